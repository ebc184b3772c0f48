//! `binspace order`: fragments in paint order, as JSON lines.

use std::io::{self, Write};

use binspace::glam::DVec3;
use binspace::scene::Scene;
use binspace::{BspTree, Fragment, Viewpoint};
use serde::Serialize;

use crate::Outcome;
use crate::args::OrderArgs;
use crate::cells;
use crate::failure::Failure;
use crate::files::Output;
use crate::job::{self, Made};
use crate::progress::Progress;

/// Runs the command.
pub(crate) fn run(args: &OrderArgs) -> Result<Outcome, Failure> {
    let output = Output::open(&args.output, &args.scene)?;
    let viewpoints: Vec<Viewpoint> = match args.direction {
        Some(direction) => vec![Viewpoint::Direction(direction)],
        None => args.eye.iter().copied().map(Viewpoint::Eye).collect(),
    };
    if let Some(path) = cells::folder::asked(&args.scene, &args.build)? {
        cells::draw::order(args, path, &viewpoints, output)?;
        return Ok(Outcome::Done);
    }
    let Made { scene, tree, .. } = job::make(&args.scene, &args.build)?;
    let _progress = Progress::spinner("writing");
    output.write(|out| {
        viewpoints.iter().enumerate().try_for_each(|(k, &viewpoint)| {
            let eye = (viewpoints.len() > 1).then_some(k);
            write_order(out, args, &scene, &tree, None, viewpoint, eye)
        })
    })?;
    Ok(Outcome::Done)
}

/// Writes the order of one viewpoint. Polygons of a cell have other numbers in the whole scene.
pub(crate) fn write_order(
    out: &mut dyn Write,
    args: &OrderArgs,
    scene: &Scene,
    tree: &BspTree,
    numbers: Option<&[usize]>,
    viewpoint: Viewpoint,
    eye: Option<usize>,
) -> io::Result<()> {
    let mut fragments = if args.front_to_back {
        tree.order(viewpoint).front_to_back().into_iter()
    } else {
        tree.back_to_front(viewpoint)
    };
    fragments.try_for_each(|fragment| {
        if !args.cull.cull.shows(&fragment, viewpoint) {
            return Ok(());
        }
        let line = Line {
            eye,
            polygon: numbers.map_or(fragment.polygon(), |numbers| numbers[fragment.polygon()]),
            vertices: vertices(&fragment, scene.polygon(fragment.polygon())),
            edges: args.edges.then(|| fragment.edges().collect()),
            weights: args.weights.then(|| weights(&fragment)),
        };
        serde_json::to_writer(&mut *out, &line)?;
        out.write_all(b"\n")
    })
}

/// A line of the output.
#[derive(Serialize)]
struct Line {
    /// The number of the eye, if there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    eye: Option<usize>,
    polygon: usize,
    vertices: Vec<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    edges: Option<Vec<Option<u32>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    weights: Option<Vec<Vec<(u32, f64)>>>,
}

/// The vertices. Corners of the polygon are as in the input, not rounded to the tree's grid.
fn vertices(fragment: &Fragment<'_>, polygon: &[DVec3]) -> Vec<[f64; 3]> {
    let vertices = fragment.vertices().zip(fragment.weights()).map(|(vertex, weights)| {
        let vertex = match weights[..] {
            [(corner, _)] => polygon[corner as usize],
            _ => vertex,
        };
        // Adding 0 turns −0 into 0, as not every JSON reader knows −0.
        (vertex + 0.0).to_array()
    });
    vertices.collect()
}

/// For each vertex, corners of the fragment's polygon and the weights of these corners.
fn weights(fragment: &Fragment<'_>) -> Vec<Vec<(u32, f64)>> {
    let pairs = fragment.weights().map(|weights| {
        let pairs = weights.into_iter().map(|(corner, weight)| (corner, weight + 0.0));
        pairs.collect()
    });
    pairs.collect()
}
