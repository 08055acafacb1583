//! What position errors of the pins of planets change at the rated torque: the stated ones, or one of 10 um where equal sharing is assumed.

use gearloss_framework::language::Language;
use gearloss_framework::transmission::{PlanetShares, Transmission};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Value, json};

use super::CheckedGearbox;

/// Position error of one pin that shows what errors would change. \[m\]
const ERROR: f64 = 10e-6;

/// Load sharing of the planets of a set at the rated torque and speed, and the loss of the gearbox with it and with equal loads.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PlanetsAtRating {
    /// Id of the set.
    pub set: String,
    /// Gear state.
    pub gear: String,
    /// True if no errors are stated, so that the values are those of one pin with an error of 10 um, with members without bearings floating.
    pub assumed_equal: bool,
    /// Load of the most loaded planet over the mean. [-]
    pub k_gamma: f64,
    /// Loss of the gearbox with it. [W]
    pub loss_w: f64,
    /// Loss of the gearbox with equal loads. [W]
    pub equal_loss_w: f64,
}

impl PlanetsAtRating {
    /// As one sentence.
    pub fn sentence(&self) -> String {
        let Self {
            set,
            gear,
            assumed_equal,
            k_gamma,
            loss_w,
            equal_loss_w,
        } = self;
        if *assumed_equal {
            format!(
                "at the rated torque in `{gear}`: planets of {set}: equal loads are assumed, loss {equal_loss_w:.2} W; an error of 10 um of one \
                 pin: K_gamma {k_gamma:.3}, {loss_w:.2} W"
            )
        } else {
            format!(
                "at the rated torque in `{gear}`: planets of {set}: K_gamma {k_gamma:.3} by their pins, loss {loss_w:.2} W; with equal loads \
                 {equal_loss_w:.2} W"
            )
        }
    }
}

/// The sets whose load sharing follows, or would follow, from position errors of their pins, in the first gear that loads them at the rating.
pub fn planet_sharings(language: &Language, checked: &CheckedGearbox) -> Vec<PlanetsAtRating> {
    let sets = checked.resolved.value["planetary_sets"].as_object();
    let found = sets.into_iter().flatten().filter_map(|(id, set)| {
        let stated = !set["pins"].is_null();
        if !(stated || set["load_sharing"].is_null()) || checked.transmission.rating.is_none() {
            return None;
        }
        let floating = if stated {
            Vec::new()
        } else {
            floating(&checked.resolved.value, set)
        };
        let errors = |first: f64| {
            let count = set["count"].as_u64().unwrap_or(0) as usize;
            let errors: Vec<f64> = (0..count).map(|i| if i == 0 { first } else { 0.0 }).collect();
            with_pins(
                language,
                checked,
                id,
                json!({ "errors": errors, "clearances": [], "meshes": [], "floating": floating }),
            )
        };
        let (own, other);
        let (uneven, equal) = if stated {
            other = errors(0.0)?;
            (&checked.transmission, &other)
        } else {
            own = errors(ERROR)?;
            (&own, &checked.transmission)
        };
        (0..uneven.states().len()).find_map(|state| {
            let (loss_w, shares) = at_rating(uneven, state)?;
            let shares = shares.into_iter().find(|shares| shares.set == *id)?;
            Some(PlanetsAtRating {
                set: id.clone(),
                gear: uneven.states()[state].name.clone(),
                assumed_equal: !stated,
                k_gamma: shares.k_gamma(),
                loss_w,
                equal_loss_w: at_rating(equal, state)?.0,
            })
        })
    });
    found.collect()
}

/// The members of a set that float, since they have no bearings: carrier, and members whose gears mesh with the planets.
fn floating(document: &Value, set: &Value) -> Vec<Value> {
    let elements = |section: &str| document[section].as_object().into_iter().flatten();
    let planets = set["planets"].as_array().map_or(&[] as &[Value], Vec::as_slice);
    // A loose gear is a member of its own, with its id as the name.
    let member = |gear: &Value| {
        let written = &document["gears"][gear.as_str()?];
        Some(if written["mounted"] == "loose" {
            gear.clone()
        } else {
            written["shaft"].clone()
        })
    };
    let mut members = vec![set["carrier"].clone()];
    for (_, mesh) in elements("meshes") {
        let gears = [&mesh["gears"][0], &mesh["gears"][1]].map(member);
        if let [Some(first), Some(second)] = gears {
            match [&first, &second].map(|member| planets.contains(member)) {
                [true, false] => members.push(second),
                [false, true] => members.push(first),
                _ => {}
            }
        }
    }
    members.sort_by(|a, b| a.as_str().cmp(&b.as_str()));
    members.dedup();
    let held = |member: &Value| elements("bearings").any(|(_, own)| own["shaft"] == *member || own["outer"] == *member);
    members.retain(|member| !held(member));
    members
        .into_iter()
        .map(|shaft| json!({ "shaft": shaft, "stiffness": 0.0 }))
        .collect()
}

/// The gearbox with other pins of a set; `None` if it cannot have them.
fn with_pins(language: &Language, checked: &CheckedGearbox, set: &str, pins: Value) -> Option<Transmission> {
    let mut resolved = checked.resolved.clone();
    resolved.value["planetary_sets"][set]["pins"] = pins;
    checked.gearbox.build(language, &resolved).ok()
}

/// Loss and load sharing at the rating; `None` if nothing is loaded.
fn at_rating(t: &Transmission, state: usize) -> Option<(f64, Vec<PlanetShares>)> {
    t.at_rating(state, |solution| Some((solution.loss()?, solution.planet_shares())))
        .flatten()
}
