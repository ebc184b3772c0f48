//! Polygons with one difficulty each, from simple parameters.

use binspace::Polygon;
use binspace::glam::{DMat3, DQuat, DVec3};

pub type Corners = Vec<DVec3>;

/// A polygon with a stated precision.
#[derive(Clone, Debug)]
pub struct Claim {
    pub corners: Corners,
    pub precision: f64,
}

impl Polygon for Claim {
    type Point = DVec3;

    fn corners(&self) -> impl Iterator<Item = DVec3> {
        self.corners.iter().copied()
    }

    fn precision(&self) -> f64 {
        self.precision
    }
}

/// Returns a rotation from any three numbers.
pub fn rotation([a, b, c]: [f64; 3]) -> DMat3 {
    DMat3::from_quat(DQuat::from_euler(binspace::glam::EulerRot::ZYX, a, b, c))
}

/// Returns a square of side 2 around a centre.
pub fn square(turn: DMat3, centre: DVec3) -> Corners {
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| turn * DVec3::new(x, y, 0.0) + centre)
        .to_vec()
}

/// Returns a square from 0 to `side` along two axes, perpendicular to the third.
pub fn sheet(axis: usize, at: f64, side: f64) -> [[f64; 3]; 4] {
    [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]].map(|[u, v]| {
        let mut corner = [at, u, v];
        corner.rotate_right(axis);
        corner
    })
}

/// Returns a rectangle along x and y.
pub fn rectangle(low: [f64; 2], high: [f64; 2], z: f64) -> Corners {
    let corners = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]];
    corners.map(|[x, y]| DVec3::new(x, y, z)).to_vec()
}

/// Returns two triangles with a common edge and a very small angle between them.
pub fn near_coplanar_pair(turn: DMat3, angle: f64, shift: DVec3) -> Vec<Corners> {
    let base = [DVec3::new(-1.0, 0.0, 0.0), DVec3::new(1.0, 0.25, 0.0), DVec3::new(0.0, 1.0, 0.0)];
    let tilt = DMat3::from_rotation_x(angle);
    vec![base.map(|p| turn * p).to_vec(), base.map(|p| turn * (tilt * p) + shift).to_vec()]
}

/// Squares one above the other, each shifted within its plane so that outlines cross.
pub fn layers(turn: DMat3, gap: f64, count: usize) -> Vec<Corners> {
    let at = |k: usize| DVec3::new(0.3 * k as f64, -0.2 * k as f64, gap * k as f64);
    (0..count).map(|k| square(turn, turn * at(k))).collect()
}

/// Returns a triangle that is long and almost without width.
pub fn sliver(turn: DMat3, width: f64, along: f64, centre: DVec3) -> Corners {
    [DVec3::new(-1.0, 0.0, 0.0), DVec3::new(1.0, 0.0, 0.0), DVec3::new(along, width, 0.0)]
        .map(|p| turn * p + centre)
        .to_vec()
}

/// Returns the six sides of a box, facing outwards.
pub fn cuboid(turn: DMat3, centre: DVec3, size: DVec3) -> Vec<Corners> {
    let corner = |x: f64, y: f64, z: f64| turn * (DVec3::new(x, y, z) * size) + centre;
    let side = |axis: usize, sign: f64| {
        let around = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let mut corners: Corners = around
            .iter()
            .map(|&(u, v)| {
                let mut at = [0.0; 3];
                (at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]) = (sign, u, v);
                corner(at[0], at[1], at[2])
            })
            .collect();
        if sign < 0.0 {
            corners.reverse();
        }
        corners
    };
    (0..3).flat_map(|axis| [side(axis, 1.0), side(axis, -1.0)]).collect()
}

/// Returns a convex polygon with integer corners in the plane z = 0. Its edges are the given vectors, each
/// once forwards and once backwards, sorted by direction. Parallel edges are consecutive, so some corners are
/// collinear.
pub fn convex_on_grid(edges: &[[i32; 2]]) -> Vec<[i32; 2]> {
    let both = |&[x, y]: &[i32; 2]| {
        let x = if [x, y] == [0, 0] { 1 } else { x };
        [[x, y], [-x, -y]]
    };
    let mut steps: Vec<[i32; 2]> = edges.iter().flat_map(both).collect();
    let upper = |[x, y]: [i32; 2]| y > 0 || (y == 0 && x > 0);
    steps.sort_by(|&a, &b| {
        let turn = a[0] * b[1] - a[1] * b[0];
        upper(b).cmp(&upper(a)).then(0.cmp(&turn))
    });
    let mut at = [0, 0];
    let mut corners = Vec::new();
    for [x, y] in steps {
        corners.push(at);
        at = [at[0] + x, at[1] + y];
    }
    corners
}

/// Points of the plane spanned by two integer vectors.
pub fn onto_plane(flat: &[[i32; 2]], u: [i32; 3], v: [i32; 3], origin: [i32; 3]) -> Corners {
    let place = |&[x, y]: &[i32; 2]| {
        DVec3::from_array(std::array::from_fn(|i| f64::from(origin[i] + x * u[i] + y * v[i])))
    };
    flat.iter().map(place).collect()
}

/// Returns a regular polygon of `n` corners and radius 1.
pub fn regular(n: usize, turn: DMat3, centre: DVec3) -> Corners {
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / n as f64;
    (0..n).map(|k| turn * DVec3::new(angle(k).cos(), angle(k).sin(), 0.0) + centre).collect()
}

/// Returns a triangle, and two smaller triangles on one of its edges that meet in the middle of this edge: a
/// T-junction.
pub fn t_junction([a, b, c]: [DVec3; 3], apex: DVec3) -> Vec<Corners> {
    let middle = (a + b) * 0.5;
    vec![vec![a, b, c], vec![middle, a, apex], vec![b, middle, apex]]
}

/// Returns a triangle with two corners on the plane of another triangle. `weights` are in eighths, and `apex`
/// is the third corner.
pub fn resting_on([a, b, c]: [DVec3; 3], weights: [[i32; 2]; 2], apex: DVec3) -> Corners {
    let on = |[s, t]: [i32; 2]| {
        let (s, t) = (f64::from(s) / 8.0, f64::from(t) / 8.0);
        a + (b - a) * s + (c - a) * t
    };
    vec![on(weights[0]), on(weights[1]), apex]
}

/// Returns the representable value a number of steps away from `value`.
pub fn ulps_from(value: f64, steps: i32) -> f64 {
    let step = |v: f64| if steps > 0 { v.next_up() } else { v.next_down() };
    (0..steps.abs()).fold(value, |v, _| step(v))
}

/// Triangles around one vertex at a height above their circle: a cone, or a flat fan.
pub fn fan(sides: usize, height: f64) -> Vec<Corners> {
    let corner = |k: usize| {
        let angle = std::f64::consts::TAU * (k % sides) as f64 / sides as f64;
        DVec3::new(angle.cos(), angle.sin(), 0.0)
    };
    let tip = DVec3::new(0.0, 0.0, height);
    (0..sides).map(|k| vec![tip, corner(k), corner(k + 1)]).collect()
}
