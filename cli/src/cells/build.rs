//! `binspace build --cells`: one tree after the other.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Seek, Write};
use std::path::Path;

use binspace::glam::DVec3;
use binspace::partition::Partition;
use binspace::scene::Scene;
use binspace::{BuildOptions, Error, Preparation};

use super::folder::{Cell, NewFolder};
use super::source::Polygons;
use crate::args::BuildFileArgs;
use crate::failure::Failure;
use crate::job;
use crate::progress::Progress;

/// Bytes buffered for each cell. Too small: more calls. Too large: more memory.
const WAITING: usize = 1 << 14;

/// Builds the trees of a scene's cells. Needs memory for one tree at a time, and for the vertices of the
/// scene.
pub(crate) fn run(args: &BuildFileArgs, cells: usize) -> Result<(), Failure> {
    let mut folder = NewFolder::create(&args.output)?;
    let polygons = Polygons::open(&args.scene)?;
    let (name, total) = (polygons.scene().name().to_owned(), polygons.len());
    let options = args.build.limits.options(args.build.heuristic);
    let about = |error| job::about(&polygons.scene(), &error);
    let (extent, samples) = polygons.extent_and_samples();
    let partition = options.partition(&extent, samples, cells).map_err(about)?;
    let (parts, quads) = divide(&polygons, &partition, folder.beside())?;
    let mut whole = polygons.scene();
    whole.push([extent.low, extent.high], u32::MAX);
    let empty = polygons.scene();
    drop(polygons);
    folder.add_partition(&partition, &whole)?;
    let progress = Progress::steps("building: cell", cells as u64);
    let mut found = Found::new(total);
    for (number, part) in parts.into_iter().enumerate() {
        let cell = build(&options, &partition, number, &empty, part, &mut found)?;
        folder.add_cell(&cell)?;
        progress.step();
    }
    drop(progress);
    let Found { sum, .. } = found;
    job::note_length(&empty, &args.build.limits, partition.tolerance(), &sum, quads);
    job::note_found(&empty, found.dropped(), &sum);
    if sum.dropped == total {
        return Err(Failure::about(name, job::NOTHING_LEFT));
    }
    let _progress = Progress::spinner("writing");
    folder.finish()
}

/// The preparation figures of the polygons of all cells.
struct Found {
    /// Each polygon counts in one cell: the first cell that contains its least corner.
    sum: Preparation,
    /// The polygons that are in some cell: one bit per polygon.
    shown: Vec<u64>,
}

impl Found {
    /// Creates the figures of no cells.
    fn new(polygons: usize) -> Self {
        let mut sum = Preparation::default();
        (sum.polygons, sum.dropped) = (polygons, polygons);
        Self { sum, shown: vec![0; polygons.div_ceil(64)] }
    }

    /// Adds a cell, and the preparation figures of the polygons that count in this cell.
    fn add(&mut self, cell: &Cell, counted: &Preparation) {
        let Self { sum, shown } = self;
        for fragment in cell.tree.fragments() {
            let polygon = cell.numbers[fragment.polygon()];
            let (word, bit) = (&mut shown[polygon / 64], 1 << (polygon % 64));
            sum.dropped -= usize::from(*word & bit == 0);
            *word |= bit;
        }
        sum.triangulated += counted.triangulated;
        sum.crossing += counted.crossing;
        sum.bent += counted.bent;
        sum.bent_by = sum.bent_by.max(counted.bent_by);
    }

    fn dropped(&self) -> impl Iterator<Item = usize> {
        (0..self.sum.polygons)
            .filter(|&polygon| self.shown[polygon / 64] >> (polygon % 64) & 1 == 0)
    }
}

/// Writes the polygons that reach each cell to a file without a name. Counts polygons of four corners or
/// more.
fn divide(
    polygons: &Polygons,
    partition: &Partition,
    beside: &Path,
) -> Result<(Vec<File>, usize), Failure> {
    let unwritable = |error: io::Error| {
        Failure::about(beside.display(), format!("cannot be written to: {error}"))
    };
    let file = |_| Ok(BufWriter::with_capacity(WAITING, tempfile::tempfile_in(beside)?));
    let files: io::Result<Vec<BufWriter<File>>> = (0..partition.cells()).map(file).collect();
    let mut files = files.map_err(unwritable)?;
    let _progress = Progress::spinner("dividing");
    let (mut reached, mut quads) = (Vec::new(), 0);
    polygons.for_each(|number, corners, material| {
        quads += usize::from(corners.len() > 3);
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
    let files: io::Result<_> = files.into_iter().map(rewound).collect();
    Ok((files.map_err(unwritable)?, quads))
}

/// Builds the tree of a cell, of the polygons in a file.
fn build(
    options: &BuildOptions,
    partition: &Partition,
    number: usize,
    empty: &Scene,
    part: File,
    found: &mut Found,
) -> Result<Cell, Failure> {
    let mut scene = empty.clone();
    let read = read_polygons(&mut scene, part);
    let numbers = read.map_err(|error| {
        Failure::about("a temporary file beside the output", format!("cannot be read: {error}"))
    })?;
    let mut reached = Vec::new();
    let counted = scene.polygons().filter(|polygon| {
        let corners = polygon.points().iter().map(|corner| corner.to_array());
        let least = corners.reduce(|a, b| if b < a { b } else { a });
        reached.clear();
        least.inspect(|corner| partition.reached_by(&[*corner], &mut reached));
        reached.first() == Some(&number)
    });
    let counted = partition.preparation(counted);
    let tree = options.build_cell(partition, number, scene.polygons());
    let tree = tree.map_err(|error| about(&scene, &numbers, error))?;
    let counted = counted.map_err(|error| job::about(&scene, &error))?;
    let cell = Cell { tree, scene, numbers };
    found.add(&cell, &counted);
    Ok(cell)
}

/// A failure to build the tree of a cell, with the polygon to blame by its number in the whole scene.
fn about(scene: &Scene, numbers: &[usize], error: Error) -> Failure {
    match error.polygon().and_then(|place| numbers.get(place)) {
        Some(&number) => job::about(scene, &error.with_polygon(number)),
        None => job::about(scene, &error),
    }
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

#[cfg(test)]
mod tests {
    use binspace::partition::Extent;

    use super::*;

    #[test]
    fn errors_name_polygons_by_their_numbers_in_the_scene() {
        let triangle = |x: f64| vec![DVec3::ZERO, DVec3::X * x, DVec3::Y];
        let mut extent = Extent::default();
        extent.include(&triangle(1.0));
        let options = BuildOptions::DEFAULT;
        let partition = options.partition(&extent, [DVec3::ZERO], 2).unwrap();
        let mut scene = Scene::new("s", DVec3::Z);
        for x in [1.0, 1.0, f64::NAN] {
            scene.push(triangle(x), u32::MAX);
        }
        let error = options.build_cell(&partition, 1, scene.polygons()).unwrap_err();
        let Failure::Message(message) = about(&scene, &[4, 7, 90], error) else { panic!() };
        assert!(message.starts_with("s: polygon 90 has a coordinate that is NaN"), "{message}");
    }
}
