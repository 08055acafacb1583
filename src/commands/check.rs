//! `check`: reads, resolves and builds; reports all errors.

mod json;

use std::collections::BTreeSet;

use gearloss_framework::coefficients::changed_from_source;
use gearloss_framework::document::{Sources, did_you_mean, read_yaml};
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::files::{LONGEST_TEXT, read_text};
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::registry::Evidence;
use gearloss_framework::transmission::Transmission;
use gearloss_report::card::{card, stage_lines};
use gearloss_report::page::outside;
use gearloss_report::point::remarks;
use gearloss_studies::analysis::{Note, STATIC_SAFETY, evidence, merge, notes};

use super::set;
use crate::args::{CheckArgs, ChoiceArgs, Format};
use crate::output::{End, Failure, Out};

pub fn run(args: &CheckArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let deny = match &args.deny {
        Some(name) => Some(grade(name)?),
        None => None,
    };
    if args.format == Format::Json {
        return json::run(language, args, deny, out);
    }
    let mut wrong = String::new();
    let mut shown = BTreeSet::new();
    let mut end = End::Fine;
    for file in &args.files {
        if is_study(file) {
            belongs_to_gearboxes(args, file)?;
            let looked = super::run::look_over(language, file);
            for findings in &looked.warnings {
                for warning in &findings.list {
                    out.text(&format!("{}\n\n", findings.sources.render(warning)))?;
                }
            }
            if looked.refused.is_empty() {
                out.line(format!("{}: fine", file.display()))?;
            }
            for note in &looked.notes {
                out.line(format!("  note: {note}"))?;
            }
            for failure in looked.refused {
                match failure.text() {
                    Some(text) => wrong.push_str(&text),
                    None => return Err(failure),
                }
            }
            continue;
        }
        match gearbox(language, file, &args.choice, args.resolved) {
            Ok((text, weakest)) => {
                out.text(&text)?;
                if deny.is_some_and(|deny| weakest.is_some_and(|w| w >= deny)) {
                    end = End::Finding;
                    out.line(format!(
                        "  error (--deny {}): a result depends on evidence of this grade or lower",
                        args.deny.as_deref().unwrap_or_default()
                    ))?;
                }
            }
            Err(findings) => wrong.push_str(&findings.render_new(&mut shown)),
        }
    }
    if wrong.is_empty() {
        Ok(end)
    } else {
        Err(Failure::Input(wrong))
    }
}

/// Rejects options that do not apply to a study.
fn belongs_to_gearboxes(args: &CheckArgs, file: &std::path::Path) -> Result<(), Failure> {
    let given = [
        ("--set", !args.choice.set.is_empty()),
        ("--models", args.choice.models.is_some()),
        ("--resolved", args.resolved),
        ("--deny", args.deny.is_some()),
    ];
    match given.into_iter().find(|(_, given)| *given) {
        Some((option, _)) => Err(Failure::input(
            format!("{option} does not apply to {}, which is a study", file.display()),
            format!("use {option} with its gearbox, or check the study without it"),
        )),
        None => Ok(()),
    }
}

/// Grades from highest to lowest.
const GRADES: [&str; 8] = [
    "several_sources",
    "derived",
    "one_source",
    "user",
    "recalled",
    "reconstructed",
    "disputed",
    "assumed",
];

/// The grade of a name.
pub fn grade(name: &str) -> Result<Evidence, Failure> {
    Evidence::of_name(name).ok_or_else(|| {
        let grades = GRADES.join(", ");
        let help = match did_you_mean(name, GRADES) {
            Some(close) => format!("write {close}; the grades are {grades}"),
            None => format!("write one of {grades}"),
        };
        Failure::input(format!("`{name}` is not an evidence grade"), help)
    })
}

/// Bearings with insufficient static safety at the rated torque and speed, in any gear, in drive and coast.
fn overloaded(t: &Transmission) -> Vec<Note> {
    let Some(rating) = t.rating else { return Vec::new() };
    let mut seen = Vec::new();
    for i in 0..t.states().len() {
        let Some(case) = t.case_at_reference(i) else { continue };
        let mut scratch = t.scratch(&case);
        let mut torques = vec![0.0; case.torque_ports.len()];
        for sign in [1.0, -1.0] {
            let Some(first) = torques.first_mut() else { continue };
            *first = sign * rating.torque;
            let point = Point {
                speeds: &[rating.speed],
                torques: &torques,
                flow: PowerFlow::Ideal,
                ..Point::default()
            };
            t.evaluate(&case, &point, &[t.oil_temperature], &mut scratch);
        }
        merge(&mut seen, &scratch.totals);
    }
    if seen.is_empty() {
        return Vec::new();
    }
    let safety = |note: &Note| note.name == STATIC_SAFETY;
    notes(t, &seen).into_iter().filter(safety).collect()
}

fn is_study(file: &std::path::Path) -> bool {
    let text = read_text(file, LONGEST_TEXT).unwrap_or_default();
    let node = read_yaml(0, &text).node;
    node.get("gearloss")
        .and_then(|n| n.text())
        .is_some_and(|kind| kind.starts_with("study"))
}

fn gearbox(
    language: &Language,
    file: &std::path::Path,
    choice: &ChoiceArgs,
    print: bool,
) -> Result<(String, Option<Evidence>), Findings> {
    let gearbox = Gearbox::read(language, file)?;
    gearbox.check_sets(language)?;
    let resolved = set::resolve(language, &gearbox, choice)?;
    let transmission = gearbox.build(language, &resolved)?;
    let known = evidence(&transmission, &resolved, &|path| gearbox.places.is_written(path));
    let weakest = known.first().map(|w| w.grade);
    let mut text = String::new();
    if print {
        match serde_saphyr::to_string(&language.readable(&resolved.value)) {
            Ok(yaml) => {
                text.push_str(&format!(
                    "# {} with all defaults, catalogue values and models; file names are relative to its folder\n",
                    file.display()
                ));
                // As comments, so that the output is a valid gearbox.
                for warning in &transmission.warnings {
                    for line in gearbox.sources.render(warning).lines() {
                        text.push_str(format!("# {line}").trim_end());
                        text.push('\n');
                    }
                }
                text.push_str(&yaml);
                // As comments, because they are not keys of a gearbox.
                text.push_str("# derived geometry\n");
                for stage in transmission.stages() {
                    text.push_str(&format!("# {}:\n", stage.mesh));
                    for figure in stage_lines(&stage) {
                        text.push_str(&format!("#   {figure}\n"));
                    }
                }
            }
            Err(e) => {
                let error = gearloss_framework::document::Diagnostic::error("", format!("cannot write YAML: {e}"));
                return Err(Findings {
                    list: vec![error],
                    sources: Sources::default(),
                });
            }
        }
        return Ok((text, weakest));
    }
    for warning in &transmission.warnings {
        text.push_str(&gearbox.sources.render(warning));
        text.push_str("\n\n");
    }
    let states: Vec<&str> = transmission.states().iter().map(|s| s.name.as_str()).collect();
    text.push_str(&format!(
        "{}: fine; {} components, gears: {}\n",
        file.display(),
        transmission.parts().len(),
        states.join(", ")
    ));
    text.push_str(&card(&transmission));
    for line in outside(&overloaded(&transmission)).lines() {
        let line = line.trim_start_matches("outside: ");
        text.push_str(&format!("  at the rated torque: {line}\n"));
    }
    for line in remarks(&resolved, &changed_from_source(&transmission, &resolved), &known) {
        text.push_str(&format!("  {line}\n"));
    }
    Ok((text, weakest))
}
