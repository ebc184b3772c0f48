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
        "The algorithm of M. E. Newell, R. G. Newell and T. L. Sancha (\"A solution to the hidden \
         surface problem\", 1972) sorts polygons by their furthest vertex, and then checks this order. \
         Let P be the furthest polygon in the list. P may be painted if P hides no polygon Q whose depth \
         range overlaps P's. Each of five tests can prove that P does not hide Q, the cheapest first: 1. P \
         and Q do not overlap from left to right; 2. P and Q do not overlap from top to bottom; 3. P is \
         behind the plane of Q; 4. Q is in front of the plane of P; 5. the projections of P and Q do not \
         overlap. If all tests fail, Q takes the place of P in the list. But if Q has been moved before, or \
         if P and Q penetrate each other, the plane of one polygon splits the other polygon.",
    );
    let towards = DVec3::new(0.7, -1.0, 0.5);
    let scenes = [
        ("city of 600", Builtin::City.build(Some(600), 1)),
        ("teapot", Builtin::Teapot.build(Some(6), 1)),
        ("terrain of 2000", Builtin::Terrain.build(Some(2000), 1)),
        ("random triangles, 300", Builtin::Random.build(Some(300), 1)),
        ("three bars", newell_bars()),
        ("penetrating triangles, 60", Family::Penetration.scene(60.0, 1)),
    ];
    let (mut pictures, mut shares, mut outcomes) = (Vec::new(), Vec::new(), Vec::new());
    for (name, scene) in &scenes {
        let shot = Shot::around(scene, towards)?;
        if ["city of 600", "teapot", "penetrating triangles, 60"].contains(name) {
            pictures.push(shot.by(&Newell::DEFAULT, name)?);
        }
        let decisions = Newell::DEFAULT.decisions(&shot.faces, &shot.camera);
        let decisions = decisions.map_err(|error| Failure::about(name, error))?;
        shares.push(tests(name, &decisions));
        outcomes.push(rest(name, &decisions));
    }
    chapter.pictures(pictures);
    chapter.text(
        "The table gives the share of pairs that each test settles. All compared pairs overlap in depth, \
         and each test sees only the pairs left undecided by earlier tests. The first two tests need two \
         comparisons of numbers each, and they settle most pairs. Few pairs reach the expensive fifth \
         test.",
    );
    let head = [
        "scene",
        "pairs compared",
        "1 left, right",
        "2 top, bottom",
        "3 P behind Q",
        "4 Q in front of P",
        "5 projections",
        "none",
    ];
    chapter.table(head, shares);
    chapter.text(
        "The next table shows the outcome for the pairs that no test settled. Pieces of one polygon \
         never hide each other and are not tested.",
    );
    let head = [
        "scene",
        "polygons in view",
        "Q moved before P",
        "splits",
        "within the epsilon",
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
