//! The bearings of a checked gearbox at a glance.

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use crate::checked::{CheckedGearbox, at_the_rating};
use crate::ratings::{RatedComponent, rated};

/// One bearing: what it is, where it is, and its worst values at the rated torque and speed.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct BearingCard {
    /// Path of the bearing.
    pub bearing: String,
    /// Shaft in its bore.
    pub shaft: String,
    /// Position along the shaft. [mm]
    pub at_mm: f64,
    /// Designation; null if the data are stated.
    pub designation: Option<String>,
    /// Directions in which it takes thrust of the shaft.
    #[schemars(extend("enum" = ["none", "left", "right", "both"]))]
    pub axial: String,
    /// Dynamic load rating. [N]
    pub c_n: Option<f64>,
    /// Static load rating. [N]
    pub c0_n: Option<f64>,
    /// Values at the rated torque and speed; null without a `rating` of the gearbox.
    pub at_rating: Option<BearingAtRating>,
}

/// Values of a bearing at the rated torque and speed, each the worst of all gears, in drive and coast; null where it is unknown.
#[derive(Debug, Clone, Default, Serialize, JsonSchema)]
pub struct BearingAtRating {
    /// Largest equivalent dynamic load. [N]
    pub p_n: Option<f64>,
    /// Largest equivalent static load. [N]
    pub p0_n: Option<f64>,
    /// Shortest basic rating life. [h]
    pub l10h_h: Option<f64>,
    /// Largest speed factor n d_m. [mm/min]
    pub speed_factor: Option<f64>,
}

impl BearingAtRating {
    fn note(&mut self, rated: &RatedComponent) {
        let slots: [(&str, &str, &mut Option<f64>, fn(f64, f64) -> f64); 4] = [
            ("iso_281", "P", &mut self.p_n, f64::max),
            ("iso_76", "P0", &mut self.p0_n, f64::max),
            ("iso_281", "L10h", &mut self.l10h_h, f64::min),
            ("bearing_speed", "n d_m", &mut self.speed_factor, f64::max),
        ];
        for (rating, symbol, slot, worse) in slots {
            let quantities = rated.quantities.iter();
            let mut quantities = quantities.filter(|quantity| rated.rating == rating && quantity.symbol == symbol);
            if let Some(quantity) = quantities.next() {
                *slot = Some(slot.map_or(quantity.value, |known| worse(known, quantity.value)));
            }
        }
    }
}

/// The bearings of a gearbox, in the order of the document.
pub fn bearing_cards(checked: &CheckedGearbox) -> Vec<BearingCard> {
    let section = checked.resolved.value["bearings"].as_object();
    let mut cards: Vec<BearingCard> = section
        .into_iter()
        .flatten()
        .map(|(id, entry)| described(id, entry))
        .collect();
    at_the_rating(&checked.transmission, |solution| {
        for rated_bearing in rated(&checked.ratings, &checked.transmission, solution) {
            if let Some(card) = cards.iter_mut().find(|card| card.bearing == rated_bearing.component) {
                card.at_rating.get_or_insert_default().note(&rated_bearing);
            }
        }
    });
    cards
}

/// A bearing as described in a resolved document.
fn described(id: &str, entry: &Value) -> BearingCard {
    let text = |key: &str| entry[key].as_str().map(str::to_owned);
    let path = format!("bearings.{id}");
    BearingCard {
        shaft: text("shaft").unwrap_or_default(),
        at_mm: 1e3 * entry["at"].as_f64().unwrap_or_default(),
        designation: text("designation"),
        axial: text("axial").unwrap_or_default(),
        c_n: entry["c"].as_f64(),
        c0_n: entry["c0"].as_f64(),
        at_rating: None,
        bearing: path,
    }
}
