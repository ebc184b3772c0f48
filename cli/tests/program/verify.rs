use crate::run::{CROSSING, Folder};

/// The figures of a line, between the place and the verdict.
fn figures(line: &str) -> Vec<usize> {
    line.split_whitespace().filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn a_line_a_view_and_the_totals() {
    let folder = Folder::new("verify_lines");
    folder.write("s.obj", CROSSING);
    let out = folder.run("verify s.obj --views 5 --size 80x60").good();
    let lines: Vec<&str> = out.lines().collect();
    assert_eq!(lines.len(), 2 + 5 + 1, "{out}");
    for title in ["covered", "contested", "wrong order", "holes", "spills"] {
        assert!(lines[1].contains(title), "{out}");
    }
    let views: Vec<Vec<usize>> = lines[2..7].iter().map(|line| figures(line)).collect();
    assert!(views.iter().enumerate().all(|(i, view)| view[0] == i + 1), "{out}");
    let sum = |column: usize| views.iter().map(|view| view[column]).sum::<usize>();
    assert!(sum(1) > 0 && lines[7].starts_with("total") && lines[7].ends_with("right"), "{out}");
    assert_eq!(figures(lines[7]), [sum(1), sum(2), 0, 0, 0], "{out}");
    assert!(lines.iter().any(|line| line.contains("inside")), "{out}");
    assert!(lines.iter().any(|line| line.contains("around")), "{out}");
}

#[test]
fn every_heuristic_paints_every_built_in_scene_right() {
    let folder = Folder::new("verify_scenes");
    for scene in ["newell", "cornell", "teapot:3", "crossing:6", "terrain:200", "sphere:200"] {
        for heuristic in ["auto", "first", "balanced"] {
            let size = "--views 4 --size 90x70";
            folder.run(&format!("verify {scene} {size} --heuristic {heuristic}")).good();
        }
    }
    for scene in ["city:200", "random:60", "chain:30", "layers"] {
        folder.run(&format!("verify {scene} --views 4 --size 90x70 --tolerance 0")).good();
    }
}

#[test]
fn the_same_seed_gives_the_same_views() {
    let folder = Folder::new("verify_seed");
    let verify = |seed| folder.run(&format!("verify cornell --size 60x40 --seed {seed}")).good();
    assert_eq!(verify(3), verify(3));
    assert_ne!(verify(3), verify(4));
}

#[test]
fn what_the_tolerance_makes_equals_is_contested_not_wrong() {
    let folder = Folder::new("verify_contested");
    let contested = |tolerance: &str| {
        let command = format!("verify layers --size 120x90 --tolerance {tolerance}");
        let out = folder.run(&command).good();
        figures(out.lines().last().unwrap())[1]
    };
    assert_eq!(contested("0"), 0);
    assert!(contested("0.0021") > 0);
}

#[test]
fn a_scene_without_area_is_not_called_right() {
    let folder = Folder::new("verify_empty");
    folder.write("s.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    for command in ["verify s.obj", "order s.obj --eye=0,0,1", "render s.obj -o s.png"] {
        let message = folder.run(&format!("{command} --notes")).refused();
        assert!(message.contains("s.obj: nothing to draw"), "{message}");
        assert!(message.contains("1 face without area dropped: face 0 (line 4)"), "{message}");
    }
    assert_eq!(folder.files(), ["s.obj"]);
    // Everything that can be counted is counted.
    let run = folder.run("stats s.obj --json --notes");
    assert!(run.err.contains("1 face without area dropped: face 0 (line 4)"), "{run:?}");
    assert!(run.err.contains("s.obj: nothing to draw"), "{run:?}");
    assert!(run.good().contains("\"dropped\":1"));
}
