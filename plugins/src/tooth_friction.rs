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
mod product;
pub mod xu;

#[cfg(test)]
mod accuracy;

use gearloss_framework::loss::{Observed, Undefined};
use gearloss_framework::mechanism::tooth_friction::{PathAt, Range};
use gearloss_framework::real::{Mask as _, Real};

/// The sum of the surface speeds (m/s) of a contact that entrains oil; laws that divide by it are undefined otherwise.
#[inline(always)]
fn entraining<R: Real>(sum_speed: R) -> Result<R, Undefined> {
    if sum_speed.is_above(R::ZERO).all() {
        Ok(sum_speed)
    } else {
        Err(Undefined {
            what: "sum of the surface speeds, which must be above zero [m/s]",
            value: sum_speed.extremes(1).0,
        })
    }
}

/// The coefficient if it is a number, else the reason why it is undefined.
#[inline(always)]
pub(crate) fn finite<R: Real>(mu: R) -> Result<R, Undefined> {
    if mu.is_within(0.0, f64::MAX).all() {
        Ok(mu)
    } else {
        Err(Undefined {
            what: "coefficient of friction",
            value: mu.extremes(1).0,
        })
    }
}

/// Notes the range of a quantity over the nodes of a path that carry load.
#[inline(always)]
pub fn observe_along<R: Real>(path: &PathAt<'_, R>, observed: &Observed, all: impl Iterator<Item = R>) {
    let mut range = Range::default();
    for (node, value) in path.nodes.iter().zip(all) {
        range.extend(node, value);
    }
    for end in range.ends() {
        path.notes.observe(observed, end);
    }
}
