//! A gearbox under one model set, and a point of it.

use std::path::Path;

use gearloss_framework::evaluate::PowerFlow;
use gearloss_framework::files::SharedSource;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::{Choice, OWN_MODELS, Resolved};
use gearloss_framework::transmission::Transmission;
use gearloss_studies::analyses::numbers::RPM;
use gearloss_studies::analyses::progress::Progress;
use gearloss_studies::points::{OilTemperature, PreparedPoint};

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
        Ok(Self {
            gearbox,
            resolved,
            transmission,
        })
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
