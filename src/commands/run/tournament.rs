//! Every combination of the models of some mechanisms: ranked by a measurement, or the spread that they leave.

mod candidates;
mod rank;
mod spread;

use gearloss_framework::analysis::{Given, PointResult};
use gearloss_framework::measured::{Measured, Row, Seen};
use gearloss_framework::study::{Difference, Quantity, TournamentEntry};
use serde_json::{Value, json};

use self::candidates::Slot;
use super::super::solve::RPM;
use super::{Built, Runner, gear_of, grid_axes};
use crate::output::{Failure, Out, Table, number};

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
    /// What an error of one watt counts at each point.
    scale: Vec<f64>,
    /// Unit of errors, in words.
    unit: &'static str,
}

impl Field<'_> {
    /// Number of combinations.
    fn count(&self) -> usize {
        self.slots.iter().map(|s| s.candidates.len()).product()
    }

    /// The candidates of a combination by number: one place for each slot.
    fn combination(&self, mut number: usize) -> Vec<usize> {
        let mut places = vec![0; self.slots.len()];
        for (place, slot) in places.iter_mut().zip(&self.slots).rev() {
            *place = number % slot.candidates.len();
            number /= slot.candidates.len();
        }
        places
    }

    /// Loss of a combination at every point. \[W\]
    fn loss(&self, places: &[usize]) -> Vec<f64> {
        let mut loss = self.rest.clone();
        for (slot, place) in self.slots.iter().zip(places) {
            for (sum, own) in loss.iter_mut().zip(&slot.candidates[*place].loss) {
                *sum += own;
            }
        }
        loss
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
            if entry.factors.is_some() || entry.gear.is_some() {
                let message = "`factors` and `gear` belong to `data`";
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
                return candidates::slots(runner, &path, entry, &base, (&points, &[])).map(|_| ());
            }
            let field = field(runner, &path, entry, base, &points, out, name)?;
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
                return candidates::slots(runner, &path, entry, &base, (&points, &[])).map(|_| ());
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
            let seen = measurements(runner, &path, entry, &measured, &rows, &field)?;
            rank::show(runner, name, entry, &gear, &seen, &field, out)
        }
        _ => Err(runner.wrong(
            &path,
            "a tournament needs either `data` or `grid`",
            "give measured points under `data`, or a `grid` for the spread of the models",
        )),
    }
}

/// A measured point.
struct Measurement {
    /// \[Nm\]
    torque: f64,
    /// \[rad/s\]
    speed: f64,
    /// \[W\]
    loss: f64,
    /// In the unit of errors.
    accuracy: Option<f64>,
    /// How much it counts.
    weight: f64,
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

/// Measured losses beside the solved points.
fn measurements(
    runner: &Runner<'_>,
    path: &str,
    entry: &TournamentEntry,
    measured: &Measured,
    rows: &[&Row],
    field: &Field<'_>,
) -> Result<Vec<Measurement>, Failure> {
    let points = rows.iter().zip(&field.points);
    let seen = points.map(|(row, point)| {
        let seen = Seen::of(measured, row, point);
        let Some(loss) = seen.loss else {
            let message = format!("{}: no measured loss follows", measured.origin(row));
            let mend = "give the loss, the loss torque, the efficiency, or torque and speed at both ports";
            return Err(runner.wrong(&format!("{path}.data"), message, mend));
        };
        let points = if entry.quantity == Quantity::Efficiency {
            100.0
        } else {
            1.0
        };
        Ok(Measurement {
            torque: point.torque,
            speed: point.speed,
            loss,
            accuracy: seen.accuracy(entry.quantity).map(|a| points * a),
            weight: measured.value(row, "weight").unwrap_or(1.0),
        })
    });
    seen.collect()
}

fn field<'a>(
    runner: &'a Runner<'_>,
    path: &str,
    entry: &TournamentEntry,
    base: Built<'a>,
    points: &gearloss_framework::analysis::Points,
    out: &mut Out,
    name: &str,
) -> Result<Field<'a>, Failure> {
    let mut points = points.clone();
    // A measured temperature counts where the model does not find its own.
    if base.transmission.thermal_mode != gearloss_framework::description::ThermalMode::Fixed
        && let gearloss_framework::analysis::Field::List(list) = &mut points.field
    {
        for given in list {
            given.oil = None;
        }
    }
    let solved = runner.solve(&base, &points)?;
    // Every model loses at the temperatures of the set, else losses could not be added.
    points.field = gearloss_framework::analysis::Field::List(
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
    let (slots, left_out) = candidates::slots(runner, path, entry, &base, (&points, &solved.points))?;
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
    if field.scale.iter().any(|s| !s.is_finite()) {
        let message = "an efficiency, or a loss torque, needs speed and torque at every point";
        return Err(runner.wrong(path, message, "leave zero out, or write `quantity: loss`"));
    }
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
        return Err(runner.wrong(path, message, "name fewer models"));
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
            .map(|c| json!({ "name": c.name, "model": c.model, "losses_w": c.loss }));
        json!({ "mechanism": s.name, "candidates": candidates.collect::<Vec<_>>() })
    };
    Value::Array(field.slots.iter().map(slot).collect())
}
