//! Planetary gearboxes from their documents: rolling power, unequal sharing, planets that dip, assembly, trains of several
//! sets.

use crate::common::{RPM, built, language};
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::flow::Status;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;

/// Losses by part path, sum, status, largest power inside.
fn losses(t: &Transmission, speed: f64, torque: f64, flow: PowerFlow) -> (Vec<(String, f64)>, f64, Status, f64) {
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[speed * RPM],
        torques: &[torque],
        flow,
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
    let parts = solution.parts().map(|(p, l)| (p.path.clone(), l.watts())).collect();
    (
        parts,
        solution.loss().unwrap_or(f64::NAN),
        solution.status(),
        solution.largest_power(),
    )
}

/// A loss that is a fixed share of the rolling power.
fn share(zeta: f64) -> String {
    format!("{{ type: formula, formula: \"{zeta} * torque * abs(speed) * 0.10471975511965977\" }}")
}

/// A simple set with held ring; numbers of teeth of sun, planet, ring; shares lost in both meshes.
fn simple(teeth: [u32; 3], zeta: [&str; 2], set: &str, more: &str) -> String {
    let [sun, planet, ring] = teeth;
    format!(
        "
gearloss: gearbox/1
ports: {{ input: sun_shaft, output: carrier }}
shafts:
  sun_shaft: {{ axis: [0 mm, 0 mm] }}
  carrier: {{ axis: [0 mm, 0 mm] }}
  ring_shaft: {{ axis: [0 mm, 0 mm] }}
  planet: {{ mass: 0.2 kg }}
gears:
  sun: {{ shaft: sun_shaft, z: {sun}, facewidth: 20 mm }}
  planet_gear: {{ shaft: planet, z: {planet}, facewidth: 20 mm }}
  ring: {{ shaft: ring_shaft, z: {ring}, facewidth: 20 mm, kind: ring, tip_diameter: {} mm }}
meshes:
  sun_planet: {{ gears: [sun, planet_gear], normal_module: 2 mm, centre_distance: {} mm, model: {} }}
  planet_ring: {{ gears: [planet_gear, ring], normal_module: 2 mm, centre_distance: {} mm, model: {} }}
planetary_sets:
  set: {{ carrier: carrier, planets: [planet], {set} }}
couplings: {{ brake: {{ kind: dog, between: [ring_shaft, housing] }} }}
gear_states: {{ only: [brake] }}
lubricants: {{ oil: {{ viscosity: {{ kv40: 46 mm2/s, kv100: 8 mm2/s }} }} }}
{more}",
        2 * ring - 4,
        sun + planet,
        zeta[0],
        sun + planet,
        zeta[1],
    )
}

/// Check D1 of rolling power: 50 Nm at 3000 rpm and ratio 4; 16 Nm at 3000 rpm and ratio 10.
#[test]
fn d1_losses_are_shares_of_the_rolling_power() {
    let language = language();
    for (teeth, torque, zeta, rolling, lost) in [
        ([24, 24, 72], 50.0, [0.05 * 0.15, 0.05 * 0.06], 11781.0, 123.7),
        ([16, 64, 144], 16.0, [0.04 * 0.18, 0.04 * 0.08], 4523.89, 47.0485),
    ] {
        let t = built(
            &language,
            &simple(teeth, [&share(zeta[0]), &share(zeta[1])], "count: 3", ""),
        );
        let (_, sum, status, largest) = losses(&t, 3000.0, torque, PowerFlow::Ideal);
        assert!((sum / lost - 1.0).abs() < 1e-5, "{sum} against {lost}");
        // The largest power inside is that of the port, which is more than what rolls.
        let port = torque * 3000.0 * RPM;
        assert!((largest / port - 1.0).abs() < 1e-9 && rolling < port && status == Status::Drive);
    }
}

#[test]
fn unequal_planets_lose_the_mean_over_the_planets() {
    let language = language();
    // A friction that rises with the root of the load.
    let law = "{ type: formula, formula: \"0.001 * torque ^ 1.5 * abs(speed)\" }";
    let pin = "bearings: { pin: { shaft: planet, outer: carrier, at: 0 mm, kind: needle_cage, bore: 20 mm, outside: 25 mm, \
               width: 18 mm, model: { type: formula, formula: \"1e-6 * radial ^ 2\" } } }";
    let at = |sharing: &str| {
        let t = built(
            &language,
            &simple([24, 24, 72], [law, law], &format!("count: 3{sharing}"), pin),
        );
        losses(&t, 3000.0, 60.0, PowerFlow::Ideal).0
    };
    let (equal, uneven) = (at(""), at(", load_sharing: 1.2"));
    let mean = |power: f64| (1.2_f64.powf(power) + 2.0 * 0.9_f64.powf(power)) / 3.0;
    for ((path, equal), (_, uneven)) in equal.iter().zip(&uneven).filter(|((_, watts), _)| *watts > 0.0) {
        // The pin carries the meshes across and the centrifugal force outwards; only the first is shared unevenly.
        let expected = if path == "bearings.pin" {
            let across = (2.0 * 60.0 / 3.0 / 0.024_f64).powi(2);
            let outwards = (0.2 * 0.048 * (750.0 * RPM).powi(2)).powi(2);
            (across * mean(2.0) + outwards) / (across + outwards)
        } else {
            mean(1.5)
        };
        assert!(
            *equal > 0.0 && (uneven / equal / expected - 1.0).abs() < 1e-9,
            "{path} {}",
            uneven / equal
        );
    }
    assert_eq!(at(", load_sharing: 1"), equal);
}

#[test]
fn the_explanation_of_an_unequal_planet_has_the_bits_of_the_solution() {
    let language = language();
    let text = simple(
        [24, 24, 72],
        ["{ type: iso14179_2 }"; 2],
        "count: 3, load_sharing: 1.3",
        "",
    );
    let t = built(&language, &text);
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[3000.0 * RPM],
        torques: &[60.0],
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
    let watts: Vec<f64> = solution.parts().map(|(_, loss)| loss.watts()).collect();
    for (i, watts) in watts.iter().enumerate().take(2) {
        let (loss, trace) = solution.explain(i);
        assert_eq!(loss.watts(), *watts);
        let steps = format!("{:?}", trace.into_steps());
        assert!(steps.contains("the most loaded planet") && steps.contains("each other planet"));
    }
}

#[test]
fn planets_dip_as_a_mean_over_their_orbit() {
    let language = language();
    let drag = "models: { gear_drag: { churning: { type: formula, formula: \"tip_dip\" } } }";
    let at = |level: f64| {
        let housing =
            format!("housing: {{ oil: {{ lubricant: oil, level: {level} mm, measured_from: carrier }} }}\n{drag}");
        let t = built(&language, &simple([24, 24, 72], ["none", "none"], "count: 3", &housing));
        let (parts, ..) = losses(&t, 3000.0, 0.0, PowerFlow::Ideal);
        let of = |path: &str| parts.iter().find(|p| p.0 == path).unwrap().1;
        // Moments of as many Nm as the tip circle dips in mm; three planets of 26 mm on 48 mm at -1500 rpm.
        (
            of("gears.planet_gear.drag.churning") / (3.0 * 1500.0 * RPM),
            of("gears.sun.drag.churning") / (3000.0 * RPM),
        )
    };
    for (level, dip) in [(-80.0, 0.0), (-20.0, 18.2756224), (0.0, 26.0), (80.0, 52.0)] {
        let (planet, sun) = at(level);
        assert!((planet - dip).abs() < 1e-6, "{planet} against {dip}");
        assert!((sun - (level + 26.0).clamp(0.0, 52.0)).abs() < 1e-9);
    }
}

#[test]
fn a_set_that_cannot_be_assembled_is_warned_of() {
    let language = language();
    let warnings = |set: &str, teeth| {
        let text = simple(teeth, ["none", "none"], set, "");
        let bare = text.replace("planet: { mass: 0.2 kg }", "planet: { mass: 0.2 kg, bearings: none }");
        let t = built(&language, &bare);
        t.warnings
            .iter()
            .map(|w| w.message.clone())
            .collect::<Vec<_>>()
            .join("; ")
    };
    assert!(!warnings("count: 3", [24, 24, 72]).contains("planets"));
    assert!(warnings("count: 5", [24, 24, 72]).contains("cannot be spaced equally"));
    assert!(warnings("count: 7", [24, 24, 72]).contains("adjacent planets touch"));
    let text = simple([24, 24, 72], ["none", "none"], "count: 3, load_sharing: 3.5", "");
    let gearbox = Gearbox::of_text(&language, &text, "input.yaml", ".").unwrap();
    let error = gearbox
        .transmission(&language, &Choice::default())
        .err()
        .unwrap()
        .render();
    assert!(
        error.contains("one planet of 3 cannot carry 3.5 times the mean"),
        "{error}"
    );
}

/// Check P6, from a document: sun 21, stepped planet 30 and 29, held ring 81, ring 80 as output.
#[test]
fn p6_a_wolfrom_train_multiplies_rolling_power() {
    let language = language();
    let text = |ring: f64| {
        format!(
            "
gearloss: gearbox/1
ports: {{ input: sun_shaft, output: output }}
shafts:
  sun_shaft: {{ axis: [0 mm, 0 mm] }}
  carrier: {{ axis: [0 mm, 0 mm] }}
  held: {{ axis: [0 mm, 0 mm] }}
  output: {{ axis: [0 mm, 0 mm] }}
  planet: {{}}
gears:
  sun: {{ shaft: sun_shaft, z: 21, facewidth: 10 mm }}
  planet_1: {{ shaft: planet, z: 30, facewidth: 10 mm }}
  planet_2: {{ shaft: planet, at: 12 mm, z: 29, facewidth: 10 mm }}
  ring_1: {{ shaft: held, z: 81, facewidth: 10 mm, kind: ring, tip_diameter: 79.2 mm }}
  ring_2: {{ shaft: output, at: 12 mm, z: 80, facewidth: 10 mm, kind: ring, tip_diameter: 78.2 mm }}
meshes:
  sp: {{ gears: [sun, planet_1], normal_module: 1 mm, centre_distance: 25.5 mm, model: {} }}
  p_r1: {{ gears: [planet_1, ring_1], normal_module: 1 mm, centre_distance: 25.5 mm, model: {} }}
  p_out: {{ gears: [planet_2, ring_2], normal_module: 1 mm, centre_distance: 25.5 mm, model: {} }}
planetary_sets:
  set: {{ carrier: carrier, planets: [planet], count: 3 }}
couplings: {{ brake: {{ kind: dog, between: [held, housing] }} }}
gear_states: {{ only: [brake] }}
lubricants: {{ oil: {{ viscosity: {{ kv40: 46 mm2/s, kv100: 8 mm2/s }} }} }}
",
            share(0.010),
            share(ring),
            share(ring)
        )
    };
    let rpm = 300.0 / RPM;
    let t = built(&language, &text(0.006));
    let (parts, sum, status, largest) = losses(&t, rpm, 1.0, PowerFlow::Real);
    assert_eq!(status, Status::Drive);
    assert!((sum / (300.0 * (1.0 - 0.636564384)) - 1.0).abs() < 1e-7, "{sum}");
    // Of 300 W that go in, 9 kW roll in the mesh with the held ring.
    assert!((largest - 8978.90).abs() < 0.01, "{largest}");
    assert!((parts[1].1 / (0.006 * 8978.90) - 1.0).abs() < 1e-6);
    let (_, sum, status, _) = losses(&t, rpm, -1.0, PowerFlow::Real);
    assert!(status == Status::Coast && sum > 0.0);
    // With lossier rings it locks itself, and says so.
    let (_, _, status, _) = losses(&built(&language, &text(0.012)), rpm, -1.0, PowerFlow::Real);
    assert_eq!(status, Status::SelfLocking);
}

const TABLE: &str = "speed [rpm],nu [mm2/s],volume [ml],moment [Nm]
100,20,60,0.010
100,20,130,0.020
100,200,60,0.040
100,200,130,0.080
400,20,60,0.020
400,20,130,0.050
400,200,60,0.080
400,200,130,0.200
";

/// The set with a drag table of the text beside it, at a carrier speed, oil of 80 degC.
fn tabled(language: &Language, csv: &str, model: &str, more: &str) -> Result<Transmission, String> {
    let text = simple(
        [24, 24, 72],
        ["none", "none"],
        &format!("count: 3, {more}model: {{ type: table, file: drag.csv{model} }}"),
        "housing: { oil: { lubricant: oil, volume: 90 ml } }",
    );
    let gearbox = Gearbox::of_text(language, &text, "input.yaml", ".").map_err(|e| e.render())?;
    gearbox.files.put("drag.csv", csv);
    gearbox
        .transmission(language, &Choice::default())
        .map_err(|e| e.render())
}

fn drag(t: &Transmission, input: f64) -> Option<(f64, bool)> {
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[input * RPM],
        torques: &[0.0],
        flow: PowerFlow::Ideal,
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
    let outside = solution.extents().iter().any(|e| e.outside > 0);
    solution.loss().map(|watts| (watts, outside))
}

/// Check D3: straight lines between logarithms of speed, viscosity and moment, straight in the volume.
#[test]
fn d3_a_table_is_interpolated_between_logarithms() {
    let language = language();
    let t = tabled(&language, TABLE, "", "").unwrap();
    // The oil of the test at 80 degC, as the framework computes it.
    let nu = {
        let t = built(
            &language,
            &simple(
                [24, 24, 72],
                ["none", "none"],
                "count: 3, model: { type: formula, formula: \"nu\" }",
                "",
            ),
        );
        drag(&t, 400.0).unwrap().0 / (100.0 * RPM)
    };
    assert!((10.0..20.0).contains(&nu), "{nu}");
    // On the grid in speed; half way in volume; a share of the way in viscosity would lie below the table.
    assert!(
        drag(&t, 800.0).is_none(),
        "the viscosity lies below the table, which is an error"
    );
    let clamped = tabled(&language, TABLE, ", outside: clamp", "").unwrap();
    let (watts, outside) = drag(&clamped, 800.0).unwrap();
    let share = 30.0 / 70.0;
    let at = |low: f64, high: f64| low.ln() + share * (high.ln() - low.ln());
    let moment = (0.5 * at(0.010, 0.020) + 0.5 * at(0.020, 0.050)).exp();
    assert!(
        outside && (watts / (moment * 200.0 * RPM) - 1.0).abs() < 1e-12,
        "{watts}"
    );
    // A further row of viscosity takes the point inside.
    let wide = TABLE.replace(",20,", ",2,");
    let (watts, outside) = drag(&tabled(&language, &wide, "", "").unwrap(), 800.0).unwrap();
    let t = (nu / 2.0).ln() / 100.0_f64.ln();
    let thick = 0.5 * at(0.040, 0.080) + 0.5 * at(0.080, 0.200);
    let moment = ((1.0 - t) * moment.ln() + t * thick).exp();
    assert!(
        !outside && (watts / (moment * 200.0 * RPM) - 1.0).abs() < 1e-12,
        "{watts}"
    );
    // At rest there is no drag, and backwards it is the same.
    assert_eq!(drag(&clamped, 0.0).unwrap().0, 0.0);
    assert_eq!(drag(&clamped, -800.0).unwrap().0, drag(&clamped, 800.0).unwrap().0);
    // With a zero among the moments the answer is interpolated as it stands.
    let zero = TABLE.replace("0.010", "0");
    let (watts, _) = drag(&tabled(&language, &zero, ", outside: clamp", "").unwrap(), 800.0).unwrap();
    let moment = 0.5 * share * 0.020 + 0.5 * (0.020 + share * 0.030);
    assert!((watts / (moment * 200.0 * RPM) - 1.0).abs() < 1e-12);
}

#[test]
fn a_table_may_refer_to_the_input_and_belong_to_a_family() {
    let language = language();
    let csv = "speed [rpm],size [mm],pressure [Nm],viscous [Nm]\n100,50,1,2\n100,100,2,4\n4000,50,2,3\n4000,100,4,6\n";
    let t = tabled(&language, csv, "", "reference: sun_shaft, size: 50 mm, ").unwrap();
    // The moment acts on the sun; pressure and viscous part are interpolated each by itself and added.
    let (watts, _) = drag(&t, 4000.0).unwrap();
    assert!((watts / (5.0 * 4000.0 * RPM) - 1.0).abs() < 1e-12);
    let missing = tabled(&language, csv, "", "").err().unwrap();
    assert!(missing.contains("`size` is unknown here") && missing.contains("state `size` of the planetary set"));
    let held = tabled(&language, TABLE, ", outside: clamp", "reference: ring_shaft, ").unwrap();
    assert!(drag(&held, 800.0).is_none(), "a shaft that rests feels no moment");
}

#[test]
fn a_faulty_table_is_refused_with_line_and_column() {
    let language = language();
    let refused = |csv: &str| tabled(&language, csv, "", "").err().unwrap();
    for (csv, said) in [
        (
            TABLE.replace("400,20,130,0.050\n", ""),
            "line 6: the next point, speed = 400 rpm, nu = 20 mm2/s, volume = 130 ml, is missing",
        ),
        (
            TABLE.replace("400,", "50,"),
            "line 6, column 1 `speed [rpm]`: 50 follows 100",
        ),
        (
            TABLE.replace("[mm2/s]", "[m2/s]"),
            "line 1, column 2: `nu` is in m2/s, not in mm2/s",
        ),
        (
            TABLE.replace("[Nm]", "[Nmm]"),
            "line 1, column 4: `moment` is in Nmm, not in Nm",
        ),
        (
            TABLE.replace("0.050", "NaN"),
            "line 7, column 4 `moment [Nm]`: `NaN` is not a number",
        ),
        (
            TABLE.lines().take(2).collect::<Vec<_>>().join("\n"),
            "line 2, column 1 `speed [rpm]`: one value up to here",
        ),
        (
            TABLE.replace("speed [rpm]", "spede [rpm]"),
            "the context of planetary_drag has no quantity `spede`",
        ),
        (
            TABLE.replace("nu [mm2/s]", "viscosity [mm2/s]"),
            "the axis `volume` follows `viscosity`",
        ),
        (
            TABLE.replace("0.050", "-0.050"),
            "at speed = 400, nu = 20, volume = 130 the result is -0.05, which is negative",
        ),
        (
            TABLE.replace("moment [Nm]", "moment"),
            "line 1, column 4: `moment` has no unit",
        ),
    ] {
        let text = tabled(&language, &csv, ", outside: clamp", "").err().unwrap();
        assert!(
            text.contains(said) && text.contains("drag.csv"),
            "{said}
{text}"
        );
    }
    assert!(refused("speed [rpm],nu [mm2/s],moment [Nm]\n").contains("no value up to here"));
}

#[test]
fn drag_is_not_counted_twice() {
    let language = language();
    let text = simple(
        [24, 24, 72],
        ["none", "none"],
        "count: 3, model: { type: constant, value: 0.1 Nm }",
        "models: { gear_drag: { churning: { type: constant, value: 0.2 Nm } } }",
    );
    let gearbox = Gearbox::of_text(&language, &text, "input.yaml", ".").unwrap();
    let error = gearbox
        .transmission(&language, &Choice::default())
        .err()
        .unwrap()
        .render();
    assert!(
        error.contains("churning is computed here and by `planetary_sets.set.model`"),
        "{error}"
    );
}

#[test]
fn a_power_law_is_exact_at_its_reference_and_notes_its_range() {
    let language = language();
    let law = "model: { type: power_law, moment: 0.05 Nm, speed: 300 rpm, nu: 100 mm2/s, volume: 60 ml, speed_exponent: 0.6, \
               volume_exponent: 1, speeds: [100 rpm, 500 rpm] }";
    let housing = "housing: { oil: { lubricant: oil, volume: 90 ml } }";
    let t = built(
        &language,
        &simple([24, 24, 72], ["none", "none"], &format!("count: 3, {law}"), housing),
    );
    for (input, inside) in [(1200.0, true), (2400.0, false)] {
        let carrier: f64 = input / 4.0;
        let (watts, outside) = drag(&t, input).unwrap();
        let moment = 0.05 * (carrier / 300.0).powf(0.6) * 1.5;
        assert!((watts / (moment * carrier * RPM) - 1.0).abs() < 1e-12 && outside != inside);
    }
    let without = simple([24, 24, 72], ["none", "none"], &format!("count: 3, {law}"), "");
    let gearbox = Gearbox::of_text(&language, &without, "input.yaml", ".").unwrap();
    let error = gearbox
        .transmission(&language, &Choice::default())
        .err()
        .unwrap()
        .render();
    assert!(error.contains("state `housing.oil.volume`"), "{error}");
}

#[test]
fn the_estimate_grows_with_level_and_speed_and_rests_on_assumptions() {
    let language = language();
    let at = |level: f64, input: f64| {
        let housing = format!(
            "housing: {{ oil: {{ lubricant: oil, volume: 90 ml, level: {level} mm, measured_from: carrier }} }}"
        );
        let set = "count: 3, model: { type: estimate, planet: { type: changenet_2011 } }";
        drag(
            &built(&language, &simple([24, 24, 72], ["none", "none"], set, &housing)),
            input,
        )
        .unwrap()
        .0
    };
    assert_eq!(at(-100.0, 3000.0), 0.0);
    assert!(at(-40.0, 3000.0) < at(0.0, 3000.0) && at(0.0, 3000.0) < at(40.0, 3000.0));
    assert!(
        at(0.0, 1000.0) < at(0.0, 3000.0) && (0.1..50.0).contains(&at(0.0, 3000.0)),
        "{}",
        at(0.0, 3000.0)
    );
}

/// Check A7: speeds of planets in the housing's and in the carrier's frame.
#[test]
fn a7_planets_turn_as_willis_says() {
    let language = language();
    for (teeth, sun, carrier, planet) in [
        ([24, 24, 72], 3000.0, 750.0, -1500.0),
        ([30, 20, 70], 1000.0, 300.0, -750.0),
    ] {
        let t = built(&language, &simple(teeth, ["none", "none"], "count: 2", ""));
        let case = t.case("only", &["input"], &["input"]).unwrap();
        let mut scratch = t.scratch(&case);
        let point = Point {
            speeds: &[sun * RPM],
            torques: &[0.0],
            flow: PowerFlow::Ideal,
            ..Point::default()
        };
        let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
        let speed = |name: &str| solution.speed(t.members().iter().position(|m| m == name).unwrap()) / RPM;
        assert!((speed("carrier") / carrier - 1.0).abs() < 1e-12 && (speed("planet") / planet - 1.0).abs() < 1e-12);
        // In the carrier's frame, where losses arise.
        let relative = speed("planet") - speed("carrier");
        assert!((relative + (sun - carrier) * f64::from(teeth[0]) / f64::from(teeth[1])).abs() < 1e-9);
    }
}
