//! The pictures that can be drawn of a tree, as RGB pixels.

use binspace::paint::{paint_tree, paint_tree_in_colour};
use binspace::raster::{Rays, depth_map, difference, picture, zbuffer};
use binspace::verify::{Verification, verify, verify_fronts};
use binspace::view::Camera;
use binspace::{BspTree, Error};
use clap::ValueEnum;

use crate::args::KindArgs;
use crate::colours::{BACKGROUND, Colours};
use crate::cull::Cull;
use crate::progress::Progress;
use crate::samples::averaged;

/// The number of samples drawn at once. Too large: more memory, some 20 bytes each. Too small: more time, as
/// all fragments are visited for each part of a picture, and all cells of a folder are read.
const AT_ONCE: u64 = 1 << 23;

/// The kinds of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The fragments, painted over each other.
    Painter,
    /// The picture of a depth buffer.
    ZBuffer,
    /// The pixels in which painter and depth buffer differ.
    Difference,
    /// The depth of every pixel.
    Depth(Bright),
}

/// The bright end of a picture of depths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Bright {
    /// Near is bright
    Near,
    /// Far is bright
    Far,
}

impl Bright {
    /// The greys of the nearest and of the furthest depth. Both differ from the background, which is black.
    pub fn greys(self) -> [u8; 2] {
        match self {
            Self::Near => [255, 40],
            Self::Far => [40, 255],
        }
    }
}

/// A picture to draw.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawing<'a> {
    pub(crate) tree: &'a BspTree,
    pub(crate) camera: &'a Camera,
    pub(crate) colours: &'a Colours<'a>,
    pub(crate) cull: Cull,
    /// Samples each way in a pixel, of a painter's or a depth buffer's picture.
    pub(crate) samples: u32,
}

impl Kind {
    /// All kinds, in the order in which pictures are written.
    pub(crate) const ALL: [Self; 4] =
        [Self::Painter, Self::ZBuffer, Self::Difference, Self::Depth(Bright::Near)];

    /// The kind that the options select.
    pub(crate) fn asked(args: &KindArgs) -> Self {
        match (args.z_buffer, args.difference, args.depth) {
            (true, ..) => Self::ZBuffer,
            (_, true, _) => Self::Difference,
            (.., Some(bright)) => Self::Depth(bright),
            _ => Self::Painter,
        }
    }

    /// The kind's name in file names and on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Painter => "painter",
            Self::ZBuffer => "z-buffer",
            Self::Difference => "difference",
            Self::Depth(_) => "depth",
        }
    }
}

/// The number of rows of samples drawn at once, for a picture of this many columns and rows of samples.
pub(crate) fn rows_at_once([columns, rows]: [u32; 2], samples: u32) -> u32 {
    let at_once = (AT_ONCE / (u64::from(columns) * u64::from(samples))).max(1);
    at_once.min(u64::from(rows)) as u32 * samples
}

impl Drawing<'_> {
    /// Draws one kind of picture. Transparency shows only in the painter's picture. With a difference,
    /// returns the figures of the comparison.
    pub(crate) fn draw(&self, kind: Kind) -> Result<(Vec<u8>, Option<Verification>), Error> {
        match kind {
            Kind::Painter | Kind::ZBuffer => Ok((self.in_parts(kind)?, None)),
            Kind::Depth(bright) => {
                let rays = self.cull.rays(Rays::new(self.camera, self.tree.faces())?);
                Ok((depth_map(&zbuffer(&rays, self.tree.faces()), bright.greys()), None))
            }
            Kind::Difference => {
                let verify = if self.cull == Cull::Back { verify_fronts } else { verify };
                let seen = verify(self.tree, self.camera)?;
                let shown = picture(
                    &seen.rays,
                    self.tree.faces(),
                    &seen.painted,
                    |polygon| self.colours.rgb(polygon),
                    BACKGROUND,
                );
                Ok((difference(&seen.comparison, &shown), Some(seen)))
            }
        }
    }

    /// A picture with all its samples, some rows at a time.
    fn in_parts(&self, kind: Kind) -> Result<Vec<u8>, Error> {
        let rays = self.cull.rays(Rays::sampled(self.camera, self.tree.faces(), self.samples)?);
        let ([columns, rows], [width, _]) = (rays.size(), self.camera.size());
        let step = rows_at_once([columns, rows], self.samples);
        let mut rgb = Vec::new();
        let progress = Progress::steps("drawing: part", rows.div_ceil(step).into());
        for start in (0..rows).step_by(step as usize) {
            let part = self.part(kind, &rays.rows(start..start.saturating_add(step)));
            rgb.extend(averaged(part, width as usize, self.samples as usize));
            progress.step();
        }
        Ok(rgb)
    }

    /// The colours along some rays.
    fn part(&self, kind: Kind, rays: &Rays) -> Vec<u8> {
        let (tree, viewpoint) = (self.tree, self.camera.viewpoint());
        let image = match kind {
            Kind::ZBuffer => zbuffer(rays, tree.faces()).into_image(),
            _ if self.colours.are_translucent() => {
                let look = |polygon| (self.colours.rgb(polygon), self.colours.opacity(polygon));
                return paint_tree_in_colour(tree, viewpoint, rays, look, BACKGROUND);
            }
            _ => paint_tree(tree, viewpoint, rays),
        };
        picture(rays, tree.faces(), &image, |polygon| self.colours.rgb(polygon), BACKGROUND)
    }
}
