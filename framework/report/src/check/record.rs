//! The document of `check --format json`: findings by file, for editors and scripts.

use gearloss_framework::coefficients::Changed;
use gearloss_framework::document::{Diagnostic, PlacedDiagnostic, Severity, Sources};
use gearloss_framework::gearbox::Findings;
use gearloss_framework::language::Language;
use gearloss_framework::registry::{Evidence, Package};
use gearloss_framework::transmission::{ChainStage, CrossedStage, Stage, TorqueOrder, Transmission};
use gearloss_studies::analyses::Work;
use gearloss_studies::bearings::{BearingCard, bearing_cards};
use gearloss_studies::checked::{CheckedGearbox, PlanetsAtRating, SharingAtRating};
use gearloss_studies::checked_study::CheckedStudy;
use gearloss_studies::corpus::{Basis, Corpus, Set};
use gearloss_studies::pairs::{PairCard, pair_cards};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

const FORMAT: &str = "gearloss-check/1";

/// Output of `gearloss check --format json`.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(title = FORMAT)]
pub struct CheckRecord {
    /// Kind and version of the format.
    #[schemars(extend("const" = FORMAT))]
    format: &'static str,
    /// Version of the program.
    gearloss: &'static str,
    /// Crates whose mechanisms and models are linked into the program.
    packages: Vec<Package>,
    /// The files, in the order of the command.
    files: Vec<FileRecord>,
}

/// One file.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "File")]
pub struct FileRecord {
    /// File name as given in the command.
    file: String,
    /// Kind of document by its first key, a gearbox if the key is missing; a folder is a corpus.
    #[schemars(extend("enum" = ["gearbox", "study", "corpus"]))]
    kind: &'static str,
    /// True if it can be used.
    pub fine: bool,
    /// Findings: errors and warnings.
    findings: Vec<PlacedDiagnostic>,
    #[serde(flatten)]
    content: Content,
}

/// What a file holds.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(untagged)]
#[schemars(inline)]
enum Content {
    /// A study.
    Study {
        /// What its analyses compute.
        plan: Vec<WorkRecord>,
        /// Components of its gearboxes without a model, and coefficients that differ from their source.
        notes: Vec<String>,
    },
    /// A corpus.
    Corpus {
        /// Its sets.
        sets: Vec<SetRecord>,
    },
    /// A gearbox that was built.
    Gearbox(Box<BuiltRecord>),
    /// A gearbox that cannot be built.
    Nothing {},
}

/// A gearbox that was built.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(inline)]
struct BuiltRecord {
    /// Number of its components.
    parts: usize,
    /// Its gear states.
    gear_states: Vec<String>,
    /// Derived geometry of every mesh.
    stages: Vec<Stage>,
    /// Geometry of every mesh of gears on axes that cross; absent without such meshes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    crossed_stages: Vec<CrossedStage>,
    /// Derived geometry of every chain and belt over wheels with teeth; absent without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    chains: Vec<ChainStage>,
    /// Bearings, with their worst values at the rated torque and speed.
    bearings: Vec<BearingCard>,
    /// Opposed bearings that load each other by induced thrust or a spring.
    bearing_pairs: Vec<PairCard>,
    /// Oil in the housing; null if its volume is not stated.
    oil: Option<OilRecord>,
    /// Speed ratios from the reference port to every other port, for each gear.
    ratios: Vec<RatioRecord>,
    /// The order in which torques and losses are found in each gear.
    torque_orders: Vec<TorqueOrder>,
    /// Models that no component uses, and components without a model.
    notes: Vec<String>,
    /// Losses of meshes at the rated torque by their load sharing and by one calculated in thin slices; absent without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    load_sharings: Vec<SharingAtRating>,
    /// What position errors of the pins of planets change at the rated torque; absent without planets whose load sharing they determine.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    planet_sharings: Vec<PlanetsAtRating>,
    /// Coefficients of formulas that were changed from their source.
    changed_from_source: Vec<Changed>,
    /// The lowest evidence grade that its results depend on.
    weakest_evidence: Option<EvidenceRecord>,
    /// The resolved document in SI units; with `--resolved`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("type" = "object"))]
    resolved: Option<Value>,
    /// True if `--deny` rejects it.
    denied: bool,
}

/// A set of a corpus.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "CorpusSet")]
struct SetRecord {
    /// Name of its folder.
    set: String,
    /// Where its numbers come from.
    kind: Basis,
    /// Number of rows of its data; null without data.
    rows: Option<usize>,
    /// What the program lacks to describe its product; null for a set that judges models.
    needs: Option<String>,
}

/// A part of the work of an analysis.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Work")]
struct WorkRecord {
    /// Name of the analysis.
    analysis: String,
    /// What it belongs to: usually model set and gear.
    of: String,
    /// How many.
    count: usize,
    /// What is counted: points, cycles, searches.
    what: &'static str,
    /// True if the count is a maximum.
    at_most: bool,
}

/// Oil in the housing.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Oil")]
struct OilRecord {
    /// Volume. [l]
    volume_l: f64,
    /// Mass. [kg]
    mass_kg: f64,
    /// Temperature of the mass. [degC]
    temperature_degc: f64,
}

/// A ratio.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Ratio")]
struct RatioRecord {
    /// Gear state.
    gear: String,
    /// Reference port.
    from: String,
    /// The other port.
    to: String,
    /// Speed of the reference port over that of the other one; null if that one is stationary. [-]
    ratio: Option<f64>,
}

/// A formula, default or value with its grade.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "WeakestEvidence")]
struct EvidenceRecord {
    /// Grade.
    grade: Evidence,
    /// Graded formula, default or value.
    what: String,
    /// Reason or source of the grade.
    because: String,
}

impl CheckRecord {
    /// One document for the records of all files.
    pub fn new(language: &Language, files: Vec<FileRecord>) -> Self {
        Self {
            format: FORMAT,
            gearloss: env!("CARGO_PKG_VERSION"),
            packages: language.registry().packages(),
            files,
        }
    }
}

impl FileRecord {
    /// A folder of a corpus, as far as it could be read.
    pub fn of_corpus(file: String, read: Result<Corpus, Vec<Findings>>) -> Self {
        let set = |set: Set| SetRecord {
            set: set.name,
            kind: set.source.kind,
            rows: set.rows,
            needs: set.source.needs,
        };
        let (fine, findings, content) = match read {
            Ok(corpus) => {
                let sets = corpus.sets.into_iter().map(set).collect();
                (true, Vec::new(), Content::Corpus { sets })
            }
            Err(list) => {
                let all = list.iter().flat_map(|found| placed(&found.list, &found.sources));
                (false, all.collect(), Content::Nothing {})
            }
        };
        Self {
            file,
            kind: "corpus",
            fine,
            findings,
            content,
        }
    }

    /// Errors and warnings that `run` would report for a study.
    pub fn of_study(file: String, study: CheckedStudy) -> Self {
        let refused = study.refused.iter().flat_map(|stopped| stopped.findings().iter());
        let found = refused.chain(&study.warnings);
        Self {
            file,
            kind: "study",
            fine: study.refused.is_empty(),
            findings: found.flat_map(|found| placed(&found.list, &found.sources)).collect(),
            content: Content::Study {
                plan: plan(study.plans),
                notes: study.notes,
            },
        }
    }

    /// A built gearbox, with the resolved description if `with_resolved`, or why it cannot be built; denied if a result depends on
    /// evidence of this grade or lower.
    pub fn of_gearbox(
        file: String,
        checked: Result<CheckedGearbox, Findings>,
        with_resolved: bool,
        denied_grade: Option<Evidence>,
    ) -> Self {
        let (fine, findings, content) = match checked {
            Ok(checked) => (
                true,
                placed(&checked.warnings(), &checked.gearbox.sources),
                Content::Gearbox(Box::new(BuiltRecord::new(checked, with_resolved, denied_grade))),
            ),
            Err(found) => (
                found.list.iter().all(|finding| finding.severity != Severity::Error),
                placed(&found.list, &found.sources),
                Content::Nothing {},
            ),
        };
        Self {
            file,
            kind: "gearbox",
            fine,
            findings,
            content,
        }
    }

    /// Whether a result depends on evidence that is denied.
    pub fn is_denied(&self) -> bool {
        matches!(&self.content, Content::Gearbox(built) if built.denied)
    }
}

impl BuiltRecord {
    fn new(checked: CheckedGearbox, with_resolved: bool, denied_grade: Option<Evidence>) -> Self {
        let t = &checked.transmission;
        let oil = t.oil_fill().map(|(volume, mass)| OilRecord {
            volume_l: 1e3 * volume,
            mass_kg: mass,
            temperature_degc: t.oil_temperature,
        });
        let lowest = checked.lowest_evidence();
        let resolved = &checked.resolved;
        let notes = [&resolved.unreached, &resolved.without, &resolved.designations];
        Self {
            parts: t.parts().len(),
            gear_states: t.states().iter().map(|state| state.name.clone()).collect(),
            stages: t.stages().collect(),
            crossed_stages: t.crossed_stages().collect(),
            chains: t.chain_stages().collect(),
            bearings: bearing_cards(&checked),
            bearing_pairs: pair_cards(t, resolved),
            oil,
            ratios: ratios(t),
            torque_orders: t.torque_orders(),
            notes: notes.into_iter().flatten().cloned().collect(),
            weakest_evidence: checked.evidence.into_iter().next().map(|weak| EvidenceRecord {
                grade: weak.grade,
                what: weak.what,
                because: weak.because,
            }),
            load_sharings: checked.load_sharings,
            planet_sharings: checked.planet_sharings,
            changed_from_source: checked.changed,
            resolved: with_resolved.then_some(checked.resolved.value),
            denied: denied_grade.is_some_and(|grade| lowest.is_some_and(|lowest| lowest >= grade)),
        }
    }
}

/// What each analysis of a study computes.
fn plan(plans: Vec<(String, Vec<Work>)>) -> Vec<WorkRecord> {
    let part = |(analysis, part): (String, Work)| WorkRecord {
        analysis,
        of: part.of,
        count: part.count,
        what: part.what,
        at_most: part.at_most,
    };
    let all = plans.into_iter();
    all.flat_map(|(analysis, work)| work.into_iter().map(move |part| (analysis.clone(), part)))
        .map(part)
        .collect()
}

/// The ratio from the reference port to each other port for each gear.
fn ratios(t: &Transmission) -> Vec<RatioRecord> {
    let name = |port: usize| t.ports()[port].name.clone();
    let mut all = Vec::new();
    for (i, gear) in t.states().iter().enumerate() {
        all.extend(t.ratios(i).into_iter().map(|(to, ratio)| RatioRecord {
            gear: gear.name.clone(),
            from: name(t.reference_port()),
            to: name(to),
            ratio,
        }));
    }
    all
}

/// Findings with file, line and column instead of spans.
fn placed(list: &[Diagnostic], sources: &Sources) -> Vec<PlacedDiagnostic> {
    list.iter().map(|finding| sources.placed(finding)).collect()
}
