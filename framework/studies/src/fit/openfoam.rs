//! Output of OpenFOAM's `forces` function object: `forces.dat` (all releases until about 2016, and openfoam.org) and `moment.dat`
//! (openfoam.com), with or without parentheses, porous parts and local axes.

mod history;
mod layout;
mod runs;

pub use history::{HistoryFault, history};
pub use layout::Frame;
use layout::{Heading, NoMoments};
pub use runs::{Run, Runs};

/// Axis of the moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// First axis.
    X,
    /// Second axis.
    Y,
    /// Third axis.
    Z,
}

impl Axis {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        ["x", "y", "z"][self as usize]
    }
}

/// Why moments cannot be read or averaged.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MomentsError {
    /// A word of a line is not a finite number.
    #[error("line {line}: `{word}` is not a number")]
    NotANumber {
        /// Line, from 1.
        line: usize,
        /// The word.
        word: String,
    },
    /// The number of columns belongs to no format, or not to the heading.
    #[error("line {line}: {count} numbers; {due}")]
    Columns {
        /// Line, from 1.
        line: usize,
        /// Number of columns.
        count: usize,
        /// What there should be.
        due: String,
    },
    /// The file has forces, not moments.
    #[error("these are forces in N, not moments")]
    Forces,
    /// Neither heading nor name of the file say what it has.
    #[error("neither its heading nor its name says whether these are moments or forces")]
    Unknown,
    /// The moments are in other axes.
    #[error("it has no moments in {} axes", if *.frame == Frame::Local { "local" } else { "global" })]
    Axes {
        /// The wanted axes.
        frame: Frame,
    },
    /// The time is not later than that of the line before.
    #[error("line {line}: time {time} does not increase")]
    Time {
        /// Line, from 1.
        line: usize,
        /// Time. \[s\]
        time: f64,
    },
    /// Fewer than two samples lie in the averaging time.
    #[error("{inside} samples in the averaging time; {}", .of.map_or_else(
        || "there is no sample".to_owned(),
        |[first, last]| format!("times are {first} to {last} s"),
    ))]
    TooFewSamples {
        /// Number of samples in the averaging time.
        inside: usize,
        /// Times of the first and the last of all samples. \[s\]
        of: Option<[f64; 2]>,
    },
}

impl MomentsError {
    /// How to fix it.
    pub fn help(&self) -> &'static str {
        match self {
            Self::NotANumber { .. } | Self::Columns { .. } => {
                "delete the line if the solver was stopped while it wrote; otherwise name the file that the function object wrote"
            }
            Self::Forces => "name the file of moments, `moment.dat` or `forces.dat`, or the folder that contains it",
            Self::Unknown => {
                "name the folder or the file as OpenFOAM wrote it: `moment.dat`, or `forces.dat` with its comments"
            }
            Self::Axes { frame: Frame::Local } => "omit `--local-axes`",
            Self::Axes { frame: Frame::Global } => {
                "state `--local-axes` if `--axis` is one of the local axes, or name the file in global axes"
            }
            Self::Time { .. } => {
                "delete the repeated lines; if the solver was started several times, name the folder above the folders of its starts"
            }
            Self::TooFewSamples { .. } => "choose --from and --to within the times of the run",
        }
    }
}

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
    /// [`MomentsError::TooFewSamples`].
    pub fn over_time(samples: &[Sample], axis: Axis, [from, to]: [f64; 2]) -> Result<Self, MomentsError> {
        let inside: Vec<&Sample> = samples.iter().filter(|s| s.time >= from && s.time <= to).collect();
        if inside.len() < 2 {
            let ends = samples.first().zip(samples.last());
            return Err(MomentsError::TooFewSamples {
                inside: inside.len(),
                of: ends.map(|(first, last)| [first.time, last.time]),
            });
        }
        let axis = axis as usize;
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
/// the total, pressure, viscous and optionally porous moment. The heading, else the `name` of the file identifies the format.
///
/// # Errors
/// The line that cannot be read, and why.
pub fn samples(text: &str, name: &str, frame: Frame) -> Result<Vec<Sample>, MomentsError> {
    let mut heading = Heading::of_name(name);
    let mut samples: Vec<Sample> = Vec::new();
    for (line, content) in (1..).zip(text.lines()) {
        let content = content.trim();
        if content.is_empty() {
            continue;
        }
        if content.starts_with('#') {
            heading.take(content);
            continue;
        }
        let words = content.split(|c: char| c.is_whitespace() || c == '(' || c == ')' || c == ',');
        let numbers: Vec<f64> = words
            .filter(|w| !w.is_empty())
            .map(|w| {
                let number = w.parse::<f64>().ok().filter(|x| x.is_finite());
                number.ok_or_else(|| MomentsError::NotANumber {
                    line,
                    word: w.to_owned(),
                })
            })
            .collect::<Result<_, _>>()?;
        let count = numbers.len();
        let columns = |due: String| MomentsError::Columns { line, count, due };
        let places = heading.places(count, content.contains("(("), frame);
        let [pressure, viscous] = places.map_err(|none| match none {
            NoMoments::Forces => MomentsError::Forces,
            NoMoments::Unknown => MomentsError::Unknown,
            NoMoments::Axes(frame) => MomentsError::Axes { frame },
            NoMoments::Count(due) => columns(format!("a file of this kind has {due}")),
            NoMoments::Heading(due) => columns(format!("the heading names {due} columns")),
        })?;
        let three = |at: usize| [numbers[at], numbers[at + 1], numbers[at + 2]];
        let sample = Sample {
            time: numbers[0],
            pressure: three(pressure),
            viscous: three(viscous),
        };
        if samples.last().is_some_and(|last| last.time >= sample.time) {
            return Err(MomentsError::Time {
                line,
                time: sample.time,
            });
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
        let expected = samples(SPACED, "moment.dat", Frame::Global).unwrap();
        assert_eq!(expected[0].pressure, [1.0, 2.0, 3.0]);
        for (text, name) in [
            (bracketed, "moment.dat"),
            (porous, "moment.dat"),
            (old, "copy.dat"),
            (oldest, "forces.dat"),
        ] {
            assert_eq!(samples(text, name, Frame::Global).unwrap(), expected);
        }
    }

    #[test]
    fn means_weigh_by_time_and_faults_name_the_line() {
        let all = samples(
            "0 0 0 0 9 0 0 0 0 0\n1 0 0 0 1 0 0 1 0 0\n2 0 0 0 1 0 0 1 0 0\n6 0 0 0 3 0 0 1 0 0\n",
            "moment.dat",
            Frame::Global,
        )
        .unwrap();
        let mean = Mean::over_time(&all, Axis::X, [1.0, f64::INFINITY]).unwrap();
        assert_eq!(
            (mean.pressure, mean.viscous, mean.samples),
            ((1.0 + 4.0 * 2.0) / 5.0, 1.0, 3)
        );
        assert!(mean.spread > 0.0 && mean.times(2.0).total() == 2.0 * mean.total());
        let few = Mean::over_time(&all, Axis::X, [3.0, 7.0]).unwrap_err().to_string();
        assert_eq!(few, "1 samples in the averaging time; times are 0 to 6 s");
        let wrong = |text: &str| samples(text, "moment.dat", Frame::Global).unwrap_err().to_string();
        assert!(wrong("1 2 3\n").contains("line 1: 3 numbers"));
        assert!(wrong("1 a 0 0 0 0 0 0 0 0\n").contains("`a` is not a number"));
        assert!(wrong("2 0 0 0 0 0 0 0 0 0\n1 0 0 0 0 0 0 0 0 0\n").contains("does not increase"));
    }
}
