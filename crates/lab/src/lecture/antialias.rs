//! Anti-aliasing.

use binspace::drawing::ViewOptions;
use binspace::glam::{DVec3, dvec3};
use binspace::raster::colour_of;
use binspace::scene::{self, Scene};
use binspace::view::Camera;
use binspace::{BspTree, BuildOptions};
use binspace_evidence::antialias::{Areas, blended, distance, supersampled};
use binspace_evidence::translucent::{Colour, rgb};

use super::chapter::{Chapter, Picture, percent};
use crate::chart::{Chart, Marker, Series, Style};
use binspace_cli::failure::Failure;

/// The size of pictures, which are computed small and shown enlarged, so that pixels are visible.
const SIZE: [u32; 2] = [80, 60];
const ENLARGED: u32 = 4;
const PAPER: Colour = [1.0; 3];
/// Rays along each side of a pixel.
const SIDES: [u32; 4] = [1, 2, 4, 8];

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.text(
        "A pixel is a square, not a point. The colour of a pixel should be the mean of the surfaces \
         that are visible in the pixel. One ray per pixel gives steps along edges, and misses details \
         thinner than a pixel. The visibility map of the tree consists of convex cells between exact \
         lines. If the cells are clipped to a pixel, the areas of their parts are the weights of the \
         mean (Catmull, A hidden-surface algorithm with anti-aliasing, 1978). Several rays per pixel \
         approximate the mean. Carpenter's A-buffer (1984) stores a mask of such samples for each \
         piece.",
    );
    let scene = scene::crossing(9);
    let tree = tree_of(&scene)?;
    let (eye, target) = scene.suggested_view().unwrap_or((DVec3::ONE, DVec3::ZERO));
    let camera = Camera::perspective(eye, target, scene.up(), 0.55, SIZE).map_err(view)?;
    samples(chapter, &tree, &camera)?;
    seams(chapter, &tree, &camera)
}

fn view(error: impl std::fmt::Display) -> Failure {
    Failure::about("a view", error)
}

fn tree_of(scene: &Scene) -> Result<BspTree, Failure> {
    let options = BuildOptions::DEFAULT.with_tolerance(0.0);
    options.build(scene.polygons()).map_err(|error| Failure::about("a tree", error))
}

fn areas(tree: &BspTree, camera: &Camera) -> Result<(Areas, f64), Failure> {
    let map = tree
        .visibility(camera, &ViewOptions::DEFAULT)
        .map_err(|error| Failure::about("a map", error))?;
    let whole: f64 = map.polygons().map(|shown| shown.area).sum();
    Ok((Areas::of(&map), whole))
}

fn colour(polygon: usize) -> Colour {
    colour_of(polygon).map(|c| f32::from(c) / 255.0)
}

/// A picture with large pixels.
fn enlarged(pixels: &[Colour], caption: impl Into<String>) -> Picture {
    let small = rgb(pixels);
    let size = SIZE.map(|side| ENLARGED * side);
    let at = |x: u32, y: u32| 3 * (y / ENLARGED * SIZE[0] + x / ENLARGED) as usize;
    let rows = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    let large = rows.flat_map(|(x, y)| small[at(x, y)..at(x, y) + 3].iter().copied()).collect();
    Picture::new(size, large, caption)
}

/// Compares increasing numbers of rays per pixel with the areas.
fn samples(chapter: &mut Chapter, tree: &BspTree, camera: &Camera) -> Result<(), Failure> {
    let (areas, whole) = areas(tree, camera)?;
    let exact = areas.picture(colour, PAPER);
    let (mut rows, mut points, mut pictures) = (Vec::new(), Vec::new(), Vec::new());
    for side in SIDES {
        let found = supersampled(camera, tree.faces(), side, colour, PAPER).map_err(view)?;
        let (largest, mean) = distance(&found, &exact);
        rows.push([(side * side).to_string(), format!("{largest:.3}"), format!("{mean:.4}")]);
        points.push((f64::from(side * side), mean));
        if side < 8 {
            pictures.push(enlarged(&found, format!("Rays per pixel: {}", side * side)));
        }
    }
    pictures.push(enlarged(&exact, "By areas"));
    chapter.pictures(pictures);
    chapter.table(["rays per pixel", "largest error", "root mean square error"], rows);
    chapter.graph(&Chart {
        title: "Error of samples against exact areas",
        x_label: "rays per pixel",
        y_label: "root mean square error",
        ticks: Some(SIDES.map(|side| f64::from(side * side)).to_vec()),
        falls: false,
        zero: false,
        series: vec![Series::new(
            "crossing:9",
            Style::new([0, 114, 178], Marker::Circle, 4),
            points,
        )],
    })?;
    let sum: f64 = areas.pixels().flatten().map(|(_, area)| area).sum();
    let parted = areas.pixels().filter(|shares| {
        shares.len() > 1 || shares.first().is_some_and(|share| share.1 < 1.0 - 1e-9)
    });
    chapter.text(format!(
        "{} of {} pixels contain an edge. The areas in all pixels sum to {sum:.6} pixels, and the areas of \
         the visible polygons to {whole:.6}. Channels range from 0 to 1, and are blended without a gamma \
         correction. Twice as many rays along each side of a pixel are four times the work, and about halve \
         the error. The tests compute the areas again in rational numbers: the difference is at most 1e-9 of \
         a pixel.",
        parted.count(),
        SIZE[0] * SIZE[1],
    ));
    Ok(())
}

/// Blends coverages in paint order, which shows seams.
fn seams(chapter: &mut Chapter, tree: &BspTree, camera: &Camera) -> Result<(), Failure> {
    chapter.heading("Seams");
    let mut fan = Scene::new("fan", DVec3::Y);
    let (middle, count) = (dvec3(0.1, 0.1, 0.0), 9);
    let corners = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let boundary = (0..4 * count).map(|k| {
        let ([a, b], t) = ([corners[k / count], corners[(k / count + 1) % 4]], (k % count) as f64);
        let at = |axis: usize| a[axis] + (b[axis] - a[axis]) * t / count as f64;
        dvec3(at(0), at(1), 0.0)
    });
    let boundary: Vec<DVec3> = boundary.collect();
    for k in 0..boundary.len() {
        fan.push([middle, boundary[k], boundary[(k + 1) % boundary.len()]], 0);
    }
    let flat = tree_of(&fan)?;
    let front = Camera::parallel(-DVec3::Z, DVec3::Y, DVec3::ZERO, 2.0, SIZE).map_err(view)?;
    let blue: Colour = colour(4);
    let constant = areas(&flat, &front)?.0.picture(|_| blue, PAPER);
    let joined = blended(&flat, &front, |_| blue, PAPER);
    let exact = areas(tree, camera)?.0.picture(colour, PAPER);
    let wrong = blended(tree, camera, colour, PAPER);
    let off = |pixel: &(&Colour, &Colour)| {
        pixel.0.iter().zip(pixel.1).any(|(a, b)| (a - b).abs() > 1.0 / 255.0)
    };
    let count = |a: &[Colour], b: &[Colour]| a.iter().zip(b).filter(off).count();
    let all = f64::from(SIZE[0] * SIZE[1]);
    let ((flat_most, _), (most, mean)) = (distance(&joined, &constant), distance(&wrong, &exact));
    let [seamed, steady] = [&joined, &constant].map(|p| count(p, &vec![blue; p.len()]));
    let crossed = count(&wrong, &exact);
    chapter.text(format!(
        "Painting programs use the covered share of a pixel as opacity. Suppose that two pieces of \
         one surface meet in an edge, and each covers half of a pixel. The first piece leaves half of \
         the background visible, and the second piece leaves half of this half. So a quarter of the \
         background shines through, because a share does not say which part of the pixel is covered. \
         The first picture is a fan of {} triangles of one colour that fills the picture. {seamed} \
         pixels ({}) have a wrong colour, with an error of up to {flat_most:.2}. If areas are the \
         weights, {steady} pixels have a wrong colour. In the scene above, hidden surfaces also shine \
         through along edges. {crossed} pixels ({}) differ from the areas, by up to {most:.2}, with a \
         root mean square error of {mean:.4}. The splits of a tree add such edges, so a painter must \
         not antialias edges. Instead, a painter can use several rays per pixel, or weight the visible \
         parts by their areas.",
        fan.len(),
        percent(seamed as f64, all),
        percent(crossed as f64, all),
    ));
    chapter.pictures([
        enlarged(&joined, format!("Coverage blended: {seamed} pixels of another colour")),
        enlarged(&constant, format!("By areas: {steady}")),
        enlarged(&wrong, "The scene above, coverage blended"),
        enlarged(&exact, "By areas"),
    ]);
    Ok(())
}
