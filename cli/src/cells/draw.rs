//! Pictures and orders of scenes in folders: cell after cell, with one cell in memory at a time.

use std::io;
use std::path::Path;

use binspace::Viewpoint;
use binspace::glam::DVec3;
use binspace::paint::for_each_painted;
use binspace::raster::{Rays, blend};
use binspace::scene::Scene;
use binspace::view::Camera;

use super::folder::{Cell, Folder};
use crate::args::{OrderArgs, RenderArgs};
use crate::camera;
use crate::colours::{BACKGROUND, Colours};
use crate::commands::order::write_order;
use crate::failure::Failure;
use crate::files::Output;
use crate::pictures::{Kind, rows_at_once};
use crate::png_file;
use crate::progress::Progress;
use crate::samples::averaged;

/// `binspace render`.
pub(crate) fn render(args: &RenderArgs, path: &Path, output: Output) -> Result<(), Failure> {
    if Kind::asked(&args.kind) != Kind::Painter {
        let problem = "cells can only be painted: for a depth buffer, name the scene from which they were \
             built";
        return Err(Failure::about(path.display(), problem));
    }
    let folder = Folder::open(path)?;
    let camera = camera::asked(&args.view, &boxed(&folder.bounds), None)?;
    let order = folder.partition.back_to_front(camera.viewpoint());
    let pixels = paint(args, &folder, &camera, &order)?;
    output.write(|out| png_file::write(out, camera.size(), &pixels))
}

/// The bounding box as a scene, for cameras that must show the whole scene.
fn boxed(bounds: &Scene) -> Scene {
    let &[low, high] = bounds.polygon(0) else { return bounds.clone() };
    let corner = |k: usize| {
        DVec3::from_array(std::array::from_fn(|i| if k >> i & 1 == 1 { high[i] } else { low[i] }))
    };
    let mut scene = bounds.clone();
    scene.push([0, 1, 3, 2, 6, 7, 5, 4].map(corner), u32::MAX);
    scene
}

/// Paints the cells one after the other, each over the cells before it.
fn paint(
    args: &RenderArgs,
    folder: &Folder,
    camera: &Camera,
    order: &[usize],
) -> Result<Vec<u8>, Failure> {
    let (samples, [width, height]) = (args.samples, camera.size());
    let [columns, rows] = [width, height].map(|side| side * samples);
    let step = rows_at_once([columns, rows], samples);
    let progress =
        Progress::steps("drawing: cell", u64::from(rows.div_ceil(step)) * order.len() as u64);
    let mut rgb = Vec::new();
    for start in (0..rows).step_by(step as usize) {
        let end = start.saturating_add(step).min(rows);
        let mut pixels = vec![BACKGROUND.map(f32::from); columns as usize * (end - start) as usize];
        for &number in order {
            let cell = folder.cell(number)?;
            let rays = Rays::sampled(camera, cell.tree.faces(), samples)
                .map_err(|error| camera::about(&folder.bounds, &error))?;
            let rays = args.look.cull.cull.rays(rays.rows(start..end));
            let colours = Colours::new(&cell.scene, args.look.colours).numbered(&cell.numbers);
            let look = |polygon| (colours.rgb(polygon), colours.opacity(polygon));
            let viewpoint = camera.viewpoint();
            for_each_painted(&cell.tree, viewpoint, &rays, look, |pixel, colour, opacity| {
                blend(&mut pixels[pixel], colour, opacity);
            });
            progress.step();
        }
        let part = pixels.into_iter().flatten().map(|channel| channel.round() as u8).collect();
        rgb.extend(averaged(part, width as usize, samples as usize));
    }
    Ok(rgb)
}

/// `binspace order`.
pub(crate) fn order(
    args: &OrderArgs,
    path: &Path,
    viewpoints: &[Viewpoint],
    output: Output,
) -> Result<(), Failure> {
    let folder = Folder::open(path)?;
    let mut failure = None;
    let written = output.write(|out| {
        for (k, &viewpoint) in viewpoints.iter().enumerate() {
            let mut cells = folder.partition.back_to_front(viewpoint);
            if args.front_to_back {
                cells.reverse();
            }
            let eye = (viewpoints.len() > 1).then_some(k);
            for number in cells {
                let cell = match folder.cell(number) {
                    Ok(cell) => cell,
                    Err(error) => {
                        failure = Some(error);
                        return Err(io::ErrorKind::InvalidData.into());
                    }
                };
                let Cell { tree, scene, numbers } = &cell;
                write_order(out, args, scene, tree, Some(numbers), viewpoint, eye)?;
            }
        }
        Ok(())
    });
    written.map_err(|error| failure.unwrap_or(error))
}
