//! Shadows as pieces of polygons.

use binspace::BspTree;
use binspace::glam::DVec3;
use binspace::raster::{Faces, NONE, Rays, picture, zbuffer};
use binspace::view::Camera;
use binspace_evidence::shadows::{Piece, Pieces, Zone, lamp, pieces};

use super::chapter::{Chapter, Picture, failure, percent};
use super::shadows::{SIZE, colour};
use binspace_cli::failure::Failure;

/// The part of the chapter on pieces. `by_lines` holds the zones of the pixels by sight lines to the corners
/// of the lamp.
pub(super) fn fill(
    chapter: &mut Chapter,
    tree: &BspTree,
    camera: &Camera,
    middle: &[DVec3],
    by_lines: &[Option<Zone>],
) -> Result<(), Failure> {
    chapter.heading("Shadows as pieces of polygons");
    chapter.text(
        "A point lamp and a convex polygon span a cone; what is in the cone behind the polygon is in its shadow \
         (F. Crow, \"Shadow algorithms for computer graphics\", 1977). Each polygon is cut by the planes of \
         these cones into convex pieces, each of them lit or not as a whole. Of a rectangle it is done for its \
         four corners. Which polygons may throw a shadow on another is asked of the tree: those that go through \
         the pyramid between it and the lamp. The pieces have nothing to do with pixels or with an eye: they are made once (P. \
         Atherton, K. Weiler and D. Greenberg, \"Polygon shadow generation\", 1978). Corners of pieces are kept \
         exactly, as points where three planes meet.",
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
        let caption = format!("{name}: {} pieces, each in a shade of its own", pieces.len());
        pictures.push(Picture::new(SIZE, rgb, caption));
    }
    chapter.pictures(pictures);
    let head = [
        "lamp",
        "polygons",
        "pieces",
        "shadows tried, of all pairs",
        "lit",
        "penumbra",
        "umbra",
        "umbra for certain",
    ];
    chapter.table(head, rows);
    chapter.text(format!(
        "Shares are of the area of all polygons; the pieces of each polygon have its area, in rational numbers. \
         In the tests, a million sight lines from points within the pieces to the corners of the lamp are \
         decided by rational numbers: none is other than its piece says. Here, {} of {} pixels show another \
         zone than by sight lines above, as those start from points that are rounded to whole numbers.",
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
