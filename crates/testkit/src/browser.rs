//! Pages of the program in a browser without a window.

use binspace::glam::DVec3;
use binspace::{BspTree, Viewpoint};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// The possible names of Chromium.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome-stable", "google-chrome"];

/// Returns the browser's name.
pub fn browser() -> &'static str {
    let runs = |name: &&&str| {
        let mut command = Command::new(name);
        command.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    };
    NAMES.iter().find(runs).unwrap_or_else(|| panic!("none of {NAMES:?} is installed"))
}

/// Runs a script at the end of a page, and returns its text, without markup. The script is the body of a
/// function. The browser stores its files in the folder.
pub fn said(browser: &str, folder: &Path, page: &str, script: &str) -> String {
    let page = page.replace(
        "</body>",
        &format!(
            "<script>{{ const said = document.createElement('pre'); said.id = 'said';\n\
             try {{ said.textContent = (() => {{ {script} }})(); }}\n\
             catch (error) {{ said.textContent = 'error: ' + error.stack; }}\n\
             document.body.append(said); }}</script></body>"
        ),
    );
    let (judged, profile) = (folder.join("judged.html"), folder.join("profile"));
    fs::write(&judged, page).unwrap();
    let _ = fs::remove_dir_all(&profile);
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--dump-dom"])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("file://{}", judged.display()))
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

/// Returns a hash of a list: the function of Fowler, Noll and Vo over its numbers.
pub fn hash(order: &[u32]) -> u32 {
    order.iter().fold(2_166_136_261, |hash, &number| (hash ^ number).wrapping_mul(16_777_619))
}

/// Returns an expression that computes the same hash of a list in a script.
pub fn hash_in_script(list: &str) -> String {
    format!(
        "({list}.reduce((hash, number) => Math.imul(hash ^ number, 16777619), 2166136261 | 0) >>> 0)"
    )
}

/// Returns an eye at a point of the grid as the library takes it; `None` if its position cannot be expressed.
pub fn eye_at(tree: &BspTree, point: [f64; 3]) -> Option<Viewpoint> {
    let grid = tree.grid();
    let away = DVec3::from(point) * 2f64.powi(grid.exponent);
    let at = grid.base + away;
    (at - away == grid.base && at - grid.base == away).then_some(Viewpoint::Eye(at))
}

/// Turns the camera of a page around its scene twice: first without edges, then with all edges. Asserts that
/// each picture is painted, differs from the picture before, and has the library's order. Returns the median
/// time of a picture in milliseconds, without and with edges.
pub fn turn(browser: &str, folder: &Path, page: &str, tree: &BspTree, pictures: u32) -> [f64; 2] {
    let script = format!(
        "[CANVAS.width, CANVAS.height] = [1280, 720];
        const picture = pictureOf(1280, 720);
        const eyes = [];
        let [painted, last] = [0, 0];
        const hash = numbers => {hash};
        const turned = count => {{
            const times = [];
            for (let i = 0; i < count; i++) {{
                camera.yaw = i * 2 * Math.PI / count;
                const begin = performance.now();
                const filled = paint(TREE, camera, picture, style, TREE.fragments);
                show(picture);
                times.push(performance.now() - begin);
                const now = hash(picture.pixels);
                painted += filled > 0.5 * TREE.fragments && now !== last;
                last = now;
                if (i % 5 === 0) eyes.push([...viewpointOf(TREE, camera).at, hash(TREE.order)]);
            }}
            times.sort((a, b) => a - b);
            return times[count >> 1];
        }};
        const plain = turned({pictures});
        style.edges = style.cuts = [0, 0, 0];
        return [plain, turned({pictures}), painted, eyes.map(eye => eye.join(' '))].join(',');",
        hash = hash_in_script("numbers"),
    );
    let said = said(browser, folder, page, &script);
    let mut parts = said.split(',');
    let mut number = || parts.next().and_then(|part| part.parse::<f64>().ok()).expect("a number");
    let (times, painted) = ([number(), number()], number());
    assert_eq!(painted, f64::from(2 * pictures));
    let (mut order, mut compared) = (Vec::new(), 0);
    for eye in parts {
        let numbers: Vec<f64> = eye.split(' ').map(|number| number.parse().unwrap()).collect();
        let [x, y, z, found] = numbers[..] else { panic!("{eye}") };
        let Some(viewpoint) = eye_at(tree, [x, y, z]) else { continue };
        tree.back_to_front_into(viewpoint, &mut order);
        assert_eq!(hash(&order), found as u32, "{eye}");
        compared += 1;
    }
    crate::enough!(compared > pictures / 5; "{compared}");
    times
}
