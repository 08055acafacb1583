//! Tables over one to four axes: linear or monotone cubic interpolation, exact at the points, on linear or logarithmic scales.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use gearloss_document::data::{self, TableForm};

use crate::loss::Undefined;

/// Extrapolation of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Outside {
    /// The result is undefined.
    #[default]
    Error,
    /// The value at the end.
    Clamp,
    /// Linear extrapolation.
    Extrapolate,
}

/// Scale of an axis or of the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// Linear.
    #[default]
    Linear,
    /// Logarithmic; all values must be positive.
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

/// Interpolation between the points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// Linear along each axis in turn.
    #[default]
    Linear,
    /// Monotone cubic (Fritsch and Butland 1984) along each axis in turn.
    MonotoneCubic,
}

/// Options of a table.
#[derive(Debug, Clone, Default)]
pub struct Reading {
    /// Extrapolation.
    pub outside: Outside,
    /// Interpolation.
    pub interpolation: Interpolation,
    /// Scales by the name of an axis; `answer` is the result. Default: linear.
    pub scales: Vec<(String, Scale)>,
    /// Names among axes and `answer` that are logarithmic if all their values are positive, unless `scales` names them.
    pub usually_log: &'static [&'static str],
}

impl Reading {
    fn scale(&self, name: &str, values: &[f64]) -> Scale {
        match self.scales.iter().find(|(n, _)| n == name) {
            Some((_, scale)) => *scale,
            None if self.usually_log.contains(&name) && values.iter().all(|x| *x > 0.0) => Scale::Log,
            None => Scale::Linear,
        }
    }
}

/// Name of the result among the scales.
const ANSWER: &str = "answer";

/// One axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Name, as in the header.
    pub name: String,
    /// Unit, as in the header.
    pub unit: String,
    /// Increasing values.
    pub values: Vec<f64>,
}

/// A table over a full grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    axes: Vec<Axis>,
    /// Values of each axis on its scale.
    places: Vec<Vec<f64>>,
    scales: Vec<Scale>,
    /// Results on their scale; the last axis varies fastest.
    values: Vec<f64>,
    answer: Scale,
    outside: Outside,
    interpolation: Interpolation,
    unit: Option<String>,
}

impl Table {
    /// A table from axes and values, the last axis varying fastest.
    ///
    /// # Errors
    /// If an axis does not increase, the number of values does not match, or a scale is invalid.
    pub(crate) fn from_grid(axes: Vec<Axis>, values: Vec<f64>, reading: &Reading) -> Result<Self, String> {
        if axes.is_empty() || axes.len() > 4 {
            return Err(format!("{} axes; a table has one to four", axes.len()));
        }
        for axis in &axes {
            if axis.values.windows(2).any(|w| w[1] <= w[0]) || axis.values.iter().any(|x| !x.is_finite()) {
                return Err(format!("axis `{}` does not increase", axis.name));
            }
            if axis.values.len() < 2 {
                return Err(format!("axis `{}` has one value; a table requires two", axis.name));
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
                    "`scale` names `{name}`, but the axes are {}; the result is `answer`",
                    names.join(", ")
                ));
            }
        }
        let scales: Vec<Scale> = axes.iter().map(|a| reading.scale(&a.name, &a.values)).collect();
        for (axis, scale) in axes.iter().zip(&scales) {
            if *scale == Scale::Log && axis.values[0] <= 0.0 {
                return Err(format!(
                    "axis `{}` is logarithmic but has {}",
                    axis.name, axis.values[0]
                ));
            }
        }
        let answer = reading.scale(ANSWER, &values);
        if let (Scale::Log, Some(value)) = (answer, values.iter().find(|v| **v <= 0.0)) {
            return Err(format!("`answer` is logarithmic but has {value}"));
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

    /// A table from the bytes of a CSV file, a workbook or an MDF file: a column `name [unit]` for each axis, then one column for the value;
    /// one row for each point of the full grid, in the order of increasing axes. Lines that begin with # are comments.
    ///
    /// # Errors
    /// The line, the column and the problem.
    pub fn from_file(bytes: impl AsRef<[u8]>, reading: &Reading) -> Result<Self, String> {
        let cells = cells(bytes.as_ref())?;
        let mut tables = Self::from_cells(&cells, reading, cells.names.len().saturating_sub(1))?;
        tables.pop().ok_or_else(|| "line 1: no column".to_owned())
    }

    /// As [`Table::from_file`], with a stated number of axes; every column after them is a separate table.
    ///
    /// # Errors
    /// As [`Table::from_file`].
    pub fn several_from_file(bytes: impl AsRef<[u8]>, reading: &Reading, axes: usize) -> Result<Vec<Self>, String> {
        Self::from_cells(&cells(bytes.as_ref())?, reading, axes)
    }

    /// As [`Table::from_file`], with one table for each word in a column of words, in the order of the file; a single one with an empty word if
    /// there is no such column.
    ///
    /// # Errors
    /// As [`Table::from_file`].
    pub fn by_word(bytes: impl AsRef<[u8]>, reading: &Reading, column: &str) -> Result<Vec<(String, Self)>, String> {
        let mut cells = cells(bytes.as_ref())?;
        let axes = |cells: &data::cells::Table| cells.names.len().saturating_sub(1);
        let Some(place) = cells.names.iter().position(|name| name.trim() == column) else {
            let mut tables = Self::from_cells(&cells, reading, axes(&cells))?;
            let only = tables.pop().ok_or_else(|| "line 1: no column".to_owned())?;
            return Ok(vec![(String::new(), only)]);
        };
        cells.names.remove(place);
        if place < cells.units.len() {
            cells.units.remove(place);
        }
        let mut groups: Vec<(String, Vec<(u64, Vec<String>)>)> = Vec::new();
        for (line, mut row) in std::mem::take(&mut cells.rows) {
            if place >= row.len() {
                return Err(format!("line {line}: no `{column}`"));
            }
            let word = row.remove(place).trim().to_owned();
            match groups.iter_mut().find(|(known, _)| *known == word) {
                Some((_, rows)) => rows.push((line, row)),
                None => groups.push((word, vec![(line, row)])),
            }
        }
        let mut tables = Vec::new();
        for (word, rows) in groups {
            cells.rows = rows;
            let found = Self::from_cells(&cells, reading, axes(&cells))?.pop();
            tables.push((word, found.ok_or_else(|| "line 1: no column".to_owned())?));
        }
        Ok(tables)
    }

    fn from_cells(cells: &data::cells::Table, reading: &Reading, axes: usize) -> Result<Vec<Self>, String> {
        let header = headings(cells);
        let at_header = cells.at_header();
        if axes == 0 || axes > 4 || header.len() <= axes {
            return Err(format!(
                "{at_header}{} columns, {axes} of them axes; a table has one to four axes and a value",
                header.len()
            ));
        }
        let rows = rows(cells)?;
        let mut names = Vec::new();
        for (column, name) in header.iter().take(axes).enumerate() {
            let (name, rest) = name.split_once('[').ok_or_else(|| {
                format!(
                    "line {}, column {} `{name}`: no [unit]",
                    cells.header_line.max(1),
                    column + 1
                )
            })?;
            names.push((name.trim().to_owned(), rest.trim_end_matches(']').to_owned()));
        }
        let grid: Vec<Axis> = names
            .into_iter()
            .enumerate()
            .map(|(column, (name, unit))| {
                Ok(Axis {
                    name,
                    unit,
                    values: rising(&rows, column, &header[column], cells.header_line.max(1))?,
                })
            })
            .collect::<Result<_, String>>()?;
        let count: usize = grid.iter().fold(1, |n: usize, a| n.saturating_mul(a.values.len()));
        if count > 10_000_000 {
            return Err(format!(
                "the axes span {count} points; check for values that should be equal"
            ));
        }
        let mut filled: Vec<Option<usize>> = vec![None; count];
        for (i, (row, line)) in rows.iter().enumerate() {
            let place = grid.iter().zip(row).fold(0, |place, (axis, x)| {
                place * axis.values.len() + axis.values.partition_point(|v| v < x)
            });
            if filled[place].is_some() {
                return Err(format!("line {line}: this point occurs twice"));
            }
            filled[place] = Some(i);
        }
        if let Some(place) = filled.iter().position(Option::is_none) {
            let missing = filled.iter().filter(|f| f.is_none()).count();
            let after = filled[..place]
                .iter()
                .flatten()
                .max()
                .map_or(cells.header_line.max(1), |row| rows[*row].1);
            let are = if missing == 1 { "is" } else { "are" };
            return Err(format!(
                "line {after}: the next point, {}, is missing; {missing} of {count} points {are} missing in all",
                named(&grid, place)
            ));
        }
        header
            .iter()
            .enumerate()
            .skip(axes)
            .map(|(column, name)| {
                let values = filled.iter().flatten().map(|row| rows[*row].0[column]).collect();
                let unit = name
                    .split_once('[')
                    .map(|(_, rest)| rest.trim_end_matches(']').to_owned());
                Ok(Self {
                    unit,
                    ..Self::from_grid(grid.clone(), values, reading)?
                })
            })
            .collect()
    }

    /// Position of a point along the axis on which it is farthest outside: from zero to one inside, on the scale of the axis.
    pub fn place(&self, point: &[f64]) -> f64 {
        let mut farthest = 0.5;
        for ((x, places), scale) in point.iter().zip(&self.places).zip(&self.scales) {
            let (first, last) = (places[0], places[places.len() - 1]);
            let place = (scale.apply(*x) - first) / (last - first);
            if (place - 0.5_f64).abs() > (farthest - 0.5_f64).abs() {
                farthest = place;
            }
        }
        farthest
    }

    /// Unit of the values, if the header states it.
    pub fn unit(&self) -> Option<&str> {
        self.unit.as_deref()
    }

    /// The points of the grid: coordinates and result.
    pub fn points(&self) -> Vec<(Vec<f64>, f64)> {
        let mut points = Vec::with_capacity(self.values.len());
        for (place, value) in self.values.iter().enumerate() {
            let mut rest = place;
            let mut point: Vec<f64> = self
                .axes
                .iter()
                .rev()
                .map(|axis| {
                    let x = axis.values[rest % axis.values.len()];
                    rest /= axis.values.len();
                    x
                })
                .collect();
            point.reverse();
            let answer = match self.answer {
                Scale::Linear => *value,
                Scale::Log => value.exp(),
            };
            points.push((point, answer));
        }
        points
    }

    /// The axes.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// The value at a point, one coordinate for each axis.
    ///
    /// # Errors
    /// Outside the axes, if that is an error; at a coordinate that is NaN, or has no logarithm.
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

    /// Interpolates along one axis and, at the required points, along those after it.
    fn along(&self, axis: usize, place: usize, cells: &[(usize, f64); 4]) -> f64 {
        let Some(xs) = self.places.get(axis) else {
            return self.values[place];
        };
        let (i, x) = cells[axis];
        let at = |j: usize| self.along(axis + 1, place * xs.len() + j, cells);
        // Exact at the points, and free along an axis whose coordinate is a point.
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
        let slope_at = |near: Option<(f64, f64)>, other: Option<(f64, f64)>| match (near, other) {
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

/// The cells of a file. Its header is the first line, unless another has more texts.
fn cells(bytes: &[u8]) -> Result<data::cells::Table, String> {
    let is_text = |name: &str| name.parse::<f64>().is_err();
    data::cells::table(bytes, &TableForm::default(), &is_text, &mut Vec::new())
        .map_err(|wrong| format!("{} ({})", wrong.message, wrong.help))
}

/// The headings of the columns, with their units.
fn headings(cells: &data::cells::Table) -> Vec<String> {
    let heading = |(name, unit): (&String, &Option<String>)| match unit {
        Some(unit) => format!("{name} [{unit}]"),
        None => name.clone(),
    };
    cells.names.iter().zip(&cells.units).map(heading).collect()
}

/// Names of the columns of a table, without their units.
///
/// # Errors
/// If the file has no header.
pub fn columns(bytes: impl AsRef<[u8]>) -> Result<Vec<String>, String> {
    Ok(cells(bytes.as_ref())?.names)
}

/// All numbers of a file with their line numbers.
fn rows(cells: &data::cells::Table) -> Result<Vec<(Vec<f64>, u64)>, String> {
    let (header, width) = (headings(cells), cells.names.len());
    let mut rows = Vec::new();
    for (line, row) in &cells.rows {
        if row.len() != width {
            return Err(format!("line {line}: {} cells, but the header has {width}", row.len()));
        }
        let number = |(column, (cell, name)): (usize, (&String, &String))| {
            let number = cells.numbers.number(cell);
            number.ok_or_else(|| format!("line {line}, column {} `{name}`: `{cell}` is not a number", column + 1))
        };
        rows.push((
            row.iter()
                .zip(&header)
                .enumerate()
                .map(number)
                .collect::<Result<_, _>>()?,
            *line,
        ));
    }
    Ok(rows)
}

/// The values of an axis, which must occur in increasing order.
fn rising(rows: &[(Vec<f64>, u64)], column: usize, name: &str, header_line: u64) -> Result<Vec<f64>, String> {
    let mut values: Vec<f64> = Vec::new();
    for (row, line) in rows {
        let x = row[column];
        match values.last() {
            Some(last) if x <= *last && values.binary_search_by(|v| v.total_cmp(&x)).is_err() => {
                return Err(format!(
                    "line {line}, column {} `{name}`: {x} follows {last}; the values of an axis must increase",
                    column + 1
                ));
            }
            Some(last) if x <= *last => {}
            _ => values.push(x),
        }
    }
    if values.len() < 2 {
        let line = rows.last().map_or(header_line, |(_, line)| *line);
        return Err(format!(
            "line {line}, column {} `{name}`: {} up to here; a table requires two values on each axis",
            column + 1,
            if values.is_empty() { "no value" } else { "one value" },
        ));
    }
    Ok(values)
}

/// The coordinates of a point of a grid.
fn named(grid: &[Axis], place: usize) -> String {
    let mut rest = place;
    let mut words: Vec<String> = Vec::new();
    for axis in grid.iter().rev() {
        words.push(format!(
            "{} = {} {}",
            axis.name,
            axis.values[rest % axis.values.len()],
            axis.unit
        ));
        rest /= axis.values.len();
    }
    words.reverse();
    words.join(", ")
}

/// Slope at a point between two intervals with lengths and slopes: zero at an extremum, else a weighted harmonic mean.
fn inner_slope(h_1: f64, d_1: f64, h_2: f64, d_2: f64) -> f64 {
    if d_1 * d_2 <= 0.0 {
        return 0.0;
    }
    let (w_1, w_2) = (2.0 * h_2 + h_1, h_2 + 2.0 * h_1);
    (w_1 + w_2) / (w_1 / d_1 + w_2 / d_2)
}

/// Slope at an end, from its interval and the next: that of a parabola, limited to avoid overshoot.
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

/// Linear between points, constant beyond the ends. The first list increases and both have the same length.
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
        let table = Table::from_file(PLANE, &reading(Outside::Error)).unwrap();
        for (point, expected) in [([0.0, 20.0], 1.0), ([1000.0, 80.0], 4.0), ([500.0, 50.0], 2.5)] {
            assert_eq!(table.value(&point).unwrap(), expected);
        }
    }

    #[test]
    fn beyond_the_ends() {
        let at = |outside| {
            Table::from_file(PLANE, &reading(outside))
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
                    ..Reading::default()
                },
            );
            for x in [0.1, 1.0, 3.0, 20.0, 400.0] {
                assert!((table.value(&[x]).unwrap() / law(x) - 1.0).abs() < 1e-12, "{x}");
            }
            assert!(table.value(&[-1.0]).is_err());
        }
    }

    #[test]
    fn several_columns_are_several_tables_and_places_are_shares_of_an_axis() {
        let text = "n [rpm],t [degC],pressure [Nm],viscous [Nm]\n10,20,1,5\n10,40,2,6\n1000,20,3,7\n1000,40,4,0\n";
        let reading = Reading {
            outside: Outside::Clamp,
            usually_log: &["n", "answer"],
            ..Reading::default()
        };
        let tables = Table::several_from_file(text, &reading, 2).unwrap();
        assert_eq!((tables.len(), tables[1].unit()), (2, Some("Nm")));
        assert_eq!(columns(text).unwrap(), ["n", "t", "pressure", "viscous"]);
        // The first result is positive everywhere and becomes logarithmic, the second is not.
        assert!((tables[0].value(&[100.0, 20.0]).unwrap() - 3.0_f64.sqrt()).abs() < 1e-12);
        assert!((tables[1].value(&[100.0, 20.0]).unwrap() - 6.0).abs() < 1e-12);
        for (point, place) in [([100.0, 30.0], 0.5), ([100.0, 60.0], 2.0), ([1.0, 30.0], -0.5)] {
            assert!((tables[0].place(&point) - place).abs() < 1e-12);
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
        // Harmonic means trade accuracy for monotonicity: an error of at most a tenth of the first step.
        let square = line(&[0.0, 1.0, 2.0, 3.0, 4.0].map(|x| (x, x * x)), &cubic);
        for x in [0.3, 1.5, 2.7, 3.6] {
            assert!((square.value(&[x]).unwrap() - x * x).abs() < 0.1, "{x}");
        }
    }

    #[test]
    fn faults_name_the_line() {
        let fault = |text: &str| Table::from_file(text, &reading(Outside::Error)).unwrap_err();
        assert!(fault("x [mm],y\n0,1\n1,a\n").contains("line 3, column 2 `y`: `a` is not a number"));
        assert!(fault("x [mm],y\n0,1\nNaN,2\n").contains("line 3, column 1 `x [mm]`: `NaN` is not a number"));
        assert!(fault("x [mm],y\n0,1\n2,2\n1,3\n").contains("line 4, column 1 `x [mm]`: 1 follows 2"));
        assert!(fault("x [mm],y\n0,1\n").contains("line 2, column 1 `x [mm]`: one value up to here"));
        assert!(fault("x [mm],y\n").contains("line 1, column 1 `x [mm]`: no value up to here"));
        assert!(
            fault("# a\na [mm],b [s],y\n0,0,1\n0,1,1\n1,0,1\n")
                .contains("line 5: the next point, a = 1 mm, b = 1 s, is missing; 1 of 4")
        );
        assert!(fault("x [mm],y\n0,1\n0,2\n1,1\n").contains("line 3: this point occurs twice"));
        assert!(fault("x,y\n0,1\n").contains("no [unit]"));
        assert!(fault("a [mm],b [mm],y\n0,0,1\n1,1,1\n").contains("missing"));
        assert!(fault("a [mm],y\n0,1,2\n").contains("line 2: 3 cells, but the header has 2"));
        let scaled = |name: &str| Reading {
            scales: vec![(name.to_owned(), Scale::Log)],
            ..Reading::default()
        };
        assert!(
            Table::from_file(PLANE, &scaled("speed"))
                .unwrap_err()
                .contains("logarithmic")
        );
        assert!(
            Table::from_file(PLANE, &scaled("torque"))
                .unwrap_err()
                .contains("axes are speed, temperature")
        );
        assert!(
            Table::from_file("x [mm],y\n0,0\n1,1\n", &scaled("answer"))
                .unwrap_err()
                .contains("answer")
        );
    }

    proptest! {
        #[test]
        fn inside_the_value_stays_between_its_corners(x in 0.0..1000.0_f64, t in 20.0..80.0_f64) {
            let value = Table::from_file(PLANE, &reading(Outside::Error)).unwrap().value(&[x, t]).unwrap();
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
