//! Files that are written completely or not at all.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, StdoutLock, Write};
use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::unfinished;

/// Links that are followed before they count as a circle, as in most systems.
const MOST_LINKS: usize = 40;

/// Where output goes.
#[derive(Debug)]
pub(crate) enum Output {
    /// Standard output.
    Standard(BufWriter<StdoutLock<'static>>),
    /// A file.
    File(NewFile),
}

/// A file that takes its place when it is complete; until then, what was there stays.
#[derive(Debug)]
pub(crate) struct NewFile {
    writer: BufWriter<File>,
    target: PathBuf,
    /// The name until then; none for what is no regular file, such as /dev/null.
    temporary: Option<PathBuf>,
}

impl Output {
    /// Output to a file, or to standard output without a name or for the name `-`.
    pub(crate) fn open(path: Option<&Path>) -> Result<Self, Failure> {
        match path {
            Some(path) if path != Path::new("-") => NewFile::create(path).map(Self::File),
            _ => Ok(Self::Standard(BufWriter::with_capacity(1 << 16, io::stdout().lock()))),
        }
    }

    /// Writes with `write`, and completes the output.
    pub(crate) fn write(
        self,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        match self {
            Self::File(file) => file.write(write),
            Self::Standard(mut out) => {
                let written = write(&mut out).and_then(|()| out.flush());
                written.map_err(|error| Failure::of_output(&error))
            }
        }
    }
}

impl NewFile {
    /// Makes ready to write a file; whether that can be done shows here.
    pub(crate) fn create(path: &Path) -> Result<Self, Failure> {
        Self::try_create(path).map_err(|error| unwritable(path, error))
    }

    fn try_create(path: &Path) -> io::Result<Self> {
        let existing = match fs::metadata(path) {
            Ok(data) => Some(data),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            // Such as that the name is too long: said now, not when all is done.
            Err(error) => return Err(error),
        };
        let target = behind_links(path)?;
        if existing.as_ref().is_some_and(fs::Metadata::is_dir) {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        if existing.as_ref().is_some_and(|data| !data.is_file()) {
            let file = OpenOptions::new().write(true).open(&target)?;
            return Ok(Self { writer: BufWriter::new(file), target, temporary: None });
        }
        if existing.as_ref().is_some_and(|data| data.permissions().readonly()) {
            return Err(io::ErrorKind::PermissionDenied.into());
        }
        target.file_name().ok_or(io::ErrorKind::InvalidFilename)?;
        let (file, temporary) = unfinished::create_beside(&target)?;
        if let Some(data) = existing {
            // Best effort: the content is what matters.
            let _ = file.set_permissions(data.permissions());
        }
        Ok(Self { writer: BufWriter::new(file), target, temporary: Some(temporary) })
    }

    /// Writes with `write`, and puts the file in its place.
    pub(crate) fn write(
        mut self,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let written = write(&mut self.writer).and_then(|()| self.writer.flush());
        let placed = written.and_then(|()| match &self.temporary {
            Some(temporary) => unfinished::place(temporary, &self.target),
            None => Ok(()),
        });
        if placed.is_ok() {
            self.temporary = None;
        }
        placed.map_err(|error| unwritable(&self.target, error))
    }
}

impl Drop for NewFile {
    fn drop(&mut self) {
        if let Some(temporary) = &self.temporary {
            unfinished::remove(temporary);
        }
    }
}

/// Where a path leads, through links to files that need not be there: what is behind them is
/// replaced, not they.
fn behind_links(path: &Path) -> io::Result<PathBuf> {
    let mut target = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&target) {
            // Relative links begin in their own folder.
            Ok(next) => target = target.parent().unwrap_or(Path::new("")).join(next),
            Err(_) => return Ok(target),
        }
    }
    Err(io::Error::other("too many links"))
}

fn unwritable(path: &Path, error: io::Error) -> Failure {
    Failure::about(path.display(), format!("cannot be written: {error}"))
}

/// Makes a folder, and those above it, unless it is there.
pub(crate) fn make_folder(path: &Path) -> Result<(), Failure> {
    let made = fs::create_dir_all(path);
    made.map_err(|error| Failure::about(path.display(), format!("cannot be made: {error}")))
}
