//! Opposed bearings that load each other, as a checked gearbox shows them.

use gearloss_framework::evaluate::Solution;
use gearloss_framework::loads::{InducedBasis, InducedThrust};
use gearloss_framework::resolve::{Resolved, ValueSource, lookup};
use gearloss_framework::transmission::{BearingPair, BodyTemperature, Mounting, PairPreload, PreloadBy, Transmission};
use schemars::JsonSchema;
use serde::Serialize;

use crate::numbers::{figures, significant};

/// Opposed angular contact or tapered roller bearings that load each other.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PairCard {
    /// Shaft or gear that they carry.
    pub member: String,
    /// The bearings, those that take thrust of the member towards -x first.
    pub bearings: Vec<PairedCard>,
    /// How they are mounted; null if their positions do not tell.
    pub mounting: Option<Mounting>,
    /// Spring on one of them; null without a spring.
    pub spring: Option<SpringCard>,
    /// Preload or end play of both; null if none is stated.
    pub preload: Option<PreloadCard>,
}

/// A bearing of a pair.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PairedCard {
    /// Path of the bearing.
    pub bearing: String,
    /// Direction of the thrust of the member that it takes.
    #[schemars(extend("enum" = ["left", "right"]))]
    pub takes: &'static str,
    /// Thrust that its radial load induces, per radial load. [-]
    pub induced_thrust: f64,
    /// What this follows from.
    pub follows_from: String,
    /// Share of the axial load of its side. [-]
    pub share: f64,
}

/// A spring that presses a ring of a pair against its rolling elements.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SpringCard {
    /// Path of the bearing.
    pub bearing: String,
    /// Force of the spring. [N]
    pub force_n: f64,
}

/// Preload or end play of a pair.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PreloadCard {
    /// Path of the bearing that states it.
    pub bearing: String,
    /// What is stated.
    #[schemars(extend("enum" = ["force", "closing", "torque"]))]
    pub stated: &'static str,
    /// Temperature of all parts at mounting. [degC]
    pub mounting_temperature_degc: f64,
    /// Force at mounting temperature, without other loads; zero with end play. [N]
    pub force_n: f64,
    /// Distance by which both bearings together are closed at mounting temperature; negative with end play. [um]
    pub closing_um: f64,
    /// Axial stiffness of the shaft between both at this force; null with end play. [N/um]
    pub axial_stiffness: Option<f64>,
    /// Distance of the contacts with the outer rings along the shaft. [mm]
    pub distance_mm: f64,
    /// Change of the closing per kelvin of the shaft. [um]
    pub per_kelvin_of_shaft_um: f64,
    /// Change of the closing per kelvin of the housing. [um]
    pub per_kelvin_of_housing_um: f64,
    /// What the temperature of the shaft is.
    pub shaft_temperature: String,
    /// What the temperature of the housing is.
    pub housing_temperature: String,
}

/// Preload of a pair at a point.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PreloadRecord {
    /// Shaft or gear that the pair carries.
    pub member: String,
    /// Paths of both bearings, the one that takes thrust towards -x first.
    pub bearings: [String; 2],
    /// Temperature of the shaft. [degC]
    pub shaft_degc: f64,
    /// Temperature of the housing. [degC]
    pub housing_degc: f64,
    /// Distance by which both bearings together are closed; negative with end play. [um]
    pub closing_um: f64,
    /// The part of it that temperature adds to that at mounting. [um]
    pub thermal_closing_um: f64,
    /// Force with which both would press against each other without other loads; zero with end play. [N]
    pub preload_n: f64,
    /// Distance by which each bearing is closed under its loads; below zero less than half of its rolling elements carry, none without radial
    /// load. [um]
    pub closings_um: [f64; 2],
    /// True if that of a bearing is below zero.
    pub lost: bool,
}

/// The preloads of the pairs of a transmission at a point, in their order; empty without a power flow.
pub fn preload_records(transmission: &Transmission, solution: &Solution<'_>) -> Vec<PreloadRecord> {
    let of_pair = |(number, pair): (usize, &BearingPair)| {
        let at = solution.preload(number).filter(|_| solution.has_flow())?;
        let mounted = pair.preload.as_ref()?.closing;
        let mut paths = pair.supports().map(|support| transmission.supports()[support].clone());
        let [shaft, housing] = at.temperatures;
        Some(PreloadRecord {
            member: transmission.members()[pair.member].clone(),
            bearings: [paths.next()?, paths.next()?],
            shaft_degc: shaft,
            housing_degc: housing,
            closing_um: 1e6 * at.closing,
            thermal_closing_um: 1e6 * (at.closing - mounted),
            preload_n: at.force,
            closings_um: at.closings.map(|own| 1e6 * own),
            lost: at.closings.iter().any(|own| *own < 0.0),
        })
    };
    transmission.pairs().iter().enumerate().filter_map(of_pair).collect()
}

impl PreloadRecord {
    /// It as a line.
    pub fn sentence(&self) -> String {
        let [left, right] = self.bearings.each_ref().map(|path| id(path));
        let words = if self.closing_um > 0.0 { "closed by" } else { "end play" };
        let lost = if self.lost { "; preload lost" } else { "" };
        format!(
            "pair {left}/{right} of {}: {words} {} um, of it {} um by temperature (shaft {} degC, housing {} degC); preload {} N; \
             under load {left} {} um, {right} {} um{lost}",
            self.member,
            short(self.closing_um.abs()),
            short(self.thermal_closing_um),
            short(self.shaft_degc),
            short(self.housing_degc),
            short(self.preload_n),
            short(self.closings_um[0]),
            short(self.closings_um[1]),
        )
    }
}

/// A number as in lines for reading.
fn short(x: f64) -> String {
    figures(x, 4)
}

/// The preload of a pair.
fn preload_card(transmission: &Transmission, preload: &PairPreload) -> PreloadCard {
    let temperature = |body: BodyTemperature| match body {
        BodyTemperature::Stated(temperature) => format!("{} degC", significant(temperature)),
        BodyTemperature::Node(node) => {
            let network = transmission.network();
            let name = network.and_then(|network| network.names().get(node).cloned());
            format!("node {}", name.unwrap_or_default())
        }
        BodyTemperature::AboveOil { above: 0.0, .. } => "that of the oil".to_owned(),
        BodyTemperature::AboveOil { above, .. } if above > 0.0 => format!("oil + {} K", significant(above)),
        BodyTemperature::AboveOil { above, .. } => format!("oil - {} K", significant(-above)),
    };
    let [of_shaft, of_housing] = preload.per_kelvin;
    let [shaft, housing] = preload.temperatures.map(temperature);
    PreloadCard {
        bearing: transmission.supports()[preload.support].clone(),
        stated: match preload.stated {
            PreloadBy::Force => "force",
            PreloadBy::Closing => "closing",
            PreloadBy::Torque => "torque",
        },
        mounting_temperature_degc: preload.mounting_temperature,
        force_n: preload.force,
        closing_um: 1e6 * preload.closing,
        axial_stiffness: (preload.force > 0.0).then(|| 1e-6 * preload.bearings.stiffness(preload.force)),
        distance_mm: 1e3 * preload.distance,
        per_kelvin_of_shaft_um: 1e6 * of_shaft,
        per_kelvin_of_housing_um: 1e6 * of_housing,
        shaft_temperature: shaft,
        housing_temperature: housing,
    }
}

impl PreloadCard {
    /// It in words.
    fn words(&self) -> String {
        let mounted = match self.axial_stiffness {
            Some(stiffness) => format!(
                "preload {} N ({} um, {} N/um)",
                short(self.force_n),
                short(self.closing_um),
                short(stiffness)
            ),
            None => format!("end play {} um", short(-self.closing_um)),
        };
        let signed = |um: f64| {
            let sign = if um < 0.0 { "-" } else { "+" };
            format!("{sign}{} um/K", short(um.abs()))
        };
        format!(
            "{mounted} at {} degC, {} of the shaft ({}), {} of the housing ({}), contacts {} mm apart",
            short(self.mounting_temperature_degc),
            signed(self.per_kelvin_of_shaft_um),
            self.shaft_temperature,
            signed(self.per_kelvin_of_housing_um),
            self.housing_temperature,
            short(self.distance_mm),
        )
    }
}

/// The pairs of a transmission, in its order.
pub fn pair_cards(transmission: &Transmission, resolved: &Resolved) -> Vec<PairCard> {
    let card = |pair: &BearingPair| {
        let path = |support: usize| transmission.supports()[support].clone();
        let sides = pair.sides.iter().zip(["left", "right"]);
        let bearings = sides.flat_map(|(side, takes)| side.iter().map(move |bearing| (bearing, takes)));
        PairCard {
            member: transmission.members()[pair.member].clone(),
            bearings: bearings
                .map(|(bearing, takes)| PairedCard {
                    takes,
                    induced_thrust: bearing.induced.ratio,
                    follows_from: follows_from(resolved, &path(bearing.support), bearing.induced),
                    share: bearing.share,
                    bearing: path(bearing.support),
                })
                .collect(),
            mounting: pair.mounting,
            spring: pair.spring.map(|spring| SpringCard {
                bearing: path(spring.support),
                force_n: spring.force,
            }),
            preload: pair.preload.as_ref().map(|preload| preload_card(transmission, preload)),
        }
    };
    transmission.pairs().iter().map(card).collect()
}

/// What the induced thrust of a bearing follows from, and where that value is from.
fn follows_from(resolved: &Resolved, bearing: &str, induced: InducedThrust) -> String {
    let path = format!("{bearing}.{}", induced.basis.key());
    let source = match resolved.source_of(&path) {
        ValueSource::Catalogue { designation, .. } => format!("catalogue {designation}"),
        ValueSource::Override => "override".to_owned(),
        _ if lookup(&resolved.value, &path).is_none_or(serde_json::Value::is_null) => "designation".to_owned(),
        _ => "stated".to_owned(),
    };
    match induced.basis {
        InducedBasis::Stated => source,
        // Its angle may be estimated, which the evidence says.
        basis @ InducedBasis::HalfLoaded(_) => basis.to_string(),
        basis => format!("{basis}, {source}"),
    }
}

impl PairCard {
    /// Its name: bearings and member.
    pub fn name(&self) -> String {
        let of_side = |takes: &str| {
            let side = self.bearings.iter().filter(|bearing| bearing.takes == takes);
            let ids: Vec<&str> = side.map(|bearing| id(&bearing.bearing)).collect();
            ids.join("+")
        };
        format!("pair {}/{} of {}", of_side("left"), of_side("right"), self.member)
    }

    /// How it is mounted, in words.
    pub fn mounting_words(&self) -> &'static str {
        self.mounting
            .map_or("mounting not known from the positions", Mounting::words)
    }

    /// It and what its induced thrust follows from, as a line.
    pub fn sentence(&self) -> String {
        let thrust =
            |bearing: &PairedCard| format!("{} ({})", significant(bearing.induced_thrust), bearing.follows_from);
        let mut thrusts: Vec<String> = self.bearings.iter().map(thrust).collect();
        thrusts.dedup();
        let thrusts = if thrusts.len() == 1 {
            thrusts.remove(0)
        } else {
            let all = self.bearings.iter();
            let all = all.map(|bearing| format!("{} {}", id(&bearing.bearing), thrust(bearing)));
            all.collect::<Vec<_>>().join(", ")
        };
        let spring = self.spring.as_ref().map_or_else(String::new, |spring| {
            format!(
                "; spring of {} N on {}",
                significant(spring.force_n),
                id(&spring.bearing)
            )
        });
        if let Some(preload) = &self.preload {
            return format!("{}: {}; {}", self.name(), self.mounting_words(), preload.words());
        }
        format!(
            "{}: {}; induced thrust per radial load {thrusts}{spring}",
            self.name(),
            self.mounting_words()
        )
    }
}

/// The last key of a path.
fn id(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}
