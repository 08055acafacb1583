//! `fit traction` and `fit stribeck`: the rheology of an oil from curves.

use crate::common::{
    self,
    program::{gearloss, out},
};
use std::path::PathBuf;

use gearloss_framework::description::LubricantEntry;
use gearloss_framework::description::lubricant::{DensityEntry, DensityLaw, ViscosityEntry};
use gearloss_framework::lubricant::Lubricant;
use gearloss_framework::lubricant::roelands::{ETA_INF, Roelands};
use gearloss_plugins::tooth_friction::ehl_mixed::identification::stress;
use gearloss_plugins::tooth_friction::ehl_mixed::mixed::{boundary_share, friction};

const TRACTION: &str = "examples/electric-drive-unit/traction.csv";
const STRIBECK: &str = "examples/electric-drive-unit/stribeck.csv";
const OIL: &str = "{ viscosity: { kv40: 27.3 mm2/s, kv100: 5.9 mm2/s }, \
density: { value: 839 kg/m3, at: 20 degC, expansion: 7.7473e-4 1/K } }";

/// What a file is refused with.
fn refused(args: &[&str]) -> String {
    let output = gearloss(args);
    assert_eq!(output.status.code(), Some(2), "{args:?}");
    String::from_utf8(output.stderr).unwrap()
}

fn written(name: &str, text: &str) -> PathBuf {
    let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("rheology-{name}"));
    std::fs::write(&file, text).unwrap();
    file
}

/// The numbers of the first line that begins with some words, behind them.
fn numbers(text: &str, words: &str) -> Vec<f64> {
    let line = text.lines().find(|line| line.trim_start().starts_with(words));
    let line = line.unwrap_or_else(|| panic!("no `{words}` in\n{text}"));
    let rest = line.trim_start().strip_prefix(words).unwrap();
    rest.split_whitespace()
        .filter_map(|word| word.trim_end_matches(',').parse().ok())
        .collect()
}

fn close(value: f64, printed: f64) {
    assert!((value / printed - 1.0).abs() < 1e-6, "{value} against {printed}");
}

/// The viscosity of the check cases: 0.022 Pa s at 40 degC, S0 1.2.
fn check_law() -> Roelands {
    Roelands {
        ln_ratio: (0.022 / ETA_INF).ln(),
        reference: 40.0,
        s0: 1.2,
        z: 0.62,
    }
}

/// That viscosity as an oil of 1000 kg/m3 at every temperature.
fn check_oil() -> String {
    let kv100 = check_law().eta(0.0, 100.0) * 1e3;
    format!("{{ viscosity: {{ kv40: 22, kv100: {kv100} }}, density: {{ value: 1000, expansion: 0 }} }}")
}

fn check_curves() -> String {
    let mut text = "pressure [GPa],temperature [degC],shear_rate [1/s],stress [MPa]\n".to_owned();
    for pressure in [0.8, 1.0, 1.2] {
        for rate in [2e5, 5e5, 1e6, 2e6] {
            let stress = stress(&check_law(), 5.2e6, pressure * 1e9, 60.0, rate) * 1e-6;
            text.push_str(&format!("{pressure},60,{rate},{stress}\n"));
        }
    }
    text
}

#[test]
fn u3l_u3m_u3n_three_steps_through_the_command() {
    let curves = check_curves();
    let column = |row: usize| {
        curves
            .lines()
            .nth(row)
            .unwrap()
            .rsplit(',')
            .next()
            .unwrap()
            .parse::<f64>()
            .unwrap()
    };
    close(column(1), 9.744835);
    close(column(12), 38.64934);
    let file = written("check.csv", &curves);
    let said = out(&["fit", "traction", file.to_str().unwrap(), "--oil", &check_oil()]);
    for (set, slope) in [("0.800", 5.147599), ("1.000", 5.198162), ("1.200", 5.199923)] {
        let row = numbers(&said, set);
        assert_eq!(row[1..5], [4.0, 0.0, 0.0, 4.0], "{said}");
        close(row[5], slope);
    }
    let second = numbers(&said, "2: z with the mean slope");
    close(second[1], 0.6204725);
    let third = numbers(&said, "3: both by least squares");
    close(third[0], 5.2);
    close(third[1], 0.62);
    assert!(
        said.contains("rheology: { tau0: 5.2 MPa, z: 0.62, limiting_slope: 0.0322 }"),
        "{said}"
    );
    // The least pressure begins at less than twice the Eyring stress.
    assert!(
        said.contains("note: at 0.800 GPa, 60.0 degC the stress starts at 1.9 times the slope"),
        "{said}"
    );
    assert!(said.contains("the curve still increases there"), "{said}");
}

#[test]
fn traction_coefficients_and_films_say_the_same_as_stresses_and_shear_rates() {
    let stated = written("stated.csv", &check_curves());
    let mut text = "pressure [MPa],temperature [degC],sliding [m/s],film [nm],mu,run\n".to_owned();
    for row in check_curves().lines().skip(1) {
        let x: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        text.push_str(&format!(
            "{},{},{},80,{},7\n",
            x[0] * 1e3,
            x[1],
            x[2] * 80e-9,
            x[3] / (x[0] * 1e3)
        ));
    }
    let derived = written("derived.csv", &text);
    let run = |file: &PathBuf| out(&["fit", "traction", file.to_str().unwrap(), "--oil", &check_oil()]);
    let said = run(&derived);
    assert!(said.contains("note: not used: run"), "{said}");
    assert_eq!(run(&stated).lines().last(), said.lines().last());
}

#[test]
fn an_oil_of_a_gearbox() {
    let gearbox = "examples/two-speed-ev/gearbox.yaml";
    let said = out(&["fit", "traction", TRACTION, "--gearbox", gearbox]);
    assert!(said.contains("rheology: { tau0: "), "{said}");
    let wrong = refused(&["fit", "traction", TRACTION, "--gearbox", gearbox, "--lubricant", "none"]);
    assert!(
        wrong.contains("no lubricant `none`") && wrong.contains("help: write --lubricant with one of"),
        "{wrong}"
    );
    let oil = refused(&[
        "fit",
        "traction",
        TRACTION,
        "--oil",
        "{ viscosity: { kv40: 5, kv100: 9 } }",
    ]);
    assert!(oil.contains("not below kv40"), "{oil}");
    assert!(refused(&["fit", "traction", TRACTION]).contains("--gearbox"));
}

/// Random numbers of mean zero and variance one: twelve of an even distribution, less six.
struct Normal(u64);

impl Normal {
    fn next(&mut self) -> f64 {
        let mut sum = -6.0;
        for _ in 0..12 {
            self.0 = (1_103_515_245 * self.0 + 12_345) % 2_147_483_648;
            sum += self.0 as f64 / 2_147_483_648.0;
        }
        sum
    }
}

const NOISE: &str = "\
# Noise: times 1 + 0.01 g; g is the sum of twelve u less 6, u = x / 2^31, x <- (1103515245 x + 12345) mod 2^31, x = 1 at first.
";

fn traction() -> String {
    let oil = Lubricant::new(&LubricantEntry {
        viscosity: Some(ViscosityEntry {
            kv40: Some(27.3e-6),
            kv100: Some(5.9e-6),
            ..ViscosityEntry::default()
        }),
        density: Some(DensityEntry {
            at: 20.0,
            value: Some(839.0),
            law: DensityLaw::Linear,
            expansion: Some(7.7473e-4),
        }),
        ..LubricantEntry::default()
    });
    let law = oil.unwrap().roelands(Some(0.60));
    let mut noise = Normal(1);
    let mut text = format!(
        "\
# Synthetic, not measured: traction curves of an oil with KV40 27.3 mm2/s, KV100 5.9 mm2/s and 839 kg/m3 at 20 degC.
# Made with Eyring's law, tau0 = 5 MPa, and Roelands' law, z = 0.60, rolling at 3 m/s, film of 180, 110, 70 and 48 nm at 40, 60, 80, 100 degC.
# At 1.2 GPa and 50 % of sliding friction is lowered by a fifth, as heat in the film does.
{NOISE}pressure [GPa],temperature [degC],slide_roll [%],sliding [m/s],film [nm],mu
"
    );
    for pressure in [0.8, 1.0, 1.2] {
        for (temperature, film) in [(40.0, 180.0), (60.0, 110.0), (80.0, 70.0), (100.0, 48.0)] {
            for slide_roll in [0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 50.0] {
                let sliding = 0.03 * slide_roll;
                let rate = sliding / (film * 1e-9);
                let heat = if pressure == 1.2 && slide_roll == 50.0 {
                    0.8
                } else {
                    1.0
                };
                let mu = stress(&law, 5e6, pressure * 1e9, temperature, rate) / (pressure * 1e9) * heat;
                let mu = mu * (1.0 + 0.01 * noise.next());
                text.push_str(&format!(
                    "{pressure},{temperature},{slide_roll},{sliding:.3},{film},{mu:.6}\n"
                ));
            }
        }
    }
    text
}

fn stribeck() -> String {
    let mut noise = Normal(1);
    let mut text = format!(
        "\
# Synthetic, not measured: a Stribeck curve with mu_b = 0.13 and the exponent 2; film friction falls from 0.045 to 0.034.
{NOISE}lambda,mu_film,mu
"
    );
    for i in 0..12 {
        let (lambda, film) = (0.05 * 1.5_f64.powi(i), 0.045 - 0.001 * f64::from(i));
        let mu = friction(film, 0.13, boundary_share(lambda, 2.0)) * (1.0 + 0.01 * noise.next());
        text.push_str(&format!("{lambda:.4},{film:.3},{mu:.5}\n"));
    }
    text
}

#[test]
fn example_curves_are_made_as_they_say() {
    for (path, text) in [(TRACTION, traction()), (STRIBECK, stribeck())] {
        let file = common::file(path);
        if std::env::var_os("UPDATE").is_some() {
            std::fs::create_dir_all(file.parent().unwrap()).unwrap();
            std::fs::write(&file, &text).unwrap();
        }
        assert!(
            std::fs::read_to_string(&file).unwrap() == text,
            "{path}: run with UPDATE=1"
        );
    }
}

#[test]
fn example_curves_give_back_their_oil() {
    let said = out(&["fit", "traction", TRACTION, "--oil", OIL]);
    for (name, hidden) in [("tau0", 5.0), ("z", 0.60)] {
        let row = numbers(&said, &format!("{name} "));
        assert!(row[2] < hidden && hidden < row[3], "{said}");
        assert!(row[1] < 0.02 * hidden, "{said}");
    }
    // The point below 1 % of sliding is out of every curve, the heated one out of those at 1.2 GPa.
    assert!(said.contains("116 of 132 points on 12 curves"), "{said}");
    let said = out(&["fit", "stribeck", STRIBECK]);
    let row = numbers(&said, "mu_b ");
    assert!(row[2] < 0.13 && 0.13 < row[3], "{said}");
}

#[test]
fn a_stribeck_curve_without_noise_gives_back_its_coefficient() {
    for exponent in [2.0, 1.5] {
        let (mut plain, mut films) = (
            "lambda,mu_film,mu\n".to_owned(),
            "film [nm],mu_film [%],mu\n".to_owned(),
        );
        for lambda in [0.1, 0.3, 1.0, 3.0] {
            let mu = friction(0.03, 0.12, boundary_share(lambda, exponent));
            plain.push_str(&format!("{lambda},0.03,{mu}\n"));
            films.push_str(&format!("{},3,{mu}\n", lambda * 280.0));
        }
        let (plain, films) = (written("plain.csv", &plain), written("films.csv", &films));
        let exponent = exponent.to_string();
        let more = ["--exponent", &exponent];
        let plain = out(&[&["fit", "stribeck", plain.to_str().unwrap()][..], &more].concat());
        let films = out(&[
            &["fit", "stribeck", films.to_str().unwrap(), "--rq", "0.28 um"][..],
            &more,
        ]
        .concat());
        for said in [plain, films] {
            assert!(said.contains("rheology: { mu_b: 0.12 }"), "{said}");
        }
    }
}

#[test]
fn faulty_files_are_refused_with_line_and_help() {
    let head = "pressure [GPa],temperature [degC],shear_rate [1/s],stress [MPa]\n";
    let row = "1,60,1e5,12\n1,60,1e6,24\n";
    for (name, text, said) in [
        (
            "no_column.csv",
            format!("presure [GPa],temperature [degC],shear_rate [1/s],stress [MPa]\n{row}"),
            "line 1: no column `pressure`",
        ),
        (
            "no_rate.csv",
            "pressure [GPa],temperature [degC],stress [MPa]\n1,60,12\n".to_owned(),
            "line 1: neither `shear_rate [1/s]` nor `sliding [m/s]` and `film [nm]`",
        ),
        (
            "no_film.csv",
            "pressure [GPa],temperature [degC],sliding [m/s],mu\n1,60,0.1,0.03\n".to_owned(),
            "line 1: no column `film`",
        ),
        (
            "no_stress.csv",
            "pressure [GPa],temperature [degC],shear_rate [1/s]\n1,60,1e5\n".to_owned(),
            "line 1: neither `stress [MPa]` nor `mu`",
        ),
        (
            "both.csv",
            "pressure [GPa],temperature [degC],shear_rate [1/s],stress [MPa],mu\n1,60,1e5,12,0.012\n".to_owned(),
            "line 1: both `stress [MPa]` and `mu`",
        ),
        (
            "unit.csv",
            format!("# rig 3\n{}{row}", head.replace("GPa", "torr")),
            "line 2: `pressure` is in `torr`, which is not a unit of this quantity",
        ),
        (
            "dimension.csv",
            format!("{}{row}", head.replace("1/s", "rpm")),
            "line 1: `shear_rate` is in `rpm`",
        ),
        (
            "no_unit.csv",
            format!("{}{row}", head.replace(" [MPa]", "")),
            "line 1: `stress` has no unit",
        ),
        (
            "text.csv",
            format!("{head}{row}1,60,2e6,n/a\n"),
            "line 4: column 4 `stress`: `n/a` is not a number",
        ),
        (
            "zero.csv",
            format!("{head}{row}0,60,2e6,30\n"),
            "line 4: column 1 `pressure`: 0 is not positive",
        ),
        (
            "hot.csv",
            format!("{head}{row}1,333,2e6,30\n"),
            "line 4: 333 degC is not a valid oil temperature",
        ),
        (
            "cells.csv",
            format!("{head}1,60,1e5\n"),
            "line 2: 3 cells, but the header has 4",
        ),
        ("empty.csv", head.to_owned(), "no row of numbers"),
        (
            "single.csv",
            format!("{head}1,60,1e5,12\n"),
            "no curve with increasing stress over two shear rates",
        ),
        (
            "two.csv",
            format!("{head}{row}"),
            "2 points for 2 parameters do not allow an estimate of the accuracy",
        ),
    ] {
        let file = written(name, &text);
        let fault = refused(&["fit", "traction", file.to_str().unwrap(), "--oil", OIL]);
        assert!(
            fault.contains(name) && fault.contains(said) && fault.contains("= help: "),
            "{name}: {fault}"
        );
    }
    assert!(refused(&["fit", "traction", "nowhere.csv", "--oil", OIL]).contains("cannot read nowhere.csv"));
    for (name, text, more, said) in [
        (
            "no_lambda.csv",
            "mu,mu_film\n0.1,0.03\n",
            &[][..],
            "line 1: neither `lambda` nor `film [nm]`",
        ),
        (
            "no_rq.csv",
            "film [nm],mu,mu_film\n80,0.1,0.03\n",
            &[],
            "line 1: `film` without a roughness",
        ),
        (
            "two_films.csv",
            "film [nm],lambda,mu,mu_film\n80,1,0.1,0.03\n",
            &[],
            "line 1: both `lambda` and `film`",
        ),
        (
            "beside.csv",
            "lambda,mu,mu_film\n1,0.1,0.03\n",
            &["--rq", "0.3 um"],
            "line 1: both `lambda` and --rq",
        ),
        (
            "rough.csv",
            "film [nm],mu,mu_film\n80,0.1,0.03\n",
            &["--rq", "0 um"],
            "is not positive",
        ),
        ("without.csv", "lambda,mu\n1,0.1\n", &[], "line 1: no column `mu_film`"),
        (
            "minus.csv",
            "lambda,mu,mu_film\n1,-0.1,0.03\n",
            &[],
            "line 2: column 2 `mu`: -0.1 is not positive",
        ),
        (
            "power.csv",
            "lambda,mu,mu_film\n1,0.1,0.03\n",
            &["--exponent", "40"],
            "--exponent 40 is not between",
        ),
    ] {
        let file = written(name, text);
        let fault = refused(&[&["fit", "stribeck", file.to_str().unwrap()][..], more].concat());
        assert!(fault.contains(said) && fault.contains("= help: "), "{name}: {fault}");
    }
}
