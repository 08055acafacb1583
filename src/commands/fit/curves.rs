//! Traction curves from a file: points by pressure and temperature, without points dominated by heating or elastic creep.

use gearloss_framework::document::Dimension;
use gearloss_plugins::tooth_friction::ehl_mixed::identification::TractionPoint;

use super::columns::{Columns, Measure, Quantity};
use crate::output::Failure;

const PRESSURE: Quantity = Quantity::new("pressure", Measure::Of(Dimension::Pressure), "GPa");
const TEMPERATURE: Quantity = Quantity::new("temperature", Measure::Of(Dimension::Temperature), "degC");
const SHEAR_RATE: Quantity = Quantity::new("shear_rate", Measure::ShearRate, "1/s");
const SLIDING: Quantity = Quantity::new("sliding", Measure::Of(Dimension::Speed), "m/s");
const FILM: Quantity = Quantity::new("film", Measure::Of(Dimension::Length), "nm");
const STRESS: Quantity = Quantity::new("stress", Measure::Of(Dimension::Pressure), "MPa");
const MU: Quantity = Quantity::plain("mu");
const SLIDE_ROLL: Quantity = Quantity::plain("slide_roll");

/// All columns that are used.
pub const QUANTITIES: [Quantity; 8] = [PRESSURE, TEMPERATURE, SHEAR_RATE, SLIDING, FILM, STRESS, MU, SLIDE_ROLL];

/// Slide-to-roll ratio below which elastic creep of the bodies matters.
const CREEP: f64 = 0.01;
/// Relative pressure difference within which points belong to one curve: repeatability of loads.
const SAME_PRESSURE: f64 = 0.01;
/// Temperature difference within which points belong to one curve: control accuracy of baths. \[K\]
const SAME_TEMPERATURE: f64 = 1.0;

/// The points of one pressure and temperature, in order of their shear rate.
#[derive(Debug, Clone)]
pub struct Curve {
    /// Mean pressure of the first point. \[Pa\]
    pub pressure: f64,
    /// Temperature of the first point. \[degC\]
    pub temperature: f64,
    /// The remaining points.
    pub points: Vec<TractionPoint>,
    /// Number of points omitted because of little sliding.
    pub creeping: usize,
    /// Number of points omitted because they are beyond the maximum stress, where heating dominates.
    pub heated: usize,
    /// Maximum of stress over pressure. \[-\]
    pub greatest: f64,
}

/// The curves of a file, in order of their first points.
pub fn curves(columns: &Columns) -> Result<Vec<Curve>, Failure> {
    let pressure = columns.numbers(&PRESSURE)?;
    let temperature = columns.numbers(&TEMPERATURE)?;
    if let Some(row) = temperature.iter().position(|t| !(-60.0..=300.0).contains(t)) {
        let message = format!("{} degC is not a valid oil temperature", temperature[row]);
        return Err(columns.wrong(
            Some(row),
            &message,
            "write a temperature from -60 to 300 degC, and check the unit",
        ));
    }
    one_of(columns, SHEAR_RATE, [SLIDING, FILM].as_slice())?;
    let shear_rate = if columns.has(&SHEAR_RATE) {
        columns.numbers(&SHEAR_RATE)?
    } else {
        let film = columns.numbers(&FILM)?;
        columns
            .numbers(&SLIDING)?
            .iter()
            .zip(film)
            .map(|(v, h)| v / h)
            .collect()
    };
    one_of(columns, STRESS, [MU].as_slice())?;
    let stress: Vec<f64> = if columns.has(&STRESS) {
        columns.numbers(&STRESS)?
    } else {
        columns
            .numbers(&MU)?
            .iter()
            .zip(&pressure)
            .map(|(mu, p)| mu * p)
            .collect()
    };
    let slide_roll = if columns.has(&SLIDE_ROLL) {
        Some(columns.numbers(&SLIDE_ROLL)?)
    } else {
        None
    };
    let mut curves: Vec<Curve> = Vec::new();
    for row in 0..columns.len() {
        let point = TractionPoint {
            pressure: pressure[row],
            temperature: temperature[row],
            shear_rate: shear_rate[row],
            stress: stress[row],
        };
        let place = curves.iter().position(|curve| curve.holds(&point));
        let place = place.unwrap_or_else(|| {
            curves.push(Curve::from_point(&point));
            curves.len() - 1
        });
        if slide_roll.as_ref().is_some_and(|ratio| ratio[row] < CREEP) {
            curves[place].creeping += 1;
        } else {
            curves[place].points.push(point);
        }
    }
    curves.iter_mut().for_each(Curve::cut);
    Ok(curves)
}

/// Rejects a quantity that is given twice or not at all.
fn one_of(columns: &Columns, one: Quantity, others: &[Quantity]) -> Result<(), Failure> {
    let words: Vec<String> = others.iter().map(Quantity::header).collect();
    let words = words.join(" and ");
    let also = others.iter().any(|q| columns.has(q));
    match (columns.has(&one), also) {
        (true, true) => Err(columns.wrong(
            None,
            &format!("both {} and {words}", one.header()),
            "delete one of them",
        )),
        (false, false) => Err(columns.wrong(
            None,
            &format!("neither {} nor {words}", one.header()),
            "add one of them",
        )),
        _ => Ok(()),
    }
}

impl Curve {
    fn from_point(point: &TractionPoint) -> Self {
        Self {
            pressure: point.pressure,
            temperature: point.temperature,
            points: Vec::new(),
            creeping: 0,
            heated: 0,
            greatest: 0.0,
        }
    }

    fn holds(&self, point: &TractionPoint) -> bool {
        (point.pressure / self.pressure - 1.0).abs() <= SAME_PRESSURE
            && (point.temperature - self.temperature).abs() <= SAME_TEMPERATURE
    }

    /// Omits points beyond the maximum stress.
    fn cut(&mut self) {
        self.points.sort_by(|p, q| p.shear_rate.total_cmp(&q.shear_rate));
        let greatest = self.points.iter().map(|p| p.stress).fold(0.0, f64::max);
        let last = self.points.iter().rposition(|p| p.stress == greatest);
        let keep = last.map_or(0, |last| last + 1);
        self.heated = self.points.len() - keep;
        self.points.truncate(keep);
        self.greatest = self.points.iter().map(|p| p.stress / p.pressure).fold(0.0, f64::max);
    }

    /// Pressure and temperature as text.
    pub fn name(&self) -> String {
        format!("{:.3} GPa, {:.1} degC", self.pressure * 1e-9, self.temperature)
    }
}
