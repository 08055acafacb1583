//! Integrals of Sjoevall.

use super::*;
use crate::testing::assert_close;

/// Quadrature of SciPy; catalogues print J_r and J_a with four digits.
#[test]
fn integrals_of_sjoevall() {
    for (zone, point, line) in [
        (0.2, [0.159_037_526, 0.170_672_024], [0.173_174_513, 0.187_918_847]),
        (0.5, [0.228_827_929, 0.278_208_947], [0.244_798_559, 0.307_964_164]),
        (0.8, [0.255_902_442, 0.365_849_353], [0.265_492_329, 0.408_441_637]),
        (1.0, [0.254_647_909, 0.424_413_182], [0.252_530_063, 0.479_807_119]),
        (2.5, [0.133_899_426, 0.723_951_956], [0.108_305_270, 0.781_924_380]),
    ] {
        for (contact, [j_r, j_a]) in [(Contact::Point, point), (Contact::Line, line)] {
            let [axial, radial] = load_integral(zone, contact.exponent());
            assert_close(radial, j_r, 1e-8);
            assert_close(axial, j_a, 1e-8);
        }
    }
    assert_eq!(
        load_integral(f64::INFINITY, 1.5).map(|j| (1e12 * j).round()),
        [1e12, 0.0]
    );
    assert_eq!(load_integral(0.0, 1.5), [0.0; 2]);
}

/// The factors of Q_max and of the thrust in a half loaded zone, which NSK prints as 4.37, 4.08, 1.216, 1.260.
#[test]
fn half_a_zone() {
    for (contact, greatest, thrust) in [
        (Contact::Point, 4.370_096, 1.215_800),
        (Contact::Line, 4.084_991, 1.258_031),
    ] {
        let [axial, radial] = load_integral(0.5, contact.exponent());
        assert_close(1.0 / radial, greatest, 1e-6);
        assert_close(axial / radial, thrust, 1e-6);
    }
    // The most loaded of fourteen rollers under 5 kN.
    let [_, radial] = load_integral(0.5, Contact::Line.exponent());
    assert_close(5000.0 / (14.0 * radial), 1458.9255, 5e-8);
}

/// Load zones of single angular contact bearings under the thrust that catalogues take as their least: Fa = 0.50, 0.57, 0.66, 0.88 Fr.
#[test]
fn zones_of_catalogues() {
    for (degrees, thrust, expected) in [
        (20.0, 0.50, 0.735),
        (25.0, 0.57, 0.512),
        (30.0, 0.66, 0.360),
        (40.0, 0.88, 0.137),
    ] {
        let row = ManyElements {
            number: 12.0,
            stiffness: 1e9,
            contact_angle: f64::to_radians(degrees),
            contact: Contact::Point,
        };
        let zone = row.zone(1000.0, 1000.0 * thrust).unwrap_or_default();
        assert!((zone - expected).abs() < 0.0005, "{degrees}: {zone}");
    }
}

/// Bearings with very many balls or rollers and no clearance.
#[test]
fn many_elements_are_an_integral() {
    for number in [40, 200, 1000] {
        let balls = Balls::new(BallGeometry {
            number,
            diameter: 1.0 * MM,
            pitch_diameter: 500.0 * MM,
            ..seven_balls(0.0)
        });
        let found = balanced(&balls, Axes::loaded(0.0, 1000.0));
        let greatest = balls.loads(&found.displacement).next().unwrap_or_default().load[0];
        assert_close(
            greatest * number as f64 / 1000.0,
            4.370_096,
            30.0 / (number * number) as f64,
        );
        let rollers = Rollers::new(RollerGeometry {
            number,
            clearance: 0.0,
            profile: Profile::Straight,
            ..fourteen_rollers()
        });
        let found = balanced(&rollers, Axes::loaded(0.0, 5000.0));
        let greatest = rollers.loads(&found.displacement).next().unwrap_or_default().load;
        assert_close(
            greatest * number as f64 / 5000.0,
            4.084_991,
            30.0 / (number * number) as f64,
        );
    }
}

/// Tapered rollers under both loads, for which the contact angle does not change.
#[test]
fn many_tapered_rollers_are_an_integral() {
    let angle = 20.0_f64.to_radians();
    let rollers = Rollers::new(RollerGeometry {
        number: 300,
        contact_angle: angle,
        clearance: 0.0,
        profile: Profile::Straight,
        ..fourteen_rollers()
    });
    let many = ManyElements {
        number: 300.0,
        stiffness: rollers.stiffness(),
        contact_angle: angle,
        contact: Contact::Line,
    };
    for axial in [2500.0, 3000.0, 6000.0] {
        let found = balanced(&rollers, Axes::loaded(axial, 5000.0));
        let thrust = many.thrust(5000.0, found.displacement.axial).unwrap_or_default();
        assert_close(thrust, axial, 1e-4);
        let shift = found.displacement.axial * angle.tan() / found.displacement.radial[0];
        assert_close(many.zone(5000.0, axial).unwrap_or_default(), 0.5 * (1.0 + shift), 1e-4);
    }
    assert_eq!(many.zone(5000.0, 0.9 * 5000.0 * angle.tan()), None);
}
