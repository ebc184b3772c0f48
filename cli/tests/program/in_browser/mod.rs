//! Pages in a headless browser. These tests are ignored, as they need Chromium: `cargo test in_browser --
//! --ignored` runs them.

mod deeds;
mod inflated;
mod orders;
mod pictures;
mod turn;

use std::fs;

use binspace::BspTree;

use crate::run::Folder;

/// What the script calls to paint: nothing, so that it paints by itself, and WebGL, be it slow.
const PAINTERS: [&str; 2] = ["null", "graphicsOf(TREE, false)"];

/// A function of the script that paints with the camera, and returns the pixels.
const PAINTED: &str = "
    const painted = (width, height, style) => {
        const picture = pictureOf(width, height);
        if (!graphics) {
            paint(TREE, camera, picture, style, TREE.fragments);
            return picture.pixels;
        }
        graphics.paint(camera, picture, style, TREE.fragments);
        const context = new OffscreenCanvas(width, height).getContext('2d');
        context.drawImage(graphics.canvas, 0, 0);
        return new Uint32Array(context.getImageData(0, 0, width, height).data.buffer);
    };";

/// A page, and its tree.
pub(crate) fn page_and_tree(folder: &Folder, scene: &str) -> (String, BspTree) {
    folder.run(&format!("build {scene} -o s.bsp")).good();
    folder.run("page s.bsp -o s.html").good();
    let tree = BspTree::read(fs::File::open(folder.path("s.bsp")).unwrap()).unwrap();
    (fs::read_to_string(folder.path("s.html")).unwrap(), tree)
}
