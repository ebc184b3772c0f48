//! Compares each heuristic with its documentation, at every node, by brute force in exact rationals. Scenes
//! have integer coordinates, so that the cuts of a plane are certain.

mod divided;
mod given;
mod trials;

use binspace::internals::PlaneKind;
use divided::{Counts, Divided, Row, nodes, work};
use testkit::prelude::*;
use testkit::shapes;

/// A scene of one of several kinds, on a small lattice.
fn scene(dice: &mut Dice, count: usize) -> Vec<Corners> {
    let wide = 2 + dice.below(8) as u32;
    let kind = dice.below(3);
    let point = |dice: &mut Dice| dice.whole_point(wide);
    (0..count)
        .map(|_| match kind {
            0 => vec![point(dice), point(dice), point(dice)],
            1 => {
                // Small polygons at a distance from each other, so that free planes cut nothing.
                let at = point(dice) * 4.0;
                [0; 3].map(|_| at + point(dice) / 4.0).to_vec()
            }
            _ => {
                // Squares perpendicular to an axis.
                let (at, axis) = (point(dice), dice.below(3));
                let square = shapes::square(binspace::glam::DMat3::IDENTITY, DVec3::ZERO);
                let turned = |p: DVec3| {
                    let mut turned = [p.x, p.y, p.z];
                    turned.rotate_right(2 - axis);
                    DVec3::from_array(turned) + at
                };
                square.into_iter().map(turned).collect()
            }
        })
        .collect()
}

fn build(scene: &[Corners], by: Heuristic) -> BspTree {
    BuildOptions::DEFAULT.with_heuristic(by).with_tolerance(0.0).build(scene).expect("finite")
}

/// Visits the nodes of trees of many scenes that divide at least two pieces; returns their number.
fn each(by: Heuristic, scenes: u64, count: usize, mut visit: impl FnMut(&Divided<'_>)) -> usize {
    let mut found = 0;
    for seed in 0..scenes {
        let scene = scene(&mut Dice(seed), 2 + (seed as usize * 5) % count);
        nodes(&build(&scene, by), |node| {
            if node.set.len() >= 2 {
                visit(node);
                found += 1;
            }
        });
    }
    found
}

fn assert_least(by: Heuristic, score: impl Fn(&Counts, bool) -> f64) {
    let mut choices = 0;
    let found = each(by, 24, 14, |node| {
        let [chosen, least] = node.scores(&score);
        assert!(chosen <= least + 1e-9, "{by}: {chosen}, not {least}, by {:?}", node.plane);
        let most = node.own_planes().map(|(c, axial)| score(&c, axial)).fold(-1e300, f64::max);
        choices += usize::from(most > least);
    });
    // If all planes have equal scores, the test shows nothing.
    enough!(found > 150, choices > 80; "{by}: {found} nodes, {choices} choices");
}

#[test]
fn first_takes_the_plane_of_the_first_polygon() {
    let mut later = 0;
    let found = each(Heuristic::First, 24, 14, |node| {
        let first = node.set.iter().map(|piece| piece.face).min().expect("a piece");
        assert_eq!(node.plane, PlaneId::face(first));
        later += usize::from(node.set[0].face != first || first > 0);
    });
    enough!(found > 150, later > 100; "{found} {later}");
}

#[test]
fn random_takes_a_polygon_s_plane_that_only_the_seed_decides() {
    let planes = |seed: u64| {
        let mut planes = Vec::new();
        each(Heuristic::Random { seed }, 16, 12, |node| {
            let PlaneKind::Face(face) = node.plane.kind() else { panic!("{:?}", node.plane) };
            assert!(node.set.iter().any(|piece| piece.face == face));
            planes.push(face);
        });
        enough!(planes.len() > 100; "{}", planes.len());
        planes
    };
    let some: Vec<Vec<u32>> = (0..6).map(planes).collect();
    assert_eq!(some[3], planes(3));
    for (i, a) in some.iter().enumerate() {
        assert!(some[..i].iter().all(|b| a != b), "seed {i}");
    }
    // Over many seeds, each polygon of a set is chosen: none is left out.
    let scene: Vec<Corners> = scene(&mut Dice(4), 5);
    let mut counts = [0; 5];
    for seed in seeds(200) {
        let tree = build(&scene, Heuristic::Random { seed });
        let plane = tree.root().expect("a node").plane();
        let PlaneKind::Face(face) = plane.kind() else { panic!("{plane:?}") };
        counts[face as usize] += 1;
    }
    assert!(counts.iter().all(|&count| count >= 20), "{counts:?}");
}

#[test]
fn fewest_splits_takes_a_plane_with_the_fewest_cuts() {
    assert_least(Heuristic::FewestSplits, |c, _| c.splits as f64 * 1e3 + c.imbalance());
}

#[test]
fn balanced_takes_a_most_evenly_dividing_plane() {
    assert_least(Heuristic::Balanced, |c, _| c.imbalance() * 1e3 + c.splits as f64);
}

#[test]
fn weighted_takes_a_plane_of_least_weighted_sum() {
    for (splits, balance) in [(8.0, 1.0), (1.0, 3.0), (0.0, 1.0), (1.0, 0.0), (2.0, -1.0)] {
        for axial in [0.0, 0.5, -2.0] {
            let by = Heuristic::Weighted { splits, balance, axial };
            let mut choices = 0;
            let found = each(by, 9, 12, |node| {
                let reward = axial * node.set.len() as f64;
                let score = |c: &Counts, is_axial: bool| {
                    let bonus = if is_axial { reward } else { 0.0 };
                    splits * c.splits as f64 + balance * c.imbalance() - bonus
                };
                let [chosen, least] = node.scores(score);
                assert!(chosen <= least + 1e-9, "{by}: {chosen}, not {least}");
                choices += usize::from(node.own_planes().any(|(c, a)| score(&c, a) > least));
            });
            enough!(found > 40, choices > 15; "{by}: {found} nodes, {choices} choices");
        }
    }
}

#[test]
fn sampled_from_all_planes_takes_one_of_least_weighted_sum() {
    assert_least(Heuristic::Sampled { candidates: 1000 }, |c, _| {
        8.0 * c.splits as f64 + c.imbalance()
    });
}

/// With one candidate there is no choice; with more, some choice is better.
#[test]
fn sampled_tries_as_many_planes_as_its_parameter() {
    let sum = |candidates: u32| {
        let mut sum = 0.0;
        each(Heuristic::Sampled { candidates }, 16, 14, |node| {
            sum += 8.0 * node.counts.splits as f64;
        });
        sum
    };
    assert!(sum(1) > 1.2 * sum(32), "{} {}", sum(1), sum(32));
}

#[test]
fn free_planes_are_taken_wherever_one_cuts_nothing_and_cost_little() {
    let (mut free, mut own, mut clean, mut missed) = (0, 0, 0, 0);
    each(Heuristic::FreePlanes, 40, 20, |node| {
        let planes = node.free_planes();
        let key = |c: &Counts| (c.splits > 0, c.work());
        match node.plane.kind() {
            PlaneKind::Face(_) => {
                let Counts { front, back, splits } = node.counts;
                let is_flat = front + back + splits == 0;
                let all_cut = planes.iter().all(|counts| counts.splits > 0);
                assert!(all_cut || is_flat, "{} pieces, {planes:?}", node.set.len());
                own += 1;
                missed += usize::from(!planes.is_empty() && !is_flat);
            }
            PlaneKind::Axis(..) => {
                assert!(node.counts.separates(node.set.len()), "{:?}", node.counts);
                let least =
                    planes.iter().map(key).min_by(|a, b| a.partial_cmp(b).expect("numbers"));
                let chosen = key(&node.counts);
                // The list may lack a plane that cuts nothing, because it may go through a corner that was
                // cut off.
                let least = least.unwrap_or(chosen);
                // The search stops at a plane that cuts nothing and leaves a quarter on each side.
                let n = node.set.len();
                let enough = chosen.1 <= work(n / 4) + work(n - n / 4) + 1e-9;
                // The border of two bins is near the best plane, but not always next to it.
                let fits = chosen.1 <= least.1 * 1.5 || !chosen.0 && enough;
                assert!(chosen.0 <= least.0 && fits, "{chosen:?}, not {least:?}, of {n}");
                free += 1;
                clean += usize::from(!chosen.0);
            }
        }
    });
    assert!(free > 150 && own > 30 && clean > 50 && clean < free, "{free} {own} {clean}");
    assert!(20 * missed < free, "{missed} of {free}");
}

/// Below and above the sizes at which `auto` changes its search.
#[test]
fn auto_cuts_nothing_wherever_a_free_plane_cuts_nothing() {
    let (mut clean, mut cut) = (0, 0);
    let (mut clean_of_frames, mut needed) = (0, 0);
    for count in [40, 63, 64, 65, 210, 255, 256, 257] {
        for seed in [1, 2, 4] {
            // Some polygons have no area.
            let mut scene = scene(&mut Dice(seed), count + count / 4);
            scene.retain(|polygon| {
                build(std::slice::from_ref(polygon), Heuristic::First).len() == 1
            });
            scene.truncate(count);
            let tree = build(&scene, Heuristic::Auto);
            assert_eq!(tree.faces().len(), count);
            let has_clean = |node: &Divided<'_>| node.free_planes().iter().any(|c| c.splits == 0);
            nodes(&tree, |node| {
                let cuts = node.counts.splits > 0;
                if has_clean(node) {
                    assert!(!cuts, "{} pieces, seed {seed}", node.set.len());
                    clean += 1;
                } else {
                    cut += usize::from(cuts);
                }
            });
            // In a frame, a plane that cuts only crossing pieces may divide small sets.
            let mut builder = FrameBuilder::new(BuildOptions::DEFAULT.with_tolerance(0.0));
            nodes(builder.build(&scene).expect("a tree"), |node| {
                if has_clean(node) {
                    let cuts = node.counts.splits > 0;
                    let is_needed = || node.set.len() <= 255 && node.cuts_what_crosses();
                    assert!(!cuts || is_needed(), "{} pieces, seed {seed}", node.set.len());
                    clean_of_frames += 1;
                    needed += usize::from(cuts);
                }
            });
        }
    }
    enough!(clean > 2000, cut > 50; "{clean} {cut}");
    enough!(clean_of_frames > 2000, needed > 10; "{clean_of_frames} {needed}");
}

/// If every plane cuts, `auto` uses one of the own planes with the least work less the reward, or in sets of 64 or
/// more an axis plane that is no worse: the first of them if many planes cut, otherwise one of four by the cuts that follow. In a
/// frame it may also use a plane that cuts one or two pieces which cross its own piece.
#[test]
fn auto_takes_an_own_plane_of_little_cost_where_every_plane_cuts() {
    let (mut cut, mut dense, mut by_cuts, mut rewarded) = ([0; 2], 0, 0, 0);
    let (mut crossings, mut axial) = (0, 0);
    for (seed, of_frame) in (0..seeds(360).end).flat_map(|seed| [(seed, false), (seed, true)]) {
        let dice = &mut Dice(seed);
        let scene = match seed % 8 {
            // A crowd, of which each plane cuts little.
            0 => (0..if dice.below(2) == 0 { 60 } else { 80 })
                .map(|_| {
                    let at = dice.whole_point(16);
                    [0; 3].map(|_| at + dice.whole_point(4)).to_vec()
                })
                .collect(),
            _ => scene(dice, 4 + seed as usize % 13),
        };
        let mut builder = FrameBuilder::new(BuildOptions::DEFAULT.with_tolerance(0.0));
        let tree = build(&scene, Heuristic::Auto);
        let tree = if of_frame { builder.build(&scene).expect("a tree") } else { &tree };
        let mut is_root = true;
        nodes(tree, |node| {
            if !std::mem::take(&mut is_root) || node.counts.splits == 0 {
                return;
            }
            if of_frame && node.counts.splits <= 2 && node.cuts_what_crosses() {
                crossings += 1;
                return;
            }
            assert!(node.own_planes().all(|(counts, _)| counts.splits > 0), "seed {seed}");
            let (rows, density) = node.rows();
            let by_amount = |a: &&Row, b: &&Row| a.amount.total_cmp(&b.amount);
            let mut sorted: Vec<&Row> = rows.iter().collect();
            sorted.sort_by(|a, b| by_amount(a, b));
            let is_dense = density >= 0.2;
            let most = sorted[if is_dense { 0 } else { sorted.len().min(4) - 1 }].amount;
            let PlaneKind::Face(face) = node.plane.kind() else {
                assert!(node.counts.work() <= most + 1e-9, "seed {seed}: {:?}", node.counts);
                assert!(node.set.len() >= 64, "seed {seed}");
                axial += 1;
                return;
            };
            let at = node.set.iter().position(|piece| piece.face == face).expect("a piece");
            let chosen = &rows[at];
            assert!(chosen.amount <= most + 1e-9, "seed {seed}: {}, not {most}", chosen.amount);
            // If no axis plane comes before the first, that is one of the four.
            let least_of_axes = node.free_planes().iter().map(Counts::work).fold(1e300, f64::min);
            if !is_dense && sorted[0].amount < least_of_axes {
                let first = sorted[0].cuts;
                assert!(chosen.cuts <= first + 1e-9, "seed {seed}: {}, not {first}", chosen.cuts);
            }
            by_cuts += usize::from(chosen.amount > sorted[0].amount + 1e-9);
            cut[usize::from(of_frame)] += 1;
            dense += usize::from(is_dense);
            rewarded += usize::from(rows.iter().any(|row| row.work < chosen.work - 1e-9));
        });
    }
    enough!(cut[0] > 50, cut[1] > 25, rewarded > 5; "{cut:?} {rewarded}");
    enough!(crossings > 20, axial > 0, dense > 10, by_cuts > 0; "{crossings} {axial} {dense} {by_cuts}");
}

/// Squares of z = x² + y² over a grid of integers: exactly planar, in exactly convex position.
fn bowl(across: i32) -> Vec<Corners> {
    let at = |x: i32, y: i32| DVec3::new(x.into(), y.into(), (x * x + y * y).into());
    let half = across / 2;
    let cells = (-half..across - half).flat_map(|x| (-half..across - half).map(move |y| (x, y)));
    cells.map(|(x, y)| vec![at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]).collect()
}

#[test]
fn auto_never_cuts_sets_in_convex_position() {
    for across in [2, 5, 14, 15, 25, 40] {
        for shear in [0.0, 1.0, 3.0] {
            // After shearing, no free plane follows the bowl.
            let place = |p: DVec3| DVec3::new(p.x + shear * p.z, p.y - shear * p.x, p.z);
            let scene: Vec<Corners> =
                bowl(across).into_iter().map(|p| p.into_iter().map(place).collect()).collect();
            let tree = build(&scene, Heuristic::Auto);
            assert_eq!(tree.len(), scene.len(), "{across}, {shear}");
        }
    }
}
