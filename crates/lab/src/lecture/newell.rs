//! Newell's algorithm: its tests, in their order, and the number of decisions of each.

use binspace::glam::DVec3;
use binspace::scene::{Builtin, newell_bars};
use binspace_evidence::Family;
use binspace_evidence::method::{Decisions, Newell};

use super::chapter::{Chapter, percent};
use super::shot::Shot;
use binspace_cli::failure::Failure;

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.text(
        "M. E. Newell, R. G. Newell and T. L. Sancha (\"A solution to the hidden surface problem\", 1972) sort \
         polygons by their furthest vertex and then make sure. The furthest, P, may be painted if it hides no \
         Q that overlaps it in depth. Five tests are tried in turn, the cheap ones first: 1. P and Q do not \
         overlap from left to right; 2. nor from top to bottom; 3. P is behind Q's plane; 4. Q is in front of \
         P's plane; 5. their projections do not overlap. If none holds, Q takes P's place in the list, \
         unless it has done so before or the two go through each other: then one is cut by the plane of the \
         other.",
    );
    let towards = DVec3::new(0.7, -1.0, 0.5);
    let scenes = [
        ("city of 600", Builtin::City.build(Some(600), 1)),
        ("teapot", Builtin::Teapot.build(Some(6), 1)),
        ("terrain of 2000", Builtin::Terrain.build(Some(2000), 1)),
        ("random triangles, 300", Builtin::Random.build(Some(300), 1)),
        ("three bars", newell_bars()),
        ("triangles through each other, 60", Family::Penetration.scene(60.0, 1)),
    ];
    let (mut pictures, mut shares, mut outcomes) = (Vec::new(), Vec::new(), Vec::new());
    for (name, scene) in &scenes {
        let shot = Shot::around(scene, towards)?;
        if ["city of 600", "teapot", "triangles through each other, 60"].contains(name) {
            pictures.push(shot.by(&Newell::DEFAULT, name)?);
        }
        let decisions = Newell::DEFAULT.decisions(&shot.faces, &shot.camera);
        let decisions = decisions.map_err(|error| Failure::about(name, error))?;
        shares.push(tests(name, &decisions));
        outcomes.push(rest(name, &decisions));
    }
    chapter.pictures(pictures);
    chapter.text(
        "How often each test decides, of the pairs that it could have: those that overlap in depth and that no \
         test before it decided. The first two take two comparisons of numbers each and settle most pairs; what is left \
         for the expensive fifth is little.",
    );
    let head = [
        "scene",
        "pairs compared",
        "1 left, right",
        "2 top, bottom",
        "3 P behind Q",
        "4 Q before P",
        "5 projections",
        "none",
    ];
    chapter.table(head, shares);
    chapter.text(
        "What became of the pairs that no test decided. Pieces of one polygon never hide each other and are \
         not tested.",
    );
    let head = [
        "scene",
        "polygons in view",
        "Q moved before P",
        "cuts",
        "within the rounding",
        "pieces painted",
    ];
    chapter.table(head, outcomes);
    Ok(())
}

/// The share of all pairs that each test decided.
fn tests(name: &str, found: &Decisions) -> [String; 8] {
    let tested = found.compared - found.of_one_face;
    let share = |part: u64| percent(part as f64, tested.max(1) as f64).to_string();
    let [a, b, c, d, e] = found.by_test.map(share);
    let none = share(found.moved + found.cuts + found.passed);
    [name.to_owned(), tested.to_string(), a, b, c, d, e, none]
}

fn rest(name: &str, found: &Decisions) -> [String; 6] {
    [
        name.to_owned(),
        found.begun.to_string(),
        found.moved.to_string(),
        found.cuts.to_string(),
        found.passed.to_string(),
        found.painted.to_string(),
    ]
}
