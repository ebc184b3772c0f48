//! What most commands begin with: a scene, and a tree of it.

use binspace::geom::Preparation;
use binspace::scene::Scene;
use binspace::{BspTree, Error};

use crate::args::{BuildArgs, SceneArgs};
use crate::failure::Failure;
use crate::measure;
use crate::scene_arg;
use crate::terminal::note;
use crate::units::count;

/// Loads a scene and builds its tree; says what was left out of either.
pub(crate) fn scene_and_tree(
    scene: &SceneArgs,
    build: &BuildArgs,
) -> Result<(Scene, BspTree), Failure> {
    let scene = scene_arg::load(scene)?;
    let options = build.limits.options(build.heuristic);
    let tree = measure::build(&scene, &options).map_err(|error| about(&scene, &error))?;
    note_preparation(&scene, tree.preparation());
    Ok((scene, tree))
}

/// A failure to build a scene's tree.
pub(crate) fn about(scene: &Scene, error: &Error) -> Failure {
    Failure::about(scene.name(), error)
}

/// Says what became of polygons that are not faces as they stand.
pub(crate) fn note_preparation(scene: &Scene, preparation: &Preparation) {
    let Preparation { dropped, triangulated, .. } = *preparation;
    let dropped = (dropped > 0).then(|| format!("{} without area dropped", faces(dropped)));
    let triangulated = (triangulated > 0)
        .then(|| format!("{} not convex or not planar, triangulated", faces(triangulated)));
    let said: Vec<String> = dropped.into_iter().chain(triangulated).collect();
    if !said.is_empty() {
        note(&format!("{}: {}", scene.name(), said.join("; ")));
    }
}

fn faces(number: usize) -> String {
    count(number, "polygon")
}
