//! Boxes in the picture.

/// A box in the picture: its least and its largest coordinates, in pixels.
pub(super) type Rect = [[f64; 2]; 2];

/// Whether two boxes are apart.
pub(super) fn are_apart([low, high]: &Rect, [from, to]: &Rect) -> bool {
    (0..2).any(|axis| to[axis] < low[axis] || from[axis] > high[axis])
}

/// Whether a box is in another.
pub(super) fn is_within([low, high]: &Rect, [from, to]: &Rect) -> bool {
    (0..2).all(|axis| from[axis] <= low[axis] && high[axis] <= to[axis])
}

/// The box of nothing: apart from all others.
pub(super) const NOWHERE: Rect = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];

/// Whether a box has no points.
pub(super) fn is_empty([low, high]: &Rect) -> bool {
    (0..2).any(|axis| low[axis] > high[axis])
}

/// Whether a box reaches from one side of another to the opposite one, or beyond.
pub(super) fn reaches_across([low, high]: &Rect, [from, to]: &Rect) -> bool {
    (0..2).any(|axis| low[axis] <= from[axis] && to[axis] <= high[axis])
}

/// What two boxes have in common; if they are apart, an empty box.
pub(super) fn common(a: &Rect, b: &Rect) -> Rect {
    let axes = [0, 1];
    [axes.map(|i: usize| a[0][i].max(b[0][i])), axes.map(|i: usize| a[1][i].min(b[1][i]))]
}
