//! Rows that were held out of a fit: their predictions beside those of fitted rows, in tables, JSON and pictures.

use gearloss_numerics::inference::{Coverage, ErrorSummary, PlacedError, Region, regions};
use gearloss_report::Figure;
use gearloss_report::plot::{Line, Stroke};
use gearloss_studies::identify::{CONFIDENCE, HoldOut, PredictedNumber, Predictions};
use gearloss_studies::study::{Difference, IdentifyEntry, Quantity};
use serde_json::{Value, json};

use super::super::super::solve::RPM;
use super::super::Runner;
use super::super::table::TableFile;
use super::super::write::cell;
use super::outcome::Outcome;
use super::pictures::slug;
use crate::output::{Failure, Out, Table, figures, fixed};
use gearloss_studies::analyses::numbers::tidy;

/// Rows that were held out, predicted.
pub struct HeldOut<'a> {
    pub choice: &'a HoldOut,
    pub predictions: Predictions,
    /// What was predicted of each quantity.
    pub quantities: Vec<HeldOutQuantity>,
}

/// Errors of one quantity, of fitted rows and of rows held out.
pub struct HeldOutQuantity {
    pub quantity: Quantity,
    pub errors: Vec<PlacedError>,
    pub fitted: Option<ErrorSummary>,
    pub held_out: Option<ErrorSummary>,
    pub coverage: Option<Coverage>,
    pub regions: Vec<Region>,
}

/// Predicts what was held out with the parameters of a fit; absent where nothing was held out.
pub fn predict<'a>(choice: &'a HoldOut, residuals: &[Quantity], o: &Outcome<'_>) -> Result<HeldOut<'a>, String> {
    let predictions = o.identification.predict(
        &o.fitted,
        &choice.held_out,
        residuals,
        (o.intervals_widened(), &o.profiles),
    )?;
    if predictions.numbers.is_empty() {
        return Err(match predictions.missing.first() {
            Some(reason) => reason.clone(),
            None => "no row that is held out has a measured number of what is fitted".to_owned(),
        });
    }
    let mut quantities: Vec<Quantity> = Vec::new();
    for number in &predictions.numbers {
        if !quantities.contains(&number.observation.quantity) {
            quantities.push(number.observation.quantity);
        }
    }
    let accuracy = o.fitted.inference.accuracy();
    let summed = |quantity: Quantity| {
        let mut errors = o.identification.placed_errors(&o.calculated[1], &o.pairs[1], quantity);
        errors.extend(predictions.placed_errors(&choice.held_out, accuracy, quantity));
        let of_kind = |held: bool| ErrorSummary::summarise(errors.iter().filter(|e| e.is_held_out == held));
        HeldOutQuantity {
            quantity,
            fitted: of_kind(false),
            held_out: of_kind(true),
            coverage: predictions.coverage(Some(quantity)),
            regions: regions(&errors),
            errors,
        }
    };
    let quantities = quantities.into_iter().map(summed).collect();
    Ok(HeldOut {
        choice,
        predictions,
        quantities,
    })
}

fn short(x: f64) -> String {
    figures(x, 3)
}

fn signed(x: f64) -> String {
    let sign = if x < 0.0 { "-" } else { "+" };
    format!("{sign}{}", short(x.abs()))
}

fn percent(share: f64) -> String {
    fixed(100.0 * share, 1)
}

impl HeldOutQuantity {
    /// Whether the loss is told in percent of what was measured.
    fn is_relative(&self) -> bool {
        matches!(self.quantity, Quantity::Loss | Quantity::LossTorque)
    }

    /// What there is to say, in one sentence.
    pub fn verdict(&self, choice: &str) -> Option<String> {
        let held = self.held_out?;
        let (what, unit) = self.quantity.words(Difference::Points);
        let in_percent = |s: ErrorSummary| s.in_percent.filter(|_| self.is_relative());
        let relative = in_percent(held).filter(|_| self.fitted.is_none_or(|fitted| in_percent(fitted).is_some()));
        let ([rms, mean], own) = match relative {
            Some([rms, mean, _]) => ([rms, mean], "%"),
            None => ([held.rms, held.mean], unit),
        };
        let over_accuracy = |s: ErrorSummary| s.in_accuracies.map(|[rms, ..]| short(rms));
        let held_over = over_accuracy(held).map_or_else(String::new, |x| format!(", {x} times the stated accuracy"));
        let beside = self.fitted.map_or_else(String::new, |fitted| {
            let rms = in_percent(fitted)
                .filter(|_| relative.is_some())
                .map_or(fitted.rms, |[rms, ..]| rms);
            let over = over_accuracy(fitted).map_or_else(String::new, |x| format!(", {x} times"));
            format!(" (fitted points {}{over})", short(rms))
        });
        let at = held.greatest;
        let points = if held.count == 1 { "point" } else { "points" };
        let mut words = format!(
            "predicts the {what} of the {} {points} held out ({choice}) to {} {own} rms{held_over}{beside}, bias {} {own}, worst {} {unit} at \
             {} Nm and {} rpm (line {})",
            held.count,
            short(rms),
            signed(mean),
            signed(at.error),
            short(at.torque),
            fixed(at.speed, 0),
            at.line,
        );
        if let Some((coverage, [low, high])) = self.coverage.and_then(|c| Some((c, c.interval(CONFIDENCE)?))) {
            let judged = if high < CONFIDENCE {
                "; the bands are too narrow: the model errs there by more than its fit says"
            } else if low > CONFIDENCE {
                "; the bands are wider than the errors"
            } else {
                ""
            };
            words += &format!(
                "; {} of {} lie inside their 95 % bands ({} %, 95 % interval {} to {} %){judged}",
                coverage.inside,
                coverage.count,
                percent(coverage.share()),
                percent(low),
                percent(high),
            );
        }
        Some(words)
    }
}

/// What was held out on the terminal.
pub fn show(runner: &Runner<'_>, name: &str, o: &Outcome<'_>, out: &mut Out) -> Result<(), Failure> {
    let Some(held) = &o.held_out else { return Ok(()) };
    for own in &held.quantities {
        let (what, unit) = own.quantity.words(Difference::Points);
        out.line(format!(
            "errors of the {what} in rows that were fitted and in rows that were held out, in {unit}:"
        ))?;
        out.text(&summaries(own))?;
        if own.regions.iter().any(|r| r.held_out.is_some()) {
            out.text(&by_region(own))?;
        }
        if let Some(words) = own.verdict(&held.choice.words) {
            runner.verdict(format!("{name}: {words}"), out)?;
        }
    }
    let widening = held.predictions.widening;
    if widening.is_some() && held.predictions.no_bands.is_none() {
        out.line(format!(
            "the bands are widened, because the model misses the fitted points: what the parameters are uncertain counts {:.2} times, \
             the scatter of a measurement {:.2} times",
            widening.parameters, widening.scatter
        ))?;
    }
    if let Some(reason) = &held.predictions.no_bands {
        out.line(format!("no bands of what was held out: {reason}"))?;
    }
    if let Some(first) = held.predictions.missing.first() {
        let count = held.predictions.missing.len();
        out.line(format!("{count} numbers held out are not predicted: {first}"))?;
    }
    Ok(())
}

fn summaries(own: &HeldOutQuantity) -> String {
    let both = [("fitted", &own.fitted), ("held out", &own.held_out)];
    let all = |has: &dyn Fn(&ErrorSummary) -> bool| both.iter().all(|(_, summary)| summary.as_ref().is_none_or(has));
    let in_percent = own.is_relative() && all(&|s| s.in_percent.is_some());
    let in_accuracies = all(&|s| s.in_accuracies.is_some());
    let mut head = vec!["rows".to_owned(), "points".to_owned()];
    head.extend(["rms", "bias", "greatest"].map(str::to_owned));
    head.extend(["line", "torque Nm", "speed rpm"].map(|what| format!("its {what}")));
    let units = [(in_percent, "%"), (in_accuracies, "/ accuracy")];
    for (_, unit) in units.iter().filter(|(shown, _)| *shown) {
        head.extend(["rms", "bias", "greatest"].map(|figure| format!("{figure} {unit}")));
    }
    let mut table = Table::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
    for (kind, summary) in both {
        let Some(s) = summary else { continue };
        let at = s.greatest;
        let mut cells = vec![
            kind.to_owned(),
            s.count.to_string(),
            short(s.rms),
            short(s.mean),
            short(at.error),
        ];
        cells.extend([at.line.to_string(), short(at.torque), fixed(at.speed, 0)]);
        let further = [
            s.in_percent.filter(|_| in_percent),
            s.in_accuracies.filter(|_| in_accuracies),
        ];
        cells.extend(further.into_iter().flatten().flatten().map(short));
        table.row(cells);
    }
    table.render()
}

fn by_region(own: &HeldOutQuantity) -> String {
    let mut table = Table::new(&["region", "held out", "rms", "bias", "fitted", "rms", "bias"]);
    for region in own.regions.iter().filter(|r| r.held_out.is_some()) {
        let cells = |summary: &Option<ErrorSummary>| match summary {
            Some(s) => [s.count.to_string(), short(s.rms), short(s.mean)],
            None => ["0", "-", "-"].map(str::to_owned),
        };
        let mut row = vec![match region.over {
            "oil_temperature" => format!("oil {}", region.name),
            _ => region.name.clone(),
        }];
        row.extend(cells(&region.held_out));
        row.extend(cells(&region.fitted));
        table.row(row);
    }
    table.render()
}

/// One row for each number that was held out.
pub fn table(runner: &Runner<'_>, name: &str, entry: &IdentifyEntry, all: &[Outcome<'_>]) -> Result<(), Failure> {
    let header = [
        "model_set",
        "line",
        "name",
        "gear",
        "torque_nm",
        "speed_rpm",
        "oil_temperature_degc",
        "quantity",
        "measured",
        "predicted",
        "band_low",
        "band_high",
        "inside",
    ]
    .map(str::to_owned);
    let mut table = TableFile::new(runner.run, &format!("{name}-hold-out"), &entry.write, &header)?;
    let mut rows: Vec<Vec<String>> = Vec::new();
    for o in all {
        let Some(held) = &o.held_out else { continue };
        for number in &held.predictions.numbers {
            let place = Place::find(held, number);
            let mut cells = vec![
                o.name.clone(),
                place.line.to_string(),
                place.name.unwrap_or_default().to_owned(),
                place.gear.to_owned(),
            ];
            cells.extend([place.torque, Some(place.speed), place.oil].map(cell));
            cells.push(number.observation.quantity.name().to_owned());
            cells.extend([number.pair.measured, number.pair.model].map(|x| cell(Some(x))));
            cells.extend([0, 1].map(|end| cell(number.band.map(|band| band[end]))));
            cells.push(number.is_inside().map_or_else(String::new, |inside| inside.to_string()));
            rows.push(cells);
        }
    }
    table.push_all(&rows)?;
    table.finish()
}

/// Where a number that was held out belongs.
struct Place<'h> {
    line: u64,
    name: Option<&'h str>,
    gear: &'h str,
    torque: Option<f64>,
    /// \[rpm\]
    speed: f64,
    oil: Option<f64>,
}

impl<'h> Place<'h> {
    fn find(held: &'h HeldOut<'_>, number: &PredictedNumber) -> Self {
        let measured = &held.choice.held_out;
        let row = &measured.rows[number.observation.row];
        let (_, gear, point) = &held.predictions.calculated.solved.rows[number.observation.row];
        Self {
            line: row.line,
            name: row.name.as_deref(),
            gear,
            torque: measured.value(row, "torque"),
            speed: tidy(point.speed * RPM),
            oil: point.oil,
        }
    }
}

/// What was held out as JSON.
pub fn json_of(o: &Outcome<'_>) -> Value {
    let Some(held) = &o.held_out else { return Value::Null };
    let three = |figures: Option<[f64; 3]>| {
        figures.map(|[rms, mean, greatest]| json!({ "rms": rms, "mean": mean, "greatest": greatest }))
    };
    let summary = |s: &Option<ErrorSummary>| {
        s.map(|s| {
            let at = s.greatest;
            json!({
                "points": s.count, "rms": s.rms, "mean": s.mean, "greatest": at.error,
                "greatest_at": { "line": at.line, "torque_nm": at.torque, "speed_rpm": tidy(at.speed) },
                "in_percent": three(s.in_percent), "in_accuracies": three(s.in_accuracies),
            })
        })
    };
    let region = |r: &Region| {
        json!({
            "over": r.over, "name": r.name, "from": r.band.map(|b| b[0]), "to": r.band.map(|b| b[1]),
            "held_out": summary(&r.held_out), "fitted": summary(&r.fitted),
        })
    };
    let quantity = |q: &HeldOutQuantity| {
        json!({
            "quantity": q.quantity.name(), "unit": q.quantity.unit(Difference::Points),
            "held_out": summary(&q.held_out), "fitted": summary(&q.fitted),
            "coverage": q.coverage.map(|c| json!({
                "inside": c.inside, "points": c.count, "share": c.share(), "interval": c.interval(CONFIDENCE),
            })),
            "sentence": q.verdict(&held.choice.words),
            "regions": q.regions.iter().map(region).collect::<Vec<_>>(),
        })
    };
    let point = |number: &PredictedNumber| {
        let place = Place::find(held, number);
        json!({
            "line": place.line, "name": place.name, "gear": place.gear, "torque_nm": place.torque,
            "speed_rpm": place.speed, "oil_temperature_degc": place.oil,
            "quantity": number.observation.quantity.name(),
            "accuracy": Some(number.observation.deviation).filter(|d| d.is_finite()),
            "measured": number.pair.measured, "predicted": number.pair.model,
            "band": number.band, "inside": number.is_inside(),
        })
    };
    let (choice, predictions) = (held.choice, &held.predictions);
    json!({
        "chosen_by": choice.words,
        "rows": choice.held_out.rows.len(),
        "rows_fitted": choice.fitted.rows.len(),
        "confidence": CONFIDENCE,
        "widening": { "parameters": predictions.widening.parameters, "scatter": predictions.widening.scatter },
        "no_bands": predictions.no_bands,
        "not_predicted": predictions.missing,
        "quantities": held.quantities.iter().map(quantity).collect::<Vec<_>>(),
        "points": predictions.numbers.iter().map(point).collect::<Vec<_>>(),
    })
}

/// Errors over torque and over speed: of fitted rows, of rows held out, and the ends of the bands of the latter.
pub fn pictures(name: &str, o: &Outcome<'_>) -> Vec<(String, Figure)> {
    let Some(held) = &o.held_out else {
        return Vec::new();
    };
    let mut all = Vec::new();
    for own in &held.quantities {
        let (what, unit) = own.quantity.words(Difference::Points);
        let axes: [(&str, &str, fn(&PlacedError) -> f64); 2] =
            [("torque", "Nm", |e| e.torque), ("speed", "rpm", |e| e.speed)];
        let factor = own.quantity.difference(Difference::Points, 0.0, 1.0).unwrap_or(1.0);
        for (axis, axis_unit, value) in axes {
            let dots = |held: bool| {
                let own = own.errors.iter().filter(move |e| e.is_held_out == held);
                own.map(|e| Some((value(e), e.error))).collect::<Vec<_>>()
            };
            let of_quantity = held
                .predictions
                .numbers
                .iter()
                .filter(|n| n.observation.quantity == own.quantity);
            let placed = own.errors.iter().filter(|e| e.is_held_out);
            let ends = of_quantity.zip(placed).flat_map(|(number, placed)| {
                // A measurement inside of its band has an error between these ends.
                let from_model = |end: f64| factor * (number.pair.model - end);
                let ends = number.band.map_or_else(Vec::new, |band| band.map(from_model).to_vec());
                ends.into_iter()
                    .map(|end| Some((value(placed), end)))
                    .collect::<Vec<_>>()
            });
            let dotted = |name: &str, points: Vec<Option<(f64, f64)>>| Line {
                name: name.to_owned(),
                points,
                stroke: Stroke::Dots,
            };
            let figure = Figure::Lines {
                title: format!("{name}: errors of {} over {axis}, {what}, fitted and held out", o.name),
                x: format!("{axis} {axis_unit}"),
                y: format!("calculated less measured, {unit}"),
                lines: vec![
                    dotted("fitted", dots(false)),
                    dotted("held out", dots(true)),
                    dotted("ends of 95 % bands", ends.collect()),
                ],
            };
            all.push((format!("hold-out-{}-{axis}", slug(own.quantity)), figure));
        }
    }
    all
}
