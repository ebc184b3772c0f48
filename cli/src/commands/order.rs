//! `binspace order`: fragments in paint order, as JSON lines.

use binspace::glam::DVec3;
use binspace::{Fragment, Viewpoint};
use serde::Serialize;

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
        fragments.try_for_each(|fragment| {
            let line = Line::new(&fragment, scene.polygon(fragment.polygon()));
            serde_json::to_writer(&mut *out, &line)?;
            out.write_all(b"\n")
        })
    })?;
    Ok(Outcome::Done)
}

/// A line of the output.
#[derive(Serialize)]
struct Line {
    polygon: usize,
    vertices: Vec<[f64; 3]>,
}

impl Line {
    /// Corners are written as they were given, not rounded to the tree's grid.
    fn new(fragment: &Fragment<'_>, polygon: &[DVec3]) -> Self {
        let vertices = fragment.vertices().zip(fragment.weights()).map(|(vertex, weights)| {
            let vertex = match weights[..] {
                [(corner, _)] => polygon[corner as usize],
                _ => vertex,
            };
            // Adding 0 turns −0 into 0, as not every JSON reader knows −0.
            (vertex + 0.0).to_array()
        });
        Self { polygon: fragment.polygon(), vertices: vertices.collect() }
    }
}
