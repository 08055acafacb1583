//! A smooth correction of the loss torque that an identification leaves unexplained, apart from the physics.
//!
//! An identification fits it to measured less calculated loss torque at its rows ([`Correction::fit`]) and writes it into its result. Other
//! analyses read it from there ([`CorrectionFrom`]), after they have found that their gearbox calculates what the identified one did: a
//! correction belongs to the physics that it corrects. It has no value outside of the convex hull of its points.

use gearloss_framework::document::{Code, Diagnostic, did_you_mean};
use gearloss_numerics::smooth::{MOST_VALUES, Member, Predicted, Smooth};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::codes;
use crate::points::{Given, PointResult};

/// Speeds in results. \[rpm\]
const RPM: f64 = 30.0 / std::f64::consts::PI;

/// Range of oil temperatures from which they are a coordinate unless it is stated. \[K\]
const WARMER: f64 = 5.0;

/// Greatest difference between the loss torque of a gearbox and that of the identified one, relative to it: parameters written with five digits.
const SAME: f64 = 1e-3;

/// A quantity over which a correction varies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Coordinate {
    /// Given torque, Nm.
    Torque,
    /// Given speed, rpm.
    Speed,
    /// Oil temperature, degC.
    OilTemperature,
}

impl Coordinate {
    /// All of them.
    const ALL: [Self; 3] = [Self::Torque, Self::Speed, Self::OilTemperature];

    /// Its name and unit in a sentence.
    pub fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Torque => ("torque", "Nm"),
            Self::Speed => ("speed", "rpm"),
            Self::OilTemperature => ("oil temperature", "degC"),
        }
    }
}

/// A smooth correction of what remains of the measured loss torque after the fit.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
pub struct CorrectionEntry {
    /// What it varies over; default: torque and speed, and the oil temperature if it varies by more than 5 K. A quantity that is not listed must lie
    /// within the measured ones where the correction is used.
    #[serde(default)]
    pub over: Vec<Coordinate>,
}

/// A correction of one gear: everything that it needs to be used.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Correction {
    /// Gear state.
    pub gear: String,
    /// What it varies over.
    pub over: Vec<Coordinate>,
    /// The ranges within which the other quantities must lie.
    pub within: Vec<RangeOfCorrection>,
    /// Root mean square of measured less calculated loss torque. [Nm]
    pub rms_before_nm: f64,
    /// The same less the correction that the other points give, each point left out in turn. [Nm]
    pub rms_left_out_nm: f64,
    /// Share of the points inside the 95 % band that the others give. [-]
    pub in_band: f64,
    /// Sets of unknowns with their probabilities: the correction is their mixture.
    pub unknowns: Vec<UnknownsOfCorrection>,
    /// Its points.
    pub points: Vec<PointOfCorrection>,
}

/// The measured range of a quantity over which a correction does not vary.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RangeOfCorrection {
    /// The quantity.
    pub quantity: Coordinate,
    /// Least measured value. [Nm, rpm or degC]
    pub from: f64,
    /// Greatest measured value. [Nm, rpm or degC]
    pub to: f64,
}

/// Unknowns of the Gaussian process.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct UnknownsOfCorrection {
    /// Their probability. [-]
    pub probability: f64,
    /// Lengths over which the correction varies, each over the range of its quantity. [-]
    pub lengths: Vec<f64>,
    /// Standard deviation of the correction before any measurement. [Nm]
    pub amplitude_nm: f64,
    /// Standard deviation of a measured loss torque, beyond its accuracy. [Nm]
    pub noise_nm: f64,
}

/// A point of a correction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PointOfCorrection {
    /// Line in the measured data. [-]
    pub line: u64,
    /// Torque. [Nm]
    pub torque_nm: f64,
    /// Speed. [rpm]
    pub speed_rpm: f64,
    /// Oil temperature. [degC]
    pub oil_temperature_degc: f64,
    /// Loss torque of the identified gearbox. [Nm]
    pub calculated_nm: f64,
    /// Measured less calculated loss torque. [Nm]
    pub correction_nm: f64,
    /// Standard deviation of the measured loss torque; zero if it is not stated. [Nm]
    pub accuracy_nm: f64,
}

impl PointOfCorrection {
    fn coordinate(&self, coordinate: Coordinate) -> f64 {
        match coordinate {
            Coordinate::Torque => self.torque_nm,
            Coordinate::Speed => self.speed_rpm,
            Coordinate::OilTemperature => self.oil_temperature_degc,
        }
    }

    /// As a point to solve.
    fn given(&self) -> Given {
        Given {
            torque: self.torque_nm,
            speed: self.speed_rpm / RPM,
            oil: Some(self.oil_temperature_degc),
        }
    }
}

/// A correction at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corrected {
    /// Correction of the loss torque. \[Nm\]
    pub torque: f64,
    /// Its 95 % band. \[Nm\]
    pub band: [f64; 2],
}

impl From<Predicted> for Corrected {
    fn from(found: Predicted) -> Self {
        Self {
            torque: found.mean,
            band: found.band(),
        }
    }
}

/// A correction that can be evaluated.
#[derive(Debug, Clone)]
pub struct ReadyCorrection {
    /// Its record.
    pub record: Correction,
    smooth: Smooth,
}

impl Correction {
    /// Fits the correction of one gear. Absent without points.
    ///
    /// # Errors
    /// Too many points, or numbers that are not finite.
    pub fn fit(entry: &CorrectionEntry, gear: &str, points: Vec<PointOfCorrection>) -> Result<Option<Self>, String> {
        if points.len() > MOST_VALUES {
            return Err(format!(
                "gear {gear} has {} rows with a loss, and a correction takes at most {MOST_VALUES}",
                points.len()
            ));
        }
        let range = |coordinate: Coordinate| {
            let values = points.iter().map(|point| point.coordinate(coordinate));
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
                [low.min(x), high.max(x)]
            })
        };
        let varies = |coordinate: &Coordinate| {
            let [low, high] = range(*coordinate);
            match coordinate {
                Coordinate::OilTemperature => high - low > WARMER,
                _ => high > low,
            }
        };
        let over: Vec<Coordinate> = if entry.over.is_empty() {
            Coordinate::ALL.into_iter().filter(varies).collect()
        } else {
            entry.over.clone()
        };
        let others = Coordinate::ALL
            .into_iter()
            .filter(|coordinate| !over.contains(coordinate));
        let within = others.map(|quantity| {
            let [from, to] = range(quantity);
            RangeOfCorrection { quantity, from, to }
        });
        let mut record = Self {
            gear: gear.to_owned(),
            within: within.collect(),
            over,
            rms_before_nm: 0.0,
            rms_left_out_nm: 0.0,
            in_band: 0.0,
            unknowns: Vec::new(),
            points,
        };
        let [places, values, accuracies] = record.data();
        let values = values.concat();
        let Some(smooth) = Smooth::fit(&places, &values, &accuracies.concat())? else {
            return Ok(None);
        };
        let left = smooth.left_out();
        record.rms_before_nm = left.rms_before;
        record.rms_left_out_nm = left.rms_after;
        record.in_band = left.in_band;
        let unknowns = |member: &Member| UnknownsOfCorrection {
            probability: member.weight,
            lengths: member.lengths.clone(),
            amplitude_nm: member.amplitude,
            noise_nm: member.noise,
        };
        record.unknowns = smooth.members().map(unknowns).collect();
        Ok(Some(record))
    }

    /// Places, values and accuracies of the points, each as a list for each point.
    fn data(&self) -> [Vec<Vec<f64>>; 3] {
        let place = |point: &PointOfCorrection| self.over.iter().map(|over| point.coordinate(*over)).collect();
        [
            self.points.iter().map(place).collect(),
            self.points.iter().map(|point| vec![point.correction_nm]).collect(),
            self.points.iter().map(|point| vec![point.accuracy_nm]).collect(),
        ]
    }

    /// The correction for use.
    ///
    /// # Errors
    /// A record that was changed so that it fits no function.
    pub fn ready(self) -> Result<ReadyCorrection, String> {
        let [places, values, accuracies] = self.data();
        let members = self.unknowns.iter().map(|unknowns| Member {
            weight: unknowns.probability,
            lengths: unknowns.lengths.clone(),
            amplitude: unknowns.amplitude_nm,
            noise: unknowns.noise_nm,
        });
        let smooth = Smooth::with_members(&places, &values.concat(), &accuracies.concat(), members.collect())?;
        let smooth = smooth.ok_or("it has no points")?;
        Ok(ReadyCorrection { record: self, smooth })
    }
}

impl ReadyCorrection {
    /// The correction at a torque in Nm, a speed in rad/s and an oil temperature in degC; absent outside of the measured region.
    pub fn at(&self, torque: f64, speed: f64, oil: f64) -> Option<Corrected> {
        let value = |coordinate: Coordinate| match coordinate {
            Coordinate::Torque => torque,
            Coordinate::Speed => speed * RPM,
            Coordinate::OilTemperature => oil,
        };
        let near = |range: &RangeOfCorrection| {
            let x = value(range.quantity);
            let rounding = 1e-6 * (range.to - range.from).max(range.to.abs().max(range.from.abs()));
            (range.from - rounding..=range.to + rounding).contains(&x)
        };
        if !self.record.within.iter().all(near) {
            return None;
        }
        let place: Vec<f64> = self.record.over.iter().map(|over| value(*over)).collect();
        self.smooth.at(&place).map(Corrected::from)
    }

    /// The correction at a solved point; absent outside of the measured region, and without a loss.
    pub fn of(&self, point: &PointResult) -> Option<Corrected> {
        point.loss_torque?;
        self.at(point.torque, point.speed, point.oil?)
    }

    /// Its points, to be solved by another gearbox.
    pub fn list(&self) -> Vec<Given> {
        self.record.points.iter().map(PointOfCorrection::given).collect()
    }

    /// Whether a gearbox has the loss torques of the identified one; else where it differs most.
    ///
    /// # Errors
    /// The point of the greatest difference, in words.
    pub fn fits(&self, loss_torques: &[Option<f64>]) -> Result<(), String> {
        let difference = |(point, solved): (&PointOfCorrection, &Option<f64>)| {
            let torque = solved.unwrap_or(f64::NAN);
            let size = point.calculated_nm.abs().max(f64::MIN_POSITIVE);
            ((torque - point.calculated_nm).abs() / size, torque, *point)
        };
        let worst = self.record.points.iter().zip(loss_torques).map(difference);
        let worst = worst.max_by(|a, b| a.0.total_cmp(&b.0));
        match worst {
            Some((relative, torque, point)) if relative.is_nan() || relative > SAME => Err(format!(
                "the gearbox loses {torque:.6} Nm at {} Nm, {:.0} rpm and {:.1} degC (line {}), the identified one {:.6} Nm",
                point.torque_nm, point.speed_rpm, point.oil_temperature_degc, point.line, point.calculated_nm
            )),
            _ => Ok(()),
        }
    }
}

/// A correction from an identification: of the same study, or from its JSON result.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
pub struct CorrectionFrom {
    /// An analysis of type `identify` with `correction`, above this one.
    #[schemars(extend("x-refers-to" = "analyses"))]
    pub of: Option<String>,
    /// JSON result of such an analysis instead.
    #[schemars(extend("x-refers-to" = "file"))]
    pub file: Option<String>,
    /// Name of the identified model set; default: the only one with a correction.
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub model_set: Option<String>,
}

impl CorrectionFrom {
    /// The analysis or the file, for messages and results.
    pub fn name(&self) -> &str {
        self.of.as_deref().or(self.file.as_deref()).unwrap_or_default()
    }

    /// The corrections of all gears in the bytes of a file.
    ///
    /// # Errors
    /// What is wrong with the file or the set, without a place.
    pub fn read(&self, bytes: &[u8]) -> Result<Vec<ReadyCorrection>, Diagnostic> {
        let result = serde_json::from_slice(bytes);
        self.take(&result.map_err(|e| self.wrong(format!("it is no JSON: {e}"), AGAIN))?)
    }

    /// The corrections of all gears in a result.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn take(&self, result: &Value) -> Result<Vec<ReadyCorrection>, Diagnostic> {
        let all = result.get("identifications").and_then(Value::as_array);
        let all = all.ok_or_else(|| self.wrong("it is no result of an identification".to_owned(), AGAIN))?;
        let named = |of: &Value| {
            of.get("model_set")
                .and_then(Value::as_str)
                .unwrap_or_default()
                .to_owned()
        };
        let with: Vec<(String, &Value)> = all
            .iter()
            .filter_map(|of| Some((named(of), of.get("correction")?)))
            .collect();
        let names: Vec<&str> = with.iter().map(|(name, _)| name.as_str()).collect();
        let chosen = match (&self.model_set, &with[..]) {
            (_, []) => return Err(self.wrong("it has no correction".to_owned(), AGAIN)),
            (None, [(_, only)]) => *only,
            (None, _) => {
                let message = format!("it has corrections of several model sets: {}", names.join(", "));
                return Err(self.wrong(message, "name one of them: `model_set`"));
            }
            (Some(set), _) => {
                let Some((_, correction)) = with.iter().find(|(name, _)| name == set) else {
                    let help = match did_you_mean(set, names.iter().copied()) {
                        Some(near) => format!("write `{near}`"),
                        None => format!("there are {}", names.join(", ")),
                    };
                    return Err(self.wrong(format!("it has no correction of the model set `{set}`"), &help));
                };
                *correction
            }
        };
        let records: Vec<Correction> = serde_json::from_value(chosen.clone())
            .map_err(|e| self.wrong(format!("its correction cannot be read: {e}"), AGAIN))?;
        let ready = |record: Correction| {
            let gear = record.gear.clone();
            record
                .ready()
                .map_err(|reason| self.wrong(format!("the correction of gear {gear}: {reason}"), AGAIN))
        };
        records.into_iter().map(ready).collect()
    }

    fn wrong(&self, message: String, help: &str) -> Diagnostic {
        Diagnostic::error("", format!("{}: {message}", self.name()))
            .help(help)
            .code(CODE)
    }
}

/// Help for results that have no correction.
const AGAIN: &str = "give the result of an `identify` analysis that has `correction: {}`, as this version wrote it";

/// Code of findings about a correction.
pub const CODE: Code = codes::CORRECTION;

/// What a result says of the correction that its numbers contain.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct UsedCorrection {
    /// The identification, or the file of its result.
    pub from: String,
    /// Name of the model set of the result.
    pub model_set: String,
    /// Gear state.
    pub gear: String,
    /// What it varies over.
    pub over: Vec<Coordinate>,
    /// Number of measured points behind it. [-]
    pub measured_points: usize,
    /// Number of points of the result with a correction. [-]
    pub inside: usize,
    /// Number of points with a loss outside of the measured region, which have no corrected value. [-]
    pub outside: usize,
    /// Root mean square of measured less calculated loss torque, without a correction. [Nm]
    pub rms_before_nm: f64,
    /// The same less the correction that the other points give. [Nm]
    pub rms_left_out_nm: f64,
}

impl UsedCorrection {
    /// Without points yet.
    pub fn new(from: &str, model_set: &str, ready: &ReadyCorrection) -> Self {
        Self {
            from: from.to_owned(),
            model_set: model_set.to_owned(),
            gear: ready.record.gear.clone(),
            over: ready.record.over.clone(),
            measured_points: ready.record.points.len(),
            inside: 0,
            outside: 0,
            rms_before_nm: ready.record.rms_before_nm,
            rms_left_out_nm: ready.record.rms_left_out_nm,
        }
    }

    /// As a sentence of what to be careful about.
    pub fn sentence(&self) -> String {
        let over: Vec<&str> = self.over.iter().map(|over| over.words().0).collect();
        format!(
            "corrected values contain a smooth correction of the loss torque over {}, which is no physics: from {} measured points of {}, gear {}; {} points of the result are inside of \
             them, {} outside have no corrected value",
            over.join(", "),
            self.measured_points,
            self.from,
            self.gear,
            self.inside,
            self.outside
        )
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn points(oil: impl Fn(usize) -> f64) -> Vec<PointOfCorrection> {
        let point = |i: usize| {
            let (torque, speed) = (50.0 * (i % 4) as f64 + 20.0, 500.0 * (i / 4) as f64 + 300.0);
            PointOfCorrection {
                line: i as u64 + 2,
                torque_nm: torque,
                speed_rpm: speed,
                oil_temperature_degc: oil(i),
                calculated_nm: 1.0 + 0.01 * torque,
                correction_nm: 0.05 + 0.001 * torque - 2e-5 * speed,
                accuracy_nm: 0.002,
            }
        };
        (0..16).map(point).collect()
    }

    #[test]
    fn one_temperature_is_a_range_and_several_are_a_coordinate() {
        let near = Correction::fit(
            &CorrectionEntry::default(),
            "one",
            points(|i| 80.0 + 0.1 * (i % 3) as f64),
        );
        let near = near.unwrap().unwrap();
        assert_eq!(near.over, [Coordinate::Torque, Coordinate::Speed]);
        assert_eq!((near.within[0].from, near.within[0].to), (80.0, 80.2));
        let ready = near.ready().unwrap();
        let at = |torque, rpm: f64, oil| ready.at(torque, rpm / RPM, oil);
        let found = at(100.0, 1000.0, 80.1).unwrap();
        assert!((found.torque - 0.13).abs() < 0.01, "{found:?}");
        assert!(found.band[0] < found.torque && found.torque < found.band[1]);
        assert_eq!(at(100.0, 1000.0, 79.0), None);
        assert_eq!(at(300.0, 1000.0, 80.1), None);
        let far = Correction::fit(
            &CorrectionEntry::default(),
            "one",
            points(|i| 40.0 + 10.0 * (i % 3) as f64),
        );
        assert_eq!(far.unwrap().unwrap().over.len(), 3);
        assert!(
            Correction::fit(&CorrectionEntry::default(), "one", Vec::new())
                .unwrap()
                .is_none()
        );
    }

    #[test]
    fn a_record_is_read_from_the_result_that_contains_it() {
        let record = Correction::fit(&CorrectionEntry::default(), "one", points(|_| 80.0))
            .unwrap()
            .unwrap();
        let text = serde_json::json!({ "identifications": [{ "model_set": "iso", "correction": [record] }, { "model_set": "other" }] });
        let of = |model_set: Option<&str>| CorrectionFrom {
            file: Some("fit.json".to_owned()),
            model_set: model_set.map(str::to_owned),
            ..CorrectionFrom::default()
        };
        let bytes = serde_json::to_vec(&text).unwrap();
        let ready = of(None).read(&bytes).unwrap().remove(0);
        let own = record.clone().ready().unwrap();
        let at = |ready: &ReadyCorrection| ready.at(90.0, 100.0, 80.0).unwrap();
        assert!((at(&ready).torque - at(&own).torque).abs() < 1e-12);
        let fault = |file: CorrectionFrom, bytes: &[u8]| file.read(bytes).unwrap_err();
        assert!(fault(of(Some("isi")), &bytes).message.contains("`isi`"));
        assert!(fault(of(None), b"{").message.contains("no JSON"));
        assert!(
            fault(of(None), b"{}")
                .message
                .contains("no result of an identification")
        );
        assert!(
            fault(of(None), br#"{"identifications":[{"model_set":"a"}]}"#)
                .message
                .contains("no correction")
        );
    }

    #[test]
    fn a_correction_belongs_to_its_physics() {
        let record = Correction::fit(&CorrectionEntry::default(), "one", points(|_| 80.0))
            .unwrap()
            .unwrap();
        let ready = record.ready().unwrap();
        let solved = |factor: f64| -> Vec<Option<f64>> {
            let torque = |point: &PointOfCorrection| Some(factor * point.calculated_nm);
            ready.record.points.iter().map(torque).collect()
        };
        assert!(ready.fits(&solved(1.0001)).is_ok());
        assert!(ready.fits(&solved(1.01)).unwrap_err().contains("the identified one"));
    }
}
