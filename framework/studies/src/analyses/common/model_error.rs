//! Model-form error of bands: factors on the losses of components, distributed as the measured sets of a corpus show.
//!
//! It is one more uncertain input for each law in components of one kind, so that every analysis that samples inputs has it. All
//! components with the same law in the same kind have one factor in a sample: what the law omits, it omits in each of them.

use std::borrow::Cow;

use gearloss_framework::registry::{JudgedCell, ShippedCells, kind_of};
use gearloss_framework::resolve::Resolved;
use gearloss_framework::transmission::{PartInfo, Transmission};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::inputs::Input;
use super::ranges::once;
use crate::analyses::{Built, Planner, Stopped};
use crate::codes;
use crate::corpus::{ErrorOfLaw, FEWEST_SETS, JudgingSet, LeftOut};
use crate::points::{Driven, PointResult};

/// Where the error of the models is taken from.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ModelErrorEntry {
    /// The measured sets of the corpus that the program carries.
    Shipped(ShippedCorpus),
    /// Sets of one's own.
    Own(OwnCells),
}

/// The corpus of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ShippedCorpus {
    /// The measured sets of the corpus that the program carries.
    Corpus,
}

/// Sets of one's own.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct OwnCells {
    /// Files `cells.csv` that `gearloss validate` wrote.
    #[schemars(length(min = 1), extend("x-refers-to" = "file"))]
    pub cells: Vec<String>,
    /// Whether the sets of the corpus that the program carries count too.
    #[serde(default = "yes")]
    pub corpus: bool,
}

fn yes() -> bool {
    true
}

/// The model error of the components under a model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ModelErrorOfSet {
    /// Name of the set.
    pub model_set: String,
    /// The laws, each with the kind of component in which it is used.
    pub laws: Vec<ModelError>,
}

/// The error of a law in components of one kind.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ModelError {
    /// Mechanism.
    pub mechanism: &'static str,
    /// Model with its nested models.
    pub model: String,
    /// Kind of the components, such as `tapered_roller`; absent for components without kinds.
    pub kind: Option<String>,
    /// Paths of the components.
    pub components: Vec<String>,
    /// Whether its error is known, and why not.
    pub state: StateOfModelError,
    /// Measured sets that judge the law in this kind of component.
    pub sets: Vec<JudgingSet>,
    /// Measured sets from which constants of the law were derived; they do not count.
    pub seen: Vec<JudgingSet>,
    /// Lower end, median and upper end of the 95 % band of the factor on the loss; absent if the error is unknown. [-]
    pub factor: Option<[f64; 3]>,
    /// How many sets are inside the band that the others give; absent with fewer than four sets.
    pub left_out: Option<LeftOut>,
    /// Share of these components in the loss over all nominal points or cycles; absent without a loss. [-]
    pub share_of_loss: Option<f64>,
    /// Their numbers in the transmission.
    #[serde(skip)]
    pub parts: Vec<usize>,
}

/// Whether the error of a law is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StateOfModelError {
    /// At least three measured sets judge it.
    Known,
    /// One or two measured sets judge it: their ratios are stated, and there is no band.
    TooFewSets,
    /// No measured set judges it in this kind of component.
    NoSet,
    /// The user states the law.
    OwnLaw,
    /// The gearbox states a loss factor, and the sets judge the law without one.
    LossFactorStated,
    /// The component has no loss factor of its own.
    NoLossFactor,
}

impl StateOfModelError {
    /// Why an error is unknown, in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Known => "known",
            Self::TooFewSets => "fewer than three measured sets",
            Self::NoSet => "no measured set",
            Self::OwnLaw => "own law",
            Self::LossFactorStated => "the gearbox states a loss factor, the sets judge the law without one",
            Self::NoLossFactor => "the component has no loss factor of its own",
        }
    }
}

impl ModelErrorEntry {
    /// Adds the known errors of the models of a gearbox to the inputs of an analysis, and notes for its head which are known.
    ///
    /// # Errors
    /// A table that cannot be read, and a loss factor that is an input already.
    pub fn add(entry: Option<&Self>, cx: &Planner<'_>, b: &Built<'_>, inputs: &mut Vec<Input>) -> Result<(), Stopped> {
        let Some(entry) = entry else { return Ok(()) };
        let path = format!("{}.model_error", cx.path());
        let tables = entry.tables(cx)?;
        let laws = laws(cx, &b.resolved, &b.transmission, &tables.cells());
        let (laws, distributions): (Vec<ModelError>, Vec<ErrorOfLaw>) = laws.into_iter().unzip();
        for (law, of) in laws.iter().zip(distributions) {
            if let (StateOfModelError::Known, Some(factor)) = (law.state, of.factor) {
                let paths = law
                    .components
                    .iter()
                    .map(|component| format!("{component}.loss_factor"));
                inputs.push(Input::of_model_error(cx, &path, (law, paths.collect()), factor, b)?);
            }
        }
        let varied: Vec<_> = inputs.iter().map(|input| &input.range.varied).collect();
        once(cx, &path, &varied)?;
        cx.keep_model_error(&b.name, laws);
        Ok(())
    }

    /// The tables of cells that count.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub(crate) fn tables(&self, cx: &Planner<'_>) -> Result<Tables, Stopped> {
        let path = format!("{}.model_error", cx.path());
        let (own, counts_corpus): (&[String], bool) = match self {
            Self::Shipped(ShippedCorpus::Corpus) => (&[], true),
            Self::Own(own) => (&own.cells, own.corpus),
        };
        let mut tables = Tables(Vec::new());
        for (i, file) in own.iter().enumerate() {
            let path = format!("{path}.cells.{i}");
            let bytes = cx.study.read_file(file);
            let bytes = bytes.map_err(|e| faulty(cx, &path, file, &e.to_string()))?;
            cx.keep_input(file, &bytes);
            let text = String::from_utf8(bytes).map_err(|_| faulty(cx, &path, file, "it is no text in UTF-8"))?;
            JudgedCell::read(&text).map_err(|reason| faulty(cx, &path, file, &reason))?;
            tables.0.push(text.into());
        }
        for shipped in ShippedCells::all().filter(|_| counts_corpus) {
            JudgedCell::read(shipped).map_err(|reason| faulty(cx, &path, "a linked crate", &reason))?;
            tables.0.push(shipped.into());
        }
        Ok(tables)
    }
}

/// Tables of cells that can be read.
pub(crate) struct Tables(Vec<Cow<'static, str>>);

impl Tables {
    /// Their cells.
    pub(crate) fn cells(&self) -> Vec<JudgedCell<'_>> {
        self.0
            .iter()
            .flat_map(|text| JudgedCell::read(text).unwrap_or_default())
            .collect()
    }
}

fn faulty(cx: &Planner<'_>, path: &str, file: &str, reason: &str) -> Stopped {
    let help = "give a file `cells.csv` that `gearloss validate --corpus FOLDER` of this version wrote";
    cx.wrong_as(codes::CELLS, path, format!("{file}: {reason}"), help)
}

/// The laws of a gearbox with their errors, in the order of its components.
pub(crate) fn laws(
    cx: &Planner<'_>,
    resolved: &Resolved,
    t: &Transmission,
    cells: &[JudgedCell<'_>],
) -> Vec<(ModelError, ErrorOfLaw)> {
    let mut all: Vec<(ModelError, ErrorOfLaw)> = Vec::new();
    for (i, part) in t.parts().iter().enumerate() {
        let entry = &t.instances()[part.notes.instance()].entry;
        if entry.name == "none" {
            continue;
        }
        let kind = kind_of(&resolved.value, &part.path);
        let nested = nested(t, part);
        let model = std::iter::once(entry.name).chain(nested.iter().map(|(_, name)| *name));
        let model = model.collect::<Vec<_>>().join("/");
        let factor_path = format!("{}.loss_factor", part.path);
        let own_factor = cx.language.number_at(&resolved.value, &factor_path).is_some();
        let stated = part.loss_factor != 1.0;
        let law = all.iter_mut().find(|(law, _)| {
            let known = (law.mechanism, &law.model, &law.kind) == (part.mechanism, &model, &kind);
            let states = [StateOfModelError::LossFactorStated, StateOfModelError::NoLossFactor];
            let alike = [stated && own_factor, !own_factor] == states.map(|state| law.state == state);
            // Components whose error is unknown anyway are one law, whatever their factors.
            known
                && (alike
                    || matches!(
                        law.state,
                        StateOfModelError::NoSet | StateOfModelError::TooFewSets | StateOfModelError::OwnLaw
                    ))
        });
        if let Some((law, _)) = law {
            law.components.push(part.path.clone());
            law.parts.push(i);
            continue;
        }
        let mut names: Vec<String> = nested
            .iter()
            .map(|(mechanism, name)| format!("{mechanism}/{name}"))
            .collect();
        names.sort_unstable();
        let judges = |cell: &&JudgedCell<'_>| {
            let mut of_cell: Vec<&str> = cell.nested.clone();
            of_cell.sort_unstable();
            is_of_mechanism(cell.mechanism, part)
                && cell.model.split('/').next() == Some(entry.name)
                && names.iter().map(String::as_str).eq(of_cell)
                && cell.is_of_kind(kind.as_deref())
        };
        let of = ErrorOfLaw::of(cells.iter().filter(judges));
        let state = match of.sets.len() {
            _ if entry.is_user_defined() => StateOfModelError::OwnLaw,
            0 => StateOfModelError::NoSet,
            count if count < FEWEST_SETS || of.factor.is_none() => StateOfModelError::TooFewSets,
            _ if !own_factor => StateOfModelError::NoLossFactor,
            _ if stated => StateOfModelError::LossFactorStated,
            _ => StateOfModelError::Known,
        };
        let is_known = state == StateOfModelError::Known;
        let law = ModelError {
            mechanism: part.mechanism,
            model,
            kind,
            components: vec![part.path.clone()],
            state,
            sets: of.sets.clone(),
            seen: of.seen.clone(),
            factor: of.band().filter(|_| is_known),
            left_out: of.left_out.filter(|_| is_known),
            share_of_loss: None,
            parts: vec![i],
        };
        all.push((law, of));
    }
    all
}

/// Whether cells of a mechanism judge a part; a drag has its slot behind a dot.
fn is_of_mechanism(of_cell: &str, part: &PartInfo) -> bool {
    let (mechanism, slot) = of_cell
        .split_once('.')
        .map_or((of_cell, None), |(m, slot)| (m, Some(slot)));
    mechanism == part.mechanism && slot.is_none_or(|slot| part.path.rsplit('.').next() == Some(slot))
}

/// The models directly below that of a part: mechanism and name.
fn nested(t: &Transmission, part: &PartInfo) -> Vec<(&'static str, &'static str)> {
    let own = &t.instances()[part.notes.instance()].path;
    let below = |path: &str| {
        let rest = path.strip_prefix(own.as_str()).and_then(|rest| rest.strip_prefix('.'));
        rest.is_some_and(|rest| !rest.contains('.'))
    };
    let nested = t.instances().iter().filter(|instance| below(&instance.path));
    nested
        .map(|instance| (instance.entry.mechanism, instance.entry.name))
        .collect()
}

/// Writes the shares of the laws in a loss: by part. \[W\] or \[J\]
pub(crate) fn weigh(laws: &mut [ModelError], losses: &[f64]) {
    let whole: f64 = losses.iter().sum();
    for law in laws.iter_mut().filter(|law| !law.parts.is_empty()) {
        let own: f64 = law.parts.iter().filter_map(|part| losses.get(*part)).sum();
        law.share_of_loss = (whole > 0.0).then(|| own / whole).filter(|share| share.is_finite());
    }
}

/// Losses by part over the points with a loss. \[W\]
pub(crate) fn losses_of_parts(points: &[PointResult]) -> Vec<f64> {
    let solved: Vec<&PointResult> = points.iter().filter(|point| point.loss.is_some()).collect();
    let count = solved.first().map_or(0, |point| point.parts.len());
    let sum = |part: usize| solved.iter().filter_map(|point| point.parts.get(part)).sum();
    (0..count).map(sum).collect()
}

/// Losses by part over all cycles. \[J\]
pub(crate) fn energies_of_parts(driven: &[Driven]) -> Vec<f64> {
    let count = driven.first().map_or(0, |driven| driven.total.parts.len());
    let sum = |part: usize| driven.iter().filter_map(|driven| driven.total.parts.get(part)).sum();
    (0..count).map(sum).collect()
}
