//! The order of blocks.

use std::cell::RefCell;
use std::collections::BTreeSet;

use proptest::prelude::*;

use super::properties::train;
use super::two_speed::two_speed;
use super::*;
use crate::flow::order::Order;

/// A pattern of driving gears from bits.
fn pattern(flow: &Flow, bits: u32) -> Vec<Drive> {
    let second = |k: usize| bits >> (k % 32) & 1 == 1;
    let drives = (0..flow.meshes().len()).map(|k| if second(k) { Drive::Second } else { Drive::First });
    drives.collect()
}

/// The same train with its columns, meshes and other rows in reverse.
fn reversed(rig: &Rig) -> Rig {
    let column = |column: usize| rig.columns - 1 - column;
    let (meshes, rows) = (rig.meshes.len(), rig.rows.len());
    let row = |row: usize| {
        if row < meshes {
            meshes - 1 - row
        } else {
            meshes + rows - 1 - row
        }
    };
    let mut turned = Rig {
        rows: vec![Row { terms: Vec::new() }; rows],
        loaded: rig.loaded.iter().map(|c| column(*c)).collect(),
        ..Rig::new(rig.columns)
    };
    for (k, old) in rig.rows.iter().enumerate() {
        turned.rows[row(k)].terms = old.terms.iter().map(|(c, z)| (column(*c), *z)).collect();
    }
    turned.meshes = rig.meshes.iter().rev().copied().collect();
    for (mesh, _) in &mut turned.meshes {
        mesh.row = row(mesh.row);
        for gear in [&mut mesh.first, &mut mesh.second, &mut mesh.carrier] {
            *gear = gear.map(column);
        }
    }
    turned.shares = rig.shares.clone();
    for share in &mut turned.shares {
        share.member = column(share.member);
        (share.a.0, share.b.0) = (row(share.a.0), row(share.b.0));
    }
    turned
}

/// Rows and meshes of each loop.
fn loops(order: &Order, name: impl Fn(usize) -> usize) -> BTreeSet<Vec<usize>> {
    let loops = order.blocks.iter().filter(|block| block.is_loop());
    let named = loops.map(|block| {
        let mut rows: Vec<usize> = block.unknowns.iter().map(|unknown| name(*unknown)).collect();
        rows.sort_unstable();
        rows
    });
    named.collect()
}

/// Rows of trains in which meshes are the first rows.
fn sorted(rig: &Rig) -> Rig {
    let is_mesh = |row: usize| rig.meshes.iter().any(|(mesh, _)| mesh.row == row);
    let (first, last): (Vec<usize>, Vec<usize>) = (0..rig.rows.len()).partition(|row| is_mesh(*row));
    let order: Vec<usize> = first.into_iter().chain(last).collect();
    let place = |row: usize| order.iter().position(|other| *other == row).unwrap();
    let mut rig = rig.clone();
    let rows = rig.rows.clone();
    rig.rows = order.iter().map(|row| rows[*row].clone()).collect();
    for (mesh, _) in &mut rig.meshes {
        mesh.row = place(mesh.row);
    }
    for share in &mut rig.shares {
        (share.a.0, share.b.0) = (place(share.a.0), place(share.b.0));
    }
    rig
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn blocks_read_only_what_is_known((rig, out) in train(), bits in any::<u32>(), loaded in any::<bool>()) {
        let rig = if loaded { rig.loaded(out).loaded(0) } else { rig };
        let (_, flow) = rig.flow(&[0, out], &[0], &[0]);
        let order = flow.order(&pattern(&flow, bits)).unwrap();
        let (mut unknowns, mut laws) = (BTreeSet::new(), BTreeSet::new());
        for block in &order.blocks {
            for equation in &block.equations {
                prop_assert!(equation.unknowns.iter().all(|(unknown, _)| unknowns.contains(unknown)));
                prop_assert!(equation.laws.iter().all(|(law, _)| laws.contains(law)));
            }
            prop_assert!(block.unknowns.iter().all(|unknown| unknowns.insert(*unknown)), "twice");
            for &mesh in &block.laws.meshes {
                prop_assert!(unknowns.contains(&flow.meshes()[mesh].row));
                prop_assert!(laws.insert(mesh), "twice");
            }
            for &drag in &block.laws.drags {
                prop_assert!(flow.drags()[drag].reads.iter().all(|r| flow.unknown_of(*r).is_none_or(|u| unknowns.contains(&u))));
                prop_assert!(laws.insert(flow.meshes().len() + drag), "twice");
            }
        }
        prop_assert_eq!(unknowns.len(), flow.equations.len());
        prop_assert_eq!(laws.len(), flow.meshes().len() + flow.drags().len());
    }

    #[test]
    fn loops_do_not_depend_on_numbers((rig, out) in train(), bits in any::<u32>()) {
        let rig = sorted(&rig.loaded(out));
        let back = reversed(&rig);
        let (first, last) = (rig.columns - 1, rig.columns - 1 - out);
        let (_, turned) = back.flow(&[first, last], &[first], &[first]);
        let (_, flow) = rig.flow(&[0, out], &[0], &[0]);
        let drives = pattern(&flow, bits);
        let reversed: Vec<Drive> = drives.iter().rev().copied().collect();
        let (meshes, rows) = (rig.meshes.len(), rig.rows.len());
        let name = |row: usize| match row {
            row if row < meshes => meshes - 1 - row,
            row if row < rows => meshes + rows - 1 - row,
            row => row,
        };
        prop_assert_eq!(
            loops(&flow.order(&drives).unwrap(), |row| row),
            loops(&turned.order(&reversed).unwrap(), name)
        );
    }
}

/// With torque given at the input each mesh of the path follows from the one before; in coast the torque of each depends on its own
/// loss, as that of the idle mesh does, which follows from the drag of its driven gear.
#[test]
fn laws_outside_of_loops_are_evaluated_once() {
    let rig = two_speed(&[3], [0.01, 0.008, 0.009]).drag(Some(4), None, 0.02);
    for (torque, expected) in [(10.0, [1, 1, 2]), (-10.0, [2, 2, 2])] {
        let calls = RefCell::new([0; 3]);
        let law = |k: usize, torque: f64, speed: f64| {
            calls.borrow_mut()[k] += 1;
            rig.meshes[k].1 * torque * speed
        };
        let solved = solve_to(1e-9, &rig, &[0, 2], &[(0, 800.0)], &[(0, torque)], law, |_| Vec::new());
        assert!(matches!(solved.outcome, Outcome::Converged { .. }));
        assert_eq!(*calls.borrow(), expected, "{torque}");
    }
}

/// A drag that depends on the tooth force of its shaft is a loop of one force, with the mesh after it.
#[test]
fn a_shaft_and_its_bearings_are_a_loop_of_one_force() {
    let rig = two_speed(&[3], [0.01, 0.008, 0.009]);
    let train = rig.train();
    let motion = Motion::new(&train, &[0, 2], &[0]).unwrap();
    let meshes = rig.meshes.iter().map(|m| m.0).collect();
    let bearing = LoadedDrag {
        component: 0,
        between: [Some(0), None],
        reads: vec![Reading::Row(0)],
        group: None,
    };
    let flow = Flow::new(
        &train,
        meshes,
        Vec::new(),
        &motion.loops,
        (vec![2], vec![0]),
        vec![bearing],
    )
    .unwrap();
    let order = flow.order(&[Drive::First; 3]).unwrap();
    let looped: Vec<_> = order.blocks.iter().filter(|block| block.is_loop()).collect();
    assert_eq!(looped.len(), 1);
    assert_eq!((&looped[0].unknowns[..], looped[0].leads.len()), (&[0][..], 1));
    assert_eq!((looped[0].laws.meshes.len(), &looped[0].laws.drags[..]), (0, &[0][..]));
}
