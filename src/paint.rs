//! Painting a tree's fragments, with exact coverage of every pixel.

use crate::exact::EdgeLine;
use crate::raster::{Image, Layers, Outline, Painter, Piece, Rays, blend, for_each_shaded};
use crate::tree::{BspTree, Fragment};
use crate::viewpoint::Viewpoint;

/// Paints a tree's [fragments](Fragment) in the back-to-front order of a viewpoint. `viewpoint` should be the
/// viewpoint of the camera that the rays were made from.
///
/// The edges of fragments are exact: they are computed from the planes that cut the fragments, not from
/// rounded vertices.
///
/// # Panics
///
/// If the rays were made for a tree with another [grid](BspTree::grid).
pub fn paint_tree(tree: &BspTree, viewpoint: Viewpoint, rays: &Rays) -> Image {
    let mut order = Vec::new();
    tree.back_to_front_into(viewpoint, &mut order);
    paint_order(tree, &order, rays)
}

/// Paints the [fragments](Fragment) whose numbers are in a list, such as a culled order. Each fragment is
/// painted over the earlier fragments of the list. Numbers that belong to no fragment are skipped.
///
/// # Panics
///
/// If the rays were made for a tree with another [grid](BspTree::grid).
pub fn paint_order(tree: &BspTree, order: &[u32], rays: &Rays) -> Image {
    paint_list(Painter::new(rays, tree.faces()), tree, order, None)
}

/// Paints fragments of a tree one after the other, and records the faces that cover each pixel. Numbers
/// that name no fragment are skipped.
pub(crate) fn paint_list(
    mut painter: Painter<'_>,
    tree: &BspTree,
    list: &[u32],
    mut layers: Option<&mut Layers>,
) -> Image {
    let mut pieces = Pieces::default();
    for &index in list.iter().filter(|&&index| (index as usize) < tree.len()) {
        let fragment = tree.fragment(index);
        painter.draw_and(pieces.of(&fragment), |y, columns| {
            if let Some(layers) = &mut layers {
                layers.add(fragment.face(), y, columns);
            }
        });
    }
    painter.finish()
}

/// Paints a tree's [fragments](Fragment) in colours, back to front, over a background. `look` returns the
/// colour and the opacity of a polygon, given the polygon's number.
///
/// The picture is RGB, 8 bits each, row by row from the top left. If all polygons are opaque, the picture
/// equals [`raster::picture`](crate::raster::picture) of the image from [`paint_tree`].
///
/// # Panics
///
/// If the rays were made for a tree with another [grid](BspTree::grid).
pub fn paint_tree_in_colour(
    tree: &BspTree,
    viewpoint: Viewpoint,
    rays: &Rays,
    look: impl Fn(usize) -> ([u8; 3], f32),
    background: [u8; 3],
) -> Vec<u8> {
    let [width, height] = rays.size().map(|side| side as usize);
    let mut pixels = vec![background.map(f32::from); width * height];
    for_each_painted(tree, viewpoint, rays, look, |pixel, colour, opacity| {
        blend(&mut pixels[pixel], colour, opacity);
    });
    pixels.into_iter().flatten().map(|channel| channel.round() as u8).collect()
}

/// Calls `paint` for each pixel of each [fragment](Fragment), back to front. The arguments of `paint` are the
/// pixel's number, counted row by row from the top left, and the colour and opacity of the fragment. If
/// `paint` calls [`blend`], the result is the picture of [`paint_tree_in_colour`]. To paint a
/// [partition](crate::partition), call this function for the tree of each cell, back to front.
///
/// # Panics
///
/// If the rays were made for a tree with another [grid](BspTree::grid).
pub fn for_each_painted(
    tree: &BspTree,
    viewpoint: Viewpoint,
    rays: &Rays,
    look: impl Fn(usize) -> ([u8; 3], f32),
    mut paint: impl FnMut(usize, [u8; 3], f32),
) {
    rays.expect(tree.faces());
    let mut order = Vec::new();
    tree.back_to_front_into(viewpoint, &mut order);
    let mut pieces = Pieces::default();
    for index in order {
        let fragment = tree.fragment(index);
        let (colour, opacity) = look(fragment.polygon());
        for_each_shaded(rays, tree.faces(), pieces.of(&fragment), colour, |pixel, colour| {
            paint(pixel, colour, opacity);
        });
    }
}

#[doc(hidden)]
/// Converts fragments to pieces for painting, in reused memory.
#[derive(Clone, Debug, Default)]
pub struct Pieces {
    lines: Vec<EdgeLine>,
    vertices: Vec<[f64; 3]>,
}

impl Pieces {
    /// Returns a fragment as a piece bounded by its exact lines.
    pub fn of(&mut self, fragment: &Fragment<'_>) -> Piece<'_> {
        let face = fragment.face();
        if fragment.is_whole() {
            return Piece { face, outline: Outline::Whole };
        }
        self.vertices.clear();
        self.vertices.extend(fragment.lattice_vertices());
        let vertices = &self.vertices[..];
        self.lines.clear();
        self.lines.extend(fragment.lines());
        Piece { face, outline: Outline::Lines { lines: &self.lines, vertices } }
    }
}
