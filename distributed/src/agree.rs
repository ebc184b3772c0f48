//! Errors: if one rank has an error, all stop.

use mpi::collective::SystemOperation;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives};

/// Some rank has failed, and has reported why.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Failure;

/// Returns the value of this rank, if all ranks have one. Otherwise the first rank without a value reports
/// its error. Every rank must call this function at the same place.
pub(crate) fn together<T>(
    world: &SimpleCommunicator,
    result: Result<T, String>,
) -> Result<T, Failure> {
    let own = if result.is_err() { world.rank() } else { i32::MAX };
    let mut first = own;
    world.all_reduce_into(&own, &mut first, SystemOperation::min());
    match result {
        Ok(found) if first == i32::MAX => Ok(found),
        Err(problem) if first == world.rank() => {
            eprintln!("error: rank {first}: {problem}");
            Err(Failure)
        }
        _ => Err(Failure),
    }
}

/// From now on, a panic on one rank ends all ranks. Without this, the other ranks would wait for it.
pub(crate) fn abort_on_panic() {
    let print = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        print(panic);
        SimpleCommunicator::world().abort(3);
    }));
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use mpi::traits::{Communicator, CommunicatorCollectives};

    use super::abort_on_panic;

    /// The work of a rank in the test below. Outside `mpirun`, it is the only rank and does nothing.
    #[test]
    #[ignore = "it is run by mpirun"]
    fn one_rank_of_several_panics() {
        let universe = mpi::initialize().unwrap();
        let world = universe.world();
        abort_on_panic();
        assert_ne!(world.rank(), 1, "a panic on one rank");
        // The other ranks would wait for this rank.
        world.barrier();
        assert_eq!(world.size(), 1, "nobody gets here");
    }

    #[test]
    #[ignore = "needs mpirun of Open MPI"]
    fn a_panic_on_one_rank_ends_all() {
        let mut command = Command::new("timeout");
        command.args(["100", "mpirun", "--allow-run-as-root", "--oversubscribe", "-np", "4"]);
        command.arg(std::env::current_exe().unwrap());
        command.args(["one_rank_of_several_panics", "--ignored", "--nocapture"]);
        let output = command.output().unwrap();
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{text}");
        assert!(
            text.contains("a panic on one rank") && !text.contains("nobody gets here"),
            "{text}"
        );
    }
}
