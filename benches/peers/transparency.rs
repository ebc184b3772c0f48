//! Translucent polygons by the methods of engines: whole polygons sorted by their centroids, weighted blended
//! order-independent transparency, and depth peeling that stops after some passes. All of them blend on the
//! processor, and each picture is compared with all layers of each pixel, sorted exactly.

use binspace::BuildOptions;
use binspace::raster::{Rays, colour_of};
use binspace::view::Camera;
use binspace_evidence::layers::Layers;
use binspace_evidence::method::centroid_order;
use binspace_evidence::translucent::{
    Colour, Look, Weight, by_layers, by_list, by_nearest_layers, by_tree, by_weights,
};
use support::{Table, check, scene, up};

const SCENES: [&str; 11] = [
    "crossing:12",
    "layers:12",
    "random:200",
    "city:2000",
    "terrain:5000",
    "sphere:5000",
    "bunny.obj",
    "spider.obj",
    "person.obj",
    "engine.obj",
    "level.obj",
];
const SIZE: [u32; 2] = [320, 240];
const PASSES: [usize; 2] = [4, 8];
const BACKGROUND: Colour = [1.0; 3];

pub(crate) fn run() {
    let table = Table::new(
        "Transparency",
        &[
            "scene",
            "pixels",
            "most layers",
            "tree wrong",
            "centroids wrong",
            "weighted wrong",
            "4 passes wrong",
            "8 passes wrong",
            "tree error",
            "centroids error",
            "weighted error",
            "4 passes error",
            "8 passes error",
        ],
    );
    for name in SCENES {
        let scene = scene(name);
        let options = BuildOptions::DEFAULT.with_tolerance(0.0);
        let tree = options.build(scene.polygons()).expect("within budget");
        check(&tree, &scene);
        let (low, high) = scene.bounds().expect("polygons");
        let camera = Camera::looking_at_all([low, high], up(name), SIZE).expect("a camera");
        let faces = tree.faces();
        let rays = Rays::new(&camera, faces).expect("a picture");
        let layers = Layers::new(&rays, faces);
        let truth = by_layers(faces, &layers, look, BACKGROUND);
        // Every method is right in pixels with fewer layers.
        let judged: Vec<bool> = layers.pixels().map(|layers| layers.len() > 1).collect();
        let error = |picture: Vec<Colour>| Error::of(&picture, &truth, &judged);

        let ours = error(by_tree(&tree, &rays, look, BACKGROUND));
        assert_eq!(ours.wrong, 0.0, "{name}");
        let order = centroid_order(faces, &camera);
        let sorted = error(by_list(faces, order, &rays, look, BACKGROUND));
        let weighted = Weight::ALL
            .map(|weight| error(by_weights(faces, &layers, &camera, weight, look, BACKGROUND)))
            .into_iter()
            .min_by(|a, b| a.mean.total_cmp(&b.mean))
            .expect("some weights");
        let [few, more] =
            PASSES.map(|passes| error(by_nearest_layers(faces, &layers, passes, look, BACKGROUND)));
        let errors = [ours, sorted, weighted, few, more];
        let pixels = judged.iter().filter(|&&is| is).count();
        let mut row = vec![name.to_owned(), pixels.to_string(), layers.deepest().to_string()];
        row.extend(errors.iter().map(|error| format!("{:.1} %", 100.0 * error.wrong)));
        row.extend(errors.iter().map(|error| format!("{:.1}", error.mean)));
        table.row(&row);
    }
}

/// An opacity of a quarter, in the polygon's colour.
fn look(polygon: usize) -> Look {
    Look { colour: colour_of(polygon).map(|c| f32::from(c) / 255.0), opacity: 0.25 }
}

/// The differences from the true picture in the judged pixels.
struct Error {
    /// The share of pixels in which a channel differs by more than 1/255.
    wrong: f64,
    /// The mean difference of a channel, in units of 1/255.
    mean: f64,
}

impl Error {
    fn of(picture: &[Colour], truth: &[Colour], judged: &[bool]) -> Self {
        let (mut pixels, mut wrong, mut sum) = (0, 0, 0.0);
        for ((found, truth), _) in picture.iter().zip(truth).zip(judged).filter(|pair| *pair.1) {
            let off = [0, 1, 2].map(|i| 255.0 * f64::from((found[i] - truth[i]).abs()));
            pixels += 1;
            wrong += usize::from(off.iter().any(|&off| off > 1.0));
            sum += off.iter().sum::<f64>() / 3.0;
        }
        Self { wrong: wrong as f64 / f64::from(pixels), mean: sum / f64::from(pixels) }
    }
}
