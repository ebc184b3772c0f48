//! The content of pages.

use std::fs;

use crate::run::{CROSSING, Folder};

#[test]
fn a_page_stands_alone_and_names_its_scene() {
    let folder = Folder::new("page_alone");
    let name = "a<!--&{{data}}.obj";
    folder.write(name, CROSSING);
    let mut command = folder.command("page -o s.html");
    assert!(command.arg(name).status().unwrap().success());
    let page = fs::read_to_string(folder.path("s.html")).unwrap();
    assert_eq!(page.matches("a&lt;!--&amp;{{data}}.obj").count(), 2, "{page}");
    for outside in ["http:", "https:", "src=", "url(", "import(", "fetch(", "<link"] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert_eq!(page.matches("</script>").count(), 2);
    assert_eq!(page.matches("<!--").count(), 0);
    let culled = folder.run("page teapot:2 -o - --cull back --up y").good();
    assert!(culled.contains("id=\"culling\" type=\"checkbox\" autocomplete=\"off\" checked>"));
    assert!(!page.contains(" checked>"));
    let empty = "v 0 0 0\nf 1 1 1\n";
    folder.write("empty.obj", empty);
    folder.run("page empty.obj -o s.html").refused();
    assert_eq!(fs::read_to_string(folder.path("s.html")).unwrap(), page);
}
