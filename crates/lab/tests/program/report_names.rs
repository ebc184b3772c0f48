//! Names of scenes that mean something in Markdown.

use std::fs;

use crate::run::{CROSSING, Folder};

/// Files may have any name. In a report, each name is text, and makes no column, heading, emphasis, link or
/// tag.
#[test]
fn names_of_scenes_are_text_in_a_report() {
    let folder = Folder::new("report_names");
    let names =
        ["a|b.obj", "*c*_d_.obj", "<i>e&amp;.obj", "[f](g).obj", "h\n## i.obj", "`j`\\.obj"];
    let mut command = folder.command("report --quick --family cycle --size 8x6 -o out");
    for name in names {
        folder.write(name, CROSSING);
        command.arg(name);
    }
    let run = crate::run::Run::new(&command.output().unwrap());
    run.good();
    let report = fs::read_to_string(folder.path("out/report.md")).unwrap();
    let escaped = [
        r"a\|b.obj",
        r"\*c\*\_d\_.obj",
        r"\<i\>e\&amp;.obj",
        r"\[f\](g).obj",
        r"h \#\# i.obj",
        r"\`j\`\\.obj",
    ];
    for name in escaped {
        assert!(report.lines().any(|line| line == format!("## {name}")), "{name}: {report}");
    }
    assert!(!report.lines().any(|line| line.starts_with("## i.obj")), "{report}");
}

/// A scene that cannot be measured is named too.
#[test]
fn names_of_scenes_that_failed_are_text_in_a_report() {
    let folder = Folder::new("report_failed_names");
    folder.write("a*b*.obj", "v -1e308 -1e308 0\nv 1e308 0 0\nv 0 1e308 1e308\nf 1 2 3\n");
    let run = folder.run("report --quick --family cycle --size 8x6 -o out a*b*.obj");
    assert!(run.err.contains("a*b*.obj") && run.status != Some(0), "{run:?}");
    let report = fs::read_to_string(folder.path("out/report.md")).unwrap();
    assert!(report.contains(r"**a\*b\*.obj could not be measured.**"), "{report}");
}
