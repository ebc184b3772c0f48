//! `binspace render`: a picture of a scene.

use binspace::scene::Scene;
use binspace::verify::Verification;

use super::verify::unseen_faults;
use crate::Outcome;
use crate::args::RenderArgs;
use crate::backs::note_backs;
use crate::colours::Colours;
use crate::cull::Cull;
use crate::failure::Failure;
use crate::files::{Output, about_output};
use crate::job::{self, Made};
use crate::pictures::{Drawing, Kind};
use crate::terminal::note;
use crate::units::count;
use crate::upright::note_up;
use crate::{camera, cells, png_file};

/// Runs the command.
pub(crate) fn run(args: &RenderArgs) -> Result<Outcome, Failure> {
    let kind = Kind::asked(&args.kind);
    check(args, kind).map_err(|problem| about_output(&args.output, &problem))?;
    let output = Output::open_binary(&args.output, &args.scene, "a PNG")?;
    if let Some(path) = cells::folder::asked(&args.scene, &args.build)? {
        cells::draw::render(args, path, output)?;
        return Ok(Outcome::Done);
    }
    let Made { scene, tree, .. } = job::make(&args.scene, &args.build)?;
    note_up(&scene, &args.view.up);
    let camera = camera::asked(&args.view, &scene, None)?;
    let colours = Colours::new(&scene, args.look.colours);
    let (cull, samples) = (args.look.cull.cull, args.samples);
    if cull == Cull::None {
        note_backs(&scene, &tree, &camera);
    }
    let drawing = Drawing { tree: &tree, camera: &camera, colours: &colours, cull, samples };
    let drawn = drawing.draw(kind).map_err(|error| camera::about(&scene, &error));
    let (pixels, seen) = drawn?;
    output.write(|out| png_file::write(out, camera.size(), &pixels))?;
    Ok(seen.map_or(Outcome::Done, |seen| judge(&scene, &seen)))
}

/// Returns an error if there is no such picture.
fn check(args: &RenderArgs, kind: Kind) -> Result<(), String> {
    let extension = args.output.extension().map(|extension| extension.to_ascii_lowercase());
    let extension = extension.as_ref().map(|extension| extension.to_string_lossy());
    match extension.as_deref() {
        Some("svg" | "pdf" | "tex" | "dxf") => {
            return Err("`binspace render` writes only .png: use `binspace draw`".to_owned());
        }
        Some("png") | None => {}
        Some(_) => return Err("name a file that ends in .png".to_owned()),
    }
    let is_plain = matches!(kind, Kind::Painter | Kind::ZBuffer);
    if !is_plain && args.samples > 1 {
        let name = kind.name();
        return Err(format!("--{name} uses one sample per pixel: omit --samples"));
    }
    Ok(())
}

/// Reports the number of wrong pixels of a picture. Returns whether the picture differs.
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
