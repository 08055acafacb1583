//! Factors f0 and f1 by kind, series and lubrication: SKF General Catalogue 1994, in the form of ISO/TR 14179-2.

use gearloss_framework::mechanism::bearing::{BearingKind, BearingPart, Lubrication};
use gearloss_framework::real::Real;

/// What is missing, and how to fix it.
pub type Lack = (String, String);

/// How P0 and P1 are computed from the loads.
#[derive(Debug, Clone, Copy)]
pub enum Rule {
    DeepGroove {
        k: f64,
    },
    /// P0 = max(Fr, 0.5 Fr + y0 Fa).
    Angular {
        y0: f64,
    },
    /// P0 = Fr + y0 Fa, for two rows or a pair.
    TwoRows {
        k: f64,
        y0: f64,
    },
    FourPoint,
    Radial,
    Tapered {
        y: f64,
    },
    Spherical {
        y: f64,
    },
    Thrust,
    /// P1 = k Fa cot(alpha) - 0.1 Fr of balls, according to Harris; P0 as for angular contact bearings.
    Ball {
        k_cot: f64,
        y0: f64,
    },
    /// The same for two rows: P0 = Fr + y0 Fa.
    BallTwoRows {
        k_cot: f64,
        y0: f64,
    },
    /// P1 = k Fa cot(alpha), according to Harris.
    Roller {
        k_cot: f64,
    },
}

impl Rule {
    /// P0 and P1 from radial and axial load; P1 is at least the radial load. \[N\]
    #[inline(always)]
    pub fn equivalent<R: Real>(self, fr: R, fa: R) -> (R, R) {
        let (p0, p1) = match self {
            Self::DeepGroove { k } => (fr.max(fr * 0.6 + fa * 0.5), fa * k - fr * 0.1),
            Self::Angular { y0 } => (fr.max(fr * 0.5 + fa * y0), fa - fr * 0.1),
            Self::TwoRows { k, y0 } => (fr + fa * y0, fa * k - fr * 0.1),
            Self::FourPoint => (fr + fa * 0.58, fa * 1.5 + fr * 3.6),
            Self::Radial => (fr, fr),
            Self::Tapered { y } => (fr, fa * (2.0 * y)),
            Self::Spherical { y } => {
                let axial = fa * y;
                let ratio = axial / fr;
                let mostly_radial = fr * (ratio * ratio * ratio * 0.35 + 1.0);
                let p1 = R::select(fr.is_above(R::ZERO), mostly_radial, R::ZERO);
                (fr, R::select(fr.is_below(axial), axial * 1.35, p1))
            }
            Self::Thrust => (fa, fa),
            Self::Ball { k_cot, y0 } => (fr.max(fr * 0.5 + fa * y0), fa * k_cot - fr * 0.1),
            Self::BallTwoRows { k_cot, y0 } => (fr + fa * y0, fa * k_cot - fr * 0.1),
            Self::Roller { k_cot } => (fr, fa * k_cot),
        };
        (p0, p1.max(fr))
    }
}

/// f1 = z (P0/C0)^exponent with the powers a of P1 and b of d_m.
#[derive(Debug, Clone, Copy)]
pub struct LoadLaw {
    pub z: f64,
    /// Zero where f1 is constant.
    pub exponent: f64,
    pub a: f64,
    pub b: f64,
    pub rule: Rule,
}

impl LoadLaw {
    /// A law with both exponents one.
    pub fn new(z: f64, exponent: f64, rule: Rule) -> Self {
        Self {
            z,
            exponent,
            a: 1.0,
            b: 1.0,
            rule,
        }
    }
}

/// Position of a series between light and heavy cross sections.
const LIGHT: [&str; 23] = [
    "10", "60", "630", "160", "161", "617", "618", "619", "628", "637", "638", "639", "130", "139", "18", "320 X",
    "320", "329", "230", "238", "239", "240", "292E",
];
const MIDDLE: [&str; 23] = [
    "2", "12", "20", "62", "622", "112", "29", "30", "50", "302", "322", "322 B", "330", "331", "332", "222", "231",
    "232", "241", "248", "249", "293E", "42",
];
const HEAVY: [&str; 18] = [
    "3", "4", "13", "22", "23", "43", "63", "64", "623", "303", "313", "313 (X)", "323", "323 B", "213", "223", "294E",
    "33 A",
];

/// z of light series of deep groove ball bearings, within the catalogue's 0.0006 to 0.0009.
const Z_LIGHT: f64 = 0.0007;
/// z of the other deep groove ball bearings.
const Z_OTHERS: f64 = 0.0009;

/// Spherical roller bearings: series, f1, exponent of P1, exponent of d_m.
const SPHERICAL: [(&str, f64, f64, f64); 9] = [
    ("213", 0.00022, 1.35, 0.2),
    ("222", 0.00015, 1.35, 0.3),
    ("223", 0.00065, 1.35, 0.1),
    ("230", 0.001, 1.5, -0.3),
    ("231", 0.00035, 1.5, -0.1),
    ("232", 0.00045, 1.5, -0.1),
    ("239", 0.00025, 1.5, -0.1),
    ("240", 0.0008, 1.5, -0.2),
    ("241", 0.001, 1.5, -0.2),
];

/// Series as the tables name it; spherical roller bearings of the E design use the row of their series.
fn series(part: &BearingPart) -> Option<&str> {
    let series = part.series.as_deref()?.trim();
    Some(match part.kind {
        BearingKind::SphericalRoller => series.trim_end_matches('E').trim_end(),
        _ => series,
    })
}

fn no_series(part: &BearingPart, what: &str, known: &str) -> Lack {
    match &part.series {
        Some(series) => (
            format!("the table has no {what} for series `{series}`"),
            format!("set `series` to one of {known}"),
        ),
        None => (
            format!("`series` is needed for {what}"),
            format!("add `series:`, one of {known}, or a `designation`"),
        ),
    }
}

/// Why a model of rolling bearings refuses one without rolling elements.
pub fn sliding(part: &BearingPart) -> Lack {
    let model = match part.kind {
        BearingKind::ThrustWasher => "washer_gap",
        _ => "journal_film",
    };
    (
        format!("this model applies to rolling bearings, not to `{}`", part.kind.name()),
        format!("give this bearing its own model: `model: {{ type: {model} }}`"),
    )
}

/// f0 of the load-independent moment.
///
/// # Errors
/// If the table has no value for this bearing, or has a range and no series selects from it.
pub fn f0(part: &BearingPart) -> Result<f64, Lack> {
    f0_under(part, part.lubrication)
}

/// f0 with a lubrication other than the bearing's own.
///
/// # Errors
/// As [`f0`].
pub fn f0_under(part: &BearingPart, lubrication: Lubrication) -> Result<f64, Lack> {
    use BearingKind as K;
    let one = |x: f64| Some((x, x));
    // Grease, oil and air, bath, jet; a range covers light to heavy series.
    let [grease, air, bath, jet] = match part.kind {
        K::DeepGrooveBall => [Some((0.75, 2.0)), one(1.0), one(2.0), one(4.0)],
        K::DeepGrooveBallDoubleRow => [one(3.0), one(2.0), one(4.0), one(8.0)],
        K::SelfAligningBall => [Some((1.5, 2.0)), Some((0.7, 1.0)), Some((1.5, 2.0)), Some((3.0, 4.0))],
        K::AngularContactBall => [one(2.0), one(1.7), one(3.3), one(6.6)],
        K::AngularContactBallDoubleRow => [one(4.0), one(3.4), one(6.5), one(13.0)],
        K::FourPointContactBall => [one(6.0), one(2.0), one(6.0), one(9.0)],
        K::ThrustBall => [one(5.5), one(0.8), one(1.5), one(3.0)],
        K::CylindricalRoller => [Some((0.6, 1.0)), Some((1.5, 2.8)), Some((2.2, 4.0)), Some((2.2, 4.0))],
        K::CylindricalRollerFullComplement => [Some((5.0, 10.0)), None, Some((5.0, 10.0)), None],
        K::NeedleCage => [one(12.0), one(6.0), one(12.0), one(24.0)],
        K::TaperedRoller => [one(6.0), one(3.0), one(6.0), Some((8.0, 10.0))],
        K::SphericalRoller => [Some((3.5, 7.0)), Some((1.7, 3.5)), Some((3.5, 7.0)), Some((7.0, 14.0))],
        K::CylindricalRollerThrust => [one(9.0), None, one(3.5), one(8.0)],
        K::NeedleRollerThrust => [one(14.0), None, one(5.0), one(11.0)],
        K::SphericalRollerThrust => [None, None, Some((2.5, 5.0)), Some((5.0, 10.0))],
        K::ToroidalRoller | K::ToroidalRollerFullComplement | K::Plain | K::ThrustWasher => [None; 4],
    };
    let (cell, lubrication) = match lubrication {
        Lubrication::Grease => (grease, "grease"),
        Lubrication::OilAir => (air, "oil and air"),
        Lubrication::Bath => (bath, "an oil bath"),
        Lubrication::Jet => (jet, "an oil jet"),
    };
    let (low, high) = cell.ok_or_else(|| {
        (
            format!("the table has no f0 for this kind of bearing under {lubrication}"),
            "write `f0:` (`f0_min:` and `f0_max:` of iso14179_1) in the model with your value, or another `lubrication:`"
                .to_owned(),
        )
    })?;
    if low == high {
        return Ok(low);
    }
    match series(part) {
        Some(series) if HEAVY.contains(&series) => Ok(high),
        Some(series) if MIDDLE.contains(&series) => Ok(0.5 * (low + high)),
        Some(series) if LIGHT.contains(&series) => Ok(low),
        _ => Err(no_series(
            part,
            "f0",
            &format!("{}, {}, {}", LIGHT.join(", "), MIDDLE.join(", "), HEAVY.join(", ")),
        )),
    }
}

/// Law of the load-dependent moment; exponent and axial factor are those of deep groove ball bearings.
///
/// # Errors
/// If a series or a load factor required by the row is missing.
pub fn load_law(part: &BearingPart, exponent: f64, axial_factor: f64, z_given: bool) -> Result<LoadLaw, Lack> {
    use BearingKind as K;
    let need = |value: Option<f64>, key: &str, hint: &str| {
        value.ok_or_else(|| {
            (
                format!("`{key}` is needed for this kind of bearing"),
                format!("add `{key}:` {hint}"),
            )
        })
    };
    let y = || need(part.y, "y", "from the catalogue");
    let deep = Rule::DeepGroove { k: axial_factor };
    let name = series(part).unwrap_or("");
    Ok(match part.kind {
        K::DeepGrooveBall if z_given => LoadLaw::new(Z_OTHERS, exponent, deep),
        K::DeepGrooveBall if LIGHT.contains(&name) => LoadLaw::new(Z_LIGHT, exponent, deep),
        K::DeepGrooveBall if MIDDLE.contains(&name) || HEAVY.contains(&name) => LoadLaw::new(Z_OTHERS, exponent, deep),
        K::DeepGrooveBall => return Err(no_series(part, "f1", "60, 160, 617, 618, 619, 2, 62, 3, 63, 64")),
        K::DeepGrooveBallDoubleRow => LoadLaw::new(Z_OTHERS, exponent, deep),
        K::SelfAligningBall => {
            let y0 = need(part.y0, "y0", "from the catalogue")?;
            LoadLaw::new(0.0003, 0.4, Rule::TwoRows { k: 1.4 * y()?, y0 })
        }
        K::AngularContactBall => {
            let y0 = need(part.y0, "y0", "such as 0.26 for 40 deg, 0.38 for 25 deg")?;
            LoadLaw::new(0.001, 0.33, Rule::Angular { y0 })
        }
        K::AngularContactBallDoubleRow => {
            let y0 = need(part.y0, "y0", "such as 0.66 for 30 deg, 0.52 for 40 deg")?;
            LoadLaw::new(0.001, 0.33, Rule::TwoRows { k: 1.4, y0 })
        }
        K::FourPointContactBall => LoadLaw::new(0.001, 0.33, Rule::FourPoint),
        K::ThrustBall => LoadLaw::new(0.0008, 0.33, Rule::Thrust),
        K::CylindricalRoller => {
            let z = match name {
                "10" => 0.0002,
                "2" => 0.0003,
                "3" => 0.00035,
                "4" | "22" | "23" => 0.0004,
                _ if z_given => 0.0,
                _ => return Err(no_series(part, "f1", "10, 2, 3, 4, 22, 23")),
            };
            LoadLaw::new(z, 0.0, Rule::Radial)
        }
        K::CylindricalRollerFullComplement => LoadLaw::new(0.00055, 0.0, Rule::Radial),
        K::NeedleCage => LoadLaw::new(0.002, 0.0, Rule::Radial),
        K::TaperedRoller => LoadLaw::new(0.0004, 0.0, Rule::Tapered { y: y()? }),
        K::SphericalRoller => spherical(part, Rule::Spherical { y: y()? })?,
        K::ToroidalRoller | K::ToroidalRollerFullComplement => {
            return Err((
                "the tables of Palmgren's form have no toroidal roller bearings".to_owned(),
                "give this bearing its own model, such as `model: { type: skf }`".to_owned(),
            ));
        }
        K::Plain | K::ThrustWasher => return Err(sliding(part)),
        K::CylindricalRollerThrust | K::NeedleRollerThrust => LoadLaw::new(0.0015, 0.0, Rule::Thrust),
        K::SphericalRollerThrust => {
            let z = match name {
                "292E" => 0.00023,
                "293E" => 0.0003,
                "294E" => 0.00033,
                _ if z_given => 0.0,
                _ => return Err(no_series(part, "f1", "292E, 293E, 294E")),
            };
            LoadLaw::new(z, 0.0, Rule::Thrust)
        }
    })
}

/// Load law of a spherical roller bearing with a rule for its loads.
///
/// # Errors
/// If the table does not list the series.
pub fn spherical(part: &BearingPart, rule: Rule) -> Result<LoadLaw, Lack> {
    let name = series(part).unwrap_or("");
    let known = || SPHERICAL.map(|row| row.0).join(", ");
    let row = SPHERICAL
        .iter()
        .find(|row| row.0 == name)
        .ok_or_else(|| no_series(part, "f1", &known()))?;
    Ok(LoadLaw {
        z: row.1,
        exponent: 0.0,
        a: row.2,
        b: row.3,
        rule,
    })
}

/// f2 of axially loaded cylindrical roller bearings with flanges of the EC design; zero for other kinds.
pub fn f2(part: &BearingPart) -> f64 {
    let grease = part.lubrication == Lubrication::Grease;
    match part.kind {
        BearingKind::CylindricalRoller if grease => 0.003,
        BearingKind::CylindricalRoller => 0.002,
        BearingKind::CylindricalRollerFullComplement if grease => 0.006,
        BearingKind::CylindricalRollerFullComplement => 0.003,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::bearing::palmgren::AXIAL_RATIO;
    use crate::printed::Printed;
    use gearloss_framework::mechanism::bearing::BearingEntry;

    #[test]
    fn both_branches_of_spherical_rollers_meet() {
        let rule = Rule::Spherical { y: 2.0 };
        let (axial, radial) = (rule.equivalent(1999.999, 1000.0).1, rule.equivalent(2000.001, 1000.0).1);
        // At Fr = Y2 Fa both forms give 1.35 Fr.
        assert!(
            (axial - 2700.0).abs() < 0.01 && (radial - 2700.0).abs() < 0.01,
            "{axial} {radial}"
        );
        assert_eq!(rule.equivalent(0.0, 0.0), (0.0, 0.0));
    }

    #[test]
    fn no_rule_falls_below_the_radial_load() {
        for rule in [
            Rule::DeepGroove { k: 3.0 },
            Rule::Angular { y0: 0.26 },
            Rule::Tapered { y: 1.6 },
            Rule::Spherical { y: 2.0 },
        ] {
            assert!(rule.equivalent(1000.0, 1.0).1 >= 1000.0);
        }
    }

    #[test]
    fn a_series_stands_in_one_weight_only() {
        for name in LIGHT {
            assert!(!MIDDLE.contains(&name) && !HEAVY.contains(&name), "{name}");
        }
        assert!(MIDDLE.iter().all(|name| !HEAVY.contains(name)));
    }

    fn part(kind: BearingKind, series: &str, lubrication: Lubrication) -> BearingPart {
        let entry = BearingEntry {
            kind: Some(kind),
            series: Some(series.to_owned()),
            bore: Some(0.030),
            outside: Some(0.062),
            y: Some(1.6),
            y0: Some(0.9),
            lubrication,
            ..BearingEntry::default()
        };
        BearingPart::try_from(entry).unwrap()
    }

    fn kind(name: &str) -> BearingKind {
        use BearingKind as K;
        match name {
            "deep_groove" | "deep_groove single row" => K::DeepGrooveBall,
            "deep_groove double row" => K::DeepGrooveBallDoubleRow,
            "self_aligning" => K::SelfAligningBall,
            "angular_contact single row" => K::AngularContactBall,
            "angular_contact double row" => K::AngularContactBallDoubleRow,
            "four_point_contact" => K::FourPointContactBall,
            "thrust_ball" => K::ThrustBall,
            "cylindrical_roller" => K::CylindricalRoller,
            "cylindrical_roller full complement" => K::CylindricalRollerFullComplement,
            "needle_roller" => K::NeedleCage,
            "tapered_roller" => K::TaperedRoller,
            "spherical_roller" => K::SphericalRoller,
            "cylindrical_roller_thrust" => K::CylindricalRollerThrust,
            "needle_roller_thrust" => K::NeedleRollerThrust,
            "spherical_roller_thrust" => K::SphericalRollerThrust,
            other => panic!("{other}"),
        }
    }

    #[test]
    fn every_f0_is_that_of_the_catalogue() {
        let table = Printed::read(include_str!("../../tests/tables/palmgren_f0.csv"));
        for line in table.rows() {
            let kind = kind(line.text("type"));
            for (least, greatest, lubrication) in [
                ("grease", "grease_to", Lubrication::Grease),
                ("mist", "mist_to", Lubrication::OilAir),
                ("bath", "bath_to", Lubrication::Bath),
                ("jet", "jet_to", Lubrication::Jet),
            ] {
                // A light and a heavy series.
                let light = f0(&part(kind, "10", lubrication)).ok();
                let heavy = f0(&part(kind, "3", lubrication)).ok();
                assert_eq!(light.is_some(), line.cell(least).is_some(), "{kind:?} {lubrication:?}");
                if let (Some(light), Some(heavy)) = (light, heavy) {
                    line.is(least, light);
                    line.is(greatest, heavy);
                }
            }
        }
        assert_eq!(table.rows().count(), 15);
    }

    #[test]
    fn every_f1_is_that_of_the_catalogue() {
        let table = Printed::read(include_str!("../../tests/tables/palmgren_f1.csv"));
        for line in table.rows() {
            let (name, series) = (line.text("type"), line.text("series"));
            let (kind, series) = match (name, series) {
                ("cylindrical_roller", "full complement") => {
                    (BearingKind::CylindricalRollerFullComplement, String::new())
                }
                ("deep_groove", _) => (BearingKind::DeepGrooveBall, "3".to_owned()),
                _ => (kind(name), series.replace(" E", "E")),
            };
            let law = load_law(&part(kind, &series, Lubrication::Bath), 0.55, 3.0, false).unwrap();
            line.is("factor_to", law.z);
            line.is("exponent", law.exponent);
            line.is("a", law.a);
            line.is("b", law.b);
            if kind == BearingKind::DeepGrooveBall {
                // Light series lie within the range of the catalogue.
                let light = load_law(&part(kind, "60", Lubrication::Bath), 0.55, 3.0, false).unwrap();
                assert!((line.number("factor")..line.number("factor_to")).contains(&light.z));
            } else {
                line.is("factor", law.z);
            }
        }
        assert_eq!(
            SPHERICAL.len(),
            table
                .rows()
                .filter(|line| line.text("type") == "spherical_roller")
                .count()
        );
    }

    #[test]
    fn every_f2_is_that_of_the_catalogue() {
        let table = Printed::read(include_str!("../../tests/tables/flange_f2.csv"));
        let mut met = 0;
        for line in table.rows() {
            // For other designs the user states the value.
            let kind = match line.text("type") {
                "cage with EC flange" => BearingKind::CylindricalRoller,
                "full complement single row" => BearingKind::CylindricalRollerFullComplement,
                _ => continue,
            };
            line.is("oil", f2(&part(kind, "2", Lubrication::Bath)));
            line.is("grease", f2(&part(kind, "2", Lubrication::Grease)));
            line.is("Fa/Fr", AXIAL_RATIO.greatest);
            met += 1;
        }
        assert_eq!(met, 2);
    }
}
