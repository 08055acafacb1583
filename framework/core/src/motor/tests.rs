#![allow(clippy::unwrap_used)]
use super::*;
use std::f64::consts::PI;

fn messages(text: &str) -> Vec<String> {
    let found = MotorMap::read(text.as_bytes()).unwrap_err();
    found.into_iter().map(|f| f.message).collect()
}

#[test]
fn efficiencies_become_losses_before_they_are_interpolated() {
    let text = "speed [rpm],torque [Nm],efficiency [%]\n\
                0,0,70\n0,10,70\n0,20,70\n1000,0,70\n1000,10,80\n1000,20,90\n2000,0,50\n2000,10,80\n2000,20,80\n\
                1000,-10,80\n1000,-20,90\n2000,-10,80\n2000,-20,0\n";
    let map = MotorMap::read(text.as_bytes()).unwrap();
    let w = 1000.0 * PI / 30.0;
    let at = |rpm: f64, torque: f64| map.loss(rpm * PI / 30.0, torque, 20.0);
    let close = |a: f64, b: f64| (a - b).abs() < 1e-9 * b;
    let (low, high) = (10.0 * w * 0.25, 20.0 * w * (1.0 / 0.9 - 1.0));
    assert!(close(at(1000.0, 15.0).loss, 0.5 * (low + high)));
    // Generating: the part of the mechanical power that is not recovered; also in reverse.
    assert!(close(at(1000.0, -10.0).loss, 10.0 * w * 0.2) && close(at(-1000.0, 10.0).loss, 10.0 * w * 0.2));
    assert!(close(at(2000.0, -20.0).loss, 20.0 * 2.0 * w));
    assert!(close(at(-1000.0, -10.0).loss, low));
    // Below the lowest speed the nearest loss is used; at standstill without torque the motor is off. An efficiency says nothing about
    // 0 Nm: the loss is linear between the smallest torques of both signs.
    assert!(close(at(0.0, 10.0).loss, low));
    let none = 0.5 * (low + 10.0 * w * 0.2);
    assert!(close(at(1000.0, 0.0).loss, none) && !at(1000.0, 0.0).outside);
    assert!(close(at(1000.0, 5.0).loss, 0.5 * (low + none)) && close(at(1000.0, -1e-9).loss, none));
    assert_eq!(at(0.0, 0.0).loss, 0.0);
    // Outside the map the end value is used and reported.
    for (rpm, torque) in [(3000.0, 10.0), (2000.0, 30.0), (-3000.0, 30.0)] {
        assert!(at(rpm, torque).outside, "{rpm} {torque}");
    }
    assert!(close(at(3000.0, 10.0).loss, 2.0 * low));
    assert_eq!(
        map.notes,
        [
            "5 rows without speed or torque skipped: an efficiency defines no loss there",
            "no loss at 0 Nm at 2 speeds: linear between the smallest torques of both signs",
        ]
    );
}

#[test]
fn a_corner_that_the_motor_does_not_reach_has_the_last_loss_and_a_note() {
    let text = "speed [rpm],torque [Nm],loss [W]\n1000,10,100\n1000,20,200\n2000,10,150\n";
    let map = MotorMap::read(text.as_bytes()).unwrap();
    let at = |rpm: f64, torque: f64| map.loss(rpm * PI / 30.0, torque, 20.0);
    let corner = at(2000.0, 20.0);
    assert!((corner.loss - 150.0).abs() < 1e-9 && corner.outside);
    assert!(!at(1500.0, 15.0).outside && at(1500.0, 15.1).outside);
    // Without generating rows the motoring losses are used.
    assert_eq!(at(1000.0, -20.0), at(1000.0, 20.0));
}

/// A loss of 100 W and 10 W/Nm: rows of 0 Nm belong to both signs.
#[test]
fn the_loss_is_continuous_through_zero_torque() {
    let map = |torques: &[f64]| {
        let rows = [0.0, 5000.0].into_iter().flat_map(|speed| {
            let row = move |torque: &f64| format!("{speed},{torque},{}\n", 100.0 + 10.0 * torque.abs());
            torques.iter().map(row).collect::<Vec<_>>()
        });
        let text: String = std::iter::once("speed [rpm],torque [Nm],loss [W]\n".to_owned())
            .chain(rows)
            .collect();
        MotorMap::read(text.as_bytes()).unwrap()
    };
    for torques in [
        &[-200.0, -100.0, 0.0, 100.0, 200.0][..],
        &[-100.0, 0.0, 100.0],
        &[-50.0, 0.0, 100.0],
    ] {
        let map = map(torques);
        assert!(map.notes.is_empty(), "{:?}", map.notes);
        for torque in [-40.0, -1.0, -1e-9, 0.0, 1.0, 40.0] {
            for speed in [-100.0, 100.0] {
                let found = map.loss(speed, torque, 20.0);
                assert!(
                    (found.loss - 100.0 - 10.0 * torque.abs()).abs() < 1e-7 && !found.outside,
                    "{torque} {found:?}"
                );
            }
        }
    }
    // A row of 0 Nm that is missing at one speed is between the neighbours of both signs there; one torque of a sign is no map.
    let text = "speed [rpm],torque [Nm],loss [W]\n1000,-10,150\n1000,0,100\n1000,10,200\n2000,-10,250\n2000,10,350\n";
    let gap = MotorMap::read(text.as_bytes()).unwrap();
    assert!((gap.loss(2000.0 * PI / 30.0, 0.0, 20.0).loss - 300.0).abs() < 1e-9);
    let text = "speed [rpm],torque [Nm],efficiency [-]\n1000,-10,0.9\n1000,10,0.9\n2000,-10,0.9\n2000,10,0.9\n";
    assert_eq!(
        messages(text),
        ["the motoring part has 2 speeds and 1 torques; a map requires two of each"]
    );
}

#[test]
fn losses_are_linear_over_the_temperature() {
    let text = "speed [rpm],torque [Nm],temperature [degC],loss [W]\n\
                1000,10,20,100\n1000,20,20,200\n2000,10,20,150\n2000,20,20,250\n\
                1000,10,120,140\n1000,20,120,280\n2000,10,120,190\n2000,20,120,330\n";
    let map = MotorMap::read(text.as_bytes()).unwrap();
    let at = |temperature: f64| map.loss(1000.0 * PI / 30.0, 20.0, temperature);
    assert!((at(70.0).loss - 240.0).abs() < 1e-9 && !at(70.0).outside);
    assert!((at(0.0).loss - 200.0).abs() < 1e-9 && at(0.0).outside && at(130.0).outside);
    // A single temperature applies to all.
    let single: String = text.lines().take(5).fold(String::new(), |all, line| all + line + "\n");
    let map = MotorMap::read(single.as_bytes()).unwrap();
    assert!(!map.loss(1000.0 * PI / 30.0, 20.0, 90.0).outside);
}

#[test]
fn faults_of_a_map_tell_line_and_column() {
    let unit = MotorMap::read(b"speed,torque [Nm],loss [W]\n1,1,1\n")
        .unwrap_err()
        .remove(0);
    assert_eq!(unit.message, "line 1, column `speed` has no unit");
    assert_eq!(unit.help, COLUMNS);
    assert_eq!(
        messages("n [rpm],torque [Nm],eta [-]\n1,1,1\n"),
        [
            "line 1: there is no column for the speed; there are: n, torque, eta",
            "line 1: there is no column for the efficiency or the loss; there are: n, torque, eta",
        ]
    );
    assert_eq!(
        messages("speed [rpm],torque [Nm],efficiency [-]\n1000,10,80\n1000,20,0\n-1,10,0.5\n1000,x,0.5\n"),
        [
            "line 2, column 3 `efficiency`: an efficiency of 80; it must be between 0 and 1, or 0 and 100 %",
            "line 3, column 3 `efficiency`: an efficiency of 0; it must be between 0 and 1, or 0 and 100 %",
            "line 4, column 1 `speed`: `-1` is negative",
            "line 5, column 2 `torque`: `x` is not a number",
        ]
    );
    assert_eq!(
        messages("speed [rpm],torque [Nm],loss [W]\n1000,10,80\n2000,20,90\n1000,10,80\n"),
        ["line 4: this speed and torque are already in line 2"]
    );
    assert_eq!(
        messages("speed [rpm],torque [Nm],loss [W]\n1000,10,80\n1000,20,80\n"),
        ["the motoring part has 1 speeds and 2 torques; a map requires two of each"]
    );
    assert_eq!(
        messages("speed [rpm],torque [Nm],loss [W]\n1,1,1\n2,2,2\n3,3,3\n4,4,4\n"),
        ["the motoring part has 4 rows for 4 speeds, 4 torques and 1 temperatures, which is not a grid"]
    );
}

#[test]
fn the_share_of_the_rotor_is_one_number_or_rises_with_speed() {
    let over = |speeds: [f64; 2]| {
        RotorShare::Over(vec![
            RotorShareAt {
                speed: speeds[0],
                share: 0.1,
            },
            RotorShareAt {
                speed: speeds[1],
                share: 0.3,
            },
        ])
    };
    assert_eq!(RotorShare::default().share_at(500.0).unwrap(), 0.2);
    assert!((over([0.0, 1000.0]).share_at(-500.0).unwrap() - 0.2).abs() < 1e-12);
    assert_eq!(over([0.0, 1000.0]).share_at(2000.0).unwrap(), 0.3);
    assert_eq!(
        over([10.0, 10.0]).share_at(5.0).unwrap_err().message,
        "the speeds of `rotor_share` do not increase"
    );
}
