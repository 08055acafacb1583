//! Viscosity over temperature according to Walther, ASTM D341 and DIN 51563: lg lg Z = A - B lg T, Z the viscosity in mm2/s with a
//! constant.

use std::f64::consts::LN_10;

use super::ZERO_CELSIUS;

/// Definition of Z.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// nu + 0.7: ASTM D341 from 2 mm2/s.
    AstmD341,
    /// nu + 0.8: DIN 51563. About 2 % different from the former at 0 degC, the same between the two points of its fit.
    Din51563,
    /// nu + 0.7 + exp(-1.47 - 1.84 nu - 0.51 nu^2): ASTM D341 from 0.21 mm2/s.
    AstmD341Low,
}

impl Form {
    fn z(self, nu: f64) -> f64 {
        match self {
            Self::AstmD341 => nu + 0.7,
            Self::Din51563 => nu + 0.8,
            Self::AstmD341Low => nu + 0.7 + (-1.47 - 1.84 * nu - 0.51 * nu * nu).exp(),
        }
    }

    /// Viscosity from Z, and its slope.
    fn nu(self, z: f64) -> (f64, f64) {
        match self {
            Self::AstmD341 => (z - 0.7, 1.0),
            Self::Din51563 => (z - 0.8, 1.0),
            Self::AstmD341Low => {
                let x = z - 0.7;
                let small = (-0.7487 - 3.295 * x + 0.6119 * x * x - 0.3193 * x.powi(3)).exp();
                (x - small, 1.0 + small * (3.295 - 1.2238 * x + 0.9579 * x * x))
            }
        }
    }
}

/// A fitted law. Valid to 2e7 mm2/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Walther {
    /// Intercept.
    pub a: f64,
    /// Slope.
    pub b: f64,
    /// Definition of Z.
    pub form: Form,
}

/// Minimum viscosity of the law: outside its range it would cross zero. \[mm2/s\]
const THINNEST: f64 = 0.1;

impl Walther {
    /// The law through two points of temperature in degC and viscosity in mm2/s.
    pub fn through(first: (f64, f64), second: (f64, f64), form: Form) -> Self {
        let y = |nu: f64| form.z(nu).log10().log10();
        let x = |t: f64| (t + ZERO_CELSIUS).log10();
        let b = (y(first.1) - y(second.1)) / (x(second.0) - x(first.0));
        Self {
            a: y(first.1) + b * x(first.0),
            b,
            form,
        }
    }

    /// Logarithm of Z, and Z.
    fn z(&self, temperature: f64) -> (f64, f64) {
        let lg_lg = self.a - self.b * (temperature + ZERO_CELSIUS).max(1.0).log10();
        let ln = LN_10 * (LN_10 * lg_lg.min(1.2)).exp();
        (ln, ln.exp())
    }

    /// Kinematic viscosity at a temperature in degC. \[mm2/s\] Above zero at any temperature.
    pub fn nu(&self, temperature: f64) -> f64 {
        self.form.nu(self.z(temperature).1).0.max(THINNEST)
    }

    /// Kinematic viscosity in mm2/s, and its relative decrease with temperature, -(dnu/dT)/nu, in 1/K.
    pub(crate) fn nu_and_slope(&self, temperature: f64) -> (f64, f64) {
        let (ln_z, z) = self.z(temperature);
        let (nu, slope) = self.form.nu(z);
        let nu = nu.max(THINNEST);
        (
            nu,
            slope * self.b * z * ln_z / (nu * (temperature + ZERO_CELSIUS).max(1.0)),
        )
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
        for (form, a, b, points) in [
            (
                Form::AstmD341,
                8.25591,
                3.24367,
                [(60.0, 14.5709), (80.0, 8.84737), (0.0, 178.940), (130.0, 3.64244)],
            ),
            (
                Form::Din51563,
                8.15859,
                3.20449,
                [(60.0, 14.6173), (80.0, 8.87304), (0.0, 174.897), (130.0, 3.61333)],
            ),
        ] {
            let law = Walther::through((40.0, 27.3), (100.0, 5.9), form);
            close(law.a, a);
            close(law.b, b);
            for (t, nu) in points {
                close(law.nu(t), nu);
            }
        }
    }

    #[test]
    fn d1_data_sheet_of_a_gear_oil() {
        let law = Walther::through((40.0, 30.8), (100.0, 5.9), Form::Din51563);
        close(law.nu(80.0), 9.11592);
        close(law.nu(90.0), 7.25469);
    }

    #[test]
    fn d1_low_viscosity_form() {
        let law = Walther::through((40.0, 2.5), (100.0, 1.2), Form::AstmD341Low);
        close(law.nu(150.0), 0.792533);
    }

    proptest! {
        #[test]
        fn viscosity_falls_with_temperature(nu40 in 6.0..1000.0_f64, ratio in 1.5..20.0_f64, t in -60.0..250.0_f64) {
            let law = Walther::through((40.0, nu40), (100.0, (nu40 / ratio).max(2.0)), Form::AstmD341);
            prop_assert!(law.nu(t).is_finite() && law.nu(t) >= law.nu(t + 1.0));
        }

        #[test]
        fn the_slope_is_that_of_the_law(nu40 in 6.0..1000.0_f64, ratio in 1.5..10.0_f64, t in -20.0..150.0_f64) {
            for form in [Form::AstmD341, Form::Din51563, Form::AstmD341Low] {
                let law = Walther::through((40.0, nu40), (100.0, (nu40 / ratio).max(2.0)), form);
                let difference = (law.nu(t - 1e-3) - law.nu(t + 1e-3)) / 2e-3 / law.nu(t);
                // A central difference over 2 mK of a smooth law has six accurate digits; below 0.1 mm2/s it is constant.
                prop_assert!(law.nu(t + 1e-3) <= 0.1 || (difference / law.nu_and_slope(t).1 - 1.0).abs() < 1e-5);
            }
        }
    }
}
