//! Comparing a tree's picture with a depth buffer's: the only module that knows both.

mod orders;
#[cfg(test)]
mod tests;

use crate::paint::paint_list;
use crate::raster::{Comparison, DepthImage, Image, Layers, Order, Rays, zbuffer_layers};
use crate::tree::BspTree;
use crate::view::{Camera, CameraError};

use orders::{Orders, compare_by_planes};

pub use orders::{OrderFault, check_orders};

/// A tree verified from one camera: the picture painted in its order, the true picture, and their
/// differences.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Verification {
    /// The rays that both pictures were made with.
    pub rays: Rays,
    /// The fragments painted over each other, back to front.
    pub painted: Image,
    /// The nearest face in every pixel, by a depth buffer that knows the faces but not the tree.
    pub truth: DepthImage,
    /// How `painted` differs from `truth`.
    pub comparison: Comparison,
    /// How the picture painted front to back, each fragment only where no earlier one is, differs
    /// from `truth`.
    pub front_to_back: Comparison,
    /// The number of pixels in which a face that covers them, seen or hidden, is painted more than
    /// once or not at all. Such faults would show in transparent faces.
    pub miscounted: usize,
    /// Whether each order lists every fragment once, and is the same in all its forms.
    pub orders: Result<(), OrderFault>,
}

impl Verification {
    /// Whether the pictures and the orders are all right.
    pub fn is_right(&self) -> bool {
        let wrong = self.comparison.wrong() + self.front_to_back.wrong() + self.miscounted;
        wrong == 0 && self.orders.is_ok()
    }
}

/// Paints a tree's fragments back to front and front to back, and compares both pictures with a
/// depth buffer's, pixel by pixel. Also compares the orders that the tree returns as lists, by
/// iterators and by visitors.
///
/// Everything [is right](Verification::is_right), whatever the scene and the camera. Pixels that
/// differ only as far as the tolerance allows count as contested: one of the two fragments reaches
/// across the tree's plane between them, and the ray meets both within the tolerance of that plane, or
/// meets the nearer one there and begins there. With a tolerance of 0 only ties are contested, which
/// are fragments at exactly the same distance.
///
/// This is less than [`compare`](crate::raster::compare) excuses of layers up to twice the tolerance
/// apart, as that knows the polygons alone: where a plane of the tree parts them exactly, their order
/// is not open.
///
/// ```
/// use binspace::verify::verify;
/// use binspace::{BspTree, scene, view};
///
/// let scene = scene::newell_bars();
/// let tree = BspTree::build(scene.polygons())?;
/// let (low, high) = scene.bounds().expect("a scene with corners");
/// for camera in view::views([low, high], scene.up(), 4, [160, 120], 1)? {
///     assert!(verify(&tree, &camera)?.is_right());
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// If the camera does not fit the scene's grid; see [`Rays::new`].
pub fn verify(tree: &BspTree, camera: &Camera) -> Result<Verification, CameraError> {
    let rays = Rays::new(camera, tree.faces())?;
    Ok(judge(tree, rays, Orders::of(tree, camera.viewpoint())))
}

/// Like [`verify`], with the backs of faces left out: of the pictures, and of what counts as in
/// front. For rooms seen from outside.
///
/// # Errors
///
/// As for [`verify`].
pub fn verify_fronts(tree: &BspTree, camera: &Camera) -> Result<Verification, CameraError> {
    let rays = Rays::new(camera, tree.faces())?.with_front_faces_only();
    Ok(judge(tree, rays, Orders::of(tree, camera.viewpoint())))
}

/// Like [`verify`], for orders that need not be the tree's.
fn judge(tree: &BspTree, rays: Rays, orders: Orders) -> Verification {
    let faces = tree.faces();
    let (far_first, near_first) = (orders.back_to_front(), orders.front_to_back());
    let mut layers = Layers::new(&rays);
    let painted = paint_list(tree, far_first, Order::BackToFront, &rays, Some(&mut layers));
    let (truth, all) = zbuffer_layers(&rays, faces);
    let against_truth = |image: &Image| compare_by_planes(tree, &rays, image, truth.image());
    let comparison = against_truth(&painted);
    // If one order is the reverse of the other, showing only the first fragment of each pixel makes
    // the same picture as painting over: it need not be painted again.
    let front_to_back = if near_first.iter().rev().eq(far_first) {
        comparison.clone()
    } else {
        against_truth(&paint_list(tree, near_first, Order::FrontToBack, &rays, None))
    };
    let miscounted = layers.differences(&all);
    let orders = orders.check(tree.len());
    Verification { rays, painted, truth, comparison, front_to_back, miscounted, orders }
}
