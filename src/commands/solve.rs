//! `solve`: one operating point with the loss of each component, sums and efficiency, and their derivatives.

use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::registry::Evidence;
use gearloss_report::point::{PointRecord, derivatives_text, point_text, ratings_text, remarks};
use gearloss_studies::points::{Derived, Variable};

use super::point::prepare;
use super::{set, warn};
use crate::args::{Format, SolveArgs};
use crate::output::{End, Failure, Out};

pub fn run(args: &SolveArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let gearbox = Gearbox::read(language, &args.gearbox)?;
    let resolved = set::resolve(language, &gearbox, &args.choice)?;
    let transmission = gearbox.build(language, &resolved)?;
    warn(&gearbox, &transmission)?;
    let prepared = prepare(&args.point, &gearbox, &transmission)?;
    let mut scratch = transmission.scratch(&prepared.case);
    let solved = prepared.solve(&transmission, &mut scratch);
    let mut record = PointRecord::new(language, (&gearbox, &resolved, &transmission), &prepared, &solved)?;
    let choice = set::choice(&args.choice)?;
    let derived = Derived {
        language,
        gearbox: &gearbox,
        choice: &choice,
        resolved: &resolved,
        transmission: &transmission,
        prepared: &prepared,
    };
    for text in &args.derivative {
        let variable = Variable::from(text.as_str());
        let found = derived.over(&variable);
        let found = found.map_err(|findings| set::at_option("--derivative", text, findings))?;
        record.derivatives.push(found);
    }
    match args.format {
        Format::Json => out.json(&record)?,
        Format::Table => {
            out.text(&point_text(&transmission, &prepared, &solved))?;
            let text = ratings_text(&record.ratings);
            if !text.is_empty() {
                out.text(&format!("{text}\n"))?;
            }
            for derivatives in &record.derivatives {
                out.text(&derivatives_text(derivatives))?;
            }
            for line in remarks(&resolved, &record.changed_from_source, &record.evidence) {
                out.line(line)?;
            }
        }
    }
    let mut end = if solved.solution.is_complete() && solved.found.is_sound() {
        End::Fine
    } else {
        End::Finding
    };
    for what in &args.deny {
        let denied = if what == "extrapolation" {
            solved.notes.iter().any(|n| n.outside > 0)
        } else {
            let grade = Evidence::of_name(what)?;
            record.evidence.first().is_some_and(|w| w.grade >= grade)
        };
        if denied {
            let reason = if what == "extrapolation" {
                "a model is used outside its stated range"
            } else {
                "the result depends on evidence of this grade or lower"
            };
            out.line(format!("error (--deny {what}): {reason}"))?;
            end = End::Finding;
        }
    }
    Ok(end)
}
