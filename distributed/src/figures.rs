//! The work, time and memory of each rank.

use std::time::Duration;

use mpi::topology::SimpleCommunicator;

use crate::exchange;

/// The figures of one rank.
#[derive(Debug, Default)]
pub(crate) struct Figures {
    /// Polygons of the rank's share, polygons that it received, and polygons that reach into its cell.
    pub(crate) given: u64,
    pub(crate) received: u64,
    pub(crate) polygons: u64,
    pub(crate) fragments: u64,
    /// Layers of pixels.
    pub(crate) layers: u64,
    /// Bytes sent to other ranks.
    pub(crate) polygon_bytes: u64,
    pub(crate) layer_bytes: u64,
    /// Processor time, without waiting for others.
    pub(crate) read: Duration,
    pub(crate) build: Duration,
    pub(crate) paint: Duration,
    /// Time by the clock, including waiting for other ranks.
    pub(crate) exchange: Duration,
    pub(crate) composite: Duration,
    pub(crate) all: Duration,
}

impl Figures {
    /// Prints the figures of all ranks, one rank per line, if they are requested.
    pub(crate) fn report(&self, world: &SimpleCommunicator, is_wanted: bool) {
        let counts = [
            self.given,
            self.received,
            self.polygons,
            self.fragments,
            self.layers,
            self.polygon_bytes,
            self.layer_bytes,
            peak_memory(),
        ];
        let times = [self.read, self.build, self.paint, self.exchange, self.composite, self.all];
        let own: Vec<f64> = counts
            .into_iter()
            .map(|count| count as f64)
            .chain(times.into_iter().map(|time| time.as_secs_f64()))
            .collect();
        let Some(all) = exchange::gather(world, &own).filter(|_| is_wanted) else { return };
        // An error is ignored: if standard output is closed, nobody reads the figures.
        let _ = print(&all, own.len(), counts.len());
    }
}

const COLUMNS: [&str; 15] = [
    "rank",
    "given",
    "received",
    "polygons",
    "fragments",
    "layers",
    "polygon_bytes",
    "layer_bytes",
    "peak_bytes",
    "read_cpu_s",
    "build_cpu_s",
    "paint_cpu_s",
    "exchange_s",
    "composite_s",
    "all_s",
];

/// Prints rows of figures: the first ones are counts, and the others seconds.
fn print(all: &[f64], each: usize, counts: usize) -> csv::Result<()> {
    let mut out = csv::Writer::from_writer(std::io::stdout().lock());
    out.write_record(COLUMNS)?;
    for (rank, row) in all.chunks(each).enumerate() {
        let (counts, times) = row.split_at(counts);
        let counts = counts.iter().map(|count| format!("{count:.0}"));
        let times = times.iter().map(|time| format!("{time:.3}"));
        out.write_record(std::iter::once(rank.to_string()).chain(counts).chain(times))?;
    }
    Ok(out.flush()?)
}

/// The processor time of this process; 0 where the system does not report it.
pub(crate) fn processor_time() -> Duration {
    let status = std::fs::read_to_string("/proc/self/schedstat").unwrap_or_default();
    let nanoseconds = status.split_whitespace().next().and_then(|first| first.parse().ok());
    Duration::from_nanos(nanoseconds.unwrap_or(0))
}

/// The peak memory of this process, in bytes; 0 where the system does not report it.
fn peak_memory() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok());
    kilobytes.unwrap_or(0) * 1024
}
