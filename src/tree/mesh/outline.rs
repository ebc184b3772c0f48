//! Triangles of a convex outline that may have vertices inside its sides.

/// A vertex of an outline.
#[derive(Clone, Copy, Debug)]
pub(super) struct OutlineVertex {
    pub(super) vertex: u32,
    /// Whether the outline runs straight through it.
    pub(super) straight: bool,
}

/// Calls `triangle` with two triangles fewer than the outline has vertices. They face as it does,
/// fill it, and none has all its vertices on one side of the outline, so none is without area.
///
/// Each edge of the outline belongs to one triangle. An outline of two vertices or fewer has none.
pub(super) fn triangulate(outline: &[OutlineVertex], mut triangle: impl FnMut([u32; 3])) {
    let n = outline.len();
    let at = |k: usize| outline[k % n];
    let mut emit = |a: usize, b: usize, c: usize| triangle([a, b, c].map(|k| at(k).vertex));
    // A fan from any true corner would have flat triangles on the sides next to it, if these have
    // vertices inside. A fan from a vertex inside a side has them on that side alone.
    let first = (0..n).find(|&k| at(k).straight && !at(k + n - 1).straight);
    let apex = first.unwrap_or(0);
    // How many edges it is to the end of the apex's side.
    let length = first.and_then(|apex| (1..n).find(|&k| !at(apex + k).straight)).unwrap_or(1);
    let mut next = apex + 1;
    if length > 1 && length + 1 < n {
        // The rest of that side is filled from the first vertex beyond it.
        next = apex + length + 1;
        (apex..apex + length).for_each(|k| emit(k, k + 1, next));
    }
    (next + 1..apex + n).for_each(|k| emit(apex, k - 1, k));
}

#[cfg(test)]
mod tests {
    use super::{OutlineVertex, triangulate};
    use std::collections::HashSet;

    /// Outlines of integer points on the sides of polygons, with every number of points inside each.
    #[test]
    fn triangles_have_area_and_each_edge_of_the_outline_once() {
        let shapes: [&[[i64; 2]]; 3] = [
            &[[0, 0], [12, 0], [0, 12]],
            &[[0, 0], [12, 0], [12, 12], [0, 12]],
            &[[0, 0], [12, 0], [24, 12], [12, 24], [0, 12]],
        ];
        let mut tried = 0;
        for shape in shapes {
            let sides = shape.len();
            for pattern in 0..4_usize.pow(sides as u32) {
                let mut points = Vec::new();
                for (side, a) in shape.iter().enumerate() {
                    let b = shape[(side + 1) % sides];
                    let inside = (pattern / 4_usize.pow(side as u32) % 4) as i64;
                    points.push((*a, false));
                    points.extend((1..=inside).map(|k| {
                        let part = |i: usize| a[i] + (b[i] - a[i]) * k / (inside + 1);
                        ([part(0), part(1)], true)
                    }));
                }
                for turned in 0..points.len() {
                    points.rotate_left(turned.min(1));
                    check(&points, shape);
                    tried += 1;
                }
            }
        }
        assert!(tried > 10_000, "{tried}");
    }

    fn check(points: &[([i64; 2], bool)], shape: &[[i64; 2]]) {
        let outline: Vec<OutlineVertex> = (0..)
            .zip(points)
            .map(|(vertex, &(_, straight))| OutlineVertex { vertex, straight })
            .collect();
        let (mut area, mut count, mut edges) = (0, 0, HashSet::new());
        triangulate(&outline, |triangle| {
            let [a, b, c] = triangle.map(|k| points[k as usize].0);
            let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            assert!(twice > 0, "{points:?}");
            (area, count) = (area + twice, count + 1);
            for k in 0..3 {
                let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
                assert!(edges.insert((from, to)), "{points:?}");
            }
        });
        let n = points.len() as u32;
        assert_eq!(count, n - 2);
        edges.retain(|&(a, b)| b != (a + 1) % n || n == 3 && a == b);
        // What is left beside the outline is matched.
        assert!(edges.iter().all(|&(a, b)| edges.contains(&(b, a)) || (b + 1) % n == a));
        assert_eq!(edges.len() as u32, 2 * (n - 3));
        let next = shape.iter().cycle().skip(1);
        let whole: i64 = shape.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
        assert_eq!(area, whole);
    }
}
