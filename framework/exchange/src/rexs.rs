//! REXS models (Reusable Engineering EXchange Standard) of gearboxes, versions 1.0 to 2.0, as XML, JSON or in an archive.
//!
//! Source: schemas, change logs and file definition of the FVA, github.com/fva-net/rexs-api-java; specification, spec.rexs.info. A file is
//! read as a graph of components and relations without its schema: renamed ids are looked up in one table for all versions. See
//! `docs/rexs.md` for the attributes that are used and for what is assumed.

mod aliases;
mod bearings;
mod check;
mod coded;
mod crossed;
mod draft;
mod file;
mod gears;
mod graph;
mod incomplete;
mod json;
mod loads;
mod map;
mod members;
mod model;
mod oil;
mod pair;
mod pose;
mod shafts;
mod shares;
mod source;
mod study;
mod units;
mod xml;
mod yaml;

use std::collections::BTreeSet;

use gearloss_document::{Diagnostic, Sources, classify};
use gearloss_framework::gearbox::Findings;
use gearloss_framework::language::Language;

pub use aliases::{newest_attribute, newest_component};
pub use file::LONGEST_MODEL;

use draft::{Coupling, Draft, Port};
use file::Format;
use loads::{Loads, gear_name};
use map::{Map, id, named, one_line};
use model::Model;
use source::{Source, counted};

/// The newest version whose ids are known.
const NEWEST: &str = "2.0";

/// Most components of the kinds that describe a gearbox; the conversion compares them with each other.
const MOST_PARTS: usize = 2000;
const MOST_RELATIONS: usize = 100_000;

/// The texts that a model becomes.
#[derive(Debug)]
pub struct Imported {
    /// Text of the gearbox file, with the report at its end.
    pub gearbox: String,
    /// Text of the study, if the model has load cases. It names `gearbox.yaml` and `load_cases.csv` beside it.
    pub study: Option<String>,
    /// Table of the load cases, if there is a study.
    pub load_cases: Option<String>,
    /// Tables of loads on the teeth beside the gearbox, by the name with which it names them.
    pub shares: Vec<(String, String)>,
    /// What was taken, assumed, ignored and is missing, in lines.
    pub report: Vec<String>,
    /// Warnings about the file.
    pub warnings: Findings,
}

/// Converts the bytes of a REXS file. `name` is the name of the file, for messages and the title.
///
/// # Errors
/// All findings: a file that is no model or exceeds a limit, contradictions, values that cannot be read, and parts that gearbox files do not
/// describe.
pub fn import(bytes: &[u8], name: &str, language: &Language) -> Result<Imported, Findings> {
    let mut sources = Sources::default();
    let text = match file::text(bytes, name) {
        Ok(text) => text,
        Err(finding) => {
            return Err(Findings {
                list: vec![finding],
                sources,
            });
        }
    };
    let (mut model, mut found) = match text.format {
        Format::Xml => xml::read(&text.text),
        Format::Json => json::read(&text.text),
    };
    sources.add(text.name, text.text);
    if !found.is_empty() {
        classify(&mut found, crate::codes::REXS_FILE);
        return Err(Findings { list: found, sources });
    }
    if let Err(finding) = within_limits(&model) {
        return Err(Findings {
            list: vec![finding],
            sources,
        });
    }
    let left_out = incomplete::leave_out(&mut model);
    let source = Source::new(&model);
    if let Some(line) = left_out {
        source.note(line);
    }
    let converted = convert(&source, title(name), language);
    let list = source.findings();
    match converted {
        Some(mut imported)
            if list
                .iter()
                .all(|finding| finding.severity != gearloss_document::Severity::Error) =>
        {
            imported.warnings = Findings { list, sources };
            Ok(imported)
        }
        _ => Err(Findings { list, sources }),
    }
}

fn within_limits(model: &Model) -> Result<(), Diagnostic> {
    let is_part = |kind: &str| {
        [
            "shaft",
            "gear",
            "stage",
            "coupling",
            "external_load",
            "lubricant",
            "side_plate",
            "planet_carrier",
        ]
        .contains(&kind)
            || map::is_gear(kind)
            || kind.ends_with("_gear")
            || kind.ends_with("_stage")
            || kind.ends_with("_coupling")
            || kind.contains("bearing") && !kind.contains("row") && !kind.contains("data_set")
    };
    let parts = model
        .components
        .values()
        .filter(|component| is_part(&component.kind))
        .count();
    let cases: usize = model.spectra.iter().map(|spectrum| spectrum.cases.len()).sum();
    let loads = model
        .components
        .values()
        .filter(|component| component.kind == "external_load")
        .count();
    for (what, count, most) in [
        ("shafts, gears, bearings and couplings", parts, MOST_PARTS),
        ("relations", model.relations.len(), MOST_RELATIONS),
        ("values of load cases", cases.saturating_mul(loads.max(1)), 1_000_000),
    ] {
        if count > most {
            return Err(
                Diagnostic::error("", format!("the model has {count} {what}; at most {most} are read"))
                    .code(crate::codes::REXS_LIMIT)
                    .help("export one gearbox"),
            );
        }
    }
    Ok(())
}

/// Name of a model: that of its file without the endings.
pub fn title(name: &str) -> String {
    let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let lower = name.to_ascii_lowercase();
    let ends = [
        ".rexs.xml",
        ".rexs.json",
        ".rexs.zip",
        ".rexs",
        ".rexsj",
        ".rexsz",
        ".xml",
        ".json",
        ".zip",
    ];
    let end = ends.iter().find(|end| lower.ends_with(*end)).map_or(0, |end| end.len());
    let stem = one_line(name.get(..name.len() - end).unwrap_or(name), 100);
    if stem.is_empty() { "rexs".to_owned() } else { stem }
}

/// The texts; `None` after errors.
fn convert(source: &Source<'_>, title: String, language: &Language) -> Option<Imported> {
    let version = one_line(&source.model.version, 20);
    let known = ["1.0", "1.1", "1.2", "1.3", "1.4", "1.5", "1.6", "1.7", "2.0", "2.0.0"];
    if !known.contains(&version.as_str()) {
        let shown = if version.is_empty() { "none" } else { &version };
        source.report(
            Diagnostic::warning(
                "",
                format!(
                    "the version of the file is {shown}; 1.0 to {NEWEST} are known, and its ids were read as theirs"
                ),
            )
            .code(crate::codes::REXS_VERSION)
            .help("check the report for attributes that were not used"),
        );
    }
    let mut map = Map::new(source);
    map.find_supports();
    map.connected = shafts::connected(&map);
    map.sump = oil::sump(&map).map(|oil| id("lubricant", oil.id));
    shafts::check_axes(&map);
    map.forces = loads::forces(&map);
    let gears::Cylindrical {
        mut gears,
        meshes,
        sets,
        crossed,
    } = gears::gears(&mut map);
    let crossed = crossed::crossed(&map, &crossed);
    gears.extend(crossed.gears);
    if gears.is_empty() && !source.has_errors() {
        source.report(no_gears(source));
    }
    let mut draft = Draft {
        source: format!(
            "REXS {version} model {title}, written by {}",
            one_line(&source.model.application, 60)
        ),
        title: title.clone(),
        gears,
        meshes,
        crossed: crossed.meshes,
        assumed: crossed.assumed,
        sets,
        ..Draft::default()
    };
    let (bearings, placeholders) = bearings::bearings(&map, language);
    draft.bearings = bearings;
    draft.assumed.extend(placeholders);
    oil::oils(&map, &mut draft);
    let loads = loads::loads(&map);
    describe_loads(&map, &loads, &mut draft);
    draft.shafts = shafts::shafts(&map);
    couplings(&map, &mut draft);
    alone(&map);
    if source.has_errors() {
        return None;
    }
    missing(&map, &mut draft);
    draft.from_file = vec!["shafts", "gears", "meshes", "bearings"];
    for section in ["bevel_meshes", "worm_meshes", "crossed_helical_meshes"] {
        if draft.crossed.iter().any(|mesh| mesh.section == section) {
            draft.from_file.push(section);
        }
    }
    if draft.meshes.is_empty() {
        draft.from_file.retain(|section| *section != "meshes");
    }
    let gears: BTreeSet<String> = draft.states.iter().map(|(gear, _)| gear.clone()).collect();
    let study = study::study(&map, &loads, &title, &gears);
    let faults = match check::fit(&mut draft, language, source) {
        Ok(transmission) => {
            shares::add(&map, &transmission, &mut draft);
            Vec::new()
        }
        Err(faults) => {
            shares::postpone(&map);
            faults
        }
    };
    if source.has_errors() {
        return None;
    }
    let report = report(&map, loads.cases.len(), faults);
    draft.head = head(&draft.source);
    draft.report.clone_from(&report);
    let (study, load_cases) = study.map(|study| (study.study, study.table)).unzip();
    Some(Imported {
        gearbox: yaml::gearbox(&draft),
        study,
        load_cases,
        shares: draft.shares,
        report,
        warnings: Findings::from(Vec::new()),
    })
}

fn head(source: &str) -> Vec<String> {
    vec![
        format!("{source}."),
        "Ids are the type and the number of a component of that model; its name is in the comment. The report of the import is at the end.".to_owned(),
        "A line such as `#level: ...`, without a space after the `#`, is an option: delete the `#` to use it.".to_owned(),
    ]
}

/// Ports, rating and oil temperature from the load cases.
fn describe_loads(map: &Map<'_>, loads: &Loads, draft: &mut Draft) {
    let source = map.source;
    draft.ports = loads
        .ports
        .iter()
        .map(|(member, name)| Port {
            name: name.clone(),
            shaft: map.member_name(*member),
        })
        .collect();
    if draft.ports.is_empty() && !source.has_errors() {
        source.report(
            Diagnostic::error(
                "",
                "the model does not say where torque enters or leaves: no external_load has transmits_torque",
            )
            .code(crate::codes::REXS_MODEL)
            .help("add an external load that transmits torque to the input and to the output shaft"),
        );
    }
    let greatest = |values: &mut dyn Iterator<Item = f64>| values.map(f64::abs).fold(0.0, f64::max);
    let torque = greatest(&mut loads.cases.iter().map(|case| case.torque));
    let speed = greatest(&mut loads.cases.iter().map(|case| case.speed));
    draft.rating = (torque > 0.0 && speed > 0.0).then_some((torque, speed));
    draft.oil_temperature = loads.cases.iter().find_map(|case| case.oil).or_else(|| {
        let casing = source.components("gear_casing").next()?;
        source.number(casing, "temperature_lubricant", units::Quantity::Temperature)
    });
}

/// Couplings and the gears that engage them.
fn couplings(map: &Map<'_>, draft: &mut Draft) {
    let source = map.source;
    let unit = source.components("gear_unit").next();
    let stated = unit
        .and_then(|unit| source.integer(unit, "number_of_gears"))
        .unwrap_or(1);
    let switched = map
        .members
        .joints
        .iter()
        .filter_map(|joint| joint.engaged.as_ref())
        .map(Vec::len);
    let count = switched
        .max()
        .unwrap_or(1)
        .max(usize::try_from(stated.clamp(1, 1000)).unwrap_or(1));
    let mut names: Vec<(String, Option<Vec<bool>>)> = Vec::new();
    for joint in &map.members.joints {
        let members = [Some(joint.first), joint.second];
        if members.iter().flatten().any(|member| map.copies.contains(member)) {
            continue;
        }
        let name = id("coupling", joint.ids[0]);
        let labels: Vec<String> = joint
            .ids
            .iter()
            .filter_map(|id| source.component(*id))
            .map(named)
            .collect();
        draft.couplings.push(Coupling {
            id: name.clone(),
            comment: labels.join(" + "),
            between: [
                map.member_name(joint.first),
                joint
                    .second
                    .map_or_else(|| "housing".to_owned(), |member| map.member_name(member)),
            ],
        });
        if joint.engaged.as_ref().is_some_and(Vec::is_empty) {
            source.assume(format!(
                "{name}: the file does not say when it is engaged; always was taken"
            ));
        }
        names.push((name, joint.engaged.clone()));
    }
    if names.is_empty() {
        return;
    }
    for (gear, number) in (0..count).zip(1..) {
        let engaged = names
            .iter()
            .filter(|(_, engaged)| match engaged {
                None => true,
                Some(list) => list.get(gear).or(list.last()).copied().unwrap_or(true),
            })
            .map(|(name, _)| name.clone())
            .collect();
        draft.states.push((gear_name(number), engaged));
    }
}

/// Shafts that nothing touches are left out.
fn alone(map: &Map<'_>) {
    for member in map.members.all() {
        if !map.connected.contains(&member)
            && let Some(shaft) = map.source.component(member)
        {
            map.source
                .note(format!("{} carries nothing and was left out", shaft.label()));
        }
    }
}

/// What losses need beside the values of the file.
fn missing(map: &Map<'_>, draft: &mut Draft) {
    let source = map.source;
    if draft.gears.iter().any(|gear| gear.ra.is_none()) {
        draft.assumed.push((
            vec!["surface".to_owned()],
            "placeholder: the REXS file states no roughness of some flanks".to_owned(),
        ));
        source.missing("the roughness of the flanks: Ra 0.4 um stands in as `surface`");
    }
    if draft.oil_temperature.is_none() {
        draft.assumed.push((
            vec!["thermal.oil".to_owned()],
            "placeholder: the REXS file states no oil temperature".to_owned(),
        ));
        source.missing("the oil temperature: 80 degC stands in as `thermal.oil`");
    }
    source.missing("seals: REXS has no component for them; there is no seal friction until `seals` are added");
    source.missing("oil level, cross section of the case and gaps to the wall: no gear churns until `housing` has them and `models` has `gear_drag`");
    if !draft.sets.is_empty() {
        source.missing("drag of the carrier with its planets: none until `models` has `planetary_drag`");
    }
}

/// The lines of the report.
fn report(map: &Map<'_>, cases: usize, faults: Vec<String>) -> Vec<String> {
    let source = map.source;
    let copied = map.copied_parts();
    let unused = source.unused(&copied);
    let total: usize = unused.values().sum();
    let mut lines = vec![format!(
        "Taken: {} of {}, {}.",
        counted(source.taken(), "value"),
        counted(source.model.components.len(), "component"),
        counted(cases, "load case")
    )];
    let mut list = |title: &str, entries: Vec<String>| {
        if !entries.is_empty() {
            lines.push(String::new());
            lines.push(format!("{title}:"));
            lines.extend(entries.into_iter().map(|entry| format!("- {entry}")));
        }
    };
    list("To correct before the gearbox can be solved", faults);
    list("Missing for losses", source.missing.take());
    list("Assumed", source.assumptions.take());
    list("Ignored or changed", source.notes.take());
    if total > 0 {
        lines.push(String::new());
        lines.push(format!(
            "Not used: {} of {}:",
            counted(total, "attribute"),
            counted(unused.len(), "kind")
        ));
        let mut line = "-".to_owned();
        for (i, (attribute, count)) in unused.iter().enumerate() {
            let attribute = one_line(attribute, 100);
            let end = if i + 1 == unused.len() { "" } else { "," };
            let word = if *count == 1 {
                format!(" {attribute}{end}")
            } else {
                format!(" {attribute} ({count}){end}")
            };
            if line.len() + word.len() > 130 {
                lines.push(std::mem::replace(&mut line, " ".to_owned()));
            }
            line.push_str(&word);
            if lines.len() > 400 {
                line.push_str(" ...");
                break;
            }
        }
        lines.push(line);
    }
    lines
}

/// The finding of a model without gears, such as one of loads of bearings.
fn no_gears(source: &Source<'_>) -> Diagnostic {
    let found = Diagnostic::error("", "the model has no gears")
        .code(crate::codes::REXS_PART)
        .help("give a REXS model of a gearbox with cylindrical, planetary, bevel or worm stages");
    let cases: usize = source.model.spectra.iter().map(|spectrum| spectrum.cases.len()).sum();
    let bearings = source.components("rolling_bearing_with_catalog_geometry").count();
    if cases == 0 || bearings == 0 {
        return found;
    }
    found.note(format!(
        "it has loads of {} in {}, for programs that calculate their life: no gears, shafts, positions and relations",
        counted(bearings, "bearing"),
        counted(cases, "load case")
    ))
}
