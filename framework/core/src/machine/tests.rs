#![allow(clippy::unwrap_used)]
use std::f64::consts::{PI, SQRT_2, TAU};
use std::fmt::Write as _;

use super::entry::{BridgeEntry, CurrentEntry, EnvelopeEntry, ReachEntry, WindingEntry};
use super::inverter::{Bridge, Conduction};
use super::*;
use crate::motor::PhaseCurrent;

const RPM: f64 = PI / 30.0;

fn close(value: f64, expected: f64, digits: f64) {
    assert!(
        (value - expected).abs() <= digits * expected.abs(),
        "{value} is not {expected}"
    );
}

/// P = 40 + 0.5 w + 4e-4 w2 + 0.08 T2 + 2e-3 w |T| at nine nodes.
fn synthetic() -> MotorMap {
    let mut rows = "speed [rpm],torque [Nm],loss [W]\n".to_owned();
    for n in [1000.0, 5000.0, 10_000.0] {
        for torque in [-100.0_f64, -50.0, 0.0, 50.0, 100.0] {
            let w = n * RPM;
            let loss = 40.0 + 0.5 * w + 4e-4 * w * w + 0.08 * torque * torque + 2e-3 * w * torque.abs();
            writeln!(rows, "{n},{torque},{loss}").unwrap();
        }
    }
    MotorMap::read(rows.as_bytes()).unwrap()
}

fn machine() -> Machine {
    Machine::of_map("machines.M", (0, 0), synthetic())
}

/// Nodes and bilinear values, calculated by hand.
#[test]
fn losses_are_interpolated_over_speed_and_signed_torque() {
    let machine = machine();
    let at = |n: f64, torque: f64| machine.loss(n * RPM, torque, 80.0).machine;
    for (n, torque, loss) in [
        (1000.0, 0.0, 96.746_368_4),
        (5000.0, 50.0, 663.821_536),
        (10_000.0, 100.0, 2_011.687_37),
        (3000.0, 75.0, 801.227_903),
        (3000.0, 25.0, 369.811_977),
        (3000.0, 0.0, 254.104_014),
        (7500.0, 60.0, 1_121.102_54),
    ] {
        close(at(n, torque), loss, 1e-8);
        close(at(n, -torque), loss, 1e-8);
    }
    // Both quadrants share the row of zero torque, so the loss is continuous there.
    close(at(3000.0, 1e-9), at(3000.0, 0.0), 1e-9);
    close(at(3000.0, -1e-9), at(3000.0, 0.0), 1e-9);
    let power = 3000.0 * RPM * 75.0;
    close(power / (power + at(3000.0, 75.0)), 0.967_113, 1e-6);
    close((power - at(3000.0, -75.0)) / power, 0.965_995, 1e-6);
}

#[test]
fn copper_losses_follow_the_temperature_of_the_winding() {
    let warmer = Machine {
        winding: Some(WindingEntry {
            temperature: 80.0,
            copper_share: 0.08 * 1e4 / 1_316.181_41,
        }),
        ..machine()
    };
    close(warmer.loss(5000.0 * RPM, 100.0, 140.0).machine, 1_468.827, 1e-6);
    close(warmer.loss(5000.0 * RPM, 100.0, 80.0).machine, 1_316.181, 1e-6);
}

#[test]
fn a_machine_that_is_off_loses_what_freewheels() {
    let off = Machine {
        freewheel: Some([vec![0.0, 100.0], vec![0.0, 20.0]]),
        inverter: Some(Inverter::Efficiency(0.9)),
        ..machine()
    };
    assert_eq!(off.loss(50.0, 0.0, 80.0).sum(), 10.0);
    assert!(off.loss(50.0, 1e-6, 80.0).sum() > 60.0);
    assert_eq!(off.loss(0.0, 0.0, 80.0), MachineLoss::default());
}

#[test]
fn torque_and_power_limit_and_follow_the_voltage() {
    let entry = EnvelopeEntry {
        peak: Some(ReachEntry {
            torque: 300.0,
            power: 150e3,
            speed: Some(12_000.0 * RPM),
        }),
        continuous: Some(ReachEntry {
            torque: 150.0,
            power: 80e3,
            speed: None,
        }),
        peak_time: Some(30.0),
        voltage: Some(400.0),
        beyond: BeyondEntry::Limit,
    };
    let envelope = Envelope::new(&entry, Some(400.0));
    close(150e3 / 300.0 / RPM, 4_774.648, 1e-6);
    close(envelope.most(8000.0 * RPM), 179.049_3, 1e-6);
    assert_eq!(envelope.most(4000.0 * RPM), 300.0);
    assert_eq!(envelope.most(12_001.0 * RPM), 0.0);
    assert_eq!(envelope.reached(100.0, -151.0), Reached::Peak);
    assert_eq!(envelope.reached(100.0, 301.0), Reached::Beyond);
    assert_eq!(envelope.reached(100.0, 150.0), Reached::Continuous);
    // At 300 V the same torque up to three quarters of the speed.
    let lower = Envelope::new(&entry, Some(300.0));
    close(lower.most(6000.0 * RPM), envelope.most(8000.0 * RPM), 1e-12);
}

fn bridge(conduction: Conduction) -> Bridge {
    Bridge {
        entry: BridgeEntry {
            transistor_voltage: None,
            transistor_resistance: None,
            diode_voltage: None,
            diode_resistance: None,
            channel_resistance: None,
            frequency: 10e3 * TAU,
            energy_on: 12e-3,
            energy_off: 16e-3,
            energy_recovery: 8e-3,
            at_current: 450.0,
            at_voltage: 400.0,
            voltage_exponent: 1.35,
            recovery_current_exponent: 0.6,
            recovery_voltage_exponent: 0.6,
            auxiliary: 0.0,
            current: None,
        },
        conduction,
        voltage: 400.0,
    }
}

const SILICON: Conduction = Conduction::Bipolar {
    transistor: [0.9, 1.5e-3],
    diode: [0.8, 1.2e-3],
};

fn phase(power_factor: f64) -> PhaseCurrent {
    PhaseCurrent {
        current: 300.0,
        power_factor,
        modulation: 0.8,
    }
}

/// Conduction and switching against integrals over a period, computed independently.
#[test]
fn the_losses_of_an_inverter_are_those_of_its_data_sheet() {
    let all = bridge(SILICON).loss(&phase(0.85));
    close(all, 1_749.917_50, 1e-8);
    close(86_549.87 / (86_549.87 + all), 0.980_182, 1e-6);
    let conduction = 42.584_585_0 + 125.453_388;
    close(
        bridge(SILICON).loss(&phase(-0.85)),
        6.0 * (conduction + 84.029_522_8 + 24.580_706_3),
        1e-8,
    );
    let mut silicon_carbide = bridge(Conduction::Channel(3e-3));
    silicon_carbide.entry.frequency = 0.0;
    close(silicon_carbide.loss(&phase(0.85)), 810.0, 1e-12);
    // A linear recovery.
    let mut linear = bridge(SILICON);
    linear.entry.recovery_current_exponent = 1.0;
    close(linear.loss(&phase(0.85)), 1_746.483_88, 1e-8);
}

/// The formula of conduction is the mean over a period of the current times the duty ratio.
#[test]
fn the_formula_of_conduction_is_its_integral() {
    let (peak, pf, m) = (300.0 * SQRT_2, 0.85_f64, 0.8);
    let mut silent = bridge(SILICON);
    silent.entry.frequency = 0.0;
    let steps = 20_000;
    let lag = pf.acos();
    let mut sum = 0.0;
    for k in 0..steps {
        // The half period in which the current flows forward.
        let angle = PI * (f64::from(k) + 0.5) / f64::from(steps);
        let current = peak * angle.sin();
        let duty = 0.5 * (1.0 + m * (angle + lag).sin());
        sum += duty * (0.9 * current + 1.5e-3 * current * current);
        sum += (1.0 - duty) * (0.8 * current + 1.2e-3 * current * current);
    }
    close(silent.loss(&phase(pf)), 6.0 * 0.5 * sum / f64::from(steps), 1e-7);
}

#[test]
fn the_current_follows_from_the_torque_up_to_the_base_speed() {
    let mut of_torque = bridge(SILICON);
    of_torque.entry.current = Some(CurrentEntry {
        torque: 300.0,
        current: 400.0,
        power_factor: 0.85,
        base_speed: 500.0,
        modulation: 1.0,
        field_weakening: Vec::new(),
    });
    let expected = bridge(SILICON).loss(&phase(0.85));
    let inverter = Inverter::Bridge(Box::new(of_torque));
    let at = |speed: f64, torque: f64| MotorAt {
        speed,
        torque,
        ..MotorAt::default()
    };
    let (loss, outside) = inverter.loss(&at(400.0, 225.0), 0.0, None);
    close(loss, expected, 1e-12);
    assert!(!outside);
    assert!(inverter.loss(&at(501.0, 225.0), 0.0, None).1);
}

#[test]
fn machine_and_inverter_of_constant_efficiency_have_the_losses_of_the_hand_case() {
    let machine = Machine {
        law: Law::Efficiency(0.92),
        inverter: Some(Inverter::Efficiency(0.98)),
        ..machine()
    };
    for (power, of_machine, of_inverter) in [
        (8_685.567_010_31, 755.266_696_549, 192.670_075_65),
        (1_443.298_969_07, 125.504_258_18, 32.016_392_392_9),
        (-6000.0, 480.0, 110.4),
    ] {
        let loss = machine.loss(100.0, power / 100.0, 20.0);
        close(loss.machine, of_machine, 1e-11);
        close(loss.inverter, of_inverter, 1e-11);
    }
}
