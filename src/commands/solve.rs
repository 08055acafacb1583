//! `solve`: one operating point with the loss of each component, sums and efficiency, and their derivatives.

use gearloss_framework::coefficients::changed_from_source;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::registry::Evidence;
use gearloss_report::point::{derivatives_text, point_json, point_text, ratings_text, remarks};
use gearloss_studies::points::{Derived, Variable, evidence};
use gearloss_studies::ratings::rated;
use serde_json::json;

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
    let ratings = gearbox.ratings(language, &resolved, &transmission)?;
    let ratings = rated(&ratings, &transmission, &solved.solution);
    let known = evidence(&transmission, &resolved, &|path| gearbox.places.is_written(path));
    let changed = changed_from_source(&transmission, &resolved);
    let choice = set::choice(&args.choice)?;
    let derived = Derived {
        language,
        gearbox: &gearbox,
        choice: &choice,
        resolved: &resolved,
        transmission: &transmission,
        prepared: &prepared,
    };
    let mut derivatives = Vec::new();
    for text in &args.derivative {
        let variable = Variable::from(text.as_str());
        let found = derived.over(&variable);
        derivatives.push(found.map_err(|findings| set::at_option("--derivative", text, findings))?);
    }
    match args.format {
        Format::Json => {
            let packages = language.registry().packages();
            let mut value = point_json(&transmission, &prepared, &solved, packages);
            value["ratings"] = json!(ratings);
            value["evidence"] = json!(known);
            value["unreached"] = json!(resolved.unreached);
            value["changed_from_source"] = json!(changed);
            if !derivatives.is_empty() {
                value["derivatives"] = json!(derivatives);
            }
            out.json(&value)?;
        }
        Format::Table => {
            out.text(&point_text(&transmission, &prepared, &solved))?;
            let text = ratings_text(&ratings);
            if !text.is_empty() {
                out.text(&format!("{text}\n"))?;
            }
            for derivatives in &derivatives {
                out.text(&derivatives_text(derivatives))?;
            }
            for line in remarks(&resolved, &changed, &known) {
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
            known.first().is_some_and(|w| w.grade >= grade)
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
