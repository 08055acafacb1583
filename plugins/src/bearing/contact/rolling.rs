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

    /// Factor of heating at the inlet according to Zhou and Hoeprich for pure rolling, from the maximum pressure over E'; negative beyond its range.
    fn heating_of_zhou_hoeprich(&self, pressure: f64, speed: f64) -> f64 {
        let thermal = self.thermal_load(speed);
        (1.0 - 13.2 * pressure * thermal.powf(0.42)) / (1.0 + 0.213 * thermal.powf(0.64))
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

/// Rolling forces of a flooded, cold point contact.
#[derive(Debug, Clone, Copy)]
struct Regimes {
    /// Of rigid bodies and a constant viscosity. \[N\]
    isoviscous: f64,
    /// Of bodies that the film deforms. \[N\]
    elastic: f64,
    /// M, which decides between the two.
    load_number: f64,
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
        let Regimes {
            isoviscous,
            elastic,
            load_number,
        } = self.regimes(load, ellipse, eta, speed);
        elastic + (isoviscous - elastic) / (1.0 + load_number / 6.6)
    }

    fn regimes(&self, load: f64, ellipse: &Ellipse, eta: f64, speed: f64) -> Regimes {
        let unit = self.modulus * self.along * self.along;
        let u = 2.0 * eta * speed / (self.modulus * self.along);
        let kappa = ellipse.along / ellipse.across;
        let b = 4.0 / PI * self.second / (1.0 + self.along / self.across);
        let width = 2.0 * ellipse.across / self.along * unit;
        Regimes {
            isoviscous: 0.77 * b.powf(-1.0 / 3.0) * kappa.powf(0.12) * width * u.powf(2.0 / 3.0),
            elastic: 1.8 * b.powf(-0.25) * width * u.powf(0.75),
            load_number: b.powf(0.25) * kappa * (load / unit) / u.powf(0.75),
        }
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
        let gu = oil.alpha * oil.eta * speed / radius;
        let unit = radius * radius / oil.alpha * length;
        match law {
            LineLaw::ZhouHoeprich => {
                let heating = self.heating_of_zhou_hoeprich(load, oil, speed).max(0.0);
                58.4 * heating * unit * gu.powf(0.648) * self.load_number(load).powf(0.246)
            }
            LineLaw::Aihara => {
                // His load number has the radius of the roller, not the relative one.
                let w = 2.0 * load / (diameter * length * modulus);
                176.0 * oil.heating(speed) * unit * gu.powf(0.658) * w.powf(0.31)
            }
            LineLaw::BibouletHoupert => 2.0 * self.force(load, oil.eta, speed) * radius * oil.heating(speed),
        }
    }

    /// Factor of heating at the inlet according to Zhou and Hoeprich; negative beyond its range, where the moment takes zero.
    pub fn heating_of_zhou_hoeprich(&self, load: f64, oil: &InletOil, speed: f64) -> f64 {
        let pressure = (self.load_number(load) / (2.0 * PI)).sqrt();
        oil.heating_of_zhou_hoeprich(pressure, speed)
    }

    /// Load number W.
    fn load_number(&self, load: f64) -> f64 {
        load / (self.length * self.modulus * self.radius)
    }

    /// Rolling force of the flooded, cold contact according to Biboulet and Houpert. \[N\]
    pub fn force(&self, load: f64, eta: f64, speed: f64) -> f64 {
        let [u, w, m] = self.numbers(load, eta, speed);
        let bend = (1.0 + (1.4 / 1.45 * m.sqrt()).powi(10)).powf(0.1);
        1.42 * (u * w).sqrt() / bend * self.modulus * self.radius * self.length
    }

    /// Their speed number U, load number W, and M = W/sqrt(U).
    fn numbers(&self, load: f64, eta: f64, speed: f64) -> [f64; 3] {
        let w = self.load_number(load);
        let u = 2.0 * eta * speed / (self.modulus * self.radius);
        [u, w, w / u.sqrt()]
    }

    /// Half width of the contact under a load. \[m\]
    pub fn half_width(&self, load: f64) -> f64 {
        (8.0 * load * self.radius / (PI * self.length * self.modulus)).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearloss_framework::rolling::{BallGeometry, Balls, Material};
    use gearloss_framework::testing::assert_close;

    fn modulus() -> f64 {
        2.0 * Material::STEEL.contact_modulus(&Material::STEEL)
    }

    /// The contact of a ball of 15.081 mm on 65 mm with a ring under a load, its rolling force and what it consists of.
    fn rolling(balls: Material, ring: usize, load: f64) -> (f64, Regimes) {
        let geometry = BallGeometry {
            number: 8,
            diameter: 15.081e-3,
            pitch_diameter: 65e-3,
            conformity: [0.52, 0.53],
            contact_angle: 0.0,
            clearance: 0.0,
            balls,
            rings: Material::STEEL,
        };
        let contact = Balls::new(geometry).contacts()[ring];
        let [along, across] = geometry.radii(ring, 1.0);
        let point = RollingPoint {
            along,
            across,
            modulus: 2.0 * balls.contact_modulus(&Material::STEEL),
            second: contact.second_integral(),
        };
        let (ellipse, eta, speed) = (contact.under(load), 0.01275, 3.0);
        (
            point.force(load, &ellipse, eta, speed),
            point.regimes(load, &ellipse, eta, speed),
        )
    }

    /// Values of an independent implementation for both contacts of a 6308.
    #[test]
    fn points_of_a_6308() {
        for (load, [isoviscous, elastic, load_number], inner, outer) in [
            (
                100.0,
                [0.163_269_07, 0.071_461_932, 68.853_824],
                0.079_492_368,
                0.075_633_970,
            ),
            (
                1500.0,
                [0.402_656_15, 0.176_240_28, 1032.8074],
                0.177_677_97,
                0.164_927_23,
            ),
        ] {
            let (force, regimes) = rolling(Material::STEEL, 0, load);
            assert_close(regimes.isoviscous, isoviscous, 5e-8);
            assert_close(regimes.elastic, elastic, 5e-8);
            assert_close(regimes.load_number, load_number, 5e-8);
            assert_close(force, inner, 5e-8);
            assert_close(rolling(Material::STEEL, 1, load).0, outer, 5e-8);
        }
        assert_close(rolling(Material::SILICON_NITRIDE, 0, 1500.0).0, 0.175_33, 3e-5);
    }

    #[test]
    fn lines() {
        let line = RollingLine {
            radius: 6e-3,
            length: 20e-3,
            diameter: 17e-3,
            modulus: modulus(),
        };
        for (load, [u, w, m], force) in [
            (1000.0, [8.666_666_7e-11, 3.611_111_1e-5, 3.878_955_6], 1.156_661_7),
            (5.0, [8.666_666_7e-11, 1.805_555_56e-7, 0.019_394_778], 0.155_553_21),
        ] {
            let found = line.numbers(load, 0.02, 3.0);
            for (found, expected) in found.into_iter().zip([u, w, m]) {
                assert_close(found, expected, 5e-8);
            }
            assert_close(line.force(load, 0.02, 3.0), force, 5e-8);
        }
    }

    /// Both raceways of a 32216 under 6 kN of thrust, by an independent implementation: sixteen rollers of 17 mm by 22.7 mm with the load of the
    /// outer raceway. The viscosity is printed as 60.592 mm2/s; 60.5926 is what its printed M and forces imply.
    #[test]
    fn raceways_of_a_32216() {
        let load = 1_531.864_298;
        let lines = [7.195_942e-3, 9.790_176e-3].map(|radius| RollingLine {
            radius,
            length: 22.7e-3,
            diameter: 17e-3,
            modulus: modulus(),
        });
        let oil = InletOil {
            eta: 60.5926e-6 * 870.0,
            alpha: 2e-8,
            beta: 0.046_134_733,
            conductivity: 0.137,
        };
        let speed = |rpm: f64| 5.548_463_580 * rpm / 2000.0;
        for (line, m, force) in [
            (lines[0], 2.165_163_5, 4.494_688_280),
            (lines[1], 1.856_262_1, 4.838_271_957),
        ] {
            assert_close(line.numbers(load, oil.eta, speed(2000.0))[2], m, 1e-6);
            assert_close(line.force(load, oil.eta, speed(2000.0)), force, 1e-6);
        }
        let moment = |law: LineLaw, oil: &InletOil, rpm: f64| {
            let power = lines.map(|line| line.moment(law, load, oil, speed(rpm)) * speed(rpm) / line.radius);
            16.0 * (power[0] + power[1]) / (rpm * PI / 30.0) * 1e3
        };
        let cold = InletOil { beta: 0.0, ..oil };
        for (rpm, thermal, zhou_hoeprich, aihara, flooded, flooded_cold) in [
            (500.0, 0.969_250, 1525.694, 2057.693, 2752.616, 2809.9),
            (2000.0, 0.854_092, 3296.916, 4428.224, 6699.264, 7911.9),
            (4000.0, 0.710_415, 4290.548, 5380.380, 8512.811, 13_056.0),
        ] {
            assert_close(
                oil.heating_of_zhou_hoeprich(503.15e6 / modulus(), speed(rpm)),
                thermal,
                1e-6,
            );
            assert_close(moment(LineLaw::ZhouHoeprich, &oil, rpm), zhou_hoeprich, 3e-7);
            assert_close(moment(LineLaw::Aihara, &oil, rpm), aihara, 3e-7);
            assert_close(moment(LineLaw::BibouletHoupert, &oil, rpm), flooded, 3e-7);
            assert_close(moment(LineLaw::BibouletHoupert, &cold, rpm), flooded_cold, 4e-5);
        }
    }

    #[test]
    fn a_flooded_inlet_is_not_starved() {
        assert_close(starvation(8.890_285), 0.5, 1e-6);
        assert!(starvation(1e7) > 0.9999 && starvation(2.0) < 0.21);
    }
}
