//! Folders of `binspace build --cells`: a partition, and a tree and its polygons for each cell.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

use binspace::partition::Partition;
use binspace::scene::Scene;
use binspace::{BspTree, Error};

use crate::args::{BuildArgs, SceneArgs};
use crate::failure::Failure;
use crate::files::{self, STANDARD, open_existing};
use crate::{job, saved_file};

/// The name of the file with the partition. After the partition, the file holds a scene of one polygon: the
/// ends of a diagonal of the bounding box.
const PARTITION: &str = "partition.bsp";

/// The name of a cell's file. The file holds the cell's tree, the scene that the tree was built from, and the
/// numbers of the scene's polygons in the whole scene, ascending, as `u64`.
fn cell_name(cell: usize) -> String {
    format!("cell-{cell:04}.bsp")
}

/// The data kept of a cell.
pub(crate) struct Cell {
    pub(crate) tree: BspTree,
    pub(crate) scene: Scene,
    /// The numbers of the cell's polygons in the whole scene.
    pub(crate) numbers: Vec<usize>,
}

/// A folder that gets its name only when it is complete.
pub(crate) struct NewFolder {
    target: PathBuf,
    /// The files in the folder, which have no names yet.
    files: Vec<(String, File)>,
}

impl NewFolder {
    /// Prepares to write a folder, which must not be there, or must be empty; and fails now if that is not
    /// possible.
    pub(crate) fn create(target: &Path) -> Result<Self, Failure> {
        let about = |problem: String| Failure::about(target.display(), problem);
        if target == Path::new(STANDARD) {
            return Err(about("`--cells` writes a folder: name a new one".to_owned()));
        }
        // Without a dot at the end, by which no folder can be replaced.
        let target: &Path = &target.components().collect::<PathBuf>();
        if target.symlink_metadata().is_ok_and(|found| found.is_symlink()) {
            return Err(about("this is a symbolic link: name the folder itself".to_owned()));
        }
        match std::fs::read_dir(target).map(Iterator::count) {
            Ok(0) => {}
            Ok(_) => {
                return Err(about(
                    "this folder is not empty: remove it, or name another".to_owned(),
                ));
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(about(format!("it cannot become a folder: {error}"))),
        }
        if target.file_name().is_none() {
            return Err(about("a new folder needs a name".to_owned()));
        }
        let folder = Self { target: target.to_owned(), files: Vec::new() };
        if is_mounted(target, folder.beside()) {
            return Err(about("this is a mount point: name a folder inside it".to_owned()));
        }
        match files::unnamed(folder.beside()) {
            Ok(_) => Ok(folder),
            Err(error) => Err(about(format!("cannot be written: {error}"))),
        }
    }

    /// The folder that will contain the new folder.
    pub(crate) fn beside(&self) -> &Path {
        files::folder_of(&self.target)
    }

    /// Adds the partition, and the scene's name, view and bounding box.
    pub(crate) fn add_partition(
        &mut self,
        partition: &Partition,
        scene: &Scene,
    ) -> Result<(), Failure> {
        self.add(PARTITION.to_owned(), |mut out| {
            partition.write(&mut out)?;
            scene.write(&mut out)
        })
    }

    /// Adds the next cell.
    pub(crate) fn add_cell(&mut self, cell: &Cell) -> Result<(), Failure> {
        // The partition is the first of the files.
        let number = self.files.len() - 1;
        self.add(cell_name(number), |out| {
            saved_file::write(out, &cell.scene, &cell.tree)?;
            cell.numbers
                .iter()
                .try_for_each(|&number| out.write_all(&(number as u64).to_le_bytes()))
        })
    }

    fn add(
        &mut self,
        name: String,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let written = files::unnamed(self.beside()).and_then(|file| {
            let mut out = BufWriter::new(file);
            write(&mut out)?;
            out.into_inner().map_err(io::IntoInnerError::into_error)
        });
        let unwritable = |error| {
            Failure::about(self.target.display(), format!("{name} cannot be written: {error}"))
        };
        let file = written.map_err(unwritable)?;
        self.files.push((name, file));
        Ok(())
    }

    /// Moves the folder to its place, with all files.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        let placed = files::place_all(self.files, files::folder_of(&self.target), &self.target);
        placed.map_err(|error| {
            Failure::about(self.target.display(), format!("cannot be written: {error}"))
        })
    }
}

/// Whether a folder is on another device than its parent folder. No other folder can replace such a folder.
#[cfg(unix)]
fn is_mounted(folder: &Path, around: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;

    let device = |path: &Path| path.metadata().map(|found| found.dev()).ok();
    device(folder).is_some_and(|own| device(around) != Some(own))
}

#[cfg(not(unix))]
fn is_mounted(_: &Path, _: &Path) -> bool {
    false
}

/// An existing folder.
pub(crate) struct Folder {
    path: PathBuf,
    pub(crate) partition: Partition,
    /// One polygon: the ends of a diagonal of the bounding box. The scene of this polygon has the whole
    /// scene's name, up direction and view.
    pub(crate) bounds: Scene,
}

/// The folder that a scene's name means; `None` if the name means no folder.
pub(crate) fn named(name: &std::ffi::OsStr) -> Option<&Path> {
    Some(Path::new(name)).filter(|path| path.is_dir())
}

/// Like [`named`], with an error if build options are given for the folder's trees.
pub(crate) fn asked<'a>(
    scene: &'a SceneArgs,
    build: &BuildArgs,
) -> Result<Option<&'a Path>, Failure> {
    let path = named(&scene.name);
    if let Some(path) = path {
        job::refuse_options(path.display(), build.is_given)?;
    }
    Ok(path)
}

impl Folder {
    pub(crate) fn open(path: &Path) -> Result<Self, Failure> {
        let mut input = BufReader::new(open_existing(&path.join(PARTITION))?);
        let name = path.join(PARTITION).display().to_string();
        let about = |error: Error| Failure::about(&name, error);
        let partition = Partition::read(&mut input).map_err(about)?;
        let bounds = Scene::read(&mut input).map_err(about)?;
        let is_box = bounds.len() == 1 && bounds.polygon(0).len() == 2;
        if !is_box || has_more(&mut input) {
            return Err(Failure::about(name, "not written by `binspace build --cells`"));
        }
        Ok(Self { path: path.to_owned(), partition, bounds })
    }

    /// Reads a cell.
    pub(crate) fn cell(&self, number: usize) -> Result<Cell, Failure> {
        let path = self.path.join(cell_name(number));
        let name = path.display().to_string();
        let mut input = BufReader::new(open_existing(&path)?);
        let (scene, tree) = saved_file::read_pair(&name, &mut input)?;
        let mut numbers = Vec::with_capacity(scene.len());
        for _ in 0..scene.len() {
            let mut bytes = [0; 8];
            let read = input.read_exact(&mut bytes);
            read.map_err(|_| Failure::about(&name, "truncated: numbers of polygons are missing"))?;
            numbers.push(u64::from_le_bytes(bytes) as usize);
        }
        let is_own = self.partition.is_tree_of(number, &tree);
        if !is_own || !numbers.is_sorted_by(|a, b| a < b) || has_more(&mut input) {
            return Err(Failure::about(
                name,
                "it does not belong to this folder: build the folder again",
            ));
        }
        Ok(Cell { tree, scene, numbers })
    }
}

fn has_more(input: &mut impl Read) -> bool {
    input.read(&mut [0]).is_ok_and(|more| more > 0)
}
