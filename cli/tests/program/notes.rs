//! The note on which way is up.

use crate::run::Folder;

/// A block of 2 by 2 by 3 that stands on z = 0, or on y = 0 if its corners are turned.
fn block(turned: bool) -> String {
    let mut text = String::new();
    for z in [0, 3] {
        for (x, y) in [(-1, -1), (1, -1), (1, 1), (-1, 1)] {
            let [a, b, c] = if turned { [x, z, -y] } else { [x, y, z] };
            text += &format!("v {a} {b} {c}\n");
        }
    }
    text + "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
}

#[test]
fn a_file_that_looks_z_up_is_noted_where_up_matters() {
    let folder = Folder::new("notes_up");
    folder.write("z.obj", block(false));
    folder.write("y.obj", block(true));
    folder.write("hangs.obj", block(false).replace(" 0\n", " 1\n"));
    let said = |options: &str| {
        let run = folder.run(&format!("{options} --notes"));
        let said = run.err.contains("z points up, because it stands on z = 0; `--up y`");
        run.good();
        said
    };
    let (render, verify) = ("-o p.png --size 16x12", "--views 1 --size 16x12");
    assert!(said(&format!("render z.obj {render}")));
    // The picture is that with z up.
    let picture = |options: &str| {
        folder.run(&format!("render z.obj {render} {options}")).good();
        std::fs::read(folder.path("p.png")).unwrap()
    };
    assert_eq!(picture(""), picture("--up z"));
    assert_ne!(picture(""), picture("--up y"));
    assert!(said("draw z.obj -o p.svg"));
    assert!(said(&format!("verify z.obj {verify}")));
    for options in [
        format!("render z.obj {render} --up z"),
        format!("render z.obj {render} --up y"),
        format!("verify z.obj {verify} --up z"),
        format!("render y.obj {render}"),
        format!("verify y.obj {verify}"),
        format!("render hangs.obj {render}"),
        // Built-in scenes have a known up direction; orders and figures need none.
        format!("render teapot:2 {render}"),
        "order z.obj --eye=9,9,9".to_owned(),
        "stats z.obj".to_owned(),
    ] {
        assert!(!said(&options), "{options}");
    }
    let run =
        crate::run::Run::new(&folder.pipe(&format!("verify - {verify} --notes"), block(false)));
    assert!(run.err.contains("standard input: z points up"), "{}", run.err);
}

#[test]
fn a_drawing_of_nothing_is_noted() {
    let folder = Folder::new("notes_nothing");
    folder.write("block.obj", block(true));
    let says = |options: &str| {
        let run = folder.run(&format!("draw block.obj --size 16x12 {options} --notes"));
        let says = run.err.contains("block.obj: no polygon is visible in the picture");
        run.good();
        says
    };
    for output in ["p.svg", "p.pdf", "p.png", "p.svg --lines", "p.svg --translucent"] {
        assert!(!says(&format!("-o {output}")), "{output}");
        // Everything is behind the eye.
        assert!(says(&format!("--eye 0,9,0 --target 0,20,1 -o {output}")), "{output}");
    }
}

#[test]
fn the_notes_on_a_scene_are_one_line_unless_all_or_none_are_asked_for() {
    let folder = Folder::new("notes_line");
    folder.write("s.obj", block(false) + "f 1 1 2\nf 1 2 7 4\n");
    let notes = |options: &str| {
        let run = folder.run(&format!("render s.obj -o a.png {options}"));
        let notes = run.err.clone();
        run.good();
        notes
    };
    assert_eq!(notes("--quiet"), "");
    let brief = notes("");
    assert_eq!(brief.lines().count(), 1, "{brief}");
    for part in
        ["note: s.obj: tolerance ", " (rounded input); ", "; 1 face triangulated; 1 dropped; "]
    {
        assert!(brief.contains(part), "{brief}");
    }
    assert!(brief.contains("z points up") && brief.ends_with("; --notes for each\n"), "{brief}");
    let each = notes("--notes");
    assert_eq!(each.lines().count(), 4, "{each}");
    assert!(each.lines().all(|line| line.starts_with("note: s.obj: ")), "{each}");
    // Errors are printed all the same.
    assert!(folder.run("stats missing.obj --quiet").refused().contains("missing.obj"));
}
