//! `binspace page`: a scene as a self-contained page, to be turned in a browser.

use crate::Outcome;
use crate::args::PageArgs;
use crate::backs::note_backs;
use crate::camera;
use crate::cull::Cull;
use crate::failure::Failure;
use crate::files::Output;
use crate::job::{self, Made};
use crate::page::{self, Page};
use crate::progress::Progress;
use crate::terminal::remark;
use crate::units::{count, three_digits, time};
use crate::upright::{note_up, up_of};

/// The shape of the picture for which the first view is chosen.
const SIZE: [u32; 2] = [1280, 720];
/// The number of fragments beyond which a page without a graphics card draws only a few pictures a second.
/// Too small: notes on pages that turn well. Too large: people wait and do not know why.
const MANY: usize = 200_000;

/// Runs the command.
pub(crate) fn run(args: &PageArgs) -> Result<Outcome, Failure> {
    let output = Output::open_binary(&args.output, &args.scene, "a page")?;
    let made = job::make(&args.scene, &args.build)?;
    let Made { scene, tree, .. } = &made;
    note_up(scene, &args.up);
    let camera =
        camera::whole(scene, args.up.given(), camera::FIELD_OF_VIEW, SIZE, camera::MARGIN)?;
    let culls_backs = args.cull.cull == Cull::Back;
    if !culls_backs {
        note_backs(scene, tree, &camera);
    }
    if tree.len() > MANY {
        let fragments = count(tree.len(), "fragment");
        let slow = format!("{fragments}: without a graphics card, the page turns slowly");
        remark(scene.name(), &slow, &slow);
    }
    let up = args.up.given().unwrap_or_else(|| up_of(scene));
    let figures = figures(&made);
    let _progress = Progress::spinner("writing");
    let page = Page { scene, tree, camera: &camera, up, culls_backs, figures };
    output.write(|out| page::write(out, page))?;
    Ok(Outcome::Done)
}

/// The figures that the page shows, by name.
fn figures(made: &Made) -> Vec<(String, String)> {
    let stats = made.tree.stats();
    let heuristic = made.heuristic.map_or("from a file".to_owned(), |built| built.to_string());
    let seconds = if made.heuristic.is_some() { "built in" } else { "read in" };
    let rows = [
        ("polygons", made.tree.preparation().polygons.to_string()),
        ("fragments", stats.fragments.to_string()),
        ("cuts", stats.splits.to_string()),
        ("nodes", stats.nodes.to_string()),
        ("depth", stats.depth_max.to_string()),
        ("mean depth", three_digits(stats.depth_mean)),
        ("heuristic", heuristic),
        (seconds, time(made.seconds)),
    ];
    rows.map(|(name, value)| (name.to_owned(), value)).into()
}
