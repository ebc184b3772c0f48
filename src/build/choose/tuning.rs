//! The numbers of choosing: how many planes are tried on how many pieces, and from which sizes on.

/// The numbers that decide how planes are chosen. (The exponent of the cost is in `cost.rs`, the numbers of
/// bins in `axis_planes.rs`.) `benches/ABLATION.md` says what each is worth.
#[derive(Clone, Copy, Debug)]
pub struct Tuning {
    /// Sets of fewer pieces sort their pieces to find an axis plane that cuts nothing; `Auto` tries no other
    /// axis planes on them. Too large: fewer axis planes to choose from. Too small: time, as counting by bins
    /// takes longer than sorting.
    pub clean_below: usize,
    /// Sets of fewer pieces try more own planes, and pieces that need no cut are peeled off them.
    /// Larger: slightly fewer fragments, but more time and deeper trees; smaller: more fragments on
    /// scans, whose surfaces no free plane follows.
    pub small: usize,
    /// Own planes tried in a small set, and at most by the heuristics that score own planes alone.
    /// More: time; fewer: more fragments.
    pub own_planes: usize,
    /// Own planes tried in a large set. More: time; fewer: more fragments.
    pub few_own_planes: usize,
    /// A large set is searched for peelable pieces if at least this many of its tried own planes have
    /// the whole first sample on one side. More: large convex sets are cut; fewer: searches that find
    /// nothing.
    pub one_sided_needed: usize,
    /// A plane that cuts nothing is taken at once if each side keeps at least 1/`uneven` of the
    /// pieces. Larger: unbalanced trees; smaller: a longer search for little gain.
    pub uneven: usize,
    /// Pieces in the first sample that own planes are compared with, and of which the largest tells
    /// whether all lie on one plane. More: time; fewer: good planes are dropped by chance, and the
    /// pieces tried for all may be too small to tell.
    pub first_sample: usize,
    /// Each round keeps 1/`rate` of the own planes and compares them with `rate` times as many
    /// pieces. Larger: the best are dropped by chance; smaller: time.
    pub rate: usize,
    /// Subtracted from the cost of a polygon's plane, per piece of the set, scaled by the share of the
    /// bounding box that the polygon fills and by 1 + the mean number of cuts per piece. (A wall that
    /// is not taken early is cut again by every plane through it.) Larger: depth wasted on polygons
    /// that nothing would cut; smaller: large polygons are cut.
    pub reward: f64,
    /// The most groups of four pieces per box of the peeling search. More: groups are tested one by
    /// one; fewer: more boxes to build, which tell nothing in small sets (of fewer than `small`
    /// pieces): their groups are not near one another.
    pub groups_per_box: usize,
    /// How small sets are divided quickly; `None` in trees that stay. With it, orders take a fifth longer.
    pub frames: Option<FrameTuning>,
}

impl Tuning {
    /// What trees are built with that stay.
    pub const DEFAULT: Self = Self {
        clean_below: 64,
        small: 256,
        own_planes: 96,
        few_own_planes: 16,
        one_sided_needed: 12,
        uneven: 4,
        first_sample: 16,
        rate: 4,
        reward: 0.35,
        groups_per_box: 64,
        frames: None,
    };

    /// What frames are built with, of which each is ordered once or twice.
    pub const FRAMES: Self = Self { frames: Some(FrameTuning::FRAMES), ..Self::DEFAULT };
}

/// The numbers that decide how frames divide small sets quickly.
#[derive(Clone, Copy, Debug)]
pub struct FrameTuning {
    /// The most pieces that a plane may cut to be taken at once. It must cut at least one, and each of them
    /// must cross the plane's own piece: any tree has to cut one of the two. Too large: polygons that cross at
    /// random are cut by worse planes. Too small: all planes of rings are compared again and again.
    pub crossings: usize,
    /// Own planes of a set of fewer than `small` pieces that are tried first, and taken at once if they
    /// cut nothing and divide the set evenly, or as above. More: time where each plane cuts something; fewer:
    /// stacks of layers are searched for the best plane, though any will do.
    pub probes: usize,
    /// The share of its set's box that a piece has to fill for its plane to be trusted at once, where
    /// the tolerance is coarse. Corners in `f32` are rounded, so small polygons that were meant to lie
    /// in one plane have planes of their own, which separate others that belong together. Less: of 400
    /// pages with forty small cards in one plane, 3 lose their order at 1/16, and 10 at 1/50; more:
    /// each set of layers in `f32` is searched for its best plane.
    pub trusted_share: f64,
    /// A tolerance is coarse if it is a larger share of the extent: above that of numbers in `f64`,
    /// and below that of `f32`. Less: planes of layers in `f64` are searched for, which takes stacks
    /// 1.4 times as long; more: small cards in `f32` lose their order.
    pub coarse: f64,
}

impl FrameTuning {
    /// That of frames.
    pub const FRAMES: Self = Self { crossings: 2, probes: 4, trusted_share: 0.25, coarse: 1e-8 };
}
