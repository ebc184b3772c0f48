//! Overdraw: pixels that are painted more than once.

use binspace::BspTree;
use binspace::glam::{DVec3, dvec3};
use binspace::internals::SplitMix64;
use binspace::raster::Rays;
use binspace::scene;
use binspace::view::{Camera, views};
use binspace_evidence::layers::Layers;
use binspace_evidence::method::centroid_order;
use binspace_evidence::overdraw::{Overdraw, depth_buffer, front_to_back, heat, painter};

use crate::chart::{Chart, Marker, Series, Style};
use crate::lecture::chapter::{Chapter, Picture};
use binspace_cli::failure::Failure;

const SIZE: [u32; 2] = [320, 240];
/// The number of random orders in the graph.
const SHUFFLES: u32 = 2000;

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.heading("Overdraw");
    chapter.text(
        "Overdraw is the number of written pixels divided by the number of visible pixels. A painter \
         writes each pixel once for every surface in it. A depth buffer writes a pixel whenever a \
         surface is nearer than all earlier ones, so its overdraw depends on the order of the \
         polygons. For n layers, the overdraw of a depth buffer is n from back to front and 1 from \
         front to back. In random order, this overdraw is 1 + 1/2 + … + 1/n on average. A tree that is \
         walked from front to back, with a mask of covered pixels, writes each pixel once. Such a walk \
         skips subtrees that the mask hides completely.",
    );
    let city = scene::city(1500, 1);
    let random = scene::random_triangles(300, 1);
    let failure = |error| Failure::about("a view", error);
    let (eye, target) = ((-40.0, 20.0, 30.0), (260.0, 250.0, 20.0));
    let low_view = Camera::perspective(eye.into(), target.into(), city.up(), 0.9, SIZE);
    let Some((low, high)) = random.bounds() else { return Ok(()) };
    let random_view = views([low, high], random.up(), 1, SIZE, 4).map_err(failure)?;
    let scenes = [(&city, low_view.map_err(failure)?), (&random, random_view[0])];
    let mut rows = Vec::new();
    for (k, (scene, camera)) in scenes.into_iter().enumerate() {
        let tree =
            BspTree::build(scene.polygons()).map_err(|error| Failure::about("a tree", error))?;
        let ways = ways(&tree, &camera)?;
        rows.extend(ways.iter().map(|(name, found)| row(scene.name(), name, found)));
        if k == 0 {
            let most = ways[0].1.written.iter().copied().max().unwrap_or(1);
            chapter.pictures([0, 3, 1].map(|way| {
                let (name, found) = &ways[way];
                let rgb = heat(&found.written, most);
                Picture::new(SIZE, rgb, format!("{name}: blue is one write, red is {most}"))
            }));
        }
    }
    chapter.table(["scene", "way", "pixels tested", "pixels written", "shown", "overdraw"], rows);
    stack(chapter)
}

/// The growth of overdraw with the layers per pixel.
fn stack(chapter: &mut Chapter) -> Result<(), Failure> {
    let [mut painted, mut buffered, mut masked] = [vec![], vec![], vec![]];
    for layers in [1, 2, 5, 10, 20, 50, 100] {
        let found = overdraw_of_stack(layers)?;
        for (points, overdraw) in [&mut painted, &mut buffered, &mut masked].into_iter().zip(found)
        {
            points.push((f64::from(layers), overdraw));
        }
    }
    let last = |points: &[(f64, f64)]| points.last().map_or(0.0, |point| point.1);
    chapter.text(format!(
        "The next graph shows the overdraw of a stack of squares. The depth buffer gets the squares in \
         {SHUFFLES} random orders. With 100 layers, it writes each pixel {:.2} times on average (1 + 1/2 + … \
         + 1/100 = 5.19), and the painter writes it {} times.",
        last(&buffered),
        last(&painted),
    ));
    let series = [
        Series::new("painter", Style::new([200, 60, 50], Marker::Circle, 5), painted),
        Series::new("depth buffer", Style::new([50, 110, 200], Marker::Square, 5), buffered),
        Series::new("mask", Style::new([50, 150, 80], Marker::Triangle, 5), masked),
    ];
    chapter.graph(&Chart {
        title: "Overdraw",
        x_label: "layers per pixel",
        y_label: "writes per pixel",
        ticks: None,
        falls: false,
        zero: false,
        series: series.into(),
    })
}

/// Returns the overdraw of a stack of squares: for a painter, for a depth buffer (the mean over random
/// orders), and for a mask.
fn overdraw_of_stack(layers: u32) -> Result<[f64; 3], Failure> {
    let failure = |error| Failure::about("a view", error);
    let square = |z: f64| [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| [x, y, z]);
    let tree = BspTree::build((0..layers).map(|layer| square(f64::from(layer))))
        .map_err(|error| Failure::about("a tree", error))?;
    let middle = dvec3(0.5, 0.5, 0.0);
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, middle, 1.5, [4, 4]).map_err(failure)?;
    let faces = tree.faces();
    let rays = Rays::new(&camera, faces).map_err(failure)?;
    let sorted = Layers::new(&rays, faces);
    let overdraw = |found: Overdraw| found.sums()[1] as f64 / found.shown() as f64;
    let mut random = SplitMix64::new(u64::from(layers));
    let mut shuffled = || {
        let mut order: Vec<(u64, u32)> = (0..layers).map(|face| (random.next(), face)).collect();
        order.sort_unstable();
        overdraw(depth_buffer(faces, &rays, &sorted, order.into_iter().map(|(_, face)| face)))
    };
    let buffered = (0..SHUFFLES).map(|_| shuffled()).sum::<f64>() / f64::from(SHUFFLES);
    let once = front_to_back(&tree, &rays).map_err(|error| Failure::about("a mask", error))?;
    Ok([overdraw(painter(&tree, &rays)), buffered, overdraw(once)])
}

/// The ways to fill a picture, each with its work.
fn ways(tree: &BspTree, camera: &Camera) -> Result<[(&'static str, Overdraw); 5], Failure> {
    let faces = tree.faces();
    let rays = Rays::new(camera, faces).map_err(|error| Failure::about("a view", error))?;
    let layers = Layers::new(&rays, faces);
    let far_first = centroid_order(faces, camera);
    let near_first = far_first.iter().rev().copied();
    let once = front_to_back(tree, &rays).map_err(|error| Failure::about("a mask", error))?;
    Ok([
        ("painter", painter(tree, &rays)),
        ("front to back with a mask", once),
        ("depth buffer, nearest centroid first", depth_buffer(faces, &rays, &layers, near_first)),
        ("depth buffer, input order", depth_buffer(faces, &rays, &layers, 0..faces.len() as u32)),
        (
            "depth buffer, furthest centroid first",
            depth_buffer(faces, &rays, &layers, far_first.iter().copied()),
        ),
    ])
}

fn row(scene: &str, way: &str, found: &Overdraw) -> [String; 6] {
    let ([tested, written], shown) = (found.sums(), found.shown());
    let overdraw = format!("{:.2}", written as f64 / shown.max(1) as f64);
    let [tested, written, shown] = [tested, written, shown].map(|count| count.to_string());
    [scene.to_owned(), way.to_owned(), tested, written, shown, overdraw]
}
