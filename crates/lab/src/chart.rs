//! A chart with two logarithmic axes, a separate lane for zero, and a legend.

mod scale;

use std::fmt::Display;

use plotters::chart::ChartContext;
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::element::{Circle, EmptyElement, PathElement, Polygon};
use plotters::prelude::{
    ChartBuilder, Color, DrawingArea, IntoDrawingArea, IntoFont, LineSeries, RGBColor, Rectangle,
    SVGBackend, ShapeStyle, TextStyle, WHITE,
};

use self::scale::{Scale, label};
use binspace_cli::failure::Failure;

/// The size of the picture, and the width of the legend, in pixels.
const SIZE: (u32, u32) = (900, 560);
const LEGEND: u32 = 175;
/// The height of the lane for zero, as a share of the axis above it.
const LANE: f64 = 0.28;
/// The distance of the lane from the axis, as a share of the lane's height.
const GAP: f64 = 0.3;
const FONT: &str = "sans-serif";

/// The shape of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Marker {
    Circle,
    Ring,
    Square,
    Triangle,
    Diamond,
    Cross,
}

/// The colour and the marker of a series.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Style {
    colour: RGBColor,
    marker: Marker,
    /// About half of a marker's width, in pixels.
    reach: i32,
}

impl Style {
    pub(crate) const fn new([r, g, b]: [u8; 3], marker: Marker, reach: i32) -> Self {
        Self { colour: RGBColor(r, g, b), marker, reach }
    }
}

/// Points of one kind.
#[derive(Debug)]
pub(crate) struct Series {
    name: String,
    style: Style,
    points: Vec<(f64, f64)>,
    line: bool,
}

impl Series {
    /// Creates a series whose points are joined by a line.
    pub(crate) fn new(name: &str, style: Style, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.to_owned(), style, points, line: true }
    }

    /// Leaves out the line. Such a series has few points, so its markers are drawn larger.
    pub(crate) fn without_line(mut self) -> Self {
        self.style.reach = self.style.reach.max(6);
        Self { line: false, ..self }
    }
}

/// The data of a chart, and its title.
#[derive(Debug)]
pub(crate) struct Chart<'a> {
    pub(crate) title: &'a str,
    pub(crate) x_label: &'a str,
    pub(crate) y_label: &'a str,
    /// Ticks of the x axis; if `None`, decades.
    pub(crate) ticks: Option<Vec<f64>>,
    /// Whether the x axis runs from large to small.
    pub(crate) falls: bool,
    /// Whether values may be 0. Zeros are drawn in a separate lane below the axis, side by side, so that all
    /// are visible.
    pub(crate) zero: bool,
    pub(crate) series: Vec<Series>,
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Plot<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<Scale, Scale>>;

/// The lane for zero: its upper end, its height, and its ends on the left and right.
struct Lane {
    top: f64,
    height: f64,
    ends: [f64; 2],
}

impl Chart<'_> {
    /// Draws the chart as SVG.
    pub(crate) fn draw(&self) -> Result<String, Failure> {
        let mut svg = String::new();
        {
            let all = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
            all.fill(&WHITE).map_err(failure)?;
            let (left, right) = all.split_horizontally(SIZE.0 - LEGEND);
            self.draw_axes(&left)?;
            self.draw_legend(&right)?;
            all.present().map_err(failure)?;
        }
        Ok(svg)
    }

    /// Returns the x axis, the y axis, and the lane for zero below the y axis.
    fn scales(&self) -> (Scale, Scale, Lane) {
        let points = || self.series.iter().flat_map(|series| &series.points);
        let mut x = match &self.ticks {
            Some(ticks) => Scale::at(ticks),
            None => Scale::decades(points().map(|&(x, _)| x)),
        };
        x.falls = self.falls;
        let mut y = Scale::decades(points().map(|&(_, y)| y).filter(|&y| y > 0.0));
        let height = if self.zero { LANE * (y.high - y.low) } else { 0.0 };
        // A gap below the axis, so that no marker in the lane reaches values above zero.
        let gap = GAP * height;
        let lane = Lane { top: y.low - gap, height, ends: [x.low, x.high] };
        if self.zero {
            y.ticks.insert(0, lane.top - 0.5 * height);
            y.low -= gap + height;
        }
        (x, y, lane)
    }

    fn draw_axes(&self, area: &Area<'_>) -> Result<(), Failure> {
        let (x, y, lane) = self.scales();
        let [left, right] = lane.ends;
        let mut chart = ChartBuilder::on(area)
            .caption(self.title, (FONT, 20))
            .margin(14)
            .x_label_area_size(48)
            .y_label_area_size(70)
            .build_cartesian_2d(x, y)
            .map_err(failure)?;
        if self.zero {
            let corners = [(left, lane.top - lane.height), (right, lane.top)];
            let shade = Rectangle::new(corners, RGBColor(238, 244, 238).filled());
            chart.draw_series([shade]).map_err(failure)?;
        }
        let y_text =
            |value: &f64| if *value < lane.top - 1e-9 { "0".into() } else { label(*value) };
        chart
            .configure_mesh()
            .x_desc(self.x_label)
            .y_desc(self.y_label)
            .x_label_formatter(&|value| label(*value))
            .y_label_formatter(&y_text)
            .label_style((FONT, 14))
            .axis_desc_style((FONT, 15))
            .bold_line_style(RGBColor(215, 215, 215))
            .draw()
            .map_err(failure)?;
        if self.zero {
            let edge = RGBColor(110, 130, 110).stroke_width(1);
            let line = PathElement::new([(left, lane.top), (right, lane.top)], edge);
            chart.draw_series([line]).map_err(failure)?;
        }
        self.draw_points(&mut chart, &lane)
    }

    fn draw_points(&self, chart: &mut Plot<'_>, lane: &Lane) -> Result<(), Failure> {
        let has_zero = |series: &&Series| series.points.iter().any(|point| point.1 <= 0.0);
        let count = self.series.iter().filter(has_zero).count() as f64;
        // Away from the lane's edges, which would clip markers.
        let step = lane.height / (count + 1.0);
        let mut slot = lane.top - lane.height + step;
        // The first series is drawn last, over all others.
        for series in self.series.iter().rev() {
            let place = |&(x, y): &(f64, f64)| (x.log10(), if y > 0.0 { y.log10() } else { slot });
            let places: Vec<(f64, f64)> = series.points.iter().map(place).collect();
            if has_zero(&series) {
                slot += step;
            }
            if series.line {
                let style = series.style.colour.mix(0.75).stroke_width(2);
                chart.draw_series(LineSeries::new(places.clone(), style)).map_err(failure)?;
            }
            for place in places {
                draw_marker(chart.plotting_area(), place, series.style)?;
            }
        }
        Ok(())
    }

    fn draw_legend(&self, area: &Area<'_>) -> Result<(), Failure> {
        let text = TextStyle::from((FONT, 14).into_font());
        for (series, i) in self.series.iter().zip(0..) {
            let y = 60 + 24 * i;
            if series.line {
                let line = series.style.colour.mix(0.75).stroke_width(2);
                area.draw(&PathElement::new([(4, y), (32, y)], line)).map_err(failure)?;
            }
            draw_marker(area, (18, y), series.style)?;
            area.draw_text(&series.name, &text, (40, y - 7)).map_err(failure)?;
        }
        Ok(())
    }
}

/// A marker, whose size in pixels does not depend on its position.
fn draw_marker<C: plotters::coord::CoordTranslate>(
    area: &DrawingArea<SVGBackend<'_>, C>,
    at: C::From,
    style: Style,
) -> Result<(), Failure>
where
    C::From: Clone,
{
    let full: ShapeStyle = style.colour.filled();
    let (at, r) = (EmptyElement::at(at), style.reach);
    let drawn = match style.marker {
        Marker::Circle => area.draw(&(at + Circle::new((0, 0), r, full))),
        Marker::Ring => {
            let ring = Circle::new((0, 0), r, style.colour.stroke_width(3));
            area.draw(&(at + ring))
        }
        Marker::Square => area.draw(&(at + Rectangle::new([(-r, -r), (r, r)], full))),
        Marker::Triangle => {
            area.draw(&(at + Polygon::new([(0, -r - 1), (r + 1, r), (-r - 1, r)], full)))
        }
        Marker::Diamond => {
            area.draw(&(at + Polygon::new([(0, -r), (r, 0), (0, r), (-r, 0)], full)))
        }
        Marker::Cross => {
            let stroke = style.colour.stroke_width(3);
            let [rising, falling] = [[(-r, r), (r, -r)], [(-r, -r), (r, r)]];
            let cross = PathElement::new(rising, stroke);
            area.draw(&(at + cross + PathElement::new(falling, stroke)))
        }
    };
    drawn.map_err(failure)
}

fn failure(error: impl Display) -> Failure {
    Failure::about("a plot", error)
}
