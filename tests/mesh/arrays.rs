//! Compares the arrays of all fragments with the fragments one by one, and with the given polygons.

use binspace::mesh::FragmentArrays;
use proptest::test_runner::TestCaseError;
use testkit::prelude::*;

/// The part of an array that belongs to an item, by the offsets of the items.
fn part<'a, T>(array: &'a [T], offsets: &[u32], item: usize) -> &'a [T] {
    &array[offsets[item] as usize..offsets[item + 1] as usize]
}

/// The weights of a vertex with their corners.
fn weights<T: Copy>(arrays: &FragmentArrays<T>, vertex: usize) -> Vec<(u32, T)> {
    let corners = part(&arrays.weight_corners, &arrays.weight_offsets, vertex);
    let weights = part(&arrays.weights, &arrays.weight_offsets, vertex);
    corners.iter().copied().zip(weights.iter().copied()).collect()
}

/// The numbers of each fragment, bit for bit.
fn assert_copied(tree: &BspTree) {
    let (double, single) = (tree.arrays().expect("room"), tree.arrays_f32().expect("room"));
    assert_eq!(double.offsets.len(), tree.len() + 1);
    assert_eq!(double.weight_offsets.len(), double.vertices.len() + 1);
    assert_eq!(double.edges.len(), double.vertices.len());
    assert_eq!(double.offsets.last().copied(), Some(double.vertices.len() as u32));
    assert_eq!(double.weight_offsets.last().copied(), Some(double.weights.len() as u32));
    assert_eq!(double.weight_corners.len(), double.weights.len());
    let mut vertex = 0;
    for (i, fragment) in tree.fragments().enumerate() {
        assert_eq!(double.polygons[i] as usize, fragment.polygon());
        let vertices: Vec<[f64; 3]> = fragment.vertices().map(DVec3::into).collect();
        assert_eq!(part(&double.vertices, &double.offsets, i), vertices);
        let edges: Vec<i32> =
            fragment.edges().map(|edge| edge.map_or(-1, |edge| edge as i32)).collect();
        assert_eq!(part(&double.edges, &double.offsets, i), edges);
        for expected in fragment.weights() {
            assert_eq!(weights(&double, vertex), expected[..]);
            vertex += 1;
        }
    }
    assert_eq!(vertex, double.vertices.len());
    // Single precision is the same, rounded.
    let rounded: Vec<[f32; 3]> = double.vertices.iter().map(|p| p.map(|c| c as f32)).collect();
    assert_eq!(single.vertices, rounded);
    let rounded: Vec<f32> = double.weights.iter().map(|&weight| weight as f32).collect();
    assert_eq!(single.weights, rounded);
    let whole =
        |a: &FragmentArrays<f64>| [a.offsets.clone(), a.polygons.clone(), a.weight_offsets.clone()];
    assert_eq!(
        whole(&double),
        [single.offsets.clone(), single.polygons.clone(), single.weight_offsets.clone()]
    );
    assert_eq!((double.edges, double.weight_corners), (single.edges, single.weight_corners));
}

/// Checks each vertex against the weighted sum of the polygon's given corners, in rationals. Returns the
/// number of vertices with one weight, two, and three.
fn sums(tree: &BspTree, polygons: &[Corners]) -> Result<[usize; 3], TestCaseError> {
    let arrays = tree.arrays().expect("room");
    let lattice = tree.faces().lattice();
    let moved = 2.0 * lattice.length_to_world(tree.faces().tolerance());
    let mut counts = [0; 3];
    for (i, &polygon) in arrays.polygons.iter().enumerate() {
        let corners = &polygons[polygon as usize];
        let size = corners.iter().fold(0.0, |m: f64, c| m.max(c.abs().max_element()));
        let allowed =
            8.0 * (moved + lattice.length_to_world(1.0) + size * f64::EPSILON + f64::from_bits(1));
        for vertex in arrays.offsets[i] as usize..arrays.offsets[i + 1] as usize {
            let weights = weights(&arrays, vertex);
            counts[weights.len() - 1] += 1;
            let largest = weights.iter().fold(1.0, |m: f64, (_, weight)| m.max(weight.abs()));
            let total = rational::total(weights.iter().map(|&(_, w)| rational::exact(w)));
            let off = (total - rational::exact(1.0)).abs();
            proptest::prop_assert!(off <= rational::exact(1e-12), "{weights:?}");
            for (axis, &found) in arrays.vertices[vertex].iter().enumerate() {
                let terms = weights.iter().map(|&(k, weight)| {
                    rational::exact(weight) * rational::exact(corners[k as usize][axis])
                });
                let sum = rational::total(terms);
                let off = (sum - rational::exact(found)).abs();
                proptest::prop_assert!(
                    off <= rational::exact(allowed * largest),
                    "{weights:?} are not {:?}",
                    arrays.vertices[vertex]
                );
            }
        }
    }
    Ok(counts)
}

#[test]
fn arrays_have_the_numbers_of_all_fragments() {
    for scene in [scene::city(600, 1), scene::random_triangles(150, 2), scene::sphere(300)] {
        for by in [Heuristic::Auto, Heuristic::First, Heuristic::FreePlanes] {
            let options = BuildOptions::DEFAULT.with_heuristic(by);
            assert_copied(&options.build(scene.polygons()).expect("a tree"));
        }
    }
    // Frames store the positions of their vertices.
    let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
    assert_copied(builder.build(scene::random_triangles(150, 2).polygons()).expect("a tree"));
    // Without fragments, only the end of the offsets remains.
    let arrays = BspTree::build([[[0.0; 3]; 3]; 0]).expect("a tree").arrays().expect("room");
    assert_eq!((arrays.offsets, arrays.weight_offsets), (vec![0], vec![0]));
}

#[test]
fn weights_give_the_vertices_back_from_the_given_corners() {
    let strategy = (hard::scene(), hard::heuristic());
    let counts: [usize; 3] = tally(file!(), 192, strategy, |seen: &mut [usize; 3], (scene, by)| {
        let tree = scene.build(by).map_err(fail)?;
        assert_copied(&tree);
        let counts = sums(&tree, &scene.polygons)?;
        seen.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
        Ok(())
    });
    enough!(counts[0] > 2000, counts[1] > 500, counts[2] > 20; "{counts:?}");
}

/// A hand-drawn case: a square that is cut in two by the plane of an upright square.
#[test]
fn a_square_cut_in_two() {
    let flat = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let upright = [[0.5, -1.0, -1.0], [0.5, 1.0, -1.0], [0.5, 1.0, 1.0], [0.5, -1.0, 1.0]];
    let by = Heuristic::First;
    let tree = BuildOptions::DEFAULT.with_heuristic(by).build([upright, flat]).expect("a tree");
    let arrays = tree.arrays_f32().expect("room");
    let front = arrays.polygons.iter().enumerate().position(|(i, &polygon)| {
        polygon == 1 && part(&arrays.vertices, &arrays.offsets, i).iter().any(|p| p[0] == 1.0)
    });
    let front = front.expect("the part beyond the upright square");
    let mut found: Vec<_> = (arrays.offsets[front] as usize..arrays.offsets[front + 1] as usize)
        .map(|v| {
            (
                arrays.vertices[v].map(|c| c.to_string()).join(" "),
                arrays.edges[v],
                weights(&arrays, v),
            )
        })
        .collect();
    found.sort_by(|a, b| a.0.cmp(&b.0));
    let expected = [
        ("0.5 -1 0", 0, vec![(0, 0.25), (1, 0.75)]),
        ("0.5 1 0", -1, vec![(2, 0.75), (3, 0.25)]),
        ("1 -1 0", 1, vec![(1, 1.0)]),
        ("1 1 0", 2, vec![(2, 1.0)]),
    ];
    let expected = expected.map(|(place, edge, weights)| (place.to_owned(), edge, weights));
    assert_eq!(found, expected);
}
