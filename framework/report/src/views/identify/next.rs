//! Proposed measurements as text.

use gearloss_numerics::design::Choice;
use gearloss_studies::analyses::identify::next::Next;
use gearloss_studies::analyses::identify::{IdentificationOfSet, RuleEntry};
use gearloss_studies::numbers::RPM;

use super::short;
use crate::page::Page;
use crate::text::{TextTable, fixed};

pub(super) fn show(name: &str, o: &IdentificationOfSet, page: &mut Page) {
    let next = match &o.found.next {
        None => return,
        Some(Err(reason)) => {
            return page.line(format!("no measurements can be proposed: {reason}"));
        }
        Some(Ok(next)) => next,
    };
    let plan = &next.plan.plan;
    let worst = |deviations: &[f64]| {
        let place = (0..deviations.len()).max_by(|a, b| deviations[*a].total_cmp(&deviations[*b]))?;
        let parameter = &o.found.parameters[next.plan.parameters[place]];
        Some((parameter.name.clone(), deviations[place]))
    };
    let rule = match next.rule {
        RuleEntry::Worst => "the widest interval relative to its range",
        RuleEntry::Trace => "the sum of the variances relative to the squared ranges",
        RuleEntry::Determinant => "the volume of the joint region",
    };
    page.line(format!(
        "proposed measurements in gear `{}`, chosen to reduce {rule}:",
        next.gear
    ));
    page.table(table(next));
    if let (Some((before, was)), Some((after, will))) = (worst(&plan.before.deviations), worst(&plan.after.deviations))
    {
        let half = |deviation: f64| short(100.0 * 1.96 * deviation);
        page.verdict(format!(
            "{name}: {} more points would narrow the widest interval, that of `{before}`, +-{} % of its range, to +-{} % \
             (then `{after}`)",
            next.count,
            half(was),
            half(will)
        ));
    }
}

/// The points in order; a repeated point is one row.
fn table(next: &Next) -> TextTable {
    let mut table = TextTable::new(&[
        "measure",
        "torque Nm",
        "speed rpm",
        "oil degC",
        "gain",
        "depends on the parameters",
    ]);
    let mut place = 0;
    let same = |a: &Choice, b: &Choice| a.candidate == b.candidate;
    for group in next.plan.plan.choices.chunk_by(same) {
        let choice = &group[0];
        let at = &next.candidates[choice.candidate];
        let first = place + 1;
        place += group.len();
        let measure = if group.len() == 1 {
            first.to_string()
        } else {
            format!("{first} to {place}")
        };
        let lacking = next.plan.lacking.iter().find(|(c, _)| *c == choice.candidate);
        table.row(vec![
            measure,
            short(at.torque),
            fixed(at.speed * RPM, 0),
            at.oil.map_or_else(|| "-".to_owned(), short),
            short(choice.gain),
            lacking.map_or_else(
                || "no".to_owned(),
                |(_, count)| format!("absent from {count} of {} plans", next.plan.others),
            ),
        ]);
    }
    table
}
