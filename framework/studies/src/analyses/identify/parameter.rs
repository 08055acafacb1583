//! Results for each parameter of a fit.

use gearloss_numerics::inference::{Reach, Scale, Standing, Verdict};
use schemars::JsonSchema;
use serde::Serialize;

use super::found::Found;
use crate::identify::Profiled;
use crate::study::ScaleEntry;

/// Results for one parameter of a fit.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ParameterOfSet {
    /// Name.
    pub name: String,
    /// The path as written.
    pub path: String,
    /// Resolved paths that it changes; empty for a quantity of the rig.
    pub paths: Vec<String>,
    /// Unit of its values.
    pub unit: &'static str,
    /// Scale.
    pub scale: ScaleEntry,
    /// Value of the gearbox or the rig before the fit; absent if not stated. [unit]
    pub stated: Option<f64>,
    /// Published value, if it changes coefficients of formulas. [unit]
    pub published: Option<f64>,
    /// Start value. [unit]
    pub start: f64,
    /// Lower bound; absent if none. [unit]
    pub least: Option<f64>,
    /// Upper bound; absent if none. [unit]
    pub greatest: Option<f64>,
    /// Prior.
    pub prior: Option<PriorOfParameter>,
    /// Identified value. [unit]
    pub value: f64,
    /// Standard deviation of its coordinate: for a logarithmic parameter relative to the value; absent if it is not free.
    /// [unit, or - of a logarithmic one]
    pub standard_deviation: Option<f64>,
    /// 95 % interval of the linearised fit, within the bounds. [unit]
    pub interval: Option<[f64; 2]>,
    /// The same without the bounds. [unit]
    pub interval_without_bounds: Option<[f64; 2]>,
    /// 95 % profile interval; absent if not requested or not possible.
    pub profile: Option<ProfileOfParameter>,
    /// Active bound, `lower` or `upper`.
    pub bound: Option<&'static str>,
    /// Whether there is a kink along it, so that its linearised interval is only approximate.
    pub kink: bool,
    /// Verdict.
    pub verdict: VerdictOfParameter,
    /// The same as text.
    pub sentence: String,
    /// Parameters that are identifiable only in combination with it, the strongest first.
    pub partners: Vec<String>,
    /// Reference size of its interval; absent for a logarithmic parameter. [unit]
    pub size: Option<f64>,
    /// Half-width of the 95 % interval over the size. [-]
    pub half_width_over_size: Option<f64>,
    /// The same conditional on all other parameters. [-]
    pub half_width_over_size_alone: Option<f64>,
    /// Share of the range between the bounds that the interval fills. [-]
    pub range_filled: Option<f64>,
    /// Half-width of the 95 % interval over the range. [-]
    pub width_over_range: Option<f64>,
    /// The same conditional on all other parameters. [-]
    pub width_over_range_alone: Option<f64>,
    /// Part of its column that the other parameters do not explain, from zero to one. [-]
    pub own_share: f64,
    /// Verdict with the active bound.
    #[serde(skip)]
    pub judgement: Verdict,
}

/// Prior of a parameter.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct PriorOfParameter {
    /// Mean. [unit]
    pub mean: f64,
    /// Standard deviation; for a logarithmic parameter relative to the mean. [unit, or - of a logarithmic one]
    pub deviation: f64,
}

/// A profile interval, or why there is none.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ProfileOfParameter {
    /// Why there is none.
    pub failed: Option<String>,
    /// Both ends. [unit]
    pub ends: Option<[f64; 2]>,
    /// Why the search for each end stopped.
    pub reach: Option<[ReachOfProfile; 2]>,
    /// Number of fits.
    pub fits: Option<usize>,
    /// Whether a half-width is below 0.8 or above 1.25 of the linearised one.
    pub nonlinear: Option<bool>,
}

/// Why the search for an end of a profile interval stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ReachOfProfile {
    /// The misfit reaches its limit.
    Limit,
    /// The parameter reaches its bound first.
    Bound,
    /// Neither within the allowed number of fits.
    Unresolved,
}

/// Verdict on a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum VerdictOfParameter {
    /// Fixed by the study.
    Held,
    /// At an active bound.
    OnBound,
    /// Not identifiable: a change by its own size has less effect than the accuracy of the instruments.
    NotSeen,
    /// The half-width of its interval is at most a tenth of its size.
    WellDetermined,
    /// Identifiable only in combination with others.
    OnlyInCombination,
    /// The half-width of its interval is at most half its size.
    RoughlyDetermined,
    /// Otherwise.
    NotDetermined,
}

impl From<Verdict> for VerdictOfParameter {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Held => Self::Held,
            Verdict::OnBound(_) => Self::OnBound,
            Verdict::NotSeen => Self::NotSeen,
            Verdict::WellDetermined => Self::WellDetermined,
            Verdict::OnlyInCombination => Self::OnlyInCombination,
            Verdict::RoughlyDetermined => Self::RoughlyDetermined,
            Verdict::NotDetermined => Self::NotDetermined,
        }
    }
}

/// A verdict in two or three words.
pub fn verdict_words(verdict: Verdict) -> String {
    match verdict {
        Verdict::Held => "fixed".to_owned(),
        Verdict::OnBound(side) => format!("at its {} bound", side.name()),
        Verdict::NotSeen => "not identifiable".to_owned(),
        Verdict::WellDetermined => "well determined".to_owned(),
        Verdict::OnlyInCombination => "only in combination".to_owned(),
        Verdict::RoughlyDetermined => "roughly determined".to_owned(),
        Verdict::NotDetermined => "not determined".to_owned(),
    }
}

impl From<&Profiled> for ProfileOfParameter {
    fn from(profile: &Profiled) -> Self {
        match profile {
            Ok(p) => Self {
                failed: None,
                ends: Some(p.theta),
                reach: Some(p.ends.map(|end| match end.reach {
                    Reach::Limit => ReachOfProfile::Limit,
                    Reach::Bound => ReachOfProfile::Bound,
                    Reach::Unresolved => ReachOfProfile::Unresolved,
                })),
                fits: Some(p.ends.iter().map(|end| end.fits).sum()),
                nonlinear: Some(p.nonlinear),
            },
            Err(reason) => Self {
                failed: Some(reason.clone()),
                ends: None,
                reach: None,
                fits: None,
                nonlinear: None,
            },
        }
    }
}

impl ParameterOfSet {
    /// The parameter of a number.
    pub(super) fn new(o: &Found, k: usize) -> Self {
        let inference = &o.fitted.inference;
        let (parameter, fitted) = (&o.parameters[k], &inference.parameters()[k]);
        let found = inference.determination_widened(k, o.widening().unwrap_or(1.0));
        let interval = inference.interval(k, 0.95, 1.0);
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        let partners = found.partners.iter();
        Self {
            name: parameter.name.clone(),
            path: parameter.path.clone(),
            paths: parameter.paths().to_vec(),
            unit: parameter.unit.symbol,
            scale: parameter.scale,
            stated: parameter.stated,
            published: parameter.published(),
            start: parameter.start,
            least: finite(parameter.bounds[0]),
            greatest: finite(parameter.bounds[1]),
            prior: parameter.prior.map(|p| PriorOfParameter {
                mean: p.mean,
                deviation: p.deviation,
            }),
            value: o.fitted.theta()[k],
            standard_deviation: inference.deviation(k),
            interval: interval.map(|i| i.ends),
            interval_without_bounds: interval.map(|i| i.uncut),
            profile: o.profiles[k].as_ref().map(ProfileOfParameter::from),
            bound: match fitted.standing {
                Standing::Active(side) => Some(side.name()),
                Standing::Free | Standing::Fixed => None,
            },
            kink: o.fitted.is_kinked(k),
            verdict: found.verdict.into(),
            sentence: inference.sentence(k),
            partners: partners.map(|k| inference.parameters()[*k].name.clone()).collect(),
            size: (fitted.scale == Scale::Linear).then(|| fitted.own_size()),
            half_width_over_size: found.relative,
            half_width_over_size_alone: found.relative_alone,
            range_filled: found.filled,
            width_over_range: found.width,
            width_over_range_alone: found.alone,
            own_share: found.own_share,
            judgement: found.verdict,
        }
    }
}
