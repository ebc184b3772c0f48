//! Direct send: each pixel has an owner, which receives the layers of all cells there, and blends them.
//!
//! Blending "over" is associative in real numbers, but not in rounded ones. If cells were blended separately,
//! and then with each other, the last bits would differ from the picture of one process. So ranks send layers
//! that are not yet blended, and the owner blends layer over layer, as one process does.

use binspace::raster::blend;
use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;

use crate::exchange;
use crate::picture::{BACKGROUND, LAYER, Layer};

/// Blends the layers of all ranks' cells, given the order of the cells, the furthest first. Returns the
/// picture on rank 0, and the number of bytes of layers that this rank has sent to others.
pub(crate) fn blended(
    world: &SimpleCommunicator,
    size: [u32; 2],
    order: &[usize],
    layers: Vec<Layer>,
) -> (u64, Option<Vec<u8>>) {
    let pixels = size[0] as usize * size[1] as usize;
    let (rank, ranks) = (world.rank() as usize, world.size() as usize);
    // Ranks own rows in turn, because neighbouring rows need about the same amount of blending.
    let owner = |pixel: u32| (pixel / size[0]) as usize % ranks;
    let mut outgoing = vec![Vec::new(); ranks];
    for layer in &layers {
        outgoing[owner(layer.pixel)].extend(layer.bytes());
    }
    drop(layers);
    let sent = outgoing.iter().map(Vec::len).sum::<usize>() - outgoing[rank].len();
    let incoming = exchange::all_to_all(world, outgoing);
    let mut colours = vec![BACKGROUND.map(f32::from); pixels];
    for &cell in order {
        for bytes in incoming[cell].as_chunks::<LAYER>().0 {
            let Layer { pixel, colour, opacity } = Layer::of(bytes);
            blend(&mut colours[pixel as usize], colour, opacity);
        }
    }
    let mut own = Vec::new();
    for (y, row) in colours.chunks(size[0] as usize).enumerate() {
        if y % ranks == rank {
            own.extend(row.iter().flatten().map(|channel| channel.round() as u8));
        }
    }
    // All rows to rank 0.
    let mut outgoing = vec![Vec::new(); ranks];
    outgoing[0] = own;
    let rows = exchange::all_to_all(world, outgoing);
    let picture = (rank == 0).then(|| {
        let width = 3 * size[0] as usize;
        let mut picture = Vec::with_capacity(3 * pixels);
        for y in 0..size[1] as usize {
            picture.extend_from_slice(&rows[y % ranks][y / ranks * width..][..width]);
        }
        picture
    });
    (sent as u64, picture)
}
