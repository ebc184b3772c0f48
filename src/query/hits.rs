//! The hits of a ray, the nearest first; whether there is any; and what is known of one.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::iter::FusedIterator;

use glam::DVec3;
use smallvec::SmallVec;

use super::chord::{Chord, Spot, chord};
use super::filter::{Guess, guess};
use super::probe::{Depth, Meeting, RayQuery};
use super::walk::Walk;
use crate::exact::Faces;
use crate::exact::eye::{ExactRay, Parameter};
use crate::tree::{Bounds, BspTree, Fragment};
use crate::viewpoint::Ray;

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
    probe: RayQuery,
    walk: Walk<'t>,
    /// What the ray meets of what it has come to.
    found: Found,
    reached: SeenPolygons,
}

/// For each polygon hit so far, the depth at which the hit ends.
#[derive(Clone, Debug, Default)]
struct SeenPolygons {
    /// The last few.
    few: SmallVec<[(usize, Depth); FEW]>,
    /// Others that may have gone on when there were more than a few.
    many: BTreeMap<usize, Depth>,
}

/// How many polygons at one place are looked through one by one. Smaller: more rays need a map, and
/// allocate. Larger: looking through them takes longer than a map.
const FEW: usize = 8;

impl SeenPolygons {
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
        let search = RayQuery::new(ray, tree.faces.lattice()).map(|probe| Search {
            walk: Walk::new(tree, bounds, &probe),
            probe,
            found: Found::default(),
            reached: SeenPolygons::default(),
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

/// Where a ray hits a polygon: [`BspTree::hits`].
#[derive(Clone, Copy)]
pub struct Hit<'t> {
    pub(super) tree: &'t BspTree,
    pub(super) ray: Ray,
    pub(super) fragment: u32,
    pub(super) spot: Spot,
    pub(super) facing: Ordering,
}

impl<'t> Hit<'t> {
    /// The fragment that is hit. Where several fragments of the polygon meet in the point, it is one
    /// of them.
    pub fn fragment(&self) -> Fragment<'t> {
        self.tree.fragment(self.fragment)
    }

    /// The index, in the input, of the polygon that is hit.
    pub fn polygon(&self) -> usize {
        self.fragment().polygon()
    }

    /// The side of the fragment that is hit, exactly: `Greater` if it is the front, `Less` if it is the
    /// back, `Equal` if the ray lies in the fragment's plane. It depends on the ray's direction alone,
    /// so it is the same for a ray that begins on the fragment.
    pub fn facing(&self) -> Ordering {
        self.facing
    }

    /// How far along the ray the point is: it is at `from + parameter * direction`. It is the `f64` that is
    /// nearest to the exact fraction, or its neighbour where these are about as near; infinite if `f64`
    /// cannot hold it.
    ///
    /// Computed at each call, about 0.1 µs.
    pub fn parameter(&self) -> f64 {
        let exact = self.exact();
        exact.map_or(f64::NAN, |(ray, t)| ray.parameter(&t))
    }

    /// The point. It is rounded as a fragment's vertices are: each coordinate is within 2⁻⁵¹ of the
    /// scene's extent plus one step of `f64` of its exact value, however far away the ray begins and
    /// however flat it comes in.
    ///
    /// Computed at each call, about 0.2 µs.
    pub fn point(&self) -> DVec3 {
        let exact = self.exact();
        exact.map_or(DVec3::NAN, |(ray, t)| self.tree.faces.lattice().to_world(ray.point(&t)))
    }

    /// How far two hits of the same ray are along it: `Less` if this one is nearer. It is exact, where
    /// [`parameter`](Self::parameter) and [`point`](Self::point) may have been rounded to the same.
    /// Hits of different rays, or of different trees, do not compare in any useful way.
    pub fn compare(&self, other: &Self) -> Ordering {
        match (self.exact(), other.exact()) {
            (Some((_, t)), Some((_, other))) => t.compare(&other),
            _ => Ordering::Equal,
        }
    }

    /// The exact point, by what defines it: three points of the tree's [grid](BspTree::grid). The hit is
    /// where the ray meets the plane through them: mostly that of the fragment; for a ray that lies in the
    /// fragment's plane, one through an edge. `None` if it is an end of the ray, which is then within the
    /// polygon: its beginning if [`parameter`](Self::parameter) is 0.
    ///
    /// With the ray as it is given (see [`Ray`]) this is the point exactly, as a fraction: with n the
    /// vector product of q − p and r − p, its parameter is n·(p − from) / n·direction.
    pub fn grid_points(&self) -> Option<[[i64; 3]; 3]> {
        self.spot.grid_points(&self.tree.faces)
    }

    /// The point by what defines it: a plane, mostly that of the face, and the ray.
    #[doc(hidden)]
    pub fn spot(&self) -> Spot {
        self.spot
    }

    /// The ray in integers, and the parameter. There is no hit without.
    fn exact(&self) -> Option<(ExactRay, Parameter)> {
        let faces = &self.tree.faces;
        let ray = ExactRay::new(self.ray, faces.lattice())?;
        Some((ray, self.spot.parameter(&ray, faces)))
    }
}

impl std::fmt::Debug for Hit<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Hit")
            .field("polygon", &self.polygon())
            .field("fragment", &self.fragment)
            .field("parameter", &self.parameter())
            .field("point", &self.point())
            .field("facing", &self.facing)
            .finish()
    }
}

/// A binary heap: each meeting comes before the two below it. (That of the standard library compares
/// without the ray, by which these are compared.)
///
/// To push takes a few comparisons if the meeting comes later than most, as at one place, where faces
/// are reached in input order; to pop takes one or two a level.
#[derive(Clone, Debug, Default)]
pub(super) struct Found {
    heap: SmallVec<[Meeting; 8]>,
}

impl Found {
    /// The nearest.
    pub(super) fn first(&self) -> Option<&Meeting> {
        self.heap.first()
    }

    /// Puts one in: O(log n) comparisons.
    pub(super) fn push(&mut self, meeting: Meeting, probe: &mut RayQuery, faces: &Faces) {
        self.heap.push(meeting);
        self.rise(self.heap.len() - 1, probe, faces);
    }

    /// Takes the nearest out: O(log n) comparisons.
    pub(super) fn pop(&mut self, probe: &mut RayQuery, faces: &Faces) -> Option<Meeting> {
        if self.heap.len() <= 1 {
            return self.heap.pop();
        }
        let first = self.heap.swap_remove(0);
        // The last goes down as far as it can without being compared: mostly it belongs there.
        let (mut at, mut below) = (0, 1);
        while below < self.heap.len() {
            let other = below + 1;
            if other < self.heap.len()
                && self.heap[other].compare(&self.heap[below], probe, faces).is_lt()
            {
                below = other;
            }
            self.heap.swap(at, below);
            (at, below) = (below, 2 * below + 1);
        }
        self.rise(at, probe, faces);
        Some(first)
    }

    /// Moves a meeting up before those that it comes before.
    fn rise(&mut self, mut at: usize, probe: &mut RayQuery, faces: &Faces) {
        while at > 0 {
            let above = (at - 1) / 2;
            if self.heap[at].compare(&self.heap[above], probe, faces).is_gt() {
                break;
            }
            self.heap.swap(at, above);
            at = above;
        }
    }
}

/// Whether a ray meets a fragment between its ends.
fn is_between(probe: &mut RayQuery, fragment: &Fragment<'_>, faces: &Faces) -> bool {
    match guess(probe, fragment, faces) {
        Guess::Misses => false,
        Guess::Meets { .. } => true,
        Guess::Unsure => probe.exact().is_some_and(|ray| {
            chord(ray, fragment, faces).is_some_and(|chord| reaches_inside(ray, &chord, faces))
        }),
    }
}

/// Whether some of what a ray and a fragment have in common is no end of the ray.
fn reaches_inside(ray: &ExactRay, chord: &Chord, faces: &Faces) -> bool {
    let [enter, leave] = [chord.enter, chord.leave].map(|spot| spot.parameter(ray, faces));
    let is_inside = |t: &Parameter| {
        t.compare(&Parameter::ZERO).is_gt() && ray.end().is_none_or(|end| t.compare(&end).is_lt())
    };
    // More than a point has more than ends.
    enter.compare(&leave).is_lt() || is_inside(&enter)
}

impl BspTree {
    /// Whether a polygon lies between two points, so that there is no line of sight: whether it has a
    /// point of the segment in common that is neither of its two ends. Of an endless ray, whether it
    /// has another point than the first.
    ///
    /// ```
    /// use binspace::{BspTree, Ray};
    ///
    /// let wall = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 0.0, 3.0], [0.0, 0.0, 3.0]];
    /// let tree = BspTree::build([wall])?;
    ///
    /// let eye = [1.0, -2.0, 1.5];
    /// assert!(tree.is_blocked(Ray::between(eye, [1.0, 2.0, 1.5])));
    /// assert!(!tree.is_blocked(Ray::between(eye, [9.0, 2.0, 1.5])));
    /// // What is on the wall is seen.
    /// assert!(!tree.is_blocked(Ray::between(eye, [1.0, 0.0, 1.5])));
    /// # Ok::<(), binspace::Error>(())
    /// ```
    ///
    /// That a polygon touches the segment with an edge or a corner is enough, and so is that it has some
    /// of the segment in its plane, such as a floor along which one looks. This is exact. Where an eye
    /// along a floor should see, look for [`hits`](Self::hits) whose [`facing`](crate::Hit::facing) is not
    /// `Equal`.
    ///
    /// It stops at the first polygon that it finds, which need not be the nearest. Until then it takes time
    /// for the nodes whose regions the segment crosses and for the fragments on their planes where it does,
    /// however many lie at one place. Nothing is allocated unless dozens of parts of the tree are pending at
    /// once.
    pub fn is_blocked(&self, ray: Ray) -> bool {
        is_blocked(self, None, ray)
    }
}

impl Bounds {
    /// Whether a polygon lies between two points: the same as [`BspTree::is_blocked`], with the boxes of
    /// the tree, and several times as fast in scenes of thousands of polygons.
    ///
    /// # Panics
    ///
    /// If the bounds are those of another tree.
    pub fn is_blocked(&self, tree: &BspTree, ray: Ray) -> bool {
        self.expect(tree);
        is_blocked(tree, Some(self), ray)
    }
}

fn is_blocked(tree: &BspTree, bounds: Option<&Bounds>, ray: Ray) -> bool {
    let Some(mut probe) = RayQuery::new(ray, tree.faces.lattice()) else { return false };
    let mut walk = Walk::new(tree, bounds, &probe);
    while let Some(fragment) = walk.next(f64::INFINITY) {
        if is_between(&mut probe, &tree.fragment(fragment), &tree.faces) {
            return true;
        }
    }
    false
}
