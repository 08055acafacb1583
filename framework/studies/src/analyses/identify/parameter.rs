//! What a fit says of each parameter.

use gearloss_numerics::inference::{Reach, Scale, Standing, Verdict};
use schemars::JsonSchema;
use serde::Serialize;

use super::found::Found;
use crate::identify::Profiled;
use crate::study::ScaleEntry;

/// What a fit says of one parameter.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ParameterOfSet {
    /// Name.
    pub name: String,
    /// The path as written.
    pub path: String,
    /// Resolved paths that it moves; none for a quantity of the rig.
    pub paths: Vec<String>,
    /// Unit of its values.
    pub unit: &'static str,
    /// How it is counted.
    pub scale: ScaleEntry,
    /// Value of the gearbox or the rig, before anything is fitted; absent where none is stated. [unit]
    pub stated: Option<f64>,
    /// Published value, where it moves coefficients of formulas. [unit]
    pub published: Option<f64>,
    /// Where the search begins. [unit]
    pub start: f64,
    /// Least value allowed; absent without bound. [unit]
    pub least: Option<f64>,
    /// Greatest value allowed; absent without bound. [unit]
    pub greatest: Option<f64>,
    /// What is known of it beside the points.
    pub prior: Option<PriorOfParameter>,
    /// Value that was found. [unit]
    pub value: f64,
    /// Standard deviation of its coordinate: of a logarithmic parameter relative to the value; absent where it does not move.
    /// [unit, or - of a logarithmic one]
    pub standard_deviation: Option<f64>,
    /// 95 % interval of the linearised fit, inside the bounds. [unit]
    pub interval: Option<[f64; 2]>,
    /// The same without regard to the bounds. [unit]
    pub interval_without_bounds: Option<[f64; 2]>,
    /// 95 % interval by profile; absent where it was not requested or there is nothing to profile.
    pub profile: Option<ProfileOfParameter>,
    /// The bound on which it stands, `lower` or `upper`, with the points pulling outward.
    pub bound: Option<&'static str>,
    /// Whether a kink lies across it, so that its linearised interval is a guess.
    pub kink: bool,
    /// What the points say of it.
    pub verdict: VerdictOfParameter,
    /// The same in words.
    pub sentence: String,
    /// Parameters that it is known together with, the nearest first.
    pub partners: Vec<String>,
    /// Size by which its interval is judged; absent for a logarithmic parameter. [unit]
    pub size: Option<f64>,
    /// Half-width of the 95 % interval over the size. [-]
    pub half_width_over_size: Option<f64>,
    /// The same if all other parameters were known. [-]
    pub half_width_over_size_alone: Option<f64>,
    /// Share of the range between the bounds that the interval fills. [-]
    pub range_filled: Option<f64>,
    /// Half-width of the 95 % interval over the range. [-]
    pub width_over_range: Option<f64>,
    /// The same if all other parameters were known. [-]
    pub width_over_range_alone: Option<f64>,
    /// Part of its column that no other parameter explains, from zero to one. [-]
    pub own_share: f64,
    /// What the points say of it, with the bound on which it stands.
    #[serde(skip)]
    pub judgement: Verdict,
}

/// What is known of a parameter beside the points.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct PriorOfParameter {
    /// Mean. [unit]
    pub mean: f64,
    /// Standard deviation; of a logarithmic parameter relative to the mean. [unit, or - of a logarithmic one]
    pub deviation: f64,
}

/// An interval by profile, or why there is none.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ProfileOfParameter {
    /// Why there is none.
    pub failed: Option<String>,
    /// Both ends. [unit]
    pub ends: Option<[f64; 2]>,
    /// Why each end is where it is.
    pub reach: Option<[ReachOfProfile; 2]>,
    /// Fits that it took.
    pub fits: Option<usize>,
    /// Whether a half-width is less than 0.8 or more than 1.25 of the linearised one.
    pub nonlinear: Option<bool>,
}

/// Why an end of an interval by profile is where it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ReachOfProfile {
    /// The misfit has risen to its limit there.
    Limit,
    /// The parameter meets its bound before.
    Bound,
    /// Neither within the fits that are allowed.
    Unresolved,
}

/// What the points say of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum VerdictOfParameter {
    /// The study holds it.
    Held,
    /// It is on a bound and would go on.
    OnBound,
    /// A change by its own size moves the results less than the instruments can see.
    NotSeen,
    /// The half-width of its interval is a tenth of its size or less.
    WellDetermined,
    /// It is known only together with others.
    OnlyInCombination,
    /// The half-width of its interval is half of its size or less.
    RoughlyDetermined,
    /// Its interval is nearly as wide as its size, or wider.
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
        Verdict::Held => "held".to_owned(),
        Verdict::OnBound(side) => format!("on its {} bound", side.name()),
        Verdict::NotSeen => "not seen".to_owned(),
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
            own_share: found.own,
            judgement: found.verdict,
        }
    }
}
