//! A study with its gearboxes.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::{Map, Value};

use super::names::devices;
use super::parameters::{TakenOver, replace_names, written_at};
use super::then::{PromisedSets, promised_sets};
use super::{BEST, Data, Grid, StudyEntry, Uses};
use crate::analyses::{AnalysisEntry, AnalysisKind};
use crate::codes;
use crate::measured::{FaultPlace, Measured, MeasuredEntry, MeasuredFault};
use crate::numbers::word;
use crate::points::{Field, OilTemperature, Points, Rows};
use gearloss_framework::attach::dangling;
use gearloss_framework::description::Ordered;
use gearloss_framework::document::{self, Diagnostic, Places, Sources, read_yaml};
use gearloss_framework::files::{Disk, LONGEST_DATA, LONGEST_TEXT, SharedSource};
use gearloss_framework::gearbox::{DocumentKind, Findings, Gearbox, other_kind};
use gearloss_framework::language::Language;
use gearloss_framework::resolve::{Choice, OWN_MODELS, Resolved, called_own, expand_set, meets, sets_of};
use gearloss_framework::transmission::{Case, Transmission, WHEEL_SPEEDS, WHEELS};

/// A study as read, with its gearboxes. Copies share what is read, because each analysis has one.
#[derive(Clone)]
pub struct Study {
    /// The entry.
    pub entry: Arc<StudyEntry>,
    /// Its sets of models.
    pub sets: Arc<Map<String, Value>>,
    /// Its gearboxes by name.
    pub gearboxes: Vec<(String, Gearbox)>,
    /// Its text.
    pub text: Arc<str>,
    /// Folder of its files.
    pub folder: PathBuf,
    files: SharedSource,
    places: Arc<Places>,
    sources: Sources,
    promised: Arc<PromisedSets>,
    taken_over: Arc<TakenOver>,
    /// Results of identifications with corrections that have run, by the names of the analyses.
    corrections: Arc<BTreeMap<String, Value>>,
}

impl Study {
    /// Reads a study of the disk and its gearboxes.
    ///
    /// # Errors
    /// All errors of reading and of the walk.
    pub fn read(language: &Language, file: &Path) -> Result<Self, Findings> {
        Self::read_from(language, &Disk::shared(), file)
    }

    /// Reads a study of a source and its gearboxes. Data that they name are read from the same source.
    ///
    /// # Errors
    /// Everything that reading and the walk find.
    pub fn read_from(language: &Language, files: &SharedSource, file: &Path) -> Result<Self, Findings> {
        let text = files.read_text(file, LONGEST_TEXT).map_err(|e| {
            Diagnostic::error("", format!("cannot read {}: {e}", file.display()))
                .help("check the file name")
                .code(document::codes::UNREADABLE)
        })?;
        let folder = file.parent().unwrap_or(Path::new(""));
        Self::from_text(language, files, text, &file.display().to_string(), folder)
    }

    /// Reads a study from a text, with its gearboxes; `folder` is where the files on the disk that it names lie.
    ///
    /// # Errors
    /// All errors of reading and of the walk.
    pub fn of_text(
        language: &Language,
        text: String,
        name: &str,
        folder: impl Into<PathBuf>,
    ) -> Result<Self, Findings> {
        Self::from_text(language, &Disk::shared(), text, name, folder)
    }

    /// Reads a study from a text, with its gearboxes; the files that it names are read from a source, relative to `folder`.
    ///
    /// # Errors
    /// Everything that reading and the walk find.
    pub fn from_text(
        language: &Language,
        files: &SharedSource,
        text: String,
        name: &str,
        folder: impl Into<PathBuf>,
    ) -> Result<Self, Findings> {
        let folder = folder.into();
        let mut sources = Sources::default();
        let source = sources.add(name, text.as_str());
        let read = read_yaml(source, &text);
        if !read.findings.is_empty() {
            return Err(Findings {
                list: read.findings,
                sources,
            });
        }
        if let Some(error) = other_kind(&read.node, DocumentKind::Study, name) {
            return Err(Findings {
                list: vec![error],
                sources,
            });
        }
        let mut walked = language.walk_study(&read.node);
        if !walked.findings.is_empty() {
            return Err(Findings {
                list: walked.findings,
                sources,
            });
        }
        let taken_over = match replace_names(&mut walked.value, AnalysisKind::parameters_of) {
            Ok(taken_over) => taken_over,
            Err(list) => {
                let list = list.into_iter().map(|d| walked.places.place(d).code(codes::STUDY));
                return Err(Findings {
                    list: list.collect(),
                    sources,
                });
            }
        };
        let bug = |e: serde_json::Error| Findings::from(vec![Diagnostic::error("", e.to_string())]);
        let mut sets = walked
            .value
            .get("model_sets")
            .and_then(Value::as_object)
            .cloned()
            .unwrap_or_default();
        let entry: StudyEntry = serde_json::from_value(walked.value).map_err(bug)?;
        let mut unusable = devices(&entry);
        let promised = promised_sets(&entry, &mut sets).unwrap_or_else(|found| {
            unusable.extend(found);
            PromisedSets::default()
        });
        if !unusable.is_empty() {
            return Err(Findings {
                list: unusable
                    .into_iter()
                    .map(|d| walked.places.place(d).code(codes::STUDY))
                    .collect(),
                sources,
            });
        }
        let mut gearboxes = Vec::new();
        for (name, gearbox) in entry.gearboxes.iter() {
            let gearbox = Gearbox::read_from(language, files, &folder.join(gearbox))?;
            gearboxes.push((name.to_owned(), gearbox));
        }
        Ok(Self {
            entry: Arc::new(entry),
            sets: Arc::new(sets),
            gearboxes,
            text: text.into(),
            folder,
            files: Arc::clone(files),
            places: Arc::new(walked.places),
            sources,
            promised: Arc::new(promised),
            corrections: Arc::default(),
            taken_over: Arc::new(taken_over),
        })
    }

    /// Names of the model sets that the analyses use for a gearbox, without repetition.
    pub fn sets_used_for(&self, gearbox: &str) -> Vec<String> {
        let is_first = self.gearboxes.first().is_some_and(|(name, _)| name == gearbox);
        let mut sets: Vec<String> = Vec::new();
        for (_, analysis) in self.entry.analyses.iter() {
            let uses = analysis.uses();
            let of_analysis = uses.gearbox.map_or(is_first, |named| named == gearbox);
            for set in uses.sets {
                let is_of_gearbox = match set.split_once('/') {
                    Some((product, _)) => product == gearbox,
                    None => of_analysis,
                };
                if is_of_gearbox && !sets.contains(set) {
                    sets.push(set.clone());
                }
            }
        }
        sets
    }

    /// Findings about the study itself, with their places.
    pub fn findings(&self, list: Vec<Diagnostic>) -> Findings {
        let placed = |found: Diagnostic| {
            let path = written_at(&self.taken_over, &found.path);
            let found = match path {
                Some(path) => Diagnostic { path, ..found },
                None => found,
            };
            self.places.place(found).code(codes::STUDY)
        };
        Findings {
            list: list.into_iter().map(placed).collect(),
            sources: self.sources.clone(),
        }
    }

    /// A gearbox by name; the first if no name is given.
    ///
    /// # Errors
    /// If there is none.
    pub fn gearbox(&self, path: &str, name: Option<&String>) -> Result<&(String, Gearbox), Findings> {
        let names: Vec<&str> = self.gearboxes.iter().map(|(n, _)| n.as_str()).collect();
        match name {
            None => self.gearboxes.first().ok_or_else(|| {
                self.findings(vec![
                    Diagnostic::error("gearboxes", "no gearbox is given")
                        .help("add `gearboxes: { ours: gearbox.yaml }`"),
                ])
            }),
            Some(name) => self
                .gearboxes
                .iter()
                .find(|(n, _)| n == name)
                .ok_or_else(|| self.findings(vec![dangling(&format!("{path}.gearbox"), "gearbox", name, &names)])),
        }
    }

    /// A model set of an analysis: `SET` of the given gearbox, or `PRODUCT/SET`; `own` means the default models of the gearbox.
    ///
    /// # Errors
    /// If there is no such product.
    pub fn reference<'a, 'n>(
        &'a self,
        path: &str,
        name: &'n str,
        gearbox: &'a Gearbox,
    ) -> Result<(&'a Gearbox, Option<&'n str>), Findings> {
        let Some((product, set)) = name.split_once('/') else {
            return Ok((gearbox, Some(name).filter(|set| *set != OWN_MODELS)));
        };
        let (_, gearbox) = self.gearbox(path, Some(&product.to_owned()))?;
        Ok((gearbox, Some(set).filter(|set| *set != OWN_MODELS)))
    }

    /// The choice of a set, with the overrides of the conditions.
    pub fn choice(&self, set: Option<&str>) -> Choice {
        let conditions = &self.entry.conditions;
        let wheels = conditions
            .wheels
            .iter()
            .map(|ports| (WHEELS.to_owned(), ports.clone().into()));
        let speeds = conditions.wheel_speeds.iter();
        let speeds = speeds.map(|speeds| (WHEEL_SPEEDS.to_owned(), speeds.clone().into()));
        let changes = conditions
            .set
            .iter()
            .map(|(path, value)| (path.to_owned(), value.clone()));
        Choice {
            set: set.filter(|set| *set != OWN_MODELS).map(str::to_owned),
            sets: Map::clone(&self.sets),
            overrides: wheels.chain(speeds).chain(changes).collect(),
            follows: conditions
                .follows
                .iter()
                .map(|(path, formula)| (path.to_owned(), word(formula)))
                .collect(),
        }
    }

    /// The transmission of a gearbox with a choice. `changes` are further changed paths, each with its place in the study, where its errors
    /// are reported.
    ///
    /// # Errors
    /// All errors of resolving and building.
    pub fn built(
        &self,
        language: &Language,
        gearbox: &Gearbox,
        choice: &Choice,
        changes: &[(String, String)],
    ) -> Result<(Resolved, Transmission), Findings> {
        let build = || {
            let resolved = gearbox.resolve(language, choice)?;
            let transmission = gearbox.build(language, &resolved)?;
            Ok((resolved, transmission))
        };
        build().map_err(|findings: Findings| {
            let replaced = |finding: &Diagnostic| {
                let changed = changes.iter().find(|(path, _)| meets(path, &finding.path));
                let set = self.entry.conditions.set.ids().find(|path| meets(path, &finding.path));
                let conditions = &self.entry.conditions;
                let wheels = (finding.path == WHEELS || finding.path.starts_with("wheels."))
                    && conditions.wheels.is_some()
                    || finding.path == WHEEL_SPEEDS && conditions.wheel_speeds.is_some();
                let in_own_set = self
                    .sets
                    .keys()
                    .any(|name| finding.path.starts_with(&format!("model_sets.{name}.set.")));
                if in_own_set {
                    return Some(Diagnostic {
                        spans: Vec::new(),
                        ..finding.clone()
                    });
                }
                let follows = &self.entry.conditions.follows;
                let follower = follows.ids().find(|path| meets(path, &finding.path));
                match (changed, set) {
                    _ if follower.is_some() => {
                        let path = follower.unwrap_or_default();
                        // Resolving gives it the code of a choice.
                        let finding = Diagnostic {
                            code: Some(codes::FOLLOWS),
                            ..finding.clone()
                        };
                        Some(finding.moved("conditions.follows", path))
                    }
                    (Some((path, place)), _) => Some(finding.clone().moved(place, path)),
                    (None, Some(path)) => Some(finding.clone().moved("conditions.set", path)),
                    (None, None) if wheels => Some(Diagnostic {
                        path: format!("conditions.{}", finding.path),
                        spans: Vec::new(),
                        ..finding.clone()
                    }),
                    _ => None,
                }
            };
            let replaced_findings: Option<Vec<Diagnostic>> = findings.list.iter().map(replaced).collect();
            replaced_findings.map_or(findings, |list| self.findings(list))
        })
    }

    /// Fills the model set from `then` of an analysis with values, resolved path to value.
    pub(crate) fn fill_set(&mut self, set: &str, values: Map<String, Value>) {
        if self.sets.contains_key(set)
            && let Some(set) = Arc::make_mut(&mut self.sets).get_mut(set)
        {
            set["set"] = Value::Object(values);
        }
    }

    /// Keeps the corrections of an identification for later analyses.
    pub(crate) fn fill_correction(&mut self, analysis: &str, result: Value) {
        Arc::make_mut(&mut self.corrections).insert(analysis.to_owned(), result);
    }

    /// The corrections of an identification that has run.
    pub(crate) fn correction(&self, analysis: &str) -> Option<&Value> {
        self.corrections.get(analysis)
    }

    /// The first model set of an analysis that needs values from another analysis, with that analysis.
    pub fn pending(&self, analysis: &AnalysisEntry) -> Option<(String, String)> {
        analysis.uses().sets.into_iter().find_map(|set| {
            let (set, by) = self.promised.get_key_value(without_product(set))?;
            let is_pending = self
                .sets
                .get(set)
                .is_some_and(|set_entry| set_entry.get("set").is_none());
            is_pending.then(|| (set.clone(), by.clone()))
        })
    }

    /// Points under the conditions.
    pub fn points(&self, transmission: &Transmission, gear: &str, field: Field) -> Points {
        let conditions = &self.entry.conditions;
        Points {
            gear: gear.to_owned(),
            torque_at: vec![conditions.torque_at.clone()],
            speed_at: vec![conditions.speed_at.clone()],
            field,
            oil: OilTemperature::from_conditions(transmission, conditions.oil_temperature),
            flow: conditions.power_flow,
            terms: false,
        }
    }

    /// The case of points under the conditions.
    ///
    /// # Errors
    /// If the gear, the ports or their number are invalid: at the conditions if these state a port, otherwise at `place`.
    pub fn case(
        &self,
        place: &str,
        gearbox: &Gearbox,
        transmission: &Transmission,
        points: &Points,
    ) -> Result<Case, Findings> {
        let of_gearbox = |error: Diagnostic| gearbox.findings(vec![error]);
        let state = transmission.state(&points.gear).map_err(of_gearbox)?;
        let conditions = &self.entry.conditions;
        let names: Vec<&str> = transmission.ports().iter().map(|port| port.name.as_str()).collect();
        let unknown = [
            ("torque_at", &conditions.torque_at, &points.torque_at),
            ("speed_at", &conditions.speed_at, &points.speed_at),
        ]
        .into_iter()
        .filter(|(_, port, used)| used.contains(port) && !names.contains(&port.as_str()))
        .map(|(key, port, _)| dangling(&format!("conditions.{key}"), "port", port, &names));
        let unknown: Vec<Diagnostic> = unknown.collect();
        if !unknown.is_empty() {
            return Err(self.findings(unknown));
        }
        let [needed, free] = [transmission.torques_needed(state), transmission.states()[state].freedom];
        if points.torque_at.len() < needed || points.speed_at.len() < free {
            let at_place = |error: Diagnostic| Diagnostic {
                path: place.to_owned(),
                ..error
            };
            let fits = transmission.takes_one(state).map_err(at_place);
            fits.map_err(|error| self.findings(vec![error]))?;
        }
        points.case(transmission).map_err(|list| gearbox.findings(list))
    }

    /// The rows of a file under the conditions; `bind` are the paths of columns that change the gearbox.
    pub fn rows<'s>(
        &'s self,
        measured: &'s Measured,
        bind: &'s Ordered<String>,
        gear: Option<&'s str>,
        terms: bool,
    ) -> Rows<'s> {
        let conditions = &self.entry.conditions;
        Rows {
            measured,
            bind: bind.iter().map(|(_, path)| path.as_str()).collect(),
            gear,
            torque_at: &conditions.torque_at,
            speed_at: &conditions.speed_at,
            oil: conditions.oil_temperature,
            flow: conditions.power_flow,
            terms,
        }
    }

    /// Checks every name of the analyses, and builds every gearbox with every set.
    ///
    /// # Errors
    /// All errors.
    pub fn check(&self, language: &Language) -> Result<(), Findings> {
        let mut found: Vec<Diagnostic> = Vec::new();
        found.extend(called_own(self.sets.keys()));
        let analyses: Vec<&str> = self.entry.analyses.ids().collect();
        for (i, name) in self.entry.answered_by.iter().enumerate() {
            if !analyses.contains(&name.as_str()) {
                found.push(dangling(&format!("answered_by.{i}"), "analysis", name, &analyses));
            }
        }
        for (_, gearbox) in &self.gearboxes {
            gearbox.check_sets(language)?;
            let at_hand = sets_of(language, &gearbox.value, &self.sets);
            for error in self.sets.keys().filter_map(|name| expand_set(&at_hand, name).err()) {
                if found.iter().all(|other| other.path != error.path) {
                    found.push(error);
                }
            }
        }
        for (name, analysis) in self.entry.analyses.iter() {
            let path = format!("analyses.{name}");
            let Uses {
                gearbox,
                grid,
                sets,
                gears,
                best_gear,
                ..
            } = analysis.uses();
            found.extend(self.check_names(&path, &analysis.uses()));
            let (_, gearbox) = self.gearbox(&path, gearbox)?;
            let mut built = Vec::new();
            for set in &sets {
                let Some(by) = self.promised.get(without_product(set)) else {
                    continue;
                };
                let order = |analysis: &str| self.entry.analyses.index(analysis);
                if order(name) <= order(by) {
                    let message = format!("the set `{set}` has no values before the analysis `{by}`");
                    let below = Diagnostic::error(&path, message).help(format!("write this analysis below `{by}`"));
                    found.push(below.code(codes::NOT_FOUND_YET));
                }
            }
            for set in sets {
                let (gearbox, set) = self.reference(&path, set, gearbox)?;
                let at_hand = sets_of(language, &gearbox.value, &self.sets);
                match set.map(|set| expand_set(&at_hand, set)) {
                    // An invalid set is reported at its definition.
                    Some(Err(error)) if error.path != "model_sets" => {}
                    Some(Err(error)) => found.push(Diagnostic {
                        path: path.clone(),
                        ..error
                    }),
                    _ => built.push(self.built(language, gearbox, &self.choice(set), &[])?.1),
                }
            }
            if built.is_empty() {
                built.push(self.built(language, gearbox, &self.choice(None), &[])?.1);
            }
            let of_grid = grid.and_then(|name| Some((name, self.entry.grids.get(name)?)));
            for t in &built {
                let names: Vec<&str> = t.states().iter().map(|s| s.name.as_str()).collect();
                let mut unknown = |place: String, gear: &str| {
                    let error = dangling(&place, "gear state", gear, &names);
                    if !names.contains(&gear) && !found.iter().any(|e: &Diagnostic| e.path == place) {
                        found.push(error);
                    }
                };
                for gear in &gears {
                    unknown(format!("{path}.gear"), gear);
                }
                for gear in of_grid.iter().flat_map(|(_, grid)| grid.gear.names()) {
                    let name = of_grid.map_or("", |(name, _)| name.as_str());
                    if best_gear && gear == BEST {
                        continue;
                    }
                    unknown(format!("grids.{name}.gear"), gear);
                }
            }
        }
        if let Some(gear) = self.entry.report_at.as_ref().and_then(|at| at.gear.as_ref()) {
            let (_, gearbox) = self.gearbox("report_at", None)?;
            let (_, t) = self.built(language, gearbox, &self.choice(None), &[])?;
            if let Err(error) = t.state(gear) {
                found.push(Diagnostic {
                    path: "report_at.gear".to_owned(),
                    ..error
                });
            }
        }
        if found.is_empty() {
            Ok(())
        } else {
            Err(self.findings(found))
        }
    }

    /// Names of measurements, duty cycles, vehicles and grids that an analysis uses and that the study does not have.
    fn check_names(&self, path: &str, uses: &Uses<'_>) -> Vec<Diagnostic> {
        let named = uses.data.iter().filter_map(|(key, data)| {
            let name = data.name()?;
            self.named(&format!("{path}.{key}"), name).err()
        });
        let mut found: Vec<Diagnostic> = named.collect();
        let mut known = |names: &[&str], key: &str, kind: &str, name: &str| {
            if !names.contains(&name) {
                found.push(dangling(&format!("{path}.{key}"), kind, name, names));
            }
        };
        let cycles: Vec<&str> = self.entry.cycles.ids().collect();
        for cycle in uses.cycles {
            known(&cycles, "cycles", "cycle", cycle);
        }
        if let Some(vehicle) = uses.vehicle {
            let vehicles: Vec<&str> = self.entry.vehicles.ids().collect();
            known(&vehicles, "vehicle", "vehicle", vehicle);
        }
        if let Some(grid) = uses.grid {
            let grids: Vec<&str> = self.entry.grids.ids().collect();
            known(&grids, uses.grid_key, "grid", grid);
        }
        found
    }

    /// The data entry: from the measurements of the study, or from the analysis.
    ///
    /// # Errors
    /// If the name is unknown.
    pub fn measurement<'a>(&'a self, path: &str, data: &'a Data) -> Result<&'a MeasuredEntry, Findings> {
        match data {
            Data::Own(entry) => Ok(entry),
            Data::Named(name) => self.named(path, name).map_err(|error| self.findings(vec![error])),
        }
    }

    /// Reads measured points and the bytes of their files; `path` is their key, `bind` are columns that change the gearbox.
    ///
    /// # Errors
    /// If the name is unknown or a file cannot be read; all errors in the file, with line and column.
    pub fn measured(
        &self,
        path: &str,
        data: &Data,
        bind: &[&str],
    ) -> Result<(Measured, Vec<(String, Vec<u8>)>), Findings> {
        let entry = self.measurement(path, data)?;
        let elsewhere = data.name().map_or_else(Vec::new, |name| self.bound_columns(name));
        let analysis = path.rsplit_once('.').map_or(path, |(analysis, _)| analysis);
        let found = |list| self.findings(list);
        let place = own_place(path, data);
        let contents = self.contents(entry, &place).map_err(found)?;
        let measured = entry.read_files(&contents, bind, &elsewhere);
        let measured = measured.map_err(|faults| found(diagnostics(faults, &place, analysis)))?;
        let files = entry.file.list().into_iter().map(|file| file.file.to_owned());
        Ok((measured, files.zip(contents).collect()))
    }

    /// Columns that any analysis binds of a measurement.
    fn bound_columns(&self, name: &str) -> Vec<&str> {
        let analyses = self.entry.analyses.iter().map(|(_, analysis)| analysis.uses());
        let used = analyses.filter(|uses| uses.data.iter().any(|(_, data)| data.name().is_some_and(|n| n == name)));
        used.filter_map(|uses| uses.bind).flat_map(Ordered::ids).collect()
    }

    /// The bytes of a file of data that the study names.
    ///
    /// # Errors
    /// The reason why it cannot be read.
    pub fn read_file(&self, name: &str) -> io::Result<Vec<u8>> {
        self.files.read(&self.folder.join(name), LONGEST_DATA)
    }

    /// The bytes of the files of a measurement.
    fn contents(&self, entry: &MeasuredEntry, place: &str) -> Result<Vec<Vec<u8>>, Vec<Diagnostic>> {
        let (mut contents, mut faults) = (Vec::new(), Vec::new());
        for file in entry.file.list() {
            match self.read_file(file.file) {
                Ok(bytes) => contents.push(bytes),
                Err(e) => {
                    let error = Diagnostic::error(format!("{place}.file"), format!("{}: cannot read: {e}", file.file));
                    let error = error.help("file names are relative to the study");
                    faults.push(error.code(document::codes::UNREADABLE));
                }
            }
        }
        if faults.is_empty() { Ok(contents) } else { Err(faults) }
    }

    /// All errors of the files of points; absent if there are none. Each error is reported once, at its key of the measurement, for any
    /// number of analyses.
    pub fn data_findings(&self) -> Option<Findings> {
        let list = self.faults_of_data();
        (!list.is_empty()).then(|| self.findings(list))
    }

    fn faults_of_data(&self) -> Vec<Diagnostic> {
        let mut found: Vec<Diagnostic> = Vec::new();
        let mut add = |list: Vec<Diagnostic>| {
            for error in list {
                let known = |other: &Diagnostic| (&other.path, &other.message) == (&error.path, &error.message);
                if !found.iter().any(known) {
                    found.push(error);
                }
            }
        };
        let analyses = self.entry.analyses.iter();
        let uses: Vec<(String, Uses<'_>)> = analyses
            .map(|(name, analysis)| (format!("analyses.{name}"), analysis.uses()))
            .collect();
        let mut look = |entry: &MeasuredEntry, place: &str, elsewhere: &[&str], users: &[(&str, Vec<&str>)]| {
            let contents = match self.contents(entry, place) {
                Ok(contents) => contents,
                Err(faults) => return add(faults),
            };
            for (analysis, bind) in users {
                if let Err(faults) = entry.read_files(&contents, bind, elsewhere) {
                    add(diagnostics(faults, place, analysis));
                }
            }
        };
        for (name, entry) in self.entry.measurements.iter() {
            let mut users: Vec<(&str, Vec<&str>)> = Vec::new();
            for (path, uses) in &uses {
                let named = |(_, data): &&(&str, &Data)| data.name().is_some_and(|known| known == name);
                let Some((key, _)) = uses.data.iter().find(named) else {
                    continue;
                };
                let bind = uses.bound_of(key);
                // Files with equal settings are read once.
                if bind.is_empty() && users.iter().any(|(_, other)| other.is_empty()) {
                    continue;
                }
                users.push((path, bind));
            }
            if users.is_empty() {
                users.push(("", Vec::new()));
            }
            look(
                entry,
                &format!("measurements.{name}"),
                &self.bound_columns(name),
                &users,
            );
        }
        for (path, uses) in &uses {
            for (key, data) in &uses.data {
                if let Data::Own(entry) = data {
                    look(entry, &format!("{path}.{key}"), &[], &[(path, uses.bound_of(key))]);
                }
            }
        }
        found
    }

    fn named(&self, path: &str, name: &str) -> Result<&MeasuredEntry, Diagnostic> {
        let all = &self.entry.measurements;
        let names: Vec<&str> = all.ids().collect();
        all.get(name).ok_or_else(|| dangling(path, "measurement", name, &names))
    }

    /// The grid of a name.
    ///
    /// # Errors
    /// If there is none.
    pub fn grid<'a>(&'a self, path: &str, name: &str) -> Result<&'a Grid, Findings> {
        let grids: &Ordered<_> = &self.entry.grids;
        let names: Vec<&str> = grids.ids().collect();
        grids
            .get(name)
            .ok_or_else(|| self.findings(vec![dangling(&format!("{path}.grid"), "grid", name, &names)]))
    }
}

/// The set of `SET` or `PRODUCT/SET`.
fn without_product(set: &str) -> &str {
    set.rsplit('/').next().unwrap_or(set)
}

/// Place of data: under `measurements`, or at the key of the analysis.
fn own_place(path: &str, data: &Data) -> String {
    data.name()
        .map_or_else(|| path.to_owned(), |name| format!("measurements.{name}"))
}

/// Errors of data at their places: the entry of the data, or the bound columns of an analysis.
fn diagnostics(faults: Vec<MeasuredFault>, place: &str, analysis: &str) -> Vec<Diagnostic> {
    let at_place = |fault: MeasuredFault| {
        let path = match fault.place {
            FaultPlace::Entry(key) if key.is_empty() => place.to_owned(),
            FaultPlace::Entry(key) => format!("{place}.{key}"),
            FaultPlace::Bind(column) => format!("{analysis}.bind.{column}"),
        };
        Diagnostic::error(path, fault.message)
            .help(fault.help)
            .code(codes::DATA)
    };
    faults.into_iter().map(at_place).collect()
}
