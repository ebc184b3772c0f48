//! Views of small scenes as drawings, at several zooms, compared with the tree's painted pictures.

use super::super::decode;
use super::super::fill::{Score, check};
use super::super::layered::{Layers, check_mixed};
use arbitrary::{Result, Unstructured};
use binspace::glam::DVec3;
use binspace::raster::Rays;
use binspace::view::Camera;

/// Builds a tree, and draws views of it until the bytes end.
pub fn run(data: &[u8]) {
    // Too few bytes change nothing.
    let _ = draw(&mut Unstructured::new(data));
}

fn draw(bytes: &mut Unstructured<'_>) -> Result<()> {
    let options = decode::options(bytes)?;
    // Views come first: scenes take all bytes that are left.
    let views = [view(bytes)?, view(bytes)?, view(bytes)?];
    let polygons = decode::polygons(bytes, 10)?;
    let Ok(tree) = options.build(&polygons) else { return Ok(()) };
    for camera in views.into_iter().flatten() {
        // Some cameras are too near to a scene, or too far from it, to distinguish its pixels.
        if Rays::new(&camera, tree.faces()).is_err() {
            continue;
        }
        // Of four polygons, one is translucent, and one is left out.
        let opacity = |polygon: usize| [1.0, 0.5, 1.0, 0.0][polygon % 4];
        let checked = check(&tree, &camera, &mut Score::default());
        let checked =
            checked.and_then(|()| check_mixed(&tree, &camera, &opacity, &mut Layers::default()));
        if let Err(what) = checked {
            panic!("{what}: {camera:?} {polygons:?}");
        }
    }
    Ok(())
}

/// A camera at a place of half integers, so that it often looks along planes and from corners.
fn view(bytes: &mut Unstructured<'_>) -> Result<Option<Camera>> {
    let mut point = || -> Result<DVec3> {
        let mut half = || Ok(f64::from(bytes.int_in_range(-8..=12i8)?) * 0.5);
        Ok(DVec3::new(half()?, half()?, half()?))
    };
    let (place, target) = (point()?, point()?);
    // 1, 8, 32 and 128 times.
    let zoom = *bytes.choose(&[1.0, 0.125, 0.03125, 0.0078125])?;
    let size = *bytes.choose(&[[24, 18], [31, 7], [1, 1]])?;
    let up = *bytes.choose(&[DVec3::Z, DVec3::Y, DVec3::new(1.0, 2.0, 3.0)])?;
    let camera = match bytes.ratio(1, 3)? {
        true => Camera::parallel(target - place, up, place, 8.0 * zoom, size),
        false => Camera::perspective_by_slope(place, target, up, 0.5 * zoom, size),
    };
    Ok(camera.ok())
}
