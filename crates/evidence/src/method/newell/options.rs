//! The algorithm's definition, and its budgets.

/// Sorts by depth, and checks the order: M. E. Newell, R. G. Newell & T. L. Sancha, "A solution to the hidden
/// surface problem" (1972).
///
/// Faces are clipped to the picture and sorted by their furthest vertex. The furthest, P, may be painted if
/// it hides no Q that reaches further than P's nearest vertex. This is certain if one of these tests holds.
/// They are tried in this order:
///
/// 1. their extents on the picture do not overlap from left to right;
/// 2. nor from top to bottom;
/// 3. all of P is behind Q's plane;
/// 4. all of Q is in front of P's plane;
/// 5. their projections do not overlap.
///
/// If no test holds, and Q is behind P's plane or P is in front of Q's plane, then Q is marked and takes P's
/// place. Otherwise P and Q penetrate each other, and one of them is cut by the plane of the other. The same
/// is done if Q was already marked, which means a cycle. If no plane of a cycle cuts another face of the
/// cycle, one face is cut along the projected edge of another. If that fails too, all differences are within
/// the epsilon, and P is painted.
///
/// When Q is painted, its predecessor resumes its comparisons instead of beginning again. The order is the
/// same, with fewer comparisons.
///
/// Everything is computed in `f64`. The time is quadratic in the number of faces that overlap in depth. In
/// the worst case, the number of pieces is quadratic as well. Both have a budget.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Newell {
    /// The largest number of pieces, including faces that were not cut. More pieces are an error. Default:
    /// 2²¹, about 1 GB.
    pub max_pieces: usize,
    /// The largest number of pairs that are compared for one picture. More pairs are an error. Default: 2²⁸,
    /// which take some seconds.
    pub max_comparisons: u64,
    /// Vertices no further than this from a plane are treated as lying on the plane. The unit is 2⁵¹ lattice
    /// steps, which is one to four times half the scene's extent. Default: 1e-10. Too small: faces with a
    /// common edge cut each other. Too large: near layers are painted in input order.
    pub epsilon: f64,
}

impl Newell {
    /// The defaults.
    pub const DEFAULT: Self =
        Self { max_pieces: 1 << 21, max_comparisons: 1 << 28, epsilon: 1e-10 };
}

impl Default for Newell {
    fn default() -> Self {
        Self::DEFAULT
    }
}
