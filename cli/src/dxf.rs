//! Lines as DXF of release 12, which every CAD program reads: a layer for each kind of edges, visible and
//! hidden. Units are pixels or, to scale, millimetres of paper; y points up.

use std::fmt::{self, Write};

use crate::drawn::dashes;
use crate::strokes::Strokes;

/// Lines of a picture of a size, as a file.
pub(crate) fn written(size: [u32; 2], all: &[Strokes]) -> Vec<u8> {
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = write(&mut text, size, all);
    text.into_bytes()
}

fn write(out: &mut String, [width, height]: [u32; 2], all: &[Strokes]) -> fmt::Result {
    write!(out, "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n")?;
    write!(out, "9\n$EXTMIN\n10\n0.0\n20\n0.0\n30\n0.0\n")?;
    write!(out, "9\n$EXTMAX\n10\n{width}.0\n20\n{height}.0\n30\n0.0\n0\nENDSEC\n")?;
    write_tables(out, all)?;
    write!(out, "0\nSECTION\n2\nENTITIES\n")?;
    for strokes in all {
        let layer = layer(strokes);
        for line in &strokes.lines {
            let upwards =
                |&[x, y]: &[f64; 2]| [x, f64::from(height) - y].map(|c| format!("{c:.6}"));
            let mut points: Vec<[String; 2]> = line.points.iter().map(upwards).collect();
            // The ends of a closed line may differ by rounding.
            let is_closed = points.len() > 3 && points.first() == points.last();
            points.truncate(points.len() - usize::from(is_closed));
            write!(out, "0\nPOLYLINE\n8\n{layer}\n66\n1\n10\n0.0\n20\n0.0\n30\n0.0\n")?;
            write!(out, "70\n{}\n", u8::from(is_closed))?;
            for [x, y] in points {
                write!(out, "0\nVERTEX\n8\n{layer}\n10\n{x}\n20\n{y}\n30\n0.0\n")?;
            }
            write!(out, "0\nSEQEND\n8\n{layer}\n")?;
        }
    }
    write!(out, "0\nENDSEC\n0\nEOF\n")
}

/// The types of lines, and the layers.
fn write_tables(out: &mut String, all: &[Strokes]) -> fmt::Result {
    let mut depths: Vec<u32> =
        all.iter().map(|strokes| strokes.depth).filter(|&depth| depth > 0).collect();
    // Strokes are sorted by depth.
    depths.dedup();
    write!(out, "0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLTYPE\n70\n{}\n", depths.len() + 1)?;
    write!(out, "0\nLTYPE\n2\nCONTINUOUS\n70\n0\n3\nSolid\n72\n65\n73\n0\n40\n0.0\n")?;
    for depth in depths {
        let [dash, gap] = dashes(depth, 1.0);
        write!(out, "0\nLTYPE\n2\n{}\n70\n0\n3\nHidden\n72\n65\n73\n2\n", line_type(depth))?;
        write!(out, "40\n{:.1}\n49\n{dash:.1}\n49\n-{gap:.1}\n", dash + gap)?;
    }
    write!(out, "0\nENDTAB\n0\nTABLE\n2\nLAYER\n70\n{}\n", all.len() + 1)?;
    // Layer 0 is in every file. Colour 7 is black on white, and white on black.
    write!(out, "0\nLAYER\n2\n0\n70\n0\n62\n7\n6\nCONTINUOUS\n")?;
    for strokes in all {
        let (layer, line_type) = (layer(strokes), line_type(strokes.depth));
        write!(out, "0\nLAYER\n2\n{layer}\n70\n0\n62\n7\n6\n{line_type}\n")?;
    }
    write!(out, "0\nENDTAB\n0\nENDSEC\n")
}

/// The name of a layer, such as `CREASE`, `HIDDEN_CREASE` or, behind three polygons, `HIDDEN3_CREASE`.
fn layer(strokes: &Strokes) -> String {
    let class = strokes.class.to_ascii_uppercase();
    match strokes.depth {
        0 => class,
        depth => format!("{}_{class}", line_type(depth)),
    }
}

fn line_type(depth: u32) -> String {
    match depth {
        0 => "CONTINUOUS".to_owned(),
        1 => "HIDDEN".to_owned(),
        _ => format!("HIDDEN{depth}"),
    }
}
