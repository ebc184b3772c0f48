//! Lines of a drawing: which edges are drawn, joined and in an order for a pen.

use binspace::Error;
use binspace::drawing::{self, EdgeKind, EdgeRun, Polyline, polylines};
use clap::ValueEnum;

/// The default angle from which on a crease is drawn, in degrees. Too large: edges of parts with many sides
/// are missing. Too small: the facets of curved surfaces are drawn.
const CREASE: f64 = 30.0;

/// The edges that are drawn as lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum EdgeChoice {
    None,
    All,
    /// Edges where polygons meet at this angle in radians or more, borders, silhouettes, and edges where
    /// polygons penetrate each other.
    Creases(f64),
    /// Silhouettes and borders.
    Silhouettes,
}

/// The style of hidden parts of edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Hidden {
    /// Dashed and thinner
    Dashed,
    /// Dashed, with sparser dashes behind two, three, or more polygons
    Layers,
    /// Not drawn
    #[default]
    None,
}

impl From<Hidden> for drawing::Hidden {
    fn from(hidden: Hidden) -> Self {
        match hidden {
            Hidden::None => Self::Skip,
            Hidden::Dashed => Self::Keep,
            Hidden::Layers => Self::Count,
        }
    }
}

/// Lines of one style.
#[derive(Debug)]
pub(crate) struct Strokes {
    /// The number of polygons in front of the lines, up to [`DEEPEST`]: 0 for visible lines, and 1 for all
    /// hidden lines if these have one style.
    pub(crate) depth: u32,
    /// The kind of the edges.
    pub(crate) class: &'static str,
    /// The edges of the lines' segments, by number.
    pub(crate) runs: Vec<EdgeRun>,
    pub(crate) lines: Vec<Polyline>,
}

impl EdgeChoice {
    pub(crate) const DEFAULT: Self = Self::Creases(CREASE.to_radians());

    /// The meaning of `none`, `all`, `creases`, `creases=DEG` or `silhouettes`.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        match text {
            "none" => return Ok(Self::None),
            "all" => return Ok(Self::All),
            "creases" => return Ok(Self::DEFAULT),
            "silhouettes" => return Ok(Self::Silhouettes),
            _ => {}
        }
        let Some(degrees) = text.strip_prefix("creases=") else {
            return Err("expected none, all, creases, creases=DEG or silhouettes".to_owned());
        };
        match degrees.trim().parse::<f64>() {
            Ok(degrees) if (0.0..=180.0).contains(&degrees) => {
                Ok(Self::Creases(degrees.to_radians()))
            }
            _ => Err("expected an angle from 0 to 180 degrees, as in creases=20".to_owned()),
        }
    }

    fn draws(self, kind: EdgeKind) -> bool {
        match (self, kind) {
            (Self::None, _) => false,
            (Self::All, _) | (_, EdgeKind::Border | EdgeKind::Silhouette) => true,
            // A hundred-millionth of a radian is rounding.
            (Self::Creases(least), EdgeKind::Crease(angle)) => angle > least - 1e-8,
            (Self::Silhouettes, _) => false,
            (Self::Creases(_), _) => true,
        }
    }
}

/// Lines behind more polygons are drawn as lines behind this many.
pub(crate) const DEEPEST: u32 = 4;

/// The names of kinds of edges in a file, in drawing order.
const CLASSES: [&str; 5] = ["other", "crossing", "crease", "border", "silhouette"];

fn class(kind: EdgeKind) -> &'static str {
    match kind {
        EdgeKind::Border => "border",
        EdgeKind::Silhouette => "silhouette",
        EdgeKind::Crease(_) => "crease",
        EdgeKind::Crossing(_) => "crossing",
        // Kinds that the library may add later.
        _ => "other",
    }
}

/// The lines of some edges, hidden lines before visible lines, without lines shorter than a length.
///
/// Lines of a kind are joined before short lines are left out. The part of an edge seen through a crack is
/// short, but so are the edges of a fine mesh.
pub(crate) fn strokes(
    runs: &[EdgeRun],
    edges: EdgeChoice,
    shortest: f64,
) -> Result<Vec<Strokes>, Error> {
    let mut all = Vec::new();
    let depth_of = |run: &EdgeRun| match run.is_visible {
        true => 0,
        false => run.layers.unwrap_or(1).clamp(1, DEEPEST),
    };
    for depth in (0..=DEEPEST).rev() {
        for name in CLASSES {
            let runs = runs.iter().copied().filter(|run| {
                depth_of(run) == depth && class(run.kind) == name && edges.draws(run.kind)
            });
            let runs: Vec<EdgeRun> = runs.collect();
            let mut lines = polylines(runs.iter().map(|run| run.ends))?;
            lines.retain(|line| line.length() >= shortest);
            if !lines.is_empty() {
                all.push(Strokes { depth, class: name, runs, lines });
            }
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_are_words_and_an_angle() {
        assert_eq!(EdgeChoice::parse("all"), Ok(EdgeChoice::All));
        assert_eq!(EdgeChoice::parse("creases"), EdgeChoice::parse("creases=30"));
        assert_eq!(EdgeChoice::parse("creases=0"), Ok(EdgeChoice::Creases(0.0)));
        for text in ["", "creases=", "creases=x", "creases=-1", "creases=181", "all=3", "nan"] {
            assert!(EdgeChoice::parse(text).is_err(), "{text}");
        }
        let kinds =
            [EdgeKind::Border, EdgeKind::Silhouette, EdgeKind::Crease(0.5), EdgeKind::Crease(0.6)];
        for (choice, expected) in [
            (EdgeChoice::None, [false; 4]),
            (EdgeChoice::All, [true; 4]),
            (EdgeChoice::Silhouettes, [true, true, false, false]),
            (EdgeChoice::DEFAULT, [true, true, false, true]),
        ] {
            assert_eq!(kinds.map(|kind| choice.draws(kind)), expected, "{choice:?}");
        }
        for kind in kinds.into_iter().chain([EdgeKind::Crossing(1)]) {
            assert!(CLASSES[1..].contains(&class(kind)), "{kind:?}");
        }
    }
}
