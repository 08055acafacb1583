//! Placed pairs on axes in any direction: contact, torques and power of their forces.
#![allow(clippy::unwrap_used)]

use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;

use super::*;
use crate::description::{AxisEntry, DirectedAxis};
use crate::geometry::crossed::{Closure, Depth, Size, SpiralAngle};

const DEG: f64 = std::f64::consts::PI / 180.0;

/// Kinds of pairs, and whether the first gear has the left hand.
#[derive(Debug, Clone, Copy)]
struct Case {
    kind: u8,
    left: bool,
    /// As [`CrossedTeeth::along`].
    along: [f64; 2],
}

fn case() -> impl Strategy<Value = Case> {
    let side = || prop_oneof![Just(1.0), Just(-1.0)];
    (0..5_u8, any::<bool>(), side(), side()).prop_map(|(kind, left, a, b)| Case {
        kind,
        left,
        along: [a, b],
    })
}

/// The pair of a case: bevel gears at 90 and at 70 deg, the hypoid example F.3 of ISO 23509, a worm, crossed helical gears.
fn unplaced(case: Case) -> Unplaced {
    let depth = Depth {
        working: 2.0,
        clearance: 0.125,
        wheel_addendum: 0.35,
        addendum_angle: 1.0 * DEG,
        dedendum_angle: 4.0 * DEG,
    };
    let (kind, cones, facewidth) = match case.kind {
        0 | 1 => {
            let angle = [90.0, 70.0][usize::from(case.kind)] * DEG;
            let cones = PitchCones::bevel([14, 39], angle, Size::Outer(0.176893), 0.0254, 35.0 * DEG);
            (CrossedKind::Bevel, cones, 0.0254)
        }
        2 => {
            let closure = Closure::LimitRadius {
                cutter_radius: 0.0635,
                blade_groups: 0,
            };
            let spiral = SpiralAngle::Pinion(50.0 * DEG);
            let size = (Size::OuterOfStandard(0.17), 0.03);
            let cones = PitchCones::hypoid([13, 42], (90.0 * DEG, 0.015), size, spiral, closure);
            (CrossedKind::Bevel, cones.unwrap(), 0.03)
        }
        3 => {
            let lead = (2.0_f64 / 9.0).atan();
            let cones = PitchCones::cylinders([2, 41], 4e-3 * lead.cos(), [90.0 * DEG - lead, -lead]);
            (CrossedKind::Worm, cones, 0.0)
        }
        _ => {
            let cones = PitchCones::cylinders([15, 30], 3e-3, [50.0 * DEG, -20.0 * DEG]);
            (CrossedKind::CrossedHelical, cones, 0.0)
        }
    };
    Unplaced {
        pairs: None,
        worm: None,
        blank: (kind == CrossedKind::Bevel).then(|| Blank::new(&cones, &depth, facewidth, None)),
        kind,
        cones,
        pressure_angle: [20.0 * DEG, 22.0 * DEG],
        limit_factor: 1.0,
        left: case.left,
        along: case.along,
    }
}

/// Axes for a pair, turned as a whole.
fn axes(pair: &Unplaced, turn: &Rotation3<f64>, shift: Vector3<f64>) -> [Axis; 2] {
    let frame = MeanPoint::new(&pair.cones);
    // A left-hand pair is seen in a mirror.
    let mirror = |v: Vector3<f64>| if pair.left { Vector3::new(v.x, v.y, -v.z) } else { v };
    [0, 1].map(|i| {
        let through = turn * mirror(frame.foot[i] + frame.axis[i] * 0.03) + shift;
        let direction = turn * mirror(frame.axis[i]) * pair.along[i];
        let entry = DirectedAxis {
            through: through.into(),
            direction: direction.into(),
        };
        Axis::new(&AxisEntry::Directed(entry)).unwrap()
    })
}

/// Torques of a wrench on the first gear, and of its opposite on the second one, about the directions of the shafts.
fn torques(teeth: &CrossedTeeth, axes: &[Axis; 2], wrench: Wrench) -> [f64; 2] {
    [0, 1].map(|i| {
        let sense = if i == 0 { 1.0 } else { -1.0 };
        let direction = Vector3::from(axes[i].direction());
        let arm = teeth.mean_point - Vector3::from(axes[i].origin);
        sense * direction.dot(&(arm.cross(&wrench.force) + wrench.moment))
    })
}

proptest! {
    /// The torques of normal forces have the ratio of the teeth and the sense of their flanks; friction takes the power of its sliding and
    /// leaves the torque of the driving gear.
    #[test]
    fn torques_and_powers_balance(
        case in case(), roll in -3.0..3.0_f64, pitch in -1.5..1.5_f64, yaw in -3.0..3.0_f64, shift in -0.2..0.2_f64,
    ) {
        let pair = unplaced(case);
        let [z1, z2] = pair.cones.z.map(f64::from);
        let radius = pair.cones.radius[0];
        let axes = axes(&pair, &Rotation3::from_euler_angles(roll, pitch, yaw), Vector3::new(shift, 0.1, -shift));
        let teeth = CrossedTeeth::new(pair, [&axes[0], &axes[1]]);
        let ratio = teeth.sign() * z2 / z1;
        for (flank, sense) in teeth.flanks.iter().zip([1.0, -1.0]) {
            let normal = Wrench { force: flank.normal, moment: Vector3::zeros() };
            let [first, second] = torques(&teeth, &axes, normal);
            prop_assert!((first - sense * radius).abs() < 1e-12 * radius);
            prop_assert!((second - first * ratio).abs() < 1e-11 * first.abs() * ratio.abs());
            for (driving, friction) in flank.friction.into_iter().enumerate() {
                let lost = torques(&teeth, &axes, friction);
                // The speed of the second gear while the first one turns at one.
                let power = lost[0] - lost[1] / ratio;
                prop_assert!((power + flank.sliding).abs() < 1e-11 * flank.sliding, "{power} {}", flank.sliding);
                prop_assert!(lost[driving].abs() < 1e-11 * radius * ratio.abs());
            }
        }
    }

    /// All vectors turn with the gearbox.
    #[test]
    fn vectors_turn_with_the_gearbox(case in case(), roll in -3.0..3.0_f64, pitch in -1.5..1.5_f64, yaw in -3.0..3.0_f64) {
        let turn = Rotation3::from_euler_angles(roll, pitch, yaw);
        let still = axes(&unplaced(case), &Rotation3::identity(), Vector3::zeros());
        let turned = axes(&unplaced(case), &turn, Vector3::zeros());
        let [a, b] = [still, turned].map(|axes| CrossedTeeth::new(unplaced(case), [&axes[0], &axes[1]]));
        prop_assert!((turn * a.mean_point - b.mean_point).norm() < 1e-14);
        for (a, b) in a.flanks.iter().zip(&b.flanks) {
            prop_assert!((turn * a.normal - b.normal).norm() < 1e-12);
            prop_assert_eq!(a.flank, b.flank);
            for (a, b) in a.friction.iter().zip(&b.friction) {
                prop_assert!((turn * a.force - b.force).norm() < 1e-11 && (turn * a.moment - b.moment).norm() < 1e-11);
            }
        }
    }

    /// A gearbox with exchanged hands is the mirror image: it turns and twists the other way.
    #[test]
    fn exchanged_hands_are_the_mirror_image(case in case()) {
        let of = |left: bool| {
            let pair = unplaced(Case { left, ..case });
            let axes = axes(&pair, &Rotation3::identity(), Vector3::zeros());
            CrossedTeeth::new(pair, [&axes[0], &axes[1]])
        };
        let mirror = |v: Vector3<f64>| Vector3::new(v.x, v.y, -v.z);
        let (right, left) = (of(false), of(true));
        prop_assert!((mirror(right.mean_point) - left.mean_point).norm() < 1e-14);
        for sense in 0..2 {
            let (a, b) = (right.flanks[sense], left.flanks[1 - sense]);
            prop_assert_eq!(a.flank, b.flank);
            prop_assert!((mirror(a.normal) - b.normal).norm() < 1e-12);
            for driving in 0..2 {
                // Speeds change their sign, so the force of friction turns round where the mirror leaves it.
                prop_assert!((mirror(a.friction[driving].force) + b.friction[driving].force).norm() < 1e-11);
                prop_assert!((mirror(a.friction[driving].moment) - b.friction[driving].moment).norm() < 1e-11);
            }
        }
    }
}

/// The example of a bevel stage: pinion along x, wheel along y, both from the common apex, 300 N m into the pinion, which turns backwards.
#[test]
fn forces_of_a_bevel_stage() {
    let pair = Unplaced {
        pressure_angle: [20.0 * DEG; 2],
        left: true,
        ..unplaced(Case {
            kind: 0,
            left: true,
            along: [1.0; 2],
        })
    };
    let axis = |direction| {
        let through = [0.0; 3];
        Axis::new(&AxisEntry::Directed(DirectedAxis { through, direction })).unwrap()
    };
    let axes = [axis([1.0, 0.0, 0.0]), axis([0.0, 1.0, 0.0])];
    let teeth = CrossedTeeth::new(pair, [&axes[0], &axes[1]]);
    let close = |vector: Vector3<f64>, expected: [f64; 3]| {
        let expected = Vector3::from(expected);
        assert!(
            (vector - expected).norm() < 1e-12 * expected.norm(),
            "{vector} {expected}"
        );
    };
    close(teeth.mean_point * 1e3, [76.493_327_681_3, 27.459_143_270_2, 0.0]);
    // The shaft pushes backwards, so the teeth push forwards.
    let flank = teeth.flanks[0];
    let tangential = 300.0 / teeth.cones.radius[0];
    close(
        flank.normal * tangential,
        [8_840.263_797_064_3, -1_984.272_960_755_7, 10_925.322_652_923_4],
    );
    assert!((flank.normal.norm() * tangential / 14_193.318_084_75 - 1.0).abs() < 1e-12);
    assert_eq!(flank.flank, Flank::Drive);
}
