//! Errors: if one rank has one, all stop.

use mpi::collective::SystemOperation;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives};

/// Some rank has failed, and has said why.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Failure;

/// What all ranks have, if all have it. Otherwise the first of those that do not says why. Every rank has
/// to call this, at the same place.
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

/// From now on, a panic on one rank ends all of them: the others would wait for it.
pub(crate) fn abort_on_panic() {
    let print = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        print(panic);
        SimpleCommunicator::world().abort(3);
    }));
}
