//! Shadows as pieces of polygons.

use binspace::BspTree;
use binspace::glam::DVec3;
use binspace::raster::{Faces, NONE, Rays, picture, zbuffer};
use binspace::view::Camera;
use binspace_evidence::shadows::{Piece, Pieces, Zone, lamp, pieces};

use super::chapter::{Chapter, Picture, failure, percent};
use super::shadows::{SIZE, colour};
use binspace_cli::failure::Failure;

/// Writes the part of the chapter on pieces. `by_lines` contains the zones of the pixels, found by sight
/// lines to the corners of the lamp.
pub(super) fn fill(
    chapter: &mut Chapter,
    tree: &BspTree,
    camera: &Camera,
    middle: &[DVec3],
    by_lines: &[Option<Zone>],
) -> Result<(), Failure> {
    chapter.heading("Shadows as pieces of polygons");
    chapter.text(
        "A point lamp and a convex polygon span a cone. The part of the cone behind the polygon is in \
         the polygon's shadow (F. Crow, \"Shadow algorithms for computer graphics\", 1977). The planes \
         of these cones cut each polygon into convex pieces. For one point of light, each piece is lit \
         as a whole or dark as a whole. A rectangular lamp is treated as its four corners. A polygon \
         can throw a shadow on a second polygon only if the first polygon intersects the pyramid \
         between the second polygon and the lamp. A query to the tree finds these polygons. The pieces \
         do not depend on pixels or on an eye, so they are computed once (P. Atherton, K. Weiler and \
         D. Greenberg, \"Polygon shadow generation\", 1978). The corners of pieces are stored exactly, \
         as points where three planes meet.",
    );
    let faces = tree.faces();
    let lamps = [("a point", middle.to_vec()), ("a rectangle, by its corners", lamp(2))];
    let (mut rows, mut pictures, mut differ) = (Vec::new(), Vec::new(), (0, 0));
    for (name, lamp) in lamps {
        let Pieces { pieces, tried } = pieces(tree, &lamp);
        rows.push(row(name, faces, &pieces, [tried, lamp.len() * faces.len().pow(2)]));
        let (rgb, zones) = painted(camera, faces, &pieces)?;
        let pairs = zones.iter().zip(by_lines).filter(|(zone, _)| zone.is_some());
        differ = (pairs.clone().filter(|(a, b)| a != b).count(), pairs.count());
        let caption = format!("{name}: {} pieces, in alternating shades", pieces.len());
        pictures.push(Picture::new(SIZE, rgb, caption));
    }
    chapter.pictures(pictures);
    let head = [
        "lamp",
        "polygons",
        "pieces",
        "shadows tested, of all pairs",
        "lit",
        "penumbra",
        "umbra",
        "certain umbra",
    ];
    chapter.table(head, rows);
    chapter.text(format!(
        "The shares refer to the total area of all polygons. The areas of the pieces of a polygon sum \
         exactly to the area of the polygon. In the tests, rational numbers decide a million sight lines \
         from points in pieces to the corners of the lamp: all agree with the zone of the piece. Here, {} of \
         {} pixels show another zone than the sight lines above. The reason is that those sight lines start \
         from points that are rounded to whole numbers.",
        differ.0, differ.1,
    ));
    Ok(())
}

fn row(name: &str, faces: &Faces, pieces: &[Piece], [tried, pairs]: [usize; 2]) -> [String; 8] {
    let area = |is_meant: &dyn Fn(&Piece) -> bool| {
        let meant = pieces.iter().filter(|piece| is_meant(piece));
        let areas = meant.map(|piece| area(&piece.corners(faces).collect::<Vec<_>>()));
        areas.fold(0.0, |sum, area| sum + area)
    };
    let whole = area(&|_| true);
    let share = |is_meant: &dyn Fn(&Piece) -> bool| percent(area(is_meant), whole).to_string();
    [
        name.to_owned(),
        faces.len().to_string(),
        pieces.len().to_string(),
        format!("{tried} of {pairs}"),
        share(&|piece| piece.zone() == Zone::Lit),
        share(&|piece| piece.zone() == Zone::Penumbra),
        share(&|piece| piece.zone() == Zone::Umbra),
        share(&|piece| piece.is_umbra),
    ]
}

fn area(corners: &[DVec3]) -> f64 {
    let arms = corners.windows(2).map(|pair| (pair[0] - corners[0]).cross(pair[1] - corners[0]));
    0.5 * arms.sum::<DVec3>().length()
}

/// A picture of the pieces, and the zone in each pixel.
fn painted(
    camera: &Camera,
    faces: &Faces,
    pieces: &[Piece],
) -> Result<(Vec<u8>, Vec<Option<Zone>>), Failure> {
    let outlines: Vec<Vec<DVec3>> =
        pieces.iter().map(|piece| piece.corners(faces).collect()).collect();
    let (cut, _) = Faces::new(&outlines, None).map_err(failure)?;
    let rays = Rays::new(camera, &cut).map_err(failure)?;
    let image = zbuffer(&rays, &cut).into_image();
    let shade = |number: usize| {
        let light = 100 - 4 * (number % 4) as u16;
        colour(pieces[number].zone()).map(|c| (u16::from(c) * light / 100) as u8)
    };
    let zone = |&face: &u32| (face != NONE).then(|| pieces[cut.polygon(face)].zone());
    let zones = image.faces().iter().map(zone).collect();
    Ok((picture(&rays, &cut, &image, shade, [255; 3]), zones))
}
