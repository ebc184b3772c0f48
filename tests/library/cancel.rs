//! A cancel takes effect while a single polygon is being read or prepared.

use binspace::ErrorKind;
use std::cell::Cell;
use testkit::prelude::*;

/// Endless corners.
struct Endless<'a> {
    read: &'a Cell<usize>,
}

impl Polygon for Endless<'_> {
    type Point = DVec3;

    fn corners(&self) -> impl Iterator<Item = DVec3> {
        (0..).map(|k: u32| {
            self.read.set(self.read.get() + 1);
            DVec3::new(f64::from(k), f64::from(k % 2), 0.0)
        })
    }
}

#[test]
fn a_cancel_takes_effect_while_corners_are_read() {
    for calls in [1, 2, 10] {
        let (read, mut heard) = (Cell::new(0), 0);
        let polygons = [Endless { read: &read }];
        let stopped = BuildOptions::DEFAULT.build_with_progress(polygons, |_| {
            heard += 1;
            if heard == calls { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert!(stopped.is_err_and(|error| error.kind() == ErrorKind::Cancelled));
        assert_eq!(heard, calls);
        assert!(read.get() <= calls * 4096, "{} corners", read.get());
    }
}

/// A polygon of many teeth.
fn comb(corners: usize) -> Vec<DVec3> {
    let teeth = (corners - 2) / 2;
    let tip = |k: usize, y: f64| DVec3::new(k as f64, y, 0.0);
    let tips = (0..teeth).rev().flat_map(|k| [tip(2 * k + 1, 1000.0), tip(2 * k, 1.0)]);
    [tip(0, 0.0), tip(2 * teeth, 0.0)].into_iter().chain(tips).collect()
}

#[test]
fn a_cancel_takes_effect_while_one_polygon_is_triangulated() {
    let comb = comb(400_000);
    // All calls before the tree is begun, that is, before the total is the number of triangles.
    let mut all = 0;
    let _ = BuildOptions::DEFAULT.build_with_progress([&comb], |progress| {
        if progress.total > 1 {
            return ControlFlow::Break(());
        }
        all += 1;
        ControlFlow::Continue(())
    });
    enough!(all > 100; "{all} calls");
    for at in [all / 2, all * 3 / 4, all - 1] {
        let mut heard = 0;
        let stopped = BuildOptions::DEFAULT.build_with_progress([&comb], |_| {
            heard += 1;
            if heard == at { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert!(stopped.is_err_and(|error| error.kind() == ErrorKind::Cancelled));
        assert_eq!(heard, at);
    }
}
