//! Drag of open synchronizers: Couette flow in the gap between cones.
//!
//! Source: derived from laminar shear flow between two cones, Newtonian oil at oil temperature:
//! T = z phi pi eta dw (r2^4 - r1^4)/(2 h sin a). Mean diameter, width and half angle define the ends of the cone. Assumes the full
//! speed difference over one gap (a floating ring would halve it) and a gap filled by the share phi. Not for turbulent gaps: above
//! the stated Reynolds and Taylor numbers the drag is underpredicted.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::mechanism::synchronizer::{CouplingKind, Synchronizer};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Check, Evidence, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Film, REYNOLDS, SHEAR, TAYLOR};
use crate::checks::SIX_DIGITS;

/// Oil shear in the gap between the cones of an open synchronizer.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct ConeGap {}

fn prepare(_params: ConeGap, cx: &mut Build<'_>) -> Result<Film, Diagnostic> {
    let part = cx.own_part::<Synchronizer>()?;
    if part.kind != CouplingKind::Synchronizer {
        return Err(cx
            .error("cone_gap applies to synchronizers only")
            .help("write `model: { type: ring_gap }` for a ring or a dog clutch with a gap, `model: none` for a coupling without drag"));
    }
    let (Some(diameter), Some(width), Some(angle), Some(gap)) =
        (part.cone_diameter, part.cone_width, part.cone_angle, part.gap)
    else {
        return Err(cx
            .error("cone_gap requires `cone_diameter`, `cone_width`, `cone_angle` and `gap`")
            .help("add them to the coupling"));
    };
    let half = 0.5 * width * angle.tan();
    let (r1, r2) = (0.5 * diameter - half, 0.5 * diameter + half);
    if r1 < 0.0 {
        return Err(cx
            .error("the cone is too wide: its small end would have a negative radius")
            .help("correct `cone_diameter` (mean), `cone_width` (along the axis) or `cone_angle` (half angle)"));
    }
    Ok(Film {
        symbol: "T_cone",
        factor: part.oil_fill * f64::from(part.cones) * cone(r1, r2, angle, gap),
        radius: 0.5 * diameter,
        gap,
    })
}

/// Torque per viscosity and speed of one flooded cone between two radii. \[m3\]
fn cone(r1: f64, r2: f64, angle: f64, gap: f64) -> f64 {
    std::f64::consts::PI * (r2.powi(4) - r1.powi(4)) / (2.0 * gap * angle.sin())
}

register!(Synchronizer, "cone_gap", ConeGap,
    source: "derived: laminar Couette flow between cones",
    example: "{ type: cone_gap }",
    evidence: [formula(Evidence::Derived, "shear flow; the user states the filling of the gap")],
    checks: [
        Check {
            input: "{ part: { cone_diameter: 62 mm, cone_width: 17.5537747 mm, cone_angle: 6.5 deg, gap: 0.15 mm, oil_fill: 1 }, \
                    at: { speed: 2000 rpm, eta: 12 mPa s } }",
            values: &[("moment", "0.0554672 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ part: { cone_diameter: 62 mm, cone_width: 17.5537747 mm, cone_angle: 6.5 deg, gap: 0.15 mm, oil_fill: 0.3 }, \
                    at: { speed: 2000 rpm, eta: 12 mPa s } }",
            values: &[("moment", "0.0166402 Nm")],
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
    fn the_number_of_cones_multiplies() {
        let cones = |cones: u32| {
            let json = format!(
                r#"{{"kind":"synchronizer","cones":{cones},"cone_diameter":0.062,"cone_width":0.008,"cone_angle":0.113,"gap":1.5e-4}}"#
            );
            let part = part(&json);
            let model = build("cone_gap", &part).unwrap();
            let at = |speed| SynchronizerAt::usual(&part, Notes::MUTED).with(|to| to.speed = speed);
            assert_eq!(model.loss(&at(0.0)).unwrap().sum(), 0.0);
            assert_eq!(model.loss(&at(-100.0)).unwrap(), model.loss(&at(100.0)).unwrap());
            model.loss(&at(100.0)).unwrap().sum()
        };
        assert!(cones(1) > 0.0 && (cones(3) / cones(1) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_missing_or_of_another_kind_is_said() {
        assert!(
            build(
                "cone_gap",
                &part(r#"{"cone_diameter":0.062,"cone_width":0.008,"gap":1.5e-4}"#)
            )
            .err()
            .unwrap()
            .contains("cone_angle")
        );
        assert!(
            build("cone_gap", &part(r#"{"kind":"dog"}"#))
                .err()
                .unwrap()
                .contains("to synchronizers")
        );
        let wide = r#"{"cone_diameter":0.01,"cone_width":0.1,"cone_angle":0.5,"gap":1.5e-4}"#;
        assert!(
            build("cone_gap", &part(wide))
                .err()
                .unwrap()
                .contains("negative radius")
        );
    }
}
