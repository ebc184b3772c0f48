//! The guide: a page for each subject. The programs on the pages are tests. For details see the pages of
//! types, and the table of [what works together](crate#what-works-together).
//!
//! This module has no code. Its pages are the files in `docs/guide/`.

/// The targets of links between pages in rustdoc. The Markdown files define the same links again, as links to
/// files. (The first definition of a link counts.)
macro_rules! links {
    () => {
        "[building]: crate::guide::building
[cells]: crate::guide::cells
[culling]: crate::guide::culling
[drawings]: crate::guide::drawings
[exact]: crate::guide::exact
[files]: crate::guide::files
[frames]: crate::guide::frames
[gpu]: crate::guide::gpu
[moving]: crate::guide::moving
[rays]: crate::guide::rays
[speed]: crate::guide::speed
[together]: crate#what-works-together
[verification]: crate::guide::verification
"
    };
}

/// Makes the pages. Each page consists of the links, the lines given here, and the page's file.
macro_rules! pages {
    ($($(#[$doc:meta])* $page:ident)*) => {
        $(
            #[doc = links!()]
            $(#[$doc])*
            #[doc = ""]
            #[doc = include_str!(concat!("../docs/guide/", stringify!($page), ".md"))]
            pub mod $page {}
        )*
    };
}

pages! {
    /// Heuristics, budgets and progress: [`BuildOptions`](crate::BuildOptions),
    /// [`Heuristic`](crate::Heuristic), [`Preparation`](crate::Preparation).
    building
    /// Vertex and index buffers: [`Mesh`](crate::mesh::Mesh), [`Triangles`](crate::mesh::Triangles).
    gpu
    /// One view as paths and lines: the module `drawing`.
    drawings
    /// Moving polygons, lines and points: [`Overlay`](crate::overlay::Overlay).
    moving
    /// Compositing, a tree per frame: [`FrameBuilder`](crate::FrameBuilder), and the module `layers`.
    frames
    /// Orders of the visible part of a scene: [`Culling`](crate::Culling), [`Frustum`](crate::Frustum),
    /// [`Order::walk`](crate::Order::walk), and the module `occlusion`.
    culling
    /// Geometric queries: [`Ray`](crate::Ray), [`Hit`](crate::Hit), [`Location`](crate::Location).
    rays
    /// Writing and reading trees: the feature `save`.
    files
    /// Large scenes in parts: [`Partition`](crate::partition::Partition).
    cells
    /// Exactness and the coplanar [`Tolerance`](crate::Tolerance).
    exact
    /// Pictures compared with a depth buffer: the module `verify`.
    verification
    /// Measured figures, and known limits.
    speed
    /// The program `binspace` and its pages; the lecture of `binspace-lab`.
    program
}
