//! Leaving out the backs of polygons.

use binspace::raster::Rays;
use binspace::{Facing, Fragment, Viewpoint};
use clap::{Args, ValueEnum};

/// The sides of polygons that are left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Cull {
    /// None: polygons are visible from both sides
    #[default]
    None,
    /// Back faces: polygons are visible only where their corners run counter-clockwise
    Back,
}

impl Cull {
    /// Whether a fragment shows a side that is not left out.
    pub(crate) fn shows(self, fragment: &Fragment<'_>, viewpoint: Viewpoint) -> bool {
        self == Self::None || fragment.facing(viewpoint) == Facing::Front
    }

    /// Rays that pass through polygons that are left out.
    pub(crate) fn rays(self, rays: Rays) -> Rays {
        if self == Self::Back { rays.with_front_faces_only() } else { rays }
    }
}

#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct CullArgs {
    /// Sides of polygons to omit: none or back
    #[arg(long, value_name = "SIDE", value_enum, default_value_t, hide_possible_values = true)]
    pub(crate) cull: Cull,
}
