//! Every combination of the models of some mechanisms: ranked by a measurement, or the spread that they leave.

mod candidates;
mod marks;
mod pictures;
mod rank;
mod results;
mod spread;

use gearloss_numerics::inference::{PointSet, folds};
use gearloss_numerics::selection::{LossErrors, Losses, MeasuredLosses};
use gearloss_studies::analysis::{Given, GridResult, PointResult};
use gearloss_studies::measured::{Measured, Row, Seen};
use gearloss_studies::study::{Difference, Quantity, TournamentEntry};
use serde_json::{Value, json};

use self::candidates::Slot;
use super::super::solve::RPM;
use super::{Built, Runner, gear_of, grid_axes};
use crate::output::{Failure, Out, Table, number, significant};

/// The most combinations.
const MOST: usize = 200_000;

/// Points, what everything else loses there, and what each candidate loses.
struct Field<'a> {
    base: Built<'a>,
    gear: String,
    points: Vec<PointResult>,
    /// Loss of all parts that no mechanism of the tournament covers. \[W\]
    rest: Vec<f64>,
    slots: Vec<Slot>,
    /// What an error of one watt is at each point in the unit in which errors are printed; absent where the quantity does not exist, as an
    /// efficiency without torque.
    scale: Vec<Option<f64>>,
    /// Unit of errors, in words.
    unit: &'static str,
}

impl Field<'_> {
    /// Number of combinations.
    fn count(&self) -> usize {
        self.slots.iter().map(|s| s.candidates.len()).product()
    }

    /// Losses of all candidates.
    fn losses(&self) -> Losses<'_> {
        let mechanisms = self
            .slots
            .iter()
            .map(|slot| slot.candidates.iter().map(|c| c.loss.as_slice()).collect());
        Losses {
            rest: &self.rest,
            mechanisms: mechanisms.collect(),
        }
    }

    /// Names of the candidates of a combination.
    fn names(&self, places: &[usize]) -> Vec<&str> {
        self.slots
            .iter()
            .zip(places)
            .map(|(slot, place)| slot.candidates[*place].name.as_str())
            .collect()
    }

    /// Relative time of a combination: that of the base, with what each candidate adds to it.
    fn time(&self, places: &[usize]) -> f64 {
        let more = self
            .slots
            .iter()
            .zip(places)
            .map(|(slot, place)| slot.candidates[*place].time - 1.0);
        (1.0 + more.sum::<f64>()).max(0.0)
    }

    fn header(&self) -> Vec<String> {
        self.slots.iter().map(|s| s.name.clone()).collect()
    }
}

pub fn run(runner: &Runner<'_>, name: &str, entry: &TournamentEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    if entry.quantity == Quantity::Temperature {
        let message = "combinations are ranked by losses, not by temperature";
        return Err(runner.wrong(&format!("{path}.quantity"), message, "write `quantity: loss`"));
    }
    if let Some(errors) = entry.errors {
        let both = [errors.percent, errors.absolute];
        if both.iter().all(Option::is_none) || both.iter().flatten().any(|x| *x <= 0.0) {
            let message = "accuracies of losses are above zero, and one at least is stated";
            let mend = "write `{ percent: 2, absolute: 5 W }`, or one of the two";
            return Err(runner.wrong(&format!("{path}.errors"), message, mend));
        }
    }
    if let Some(f) = entry.factors.filter(|f| f.least >= f.greatest) {
        let message = format!("factors from {} to {} leave no room", f.least, f.greatest);
        return Err(runner.wrong(
            &format!("{path}.factors"),
            message,
            "write `{ least: 0.5, greatest: 2 }`",
        ));
    }
    let Some(base) = runner.built(gearbox, entry.model_set.as_slice())?.pop() else {
        return Ok(());
    };
    let t = &base.transmission;
    match (&entry.grid, &entry.data) {
        (Some(grid_name), None) => {
            let of_data = [
                entry.factors.is_some(),
                entry.gear.is_some(),
                entry.errors.is_some(),
                entry.correlation.is_some(),
            ];
            if of_data.contains(&true) {
                let message = "`factors`, `gear`, `errors` and `correlation` belong to `data`";
                return Err(runner.wrong(&path, message, "leave them out, or give `data`"));
            }
            let grid = runner.study.grid(&path, grid_name)?;
            let gear = &runner.one_gear(&path, grid, t)?;
            if !grid.bind.is_empty() || grid.envelope.is_some() {
                let message = "a tournament takes a grid without bound values and envelope";
                return Err(runner.wrong(&path, message, "give it a grid of its own"));
            }
            let own = grid_axes(runner, grid_name, grid, t)?;
            let points = runner.points(t, gear, own.0.clone(), own.1.clone());
            if runner.checked(&base, &points)? {
                return candidates::slots(runner, &path, entry, &base, (&points, &GridResult::default())).map(|_| ());
            }
            let field = field(runner, &path, entry, base, &points, out, name)?;
            if field.scale.iter().any(Option::is_none) {
                let message = "an efficiency, or a loss torque, needs speed and torque at every point";
                let mend = "leave zero out, or write `quantity: loss`";
                return Err(runner.wrong(&path, message, mend));
            }
            spread::show(runner, name, entry, gear, &own, &field, out)
        }
        (None, Some(data)) => {
            let measured = runner.read_at_ports(&format!("{path}.data"), data, &[])?;
            for note in &measured.notes {
                out.line(format!("{name}: {}: {note}", runner.data(&path, data)?.file))?;
            }
            let gear = gear_of(entry.gear.as_deref(), t).to_owned();
            let (rows, mut list) = rows(runner, &path, &measured, &gear, out)?;
            if runner.checked(&base, &runner.listed(t, &gear, Vec::new()))? {
                let points = runner.listed(t, &gear, Vec::new());
                return candidates::slots(runner, &path, entry, &base, (&points, &GridResult::default())).map(|_| ());
            }
            if !measured.rig.is_silent() {
                // The speeds tell what the rig adds; the rest of the torque is left for the transmission.
                let solved = runner.solve(&base, &runner.listed(t, &gear, list.clone()))?;
                for (given, p) in list.iter_mut().zip(solved.points) {
                    let added = measured.rig.added([p.reference_speed, p.output_speed.unwrap_or(0.0)]);
                    given.torque -= added[usize::from(!p.at_reference)];
                }
            }
            let points = runner.listed(t, &gear, list);
            let field = field(runner, &path, entry, base, &points, out, name)?;
            let seen = measurements(runner, &path, entry, (&measured, &rows), &field)?;
            for line in &seen.notes {
                out.line(format!("{name}: {line}"))?;
            }
            rank::show(runner, name, entry, &gear, &seen, &field, out)
        }
        _ => Err(runner.wrong(
            &path,
            "a tournament needs either `data` or `grid`",
            "give measured points under `data`, or a `grid` for the spread of the models",
        )),
    }
}

/// The measured points.
struct Measurements {
    /// \[Nm\]
    torques: Vec<f64>,
    /// \[rad/s\]
    speeds: Vec<f64>,
    losses: MeasuredLosses,
    /// What a reader should know of their accuracy.
    notes: Vec<String>,
}

impl Measurements {
    /// Accuracy of a point in the unit in which errors are printed.
    fn accuracy(&self, i: usize) -> Option<f64> {
        Some(self.losses.units[i]? * self.losses.deviations[i])
    }
}

/// The rows in the gear state of the analysis.
fn rows<'r>(
    runner: &Runner<'_>,
    path: &str,
    measured: &'r Measured,
    gear: &str,
    out: &mut Out,
) -> Result<(Vec<&'r Row>, Vec<Given>), Failure> {
    let own = |row: &&Row| row.gear.as_deref().is_none_or(|g| g == gear);
    let rows: Vec<&Row> = measured.rows.iter().filter(own).collect();
    let others = measured.rows.len() - rows.len();
    if others > 0 {
        out.line(format!("{others} points of other gear states are left out"))?;
    }
    if rows.len() < 3 {
        let message = format!("{} points in gear `{gear}` rank nothing", rows.len());
        return Err(runner.wrong(&format!("{path}.data"), message, "name the gear state under `gear`"));
    }
    let given = |row: &&Row| Given {
        torque: measured.value(row, "torque").unwrap_or(0.0),
        speed: measured.value(row, "speed").unwrap_or(0.0),
        oil: measured.value(row, "oil_temperature"),
    };
    let list = rows.iter().map(given).collect();
    Ok((rows, list))
}

/// Measured losses beside the solved points, with the accuracy of each.
fn measurements(
    runner: &Runner<'_>,
    path: &str,
    entry: &TournamentEntry,
    (measured, rows): (&Measured, &[&Row]),
    field: &Field<'_>,
) -> Result<Measurements, Failure> {
    let (mut losses, mut stated) = (Vec::new(), Vec::new());
    for (row, point) in rows.iter().zip(&field.points) {
        let seen = Seen::of(measured, row, point);
        let Some(loss) = seen.loss else {
            let message = format!("{}: no measured loss follows", measured.origin(row));
            let mend = "give the loss, the loss torque, the efficiency, or torque and speed at both ports";
            return Err(runner.wrong(&format!("{path}.data"), message, mend));
        };
        losses.push(loss);
        stated.push(seen.accuracy(Quantity::Loss).filter(|a| *a > 0.0));
    }
    let lacking = stated.iter().filter(|a| a.is_none()).count();
    let errors = entry.errors.map(|errors| LossErrors {
        percent: errors.percent.unwrap_or(0.0),
        absolute: errors.absolute.unwrap_or(0.0),
    });
    let (errors, word) = match errors {
        Some(errors) => (errors, "stated under `errors`"),
        None => (LossErrors::assumed(&losses), "assumed: state them under `errors`"),
    };
    let mut notes = Vec::new();
    if lacking > 0 {
        notes.push(format!(
            "{lacking} of {} points have no accuracy in the file: {} % of the loss and {} W, as standard deviations that add as squares, \
             {word}",
            losses.len(),
            significant(errors.percent),
            significant(errors.absolute)
        ));
    } else if entry.errors.is_some() {
        notes.push("the file states the accuracy of every point, so `errors` is not used".to_owned());
    }
    let deviations: Vec<f64> = losses
        .iter()
        .zip(&stated)
        .map(|(loss, a)| a.unwrap_or_else(|| errors.standard_deviation(*loss)))
        .collect();
    if let Some(i) = deviations.iter().position(|d| !(*d > 0.0 && d.is_finite())) {
        let message = format!(
            "line {}: the accuracy of a loss of {} W is zero",
            rows[i].line, losses[i]
        );
        let mend = "state an absolute accuracy too: `errors: { percent: 2, absolute: 5 W }`";
        return Err(runner.wrong(&format!("{path}.errors"), message, mend));
    }
    let torques: Vec<f64> = field.points.iter().map(|p| p.torque).collect();
    let speeds: Vec<f64> = field.points.iter().map(|p| p.speed).collect();
    let oils: Vec<f64> = field.points.iter().map(|p| p.oil.unwrap_or(0.0)).collect();
    let groups = folds(&torques, entry.folds as usize);
    let groups = groups
        .map_err(|reason| runner.wrong(&format!("{path}.data"), reason, "give points at two torques at least"))?;
    let without = field.scale.iter().filter(|s| s.is_none()).count();
    if without > 0 {
        let what = entry.quantity.words(Difference::Points).0;
        notes.push(format!(
            "{without} points have no {what}: they count by their loss, but not in the errors that are printed in {}",
            field.unit
        ));
    }
    let measured = MeasuredLosses {
        losses,
        deviations,
        weights: rows
            .iter()
            .map(|row| measured.value(row, "weight").unwrap_or(1.0))
            .collect(),
        units: field.scale.clone(),
        folds: groups.into_iter().map(|fold| fold.points).collect(),
        points: PointSet::default(),
    };
    Ok(Measurements {
        losses: measured.with_conditions(&torques, &speeds, &oils),
        torques,
        speeds,
        notes,
    })
}

fn field<'a>(
    runner: &'a Runner<'_>,
    path: &str,
    entry: &TournamentEntry,
    base: Built<'a>,
    points: &gearloss_studies::analysis::Points,
    out: &mut Out,
    name: &str,
) -> Result<Field<'a>, Failure> {
    let mut points = points.clone();
    // A measured temperature counts where the model does not find its own.
    if base.transmission.thermal_mode != gearloss_framework::description::ThermalMode::Fixed
        && let gearloss_studies::analysis::Field::List(list) = &mut points.field
    {
        for given in list {
            given.oil = None;
        }
    }
    let solved = runner.solve(&base, &points)?;
    // Every model loses at the temperatures of the set, else losses could not be added.
    points.field = gearloss_studies::analysis::Field::List(
        solved
            .points
            .iter()
            .map(|p| Given {
                torque: p.torque,
                speed: p.speed,
                oil: p.oil,
            })
            .collect(),
    );
    let (slots, left_out) = candidates::slots(runner, path, entry, &base, (&points, &solved))?;
    if let Some(p) = solved.points.iter().find(|p| p.loss.is_none()) {
        let message = format!(
            "the set itself has no loss at {} Nm, {:.0} rpm",
            p.torque,
            p.speed * RPM
        );
        return Err(runner.wrong(path, message, "choose a set that has one at every point"));
    }
    let rest = solved.points.iter().map(|p| {
        let own = base.transmission.parts().iter().zip(&p.parts);
        own.filter(|(part, _)| !slots.iter().any(|s| s.covers(part)))
            .map(|(_, w)| w)
            .sum()
    });
    let rest: Vec<f64> = rest.collect();
    let scale = |p: &PointResult| match entry.quantity {
        Quantity::Efficiency => 100.0 / (p.torque * p.torque_speed).abs(),
        Quantity::LossTorque => 1.0 / p.reference_speed.abs(),
        Quantity::Loss | Quantity::Temperature => 1.0,
    };
    let scale = |p: &PointResult| Some(scale(p)).filter(|s| s.is_finite());
    let unit = entry.quantity.words(Difference::Points).1;
    let field = Field {
        scale: solved.points.iter().map(scale).collect(),
        gear: points.gear,
        points: solved.points,
        rest,
        slots,
        unit,
        base,
    };
    let counts: Vec<String> = field
        .slots
        .iter()
        .map(|s| format!("{} {}", s.candidates.len(), s.name))
        .collect();
    out.line(format!(
        "{name}: {} = {} combinations",
        counts.join(" x "),
        field.count()
    ))?;
    for line in left_out {
        out.line(format!("left out: {line}"))?;
    }
    if field.count() > MOST {
        let message = format!("{} combinations are more than {MOST}", field.count());
        let mend = "name those that take part: `mechanisms: [{ mechanism: bearing, models: { skf: { type: skf } } }]`; without names every \
                    model takes part with every model that it takes";
        return Err(runner.wrong(path, message, mend));
    }
    let mut table = Table::new(&["mechanism", "model", "mean loss W", "time over that of the set"]);
    for slot in &field.slots {
        for candidate in &slot.candidates {
            let mean = candidate.loss.iter().sum::<f64>() / candidate.loss.len() as f64;
            table.row(vec![
                slot.name.clone(),
                candidate.name.clone(),
                number(Some(mean), 3),
                number(Some(candidate.time), 2),
            ]);
        }
    }
    out.text(&table.render())?;
    out.line("")?;
    Ok(field)
}

/// Unit of errors, as in comparisons.
fn unit(entry: &TournamentEntry) -> &'static str {
    entry.quantity.unit(Difference::Points)
}

/// The slots with their candidates, for JSON.
fn json_of(field: &Field<'_>) -> Value {
    let slot = |s: &Slot| {
        let candidates = s
            .candidates
            .iter()
            .map(|c| json!({ "name": c.name, "model": c.model, "losses_w": c.loss, "outside": c.marks.iter().map(|m| &m.words).collect::<Vec<_>>() }));
        json!({ "mechanism": s.name, "candidates": candidates.collect::<Vec<_>>() })
    };
    Value::Array(field.slots.iter().map(slot).collect())
}
