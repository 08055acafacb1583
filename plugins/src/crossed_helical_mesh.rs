//! Loss of crossed helical meshes.

pub mod efficiency;
pub mod friction;
pub mod point_contact;

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::crossed_helical_mesh::CrossedHelicalMeshAt;
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::{observed, terms};

terms! { pub(crate) SLIDING = load("sliding"); }
observed! {
    pub(crate) MU = ("mu", "-", "coefficient of friction, weighted by load and sliding speed");
    pub(crate) EFFICIENCY = ("eta", "-", "efficiency in the direction of the power; below zero both gears must be driven");
}

/// The normal force for sliding power and friction arm of the friction on the flanks, both over the normal force and the speed of the first gear.
#[inline(always)]
pub(crate) fn normal_force<R: Real>(
    at: &CrossedHelicalMeshAt<'_, R>,
    [sliding, friction_arm]: [R; 2],
) -> Result<R, Undefined> {
    let arm = at.arm(sliding, friction_arm);
    if !arm.is_above(R::ZERO).all() {
        return Err(Undefined {
            what: "arm of the tooth force about the driving gear's axis, so that friction stops it [m]",
            value: arm.extremes(1).0,
        });
    }
    Ok(at.torque / arm)
}

/// The loss of friction with this sliding power and normal force, except at idle points.
#[inline(always)]
pub(crate) fn sliding_loss<R: Real>(at: &CrossedHelicalMeshAt<'_, R>, idle: R::Mask, sliding: R, normal: R) -> Loss<R> {
    at.show("F_n", "N", normal);
    let watts = at.show("P_s", "W", sliding * normal * at.speed.abs());
    at.observe(&EFFICIENCY, R::constant(1.0) - watts / (at.torque * at.speed.abs()));
    Loss::POWERS.with(&SLIDING, R::select(idle, R::ZERO, watts))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use gearloss_framework::evaluate::Point;
    use gearloss_framework::gearbox::Gearbox;
    use gearloss_framework::resolve::Choice;
    use gearloss_framework::testing::{eval, language};

    /// The path beside the pitch point changes the loss by the profile sliding only, which is small against the lengthwise one.
    #[test]
    fn the_whole_path_is_near_the_pitch_point() {
        let at = "at: { torque: 10 Nm, speed: 1000 rpm }";
        let path = eval(
            "crossed_helical_mesh/point_contact",
            &format!("{{ model: {{ type: point_contact, tooth_friction: {{ type: constant, value: 0.05 }} }}, {at} }}"),
        );
        let pitch = eval(
            "crossed_helical_mesh/friction",
            &format!("{{ model: {{ type: friction, value: 0.05 }}, {at} }}"),
        );
        let ratio = path.total / pitch.total;
        assert!((0.98..1.06).contains(&ratio), "{ratio}");
    }

    /// A gearbox file has the efficiency of the pair, in both directions of power, and its power balance closes.
    #[test]
    fn a_gearbox_has_the_efficiency_of_the_pair() {
        let text = "gearloss: gearbox/1
title: crossed helical gears
ports: { input: a, output: b }
shafts:
  a: { axis: { through: [0, 0, 0], direction: [1, 0, 0] }, bearings: none }
  b: { axis: { through: [0 mm, 0 mm, 95.459415461 mm], direction: [0, 1, 0] }, bearings: none }
gears:
  first: { shaft: a, z: 15, facewidth: 30 mm, hand: right }
  second: { shaft: b, z: 30, facewidth: 30 mm, hand: right }
crossed_helical_meshes:
  pair: { gears: [first, second], normal_module: 3 mm, helix_angle: [45 deg, 45 deg], model: { type: friction, value: 0.1 } }
surface: { ra: 0.4 um }
lubricants: { oil: { viscosity: { kv40: 100 mm2/s, kv100: 11 mm2/s } } }
housing: { oil: { lubricant: oil } }
thermal: { mode: fixed, oil: 70 degC }
";
        let gearbox =
            Gearbox::of_text(language(), text, "crossed.yaml", "").unwrap_or_else(|f| panic!("{}", f.render()));
        let t = gearbox
            .transmission(language(), &Choice::default())
            .unwrap_or_else(|f| panic!("{}", f.render()));
        let case = t.case(&t.states()[0].name, &["input"], &["input"]).unwrap();
        let mut scratch = t.scratch(&case);
        let mut efficiency = |torque: f64| {
            let point = Point {
                speeds: &[100.0],
                torques: &[torque],
                ..Point::default()
            };
            let solution = t.evaluate(&case, &point, &[70.0], &mut scratch);
            assert!(solution.residual().unwrap().abs() < 1e-10 * solution.largest_power());
            solution.efficiency().unwrap()
        };
        assert!((efficiency(10.0) - 0.8076354530).abs() < 1e-8);
        // If the second gear drives, the inverse of the formula with the other sign of friction.
        let (cos, mu) = (20.0_f64.to_radians().cos(), 0.1);
        let expected = (1.0 - mu / cos) / (1.0 + mu / cos);
        assert!(
            (efficiency(-10.0) - expected).abs() < 1e-8,
            "{} {expected}",
            efficiency(-10.0)
        );
    }
}
