//! Thrust that the radial load of a bearing with a contact angle induces.
//!
//! Source: catalogues of rolling bearings: S = r Fr, with r = 0.5/Y for tapered roller bearings. With Y = 0.4 cot(alpha) of ISO 281 this is
//! 1.25 tan(alpha), the thrust at which half of the rollers carry (1.258 tan(alpha) of the load distribution of line contact). For
//! single-row angular contact ball bearings r is tabulated by contact angle; two copies of the table agree.

use std::fmt;

use crate::registry::Evidence;
use crate::table::clamped;

/// Contact angles of ball bearings with a known r, and the r. \[deg and 1\]
const BALLS: [[f64; 4]; 2] = [[20.0, 25.0, 30.0, 40.0], [0.50, 0.57, 0.66, 0.88]];

/// Largest thrust per radial load, as for the key `induced_thrust`: a contact angle of 67 degrees.
const LARGEST: f64 = 3.0;

/// Thrust that a radial load induces by the design of a bearing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Induced {
    /// None: the bearing has no contact angle, or two rows whose thrusts balance each other.
    None,
    /// In proportion to the radial load.
    Known(InducedThrust),
    /// The bearing has a contact angle, but its data do not state how large the thrust is.
    Unknown {
        /// Why not.
        why: &'static str,
        /// Which keys state it.
        help: &'static str,
    },
}

/// Thrust per radial load, and what it follows from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InducedThrust {
    /// Thrust per radial load r.
    pub ratio: f64,
    /// What it follows from.
    pub basis: InducedBasis,
}

/// What the induced thrust of a bearing follows from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InducedBasis {
    /// The key `induced_thrust`.
    Stated,
    /// Axial factor Y of a tapered roller bearing.
    AxialFactor(f64),
    /// Contact angle of a tapered roller bearing. \[rad\]
    RollerAngle(f64),
    /// Contact angle of an angular contact ball bearing. \[rad\]
    BallAngle(f64),
    /// Contact angle of a bearing of a preloaded pair: the thrust per radial load at which half of the elements carry. \[rad\]
    HalfLoaded(f64),
}

impl Induced {
    /// That of a tapered roller bearing with an axial factor Y, else with a contact angle in rad.
    pub fn of_tapered_roller(y: Option<f64>, contact_angle: Option<f64>) -> Self {
        let (ratio, basis) = match (y, contact_angle) {
            (Some(y), _) => (0.5 / y, InducedBasis::AxialFactor(y)),
            (None, Some(angle)) => (1.25 * angle.tan(), InducedBasis::RollerAngle(angle)),
            (None, None) => {
                return Self::Unknown {
                    why: "neither its axial factor Y nor its contact angle is stated",
                    help: "state `y` of its catalogue, `contact_angle`, or `induced_thrust`",
                };
            }
        };
        if (0.0..=LARGEST).contains(&ratio) {
            Self::Known(InducedThrust { ratio, basis })
        } else {
            Self::Unknown {
                why: "its axial factor Y or its contact angle is not that of a tapered roller bearing",
                help: "correct `y` or `contact_angle`, or state `induced_thrust`",
            }
        }
    }

    /// That of a single-row angular contact ball bearing with a contact angle in rad; linear between the angles of the table.
    pub fn of_angular_contact_ball(contact_angle: Option<f64>) -> Self {
        let Some(angle) = contact_angle else {
            return Self::Unknown {
                why: "its contact angle is not stated",
                help: "state `contact_angle`, or `induced_thrust`",
            };
        };
        let [angles, ratios] = &BALLS;
        let (degrees, rounding) = (angle.to_degrees(), 1e-9);
        if degrees < angles[0] - rounding || degrees > angles[3] + rounding {
            return Self::Unknown {
                why: "the table of ball bearings has contact angles from 20 to 40 deg; below, the angle depends on the load",
                help: "state `induced_thrust` of its catalogue",
            };
        }
        Self::Known(InducedThrust {
            ratio: clamped(angles, ratios, degrees),
            basis: InducedBasis::BallAngle(angle),
        })
    }
}

impl InducedBasis {
    /// It in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Stated => "`induced_thrust`",
            Self::AxialFactor(_) => "Y",
            Self::RollerAngle(_) | Self::BallAngle(_) => "contact angle",
            Self::HalfLoaded(_) => "load distribution",
        }
    }

    /// The grade of the rule and its reason; `None` if the thrust is stated.
    pub fn evidence(self) -> Option<(Evidence, &'static str)> {
        match self {
            Self::Stated => None,
            Self::AxialFactor(_) | Self::RollerAngle(_) => Some((
                Evidence::SeveralSources,
                "rule of catalogues for half of the rollers, and load distribution",
            )),
            Self::HalfLoaded(_) => Some((
                Evidence::SeveralSources,
                "load integrals of a fixed contact angle, printed by catalogues",
            )),
            Self::BallAngle(angle) => {
                let tabulated = |known: &f64| (known - angle.to_degrees()).abs() < 1e-6;
                Some(if BALLS[0].iter().any(tabulated) {
                    (Evidence::SeveralSources, "table of catalogues, two copies")
                } else {
                    (
                        Evidence::Assumed,
                        "linear between the angles of the table of catalogues",
                    )
                })
            }
        }
    }

    /// The key of the bearing that states it.
    pub fn key(self) -> &'static str {
        match self {
            Self::Stated => "induced_thrust",
            Self::AxialFactor(_) => "y",
            Self::RollerAngle(_) | Self::BallAngle(_) | Self::HalfLoaded(_) => "contact_angle",
        }
    }
}

impl fmt::Display for InducedBasis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Angles are stored in radians.
        let degrees = |angle: f64| (angle.to_degrees() * 1e6).round() / 1e6;
        match self {
            Self::Stated => f.write_str("stated"),
            Self::AxialFactor(y) => write!(f, "0.5/Y, Y = {y}"),
            Self::RollerAngle(angle) => write!(f, "1.25 tan(alpha), alpha = {} deg", degrees(*angle)),
            Self::BallAngle(angle) => write!(f, "contact angle {} deg", degrees(*angle)),
            Self::HalfLoaded(angle) => write!(f, "load distribution, contact angle {} deg", degrees(*angle)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ratio(induced: Induced) -> Option<f64> {
        match induced {
            Induced::Known(known) => Some(known.ratio),
            _ => None,
        }
    }

    #[test]
    fn balls_have_the_values_of_the_catalogue_and_lines_between_them() {
        let ball = |degrees: f64| ratio(Induced::of_angular_contact_ball(Some(degrees.to_radians())));
        for (degrees, printed) in [(20.0, 0.50), (25.0, 0.57), (30.0, 0.66), (35.0, 0.77), (40.0, 0.88)] {
            let found = ball(degrees).unwrap_or_default();
            assert!((found - printed).abs() < 1e-12, "{degrees}: {found}");
        }
        assert_eq!((ball(15.0), ball(19.99), ball(40.01)), (None, None, None));
        assert_eq!(ratio(Induced::of_angular_contact_ball(None)), None);
    }

    #[test]
    fn tapered_rollers_follow_from_y_and_else_from_the_angle() {
        let tapered = |y, degrees: Option<f64>| ratio(Induced::of_tapered_roller(y, degrees.map(f64::to_radians)));
        assert_eq!(tapered(Some(1.6), None), Some(0.3125));
        assert_eq!(tapered(Some(1.6), Some(20.0)), Some(0.3125));
        // Y = 0.4 cot(alpha): both are the same.
        let y = 0.4 / 14_f64.to_radians().tan();
        let (by_y, by_angle) = (tapered(Some(y), None), tapered(None, Some(14.0)));
        assert!((by_y.unwrap_or_default() - by_angle.unwrap_or_default()).abs() < 1e-15);
        for (y, degrees) in [(None, None), (Some(0.0), None), (Some(0.1), None), (None, Some(80.0))] {
            assert_eq!(tapered(y, degrees), None);
        }
    }
}
