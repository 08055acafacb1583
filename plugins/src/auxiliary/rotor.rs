//! Friction of a rotor in air, mist or oil: its cylindrical gap and both end faces.
//!
//! Sources: see `gap.rs` (Bilgen and Boulos 1973; Vrancik 1968) and `face.rs` (Daily and Nece 1960; von Karman). The air has the temperature
//! of the oil of the component and one atmosphere. Axial flow, eccentricity and pockets of magnets are not modelled.
//!
//! Do not use it if the loss map of the machine contains windage: it would be counted twice.

mod face;
mod gap;
mod medium;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::auxiliary::{Auxiliary, AuxiliaryAt, AuxiliaryModel};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{limits, observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

pub use face::free as free_disc;
pub use gap::Bore;
pub use medium::{Medium, MixtureViscosity};

use crate::checks::SIX_DIGITS;

terms! {
    GAP = no_load("gap");
    FACES = no_load("faces");
}
observed! { REYNOLDS = ("Re", "-", "Reynolds number of the gap"); }
limits! {
    SPEED = ("R w", "surface speed of the rotor", "m/s", 0.0, 100.0, "incompressible flow, Mach number below 0.3");
    TESTED = ("Re_gap", "Reynolds number of the gap", "-", 0.0, 1e5, "Bilgen and Boulos 1973, quoted from programs");
    OIL = ("a", "volume fraction of oil in droplets", "-", 0.0, 0.2, "assumed: droplets that do not touch");
}

/// A rotor in air, mist or oil: its cylindrical gap and both end faces.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Rotor {
    /// Radius of the rotor. [mm]
    #[schemars(range(min = 1.0, max = 1e4))]
    pub radius: f64,
    /// Radial gap to the bore. [mm]
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub gap: f64,
    /// Length of the gap. [mm]
    #[schemars(range(min = 1.0, max = 1e4))]
    pub length: f64,
    /// Surface of the bore: the law of slotted bores gives 1.5 to 4.1 times that of smooth ones.
    pub bore: Bore,
    /// Radius inside which the end faces are shaft. [mm]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub face_inner_radius: f64,
    /// Axial clearance of each end face to a wall; default: free discs. [mm]
    #[schemars(range(min = 0.1, max = 1e4))]
    pub face_clearance: Option<f64>,
    /// Volume fraction of oil in the air: 0 dry, 1 full of oil. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub oil_fraction: f64,
    /// Viscosity of the mixture.
    #[serde(default)]
    pub mixture_viscosity: MixtureViscosity,
    /// Factor on the torque of the gap, for a measured run-down or a band. [-]
    #[serde(default = "one")]
    #[schemars(range(min = 0.1, max = 10.0))]
    pub gap_factor: f64,
}

fn one() -> f64 {
    1.0
}

fn prepare(params: Rotor, cx: &mut Build<'_>) -> Result<Rotor, Diagnostic> {
    if params.gap > 0.3 * params.radius {
        return Err(cx
            .error("the gap is more than 0.3 of the rotor's radius; no law covers it")
            .help("check the units of `gap` and `radius`"));
    }
    if params.face_inner_radius >= params.radius {
        return Err(cx
            .error("`face_inner_radius` is not smaller than the rotor's radius")
            .help("state the radius of the shaft at the end faces"));
    }
    Ok(params)
}

impl AuxiliaryModel for Rotor {
    fn loss(&self, at: &AuxiliaryAt<'_>) -> Result<Loss, Undefined> {
        let speed = at.speed.abs();
        if speed == 0.0 {
            at.branch("at standstill: no torque");
            return Ok(Loss::MOMENTS);
        }
        if self.mixture_viscosity == MixtureViscosity::Droplets && self.oil_fraction < 1.0 {
            at.check(&OIL, self.oil_fraction);
        }
        let oil = Medium {
            rho: at.rho,
            mu: at.eta,
        };
        let Medium { rho, mu } = Medium::new(at.temperature, oil, self.oil_fraction, self.mixture_viscosity);
        at.show("rho", "kg/m3", rho);
        at.show("mu", "mPa s", mu.mpa_s());
        let (radius, gap) = (self.radius, self.gap);
        at.check(&SPEED, speed * radius);
        let re = at.observe(&REYNOLDS, rho * speed * radius * gap / mu);
        at.check(&TESTED, re);
        let c_gap = at.show("C_gap", "-", gap::moment_coefficient(self.bore, re, gap / radius));
        let pressure = rho * speed * speed;
        let in_gap = 0.5 * std::f64::consts::PI * c_gap * pressure * radius.powi(4) * self.length * self.gap_factor;
        let re_disc = at.show("Re_disc", "-", rho * speed * radius * radius / mu);
        let c_faces = match self.face_clearance {
            Some(clearance) => face::enclosed(re_disc, clearance / radius),
            None => face::free(re_disc),
        };
        let at_faces =
            0.5 * at.show("C_faces", "-", c_faces) * pressure * (radius.powi(5) - self.face_inner_radius.powi(5));
        Ok(Loss::MOMENTS.with(&GAP, in_gap).with(&FACES, at_faces))
    }
}

register!(Auxiliary, "rotor", Rotor,
    source: "Bilgen, Boulos, J. Fluids Eng. 95 (1973) 122-126; Vrancik, NASA TN D-4849 (1968); Daily, Nece, J. Basic Eng. 82 (1960) 217-232",
    example: "{ type: rotor, radius: 75 mm, gap: 0.8 mm, length: 134 mm, bore: slotted, face_clearance: 7.5 mm }",
    evidence: [
        formula(Evidence::Disputed, "the laws of smooth and slotted bores differ by 1.5 to 4.1 times; each is quoted alike by several programs"),
        default_of("face_inner_radius", Evidence::Assumed, "whole faces: the torque is at the rim"),
        default_of("face_clearance", Evidence::Assumed, "no wall near the faces"),
        default_of("oil_fraction", Evidence::Assumed, "dry air; 1 % of oil multiplies the loss by 4 to 9"),
        default_of("mixture_viscosity", Evidence::Disputed, "between the two other rules, whose losses differ by two to three times"),
        default_of("gap_factor", Evidence::Disputed, "the laws as published"),
    ],
    checks: [
        Check {
            input: "{ model: { type: rotor, radius: 75 mm, gap: 0.8 mm, length: 134 mm, bore: smooth, face_clearance: 7.5 mm }, \
                    at: { speed: 3000 rpm, temperature: 80 degC, eta: 8 mPa s, rho: 820 } }",
            values: &[("gap", "1.81223 W"), ("faces", "0.371528 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: rotor, radius: 75 mm, gap: 0.8 mm, length: 134 mm, bore: slotted }, \
                    at: { speed: 12000 rpm, temperature: 80 degC, eta: 8 mPa s, rho: 820 } }",
            values: &[("gap", "180.068 W"), ("faces", "26.9248 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: rotor, radius: 75 mm, gap: 0.8 mm, length: 134 mm, bore: smooth }, \
                    at: { speed: 500 rpm, temperature: 80 degC, eta: 8 mPa s, rho: 820 } }",
            values: &[("gap", "0.0258155 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: rotor, radius: 75 mm, gap: 0.8 mm, length: 134 mm, bore: smooth, face_clearance: 7.5 mm }, \
                    at: { speed: 12000 rpm, temperature: 80 degC, eta: 8 mPa s, rho: 820 } }",
            values: &[("gap", "57.9915 W"), ("faces", "14.9417 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: rotor, radius: 75 mm, gap: 0.8 mm, length: 134 mm, bore: slotted, face_clearance: 7.5 mm }, \
                    at: { speed: 18000 rpm, temperature: 80 degC, eta: 8 mPa s, rho: 820 } }",
            values: &[("gap", "549.333 W"), ("faces", "46.5002 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: rotor, radius: 75 mm, gap: 0.8 mm, length: 134 mm, bore: smooth }, \
                    at: { speed: 18000 rpm, temperature: 80 degC, eta: 8 mPa s, rho: 820 } }",
            values: &[("gap", "159.806 W"), ("faces", "83.7930 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: rotor, radius: 75 mm, gap: 0.8 mm, length: 134 mm, bore: slotted }, \
                    at: { speed: 3000 rpm, temperature: 80 degC, eta: 8 mPa s, rho: 820 } }",
            values: &[("gap", "4.12754 W"), ("faces", "0.489216 W")],
            ..SIX_DIGITS
        },
        // 1 % of oil, by the three rules of viscosity.
        Check {
            input: "{ model: { type: rotor, radius: 75 mm, gap: 0.8 mm, length: 134 mm, bore: smooth, oil_fraction: 0.01 }, \
                    at: { speed: 12000 rpm, temperature: 80 degC, eta: 8 mPa s, rho: 820 } }",
            values: &[("gap", "386.1 W")],
            tolerance: 2e-4,
            because: "the values have four digits",
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: rotor, radius: 75 mm, gap: 0.8 mm, length: 134 mm, bore: smooth, oil_fraction: 0.01, mixture_viscosity: droplets }, \
                    at: { speed: 12000 rpm, temperature: 80 degC, eta: 8 mPa s, rho: 820 } }",
            values: &[("gap", "253.3 W")],
            tolerance: 2e-4,
            because: "the values have four digits",
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: rotor, radius: 75 mm, gap: 0.8 mm, length: 134 mm, bore: smooth, oil_fraction: 0.01, mixture_viscosity: mass }, \
                    at: { speed: 12000 rpm, temperature: 80 degC, eta: 8 mPa s, rho: 820 } }",
            values: &[("gap", "530.1 W")],
            tolerance: 2e-4,
            because: "the values have four digits",
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: rotor, radius: 75 mm, gap: 0.8 mm, length: 134 mm, bore: smooth, oil_fraction: 0.05 }, \
                    at: { speed: 12000 rpm, temperature: 80 degC, eta: 8 mPa s, rho: 820 } }",
            values: &[("gap", "1684.9 W")],
            tolerance: 2e-4,
            because: "the values have four or five digits",
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: rotor, radius: 75 mm, gap: 0.8 mm, length: 134 mm, bore: smooth, oil_fraction: 0.2, mixture_viscosity: mass }, \
                    at: { speed: 12000 rpm, temperature: 80 degC, eta: 8 mPa s, rho: 820 } }",
            values: &[("gap", "8628 W")],
            tolerance: 2e-4,
            because: "the values have four or five digits",
            ..SIX_DIGITS
        },
    ],
    limits: [SPEED, TESTED, OIL], terms: [GAP, FACES], observed: [REYNOLDS], prepare: prepare);
