//! The numbers that choosing is tuned by.

/// What decides how planes are chosen, in numbers. `benches/ABLATION.md` says what each is worth.
#[derive(Clone, Copy, Debug)]
pub struct Tuning {
    /// In sets of fewer pieces only those free planes are sought that cut nothing, as sorting finds
    /// them. Larger: sets without such a plane are cut by own planes alone; smaller: time to count.
    pub clean_below: usize,
    /// Sets of fewer pieces are small: pieces at the rim are taken off them one by one, and more own
    /// planes are tried. Larger: few fragments less, for time and deep trees; smaller: scans, whose
    /// surfaces no free plane follows, are cut more.
    pub small: usize,
    /// How many own planes are tried in a small set. Larger: time; smaller: more fragments.
    pub own_planes: usize,
    /// How many own planes are tried in a large set. As above.
    pub few_own_planes: usize,
    /// A large set is searched for pieces at its rim if so many of its own planes that are tried
    /// have all of a sample on one side. Larger: large convex sets are cut; smaller: searches in
    /// vain.
    pub at_rim: usize,
    /// A plane that cuts nothing and leaves at least one in so many pieces on either side is good
    /// enough. Smaller: others are searched for what is hardly better; larger: unbalanced trees.
    pub uneven: usize,
    /// How many pieces own planes are held against first. Smaller: good planes are not recognised;
    /// larger: time.
    pub looks: usize,
    /// Each round holds the own planes that are left against so many times as many pieces, and
    /// leaves one in so many of them. Smaller: time; larger: the best are dropped by chance.
    pub rate: usize,
    /// What is taken off the cost of the plane of a polygon that fills the set's bounding box, per
    /// polygon of the set, and once more for each time that these were cut in the mean; less for a
    /// polygon that fills less of it. What is not taken early is cut again by every wall on it.
    /// Larger: depth spent on polygons that nothing would have cut; smaller: large polygons cut.
    pub reward: f64,
    /// An own plane that cuts nothing is taken in a large set only if it leaves one in so many
    /// pieces on either side, or takes as many off: those at the rim would make a list of the set,
    /// one search for each. Larger: lists; smaller: such planes passed over.
    pub rim_share: usize,
    /// Values that a bin of the search for free planes is to hold in the mean. Larger: more to sort
    /// in the bins that are looked into; smaller: more bins to bound.
    pub per_bin: usize,
    /// The most bins. Larger: their counters leave the cache; smaller: more to sort in each.
    pub most_bins: usize,
    /// The most groups in a leaf of its tree of boxes. Larger: groups looked at one by one; smaller:
    /// boxes, and time to make them for small sets.
    pub leaf: usize,
}

impl Tuning {
    /// What the library builds with.
    pub const DEFAULT: Self = Self {
        clean_below: 64,
        small: 256,
        own_planes: 96,
        few_own_planes: 16,
        at_rim: 12,
        uneven: 4,
        looks: 16,
        rate: 4,
        reward: 0.35,
        rim_share: 8,
        per_bin: 2,
        most_bins: 1024,
        leaf: 64,
    };
}
