//! Removes the crossings of a polygon that crosses itself.
//!
//! Two edges that cross are replaced by two edges between the same four ends that do not cross.
//! There are two ways to do that; the one that changes less of the inside, by the even-odd rule, is
//! taken. So the result covers somewhat more or less than the outline near a crossing, and exactly
//! the inside by the even-odd rule everywhere else. Two edges that cross are longer than the two
//! that replace them, so the process ends. It may take long (van Leeuwen and Schoone, “Untangling a
//! travelling salesman tour in the plane”, 1981), so there is a budget. If it runs out, or if
//! nothing is left inside, the triangles fan out from the first corner.

use super::arrange::ArrangementSweep;
use super::arrangement::{Arrangement, Rule};
use super::edge::{Edge, Point, area};
use crate::Error;
use crate::progress::Watch;

/// Search budget of small polygons, in edges swept. Smaller: tangles of some hundred corners become
/// fans; larger: each of them takes longer.
pub(super) const PATIENCE: usize = 1 << 17;
/// Search budget of large polygons, in sweeps. Smaller: outlines with some crossings in a row
/// become fans; larger: tangles take longer.
const SWEEPS: usize = 16;

/// Replaces edges that cross until none do; what is inside is defined by [`Rule::Parity`]. `None`
/// if the budget runs out.
pub(super) fn uncross(
    points: &[Point],
    mut edges: Vec<Edge>,
    watch: &Watch<'_>,
) -> Result<Option<Arrangement>, Error> {
    let mut budget = PATIENCE.max(SWEEPS * edges.len());
    while let Some(left) = budget.checked_sub(edges.len()) {
        budget = left;
        let Some(sweep) = ArrangementSweep::new(points, &edges, Rule::Parity).run(false, watch)?
        else {
            return Ok(None);
        };
        if sweep.crossings.is_empty() {
            return Ok(Some(sweep.finish()));
        }
        edges.clear();
        edges.extend(sweep.uncrossed());
        for pair in &sweep.crossings {
            edges.extend(rejoined(points, pair.map(|edge| *sweep.edge(edge))));
        }
    }
    Ok(None)
}

/// Two edges that do not cross, between the ends of two that do.
fn rejoined(points: &[Point], [first, second]: [Edge; 2]) -> [Edge; 2] {
    let nearer_to_low = |edge: &Edge, other: &Edge| {
        let [c, d] = other.ends.map(|end| points[end as usize]);
        let [low, high] = edge.ends.map(|end| area(c, d, points[end as usize]).abs());
        low < high
    };
    let end = |edge: &Edge, end: usize| (edge.corners[end], edge.ends[end]);
    let [a, b] = [0, 1].map(|k| end(&first, k));
    let [c, d] = [0, 1].map(|k| end(&second, k));
    // The crossing and the four ends form four triangles. Each of the two ways changes the inside
    // of two of them. As shares of all four, these have the areas t·u + (1 − t)(1 − u) and t(1 − u)
    // + u(1 − t), where the crossing is at t between a and b and at u between c and d. The first is
    // smaller if just one of t and u is below 1/2.
    if nearer_to_low(&first, &second) == nearer_to_low(&second, &first) {
        [Edge::between(a, d), Edge::between(c, b)]
    } else {
        [Edge::between(a, c), Edge::between(b, d)]
    }
}
