//! The source of the polygons of a scene that need not fit into memory.

use std::collections::HashMap;
use std::ops::ControlFlow;
use std::{io, ptr};

use binspace::glam::DVec3;
use binspace::partition::Extent;
use binspace::scene::{ObjStream, Scene};

use crate::args::SceneArgs;
use crate::failure::Failure;
use crate::formats::{self, Kind};
use crate::progress::Progress;
use crate::scene_arg::{self, Loaded, Source};
use crate::terminal::remark;

/// The most corners that are sampled to choose the planes between cells. Too large: memory. Too small: cells
/// differ in size.
const SAMPLES: usize = 1 << 20;

/// Polygons, read one after the other.
pub(crate) enum Polygons {
    File(Box<ObjStream>),
    /// A scene in memory: a built-in scene, or a scene from a file other than OBJ.
    Whole(Box<Scene>),
}

impl Polygons {
    /// Reads the part before the polygons, or generates a scene.
    pub(crate) fn open(args: &SceneArgs) -> Result<Self, Failure> {
        let name = args.name.to_string_lossy();
        match scene_arg::source(&args.name)? {
            Source::StandardInput => {
                let problem = "`--cells` reads a scene twice: name a file";
                return Err(Failure::about("standard input", problem));
            }
            Source::File(path) if !path.is_dir() => {
                if let (Kind::Obj, beginning) = scene_arg::kind(&path) {
                    let _progress = Progress::spinner(format!("reading {name}"));
                    let file = ObjStream::open(&path)
                        .map_err(|error| formats::not_obj(&name, &beginning, error.to_string()))?;
                    if !file.report().is_clean() {
                        remark(&name, file.report(), file.report());
                    }
                    return Ok(Self::File(Box::new(file)));
                }
            }
            _ => {}
        }
        match scene_arg::load(&args.name, args.seed)? {
            Loaded { scene, tree: None, .. } => Ok(Self::Whole(Box::new(scene))),
            _ => {
                let problem = "it contains a finished tree: name the scene from which it was built";
                Err(Failure::about(name, problem))
            }
        }
    }

    /// The scene without its polygons.
    pub(crate) fn scene(&self) -> Scene {
        match self {
            Self::File(file) => file.scene().clone(),
            Self::Whole(scene) => {
                let mut empty = Scene::new(scene.name(), scene.up());
                if let Some((eye, target)) = scene.suggested_view() {
                    empty = empty.with_view(eye, target);
                }
                for material in scene.materials() {
                    empty.add_material(material.clone());
                }
                empty
            }
        }
    }

    pub(crate) fn len(&self) -> usize {
        match self {
            Self::File(file) => file.polygons(),
            Self::Whole(scene) => scene.len(),
        }
    }

    /// The extent, and some of the corners.
    pub(crate) fn extent_and_samples(&self) -> (Extent, Vec<DVec3>) {
        match self {
            Self::File(file) => extent_and_samples(file.corners(), file.scene().precision()),
            Self::Whole(scene) => {
                let corners = scene.polygons().flat_map(|polygon| polygon.into_iter().copied());
                extent_and_samples(corners, scene.precision())
            }
        }
    }

    /// Calls `visit` with the number, the corners and the material of each polygon.
    pub(crate) fn for_each(
        &self,
        mut visit: impl FnMut(usize, &[DVec3], u32) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let unwritable = |error: io::Error| {
            Failure::about(
                "a temporary file beside the output",
                format!("cannot be written: {error}"),
            )
        };
        match self {
            Self::File(file) => {
                let mut number = 0;
                let read = file.read(|polygon, material| match visit(number, polygon, material) {
                    Ok(()) => {
                        number += 1;
                        ControlFlow::Continue(())
                    }
                    Err(error) => ControlFlow::Break(error),
                });
                match read.map_err(|error| Failure::Message(error.to_string()))? {
                    ControlFlow::Continue(()) => Ok(()),
                    ControlFlow::Break(error) => Err(unwritable(error)),
                }
            }
            Self::Whole(scene) => {
                let numbers = scene.materials().iter().zip(0..);
                let numbers: HashMap<_, u32> =
                    numbers.map(|(material, number)| (ptr::from_ref(material), number)).collect();
                let known = |number: usize| numbers.get(&ptr::from_ref(scene.material(number)));
                let mut polygons = scene.polygons().enumerate();
                polygons
                    .try_for_each(|(number, polygon)| {
                        visit(number, polygon.points(), known(number).copied().unwrap_or(u32::MAX))
                    })
                    .map_err(unwritable)
            }
        }
    }
}

fn extent_and_samples(
    corners: impl Iterator<Item = DVec3> + Clone,
    precision: f64,
) -> (Extent, Vec<DVec3>) {
    let (mut extent, mut count) = (Extent::default(), 0_usize);
    for corner in corners.clone() {
        extent.include(&[corner]);
        count += 1;
    }
    // The precision of the file's decimals, not of a list of corners.
    extent.precision = precision;
    (extent, corners.step_by(count.div_ceil(SAMPLES).max(1)).collect())
}
