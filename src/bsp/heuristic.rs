//! How splitters are chosen.

use std::fmt;
use std::str::FromStr;

/// How the plane that splits a set of polygons is chosen.
///
/// Two kinds of planes compete: the polygons' own (an *autopartition*: Fuchs, Kedem and Naylor,
/// “On visible surface generation by a priori tree structures”, 1980) and *free planes*, here
/// perpendicular to an axis and through a corner of a polygon. Every heuristic is deterministic.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Heuristic {
    /// The plane of the first polygon in input order. The cheapest choice, and up to 14 times
    /// the fragments of a scored one.
    First,
    /// The plane of a random polygon; the same for the same seed. In expectation O(n log n)
    /// fragments in the plane (Paterson and Yao, 1990), O(n²) in space.
    Random {
        /// Chooses among the sequences of choices.
        seed: u64,
    },
    /// Among the polygons' planes, the one that cuts fewest polygons.
    FewestSplits,
    /// Among the polygons' planes, the one with most nearly as many polygons in front as behind.
    Balanced,
    /// Among the polygons' planes, the lowest weighted sum.
    Weighted {
        /// The price of a polygon cut. Default 8.
        splits: f64,
        /// The price of one polygon more on one side than on the other. Default 1.
        balance: f64,
        /// What is taken off, per polygon in the set, for a plane perpendicular to an axis.
        /// Default 0.
        axial: f64,
    },
    /// As [`Weighted`](Self::Weighted) by default, from a sample of the polygons' planes (as in
    /// the builders for the levels of id Software's games).
    Sampled {
        /// How many planes are tried at a node. Default 16.
        candidates: u32,
    },
    /// Free planes as long as one separates anything, by the cost of [`Auto`](Self::Auto).
    FreePlanes,
    /// Free planes and the planes of the largest polygons, in small sets a sample of all
    /// polygons' planes too, by the estimate f·log f + b·log b of the work left in front and
    /// behind, a price for cuts, and a reward for taking polygons that fill the set's box before
    /// they are cut. Fewest fragments on most scenes. Scenes of up to 200 faces
    /// are taken for layers that are rebuilt for every frame: there, free planes that cut nothing,
    /// and else the choice of [`Sampled`](Self::Sampled) from 8 planes.
    #[default]
    Auto,
}

impl Heuristic {
    /// Every heuristic, with its default parameters.
    pub const ALL: [Self; 8] = [
        Self::First,
        Self::Random { seed: 0 },
        Self::FewestSplits,
        Self::Balanced,
        Self::Weighted { splits: 8.0, balance: 1.0, axial: 0.0 },
        Self::Sampled { candidates: 16 },
        Self::FreePlanes,
        Self::Auto,
    ];
}

impl fmt::Display for Heuristic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::First => f.write_str("first"),
            Self::Random { seed } => write!(f, "random({seed})"),
            Self::FewestSplits => f.write_str("fewest-splits"),
            Self::Balanced => f.write_str("balanced"),
            Self::Weighted { splits, balance, axial } => {
                write!(f, "weighted({splits},{balance},{axial})")
            }
            Self::Sampled { candidates } => write!(f, "sampled({candidates})"),
            Self::FreePlanes => f.write_str("free-planes"),
            Self::Auto => f.write_str("auto"),
        }
    }
}

/// A name that is no heuristic, or parameters that do not fit it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParseHeuristicError {
    text: String,
    /// What the heuristic of that name takes; `None` if there is none.
    parameters: Option<&'static str>,
}

impl fmt::Display for ParseHeuristicError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(parameters) = self.parameters {
            return write!(f, "the parameters of `{}` do not fit: {parameters}", self.text);
        }
        write!(
            f,
            "no heuristic `{}`; there are first, random(SEED), fewest-splits, balanced, \
             weighted(SPLITS,BALANCE,AXIAL), sampled(K), free-planes and auto",
            self.text
        )
    }
}

impl std::error::Error for ParseHeuristicError {}

impl FromStr for Heuristic {
    type Err = ParseHeuristicError;

    /// Reads what `Display` writes; parameters may be left out, or follow a colon (`sampled:8`).
    fn from_str(text: &str) -> Result<Self, ParseHeuristicError> {
        let name = text.split(['(', ':']).next().unwrap_or_default();
        let takes = match name {
            "first" | "fewest-splits" | "balanced" | "free-planes" | "auto" => Some("it has none"),
            "random" => Some("a whole number, as in random(7)"),
            "weighted" => Some("up to three finite numbers, as in weighted(8,1,0)"),
            "sampled" => Some("a whole number from 1, as in sampled(16)"),
            _ => None,
        };
        let error = || ParseHeuristicError { text: text.to_owned(), parameters: takes };
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
                let mut weights = [8.0, 1.0, 0.0];
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
mod tests {
    use super::Heuristic;

    #[test]
    fn names_come_back_as_they_went_out() {
        for heuristic in Heuristic::ALL {
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
    fn parameters_that_do_not_fit_are_errors_that_say_which_do() {
        for (text, takes) in [
            ("sampled(0)", "a whole number from 1"),
            ("sampled(1,2)", "a whole number from 1"),
            ("sampled(99999999999)", "a whole number from 1"),
            ("random(x)", "a whole number"),
            ("random(1", "a whole number"),
            ("auto(1)", "it has none"),
            ("weighted(nan)", "three finite numbers"),
            ("weighted(1,2,3,4)", "three finite numbers"),
        ] {
            let error = text.parse::<Heuristic>().unwrap_err().to_string();
            assert!(error.contains(takes) && error.contains(text), "{error}");
        }
    }
}
