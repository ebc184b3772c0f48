//! The near and the far plane.

use super::super::MethodError;
use super::super::clip::{Clipper, Range};
use super::super::space::CameraSpace;
use binspace::internals::Faces;

/// The nearest near plane that is chosen, as a share of the far plane's depth. Too small: one face at the eye
/// uses up all depths. Too large: such a face is cut off.
const NEAREST: f64 = 1.0 / (1u64 << 44) as f64;
/// The least range that is chosen, as a share of the larger depth, so that the range is a valid divisor.
const SHALLOWEST: f64 = 1.0 / (1u64 << 20) as f64;

/// The range of depths of a picture, from the given limits; `None` if nothing is visible.
pub(super) fn of(
    limits: [Option<f64>; 2],
    space: &CameraSpace,
    faces: &Faces,
) -> Result<Option<Range>, MethodError> {
    let given = |depth: Option<f64>| depth.map(|depth| space.length(depth));
    let [near, far] = limits.map(given);
    let wrong = |depth: f64| !depth.is_finite() || space.perspective && depth <= 0.0;
    if near.is_some_and(wrong) || far.is_some_and(wrong) {
        return Err(MethodError::range(limits[0], limits[1]));
    }
    if let (Some(near), Some(far)) = (near, far) {
        let range = (near < far).then_some(Range { near, far });
        return range.map(Some).ok_or(MethodError::range(limits[0], limits[1]));
    }
    let Some(seen) = visible(space, faces) else { return Ok(None) };
    let least = |depth: f64| if space.perspective { depth.abs() * SHALLOWEST } else { SHALLOWEST };
    Ok(Some(match (near, far) {
        (Some(near), _) => Range { near, far: seen.far.max(near + least(near)) },
        (_, Some(far)) => Range { near: seen.near.min(far - least(far)), far },
        _ => {
            let pad = (least(seen.far) - (seen.far - seen.near)).max(0.0);
            Range { near: seen.near - 0.5 * pad, far: seen.far + 0.5 * pad }
        }
    }))
}

/// The depths of the visible faces.
fn visible(space: &CameraSpace, faces: &Faces) -> Option<Range> {
    let ahead = Range::ahead(space, faces)?;
    let mut clipper = Clipper::new(space, ahead);
    let mut seen = Range { near: f64::INFINITY, far: f64::NEG_INFINITY };
    for face in 0..faces.len() as u32 {
        for vertex in clipper.clip_face(space, faces, face) {
            seen.include(vertex.at.z);
        }
    }
    // The range is a little wider, so that rounding does not move faces at its ends out of the range.
    let pad = 1e-12 * if space.perspective { seen.far } else { 1.0 };
    seen = Range { near: seen.near - pad, far: seen.far + pad };
    if space.perspective {
        seen.near = seen.near.max(seen.far * NEAREST);
    }
    (seen.far >= seen.near).then_some(seen)
}
