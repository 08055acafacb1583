//! A gearbox under one model set, and a point of it.

use std::path::Path;

use gearloss_framework::evaluate::PowerFlow;
use gearloss_framework::files::SharedSource;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::{Choice, OWN_MODELS, Resolved};
use gearloss_framework::transmission::Transmission;
use gearloss_studies::engine::progress::Progress;
use gearloss_studies::numbers::RPM;
use gearloss_studies::points::{OilTemperature, PreparedPoint};
use serde_json::{Value, json};

use crate::answer::Fault;
use crate::request::{GivenInput, PointOf, Quantity};

/// A gearbox under one model set.
pub struct Chosen {
    pub gearbox: Gearbox,
    pub resolved: Resolved,
    pub transmission: Transmission,
}

impl Chosen {
    /// Reads, resolves and builds a gearbox, unless nobody waits for it any more.
    pub fn read(
        language: &Language,
        files: &SharedSource,
        file: &str,
        set: &str,
        progress: &dyn Progress,
    ) -> Result<Self, Fault> {
        Self::filled(language, files, file, (set, None), progress)
    }

    /// The same with another volume of oil (l), whose level follows from the oil space.
    pub fn filled(
        language: &Language,
        files: &SharedSource,
        file: &str,
        (set, volume): (&str, Option<f64>),
        progress: &dyn Progress,
    ) -> Result<Self, Fault> {
        let wanted = || {
            if progress.should_continue() {
                Ok(())
            } else {
                Err(Fault::interrupted())
            }
        };
        let gearbox = Gearbox::read_from(language, files, Path::new(file))?;
        let choice = Choice {
            set: Some(set.to_owned()).filter(|set| !set.is_empty() && set != OWN_MODELS),
            ..Choice::default()
        };
        wanted()?;
        let resolved = gearbox.resolve(language, &choice)?;
        wanted()?;
        let transmission = gearbox.build(language, &resolved)?;
        wanted()?;
        let own = Self {
            gearbox,
            resolved,
            transmission,
        };
        let Some(volume) = volume else { return Ok(own) };
        let overrides = own.fill(volume)?;
        let resolved = own.gearbox.resolve(language, &Choice { overrides, ..choice })?;
        wanted()?;
        let transmission = own.gearbox.build(language, &resolved)?;
        wanted()?;
        Ok(Self {
            gearbox: own.gearbox,
            resolved,
            transmission,
        })
    }

    /// Overrides for another volume of oil in l: the volume, and its level at the oil temperature of the gearbox if that states a level.
    pub fn fill(&self, volume: f64) -> Result<Vec<(String, Value)>, Fault> {
        let none = || {
            Fault::new(
                "the level of another volume is not known",
                "state an oil level, or a volume, and `housing.inside` if there is no hull of the gears",
            )
        };
        let space = self.transmission.oil_space().ok_or_else(none)?.space();
        let oil = &self.resolved.value["housing"]["oil"];
        let mut overrides = vec![("housing.oil.volume".to_owned(), json!(format!("{volume} l")))];
        if oil["level"].is_number() {
            let circuit = oil["circuit_volume"].as_f64().unwrap_or(0.0);
            let expansion = self
                .transmission
                .oil_expansion(oil["fill_temperature"].as_f64().unwrap_or(20.0));
            let hot = volume * 1e-3 * expansion - circuit;
            if !(hot > 0.0 && hot <= space.full()) {
                return Err(Fault::new(
                    format!(
                        "{volume} l of oil have no level: {:.3} l fit",
                        (space.full() + circuit) / expansion * 1e3
                    ),
                    "choose another volume",
                ));
            }
            let offset = oil["level_offset"].as_f64().unwrap_or(0.0);
            overrides.push((
                "housing.oil.level".to_owned(),
                json!(format!("{} mm", (space.level(hot) - offset) * 1e3)),
            ));
        }
        Ok(overrides)
    }

    /// Prepares a point.
    pub fn prepare(&self, point: &PointOf) -> Result<PreparedPoint, Fault> {
        let unknown = point.inputs.iter().find(|input| !input.value.is_finite());
        if let Some(input) = unknown {
            return Err(Fault::new(
                format!("the value at `{}` is not a number", input.port),
                "write a number",
            ));
        }
        let of = |quantity: Quantity| -> Vec<&GivenInput> {
            let inputs = point.inputs.iter();
            inputs.filter(|input| input.quantity == quantity).collect()
        };
        let names = |inputs: &[&GivenInput]| -> Vec<String> { inputs.iter().map(|input| input.port.clone()).collect() };
        let (speeds, torques) = (of(Quantity::Speed), of(Quantity::Torque));
        let (speed_names, torque_names) = (names(&speeds), names(&torques));
        let case = self.transmission.case(
            &point.gear,
            &speed_names.iter().map(String::as_str).collect::<Vec<_>>(),
            &torque_names.iter().map(String::as_str).collect::<Vec<_>>(),
        );
        let case = case.map_err(|list| Fault::from(self.gearbox.findings(list)))?;
        if let Some(oil) = point.oil_temperature.filter(|oil| !(-60.0..=250.0).contains(oil)) {
            return Err(Fault::new(
                format!("{oil} degC is not a valid oil temperature"),
                "write a temperature from -60 to 250 degC",
            ));
        }
        Ok(PreparedPoint {
            case,
            gear: point.gear.clone(),
            // The order of operations is that of `gearloss solve`, whose numbers these are to the bit.
            speeds: speeds.iter().map(|input| rad_per_s(input.value)).collect(),
            torques: torques.iter().map(|input| input.value).collect(),
            oil: OilTemperature::from_conditions(&self.transmission, point.oil_temperature),
            flow: PowerFlow::Real,
        })
    }
}

/// A speed in rpm as the documents read it. \[rad/s\]
fn rad_per_s(rpm: f64) -> f64 {
    gearloss_document::Unit::of_symbol("rpm").map_or(rpm / RPM, |unit| unit.to_si(rpm))
}
