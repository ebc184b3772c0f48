//! A tree's picture against the depth buffer's: the one place that knows both.

use crate::bsp::{BspTree, Fragment};
use crate::geom::{Kernel, Line, Viewpoint};
use crate::raster::{
    Canvas, Comparison, DepthImage, Image, Order, Outline, Painter, Piece, Rays, Verdict, compare,
    covers, is_open, zbuffer,
};
use crate::view::{Camera, CameraError};

/// A tree judged from one camera: what was painted in its order, what is really to be seen, and
/// how they differ.
#[derive(Clone, Debug)]
pub struct Verification {
    /// The rays that made both pictures.
    pub rays: Rays,
    /// The fragments painted over each other, back to front.
    pub painted: Image,
    /// The nearest face in every pixel, by a depth buffer that knows the faces but not the tree.
    pub truth: DepthImage,
    /// The difference of the two.
    pub comparison: Comparison,
}

/// Paints a tree's fragments back to front, and compares the picture with that of a depth buffer,
/// pixel by pixel.
///
/// With the [`Exact`](crate::geom::Exact) kernel there is no wrong pixel, whatever the scene and
/// wherever the camera: what the tolerance allows counts as contested, be it by the rule of
/// [`compare`], which knows the polygons, or by that of [`is_open`] for the plane that the tree has
/// between the two. With a tolerance of 0 only ties are contested.
///
/// ```
/// use binspace::{BspTree, scene, verify, view};
///
/// let scene = scene::newell_bars();
/// let tree = BspTree::build(scene.polygons())?;
/// let (low, high) = scene.bounds().expect("a scene with corners");
/// for camera in view::views([low, high], scene.up(), 4, [160, 120], 1)? {
///     assert_eq!(verify(&tree, &camera)?.comparison.wrong(), 0);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// If the camera cannot be had on the scene's grid; see [`Rays::new`].
pub fn verify<K: Kernel>(tree: &BspTree<K>, camera: &Camera) -> Result<Verification, CameraError> {
    let rays = Rays::new(camera, tree.faces())?;
    let painted = paint_tree(tree, camera.viewpoint(), &rays);
    let truth = zbuffer(&rays, tree.faces());
    let mut comparison = compare(&rays, tree.faces(), &painted, truth.image());
    if tree.faces().tolerance() > 0.0 && comparison.wrong_order > 0 {
        contest(tree, &rays, [&painted, truth.image()], &mut comparison);
    }
    Ok(Verification { rays, painted, truth, comparison })
}

/// Paints a tree's fragments in the back-to-front order of a viewpoint, which should be that of the
/// rays.
///
/// Fragments of an exact kernel are bounded by the lines that cut them, those of others by their
/// rounded vertices: such a kernel decides by these, and they are what its users would draw.
pub fn paint_tree<K: Kernel>(tree: &BspTree<K>, viewpoint: Viewpoint, rays: &Rays) -> Image {
    let mut order = Vec::new();
    tree.back_to_front_into(viewpoint, &mut order);
    paint_order(tree, &order, rays)
}

/// Paints fragments of a tree one after the other.
pub(crate) fn paint_order<K: Kernel>(tree: &BspTree<K>, order: &[u32], rays: &Rays) -> Image {
    let mut painter = Painter::new(rays, tree.faces(), Order::BackToFront);
    let mut buffers = Buffers::default();
    for &index in order {
        painter.draw(buffers.piece(&tree.fragment(index)));
    }
    painter.finish()
}

/// Paints a tree's fragments in colours, back to front, over a background; `look` gives the colour
/// and the opacity of a polygon by its number.
///
/// The picture is RGB, 8 bits each, row by row from the top left. Where all is opaque it is that
/// which [`raster::picture`](crate::raster::picture) makes of what [`paint_tree`] paints.
pub fn paint_tree_in_colour<K: Kernel>(
    tree: &BspTree<K>,
    viewpoint: Viewpoint,
    rays: &Rays,
    look: impl Fn(usize) -> ([u8; 3], f32),
    background: [u8; 3],
) -> Vec<u8> {
    let mut canvas = Canvas::new(rays, tree.faces(), background);
    let mut order = Vec::new();
    tree.back_to_front_into(viewpoint, &mut order);
    let mut buffers = Buffers::default();
    for index in order {
        let fragment = tree.fragment(index);
        let (colour, opacity) = look(fragment.polygon());
        canvas.draw(buffers.piece(&fragment), colour, opacity);
    }
    canvas.finish()
}

/// Counts wrong pixels as contested where the plane between the two fragments leaves it open which
/// of them is painted last.
fn contest<K: Kernel>(
    tree: &BspTree<K>,
    rays: &Rays,
    [painted, truth]: [&Image; 2],
    comparison: &mut Comparison,
) {
    let mut by_face: Vec<(u32, u32)> = tree.fragments().map(|f| (f.face(), f.index())).collect();
    by_face.sort_unstable();
    let mut buffers = Buffers::default();
    // The fragment of a face that is met in a pixel.
    let mut fragment_at = |face: u32, pixel| {
        let first = by_face.partition_point(|&(other, _)| other < face);
        let of_face = by_face[first..].iter().take_while(|&&(other, _)| other == face);
        let mut fragments = of_face.map(|&(_, fragment)| fragment);
        fragments.find(|&fragment| {
            let piece = buffers.piece(&tree.fragment(fragment));
            covers(rays, tree.faces(), piece, pixel)
        })
    };
    let width = rays.size()[0] as usize;
    for (i, verdict) in comparison.verdicts.iter_mut().enumerate() {
        if *verdict != Verdict::WrongOrder {
            continue;
        }
        let pixel = [(i % width) as u32, (i / width) as u32];
        let met = [truth.faces()[i], painted.faces()[i]];
        let [nearest, other] = met.map(|face| fragment_at(face, pixel));
        let plane = nearest.zip(other).and_then(|(a, b)| tree.plane_between(a, b));
        if plane.is_some_and(|plane| is_open(rays, tree.faces(), plane, met, pixel)) {
            *verdict = Verdict::Contested;
            comparison.wrong_order -= 1;
            comparison.contested += 1;
        }
    }
}

/// A fragment's outline, in memory that the next one uses again.
#[derive(Default)]
struct Buffers {
    lines: Vec<Line>,
    vertices: Vec<[f64; 3]>,
}

impl Buffers {
    fn piece<K: Kernel>(&mut self, fragment: &Fragment<'_, K>) -> Piece<'_> {
        let face = fragment.face();
        if fragment.is_whole() {
            return Piece { face, outline: Outline::Whole };
        }
        self.vertices.clear();
        self.vertices.extend(fragment.lattice_vertices());
        let vertices = &self.vertices[..];
        if !K::IS_EXACT {
            return Piece { face, outline: Outline::Vertices(vertices) };
        }
        self.lines.clear();
        self.lines.extend(fragment.lines());
        Piece { face, outline: Outline::Lines { lines: &self.lines, vertices } }
    }
}

#[cfg(test)]
mod tests {
    use super::{paint_tree_in_colour, verify};
    use crate::geom::Float;
    use crate::raster::{colour_of, picture};
    use crate::view::{Camera, views};
    use crate::{BspTree, BuildOptions, Heuristic, scene};
    use glam::DVec3;

    #[test]
    fn the_exact_kernel_paints_what_the_depth_buffer_sees() {
        for scene in [scene::newell_bars(), scene::crossing(5), scene::random_triangles(60, 1)] {
            let (low, high) = scene.bounds().unwrap();
            let cameras = views([low, high], scene.up(), 4, [96, 72], 3).unwrap();
            for heuristic in Heuristic::ALL {
                let options = BuildOptions::DEFAULT.with_heuristic(heuristic);
                let tree = options.build(scene.polygons()).unwrap();
                for camera in &cameras {
                    let result = verify(&tree, camera).unwrap().comparison;
                    assert!(result.covered > 0, "{} {heuristic}", scene.name());
                    assert_eq!(result.wrong(), 0, "{} {heuristic} {camera:?}", scene.name());
                }
            }
        }
    }

    /// Square 1 counts as on the plane of square 0, which is aside; the eye is between them, and
    /// square 2, far behind square 1, counts as nearer.
    #[test]
    fn what_an_eye_within_the_tolerance_of_a_plane_sees_is_contested() {
        let square =
            |x: f64, z: f64, r: f64| [[x - r, -r, z], [x + r, -r, z], [x + r, r, z], [x - r, r, z]];
        for unit in [1e-2, 1e-6] {
            let squares =
                [square(10.0, 0.0, 1.0), square(0.0, 0.5 * unit, 2.0), square(0.0, 1.0, 5.0)];
            let look = |tolerance, z: f64| {
                let first = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
                let tree = first.with_tolerance(tolerance).build(squares).unwrap();
                let eye = DVec3::new(0.0, 0.0, z * unit);
                let camera = Camera::perspective(eye, eye + DVec3::Z, DVec3::Y, 1.0, [40, 30]);
                verify(&tree, &camera.unwrap()).unwrap().comparison
            };
            let within = look(unit, 0.2);
            assert_eq!((within.wrong(), within.contested), (0, 40 * 30), "{unit}");
            for (tolerance, z) in [(0.0, 0.2), (unit, -1.2)] {
                let comparison = look(tolerance, z);
                assert_eq!((comparison.wrong(), comparison.contested), (0, 0), "{unit} {z}");
            }
        }
    }

    /// Two walls that each reach across the plane of a floor aside by less than the tolerance, the
    /// one up and the other down, seen along it.
    #[test]
    fn what_a_ray_along_a_plane_within_the_tolerance_sees_is_contested() {
        let unit = 1e-2;
        let wall = |x: f64, low: f64, high: f64| {
            [[x, -1.0, low], [x, 1.0, low], [x, 1.0, high], [x, -1.0, high]]
        };
        let floor = [[3.0, 5.0, 0.0], [4.0, 5.0, 0.0], [4.0, 6.0, 0.0], [3.0, 6.0, 0.0]];
        let polygons = [floor, wall(1.0, -0.5 * unit, 1.0), wall(2.0, -1.0, 0.5 * unit)];
        let look = |tolerance, z: f64| {
            let first = BuildOptions::DEFAULT.with_heuristic(Heuristic::First);
            let tree = first.with_tolerance(tolerance).build(polygons).unwrap();
            let eye = DVec3::new(-1.0, 0.0, z);
            let target = DVec3::new(1.0, 0.0, 0.0);
            let camera = Camera::perspective(eye, target, DVec3::Z, 0.01, [40, 40]).unwrap();
            verify(&tree, &camera).unwrap().comparison
        };
        // From below, the wall in front is painted first, and the far one over its lower end.
        let within = look(unit, -1e-6);
        assert_eq!(within.wrong(), 0);
        assert!(within.contested > 0);
        let exact = look(0.0, -1e-6);
        assert_eq!((exact.wrong(), exact.contested), (0, 0));
    }

    #[test]
    fn a_kernel_that_is_far_off_is_found_out() {
        // With an epsilon of a tenth of the extent, what crosses counts as on one side.
        let scene = scene::random_triangles(60, 1);
        let kernel = Float::<f64>::new(0.1);
        let tree = BuildOptions::DEFAULT.build_with(kernel, scene.polygons()).unwrap();
        let (low, high) = scene.bounds().unwrap();
        let cameras = views([low, high], scene.up(), 4, [96, 72], 3).unwrap();
        let wrong = cameras.iter().map(|camera| verify(&tree, camera).unwrap().comparison.wrong());
        assert!(wrong.sum::<usize>() > 0);
    }

    #[test]
    fn opaque_colours_are_those_of_the_picture_of_polygons() {
        let scene = scene::random_triangles(60, 1);
        let tree = BspTree::build(scene.polygons()).unwrap();
        let (low, high) = scene.bounds().unwrap();
        let camera = &views([low, high], scene.up(), 1, [96, 72], 3).unwrap()[0];
        let seen = verify(&tree, camera).unwrap();
        let look = |polygon: usize| (colour_of(polygon as u32), 1.0);
        let picture = picture(&seen.rays, tree.faces(), &seen.painted, colour_of, [9; 3]);
        let viewpoint = camera.viewpoint();
        assert!(paint_tree_in_colour(&tree, viewpoint, &seen.rays, look, [9; 3]) == picture);
        let clear = |polygon: usize| (colour_of(polygon as u32), 0.0);
        let nothing = paint_tree_in_colour(&tree, viewpoint, &seen.rays, clear, [9; 3]);
        assert!(nothing.iter().all(|&channel| channel == 9));
    }

    #[test]
    fn an_empty_tree_is_an_empty_picture() {
        let tree = BspTree::build(Vec::<[[f64; 3]; 3]>::new()).unwrap();
        let bounds = [[0.0; 3], [1.0; 3]].map(glam::DVec3::from);
        let camera = &views(bounds, glam::DVec3::Z, 1, [8, 8], 0).unwrap()[0];
        let result = verify(&tree, camera).unwrap().comparison;
        assert_eq!((result.covered, result.wrong()), (0, 0));
    }
}
