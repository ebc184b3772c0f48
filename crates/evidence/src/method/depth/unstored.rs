//! The number that a depth buffer is about to store, with bounds of the roundings before that.

use super::super::clip::{Clipper, Range};
use super::super::space::CameraSpace;
use super::format::{DepthFormat, Scale};
use super::gradient::{Gradient, Sample};
use super::{DepthBuffer, range};
use crate::Precision;
use crate::method::MethodError;
use binspace::internals::Faces;
use binspace::view::Camera;

/// A number that is about to be stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unstored {
    /// The number of the face's plane in the pixel, for the plane that the pipeline sets up with rounded
    /// corners and slopes. Smaller numbers are nearer.
    pub value: f64,
    /// The difference of two consecutive stored numbers there.
    pub step: f64,
    /// The largest effect of the roundings in the pixel on the number, before it is stored.
    pub rounding: f64,
}

/// The planes of faces in a picture, as a pipeline with edge functions sets them up.
#[derive(Clone, Debug)]
pub struct SetUp {
    format: DepthFormat,
    range: Range,
    perspective: bool,
    /// Half of the step between numbers from 1 to 2 in the pipeline.
    unit: f64,
    /// A point and the slopes of each face; `None` if the face is not visible.
    planes: Vec<Option<(Sample, [f64; 2])>>,
}

impl DepthBuffer {
    /// Sets up the planes of all faces.
    ///
    /// # Errors
    ///
    /// If the near and the far plane do not suit the camera, or nothing is visible.
    pub fn set_up(&self, camera: &Camera, faces: &Faces) -> Result<SetUp, MethodError> {
        if self.format.is_float() {
            self.set_up_in::<f32>(camera, faces, 2f64.powi(-24))
        } else {
            self.set_up_in::<f64>(camera, faces, 2f64.powi(-53))
        }
    }

    fn set_up_in<P: Precision>(
        &self,
        camera: &Camera,
        faces: &Faces,
        unit: f64,
    ) -> Result<SetUp, MethodError> {
        let space = CameraSpace::new(camera, faces.lattice());
        let range = range::of([self.near, self.far], &space, faces)?
            .ok_or(MethodError::range(self.near, self.far))?;
        let scale = Scale::<P>::new(self.format, range, space.perspective);
        let mut clipper = Clipper::new(&space, range);
        let plane = |face| {
            let outline = clipper.clip_face(&space, faces, face);
            let samples: Vec<Sample> =
                outline.iter().map(|vertex| scale.sample(&space, vertex.at)).collect();
            let gradient = Gradient::<P>::new(&samples);
            let slopes = [gradient.along_x, gradient.along_y];
            samples.first().map(|&first| (first, slopes))
        };
        let planes = (0..faces.len() as u32).map(plane).collect();
        Ok(SetUp { format: self.format, range, perspective: space.perspective, unit, planes })
    }
}

impl SetUp {
    /// The largest rounding of a sum of this size.
    fn half_step(&self, size: f64) -> f64 {
        self.unit * 2f64.powi(size.log2().floor() as i32)
    }

    /// Returns the number that is about to be stored for a face at a pixel's centre; `None` for a face that
    /// is not seen.
    pub fn at(&self, face: u32, x: u32, y: u32) -> Option<Unstored> {
        let (origin, [along_x, along_y]) = self.planes[face as usize]?;
        let by_y = (f64::from(y) + 0.5 - origin.y) * along_y;
        let by_x = (f64::from(x) + 0.5 - origin.x) * along_x;
        let row = origin.value + by_y;
        let value = row + by_x;
        // The roundings of the differences, the products and the sum of a row. The last sum is stored.
        let products = 2.0 * self.unit * (by_y.abs() + by_x.abs());
        let rounding = products + self.half_step(row.abs() + products);
        let whole = |bits: u8| 1.0 / (2f64.powi(i32::from(bits.clamp(1, 32))) - 1.0);
        let of_float = |value: f64| 2f64.powi(value.abs().log2().floor() as i32 - 23);
        let sum = self.half_step(value.abs() + rounding);
        Some(match self.format {
            DepthFormat::Integer(bits) => {
                Unstored { value, step: whole(bits), rounding: rounding + 3.0 * sum }
            }
            DepthFormat::Float => Unstored { value, step: of_float(value), rounding },
            DepthFormat::FloatReversed => {
                Unstored { value: -value, step: of_float(value), rounding }
            }
            DepthFormat::LinearInteger(_) | DepthFormat::LinearFloat if !self.perspective => {
                let step = match self.format {
                    DepthFormat::LinearInteger(bits) => whole(bits),
                    _ => of_float(value),
                };
                Unstored { value, step, rounding: rounding + 3.0 * sum }
            }
            DepthFormat::LinearInteger(_) | DepthFormat::LinearFloat => {
                // 1 / w is interpolated. An error of 1 / w changes w by this error times w², and w is rounded
                // as well.
                let depth = 1.0 / value;
                let rounding = (rounding + sum) * depth * depth;
                let Range { near, far } = self.range;
                match self.format {
                    DepthFormat::LinearInteger(bits) => Unstored {
                        value: depth,
                        step: whole(bits) * (far - near),
                        rounding: rounding + 4.0 * self.unit * (depth + far),
                    },
                    _ => Unstored { value: depth, step: of_float(depth), rounding },
                }
            }
        })
    }
}
