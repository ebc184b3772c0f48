//! The first step of most commands: loads a scene and builds its tree.

use std::fmt::Display;
use std::time::Instant;

use binspace::internals::Faces;
use binspace::scene::Scene;
use binspace::{BspTree, Error, Heuristic, Preparation};

use crate::args::{BuildArgs, IsGiven, LimitArgs, SceneArgs};
use crate::failure::Failure;
use crate::measure;
use crate::scene_arg::{self, Loaded};
use crate::terminal::remark;
use crate::units::count;

/// The largest number of faces that a note names.
const NAMED: usize = 3;
/// The message for a scene of which no face is left.
pub const NOTHING_LEFT: &str = "nothing to draw: no face has an area";

/// A scene and its tree.
pub(crate) struct Made {
    pub(crate) scene: Scene,
    pub(crate) tree: BspTree,
    /// The time to build the tree, or to read its file.
    pub(crate) seconds: f64,
    /// The heuristic of the build; `None` if the tree was read.
    pub(crate) heuristic: Option<Heuristic>,
    /// The scene's name in a file of `binspace build`.
    pub(crate) stored_name: String,
}

/// Loads a scene and builds its tree, which has at least one fragment. Notes to the user name everything that
/// was left out.
pub(crate) fn make(scene: &SceneArgs, build: &BuildArgs) -> Result<Made, Failure> {
    let mut begin = Instant::now();
    let Loaded { scene, tree, stored_name } = scene_arg::load(&scene.name, scene.seed)?;
    let heuristic = build.heuristic;
    let options = build.limits.options(heuristic);
    let is_built = tree.is_none();
    let tree = match tree {
        Some(tree) => {
            refuse_options(scene.name(), build.is_given)?;
            tree
        }
        None => {
            begin = Instant::now();
            measure::build(&scene, &options).map_err(|error| about(&scene, &error))?
        }
    };
    let seconds = begin.elapsed().as_secs_f64();
    if is_built {
        note_tolerance(&scene, &build.limits, &tree);
    }
    note_preparation(&scene, tree.faces(), tree.preparation());
    if tree.is_empty() {
        return Err(Failure::about(scene.name(), NOTHING_LEFT));
    }
    Ok(Made { scene, tree, seconds, heuristic: is_built.then_some(heuristic), stored_name })
}

/// Returns an error if build options are given for a tree in a file, even with default values.
pub(crate) fn refuse_options(
    name: impl Display,
    IsGiven(is_given): IsGiven,
) -> Result<(), Failure> {
    if !is_given {
        return Ok(());
    }
    let problem = "it contains a finished tree: omit --heuristic, --tolerance and --max-fragments, \
                   or name the scene from which it was built";
    Err(Failure::about(name, problem))
}

/// A failure to build a scene's tree. The message names the program's options, not the library's.
pub fn about(scene: &Scene, error: &Error) -> Failure {
    let problem = error.to_string().replace("`max_fragments`", "`--max-fragments`");
    let problem = problem.replace("`VisibilityMap::drawing`", "`--seams trap`");
    Failure::about(scene.name(), problem)
}

/// Notes which faces were dropped, triangulated, or given more than once.
pub fn note_preparation(scene: &Scene, prepared: &Faces, found: &Preparation) {
    note_found(scene, prepared.dropped(found.polygons), found);
    let duplicates = prepared.duplicates();
    if duplicates > 0 {
        let faces = count(duplicates, "duplicate face");
        remark(scene.name(), &faces, format!("{faces}: the last copy is visible"));
    }
}

/// Notes the dropped and triangulated faces; `dropped` are the numbers of the dropped faces.
pub(crate) fn note_found(scene: &Scene, dropped: impl Iterator<Item = usize>, found: &Preparation) {
    if found.triangulated > 0 {
        let faces = count(found.triangulated, "face");
        let full = format!("{faces} triangulated: not convex or not planar");
        remark(scene.name(), format!("{faces} triangulated"), full);
    }
    if found.crossing > 0 {
        let brief = count(found.crossing, "self-intersecting face");
        let full = format!("{brief}: the filled area is unspecified");
        remark(scene.name(), brief, full);
    }
    if found.dropped > 0 {
        let faces = count(found.dropped, "face");
        let full = format!("{faces} without area dropped: {}", some(scene, dropped, found));
        remark(scene.name(), format!("{} dropped", found.dropped), full);
    }
}

/// Notes that the tolerance is too small for the faces; otherwise the tolerance, if the file's decimals make
/// it larger than the usual 1e-9 of the extent.
pub(crate) fn note_tolerance(scene: &Scene, limits: &LimitArgs, tree: &BspTree) {
    let quads = scene.polygons().filter(|polygon| polygon.points().len() > 3).count();
    let tolerance = tree.faces().lattice().length_to_world(tree.faces().tolerance());
    note_length(scene, limits, tolerance, tree.preparation(), quads);
}

/// Like [`note_tolerance`], for the given tolerance, and faces of which `quads` have four corners or more.
pub(crate) fn note_length(
    scene: &Scene,
    limits: &LimitArgs,
    tolerance: f64,
    found: &Preparation,
    quads: usize,
) {
    let taken = short(tolerance);
    if 2 * found.bent > quads {
        let advice = format!("--tolerance {}", short(raised(found.bent_by)));
        let full = format!(
            "{} of {} with four or more corners are non-planar by at most {}, probably because \
             coordinates are rounded: `{advice}` keeps these faces whole (now {taken})",
            found.bent,
            count(quads, "face"),
            short(found.bent_by),
        );
        let brief =
            format!("tolerance {taken} (`{advice}` keeps {} whole)", count(found.bent, "face"));
        remark(scene.name(), brief, full);
    } else if tolerance < 1.001 * scene.precision() && limits.tolerance.is_none() {
        let is_bound = tolerance < 0.999 * scene.precision();
        let bound = if is_bound { ", the largest default (1e-5 of the extent)" } else { "" };
        let full = format!(
            "coordinates are precise to {}, so the tolerance is {taken}{bound}; `--tolerance` \
             overrides it",
            // The precision is four units in the last decimal.
            short(0.25 * scene.precision()),
        );
        remark(scene.name(), format!("tolerance {taken} (rounded input)"), full);
    }
}

/// A length of two digits that is larger, by a tenth at most.
fn raised(length: f64) -> f64 {
    let unit = 10f64.powi(length.log10().floor() as i32 - 1);
    ((length / unit).floor() + 1.0) * unit
}

/// A length with two digits.
fn short(length: f64) -> String {
    match format!("{length:.1e}").replace(".0e", "e") {
        whole if whole.ends_with("e0") => whole.trim_end_matches("e0").to_owned(),
        other => other,
    }
}

/// The first of the dropped faces, and the number of the others.
fn some(scene: &Scene, dropped: impl Iterator<Item = usize>, found: &Preparation) -> String {
    let name = |face: usize| match scene.line(face) {
        Some(line) => format!("face {face} (line {line})"),
        None => format!("face {face}"),
    };
    let named: Vec<String> = dropped.take(NAMED).map(name).collect();
    match found.dropped - named.len() {
        0 => format!("{}, counted from 0", named.join(", ")),
        more => format!("{} and {more} more, counted from 0", named.join(", ")),
    }
}
