//! Several samples in each pixel.

use crate::png_picture::Picture;
use crate::run::{CROSSING, Folder};

fn linear(number: u8) -> f64 {
    let value = f64::from(number) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

fn number(light: f64) -> f64 {
    let value =
        if light <= 0.0031308 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
    255.0 * value
}

#[test]
fn a_pixel_has_the_mean_light_of_a_finer_picture() {
    let folder = Folder::new("samples_mean");
    folder.write("glass.mtl", "newmtl a\nKd 0.9 0.1 0.3\nd 0.5\n");
    folder.write("s.obj", CROSSING);
    folder.write("g.obj", format!("mtllib glass.mtl\nusemtl a\n{CROSSING}"));
    let views = [
        "s.obj --colours polygon --eye=3,2.5,6 --target=0.1,0,0",
        "s.obj --colours polygon --direction=-1,-1,-2 --z-buffer",
        "g.obj --eye=3,2.5,6 --target=0.1,0,0 --cull back",
    ];
    for view in views {
        for n in [2u32, 3, 7] {
            folder.run(&format!("render {view} --size 60x40 --samples {n} -o a.png")).good();
            let size = format!("{}x{}", 60 * n, 40 * n);
            folder.run(&format!("render {view} --size {size} -o b.png")).good();
            let [smooth, fine] = ["a.png", "b.png"].map(|name| Picture::read(&folder.path(name)));
            assert_eq!(smooth.size, [60, 40]);
            let (mut wrong, mut mixed) = (0, 0);
            for (i, &found) in smooth.rgb.iter().enumerate() {
                let (x, y, channel) = (i as u32 / 3 % 60, i as u32 / 180, i as u32 % 3);
                let samples = (0..n * n).map(|k| {
                    let (x, y) = (x * n + k % n, y * n + k / n);
                    fine.rgb[(3 * (y * 60 * n + x) + channel) as usize]
                });
                let mean = samples.clone().map(linear).sum::<f64>() / f64::from(n * n);
                wrong += usize::from((number(mean) - f64::from(found)).abs() > 0.51);
                mixed += usize::from(samples.clone().max() != samples.min());
            }
            // The two cameras differ in their last bits, so single samples may.
            assert!(wrong < 10 && mixed > 100, "{view} {n}: {wrong} wrong, {mixed} mixed");
        }
    }
}

#[test]
fn samples_are_the_same_every_time_and_more_than_one_only_smooths() {
    let folder = Folder::new("samples_same");
    folder.write("s.obj", CROSSING);
    let picture = |options: &str| {
        folder.run(&format!("render s.obj --size 60x40 -o p.png {options}")).good();
        Picture::read(&folder.path("p.png"))
    };
    assert_eq!(picture("--samples 4"), picture("--samples 4"));
    assert_eq!(picture("--samples 1"), picture(""));
    assert_eq!(picture("--samples 4"), picture("--samples 4 --z-buffer"));
    assert!(picture("--samples 4").colours() > picture("").colours());
}

/// Large enough to be drawn in several parts, which the depths are not.
#[test]
fn parts_of_a_large_picture_fit_together() {
    let folder = Folder::new("samples_parts");
    folder.write("s.obj", CROSSING);
    let picture = |options: &str| {
        let command = format!("render s.obj --size 3100x3000 --eye=3,2.5,6 -o p.png {options}");
        folder.run(&command).good();
        Picture::read(&folder.path("p.png")).rgb
    };
    let [painted, depths] = [picture(""), picture("--depth")];
    let mut shown = 0;
    for (p, d) in painted.chunks_exact(3).zip(depths.chunks_exact(3)) {
        let is_empty = p == [255; 3];
        assert_eq!(is_empty, d == [0; 3]);
        shown += usize::from(!is_empty);
    }
    assert!(shown > 1_000_000, "{shown}");
}
