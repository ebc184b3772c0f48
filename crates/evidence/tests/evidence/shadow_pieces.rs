//! Lit and shadowed pieces of polygons, against sight lines in rational numbers.

use binspace::internals::Eye;
use binspace_evidence::shadows::{Piece, Zone, courtyard, lamp, pieces};
use dashu_int::IBig;
use dashu_ratio::RBig;
use testkit::prelude::*;
use testkit::vector::{Plane, scalar};

type Point = [IBig; 3];

fn whole(point: [f64; 3]) -> Point {
    point.map(|c| {
        assert_eq!(c, c.trunc());
        IBig::from(c as i128)
    })
}

/// The side of a plane on which a point lies. The point is given by its coordinates times a factor, and this
/// factor.
fn side(plane: &Plane<IBig>, [point @ .., factor]: &[IBig; 4]) -> Ordering {
    (scalar(&plane.normal, point) - &plane.offset * factor).cmp(&IBig::ZERO)
}

/// A face, as seen from a point of the lamp: the face's plane, the side on which the lamp is, and the planes
/// through the lamp and the face's edges.
struct Screen {
    plane: Plane<IBig>,
    lamp: Ordering,
    side_planes: Vec<Plane<IBig>>,
}

/// The faces that may hide a point of the lamp.
struct Judge(Vec<Screen>);

impl Judge {
    fn new(faces: &Faces, lamp: DVec3) -> Self {
        let at = Eye::new(Viewpoint::Eye(lamp), faces.lattice()).homogeneous();
        let lamp = whole(at.0);
        let screen = |face: u32| {
            let corners: Vec<Point> = faces.corners(face).iter().map(|&p| whole(p)).collect();
            let plane = Plane::through([&corners[0], &corners[1], &corners[2]]);
            let next = corners.iter().cycle().skip(1);
            let edges = corners.iter().zip(next);
            let side_planes = edges.map(|(a, b)| Plane::through([&lamp, a, b])).collect();
            let lamp = plane.at(&lamp).cmp(&IBig::ZERO);
            Screen { plane, lamp, side_planes }
        };
        Self((0..faces.len() as u32).map(screen).collect())
    }

    fn is_edge_on(&self, face: u32) -> bool {
        self.0[face as usize].lamp == Ordering::Equal
    }

    /// Whether a face has a point between this point and the lamp.
    fn hides(&self, point: &[IBig; 4]) -> bool {
        self.0.iter().any(|Screen { plane, lamp, side_planes }| {
            if *lamp == Ordering::Equal || side(plane, point) != lamp.reverse() {
                return false;
            }
            let sides: Vec<Ordering> = side_planes.iter().map(|plane| side(plane, point)).collect();
            !(sides.contains(&Ordering::Greater) && sides.contains(&Ordering::Less))
        })
    }
}

/// A random point within a piece: a mean of its corners, all with weights above 0.
fn within(corners: &[[IBig; 4]], dice: &mut Dice) -> [IBig; 4] {
    let most = corners.iter().map(|corner| &corner[3]).max().unwrap();
    let mut sum: [IBig; 4] = Default::default();
    for corner in corners {
        let weight = most / &corner[3] * IBig::from(1 + dice.roll() % 1000);
        sum.iter_mut().zip(corner).for_each(|(sum, c)| *sum += &weight * c);
    }
    sum
}

/// The numbers of sight lines that were compared, that were hidden, and that are wrong.
fn compare(scene: &Scene, lamp: &[DVec3], pieces: &[Piece], count: usize) -> [usize; 3] {
    let (faces, _) = Faces::new(scene.polygons(), Some(0.0)).unwrap();
    let judges: Vec<Judge> = lamp.iter().map(|&at| Judge::new(&faces, at)).collect();
    let corners: Vec<Vec<_>> = pieces.iter().map(|piece| piece.exact_corners().collect()).collect();
    let mut dice = Dice(11);
    let [mut compared, mut hidden, mut wrong] = [0; 3];
    while compared < count {
        let number = (dice.roll() % pieces.len() as u64) as usize;
        let (piece, point) = (&pieces[number], within(&corners[number], &mut dice));
        for (judge, sees) in judges.iter().zip(&piece.sees) {
            // A point in the plane of the lamp does not see the lamp.
            if judge.is_edge_on(piece.face) {
                assert!(!sees);
                continue;
            }
            let hides = judge.hides(&point);
            wrong += usize::from(hides == *sees);
            hidden += usize::from(hides);
            compared += 1;
        }
    }
    [compared, hidden, wrong]
}

fn tree(scene: &Scene) -> BspTree {
    BuildOptions::DEFAULT.with_tolerance(0.0).build(scene.polygons()).unwrap()
}

fn cut(scene: &Scene, lamp: &[DVec3]) -> Vec<Piece> {
    let tree = tree(scene);
    pieces(&tree, lamp).pieces
}

fn check(scene: &Scene, lamp: &[DVec3], count: usize) {
    let pieces = cut(scene, lamp);
    let [compared, hidden, wrong] = compare(scene, lamp, &pieces, count);
    assert!(hidden > compared / 5 && hidden < compared / 5 * 4, "{hidden} of {compared}");
    assert_eq!(wrong, 0, "of {compared}, within {} pieces", pieces.len());
}

fn triangles() -> (Scene, Vec<DVec3>) {
    let at = |x: f64, y: f64| dvec3(0.31 + x, 0.27 + y, 4.0);
    let lamp = [at(-0.2, -0.2), at(0.2, -0.2), at(0.2, 0.2), at(-0.2, 0.2)];
    (scene::random_triangles(14, 5), lamp.to_vec())
}

/// A wall in the plane of two corners of the lamp. It hides the other two corners from places beside it on
/// the floor, and a plate hides the first two. So no corner is visible from there, but the lamp between the
/// corners is.
fn edge_on() -> Scene {
    let mut scene = Scene::new("edge on", DVec3::Z);
    let level = |x: [f64; 2], y: [f64; 2], z: f64| {
        [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| dvec3(x[i], y[j], z))
    };
    scene.push(level([0.0, 4096.0], [0.0, 4096.0], 0.0), 0);
    scene.push(level([1650.0, 1720.0], [1700.0, 2700.0], 2500.0), 0);
    let wall = [(1000.0, 0.0), (3500.0, 0.0), (3500.0, 1500.0), (1000.0, 1500.0)];
    scene.push(wall.map(|(y, z)| dvec3(1733.0, y, z)), 0);
    scene
}

#[test]
fn every_point_within_a_piece_has_the_zone_of_the_piece() {
    check(&courtyard(), &lamp(2), times(30_000));
    check(&courtyard(), &lamp(2)[..1], 5000);
    check(&edge_on(), &lamp(2), 5000);
    let (scene, lamp) = triangles();
    check(&scene, &lamp, 5000);
}

#[test]
#[ignore = "takes half a minute; with fewer above"]
fn a_million_points_have_the_zones_of_their_pieces() {
    check(&courtyard(), &lamp(2), 800_000);
    let (scene, lamp) = triangles();
    check(&scene, &lamp, 200_000);
}

#[test]
fn pieces_with_another_zone_are_noticed() {
    let mut pieces = cut(&courtyard(), &lamp(2));
    pieces.iter_mut().flat_map(|piece| &mut piece.sees).for_each(|sees| *sees = !*sees);
    let [compared, _, wrong] = compare(&courtyard(), &lamp(2), &pieces, 1000);
    assert_eq!(wrong, compared);
}

/// Twice the area of a projection along an axis.
fn area(corners: &[[IBig; 4]], axis: usize) -> RBig {
    let at = |k: usize, i: usize| {
        let corner = &corners[k % corners.len()];
        RBig::from_parts_signed(corner[(axis + i) % 3].clone(), corner[3].clone())
    };
    let turn = |k| at(k, 1) * at(k + 1, 2) - at(k + 1, 1) * at(k, 2);
    testkit::rational::total((0..corners.len()).map(turn))
}

#[test]
fn the_pieces_of_a_face_have_its_area() {
    let (dice, over_it) = triangles();
    for (scene, lamp) in [(courtyard(), lamp(2)), (dice, over_it)] {
        let (faces, _) = Faces::new(scene.polygons(), Some(0.0)).unwrap();
        let pieces = cut(&scene, &lamp);
        assert!(pieces.len() > 3 * faces.len(), "{}", pieces.len());
        for face in 0..faces.len() as u32 {
            for axis in 0..3 {
                let one = IBig::from(1);
                let corners = faces.corners(face).iter().map(|&p| whole(p));
                let corners: Vec<_> = corners.map(|[x, y, z]| [x, y, z, one.clone()]).collect();
                let own = pieces.iter().filter(|piece| piece.face == face);
                let areas = own.map(|piece| area(&piece.exact_corners().collect::<Vec<_>>(), axis));
                let areas: Vec<RBig> = areas.collect();
                // All pieces have the face's orientation, so no area is subtracted.
                let whole = area(&corners, axis);
                assert!(areas.iter().all(|part| part.signum() == whole.signum()));
                assert_eq!(testkit::rational::total(areas), whole, "face {face}");
            }
        }
    }
}

#[test]
fn a_certain_umbra_is_hidden_from_all_between() {
    let [certain, _] = umbra(&courtyard());
    enough!(certain > 5; "{certain}");
    let [_, by_several] = umbra(&edge_on());
    assert!(by_several > 0);
}

/// The number of pieces that are certainly in the umbra, and of pieces that see no corner of the lamp but are
/// not certainly in the umbra.
fn umbra(scene: &Scene) -> [usize; 2] {
    let (faces, _) = Faces::new(scene.polygons(), Some(0.0)).unwrap();
    let pieces = cut(scene, &lamp(2));
    let judges: Vec<Judge> = lamp(9).iter().map(|&at| Judge::new(&faces, at)).collect();
    let mut dice = Dice(2);
    let [mut certain, mut by_several, mut zones] = [0; 3];
    for piece in &pieces {
        zones |= 1 << piece.zone() as u32;
        by_several += usize::from(piece.zone() == Zone::Umbra && !piece.is_umbra);
        if piece.is_umbra {
            assert_eq!(piece.zone(), Zone::Umbra);
            let corners: Vec<_> = piece.exact_corners().collect();
            for _ in 0..8 {
                let point = within(&corners, &mut dice);
                assert!(judges.iter().all(|judge| judge.hides(&point)), "{}", scene.name());
            }
            certain += 1;
        }
    }
    assert_eq!(zones, 0b111);
    [certain, by_several]
}

/// A square over a floor, the lamp twice as high over its middle: the shadow is twice as wide.
#[test]
fn a_shadow_by_hand() {
    let square = |half: f64, z: f64| {
        [[-half, -half], [half, -half], [half, half], [-half, half]].map(|[x, y]| dvec3(x, y, z))
    };
    let mut scene = Scene::new("square", DVec3::Z);
    scene.push(square(16.0, 0.0), 0);
    scene.push(square(2.0, 8.0), 0);
    let (faces, _) = Faces::new(scene.polygons(), Some(0.0)).unwrap();
    let pieces = cut(&scene, &[dvec3(0.0, 0.0, 16.0)]);
    let dark: Vec<&Piece> = pieces.iter().filter(|piece| piece.zone() == Zone::Umbra).collect();
    assert_eq!((dark.len(), dark[0].face, dark[0].is_umbra), (1, 0, true));
    let corners: Vec<DVec3> = dark[0].corners(&faces).collect();
    assert_eq!(corners.len(), 4);
    assert!(corners.iter().all(|p| p.x.abs() == 4.0 && p.y.abs() == 4.0 && p.z == 0.0));
}

/// A lamp that stands on a floor: the floor sees two of its corners edge-on, and still lies in the umbra
/// behind a wall.
#[test]
fn behind_a_wall_is_umbra_of_a_lamp_that_is_partly_seen_edge_on() {
    let mut scene = Scene::new("standing", DVec3::Z);
    let floor = [[-16.0, -16.0], [16.0, -16.0], [16.0, 16.0], [-16.0, 16.0]];
    scene.push(floor.map(|[x, y]| dvec3(x, y, 0.0)), 0);
    let wall = [[-16.0, -1.0], [16.0, -1.0], [16.0, 8.0], [-16.0, 8.0]];
    scene.push(wall.map(|[y, z]| dvec3(4.0, y, z)), 0);
    let lamp = [[-2.0, 0.0], [2.0, 0.0], [2.0, 4.0], [-2.0, 4.0]];
    let (faces, _) = Faces::new(scene.polygons(), Some(0.0)).unwrap();
    let pieces = cut(&scene, &lamp.map(|[y, z]| dvec3(-8.0, y, z)));
    let floor = pieces.iter().filter(|piece| piece.face == 0);
    let (dark, others): (Vec<&Piece>, Vec<&Piece>) = floor.partition(|piece| piece.is_umbra);
    assert!(!dark.is_empty());
    for (pieces, is_behind) in [(dark, true), (others, false)] {
        for piece in pieces {
            assert!(piece.corners(&faces).all(|p| (p.x >= 4.0) == is_behind || p.x == 4.0));
        }
    }
}

#[test]
fn without_a_lamp_all_faces_are_whole() {
    assert_eq!(cut(&courtyard(), &[]).len(), courtyard().len());
}
