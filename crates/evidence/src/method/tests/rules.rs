//! Conventions of depth buffers, sections, and translucent polygons over opaque ones.

use super::{cameras, faces, polygons_of, show};
use crate::method::{Clear, DepthBuffer, DepthFormat, DepthRules, DepthTest, Interpolation};
use crate::method::{Layered, Method, Nearer};
use crate::panes::{panes, world_polygons};
use crate::plain::PlainView;
use binspace::raster::NONE;
use testkit::prelude::*;

use DepthFormat::{Float, FloatReversed, Integer, LinearFloat, LinearInteger};

const FORMATS: [DepthFormat; 7] =
    [Integer(16), Integer(24), Integer(32), Float, FloatReversed, LinearInteger(16), LinearFloat];
const LARGER: DepthRules = DepthRules {
    nearer: Nearer::Larger,
    test: DepthTest::Greater,
    clear: Clear::Smallest,
    writes: true,
};

/// The visible wall among walls at these depths, drawn in this order.
fn walls(depths: &[f64], format: DepthFormat, rules: DepthRules) -> u32 {
    let wall = |&depth: &f64| {
        let corners = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)];
        corners.map(|(x, y)| DVec3::new(x * depth, y * depth, -depth)).to_vec()
    };
    let faces = faces(&depths.iter().map(wall).collect(), Some(0.0));
    let eye = DVec3::ZERO;
    let camera = Camera::perspective(eye, DVec3::NEG_Z, DVec3::Y, 1.0, [4, 4]).unwrap();
    let method = DepthBuffer::new(format).with_range(1.0, 8.0).with_rules(rules);
    let shown = show(&method, &faces, &camera).image.faces().to_vec();
    assert!(shown.iter().all(|&face| face == shown[0]));
    shown[0]
}

#[test]
fn a_picture_does_not_depend_on_which_end_is_near() {
    let polygons = polygons_of(&scene::random_triangles(60, 3));
    let faces = faces(&polygons, Some(0.0));
    let smaller = DepthRules::DEFAULT.with_clear(Clear::Largest);
    for camera in cameras(&polygons, [60, 45], 4) {
        for format in FORMATS {
            let picture =
                |rules| show(&DepthBuffer::new(format).with_rules(rules), &faces, &camera).image;
            let first = picture(smaller);
            assert!(first.covered() > 0);
            assert_eq!(first, picture(LARGER), "{format}");
            let or_equal = [DepthTest::LessOrEqual, DepthTest::GreaterOrEqual];
            let ends = [smaller, LARGER].into_iter().zip(or_equal);
            let [a, b]: [_; 2] = ends
                .map(|(rules, test)| picture(rules.with_test(test)))
                .collect::<Vec<_>>()
                .try_into()
                .unwrap();
            assert_eq!(a, b, "{format}");
        }
    }
}

#[test]
fn each_rule_decides_what_it_says() {
    for format in FORMATS {
        let smaller = DepthRules::DEFAULT.with_clear(Clear::Largest);
        let or_equal = smaller.with_test(DepthTest::LessOrEqual);
        for order in [[2.0, 4.0], [4.0, 2.0]] {
            let nearest = u32::from(order[1] < order[0]);
            assert_eq!(walls(&order, format, smaller), nearest, "{format}");
            assert_eq!(walls(&order, format, LARGER), nearest);
            // With the reversed test, and the buffer cleared to the near end, the furthest wall shows.
            let wrong = smaller.with_test(DepthTest::Greater).with_clear(Clear::Smallest);
            assert_eq!(walls(&order, format, wrong), 1 - nearest);
            let wrong = LARGER.with_test(DepthTest::Less).with_clear(Clear::Largest);
            assert_eq!(walls(&order, format, wrong), 1 - nearest);
            // Cleared to the near end: nothing shows.
            assert_eq!(walls(&order, format, smaller.with_clear(Clear::Smallest)), NONE);
            assert_eq!(walls(&order, format, LARGER.with_clear(Clear::Largest)), NONE);
            // If no depth is written, the last wall shows.
            assert_eq!(walls(&order, format, DepthRules { writes: false, ..smaller }), 1);
        }
        // Of two faces at the same depth, `LESS` shows the first and `LEQUAL` the last.
        assert_eq!(walls(&[3.0, 3.0], format, smaller), 0);
        assert_eq!(walls(&[3.0, 3.0], format, or_equal), 1);
        // A face at the far plane is not nearer than the clear value.
        assert_eq!(walls(&[8.0], format, smaller), NONE, "{format}");
        assert_eq!(walls(&[8.0], format, or_equal), 0, "{format}");
        assert_eq!(walls(&[8.0], format, DepthRules::DEFAULT), 0);
    }
}

#[test]
fn sections_make_the_same_picture_for_any_number_of_rows_and_threads() {
    let polygons = polygons_of(&scene::random_triangles(40, 8));
    let faces = faces(&polygons, Some(0.0));
    for camera in cameras(&polygons, [64, 50], 2) {
        let rays = Rays::new(&camera, &faces).unwrap();
        // If a stored number could equal the clear value, the faces that another section left there would
        // show.
        let rules = [Clear::Nothing, Clear::Largest].map(|c| DepthRules::DEFAULT.with_clear(c));
        for (format, rules) in FORMATS.into_iter().flat_map(|f| rules.map(|rules| (f, rules))) {
            for how in Interpolation::ALL {
                let whole = DepthBuffer::new(format).with_interpolation(how).with_rules(rules);
                let expected = show(&whole, &faces, &camera);
                for (rows, threads) in [(1, 3), (7, 1), (16, 2), (50, 1), (64, 4), (0, 0)] {
                    let method = whole.with_sections(rows, threads);
                    let mut ready = method.prepare(&faces).unwrap();
                    let painted = ready.paint(&camera, &rays).unwrap();
                    assert_eq!(painted.image, expected.image, "{format} {how:?} {rows} {threads}");
                    let bytes = threads.max(1) * rows.clamp(1, 50) as usize * 64 * 8;
                    assert_eq!(ready.bytes(), bytes);
                }
            }
        }
    }
}

#[test]
fn translucent_fragments_over_opaque_polygons_are_the_exact_layers() {
    let view = PlainView::new([80, 60]);
    let camera = view.camera();
    let (mut several, mut lost, mut wrong) = (0, 0, [0; 4]);
    for seed in 0..4 {
        let (integers, opaque) = panes(36, seed);
        let polygons = world_polygons(&integers);
        let tree = BuildOptions::DEFAULT.with_tolerance(0.0).build(&polygons).unwrap();
        let rays = Rays::new(&camera, tree.faces()).unwrap();
        let buffer = DepthBuffer::new(Integer(32));
        let (mut sorted, tree) = (Vec::new(), &tree);
        tree.back_to_front_into(camera.viewpoint(), &mut sorted);
        let unsorted: Vec<u32> = (0..tree.len() as u32).collect();
        let cases = [(&sorted, false), (&sorted, true), (&unsorted, false), (&unsorted, true)];
        let shown = cases.map(|(order, writes)| {
            let layered =
                Layered { buffer, tree, camera: &camera, rays: &rays, opaque: &opaque, writes };
            layered.draw(order).unwrap()
        });
        for i in 0..80 * 60 {
            let pixel = [i as u32 % 80, i as u32 / 80];
            let Some(truth) = view.shown(&integers, &opaque, pixel) else { continue };
            several += usize::from(truth.len() > 2);
            for (shown, wrong) in shown.iter().zip(&mut wrong) {
                *wrong += usize::from(shown[i] != truth);
            }
            lost += truth.len() - shown[3][i].len();
            assert_eq!(truth.len(), shown[2][i].len());
        }
    }
    assert!(several > 2000, "{several}");
    // If drawn from back to front, each polygon is nearer than all before it, so written depths have no
    // effect until the order is wrong.
    assert_eq!(wrong[..2], [0, 0]);
    assert!(wrong[2] > 500 && wrong[3] > 500 && lost > 500, "{wrong:?} {lost}");
}
