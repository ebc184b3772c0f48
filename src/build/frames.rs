//! Trees for one view, built in reused memory: trees of frames, and trees of an overlay's pieces in one cell.

use std::fmt;
use std::mem::take;

use super::choose::Tuning;
use super::driver::divide_all;
use super::jobs::{self, Job};
use super::options::BuildOptions;
use super::piece::Piece;
use super::subtree::{Builder, Shared};
use crate::error::Error;
use crate::exact::{Faces, PlaneId, PreparedPlane, Vertex};
use crate::faces::Preparer;
use crate::input::Polygon;
use crate::memory::reserve;
use crate::progress::Watch;
use crate::tree::BspTree;
use crate::tree::node::{MOST_FRAGMENTS, Sizes};
use crate::tree::parts::{Parts, RawNode};

/// Builds a tree for every frame, in reused memory.
///
/// Use a `FrameBuilder` if polygons move every frame and each tree is drawn once or twice, as in a compositor
/// of layers. The trees are as exact as the trees of [`BspTree::build`], but are made for one view:
///
/// - The builder spends less time on the choice of planes, so the [fragments](crate::Fragment) may differ.
/// - The rounded positions of vertices made by cuts are stored, not computed at each access.
/// - The memory layout that makes [`back_to_front_into`](BspTree::back_to_front_into) fast is left out. So an
///   order of such a tree, or of a clone of the tree, takes a few times longer.
///
/// The builder keeps its buffers from frame to frame. Once the buffers are large enough, building a frame of
/// few polygons allocates no memory. (Queries and culling allocate bounding boxes; see [`BspTree::bounds`].)
/// The buffers do not shrink; to free their memory, make another builder.
///
/// ```
/// use binspace::{BuildOptions, FrameBuilder, Viewpoint, glam::DVec3};
///
/// let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
/// let mut order = Vec::new();
/// for frame in 0..3 {
///     let z = f64::from(frame);
///     let layer = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
///     let tree = builder.build([layer(z), layer(1.5)])?;
///     tree.back_to_front_into(Viewpoint::direction([0.0, 0.0, -1.0]), &mut order);
///     for &number in &order {
///         let fragment = tree.fragment(number);
///         let outline = fragment.vertices(); // of polygon `fragment.polygon()`
///         # assert_eq!(outline.len(), 4);
///     }
///     assert_eq!(order, if frame < 2 { [0, 1] } else { [1, 0] });
/// }
/// # Ok::<(), binspace::Error>(())
/// ```
pub struct FrameBuilder {
    options: BuildOptions,
    tree: BspTree,
    // Lists reused for the next frame.
    preparer: Preparer,
    builder: Builder,
    planes: Vec<PreparedPlane>,
    nodes: Vec<RawNode>,
    sizes: Vec<Sizes>,
}

/// Puts faces into common planes.
type Arrange<'a> = &'a mut dyn FnMut(&mut Faces) -> Result<(), Error>;

impl FrameBuilder {
    /// Creates a builder with these options and an empty tree.
    pub fn new(options: BuildOptions) -> Self {
        Self {
            options,
            tree: BspTree::empty(),
            preparer: Preparer::default(),
            builder: Builder::default(),
            planes: vec![],
            nodes: vec![],
            sizes: vec![],
        }
    }

    /// Sets the options of later trees.
    pub fn set_options(&mut self, options: BuildOptions) {
        self.options = options;
    }

    /// Builds a tree of polygons. This tree replaces the previous tree.
    ///
    /// # Errors
    ///
    /// As for [`BuildOptions::build`]. After an error the tree is empty.
    pub fn build<P: Polygon>(
        &mut self,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<&BspTree, Error> {
        self.rebuild(polygons, None)?;
        Ok(&self.tree)
    }

    /// Builds a tree of polygons that are flat by definition. Puts the polygons of each group into one plane.
    #[cfg(feature = "layers")]
    pub(crate) fn build_in_planes<'g, P: Polygon>(
        &mut self,
        polygons: impl IntoIterator<Item = P>,
        mut groups: impl Iterator<Item = &'g [u32]>,
    ) -> Result<(), Error> {
        let mut arrange =
            |faces: &mut Faces| groups.try_for_each(|group| faces.put_into_one_plane(group));
        self.rebuild(polygons, Some(&mut arrange))
    }

    /// Replaces the tree by a tree for a single view. The new tree stores the positions of its vertices, and
    /// lacks the layout that makes many orders fast. After an error the tree is empty.
    ///
    /// With `arrange`, polygons are flat by definition, and `arrange` puts their faces into common planes.
    fn rebuild<P: Polygon>(
        &mut self,
        polygons: impl IntoIterator<Item = P>,
        arrange: Option<Arrange<'_>>,
    ) -> Result<(), Error> {
        let Self { options, tree, preparer, builder, planes, nodes, sizes } = self;
        let BuildOptions { bounds, tolerance, max_fragments, .. } = *options;
        let (mut faces, parts) = tree.take_parts();
        builder.output.parts = Parts { nodes: take(nodes), ..parts };
        let watch = Watch::default();
        preparer.hold(bounds)?;
        preparer.are_flat = arrange.is_some();
        let preparation =
            preparer.prepare(&mut faces, polygons, tolerance, max_fragments, &watch)?;
        if let Some(arrange) = arrange {
            arrange(&mut faces)?;
        }
        planes.clear();
        reserve(planes, faces.len())?;
        let own = (0..faces.len() as u32).map(PlaneId::face);
        planes.extend(own.map(|plane| PreparedPlane::new(&faces, plane)));
        let shared = Shared::new(&faces, options, &Tuning::FRAMES, &watch)?;
        let shared = shared.with_positions().with_planes(planes);
        let parts = divide_all(&shared, &faces, builder, &watch)?;
        *nodes = tree.refill(faces, preparation, parts, sizes)?;
        Ok(())
    }

    /// Returns the last tree built.
    pub fn tree(&self) -> &BspTree {
        &self.tree
    }
}

impl Clone for FrameBuilder {
    /// Copies the options and the tree, but no spare memory.
    fn clone(&self) -> Self {
        Self { tree: self.tree.clone(), ..Self::new(self.options.clone()) }
    }
}

impl fmt::Debug for FrameBuilder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FrameBuilder")
            .field("options", &self.options)
            .field("tree", &self.tree)
            .finish_non_exhaustive()
    }
}

/// Builds a tree of the pieces in each cell, in reused memory.
#[derive(Default)]
pub(crate) struct OverlayBuilder {
    builder: Builder,
}

impl OverlayBuilder {
    /// Builds a tree of some pieces, with the positions of its vertices. After reading the parts, pass them
    /// to [`keep`](Self::keep).
    ///
    /// # Errors
    ///
    /// If there are too many fragments, the caller cancels, or memory runs out.
    pub(crate) fn build(
        &mut self,
        faces: &Faces,
        pieces: &[Piece],
        arena: &[Vertex],
        watch: &Watch<'_>,
    ) -> Result<Parts, Error> {
        let Self { builder } = self;
        let mut job =
            Job { pieces: take(&mut builder.pieces), arena: take(&mut builder.arena), depth: 0 };
        job.pieces.clear();
        job.arena.clear();
        reserve(&mut job.pieces, pieces.len())?;
        for piece in pieces {
            job.pieces.push(piece.copied(arena, &mut job.arena));
        }
        // The budget counts all faces, including the tree's.
        let options = BuildOptions::DEFAULT.with_max_fragments(MOST_FRAGMENTS);
        let shared = Shared::new(faces, &options, &Tuning::FRAMES, watch)?;
        jobs::run(&shared.with_positions(), job, builder)
    }

    /// Keeps the memory of a tree for the next tree.
    pub(crate) fn keep(&mut self, parts: Parts) {
        self.builder.output.parts = parts;
    }
}
