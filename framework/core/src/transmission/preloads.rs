//! Preload of opposed bearings as written: checks, conversion to a closing, what temperature makes of it.

use super::Component;
use super::nodes::NodeNames;
use super::oils::Oils;
use super::pairs::Design;
use crate::attach::{Axial, Oil, PreloadBody, PreloadEntry, SeatedSupport, State, dangling};
use crate::codes;
use crate::document::Diagnostic;
use crate::hydraulics::Supplies;
use crate::loads::{AngularRow, Layout, Mounting, Pair, StiffPair, SupportLoad, ThermalClosing};
use crate::loss::{Notebook, Undefined};
use crate::real::Points;
use crate::rolling::{AxialRow, root_of_growing};
use std::cell::Cell;

/// Expansion of rings and rolling elements. \[1/K\]
const BEARING_STEEL: f64 = 11.5e-6;

/// Node of the housing in `network: auto`; those of shafts and idler gears have their names.
const CASING: &str = "casing";

/// Preload or end play of a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairPreload {
    /// Number of the support that states it.
    pub support: usize,
    /// How it is stated.
    pub stated: PreloadBy,
    /// Force at mounting temperature, zero with end play. \[N\]
    pub force: f64,
    /// Closing at mounting temperature, negative with end play. \[m\]
    pub closing: f64,
    /// Mounting temperature. \[degC\]
    pub mounting_temperature: f64,
    /// Distance of the contacts with the outer rings along the shaft. \[m\]
    pub distance: f64,
    /// Change of the closing per kelvin of the shaft and of the housing. \[m/K\]
    pub per_kelvin: [f64; 2],
    /// Temperatures of shaft and housing.
    pub temperatures: [BodyTemperature; 2],
    /// True if the internal geometry of a bearing is estimated.
    pub is_estimated: bool,
    /// Both bearings, the one that takes thrust towards -x first.
    pub bearings: StiffPair,
}

/// How a preload is stated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PreloadBy {
    /// As a force.
    Force,
    /// As a displacement.
    Closing,
    /// As a torque.
    Torque,
}

/// Temperature of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BodyTemperature {
    /// As stated. \[degC\]
    Stated(f64),
    /// That of a node of the thermal network.
    Node(usize),
    /// Above the mean of the oils of both bearings.
    AboveOil {
        /// Numbers of the oils.
        oils: [u16; 2],
        /// By how much. \[K\]
        above: f64,
    },
}

impl BodyTemperature {
    fn at<R: Points>(self, temperatures: &[R], oils: &[Oil<R>]) -> R {
        match self {
            Self::Stated(temperature) => R::constant(temperature),
            // With one temperature for all nodes, it is that.
            Self::Node(node) => *temperatures.get(node).unwrap_or(&temperatures[0]),
            Self::AboveOil { oils: [a, b], above } => {
                let [a, b] = [a, b].map(|oil| oils[usize::from(oil)].temperature);
                (a + b) * 0.5 + above
            }
        }
    }
}

impl PairPreload {
    /// Temperatures of shaft and housing. \[degC\]
    pub fn temperatures<R: Points>(&self, temperatures: &[R], oils: &[Oil<R>]) -> [R; 2] {
        self.temperatures.map(|body| body.at(temperatures, oils))
    }

    /// Closing at the temperatures of shaft and housing (degC). \[m\]
    pub fn closing_at<R: Points>(&self, [shaft, housing]: [R; 2]) -> R {
        let [of_shaft, of_housing] = self.per_kelvin;
        let mounting = self.mounting_temperature;
        (shaft - mounting) * of_shaft + (housing - mounting) * of_housing + self.closing
    }
}

/// Checks all stated preloads and marks the bearings of their pairs in the layout.
pub(super) fn mark(
    layout: &mut Layout,
    supports: &[SeatedSupport],
    designs: &[Design],
    names: &[String],
    found: &mut Vec<Diagnostic>,
) {
    for (number, support) in supports.iter().enumerate() {
        let Some(entry) = &support.place.preload else { continue };
        let path = format!("{}.preload", support.path);
        let faults = found.len();
        found.extend(of_entry(&path, entry));
        let opposed = match opposed(number, layout, supports, &path, names) {
            Ok(opposed) => opposed,
            Err(fault) => {
                found.push(fault);
                continue;
            }
        };
        found.extend(contradictions(number, opposed, supports, &path));
        for own in [number, opposed] {
            if let Some(Err(why)) = &designs[own].row {
                let fault = format!("the preload needs the stiffness of `{}`: {why}", supports[own].path);
                found.push(
                    Diagnostic::error(&path, fault).help("use bearings with a contact angle, or remove `preload`"),
                );
            }
        }
        if found.len() > faults {
            continue;
        }
        for own in [number, opposed] {
            if let Some(Ok(AngularRow { row, .. })) = &designs[own].row {
                let marked = &mut layout.supports[own];
                marked.preloaded = Some(AxialRow::new(row));
                marked.induced = Some(AxialRow::half_ratio(row.contact, row.contact_angle));
            }
        }
    }
}

/// What is wrong with an entry in itself.
fn of_entry(path: &str, entry: &PreloadEntry) -> Vec<Diagnostic> {
    let mut faults = Vec::new();
    let stated = [entry.force, entry.closing, entry.torque];
    if stated.iter().flatten().count() != 1 {
        faults.push(
            Diagnostic::error(path, "a preload is one of `force`, `closing` and `torque`")
                .help("state one of them only"),
        );
    }
    match (entry.torque, entry.torque_speed) {
        (Some(_), None) => faults.push(
            Diagnostic::error(path, "friction depends on the speed at which `torque` is measured")
                .help("add `torque_speed:`, such as 30 rpm"),
        ),
        (None, Some(_)) => faults.push(
            Diagnostic::error(format!("{path}.torque_speed"), "there is no `torque` at this speed")
                .help("remove it, or state `torque`"),
        ),
        _ => {}
    }
    for (key, body) in [("shaft", &entry.shaft), ("housing", &entry.housing)] {
        let stated = [
            body.temperature.is_some(),
            body.node.is_some(),
            body.above_oil.is_some(),
        ];
        if stated.iter().filter(|is_stated| **is_stated).count() > 1 {
            faults.push(
                Diagnostic::error(
                    format!("{path}.{key}"),
                    "a temperature is one of `temperature`, `node` and `above_oil`",
                )
                .help("state one of them only"),
            );
        }
        if body.material.is_some() && body.expansion.is_some() {
            faults.push(
                Diagnostic::error(
                    format!("{path}.{key}"),
                    "`material` and `expansion` both state the expansion",
                )
                .help("remove one of them"),
            );
        }
    }
    faults
}

/// The one bearing that opposes a bearing.
fn opposed(
    number: usize,
    layout: &Layout,
    supports: &[SeatedSupport],
    path: &str,
    names: &[String],
) -> Result<usize, Diagnostic> {
    let axial = supports[number].place.axial;
    let error = |why: String| Diagnostic::error(path, format!("this preload presses no opposed bearing: {why}"));
    if matches!(axial, Axial::None | Axial::Both) {
        return Err(error("the bearing has no `axial: left` or `axial: right`".to_owned())
            .help("state the direction of thrust that it takes, and the opposite one at its partner"));
    }
    let carried = |own: usize| layout.carried(&layout.supports[own]).0;
    // `axial` is that of the member in the bore, which need not be the carried one.
    let takes = |own: usize| {
        let axial = supports[own].place.axial;
        if usize::from(supports[own].inner) == carried(own) {
            axial
        } else {
            axial.opposite()
        }
    };
    let others: Vec<usize> = (0..supports.len())
        .filter(|own| *own != number && carried(*own) == carried(number))
        .filter(|own| supports[*own].place.axial != Axial::None)
        .collect();
    match others[..] {
        [other] if takes(other) == takes(number).opposite() => Ok(other),
        [] => Err(
            error(format!("no other bearing takes thrust of `{}`", names[carried(number)]))
                .help("write `axial: left` and `axial: right` at the two bearings that oppose each other"),
        ),
        [other] => Err(
            error(format!("`{}` does not take the opposite thrust", supports[other].path))
                .help("write `axial: left` and `axial: right` at the two bearings that oppose each other"),
        ),
        [..] => {
            let paths: Vec<&str> = others.iter().map(|own| supports[*own].path.as_str()).collect();
            Err(
                error(format!("several bearings take thrust besides it: {}", paths.join(", ")))
                    .help("a preload is that of two single bearings; write `axial: none` at the others"),
            )
        }
    }
}

/// What contradicts a preload of two bearings.
fn contradictions(number: usize, opposed: usize, supports: &[SeatedSupport], path: &str) -> Vec<Diagnostic> {
    let mut faults = Vec::new();
    if supports[opposed].place.preload.is_some() && number > opposed {
        faults.push(
            Diagnostic::error(
                path,
                format!("`{}` states the preload of this pair, too", supports[opposed].path),
            )
            .help("state it at one of both bearings"),
        );
    }
    for own in [number, opposed] {
        let (own, place) = (&supports[own].path, &supports[own].place);
        if place.spring_preload != 0.0 {
            faults.push(
                Diagnostic::error(
                    path,
                    format!("`{own}` is on a spring, which holds its force whatever the closing is"),
                )
                .help("state `preload` or `spring_preload`"),
            );
        }
        if place.induced_thrust.is_some() {
            faults.push(
                Diagnostic::error(
                    format!("{own}.induced_thrust"),
                    "the pair has a preload, whose load distribution determines the thrust",
                )
                .help("remove `induced_thrust`, or `preload`"),
            );
        }
    }
    faults
}

/// What the preloads of pairs are made of.
pub(super) struct Preloading<'a> {
    pub supports: &'a [SeatedSupport],
    pub designs: &'a [Design],
    pub components: &'a [Component],
    pub nodes: &'a NodeNames,
    pub oils: &'a Oils,
    /// Names of the members.
    pub members: &'a [String],
}

impl Preloading<'_> {
    fn component(&self, support: usize) -> Option<&Component> {
        self.components
            .iter()
            .find(|component| component.support.map(usize::from) == Some(support))
    }

    /// Where the temperature of a body is from.
    fn temperature(
        &self,
        path: &str,
        body: &PreloadBody,
        default: Option<usize>,
        oils: [u16; 2],
    ) -> Result<BodyTemperature, Diagnostic> {
        if let Some(temperature) = body.temperature {
            return Ok(BodyTemperature::Stated(temperature));
        }
        if let Some(name) = &body.node {
            if self.nodes.names().is_empty() {
                return Err(
                    Diagnostic::error(format!("{path}.node"), "there is no thermal network with nodes")
                        .help("state `temperature` or `above_oil`, or add `thermal: { network: auto }`"),
                );
            }
            let names: Vec<&str> = self.nodes.names().iter().map(String::as_str).collect();
            let node = self.nodes.node(name).map(BodyTemperature::Node);
            return node.ok_or_else(|| dangling(&format!("{path}.node"), "node", name, &names));
        }
        Ok(match default.filter(|_| body.above_oil.is_none()) {
            Some(node) => BodyTemperature::Node(node),
            None => BodyTemperature::AboveOil {
                oils,
                above: body.above_oil.unwrap_or(0.0),
            },
        })
    }

    /// The force at which both bearings together have a torque at a speed without other loads and without an oil bath. \[N\]
    fn force_of_torque(&self, pair: [usize; 2], torque: f64, speed: f64, temperature: f64) -> Result<f64, String> {
        let components: Vec<&Component> = pair.iter().filter_map(|own| self.component(*own)).collect();
        if let Some(off) = pair.iter().zip(&components).find(|(_, component)| component.off) {
            return Err(format!("`{}` has no friction model", self.supports[*off.0].path));
        }
        let mut speeds = vec![0.0; self.members.len()];
        for own in pair {
            speeds[usize::from(self.supports[own].inner)] = speed;
        }
        let mut oils = vec![Oil::default(); self.oils.len()];
        self.oils.write_states(&[temperature], &mut oils);
        // A bearing has one pocket at most.
        let pockets = vec![0.0; self.supports.len()];
        let moment = |force: f64| -> Result<f64, Undefined> {
            let mut loads = vec![SupportLoad::default(); self.supports.len()];
            for own in pair {
                loads[own].axial = force;
            }
            let state = State {
                speeds: &speeds,
                oils: &oils,
                temperatures: &[temperature],
                surface: f64::NEG_INFINITY,
                rest: f64::NEG_INFINITY,
                incline: None,
                supplies: Supplies {
                    elements: &[],
                    pockets: &pockets,
                },
                loads: &loads,
                calls: &Cell::new(0),
            };
            let losses = components
                .iter()
                .map(|component| component.placed.loss(&state, &Notebook::CLOSED));
            losses.map(|loss| Ok(loss?.total_moment(speed))).sum()
        };
        let free = moment(0.0).map_err(|reason| reason.to_string())?;
        if free > torque {
            return Err(format!("without preload it is {free:.4} Nm already"));
        }
        let off = |force: f64| moment(force).map_or(f64::NAN, |moment| moment - torque);
        root_of_growing(off, 0.0, 1.0, 24)
            .filter(|force| force.is_finite())
            .ok_or_else(|| "no preload has it by the friction models of the bearings".to_owned())
    }
}

impl PairPreload {
    /// The preload that a bearing of a pair states; reports what is wrong with it.
    pub(super) fn new(
        pair: &Pair,
        mounting: Option<Mounting>,
        preloading: &Preloading<'_>,
        found: &mut Vec<Diagnostic>,
    ) -> Option<Self> {
        let bearings = pair.stiff?;
        let numbers = [pair.sides[0].first()?.support, pair.sides[1].first()?.support];
        let support = *numbers
            .iter()
            .find(|own| preloading.supports[**own].place.preload.is_some())?;
        let seated = &preloading.supports[support];
        let entry = seated.place.preload.as_ref()?;
        let path = format!("{}.preload", seated.path);
        match Self::of(entry, (&path, support), (numbers, bearings), mounting, preloading) {
            Ok(preload) => Some(preload),
            Err(fault) => {
                found.push(fault);
                None
            }
        }
    }

    fn of(
        entry: &PreloadEntry,
        (path, support): (&str, usize),
        (numbers, bearings): ([usize; 2], StiffPair),
        mounting: Option<Mounting>,
        preloading: &Preloading<'_>,
    ) -> Result<Self, Diagnostic> {
        let places = numbers.map(|own| &preloading.supports[own].place);
        let mounting = mounting.ok_or_else(|| {
            Diagnostic::error(
                path,
                "both bearings are at the same position, so their mounting is not known",
            )
            .help("write different positions `at`, those of the pressure centres")
        })?;
        let rows = numbers.map(|own| match &preloading.designs[own].row {
            Some(Ok(row)) => Some(*row),
            _ => None,
        });
        let [Some(first), Some(second)] = rows else {
            return Err(Diagnostic::error(path, "the stiffness of a bearing is not known"));
        };
        let rows = [first, second];
        let distance = match entry.distance {
            Some(distance) => distance,
            None => distance_of_contacts(path, mounting, (places[0].at - places[1].at).abs(), &rows)?,
        };
        let housing = entry.housing.expansion();
        let thermal = ThermalClosing {
            mounting,
            diameter: rows.map(|row| row.outer_diameter),
            contact_angle: rows.map(|row| row.row.contact_angle),
            distance,
            shaft: entry.shaft.expansion(),
            outer_rings: BEARING_STEEL + entry.ring_follows * (housing - BEARING_STEEL),
            housing,
        };
        let oils = numbers.map(|own| {
            let oil = preloading.component(own).and_then(|component| component.placed.oil());
            oil.unwrap_or(0)
        });
        // Nodes with the names that `network: auto` gives them.
        let seated = &preloading.supports[support];
        let of_member = |member: u16| preloading.nodes.node(&preloading.members[usize::from(member)]);
        let around = seated.outer.map_or_else(|| preloading.nodes.node(CASING), of_member);
        let temperatures = [
            preloading.temperature(&format!("{path}.shaft"), &entry.shaft, of_member(seated.inner), oils)?,
            preloading.temperature(&format!("{path}.housing"), &entry.housing, around, oils)?,
        ];
        let (stated, force, closing) = match (entry.force, entry.closing, entry.torque.zip(entry.torque_speed)) {
            (Some(force), ..) => (PreloadBy::Force, force, bearings.closing(force)),
            (None, Some(closing), _) => (PreloadBy::Closing, bearings.force(closing), closing),
            (None, None, Some((torque, speed))) => {
                let force = preloading
                    .force_of_torque(numbers, torque, speed, entry.mounting_temperature)
                    .map_err(|why| {
                        Diagnostic::error(
                            format!("{path}.torque"),
                            format!("the bearings cannot have this torque: {why}"),
                        )
                        .help("correct `torque` or the friction models of both bearings, or state `force` or `closing`")
                    })?;
                (PreloadBy::Torque, force, bearings.closing(force))
            }
            // Reported before.
            (None, None, None) => return Err(Diagnostic::error(path, "a preload is missing")),
        };
        Ok(Self {
            support,
            stated,
            force,
            closing,
            mounting_temperature: entry.mounting_temperature,
            distance,
            per_kelvin: thermal.per_kelvin(),
            temperatures,
            is_estimated: rows.iter().any(|row| row.is_estimated),
            bearings,
        })
    }

    /// What a preload may not be as meant: an expansion of the housing that is not stated, more than a bearing can carry.
    pub(super) fn warnings(&self, numbers: [usize; 2], preloading: &Preloading<'_>) -> Vec<Diagnostic> {
        let support = &preloading.supports[self.support];
        let path = format!("{}.preload", support.path);
        let mut warnings = Vec::new();
        let entry = support.place.preload.as_ref();
        if support.outer.is_none() && entry.is_some_and(|entry| entry.housing.is_material_assumed()) {
            warnings.push(
                Diagnostic::warning(
                    format!("{path}.housing"),
                    "the housing is taken to expand as steel; one of aluminium changes the preload twice as much or the other way",
                )
                .code(codes::PRELOAD)
                .help("state `housing: { material: aluminium }`, `cast_iron`, `steel` or `magnesium`, or `expansion`"),
            );
        }
        for own in numbers {
            let rating = preloading
                .component(own)
                .and_then(|component| component.placed.static_rating());
            if let Some(rating) = rating
                && rating.safety(0.0, self.force) < crate::loads::LEAST_STATIC_SAFETY
            {
                warnings.push(
                    Diagnostic::warning(
                        path.clone(),
                        format!(
                            "{:.0} N of preload alone exceed the static rating of `{}`",
                            self.force, preloading.supports[own].path
                        ),
                    )
                    .code(codes::PRELOAD)
                    .help("correct the preload, or use a larger bearing"),
                );
            }
        }
        warnings
    }
}

/// Distance of the contacts with the outer rings, from that of the pressure centres. \[m\]
fn distance_of_contacts(
    path: &str,
    mounting: Mounting,
    centres: f64,
    rows: &[AngularRow; 2],
) -> Result<f64, Diagnostic> {
    // A pressure centre is D/2 tan(a) beside the contacts, inside face to face.
    let beside: f64 = rows
        .iter()
        .map(|row| 0.5 * row.outer_diameter * row.row.contact_angle.tan())
        .sum();
    let distance = centres + mounting.sign() * beside;
    if distance < 0.0 {
        return Err(Diagnostic::error(
            path,
            format!(
                "the positions `at` of both bearings are {:.1} mm apart, less than their pressure centres can be back to back",
                1e3 * centres
            ),
        )
        .help("write the pressure centres into `at`, or state `distance`"));
    }
    Ok(distance)
}
