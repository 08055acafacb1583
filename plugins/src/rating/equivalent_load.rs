//! Equivalent dynamic load of rolling bearings.
//!
//! Source: ISO 281:2007: P = X Fr + Y Fa, for radial bearings. The axial factor of deep groove ball bearings is interpolated linearly in
//! f0 Fa/C0. SKF and others print the same factors for each kind in their catalogues. Where P is continuous at Fa/Fr = e, which holds for
//! all kinds within the two digits of the table, X = 1 - Y e of bearings whose contact angle is not stated.

use gearloss_framework::loss::Notes;
use gearloss_framework::mechanism::bearing::{BearingKind, BearingPart};

/// Values of f0 Fa/C0 with e and Y of deep groove ball bearings of normal clearance; X = 0.56.
const DEEP_GROOVE: [[f64; 3]; 9] = [
    [0.172, 0.19, 2.30],
    [0.345, 0.22, 1.99],
    [0.689, 0.26, 1.71],
    [1.03, 0.28, 1.55],
    [1.38, 0.30, 1.45],
    [2.07, 0.34, 1.31],
    [3.45, 0.38, 1.15],
    [5.17, 0.42, 1.04],
    [6.89, 0.44, 1.00],
];

/// Values of e with Y1 below it, X2 and Y2 above it, of double-row angular contact ball bearings with contact angles of 20 to 45 deg.
const DOUBLE_ROW_ANGULAR: [[f64; 4]; 6] = [
    [0.57, 1.09, 0.70, 1.63],
    [0.68, 0.92, 0.67, 1.41],
    [0.80, 0.78, 0.63, 1.24],
    [0.95, 0.66, 0.60, 1.07],
    [1.14, 0.55, 0.57, 0.93],
    [1.34, 0.47, 0.54, 0.81],
];

/// Factors of the equivalent dynamic load: P = Fr + Y1 Fa up to Fa/Fr = e, X2 Fr + Y2 Fa above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factors {
    /// Limit of Fa/Fr.
    pub e: f64,
    /// Axial factor up to the limit.
    pub below: f64,
    /// Radial and axial factor above the limit.
    pub above: [f64; 2],
}

impl Factors {
    /// Equivalent dynamic load from the magnitudes of both loads. \[N\]
    pub fn load(&self, radial: f64, axial: f64) -> f64 {
        if axial <= self.e * radial {
            radial + self.below * axial
        } else {
            self.above[0] * radial + self.above[1] * axial
        }
    }
}

/// Linear interpolation in the first column of a table with increasing rows, constant beyond its ends.
fn interpolated<const N: usize>(table: &[[f64; N]], x: f64) -> [f64; N] {
    let next = table.partition_point(|row| row[0] < x);
    let (Some(low), Some(high)) = (next.checked_sub(1).and_then(|i| table.get(i)), table.get(next)) else {
        return if next == 0 { table[0] } else { table[table.len() - 1] };
    };
    let share = (x - low[0]) / (high[0] - low[0]);
    std::array::from_fn(|i| low[i] + share * (high[i] - low[i]))
}

/// Factors of a bearing under an axial load, with `f0` where the catalogue's is not known; `None` if its data do not suffice.
pub fn factors(part: &BearingPart, axial: f64, f0: f64) -> Option<Factors> {
    let single_row = |e: f64, y: f64, x: f64| Factors {
        e,
        below: 0.0,
        above: [x, y],
    };
    match part.kind {
        BearingKind::DeepGrooveBall | BearingKind::DeepGrooveBallDoubleRow => {
            if let (Some(e), Some(y)) = (part.e, part.y) {
                return Some(single_row(e, y, 0.56));
            }
            let relative = part.calculation_factor.unwrap_or(f0) * axial / part.c0?;
            let [_, e, y] = interpolated(&DEEP_GROOVE, relative);
            Some(single_row(e, y, 0.56))
        }
        BearingKind::AngularContactBall => Some(single_row(part.e?, part.y?, 1.0 - part.e? * part.y?)),
        BearingKind::AngularContactBallDoubleRow => {
            let [_, y1, x2, y2] = interpolated(&DOUBLE_ROW_ANGULAR, part.e?);
            Some(Factors {
                e: part.e?,
                below: y1,
                above: [x2, y2],
            })
        }
        BearingKind::FourPointContactBall => Some(Factors {
            e: 0.95,
            below: 0.66,
            above: [0.6, 1.07],
        }),
        // Y1 = 0.42 cot a, Y2 = 0.65 cot a and e = 1.5 tan a for a contact angle a.
        BearingKind::SelfAligningBall => Some(Factors {
            e: part.e.unwrap_or(0.975 / part.y?),
            below: part.y? * (0.42 / 0.65),
            above: [0.65, part.y?],
        }),
        // Y = 0.4 cot a and e = 1.5 tan a.
        BearingKind::TaperedRoller => Some(single_row(part.e.unwrap_or(0.6 / part.y?), part.y?, 0.4)),
        // Y1 = 0.45 cot a, Y2 = 0.67 cot a and e = 1.5 tan a.
        BearingKind::SphericalRoller => Some(Factors {
            e: part.e.unwrap_or(1.005 / part.y?),
            below: part.y? * (0.45 / 0.67),
            above: [0.67, part.y?],
        }),
        BearingKind::CylindricalRoller | BearingKind::CylindricalRollerFullComplement => {
            let of_series = match part.series.as_deref() {
                Some("10" | "2" | "3" | "4") => Some((0.2, 0.6)),
                Some("22" | "23") => Some((0.3, 0.4)),
                _ => None,
            };
            let (e, y) = part.e.zip(part.y).or(of_series)?;
            Some(single_row(e, y, 0.92))
        }
        // They carry no axial load.
        BearingKind::NeedleCage | BearingKind::ToroidalRoller | BearingKind::ToroidalRollerFullComplement => {
            Some(single_row(f64::INFINITY, 0.0, 1.0))
        }
        BearingKind::ThrustBall | BearingKind::CylindricalRollerThrust | BearingKind::NeedleRollerThrust => {
            Some(single_row(-1.0, 1.0, 0.0))
        }
        BearingKind::SphericalRollerThrust => Some(single_row(-1.0, 0.88, 0.88 * 1.2)),
        BearingKind::Plain | BearingKind::ThrustWasher => None,
    }
}

/// Equivalent dynamic load of a bearing, with its factors in an explanation; `None` if its data do not suffice. \[N\]
pub fn equivalent(part: &BearingPart, radial: f64, axial: f64, f0: f64, notes: Notes<'_>) -> Option<f64> {
    let axial = axial.abs();
    if axial == 0.0 && !part.kind.is_thrust() {
        notes.branch("no axial load: P = Fr");
        return Some(radial);
    }
    let Some(factors) = factors(part, axial, f0) else {
        notes.branch("e and Y of this bearing are not known: state `e` and `y`, for a deep groove ball bearing `c0`");
        return None;
    };
    if factors.e.is_finite() && factors.e > 0.0 {
        notes.show("e", "-", factors.e);
        if radial > 0.0 {
            notes.show("Fa/Fr", "-", axial / radial);
        }
    }
    if axial > factors.e * radial {
        notes.show("X", "-", factors.above[0]);
        notes.show("Y", "-", factors.above[1]);
    } else {
        notes.show("Y", "-", factors.below);
    }
    Some(factors.load(radial, axial))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::testing::assert_close;
    use proptest::prelude::*;

    fn part(yaml: &str) -> BearingPart {
        let value = gearloss_framework::testing::part("bearing", yaml);
        serde_json::from_value(value).unwrap()
    }

    /// Check values of an independent implementation: 6308, f0 13, C0 24 kN.
    #[test]
    fn check_values_of_a_6308_and_a_30206() {
        let ball = part("{ kind: deep_groove_ball, bore: 40 mm, outside: 90 mm, c0: 24000 N, calculation_factor: 13 }");
        let found = factors(&ball, 1000.0, 14.0).unwrap();
        assert_close(found.e, 0.242_868, 1e-5);
        assert_close(found.above[1], 1.829_92, 1e-5);
        assert_close(found.load(3000.0, 1000.0), 3509.92, 1e-5);
        assert_close(found.load(1000.0, 1000.0), 2389.92, 1e-5);
        let tapered = part("{ kind: tapered_roller, bore: 30 mm, outside: 62 mm, e: 0.37, y: 1.6 }");
        assert_close(
            factors(&tapered, 1500.0, 14.0).unwrap().load(3000.0, 1500.0),
            3600.0,
            1e-12,
        );
    }

    /// NSK catalogue E1102m, page 15: example 2 (6208, f0 14, C0r 17900 N: f0 Fa/C0r = 0.782, e about 0.26) and example 3 (series 231:
    /// e 0.3, Y3 2.2 up to e: P = 45000 + 2.2 8000 = 62600 N).
    #[test]
    fn nsk_examples_2_and_3() {
        let ball = part("{ kind: deep_groove_ball, bore: 40 mm, outside: 80 mm, c0: 17900 N, calculation_factor: 14 }");
        let found = factors(&ball, 1000.0, 14.0).unwrap();
        assert_close(found.e, 0.26, 0.03);
        // Y2 = Y3 0.67/0.45.
        let y2 = 2.2 * 0.67 / 0.45;
        let spherical = part(&format!(
            "{{ kind: spherical_roller, bore: 120 mm, outside: 200 mm, e: 0.3, y: {y2} }}"
        ));
        assert_close(
            factors(&spherical, 8000.0, 14.0).unwrap().load(45_000.0, 8000.0),
            62_600.0,
            1e-9,
        );
    }

    /// ISO 281 as printed by catalogues for contact angles of 25 and 40 deg: X 0.41 and 0.35.
    #[test]
    fn the_radial_factor_of_angular_contact_follows_from_continuity() {
        for (e, y, x) in [(0.68, 0.87, 0.41), (1.14, 0.57, 0.35)] {
            let bearing = part(&format!(
                "{{ kind: angular_contact_ball, bore: 40 mm, outside: 80 mm, e: {e}, y: {y} }}"
            ));
            assert_close(factors(&bearing, 1.0, 14.0).unwrap().above[0], x, 0.005);
        }
    }

    const EACH: [&str; 7] = [
        "{ kind: deep_groove_ball, bore: 40 mm, outside: 80 mm, c0: 20000 N }",
        "{ kind: angular_contact_ball, bore: 40 mm, outside: 80 mm, e: 1.14, y: 0.57 }",
        "{ kind: angular_contact_ball_double_row, bore: 40 mm, outside: 80 mm, e: 0.8 }",
        "{ kind: tapered_roller, bore: 40 mm, outside: 80 mm, y: 1.6 }",
        "{ kind: spherical_roller, bore: 40 mm, outside: 80 mm, y: 2.9 }",
        "{ kind: self_aligning_ball, bore: 40 mm, outside: 80 mm, y: 2.9 }",
        "{ kind: cylindrical_roller, series: \"2\", bore: 40 mm, outside: 80 mm }",
    ];

    proptest! {
        /// The load is positive, grows with the axial load, and never falls below 0.85 of the radial load.
        #[test]
        fn loads_grow(kind in 0..EACH.len(), radial in 1.0..1e5_f64, share in 0.0..3.0_f64) {
            let bearing = part(EACH[kind]);
            let at = |axial: f64| factors(&bearing, axial, 14.0).unwrap().load(radial, axial);
            let (one, more) = (at(share * radial), at(share * radial * 1.1 + 1.0));
            prop_assert!(one > 0.85 * radial, "{one} under {radial}");
            prop_assert!(more > 0.96 * one, "{more} after {one}");
        }
    }
}
