//! Plain bearings and thrust washers in a gearbox: as supports of a shaft, on planets, with their films, ratings and errors.

use crate::common::{RPM, language};
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::resolve::Choice;
use gearloss_framework::testing::{assert_close, eval};
use gearloss_framework::transmission::Transmission;

/// A helical stage whose pinion runs in bearings that are given.
fn stage(bearings: &str) -> Transmission {
    let text = format!(
        "
gearloss: gearbox/1
ports: {{ input: pinion_shaft, output: wheel_shaft }}
shafts:
  pinion_shaft: {{ axis: [0 mm, 0 mm] }}
  wheel_shaft: {{ axis: [90 mm, 0 mm] }}
gears:
  pinion: {{ shaft: pinion_shaft, at: 30 mm, z: 20, facewidth: 24 mm, hand: right }}
  wheel: {{ shaft: wheel_shaft, at: 30 mm, z: 67, facewidth: 24 mm }}
meshes:
  stage: {{ gears: [pinion, wheel], normal_module: 2 mm, helix_angle: 15 deg, centre_distance: 90 mm }}
bearings:
{bearings}
  W1: {{ shaft: wheel_shaft, at: 0 mm, designation: \"6206\", axial: both }}
  W2: {{ shaft: wheel_shaft, at: 60 mm, designation: \"6206\" }}
lubricants: {{ oil: {{ viscosity: {{ kv40: 46 mm2/s, kv100: 8 mm2/s }}, density: {{ value: 860 kg/m3, at: 15 degC }} }} }}
models: {{ gear_mesh: {{ type: iso14179_2 }}, bearing: {{ type: iso14179_2 }} }}
"
    );
    built(&text)
}

fn built(text: &str) -> Transmission {
    let language = language();
    let gearbox = Gearbox::of_text(&language, text, "input.yaml", ".").unwrap();
    gearbox.transmission(&language, &Choice::default()).unwrap()
}

/// Loss of a part in W, with its readings, at a speed in 1/min and a torque in N m with an oil of 80 degC.
fn at(t: &Transmission, part: &str, speed: f64, torque: f64) -> (f64, impl Fn(&str) -> f64) {
    with_oil(t, part, speed, torque, 80.0)
}

fn with_oil(t: &Transmission, part: &str, speed: f64, torque: f64, oil: f64) -> (f64, impl Fn(&str) -> f64) {
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[speed * RPM],
        torques: &[torque],
        flow: PowerFlow::Ideal,
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[oil], &mut scratch);
    let number = t.parts().iter().position(|p| p.path == part).unwrap();
    let watts = solution.parts().nth(number).unwrap().1.watts();
    let readings = solution.readings(number);
    let read = move |name: &str| readings.iter().find(|r| r.name == name).unwrap().value;
    (watts, read)
}

const PLAIN: &str = "  P1: { shaft: pinion_shaft, at: 0 mm, kind: plain, bore: 25 mm, width: 20 mm, film: { clearance: 40 um, least_thickness: 2 um }, model: { type: journal_film } }
  P2: { shaft: pinion_shaft, at: 60 mm, kind: plain, bore: 25 mm, width: 20 mm, film: { clearance: 40 um, least_thickness: 2 um }, model: { type: journal_film } }
  T1: { shaft: pinion_shaft, at: 0 mm, kind: thrust_washer, bore: 26 mm, outside: 38 mm, axial: left, film: { gap: 80 um, solid_friction: 0.05 }, model: { type: washer_gap } }
  T2: { shaft: pinion_shaft, at: 60 mm, kind: thrust_washer, bore: 26 mm, outside: 38 mm, axial: right, film: { gap: 80 um, solid_friction: 0.05 }, model: { type: washer_gap } }";

const ROLLING: &str = "  P1: { shaft: pinion_shaft, at: 0 mm, designation: \"6205\", axial: left }
  P2: { shaft: pinion_shaft, at: 60 mm, designation: \"6205\", axial: right }";

#[test]
fn plain_bearings_carry_radial_loads_and_washers_the_thrust() {
    let (plain, rolling) = (stage(PLAIN), stage(ROLLING));
    for bearing in ["bearings.P1", "bearings.P2"] {
        let (_, of_plain) = at(&plain, bearing, 3000.0, 50.0);
        let (_, of_rolling) = at(&rolling, bearing, 3000.0, 50.0);
        assert_close(of_plain("radial"), of_rolling("radial"), 1e-12);
        assert_eq!(of_plain("axial"), 0.0);
    }
    let thrust = ["bearings.P1", "bearings.P2"].map(|bearing| at(&rolling, bearing, 3000.0, 50.0).1("axial"));
    let washers = ["bearings.T1", "bearings.T2"].map(|washer| at(&plain, washer, 3000.0, 50.0).1);
    for (washer, thrust) in washers.iter().zip(thrust) {
        assert_eq!(washer("radial"), 0.0);
        assert_close(washer("axial") + 1.0, thrust + 1.0, 1e-12);
    }
    assert!(thrust.iter().sum::<f64>() > 100.0);
}

#[test]
fn their_losses_are_those_of_the_laws_at_the_loads_of_the_point() {
    let plain = stage(PLAIN);
    let (journal, read) = at(&plain, "bearings.P1", 3000.0, 50.0);
    let alone = eval(
        "bearing/journal_film",
        &format!(
            "{{ part: {{ kind: plain, bore: 25 mm, width: 20 mm, film: {{ relative_clearance: 0.0016, least_thickness: 2 um }} }}, \
             at: {{ speed: 3000 rpm, radial: {} N, temperature: 80 degC, nu: {} mm2/s, rho: {} kg/m3 }} }}",
            read("radial"),
            read("nu"),
            read("rho"),
        ),
    );
    assert_close(journal, alone.total, 1e-9);
    let (idle, _) = at(&plain, "bearings.P1", 3000.0, 0.0);
    // Petroff: without load, the shaft is in the middle.
    let w = 3000.0 * RPM;
    let eta = read("nu") * 1e-6 * read("rho");
    let petroff = std::f64::consts::PI * eta * w * w * 0.02 * 0.025 * 0.025 / (2.0 * 0.0016);
    assert_close(idle, petroff, 1e-9);
    let (still, _) = at(&plain, "bearings.P1", 0.0, 50.0);
    assert_eq!(still, 0.0);
}

/// A planet on a plain pin between two washers: the film is that of the load of the planet and of its speed on the pin.
#[test]
fn a_planet_runs_on_a_plain_pin_between_washers() {
    let t = built(
        "
gearloss: gearbox/1
ports: { input: sun_shaft, output: carrier }
shafts:
  sun_shaft: { axis: [0 mm, 0 mm] }
  carrier: { axis: [0 mm, 0 mm] }
  ring_shaft: { axis: [0 mm, 0 mm] }
  planet: { mass: 0.2 kg }
gears:
  sun: { shaft: sun_shaft, z: 24, facewidth: 20 mm }
  planet_gear: { shaft: planet, z: 24, facewidth: 20 mm }
  ring: { shaft: ring_shaft, z: 72, facewidth: 20 mm, kind: ring, tip_diameter: 140 mm }
meshes:
  sun_planet: { gears: [sun, planet_gear], normal_module: 2 mm, centre_distance: 48 mm }
  planet_ring: { gears: [planet_gear, ring], normal_module: 2 mm, centre_distance: 48 mm }
planetary_sets:
  set: { carrier: carrier, planets: [planet], count: 3 }
couplings: { brake: { kind: dog, between: [ring_shaft, housing] } }
gear_states: { only: [brake] }
bearings:
  pin: { shaft: planet, outer: carrier, at: 0 mm, kind: plain, bore: 18 mm, width: 20 mm, film: { relative_clearance: 0.002, least_thickness: 1 um }, model: { type: journal_film } }
  left: { shaft: planet, outer: carrier, at: -10 mm, kind: thrust_washer, bore: 19 mm, outside: 30 mm, axial: left, film: { gap: 200 um }, model: { type: washer_gap } }
  right: { shaft: planet, outer: carrier, at: 10 mm, kind: thrust_washer, bore: 19 mm, outside: 30 mm, axial: right, film: { gap: 200 um }, model: { type: washer_gap } }
lubricants: { oil: { viscosity: { kv40: 46 mm2/s, kv100: 8 mm2/s } } }
models: { gear_mesh: { type: iso14179_2 } }
",
    );
    let (pin, read) = at(&t, "bearings.pin", 3000.0, 50.0);
    // The sun turns a planet of equal teeth by (3000 - 750) against the carrier; both meshes push it across.
    let relative = 2250.0;
    assert_close(read("speed").abs(), relative, 1e-12);
    let across: f64 = 2.0 * 50.0 / 3.0 / 0.024;
    let outwards = 0.2 * 0.048 * (750.0_f64 * RPM).powi(2);
    assert_close(read("radial"), across.hypot(outwards), 1e-9);
    let alone = eval(
        "bearing/journal_film",
        &format!(
            "{{ part: {{ kind: plain, bore: 18 mm, width: 20 mm, film: {{ relative_clearance: 0.002, least_thickness: 1 um }} }}, \
             at: {{ speed: {relative} rpm, radial: {} N, nu: {} mm2/s, rho: {} kg/m3 }} }}",
            read("radial"),
            read("nu"),
            read("rho"),
        ),
    );
    assert_close(pin, 3.0 * alone.total, 1e-9);
    let (washer, _) = at(&t, "bearings.left", 3000.0, 50.0);
    let w = relative * RPM;
    let ring = std::f64::consts::PI / 32.0 * (0.03_f64.powi(4) - 0.019_f64.powi(4)) / 2e-4;
    assert_close(washer, 3.0 * ring * read("nu") * 1e-6 * read("rho") * w * w, 1e-9);
}

/// A film that is warmer than its oil has the viscosity of that oil at its temperature.
#[test]
fn a_film_warmer_than_its_oil_follows_the_line_of_the_oil() {
    let with_film = |more: &str| {
        stage(&format!(
            "  P1: {{ shaft: pinion_shaft, at: 0 mm, kind: plain, bore: 25 mm, width: 20 mm, \
             film: {{ clearance: 40 um, least_thickness: 2 um{more} }}, model: {{ type: journal_film }} }}\n  \
             P2: {{ shaft: pinion_shaft, at: 60 mm, designation: \"6205\", axial: both }}"
        ))
    };
    let (plain, cooled) = (with_film(""), with_film(", conductance: 2 W/K"));
    let (isothermal, _) = at(&plain, "bearings.P1", 6000.0, 50.0);
    let (warm, _) = at(&cooled, "bearings.P1", 6000.0, 50.0);
    let temperature = 80.0 + warm / 2.0;
    assert!(
        warm < 0.95 * isothermal && temperature > 85.0,
        "{warm} of {isothermal} W"
    );
    // Of the oil at that temperature only the density differs, by 0.6 % in 10 K.
    let (at_its_temperature, _) = with_oil(&plain, "bearings.P1", 6000.0, 50.0, temperature);
    assert_close(warm, at_its_temperature, 0.02);
}
