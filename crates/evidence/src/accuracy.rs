//! Compares a tree's fragments with their exact definitions.

use std::cmp::Ordering;

use crate::residue::Residue;
use crate::tree::{KernelTree, Visit};
use binspace::internals::{Exact, ExactSplitter, Kernel, Plane, PlaneId, PlaneKind, Side, Symbol};

/// The errors of the vertices of a tree's fragments, and the number of those on a wrong side; see
/// [`accuracy`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Accuracy {
    /// Vertices of all fragments.
    pub vertices: usize,
    /// Vertices that by their definition are on the other side of a partition plane than their
    /// fragment was put, or off a plane that it was put on, by more than the tolerance.
    pub misplaced: usize,
    /// Vertices without a position, because the planes that define them are parallel.
    pub undefined: usize,
    /// Faces whose fragments do not add up to the face's own area, by the definitions of their
    /// vertices, exactly (but for odds of 2⁻⁶¹ that a difference goes unseen).
    pub torn: usize,
    /// The largest difference between a vertex's coordinate and the exact one, in units of the
    /// scene's lattice, 2⁻⁵² to 2⁻⁵⁰ of the extent: units in the last place of a coordinate at the
    /// scene's rim.
    pub drift_max: f64,
    /// The mean over all vertices of the largest such difference among the vertex's coordinates.
    pub drift_mean: f64,
}

/// In lattice units. Larger: vertices that are moved back that far are off by more than a rounding;
/// smaller: time for integers.
const NEAR: f64 = (1u64 << 40) as f64;

/// A plane on the way to a fragment, and where the fragment was put.
struct Above {
    id: PlaneId,
    splitter: ExactSplitter,
    plane: Plane,
    /// The tolerance times the length of the normal, an integer.
    band: f64,
    side: Side,
}

/// Compares every vertex with its definition, and its definition with every plane above it, in
/// exact arithmetic, whatever the kernel: O(n · mean depth).
///
/// The exact kernel misplaces nothing, and its vertices are off only by their last rounding. This
/// function uses the kernel's own integers; tests count the same in rationals, on hard scenes of up
/// to some hundred faces.
pub fn accuracy<K: Kernel>(tree: &KernelTree<K>) -> Accuracy {
    let mut result = Accuracy::default();
    let mut path: Vec<Above> = Vec::new();
    let mut sum = 0.0;
    for visit in tree.walk() {
        tree.extend_path(&mut path, &visit);
        for (range, side) in
            [(visit.on, Side::Coplanar), (visit.front, Side::Front), (visit.back, Side::Back)]
        {
            if let Some(last) = path.last_mut() {
                last.side = side;
            }
            range.for_each(|fragment| tree.judge(fragment, &path, &mut result, &mut sum));
        }
    }
    result.torn = tree.torn_faces();
    result.drift_mean = sum / result.vertices.max(1) as f64;
    result
}

impl<K: Kernel> KernelTree<K> {
    /// The number of faces whose area is not the sum of their fragments' areas.
    fn torn_faces(&self) -> usize {
        // For each face the sum of its fragments' areas; none if a vertex has no place.
        let mut sums = vec![Some(Residue::ZERO); self.faces().len()];
        let axis = |face| self.faces().plane(PlaneId::face(face)).main_axis();
        for fragment in 0..self.len() as u32 {
            let face = self.face(fragment);
            let area = self.twice_area(face, axis(face), self.symbols(fragment));
            let sum = &mut sums[face as usize];
            *sum = sum.zip(area).map(|(sum, area)| sum.plus(area));
        }
        let is_torn = |(face, sum): (u32, Option<Residue>)| {
            let corners = 0..self.faces().corners(face).len() as u32;
            sum != self.twice_area(face, axis(face), corners.map(Symbol::corner))
        };
        (0..).zip(sums).filter(|&sum| is_torn(sum)).count()
    }

    /// Twice the area of a polygon, seen along an axis.
    fn twice_area(
        &self,
        face: u32,
        axis: usize,
        symbols: impl Iterator<Item = Symbol>,
    ) -> Option<Residue> {
        let place = |symbol| Residue::place(self.faces(), face, symbol, axis);
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
        let id = visit.plane;
        let plane = self.faces().plane(id);
        let length = match id.kind() {
            PlaneKind::Face(_) => plane.normal_f64().length(),
            PlaneKind::Axis(..) => 1.0,
        };
        let band = (self.faces().tolerance() * length).floor();
        let splitter = Exact.splitter(self.faces(), id);
        path.push(Above { id, splitter, plane, band, side: Side::Coplanar });
    }

    fn judge(&self, id: u32, path: &[Above], result: &mut Accuracy, sum: &mut f64) {
        let face = self.face(id);
        for (symbol, position) in self.symbols(id).zip(self.lattice_vertices(id)) {
            result.vertices += 1;
            let Some(drift) = self.faces().drift(face, symbol, position) else {
                result.undefined += 1;
                continue;
            };
            let size = drift.iter().fold(0.0, |max: f64, c| max.max(c.abs()));
            *sum += size;
            result.drift_max = result.drift_max.max(size);
            // A long way is rounded by more than the filter allows for.
            let place = (size < NEAR).then(|| std::array::from_fn(|i| position[i] - drift[i]));
            let own = PlaneId::face(face);
            let wrong = |above: &Above| self.is_misplaced(above, own, face, symbol, place);
            result.misplaced += usize::from(path.iter().any(wrong));
        }
    }

    /// Whether a vertex, by its definition, is not where its fragment was put; `place` is the
    /// vertex within the error that the exact kernel's filter allows for, if that is known.
    fn is_misplaced(
        &self,
        above: &Above,
        own: PlaneId,
        face: u32,
        symbol: Symbol,
        place: Option<[f64; 3]>,
    ) -> bool {
        if above.plane_is(own) {
            return above.side != Side::Coplanar;
        }
        let slack = Exact::slack(&above.splitter);
        let s = place.map_or(0.0, |place| Exact::distance(&above.splitter, place));
        let exactly =
            |threshold| self.faces().compare(above.id, &above.plane, face, symbol, threshold);
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
        self.id == id
    }
}
