//! Pictures per second of a page of the program in Chromium. Measures the processor alone: no graphics card
//! paints.

#![allow(missing_docs, reason = "a program")]

use std::path::Path;
use std::process::Command;
use std::{env, fs};

use binspace::BspTree;
use support::{Table, print_head};
use testkit::browser::{browser, turn};

const PICTURES: u32 = 60;

/// Runs the program in a folder.
fn run(folder: &Path, arguments: &str) {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cli/Cargo.toml");
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or("cargo".into()));
    cargo.args(["run", "--quiet", "--release", "--manifest-path"]).arg(manifest).arg("--");
    let status = cargo.args(arguments.split(' ')).current_dir(folder).status();
    assert!(status.is_ok_and(|status| status.success()), "{arguments}");
}

fn main() {
    print_head("Pages", "cargo bench -p binspace-benches --bench page");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("page");
    fs::create_dir_all(&folder).expect("a folder");
    let columns = ["scene", "fragments", "pictures / s", "with all edges"];
    let table = Table::new("Pages: pictures of 1280 by 720 in Chromium", &columns);
    for scene in ["city:10000", "teapot:14", "random:910"] {
        run(&folder, &format!("build {scene} -o s.bsp"));
        run(&folder, "page s.bsp -o s.html");
        let file = fs::File::open(folder.join("s.bsp")).expect("a tree's file");
        let tree = BspTree::read(file).expect("a tree");
        let page = fs::read_to_string(folder.join("s.html")).expect("a page");
        let [plain, with_edges] = turn(browser(), &folder, &page, &tree, PICTURES)
            .map(|milliseconds| format!("{:.0}", 1e3 / milliseconds));
        table.row(&[scene.to_owned(), tree.len().to_string(), plain, with_edges]);
    }
}
