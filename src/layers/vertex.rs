//! A corner on the screen and in its layer.

use glam::{DVec2, DVec3, DVec4};

use super::layer::Layer;

/// A corner of a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerVertex {
    /// Its place on the screen, and its depth: (x/w, y/w, z/w).
    pub position: DVec3,
    /// The w that it was divided by; positive.
    pub w: f64,
    /// Its place (u, v) in the layer's own rectangle.
    pub local: DVec2,
}

impl LayerVertex {
    /// (x, y, z, w), for a graphics card that divides by w itself.
    pub fn homogeneous(&self) -> DVec4 {
        (self.position * self.w).extend(self.w)
    }

    /// (u/w, v/w, 1/w). All three are linear over the piece on the screen, which u and v are not:
    /// interpolate them and divide the first two by the third.
    pub fn perspective(&self) -> DVec3 {
        self.local.extend(1.0) / self.w
    }
}

/// A corner of a clipped layer.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClippedCorner {
    pub(super) vertex: LayerVertex,
    /// Which edge of the rectangle begins here, if clipping did not make it.
    pub(super) edge: Option<u8>,
}

/// The vertex at a point of the screen, by its weights over corners.
pub(super) fn interpolated(
    layer: &Layer,
    outline: &[ClippedCorner],
    position: DVec3,
    weights: &[(u32, f64)],
) -> LayerVertex {
    let corner = |k: u32| outline[k as usize].vertex;
    // As shares of one corner's w, so that no w is too small or too large.
    let unit = weights.first().map_or(1.0, |&(k, _)| corner(k).w);
    let term =
        |&(k, weight): &(u32, f64)| corner(k).local.extend(1.0) * (weight * (unit / corner(k).w));
    let sum: DVec3 = weights.iter().map(term).sum();
    let local = layer.clamp(sum.truncate() / sum.z);
    LayerVertex { position, w: unit / sum.z, local }
}
