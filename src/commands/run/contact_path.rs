//! Sliding and rolling speed, load share, Hertz pressure, friction, film and loss along the path of contact of one mesh.

use std::sync::Arc;

use gearloss_framework::evaluate::Point;
use gearloss_framework::flow::Tolerance;
use gearloss_framework::geometry::LoadSharing;
use gearloss_framework::loss::Notes;
use gearloss_framework::mechanism::gear_mesh::MeshPart;
use gearloss_framework::mechanism::mean_friction::{MeanFriction, MeanFrictionAt};
use gearloss_framework::mechanism::tooth_friction::ToothFriction;
use gearloss_framework::registry::{Build, ModelRef, Slot};
use gearloss_framework::contact::{self, Film};
use gearloss_framework::contact::path::Path;
use gearloss_report::Figure;
use gearloss_report::plot::{Line, Stroke};
use gearloss_studies::study::ContactPathEntry;
use serde_json::{Value, json};

use super::super::solve::RPM;
use super::map::{spread, tidy};
use super::write::{cell, head, picture, write};
use super::{Built, Runner};
use crate::output::{Failure, Out, Table, number};

/// One place on the path.
struct Place {
    /// Distance from the pitch point, towards the tip of the first gear. \[mm\]
    from_pitch: f64,
    /// Share of the normal force on one pair.
    share: f64,
    /// \[m/s\]
    sliding: f64,
    /// \[m/s\]
    sum_speed: f64,
    /// \[mm\]
    radius: f64,
    /// \[GPa\]
    pressure: f64,
    /// Least film, isothermal, Dowson and Higginson. \[um\]
    film: f64,
    /// Coefficient of friction, where the model has one.
    mu: Option<f64>,
    /// Power lost in sliding of one pair there. \[W\]
    loss: Option<f64>,
}

/// The path of contact under one set.
struct Paths {
    places: Vec<Place>,
    /// Torque of the mesh on its first gear. \[Nm\]
    torque: f64,
    sharing: LoadSharing,
    /// Why there is no friction; empty where there is.
    silent: String,
    gear: String,
    /// \[degC\]
    temperature: f64,
}

/// The law of friction within the model of a mesh.
enum Friction {
    Local(Slot<ToothFriction>),
    Mean(Slot<MeanFriction>),
    /// The model of the mesh shows none.
    Hidden,
}

impl Friction {
    /// The law that the model of a mesh holds in a slot.
    fn of(build: &mut Build<'_>, path: &str, part: &Arc<MeshPart>, model: &Value) -> Result<Self, Failure> {
        let failed = |d: gearloss_framework::document::Diagnostic| Failure::Input(format!("{d}\n"));
        if let Some(value) = model.get("tooth_friction") {
            let slot = ModelRef::<ToothFriction>::new(value.clone());
            let built = build.slot_beside(&format!("{path}.tooth_friction"), part, &slot.value);
            return built.map(Self::Local).map_err(failed);
        }
        if let Some(value) = model.get("mean_friction") {
            let built = build.slot_at(&format!("{path}.mean_friction"), part, value);
            return built.map(Self::Mean).map_err(failed);
        }
        Ok(Self::Hidden)
    }
}

pub fn run(runner: &Runner<'_>, name: &str, entry: &ContactPathEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let built = runner.built(gearbox, &entry.model_sets)?;
    let header = [
        "model_set",
        "mesh",
        "from_pitch_point_mm",
        "load_share",
        "sliding_speed_m_s",
        "sum_speed_m_s",
        "radius_mm",
        "hertz_pressure_gpa",
        "film_um",
        "mu",
        "sliding_loss_w",
    ]
    .map(str::to_owned);
    let (mut rows, mut results) = (Vec::new(), Vec::new());
    for b in &built {
        let found = places(runner, &path, entry, b)?;
        if runner.only_checks {
            continue;
        }
        for p in &found.places {
            let mut row = vec![b.name.clone(), entry.mesh.clone()];
            row.extend(
                [
                    p.from_pitch,
                    p.share,
                    p.sliding,
                    p.sum_speed,
                    p.radius,
                    p.pressure,
                    p.film,
                ]
                .map(|x| cell(Some(x))),
            );
            row.extend([cell(p.mu), cell(p.loss)]);
            rows.push(row);
        }
        show(name, entry, b, &found, out)?;
        figures(runner, name, entry, b, &found)?;
        results.push(json!({
            "model_set": b.name,
            "mesh": entry.mesh,
            "gear": found.gear,
            "torque_nm": entry.torque,
            "speed_rpm": tidy(entry.speed * RPM),
            "oil_temperature_degc": found.temperature,
            "load_sharing": found.sharing,
            "mesh_torque_nm": found.torque,
            "no_friction": Some(&found.silent).filter(|why| !why.is_empty()),
            "places": found.places.iter().map(|p| json!({
                "from_pitch_point_mm": p.from_pitch, "load_share": p.share, "sliding_speed_m_s": p.sliding,
                "sum_speed_m_s": p.sum_speed, "radius_mm": p.radius, "hertz_pressure_gpa": p.pressure,
                "film_um": p.film, "mu": p.mu, "sliding_loss_w": p.loss,
            })).collect::<Vec<_>>(),
        }));
    }
    if runner.only_checks {
        return Ok(());
    }
    let mut value = head(runner, &built.iter().collect::<Vec<_>>());
    value["paths"] = Value::Array(results);
    write(runner, name, &entry.write, &header, &rows, &value)?;
    Ok(())
}

/// How the model of a mesh shares its load: its own word, that of its law of mean friction, or what its loss factor assumes.
fn sharing(model: &Value) -> LoadSharing {
    let written = [&model["load_sharing"], &model["mean_friction"]["load_sharing"]]
        .into_iter()
        .find_map(|value| serde_json::from_value(value.clone()).ok());
    let uniform = model["type"] == "even_share" || model["loss_factor"] == "uniform";
    written.unwrap_or(if uniform {
        LoadSharing::Uniform
    } else {
        LoadSharing::Rigid
    })
}

/// The path under one set.
fn places(runner: &Runner<'_>, path: &str, entry: &ContactPathEntry, built: &Built<'_>) -> Result<Paths, Failure> {
    let t = &built.transmission;
    let own = format!("meshes.{}", entry.mesh);
    let Some(index) = t.meshes().position(|(path, _)| path == own) else {
        let names: Vec<&str> = t.meshes().map(|(path, _)| path.trim_start_matches("meshes.")).collect();
        let error = gearloss_framework::attach::dangling(&format!("{path}.mesh"), "mesh", &entry.mesh, &names);
        return Err(runner.study.findings(vec![error]).into());
    };
    if t.meshes().nth(index).is_some_and(|(_, part)| !part.pair.involute) {
        return Err(runner.wrong(
            &format!("{path}.mesh"),
            format!(
                "`{}` has no path of contact: its teeth are not known as an involute pair",
                entry.mesh
            ),
            "state the tip diameter of the ring, or check what `gearloss check` says of the mesh",
        ));
    }
    let first = t.states().first().map_or("", |s| s.name.as_str());
    let given = runner.points(t, entry.gear.as_deref().unwrap_or(first), Vec::new(), Vec::new());
    let case = runner.case(built.gearbox, t, &given)?;
    let torques = [entry.torque];
    let point = Point {
        speeds: &[entry.speed],
        torques: &torques[..case.torque_ports.len()],
        flow: given.flow,
        tolerance: Tolerance::default(),
    };
    let mut scratch = t.scratch(&case);
    let warm = given.oil.find(t, &case, &point, &mut scratch);
    let solution = t.evaluate(&case, &point, warm.temperatures(), &mut scratch);
    if !solution.has_flow() {
        let message = format!(
            "{} at this point, so no torque of the mesh is known",
            solution.status().name()
        );
        return Err(runner.wrong(path, message, "give the torque at another port, or with the other sign"));
    }
    let at = solution.mesh_at(index);
    let part = Arc::new(at.part.clone());
    let model = &built.resolved.value["meshes"][&entry.mesh]["model"];
    let sharing = sharing(model);
    let mut build = Build::new(runner.language.registry(), &built.gearbox.files);
    let friction = Friction::of(&mut build, &format!("{own}.model"), &part, model)?;
    let mean = MeanFrictionAt::of(&at, Notes::MUTED);
    let fine = Path::even(&part.pair, sharing, entry.places as usize);
    let along = fine.at(&mean, Notes::MUTED).with(|to| to.bodies = at.bodies());
    let loaded = at.speed != 0.0 && at.torque != 0.0;
    let (mu, silent): (Option<Vec<f64>>, String) = match &friction {
        _ if !loaded => (None, "the mesh is idle or rests".to_owned()),
        Friction::Hidden => (None, "its model shows no friction along the path".to_owned()),
        Friction::Local(slot) => {
            let mut mu = vec![0.0; fine.len()];
            match slot.along(&along, &mut mu) {
                Ok(_) => (Some(mu), String::new()),
                Err(undefined) => (None, undefined.to_string()),
            }
        }
        Friction::Mean(slot) => match slot.mu(&mean) {
            Ok(mu) => (Some(vec![mu; fine.len()]), String::new()),
            Err(undefined) => (None, undefined.to_string()),
        },
    };
    let pitch = part.pair.points[2];
    let places = fine
        .nodes()
        .iter()
        .zip(fine.points())
        .enumerate()
        .map(|(i, (node, p))| {
            let contact = along.contact(node);
            let mu = mu.as_ref().map(|mu| mu[i]);
            Place {
                from_pitch: (p.x - pitch) * 1e3,
                share: p.share,
                sliding: contact.sliding,
                sum_speed: contact.sum_speed,
                radius: contact.radius * 1e3,
                pressure: contact.pressure * 1e-9,
                film: contact::film(&contact, Film::DowsonHigginson, false) * 1e6,
                mu,
                loss: mu.map(|mu| mu * p.share * mean.normal_force * contact.sliding),
            }
        })
        .collect();
    Ok(Paths {
        places,
        torque: solution.mesh_torque(index),
        sharing,
        silent,
        gear: given.gear.clone(),
        temperature: warm.oil,
    })
}

/// One picture for each quantity along the path.
fn figures(
    runner: &Runner<'_>,
    name: &str,
    entry: &ContactPathEntry,
    built: &Built<'_>,
    found: &Paths,
) -> Result<(), Failure> {
    type Along = (&'static str, &'static str, fn(&Place) -> Option<f64>);
    let quantities: [Along; 5] = [
        ("share", "share of the load", |p| Some(p.share)),
        ("pressure", "Hertz pressure in GPa", |p| Some(p.pressure)),
        ("sliding", "sliding speed in m/s", |p| Some(p.sliding)),
        ("friction", "coefficient of friction", |p| p.mu),
        ("loss", "sliding loss in W", |p| p.loss),
    ];
    for (short, y, quantity) in quantities {
        if found.places.iter().all(|p| quantity(p).is_none()) {
            continue;
        }
        let line = Line {
            name: built.name.clone(),
            points: found
                .places
                .iter()
                .map(|p| Some((p.from_pitch, quantity(p)?)))
                .collect(),
            stroke: Stroke::Line,
        };
        let figure = Figure::Lines {
            title: format!("{name}: {y} along the path of contact of {}", entry.mesh),
            x: "distance from the pitch point in mm".to_owned(),
            y: y.to_owned(),
            lines: vec![line],
        };
        let file = format!("{name}-{}-{short}", built.name);
        picture(runner, &file, figure, &entry.write)?;
    }
    Ok(())
}

fn show(name: &str, entry: &ContactPathEntry, built: &Built<'_>, found: &Paths, out: &mut Out) -> Result<(), Failure> {
    out.line(format!(
        "{name}: path of contact of {}, {:.3} Nm on its first gear, load sharing {}, models {}",
        entry.mesh,
        found.torque,
        json!(found.sharing).as_str().unwrap_or_default(),
        built.name
    ))?;
    let mut table = Table::new(&[
        "mm from pitch",
        "share",
        "sliding m/s",
        "sum m/s",
        "p_H GPa",
        "film um",
        "mu",
        "loss W",
    ]);
    for i in spread(found.places.len()) {
        let p = &found.places[i];
        table.row(vec![
            format!("{:.3}", p.from_pitch),
            format!("{:.3}", p.share),
            format!("{:.3}", p.sliding),
            format!("{:.3}", p.sum_speed),
            format!("{:.3}", p.pressure),
            format!("{:.3}", p.film),
            number(p.mu, 4),
            number(p.loss, 2),
        ]);
    }
    out.text(&table.render())?;
    if !found.silent.is_empty() {
        out.line(format!("no friction of {}: {}", entry.mesh, found.silent))?;
    }
    out.line("")?;
    Ok(())
}
