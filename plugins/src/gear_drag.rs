//! Drag of gears in oil and air: churning, squeezing, windage.

pub mod anderson_loewenthal;
pub mod ariura;
pub mod changenet_2007;
pub mod changenet_2011;
pub mod dawson;
pub mod diab;
pub mod dimensional;
mod dipping;
mod injected;
pub mod iso14179_1;
pub mod iso14179_2;
pub mod maurer;
pub mod mauz;
pub mod mauz_injection;
pub(crate) mod rise;
pub mod seetharaman_kahraman;
pub mod shore;
pub mod townsend;
pub(crate) mod wetted;

use gearloss_framework::mechanism::gear_drag::Covers;

const CHURNING: Covers = Covers {
    churning: true,
    squeezing: false,
    windage: false,
};
const SQUEEZING: Covers = Covers {
    churning: false,
    squeezing: true,
    windage: false,
};
const WINDAGE: Covers = Covers {
    churning: false,
    squeezing: false,
    windage: true,
};

/// Acceleration of gravity. \[m/s2\]
const GRAVITY: f64 = 9.80665;
