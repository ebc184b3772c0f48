//! Paints the cell of a rank, and writes pictures into files.

use std::fs::{self, Permissions};
use std::io;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use binspace::BspTree;
use binspace::paint::for_each_painted;
use binspace::raster::Rays;
use binspace::view::Camera;

use crate::polygon::Given;

/// The colour behind everything.
pub(crate) const BACKGROUND: [u8; 3] = [255; 3];

/// The contribution of one polygon to one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layer {
    /// The number of the pixel, row by row from the top left.
    pub(crate) pixel: u32,
    pub(crate) colour: [u8; 3],
    /// The opacity, from 0 to 1.
    pub(crate) opacity: f32,
}

/// The bytes of a layer.
pub(crate) const LAYER: usize = 12;

impl Layer {
    pub(crate) fn bytes(&self) -> [u8; LAYER] {
        let ([a, b, c, d], [r, g, blue]) = (self.pixel.to_le_bytes(), self.colour);
        let [e, f, h, i] = self.opacity.to_le_bytes();
        [a, b, c, d, r, g, blue, 0, e, f, h, i]
    }

    pub(crate) fn of(&[a, b, c, d, r, g, blue, _, e, f, h, i]: &[u8; LAYER]) -> Self {
        Self {
            pixel: u32::from_le_bytes([a, b, c, d]),
            colour: [r, g, blue],
            opacity: f32::from_le_bytes([e, f, h, i]),
        }
    }
}

/// The visible layers of a cell in each pixel, the furthest first. Layers that an opaque polygon hides are
/// left out.
pub(crate) fn layers(
    tree: &BspTree,
    camera: &Camera,
    rays: &Rays,
    polygons: &[Given],
) -> Vec<Layer> {
    let [width, height] = rays.size().map(|side| side as usize);
    let look = |polygon: usize| (polygons[polygon].colour, polygons[polygon].opacity);
    let mut painted =
        Painted { layers: Vec::new(), first: vec![0; width * height], sweep_at: 1 << 20 };
    for_each_painted(tree, camera.viewpoint(), rays, look, |pixel, colour, opacity| {
        painted.add(Layer { pixel: pixel as u32, colour, opacity });
    });
    painted.sweep();
    painted.layers
}

/// Layers in the order in which they were painted.
struct Painted {
    layers: Vec<Layer>,
    /// For each pixel, the place of the first layer that is not hidden.
    first: Vec<usize>,
    /// The number of layers at which hidden layers are removed.
    sweep_at: usize,
}

impl Painted {
    fn add(&mut self, layer: Layer) {
        if layer.opacity == 1.0 {
            self.first[layer.pixel as usize] = self.layers.len();
        }
        self.layers.push(layer);
        if self.layers.len() >= self.sweep_at {
            self.sweep();
            self.sweep_at = self.sweep_at.max(2 * self.layers.len());
        }
    }

    /// Removes hidden layers.
    fn sweep(&mut self) {
        let (first, mut place) = (&self.first, 0);
        self.layers.retain(|layer| {
            place += 1;
            place > first[layer.pixel as usize]
        });
        // The remaining layers of each pixel are visible.
        self.first.fill(0);
    }
}

/// The way to write a picture to its place.
enum Place {
    /// The picture is written into a device or a pipe.
    Into,
    /// The picture is written to a temporary file beside this one, and replaces this file when it is
    /// complete.
    Beside(PathBuf),
}

impl Place {
    fn of(path: &Path) -> io::Result<Self> {
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
            Ok(found) if !found.is_file() => Ok(Self::Into),
            // The target of a link is replaced, not the link. (If a link has no target, the link itself is
            // replaced.)
            Ok(_) => fs::canonicalize(path).map(Self::Beside),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                path.file_name().ok_or(io::ErrorKind::InvalidFilename)?;
                Ok(Self::Beside(path.to_owned()))
            }
            Err(error) => Err(error),
        }
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn unwritable(path: &Path, error: &io::Error) -> String {
    format!("{}: cannot be written: {error}", path.display())
}

/// Returns an error if it is already certain that a picture cannot be written to a file.
pub(crate) fn check(path: &Path) -> Result<(), String> {
    let check = || match Place::of(path)? {
        Place::Into => Ok(()),
        // The temporary file has no name, so nothing remains if the program is killed.
        Place::Beside(path) => tempfile::tempfile_in(folder_of(&path)).map(drop),
    };
    check().map_err(|error| unwritable(path, &error))
}

/// Writes a picture, RGB, as PNG: completely or not at all.
pub(crate) fn write(path: &Path, size: [u32; 2], pixels: &[u8]) -> Result<(), String> {
    let write = || -> io::Result<()> {
        let target = match Place::of(path)? {
            Place::Into => {
                return encode(fs::OpenOptions::new().write(true).open(path)?, size, pixels);
            }
            Place::Beside(target) => target,
        };
        // The system's mask decides who can read the file, as for other files.
        let file = tempfile::Builder::new()
            .permissions(Permissions::from_mode(0o666))
            .tempfile_in(folder_of(&target))?;
        encode(file.as_file(), size, pixels)?;
        file.as_file().sync_all()?;
        file.persist(target)?;
        Ok(())
    };
    write().map_err(|error| unwritable(path, &error))
}

fn encode(out: impl io::Write, size: [u32; 2], pixels: &[u8]) -> io::Result<()> {
    let mut encoder = png::Encoder::new(out, size[0], size[1]);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    Ok(writer.finish()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layer(pixel: u32, opacity: f32) -> Layer {
        Layer { pixel, colour: [pixel as u8, 2, 3], opacity }
    }

    #[test]
    fn pictures_replace_files_and_are_written_into_devices() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("p.png");
        fs::write(&path, "older").unwrap();
        std::os::unix::fs::symlink(&path, folder.path().join("link")).unwrap();
        write(&folder.path().join("link"), [2, 1], &[9; 6]).unwrap();
        assert!(fs::read(&path).unwrap().starts_with(b"\x89PNG"));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
        // The mask of the test is unknown, but under any mask the owner can write the file.
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o600, 0o600);
        write(Path::new("/dev/null"), [2, 1], &[9; 6]).unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }

    #[test]
    fn unwritable_files_are_reported_before_the_work() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("file"), "kept").unwrap();
        fs::create_dir(path("folder")).unwrap();
        std::os::unix::fs::symlink("circle", path("circle")).unwrap();
        for name in ["none/p.png", "folder", "file/p.png", "circle", &"n".repeat(300)] {
            assert!(check(&path(name)).unwrap_err().contains("cannot be written"), "{name}");
            assert!(write(&path(name), [2, 1], &[9; 6]).is_err(), "{name}");
        }
        for name in ["file", "new"] {
            check(&path(name)).unwrap();
        }
        check(Path::new("/dev/null")).unwrap();
        assert_eq!(fs::read(path("file")).unwrap(), b"kept");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
    }

    #[test]
    fn layers_are_bytes_and_back() {
        let given = layer(70_000, 0.3);
        assert_eq!(Layer::of(&given.bytes()), given);
    }

    #[test]
    fn hidden_layers_are_removed_and_the_rest_keeps_its_order() {
        for sweep_at in [1, 2, 3, 100] {
            let mut painted = Painted { layers: vec![], first: vec![0; 4], sweep_at };
            let given =
                [(0, 0.1), (1, 0.2), (0, 1.0), (1, 0.3), (0, 0.4), (2, 1.0), (2, 1.0), (1, 0.5)];
            given.into_iter().for_each(|(pixel, opacity)| painted.add(layer(pixel, opacity)));
            painted.sweep();
            let expected = [(1, 0.2), (0, 1.0), (1, 0.3), (0, 0.4), (2, 1.0), (1, 0.5)];
            assert_eq!(painted.layers, expected.map(|(pixel, opacity)| layer(pixel, opacity)));
        }
    }
}
