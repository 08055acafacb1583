//! Quadrature error along the path: every law under every load sharing over broad random geometries, loads, speeds and oils.
#![allow(clippy::unwrap_used)]

use gearloss_framework::contact::path::{FrictionPath, Path};
use gearloss_framework::contact::{self, Film, Films};
use gearloss_framework::geometry::{LoadSharing, Pair, PairSpec};
use gearloss_framework::loss::{NoteBase, Notebook, Notes};
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, MeshPart};
use gearloss_framework::mechanism::mean_friction::MeanFrictionAt;
use gearloss_framework::mechanism::tooth_friction::{SMOOTH, ToothFriction};
use gearloss_framework::mechanism::{Answers as _, Inputs as _, Mechanism as _};
use gearloss_framework::real::{LANES, Lane, Real as _};
use gearloss_framework::registry::{Build, Files, Registry};
use gearloss_numerics::sampling::Sobol;
use serde_json::{Value, json};
use std::sync::Arc;

/// Stated error, of the loss, and of the mean coefficient of friction where the loss nearly vanishes.
const LOSS: f64 = 1e-4;
const FRICTION: f64 = 1e-6;

const SHARINGS: [LoadSharing; 6] = [
    LoadSharing::Rigid,
    LoadSharing::Ramp,
    LoadSharing::SymmetricRamp,
    LoadSharing::Third,
    LoadSharing::Uniform,
    LoadSharing::ContactLines,
];

/// A log-uniformly distributed quantity.
fn spread(t: f64, low: f64, high: f64) -> f64 {
    low * (high / low).powf(t)
}

/// A mesh at an operating point, from fifteen numbers between zero and one; `None` if its gears are impossible.
struct Case {
    part: Arc<MeshPart>,
    t: Vec<f64>,
}

impl Case {
    fn new(t: Vec<f64>) -> Option<Self> {
        let internal = t[0] < 0.25;
        let z1 = spread(t[1], 9.0, 80.0).round();
        let z2 = (z1 * spread(t[2], if internal { 1.5 } else { 1.0 }, 7.0)).round();
        let module = spread(t[3], 0.5e-3, 10e-3);
        let helix = (35.0 * (t[5] - 0.4) / 0.6).max(0.0).to_radians();
        let (x1, spare, addendum) = (1.2 * t[6] - 0.4, 1.2 * t[7] - 0.6, 0.8 + 0.5 * t[9]);
        let x2 = if internal { x1 + 0.3 * spare } else { spare };
        let diameters = [z1, z2].map(|z| z * module / helix.cos());
        let pair = Pair::new(&PairSpec {
            z: [z1 as u32, z2 as u32],
            internal,
            normal_module: module,
            pressure_angle: (14.5 + 13.5 * t[4]).to_radians(),
            helix_angle: helix,
            centre_distance: None,
            profile_shift: [Some(x1), Some(x2)],
            tip_diameter: [
                Some(diameters[0] + 2.0 * module * (addendum + x1)),
                Some(if internal {
                    diameters[1] - 2.0 * module * (0.9 * addendum - x2)
                } else {
                    diameters[1] + 2.0 * module * (addendum + x2)
                }),
            ],
            root_diameter: [None, None],
            facewidth: module * (3.0 + 27.0 * t[8]),
            tip_shortening: true,
        })
        .ok()?;
        let ra = spread(t[10], 0.1e-6, 0.8e-6);
        Some(Self {
            part: Arc::new(MeshPart::new(pair, [ra; 2], [1.25 * ra; 2], 206e9, 0.3)),
            t,
        })
    }

    /// The first cases of an infinite sequence.
    fn list(number: usize) -> impl Iterator<Item = Self> {
        let sobol = Sobol::new(15).unwrap();
        (1..).filter_map(move |i| Self::new(sobol.point(i))).take(number)
    }

    fn context(&self) -> GearMeshAt<'_> {
        let (pair, t) = (&self.part.pair, &self.t);
        let eta = spread(t[12], 2e-3, 0.5);
        GearMeshAt::usual(&self.part, Notes::MUTED).with(|to| {
            to.torque = spread(t[13], 1e6, 150e6) * pair.normal_module * pair.facewidth * pair.base_radius[0];
            to.speed = spread(t[11], 0.1, 60.0) / pair.working_radius[0];
            (to.eta, to.nu) = (eta, eta / 850.0);
            to.alpha = 10e-9 + 15e-9 * t[14];
        })
    }
}

fn laws() -> Vec<Value> {
    let doleschel = |mu: f64, pressure: f64, speed: f64, viscosity: f64, reference: f64| {
        json!({ "type": "doleschel", "mu": mu, "pressure": pressure, "speed": speed, "viscosity": viscosity,
            "reference_speed": reference })
    };
    let boundary = doleschel(0.085, 0.1, -0.05, 0.0, 0.2);
    let fluid = doleschel(0.02, 0.5, -0.1, -0.05, 8.3);
    let mut laws = vec![
        json!({ "type": "none" }),
        json!({ "type": "constant", "value": 0.05 }),
        json!({ "type": "formula", "formula": "min(0.08, 0.02 + 0.01 / (0.1 + sliding))" }),
        json!({ "type": "formula", "formula": "0.03 + 0.09 * exp(-sliding / 0.3)" }),
        json!({ "type": "formula", "formula": "0.05 * (pressure / (sum_speed + 0.1))^0.3 * tanh(sliding)" }),
        json!({ "type": "xu" }),
        json!({ "type": "iso_tc60" }),
        json!({ "type": "benedict_kelley" }),
        json!({ "type": "misharin" }),
        json!({ "type": "misharin", "held": false }),
        json!({ "type": "odonoghue_cameron" }),
        json!({ "type": "drozdov_gavrikov" }),
        json!({ "type": "eyring" }),
        json!({ "type": "eyring", "thermal": false }),
        json!({ "type": "eyring", "limiting_slope": 0.03 }),
        json!({ "type": "iso_tc60", "greatest": 0.06 }),
        json!({ "type": "benedict_kelley", "greatest": 0.05 }),
        json!({ "type": "odonoghue_cameron", "greatest": 0.15 }),
        json!({ "type": "mean", "mean_friction": { "type": "schlenk" } }),
        json!({ "type": "ehl_mixed", "tau0": 5e6, "limiting_slope": 0.055, "mu_b": 0.13 }),
        boundary.clone(),
        fluid.clone(),
        json!({ "type": "doleschel", "mu": 0.05, "pressure": 1.5, "speed": -0.3, "greatest": 0.03 }),
    ];
    for weight in ["doleschel", "matsumoto", "diab", "olver_spikes"] {
        laws.push(json!({ "type": "mixed", "weight": weight, "boundary": boundary, "fluid": fluid }));
    }
    laws
}

/// The errors of a law over some cases, in units of the stated error, with the case numbers; sorted, the maximum last.
fn errors(registry: &Registry, law: &Value, sharing: LoadSharing, cases: &[Case]) -> Vec<(f64, usize)> {
    let files = Files::default();
    let mut errors = vec![(0.0, 0)];
    for (i, case) in cases.iter().enumerate() {
        let mut build = Build::new(registry, &files);
        let slot = build.slot_beside::<ToothFriction, _>("law", &case.part, law).unwrap();
        let at = case.context();
        let mean = MeanFrictionAt::at_pitch_point(&at, Notes::MUTED);
        let sum = |path: &Path| {
            let mut mu = vec![0.0; path.len()];
            f64::along(&*slot, &path.at_operating_point(&mean, Notes::MUTED), &mut mu).map(|_| path.sliding(&mu))
        };
        let pair = &case.part.pair;
        let path = FrictionPath::new(pair, sharing, &*slot).unwrap();
        let fine = 4 * slot.cut_off_order().unwrap_or(0).max(slot.order());
        // Undefined at some point, for any number of nodes.
        let Ok(exact) = sum(&Path::from_points(pair, pair.graded_path(sharing, fine))) else {
            continue;
        };
        let friction = path
            .friction(&*slot, &path.few().at_operating_point(&mean, Notes::MUTED))
            .unwrap();
        let stated = LOSS * exact + FRICTION * path.few().sliding(&vec![1.0; path.few().len()]);
        errors.push(((friction.sliding - exact).abs() / stated, i));
    }
    assert!(errors.len() > cases.len() / 2, "{law} is undefined nearly everywhere");
    errors.sort_by(|a, b| a.0.total_cmp(&b.0));
    errors
}

#[test]
fn every_law_is_as_close_to_its_limit_as_stated() {
    let registry = Registry::linked().unwrap();
    let cases: Vec<Case> = Case::list(48).collect();
    let mut wrong = Vec::new();
    for law in laws() {
        for sharing in SHARINGS {
            let errors = errors(&registry, &law, sharing, &cases);
            let (error, i) = errors[errors.len() - 1];
            // The one law that is too expensive for many nodes states its error for nine of ten points, and fifty times that for the others.
            let (usual, least) = (
                errors[errors.len() * 9 / 10].0,
                if law["type"] == "ehl_mixed" { 50.0 } else { 1.0 },
            );
            if usual > 1.0 || error > least {
                wrong.push(format!(
                    "{usual:.1} and {error:.1} times what is stated, case {i}: {sharing:?} {law}"
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn several_points_together_have_the_bits_of_each_alone() {
    let registry = Registry::linked().unwrap();
    let files = Files::default();
    let case = Case::list(1).next().unwrap();
    let usual = case.context();
    let points: [GearMeshAt<'_>; LANES] = std::array::from_fn(|i| {
        let factor = 0.3 + 0.1 * i as f64;
        usual.with(|to| {
            to.torque *= factor;
            to.speed /= factor;
            (to.nu, to.eta) = (to.nu * factor, to.eta * factor);
        })
    });
    let all = GearMeshAt::together(&case.part, Notebook::CLOSED.notes(NoteBase::default()), |i| points[i]);
    let mean = MeanFrictionAt::at_pitch_point(&all, all.notes);
    let mut laws_with_both = 0;
    for law in laws() {
        let mut build = Build::new(&registry, &files);
        let slot = build.slot_beside::<ToothFriction, _>("law", &case.part, &law).unwrap();
        let whole = FrictionPath::new(&case.part.pair, LoadSharing::Ramp, &*slot).unwrap();
        let path = whole.few();
        let mut together = vec![Lane::ZERO; path.len()];
        let at_path = path.at_operating_point(&mean, mean.notes);
        slot.uncut_along_together(&at_path, &mut together).unwrap();
        let friction = whole.friction(&*slot, &at_path).unwrap();
        let mut cut_off = 0;
        for (i, at) in points.iter().enumerate() {
            let mean = MeanFrictionAt::at_pitch_point(at, Notes::MUTED);
            let mut mu = vec![0.0; path.len()];
            let at_path = path.at_operating_point(&mean, Notes::MUTED);
            slot.uncut_along(&at_path, &mut mu).unwrap();
            let alone = whole.friction(&*slot, &at_path).unwrap();
            assert_eq!(
                alone.sliding.to_bits(),
                friction.sliding[i].to_bits(),
                "{law} at point {i}"
            );
            let same = mu
                .iter()
                .zip(&together)
                .all(|(mu, all)| mu.to_bits() == all[i].to_bits());
            assert!(same, "{law} at point {i}");
            let reaches = |mu: &f64| slot.friction_limits().is_some_and(|limits| limits.cut_off(*mu) != *mu);
            cut_off += usize::from(mu.iter().any(reaches) && !mu.iter().all(reaches));
        }
        laws_with_both += usize::from((1..LANES).contains(&cut_off));
    }
    assert!(
        laws_with_both > 1,
        "laws that are cut off along the path at some points only: {laws_with_both}"
    );
}

/// Laws compute once what does not change along a path, and products of powers from sums of logarithms.
#[test]
fn friction_along_a_path_is_that_of_its_contacts() {
    let registry = Registry::linked().unwrap();
    let files = Files::default();
    let mut compared = 0;
    for law in laws() {
        // A mean of the path, and a law whose points heat the bodies together.
        if law["type"] == "mean" || law["type"] == "ehl_mixed" {
            continue;
        }
        for case in Case::list(10) {
            let mut build = Build::new(&registry, &files);
            let slot = build.slot_beside::<ToothFriction, _>("law", &case.part, &law).unwrap();
            let path = Path::new(&case.part.pair, LoadSharing::Ramp, SMOOTH).unwrap();
            let usual = case.context();
            let mean = MeanFrictionAt::at_pitch_point(&usual, Notes::MUTED);
            let at = path.at_operating_point(&mean, Notes::MUTED);
            let mut mu = vec![0.0; path.len()];
            if f64::along(&*slot, &at, &mut mu).is_err() {
                continue;
            }
            for (node, along) in path.nodes().iter().zip(mu) {
                let alone = slot.mu(&at.contact(node)).unwrap();
                // Exponents times logarithms of up to 30, rounded.
                assert!((along - alone).abs() <= 1e-12 * alone, "{law}: {along} {alone}");
                compared += 1;
            }
        }
    }
    assert!(compared > 1000, "{compared}");
}

#[test]
fn films_along_a_path_are_those_of_its_contacts() {
    for case in Case::list(10) {
        let path = Path::new(&case.part.pair, LoadSharing::Ramp, SMOOTH).unwrap();
        let usual = case.context();
        let mean = MeanFrictionAt::at_pitch_point(&usual, Notes::MUTED);
        let at = path.at_operating_point(&mean, Notes::MUTED);
        for film in [Film::DowsonHigginson, Film::HamrockDowson] {
            for thermal in [false, true] {
                let films = Films::new(&at, film, thermal);
                for node in path.nodes() {
                    let (along, alone) = (films.at(node), contact::film(&at.contact(node), film, thermal));
                    // Rounding of a product of powers, in two orders.
                    assert!(
                        (along / alone - 1.0).abs() < 1e-12,
                        "{film:?} {thermal}: {along} {alone}"
                    );
                }
            }
        }
        let still = path.at_operating_point(&mean, Notes::MUTED).with(|to| to.speed = 0.0);
        let none = Films::new(&still, Film::HamrockDowson, true);
        assert!(path.nodes().iter().all(|node| none.at(node) == 0.0));
    }
}

/// With three nodes on each section the errors reach a thousandth.
#[test]
fn few_points_are_not_enough() {
    let case = Case::list(48).map(|case| {
        let pair = case.part.pair;
        let of = |order: usize| Path::from_points(&pair, pair.path(LoadSharing::Rigid, order));
        // Friction similar to Xu near the pitch point, without its exponential decay: a power of sliding over a power of the radius.
        let sum = |path: &Path| {
            let mu: Vec<f64> = path
                .nodes()
                .iter()
                .map(|n| n.slide_roll.powf(1.036) * n.radius.powf(-0.39))
                .collect();
            path.sliding(&mu)
        };
        let graded = Path::new(&pair, LoadSharing::Rigid, SMOOTH).unwrap();
        let exact = sum(&Path::new(&pair, LoadSharing::Rigid, 8 * SMOOTH).unwrap());
        [sum(&of(3)), sum(&graded)].map(|sum| (sum / exact - 1.0).abs())
    });
    let worst = case.fold([0.0_f64; 2], |worst, now| [worst[0].max(now[0]), worst[1].max(now[1])]);
    assert!(worst[0] > 5.0 * LOSS && worst[1] < LOSS, "{worst:?}");
}

#[test]
fn every_linked_law_is_asked() {
    let registry = Registry::linked().unwrap();
    let asked: Vec<String> = laws()
        .iter()
        .map(|law| law["type"].as_str().unwrap().to_owned())
        .collect();
    for model in registry.models(ToothFriction::KEY) {
        // A table has kinks at its nodes, a formula with `min` has one.
        assert!(
            model.name == "table" || asked.iter().any(|name| name == model.name),
            "{}",
            model.name
        );
    }
}

/// Rolling friction uses the nodes of the friction law; many nodes give its limit.
#[test]
fn rolling_is_as_close_to_its_limit_as_stated() {
    let registry = Registry::linked().unwrap();
    let files = Files::default();
    for (rolling, stated) in [("goksem_hargreaves", LOSS), ("crook", 2e-3)] {
        for case in Case::list(48) {
            for sharing in ["rigid", "ramp", "symmetric_ramp", "third", "uniform", "contact_lines"] {
                let watts = |friction: Value| {
                    let model = json!({ "type": "path_integral", "load_sharing": sharing, "tooth_friction": friction,
                        "rolling_friction": rolling });
                    let mut build = Build::new(&registry, &files);
                    let slot = build.slot_at::<GearMesh>("model", &case.part, &model).unwrap();
                    slot.loss(&case.context()).unwrap().sum()
                };
                let few = watts(json!({ "type": "constant", "value": 0.0 }));
                let many = watts(json!({ "type": "formula", "formula": "max(0, 0)" }));
                assert!((few / many - 1.0).abs() < stated, "{rolling} {sharing}: {few} {many}");
            }
        }
    }
}

#[test]
fn a_flank_that_begins_beside_its_base_circle_has_short_pieces_there() {
    let gaps: Vec<(f64, usize)> = Case::list(400)
        .map(|case| {
            let pair = &case.part.pair;
            (
                pair.points[0] / pair.base_pitch,
                pair.graded_path(LoadSharing::Rigid, 2).len() / 2,
            )
        })
        .collect();
    let usual = gaps.iter().filter(|(start, _)| *start > 0.3).map(|(_, pieces)| *pieces);
    let close = gaps
        .iter()
        .filter(|(start, _)| *start < 0.03)
        .map(|(_, pieces)| *pieces);
    let (usual, close) = (usual.min().unwrap(), close.min().unwrap());
    assert!(close > usual, "{usual} {close}");
}

/// The loss factor of any load sharing has its own quadrature, without powers of friction.
#[test]
fn local_loss_factors_are_as_close_to_their_limit() {
    for case in Case::list(200) {
        let pair = &case.part.pair;
        for sharing in SHARINGS {
            let path = Path::new(pair, sharing, 40).unwrap();
            let exact = path.sliding(&vec![1.0; path.len()]) / (pair.base_helix.cos() * pair.base_radius[0]);
            let error = (pair.loss_factor_local(sharing) / exact - 1.0).abs();
            assert!(error < 1e-5, "{sharing:?}: {error}");
        }
    }
}
