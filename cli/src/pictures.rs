//! The pictures that can be drawn of a tree, as RGB pixels.

use binspace::raster::{DepthImage, Image, depth_map, difference, picture};
use binspace::{BspTree, Verification, Viewpoint, paint_tree_in_colour};

use crate::args::KindArgs;
use crate::colours::{BACKGROUND, Colours};

/// The kinds of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The fragments, painted over each other.
    Painter,
    /// What a depth buffer shows.
    ZBuffer,
    /// Where the two differ.
    Difference,
    /// The depth of every pixel.
    Depth,
}

impl Kind {
    /// All, in the order in which to write them.
    pub(crate) const ALL: [Self; 4] = [Self::Painter, Self::ZBuffer, Self::Difference, Self::Depth];

    /// The kind that options ask for.
    pub(crate) fn asked(args: &KindArgs) -> Self {
        match (args.z_buffer, args.difference, args.depth) {
            (true, ..) => Self::ZBuffer,
            (_, true, _) => Self::Difference,
            (.., true) => Self::Depth,
            _ => Self::Painter,
        }
    }

    /// Its name in file names and on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Painter => "painter",
            Self::ZBuffer => "z-buffer",
            Self::Difference => "difference",
            Self::Depth => "depth",
        }
    }

    /// Its pixels, seen from a viewpoint. Transparency shows only in the painter's picture.
    pub(crate) fn pixels(
        self,
        tree: &BspTree,
        viewpoint: Viewpoint,
        seen: &Verification,
        colours: &Colours<'_>,
    ) -> Vec<u8> {
        let show = |image: &Image| {
            let colour = |polygon| colours.rgb(polygon);
            picture(&seen.rays, tree.faces(), image, colour, BACKGROUND)
        };
        let truth: &DepthImage = &seen.truth;
        match self {
            Self::Painter if colours.are_translucent() => {
                let look = |polygon| (colours.rgb(polygon), colours.opacity(polygon));
                paint_tree_in_colour(tree, viewpoint, &seen.rays, look, BACKGROUND)
            }
            Self::Painter => show(&seen.painted),
            Self::ZBuffer => show(truth.image()),
            Self::Difference => difference(&seen.comparison, &show(&seen.painted)),
            Self::Depth => depth_map(truth),
        }
    }
}
