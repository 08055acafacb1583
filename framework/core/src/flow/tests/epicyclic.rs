//! Epicyclic sets, simple and coupled.

use super::*;
use crate::real::{LANES, Lane, Mask as _, Points, Real};

/// sun 0, carrier 1, ring 2, planet 3.
fn simple(zs: f64, zp: f64, zr: f64, zeta: [f64; 2], held: usize) -> Rig {
    Rig::new(4)
        .mesh(0, zs, 3, zp, Some(1), zeta[0])
        .mesh(3, zp, 2, -zr, Some(1), zeta[1])
        .join(held, None)
}

#[test]
fn p1_simple_set_in_all_six_ways() {
    for (held, driver, driven, ratio, planet, t_driven, t_held, sp, pr, efficiency) in [
        (1, 0, 2, -3.0, -100.0, 147.7575, -197.7575, 5000.0, 4950.0, 0.98505),
        (
            1,
            2,
            0,
            -0.333333333,
            300.0,
            16.4175,
            -66.4175,
            -4975.0,
            -5000.0,
            0.98505,
        ),
        (2, 0, 1, 4.0, -50.0, -197.7575, 147.7575, 3750.0, 3712.5, 0.9887875),
        (
            2,
            1,
            0,
            0.25,
            -200.0,
            -12.359318,
            -37.640682,
            -3745.24786,
            -3764.0682,
            0.988745436,
        ),
        (
            0, 2, 1, 1.33333333, 150.0, -66.4175, 16.4175, -1243.75, -1250.0, 0.9962625,
        ),
        (
            0,
            1,
            2,
            0.75,
            200.0,
            -37.3582544,
            -12.6417456,
            1264.17456,
            1251.53281,
            0.996220118,
        ),
    ] {
        let solved = solve(
            &simple(24.0, 24.0, 72.0, [0.010, 0.005], held),
            &[driver, driven],
            &[(driver, 100.0)],
            &[(driver, 50.0)],
        );
        close(solved.speeds[driver] / solved.speeds[driven], ratio, 1.0);
        close(solved.speeds[3], planet, 300.0);
        close(solved.work.ports[driven], t_driven, 200.0);
        close(solved.work.multipliers[2], t_held, 200.0);
        close(solved.work.rolling[0], sp, 5000.0);
        close(solved.work.rolling[1], pr, 5000.0);
        close(solved.efficiency(&[driver, driven]), efficiency, 1.0);
    }
}

#[test]
fn d1_rolling_power_of_a_planetary_stage() {
    for (torque, ring, mu, factors, rolling, loss) in [
        (50.0, 72.0, 0.05, [0.15, 0.06], 11781.0, 123.7),
        (16.0, 216.0, 0.04, [0.18, 0.08], 4523.89, 47.0485),
    ] {
        let solved = solve(
            &simple(24.0, 0.5 * (ring - 24.0), ring, [0.0, 0.0], 2),
            &[0, 1],
            &[(0, rpm(3000.0))],
            &[(0, torque)],
        );
        // Both meshes have the power of the sun relative to the carrier; published with six digits.
        let powers = &solved.work.rolling;
        let lost: f64 = powers.iter().zip(factors).map(|(p, h)| p.abs() * mu * h).sum();
        for (value, printed) in [(powers[0], rolling), (powers[1], rolling), (lost, loss)] {
            assert!((value.abs() / printed - 1.0).abs() < 1e-5, "{value} {printed}");
        }
    }
}

/// Eight-speed automatic: suns a and b 0, ring a 1, carrier a = ring d 2, input = carrier b 3, ring b = sun c 4,
/// ring c = sun d 5, carrier c 6, output = carrier d 7, planets a to d 8 to 11.
fn eight_speed(loss: f64, closed: &str) -> Rig {
    let rig = Rig::new(12)
        .mesh(0, 48.0, 8, 24.0, Some(2), loss)
        .mesh(8, 24.0, 1, -96.0, Some(2), 0.0)
        .mesh(0, 48.0, 9, 24.0, Some(3), loss)
        .mesh(9, 24.0, 4, -96.0, Some(3), 0.0)
        .mesh(4, 69.0, 10, 21.0, Some(6), loss)
        .mesh(10, 21.0, 5, -111.0, Some(6), 0.0)
        .mesh(5, 23.0, 11, 31.0, Some(7), loss)
        .mesh(11, 31.0, 2, -85.0, Some(7), 0.0);
    closed.chars().fold(rig, |rig, element| match element {
        'A' => rig.join(0, None),
        'B' => rig.join(1, None),
        'C' => rig.join(3, Some(5)),
        'D' => rig.join(6, Some(7)),
        _ => rig.join(4, Some(5)),
    })
}

#[test]
fn p2_eight_speed_automatic() {
    for (closed, ratio, at98, at97, drive, coast) in [
        ("ABC", 4.69565217, 4.62173913, 4.58478261, 0.984259259, 0.984191929),
        ("ABE", 3.13043478, 3.06034078, 3.02533274, 0.977608859, 0.977630649),
        ("BCE", 2.1038961, 2.07853085, 2.06585593, 0.987943675, 0.987837719),
        ("BDE", 1.66666667, 1.64456376, 1.63360269, 0.986738255, 0.986505605),
        ("BCD", 1.28452918, 1.27191418, 1.26569985, 0.99017928, 0.989885663),
        ("CDE", 1.0, 1.0, 1.0, 1.0, 1.0),
        ("ACD", 0.839160839, 0.834710269, 0.832418435, 0.994696403, 0.994824188),
        ("ADE", 0.666666667, 0.662162162, 0.659863946, 0.993243243, 0.993333333),
        ("ABD", -3.29678639, -3.11861856, -3.03129584, 0.945957119, 0.946418604),
    ] {
        let run = |loss: f64, torque: f64| solve(&eight_speed(loss, closed), &[3, 7], &[(3, 100.0)], &[(3, torque)]);
        let solved = run(0.02, 1.0);
        close(solved.speeds[3] / solved.speeds[7], ratio, 1.0);
        close(-solved.work.ports[7], at98, 1.0);
        close(solved.efficiency(&[3, 7]), drive, 1.0);
        close(-run(0.03, 1.0).work.ports[7], at97, 1.0);
        close(run(0.02, -1.0).efficiency(&[3, 7]), coast, 1.0);
    }
}

/// Ravigneaux: small sun 0, large sun 1, carrier 2, ring 3, short planet 4, long planet 5.
fn ravigneaux(columns: usize) -> Rig {
    Rig::new(columns)
        .mesh(0, 31.0, 4, 20.0, Some(2), 0.010)
        .mesh(4, 20.0, 5, 24.0, Some(2), 0.010)
        .mesh(1, 38.0, 5, 24.0, Some(2), 0.010)
        .mesh(5, 24.0, 3, -85.0, Some(2), 0.006)
}

#[test]
fn p3_ravigneaux_set() {
    for (held, driver, ratio, short, long, t_ring, t_held, efficiency) in [
        (2, 0, 2.74193548, -155.0, 129.166667, -133.562337, 83.5623371, 0.9742194),
        (2, 1, -2.23684211, 190.0, -158.333333, 110.059342, -160.059342, 0.98406),
        (
            1,
            0,
            1.53815893,
            -40.4347826,
            116.062802,
            -75.7441251,
            25.7441251,
            0.984867346,
        ),
        (
            1,
            2,
            0.691056911,
            -90.0,
            258.333333,
            -34.380793,
            -15.619207,
            0.995020597,
        ),
    ] {
        let solved = solve(
            &ravigneaux(6).join(held, None),
            &[driver, 3],
            &[(driver, 100.0)],
            &[(driver, 50.0)],
        );
        close(solved.speeds[driver] / solved.speeds[3], ratio, 1.0);
        close(solved.speeds[4], short, 200.0);
        close(solved.speeds[5], long, 200.0);
        close(solved.work.ports[3], t_ring, 100.0);
        close(solved.work.multipliers[4], t_held, 100.0);
        close(solved.efficiency(&[driver, 3]), efficiency, 1.0);
    }
}

#[test]
fn p4_ravigneaux_set_with_two_inputs() {
    let rig = ravigneaux(6);
    let given = [(0, rpm(1972.222222222222)), (2, rpm(3000.0))];
    let solved = solve(&rig, &[0, 2, 3], &given, &[(3, -300.0)]);
    let n: Vec<f64> = solved.speeds.iter().map(|w| w * 30.0 / std::f64::consts::PI).collect();
    for (column, printed) in [(3, 2625.16340), (1, 3838.45029), (5, 1672.45370), (4, 4593.05556)] {
        close(n[column], printed, 4593.0);
    }
    close(solved.work.ports[0], 106.591064, 300.0);
    close(solved.work.ports[2], 193.408936, 300.0);
    close(solved.loss(), 303.588198, 303.0);
    close(solved.efficiency(&[0, 2, 3]), 0.996332392, 1.0);
    assert_eq!(solved.status(&[0, 2, 3]), Status::Split);
    for (value, printed) in solved
        .work
        .rolling
        .iter()
        .zip([-11588.1323, -11705.1841, 0.0, -11775.8391])
    {
        close(*value, printed, 11775.0);
    }
    let free = Motion::new(&rig.train(), &[0, 2, 3], &[2]).unwrap_err();
    match free.as_slice() {
        [crate::kinematics::Fault::Under { columns, .. }] => assert_eq!(columns, &[0, 1, 3, 4, 5]),
        other => panic!("{other:?}"),
    }
}

#[test]
fn p5_six_speed_automatic() {
    // Front set: ring = input 6, carrier 7, planet 8, sun 9 held.
    let rig = |closed: &str| {
        let rig = ravigneaux(10)
            .mesh(9, 37.0, 8, 17.0, Some(7), 0.010)
            .mesh(8, 17.0, 6, -71.0, Some(7), 0.006)
            .join(9, None);
        closed.chars().fold(rig, |rig, element| match element {
            'A' => rig.join(7, Some(0)),
            'B' => rig.join(7, Some(1)),
            'C' => rig.join(1, None),
            'D' => rig.join(2, None),
            _ => rig.join(6, Some(2)),
        })
    };
    for (closed, ratio, efficiency) in [
        ("AD", 4.17083144, 0.968899260),
        ("AC", 2.33973471, 0.979489058),
        ("AB", 1.52112676, 0.994539074),
        ("AE", 1.14278601, 0.994879550),
        ("BE", 0.867183072, 0.996432060),
        ("CE", 0.691056911, 0.995020597),
        ("BD", -3.40252039, 0.978686121),
    ] {
        let solved = solve(&rig(closed), &[6, 3], &[(6, 100.0)], &[(6, 50.0)]);
        close(solved.speeds[6] / solved.speeds[3], ratio, 1.0);
        close(solved.efficiency(&[6, 3]), efficiency, 1.0);
    }
}

/// Wolfrom: sun 0, carrier 1, held ring 2, output ring 3, planet body 4.
fn wolfrom(zeta: f64) -> Rig {
    Rig::new(5)
        .mesh(0, 21.0, 4, 30.0, Some(1), 0.010)
        .mesh(4, 30.0, 2, -81.0, Some(1), zeta)
        .mesh(4, 29.0, 3, -80.0, Some(1), zeta)
        .join(2, None)
}

#[test]
fn p6_wolfrom_set() {
    let run = |zeta: f64, given: usize, torque: f64| solve(&wolfrom(zeta), &[0, 3], &[(0, 300.0)], &[(given, torque)]);
    let solved = run(0.006, 0, 1.0);
    for (column, printed) in [(1, 61.7647059), (4, -105.0), (3, 1.3125)] {
        close(solved.speeds[column], printed, 105.0);
    }
    close(solved.work.ports[3], -145.500431, 145.5);
    close(solved.work.multipliers[3], 144.500431, 145.5);
    close(solved.efficiency(&[0, 3]), 0.636564384, 1.0);
    for (value, printed) in solved.work.rolling.iter().zip([238.235294, 8978.90, -8795.82199]) {
        assert!((value - printed).abs() < 1e-6 * 8978.9, "{value} {printed}");
    }
    let coast = run(0.006, 0, -1.0);
    close(coast.work.ports[3], 523.450708, 523.0);
    close(coast.efficiency(&[0, 3]), 0.436662756, 1.0);
    close(run(0.006, 3, 100.0).work.ports[0], -0.191039956, 1.0);
    let stiff = run(0.012, 0, 1.0);
    close(stiff.work.ports[3], -107.014555, 107.0);
    close(stiff.efficiency(&[0, 3]), 0.468188679, 1.0);
    let locked = run(0.012, 0, -1.0);
    assert_eq!(locked.outcome, Outcome::SelfLocking);
    assert_eq!(locked.work.doubtful().collect::<Vec<_>>(), [1, 2]);
    assert_eq!(coast.status(&[0, 3]), Status::Coast);
    let pushed = run(0.012, 3, 100.0);
    assert!(
        matches!(pushed.outcome, Outcome::Converged { .. }),
        "{:?}",
        pushed.outcome
    );
    close(pushed.work.ports[0], 0.0548759518, 1.0);
    assert_eq!(pushed.status(&[0, 3]), Status::Dragged);
    close(pushed.loss(), 147.712786, 147.0);
    let driven = run(0.012, 3, -100.0);
    close(driven.work.ports[0], 0.934452325, 1.0);
    close(driven.efficiency(&[0, 3]), 0.468188679, 1.0);
}

#[test]
fn p6_wolfrom_set_locks_itself_beyond_a_loss_of_0_0106820531() {
    let run = |zeta: f64, torque: f64| solve(&wolfrom(zeta), &[0, 3], &[(0, 300.0)], &[(0, torque)]);
    assert!(matches!(
        run(0.0106820531 * (1.0 - 1e-6), -1.0).outcome,
        Outcome::Converged { .. }
    ));
    assert_eq!(run(0.0106820531 * (1.0 + 1e-6), -1.0).outcome, Outcome::SelfLocking);
    close(run(0.0106820531, 1.0).efficiency(&[0, 3]), 0.497112240, 1.0);
}

#[test]
fn p6_wolfrom_set_with_a_law_that_is_not_proportional() {
    let rig = wolfrom(0.0).drag(Some(0), None, 0.01).loaded(3);
    let run = |given: usize, torque: f64| {
        solve_with(
            &rig,
            &[0, 3],
            &[(0, 300.0)],
            &[(given, torque)],
            |_, torque, speed| 0.012 * torque.powf(0.9) * speed,
            |state| {
                let mut drags = vec![0.0; 5];
                drags[3] = -0.02 * state.multipliers[2].abs() * state.speeds[3].signum();
                drags
            },
        )
    };
    let solved = run(0, 1.0);
    assert!(
        matches!(solved.outcome, Outcome::Converged { .. }),
        "{:?}",
        solved.outcome
    );
    close(solved.work.ports[3], -130.033938, 130.0);
    for (value, printed) in solved.work.mesh_loss.iter().zip([2.83308121, 65.4661584, 57.9885393]) {
        close(*value, printed, 65.0);
    }
    close(solved.drag_loss, 3.0426780553, 3.0);
    // Thirtyfold recirculation; without the secant eight iterations.
    assert!(solved.passes() <= 5, "{:?}", solved.outcome);
    close(run(3, -100.0).work.ports[0], 0.780051307, 1.0);
}

#[test]
fn p7_simpson_set() {
    // Common sun 0, ring 1 1, carrier 1 = ring 2 2, carrier 2 3, planets 4 and 5.
    let rig = Rig::new(6)
        .mesh(0, 39.0, 4, 18.0, Some(2), 0.010)
        .mesh(4, 18.0, 1, -75.0, Some(2), 0.005)
        .mesh(0, 39.0, 5, 18.0, Some(3), 0.010)
        .mesh(5, 18.0, 2, -75.0, Some(3), 0.005);
    for (driver, held, ratio, efficiency, t_held) in [
        (1, 3, 2.52, 0.985138691, 74.1274751),
        (1, 0, 1.52, 0.994885526, 25.6113000),
        (0, 3, -1.92307692, 0.98505, -144.716346),
    ] {
        let solved = solve(
            &rig.clone().join(held, None),
            &[driver, 2],
            &[(driver, 100.0)],
            &[(driver, 50.0)],
        );
        close(solved.speeds[driver] / solved.speeds[2], ratio, 1.0);
        close(solved.efficiency(&[driver, 2]), efficiency, 1.0);
        close(solved.work.multipliers[4], t_held, 100.0);
    }
    let direct = solve(&rig.join(1, Some(0)), &[1, 2], &[(1, 100.0)], &[(1, 50.0)]);
    close(direct.efficiency(&[1, 2]), 1.0, 1.0);
    assert!(
        direct.work.rolling.iter().all(|p| *p == 0.0),
        "{:?}",
        direct.work.rolling
    );
}

/// Losses of the meshes of a set whose law is nearly proportional, so that the iteration converges, but not immediately.
fn lost<R: Points>(rig: &Rig, state: &mut FlowState<'_, R>) {
    for &k in &state.laws.meshes {
        let (mesh, zeta) = rig.meshes[k];
        let (z, column) = match state.drives[k] {
            Drive::Second => (mesh.sz2, mesh.second),
            _ => (mesh.z1, mesh.first),
        };
        let of = |column: Option<usize>| column.map_or(R::ZERO, |c| state.speeds[c]);
        let multiplier = state.multipliers[mesh.row];
        let power = (multiplier * z * (of(column) - of(mesh.carrier))).abs() * zeta;
        state.mesh_loss[k] = power * multiplier.abs().at_least(1e-3).power(-0.01);
    }
}

/// Near self-locking and beyond, where points turn, lock or converge slowly: those that stay together have the bits of each alone.
#[test]
fn points_of_a_set_near_self_locking_are_solved_together_as_alone() {
    let (ports, mut together, mut left) = ([0, 3], 0, 0);
    for (zeta, sense) in [(0.001, 1.0), (0.006, 1.0), (0.006, -1.0), (0.0105, -1.0), (0.012, 1.0)] {
        let rig = wolfrom(zeta);
        let (motion, flow) = rig.flow(&ports, &[0], &[0]);
        let (mut all, mut alone) = (flow.work::<Lane>(), flow.work::<f64>());
        for speed in [100.0, 1000.0] {
            let torque = |i: usize| sense * (20.0 + i as f64) * if i == 3 { -1.0 } else { 1.0 };
            let mut speeds = vec![0.0; rig.columns];
            motion.speeds(&[speed], &mut speeds);
            let drag = -0.02 * f64::powf(speed, 0.7);
            all.speeds = speeds.iter().map(|w| Lane::constant(*w)).collect();
            all.given = vec![Lane::each(torque)];
            all.steady[0] = Lane::constant(drag);
            all.live = Lane::mask(|_| true);
            let outcome = flow.real(Tolerance::default(), Start::Lossless, &mut all, |state| {
                lost(&rig, state);
            });
            assert!(matches!(outcome, Outcome::Converged { .. }), "{outcome:?}");
            for i in 0..LANES {
                if !all.live.at_point(i) {
                    left += 1;
                    continue;
                }
                together += 1;
                alone.speeds.clone_from(&speeds);
                alone.given = vec![torque(i)];
                alone.steady[0] = drag;
                let outcome = flow.real(Tolerance::default(), Start::Lossless, &mut alone, |state| {
                    lost(&rig, state);
                });
                let passes = all.passes[i] as usize;
                assert_eq!(outcome, Outcome::Converged { passes }, "{zeta} {sense} {speed} {i}");
                assert_eq!(all.drives, alone.drives);
                let results = |all: &[Lane], alone: &[f64]| all.iter().zip(alone).all(|(all, alone)| all[i] == *alone);
                assert!(results(&all.mesh_loss, &alone.mesh_loss), "{zeta} {sense} {speed} {i}");
                assert!(results(&all.multipliers, &alone.multipliers) && results(&all.ports, &alone.ports));
            }
        }
    }
    assert!(together > 100 && left >= 10, "{together} together, {left} left");
}
