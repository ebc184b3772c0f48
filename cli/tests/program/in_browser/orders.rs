//! The script of a page orders as the library does.

use binspace::internals::LATTICE_LIMIT;
use binspace::{BspTree, Viewpoint};

use super::page_and_tree;
use crate::run::{CROSSING, Folder};
use testkit::browser::{browser, eye_at, hash, hash_in_script, said};
use testkit::dice::Dice;

/// An eye at a point of the grid, or a direction to look in, of components that are kept as they are.
#[derive(Clone, Copy, Debug)]
enum Eye {
    At([f64; 3]),
    Towards([f64; 3]),
}

impl Eye {
    /// The eye in the library's terms; `None` if its position cannot be expressed.
    fn viewpoint(self, tree: &BspTree) -> Option<Viewpoint> {
        match self {
            Self::At(point) => eye_at(tree, point),
            Self::Towards(direction) => Some(Viewpoint::Direction(direction.into())),
        }
    }

    fn script(self) -> String {
        match self {
            Self::At(point) => format!("eyeAt(TREE, {:?})", point.map(|c| c / LATTICE_LIMIT)),
            Self::Towards(direction) => format!("eyeTowards({direction:?})"),
        }
    }
}

/// Eyes around and inside a scene and far from it; on planes, on their lines and on vertices; and directions,
/// also along planes.
fn eyes(tree: &BspTree, count: usize, seed: u64) -> Vec<Eye> {
    let mut dice = Dice(seed);
    let nodes: Vec<_> = tree.nodes().map(|node| node.grid_points()).collect();
    let mut eyes = Vec::new();
    for k in 0..count {
        let [p, q, r] =
            nodes[dice.roll() as usize % nodes.len()].map(|point| point.map(|c| c as f64));
        let mut point = |reach: f64| [(); 3].map(|()| (dice.range(-reach, reach)).round());
        let along =
            |a: f64, b: f64| std::array::from_fn(|i| p[i] + a * (q[i] - p[i]) + b * (r[i] - p[i]));
        eyes.push(match k % 10 {
            0 | 1 => Eye::At(point(LATTICE_LIMIT)),
            2 => Eye::At(point(4.0 * LATTICE_LIMIT)),
            3 => Eye::At(point(500.0 * LATTICE_LIMIT)),
            4 => Eye::At(p),
            // On a plane, or next to one.
            5 => Eye::At(along(2.0, -1.0)),
            6 => Eye::At(along(1.0, 1.0).map(|c: f64| c + 1.0)),
            7 => Eye::Towards(point(LATTICE_LIMIT)),
            8 => Eye::Towards(std::array::from_fn(|i| q[i] - p[i])),
            _ => {
                let mut direction = [0.0; 3];
                direction[k / 10 % 3] = if k / 30 % 2 == 0 { 1.0 } else { -1.0 };
                Eye::Towards(direction)
            }
        });
    }
    eyes
}

/// The number of planes that integers decided, and the orders of a page, hashed.
fn orders_of_page(browser: &str, folder: &Folder, page: &str, eyes: &[Eye]) -> Vec<u32> {
    let eyes: Vec<String> = eyes.iter().map(|eye| eye.script()).collect();
    let script = format!(
        "let integers = 0;
        const exact = isInFront;
        isInFront = (...args) => {{ integers++; return exact(...args); }};
        const hashes = [{}].map(eye => {});
        return [integers, ...hashes].join(' ');",
        eyes.join(",\n"),
        hash_in_script("backToFront(TREE, eye)"),
    );
    let said = said(browser, &folder.path(""), page, &script);
    said.split(' ').map(|number| number.parse().unwrap()).collect()
}

#[test]
#[ignore = "needs Chromium"]
fn orders_are_those_of_the_library() {
    let browser = browser();
    let folder = Folder::new("page_orders");
    folder.write("crossing.obj", CROSSING);
    folder.write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let far: String = CROSSING
        .lines()
        .map(|line| match line.strip_prefix("v ") {
            Some(point) => {
                let moved = point.split(' ').map(|c| (c.parse::<f64>().unwrap() + 5e5).to_string());
                format!("v {}\n", moved.collect::<Vec<_>>().join(" "))
            }
            None => format!("{line}\n"),
        })
        .collect();
    folder.write("far.obj", far);
    let scenes =
        ["teapot:6", "random:200", "city:500", "layers", "newell", "crossing.obj", "far.obj"];
    let (mut compared, mut integers) = (0, 0);
    for (seed, scene) in scenes.into_iter().enumerate() {
        let (page, tree) = page_and_tree(&folder, scene);
        let mut eyes = eyes(&tree, 200, seed as u64);
        eyes.retain(|eye| eye.viewpoint(&tree).is_some());
        let found = orders_of_page(browser, &folder, &page, &eyes);
        integers += found[0];
        assert_eq!(found.len(), eyes.len() + 1);
        let mut order = Vec::new();
        let mut expected = Vec::new();
        for &eye in &eyes {
            tree.back_to_front_into(eye.viewpoint(&tree).unwrap(), &mut order);
            expected.push(hash(&order));
        }
        for (i, eye) in eyes.iter().enumerate() {
            assert_eq!(found[i + 1], expected[i], "{scene}: {eye:?}");
        }
        compared += eyes.len();
        if scene == "city:500" {
            // A copy that never uses the integers is detected.
            let broken = page.replace("if (isSure || ", "if (true || ");
            assert_ne!(broken, page);
            let broken = orders_of_page(browser, &folder, &broken, &eyes);
            let wrong = broken[1..].iter().zip(&expected).filter(|(found, right)| found != right);
            assert!(wrong.count() > 20);
        }
    }
    assert!(compared >= 1200, "{compared}");
    assert!(integers > 10_000, "{integers}");
    let (page, tree) = page_and_tree(&folder, "one.obj");
    assert_eq!(tree.len(), 1);
    let found = orders_of_page(browser, &folder, &page, &[Eye::At([1.0, 2.0, 3.0])]);
    assert_eq!(found, [0, hash(&[0])]);
}
