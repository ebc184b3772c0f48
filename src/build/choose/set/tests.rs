//! The packed pieces against exact decisions.

use glam::DVec3;

use super::super::tests::{Fixture, grid, triangles};
use super::{LANES, PackedPieces, Reach, Set};
use crate::exact::{PlaneId, Side};
use crate::random::SplitMix64;

fn sketched(set: &Set<'_>) -> PackedPieces {
    let mut sketch = PackedPieces::default();
    sketch.reset(set);
    sketch.extend(set, 0..set.len());
    sketch
}

/// Asserts that certain results of the packed pieces are true; returns their number.
fn assert_certain(name: &str, fixture: &Fixture) -> usize {
    let set = fixture.set();
    let sketch = sketched(&set);
    let mut certain = 0;
    for own in 0..set.len() {
        let plane = sketch.plane(&set, own);
        let prepared = set.prepare(set.own_plane(own));
        for piece in 0..set.len() {
            let (mut bits, group) = ([0; 3], piece / LANES);
            sketch.for_each_reach(&plane, group..group + 1, |_, Reach { front, back, near }| {
                bits = [front, back, near];
            });
            let [front, back, near] = bits.map(|bits| bits >> (piece % LANES) & 1 == 1);
            let is_certain = match set.classify(&prepared, piece) {
                Side::Front => !back,
                Side::Back => !front,
                Side::Coplanar => !front && !back && near,
                Side::Spanning => near,
            };
            assert!(is_certain, "{name}: piece {piece} at the plane of {own}: {bits:?}");
            assert!(front || back || near, "{name}: {piece} is nowhere");
            let may_be_on = sketch.may_be_on(&set, own, piece);
            assert!(may_be_on || set.classify(&prepared, piece) != Side::Coplanar, "{name}");
            certain += usize::from(!near);
        }
    }
    certain
}

/// All pieces except one lie exactly in one plane, at a corner of the box, so that coordinates and distances,
/// and their rounding errors, are as large as possible.
#[test]
fn rounding_makes_nothing_certain() {
    let mut random = SplitMix64::new(1);
    let mut most = 0_f32;
    for round in 0..400 {
        let mut vector = |x: f64, y: f64, z: f64| {
            let exact = DVec3::new(x, y, z) + random.point(-0.02, 0.02);
            (exact * f64::from(1 << 30) * 1e4).round()
        };
        let (u, w) = (vector(0.1, -0.1, 0.0), vector(0.0, 0.1, -0.1));
        // √3 times this coordinate is a little more than a power of two.
        let corner = vector(37.3, 37.3, 37.3);
        let mut at = || {
            let [i, j] = [(); 2].map(|()| (random.next() % 9) as f64 - 4.0);
            corner + u * i + w * j
        };
        let mut polygons: Vec<_> = (0..60)
            .map(|_| [(); 3].map(|()| at()))
            .filter(|[a, b, c]| (b - a).cross(c - a) != DVec3::ZERO)
            .collect();
        polygons.push([u, w, DVec3::ZERO].map(|p| p - corner));
        let fixture = Fixture::new(&polygons, 0.0);
        assert_certain(&format!("plane {round}"), &fixture);
        most = most.max(error(&fixture.set()));
    }
    // The test comes near the limit of the slack.
    assert!((0.15..1.0).contains(&most), "{most} of the slack");
}

/// The largest rounded distance of a piece, except the last, from the plane of another, divided by the
/// slack.
fn error(set: &Set<'_>) -> f32 {
    let sketch = sketched(set);
    let others = || 0..set.len() - 1;
    let mut most = 0_f32;
    for own in others() {
        let plane = sketch.plane(set, own);
        for piece in others() {
            for row in &sketch.rows[sketch.rows_of(piece / LANES..piece / LANES + 1)] {
                let [x, y, z] = row.map(|column| column[piece % LANES]);
                let [a, b, c] = plane.normal;
                most = most.max((x * a + y * b + z * c - plane.offset).abs());
            }
        }
    }
    most / sketch.slack
}

#[test]
fn what_is_certain_is_so() {
    let mut random = SplitMix64::new(2);
    let mut certain = 0;
    for size in [1.0, 0.1, 1e-3] {
        for tolerance in [0.0, 1e-9, 1e-5] {
            for apart in [0.0, 1e6] {
                let mut polygons = triangles(&mut random, 60, size);
                // Slivers, and neighbours with a shared corner.
                for i in 0..20 {
                    let [a, b, c] = polygons[i];
                    polygons.push([a, b, a + (b - a) * 0.4 + (c - a) * 1e-7]);
                    polygons.push([c, b, a + DVec3::ONE * size]);
                }
                let moved: Vec<_> =
                    polygons.iter().map(|p| p.map(|c| c + DVec3::splat(apart))).collect();
                let name = format!("{size}, within {tolerance}, at {apart}");
                certain += assert_certain(&name, &Fixture::new(&moved, tolerance));
            }
        }
    }
    assert!(certain > 20_000, "{certain}");
    // Noise far below the slack, and around it.
    for height in [0.0, 1e-14, 1e-10, 1e-7, 3e-7, 1e-6, 1e-5] {
        let mut random = SplitMix64::new(3);
        let polygons = grid(5, |_| height * random.point(-1.0, 1.0).x);
        for tolerance in [0.0, 1e-10, 1e-7, 1e-5] {
            let name = format!("a plane with {height} of noise, within {tolerance}");
            assert_certain(&name, &Fixture::new(&polygons, tolerance));
        }
    }
}

/// Small pieces of large faces: their planes are as certain as the planes of small faces.
#[test]
fn small_pieces_of_large_faces_are_as_certain() {
    let mut random = SplitMix64::new(4);
    let mut certain = 0;
    for round in 0..100 {
        let size = [1e-2, 1e-4, 1e-6][round % 3];
        let mut near = || random.point(-size, size);
        let mut polygons: Vec<_> = (0..10)
            .map(|_| {
                [near() - DVec3::new(1.0, 0.1, 0.3), near() - DVec3::new(0.2, 1.0, 0.7), near()]
            })
            .collect();
        // Pieces in the planes of those faces: nothing is certain for them.
        for i in 0..10 {
            let [a, b, c] = polygons[i];
            polygons.push([c, c + (a - c) * 1e-3, c + (b - c) * 1e-3]);
        }
        polygons.push([DVec3::NEG_ONE * size, DVec3::X * size, DVec3::Y * size]);
        let mut fixture = Fixture::new(&polygons, 0.0);
        let around = fixture.faces.corner_range(20).start as u32;
        for axis in 0..3 {
            fixture.keep(PlaneId::axis(axis, around), Side::Front);
        }
        certain += assert_certain(&format!("round {round}"), &fixture);
    }
    assert!(certain > 1000, "{certain}");
}

#[test]
fn counts_are_those_of_a_plain_loop() {
    let mut random = SplitMix64::new(5);
    for n in (1..14).chain([100]) {
        let mut polygons = triangles(&mut random, n, 0.7);
        polygons.truncate(n);
        let fixture = Fixture::new(&polygons, 0.0);
        let set = fixture.set();
        let sketch = sketched(&set);
        for own in 0..n {
            let plane = sketch.plane(&set, own);
            let prepared = set.prepare(set.own_plane(own));
            for first in 0..sketch.groups() {
                let counts = sketch.count(&plane, first..sketch.groups());
                let sides = (first * LANES..n).map(|piece| set.classify(&prepared, piece));
                let sides: Vec<_> = sides.collect();
                let count = |side| sides.iter().filter(|&&other| other == side).count() as u32;
                let expected = [Side::Front, Side::Back, Side::Spanning].map(count);
                assert_eq!([counts.front, counts.back, counts.splits], expected, "{n}: {own}");
            }
        }
        let last = sketch.lanes(sketch.groups() - 1);
        assert_eq!(last.count_ones() as usize, (n - 1) % LANES + 1, "{n}");
    }
}

/// A wall that is much longer than it is high: its length alone decides the rounding.
#[test]
fn rounding_makes_nothing_certain_in_a_flat_box() {
    let mut random = SplitMix64::new(6);
    for round in 0..20 {
        let mut along = || random.range(1.0, 4.0) * 1e12;
        let along = DVec3::new(along(), along(), 0.0).round();
        let mut at = || {
            let [i, j] = [(); 2].map(|()| (random.next() % 201) as f64 - 100.0);
            along * i + DVec3::Z * 1e6 * j
        };
        let polygons: Vec<_> = (0..60)
            .map(|_| [(); 3].map(|()| at()))
            .filter(|[a, b, c]| (b - a).cross(c - a) != DVec3::ZERO)
            .collect();
        assert_certain(&format!("wall {round}"), &Fixture::new(&polygons, 0.0));
    }
}
