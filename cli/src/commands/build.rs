//! `binspace build`: a tree in a file.

use crate::Outcome;
use crate::args::BuildFileArgs;
use crate::failure::Failure;
use crate::files::Output;
use crate::job::{self, Made};
use crate::progress::Progress;
use crate::{cells, saved_file};

/// Runs the command.
pub(crate) fn run(args: &BuildFileArgs) -> Result<Outcome, Failure> {
    if let Some(cells) = args.cells {
        cells::build::run(args, cells as usize)?;
        return Ok(Outcome::Done);
    }
    let output = Output::open_binary(&args.output, &args.scene, "a tree")?;
    let Made { scene, tree, stored_name, .. } = job::make(&args.scene, &args.build)?;
    let scene = scene.with_name(stored_name);
    let _progress = Progress::spinner("writing");
    output.write(|out| saved_file::write(out, &scene, &tree))?;
    Ok(Outcome::Done)
}
