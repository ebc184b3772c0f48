//! The treatment of seams between neighbours.

use clap::ValueEnum;

/// Viewers blend each path with the paint below it. Along an edge of two polygons that both cover half of a
/// pixel, a quarter of the background shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Seams {
    /// Opaque polygons reach a little under later opaque neighbours; translucent ones have seams
    #[default]
    Trap,
    /// SVG only: a path for each region where the same polygons show, with their blended colour; viewers
    /// add the paths up (`mix-blend-mode: plus-lighter`), which leaves no seam, translucent or not
    PlusLighter,
    /// Nothing: paths are the polygons alone
    None,
}
