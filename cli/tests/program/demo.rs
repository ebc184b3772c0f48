use crate::png_picture::Picture;
use crate::run::Folder;

#[test]
fn scenes_are_judged_and_drawn() {
    let folder = Folder::new("demo");
    let run = folder.run("demo --views 3 --size 120x90 -o pictures/new");
    assert_eq!(run.err, "");
    let out = run.good();
    assert!(out.contains("no pixel is wrong"), "{out}");
    assert!(out.lines().all(|line| line.chars().count() <= 80), "{out}");
    assert!(!out.contains('\u{1b}'), "colours are for terminals");
    for heuristic in ["first", "random(0)", "sampled(16)", "auto"] {
        assert!(out.lines().filter(|line| line.starts_with(heuristic)).count() >= 3, "{out}");
    }
    for scene in ["newell", "cornell", "teapot"] {
        assert!(out.contains(&format!("{scene}: ")), "{out}");
        let read =
            |kind: &str| Picture::read(&folder.path(&format!("pictures/new/{scene}-{kind}.png")));
        let painter = read("painter");
        assert_eq!(painter.size, [120, 90]);
        assert!(painter.colours() > 5, "{scene}");
        assert_eq!(painter, read("z-buffer"), "{scene}");
        assert_eq!(read("difference").count([255, 40, 40]), 0, "{scene}");
        assert!(read("depth").colours() > 5, "{scene}");
        let svg = std::fs::read_to_string(folder.path(&format!("pictures/new/{scene}.svg")));
        assert!(svg.unwrap().ends_with("</svg>\n"), "{scene}");
    }
}

#[test]
fn a_folder_that_cannot_be_made_is_said() {
    let folder = Folder::new("demo_folder");
    folder.write("file", "");
    assert!(folder.run("demo -o file/x").refused().contains("cannot be created"));
    assert!(folder.run("demo --views 0").refused().contains("--views"));
    assert_eq!(folder.files(), ["file"]);
}
