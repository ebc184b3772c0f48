use super::{Material, Scene};
use glam::DVec3;

/// SplitMix64: G. L. Steele, D. Lea and C. H. Flood, "Fast splittable
/// pseudorandom number generators", OOPSLA 2014. The same numbers everywhere.
#[derive(Clone, Debug)]
pub(super) struct SplitMix64(u64);

impl SplitMix64 {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in `low..high`; all 53 bits of the unit interval are random.
    pub(super) fn range(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        low + unit * (high - low)
    }

    pub(super) fn point(&mut self, low: f64, high: f64) -> DVec3 {
        DVec3::new(self.range(low, high), self.range(low, high), self.range(low, high))
    }
}

/// The shortest and the longest edge of a random triangle.
const EDGES: (f64, f64) = (0.1, 0.3);

/// `count` triangles anywhere in the unit cube, every edge between 0.1 and 0.3
/// long; up is z. Most of a dense scene's triangles cross others.
pub fn random_triangles(count: u32, seed: u64) -> Scene {
    let mut scene = Scene::new(format!("random:{count}"), DVec3::Z);
    Material::palette().for_each(|material| {
        scene.add_material(material);
    });
    let mut random = SplitMix64::new(seed);
    for index in 0..count {
        scene.push(triangle(&mut random), index % 8);
    }
    scene
}

/// Draws until the triangle fits. One draw in about 16 does; a thousand misses
/// in a row are as good as impossible, and then a fixed triangle ends the loop.
fn triangle(random: &mut SplitMix64) -> [DVec3; 3] {
    for _ in 0..1000 {
        let a = random.point(0.0, 1.0);
        let b = a + random.point(-EDGES.1, EDGES.1);
        let c = a + random.point(-EDGES.1, EDGES.1);
        if fits([a, b, c]) {
            return [a, b, c];
        }
    }
    [DVec3::ZERO, DVec3::X * EDGES.1, DVec3::Y * EDGES.1 * 0.5]
}

fn fits([a, b, c]: [DVec3; 3]) -> bool {
    let edges = [b - a, c - b, a - c].map(DVec3::length_squared);
    let inside = |p: DVec3| p.min_element() >= 0.0 && p.max_element() <= 1.0;
    let fair = |square| (EDGES.0 * EDGES.0..=EDGES.1 * EDGES.1).contains(&square);
    inside(b) && inside(c) && edges.into_iter().all(fair)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first outputs for seed 1234567, as listed by the reference
    /// implementations.
    #[test]
    fn splitmix_gives_the_published_sequence() {
        let mut random = SplitMix64::new(1_234_567);
        let first = [random.next(), random.next(), random.next()];
        let published =
            [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
        assert_eq!(first, published);
    }
}
