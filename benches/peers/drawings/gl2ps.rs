//! `gl2ps`: triangles drawn by OpenGL as a vector picture, by a driver in C that is compiled here.
//!
//! `gl2ps` sorts by its own tree (`bsp`) or by depths (`simple`). It uses `f32`, and its SVG files have six
//! digits for each coordinate. So the pixels of `gl2ps` are judged twice. The first count covers all pixels
//! except those with one of its outlines within 4·10⁻⁵ of a pixel. The second count covers only pixels whose
//! eight neighbours all show the same polygon. Its time is the time of a page, from the beginning of the page
//! to the SVG file. Our time is the time of the tree, the map, the paths and the SVG file. Both are the
//! running times of one thread.

use super::fill::{Picture, Pixel};
use super::{SIZE, camera, cpu_time, drawn};
use binspace::drawing::{Paint, VectorPicture};
use binspace::glam::DVec3;
use binspace::paint::paint_tree;
use binspace::raster::{Rays, Verdict, compare, zbuffer};
use binspace::scene::Scene;
use binspace::view::Camera;
use binspace::{BspTree, Viewpoint};
use std::fmt::Write as _;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, id};
use std::time::Duration;
use std::{env, io};
use support::{Table, check, ratio, scene, threads, time, triangulated};

const SCENES: [&str; 10] = [
    "triangles in cubes:1500",
    "triangles in cubes:5000",
    "random:1500",
    "terrain:5000",
    "sphere:2000",
    "city:2000",
    "bunny.obj",
    "spider.obj",
    "person.obj",
    "level.obj",
];

pub(crate) fn run() {
    let driver = match Driver::compile() {
        Ok(driver) => driver,
        Err(fault) => {
            eprintln!("left out: SVG of a mesh ({fault})");
            return;
        }
    };
    let table = Table::new(
        "SVG of a mesh",
        &[
            "scene",
            "triangles",
            "our paths",
            "our time",
            "our wrong",
            "gl2ps sorts by",
            "its paths",
            "its time",
            "its time ÷ ours",
            "pixels",
            "its wrong",
            "pixels off edges",
            "its wrong off edges",
        ],
    );
    let one_thread = threads(1);
    for name in SCENES {
        let scene = triangulated(&scene(name));
        let camera = camera(&scene, name);
        let file = driver.folder.join("ours.svg");
        let ours = one_thread.install(|| Ours::new(&scene, &camera, &file));
        for sort in ["bsp", "simple"] {
            let theirs = driver.draw(&scene, &camera, sort).expect("a picture by gl2ps");
            let mut row = vec![name.to_owned(), scene.len().to_string()];
            row.extend(ours.against(sort, &theirs));
            table.row(&row);
        }
    }
}

/// Our drawing, which is right.
struct Ours {
    time: Duration,
    paths: usize,
    truth: Truth,
}

impl Ours {
    fn new(scene: &Scene, camera: &Camera, file: &Path) -> Self {
        let (time, (tree, drawing)) = cpu_time(|| {
            let tree = BspTree::build(scene.polygons()).expect("within budget");
            let drawing = drawn(&tree, camera);
            let mut picture = VectorPicture::new(SIZE);
            picture.add_drawing(&drawing, |number| Paint::from(colour(number)));
            fs::write(file, picture.to_svg()).expect("a file");
            (tree, drawing)
        });
        check(&tree, scene);
        let truth = Truth::new(&tree, camera);
        assert_eq!(truth.judge(&Picture::of(&drawing)).wrong, 0, "{}", scene.name());
        Self { time, paths: drawing.paths().len(), truth }
    }

    /// The figures of a row from `our paths` on.
    fn against(&self, sort: &str, theirs: &Theirs) -> [String; 11] {
        let judged = self.truth.judge(&theirs.picture());
        let paths = theirs.filled.len();
        [
            self.paths.to_string(),
            time(self.time),
            "0".to_owned(),
            sort.to_owned(),
            paths.to_string(),
            time(theirs.time),
            ratio(theirs.time, self.time),
            judged.pixels.to_string(),
            judged.wrong.to_string(),
            judged.off_edges.to_string(),
            judged.wrong_off_edges.to_string(),
        ]
    }
}

/// The approximate colour that the driver gives a triangle.
fn colour(number: usize) -> [u8; 3] {
    [14, 7, 0].map(|from| (number >> from & 127) as u8 * 2)
}

/// A picture by gl2ps.
struct Theirs {
    /// The time that `gl2ps` takes for a page.
    time: Duration,
    /// The filled triangles, in paint order.
    filled: Vec<Filled>,
}

impl Theirs {
    fn picture(&self) -> Picture {
        let mut picture = Picture::new(SIZE);
        for (number, corners) in &self.filled {
            picture.fill(*number, std::iter::once(&corners[..]));
        }
        picture
    }
}

/// A filled triangle: the number of its polygon, and corners in pixels.
type Filled = (usize, Vec<[f64; 2]>);

/// The compiled driver, in its own folder.
struct Driver {
    folder: PathBuf,
}

impl Driver {
    fn compile() -> Result<Self, String> {
        let folder = env::temp_dir().join(format!("binspace-gl2ps-{}", id()));
        fs::create_dir(&folder).map_err(|error| format!("no folder to compile in: {error}"))?;
        let driver = Self { folder };
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("gl2ps/driver.c");
        let answer = Command::new("cc")
            .args(["-O2", "-o"])
            .args([driver.program(), source])
            .args(["-lgl2ps", "-lOSMesa"])
            .output()
            .map_err(|error| format!("no compiler: {error}"))?;
        match answer.status.success() {
            true => Ok(driver),
            false => {
                Err("its driver does not compile; it needs libgl2ps-dev and libosmesa6-dev".into())
            }
        }
    }

    fn program(&self) -> PathBuf {
        self.folder.join("driver")
    }

    /// The driver's drawing, by one of the two ways to sort.
    fn draw(&self, scene: &Scene, camera: &Camera, sort: &str) -> io::Result<Theirs> {
        let [input, output] = ["triangles", "drawing.svg"].map(|name| self.folder.join(name));
        fs::write(&input, seen(scene, camera))?;
        let mut driver = Command::new(self.program());
        let answer = driver.arg(sort).arg(&output).stdin(File::open(&input)?).output()?;
        let said = String::from_utf8_lossy(&answer.stdout);
        let fault = || io::Error::other(format!("{}: {said}", answer.status));
        let seconds = said.trim().parse().ok().filter(|_| answer.status.success());
        let time = Duration::from_secs_f64(seconds.ok_or_else(fault)?);
        let file = fs::read_to_string(&output)?;
        let polygons = file.lines().filter(|line| line.starts_with("<poly"));
        let filled: Option<Vec<Filled>> = polygons.map(filled_of).collect();
        let filled = filled.filter(|all| all.iter().all(|&(number, _)| number < scene.len()));
        Ok(Theirs { time, filled: filled.ok_or_else(fault)? })
    }
}

impl Drop for Driver {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// The driver's input: the picture's size, the view volume, and triangles as the camera sees them.
fn seen(scene: &Scene, camera: &Camera) -> String {
    let Viewpoint::Eye(eye) = camera.viewpoint() else { panic!("a perspective camera") };
    let corner = |p: &DVec3| {
        let arm = p - eye;
        [camera.right(), camera.up(), -camera.forward()].map(|axis| arm.dot(axis))
    };
    let corners: Vec<[f64; 3]> =
        (0..scene.len()).flat_map(|index| scene.polygon(index)).map(corner).collect();
    let depths = corners.iter().map(|p| -p[2]);
    let (near, far) =
        (0.9 * depths.clone().fold(f64::MAX, f64::min), 1.1 * depths.fold(0.0, f64::max));
    assert!(near > 0.0, "{}: the eye is outside", scene.name());
    let [width, height] = SIZE.map(|side| 0.5 * f64::from(side) * camera.pixel_size()[1] * near);
    let mut text = format!("{} {}\n{} {width} {} {height}", SIZE[0], SIZE[1], -width, -height);
    let _ = writeln!(text, " {near} {far}");
    for [x, y, z] in corners {
        let _ = writeln!(text, "{x} {y} {z}");
    }
    text
}

/// A polygon of the file. The upper seven bits of each byte of its fill colour are the number of the
/// triangle.
fn filled_of(line: &str) -> Option<Filled> {
    let fill = usize::from_str_radix(line.split_once("fill=\"#")?.1.get(..6)?, 16).ok()?;
    let bits = |from: usize| (fill >> (from + 1)) & 127;
    let number = (bits(16) << 14) | (bits(8) << 7) | bits(0);
    let points = line.split_once("points=\"")?.1.split('"').next()?;
    let corner = |point: &str| -> Option<[f64; 2]> {
        let (x, y) = point.split_once(',')?;
        Some([x.parse::<f64>().ok()?, y.parse::<f64>().ok()?])
    };
    let corners: Option<Vec<_>> = points.split_whitespace().map(corner).collect();
    Some((number, corners?))
}

/// The visible polygon of each pixel, where a depth buffer and the tree's order agree. The two are
/// independent of each other.
struct Truth {
    pixels: Vec<Option<Pixel>>,
}

#[derive(Default)]
struct Judged {
    pixels: usize,
    wrong: usize,
    off_edges: usize,
    wrong_off_edges: usize,
}

impl Truth {
    fn new(tree: &BspTree, camera: &Camera) -> Self {
        let rays = Rays::new(camera, tree.faces()).expect("a picture");
        let painted = paint_tree(tree, camera.viewpoint(), &rays);
        let nearest = zbuffer(&rays, tree.faces()).into_image();
        let compared = compare(&rays, tree.faces(), &painted, &nearest);
        assert_eq!(compared.wrong(), 0);
        let pixel = |(&face, verdict): (&u32, &Verdict)| match verdict {
            Verdict::Empty => Some(Pixel::Nothing),
            Verdict::Right => Some(Pixel::Polygon(tree.faces().polygon(face))),
            _ => None,
        };
        Self { pixels: nearest.faces().iter().zip(&compared.verdicts).map(pixel).collect() }
    }

    fn judge(&self, picture: &Picture) -> Judged {
        let mut judged = Judged::default();
        for (i, (&found, truth)) in picture.pixels.iter().zip(&self.pixels).enumerate() {
            let Some(truth) = truth.filter(|_| found != Pixel::Unsure) else { continue };
            let is_wrong = found != truth;
            judged.pixels += 1;
            judged.wrong += usize::from(is_wrong);
            if self.is_off_edges(i) {
                judged.off_edges += 1;
                judged.wrong_off_edges += usize::from(is_wrong);
            }
        }
        judged
    }

    /// Whether the neighbours of a pixel within the picture show the same polygon as the pixel.
    fn is_off_edges(&self, i: usize) -> bool {
        let [width, height] = SIZE.map(|side| side as usize);
        let [x, y] = [i % width, i / width];
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let columns = x.saturating_sub(1)..(x + 2).min(width);
        rows.flat_map(|y| columns.clone().map(move |x| y * width + x))
            .all(|k| self.pixels[k] == self.pixels[i])
    }
}
