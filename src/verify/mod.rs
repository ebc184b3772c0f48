//! Compares a tree's picture with a depth buffer's picture, and the list of an order with the iterator. No
//! other module uses both the tree and the independent depth buffer.

use std::collections::HashMap;
use std::ops::Range;

use crate::Error;
use crate::paint::{Pieces, paint_list};
use crate::raster::{
    Comparison, DepthImage, Image, Layers, Painter, Rays, compare_by, for_each_run, is_open,
    zbuffer_layers,
};
use crate::tree::{BspTree, Fragment};
use crate::view::Camera;
use crate::viewpoint::Viewpoint;

/// The result of [`verify`]: the picture painted in the tree's order, the true picture of a depth buffer, and
/// the differences between the two pictures.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Verification {
    /// The rays of both pictures.
    pub rays: Rays,
    /// The [fragments](crate::Fragment) painted over each other, back to front.
    pub painted: Image,
    /// The nearest [face](crate::BspTree#contents) in every pixel, by a depth buffer that uses the faces but
    /// not the tree.
    pub truth: DepthImage,
    /// The differences between `painted` and `truth`.
    pub comparison: Comparison,
    /// The differences between `truth` and a picture painted front to back. In that picture, each fragment is
    /// painted only on pixels that are still empty.
    pub front_to_back: Comparison,
    /// The number of pixels in which a face that covers the pixel is not painted exactly once, even if the
    /// face is hidden. Such an error would be visible if the faces were transparent.
    pub miscounted: usize,
    /// An error if an order does not list every fragment once, if the list and the iterator have different
    /// orders, or if front to back is not the reverse of back to front.
    pub orders: Result<(), String>,
}

impl Verification {
    /// Returns whether the pictures and the orders are all right.
    pub fn is_right(&self) -> bool {
        let wrong = self.comparison.wrong() + self.front_to_back.wrong() + self.miscounted;
        wrong == 0 && self.orders.is_ok()
    }
}

/// Paints a tree's [fragments](crate::Fragment) back to front and front to back, and compares both pictures
/// with a depth buffer's picture, pixel by pixel. Also checks that the tree's list and iterator have the same
/// order.
///
/// If the library has no error, the result [is right](Verification::is_right) for every scene and camera. A
/// pixel may differ, but only if it is *contested*: the [tolerance](BspTree#exactness) τ allows either order
/// of the painted fragment and the true fragment. A pixel is contested in two cases:
///
/// - The ray of the pixel meets both fragments at exactly the same distance.
/// - One of the two fragments reaches across the [partition plane](BspTree#contents) between the two
///   fragments, and two points of the ray are within τ of that plane: the point where the ray meets the
///   nearer fragment, and either the ray's start or the point where the ray meets the other fragment.
///
/// With a tolerance of 0, only the first case is contested.
///
/// This rule is stricter than [`compare`](crate::raster::compare), which does not use the partition planes.
/// For example, `compare` contests two layers less than 2 τ apart. `verify` does not contest the two layers
/// if a partition plane separates them exactly.
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
/// If the camera does not fit the tree's [grid](BspTree::grid); see [`Rays::new`].
pub fn verify(tree: &BspTree, camera: &Camera) -> Result<Verification, Error> {
    let rays = Rays::new(camera, tree.faces())?;
    Ok(judge(tree, rays, Orders::of(tree, camera.viewpoint())))
}

/// Verifies a tree like [`verify`], but ignores [faces](BspTree#contents) seen from the back: such faces are
/// not painted, and hide no other faces. Use this function for rooms seen from outside.
///
/// # Errors
///
/// As for [`verify`].
pub fn verify_fronts(tree: &BspTree, camera: &Camera) -> Result<Verification, Error> {
    let rays = Rays::new(camera, tree.faces())?.with_front_faces_only();
    Ok(judge(tree, rays, Orders::of(tree, camera.viewpoint())))
}

/// Like [`verify`], for orders that need not be the tree's orders.
fn judge(tree: &BspTree, rays: Rays, orders: Orders) -> Verification {
    let faces = tree.faces();
    let (far_first, near_first) = (&orders.0[0], &orders.0[FIRST_NEAR]);
    let mut layers = Layers::new(&rays);
    let painted = paint_list(Painter::new(&rays, faces), tree, far_first, Some(&mut layers));
    let (truth, all) = zbuffer_layers(&rays, faces);
    let against_truth = |image: &Image| compare_by_planes(tree, &rays, image, truth.image());
    let comparison = against_truth(&painted);
    // If one order is the reverse of the other, keeping the first fragment of each pixel results in the same
    // picture as painting over: no second picture is needed.
    let front_to_back = if near_first.iter().rev().eq(far_first) {
        comparison.clone()
    } else {
        let painter = Painter::new(&rays, faces).front_to_back();
        against_truth(&paint_list(painter, tree, near_first, None))
    };
    let miscounted = layers.differences(&all);
    let orders = orders.check(tree.len());
    Verification { rays, painted, truth, comparison, front_to_back, miscounted, orders }
}

/// Compares a painted picture of a tree with a true picture. Ties are contested. So are pixels in which the
/// tolerance at the plane between the two fragments leaves open which fragment is painted last.
fn compare_by_planes(tree: &BspTree, rays: &Rays, painted: &Image, truth: &Image) -> Comparison {
    let faces = tree.faces();
    if faces.tolerance() == 0.0 {
        return compare_by(rays, faces, [painted, truth], 0.0, |_, _| false);
    }
    let mut painted_runs = PaintedRuns::new(tree, rays);
    compare_by(rays, faces, [painted, truth], 0.0, |met, pixel| {
        let [nearest, other] = met.map(|face| painted_runs.fragment_at(face, pixel));
        let parting = nearest.zip(other).and_then(|(a, b)| tree.parting(a, b));
        parting.is_some_and(|(plane, [near, far])| {
            is_open(rays, faces, plane, [(met[0], near), (met[1], far)], pixel)
        })
    })
}

/// The fragments of faces in the pixels of a picture. The fragments of a face are painted once, when the face
/// is first looked up.
struct PaintedRuns<'a> {
    tree: &'a BspTree,
    rays: &'a Rays,
    /// Each fragment after its face, sorted; empty before the first call.
    by_face: Vec<(u32, u32)>,
    /// The runs of each face, sorted by row and column. Fragments of one face do not overlap.
    runs: HashMap<u32, Vec<Run>>,
    /// The number of fragments painted.
    #[cfg(test)]
    painted: usize,
}

/// Neighbouring pixels of a row that a fragment covers.
struct Run {
    row: u32,
    columns: Range<u32>,
    fragment: u32,
}

impl<'a> PaintedRuns<'a> {
    fn new(tree: &'a BspTree, rays: &'a Rays) -> Self {
        Self {
            tree,
            rays,
            by_face: vec![],
            runs: HashMap::new(),
            #[cfg(test)]
            painted: 0,
        }
    }

    /// The fragment of a face that covers a pixel.
    fn fragment_at(&mut self, face: u32, [x, y]: [u32; 2]) -> Option<u32> {
        if !self.runs.contains_key(&face) {
            let runs = self.paint(face);
            self.runs.insert(face, runs);
        }
        let runs = &self.runs[&face];
        let next = runs.partition_point(|run| (run.row, run.columns.start) <= (y, x));
        let run = runs[..next].last()?;
        (run.row == y && run.columns.contains(&x)).then_some(run.fragment)
    }

    fn paint(&mut self, face: u32) -> Vec<Run> {
        let &mut Self { tree, rays, ref mut by_face, .. } = self;
        if by_face.is_empty() {
            by_face.extend(tree.fragments().map(|f| (f.face(), f.index())));
            by_face.sort_unstable();
        }
        let first = by_face.partition_point(|&(other, _)| other < face);
        let of_face = by_face[first..].iter().take_while(|&&(other, _)| other == face);
        let (mut pieces, mut runs) = (Pieces::default(), Vec::new());
        for &(_, fragment) in of_face {
            #[cfg(test)]
            {
                self.painted += 1;
            }
            let piece = pieces.of(&tree.fragment(fragment));
            for_each_run(rays, tree.faces(), piece, |row, columns| {
                runs.push(Run { row, columns, fragment });
            });
        }
        runs.sort_unstable_by_key(|run| (run.row, run.columns.start));
        runs
    }
}

/// The forms of an order: back to front, then front to back.
const FORMS: [&str; 4] = ["write_into", "order", "front_to_back", "front_to_back().write_into"];
/// The first form of front-to-back orders.
const FIRST_NEAR: usize = 2;

/// Checks that the order of a viewpoint contains every [fragment](crate::Fragment) once, that the list and
/// the iterator have the same order, and that front to back is the reverse of back to front.
///
/// This function does not check that the order is right: [`verify`] does, by a picture of the order.
///
/// # Errors
///
/// The first fault found.
pub fn check_orders(tree: &BspTree, viewpoint: Viewpoint) -> Result<(), String> {
    Orders::of(tree, viewpoint).check(tree.len())
}

/// The orders of one viewpoint, a list of fragments for each of [`FORMS`].
#[derive(Clone, Debug)]
struct Orders([Vec<u32>; 4]);

impl Orders {
    /// The orders of a tree. An order that does not end is truncated as soon as it is certainly too long.
    fn of(tree: &BspTree, viewpoint: Viewpoint) -> Self {
        let most = tree.len() + 1;
        let (mut far_first, mut near_first) = (Vec::new(), Vec::new());
        tree.back_to_front_into(viewpoint, &mut far_first);
        let near = tree.order(viewpoint).front_to_back();
        near.write_into(&mut near_first);
        let number = |fragment: Fragment<'_>| fragment.index();
        Self([
            far_first,
            tree.back_to_front(viewpoint).map(number).take(most).collect(),
            near.into_iter().map(number).take(most).collect(),
            near_first,
        ])
    }

    /// Checks that each form lists each of `fragments` fragments once, and that all forms agree.
    fn check(&self, fragments: usize) -> Result<(), String> {
        let forms = || FORMS.into_iter().zip(&self.0).enumerate();
        for (_, (form, list)) in forms() {
            each_once(list, fragments).map_err(|fault| format!("{form} {fault}"))?;
        }
        let [first, ..] = &self.0;
        for (i, (form, list)) in forms() {
            let expected =
                |place| if i < FIRST_NEAR { first[place] } else { first[fragments - 1 - place] };
            if let Some(place) = (0..fragments).find(|&place| list[place] != expected(place)) {
                let fault = format!("contradicts {} at place {place} of the order", FORMS[0]);
                return Err(format!("{form} {fault}"));
            }
        }
        Ok(())
    }
}

/// Returns an error unless a list contains each fragment once.
fn each_once(list: &[u32], fragments: usize) -> Result<(), String> {
    let mut seen = vec![false; fragments];
    for &fragment in list {
        match seen.get_mut(fragment as usize) {
            None => return Err(format!("lists fragment {fragment}, which does not exist")),
            Some(true) => return Err(format!("lists fragment {fragment} more than once")),
            Some(seen) => *seen = true,
        }
    }
    let missing = seen.iter().position(|seen| !seen);
    missing.map_or(Ok(()), |fragment| Err(format!("leaves out fragment {fragment}")))
}

#[cfg(test)]
mod tests;
