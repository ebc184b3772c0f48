//! `binspace render`: a picture of a scene.

use binspace::scene::Scene;
use binspace::verify::Verification;

use super::verify::unseen_faults;
use crate::Outcome;
use crate::args::{Format, RenderArgs};
use crate::backs::note_backs;
use crate::colours::Colours;
use crate::cull::Cull;
use crate::failure::Failure;
use crate::files::Output;
use crate::format::{about_output, format};
use crate::pictures::{Drawing, Kind};
use crate::progress::Progress;
use crate::terminal::note;
use crate::units::count;
use crate::upright::note_z_up;
use crate::{camera, cells, job, png_file, svg};

/// Runs the command.
pub(crate) fn run(args: &RenderArgs) -> Result<Outcome, Failure> {
    let (format, kind) = (format(&args.output, args.format)?, Kind::asked(&args.kind));
    check_kind(args, format, kind)?;
    let output = Output::open(Some(&args.output))?;
    if format == Format::Png && output.is_terminal() {
        let problem = "a PNG is not for a terminal: pipe it, or name a file";
        return Err(about_output(&args.output, problem));
    }
    if let Some(path) = cells::folder::asked(&args.scene, &args.build)? {
        cells::draw::render(args, path, output, format)?;
        return Ok(Outcome::Done);
    }
    let (scene, tree) = job::scene_and_tree(&args.scene, &args.build)?;
    note_z_up(&scene, &args.view.up);
    let camera = camera::asked(&args.view, &scene)?;
    let colours = Colours::new(&scene, args.colours);
    let (cull, samples) = (args.cull.cull, args.samples);
    if cull == Cull::None {
        note_backs(&scene, &tree, &camera);
    }
    let drawing = Drawing { tree: &tree, camera: &camera, colours: &colours, cull, samples };
    match format {
        Format::Svg => {
            let _progress = Progress::spinner("drawing");
            output.write(|out| svg::write(out, &drawing, &scene))?;
        }
        Format::Png => {
            let drawn = drawing.draw(kind).map_err(|error| camera::about(&scene, &error));
            let (pixels, seen) = drawn?;
            output.write(|out| png_file::write(out, camera.size(), &pixels))?;
            if let Some(seen) = seen {
                return Ok(judge(&scene, &seen));
            }
        }
    }
    Ok(Outcome::Done)
}

/// An error if there is no such picture.
fn check_kind(args: &RenderArgs, format: Format, kind: Kind) -> Result<(), Failure> {
    let is_plain = matches!(kind, Kind::Painter | Kind::ZBuffer);
    let problem = if format == Format::Svg && kind != Kind::Painter {
        format!("--{} cannot be drawn as SVG: write a PNG", kind.name())
    } else if format == Format::Svg && args.samples > 1 {
        "--samples is for PNG: an SVG has no pixels".to_owned()
    } else if !is_plain && args.samples > 1 {
        format!("--samples cannot be used with --{}: it has one value a pixel", kind.name())
    } else {
        return Ok(());
    };
    Err(about_output(&args.output, &problem))
}

/// Reports the number of wrong pixels of a picture, and whether it differs.
fn judge(scene: &Scene, seen: &Verification) -> Outcome {
    let found = &seen.comparison;
    note(&format!(
        "{}: {} covered, {} contested; {} wrong ({} wrong order, {}, {})",
        scene.name(),
        count(found.covered, "pixel"),
        found.contested,
        found.wrong(),
        found.wrong_order,
        count(found.holes, "hole"),
        count(found.spills, "spill"),
    ));
    unseen_faults(seen).iter().for_each(|fault| note(fault));
    if seen.is_right() { Outcome::Done } else { Outcome::Differs }
}

#[cfg(test)]
mod tests {
    use super::*;
    use binspace::verify::verify;

    #[test]
    fn a_difference_with_wrong_pixels_is_no_success() {
        let scene = binspace::scene::crossing(2);
        let tree = binspace::BspTree::build(scene.polygons()).unwrap();
        let view = &camera::around_and_inside(&scene, None, 1, [40, 30], 0).unwrap()[0];
        let right = verify(&tree, view).unwrap();
        assert_eq!(judge(&scene, &right), Outcome::Done);
        let faults: [fn(&mut Verification); 5] = [
            |seen| seen.comparison.wrong_order = 1,
            |seen| seen.comparison.holes = 1,
            |seen| seen.comparison.spills = 1,
            |seen| seen.front_to_back.wrong_order = 1,
            |seen| seen.miscounted = 1,
        ];
        for fault in faults {
            let mut wrong = right.clone();
            fault(&mut wrong);
            assert_eq!(judge(&scene, &wrong), Outcome::Differs);
        }
    }
}
