//! All faces along the ray of each pixel, sorted exactly.

use std::cmp::Ordering;

use dashu_int::IBig;
use num_traits::Signed;

use binspace::internals::Faces;
use binspace::raster::{Outline, Piece, Rays, for_each_run};

/// The faces that each pixel's ray meets, the nearest first. If two faces are met at the same point, the face
/// of the later polygon comes first, because it is painted later.
///
/// Where the ray meets a plane is a fraction of two integers, and fractions are compared by
/// multiplication, so every order is exact.
#[derive(Clone, Debug)]
pub struct Layers {
    pixels: Vec<Vec<u32>>,
}

/// The point where a ray meets a face: start/slope times the ray's direction, with a slope above 0.
#[derive(Debug)]
struct Meeting {
    face: u32,
    start: IBig,
    slope: IBig,
}

/// The plane of a face: normal · point = offset.
struct Plane {
    normal: [IBig; 3],
    offset: IBig,
}

impl Plane {
    fn of(faces: &Faces, face: u32) -> Self {
        let triangle = faces.reference_triangle(face);
        // Lattice points are integers.
        let [p, q, r] = triangle.map(|k| faces.corner(k).map(|c| IBig::from(c as i64)));
        let arm = |to: &[IBig; 3]| [0, 1, 2].map(|i| &to[i] - &p[i]);
        let [u, v] = [arm(&q), arm(&r)];
        let normal = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &u[i] * &v[j] - &u[j] * &v[i]);
        let offset = (0..3).map(|i| &normal[i] * &p[i]).sum();
        Self { normal, offset }
    }

    fn dot(&self, vector: [i128; 3]) -> IBig {
        (0..3).map(|i| &self.normal[i] * vector[i]).sum()
    }

    fn meet(&self, face: u32, [start, direction]: [[i128; 3]; 2]) -> Meeting {
        let (start, slope) = (&self.offset - self.dot(start), self.dot(direction));
        match slope.is_negative() {
            true => Meeting { face, start: -start, slope: -slope },
            false => Meeting { face, start, slope },
        }
    }
}

impl Meeting {
    fn compare(&self, other: &Self, faces: &Faces) -> Ordering {
        let rank = |meeting: &Self| (faces.polygon(meeting.face), meeting.face);
        let depth = (&self.start * &other.slope).cmp(&(&other.start * &self.slope));
        depth.then(rank(other).cmp(&rank(self)))
    }
}

impl Layers {
    /// Finds the layers of a picture: the pixels that each face covers, and the order in each pixel.
    pub fn new(rays: &Rays, faces: &Faces) -> Self {
        let [width, height] = rays.size().map(|side| side as usize);
        let mut met: Vec<Vec<Meeting>> = Vec::new();
        met.resize_with(width * height, Vec::new);
        for face in 0..faces.len() as u32 {
            let plane = Plane::of(faces, face);
            for_each_run(rays, faces, Piece { face, outline: Outline::Whole }, |y, columns| {
                for x in columns {
                    let pixel = y as usize * width + x as usize;
                    met[pixel].push(plane.meet(face, rays.ray(x, y)));
                }
            });
        }
        let sorted = |mut met: Vec<Meeting>| {
            met.sort_unstable_by(|a, b| a.compare(b, faces));
            met.into_iter().map(|meeting| meeting.face).collect()
        };
        Self { pixels: met.into_iter().map(sorted).collect() }
    }

    /// Returns the faces of each pixel, row by row from the top left, each the nearest first.
    pub fn pixels(&self) -> impl ExactSizeIterator<Item = &[u32]> + Clone {
        self.pixels.iter().map(Vec::as_slice)
    }

    /// Returns the number of layers of the deepest pixel.
    pub fn deepest(&self) -> usize {
        self.pixels().map(<[u32]>::len).max().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use binspace::glam::DVec3;
    use binspace::raster::{NONE, zbuffer};
    use binspace::scene;
    use binspace::view;

    #[test]
    fn the_first_layer_matches_the_depth_buffer() {
        let mut pixels = 0;
        for scene in [scene::random_triangles(80, 3), scene::crossing(7), scene::newell_bars()] {
            let (faces, _) = Faces::new(scene.polygons(), Some(0.0)).unwrap();
            let (low, high) = scene.bounds().unwrap();
            for camera in view::views([low, high], scene.up(), 3, [64, 48], 5).unwrap() {
                let rays = Rays::new(&camera, &faces).unwrap();
                let truth = zbuffer(&rays, &faces);
                let layers = Layers::new(&rays, &faces);
                for (layers, &nearest) in layers.pixels().zip(truth.image().faces()) {
                    assert_eq!(layers.first().copied().unwrap_or(NONE), nearest);
                    pixels += usize::from(nearest != NONE);
                }
            }
        }
        assert!(pixels > 2000, "{pixels}");
    }

    /// Squares in one plane and one before them, as seen from above. The later of two coplanar squares is
    /// painted later, from either side.
    #[test]
    fn of_faces_at_one_depth_the_later_polygon_is_the_nearer() {
        let square = |z: f64| {
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| DVec3::new(x, y, z))
        };
        let (faces, _) = Faces::new([square(0.0), square(1.0), square(0.0)], Some(0.0)).unwrap();
        let centre = DVec3::new(0.5, 0.5, 0.0);
        for (ahead, expected) in [(DVec3::NEG_Z, [1, 2, 0]), (DVec3::Z, [2, 0, 1])] {
            let camera = view::Camera::parallel(ahead, DVec3::Y, centre, 0.8, [4, 4]).unwrap();
            let layers = Layers::new(&Rays::new(&camera, &faces).unwrap(), &faces);
            for found in layers.pixels() {
                let found: Vec<usize> = found.iter().map(|&face| faces.polygon(face)).collect();
                assert_eq!(found, expected, "{ahead}");
            }
        }
    }
}
