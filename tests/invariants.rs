//! What holds for any gearbox, on 200 that are laid out at random: power in is power out and losses, a mirror image loses the same,
//! the order of keys says nothing, and the ideal flow is the limit of the real one for small losses.
//!
//! `INVARIANTS=100000 INVARIANTS_SEED=5 cargo test --test all invariants::` takes more or others.

use crate::common::{self, RPM};
use crate::fuzz::random::Random;
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::flow::{Status, Tolerance};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use serde_json::json;

/// One stage of spur or helical gears.
struct Stage {
    teeth: [usize; 2],
    module: f64,
    helix: f64,
    left: bool,
    facewidth: f64,
    /// Direction in which the next shaft lies. \[rad\]
    direction: f64,
    /// Place along the shafts. \[mm\]
    at: f64,
}

/// A reducer of one to three stages.
struct Plan {
    stages: Vec<Stage>,
    length: f64,
    level: f64,
    oil: f64,
    joint: bool,
    /// Input speed in rpm and torque in Nm.
    point: [f64; 2],
}

/// How a plan is written.
#[derive(Clone, Copy, PartialEq)]
enum Written {
    Plainly,
    /// Mirrored in the plane of x and z: y changes its sign, hands and senses of rotation change.
    AxesMirrored,
    /// Mirrored across the shafts: places along them and hands change, senses of rotation stay.
    EndsMirrored,
    /// With the keys of every section the other way round.
    KeysReversed,
}

fn between(random: &mut Random, from: f64, to: f64) -> f64 {
    // Some digits, so that what is read is what was written.
    let share = random.below(1001) as f64 / 1000.0;
    ((from + (to - from) * share) * 1000.0).round() / 1000.0
}

impl Plan {
    fn random(random: &mut Random) -> Self {
        let count = 1 + random.below(3);
        let length = 60.0 * count as f64 + 40.0;
        let stages = (0..count).map(|i| {
            let pinion = 17 + random.below(20);
            Stage {
                teeth: [pinion, pinion + 5 + random.below(70)],
                module: *random.one(&[1.25, 1.5, 2.0, 2.5, 3.0]),
                helix: *random.one(&[0.0, 10.0, 17.5, 25.0]),
                left: random.once_in(2),
                facewidth: between(random, 15.0, 30.0),
                direction: between(random, -1.2, 1.2),
                at: 60.0 * i as f64 + 50.0,
            }
        });
        Self {
            stages: stages.collect(),
            length,
            level: between(random, -60.0, 20.0),
            oil: between(random, 20.0, 110.0),
            joint: random.once_in(2),
            point: [between(random, 200.0, 6000.0), between(random, 5.0, 80.0)],
        }
    }

    fn yaml(&self, written: Written) -> String {
        let mirrored = matches!(written, Written::AxesMirrored | Written::EndsMirrored);
        let place = |at: f64| {
            if written == Written::EndsMirrored {
                self.length - at
            } else {
                at
            }
        };
        let (mut shafts, mut gears, mut meshes, mut bearings) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let (mut y, mut z) = (0.0, 0.0);
        for i in 0..=self.stages.len() {
            let side = if written == Written::AxesMirrored { -y } else { y };
            shafts.push(format!("S{i}: {{ axis: [{side} mm, {z} mm] }}"));
            let designation = ["6306", "6308", "6310", "6312"][i];
            // One bearing takes thrust both ways, so that no thrust goes back and forth between two.
            bearings.push(format!(
                "A{i}: {{ shaft: S{i}, at: {} mm, designation: \"{designation}\", axial: both }}",
                place(0.0)
            ));
            bearings.push(format!(
                "B{i}: {{ shaft: S{i}, at: {} mm, designation: \"{designation}\" }}",
                place(self.length)
            ));
            let Some(stage) = self.stages.get(i) else { break };
            let [pinion, wheel] = stage.teeth;
            let hand = if stage.left == mirrored { "right" } else { "left" };
            let hand = if stage.helix > 0.0 {
                format!(", hand: {hand}")
            } else {
                String::new()
            };
            let at = place(stage.at);
            gears.push(format!(
                "P{i}: {{ shaft: S{i}, at: {at} mm, z: {pinion}, facewidth: {} mm{hand} }}",
                stage.facewidth
            ));
            gears.push(format!(
                "W{i}: {{ shaft: S{}, at: {at} mm, z: {wheel}, facewidth: {} mm }}",
                i + 1,
                stage.facewidth
            ));
            let helix = if stage.helix > 0.0 {
                format!(", helix_angle: {} deg", stage.helix)
            } else {
                String::new()
            };
            let distance = stage.module * (pinion + wheel) as f64 / 2.0 / stage.helix.to_radians().cos();
            meshes.push(format!(
                "M{i}: {{ gears: [P{i}, W{i}], normal_module: {} mm{helix}, centre_distance: {distance} mm }}",
                stage.module
            ));
            y -= distance * stage.direction.cos();
            z -= distance * stage.direction.sin();
        }
        let models = if self.joint {
            "{ gear_mesh: { type: path_integral, load_sharing: rigid, tooth_friction: { type: xu } }, gear_drag: { churning: { type: changenet_2011 } }, \
             bearing: { type: skf, edition: \"2013\", mu_bl: 0.15 }, seal: { type: iso14179_2 } }"
        } else {
            "{ gear_mesh: { type: iso14179_2 }, gear_drag: { churning: { type: iso14179_2, speed_of: pinion } }, bearing: { type: iso14179_2 }, \
             seal: { type: iso14179_2 } }"
        };
        let section = |entries: &mut Vec<String>| {
            if written == Written::KeysReversed {
                entries.reverse();
            }
            format!("{{ {} }}", entries.join(", "))
        };
        let mut lines = vec![
            "gearloss: gearbox/1".to_owned(),
            format!("ports: {{ input: S0, output: S{} }}", self.stages.len()),
            format!("shafts: {}", section(&mut shafts)),
            format!("gears: {}", section(&mut gears)),
            format!("meshes: {}", section(&mut meshes)),
            format!("bearings: {}", section(&mut bearings)),
            "surface: { ra: 0.4 um, rq: 0.5 um }".to_owned(),
            format!("seals: {{ front: {{ shaft: S0, diameter: 30 mm }}, back: {{ shaft: S{}, diameter: 50 mm }} }}", self.stages.len()),
            "lubricants: { sump: { kind: mineral, viscosity: { kv40: 68 mm2/s, kv100: 8.5 mm2/s }, density: { at: 15 degC, value: 880 kg/m3 } } }"
                .to_owned(),
            format!(
                "housing: {{ oil: {{ lubricant: sump, volume: 2 l, level: {} mm, measured_from: S{} }}, \
                 section: {{ area: 600 cm2, perimeter: 100 cm }}, clearance: {{ radial: 10 mm, axial: 12 mm }} }}",
                self.level,
                self.stages.len()
            ),
            format!("thermal: {{ mode: fixed, oil: {} degC }}", self.oil),
            format!("models: {models}"),
        ];
        if written == Written::KeysReversed {
            lines.reverse();
        }
        lines.join("\n") + "\n"
    }
}

/// What the invariants look at.
#[derive(Debug)]
struct Seen {
    status: Status,
    loss: f64,
    input: f64,
    /// Residual over the largest power inside.
    residual: f64,
}

fn solve(language: &Language, yaml: &str, factor: Option<f64>, [speed, torque]: [f64; 2], flow: PowerFlow) -> Seen {
    let gearbox = Gearbox::of_text(language, yaml, "random.yaml", "").unwrap_or_else(|e| panic!("{e}\n{yaml}"));
    let patterns = [
        "meshes.*.loss_factor",
        "bearings.*.loss_factor",
        "seals.*.loss_factor",
        "gears.*.loss_factor",
    ];
    let overrides = factor.map(|factor| patterns.map(|path| (path.to_owned(), json!(factor))).to_vec());
    let choice = Choice {
        overrides: overrides.unwrap_or_default(),
        ..Choice::default()
    };
    let t = gearbox
        .transmission(language, &choice)
        .unwrap_or_else(|e| panic!("{e}\n{yaml}"));
    let state = t.states()[0].name.clone();
    let case = t.case(&state, &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[speed * RPM],
        torques: &[torque],
        flow,
        tolerance: Tolerance {
            power: 1e-13,
            passes: 100,
        },
        inclination: 0.0,
    };
    let solution = t.evaluate(&case, &point, &[t.oil_temperature], &mut scratch);
    let seen = Seen {
        status: solution.status(),
        loss: solution
            .loss()
            .unwrap_or_else(|| panic!("{:?}\n{yaml}", solution.undefined())),
        input: solution.input_power().unwrap_or(0.0),
        residual: solution.residual().unwrap_or(0.0) / solution.largest_power().max(f64::MIN_POSITIVE),
    };
    assert!(seen.loss.is_finite() && seen.loss > 0.0, "{seen:?}\n{yaml}");
    seen
}

fn given(key: &str, usual: u64) -> u64 {
    std::env::var(key)
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(usual)
}

#[test]
fn random_gearboxes_keep_power_symmetry_order_and_limit() {
    let language = common::language();
    let seed = given("INVARIANTS_SEED", 27);
    let count = given("INVARIANTS", 200);
    let mut in_the_limit = 0;
    for number in 0..count {
        let plan = Plan::random(&mut Random::from_seed(seed, number));
        let yaml = plan.yaml(Written::Plainly);
        let [speed, torque] = plan.point;
        let seen = solve(&language, &yaml, None, plan.point, PowerFlow::Real);
        let told = || format!("gearbox {number} of seed {seed}, {speed} rpm, {torque} Nm\n{yaml}");

        // The balance, to the tolerance that it is solved with and rounding in sums of some tens of terms.
        assert!(seen.residual.abs() < 1e-11, "{seen:?} {}", told());

        // A mirror image is another gearbox to the program, with other signs everywhere. The loop between torque and loss ends within
        // its tolerance on either way, and cosines of other axes round otherwise.
        for (written, sign) in [
            (Written::AxesMirrored, -1.0),
            (Written::EndsMirrored, 1.0),
            (Written::KeysReversed, 1.0),
        ] {
            let other = plan.yaml(written);
            let mirrored = solve(&language, &other, None, [sign * speed, sign * torque], PowerFlow::Real);
            let off = (mirrored.loss - seen.loss).abs() / seen.loss;
            assert!(
                mirrored.status == seen.status && off < 1e-9,
                "{off:e} {mirrored:?} {seen:?}\n{other}\n{}",
                told()
            );
        }

        // The real flow differs from the ideal one by the loss of losses: with all losses a tenth as large it is a hundredth. That holds
        // where power goes through, and as far as laws of friction are smooth over so small a change of load.
        let difference = |factor: f64| {
            let [real, ideal] =
                [PowerFlow::Real, PowerFlow::Ideal].map(|flow| solve(&language, &yaml, Some(factor), plan.point, flow));
            ((real.loss - ideal.loss).abs(), ideal.loss, ideal.input)
        };
        let (large, loss, input) = difference(0.1);
        let (small, ..) = difference(0.01);
        if loss < 0.2 * input {
            let second_order = loss * loss / input;
            assert!(
                large < 4.0 * second_order,
                "{large:e} W of {second_order:e} W {}",
                told()
            );
            // Below what rounding leaves of the loss the ratio says nothing.
            if large > 1e-8 * loss {
                in_the_limit += 1;
                assert!(
                    (0.008..0.0125).contains(&(small / large)),
                    "{} {}",
                    small / large,
                    told()
                );
            }
        }
    }
    assert!(
        2 * in_the_limit > count,
        "{in_the_limit} of {count} have been seen in the limit of small losses"
    );
}
