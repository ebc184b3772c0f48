//! Transparency as an engine draws it. Vertices are uploaded once. Opaque triangles are drawn with a depth
//! buffer. Translucent triangles are drawn back to front, from an index buffer that is written only when the
//! order has changed.
//!
//! ```sh
//! cargo run --release --example gpu_transparency                    # walks along a path
//! cargo run --release --example gpu_transparency -- picture.png     # draws its last frame too
//! ```
//!
//! There is no window. `Target` stands for the device: it draws indexed triangles with a depth test
//! and blending.
//!
//! ![The last frame: panes of glass that cross, pillars and a ball](../docs/gpu_transparency.png)

#![allow(clippy::print_stdout, reason = "a program")]

use binspace::glam::{DVec3, Vec3, dvec3};
use binspace::{BspTree, Viewpoint};
use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::fs::File;
use std::io::BufWriter;

const SIZE: [usize; 2] = [960, 600];
const FRAMES: usize = 240;
const TARGET: DVec3 = dvec3(0.1, 0.0, 0.25);

struct Polygon {
    corners: Vec<DVec3>,
    color: [f32; 3],
    opacity: f32,
}

/// The input of a vertex shader.
struct Vertex {
    position: Vec3,
    color: [f32; 3],
    opacity: f32,
}

/// The number of index buffers that were written, and the picture of the last frame, if requested.
struct Film {
    written: usize,
    picture: Option<Vec<u8>>,
}

fn film(with_picture: bool) -> Result<Film, binspace::Error> {
    let scene = scene();
    let tree = BspTree::build(scene.iter().map(|polygon| &polygon.corners))?;

    // Done once: a vertex buffer for both passes, and the triangles of each pass.
    let mesh = tree.welded_mesh()?;
    let vertices: Vec<Vertex> = mesh
        .vertices()
        .map(|vertex| {
            let polygon = &scene[vertex.polygon];
            let (color, opacity) = (lit(polygon), polygon.opacity);
            Vertex { position: vertex.position.as_vec3(), color, opacity }
        })
        .collect();
    let opaque = mesh.triangles_of(|polygon| scene[polygon].opacity == 1.0)?;
    let translucent = mesh.triangles_of(|polygon| scene[polygon].opacity < 1.0)?;

    // In every frame: nothing to do, unless the eye has passed a partition plane.
    let mut order = Vec::new(); // working space
    let mut indices = vec![0; translucent.indices().len()]; // or mapped memory of a device
    let mut written_for = None;
    let mut written = 0;
    for frame in 0..FRAMES {
        let viewpoint = Viewpoint::Eye(eye(frame));
        if !written_for.is_some_and(|last| tree.same_order(last, viewpoint)) {
            translucent.write_back_to_front(&tree, viewpoint, &mut order, &mut indices)?;
            (written_for, written) = (Some(viewpoint), written + 1);
        }
        // Here a renderer would draw both passes.
    }

    let picture = with_picture.then(|| {
        let mut target = Target::new(eye(FRAMES - 1));
        target.draw(&vertices, opaque.indices(), true);
        target.draw(&vertices, &indices, false);
        target.resolve()
    });
    Ok(Film { written, picture })
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1);
    let film = film(path.is_some())?;
    println!("{FRAMES} frames, {} index buffers written", film.written);
    if let (Some(path), Some(picture)) = (path, film.picture) {
        let file = BufWriter::new(File::create(path)?);
        let mut png = png::Encoder::new(file, SIZE[0] as u32, SIZE[1] as u32);
        png.set_color(png::ColorType::Rgb);
        png.write_header()?.write_image_data(&picture)?;
    }
    Ok(())
}

/// A walk past the scene.
fn eye(frame: usize) -> DVec3 {
    let angle = -1.9 + 0.7 * frame as f64 / FRAMES as f64;
    dvec3(6.2 * angle.cos(), 6.2 * angle.sin(), 2.9)
}

/// A floor of tiles, three pillars, panes of glass that cross each other and the pillars, and a
/// translucent ball.
fn scene() -> Vec<Polygon> {
    let mut scene = Vec::new();
    let mut add = |corners: Vec<DVec3>, color, opacity| {
        scene.push(Polygon { corners, color, opacity });
    };
    for (x, y) in (-4..4).flat_map(|x| (-4..4).map(move |y| (x, y))) {
        let tile = [(0, 0), (1, 0), (1, 1), (0, 1)];
        let corners = tile.map(|(u, v)| dvec3(f64::from(x + u), f64::from(y + v), 0.0) * 0.6);
        let grey = if (x + y) % 2 == 0 { 0.86 } else { 0.62 };
        add(corners.to_vec(), [grey; 3], 1.0);
    }
    for (x, y, height, color) in [
        (-1.1, 0.6, 1.7, [0.80, 0.45, 0.25]),
        (1.2, 0.9, 1.2, [0.35, 0.55, 0.35]),
        (0.3, -1.2, 0.8, [0.45, 0.45, 0.70]),
    ] {
        let ring = |z: f64| {
            [(-1, -1), (1, -1), (1, 1), (-1, 1)]
                .map(|(u, v)| dvec3(x + 0.25 * f64::from(u), y + 0.25 * f64::from(v), z))
        };
        let (low, high) = (ring(0.0), ring(height));
        add(high.to_vec(), color, 1.0);
        for k in 0..4 {
            let next = (k + 1) % 4;
            add(vec![low[k], low[next], high[next], high[k]], color, 1.0);
        }
    }
    for (angle, color) in
        [(0.2, [0.95, 0.35, 0.30]), (1.25, [0.25, 0.60, 0.95]), (2.3, [0.98, 0.80, 0.20])]
    {
        let along = dvec3(f64::cos(angle), f64::sin(angle), 0.0) * 2.0;
        let up = dvec3(0.0, 0.0, 1.4);
        let low = dvec3(0.0, -0.1, 0.05);
        add(vec![low - along, low + along, low + along + up, low - along + up], color, 0.45);
    }
    let (rings, sides) = (8, 16);
    let on_ball = |i: usize, k: usize| {
        let (down, around) = (i as f64 / rings as f64, (k % sides) as f64 / sides as f64);
        let (tilt, turn) = (down * PI, around * TAU);
        // At the poles the sine is not quite zero; the corners there must be equal.
        let radius = if i.is_multiple_of(rings) { 0.0 } else { tilt.sin() };
        let height = tilt.cos();
        dvec3(0.75, -0.35, 0.95) + 0.55 * dvec3(radius * turn.cos(), radius * turn.sin(), height)
    };
    for (i, k) in (0..rings).flat_map(|i| (0..sides).map(move |k| (i, k))) {
        let corners = [on_ball(i, k), on_ball(i + 1, k), on_ball(i + 1, k + 1), on_ball(i, k + 1)];
        add(corners.to_vec(), [0.30, 0.80, 0.55], 0.40);
    }
    scene
}

/// A polygon's colour, lit from above; glass is not lit.
fn lit(polygon: &Polygon) -> [f32; 3] {
    let [a, b, c] = [0, 1, 2].map(|k| polygon.corners[k * (polygon.corners.len() - 1) / 2]);
    let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
    let light: f64 = 0.55 + 0.45 * normal.dot(dvec3(0.4, -0.5, 0.77)).abs();
    let light = if polygon.opacity < 1.0 { 1.0 } else { light };
    polygon.color.map(|channel| channel * light as f32)
}

/// Stands for the device: a colour buffer and a depth buffer with two by two samples per pixel.
struct Target {
    eye: DVec3,
    axes: [DVec3; 3],
    colors: Vec<[f32; 3]>,
    nearness: Vec<f64>,
}

impl Target {
    const WIDTH: usize = 2 * SIZE[0];
    const HEIGHT: usize = 2 * SIZE[1];
    /// Positions are rounded to this share of a sample, as devices do.
    const STEPS: f64 = 256.0;

    fn new(eye: DVec3) -> Self {
        let ahead = (TARGET - eye).normalize();
        let right = ahead.cross(DVec3::Z).normalize();
        let samples = Self::WIDTH * Self::HEIGHT;
        let (colors, nearness) = (vec![[0.93, 0.95, 0.98]; samples], vec![0.0; samples]);
        Self { eye, axes: [right, ahead.cross(right), ahead], colors, nearness }
    }

    /// Draws triangles with depth test and blending; `writes_depth` is off for translucent triangles.
    fn draw(&mut self, vertices: &[Vertex], indices: &[u32], writes_depth: bool) {
        for triangle in indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|k| &vertices[triangle[k] as usize]);
            let [p, q, r] = [a, b, c].map(|vertex| self.project(vertex.position.as_dvec3()));
            let both = [(p, q, r), (p, r, q)].into_iter().find(|&(p, q, r)| area(p, q, r) > 0);
            if let Some((p, q, r)) = both {
                self.fill([p, q, r], a.color, a.opacity, writes_depth);
            }
        }
    }

    /// The position on the screen in steps to the right and down, and 1 / depth, which is linear on the
    /// screen.
    fn project(&self, position: DVec3) -> (i64, i64, f64) {
        let [x, y, z] = self.axes.map(|axis| axis.dot(position - self.eye));
        let scale = 1.35 * Self::HEIGHT as f64 / z;
        let place = |from_middle: f64, side: usize| {
            ((from_middle * scale + side as f64 * 0.5) * Self::STEPS).round() as i64
        };
        (place(x, Self::WIDTH), place(y, Self::HEIGHT), 1.0 / z)
    }

    fn fill(
        &mut self,
        [p, q, r]: [(i64, i64, f64); 3],
        color: [f32; 3],
        opacity: f32,
        writes: bool,
    ) {
        let step = Self::STEPS as i64;
        let span = |values: [i64; 3], size: usize| {
            let least = values.into_iter().min().unwrap_or(0) / step;
            let most = values.into_iter().max().unwrap_or(0) / step + 1;
            least.max(0)..most.min(size as i64)
        };
        let whole = area(p, q, r) as f64;
        for y in span([p.1, q.1, r.1], Self::HEIGHT) {
            for x in span([p.0, q.0, r.0], Self::WIDTH) {
                let at = (x * step + step / 2, y * step + step / 2, 0.0);
                let inside =
                    [(q, r), (r, p), (p, q)].map(|(a, b)| (area(a, b, at), is_top_left(a, b)));
                if inside.iter().any(|&(side, on)| side < 0 || side == 0 && !on) {
                    continue;
                }
                let [u, v, w] = inside.map(|(side, _)| side as f64 / whole);
                let nearness = u * p.2 + v * q.2 + w * r.2;
                let sample = y as usize * Self::WIDTH + x as usize;
                if nearness < self.nearness[sample] {
                    continue;
                }
                for (channel, new) in self.colors[sample].iter_mut().zip(color) {
                    *channel += (new - *channel) * opacity;
                }
                if writes {
                    self.nearness[sample] = nearness;
                }
            }
        }
    }

    /// The mean of each pixel's samples, as RGB bytes.
    fn resolve(&self) -> Vec<u8> {
        let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (2 * x, 2 * y)));
        let sample = |x: usize, y: usize, k: usize| self.colors[y * Self::WIDTH + x][k];
        pixels
            .flat_map(|(x, y)| {
                [0, 1, 2].map(|k| {
                    let sum = sample(x, y, k)
                        + sample(x + 1, y, k)
                        + sample(x, y + 1, k)
                        + sample(x + 1, y + 1, k);
                    (sum * 63.75).round() as u8
                })
            })
            .collect()
    }
}

/// Twice the area of a triangle on the screen, positive if it runs to the right and then down.
fn area(a: (i64, i64, f64), b: (i64, i64, f64), c: (i64, i64, f64)) -> i64 {
    (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
}

/// Whether a sample exactly on an edge is inside. Of two triangles that share an edge, one contains it.
fn is_top_left(a: (i64, i64, f64), b: (i64, i64, f64)) -> bool {
    a.1 > b.1 || a.1 == b.1 && a.0 < b.0
}

#[test]
fn few_frames_need_a_new_order_and_the_picture_shows_the_scene() {
    let film = film(true).expect("memory");
    assert!((2..FRAMES).contains(&film.written), "{} index buffers", film.written);
    let picture = film.picture.expect("a picture was wanted");
    assert_eq!(picture.len(), 3 * SIZE[0] * SIZE[1]);
    let mut colors: Vec<&[u8]> = picture.chunks(3).collect();
    colors.sort_unstable();
    colors.dedup();
    assert!(colors.len() > 300, "{} colours", colors.len());
}
