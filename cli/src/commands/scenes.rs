//! `binspace scenes`: the built-in scenes.

use binspace::scene::Builtin;

use crate::Outcome;
use crate::failure::Failure;
use crate::terminal::{HEAD, say, styled};

/// Runs the command.
pub(crate) fn run() -> Result<Outcome, Failure> {
    for &scene in Builtin::ALL {
        say(format!("{}{}", styled(HEAD, format!("{scene:10}")), scene.description()))?;
        if let (Some(meaning), Some(size)) = (scene.size_meaning(), scene.default_size()) {
            say(format!("{:10}{scene}:SIZE: {meaning} [default: {size}]", ""))?;
        }
    }
    say("\nThe largest sizes are about 20 million polygons.")?;
    say("--seed changes the scenes that are marked as seeded.")?;
    Ok(Outcome::Done)
}
