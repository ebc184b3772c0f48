//! Patches of surfaces that light one another: form factors by exact sight lines.
//!
//! C. Goral, K. Torrance, D. Greenberg and B. Battaile, "Modeling the interaction of light between diffuse
//! surfaces", 1984. The form factor from a point to a patch has a closed form; sight lines give its unblocked
//! share (D. Baum, H. Rushmeier and J. Winget, "Improving radiosity solutions through the use of analytically
//! determined form-factors", 1989).

use std::f64::consts::PI;

use binspace::glam::DVec3;
use binspace::internals::SplitMix64;
use binspace::{BspTree, Ray};

/// Sight lines end before the surfaces that they join, at this share of their length, because points of
/// surfaces are rounded. A face nearer to an end than this does not block the line.
pub const SHORTENED: f64 = 1e-6;

/// A quad that is lit evenly; its front is the side from which its corners run counter-clockwise.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    /// The corners.
    pub corners: [DVec3; 4],
    /// The number of the quad that the patch is a part of.
    pub quad: usize,
}

impl Patch {
    fn at(&self, u: f64, v: f64) -> DVec3 {
        let [a, b, c, d] = self.corners;
        a.lerp(b, u).lerp(d.lerp(c, u), v)
    }

    /// The normal, as long as the area.
    fn area_vector(&self) -> DVec3 {
        let [a, b, c, d] = self.corners;
        0.5 * (c - a).cross(d - b)
    }

    fn normal(&self) -> DVec3 {
        self.area_vector().normalize_or_zero()
    }

    /// Whether a part of this patch is in front of the plane of `other`.
    fn is_ahead_of(&self, other: &Self) -> bool {
        let normal = other.normal();
        self.corners.iter().any(|&p| normal.dot(p - other.corners[0]) > 0.0)
    }

    /// Returns the area of the patch.
    pub fn area(&self) -> f64 {
        self.area_vector().length()
    }
}

/// Divides quads into patches whose sides are not much longer than `length`.
pub fn patches(quads: &[[DVec3; 4]], length: f64) -> Vec<Patch> {
    let mut all = Vec::new();
    for (quad, &corners) in quads.iter().enumerate() {
        let whole = Patch { corners, quad };
        let parts =
            |a: usize, b: usize| (corners[a].distance(corners[b]) / length).round().max(1.0);
        let (across, along) = (parts(0, 1), parts(1, 2));
        for k in 0..(across * along) as usize {
            let (i, j) = ((k % across as usize) as f64, (k / across as usize) as f64);
            let at = |di: f64, dj: f64| whole.at((i + di) / across, (j + dj) / along);
            let corners = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
            all.push(Patch { corners, quad });
        }
    }
    all
}

/// Form factors of all pairs of patches. A form factor is the share of the light of an evenly bright patch
/// that arrives at another patch.
#[derive(Clone, Debug)]
pub struct FormFactors {
    /// From each patch to each, row by row.
    factors: Vec<f64>,
    patches: usize,
    /// The number of sight lines tested.
    pub sight_lines: usize,
}

impl FormFactors {
    /// Computes the form factors. Each patch has `side` × `side` points, at random in equal parts of the
    /// patch. For a pair of patches, each point of one is joined to one point of the other by a sight line.
    /// The form factor is the mean of the point form factors without obstacles, times the share of free sight
    /// lines, each weighted by the light that it carries.
    pub fn new(tree: &BspTree, patches: &[Patch], side: u32, seed: u64) -> Self {
        let n = patches.len();
        let mut found = Self { factors: vec![0.0; n * n], patches: n, sight_lines: 0 };
        let mut random = SplitMix64::new(seed);
        for i in 0..n {
            for j in 0..i {
                let pair = [&patches[i], &patches[j]];
                let [there, back] = found.between(tree, pair, side, &mut random);
                found.factors[i * n + j] = there;
                found.factors[j * n + i] = back;
            }
        }
        found
    }

    /// The form factors of two patches, in both directions.
    fn between(
        &mut self,
        tree: &BspTree,
        [a, b]: [&Patch; 2],
        side: u32,
        random: &mut SplitMix64,
    ) -> [f64; 2] {
        if !a.is_ahead_of(b) || !b.is_ahead_of(a) {
            return [0.0; 2];
        }
        let count = side * side;
        // Part k of one patch is joined to part k + shift of the other.
        let shift = (random.next() % u64::from(count)) as u32;
        let (mut sums, mut free, mut all) = ([0.0; 2], 0.0, 0.0);
        for k in 0..count {
            let [p, q] = [(a, k), (b, (k + shift) % count)].map(|(patch, k)| {
                let [u, v] = [k % side, k / side]
                    .map(|part| (f64::from(part) + unit(random)) / f64::from(side));
                patch.at(u, v)
            });
            sums[0] += seen(p, a.normal(), b);
            sums[1] += seen(q, b.normal(), a);
            let way = q - p;
            let slopes = [a.normal().dot(way), -b.normal().dot(way)].map(|slope| slope.max(0.0));
            let weight = slopes[0] * slopes[1] / way.length_squared().powi(2);
            if weight > 0.0 {
                self.sight_lines += 1;
                all += weight;
                free += if is_free(tree, p, q) { weight } else { 0.0 };
            }
        }
        let share = if all > 0.0 { free / all } else { 0.0 };
        sums.map(|sum| share * sum / f64::from(count))
    }

    /// Returns the share of the light of one patch that arrives at another.
    pub fn factor(&self, from: usize, to: usize) -> f64 {
        self.factors[from * self.patches + to]
    }

    /// Returns the share of the light of a patch that arrives anywhere: 1 in a closed room.
    pub fn sum(&self, from: usize) -> f64 {
        (0..self.patches).map(|to| self.factor(from, to)).sum()
    }

    /// Returns the light that arrives at each patch, for each unit of area, if `leaving` is the light that
    /// leaves them.
    pub fn arriving(&self, leaving: &[f64]) -> Vec<f64> {
        let n = self.patches;
        let at = |to: usize| (0..n).map(|from| self.factor(to, from) * leaving[from]).sum();
        (0..n).map(at).collect()
    }
}

/// The point form factor: the share of a surface point's light that goes towards the front of a patch, if
/// nothing hides the patch (J. Lambert, "Photometria", 1760). It is a sum over the edges of the part of the
/// patch above the point's horizon.
fn seen(point: DVec3, normal: DVec3, patch: &Patch) -> f64 {
    if patch.normal().dot(point - patch.corners[0]) <= 0.0 {
        return 0.0;
    }
    let mut above = Vec::with_capacity(5);
    for (k, &corner) in patch.corners.iter().enumerate() {
        let [p, q] = [corner, patch.corners[(k + 1) % 4]].map(|c| c - point);
        let [at_p, at_q] = [p, q].map(|c| normal.dot(c));
        if at_p >= 0.0 {
            above.push(p);
        }
        if at_p * at_q < 0.0 {
            above.push(p.lerp(q, at_p / (at_p - at_q)));
        }
    }
    let edge = |k: usize| {
        let (p, q) = (above[k], above[(k + 1) % above.len()]);
        let cross = p.cross(q);
        let angle = cross.length().atan2(p.dot(q));
        angle * normal.dot(cross.normalize_or_zero())
    };
    ((0..above.len()).map(edge).sum::<f64>() / (2.0 * PI)).abs()
}

/// Whether one point of a surface sees another.
fn is_free(tree: &BspTree, p: DVec3, q: DVec3) -> bool {
    !tree.is_occluded(Ray::between(p.lerp(q, SHORTENED), q.lerp(p, SHORTENED)))
}

/// A number from 0 to 1.
fn unit(random: &mut SplitMix64) -> f64 {
    (random.next() >> 11) as f64 / (1u64 << 53) as f64
}

#[cfg(test)]
mod tests;
