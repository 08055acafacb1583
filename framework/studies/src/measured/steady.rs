//! Steady intervals of a time series: detected by their drift, and averaged to one point each.
//!
//! An interval starts when every limited quantity is within its limits over one window, or up to half a window later if that contains less of
//! a preceding ramp, and grows sample by sample while the limits hold over its last window and over the whole interval. The drift is the
//! slope of a least-squares line times the duration, the scatter is the standard deviation about that line. The ends of an interval may
//! contain the first samples of a ramp; they change the mean by at most about a sixth of the drift limit, because a sum S of deviations at
//! one end of n samples gives a drift of 6 S / n.

use schemars::JsonSchema;
use serde::Deserialize;

use super::columns::KNOWN;
use super::{MeasuredFault, Row};
use gearloss_framework::document::Unit;

/// Minimum number of samples in a window. An assumption.
const FEWEST: usize = 5;

/// Gaps between samples longer than this share of the window end an interval. An assumption.
const GAP: f64 = 0.5;

/// Share of the drift limit below which a later start is not searched. An assumption.
const SETTLED: f64 = 0.25;

/// Maximum number of summed lags of the autocorrelation, and of products.
const MOST_LAGS: usize = 1000;
const MOST_PRODUCTS: usize = 20_000_000;

/// Detection of steady intervals of a time series; each becomes one point.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SteadyEntry {
    /// Column of the time; its unit is in the header, in the row of units or in `units: { time: s }`.
    #[serde(default = "time")]
    pub time: String,
    /// Minimum duration of an interval. [s]
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub window: f64,
    /// Maximum drift within a window and over the whole interval: slope times duration.
    pub drift: SteadyLimitsEntry,
    /// Maximum standard deviation about the drift.
    #[serde(default)]
    pub scatter: SteadyLimitsEntry,
}

fn time() -> String {
    "time".to_owned()
}

/// Limits of quantities; other quantities are not limited.
#[derive(Debug, Clone, Copy, Default, Deserialize, JsonSchema)]
pub struct SteadyLimitsEntry {
    /// Limit of the torque. [Nm]
    #[schemars(range(min = 1e-9, max = 1e9))]
    pub torque: Option<f64>,
    /// Limit of the speed. [rpm]
    #[schemars(range(min = 1e-9, max = 1e6))]
    pub speed: Option<f64>,
    /// Limit of the torque at the other port. [Nm]
    #[schemars(range(min = 1e-9, max = 1e9))]
    pub torque_out: Option<f64>,
    /// Limit of the speed at the other port. [rpm]
    #[schemars(range(min = 1e-9, max = 1e6))]
    pub speed_out: Option<f64>,
    /// Limit of the efficiency, as a fraction. [-]
    #[schemars(range(min = 1e-9, max = 1.0))]
    pub efficiency: Option<f64>,
    /// Limit of the power loss. [W]
    #[schemars(range(min = 1e-9, max = 1e9))]
    pub loss: Option<f64>,
    /// Limit of the loss torque. [Nm]
    #[schemars(range(min = 1e-9, max = 1e9))]
    pub loss_torque: Option<f64>,
    /// Limit of the oil temperature. [K]
    #[schemars(range(min = 1e-9, max = 1000.0))]
    pub oil_temperature: Option<f64>,
    /// Limit of the surface temperature. [K]
    #[schemars(range(min = 1e-9, max = 1000.0))]
    pub surface_temperature: Option<f64>,
}

impl SteadyLimitsEntry {
    /// The stated limits by quantity.
    fn stated(&self) -> Vec<(&'static str, f64)> {
        let all = [
            ("torque", self.torque),
            ("speed", self.speed),
            ("torque_out", self.torque_out),
            ("speed_out", self.speed_out),
            ("efficiency", self.efficiency),
            ("loss", self.loss),
            ("loss_torque", self.loss_torque),
            ("oil_temperature", self.oil_temperature),
            ("surface_temperature", self.surface_temperature),
        ];
        all.into_iter()
            .filter_map(|(quantity, limit)| Some((quantity, limit?)))
            .collect()
    }
}

impl SteadyEntry {
    /// Errors of the entry.
    pub(super) fn faults(&self) -> Option<MeasuredFault> {
        self.drift.stated().is_empty().then(|| {
            MeasuredFault::new(
                "steady.drift",
                "no drift limit is given, so every interval would be steady",
                "write limits such as `drift: { torque: 0.5 Nm, speed: 5 rpm }`",
            )
        })
    }
}

/// The averaged samples of a point.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Stretch {
    /// Number of samples.
    pub samples: usize,
    /// \[s\]
    pub duration: f64,
    /// Standard error of the mean of each quantity, corrected for autocorrelation; in the order of the quantities.
    pub standard_errors: Vec<Option<f64>>,
}

/// A limited quantity: its index and its limits.
struct Limited {
    place: usize,
    drift: Option<f64>,
    scatter: Option<f64>,
}

/// The steady intervals of a time series, each as one row, and a note on them.
pub(super) fn stretches(
    entry: &SteadyEntry,
    quantities: &[&'static str],
    rows: Vec<(f64, Row)>,
) -> Result<(Vec<Row>, String), MeasuredFault> {
    let limits = limited(entry, quantities)?;
    let (times, rows): (Vec<f64>, Vec<Row>) = rows.into_iter().unzip();
    if let Some(k) = (1..times.len()).find(|k| times[*k] <= times[*k - 1]) {
        return Err(MeasuredFault::new(
            "steady.time",
            format!("line {}: the time does not increase", rows[k].line),
            "sort the rows by time, and use a separate file for each recording",
        ));
    }
    let series = Series {
        entry,
        limits,
        times,
        rows,
    };
    let found = series.stretches()?;
    let points: Vec<Row> = found.iter().map(|place| series.mean(quantities, *place)).collect();
    let note = series.note(quantities, &points);
    Ok((points, note))
}

fn limited(entry: &SteadyEntry, quantities: &[&'static str]) -> Result<Vec<Limited>, MeasuredFault> {
    let mut limits: Vec<Limited> = Vec::new();
    for (key, stated) in [("drift", entry.drift.stated()), ("scatter", entry.scatter.stated())] {
        for (quantity, limit) in stated {
            let Some(place) = quantities.iter().position(|q| *q == quantity) else {
                return Err(MeasuredFault::new(
                    format!("steady.{key}.{quantity}"),
                    format!("there is no column of `{quantity}`, whose {key} is limited"),
                    format!("the file has {}: limit one of these", quantities.join(", ")),
                ));
            };
            let (drift, scatter) = match key {
                "drift" => (Some(limit), None),
                _ => (None, Some(limit)),
            };
            match limits.iter_mut().find(|other| other.place == place) {
                Some(other) => other.scatter = scatter,
                None => limits.push(Limited { place, drift, scatter }),
            }
        }
    }
    Ok(limits)
}

/// First and last sample.
type Span = [usize; 2];

struct Series<'a> {
    entry: &'a SteadyEntry,
    limits: Vec<Limited>,
    times: Vec<f64>,
    rows: Vec<Row>,
}

impl Series<'_> {
    /// Steady intervals from the first to the last, without overlap.
    fn stretches(&self) -> Result<Vec<Span>, MeasuredFault> {
        let (mut found, mut windows, mut sparse) = (Vec::new(), 0, 0);
        let mut sliding = Sliding::new(self);
        for [first, last] in self.pieces() {
            let mut start = first;
            while let Some(end) = self.window_after(start, last) {
                windows += 1;
                if end - start + 1 < FEWEST {
                    sparse += 1;
                }
                if end - start + 1 < FEWEST || !sliding.is_steady([start, end]) {
                    start += 1;
                    continue;
                }
                let [begin, end] = self.settled(&mut sliding, [start, end], last);
                let end = self.grown(&mut sliding, [begin, end], last);
                found.push([begin, end]);
                start = end + 1;
            }
        }
        if windows > 0 && sparse == windows {
            return Err(MeasuredFault::new(
                "steady.window",
                format!("a window of {} s has fewer than {FEWEST} samples", self.entry.window),
                "use a longer window, or a file with more samples",
            ));
        }
        Ok(found)
    }

    /// Pieces with one gear and one set of bound values, without gaps in time.
    fn pieces(&self) -> Vec<Span> {
        let mut pieces: Vec<Span> = Vec::new();
        for (k, row) in self.rows.iter().enumerate() {
            let goes_on = k > 0
                && row.gear == self.rows[k - 1].gear
                && row.bound == self.rows[k - 1].bound
                && self.times[k] - self.times[k - 1] <= GAP * self.entry.window;
            match pieces.last_mut() {
                Some(piece) if goes_on => piece[1] = k,
                _ => pieces.push([k, k]),
            }
        }
        pieces
    }

    /// A window with tolerance for the rounding of times.
    fn window(&self) -> f64 {
        self.entry.window * (1.0 - 1e-9)
    }

    /// Last sample of the window that starts at a sample.
    fn window_after(&self, start: usize, last: usize) -> Option<usize> {
        let end = start + self.times[start..=last].partition_point(|t| t - self.times[start] < self.window());
        (end <= last).then_some(end)
    }

    /// First sample of the window that ends at a sample.
    fn window_before(&self, first: usize, end: usize) -> usize {
        let inside = self.times[first..=end].partition_point(|t| self.times[end] - t >= self.window());
        (first + inside).saturating_sub(1).max(first)
    }

    fn line(&self, limited: &Limited, [start, end]: Span) -> Line {
        let mut line = Line::default();
        for k in start..=end {
            line.add(self.times[k], self.rows[k].values[limited.place]);
        }
        line
    }

    /// The first steady window, or a later one with less of a ramp: within half a window the first whose drift is a quarter of the limit,
    /// otherwise the one with the minimum drift.
    fn settled(&self, sliding: &mut Sliding<'_>, first: Span, last: usize) -> Span {
        let (mut best, mut least) = (first, sliding.drift());
        let mut start = first[0];
        while least > SETTLED {
            start += 1;
            let near = start <= last && self.times[start] - self.times[first[0]] <= 0.5 * self.entry.window;
            let Some(end) = near.then(|| self.window_after(start, last)).flatten() else {
                break;
            };
            if end - start + 1 < FEWEST || !sliding.is_steady([start, end]) {
                break;
            }
            // Ignore differences due to rounding.
            if sliding.drift() < 0.99 * least {
                (best, least) = ([start, end], sliding.drift());
            }
        }
        best
    }

    /// Last sample of the interval that starts with a steady window.
    fn grown(&self, sliding: &mut Sliding<'_>, [start, end]: Span, last: usize) -> usize {
        let mut lines: Vec<Line> = self.limits.iter().map(|l| self.line(l, [start, end])).collect();
        for next in end + 1..=last {
            let window = self.window_before(start, next);
            let duration = self.times[next] - self.times[start];
            let fits = sliding.is_steady([window, next])
                && self.limits.iter().zip(&mut lines).all(|(limited, line)| {
                    line.add(self.times[next], self.rows[next].values[limited.place]);
                    line.keeps(limited, duration)
                });
            if !fits {
                return next - 1;
            }
        }
        last
    }

    /// The mean of an interval.
    fn mean(&self, quantities: &[&str], [start, end]: Span) -> Row {
        let rows = &self.rows[start..=end];
        let first = &self.rows[start];
        let (mut values, mut standard_errors) = (Vec::new(), Vec::new());
        for place in 0..quantities.len() {
            let mut line = Line::default();
            for (time, row) in self.times[start..=end].iter().zip(rows) {
                line.add(*time, row.values[place]);
            }
            let mean = (line.count > 0.0).then_some(line.value);
            values.push(mean);
            let residuals = self.times[start..=end].iter().zip(rows);
            let residuals: Vec<f64> = residuals
                .filter_map(|(time, row)| Some(row.values[place]? - line.value - line.slope() * (time - line.time)))
                .collect();
            standard_errors.push(standard_error(&residuals));
        }
        Row {
            values,
            stretch: Some(Stretch {
                samples: rows.len(),
                duration: self.times[end] - self.times[start],
                standard_errors,
            }),
            cells: (0..first.cells.len()).map(|place| averaged(rows, place)).collect(),
            ..first.clone()
        }
    }

    /// Number of intervals, their share of the time, and the standard errors of their means.
    fn note(&self, quantities: &[&str], points: &[Row]) -> String {
        let stretches: Vec<&Stretch> = points.iter().filter_map(|row| row.stretch.as_ref()).collect();
        let whole = self.times.last().unwrap_or(&0.0) - self.times.first().unwrap_or(&0.0);
        let held: f64 = stretches.iter().map(|s| s.duration).sum();
        let percent = if whole > 0.0 { 100.0 * held / whole } else { 0.0 };
        let noun = if points.len() == 1 { "interval" } else { "intervals" };
        let mut words = format!("{} steady {noun}, {percent:.0} % of {whole:.0} s", points.len());
        let samples = stretches.iter().map(|s| s.samples);
        if let (Some(fewest), Some(most)) = (samples.clone().min(), samples.max()) {
            words.push_str(&format!("; {fewest} to {most} samples each"));
        }
        let errors: Vec<String> = (quantities.iter().enumerate())
            .filter(|(_, quantity)| !quantity.ends_with("_accuracy") && **quantity != "weight")
            .filter_map(|(place, quantity)| {
                let errors = stretches.iter().filter_map(|s| s.standard_errors[place]);
                Some(format!("{quantity} {}", shown(quantity, errors.reduce(f64::max)?)))
            })
            .collect();
        if !errors.is_empty() {
            words.push_str(&format!(
                "; largest standard errors of the means: {}",
                errors.join(", ")
            ));
        }
        words
    }
}

/// The cell of a column over several rows: the mean of its numbers, or the common text; otherwise blank.
fn averaged(rows: &[Row], place: usize) -> String {
    let cell = |row: &Row| row.cells.get(place).cloned().unwrap_or_default();
    let first = cell(&rows[0]);
    let numbers: Option<Vec<f64>> = rows
        .iter()
        .map(|row| cell(row).parse::<f64>().ok().filter(|x| x.is_finite()))
        .collect();
    match numbers {
        Some(numbers) => (numbers.iter().sum::<f64>() / numbers.len() as f64).to_string(),
        None if rows.iter().all(|row| cell(row) == first) => first,
        None => String::new(),
    }
}

/// A difference of a quantity in its documented unit.
fn shown(quantity: &str, difference: f64) -> String {
    let unit = KNOWN
        .iter()
        .find(|known| known.name == quantity)
        .map(|known| known.unit);
    let (symbol, factor) = match unit.and_then(Unit::of_symbol) {
        Some(unit) if unit.symbol == "degC" => (" K".to_owned(), 1.0),
        Some(unit) if unit.symbol != "-" => (format!(" {}", unit.symbol), unit.factor),
        _ => (String::new(), 1.0),
    };
    format!("{:.2e}{symbol}", difference / factor)
}

/// Lines over a moving window.
struct Sliding<'a> {
    series: &'a Series<'a>,
    /// One for each limited quantity.
    lines: Vec<Line>,
    span: Option<Span>,
    /// Samples removed since the lines were refitted.
    removed: usize,
}

impl<'a> Sliding<'a> {
    fn new(series: &'a Series<'a>) -> Self {
        Self {
            series,
            lines: Vec::new(),
            span: None,
            removed: 0,
        }
    }

    fn is_steady(&mut self, span: Span) -> bool {
        self.move_to(span);
        let duration = self.series.times[span[1]] - self.series.times[span[0]];
        (self.series.limits.iter().zip(&self.lines)).all(|(limited, line)| line.keeps(limited, duration))
    }

    /// The largest drift over its limit.
    fn drift(&self) -> f64 {
        let duration = self
            .span
            .map_or(0.0, |[start, end]| self.series.times[end] - self.series.times[start]);
        let share = |(limited, line): (&Limited, &Line)| Some(line.slope().abs() * duration / limited.drift?);
        let shares = self.series.limits.iter().zip(&self.lines).filter_map(share);
        shares.fold(0.0, f64::max)
    }

    fn move_to(&mut self, [start, end]: Span) {
        let series = self.series;
        // Rounding errors of removals accumulate, so the lines are refitted after each complete window.
        let goes_on = self.span.filter(|[first, last]| {
            *first <= start && start <= *last && *last <= end && self.removed + start - first <= end - start
        });
        if let Some([first, last]) = goes_on {
            for (limited, line) in series.limits.iter().zip(&mut self.lines) {
                let value = |k: usize| series.rows[k].values[limited.place];
                (last + 1..=end).for_each(|k| line.add(series.times[k], value(k)));
                (first..start).for_each(|k| line.remove(series.times[k], value(k)));
            }
            self.removed += start - first;
        } else {
            self.lines = series.limits.iter().map(|l| series.line(l, [start, end])).collect();
            self.removed = 0;
        }
        self.span = Some([start, end]);
    }
}

/// A line fitted incrementally by the updating formulas of Welford.
#[derive(Debug, Clone, Copy, Default)]
struct Line {
    count: f64,
    /// Means of time and value.
    time: f64,
    value: f64,
    /// Sums of squares and products about the means.
    time_time: f64,
    time_value: f64,
    value_value: f64,
}

impl Line {
    fn add(&mut self, time: f64, value: Option<f64>) {
        let Some(value) = value else { return };
        self.count += 1.0;
        let (dt, dv) = (time - self.time, value - self.value);
        self.time += dt / self.count;
        self.value += dv / self.count;
        self.time_time += dt * (time - self.time);
        self.time_value += dt * (value - self.value);
        self.value_value += dv * (value - self.value);
    }

    fn remove(&mut self, time: f64, value: Option<f64>) {
        let Some(value) = value else { return };
        if self.count <= 1.0 {
            *self = Self::default();
            return;
        }
        self.count -= 1.0;
        let (dt, dv) = (time - self.time, value - self.value);
        self.time -= dt / self.count;
        self.value -= dv / self.count;
        self.time_time = (self.time_time - dt * (time - self.time)).max(0.0);
        self.time_value -= dv * (time - self.time);
        self.value_value = (self.value_value - dv * (value - self.value)).max(0.0);
    }

    fn slope(&self) -> f64 {
        if self.time_time > 0.0 {
            self.time_value / self.time_time
        } else {
            0.0
        }
    }

    /// Standard deviation about the line.
    fn scatter(&self) -> f64 {
        let left = self.value_value - self.slope() * self.time_value;
        (left.max(0.0) / (self.count - 2.0).max(1.0)).sqrt()
    }

    fn keeps(&self, limited: &Limited, duration: f64) -> bool {
        self.count >= FEWEST as f64
            && limited.drift.is_none_or(|limit| self.slope().abs() * duration <= limit)
            && limited.scatter.is_none_or(|limit| self.scatter() <= limit)
    }
}

/// Standard error of the mean of samples with these deviations from their line: that of independent samples, times the root of the
/// integrated autocorrelation time 1 + 2 (r1 + r2 + ...). The sum ends before the first autocorrelation that is not positive, because later
/// ones are noise (after Geyer, Practical Markov Chain Monte Carlo, 1992, who ends it at sums of pairs).
fn standard_error(deviations: &[f64]) -> Option<f64> {
    let count = deviations.len();
    if count < FEWEST {
        return None;
    }
    let at_lag = |lag: usize| -> f64 { deviations.iter().zip(&deviations[lag..]).map(|(a, b)| a * b).sum() };
    let squares = at_lag(0);
    if squares <= 0.0 {
        return Some(0.0);
    }
    let mut time = 1.0;
    for lag in 1..=MOST_LAGS.min(count / 4).min(MOST_PRODUCTS / count) {
        let correlation = at_lag(lag) / squares;
        if correlation <= 0.0 {
            break;
        }
        time += 2.0 * correlation;
    }
    let variance = squares / (count as f64 - 2.0);
    Some((variance * time / count as f64).sqrt())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const QUANTITIES: [&str; 2] = ["torque", "speed"];

    fn entry(scatter: Option<f64>) -> SteadyEntry {
        SteadyEntry {
            time: time(),
            window: 10.0,
            drift: SteadyLimitsEntry {
                torque: Some(0.5),
                speed: Some(0.5),
                ..SteadyLimitsEntry::default()
            },
            scatter: SteadyLimitsEntry {
                torque: scatter,
                ..SteadyLimitsEntry::default()
            },
        }
    }

    /// Pseudo-random numbers of unit variance, always the same.
    fn noise(count: usize) -> Vec<f64> {
        let mut state = 1_u64;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..count)
            .map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0)
            .collect()
    }

    fn rows(torque: impl Fn(f64) -> f64, seconds: f64, noise_torque: f64) -> Vec<(f64, Row)> {
        let count = (seconds / 0.1) as usize;
        let noise = noise(count);
        let row = |k: usize| {
            let time = 0.1 * k as f64;
            let values = vec![Some(torque(time) + noise_torque * noise[k]), Some(100.0)];
            let line = k as u64 + 2;
            (
                time,
                Row {
                    line,
                    values,
                    ..Row::default()
                },
            )
        };
        (0..count).map(row).collect()
    }

    /// 30 s at 100 Nm, 5 s up, 40 s at 150 Nm, 20 s down to 50 Nm, 8 s there.
    fn program(time: f64) -> f64 {
        match time {
            t if t < 30.0 => 100.0,
            t if t < 35.0 => 100.0 + 10.0 * (t - 30.0),
            t if t < 75.0 => 150.0,
            t if t < 95.0 => 150.0 - 5.0 * (t - 75.0),
            _ => 50.0,
        }
    }

    #[test]
    fn plateaus_between_ramps_are_found_and_averaged() {
        let (points, note) = stretches(&entry(None), &QUANTITIES, rows(program, 103.0, 0.05)).unwrap();
        let torques: Vec<f64> = points.iter().map(|row| row.values[0].unwrap()).collect();
        // The last plateau is shorter than the window.
        assert_eq!(torques.len(), 2, "{torques:?}");
        for (torque, plateau) in torques.iter().zip([100.0, 150.0]) {
            // A sixth of the drift limit at each end.
            assert!((torque - plateau).abs() < 2.0 * 0.5 / 6.0, "{torque}");
        }
        let spans: Vec<f64> = points
            .iter()
            .map(|row| row.stretch.as_ref().unwrap().duration)
            .collect();
        assert!(
            (spans[0] - 30.0).abs() < 1.0 && (spans[1] - 40.0).abs() < 1.5,
            "{spans:?}"
        );
        assert_eq!(points[0].line, 2);
        assert!(
            note.starts_with("2 steady intervals, 6") || note.starts_with("2 steady intervals, 7"),
            "{note}"
        );
        assert!(note.contains("largest standard errors of the means: torque "), "{note}");
    }

    #[test]
    fn cells_of_a_stretch_are_means_or_what_all_of_them_hold() {
        let row = |number: &str, text: &str| Row {
            cells: vec![number.to_owned(), "warm".to_owned(), text.to_owned()],
            ..Row::default()
        };
        let rows = [row("1", "a"), row("2", "b")];
        assert_eq!([0, 1, 2].map(|place| averaged(&rows, place)), ["1.5", "warm", ""]);
    }

    #[test]
    fn a_slow_drift_ends_a_stretch_before_it_adds_up() {
        // 0.2 Nm in a window, so 0.5 Nm in 25 s.
        let (points, _) = stretches(&entry(None), &QUANTITIES, rows(|t| 100.0 + 0.02 * t, 100.0, 0.0)).unwrap();
        for point in &points {
            assert!(point.stretch.as_ref().unwrap().duration <= 25.0 + 1e-9);
        }
        assert!(points.len() >= 4);
        // Ten times faster nothing is steady.
        let (points, note) = stretches(&entry(None), &QUANTITIES, rows(|t| 100.0 + 0.2 * t, 100.0, 0.0)).unwrap();
        assert!(points.is_empty() && note.starts_with("0 steady intervals"), "{note}");
    }

    #[test]
    fn scatter_is_limited_where_it_is_stated() {
        let wavy = |t: f64| 100.0 + 2.0 * (7.0 * t).sin();
        let found = |scatter| {
            stretches(&entry(scatter), &QUANTITIES, rows(wavy, 60.0, 0.0))
                .unwrap()
                .0
                .len()
        };
        assert!(found(None) > 0);
        assert_eq!(found(Some(1.0)), 0);
    }

    #[test]
    fn the_standard_error_counts_correlated_samples_once() {
        let white = noise(4000);
        let independent = standard_error(&white).unwrap();
        assert!((independent * 4000.0_f64.sqrt() - 1.0).abs() < 0.1, "{independent}");
        // x = 0.9 x + e has (1 + 0.9) / (1 - 0.9) = 19 times the variance of the mean that its samples alone suggest.
        let mut x = 0.0;
        let red: Vec<f64> = white
            .iter()
            .map(|e| {
                x = 0.9 * x + e;
                x
            })
            .collect();
        let uncorrelated = (red.iter().map(|x| x * x).sum::<f64>() / 4000.0).sqrt() / 4000.0_f64.sqrt();
        let ratio = standard_error(&red).unwrap() / uncorrelated;
        assert!((ratio / 19.0_f64.sqrt() - 1.0).abs() < 0.25, "{ratio}");
    }

    #[test]
    fn a_window_that_slides_has_the_line_of_its_samples() {
        let entry = entry(None);
        let (times, rows): (Vec<f64>, Vec<Row>) = rows(program, 100.0, 0.3).into_iter().unzip();
        let limits = limited(&entry, &QUANTITIES).unwrap();
        let series = Series {
            entry: &entry,
            limits,
            times,
            rows,
        };
        let mut sliding = Sliding::new(&series);
        for start in 0..800 {
            let span = [start, start + 100 + start % 7 / 6];
            sliding.move_to(span);
            let anew = series.line(&series.limits[0], span);
            let slid = sliding.lines[0];
            assert!((slid.slope() - anew.slope()).abs() < 1e-9 && (slid.scatter() - anew.scatter()).abs() < 1e-9);
            assert!((slid.value - anew.value).abs() < 1e-9 && (slid.count - anew.count).abs() < 0.5);
        }
    }

    #[test]
    fn what_is_no_series_is_refused() {
        let mut backwards = rows(program, 60.0, 0.0);
        backwards[7].0 = 0.0;
        let fault = stretches(&entry(None), &QUANTITIES, backwards).unwrap_err();
        assert!(
            fault.message.contains("line 9: the time does not increase"),
            "{}",
            fault.message
        );
        let sparse: Vec<(f64, Row)> = rows(program, 60.0, 0.0).into_iter().step_by(40).collect();
        let fault = stretches(&entry(None), &QUANTITIES, sparse).unwrap_err();
        assert!(fault.message.contains("fewer than 5 samples"), "{}", fault.message);
        let fault = stretches(&entry(None), &["speed"], rows(program, 60.0, 0.0)).unwrap_err();
        assert_eq!(
            fault.place,
            super::super::FaultPlace::Entry("steady.drift.torque".to_owned())
        );
    }
}
