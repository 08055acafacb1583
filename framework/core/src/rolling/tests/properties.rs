//! Properties of any bearing under any load.

use super::*;
use proptest::prelude::*;

/// Moments over the radius of the row, so that all loads have one unit.
fn largest(load: [f64; 5], radius: f64) -> f64 {
    let [axial, y, z, of_y, of_z] = load;
    [axial, y, z, of_y / radius, of_z / radius]
        .into_iter()
        .fold(0.0, |most, part| most.max(part.abs()))
}

/// The resultant of the elements, summed independently of the solver from their loads and angles.
fn resultant(bearing: &Balls, found: &Equilibrium) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (ball, [cos, sin]) in bearing.loads(&found.displacement).zip(bearing.directions()) {
        let (load, angle) = (ball.load[0], ball.angle[0]);
        sum[0] += load * angle.sin();
        sum[1] += load * angle.cos() * cos;
        sum[2] += load * angle.cos() * sin;
    }
    sum
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Balls under loads in all five directions: residual 1e-10 of the load, also by an independent sum.
    #[test]
    fn ball_bearings_balance(
        number in 5..30_usize, angle in 0.0..0.7_f64, clearance in -10.0..40.0_f64,
        axial in 10.0..5000.0_f64, y in -3000.0..3000.0_f64, z in -3000.0..3000.0_f64, moment in -2.0..2.0_f64,
    ) {
        // Enough thrust for a bearing that takes it in one direction.
        let axial = axial + 1.3 * angle.tan() * y.hypot(z) + 100.0 * moment.abs();
        let bearing = Balls::new(BallGeometry {
            number,
            contact_angle: angle,
            clearance: if angle == 0.0 { clearance * UM } else { 0.0 },
            ..seven_balls(0.0)
        });
        let load = |x| Given::Load(x);
        let given = Axes { axial: load(axial), radial: [load(y), load(z)], tilt: [load(moment), load(0.5 * moment)] };
        let found = balanced(&bearing, given);
        let wanted = [axial, y, z, moment, 0.5 * moment];
        let size = largest(wanted, bearing.radius());
        prop_assert!(found.residual <= 1e-10 * size, "{} of {size}", found.residual);
        for (got, wanted) in found.load.array().into_iter().zip(wanted) {
            prop_assert!((got - wanted).abs() <= 1e-10 * size, "{got} {wanted}");
        }
        for (got, wanted) in resultant(&bearing, &found).into_iter().zip(wanted) {
            prop_assert!((got - wanted).abs() <= 1e-9 * size, "{got} {wanted}");
        }
    }

    /// The other way around: clearance with a radial and a small axial load.
    #[test]
    fn deep_groove_bearings_balance(clearance in -20.0..60.0_f64, radial in 1e-3..1e5_f64, axial in -1e4..1e4_f64) {
        let bearing = Balls::new(seven_balls(clearance * UM));
        for axial in [0.0, axial, 1e-6 * axial] {
            let found = balanced(&bearing, Axes::loaded(axial, radial));
            prop_assert!(found.residual <= 1e-10 * radial.max(axial.abs()), "{}", found.residual);
        }
    }

    /// Rollers with profile, clearance and moments.
    #[test]
    fn roller_bearings_balance(
        number in 8..40_usize, clearance in -10.0..60.0_f64, radial in 1.0..1e5_f64, tilt in -2e-3..2e-3_f64,
    ) {
        let bearing = Rollers::new(RollerGeometry { number, clearance: clearance * UM, ..fourteen_rollers() });
        let found = balanced(&bearing, Axes::loaded(0.0, radial).with_tilt(tilt));
        prop_assert!(found.residual <= 1e-10 * radial, "{}", found.residual);
        // The moment that this tilt needs gives the tilt again.
        let moment = found.load.tilt[0];
        let again = balanced(&bearing, Axes::loaded(0.0, radial).with_moment(moment));
        let slope = again.displacement.tilt[0];
        prop_assert!((slope - tilt).abs() <= 1e-6 * tilt.abs() + 1e-9, "{slope} {tilt}");
    }

    /// In a mirror, along the axis or across the load, everything is mirrored.
    #[test]
    fn mirrored_loads_have_mirrored_displacements(
        clearance in 0.0..30.0_f64, axial in 1.0..3000.0_f64, y in 1.0..3000.0_f64, z in -3000.0..3000.0_f64, moment in -3.0..3.0_f64,
    ) {
        let bearing = Balls::new(seven_balls(clearance * UM));
        let load = |[axial, y, z, moment]: [f64; 4]| Axes {
            axial: Given::Load(axial),
            radial: [Given::Load(y), Given::Load(z)],
            tilt: [Given::Load(moment), Given::Load(0.0)],
        };
        let one = balanced(&bearing, load([axial, y, z, moment])).displacement.array();
        let along = balanced(&bearing, load([-axial, y, z, -moment])).displacement.array();
        let across = balanced(&bearing, load([axial, y, -z, moment])).displacement.array();
        for i in 0..5 {
            let size = if i < 3 { 1e-5 } else { 1e-3 };
            let along_sign = [-1.0, 1.0, 1.0, -1.0, -1.0][i];
            let across_sign = [1.0, 1.0, -1.0, 1.0, -1.0][i];
            prop_assert!((along[i] - along_sign * one[i]).abs() < 1e-7 * size, "{i}: {along:?} {one:?}");
            prop_assert!((across[i] - across_sign * one[i]).abs() < 1e-7 * size, "{i}: {across:?} {one:?}");
        }
    }

    /// The work of the loads is stored: the stiffness is symmetric, so that a thrust moves the ring across as much as a radial load moves it
    /// along.
    #[test]
    fn displacements_are_reciprocal(angle in 0.1..0.7_f64, axial in 500.0..3000.0_f64, radial in 10.0..300.0_f64) {
        let bearing = Balls::new(BallGeometry { contact_angle: angle, ..seven_balls(0.0) });
        let at = |axial: f64, radial: f64| balanced(&bearing, Axes::loaded(axial, radial).with_moment(0.0)).displacement;
        let step = 0.01;
        let across = at(axial + step, radial).radial[0] - at(axial - step, radial).radial[0];
        let along = at(axial, radial + step).axial - at(axial, radial - step).axial;
        prop_assert!((across - along).abs() <= 1e-4 * along.abs() + 1e-15, "{across} {along}");
    }

    /// Speed changes the sides: loads at high speed balance too, and the outer contact carries more than the inner one.
    #[test]
    fn fast_bearings_balance(rpm in 0.0..20_000.0_f64, axial in 2000.0..10_000.0_f64, radial in 0.0..3000.0_f64) {
        let bearing = Balls::new(BallGeometry { contact_angle: 0.436, number: 12, pitch_diameter: 60e-3, ..seven_balls(0.0) });
        let row = bearing.at_speed(rpm * std::f64::consts::PI / 30.0);
        let found = balanced(&row, Axes::loaded(axial, radial));
        prop_assert!(found.residual <= 1e-10 * axial, "{}", found.residual);
        for ball in row.loads(&found.displacement) {
            let [inner, outer] = ball.contacts.load;
            prop_assert!(outer >= inner * (1.0 - 1e-9), "{inner} {outer}");
        }
    }
}
