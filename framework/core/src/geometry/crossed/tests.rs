//! Published examples of ISO 23509 annex F and ISO/TR 10300-30, limits, and properties over random pairs.
#![allow(clippy::unwrap_used)]

use std::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;

use super::*;
use crate::contact::path::Path;
use crate::geometry::{LoadSharing, Pair, PairSpec};

const DEG: f64 = PI / 180.0;
const RPM: f64 = PI / 30.0;

fn close(value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value - expected).abs() <= tolerance * expected.abs().max(1e-9),
        "{value} against {expected}"
    );
}

/// Compares lengths in mm and angles in degrees, to the digits that are printed.
fn all(values: &[f64], printed: &[f64], tolerance: f64) {
    assert_eq!(values.len(), printed.len());
    for (value, printed) in values.iter().zip(printed) {
        close(*value, *printed, tolerance);
    }
}

fn degrees(angles: &[f64]) -> Vec<f64> {
    angles.iter().map(|angle| angle / DEG).collect()
}

fn millimetres(lengths: &[f64]) -> Vec<f64> {
    lengths.iter().map(|length| length * 1e3).collect()
}

/// A published example: cones, blank, design pressure angle and the share of the limit pressure angle in the cutter.
struct Example {
    cones: PitchCones,
    blank: Blank,
    pressure: (f64, f64),
}

impl Example {
    fn pair(&self, flank: Flank) -> VirtualPair {
        VirtualPair::new(&self.cones, &self.blank, self.pressure, flank)
    }

    fn path(&self, flank: Flank) -> ToothPath {
        let frame = MeanPoint::new(&self.cones);
        let pair = self.pair(flank);
        let normal = frame.flank_normal(pair.pressure_angle, flank);
        ToothPath::new(&frame, normal, pair.to_tip, (pair.base_helix, pair.inclination))
    }

    /// Mean sliding over the speed, by the arm of the normal force.
    fn loss_factor(&self, flank: Flank) -> f64 {
        self.path(flank).mean_sliding() / self.arm(flank)
    }

    fn arm(&self, flank: Flank) -> f64 {
        let [radius, _] = self.cones.radius;
        radius * self.pair(flank).pressure_angle.cos() * self.cones.spiral_angle[0].cos()
    }

    /// Efficiency with friction in the balance of forces, first gear driving.
    fn efficiency(&self, friction: f64) -> f64 {
        let path = self.path(Flank::Drive);
        1.0 - friction * path.mean_sliding() / (self.arm(Flank::Drive) + friction * path.mean_friction_arm())
    }
}

fn depth(wheel_addendum: f64, [addendum_angle, dedendum_angle]: [f64; 2]) -> Depth {
    Depth {
        working: 2.0,
        clearance: 0.125,
        wheel_addendum,
        addendum_angle: addendum_angle * DEG,
        dedendum_angle: dedendum_angle * DEG,
    }
}

/// Spiral bevel pair 14/39.
fn f2() -> Example {
    let cones = PitchCones::bevel([14, 39], FRAC_PI_2, Size::Outer(176.893e-3), 25.4e-3, 35.0 * DEG);
    Example {
        blank: Blank::new(&cones, &depth(0.24737, [2.1342, 6.4934]), 25.4e-3, Some(176.893e-3)),
        cones,
        pressure: (20.0 * DEG, 0.0),
    }
}

const GLEASON: Closure = Closure::LimitRadius {
    cutter_radius: 63.5e-3,
    blade_groups: 0,
};

fn gleason(size: Size, spiral_angle: f64) -> PitchCones {
    let pinion = SpiralAngle::Pinion(spiral_angle * DEG);
    PitchCones::hypoid([13, 42], (FRAC_PI_2, 15e-3), (size, 30e-3), pinion, GLEASON).unwrap()
}

/// Hypoid pair 13/42 by method 1. The spiral angle is the one that the standard reaches instead of the 50 degrees that are wanted.
fn f3() -> Example {
    let cones = gleason(Size::OuterOfStandard(170e-3), 49.99814);
    Example {
        blank: Blank::new(&cones, &depth(0.35, [1.0, 4.0]), 30e-3, Some(170e-3)),
        cones,
        pressure: (20.0 * DEG, 1.0),
    }
}

/// Hypoid pair 12/49 by method 3.
fn f5() -> Example {
    let closure = Closure::Palloid {
        cutter_radius: 135e-3,
        blade_groups: 5,
    };
    let wheel = SpiralAngle::Wheel(30.0 * DEG);
    let size = (Size::Outer(400e-3), 60e-3);
    let cones = PitchCones::hypoid([12, 49], (FRAC_PI_2, 40e-3), size, wheel, closure).unwrap();
    let depth = Depth {
        clearance: 0.125,
        ..depth(0.4, [0.0, 0.0])
    };
    Example {
        blank: Blank::new(&cones, &depth, 60e-3, None),
        cones,
        pressure: (19.0 * DEG, 0.0),
    }
}

#[test]
fn cones_of_the_bevel_example() {
    let Example { cones, blank, .. } = f2();
    all(&degrees(&cones.pitch_angle), &[19.74684, 70.25316], 1e-6);
    all(&millimetres(&cones.cone_distance()), &[81.27259; 2], 1e-6);
    close(cones.normal_module() * 1e3, 3.21332, 1e-5);
    all(&millimetres(&cones.crossing_to_mean_point()), &[76.4933, 27.4591], 1e-5);
    // That of the pinion is 2 um above the printed one, whose angles are rounded.
    all(&millimetres(&blank.tip_diameter), &[75.324, 178.288], 3e-5);
    close(blank.facewidth[0], 25.4e-3, 1e-12);
}

#[test]
fn cones_of_the_hypoid_example_of_method_1() {
    let Example { cones, blank, .. } = f3();
    all(&degrees(&cones.pitch_angle), &[21.28775, 68.32393], 1e-6);
    all(&degrees(&cones.spiral_angle), &[49.99814, 38.60855], 1e-6);
    all(&millimetres(&cones.cone_distance()), &[73.52116, 76.33662], 1e-6);
    all(
        &degrees(&[cones.offset_angle(), cones.limit_pressure_angle()]),
        &[11.38959, -2.25354],
        2e-6,
    );
    close(cones.normal_module() * 1e3, 2.63968, 2e-6);
    // Printed after a stop within 1 %.
    all(&millimetres(&cones.crossing_to_mean_point()), &[69.727, 26.621], 5e-4);
    all(&millimetres(&cones.apex_beyond_crossing()), &[-1.225, 1.576], 2e-2);
    all(&millimetres(&blank.facewidth), &[31.9102, 30.0], 2e-5);
    all(&millimetres(&blank.tip_diameter), &[73.5277, 171.5601], 2e-5);
    // With the wanted spiral angle exactly, and with the mean point in the middle of the face.
    let exact = gleason(Size::OuterOfStandard(170e-3), 50.0);
    all(&degrees(&exact.pitch_angle), &[21.28797443, 68.32370047], 1e-9);
    close(exact.offset_angle() / DEG, 11.38957651, 1e-8);
    let middle = gleason(Size::Outer(170e-3), 50.0);
    all(&degrees(&middle.pitch_angle), &[21.30215818, 68.31065785], 1e-9);
    close(middle.offset_angle() / DEG, 11.37005912, 1e-8);
    close(middle.radius[1] * 1e3, 71.06197999, 1e-9);
}

#[test]
fn cones_of_the_hypoid_example_of_method_2_from_its_pitch_angle() {
    let angles = SpiralAngle::Wheel(21.009 * DEG);
    let closure = Closure::WheelPitchAngle(63.13207 * DEG);
    let cones = PitchCones::hypoid(
        [9, 34],
        (FRAC_PI_2, 31.75e-3),
        (Size::Mean(146.7e-3), 26e-3),
        angles,
        closure,
    )
    .unwrap();
    all(&degrees(&cones.pitch_angle), &[24.83764, 63.13207], 5e-3);
    close(cones.offset_angle() / DEG, 23.97087, 5e-3);
    all(&millimetres(&cones.cone_distance()), &[61.02327, 82.22627], 5e-3);
    close(cones.normal_module() * 1e3, 4.02788, 2e-6);
    close(cones.limit_pressure_angle() / DEG, -4.10272, 2e-2);
}

#[test]
fn cones_of_the_hypoid_example_of_method_3() {
    let Example { cones, .. } = f5();
    all(&degrees(&cones.pitch_angle), &[18.19992, 71.35950], 1e-6);
    all(&degrees(&cones.spiral_angle), &[42.92185, 30.0], 1e-6);
    all(&millimetres(&cones.cone_distance()), &[159.09945, 181.07228], 1e-6);
    close(cones.limit_pressure_angle() / DEG, -1.73173, 1e-5);
    close(cones.normal_module() * 1e3, 6.06478, 2e-6);
}

#[test]
fn virtual_pairs_of_the_examples() {
    let pair = f2().pair(Flank::Drive);
    all(&millimetres(&pair.diameter), &[58.34955, 452.80442], 1e-6);
    all(
        &degrees(&[pair.transverse_angle, pair.base_helix]),
        &[23.95680, 32.61461],
        1e-6,
    );
    close((pair.to_tip[0] + pair.to_tip[1]) * 1e3, 13.11983, 1e-6);
    all(&[pair.contact_ratio, pair.overlap_ratio], &[1.16497, 1.22671], 5e-6);
    close(pair.relative_radius * 1e3, 12.45859, 1e-6);
    close(pair.inclination / DEG, 13.46783, 1e-6);
    let pair = f3().pair(Flank::Drive);
    all(&millimetres(&pair.diameter), &[57.29318, 384.11781], 1e-6);
    all(
        &degrees(&[pair.transverse_angle, pair.base_helix]),
        &[26.95723, 41.02095],
        1e-6,
    );
    close((pair.to_tip[0] + pair.to_tip[1]) * 1e3, 10.43451, 1e-6);
    all(&[pair.contact_ratio, pair.overlap_ratio], &[1.01024, 2.09551], 5e-6);
    close(pair.facewidth * 1e3, 24.88005, 1e-6);
    close(pair.relative_radius * 1e3, 17.92617, 1e-6);
    close(pair.inclination / DEG, 18.45914, 1e-6);
    let pair = f5().pair(Flank::Drive);
    all(&millimetres(&pair.diameter), &[104.61801, 1073.58002], 1e-6);
    close((pair.to_tip[0] + pair.to_tip[1]) * 1e3, 25.09897, 1e-6);
    all(&[pair.contact_ratio, pair.overlap_ratio], &[1.17093, 1.53644], 5e-6);
    close(pair.facewidth * 1e3, 49.25981, 1e-6);
    close(pair.relative_radius * 1e3, 28.39731, 1e-6);
    close(pair.inclination / DEG, 14.65831, 1e-6);
}

/// Without offset the relative radius is that of the virtual pair.
#[test]
fn without_offset_the_curvature_is_that_of_cylinders() {
    let pair = f2().pair(Flank::Drive);
    let [first, second] = pair.diameter.map(|d| 0.5 * d * pair.transverse_angle.sin());
    close(
        first * second / (first + second) / pair.base_helix.cos(),
        pair.relative_radius,
        1e-12,
    );
}

#[test]
fn velocities_of_the_examples() {
    for (example, sliding, turning, rolling) in [
        (f2(), 0.0, 0.894942, [11.14972, 11.14972]),
        (f3(), 6.745500, 0.708372, [11.43477, 9.29895]),
        (f5(), 12.83132, 0.777548, [20.02485, 16.77783]),
    ] {
        let frame = MeanPoint::new(&example.cones);
        let pair = example.pair(Flank::Drive);
        let normal = frame.flank_normal(pair.pressure_angle, Flank::Drive);
        assert!((frame.sliding().norm() * 1e3 - sliding).abs() < 1e-5 * sliding.max(1e-6));
        assert!(frame.sliding().dot(&normal).abs() < 1e-15);
        close(frame.turning().cross(&normal).norm(), turning, 1e-6);
        let speeds = example.path(Flank::Drive).rolling(0.0).map(f64::abs);
        all(&millimetres(&speeds), &rolling, 1e-6);
    }
    let coast = f3();
    let frame = MeanPoint::new(&coast.cones);
    let pair = coast.pair(Flank::Coast);
    let normal = frame.flank_normal(pair.pressure_angle, Flank::Coast);
    close(frame.turning().cross(&normal).norm(), 0.780076, 1e-6);
    let speeds = coast.path(Flank::Coast).rolling(0.0).map(f64::abs);
    all(&millimetres(&speeds), &[12.63750, 10.50169], 1e-6);
}

#[test]
fn losses_of_the_examples() {
    close(f2().loss_factor(Flank::Drive), 0.193043, 3e-6);
    close(f3().loss_factor(Flank::Drive), 0.463247, 2e-6);
    close(f3().loss_factor(Flank::Coast), 0.494836, 2e-6);
    close(f5().loss_factor(Flank::Drive), 0.425387, 2e-6);
    close(f2().path(Flank::Drive).mean_friction_arm() * 1e3, 7.886106, 1e-5);
    close(f3().path(Flank::Drive).mean_friction_arm() * 1e3, 20.348719, 1e-6);
    close(f5().path(Flank::Drive).mean_friction_arm() * 1e3, 33.484704, 1e-6);
    for (example, friction, efficiency) in [
        (f2(), 0.05, 0.99052460),
        (f3(), 0.05, 0.97819524),
        (f5(), 0.05, 0.97971760),
        (f2(), 0.03, 0.99427280),
        (f3(), 0.03, 0.98660306),
        (f2(), 0.08, 0.98500413),
        (f3(), 0.08, 0.96629760),
    ] {
        close(example.efficiency(friction), efficiency, 2e-8);
    }
}

/// The published forces of the hypoid example, and the balance of power with friction.
#[test]
fn forces_of_the_hypoid_example() {
    let example = f3();
    let frame = MeanPoint::new(&example.cones);
    let pair = example.pair(Flank::Drive);
    close(pair.pressure_angle / DEG, 17.74646, 1e-6);
    // A right-hand pinion drives on its concave flank if it turns backwards about the axis from apex to base.
    let normal = frame.flank_normal(pair.pressure_angle, Flank::Drive);
    let turns = -frame.torque_of(0, normal).signum();
    let without = frame.force(250.0 * turns, turns, normal, 0.0).unwrap();
    close(without.normal, 15298.49, 1e-6);
    close(frame.parts(0, without.on_first)[2].abs(), 9366.101, 1e-6);
    let force = frame.force(250.0 * turns, turns, normal, 0.05).unwrap();
    close(force.normal, 14397.754459, 2e-7);
    let [axial, outwards, along] = frame.parts(0, force.on_first);
    all(
        &[axial, outwards, along.abs()],
        &[10949.566790, -443.514616, 9366.101307],
        1e-6,
    );
    let on_wheel = -force.on_first;
    let [axial, outwards, along] = frame.parts(1, on_wheel);
    all(
        &[axial, outwards, along.abs()],
        &[1125.503159, -9049.739190, 11164.633224],
        1e-6,
    );
    let speed = 1200.0 * RPM * turns;
    let torque = frame.torque_of(1, on_wheel);
    close(torque.abs(), 792.003684, 1e-7);
    let output = torque * speed * frame.speed_ratio;
    let input = 250.0 * turns * speed;
    let friction = 0.05 * force.normal * frame.sliding().norm() * speed.abs();
    close(output, 30805.703255, 1e-7);
    close(friction, 610.223280, 1e-6);
    close(input - output, friction, 1e-10);
}

#[test]
fn forces_of_bevel_gears() {
    let example = f2();
    let frame = MeanPoint::new(&example.cones);
    for (flank, pinion) in [
        (Flank::Drive, [0.8091536, -0.1816215]),
        (Flank::Coast, [-0.5089096, -0.6547723]),
    ] {
        let normal = frame.flank_normal(example.pair(flank).pressure_angle, flank);
        let turns = -frame.torque_of(0, normal).signum();
        let force = frame.force(turns, turns, normal, 0.0).unwrap().on_first;
        let [axial, outwards, along] = frame.parts(0, force);
        all(&[axial / along.abs(), outwards / along.abs()], &pinion, 3e-7);
        // At right angles what is axial for one gear is radial for the other.
        let [of_wheel, ..] = frame.parts(1, -force);
        close(of_wheel, -outwards, 1e-12);
    }
}

#[test]
fn crossed_helical_teeth() {
    let cylinders = PitchCones::cylinders([15, 30], 3e-3, [45.0 * DEG, -45.0 * DEG]);
    all(&millimetres(&cylinders.radius), &[31.81980515, 63.63961031], 1e-9);
    close(cylinders.shaft_angle / DEG, 90.0, 1e-12);
    let frame = MeanPoint::new(&cylinders);
    close(frame.sliding().norm() * 1e3, 45.0, 1e-12);
    let normal = frame.flank_normal(20.0 * DEG, Flank::Drive);
    close(frame.turning().cross(&normal).norm(), 1.06753090, 1e-8);
    for (friction, efficiency) in [(0.05, 0.8989585272), (0.1, 0.8076354530)] {
        let turns = -frame.torque_of(0, normal).signum();
        let force = frame.force(turns, turns, normal, friction).unwrap();
        let output = -frame.torque_of(1, force.on_first) * turns * frame.speed_ratio;
        close(output, efficiency, 1e-9);
    }
}

/// A worm drives its wheel; the wheel does not drive the worm once friction exceeds the lead.
#[test]
fn a_worm_locks_itself() {
    let lead = 4.0 * DEG;
    let worm = PitchCones::cylinders([1, 40], 3e-3, [FRAC_PI_2 - lead, -lead]);
    let frame = MeanPoint::new(&worm);
    close(frame.sliding().norm(), worm.radius[0] / lead.cos(), 1e-12);
    let efficiency = |friction: f64| {
        let normal = frame.flank_normal(20.0 * DEG, Flank::Drive);
        let turns = -frame.torque_of(0, normal).signum();
        let force = frame.force(turns, turns, normal, friction).unwrap();
        -frame.torque_of(1, force.on_first) * turns * frame.speed_ratio
    };
    let [alpha, friction] = [20.0 * DEG, 0.05_f64];
    let formula = (alpha.cos() - friction * lead.tan()) / (alpha.cos() + friction / lead.tan());
    close(efficiency(friction), formula, 1e-12);
    // Driven by the wheel, the worm turns against the torque with which its shaft holds it, on the other flank.
    let locks = |friction: f64| {
        let normal = frame.flank_normal(alpha, Flank::Coast);
        let turns = frame.torque_of(0, normal).signum();
        frame.force(-turns, turns, normal, friction).is_none()
    };
    assert!(!locks(0.0) && !locks(0.9 * lead.tan() * alpha.cos()));
    assert!(locks(1.1 * lead.tan() * alpha.cos()));
}

/// At a shaft angle of zero sliding and rolling are those of a cylindrical pair.
#[test]
fn parallel_axes_are_the_cylindrical_limit() {
    let helix = 25.0 * DEG;
    let spec = PairSpec {
        z: [31, 96],
        internal: false,
        normal_module: 2e-3,
        pressure_angle: 20.0 * DEG,
        helix_angle: helix,
        centre_distance: None,
        profile_shift: [Some(0.0); 2],
        tip_diameter: [None; 2],
        root_diameter: [None; 2],
        facewidth: 30e-3,
        tip_shortening: false,
    };
    let pair = Pair::new(&spec).unwrap();
    let cylinders = PitchCones::cylinders([31, 96], 2e-3, [helix, helix]);
    let frame = MeanPoint::new(&cylinders);
    let normal = frame.flank_normal(20.0 * DEG, Flank::Drive);
    let [start, _, pitch_point, _, end] = pair.points;
    let base_helix = (helix.sin() * (20.0 * DEG).cos()).asin();
    let path = ToothPath::new(
        &frame,
        normal,
        [end - pitch_point, pitch_point - start],
        (base_helix, (helix.tan() * (20.0 * DEG).sin()).atan()),
    );
    assert!(frame.sliding().norm() < 1e-17);
    for x in [start, 0.5 * (start + pitch_point), end] {
        let s = (pitch_point - x) / base_helix.cos();
        close(path.sliding(s).norm(), pair.sliding(x), 1e-12);
        let [first, second] = path.rolling(s);
        close((first + second).abs(), pair.sum_speed(x), 1e-12);
    }
    let even =
        0.5 * (1.0 + 31.0 / 96.0) * ((end - pitch_point).powi(2) + (pitch_point - start).powi(2)) / (end - start);
    close(path.mean_sliding(), even, 1e-12);
}

proptest! {
    /// Cones from any data touch along the axes that they were found for: shaft angle, offset and power.
    #[test]
    fn frames_have_the_axes(
        first in 5.0..40.0_f64,
        second in 30.0..80.0_f64,
        offset_angle in -30.0..30.0_f64,
        spiral in -45.0..45.0_f64,
        radius in 0.02..0.2_f64,
        teeth in (8_u32..20, 25_u32..60),
    ) {
        let [first, second, offset_angle, spiral] = [first, second, offset_angle, spiral].map(|x| x * DEG);
        let spiral_angle = [spiral + offset_angle, spiral];
        let pinion = radius * spiral_angle[1].cos() / spiral_angle[0].cos() * f64::from(teeth.0) / f64::from(teeth.1);
        let cones = PitchCones {
            z: [teeth.0, teeth.1],
            shaft_angle: (first.cos() * second.cos() * offset_angle.cos() - first.sin() * second.sin()).acos(),
            offset: 0.0,
            pitch_angle: [first, second],
            spiral_angle,
            radius: [pinion, radius],
        };
        let frame = MeanPoint::new(&cones);
        prop_assert!((frame.axis[0].dot(&frame.axis[1]).acos() - cones.shaft_angle).abs() < 1e-12);
        let common = frame.axis[0].cross(&frame.axis[1]);
        let offset = common.normalize().dot(&(frame.foot[1] - frame.foot[0]));
        let expected = (pinion * second.cos() + radius * first.cos()) * offset_angle.sin() / cones.shaft_angle.sin();
        prop_assert!((offset.abs() - expected.abs()).abs() < 1e-12);
        // The teeth stay in contact, and friction takes the power that is missing.
        for flank in [Flank::Drive, Flank::Coast] {
            let normal = frame.flank_normal(20.0 * DEG, flank);
            prop_assert!(frame.sliding().dot(&normal).abs() < 1e-12);
            let turns = -frame.torque_of(0, normal).signum();
            let force = frame.force(turns, turns, normal, 0.06).unwrap();
            let output = -frame.torque_of(1, force.on_first) * turns * frame.speed_ratio;
            let lost = 0.06 * force.normal * frame.sliding().norm();
            prop_assert!((1.0 - output - lost).abs() < 1e-12);
        }
    }

    /// A hypoid pair whose offset vanishes is the bevel pair.
    #[test]
    fn a_vanishing_offset_gives_a_bevel_pair(teeth in (9_u32..20, 30_u32..50), spiral in 0.0..45.0_f64) {
        let z = [teeth.0, teeth.1];
        let size = (Size::Outer(0.18), 0.025);
        let bevel = PitchCones::bevel(z, FRAC_PI_2, size.0, size.1, spiral * DEG);
        let closure = Closure::WheelPitchAngle(bevel.pitch_angle[1]);
        let stated = SpiralAngle::Pinion(spiral * DEG);
        let cones = PitchCones::hypoid(z, (FRAC_PI_2, 1e-9), size, stated, closure).unwrap();
        for i in 0..2 {
            prop_assert!((cones.pitch_angle[i] - bevel.pitch_angle[i]).abs() < 1e-7);
            prop_assert!((cones.radius[i] / bevel.radius[i] - 1.0).abs() < 1e-7);
            prop_assert!((cones.spiral_angle[i] - bevel.spiral_angle[i]).abs() < 1e-7);
        }
    }
}

/// The flanks of a pair as two surfaces with a path of contact.
fn flanks(example: &Example, flank: Flank) -> Pair {
    Pair::bevel(&example.cones, &example.blank, example.pressure, flank).unwrap()
}

#[test]
fn flanks_have_the_velocities_curvature_and_losses_of_the_examples() {
    for (example, flank, lengthwise, rolling, radius, factor) in [
        (f2(), Flank::Drive, 0.0, 2.0 * 11.14972, 12.45859, 0.193043),
        (f3(), Flank::Drive, 6.745500, 11.43477 + 9.29895, 17.92617, 0.463247),
        (f3(), Flank::Coast, 6.745500, 12.63750 + 10.50169, 0.0, 0.494836),
        (f5(), Flank::Drive, 12.83132, 20.02485 + 16.77783, 28.39731, 0.425387),
    ] {
        let pair = flanks(&example, flank);
        let pitch = pair.points[2];
        for sliding in [pair.lengthwise_sliding(), pair.sliding(pitch)] {
            assert!((sliding * 1e3 - lengthwise).abs() < 2e-6 * lengthwise + 1e-12);
        }
        close(pair.sum_speed(pitch) * 1e3, rolling, 1e-6);
        close(
            2.0 * pair.sin_working_angle * pair.working_radius[0] * 1e3,
            rolling,
            1e-6,
        );
        if radius > 0.0 {
            close(pair.relative_radius(pitch) * 1e3, radius, 1e-6);
        }
        // Friction over even load, by quadrature and in closed form.
        let path = Path::new(&pair, LoadSharing::Uniform, 24).unwrap();
        let arm = pair.base_radius[0] * pair.cos_base_helix;
        close(
            arm,
            example.cones.radius[0] * pair.pressure_angle.cos() * example.cones.spiral_angle[0].cos(),
            1e-12,
        );
        let one = vec![1.0; path.len()];
        close(path.sliding(&one) / arm, factor, 3e-6);
        let closed = example.path(flank);
        close(path.sliding(&one), closed.mean_sliding(), 1e-9);
        close(path.friction_arm(&one, None), closed.mean_friction_arm(), 1e-7);
    }
}

/// Without an offset the loss factor is that of the virtual cylindrical gears with an evenly shared load.
#[test]
fn without_offset_the_loss_factor_is_that_of_virtual_gears() {
    for spiral in [0.0, 35.0] {
        let cones = PitchCones::bevel([14, 39], FRAC_PI_2, Size::Outer(176.893e-3), 25.4e-3, spiral * DEG);
        let example = Example {
            blank: Blank::new(&cones, &depth(0.24737, [0.0, 0.0]), 25.4e-3, Some(176.893e-3)),
            cones,
            pressure: (20.0 * DEG, 0.0),
        };
        for flank in [Flank::Drive, Flank::Coast] {
            let (pair, teeth) = (flanks(&example, flank), example.pair(flank));
            let z = [0, 1].map(|i| f64::from(cones.z[i]) / cones.pitch_angle[i].cos());
            let u = z[1] / z[0];
            let [e1, e2] = pair.addendum_ratio;
            let factor =
                PI * (u + 1.0) / (z[0] * u * teeth.base_helix.cos()) * (e1 * e1 + e2 * e2) / pair.contact_ratio;
            let path = Path::new(&pair, LoadSharing::Uniform, 8).unwrap();
            let arm = pair.base_radius[0] * pair.cos_base_helix;
            close(path.sliding(&vec![1.0; path.len()]) / arm, factor, 1e-9);
            assert!(pair.lengthwise_sliding() <= 1e-12 * pair.sliding(pair.points[0]));
        }
    }
}

/// At a shaft angle of zero the flanks are those of a cylindrical pair.
#[test]
fn cylinders_have_the_loss_factor_of_cylindrical_gears() {
    let fzg = PairSpec {
        z: [16, 24],
        internal: false,
        normal_module: 4.5e-3,
        pressure_angle: 20.0 * DEG,
        helix_angle: 0.0,
        centre_distance: Some(91.5e-3),
        profile_shift: [None, None],
        tip_diameter: [Some(82.636e-3), Some(118.544e-3)],
        root_diameter: [None, None],
        facewidth: 14e-3,
        tip_shortening: true,
    };
    let helical = PairSpec {
        z: [31, 96],
        normal_module: 1.6e-3,
        pressure_angle: 17.5 * DEG,
        helix_angle: 27.0 * DEG,
        centre_distance: Some(115e-3),
        tip_diameter: [Some(60.2e-3), Some(176.251e-3)],
        facewidth: 17e-3,
        ..fzg
    };
    for (spec, printed) in [(fzg, 0.2393094), (helical, 0.1160330)] {
        let cylindrical = Pair::new(&spec).unwrap();
        let helix = cylindrical.working_helix;
        let module = 2.0 * cylindrical.working_radius[0] * helix.cos() / f64::from(spec.z[0]);
        let cones = PitchCones::cylinders(spec.z, module, [helix, helix]);
        let angle = (cylindrical.working_angle.tan() * helix.cos()).atan();
        let addendum = [0, 1].map(|i| 0.5 * cylindrical.tip_diameter[i] - cylindrical.working_radius[i]);
        let blank = Blank {
            mean_addendum: addendum,
            mean_dedendum: [2e-3; 2],
            facewidth: [spec.facewidth; 2],
            outer: [0.5 * spec.facewidth; 2],
            outer_dedendum: [2e-3; 2],
            tip_diameter: cylindrical.tip_diameter,
        };
        let pair = Pair::bevel(&cones, &blank, (angle, 0.0), Flank::Drive).unwrap();
        for (value, expected) in pair.points.iter().zip(cylindrical.points) {
            close(*value, expected, 1e-9);
        }
        for x in cylindrical.points {
            assert!((pair.sliding(x) - cylindrical.sliding(x)).abs() < 1e-12);
            close(pair.sum_speed(x), cylindrical.sum_speed(x), 1e-9);
            close(pair.relative_radius(x), cylindrical.relative_radius(x), 1e-9);
        }
        close(pair.normal_force(100.0), cylindrical.normal_force(100.0), 1e-12);
        close(pair.loss_factor_local(LoadSharing::Uniform), printed, 1e-6);
        close(
            pair.loss_factor_local(LoadSharing::Uniform),
            cylindrical.loss_factor_uniform(),
            1e-9,
        );
    }
}

/// Sliding per speed is the difference of the arms with which friction acts on both gears: what it takes from one and does not give to the
/// other is heat.
#[test]
fn friction_arms_differ_by_sliding() {
    let pair = flanks(&f3(), Flank::Drive);
    let frame = MeanPoint::new(&f3().cones);
    let normal = frame.flank_normal(pair.pressure_angle, Flank::Drive);
    for x in pair.points {
        let s = (pair.points[2] - x) / pair.cos_base_helix;
        let [first, second] = frame.velocities(normal * s);
        let along = (first - second).normalize();
        let motion = pair.crossed.unwrap();
        close(motion.friction_arm(x - pair.points[2]), along.dot(&first), 1e-12);
        close(along.dot(&first) - along.dot(&second), pair.sliding(x), 1e-12);
    }
}
