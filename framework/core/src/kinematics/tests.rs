#![allow(clippy::unwrap_used)]
use super::*;
use std::f64::consts::PI;

/// Two-speed example: input, intermediate, output, G3, G5; M1, M2, M3 and what is engaged.
fn two_speed(engaged: &[usize]) -> Train {
    let mut rows = vec![
        Row::mesh(Some(0), 16.0, Some(1), 83.0, None),
        Row::mesh(Some(3), 24.0, Some(2), 101.0, None),
        Row::mesh(Some(4), 31.0, Some(2), 96.0, None),
    ];
    rows.extend(engaged.iter().map(|gear| Row::joined(Some(1), Some(*gear))));
    Train { columns: 5, rows }
}

const PORTS: [usize; 2] = [0, 2];

fn rpm(motion: &Motion, prescribed: &[f64]) -> Vec<f64> {
    let mut speeds = vec![0.0; 5];
    let given: Vec<f64> = prescribed.iter().map(|n| n * PI / 30.0).collect();
    motion.speeds(&given, &mut speeds);
    speeds.iter().map(|w| w * 30.0 / PI).collect()
}

fn close(values: &[f64], printed: &[f64]) {
    let largest = printed.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    for (value, expected) in values.iter().zip(printed) {
        assert!(
            (value - expected).abs() <= 1e-7 * largest,
            "{values:?} against {printed:?}"
        );
    }
}

#[test]
fn t1_speeds_in_first_second_and_neutral() {
    let first = Motion::new(&two_speed(&[3]), &PORTS, &[0]).unwrap();
    close(
        &rpm(&first, &[22000.0]),
        &[22000.0, -4240.96386, 1007.75379, -4240.96386, -3120.78592],
    );
    let second = Motion::new(&two_speed(&[4]), &PORTS, &[0]).unwrap();
    close(
        &rpm(&second, &[22000.0]),
        &[22000.0, -4240.96386, 1369.47791, -5763.21954, -4240.96386],
    );
    let neutral = Motion::new(&two_speed(&[]), &PORTS, &[0, 2]).unwrap();
    close(
        &rpm(&neutral, &[3000.0, 500.0]),
        &[3000.0, -578.313253, 500.0, -2104.16667, -1548.3871],
    );
    assert_eq!(
        (Motion::freedom(&two_speed(&[3])), Motion::freedom(&two_speed(&[]))),
        (1, 2)
    );
}

#[test]
fn t1_relative_speed_of_the_loose_pinions() {
    let first = rpm(&Motion::new(&two_speed(&[3]), &PORTS, &[0]).unwrap(), &[22000.0]);
    close(&[first[4] - first[1]], &[1120.17794]);
    let second = rpm(&Motion::new(&two_speed(&[4]), &PORTS, &[0]).unwrap(), &[22000.0]);
    close(&[second[1] - second[3]], &[1522.25572]);
}

#[test]
fn t_faults_name_the_guilty() {
    let faults =
        |engaged: &[usize], prescribed: &[usize]| Motion::new(&two_speed(engaged), &PORTS, prescribed).unwrap_err();
    assert_eq!(
        faults(&[], &[0]),
        [Fault::Under {
            columns: vec![2, 3, 4],
            ports: vec![2]
        }]
    );
    match faults(&[3], &[0, 2]).as_slice() {
        [Fault::Tied { port, others, rows }] => {
            let mut both = vec![*port, others[0].0];
            both.sort_unstable();
            assert_eq!((both, rows.as_slice()), (vec![0, 2], &[0, 1, 3][..]));
            let ratio = others[0].1.abs();
            assert!((ratio.max(1.0 / ratio) - 21.8307292).abs() < 1e-6);
        }
        other => panic!("{other:?}"),
    }
    assert_eq!(
        faults(&[3, 4], &[0]),
        [Fault::Locked {
            port: 0,
            rows: vec![0, 1, 2, 3, 4]
        }]
    );
    let both = faults(&[3, 4], &[0, 2]);
    assert!(
        both.contains(&Fault::Locked {
            port: 0,
            rows: vec![0, 1, 2, 3, 4]
        }),
        "{both:?}"
    );
    assert!(
        both.contains(&Fault::Locked {
            port: 2,
            rows: vec![1, 2, 3, 4]
        }),
        "{both:?}"
    );
}

#[test]
fn s1_six_shafts_in_a_chain() {
    let train = Train {
        columns: 6,
        rows: vec![
            Row::mesh(Some(0), 23.0, Some(1), 57.0, None),
            Row::mesh(Some(1), 19.0, Some(2), 41.0, None),
            Row::mesh(Some(2), 41.0, Some(3), 47.0, None),
            Row::mesh(Some(3), 21.0, Some(4), 64.0, None),
            Row::mesh(Some(4), 26.0, Some(5), -89.0, None),
        ],
    };
    let motion = Motion::new(&train, &[0, 5], &[0]).unwrap();
    let mut speeds = vec![0.0; 6];
    motion.speeds(&[3000.0], &mut speeds);
    close(
        &speeds,
        &[3000.0, -1210.52632, 560.97561, -489.361702, 160.571809, 46.9086182],
    );
}

#[test]
fn r_a_loop_is_redundant_and_the_slightest_difference_locks_it() {
    let train = |other: f64| Train {
        columns: 4,
        rows: vec![
            Row::mesh(Some(0), 40.0, Some(1), 50.0, None),
            Row::mesh(Some(0), 40.0, Some(2), other, None),
            Row::mesh(Some(1), 20.0, Some(3), 60.0, None),
            Row::mesh(Some(2), 20.0, Some(3), 60.0, None),
        ],
    };
    let motion = Motion::new(&train(50.0), &[0, 3], &[0]).unwrap();
    let rank = 4 - Motion::freedom(&train(50.0));
    assert_eq!((rank, motion.loops.clone()), (3, vec![vec![0, 1, 2, 3]]));
    let locked = Motion::new(&train(51.0), &[0, 3], &[0]).unwrap_err();
    assert_eq!(
        locked,
        [Fault::Locked {
            port: 0,
            rows: vec![0, 1, 2, 3]
        }]
    );
}

#[test]
fn standstill_and_reversal() {
    let first = Motion::new(&two_speed(&[3]), &PORTS, &[0]).unwrap();
    assert!(rpm(&first, &[0.0]).iter().all(|n| *n == 0.0));
    let (forward, back) = (rpm(&first, &[100.0]), rpm(&first, &[-100.0]));
    assert!(forward.iter().zip(&back).all(|(a, b)| *a == -b));
}

#[test]
fn a7_planetary_speeds() {
    // Sun, planet and carrier with the ring gear held: the sun's speed determines the carrier's, and the planet rotates in the opposite direction.
    for (zs, zp, zr, sun, carrier, relative, absolute) in [
        (24.0, 24.0, 72.0, 3000.0, 750.0, -2250.0, -1500.0),
        (30.0, 20.0, 70.0, 1000.0, 300.0, -1050.0, -750.0),
    ] {
        let train = Train {
            columns: 4,
            rows: vec![
                Row::mesh(Some(0), zs, Some(1), zp, Some(2)),
                Row::mesh(Some(1), zp, Some(3), -zr, Some(2)),
                Row::joined(Some(3), None),
            ],
        };
        let motion = Motion::new(&train, &[0, 2], &[0]).unwrap();
        let mut speeds = vec![0.0; 4];
        motion.speeds(&[sun], &mut speeds);
        close(
            &[speeds[2], speeds[1], speeds[1] - speeds[2]],
            &[carrier, absolute, relative],
        );
    }
}

/// A chain of shafts with ratios around one.
fn chain(shafts: usize) -> Train {
    let row = |i: usize| {
        Row::mesh(
            Some(i),
            (20 + i * 7 % 5) as f64,
            Some(i + 1),
            (20 + i * 11 % 5) as f64,
            None,
        )
    };
    Train {
        columns: shafts,
        rows: (0..shafts - 1).map(row).collect(),
    }
}

/// Shafts around a common one.
fn star(shafts: usize) -> Train {
    let row = |i: usize| Row::mesh(Some(0), 60.0, Some(i), (17 + i % 9) as f64, None);
    Train {
        columns: shafts,
        rows: (1..shafts).map(row).collect(),
    }
}

#[test]
fn work_grows_with_the_number_of_shafts() {
    for train in [chain, star] {
        let work = |shafts: usize| {
            let reduced = Reduced::new(&train(shafts), &[0, shafts - 1], &[0]);
            assert_eq!(reduced.rank(), shafts - 1);
            reduced.work()
        };
        assert!(
            work(4000) <= 4 * work(1000) + 100,
            "{} after {}",
            work(4000),
            work(1000)
        );
    }
}

#[test]
fn long_chains_move_by_the_product_of_their_ratios() {
    let train = chain(3000);
    let motion = Motion::new(&train, &[0, 2999], &[0]).unwrap();
    let mut speeds = vec![0.0; 3000];
    motion.speeds(&[100.0], &mut speeds);
    let mut speed = 100.0;
    for (i, solved) in speeds.iter().enumerate() {
        assert!(
            (solved - speed).abs() <= 1e-12 * speed.abs() * (i + 1) as f64,
            "{i}: {solved}, {speed}"
        );
        speed *= -((20 + i * 7 % 5) as f64) / (20 + i * 11 % 5) as f64;
    }
}

#[test]
fn the_rows_of_a_fault_in_a_long_chain_are_named() {
    let mut train = chain(500);
    // An odd number of meshes reverses the sense of rotation.
    train.rows.push(Row::joined(Some(200), Some(261)));
    let Err(faults) = Motion::new(&train, &[0], &[0]) else {
        panic!("a loop with another ratio moves")
    };
    let rows: Vec<usize> = (200..261).chain([499]).collect();
    let [Fault::Locked { port: 0, rows: locked }] = &faults[..] else {
        panic!("{faults:?}")
    };
    assert!(rows.iter().all(|row| locked.contains(row)), "{locked:?}");
}
