//! Rolling bearings according to the Schaeffler catalogue (INA, FAG): Palmgren's form with its own factors.
//!
//! Source: Schaeffler, Wälzlager HR 1, quoted from memory; f0 as used for the thermal reference speed of ISO 15312: one column for grease or
//! mist, one for an oil bath or circulation. Deep groove f1 = 0.0005 to 0.0009 (P0/C0)^0.5 with P1 = 3.3 Fa - 0.1 Fr. Needle roller
//! bearings have a quarter of the f1 of SKF 1994, which is disputed. Axial load on the flanges of cylindrical rollers uses the f2
//! of SKF 1994.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::mechanism::bearing::{Bearing, BearingKind, BearingPart, Lubrication};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::palmgren::{self, AXIAL_RATIO, Constants, F0, LOAD, NO_LOAD, P1, Palmgren, RADIAL_RATIO};
use super::rows::{self, Lack, LoadLaw, Rule};
use crate::checks::SIX_DIGITS;

/// Rolling bearings after the catalogue of Schaeffler, in Palmgren's form.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Factor f0 of the load-independent moment; default: by kind, series and lubrication. [-]
    #[schemars(range(min = 0.0, max = 50.0))]
    pub f0: Option<f64>,
    /// Factor z of f1 = z (P0/C0)^y of ball bearings, or f1 itself; default: by kind and series. [-]
    #[schemars(range(min = 0.0, max = 0.1))]
    pub f1: Option<f64>,
    #[serde(default)]
    coefficients: Constants,
}

/// f0 for grease or mist and for oil, and the load law.
struct Row {
    f0: [f64; 2],
    law: LoadLaw,
}

fn row(part: &BearingPart) -> Result<Row, Lack> {
    use BearingKind as K;
    let series = part.series.as_deref().unwrap_or("").trim();
    let none = || {
        (
            if series.is_empty() {
                "schaeffler has no row for this kind of bearing without `series`".to_owned()
            } else {
                format!("schaeffler has no row for this kind of bearing with series `{series}`")
            },
            "write `series` as in the catalogue, or give the bearing its own model".to_owned(),
        )
    };
    let need = |value: Option<f64>, key: &str| {
        value.ok_or_else(|| {
            (
                format!("`{key}` is needed for this kind of bearing"),
                format!("add `{key}:` from the catalogue"),
            )
        })
    };
    let deep = |f0, z| Row {
        f0,
        law: LoadLaw::new(z, 0.5, Rule::DeepGroove { k: 3.3 }),
    };
    let y0 = || need(part.y0, "y0");
    let angular = |f0| -> Result<Row, Lack> {
        Ok(Row {
            f0,
            law: LoadLaw::new(0.001, 0.33, Rule::Angular { y0: y0()? }),
        })
    };
    let two_rows = |f0| -> Result<Row, Lack> {
        Ok(Row {
            f0,
            law: LoadLaw::new(0.001, 0.33, Rule::TwoRows { k: 1.4, y0: y0()? }),
        })
    };
    let four = |f0| Row {
        f0,
        law: LoadLaw::new(0.001, 0.33, Rule::FourPoint),
    };
    let roller = |f0, f1| Row {
        f0,
        law: LoadLaw::new(f1, 0.0, Rule::Radial),
    };
    let y = || need(part.y, "y");
    let tapered = |f0| -> Result<Row, Lack> {
        Ok(Row {
            f0,
            law: LoadLaw::new(0.0004, 0.0, Rule::Tapered { y: y()? }),
        })
    };
    Ok(match (part.kind, series) {
        (K::DeepGrooveBall, "618") => deep([1.1, 1.7], 0.0005),
        (K::DeepGrooveBall, "619" | "160" | "60") => deep([1.1, 1.7], 0.0007),
        (K::DeepGrooveBall, "2" | "62" | "622") => deep([1.3, 2.0], 0.0009),
        (K::DeepGrooveBall, "3" | "63" | "623" | "64") => deep([1.5, 2.3], 0.0009),
        (K::DeepGrooveBallDoubleRow, "42" | "42B") => deep([2.3, 3.5], 0.0010),
        (K::DeepGrooveBallDoubleRow, "43" | "43B") => deep([4.0, 6.0], 0.0010),
        (K::AngularContactBall, s) if s.starts_with("73") => angular([2.0, 3.0])?,
        (K::AngularContactBall, s) if s.starts_with("70") || s.starts_with("72") => angular([1.3, 2.0])?,
        (K::AngularContactBallDoubleRow, s) if s.starts_with("33") => two_rows([4.0, 6.0])?,
        (K::AngularContactBallDoubleRow, s) if s.starts_with("30") || s.starts_with("32") => two_rows([2.3, 3.5])?,
        (K::FourPointContactBall, "QJ3") => four([2.0, 3.0]),
        (K::FourPointContactBall, "QJ2") => four([1.3, 2.0]),
        (K::CylindricalRoller, "10") => roller([1.3, 2.0], 0.0002),
        (K::CylindricalRoller, "2") => roller([1.3, 2.0], 0.0003),
        (K::CylindricalRoller, "3") => roller([1.3, 2.0], 0.00035),
        (K::CylindricalRoller, "4") => roller([1.3, 2.0], 0.0004),
        (K::CylindricalRoller, "22") => roller([2.0, 3.0], 0.0004),
        (K::CylindricalRoller, "23") => roller([2.7, 4.0], 0.0004),
        (K::TaperedRoller, "302" | "303" | "320" | "320 X" | "329" | "330") => tapered([2.0, 3.0])?,
        (K::TaperedRoller, "313" | "313 (X)" | "322" | "322 B" | "323" | "323 B" | "331" | "332") => {
            tapered([3.0, 4.5])?
        }
        (K::NeedleCage, "NA69") => roller([7.0, 10.0], 0.0005),
        (K::NeedleCage, _) => roller([3.5, 5.25], 0.0005),
        _ => return Err(none()),
    })
}

impl Params {
    fn model(&self, part: &BearingPart) -> Result<Palmgren, Lack> {
        let mut row = row(part)?;
        row.law.z = self.f1.unwrap_or(row.law.z);
        let oil = matches!(part.lubrication, Lubrication::Bath | Lubrication::Jet);
        let f0 = self.f0.unwrap_or(row.f0[usize::from(oil)]);
        Palmgren::new(part, F0::Fixed(f0), row.law, rows::f2(part), self.coefficients)
    }
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Palmgren, Diagnostic> {
    palmgren::of_part(cx, |part| params.model(part))
}

register!(Bearing, "schaeffler", Params,
    source: "Schaeffler (INA, FAG), Wälzlager HR 1; ISO 15312",
    example: "{ type: schaeffler }",
    evidence: [
        formula(Evidence::OneSource, "one program uses the same form and one f1"),
        default_of("f0", Evidence::Recalled, "table quoted from memory, not checked; middle of a range for needle roller bearings"),
        default_of("f1", Evidence::Disputed, "three published variants for deep groove balls; factors for needle roller bearings differ by four"),
    ],
    checks: [
        Check {
            input: "{ part: { kind: deep_groove_ball, series: '63', bore: 40 mm, outside: 90 mm, c0: 24000 N }, at: { speed: 3000 rpm, \
                    nu: 15 mm2/s, radial: 3000 N, axial: 1000 N, oil_height: 0 mm } }",
            values: &[("M0", "79.9116 N mm"), ("M1", "62.0486 N mm"), ("total", "44.5981 W")],
            ..SIX_DIGITS
        },
    ],
    limits: [AXIAL_RATIO, RADIAL_RATIO], terms: [LOAD, NO_LOAD], observed: [P1], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::bearing::testing::part;
    use gearloss_framework::mechanism::bearing::BearingEntry;

    #[test]
    fn kinds_without_a_row_say_what_to_give() {
        let part = part(BearingKind::SphericalRoller, "222", 40.0, 90.0, None);
        assert!(
            Params {
                coefficients: Constants::PUBLISHED,
                f0: None,
                f1: None
            }
            .model(&part)
            .unwrap_err()
            .1
            .contains("series")
        );
    }

    #[test]
    fn every_factor_is_that_of_the_catalogue() {
        use BearingKind as K;
        let table = crate::printed::Printed::read(include_str!("../../tests/tables/schaeffler.csv"));
        for line in table.rows() {
            let series = line.text("series");
            let kind = match (line.text("type"), series) {
                ("deep_groove", "42" | "43") => K::DeepGrooveBallDoubleRow,
                ("deep_groove", _) => K::DeepGrooveBall,
                ("angular_contact", "30 B" | "32 B" | "33 B") => K::AngularContactBallDoubleRow,
                ("angular_contact", _) => K::AngularContactBall,
                ("four_point_contact", _) => K::FourPointContactBall,
                ("cylindrical_roller", _) => K::CylindricalRoller,
                ("tapered_roller", _) => K::TaperedRoller,
                ("needle_roller", _) => K::NeedleCage,
                (other, _) => panic!("{other}"),
            };
            let entry = BearingEntry {
                kind: Some(kind),
                series: Some(series.to_owned()),
                bore: Some(0.030),
                outside: Some(0.062),
                y: Some(1.6),
                y0: Some(0.9),
                ..BearingEntry::default()
            };
            let constants = row(&BearingPart::try_from(entry).unwrap()).unwrap();
            line.is("f0_grease", constants.f0[0]);
            line.is("f0_bath", constants.f0[1]);
            line.is("factor", constants.law.z);
            line.is("exponent", constants.law.exponent);
        }
    }
}
