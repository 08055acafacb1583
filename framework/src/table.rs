//! Tables over one to four axes: linear or monotone cubic in between, exact at the points, on linear or logarithmic scales.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::loss::Undefined;

/// What holds beyond the ends of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Outside {
    /// The answer is undefined.
    #[default]
    Error,
    /// The value at the end.
    Clamp,
    /// The last slope goes on.
    Extrapolate,
}

/// How an axis or the answer counts between points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// By its value.
    #[default]
    Linear,
    /// By its logarithm; above zero.
    Log,
}

impl Scale {
    fn apply(self, x: f64) -> f64 {
        match self {
            Self::Linear => x,
            Self::Log => x.ln(),
        }
    }
}

/// What connects the points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// Straight lines, along each axis in turn.
    #[default]
    Linear,
    /// Smooth curves that rise and fall only where the points do (Fritsch and Butland 1984), along each axis in turn.
    MonotoneCubic,
}

/// How a table is read.
#[derive(Debug, Clone, Default)]
pub struct Reading {
    /// What holds beyond the ends.
    pub outside: Outside,
    /// What connects the points.
    pub interpolation: Interpolation,
    /// Scales by the name of an axis; `answer` names the answer. Others are linear.
    pub scales: Vec<(String, Scale)>,
}

impl Reading {
    fn scale(&self, name: &str) -> Scale {
        self.scales
            .iter()
            .find(|(n, _)| n == name)
            .map_or(Scale::Linear, |(_, scale)| *scale)
    }
}

/// Name of the answer among the scales.
const ANSWER: &str = "answer";

/// One axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Name, as in the header.
    pub name: String,
    /// Unit, as in the header.
    pub unit: String,
    /// Rising values.
    pub values: Vec<f64>,
}

/// A table over a full grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    axes: Vec<Axis>,
    /// Values of each axis on its scale.
    places: Vec<Vec<f64>>,
    scales: Vec<Scale>,
    /// Answers on their scale; the last axis runs fastest.
    values: Vec<f64>,
    answer: Scale,
    outside: Outside,
    interpolation: Interpolation,
    unit: Option<String>,
}

impl Table {
    /// A table from axes and values, the last axis running fastest.
    ///
    /// # Errors
    /// If an axis does not rise, the number of values does not fit, or a scale does not.
    pub fn from_grid(axes: Vec<Axis>, values: Vec<f64>, reading: &Reading) -> Result<Self, String> {
        if axes.is_empty() || axes.len() > 4 {
            return Err(format!("{} axes; a table has one to four", axes.len()));
        }
        for axis in &axes {
            if axis.values.windows(2).any(|w| w[1] <= w[0]) || axis.values.iter().any(|x| !x.is_finite()) {
                return Err(format!("axis `{}` does not rise", axis.name));
            }
            if axis.values.len() < 2 {
                return Err(format!("axis `{}` has one value; a table needs two", axis.name));
            }
        }
        let count: usize = axes.iter().fold(1, |n: usize, a| n.saturating_mul(a.values.len()));
        if values.len() != count {
            return Err(format!("{} values for a grid of {count}", values.len()));
        }
        for (name, _) in &reading.scales {
            if name != ANSWER && axes.iter().all(|a| a.name != *name) {
                let names: Vec<&str> = axes.iter().map(|a| a.name.as_str()).collect();
                return Err(format!(
                    "`scale` names `{name}`, but the axes are {}; the answer is `answer`",
                    names.join(", ")
                ));
            }
        }
        let scales: Vec<Scale> = axes.iter().map(|a| reading.scale(&a.name)).collect();
        for (axis, scale) in axes.iter().zip(&scales) {
            if *scale == Scale::Log && axis.values[0] <= 0.0 {
                return Err(format!(
                    "axis `{}` is logarithmic and has {}",
                    axis.name, axis.values[0]
                ));
            }
        }
        let answer = reading.scale(ANSWER);
        if let (Scale::Log, Some(value)) = (answer, values.iter().find(|v| **v <= 0.0)) {
            return Err(format!("the answer is logarithmic and has {value}"));
        }
        Ok(Self {
            places: axes
                .iter()
                .zip(&scales)
                .map(|(axis, scale)| axis.values.iter().map(|x| scale.apply(*x)).collect())
                .collect(),
            values: values.into_iter().map(|y| answer.apply(y)).collect(),
            axes,
            scales,
            answer,
            outside: reading.outside,
            interpolation: reading.interpolation,
            unit: None,
        })
    }

    /// A table from CSV: a column `name [unit]` for each axis, then one column for the value; one row for each point of
    /// the full grid, in any order. Lines that begin with # are comments.
    ///
    /// # Errors
    /// With the line of the file.
    pub fn from_csv(text: &str, reading: &Reading) -> Result<Self, String> {
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let header = reader.headers().map_err(|e| e.to_string())?.clone();
        if header.len() < 2 || header.len() > 5 {
            return Err(format!(
                "line 1: {} columns; a table has one to four axes and a value",
                header.len()
            ));
        }
        let mut names = Vec::new();
        for name in header.iter().take(header.len() - 1) {
            let (name, rest) = name
                .split_once('[')
                .ok_or_else(|| format!("line 1: column `{name}` has no [unit]"))?;
            names.push((name.trim().to_owned(), rest.trim_end_matches(']').to_owned()));
        }
        let mut rows: Vec<(Vec<f64>, u64)> = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|e| e.to_string())?;
            let line = record.position().map_or(0, csv::Position::line);
            let row: Result<Vec<f64>, String> = record
                .iter()
                .zip(&header)
                .map(|(cell, column)| {
                    cell.parse::<f64>()
                        .ok()
                        .filter(|x| x.is_finite())
                        .ok_or_else(|| format!("line {line}, column `{column}`: `{cell}` is not a number"))
                })
                .collect();
            rows.push((row?, line));
        }
        let axes: Vec<Axis> = names
            .into_iter()
            .enumerate()
            .map(|(i, (name, unit))| {
                let mut values: Vec<f64> = rows.iter().map(|(row, _)| row[i]).collect();
                values.sort_by(f64::total_cmp);
                values.dedup();
                Axis { name, unit, values }
            })
            .collect();
        let count: usize = axes.iter().fold(1, |n: usize, a| n.saturating_mul(a.values.len()));
        if count > 10_000_000 {
            return Err(format!(
                "the axes span {count} points; check for values that should be equal"
            ));
        }
        let mut values = vec![f64::NAN; count];
        for (row, line) in &rows {
            let place = axes.iter().zip(row).fold(0, |place, (axis, x)| {
                place * axis.values.len() + axis.values.partition_point(|v| v < x)
            });
            if !values[place].is_nan() {
                return Err(format!("line {line}: this point stands twice"));
            }
            values[place] = row[axes.len()];
        }
        let missing = values.iter().filter(|v| v.is_nan()).count();
        if missing > 0 {
            return Err(format!("{missing} of {count} points of the grid are missing"));
        }
        let unit = header[header.len() - 1]
            .split_once('[')
            .map(|(_, rest)| rest.trim_end_matches(']').to_owned());
        Ok(Self {
            unit,
            ..Self::from_grid(axes, values, reading)?
        })
    }

    /// Unit of the values, where the header states it.
    pub fn unit(&self) -> Option<&str> {
        self.unit.as_deref()
    }

    /// The axes.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// The value at a point, one coordinate for each axis.
    ///
    /// # Errors
    /// Beyond an end, where that is an error; at a coordinate that is not a number, or has no logarithm.
    pub fn value(&self, point: &[f64]) -> Result<f64, Undefined> {
        let mut cell = [(0_usize, 0.0_f64); 4];
        for (k, (x, cell)) in point.iter().zip(&mut cell).enumerate() {
            let (values, places) = (&self.axes[k].values, &self.places[k]);
            let (first, last) = (values[0], values[values.len() - 1]);
            let held = match self.outside {
                Outside::Clamp => x.clamp(first, last),
                _ => *x,
            };
            let place = self.scales[k].apply(held);
            if !place.is_finite() || (self.outside == Outside::Error && (*x < first || *x > last)) {
                return Err(Undefined {
                    what: "coordinate beyond the end of the table",
                    value: *x,
                });
            }
            let i = places.partition_point(|v| *v <= place).clamp(1, places.len() - 1) - 1;
            *cell = (i, place);
        }
        let value = self.along(0, 0, &cell);
        Ok(match self.answer {
            Scale::Linear => value,
            Scale::Log => value.exp(),
        })
    }

    /// Interpolates along one axis and, at the points it needs, along those behind it.
    fn along(&self, axis: usize, place: usize, cells: &[(usize, f64); 4]) -> f64 {
        let Some(xs) = self.places.get(axis) else {
            return self.values[place];
        };
        let (i, x) = cells[axis];
        let at = |j: usize| self.along(axis + 1, place * xs.len() + j, cells);
        // Exact at the points, and no cost along an axis that stands on one.
        if x == xs[i] {
            return at(i);
        }
        if x == xs[i + 1] {
            return at(i + 1);
        }
        let (low, high) = (at(i), at(i + 1));
        let h = xs[i + 1] - xs[i];
        let (t, slope) = ((x - xs[i]) / h, (high - low) / h);
        if self.interpolation == Interpolation::Linear || xs.len() == 2 {
            return low + t * (high - low);
        }
        let before = (i > 0).then(|| (xs[i] - xs[i - 1], (low - at(i - 1)) / (xs[i] - xs[i - 1])));
        let behind = (i + 2 < xs.len()).then(|| (xs[i + 2] - xs[i + 1], (at(i + 2) - high) / (xs[i + 2] - xs[i + 1])));
        let slope_at = |own: Option<(f64, f64)>, other: Option<(f64, f64)>| match (own, other) {
            (Some((h_own, d_own)), _) => inner_slope(h_own, d_own, h, slope),
            (None, Some((h_other, d_other))) => end_slope(h, slope, h_other, d_other),
            (None, None) => slope,
        };
        let (start, end) = (slope_at(before, behind), slope_at(behind, before));
        if t < 0.0 {
            return low + start * (x - xs[i]);
        }
        if t > 1.0 {
            return high + end * (x - xs[i + 1]);
        }
        let u = 1.0 - t;
        low * u * u * (1.0 + 2.0 * t) + high * t * t * (3.0 - 2.0 * t) + h * t * u * (u * start - t * end)
    }
}

/// Slope at a point between two pieces of lengths and slopes: none at a turn, else a weighted harmonic mean.
fn inner_slope(h_1: f64, d_1: f64, h_2: f64, d_2: f64) -> f64 {
    if d_1 * d_2 <= 0.0 {
        return 0.0;
    }
    let (w_1, w_2) = (2.0 * h_2 + h_1, h_2 + 2.0 * h_1);
    (w_1 + w_2) / (w_1 / d_1 + w_2 / d_2)
}

/// Slope at an end, from its piece and the next: a parabola's, held so that nothing overshoots.
fn end_slope(h_1: f64, d_1: f64, h_2: f64, d_2: f64) -> f64 {
    let slope = ((2.0 * h_1 + h_2) * d_1 - h_1 * d_2) / (h_1 + h_2);
    if slope * d_1 <= 0.0 {
        0.0
    } else if d_1 * d_2 < 0.0 && slope.abs() > 3.0 * d_1.abs() {
        3.0 * d_1
    } else {
        slope
    }
}

/// Linear between points, constant beyond the ends. The first list rises and both are of one length.
pub fn clamped(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    let last = xs.len() - 1;
    if x <= xs[0] {
        return ys[0];
    }
    if x >= xs[last] {
        return ys[last];
    }
    let i = xs.partition_point(|v| *v <= x).clamp(1, last) - 1;
    ys[i] + (ys[i + 1] - ys[i]) * (x - xs[i]) / (xs[i + 1] - xs[i])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use proptest::prelude::*;

    const PLANE: &str = "speed [rpm],temperature [degC],moment [Nm]\n0,20,1\n1000,20,3\n0,80,2\n1000,80,4\n";

    fn reading(outside: Outside) -> Reading {
        Reading {
            outside,
            ..Reading::default()
        }
    }

    fn line(values: &[(f64, f64)], reading: &Reading) -> Table {
        let axis = Axis {
            name: "x".to_owned(),
            unit: "mm".to_owned(),
            values: values.iter().map(|v| v.0).collect(),
        };
        Table::from_grid(vec![axis], values.iter().map(|v| v.1).collect(), reading).unwrap()
    }

    #[test]
    fn exact_at_the_points_and_linear_between() {
        let table = Table::from_csv(PLANE, &reading(Outside::Error)).unwrap();
        for (point, expected) in [([0.0, 20.0], 1.0), ([1000.0, 80.0], 4.0), ([500.0, 50.0], 2.5)] {
            assert_eq!(table.value(&point).unwrap(), expected);
        }
    }

    #[test]
    fn beyond_the_ends() {
        let at = |outside| {
            Table::from_csv(PLANE, &reading(outside))
                .unwrap()
                .value(&[2000.0, 20.0])
        };
        assert!(at(Outside::Error).is_err());
        assert_eq!(at(Outside::Clamp).unwrap(), 3.0);
        assert_eq!(at(Outside::Extrapolate).unwrap(), 5.0);
    }

    #[test]
    fn a_power_law_is_exact_on_logarithmic_scales() {
        let law = |x: f64| 3.0 * x.powf(1.5);
        let points = [1.0, 7.0, 40.0].map(|x| (x, law(x)));
        for interpolation in [Interpolation::Linear, Interpolation::MonotoneCubic] {
            let table = line(
                &points,
                &Reading {
                    outside: Outside::Extrapolate,
                    interpolation,
                    scales: vec![("x".to_owned(), Scale::Log), ("answer".to_owned(), Scale::Log)],
                },
            );
            for x in [0.1, 1.0, 3.0, 20.0, 400.0] {
                assert!((table.value(&[x]).unwrap() / law(x) - 1.0).abs() < 1e-12, "{x}");
            }
            assert!(table.value(&[-1.0]).is_err());
        }
    }

    #[test]
    fn a_cubic_is_smooth_and_does_not_overshoot() {
        let steep = [(0.0, 0.0), (1.0, 0.0), (2.0, 1.0), (3.0, 1.0)];
        let cubic = Reading {
            interpolation: Interpolation::MonotoneCubic,
            ..Reading::default()
        };
        let table = line(&steep, &cubic);
        let at = |x: f64| table.value(&[x]).unwrap();
        assert_eq!((at(0.5), at(1.5), at(2.5)), (0.0, 0.5, 1.0));
        // Harmonic means cost accuracy for safety: a tenth of the first step at most.
        let square = line(&[0.0, 1.0, 2.0, 3.0, 4.0].map(|x| (x, x * x)), &cubic);
        for x in [0.3, 1.5, 2.7, 3.6] {
            assert!((square.value(&[x]).unwrap() - x * x).abs() < 0.1, "{x}");
        }
    }

    #[test]
    fn faults_name_the_line() {
        let fault = |text: &str| Table::from_csv(text, &reading(Outside::Error)).unwrap_err();
        assert!(fault("x [mm],y\n0,1\n1,a\n").contains("line 3, column `y`"));
        assert!(fault("x [mm],y\n0,1\n0,2\n1,1\n").contains("line 3: this point stands twice"));
        assert!(fault("x,y\n0,1\n").contains("no [unit]"));
        assert!(fault("a [mm],b [mm],y\n0,0,1\n1,1,1\n").contains("missing"));
        assert!(fault("a [mm],y\n0,1,2\n").contains("line"));
        let scaled = |name: &str| Reading {
            scales: vec![(name.to_owned(), Scale::Log)],
            ..Reading::default()
        };
        assert!(
            Table::from_csv(PLANE, &scaled("speed"))
                .unwrap_err()
                .contains("logarithmic")
        );
        assert!(
            Table::from_csv(PLANE, &scaled("torque"))
                .unwrap_err()
                .contains("axes are speed, temperature")
        );
        assert!(
            Table::from_csv("x [mm],y\n0,0\n1,1\n", &scaled("answer"))
                .unwrap_err()
                .contains("answer")
        );
    }

    proptest! {
        #[test]
        fn inside_the_value_stays_between_its_corners(x in 0.0..1000.0_f64, t in 20.0..80.0_f64) {
            let value = Table::from_csv(PLANE, &reading(Outside::Error)).unwrap().value(&[x, t]).unwrap();
            prop_assert!((1.0..=4.0).contains(&value));
        }

        #[test]
        fn between_two_points_a_cubic_stays_between_their_values(ys in prop::collection::vec(-5.0..5.0_f64, 3..7), t in 0.0..1.0_f64) {
            let points: Vec<(f64, f64)> = ys.iter().enumerate().map(|(i, y)| (i as f64 * (1.0 + i as f64), *y)).collect();
            let table = line(&points, &Reading { interpolation: Interpolation::MonotoneCubic, ..Reading::default() });
            for pair in points.windows(2) {
                let value = table.value(&[pair[0].0 + t * (pair[1].0 - pair[0].0)]).unwrap();
                let (low, high) = (pair[0].1.min(pair[1].1), pair[0].1.max(pair[1].1));
                prop_assert!(value >= low - 1e-12 && value <= high + 1e-12);
            }
        }
    }
}
