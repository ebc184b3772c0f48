//! Shapes that are cut at the borders of the polygons on which they lie: reduced cases in which a part went to the side of
//! a polygon beside it.

use binspace::glam::Vec3;
use binspace::overlay::{Overlay, Shape};
use testkit::prelude::*;

/// A wall of squares in two planes that cross at a small angle.
const WALL: &[&[[f32; 3]]] = &[
    &[
        [-0.24670321, -1.5911705, 0.5385595],
        [0.32868657, -1.2549968, 0.557487],
        [0.28635678, -1.1695346, 0.32639316],
        [-0.28903303, -1.5057082, 0.30746558],
    ],
    &[
        [0.32868657, -1.2549968, 0.557487],
        [0.90407634, -0.91882306, 0.5764146],
        [0.86174655, -0.8333608, 0.3453207],
        [0.28635678, -1.1695346, 0.32639316],
    ],
    &[
        [0.28635678, -1.1695346, 0.32639316],
        [0.86174655, -0.8333608, 0.3453207],
        [0.81941676, -0.74789846, 0.11422683],
        [0.24402696, -1.0840722, 0.095299274],
    ],
    &[
        [-0.37369263, -1.3347837, -0.15472217],
        [0.20169714, -0.9986099, -0.13579461],
        [0.15936734, -0.9131476, -0.3668885],
        [-0.41602245, -1.2493213, -0.38581604],
    ],
    &[
        [0.20169714, -0.9986099, -0.13579461],
        [0.7770869, -0.6624362, -0.11686705],
        [0.7347571, -0.57697386, -0.34796095],
        [0.15936734, -0.9131476, -0.3668885],
    ],
    &[
        [0.7770869, -0.6624362, -0.11686705],
        [1.3524767, -0.3262624, -0.0979395],
        [1.3101469, -0.24080011, -0.32903337],
        [0.7347571, -0.57697386, -0.34796095],
    ],
    &[
        [1.2072521, -0.5947596, 0.28012162],
        [1.4230222, -0.46869245, 0.2872204],
        [1.394802, -0.41171718, 0.133158],
        [1.179032, -0.53778434, 0.12605922],
    ],
    &[
        [-0.33135784, -1.4202543, 0.07636772],
        [-0.11558785, -1.2941872, 0.08346651],
        [-0.14380796, -1.237212, -0.07059589],
        [-0.35957795, -1.363279, -0.07769468],
    ],
    &[
        [0.69105184, -0.67596805, -0.19626315],
        [0.90682185, -0.54990095, -0.18916437],
        [0.87860173, -0.49292567, -0.34322676],
        [0.6628317, -0.6189928, -0.35032555],
    ],
    &[
        [1.1225919, -0.4238338, -0.18206558],
        [1.3383617, -0.29776666, -0.1749668],
        [1.3101417, -0.2407914, -0.3290292],
        [1.0943717, -0.36685854, -0.33612797],
    ],
    &[
        [-0.030657044, -0.9039612, -0.6237236],
        [0.40088293, -0.6518269, -0.60952604],
        [0.37009734, -0.5896721, -0.77759415],
    ],
    &[
        [-0.030657044, -0.9039612, -0.6237236],
        [0.37009734, -0.5896721, -0.77759415],
        [-0.061442617, -0.84180635, -0.7917917],
    ],
    &[
        [0.40088293, -0.6518269, -0.60952604],
        [0.83242285, -0.39969262, -0.5953285],
        [0.8016373, -0.3375378, -0.76339656],
    ],
];
const LABEL: &[[f32; 3]] = &[
    [0.5219359, -1.0715817, 0.4168674],
    [1.2167695, -0.6656225, 0.4397241],
    [0.91982985, -0.06611248, -1.1813776],
    [0.22499624, -0.47207174, -1.2042344],
];

/// Triangles of `f32` corners on a slope, with the smaller tolerance of `f64`.
const SLOPES: &[&[[f64; 3]]] = &[
    &[
        [0.9309864, -0.65440536, -1.0915233],
        [-0.04277025, -0.51158917, -0.8857133],
        [-0.02809891, -0.4195674, -0.9333887],
    ],
    &[
        [-0.010816561, -0.32351276, -0.97121745],
        [-0.9871842, -0.18472949, -0.77525413],
        [-0.96990186, -0.08867482, -0.8130829],
    ],
    &[
        [-0.02809891, -0.4195674, -0.9333887],
        [-1.0018555, -0.27675122, -0.7275787],
        [-0.9871842, -0.18472949, -0.77525413],
    ],
];
const ROUND_LABEL: &[[f32; 3]] = &[
    [0.11941512, -0.37152103, -0.99754864],
    [0.11601993, -0.39281636, -0.98651576],
    [0.11262474, -0.4141117, -0.97548294],
    [0.10922956, -0.435407, -0.96445006],
    [0.105834365, -0.45670235, -0.9534172],
    [-0.08970365, -0.40882367, -0.9211768],
    [-0.28524166, -0.36094496, -0.88893634],
    [-0.48077968, -0.31306627, -0.85669595],
    [-0.6763177, -0.2651876, -0.8244555],
    [-0.6729225, -0.24389227, -0.8354884],
    [-0.6695273, -0.22259694, -0.8465212],
    [-0.66613215, -0.20130162, -0.8575541],
    [-0.66273695, -0.1800063, -0.86858696],
    [-0.46719894, -0.22788498, -0.90082735],
    [-0.27166092, -0.27576366, -0.9330678],
    [-0.0761229, -0.32364234, -0.9653082],
];

/// A plane, as a unit normal and an offset.
fn plane([a, b, c]: [DVec3; 3]) -> (DVec3, f64) {
    let normal = (b - a).cross(c - a).normalize();
    (normal, normal.dot(a))
}

/// Whether a polygon contains a point of its plane.
fn contains(vertices: &[DVec3], at: DVec3, normal: DVec3) -> bool {
    let sides = (0..vertices.len()).map(|i| {
        let side = vertices[(i + 1) % vertices.len()] - vertices[i];
        side.normalize_or_zero().cross(at - vertices[i]).dot(normal)
    });
    let sides: Vec<f64> = sides.collect();
    sides.iter().all(|side| *side > 1e-7) || sides.iter().all(|side| *side < -1e-7)
}

/// The order of a polygon of the tree and of a label at a point of the polygon, from both sides: whether the nearer one is
/// later. `None` if one of them does not cover the point or they are too close to each other.
fn is_right(
    (tree, overlay): (&BspTree, &Overlay),
    (polygon, label): (usize, usize),
    planes: [(DVec3, f64); 2],
    at: DVec3,
    least: f64,
) -> Option<bool> {
    let mut is_right = true;
    for sign in [1.0, -1.0] {
        let direction = sign * planes[0].0;
        let along = planes.map(|(n, offset)| (offset - n.dot(at)) / n.dot(direction));
        if (along[0] - along[1]).abs() < least {
            return None;
        }
        let mut places = [None; 2];
        let order = overlay.order(tree, Viewpoint::direction(direction)).expect("its own tree");
        for (place, shape) in order.into_iter().enumerate() {
            let Shape::Fragment(fragment) = shape else { continue };
            let vertices: Vec<DVec3> = fragment.vertices().collect();
            for (k, wanted) in [polygon, label].into_iter().enumerate() {
                let there = at + direction * along[k];
                if fragment.polygon() == wanted && contains(&vertices, there, planes[k].0) {
                    places[k] = Some(place);
                }
            }
        }
        is_right &= (places[0]? > places[1]?) == (along[0] < along[1]);
    }
    Some(is_right)
}

#[test]
fn a_part_beside_a_border_does_not_go_with_the_polygon_there() {
    let options = BuildOptions::DEFAULT
        .with_heuristic(Heuristic::Weighted { splits: 8.0, balance: 1.0, axial: 0.0 })
        .with_bounds(DVec3::splat(-8.0), DVec3::splat(8.0));
    let mut frames = FrameBuilder::new(options);
    let tree = frames.build(WALL.iter().map(|p| p.to_vec())).expect("a tree");
    let mut overlay = Overlay::new(tree);
    overlay.replace(tree, [LABEL.to_vec()]).expect("on the grid");
    let planes = [WALL[8], LABEL].map(|p| plane([0, 1, 2].map(|i| Vec3::from(p[i]).as_dvec3())));
    let at = dvec3(0.739_197_39, -0.608_529_34, -0.276_618_4);
    let polygons = (8, WALL.len());
    assert_eq!(is_right((tree, &overlay), polygons, planes, at, 0.0), Some(true));
}

#[test]
fn a_part_that_reaches_far_beyond_a_plane_does_not_go_with_a_thin_polygon_on_the_other_side() {
    let mut judged = 0;
    for &heuristic in Heuristic::ALL {
        let options = BuildOptions::DEFAULT
            .with_bounds(DVec3::splat(-8.0), DVec3::splat(8.0))
            .with_heuristic(heuristic)
            .with_tolerance(1e-12);
        let rounded = |p: &&[[f64; 3]]| p.iter().map(|c| c.map(|x| f64::from(x as f32))).collect();
        let still: Vec<Vec<[f64; 3]>> = SLOPES.iter().map(rounded).collect();
        let tree = options.build(&still).expect("a tree");
        let mut overlay = Overlay::new(&tree);
        overlay.replace(&tree, [ROUND_LABEL.to_vec()]).expect("on the grid");
        let triangle = [0, 1, 2].map(|i| DVec3::from(still[1][i]));
        let label = [0, 5, 10].map(|i| Vec3::from(ROUND_LABEL[i]).as_dvec3());
        let planes = [plane(triangle), plane(label)];
        let [a, b, c] = triangle;
        for k in 0..400 {
            let (u, v) = (f64::from(k % 20) / 20.0 + 0.02, f64::from(k / 20) / 20.0 + 0.02);
            if u + v > 0.98 {
                continue;
            }
            let at = a + (b - a) * u + (c - a) * v;
            let found = is_right((&tree, &overlay), (1, SLOPES.len()), planes, at, 1e-4);
            assert!(found != Some(false), "{heuristic} {u} {v}");
            judged += usize::from(found.is_some());
        }
    }
    enough!(judged > 50; "{judged}");
}
