//! Which faces hide which: the exact partial order that a painter has to respect.

mod components;
mod cone;
#[cfg(test)]
mod tests;

use binspace::Viewpoint;
use binspace::glam::DVec3;
use binspace::internals::{Eye, Faces};

use self::components::{components, fewest_removed};
use self::cone::Seen;
use crate::place;

/// Which faces hide parts of which other faces from a viewpoint, for every direction of view, in big
/// integers. For small scenes only: every pair is tested, in O(n²) time.
///
/// A face hides another if a ray from the eye passes through the inside of both and meets the hiding face
/// first. Faces that penetrate each other may hide parts of each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hiding {
    /// For each face, the faces that it hides parts of, in ascending order.
    hidden: Vec<Vec<u32>>,
}

impl Hiding {
    /// Looks at all pairs of faces.
    pub fn of(faces: &Faces, viewpoint: Viewpoint) -> Self {
        let eye = place::eye(&Eye::new(viewpoint, faces.lattice()));
        let all = 0..faces.len() as u32;
        let seen: Vec<Option<Seen>> =
            all.clone().map(|face| Seen::new(faces, face, &eye)).collect();
        let mut hidden = vec![Vec::new(); faces.len()];
        for a in all.clone() {
            for b in all.clone().skip(a as usize + 1) {
                let (Some(p), Some(q)) = (&seen[a as usize], &seen[b as usize]) else { continue };
                let [near, far] = p.against(q);
                if near {
                    hidden[a as usize].push(b);
                }
                if far {
                    hidden[b as usize].push(a);
                }
            }
        }
        hidden.iter_mut().for_each(|list| list.sort_unstable());
        Self { hidden }
    }

    /// Returns whether a face hides a part of another.
    pub fn hides(&self, face: u32, other: u32) -> bool {
        self.hidden[face as usize].binary_search(&other).is_ok()
    }

    /// Returns the number of pairs in which one face hides a part of the other.
    pub fn pairs(&self) -> usize {
        self.hidden.iter().map(Vec::len).sum::<usize>() - self.mutual()
    }

    /// Returns the number of pairs that hide parts of each other: these penetrate each other.
    pub fn mutual(&self) -> usize {
        let both = |a: u32| {
            let back = self.hidden[a as usize].iter().filter(move |&&b| b > a && self.hides(b, a));
            back.count()
        };
        (0..self.hidden.len() as u32).map(both).sum()
    }

    /// Returns the faces on cycles of hiding (strongly connected components): in each list all faces hide
    /// each other, directly or through others.
    pub fn cycles(&self) -> Vec<Vec<u32>> {
        components(&self.hidden)
    }

    /// Returns an order in which whole faces can be painted, each after all faces that it hides parts of;
    /// `None` if there is a cycle. Of several possible next faces, the face with the least number is taken.
    pub fn paint_order(&self) -> Option<Vec<u32>> {
        let mut waits_for: Vec<usize> = self.hidden.iter().map(Vec::len).collect();
        let mut order = Vec::with_capacity(waits_for.len());
        let mut is_done = vec![false; waits_for.len()];
        while order.len() < waits_for.len() {
            let next = (0..waits_for.len()).find(|&f| waits_for[f] == 0 && !is_done[f])?;
            is_done[next] = true;
            order.push(next as u32);
            for (face, hidden) in self.hidden.iter().enumerate() {
                waits_for[face] -= usize::from(hidden.contains(&(next as u32)));
            }
        }
        Some(order)
    }

    /// Returns the minimal number of faces that have to be cut by any method: each cycle contains one of
    /// them. All subsets of the faces on a cycle are tried, so the result is `None` if more than
    /// [`SEARCHED`](Self::SEARCHED) faces are on cycles through one another.
    pub fn fewest_cut(&self) -> Option<usize> {
        self.cycles().iter().map(|cycle| fewest_removed(&self.hidden, cycle)).sum()
    }

    /// The largest number of faces whose subsets are all tried.
    pub const SEARCHED: usize = components::SEARCHED;
}

/// Returns the number of pairs of faces that overlap in depth along a direction of view. A sort by depth does
/// not determine their order. Exact, except for the direction, which is rounded to 2⁻⁴⁰.
pub fn overlaps_in_depth(faces: &Faces, forward: DVec3) -> usize {
    let direction = forward.to_array().map(|c| (c * 2f64.powi(40)).round() as i128);
    let extent = |face: u32| {
        let depth = |corner: &[f64; 3]| (0..3).map(|i| direction[i] * corner[i] as i128).sum();
        let depths = faces.corners(face).iter().map(depth);
        depths.fold([i128::MAX, i128::MIN], |[low, high], d: i128| [low.min(d), high.max(d)])
    };
    let mut extents: Vec<[i128; 2]> = (0..faces.len() as u32).map(extent).collect();
    extents.sort_unstable();
    let overlaps = |i: usize| {
        let [low, high] = extents[i];
        let later = extents[i + 1..].iter().take_while(move |other| other[0] < high);
        // Except a face without extent in depth at the start of this face's extent.
        later.filter(move |other| other[1] > low).count()
    };
    (0..extents.len()).map(overlaps).sum()
}
