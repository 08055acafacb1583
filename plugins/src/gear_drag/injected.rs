//! The flow of injected oil: stated, or that of a nozzle of the oil network.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::mechanism::gear_drag::GearDragAt;
use gearloss_framework::registry::Build;

/// Where the flow is stated.
#[derive(Debug, Clone, Copy)]
pub enum Injected {
    /// A flow. \[m3/s\]
    Stated(f64),
    /// That of the nozzle, in the context.
    Nozzle,
}

impl Injected {
    /// From the options of a model, of which one is required.
    pub fn new(flow: Option<f64>, nozzle: Option<&str>, cx: &mut Build<'_>) -> Result<Self, Diagnostic> {
        match (flow, nozzle) {
            (Some(flow), None) => Ok(Self::Stated(flow)),
            (None, Some(nozzle)) => {
                cx.oil_element("nozzles", nozzle)?;
                Ok(Self::Nozzle)
            }
            (Some(_), Some(_)) => Err(cx.error("the flow is stated twice").help("remove `flow` or `nozzle`")),
            (None, None) => Err(cx
                .error("the injected flow is missing")
                .help("write `flow: 2 l/min`, or name a nozzle of the oil network: `nozzle: J1`")),
        }
    }

    /// The flow. \[m3/s\]
    pub fn at(self, at: &GearDragAt<'_>) -> f64 {
        match self {
            Self::Stated(flow) => flow,
            Self::Nozzle => at.show("Q", "m3/s", at.injected),
        }
    }
}
