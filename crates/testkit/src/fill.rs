//! Fills outlines at the centres of pixels, in floats; pixels too near to an outline are left out.

use binspace::drawing::{Drawing, ViewOptions, VisibilityMap};
use binspace::paint::paint_tree;
use binspace::raster::Rays;
use binspace::view::Camera;
use binspace::{BspTree, Facing, Hit, Viewpoint};

/// Returns view options with an opacity for each polygon.
pub fn with_opacities(tree: &BspTree, opacity: impl Fn(usize) -> f64) -> ViewOptions<'static> {
    ViewOptions::DEFAULT.with_opacities((0..tree.preparation().polygons).map(opacity).collect())
}

/// The polygon that covers the centre of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pixel {
    Nothing,
    Polygon(usize),
    /// An outline passes too near.
    Unsure,
}

/// A picture in which outlines are filled, one after another.
pub struct Picture {
    size: [usize; 2],
    pub pixels: Vec<Pixel>,
    /// The number of outlines that cover each pixel.
    pub layers: Vec<u32>,
}

/// Centres nearer to an outline than this, in pixels, are not compared: where parts were joined, outlines
/// are off by up to 2⁻¹⁵.
const NEAR: f64 = 4e-5;

impl Picture {
    pub fn new(size: [u32; 2]) -> Self {
        let size = size.map(|side| side as usize);
        let pixels = vec![Pixel::Nothing; size[0] * size[1]];
        Self { size, layers: vec![0; pixels.len()], pixels }
    }

    /// Fills the points whose winding number is not 0.
    pub fn fill<'o>(&mut self, polygon: usize, outlines: impl Iterator<Item = &'o [[f64; 2]]>) {
        let [width, height] = self.size;
        let mut crossings: Vec<(usize, f64, i32)> = Vec::new();
        for outline in outlines {
            for (i, a) in outline.iter().enumerate() {
                // Coordinates are from the centre of the first pixel.
                let [a, b] = [a, &outline[(i + 1) % outline.len()]].map(|end| end.map(|c| c - 0.5));
                self.mark_near(a, b);
                let (low, high, step) = if a[1] < b[1] { (a, b, 1) } else { (b, a, -1) };
                let rows = low[1].ceil().max(0.0) as usize..height;
                for y in rows.take_while(|&y| (y as f64) < high[1]) {
                    let share = (y as f64 - low[1]) / (high[1] - low[1]);
                    crossings.push((y, low[0] + (high[0] - low[0]) * share, step));
                }
            }
        }
        crossings.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        for row in crossings.chunk_by(|a, b| a.0 == b.0) {
            let mut winding = 0;
            for pair in row.windows(2) {
                winding += pair[0].2;
                if winding == 0 {
                    continue;
                }
                let [from, to] = [pair[0].1, pair[1].1].map(|x| x.ceil().max(0.0) as usize);
                for x in from..to.min(width) {
                    let pixel = &mut self.pixels[pair[0].0 * width + x];
                    self.layers[pair[0].0 * width + x] += 1;
                    if *pixel != Pixel::Unsure {
                        *pixel = Pixel::Polygon(polygon);
                    }
                }
            }
        }
    }

    /// Marks the pixels whose centres an edge passes too near.
    fn mark_near(&mut self, a: [f64; 2], b: [f64; 2]) {
        let [width, height] = self.size.map(|side| side as f64);
        for axis in 0..2 {
            // Along each row, and each column.
            let (low, high) = if a[axis] < b[axis] { (a, b) } else { (b, a) };
            let limit = if axis == 0 { width } else { height };
            let first = (low[axis] - NEAR).ceil().max(0.0);
            let last = (high[axis] + NEAR).floor().min(limit - 1.0);
            let mut at = first;
            while at <= last {
                let length = high[axis] - low[axis];
                let share =
                    if length > 0.0 { ((at - low[axis]) / length).clamp(0.0, 1.0) } else { 0.0 };
                let across = low[1 - axis] + (high[1 - axis] - low[1 - axis]) * share;
                let nearest = across.round();
                if (across - nearest).abs() < NEAR {
                    let [x, y] = if axis == 0 { [at, nearest] } else { [nearest, at] };
                    if x >= 0.0 && y >= 0.0 && x < width && y < height {
                        self.pixels[y as usize * self.size[0] + x as usize] = Pixel::Unsure;
                    }
                }
                at += 1.0;
            }
        }
    }

    /// Returns the numbers of all pixels that outlines may have changed, and some around them.
    pub fn around<'o>(&self, outlines: impl Iterator<Item = &'o [[f64; 2]]>) -> Vec<usize> {
        let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
        for corner in outlines.flatten() {
            for axis in 0..2 {
                low[axis] = low[axis].min(corner[axis]);
                high[axis] = high[axis].max(corner[axis]);
            }
        }
        let width = self.size[0];
        let [columns, rows] = [0, 1].map(|axis| {
            (low[axis] - 1.0).max(0.0) as usize
                ..self.size[axis].min((high[axis] + 1.0).max(0.0) as usize)
        });
        rows.flat_map(|y| columns.clone().map(move |x| y * width + x)).collect()
    }

    pub fn of(drawing: &Drawing) -> Self {
        let mut picture = Self::new(drawing.size());
        drawing.paths().for_each(|path| picture.fill(path.polygon(), path.outlines()));
        picture
    }
}

/// Counts of compared pictures, pixels, paths and rays.
#[derive(Clone, Copy, Debug, Default)]
pub struct Score {
    pub pictures: usize,
    pub pixels: usize,
    pub unsure: usize,
    pub paths: usize,
    pub clipped: usize,
    pub rays: usize,
}

/// Compares the map and the drawing of a view with the picture of the tree's order, pixel by pixel, by
/// separate integers. For small scenes also with front faces only.
pub fn check(tree: &BspTree, camera: &Camera, score: &mut Score) -> Result<(), String> {
    checked(tree, camera, score).map(|_| ())
}

/// Runs the same check, and checks that every polygon of the map is the first hit of a ray through its point.
pub fn check_with_rays(tree: &BspTree, camera: &Camera, score: &mut Score) -> Result<(), String> {
    check_rays(&checked(tree, camera, score)?, tree, camera, score)
}

/// Runs the check, and returns the map.
fn checked<'t>(
    tree: &'t BspTree,
    camera: &Camera,
    score: &mut Score,
) -> Result<VisibilityMap<'t>, String> {
    let rays = Rays::new(camera, tree.faces()).map_err(|error| error.to_string())?;
    if tree.len() < SMALL {
        let fronts = ViewOptions::DEFAULT.with_front_faces_only();
        let rays = rays.clone().with_front_faces_only();
        check_view(tree, camera, &rays, &fronts, &mut Score::default())?;
    }
    check_view(tree, camera, &rays, &ViewOptions::DEFAULT, score)
}

/// Trees with fewer fragments are also judged with front faces only.
const SMALL: usize = 100;

fn check_view<'t>(
    tree: &'t BspTree,
    camera: &Camera,
    rays: &Rays,
    options: &ViewOptions<'static>,
    score: &mut Score,
) -> Result<VisibilityMap<'t>, String> {
    let truth = paint_tree(tree, camera.viewpoint(), rays);
    let map = tree.visibility(camera, options).expect("memory");
    let drawing = map.drawing().expect("memory");
    let shown: Vec<usize> = map.polygons().map(|shown| shown.polygon).collect();
    let mut drawn: Vec<usize> = drawing.paths().map(|path| path.polygon()).collect();
    drawn.sort_unstable();
    if drawn != shown {
        return Err(format!("shown {shown:?}, drawn {drawn:?}"));
    }
    if let Some(path) = drawing.paths().find(|path| path.outlines().next().is_none()) {
        return Err(format!("nothing is drawn of {}", path.polygon()));
    }
    let mut by_cells = Picture::new(map.size());
    for cell in map.cells() {
        let corners: Vec<[f64; 2]> = cell.corners().collect();
        by_cells.fill(cell.polygon(), std::iter::once(&corners[..]));
    }
    // Outlines do not contain parts thinner than this.
    let is_unsure: Vec<bool> = by_cells.pixels.iter().map(|p| *p == Pixel::Unsure).collect();
    for (what, picture) in [("drawing", Picture::of(&drawing)), ("map", by_cells)] {
        for (i, (&found, &face)) in picture.pixels.iter().zip(truth.faces()).enumerate() {
            let expected = match face {
                u32::MAX => Pixel::Nothing,
                face => Pixel::Polygon(tree.faces().polygon(face)),
            };
            if found == Pixel::Unsure || is_unsure[i] {
                score.unsure += 1;
                continue;
            }
            score.pixels += 1;
            let [x, y] = [i % picture.size[0], i / picture.size[0]];
            if found != expected {
                return Err(format!("{what}: {found:?} at ({x}, {y}), not {expected:?}"));
            }
            if what == "map" && picture.layers[i] > 1 {
                return Err(format!("cells overlap at ({x}, {y})"));
            }
        }
    }
    score.pictures += 1;
    score.paths += drawn.len();
    score.clipped += drawing.paths().filter(|path| path.is_clipped()).count();
    Ok(map)
}

fn check_rays(
    map: &VisibilityMap<'_>,
    tree: &BspTree,
    camera: &Camera,
    score: &mut Score,
) -> Result<(), String> {
    for shown in map.polygons().filter(|shown| shown.area > 0.1) {
        score.rays += 1;
        // No polygon is seen edge-on. For polygons of one plane, the order decides.
        let mut hits = tree
            .hits(ray(camera, shown.point))
            .filter(|hit| hit.facing() != Facing::EdgeOn && hit.parameter() > 0.0);
        let first = hits.next();
        let is_first = |hit: &Hit<'_>| first.is_some_and(|first| first.compare(hit).is_eq());
        let mut nearest = first.into_iter().chain(hits.take_while(is_first));
        if !nearest.any(|hit| hit.polygon() == shown.polygon) {
            return Err(format!("{shown:?}, but a ray hits {first:?}"));
        }
    }
    Ok(())
}

/// Returns the ray through a point of the picture of a camera with square pixels that looks at its middle.
pub fn ray(camera: &Camera, [x, y]: [f64; 2]) -> binspace::Ray {
    let ([width, height], [_, pixel]) = (camera.size().map(f64::from), camera.pixel_size());
    let across = camera.right() * ((x - 0.5 * width) * pixel);
    let down = camera.up() * ((y - 0.5 * height) * -pixel);
    match camera.viewpoint() {
        Viewpoint::Eye(eye) => binspace::Ray::new(eye, camera.forward() + across + down),
        Viewpoint::Direction(direction) => {
            let binspace::view::Projection::Parallel { centre, .. } = *camera.projection() else {
                unreachable!("a direction of view is parallel")
            };
            let reach = 1e4 * pixel * height.max(width);
            let start = centre + across + down - camera.forward() * reach;
            binspace::Ray::new(start, direction)
        }
    }
}
