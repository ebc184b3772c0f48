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
        let run = folder.run(options);
        let said = run.err.contains("z pointed up");
        assert!(!said || run.err.contains("`--up z`"), "{}", run.err);
        run.good();
        said
    };
    let (render, verify) = ("-o p.png --size 16x12", "--views 1 --size 16x12");
    assert!(said(&format!("render z.obj {render}")));
    assert!(said("render z.obj -o p.svg"));
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
    let run = crate::run::Run::new(&folder.pipe(&format!("verify - {verify}"), block(false)));
    assert!(run.err.contains("standard input: it looks as if z pointed up"), "{}", run.err);
}

#[test]
fn a_drawing_of_nothing_is_noted() {
    let folder = Folder::new("notes_nothing");
    folder.write("block.obj", block(true));
    let says = |options: &str| {
        let run = folder.run(&format!("draw block.obj --size 16x12 {options}"));
        let says = run.err.contains("block.obj: the picture shows nothing of it");
        run.good();
        says
    };
    for output in ["p.svg", "p.pdf", "p.png", "p.svg --lines", "p.svg --translucent"] {
        assert!(!says(&format!("-o {output}")), "{output}");
        // Everything is behind the eye.
        assert!(says(&format!("--eye 0,9,0 --target 0,20,1 -o {output}")), "{output}");
    }
}
