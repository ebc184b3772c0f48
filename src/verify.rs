//! A tree's picture against the depth buffer's: the one place that knows both.

use crate::bsp::{BspTree, Fragment};
use crate::geom::{Kernel, Line, Viewpoint};
use crate::raster::{
    Comparison, DepthImage, Image, Order, Outline, Painter, Piece, Rays, compare, zbuffer,
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
/// With the [`Exact`](crate::geom::Exact) kernel and a tolerance of 0 there is no wrong pixel,
/// whatever the scene and wherever the camera. With a tolerance there can be some where the eye,
/// or a ray, keeps within the tolerance of a partition plane.
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
    let comparison = compare(&rays, tree.faces(), &painted, truth.image());
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
    use super::verify;
    use crate::geom::Float;
    use crate::view::views;
    use crate::{BspTree, BuildOptions, Heuristic, scene};

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
    fn an_empty_tree_is_an_empty_picture() {
        let tree = BspTree::build(Vec::<[[f64; 3]; 3]>::new()).unwrap();
        let bounds = [[0.0; 3], [1.0; 3]].map(glam::DVec3::from);
        let camera = &views(bounds, glam::DVec3::Z, 1, [8, 8], 0).unwrap()[0];
        let result = verify(&tree, camera).unwrap().comparison;
        assert_eq!((result.covered, result.wrong()), (0, 0));
    }
}
