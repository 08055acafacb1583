//! Thermal limits beyond the tested points of a study.

use std::any::Any;
use std::collections::BTreeMap;

use gearloss_studies::analyses::Outcome;
use gearloss_studies::analyses::compare::{CompareOutcome, Comparisons};
use gearloss_studies::analyses::operating_points::OperatingPointsOutcome;
use gearloss_studies::analyses::thermal_limit::{ThermalLimit, ThermalLimitOutcome};

use crate::text::{place, range};

/// Minimum and maximum of torque in Nm and of speed in rpm.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Field {
    torque: [f64; 2],
    speed: [f64; 2],
}

impl Field {
    fn with(self, torque: f64, speed: f64) -> Self {
        let wider = |[low, high]: [f64; 2], x: f64| [low.min(x), high.max(x)];
        Self {
            torque: wider(self.torque, torque),
            speed: wider(self.speed, speed),
        }
    }

    /// Rounding of the solved values does not count.
    fn holds(self, torque: f64, speed: f64) -> bool {
        let within = |[low, high]: [f64; 2], x: f64| {
            let margin = 1e-6 * (high - low).max(high.abs());
            x >= low - margin && x <= high + margin
        };
        within(self.torque, torque) && within(self.speed, speed)
    }
}

/// The limits of an analysis in one gear.
#[derive(Debug)]
struct Limits {
    analysis: String,
    gear: String,
    /// Torque and speed of each limit.
    places: Vec<(f64, f64)>,
    /// Number of quantities outside their stated ranges.
    outside: usize,
}

/// Tested points, which data state with or without a measured loss, and thermal limits of all analyses of a run.
#[derive(Debug, Default)]
pub struct Tested {
    /// By gear.
    points: BTreeMap<String, Field>,
    limits: Vec<Limits>,
}

impl Tested {
    /// Adds what an analysis tested or found.
    pub fn add_outcome(&mut self, analysis: &str, outcome: &dyn Outcome) {
        let any: &dyn Any = outcome;
        if let Some(listed) = any.downcast_ref::<OperatingPointsOutcome>() {
            let points = listed.operating_points.iter().flat_map(|set| &set.points);
            for point in points {
                self.add_point(&point.gear, point.torque_nm, point.speed_rpm);
            }
        } else if let Some(compared) = any.downcast_ref::<CompareOutcome>() {
            let Comparisons::WithData(all) = &compared.comparisons else {
                return;
            };
            let points = all.iter().flat_map(|c| &c.points);
            for point in points.filter(|point| point.measured.is_some()) {
                self.add_point(&point.gear, point.torque_nm, point.speed_rpm);
            }
        } else if let Some(found) = any.downcast_ref::<ThermalLimitOutcome>() {
            let place = |limit: &ThermalLimit| Some((limit.torque_nm?, limit.speed_rpm?));
            self.limits.extend(found.thermal_limits.iter().map(|set| Limits {
                analysis: analysis.to_owned(),
                gear: set.gear.clone(),
                places: set.limits.iter().filter_map(place).collect(),
                outside: set.notes.iter().filter(|note| note.outside > 0).count(),
            }));
        }
    }

    fn add_point(&mut self, gear: &str, torque: f64, speed: f64) {
        let point = Field {
            torque: [torque; 2],
            speed: [speed; 2],
        };
        let known = self.points.entry(gear.to_owned()).or_insert(point);
        *known = known.with(torque, speed);
    }

    /// What to be careful about, each with the name of its analysis.
    pub fn warnings(&self) -> Vec<(&str, String)> {
        let warnings = self.limits.iter().filter_map(|limits| {
            let warning = match self.points.get(&limits.gear) {
                Some(field) => beyond(limits, *field)?,
                None if limits.outside > 0 => format!(
                    "no points of the data are in gear `{}`; at the limits, {} quantities are outside their stated ranges",
                    limits.gear, limits.outside
                ),
                None => return None,
            };
            Some((limits.analysis.as_str(), warning))
        });
        warnings.collect()
    }
}

fn beyond(limits: &Limits, field: Field) -> Option<String> {
    let all = &limits.places;
    let outside: Vec<&(f64, f64)> = all
        .iter()
        .filter(|(torque, speed)| !field.holds(*torque, *speed))
        .collect();
    let farthest = outside.iter().max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))?;
    let [torque, speed] = [field.torque, field.speed].map(|[low, high]| range(low, high, 0));
    let count = if outside.len() == all.len() {
        format!("all {}", all.len())
    } else {
        format!("{} of {}", outside.len(), all.len())
    };
    Some(format!(
        "{count} limits are outside the range of the data ({torque} Nm, {speed} rpm), the farthest at {}",
        place(farthest.0, farthest.1)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_beyond_the_tested_points_are_counted() {
        let mut tested = Tested::default();
        tested.limits.push(Limits {
            analysis: "limit".to_owned(),
            gear: "first".to_owned(),
            places: vec![(-10.0, 1000.0), (-50.0, 2000.0)],
            outside: 2,
        });
        let alone = tested.warnings();
        assert!(
            alone[0].1.starts_with("no points of the data are in gear `first`"),
            "{alone:?}"
        );
        tested.add_point("first", -16.0, 500.0);
        tested.add_point("first", 0.0, 3000.0);
        let words = "1 of 2 limits are outside the range of the data (-16 to 0 Nm, 500 to 3000 rpm), the farthest at -50 Nm, 2000 rpm";
        assert_eq!(tested.warnings(), [("limit", words.to_owned())]);
    }
}
