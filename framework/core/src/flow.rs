//! Power flow: equilibrium of every member with losses, ideal or real.
//!
//! Constraints do no net work, so their torques are the transposed rows times multipliers. Mesh friction reduces the torque of the
//! driven gear in the carrier's frame, and the carrier takes the reaction. The power balance therefore holds to rounding for any
//! multipliers that solve the linear system.

mod derive;
mod equilibrium;
mod linear;
mod order;
mod solve;
mod structure;
mod system;
mod work;

use crate::real::Points;

pub use order::{FlowBlock, Laws};
pub use system::{Flow, FlowFault, LoadedDrag, MeshRow, Reading, Share};
pub(crate) use work::Last;
pub use work::{Drive, FlowState, Outcome, Start, Tolerance, Work};

/// Powers and status of one solved point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Balance<R = f64> {
    /// Input power over the ports. \[W\]
    pub input: R,
    /// Output power over the ports. \[W\]
    pub output: R,
}

impl<R: Points> Balance<R> {
    /// Power in and out over ports at one point; powers below 1e-12 of the input count as zero.
    pub(crate) fn from_powers(powers: impl Iterator<Item = R> + Clone) -> Self {
        let most = powers.clone().fold(0.0_f64, |most, power| most.max(power.at_point(0)));
        let (mut input, mut output) = (R::ZERO, R::ZERO);
        for power in powers {
            let watts = power.at_point(0);
            if watts > 1e-12 * most {
                input += power;
            } else if watts < -1e-12 * most {
                output -= power;
            }
        }
        Self { input, output }
    }
}

impl Balance {
    /// Output power over input power; `None` if the output is zero.
    pub fn efficiency(&self) -> Option<f64> {
        // Without losses the quotient may exceed one by rounding.
        (self.output > 0.0).then(|| (self.output / self.input).min(1.0))
    }
}

/// Operating state of a transmission at a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The reference port drives.
    Drive,
    /// Power flows towards the reference port.
    Coast,
    /// Several ports supply power.
    Split,
    /// There is input power, but no output power.
    Dragged,
    /// Nothing rotates.
    #[default]
    Standstill,
    /// With ideal power flow: losses exceed the input power, so there is no output.
    LossAboveInput,
    /// Self-locking: no torque maintains this motion.
    SelfLocking,
    /// The iteration did not converge.
    NoConvergence,
    /// A loss is undefined.
    Undefined,
}

impl Status {
    /// The regime of a rotating transmission from the powers of its ports; `reference` is the number of the reference port.
    pub(crate) fn from_powers(powers: impl Iterator<Item = f64> + Clone, reference: usize) -> Self {
        let Balance { input, output } = Balance::from_powers(powers.clone());
        let mut pushing = powers
            .enumerate()
            .filter(|(_, power)| *power > 1e-12 * input)
            .map(|(port, _)| port);
        match (pushing.next(), pushing.next()) {
            _ if output == 0.0 => Self::Dragged,
            (_, Some(_)) => Self::Split,
            (Some(port), None) if port == reference => Self::Drive,
            _ => Self::Coast,
        }
    }

    /// False if no torques were found: then no torque, load or loss is defined.
    pub fn has_flow(self) -> bool {
        !matches!(self, Self::SelfLocking | Self::NoConvergence)
    }

    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Drive => "drive",
            Self::Coast => "coast",
            Self::Split => "split",
            Self::Dragged => "dragged",
            Self::Standstill => "standstill",
            Self::LossAboveInput => "loss_above_input",
            Self::SelfLocking => "self_locking",
            Self::NoConvergence => "no_convergence",
            Self::Undefined => "undefined",
        }
    }
}

#[cfg(test)]
mod tests;
