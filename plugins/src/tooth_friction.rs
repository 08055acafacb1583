//! Friction between flanks along the path of contact.

pub mod benedict_kelley;
pub mod doleschel;
pub mod drozdov_gavrikov;
pub mod ehl_mixed;
pub mod eyring;
pub mod iso_tc60;
pub mod mean;
pub mod misharin;
pub mod mixed;
pub mod odonoghue_cameron;
pub mod xu;

#[cfg(test)]
mod accuracy;

use gearloss_framework::loss::Undefined;

/// The sum of the surface speeds (m/s) of a contact that entrains oil; laws that divide by it are undefined otherwise.
fn entraining(sum_speed: f64) -> Result<f64, Undefined> {
    if sum_speed > 0.0 {
        Ok(sum_speed)
    } else {
        Err(Undefined {
            what: "sum of the surface speeds, which must be above zero [m/s]",
            value: sum_speed,
        })
    }
}

/// The coefficient if it is a number, else the reason why it is undefined.
fn finite(mu: f64) -> Result<f64, Undefined> {
    if mu.is_finite() && mu >= 0.0 {
        Ok(mu)
    } else {
        Err(Undefined {
            what: "coefficient of friction",
            value: mu,
        })
    }
}
