//! Filling a depth buffer: scan conversion, and one section of the picture at a time.

use binspace::glam::DVec3;
use binspace::raster::{
    Comparison, Faces, Image, Rays, Verdict, colour_of, compare, picture, zbuffer,
};
use binspace::scene;
use binspace::view::Camera;
use binspace_evidence::method::{DepthBuffer, DepthFormat, Interpolation, Method};

use super::chapter::{Chapter, Picture, failure};
use binspace_cli::failure::Failure;

const SIZE: [u32; 2] = [240, 180];
const WHITE: [u8; 3] = [255; 3];

/// The part of a chapter on filling the buffer.
pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    let body = Body::new()?;
    walks(chapter, &body)?;
    sections(chapter, &body)
}

/// A curved body of many small triangles.
struct Body {
    faces: Faces,
    camera: Camera,
    rays: Rays,
    truth: Image,
}

impl Body {
    fn new() -> Result<Self, Failure> {
        let scene = scene::teapot(14);
        let (faces, _) = Faces::new(scene.polygons(), None).map_err(failure)?;
        let ends = scene.bounds().ok_or_else(|| failure("an empty scene"))?;
        let (centre, extent) = ((ends.0 + ends.1) * 0.5, (ends.1 - ends.0).max_element());
        let eye = centre + DVec3::new(0.5, -1.2, 0.7) * extent;
        let camera = Camera::perspective(eye, centre, scene.up(), 0.45, SIZE).map_err(failure)?;
        let rays = Rays::new(&camera, &faces).map_err(failure)?;
        let truth = zbuffer(&rays, &faces).into_image();
        Ok(Self { faces, camera, rays, truth })
    }
}

/// Methods that find a face's pixels and their depths.
fn walks(chapter: &mut Chapter, body: &Body) -> Result<(), Failure> {
    let names = ["edge functions", "edge table, sums", "trapezoids", "integer edges"];
    let shown = picture(&body.rays, &body.faces, &body.truth, colour_of, WHITE);
    let mut pictures = vec![Picture::new(SIZE, shown, "the exact picture")];
    let mut rows = Vec::new();
    for format in [DepthFormat::Integer(24), DepthFormat::Float] {
        for (name, how) in names.into_iter().zip(Interpolation::ALL) {
            let method = DepthBuffer::new(format).with_interpolation(how);
            let mut ready = method.prepare(&body.faces).map_err(failure)?;
            let image = ready.paint(&body.camera, &body.rays).map_err(failure)?.image;
            let found = compare(&body.rays, &body.faces, &image, &body.truth);
            let counts = [found.wrong_order, found.holes, found.spills].map(|n| n.to_string());
            let [order, holes, spills] = counts;
            rows.push([name.to_owned(), format.to_string(), order, holes, spills]);
            if format == DepthFormat::Float && how == Interpolation::IntegerEdges {
                let shown = picture(&body.rays, &body.faces, &image, colour_of, WHITE);
                let marked = marked(&found, &shown);
                pictures.push(Picture::new(
                    SIZE,
                    marked,
                    format!(
                        "{name}, {format}: each wrong pixel is marked by a block of three by three"
                    ),
                ));
            }
        }
    }
    let covered = body.truth.covered();
    chapter.heading("Scan conversion");
    chapter.text(
        "Scan conversion finds the pixels that a polygon covers, and the depth of the polygon in each \
         of these pixels. Edge functions decide each pixel separately. The other methods walk along \
         edges and scanlines. Along an edge, x grows by 1/m from one scanline to the next. From one \
         pixel to the next, z grows by -A/C. A trapezoid lies between the heights of two vertices. \
         Along its left edge, z grows by (A/m + B)/C, or by B/C if the edge is vertical. Integer edges \
         store x as a number of pixels and a remainder, as Bresenham (1965) does for lines. The \
         vertices of integer edges are rounded to 1/256 of a pixel.",
    );
    chapter.pictures(pictures);
    chapter.table(["walk", "stored", "wrong order", "holes", "spills"], rows);
    chapter.text(format!(
        "The table compares each method with the exact picture of a teapot, which covers {covered} \
         pixels. Sums of rounded steps have errors of about a hundred-thousandth of a pixel. A pixel \
         is wrong only if its centre is that near to an edge. Such a pixel shows the wrong triangle \
         (red), shows none (black), or shows a triangle beyond the outline (blue). Vertices rounded to \
         1/256 have larger errors, so more pixels are wrong. But each edge is then walked exactly, so \
         triangles that share an edge meet without a gap.",
    ));
    Ok(())
}

/// A pale copy of a picture on which wrong pixels are marked.
fn marked(found: &Comparison, shown: &[u8]) -> Vec<u8> {
    let mut marked: Vec<u8> = shown.iter().map(|&c| 204 + c / 5).collect();
    let [width, height] = SIZE.map(|side| side as usize);
    for (k, verdict) in found.verdicts.iter().enumerate() {
        let colour = match verdict {
            Verdict::WrongOrder => [225, 0, 0],
            Verdict::Hole => [0, 0, 0],
            Verdict::Spill => [0, 60, 255],
            _ => continue,
        };
        let (x, y) = (k % width, k / width);
        for y in y.saturating_sub(1)..(y + 2).min(height) {
            for x in x.saturating_sub(1)..(x + 2).min(width) {
                marked[3 * (y * width + x)..][..3].copy_from_slice(&colour);
            }
        }
    }
    marked
}

/// A section of the picture at a time.
fn sections(chapter: &mut Chapter, body: &Body) -> Result<(), Failure> {
    let whole = DepthBuffer::new(DepthFormat::Integer(24));
    let mut rows = Vec::new();
    let mut first: Option<Image> = None;
    for (height, threads) in [(SIZE[1], 1), (45, 1), (16, 1), (16, 2), (4, 2), (1, 1)] {
        let method = whole.with_sections(height, threads);
        let mut ready = method.prepare(&body.faces).map_err(failure)?;
        let image = ready.paint(&body.camera, &body.rays).map_err(failure)?.image;
        let first = first.get_or_insert_with(|| image.clone());
        let pairs = image.faces().iter().zip(first.faces());
        let differ = pairs.filter(|(a, b)| a != b).count();
        let numbers = [height as usize, threads, ready.bytes(), differ];
        rows.push(numbers.map(|n| n.to_string()));
    }
    chapter.heading("A section of the picture at a time");
    chapter.text(
        "If memory is short, the buffer holds only a section of the picture, and all polygons are drawn \
         again for each section. The sections are independent, so threads can share them. Each depth \
         comes from the equation of a plane, not from a sum that starts at the border of a section. So \
         the picture is the same, bit for bit.",
    );
    chapter.table(
        ["rows per section", "threads", "bytes of depths and faces", "pixels that differ"],
        rows,
    );
    Ok(())
}
