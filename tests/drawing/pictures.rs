//! Vector pictures, as a viewer shows them (resvg): seams, the order of paths, places, names, and odd
//! numbers.

use super::map_of;
use super::sides::distance;
use binspace::drawing::{Paint, Path, Polyline, Stroke, VectorPicture, polylines};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::roxmltree::{Document, Node};
use resvg::usvg::{Options, ShapeRendering, Tree};
use std::collections::{BTreeMap, BTreeSet};
use testkit::prelude::*;

/// The pixels of an SVG on a white background: each with its edges blended, or one sample at its centre.
fn pixels(picture: &VectorPicture, shape_rendering: ShapeRendering) -> Vec<[u8; 3]> {
    let options = Options { shape_rendering, ..Options::default() };
    let tree = Tree::from_str(&picture.to_svg(), &options).unwrap();
    let size = tree.size().to_int_size();
    let mut pixels = Pixmap::new(size.width(), size.height()).unwrap();
    pixels.fill(resvg::tiny_skia::Color::WHITE);
    resvg::render(&tree, Transform::identity(), &mut pixels.as_mut());
    pixels.data().chunks_exact(4).map(|rgba| [rgba[0], rgba[1], rgba[2]]).collect()
}

fn smooth(picture: &VectorPicture) -> Vec<[u8; 3]> {
    pixels(picture, ShapeRendering::GeometricPrecision)
}

fn crisp(picture: &VectorPicture) -> Vec<[u8; 3]> {
    pixels(picture, ShapeRendering::CrispEdges)
}

/// Rows of quads, triangles and darts, where the corners of one row lie between the corners of the next.
fn wall() -> Vec<Corners> {
    let mut faces = Vec::new();
    for row in 0..8 {
        let (y, shift) = (f64::from(row), f64::from(row % 3) * 0.25);
        for column in 0..8 {
            let x = f64::from(column) + shift;
            let [a, b, c, d] = [[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]];
            let middle = [x + 0.375, y + 0.25];
            match (row + column) % 3 {
                0 => faces.push(vec![a, b, c, d]),
                1 => faces.extend([vec![a, b, c], vec![a, c, d]]),
                _ => faces.extend([vec![a, b, c, middle], vec![c, d, a, middle]]),
            }
        }
    }
    let corners = |face: Vec<[f64; 2]>| face.iter().map(|&[x, y]| dvec3(x, y, 0.0)).collect();
    faces.into_iter().map(corners).collect()
}

/// If all polygons have one colour, a picture without seams has only this colour. Paths filled one after
/// another show other colours at seams.
#[test]
fn no_background_shows_in_seams() {
    const COLOUR: [u8; 3] = [51, 102, 77];
    let tree = BspTree::build(wall()).unwrap();
    let centre = dvec3(4.0, 4.0, 0.0);
    let (along, up) = (dvec3(0.31, 0.22, -1.0), dvec3(0.3, 1.0, 0.0));
    let camera = Camera::parallel(along, up, centre, 9.0, [200, 160]).unwrap();
    let drawing = map_of(&tree, &camera).drawing().unwrap();
    let (mut with, mut without) =
        (VectorPicture::new(drawing.size()), VectorPicture::new(drawing.size()));
    with.add_drawing(&drawing, |_| COLOUR);
    for path in drawing.paths() {
        without.add_area(path.outlines(), COLOUR);
    }
    let covered = crisp(&without);
    let inner: Vec<usize> = (0..covered.len())
        .filter(|at| {
            let (x, y) = (at % 200, at / 200);
            let around = |k: usize| covered[(y + k / 5 - 2) * 200 + x + k % 5 - 2];
            (2..198).contains(&x) && (2..158).contains(&y) && (0..25).all(|k| around(k) == COLOUR)
        })
        .collect();
    let error = |picture: &VectorPicture| {
        let found = smooth(picture);
        let off = |at: usize| (0..3).map(|i| found[at][i].abs_diff(COLOUR[i])).max().unwrap();
        inner.iter().map(|&at| u32::from(off(at))).sum::<u32>()
    };
    let errors = [error(&with), error(&without)];
    assert!(inner.len() > 10_000, "{}", inner.len());
    assert!(5 * errors[0] < inner.len() as u32, "{errors:?} in {} pixels", inner.len());
    assert!(10 * errors[0] < errors[1], "{errors:?}");
    // Nothing is drawn outside the wall.
    let changed = covered.iter().zip(crisp(&with)).filter(|(a, b)| *a != b).count();
    assert!(changed < 4, "{changed} pixels");
}

/// Drawings of triangles that cross each other, and of a city.
fn drawings() -> Vec<Drawing> {
    let scenes = [(Builtin::Random, 200), (Builtin::City, 200), (Builtin::Crossing, 6)];
    let drawing = |(scene, count): (Builtin, u32)| {
        let scene = scene.build(Some(count), 1);
        let tree = BspTree::build(scene.polygons()).unwrap();
        let (low, high) = scene.bounds().unwrap();
        let (centre, reach) = ((low + high) * 0.5, (high - low).length());
        let eye = centre + dvec3(1.1, -1.3, 0.9) * reach;
        let camera = Camera::perspective(eye, centre, DVec3::Z, 0.6, [320, 240]).unwrap();
        map_of(&tree, &camera).drawing().unwrap()
    };
    scenes.into_iter().map(drawing).collect()
}

#[test]
fn batches_paint_the_same_picture() {
    let key = |polygon: usize| polygon * 7 % 5;
    let paint = |polygon: usize| [40 * key(polygon) as u8 + 20, 90, 200 - 30 * key(polygon) as u8];
    let mut counts = [0; 2];
    for drawing in drawings() {
        let batched = drawing.batched(key);
        let keys = |drawing: &Drawing| -> Vec<usize> {
            drawing.paths().map(|path| key(path.polygon())).collect()
        };
        let runs = |keys: &[usize]| keys.chunk_by(|a, b| a == b).count();
        let [before, after] = [&drawing, &batched].map(keys);
        [&before, &after].into_iter().zip(&mut counts).for_each(|(keys, n)| *n += runs(keys));
        let polygons = |drawing: &Drawing| -> BTreeSet<usize> {
            drawing.paths().map(|path| path.polygon()).collect()
        };
        assert_eq!(polygons(&drawing), polygons(&batched));
        let of = |drawing: &Drawing| {
            let mut picture = VectorPicture::new(drawing.size());
            for path in drawing.paths() {
                picture.add_area(path.outlines(), paint(path.polygon()));
            }
            crisp(&picture)
        };
        let [before, after] = [of(&drawing), of(&batched)];
        // Neighbours may both cover a pixel whose middle is within the painter's rounding of their edge.
        let changed = (0..before.len()).filter(|&pixel| before[pixel] != after[pixel]);
        for pixel in changed {
            let [x, y] = [pixel % drawing.size()[0] as usize, pixel / drawing.size()[0] as usize];
            let middle = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            let outlines = drawing.paths().flat_map(|path| path.outlines());
            let sides = outlines.flat_map(|outline| {
                let next = outline.iter().cycle().skip(1);
                outline.iter().zip(next).map(|(&a, &b)| [a, b].map(DVec2::from_array))
            });
            let nearest = sides.map(|side| distance(middle, side)).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1.0 / 64.0, "pixel {x}, {y} is {nearest} from the nearest side");
        }
    }
    assert!(2 * counts[1] < counts[0], "{counts:?}");
}

/// Trapping only adds corners to outlines. The outlines of polygons that are not opaque do not change.
#[test]
fn trapped_outlines_go_through_the_same_corners() {
    let mut extended = 0;
    for drawing in drawings() {
        let trapped = drawing.trapped(|polygon| polygon % 4 > 0);
        assert_eq!(drawing.paths().len(), trapped.paths().len());
        for (path, longer) in drawing.paths().zip(trapped.paths()) {
            assert_eq!(path.polygon(), longer.polygon());
            assert_eq!(path.is_clipped(), longer.is_clipped());
            assert_eq!(path.outlines().count(), longer.outlines().count());
            for (outline, longer) in path.outlines().zip(longer.outlines()) {
                let mut corners = longer.iter();
                assert!(outline.iter().all(|corner| corners.any(|other| other == corner)));
                extended += usize::from(longer.len() > outline.len());
                assert!(path.polygon() % 4 > 0 || longer.len() == outline.len());
            }
            // An unchanged side has its edge, and an extended side has no edge.
            let sides = |path: Path<'_>| -> BTreeMap<[[u64; 2]; 2], Option<u32>> {
                let all = path.outlines().zip(path.edges()).flat_map(|(outline, edges)| {
                    assert_eq!(outline.len(), edges.len());
                    let next = outline.iter().cycle().skip(1);
                    outline.iter().zip(next).zip(edges)
                });
                all.map(|((a, b), edge)| ([a, b].map(|end| end.map(f64::to_bits)), *edge)).collect()
            };
            let before = sides(path);
            for (side, edge) in sides(longer) {
                assert_eq!(edge, before.get(&side).copied().flatten());
            }
        }
    }
    assert!(extended > 100, "{extended}");
}

#[test]
fn markers_lines_and_labels_are_at_their_places() {
    const RED: [u8; 3] = [255, 0, 0];
    let mut picture = VectorPicture::new([100, 80]).with_background([255; 3]);
    picture.add_marker([30.0, 40.0], 10.0, RED);
    picture.add_lines([[[60.0, 20.5], [90.0, 20.5]]], Stroke::new(3.0, RED));
    picture.add_lines([[[60.0, 60.0], [90.0, 60.0]]], Stroke::new(4.0, RED).with_dashes(10.0, 5.0));
    picture.add_label([50.0, 10.0], "a & b", 20.0, RED);
    for (at, found) in crisp(&picture).into_iter().enumerate() {
        let [x, y] = [at % 100, at / 100].map(|c| c as f64 + 0.5);
        let disc = (x - 30.0).hypot(y - 40.0) - 10.0;
        let line = (x - x.clamp(60.0, 90.0)).hypot(y - 20.5) - 1.5;
        let dash = |from: f64| ((x - from - 5.0).abs() - 5.0).max((y - 60.0).abs() - 2.0);
        let inside = disc.min(line).min(dash(60.0)).min(dash(75.0));
        // Viewers approximate curves by few pieces.
        if inside.abs() > 0.25 {
            assert_eq!(found, if inside < 0.0 { RED } else { [255; 3] }, "{x} {y}");
        }
    }
    // Without fonts, the viewer leaves out the label.
    let text = picture.to_svg();
    let document = Document::parse(&text).unwrap();
    let label = document.descendants().find(|node| node.has_tag_name("text")).unwrap();
    assert_eq!(label.text(), Some("a & b"));
    assert_eq!(label.attribute("text-anchor"), Some("middle"));
    // In units of 1/500 of a pixel: the baseline is half the height of a capital letter below the point.
    let place =
        ["x", "y"].map(|axis| label.attribute(axis).unwrap().parse::<f64>().unwrap() / 500.0);
    assert!(place[0] == 50.0 && (place[1] - 10.0 - 0.359 * 20.0).abs() < 2e-3, "{place:?}");
}

/// A stroke follows the polygon, not the corners that trapping added.
#[test]
fn strokes_follow_the_outlines_of_polygons() {
    let tree = BspTree::build(wall()).unwrap();
    let centre = dvec3(4.0, 4.0, 0.0);
    let camera = Camera::parallel(-DVec3::Z, DVec3::Y, centre, 9.0, [200, 160]).unwrap();
    let drawing = map_of(&tree, &camera).drawing().unwrap();
    let mut picture = VectorPicture::new(drawing.size());
    let stroke = Stroke::new(1.0, [0; 3]).with_opacity(0.5);
    picture.add_drawing(&drawing, |_| Paint::from([200; 3]).with_stroke(stroke));
    let text = picture.to_svg();
    let document = Document::parse(&text).unwrap();
    let paths: Vec<Node<'_, '_>> =
        document.descendants().filter(|node| node.has_tag_name("path")).collect();
    assert_eq!(paths.len(), 2 * drawing.paths().len());
    let corners = |node: &Node<'_, '_>| {
        let data = node.attribute("d").unwrap().replace(['m', 'z'], " ").replace('-', " -");
        data.split_whitespace().count() / 2
    };
    for (pair, path) in paths.chunks(2).zip(drawing.paths()) {
        assert_eq!(pair[0].attribute("stroke"), Some("none"));
        assert_eq!(pair[1].attribute("fill"), Some("none"));
        assert_eq!(corners(&pair[1]), path.outlines().flatten().count());
        assert!(corners(&pair[0]) >= corners(&pair[1]));
    }
    let extended = paths.chunks(2).filter(|pair| corners(&pair[0]) > corners(&pair[1])).count();
    assert!(extended > 50, "{extended}");
}

/// The border of the picture is no edge of a polygon that reaches beyond it.
#[test]
fn strokes_leave_out_the_border_of_the_picture() {
    let corners = [[-9.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-9.0, 1.0]];
    let tree = BspTree::build([corners.map(|[x, y]| dvec3(x, y, 0.0))]).unwrap();
    let camera = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 4.0, [40, 40]).unwrap();
    let drawing = map_of(&tree, &camera).drawing().unwrap();
    let mut picture = VectorPicture::new(drawing.size());
    picture.add_drawing(&drawing, |_| Paint::from([200; 3]).with_stroke(Stroke::new(2.0, [0; 3])));
    let pixels = crisp(&picture);
    let at = |x: usize, y: usize| pixels[40 * y + x];
    // The pixels from the left: the border, the inside, the right edge, the background. Then the edges above
    // and below.
    assert_eq!([0, 15, 29, 35].map(|x| at(x, 20)), [[200; 3], [200; 3], [0; 3], [255; 3]]);
    assert_eq!([10, 29].map(|y| at(0, y)), [[0; 3]; 2]);
}

/// Areas side by side that are added up have the sum of their coverages over the background.
#[test]
fn areas_that_are_added_up_have_no_seams() {
    let mut picture = VectorPicture::new([40, 30]).with_background([255; 3]);
    let glass = Paint::from([0, 0, 200]).with_opacity(0.5);
    picture.added_up(|picture| {
        for [a, b] in [[5.0, 17.3], [17.3, 33.0]] {
            picture.add_area([[[a, 4.0], [b, 4.0], [b + 1.7, 26.0], [a + 1.7, 26.0]]], glass);
        }
    });
    let found = smooth(&picture);
    for y in 6..24 {
        for x in 8..31 {
            let [r, g, b] = found[y * 40 + x];
            let off = r.abs_diff(128).max(g.abs_diff(128)).max(b.abs_diff(228));
            assert!(off <= 2, "{r} {g} {b} at {x} {y}");
        }
    }
}

#[test]
fn groups_name_their_shapes() {
    let mut picture = VectorPicture::new([100, 100]);
    let square = [[[1.0, 1.0], [9.0, 1.0], [9.0, 9.0], [1.0, 9.0]]];
    picture.group(&[("class", "a<\"&")], |picture| {
        picture.group(
            &[("data-n", "1"), ("data-n", "2"), ("fill", "x"), ("data-A", "y")],
            |inner| {
                inner.add_area(square, [1, 2, 3]);
            },
        );
        picture.group(&[("id", "x"), ("on\"", "z"), ("data-", "")], |inner| {
            inner.add_area(square, [1, 2, 3]);
            inner.add_marker([5.0, 5.0], 2.0, [9; 3]);
        });
        picture.group(&[("class", "empty")], |_| {});
    });
    let text = picture.to_svg();
    let document = Document::parse(&text).unwrap();
    let attributes = |node: Node<'_, '_>| -> Vec<(String, String)> {
        let own = node.attributes().filter(|a| !matches!(a.name(), "d" | "cx" | "cy" | "r"));
        own.map(|a| (a.name().to_owned(), a.value().to_owned())).collect()
    };
    let named = |list: &[(&str, &str)]| -> Vec<(String, String)> {
        list.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect()
    };
    let shapes = document.root_element().first_element_child().unwrap();
    let outer = shapes.first_element_child().unwrap();
    assert_eq!(attributes(outer), named(&[("class", "a<\"&")]));
    let inner: Vec<Node<'_, '_>> = outer.children().filter(Node::is_element).collect();
    // A group of one shape is the shape, and an empty one is nothing.
    assert_eq!(inner.len(), 2, "{text}");
    assert!(inner[0].has_tag_name("path") && inner[1].has_tag_name("g"), "{text}");
    assert_eq!(attributes(inner[0]), named(&[("data-n", "1"), ("fill", "#010203")]));
    assert_eq!(attributes(inner[1]), named(&[("id", "x")]));
    assert_eq!(inner[1].children().filter(Node::is_element).count(), 2);
}

/// The style of each shape is written once, on the shape or on a group around it.
#[test]
fn every_shape_has_its_look() {
    let mut dice = Dice(5);
    for _ in 0..300 {
        let mut picture = VectorPicture::new([50, 50]);
        let mut expected = Vec::new();
        fill_at_random(&mut picture, &mut dice, 4, &mut expected);
        let text = picture.to_svg();
        let document = Document::parse(&text).unwrap();
        let all = document.descendants().filter(|node| node.has_tag_name("circle"));
        let found = all.map(|node| {
            let fills: Vec<&str> = node.ancestors().filter_map(|a| a.attribute("fill")).collect();
            let [fill] = fills[..] else { panic!("{fills:?} in {text}") };
            let groups = node.ancestors().filter(|a| a.attribute("data-depth").is_some()).count();
            (fill.to_owned(), groups)
        });
        assert_eq!(found.collect::<Vec<_>>(), expected, "{text}");
    }
}

fn fill_at_random(
    picture: &mut VectorPicture,
    dice: &mut Dice,
    depth: usize,
    expected: &mut Vec<(String, usize)>,
) {
    for _ in 0..dice.below(5) {
        if depth > 0 && dice.below(2) == 0 {
            let inner = |picture: &mut VectorPicture| {
                fill_at_random(picture, dice, depth - 1, expected);
            };
            picture.group(&[("data-depth", &depth.to_string())], inner);
        } else {
            let colour = [[1, 1, 1], [2, 2, 2]][dice.below(2)];
            picture.add_marker([5.0, 5.0], 1.0, colour);
            let [r, g, b] = colour;
            expected.push((format!("#{r:02x}{g:02x}{b:02x}"), 4 - depth));
        }
    }
}

/// For any input numbers, a file is well-formed, and its numbers are finite.
#[test]
fn odd_numbers_make_no_broken_files() {
    const ODD: [f64; 12] = [
        0.0,
        -0.0,
        1.0,
        -3.5,
        1e-300,
        1e5,
        1e6,
        1.1e6,
        1e300,
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
    ];
    let mut dice = Dice(11);
    let mut shapes = 0;
    for round in 0..2_000 {
        let mut odd =
            || if dice.below(3) == 0 { ODD[dice.below(ODD.len())] } else { 20.0 * dice.share() };
        let sizes = [[40, 30], [1, 1], [0, 0], [u32::MAX, 5]];
        let mut picture = VectorPicture::new(sizes[round % 4]);
        let mut stroke =
            Stroke::new(odd(), [1, 2, 3]).with_opacity(odd()).with_dashes(odd(), odd());
        stroke.round_ends = round % 3 == 0;
        let paint = Paint::from([7; 3]).with_opacity(odd()).with_stroke(stroke);
        let point = [odd(), odd()];
        picture.add_area([[point, [odd(), odd()], [3.0, 1.0]], [point; 3]], paint);
        picture.add_area(Vec::<Vec<[f64; 2]>>::new(), paint);
        picture.add_area([vec![]], paint);
        picture.add_lines([vec![], vec![point], vec![point, [odd(), odd()]]], stroke);
        picture.add_marker(point, odd(), paint);
        picture.add_label(point, "\u{0}<b>\u{ffff}", odd(), paint);
        let text = picture.to_svg();
        let document = Document::parse(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
        for node in document.root_element().descendants().filter(Node::is_element) {
            for attribute in node.attributes() {
                let value = attribute.value();
                assert!(!value.contains("NaN") && !value.contains("inf"), "{text}");
                if attribute.name() == "d" {
                    let is_known = |c: char| c.is_ascii_digit() || "mz .-".contains(c);
                    assert!(value.chars().all(is_known), "{value}");
                    assert!(
                        value.split('m').skip(1).all(|line| !matches!(line, "" | "z")),
                        "{value}"
                    );
                    shapes += 1;
                }
                let is_number = ["cx", "cy", "r", "x", "y", "stroke-width", "font-size"];
                if is_number.contains(&attribute.name()) {
                    assert!(value.parse::<f64>().unwrap().is_finite(), "{text}");
                }
                if attribute.name().ends_with("opacity") {
                    assert!((0.0..1.0).contains(&value.parse::<f64>().unwrap()), "{text}");
                }
            }
        }
    }
    assert!(shapes > 1_000, "{shapes}");
}

/// Lines may be polylines or pairs of points.
#[test]
fn polylines_are_lines() {
    let ends = [[[0.0, 0.0], [5.0, 0.0]], [[5.0, 0.0], [5.0, 5.0]]];
    let joined: Vec<Polyline> = polylines(ends).unwrap();
    let stroke = Stroke::new(1.0, [0; 3]);
    let [mut first, mut second] = [VectorPicture::new([9, 9]), VectorPicture::new([9, 9])];
    first.add_lines(&joined, stroke);
    second.add_lines([[[0.0, 0.0], [5.0, 0.0], [5.0, 5.0]]], stroke);
    assert_eq!(first.to_svg(), second.to_svg());
}
