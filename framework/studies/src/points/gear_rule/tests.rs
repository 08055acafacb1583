use super::*;

/// Loss of a machine at a speed (rad/s) and a torque (Nm): P = 40 + 0.5 w + 4e-4 w2 + 0.08 T2 + 2e-3 w |T|. \[W\]
fn machine(w: f64, t: f64) -> f64 {
    40.0 + 0.5 * w + 4e-4 * w * w + 0.08 * t * t + 2e-3 * w * t.abs()
}

/// Ten seconds of a vehicle with two gears, wheels of 0.3 m: P_in = P_wheel/0.98 (times 0.98 while braking) + 0.9 or 0.6 w_in.
fn ten_seconds() -> Vec<Vec<Offer>> {
    let speeds = [4.0, 8.0, 5.0, 9.0, 4.0, 10.0, 6.0, 5.0, 12.0, 4.0];
    let forces = [
        1800.0, 500.0, 1900.0, 450.0, 1800.0, 300.0, 2000.0, 1900.0, 200.0, -1400.0,
    ];
    let interval = |(v, force): (f64, f64)| {
        let gear = |(ratio, drag): (f64, f64)| {
            let (w, wheels) = (v / 0.3 * ratio, force * v);
            let shaft = if wheels > 0.0 { wheels / 0.98 } else { wheels * 0.98 };
            let input = shaft + drag * w;
            Offer {
                power: input + machine(w, input / w),
                loss: input - wheels,
                excess: 0.0,
            }
        };
        [(12.0, 0.9), (7.0, 0.6)].map(gear).to_vec()
    };
    speeds.into_iter().zip(forces).map(interval).collect()
}

/// The gears by the rule, at equal durations. \[s\]
fn by_rule(rule: &Rule, offers: &[Vec<Offer>], duration: f64) -> (Vec<usize>, Vec<Pick>) {
    let mut now = Shifting::default();
    let pick = |offers: &Vec<Offer>| {
        let pick = rule.pick(now, offers);
        now = now.after(pick.gear, duration);
        pick
    };
    let picks: Vec<Pick> = offers.iter().map(pick).collect();
    (picks.iter().map(|pick| pick.gear).collect(), picks)
}

fn shifts(gears: &[usize]) -> usize {
    gears.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

/// Gears as digits, from 1.
fn digits(gears: &[usize]) -> String {
    gears.iter().map(|gear| (gear + 1).to_string()).collect()
}

/// Drawn power of the first second, computed independently with NumPy.
#[test]
fn drawn_power_is_that_of_the_hand_calculation() {
    let offers = ten_seconds();
    let expected = [[7811.517, 8011.193], [4634.249, 4389.668], [10244.612, 10447.509]];
    for (offers, expected) in offers.iter().zip(expected) {
        for (offer, expected) in offers.iter().zip(expected) {
            assert!((offer.power - expected).abs() < 5e-4, "{offer:?} {expected}");
        }
    }
}

/// Least energies over all 1024 sequences, for three energies of a shift.
#[test]
fn the_least_energy_is_that_of_all_sequences() {
    let (offers, durations) = (ten_seconds(), [1.0; 10]);
    let cases = [
        (0.0, "1212121121", 58_977.020_2, 8),
        (100.0, "1212221122", 59_730.517_5, 5),
        (300.0, "2222222222", 60_043.280_7, 0),
    ];
    for (cost, expected, least, count) in cases {
        let shift = |_: usize, _: usize, _: usize| cost;
        let gears = least_energy(&offers, &durations, &shift);
        assert_eq!(digits(&gears), expected, "{cost} J");
        assert_eq!(shifts(&gears), count);
        let found = energy(&offers, &durations, &gears, &shift);
        assert!((found - least).abs() < 5e-5, "{found} {least}");
        let all = (0..1024_usize).map(|bits| {
            let gears: Vec<usize> = (0..10).map(|i| bits >> i & 1).collect();
            energy(&offers, &durations, &gears, &shift)
        });
        assert_eq!(found, all.fold(f64::INFINITY, f64::min), "brute force at {cost} J");
    }
    let first = energy(&offers, &durations, &[0; 10], &|_, _, _| 0.0);
    assert!((first - 60_266.568_5).abs() < 5e-5, "{first}");
}

#[test]
fn the_rule_gives_the_sequences_of_the_hand_calculation() {
    let (offers, durations) = (ten_seconds(), [1.0; 10]);
    let cases = [
        (0.0, 0.0, "1212121121", 58_977.020_2),
        (250.0, 0.0, "1112222222", 59_885.288_2),
        (0.0, 3.0, "1222111122", 59_570.528_8),
    ];
    for (saving, dwell, expected, sum) in cases {
        let (gears, picks) = by_rule(&Rule { saving, dwell }, &offers, 1.0);
        assert_eq!(digits(&gears), expected, "{saving} W, {dwell} s");
        assert!(picks.iter().all(|pick| !pick.forced && !pick.beyond));
        let found = energy(&offers, &durations, &gears, &|_, _, _| 0.0);
        assert!((found - sum).abs() < 5e-5, "{found} {sum}");
    }
}

/// Numbers between 0 and 1 from a seed: a linear congruential generator.
fn random(seed: &mut u64) -> f64 {
    *seed = seed
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

/// 500 random cycles of up to 40 intervals with two to four gears: the rule never shifts more often than without saving and dwell, forced
/// shifts aside; the optimum never needs more energy than the rule.
#[test]
fn hysteresis_never_adds_shifts_and_the_optimum_is_never_worse() {
    let seed = &mut 7;
    for case in 0..500 {
        let gears = 2 + case % 3;
        let count = 2 + (random(seed) * 38.0) as usize;
        let with_limits = case % 2 == 1;
        let mut offer = || Offer {
            power: 1000.0 * random(seed),
            loss: 100.0,
            excess: if with_limits && random(seed) < 0.1 {
                random(seed)
            } else {
                0.0
            },
        };
        let offers: Vec<Vec<Offer>> = (0..count).map(|_| (0..gears).map(|_| offer()).collect()).collect();
        let rule = Rule {
            saving: 400.0 * random(seed),
            dwell: 5.0 * random(seed),
        };
        let durations: Vec<f64> = vec![1.0; count];
        let (with, picks) = by_rule(&rule, &offers, 1.0);
        let (without, _) = by_rule(&Rule::default(), &offers, 1.0);
        let forced = picks.iter().filter(|pick| pick.forced).count();
        assert!(
            shifts(&with) <= shifts(&without) + forced,
            "case {case}: {with:?} {without:?}"
        );
        if !with_limits {
            assert!(forced == 0 && shifts(&with) <= shifts(&without), "case {case}");
        }
        let cost = 300.0 * random(seed);
        let shift = |_: usize, _: usize, _: usize| cost;
        let best = least_energy(&offers, &durations, &shift);
        for gears in [&with, &without] {
            let difference = energy(&offers, &durations, gears, &shift) - energy(&offers, &durations, &best, &shift);
            assert!(difference >= -1e-9, "case {case}: {difference}");
        }
    }
}

#[test]
fn a_limit_overrides_saving_and_dwell_and_is_counted() {
    let within = |power: f64| Offer {
        power,
        loss: 10.0,
        excess: 0.0,
    };
    let beyond = |power: f64, excess: f64| Offer {
        excess,
        ..within(power)
    };
    let rule = Rule {
        saving: 1e6,
        dwell: 1e6,
    };
    let now = Shifting::default().after(0, 1.0).after(1, 1.0);
    let pick = rule.pick(now, &[within(900.0), beyond(100.0, 0.1)]);
    assert_eq!((pick.gear, pick.forced, pick.beyond), (0, true, false));
    // Beyond in both gears: that with the smallest excess, and said.
    let pick = rule.pick(now, &[beyond(900.0, 0.05), beyond(100.0, 0.1)]);
    assert_eq!((pick.gear, pick.forced, pick.beyond), (0, true, true));
    // A gear without a solution is never chosen while there is another.
    let pick = Rule::default().pick(now, &[beyond(900.0, 0.5), beyond(f64::NAN, f64::INFINITY)]);
    assert_eq!((pick.gear, pick.beyond), (0, true));
}

#[test]
fn a_choice_that_warmer_oil_may_change_is_not_clear() {
    let offers = |difference: f64| {
        let offer = |power: f64| Offer {
            power,
            loss: 100.0,
            excess: 0.0,
        };
        [offer(1000.0), offer(1000.0 - difference)]
    };
    let now = Shifting::default().after(0, 10.0);
    let clear = |saving: f64, difference: f64| {
        let rule = Rule { saving, dwell: 0.0 };
        let pick = rule.pick(now, &offers(difference));
        (pick.gear, pick.is_clear)
    };
    assert_eq!(clear(0.0, 50.0), (1, true));
    assert_eq!(clear(0.0, 5.0), (1, false));
    assert_eq!(clear(0.0, -5.0), (0, false));
    assert_eq!(clear(50.0, 45.0), (0, false));
    assert_eq!(clear(50.0, 20.0), (0, true));
    assert_eq!(clear(50.0, 100.0), (1, true));
}
