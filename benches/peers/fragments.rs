//! Fragments per face by the default heuristic. No time is taken.

use binspace::BspTree;
use support::{Table, Target, against, check, scene};

const SCENES: [(&str, f64); 12] = [
    ("city:10000", 1.02),
    ("city:100000", 1.02),
    ("terrain:10000", 1.02),
    ("terrain:100000", 1.02),
    ("sphere:10000", 1.06),
    ("sphere:100000", 1.06),
    ("teapot_quads_32k.obj", 1.20),
    ("chessboard_63k.obj", 1.12),
    ("doom_map12_big.obj", 1.10),
    ("bunny_4k.obj", 1.60),
    ("maple_tree_166k.obj", 2.3),
    ("showroom_big_cc0.obj", 2.7),
];

pub(crate) fn run() {
    let table = Table::new(
        "Fragments per face, by `auto`",
        &["scene", "faces", "fragments", "ratio", "target", "met"],
    );
    for (name, target) in SCENES {
        let Some(scene) = scene(name) else { continue };
        let tree = BspTree::build(scene.polygons()).expect("within budget");
        check(&tree, &scene);
        let stats = tree.stats();
        let measured = stats.fragments as f64 / stats.faces as f64;
        let [_, target, met] = against(measured, Target::AtMost(target));
        let ratio = format!("{measured:.3}");
        table.row(&[
            name.to_owned(),
            stats.faces.to_string(),
            stats.fragments.to_string(),
            ratio,
            target,
            met,
        ]);
    }
}
