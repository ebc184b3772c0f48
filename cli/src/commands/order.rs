//! `binspace order`: fragments in paint order, as JSON lines.

use std::io::{self, Write};

use binspace::glam::DVec3;
use binspace::{Fragment, Viewpoint};

use super::Outcome;
use crate::args::OrderArgs;
use crate::failure::Failure;
use crate::files::Output;
use crate::job;
use crate::progress::Progress;

/// Runs the command.
pub(crate) fn run(args: &OrderArgs) -> Result<Outcome, Failure> {
    let output = Output::open(args.output.as_deref())?;
    let (scene, tree) = job::scene_and_tree(&args.scene, &args.build)?;
    let viewpoint = match (args.eye, args.direction) {
        (Some(eye), _) => Viewpoint::Eye(eye),
        (None, Some(direction)) => Viewpoint::Direction(direction),
        (None, None) => return Err(Failure::Message("--eye or --direction is needed".to_owned())),
    };
    let _progress = Progress::spinner("writing");
    output.write(|out| {
        let mut fragments = if args.front_to_back {
            tree.front_to_back(viewpoint)
        } else {
            tree.back_to_front(viewpoint)
        };
        fragments
            .try_for_each(|fragment| write_line(out, &fragment, scene.polygon(fragment.polygon())))
    })?;
    Ok(Outcome::Done)
}

/// Corners are written as they were given, not as the tree's grid has them. Debug formatting of a
/// finite number is its shortest round-trip form, and valid JSON.
fn write_line(out: &mut dyn Write, fragment: &Fragment<'_>, polygon: &[DVec3]) -> io::Result<()> {
    write!(out, "{{\"polygon\": {}, \"vertices\": [", fragment.polygon())?;
    for (i, (vertex, weights)) in fragment.vertices().zip(fragment.weights()).enumerate() {
        let vertex = match weights[..] {
            [(corner, _)] => polygon[corner as usize],
            _ => vertex,
        };
        let comma = if i == 0 { "" } else { ", " };
        write!(out, "{comma}[{:?}, {:?}, {:?}]", vertex.x, vertex.y, vertex.z)?;
    }
    writeln!(out, "]}}")
}
