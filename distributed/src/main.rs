//! Draws scenes that are spread over many processes, in exact order.
//!
//! Each MPI rank reads or generates a share of the polygons. All ranks agree on the extent and, from samples,
//! on the planes between cells, one cell per rank. Polygons go to the ranks whose cells they reach. Each rank
//! builds the tree of its cell, and paints it. The visible layers of a pixel go to the rank that owns the
//! pixel, which blends them in the order of the cells.

mod agree;
mod arguments;
mod composite;
mod exchange;
mod figures;
mod picture;
mod polygon;
mod share;

use std::process::ExitCode;
use std::time::Instant;

use binspace::partition::{Extent, Partition};
use binspace::raster::Rays;
use binspace::view::Camera;
use binspace::{BspTree, BuildOptions};
use clap::Parser;
use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;

use agree::{Failure, together};
use arguments::Arguments;
use figures::{Figures, processor_time};
use polygon::Given;
use share::Share;

/// The approximate number of samples that choose the planes between cells. Too large: choosing takes longer.
/// Too small: cells differ in size.
const SAMPLES: u64 = 1 << 16;

fn main() -> ExitCode {
    let Some(universe) = mpi::initialize() else {
        eprintln!("error: MPI cannot be initialized");
        return ExitCode::from(2);
    };
    let world = universe.world();
    agree::abort_on_panic();
    match run(&world) {
        Ok(()) => ExitCode::SUCCESS,
        // The rank with the error has reported it.
        Err(Failure) => ExitCode::from(2),
    }
}

/// The work of a rank. After an error on any rank, all ranks return.
fn run(world: &SimpleCommunicator) -> Result<(), Failure> {
    let arguments = match Arguments::try_parse() {
        // Requested output, such as help, is not an error: rank 0 prints it.
        Err(answer) if !answer.use_stderr() => {
            if rank(world) == 0 {
                print!("{answer}");
            }
            return Ok(());
        }
        parsed => together(world, parsed.map_err(|error| plain(&error)))?,
    };
    // The error is reported before the work, not after it.
    let is_writer = rank(world) == 0;
    together(world, if is_writer { picture::check(&arguments.output) } else { Ok(()) })?;
    let mut figures = Figures::default();
    let (start, begin) = (Instant::now(), processor_time());
    let share = Share::load(&arguments.scene, rank(world), ranks(world));
    figures.read = processor_time() - begin;
    let share = together(world, share)?;
    figures.given = share.polygons.len() as u64;
    if arguments.alone {
        return alone(world, &arguments, &share);
    }
    let mut extent = share.extent();
    exchange::merge(world, &mut extent);
    let begin = Instant::now();
    let options = arguments.options();
    let partition = divide(world, &options, &extent, &share)?;
    let (sent, mine) = send_polygons(world, &partition, share);
    figures.polygon_bytes = sent;
    figures.received = mine.len() as u64;
    figures.exchange = begin.elapsed();
    let begin = processor_time();
    let tree = options.build_cell(&partition, rank(world), &mine);
    figures.build = processor_time() - begin;
    let tree = together(world, tree.map_err(|error| share::about(&arguments.scene, &mine, error)))?;
    figures.fragments = tree.len() as u64;
    figures.polygons = (mine.len() - tree.preparation().dropped) as u64;
    let begin = processor_time();
    let (camera, rays) = together(world, camera_and_rays(&arguments, &extent, &tree))?;
    let layers = picture::layers(&tree, &camera, &rays, &mine);
    figures.paint = processor_time() - begin;
    figures.layers = layers.len() as u64;
    let begin = Instant::now();
    let order = partition.back_to_front(camera.viewpoint());
    let (sent, pixels) = composite::blended(world, camera.size(), &order, layers);
    figures.layer_bytes = sent;
    figures.composite = begin.elapsed();
    let written = match pixels {
        Some(pixels) => picture::write(&arguments.output, camera.size(), &pixels),
        None => Ok(()),
    };
    together(world, written)?;
    figures.all = start.elapsed();
    figures.report(world, arguments.figures);
    Ok(())
}

/// The error of a command line.
fn plain(error: &clap::Error) -> String {
    let text = error.to_string();
    text.strip_prefix("error: ").unwrap_or(&text).trim_end().to_owned()
}

fn rank(world: &SimpleCommunicator) -> usize {
    world.rank() as usize
}

fn ranks(world: &SimpleCommunicator) -> usize {
    world.size() as usize
}

/// The cells, one for each rank. Rank 0 makes them from samples, and sends them to all ranks.
fn divide(
    world: &SimpleCommunicator,
    options: &BuildOptions,
    extent: &Extent,
    share: &Share,
) -> Result<Partition, Failure> {
    let total = exchange::sum(world, share.polygons.len() as u64);
    // The choice of samples does not depend on the distribution of polygons, so neither do the cells.
    let stride = total.div_ceil(SAMPLES).max(1);
    let samples = share.polygons.iter().filter(|given| mixed(given.number).is_multiple_of(stride));
    let own: Vec<f64> = samples.flat_map(|given| given.corners[0].to_array()).collect();
    let samples = exchange::gather(world, &own);
    let made = samples.map_or(Ok(Vec::new()), |samples| {
        let points = samples.as_chunks::<3>().0.iter().copied();
        let partition = options.partition(extent, points, ranks(world));
        let mut bytes = Vec::new();
        let written = partition
            .map_err(|error| error.to_string())
            .and_then(|partition| partition.write(&mut bytes).map_err(|error| error.to_string()));
        written.map(|()| bytes)
    });
    let bytes = exchange::broadcast(world, together(world, made)?);
    together(world, Partition::read(&bytes[..]).map_err(|error| error.to_string()))
}

/// A hash of a number. For any pattern of numbers, the share of hashes that are multiples of a divisor is
/// about the same.
fn mixed(number: u64) -> u64 {
    let bits = (number ^ number >> 31).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (bits ^ bits >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 32
}

/// Sends each polygon to the ranks whose cells it reaches. Returns the number of bytes that this rank has
/// sent, and the polygons that it has received, in the order of their numbers.
fn send_polygons(
    world: &SimpleCommunicator,
    partition: &Partition,
    share: Share,
) -> (u64, Vec<Given>) {
    let mut outgoing = vec![Vec::new(); ranks(world)];
    let mut reached = Vec::new();
    for given in &share.polygons {
        partition.reached_by(given, &mut reached);
        reached.iter().for_each(|&cell| given.write(&mut outgoing[cell]));
    }
    // The memory of the share is freed before other polygons arrive.
    drop(share);
    let own = outgoing[rank(world)].len();
    let sent = outgoing.iter().map(Vec::len).sum::<usize>() - own;
    let incoming = exchange::all_to_all(world, outgoing);
    let mut mine: Vec<Given> = Vec::new();
    for bytes in incoming {
        mine.extend(Given::read_all(&bytes));
    }
    // Coplanar polygons are painted in input order.
    mine.sort_unstable_by_key(|given| given.number);
    (sent as u64, mine)
}

fn camera_and_rays(
    arguments: &Arguments,
    extent: &Extent,
    tree: &BspTree,
) -> Result<(Camera, Rays), String> {
    let camera = arguments.camera(extent).map_err(|error| error.to_string())?;
    let rays = Rays::new(&camera, tree.faces()).map_err(|error| error.to_string())?;
    Ok((camera, rays))
}

/// The picture that the library paints from one tree without cells, for comparison. Only for one rank.
fn alone(world: &SimpleCommunicator, arguments: &Arguments, share: &Share) -> Result<(), Failure> {
    let draw = || -> Result<(), String> {
        if ranks(world) > 1 {
            return Err("--alone is for one rank".to_owned());
        }
        let tree = arguments.options().build(&share.polygons);
        let tree = tree.map_err(|error| share::about(&arguments.scene, &share.polygons, error))?;
        let (camera, rays) = camera_and_rays(arguments, &share.extent(), &tree)?;
        let look =
            |polygon: usize| (share.polygons[polygon].colour, share.polygons[polygon].opacity);
        let viewpoint = camera.viewpoint();
        let pixels = binspace::paint::paint_tree_in_colour(
            &tree,
            viewpoint,
            &rays,
            look,
            picture::BACKGROUND,
        );
        picture::write(&arguments.output, camera.size(), &pixels)
    };
    together(world, draw())
}
