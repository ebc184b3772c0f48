//! Files that are written completely or not at all.
//!
//! A file has no name until the file is complete. So a program that ends earlier, by a signal, by lack of
//! memory or killed, leaves nothing behind. A complete file gets a hidden name beside its place,
//! `.binspace-….part`, and then replaces an existing file at once. Linux links the name to the file. Other
//! systems, and file systems without such links, copy the file. Signals wait while a file has a hidden name.
//! The hidden name remains only if the program is killed meanwhile, or the machine stops.

use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, BufWriter, IntoInnerError, IsTerminal, Seek, StdoutLock, Write};
use std::path::{Path, PathBuf};

use binspace::internals::open_regular;
use tempfile::NamedTempFile;

use crate::args::SceneArgs;
use crate::failure::Failure;
use crate::scene_arg::{Source, source};
use crate::signals;

/// The most symbolic links that are followed: more count as a cycle, as in most systems.
const MOST_LINKS: usize = 40;

/// The destination of output.
#[derive(Debug)]
pub(crate) enum Output {
    /// Standard output.
    Standard(BufWriter<StdoutLock<'static>>),
    /// A file.
    File(NewFile),
}

/// A new file, which replaces an existing file only when the new file is complete.
#[derive(Debug)]
pub struct NewFile {
    writer: BufWriter<File>,
    target: PathBuf,
    place: Place,
}

/// The way of a complete file to its place.
#[derive(Debug)]
enum Place {
    /// The output is written in place, because the target is not a regular file, such as /dev/null.
    Same,
    /// The complete file is moved to the target, with the permissions of the replaced file.
    Later(Option<Permissions>),
}

/// The name that stands for standard input and standard output.
pub const STANDARD: &str = "-";

impl Output {
    /// Output to a file, or to standard output for the name `-`. The file of the scene is refused.
    pub(crate) fn open(path: &Path, scene: &SceneArgs) -> Result<Self, Failure> {
        if path == Path::new(STANDARD) {
            return Ok(Self::Standard(BufWriter::with_capacity(1 << 16, io::stdout().lock())));
        }
        if let Source::File(input) = source(&scene.name)?
            && path.is_file()
            && let (Ok(input), Ok(output)) = (input.canonicalize(), path.canonicalize())
            && input == output
        {
            let problem = "this is the scene's own file: name another output";
            return Err(about_output(path, problem));
        }
        NewFile::create(path).map(Self::File)
    }

    /// Like [`open`](Self::open), for content that a terminal cannot show.
    pub(crate) fn open_binary(path: &Path, scene: &SceneArgs, what: &str) -> Result<Self, Failure> {
        let output = Self::open(path, scene)?;
        let is_terminal = match &output {
            Self::Standard(out) => out.get_ref().is_terminal(),
            Self::File(file) => file.writer.get_ref().is_terminal(),
        };
        if is_terminal {
            let problem = format!("{what} is not for a terminal: redirect it, or name a file");
            return Err(about_output(path, &problem));
        }
        Ok(output)
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
    /// Prepares to write a file, and fails now if that is not possible.
    pub fn create(path: &Path) -> Result<Self, Failure> {
        Self::try_create(path).map_err(|error| unwritable(path, error))
    }

    fn try_create(path: &Path) -> io::Result<Self> {
        let existing = match fs::metadata(path) {
            Ok(data) => Some(data),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            // For example, a name that is too long is reported now, not at the end.
            Err(error) => return Err(error),
        };
        if existing.as_ref().is_some_and(fs::Metadata::is_dir) {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        if existing.as_ref().is_some_and(|data| !data.is_file()) {
            // The link /dev/stdout leads to a pipe that has no path.
            let file = OpenOptions::new().write(true).open(path)?;
            let target = path.to_owned();
            return Ok(Self { writer: BufWriter::new(file), target, place: Place::Same });
        }
        if existing.as_ref().is_some_and(|data| data.permissions().readonly()) {
            return Err(io::ErrorKind::PermissionDenied.into());
        }
        let target = behind_links(path)?;
        target.file_name().ok_or(io::ErrorKind::InvalidFilename)?;
        let writer = BufWriter::new(unnamed(folder_of(&target))?);
        let place = Place::Later(existing.map(|data| data.permissions()));
        Ok(Self { writer, target, place })
    }

    /// Writes with `write`, and puts the file in its place.
    pub fn write(
        self,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let Self { mut writer, target, place } = self;
        let written = write(&mut writer).and_then(|()| match place {
            Place::Same => writer.flush(),
            Place::Later(permissions) => {
                let file = writer.into_inner().map_err(IntoInnerError::into_error)?;
                signals::hold_back(|| put(file, folder_of(&target), &target, permissions))
            }
        });
        written.map_err(|error| unwritable(&target, error))
    }
}

/// Creates a file without a name in a folder.
pub(crate) fn unnamed(folder: &Path) -> io::Result<File> {
    #[cfg(target_os = "linux")]
    {
        use std::os::unix::fs::OpenOptionsExt;

        let flags = rustix::fs::OFlags::TMPFILE.bits() as i32;
        let mut options = OpenOptions::new();
        let options = options.read(true).write(true).mode(0o666).custom_flags(flags);
        // Some file systems do not support the flag.
        options.open(folder).or_else(|_| tempfile::tempfile_in(folder))
    }
    #[cfg(not(target_os = "linux"))]
    tempfile::tempfile_in(folder)
}

/// Puts a complete file in its place, with the given permissions, or the usual permissions if none are given.
/// The file gets a hidden name in a folder, and then replaces the existing file.
fn put(
    file: File,
    folder: &Path,
    target: &Path,
    permissions: Option<Permissions>,
) -> io::Result<()> {
    if let Some(permissions) = &permissions {
        // Now without the user's mask. Best effort: only the content matters.
        let _ = file.set_permissions(permissions.clone());
    }
    match linked(&file, folder) {
        Ok(part) => part.persist(target).map_err(|error| error.error),
        Err(_) => {
            let part = copied(file, folder, permissions)?;
            part.persist(target).map(drop).map_err(|error| error.error)
        }
    }
}

/// Gives an unnamed file a hidden name in a folder.
#[cfg(target_os = "linux")]
fn linked(file: &File, folder: &Path) -> io::Result<NamedTempFile<()>> {
    use std::os::fd::AsRawFd;

    use rustix::fs::{AtFlags, CWD, linkat};

    let unnamed = format!("/proc/self/fd/{}", file.as_raw_fd());
    hidden(None).make_in(folder, |path| {
        Ok(linkat(CWD, unnamed.as_str(), CWD, path, AtFlags::SYMLINK_FOLLOW)?)
    })
}

#[cfg(not(target_os = "linux"))]
fn linked(_: &File, _: &Path) -> io::Result<NamedTempFile<()>> {
    Err(io::ErrorKind::Unsupported.into())
}

/// Copies a file to a file with a hidden name in a folder.
fn copied(
    mut file: File,
    folder: &Path,
    permissions: Option<Permissions>,
) -> io::Result<NamedTempFile> {
    let mut part = hidden(permissions.clone().or(mode(0o666))).tempfile_in(folder)?;
    file.rewind()?;
    io::copy(&mut file, &mut part)?;
    if let Some(permissions) = permissions {
        let _ = part.as_file().set_permissions(permissions);
    }
    Ok(part)
}

/// Puts complete files, with their names, into the new folder `target`: all files or none. `folder` contains
/// the new folder.
pub(crate) fn place_all(
    files: Vec<(String, File)>,
    folder: &Path,
    target: &Path,
) -> io::Result<()> {
    signals::hold_back(|| {
        // Removed with all its content, unless it becomes the target.
        let part = hidden(mode(0o777)).tempdir_in(folder)?;
        for (name, file) in files {
            put(file, part.path(), &part.path().join(name), None)?;
        }
        fs::rename(part.path(), target)?;
        // Nothing is left under its first name.
        let _ = part.keep();
        Ok(())
    })
}

/// A hidden file or folder. The hidden name is short, because the name of the replaced file may have the
/// maximal length.
fn hidden(permissions: Option<Permissions>) -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".binspace-").suffix(".part");
    if let Some(permissions) = permissions {
        builder.permissions(permissions);
    }
    builder
}

/// Permissions, from which the system removes the permissions that the user's mask excludes.
#[cfg(unix)]
fn mode(bits: u32) -> Option<Permissions> {
    Some(std::os::unix::fs::PermissionsExt::from_mode(bits))
}

#[cfg(not(unix))]
fn mode(_: u32) -> Option<Permissions> {
    None
}

/// The folder that a file is in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."))
}

/// The target of a path, through links to files that need not exist: the target is replaced, not the links.
pub(crate) fn behind_links(path: &Path) -> io::Result<PathBuf> {
    let mut target = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&target) {
            // Relative links begin in their own folder.
            Ok(next) => target = target.parent().unwrap_or(Path::new("")).join(next),
            Err(_) => return Ok(target),
        }
    }
    Err(io::Error::other("too many symbolic links"))
}

/// A failure to write to a file or to standard output.
pub(crate) fn about_output(output: &Path, problem: &str) -> Failure {
    if output == Path::new(STANDARD) {
        return Failure::about("standard output", problem);
    }
    Failure::about(output.display(), problem)
}

/// Opens a regular file to read it.
pub(crate) fn open_existing(path: &Path) -> Result<File, Failure> {
    open_regular(path)
        .map_err(|error| Failure::about(path.display(), format!("cannot be read: {error}")))
}

fn unwritable(path: &Path, error: io::Error) -> Failure {
    Failure::about(path.display(), format!("cannot be written: {error}"))
}

/// Makes a folder and its parents, unless they exist.
pub fn make_folder(path: &Path) -> Result<(), Failure> {
    if path == Path::new(STANDARD) {
        let problem = "several files cannot go there: name a folder (./- for a folder named -)";
        return Err(Failure::about("standard output", problem));
    }
    let made = fs::create_dir_all(path);
    made.map_err(|error| Failure::about(path.display(), format!("cannot be created: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_cannot_take_its_place_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a");
        let names = || fs::read_dir(folder.path()).unwrap().count();
        let file = |content: &str| {
            let mut file = unnamed(folder.path()).unwrap();
            file.write_all(content.as_bytes()).unwrap();
            file
        };
        put(file("content"), folder.path(), &target, None).unwrap();
        assert_eq!((fs::read_to_string(&target).unwrap().as_str(), names()), ("content", 1));
        fs::remove_file(&target).unwrap();
        fs::create_dir(&target).unwrap();
        assert!(put(file("other"), folder.path(), &target, None).is_err());
        assert_eq!(names(), 1);
    }

    /// As on file systems whose unnamed files cannot be linked.
    #[test]
    fn a_file_that_cannot_get_a_name_is_copied() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a");
        let named = tempfile::NamedTempFile::new_in(folder.path()).unwrap();
        let (mut file, path) = named.into_parts();
        file.write_all(b"content").unwrap();
        path.close().unwrap();
        assert!(linked(&file, folder.path()).is_err());
        put(file, folder.path(), &target, None).unwrap();
        assert_eq!(fs::read_to_string(&target).unwrap(), "content");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_complete_file_is_not_copied() {
        use std::os::unix::fs::MetadataExt;

        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a");
        fs::write(&target, "old").unwrap();
        let new = NewFile::create(&target).unwrap();
        let written = new.writer.get_ref().metadata().unwrap().ino();
        new.write(|out| out.write_all(b"content")).unwrap();
        assert_eq!(fs::metadata(&target).unwrap().ino(), written);
        assert_eq!(fs::read_to_string(&target).unwrap(), "content");
    }
}
