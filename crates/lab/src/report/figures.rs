//! The figures of a method on a scene.

use std::fmt;
use std::ops::Add;

use binspace_evidence::Accuracy;
use binspace_evidence::Family;
use binspace_evidence::measure::{AreaError, PictureError};
use binspace_evidence::method::Space;

/// The name of the method whose errors must all be 0.
pub(super) const EXACT: &str = "bsp exact";

/// The subject of a section of the report.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Subject {
    Family(Family),
    Scene(String),
}

impl Subject {
    pub(super) fn name(&self) -> &str {
        match self {
            Self::Family(family) => family.name(),
            Self::Scene(name) => name,
        }
    }
}

/// The rows of one family or scene, by step, and within a step by method.
#[derive(Debug)]
pub(super) struct Section {
    pub(super) subject: Subject,
    pub(super) rows: Vec<Row>,
}

/// One method on one scene.
#[derive(Debug)]
pub(super) struct Row {
    /// The difficulty in the sweep; `None` for a scene that does not belong to a family.
    pub(super) difficulty: Option<f64>,
    pub(super) faces: usize,
    pub(super) views: usize,
    pub(super) method: String,
    /// The space in which the method decides visibility.
    pub(super) space: Space,
    /// The figures, or the reason for their absence.
    pub(super) found: Result<Figures, String>,
}

/// Errors, which depend only on the seed, and costs, which depend on the machine.
#[derive(Clone, Debug)]
pub(super) struct Figures {
    pub(super) picture: PictureError,
    /// The accuracy of vertices, for methods that store the definitions of vertices.
    pub(super) accuracy: Option<Accuracy>,
    /// The error of areas, for methods that split before any view is known.
    pub(super) area: Option<AreaError>,
    /// The mean share of faces that a step before the method leaves out.
    pub(super) removed: f64,
    /// A unit of the scene's grid, as a share of the extent.
    pub(super) grid: f64,
    /// The most pieces drawn in a view.
    pub(super) pieces: usize,
    pub(super) build: f64,
    /// Seconds for the order of a view: the median.
    pub(super) order: f64,
    /// Seconds for drawing a view: the median.
    pub(super) draw: f64,
    pub(super) bytes: usize,
}

impl Figures {
    /// The largest drift of a vertex, as a share of the extent.
    pub(super) fn drift(&self) -> Option<f64> {
        self.accuracy.map(|accuracy| accuracy.drift_max * self.grid)
    }
}

impl Section {
    pub(super) fn new(subject: Subject) -> Self {
        Self { subject, rows: Vec::new() }
    }

    /// The rows of a method, in the order of the sweep.
    pub(super) fn of<'a>(&'a self, method: &'a str) -> impl Iterator<Item = &'a Row> {
        self.rows.iter().filter(move |row| row.method == method)
    }

    /// The methods, in the order in which they ran.
    pub(super) fn methods(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for row in &self.rows {
            if !names.contains(&row.method.as_str()) {
                names.push(&row.method);
            }
        }
        names
    }

    /// The errors of the exact tree here.
    pub(super) fn exactness(&self) -> Exactness {
        let one = |row: &Row| match &row.found {
            Err(_) => Exactness { rows: 1, failed: 1, ..Exactness::default() },
            Ok(figures) => Exactness {
                rows: 1,
                failed: 0,
                pixels: figures.picture.covered,
                contested: figures.picture.contested,
                wrong: figures.picture.wrong(),
                vertices: figures.accuracy.map_or(0, |accuracy| accuracy.vertices),
                misplaced: figures.accuracy.map_or(0, |a| a.misplaced + a.undefined),
                torn: figures.accuracy.map_or(0, |accuracy| accuracy.torn),
            },
        };
        self.of(EXACT).map(one).fold(Exactness::default(), Add::add)
    }
}

/// The errors of the exact tree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Exactness {
    pub(super) rows: usize,
    pub(super) failed: usize,
    pub(super) pixels: usize,
    pub(super) contested: usize,
    pub(super) wrong: usize,
    pub(super) vertices: usize,
    pub(super) misplaced: usize,
    pub(super) torn: usize,
}

impl Exactness {
    /// Whether the exact tree was measured, and nothing was wrong.
    pub(super) fn is_zero(&self) -> bool {
        self.rows > 0 && self.failed + self.wrong + self.misplaced + self.torn == 0
    }
}

impl Add for Exactness {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            rows: self.rows + other.rows,
            failed: self.failed + other.failed,
            pixels: self.pixels + other.pixels,
            contested: self.contested + other.contested,
            wrong: self.wrong + other.wrong,
            vertices: self.vertices + other.vertices,
            misplaced: self.misplaced + other.misplaced,
            torn: self.torn + other.torn,
        }
    }
}

impl fmt::Display for Exactness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{EXACT}: {} of {} pixels wrong, {} contested, {} of {} vertices misplaced, \
             {} polygons torn, {} of {} trials not finished",
            self.wrong,
            self.pixels,
            self.contested,
            self.misplaced,
            self.vertices,
            self.torn,
            self.failed,
            self.rows
        )
    }
}
