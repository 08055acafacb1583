//! Oils under limits: the thinnest one saves losses, and costs life and film.

use gearloss::api::{InMemory, Language, StudyRun, analyses::fluid_sweep::FluidSweepOutcome, read_study};
use gearloss::report::page::Page;

use crate::common::file;

/// The sweep of oils of the two-speed gearbox with limits, and its page.
fn swept(limits: &str) -> (FluidSweepOutcome, Page) {
    let language = Language::linked().unwrap();
    let gearbox = std::fs::read_to_string(file("examples/two-speed-ev/gearbox.yaml")).unwrap();
    let study = format!(
        "
gearloss: study/1
gearboxes: {{ ev: gearbox.yaml }}
conditions: {{ oil_temperature: 80 degC }}
cycles: {{ loads: {{ spectrum: [{{ torque: 12 Nm, speed: 6000 rpm, share: 0.6 }}, {{ torque: 3 Nm, speed: 12000 rpm, share: 0.4 }}] }} }}
analyses:
  oils:
    type: fluid_sweep
    gear: first
    model_sets: [joint]
    cycles: [loads]
    vi: 150
    kv100: [3 mm2/s, 5 mm2/s, 8 mm2/s, 12 mm2/s]
    refine: false
    limits: {limits}
"
    );
    let files = InMemory::new([("study.yaml", study), ("gearbox.yaml", gearbox)]).shared();
    let study = read_study(&language, &files, "study.yaml")
        .map_err(|e| e.render())
        .unwrap();
    let outcome = StudyRun::new(&language, &study).analysis("oils").unwrap();
    let page = Page::from_outcome(&*outcome);
    (outcome.get::<FluidSweepOutcome>().unwrap().clone(), page)
}

#[test]
fn the_film_grows_and_the_best_oil_within_limits_is_thicker() {
    let film = "{ film: { quantity: rating, rating: flank_contact.lambda, of: meshes.M1, least: 1e-9 } }";
    let (free, _) = swept(film);
    let duty = &free.fluid_sweep[0].cycles[0];
    let films: Vec<f64> = duty.fluids.iter().map(|fluid| fluid.limited[0].unwrap()).collect();
    assert!(films.windows(2).all(|pair| pair[0] < pair[1]), "{films:?}");
    assert!(duty.fluids.iter().all(|fluid| fluid.keeps_limits));
    assert_eq!(duty.least_within_limits.unwrap().value, 3.0);

    // Between the films of the second and the third oil.
    let least = 0.5 * (films[1] + films[2]);
    let (bound, page) = swept(&film.replace("1e-9", &least.to_string()));
    let duty = &bound.fluid_sweep[0].cycles[0];
    let kept: Vec<bool> = duty.fluids.iter().map(|fluid| fluid.keeps_limits).collect();
    assert_eq!(kept, [false, false, true, true]);
    let best = duty.least_within_limits.unwrap();
    assert_eq!((best.value, best.mean_loss_w), (8.0, duty.fluids[2].mean_loss_w));
    assert!(best.mean_loss_w > duty.least.mean_loss_w);
    let said = page.careful.join("\n");
    assert!(
        said.contains("breaks `film`; 8 mm2/s is the best that keeps all limits"),
        "{said}"
    );
    assert!(page.figures.iter().any(|figure| figure.name == "oils-joint-film"));
}

#[test]
fn an_impossible_limit_is_said() {
    let (outcome, page) = swept("{ hot: { quantity: temperature, most: 70 degC } }");
    let set = &outcome.fluid_sweep[0];
    assert_eq!(
        (set.limits[0].present, set.limits[0].present_keeps_it),
        (Some(80.0), false)
    );
    assert!(set.cycles[0].least_within_limits.is_none());
    assert!(
        page.careful
            .iter()
            .any(|sentence| sentence.contains("no oil keeps `hot`")),
        "{:?}",
        page.careful
    );
}
