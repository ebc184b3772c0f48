//! The command line.

use binspace::Error;
use std::path::PathBuf;

use binspace::BuildOptions;
use binspace::glam::DVec3;
use binspace::partition::Extent;
use binspace::view::Camera;
use clap::Parser;

/// The vertical field of view in radians.
const FIELD_OF_VIEW: f64 = 40.0 * std::f64::consts::PI / 180.0;

/// Draws a scene that is spread over MPI ranks, in exact order.
///
/// Run it by `mpirun -np RANKS binspace-mpi SCENE -o FILE.png`. The picture is the same on any number of
/// ranks.
#[derive(Debug, Parser)]
#[command(name = "binspace-mpi", version)]
pub(crate) struct Arguments {
    /// cloud:N or lump:N, with N generated triangles; an OBJ file; or a folder of OBJ files, which the ranks
    /// share
    pub(crate) scene: String,
    /// PNG file to write
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = size)]
    size: [u32; 2],
    /// Position of the eye [default: outside of the scene]
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    eye: Option<DVec3>,
    /// Point in the middle of the picture [default: the scene's middle]
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    target: Option<DVec3>,
    /// Coplanar tolerance, a length
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    tolerance: Option<f64>,
    /// Give up if a cell has more fragments than this
    #[arg(long, value_name = "N")]
    max_fragments: Option<usize>,
    /// Print the work, time and memory of each rank as CSV
    #[arg(long)]
    pub(crate) figures: bool,
    /// For one rank: paint one tree of the whole scene, without cells
    #[arg(long)]
    pub(crate) alone: bool,
}

impl Arguments {
    pub(crate) fn options(&self) -> BuildOptions {
        let mut options = BuildOptions::DEFAULT;
        if let Some(length) = self.tolerance {
            options = options.with_tolerance(length);
        }
        if let Some(most) = self.max_fragments {
            options = options.with_max_fragments(most);
        }
        options
    }

    /// The camera for a scene of some extent.
    pub(crate) fn camera(&self, extent: &Extent) -> Result<Camera, Error> {
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

fn size(text: &str) -> Result<[u32; 2], &'static str> {
    let sides = text.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    sides.ok_or("expected two whole numbers of pixels, such as 640x480")
}

fn point(text: &str) -> Result<DVec3, &'static str> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|word| word.parse().ok()).collect();
    let point = numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
    point.map(DVec3::from_array).ok_or("expected three numbers X,Y,Z")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> Result<Arguments, clap::Error> {
        Arguments::try_parse_from(format!("binspace-mpi {line}").split_whitespace())
    }

    #[test]
    fn arguments_are_parsed() {
        let found = parsed("cloud:9 -o a.png --size 20x10 --eye -1,2,3 --figures").unwrap();
        assert_eq!((found.size, found.eye), ([20, 10], Some(DVec3::new(-1.0, 2.0, 3.0))));
        assert!(found.figures && !found.alone && found.scene == "cloud:9");
    }

    #[test]
    fn wrong_arguments_are_refused() {
        for line in ["", "a.obj", "-o b", "a b -o c", "a -o", "a -o b --size 3", "a -o b --eye 1,2"]
        {
            assert!(parsed(line).is_err_and(|error| error.use_stderr()), "{line}");
        }
    }
}
