//! Friction of contact seals of bearings, SKF catalogue: M = K_S1 d_s^beta + K_S2 for both seals.

use gearloss_framework::mechanism::bearing::{BearingKind, SealDesign};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Seal type and kind of bearing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Code {
    /// RSL in deep groove ball bearings, outside diameter to 52 mm.
    RslDeepGroove,
    /// RSH in deep groove ball bearings, outside diameter to 52 mm.
    RshDeepGroove,
    /// RS1 in deep groove ball bearings.
    Rs1DeepGroove,
    /// RS1 in angular contact ball bearings.
    Rs1AngularContact,
    /// RS1 in self-aligning ball bearings.
    Rs1SelfAligning,
    /// LS in cylindrical roller bearings.
    LsCylindrical,
    /// CS, CS2, CS5 in spherical roller bearings.
    CsSpherical,
    /// CS, CS2, CS5 in CARB bearings.
    CsCarb,
}

impl Code {
    /// The row of a design in a kind of bearing with an outside diameter in mm; `None` without friction.
    ///
    /// # Errors
    /// If the catalogue has no such seals in this kind: the problem and how to fix it.
    pub fn of(design: SealDesign, kind: BearingKind, outside: f64) -> Result<Option<Self>, (String, String)> {
        use BearingKind as Kind;
        let code = match (design, kind) {
            (SealDesign::NonContact | SealDesign::Shield, _) => return Ok(None),
            // Constants of RSL and RSH end at 52 mm; those of RS1 are an upper estimate for RSL.
            (SealDesign::Rsl, Kind::DeepGrooveBall) if outside <= 52.0 => Self::RslDeepGroove,
            (SealDesign::Rsh, Kind::DeepGrooveBall) if outside <= 52.0 => Self::RshDeepGroove,
            (SealDesign::Rs1 | SealDesign::Rsh | SealDesign::Rsl, Kind::DeepGrooveBall) => Self::Rs1DeepGroove,
            (SealDesign::Rs1, Kind::AngularContactBall | Kind::AngularContactBallDoubleRow) => Self::Rs1AngularContact,
            (SealDesign::Rs1, Kind::SelfAligningBall) => Self::Rs1SelfAligning,
            (SealDesign::Ls, Kind::CylindricalRoller | Kind::CylindricalRollerFullComplement) => Self::LsCylindrical,
            (SealDesign::Cs, Kind::SphericalRoller) => Self::CsSpherical,
            (SealDesign::Cs, Kind::ToroidalRoller | Kind::ToroidalRollerFullComplement) => Self::CsCarb,
            _ => {
                return Err((
                    format!("the catalogue has no friction of `{design:?}` seals in this kind of bearing")
                        .to_lowercase(),
                    "state `seals` of the model with the code that is closest, or delete `seals` of the bearing"
                        .to_owned(),
                ));
            }
        };
        Ok(Some(code))
    }
}

/// Constants of one seal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SealRow {
    beta: f64,
    k_s1: f64,
    k_s2: f64,
    /// Share of the moment of both seals.
    share: f64,
}

impl SealRow {
    /// The constants for an outside diameter in mm and one or two seals.
    ///
    /// # Errors
    /// If the table has no row for that diameter: the problem and how to fix it.
    pub fn new(code: Code, outside: f64, seals: u32) -> Result<Self, (String, String)> {
        // Minimum and maximum outside diameter, beta, K_S1, K_S2.
        let rows: &[(f64, f64, f64, f64, f64)] = match code {
            Code::RslDeepGroove => &[(0.0, 25.0, 0.0, 0.0, 0.0), (25.0, 52.0, 2.25, 0.0018, 0.0)],
            Code::RshDeepGroove => &[(0.0, 52.0, 2.25, 0.028, 2.0)],
            Code::Rs1DeepGroove => &[
                (0.0, 62.0, 2.25, 0.023, 2.0),
                (62.0, 80.0, 2.25, 0.018, 20.0),
                (80.0, 100.0, 2.25, 0.018, 15.0),
                (100.0, f64::INFINITY, 2.25, 0.018, 0.0),
            ],
            Code::Rs1AngularContact => &[(30.0, 120.0, 2.0, 0.014, 10.0)],
            Code::Rs1SelfAligning => &[(30.0, 125.0, 2.0, 0.014, 10.0)],
            Code::LsCylindrical => &[(42.0, 360.0, 2.0, 0.032, 50.0)],
            Code::CsSpherical => &[(62.0, 300.0, 2.0, 0.057, 50.0)],
            Code::CsCarb => &[(42.0, 340.0, 2.0, 0.057, 50.0)],
        };
        // The upper end is included: RS1 of 62 mm is that of smaller bearings.
        let row = rows.iter().find(|row| outside <= row.1 && outside >= row.0);
        let Some((_, _, beta, k_s1, k_s2)) = row else {
            return Err((
                format!("the catalogue has no such seal for an outside diameter of {outside} mm"),
                format!(
                    "it covers {} to {} mm; choose another seal",
                    rows[0].0,
                    rows[rows.len() - 1].1
                ),
            ));
        };
        let whole = seals != 1 || (code == Code::RslDeepGroove && outside > 25.0);
        Ok(Self {
            beta: *beta,
            k_s1: *k_s1,
            k_s2: *k_s2,
            share: if whole { 1.0 } else { 0.5 },
        })
    }

    /// Moment from the counterface diameter in mm. \[N mm\]
    pub fn moment(&self, d_s: f64) -> f64 {
        self.share * (self.k_s1 * d_s.powf(self.beta) + self.k_s2)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn one_seal_has_half_the_moment_of_two_except_rsl() {
        let both = SealRow::new(Code::Rs1DeepGroove, 80.0, 2).unwrap().moment(52.6);
        assert_eq!(
            SealRow::new(Code::Rs1DeepGroove, 80.0, 1).unwrap().moment(52.6),
            0.5 * both
        );
        let rsl = |seals| SealRow::new(Code::RslDeepGroove, 47.0, seals).unwrap().moment(30.0);
        assert_eq!(rsl(1), rsl(2));
        assert!(SealRow::new(Code::RshDeepGroove, 62.0, 2).is_err());
    }

    #[test]
    fn every_seal_is_that_of_the_catalogue() {
        let table = crate::printed::Printed::read(include_str!("../../tests/tables/skf_seals.csv"));
        for line in table.rows() {
            let code = match (line.text("seal"), line.text("bearing")) {
                ("RSL", "deep_groove") => Code::RslDeepGroove,
                ("RSH", "deep_groove") => Code::RshDeepGroove,
                ("RS1", "deep_groove") => Code::Rs1DeepGroove,
                ("RS1", "angular_contact") => Code::Rs1AngularContact,
                ("RS1", "self_aligning") => Code::Rs1SelfAligning,
                ("LS", "cylindrical_roller") => Code::LsCylindrical,
                ("CS", "spherical_roller") => Code::CsSpherical,
                ("CS", "toroidal_roller") => Code::CsCarb,
                other => panic!("{other:?}"),
            };
            let (above, up_to) = (line.number("above"), line.cell("up_to").unwrap_or(1e4));
            for outside in [above + 0.01, up_to] {
                let seal = SealRow::new(code, outside, 2).unwrap();
                line.is("beta", seal.beta);
                line.is("K_S1", seal.k_s1);
                line.is("K_S2", seal.k_s2);
                assert_eq!(seal.share, 1.0);
            }
            // No seal above the last row of its table, nor below the first.
            if code != Code::Rs1DeepGroove && up_to > 25.0 {
                assert!(SealRow::new(code, up_to + 0.01, 2).is_err());
            }
            if above >= 30.0 && code != Code::Rs1DeepGroove {
                assert!(SealRow::new(code, above - 0.01, 2).is_err());
            }
        }
    }
}
