//! The command line.

use std::path::PathBuf;

use binspace::glam::DVec3;
use binspace::view::{Camera, CameraError};
use binspace::{BuildOptions, Extent};

const USAGE: &str = "\
usage: mpirun -np RANKS binspace-mpi SCENE -o FILE.ppm [OPTION…]

SCENE is cloud:N or lump:N, of N generated triangles; an OBJ file; or a folder of OBJ
files, which the ranks share.

  --size WxH        size of the picture in pixels [640x480]
  --eye X,Y,Z       position of the eye [outside of the scene]
  --target X,Y,Z    point in the middle of the picture [the scene's middle]
  --tolerance T     coplanar tolerance, a length
  --max-fragments N the most fragments of a cell
  --figures         print what each rank has done, as CSV
  --alone           one rank: one tree of all, without cells";

/// The vertical field of view in radians.
const FIELD_OF_VIEW: f64 = 40.0 * std::f64::consts::PI / 180.0;

#[derive(Debug, PartialEq)]
pub(crate) struct Arguments {
    pub(crate) scene: String,
    pub(crate) output: PathBuf,
    pub(crate) figures: bool,
    pub(crate) alone: bool,
    size: [u32; 2],
    eye: Option<DVec3>,
    target: Option<DVec3>,
    tolerance: Option<f64>,
    max_fragments: Option<usize>,
}

impl Arguments {
    pub(crate) fn parse(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let (mut scene, mut output) = (None, None);
        let mut found = Self {
            scene: String::new(),
            output: PathBuf::new(),
            figures: false,
            alone: false,
            size: [640, 480],
            eye: None,
            target: None,
            tolerance: None,
            max_fragments: None,
        };
        while let Some(word) = words.next() {
            let wrong = || format!("{word} needs another value\n{USAGE}");
            // Also --eye=X,Y,Z.
            let (name, mut given) = match word.split_once('=') {
                Some((name, value)) if name.starts_with("--") => (name, Some(value.to_owned())),
                _ => (word.as_str(), None),
            };
            let mut value = || given.take().or_else(|| words.next()).ok_or_else(wrong);
            match name {
                "-o" => output = Some(value()?),
                "--size" => found.size = size(&value()?).ok_or_else(wrong)?,
                "--eye" => found.eye = Some(point(&value()?).ok_or_else(wrong)?),
                "--target" => found.target = Some(point(&value()?).ok_or_else(wrong)?),
                "--tolerance" => found.tolerance = Some(value()?.parse().map_err(|_| wrong())?),
                "--max-fragments" => {
                    found.max_fragments = Some(value()?.parse().map_err(|_| wrong())?);
                }
                "--figures" => found.figures = true,
                "--alone" => found.alone = true,
                _ if word.starts_with('-') || scene.is_some() => {
                    return Err(format!("{word} is unknown\n{USAGE}"));
                }
                _ => scene = Some(word),
            }
        }
        match (scene, output) {
            (Some(scene), Some(output)) => Ok(Self { scene, output: output.into(), ..found }),
            _ => Err(format!("a scene and a file to write are needed\n{USAGE}")),
        }
    }

    pub(crate) fn options(&self) -> BuildOptions {
        let mut options = BuildOptions::DEFAULT;
        if let Some(length) = self.tolerance {
            options = options.with_tolerance(length);
        }
        self.max_fragments.map_or(options, |most| options.with_max_fragments(most))
    }

    /// The camera for a scene of some extent.
    pub(crate) fn camera(&self, extent: &Extent) -> Result<Camera, CameraError> {
        let is_something = extent.low.cmple(extent.high).all();
        let [low, high] =
            if is_something { [extent.low, extent.high] } else { [DVec3::NEG_ONE, DVec3::ONE] };
        let middle = low * 0.5 + high * 0.5;
        let eye = self.eye.unwrap_or_else(|| {
            middle + DVec3::new(0.7, 0.5, 1.0) * (high - low).max_element().max(f64::MIN_POSITIVE)
        });
        let target = self.target.unwrap_or(middle);
        Camera::perspective(eye, target, DVec3::Y, FIELD_OF_VIEW, self.size)
    }
}

fn size(text: &str) -> Option<[u32; 2]> {
    let (width, height) = text.split_once('x')?;
    Some([width.parse().ok()?, height.parse().ok()?])
}

fn point(text: &str) -> Option<DVec3> {
    let numbers: Vec<f64> = text.split(',').map(|word| word.parse().ok()).collect::<Option<_>>()?;
    <[f64; 3]>::try_from(numbers).ok().map(DVec3::from_array)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> Result<Arguments, String> {
        Arguments::parse(line.split_whitespace().map(str::to_owned))
    }

    #[test]
    fn what_is_said_is_understood() {
        let found = parsed("cloud:9 -o a.ppm --size 20x10 --eye -1,2,3 --figures").unwrap();
        assert_eq!((found.size, found.eye), ([20, 10], Some(DVec3::new(-1.0, 2.0, 3.0))));
        assert!(found.figures && !found.alone && found.scene == "cloud:9");
    }

    #[test]
    fn what_is_wrong_is_refused() {
        for line in ["", "a.obj", "-o b", "a b -o c", "a -o", "a -o b --size 3", "a -o b --eye 1,2"]
        {
            assert!(parsed(line).is_err_and(|error| error.contains("usage")), "{line}");
        }
    }
}
