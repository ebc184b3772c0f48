//! The depth buffer: its conventions, its memory, and the ways to fill it.

use binspace::BspTree;
use binspace::raster::{Image, Rays, colour_of, compare, depth_map, picture, zbuffer};
use binspace::view::Camera;
use binspace_evidence::method::{
    Across, Clear, DepthBuffer, DepthFormat, DepthRules, DepthTest, Layered, Layers, Method,
    Nearer, paint_attributes,
};
use binspace_evidence::panes::{panes, world_polygons};
use binspace_evidence::plain::{Corner, PlainView};

use super::chapter::{Chapter, Picture, failure};
use super::{curved, filling};
use binspace_cli::failure::Failure;
use binspace_cli::pictures::Bright;

const SIZE: [u32; 2] = [240, 180];
const WHITE: [u8; 3] = [255; 3];
/// The opacity of translucent polygons.
const OPACITY: f64 = 0.5;

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.text(
        "A depth buffer (Catmull 1974) stores in each pixel the depth of the nearest surface so far. \
         A nearer surface replaces the stored depth and the colour of the pixel. Polygons may come in \
         any order. The method needs memory for one number per pixel, and these numbers must be \
         precise enough to compare depths. The next chapter is about this precision.",
    );
    let room = Room::new()?;
    conventions(chapter, &room)?;
    depth_maps(chapter, &room);
    translucent(chapter, &room)?;
    filling::fill(chapter)?;
    attributes(chapter, &room)?;
    curved::fill(chapter)
}

/// A scene of parallelograms that cross, in a view with integer coordinates.
struct Room {
    view: PlainView,
    camera: Camera,
    integers: Vec<Vec<Corner>>,
    opaque: Vec<bool>,
    tree: BspTree,
    rays: Rays,
}

impl Room {
    fn new() -> Result<Self, Failure> {
        let view = PlainView::new(SIZE);
        let (integers, opaque) = panes(21, 5);
        let tree = binspace::BuildOptions::DEFAULT
            .with_tolerance(0.0)
            .build(world_polygons(&integers))
            .map_err(failure)?;
        let camera = view.camera();
        let rays = Rays::new(&camera, tree.faces()).map_err(failure)?;
        Ok(Self { view, camera, integers, opaque, tree, rays })
    }

    fn painted(&self, method: &DepthBuffer) -> Result<Image, Failure> {
        let mut ready = method.prepare(self.tree.faces()).map_err(failure)?;
        Ok(ready.paint(&self.camera, &self.rays).map_err(failure)?.image)
    }
}

/// Sets of rules, with names for the nearer end, the test, the clear value, and whether depths are written.
fn sets_of_rules() -> [(&'static str, &'static str, &'static str, &'static str, DepthRules); 7] {
    let smaller = DepthRules::DEFAULT.with_clear(Clear::Largest);
    let larger = DepthRules {
        nearer: Nearer::Larger,
        test: DepthTest::Greater,
        clear: Clear::Smallest,
        writes: true,
    };
    [
        ("smaller", "LESS", "1", "yes", smaller),
        ("smaller", "LEQUAL", "1", "yes", smaller.with_test(DepthTest::LessOrEqual)),
        ("larger", "GREATER", "0", "yes", larger),
        ("larger", "GEQUAL", "0", "yes", larger.with_test(DepthTest::GreaterOrEqual)),
        (
            "larger",
            "LESS",
            "1",
            "yes",
            larger.with_test(DepthTest::Less).with_clear(Clear::Largest),
        ),
        ("smaller", "LESS", "1", "no", DepthRules { writes: false, ..smaller }),
        ("smaller", "LESS", "0", "yes", smaller.with_clear(Clear::Smallest)),
    ]
}

/// The near end, the test, and the clear value.
fn conventions(chapter: &mut Chapter, room: &Room) -> Result<(), Failure> {
    let truth = zbuffer(&room.rays, room.tree.faces()).into_image();
    let (mut rows, mut pictures) = (Vec::new(), Vec::new());
    for (number, (nearer, test, clear, writes, rules)) in (0..).zip(sets_of_rules()) {
        let image = room.painted(&DepthBuffer::new(DepthFormat::Integer(24)).with_rules(rules))?;
        let found = compare(&room.rays, room.tree.faces(), &image, &truth);
        let cells = [nearer, test, clear, writes].map(str::to_owned);
        let [a, b, c, d] = cells.clone();
        rows.push([a, b, c, d, found.wrong().to_string()]);
        if [0, 4, 5].contains(&number) {
            let caption = format!(
                "{nearer} is nearer, {test}, cleared to {clear}{}",
                if writes == "no" { ", writes off" } else { "" }
            );
            let pixels = picture(&room.rays, room.tree.faces(), &image, colour_of, WHITE);
            pictures.push(Picture::new(SIZE, pixels, caption));
        }
    }
    chapter.heading("Conventions");
    chapter.pictures(pictures);
    let head = ["nearer is", "test", "cleared to", "writes", "wrong pixels"];
    chapter.table(head, rows);
    chapter.text(format!(
        "Either small or large numbers can mean near. The test and the clear value must agree with this \
         choice. If the test is reversed, the furthest surface shows. If writes are off, the last polygon \
         shows. If the buffer is cleared to the near end, no polygon passes the test. LESS and LEQUAL differ \
         only where depths are equal: of two coincident polygons, LESS shows the first and LEQUAL the last. \
         {} pixels show a polygon.",
        truth.covered()
    ));
    Ok(())
}

fn depth_maps(chapter: &mut Chapter, room: &Room) {
    let depth = zbuffer(&room.rays, room.tree.faces());
    let map =
        |bright: Bright, caption| Picture::new(SIZE, depth_map(&depth, bright.greys()), caption);
    chapter.heading("The buffer as a picture");
    chapter.text(
        "The depths are drawn as grey levels. Textbooks draw far surfaces lighter, because their numbers \
         are larger. `binspace render --depth` draws near surfaces brighter, as if a lamp were at the \
         eye; `--depth=far` does the opposite. In black pixels there is no surface.",
    );
    chapter
        .pictures([map(Bright::Far, "lighter is further"), map(Bright::Near, "lighter is nearer")]);
}

/// Translucent polygons over opaque polygons.
fn translucent(chapter: &mut Chapter, room: &Room) -> Result<(), Failure> {
    let mut sorted = Vec::new();
    room.tree.back_to_front_into(room.camera.viewpoint(), &mut sorted);
    let unsorted: Vec<u32> = (0..room.tree.len() as u32).collect();
    let cases = [
        ("tree order", "off", &sorted, false),
        ("any order", "off", &unsorted, false),
        ("any order", "on", &unsorted, true),
    ];
    let (mut rows, mut pictures) = (Vec::new(), Vec::new());
    for (name, state, order, writes) in cases {
        let layered = Layered {
            buffer: DepthBuffer::new(DepthFormat::Integer(32)),
            tree: &room.tree,
            camera: &room.camera,
            rays: &room.rays,
            opaque: &room.opaque,
            writes,
        };
        let layers = layered.draw(order).map_err(failure)?;
        let [judged, wrong, lost] = judge(room, &layers);
        rows.push(
            [name, state]
                .map(str::to_owned)
                .into_iter()
                .chain([judged, wrong, lost].map(|n| n.to_string()))
                .collect::<Vec<_>>(),
        );
        pictures.push(Picture::new(
            SIZE,
            blended(room, &layers),
            format!("{name}, writes {state}"),
        ));
    }
    chapter.heading("Translucent polygons");
    chapter.text(
        "A pixel stores one depth. But light comes through every translucent surface in front of the \
         nearest opaque one. So opaque polygons are drawn first, with depth test and depth writes. Then \
         translucent polygons are drawn from back to front, with depth test and without depth writes. If \
         polygons cross, no order of whole polygons is right. The fragments of the tree always have a \
         right order.",
    );
    chapter.pictures(pictures);
    chapter.table(
        ["translucent in", "writes", "pixels judged", "wrong", "layers lost"],
        rows.into_iter().map(|row| <[String; 5]>::try_from(row).expect("five cells")),
    );
    chapter.text(
        "The judge computes for each pixel the list of polygons that the pixel must show, in order. \
         The judge intersects the ray of the pixel with each polygon in integers, and compares the \
         crossings as fractions. (Rays that meet the boundary of a polygon are left out.) Without the \
         order, layers are blended in a wrong sequence. With writes on, some layers are also lost.",
    );
    Ok(())
}

/// The numbers of judged pixels, of wrong pixels, and of missing layers.
fn judge(room: &Room, layers: &Layers) -> [usize; 3] {
    let mut counts = [0; 3];
    for (i, layers) in (0..).zip(layers) {
        let pixel = [i % SIZE[0], i / SIZE[0]];
        let Some(truth) = room.view.shown(&room.integers, &room.opaque, pixel) else { continue };
        counts[0] += 1;
        counts[1] += usize::from(*layers != truth);
        counts[2] += truth.len().saturating_sub(layers.len());
    }
    counts
}

/// The colours of layers, one over the other.
fn blended(room: &Room, layers: &Layers) -> Vec<u8> {
    let colour = |layers: &Vec<u32>| {
        layers.iter().fold(WHITE.map(f64::from), |behind, &polygon| {
            let share = if room.opaque[polygon as usize] { 1.0 } else { OPACITY };
            let own = colour_of(polygon as usize).map(f64::from);
            std::array::from_fn(|i| behind[i] + (own[i] - behind[i]) * share)
        })
    };
    layers.iter().flat_map(|layers| colour(layers).map(|c| c.round() as u8)).collect()
}

/// Texture coordinates on split polygons.
fn attributes(chapter: &mut Chapter, room: &Room) -> Result<(), Failure> {
    let corners = [[0, 0], [6, 0], [6, 6], [0, 6]];
    let all = vec![corners.map(|uv| uv.map(f64::from)).to_vec(); room.integers.len()];
    let (mut pictures, mut rows) = (Vec::new(), Vec::new());
    let cases = [
        (Across::Polygon, "attribute / w and 1 / w"),
        (Across::Picture, "linear on the projection"),
    ];
    for (across, name) in cases {
        let shown = paint_attributes(&room.tree, &room.camera, &room.rays, &all, across);
        let (mut judged, mut wrong, mut largest) = (0, 0, 0.0f64);
        for (i, uv) in (0..).zip(&shown) {
            let exact = exact_place(room, [i % SIZE[0], i / SIZE[0]], &corners);
            let (Some(uv), Some(exact)) = (uv, exact) else { continue };
            largest = largest.max((uv[0] - exact[0]).abs()).max((uv[1] - exact[1]).abs());
            wrong += usize::from(is_dark(*uv) != is_dark(exact));
            judged += 1;
        }
        let colour = |uv| if is_dark(uv) { [40, 60, 90] } else { [235, 225, 200] };
        let rgb = shown.iter().flat_map(|uv| uv.map_or(WHITE, colour)).collect();
        pictures.push(Picture::new(SIZE, rgb, name));
        rows.push([
            name.into(),
            judged.to_string(),
            wrong.to_string(),
            if largest < 1e-3 { format!("{largest:.1e}") } else { format!("{largest:.1}") },
        ]);
    }
    chapter.heading("Textures in perspective");
    chapter.text(
        "Colours and texture coordinates are linear on a polygon, but not on its projection. The quotients \
         attribute / w and 1 / w are linear on the projection. Dividing one by the other gives the attribute \
         in each pixel (Heckbert & Moreton 1991). A painter needs this division too. The splits of the tree \
         create vertices, whose attributes are weighted sums of the attributes of the corners. The weights \
         are exact. If the attributes themselves are interpolated on the projection, the squares of a \
         chequered texture bend, and they bend differently on each side of a split.",
    );
    chapter.pictures(pictures);
    chapter.table(
        ["texture coordinates", "pixels judged", "on a wrong square", "largest error"],
        rows,
    );
    chapter.text(
        "Squares of side 1 cover each polygon. The reference value at each pixel centre is computed in \
         exact rational arithmetic. The largest error is measured in sides of a square.",
    );
    Ok(())
}

/// The texture coordinates in a pixel, by fractions of integers, given the coordinates of the corners.
fn exact_place(room: &Room, pixel: [u32; 2], corners: &[[i32; 2]; 4]) -> Option<[f64; 2]> {
    let layers = room.view.layers(&room.integers, pixel)?;
    let [a, b, _, d] = room.integers[layers.first()?.0 as usize][..] else { return None };
    let values = |n: usize| [corners[0], corners[1], corners[3]].map(|uv| i64::from(uv[n]));
    Some([0, 1].map(|n| room.view.interpolate([a, b, d], values(n), pixel)))
}

fn is_dark(uv: [f64; 2]) -> bool {
    (uv[0].floor() + uv[1].floor()).rem_euclid(2.0) == 0.0
}
