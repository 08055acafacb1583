//! Combinations ranked by how well they predict measured losses, over their accuracy; the winner, and those that are not told from it.

use gearloss_numerics::inference::{Decision, VISIBLE};
use gearloss_numerics::selection::{Bounds, Combination, Shortlist, Standing, Winner, rank, shortlist, winner};
use gearloss_studies::analysis::Statistics;
use gearloss_studies::study::TournamentEntry;

use super::super::Runner;
use super::{Field, Measurements, pictures, results};
use crate::interrupt;
use crate::output::{Failure, Out, Table, number};

/// A ranking with what follows from it.
pub struct Outcome {
    pub ranked: Vec<Combination>,
    pub winner: Winner,
    pub shortlist: Shortlist,
    /// Root mean square of the accuracies, in the unit in which errors are printed.
    pub accuracy: Option<f64>,
}

impl Outcome {
    /// Weight of a combination by its place; absent where it is not on the shortlist.
    pub fn weight(&self, place: usize) -> Option<f64> {
        let member = self.shortlist.members.iter().position(|own| *own == place)?;
        self.shortlist.weights.get(member).copied()
    }
}

/// What speaks against a combination, in words: stated ranges that a model left, and factors on a bound.
pub fn marks(field: &Field<'_>, c: &Combination) -> Vec<String> {
    let ranges = field.slots.iter().zip(&c.places).flat_map(|(slot, place)| {
        let candidate = &slot.candidates[*place];
        let words = |mark: &super::marks::Mark| format!("{} {}: {}", slot.name, candidate.name, mark.words);
        candidate.marks.iter().map(words)
    });
    let bounds = c
        .on_bound
        .iter()
        .map(|k| format!("{}: factor {:.2} on a bound", field.slots[*k].name, c.factors[*k]));
    ranges.chain(bounds).collect()
}

/// The same for a column of a table.
fn short_marks(field: &Field<'_>, c: &Combination) -> String {
    let mut list: Vec<String> = Vec::new();
    for (slot, place) in field.slots.iter().zip(&c.places) {
        let names: Vec<&str> = slot.candidates[*place].marks.iter().map(|mark| mark.name).collect();
        if !names.is_empty() {
            list.push(format!("{}: range of {}", slot.name, names.join(", ")));
        }
    }
    list.extend(c.on_bound.iter().map(|k| format!("{}: bound", field.slots[*k].name)));
    list.join("; ")
}

/// Bounds of the factors.
pub fn bounds(entry: &TournamentEntry) -> Bounds {
    entry.factors.map(|f| [f.least, f.greatest])
}

pub fn show(
    runner: &Runner<'_>,
    name: &str,
    entry: &TournamentEntry,
    gear: &str,
    rows: &Measurements,
    field: &Field<'_>,
    out: &mut Out,
) -> Result<(), Failure> {
    let measured = &rows.losses;
    let fewest = measured
        .folds
        .iter()
        .map(|fold| measured.len() - fold.len())
        .min()
        .unwrap_or(0);
    if entry.factors.is_some() && fewest < field.slots.len() {
        let message = format!(
            "{fewest} points outside of a group cannot fit {} factors",
            field.slots.len()
        );
        let mend = "give more points, or fewer mechanisms";
        return Err(runner.wrong(&format!("analyses.{name}.data"), message, mend));
    }
    let losses = field.losses();
    let bar = runner.bar(field.count() as u64, name);
    let going = || {
        bar.inc(1);
        !interrupt::pressed()
    };
    let ranked = rank(&losses, measured, bounds(entry), &going);
    bar.finish_and_clear();
    if interrupt::pressed() {
        return Err(Failure::Interrupted);
    }
    let unranked = field.count() - ranked.len();
    if unranked > 0 {
        let line = format!("{unranked} combinations could not be fitted, or have no point that counts");
        out.line(line)?;
    }
    let is_marked = |c: &Combination| !marks(field, c).is_empty();
    let Some(winner) = winner(&ranked, &is_marked, &losses, measured, entry.correlation) else {
        let message = "no combination can be ranked by these points";
        let mend = "give points with a weight above zero, or wider bounds of the factors";
        return Err(runner.wrong(&format!("analyses.{name}.data"), message, mend));
    };
    let shortlist = shortlist(&ranked, &winner, &losses, measured);
    let stated = (0..measured.len()).filter_map(|i| Some((rows.accuracy(i)?, measured.weights[i])));
    let o = Outcome {
        accuracy: Statistics::weighted(stated).map(|s| s.rms),
        ranked,
        winner,
        shortlist,
    };
    table(name, entry, field, &o, out)?;
    summary(runner, name, entry, (rows, field), &o, out)?;
    out.line(added_up(runner, field, &o.ranked[o.winner.place])?)?;
    out.line("")?;
    results::write_all(runner, name, entry, gear, (rows, field), &o)?;
    pictures::write_all(runner, name, entry, (rows, field), &o)
}

/// What follows from the ranking.
fn summary(
    runner: &Runner<'_>,
    name: &str,
    entry: &TournamentEntry,
    (rows, field): (&Measurements, &Field<'_>),
    o: &Outcome,
    out: &mut Out,
) -> Result<(), Failure> {
    out.line(format!(
        "{name}: {} points in {} groups of neighbouring torques; errors over the accuracy of the loss, and in {}: the ranking is the \
         same in every unit",
        rows.losses.len(),
        rows.losses.folds.len(),
        field.unit
    ))?;
    let how = if o.winner.is_estimated {
        "estimated from the residuals of the best"
    } else {
        "stated"
    };
    out.line(format!(
        "{name}: correlation of the errors of any two points {:.2} ({how}), variance {:.2} times the stated one; the set of points sees \
         predictions that are {:.1} standard deviations of the set apart",
        o.winner.errors.correlation,
        o.winner.errors.variance,
        VISIBLE.sqrt()
    ))?;
    runner.verdict(format!("{name}: {}", verdict(entry, field, o)), out)?;
    let list = &o.shortlist;
    if list.members.len() < 2 {
        return Ok(());
    }
    let mut order: Vec<usize> = (0..list.members.len()).collect();
    order.sort_by(|a, b| list.weights[*b].total_cmp(&list.weights[*a]));
    let largest: Vec<String> = order
        .iter()
        .take(3)
        .map(|k| {
            format!(
                "{:.2} {}",
                list.weights[*k],
                field.names(&o.ranked[list.members[*k]].places).join(", ")
            )
        })
        .collect();
    let spread = |i: usize| Some(100.0 * list.deviations[i] / list.means[i]).filter(|x| x.is_finite());
    let range =
        |i: usize| Some(50.0 * (list.ranges[i][1] - list.ranges[i][0]) / list.means[i]).filter(|x| x.is_finite());
    let rms =
        |list: &dyn Fn(usize) -> Option<f64>| Statistics::of((0..rows.losses.len()).filter_map(list)).map(|s| s.rms);
    let sentence = format!(
        "{name}: the shortlist of {} spreads by {} % of the loss (weighted standard deviation, root mean square over the points; half of \
         the distance between its extremes {} %); largest weights: {}",
        list.members.len(),
        number(rms(&spread), 2),
        number(rms(&range), 2),
        largest.join("; ")
    );
    runner.verdict(sentence, out)
}

/// The winner, whether it is marked, and how many are not told from it.
fn verdict(entry: &TournamentEntry, field: &Field<'_>, o: &Outcome) -> String {
    let names = |place: usize| field.names(&o.ranked[place].places).join(", ");
    let error = |place: usize| {
        let c = &o.ranked[place];
        let printed = c
            .printed
            .map_or_else(String::new, |p| format!(" ({:.3} {} rms)", p.predicted, field.unit));
        format!("{:.2} times the accuracy{printed}", c.predicted)
    };
    let how = if entry.factors.is_some() {
        "predicted with factors from the other groups"
    } else {
        "nothing fitted"
    };
    let chosen = o.winner.place;
    let mut sentence = format!("best: {}, {how}, errors {}", names(chosen), error(chosen));
    match (o.winner.unmarked, o.winner.best_against_unmarked) {
        (None, _) => sentence.push_str(&format!(
            "; it is marked ({}), as every combination is",
            short_marks(field, &o.ranked[chosen])
        )),
        (Some(unmarked), Some(standing)) if chosen == 0 => sentence.push_str(&format!(
            "; it is marked ({}), but decidedly better than the best without a mark, {}, errors {}: {}",
            short_marks(field, &o.ranked[0]),
            names(unmarked),
            error(unmarked),
            ratio(&standing)
        )),
        (Some(_), Some(standing)) => sentence.push_str(&format!(
            "; the smallest errors of all, {}, are those of {}, which is marked ({}) and not decidedly better: {}",
            error(0),
            names(0),
            short_marks(field, &o.ranked[0]),
            ratio(&standing)
        )),
        (Some(_), None) => {}
    }
    let others = o.shortlist.members.len() - 1;
    sentence
        + &if others == 0 {
            format!("; it is decidedly better than all {} others", o.ranked.len() - 1)
        } else {
            format!(
                "; {others} of the {} other combinations are not distinguishable from it",
                o.ranked.len() - 1
            )
        }
}

/// A standing in words.
fn ratio(standing: &Standing) -> String {
    let folds = standing.folds.map_or_else(
        || "too few groups to compare".to_owned(),
        |p| {
            let [low, high] = p.interval;
            format!(
                "errors {:.2} times as large (95 % {low:.2} to {high:.2}), smaller in {} of {} groups",
                p.ratio, p.won, p.folds
            )
        },
    );
    format!(
        "{folds}, predictions {:.1} standard deviations of the set apart",
        standing.separation.square.sqrt()
    )
}

/// How far losses that were added are from the combination solved as a whole.
fn added_up(runner: &Runner<'_>, field: &Field<'_>, c: &Combination) -> Result<String, Failure> {
    let mut resolved = field.base.resolved.clone();
    for (slot, place) in field.slots.iter().zip(&c.places) {
        let candidate = &slot.candidates[*place];
        resolved = slot
            .with(runner.language, &resolved, &candidate.model)
            .map_err(|reason| Failure::input(reason, "report this"))?;
    }
    let transmission = field.base.gearbox.build(runner.language, &resolved)?;
    let list = field.points.iter().map(|p| gearloss_studies::analysis::Given {
        torque: p.torque,
        speed: p.speed,
        oil: p.oil,
    });
    let gear = field.gear.clone();
    let points = runner.listed(&transmission, &gear, list.collect());
    let solved = gearloss_studies::analysis::run_grid(&transmission, &points, &|_| !interrupt::pressed());
    let solved = solved.map_err(|list| Failure::from(field.base.gearbox.findings(list)))?;
    let solved = solved.ok_or(Failure::Interrupted)?;
    let added = field.losses().all(&c.places, &vec![1.0; c.places.len()]);
    let gap = solved
        .points
        .iter()
        .zip(&added)
        .filter_map(|(p, added)| Some(100.0 * (added - p.loss?) / p.loss?))
        .fold(0.0_f64, |worst, gap| if gap.abs() > worst.abs() { gap } else { worst });
    Ok(format!(
        "losses are added, each mechanism at the torques of the set: for the best combination that is {gap:.3} % of the loss off at most"
    ))
}

fn table(name: &str, entry: &TournamentEntry, field: &Field<'_>, o: &Outcome, out: &mut Out) -> Result<(), Failure> {
    out.line(format!(
        "{name}: the combinations with the smallest errors; * the winner, = not distinguishable from it; errors in {}",
        field.unit
    ))?;
    let mut head: Vec<String> = vec!["rank".to_owned()];
    head.extend(field.header());
    head.extend(
        [
            "over accuracy",
            "predicted rms",
            "worst group",
            "fitted rms",
            "mean",
            "time",
        ]
        .map(str::to_owned),
    );
    if entry.factors.is_some() {
        head.push("factors".to_owned());
    }
    head.extend(["weight", "marks"].map(str::to_owned));
    let mut table = Table::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
    let mut shown: Vec<usize> = (0..o.ranked.len().min(entry.shown as usize)).collect();
    // The winner is shown wherever it is.
    if !shown.contains(&o.winner.place) {
        shown.push(o.winner.place);
    }
    let mut words: Vec<String> = Vec::new();
    for i in shown {
        let c = &o.ranked[i];
        let mark = match o.winner.standings[i].decision {
            _ if i == o.winner.place => "*",
            Decision::Better => "",
            Decision::Worse | Decision::NotDecided => "=",
        };
        let mut row = vec![format!("{}{mark}", i + 1)];
        row.extend(field.names(&c.places).into_iter().map(str::to_owned));
        row.push(number(Some(c.predicted), 2));
        let printed = c.printed.map(|p| [p.predicted, p.worst, p.fitted, p.mean]);
        row.extend((0..4).map(|k| number(printed.map(|p| p[k]), 3)));
        row.push(number(Some(field.time(&c.places)), 2));
        if entry.factors.is_some() {
            row.push(
                c.factors
                    .iter()
                    .map(|f| format!("{f:.2}"))
                    .collect::<Vec<_>>()
                    .join(" "),
            );
        }
        row.push(number(o.weight(i), 2));
        row.push(short_marks(field, c));
        table.row(row);
        for line in marks(field, c) {
            if !words.contains(&line) {
                words.push(line);
            }
        }
    }
    out.text(&table.render())?;
    for line in words {
        out.line(format!("mark: {line}"))?;
    }
    Ok(())
}
