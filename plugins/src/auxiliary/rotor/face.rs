//! Moment coefficient of both faces of a disc: C_M = 2 M/(rho w^2 R^5).
//!
//! Sources: free disc, 3.87/Re^0.5 (von Karman's equations, solved) and 0.146/Re^0.2 above Re = 3e5; enclosed disc, Daily, Nece, J. Basic Eng. 82
//! (1960) 217-232, four regimes over Re = rho w R^2/mu and the clearance over the radius.

use std::f64::consts::PI;

/// Reynolds number at which the flow at a free disc becomes turbulent.
const TURBULENT: f64 = 3e5;

/// The coefficient of a free disc.
pub fn free(re: f64) -> f64 {
    if re <= TURBULENT {
        3.87 / re.sqrt()
    } else {
        0.146 / re.powf(0.2)
    }
}

/// The coefficient of a disc with walls on both sides, by clearance over radius.
pub fn enclosed(re: f64, clearance: f64) -> f64 {
    let merged = 2.0 * PI / (clearance * re);
    let laminar = 3.70 * clearance.powf(0.1) / re.sqrt();
    let merged_turbulent = 0.080 * clearance.powf(-1.0 / 6.0) / re.powf(0.25);
    let turbulent = 0.102 * clearance.powf(0.1) / re.powf(0.2);
    // Both of merged boundary layers and of separate ones, the regime with the larger coefficient holds.
    merged.max(laminar).max(merged_turbulent.max(turbulent))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, printed: f64) {
        assert!((value / printed - 1.0).abs() < 1e-5, "{value} against {printed}");
    }

    #[test]
    fn third_regime() {
        close(enclosed(1.9e5, 0.04), 0.006_552_27);
    }

    #[test]
    fn published_borders_of_the_regimes() {
        let meets = |a: f64, b: f64, tolerance: f64| assert!((a / b - 1.0).abs() < tolerance, "{a} {b}");
        for re in [1e4_f64, 1e5] {
            // Between I and II the clearance is 1.62 Re^(-5/11).
            let s = 1.62 * re.powf(-5.0 / 11.0);
            meets(2.0 * PI / (s * re), 3.70 * s.powf(0.1) / re.sqrt(), 5e-3);
        }
        for re in [1e6_f64, 1e7] {
            // Between III and IV it is 0.402 Re^(-3/16).
            let s = 0.402 * re.powf(-3.0 / 16.0);
            meets(
                0.080 * s.powf(-1.0 / 6.0) / re.powf(0.25),
                0.102 * s.powf(0.1) / re.powf(0.2),
                5e-3,
            );
        }
    }
}
