//! The displacement of very many elements beside that of single ones.

use super::*;
use crate::testing::assert_close;

/// Ratio of the axial displacement of a row of single elements to that of very many with a fixed contact angle, at a thrust and a radial load.
fn over_many(row: &impl Row, many: &ManyElements, thrust: f64, radial: f64) -> f64 {
    let found = balanced(row, Axes::loaded(thrust, radial)).displacement.axial;
    found / AxialRow::new(many).displacement(thrust, radial)
}

fn balls(degrees: f64) -> (Balls, ManyElements) {
    let row = Balls::new(BallGeometry {
        number: 13,
        diameter: 9.5 * MM,
        pitch_diameter: 46.0 * MM,
        contact_angle: degrees.to_radians(),
        ..seven_balls(0.0)
    });
    let many = ManyElements {
        number: 13.0,
        stiffness: row.stiffness(),
        contact_angle: degrees.to_radians(),
        contact: Contact::Point,
    };
    (row, many)
}

fn tapered(profile: Profile) -> (Rollers, ManyElements) {
    let degrees: f64 = 14.0;
    let row = Rollers::new(RollerGeometry {
        number: 17,
        diameter: 8.0 * MM,
        length: 15.0 * MM,
        pitch_diameter: 62.0 * MM,
        contact_angle: degrees.to_radians(),
        clearance: 0.0,
        profile,
        ..fourteen_rollers()
    });
    let many = ManyElements {
        number: 17.0,
        stiffness: row.stiffness(),
        contact_angle: degrees.to_radians(),
        contact: Contact::Line,
    };
    (row, many)
}

/// Straight rollers have no other difference than their number.
#[test]
fn straight_rollers_are_as_very_many() {
    let (row, many) = tapered(Profile::Straight);
    for (thrust, radial) in [(300.0, 0.0), (10_000.0, 0.0), (1000.0, 2000.0), (3000.0, 6000.0)] {
        assert_close(over_many(&row, &many, thrust, radial), 1.0, 1e-6);
    }
}

/// What the fixed angle and the missing profile do, as the documents state it: the angle of balls grows with the load, the ends of rollers carry
/// less.
#[test]
fn angles_that_grow_and_profiles_change_the_displacement() {
    for (degrees, light, heavy) in [(15.0, 0.787, 0.673), (25.0, 0.931, 0.874), (40.0, 0.982, 0.965)] {
        let (row, many) = balls(degrees);
        assert_close(over_many(&row, &many, 1000.0, 0.0), light, 1e-3);
        assert_close(over_many(&row, &many, 3000.0, 0.0), heavy, 1e-3);
    }
    let (row, many) = tapered(Profile::Logarithmic);
    for (thrust, expected) in [(1000.0, 2.323), (3000.0, 1.770), (10_000.0, 1.367)] {
        assert_close(over_many(&row, &many, thrust, 0.0), expected, 1e-3);
    }
}
