//! The outline of a maze without loops.

use super::super::super::dice::Dice;
use super::outline::Corner;
use std::collections::HashSet;

/// The outline of rooms and doors on a grid, which form a tree. It is simple, and has about `size` corners
/// and only right angles.
pub(super) fn outline(size: usize, dice: &mut Dice) -> Vec<Corner> {
    let cells = cells(size.div_ceil(3).max(2), dice);
    around(&cells)
}

const STEPS: [Corner; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];

fn plus([x, y]: Corner, [u, v]: Corner) -> Corner {
    [x + u, y + v]
}

/// A tree that grows at random: rooms have even coordinates, doors lie between them.
fn cells(rooms: usize, dice: &mut Dice) -> HashSet<Corner> {
    let mut grown = vec![[0, 0]];
    let mut cells = HashSet::from([[0, 0]]);
    while grown.len() < rooms {
        // The tree mostly grows from the last room, so that corridors are long.
        let last = grown.len() - 1;
        let from = grown[if dice.below(3) > 0 { last } else { dice.below(grown.len()) }];
        let step = STEPS[dice.below(4)];
        let (door, room) = (plus(from, step), plus(plus(from, step), step));
        if cells.insert(room) {
            cells.insert(door);
            grown.push(room);
        } else {
            let any = dice.below(grown.len());
            grown.swap(any, last);
        }
    }
    cells
}

/// The outline of the cells, counter-clockwise, with a corner at each turn.
fn around(cells: &HashSet<Corner>) -> Vec<Corner> {
    let start = *cells.iter().min().expect("a cell");
    // Along the lower side of the leftmost, lowest cell; the inside is to the left.
    let (mut at, mut heading) = (start, 0);
    let mut corners = Vec::new();
    loop {
        let ahead = plus(at, STEPS[heading]);
        let [left, right] = sides(ahead, heading).map(|cell| cells.contains(&cell));
        let turn = match (left, right) {
            (true, true) => 3,
            (true, false) => 0,
            _ => 1,
        };
        if turn != 0 {
            corners.push(ahead);
        }
        (at, heading) = (ahead, (heading + turn) % 4);
        if (at, heading) == (start, 0) {
            return corners;
        }
    }
}

/// The cells ahead of a corner, to the left and to the right. A cell is named by its lower left corner.
fn sides([x, y]: Corner, heading: usize) -> [Corner; 2] {
    match heading {
        0 => [[x, y], [x, y - 1]],
        1 => [[x - 1, y], [x, y]],
        2 => [[x - 1, y - 1], [x - 1, y]],
        _ => [[x, y - 1], [x - 1, y - 1]],
    }
}
