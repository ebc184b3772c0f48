//! The kind of each error that a program can act on.

use binspace::overlay::{Overlay, Shapes};
use binspace::{Error, ErrorKind};
use testkit::prelude::*;
use testkit::shapes::rectangle;

const NAN: DVec3 = DVec3::NAN;

/// A square, and a tree that contains only the square.
fn square() -> (Corners, BspTree) {
    let square = rectangle([0.0, 0.0], [1.0, 1.0], 0.0);
    let tree = BspTree::build([&square]).expect("within budget");
    (square, tree)
}

#[test]
fn each_error_has_its_kind() {
    let (square, tree) = square();
    let build = |options: BuildOptions, polygon: &[DVec3]| options.build([polygon]).map(drop);
    let view = |opacities: Vec<f64>| {
        let camera = Camera::perspective(DVec3::splat(5.0), DVec3::ZERO, DVec3::Z, 0.7, [8, 8])?;
        tree.visibility(&camera, &ViewOptions::DEFAULT.with_opacities(opacities)).map(drop)
    };
    let move_to = |corner: DVec3| {
        let mut overlay = Overlay::new(&tree);
        overlay.replace(&tree, [[corner, corner + DVec3::X, corner + DVec3::Y]])
    };
    let all = BuildOptions::DEFAULT;
    let cases: [(&str, Result<(), Error>, ErrorKind); 13] = [
        ("NaN", build(all.clone(), &[NAN; 3]), ErrorKind::InvalidInput),
        (
            "corners",
            BspTree::build([vec![DVec3::ONE; (1 << 22) + 1]]).map(drop),
            ErrorKind::InvalidInput,
        ),
        ("tolerance", build(all.clone().with_tolerance(-1.0), &square), ErrorKind::InvalidInput),
        ("bounds", build(all.clone().with_bounds(NAN, NAN), &square), ErrorKind::InvalidInput),
        ("budget", build(all.clone().with_max_fragments(0), &square), ErrorKind::OverBudget),
        ("opacity", view(vec![2.0]), ErrorKind::InvalidInput),
        ("opacities", view(vec![1.0; 2]), ErrorKind::InvalidInput),
        ("NaN moved", move_to(NAN), ErrorKind::InvalidInput),
        ("far away", move_to(DVec3::splat(1e30)), ErrorKind::OutOfBounds),
        ("open", tree.winding_number([0.5, 0.5, 0.5]).map(drop), ErrorKind::OpenBody),
        ("heuristic", "best".parse::<Heuristic>().map(drop), ErrorKind::InvalidInput),
        ("scene", "nowhere".parse::<Builtin>().map(drop), ErrorKind::InvalidInput),
        ("file", BspTree::read(&b"something else"[..]).map(drop), ErrorKind::InvalidFile),
    ];
    for (name, result, kind) in cases {
        let error = result.expect_err(name);
        assert_eq!(error.kind(), kind, "{name}: {error}");
        assert_eq!(format!("{error:?}"), format!("Error({:?})", error.to_string()), "{name}");
    }
    let mesh = tree.mesh().expect("a small mesh");
    let error = mesh.triangles().write_order(&[0], &mut []).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidInput);
}

/// Only polygons and layers can be renumbered.
#[test]
fn a_line_keeps_its_number() {
    let (_, tree) = square();
    let mut overlay = Overlay::new(&tree);
    let lines = Shapes::NONE.with_lines([[NAN, DVec3::ZERO]]);
    let error = overlay.replace_with(&tree, lines).unwrap_err();
    assert_eq!((error.line(), error.clone().with_polygon(7).line()), (Some(0), Some(0)));
    assert_eq!(error.with_polygon(7).polygon(), None);
}

/// A reader that fails.
struct Failing(std::io::ErrorKind);

impl std::io::Read for Failing {
    fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
        Err(self.0.into())
    }
}

/// Errors of a reader are equal if they are of the same kind.
#[test]
fn errors_of_files_are_compared_by_their_kinds() {
    use std::io::ErrorKind::{NotFound, PermissionDenied};
    let [missing, again, forbidden] = [NotFound, NotFound, PermissionDenied]
        .map(|kind| BspTree::read(Failing(kind)).map(drop).unwrap_err());
    assert_eq!(missing, again);
    assert_ne!(missing, forbidden);
}
