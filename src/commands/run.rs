//! `run`: the analyses of a study; tables on the terminal, CSV and JSON in files.

mod axes;
mod balance;
mod breakdown;
mod compare;
mod component_compare;
mod contact_path;
mod cycle;
mod deviations;
mod duties;
mod fluid_sweep;
mod identify;
mod inputs;
mod map;
mod operating_points;
mod parquet;
mod parts;
mod pieces;
mod ranges;
mod report;
mod rms_surface;
mod rows;
mod sensitivity;
mod shard;
mod shares;
mod sweep;
mod thermal_limit;
mod tournament;
mod trial;
mod uncertainty;
mod write;

pub(super) use map::tidy;
pub(super) use parts::Parts;
pub use shard::Shard;

use self::axes::{axis, grid_axes, speeds, torques};

use std::cell::{Cell, RefCell};
use std::path::{Path, PathBuf};

use gearloss_framework::analysis::{Field, Given, GridResult, Piece, Points, merge, notes, pieces, solve_pieces};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::loss::Extent;
use gearloss_framework::resolve::Resolved;
use gearloss_framework::study::{Analysis, Grid, Study};
use gearloss_framework::transmission::Transmission;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::Value;

use crate::args::{ResultArgs, RunArgs};
use crate::interrupt;
use crate::output::{End, Failure, Out};
use crate::report::Report;

/// One gearbox under one set of models.
pub(super) struct Built<'a> {
    pub name: String,
    pub gearbox: &'a Gearbox,
    pub resolved: Resolved,
    pub transmission: Transmission,
}

impl Built<'_> {
    /// The set as a choice names it: without the product, absent for the gearbox's own models.
    pub fn set(&self) -> Option<&str> {
        let set = self.name.rsplit('/').next();
        set.filter(|set| *set != "own")
    }
}

/// What all analyses of one run share.
pub(super) struct Runner<'a> {
    language: &'a Language,
    study: &'a Study,
    folder: PathBuf,
    progress: bool,
    report: RefCell<Report>,
    /// Files that were written.
    names: write::Names,
    /// Limits that were left at any point, counted over all analyses.
    left: Cell<usize>,
    /// Files of points that the analysis at hand has read, with their hashes.
    read: RefCell<Vec<(String, String)>>,
    /// Files that the gearboxes had read before any analysis.
    known: Vec<Vec<PathBuf>>,
    /// What shards have computed, where they are merged.
    parts: Option<Parts>,
}

impl<'a> Runner<'a> {
    fn new(language: &'a Language, study: &'a Study, folder: PathBuf, parts: Option<Parts>) -> Self {
        let known = |(_, gearbox): &(String, Gearbox)| gearbox.files.all().into_iter().map(|(file, _)| file).collect();
        Self {
            language,
            study,
            folder,
            progress: Out::error().is_terminal(),
            report: RefCell::default(),
            names: write::Names::default(),
            left: Cell::new(0),
            read: RefCell::default(),
            known: study.gearboxes.iter().map(known).collect(),
            parts,
        }
    }
}

impl Runner<'_> {
    /// Runs an analysis, with its section in the report. What another one has read is forgotten: the inputs that its results
    /// name are its own, whatever ran before.
    fn attempt(&self, name: &str, analysis: &Analysis, out: &mut Out) -> Result<(), Failure> {
        self.report.borrow_mut().begin(name, about(analysis));
        self.read.borrow_mut().clear();
        for ((_, gearbox), known) in self.study.gearboxes.iter().zip(&self.known) {
            gearbox.files.forget_all_but(known);
        }
        out.begin_copy();
        let done = match analysis {
            Analysis::Map(entry) => map::run(self, name, entry, out),
            Analysis::Compare(entry) => compare::run(self, name, entry, out),
            Analysis::Breakdown(entry) => breakdown::run(self, name, entry, out),
            Analysis::ComponentCompare(entry) => component_compare::run(self, name, entry, out),
            Analysis::ContactPath(entry) => contact_path::run(self, name, entry, out),
            Analysis::OperatingPoints(entry) => operating_points::run(self, name, entry, out),
            Analysis::ThermalLimit(entry) => thermal_limit::run(self, name, entry, out),
            Analysis::Balance(entry) => balance::run(self, name, entry, out),
            Analysis::Sweep(entry) => sweep::run(self, name, entry, out),
            Analysis::Tournament(entry) => tournament::run(self, name, entry, out),
            Analysis::Uncertainty(entry) => uncertainty::run(self, name, entry, out),
            Analysis::Identify(entry) => identify::run(self, name, entry, out),
            Analysis::Sensitivity(entry) => sensitivity::run(self, name, entry, out),
            Analysis::RmsSurface(entry) => rms_surface::run(self, name, entry, out),
            Analysis::Cycle(entry) => cycle::run(self, name, entry, out),
            Analysis::FluidSweep(entry) => fluid_sweep::run(self, name, entry, out),
            Analysis::SpinLoss(entry) => breakdown::spin_loss(self, name, entry, out),
            Analysis::TemperatureSweep(entry) => breakdown::temperature_sweep(self, name, entry, out),
        };
        let printed = out.end_copy();
        self.report.borrow_mut().text(&printed);
        done
    }

    /// The gearbox under each set; under its own models where no set is named.
    fn built<'s>(&'s self, gearbox: &'s Gearbox, sets: &'s [String]) -> Result<Vec<Built<'s>>, Failure> {
        self.built_with(gearbox, sets, &[])
    }

    /// As [`Runner::built`], with further overrides.
    fn built_with<'s>(
        &'s self,
        gearbox: &'s Gearbox,
        sets: &'s [String],
        overrides: &[(String, Value)],
    ) -> Result<Vec<Built<'s>>, Failure> {
        let build = |name: Option<&'s str>| -> Result<Built<'s>, Failure> {
            let (gearbox, set) = match name {
                Some(name) => self.study.reference("analyses", name, gearbox)?,
                None => (gearbox, None),
            };
            let mut choice = self.study.choice(set);
            choice.overrides.extend_from_slice(overrides);
            let resolved = gearbox.resolve(self.language, &choice)?;
            let transmission = gearbox.build(self.language, &resolved)?;
            Ok(Built {
                name: name.unwrap_or("own").to_owned(),
                gearbox,
                resolved,
                transmission,
            })
        };
        if sets.is_empty() {
            Ok(vec![build(None)?])
        } else {
            sets.iter().map(|set| build(Some(set))).collect()
        }
    }

    /// The points of axes under the study's conditions.
    fn points(&self, transmission: &Transmission, gear: &str, torques: Vec<f64>, speeds: Vec<f64>) -> Points {
        self.field(transmission, gear, Field::Grid { torques, speeds })
    }

    /// The points of a list under the study's conditions.
    fn listed(&self, transmission: &Transmission, gear: &str, list: Vec<Given>) -> Points {
        self.field(transmission, gear, Field::List(list))
    }

    fn field(&self, transmission: &Transmission, gear: &str, field: Field) -> Points {
        self.study.points(transmission, gear, field)
    }

    /// A bar of progress on standard error, on a terminal only.
    fn bar(&self, count: u64, name: &str) -> ProgressBar {
        let bar = if self.progress {
            ProgressBar::new(count)
        } else {
            ProgressBar::hidden()
        };
        if let Ok(style) = ProgressStyle::with_template("{msg} {bar:30} {pos}/{len}") {
            bar.set_style(style);
        }
        bar.set_message(name.to_owned());
        bar
    }

    /// Solves all points and holds them.
    fn solve(&self, built: &Built<'_>, points: &Points) -> Result<GridResult, Failure> {
        let mut all = GridResult::default();
        self.solve_pieces(built, points, None, &mut |piece| {
            all.add(piece);
            Ok(())
        })?;
        Ok(all)
    }

    /// Solves all points and hands them over piece by piece. Those `of` a map, its analysis and its number there, come from
    /// the shards where they are merged.
    fn solve_pieces(
        &self,
        built: &Built<'_>,
        points: &Points,
        of: Option<(&str, usize)>,
        take: &mut dyn FnMut(Piece) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut seen = Vec::new();
        let mut counted = |piece: Piece| {
            merge(&mut seen, &piece.seen);
            take(piece)
        };
        let solved = self.parts.as_ref().zip(of).and_then(|(parts, of)| parts.pieces(of));
        match solved {
            Some(solved) => solved.into_iter().try_for_each(|piece| counted(piece?))?,
            None => {
                let numbers: Vec<usize> = (0..pieces(points.field.len())).collect();
                self.evaluate(built, points, &numbers, &mut counted)?;
            }
        }
        self.seen(&built.transmission, &seen);
        Ok(())
    }

    /// Solves pieces of given numbers, however they are wanted.
    fn evaluate(
        &self,
        built: &Built<'_>,
        points: &Points,
        numbers: &[usize],
        take: &mut dyn FnMut(Piece) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let count = points.field.len();
        let own = count * numbers.len() / pieces(count).max(1);
        let bar = self.bar(own as u64, &built.name);
        let going = |n: usize| {
            bar.inc(n as u64);
            !interrupt::pressed()
        };
        let mut fault = None;
        let whole = solve_pieces(&built.transmission, points, numbers, &going, &mut |piece| {
            fault = take(piece).err();
            fault.is_none()
        });
        bar.finish_and_clear();
        let whole = whole.map_err(|list| Failure::from(built.gearbox.findings(list)))?;
        match fault {
            Some(fault) => Err(fault),
            None if whole => Ok(()),
            None => Err(Failure::Interrupted),
        }
    }

    /// Prints a sentence that a reader must not miss, and puts it where the report begins to tell of the analysis.
    fn verdict(&self, sentence: String, out: &mut Out) -> Result<(), Failure> {
        out.line(&sentence)?;
        self.report.borrow_mut().verdict(&sentence);
        Ok(())
    }

    /// The one gear state of a grid.
    fn one_gear(&self, path: &str, grid: &Grid, t: &Transmission) -> Result<String, Failure> {
        match &grid.gear.of(t)[..] {
            [gear] => Ok(gear.clone()),
            several => Err(self.wrong(
                path,
                format!("this analysis takes a grid of one gear state, not of {}", several.len()),
                "give it a grid of its own",
            )),
        }
    }

    /// A fault of the study at a path.
    fn wrong(&self, path: &str, message: impl Into<String>, mend: &str) -> Failure {
        self.study
            .findings(vec![Diagnostic::error(path, message.into()).mend(mend)])
            .into()
    }

    /// Counts the limits that were left.
    fn seen(&self, transmission: &Transmission, seen: &[Extent]) {
        let left = notes(transmission, seen).iter().filter(|n| n.outside > 0).count();
        self.left.set(self.left.get() + left);
    }
}

pub fn run(args: &RunArgs, out: &mut Out) -> Result<End, Failure> {
    let language = Language::linked()?;
    let study = read(&language, &args.study)?;
    match args.shard {
        Some(shard) => shard::run(&language, &study, shard, args, out),
        None => all(&language, &study, None, &args.results, out),
    }
}

/// A study, checked.
pub(super) fn read(language: &Language, file: &Path) -> Result<Study, Failure> {
    let study = Study::read(language, file)?;
    study.check(language)?;
    Ok(study)
}

/// All analyses and the report; what shards have computed is taken from them.
pub(super) fn all(
    language: &Language,
    study: &Study,
    parts: Option<Parts>,
    args: &ResultArgs,
    out: &mut Out,
) -> Result<End, Failure> {
    let folder = args.output.clone().unwrap_or_else(|| study.folder.join("results"));
    if let Some(wrong) = args.deny.iter().find(|what| *what != "extrapolation") {
        return Err(Failure::input(
            format!("--deny {wrong}: a study can deny `extrapolation` only"),
            "write --deny extrapolation, or `check --deny GRADE` for evidence",
        ));
    }
    let template = report::template(args.template.as_deref())?;
    replaced(&folder, args.force, out)?;
    let runner = Runner::new(language, study, folder, parts);
    if let Some(title) = &study.entry.title {
        out.line(title)?;
        out.line("")?;
    }
    overridden(study, out)?;
    // A folder that cannot be written is told before anything is computed.
    write::folder(&runner)?;
    interrupt::listen();
    let (mut failed, mut done_so_far, mut finished) = (0, 0, None);
    for (name, analysis) in study.entry.analyses.iter() {
        let outcome = runner.parts.as_ref().and_then(|parts| parts.outcome(name));
        let done = match outcome {
            Some(outcome) => outcome.replay(&runner, out),
            None => runner.attempt(name, analysis, out),
        };
        match done {
            Ok(()) => {}
            // What was computed before and what comes after is kept.
            Err(Failure::Input(text)) => {
                failed += 1;
                write::remove(&runner, name);
                out.line(format!("{name}: failed"))?;
                runner.report.borrow_mut().text(&format!("failed\n{text}"));
                Out::error().text(&text)?;
            }
            Err(Failure::Interrupted) => {
                runner.report.borrow_mut().drop_last();
                finished = Some(done_so_far);
                break;
            }
        }
        done_so_far += 1;
    }
    report::write(&runner, template.as_deref())?;
    out.line(format!("results in {}, report in report.html", runner.folder.display()))?;
    if let Some(finished) = finished {
        let all = study.entry.analyses.len();
        Out::error().line(format!("{finished} of {all} analyses are finished and kept"))?;
        return Err(Failure::Interrupted);
    }
    if failed == 0 && !args.deny.is_empty() && runner.left.get() > 0 {
        out.line(format!(
            "denied: extrapolation; {} stated ranges were left",
            runner.left.get()
        ))?;
        return Ok(End::Finding);
    }
    if failed == 0 {
        Ok(End::Fine)
    } else {
        Err(Failure::Input(format!(
            "error: {failed} of {} analyses failed\n",
            study.entry.analyses.len()
        )))
    }
}

/// The gear state that an analysis names, or the first.
fn gear_of<'a>(named: Option<&'a str>, transmission: &'a Transmission) -> &'a str {
    let first = transmission.states().first().map_or("", |s| s.name.as_str());
    named.unwrap_or(first)
}

/// What an analysis is, as a sentence.
fn about(analysis: &Analysis) -> &'static str {
    match analysis {
        Analysis::Map(_) => "Losses and efficiency over a grid.",
        Analysis::Compare(_) => "Differences between sets of models and products, or between them and a measurement.",
        Analysis::Breakdown(_) => "Where the losses arise.",
        Analysis::ComponentCompare(_) => "Several models of one component.",
        Analysis::ContactPath(_) => {
            "Speeds, load, pressure, friction, film and loss along the path of contact of one mesh."
        }
        Analysis::OperatingPoints(_) => "Losses of a list of operating points.",
        Analysis::ThermalLimit(_) => "How far a torque or a speed can go before the oil reaches a temperature.",
        Analysis::Balance(_) => "How the temperature of one point is found.",
        Analysis::Sweep(_) => "Losses and efficiency over the values of one path.",
        Analysis::Tournament(_) => {
            "Every combination of models, ranked by a measurement, or the spread that they leave."
        }
        Analysis::Uncertainty(_) => "Bands from uncertain inputs.",
        Analysis::Identify(_) => "Uncertain parameters, found from measured points, and what the points say of each.",
        Analysis::Sensitivity(_) => "What the losses depend on.",
        Analysis::RmsSurface(_) => "How well models meet a measurement over two quantities of the gearbox.",
        Analysis::Cycle(_) => "Losses, energies and temperatures of duties.",
        Analysis::FluidSweep(_) => "Mean losses of duties over one property of an oil, and where they are least.",
        Analysis::SpinLoss(_) => "Losses without load.",
        Analysis::TemperatureSweep(_) => "Where the losses arise, over the temperature of the oil.",
    }
}

/// Says where the conditions take the place of a temperature that a gearbox states.
fn overridden(study: &Study, out: &mut Out) -> Result<(), Failure> {
    let Some(oil) = study.entry.conditions.oil_temperature else {
        return Ok(());
    };
    for (name, gearbox) in &study.gearboxes {
        let thermal = &gearbox.value["thermal"];
        let own = thermal["oil"].as_f64().filter(|own| (own - oil).abs() > 1e-9);
        let words = match (own, thermal["mode"].as_str()) {
            (_, Some("balance")) => "the balance of".to_owned(),
            (Some(own), _) if gearbox.places.is_written("thermal.oil") => format!("{own} degC of"),
            _ => continue,
        };
        out.line(format!(
            "note: `conditions.oil_temperature`, {oil} degC, takes the place of {words} gearbox `{name}`"
        ))?;
    }
    Ok(())
}

/// A folder that holds something else than earlier results is not written into unasked; earlier results are replaced, which
/// is said.
fn replaced(folder: &Path, force: bool, out: &mut Out) -> Result<(), Failure> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Ok(());
    };
    let files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    if files.is_empty() || force {
        return Ok(());
    }
    let written = |file: &PathBuf| {
        let kind = file.extension().and_then(|kind| kind.to_str());
        matches!(
            kind,
            Some("csv" | "json" | "svg" | "html" | "parquet" | "vtlm" | "m" | "mo" | "yaml" | "part")
        )
    };
    // Every run leaves a report, so a folder without one is the user's own.
    let ours = files
        .iter()
        .any(|file| file.file_name().is_some_and(|name| name == write::REPORT));
    if ours && files.iter().all(written) {
        out.line(format!("replacing the results in {}", folder.display()))?;
        return Ok(());
    }
    Err(Failure::input(
        format!("{} holds files, and no results of a study", folder.display()),
        "name another folder with -o, or write into it with --force",
    ))
}
