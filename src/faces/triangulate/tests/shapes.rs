//! Outlines to triangulate.

use super::super::sweep::{Point, turn};
use crate::random::SplitMix64;

/// Corners anywhere in a square.
pub(super) fn random_points(n: usize, size: i64, random: &mut SplitMix64) -> Vec<Point> {
    let mut coordinate = || (random.next() >> 11) as i64 % size;
    (0..n).map(|_| [coordinate(), coordinate()]).collect()
}

/// A family of polygons that do not cross themselves.
#[derive(Clone, Copy, Debug)]
pub(super) enum Family {
    Star,
    Monotone,
    Untangled,
    Spiral,
    Comb,
    Zigzag,
}

impl Family {
    pub(super) const ALL: [Self; 6] =
        [Self::Star, Self::Monotone, Self::Untangled, Self::Spiral, Self::Comb, Self::Zigzag];
}

/// A polygon of about `n` corners that does not cross itself.
pub(super) fn simple(shape: Family, n: usize, random: &mut SplitMix64) -> Vec<Point> {
    match shape {
        Family::Star => star(n, random),
        Family::Monotone => monotone(n, random),
        Family::Untangled => untangled(n.min(40), random),
        Family::Spiral => square_spiral(n),
        Family::Comb => comb(n),
        Family::Zigzag => zigzag(n),
    }
}

/// Large polygons, on which ear clipping takes long.
pub(super) fn large(n: usize) -> Vec<(&'static str, Vec<Point>)> {
    let mut random = SplitMix64::new(5);
    vec![
        ("square spiral", square_spiral(n)),
        ("round spiral", round_spiral(n)),
        ("comb", comb(n)),
        ("zigzag", zigzag(n)),
        ("star", star(n, &mut random)),
        ("monotone", monotone(n, &mut random)),
    ]
}

/// Corners at rising angles around the origin, near or far.
fn star(n: usize, random: &mut SplitMix64) -> Vec<Point> {
    let corner = |k: usize, radius: f64| {
        let (sin, cos) = (k as f64 / n as f64 * std::f64::consts::TAU).sin_cos();
        [cos, sin].map(|c| (c * radius * 1e12) as i64)
    };
    (0..n).map(|k| corner(k, random.range(0.1, 1.0))).collect()
}

/// An upper and a lower side, each rising in x.
fn monotone(n: usize, random: &mut SplitMix64) -> Vec<Point> {
    let half = n as i64 / 2;
    let mut side = |up: i64| -> Vec<Point> {
        (1..half).map(|x| [x, up * (1 + (random.next() >> 40) as i64)]).collect()
    };
    let (lower, upper) = (side(-1), side(1));
    let ends = [[0, 0], [half, 0]];
    [&ends[..1], &lower, &ends[1..], &upper.into_iter().rev().collect::<Vec<_>>()].concat()
}

/// Random corners, in an order without crossings.
fn untangled(n: usize, random: &mut SplitMix64) -> Vec<Point> {
    loop {
        let mut corners = random_points(n, 1 << 20, random);
        let mut swapped = true;
        while swapped {
            swapped = false;
            for i in 0..n - 2 {
                for j in i + 2..n {
                    let [a, b] = [corners[i], corners[i + 1]];
                    let [c, d] = [corners[j], corners[(j + 1) % n]];
                    let [e, f] = [turn(a, b, c) as i32, turn(a, b, d) as i32];
                    let [g, h] = [turn(c, d, a) as i32, turn(c, d, b) as i32];
                    if e * f < 0 && g * h < 0 {
                        corners[i + 1..=j].reverse();
                        swapped = true;
                    }
                }
            }
        }
        let straight = (0..n).any(|k| {
            let [a, b] = [corners[k], corners[(k + 1) % n]];
            corners.iter().any(|&p| p != a && p != b && turn(a, b, p).is_eq())
        });
        if !straight {
            return corners;
        }
    }
}

/// A corridor of width 1 that turns inwards.
fn square_spiral(n: usize) -> Vec<Point> {
    let turns = (n as i64 / 2).max(4);
    let arm = |inner: i64| {
        (0..turns).map(move |k| {
            let reach = 4 * (turns - k) + 8 - inner;
            match k % 4 {
                0 => [-reach, -reach],
                1 => [reach, -reach - 4 + 2 * inner],
                2 => [reach, reach],
                _ => [-reach - 4 + 2 * inner, reach],
            }
        })
    };
    let back: Vec<Point> = arm(1).collect();
    arm(0).chain(back.into_iter().rev()).collect()
}

fn round_spiral(n: usize) -> Vec<Point> {
    let half = n / 2;
    let corner = |k: usize, shift: f64| {
        let angle = 2.0 * (k as f64).sqrt();
        let (sin, cos) = angle.sin_cos();
        [cos, sin].map(|c| (c * 1e4 * (angle + shift)).round() as i64)
    };
    let out = (50..50 + half).map(|k| corner(k, 0.0));
    out.chain((50..50 + half).rev().map(|k| corner(k, 2.5))).collect()
}

/// Teeth side by side.
fn comb(n: usize) -> Vec<Point> {
    let teeth = (n as i64 - 2) / 2;
    let tips = (0..teeth).rev().flat_map(|k| [[2 * k + 1, 1000 + k % 7], [2 * k, 3 - k % 3]]);
    [[0, 0], [2 * teeth, 0]].into_iter().chain(tips).collect()
}

/// A band that goes up and down.
fn zigzag(n: usize) -> Vec<Point> {
    let half = n as i64 / 2;
    let side = |up: i64| (0..half).map(move |k| [8 * k, 1000 * (k % 2) + up]);
    let upper: Vec<Point> = side(5).collect();
    side(0).chain(upper.into_iter().rev()).collect()
}
