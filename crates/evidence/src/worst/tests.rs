//! Fragments counted against the formulas, and against growth by a factor.

use super::Worst;
use crate::Hiding;
use testkit::prelude::*;

/// The heuristics that take the polygons' own planes only.
const OWN: [Heuristic; 6] = [
    Heuristic::First,
    Heuristic::Random { seed: 7 },
    Heuristic::FewestSplits,
    Heuristic::Balanced,
    Heuristic::Weighted { splits: 8.0, balance: 1.0, axial: 0.0 },
    Heuristic::Sampled { candidates: 16 },
];

fn tree(worst: Worst, count: u32, heuristic: Heuristic) -> BspTree {
    let options = BuildOptions::DEFAULT.with_heuristic(heuristic).with_tolerance(0.0);
    options.build(worst.scene(count).polygons()).unwrap()
}

#[test]
fn nothing_is_rounded_and_all_is_flat() {
    for worst in Worst::ALL {
        for count in [2, 6, 14, 50] {
            let scene = worst.scene(count);
            let (faces, _) = Faces::new(scene.polygons(), Some(0.0)).unwrap();
            // A polygon that is not exactly planar would be two triangles.
            assert_eq!((scene.len(), faces.len()), (count as usize, count as usize), "{worst}");
            for face in 0..faces.len() as u32 {
                for (corner, given) in faces.corners(face).iter().zip(scene.polygon(face as usize))
                {
                    assert_eq!(faces.lattice().to_world(*corner), *given, "{worst}");
                }
            }
        }
    }
}

#[test]
fn every_tree_of_own_planes_has_the_fragments_of_the_formula() {
    let mut counted = 0;
    for (worst, counts) in
        [(Worst::Walls, [2, 10, 60]), (Worst::Saddle, [2, 10, 60]), (Worst::Sheets, [3, 9, 24])]
    {
        for count in counts {
            let expected = worst.fragments(count);
            for heuristic in OWN {
                let found = tree(worst, count, heuristic).len() as u64;
                assert_eq!(found, expected, "{worst} {count} {heuristic}");
                counted += 1;
            }
        }
    }
    assert_eq!(counted, 54);
}

/// Counts the cells between sheets in another way. Each cell has its own row of signs: its sides of all
/// sheets. All rows occur at points near the corners of the arrangement.
#[test]
fn sheets_have_as_many_cells_as_rows_of_signs() {
    for count in 1..9u32 {
        let roots: Vec<i64> = (0..i64::from(count)).map(|k| 8 * k).collect();
        // The signs of a cubic at the roots of the sheets are determined by the places of its three real
        // roots among them. A pair of complex roots changes no sign.
        let gaps: Vec<i64> = (0..=i64::from(count)).map(|k| 8 * k - 4).collect();
        let signs = |own: &[i64]| -> Vec<bool> {
            roots.iter().map(|t| own.iter().map(|r| t - r).product::<i64>() > 0).collect()
        };
        let mut rows = std::collections::HashSet::new();
        for a in &gaps {
            for b in &gaps {
                for c in &gaps {
                    rows.insert(signs(&[*a, *b, *c]));
                }
            }
        }
        let leaves = Worst::Sheets.fragments(count) + 1;
        assert_eq!(rows.len() as u64, leaves, "{count}");
    }
}

#[test]
fn strips_on_a_saddle_grow_by_the_square_whatever_the_planes() {
    for &heuristic in Heuristic::ALL {
        let [small, large] = [32, 64].map(|count| tree(Worst::Saddle, count, heuristic).len());
        let cuts = [small - 32, large - 64];
        assert!(cuts[1] >= 3 * cuts[0], "{heuristic}: {cuts:?}");
        assert!(cuts[0] >= 16 * 16 / 4, "{heuristic}: {cuts:?}");
    }
}

#[test]
fn a_plane_between_the_walls_saves_all_cuts() {
    for heuristic in [Heuristic::Auto, Heuristic::FreePlanes] {
        assert_eq!(tree(Worst::Walls, 60, heuristic).len(), 60, "{heuristic}");
    }
}

#[test]
fn sheets_all_cross_and_nothing_else_does() {
    for direction in [[0.2, 0.3, -1.0], [-1.0, 0.4, -0.7], [0.9, 1.0, 0.6]] {
        let mutual = |worst: Worst| {
            let (faces, _) = Faces::new(worst.scene(12).polygons(), Some(0.0)).unwrap();
            Hiding::of(&faces, Viewpoint::direction(direction)).mutual()
        };
        assert_eq!([Worst::Walls, Worst::Saddle].map(mutual), [0, 0]);
        assert_eq!(mutual(Worst::Sheets), 12 * 11 / 2);
    }
}
