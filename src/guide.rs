//! The guide: a page for each subject, with programs that are tests. The pages of types say the rest.
//!
//! This module has no code. Its pages are the files in `docs/guide/`.

/// Where links between pages lead here; in the files they lead to files. (The first definition of a link wins.)
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
[verification]: crate::guide::verification
"
    };
}

#[doc = links!()]
/// Heuristics, budgets and progress: [`BuildOptions`](crate::BuildOptions),
/// [`Heuristic`](crate::Heuristic), [`Preparation`](crate::Preparation).
#[doc = ""]
#[doc = include_str!("../docs/guide/building.md")]
pub mod building {}

#[doc = links!()]
/// Vertex and index buffers: [`Mesh`](crate::mesh::Mesh), [`Triangles`](crate::mesh::Triangles).
#[doc = ""]
#[doc = include_str!("../docs/guide/gpu.md")]
pub mod gpu {}

#[doc = links!()]
/// One view as paths and lines: the module `drawing`.
#[doc = ""]
#[doc = include_str!("../docs/guide/drawings.md")]
pub mod drawings {}

#[doc = links!()]
/// Polygons that move, lines and points: [`Overlay`](crate::overlay::Overlay).
#[doc = ""]
#[doc = include_str!("../docs/guide/moving.md")]
pub mod moving {}

#[doc = links!()]
/// A tree a frame: [`FrameBuilder`](crate::FrameBuilder), and the module `layers`.
#[doc = ""]
#[doc = include_str!("../docs/guide/frames.md")]
pub mod frames {}

#[doc = links!()]
/// Orders of the visible part of a scene: [`Culling`](crate::Culling), [`Bounds`](crate::Bounds),
/// [`Frustum`](crate::Frustum), and the module `occlusion`.
#[doc = ""]
#[doc = include_str!("../docs/guide/culling.md")]
pub mod culling {}

#[doc = links!()]
/// Geometric queries: [`Ray`](crate::Ray), [`Hit`](crate::Hit), [`Location`](crate::Location).
#[doc = ""]
#[doc = include_str!("../docs/guide/rays.md")]
pub mod rays {}

#[doc = links!()]
/// Writing and reading trees: the feature `save`.
#[doc = ""]
#[doc = include_str!("../docs/guide/files.md")]
pub mod files {}

#[doc = links!()]
/// Large scenes in parts: [`Partition`](crate::partition::Partition).
#[doc = ""]
#[doc = include_str!("../docs/guide/cells.md")]
pub mod cells {}

#[doc = links!()]
/// Exactness and the coplanar [`Tolerance`](crate::Tolerance).
#[doc = ""]
#[doc = include_str!("../docs/guide/exact.md")]
pub mod exact {}

#[doc = links!()]
/// Pictures compared with a depth buffer: the module `verify`.
#[doc = ""]
#[doc = include_str!("../docs/guide/verification.md")]
pub mod verification {}

#[doc = links!()]
/// Measured figures, and known limits.
#[doc = ""]
#[doc = include_str!("../docs/guide/speed.md")]
pub mod speed {}

#[doc = links!()]
/// The program `binspace`, its pages and its lecture.
#[doc = ""]
#[doc = include_str!("../docs/guide/program.md")]
pub mod program {}
