//! The options of a build, and the names of heuristics.

use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use glam::DVec3;

use super::choose::{GivenChooser, PieceSet, SplitPlane};
use crate::error::{Error, Kind};
use crate::faces::Tolerance;

/// The options of a build. [`BspTree::build`](crate::BspTree::build) uses the defaults.
///
/// ```
/// use binspace::{BuildOptions, Heuristic};
///
/// let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let options = BuildOptions::DEFAULT
///     .with_heuristic(Heuristic::FewestSplits)
///     .with_tolerance(1e-6)
///     .with_max_fragments(1000);
/// assert_eq!(options.build([square])?.len(), 1);
/// # Ok::<(), binspace::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BuildOptions {
    /// The heuristic that chooses partition planes. Default: [`Heuristic::Auto`].
    pub heuristic: Heuristic,
    /// The coplanar tolerance: a polygon counts as lying on a plane if no corner is further from the plane
    /// than this distance. Default: [`Tolerance::Default`], which depends on the precision of the polygons.
    pub tolerance: Tolerance,
    /// The largest number of [fragments](crate::Fragment) of a tree, and of input polygons. More fragments or
    /// polygons are an error. Polygons are counted while they are read, before the tree is built. Default:
    /// 2²⁵, or 33 554 432 fragments in about 5 GB. A value above 2²⁹ − 1 counts as 2²⁹ − 1. The number of
    /// polygons also has a fixed limit of 2²⁸.
    pub max_fragments: usize,
    /// The largest number of [nodes](crate::Node) on a path from the root. A longer path is an error.
    /// Default: unlimited; no code recurses over the tree, so a deep tree cannot overflow the stack.
    pub max_depth: usize,
    /// Two opposite corners of a box that the [grid](crate::Grid) of exact coordinates must contain, in
    /// addition to the polygons. For example: a box around everything that is later added in an
    /// [`Overlay`](crate::overlay::Overlay). The scene's extent includes this box, so the box may increase a
    /// default or relative tolerance. Default: no box.
    pub bounds: Option<[DVec3; 2]>,
    /// The number of planes for which subtrees are tried. Default: 0, for none. See
    /// [`with_trials`](Self::with_trials).
    pub trials: usize,
    pub(super) chooser: Option<GivenChooser>,
}

impl BuildOptions {
    /// The defaults.
    pub const DEFAULT: Self = Self {
        heuristic: Heuristic::Auto,
        tolerance: Tolerance::Default,
        max_fragments: 1 << 25,
        max_depth: usize::MAX,
        bounds: None,
        trials: 0,
        chooser: None,
    };

    /// Sets the heuristic that chooses partition planes.
    #[must_use]
    pub const fn with_heuristic(mut self, heuristic: Heuristic) -> Self {
        self.heuristic = heuristic;
        self
    }

    /// Sets the coplanar tolerance, a length of 0 or more in the polygons' unit.
    #[must_use]
    pub const fn with_tolerance(mut self, length: f64) -> Self {
        self.tolerance = Tolerance::Length(length);
        self
    }

    /// Sets the coplanar tolerance as a share, 0 or more, of the scene's extent (the longest side of the
    /// scene's bounding box).
    #[must_use]
    pub const fn with_relative_tolerance(mut self, share: f64) -> Self {
        self.tolerance = Tolerance::Relative(share);
        self
    }

    /// Sets the largest number of fragments.
    #[must_use]
    pub const fn with_max_fragments(mut self, max_fragments: usize) -> Self {
        self.max_fragments = max_fragments;
        self
    }

    /// Sets the largest number of nodes on a path from the root.
    #[must_use]
    pub const fn with_max_depth(mut self, max_depth: usize) -> Self {
        self.max_depth = max_depth;
        self
    }

    /// Sets two opposite corners of a box that contains everything that will move.
    #[must_use]
    pub const fn with_bounds(mut self, corner: DVec3, opposite: DVec3) -> Self {
        self.bounds = Some([corner, opposite]);
        self
    }

    /// Sets the number of planes for which subtrees are tried, for trees that are built once and used often.
    ///
    /// Where every polygon's plane cuts a set of at most 64 pieces, [`Heuristic::Auto`] builds the subtrees of this many
    /// planes of low cost, and uses the plane whose subtree has the fewest cuts. With 0 and 1 it makes no trials. A node
    /// of such a set takes the time of up to `planes` subtrees, which make no trials themselves; a subtree with twice as
    /// many cuts as the set has pieces is not built to its end.
    ///
    /// The tree is the same with any number of threads. Trials do not count towards `max_fragments`, and they end if the
    /// build is cancelled. A [`FrameBuilder`](crate::FrameBuilder) makes trials too; other heuristics and builds with a
    /// [chooser](Self::with_chooser) make none.
    #[must_use]
    pub const fn with_trials(mut self, planes: usize) -> Self {
        self.trials = planes;
        self
    }

    /// Sets your own heuristic: a function that chooses the plane that divides a [set of
    /// pieces](crate::choose::PieceSet). A piece is a part of a polygon.
    ///
    /// The function is called once for each set of two or more pieces. If the function returns `None` or a
    /// plane that does not divide the set, [`heuristic`](Self::heuristic) chooses instead. A plane does not
    /// divide the set if all pieces are on one side of the plane. A plane with an invalid piece number, axis
    /// or coordinate counts as `None`. Whatever the function returns, the tree is exact, the build ends, and
    /// budgets and cancellation work.
    ///
    /// Several threads call the function at the same time, in any order. If the function's result depends
    /// only on the set, the tree is the same with any number of threads. If the function panics, the build
    /// panics too.
    ///
    /// The function also chooses planes for a [`FrameBuilder`](crate::FrameBuilder) with these options, for
    /// the cells of a [`partition`](crate::partition), and when the tree is [extended](Self::extend). Files
    /// of trees store the planes but not the function.
    ///
    /// ```
    /// use binspace::choose::SplitPlane;
    /// use binspace::{BuildOptions, Heuristic, scene};
    ///
    /// // A k-d tree: the median of the pieces' middles, along each axis in turn.
    /// let options = BuildOptions::DEFAULT.with_chooser(|set| {
    ///     let axis = set.depth() % 3;
    ///     let middle = |piece| 0.5 * (set.bounds(piece)[0][axis] + set.bounds(piece)[1][axis]);
    ///     let mut middles: Vec<f64> = (0..set.piece_count()).map(middle).collect();
    ///     middles.sort_by(f64::total_cmp);
    ///     Some(SplitPlane::Axis { axis, coordinate: middles[middles.len() / 2] })
    /// });
    /// let scene = scene::city(200, 1);
    /// let [own, auto] = [options, BuildOptions::DEFAULT].map(|o| o.build(scene.polygons()));
    /// assert!(own?.len() > auto?.len());
    /// # Ok::<(), binspace::Error>(())
    /// ```
    #[must_use]
    pub fn with_chooser(
        mut self,
        chooser: impl Fn(&PieceSet<'_>) -> Option<SplitPlane> + Send + Sync + 'static,
    ) -> Self {
        self.chooser = Some(GivenChooser(Arc::new(chooser)));
        self
    }
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// The strategy that chooses the plane that splits a set of polygons.
///
/// There are two kinds of candidates: the polygons' own planes (an *autopartition*: Fuchs, Kedem and
/// Naylor, “On visible surface generation by a priori tree structures”, 1980), and *free planes*,
/// which here are perpendicular to an axis and go through a corner of a polygon.
///
/// The plane of a small polygon is less certain than the plane of a large polygon, because corners are
/// rounded. Suppose that the chosen plane would separate two polygons that overlap and are coplanar within the
/// [tolerance](crate::Tolerance), or cut the larger of them. Then every heuristic uses the plane of the larger
/// polygon instead. Planes that cross both polygons may cut both.
///
/// Your own heuristic has priority: [`BuildOptions::with_chooser`].
///
/// Every heuristic is deterministic. A heuristic that compares polygons' planes tries at most 96 planes for a
/// set. In larger sets, the tried polygons are spread evenly over the set.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Heuristic {
    /// The plane of the first polygon in input order, as in the first BSP trees (Fuchs, Kedem and Naylor,
    /// 1980). This heuristic compares no planes, and makes up to 14 times as many
    /// [fragments](crate::Fragment) as heuristics that compare planes.
    First,
    /// The plane of a random polygon; the same seed makes the same tree. The expected number of fragments is
    /// O(n log n) for n segments in two dimensions, and O(n²) for n polygons in three dimensions (Paterson
    /// and Yao, “Efficient binary space partitions for hidden-surface removal and solid modeling”, 1990).
    Random {
        /// Seed of the pseudo-random sequence.
        seed: u64,
    },
    /// Among the polygons' planes, the plane that cuts the fewest polygons (Fuchs, Abram and Grant, “Near
    /// real-time shaded display of rigid objects”, 1983).
    FewestSplits,
    /// Among the polygons' planes, the plane with the smallest difference between the numbers of polygons in
    /// front and behind. Naylor (“Constructing good partitioning trees”, 1993) explains why balance alone
    /// does not make a good tree.
    Balanced,
    /// Among the polygons' planes, the plane with the lowest cost. The cost is a weighted sum of splits and
    /// imbalance, less a bonus for planes perpendicular to an axis. The weighted sum is from Thibault and
    /// Naylor (“Set operations on polyhedra using binary space partitioning trees”, 1987).
    Weighted {
        /// Cost per polygon that the plane cuts. Default 8.
        splits: f64,
        /// Cost per polygon of the difference between the numbers of polygons in front and behind. Default 1.
        balance: f64,
        /// Bonus, per polygon in the set, for a plane perpendicular to an axis. Default 0.
        axial: f64,
    },
    /// [`Weighted`](Self::Weighted) with its default weights, over a sample of the polygons' planes, as in
    /// the level builders of id Software's games. (Fuchs, Abram and Grant, 1983, found that a few
    /// candidates are enough.)
    Sampled {
        /// The number of planes tried for each [node](crate::Node). Default 16.
        candidates: u32,
    },
    /// Free planes, as in a k-d tree (Bentley, “Multidimensional binary search trees used for associative
    /// searching”, 1975), compared by the cost of [`Auto`](Self::Auto). A binned sweep finds the planes
    /// (Wald, “On fast construction of SAH-based bounding volume hierarchies”, 2007). A polygon's plane is
    /// used if all polygons of the set lie in one plane, or if no free plane separates any polygons.
    FreePlanes,
    /// The plane with the lowest cost, among free planes and polygons' planes. This heuristic is the default,
    /// because it makes the fewest fragments on most scenes. The cost is the library's own: it estimates the
    /// remaining work, n^1.25 for n polygons in front, plus n^1.25 for n polygons behind. A polygon that the
    /// plane cuts counts on both sides.
    ///
    /// A free plane that cuts nothing has priority. In a set of up to 256 polygons, the sides of all polygons
    /// at the polygons' own planes are then computed once, in O(n²) time and memory of fixed size, and the
    /// planes of the set's subtree are chosen from these. There a polygon's plane that cuts nothing comes first. If
    /// every polygon's plane cuts, free planes are searched: among fewer than 64 polygons only those that cut
    /// nothing. A plane costs less if many planes cut its own
    /// polygon, because a wall or floor that is not used early is cut repeatedly. If few planes cut few
    /// polygons, those of lowest cost are compared by the cuts of the next planes too. If every plane without
    /// cuts separates a single polygon at the boundary of the set, as in a convex body, one pass separates all
    /// these polygons one after the other.
    ///
    /// In a larger set, the planes of a sample of 64 polygons are compared in the same way, by their effect on the
    /// sample. The best of these is then compared with a free plane by its effect on the whole set. Cuts alone do not
    /// decide here, because a plane that cuts nothing of a sample may cut much of the set.
    ///
    /// A [`FrameBuilder`](crate::FrameBuilder) tries polygons' planes first, which takes less time: four
    /// planes in sets of up to 256 polygons. A `FrameBuilder` accepts a plane that cuts nothing and divides
    /// the set evenly, or a plane that cuts only one or two polygons, which cross the plane's own polygon.
    #[default]
    Auto,
}

/// Default weights of splits, balance and axial planes in `Weighted`.
pub(super) const DEFAULT_WEIGHTS: [f64; 3] = [8.0, 1.0, 0.0];

impl Heuristic {
    /// Every heuristic, with its default parameters.
    pub const ALL: &'static [Self] = &[
        Self::First,
        Self::Random { seed: 0 },
        Self::FewestSplits,
        Self::Balanced,
        Self::Weighted {
            splits: DEFAULT_WEIGHTS[0],
            balance: DEFAULT_WEIGHTS[1],
            axial: DEFAULT_WEIGHTS[2],
        },
        Self::Sampled { candidates: 16 },
        Self::FreePlanes,
        Self::Auto,
    ];
}

impl fmt::Display for Heuristic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::First => f.pad("first"),
            Self::Random { seed } => f.pad(&format!("random({seed})")),
            Self::FewestSplits => f.pad("fewest-splits"),
            Self::Balanced => f.pad("balanced"),
            Self::Weighted { splits, balance, axial } => {
                f.pad(&format!("weighted({splits},{balance},{axial})"))
            }
            Self::Sampled { candidates } => f.pad(&format!("sampled({candidates})")),
            Self::FreePlanes => f.pad("free-planes"),
            Self::Auto => f.pad("auto"),
        }
    }
}

impl FromStr for Heuristic {
    type Err = Error;

    /// Parses the output of `Display`. Parameters may be left out, or follow a colon (`sampled:8`).
    fn from_str(text: &str) -> Result<Self, Error> {
        let name = text.split(['(', ':']).next().unwrap_or_default();
        let takes = match name {
            "first" | "fewest-splits" | "balanced" | "free-planes" | "auto" => Some("none"),
            "random" => Some("a whole number, as in `random(7)`"),
            "weighted" => Some("up to three finite numbers, as in `weighted(8,1,0)`"),
            "sampled" => Some("a whole number ≥ 1, as in `sampled(16)`"),
            _ => None,
        };
        let error = || {
            let problem = match takes {
                Some(parameters) => {
                    format!("invalid parameter in `{text}`: expected {parameters}")
                }
                None => format!(
                    "unknown heuristic `{text}`; expected first, random(SEED), fewest-splits, balanced, \
                     weighted(SPLITS,BALANCE,AXIAL), sampled(K), free-planes or auto"
                ),
            };
            Kind::Argument(problem).error()
        };
        let (name, parameters) = match text.split_once(['(', ':']) {
            Some((name, rest)) if text.contains(':') => (name, Some(rest)),
            Some((name, rest)) => (name, Some(rest.strip_suffix(')').ok_or_else(error)?)),
            None => (text, None),
        };
        let numbers: Vec<&str> = parameters.map_or(vec![], |p| p.split(',').collect());
        let integer = |default: u64| match numbers[..] {
            [] => Ok(default),
            [one] => one.trim().parse().map_err(|_| error()),
            _ => Err(error()),
        };
        let plain = |heuristic| if numbers.is_empty() { Ok(heuristic) } else { Err(error()) };
        match name {
            "first" => plain(Self::First),
            "random" => Ok(Self::Random { seed: integer(0)? }),
            "fewest-splits" => plain(Self::FewestSplits),
            "balanced" => plain(Self::Balanced),
            "weighted" => {
                let mut weights = DEFAULT_WEIGHTS;
                if numbers.len() > weights.len() {
                    return Err(error());
                }
                for (weight, number) in weights.iter_mut().zip(&numbers) {
                    let value: f64 = number.trim().parse().map_err(|_| error())?;
                    *weight = Some(value).filter(|value| value.is_finite()).ok_or_else(error)?;
                }
                let [splits, balance, axial] = weights;
                Ok(Self::Weighted { splits, balance, axial })
            }
            "sampled" => {
                let candidates = u32::try_from(integer(16)?).map_err(|_| error())?;
                if candidates == 0 { Err(error()) } else { Ok(Self::Sampled { candidates }) }
            }
            "free-planes" => plain(Self::FreePlanes),
            "auto" => plain(Self::Auto),
            _ => Err(error()),
        }
    }
}

#[cfg(test)]
mod heuristic_tests {
    use super::Heuristic;

    #[test]
    fn parsing_reverses_display() {
        for &heuristic in Heuristic::ALL {
            assert_eq!(heuristic.to_string().parse(), Ok(heuristic));
        }
        assert_eq!("random:7".parse(), Ok(Heuristic::Random { seed: 7 }));
        assert_eq!("sampled".parse(), Ok(Heuristic::Sampled { candidates: 16 }));
        let cheap = Heuristic::Weighted { splits: 2.5, balance: 1.0, axial: 0.0 };
        assert_eq!("weighted(2.5)".parse(), Ok(cheap));
    }

    #[test]
    fn other_names_are_errors_that_list_the_right_ones() {
        for text in ["", "best", "best(1)", "Auto"] {
            let error = text.parse::<Heuristic>().unwrap_err().to_string();
            assert!(error.contains("fewest-splits") && error.contains(text), "{error}");
        }
    }

    #[test]
    fn errors_of_parameters_name_the_accepted_values() {
        for (text, takes) in [
            ("sampled(0)", "a whole number ≥ 1"),
            ("sampled(1,2)", "a whole number ≥ 1"),
            ("sampled(99999999999)", "a whole number ≥ 1"),
            ("random(x)", "a whole number"),
            ("random(1", "a whole number"),
            ("auto(1)", "expected none"),
            ("weighted(nan)", "three finite numbers"),
            ("weighted(1,2,3,4)", "three finite numbers"),
        ] {
            let error = text.parse::<Heuristic>().unwrap_err().to_string();
            assert!(error.contains(takes) && error.contains(text), "{error}");
        }
    }
}
