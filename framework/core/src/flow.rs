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

use crate::real::{Mask as _, Points};

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
    /// Power in and out over ports; powers below 1e-12 of the greatest input count as zero.
    #[inline(always)]
    pub(crate) fn from_powers(powers: impl Iterator<Item = R> + Clone) -> Self {
        let most = powers
            .clone()
            .fold(R::ZERO, |most, power| R::select(power.is_above(most), power, most));
        let (mut input, mut output) = (R::ZERO, R::ZERO);
        for power in powers {
            input += R::select(power.is_above(most * 1e-12), power, R::ZERO);
            output -= R::select(power.is_below(most * -1e-12), power, R::ZERO);
        }
        Self { input, output }
    }

    /// That of one point.
    pub(crate) fn at_point(&self, point: usize) -> Balance {
        Balance {
            input: self.input.at_point(point),
            output: self.output.at_point(point),
        }
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
    /// The regime of each point of a rotating transmission from the powers of its ports; `reference` is the number of the reference
    /// port.
    #[inline(always)]
    pub(crate) fn from_powers<R: Points>(
        Balance { input, output }: Balance<R>,
        powers: impl Iterator<Item = R>,
        reference: usize,
    ) -> impl Fn(usize) -> Self {
        let (mut any, mut several, mut by_reference) = (0, 0, 0);
        for (port, power) in powers.enumerate() {
            let pushes = power.is_above(input * 1e-12).bits();
            several |= any & pushes;
            any |= pushes;
            if port == reference {
                by_reference = pushes;
            }
        }
        let dragged = output.is_zero().bits();
        move |point| {
            let holds = |bits: u32| bits >> point & 1 == 1;
            match () {
                () if holds(dragged) => Self::Dragged,
                () if holds(several) => Self::Split,
                () if holds(by_reference) => Self::Drive,
                () => Self::Coast,
            }
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
