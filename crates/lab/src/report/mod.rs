//! `binspace-lab report`: the speed and the errors of methods to decide visibility.

mod csv;
mod culling;
mod figures;
mod growth;
mod machine;
mod markdown;
mod plots;
mod summary;
mod tables;
mod trial;

use std::ffi::OsStr;
use std::path::Path;
use std::time::{Duration, Instant};
use std::{fs, io};

use binspace::BuildOptions;
use binspace::internals::Faces;
use binspace::scene::Scene;
use binspace_evidence::Family;
use binspace_evidence::method::{Method, Newell, Options, all};

use self::culling::City;
use self::figures::{Row, Section, Subject};
use self::growth::Growth;
use self::trial::Trial;
use crate::args::ReportArgs;
use binspace_cli::Outcome;
use binspace_cli::failure::Failure;
use binspace_cli::files::{NewFile, STANDARD, make_folder};
use binspace_cli::job;
use binspace_cli::progress::Progress;
use binspace_cli::scene_arg;
use binspace_cli::terminal::{BAD, GOOD, HEAD, note, say, styled};
use binspace_cli::units::count;

/// The budget of fragments of a tree, and of pieces of Newell's algorithm. Too large: a single step of a
/// sweep takes minutes. Too small: methods that would finish are stopped.
const MAX_PIECES: usize = 1 << 19;
/// The budget per corner of a scene from a file.
const PIECES_PER_CORNER: usize = 8;
/// The most pairs that Newell's algorithm may compare for a picture; the second limit is for `quick`. Too
/// large: a picture takes minutes. Too small: the algorithm is stopped although it would finish.
const MAX_COMPARISONS: [u64; 2] = [1 << 27, 1 << 25];
/// The time between two writes of the results. Too small: writing takes a noticeable share of the time. Too
/// large: an interruption loses more results.
const PATIENCE: Duration = Duration::from_secs(2);
/// Plots of build times and of fragments, and their figures.
const GROWTH_FILES: [&str; 3] = ["growth-build.svg", "growth-fragments.svg", "growth.csv"];
/// The files of every report.
const FILES: [&str; 4] = ["report.md", "speed.svg", "errors.csv", "times.csv"];
/// The number of views of a scene from a file.
const VIEWS: usize = 6;

/// The content of the report up to now.
pub(super) struct Report<'a> {
    args: &'a ReportArgs,
    size: [u32; 2],
    sections: Vec<Section>,
    growth: Vec<Growth>,
    city: Option<City>,
    /// Scenes that could not be measured.
    failed: Vec<String>,
    /// Whether the report contains all requested sections.
    complete: bool,
}

/// Runs the command.
pub(crate) fn run(args: &ReportArgs) -> Result<Outcome, Failure> {
    if args.scenes.iter().filter(|&name| name == STANDARD).count() > 1 {
        return Err(Failure::about("standard input", "it can be read only once"));
    }
    // Files are read first, so that an unreadable file is reported at once.
    let scenes = args.scenes.iter().map(|name| load(args, name)).collect::<Result<Vec<_>, _>>()?;
    make_folder(&args.output)?;
    try_to_write(&args.output)?;
    let size = args.size.unwrap_or(if args.quick { [160, 120] } else { [640, 480] });
    let mut report = Report {
        args,
        size,
        sections: Vec::new(),
        growth: Vec::new(),
        city: None,
        failed: Vec::new(),
        complete: false,
    };
    let max_comparisons = MAX_COMPARISONS[usize::from(args.quick)];
    let methods_of = |max_pieces| methods(max_comparisons, max_pieces);
    let all = args.family.is_empty();
    for family in Family::ALL.into_iter().filter(|family| all || args.family.contains(family)) {
        report.run_family(family, &methods_of(MAX_PIECES))?;
    }
    for scene in &scenes {
        let corners: usize = scene.polygons().map(|polygon| polygon.points().len()).sum();
        let methods = methods_of(MAX_PIECES.max(PIECES_PER_CORNER * corners));
        match report.run_scene(scene, &methods) {
            Err(Failure::Message(problem)) => {
                note(&format!("{problem}; the report continues without it"));
                report.failed.push(scene.name().to_owned());
            }
            result => result?,
        }
    }
    if args.family.is_empty() {
        report.city = Some(culling::run(args.quick)?);
        growth::run(args, &scenes, |growth| {
            report.growth.push(growth);
            report.write()
        })?;
    }
    report.complete = true;
    report.write()?;
    let outcome = report.conclude()?;
    match report.failed.last() {
        Some(name) => Err(Failure::about(name, "could not be measured")),
        None => Ok(outcome),
    }
}

/// Reads a scene; an error if no face is left.
fn load(args: &ReportArgs, name: &OsStr) -> Result<Scene, Failure> {
    let scene = scene_arg::load(name, args.seed)?.scene;
    match Faces::new(scene.polygons(), None) {
        Ok((faces, found)) if faces.is_empty() => {
            job::note_preparation(&scene, &faces, &found);
            Err(Failure::about(scene.name(), job::NOTHING_LEFT))
        }
        // Other errors are reported when the scene is measured, and do not stop the report.
        _ => Ok(scene),
    }
}

/// All methods, with budgets.
fn methods(max_comparisons: u64, max_pieces: usize) -> Vec<Box<dyn Method>> {
    let newell = Newell { max_pieces, max_comparisons, ..Newell::DEFAULT };
    let build = BuildOptions::DEFAULT.with_max_fragments(max_pieces);
    all(&Options::DEFAULT.with_build(build).with_newell(newell))
}

impl Report<'_> {
    fn run_family(&mut self, family: Family, methods: &[Box<dyn Method>]) -> Result<(), Failure> {
        let sweep = family.sweep(self.args.quick);
        let progress = Progress::steps(format!("{family}: step"), sweep.len() as u64);
        self.sections.push(Section::new(Subject::Family(family)));
        let mut written = Instant::now();
        for &difficulty in sweep {
            let trial = Trial::of_family(family, difficulty, self.args.seed, self.size)?;
            self.add(trial.measure(methods, Some(difficulty)));
            if written.elapsed() > PATIENCE {
                self.write()?;
                written = Instant::now();
            }
            progress.step();
        }
        drop(progress);
        self.finish_section()
    }

    fn run_scene(&mut self, scene: &Scene, methods: &[Box<dyn Method>]) -> Result<(), Failure> {
        let progress = Progress::spinner(scene.name().to_owned());
        let trial = Trial::of_scene(scene, VIEWS, self.args.seed, self.size)?;
        self.sections.push(Section::new(Subject::Scene(scene.name().to_owned())));
        self.add(trial.measure(methods, None));
        drop(progress);
        self.finish_section()
    }

    /// Adds rows to the last section.
    fn add(&mut self, rows: Vec<Row>) {
        if let Some(section) = self.sections.last_mut() {
            section.rows.extend(rows);
        }
    }

    fn finish_section(&mut self) -> Result<(), Failure> {
        if let Some(section) = self.sections.last() {
            let exact = section.exactness();
            let verdict = if exact.is_zero() {
                styled(GOOD, "exact: nothing wrong")
            } else {
                styled(BAD, exact)
            };
            let rows = count(section.rows.len(), "row");
            say(format!("{:14} {rows}, {verdict}", section.subject.name()))?;
        }
        self.write()
    }

    /// Rewrites all files, and removes files of an earlier report that this report does not have.
    fn write(&self) -> Result<(), Failure> {
        let folder = &self.args.output;
        for family in Family::ALL {
            if !self.sections.iter().any(|section| section.subject == Subject::Family(family)) {
                remove(folder, &error_plot(family))?;
            }
        }
        if self.growth.is_empty() {
            GROWTH_FILES.iter().try_for_each(|name| remove(folder, name))?;
        }
        for section in &self.sections {
            if let Subject::Family(family) = section.subject {
                let plot = plots::against_difficulty(section, family)?;
                write(folder, &error_plot(family), &plot)?;
            }
        }
        if let Some(plot) = plots::speed(&self.sections)? {
            write(folder, "speed.svg", &plot)?;
        }
        if !self.growth.is_empty() {
            let [build, fragments, table] = GROWTH_FILES;
            write(folder, build, &plots::growth_build(&self.growth)?)?;
            write(folder, fragments, &plots::growth_fragments(&self.growth)?)?;
            write(folder, table, &csv::growth(&self.growth)?)?;
        }
        write(folder, "errors.csv", &csv::errors(&self.sections)?)?;
        write(folder, "times.csv", &csv::times(&self.sections)?)?;
        write(folder, "report.md", &markdown::report(self))
    }

    fn conclude(&self) -> Result<Outcome, Failure> {
        let table = summary::headline(&self.sections);
        let head = match self.args.family[..] {
            [] => "All families together",
            [_] => "The named family",
            _ => "All named families together",
        };
        say(format!("\n{}\n{}", styled(HEAD, head), table.plain()))?;
        let exact = self.exactness();
        say(format!("{exact}\nwritten: {}", self.args.output.join("report.md").display()))?;
        Ok(if exact.is_zero() { Outcome::Done } else { Outcome::Differs })
    }

    fn exactness(&self) -> figures::Exactness {
        self.sections.iter().map(Section::exactness).fold(Default::default(), |a, b| a + b)
    }
}

/// Checks that all files of a report can be written, before anything is measured. Existing files are not
/// changed.
fn try_to_write(folder: &Path) -> Result<(), Failure> {
    let plots = Family::ALL.map(error_plot);
    let names = FILES.into_iter().chain(GROWTH_FILES).chain(plots.iter().map(String::as_str));
    // Dropping a `NewFile` without writing removes it.
    names.into_iter().try_for_each(|name| NewFile::create(&folder.join(name)).map(drop))
}

fn error_plot(family: Family) -> String {
    format!("error-{family}.svg")
}

fn remove(folder: &Path, name: &str) -> Result<(), Failure> {
    match fs::remove_file(folder.join(name)) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            Err(Failure::about(folder.join(name).display(), error))
        }
        _ => Ok(()),
    }
}

fn write(folder: &Path, name: &str, text: &str) -> Result<(), Failure> {
    NewFile::create(&folder.join(name))?.write(|out| out.write_all(text.as_bytes()))
}
