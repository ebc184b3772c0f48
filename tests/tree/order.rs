//! Orders compared with the tree's planes; exact rationals give the eye's side.

use binspace::Node;
use proptest::prelude::*;
use std::ops::Range;
use testkit::judge::{Verdict, ensure};
use testkit::orders;
use testkit::prelude::*;
use testkit::rational::Plane;
use testkit::views::View;

/// A tree with its planes in rationals.
struct Sides<'t> {
    tree: &'t BspTree,
    planes: Vec<(Node<'t>, Plane)>,
    /// The number of planes with the eye behind them, on them, and in front.
    counts: [usize; 3],
}

impl<'t> Sides<'t> {
    fn new(tree: &'t BspTree) -> Self {
        let plane = |node: Node<'t>| {
            let plane = model::plane(tree.faces(), node.plane());
            (node, plane)
        };
        Self { tree, planes: tree.nodes().map(plane).collect(), counts: [0; 3] }
    }

    /// Checks that, at every plane, the far side comes first, then the fragments on the plane in input order,
    /// then the near side. For an eye on the plane, either side may come first.
    fn check(&mut self, view: &View) -> Verdict {
        orders::check(self.tree, view.viewpoint)?;
        let mut place = vec![0; self.tree.len()];
        let order = self.tree.back_to_front(view.viewpoint);
        order.enumerate().for_each(|(at, fragment)| place[fragment.index() as usize] = at);
        let places = |ids: Range<u32>| place[ids.start as usize..ids.end as usize].iter();
        let is_before = |a, b| places(a).max().zip(places(b).min()).is_none_or(|(a, b)| a < b);
        for (node, plane) in &self.planes {
            let is_parted = |far: Range<u32>, near: Range<u32>| {
                let on = node.on();
                is_before(far.clone(), near.clone())
                    && is_before(far, on.clone())
                    && is_before(on, near)
            };
            let front_last = || is_parted(node.behind(), node.in_front());
            let back_last = || is_parted(node.in_front(), node.behind());
            let side = view.side(plane);
            self.counts[(side as i8 + 1) as usize] += 1;
            let fits = match side {
                Ordering::Greater => front_last(),
                Ordering::Less => back_last(),
                Ordering::Equal => front_last() || back_last(),
            };
            ensure(fits && places(node.on()).is_sorted(), || {
                format!("{node:?} is {side:?}: {view:?}")
            })?;
        }
        Ok(())
    }

    fn check_all(&mut self, views: &[View]) -> Verdict {
        views.iter().try_for_each(|view| self.check(view))?;
        views.iter().zip(views.iter().skip(1)).try_for_each(|(a, b)| {
            self.check_same(a, b)?;
            self.check_same(a, a)
        })
    }

    /// Checks that the orders of two viewpoints are equal exactly if no plane lies between the viewpoints. A
    /// plane that contains an eye may count as between.
    fn check_same(&self, a: &View, b: &View) -> Verdict {
        let planes = self.planes.iter().map(|(_, plane)| plane);
        let sides: Vec<_> = planes.map(|plane| (a.side(plane), b.side(plane))).collect();
        let parts = sides.iter().any(|(a, b)| a.is_ne() && b.is_ne() && a != b);
        let touches = sides.iter().any(|(a, b)| a.is_eq() || b.is_eq());
        let found = self.tree.same_order(a.viewpoint, b.viewpoint);
        ensure(if found { !parts } else { parts || touches }, || format!("{found}: {a:?}, {b:?}"))
    }
}

/// Eyes on the planes of a face, at its corners, and at the height of a corner along an axis; and the same
/// eyes moved by one step of the lattice.
fn eyes_on(faces: &Faces, face: u32, dice: &mut Dice) -> Vec<View> {
    let [p, q, r] = faces.reference_triangle(face).map(|c| DVec3::from(faces.corner(c)));
    let mut eyes = vec![p, q];
    for _ in 0..2 {
        eyes.push(p + (q - p) * dice.around_zero(3) + (r - p) * dice.around_zero(3));
    }
    for axis in 0..3 {
        let mut level = dice.whole_point(1 << 30) * 1e6;
        level[axis] = r[axis];
        eyes.push(level);
    }
    let missed: Vec<DVec3> =
        eyes.iter().map(|&eye| eye + DVec3::AXES[dice.below(3)] * dice.around_zero(1)).collect();
    eyes.into_iter().chain(missed).map(|eye| View::eye(faces, eye)).collect()
}

/// Eyes from one extent away to so far away that only their direction counts. Directions are along axes,
/// along planes and edges of a face, and anywhere.
fn eyes_far_from(faces: &Faces, face: u32, dice: &mut Dice) -> Vec<View> {
    let [p, q, r] = faces.reference_triangle(face).map(|c| DVec3::from(faces.corner(c)));
    let axis = DVec3::AXES[dice.below(3)];
    let any = dice.point(-0.5, 0.5);
    let ways = [axis, -axis, q - p, (q - p) * dice.around_zero(5) + (r - p), any];
    let mut eyes = Vec::new();
    for way in ways {
        let unit = way / way.abs().max_element();
        for exponent in [51, 54, 60, 61, 62, 75, 120, 300, 415, 421, 422, 500, 960] {
            eyes.push(View::eye(faces, p + unit * 2f64.powi(exponent)));
        }
    }
    eyes
}

/// Directions along the axes, along edges and in the plane of a face, and directions next to these.
fn directions(faces: &Faces, face: u32, dice: &mut Dice) -> Vec<View> {
    let [p, q, r] = faces.reference_triangle(face).map(|c| DVec3::from(faces.corner(c)));
    let axes = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    let along = [q - p, r - q, (q - p) * 2.0 - (r - p)];
    let nearly = along.map(|way| way + DVec3::AXES[dice.below(3)] * dice.around_zero(2));
    let all = axes.chain(along).chain(nearly).filter(|&way| way != DVec3::ZERO);
    all.map(View::direction).collect()
}

/// All these viewpoints for some faces.
fn awkward_views(faces: &Faces, count: usize, dice: &mut Dice) -> Vec<View> {
    let mut views = Vec::new();
    for _ in 0..count.min(faces.len()) {
        let face = dice.below(faces.len()) as u32;
        views.extend(eyes_on(faces, face, dice));
        views.extend(eyes_far_from(faces, face, dice));
        views.extend(directions(faces, face, dice));
    }
    views
}

#[test]
fn eyes_far_away_and_on_planes_are_on_the_sides_that_rationals_say() {
    let scenes =
        [scene::sphere(100), scene::city(100, 2), scene::terrain(80, 4), scene::newell_bars()];
    let mut counts = [0; 3];
    for scene in &scenes {
        for by in [Heuristic::Auto, Heuristic::First] {
            let options = BuildOptions::DEFAULT.with_heuristic(by).with_tolerance(0.0);
            let tree = options.build(scene.polygons()).expect("within budget");
            let mut sides = Sides::new(&tree);
            let views = awkward_views(tree.faces(), 1, &mut Dice(9));
            assert_eq!(sides.check_all(&views), Ok(()), "{} by {by}", scene.name());
            (0..3).for_each(|side| counts[side] += sides.counts[side]);
        }
    }
    assert!(counts.iter().all(|&count| count > 500), "{counts:?}");
}

/// The layout of orders relies on this: no plane has all fragments on one side, and no node has fewer than
/// two fragments, except the only node of a tree.
#[test]
fn every_plane_has_something_on_it_or_on_both_sides() {
    let scenes = [scene::sphere(900), scene::random_triangles(300, 8), scene::teapot(4)];
    for scene in scenes {
        for &by in Heuristic::ALL {
            let tree = BuildOptions::DEFAULT.with_heuristic(by).build(scene.polygons()).unwrap();
            for node in tree.nodes() {
                let (on, front, back) = (node.on(), node.in_front(), node.behind());
                assert!(!on.is_empty() || !front.is_empty() && !back.is_empty(), "{by}");
                assert!(on.len() + front.len() + back.len() > 1, "{by}");
            }
        }
    }
}

proptest! {
    #![proptest_config(cases(40, file!()))]

    #[test]
    fn awkward_eyes_are_on_the_sides_that_rationals_say(
        scene in hard::scene(), by in crate::tree::heuristic(), seed in any::<u64>(),
    ) {
        let tree = scene.build(by).map_err(fail)?;
        let views = awkward_views(tree.faces(), 2, &mut Dice(seed));
        Sides::new(&tree).check_all(&views).map_err(fail)?;
    }
}
