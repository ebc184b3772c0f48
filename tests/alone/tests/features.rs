//! Uses each feature alone and with others, and the library without features.

use binspace::{BspTree, BuildOptions, Error, Heuristic, Point, Polygon, Viewpoint};
use std::collections::HashSet;
use std::ops::ControlFlow;
use std::thread;

const ARROW: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 1.0, 0.0], [-2.0, 2.0, 0.0]];

/// Squares in a grid with `side` squares on each side. They are tilted and so large that they cut their
/// neighbours.
fn squares(side: usize) -> Vec<[[f64; 3]; 4]> {
    let place = |i: usize| (i % side, i / side % side, i / side / side);
    let square = |i: usize| {
        let (x, y, z) = place(i);
        let [x, y, z] = [x, y, z].map(|k| k as f64);
        let tilt = 0.2 * ((i * 7 % 11) as f64 - 5.0);
        [[x, y, z], [x + 1.5, y, z + tilt], [x + 1.5, y + 1.5, z + tilt], [x, y + 1.5, z]]
    };
    (0..side * side * side).map(square).collect()
}

#[test]
fn polygons_are_built_ordered_and_handed_out() {
    let squares = squares(8);
    for heuristic in [Heuristic::Auto, Heuristic::Sampled { candidates: 4 }] {
        let tree = BuildOptions::DEFAULT.with_heuristic(heuristic).build(&squares).unwrap();
        assert!(tree.len() >= squares.len() && tree.stats().splits > 0);
        let mut order = Vec::new();
        let from_above = Viewpoint::direction([0.0, -1.0, 0.25]);
        tree.back_to_front_into(from_above, &mut order);
        assert!(tree.back_to_front(from_above).map(|fragment| fragment.index()).eq(order));
        assert!(tree.fragments().all(|fragment| fragment.vertices().len() >= 3));
    }
}

#[test]
fn a_polygon_that_is_not_convex_is_taken_apart() {
    let tree = BspTree::build([ARROW]).unwrap();
    assert_eq!((tree.len(), tree.preparation().triangulated), (2, 1));
}

#[test]
fn an_error_names_the_polygon() {
    let mut polygons = squares(2);
    polygons[5][1][2] = f64::NAN;
    let error: Error = BspTree::build(&polygons).unwrap_err();
    assert_eq!(error.polygon(), Some(5));
}

/// A user's own polygon.
struct Triangle([binspace::glam::DVec3; 3]);

impl Polygon for Triangle {
    type Point = binspace::glam::DVec3;

    fn corners(&self) -> impl Iterator<Item = binspace::glam::DVec3> {
        self.0.iter().copied()
    }
}

#[test]
fn polygons_of_a_user_s_own_type_are_built() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let tree = BspTree::build([Triangle(corners.map(|corner| corner.to_dvec3()))]).unwrap();
    assert_eq!(tree.fragment(0).polygon(), 0);
}

/// The building thread calls the callback. With `parallel`, other threads of its pool also call it.
#[test]
fn parallel_builds_by_the_threads_of_a_pool() {
    let squares = squares(24);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
    let callers = || {
        let mut callers = HashSet::from([thread::current().id()]);
        let tree = BuildOptions::DEFAULT.build_with_progress(&squares, |_| {
            callers.insert(thread::current().id());
            ControlFlow::Continue(())
        });
        assert!(tree.unwrap().len() >= squares.len());
        callers.len()
    };
    if cfg!(feature = "parallel") {
        // The other thread may be too late for one tree, but not for all of these trees.
        assert!((0..100).any(|_| pool.install(callers) == 2));
    } else {
        assert_eq!(pool.install(callers), 1);
    }
}

#[cfg(feature = "layers")]
#[test]
fn layers_are_cut_and_put_in_order() {
    use binspace::glam::{DMat4, Mat4};
    use binspace::layers::{Layer, Layers};

    let rect = [[-50.0, -20.0], [50.0, 20.0]];
    let mut page = Layers::new([[-100.0; 2], [100.0; 2]]);
    let layers =
        [Layer::new(rect, DMat4::from_rotation_y(1.0)), Layer::from_f32(rect, Mat4::IDENTITY)];
    assert!(page.update(&layers).unwrap() && !page.update(&layers).unwrap());
    assert_eq!((page.visible(), page.len()), (2, 3));
    assert!(page.back_to_front().all(|piece| piece.vertices().len() == 4));
    let error = page.update(&[Layer::new(rect, DMat4::NAN)]).unwrap_err();
    assert_eq!(error.polygon(), Some(0));
}

#[cfg(feature = "drawing")]
#[test]
fn drawings_have_a_path_for_each_visible_polygon() {
    use binspace::{drawing::ViewOptions, view};

    let tree = BspTree::build(squares(3)).unwrap();
    let corners = [[0.0; 3], [3.0; 3]].map(Point::to_dvec3);
    for camera in view::views(corners, binspace::glam::DVec3::Z, 2, [80, 60], 1).unwrap() {
        let map = tree.visibility(&camera, &ViewOptions::DEFAULT).unwrap();
        let drawing = map.drawing().unwrap();
        assert!(drawing.paths().len() == map.polygons().count() && drawing.paths().len() > 5);
    }
}

#[cfg(feature = "pdf")]
#[test]
fn pdf_writes_a_page() {
    use binspace::drawing::VectorPicture;

    let mut picture = VectorPicture::new([30, 20]);
    picture.add_label([15.0, 10.0], "one", 8.0, [0, 0, 0]);
    let file = picture.to_pdf();
    assert!(file.starts_with(b"%PDF-1.7") && file.ends_with(b"%%EOF"));
}

#[cfg(feature = "raster")]
#[test]
fn raster_paints_visible_polygons() {
    use binspace::verify::verify;
    use binspace::{raster, view};

    let tree = BspTree::build(squares(3)).unwrap();
    let corners = [[0.0; 3], [3.0; 3]].map(Point::to_dvec3);
    for camera in view::views(corners, binspace::glam::DVec3::Z, 2, [80, 60], 1).unwrap() {
        let verification = verify(&tree, &camera).unwrap();
        assert!(verification.is_right());
        let seen = verification.painted.faces().iter().filter(|&&face| face != raster::NONE);
        assert!(seen.count() > 100);
    }
}

#[cfg(feature = "scene")]
#[test]
fn scene_makes_scenes() {
    use binspace::scene;

    let city = scene::city(300, 1);
    let tree = BspTree::build(city.polygons()).unwrap();
    assert!(tree.len() >= city.len());
    assert_eq!(city.material(0), &city.materials()[0]);
}

#[cfg(feature = "obj")]
#[test]
fn obj_reads_a_file() {
    use binspace::scene::Scene;

    let text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let (scene, report) = Scene::from_obj("one", text, |_| None).unwrap();
    assert_eq!((scene.len(), report.faces), (1, 1));
    assert_eq!(BspTree::build(scene.polygons()).unwrap().len(), 1);
}

#[cfg(feature = "save")]
#[test]
fn save_writes_a_tree_and_reads_it() {
    let tree = BspTree::build(squares(6)).unwrap();
    let mut file = Vec::new();
    tree.write(&mut file).unwrap();
    let again = BspTree::read(&file[..]).unwrap();
    assert_eq!(again.stats(), tree.stats());
    assert_eq!(again.preparation(), tree.preparation());
    let from_above = Viewpoint::direction([0.0, -1.0, 0.25]);
    let order = |tree: &BspTree| {
        tree.back_to_front(from_above).map(|fragment| fragment.index()).collect::<Vec<_>>()
    };
    assert_eq!(order(&again), order(&tree));
    file[40] ^= 1;
    let error: binspace::Error = BspTree::read(&file[..]).unwrap_err();
    assert!(error.to_string().contains("damaged"));
}

#[cfg(feature = "mint")]
#[test]
fn mint_has_points_for_polygons_and_viewpoints() {
    let point = |[x, y, z]: [f32; 3]| mint::Point3 { x, y, z };
    let single = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.1], [0.5, 1.0, 0.0]];
    let tree = BspTree::build([single.map(point), single.map(|[x, y, z]| point([x, y, z + 1.0]))]);
    let tree = tree.unwrap();
    // The values are as precise as the arrays that they replace.
    let arrays = BspTree::build([single, single.map(|[x, y, z]| [x, y, z + 1.0])]).unwrap();
    assert_eq!(tree.stats(), arrays.stats());
    assert_eq!(tree.preparation(), arrays.preparation());
    let double = single.map(|c| mint::Point3::from(c.map(f64::from)));
    assert!(BspTree::build([double]).unwrap().fragment(0).vertices().len() == 3);
    let above = Viewpoint::eye(mint::Point3 { x: 0.0, y: 0.0, z: 9.0 });
    assert!(tree.back_to_front(above).map(|fragment| fragment.polygon()).eq([0, 1]));
    let vertex: mint::Point3<f64> = tree.fragment(0).vertices().next().unwrap().into();
    assert_eq!(vertex.x, 0.0);
}
