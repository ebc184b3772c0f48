//! Translucent surfaces.

use binspace::glam::dvec3;
use binspace::raster::{Rays, colour_of};
use binspace::scene::{self, Scene};
use binspace::view::{Camera, views};
use binspace::{BspTree, BuildOptions};
use binspace_evidence::layers::Layers;
use binspace_evidence::method::centroid_order;
use binspace_evidence::translucent::{Colour, Look, by_layers, by_list, by_tree, differences, rgb};

use super::chapter::{Chapter, Picture, percent};
use binspace_cli::failure::Failure;

const SIZE: [u32; 2] = [320, 240];
const PAPER: Colour = [1.0; 3];
/// The number of views of each scene in the table.
const VIEWS: usize = 6;

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.text(
        "A translucent surface lets some light through. The new colour of a pixel is the old colour \
         times 1 − α, plus the colour of the surface times α (\"over\": Porter & Duff, Compositing \
         Digital Images, 1984). This operation does not commute. So it is not enough to know the nearest \
         surface: all surfaces are needed, from back to front. A depth buffer stores only one depth and \
         cannot give this order. The order of a tree is right in every pixel at once, because planes \
         separate the pieces.",
    );
    chapter.text(
        "The judge shares no code with the tree. In each pixel, the judge intersects the ray with \
         the planes of all polygons that cover the pixel, and gets fractions of large integers. The \
         judge sorts these fractions, and blends the colours in this order with the same operations \
         as the painters. Two pictures are equal only if every bit of every channel is equal. Most \
         programs sort by centroids; the judge compares this order in the same way.",
    );
    let mut rows = Vec::new();
    let scenes = [scene::random_triangles(200, 3), scene::crossing(9), scene::newell_bars()];
    for (k, scene) in scenes.iter().enumerate() {
        let tree = tree_of(scene)?;
        let Some((low, high)) = scene.bounds() else { continue };
        let all = views([low, high], scene.up(), VIEWS, SIZE, 3)
            .map_err(|error| Failure::about("a view", error))?;
        let mut sums = Sums::default();
        for camera in &all {
            sums.add(&blend(&tree, camera)?);
        }
        if k == 0 {
            pictures(chapter, &blend(&tree, &all[1])?);
        }
        rows.push(sums.row(scene, &tree));
    }
    chapter.table(
        [
            "scene",
            "fragments",
            "pixels with two or more layers",
            "most layers in a pixel",
            "wrong in the tree's order",
            "wrong by centroids",
            "share",
        ],
        rows,
    );
    chapter.text(format!(
        "The figures are sums over {VIEWS} views of each scene, {} by {} pixels. In the tree's order, the \
         colours are exactly those of the judge, bit for bit. Centroids are wrong where polygons cross, and \
         also where a long polygon passes a short one. If polygons cross, or hide one another in a cycle, no \
         order of whole polygons is right.",
        SIZE[0], SIZE[1],
    ));
    glass(chapter)
}

/// Three panes that cross: the smallest scene that no order of whole polygons paints.
fn glass(chapter: &mut Chapter) -> Result<(), Failure> {
    let mut panes = Scene::new("panes", dvec3(0.0, 0.0, 1.0));
    for (a, b) in
        [((-1.0, 0.0), (1.0, 0.2)), ((-0.5, -0.9), (0.6, 0.8)), ((0.5, -0.9), (-0.4, 0.9))]
    {
        let at = |(x, y): (f64, f64), z: f64| dvec3(x, y, z);
        panes.push([at(a, -0.6), at(b, -0.6), at(b, 0.6), at(a, 0.6)], 0);
    }
    let tree = tree_of(&panes)?;
    let eye = dvec3(-3.0, -1.4, 1.3);
    let camera = Camera::perspective(eye, dvec3(0.0, 0.0, 0.0), dvec3(0.0, 0.0, 1.0), 0.6, SIZE)
        .map_err(|error| Failure::about("a view", error))?;
    let found = blend(&tree, &camera)?;
    chapter.heading("Panes that cross");
    chapter.text(format!(
        "Each of three panes crosses both others. The tree splits them into {} pieces. Of {} pixels with \
         two or more layers, the order by centroids blends {} wrongly ({}); the tree blends {} wrongly.",
        tree.len(),
        found.deep,
        found.centroid_wrong,
        percent(found.centroid_wrong as f64, found.deep as f64),
        found.tree_wrong,
    ));
    pictures(chapter, &found);
    Ok(())
}

fn tree_of(scene: &Scene) -> Result<BspTree, Failure> {
    let options = BuildOptions::DEFAULT.with_tolerance(0.0);
    options.build(scene.polygons()).map_err(|error| Failure::about("a tree", error))
}

fn look(polygon: usize) -> Look {
    Look { colour: colour_of(polygon).map(|c| f32::from(c) / 255.0), opacity: 0.5 }
}

/// One view, blended in each order, with its errors.
struct Blended {
    by_tree: Vec<Colour>,
    by_centroid: Vec<Colour>,
    truth: Vec<Colour>,
    /// The number of pixels of two layers or more.
    deep: usize,
    deepest: usize,
    tree_wrong: usize,
    centroid_wrong: usize,
}

fn blend(tree: &BspTree, camera: &Camera) -> Result<Blended, Failure> {
    let faces = tree.faces();
    let rays = Rays::new(camera, faces).map_err(|error| Failure::about("a view", error))?;
    let layers = Layers::new(&rays, faces);
    let truth = by_layers(faces, &layers, look, PAPER);
    let by_tree = by_tree(tree, &rays, look, PAPER);
    let by_centroid = by_list(faces, centroid_order(faces, camera), &rays, look, PAPER);
    Ok(Blended {
        tree_wrong: differences(&by_tree, &truth),
        centroid_wrong: differences(&by_centroid, &truth),
        deep: layers.pixels().filter(|layers| layers.len() > 1).count(),
        deepest: layers.deepest(),
        by_tree,
        by_centroid,
        truth,
    })
}

fn pictures(chapter: &mut Chapter, found: &Blended) {
    let pairs = found.by_centroid.iter().zip(&found.truth);
    let marked: Vec<Colour> = pairs
        .map(|(a, b)| if a == b { b.map(|c| 0.6 + 0.4 * c) } else { [0.85, 0.1, 0.1] })
        .collect();
    chapter.pictures([
        Picture::new(SIZE, rgb(&found.by_tree), format!("By the tree: {} wrong", found.tree_wrong)),
        Picture::new(
            SIZE,
            rgb(&found.by_centroid),
            format!("By centroids: {} wrong", found.centroid_wrong),
        ),
        Picture::new(SIZE, rgb(&marked), "Red: wrong by centroids"),
    ]);
}

/// The sums of figures over several views.
#[derive(Default)]
struct Sums {
    deep: usize,
    deepest: usize,
    tree_wrong: usize,
    centroid_wrong: usize,
}

impl Sums {
    fn add(&mut self, found: &Blended) {
        self.deep += found.deep;
        self.deepest = self.deepest.max(found.deepest);
        self.tree_wrong += found.tree_wrong;
        self.centroid_wrong += found.centroid_wrong;
    }

    fn row(&self, scene: &Scene, tree: &BspTree) -> [String; 7] {
        [
            scene.name().to_owned(),
            tree.len().to_string(),
            self.deep.to_string(),
            self.deepest.to_string(),
            self.tree_wrong.to_string(),
            self.centroid_wrong.to_string(),
            percent(self.centroid_wrong as f64, self.deep as f64).to_string(),
        ]
    }
}
