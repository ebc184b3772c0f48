//! The hits of a ray, the nearest first.

use std::collections::BTreeMap;
use std::iter::FusedIterator;

use smallvec::SmallVec;

use super::found::Found;
use super::hit::Hit;
use super::meeting::{Depth, Meeting};
use super::probe::Probe;
use super::walk::Walk;
use crate::ray::Ray;
use crate::tree::{Bounds, BspTree};

/// The hits of a ray, the nearest first: [`BspTree::hits`].
///
/// It searches only as far along the ray as the next hit requires. Nothing is allocated
/// unless dozens of parts of the tree, or more than eight fragments at one place, are pending at once.
#[derive(Clone, Debug)]
pub struct Hits<'t> {
    tree: &'t BspTree,
    ray: Ray,
    /// None if the ray meets nothing.
    search: Option<Search<'t>>,
}

#[derive(Clone, Debug)]
struct Search<'t> {
    probe: Probe,
    walk: Walk<'t>,
    /// What the ray meets of what it has come to.
    found: Found,
    reached: Reached,
}

/// For each polygon hit so far, the depth at which the hit ends.
#[derive(Clone, Debug, Default)]
struct Reached {
    /// The last few.
    few: SmallVec<[(usize, Depth); FEW]>,
    /// Others that may have gone on when there were more than a few.
    many: BTreeMap<usize, Depth>,
}

/// How many polygons at one place are looked through one by one. Smaller: more rays need a map, and
/// allocate. Larger: looking through them takes longer than a map.
const FEW: usize = 8;

impl Reached {
    /// Where what was hit of a polygon ends. Those that end before a depth may be forgotten.
    fn get(&mut self, polygon: usize, from: &Depth) -> Option<&mut Depth> {
        self.few.retain(|(_, end)| end.high >= from.low);
        match self.few.iter_mut().find(|(of, _)| *of == polygon) {
            Some((_, end)) => Some(end),
            None => self.many.get_mut(&polygon),
        }
    }

    fn insert(&mut self, polygon: usize, end: Depth) {
        if self.few.len() == FEW {
            self.many.extend(self.few.drain(..));
        }
        self.few.push((polygon, end));
    }
}

impl Search<'_> {
    /// The next fragment that the ray meets.
    fn next(&mut self, tree: &BspTree) -> Option<Meeting> {
        let Self { probe, walk, found, .. } = self;
        loop {
            // What comes no nearer than the nearest that is found need not be looked at.
            let limit = found.first().map_or(f64::INFINITY, |nearest| nearest.enter.high);
            let Some(fragment) = walk.next(limit) else { return found.pop(probe, &tree.faces) };
            let fragment = tree.fragment(fragment);
            if let Some(meeting) = Meeting::new(probe, &fragment, &tree.faces) {
                found.push(meeting, probe, &tree.faces);
            }
        }
    }

    /// Whether a meeting is a hit, rather than more of what was hit.
    fn is_new(&mut self, tree: &BspTree, meeting: &Meeting) -> bool {
        let Self { probe, reached, .. } = self;
        let polygon = tree.faces.polygon(meeting.face);
        let Some(end) = reached.get(polygon, &meeting.enter) else {
            reached.insert(polygon, meeting.leave);
            return true;
        };
        let is_apart = end.compare(&meeting.enter, probe, &tree.faces).is_lt();
        if is_apart || end.compare(&meeting.leave, probe, &tree.faces).is_lt() {
            *end = meeting.leave;
        }
        is_apart
    }
}

impl<'t> Hits<'t> {
    fn new(tree: &'t BspTree, bounds: Option<&'t Bounds>, ray: Ray) -> Self {
        let search = Probe::new(ray, tree.faces.lattice()).map(|probe| Search {
            walk: Walk::new(tree, bounds, &probe),
            probe,
            found: Found::default(),
            reached: Reached::default(),
        });
        Self { tree, ray, search }
    }
}

impl<'t> Iterator for Hits<'t> {
    type Item = Hit<'t>;

    fn next(&mut self) -> Option<Hit<'t>> {
        let search = self.search.as_mut()?;
        let meeting = loop {
            let meeting = search.next(self.tree)?;
            if search.is_new(self.tree, &meeting) {
                break meeting;
            }
        };
        let Meeting { fragment, enter, facing, .. } = meeting;
        Some(Hit { tree: self.tree, ray: self.ray, fragment, spot: enter.spot, facing })
    }
}

impl FusedIterator for Hits<'_> {}

impl BspTree {
    /// What a ray or a segment hits, the nearest first. The first hit is the nearest polygon.
    ///
    /// ```
    /// use binspace::{BspTree, Ray};
    ///
    /// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    /// let tree = BspTree::build([square(0.0), square(2.0), square(1.0)])?;
    ///
    /// let down = Ray::new([0.5, 0.5, 9.0], [0.0, 0.0, -1.0]);
    /// let nearest = tree.hits(down).next().expect("a hit");
    /// assert_eq!((nearest.polygon(), nearest.parameter()), (1, 7.0));
    /// assert_eq!(nearest.point().to_array(), [0.5, 0.5, 2.0]);
    /// // It is hit from its front.
    /// assert!(nearest.facing().is_gt());
    /// // All of them, and those of a segment.
    /// assert!(tree.hits(down).map(|hit| hit.polygon()).eq([1, 2, 0]));
    /// let segment = Ray::between([0.5, 0.5, 1.0], [0.5, 0.5, 0.5]);
    /// assert!(tree.hits(segment).map(|hit| hit.polygon()).eq([2]));
    /// # Ok::<(), binspace::Error>(())
    /// ```
    ///
    /// # What is a hit
    ///
    /// Polygons are as the tree has them: corners on its grid, and moved onto the polygon's plane if
    /// they were off it by less than the tolerance. Their edges and corners belong to them, and both
    /// ends belong to a segment, as its beginning does to a ray. What a ray and a polygon have in common
    /// are points and segments, and each of these is one hit, at its nearest point. So
    ///
    /// - a ray through an edge that several polygons share, or through a corner, hits all of them
    ///   there, and each once, however the tree has cut it;
    /// - a ray that lies in the plane of a polygon hits it where it enters it, or where the ray begins if
    ///   that is inside, and is then [`facing`](Hit::facing) neither side. It is no second hit where
    ///   it leaves, nor where it goes from one fragment of the polygon to another;
    /// - only a polygon that is not convex, or not planar, can be hit more than once.
    ///
    /// Hits at the same point come in input order. All of this is exact: which polygons are hit, in which
    /// order, and from which side. So hits do not depend on how a tree was built.
    ///
    /// It takes time for the nodes whose regions the ray crosses, as far as it is read, and for the fragments
    /// on the planes where it crosses them. These regions extend into empty space: for many rays in
    /// a large scene, make [`Bounds`] once and ask [`Bounds::hits`]. Where k fragments are met at one place,
    /// as in a stack of coplanar polygons, that adds O(k log k) for all of them, and the first is
    /// there after O(k log k) in the worst case, O(k) if they are met in input order.
    pub fn hits(&self, ray: Ray) -> Hits<'_> {
        Hits::new(self, None, ray)
    }
}

impl Bounds {
    /// What a ray or a segment hits, the nearest first: the same as [`BspTree::hits`], with the boxes of
    /// the tree, so that what the ray passes by is left out as a whole. In scenes of thousands of polygons
    /// that is several times as fast.
    ///
    /// ```
    /// use binspace::{BspTree, Ray, scene};
    ///
    /// let tree = BspTree::build(scene::terrain(5000, 1).polygons())?;
    /// // Once.
    /// let bounds = tree.bounds()?;
    /// // For each ray.
    /// let ray = Ray::new([20.3, 30.1, 90.0], [0.01, 0.02, -1.0]);
    /// let nearest = bounds.hits(&tree, ray).next().expect("a hit");
    /// assert_eq!(tree.hits(ray).next().map(|hit| hit.polygon()), Some(nearest.polygon()));
    /// # Ok::<(), binspace::Error>(())
    /// ```
    ///
    /// # Panics
    ///
    /// If the bounds are those of another tree.
    pub fn hits<'t>(&'t self, tree: &'t BspTree, ray: Ray) -> Hits<'t> {
        self.expect(tree);
        Hits::new(tree, Some(self), ray)
    }
}
