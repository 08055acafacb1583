//! Viscosity over temperature after Walther, ASTM D341 and DIN 51563: lg lg (nu + c) = A - B lg T.

use super::ZERO_CELSIUS;

/// A fitted law. Valid from 2 to 2e7 mm2/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walther {
    /// Intercept.
    pub a: f64,
    /// Slope.
    pub b: f64,
    /// Added to the viscosity in mm2/s: 0.7 in ASTM D341, 0.8 in DIN 51563.
    pub c: f64,
}

impl Walther {
    /// The law through two points of temperature in degC and viscosity in mm2/s.
    pub fn through(first: (f64, f64), second: (f64, f64), c: f64) -> Self {
        let y = |nu: f64| (nu + c).log10().log10();
        let x = |t: f64| (t + ZERO_CELSIUS).log10();
        let b = (y(first.1) - y(second.1)) / (x(second.0) - x(first.0));
        Self {
            a: y(first.1) + b * x(first.0),
            b,
            c,
        }
    }

    /// Kinematic viscosity at a temperature in degC. \[mm2/s\] Above zero at any temperature.
    pub fn nu(&self, temperature: f64) -> f64 {
        let lg = self.a - self.b * (temperature + ZERO_CELSIUS).max(1.0).log10();
        // Beyond its range the law crosses c; a thin oil stays an oil.
        (10.0_f64.powf(10.0_f64.powf(lg.min(1.2))) - self.c).max(0.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn close(value: f64, expected: f64) {
        assert!((value / expected - 1.0).abs() < 1e-5, "{value} against {expected}");
    }

    #[test]
    fn d1_law_through_27_3_and_5_9() {
        for (c, a, b, points) in [
            (
                0.7,
                8.25591,
                3.24367,
                [(60.0, 14.5709), (80.0, 8.84737), (0.0, 178.940), (130.0, 3.64244)],
            ),
            (
                0.8,
                8.15859,
                3.20449,
                [(60.0, 14.6173), (80.0, 8.87304), (0.0, 174.897), (130.0, 3.61333)],
            ),
        ] {
            let law = Walther::through((40.0, 27.3), (100.0, 5.9), c);
            close(law.a, a);
            close(law.b, b);
            for (t, nu) in points {
                close(law.nu(t), nu);
            }
        }
    }

    #[test]
    fn d1_data_sheet_of_a_gear_oil() {
        let law = Walther::through((40.0, 30.8), (100.0, 5.9), 0.8);
        close(law.nu(80.0), 9.11592);
        close(law.nu(90.0), 7.25469);
    }

    proptest! {
        #[test]
        fn viscosity_falls_with_temperature(nu40 in 6.0..1000.0_f64, ratio in 1.5..20.0_f64, t in -60.0..250.0_f64) {
            let law = Walther::through((40.0, nu40), (100.0, (nu40 / ratio).max(2.0)), 0.7);
            prop_assert!(law.nu(t).is_finite() && law.nu(t) >= law.nu(t + 1.0));
        }
    }
}
