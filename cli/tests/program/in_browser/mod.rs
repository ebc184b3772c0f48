//! Pages, and what a browser without a window makes of them. These tests are ignored, as they need
//! Chromium: `cargo test in_browser -- --ignored` runs them.

mod deeds;
mod orders;
mod pictures;
mod speed;

use std::fs;
use std::process::{Command, Stdio};

use binspace::BspTree;

use crate::run::Folder;

/// A page, and the tree that it is of.
pub(crate) fn page_and_tree(folder: &Folder, scene: &str) -> (String, BspTree) {
    folder.run(&format!("build {scene} -o s.bsp")).good();
    folder.run("page s.bsp -o s.html").good();
    let tree = BspTree::read(fs::File::open(folder.path("s.bsp")).unwrap()).unwrap();
    (fs::read_to_string(folder.path("s.html")).unwrap(), tree)
}

/// What Chromium is called.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome-stable", "google-chrome"];

/// The browser's name.
pub(crate) fn browser() -> &'static str {
    let runs = |name: &&&str| {
        let mut command = Command::new(name);
        command.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    };
    NAMES.iter().find(runs).unwrap_or_else(|| panic!("none of {NAMES:?} is installed"))
}

/// What a script says at the end of a page: the body of a function that returns a text without markup.
pub(crate) fn said(browser: &str, folder: &Folder, page: &str, script: &str) -> String {
    let page = page.replace(
        "</body>",
        &format!(
            "<script>{{ const said = document.createElement('pre'); said.id = 'said';\n\
             try {{ said.textContent = (() => {{ {script} }})(); }}\n\
             catch (error) {{ said.textContent = 'error: ' + error.stack; }}\n\
             document.body.append(said); }}</script></body>"
        ),
    );
    folder.write("judged.html", page);
    let profile = folder.path("profile");
    let _ = fs::remove_dir_all(&profile);
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--dump-dom"])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("file://{}", folder.path("judged.html").display()))
        .output()
        .unwrap();
    let _ = fs::remove_dir_all(&profile);
    let dom = String::from_utf8(output.stdout).unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    let said = dom.split_once("<pre id=\"said\">").and_then(|(_, rest)| rest.split_once("</pre>"));
    let (said, _) = said.unwrap_or_else(|| panic!("nothing said: {errors}"));
    assert!(!said.starts_with("error: "), "{said}");
    said.to_owned()
}
