//! Small cards on the faces of bodies, rooms and cylinders: decals, labels, markings. At the default
//! tolerances of `f32`, of decimals and of `f64`, coplanar polygons come in input order.
//!
//! Two polygons are coplanar if the corners of the smaller one are within the tolerance of the larger one's
//! plane; rationals decide that. The tree is not asked which polygons it takes for coplanar, but which plane
//! separates two fragments: parts within the tolerance of a plane that crosses both may come in either order.

use binspace::Ray;
use binspace::glam::{DQuat, EulerRot};
use std::collections::HashMap;
use std::f64::consts::TAU;
use testkit::prelude::*;
use testkit::rational::{Plane, Point, exact, scalar};
use testkit::scenes::trees;

/// How the corners are given.
#[derive(Clone, Copy, Debug)]
enum Numbers {
    Single,
    Double,
    /// A number of decimals.
    Decimal(i32),
}

struct Decals {
    polygons: Vec<Corners>,
    /// A card, and the face that it was put on, by their numbers among the polygons.
    pairs: Vec<[usize; 2]>,
    /// The tolerance, if not the default one.
    tolerance: Option<f64>,
    numbers: Numbers,
}

/// Faces of a body around the origin, with a radius of about 1.
fn body(dice: &mut Dice) -> Vec<Corners> {
    let turn =
        DQuat::from_euler(EulerRot::XYZ, dice.share() * TAU, dice.share() * TAU, dice.share());
    let mut faces: Vec<Corners> = Vec::new();
    match dice.below(4) {
        0 => faces.push(vec![dvec3(-1.0, -0.8, 0.0), dvec3(1.1, -0.7, 0.0), dvec3(0.2, 0.9, 0.0)]),
        // A room.
        1 => {
            for axis in 0..3 {
                let [n, u, v] = [0, 1, 2].map(|k| DVec3::AXES[(axis + k) % 3]);
                let size = dvec3(1.0, 0.7, 0.5);
                let at = |s: f64, a: f64, b: f64| (n * s + u * a + v * b) * size;
                faces.push(vec![
                    at(1.0, -1.0, -1.0),
                    at(1.0, 1.0, -1.0),
                    at(1.0, 1.0, 1.0),
                    at(1.0, -1.0, 1.0),
                ]);
                faces.push(vec![
                    at(-1.0, -1.0, -1.0),
                    at(-1.0, -1.0, 1.0),
                    at(-1.0, 1.0, 1.0),
                    at(-1.0, 1.0, -1.0),
                ]);
            }
        }
        // A cylinder.
        2 => {
            let sides = 5 + dice.below(30);
            let at = |k: usize, z: f64| {
                let (sin, cos) = (TAU * k as f64 / sides as f64).sin_cos();
                dvec3(0.6 * cos, 0.6 * sin, z)
            };
            let sides = 0..sides;
            faces.extend(
                sides.map(|k| vec![at(k, -0.8), at(k + 1, -0.8), at(k + 1, 0.8), at(k, 0.8)]),
            );
        }
        // A ball of triangles, not quite round.
        _ => {
            let (rings, sides) = (3 + dice.below(3), 3 + dice.below(6));
            let radii: Vec<f64> = (0..=rings * sides).map(|_| dice.range(0.95, 1.0)).collect();
            let at = |i: usize, k: usize| {
                let (up, around) =
                    (TAU * 0.5 * i as f64 / rings as f64, TAU * k as f64 / sides as f64);
                let k = if i == 0 || i == rings { 0 } else { k % sides };
                let radius = radii[i % rings * sides + k];
                dvec3(up.sin() * around.cos(), up.sin() * around.sin(), up.cos()) * radius
            };
            for i in 0..rings {
                for k in 0..sides {
                    let [a, b, c, d] = [at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)];
                    faces.extend((i + 1 < rings).then(|| vec![a, b, c]));
                    faces.extend((i > 0).then(|| vec![a, c, d]));
                }
            }
        }
    }
    faces.iter().map(|face| face.iter().map(|&p| turn * p).collect()).collect()
}

fn decals(dice: &mut Dice, numbers: Numbers) -> Decals {
    let faces = body(dice);
    let mut polygons: Vec<(Corners, usize)> = faces.iter().cloned().zip(0..).collect();
    let most = [3, 20][dice.below(2)];
    for card in 0..1 + dice.below(most) {
        let face = dice.below(faces.len());
        let corners = &faces[face];
        let (origin, u) = (corners[0], (corners[1] - corners[0]).normalize());
        let normal = u.cross(corners[2] - origin).normalize();
        let middle = {
            let weights: Vec<f64> = corners.iter().map(|_| dice.share() + 0.05).collect();
            let sum: f64 = weights.iter().sum();
            corners.iter().zip(&weights).map(|(&p, w)| p * (w / sum)).sum::<DVec3>()
        };
        let size = 10f64.powf(dice.range(-2.2, -0.7));
        let from = dice.share() * TAU;
        let count = 3 + dice.below(2);
        let around = (0..count).map(|k| {
            let (sin, cos) = (from + TAU * k as f64 / count as f64).sin_cos();
            middle + (u * cos + normal.cross(u) * sin) * size
        });
        polygons.push((around.collect(), faces.len() + card * faces.len() + face));
    }
    dice.shuffle(&mut polygons);
    let step = match numbers {
        Numbers::Decimal(places) => 10f64.powi(-places),
        _ => 0.0,
    };
    let round = |p: DVec3| match numbers {
        Numbers::Single => p.as_vec3().as_dvec3(),
        Numbers::Double => p,
        Numbers::Decimal(_) => (p / step).round() * step,
    };
    let place = |name: usize| polygons.iter().position(|(_, known)| *known == name).unwrap();
    let cards = polygons.iter().enumerate().filter(|(_, (_, name))| *name >= faces.len());
    let pairs = cards.map(|(card, (_, name))| [card, place(name % faces.len())]).collect();
    let tolerance = match numbers {
        Numbers::Decimal(_) => Some(4.0 * step),
        _ => None,
    };
    let polygons = polygons.iter().map(|(p, _)| p.iter().map(|&p| round(p)).collect()).collect();
    Decals { polygons, pairs, tolerance, numbers }
}

/// Whether a point is within so many tolerances of a plane.
fn is_near(faces: &Faces, plane: &Plane, point: &Point, tolerances: f64) -> bool {
    let (off, most) = (plane.at(point), exact(faces.tolerance()) * exact(tolerances));
    &off * &off <= &most * &most * scalar(&plane.normal, &plane.normal)
}

/// Which planes faces lie on, decided once for all trees with these faces.
struct Flat<'f> {
    faces: &'f Faces,
    /// The corners of each face.
    corners: Vec<Vec<Point>>,
    decided: HashMap<(u32, PlaneId), bool>,
}

impl<'f> Flat<'f> {
    fn new(faces: &'f Faces) -> Self {
        let corners = |face| model::Face::new(faces, face).corners;
        let corners = (0..faces.len() as u32).map(corners).collect();
        Self { faces, corners, decided: HashMap::new() }
    }

    /// Whether all corners of a face are clearly within the tolerance of a plane.
    fn is_on_plane(&mut self, face: u32, plane: PlaneId) -> bool {
        *self.decided.entry((face, plane)).or_insert_with(|| {
            let plane = model::plane(self.faces, plane);
            let mut corners = self.corners[face as usize].iter();
            corners.all(|corner| is_near(self.faces, &plane, corner, 1.0 - 1e-6))
        })
    }

    fn is_on(&mut self, face: u32, other: u32) -> bool {
        self.is_on_plane(face, PlaneId::face(other))
    }

    /// Whether other faces are the same.
    fn are(&self, other: &Faces) -> bool {
        let all = 0..self.faces.len() as u32;
        (self.faces.len(), self.faces.tolerance()) == (other.len(), other.tolerance())
            && all.into_iter().all(|face| self.faces.corners(face) == other.corners(face))
    }
}

#[derive(Debug, Default)]
struct Counts {
    pairs: usize,
    /// Pairs that are not judged.
    ambiguous: usize,
    /// Pairs in which the larger polygon leaves the smaller one's plane by more than the tolerance.
    one_sided: usize,
    /// Points within the tolerance of a partition plane that crosses both polygons. They are not judged.
    crossed: usize,
    /// Compared fragments.
    compared: usize,
}

fn judge(
    (name, tree): (&str, &BspTree),
    decals: &Decals,
    flat: &mut Flat<'_>,
    dice: &mut Dice,
    counts: &mut Counts,
) {
    let faces = tree.faces();
    assert!(flat.are(faces), "{name}");
    let of = |polygon: usize| {
        let mut own = (0..faces.len() as u32).filter(|&face| faces.polygon(face) == polygon);
        own.next().filter(|_| own.next().is_none())
    };
    for &[card, wall] in &decals.pairs {
        let (Some(one), Some(other)) = (of(card), of(wall)) else { continue };
        if !flat.is_on(one, other) {
            continue;
        }
        // A card on two faces that are not coplanar keeps its place with one of them.
        let is_ambiguous = (0..faces.len() as u32).any(|face| {
            face != other
                && flat.is_on(one, face)
                && !flat.is_on(face, other)
                && !flat.is_on(other, face)
        });
        if is_ambiguous {
            counts.ambiguous += 1;
            continue;
        }
        counts.pairs += 1;
        counts.one_sided += usize::from(!flat.is_on(other, one));
        let corners = &decals.polygons[wall];
        let x = (corners[1] - corners[0]).normalize();
        let z = x.cross(corners[2] - corners[0]).normalize();
        let level = |p: DVec3| dvec2(p.dot(x), p.dot(z.cross(x)));
        let outlines = |polygon: usize| -> Vec<(u32, Vec<DVec2>)> {
            let own = (0..tree.len() as u32).filter(|&f| tree.fragment(f).polygon() == polygon);
            own.map(|f| (f, tree.fragment(f).vertices().map(level).collect())).collect()
        };
        let (own, others) = (outlines(card), outlines(wall));
        let points = &decals.polygons[card];
        for _ in 0..4 {
            let weights: Vec<f64> = points.iter().map(|_| dice.share() + 0.02).collect();
            let sum: f64 = weights.iter().sum();
            let at = points.iter().zip(&weights).map(|(&p, w)| p * (w / sum)).sum::<DVec3>();
            let here = |outlines: &[(u32, Vec<DVec2>)]| {
                let found = outlines.iter().find(|(_, outline)| is_inside(outline, level(at)));
                found.map(|(fragment, _)| *fragment)
            };
            let (Some(a), Some(b)) = (here(&own), here(&others)) else { continue };
            let is_crossed = tree.plane_between(a, b).is_some_and(|plane| {
                let point = faces.lattice().to_lattice(at).map(exact);
                is_near(faces, &model::plane(faces, plane), &point, 1.0 + 1e-6)
                    && [one, other].iter().all(|&face| !flat.is_on_plane(face, plane))
            });
            if is_crossed {
                counts.crossed += 1;
                continue;
            }
            let aside = (x * dice.range(-1.0, 1.0) + z.cross(x) * dice.range(-1.0, 1.0)) * 0.7;
            let mut order = Vec::new();
            for side in [1.0, -1.0] {
                let away = z * side + aside;
                for viewpoint in [
                    Viewpoint::direction((-away).to_array()),
                    Viewpoint::eye((at + 3.0 * away).to_array()),
                ] {
                    tree.back_to_front_into(viewpoint, &mut order);
                    let rank = |fragment| order.iter().position(|&f| f == fragment).unwrap();
                    counts.compared += 1;
                    assert_eq!(
                        rank(a) < rank(b),
                        card < wall,
                        "{name}, {:?}: {card} on {wall} from {viewpoint:?}: {:?}",
                        decals.numbers,
                        decals.polygons
                    );
                }
            }
        }
    }
}

/// Whether a point is inside a convex outline, and not near its sides.
fn is_inside(outline: &[DVec2], at: DVec2) -> bool {
    let next = outline.iter().cycle().skip(1);
    let sides = outline.iter().zip(next).map(|(&a, &b)| (b - a).normalize().perp_dot(at - a));
    let (low, high) = sides.fold((f64::MAX, f64::MIN), |(low, high), s| (low.min(s), high.max(s)));
    low > 1e-4 || high < -1e-4
}

/// Rays through the cards hit the same polygons in the same order, whichever planes divide the tree.
fn hits_are_equal(trees: &[(String, BspTree)], decals: &Decals, dice: &mut Dice) {
    for &[card, _] in &decals.pairs {
        let corners = &decals.polygons[card];
        let at = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let towards = dvec3(dice.range(-1.0, 1.0), dice.range(-1.0, 1.0), dice.range(-1.0, 1.0));
        let of = |tree: &BspTree| -> Vec<(usize, f64)> {
            let hits = tree.hits(Ray::new(at - 3.0 * towards, towards));
            hits.map(|hit| (hit.polygon(), hit.parameter())).collect()
        };
        let expected = of(&trees[0].1);
        // A ray along a card whose corners were moved to one plane may miss it.
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
        let grazes = normal.dot(towards.normalize()).abs() < 0.1;
        assert!(grazes || !expected.is_empty(), "{at} {towards}");
        for (name, tree) in trees {
            assert_eq!(of(tree), expected, "{name}: {at} {towards}");
        }
    }
}

/// The face leaves the card's plane on one side only, so the card's plane cuts nothing.
#[test]
fn a_card_whose_plane_passes_beside_its_face_keeps_its_place() {
    let card = [
        [0.16458091f32, -0.8256243, -0.50781417],
        [0.15240966, -0.82543993, -0.50566643],
        [0.15728892, -0.82035375, -0.5140212],
    ];
    let face = [
        [0.21473855, -0.8454632, -0.48895735],
        [-0.3938244, -0.8362459, -0.38156936],
        [-0.14986128, -0.5819343, -0.7993085],
    ];
    let eye = Viewpoint::eye([-0.657895, -4.527287, -3.339690]);
    for (name, tree) in trees(&[card, face], BuildOptions::DEFAULT) {
        let order: Vec<usize> = tree.back_to_front(eye).map(|f| f.polygon()).collect();
        assert_eq!(order, [0, 1], "{name}");
    }
}

#[test]
fn cards_on_bodies_come_in_input_order_at_default_tolerances() {
    for numbers in [Numbers::Single, Numbers::Decimal(4), Numbers::Double] {
        let mut counts = Counts::default();
        for seed in seeds(25) {
            let mut dice = Dice(seed);
            let decals = decals(&mut dice, numbers);
            let default = BuildOptions::DEFAULT;
            let options = match decals.tolerance {
                Some(length) => default.with_tolerance(length),
                None => default,
            };
            let all = match numbers {
                Numbers::Single => {
                    let single = |corners: &Corners| -> Vec<[f32; 3]> {
                        corners.iter().map(|p| p.as_vec3().to_array()).collect()
                    };
                    trees(&decals.polygons.iter().map(single).collect::<Vec<_>>(), options)
                }
                _ => trees(&decals.polygons, options),
            };
            let mut flat = Flat::new(all[0].1.faces());
            for (name, tree) in &all {
                judge((name, tree), &decals, &mut flat, &mut dice, &mut counts);
            }
            hits_are_equal(&all, &decals, &mut dice);
        }
        assert!(counts.compared > 4_000, "{numbers:?}: {counts:?}");
        assert!(counts.crossed * 100 < counts.compared, "{numbers:?}: {counts:?}");
        let floor = if matches!(numbers, Numbers::Double) { 0 } else { 120 };
        assert!(counts.one_sided >= floor, "{numbers:?}: {counts:?}");
    }
}
