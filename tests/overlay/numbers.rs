//! How the corners of a wall and of shapes on it are given.

use binspace::overlay::{Overlay, Shapes};
use testkit::prelude::*;

type Corners = Vec<DVec3>;

#[derive(Clone, Copy, Debug)]
pub(super) enum Numbers {
    Single,
    Double,
    Decimal(i32),
}

impl Numbers {
    pub(super) fn round(self, p: DVec3) -> DVec3 {
        match self {
            Self::Single => p.as_vec3().as_dvec3(),
            Self::Double => p,
            Self::Decimal(places) => (p * 10f64.powi(places)).round() / 10f64.powi(places),
        }
    }

    /// The tolerance that is set for decimals; others have the default.
    pub(super) fn tolerance(self) -> Option<f64> {
        match self {
            Self::Single | Self::Double => None,
            Self::Decimal(places) => Some(2.0 * 10f64.powi(-places)),
        }
    }

    /// The tree of rounded polygons.
    pub(super) fn tree(self, options: BuildOptions, polygons: &[Corners]) -> BspTree {
        let options = match self.tolerance() {
            Some(tolerance) => options.with_tolerance(tolerance),
            None => options,
        };
        let tree = match self {
            Self::Single => options.build(polygons.iter().map(single)),
            _ => options.build(polygons),
        };
        tree.expect("a tree")
    }

    /// Puts rounded polygons, lines and points into an overlay. Returns whether they are on the grid.
    pub(super) fn replace(
        self,
        overlay: &mut Overlay,
        tree: &BspTree,
        [polygons, lines]: [&[Corners]; 2],
        points: &[DVec3],
    ) -> bool {
        let shapes = Shapes::NONE.with_points(points.iter().copied());
        let replaced = match self {
            Self::Single => {
                let [polygons, lines] = [polygons, lines].map(|all| all.iter().map(single));
                overlay.replace_with(tree, shapes.with_polygons(polygons).with_lines(lines))
            }
            _ => overlay.replace_with(tree, shapes.with_polygons(polygons).with_lines(lines)),
        };
        replaced.is_ok()
    }
}

fn single(corners: &Corners) -> Vec<binspace::glam::Vec3> {
    corners.iter().map(|p| p.as_vec3()).collect()
}
