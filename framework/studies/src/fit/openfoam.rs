//! Output of OpenFOAM's `forces` function object: `forces.dat` (all releases until about 2016, and openfoam.org) and `moment.dat`
//! (openfoam.com), with or without parentheses and porous parts.

/// Moments at one time. \[Nm\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time. \[s\]
    pub time: f64,
    /// Pressure part, by axis.
    pub pressure: [f64; 3],
    /// Viscous part, by axis.
    pub viscous: [f64; 3],
}

/// Mean moment about one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// Pressure part. \[Nm\]
    pub pressure: f64,
    /// Viscous part. \[Nm\]
    pub viscous: f64,
    /// Standard deviation of the sum over time. \[Nm\]
    pub spread: f64,
    /// Number of samples.
    pub samples: usize,
    /// Time of the last sample. \[s\]
    pub until: f64,
}

impl Mean {
    /// Mean between two times, weighted by the length of the time steps.
    ///
    /// # Errors
    /// That fewer than two samples lie between the times, with the times that there are.
    pub fn over_time(samples: &[Sample], axis: usize, [from, to]: [f64; 2]) -> Result<Self, String> {
        let inside: Vec<&Sample> = samples.iter().filter(|s| s.time >= from && s.time <= to).collect();
        if inside.len() < 2 {
            let range = match (samples.first(), samples.last()) {
                (Some(first), Some(last)) => format!("times are {} to {} s", first.time, last.time),
                _ => "there is no sample".to_owned(),
            };
            return Err(format!("{} samples in the averaging time; {range}", inside.len()));
        }
        let mean = |f: &dyn Fn(&Sample) -> f64| {
            let mut sum = 0.0;
            for pair in inside.windows(2) {
                sum += 0.5 * (f(pair[0]) + f(pair[1])) * (pair[1].time - pair[0].time);
            }
            sum / (inside[inside.len() - 1].time - inside[0].time)
        };
        let (pressure, viscous) = (mean(&|s| s.pressure[axis]), mean(&|s| s.viscous[axis]));
        let total = pressure + viscous;
        let variance = mean(&|s| (s.pressure[axis] + s.viscous[axis] - total).powi(2));
        Ok(Self {
            pressure,
            viscous,
            spread: variance.sqrt(),
            samples: inside.len(),
            until: inside[inside.len() - 1].time,
        })
    }

    /// Sum of both parts. \[Nm\]
    pub fn total(&self) -> f64 {
        self.pressure + self.viscous
    }

    /// All moments multiplied by a factor.
    pub fn times(self, factor: f64) -> Self {
        Self {
            pressure: self.pressure * factor,
            viscous: self.viscous * factor,
            spread: self.spread * factor,
            ..self
        }
    }
}

/// Samples of one file. `forces.dat` contains forces, then moments, each as pressure, viscous and optionally porous; `moment.dat` contains
/// the total, pressure, viscous and optionally porous moment. The number of columns identifies the format.
///
/// # Errors
/// The line that cannot be read, and why.
pub fn samples(text: &str) -> Result<Vec<Sample>, String> {
    let mut samples: Vec<Sample> = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let words = line.split(|c: char| c.is_whitespace() || c == '(' || c == ')' || c == ',');
        let numbers: Vec<f64> = words
            .filter(|w| !w.is_empty())
            .map(|w| {
                let number = w.parse::<f64>().ok().filter(|x| x.is_finite());
                number.ok_or_else(|| format!("line {}: `{w}` is not a number", i + 1))
            })
            .collect::<Result<_, _>>()?;
        let nested = line.contains("((");
        let pressure = match (numbers.len(), nested) {
            // Time, forces and moments by pressure and viscous; the same with porous.
            (13, true) => 7,
            (19, _) => 10,
            // Time, total, pressure, viscous; the same with porous.
            (10, _) | (13, false) => 4,
            (count, _) => {
                return Err(format!(
                    "line {}: {count} numbers; moment.dat has 10 or 13, forces.dat 13 or 19",
                    i + 1
                ));
            }
        };
        let three = |at: usize| [numbers[at], numbers[at + 1], numbers[at + 2]];
        let sample = Sample {
            time: numbers[0],
            pressure: three(pressure),
            viscous: three(pressure + 3),
        };
        if samples.last().is_some_and(|last| last.time >= sample.time) {
            return Err(format!("line {}: time {} does not increase", i + 1, sample.time));
        }
        samples.push(sample);
    }
    Ok(samples)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const SPACED: &str = "# Time total_x total_y total_z pressure_x pressure_y pressure_z viscous_x viscous_y viscous_z\n\
        1 5 7 9 1 2 3 4 5 6\n2 5 7 9 3 2 1 4 5 6\n";

    #[test]
    fn all_layouts_give_the_same_moments() {
        let bracketed = "# Time (total_x total_y total_z) (pressure_x pressure_y pressure_z) (viscous_x viscous_y viscous_z)\n\
            1\t(5 7 9) (1 2 3) (4 5 6)\n2\t(5 7 9) (3 2 1) (4 5 6)\n";
        let porous = "1 (5 7 9) (1 2 3) (4 5 6) (0 0 0)\n2 (5 7 9) (3 2 1) (4 5 6) (0 0 0)\n";
        let old = "# Time forces(pressure viscous porous) moment(pressure viscous porous)\n\
            1 ((9 9 9) (9 9 9) (0 0 0)) ((1 2 3) (4 5 6) (0 0 0))\n2 ((9 9 9) (9 9 9) (0 0 0)) ((3 2 1) (4 5 6) (0 0 0))\n";
        let oldest = "1 ((9 9 9) (9 9 9)) ((1 2 3) (4 5 6))\n2 ((9 9 9) (9 9 9)) ((3 2 1) (4 5 6))\n";
        let expected = samples(SPACED).unwrap();
        assert_eq!(expected[0].pressure, [1.0, 2.0, 3.0]);
        for text in [bracketed, porous, old, oldest] {
            assert_eq!(samples(text).unwrap(), expected);
        }
    }

    #[test]
    fn means_weigh_by_time_and_faults_name_the_line() {
        let all =
            samples("0 0 0 0 9 0 0 0 0 0\n1 0 0 0 1 0 0 1 0 0\n2 0 0 0 1 0 0 1 0 0\n6 0 0 0 3 0 0 1 0 0\n").unwrap();
        let mean = Mean::over_time(&all, 0, [1.0, f64::INFINITY]).unwrap();
        assert_eq!(
            (mean.pressure, mean.viscous, mean.samples),
            ((1.0 + 4.0 * 2.0) / 5.0, 1.0, 3)
        );
        assert!(mean.spread > 0.0 && mean.times(2.0).total() == 2.0 * mean.total());
        assert!(
            Mean::over_time(&all, 0, [3.0, 7.0])
                .unwrap_err()
                .contains("1 samples in the averaging time; times are 0 to 6 s")
        );
        assert!(samples("1 2 3\n").unwrap_err().contains("line 1: 3 numbers"));
        assert!(
            samples("1 a 0 0 0 0 0 0 0 0\n")
                .unwrap_err()
                .contains("`a` is not a number")
        );
        assert!(
            samples("2 0 0 0 0 0 0 0 0 0\n1 0 0 0 0 0 0 0 0 0\n")
                .unwrap_err()
                .contains("does not increase")
        );
    }
}
