//! Oil flow: the laws of channels, orifices, edges and holes, and the network of nodal pressures that they form.
//!
//! All laws are written over [`Real`](crate::real::Real). The network is solved once for the speeds and temperatures of a point, before the losses.

mod channel;
mod edge;
mod network;
mod orifice;
mod pocket;
mod solve;
mod window;

pub use channel::{Channel, friction_factor};
pub use edge::Edge;
pub(crate) use network::Inputs;
pub use network::{Driver, Element, End, Fluid, Hydraulics, Law, Place, Relief, Supplies, Supply};
pub use orifice::Orifice;
pub use pocket::{Chamber, Pocket, Rib, Room};
pub(crate) use solve::Work;
pub use window::{Taken, Window};

/// Standard acceleration of gravity. \[m/s2\]
pub const GRAVITY: f64 = 9.80665;

#[cfg(test)]
mod tests {
    /// \[m3/s\]
    pub const L_MIN: f64 = 1e-3 / 60.0;

    /// Equal to a number printed with some significant digits.
    pub fn close(value: f64, printed: f64, digits: i32) {
        let unit = 10.0_f64.powi(printed.abs().log10().floor() as i32 + 1 - digits);
        assert!((value - printed).abs() <= 0.501 * unit, "{value} against {printed}");
    }
}
