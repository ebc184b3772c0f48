//! A rank's share of a scene before all exchange: generated, or read from files.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use binspace::Error;
use binspace::glam::DVec3;
use binspace::partition::Extent;
use binspace::scene::ObjStream;

use crate::polygon::Given;

/// A part of a scene's polygons.
#[derive(Debug, Default)]
pub(crate) struct Share {
    pub(crate) polygons: Vec<Given>,
}

/// A scene whose polygons each rank generates by their numbers.
#[derive(Clone, Copy, Debug)]
struct Generated {
    polygons: u64,
    /// Whether nearly all polygons are in a small part of the room.
    is_lump: bool,
}

/// The number of low bits of a polygon's number that contain the place in a file. The bits above contain the
/// number of the file.
const IN_FILE: u32 = 32;

/// The prefixes of the names of generated scenes, and whether they are lumps.
const KINDS: [(&str, bool); 2] = [("cloud:", false), ("lump:", true)];

fn is_generated(scene: &str) -> bool {
    KINDS.iter().any(|(name, _)| scene.starts_with(name))
}

impl Share {
    /// Loads the share of a rank. `cloud:N` and `lump:N` are generated. Any other name is an OBJ file or a
    /// folder of OBJ files. Rank k of n reads the files k, k + n, … in the order of their names.
    pub(crate) fn load(scene: &str, rank: usize, ranks: usize) -> Result<Self, String> {
        for (name, is_lump) in KINDS {
            if let Some(count) = scene.strip_prefix(name) {
                let polygons =
                    count.parse().map_err(|_| format!("{scene}: no number of polygons"))?;
                let share = Generated { polygons, is_lump }.share(rank as u64, ranks as u64);
                return share
                    .ok_or_else(|| format!("{scene}: there is no memory for so many polygons"));
            }
        }
        let mut share = Self::default();
        for (number, file) in files(Path::new(scene))?.into_iter().enumerate() {
            if number % ranks == rank {
                share.read(&file, number)?;
            }
        }
        Ok(share)
    }

    pub(crate) fn extent(&self) -> Extent {
        let mut extent = Extent::default();
        self.polygons.iter().for_each(|given| extent.include(given));
        extent
    }

    /// Adds the polygons of a file. Numbers are ordered by files, and then by places in them.
    fn read(&mut self, path: &Path, file: usize) -> Result<(), String> {
        let about = |error: binspace::Error| error.to_string();
        let stream = ObjStream::open(path).map_err(about)?;
        let (precision, mut number) = (stream.scene().precision(), (file as u64) << IN_FILE);
        let flow = stream.read(|corners, material| {
            // If the file changes while it is read, fewer polygons may remain. This is an error at the end of
            // the file.
            let look = stream.scene().materials().get(material as usize);
            let colour = look.map_or([0.0; 3], |look| look.color);
            let colour = colour.map(|channel| (channel * 255.0).round() as u8);
            let (opacity, corners) = (look.map_or(1.0, |look| look.opacity), corners.to_vec());
            // Faces without corners are not visible.
            if !corners.is_empty() {
                self.polygons.push(Given { number, colour, opacity, precision, corners });
            }
            number += 1;
            ControlFlow::<()>::Continue(())
        });
        flow.map(drop).map_err(about)
    }
}

/// The message for an error in a tree of a part of a scene. It names the polygon by its number in a generated
/// scene, or by its place in a file.
pub(crate) fn about(scene: &str, polygons: &[Given], error: Error) -> String {
    let Some(given) = error.polygon().and_then(|place| polygons.get(place)) else {
        return error.to_string();
    };
    let files =
        if is_generated(scene) { vec![] } else { files(Path::new(scene)).unwrap_or_default() };
    match files.get((given.number >> IN_FILE) as usize) {
        Some(file) => {
            let face = given.number & ((1 << IN_FILE) - 1);
            format!("{}: {}", file.display(), error.with_polygon(face as usize))
        }
        None => error.with_polygon(given.number as usize).to_string(),
    }
}

/// The OBJ files that a name means.
fn files(path: &Path) -> Result<Vec<PathBuf>, String> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let about = |error: std::io::Error| format!("{}: {error}", path.display());
    let mut found = Vec::new();
    for entry in std::fs::read_dir(path).map_err(about)? {
        let file = entry.map_err(about)?.path();
        if file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj")) {
            found.push(file);
        }
    }
    found.sort();
    if found.is_empty() {
        Err(format!("{}: no OBJ file is in it", path.display()))
    } else {
        Ok(found)
    }
}

/// The opacity of three in four generated polygons.
const TRANSLUCENT: f32 = 0.6;

impl Generated {
    /// `None` if there is no memory for it.
    fn share(self, rank: u64, ranks: u64) -> Option<Share> {
        let end =
            |rank: u64| (u128::from(self.polygons) * u128::from(rank) / u128::from(ranks)) as u64;
        let numbers = end(rank)..end(rank + 1);
        let mut polygons = Vec::new();
        polygons.try_reserve_exact(usize::try_from(numbers.end - numbers.start).ok()?).ok()?;
        polygons.extend(numbers.map(|number| self.polygon(number)));
        Some(Share { polygons })
    }

    /// A triangle at a random place. Its size depends on the number of triangles, so that each triangle
    /// always has about the same number of neighbours.
    fn polygon(self, number: u64) -> Given {
        let mut dice = Dice(number.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let mut point = || DVec3::from_array([0; 3].map(|_| dice.share() - 0.5));
        let mut centre = point() * 100.0;
        let mut size = 60.0 / (self.polygons as f64).cbrt();
        if self.is_lump && !number.is_multiple_of(64) {
            (centre, size) = (centre * 0.05 + DVec3::splat(40.0), size * 0.05);
        }
        let corners: Vec<DVec3> = (0..3).map(|_| centre + point() * size).collect();
        let hue = dice.roll();
        let colour = [hue, hue >> 8, hue >> 16].map(|bits| 64 + (bits % 192) as u8);
        let opacity = if number.is_multiple_of(4) { 1.0 } else { TRANSLUCENT };
        Given { number, colour, opacity, precision: 0.0, corners }
    }
}

/// A stream of numbers (SplitMix64: Steele, Lea and Flood, 2014).
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number from 0 to 1.
    fn share(&mut self) -> f64 {
        (self.roll() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_any_number_of_ranks_are_the_scene() {
        let all = Share::load("lump:101", 0, 1).unwrap().polygons;
        assert_eq!(all.len(), 101);
        for ranks in [2, 3, 8, 150] {
            let shares = (0..ranks).map(|rank| Share::load("lump:101", rank, ranks).unwrap());
            let joined: Vec<Given> = shares.flat_map(|share| share.polygons).collect();
            assert_eq!(joined, all);
        }
    }

    #[test]
    fn more_than_memory_holds_is_an_error() {
        for count in [u64::MAX, 1 << 61, 1 << 58] {
            let error = Share::load(&format!("cloud:{count}"), 0, 2).unwrap_err();
            assert!(error.contains("no memory"), "{error}");
        }
        assert!(Share::load("cloud:1e9", 0, 1).unwrap_err().contains("no number"));
    }

    /// A polygon with a wrong corner is named by its number in the scene.
    #[test]
    fn errors_name_polygons_by_their_numbers_in_the_scene() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().to_str().unwrap();
        for name in ["a.obj", "b.obj"] {
            let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned() + &"f 1 2 3\n".repeat(9);
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        for (scene, skip, expected) in [
            ("cloud:9", 4, "polygon 4 has".to_owned()),
            (path, 11, format!("{path}/b.obj: polygon 2 has")),
        ] {
            let mut polygons = Share::load(scene, 0, 1).unwrap().polygons.split_off(skip);
            polygons[0].corners[1].x = f64::NAN;
            let error = binspace::BspTree::build(&polygons).unwrap_err();
            let text = about(scene, &polygons, error);
            assert!(text.starts_with(&expected) && text.contains("NaN"), "{text}");
        }
    }
}
