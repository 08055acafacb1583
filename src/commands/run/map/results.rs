//! Maps as JSON. Passes and notes stand before the points, so these wait in a file of their own until all are solved.

use std::cell::RefCell;

use gearloss_framework::flow::Status;
use gearloss_framework::thermal::Outcome;
use gearloss_studies::analysis::{Bits, Note, Piece, PointResult, SUMS, WeakPoint, evidence};
use gearloss_studies::study::Write;
use serde::ser::{Error as _, SerializeSeq as _};
use serde::{Serialize, Serializer};
use serde_json::Value;

use super::super::super::solve::RPM;
use super::super::Runner;
use super::super::pieces::Waiting;
use super::{Map, loss_of, sums, tidy};
use crate::output::Failure;

/// Solved pieces that wait to be written as JSON.
pub struct Waited(RefCell<Waiting>);

impl Waited {
    /// A file beside the results, where JSON is asked for.
    pub fn where_asked(runner: &Runner<'_>, name: &str, formats: &[Write]) -> Result<Option<Self>, Failure> {
        if !formats.contains(&Write::Json) {
            return Ok(None);
        }
        let waiting = Waiting::new(&runner.run.folder.join(format!("{name}.points")))?;
        Ok(Some(Self(RefCell::new(waiting))))
    }

    /// Adds a piece and tells its place.
    pub fn append(&mut self, piece: &Piece<Bits>) -> Result<u64, Failure> {
        self.0.get_mut().append(piece)
    }

    /// All maps of an analysis as they are written.
    pub fn results<'a>(&'a self, head: Value, maps: &'a [Map<'_>]) -> impl Serialize + 'a {
        Results {
            head,
            maps: maps.iter().map(|map| map.result(self)).collect(),
        }
    }
}

/// All maps of an analysis.
#[derive(Serialize)]
struct Results<'a> {
    #[serde(flatten)]
    head: Value,
    maps: Vec<MapResult<'a>>,
}

/// One map.
#[derive(Serialize)]
struct MapResult<'a> {
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
    points: (&'a Map<'a>, &'a Waited),
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

fn points<S: Serializer>((map, waited): &(&Map<'_>, &Waited), to: S) -> Result<S::Ok, S::Error> {
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
            parts_w: (0..p.parts.len()).map(|part| loss_of(p, part)).collect(),
            undefined: p.undefined.map(|(part, reason)| Missing {
                part: &map.built.transmission.parts()[part].path,
                reason: reason.to_string(),
            }),
        }
    };
    let mut list = to.serialize_seq(None)?;
    for place in &map.waiting {
        let piece = waited.0.borrow_mut().piece(*place).map_err(S::Error::custom)?;
        for p in piece.points() {
            list.serialize_element(&point(p))?;
        }
    }
    list.end()
}

impl Map<'_> {
    /// The map as it is written.
    fn result<'s>(&'s self, waited: &'s Waited) -> MapResult<'s> {
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
                    model: t.instances()[p.notes.instance()].entry.name,
                })
                .collect(),
            passes: self.passes,
            notes: &self.notes,
            evidence: evidence(t, &built.resolved, &|path| built.gearbox.places.is_written(path)),
            points: (self, waited),
        }
    }
}
