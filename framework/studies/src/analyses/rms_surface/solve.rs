//! All measured points at every pair of values.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Axis, RmsSurfaceEntry};
use crate::analyses::common::rows::SolvedRow;
use crate::analyses::common::trial::{Left, Trial};
use crate::analyses::{Built, Engine, Planner, Stopped};
use crate::measured::{Measured, Seen, counted};
use crate::points::{Rows, Statistics};

/// A row at a pair: the difference of the model from the measurement, or why there is none.
pub type Difference = Result<f64, String>;

/// A pair of values.
#[derive(Serialize, Deserialize)]
pub struct Pair {
    /// Values of x and y, in their units.
    pub at: [f64; 2],
    /// By row; or why the pair has no value at all.
    pub differences: Result<Vec<Difference>, String>,
    /// Accuracy of the measurement at each row.
    accuracies: Vec<Option<f64>>,
}

impl Pair {
    /// Weighted root mean square over some rows.
    pub fn rms(&self, measured: &Measured, places: &[usize]) -> Option<f64> {
        let all = self.differences.as_ref().ok()?;
        let weight = |i: usize| measured.value(&measured.rows[i], "weight").unwrap_or(1.0);
        let list = places
            .iter()
            .filter_map(|i| Some((*all[*i].as_ref().ok()?, weight(*i))));
        Statistics::weighted(list).map(|s| s.rms)
    }

    /// The pair as text.
    fn words(&self, axes: &[Axis; 2]) -> String {
        let word = |k: usize| format!("{} = {}", axes[k].varied.pattern, axes[k].varied.words(self.at[k]));
        format!("{}, {}", word(0), word(1))
    }
}

/// Missing measured values do not depend on the pair.
const NOTHING: &str = "nothing was measured";

/// The points used.
pub struct Counted {
    /// Rows that have a value at every pair of every set.
    pub places: Vec<usize>,
    /// The others, with the reason.
    pub left_out: Vec<(usize, String)>,
    /// Accuracy of the measurement, in the unit of the difference.
    pub accuracy: Option<f64>,
}

/// Solves all pairs of one set; independent of the number of threads.
pub fn pairs(
    engine: &Engine<'_>,
    entry: &RmsSurfaceEntry,
    built: &Built<'_>,
    axes: &[Axis; 2],
    rows: &Rows<'_>,
    seen: &mut Left,
) -> Result<Vec<Pair>, Stopped> {
    let [x, y] = axes;
    let count = x.values.len() * y.values.len();
    engine.holds("analyses", rows.measured.rows.len(), count)?;
    let trial = Trial::new(engine, built);
    let speeds = trial.speeds(engine, rows);
    let speeds = &speeds.map_err(|reason| engine.wrong("analyses", reason, "delete it from `rig`"))?[..];
    let solve = |i: usize| {
        let at = [x.values[i % x.values.len()], y.values[i / x.values.len()]];
        let overrides: Vec<_> = x.varied.overrides(at[0]).chain(y.varied.overrides(at[1])).collect();
        let mut seen = Left::new();
        let solved = trial.rows(engine, rows, speeds, &overrides, &mut seen);
        Ok((pair(entry, rows.measured, at, solved), seen))
    };
    let all: Vec<(Pair, Left)> = engine.jobs(&built.name, count, solve)?;
    let mut pairs = Vec::with_capacity(count);
    for (pair, left) in all {
        seen.extend(left);
        pairs.push(pair);
    }
    Ok(pairs)
}

fn pair(entry: &RmsSurfaceEntry, measured: &Measured, at: [f64; 2], solved: Result<Vec<SolvedRow>, String>) -> Pair {
    let solved = match solved {
        Ok(solved) => solved,
        Err(reason) => {
            return Pair {
                at,
                differences: Err(reason),
                accuracies: Vec::new(),
            };
        }
    };
    let (mut differences, mut accuracies) = (Vec::new(), Vec::new());
    for (row, (point, why)) in measured.rows.iter().zip(&solved) {
        let seen = Seen::without_rig(measured, row, point);
        let (saw, model) = (seen.quantity(entry.quantity), entry.quantity.value(point));
        let accuracy = seen.accuracy(entry.quantity);
        accuracies.push(accuracy.and_then(|a| counted(entry.quantity, entry.difference, a, saw)));
        differences.push(match (saw, model) {
            (None, _) => Err(NOTHING.to_owned()),
            (_, None) => Err(why.clone().unwrap_or_else(|| point.status.name().to_owned())),
            (Some(saw), Some(model)) => entry
                .quantity
                .difference(entry.difference, saw, model)
                .ok_or_else(|| "percent of zero is undefined".to_owned()),
        });
    }
    // A pair without any value would exclude all points at the others.
    let none = differences.iter().all(Result::is_err);
    let why = differences
        .iter()
        .filter_map(|d| d.as_ref().err())
        .find(|why| *why != NOTHING);
    let differences = match why {
        Some(why) if none => Err(format!("no point has a value: {why}")),
        _ => Ok(differences),
    };
    Pair {
        at,
        differences,
        accuracies,
    }
}

/// The rows with a value at every pair of every set, except pairs without any value.
pub fn counted_points<'p, 'b: 'p, 's>(
    cx: &Planner<'_>,
    entry: &RmsSurfaceEntry,
    measured: &Measured,
    solved: impl Iterator<Item = ((&'p Built<'b>, &'p [Axis; 2]), &'s Vec<Pair>)> + Clone,
) -> Result<Counted, Stopped> {
    let path = cx.path();
    let mut faults: BTreeMap<usize, String> = BTreeMap::new();
    for ((built, axes), pairs) in solved.clone() {
        for pair in pairs {
            for (i, difference) in pair.differences.iter().flatten().enumerate() {
                if let Err(why) = difference {
                    let said = || match why.as_str() {
                        NOTHING => why.clone(),
                        _ => format!("models {}, {}: {why}", built.name, pair.words(axes)),
                    };
                    faults.entry(i).or_insert_with(said);
                }
            }
        }
    }
    let places: Vec<usize> = (0..measured.rows.len()).filter(|i| !faults.contains_key(i)).collect();
    if places.is_empty() && faults.values().all(|why| why == NOTHING) {
        let message = format!(
            "{}: there is no measured {}",
            cx.data(&path, &entry.data)?.file,
            entry.quantity.name()
        );
        let help = "add a column of it, or columns of torque and speed at both ports";
        return Err(cx.wrong(&format!("{path}.data"), message, help));
    }
    if let Some(why) = faults
        .values()
        .find(|why| *why != NOTHING)
        .filter(|_| places.is_empty())
    {
        let message = format!("no point has a value at every pair; {why}");
        return Err(cx.wrong(&path, message, "delete values of `x` and `y`"));
    }
    // Speeds depend only on the gear, so one pair provides the accuracies for all.
    let mut all = solved.flat_map(|(_, pairs)| pairs);
    let first = all.find(|pair| pair.differences.is_ok());
    let deviations = places
        .iter()
        .filter_map(|i| first?.accuracies.get(*i).copied().flatten());
    Ok(Counted {
        accuracy: Statistics::from_values(deviations).map(|s| s.rms).or(entry.accuracy),
        places,
        left_out: faults.into_iter().collect(),
    })
}
