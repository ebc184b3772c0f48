//! The Cornell box in patches, lit by its lamp: direct light and one bounce.
//!
//! The positions and reflectances of its surfaces were measured at Cornell University
//! (<https://www.graphics.cornell.edu/online/box/data.html>).

use std::ops::Range;

use binspace::glam::{DVec3, dvec3};
use binspace::scene::{Scene, cornell_box};
use binspace::{BspTree, Error};

use crate::patches::{FormFactors, Patch, patches};

/// Numbers of the scene's polygons.
const CEILING: usize = 1;
const LAMP: usize = 2;
/// The light that the lamp sends out for each unit of area, in each channel.
const LAMP_LIGHT: f64 = 1.0;
/// The share of light that the paints reflect at 620, 540 and 460 nm, and that the lamp reflects at all
/// wavelengths.
const WHITE: [f64; 3] = [0.744, 0.743, 0.765];
const GREEN: [f64; 3] = [0.126, 0.441, 0.104];
const RED: [f64; 3] = [0.513, 0.059, 0.062];
const OF_LAMP: [f64; 3] = [0.78; 3];

/// The room, divided into patches, and the light between them.
#[derive(Debug)]
pub struct Room {
    /// The patches of all surfaces.
    pub patches: Vec<Patch>,
    /// The form factors of the patches.
    pub factors: FormFactors,
    /// The reflectance of each patch at 620, 540 and 460 nm.
    reflected: Vec<[f64; 3]>,
    light: Vec<f64>,
    /// The patches of the black wall that closes the room.
    closing: Range<usize>,
}

/// The destinations of light, in shares of the lamp's light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balance {
    /// The light that arrived at the surfaces straight from the lamp.
    pub arrived: f64,
    /// The light that left through the open side straight from the lamp.
    pub escaped: f64,
}

impl Room {
    /// Divides the room into patches about as long as `length`, with `side`² sight lines for each pair of
    /// patches.
    ///
    /// The ceiling has a hole where the lamp is. A black wall closes the open side, so that escaping light is
    /// counted.
    ///
    /// # Errors
    ///
    /// As for [`BspTree::build`].
    pub fn new(length: f64, side: u32) -> Result<Self, Error> {
        Self::seeded(length, side, 1)
    }

    fn seeded(length: f64, side: u32, seed: u64) -> Result<Self, Error> {
        let scene = cornell_box();
        let (quads, colours) = surfaces(&scene);
        let tree = BspTree::build(quads.iter().copied())?;
        let patches = patches(&quads, length);
        let factors = FormFactors::new(&tree, &patches, side, seed);
        let reflected = patches.iter().map(|patch| colours[patch.quad]).collect();
        let is_lamp = |patch: &Patch| patch.quad == quads.len() - 2;
        let light = patches.iter().map(|p| if is_lamp(p) { LAMP_LIGHT } else { 0.0 }).collect();
        let last = patches.iter().filter(|patch| patch.quad == quads.len() - 1).count();
        let closing = patches.len() - last..patches.len();
        Ok(Self { patches, factors, reflected, light, closing })
    }

    /// Returns the number of patches that are surfaces of the scene. These patches come first; the others
    /// close the room.
    pub fn surfaces(&self) -> usize {
        self.closing.start
    }

    /// Returns the light that leaves each patch: its own light, its reflection of the lamp's light, and after
    /// `bounces` its reflection of the light that others reflect.
    pub fn leaving(&self, bounces: u32) -> Vec<[f64; 3]> {
        let channels = [0, 1, 2].map(|channel| {
            let (mut step, mut sum) = (self.light.clone(), self.light.clone());
            for _ in 0..=bounces {
                step = self.factors.arriving(&step);
                for (k, light) in step.iter_mut().enumerate() {
                    *light *= self.reflected[k][channel];
                    sum[k] += *light;
                }
            }
            sum
        });
        (0..self.patches.len()).map(|k| [0, 1, 2].map(|c| channels[c][k])).collect()
    }

    /// Returns the destinations of the lamp's light.
    pub fn balance(&self) -> Balance {
        let sent: f64 =
            self.patches.iter().zip(&self.light).map(|(p, light)| p.area() * light).sum();
        let arriving = self.factors.arriving(&self.light);
        let share = |range: Range<usize>| {
            range.map(|k| arriving[k] * self.patches[k].area()).sum::<f64>() / sent
        };
        Balance { arrived: share(0..self.closing.start), escaped: share(self.closing.clone()) }
    }
}

/// The quads and their reflectances: the scene's, with the ceiling in four parts around the lamp; then the
/// lamp, and the wall that closes the room.
fn surfaces(scene: &Scene) -> (Vec<[DVec3; 4]>, Vec<[f64; 3]>) {
    let quad = |k: usize| -> [DVec3; 4] { std::array::from_fn(|i| scene.polygon(k)[i]) };
    let colour = |k: usize| match &*scene.material(k).name {
        "green" => GREEN,
        "red" => RED,
        "lamp" => OF_LAMP,
        _ => WHITE,
    };
    let others = (0..scene.len()).filter(|&k| k != CEILING && k != LAMP);
    let mut all: Vec<_> = others.map(|k| (quad(k), colour(k))).collect();
    let (lamp, ceiling) = (quad(LAMP), quad(CEILING));
    let ends = |quad: [DVec3; 4]| {
        quad.into_iter().fold((quad[0], quad[0]), |(a, b), p| (a.min(p), b.max(p)))
    };
    let ((low, high), (inner, outer)) = (ends(ceiling), ends(lamp));
    // Fronts face down.
    let part = |[x0, x1]: [f64; 2], [z0, z1]: [f64; 2]| {
        [[x1, z0], [x1, z1], [x0, z1], [x0, z0]].map(|[x, z]| dvec3(x, low.y, z))
    };
    for (x, z) in [
        ([low.x, high.x], [low.z, inner.z]),
        ([low.x, high.x], [outer.z, high.z]),
        ([low.x, inner.x], [inner.z, outer.z]),
        ([outer.x, high.x], [inner.z, outer.z]),
    ] {
        all.push((part(x, z), colour(CEILING)));
    }
    all.push((part([inner.x, outer.x], [inner.z, outer.z]), colour(LAMP)));
    let floor = quad(0);
    all.push(([floor[1], floor[0], ceiling[0], ceiling[3]], [0.0; 3]));
    all.into_iter().unzip()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lamps_light_arrives_or_escapes() {
        let off = [1, 4].map(|side| {
            let room = Room::new(180.0, side).unwrap();
            let Balance { arrived, escaped } = room.balance();
            assert!(escaped > 0.05 && escaped < 0.3, "{escaped}");
            (arrived + escaped - 1.0).abs()
        });
        assert!(off[0] < 0.1 && off[1] < 0.02, "{off:?}");
    }

    /// The reflectance of a patch, by its place: the walls on the left and on the right are painted.
    fn paint(patch: &Patch) -> [f64; 3] {
        let is_all = |is_there: fn(f64) -> bool| patch.corners.iter().all(|p| is_there(p.x));
        match patch {
            _ if is_all(|x| x < 1.0) => [0.126, 0.441, 0.104],
            _ if is_all(|x| x > 549.0) => [0.513, 0.059, 0.062],
            _ => [0.744, 0.743, 0.765],
        }
    }

    /// B = E + ρ F B holds for each bounce and each wavelength, and all light that leaves surfaces arrives
    /// somewhere.
    #[test]
    fn light_obeys_the_radiosity_equation_and_none_is_lost() {
        let room = Room::new(180.0, 4).unwrap();
        let sum = |of: &[f64]| -> f64 {
            of.iter().zip(&room.patches).map(|(light, patch)| light * patch.area()).sum()
        };
        let mut first_lit = [0; 2];
        for channel in 0..3 {
            let mut before = room.light.clone();
            for bounces in 0..3 {
                let arriving = room.factors.arriving(&before);
                let lost = sum(&arriving) / sum(&before) - 1.0;
                assert!(lost.abs() < 0.02, "{bounces}: {lost}");
                let leaving: Vec<f64> = room.leaving(bounces).iter().map(|l| l[channel]).collect();
                for (k, patch) in room.patches[..room.surfaces()].iter().enumerate() {
                    let expected = match room.light[k] {
                        0.0 => paint(patch)[channel] * arriving[k],
                        own => own + 0.78 * arriving[k],
                    };
                    assert!((leaving[k] - expected).abs() < 1e-12, "{patch:?}");
                    // The ceiling is in the plane of the lamp.
                    let is_ceiling =
                        room.light[k] == 0.0 && patch.corners.iter().all(|p| p.y == 548.8);
                    if is_ceiling && bounces < 2 {
                        assert_eq!(leaving[k] > 0.0, bounces == 1);
                        first_lit[bounces as usize] += 1;
                    }
                }
                assert!(leaving[room.surfaces()..].iter().all(|&light| light == 0.0));
                before = leaving;
            }
        }
        assert!(first_lit[1] > 10, "{first_lit:?}");
    }

    /// With sixteen times as many sight lines, the share of light that is lost or gained falls to a fourth or
    /// less, over several seeds.
    #[test]
    fn the_balance_approaches_1_with_more_sight_lines() {
        let off = [1, 4].map(|side| {
            let square = |seed: u64| {
                let Balance { arrived, escaped } =
                    Room::seeded(180.0, side, seed).unwrap().balance();
                (arrived + escaped - 1.0).powi(2)
            };
            ((1..=6).map(square).sum::<f64>() / 6.0).sqrt()
        });
        assert!(4.0 * off[1] < off[0] && off[1] < 0.01, "{off:?}");
    }
}
