//! Why surfaces have to be ordered: a picture without an order, and the effect of back-face detection alone.

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
        "A picture shows, in each pixel, the surface that is nearest along the ray through it. Drawn in the \
         order in which a file happens to list them, polygons cover one another at random: what is listed \
         later is on top, wherever it is. A pixel counts as wrong if it shows another polygon than the \
         nearest, by a depth buffer in exact arithmetic.",
    );
    let mut pictures = Vec::new();
    for (scene, name) in [(Builtin::City, "A city"), (Builtin::Teapot, "The teapot")] {
        let scene = scene.build(Some(if scene == Builtin::City { 600 } else { 6 }), 1);
        let shot = Shot::around(&scene, DIRECTION)?;
        pictures.push(shot.by(&InputOrder, &format!("{name} in input order"))?);
        pictures.push(shot.by(&ExactDepth, &format!("{name} as it is"))?);
    }
    chapter.pictures(pictures);
    Ok(())
}

fn back_faces(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.heading("Back faces");
    chapter.text(
        "The plane of a polygon is Ax + By + Cz + D = 0, with the normal (A, B, C) pointing out of the body. \
         If Ax + By + Cz + D < 0 at the eye, the eye is behind the polygon and sees its back: the body itself \
         is in the way, and the polygon can be left out. For parallel rays along the z axis only the sign of C \
         counts; C = 0 is a polygon seen edge-on, which covers no pixel.",
    );
    chapter.text(
        "For a convex body this step is all that is needed: what is left is visible, and no two of the \
         polygons overlap in the picture. Other closed bodies keep hidden fronts, and still have to be \
         ordered, with fewer polygons to order. A surface that is not closed, such as a terrain seen from \
         below, loses what can be seen of its backs.",
    );
    let scenes = [
        (Builtin::Sphere, 500, "sphere, convex"),
        (Builtin::City, 600, "city, closed boxes on a ground"),
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
            pictures.push(shot.picture(&fronts, &format!("{name}: fronts in input order")));
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
    let head =
        ["scene", "polygons", "removed", "wrong pixels, all polygons", "wrong pixels, fronts"];
    chapter.table(head, rows);
    Ok(())
}

fn spaces(chapter: &mut Chapter) {
    chapter.heading("Object space or image space");
    chapter.text(
        "Methods differ in where they decide (I. E. Sutherland, R. F. Sproull and R. A. Schumacker, \"A \
         characterization of ten hidden-surface algorithms\", 1974): among the polygons of the scene, at \
         whatever resolution it is drawn (object space), in each pixel (image space), or with priorities \
         among polygons that are found partly in the one and partly in the other. These are the methods that \
         are compared here and in the report. In their names, bsp is the tree: exact, or decided in numbers \
         of 64 or 32 bits with the tolerance that follows. z is a depth buffer of so many bits, or of \
         floating-point numbers (f32); w is one that stores the depth itself instead of the usual z; what \
         follows says how pixels are found and which depths count as nearer. The chapters below explain \
         them.",
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
