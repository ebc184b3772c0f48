//! Drawings of views beside the plain list of the tree's fragments.

use std::io;
use std::time::Instant;

use binspace::drawing::ViewOptions;
use binspace::paint::paint_tree;
use binspace::raster::Rays;
use binspace::scene::{Builtin, Scene};
use binspace::view::Camera;
use binspace::{BspTree, BuildOptions};
use binspace_evidence::measure::{FillError, Filled as Judge};

use super::MAX_PIECES;
use crate::args::ReportArgs;
use crate::camera::{self, FIELD_OF_VIEW};
use crate::colours::{Colouring, Colours};
use crate::cull::Cull;
use crate::drawn::{Style, add_drawing, blank};
use crate::failure::Failure;
use crate::pictures::Drawing;
use crate::progress::Progress;
use crate::seams::Seams;
use crate::svg;

/// The scenes that every report draws, with their sizes.
const SCENES: [(Builtin, Option<u32>); 6] = [
    (Builtin::Newell, None),
    (Builtin::Cornell, None),
    (Builtin::Teapot, Some(8)),
    (Builtin::City, Some(600)),
    (Builtin::Terrain, Some(2000)),
    (Builtin::Random, Some(500)),
];

/// A view as a drawing, all polygons opaque, and as a list.
pub(super) struct Drawings {
    pub(super) scene: String,
    pub(super) polygons: usize,
    /// The figures, or why there are none.
    pub(super) found: Result<Figures, String>,
}

pub(super) struct Figures {
    pub(super) fragments: usize,
    pub(super) visible: usize,
    pub(super) paths: usize,
    pub(super) clipped: usize,
    /// Of the drawing's file, of that without the reach of paths under others, and of the list's, with strokes.
    pub(super) bytes: [u64; 3],
    /// To build the tree, and to draw.
    pub(super) seconds: [f64; 2],
    pub(super) error: FillError,
}

/// Draws one view of each scene, and hands over one after another.
pub(super) fn run(
    args: &ReportArgs,
    scenes: &[Scene],
    size: [u32; 2],
    mut add: impl FnMut(Drawings) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let progress = Progress::steps("drawings: scene", (SCENES.len() + scenes.len()) as u64);
    let mut each = |scene: &Scene| {
        let found = draw(scene, size).map_err(|failure| match failure {
            Failure::Message(problem) => problem,
            _ => String::new(),
        });
        progress.step();
        add(Drawings { scene: scene.name().to_owned(), polygons: scene.len(), found })
    };
    for (builtin, count) in SCENES {
        each(&builtin.build(count, args.seed))?;
    }
    scenes.iter().try_for_each(each)
}

fn draw(scene: &Scene, size: [u32; 2]) -> Result<Figures, Failure> {
    let about = |error| Failure::about(scene.name(), error);
    let start = Instant::now();
    let options = BuildOptions::DEFAULT.with_max_fragments(MAX_PIECES);
    let tree = options.build(scene.polygons()).map_err(about)?;
    let built = start.elapsed().as_secs_f64();
    let camera = camera::whole(scene, None, FIELD_OF_VIEW, size)?;
    let rays = Rays::new(&camera, tree.faces()).map_err(|error| camera::about(scene, &error))?;
    let truth = paint_tree(&tree, camera.viewpoint(), &rays);
    let start = Instant::now();
    let map = tree.visibility(&camera, &ViewOptions::DEFAULT).map_err(about)?;
    let drawing = map.drawing().map_err(about)?;
    let drawn = start.elapsed().as_secs_f64();
    let mut judge = Judge::new(size);
    drawing.paths().for_each(|path| judge.fill(path.polygon(), path.outlines()));
    let colours = Colours::new(scene, Colouring::Material);
    let bytes = |seams| bytes_of(&drawing, scene, &camera, &colours, seams);
    Ok(Figures {
        fragments: tree.len(),
        visible: map.polygons().count(),
        paths: drawing.paths().len(),
        clipped: drawing.paths().filter(|path| path.is_clipped()).count(),
        bytes: [
            bytes(Seams::Trap),
            bytes(Seams::None),
            bytes_of_list(&tree, scene, &camera, &colours)?,
        ],
        seconds: [built, drawn],
        error: judge.compare(tree.faces(), &truth),
    })
}

/// How long the file of a drawing is.
fn bytes_of(
    drawing: &binspace::drawing::Drawing,
    scene: &Scene,
    camera: &Camera,
    colours: &Colours<'_>,
    seams: Seams,
) -> u64 {
    let style = Style { scene, camera, colours, ids: false, is_opaque: true, seams };
    let mut picture = blank(camera);
    add_drawing(&mut picture, drawing, &style);
    picture.to_svg().len() as u64
}

fn bytes_of_list(
    tree: &BspTree,
    scene: &Scene,
    camera: &Camera,
    colours: &Colours<'_>,
) -> Result<u64, Failure> {
    let list = Drawing { tree, camera, colours, cull: Cull::None, samples: 1 };
    let mut counted = Counted(0);
    svg::write(&mut counted, &list, scene).map_err(|error| Failure::of_output(&error))?;
    Ok(counted.0)
}

/// Counts bytes instead of writing them.
struct Counted(u64);

impl io::Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
