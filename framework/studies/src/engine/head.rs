//! Provenance of a result: versions, conditions, inputs with their hashes, changed coefficients.

use std::io::{self, BufRead as _, BufReader};
use std::path::Path;

use gearloss_framework::coefficients::{Changed, changed_from_source};
use gearloss_framework::description::Ordered;
use gearloss_framework::evaluate::PowerFlow;
use gearloss_framework::files::open_regular;
use gearloss_framework::real::registers;
use gearloss_framework::registry::Package;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use super::{Built, Planner};
use crate::analyses::common::model_error::ModelErrorOfSet;
use crate::correction::UsedCorrection;
use crate::limits::reached::LimitReached;
use crate::study::Study;

/// The head of every result.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Head {
    /// Format of the result.
    pub format: &'static str,
    /// Version of the program.
    pub gearloss: &'static str,
    /// Crates with models.
    pub packages: Vec<Package>,
    /// Registers in which the points were computed, such as `avx2`; they change the time, not the results.
    pub registers: &'static str,
    /// Title of the study.
    pub study: Option<String>,
    /// Name of the analysis.
    pub analysis: String,
    /// Conditions of all analyses of the study.
    pub conditions: ConditionsOfResult,
    /// The study, its gearboxes and the files that they and the analysis read.
    pub inputs: Vec<InputFile>,
    /// Coefficients that differ from the published value.
    pub changed_from_source: Vec<ChangedOfSet>,
    /// Models of a set that no component uses.
    pub unreached: Vec<UnreachedOfSet>,
    /// Limits of the study over all points or cycles of the analysis; absent if the study has none that apply.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub study_limits: Vec<LimitReached>,
    /// What is known of the error of the models, by model set; absent unless the analysis asks for it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub model_error: Vec<ModelErrorOfSet>,
    /// Smooth corrections of the loss torque that numbers of the result contain; absent without.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub corrections: Vec<UsedCorrection>,
    /// Notes of data entries on their files.
    #[serde(skip)]
    pub about_data: Vec<String>,
}

/// Conditions of all analyses of a study.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ConditionsOfResult {
    /// Port with given torque.
    pub torque_at: String,
    /// Port with given speed.
    pub speed_at: String,
    /// Oil temperature; absent: from the gearbox. [degC]
    pub oil_temperature_degc: Option<f64>,
    /// Whether torque downstream is reduced by upstream losses.
    pub power_flow: PowerFlow,
    /// Overrides: resolved path to value.
    pub set: Ordered<Value>,
}

/// A file with its hash.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct InputFile {
    /// Gearbox that it belongs to; absent for the study and the data of analyses.
    pub gearbox: Option<String>,
    /// Its name.
    pub file: String,
    /// FNV-1a hash of its bytes, hexadecimal.
    pub fnv1a_64: String,
}

/// Changed coefficients under a model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ChangedOfSet {
    /// Name of the set.
    pub model_set: String,
    /// The coefficients.
    pub coefficients: Vec<Changed>,
}

/// Models of a set that no component uses.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct UnreachedOfSet {
    /// Name of the set.
    pub model_set: String,
    /// One line for each.
    pub lines: Vec<String>,
}

impl InputFile {
    pub(crate) fn new(gearbox: Option<&str>, file: &str, bytes: &[u8]) -> Self {
        Self {
            gearbox: gearbox.map(str::to_owned),
            file: file.to_owned(),
            fnv1a_64: hash(bytes),
        }
    }
}

impl Head {
    pub(crate) fn new(cx: &Planner<'_>, built: &[&Built<'_>], read: &[InputFile], about: &[String]) -> Self {
        let conditions = &cx.study.entry.conditions;
        let mut inputs = inputs(cx.study);
        inputs.extend_from_slice(read);
        Self {
            format: crate::results::FORMAT,
            gearloss: env!("CARGO_PKG_VERSION"),
            packages: cx.language.registry().packages(),
            registers: registers(),
            study: cx.study.entry.title.clone(),
            analysis: cx.name.to_owned(),
            conditions: ConditionsOfResult {
                torque_at: conditions.torque_at.clone(),
                speed_at: conditions.speed_at.clone(),
                oil_temperature_degc: conditions.oil_temperature,
                power_flow: conditions.power_flow,
                set: conditions.set.clone(),
            },
            inputs,
            changed_from_source: built
                .iter()
                .map(|b| ChangedOfSet {
                    model_set: b.name.clone(),
                    coefficients: changed_from_source(&b.transmission, &b.resolved),
                })
                .collect(),
            unreached: built
                .iter()
                .map(|b| UnreachedOfSet {
                    model_set: b.name.clone(),
                    lines: b.resolved.unreached.clone(),
                })
                .collect(),
            study_limits: Vec::new(),
            model_error: Vec::new(),
            corrections: Vec::new(),
            about_data: about.to_vec(),
        }
    }
}

/// The study, its gearboxes and the files that they have read.
pub fn inputs(study: &Study) -> Vec<InputFile> {
    let mut list = vec![InputFile::new(None, "study", study.text.as_bytes())];
    for (name, gearbox) in &study.gearboxes {
        let mut add = |file: &str, bytes: &[u8]| list.push(InputFile::new(Some(name), file, bytes));
        for source in 0.. {
            let Some((file, text)) = gearbox.sources.get(source) else {
                break;
            };
            add(
                Path::new(file).file_name().map_or(file, |f| f.to_str().unwrap_or(file)),
                text.as_bytes(),
            );
        }
        for (file, bytes) in gearbox.files.all() {
            add(file.file_name().and_then(|f| f.to_str()).unwrap_or_default(), &bytes);
        }
    }
    list
}

/// FNV-1a, 64 bit: only detects changes of an input.
pub fn fnv1a_64(bytes: &[u8]) -> u64 {
    fnv1a_from(FNV_BASIS, bytes)
}

/// The hash of nothing.
pub const FNV_BASIS: u64 = 0xcbf2_9ce4_8422_2325;

/// Continues a hash over more bytes.
pub fn fnv1a_from(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// The hash of bytes as it is written in results.
pub fn hash(bytes: &[u8]) -> String {
    hexadecimal(fnv1a_64(bytes))
}

/// The hash of a regular file, read in blocks.
///
/// # Errors
/// If it cannot be read.
pub fn hash_of(file: &Path) -> io::Result<String> {
    let mut file = BufReader::new(open_regular(file)?);
    let mut hash = FNV_BASIS;
    loop {
        let bytes = file.fill_buf()?;
        if bytes.is_empty() {
            return Ok(hexadecimal(hash));
        }
        hash = fnv1a_from(hash, bytes);
        let count = bytes.len();
        file.consume(count);
    }
}

/// A hash as it is written in results.
pub fn hexadecimal(hash: u64) -> String {
    format!("{hash:016x}")
}
