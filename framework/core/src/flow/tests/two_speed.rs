//! Trains with fixed axes: two speeds, six shafts.

use super::*;

/// input 0, intermediate 1, output 2, G3 3, G5 4.
pub(super) fn two_speed(engaged: &[usize], zeta: [f64; 3]) -> Rig {
    let rig = Rig::new(5)
        .mesh(0, 16.0, 1, 83.0, None, zeta[0])
        .mesh(3, 24.0, 2, 101.0, None, zeta[1])
        .mesh(4, 31.0, 2, 96.0, None, zeta[2]);
    engaged.iter().fold(rig, |rig, gear| rig.join(1, Some(*gear)))
}

#[test]
fn t2_ideal_multipliers_and_torques() {
    for (gear, index, torque, out, m1, loaded, coupling) in [
        (3, 1, 10.0, -218.307292, -0.625, 2.16145833, 51.875),
        (3, 1, -10.0, 218.307292, 0.625, -2.16145833, -51.875),
        (3, 1, 20.0, -436.614583, -1.25, 4.32291667, 103.75),
        (4, 2, 10.0, -160.645161, -0.625, 1.6733871, 51.875),
        (4, 2, -10.0, 160.645161, 0.625, -1.6733871, -51.875),
    ] {
        let solved = solve(
            &two_speed(&[gear], [0.0; 3]),
            &[0, 2],
            &[(0, rpm(8000.0))],
            &[(0, torque)],
        );
        close(solved.work.ports[2], out, out);
        close(solved.work.multipliers[0], m1, m1);
        close(solved.work.multipliers[index], loaded, loaded);
        close(solved.work.multipliers[3 - index], 0.0, loaded);
        close(solved.work.multipliers[3].abs(), f64::abs(coupling), coupling);
    }
}

#[test]
fn t3_real_flow_with_constant_models() {
    let rig = |engaged: &[usize]| {
        two_speed(engaged, [0.010, 0.008, 0.009])
            .drag(Some(0), None, 0.020)
            .drag(Some(1), None, 0.050)
            .drag(Some(2), None, 0.120)
            .drag(Some(2), None, 0.300)
            .drag(Some(1), Some(3), 0.014)
            .drag(Some(1), Some(4), 0.021)
    };
    for (given, torque, t_in, t_out, meshes, loss, efficiency, status) in [
        (
            0,
            10.0,
            10.0,
            -213.31448,
            [83.6082525, 66.1260065, 0.0224606183],
            191.600012,
            Some(0.977129433),
            Status::Drive,
        ),
        (
            0,
            -10.0,
            -10.0,
            223.392078,
            [84.7912684, 68.4725244, 0.0224606183],
            195.129546,
            Some(0.977238289),
            Status::Coast,
        ),
        (
            2,
            -218.0,
            10.2185459,
            -218.0,
            [85.4391384, 67.5760681, 0.0224606183],
            194.880959,
            Some(0.977235312),
            Status::Drive,
        ),
        (
            0,
            0.0,
            0.0,
            1.10133579,
            [0.169244049, 0.228956348, 0.0224606183],
            42.2639532,
            None,
            Status::Dragged,
        ),
    ] {
        let solved = solve(&rig(&[3]), &[0, 2], &[(0, rpm(8000.0))], &[(given, torque)]);
        assert!(matches!(solved.outcome, Outcome::Converged { .. }));
        close(solved.work.ports[0], t_in, 10.0);
        close(solved.work.ports[2], t_out, t_out);
        for (value, printed) in solved.work.mesh_loss.iter().zip(meshes) {
            close(*value, printed, meshes[0]);
        }
        close(solved.loss(), loss, loss);
        match efficiency {
            Some(efficiency) => close(solved.efficiency(&[0, 2]), efficiency, 1.0),
            None => assert_eq!(solved.balance(&[0, 2]).efficiency(), None),
        }
        assert_eq!(solved.status(&[0, 2]), status);
        assert!(solved.passes() <= 4, "{:?}", solved.outcome);
    }
    let first = solve(&rig(&[3]), &[0, 2], &[(0, rpm(8000.0))], &[(0, 10.0)]);
    for (row, printed) in [(0, -0.62375), (1, 2.13260573), (2, 0.000677419355), (3, 51.1825375)] {
        close(first.work.multipliers[row].abs(), f64::abs(printed), printed);
    }
    let neutral = solve(&rig(&[]), &[0, 2], &[(0, rpm(3000.0)), (2, rpm(500.0))], &[]);
    close(neutral.work.ports[0], 0.022920774, 0.545);
    close(neutral.work.ports[2], 0.545014665, 0.545);
    close(neutral.loss(), 35.7376746, 35.7);
    assert_eq!(neutral.status(&[0, 2]), Status::Dragged);
}

#[test]
fn t4_ideal_and_real_agree_to_second_order() {
    for (zeta, ideal, real) in [(0.02, 320.0, 316.8), (0.01, 160.0, 159.2)] {
        let solved = solve(
            &two_speed(&[3], [zeta, zeta, 0.0]),
            &[0, 2],
            &[(0, 800.0)],
            &[(0, 10.0)],
        );
        close(solved.loss(), real, real);
        let lossless = solve(&two_speed(&[3], [0.0; 3]), &[0, 2], &[(0, 800.0)], &[(0, 10.0)]);
        close(
            lossless.work.rolling.iter().map(|power| zeta * power.abs()).sum(),
            ideal,
            ideal,
        );
        close(ideal - solved.loss(), 8000.0 * zeta * zeta, ideal);
    }
}

/// A law with the exponents of measured gears and drags that depend on load.
fn measured(rig: &Rig, power: f64, torque: f64) -> Solved {
    solve_to(
        power,
        rig,
        &[0, 2],
        &[(0, 800.0)],
        &[(0, torque)],
        |k, torque, speed| [0.013, 0.010, 0.012][k] * torque.powf(0.9) * speed.powf(0.95),
        |state| {
            let (one, two) = (state.multipliers[0].abs(), state.multipliers[1].abs());
            vec![0.0, 0.01 * one.powf(0.7) + 0.02 * two, -0.02 * two.powf(1.5), 0.0, 0.0]
        },
    )
}

#[test]
fn two_or_three_passes_agree_to_1e_9_for_laws_that_are_not_proportional() {
    let rig = two_speed(&[3], [0.0; 3])
        .drag(Some(0), None, 0.02)
        .drag(Some(2), None, 0.4)
        .loaded(1)
        .loaded(2);
    for torque in [10.0, -10.0, 100.0] {
        let (quick, exact) = (measured(&rig, 1e-9, torque), measured(&rig, 1e-12, torque));
        assert!((2..=3).contains(&quick.passes()), "{}", quick.passes());
        // The tolerance itself is the guarantee; the balance holds to rounding in both.
        assert!((quick.loss() - exact.loss()).abs() <= 1e-9 * exact.work.largest);
        for solved in [quick, exact] {
            let power: f64 = [0, 2].iter().map(|p| solved.work.ports[*p] * solved.speeds[*p]).sum();
            assert!((power - solved.loss()).abs() <= 1e-14 * solved.work.largest);
        }
    }
}

#[test]
fn a_mesh_loss_without_load_is_carried_as_a_torque() {
    let rig = two_speed(&[3], [0.0; 3]);
    let solved = solve_with(
        &rig,
        &[0, 2],
        &[(0, 800.0)],
        &[(0, 0.0)],
        |k, _, _| [5.0, 3.0, 2.0][k],
        |_| Vec::new(),
    );
    close(solved.loss(), 10.0, 10.0);
    close(solved.work.ports[2] * solved.speeds[2], 10.0, 10.0);
    assert_eq!(solved.status(&[0, 2]), Status::Dragged);
}

#[test]
fn at_standstill_torques_flow_and_nothing_is_lost() {
    let solved = solve(&two_speed(&[3], [0.01; 3]), &[0, 2], &[(0, 0.0)], &[(0, 10.0)]);
    close(solved.work.ports[2], -218.307292, 218.0);
    assert_eq!((solved.loss(), solved.passes()), (0.0, 1));
}

#[test]
fn answers_that_are_no_numbers_leave_none_in_the_flow() {
    let rig = two_speed(&[3], [0.0; 3]);
    for bad in [f64::NAN, f64::INFINITY] {
        let solved = solve_with(
            &rig.clone().loaded(1),
            &[0, 2],
            &[(0, 800.0)],
            &[(0, 10.0)],
            |_, _, _| bad,
            |_| vec![bad; 5],
        );
        assert_eq!(solved.outcome, Outcome::NoConvergence);
        assert!(
            solved
                .work
                .ports
                .iter()
                .chain(&solved.work.drags)
                .chain(&solved.work.mesh_loss)
                .all(|x| x.is_finite())
        );
    }
}

#[test]
fn s2_six_shafts_ideal() {
    let rig = Rig::new(6)
        .mesh(0, 23.0, 1, 57.0, None, 0.0)
        .mesh(1, 19.0, 2, 41.0, None, 0.0)
        .mesh(2, 41.0, 3, 47.0, None, 0.0)
        .mesh(3, 21.0, 4, 64.0, None, 0.0)
        .mesh(4, 26.0, 5, -89.0, None, 0.0);
    let solved = solve(&rig, &[0, 5], &[(0, rpm(3000.0))], &[(0, 80.0)]);
    close(solved.work.ports[5], -5116.33063, 5116.0);
    let printed = [-3.47826087, 10.4347826, -10.4347826, 23.3540373, -57.486861];
    for (value, printed) in solved.work.multipliers.iter().zip(printed) {
        close(*value, printed, printed);
    }
}

/// As a worm drive with an efficiency of 17 %, whose wheel has a given torque.
#[test]
fn a_loss_of_most_of_the_power_is_followed_from_the_driven_side() {
    let rig = Rig::new(2).mesh(0, 1.0, 1, 40.0, None, 0.83);
    let solved = solve(&rig, &[0, 1], &[(0, 100.0)], &[(1, 40.0)]);
    close(solved.work.ports[0], 1.0 / 0.17, 1.0);
    assert_eq!(solved.status(&[0, 1]), Status::Drive);
    assert!(solved.passes() <= 3, "{:?}", solved.outcome);
}

/// As a worm drive that locks: the driven shaft cannot give off power, so no torque of the driving one maintains its motion; if both are driven,
/// their torques are found.
#[test]
fn a_loss_of_more_than_the_power_locks() {
    let rig = Rig::new(2).mesh(0, 1.0, 1, 40.0, None, 1.5);
    let braked = solve(&rig, &[0, 1], &[(0, 100.0)], &[(0, -1.0)]);
    assert_eq!(braked.outcome, Outcome::SelfLocking);
    assert_eq!(braked.work.doubtful().collect::<Vec<_>>(), [0]);
    let pushed = solve(&rig, &[0, 1], &[(0, 100.0)], &[(1, -40.0)]);
    close(pushed.work.ports[0], 0.5, 1.0);
}
