//! How far a tree is from what it should be: its fragments against their exact definitions.

use std::cmp::Ordering;

use super::BspTree;
use super::walk::{Visit, Walk};
use crate::geom::{Exact, ExactSplitter, Kernel, Plane, PlaneId, PlaneKind, Residue, Side, Symbol};

/// What the vertices of a tree's fragments are off by, and how many of them are on a wrong side;
/// see [`BspTree::accuracy`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Accuracy {
    /// Vertices of all fragments.
    pub vertices: usize,
    /// Vertices that by their definition are on the other side of a partition plane than their
    /// fragment was put, or off a plane that it was put on, by more than the tolerance.
    pub misplaced: usize,
    /// Vertices that have no place, because what they are defined by is parallel.
    pub undefined: usize,
    /// Faces whose fragments do not add up to the face's own area, by the definitions of their
    /// vertices, exactly (but for odds of 2⁻⁶¹ that a difference goes unseen).
    pub torn: usize,
    /// The largest difference between a vertex's coordinate and the exact one, in units of the
    /// scene's lattice, 2⁻⁵² to 2⁻⁵⁰ of the extent: units in the last place of a coordinate at the
    /// scene's rim.
    pub drift_max: f64,
    /// The mean of that difference over all vertices, of each the largest of its coordinates.
    pub drift_mean: f64,
}

/// A plane on the way to a fragment, and where the fragment was put.
struct Above {
    splitter: ExactSplitter,
    plane: Plane,
    /// The tolerance times the length of the normal, an integer.
    band: f64,
    side: Side,
}

impl<K: Kernel> BspTree<K> {
    /// Holds every vertex against its definition, and its definition against every plane above
    /// it, in exact arithmetic, whatever the kernel: O(n · mean depth).
    ///
    /// The exact kernel misplaces nothing, and its vertices are off by their last rounding alone.
    pub fn accuracy(&self) -> Accuracy {
        let mut result = Accuracy::default();
        let mut path: Vec<Above> = Vec::new();
        let mut walk = Walk::new(self);
        let mut sum = 0.0;
        while let Some(visit) = walk.next(self) {
            self.extend_path(&mut path, &visit);
            for (range, side) in
                [(visit.own, Side::Coplanar), (visit.front, Side::Front), (visit.back, Side::Back)]
            {
                if let Some(last) = path.last_mut() {
                    last.side = side;
                }
                range.for_each(|fragment| self.judge(fragment, &path, &mut result, &mut sum));
            }
        }
        result.torn = self.torn_faces();
        result.drift_mean = sum / result.vertices.max(1) as f64;
        result
    }

    /// How many faces are not the sum of their fragments.
    fn torn_faces(&self) -> usize {
        // For each face the sum of its fragments' areas less its own; none if a vertex has no place.
        let mut rest = vec![Some(Residue::ZERO); self.faces.len()];
        let axis = |face| self.faces.plane(PlaneId::face(face)).main_axis();
        for fragment in self.fragments().filter(|fragment| !fragment.is_whole()) {
            let face = fragment.face();
            let symbols = fragment.stored().iter().map(K::symbol);
            let area = self.twice_area(face, axis(face), symbols);
            let sum = &mut rest[face as usize];
            *sum = sum.zip(area).map(|(sum, area)| sum.plus(area));
        }
        let mut seen = vec![false; self.faces.len()];
        self.fragments().for_each(|fragment| seen[fragment.face() as usize] = true);
        let is_torn = |&face: &u32| {
            let index = face as usize;
            let corners = 0..self.faces.corners(face).len() as u32;
            let own = || self.twice_area(face, axis(face), corners.map(Symbol::corner));
            // Without a piece that is cut, it is there as a whole.
            !seen[index] || rest[index] != Some(Residue::ZERO) && rest[index] != own()
        };
        (0..self.faces.len() as u32).filter(is_torn).count()
    }

    /// Twice the area of a polygon, seen along an axis.
    fn twice_area(
        &self,
        face: u32,
        axis: usize,
        symbols: impl Iterator<Item = Symbol>,
    ) -> Option<Residue> {
        let place = |symbol| self.faces.place_residues(face, symbol, axis);
        let places: Vec<[Residue; 2]> = symbols.map(place).collect::<Option<_>>()?;
        let cross = |k: usize| {
            let ([a, b], [c, d]) = (places[k], places[(k + 1) % places.len()]);
            a.times(d).minus(b.times(c))
        };
        Some((0..places.len()).fold(Residue::ZERO, |sum, k| sum.plus(cross(k))))
    }

    fn extend_path(&self, path: &mut Vec<Above>, visit: &Visit) {
        path.truncate(visit.depth - 1);
        if let Some(parent) = path.last_mut() {
            parent.side = if visit.is_front { Side::Front } else { Side::Back };
        }
        let id = self.nodes[visit.node].plane;
        let plane = self.faces.plane(id);
        let length = match id.kind() {
            PlaneKind::Face(_) => plane.normal_f64().length(),
            PlaneKind::Axis(..) => 1.0,
        };
        let band = (self.faces.tolerance() * length).floor();
        let splitter = Exact.splitter(&self.faces, id);
        path.push(Above { splitter, plane, band, side: Side::Coplanar });
    }

    fn judge(&self, id: u32, path: &[Above], result: &mut Accuracy, sum: &mut f64) {
        let fragment = self.fragment(id);
        let (face, stored) = (fragment.face(), fragment.stored());
        for (k, position) in fragment.lattice_vertices().enumerate() {
            result.vertices += 1;
            let symbol = stored.get(k).map_or(Symbol::corner(k as u32), K::symbol);
            let Some(drift) = self.faces.drift(face, symbol, position) else {
                result.undefined += 1;
                continue;
            };
            let size = drift.iter().fold(0.0, |max: f64, c| max.max(c.abs()));
            *sum += size;
            result.drift_max = result.drift_max.max(size);
            let place = std::array::from_fn(|i| position[i] - drift[i]);
            let own = PlaneId::face(face);
            let wrong = |above: &Above| self.is_misplaced(above, own, face, symbol, place);
            result.misplaced += usize::from(path.iter().any(wrong));
        }
    }

    /// Whether a vertex, by its definition, is not where its fragment was put; `place` is the
    /// vertex within the error that the exact kernel's filter allows for.
    fn is_misplaced(
        &self,
        above: &Above,
        own: PlaneId,
        face: u32,
        symbol: Symbol,
        place: [f64; 3],
    ) -> bool {
        if above.plane_is(own) {
            return above.side != Side::Coplanar;
        }
        let (s, slack) = (Exact::distance(&above.splitter, place), Exact::slack(&above.splitter));
        let exactly = |threshold| self.faces.compare(&above.plane, face, symbol, threshold);
        let beyond = |threshold: f64, order: Ordering| {
            if s.abs() > slack { s.total_cmp(&0.0) == order } else { exactly(threshold) == order }
        };
        let in_front = || beyond(above.band, Ordering::Greater);
        let behind = || beyond(-above.band, Ordering::Less);
        match above.side {
            Side::Front => behind(),
            Side::Back => in_front(),
            Side::Coplanar | Side::Spanning => in_front() || behind(),
        }
    }
}

impl Above {
    /// Whether it is the plane of a face.
    fn plane_is(&self, id: PlaneId) -> bool {
        self.splitter.plane() == id
    }
}
