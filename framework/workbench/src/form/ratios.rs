//! Ratios of the gearbox of a form.

use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::GearState;
use serde::Serialize;

/// Ratio of each gear of a gearbox without errors, to the port that it names.
pub fn ratios(language: &Language, text: &str) -> Vec<Ratio> {
    let read = Gearbox::of_text(language, text, "gearbox.yaml", "");
    let Ok(t) = read.and_then(|gearbox| gearbox.transmission(language, &Choice::default())) else {
        return Vec::new();
    };
    let of_gear = |(i, state): (usize, &GearState)| {
        let others = t.ratios(i).into_iter();
        let others = others.filter_map(|(port, ratio)| {
            Some(Ratio {
                gear: state.name.clone(),
                to: t.ports()[port].name.clone(),
                ratio: ratio?,
            })
        });
        others.collect::<Vec<_>>()
    };
    t.states().iter().enumerate().flat_map(of_gear).collect()
}

/// Speed of the reference port over that of another.
#[derive(Debug, Clone, Serialize)]
pub struct Ratio {
    /// Gear state.
    pub gear: String,
    /// The other port.
    pub to: String,
    /// Ratio; negative if the senses of rotation differ. [-]
    pub ratio: f64,
}
