//! The visible part of one layer, and its places.

use super::oracle::{Point2, area, number};
use super::{Given, VIEWPORT, layers_of, page_of, wild};
use binspace::layers::LayerVertex;
use testkit::pages::Page;
use testkit::prelude::*;
use testkit::rational::exact;

/// The allowed error: twenty steps of `f64`, times the sum of the terms of a coordinate.
const STEPS: f64 = 20.0 * f64::EPSILON;
/// The box that layers are clipped to.
const REACH: f64 = 1920.0 * (1u64 << 20) as f64;

/// The error bound of x/w, y/w and z/w at the layer's point (u, v): the sum of the terms, divided by w, times
/// `STEPS`.
fn bound(given: &Given, vertex: &LayerVertex) -> f64 {
    let terms = |k: usize| {
        let [u, v, one] = [0, 1, 3].map(|column: usize| given.matrix.col(column)[k].abs());
        u * vertex.local.x.abs() + v * vertex.local.y.abs() + one
    };
    let largest = vertex.position.abs().max_element().max(1.0);
    STEPS * (terms(0).max(terms(1)).max(terms(2)) + largest * terms(3)) / vertex.w
}

#[test]
fn visible_parts_agree_with_the_exact_clip() {
    let mut dice = Dice(11);
    let (mut seen, mut unseen, mut clipped) = (0, 0, 0);
    for _ in 0..times(600) {
        let given = wild(&mut dice);
        let truth = given.truth();
        let expected = truth.clipped([0.0, 0.0, -REACH], [VIEWPORT[1][0], VIEWPORT[1][1], REACH]);
        let expected = number(&area(&expected)).abs();
        let page = page_of(&[given]);
        if page.is_empty() {
            assert!(expected < 1e-6, "{expected}");
            unseen += 1;
            continue;
        }
        assert_eq!((page.len(), page.visible()), (1, 1));
        let piece = page.back_to_front().next().unwrap();
        assert!(piece.is_whole() && piece.layer() == 0);
        let vertices: Vec<LayerVertex> = piece.vertices().collect();
        for vertex in &vertices {
            let local = vertex.local.to_array().map(exact);
            assert!(truth.inside(&local) >= 0.0);
            // The vertex appears at its stated position.
            let [x, y, z, w] = truth.homogeneous(&local);
            assert!((number(&w) - vertex.w).abs() <= bound(&given, vertex) * vertex.w);
            let off = DVec3::new(number(&(x / &w)), number(&(y / &w)), number(&(z / &w)))
                - vertex.position;
            assert!(off.abs().max_element() <= bound(&given, vertex), "{off} {vertex:?}");
            // The vertex is inside the box.
            let [low, high] = VIEWPORT.map(binspace::glam::DVec2::from);
            let on_screen = vertex.position.truncate();
            assert_eq!(on_screen.clamp(low, high), on_screen);
        }
        // The piece is in the rectangle and in the box, is convex, and has the right area. So it is the
        // visible part.
        let outline: Vec<Point2> = vertices.iter().map(|v| v.local.to_array().map(exact)).collect();
        let found = number(&area(&outline)).abs();
        assert!((found - expected).abs() <= 1e-9 * expected + 1e-9, "{found} {expected}");
        clipped += usize::from(vertices.len() > 4);
        seen += 1;
    }
    enough!(seen > 300, unseen > 50, clipped > 60; "{seen} {unseen} {clipped}");
}

#[test]
fn edges_of_the_rectangle_are_told_from_clips() {
    let mut dice = Dice(12);
    let (mut own, mut clips) = (0, 0);
    for _ in 0..times(400) {
        let given = wild(&mut dice);
        let [[u0, v0], [u1, v1]] = given.rect;
        let page = page_of(&[given]);
        for piece in page.back_to_front() {
            let locals: Vec<_> = piece.vertices().map(|vertex| vertex.local).collect();
            assert_eq!(piece.edges().len(), locals.len());
            for (k, edge) in piece.edges().enumerate() {
                let [a, b] = [k, (k + 1) % locals.len()].map(|k| locals[k]);
                // Points on an edge have the coordinate of the edge, bit for bit.
                let lies_on = [
                    a.y == v0 && b.y == v0,
                    a.x == u1 && b.x == u1,
                    a.y == v1 && b.y == v1,
                    a.x == u0 && b.x == u0,
                ];
                assert_eq!(lies_on.iter().position(|&on| on).map(|k| k as u8), edge);
                own += usize::from(edge.is_some());
                clips += usize::from(edge.is_none());
            }
        }
    }
    enough!(own > 500, clips > 200; "{own} {clips}");
}

/// At random points of random pieces, the interpolation of a GPU agrees with the exact inverse of the matrix.
/// Interpolating only u and v does not agree.
#[test]
fn places_in_a_layer_are_right_after_the_division() {
    let mut dice = Dice(13);
    let (mut compared, mut cut, mut misled) = (0, 0, 0);
    let mut scenes: Vec<Vec<Given>> =
        (0..25).map(|_| (0..12).map(|_| wild(&mut dice)).collect()).collect();
    for page in Page::ALL {
        scenes.push(layers_of(page, 30, 5));
    }
    for scene in scenes {
        let page = page_of(&scene);
        for piece in page.back_to_front() {
            let given = scene[piece.layer()];
            let vertices: Vec<LayerVertex> = piece.vertices().collect();
            let k = 2 + dice.below(vertices.len() - 2);
            let corners = [vertices[0], vertices[k - 1], vertices[k]];
            let mut shares = [0; 3].map(|_| 0.02 + dice.share());
            let sum: f64 = shares.iter().sum();
            shares = shares.map(|share| share / sum);
            let mix = |what: fn(&LayerVertex) -> DVec3| -> DVec3 {
                corners.iter().zip(shares).map(|(corner, share)| what(corner) * share).sum()
            };
            let (at, perspective) = (mix(|v| v.position), mix(LayerVertex::perspective));
            let drawn = perspective.truncate() / perspective.z;
            let naive = mix(|v| v.local.extend(0.0)).truncate();
            let truth = given.truth();
            let Some((exactly, depth)) = truth.seen_at(&[exact(at.x), exact(at.y)]) else {
                continue;
            };
            let [u, v] = [0, 1].map(|k: usize| number(&exactly[k]));
            // A rounding error on the screen is a larger error in the coordinates of a steep layer.
            let [_, _, z, w] = truth.homogeneous(&exactly);
            assert!(w.is_positive() && !z.is_zero());
            let steep = steepness(&given, [u, v], number(&w));
            let allowed = 1e-10 * (1.0 + steep) * 2000.0;
            if allowed > 0.1 {
                continue;
            }
            let off = (drawn - binspace::glam::dvec2(u, v)).abs().max_element();
            assert!(off <= allowed, "{off} {allowed} {given:?}", given = given.matrix);
            let by_layer = given.layer().local([at.x, at.y]).unwrap();
            assert!((by_layer[0] - u).abs() <= allowed && (by_layer[1] - v).abs() <= allowed);
            let depth_off = (number(&depth) - at.z).abs();
            assert!(depth_off <= allowed * (1.0 + at.z.abs()), "{depth_off}");
            compared += 1;
            cut += usize::from(!piece.is_whole());
            misled += usize::from((naive - drawn).abs().max_element() > 1.0);
        }
    }
    enough!(compared > 1000, cut > 800, misled > 300; "{compared} {cut} {misled}");
}

/// The approximate change of u and v for a change of one pixel.
fn steepness(given: &Given, [u, v]: [f64; 2], w: f64) -> f64 {
    let truth = |u: f64, v: f64| {
        let h = given.matrix * binspace::glam::dvec4(u, v, 0.0, 1.0);
        h.truncate().truncate() / h.w
    };
    let step = 1e-4 * w;
    let here = truth(u, v);
    let (a, b) = ((truth(u + step, v) - here) / step, (truth(u, v + step) - here) / step);
    (a.length() + b.length()) / a.perp_dot(b).abs().max(1e-300)
}
