//! Build time at a million polygons against a hundred thousand.

use binspace::BspTree;
use binspace::scene::{Builtin, Scene};
use support::{SEED, Table, Target, against, best, check, small_triangles, time};

pub(crate) fn run() {
    let table =
        Table::new("Growth", &["scene", "at 100 000", "at 1 000 000", "ratio", "target", "met"]);
    let builtin = |scene: Builtin| move |count| scene.build(Some(count), SEED);
    measure(&table, "terrain", builtin(Builtin::Terrain));
    measure(&table, "city", builtin(Builtin::City));
    measure(&table, "sphere", builtin(Builtin::Sphere));
    measure(&table, "random small triangles", small_triangles);
}

fn measure(table: &Table, name: &str, scene: impl Fn(u32) -> Scene) {
    let build = |count| {
        let scene = scene(count);
        let (time, tree) = best(|| BspTree::build(scene.polygons()).expect("within budget"));
        check(&tree, &scene);
        time
    };
    let (small, large) = (build(100_000), build(1_000_000));
    let [ratio, target, met] =
        against(large.as_secs_f64() / small.as_secs_f64(), Target::AtMost(13.0));
    table.row(&[name.to_owned(), time(small), time(large), ratio, target, met]);
}
