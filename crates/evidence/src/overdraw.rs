//! Overdraw: the number of tests and of writes of each pixel.

use std::ops::Range;

use binspace::internals::Faces;
use binspace::occlusion::CoverageMask;
use binspace::raster::{NONE, Outline, Piece, Rays, for_each_run};
use binspace::{BspTree, Error, Flow, Part};

use crate::layers::Layers;
use binspace::internals::Pieces;

/// The work that a picture took, pixel by pixel, row by row from the top left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Overdraw {
    /// The number of times that a pixel was found to be covered. For each of these times, a depth was
    /// computed or a mask was read.
    pub tested: Vec<u32>,
    /// The number of times that a colour was stored in a pixel.
    pub written: Vec<u32>,
}

impl Overdraw {
    fn new(rays: &Rays) -> Self {
        let [width, height] = rays.size().map(|side| side as usize);
        Self { tested: vec![0; width * height], written: vec![0; width * height] }
    }

    /// Returns the number of all tests, and the number of all writes.
    pub fn sums(&self) -> [u64; 2] {
        [&self.tested, &self.written].map(|counts| counts.iter().map(|&n| u64::from(n)).sum())
    }

    /// Returns the number of pixels that show something.
    pub fn shown(&self) -> u64 {
        self.written.iter().filter(|&&count| count > 0).count() as u64
    }

    /// Counts a run of pixels, each written if `is_written` returns true.
    fn add(
        &mut self,
        width: u32,
        (y, columns): (u32, Range<u32>),
        mut is_written: impl FnMut(usize, u32) -> bool,
    ) {
        for x in columns {
            let pixel = (y * width + x) as usize;
            self.tested[pixel] += 1;
            self.written[pixel] += u32::from(is_written(pixel, self.written[pixel]));
        }
    }
}

/// Returns the overdraw of a painter: it writes a pixel once for every fragment that covers it.
pub fn painter(tree: &BspTree, rays: &Rays) -> Overdraw {
    let (mut overdraw, mut pieces) = (Overdraw::new(rays), Pieces::default());
    let width = rays.size()[0];
    for fragment in tree.back_to_front(rays.viewpoint()) {
        for_each_run(rays, tree.faces(), pieces.of(&fragment), |y, columns| {
            overdraw.add(width, (y, columns), |_, _| true);
        });
    }
    overdraw
}

/// Paints from front to back with a mask of the covered pixels: each pixel is written once. Subtrees whose
/// box the mask hides are skipped. Once all pixels are covered, the traversal ends.
///
/// # Errors
///
/// If there is not enough memory.
pub fn front_to_back(tree: &BspTree, rays: &Rays) -> Result<Overdraw, Error> {
    let (mut overdraw, mut pieces) = (Overdraw::new(rays), Pieces::default());
    let width = rays.size()[0];
    let mut mask = CoverageMask::new(tree, rays, 1);
    let _ = tree.order(rays.viewpoint()).front_to_back().walk(|part| {
        match part {
            Part::Subtree(node) if mask.hides(node.bounds()) => return Flow::Skip,
            Part::Subtree(_) => {}
            Part::Fragment(fragment) if mask.hides(fragment.bounds()) => {}
            Part::Fragment(fragment) => {
                mask.cover(&fragment);
                for_each_run(rays, tree.faces(), pieces.of(&fragment), |y, columns| {
                    overdraw.add(width, (y, columns), |_, before| before == 0);
                });
            }
        }
        if mask.is_full() { Flow::Break(()) } else { Flow::Descend }
    });
    Ok(overdraw)
}

/// Returns the overdraw of a depth buffer for faces in some order: a pixel is written whenever a face is
/// nearer than all earlier ones. `layers` must have been made with the same rays.
pub fn depth_buffer(
    faces: &Faces,
    rays: &Rays,
    layers: &Layers,
    order: impl IntoIterator<Item = u32>,
) -> Overdraw {
    let mut overdraw = Overdraw::new(rays);
    let width = rays.size()[0];
    let layers: Vec<&[u32]> = layers.pixels().collect();
    // The place of the currently visible layer of each pixel among all its layers.
    let mut shown = vec![NONE as usize; layers.len()];
    for face in order {
        for_each_run(rays, faces, Piece { face, outline: Outline::Whole }, |y, columns| {
            overdraw.add(width, (y, columns), |pixel, _| {
                let place = layers[pixel].iter().position(|&other| other == face);
                let is_nearer = place.is_some_and(|place| place < shown[pixel]);
                if let Some(place) = place.filter(|_| is_nearer) {
                    shown[pixel] = place;
                }
                is_nearer
            });
        });
    }
    overdraw
}

/// Returns a colour for each count: black for zero, blue for one, then green and yellow, and red for `most`
/// or more.
pub fn heat(counts: &[u32], most: u32) -> Vec<u8> {
    const STOPS: [[f64; 3]; 5] = [
        [40.0, 60.0, 150.0],
        [30.0, 150.0, 170.0],
        [90.0, 190.0, 80.0],
        [240.0, 210.0, 60.0],
        [210.0, 40.0, 30.0],
    ];
    let colour = |&count: &u32| {
        if count == 0 {
            return [0; 3];
        }
        let share = f64::from(count.min(most) - 1) / f64::from(most.max(2) - 1);
        let at = share * (STOPS.len() - 1) as f64;
        let below = (at as usize).min(STOPS.len() - 2);
        let part = at - below as f64;
        [0, 1, 2].map(|i| (STOPS[below][i] * (1.0 - part) + STOPS[below + 1][i] * part) as u8)
    };
    counts.iter().flat_map(colour).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use binspace::glam::DVec3;
    use binspace::view::Camera;

    fn square(side: f64, z: f64) -> [DVec3; 4] {
        let at = |x: f64, y: f64| DVec3::new(x, y, z);
        [at(0.0, 0.0), at(side, 0.0), at(side, side), at(0.0, side)]
    }

    /// The tests and writes of squares seen from above, in 20 by 20 pixels of 0.1 each: by a painter, from
    /// front to back with a mask, and by depth buffers in input order and in reverse order.
    fn sums(squares: &[[DVec3; 4]]) -> [[u64; 2]; 4] {
        let tree = BspTree::build(squares).unwrap();
        let centre = DVec3::new(0.5, 0.5, 0.0);
        let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, centre, 2.0, [20, 20]).unwrap();
        let rays = Rays::new(&camera, tree.faces()).unwrap();
        let layers = Layers::new(&rays, tree.faces());
        let all = || 0..tree.faces().len() as u32;
        [
            painter(&tree, &rays),
            front_to_back(&tree, &rays).unwrap(),
            depth_buffer(tree.faces(), &rays, &layers, all()),
            depth_buffer(tree.faces(), &rays, &layers, all().rev()),
        ]
        .map(|overdraw| overdraw.sums())
    }

    #[test]
    fn counts_match_hand_computation() {
        // Squares of 10 by 10 pixels, the highest last.
        let stack = [square(1.0, 0.0), square(1.0, 1.0), square(1.0, 2.0)];
        assert_eq!(sums(&stack), [[300, 300], [100, 100], [300, 300], [300, 100]]);
        // 5 by 5 pixels on 10 by 10: the mask hides no part of the larger square.
        let step = [square(1.0, 0.0), square(0.5, 1.0)];
        assert_eq!(sums(&step), [[125, 125], [125, 100], [125, 125], [125, 100]]);
        // The middle square comes first, then the lowest, then the highest.
        let mixed = [square(1.0, 1.0), square(1.0, 0.0), square(1.0, 2.0)];
        assert_eq!(sums(&mixed), [[300, 300], [100, 100], [300, 200], [300, 100]]);
    }

    #[test]
    fn each_way_shows_the_same_pixels() {
        let scene = binspace::scene::random_triangles(70, 5);
        let tree = BspTree::build(scene.polygons()).unwrap();
        let (low, high) = scene.bounds().unwrap();
        for camera in binspace::view::views([low, high], DVec3::Z, 3, [64, 48], 1).unwrap() {
            let rays = Rays::new(&camera, tree.faces()).unwrap();
            let layers = Layers::new(&rays, tree.faces());
            let faces = tree.faces();
            let by_depth = depth_buffer(faces, &rays, &layers, 0..faces.len() as u32);
            let painted = painter(&tree, &rays);
            let once = front_to_back(&tree, &rays).unwrap();
            let depths: Vec<u32> = layers.pixels().map(|layers| layers.len() as u32).collect();
            assert_eq!(painted.written, depths);
            assert_eq!(by_depth.tested, depths);
            assert!(once.written.iter().zip(&depths).all(|(&n, &depth)| n == depth.min(1)));
            let between = by_depth.written.iter().zip(&depths);
            assert!(between.clone().all(|(&n, &depth)| n.min(1) == depth.min(1) && n <= depth));
            assert!(once.sums()[0] < painted.sums()[0]);
        }
    }

    #[test]
    fn heat_goes_from_black_to_red() {
        let colours = heat(&[0, 1, 5, 9], 5);
        assert_eq!(colours[..6], [0, 0, 0, 40, 60, 150]);
        assert_eq!(colours[6..], [210, 40, 30, 210, 40, 30]);
    }
}
