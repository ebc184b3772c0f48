//! Scenes of hundreds and thousands of faces, by any heuristic: fragments, orders, budgets, cancel,
//! threads.

mod copies;
mod limits;
mod pools;

use super::super::dice::Dice;
use super::super::judge::{self, Verdict, ensure};
use super::super::orders;
use super::super::rays::Rays;
use super::super::snapshot::Snapshot;
use super::super::views;
use super::cover;
use arbitrary::{Result, Unstructured};
use binspace::glam::DVec3;
use binspace::{BspTree, BuildOptions, Error, ErrorKind, Progress};
use limits::Watched;

/// A tree of more fragments takes too long to be judged, so its scene is halved.
const MOST_FRAGMENTS: usize = 8_000;

/// A build that reports its progress more often takes too long as well. It reports about once in 65 536
/// examined pieces.
const MOST_CALLS: usize = 100;

/// Trees of at most this many fragments are judged in rationals.
const JUDGED: usize = 48;

/// The checks of a build besides its tree.
#[derive(Clone, Copy, Debug)]
enum Question {
    Budgets,
    Cancel,
    Threads,
    Rays,
}

impl Question {
    const ALL: [Self; 4] = [Self::Budgets, Self::Cancel, Self::Threads, Self::Rays];
}

/// Builds a small scene that is repeated up to some thousand polygons, and judges its tree.
pub fn run(data: &[u8]) {
    // Too few bytes make no scene.
    let _ = try_run(&mut Unstructured::new(data));
}

fn try_run(bytes: &mut Unstructured<'_>) -> Result<()> {
    let options = super::super::decode::options(bytes)?.with_max_fragments(MOST_FRAGMENTS);
    let mut dice = Dice(u64::from(bytes.arbitrary::<u16>()?));
    let question = *bytes.choose(&Question::ALL)?;
    let mut polygons = copies::scene(bytes)?;
    let infinite = polygons.iter().position(|polygon| polygon.iter().any(|c| !c.is_finite()));
    let built = loop {
        let built = limits::watch(&options, &polygons, MOST_CALLS, 1);
        match &built.result {
            Err(error)
                if error.kind() == ErrorKind::OverBudget
                    || error.kind() == ErrorKind::Cancelled =>
            {
                assert!(
                    error.kind() == ErrorKind::OverBudget || built.heard.len() == MOST_CALLS,
                    "{error}"
                );
                assert!(polygons.len() > 1, "{error}: {options:?} {polygons:?}");
                polygons.truncate(polygons.len() / 2);
            }
            _ => break built,
        }
    };
    let Watched { result, heard, .. } = built;
    let tree = match result {
        Ok(tree) => tree,
        Err(error) => {
            refused(&error, infinite, polygons.len());
            return Ok(());
        }
    };
    assert!(infinite.is_none_or(|polygon| polygon >= polygons.len()), "no number, yet it passed");
    let base = Base { options: options.clone(), polygons: &polygons, tree: &tree, heard: &heard };
    if let Err(what) = base.check(question, &mut dice) {
        let shown = &polygons[..polygons.len().min(24)];
        panic!("{what}: {question:?} of {} polygons, {options:?} {shown:?}", polygons.len());
    }
    Ok(())
}

fn refused(error: &Error, infinite: Option<usize>, polygons: usize) {
    let named = infinite.is_some_and(|polygon| polygon < polygons) && error.polygon() == infinite;
    assert!(named, "{error}");
}

/// A tree built by one thread, and its reports.
struct Base<'a> {
    options: BuildOptions,
    polygons: &'a [Vec<DVec3>],
    tree: &'a BspTree,
    heard: &'a [Progress],
}

impl Base<'_> {
    fn check(&self, question: Question, dice: &mut Dice) -> Verdict {
        self.tree.validate()?;
        cover::covers(self.tree)?;
        limits::progress(self.heard, self.tree.faces().len())?;
        if self.tree.len() <= JUDGED {
            judge::judge(self.tree, self.polygons)?;
        }
        match question {
            Question::Budgets => self.budgets(dice),
            Question::Cancel => self.cancel(dice),
            Question::Threads => self.threads(),
            Question::Rays => Ok(()),
        }?;
        self.orders(question, dice)
    }

    /// Checks orders in all forms, and by rays in big integers: more rays if `question` asks for orders.
    fn orders(&self, question: Question, dice: &mut Dice) -> Verdict {
        if self.tree.is_empty() {
            return Ok(());
        }
        let mut rays = Rays::new(self.tree);
        let (views, most) = if matches!(question, Question::Rays) { (3, 16) } else { (1, 4) };
        let rays_of_a_view = (20_000 / self.tree.len()).clamp(1, most);
        for _ in 0..views {
            let view = views::some_view(self.tree.faces(), &rays, dice);
            orders::check(self.tree, view.viewpoint)?;
            rays.check(&view, rays_of_a_view, dice)?;
        }
        Ok(())
    }

    /// Checks that any number of threads builds the same tree, bit for bit.
    fn threads(&self) -> Verdict {
        let expected = Snapshot::of(self.tree);
        for threads in 1..=pools::MOST_THREADS {
            let tree = pools::with_threads(threads, || self.options.build(self.polygons));
            let tree = tree.map_err(|error| format!("{error} with {threads} threads"))?;
            ensure(Snapshot::of(&tree) == expected, || format!("another tree, {threads} threads"))?;
        }
        Ok(())
    }
}
