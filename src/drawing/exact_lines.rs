//! On which side of a line of the picture two others meet, and where: in floats and in integers.
//!
//! A line is given by three integers k: it goes through the points (x, y) of the picture, in pixels,
//! with k₀ + x·k₁ + y·k₂ = 0. The edge between two points is the
//! plane through both and the eye. The cut of a face f by a plane h is where a ray meets both: with
//! κ the value of a plane at the eye (of parallel rays, its slope along them) and φ its value along a
//! ray, k = κ_f φ_h − κ_h φ_f.
//!
//! With corners below 2⁵², rays below 2⁶⁰ and an eye below 2⁸¹, an edge has 197 bits and a cut 361; the
//! determinant of three lines has less than 1088.

use std::cmp::Ordering;

use super::lines::{HalfPlane, LineTable, NOWHERE};
use crate::exact::lattice::{exponent_of, scaled};
use crate::exact::{Faces, Int, Plane, PlaneId, dot};
use crate::raster::{RayOrigin, Rays};

impl LineTable<'_> {
    /// On which side of a half's line the point lies where two others meet, the second turning to the
    /// left of the first as seen from their halves: exact.
    #[cold]
    pub(super) fn exact_side(&self, half: HalfPlane, [first, second]: [HalfPlane; 2]) -> Ordering {
        let lines = [first, second, half];
        if half.line() == first.line() || half.line() == second.line() || self.share_point(lines) {
            return Ordering::Equal;
        }
        let side = orientation(lines.map(|half| self.exact(half)).each_ref());
        let flips = lines.iter().filter(|half| half.is_negative()).count();
        if flips % 2 == 1 { side.reverse() } else { side }
    }

    /// On which side of a line, which may be none of these, the point lies where two others meet: exact.
    #[cold]
    pub(super) fn exact_side_of(&self, line: &ExactLine, corner: [HalfPlane; 2]) -> Ordering {
        let [a, b] = corner.map(|half| self.exact(half));
        let side = orientation([&a, &b, line]);
        if corner[0].is_negative() == corner[1].is_negative() { side } else { side.reverse() }
    }

    /// Where two lines meet, from integers, and how far off that may be by rounding.
    #[cold]
    pub(super) fn exact_meeting(&self, halves: [HalfPlane; 2]) -> ([f64; 2], f64) {
        let exact = halves.map(|half| self.exact(half));
        let at = meeting(exact.each_ref());
        let radius = 8.0 * ROUNDING * self.reach[0].max(self.reach[1]);
        if self.shows(at) { (at, radius) } else { ([0.0; 2], f64::INFINITY) }
    }

    /// Whether three lines are known to go through one point.
    fn share_point(&self, lines: [HalfPlane; 3]) -> bool {
        let through = lines.map(|half| half.number().map(|line| self.through[line as usize]));
        let [Some(a), Some(b), Some(c)] = through else { return false };
        a.iter().any(|point| *point != NOWHERE && b.contains(point) && c.contains(point))
    }
}

/// The coefficients of a line.
pub(super) type ExactLine = [Int<6>; 3];

/// What all lines of a picture share: its rays, and the faces.
#[derive(Clone, Debug)]
pub(super) struct Frame<'t> {
    pub(super) rays: Rays,
    pub(super) faces: &'t Faces,
}

/// A plane as the rays meet it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheet {
    kappa: Int<4>,
    phi: [Int<3>; 3],
}

/// A point of the scene in the picture: a weight, which is positive ahead of the eye, and that many times
/// its coordinates.
pub(super) type Image = [Int<4>; 3];

impl Frame<'_> {
    /// A plane of the scene, as the rays meet it.
    pub(super) fn sheet(&self, plane: PlaneId) -> Sheet {
        self.sheet_of(&self.faces.plane(plane))
    }

    /// The plane through two lattice points and along an axis, as the rays meet it.
    pub(super) fn upright(&self, [a, b]: [[f64; 3]; 2], axis: usize) -> Sheet {
        self.sheet_of(&Plane::upright(a, b, axis))
    }

    fn sheet_of(&self, plane: &Plane) -> Sheet {
        let Rays { base, right, down, pencil, .. } = self.rays;
        let point = plane.point();
        let (kappa, first) = match pencil {
            RayOrigin::From { eye, shift } => {
                let kappa = plane.along(eye).shifted::<4>(shift) - plane.along(point).resize();
                (kappa, base)
            }
            RayOrigin::Along { direction } => {
                let first = std::array::from_fn(|i| base[i] - point[i]);
                (plane.along(direction).resize(), first)
            }
        };
        Sheet { kappa, phi: [first, right, down].map(|v| plane.along(v)) }
    }

    /// Where a lattice point is in the picture.
    pub(super) fn image(&self, point: [f64; 3]) -> Image {
        let Rays { base, right, down, pencil, .. } = self.rays;
        let point = point.map(|c| c as i64);
        // With `base`, `right` and `down`, or `right`, `down` and the direction, as axes: G. Cramer's rule.
        // (Both are right-handed: cameras look along right × down.)
        match pencil {
            RayOrigin::From { eye, shift } => {
                let duals = [product(right, down), product(down, base), product(base, right)];
                duals.map(|dual| dot(dual, point).resize() - dot(dual, eye).shifted(shift))
            }
            RayOrigin::Along { direction } => {
                let arm = std::array::from_fn(|i| point[i] - base[i]);
                let [x, y] = [product(down, direction), product(direction, right)];
                [(x, right), (x, arm), (y, arm)].map(|(dual, v)| dot(dual, v).resize())
            }
        }
    }

    /// The edge from one lattice point to another. In the picture it leads along (k₂, −k₁). Of a face whose
    /// front is seen, the inside is where its edges are negative.
    pub(super) fn edge(&self, [a, b]: [[f64; 3]; 2]) -> ExactLine {
        let Rays { base, right, down, pencil, .. } = self.rays;
        let integer = |p: [f64; 3]| p.map(|c| c as i64);
        let (a, b) = (integer(a), integer(b));
        let arm = std::array::from_fn(|i| b[i] - a[i]);
        match pencil {
            // v · ((a − eye) × (b − eye)) = v · (a × arm) − v · (eye × arm)
            RayOrigin::From { eye, shift } => {
                let (near, far) = (product(a, arm), product(eye, arm));
                [base, right, down].map(|v| dot(near, v).resize() - dot(far, v).shifted(shift))
            }
            // (p − a) · (direction × arm)
            RayOrigin::Along { direction } => {
                let normal = product(direction, arm);
                let first = std::array::from_fn(|i| base[i] - a[i]);
                [first, right, down].map(|v| dot(normal, v).resize())
            }
        }
    }
}

impl Sheet {
    /// Where the plane is seen from: `Greater` is the side from which its κ is positive. A face whose
    /// front is seen has a positive one from an eye, a negative one along parallel rays.
    pub(super) fn side(&self) -> Ordering {
        self.kappa.sign()
    }

    /// The line in which the rays meet both planes. In front of the other plane, rays that meet a
    /// face's plane ahead have the sign of its κ.
    pub(super) fn cut(&self, other: &Self) -> ExactLine {
        std::array::from_fn(|i| {
            let ahead: Int<6> = self.kappa.times(&other.phi[i]);
            let behind: Int<6> = other.kappa.times(&self.phi[i]);
            ahead - behind
        })
    }
}

/// On which side of a third line two lines meet, times the sign of the turn from the first to the
/// second.
pub(super) fn orientation([a, b, c]: [&ExactLine; 3]) -> Ordering {
    let minor =
        |i: usize, j: usize| -> Int<12> { a[i].times::<6, 12>(&b[j]) - a[j].times::<6, 12>(&b[i]) };
    let term = |i: usize, minor: Int<12>| -> Int<17> { minor.times(&c[i]) };
    (term(0, minor(1, 2)) + term(1, minor(2, 0)) + term(2, minor(0, 1))).sign()
}

/// On which side of a line a point is that is ahead of the eye.
pub(super) fn side_at(line: &ExactLine, image: &Image) -> Ordering {
    let term = |i: usize| -> Int<11> { line[i].times(&image[i]) };
    (term(0) + term(1) + term(2)).sign()
}

/// An order of lines: those that are one, in whatever direction, are equal. Lines are compared by the first of their
/// coefficients in an order, slopes first, that is not 0, and then by the ratios of the others to it.
pub(super) fn compare(a: &ExactLine, b: &ExactLine) -> Ordering {
    let order = [1, 2, 0];
    let [first, second] = [a, b].map(|line| order.iter().position(|&i| line[i].sign().is_ne()));
    let (Some(lead), Ordering::Equal) = (first, first.cmp(&second)) else {
        return first.cmp(&second);
    };
    let of = order[lead];
    let is_flipped = a[of].sign() != b[of].sign();
    let ratios = order[lead + 1..].iter().map(|&i| {
        let sign = (a[i].times::<6, 12>(&b[of]) - b[i].times::<6, 12>(&a[of])).sign();
        if is_flipped { sign.reverse() } else { sign }
    });
    ratios.fold(Ordering::Equal, Ordering::then)
}

/// Whether two numbers for one line have opposite signs.
pub(super) fn is_opposite(a: &ExactLine, b: &ExactLine) -> bool {
    (0..3).any(|i| a[i].sign().is_ne() && a[i].sign() != b[i].sign())
}

/// Where two lines meet, each coordinate rounded three times; NaN where they do not.
pub(super) fn meeting([a, b]: [&ExactLine; 2]) -> [f64; 2] {
    let minor = |i: usize, j: usize| {
        let minor = a[i].times::<6, 12>(&b[j]) - a[j].times::<6, 12>(&b[i]);
        minor.to_f64()
    };
    let turn = minor(1, 2);
    [minor(2, 0) / turn, minor(0, 1) / turn]
}

fn product(a: [i64; 3], b: [i64; 3]) -> [i128; 3] {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        i128::from(a[j]) * i128::from(b[k]) - i128::from(a[k]) * i128::from(b[j])
    })
}

/// The relative error of one rounding.
pub(super) const ROUNDING: f64 = f64::EPSILON / 2.0;

/// Lines that are further off in floats, in pixels, are computed from integers.
const FINE: f64 = 1.0 / (1u64 << 32) as f64;

/// A line in floats, scaled so that the longer part of its slope is near 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounded {
    pub(super) k: [f64; 3],
    /// The largest error of its values anywhere in the picture, computed as `k[0] + x·k[1] + y·k[2]`; and
    /// of its slope, times the picture's size.
    pub(super) error: f64,
    /// At least the length of its slope.
    pub(super) slope: f64,
}

impl Rounded {
    /// From exact coefficients, for a picture of this size.
    pub(super) fn new(exact: &ExactLine, reach: [f64; 2]) -> Self {
        let k = exact.each_ref().map(|c| c.to_f64());
        let sum = k[0].abs() + k[1].abs() * reach[0] + k[2].abs() * reach[1];
        Self::scaled(k, 8.0 * ROUNDING * sum)
    }

    pub(super) fn scaled(k: [f64; 3], error: f64) -> Self {
        let size = k[1].abs().max(k[2].abs());
        // A power of two: nothing is rounded. (A line without slope may have any scale.)
        let scale = if size > 0.0 { scaled(1.0, -exponent_of(size)) } else { 1.0 };
        Self { k: k.map(|c| c * scale), error: error * scale, slope: 1.01 * 1.42 * size * scale }
    }

    /// The same with its signs changed, if `flip`.
    pub(super) fn flipped(self, flip: bool) -> Self {
        if flip { Self { k: self.k.map(|c| -c), ..self } } else { self }
    }

    /// Whether it is off by so little that the line is not needed in integers to look at it.
    pub(super) fn is_fine(&self) -> bool {
        self.error < FINE
    }

    /// The value at a point, rounded.
    #[inline]
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> f64 {
        self.k[0] + (self.k[1] * x + self.k[2] * y)
    }
}
