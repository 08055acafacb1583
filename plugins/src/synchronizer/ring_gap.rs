//! Drag of a cylindrical gap: an idler gear on a plain shaft, a bush, the ring of a dog clutch.
//!
//! Source: derived from laminar shear flow between cylinders: T = phi 2 pi eta dw r^3 L/h (Petroff).
//! Assumes concentric cylinders, the full speed difference over one gap, and a gap filled by the share phi. A cone is treated as a
//! cylinder with its mean radius and slant length, about 0.1 % below the cone itself; the drag of several cones adds up.
//! Not for turbulent gaps.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::mechanism::synchronizer::Synchronizer;
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Check, Evidence, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Film, REYNOLDS, SHEAR, TAYLOR};
use crate::checks::SIX_DIGITS;

/// Oil shear in a cylindrical gap.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct RingGap {}

fn prepare(_params: RingGap, cx: &mut Build<'_>) -> Result<Film, Diagnostic> {
    let part = cx.own_part::<Synchronizer>()?;
    let (Some(diameter), Some(length), Some(gap)) = (part.cone_diameter, part.cone_width, part.gap) else {
        return Err(cx
            .error("ring_gap requires `cone_diameter` (of the gap), `cone_width` (its length) and `gap`")
            .help("add them to the coupling"));
    };
    let slant = length / part.cone_angle.unwrap_or(0.0).cos();
    let factor = part.oil_fill * f64::from(part.cones) * ring(0.5 * diameter, slant, gap);
    Ok(Film {
        symbol: "T_ring",
        factor,
        radius: 0.5 * diameter,
        gap,
    })
}

/// Torque per viscosity and speed of a flooded ring. \[m3\]
fn ring(radius: f64, length: f64, gap: f64) -> f64 {
    2.0 * std::f64::consts::PI * radius.powi(3) * length / gap
}

register!(Synchronizer, "ring_gap", RingGap,
    source: "Petroff 1883; derived: laminar Couette flow between cylinders",
    example: "{ type: ring_gap }",
    evidence: [formula(Evidence::Derived, "shear flow; the user states the filling of the gap")],
    checks: [
        Check {
            input: "{ part: { kind: ring, cone_diameter: 60 mm, cone_width: 40 mm, gap: 0.5 mm }, at: { speed: 3000 rpm, \
                    eta: 10 mPa s } }",
            values: &[("moment", "0.0426367 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ part: { cone_diameter: 62 mm, cone_width: 17.5537747 mm, cone_angle: 6.5 deg, gap: 0.15 mm, cones: 2, \
                    oil_fill: 0.5 }, at: { speed: 2000 rpm, eta: 12 mPa s } }",
            values: &[("moment", "0.0554096 Nm")],
            ..SIX_DIGITS
        },
    ],
    limits: [REYNOLDS, TAYLOR], terms: [SHEAR], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::synchronizer::SynchronizerAt;

    use crate::synchronizer::cases::{build, part};

    #[test]
    fn drag_is_linear_in_speed_and_filling() {
        let loss = |fill: f64, speed: f64| {
            let json =
                format!(r#"{{"kind":"ring","cone_diameter":0.06,"cone_width":0.04,"gap":5e-4,"oil_fill":{fill}}}"#);
            let part = part(&json);
            let at = SynchronizerAt::usual(&part, Notes::MUTED).with(|to| to.speed = speed);
            build("ring_gap", &part).unwrap().loss(&at).unwrap().sum()
        };
        assert_eq!((loss(1.0, 0.0), loss(0.0, 100.0)), (0.0, 0.0));
        assert!((loss(0.5, 200.0) / loss(1.0, 100.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_gap_is_asked_for() {
        assert!(
            build("ring_gap", &part(r#"{"kind":"dog"}"#))
                .err()
                .unwrap()
                .contains("gap")
        );
    }
}
