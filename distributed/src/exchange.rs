//! The messages between ranks.

use binspace::partition::Extent;
use mpi::collective::SystemOperation;
use mpi::datatype::{Partition, PartitionMut};
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives, Root};

/// The largest number of bytes that one rank sends to all others at a time. Too large: more memory, and
/// counts that do not fit MPI's `int`. Too small: more rounds.
const AT_ONCE: usize = 1 << 26;

/// The sum of a number over all ranks.
pub(crate) fn sum(world: &SimpleCommunicator, own: u64) -> u64 {
    let mut total = 0;
    world.all_reduce_into(&own, &mut total, SystemOperation::sum());
    total
}

/// Merges the extents of all shares into the scene's extent.
pub(crate) fn merge(world: &SimpleCommunicator, extent: &mut Extent) {
    let [low, high] = [extent.low, extent.high].map(|corner| corner.to_array());
    // The reduction takes the minimum of each number.
    let own = [low[0], low[1], low[2], -high[0], -high[1], -high[2], -extent.precision];
    let mut all = own;
    world.all_reduce_into(&own[..], &mut all[..], SystemOperation::min());
    let [a, b, c, d, e, f, precision] = all;
    *extent = Extent { low: [a, b, c].into(), high: [-d, -e, -f].into(), precision: -precision };
}

/// The numbers of all ranks, in the order of the ranks, on rank 0.
pub(crate) fn gather(world: &SimpleCommunicator, own: &[f64]) -> Option<Vec<f64>> {
    let root = world.process_at_rank(0);
    let count = own.len() as i32;
    if world.rank() != 0 {
        root.gather_into(&count);
        root.gather_varcount_into(own);
        return None;
    }
    let mut counts = vec![0_i32; world.size() as usize];
    root.gather_into_root(&count, &mut counts[..]);
    let starts = starts(&counts);
    let mut all = vec![0.0; counts.iter().map(|&count| count as usize).sum()];
    let mut parts = PartitionMut::new(&mut all[..], counts, &starts[..]);
    root.gather_varcount_into_root(own, &mut parts);
    Some(all)
}

/// The bytes of rank 0, on all ranks.
pub(crate) fn broadcast(world: &SimpleCommunicator, own: Vec<u8>) -> Vec<u8> {
    let root = world.process_at_rank(0);
    let (mut len, mut bytes) = (own.len() as u64, own);
    root.broadcast_into(&mut len);
    bytes.resize(len as usize, 0);
    root.broadcast_into(&mut bytes[..]);
    bytes
}

/// Sends each rank a list of bytes, and returns the lists that the ranks have sent to this one.
pub(crate) fn all_to_all(world: &SimpleCommunicator, outgoing: Vec<Vec<u8>>) -> Vec<Vec<u8>> {
    let ranks = outgoing.len();
    let each = (AT_ONCE / ranks).max(1);
    let mut incoming = vec![Vec::new(); ranks];
    let longest = outgoing.iter().map(Vec::len).max().unwrap_or(0);
    let own = longest.div_ceil(each) as u64;
    let mut rounds = 0;
    world.all_reduce_into(&own, &mut rounds, SystemOperation::max());
    for round in 0..rounds as usize {
        let part = |bytes: &Vec<u8>| {
            let begin = bytes.len().min(round * each);
            begin..bytes.len().min(begin + each)
        };
        let parts = outgoing.iter().map(|bytes| &bytes[part(bytes)]);
        let counts: Vec<i32> = parts.clone().map(|part| part.len() as i32).collect();
        let mut sent = buffer(parts.clone().map(<[u8]>::len).sum());
        parts.for_each(|part| sent.extend_from_slice(part));
        let mut expected = vec![0_i32; ranks];
        world.all_to_all_into(&counts[..], &mut expected[..]);
        let (from, to) = (starts(&counts), starts(&expected));
        let len = expected.iter().map(|&count| count as usize).sum();
        let mut received = buffer(len);
        received.resize(len, 0);
        {
            let sent = Partition::new(&sent[..], counts, &from[..]);
            let mut received = PartitionMut::new(&mut received[..], &expected[..], &to[..]);
            world.all_to_all_varcount_into(&sent, &mut received);
        }
        for (rank, list) in incoming.iter_mut().enumerate() {
            list.extend_from_slice(&received[to[rank] as usize..][..expected[rank] as usize]);
        }
    }
    incoming
}

/// An empty list with memory, even for no bytes: lists without memory are at address 1, which Open MPI takes
/// for `MPI_IN_PLACE`.
fn buffer(len: usize) -> Vec<u8> {
    Vec::with_capacity(len.max(1))
}

/// The offsets at which parts of these lengths begin.
fn starts(counts: &[i32]) -> Vec<i32> {
    let mut next = 0;
    let start = |&count: &i32| {
        let start = next;
        next += count;
        start
    };
    counts.iter().map(start).collect()
}
