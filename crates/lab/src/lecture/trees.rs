//! Trees: an example worked by hand, a grid of pixels, and the worst cases.

use binspace::glam::DVec3;
use binspace::paint::paint_order;
use binspace::scene::{Builtin, Material, Scene};
use binspace::{BuildOptions, Heuristic};
use binspace_evidence::method::{Bsp, Centroid};
use binspace_evidence::{
    EIGHT_ORDER, GRID_OF_SIX, Worst, eight, eye_on_eight, letters, noisy_sphere, six_by_six,
    six_by_six_camera,
};

use super::chapter::{Chapter, Part};
use super::plan;
use super::shot::{SIZE, Shot};
use crate::chart::{Chart, Marker, Series, Style};
use binspace_cli::failure::Failure;

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.text(
        "The method of H. Fuchs, Z. M. Kedem and B. F. Naylor (\"On visible surface generation by a \
         priori tree structures\", 1980) prepares the order before any view is known. The plane of a \
         polygon divides space in two. No polygon on the eye's side of the plane is hidden by a polygon \
         on the far side. So, for any eye, paint the polygons on the far side first, then the polygons \
         in the plane, then the polygons on the eye's side. Each side is divided again in the same way. \
         A polygon that crosses a plane is split into two pieces.",
    );
    eight_walls(chapter)?;
    grid(chapter)?;
    worst(chapter)
}

fn eight_walls(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.heading("Eight polygons, A to H");
    let options = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
    let tree = options.build(eight().map(|(_, wall)| wall));
    let tree = tree.map_err(|error| Failure::about("eight walls", error))?;
    let camera = eye_on_eight(SIZE).map_err(|error| Failure::about("eight walls", error))?;
    let order: Vec<u32> = tree.back_to_front(camera.viewpoint()).map(|f| f.index()).collect();
    let found = letters(&tree, &order);
    chapter.text(format!(
        "Eight walls are seen from above. Their planes are taken in alphabetical order. The line of A \
         divides all other walls: C, F and G are beyond it; B, D, E and H are on the eye's side. The \
         line of B splits D. Worked by hand, the order for this eye is {EIGHT_ORDER}; the library's tree \
         of {} pieces gives {found}.",
        tree.len(),
    ));
    chapter.parts.push(Part::Graph(plan::of_eight()));
    let scene = coloured("eight walls", eight().map(|(_, wall)| wall.to_vec()));
    let shot = Shot::new(&scene, Ok(camera))?;
    let after = |count: usize| {
        let painted = letters(&tree, &order[..count]);
        shot.image(&paint_order(&tree, &order[..count], &shot.rays), format!("After {painted}"))
    };
    chapter.pictures([4, 6, order.len()].map(after));
    let all = shot.paint(&Bsp::exact(options))?;
    chapter.text(format!(
        "Of {} pixels that show a wall, {} are wrong.",
        all.error.covered,
        all.error.wrong()
    ));
    Ok(())
}

/// A scene of polygons in distinguishable colours.
fn coloured(name: &str, polygons: impl IntoIterator<Item = Vec<DVec3>>) -> Scene {
    let mut scene = Scene::new(name, DVec3::Z);
    let materials: Vec<u32> = Material::palette().map(|m| scene.add_material(m)).collect();
    for (polygon, material) in polygons.into_iter().zip(materials) {
        scene.push(polygon, material);
    }
    scene
}

fn grid(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.heading("A grid of six by six");
    chapter.text(
        "Two triangles cover six by six pixels. All depths are whole numbers. A has depth 5 everywhere. \
         B has depth 2 in the first column, and its depth grows by 2 in each further column. B passes \
         through A between the second and the third column, so no order of the two triangles is right. \
         The depth buffer keeps the smaller number. The tree splits one triangle by the plane of the \
         other. Worked by hand:",
    );
    let head = ["row", "depths of B", "visible depths", "visible triangles"];
    // Pads figures to two digits, so that columns align.
    let wide = |cells: &str| {
        cells.split(' ').map(|cell| format!("{cell:\u{2007}>2}")).collect::<Vec<_>>().join("\u{a0}")
    };
    let rows = (0..).zip(GRID_OF_SIX).map(|(row, [second, shown, names]): (u32, _)| {
        [row.to_string(), wide(second), wide(shown), names.to_owned()]
    });
    chapter.table(head, rows);
    let scene = coloured("grid", six_by_six().map(|triangle| triangle.to_vec()));
    let small = Shot::new(&scene, six_by_six_camera())?;
    let by_hand = GRID_OF_SIX.iter().flat_map(|[.., names]| names.split(' '));
    let agree = |(face, name): &(&u32, &str)| ["A", "B"].get(**face as usize) == Some(name);
    let agreeing = small.truth.faces().iter().zip(by_hand).filter(agree).count();
    let by_tree = small.paint(&Bsp::exact(BuildOptions::DEFAULT))?;
    chapter.text(format!(
        "In this run, {agreeing} of the 36 pixels of the exact depth buffer agree with this table, and \
         the tree's picture has {} wrong pixels.",
        by_tree.error.wrong(),
    ));
    let fine = Shot::new(&scene, six_by_six_camera().and_then(|c| c.with_size([180, 180])))?;
    chapter.pictures([
        fine.by(&Bsp::exact(BuildOptions::DEFAULT), "By the tree, at a higher resolution")?,
        fine.by(&Centroid, "By centroids, at a higher resolution")?,
    ]);
    Ok(())
}

/// A family in the graph: its name and look, its sizes, and how it is built.
struct Line {
    name: &'static str,
    style: Style,
    scene: fn(u32) -> Scene,
    sizes: &'static [u32],
    heuristic: Heuristic,
}

const LINES: [Line; 9] = [
    Line {
        name: "sheets",
        style: Style::new([200, 30, 30], Marker::Square, 5),
        scene: |size| Worst::Sheets.scene(size),
        sizes: &[5, 10, 20, 40, 80],
        heuristic: Heuristic::Auto,
    },
    Line {
        name: "saddle",
        style: Style::new([230, 140, 0], Marker::Triangle, 5),
        scene: |size| Worst::Saddle.scene(size),
        sizes: &[10, 20, 40, 100, 200, 400],
        heuristic: Heuristic::Auto,
    },
    Line {
        name: "walls, own planes",
        style: Style::new([150, 80, 180], Marker::Diamond, 9),
        scene: |size| Worst::Walls.scene(size),
        sizes: &[10, 20, 40, 100, 200, 400, 1000],
        heuristic: Heuristic::First,
    },
    Line {
        name: "walls, any plane",
        style: Style::new([150, 80, 180], Marker::Ring, 8),
        scene: |size| Worst::Walls.scene(size),
        sizes: &[10, 20, 40, 100, 200, 400, 1000],
        heuristic: Heuristic::Auto,
    },
    Line {
        name: "random",
        style: Style::new([110, 110, 110], Marker::Cross, 5),
        scene: |size| Builtin::Random.build(Some(size), 1),
        sizes: &[10, 100, 1000, 3000],
        heuristic: Heuristic::Auto,
    },
    Line {
        name: "city",
        style: Style::new([30, 110, 220], Marker::Circle, 5),
        scene: |size| Builtin::City.build(Some(size), 1),
        sizes: &[100, 1000, 10_000],
        heuristic: Heuristic::Auto,
    },
    Line {
        name: "terrain",
        style: Style::new([0, 140, 90], Marker::Circle, 5),
        scene: |size| Builtin::Terrain.build(Some(size), 1),
        sizes: &[20, 200, 2000, 20_000],
        heuristic: Heuristic::Auto,
    },
    Line {
        name: "teapot",
        style: Style::new([90, 60, 30], Marker::Square, 4),
        scene: |size| Builtin::Teapot.build(Some(size), 1),
        sizes: &[2, 4, 8, 16],
        heuristic: Heuristic::Auto,
    },
    Line {
        name: "noisy sphere",
        style: Style::new([220, 90, 160], Marker::Triangle, 4),
        scene: |size| noisy_sphere(size, 1),
        sizes: &[100, 1000, 10_000],
        heuristic: Heuristic::Auto,
    },
];

fn worst(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.heading("How large a tree can be");
    chapter.text(
        "A plane splits every polygon that crosses it, so n polygons can become many more pieces. \
         Take n sheets that all cross one another, such that every three meet in a point and no four \
         do. These sheets divide space into 1 + n + C(n, 2) + C(n, 3) cells. A tree that uses only the \
         planes of the sheets has n + C(n, 2) + C(n, 3) pieces, about n³/6, in any order of the \
         planes. Without any crossings, n² pieces are still possible. An example is a set of walls \
         along the lines of a saddle (B. Chazelle, 1984). M. S. Paterson and F. F. Yao (\"Efficient \
         binary space partitions for hidden-surface removal and solid modeling\", 1990) prove that \
         polygons that do not cross never need more pieces, up to a constant factor. Suppose that half \
         of n walls stand along x, above the other half along y. The walls split each other (n/2)² \
         times if only their own planes are used. One plane between the two layers avoids every split. \
         Surfaces of real objects are far from these cases: their polygons are small, and few of them \
         lie near the plane of another one. Licences do not permit a scanned object on this page. A \
         noisy sphere takes its place. This sphere is a closed surface with bulges, made of small \
         triangles. The corners of the triangles are moved at random, so that hardly any two triangles \
         lie in one plane.",
    );
    let (mut series, mut rows) = (Vec::new(), Vec::new());
    for line in LINES {
        let mut points: Vec<(f64, f64)> = Vec::new();
        for &size in line.sizes {
            let scene = (line.scene)(size);
            let options = BuildOptions::DEFAULT.with_heuristic(line.heuristic);
            let tree = options.build(scene.polygons());
            let tree = tree.map_err(|error| Failure::about(line.name, error))?;
            points.push((scene.len() as f64, tree.len() as f64));
        }
        if let [.., (n, m), (polygons, fragments)] = points[..] {
            let power = (fragments / m).ln() / (polygons / n).ln();
            let per = fragments / polygons;
            rows.push([
                line.name.to_owned(),
                polygons.to_string(),
                fragments.to_string(),
                format!("{per:.2}"),
                format!("{power:.2}"),
            ]);
        }
        series.push(Series::new(line.name, line.style, points));
    }
    chapter.graph(&Chart {
        title: "Pieces of a tree against number of polygons",
        x_label: "polygons n",
        y_label: "pieces",
        ticks: None,
        falls: false,
        zero: false,
        series,
    })?;
    chapter.text(
        "The last column is the slope at the end of each line. If the slope is p, the number of \
         pieces grows as the p-th power of n.",
    );
    let head = ["scene", "polygons", "pieces", "pieces / polygon", "slope p"];
    chapter.table(head, rows);
    let towards = DVec3::new(0.8, -1.0, 0.9);
    let mut pictures = Vec::new();
    for worst in Worst::ALL {
        let scene = worst.scene(if worst == Worst::Sheets { 8 } else { 24 });
        let shot = Shot::around(&scene, towards)?;
        let name = format!("{worst}, {} polygons", scene.len());
        pictures.push(shot.by(&Bsp::exact(BuildOptions::DEFAULT), &name)?);
    }
    chapter.pictures(pictures);
    Ok(())
}
