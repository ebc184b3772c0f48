//! The precision of depths, and pictures in which it is insufficient.

use binspace::BuildOptions;
use binspace::raster::{Faces, NONE, Rays, picture};
use binspace_evidence::fighting::{Fight, PLANES, Sheets};
use binspace_evidence::method::{Bsp, DepthFormat};

use super::chapter::{Chapter, Picture, failure, percent};
use super::curve::{Curve, Graph};
use crate::chart::{Chart, Marker, Series, Style};
use binspace_cli::failure::Failure;

use DepthFormat::{Float, FloatReversed, Integer, LinearInteger};

const SIZE: [u32; 2] = [240, 180];

pub(super) fn fill(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.text(
        "A depth buffer stores one number per pixel, with a limited number of bits. The choice of this \
         number decides which depths get most of the bits. Graphics libraries store z = f (w - n) / (w \
         (f - n)). Here w is the depth, and n and f are the depths of the near and the far plane. z is \
         linear on the picture, so it can be summed along scanlines. But z is not linear in depth. The \
         graphs below are for glFrustum(..., 1, 200).",
    );
    values(chapter)?;
    errors(chapter)?;
    fighting(chapter)
}

fn style(format: DepthFormat) -> [u8; 3] {
    match format {
        Integer(4 | 16) => [200, 60, 40],
        Integer(_) => [230, 150, 20],
        Float => [120, 80, 180],
        FloatReversed => [40, 130, 70],
        _ => [40, 90, 190],
    }
}

/// The stored number against the depth.
fn values(chapter: &mut Chapter) -> Result<(), Failure> {
    let [near, far] = PLANES;
    let depths = (0..=400).map(|i| near + (far - near) * (f64::from(i) / 400.0).powi(2));
    let curve = |format: DepthFormat, name: &str| Curve {
        name: name.into(),
        colour: style(format),
        points: depths.clone().map(|w| (w, format.store(PLANES, w).value)).collect(),
    };
    let curves = vec![
        curve(Integer(4), "z in 4 bits"),
        curve(Integer(24), "z in 24 bits"),
        curve(FloatReversed, "1 - z as f32"),
        curve(LinearInteger(16), "w in 16 bits"),
    ];
    let half = Integer(24).store(PLANES, 2.0 * near).value;
    chapter.heading("The stored number against the depth");
    chapter.svg(
        Graph {
            title: "Stored number against depth",
            x_label: "depth w",
            y_label: "stored number",
            x: [0.0, far],
            y: [0.0, 1.02],
            curves,
        }
        .draw()?,
    );
    chapter.text(format!(
        "These values are read from our own buffers. At twice the near plane, depth {}, z is already \
         {half:.3}: half of all numbers are spent on the first {} of the range. At depth 50, z is {:.3}. \
         A w-buffer spends its numbers evenly.",
        2.0 * near,
        percent(near, far - near),
        Integer(24).store(PLANES, 50.0).value,
    ));
    Ok(())
}

/// The error against the depth.
fn errors(chapter: &mut Chapter) -> Result<(), Failure> {
    let depths: Vec<f64> =
        (0..24).map(|i| 1.05 * (195f64 / 1.05).powf(f64::from(i) / 23.0)).collect();
    let formats = [Integer(16), Integer(24), Float, FloatReversed, LinearInteger(16)];
    let markers = [Marker::Circle, Marker::Square, Marker::Triangle, Marker::Diamond, Marker::Ring];
    let series = |(format, marker): (DepthFormat, Marker)| {
        let points = depths.iter().map(|&w| (w, format.largest_error(PLANES, w, 0.02)));
        Series::new(&format.to_string(), Style::new(style(format), marker, 4), points.collect())
    };
    chapter.heading("The error against the depth");
    chapter.graph(&Chart {
        title: "Largest error of a stored depth, against depth",
        x_label: "depth w",
        y_label: "error",
        ticks: None,
        falls: false,
        zero: false,
        series: formats.into_iter().zip(markers).map(series).collect(),
    })?;
    let at = 100.0;
    let row = |format: DepthFormat| {
        let found = format.largest_error(PLANES, at, 1e-3);
        let formula = 0.5 * format.step(PLANES, at * 1.001);
        [format.to_string(), format!("{found:.3e}"), format!("{formula:.3e}")]
    };
    chapter.table(
        ["stored", "largest error found at depth 100", "half a step by the formula"],
        formats.map(row),
    );
    chapter.text(
        "The error of z grows with the square of the depth: half a step is w² (f - n) / (2 f n) / (2^bits - \
         1). An f32 that holds z is no better than 24 bits, because most f32 numbers lie near 0, where z \
         does not need them. The earlier stages of the pipeline also round, so the error of the f32 exceeds \
         half a step. If 1 - z is stored, the uneven steps of z and of f32 almost cancel (Lapidous & Jiao \
         1999). The error of a w-buffer is the same at all depths. Relative to the depth, it is small far \
         away and large near the eye.",
    );
    Ok(())
}

/// Shows z-fighting of two sheets: the pictures of formats, the predictions, and the picture of the tree.
fn fighting(chapter: &mut Chapter) -> Result<(), Failure> {
    chapter.heading("Z-fighting");
    chapter.text(
        "Two sheets fill the picture and recede from depth 20 (bottom) to 190 (top). Along each \
         ray, the orange sheet is further away than the blue one, by a fixed share of the depth. So \
         no orange should be visible. But where a buffer stores the same number for both sheets, the \
         sheet that was drawn first, the orange sheet, stays visible. Orange shows only where the \
         distance of the sheets is less than one step of the buffer. Where the distance is s steps, \
         with s below 1, orange shows in a share 1 − s of the pixels. So both the depths at which \
         z-fighting occurs and the number of wrong pixels can be predicted.",
    );
    let (coarse, fine) = (Sheets::new(6e-4, SIZE), Sheets::new(2.4e-6, SIZE));
    let nearest = Sheets::new(5e-5, SIZE);
    let cases: [(&Sheets, &str, DepthFormat); 6] = [
        (&coarse, "6e-4", Integer(16)),
        (&coarse, "6e-4", Integer(24)),
        (&nearest, "5e-5", LinearInteger(16)),
        (&fine, "2.4e-6", Integer(24)),
        (&fine, "2.4e-6", Float),
        (&fine, "2.4e-6", FloatReversed),
    ];
    let (mut pictures, mut rows) = (Vec::new(), Vec::new());
    for (sheets, gap, format) in cases {
        let fight = sheets.in_format(format).map_err(failure)?;
        pictures.push(Picture::new(
            SIZE,
            colours(sheets, &fight)?,
            format!("{format}, apart by {gap}"),
        ));
        rows.push(row(sheets, gap, format, &fight)?);
    }
    let tree = Bsp::exact(BuildOptions::DEFAULT.with_tolerance(0.0));
    let fight = fine.shown_by(&tree).map_err(failure)?;
    pictures.push(Picture::new(SIZE, colours(&fine, &fight)?, "the tree, apart by 2.4e-6"));
    let none = || "-".to_owned();
    rows.push([
        "tree".into(),
        "2.4e-6".into(),
        none(),
        none(),
        none(),
        0.to_string(),
        fight.wrong.to_string(),
    ]);
    chapter.pictures(pictures);
    chapter.table(
        [
            "stored",
            "apart by",
            "predicted at depths",
            "predicted with rounding",
            "seen at depths",
            "predicted wrong pixels",
            "wrong pixels",
        ],
        rows,
    );
    chapter.text(
        "For z, the fight begins at depth g f n (2^bits - 1) / (f - n), where g is the share by which \
         the sheets are apart. The fight continues at all greater depths. In a w-buffer, the fight \
         ends at some depth instead. Integer formats fight at the depths that their steps predict. For \
         an f32, the computation before the number is stored rounds as much as the f32 itself, so the \
         fight begins earlier. The column \"predicted with rounding\" includes this rounding: it uses \
         the planes that the buffer computes, and bounds of the rounding in each pixel. For each \
         format, the tests check that no pixel is wrong at other depths. The tree compares no depths. \
         The tree decides once, exactly, on which side of one sheet the other sheet lies. So no pixel \
         is wrong, however small the distance.",
    );
    Ok(())
}

fn row(
    sheets: &Sheets,
    gap: &str,
    format: DepthFormat,
    fight: &Fight,
) -> Result<[String; 7], Failure> {
    let span = |ends: Option<[f64; 2]>| {
        ends.map_or("none".to_owned(), |[low, high]| format!("{low:.1} to {high:.1}"))
    };
    let predicted = sheets.predicted_with_roundings(format).map_err(failure)?;
    Ok([
        format.to_string(),
        gap.to_owned(),
        span(sheets.predicted(format).begin),
        span(predicted.begin),
        span(fight.seen),
        format!("{:.0}", predicted.wrong),
        fight.wrong.to_string(),
    ])
}

/// The picture of a fight: the further sheet orange, the nearer blue.
fn colours(sheets: &Sheets, fight: &Fight) -> Result<Vec<u8>, Failure> {
    let (faces, _) = Faces::new(sheets.polygons(), Some(0.0)).map_err(failure)?;
    let rays = Rays::new(sheets.camera(), &faces).map_err(failure)?;
    debug_assert!(!fight.image.faces().contains(&NONE));
    let colour = |polygon: usize| if polygon < 2 { [255, 150, 30] } else { [60, 100, 190] };
    Ok(picture(&rays, &faces, &fight.image, colour, [255; 3]))
}
