//! A page whose camera is turned.

use super::page_and_tree;
use crate::run::Folder;
use testkit::browser::{browser, turn};

#[test]
#[ignore = "needs Chromium"]
fn a_camera_that_turns_around_ten_thousand_fragments_shows_them_in_the_librarys_order() {
    let folder = Folder::new("page_turn");
    for scene in ["city:10000", "teapot:14", "random:910"] {
        let (page, tree) = page_and_tree(&folder, scene);
        assert!((9_000..12_000).contains(&tree.len()), "{scene}: {}", tree.len());
        turn(browser(), &folder.path(""), &page, &tree, 60);
    }
}
