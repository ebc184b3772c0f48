//! Curved surfaces beside polygons.

use binspace::BuildOptions;
use binspace::paint::paint_tree;
use binspace::raster::{Faces, NONE, Rays, colour_of};
use binspace_evidence::curved::{Patch, Shared, Sphere, Surfaces, mesh, nearest};
use binspace_evidence::panes::{panes, world_polygons};
use binspace_evidence::plain::PlainView;

use super::chapter::{Chapter, Picture, failure};
use binspace_cli::failure::Failure;

const SIZE: [u32; 2] = [200, 150];
const WHITE: [u8; 3] = [255; 3];

/// The part of a chapter on curved surfaces.
pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    let view = PlainView::new(SIZE);
    let (polygons, _) = panes(8, 2);
    let patches = Patch::pair();
    let sphere = Sphere { centre: [100, -60, -1800], radius: 350 };
    let surfaces = Surfaces { polygons: &polygons, sphere, patches: &patches };
    let (faces, _) = Faces::new(world_polygons(&polygons), Some(0.0)).map_err(failure)?;
    let rays = Rays::new(&view.camera(), &faces).map_err(failure)?;
    let mut picture = Shared::new(&rays, &faces);
    surfaces.draw(&view, &mut picture);
    let truth = certain(&surfaces, &view);
    let judged = truth.iter().flatten().count();
    let wrong = differing(&truth, picture.shown());
    let mut pictures = vec![Picture::new(SIZE, shaded(&picture), "one depth buffer")];
    let mut rows = vec![["own routines".into(), "-".into(), "-".into(), wrong.to_string()]];
    // The trees do not contain the sphere: no ray meets a sphere of radius 0.
    let no_sphere = Sphere { radius: 0, ..sphere };
    let truth = certain(&Surfaces { sphere: no_sphere, ..surfaces }, &view);
    for tolerance in [4.0, 0.5, 0.05] {
        let (shown, cut) = by_tree(&surfaces, &view, tolerance)?;
        let [triangles, fragments] = cut.map(|n| n.to_string());
        let wrong = differing(&truth, &shown.surfaces).to_string();
        rows.push([format!("{tolerance} pixels"), triangles, fragments, wrong]);
        let colour = |&piece: &u32| if piece == NONE { WHITE } else { colour_of(piece as usize) };
        let rgb = shown.polygons.iter().flat_map(colour).collect();
        pictures.push(Picture::new(SIZE, rgb, format!("triangles within {tolerance} pixels")));
    }
    chapter.heading("Curved surfaces");
    chapter.text(
        "A depth buffer accepts any surface that has a depth in each pixel. Here polygons, a sphere and \
         two Bézier patches share one buffer. A separate routine draws each kind. The depth of the \
         sphere is the smaller root of a quadratic equation. The patches are halved until the parts are \
         smaller than a pixel (Catmull 1974). A tree accepts only planar polygons, so patches are first \
         divided into triangles, as many as the picture needs (Filip, Magedson & Markot 1986). The \
         division of a shared edge depends only on the curve of the edge, and on the patch that needs \
         the finer division. Both patches therefore get the same points along the edge, and no crack \
         opens.",
    );
    chapter.pictures(pictures);
    chapter.table(["patches by", "triangles", "fragments of the tree", "wrong pixels"], rows);
    chapter.text(format!(
        "The pictures are judged in integers. The sphere is decided by the sign of a discriminant and by \
         comparing squares. A ray is the line where two planes meet, and it meets a patch where the patch \
         meets both planes: there, two functions on the patch are 0. Parts of the patch in which one of \
         the functions cannot be 0 are discarded. The Poincaré–Miranda theorem proves that both functions \
         are 0 somewhere in a remaining part. {judged} of {} pixels are certain in this way. \
         Other pixels are not judged: they are near outlines, or a patch and another surface have nearly the \
         same depth there. Triangles only approximate a patch, so some judged pixels show a wrong surface: \
         at outlines, and where patches cross polygons.",
        SIZE[0] * SIZE[1]
    ));
    Ok(())
}

/// The certainly nearest surface in each pixel.
fn certain(surfaces: &Surfaces<'_>, view: &PlainView) -> Vec<Option<u32>> {
    let pixels = (0..SIZE[0] * SIZE[1]).map(|i| [i % SIZE[0], i / SIZE[0]]);
    pixels.map(|pixel| nearest(surfaces, view, pixel)).collect()
}

/// The number of certain pixels that show another surface.
fn differing(truth: &[Option<u32>], shown: &[u32]) -> usize {
    truth.iter().zip(shown).filter(|(truth, shown)| truth.is_some_and(|t| t != **shown)).count()
}

/// The surfaces by colour, darker the further away they are.
fn shaded(picture: &Shared) -> Vec<u8> {
    let pixels = picture.shown().iter().zip(picture.depths());
    let colour = |(&number, &depth): (&u32, &f64)| {
        let share = (4.5 / depth).clamp(0.3, 1.0);
        if number == NONE {
            return WHITE;
        }
        colour_of(number as usize).map(|c| (f64::from(c) * share) as u8)
    };
    pixels.flat_map(colour).collect()
}

/// The picture of a tree: in each pixel the surface by number, and the polygon.
struct Shown {
    surfaces: Vec<u32>,
    polygons: Vec<u32>,
}

/// The picture of the polygons and the triangulated patches, by a tree; the numbers of triangles and of
/// fragments.
fn by_tree(
    surfaces: &Surfaces<'_>,
    view: &PlainView,
    tolerance: f64,
) -> Result<(Shown, [usize; 2]), Failure> {
    let mut polygons = world_polygons(surfaces.polygons);
    let flat = polygons.len();
    let mut numbers: Vec<u32> = (0..flat as u32).collect();
    let meshes = mesh(surfaces.patches, view, tolerance);
    for (number, triangles) in (flat as u32 + 1..).zip(meshes) {
        numbers.extend(triangles.iter().map(|_| number));
        polygons.extend(triangles.iter().map(|triangle| triangle.corners.to_vec()));
    }
    let tree = BuildOptions::DEFAULT.with_tolerance(0.0).build(&polygons).map_err(failure)?;
    let camera = view.camera();
    let rays = Rays::new(&camera, tree.faces()).map_err(failure)?;
    let image = paint_tree(&tree, camera.viewpoint(), &rays);
    let polygon = |&face: &u32| if face == NONE { NONE } else { tree.faces().polygon(face) as u32 };
    let shown: Vec<u32> = image.faces().iter().map(polygon).collect();
    let surface = |&p: &u32| if p == NONE { NONE } else { numbers[p as usize] };
    let surfaces = shown.iter().map(surface).collect();
    Ok((Shown { surfaces, polygons: shown }, [polygons.len() - flat, tree.len()]))
}
