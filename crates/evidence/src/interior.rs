//! A generated interior, identical to the one in the self-contained example `level`.

use binspace::glam::{DVec3, dvec3};

type Quad = [DVec3; 4];

/// The side of a room.
pub const ROOM: f64 = 8.0;
/// The height of a room.
pub const HEIGHT: f64 = 3.0;
const DOOR: f64 = 1.6;
const LINTEL: f64 = 2.2;

/// Returns the quads of `side`² rooms, with doors in most walls between them, and a pillar or a crate in
/// each. Up is z; the first corner is the origin.
pub fn rooms(side: usize) -> Vec<Quad> {
    let mut level = Vec::new();
    let mut dice = 1_u64;
    let mut roll = |faces: u64| {
        // Knuth's generator; its upper bits have the better quality.
        dice = dice.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (dice >> 33) % faces
    };
    for row in 0..=side {
        for column in 0..=side {
            let corner = dvec3(column as f64, row as f64, 0.0) * ROOM;
            let (is_west_end, is_south_end) = (column % side == 0, row % side == 0);
            if row < side {
                wall(&mut level, corner, DVec3::Y, !is_west_end && roll(4) > 0);
            }
            if column < side {
                wall(&mut level, corner, DVec3::X, !is_south_end && roll(4) > 0);
            }
            if row == side || column == side {
                continue;
            }
            let [x, y, up] = [DVec3::X * ROOM, DVec3::Y * ROOM, DVec3::Z * HEIGHT];
            level.push([corner, corner + x, corner + x + y, corner + y]);
            let high = corner + up;
            level.push([high, high + y, high + x + y, high + x]);
            let at =
                corner + dvec3(1.5 + roll(50) as f64 / 10.0, 1.5 + roll(50) as f64 / 10.0, 0.0);
            match roll(2) {
                0 => block(&mut level, at, 0.4, HEIGHT),
                _ => block(&mut level, at, 0.7, 0.9 + roll(8) as f64 / 10.0),
            }
        }
    }
    level
}

/// A wall of a room's length, with or without a door in its middle.
fn wall(level: &mut Vec<Quad>, corner: DVec3, along: DVec3, has_door: bool) {
    let mut part = |from: f64, to: f64, low: f64| {
        let at = |along_wall: f64, z: f64| corner + along * along_wall + DVec3::Z * z;
        level.push([at(from, low), at(to, low), at(to, HEIGHT), at(from, HEIGHT)]);
    };
    if has_door {
        let door = [0.5 * (ROOM - DOOR), 0.5 * (ROOM + DOOR)];
        part(0.0, door[0], 0.0);
        part(door[1], ROOM, 0.0);
        part(door[0], door[1], LINTEL);
    } else {
        part(0.0, ROOM, 0.0);
    }
}

/// The sides of a block that stands on the floor, and its top if it is below the ceiling.
fn block(level: &mut Vec<Quad>, at: DVec3, half: f64, height: f64) {
    let ring = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let ring = ring.map(|(x, y)| at + dvec3(x, y, 0.0) * half);
    let up = DVec3::Z * height;
    for k in 0..4 {
        let (a, b) = (ring[k], ring[(k + 1) % 4]);
        level.push([a, b, b + up, a + up]);
    }
    if height < HEIGHT {
        level.push(ring.map(|corner| corner + up));
    }
}
