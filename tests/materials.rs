//! Materials of gears: two of one steel have the results of one modulus, plastics soften the contact, and nothing is undefined.

use gearloss_framework::contact::sharing::stiffness::single_stiffness;
use gearloss_framework::document::{Diagnostic, Severity};
use gearloss_framework::evaluate::Point;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::material::{Elastic, reduced_modulus};
use gearloss_framework::mechanism::gear_mesh::MeshPart;
use gearloss_framework::resolve::Choice;
use gearloss_framework::testing::{assert_close, eval, rate};
use proptest::prelude::*;

use crate::common::{RPM, file, language};

const PAIR: &str = "z: [20, 40], normal_module: 1 mm, pressure_angle: 20 deg, facewidth: 10 mm, ra: [0.4 um, 0.4 um], rq: [0.5 um, 0.5 um]";
const STEEL: &str = "{ elastic_modulus: 206 GPa, poisson: 0.3, density: 7830 kg/m3, conductivity: 46 W/(m K), heat_capacity: 465 J/(kg K) }";
const POM: &str = "{ kind: pom, elastic_modulus: 2.8 GPa, poisson: 0.35, density: 1415 kg/m3, conductivity: 0.3 W/(m K), \
    heat_capacity: 1465 J/(kg K) }";

/// A stage as written, with more text in its gears and sections.
fn stage(pinion: &str, wheel: &str, mesh: &str, model: &str, more: &str) -> String {
    format!(
        "gearloss: gearbox/1\nports: {{ input: a, output: b }}\nshafts: {{ a: {{ axis: [30 mm, 0 mm] }}, b: {{ axis: [0 mm, 0 mm] }} }}\n\
         gears:\n  pinion: {{ shaft: a, at: 20 mm, z: 20, facewidth: 10 mm{pinion} }}\n  wheel: {{ shaft: b, at: 20 mm, z: 40, facewidth: 10 mm{wheel} }}\n\
         meshes: {{ stage: {{ gears: [pinion, wheel], normal_module: 1 mm{mesh} }} }}\n\
         bearings:\n  B1: {{ shaft: a, at: 0 mm, designation: \"6000\", axial: both, model: none }}\n  B2: {{ shaft: a, at: 40 mm, designation: \"6000\", axial: none, model: none }}\n  \
         B3: {{ shaft: b, at: 0 mm, designation: \"6000\", axial: both, model: none }}\n  B4: {{ shaft: b, at: 40 mm, designation: \"6000\", axial: none, model: none }}\n\
         lubricants: {{ sump: {{ designation: ISO VG 100 mineral }} }}\nthermal: {{ oil: 60 degC }}\nmodels: {{ gear_mesh: {model} }}\n{more}"
    )
}

const XU: &str = "{ type: path_integral, tooth_friction: { type: xu } }";
const DRY: &str = "{ type: ohlendorf, mean_friction: { type: vdi_2736, lubrication: dry } }";

/// Loss at 2 Nm and 1000 rpm. \[W\]
fn loss(text: &str) -> f64 {
    let language = language();
    let gearbox = Gearbox::of_text(&language, text, "gearbox.yaml", "").unwrap();
    let t = gearbox.transmission(&language, &Choice::default());
    let t = t.unwrap_or_else(|found| panic!("{found:#?}"));
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let point = Point {
        speeds: &[1000.0 * RPM],
        torques: &[2.0],
        ..Point::default()
    };
    let mut scratch = t.scratch(&case);
    t.evaluate(&case, &point, &[60.0], &mut scratch).loss().unwrap()
}

/// All findings: errors, else warnings.
fn findings(text: &str) -> Vec<Diagnostic> {
    let language = language();
    let gearbox = Gearbox::of_text(&language, text, "gearbox.yaml", "").unwrap();
    match gearbox.transmission(&language, &Choice::default()) {
        Ok(t) => t.warnings,
        Err(found) => found.list,
    }
}

fn code(text: &str, path: &str) -> (Severity, String) {
    let found = findings(text);
    let one = found.iter().find(|finding| finding.path == path);
    let one = one.unwrap_or_else(|| panic!("{path}: {found:#?}"));
    (one.severity, one.code.map(|code| code.to_string()).unwrap_or_default())
}

/// Two equal steels have the bits of one modulus, whatever it is, in every law of friction that uses it.
#[test]
fn two_equal_steels_are_one_modulus() {
    let steel = "materials: { steel: { elastic_modulus: 195 GPa, poisson: 0.28 } }\n";
    for model in [
        XU,
        "{ type: path_integral, load_sharing: { type: slices, slices: 8, phases: 40 }, tooth_friction: { type: xu } }",
        "{ type: path_integral, tooth_friction: { type: ehl_mixed, tau0: 5 MPa, limiting_slope: 0.055, mu_b: 0.13 } }",
        "{ type: ohlendorf, mean_friction: { type: schlenk } }",
    ] {
        let one = loss(&stage("", "", ", elastic_modulus: 195 GPa, poisson: 0.28", model, ""));
        let two = loss(&stage(", material: steel", ", material: steel", "", model, steel));
        assert_eq!(one.to_bits(), two.to_bits(), "{model}");
        // Another gear alone keeps the modulus of the mesh.
        let half = loss(&stage(
            ", material: steel",
            "",
            ", elastic_modulus: 195 GPa, poisson: 0.28",
            model,
            steel,
        ));
        assert_eq!(one.to_bits(), half.to_bits(), "{model}");
    }
}

/// Hertz by hand: E* = 1/((1 - nu1^2)/E1 + (1 - nu2^2)/E2), of which E' is twice.
#[test]
fn the_contact_of_two_materials_is_that_of_hertz() {
    let steel = Elastic {
        modulus: 206e9,
        poisson: 0.3,
    };
    let pom = Elastic {
        modulus: 2.8e9,
        poisson: 0.35,
    };
    let by_hand = 2.0 / (0.91 / 206e9 + 0.8775 / 2.8e9);
    assert_close(reduced_modulus([steel, pom]), by_hand, 1e-14);
    assert_eq!(
        reduced_modulus([steel, pom]).to_bits(),
        reduced_modulus([pom, steel]).to_bits()
    );
    assert_eq!(reduced_modulus([steel; 2]).to_bits(), (206e9 / 0.91_f64).to_bits());
    let pressure = |materials: [&str; 2]| {
        let [first, second] = materials;
        let found = rate(
            "flank_contact",
            &format!("{{ part: {{ {PAIR}, materials: [{first}, {second}] }}, at: {{ torque: 2 Nm }}, rating: {{}} }}"),
        );
        found.rated.value("p_HC").unwrap()
    };
    let ratio = pressure([STEEL, POM]) / pressure([STEEL, STEEL]);
    assert_close(ratio, (by_hand / (206e9 / 0.91)).sqrt(), 1e-12);
}

/// Stiffness of ISO 6336-1 times 2 E1 E2/((E1 + E2) 206 GPa): 5.6/208.8 for 206 and 2.8 GPa.
#[test]
fn the_stiffness_of_teeth_is_that_of_both_moduli() {
    let pair = MeshPart::fzg_c().unwrap().pair;
    let steel = Elastic {
        modulus: 206e9,
        poisson: 0.3,
    };
    let plastic = Elastic {
        modulus: 2.8e9,
        poisson: 0.3,
    };
    let ratio = single_stiffness(&pair, [steel, plastic]) / single_stiffness(&pair, [steel; 2]);
    assert_close(ratio, 5.6 / 208.8, 1e-12);
}

/// The film is omitted for plastics: its formulas suppose that the pressure raises the viscosity.
#[test]
fn the_film_of_plastic_flanks_is_not_rated() {
    let film = |materials: &str| {
        let found = rate(
            "flank_contact",
            &format!("{{ part: {{ {PAIR}, materials: {materials} }}, at: {{ torque: 2 Nm }}, rating: {{}} }}"),
        );
        found.rated.value("lambda")
    };
    assert!(film(&format!("[{STEEL}, {STEEL}]")).is_some());
    assert!(film(&format!("[{STEEL}, {POM}]")).is_none());
}

/// Blok's flash temperature is the same if both gears are exchanged, and lies between those of two steels and of two plastics under the same
/// contact.
#[test]
fn the_heat_goes_into_both_flanks_by_their_effusivity() {
    let flash = |first: &str, second: &str| {
        let found = rate(
            "flash_temperature",
            &format!(
                "{{ part: {{ {PAIR}, materials: [{first}, {second}] }}, at: {{ torque: 2 Nm, speed: 1000 rpm }}, \
                 rating: {{ mean_friction: {{ type: constant, value: 0.1 }} }} }}"
            ),
        );
        found.rated.value("theta_fl").unwrap()
    };
    // The elastic constants of the plastic with the heat of the steel, so that only the heat differs.
    let conducting = POM
        .replace("1415", "7830")
        .replace("0.3 W", "46 W")
        .replace("1465", "465");
    let [mixed, steel, plastic] = [
        flash(&conducting, POM),
        flash(&conducting, &conducting),
        flash(POM, POM),
    ];
    assert!(steel < mixed && mixed < plastic, "{steel} {mixed} {plastic}");
    // Nearly all heat goes into the steel.
    assert!(mixed < 0.25 * plastic, "{mixed} {plastic}");
}

/// A material by its designation alone, and one that `materials` describes by it.
#[test]
fn a_gear_names_a_material_or_its_designation() {
    let by_entry = stage(
        ", material: steel",
        ", material: plastic",
        "",
        DRY,
        "materials: { plastic: { designation: POM }, steel: { designation: steel } }\n",
    );
    let by_designation = stage(", material: steel", ", material: POM", "", DRY, "");
    assert_eq!(loss(&by_entry).to_bits(), loss(&by_designation).to_bits());
    assert!(findings(&by_designation).is_empty(), "{:#?}", findings(&by_designation));
    // P = T w mu H_v with mu 0.20 of a steel pinion with a wheel of plastic, 0.18 the other way round.
    let other = stage(", material: POM", ", material: steel", "", DRY, "");
    assert_close(loss(&other) / loss(&by_designation), 0.9, 1e-12);
}

#[test]
fn findings_have_their_code_and_place() {
    let error = |code: &str| (Severity::Error, code.to_owned());
    let warning = |code: &str| (Severity::Warning, code.to_owned());
    let unnamed = stage("", ", material: wood", "", XU, "");
    assert_eq!(code(&unnamed, "gears.wheel.material"), error("E0203"));
    let incomplete = stage("", ", material: own", "", XU, "materials: { own: { poisson: 0.3 } }\n");
    assert_eq!(code(&incomplete, "materials.own.elastic_modulus"), error("E0370"));
    let half = "materials: { own: { elastic_modulus: 3 GPa, poisson: 0.35, conductivity: 0.3 W/(m K) } }\n";
    let half = stage("", ", material: own", "", XU, half);
    assert_eq!(code(&half, "materials.own.density"), error("E0370"));
    // No metal is so soft, so that steel does not stand in.
    let soft = "materials: { own: { elastic_modulus: 3 GPa, poisson: 0.35 } }\n";
    let soft = stage("", ", material: own", "", XU, soft);
    assert_eq!(code(&soft, "materials.own.kind"), error("E0370"));
    let unused = stage("", "", "", XU, "materials: { own: { designation: POM } }\n");
    assert_eq!(code(&unused, "materials.own"), warning("W0370"));
    let twice = stage(
        ", material: steel",
        ", material: steel",
        ", elastic_modulus: 195 GPa, poisson: 0.28",
        XU,
        "",
    );
    assert_eq!(code(&twice, "meshes.stage.elastic_modulus"), warning("W0370"));
    assert_eq!(code(&twice, "meshes.stage.poisson"), warning("W0370"));
    let metal = stage("", ", material: POM", "", XU, "");
    assert_eq!(code(&metal, "meshes.stage.model.tooth_friction.type"), warning("W0372"));
    // The coefficient of lubricated plastics has no open source.
    let oiled = stage("", ", material: POM", "", &DRY.replace("dry", "oil"), "");
    assert_eq!(code(&oiled, "meshes.stage.model.mean_friction"), error("E0207"));
    let known = stage("", ", material: POM", "", &DRY.replace("dry", "oil, mu: 0.05"), "");
    assert!(findings(&known).is_empty());
    // Neither is it a law of two metal gears, whatever the coefficient.
    let steels = stage("", "", "", &DRY.replace("dry", "dry, mu: 0.1"), "");
    assert_eq!(code(&steels, "meshes.stage.model.mean_friction"), error("E0207"));
    // Heat goes into flanks of unknown conductivity.
    let cold = "materials: { own: { kind: plastic, elastic_modulus: 3 GPa, poisson: 0.35 } }\n";
    let heated =
        "{ type: path_integral, tooth_friction: { type: ehl_mixed, tau0: 5 MPa, limiting_slope: 0.055, mu_b: 0.13 } }";
    let cold = stage("", ", material: own", "", heated, cold);
    assert_eq!(code(&cold, "meshes.stage.model.tooth_friction"), error("E0207"));
}

/// What the page of the example says.
#[test]
fn the_example_is_built_without_findings_besides_those_of_its_page() {
    let language = language();
    let gearbox = Gearbox::read(&language, &file("examples/plastic-actuator/gearbox.yaml")).unwrap();
    let t = gearbox.transmission(&language, &Choice::default()).unwrap();
    let fast = t.stages().next().unwrap();
    // 2/(0.91/206 + 0.8775/2.2) GPa.
    assert_close(
        fast.reduced_modulus_gpa.unwrap(),
        2.0 / (0.91 / 206.0 + 0.8775 / 2.2),
        1e-12,
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Random materials, as hard as ceramics or as soft as rubber, conducting or not: results are numbers, and losses are positive.
    #[test]
    fn results_over_random_materials_are_numbers(
        first in (0.1_f64..1000.0, 0.0_f64..0.49, 0.05_f64..500.0, 500.0_f64..25000.0, 50.0_f64..5000.0),
        second in (0.1_f64..1000.0, 0.0_f64..0.49, 0.05_f64..500.0, 500.0_f64..25000.0, 50.0_f64..5000.0),
        torque in 0.1_f64..50.0,
        rpm in 1.0_f64..5000.0,
        law in 0_usize..3,
    ) {
        let material = |(e, nu, k, rho, c): (f64, f64, f64, f64, f64)| format!(
            "{{ kind: plastic, elastic_modulus: {e} GPa, poisson: {nu}, conductivity: {k} W/(m K), density: {rho} kg/m3, heat_capacity: {c} J/(kg K) }}"
        );
        let part = format!("{{ {PAIR}, materials: [{}, {}] }}", material(first), material(second));
        let at = format!("{{ torque: {torque} Nm, speed: {rpm} rpm }}");
        let friction = [
            "{ type: xu }",
            "{ type: ehl_mixed, tau0: 5 MPa, limiting_slope: 0.055, mu_b: 0.13 }",
            "{ type: constant, value: 0.2 }",
        ][law];
        let model = format!("{{ type: path_integral, load_sharing: {{ type: slices, slices: 4, phases: 20, stiffness: iso6336 }}, tooth_friction: {friction} }}");
        let found = eval("gear_mesh/path_integral", &format!("{{ model: {model}, part: {part}, at: {at} }}"));
        prop_assert!(found.total.is_finite() && found.total >= 0.0, "{} {part} {at}", found.total);
        for (rating, keys) in [
            ("flash_temperature", "mean_friction: { type: constant, value: 0.2 }"),
            ("plastic_temperature", "mean_friction: { type: constant, value: 0.2 }"),
            ("flank_contact", ""),
        ] {
            let found = rate(rating, &format!("{{ part: {part}, at: {at}, rating: {{ {keys} }} }}"));
            for figure in found.rated.figures() {
                prop_assert!(figure.value.is_finite(), "{rating} {} {part} {at}", figure.figure.symbol);
            }
        }
    }
}
