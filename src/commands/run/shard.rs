//! One part of a study, so that several machines share the work: `run --shard K/N`.

use std::fmt;
use std::fs;
use std::str::FromStr;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::language::Language;
use gearloss_studies::analyses::AnalysisEntry;
use gearloss_studies::analysis::Bits;
use gearloss_studies::study::{MapEntry, Study};
use serde::{Deserialize, Serialize};

use super::folder::{cannot, inside};
use super::map::{Planned, planned};
use super::parts::{Manifest, Outcome, piece_file};
use super::pieces::PieceFile;
use super::{Run, Runner};
use crate::args::RunArgs;
use crate::interrupt;
use crate::output::{End, Failure, Out};

/// Shard `number` of as many as `of`, counted from one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    pub number: usize,
    pub of: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let how = "write K/N: part K of N, such as 1/3, 2/3 and 3/3";
        let (number, of) = text.split_once('/').ok_or(how)?;
        let number = number.parse().map_err(|_| how)?;
        let of = of.parse().map_err(|_| how)?;
        if (1..=of).contains(&number) {
            Ok(Self { number, of })
        } else {
            Err(format!("K runs from 1 to N; {how}"))
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

/// The work of a study in units, which are dealt to the shards one after the other: pieces of maps over grids, and every other
/// analysis as a whole.
pub struct Deal<'a> {
    pub works: Vec<Work<'a>>,
    of: usize,
    /// Number of units.
    pub units: usize,
}

/// One analysis.
pub struct Work<'a> {
    pub name: &'a str,
    pub analysis: &'a AnalysisEntry,
    pub kind: Kind<'a>,
}

/// How an analysis is split.
pub enum Kind<'a> {
    /// Not at all: one unit of this number.
    Whole(usize),
    /// Into the pieces of its maps.
    Maps(Vec<Pieces<'a>>),
    /// A map that cannot be planned has nothing to compute; the merge tells why.
    Faulty,
}

/// The pieces of one map.
pub struct Pieces<'a> {
    pub plan: Planned<'a>,
    /// Number of the unit of its first piece.
    pub first: usize,
}

impl Pieces<'_> {
    /// How many there are.
    pub fn pieces(&self) -> usize {
        self.plan.points.field.pieces()
    }
}

impl<'a> Deal<'a> {
    /// The work of a study for so many shards.
    pub fn of(runners: &'a [Runner<'a>], of: usize) -> Self {
        let mut units = 0;
        let mut works = Vec::new();
        for runner in runners {
            let name = runner.name;
            let Some(analysis) = runner.study.entry.analyses.get(name) else {
                continue;
            };
            let kind = match analysis.entry::<MapEntry>() {
                Some(entry) if entry.points.is_none() => match planned(runner, name, entry) {
                    Ok(plans) if plans.iter().all(|p| p.points.case(&p.built.transmission).is_ok()) => {
                        let maps = plans.into_iter().map(|plan| {
                            let map = Pieces { plan, first: units };
                            units += map.pieces();
                            map
                        });
                        Kind::Maps(maps.collect())
                    }
                    _ => Kind::Faulty,
                },
                _ => {
                    units += 1;
                    Kind::Whole(units - 1)
                }
            };
            works.push(Work { name, analysis, kind });
        }
        Self { works, of, units }
    }

    /// The shard that a unit is dealt to.
    pub fn owner(&self, unit: usize) -> usize {
        unit % self.of + 1
    }
}

/// What a shard has to do, and how much of it an earlier run has done.
#[derive(Default)]
struct Count {
    computed: usize,
    kept: usize,
    failed: usize,
}

/// Computes the part of a shard, and goes on where an earlier run of it was broken off.
pub fn run(language: &Language, study: &Study, shard: Shard, args: &RunArgs, out: &mut Out) -> Result<End, Failure> {
    let own = || {
        study
            .folder
            .join("shards")
            .join(format!("{}-of-{}", shard.number, shard.of))
    };
    let folder = args.results.output.clone().unwrap_or_else(own);
    // A shard does not know what an analysis of another one finds.
    if let Some((name, (set, by))) = study
        .entry
        .analyses
        .iter()
        .find_map(|(name, a)| Some((name, study.pending(a)?)))
    {
        let message = format!(
            "`{name}` uses the set `{set}`, whose values `{by}` finds, and the two may fall into different shards"
        );
        let mend = format!("run `{by}` first, and write what it finds under `model_sets`; or run the study as a whole");
        return Err(study
            .findings(vec![Diagnostic::error(format!("analyses.{name}"), message).mend(mend)])
            .into());
    }
    let held = Manifest::of(language, study, shard).claim(&folder)?;
    interrupt::listen();
    let runner = Run::new(language, study, folder, None);
    let runners = runner.all();
    let deal = Deal::of(&runners, shard.of);
    let mut count = Count::default();
    let done = deal.works.iter().try_for_each(|work| match &work.kind {
        Kind::Whole(unit) if deal.owner(*unit) == shard.number => whole(&runner, work, &mut count),
        Kind::Whole(_) | Kind::Faulty => Ok(()),
        Kind::Maps(maps) => maps.iter().enumerate().try_for_each(|(number, map)| {
            let own = (0..map.pieces()).filter(|piece| deal.owner(map.first + piece) == shard.number);
            of_map(&runner, work.name, number, map, own.collect(), &mut count)
        }),
    });
    // Broken off or not: the same command goes on.
    held.finish();
    let Count { computed, kept, failed } = count;
    let of_all = format!("{} of {} units", computed + kept, deal.units);
    let words = format!(
        "shard {shard}: {of_all} in {}, {kept} of them from before",
        runner.folder.display()
    );
    if let Err(fault) = done {
        Out::error().line(words)?;
        return Err(fault);
    }
    out.line(words)?;
    if failed > 0 {
        out.line(format!(
            "{failed} analyses failed; `gearloss merge` runs them again and tells why"
        ))?;
    }
    Ok(End::Fine)
}

/// Runs an analysis that is not split, unless that was done.
fn whole(runner: &Run<'_>, work: &Work<'_>, count: &mut Count) -> Result<(), Failure> {
    let part = &runner.folder;
    if Outcome::read(part, work.name).is_some_and(|outcome| !outcome.failed) {
        count.kept += 1;
        return Ok(());
    }
    let folder = Outcome::folder(part, work.name);
    let of_work = part.join(work.name);
    inside(&of_work).map_err(|e| cannot(&of_work, &e))?;
    let _ = fs::remove_dir_all(&of_work);
    fs::create_dir_all(&folder).map_err(|e| cannot(&folder, &e))?;
    let own = Run::new(runner.language, runner.study, folder, None);
    let failed = match own.attempt(work.name, work.analysis, &mut Out::nowhere()) {
        Ok(()) => false,
        Err(failure) => {
            let Some(text) = failure.text() else {
                return Err(failure);
            };
            Out::error().text(&text)?;
            count.failed += 1;
            true
        }
    };
    if let Some(outcome) = Outcome::of(&own, failed) {
        outcome.keep(part, work.name)?;
    }
    count.computed += 1;
    Ok(())
}

/// Solves the pieces of a map that are still missing.
fn of_map(
    runner: &Run<'_>,
    name: &str,
    number: usize,
    map: &Pieces<'_>,
    own: Vec<usize>,
    count: &mut Count,
) -> Result<(), Failure> {
    if own.is_empty() {
        return Ok(());
    }
    let path = piece_file(&runner.folder, name, number);
    let parent = path.parent().unwrap_or(&runner.folder);
    inside(parent).map_err(|e| cannot(parent, &e))?;
    let (mut file, found) = PieceFile::reopen(path.clone()).map_err(|e| cannot(&path, &e))?;
    let missing = own
        .iter()
        .filter(|piece| found.iter().all(|(there, _)| there != *piece));
    let missing: Vec<usize> = missing.copied().collect();
    count.kept += own.len() - missing.len();
    runner
        .runner(name)
        .evaluate(&map.plan.built, &map.plan.points, &missing, &Bits::of, &mut |piece| {
            file.append(&piece)?;
            count.computed += 1;
            Ok(())
        })
}
