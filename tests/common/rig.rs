//! The synthetic measurement of the two-speed example: what it hides, and how it is made.

use std::fmt::Write as _;

use gearloss_framework::document::read_yaml;
use gearloss_framework::evaluate::Point;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_studies::analyses::identify::IdentifyEntry;
use gearloss_studies::identify::{Faults, Identification};
use gearloss_studies::measured::{Measured, MeasuredEntry};
use gearloss_studies::points::Rows;
use gearloss_studies::study::StudyEntry;
use serde_json::{Map, Value, json};

use super::{RPM, random_bits};

/// What the models are not told: an oil that was sheared, rougher flanks, a higher level, other friction and higher loads in the
/// bearings. Chosen before anything was fitted, as the seed was.
pub const HIDDEN: [(&str, &str); 6] = [
    ("lubricants.sump.viscosity.factor", "0.85"),
    ("gears.*.surface.rq", "0.45 um"),
    ("housing.oil.level_offset", "4 mm"),
    ("bearings.*.radial_factor", "1.15"),
    ("bearings.*.model.mu_bl", "0.12"),
    ("seals.*.loss_factor", "1.3"),
];
/// What the torque meters at the input and at the output show too much. \[Nm\]
pub const OFFSETS: [f64; 2] = [0.03, 0.0];
/// The hidden value of each parameter of `identify` in the study of the example, in the unit of its path.
pub const TRUTH: [(&str, f64); 8] = [
    ("viscosity", 0.85),
    ("roughness", 0.45),
    ("level", 4.0),
    ("loads", 1.15),
    ("boundary", 0.12),
    ("seals", 1.3),
    ("torque_offset", OFFSETS[0]),
    ("rig_bearing", SUPPORT[0]),
];
/// Drag of the rig's own bearing at the input: torque at 1000 rpm in Nm, exponent of the speed. It runs in grease, so that the
/// temperature of the oil does not touch it.
pub const SUPPORT: [f64; 2] = [0.02, 0.667];
/// Standard deviations: 0.05 % of the full scale of each torque meter, 20 and 500 Nm; of the oil's temperature.
pub const NOISE: [f64; 3] = [0.01, 0.25, 0.2];
pub const SEED: u64 = 20151118;

/// Gear states, temperatures of the oil, torques, and speeds in thousands that were run.
pub const GEARS: [&str; 2] = ["first", "second"];
pub const OILS: [f64; 2] = [40.0, 100.0];
pub const TORQUES: [f64; 10] = [2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0];
pub const SPEEDS: u32 = 11;

/// Numbers of a normal distribution, always the same ones (Box and Muller).
pub struct Normal(pub u64);

impl Normal {
    fn uniform(&mut self) -> f64 {
        (random_bits(&mut self.0) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn next(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (2.0 * std::f64::consts::PI * self.uniform()).cos()
    }
}

/// The sets of models of the example.
pub fn sets(language: &Language) -> Map<String, Value> {
    let study = std::fs::read_to_string(super::file("examples/two-speed-ev/study.yaml")).unwrap();
    let read = read_yaml(0, &study);
    language.walk_study(&read.node).value["model_sets"]
        .as_object()
        .cloned()
        .unwrap()
}

/// The study of the example.
pub fn study(language: &Language) -> StudyEntry {
    let text = std::fs::read_to_string(super::file("examples/two-speed-ev/study.yaml")).unwrap();
    let walked = language.walk_study(&read_yaml(0, &text).node);
    assert!(walked.findings.is_empty(), "{:?}", walked.findings);
    serde_json::from_value(walked.value).unwrap()
}

/// The identification `identify` of the study on a file of measured points.
pub fn identification<'a>(
    language: &'a Language,
    gearbox: &'a Gearbox,
    study: &'a StudyEntry,
    measured: &'a Measured,
) -> Identification<'a> {
    let Some(entry) = study
        .analyses
        .get("identify")
        .and_then(|analysis| analysis.entry::<IdentifyEntry>())
    else {
        panic!("the study identifies");
    };
    let rows = Rows {
        measured,
        bind: Vec::new(),
        gear: None,
        torque_at: "input",
        speed_at: "input",
        oil: study.conditions.oil_temperature,
        flow: study.conditions.power_flow,
        terms: false,
    };
    let choice = Choice {
        set: Some("complete".to_owned()),
        sets: sets(language),
        ..Choice::default()
    };
    let found = Identification::new(
        language,
        gearbox,
        choice,
        rows,
        entry.parameters.iter(),
        &entry.residuals,
    );
    found.unwrap_or_else(|faults| match faults {
        Faults::Study(list) => panic!("{list:?}"),
        Faults::Gearbox(findings) => panic!("{}", findings.render()),
    })
}

/// What the study says of the file.
pub fn entry(study: &StudyEntry) -> &MeasuredEntry {
    study.measurements.get("rig").unwrap()
}

/// The gearbox of the example.
pub fn gearbox(language: &Language) -> Gearbox {
    let file = super::file("examples/two-speed-ev/gearbox.yaml");
    Gearbox::read(language, &file).unwrap_or_else(|f| panic!("{}", f.render()))
}

/// One point of the transmission with what is hidden: speed at the input, torque and speed at the output.
#[derive(Clone, Copy)]
pub struct True {
    pub speed: f64,
    pub torque_out: f64,
    pub speed_out: f64,
}

/// Calculates points of the transmission with what is hidden.
pub struct Rig {
    transmission: gearloss_framework::transmission::Transmission,
}

impl Rig {
    pub fn new(language: &Language, set: &str) -> Self {
        let value = |text: &str| text.parse::<f64>().map_or_else(|_| json!(text), |x| json!(x));
        let overrides = HIDDEN.iter().map(|(path, text)| ((*path).to_owned(), value(text)));
        let choice = Choice {
            set: Some(set.to_owned()),
            sets: sets(language),
            overrides: overrides.collect(),
            ..Choice::default()
        };
        let transmission = gearbox(language)
            .transmission(language, &choice)
            .unwrap_or_else(|f| panic!("{}", f.render()));
        Self { transmission }
    }

    /// A point at torque in Nm, speed in rad/s and temperature of the oil in degC.
    pub fn true_point(&self, gear: &str, torque: f64, speed: f64, oil: f64) -> True {
        let t = &self.transmission;
        let case = t.case(gear, &["input"], &["input"]).unwrap();
        let mut scratch = t.scratch(&case);
        let point = Point {
            speeds: &[speed],
            torques: &[torque],
            ..Point::default()
        };
        let solution = t.evaluate(&case, &point, &[oil], &mut scratch);
        let out = t.port("output").unwrap();
        True {
            speed,
            torque_out: solution.torque(out).abs(),
            speed_out: solution.speed(t.ports()[out].member).abs(),
        }
    }
}

fn comma(x: f64, digits: usize) -> String {
    format!("{x:.digits$}").replace('.', ",")
}

/// The file of a seed.
pub fn csv(rig: &Rig, seed: u64) -> String {
    let mut noise = Normal(seed);
    let mut csv =
        "# SYNTHETIC: no rig has measured this. Made by the set `complete` of study.yaml with these hidden changes:\n"
            .to_owned();
    for (path, value) in HIDDEN {
        let _ = writeln!(csv, "#   {path} = {value}");
    }
    let _ = writeln!(
        csv,
        "# The torque meters show {} Nm too much at the input and {} Nm at the output. Noise: standard deviations of {} Nm at the",
        OFFSETS[0], OFFSETS[1], NOISE[0]
    );
    let _ = writeln!(
        csv,
        "# input and {} Nm at the output (0.05 % of full scales of 20 and 500 Nm) and {} K of the oil, seed {seed}.",
        NOISE[1], NOISE[2]
    );
    csv.push_str("gear;T_in;n_in;T_out;n_out;eta;T_oil\n;Nm;1/min;Nm;1/min;%;degC\n");
    for gear in GEARS {
        for set_point in OILS {
            for torque in TORQUES {
                for step in 1..=SPEEDS {
                    let speed = f64::from(step) * 2000.0;
                    let oil = set_point + NOISE[2] * noise.next();
                    let at = rig.true_point(gear, torque, speed * RPM, oil);
                    let support = SUPPORT[0] * (speed / 1000.0).powf(SUPPORT[1]);
                    let shown_in = torque + support + OFFSETS[0] + NOISE[0] * noise.next();
                    let shown_out = at.torque_out + OFFSETS[1] + NOISE[1] * noise.next();
                    let eta = shown_out * at.speed_out / (shown_in * at.speed);
                    let cells = [
                        gear.to_owned(),
                        comma(shown_in, 4),
                        comma(speed, 0),
                        comma(shown_out, 3),
                        comma(at.speed_out / RPM, 3),
                        comma(100.0 * eta, 4),
                        comma(oil, 2),
                    ];
                    let _ = writeln!(csv, "{}", cells.join(";"));
                }
            }
        }
    }
    csv
}
