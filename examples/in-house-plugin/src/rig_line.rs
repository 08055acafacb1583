//! Two terms over the mean diameter, fitted to measurements of the manufacturer's rig.

use gearloss_framework::prelude::*;

terms! {
    VISCOUS = no_load("viscous");
    LOADED = load("loaded");
}
limits! { SPEED = ("n", "speed of the shaft", "1/min", 200.0, 9000.0, "speeds on the rig"); }

coefficients! {
    /// Constants of the curve fitted to the points of the rig.
    struct Constants {
        /// Exponent of viscosity in mm2/s times speed in 1/min; 0.6 to 0.75 on single bearings of the rig.
        speed_exponent = 2.0 / 3.0, in 0.6..=0.75;
    }
}

/// Friction of ball bearings as measured on the rig: a viscous term and a load-dependent term.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct RigLine {
    /// Coefficient of the viscous term. [-]
    #[serde(default = "viscous")]
    #[schemars(range(min = 0.0, max = 20.0))]
    pub viscous: f64,
    /// Coefficient of the load-dependent term. [-]
    #[schemars(range(min = 0.0, max = 0.01))]
    pub loaded: f64,
    #[serde(default)]
    coefficients: Constants,
}

fn viscous() -> f64 {
    1.4
}

impl BearingModel for RigLine {
    fn loss(&self, at: &BearingAt<'_>) -> Result<Loss, Undefined> {
        let n = at.check(&SPEED, at.speed.abs().rpm());
        let d_m = at.show("d_m", "mm", at.part.mean_diameter().mm());
        let m_0 = at.show(
            "M_0",
            "N mm",
            1e-7 * self.viscous * (at.nu.mm2_s() * n).powf(self.coefficients.speed_exponent) * d_m.powi(3),
        );
        let m_1 = at.show("M_1", "N mm", self.loaded * at.radial * d_m);
        Ok(Loss::MOMENTS
            .with(&VISCOUS, m_0.nmm_in_nm())
            .with(&LOADED, m_1.nmm_in_nm()))
    }
}

register!(Bearing, "rig_line", RigLine,
    source: "rig report 21, 2024",
    example: "{ type: rig_line, loaded: 3e-4 }",
    evidence: [formula(Evidence::OneSource, "40 points on four bearings"), default_of("viscous", Evidence::OneSource, "their mean")],
    checks: [
        Check {
            input: "{ model: { type: rig_line, viscous: 2, loaded: 3e-4 }, part: { kind: deep_groove_ball, bore: 40 mm, outside: 80 mm }, \
                    at: { nu: 32 mm2/s, speed: 1500 rpm, radial: 1 kN } }",
            values: &[("M_0", "57.057 N mm"), ("M_1", "18 N mm"), ("moment", "0.075057 Nm")],
            tolerance: 1e-5,
            because: "five digits",
            source: "by hand for a 6208: 2e-7 (32 1500)^(2/3) 60^3 and 3e-4 1000 60",
        },
    ],
    limits: [SPEED], terms: [VISCOUS, LOADED]);
