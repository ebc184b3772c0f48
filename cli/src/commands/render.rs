//! `binspace render`: a picture of a scene.

use std::path::Path;

use binspace::scene::Scene;
use binspace::{Verification, verify};

use super::Outcome;
use super::verify::unseen_faults;
use crate::args::RenderArgs;
use crate::colours::Colours;
use crate::failure::Failure;
use crate::files::NewFile;
use crate::pictures::Kind;
use crate::progress::Progress;
use crate::terminal::note;
use crate::units::count;
use crate::{camera, job, png_file, svg};

/// The format of an output file, by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Png,
    Svg,
}

/// Runs the command.
pub(crate) fn run(args: &RenderArgs) -> Result<Outcome, Failure> {
    let (format, kind) = (format(&args.output)?, Kind::asked(&args.kind));
    if format == Format::Svg && kind != Kind::Painter {
        let problem = format!("--{} cannot be drawn as SVG: name a .png file", kind.name());
        return Err(Failure::about(args.output.display(), problem));
    }
    let file = NewFile::create(&args.output)?;
    let (scene, tree) = job::scene_and_tree(&args.scene, &args.build)?;
    let camera = camera::asked(args, &scene)?;
    let colours = Colours::new(&scene, args.colours);
    let progress = Progress::spinner("drawing");
    match format {
        Format::Svg => file.write(|out| svg::write(out, &tree, &camera, &scene, &colours))?,
        Format::Png => {
            let seen = verify(&tree, &camera).map_err(|error| camera::about(&scene, &error))?;
            let pixels = kind.pixels(&tree, camera.viewpoint(), &seen, &colours);
            file.write(|out| png_file::write(out, camera.size(), &pixels))?;
            drop(progress);
            if kind == Kind::Difference {
                return Ok(judge(&scene, &seen));
            }
        }
    }
    Ok(Outcome::Done)
}

/// Says how many pixels of a picture are wrong, and whether it differs.
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

fn format(path: &Path) -> Result<Format, Failure> {
    let extension = path.extension().map(|ext| ext.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("png") => Ok(Format::Png),
        Some("svg") => Ok(Format::Svg),
        _ => Err(Failure::about(path.display(), "name a file that ends in .png or .svg")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
