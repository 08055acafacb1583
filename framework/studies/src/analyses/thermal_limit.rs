//! The torque, or the speed, at which the heat balance reaches a given temperature.

use gearloss_framework::evaluate::{Point, Scratch};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::thermal::Limit;
use gearloss_framework::transmission::Case;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::balance::needs_balance;
use super::common::axes::{speeds, torques};
use super::{Analysis, Chosen, Engine, Head, Outcome, Plan, Planner, Run, Stopped, Work};
use crate::numbers::{RPM, tidy};
use crate::points::{Given, Note, UnitPoint, notes, unit_of};
use crate::register_analysis;
use crate::study::{SpeedAxis, TorqueAxis, Uses, Write};
use crate::table::Table;

/// The torque, or the speed, at which the heat balance reaches a given temperature.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ThermalLimitEntry {
    /// Gearbox, gear and model sets.
    #[serde(flatten)]
    pub chosen: Chosen,
    /// Limits of the oil temperature. [degC]
    #[schemars(inner(range(min = 0.0, max = 250.0)), length(min = 1))]
    pub temperature: Vec<f64>,
    /// Unknown: the torque at each speed, or the speed at each torque.
    #[serde(default)]
    pub find: Find,
    /// Torques: the range of the search, from the value nearest to zero to the farthest; or the given torques.
    pub torque: TorqueAxis,
    /// Speeds: the given speeds, or the range of the search.
    pub speed: SpeedAxis,
}

/// Unknown of a thermal limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Find {
    /// The torque at each speed.
    #[default]
    Torque,
    /// The speed at each torque.
    Speed,
}

register_analysis!(ThermalLimitEntry);

/// The thermal limits with each model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ThermalLimitOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// One for each model set.
    pub thermal_limits: Vec<ThermalLimitsOfSet>,
}

/// The thermal limits with one model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ThermalLimitsOfSet {
    /// Name of the set.
    pub model_set: String,
    /// Gear state.
    pub gear: String,
    /// The unknown.
    pub find: Find,
    /// One for each temperature and each speed or torque.
    pub limits: Vec<ThermalLimit>,
    /// Notes of models.
    pub notes: Vec<Note>,
}

/// The limit at one speed, or at one torque.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct ThermalLimit {
    /// Limit of the oil temperature. [degC]
    pub limit_degc: f64,
    /// Torque; absent if it is the unknown and there is no solution. [Nm]
    pub torque_nm: Option<f64>,
    /// Speed; absent if it is the unknown and there is no solution. [rpm]
    pub speed_rpm: Option<f64>,
    /// Result of the search: `reached`, `at_discontinuity` if the losses are discontinuous there, `exceeded_from_the_start`, `not_reached`,
    /// or `undefined` if losses or heat have no value.
    pub outcome: &'static str,
    /// Loss there. [W]
    pub loss_w: Option<f64>,
    /// Input power. [W]
    pub input_w: Option<f64>,
    /// Output power. [W]
    pub output_w: Option<f64>,
    /// Output power over input power. [-]
    pub efficiency: Option<f64>,
    /// Lowest stable temperature there: differs from the limit if there are several. [degC]
    pub lowest_balance_degc: Option<f64>,
    /// The drive unit there; absent without machines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<UnitPoint>,
    /// The speed without rounding, for figures. [rpm]
    #[serde(skip)]
    pub solved_speed_rpm: Option<f64>,
}

impl Analysis for ThermalLimitEntry {
    const TYPE: &'static str = "thermal_limit";
    const FORMATS: &'static [Write] = Write::WITH_FIGURES;
    type Plan<'a> = ThermalLimitPlan<'a>;
    type Outcome = ThermalLimitOutcome;

    fn uses(&self) -> Uses<'_> {
        self.chosen.uses()
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<ThermalLimitPlan<'a>, Stopped> {
        let path = cx.path();
        let mut searches = Vec::new();
        for b in self.chosen.built(cx)? {
            needs_balance(cx, &b)?;
            let gear = self.chosen.gear(&b.transmission);
            let torques = torques(cx, &format!("{path}.torque"), &self.torque, &b.transmission)?;
            let speeds = speeds(cx, &format!("{path}.speed"), &self.speed, &b.transmission)?;
            match self.find {
                Find::Torque => is_range(cx, &format!("{path}.torque"), &torques)?,
                Find::Speed => is_range(cx, &format!("{path}.speed"), &speeds)?,
            }
            let points = cx.points(&b.transmission, gear, Vec::new(), Vec::new());
            let case = cx.case(b.gearbox, &b.transmission, &points)?;
            if case.torque_ports.is_empty() && self.find == Find::Torque {
                let message = format!("`{gear}` has no given torque, so there is no torque limit");
                return Err(cx.wrong(&path, message, "choose another gear, or find the speed"));
            }
            let (range, fixed) = match self.find {
                Find::Torque => (torques, speeds),
                Find::Speed => (speeds, torques),
            };
            searches.push(Search {
                find: self.find,
                run: Run::new(cx, &b, points)?,
                case,
                temperatures: &self.temperature,
                range: outwards(&range),
                fixed,
            });
        }
        Ok(ThermalLimitPlan(searches))
    }

    fn reduce<'a>(&'a self, plan: ThermalLimitPlan<'a>, engine: &Engine<'a>) -> Result<ThermalLimitOutcome, Stopped> {
        let thermal_limits: Vec<ThermalLimitsOfSet> =
            engine.undivided(|| plan.0.iter().map(|search| search.all(engine)).collect())?;
        for (search, found) in plan.0.iter().zip(&thermal_limits) {
            let given = |limit: &ThermalLimit| {
                Some(Given {
                    torque: limit.torque_nm?,
                    speed: limit.solved_speed_rpm? / RPM,
                    oil: Some(limit.limit_degc),
                })
            };
            let reached = found.limits.iter().filter(|limit| limit.loss_w.is_some());
            engine.read_limits(&search.run, reached.filter_map(given).collect())?;
        }
        let built: Vec<_> = plan.0.into_iter().map(|search| search.run.built).collect();
        Ok(ThermalLimitOutcome {
            head: engine.head(&built),
            thermal_limits,
        })
    }
}

/// The search needs two values of the same sign.
fn is_range(cx: &Planner<'_>, path: &str, range: &[f64]) -> Result<(), Stopped> {
    let (Some(first), Some(last), true) = (range.first(), range.last(), range.len() > 1) else {
        let message = "the search for a limit needs a range, not one value";
        return Err(cx.wrong(path, message, "write `{ from: ..., to: ..., step: ... }`"));
    };
    if range.iter().any(|x| x * first < 0.0 || x * last < 0.0) {
        return Err(cx.wrong(
            path,
            "the range contains zero",
            "use separate analyses for positive and negative values",
        ));
    }
    Ok(())
}

/// From the value nearest to zero outwards.
fn outwards(range: &[f64]) -> [f64; 2] {
    let values = || range.iter().copied();
    let nearest = values().min_by(|a, b| a.abs().total_cmp(&b.abs()));
    let farthest = values().max_by(|a, b| a.abs().total_cmp(&b.abs()));
    [nearest, farthest].map(|end| end.unwrap_or(0.0))
}

/// The limits of one set at each temperature and each fixed torque or speed.
pub struct ThermalLimitPlan<'a>(Vec<Search<'a>>);

impl Plan for ThermalLimitPlan<'_> {
    fn work(&self) -> Vec<Work> {
        let work = |search: &Search<'_>| {
            let count = search.temperatures.len() * search.fixed.len();
            Work::new(search.run.label(), "search", count)
        };
        self.0.iter().map(work).collect()
    }
}

/// The searches with one set.
struct Search<'a> {
    find: Find,
    run: Run<'a>,
    case: Case,
    temperatures: &'a [f64],
    /// Range of what is found, from the end nearest to zero.
    range: [f64; 2],
    /// Values of the other quantity.
    fixed: Vec<f64>,
}

impl Search<'_> {
    fn all(&self, engine: &Engine<'_>) -> Result<ThermalLimitsOfSet, Stopped> {
        let transmission = &self.run.built.transmission;
        let mut scratch = transmission.scratch(&self.case);
        let mut limits = Vec::new();
        for temperature in self.temperatures {
            for value in &self.fixed {
                if !engine.should_continue() {
                    return Err(Stopped::Interrupted);
                }
                limits.push(self.limit(*temperature, self.range, *value, &mut scratch));
            }
        }
        Ok(ThermalLimitsOfSet {
            model_set: self.run.built.name.clone(),
            gear: self.run.points.gear.clone(),
            find: self.find,
            limits,
            notes: notes(transmission, &scratch.totals),
        })
    }

    /// Speed and torque if the unknown is `x`.
    fn given(&self, fixed: f64, x: f64) -> ([f64; 1], [f64; 1]) {
        match self.find {
            Find::Torque => ([fixed], [x]),
            Find::Speed => ([x], [fixed]),
        }
    }

    /// The limit of one temperature at one fixed value.
    fn limit(&self, temperature: f64, range: [f64; 2], fixed: f64, scratch: &mut Scratch) -> ThermalLimit {
        let t = &self.run.built.transmission;
        let count = self.case.torque_ports.len();
        let (speed, torque) = self.given(fixed, range[0]);
        let start = Point {
            speeds: &speed,
            torques: &torque[..count],
            flow: self.run.points.flow,
            tolerance: Tolerance::default(),
            inclination: 0.0,
        };
        let set = |x: f64, speeds: &mut [f64], torques: &mut [f64]| {
            let (speed, torque) = self.given(fixed, x);
            speeds.copy_from_slice(&speed);
            torques.copy_from_slice(&torque[..torques.len()]);
        };
        let limit: Limit = t.thermal_limit(&self.case, &start, temperature, range, set, scratch);
        let mut found = ThermalLimit {
            limit_degc: temperature,
            torque_nm: (self.find == Find::Speed).then_some(fixed),
            speed_rpm: None,
            outcome: limit.name(),
            loss_w: None,
            input_w: None,
            output_w: None,
            efficiency: None,
            lowest_balance_degc: None,
            unit: None,
            solved_speed_rpm: (self.find == Find::Torque).then_some(fixed * RPM),
        };
        if let Some(x) = limit.value() {
            let (speed, torque) = self.given(fixed, x);
            let point = Point {
                speeds: &speed,
                torques: &torque[..count],
                ..start
            };
            found.lowest_balance_degc = t.equilibrium(&self.case, &point, scratch).oil();
            let solution = t.evaluate(&self.case, &point, &[temperature], scratch);
            (found.torque_nm, found.solved_speed_rpm) = (Some(torque[0]), Some(speed[0] * RPM));
            (found.loss_w, found.efficiency) = (solution.loss(), solution.efficiency());
            (found.input_w, found.output_w) = (solution.input_power(), solution.output_power());
            found.unit = unit_of(t, &solution, &[temperature]);
        }
        found.speed_rpm = found.solved_speed_rpm.map(tidy);
        found
    }
}

impl Outcome for ThermalLimitOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let table = Table::of_each(&self.head.analysis, &self.thermal_limits, |of_set| &of_set.limits)
            .text("model_set", "Model set", |(of_set, _)| &of_set.model_set)
            .text("gear", "Gear", |(of_set, _)| &of_set.gear)
            .fields(
                "limit_degc torque_nm speed_rpm outcome loss_w input_w output_w efficiency lowest_balance_degc",
                |(_, limit)| limit,
            );
        let table = UnitPoint::add_to(table, |(_, limit)| limit.unit.as_ref());
        vec![table.finish()]
    }

    fn notes(&self) -> Vec<&Note> {
        self.thermal_limits.iter().flat_map(|of_set| &of_set.notes).collect()
    }
}
