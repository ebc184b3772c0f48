//! The errors of methods.

use std::fmt;

use binspace::{Error, ErrorKind};

/// The reason why a method cannot paint a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct MethodError {
    kind: Kind,
}

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    Build(Error),
    Pieces { limit: usize },
    Comparisons { limit: u64 },
    Range { near: Option<f64>, far: Option<f64> },
}

impl MethodError {
    pub(super) const fn pieces(limit: usize) -> Self {
        Self { kind: Kind::Pieces { limit } }
    }

    pub(super) const fn comparisons(limit: u64) -> Self {
        Self { kind: Kind::Comparisons { limit } }
    }

    pub(super) const fn range(near: Option<f64>, far: Option<f64>) -> Self {
        Self { kind: Kind::Range { near, far } }
    }

    /// Returns whether a budget ran out; a larger one may succeed.
    pub const fn is_over_budget(&self) -> bool {
        match &self.kind {
            Kind::Build(error) => matches!(error.kind(), ErrorKind::OverBudget),
            Kind::Pieces { .. } | Kind::Comparisons { .. } => true,
            Kind::Range { .. } => false,
        }
    }
}

impl From<Error> for MethodError {
    fn from(error: Error) -> Self {
        Self { kind: Kind::Build(error) }
    }
}

impl fmt::Display for MethodError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            Kind::Build(error) => error.fmt(f),
            Kind::Pieces { limit } => {
                write!(f, "more than {limit} pieces were made (`max_pieces`): raise the budget")
            }
            Kind::Comparisons { limit } => write!(
                f,
                "more than {limit} pairs of pieces were compared (`max_comparisons`): raise the \
                 budget"
            ),
            Kind::Range { near, far } => {
                let given = |depth: &Option<f64>| {
                    depth.map_or_else(|| "none given".into(), |depth| format!("{depth}"))
                };
                write!(
                    f,
                    "invalid near plane ({}) or far plane ({}): both must be finite, the near one less \
                     than the far one and, for a perspective camera, more than 0",
                    given(near),
                    given(far)
                )
            }
        }
    }
}

impl std::error::Error for MethodError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.kind {
            Kind::Build(error) => Some(error),
            _ => None,
        }
    }
}
