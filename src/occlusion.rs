//! Which pixels are covered already, for walks from front to back that leave out what is hidden.

use glam::DVec3;

use crate::paint::Pieces;
use crate::raster::{Mask, Rays};
use crate::tree::{BspTree, Fragment};

/// The pixels that are covered so far on a walk from front to back: occlusion culling.
///
/// Cover it with each fragment that comes, and skip the subtrees that it hides: nothing in them
/// owns a pixel of the picture that the rays define. That is exact, except that a subtree is judged
/// by its box, so that one is looked at which only seems to reach out.
///
/// The mask may be coarser than the picture: cells of so many pixels each way, which are covered
/// only by a fragment that covers all of their pixels. Then it is smaller and faster, and hides less:
/// along the edge between two walls, no cell is covered by either.
///
/// ```
/// use binspace::raster::Rays;
/// use binspace::occlusion::CoverageMask;
/// use binspace::view::Camera;
/// use binspace::{BspTree, Flow, Part, scene};
/// use binspace::glam::DVec3;
///
/// // Squares one behind the other: from the front, the first hides all others.
/// let tree = BspTree::build(scene::chain(50).polygons())?;
/// let bounds = tree.bounds()?;
/// let eye = DVec3::new(0.0, -9.0, 0.0);
/// let camera = Camera::perspective(eye, DVec3::ZERO, DVec3::Z, 0.8, [64, 64])?;
/// let mut mask = CoverageMask::new(&tree, &Rays::new(&camera, tree.faces())?, 1);
/// let mut seen = Vec::new();
/// let _ = tree.walk_front_to_back(camera.viewpoint(), |part| match part {
///     Part::Subtree(node) if mask.hides(bounds.of(node)) => Flow::Skip,
///     Part::Fragment(fragment) if mask.cover(&fragment) => {
///         seen.push(fragment.polygon());
///         Flow::<()>::Descend
///     }
///     _ => Flow::Descend,
/// });
/// assert_eq!(seen, [0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct CoverageMask<'t> {
    tree: &'t BspTree,
    rays: Rays,
    mask: Mask,
    pieces: Pieces,
}

impl<'t> CoverageMask<'t> {
    /// A mask of which nothing is covered, for the picture of some rays through a tree's faces, with
    /// cells of `cell` pixels each way; 0 counts as 1.
    ///
    /// # Panics
    ///
    /// If the rays were made for another grid.
    pub fn new(tree: &'t BspTree, rays: &Rays, cell: u32) -> Self {
        rays.expect(tree.faces());
        let mask = Mask::new(rays.size(), cell.max(1));
        Self { tree, rays: rays.clone(), mask, pieces: Pieces::default() }
    }

    /// Whether nothing in a box owns a pixel: all that it may cover is covered, or it is outside of
    /// the picture.
    ///
    /// It looks at the rows of cells that the box may cover, up to the first open cell: at most a word of 64
    /// cells at a time, and nothing in a row that is full.
    pub fn hides(&self, [low, high]: [DVec3; 2]) -> bool {
        let lattice = self.tree.faces().lattice();
        let corners: [[f64; 3]; 8] = std::array::from_fn(|k| {
            let pick = |axis: usize| if k >> axis & 1 == 0 { low[axis] } else { high[axis] };
            lattice.to_lattice(DVec3::new(pick(0), pick(1), pick(2)))
        });
        self.mask.hides(&self.rays, &corners)
    }

    /// Covers the pixels of a fragment, and returns whether it owns some: whether it covers a pixel
    /// of a cell that was not covered yet.
    ///
    /// It takes the time to find the fragment's pixels, O(edges) a row of pixels, and that of the cells
    /// in the rows that it reaches, in the mask's whole width, whether they are covered already or not: ask
    /// [`hides`](Self::hides) first where a box is at hand.
    ///
    /// # Panics
    ///
    /// If the fragment is of a tree with another grid.
    pub fn cover(&mut self, fragment: &Fragment<'_>) -> bool {
        // Its own faces, not those of the mask's tree: it may be a piece of an overlay.
        let faces = fragment.faces;
        self.rays.expect(faces);
        self.mask.cover(&self.rays, faces, self.pieces.of(fragment))
    }

    /// Whether all of the picture is covered.
    pub fn is_full(&self) -> bool {
        self.mask.is_full()
    }
}
