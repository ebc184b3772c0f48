//! Whether anything lies between two points.

use super::chord::{Chord, chord};
use super::filter::{Guess, guess};
use super::probe::Probe;
use super::walk::Walk;
use crate::exact::Faces;
use crate::exact::eye::{ExactRay, Parameter};
use crate::ray::Ray;
use crate::tree::{Bounds, BspTree, Fragment};

/// Whether a ray meets a fragment between its ends.
fn is_between(probe: &mut Probe, fragment: &Fragment<'_>, faces: &Faces) -> bool {
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
    let Some(mut probe) = Probe::new(ray, tree.faces.lattice()) else { return false };
    let mut walk = Walk::new(tree, bounds, &probe);
    while let Some(fragment) = walk.next(f64::INFINITY) {
        if is_between(&mut probe, &tree.fragment(fragment), &tree.faces) {
            return true;
        }
    }
    false
}
