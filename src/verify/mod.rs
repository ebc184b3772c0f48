//! Compares a tree's picture with a depth buffer's: the only module that knows both.

mod contest;
mod orders;
mod pieces;
#[cfg(test)]
mod tests;

use crate::raster::{
    Comparison, DepthImage, Image, Layers, Order, Painter, Rays, blend, compare, for_each_shaded,
    zbuffer_layers,
};
use crate::tree::BspTree;
use crate::view::{Camera, CameraError};
use crate::viewpoint::Viewpoint;

use contest::contest;
use orders::Orders;
pub(crate) use pieces::Buffers;

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
/// differ only as far as the tolerance allows count as contested: by the rule of [`compare`], which
/// knows the polygons, or because the ray meets both within the tolerance of the tree's plane
/// between them, or meets the nearer one there and begins there. With a tolerance of 0 only ties are
/// contested.
///
/// ```
/// use binspace::{BspTree, scene, verify, view};
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
    let against_truth = |image: &Image| {
        let mut comparison = compare(&rays, faces, image, truth.image());
        if faces.tolerance() > 0.0 && comparison.wrong_order > 0 {
            contest(tree, &rays, [image, truth.image()], &mut comparison);
        }
        comparison
    };
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

/// Paints a tree's fragments in the back-to-front order of a viewpoint, which should be that of the
/// rays.
///
/// Fragments are bounded by the exact lines that cut them, not by their rounded vertices.
pub fn paint_tree(tree: &BspTree, viewpoint: Viewpoint, rays: &Rays) -> Image {
    let mut order = Vec::new();
    tree.back_to_front_into(viewpoint, &mut order);
    paint_order(tree, &order, rays)
}

/// Paints fragments of a tree one over the other.
pub fn paint_order(tree: &BspTree, order: &[u32], rays: &Rays) -> Image {
    paint_list(tree, order, Order::BackToFront, rays, None)
}

/// Paints fragments of a tree one after the other, and records which faces cover which pixels.
/// Numbers that name no fragment are skipped.
fn paint_list(
    tree: &BspTree,
    list: &[u32],
    order: Order,
    rays: &Rays,
    mut layers: Option<&mut Layers>,
) -> Image {
    let mut painter = Painter::new(rays, tree.faces(), order);
    let mut buffers = Buffers::default();
    for &index in list.iter().filter(|&&index| (index as usize) < tree.len()) {
        let fragment = tree.fragment(index);
        painter.draw_and(buffers.piece(&fragment), |y, columns| {
            if let Some(layers) = &mut layers {
                layers.add(fragment.face(), y, columns);
            }
        });
    }
    painter.finish()
}

/// Paints a tree's fragments in colours, back to front, over a background. `look` returns the
/// colour and the opacity of a polygon, given its number.
///
/// The picture is RGB, 8 bits each, row by row from the top left. If everything is opaque, it is
/// the same as [`raster::picture`](crate::raster::picture) of what [`paint_tree`] paints.
pub fn paint_tree_in_colour(
    tree: &BspTree,
    viewpoint: Viewpoint,
    rays: &Rays,
    look: impl Fn(usize) -> ([u8; 3], f32),
    background: [u8; 3],
) -> Vec<u8> {
    let [width, height] = rays.size().map(|side| side as usize);
    let mut pixels = vec![background.map(f32::from); width * height];
    for_each_painted(tree, viewpoint, rays, look, |pixel, colour, opacity| {
        blend(&mut pixels[pixel], colour, opacity);
    });
    pixels.into_iter().flatten().map(|channel| channel.round() as u8).collect()
}

/// Calls `paint` with each pixel that each fragment covers, back to front: the pixel's number, row by row
/// from the top left, and the colour and the opacity there. [`blend`] makes of them the
/// picture of [`paint_tree_in_colour`], of one tree or of those of several cells one after the other.
pub fn for_each_painted(
    tree: &BspTree,
    viewpoint: Viewpoint,
    rays: &Rays,
    look: impl Fn(usize) -> ([u8; 3], f32),
    mut paint: impl FnMut(usize, [u8; 3], f32),
) {
    let mut order = Vec::new();
    tree.back_to_front_into(viewpoint, &mut order);
    let mut buffers = Buffers::default();
    for index in order {
        let fragment = tree.fragment(index);
        let (colour, opacity) = look(fragment.polygon());
        for_each_shaded(rays, tree.faces(), buffers.piece(&fragment), colour, |pixel, colour| {
            paint(pixel, colour, opacity);
        });
    }
}
