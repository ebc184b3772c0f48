//! `binspace report`: every way to decide visibility, its speed against its error.

mod csv;
mod figures;
mod growth;
mod machine;
mod markdown;
mod plots;
mod sentences;
mod summary;
mod tables;
mod trial;

use std::path::Path;

use binspace::BuildOptions;
use binspace::method::{Method, Newell, Options, all};
use binspace::scene::{Family, Scene};

use self::figures::{Section, Subject};
use self::growth::Growth;
use self::trial::Trial;
use super::Outcome;
use crate::args::{ReportArgs, SceneArgs};
use crate::failure::Failure;
use crate::files::{NewFile, make_folder};
use crate::progress::Progress;
use crate::scene_arg;
use crate::terminal::{BAD, GOOD, HEAD, say, styled};
use crate::units::count;

/// The most fragments of a tree, and pieces of Newell's algorithm. More, and a single step of a
/// sweep takes minutes; less, and methods are given up that come to an end.
const MAX_PIECES: usize = 1 << 19;
/// The most pairs that Newell's algorithm may compare for a picture: seconds, and less if it has to
/// be quick.
const MAX_COMPARISONS: [u64; 2] = [1 << 27, 1 << 25];
/// Views of scenes that are files.
const VIEWS: usize = 6;

/// What the report is made of so far.
pub(super) struct Report<'a> {
    args: &'a ReportArgs,
    size: [u32; 2],
    sections: Vec<Section>,
    growth: Vec<Growth>,
    /// Whether all that was asked for is in it.
    complete: bool,
}

/// Runs the command.
pub(crate) fn run(args: &ReportArgs) -> Result<Outcome, Failure> {
    // Files first: what cannot be read should not cost minutes.
    let scenes = args.scenes.iter().map(|name| load(args, name)).collect::<Result<Vec<_>, _>>()?;
    make_folder(&args.output)?;
    let size = args.size.unwrap_or(if args.quick { [160, 120] } else { [640, 480] });
    let mut report =
        Report { args, size, sections: Vec::new(), growth: Vec::new(), complete: false };
    let methods = methods(MAX_COMPARISONS[usize::from(args.quick)]);
    let families = if args.family.is_empty() { &Family::ALL[..] } else { &args.family };
    for &family in families {
        let section = run_family(&report, family, &methods)?;
        report.finish_section(section)?;
    }
    for scene in &scenes {
        let section = run_scene(&report, scene, &methods)?;
        report.finish_section(section)?;
    }
    if args.family.is_empty() {
        growth::run(args, |growth| {
            report.growth.push(growth);
            report.write()
        })?;
    }
    report.complete = true;
    report.write()?;
    report.conclude()
}

fn load(args: &ReportArgs, name: &std::ffi::OsStr) -> Result<Scene, Failure> {
    scene_arg::load(&SceneArgs { name: name.to_owned(), seed: args.seed })
}

/// All competitors, with budgets that end.
fn methods(max_comparisons: u64) -> Vec<Box<dyn Method>> {
    let newell = Newell { max_pieces: MAX_PIECES, max_comparisons, ..Newell::DEFAULT };
    let build = BuildOptions::DEFAULT.with_max_fragments(MAX_PIECES);
    all(&Options::DEFAULT.with_build(build).with_newell(newell))
}

fn run_family(
    report: &Report<'_>,
    family: Family,
    methods: &[Box<dyn Method>],
) -> Result<Section, Failure> {
    let args = report.args;
    let sweep = family.sweep(args.quick);
    let progress = Progress::steps(format!("{family}: step"), sweep.len() as u64);
    let mut section = Section::new(Subject::Family(family));
    for &difficulty in sweep {
        let trial = Trial::of_family(family, difficulty, args.seed, report.size)?;
        section.rows.extend(trial.measure(methods, Some(difficulty)));
        progress.step();
    }
    Ok(section)
}

fn run_scene(
    report: &Report<'_>,
    scene: &Scene,
    methods: &[Box<dyn Method>],
) -> Result<Section, Failure> {
    let _progress = Progress::spinner(scene.name().to_owned());
    let trial = Trial::of_scene(scene, VIEWS, report.args.seed, report.size)?;
    let mut section = Section::new(Subject::Scene(scene.name().to_owned()));
    section.rows = trial.measure(methods, None);
    Ok(section)
}

impl Report<'_> {
    fn finish_section(&mut self, section: Section) -> Result<(), Failure> {
        let exact = section.exactness();
        let verdict = if exact.is_zero() {
            styled(GOOD, "exact: nothing wrong")
        } else {
            styled(BAD, format!("exact: {exact}"))
        };
        say(format!(
            "{:14}{}, {verdict}",
            section.subject.name(),
            count(section.rows.len(), "row")
        ))?;
        self.sections.push(section);
        self.write()
    }

    /// Writes all files anew.
    fn write(&self) -> Result<(), Failure> {
        let folder = &self.args.output;
        for section in &self.sections {
            if let Subject::Family(family) = section.subject {
                let plot = plots::against_difficulty(section, family)?;
                write(folder, &format!("error-{family}.svg"), &plot)?;
            }
        }
        if let Some(plot) = plots::speed(&self.sections)? {
            write(folder, "speed.svg", &plot)?;
        }
        if !self.growth.is_empty() {
            write(folder, "growth-build.svg", &plots::growth_build(&self.growth)?)?;
            write(folder, "growth-fragments.svg", &plots::growth_fragments(&self.growth)?)?;
            write(folder, "growth.csv", &csv::growth(&self.growth))?;
        }
        write(folder, "errors.csv", &csv::errors(&self.sections))?;
        write(folder, "times.csv", &csv::times(&self.sections))?;
        write(folder, "report.md", &markdown::report(self))
    }

    fn conclude(&self) -> Result<Outcome, Failure> {
        let table = summary::headline(&self.sections);
        say(format!("\n{}\n{}", styled(HEAD, "All families together"), table.plain()))?;
        let exact = self.exactness();
        say(format!("{exact}\nwritten: {}", self.args.output.join("report.md").display()))?;
        Ok(if exact.is_zero() { Outcome::Done } else { Outcome::Differs })
    }

    fn exactness(&self) -> figures::Exactness {
        self.sections.iter().map(Section::exactness).fold(Default::default(), |a, b| a + b)
    }
}

fn write(folder: &Path, name: &str, text: &str) -> Result<(), Failure> {
    NewFile::create(&folder.join(name))?.write(|out| out.write_all(text.as_bytes()))
}
