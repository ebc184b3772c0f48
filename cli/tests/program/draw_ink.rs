//! Lines in pictures of pixels, against a viewer's lines; and hidden lines by the number of polygons in
//! front.

use crate::draw::views;
use crate::png_picture::Picture;
use crate::run::Folder;
use crate::svg_picture::Svg;

fn picture(folder: &Folder, command: &str) -> Picture {
    folder.run(&format!("draw {command} -o a.png")).good();
    Picture::read(&folder.path("a.png"))
}

#[test]
fn lines_in_pictures_are_those_that_viewers_show() {
    let folder = Folder::new("ink_svg");
    let (mut inked, mut sum, mut far) = (0, 0.0, 0);
    for view in views().into_iter().take(4) {
        for options in ["", "--hidden dashed", "--hidden layers"] {
            let command = format!("{} --lines --edges all {options}", view.arguments());
            let found = picture(&folder, &command);
            folder.run(&format!("draw {command} -o a.svg")).good();
            let expected = Svg::read(&folder.path("a.svg")).averaged(6);
            for (a, b) in found.rgb.iter().step_by(3).zip(&expected) {
                let difference = (f64::from(*a) - b).abs();
                if *a < 255 || *b < 255.0 {
                    inked += 1;
                    sum += difference;
                    far += usize::from(difference > 32.0);
                }
            }
        }
    }
    // Where lines of several kinds meet, viewers paint one over another.
    let mean = sum / inked as f64;
    assert!(inked > 20_000 && mean < 4.0 && far * 50 < inked, "{inked} {mean} {far}");
}

#[test]
fn lines_change_the_polygons_picture_only_where_they_are() {
    let folder = Folder::new("ink_over");
    let (mut same, mut darker) = (0, 0);
    for view in views().into_iter().take(4) {
        let plain = picture(&folder, &view.arguments());
        let over = picture(&folder, &format!("{} --edges all", view.arguments()));
        let alone = picture(&folder, &format!("{} --lines --edges all", view.arguments()));
        for i in 0..plain.rgb.len() {
            let ink = 1.0 - f64::from(alone.rgb[i]) / 255.0;
            let expected = f64::from(plain.rgb[i]) * (1.0 - ink);
            assert!((f64::from(over.rgb[i]) - expected).abs() < 1.1, "{i}");
            *if ink == 0.0 { &mut same } else { &mut darker } += 1;
        }
    }
    assert!(same > 50_000 && darker > 10_000, "{same} {darker}");
}

/// Five bars one behind another, as seen from above: each sticks out of the one before it.
#[test]
fn dashes_are_sparser_behind_more_polygons() {
    let folder = Folder::new("ink_layers");
    let mut text = String::new();
    for k in 0..6 {
        let (x, z) = (2 * k + 1, -k);
        text += &format!("v {} -1 {z}\nv {x} -1 {z}\nv {x} 1 {z}\nv {} 1 {z}\n", -x, -x);
    }
    (0..6).for_each(|k| {
        text += &format!("f {} {} {} {}\n", 4 * k + 1, 4 * k + 2, 4 * k + 3, 4 * k + 4)
    });
    folder.write("s.obj", text);
    let command = "draw s.obj --direction=0,-0.1,-1 --up y --lines --hidden layers -o a.svg";
    folder.run(command).good();
    let svg = Svg::read(&folder.path("a.svg"));
    let mut classes: Vec<&str> = svg.lines.iter().map(|line| &*line.classes[0]).collect();
    classes.dedup();
    assert_eq!(
        classes,
        ["hidden layers-4", "hidden layers-3", "hidden layers-2", "hidden", "visible"]
    );
    let dashes: Vec<&str> = svg.text.split("stroke-dasharray=\"").skip(1).collect();
    let dashes = dashes.iter().map(|rest| rest.split('"').next().unwrap());
    assert_eq!(dashes.collect::<Vec<_>>(), ["50 300", "50 150", "100 150", "150 100"]);
    folder.run(&command.replace("layers", "dashed")).good();
    let plain = Svg::read(&folder.path("a.svg"));
    assert!(plain.lines.iter().all(|line| ["hidden", "visible"].contains(&&*line.classes[0])));
}
