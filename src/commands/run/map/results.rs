//! Maps as JSON, written without a copy of their points.

use gearloss_framework::analysis::{Note, PointResult, SUMS, WeakPoint, evidence};
use gearloss_framework::flow::Status;
use gearloss_framework::thermal::Outcome;
use serde::{Serialize, Serializer};
use serde_json::Value;

use super::super::super::solve::RPM;
use super::{Map, parts_of, sums, tidy};

/// All maps of an analysis.
#[derive(Serialize)]
pub struct Results<'a> {
    #[serde(flatten)]
    pub head: Value,
    pub maps: Vec<MapResult<'a>>,
}

/// One map.
#[derive(Serialize)]
pub struct MapResult<'a> {
    model_set: &'a str,
    gear: &'a str,
    bound: serde_json::Map<String, Value>,
    oil_temperature_degc: Option<f64>,
    sums: [SumResult; 6],
    parts: Vec<PartResult<'a>>,
    passes: usize,
    notes: &'a [Note],
    evidence: Vec<WeakPoint>,
    #[serde(serialize_with = "points")]
    points: &'a Map<'a>,
}

#[derive(Serialize)]
struct SumResult {
    sum: &'static str,
    meaning: &'static str,
}

#[derive(Serialize)]
struct PartResult<'a> {
    part: &'a str,
    mechanism: &'static str,
    model: &'static str,
}

#[derive(Serialize)]
struct Point<'a> {
    torque_nm: f64,
    speed_rpm: f64,
    oil_temperature_degc: Option<f64>,
    surface_temperature_degc: Option<f64>,
    balance: Option<Outcome>,
    status: Status,
    efficiency: Option<f64>,
    loss_w: Option<f64>,
    loss_torque_nm: Option<f64>,
    input_w: Option<f64>,
    output_w: Option<f64>,
    sums_w: Option<Sums>,
    parts_w: Vec<Option<f64>>,
    undefined: Option<Missing<'a>>,
}

#[derive(Serialize)]
struct Missing<'a> {
    part: &'a str,
    reason: String,
}

/// The usual sums by name.
struct Sums([f64; 6]);

impl Serialize for Sums {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_map(SUMS.iter().map(|(name, _)| name).zip(self.0))
    }
}

// The way that serde asks for.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn points<S: Serializer>(map: &&Map<'_>, to: S) -> Result<S::Ok, S::Error> {
    let point = |p: &PointResult| -> Point<'_> {
        Point {
            torque_nm: p.torque,
            speed_rpm: tidy(p.speed * RPM),
            oil_temperature_degc: p.oil,
            surface_temperature_degc: p.surface,
            balance: p.balance,
            status: p.status,
            efficiency: p.efficiency,
            loss_w: p.loss,
            loss_torque_nm: p.loss_torque,
            input_w: p.input,
            output_w: p.output,
            sums_w: sums(p).map(Sums),
            parts_w: parts_of(p),
            undefined: p.undefined.map(|(part, reason)| Missing {
                part: &map.built.transmission.parts()[part].path,
                reason: reason.to_string(),
            }),
        }
    };
    to.collect_seq(map.points.iter().map(point))
}

impl Map<'_> {
    /// The map as it is written.
    pub fn result(&self) -> MapResult<'_> {
        let (built, t) = (&self.built, &self.built.transmission);
        MapResult {
            model_set: &built.name,
            gear: &self.gear,
            bound: self.bound.iter().cloned().collect(),
            oil_temperature_degc: self.oil.given(),
            sums: SUMS.map(|(sum, meaning)| SumResult { sum, meaning }),
            parts: t
                .parts()
                .iter()
                .map(|p| PartResult {
                    part: &p.path,
                    mechanism: p.mechanism,
                    model: t.instances()[p.notes.instance].entry.name,
                })
                .collect(),
            passes: self.passes,
            notes: &self.notes,
            evidence: evidence(t, &built.resolved, &|path| built.gearbox.places.is_written(path)),
            points: self,
        }
    }
}
