#![allow(clippy::unwrap_used)]
use super::*;
use crate::duty::{CoastDownEntry, RoadLoad, STANDARD_GRAVITY};
use gearloss_framework::description::Ordered;

fn list(pairs: &[(&str, &str)]) -> Ordered<String> {
    Ordered(pairs.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect())
}

fn entry() -> FileCycleEntry {
    FileCycleEntry {
        columns: list(&[("time", "t"), ("vehicle_speed", "v")]),
        ..FileCycleEntry::named("drive.csv")
    }
}

fn faults(entry: &FileCycleEntry, text: &str) -> Vec<String> {
    let found = Trace::read(entry, text.as_bytes()).unwrap_err();
    found
        .into_iter()
        .map(|f| format!("{} | {}", f.message, f.help))
        .collect()
}

fn vehicle() -> Vehicle {
    Vehicle {
        mass: 1000.0,
        road_load: RoadLoad::CoastDown(CoastDownEntry {
            a: 100.0,
            b: 0.0,
            c: 1.0,
        }),
        tyre_radius: 0.5,
        rotating_mass_factor: 1.0,
        inertia: None,
        gravity: STANDARD_GRAVITY,
        regeneration: None,
        efficiency: None,
    }
}

#[test]
fn a_course_of_speeds_becomes_intervals_at_the_wheels() {
    let trace = Trace::read(&entry(), b"t [s],v [km/h]\n0,0\n1,7.2\n2,0\n3,0\n").unwrap();
    let intervals = trace.intervals(Some(&vehicle())).unwrap();
    assert_eq!(intervals.len(), 3);
    // v = 1 m/s, a = 2 m/s2, then -2 m/s2: 2000 + 101 N and -2000 + 101 N.
    for (interval, torque) in intervals.iter().zip([1050.5, -949.5]) {
        let Demand::Wheel { torque: t, speed, .. } = interval.demand else {
            panic!("{interval:?}")
        };
        assert!((t - torque).abs() < 1e-9 && (speed - 2.0).abs() < 1e-12, "{interval:?}");
        assert_eq!(interval.duration, 1.0);
    }
    assert_eq!(intervals[2].demand, Demand::Rest);
    assert_eq!(intervals[2].given.vehicle_speed, Some(0.0));
}

#[test]
fn a_german_recording_at_a_port_with_temperatures_is_read() {
    let text = "# Prüfstand\nt [s];M [Nm];n [1/min];v [km/h];Gang;Q [kg/min];T_K [°C];Luft [°C];Lager [°C]\n\
                0;10,5;3000;36;zwei;6;40;20;60\n0,5;11,5;3000;36;zwei;6;42;20;61\n";
    let entry = FileCycleEntry {
        columns: list(&[
            ("time", "t"),
            ("torque", "M"),
            ("speed", "n"),
            ("vehicle_speed", "v"),
            ("gear", "Gang"),
            ("coolant_flow", "Q"),
            ("coolant_temperature", "T_K"),
            ("ambient", "Luft"),
        ]),
        temperatures: list(&[("bearing_a", "Lager")]),
        repeat: 3,
        ..FileCycleEntry::named("rig.csv")
    };
    let trace = Trace::read(&entry, text.as_bytes()).unwrap();
    assert_eq!(trace.nodes, ["bearing_a"]);
    assert_eq!(trace.samples[1].temperatures, [61.0]);
    let intervals = trace.intervals(None).unwrap();
    assert_eq!(intervals.iter().map(|i| i.start).collect::<Vec<_>>(), [0.0, 0.5, 1.0]);
    let Demand::Port { torque, speed } = intervals[0].demand else {
        panic!("{intervals:?}")
    };
    assert!((torque - 11.0).abs() < 1e-12 && (speed - 100.0 * std::f64::consts::PI).abs() < 1e-9);
    let given = &intervals[0].given;
    assert_eq!(given.gear.as_deref(), Some("zwei"));
    assert!((given.coolant_flow.unwrap() - 0.1).abs() < 1e-12);
    assert_eq!((given.coolant_temperature, given.ambient), (Some(41.0), Some(20.0)));
    assert!((given.vehicle_speed.unwrap() - 10.0).abs() < 1e-12);
    assert!(trace.notes.iter().any(|n| n == "decimal comma"), "{:?}", trace.notes);
}

#[test]
fn a_slope_counts_by_its_rise_over_run() {
    let text = "t [s],v [m/s],grade [%]\n0,10,10\n1,10,10\n";
    let intervals = Trace::read(&entry(), text.as_bytes())
        .unwrap()
        .intervals(Some(&vehicle()))
        .unwrap();
    let Demand::Wheel { torque, .. } = intervals[0].demand else {
        panic!("{intervals:?}")
    };
    let slope = 1000.0 * STANDARD_GRAVITY * 0.1_f64.atan().sin();
    assert!((torque - 0.5 * (200.0 + slope)).abs() < 1e-9);
}

#[test]
fn a_column_counts_for_the_quantity_that_names_it_alone() {
    let entry = FileCycleEntry {
        columns: list(&[("vehicle_speed", "speed")]),
        ..FileCycleEntry::named("drive.csv")
    };
    let trace = Trace::read(&entry, b"# Where from\n\ntime [s],speed [km/h]\n# here\n0,36\n1,36\n").unwrap();
    assert_eq!(trace.samples[0].port, None);
    assert_eq!((trace.samples[0].line, trace.samples[1].line), (5, 6));
}

#[test]
fn a_window_takes_the_rows_within() {
    let text = "t [s],v [m/s]\n0,0\n1,1\n2,2\n3,3\n4,4\n";
    let window = |start, end| FileCycleEntry { start, end, ..entry() };
    let trace = Trace::read(&window(Some(1.0), Some(3.0)), text.as_bytes()).unwrap();
    assert_eq!((trace.samples.len(), trace.duration()), (3, 2.0));
    assert_eq!(
        faults(&window(Some(3.5), None), text),
        ["1 row of 5 can be used; a time series needs at least two | widen `start` and `end`"]
    );
}

#[test]
fn times_that_repeat_or_fall_are_refused() {
    let help = "sort the rows by time and remove duplicates; of a recording that restarts, read a part by `first_line` and \
                `last_line`";
    assert_eq!(
        faults(&entry(), "t [s],v [m/s]\n0,0\n1,0\n1,0\n2,0\n0.5,0\n"),
        [
            format!("line 4: time 1 s is already in line 3 | {help}"),
            format!("line 6: time 0.5 s is before the 2 s of line 5 | {help}"),
        ]
    );
}

#[test]
fn a_gap_is_refused_unless_it_is_accepted() {
    let text = "t [s],v [m/s]\n0,0\n1,0\n2,0\n12,0\n13,0\n";
    assert_eq!(
        faults(&entry(), text),
        ["line 5: a gap of 10 s, from 2 s to 12 s; the median step is 1 s | fill it, or accept it by `gap: 10 s`"]
    );
    let accepted = FileCycleEntry {
        gap: Some(10.0),
        ..entry()
    };
    assert_eq!(Trace::read(&accepted, text.as_bytes()).unwrap().samples.len(), 5);
    // Five times the median step is none yet.
    assert!(Trace::read(&entry(), b"t [s],v [m/s]\n0,0\n0.1,0\n0.2,0\n0.7,0\n").is_ok());
}

#[test]
fn cells_without_a_number_are_reported_together() {
    let help = CELL_HELP;
    assert_eq!(
        faults(&entry(), "t [s],v [m/s]\n0,NaN\n1,\n2,fast\n3,-0.1\n"),
        [
            format!("line 2, column 2 `v`: `NaN` is not a number | {help}"),
            format!("line 3, column 2 `v`: empty | {help}"),
            format!("line 4, column 2 `v`: `fast` is not a number | {help}"),
            format!("line 5, column 2 `v`: `-0.1` is negative | {help}"),
        ]
    );
    assert_eq!(
        faults(&entry(), "t [h],v [m/s]\n0,0\n1e308,0\n"),
        [format!(
            "line 3, column 1 `t`: `1e308` is unrealistically large | {help}"
        )]
    );
    let many = format!("t [s],v [m/s]\n{}", "0,x\n".repeat(8));
    let found = faults(&entry(), &many);
    assert_eq!(found.len(), 5);
    assert_eq!(
        found[4],
        format!("line 6, column 2 `v`: `x` is not a number; 3 more errors of this kind | {help}")
    );
}

#[test]
fn missing_columns_tell_those_there_are() {
    assert_eq!(
        faults(&entry(), "time [s],v [m/s]\n0,0\n1,0\n"),
        ["line 1: there is no column `t`; there are: time, v | choose one of them"]
    );
    let bare = FileCycleEntry::named("drive.csv");
    assert_eq!(
        faults(&bare, "t [s],v [m/s]\n0,0\n1,0\n"),
        [
            "line 1: there is no column for the time; there are: t, v | state one under `columns: { time: ... }`; a cycle over distance \
             states `distance` under `columns`",
            "line 1: there is no column for the vehicle speed, or torque and speed; there are: t, v | state one under `columns: { \
             vehicle_speed: ... }`",
        ]
    );
    assert_eq!(
        faults(&bare, "time [s],torque [Nm]\n0,0\n1,0\n"),
        [
            "line 1: there is no column for the speed in addition to the torque; there are: time, torque | state one under `columns: { speed: \
          ... }`"
        ]
    );
    let wrong = FileCycleEntry {
        columns: list(&[("velocity", "v")]),
        ..FileCycleEntry::named("drive.csv")
    };
    assert!(
        faults(&wrong, "time [s],v [m/s]\n0,0\n1,0\n")[0].starts_with("`velocity` is not a quantity of this file | ")
    );
}

#[test]
fn unknown_and_missing_units_are_refused() {
    // A help with another unit would change the speeds.
    let wrong = &faults(&entry(), "t [s],v [furlongs]\n0,0\n1,0\n")[0];
    assert!(
        wrong.starts_with("line 1, column `v`: unknown unit `furlongs` | a speed is written in m/s,")
            && wrong.ends_with("state it under `units: { vehicle_speed: ... }` with `units_override: true`"),
        "{wrong}"
    );
    let knots = Trace::read(&entry(), b"t [s],v [knots]\n0,0\n1,3.6\n").unwrap();
    assert!((knots.samples[1].given.vehicle_speed.unwrap() - 1.852).abs() < 1e-12);
    assert_eq!(
        faults(&entry(), "t [s],v\n0,0\n1,0\n"),
        ["line 1, column `v` has no unit | state the unit that it has, such as `units: { vehicle_speed: m/s }`"]
    );
    let stated = FileCycleEntry {
        units: list(&[("vehicle_speed", "km/h")]),
        ..entry()
    };
    let trace = Trace::read(&stated, b"t [s],v\n0,0\n1,3.6\n").unwrap();
    assert!((trace.samples[1].given.vehicle_speed.unwrap() - 1.0).abs() < 1e-12);
}

#[test]
fn accelerations_that_no_vehicle_has_are_refused() {
    let help = "correct the speeds and their unit, or state `most_acceleration`";
    let text = "t [s],v [m/s]\n0,0\n1,13\n2,13\n3,0.5\n";
    assert_eq!(
        faults(&entry(), text),
        [
            format!("line 3: an acceleration of 13 m/s2 from the previous line; the maximum is 12 m/s2 | {help}"),
            format!("line 5: an acceleration of -12.5 m/s2 from the previous line; the maximum is 12 m/s2 | {help}"),
        ]
    );
    let stated = FileCycleEntry {
        most_acceleration: 15.0,
        ..entry()
    };
    assert!(Trace::read(&stated, text.as_bytes()).is_ok());
}

#[test]
fn a_shaft_may_change_its_speed_as_fast_as_it_is_stated() {
    let text = "time [s],torque [Nm],speed [rpm]\n0,0,0\n1,0,3000\n";
    let bare = FileCycleEntry::named("rig.csv");
    assert!(Trace::read(&bare, text.as_bytes()).is_ok());
    let stated = FileCycleEntry {
        most_speed_change: Some(1000.0 * std::f64::consts::PI / 30.0),
        ..bare
    };
    assert_eq!(
        faults(&stated, text),
        [
            "line 3: the speed changes by 3000 rpm/s from the previous line; the maximum is 1000 rpm/s | correct the speeds and their \
          unit, or state another `most_speed_change`"
        ]
    );
}

#[test]
fn fewer_than_two_rows_are_refused() {
    let help = "check the file, its header and its separator";
    assert_eq!(
        faults(&entry(), "t [s],v [m/s]\n0,0\n"),
        [format!(
            "1 row of 1 can be used; a time series needs at least two | {help}"
        )]
    );
    assert_eq!(
        faults(&entry(), "t [s],v [m/s]\n"),
        [format!(
            "0 rows of 0 can be used; a time series needs at least two | {help}"
        )]
    );
}

#[test]
fn a_speed_of_the_vehicle_needs_the_vehicle() {
    let trace = Trace::read(&entry(), b"t [s],v [m/s]\n0,0\n1,1\n").unwrap();
    let f = trace.intervals(None).unwrap_err();
    assert_eq!(f.message, "the cycle has a vehicle speed but no torque");
}

#[test]
fn a_series_is_not_repeated_into_more_intervals_than_are_held() {
    let trace = Trace {
        samples: vec![Sample::default(); 6000],
        repeat: 1000,
        ..Trace::default()
    };
    let refused = trace.intervals(None).unwrap_err();
    assert_eq!(
        refused.message,
        "6000 rows repeated 1000 times exceed 5000000 intervals"
    );
}
