//! Thousands of polygons, which are prepared in parts: what is counted is summed over all parts, and
//! what is named by number is named right in each.

use testkit::prelude::*;

const COUNT: usize = 5000;

/// What a polygon is, by its number.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Flat,
    /// A corner is off the plane of the others by far less than the tolerance.
    NearlyFlat,
    /// A quad off its plane by more than the tolerance, and less than rounding of coarse numbers.
    Crossing,
    NoArea,
}

fn kind(k: usize) -> Kind {
    match k {
        _ if k % 7 == 3 => Kind::NearlyFlat,
        _ if k % 11 == 5 => Kind::Crossing,
        _ if k % 13 == 6 => Kind::NoArea,
        _ => Kind::Flat,
    }
}

fn polygon(k: usize) -> Vec<DVec3> {
    let at = DVec3::new((k % 50) as f64, (k / 50) as f64, (k % 3) as f64);
    let quad = [[0.0, 0.0], [0.75, 0.0], [0.75, 0.75], [0.0, 0.75]];
    let corner = |[x, y]: [f64; 2]| at + DVec3::new(x, y, 0.25 * x);
    let mut corners = quad.map(corner);
    match kind(k) {
        Kind::Flat => {}
        // By a few steps of the grid, and each by others: no polygon's corner could stand for another's.
        Kind::NearlyFlat => corners[2].z += (1024 + k % 97) as f64 * (-40_f64).exp2(),
        Kind::Crossing => corners.swap(1, 2),
        Kind::NoArea => corners[2..].iter_mut().for_each(|corner| *corner = at),
    }
    corners.to_vec()
}

fn assert_right(tree: &BspTree) {
    let count = |of: Kind| (0..COUNT).filter(|&k| kind(k) == of).count();
    let found = tree.preparation();
    assert_eq!(found.polygons, COUNT);
    assert_eq!(found.crossing, count(Kind::Crossing));
    assert_eq!(found.triangulated, count(Kind::Crossing));
    assert_eq!(found.flattened, count(Kind::NearlyFlat));
    assert_eq!(found.dropped, count(Kind::NoArea));
    assert!(tree.dropped().eq((0..COUNT).filter(|&k| kind(k) == Kind::NoArea)));

    // A mesh has the corners as they were given, also those that were moved onto a plane.
    let mesh = tree.mesh().unwrap();
    let mut compared = 0;
    for fragment in tree.fragments().filter(|fragment| fragment.is_whole()) {
        let k = fragment.polygon();
        if kind(k) == Kind::NearlyFlat {
            for vertex in &mesh.triangles().indices()[mesh.triangles().range(fragment.index())] {
                let found = mesh.positions()[*vertex as usize];
                assert!(polygon(k).contains(&found), "{k}: {found} for {:?}", polygon(k));
                compared += 1;
            }
        }
    }
    enough!(compared > 3000; "{compared} corners");
}

#[test]
fn counts_and_moved_corners_of_all_parts_are_right() {
    let options = BuildOptions::DEFAULT
        .with_tolerance(1e-6)
        .with_bounds(DVec3::splat(-200.0), DVec3::splat(200.0));
    let polygons: Vec<Vec<DVec3>> = (0..COUNT).map(polygon).collect();
    assert_right(&options.build(&polygons).unwrap());
    // The rest follows the faces of a finished tree.
    let mut tree = options.build(&polygons[..1500]).unwrap();
    tree.extend(&polygons[1500..]).unwrap();
    assert_right(&tree);
}

/// Quads of coarse coordinates, a little bent.
#[test]
fn bent_quads_of_all_parts_are_counted() {
    let quad = |k: usize| {
        let at = DVec3::new((k % 50) as f64, (k / 50) as f64, 0.0);
        let lift = if k % 5 == 2 { 1e-5 } else { 0.0 };
        [[0.0, 0.0, 0.0], [0.75, 0.0, 0.0], [0.75, 0.75, lift], [0.0, 0.75, 0.0]]
            .map(|corner| (at + DVec3::from(corner)).as_vec3().to_array())
    };
    let options = BuildOptions::DEFAULT.with_tolerance(1e-9);
    let bent = |numbers: std::ops::Range<usize>| {
        let quads: Vec<[[f32; 3]; 4]> = numbers.map(quad).collect();
        let tree = options.build(&quads).unwrap();
        (tree.preparation().bent, tree.preparation().bent_by)
    };
    let (all, by) = bent(0..COUNT);
    // As many as in pieces that are each prepared as one part, but for what rounding is of them.
    assert_eq!(all, COUNT / 5, "bent by {by}");
    assert!(by > 1e-6 && by < 1e-5, "{by}");
}
