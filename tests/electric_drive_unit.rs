//! The electric drive unit: geometry, forces and losses of the example against the check cases of the method it follows.
//!
//! The checks take every loss from torques without losses and all oil at 40 degC, the conductivity of their own base oil, 0.05 K/W
//! from each gear to the oil, no oil in any bearing and no swell between the gears.

use crate::common::{RPM, file, language};
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::geometry::Pair;
use gearloss_framework::language::Language;
use gearloss_framework::loads::SupportLoad;
use gearloss_framework::motor::MotorMap;
use gearloss_framework::resolve::Choice;
use gearloss_framework::thermal::Outcome;
use gearloss_framework::thermal::network::{Moment, Scheme, StepSize, Surroundings};
use gearloss_framework::transmission::Transmission;
use gearloss_studies::duty::{
    CoastDownEntry, CycleEntry, Regeneration, RoadLoad, STANDARD_GRAVITY, ShippedCycleEntry, Vehicle,
};
use gearloss_studies::points::{Driven, OilTemperature, Ride, drive};
use serde_json::{Value, json};

const EXAMPLE: &str = "examples/electric-drive-unit/gearbox.yaml";
const BEAM: &str = "examples/electric-drive-unit/gearbox-beam.yaml";

fn within(value: f64, printed: f64, tolerance: f64) {
    assert!((value / printed - 1.0).abs() < tolerance, "{value} against {printed}");
}

/// A drive unit as the checks take it, with further changes.
fn unit(language: &Language, path: &str, changes: &[(&str, Value)]) -> Transmission {
    let fixed = [
        ("thermal.mode", json!("fixed")),
        ("lubricants.fluid.conductivity", json!("0.14 W/(m K)")),
        ("bearings.B3.oil_height", json!("0 mm")),
        ("bearings.B4.oil_height", json!("0 mm")),
        ("bearings.B5.oil_height", json!("0 mm")),
        ("bearings.B6.oil_height", json!("0 mm")),
        ("gears.W1.drag.churning.swell", json!(0.0)),
        ("gears.W2.drag.churning.swell", json!(0.0)),
    ];
    let choice = Choice {
        overrides: fixed
            .iter()
            .chain(changes)
            .map(|(path, value)| ((*path).to_owned(), value.clone()))
            .collect(),
        ..Choice::default()
    };
    let gearbox = Gearbox::read(language, &file(path)).unwrap_or_else(|findings| panic!("{}", findings.render()));
    gearbox
        .transmission(language, &choice)
        .unwrap_or_else(|findings| panic!("{}", findings.render()))
}

/// What a point comes to.
struct Asked {
    meshes: [f64; 2],
    /// Torque of the second stage. \[Nm\]
    torque_2: f64,
    bearings: Vec<f64>,
    churning: f64,
    loads: Vec<SupportLoad>,
}

impl Asked {
    fn mesh(&self) -> f64 {
        self.meshes.iter().sum()
    }
}

fn ask(t: &Transmission, torque: f64, rpm: f64) -> Asked {
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[rpm * RPM],
        torques: &[torque],
        flow: PowerFlow::Ideal,
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[40.0], &mut scratch);
    assert!(solution.is_complete());
    let of = |start: &str| -> Vec<f64> {
        let parts = solution.parts().filter(|(part, _)| part.path.starts_with(start));
        parts.map(|(_, loss)| loss.watts()).collect()
    };
    let meshes = of("meshes");
    Asked {
        torque_2: solution.mesh_torque(1).abs(),
        meshes: [meshes[0], meshes[1]],
        bearings: of("bearings"),
        churning: of("gears").iter().sum(),
        loads: (0..t.supports().len()).map(|i| solution.load(i)).collect(),
    }
}

/// Torque of a power in kW at a speed in rpm. \[Nm\]
fn torque(power: f64, rpm: f64) -> f64 {
    power * 1e3 / (rpm * RPM)
}

fn pairs(t: &Transmission) -> [Pair; 2] {
    let pairs: Vec<Pair> = t.cylindrical_meshes().map(|(.., part)| part.pair).collect();
    [pairs[0], pairs[1]]
}

/// The car of the checks.
fn car() -> Vehicle {
    Vehicle {
        mass: 1928.0,
        road_load: RoadLoad::CoastDown(CoastDownEntry {
            a: 165.3404,
            b: 0.467_668_3,
            c: 0.320_520_7,
        }),
        tyre_radius: 0.3357,
        rotating_mass_factor: 1.04,
        inertia: None,
        gravity: STANDARD_GRAVITY,
        regeneration: Some(Regeneration {
            torque: 350.0,
            power: 190e3,
            fade_speed: 2.0,
        }),
        efficiency: Some(0.97),
    }
}

/// A cycle at 40 degC.
fn driven(language: &Language, t: &Transmission, cycle: &str) -> Driven {
    let entry = CycleEntry::Shipped(ShippedCycleEntry {
        shipped: cycle.to_owned(),
        repeat: 1,
        start: None,
        end: None,
    });
    let car = car();
    let duty = entry.read(language.registry(), |_| Err("no files".to_owned())).unwrap();
    let intervals = duty.intervals(Some(&car)).unwrap();
    let ride = Ride {
        intervals: &intervals,
        port: "input",
        vehicle: Some(&car),
        gear: "only",
        choice: None,
        oil: OilTemperature::Fixed(40.0),
        spectrum: false,
        start: None,
        ambient: None,
        scheme: Scheme::default(),
        step: StepSize::Fixed(1.0),
        flow: PowerFlow::Ideal,
    };
    let driven = drive(t, &ride, &|_| true).unwrap().unwrap();
    assert!(driven.broken.is_none());
    driven
}

/// Mean losses of meshes, bearings and churning over a cycle, standstill included. \[W\]
fn means(t: &Transmission, driven: &Driven) -> [f64; 3] {
    ["meshes", "bearings", "gears"].map(|start| {
        let of = t.parts().iter().zip(&driven.total.parts);
        let sum: f64 = of
            .filter(|(part, _)| part.path.starts_with(start))
            .map(|(_, joule)| joule)
            .sum();
        sum / driven.total.duration
    })
}

/// The share of the input power that the meshes lose, known at nodes and linear in between over the logarithms of torque and speed, as
/// the checks took it along a cycle. The share curves upwards, so that such a table lies above the losses themselves.
struct Shares {
    speeds: Vec<f64>,
    torques: Vec<f64>,
    nodes: Vec<Vec<f64>>,
}

impl Shares {
    fn new(t: &Transmission, speeds: &[f64], torques: &[f64]) -> Self {
        let share = |rpm: f64, torque: f64| ask(t, torque, rpm).mesh() / (torque * rpm * RPM);
        let row = |rpm: &f64| torques.iter().map(|torque| share(*rpm, *torque)).collect();
        Self {
            speeds: speeds.to_vec(),
            torques: torques.to_vec(),
            nodes: speeds.iter().map(row).collect(),
        }
    }

    /// Six nodes each, evenly spaced over the logarithms.
    fn coarse(t: &Transmission) -> Self {
        let even = |from: f64, to: f64| [0.0, 0.2, 0.4, 0.6, 0.8, 1.0].map(|share| from * (to / from).powf(share));
        Self::new(t, &even(100.0, 17000.0), &even(3.0, 350.0))
    }

    fn interpolate(&self, torque: f64, rpm: f64) -> f64 {
        let place = |axis: &[f64], x: f64| {
            let last = axis.len() - 1;
            let x = x.clamp(axis[0], axis[last]);
            let i = axis.partition_point(|node| *node <= x).clamp(1, last) - 1;
            (i, (x / axis[i]).ln() / (axis[i + 1] / axis[i]).ln())
        };
        let ((i, a), (j, b)) = (place(&self.speeds, rpm), place(&self.torques, torque.abs()));
        let along = |row: &[f64]| (1.0 - b) * row[j] + b * row[j + 1];
        (1.0 - a) * along(&self.nodes[i]) + a * along(&self.nodes[i + 1])
    }

    /// Mean loss over a cycle. \[W\]
    fn mean(&self, driven: &Driven) -> f64 {
        let moving = driven.stretches.iter().filter(|s| s.speed * s.torque != 0.0);
        let power = moving.map(|s| self.interpolate(s.torque, s.speed / RPM) * (s.speed * s.torque).abs());
        power.sum::<f64>() / driven.total.duration
    }
}

#[test]
fn u1a_u1b_u1f_the_example_has_the_geometry_of_the_checks() {
    let t = unit(&language(), EXAMPLE, &[]);
    let [one, two] = pairs(&t);
    // Axes are written to a hundredth of a micrometre, which the checks print to a tenth.
    for (pair, distance, [r_a1, r_a2], [s_a, s_c, s_e], ratios, radius) in [
        (
            one,
            0.101_712_5,
            [0.029_945_08, 0.075_172_64],
            [0.006_340_103, 0.010_432_60, 0.014_593_87],
            [1.557_373, 1.921_207],
            0.007_967_732,
        ),
        (
            two,
            0.151_075_2,
            [0.036_786_64, 0.119_494_1],
            [0.006_861_090, 0.012_689_69, 0.019_131_72],
            [1.491_723, 2.155_134],
            0.010_549_09,
        ),
    ] {
        within(pair.centre_distance, distance, 1e-6);
        within(0.5 * pair.tip_diameter[0], r_a1, 1e-6);
        within(0.5 * pair.tip_diameter[1], r_a2, 1e-6);
        // The start of contact is a small difference of two long ways and moves 2.7 times as much as the centre distance.
        within(pair.points[0], s_a, 3e-6);
        within(pair.points[2], s_c, 3e-6);
        within(pair.points[4], s_e, 1e-6);
        within(pair.contact_ratio, ratios[0], 3e-6);
        within(pair.overlap_ratio, ratios[1], 1e-6);
        within(pair.pitch_radius, radius, 3e-6);
    }
    within(one.ratio() * two.ratio(), 9.036_290, 1e-7);
}

#[test]
fn u10a_u10b_forces_at_the_meshes() {
    let t = unit(&language(), EXAMPLE, &[]);
    let asked = ask(&t, 100.0, 2000.0);
    let forces = |pair: &Pair, torque: f64| {
        let tangential = torque / pair.working_radius[0];
        [
            tangential,
            tangential * pair.working_helix.tan(),
            tangential * pair.working_angle.tan(),
        ]
    };
    let [one, two] = pairs(&t);
    within(one.working_radius[0], 0.028_152_55, 1e-6);
    within(one.working_helix.to_degrees(), 20.073_17, 1e-6);
    let first = forces(&one, 100.0);
    let second = forces(&two, asked.torque_2);
    within(asked.torque_2, 261.290_3, 1e-6);
    for (force, printed) in first.into_iter().zip([3552.076, 1297.989, 1417.208]) {
        within(force, printed, 2e-6);
    }
    for (force, printed) in second.into_iter().zip([7710.860, 3204.855, 3114.180]) {
        within(force, printed, 2e-6);
    }
    // The thrust that the bearings take is that of the meshes.
    within(asked.loads[2].axial, first[1], 1e-12);
    within(asked.loads[3].axial, second[1] - first[1], 1e-12);
    within(asked.loads[5].axial, second[1], 1e-12);
}

#[test]
fn u11a_bearing_loads_with_a_hinge_in_the_rotor_shaft() {
    let language = language();
    let printed = [
        [88.25985, 0.0],
        [1698.060, 0.0],
        [2160.731, 1297.989],
        [4994.772, 1906.866],
        [7446.025, 0.0],
        [6068.866, 3204.855],
        [4163.858, 0.0],
    ];
    let hinged = ask(&unit(&language, EXAMPLE, &[]), 100.0, 2000.0).loads;
    for (load, [radial, axial]) in hinged.iter().zip(printed) {
        within(load.radial, radial, 1e-6);
        assert!((load.axial - axial).abs() < 1e-3, "{load:?}");
        assert_eq!(load.untaken, 0.0);
    }
    // A wheel on the other side of a rotor that turns the same way presses the pinion down and not up, so that the weight of the rotor
    // adds to it. So does a rotor that turns the other way, with helices of the other hand.
    let opposite = [
        ("shafts.input.axis", json!(["-252.78761 mm", "0 mm"])),
        ("shafts.intermediate.axis", json!(["-151.07515 mm", "0 mm"])),
    ];
    let opposite = ask(&unit(&language, EXAMPLE, &opposite), 100.0, 2000.0).loads;
    within(opposite[1].radial, 1873.61, 3e-6);
    for other in [0, 2, 3, 4, 5, 6] {
        within(opposite[other].radial, hinged[other].radial, 1e-9);
    }
    // One stiff beam in three bearings: what this program finds, for comparison. The bending of the pinion side lifts the rotor end.
    let beam = ask(&unit(&language, BEAM, &[]), 100.0, 2000.0).loads;
    for (load, [radial, axial]) in beam.iter().zip([[125.503, 0.0], [1844.28, 0.0], [2046.84, 1297.989]]) {
        within(load.radial, radial, 1e-5);
        assert!((load.axial - axial).abs() < 1e-3, "{load:?}");
    }
    for other in 3..7 {
        assert_eq!(beam[other], hinged[other]);
    }
}

#[test]
fn the_thermal_network_of_the_example_comes_to_rest_at_sensible_temperatures() {
    let language = language();
    let gearbox = Gearbox::read(&language, &file(EXAMPLE)).unwrap();
    let t = gearbox.transmission(&language, &Choice::default()).unwrap();
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    for (power, rpm) in [(30.0, 2000.0), (30.0, 10000.0), (5.0, 4000.0), (-15.0, 6000.0)] {
        let point = Point {
            speeds: &[rpm * RPM],
            torques: &[torque(power, rpm)],
            ..Point::default()
        };
        let moment = Moment {
            case: &case,
            point: &point,
            around: &Surroundings::default(),
        };
        let steady = t.steady(&moment, &mut scratch).unwrap();
        assert_eq!(steady.outcome, Outcome::Converged);
        let came: f64 = steady.heat.iter().sum();
        assert!(steady.residual.abs() < 1e-9 * came, "{steady:?}");
        // Between the coolant and what seals and magnets bear; coolest is the oil behind the exchanger.
        let names = t.network().unwrap().names();
        for (name, warm) in names.iter().zip(&steady.temperatures).skip(1) {
            assert!((35.0..110.0).contains(warm), "{name} {warm} at {power} kW, {rpm} rpm");
        }
    }
}

#[test]
fn u9d_share_of_the_input_that_both_meshes_lose() {
    let t = unit(&language(), EXAMPLE, &[]);
    for (rpm, torque, share) in [
        (60.0, 1.0, 0.019_550),
        (60.0, 350.0, 0.021_340),
        (1000.0, 50.0, 0.012_116),
        (2500.0, 150.0, 0.011_063),
        (5000.0, 15.0, 0.005_426),
        (10000.0, 50.0, 0.006_214),
    ] {
        // Forty midpoints lie 0.06 to 0.09 % above the path; two hundred are within 0.01 %.
        within(ask(&t, torque, rpm).mesh() / (torque * rpm * RPM), share, 1e-3);
    }
}

#[test]
fn u9e_mean_mesh_loss_over_cycles() {
    let language = language();
    let t = unit(&language, EXAMPLE, &[]);
    // The nodes of check 9d, which are those of its table.
    let speeds = [60.0, 300.0, 1000.0, 2500.0, 5000.0, 10000.0];
    let torques = [1.0, 5.0, 15.0, 50.0, 150.0, 350.0];
    let table = Shares::new(&t, &speeds, &torques);
    for (cycle, printed) in [("wltc_class3b", 75.65), ("nycc", 45.12)] {
        let driven = driven(&language, &t, cycle);
        // The table of the check, but for its forty midpoints.
        within(table.mean(&driven), printed, 1.5e-3);
        // Without a table, the loss itself.
        let [mesh, ..] = means(&t, &driven);
        within(mesh, printed, 0.015);
        assert!(mesh < printed);
    }
}

#[test]
fn u11b_losses_at_30_kw_and_40_degc() {
    let t = unit(&language(), EXAMPLE, &[]);
    // Both stages as check 4i prints them.
    for (rpm, one, two, printed, churning) in [
        (1000.0, 184.3612, 258.9979, 443.4, 0.8),
        (2000.0, 142.0955, 207.3154, 349.9, 2.7),
        (3000.0, 118.0479, 174.2445, 293.6, 5.0),
        (5000.0, 91.65394, 133.6493, 229.9, 10.8),
        (8000.0, 74.42918, 102.3301, 183.1, 20.6),
        (14000.0, 65.12819, 77.97244, 146.9, 43.2),
    ] {
        let asked = ask(&t, torque(30.0, rpm), rpm);
        // Nodes of Gauss in place of two hundred midpoints.
        within(asked.meshes[0], one, 2e-4);
        within(asked.meshes[1], two, 2e-4);
        // The column of meshes comes from a table, which lies up to 3.6 % above the losses between its nodes.
        let over = printed / asked.mesh();
        assert!((0.9995..1.037).contains(&over), "{over} at {rpm}");
        within(
            30e3 * Shares::coarse(&t).interpolate(torque(30.0, rpm), rpm),
            printed,
            0.01,
        );
        assert!((asked.churning - churning).abs() < 0.051, "{} at {rpm}", asked.churning);
    }
    for (rpm, printed) in [
        (1000.0, [0.46, 22.98, 73.62, 66.29, 72.18, 30.49, 9.26]),
        (2000.0, [1.30, 21.36, 79.53, 49.21, 46.96, 23.22, 6.29]),
        (3000.0, [2.37, 23.47, 92.05, 46.81, 39.63, 20.93, 5.38]),
        (14000.0, [16.47, 41.18, 194.32, 89.48, 47.96, 28.68, 8.00]),
    ] {
        for (computed, printed) in ask(&t, torque(30.0, rpm), rpm).bearings.iter().zip(printed) {
            assert!(
                (computed - printed).abs() < 0.0051,
                "{computed} against {printed} at {rpm}"
            );
        }
    }
    for (rpm, printed) in [
        (1000.0, 275.3),
        (2000.0, 227.9),
        (3000.0, 230.6),
        (5000.0, 265.9),
        (8000.0, 328.0),
        (14000.0, 426.1),
    ] {
        let sum: f64 = ask(&t, torque(30.0, rpm), rpm).bearings.iter().sum();
        assert!((sum - printed).abs() < 0.051, "{sum} against {printed} at {rpm}");
    }
}

#[test]
fn u11c_mean_losses_over_cycles_with_four_oils() {
    let language = language();
    let of_index = |kv100: &str| json!({ "kv100": kv100, "vi": 174 });
    for (viscosity, wltc, nycc) in [
        (
            of_index("2.0 mm2/s"),
            [129.9, 63.8, 7.4, 201.0],
            [68.0, 23.5, 1.0, 92.5],
        ),
        (of_index("4.0 mm2/s"), [91.9, 82.9, 7.1, 182.0], [53.3, 26.7, 1.0, 81.0]),
        (
            json!({ "kv40": "27.3 mm2/s", "kv100": "5.9 mm2/s" }),
            [76.1, 98.5, 7.0, 181.6],
            [45.3, 29.8, 1.0, 76.1],
        ),
        (of_index("10 mm2/s"), [66.5, 118.8, 6.7, 192.0], [38.4, 35.1, 1.0, 74.5]),
    ] {
        let t = unit(&language, EXAMPLE, &[("lubricants.fluid.viscosity", viscosity)]);
        let table = Shares::coarse(&t);
        for (cycle, [mesh, bearings, churning, total]) in [("wltc_class3b", wltc), ("nycc", nycc)] {
            let driven = driven(&language, &t, cycle);
            let mean_losses = means(&t, &driven);
            // To the last printed digit.
            assert!(
                (mean_losses[1] - bearings).abs() < 0.051,
                "{mean_losses:?} against {bearings}"
            );
            assert!(
                (mean_losses[2] - churning).abs() < 0.051,
                "{mean_losses:?} against {churning}"
            );
            // The losses of the meshes come from a table, which lies up to 2 % above them.
            within(table.mean(&driven), mesh, 0.01);
            let over = mesh / mean_losses[0];
            assert!((0.999..1.021).contains(&over), "{over}");
            within(mean_losses.iter().sum(), total, 0.01);
        }
    }
}

/// The law that the shipped map was made from: copper, iron, friction and windage, inverter.
fn motor_law(rpm: f64, torque: f64) -> f64 {
    let w = rpm * RPM;
    let copper = 0.09 * torque * torque * (1.0 + 0.15 * ((w / 560.0).max(1.0) - 1.0));
    copper + 0.6 * w + 5e-4 * w * w + 1.5e-7 * w * w * w + 60.0
}

#[test]
fn u7m_the_map_of_the_motor_is_its_law() {
    let cases = [
        (1000.0, 10.0, 137.4872),
        (5000.0, 60.0, 856.7692),
        (7000.0, 13.0, 843.4947),
        (9000.0, 150.0, 3427.654),
    ];
    let synthetic = std::fs::read_to_string(file("examples/electric-drive-unit/motor_map.csv")).unwrap();
    let map = MotorMap::read(synthetic.as_bytes()).unwrap();
    for (rpm, torque, loss) in cases {
        assert!((motor_law(rpm, torque) - loss).abs() < 1e-6 * loss, "{rpm} {torque}");
        // Between nodes straight lines lie above the convex law, by less than 0.3 % here.
        let read = map.loss(rpm * RPM, torque, 80.0);
        assert!(!read.outside);
        assert!(
            read.loss > loss - 0.01 && read.loss < 1.003 * loss,
            "{rpm} {torque}: {read:?}"
        );
    }
    // The rows are the law to their two decimals.
    let mut rows = 0;
    for line in synthetic.lines().filter(|l| !l.starts_with(['#', 's'])) {
        let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        assert!((motor_law(row[0], row[1]) - row[2]).abs() < 0.006, "{line}");
        let read = map.loss(row[0] * RPM, row[1], 80.0);
        assert!(
            (read.loss - row[2]).abs() < 1e-9 * row[2] && !read.outside,
            "{line}: {read:?}"
        );
        rows += 1;
    }
    assert_eq!(rows, 271);
}
