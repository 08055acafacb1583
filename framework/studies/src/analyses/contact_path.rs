//! Sliding and entrainment velocity, load share, Hertzian pressure, friction, film thickness and loss along the path of contact of one
//! mesh; with a load sharing in thin slices also its transmission error and the line load over the plane of action.

use std::sync::Arc;

use gearloss_framework::attach::dangling;
use gearloss_framework::contact::path::Path;
use gearloss_framework::contact::sharing::slices::Slices;
use gearloss_framework::contact::sharing::{CalculatedSharing, Flank, Sharing, SharingEntry, slices_of};
use gearloss_framework::contact::{Film, film};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::Point;
use gearloss_framework::flow::Tolerance;
use gearloss_framework::geometry::{Line, LoadSharing, Pair, ShareTable};
use gearloss_framework::loss::Notes;
use gearloss_framework::mechanism::Answers as _;
use gearloss_framework::mechanism::gear_mesh::{GearMeshAt, MeshPart};
use gearloss_framework::mechanism::mean_friction::{MeanFriction, MeanFrictionAt, hertz};
use gearloss_framework::mechanism::tooth_friction::{PathAt, ToothFriction};
use gearloss_framework::registry::{Build, ModelRef, Slot};
use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{Analysis, Built, Chosen, Engine, Head, Outcome, Planner, Run, Runs, Stopped};
use crate::numbers::{RPM, tidy};
use crate::points::{Given, Note};
use crate::register_analysis;
use crate::study::Uses;
use crate::table::Table;

/// Velocities, load, pressure, friction, film thickness and loss along the path of contact of one mesh.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ContactPathEntry {
    /// Gearbox, gear and model sets.
    #[serde(flatten)]
    pub chosen: Chosen,
    /// Mesh, one of `meshes` or `bevel_meshes`.
    #[schemars(extend("x-refers-to" = ["meshes", "bevel_meshes"]))]
    pub mesh: String,
    /// Torque. [Nm]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub torque: f64,
    /// Speed. [rpm]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub speed: f64,
    /// Number of points along the path. [-]
    #[serde(default = "places")]
    #[schemars(range(min = 3, max = 2001))]
    pub places: u32,
}

fn places() -> u32 {
    101
}

register_analysis!(ContactPathEntry);

/// The path of contact of one mesh under each model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ContactPathOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// One for each model set.
    pub paths: Vec<ContactPath>,
}

/// The path of contact under one model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ContactPath {
    /// Name of the set.
    pub model_set: String,
    /// Mesh.
    pub mesh: String,
    /// Gear state.
    pub gear: String,
    /// Given torque. [Nm]
    pub torque_nm: f64,
    /// Given speed. [rpm]
    pub speed_rpm: f64,
    /// Oil temperature. [degC]
    pub oil_temperature_degc: f64,
    /// Load sharing of the tooth pairs in contact.
    #[schemars(with = "serde_json::Value")]
    pub load_sharing: SharingEntry,
    /// Torque of the mesh at its first gear. [Nm]
    pub mesh_torque_nm: f64,
    /// Sliding velocity along the teeth, the same on the whole path and part of the sliding velocity of each point; hypoid gears only. [m/s]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lengthwise_sliding_m_s: Option<f64>,
    /// Why there is no friction; absent if there is.
    pub no_friction: Option<String>,
    /// Points along the path, starting at the first contact.
    pub places: Vec<PlaceOnPath>,
    /// Stiffness, transmission error and load over the plane of action; with `load_sharing: { type: slices }` only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh_load: Option<MeshUnderLoad>,
}

impl ContactPath {
    fn plane(&self) -> impl Iterator<Item = &PlaceOnPlane> {
        self.mesh_load.iter().flat_map(|load| &load.plane)
    }

    fn file(&self) -> impl Iterator<Item = &ShareOfFile> {
        self.mesh_load.iter().flat_map(|load| &load.file)
    }

    fn phases(&self) -> impl Iterator<Item = &PhaseOfMesh> {
        self.mesh_load.iter().flat_map(|load| &load.phases)
    }
}

/// A mesh in thin slices under its load, over one base pitch.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MeshUnderLoad {
    /// Mean stiffness of the mesh per face width; 1 GPa is 1 N/(mm um). [GPa]
    pub stiffness_gpa: f64,
    /// Mean transmission error along the line of action, with the misalignment. [um]
    pub mean_transmission_error_um: f64,
    /// Greatest less least transmission error. [um]
    pub transmission_error_range_um: f64,
    /// Greatest line load. [N/mm]
    pub greatest_line_load_n_mm: f64,
    /// Mean over time of the line load along the face: the greatest over the mean. [-]
    pub face_load_factor: f64,
    /// Misalignment of the flanks over the face width at this load: as stated, and by the deflection of the shafts. [um]
    pub misalignment_um: f64,
    /// Distance of the resultant force from the middle of the face, over half of the face width, positive towards its end. [-]
    pub shift_of_resultant: f64,
    /// True if the loads on shafts and bearings have the shift at the rating, because of `shaft_deflection`; else they neglect it.
    pub shift_is_in_shaft_loads: bool,
    /// Least share of the flanks on the path that touch. [-]
    pub least_touching: f64,
    /// Local tooth loss factor. [-]
    pub loss_factor: f64,
    /// Transmission error over one base pitch, from the first contact of a pair; over two with a pitch error, from that of one that does not
    /// lag.
    pub phases: Vec<PhaseOfMesh>,
    /// Load over the plane of action; with a pitch error the mean of both pairs.
    pub plane: Vec<PlaceOnPlane>,
    /// The shares as rows of a file for `load_sharing: { type: file }`, at half, the whole and twice the torque.
    #[serde(skip)]
    pub file: Vec<ShareOfFile>,
}

/// A row of a file of shares.
#[derive(Debug, Clone, Copy)]
pub struct ShareOfFile {
    /// Torque of the first gear. [Nm]
    pub torque: f64,
    /// Place from the first to the last contact if the first gear drives. [-]
    pub path: f64,
    /// Place on the face. [-]
    pub face: f64,
    /// Line load over that of one pair alone. [-]
    pub share: f64,
}

/// Places along the path in a file of shares, without those beside jumps.
const FILE: usize = 161;

/// The rows of a file of shares.
fn file_rows(pair: &Pair, slices: &Slices, line_load: f64) -> Vec<ShareOfFile> {
    let [start, .., end] = pair.points;
    let places = slices.places_with_jumps(FILE);
    let mut rows = Vec::new();
    for load in [0.5, 1.0, 2.0].map(|part| part * line_load) {
        for (x, lines) in slices.plane(load, &places) {
            // A file has at least two places on the face.
            let faces: Vec<(f64, f64)> = match &lines[..] {
                [only] => vec![(0.0, *only), (1.0, *only)],
                lines => {
                    let count = lines.len() as f64;
                    let face = |(j, line): (usize, &f64)| ((j as f64 + 0.5) / count, *line);
                    lines.iter().enumerate().map(face).collect()
                }
            };
            rows.extend(faces.into_iter().map(|(face, line)| ShareOfFile {
                torque: load * pair.base_radius[0] * pair.facewidth,
                path: (x - start) / (end - start),
                face,
                share: line / load,
            }));
        }
    }
    rows
}

/// The mesh at one phase.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct PhaseOfMesh {
    /// Travel along the line of action since the first contact of a pair, over the base pitch. [-]
    pub base_pitches: f64,
    /// Transmission error. [um]
    pub transmission_error_um: f64,
}

/// One place on the plane of action.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct PlaceOnPlane {
    /// Distance from the pitch point, towards the tip of the first gear. [mm]
    pub plane_from_pitch_point_mm: f64,
    /// Distance from the start of the face. [mm]
    pub face_mm: f64,
    /// Line load. [N/mm]
    pub line_load_n_mm: f64,
    /// Hertzian pressure. [GPa]
    pub plane_pressure_gpa: f64,
}

/// Places along the path in the plane of action.
const PLANE: usize = 40;

/// One point on the path of contact.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct PlaceOnPath {
    /// Distance from the pitch point, towards the tip of the first gear. [mm]
    pub from_pitch_point_mm: f64,
    /// Share of the normal force on one pair. [-]
    pub load_share: f64,
    /// Sliding velocity. [m/s]
    pub sliding_speed_m_s: f64,
    /// Entrainment sum velocity: sum of the surface velocities. [m/s]
    pub sum_speed_m_s: f64,
    /// Radius of relative curvature. [mm]
    pub radius_mm: f64,
    /// Hertzian pressure. [GPa]
    pub hertz_pressure_gpa: f64,
    /// Minimum film thickness, isothermal, Dowson and Higginson. [um]
    pub film_um: f64,
    /// Coefficient of friction, if the model has one. [-]
    pub mu: Option<f64>,
    /// Sliding power loss of one pair there. [W]
    pub sliding_loss_w: Option<f64>,
}

/// The law of friction within the model of a mesh.
enum Friction {
    Local(Slot<ToothFriction>),
    Mean(Slot<MeanFriction>),
    /// The mesh model does not expose one.
    Hidden,
}

impl Friction {
    /// The law in a slot of the mesh model.
    fn new(build: &mut Build<'_>, path: &str, part: &Arc<MeshPart>, model: &Value) -> Result<Self, Diagnostic> {
        if let Some(value) = model.get("tooth_friction") {
            let slot = ModelRef::<ToothFriction>::new(value.clone());
            let built = build.slot_beside(&format!("{path}.tooth_friction"), part, &slot.value);
            return built.map(Self::Local);
        }
        if let Some(value) = model.get("mean_friction") {
            let built = build.slot_at(&format!("{path}.mean_friction"), part, value);
            return built.map(Self::Mean);
        }
        Ok(Self::Hidden)
    }

    /// The coefficients at the points, or why there are none.
    fn coefficients(&self, along: &PathAt<'_>, mean: &MeanFrictionAt<'_>, places: usize) -> Result<Vec<f64>, String> {
        match self {
            Self::Hidden => Err("its model has no friction along the path".to_owned()),
            Self::Local(slot) => {
                let mut mu = vec![0.0; places];
                match f64::along(&**slot, along, &mut mu) {
                    Ok(_) => Ok(mu),
                    Err(undefined) => Err(undefined.to_string()),
                }
            }
            Self::Mean(slot) => match slot.mu(mean) {
                Ok(mu) => Ok(vec![mu; places]),
                Err(undefined) => Err(undefined.to_string()),
            },
        }
    }
}

/// The point with each set, and the index of its mesh.
type ContactPathPlan<'a> = (Runs<'a>, Vec<usize>);

impl Analysis for ContactPathEntry {
    const TYPE: &'static str = "contact_path";
    type Plan<'a> = ContactPathPlan<'a>;
    type Outcome = ContactPathOutcome;

    fn uses(&self) -> Uses<'_> {
        self.chosen.uses()
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<ContactPathPlan<'a>, Stopped> {
        let built = self.chosen.built(cx)?;
        let meshes = built.iter().map(|b| self.mesh(cx, &b.transmission));
        let meshes = meshes.collect::<Result<_, _>>()?;
        let runs = Runs::of_sets(&built, |b| {
            let t = &b.transmission;
            let point = vec![Given::new(self.torque, self.speed)];
            Run::without_limits(cx, b, cx.listed(t, self.chosen.gear(t), point))
        })?;
        Ok((runs, meshes))
    }

    fn reduce<'a>(
        &'a self,
        (runs, meshes): ContactPathPlan<'a>,
        engine: &Engine<'a>,
    ) -> Result<ContactPathOutcome, Stopped> {
        let paths = runs
            .0
            .iter()
            .zip(meshes)
            .map(|(run, mesh)| self.path(engine, run, mesh));
        Ok(ContactPathOutcome {
            paths: paths.collect::<Result<_, _>>()?,
            head: engine.head(&runs.built()),
        })
    }
}

impl ContactPathEntry {
    /// The path under one set.
    fn path(&self, cx: &Planner<'_>, run: &Run<'_>, index: usize) -> Result<ContactPath, Stopped> {
        let (built, given) = (&run.built, &run.points);
        let t = &built.transmission;
        let case = cx.case(built.gearbox, t, given)?;
        let torques = [self.torque];
        let point = Point {
            speeds: &[self.speed],
            torques: &torques[..case.torque_ports.len()],
            flow: given.flow,
            tolerance: Tolerance::default(),
            inclination: 0.0,
        };
        let mut scratch = t.scratch(&case);
        let warm = given.oil.find(t, &case, &point, &mut scratch);
        let solution = t.evaluate(&case, &point, warm.temperatures(), &mut scratch);
        if !solution.has_flow() {
            let message = format!(
                "{} at this point, so the torque of the mesh is unknown",
                solution.status().name()
            );
            let help = "give the torque at another port, or with the other sign";
            return Err(cx.wrong(&cx.path(), message, help));
        }
        let (Some(path), Some(at)) = (t.mesh_paths().nth(index), solution.flanks_at(index)) else {
            return Err(self.not_found(cx, t));
        };
        let section = path.split('.').next().unwrap_or_default();
        let model = &built.resolved.value[section][&self.mesh]["model"];
        let load_sharing = sharing(model);
        let mesh_load = mesh_load(&at, &load_sharing);
        let (places, no_friction) = self.places(cx, built, (path, &at), (model, &load_sharing))?;
        let lengthwise = at.part.pair.lengthwise_sliding() * at.speed.abs();
        Ok(ContactPath {
            model_set: built.name.clone(),
            mesh: self.mesh.clone(),
            gear: given.gear.clone(),
            torque_nm: self.torque,
            speed_rpm: tidy(self.speed * RPM),
            oil_temperature_degc: warm.oil,
            load_sharing,
            mesh_torque_nm: solution.mesh_torque(index),
            // Rounding of velocities that cancel.
            lengthwise_sliding_m_s: Some(lengthwise).filter(|speed| *speed > 1e-9),
            no_friction,
            places,
            mesh_load,
        })
    }

    /// Index of the mesh; an unknown mesh or a mesh without path of contact is an error.
    fn mesh(&self, cx: &Planner<'_>, t: &Transmission) -> Result<usize, Stopped> {
        let mesh_path = format!("meshes.{}", self.mesh);
        let path = format!("{}.mesh", cx.path());
        let Some((index, _, part)) = t.cylindrical_meshes().find(|(_, path, _)| *path == mesh_path) else {
            let bevel_path = format!("bevel_{mesh_path}");
            let bevel = t.mesh_paths().position(|path| path == bevel_path);
            return bevel.ok_or_else(|| self.not_found(cx, t));
        };
        if !part.pair.involute {
            return Err(cx.wrong(
                &path,
                format!(
                    "`{}` has no path of contact, because its teeth are not defined as an involute pair",
                    self.mesh
                ),
                "state the tip diameter of the ring, or check the notes of `gearloss check` on the mesh",
            ));
        }
        Ok(index)
    }

    /// The error that there is no such mesh.
    fn not_found(&self, cx: &Planner<'_>, t: &Transmission) -> Stopped {
        let of_section = |path| {
            ["meshes.", "bevel_meshes."]
                .into_iter()
                .find_map(|section| str::strip_prefix(path, section))
        };
        let names: Vec<&str> = t.mesh_paths().filter_map(of_section).collect();
        cx.found(vec![dangling(
            &format!("{}.mesh", cx.path()),
            "mesh",
            &self.mesh,
            &names,
        )])
    }

    /// The points on the path of a mesh at one operating point, and the reason if there is no friction.
    fn places(
        &self,
        cx: &Planner<'_>,
        built: &Built<'_>,
        (path, at): (&str, &GearMeshAt<'_>),
        (model, sharing): (&Value, &SharingEntry),
    ) -> Result<(Vec<PlaceOnPath>, Option<String>), Stopped> {
        let part = Arc::new(at.part.clone());
        let mut build = Build::new(cx.language.registry(), &built.gearbox.files);
        let friction = Friction::new(&mut build, &format!("{path}.model"), &part, model);
        let friction = friction.map_err(|error| cx.found(vec![error]))?;
        let mean = MeanFrictionAt::at_pitch_point(at, Notes::MUTED);
        let places = self.places as usize;
        let line_load = part.pair.line_load(mean.normal_force);
        let flank = Flank::of(at.first_drives > 0.5, at.speed);
        let sharings = build.load_sharings(&part, sharing);
        let (drive, coast) = sharings.map_err(|error| cx.found(vec![error]))?;
        let fine = match coast.filter(|_| flank == Flank::Coast).unwrap_or(drive) {
            Sharing::Fixed(sharing) => Path::even(&part.pair, sharing, places),
            Sharing::Loaded(shares) => {
                let table = under_load(&part, sharing, line_load).unwrap_or_else(|| {
                    let rows = part.pair.even_path(LoadSharing::Rigid, places);
                    ShareTable::new(rows.iter().map(|p| shares.row(p.x, line_load)).collect())
                });
                Path::even_of_table(&part.pair, &table, Line::Peak, places)
            }
        };
        let along = fine
            .at_operating_point(&mean, Notes::MUTED)
            .with(|to| to.bodies = at.bodies().unwrap_or(None));
        let loaded = at.speed != 0.0 && at.torque != 0.0;
        let mu = if loaded {
            friction.coefficients(&along, &mean, fine.len())
        } else {
            Err("the mesh is unloaded or stationary".to_owned())
        };
        let pitch = part.pair.points[2];
        let nodes = fine.nodes().iter().zip(fine.points()).enumerate();
        let places = nodes.map(|(i, (node, p))| {
            let contact = along.contact(node);
            let mu = mu.as_ref().ok().map(|mu| mu[i]);
            PlaceOnPath {
                from_pitch_point_mm: (p.x - pitch) * 1e3,
                load_share: p.share,
                sliding_speed_m_s: contact.sliding,
                sum_speed_m_s: contact.sum_speed,
                radius_mm: contact.radius * 1e3,
                hertz_pressure_gpa: contact.pressure * 1e-9,
                film_um: film(&contact, Film::DowsonHigginson, false) * 1e6,
                mu,
                sliding_loss_w: mu.map(|mu| mu * p.share * mean.normal_force * contact.sliding),
            }
        });
        Ok((places.collect(), mu.as_ref().err().cloned()))
    }
}

/// The shares of thin slices under a line load in N/m; `None` for another sharing, or without load.
fn under_load(part: &MeshPart, sharing: &SharingEntry, line_load: f64) -> Option<ShareTable> {
    let SharingEntry::Calculated(CalculatedSharing::Slices(entry)) = sharing else {
        return None;
    };
    let (_, slices) = slices_of(part, entry).ok().filter(|_| line_load > 0.0)?;
    Some(slices.mesh(line_load).1)
}

/// The results of thin slices; `None` for another sharing, or without load.
fn mesh_load(at: &GearMeshAt<'_>, sharing: &SharingEntry) -> Option<MeshUnderLoad> {
    let SharingEntry::Calculated(CalculatedSharing::Slices(entry)) = sharing else {
        return None;
    };
    let (part, pair) = (at.part, &at.part.pair);
    let line_load = pair.line_load(pair.normal_force(at.torque));
    let (_, slices) = slices_of(part, entry).ok().filter(|_| line_load > 0.0)?;
    let (mesh, _) = slices.mesh(line_load);
    let (number, period) = (mesh.delta.len() as f64, slices.period() as f64);
    let phase = |(i, delta): (usize, &f64)| PhaseOfMesh {
        base_pitches: (i as f64 + 0.5) / number * period,
        transmission_error_um: delta * 1e6,
    };
    let plane = slices
        .plane(line_load, &slices.even_places(PLANE))
        .into_iter()
        .flat_map(|(x, lines)| {
            let count = lines.len() as f64;
            let place = move |(j, load): (usize, f64)| PlaceOnPlane {
                plane_from_pitch_point_mm: (x - pair.points[2]) * 1e3,
                face_mm: (j as f64 + 0.5) * pair.facewidth / count * 1e3,
                line_load_n_mm: load * 1e-3,
                plane_pressure_gpa: hertz(load, part.modulus, pair.relative_radius(x)) * 1e-9,
            };
            lines.into_iter().enumerate().map(place)
        });
    Some(MeshUnderLoad {
        stiffness_gpa: mesh.stiffness * 1e-9,
        mean_transmission_error_um: mesh.mean() * 1e6,
        transmission_error_range_um: mesh.peak_to_peak() * 1e6,
        greatest_line_load_n_mm: mesh.greatest * 1e-3,
        face_load_factor: mesh.face_factor,
        misalignment_um: part.misalignment_under(line_load) * 1e6,
        shift_of_resultant: mesh.shift,
        shift_is_in_shaft_loads: part.yielding != 0.0,
        least_touching: mesh.least_touching,
        loss_factor: mesh.loss_factor,
        phases: mesh.delta.iter().enumerate().map(phase).collect(),
        plane: plane.collect(),
        file: file_rows(pair, &slices, line_load),
    })
}

/// Load sharing of a mesh model: its own, that of its law of mean friction, or the assumption of its loss factor.
fn sharing(model: &Value) -> SharingEntry {
    let written = SharingEntry::of_model(model).map(|(_, sharing)| sharing);
    let uniform = model["type"] == "even_share" || model["loss_factor"] == "uniform";
    written.unwrap_or(SharingEntry::Fixed(if uniform {
        LoadSharing::Uniform
    } else {
        LoadSharing::Rigid
    }))
}

impl Outcome for ContactPathOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let table = Table::of_each(&self.head.analysis, &self.paths, |path| &path.places)
            .text("model_set", "Model set", |(path, _)| &path.model_set)
            .text("mesh", "Mesh", |(path, _)| &path.mesh)
            .fields("from_pitch_point_mm load_share sliding_speed_m_s sum_speed_m_s radius_mm hertz_pressure_gpa film_um mu sliding_loss_w", |(_, at)| at);
        let plane = Table::of_each(format!("{}-plane", self.head.analysis), &self.paths, ContactPath::plane)
            .text("model_set", "Model set", |(path, _)| &path.model_set)
            .text("mesh", "Mesh", |(path, _)| &path.mesh)
            .fields(
                "plane_from_pitch_point_mm face_mm line_load_n_mm plane_pressure_gpa",
                |(_, at)| at,
            );
        let phases = Table::of_each(
            format!("{}-phases", self.head.analysis),
            &self.paths,
            ContactPath::phases,
        )
        .text("model_set", "Model set", |(path, _)| &path.model_set)
        .text("mesh", "Mesh", |(path, _)| &path.mesh)
        .fields("base_pitches transmission_error_um", |(_, at)| at);
        let mut tables = vec![table.finish()];
        if self.paths.iter().any(|path| path.mesh_load.is_some()) {
            tables.extend([plane.finish(), phases.finish()]);
        }
        for path in self.paths.iter().filter(|path| path.mesh_load.is_some()) {
            let name = format!("{}-shares-{}", self.head.analysis, path.model_set);
            let shares = Table::of_each(name, std::slice::from_ref(path), ContactPath::file);
            // The headings are those that a file of shares has.
            let shares = shares
                .number("torque [Nm]", "Nm", "Torque of the first gear", |(_, row)| row.torque)
                .number(
                    "path [-]",
                    "-",
                    "Place from the first to the last contact if the first gear drives",
                    |(_, row)| row.path,
                )
                .number("face [-]", "-", "Place on the face", |(_, row)| row.face)
                .number("share [-]", "-", "Line load over that of one pair alone", |(_, row)| {
                    row.share
                });
            tables.push(shares.finish());
        }
        tables
    }

    fn notes(&self) -> Vec<&Note> {
        Vec::new()
    }
}
