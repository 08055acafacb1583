//! Moment coefficient of a cylinder that rotates in a bore at rest: C_M = 2 M/(pi rho w^2 R^4 L).
//!
//! Sources: laminar flow without vortices, exact: C_M = 8 (1 + x)^2/((2 + x) Re), Re = rho w R d/mu, x = d/R, up to Ta = Re sqrt(x) = 41.3.
//! Smooth bores: Bilgen, Boulos, J. Fluids Eng. 95 (1973) 122-126, quoted from programs that agree; their first branch, below the exact one, is
//! replaced by it. Slotted bores: Vrancik, NASA TN D-4849 (1968): 1/sqrt(C_f) = 2.04 + 1.768 ln(Re sqrt(C_f)), C_M = 2 C_f, verified within
//! 7 % on a smooth rotor in a slotted stator, at Re near 5000.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Surface of a bore around a rotor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Bore {
    /// Smooth, as a canned stator or a casing (Bilgen and Boulos).
    Smooth,
    /// With open slots or teeth (Vrancik).
    Slotted,
}

/// Taylor number at which vortices begin.
const ONSET: f64 = 41.3;

/// Gap over radius below which the flow with vortices has a branch of its own.
const THIN: f64 = 0.07;

/// Reynolds number below which that branch is used.
const DEVELOPED: f64 = 500.0;

/// The coefficient of a bore for a Reynolds number and a gap over the radius.
pub fn moment_coefficient(bore: Bore, re: f64, x: f64) -> f64 {
    let laminar = 8.0 * (1.0 + x).powi(2) / ((2.0 + x) * re);
    let taylor = re * x.sqrt();
    if taylor <= ONSET {
        return laminar;
    }
    match bore {
        Bore::Smooth if x < THIN && re < DEVELOPED => laminar * (1.0 + 1.4472 * (1.0 - (ONSET / taylor).powi(2))),
        Bore::Smooth => laminar.max(x.powf(0.3) * bilgen_boulos(re)),
        Bore::Slotted => laminar.max(2.0 * vrancik(re)),
    }
}

/// The coefficient of Bilgen and Boulos over x^0.3.
fn bilgen_boulos(re: f64) -> f64 {
    if re < 64.0 {
        10.0 / re
    } else if re < 500.0 {
        2.0 / re.powf(0.6)
    } else if re < 1e4 {
        1.03 / re.sqrt()
    } else {
        0.065 / re.powf(0.2)
    }
}

/// The friction coefficient of Vrancik.
fn vrancik(re: f64) -> f64 {
    // With y = 1/sqrt(C_f): y + 1.768 ln(y) = 2.04 + 1.768 ln(Re), which Newton's method solves from any y above its root.
    let right = 2.04 + 1.768 * re.ln();
    let mut y = right.max(1.0);
    for _ in 0..8 {
        y -= (y + 1.768 * y.ln() - right) / (1.0 + 1.768 / y);
    }
    1.0 / (y * y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, printed: f64) {
        assert!((value / printed - 1.0).abs() < 1e-5, "{value} against {printed}");
    }

    #[test]
    fn both_laws_over_reynolds_number_and_gap() {
        for (re, x, smooth, slotted) in [
            (1e3, 0.01, 0.008_181_58, 0.019_394_9),
            (1e4, 0.01, 0.002_587_70, 0.010_660_9),
            (1e4, 0.05, 0.004_193_77, 0.010_660_9),
            (1e5, 0.05, 0.002_646_09, 0.006_644_2),
        ] {
            close(moment_coefficient(Bore::Smooth, re, x), smooth);
            close(moment_coefficient(Bore::Slotted, re, x), slotted);
        }
    }

    #[test]
    fn branches_meet_within_the_scatter_of_the_source() {
        let x = 0.8e-3 / 0.075;
        let jump = |re: f64| {
            let at = |re| moment_coefficient(Bore::Smooth, re, x);
            at(re * (1.0 + 1e-9)) / at(re * (1.0 - 1e-9)) - 1.0
        };
        assert!(jump(ONSET / x.sqrt()).abs() < 1e-6);
        assert!(jump(DEVELOPED).abs() < 0.06, "{}", jump(DEVELOPED));
        assert!(jump(1e4).abs() < 2e-3, "{}", jump(1e4));
    }

    #[test]
    fn thin_gaps_are_a_plane_film() {
        // M = 2 pi mu w R^3 L/d, so that C_M = 4/Re.
        close(moment_coefficient(Bore::Smooth, 10.0, 1e-9), 0.4);
    }
}
