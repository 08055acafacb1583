//! Rolling friction of lubricated contacts: the resistance of the inlet film to rolling.
//!
//! Sources: Biboulet and Houpert, Proc. IMechE J 224 (2010), parts 1 and 2 (points and lines, starvation); Zhou and Hoeprich, J. Tribol. 113 (1991)
//! 590, and Aihara, J. Tribol. 109 (1987) 471 (lines of tapered rollers, heating at the inlet). The force acts on both surfaces, so that a contact
//! takes the power 2 F u; F u alone, as one public program has it, misses half.

use std::f64::consts::PI;

use gearloss_framework::rolling::Ellipse;
use schemars::JsonSchema;
use serde::Deserialize;

/// Law of the rolling friction of rollers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LineLaw {
    /// Zhou and Hoeprich, with their factor of heating.
    #[default]
    ZhouHoeprich,
    /// Aihara, with his factor of heating; fitted to about 200 tapered roller bearings.
    Aihara,
    /// Biboulet and Houpert for a flooded inlet, with Aihara's factor of heating.
    BibouletHoupert,
}

/// The oil at the inlet of a contact, SI.
#[derive(Debug, Clone, Copy)]
pub struct InletOil {
    /// Dynamic viscosity. \[Pa s\]
    pub eta: f64,
    /// Pressure-viscosity coefficient. \[1/Pa\]
    pub alpha: f64,
    /// Relative decrease of the viscosity with temperature. \[1/K\]
    pub beta: f64,
    /// Thermal conductivity. \[W/(m K)\]
    pub conductivity: f64,
}

impl InletOil {
    /// Thermal load L = eta beta u^2/k at a mean speed of both surfaces.
    pub fn thermal_load(&self, speed: f64) -> f64 {
        self.eta * self.beta * speed * speed / self.conductivity
    }

    /// Factor of heating at the inlet on rolling friction according to Aihara.
    pub fn heating(&self, speed: f64) -> f64 {
        1.0 / (1.0 + 0.29 * self.thermal_load(speed).powf(0.78))
    }
}

/// Factor of a starved inlet on rolling friction, from the height of the oil at the inlet over the minimum film, at least 2.
pub fn starvation(height: f64) -> f64 {
    let square = height * height;
    (square + 162.8 * height) / (square + 193.1 * height + 1257.0)
}

/// A point contact that rolls.
#[derive(Debug, Clone, Copy)]
pub struct RollingPoint {
    /// Relative radius along the direction of rolling. \[m\]
    pub along: f64,
    /// Relative radius across it. \[m\]
    pub across: f64,
    /// E' = 2 E*. \[Pa\]
    pub modulus: f64,
    /// Complete elliptic integral of the second kind of the contact ellipse.
    pub second: f64,
}

impl RollingPoint {
    /// Rolling force of the flooded, cold contact under a load, at a mean speed of both surfaces. \[N\]
    pub fn force(&self, load: f64, ellipse: &Ellipse, eta: f64, speed: f64) -> f64 {
        let unit = self.modulus * self.along * self.along;
        let u = 2.0 * eta * speed / (self.modulus * self.along);
        let kappa = ellipse.along / ellipse.across;
        let b = 4.0 / PI * self.second / (1.0 + self.along / self.across);
        let m = b.powf(0.25) * kappa * (load / unit) / u.powf(0.75);
        let width = 2.0 * ellipse.across / self.along * unit;
        let isoviscous = 0.77 * b.powf(-1.0 / 3.0) * kappa.powf(0.12) * width * u.powf(2.0 / 3.0);
        let elastic = 1.8 * b.powf(-0.25) * width * u.powf(0.75);
        elastic + (isoviscous - elastic) / (1.0 + m / 6.6)
    }
}

/// A line contact that rolls.
#[derive(Debug, Clone, Copy)]
pub struct RollingLine {
    /// Relative radius. \[m\]
    pub radius: f64,
    /// Length. \[m\]
    pub length: f64,
    /// Diameter of the roller. \[m\]
    pub diameter: f64,
    /// E' = 2 E*. \[Pa\]
    pub modulus: f64,
}

impl RollingLine {
    /// Rolling moment about the axis of the roller, of both surfaces together, heated. \[Nm\]
    pub fn moment(&self, law: LineLaw, load: f64, oil: &InletOil, speed: f64) -> f64 {
        let Self {
            radius,
            length,
            diameter,
            modulus,
        } = *self;
        let w = load / (length * modulus * radius);
        let gu = oil.alpha * oil.eta * speed / radius;
        let unit = radius * radius / oil.alpha * length;
        match law {
            LineLaw::ZhouHoeprich => {
                let thermal = oil.thermal_load(speed);
                let pressure = (w / (2.0 * PI)).sqrt();
                let heating = (1.0 - 13.2 * pressure * thermal.powf(0.42)) / (1.0 + 0.213 * thermal.powf(0.64));
                58.4 * heating.max(0.0) * unit * gu.powf(0.648) * w.powf(0.246)
            }
            LineLaw::Aihara => {
                // His number of load has the radius of the roller, not the relative one.
                let w = 2.0 * load / (diameter * length * modulus);
                176.0 * oil.heating(speed) * unit * gu.powf(0.658) * w.powf(0.31)
            }
            LineLaw::BibouletHoupert => 2.0 * self.force(load, oil.eta, speed) * radius * oil.heating(speed),
        }
    }

    /// Rolling force of the flooded, cold contact according to Biboulet and Houpert. \[N\]
    pub fn force(&self, load: f64, eta: f64, speed: f64) -> f64 {
        let w = load / (self.length * self.modulus * self.radius);
        let u = 2.0 * eta * speed / (self.modulus * self.radius);
        let m = w / u.sqrt();
        let bend = (1.0 + (1.4 / 1.45 * m.sqrt()).powi(10)).powf(0.1);
        1.42 * (u * w).sqrt() / bend * self.modulus * self.radius * self.length
    }

    /// Half width of the contact under a load. \[m\]
    pub fn half_width(&self, load: f64) -> f64 {
        (8.0 * load * self.radius / (PI * self.length * self.modulus)).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearloss_framework::rolling::{Material, PointContact};
    use gearloss_framework::testing::assert_close;

    fn modulus() -> f64 {
        2.0 * Material::STEEL.contact_modulus(&Material::STEEL)
    }

    fn force(along: f64, across: f64, load: f64) -> f64 {
        let contact = PointContact::new(along, across, 0.5 * modulus());
        let point = RollingPoint {
            along,
            across,
            modulus: modulus(),
            second: contact.second_integral(),
        };
        point.force(load, &contact.under(load), 0.01275, 3.0)
    }

    /// Values of an independent implementation for both contacts of a 6308.
    #[test]
    fn points_of_a_6308() {
        for (load, inner, outer) in [
            (100.0, 0.079_492_368, 0.075_633_970),
            (1500.0, 0.177_677_97, 0.164_927_23),
        ] {
            assert_close(force(5.790_988e-3, 196.053e-3, load), inner, 1e-6);
            assert_close(force(9.290_012e-3, 133.2155e-3, load), outer, 1e-6);
        }
    }

    #[test]
    fn lines() {
        let line = RollingLine {
            radius: 6e-3,
            length: 20e-3,
            diameter: 17e-3,
            modulus: modulus(),
        };
        assert_close(line.force(1000.0, 0.02, 3.0), 1.156_661_7, 1e-7);
        assert_close(line.force(5.0, 0.02, 3.0), 0.155_553_21, 1e-7);
    }

    /// Moments of the raceways of a 32216 under 6 kN of thrust in an oil of 60.6 mm2/s, by an independent implementation.
    #[test]
    fn raceways_of_a_32216() {
        let (roller, outer_raceway, inner_raceway) = (17e-3, 62.54e-3, 45.961_5e-3);
        let oil = InletOil {
            eta: 60.592e-6 * 870.0,
            alpha: 2e-8,
            beta: 0.046_134_733,
            conductivity: 0.137,
        };
        let length = 22.7e-3;
        let moment = |law: LineLaw, rpm: f64| {
            let speed = rpm * PI / 30.0 * inner_raceway * outer_raceway / (inner_raceway + outer_raceway);
            let of = |radius: f64, load: f64| {
                let line = RollingLine {
                    radius,
                    length,
                    diameter: roller,
                    modulus: modulus(),
                };
                line.moment(law, load, &oil, speed)
            };
            let (inner, outer) = (of(7.195_942e-3, 1532.07), of(9.790_176e-3, 1531.86));
            16.0 * (outer_raceway * inner + inner_raceway * outer) / roller * 1e3
        };
        // The length of the rollers is only known to three digits.
        for (rpm, zhou_hoeprich, aihara, flooded) in [
            (500.0, 1525.694, 2057.693, 2752.616),
            (2000.0, 3296.916, 4428.224, 6699.264),
            (4000.0, 4290.548, 5380.380, 8512.811),
        ] {
            assert_close(moment(LineLaw::ZhouHoeprich, rpm), zhou_hoeprich, 3e-3);
            assert_close(moment(LineLaw::Aihara, rpm), aihara, 3e-3);
            assert_close(moment(LineLaw::BibouletHoupert, rpm), flooded, 3e-3);
        }
    }

    #[test]
    fn a_flooded_inlet_is_not_starved() {
        assert_close(starvation(8.890_285), 0.5, 1e-6);
        assert!(starvation(1e7) > 0.9999 && starvation(2.0) < 0.21);
    }
}
