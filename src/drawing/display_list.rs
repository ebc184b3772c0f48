//! All that a drawing paints, in order.

use super::overlaid::{LineRun, MarkerView, Overlaid};
use super::paths::{Drawing, Path};

/// What is painted next.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum DisplayItem<'d> {
    /// A polygon, or a part of one.
    Path(Path<'d>),
    /// A part of a segment of an overlay's line.
    Line(LineRun),
    /// A point of an overlay.
    Marker(MarkerView),
}

impl Drawing {
    /// All that is painted, in order: [`paths`](Self::paths), with the lines and points between them that
    /// the drawing was made with.
    pub fn display_list(&self) -> impl Iterator<Item = DisplayItem<'_>> + Clone {
        let mut overlaid = self.overlaid.iter().peekable();
        let mut paths = self.paths();
        let count = self.paths.len();
        std::iter::from_fn(move || {
            let painted = (count - paths.len()) as u32;
            if let Some((_, next)) = overlaid.next_if(|(below, _)| *below <= painted) {
                return Some(match next {
                    Overlaid::Line(run) => DisplayItem::Line(*run),
                    Overlaid::Marker(marker) => DisplayItem::Marker(*marker),
                });
            }
            paths.next().map(DisplayItem::Path)
        })
    }
}
