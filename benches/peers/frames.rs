//! Frames of a compositor, against `plane-split`, which WebRender uses for CSS 3D layers. Every frame builds,
//! orders, and reads every outline, on one thread.

use binspace::{BuildOptions, FrameBuilder, Viewpoint};
use euclid::default::Point3D;
use plane_split::BspSplitter;
use std::time::Duration;
use support::{SEED, Table, best_of, ratio, threads, time};
use testkit::pages::{Page, SCREEN};

type Outline = [[f64; 3]; 4];

const COUNTS: [usize; 4] = [12, 30, 100, 200];
/// Points on the screen at which both orders are judged.
const SAMPLES: [usize; 2] = [48, 27];
/// Depths that differ by less than this, in pixels, are not judged. Points nearer to an edge than this are
/// not judged either.
const MARGIN: f64 = 1e-3;

pub(crate) fn run() {
    let table = Table::new(
        "Page of layers",
        &[
            "page",
            "our pieces",
            "its pieces",
            "our frame",
            "its frame",
            "its time ÷ ours",
            "points",
            "our wrong",
            "its wrong",
        ],
    );
    let pool = threads(1);
    for page in Page::ALL {
        for count in COUNTS {
            let layers = page.layers(count, SEED);
            let outlines: Vec<Outline> = layers.iter().map(|layer| layer.outline()).collect();
            let name = format!("{}:{count}", page.name());
            pool.install(|| measure(&table, name, &outlines));
        }
    }
}

fn measure(table: &Table, name: String, outlines: &[Outline]) {
    let mut order = Vec::new();
    let (mut ours, mut theirs) = (Duration::MAX, Duration::MAX);
    let mut splitter = BspSplitter::<usize>::new();
    let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
    // Both take turns, so that a slow moment of the machine affects both.
    for _ in 0..4 {
        ours = ours.min(best_of(3, || our_frame(outlines, &mut builder, &mut order)).0);
        theirs = theirs.min(best_of(3, || their_frame(outlines, &mut splitter)).0);
    }
    let (of_ours, of_theirs) = (our_pieces(outlines), their_pieces(outlines));
    let depths = |at| outlines.iter().map(|outline| depth(outline, at)).collect();
    let (judged, our_faults) = judge(depths, &of_ours);
    let (_, their_faults) = judge(depths, &of_theirs);
    assert!(judged > 10, "{name}: {judged} points");
    assert_eq!(our_faults, 0, "{name}");
    table.row(&[
        name,
        of_ours.len().to_string(),
        of_theirs.len().to_string(),
        time(ours),
        time(theirs),
        ratio(theirs, ours),
        judged.to_string(),
        our_faults.to_string(),
        their_faults.to_string(),
    ]);
}

/// Builds, orders, reads; returns the sum of the values read, so that the reads are not optimised away.
fn our_frame(outlines: &[Outline], builder: &mut FrameBuilder, order: &mut Vec<u32>) -> f64 {
    let tree = builder.build(outlines).expect("within budget");
    tree.back_to_front_into(Viewpoint::direction([0.0, 0.0, -1.0]), order);
    let vertices = order.iter().flat_map(|&number| tree.fragment(number).vertices());
    vertices.map(|vertex| vertex.x + vertex.y + vertex.z).sum()
}

fn their_frame(outlines: &[Outline], splitter: &mut BspSplitter<usize>) -> f64 {
    splitter.reset();
    for (index, outline) in outlines.iter().enumerate() {
        splitter.add(their_polygon(outline, index));
    }
    let pieces = splitter.sort(euclid::vec3(0.0, 0.0, 1.0));
    pieces.iter().flat_map(|piece| &piece.points).map(|point| point.x + point.y + point.z).sum()
}

fn their_polygon(outline: &Outline, index: usize) -> plane_split::Polygon<usize> {
    let points = outline.map(|[x, y, z]| Point3D::new(x, y, z));
    plane_split::Polygon::from_points(points, index).expect("it has an area")
}

/// A painted piece: its layer, and its corners on the screen.
pub(crate) struct Painted {
    pub(crate) layer: usize,
    pub(crate) corners: Vec<[f64; 2]>,
}

fn our_pieces(outlines: &[Outline]) -> Vec<Painted> {
    let mut builder = FrameBuilder::new(BuildOptions::DEFAULT);
    let tree = builder.build(outlines).expect("within budget");
    assert_eq!(tree.validate(), Ok(()));
    let order = tree.back_to_front(Viewpoint::direction([0.0, 0.0, -1.0]));
    let painted = |fragment: binspace::Fragment<'_>| Painted {
        layer: fragment.polygon(),
        corners: fragment.vertices().map(|vertex| [vertex.x, vertex.y]).collect(),
    };
    order.map(painted).collect()
}

fn their_pieces(outlines: &[Outline]) -> Vec<Painted> {
    let mut splitter = BspSplitter::new();
    for (index, outline) in outlines.iter().enumerate() {
        splitter.add(their_polygon(outline, index));
    }
    let painted = |piece: &plane_split::Polygon<usize>| Painted {
        layer: piece.anchor,
        corners: piece.points.iter().map(|point| [point.x, point.y]).collect(),
    };
    splitter.sort(euclid::vec3(0.0, 0.0, 1.0)).iter().map(painted).collect()
}

/// Paints at points of a grid, given the depths of the layers there. Returns the number of points that at
/// least two layers cover. Also returns at how many of these points the order of the layers differs from the
/// order of their depths.
pub(crate) fn judge(
    depths: impl Fn([f64; 2]) -> Vec<Option<f64>>,
    pieces: &[Painted],
) -> (usize, usize) {
    let (mut judged, mut wrong) = (0, 0);
    for k in 0..SAMPLES[0] * SAMPLES[1] {
        let share = |k: usize, count: usize| (k as f64 + 0.5137) / count as f64;
        let (across, down) = (k % SAMPLES[0], k / SAMPLES[0]);
        let at = [share(across, SAMPLES[0]) * SCREEN[0], share(down, SAMPLES[1]) * SCREEN[1]];
        let depths = depths(at);
        let covering = depths.iter().flatten().count();
        let mut found: Vec<f64> = Vec::new();
        for piece in pieces.iter().filter(|piece| covers(&piece.corners, at, 0.0)) {
            found.extend(depths[piece.layer]);
        }
        if covering >= 2 {
            judged += 1;
            let is_ordered = found.windows(2).all(|pair| pair[0] < pair[1] + MARGIN);
            wrong += usize::from(found.len() < covering || !is_ordered);
        }
    }
    (judged, wrong)
}

/// The depth of a layer at a point that it covers, not too near to its edges.
fn depth(outline: &Outline, [x, y]: [f64; 2]) -> Option<f64> {
    let corners = outline.map(|[x, y, _]| [x, y]);
    let [a, b, c] = [0, 1, 2].map(|k| binspace::glam::DVec3::from(outline[k]));
    let normal = (b - a).cross(c - a);
    let depth = a.z - (normal.x * (x - a.x) + normal.y * (y - a.y)) / normal.z;
    // A layer seen edge-on has no depth to judge.
    let is_steep = normal.z.abs() < 1e-3 * normal.length();
    (!is_steep && covers(&corners, [x, y], MARGIN)).then_some(depth)
}

/// Whether a convex outline, of either orientation, covers a point that is further than a margin
/// from its edges.
fn covers(corners: &[[f64; 2]], [x, y]: [f64; 2], margin: f64) -> bool {
    let next = corners.iter().cycle().skip(1);
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for ([ax, ay], [bx, by]) in corners.iter().zip(next) {
        let length = (bx - ax).hypot(by - ay);
        if length > 0.0 {
            let off = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / length;
            (low, high) = (low.min(off), high.max(off));
        }
    }
    low > margin || high < -margin
}
