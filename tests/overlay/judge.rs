//! Judges an overlay's order: compares the painter's picture of both parts with an exact depth buffer of all
//! faces.

use std::collections::HashMap;
use testkit::prelude::*;

use binspace::overlay::{Overlay, Shape};
use binspace::raster::{Outline, Painter, Piece, compare, for_each_run, zbuffer};

use testkit::fragment_pixels::with_piece;
use testkit::judge::{Verdict, ensure};
use testkit::model::Face;
use testkit::rational::Point;

/// The counts of comparisons.
#[derive(Debug, Default)]
pub(crate) struct Judged {
    pub(crate) pictures: usize,
    /// Pixels that show a polygon, and pixels that show a moving polygon.
    pub(crate) covered: usize,
    pub(crate) moving: usize,
    pub(crate) contested: usize,
}

impl Judged {
    /// Judges both parts from a camera that may not fit the grid.
    pub(crate) fn look(&mut self, tree: &BspTree, overlay: &Overlay, camera: &Camera) -> Verdict {
        self.look_at_polygons(tree, overlay, overlay.faces(), camera)
    }

    /// Runs the check of `look` with given faces of the tree and of the overlay's polygons, without lines and
    /// points.
    pub(crate) fn look_at_polygons(
        &mut self,
        tree: &BspTree,
        overlay: &Overlay,
        faces: &Faces,
        camera: &Camera,
    ) -> Verdict {
        let Ok(rays) = Rays::new(camera, faces) else { return Ok(()) };
        let order = forms(tree, overlay, camera)?;
        let mut painter = Painter::new(&rays, faces);
        let mut painted: HashMap<(u32, u32, u32), usize> = HashMap::new();
        for &number in &order {
            let shape = overlay.shape(number);
            let shape = shape.unwrap_or_else(|| Shape::Fragment(tree.fragment(number)));
            let Some(fragment) = shape.fragment() else { continue };
            with_piece(&fragment, |piece| {
                painter.draw(piece);
                if number as usize >= tree.len() {
                    for_each_run(&rays, faces, piece, |y, columns| {
                        for x in columns {
                            *painted.entry((piece.face, x, y)).or_default() += 1;
                        }
                    });
                }
            });
        }
        let truth = zbuffer(&rays, faces);
        let result = compare(&rays, faces, &painter.finish(), truth.image());
        let wrong = [result.wrong_order, result.holes, result.spills];
        ensure(wrong == [0; 3], || format!("wrong order, holes, spills {wrong:?}: {camera:?}"))?;
        for face in tree.faces().len() as u32..faces.len() as u32 {
            let whole = Piece { face, outline: Outline::Whole };
            let mut miscounted = 0;
            for_each_run(&rays, faces, whole, |y, columns| {
                miscounted += columns.filter(|&x| painted.remove(&(face, x, y)) != Some(1)).count();
            });
            ensure(miscounted == 0, || format!("{miscounted} pixels of face {face}: {camera:?}"))?;
        }
        ensure(painted.is_empty(), || format!("pieces beyond their faces: {camera:?}"))?;
        self.pictures += 1;
        self.covered += result.covered;
        self.contested += result.contested;
        let is_moving = |face: &&u32| **face != u32::MAX && **face as usize >= tree.faces().len();
        self.moving += truth.image().faces().iter().filter(is_moving).count();
        Ok(())
    }

    /// Asserts at least this many pictures, pixels, and pixels that show moving polygons. At most a tenth may
    /// be contested.
    pub(crate) fn assert_floor(&self, pictures: usize, covered: usize, moving: usize) {
        let is_enough = self.pictures >= pictures && self.covered >= covered;
        assert!(
            is_enough && self.moving >= moving && self.contested * 10 < self.covered,
            "{self:?}"
        );
    }
}

/// Returns the order as a list. Returns an error unless all forms agree, each number occurs once, and the
/// tree's fragments are in the tree's order.
fn forms(tree: &BspTree, overlay: &Overlay, camera: &Camera) -> Result<Vec<u32>, String> {
    let viewpoint = camera.viewpoint();
    let (mut order, mut still, mut near) = (vec![7], Vec::new(), Vec::new());
    let error = |error: binspace::Error| error.to_string();
    overlay.order(tree, viewpoint).map_err(error)?.write_into(&mut order);
    overlay.order(tree, viewpoint).map_err(error)?.front_to_back().write_into(&mut near);
    tree.back_to_front_into(viewpoint, &mut still);
    let of_tree = order.iter().copied().filter(|&number| (number as usize) < tree.len());
    ensure(of_tree.eq(still), || "the tree's fragments come in another order".into())?;
    let mut sorted = order.clone();
    sorted.sort_unstable();
    let count = (tree.len() + overlay.len()) as u32;
    ensure(sorted.into_iter().eq(0..count), || "not every number comes once".into())?;
    ensure(near.iter().rev().eq(&order), || "front to back is not the reverse".into())?;
    let number = |shape: Shape<'_>| shape.index();
    let far_first = overlay.order(tree, viewpoint).map_err(error)?.into_iter();
    let near_first = overlay.order(tree, viewpoint).map_err(error)?.front_to_back();
    ensure(far_first.len() == order.len(), || "another length".into())?;
    ensure(far_first.map(number).eq(order.iter().copied()), || "another back to front".into())?;
    ensure(near_first.into_iter().map(number).eq(near), || "another front to back".into())?;
    Ok(order)
}

/// Checks that the pieces of every moving face have exactly the area of the face. Returns the number of
/// faces.
pub(crate) fn areas(tree: &BspTree, overlay: &Overlay) -> Result<usize, String> {
    let faces = overlay.faces();
    let first = tree.faces().len() as u32;
    let models: Vec<Face> =
        (first..faces.len() as u32).map(|face| Face::new(faces, face)).collect();
    let mut sums: Vec<Option<Point>> = vec![None; models.len()];
    for number in tree.len()..tree.len() + overlay.len() {
        let piece = overlay.piece(number as u32).expect("a piece");
        let at = (piece.face() - first) as usize;
        let points: Vec<Point> =
            piece.vertex_ids().map(|vertex_id| models[at].resolve(faces, vertex_id)).collect();
        let area = rational::area(&points);
        // Pieces have the orientation of their face, so areas do not cancel.
        let along = rational::scalar(&area, &models[at].plane.normal);
        ensure(rational::sign(&along).is_gt(), || format!("piece {number} is turned over"))?;
        sums[at] =
            Some(sums[at].as_ref().map_or_else(|| area.clone(), |sum| rational::sum(sum, &area)));
    }
    for (model, sum) in models.iter().zip(sums) {
        let corners = &model.corners;
        ensure(sum == Some(rational::area(corners)), || format!("another area: {corners:?}"))?;
    }
    Ok(models.len())
}

/// Checks that two overlays have the same pieces, so that earlier contents leave no trace.
pub(crate) fn same(tree: &BspTree, overlays: [&Overlay; 2]) -> Verdict {
    let [bytes, others] = overlays.map(|overlay| overlay.faces().memory_usage());
    ensure(bytes == others, || format!("faces of {bytes} and {others} bytes"))?;
    for number in 0..=(tree.len() + overlays[0].len()) as u32 {
        let [piece, other] = overlays.map(|overlay| {
            let piece = overlay.piece(number)?;
            let vertices: Vec<_> = piece.vertices().zip(piece.weights()).collect();
            let edges: Vec<_> = piece.edges().zip(piece.lines()).collect();
            Some((piece.index(), piece.polygon(), vertices, edges))
        });
        let is_piece = (tree.len()..tree.len() + overlays[0].len()).contains(&(number as usize));
        ensure(piece == other && piece.is_some() == is_piece, || format!("piece {number}"))?;
    }
    Ok(())
}
