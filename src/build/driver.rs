//! From polygons to a tree, step by step: preparation, jobs, assembly, the finished tree.

use std::mem::take;
use std::ops::ControlFlow;

use super::builder::{Memory, Shared};
use super::choose::Tuning;
use super::job::Job;
use super::options::BuildOptions;
use super::piece::Piece;
use super::progress::{PIECES_AT_ONCE, Progress, Watch, one_at_a_time};
use super::threads;
use crate::error::Error;
use crate::exact::Faces;
use crate::exact::cell::Clipper;
use crate::faces::{Listener, Preparation, Preparer};
use crate::input::Polygon;
use crate::memory::{push, reserve};
use crate::tree::BspTree;
use crate::tree::node_record::Sizes;
use crate::tree::parts::{Parts, RawNode};

impl BspTree {
    /// Builds a tree with the default options.
    ///
    /// # Errors
    ///
    /// If a coordinate is infinite or NaN; if one polygon has more than 2²² corners, all polygons
    /// together have 2²⁸ or more, or the tree would have more than 2²⁵ fragments; or if memory runs
    /// out. The error names the polygon where one is to blame.
    pub fn build<P: Polygon>(polygons: impl IntoIterator<Item = P>) -> Result<Self, Error> {
        BuildOptions::DEFAULT.build(polygons)
    }
}

impl BuildOptions {
    /// Builds a tree of polygons; see [`BspTree::build`].
    ///
    /// # Errors
    ///
    /// If a polygon cannot be read or a budget runs out; see [`Error`].
    pub fn build<P: Polygon>(
        &self,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<BspTree, Error> {
        tree(self, polygons, &Watch::default())
    }

    /// Builds the same tree as [`build`](Self::build), and reports its progress to a callback.
    ///
    /// The callback is called at the start, about once per millisecond of work, and at the end. Any
    /// thread may call it, but never two at once: a thread that finds it busy continues with its
    /// work. So the callback may be slow, and may use the same thread pool.
    ///
    /// If the callback returns [`ControlFlow::Break`], the build is cancelled: each thread stops
    /// after its current pass over a set of pieces. That takes milliseconds, or tenths of a second
    /// in sets of some 100 000 pieces. When all sets are divided, the tree is laid out in memory,
    /// which takes about as long and cannot be cancelled.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    ///
    /// use binspace::{BuildOptions, scene};
    ///
    /// let (scene, mut percent) = (scene::random_triangles(2000, 1), 0);
    /// let tree = BuildOptions::DEFAULT.build_with_progress(scene.polygons(), |progress| {
    ///     percent = 100 * progress.done / progress.total.max(1);
    ///     ControlFlow::Continue(())
    /// })?;
    /// assert_eq!(percent, 100);
    ///
    /// let never = BuildOptions::DEFAULT
    ///     .build_with_progress(scene.polygons(), |_| ControlFlow::Break(()));
    /// assert!(never.is_err_and(|error| error.is_cancelled()));
    /// # Ok::<(), binspace::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As for [`build`](Self::build), and if the build is cancelled.
    pub fn build_with_progress<P: Polygon>(
        &self,
        polygons: impl IntoIterator<Item = P>,
        progress: impl FnMut(Progress) -> ControlFlow<()> + Send,
    ) -> Result<BspTree, Error> {
        let progress = one_at_a_time(progress);
        tree(self, polygons, &Watch::new(&progress))
    }
}

fn tree<P: Polygon>(
    options: &BuildOptions,
    polygons: impl IntoIterator<Item = P>,
    watch: &Watch<'_>,
) -> Result<BspTree, Error> {
    let (faces, preparation) = prepared(options, polygons, watch)?;
    tree_of_faces(options, faces, preparation, watch)
}

/// Builds a tree of prepared faces, of what is in their cell if they have one.
pub(super) fn tree_of_faces(
    options: &BuildOptions,
    mut faces: Faces,
    mut preparation: Preparation,
    watch: &Watch<'_>,
) -> Result<BspTree, Error> {
    watch.expect(faces.len())?;
    let parts = if faces.corners_of_cell() == 0 {
        parts(options, &Tuning::DEFAULT, &faces, watch)?
    } else {
        let job = pieces_in_cell(&mut faces, watch)?;
        preparation.dropped = faces.dropped(preparation.polygons).count();
        watch.expect(faces.len())?;
        let shared = Shared::new(&faces, options, &Tuning::DEFAULT, watch)?;
        threads::run(&shared, job, &mut Memory::default())?
    };
    watch.end()?;
    BspTree::new(faces, preparation, parts)
}

/// Cuts faces to their cell, and removes those that nothing is left of.
fn pieces_in_cell(faces: &mut Faces, watch: &Watch<'_>) -> Result<Job, Error> {
    let (mut pieces, mut arena, mut kept) = (Vec::new(), Vec::new(), Vec::new());
    let (mut clipper, count) = (Clipper::new(faces), faces.len() as u32);
    for start in (0..count).step_by(PIECES_AT_ONCE) {
        let some = start..count.min(start + PIECES_AT_ONCE as u32);
        watch.work(some.len())?;
        for face in some {
            let Some(outline) = clipper.clip(face) else { continue };
            let mut piece = Piece::whole(faces, face);
            if !outline.is_empty() {
                piece = Piece::part(&piece, outline, arena.len());
                reserve(&mut arena, outline.len())?;
                arena.extend_from_slice(outline);
            }
            piece.face = kept.len() as u32;
            push(&mut pieces, piece)?;
            push(&mut kept, face)?;
        }
    }
    faces.keep(&kept);
    faces.shrink_to_fit();
    Ok(Job { pieces, arena, depth: 0 })
}

/// Prepares polygons. What that needs is freed before the faces are divided.
fn prepared<P: Polygon>(
    options: &BuildOptions,
    polygons: impl IntoIterator<Item = P>,
    watch: &Watch<'_>,
) -> Result<(Faces, Preparation), Error> {
    let (mut faces, mut preparer) = (Faces::default(), Preparer::default());
    preparer.hold(options.bounds)?;
    let preparation =
        preparer.prepare(&mut faces, polygons, options.tolerance, options.max_fragments, watch)?;
    faces.shrink_to_fit();
    Ok((faces, preparation))
}

/// Memory that trees are built in, one frame after the other.
#[derive(Default)]
pub(super) struct FrameMemory {
    preparer: Preparer,
    memory: Memory,
    nodes: Vec<RawNode>,
    sizes: Vec<Sizes>,
}

/// Puts faces into planes that several of them share.
pub(super) type Arrange<'a> = &'a mut dyn FnMut(&mut Faces) -> Result<(), Error>;

impl FrameMemory {
    /// Replaces a tree by one for a single view: with the positions of its vertices, and without the
    /// layout that makes many orders fast. After an error the tree is empty.
    ///
    /// With `arrange`, polygons are flat by definition, and it puts their faces into planes.
    pub(super) fn rebuild<P: Polygon>(
        &mut self,
        tree: &mut BspTree,
        options: &BuildOptions,
        polygons: impl IntoIterator<Item = P>,
        arrange: Option<Arrange<'_>>,
    ) -> Result<(), Error> {
        let Self { preparer, memory, nodes, sizes } = self;
        let (mut faces, parts) = tree.take_parts();
        memory.output.parts = Parts { nodes: take(nodes), ..parts };
        let watch = Watch::default();
        preparer.hold(options.bounds)?;
        preparer.are_flat = arrange.is_some();
        let preparation = preparer.prepare(
            &mut faces,
            polygons,
            options.tolerance,
            options.max_fragments,
            &watch,
        )?;
        if let Some(arrange) = arrange {
            arrange(&mut faces)?;
        }
        let tuning = &Tuning::FRAMES;
        let shared = Shared::new(&faces, options, tuning, &watch)?;
        let parts = divide_all(&shared.with_positions(), &faces, memory, &watch)?;
        *nodes = tree.refill(faces, preparation, parts, sizes)?;
        Ok(())
    }
}

/// Builds a tree of prepared faces. Their tolerance counts, not that of the options.
///
/// # Errors
///
/// If a budget or memory runs out.
pub fn tree_of(
    options: &BuildOptions,
    tuning: &Tuning,
    faces: Faces,
    preparation: Preparation,
) -> Result<BspTree, Error> {
    let parts = parts(options, tuning, &faces, &Watch::default())?;
    BspTree::new(faces, preparation, parts)
}

/// A step of the preparation takes about as long as examining this many pieces.
const STEP: usize = 8;

impl Listener for Watch<'_> {
    fn read(&self, polygons: usize) -> Result<(), Error> {
        self.expect(polygons)
    }

    fn work(&self, steps: usize) -> Result<(), Error> {
        Watch::work(self, steps * STEP)
    }
}

/// Builds the parts of a tree of prepared faces.
fn parts(
    options: &BuildOptions,
    tuning: &Tuning,
    faces: &Faces,
    watch: &Watch<'_>,
) -> Result<Parts, Error> {
    let shared = Shared::new(faces, options, tuning, watch)?;
    divide_all(&shared, faces, &mut Memory::default(), watch)
}

/// Divides the set of all faces, down to the leaves.
fn divide_all(
    shared: &Shared<'_>,
    faces: &Faces,
    memory: &mut Memory,
    watch: &Watch<'_>,
) -> Result<Parts, Error> {
    let (mut pieces, mut arena) = (take(&mut memory.pieces), take(&mut memory.arena));
    pieces.clear();
    arena.clear();
    reserve(&mut pieces, faces.len())?;
    let count = faces.len() as u32;
    for start in (0..count).step_by(PIECES_AT_ONCE) {
        let some = start..count.min(start + PIECES_AT_ONCE as u32);
        watch.work(some.len())?;
        pieces.extend(some.map(|face| Piece::whole(faces, face)));
    }
    threads::run(shared, Job { pieces, arena, depth: 0 }, memory)
}
