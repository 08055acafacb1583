//! A power of the load over the mean diameter, written once for one point and for several points of a map together.

use gearloss_framework::prelude::*;

terms! { LOADED = load("loaded"); }
limits! { LOAD = ("P_0", "load", "N", 100.0, 20000.0, "loads on the rig"); }

/// Friction of ball bearings under load as measured on the rig: a power of the equivalent static load P_0 according to ISO 76.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct RigPower {
    /// Moment at a load of 1 N, in N mm per mm of mean diameter. [-]
    #[schemars(range(min = 0.0, max = 0.01))]
    pub factor: f64,
    /// Exponent of the load in N. [-]
    #[serde(default = "exponent")]
    #[schemars(range(min = 0.5, max = 2.0))]
    pub exponent: f64,
}

fn exponent() -> f64 {
    1.5
}

impl BearingLaw for RigPower {
    #[inline(always)]
    fn loss<R: Real>(&self, at: &BearingAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let d_m = at.part.mean_diameter().mm();
        let combined = at.radial * 0.6 + at.axial * 0.5;
        let p_0 = at.check(&LOAD, at.show("P_0", "N", at.radial.max(combined)));
        let m_1 = at.show("M_1", "N mm", p_0.power(self.exponent) * (self.factor * d_m));
        Ok(Loss::MOMENTS.with(&LOADED, m_1.nmm_in_nm()))
    }
}

register!(Bearing, "rig_power", RigPower,
    source: "rig report 22, 2025",
    example: "{ type: rig_power, factor: 1e-5 }",
    evidence: [formula(Evidence::OneSource, "12 loads on two bearings"), default_of("exponent", Evidence::OneSource, "their mean")],
    limits: [LOAD], terms: [LOADED]);

#[cfg(test)]
mod tests {
    use gearloss_framework::testing::{assert_close, eval};

    /// d = 40 mm, D = 80 mm: d_m = 60 mm; calculated by hand.
    #[test]
    fn the_moment_of_a_6208_under_both_loads() {
        let input = "
            model: { type: rig_power, factor: 1e-5 }
            part: { kind: deep_groove_ball, bore: 40 mm, outside: 80 mm }
            at: { radial: 1 kN, axial: 2 kN }
        ";
        let answer = eval("bearing/rig_power", input);
        // 0.6 of 1000 N and 0.5 of 2000 N; 1600^1.5 = 64000, times 1e-5 and 60 mm.
        assert_close(answer.step("P_0").unwrap(), 1600.0, 1e-12);
        assert_close(answer.moment.unwrap(), 0.0384, 1e-12);
    }
}
