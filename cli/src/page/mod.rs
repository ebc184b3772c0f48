//! A self-contained page: a tree with the scripts that order and paint its fragments, for people to turn.
//!
//! The script decides like the library, on the same grid: a plane goes through three grid points, and an eye
//! is rounded to the grid. Floats decide the eye's side of most planes, with an error bound; integers decide
//! the rest. So script and library have the same order for the same eye, wherever the eye is.

mod arrays;
mod data;
mod packed;

use std::io::{self, Write};
use std::path::Path;

use binspace::BspTree;
use binspace::glam::DVec3;
use binspace::scene::Scene;
use binspace::view::Camera;

use data::Data;

const TEMPLATE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
const SCRIPTS: [&str; 6] = [
    include_str!("inflate.js"),
    include_str!("tree.js"),
    include_str!("picture.js"),
    include_str!("graphics.js"),
    include_str!("colours.js"),
    include_str!("controls.js"),
];

/// The displayed data of a scene.
#[derive(Debug)]
pub(crate) struct Page<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) tree: &'a BspTree,
    /// The view with which the page begins.
    pub(crate) camera: &'a Camera,
    pub(crate) up: DVec3,
    pub(crate) culls_backs: bool,
    /// Names and values of the figures.
    pub(crate) figures: Vec<(String, String)>,
}

/// Writes a page.
pub(crate) fn write(out: &mut dyn Write, page: Page<'_>) -> io::Result<()> {
    let Page { scene, tree, camera, up, culls_backs, figures } = page;
    let data = Data::new(scene, tree, camera, up, figures);
    // `<` occurs only in texts, where this replaces it; so no text can end the data.
    let data = serde_json::to_string(&data)?.replace('<', "\\u003c");
    for (i, part) in TEMPLATE.split("{{").enumerate() {
        let (name, text) =
            if i == 0 { ("", part) } else { part.split_once("}}").unwrap_or_default() };
        match name {
            "title" => out.write_all(escaped(&title(scene)).as_bytes())?,
            "style" => out.write_all(STYLE.as_bytes())?,
            "culling" if culls_backs => out.write_all(b" checked")?,
            "data" => out.write_all(data.as_bytes())?,
            "script" => SCRIPTS.iter().try_for_each(|script| out.write_all(script.as_bytes()))?,
            _ => {}
        }
        out.write_all(text.as_bytes())?;
    }
    Ok(())
}

/// The scene's name, without the folders of a file, which are of no interest elsewhere.
fn title(scene: &Scene) -> String {
    let name = Path::new(scene.name()).file_name();
    name.map_or(scene.name().into(), |name| name.to_string_lossy().into_owned())
}

/// A text in HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_ends_the_script_or_the_style_before_its_end() {
        for text in SCRIPTS.into_iter().chain([STYLE]) {
            assert!(
                !text.contains("</") && !text.contains("<!--") && !text.contains("{{"),
                "{text}"
            );
        }
        let names = TEMPLATE.split("{{").skip(1).map(|part| part.split_once("}}").unwrap().0);
        assert!(names.eq(["title", "style", "title", "culling", "data", "script"]));
    }
}
