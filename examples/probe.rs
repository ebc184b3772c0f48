use binspace::geom::Faces;
use binspace::measure::*;
use binspace::method::*;
use binspace::raster::*;
use binspace::scene::Family;
use std::time::Instant;
fn main() {
    let quick = std::env::args().nth(1).as_deref() == Some("quick");
    let only = std::env::args().nth(2);
    let size = if quick { [160, 120] } else { [320, 240] };
    let methods = all(&Options::DEFAULT);
    for family in Family::ALL {
        if only.as_ref().is_some_and(|o| *o != family.name()) {
            continue;
        }
        for &d in family.sweep(quick) {
            let scene = family.scene(d, 1);
            let (faces, _) = Faces::new(scene.polygons(), Some(0.0)).unwrap();
            let cams = family.cameras(d, 1, size).unwrap();
            let views: Vec<_> = cams
                .iter()
                .map(|c| {
                    let r = Rays::new(c, &faces).unwrap_or_else(|e| panic!("{family} {d}: {e}"));
                    let t = zbuffer(&r, &faces).into_image();
                    (c, r, t)
                })
                .collect();
            println!(
                "{family} {d:e}: faces {} covered {:?}",
                faces.len(),
                views.iter().map(|v| v.2.covered()).collect::<Vec<_>>()
            );
            for m in &methods {
                let t0 = Instant::now();
                let mut p = match m.prepare(&faces) {
                    Ok(p) => p,
                    Err(e) => {
                        println!("   {:20} {e} {:?}", m.name(), t0.elapsed());
                        continue;
                    }
                };
                let build = t0.elapsed();
                let mut e = PictureError::default();
                let mut pieces = 0;
                let t1 = Instant::now();
                let mut bad = None;
                for (c, r, t) in &views {
                    match p.paint(c, r) {
                        Ok(i) => {
                            pieces = pieces.max(i.pieces);
                            e += PictureError::of(r, &faces, &i.image, t);
                        }
                        Err(x) => {
                            bad = Some(x);
                            break;
                        }
                    }
                }
                let paint = t1.elapsed();
                let t2 = Instant::now();
                let a = p.accuracy();
                let area = area_error(&faces, |v| p.for_each_piece(v));
                println!(
                    "   {:20} wrong {:6} h {:4} s {:4} ct {:5} depth {:8.1e} pieces {pieces:6} build {:8.2?} paint {:8.2?} acc {:7.1?} mis {:?} drift {:?} undef {:?} area {:.1?} {}",
                    m.name(),
                    e.wrong(),
                    e.holes,
                    e.spills,
                    e.contested,
                    e.depth_max,
                    build,
                    paint,
                    t2.elapsed(),
                    a.map(|a| a.misplaced),
                    a.map(|a| (a.drift_max * 100.0).round() / 100.0),
                    a.map(|a| a.undefined),
                    area.map(|a| format!("{:.0e}", a.worst)),
                    bad.map(|b| b.to_string()).unwrap_or_default()
                );
            }
        }
    }
}
