//! The pixels of a fragment.

use binspace::internals::Pieces;
use binspace::raster::{Piece, Rays, for_each_run};
use binspace::{BspTree, Fragment};

/// Calls a function with the piece that a painter draws for a fragment.
pub fn with_piece(fragment: &Fragment<'_>, draw: impl FnOnce(Piece<'_>)) {
    draw(Pieces::default().of(fragment));
}

/// Calls a function with the number of each pixel whose centre a fragment covers. Integers decide.
pub fn for_each_pixel(
    tree: &BspTree,
    fragment: &Fragment<'_>,
    rays: &Rays,
    mut see: impl FnMut(usize),
) {
    for_each_number(tree, fragment, rays, &mut see);
}

/// This function is not generic, so that it is compiled with the optimization of this crate.
fn for_each_number(
    tree: &BspTree,
    fragment: &Fragment<'_>,
    rays: &Rays,
    see: &mut dyn FnMut(usize),
) {
    let width = rays.size()[0] as usize;
    with_piece(fragment, |piece| {
        for_each_run(rays, tree.faces(), piece, |y, columns| {
            columns.for_each(|x| see(y as usize * width + x as usize));
        });
    });
}
