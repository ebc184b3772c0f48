//! A graph with linear axes, for curves.

use plotters::prelude::{
    ChartBuilder, Color, IntoDrawingArea, LineSeries, PathElement, RGBColor, SVGBackend, WHITE,
};

use binspace_cli::failure::Failure;

/// A curve: its name, its colour and its points.
#[derive(Debug)]
pub(super) struct Curve {
    pub(super) name: String,
    pub(super) colour: [u8; 3],
    pub(super) points: Vec<(f64, f64)>,
}

/// Curves to draw, with axes and a title.
#[derive(Debug)]
pub(super) struct Graph<'a> {
    pub(super) title: &'a str,
    pub(super) x_label: &'a str,
    pub(super) y_label: &'a str,
    /// The ends of the axes.
    pub(super) x: [f64; 2],
    pub(super) y: [f64; 2],
    pub(super) curves: Vec<Curve>,
}

impl Graph<'_> {
    /// The graph as SVG.
    pub(super) fn draw(&self) -> Result<String, Failure> {
        let failure = |error| Failure::about("a plot", error);
        let mut svg = String::new();
        {
            let area = SVGBackend::with_string(&mut svg, (900, 480)).into_drawing_area();
            area.fill(&WHITE).map_err(failure)?;
            let mut chart = ChartBuilder::on(&area)
                .caption(self.title, ("sans-serif", 20))
                .margin(14)
                .x_label_area_size(48)
                .y_label_area_size(70)
                .build_cartesian_2d(self.x[0]..self.x[1], self.y[0]..self.y[1])
                .map_err(failure)?;
            chart
                .configure_mesh()
                .x_desc(self.x_label)
                .y_desc(self.y_label)
                .label_style(("sans-serif", 14))
                .axis_desc_style(("sans-serif", 15))
                .bold_line_style(RGBColor(215, 215, 215))
                .light_line_style(WHITE)
                .draw()
                .map_err(failure)?;
            for curve in &self.curves {
                let [r, g, b] = curve.colour;
                let style = RGBColor(r, g, b).stroke_width(2);
                chart
                    .draw_series(LineSeries::new(curve.points.clone(), style))
                    .map_err(failure)?
                    .label(&curve.name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], style));
            }
            chart
                .configure_series_labels()
                .label_font(("sans-serif", 14))
                .background_style(WHITE.mix(0.9))
                .border_style(RGBColor(215, 215, 215))
                .draw()
                .map_err(failure)?;
            area.present().map_err(failure)?;
        }
        Ok(svg)
    }
}
