//! Vector pictures: areas, lines, markers and labels in painting order, to be written as SVG, PDF or TikZ.
//!
//! Coordinates are rounded once, when a shape is added, to whole numbers of a small unit. So files are short,
//! and all formats have the same shapes.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use super::paths::{Drawing, Path};

/// The largest number of steps per pixel. Corners are rounded to steps. Too large: the floats of viewers
/// cannot represent the steps. Too small: tiny areas vanish.
const MOST_STEPS: f64 = 1e9;
/// The largest absolute value of a coordinate or a length, in pixels, so that its number of steps is a 64-bit
/// integer.
const FURTHEST: f64 = 1e6;
/// Lengths below this, in pixels, count as 0. Too small: a dash of a positive length is written as 0. Too
/// large: lines that are visible in an enlarged picture are left out.
const SHORTEST: f64 = 1e-4;
/// In a picture whose longer side is at least this, in pixels, a unit is a fiftieth of a pixel. Rounding then
/// moves corners by at most a hundredth of a pixel, which is not visible even if the picture is enlarged a
/// few times. If the longer side is below 480 pixels, a unit is a tenth as large; below 48 pixels, a
/// hundredth as large; and so on.
const LARGE: u32 = 480;
const UNITS: u32 = 50;

/// A vector picture: areas, lines, markers and labels in painting order.
///
/// ```
/// use binspace::drawing::{Hidden, Stroke, VectorPicture, ViewOptions, polylines};
/// use binspace::view::Camera;
/// use binspace::{BspTree, glam::DVec3};
///
/// let square = |x: f64, y: f64| [[x, y, 0.0], [x + 2.0, y, 0.0], [x + 2.0, y, 2.0], [x, y, 2.0]];
/// let tree = BspTree::build([square(0.0, 0.0), square(1.0, -1.0)])?;
/// let (eye, target) = (DVec3::new(1.5, -9.0, 1.0), DVec3::new(1.5, 0.0, 1.0));
/// let camera = Camera::perspective(eye, target, DVec3::Z, 0.6, [320, 240])?;
/// let map = tree.visibility(&camera, &ViewOptions::DEFAULT)?;
///
/// let mut picture = VectorPicture::new(map.size());
/// picture.add_drawing(&map.drawing()?, |polygon| [[200, 80, 40], [40, 80, 200]][polygon]);
/// let edges = map.edges(Hidden::Skip)?;
/// picture.add_lines(polylines(edges.iter().map(|run| run.ends))?, Stroke::new(1.0, [0, 0, 0]));
/// picture.add_label([160.0, 20.0], "two squares", 16.0, [0, 0, 0]);
/// # let path = std::env::temp_dir().join("binspace-two-squares.svg");
/// std::fs::write(path, picture.to_svg())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Positions and lengths are in pixels, as for [`Camera::project`](crate::view::Camera::project). Positions
/// are rounded to fiftieths of a pixel, or more finely if the picture's longer side is below 480 pixels. A
/// shape with a coordinate that is NaN, infinite, or beyond a million pixels is left out. A length that is
/// NaN or less than 10⁻⁴ pixels counts as 0; markers, labels and strokes of this size are left out. Opacities
/// are clamped to the range from 0 to 1; NaN counts as 0. So files are well-formed for any numbers.
#[derive(Clone, Debug)]
pub struct VectorPicture {
    pub(super) size: [u32; 2],
    pub(super) background: Option<[u8; 3]>,
    pub(super) nodes: Vec<Node>,
    /// Whether the picture has a group from [`added_up`](Self::added_up).
    pub(super) adds_up: bool,
}

/// The style of areas, markers and labels. A colour or a [`Stroke`] converts to a `Paint`.
///
/// ```
/// use binspace::drawing::{Paint, Stroke};
///
/// let glass = Paint::from([40, 80, 200]).with_opacity(0.25).with_stroke(Stroke::new(1.0, [0, 0, 0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Paint {
    /// The colour of the area: red, green and blue. Default: `None`, the area is not filled.
    pub fill: Option<[u8; 3]>,
    /// The opacity of the area, from 0 to 1. Default: 1.
    pub opacity: f64,
    /// The line along the boundary. Half of its width is on each side of the boundary. Default: `None`.
    pub stroke: Option<Stroke>,
}

/// The style of lines. Corners are round.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Stroke {
    /// The width, in pixels.
    pub width: f64,
    /// The colour: red, green and blue.
    pub colour: [u8; 3],
    /// The opacity, from 0 to 1. Default: 1.
    pub opacity: f64,
    /// The lengths of dashes and of the gaps between them, in pixels. Default: `None`, for a solid line. The
    /// line is also solid if one of the lengths is 0.
    pub dashes: Option<[f64; 2]>,
    /// Whether a line ends in a half disc beyond its last point. Default: `true`.
    /// [`with_dashes`](Self::with_dashes) sets `false`.
    pub round_ends: bool,
}

impl From<[u8; 3]> for Paint {
    fn from(colour: [u8; 3]) -> Self {
        Self { fill: Some(colour), ..Self::NOTHING }
    }
}

impl From<Stroke> for Paint {
    fn from(stroke: Stroke) -> Self {
        Self { stroke: Some(stroke), ..Self::NOTHING }
    }
}

impl Paint {
    const NOTHING: Self = Self { fill: None, opacity: 1.0, stroke: None };

    /// Sets the [`opacity`](Self::opacity) of the area.
    #[must_use]
    pub fn with_opacity(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    /// Sets the [`stroke`](Self::stroke).
    #[must_use]
    pub fn with_stroke(self, stroke: Stroke) -> Self {
        Self { stroke: Some(stroke), ..self }
    }

    /// Whether the paint hides everything below the area.
    fn is_opaque(&self) -> bool {
        self.fill.is_some() && self.opacity >= 1.0
    }

    /// The paint without fills and strokes that are not visible, and with numbers that can be written and
    /// compared.
    fn tidy(self) -> Self {
        // Four decimals are finer than 256 levels.
        let share = |opacity: f64| (1e4 * bounded(opacity, 1.0)).round() / 1e4;
        let opacity = share(self.opacity);
        let fill = self.fill.filter(|_| opacity > 0.0);
        let stroke = self.stroke.map(|stroke| {
            let dashes = stroke.dashes.map(|lengths| lengths.map(length));
            let dashes = dashes.filter(|lengths| lengths.iter().all(|&length| length > 0.0));
            let (width, opacity) = (length(stroke.width), share(stroke.opacity));
            Stroke { width, opacity, dashes, ..stroke }
        });
        let stroke = stroke.filter(|stroke| stroke.width > 0.0 && stroke.opacity > 0.0);
        Self { fill, opacity: if fill.is_some() { opacity } else { 1.0 }, stroke }
    }
}

impl Stroke {
    /// Creates the style of solid and opaque lines of a width in pixels, with round ends.
    pub fn new(width: f64, colour: [u8; 3]) -> Self {
        Self { width, colour, opacity: 1.0, dashes: None, round_ends: true }
    }

    /// Sets the [`opacity`](Self::opacity).
    #[must_use]
    pub fn with_opacity(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    /// Sets [`dashes`](Self::dashes) with flat ends; the lengths of a dash and of a gap are in pixels.
    #[must_use]
    pub fn with_dashes(self, dash: f64, gap: f64) -> Self {
        Self { dashes: Some([dash, gap]), round_ends: false, ..self }
    }
}

/// A part of a picture. Parts are in painting order.
#[derive(Clone, Debug)]
pub(super) enum Node {
    /// A group: the nodes from the next node up to `end`, without `end`. `attributes` is the text for an SVG.
    Group {
        attributes: String,
        end: usize,
    },
    Shape(PaintedShape),
}

#[derive(Clone, Debug)]
pub(super) struct PaintedShape {
    pub(super) shape: Shape,
    pub(super) paint: Paint,
    pub(super) part: Part,
}

/// The part of the paint that a shape uses. The fill and the stroke of a path can be two shapes with the same
/// paint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Part {
    All,
    Fill,
    Stroke,
}

impl PaintedShape {
    /// The paint without the part that the shape does not use.
    pub(super) fn own_paint(&self) -> Paint {
        match self.part {
            Part::All => self.paint,
            Part::Fill => Paint { stroke: None, ..self.paint },
            Part::Stroke => Paint { fill: None, opacity: 1.0, ..self.paint },
        }
    }
}

#[derive(Clone, Debug)]
pub(super) enum Shape {
    /// Outlines or lines.
    Path(Steps),
    /// A disc: its centre in units, and its radius in pixels.
    Marker { at: [i64; 2], radius: f64 },
    /// A text: the middle of its baseline in units, and the height of its font in pixels.
    Label { at: [i64; 2], size: f64, text: String },
}

/// The parts of a path's outlines that are edges of the path's polygon.
fn own_edges(path: Path<'_>) -> Vec<Vec<[f64; 2]>> {
    let mut lines = Vec::new();
    for (outline, edges) in path.outlines().zip(path.edges()) {
        let n = outline.len();
        // Start at the first edge after a side that is not an edge, so that no line is divided at the start
        // of the outline.
        let start = (0..n).find(|&i| edges[i].is_none()).map_or(0, |i| i + 1);
        let mut line = Vec::new();
        for i in (start..start + n).map(|i| i % n) {
            if edges[i].is_some() {
                if line.is_empty() {
                    line.push(outline[i]);
                }
                line.push(outline[(i + 1) % n]);
            } else if !line.is_empty() {
                lines.push(std::mem::take(&mut line));
            }
        }
        lines.extend((!line.is_empty()).then_some(line));
    }
    lines
}

impl VectorPicture {
    /// Creates a transparent picture of a width and a height in pixels.
    pub fn new(size: [u32; 2]) -> Self {
        Self { size, background: None, nodes: vec![], adds_up: false }
    }

    /// Sets the background: red, green and blue.
    #[must_use]
    pub fn with_background(self, colour: [u8; 3]) -> Self {
        Self { background: Some(colour), ..self }
    }

    /// Adds the paths of a drawing. `paint` returns the [`Paint`] of a polygon, given the polygon's index.
    /// `paint` is called once for each polygon that has a path. Paths with equal paint are
    /// [batched](Drawing::batched), and opaque paths are [trapped](Drawing::trapped), which closes the seams
    /// between paths.
    ///
    /// A stroke follows the polygon's own [edges](Path::edges). The stroke is painted directly after its
    /// path, so later paths cover the stroke. Drawings with strokes are not batched. The lines and points of
    /// an [overlay](crate::overlay::Overlay) are not added. To add such lines and points, iterate over
    /// [`Drawing::display_list`]. To draw edges over all paths, add polylines of
    /// [`VisibilityMap::edges`](super::VisibilityMap::edges).
    pub fn add_drawing<P: Into<Paint>>(
        &mut self,
        drawing: &Drawing,
        mut paint: impl FnMut(usize) -> P,
    ) {
        let polygons: BTreeSet<usize> = drawing.paths().map(|path| path.polygon()).collect();
        let paints: BTreeMap<usize, Paint> =
            polygons.into_iter().map(|polygon| (polygon, paint(polygon).into().tidy())).collect();
        let paint = |polygon: usize| paints.get(&polygon).copied().unwrap_or(Paint::NOTHING);
        let has_strokes = paints.values().any(|paint| paint.stroke.is_some());
        let key = |polygon: usize| {
            let Paint { fill, opacity, .. } = paint(polygon);
            // Numbers from 0 to 1 have the same order as their bits.
            (fill, opacity.to_bits())
        };
        let batched = (!has_strokes).then(|| drawing.batched(key));
        let drawing = batched.as_ref().unwrap_or(drawing);
        let trapped = drawing.trapped(|polygon| paint(polygon).is_opaque());
        for (path, extended) in drawing.paths().zip(trapped.paths()) {
            let paint = paint(path.polygon());
            if paint.stroke.is_none() {
                self.add_area(extended.outlines(), paint);
                continue;
            }
            if paint.fill.is_some() {
                self.add_outlines(extended.outlines(), paint, Part::Fill);
            }
            let lines = Steps::drawn(own_edges(path).into_iter(), units(self.size));
            self.add(Shape::Path(lines), paint, Part::Stroke);
        }
    }

    /// Adds an area. All outlines are filled together by the nonzero rule, like the outlines of a
    /// [`Path`](super::Path::outlines) or a [`Region`](super::Region::outlines).
    pub fn add_area<O: AsRef<[[f64; 2]]>>(
        &mut self,
        outlines: impl IntoIterator<Item = O>,
        paint: impl Into<Paint>,
    ) {
        self.add_outlines(outlines, paint.into(), Part::All);
    }

    fn add_outlines<O: AsRef<[[f64; 2]]>>(
        &mut self,
        outlines: impl IntoIterator<Item = O>,
        paint: Paint,
        part: Part,
    ) {
        let given: Vec<O> = outlines.into_iter().collect();
        let outlines: Vec<&[[f64; 2]]> = given.iter().map(AsRef::as_ref).collect();
        if outlines.iter().copied().flatten().all(is_near) {
            self.add(Shape::Path(Steps::filled(&outlines, units(self.size))), paint, part);
        }
    }

    /// Adds lines that are painted together: where lines overlap, a translucent stroke is no darker. The
    /// lines are [polylines](super::polylines) or lists of points. A line that ends at its first point is
    /// closed.
    pub fn add_lines<L: AsRef<[[f64; 2]]>>(
        &mut self,
        lines: impl IntoIterator<Item = L>,
        stroke: Stroke,
    ) {
        let lines = lines.into_iter().filter(|line| line.as_ref().iter().all(is_near));
        self.add(Shape::Path(Steps::drawn(lines, units(self.size))), stroke.into(), Part::All);
    }

    /// Adds a disc of a radius around a point.
    pub fn add_marker(&mut self, at: [f64; 2], radius: f64, paint: impl Into<Paint>) {
        let radius = length(radius);
        if is_near(&at) && radius > 0.0 {
            let at = in_steps(at, f64::from(units(self.size)));
            self.add(Shape::Marker { at, radius }, paint.into(), Part::All);
        }
    }

    /// Adds one line of text. The point `at` is halfway along the text, at half the height of a capital
    /// letter. `size` is the size of the font, in pixels.
    ///
    /// The paint's stroke is painted below the letters. Half of the stroke's width is visible around the
    /// letters, which keeps the letters legible on any background. The font is Helvetica or, in SVG, the
    /// viewer's substitute. In a PDF, characters outside Windows-1252 become `?`, except minus signs, which
    /// become dashes. Line breaks do not begin a new line.
    pub fn add_label(&mut self, at: [f64; 2], text: &str, size: f64, paint: impl Into<Paint>) {
        let (size, [x, y]) = (length(size), at);
        if is_near(&at) && size > 0.0 && !text.is_empty() {
            let baseline = [x, y + 0.5 * CAPITAL * size];
            let at = in_steps(baseline, f64::from(units(self.size)));
            let text = text.to_owned();
            self.add(Shape::Label { at, size, text }, paint.into(), Part::All);
        }
    }

    /// Groups the shapes that `add` adds, and sets attributes of the group in an SVG. The attributes may be
    /// `class`, `id`, and names that begin with `data-`.
    ///
    /// If a group has one shape, the shape itself has the attributes. Values may be any text. Attributes with
    /// other names are left out, and so are attributes whose names have characters other than small letters,
    /// digits and hyphens. If a name is repeated, only its first attribute is written. A PDF has no groups.
    ///
    /// ```
    /// use binspace::drawing::VectorPicture;
    ///
    /// let mut picture = VectorPicture::new([100, 100]);
    /// picture.group(&[("class", "town"), ("data-name", "Ely")], |picture| {
    ///     picture.add_marker([50.0, 50.0], 4.0, [0, 0, 0]);
    /// });
    /// assert!(picture.to_svg().contains("<circle class=\"town\" data-name=\"Ely\""));
    /// ```
    pub fn group<R>(&mut self, attributes: &[(&str, &str)], add: impl FnOnce(&mut Self) -> R) -> R {
        let mut written = String::new();
        for (i, &(name, value)) in attributes.iter().enumerate() {
            let is_plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
            let is_data = name.len() > 5 && name.starts_with("data-") && name.chars().all(is_plain);
            let is_first = attributes[..i].iter().all(|&(other, _)| other != name);
            if is_first && (is_data || name == "class" || name == "id") {
                let _ = write!(written, " {name}=\"{}\"", super::svg::escaped(value));
            }
        }
        self.group_with(written, add)
    }

    /// Groups adjacent areas that `add` adds. In an SVG there are no seams between these areas, even if the
    /// areas are translucent.
    ///
    /// Viewers add up the colours of the areas (`mix-blend-mode: plus-lighter`), and blend the sum with the
    /// picture below. Use such a group for [regions](super::VisibilityMap::regions), each with its blended
    /// colour. Browsers support this blend mode; other viewers, and a PDF, paint the areas one after another.
    pub fn added_up<R>(&mut self, add: impl FnOnce(&mut Self) -> R) -> R {
        self.adds_up = true;
        self.group_with(" class=\"binspace-sum\" style=\"isolation:isolate\"".to_owned(), add)
    }

    fn group_with<R>(&mut self, attributes: String, add: impl FnOnce(&mut Self) -> R) -> R {
        let begin = self.nodes.len();
        self.nodes.push(Node::Group { attributes, end: begin + 1 });
        let result = add(self);
        let count = self.nodes.len();
        // If `add` panics, the group is empty.
        if let Some(Node::Group { end, .. }) = self.nodes.get_mut(begin) {
            *end = count;
        }
        result
    }

    fn add(&mut self, shape: Shape, paint: Paint, part: Part) {
        let paint = paint.tidy();
        let is_empty = matches!(&shape, Shape::Path(steps) if steps.lines.is_empty());
        if !is_empty && (paint.fill.is_some() || paint.stroke.is_some()) {
            self.nodes.push(Node::Shape(PaintedShape { shape, paint, part }));
        }
    }
}

/// The height of Helvetica's capital letters, as a share of the font's height.
const CAPITAL: f64 = 0.718;

fn is_near(point: &[f64; 2]) -> bool {
    point.iter().all(|c| c.abs() <= FURTHEST)
}

/// A length that can be written: not negative, and 0 if its written digits are all 0.
fn length(given: f64) -> f64 {
    if given >= SHORTEST { bounded(given, FURTHEST) } else { 0.0 }
}

/// Clamps a number to the range from 0 to `most`; NaN becomes 0.
fn bounded(given: f64, most: f64) -> f64 {
    if given > 0.0 { given.min(most) } else { 0.0 }
}

fn in_steps(point: [f64; 2], scale: f64) -> [i64; 2] {
    point.map(|c| (c * scale).round() as i64)
}

/// The number of units per pixel in a picture of this width and height in pixels.
pub(super) fn units([width, height]: [u32; 2]) -> u32 {
    let longer = width.max(height);
    let smaller = (1..4).filter(|&k| longer < LARGE.div_ceil(10u32.pow(k - 1))).count();
    UNITS * 10u32.pow(smaller as u32)
}

/// Outlines or lines in whole numbers of steps.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Steps {
    pub(super) lines: Vec<Line>,
    /// The number of decimals of a unit: a unit has 10 to this power steps.
    pub(super) decimals: u32,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Line {
    /// The corners. The first corner of a closed line is not repeated at its end.
    pub(super) corners: Vec<[i64; 2]>,
    pub(super) is_closed: bool,
}

impl Steps {
    /// Rounds outlines of an area, given in pixels, to whole units, or more finely if nothing of the area
    /// would remain.
    pub(super) fn filled(outlines: &[&[[f64; 2]]], units: u32) -> Self {
        let mut steps = f64::from(units);
        for decimals in 0.. {
            let all = outlines.iter().map(|outline| closed(rounded(outline, steps)));
            let mut lines: Vec<Line> = all.clone().filter(|line| line.corners.len() > 2).collect();
            if lines.iter().any(|line| has_area(&line.corners)) {
                return Self { lines, decimals };
            }
            if steps * 10.0 > MOST_STEPS {
                lines = all.filter(|line| !line.corners.is_empty()).collect();
                return Self { lines, decimals };
            }
            steps *= 10.0;
        }
        Self { lines: vec![], decimals: 0 }
    }

    /// Rounds lines, given in pixels, to whole units. A line that ends at its first point is closed.
    pub(super) fn drawn<L: AsRef<[[f64; 2]]>>(lines: impl Iterator<Item = L>, units: u32) -> Self {
        let line = |points: L| {
            let mut corners = rounded(points.as_ref(), f64::from(units));
            if corners.len() > 3 && corners.first() == corners.last() {
                corners.pop();
                return Line { corners, is_closed: true };
            }
            // A line that is a dot still has two ends.
            corners.extend_from_within(..usize::from(corners.len() == 1));
            Line { corners, is_closed: false }
        };
        let lines = lines.filter(|points| !points.as_ref().is_empty());
        Self { lines: lines.map(line).collect(), decimals: 0 }
    }
}

/// Makes an outline of corners. Repetitions of the first corner at the end are removed.
fn closed(mut corners: Vec<[i64; 2]>) -> Line {
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    Line { corners, is_closed: true }
}

/// Points rounded to steps from the corner of the picture, without consecutive duplicates.
fn rounded(points: &[[f64; 2]], scale: f64) -> Vec<[i64; 2]> {
    let mut rounded: Vec<[i64; 2]> = points.iter().map(|&point| in_steps(point, scale)).collect();
    rounded.dedup();
    rounded
}

fn has_area(outline: &[[i64; 2]]) -> bool {
    let next = outline.iter().cycle().skip(1);
    let wide = |c: i64| i128::from(c);
    let areas = outline.iter().zip(next);
    let areas = areas.map(|(a, b)| wide(a[0]) * wide(b[1]) - wide(a[1]) * wide(b[0]));
    areas.fold(0i128, i128::wrapping_add) != 0
}

#[cfg(test)]
mod tests {
    use super::units;

    #[test]
    fn units_go_with_the_size() {
        let sizes = [[640, 480], [480, 1], [479, 300], [48, 20], [47, 3], [1, 1]];
        assert_eq!(sizes.map(units), [50, 50, 500, 500, 5_000, 50_000]);
    }
}
