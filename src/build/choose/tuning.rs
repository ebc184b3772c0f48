//! The constants of choosing: how many planes are tried, on how many pieces, and for which sizes of sets.

/// The constants that decide how planes are chosen. (The exponent of the cost is in `cost.rs`, the numbers
/// of bins in `axis_planes.rs`.) `benches/ABLATION.md` measures the effect of each.
#[derive(Clone, Copy, Debug)]
pub struct Tuning {
    /// A number of pieces. In sets, and parts of tables, of fewer pieces, sorting the pieces finds an axis plane
    /// that cuts nothing; `Auto` tries no other axis planes on these. (`FreePlanes` counts by bins if there is
    /// none.) Too large: fewer axis planes to choose from. Too small: time, because counting by bins takes longer
    /// than sorting.
    pub clean_below: usize,
    /// A set of at most this many pieces is divided by a table (at most 256; see `table.rs`). Too large: time,
    /// because a table has a bit for each pair of pieces. Too small: the planes above tables are chosen with
    /// less care, so there are more fragments.
    pub small: usize,
    /// The weight of the planes that cut a piece: that piece's plane costs less, because a wall that is not
    /// used early is cut again and again. Too large: depth is wasted on pieces that no used plane would cut.
    /// Too small: large polygons are cut.
    pub risk: f64,
    /// The mean share of a table's pieces that a plane cuts, at which half of `risk` counts. If planes cut
    /// less, how they divide the set matters more, and so do the cuts of the next planes (`pairs`).
    pub risk_at: f64,
    /// The number of a table's planes that are compared by the cuts of the next planes too, beside an axis plane
    /// that costs less than these. Too large: time. Too small: more fragments on scans.
    pub pairs: usize,
    /// The weight of a cut that may follow, if the cut of a piece by the plane itself counts 1. Too large or too
    /// small: more fragments.
    pub next_cuts: f64,
    /// The most pieces of a set for which subtrees are tried
    /// ([`BuildOptions::with_trials`](crate::BuildOptions::with_trials)). Too large: time. Too small: more fragments.
    pub most_tried: usize,
    /// The number of cuts, for each piece of a set, from which on no other planes are tried. Too large: time, where all
    /// planes cut much. Too small: more fragments.
    pub most_cuts: usize,
    /// The largest number of own planes tried by heuristics that only score own planes. Too large: time. Too
    /// small: more fragments.
    pub own_planes: usize,
    /// The number of pieces of a large set whose planes are compared, by their effect on each other (at most 256).
    /// Too large: time. Too small: good planes are dropped by chance.
    pub sample: usize,
    /// A large set is searched for peelable pieces if at least this share of its sample's planes have the whole
    /// sample on one side. Too large: large convex sets are cut. Too small: searches that find nothing.
    pub one_sided_needed: f64,
    /// The largest number of groups of four pieces per box of the peeling search. Too large: groups are
    /// tested one by one. Too small: more boxes to build.
    pub groups_per_box: usize,
    /// The constants for dividing small sets in less time; `None` in permanent trees, because orders of the
    /// resulting trees take a fifth longer.
    pub frames: Option<FrameTuning>,
}

impl Tuning {
    /// The constants of permanent trees.
    pub const DEFAULT: Self = Self {
        clean_below: 64,
        small: 256,
        risk: 0.5,
        risk_at: 0.2,
        pairs: 4,
        next_cuts: 0.05,
        most_tried: 64,
        most_cuts: 2,
        own_planes: 96,
        sample: 64,
        one_sided_needed: 0.75,
        groups_per_box: 64,
        frames: None,
    };

    /// The constants of frames. Each frame's tree is ordered once or twice.
    pub const FRAMES: Self = Self { frames: Some(FrameTuning::FRAMES), ..Self::DEFAULT };
}

/// The constants for dividing small sets of frames in less time.
#[derive(Clone, Copy, Debug)]
pub struct FrameTuning {
    /// The largest number of pieces that an own plane may cut if it is used without further search. Each cut
    /// piece must cross the plane's own piece: any tree has to cut one of the two. Too large: polygons that
    /// cross at random are cut by worse planes. Too small: in a ring of polygons, each crossing the next, all
    /// planes are compared repeatedly.
    pub crossings: usize,
    /// The number of own planes tried first in a set of fewer than `small` pieces. Such a plane is used at
    /// once if it cuts nothing and divides the set evenly, or as `crossings` allows. Too large: time if each
    /// plane cuts something. Too small: stacks of layers are searched for the best plane, though any plane is
    /// good.
    pub probes: usize,
    /// An own plane that cuts nothing is used at once if each side keeps at least 1/`uneven` of the pieces. Too
    /// large: unbalanced trees. Too small: a longer search for little gain.
    pub uneven: usize,
    /// A share of a set's bounding box. If the tolerance is coarse, a piece's plane is used without further
    /// search only if the piece fills at least this share. Corners in `f32` are rounded, so small polygons
    /// that were meant to lie in one plane have different planes, which separate other polygons of that
    /// plane. Too small: of 400 pages with forty small cards in one plane, 3 lose their order at 1/16, and 10
    /// at 1/50. Too large: each set of layers in `f32` is searched for its best plane.
    pub trusted_share: f64,
    /// A tolerance is coarse if it is a larger share of the extent than this. The value is above the default
    /// tolerance of corners in `f64`, and below the default tolerance of corners in `f32`. Too small: layers
    /// in `f64` are searched for the best plane; stacks take 1.4 times as long. Too large: small cards in
    /// `f32` lose their order.
    pub coarse: f64,
}

impl FrameTuning {
    /// The constants of frames.
    pub const FRAMES: Self =
        Self { crossings: 2, probes: 4, uneven: 4, trusted_share: 0.25, coarse: 1e-8 };
}
