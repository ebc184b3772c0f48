//! Examples small enough to be worked by hand.

#[cfg(test)]
mod tests;

use binspace::glam::DVec3;
use binspace::view::Camera;
use binspace::{BspTree, Error};

/// The eight walls on a floor: their letters, and x and y of their ends. If the planes are taken in
/// alphabetical order, A divides C, F and G from B, D, E and H; C divides F from
/// G; and B cuts D into D₁ and D₂.
const EIGHT: [(char, [[f64; 2]; 2]); 8] = [
    ('A', [[2.0, 8.0], [7.0, 8.0]]),
    ('B', [[4.0, 5.0], [4.0, 7.0]]),
    ('C', [[6.0, 9.0], [6.0, 12.0]]),
    ('D', [[2.0, 4.0], [6.0, 4.0]]),
    ('E', [[5.0, 3.0], [9.0, 3.0]]),
    ('F', [[1.0, 10.0], [4.0, 11.0]]),
    ('G', [[8.0, 10.0], [10.0, 12.0]]),
    ('H', [[6.0, 2.0], [9.0, 1.0]]),
];

/// The position of the eye on the floor.
pub const EYE_OF_EIGHT: [f64; 2] = [8.0, 0.0];

/// The order in which this eye's picture is painted, worked by hand.
pub const EIGHT_ORDER: &str = "F C G A D₁ B D₂ E H";

/// Returns eight walls, two units high: their letters and their corners.
pub fn eight() -> impl Iterator<Item = (char, [DVec3; 4])> {
    EIGHT.into_iter().map(|(letter, [[x, y], [u, v]])| {
        let corners = [[x, y, 0.0], [u, v, 0.0], [u, v, 2.0], [x, y, 2.0]];
        (letter, corners.map(DVec3::from_array))
    })
}

/// Returns a camera above the eye of the eight walls, so that no wall hides the whole of another wall. The
/// order is the same from any height.
///
/// # Errors
///
/// If the size is zero or beyond the limits.
pub fn eye_on_eight(size: [u32; 2]) -> Result<Camera, Error> {
    let [x, y] = EYE_OF_EIGHT;
    let (eye, target) = (DVec3::new(x, y, 9.0), DVec3::new(6.0, 4.3, 0.0));
    Camera::perspective(eye, target, DVec3::Z, 1.2, size)
}

/// Returns an order of the fragments of a tree of the eight walls, by letters; pieces of a wall that was cut
/// are numbered in this order.
pub fn letters(tree: &BspTree, order: &[u32]) -> String {
    let polygon = |fragment: u32| tree.fragment(fragment).polygon();
    let name = |(place, &fragment): (usize, &u32)| {
        let number = order[..=place].iter().filter(|&&f| polygon(f) == polygon(fragment)).count();
        let subscript = char::from_u32('₀' as u32 + number as u32).unwrap_or('?');
        let letter = EIGHT[polygon(fragment)].0.to_string();
        if tree.fragment(fragment).is_whole() { letter } else { format!("{letter}{subscript}") }
    };
    order.iter().enumerate().map(name).collect::<Vec<_>>().join(" ")
}

/// Returns two triangles on a grid of six by six pixels, seen along −z: the depths at the centres of pixels
/// are whole numbers. The first triangle has depth 5 everywhere. The second has depth 2 in the first column,
/// and 2 more in each further column.
pub fn six_by_six() -> [[DVec3; 3]; 2] {
    let first = [[0.0, 0.0, -5.0], [12.0, 0.0, -5.0], [0.0, 12.0, -5.0]];
    // Depth 2x + 1, so 2 at the centre of the first column.
    let second = [[0.0, 0.25, -1.0], [5.5, 5.75, -12.0], [0.0, 5.75, -1.0]];
    [first, second].map(|triangle| triangle.map(DVec3::from_array))
}

/// Returns the camera of the grid: pixel (x, y) is the world's (x + ½, 5½ − y).
///
/// # Errors
///
/// No error: the size is valid.
pub fn six_by_six_camera() -> Result<Camera, Error> {
    Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::new(3.0, 3.0, 0.0), 6.0, [6, 6])
}

/// The content of each row of the grid, worked by hand: the depths of the second triangle, the visible
/// depths, and the visible triangles.
pub const GRID_OF_SIX: [[&str; 3]; 6] = [
    ["2 4 6 8 10 ·", "2 4 5 5 5 5", "B B A A A A"],
    ["2 4 6 8 · ·", "2 4 5 5 5 5", "B B A A A A"],
    ["2 4 6 · · ·", "2 4 5 5 5 5", "B B A A A A"],
    ["2 4 · · · ·", "2 4 5 5 5 5", "B B A A A A"],
    ["2 · · · · ·", "2 5 5 5 5 5", "B A A A A A"],
    ["· · · · · ·", "5 5 5 5 5 5", "A A A A A A"],
];
