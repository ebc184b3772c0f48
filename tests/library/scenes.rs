//! Facts about the generated scenes: published measurements, counts,
//! orientation, determinism.

use std::collections::{HashMap, HashSet};
use testkit::prelude::*;

type Bits = [u64; 3];

fn bits(p: DVec3) -> Bits {
    // Adding 0 makes −0 equal to 0.
    (p + DVec3::ZERO).to_array().map(f64::to_bits)
}

/// The area vector: a normal whose length is twice the area.
fn normal(polygon: &[DVec3]) -> DVec3 {
    let from_first = |i: usize| polygon[i % polygon.len()] - polygon[0];
    (0..polygon.len()).map(|i| from_first(i).cross(from_first(i + 1))).sum()
}

fn centre(polygon: &[DVec3]) -> DVec3 {
    polygon.iter().sum::<DVec3>() / polygon.len() as f64
}

/// The directed edges whose reverse occurs in no polygon.
fn open_edges<'a>(polygons: impl Iterator<Item = &'a [DVec3]>) -> Vec<(DVec3, DVec3)> {
    let mut edges: HashMap<(Bits, Bits), (DVec3, DVec3)> = HashMap::new();
    let mut doubled = Vec::new();
    for polygon in polygons {
        for (i, &a) in polygon.iter().enumerate() {
            let b = polygon[(i + 1) % polygon.len()];
            if edges.remove(&(bits(b), bits(a))).is_none()
                && edges.insert((bits(a), bits(b)), (a, b)).is_some()
            {
                doubled.push((a, b));
            }
        }
    }
    doubled.extend(edges.into_values());
    doubled
}

fn outlines(scene: &Scene) -> impl Iterator<Item = &[DVec3]> + Clone {
    (0..scene.len()).map(|index| scene.polygon(index))
}

/// The polygons whose material has one of these names.
fn part<'a>(scene: &'a Scene, names: &'a [&str]) -> impl Iterator<Item = &'a [DVec3]> {
    (0..scene.len())
        .filter(|&i| names.contains(&scene.material(i).name.as_str()))
        .map(|i| scene.polygon(i))
}

#[test]
fn cornell_box_is_as_published() {
    let scene = scene::cornell_box();
    assert_eq!(scene.len(), 16);
    assert_eq!(scene.up(), DVec3::Y);
    let bounds = (DVec3::ZERO, DVec3::new(556.0, 548.8, 559.2));
    assert_eq!(scene.bounds(), Some(bounds));
    let eye = scene.suggested_view().map(|(eye, _)| eye);
    assert_eq!(eye, Some(DVec3::new(278.0, 273.0, -800.0)));
    // One side of each block from the published list, as a set of corners.
    let sides = [
        (10, [[290., 0., 114.], [290., 165., 114.], [130., 165., 65.], [130., 0., 65.]]),
        (12, [[423., 0., 247.], [423., 330., 247.], [265., 330., 296.], [265., 0., 296.]]),
    ];
    for (index, published) in sides {
        let published: HashSet<Bits> = published.into_iter().map(|p| bits(p.into())).collect();
        let built: HashSet<Bits> = scene.polygon(index).iter().map(|&p| bits(p)).collect();
        assert_eq!(built, published);
    }
}

#[test]
fn cornell_box_is_open_in_front_only() {
    let scene = scene::cornell_box();
    let shell = [0, 1, 3, 4, 5].into_iter().map(|i| scene.polygon(i));
    let open = open_edges(shell);
    assert_eq!(open.len(), 4);
    assert!(open.iter().all(|(a, b)| a.z == 0.0 && b.z == 0.0));
    // Blocks are open where they stand on the floor.
    for block in [6..11, 11..16] {
        let open = open_edges(block.map(|i| scene.polygon(i)));
        assert_eq!(open.len(), 4);
        assert!(open.iter().all(|(a, b)| a.y == 0.0 && b.y == 0.0));
    }
}

#[test]
fn cornell_box_walls_face_the_room_and_blocks_the_air() {
    let scene = scene::cornell_box();
    let room = DVec3::new(278.0, 274.4, 279.6);
    for index in 0..6 {
        let wall = scene.polygon(index);
        assert!(normal(wall).dot(room - centre(wall)) > 0.0, "wall {index}");
    }
    for block in [6..11, 11..16] {
        let inside = centre(scene.polygon(block.start)) * DVec3::new(1.0, 0.5, 1.0);
        for index in block {
            let side = scene.polygon(index);
            assert!(normal(side).dot(centre(side) - inside) > 0.0, "side {index}");
        }
    }
}

#[test]
fn newell_bars_cover_one_another_in_a_cycle() {
    let scene = scene::newell_bars();
    assert_eq!(scene.len(), 18);
    let bars: Vec<(DVec3, DVec3)> = (0..3)
        .map(|bar| {
            let corners = (6 * bar..6 * bar + 6).flat_map(|face| scene.polygon(face));
            corners.fold((DVec3::MAX, DVec3::MIN), |(low, high), &p| (low.min(p), high.max(p)))
        })
        .collect();
    let inside = |(low, high): (DVec3, DVec3), p: DVec3| p.cmpgt(low).all() && p.cmplt(high).all();
    // Points inside the bars along x, y, z. From each point, two steps of (1, 1, 1) towards the viewer lead
    // into the next bar.
    let starts =
        [DVec3::new(-3.0, 1.0, -1.0), DVec3::new(-1.0, -3.0, 1.0), DVec3::new(1.0, -1.0, -3.0)];
    for bar in 0..3 {
        let next = bars[(bar + 1) % 3];
        assert!(inside(bars[bar], starts[bar]), "bar {bar}");
        assert!(inside(next, starts[bar] + DVec3::splat(2.0)), "bar {bar}");
        let (low, high) = bars[bar];
        let apart = low.cmpgt(next.1) | high.cmplt(next.0);
        assert!(apart.any(), "bars must not touch");
    }
}

#[test]
fn teapot_has_the_published_size_and_counts() {
    for segments in [2, 3, 8, 13] {
        let scene = scene::teapot(segments);
        let n = segments as usize;
        assert_eq!(scene.len(), 32 * n * n);
        let triangles = scene.polygons().filter(|p| p.points().len() == 3).count();
        assert_eq!(triangles, 8 * n);
        for polygon in scene.polygons() {
            let distinct: HashSet<Bits> = polygon.points().iter().map(|&p| bits(p)).collect();
            assert_eq!(distinct.len(), polygon.points().len());
            assert!(normal(polygon.points()).length() > 0.0);
        }
    }
    let (low, high) = scene::teapot(32).bounds().unwrap_or_default();
    assert_eq!(low, DVec3::new(-3.0, -2.0, 0.0));
    assert_eq!((high.y, high.z), (2.0, 3.15));
    // The spout's lip bulges beyond its end, but less than its control points.
    assert!((3.43..3.45).contains(&high.x), "{}", high.x);
}

#[test]
fn teapot_patches_meet_without_cracks() {
    let scene = scene::teapot(6);
    let borders: [(&[&str], &[f64]); 4] = [
        (&["body"], &[2.4, 0.15]),
        (&["lid"], &[2.4]),
        (&["bottom"], &[0.15]),
        (&["body", "bottom"], &[2.4]),
    ];
    for (names, heights) in borders {
        let open = open_edges(part(&scene, names));
        assert_eq!(open.len(), 24 * heights.len(), "{names:?}");
        let at_border = |(a, b): &(DVec3, DVec3)| a.z == b.z && heights.contains(&a.z);
        assert!(open.iter().all(at_border), "{names:?}");
    }
    for name in ["handle", "spout"] {
        let open = open_edges(part(&scene, &[name]));
        // Two halves of 6 edges at each end of the tube.
        assert_eq!(open.len(), 24, "{name}");
    }
}

/// The signed volume, with the openings closed by fans: positive if the faces look outwards. `at_first_end`
/// distinguishes the boundaries of two openings.
fn volume<'a>(
    polygons: impl Iterator<Item = &'a [DVec3]> + Clone,
    at_first_end: fn(DVec3) -> bool,
) -> f64 {
    let pyramid = |a: DVec3, b: DVec3, c: DVec3| a.dot(b.cross(c)) / 6.0;
    let mut sum = 0.0;
    for p in polygons.clone() {
        sum += (2..p.len()).map(|i| pyramid(p[0], p[i - 1], p[i])).sum::<f64>();
    }
    let (first, second): (Vec<_>, Vec<_>) =
        open_edges(polygons).into_iter().partition(|&(a, _)| at_first_end(a));
    for rim in [first, second] {
        let middle = rim.iter().map(|(a, _)| *a).sum::<DVec3>() / rim.len().max(1) as f64;
        sum += rim.iter().map(|&(a, b)| pyramid(middle, b, a)).sum::<f64>();
    }
    sum
}

#[test]
fn teapot_faces_outwards() {
    let scene = scene::teapot(12);
    let part = |names: &[&str], at_first_end| {
        let polygons: Vec<&[DVec3]> = part(&scene, names).collect();
        volume(polygons.into_iter(), at_first_end)
    };
    let volumes = [
        part(&["body", "bottom"], |_| true),
        part(&["lid"], |_| true),
        part(&["handle"], |p| p.z > 1.5),
        part(&["spout"], |p| p.x > 2.0),
    ];
    // The vessel as a lathe would turn it: π times the integral of its squared
    // radius over its height is 24.3.
    assert!((24.2..24.4).contains(&volumes[0]), "{volumes:?}");
    assert!(volumes.iter().all(|&volume| volume > 0.2), "{volumes:?}");
}

#[test]
fn sphere_is_closed_and_convex() {
    for faces in [1, 8, 100, 2_000] {
        let scene = scene::sphere(faces);
        assert!(open_edges(outlines(&scene)).is_empty(), "{faces}");
        let corners: HashMap<Bits, DVec3> =
            scene.polygons().flatten().map(|&p| (bits(p), p)).collect();
        for polygon in scene.polygons() {
            let unit = normal(polygon.points()).normalize();
            let origin = centre(polygon.points());
            assert!(unit.dot(origin) > 0.0, "outwards");
            for corner in corners.values() {
                let height = unit.dot(*corner - origin);
                assert!(height < 1e-14, "{faces}: {height:e}");
            }
        }
    }
    assert_eq!(scene::sphere(100_000).len(), 2 * 224 * 224);
}

#[test]
fn city_houses_face_outwards_and_stand_apart() {
    let scene = scene::city(500, 7);
    assert_eq!(scene.len(), 5 * 100 + 1);
    let mut footprints: Vec<(DVec2, DVec2)> = Vec::new();
    for house in 0..100 {
        let faces: Vec<&[DVec3]> = (0..5).map(|i| scene.polygon(1 + 5 * house + i)).collect();
        let corners = || faces.iter().flat_map(|face| face.iter().copied());
        let low = corners().fold(DVec3::MAX, DVec3::min);
        let high = corners().fold(DVec3::MIN, DVec3::max);
        let inside = low.midpoint(high);
        let outwards = |face: &&[DVec3]| normal(face).dot(centre(face) - inside) > 0.0;
        assert!(faces.iter().all(outwards));
        assert_eq!(open_edges(faces.iter().copied()).len(), 4, "open below");
        let (low, high) = (low.truncate(), high.truncate());
        for &(other_low, other_high) in &footprints {
            assert!((low.cmpgt(other_high) | high.cmplt(other_low)).any());
        }
        footprints.push((low, high));
    }
}

#[test]
fn terrain_is_one_sheet_that_faces_up() {
    let scene = scene::terrain(5_000, 3);
    assert_eq!(scene.len(), 5_000);
    let faces_up = |triangle: &[DVec3]| triangle.len() == 3 && normal(triangle).z > 0.0;
    assert!(scene.polygons().all(|triangle| faces_up(triangle.points())));
    let open = open_edges(outlines(&scene));
    assert_eq!(open.len(), 4 * 50);
    let at_border = |p: &DVec3| [p.x, p.y].iter().any(|&c| c == 0.0 || c == 100.0);
    assert!(open.iter().all(|(a, b)| at_border(a) && at_border(b)));
    let (low, high) = scene.bounds().unwrap_or_default();
    assert!(high.z - low.z > 5.0 && low.z > -24.0 && high.z < 24.0);
}

#[test]
fn random_triangles_have_edges_as_stated() {
    let scene = scene::random_triangles(2_000, 5);
    let (low, high) = scene.bounds().unwrap_or_default();
    assert!(low.min_element() >= 0.0 && high.max_element() <= 1.0);
    for triangle in scene.polygons() {
        for i in 0..3 {
            let edge = triangle.points()[i].distance(triangle.points()[(i + 1) % 3]);
            assert!((0.0999..0.3001).contains(&edge), "{edge}");
        }
    }
}

#[test]
fn crossing_squares_share_the_z_axis() {
    for count in [1, 2, 3, 7, 64] {
        let scene = scene::crossing(count);
        assert_eq!(scene.len(), count as usize);
        for square in scene.polygons() {
            assert_eq!(square.points()[0] + square.points()[1], DVec3::NEG_Z * 2.0);
            assert_eq!(square.points()[2] + square.points()[3], DVec3::Z * 2.0);
        }
    }
    let two = scene::crossing(2);
    assert_eq!(normal(two.polygon(0)).dot(normal(two.polygon(1))), 0.0);
}

#[test]
fn chains_and_layers_are_parallel() {
    let chain = scene::chain(50);
    let layers = scene::layers(50, 1e-7);
    for index in 0..50 {
        let y = index as f64;
        assert!(chain.polygon(index).iter().all(|p| p.y == y));
        assert_eq!(normal(chain.polygon(index)).normalize(), DVec3::NEG_Y);
        let z = y * 1e-7;
        assert!(layers.polygon(index).iter().all(|p| p.z == z));
        assert!(normal(layers.polygon(index)).normalize().z > 0.999);
    }
}

#[test]
fn the_seed_alone_decides() {
    for &scene in Builtin::ALL {
        let size = scene.sizes().map(|_| 40);
        let first = scene.build(size, 1);
        assert_eq!(first, scene.build(size, 1), "{scene}");
        assert_eq!(first != scene.build(size, 2), scene.is_seeded(), "{scene}");
    }
}

/// The hash FNV-1a of the view, all coordinates and all colours. Scenes must not depend on machine or
/// compiler, and must not change by accident. A scene that is changed on purpose gets a new number.
#[test]
fn scenes_are_the_same_everywhere() {
    let hash = |scene: Scene| {
        let view = scene.suggested_view().into_iter().flat_map(|(eye, target)| [eye, target]);
        let points = view.chain(scene.polygons().flatten().copied());
        let materials = (0..scene.len()).map(|polygon| scene.material(polygon));
        let colours = materials.flat_map(|m| m.color.into_iter().chain([m.opacity]));
        let numbers = points.flat_map(|p| p.to_array()).chain(colours.map(f64::from));
        let bytes = numbers.flat_map(|number| number.to_bits().to_le_bytes());
        bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        })
    };
    let hashes = Builtin::ALL.iter().map(|scene| {
        let built = scene.build(scene.sizes().map(|_| 20), 1);
        format!("{scene} {:016x}", hash(built))
    });
    let expected = [
        "newell fb2fd90bf0f4f277",
        "cornell ca4fc0d18aa91d17",
        "teapot b39d5af14cd6df75",
        "crossing 43dc43bc4b746a10",
        "terrain 0cc01dcd034ba671",
        "sphere 6458b5dfdd16a187",
        "city 1419dbc422efc038",
        "random b179bd96c10d5b41",
        "chain 73c85f29a72fa496",
        "layers c3599f5ccdd248ff",
    ];
    assert_eq!(hashes.collect::<Vec<_>>(), expected);
}

#[test]
fn small_sizes_give_scenes_that_can_be_drawn() {
    for &scene in Builtin::ALL {
        for size in 1..=12 {
            let built = scene.build(Some(size), 9);
            assert!(!built.is_empty(), "{scene}:{size}");
            for polygon in built.polygons() {
                assert!(
                    polygon.points().len() >= 3 && polygon.points().iter().all(|p| p.is_finite())
                );
                assert!(normal(polygon.points()).length() > 0.0, "{scene}:{size}");
            }
            assert!((0..built.len()).all(|i| !built.material(i).name.is_empty()));
        }
        let default = scene.build(None, 0);
        assert!((2..=10_000).contains(&default.len()), "{scene}");
    }
}

#[test]
fn specs_are_read_and_written() {
    for &scene in Builtin::ALL {
        assert_eq!(scene.to_string().parse(), Ok(scene));
        assert_eq!(Builtin::parse(scene.name()), Ok((scene, None)));
        let Some(sizes) = scene.sizes() else {
            assert_eq!((scene.size_meaning(), scene.default_size()), (None, None));
            continue;
        };
        assert!(scene.default_size().is_some_and(|size| sizes.contains(&size)));
        for size in [*sizes.start(), *sizes.end()] {
            let text = format!("{scene}:{size}");
            assert_eq!(Builtin::parse(&text), Ok((scene, Some(size))));
        }
    }
}

#[test]
fn errors_of_bad_specs_list_the_valid_ones() {
    let error = |text: &str| match Builtin::parse(text) {
        Ok(read) => panic!("{text:?} was read as {read:?}"),
        Err(error) => error.to_string(),
    };
    for text in ["", "tepot", "Teapot", "tepot:3", ":3"] {
        assert!(error(text).contains("newell, cornell, teapot"), "{text}");
    }
    let sizes = ["", "0", "1", "791", "-1", "1.5", "x", "8:8", " 8", "99999999999999999999"];
    for size in sizes {
        let error = error(&format!("teapot:{size}"));
        assert!(error.contains("from 2 to 790, such as teapot:8"), "{error}");
    }
    assert!(error("chain:20000001").contains("from 1 to 20000000"));
    assert!(error("cornell:3").contains("one size"));
}

#[test]
fn a_scene_stores_its_input_unchanged() {
    let mut scene = Scene::new("odd", DVec3::Z);
    assert!(scene.is_empty());
    assert_eq!(scene.bounds(), None);
    scene.push([], 0);
    scene.push([DVec3::X, DVec3::NAN], 99);
    assert_eq!(scene.polygon(0), []);
    assert_eq!(scene.polygon(1).len(), 2);
    assert_eq!(scene.material(1), &scene::Material::DEFAULT);
    assert_eq!(scene.polygons().len(), 2);
}

#[test]
fn polygons_are_counted_before_they_are_generated() {
    for &scene in Builtin::ALL {
        let (said, made) = (scene.polygons(None), scene.build(None, 1).len());
        assert!(said.abs_diff(made) * 10 <= made, "{scene}: {said} {made}");
    }
    // Sizes beyond the limits are clamped, as `build` does.
    for size in [790, 791, u32::MAX] {
        assert_eq!(Builtin::Teapot.polygons(Some(size)), 19_971_200);
        assert_eq!(Builtin::Newell.polygons(Some(size)), scene::newell_bars().len());
    }
    assert_eq!(Builtin::Chain.polygons(Some(u32::MAX)), 20_000_000);
    assert_eq!(Builtin::Chain.polygons(Some(0)), 1);
}
