//! Torque splits: differentials and redundant loops.

use super::*;

/// case 0, left 1, right 2, difference 3.
fn differential(zeta: f64) -> Rig {
    let mut rig = Rig::new(4).mesh(1, 1.0, 2, 1.0, Some(0), zeta);
    rig.rows.push(Row::difference((1, 1.0), (2, 1.0), 3));
    rig
}

#[test]
fn d_differential() {
    let prescribed = [(0, rpm(1000.0)), (1, rpm(1040.0))];
    let ports = [0, 1, 2];
    for (zeta, left, right, loss, efficiency) in [
        (0.0, -150.0, -150.0, 0.0, 1.0),
        (0.05, -146.153846, -153.846154, 32.2214631, 0.998974359),
    ] {
        // The difference is a plain column here: it follows from the prescribed speeds and carries no torque.
        let solved = solve(&differential(zeta), &ports, &prescribed, &[(0, 300.0)]);
        close(solved.speeds[2], rpm(960.0), 100.0);
        close(solved.work.ports[1], left, 150.0);
        close(solved.work.ports[2], right, 150.0);
        close(solved.loss(), loss, 32.0);
        close(solved.efficiency(&ports), efficiency, 1.0);
    }
    let equal = solve(
        &differential(0.05),
        &[0, 1, 2, 3],
        &[(0, rpm(1000.0)), (3, 0.0)],
        &[(0, 300.0), (3, 0.0)],
    );
    close(equal.speeds[1], rpm(1000.0), 100.0);
    close(equal.work.ports[1], -150.0, 150.0);
    close(equal.work.ports[2], -150.0, 150.0);
    assert_eq!(equal.work.mesh_loss[0], 0.0);
    let alone = Motion::new(&differential(0.0).train(), &ports, &[0]).unwrap_err();
    match alone.as_slice() {
        [crate::kinematics::Fault::Under { ports, .. }] => assert_eq!(ports, &[1, 2]),
        other => panic!("{other:?}"),
    }
}

#[test]
fn r_twin_countershaft() {
    let rig = |parts: Option<(f64, f64)>| {
        let mut rig = Rig::new(4)
            .mesh(0, 40.0, 1, 50.0, None, 0.0)
            .mesh(0, 40.0, 2, 50.0, None, 0.0)
            .mesh(1, 20.0, 3, 60.0, None, 0.0)
            .mesh(2, 20.0, 3, 60.0, None, 0.0);
        if let Some((a, b)) = parts {
            rig.shares.push(Share {
                member: 0,
                a: (0, a),
                b: (1, b),
            });
        }
        rig
    };
    for (parts, lambda) in [
        ((0.5, 0.5), [-2.5, -2.5, 6.25, 6.25]),
        ((0.55, 0.45), [-2.75, -2.25, 6.875, 5.625]),
    ] {
        let solved = solve(&rig(Some(parts)), &[0, 3], &[(0, 100.0)], &[(0, 200.0)]);
        close(solved.work.ports[3], -750.0, 750.0);
        for (value, printed) in solved.work.multipliers.iter().zip(lambda) {
            close(*value, printed, 7.0);
        }
    }
    let train = rig(None).train();
    let motion = Motion::new(&train, &[0, 3], &[0]).unwrap();
    let fault = Flow::new(
        &train,
        Vec::new(),
        Vec::new(),
        &motion.loops,
        (vec![3], vec![0]),
        Vec::new(),
    )
    .unwrap_err();
    assert_eq!(
        fault,
        FlowFault::Redundant {
            loops: vec![vec![0, 1, 2, 3]]
        }
    );
    let count = Flow::new(
        &train,
        Vec::new(),
        Vec::new(),
        &motion.loops,
        (vec![], vec![0, 3]),
        Vec::new(),
    )
    .unwrap_err();
    assert_eq!(count, FlowFault::Count { needed: 1, given: 2 });
}
