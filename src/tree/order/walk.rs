//! Walks in the order of a viewpoint that leave subtrees out.

use std::ops::ControlFlow;

use super::eye_sides::View;
use crate::tree::{BspTree, Child, Fragment, Node};
use crate::viewpoint::Viewpoint;

/// What a walk comes to: [`BspTree::walk_back_to_front`] and [`BspTree::walk_front_to_back`].
#[derive(Clone, Copy, Debug)]
pub enum Part<'t> {
    /// A subtree, before anything in it.
    Subtree(Node<'t>),
    /// A fragment, in its place in the order.
    Fragment(Fragment<'t>),
}

/// How a walk goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow<B = ()> {
    /// Into the subtree. After a fragment: to the next part.
    Descend,
    /// Past the subtree: nothing in it is visited. After a fragment: to the next part.
    Skip,
    /// Not at all: the walk ends and returns the value.
    Break(B),
}

impl BspTree {
    /// Visits subtrees and fragments, back to front, and leaves out the subtrees that `visit`
    /// skips. Returns what `visit` broke with.
    ///
    /// The fragments of subtrees that are not skipped come in the order of
    /// [`back_to_front`](Self::back_to_front). A subtree comes when the walk reaches it: after all
    /// that is behind it, before anything in it. Takes O(parts visited) time and O(depth) memory,
    /// and does not recurse.
    ///
    /// With [`Bounds`](crate::Bounds), what lies outside of a region is left out as a whole:
    ///
    /// ```
    /// use binspace::{BspTree, Flow, Part, Viewpoint};
    ///
    /// let square = |x: f64| [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.5], [x, 1.0, 1.0]];
    /// let tree = BspTree::build((0..100).map(|k| square(f64::from(k))))?;
    /// let bounds = tree.bounds()?;
    /// let mut seen = Vec::new();
    /// let mut subtrees = 0;
    /// let _ = tree.walk_back_to_front(Viewpoint::eye([50.0, -9.0, 3.0]), |part| match part {
    ///     Part::Subtree(node) => {
    ///         subtrees += 1;
    ///         let [low, high] = bounds.of(node);
    ///         if high.x < 20.0 || low.x > 23.5 { Flow::Skip } else { Flow::<()>::Descend }
    ///     }
    ///     Part::Fragment(fragment) => {
    ///         seen.push(fragment.polygon());
    ///         Flow::Descend
    ///     }
    /// });
    /// assert!((20..=23).all(|polygon| seen.contains(&polygon)));
    /// assert!(subtrees < 40);
    /// # Ok::<(), binspace::Error>(())
    /// ```
    pub fn walk_back_to_front<'t, B>(
        &'t self,
        viewpoint: Viewpoint,
        visit: impl FnMut(Part<'t>) -> Flow<B>,
    ) -> ControlFlow<B> {
        self.walk(viewpoint, false, visit)
    }

    /// Visits subtrees and fragments, front to back, and leaves out the subtrees that `visit`
    /// skips; otherwise as [`walk_back_to_front`](Self::walk_back_to_front). A subtree comes after
    /// all that is in front of it: skip it if that hides it.
    pub fn walk_front_to_back<'t, B>(
        &'t self,
        viewpoint: Viewpoint,
        visit: impl FnMut(Part<'t>) -> Flow<B>,
    ) -> ControlFlow<B> {
        self.walk(viewpoint, true, visit)
    }

    fn walk<'t, B>(
        &'t self,
        viewpoint: Viewpoint,
        is_front_to_back: bool,
        mut visit: impl FnMut(Part<'t>) -> Flow<B>,
    ) -> ControlFlow<B> {
        let view = View::new(self, viewpoint);
        let mut pending = vec![self.whole()];
        while let Some(next) = pending.pop() {
            match next {
                Child::Node(node) => match visit(Part::Subtree(node)) {
                    Flow::Descend => {
                        let mut parts = node.parts(view.is_in_front(self, node.index()));
                        // The last one is taken first.
                        if !is_front_to_back {
                            parts.reverse();
                        }
                        pending.extend(parts);
                    }
                    Flow::Skip => {}
                    Flow::Break(value) => return ControlFlow::Break(value),
                },
                Child::Leaf(mut run) => {
                    let take = |run: &mut std::ops::Range<u32>| {
                        if is_front_to_back { run.next_back() } else { run.next() }
                    };
                    while let Some(index) = take(&mut run) {
                        if let Flow::Break(value) = visit(Part::Fragment(self.fragment(index))) {
                            return ControlFlow::Break(value);
                        }
                    }
                }
            }
        }
        ControlFlow::Continue(())
    }
}
