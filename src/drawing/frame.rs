//! Lines of the picture, in integers.
//!
//! A line is given by three integers k: it goes through the points (x, y) of the picture, in pixels
//! from the centre of the first one, with k₀ + x·k₁ + y·k₂ = 0. The edge between two points is the
//! plane through both and the eye. The cut of a face f by a plane h is where a ray meets both: with
//! κ the value of a plane at the eye (of parallel rays, its slope along them) and φ its value along a
//! ray, k = κ_f φ_h − κ_h φ_f.
//!
//! With corners below 2⁵², rays below 2⁶⁰ and an eye below 2⁸¹, an edge has 197 bits and a cut 361; the
//! determinant of three lines has less than 1088.

use std::cmp::Ordering;

use crate::exact::{Faces, Int, Plane, PlaneId, dot};
use crate::raster::{Pencil, Rays};

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
            Pencil::From { eye, shift } => {
                let kappa = plane.along(eye).shifted::<4>(shift) - plane.along(point).resize();
                (kappa, base)
            }
            Pencil::Along { direction } => {
                let first = std::array::from_fn(|i| base[i] - point[i]);
                (plane.along(direction).resize(), first)
            }
        };
        Sheet { kappa, phi: [first, right, down].map(|v| plane.along(v)) }
    }

    /// The side of a face's plane from which rays come; `Equal` if they run along it.
    pub(super) fn seen_side(&self, face: u32) -> Ordering {
        let side = self.sheet(PlaneId::face(face)).side();
        if self.rays.is_perspective() { side } else { side.reverse() }
    }

    /// Where a lattice point is in the picture.
    pub(super) fn image(&self, point: [f64; 3]) -> Image {
        let Rays { base, right, down, pencil, .. } = self.rays;
        let point = point.map(|c| c as i64);
        // With `base`, `right` and `down`, or `right`, `down` and the direction, as axes: G. Cramer's rule.
        // (Both are right-handed: cameras look along right × down.)
        match pencil {
            Pencil::From { eye, shift } => {
                let duals = [product(right, down), product(down, base), product(base, right)];
                duals.map(|dual| dot(dual, point).resize() - dot(dual, eye).shifted(shift))
            }
            Pencil::Along { direction } => {
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
            Pencil::From { eye, shift } => {
                let (near, far) = (product(a, arm), product(eye, arm));
                [base, right, down].map(|v| dot(near, v).resize() - dot(far, v).shifted(shift))
            }
            // (p − a) · (direction × arm)
            Pencil::Along { direction } => {
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
