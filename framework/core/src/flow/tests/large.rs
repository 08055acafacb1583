//! Large trains.
#![allow(clippy::cast_possible_wrap)]

use super::*;

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
fn the_efficiency_of_a_chain_is_the_product_of_those_of_its_meshes() {
    for shafts in [40, 64, 65, 66, 400] {
        let expected = (1.0_f64 - 1e-4).powi(shafts as i32 - 1);
        let found = efficiency(shafts);
        assert!((found - expected).abs() <= 1e-11, "{shafts}: {found}, {expected}");
    }
}

#[test]
fn the_work_for_a_chain_grows_with_its_length() {
    let entries = |shafts: usize| {
        let (_, flow) = chain(shafts).flow(&[0, shafts - 1], &[0], &[0]);
        let order = flow.order(&vec![Drive::First; shafts - 1]).unwrap();
        let blocks = order.blocks.iter();
        blocks
            .map(|block| {
                block.factors.len()
                    + block
                        .equations
                        .iter()
                        .map(|e| e.unknowns.len() + e.laws.len())
                        .sum::<usize>()
            })
            .sum::<usize>()
    };
    // Each shaft has one unknown, and but for the first one that before and its loss.
    assert_eq!(entries(1000), 1000 + 2 * 999);
    assert_eq!(entries(4000), 4000 + 2 * 3999);
}
