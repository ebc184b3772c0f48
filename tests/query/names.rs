//! Everything about a hit can be computed exactly from public data.

use binspace::{Grid, Ray};
use num_traits::One;
use testkit::prelude::*;
use testkit::rational::{Plane, Point};
use testkit::shots::Shots;

fn world(grid: Grid, point: [i64; 3]) -> Point {
    let two = Rational::from(2);
    let step = if grid.exponent >= 0 {
        num_traits::pow(two, grid.exponent as usize)
    } else {
        Rational::ONE / num_traits::pow(two, -grid.exponent as usize)
    };
    let base = rational::point(grid.base);
    std::array::from_fn(|i| &base[i] + &step * Rational::from(point[i]))
}

fn plane(grid: Grid, points: [[i64; 3]; 3]) -> Plane {
    let [p, q, r] = points.map(|point| world(grid, point));
    Plane::through([&p, &q, &r])
}

/// The parameter where a ray meets a plane.
fn parameter(plane: &Plane, from: &Point, direction: &Point) -> Rational {
    let slope = rational::scalar(&plane.normal, direction);
    assert!(!slope.is_zero(), "a ray that meets the plane");
    -plane.at(from) / slope
}

fn directed(ray: Ray) -> (Point, Point) {
    match ray {
        Ray::Segment { from, to } => {
            let from = rational::point(from);
            let direction = rational::difference(&rational::point(to), &from);
            (from, direction)
        }
        Ray::Endless { from, direction } => (rational::point(from), rational::point(direction)),
    }
}

#[test]
fn hits_can_be_computed_again_from_points_of_the_grid() {
    let (mut dice, mut hits, mut in_plane, mut ends) = (Dice(4), 0, 0, 0);
    for scene in [
        scene::random_triangles(40, 2),
        scene::city(120, 1),
        scene::crossing(7),
        scene::cornell_box(),
        scene::teapot(2),
    ] {
        let tree = BspTree::build(scene.polygons()).unwrap();
        let (grid, shots) = (tree.grid(), Shots::new(tree.faces()));
        for _ in 0..150 {
            let ray = shots.ray(&mut dice);
            let (from, direction) = directed(ray);
            let mut last = Rational::zero();
            for hit in tree.hits(ray) {
                let own = plane(grid, hit.fragment().grid_points());
                let t = match hit.grid_points() {
                    Some(points) => parameter(&plane(grid, points), &from, &direction),
                    None if hit.parameter() == 0.0 => Rational::zero(),
                    None => Rational::one(),
                };
                ends += usize::from(hit.grid_points().is_none());
                // The point is on the line by construction. It must be on the fragment's plane, in order, and
                // at the place that floats give.
                let point = rational::sum(&from, &direction.clone().map(|c| c * &t));
                assert!(own.at(&point).is_zero(), "{hit:?}");
                let slope = rational::sign(&rational::scalar(&own.normal, &direction));
                assert_eq!(hit.facing(), slope.reverse().into());
                in_plane += usize::from(slope.is_eq());
                assert!(t >= last, "{hit:?}");
                let rounded = t.to_f64().value();
                assert!((hit.parameter() - rounded).abs() <= rounded.abs() * 2f64.powi(-51));
                let off = rational::distance_to_rounded(&point, hit.point().to_array());
                assert!(off <= 1e-12 * (1.0 + hit.point().abs().max_element()), "{off} {hit:?}");
                last = t;
                hits += 1;
            }
        }
    }
    enough!(hits > 1500, in_plane > 150, ends > 100; "{hits} {in_plane} {ends}");
}

#[test]
fn planes_of_nodes_and_fragments_agree_with_their_corners() {
    let (mut checked, mut axes) = (0, 0);
    for (scene, far) in [
        (scene::random_triangles(80, 2), DVec3::ZERO),
        (scene::city(300, 1), DVec3::new(1e6, -3.0, 7e4)),
        (scene::teapot(3), DVec3::splat(-5.0)),
        (scene::crossing(9), DVec3::new(1e3, -2e3, 5e2)),
    ] {
        let moved =
            scene.polygons().map(|p| p.points().iter().map(|&c| c + far).collect::<Vec<_>>());
        let polygons: Vec<Vec<DVec3>> = moved.collect();
        let tree = BspTree::build(&polygons).unwrap();
        let grid = tree.grid();
        let (low, high) = scene.bounds().unwrap();
        let slack = 1e-8 * (high - low).max_element();
        for fragment in tree.fragments() {
            // These are the given corners, except for the rounding to the grid.
            for point in fragment.grid_points().map(|point| world(grid, point)) {
                let near = |c: &DVec3| rational::distance_to_rounded(&point, c.to_array());
                let least = polygons[fragment.polygon()].iter().map(near).fold(1.0, f64::min);
                assert!(least <= 2f64.powi(grid.exponent - 1), "{least:e}");
            }
        }
        for node in tree.nodes() {
            let exact = plane(grid, node.grid_points());
            let normal = DVec3::from_array(exact.normal.each_ref().map(|c| c.to_f64().value()));
            assert!((normal.normalize() - node.normal()).length() < 1e-14);
            let offset = exact.offset.to_f64().value() / normal.length();
            assert!((offset - node.offset()).abs() <= 1e-9 * (1.0 + offset.abs()));
            axes += usize::from(node.polygon().is_none());
            // A free plane is exactly the plane that floats give.
            if node.polygon().is_none() {
                let unit = rational::exact(normal.length());
                assert_eq!(&exact.offset / unit, rational::exact(node.offset()));
            }
            // All fragments are on the sides that the plane and its rounded form give.
            let unit = rational::exact(normal.length());
            for (fragments, sides) in
                [(node.on(), &[1, -1][..]), (node.in_front(), &[1]), (node.behind(), &[-1])]
            {
                for corner in fragments.flat_map(|f| tree.fragment(f).vertices()) {
                    let at = exact.at(&rational::point(corner)) / &unit;
                    let rounded = node.normal().dot(corner) - node.offset();
                    for &side in sides {
                        let at = &at * rational::exact(f64::from(side));
                        assert!(!(at + rational::exact(1e-6)).is_negative());
                        assert!(rounded * f64::from(side) > -slack, "{rounded}: {node:?}");
                        checked += 1;
                    }
                }
            }
        }
    }
    enough!(checked > 10_000, axes > 50; "{checked} {axes}");
}
