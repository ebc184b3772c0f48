//! Scenes divided into cells, judged together; and files of partitions, either forged or with any bytes.

use super::super::cell_orders::{self, Score};
use super::super::divided::{Divided, extent};
use super::super::saved::seal;
use super::super::{cell_cover, decode};
use arbitrary::{Result, Unstructured};
use binspace::glam::DVec3;
use binspace::partition::Partition;
use binspace::{BuildOptions, Viewpoint};

/// The largest number of cells.
const CELLS: usize = 9;

/// In three of four cases, builds a scene and judges it. Otherwise reads the file of a partition, changed or
/// arbitrary, with a right checksum; a partition that is read must be usable.
pub fn run(data: &[u8]) {
    let Some((kind, rest)) = data.split_first() else { return };
    // Too few bytes make no scene, and change nothing.
    let _ = match kind % 8 {
        0 => {
            let mut file = rest.to_vec();
            seal(&mut file);
            try_file(&file, &[]);
            Ok(())
        }
        1 => forge(&mut Unstructured::new(rest)),
        _ => build(&mut Unstructured::new(rest)),
    };
}

/// Some polygons, and samples: all corners, or any points.
fn scene(bytes: &mut Unstructured<'_>) -> Result<(Vec<Vec<DVec3>>, Vec<DVec3>)> {
    let polygons = decode::polygons(bytes, 10)?;
    let samples = if bytes.ratio(1, 4)? { decode::polygons(bytes, 3)? } else { polygons.clone() };
    Ok((polygons, samples.concat()))
}

fn build(bytes: &mut Unstructured<'_>) -> Result<()> {
    let options = decode::options(bytes)?;
    let (seed, cells) = (bytes.arbitrary::<u16>()?.into(), bytes.int_in_range(1..=CELLS)?);
    let (polygons, samples) = scene(bytes)?;
    let is_finite = polygons.iter().flatten().all(|corner| corner.is_finite());
    let scene = match Divided::with_samples(polygons.clone(), options.clone(), samples, cells) {
        Ok(scene) => scene,
        Err(error) => {
            assert!(!is_finite, "{error}");
            return Ok(());
        }
    };
    assert!(is_finite, "a coordinate that is no number passed");
    let judged = cell_cover::check(&scene, options.clone())
        .and_then(|_| cell_orders::judge(&scene, seed, 4, &mut Score::default()));
    if let Err(what) = judged {
        panic!("{what}: {options:?} {cells} cells {polygons:?}");
    }
    assert_eq!(Partition::read(&written(&scene.partition)[..]).unwrap(), scene.partition);
    // The counts equal the counts of the whole scene, for any cells.
    let (whole, sum) = (options.build(&polygons), scene.partition.preparation(&polygons));
    let counts = |found: &binspace::Preparation| {
        [found.dropped, found.triangulated, found.crossing, found.flattened]
    };
    assert_eq!(counts(&sum.unwrap()), counts(whole.unwrap().preparation()), "{polygons:?}");
    Ok(())
}

/// Returns a partition's file.
pub fn written(partition: &Partition) -> Vec<u8> {
    let mut bytes = Vec::new();
    partition.write(&mut bytes).expect("a list takes all");
    bytes
}

fn forge(bytes: &mut Unstructured<'_>) -> Result<()> {
    let cells = bytes.int_in_range(1..=CELLS)?;
    let (polygons, samples) = scene(bytes)?;
    let Ok(partition) = decode::options(bytes)?.partition(&extent(&polygons), samples, cells)
    else {
        return Ok(());
    };
    let mut file = written(&partition);
    while !bytes.is_empty() {
        // Changes begin after the head, because a changed head is always refused.
        let at = bytes.int_in_range(16..=file.len() - 5)?;
        match bytes.int_in_range(0..=3u8)? {
            0 => file[at] = bytes.arbitrary()?,
            1 => file[at] ^= 1 << bytes.int_in_range(0..=7u8)?,
            2 => file[at] = file[at].wrapping_add(1),
            _ => {
                let from = bytes.int_in_range(16..=file.len() - 5)?;
                let len = bytes.int_in_range(1..=12usize)?.min(file.len() - from.max(at));
                file.copy_within(from..from + len, at);
            }
        }
        seal(&mut file);
        try_file(&file, &polygons);
    }
    Ok(())
}

/// Reads a partition, and uses it if it is valid: orders must contain all cells, bounds must not be NaN, and
/// trees of cells must not panic. Returns whether it was valid.
pub fn try_file(file: &[u8], polygons: &[Vec<DVec3>]) -> bool {
    let Ok(partition) = Partition::read(file) else { return false };
    assert_eq!(Partition::read(&written(&partition)[..]).unwrap(), partition);
    for viewpoint in [Viewpoint::eye([0.5, 2.0, -1.0]), Viewpoint::direction([1.0, 0.0, -0.5])] {
        let mut order = partition.back_to_front(viewpoint);
        let mut reverse = partition.front_to_back(viewpoint);
        reverse.reverse();
        assert_eq!(order, reverse);
        order.sort_unstable();
        assert!(order.into_iter().eq(0..partition.cells()));
    }
    let mut given = vec![Vec::new(); partition.cells()];
    let mut reached = Vec::new();
    for polygon in polygons {
        partition.reached_by(polygon, &mut reached);
        reached.iter().for_each(|&cell| given[cell].push(polygon));
    }
    for (cell, given) in given.iter().enumerate() {
        let [low, high] = partition.bounds(cell);
        assert!(!low.is_nan() && !high.is_nan());
        // The grid may be different, and the polygons may be outside it.
        let built = [given.clone(), polygons.iter().collect()]
            .map(|polygons| BuildOptions::DEFAULT.build_cell(&partition, cell, polygons));
        let [Ok(tree), Ok(all)] = built else { continue };
        tree.validate().unwrap();
        assert!(partition.is_tree_of(cell, &tree));
        assert_eq!(tree.len(), all.len());
    }
    true
}
