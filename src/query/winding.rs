//! Inside or outside: winding numbers of closed bodies.

use std::cmp::Ordering;

use glam::DVec3;

use crate::error::{Error, Kind};
use crate::exact::eye::ExactRay;
use crate::exact::{Faces, LATTICE_LIMIT, Plane, PlaneId, chain, integers};
use crate::tree::{BspTree, Flat};
use crate::viewpoint::Ray;

/// Boxes are treated as wider by this length, in units of 2⁵¹ lattice steps. The length exceeds the rounding
/// of the point. Too small: faces above the point are missed. Too large: more faces are examined.
const MARGIN: f64 = 1e-6;

impl BspTree {
    /// Returns how many times the polygons wind around a point: 0 outside, 1 inside a body whose fronts face
    /// outwards, 2 where two bodies overlap, −1 inside a body whose fronts face inwards. `None` for a point
    /// on the boundary; `hits(Ray::between(point, point))` returns the polygons that contain the point.
    ///
    /// Bodies may intersect themselves and each other, and may be nested. The number is exact for the given
    /// point. (Exception: the point is closer than the tolerance to a polygon that was
    /// [flattened](crate::Preparation::flattened), which means that the tolerance moved a corner.) A point
    /// with a NaN or infinite coordinate is outside.
    ///
    /// ```
    /// use binspace::BspTree;
    ///
    /// let [a, b, c, d] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    /// let tree = BspTree::build([[a, c, b], [a, b, d], [a, d, c], [b, c, d]])?;
    /// assert_eq!(tree.winding_number([0.1, 0.2, 0.3])?, Some(1));
    /// assert_eq!(tree.winding_number([1.0, 1.0, 1.0])?, Some(0));
    /// assert_eq!(tree.winding_number([0.0, 0.25, 0.25])?, None);
    ///
    /// let open = BspTree::build([[a, c, b], [a, b, d], [a, d, c]])?;
    /// let error = open.winding_number([0.1, 0.2, 0.3]).unwrap_err();
    /// assert_eq!(error.polygon(), Some(0));
    /// # Ok::<(), binspace::Error>(())
    /// ```
    ///
    /// The first call takes O(n log n) time to sort all edges and to check that the bodies are closed. Each
    /// call takes time proportional to the number of fragments whose bounding boxes meet a ray from the point
    /// in the direction of +z.
    ///
    /// The winding number is the signed number of crossings of this ray and the polygons. If the ray meets an
    /// edge, the ray is moved by an infinitesimal step (H. Edelsbrunner and E. Mücke, "Simulation of
    /// simplicity", 1990).
    ///
    /// # Errors
    ///
    /// - The tree is the tree of a cell of a [`partition`](crate::partition).
    /// - A body is not closed: it has an [open edge](Self::open_edges). The error names the edge's polygon.
    pub fn winding_number(&self, point: impl Into<DVec3>) -> Result<Option<i32>, Error> {
        let point = point.into();
        if self.is_of_cell() {
            return Err(Kind::OfCell.error());
        }
        if let Some(&[face, k]) = self.open_edges_of_faces().first() {
            let corner = self.faces.corner_number(face, k) as usize;
            return Err(Kind::OpenEdge(corner).of_polygon(self.faces.polygon(face)));
        }
        let here = Ray::between(point, point);
        if self.hits(here).next().is_some() {
            return Ok(None);
        }
        let Some(exact) = ExactRay::new(here, self.faces.lattice()) else { return Ok(Some(0)) };
        let faces = self.faces_above(point).into_iter();
        Ok(Some(faces.map(|face| winding_below(&self.faces, face, &exact)).sum()))
    }

    /// Returns the open edges of bodies, in the order of polygons: the index of the polygon, and the number
    /// of the corner where the edge begins. An edge is *open* if, along some part of the edge, more edges of
    /// polygons run in the direction of the open edge than in the opposite direction. So of equal edges, all
    /// are open or none. In a closed body, no edge is open. The first call takes O(n log n) time and stores the result.
    pub fn open_edges(&self) -> impl ExactSizeIterator<Item = (usize, usize)> {
        self.open_edges_of_faces().iter().map(|&[face, k]| {
            (self.faces.polygon(face), self.faces.corner_number(face, k) as usize)
        })
    }

    /// The open edges, each as the number of the face and the number of the edge in that face.
    fn open_edges_of_faces(&self) -> &[[u32; 2]] {
        self.open_edges.get_or_init(|| open_edges(&self.faces))
    }

    /// The faces with a box that reaches above a point, each once. The list includes all faces that a ray
    /// from the point along z crosses.
    fn faces_above(&self, point: DVec3) -> Vec<u32> {
        let unit = 1.0 / LATTICE_LIMIT;
        let [x, y, z] = self.faces.lattice().to_lattice(point).map(|c| c * unit);
        let margin = MARGIN + self.faces.tolerance() * unit;
        let is_apart = |bounds: &Flat| {
            let [low_x, low_y, _, high_x, high_y, high_z] = bounds.map(f64::from);
            low_x - x > margin
                || x - high_x > margin
                || low_y - y > margin
                || y - high_y > margin
                || z - high_z > margin
        };
        let (bounds, mut run) = (self.boxes(), 0..self.len() as u32);
        let mut faces = Vec::new();
        while let Some((block, _)) =
            bounds.next_block(&mut run, |bounds| is_apart(bounds).then_some(false))
        {
            faces.extend(block.map(|fragment| self.records[fragment as usize].face));
        }
        faces.sort_unstable();
        faces.dedup();
        faces
    }
}

/// Returns how many times a face winds around the ray along z from a point, if the face is above the point;
/// otherwise 0.
fn winding_below(faces: &Faces, face: u32, point: &ExactRay) -> i32 {
    // Corners as given, which neighbours share: so no ray slips between them.
    let corners: Vec<[f64; 3]> =
        faces.corner_range(face).map(|corner| faces.given_corner(corner as u32)).collect();
    let is_above = |corner: [f64; 3]| point.at(&Plane::axis(1, corner)).start().is_lt();
    let mut winding = 0;
    for (k, &a) in corners.iter().enumerate() {
        let b = corners[if k + 1 == corners.len() { 0 } else { k + 1 }];
        // The ray is moved by ε in x and by ε² in y, so a corner beside it counts as below.
        let rises = is_above(b);
        if rises == is_above(a) {
            continue;
        }
        let side = point.at(&Plane::upright(a, b, 2)).start();
        // The front of a rising edge's plane is the side of larger x.
        let is_right = if side.is_eq() || rises { side.is_ge() } else { side.is_lt() };
        if !is_right {
            winding += if rises { 1 } else { -1 };
        }
    }
    if winding == 0 {
        return 0;
    }
    // If the given corners wind around the ray but the moved corners do not, the face's plane may meet the
    // ray anywhere. So corners decide for a point above or below all corners.
    let is_below_of = |&corner: &[f64; 3]| point.at(&Plane::axis(2, corner)).start().is_lt();
    let below = corners.iter().filter(|&corner| is_below_of(corner)).count();
    let plane = faces.plane(PlaneId::face(face));
    let is_below = match plane.normal()[2].cmp(&0) {
        _ if below == 0 || below == corners.len() => below > 0,
        Ordering::Greater => point.at(&plane).start().is_lt(),
        Ordering::Less => point.at(&plane).start().is_gt(),
        Ordering::Equal => false,
    };
    if is_below { winding } else { 0 }
}

/// The open edges of faces, each as a face and a number.
fn open_edges(faces: &Faces) -> Vec<[u32; 2]> {
    let mut edges = Vec::with_capacity(faces.corner_count());
    for face in 0..faces.len() as u32 {
        let range = faces.corner_range(face);
        let corner =
            |k: usize| integers(faces.given_corner((range.start + k % range.len()) as u32));
        edges.extend((0..range.len()).map(|k| (corner(k), corner(k + 1), [face, k as u32])));
    }
    chain::open_edges(edges)
}
