//! Scenes whose trees have the maximal number of pieces.

#[cfg(test)]
mod tests;

use std::fmt;

use binspace::glam::DVec3;
use binspace::scene::{Material, Scene};

/// Families of scenes of n polygons whose trees have n² or n³ fragments.
///
/// Coordinates are short binary fractions: nothing is rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Worst {
    /// Half of the walls stand along x, half along y below them. The plane of each wall of one half cuts all
    /// remaining walls of the other half. In any order, this gives (n/2)² cuts. A plane between the halves
    /// cuts nothing.
    Walls,
    /// Upright strips along the two families of lines on the saddle z = xy: above the lines of one family,
    /// and, a little lower, below the lines of the other. No plane separates many of them, so the number of
    /// fragments of every tree is at least of order n² (B. Chazelle, "Convex partitions of polyhedra", 1984;
    /// M. S. Paterson & F. F. Yao, "Efficient binary space partitions for hidden-surface removal and solid
    /// modeling", 1990).
    Saddle,
    /// Sheets in the planes t³ + xt² + yt + z = 0 for different t. Every three meet in a separate point: its
    /// coordinates are the coefficients of the cubic whose roots are the three values of t. All sheets cross
    /// each other, so there are about n³/6 cells between them.
    Sheets,
}

impl Worst {
    /// All families.
    pub const ALL: [Self; 3] = [Self::Walls, Self::Saddle, Self::Sheets];

    /// Returns a short name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Walls => "walls",
            Self::Saddle => "saddle",
            Self::Sheets => "sheets",
        }
    }

    /// Returns a scene of this many polygons; the number is even where there are two halves.
    pub fn scene(self, count: u32) -> Scene {
        let mut scene = Scene::new(format!("{self}:{count}"), DVec3::Z);
        Material::palette().for_each(|material| {
            scene.add_material(material);
        });
        let polygons: Vec<[DVec3; 4]> = match self {
            Self::Walls => walls(count / 2).collect(),
            Self::Saddle => strips(count / 2).collect(),
            Self::Sheets => sheets(count).collect(),
        };
        for (polygon, number) in polygons.into_iter().zip(0..) {
            scene.push(polygon, number % 8);
        }
        scene
    }

    /// Returns the number of fragments of a tree of n polygons that takes its planes from these alone, in any
    /// order.
    ///
    /// For walls and strips, each pair that crosses as seen from above is cut once: the one whose plane is
    /// taken first cuts the other. For sheets, each leaf is one of the 1 + n + C(n, 2) + C(n, 3) cells
    /// between them, and each node has one fragment.
    pub fn fragments(self, count: u32) -> u64 {
        let (n, half) = (u64::from(count), u64::from(count / 2));
        let pairs = n * n.saturating_sub(1) / 2;
        match self {
            Self::Walls | Self::Saddle => 2 * half + half * half,
            Self::Sheets => n + pairs + pairs * n.saturating_sub(2) / 3,
        }
    }
}

impl fmt::Display for Worst {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

fn walls(half: u32) -> impl Iterator<Item = [DVec3; 4]> {
    let reach = f64::from(half);
    let wall = move |i: u32, is_upper: bool| {
        let (at, low) = (f64::from(i), if is_upper { 1.0 } else { -2.0 });
        let corners = [(-1.0, low), (reach, low), (reach, low + 1.0), (-1.0, low + 1.0)];
        corners.map(
            |(along, z)| {
                if is_upper { DVec3::new(at, along, z) } else { DVec3::new(along, at, z) }
            },
        )
    };
    [true, false].into_iter().flat_map(move |is_upper| (0..half).map(move |i| wall(i, is_upper)))
}

fn strips(half: u32) -> impl Iterator<Item = [DVec3; 4]> {
    /// The height of the strips, and the height of the one family above the other: from line to line, the
    /// saddle rises by four times this height.
    const HEIGHT: f64 = 0.5;
    const GAP: f64 = 0.25;
    // A power of two, so that the saddle is about as high as wide.
    let flat = f64::from(half.next_power_of_two());
    let reach = 0.5 * f64::from(half);
    let strip = move |i: u32, is_upper: bool| {
        let at = f64::from(i) + 0.5 - reach;
        let [low, high] = if is_upper { [GAP / flat, GAP / flat + HEIGHT] } else { [-HEIGHT, 0.0] };
        let corners = [(-reach, low), (reach, low), (reach, high), (-reach, high)];
        corners.map(|(along, above)| {
            let z = at * along / flat + above;
            if is_upper { DVec3::new(along, at, z) } else { DVec3::new(at, along, z) }
        })
    };
    [true, false].into_iter().flat_map(move |is_upper| (0..half).map(move |i| strip(i, is_upper)))
}

fn sheets(count: u32) -> impl Iterator<Item = [DVec3; 4]> {
    /// Beyond all points in which three sheets meet: |a + b + c| and |ab + bc + ca| are at most 3.
    const REACH: f64 = 4.0;
    let unit = f64::from(count.next_power_of_two());
    (0..count).map(move |k| {
        // From −1 to 1, in steps of a power of two.
        let t = (2.0 * f64::from(k) + 1.0 - f64::from(count)) / unit;
        let corners = [(-REACH, -REACH), (REACH, -REACH), (REACH, REACH), (-REACH, REACH)];
        corners.map(|(x, y)| DVec3::new(x, y, -(t * t * t + x * t * t + y * t)))
    })
}
