//! The plan of the eight walls, as SVG.

use std::fmt::Write;

use binspace_evidence::{EYE_OF_EIGHT, eight};

/// The length of a unit of the plan, in pixels.
const UNIT: f64 = 32.0;
/// The plan's width and depth.
const EXTENT: [f64; 2] = [11.0, 13.0];

/// Draws the walls with their letters, the lines that divide them, and the eye.
pub(super) fn of_eight() -> String {
    let [width, height] = EXTENT.map(|c| c * UNIT);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         role=\"img\" aria-label=\"Plan of the eight walls\"><rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>"
    );
    let place = |[x, y]: [f64; 2]| [x * UNIT, (EXTENT[1] - 0.5 - y) * UNIT];
    let mut line = |from: [f64; 2], to: [f64; 2], look: &str| {
        let ([a, b], [c, d]) = (place(from), place(to));
        let _ = write!(svg, "<path d=\"M{a} {b}L{c} {d}\" fill=\"none\" {look}/>");
    };
    let dashed = "stroke=\"#999\" stroke-dasharray=\"5 5\"";
    // The line of A divides all walls. The line of C divides the part beyond the line of A. The lines of B, D
    // and E divide the part on the eye's side.
    line([0.0, 8.0], [11.0, 8.0], dashed);
    line([6.0, 8.0], [6.0, 12.5], dashed);
    line([4.0, 8.0], [4.0, 0.0], dashed);
    line([4.0, 4.0], [11.0, 4.0], dashed);
    line([4.0, 3.0], [11.0, 3.0], dashed);
    for (_, [a, b, ..]) in eight() {
        line([a.x, a.y], [b.x, b.y], "stroke=\"#1f5fbf\" stroke-width=\"4\"");
    }
    let mut text = |[x, y]: [f64; 2], text: &str| {
        let [x, y] = place([x, y]);
        let _ = write!(
            svg,
            "<text x=\"{x}\" y=\"{y}\" font-family=\"sans-serif\" font-size=\"18\" fill=\"#222\">{text}</text>"
        );
    };
    for (letter, [a, b, ..]) in eight() {
        if letter == 'D' {
            text([2.7, 4.2], "D₁");
            text([5.0, 4.2], "D₂");
        } else {
            // The letter is below a rising wall, and above a falling or level wall.
            let (middle, along) = ((a + b) * 0.5, b - a);
            let below = if along.x * along.y > 0.0 { 0.75 } else { 0.0 };
            text([middle.x + 0.15, middle.y + 0.2 - below], &letter.to_string());
        }
    }
    text([EYE_OF_EIGHT[0] - 0.3, EYE_OF_EIGHT[1]], "eye");
    svg += "</svg>";
    svg
}
