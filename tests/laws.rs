//! Laws between the quantities of a context: what follows where `eval` states some of them, and what is refused.

use std::path::Path;

use gearloss_framework::eval::evaluate_input;
use gearloss_framework::loss::Notes;
use gearloss_framework::mechanism::auxiliary::Auxiliary;
use gearloss_framework::mechanism::gear_drag::GearDrag;
use gearloss_framework::mechanism::gear_mesh::GearMesh;
use gearloss_framework::mechanism::heat_link::HeatLink;
use gearloss_framework::mechanism::mean_friction::MeanFriction;
use gearloss_framework::mechanism::planetary_drag::PlanetaryDrag;
use gearloss_framework::mechanism::tooth_friction::ToothFriction;
use gearloss_framework::mechanism::{Mechanism, ROUNDED, settle};
use gearloss_framework::registry::from_resolved;
use gearloss_framework::testing::{assert_close, eval, language};
use gearloss_plugins as _;

/// The usual values agree with the laws, and for each quantity of a law follows from the others what it is.
fn holds<M: Mechanism>() {
    let language = language();
    let entry = language.registry().model_named(M::KEY, "constant").unwrap();
    let part: M::Part = from_resolved(&language.example_of(entry).unwrap().1).unwrap();
    let mut at = M::usual(&part, Notes::MUTED);
    let usual: Vec<f64> = M::QUANTITIES.iter().map(|q| (q.get)(&at)).collect();
    settle::<M>(&mut at, &[]).unwrap();
    for law in M::LAWS {
        for (name, follows) in law.quantities {
            let quantity = M::QUANTITIES.iter().find(|q| q.name == *name);
            let quantity = quantity.unwrap_or_else(|| panic!("{}: no quantity `{name}`", law.text));
            let (is, follows) = ((quantity.get)(&at), follows(&at));
            if law.always {
                assert!(
                    (is - follows).abs() <= 1e-9 * is.abs().max(follows.abs()),
                    "{}: {name} {is} {follows}",
                    law.text
                );
            }
        }
    }
    for (quantity, before) in M::QUANTITIES.iter().zip(usual) {
        let now = (quantity.get)(&at);
        assert!(
            (now - before).abs() <= ROUNDED * before.abs(),
            "{}: {} {before} {now}",
            M::KEY,
            quantity.name
        );
    }
}

#[test]
fn usual_values_agree_with_the_laws() {
    holds::<Auxiliary>();
    holds::<GearDrag>();
    holds::<GearMesh>();
    holds::<HeatLink>();
    holds::<MeanFriction>();
    holds::<PlanetaryDrag>();
    holds::<ToothFriction>();
}

/// What a formula of one quantity sees.
fn seen(mechanism: &str, quantity: &str, at: &str) -> f64 {
    let input = format!("model: {{ type: formula, formula: {quantity} }}\nat: {at}");
    let seen = eval(&format!("{mechanism}/formula"), &input);
    seen.moment.unwrap_or(seen.total)
}

fn refused(mechanism: &str, at: &str) -> String {
    let input = format!("at: {at}");
    let answer = evaluate_input(
        language(),
        &format!("{mechanism}/constant"),
        "input",
        &input,
        Path::new(""),
    );
    answer.unwrap_err().to_string()
}

#[test]
fn viscosities_and_density_follow_from_each_other() {
    let eta = |at: &str| seen("mean_friction", "eta", at);
    assert_close(eta("{ nu: 1000 mm2/s }"), 820.0, 1e-12);
    assert_close(eta("{ nu: 50 mm2/s, rho: 900 kg/m3 }"), 45.0, 1e-12);
    assert_close(eta("{ rho: 900 kg/m3 }"), 9.0, 1e-12);
    assert_close(seen("mean_friction", "nu", "{ eta: 41 mPa s }"), 50.0, 1e-12);
    assert_close(
        seen("mean_friction", "rho", "{ eta: 45 mPa s, nu: 50 mm2/s }"),
        900.0,
        1e-12,
    );
    // Rounded, as a data sheet has them.
    assert_close(eta("{ nu: 6.0 mm2/s, eta: 4.9 mPa s, rho: 818 kg/m3 }"), 4.9, 1e-12);
}

#[test]
fn what_contradicts_is_refused_by_name() {
    let text = refused("gear_mesh", "{ nu: 1000 mm2/s, eta: 8 mPa s, rho: 820 kg/m3 }");
    for part in [
        "at.eta",
        "8 mPa s",
        "`nu` of 1000 mm2/s",
        "`rho` of 820 kg/m3",
        "820 mPa s",
        "eta = nu rho",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    // Neither contradicts the other, but the density that follows is none.
    let text = refused("mean_friction", "{ nu: 1000 mm2/s, eta: 8 mPa s }");
    assert!(
        text.contains("`rho` of 8 kg/m3 (eta = nu rho), which is outside"),
        "{text}"
    );
    let text = refused("tooth_friction", "{ sliding: 12 m/s, sum_speed: 3 m/s }");
    assert!(
        text.contains("at.sliding") && text.contains("`sum_speed` of 3 m/s"),
        "{text}"
    );
    let text = refused("gear_drag", "{ tip_dip: 20 mm, dip: 60 mm }");
    assert!(text.contains("at.dip") && text.contains("`tip_dip` of 20 mm"), "{text}");
    // Over one step: the speed of the pitch circle stands between both.
    let text = refused("mean_friction", "{ speed: 3000 rpm, sum_speed: 20 m/s }");
    assert!(text.contains("at.sum_speed"), "{text}");
}

#[test]
fn pressures_and_speeds_of_a_contact_follow() {
    // Hertz: 300 N/mm on 10 mm with 226.374 GPa have 1.03964 GPa.
    let at = "{ line_load: 300 N/mm, radius: 10 mm, modulus: 226.374 GPa }";
    assert_close(seen("tooth_friction", "pressure", at), 1.03964, 1e-5);
    let at = "{ pressure: 1.03964 GPa, radius: 10 mm, modulus: 226.374 GPa }";
    assert_close(seen("tooth_friction", "line_load", at), 300.0, 1e-4);
    assert_close(seen("tooth_friction", "sum_speed", "{ sliding: 25 m/s }"), 25.0, 1e-12);
    // The pair of the example at 1500 1/min: 4.38883 m/s, and its normal force under 422.293 N/mm over 14 mm.
    assert_close(seen("mean_friction", "sum_speed", "{ speed: 1500 rpm }"), 4.38883, 1e-5);
    assert_close(
        seen("mean_friction", "speed", "{ sum_speed: 4.38883 m/s }"),
        1500.0,
        1e-5,
    );
    assert_close(
        seen("mean_friction", "normal_force", "{ line_load: 422.293 N/mm }"),
        5912.1,
        1e-5,
    );
    assert_close(seen("mean_friction", "radius", "{}"), 8.38205, 1e-5);
}

#[test]
fn dips_and_speeds_of_a_pair_follow() {
    // Tip 176.3 mm, reference 172.4 mm.
    assert_close(seen("gear_drag", "dip", "{ tip_dip: 50 mm }"), 48.05, 1e-9);
    assert_close(seen("gear_drag", "tip_dip", "{ dip: 48.05 mm }"), 50.0, 1e-9);
    assert_eq!(seen("gear_drag", "dip", "{ tip_dip: 1 mm }"), 0.0);
    assert_close(seen("gear_drag", "abs(speed_2)", "{ speed: 3100 rpm }"), 9600.0, 1e-9);
    // The planets of a turning carrier keep another ratio.
    assert_close(
        seen("gear_drag", "abs(speed_2)", "{ speed: 3100 rpm, speed_2: 100 rpm }"),
        100.0,
        1e-9,
    );
}

/// What `eval` says of a part that cannot be.
fn impossible(model: &str, part: &str) -> String {
    let answer = evaluate_input(language(), model, "input", &format!("part: {part}"), Path::new(""));
    answer.unwrap_err().to_string()
}

#[test]
fn parts_that_cannot_be_are_refused_by_name() {
    let gear = |changes: &str| {
        let mut gear = String::from(
            "{ gear: { z: 96, normal_module: 1.6 mm, pressure_angle: 17.5 deg, helix_angle: 27 deg, facewidth: 17 mm, \
             reference_diameter: 172.4 mm, working_diameter: 173.9 mm, tip_diameter: 176.3 mm, root_diameter: 169 mm, \
             contact_height: 90 mm }, oil_volume: 1.3 l }",
        );
        let (from, to) = changes.split_once(" by ").unwrap();
        assert!(gear.contains(from), "{from}");
        gear = gear.replace(from, to);
        gear
    };
    for (changes, named) in [
        (
            "tip_diameter: 176.3 mm by tip_diameter: 150 mm",
            ["tip_diameter 150 mm", "root_diameter 169 mm"],
        ),
        (
            "reference_diameter: 172.4 mm by reference_diameter: 130 mm",
            ["reference_diameter 130 mm", "normal_module"],
        ),
        (
            "contact_height: 90 mm by contact_height: 300 mm",
            ["contact_height 300 mm", "tip_diameter"],
        ),
    ] {
        for model in ["changenet_2011", "mauz", "iso14179_1", "dawson"] {
            let text = impossible(&format!("gear_drag/{model}"), &gear(changes));
            assert!(named.iter().all(|name| text.contains(name)), "{model}: {text}");
        }
    }
    let bearing =
        "{ kind: deep_groove_ball, series: \"63\", bore: 40 mm, outside: 90 mm, c0: 24000 N, raceway: 60 mm }";
    let text = impossible("bearing/skf", bearing);
    assert!(
        text.contains("raceway 60 mm") && text.contains("bore and outside"),
        "{text}"
    );
    let link =
        "{ gear: { teeth: 30, pitch_diameter: 60 mm, tip_diameter: 64 mm, tooth_height: 40 mm, facewidth: 20 mm } }";
    let text = impossible("heat_link/fling_off", link);
    assert!(
        text.contains("tooth_height 40 mm") && text.contains("tip_diameter 64 mm"),
        "{text}"
    );
}
