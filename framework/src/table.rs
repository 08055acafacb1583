//! Tables over one to four axes: linear in between, exact at the points.

use crate::loss::Undefined;

/// What holds beyond the ends of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outside {
    /// There is no value.
    Error,
    /// The value at the end.
    Clamp,
    /// The last slope goes on.
    Extrapolate,
}

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
    /// The last axis runs fastest.
    values: Vec<f64>,
    outside: Outside,
    unit: Option<String>,
}

impl Table {
    /// A table from axes and values, the last axis running fastest.
    ///
    /// # Errors
    /// If an axis does not rise, or the number of values does not fit.
    pub fn from_grid(axes: Vec<Axis>, values: Vec<f64>, outside: Outside) -> Result<Self, String> {
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
        Ok(Self {
            axes,
            values,
            outside,
            unit: None,
        })
    }

    /// A table from CSV: a column `name [unit]` for each axis, then one column for the value; one row for each point of
    /// the full grid, in any order. Lines that begin with # are comments.
    ///
    /// # Errors
    /// With the line of the file.
    pub fn from_csv(text: &str, outside: Outside) -> Result<Self, String> {
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
            ..Self::from_grid(axes, values, outside)?
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
    /// Beyond an end, where that is an error; at a coordinate that is not a number.
    pub fn value(&self, point: &[f64]) -> Result<f64, Undefined> {
        let mut cell = [(0_usize, 0.0_f64); 4];
        for ((axis, x), cell) in self.axes.iter().zip(point).zip(&mut cell) {
            let (first, last) = (axis.values[0], axis.values[axis.values.len() - 1]);
            if x.is_nan() || (self.outside == Outside::Error && (*x < first || *x > last)) {
                return Err(Undefined {
                    what: "coordinate beyond the end of the table",
                    value: *x,
                });
            }
            let x = if self.outside == Outside::Clamp {
                x.clamp(first, last)
            } else {
                *x
            };
            let i = axis.values.partition_point(|v| *v <= x).clamp(1, axis.values.len() - 1) - 1;
            *cell = (i, (x - axis.values[i]) / (axis.values[i + 1] - axis.values[i]));
        }
        let n = self.axes.len();
        let mut sum = 0.0;
        for corner in 0..1_usize << n {
            let (mut weight, mut place) = (1.0, 0);
            for (k, axis) in self.axes.iter().enumerate() {
                let upper = corner >> k & 1;
                let (i, t) = cell[k];
                weight *= if upper == 1 { t } else { 1.0 - t };
                place = place * axis.values.len() + i + upper;
            }
            if weight != 0.0 {
                sum += weight * self.values[place];
            }
        }
        Ok(sum)
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

    #[test]
    fn exact_at_the_points_and_linear_between() {
        let table = Table::from_csv(PLANE, Outside::Error).unwrap();
        for (point, expected) in [([0.0, 20.0], 1.0), ([1000.0, 80.0], 4.0), ([500.0, 50.0], 2.5)] {
            assert_eq!(table.value(&point).unwrap(), expected);
        }
    }

    #[test]
    fn beyond_the_ends() {
        let at = |outside| Table::from_csv(PLANE, outside).unwrap().value(&[2000.0, 20.0]);
        assert!(at(Outside::Error).is_err());
        assert_eq!(at(Outside::Clamp).unwrap(), 3.0);
        assert_eq!(at(Outside::Extrapolate).unwrap(), 5.0);
    }

    #[test]
    fn faults_name_the_line() {
        let fault = |text: &str| Table::from_csv(text, Outside::Error).unwrap_err();
        assert!(fault("x [mm],y\n0,1\n1,a\n").contains("line 3, column `y`"));
        assert!(fault("x [mm],y\n0,1\n0,2\n1,1\n").contains("line 3: this point stands twice"));
        assert!(fault("x,y\n0,1\n").contains("no [unit]"));
        assert!(fault("a [mm],b [mm],y\n0,0,1\n1,1,1\n").contains("missing"));
        assert!(fault("a [mm],y\n0,1,2\n").contains("line"));
    }

    proptest! {
        #[test]
        fn inside_the_value_stays_between_its_corners(x in 0.0..1000.0_f64, t in 20.0..80.0_f64) {
            let value = Table::from_csv(PLANE, Outside::Error).unwrap().value(&[x, t]).unwrap();
            prop_assert!((1.0..=4.0).contains(&value));
        }
    }
}
