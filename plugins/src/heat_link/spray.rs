//! Oil sprayed on a surface, such as the windings of a motor: limited by the heat capacity of the stream.
//!
//! Sources: stream along an isothermal wall, G = C (1 - exp(-alpha A/C)) with the heat capacity flow C of the stream, between the
//! wall and the arriving oil; textbooks. Coefficient of a jet from its size and speed according to Metzger, Cummings and Ruby, 5th Int.
//! Heat Transfer Conf. 1974, quoted from memory: St Pr^0.487 = 2.74 Re^-0.348 (L/d)^-0.774, St = alpha/(rho c v), Re = v d/nu.
//!
//! L is interpreted as the radius of the surface cooled by the jet, and d as the nozzle diameter.
//!
//! Jets and drops on windings have 500 to 2500 W/(m2 K) over the wetted part of the surface. Oil properties are taken at the mean
//! temperature of both nodes.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::heat_link::{HeatLink, HeatLinkAt, HeatLinkModel};
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use gearloss_framework::{observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::oil;
use crate::rotating::Fluid;

observed! {
    ALPHA = ("alpha", "W/(m2 K)", "heat transfer coefficient on the wetted surface");
    EFFECTIVENESS = ("eps", "-", "ratio of the heat removed to the maximum that the stream can remove");
}

/// A jet of oil.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct Jet {
    /// Diameter of the nozzle. [mm]
    #[schemars(range(min = 0.05, max = 100.0))]
    pub diameter: f64,
    /// Radius of the surface cooled by the jet, about the point of impact. [mm]
    #[schemars(range(min = 0.05, max = 1e4))]
    pub radius: f64,
    /// Velocity at the nozzle. [m/s]
    #[schemars(range(min = 0.01, max = 200.0))]
    pub speed: f64,
}

/// Oil sprayed on a surface, from the surface to the arriving oil.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Wetted area. [cm2]
    #[schemars(range(min = 0.01, max = 1e8))]
    pub area: f64,
    /// Share of the oil flow that reaches the surface. [-]
    #[serde(default = "default_share")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub share: f64,
    /// Nozzle of the oil network whose flow reaches the surface; default: the circulated oil flow of the thermal network.
    #[schemars(extend("x-refers-to" = "oil_network.nozzles"))]
    pub nozzle: Option<String>,
    /// Heat transfer coefficient, unless a `jet` is given. [W/(m2 K)]
    #[schemars(range(min = 0.1, max = 1e5))]
    pub alpha: Option<f64>,
    /// Jet that determines the coefficient.
    pub jet: Option<Jet>,
}

fn default_share() -> f64 {
    1.0
}

enum Coefficient {
    Stated(f64),
    Of(Jet),
}

struct Spray {
    area: f64,
    share: f64,
    coefficient: Coefficient,
}

impl Jet {
    /// Heat transfer coefficient. \[W/(m2 K)\]
    fn coefficient(&self, oil: &Fluid) -> f64 {
        let re = self.speed * self.diameter / oil.nu();
        let stanton = 2.74 * re.powf(-0.348) * (self.radius / self.diameter).powf(-0.774) * oil.prandtl().powf(-0.487);
        stanton * oil.density * oil.heat_capacity * self.speed
    }
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Spray, Diagnostic> {
    let coefficient = match (params.alpha, params.jet) {
        (Some(alpha), None) => Coefficient::Stated(alpha),
        (None, Some(jet)) => Coefficient::Of(jet),
        (None, None) => {
            return Err(cx
                .error("the link requires a heat transfer coefficient")
                .help("write `alpha: 1000 W/(m2 K)` or `jet: { diameter: 2 mm, radius: 10 mm, speed: 5 m/s }` with your values"));
        }
        (Some(_), Some(_)) => {
            return Err(cx
                .error("the heat transfer coefficient is stated twice")
                .help("write `alpha` or `jet`"));
        }
    };
    if let Some(nozzle) = &params.nozzle {
        cx.oil_element("nozzles", nozzle)?;
    }
    Ok(Spray {
        area: params.area,
        share: params.share,
        coefficient,
    })
}

impl HeatLinkModel for Spray {
    fn conductance(&self, at: &HeatLinkAt<'_>) -> Result<f64, Undefined> {
        let alpha = match &self.coefficient {
            Coefficient::Stated(alpha) => *alpha,
            Coefficient::Of(jet) => jet.coefficient(&oil(at)),
        };
        let alpha = at.observe(&ALPHA, alpha);
        let stream = at.show("C", "W/K", at.oil_flow * self.share * at.heat_capacity);
        if stream <= 0.0 {
            at.branch("no oil reaches the surface");
            return Ok(0.0);
        }
        let effectiveness = at.observe(&EFFECTIVENESS, -(-alpha * self.area / stream).exp_m1());
        Ok(at.show("G", "W/K", stream * effectiveness))
    }
}

register!(HeatLink, "spray", Params,
    source: "effectiveness of a stream, textbooks; Metzger, Cummings, Ruby 1974",
    example: "{ type: spray, area: 600 cm2, share: 0.5, alpha: 1000 W/(m2 K) }",
    evidence: [
        formula(Evidence::Derived, "stream derived; jet quoted from memory of one article, not checked"),
        default_of("share", Evidence::User, "all oil of the circuit reaches the surface"),
    ],
    observed: [ALPHA, EFFECTIVENESS], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::mechanism::heat_link::HeatLinkPart;

    use super::super::cases::{at, built};
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::close;

    const OIL: [f64; 4] = [0.14, 1e-5, 820.0, 2000.0];
    const JET: Jet = Jet {
        diameter: 2e-3,
        radius: 10e-3,
        speed: 5.0,
    };

    fn spray(alpha: Option<f64>, jet: Option<Jet>) -> Params {
        Params {
            area: 0.06,
            share: 0.5,
            nozzle: None,
            alpha,
            jet,
        }
    }

    fn link(params: Params, flow: f64) -> f64 {
        let part = HeatLinkPart::default();
        let here = at(&part, 0.0, OIL).with(|to| to.oil_flow = flow);
        built(prepare, params).unwrap().conductance(&here).unwrap()
    }

    /// C = 0.1 x 0.5 x 2000 = 100 W/K, alpha A = 60 W/K, by hand.
    #[test]
    fn a_stream_takes_no_more_than_its_heat_capacity() {
        close(link(spray(Some(1000.0), None), 0.1), 100.0 * (1.0 - (-0.6_f64).exp()));
        // Large flow: only the surface limits; small flow: the stream.
        close(link(spray(Some(1000.0), None), 1e7), 60.0);
        close(link(spray(Some(1000.0), None), 1e-4), 0.1);
        assert!(link(spray(Some(1000.0), None), 0.0).abs() < f64::MIN_POSITIVE);
    }

    /// Re = 1000, Pr = 117.143, L/d = 5: St = 2.74 / (11.066 x 3.4754 x 10.173), by hand.
    #[test]
    fn the_coefficient_of_a_jet_follows_from_its_speed() {
        let fluid = Fluid {
            conductivity: 0.14,
            eta: 8.2e-3,
            density: 820.0,
            heat_capacity: 2000.0,
        };
        let alpha = JET.coefficient(&fluid);
        let faster = Jet { speed: 10.0, ..JET };
        close(faster.coefficient(&fluid), alpha * 2.0_f64.powf(0.652));
        close(link(spray(None, Some(JET)), 0.1), link(spray(Some(alpha), None), 0.1));
        assert!((alpha / 57430.0 - 1.0).abs() < 2e-4, "{alpha}");
    }

    #[test]
    fn the_coefficient_is_stated_once() {
        let error = |params| built(prepare, params).err().unwrap();
        assert!(error(spray(None, None)).contains("jet: { diameter"));
        assert!(error(spray(Some(1.0), Some(JET))).contains("twice"));
    }
}
