//! The hits of a ray, nearest first; occlusion; and the properties of a hit.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::iter::FusedIterator;

use glam::DVec3;
use smallvec::SmallVec;

use super::ray::{Depth, Interval, RayQuery, Spot};
use super::walk::{Boxes, Walk};
use crate::exact::Faces;
use crate::exact::eye::{ExactRay, Parameter};
use crate::tree::bounds::Bounds;
use crate::tree::parts::Stored;
use crate::tree::{BspTree, Fragment};
use crate::viewpoint::{Facing, Ray};

/// The fragments that rays may meet: a tree's fragments, and the pieces of an overlay. Pieces are numbered
/// after the tree's fragments.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Targets<'t> {
    pub(crate) tree: &'t BspTree,
    pub(crate) pieces: Option<Pieces<'t>>,
}

/// Pieces of an overlay.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pieces<'t> {
    /// The tree's faces, then the faces of the pieces.
    pub(crate) faces: &'t Faces,
    pub(crate) stored: Stored<'t>,
    pub(crate) bounds: &'t Bounds,
}

impl<'t> Targets<'t> {
    fn faces(&self) -> &'t Faces {
        self.pieces.map_or(&self.tree.faces, |pieces| pieces.faces)
    }

    fn fragment(&self, number: u32) -> Fragment<'t> {
        match (self.pieces, (number as usize).checked_sub(self.tree.len())) {
            (Some(Pieces { faces, stored, .. }), Some(piece)) => {
                Fragment::new(faces, stored, piece, number)
            }
            _ => self.tree.fragment(number),
        }
    }

    /// The pieces of polygons that a ray may meet.
    fn pieces_near(self, query: &RayQuery) -> impl Iterator<Item = Fragment<'t>> {
        let boxes = self.pieces.and_then(|pieces| Boxes::new(query, pieces.bounds));
        let count = self.pieces.map_or(0, |pieces| pieces.stored.records.len() as u32);
        let (mut run, first) = (0..count, self.tree.len() as u32);
        let span = [0.0, if query.is_endless { f64::INFINITY } else { 1.0 }];
        let next = move || match &boxes {
            Some(boxes) => boxes.next(&mut run, span),
            None => run.next(),
        };
        let thin = self.faces().first_thin();
        let pieces = std::iter::from_fn(next).map(move |piece| self.fragment(first + piece));
        pieces.filter(move |piece| (piece.face() as usize) < thin)
    }

    pub(crate) fn hits(self, ray: Ray) -> Hits<'t> {
        let faces = self.faces();
        let search = RayQuery::new(ray, faces.lattice()).map(|query| {
            let mut found = HitQueue::default();
            for piece in self.pieces_near(&query) {
                if let Some(interval) = Interval::new(&query, &piece, faces) {
                    found.push(interval, &query, faces);
                }
            }
            let walk = Walk::new(self.tree, &query);
            Search { query, walk, found, last: None, ends: BTreeMap::new() }
        });
        Hits { targets: self, ray, search }
    }

    pub(crate) fn is_occluded(self, ray: Ray) -> bool {
        let faces = self.faces();
        let Some(query) = RayQuery::new(ray, faces.lattice()) else { return false };
        let occludes = |fragment: Fragment<'_>| {
            Interval::new(&query, &fragment, faces)
                .is_some_and(|interval| interval.has_inner_point(&query, faces))
        };
        let mut walk = Walk::new(self.tree, &query);
        let mut fragments = std::iter::from_fn(|| walk.next(f64::INFINITY));
        self.pieces_near(&query).any(occludes)
            || fragments.any(|fragment| occludes(self.tree.fragment(fragment)))
    }
}

/// The hits of a ray, nearest first: [`BspTree::hits`], [`Overlay::hits`](crate::overlay::Overlay::hits).
#[derive(Clone, Debug)]
pub(crate) struct Hits<'t> {
    targets: Targets<'t>,
    ray: Ray,
    /// The search along the ray; `None` if the ray certainly meets nothing.
    search: Option<Search<'t>>,
}

#[derive(Clone, Debug)]
struct Search<'t> {
    query: RayQuery,
    walk: Walk<'t>,
    /// The hits found so far that have not been returned.
    found: HitQueue,
    /// The polygon of the last hit, and the end of that hit.
    last: Option<(usize, Depth)>,
    /// The ends of the hits of polygons whose planes contain the ray.
    ends: BTreeMap<usize, Depth>,
}

impl Search<'_> {
    /// The next fragment that the ray meets.
    fn next(&mut self, tree: &BspTree, faces: &Faces) -> Option<Interval> {
        let Self { query, walk, found, .. } = self;
        loop {
            // Fragments behind the nearest hit found need not be tested.
            let limit = found.first().map_or(f64::INFINITY, |nearest| nearest.enter.high);
            let Some(fragment) = walk.next(limit) else { return found.pop(query, faces) };
            let fragment = tree.fragment(fragment);
            if let Some(interval) = Interval::new(query, &fragment, faces) {
                found.push(interval, query, faces);
            }
        }
    }

    /// Whether an interval is a new hit, and does not continue the last hit of its polygon. The intervals of
    /// a polygon at one point follow each other directly. So a hit that is a point need be stored only while
    /// it is the last hit of all. Hits that extend along the ray are stored for each polygon.
    fn is_new(&mut self, faces: &Faces, interval: &Interval) -> bool {
        let Self { query, last, ends, .. } = self;
        let (polygon, Interval { enter, leave, .. }) = (faces.polygon(interval.face), interval);
        let known = ends.get(&polygon).or(match last {
            Some((of, end)) if *of == polygon => Some(end),
            _ => None,
        });
        let is_apart = known.is_none_or(|end| end.compare(enter, query, faces).is_lt());
        if is_apart || known.is_some_and(|end| end.compare(leave, query, faces).is_lt()) {
            if enter.spot == leave.spot && !ends.contains_key(&polygon) {
                *last = Some((polygon, *leave));
            } else {
                ends.insert(polygon, *leave);
            }
        }
        is_apart
    }
}

impl<'t> Iterator for Hits<'t> {
    type Item = Hit<'t>;

    fn next(&mut self) -> Option<Hit<'t>> {
        let Self { targets, ray, search } = self;
        let (search, faces) = (search.as_mut()?, targets.faces());
        let Interval { fragment, enter, facing, .. } = loop {
            let interval = search.next(targets.tree, faces)?;
            if search.is_new(faces, &interval) {
                break interval;
            }
        };
        let fragment = targets.fragment(fragment);
        Some(Hit { fragment, ray: *ray, spot: enter.spot, facing })
    }
}

impl FusedIterator for Hits<'_> {}

impl BspTree {
    /// Returns the hits of a ray or a segment, nearest first. The first hit is the nearest polygon.
    ///
    /// ```
    /// use binspace::{BspTree, Facing, Ray};
    ///
    /// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    /// let tree = BspTree::build([square(0.0), square(2.0), square(1.0)])?;
    ///
    /// let down = Ray::new([0.5, 0.5, 9.0], [0.0, 0.0, -1.0]);
    /// let nearest = tree.hits(down).next().expect("a hit");
    /// assert_eq!((nearest.polygon(), nearest.parameter()), (1, 7.0));
    /// assert_eq!(nearest.point().to_array(), [0.5, 0.5, 2.0]);
    /// // The ray hits its front.
    /// assert!(nearest.facing() == Facing::Front);
    /// // All hits of the ray, and the hits of a segment.
    /// assert!(tree.hits(down).map(|hit| hit.polygon()).eq([1, 2, 0]));
    /// let segment = Ray::between([0.5, 0.5, 1.0], [0.5, 0.5, 0.5]);
    /// assert!(tree.hits(segment).map(|hit| hit.polygon()).eq([2]));
    /// # Ok::<(), binspace::Error>(())
    /// ```
    ///
    /// # Definition of a hit
    ///
    /// Hits are computed with the polygons as stored in the tree: corners are rounded to the tree's
    /// [grid](Self#exactness), and corners that were off the polygon's plane by less than the tolerance are
    /// moved onto the plane. A polygon includes its edges and corners. A segment includes both ends, and a
    /// ray includes its start.
    ///
    /// The intersection of a ray and a polygon consists of points and segments. Each point is one hit. Each
    /// segment is one hit, at the point of the segment that is nearest to the ray's start:
    ///
    /// - A ray through an edge or a corner that several polygons share hits each of these polygons once,
    ///   however the tree has cut these polygons.
    /// - A ray in the plane of a polygon hits the polygon where the ray enters the polygon, or at the ray's
    ///   start if the start is inside the polygon. The [facing](Hit::facing) of the hit is
    ///   [`Facing::EdgeOn`]. There is no second hit where the ray leaves the polygon, or passes from one
    ///   fragment of the polygon to another.
    /// - Only a polygon that is not convex, or not planar, can be hit more than once.
    ///
    /// Hits at the same point are in input order. The set of polygons that are hit, the order of the hits,
    /// and the sides of the polygons are exact. So hits do not depend on how a tree was built.
    ///
    /// # Time
    ///
    /// The iterator searches only as far along the ray as the next hit requires. So time is proportional to
    /// the number of boxes that the ray crosses until you stop reading. The first call computes the boxes, in
    /// O(n) time ([`bounds`](Self::bounds)). If k fragments meet the ray at one point, as in a stack of
    /// coplanar polygons, the hits of these fragments take O(k log k) time in total.
    ///
    /// The iterator usually allocates nothing. It allocates if dozens of parts of the tree, or more than
    /// eight fragments, are pending at once, and if the ray lies in the plane of a polygon.
    pub fn hits(&self, ray: Ray) -> impl FusedIterator<Item = Hit<'_>> + Clone + Debug {
        Targets { tree: self, pieces: None }.hits(ray)
    }
}

/// A hit of a ray on a polygon: [`BspTree::hits`], [`Overlay::hits`](crate::overlay::Overlay::hits).
#[derive(Clone, Copy)]
pub struct Hit<'t> {
    fragment: Fragment<'t>,
    ray: Ray,
    spot: Spot,
    facing: Ordering,
}

impl<'t> Hit<'t> {
    /// Returns the [fragment](Fragment) that the ray hits, for instance for its [normal](Fragment::normal).
    /// If several fragments of the polygon meet at the hit's point, the result is any one of these fragments.
    #[doc(alias = "normal")]
    pub fn fragment(&self) -> Fragment<'t> {
        self.fragment
    }

    /// Returns the index, in input order, of the polygon that is hit.
    pub fn polygon(&self) -> usize {
        self.fragment.polygon()
    }

    /// Returns the side of the fragment that the ray meets, exactly. The result is [`Facing::EdgeOn`] if the
    /// ray lies in the fragment's plane. The side depends only on the ray's direction, even if the ray begins
    /// on the fragment.
    pub fn facing(&self) -> Facing {
        self.facing.into()
    }

    /// Returns the parameter of the hit: the hit's point is at `from + parameter * direction`. The result is
    /// the `f64` nearest to the exact value, or the second nearest if both are about equally near. If the
    /// exact value is too large for `f64`, the result is infinite.
    ///
    /// The distance of the hit from the ray's start is the parameter times the length of the ray's direction.
    /// Each call computes the parameter, in about 0.1 µs.
    #[doc(alias = "distance")]
    #[doc(alias = "t")]
    pub fn parameter(&self) -> f64 {
        let exact = self.exact();
        exact.map_or(f64::NAN, |(ray, t)| ray.parameter(&t))
    }

    /// Returns the point of the hit, rounded like a fragment's vertices: the error of each coordinate is at
    /// most 2⁻⁵¹ of the scene's extent (the longest side of the scene's bounding box) plus one
    /// [step](BspTree#which-tolerance) of `f64`. This bound holds however far away the ray begins and however
    /// small the angle between the ray and the polygon.
    ///
    /// Each call computes the point, in about 0.2 µs.
    pub fn point(&self) -> DVec3 {
        let exact = self.exact();
        exact.map_or(DVec3::NAN, |(ray, t)| self.fragment.faces.lattice().to_world(ray.point(&t)))
    }

    /// Compares the distances of two hits along the same ray: `Less` if this hit is nearer. The comparison is
    /// exact, even if the [parameters](Self::parameter) or [points](Self::point) are rounded to the same
    /// values. The result is meaningless for hits of different rays or trees.
    pub fn compare(&self, other: &Self) -> Ordering {
        match (self.exact(), other.exact()) {
            (Some((_, t)), Some((_, other))) => t.compare(&other),
            _ => Ordering::Equal,
        }
    }

    /// Returns three points p, q and r of the tree's [grid](BspTree::grid) that define the hit's point
    /// exactly: the hit is the point where the ray meets the plane through p, q and r. Usually this plane is
    /// the fragment's plane. For a ray in the fragment's plane, the plane through p, q and r is another
    /// plane, which contains an edge of the fragment.
    ///
    /// `None` if the hit's point is an end of the ray inside the polygon. That end is the start if
    /// [`parameter`](Self::parameter) is 0.
    ///
    /// Let n be the vector product of q − p and r − p. For the ray as given (see [`Ray`]), the exact
    /// parameter is the fraction n·(p − from) / n·direction.
    pub fn grid_points(&self) -> Option<[[i64; 3]; 3]> {
        self.spot.grid_points(self.fragment.faces)
    }

    /// Returns the definition of the point: a plane, usually the face's, and the ray.
    #[doc(hidden)]
    pub fn spot(&self) -> Spot {
        self.spot
    }

    /// The ray in integers, and the parameter; always `Some` for a hit.
    fn exact(&self) -> Option<(ExactRay, Parameter)> {
        let faces = self.fragment.faces;
        let ray = ExactRay::new(self.ray, faces.lattice())?;
        Some((ray, self.spot.parameter(&ray, faces)))
    }
}

impl std::fmt::Debug for Hit<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Hit")
            .field("polygon", &self.polygon())
            .field("fragment", &self.fragment.index())
            .field("parameter", &self.parameter())
            .field("point", &self.point())
            .field("facing", &self.facing())
            .finish()
    }
}

/// A binary heap in which each interval precedes its two children. (The heap of the standard library cannot
/// pass the ray to comparisons.)
///
/// Pushing takes a few comparisons if the interval follows most others. This case is common, because faces
/// hit at one point are found in input order. Popping takes one or two comparisons per level.
#[derive(Clone, Debug, Default)]
struct HitQueue {
    heap: SmallVec<[Interval; 8]>,
}

impl HitQueue {
    /// The nearest interval.
    fn first(&self) -> Option<&Interval> {
        self.heap.first()
    }

    /// Adds an interval: O(log n) comparisons.
    fn push(&mut self, interval: Interval, query: &RayQuery, faces: &Faces) {
        self.heap.push(interval);
        self.rise(self.heap.len() - 1, query, faces);
    }

    /// Removes the nearest interval: O(log n) comparisons.
    fn pop(&mut self, query: &RayQuery, faces: &Faces) -> Option<Interval> {
        if self.heap.len() <= 1 {
            return self.heap.pop();
        }
        let first = self.heap.swap_remove(0);
        // The last interval moves to the bottom without being compared: mostly it belongs there.
        let (mut at, mut below) = (0, 1);
        while below < self.heap.len() {
            let other = below + 1;
            if other < self.heap.len()
                && self.heap[other].compare(&self.heap[below], query, faces).is_lt()
            {
                below = other;
            }
            self.heap.swap(at, below);
            (at, below) = (below, 2 * below + 1);
        }
        self.rise(at, query, faces);
        Some(first)
    }

    /// Moves an interval towards the root of the heap, past all parents that the interval precedes.
    fn rise(&mut self, mut at: usize, query: &RayQuery, faces: &Faces) {
        while at > 0 {
            let above = (at - 1) / 2;
            if self.heap[at].compare(&self.heap[above], query, faces).is_gt() {
                break;
            }
            self.heap.swap(at, above);
            at = above;
        }
    }
}

impl BspTree {
    /// Returns whether a polygon blocks the line of sight between two points: whether the polygon contains a
    /// point of the segment other than the segment's two ends. For an endless ray: whether a polygon contains
    /// a point of the ray other than the ray's start.
    ///
    /// ```
    /// use binspace::{BspTree, Ray};
    ///
    /// let wall = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 0.0, 3.0], [0.0, 0.0, 3.0]];
    /// let tree = BspTree::build([wall])?;
    ///
    /// let eye = [1.0, -2.0, 1.5];
    /// assert!(tree.is_occluded(Ray::between(eye, [1.0, 2.0, 1.5])));
    /// assert!(!tree.is_occluded(Ray::between(eye, [9.0, 2.0, 1.5])));
    /// // A point on the wall is visible.
    /// assert!(!tree.is_occluded(Ray::between(eye, [1.0, 0.0, 1.5])));
    /// # Ok::<(), binspace::Error>(())
    /// ```
    ///
    /// A computed point on a polygon, such as a fragment's vertex or [`Hit::point`](crate::Hit::point), is
    /// rounded. So the point may lie slightly behind the polygon, and then the polygon itself occludes the
    /// point. To test whether such a point is visible, end the segment shortly before the point:
    ///
    /// ```
    /// use binspace::glam::DVec3;
    /// use binspace::{BspTree, Ray};
    ///
    /// let slope = [[0.0, 0.0, 0.1], [3.0, 0.0, 0.7], [3.0, 3.0, 1.9], [0.0, 3.0, 1.3]];
    /// let tree = BspTree::build([slope])?;
    /// let eye = DVec3::new(0.3, 1.0, 9.0);
    /// for k in 1..30 {
    ///     let ray = Ray::between(eye, DVec3::new(0.1 * f64::from(k), 1.7, -2.0));
    ///     let point = tree.hits(ray).next().expect("a hit").point();
    ///     assert!(!tree.is_occluded(Ray::between(eye, point.lerp(eye, 1e-6))));
    /// }
    /// # Ok::<(), binspace::Error>(())
    /// ```
    ///
    /// The test is exact. A polygon also blocks the segment if only an edge or a corner of the polygon
    /// touches the segment. A polygon seen edge-on, such as a floor, blocks a segment that lies in the
    /// polygon. If an eye should see along a floor, look for [`hits`](Self::hits) whose
    /// [`facing`](crate::Hit::facing) is not [`Facing::EdgeOn`].
    ///
    /// The search stops at the first polygon found, which need not be the nearest. The time is proportional
    /// to the number of boxes that the segment crosses before that polygon. The first call computes the
    /// boxes, in O(n) time ([`bounds`](Self::bounds)). Later calls usually allocate nothing; they allocate if
    /// dozens of parts of the tree are pending at once.
    pub fn is_occluded(&self, ray: Ray) -> bool {
        Targets { tree: self, pieces: None }.is_occluded(ray)
    }
}
