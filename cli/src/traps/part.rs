//! Convex parts of paths, under which others may reach.

use binspace::drawing::Path;

use super::{Outline, cross, double_area, sides};

/// Of paths with more corners than this, no triangles are looked for. Larger: time that grows with the
/// cube of it; smaller: seams at polygons that are not convex.
const MOST_CORNERS: usize = 24;

type Segment = [[f64; 2]; 2];

/// Convex parts that together have all sides of a path, each with the sides that it has: the path
/// itself if it is convex, or else a triangle on each side, inside of the path.
pub(super) fn parts_of(path: &Path<'_>) -> Vec<(Outline, Vec<Segment>)> {
    let outlines: Vec<&[[f64; 2]]> = path.outlines().collect();
    if let [only] = outlines[..]
        && is_convex(only)
    {
        return vec![(only.to_vec(), sides(only).collect())];
    }
    let all: Vec<Segment> = outlines.iter().flat_map(|outline| sides(outline)).collect();
    if all.len() > MOST_CORNERS {
        return vec![];
    }
    let turn = outlines.iter().map(|outline| double_area(outline)).sum::<f64>().signum();
    let triangles = all.iter().filter_map(|&side| triangle_on(side, turn, &all));
    triangles.map(|triangle| (triangle.to_vec(), vec![[triangle[0], triangle[1]]])).collect()
}

fn is_convex(outline: &[[f64; 2]]) -> bool {
    let turn = double_area(outline).signum();
    let n = outline.len();
    (0..n).all(|i| turn * area_of([0, 1, 2].map(|k| outline[(i + k) % n])) >= 0.0)
}

/// The highest triangle on a side whose apex is a corner, and which no side enters.
fn triangle_on([a, b]: Segment, turn: f64, sides: &[Segment]) -> Option<[[f64; 2]; 3]> {
    let area = |p: [f64; 2]| turn * area_of([a, b, p]);
    let mut apexes: Vec<[f64; 2]> = sides.iter().map(|side| side[0]).collect();
    apexes.retain(|&apex| area(apex) > 0.0);
    apexes.sort_by(|&p, &q| area(q).total_cmp(&area(p)));
    let is_free = |&apex: &[f64; 2]| !sides.iter().any(|&side| enters(side, [a, b, apex], turn));
    apexes.into_iter().find(is_free).map(|apex| [a, b, apex])
}

/// Whether some of a segment is inside of a triangle that turns in some sense.
fn enters(segment: Segment, triangle: [[f64; 2]; 3], turn: f64) -> bool {
    let [mut from, mut to] = [0.0, 1.0];
    for k in 0..3 {
        let [p, q] = [triangle[k], triangle[(k + 1) % 3]];
        let [before, after] = segment.map(|end| turn * area_of([p, q, end]));
        if before <= 0.0 && after <= 0.0 {
            return false;
        }
        let share = before / (before - after);
        if before < 0.0 {
            from = share.max(from);
        } else if after < 0.0 {
            to = share.min(to);
        }
    }
    from < to
}

/// Twice the area of a triangle, positive if it turns from x to y.
fn area_of([a, b, c]: [[f64; 2]; 3]) -> f64 {
    cross([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_do_not_leave_the_outline() {
        // A square with a notch from above that reaches below its middle.
        let outline = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 1.0], [0.0, 4.0]];
        assert!(!is_convex(&outline) && is_convex(&outline[..3]));
        let all: Vec<Segment> = sides(&outline).collect();
        let apex = |side: usize| triangle_on(all[side], 1.0, &all).map(|triangle| triangle[2]);
        // Below, only the notch's end is seen from both ends; to the side the corner opposite is
        // behind it.
        assert_eq!(apex(0), Some([2.0, 1.0]));
        assert_eq!(apex(1), Some([2.0, 1.0]));
        assert_eq!(apex(2), Some([4.0, 0.0]));
        assert_eq!(apex(3), Some([0.0, 0.0]));
        let reversed: Vec<Segment> = all.iter().rev().map(|&[a, b]| [b, a]).collect();
        assert_eq!(triangle_on(reversed[4], -1.0, &reversed).map(|t| t[2]), Some([2.0, 1.0]));
    }
}
