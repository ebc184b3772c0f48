//! Movers walk at random, frame after frame, and no pixel may be wrong.

use binspace::glam::DMat3;
use binspace::overlay::{Overlay, Shapes};
use testkit::prelude::*;

use crate::overlay::judge::{self, Judged};
use crate::overlay::oracle::{self, Counts};
use crate::overlay::tiling::{self, Given};

/// A polygon that walks and turns.
struct Mover {
    at: DVec3,
    turn: DMat3,
    outline: Vec<DVec3>,
}

impl Mover {
    fn new(low: DVec3, high: DVec3, dice: &mut Dice) -> Self {
        let corners = 3 + dice.below(4);
        let size = 0.1 * (high - low).max_element() * (0.2 + dice.share());
        let corner = |k: usize| {
            let angle = k as f64 / corners as f64 * std::f64::consts::TAU;
            DVec3::new(angle.cos(), angle.sin(), 0.0) * size
        };
        let share = DVec3::new(dice.share(), dice.share(), dice.share());
        Self {
            at: low + (high - low) * share,
            turn: DMat3::IDENTITY,
            outline: (0..corners).map(corner).collect(),
        }
    }

    fn step(&mut self, low: DVec3, high: DVec3, dice: &mut Dice) {
        let any = |dice: &mut Dice| dice.point(-0.5, 0.5);
        let length = 0.03 * (high - low).max_element();
        self.at = (self.at + any(dice) * length).clamp(low, high);
        self.turn *= DMat3::from_axis_angle((any(dice) + DVec3::Z).normalize(), dice.share());
        // Some movers lie flat on the ground, where many polygons are coplanar.
        if dice.below(8) == 0 {
            self.at.z = low.z;
            self.turn = DMat3::IDENTITY;
        }
    }

    fn corners(&self) -> Vec<DVec3> {
        self.outline.iter().map(|&corner| self.at + self.turn * corner).collect()
    }
}

/// The number of pixels that showed moving polygons, over `frames` frames.
fn walk(scene: &Scene, tolerance: Option<f64>, frames: usize, movers: usize) -> Judged {
    let (low, high) = scene.bounds().expect("corners");
    let margin = DVec3::splat((high - low).max_element() * 0.2);
    let mut options = BuildOptions::DEFAULT.with_bounds(low - margin, high + margin);
    options.tolerance = tolerance.into();
    let tree = options.build(scene.polygons()).expect("within budget");
    let mut overlay = Overlay::new(&tree);
    let mut dice = Dice(11);
    let mut movers: Vec<Mover> = (0..movers).map(|_| Mover::new(low, high, &mut dice)).collect();
    let mut judged = Judged::default();
    for frame in 0..frames {
        movers.iter_mut().for_each(|mover| mover.step(low, high, &mut dice));
        overlay.replace(&tree, movers.iter().map(Mover::corners)).expect("on the grid");
        if frame % 10 == 0 {
            judge::areas(&tree, &overlay).expect("tiles");
        }
        let angle = frame as f64 * 0.7;
        let middle = (low + high) * 0.5;
        let away = DVec3::new(angle.cos(), angle.sin(), 0.3 + 0.2 * angle.sin()) * margin * 3.0;
        let camera = Camera::perspective(middle + away, middle, DVec3::Z, 0.9, [160, 120])
            .expect("a camera");
        judged.look(&tree, &overlay, &camera).expect("a right picture");
    }
    judged
}

#[test]
fn movers_in_a_city_are_right_in_every_pixel() {
    let judged = walk(&scene::city(600, 2), Some(0.0), 40, 50);
    judged.assert_floor(40, 333_000, 20_000);
}

#[test]
#[ignore = "takes half a minute for each unit of BINSPACE_EFFORT"]
fn two_hundred_movers_are_right_in_every_pixel_of_a_hundred_frames() {
    let judged = walk(&scene::city(600, 2), Some(0.0), times(100), 200);
    judged.assert_floor(100, 800_000, 100_000);
}

#[test]
fn movers_among_crossing_triangles_are_right_in_every_pixel() {
    let judged = walk(&scene::random_triangles(100, 5), Some(0.0), 12, 40);
    judged.assert_floor(12, 50_000, 10_000);
}

/// With the default tolerance, contested pixels are counted.
#[test]
fn movers_under_the_default_tolerance_are_right_in_every_pixel() {
    let judged = walk(&scene::city(300, 3), None, 20, 30);
    judged.assert_floor(20, 100_000, 8_000);
}

/// 200 movers of all kinds: polygons against the depth buffer, lines and points against rays.
#[test]
fn movers_of_all_kinds_are_in_order() {
    let scene = scene::city(300, 5);
    let (low, high) = scene.bounds().expect("corners");
    let margin = DVec3::splat((high - low).max_element() * 0.2);
    let options = BuildOptions::DEFAULT.with_bounds(low - margin, high + margin);
    let tree = options.with_tolerance(0.0).build(scene.polygons()).expect("within budget");
    let [mut overlay, mut alone] = [Overlay::new(&tree), Overlay::new(&tree)];
    let mut dice = Dice(12);
    let mut movers: Vec<Mover> = (0..200).map(|_| Mover::new(low, high, &mut dice)).collect();
    let (mut judged, mut counts) = (Judged::default(), Counts::default());
    for frame in 0..times(6) as u32 {
        movers.iter_mut().for_each(|mover| mover.step(low, high, &mut dice));
        let polygons: Vec<_> = movers[..110].iter().map(Mover::corners).collect();
        let lines: Vec<_> = movers[110..150].iter().map(Mover::corners).collect();
        let points: Vec<_> = movers[150..].iter().map(|mover| mover.at).collect();
        alone.replace(&tree, &polygons).expect("on the grid");
        let shapes = Shapes::NONE.with_polygons(&polygons).with_lines(&lines);
        let shapes = shapes.with_points(points.iter().copied());
        overlay.replace_with(&tree, shapes).expect("on the grid");
        let given = Given::new(&overlay, &lines, &points);
        tiling::tiles(&tree, &overlay, &given, &mut counts).expect("tiles");
        let angle = f64::from(frame) * 0.7;
        let middle = (low + high) * 0.5;
        let away = DVec3::new(angle.cos(), angle.sin(), 0.3 + 0.2 * angle.sin()) * margin * 3.0;
        let camera = Camera::perspective(middle + away, middle, DVec3::Z, 0.9, [160, 120])
            .expect("a camera");
        judged.look_at_polygons(&tree, &overlay, alone.faces(), &camera).expect("a right picture");
        let lattice = overlay.faces().lattice();
        let among = low + (high - low) * DVec3::new(dice.share(), dice.share(), dice.share());
        for eye in [middle + away, among] {
            let eye = lattice.to_lattice(eye).map(f64::round);
            oracle::judge(&tree, &overlay, &given, eye, &mut counts).expect("a right order");
        }
    }
    judged.assert_floor(6, 45_000, 2_800);
    enough!(counts.lines > 180, counts.line_polygon > 1_800; "{counts:?}");
    enough!(counts.point_polygon > 370, counts.line_on_polygon > 3; "{counts:?}");
    assert!(counts.pieces > counts.segments * 3 / 2, "{counts:?}");
}
