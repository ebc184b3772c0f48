//! Files that have no name until they are complete. If the program ends earlier, by a signal, by lack of
//! memory or killed, it leaves nothing behind.
//!
//! While it is moved to its place, a complete file or folder has a hidden name beside it, `.binspace-….part`.
//! Signals wait until the move ends. The hidden file remains only if the program is killed within the move,
//! or the machine stops.

use std::fs::{File, Permissions};
use std::io::{self, Seek};
use std::path::Path;

use tempfile::{Builder, TempPath};

use crate::signals;

/// Creates a file without a name in a folder.
pub(crate) fn create_in(folder: &Path) -> io::Result<File> {
    match nameless(folder) {
        Ok(file) => Ok(file),
        // Created with a name, which is removed at once.
        Err(_) => tempfile::tempfile_in(folder),
    }
}

/// Puts a complete file in its place, with the given permissions, or the usual ones if there are
/// none.
///
/// The file has its own name for the moment before it replaces an existing one; signals wait.
pub(crate) fn place(
    mut file: File,
    folder: &Path,
    target: &Path,
    permissions: Option<Permissions>,
) -> io::Result<()> {
    if let Some(permissions) = permissions.clone() {
        // Best effort: only the content matters.
        let _ = file.set_permissions(permissions);
    }
    signals::hold_back(|| persist(&mut file, folder, target, permissions))
}

fn persist(
    file: &mut File,
    folder: &Path,
    target: &Path,
    permissions: Option<Permissions>,
) -> io::Result<()> {
    let part = match named(file, folder) {
        Ok(part) => part,
        Err(_) => copied(file, folder, permissions)?,
    };
    part.persist(target).map_err(|error| error.error)
}

/// Puts complete files, made in a folder, into a new folder there, with their names; all or none of them.
pub(crate) fn place_all(
    files: Vec<(String, File)>,
    folder: &Path,
    target: &Path,
) -> io::Result<()> {
    let mut builder = builder();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(Permissions::from_mode(0o777));
    }
    signals::hold_back(|| {
        // Removed with all its content, unless it becomes the target.
        let part = builder.tempdir_in(folder)?;
        for (name, mut file) in files {
            persist(&mut file, part.path(), &part.path().join(name), None)?;
        }
        std::fs::rename(part.path(), target)?;
        // Nothing is left under its first name.
        let _ = part.keep();
        Ok(())
    })
}

/// A short name, as the name of the replaced file may have the maximal length.
fn builder() -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(".binspace-").suffix(".part");
    builder
}

/// A file that never had a name, if the file system supports that.
#[cfg(target_os = "linux")]
fn nameless(folder: &Path) -> io::Result<File> {
    use rustix::fs::{Mode, OFlags, open};

    let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
    // The system removes the permissions that the user's mask excludes.
    Ok(open(folder, flags, Mode::from_raw_mode(0o666))?.into())
}

/// Gives a name to a file without one.
#[cfg(target_os = "linux")]
fn named(file: &File, folder: &Path) -> io::Result<TempPath> {
    use rustix::fs::{AtFlags, CWD, linkat};
    use std::os::fd::AsRawFd;

    let opened = format!("/proc/self/fd/{}", file.as_raw_fd());
    let link = |path: &Path| Ok(linkat(CWD, &opened, CWD, path, AtFlags::SYMLINK_FOLLOW)?);
    Ok(builder().make_in(folder, link)?.into_temp_path())
}

#[cfg(not(target_os = "linux"))]
fn nameless(_: &Path) -> io::Result<File> {
    Err(io::ErrorKind::Unsupported.into())
}

#[cfg(not(target_os = "linux"))]
fn named(_: &File, _: &Path) -> io::Result<TempPath> {
    Err(io::ErrorKind::Unsupported.into())
}

/// Copies a file to one with a name.
fn copied(
    file: &mut File,
    folder: &Path,
    permissions: Option<Permissions>,
) -> io::Result<TempPath> {
    let mut builder = builder();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(permissions.clone().unwrap_or(Permissions::from_mode(0o666)));
    }
    let mut part = builder.tempfile_in(folder)?;
    file.rewind()?;
    io::copy(file, part.as_file_mut())?;
    if let Some(permissions) = permissions {
        let _ = part.as_file().set_permissions(permissions);
    }
    Ok(part.into_temp_path())
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io::Write;

    use super::*;

    #[test]
    fn a_file_takes_its_place_with_and_without_a_copy() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a");
        let names = || fs::read_dir(folder.path()).unwrap().count();
        // The second cannot get a name again, as on file systems without nameless files.
        let files = [create_in(folder.path()), tempfile::tempfile_in(folder.path())];
        for (i, file) in files.into_iter().enumerate() {
            let mut file = file.unwrap();
            write!(file, "content {i}").unwrap();
            assert_eq!(names(), i.min(1));
            place(file, folder.path(), &target, None).unwrap();
            assert_eq!(fs::read_to_string(&target).unwrap(), format!("content {i}"));
            assert_eq!(names(), 1);
        }
    }

    #[test]
    fn what_cannot_take_its_place_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a");
        fs::create_dir(&target).unwrap();
        for file in [create_in(folder.path()), tempfile::tempfile_in(folder.path())] {
            assert!(place(file.unwrap(), folder.path(), &target, None).is_err());
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        }
    }
}
