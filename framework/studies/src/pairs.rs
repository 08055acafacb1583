//! Opposed bearings that load each other, as a checked gearbox shows them.

use gearloss_framework::loads::{InducedBasis, InducedThrust};
use gearloss_framework::resolve::{Resolved, ValueSource, lookup};
use gearloss_framework::transmission::{BearingPair, Mounting, Transmission};
use schemars::JsonSchema;
use serde::Serialize;

use crate::analyses::numbers::significant;

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
