//! Properties of random trains.

use proptest::prelude::*;

use super::two_speed::two_speed;
use super::*;

/// One stage of a random train.
#[derive(Debug, Clone)]
enum Stage {
    Pair,
    /// Which member is held: ring, sun or carrier.
    Epicyclic(u8),
    /// A gear that carries only its drag.
    Idle,
    /// Two equal countershafts with this share of the torque on the first.
    Twin(f64),
}

fn stage() -> impl Strategy<Value = (Stage, [f64; 2], [f64; 2])> {
    let kind = prop_oneof![
        Just(Stage::Pair),
        (0_u8..3).prop_map(Stage::Epicyclic),
        Just(Stage::Idle),
        (0.2..0.8_f64).prop_map(Stage::Twin),
    ];
    let teeth = [15_u32..60, 15_u32..60].prop_map(|z| z.map(f64::from));
    (kind, teeth, [0.0..0.04_f64, 0.0..0.04_f64])
}

/// A random train of one to four stages with drags, and its output.
pub(super) fn train() -> impl Strategy<Value = (Rig, usize)> {
    (proptest::collection::vec(stage(), 1..5), 0.0..0.3_f64).prop_map(|(stages, drag)| {
        let mut rig = Rig::new(1);
        let mut at = 0;
        for (stage, [za, zb], [one, two]) in stages {
            let new = rig.columns;
            let end = match stage {
                Stage::Pair | Stage::Idle => {
                    rig.columns += 1;
                    rig = rig.mesh(at, za, new, zb, None, one);
                    new
                }
                Stage::Epicyclic(held) => {
                    rig.columns += 3;
                    let (planet, fixed) = (new + 2, new + 1);
                    let (sun, carrier, ring) = match held {
                        0 => (at, new, fixed),
                        1 => (fixed, new, at),
                        _ => (at, fixed, new),
                    };
                    rig = rig
                        .mesh(sun, za, planet, zb, Some(carrier), one)
                        .mesh(planet, zb, ring, -(za + 2.0 * zb), Some(carrier), two)
                        .join(fixed, None)
                        .drag(Some(planet), Some(carrier), 0.1 * drag);
                    new
                }
                Stage::Twin(part) => {
                    rig.columns += 3;
                    let (a, b, out, row) = (new, new + 1, new + 2, rig.rows.len());
                    rig = rig
                        .mesh(at, za, a, zb, None, one)
                        .mesh(at, za, b, zb, None, two)
                        .mesh(a, zb, out, za + 1.0, None, two)
                        .mesh(b, zb, out, za + 1.0, None, one);
                    rig.shares.push(Share {
                        member: at,
                        a: (row, part),
                        b: (row + 1, 1.0 - part),
                    });
                    out
                }
            };
            rig = rig.drag(Some(end), None, drag);
            if !matches!(stage, Stage::Idle) {
                at = end;
            }
        }
        // At least one stage is between both ports.
        if at == 0 {
            at = rig.columns;
            rig.columns += 1;
            rig = rig.mesh(0, 20.0, at, 30.0, None, 0.01);
        }
        (rig, at)
    })
}

/// A loss of meshes that is not proportional to torque.
fn bent(rig: &Rig, out: usize, power: f64, speed: f64, torque: f64) -> Solved {
    let law = |k: usize, torque: f64, speed: f64| rig.meshes[k].1 * torque.powf(0.85) * speed.powf(0.9);
    solve_to(power, rig, &[0, out], &[(0, speed)], &[(0, torque)], law, |_| {
        Vec::new()
    })
}

/// Largest residual of equilibrium of a member over the largest torque, computed only from the reported torques and losses.
fn unrest(rig: &Rig, solved: &Solved) -> f64 {
    let mut rest: Vec<f64> = solved
        .work
        .ports
        .iter()
        .zip(&solved.work.drags)
        .map(|(port, drag)| port + drag)
        .collect();
    let mut largest = rest.iter().fold(0.0_f64, |most, torque| most.max(torque.abs()));
    for (row, multiplier) in rig.rows.iter().zip(&solved.work.multipliers) {
        for (column, coefficient) in &row.terms {
            rest[*column] += coefficient * multiplier;
            largest = largest.max((coefficient * multiplier).abs());
        }
    }
    let speed = |column: Option<usize>| column.map_or(0.0, |c| solved.speeds[c]);
    for (k, (mesh, _)) in rig.meshes.iter().enumerate() {
        let driven = if solved.work.drives[k] == Drive::Second {
            mesh.first
        } else {
            mesh.second
        };
        let relative = speed(driven) - speed(mesh.carrier);
        if solved.work.mesh_loss[k] > 0.0 {
            let friction = solved.work.mesh_loss[k] / relative;
            rest[driven.unwrap()] -= friction;
            if let Some(carrier) = mesh.carrier {
                rest[carrier] += friction;
            }
        }
    }
    rest.iter().fold(0.0_f64, |most, torque| most.max(torque.abs())) / largest.max(f64::MIN_POSITIVE)
}

fn converged(solved: &Solved) -> bool {
    matches!(solved.outcome, Outcome::Converged { .. })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn speeds_obey_every_row((rig, out) in train(), speed in -800.0..800.0_f64) {
        let motion = Motion::new(&rig.train(), &[0, out], &[0]).unwrap();
        let mut speeds = vec![0.0; rig.columns];
        motion.speeds(&[speed], &mut speeds);
        for row in &rig.rows {
            let sum: f64 = row.terms.iter().map(|(column, z)| z * speeds[*column]).sum();
            let size: f64 = row.terms.iter().map(|(column, z)| (z * speeds[*column]).abs()).sum();
            prop_assert!(sum.abs() <= 1e-11 * size.max(1e-300), "{sum} {size}");
        }
    }

    #[test]
    fn power_balance_closes_to_1e_12_of_the_largest_internal_power(
        (rig, out) in train(), speed in -800.0..800.0_f64, torque in -100.0..100.0_f64, loose in any::<bool>(),
    ) {
        prop_assume!(speed.abs() > 1.0);
        // For any tolerance of the loop.
        let solved = bent(&rig, out, if loose { 1e-4 } else { 1e-12 }, speed, torque);
        if converged(&solved) {
            let power: f64 = [0, out].iter().map(|p| solved.work.ports[*p] * solved.speeds[*p]).sum();
            prop_assert!((power - solved.loss()).abs() <= 1e-12 * solved.work.largest,
                "{} {} {}", power, solved.loss(), solved.work.largest);
            prop_assert!(solved.work.mesh_loss.iter().all(|loss| *loss >= 0.0));
        }
    }

    #[test]
    fn every_member_is_in_equilibrium(
        (rig, out) in train(), speed in 1.0..800.0_f64, torque in -100.0..100.0_f64,
    ) {
        let solved = bent(&rig, out, 1e-10, speed, torque);
        if converged(&solved) {
            let unrest = unrest(&rig, &solved);
            prop_assert!(unrest <= 1e-12, "{unrest}");
            for share in &rig.shares {
                let z1 = |row: usize| rig.meshes.iter().find(|m| m.0.row == row).unwrap().0;
                // Whether or not the first gear drives, the share is that of the actual torques, including friction.
                let torque = |row: usize| {
                    let k = rig.meshes.iter().position(|m| m.0.row == row).unwrap();
                    let full = solved.work.multipliers[row] * z1(row).z1;
                    if solved.work.drives[k] == Drive::Second {
                        full - solved.work.mesh_loss[k] / solved.speeds[share.member]
                    } else {
                        full
                    }
                };
                let (a, b) = (torque(share.a.0), torque(share.b.0));
                prop_assert!((share.b.1 * a - share.a.1 * b).abs() <= 1e-11 * (a.abs() + b.abs()), "{a} {b}");
            }
        }
    }

    #[test]
    fn the_tolerance_is_kept((rig, out) in train(), speed in 1.0..800.0_f64, torque in -100.0..100.0_f64) {
        let (quick, exact) = (bent(&rig, out, 1e-8, speed, torque), bent(&rig, out, 1e-13, speed, torque));
        if converged(&quick) && converged(&exact) {
            prop_assert!(quick.passes() <= exact.passes());
            for (a, b) in quick.work.mesh_loss.iter().zip(&exact.work.mesh_loss) {
                prop_assert!((a - b).abs() <= 1e-8 * exact.work.largest, "{a} {b} {}", exact.work.largest);
            }
        }
    }

    /// A constant and a power of a torque, of teeth and of bearings that read the torques of both stages.
    #[test]
    fn accepted_losses_are_those_at_the_accepted_torques(
        torque in prop_oneof![-100.0..-1.0_f64, 1.0..100.0_f64], speed in 10.0..800.0_f64,
        zeta in prop::array::uniform3(1e-4..0.05_f64), drag in 1e-5..0.03_f64,
        exponents in prop::array::uniform2(0.0..2.0_f64), constants in prop::array::uniform2(0.0..1.0_f64),
    ) {
        let rig = two_speed(&[3], zeta).loaded(0).loaded(2);
        let relative = |x: f64, which: usize| {
            let [constant, exponent] = [constants[which], exponents[which]];
            constant + (1.0 - constant) * x.powf(exponent)
        };
        let law = |k: usize, driver: f64, speed: f64| zeta[k] * torque.abs() * relative(driver / torque.abs(), 0) * speed;
        let moments = |multipliers: &[f64], speeds: &[f64]| {
            let size = (multipliers[0].abs() + 0.3 * multipliers[1].abs()) * 19.0 / torque.abs();
            let moment = drag * torque.abs() * relative(size, 1);
            speeds.iter().map(|speed| -moment * speed.signum()).collect::<Vec<_>>()
        };
        let solved = solve_to(1e-9, &rig, &[0, 2], &[(0, speed)], &[(0, torque)], law, |state| {
            moments(state.multipliers, state.speeds)
        });
        if !converged(&solved) {
            return Ok(());
        }
        let work = &solved.work;
        let limit = 1e-9 * work.largest;
        for (k, (mesh, _)) in rig.meshes.iter().enumerate() {
            let at = |column: Option<usize>| column.map_or(0.0, |c| solved.speeds[c]);
            let (z, gear) = if work.drives[k] == Drive::Second { (mesh.sz2, mesh.second) } else { (mesh.z1, mesh.first) };
            let own = law(k, (work.multipliers[mesh.row] * z).abs(), (at(gear) - at(mesh.carrier)).abs());
            prop_assert!((own - work.mesh_loss[k]).abs() <= limit, "mesh {k}: {own} {}", work.mesh_loss[k]);
        }
        let torques = moments(&work.multipliers, &solved.speeds);
        for column in &rig.loaded {
            let apart = (torques[*column] - work.drags[*column]) * solved.speeds[*column];
            prop_assert!(apart.abs() <= limit, "bearing at {column}: {apart}");
        }
    }

    #[test]
    fn ideal_and_real_losses_agree_to_second_order(
        (rig, out) in train(), speed in 10.0..800.0_f64, torque in 1.0..100.0_f64,
    ) {
        let scaled = |factor: f64| {
            let mut rig = rig.clone();
            rig.meshes.iter_mut().for_each(|m| m.1 *= factor);
            rig.drags.clear();
            rig
        };
        let ideal: f64 = solve(&scaled(0.0), &[0, out], &[(0, speed)], &[(0, torque)])
            .work.rolling.iter().zip(&rig.meshes).map(|(power, mesh)| power.abs() * mesh.1).sum();
        let gap = |factor: f64| {
            let solved = solve(&scaled(factor), &[0, out], &[(0, speed)], &[(0, torque)]);
            converged(&solved).then(|| (factor * ideal - solved.loss()).abs())
        };
        // A hundredth of the loss leaves about a ten-thousandth of the gap, with the smaller of both at rounding.
        if let (Some(large), Some(small)) = (gap(1e-2), gap(1e-4)) {
            prop_assert!(small <= 2e-4 * large + 1e-9 * speed * torque, "{large} {small}");
        }
    }

    #[test]
    fn reversing_speed_and_torque_mirrors_the_flow(
        (rig, out) in train(), speed in 1.0..800.0_f64, torque in -100.0..100.0_f64,
    ) {
        let forward = solve(&rig, &[0, out], &[(0, speed)], &[(0, torque)]);
        let back = solve(&rig, &[0, out], &[(0, -speed)], &[(0, -torque)]);
        prop_assert_eq!(forward.outcome, back.outcome);
        if converged(&forward) {
            // Every operation is odd or even in both signs, so even the bits agree.
            prop_assert_eq!(forward.loss(), back.loss());
            for (a, b) in forward.work.multipliers.iter().zip(&back.work.multipliers) {
                prop_assert_eq!(*a, -b);
            }
        }
    }

    #[test]
    fn trains_with_fixed_axes_always_have_a_flow(
        teeth in proptest::collection::vec((15_u32..60, 15_u32..60, 0.0..0.04_f64), 1..6),
        drag in 0.0..0.3_f64, speed in 1.0..800.0_f64, torque in -100.0..100.0_f64,
    ) {
        let mut rig = Rig::new(teeth.len() + 1);
        for (k, (za, zb, loss)) in teeth.iter().enumerate() {
            rig = rig.mesh(k, f64::from(*za), k + 1, f64::from(*zb), None, *loss).drag(Some(k + 1), None, drag);
        }
        let solved = bent(&rig, teeth.len(), 1e-10, speed, torque);
        prop_assert!(converged(&solved), "{:?}", solved.outcome);
        let balance = solved.balance(&[0, teeth.len()]);
        prop_assert!(balance.efficiency().is_none_or(|eta| eta > 0.0 && eta <= 1.0));
    }
}
