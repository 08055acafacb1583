//! Trains beyond the size whose inverse is computed.
#![allow(clippy::cast_possible_wrap)]

use super::*;
use crate::flow::system::Solver;

/// A chain of shafts whose meshes lose a constant share, and its efficiency.
fn chain(shafts: usize) -> Rig {
    (1..shafts).fold(Rig::new(shafts), |rig, i| {
        rig.mesh(i - 1, (20 + i % 3) as f64, i, (21 + i % 2) as f64, None, 1e-4)
    })
}

fn efficiency(shafts: usize) -> f64 {
    let rig = chain(shafts);
    let ports = [0, shafts - 1];
    let share = |_: usize, torque: f64, speed: f64| 1e-4 * (torque * speed).abs();
    let solved = solve_with(&rig, &ports, &[(0, 100.0)], &[(0, 10.0)], share, |_| Vec::new());
    let balance = solved.balance(&ports);
    assert!((balance.input - balance.output - solved.loss()).abs() <= 1e-12 * balance.input);
    solved.efficiency(&ports)
}

#[test]
fn both_solvers_give_the_product_of_the_efficiencies() {
    for shafts in [40, 64, 65, 66, 400] {
        let expected = (1.0_f64 - 1e-4).powi(shafts as i32 - 1);
        let found = efficiency(shafts);
        assert!((found - expected).abs() <= 1e-11, "{shafts}: {found}, {expected}");
    }
}

#[test]
fn factors_of_a_chain_have_no_more_entries_than_its_matrix() {
    let work = |shafts: usize| {
        let rig = chain(shafts);
        let train = rig.train();
        let motion = Motion::new(&train, &[0, shafts - 1], &[0]).unwrap();
        let meshes = rig.meshes.iter().map(|m| m.0).collect();
        let flow = Flow::new(&train, meshes, Vec::new(), &motion.loops, vec![shafts - 1], vec![0]).unwrap();
        let Solver::Elimination { elimination, .. } = &flow.solver else {
            panic!("it is large")
        };
        (elimination.len(), elimination.multiplications())
    };
    let (entries, multiplications) = work(1000);
    assert_eq!(entries, 2 * 999 + 1);
    let (_, more) = work(4000);
    assert!(more <= 4 * multiplications + 100, "{more} after {multiplications}");
}
