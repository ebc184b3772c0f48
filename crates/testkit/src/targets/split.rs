//! A face cut repeatedly; each sign and each part is compared with exact rationals.

use super::super::cut_walk::{Tally, Walk};
use super::super::decode;
use arbitrary::{Result, Unstructured};
use binspace::internals::{Faces, PlaneId};

/// Cuts a face of a scene of at most eight polygons up to sixteen times.
pub fn run(data: &[u8]) {
    // The cuts end with the bytes.
    let _ = try_run(&mut Unstructured::new(data));
}

fn try_run(bytes: &mut Unstructured<'_>) -> Result<()> {
    let tolerance = decode::options(bytes)?.tolerance;
    let polygons = decode::polygons(bytes, 8)?;
    let Ok((faces, _)) = Faces::new(&polygons, tolerance) else {
        let refused = polygons.iter().flatten().any(|corner| !corner.is_finite());
        // Only coordinates that are not finite are refused.
        assert!(refused, "{polygons:?}");
        return Ok(());
    };
    if faces.is_empty() {
        return Ok(());
    }
    let (face, mut tally) = (bytes.int_in_range(0..=faces.len() - 1)? as u32, Tally::default());
    let mut walk = Walk::new(&faces, face, &mut tally);
    for _ in 0..16 {
        let plane = if bytes.int_in_range(0..=2u8)? == 0 {
            let corner = bytes.int_in_range(0..=faces.corner_count() - 1)?;
            PlaneId::axis(bytes.int_in_range(0..=2usize)?, corner as u32)
        } else {
            PlaneId::face(bytes.int_in_range(0..=faces.len() - 1)? as u32)
        };
        if let Err(what) = walk.step(plane, bytes.arbitrary()?) {
            panic!("{what}: face {face} of {polygons:?}, {plane:?}");
        }
    }
    Ok(())
}
