//! The need for an order: a picture without one, and the effect of back-face detection alone.

use binspace::glam::DVec3;
use binspace::scene::{Builtin, Scene};
use binspace_evidence::Facing;
use binspace_evidence::method::{ExactDepth, FrontFaces, InputOrder, Options, Space, all};

use super::chapter::{Chapter, percent};
use super::shot::Shot;
use binspace_cli::failure::Failure;

const DIRECTION: DVec3 = DVec3::new(0.6, -1.0, 0.55);

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    no_removal(chapter)?;
    back_faces(chapter)?;
    spaces(chapter);
    Ok(())
}

fn no_removal(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.text(
        "In each pixel, a picture shows the surface that is nearest along the ray through the pixel. \
         If polygons are drawn in the order of their file, each polygon covers all earlier polygons in \
         its area, even nearer polygons. A pixel counts as wrong if it shows a polygon other than the \
         nearest one. A depth buffer in exact arithmetic finds the nearest polygon.",
    );
    let mut pictures = Vec::new();
    for (scene, name) in [(Builtin::City, "A city"), (Builtin::Teapot, "The teapot")] {
        let scene = scene.build(Some(if scene == Builtin::City { 600 } else { 6 }), 1);
        let shot = Shot::around(&scene, DIRECTION)?;
        pictures.push(shot.by(&InputOrder, &format!("{name} in input order"))?);
        pictures.push(shot.by(&ExactDepth, &format!("{name} by an exact depth buffer"))?);
    }
    chapter.pictures(pictures);
    Ok(())
}

fn back_faces(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.heading("Back faces");
    chapter.text(
        "The plane of a polygon is Ax + By + Cz + D = 0. The normal (A, B, C) of the plane points out \
         of the body. If Ax + By + Cz + D < 0 at the eye, the eye is behind the polygon and sees its \
         back. The body itself then hides the polygon, so the polygon can be left out. For parallel \
         rays along the z axis, only the sign of C matters. If C = 0, the polygon is seen edge-on and \
         covers no pixel.",
    );
    chapter.text(
        "For a convex body, this step is sufficient: all remaining polygons are visible, and no two \
         of them overlap in the picture. Other closed bodies also have hidden front faces. So front \
         faces still need an order, but there are fewer front faces than polygons. A surface that is \
         not closed, such as a terrain seen from below, loses back faces that are visible.",
    );
    let scenes = [
        (Builtin::Sphere, 500, "sphere, convex"),
        (Builtin::City, 600, "city, closed boxes on the ground"),
        (Builtin::Newell, 1, "three bars, closed"),
        (Builtin::Teapot, 6, "teapot, several parts"),
        (Builtin::Random, 300, "random triangles, open"),
    ];
    let (mut pictures, mut rows) = (Vec::new(), Vec::new());
    for (builtin, size, name) in scenes {
        let scene: Scene = builtin.build(Some(size), 1);
        let mut shot = Shot::around(&scene, DIRECTION)?;
        if builtin == Builtin::Sphere {
            shot = shot.coloured_by_polygon(&scene);
        }
        let (all, fronts) = (shot.paint(&InputOrder)?, shot.paint(&FrontFaces(InputOrder))?);
        if matches!(builtin, Builtin::Sphere | Builtin::City | Builtin::Newell) {
            pictures.push(shot.picture(&fronts, &format!("{name}: front faces in input order")));
        }
        let facing = Facing::of(&shot.faces, shot.camera.viewpoint());
        let count = shot.faces.len();
        let share = |part: usize| percent(part as f64, count as f64).to_string();
        let wrong = |error: &binspace_evidence::measure::PictureError| {
            percent(error.wrong() as f64, error.covered as f64).to_string()
        };
        rows.push([
            name.to_owned(),
            count.to_string(),
            share(facing.removed()),
            wrong(&all.error),
            wrong(&fronts.error),
        ]);
    }
    chapter.pictures(pictures);
    let head = [
        "scene",
        "polygons",
        "removed",
        "wrong pixels, all polygons",
        "wrong pixels, front faces only",
    ];
    chapter.table(head, rows);
    Ok(())
}

fn spaces(chapter: &mut Chapter) {
    chapter.heading("Object space or image space");
    chapter.text(
        "Methods differ in the space in which they decide (I. E. Sutherland, R. F. Sproull and R. A. \
         Schumacker, \"A characterization of ten hidden-surface algorithms\", 1974). Object-space \
         methods compare polygons of the scene, at any resolution. Image-space methods decide in each \
         pixel. A third kind assigns priorities to polygons, partly in object space and partly in image \
         space. The table lists the methods that this page and the report compare. In the names, bsp \
         means a BSP tree that decides exactly, or in f64 or f32 with the given tolerance. z is a \
         depth buffer with the given number of bits, or with floating-point \
         numbers (f32). w is a depth buffer that stores the depth itself instead of the usual z. The \
         rest of the name says how pixels are found, and which depths count as nearer. The chapters \
         below explain the methods.",
    );
    let methods = all(&Options::DEFAULT);
    let row = |space: Space| {
        let of_it = methods.iter().filter(|method| method.space() == space);
        let names: Vec<String> = of_it.map(|method| method.name()).collect();
        [space.to_string(), names.join("; ")]
    };
    let spaces = [Space::Neither, Space::Object, Space::Both, Space::Image];
    chapter.table(["decides in", "methods"], spaces.map(row));
}
