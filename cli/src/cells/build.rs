//! `binspace build --cells`: one tree after the other.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Seek, Write};
use std::path::Path;

use binspace::glam::DVec3;
use binspace::scene::Scene;
use binspace::{BuildOptions, Partition};

use super::folder::{Cell, NewFolder};
use super::source::Polygons;
use crate::args::BuildFileArgs;
use crate::failure::Failure;
use crate::job;
use crate::progress::Progress;
use crate::terminal::note;
use crate::units::count;

/// How many bytes wait to be written, for each cell. Smaller: more calls; larger: more memory.
const WAITING: usize = 1 << 14;

/// Builds the trees of a scene's cells, in memory for one at a time and for the vertices of the scene.
pub(crate) fn run(args: &BuildFileArgs, cells: usize) -> Result<(), Failure> {
    let mut folder = NewFolder::create(&args.output)?;
    let polygons = Polygons::open(&args.scene)?;
    let (name, total) = (polygons.scene().name().to_owned(), polygons.len());
    let options = args.build.limits.options(args.build.heuristic.unwrap_or_default());
    let about = |error| job::about(&polygons.scene(), &error);
    let (extent, samples) = polygons.extent_and_samples();
    let partition = options.partition(&extent, samples, cells).map_err(about)?;
    let parts = divide(&polygons, &partition, folder.beside())?;
    let mut whole = polygons.scene();
    whole.push([extent.low, extent.high], u32::MAX);
    let empty = polygons.scene();
    drop(polygons);
    folder.add_partition(&partition, &whole)?;
    let progress = Progress::steps("building: cell", cells as u64);
    let mut shown = Shown::new(total);
    for (number, part) in parts.into_iter().enumerate() {
        let cell = build(&options, &partition, number, &empty, part)?;
        for fragment in cell.tree.fragments() {
            shown.mark(cell.numbers[fragment.polygon()]);
        }
        folder.add_cell(&cell)?;
        progress.step();
    }
    drop(progress);
    match total - shown.count {
        0 => {}
        _ if shown.count == 0 => return Err(Failure::about(name, job::NOTHING_LEFT)),
        dropped => note(&format!("{name}: {} without area dropped", count(dropped, "face"))),
    }
    folder.finish()
}

/// Which polygons have been seen in some cell.
struct Shown {
    bits: Vec<u64>,
    count: usize,
}

impl Shown {
    fn new(polygons: usize) -> Self {
        Self { bits: vec![0; polygons.div_ceil(64)], count: 0 }
    }

    fn mark(&mut self, polygon: usize) {
        let (word, bit) = (&mut self.bits[polygon / 64], 1 << (polygon % 64));
        self.count += usize::from(*word & bit == 0);
        *word |= bit;
    }
}

/// Writes the polygons that reach each cell to a file without a name.
fn divide(polygons: &Polygons, partition: &Partition, beside: &Path) -> Result<Vec<File>, Failure> {
    let unwritable = |error: io::Error| {
        Failure::about(beside.display(), format!("cannot be written to: {error}"))
    };
    let file = |_| Ok(BufWriter::with_capacity(WAITING, crate::unfinished::create_in(beside)?));
    let files: io::Result<Vec<BufWriter<File>>> = (0..partition.cells()).map(file).collect();
    let mut files = files.map_err(unwritable)?;
    let _progress = Progress::spinner("dividing");
    let mut reached = Vec::new();
    polygons.for_each(|number, corners, material| {
        partition.reached_by(corners, &mut reached);
        reached.iter().try_for_each(|&cell| {
            let file = &mut files[cell];
            file.write_all(&(number as u64).to_le_bytes())?;
            file.write_all(&material.to_le_bytes())?;
            file.write_all(&(corners.len() as u32).to_le_bytes())?;
            corners
                .iter()
                .flat_map(|corner| corner.to_array())
                .try_for_each(|c| file.write_all(&c.to_le_bytes()))
        })
    })?;
    let rewound = |file: BufWriter<File>| {
        let mut file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.rewind()?;
        Ok(file)
    };
    files.into_iter().map(rewound).collect::<io::Result<_>>().map_err(unwritable)
}

/// Builds the tree of a cell, of the polygons in a file.
fn build(
    options: &BuildOptions,
    partition: &Partition,
    number: usize,
    empty: &Scene,
    part: File,
) -> Result<Cell, Failure> {
    let mut scene = empty.clone();
    let read = read_polygons(&mut scene, part);
    let numbers = read.map_err(|error| {
        Failure::about("a file beside the output", format!("cannot be read: {error}"))
    })?;
    let tree = options.build_cell(partition, number, scene.polygons());
    let tree = tree.map_err(|error| job::about(&scene, &error))?;
    Ok(Cell { tree, scene, numbers })
}

fn read_polygons(scene: &mut Scene, part: File) -> io::Result<Vec<usize>> {
    let (mut left, mut numbers) = (part.metadata()?.len(), Vec::new());
    let mut part = BufReader::with_capacity(1 << 16, part);
    while left > 0 {
        let number = u64::from_le_bytes(bytes(&mut part)?);
        let material = u32::from_le_bytes(bytes(&mut part)?);
        let len = u32::from_le_bytes(bytes(&mut part)?);
        let mut corner = || -> io::Result<DVec3> {
            let mut corner = DVec3::ZERO;
            for axis in 0..3 {
                corner[axis] = f64::from_le_bytes(bytes(&mut part)?);
            }
            Ok(corner)
        };
        let corners: Vec<DVec3> = (0..len).map(|_| corner()).collect::<io::Result<_>>()?;
        scene.push(corners, material);
        numbers.push(number as usize);
        left = left.saturating_sub(16 + 24 * u64::from(len));
    }
    Ok(numbers)
}

fn bytes<const N: usize>(input: &mut impl Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    input.read_exact(&mut bytes)?;
    Ok(bytes)
}
