//! Scenes of integer corners, for [`PlainView`](crate::plain::PlainView).

use crate::plain::{Corner, to_world};
use binspace::glam::DVec3;
use binspace::internals::SplitMix64;

/// Parallelograms between depths 4 and 12, every third opaque, the others translucent; many cross.
pub fn panes(count: usize, seed: u64) -> (Vec<Vec<Corner>>, Vec<bool>) {
    let mut random = SplitMix64::new(seed);
    let mut integers = |scale: f64| -> Corner {
        random.point(-1.0, 1.0).to_array().map(|c| (c * scale).round() as i64)
    };
    let pane = |_| {
        let [x, y, z] = integers(1.0 * 256.0);
        let ([a, b], depth) = ([integers(400.0), integers(400.0)], 2048 + 3 * z);
        let centre = [x * depth / 640, y * depth / 900, -depth];
        let corner = |s: i64, t: i64| std::array::from_fn(|i| centre[i] + s * a[i] + t * b[i]);
        vec![corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)]
    };
    let polygons = (0..count).map(pane).collect();
    (polygons, (0..count).map(|number| number % 3 == 0).collect())
}

/// Polygons of integer corners in world units, exactly.
pub fn world_polygons(polygons: &[Vec<Corner>]) -> Vec<Vec<DVec3>> {
    polygons.iter().map(|polygon| polygon.iter().copied().map(to_world).collect()).collect()
}
