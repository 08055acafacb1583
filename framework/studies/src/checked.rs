//! A gearbox that was checked: what it is built from, and what deserves attention.

mod load_sharing;
mod planet_sharing;

use std::path::Path;

use gearloss_framework::codes;
use gearloss_framework::coefficients::{Changed, changed_from_source};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::{Ratings, Solution, WindowFlow};
use gearloss_framework::files::SharedSource;
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::loss::Extent;
use gearloss_framework::mechanism::bearing::Bearing;
use gearloss_framework::mechanism::{Component as _, Mechanism as _};
use gearloss_framework::registry::Evidence;
use gearloss_framework::resolve::{Choice, Resolved};
use gearloss_framework::sump::LEAST_SPLASH;
use gearloss_framework::transmission::Transmission;

use crate::numbers::{RPM, figures, significant};
use crate::points::{Note, STATIC_SAFETY, WeakPoint, evidence, merge, notes};
use crate::ratings::{RatedQuantity, rated};

pub use load_sharing::SharingAtRating;
pub use planet_sharing::PlanetsAtRating;

/// A gearbox that was read, resolved and built.
pub struct CheckedGearbox {
    /// The gearbox.
    pub gearbox: Gearbox,
    /// Its resolved description.
    pub resolved: Resolved,
    /// Its transmission.
    pub transmission: Transmission,
    /// Its ratings.
    pub ratings: Ratings,
    /// Evidence, lowest grade first.
    pub evidence: Vec<WeakPoint>,
    /// Coefficients that differ from their source.
    pub changed: Vec<Changed>,
    /// Losses of the meshes by their load sharing and by one calculated in thin slices, at the rating.
    pub load_sharings: Vec<SharingAtRating>,
    /// What position errors of the pins of planets change at the rating.
    pub planet_sharings: Vec<PlanetsAtRating>,
}

impl CheckedGearbox {
    /// Builds a resolved gearbox.
    ///
    /// # Errors
    /// Everything that building finds.
    pub fn new(language: &Language, gearbox: Gearbox, resolved: Resolved) -> Result<Self, Findings> {
        let transmission = gearbox.build(language, &resolved)?;
        let mut checked = Self {
            ratings: gearbox.ratings(language, &resolved, &transmission)?,
            evidence: evidence(&transmission, &resolved, &|path| gearbox.places.is_written(path)),
            changed: changed_from_source(&transmission, &resolved),
            gearbox,
            resolved,
            transmission,
            load_sharings: Vec::new(),
            planet_sharings: Vec::new(),
        };
        checked.load_sharings = load_sharing::load_sharings(language, &checked);
        checked.planet_sharings = planet_sharing::planet_sharings(language, &checked);
        Ok(checked)
    }

    /// Reads a gearbox of a source with all its model sets, resolves and builds it.
    ///
    /// # Errors
    /// Everything that reading, resolving and building find.
    pub fn read(language: &Language, files: &SharedSource, file: &Path, choice: &Choice) -> Result<Self, Findings> {
        let gearbox = Gearbox::read_from(language, files, file)?;
        gearbox.check_sets(language)?;
        let resolved = gearbox.resolve(language, choice)?;
        Self::new(language, gearbox, resolved)
    }

    /// Warnings of building with their places, and what is overloaded or outside its bound at the rated torque and speed.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        let overloaded = overloaded(&self.transmission).into_iter().map(|note| {
            let message = format!(
                "{} {} at the rated torque is below 1",
                note.name,
                significant(note.least)
            );
            self.gearbox.places.place(
                Diagnostic::warning(note.path, message)
                    .help("use a larger bearing, or check the rating")
                    .code(codes::OVERLOADED),
            )
        });
        let outside = out_of_bounds(self).into_iter().map(|found| {
            let sentence = found.quantity.sentence().unwrap_or_default();
            self.gearbox.places.place(
                Diagnostic::warning(found.component, format!("at the rated torque, {sentence}"))
                    .help(format!(
                        "change the component, or state another bound under `ratings.{}`",
                        found.rating
                    ))
                    .code(codes::RATED_OUTSIDE),
            )
        });
        let dry = dry_bearings(self)
            .into_iter()
            .map(|warning| self.gearbox.places.place(warning));
        let supply = self.short_of_oil();
        let built = self.transmission.warnings.iter().cloned();
        built
            .chain(overloaded)
            .chain(outside)
            .chain(dry)
            .chain(supply)
            .collect()
    }

    /// What the oil network lacks at the rated speed and at a tenth of it, and windows that no oil meets, with places.
    pub fn short_of_oil(&self) -> Vec<Diagnostic> {
        let found = short_of_oil(&self.transmission).into_iter();
        let found = found.chain(missed_windows(&self.transmission));
        found.map(|warning| self.gearbox.places.place(warning)).collect()
    }

    /// The lowest grade of evidence.
    pub fn lowest_evidence(&self) -> Option<Evidence> {
        self.evidence.first().map(|weak| weak.grade)
    }
}

/// Solves the rated torque and speed in any gear, in drive and coast, and returns what models noted.
pub fn at_the_rating(t: &Transmission, mut each: impl FnMut(&Solution<'_>)) -> Vec<Extent> {
    let Some(rating) = t.rating else { return Vec::new() };
    let mut seen = Vec::new();
    let points = [1.0, -1.0].map(|sign| [rating.speed, sign * rating.torque]);
    for state in 0..t.states().len() {
        merge(&mut seen, &t.at_reference(state, points, |_, solution| each(solution)));
    }
    seen
}

/// Part of the rated speed at which a relief valve that is still open never closes.
const SLOW: f64 = 0.1;

/// What the oil network lacks at the rated speed and at a tenth of it, in any gear, without torque.
fn short_of_oil(t: &Transmission) -> Vec<Diagnostic> {
    let Some(rating) = t.rating.filter(|_| !t.hydraulics().elements.is_empty()) else {
        return Vec::new();
    };
    let mut found: Vec<Diagnostic> = Vec::new();
    // Smallest flow through each relief valve while its pump runs.
    let mut relieved: Vec<Option<f64>> = vec![None; t.hydraulics().elements.len()];
    for (i, state) in t.states().iter().enumerate() {
        let speeds = [rating.speed, SLOW * rating.speed];
        t.at_reference(i, speeds.map(|speed| [speed, 0.0]), |[speed, _], solution| {
            let Some(supply) = solution.oil_supply() else { return };
            for (least, element) in relieved.iter_mut().zip(&supply.elements) {
                if let Some(flow) = element.relieved.filter(|_| element.flow > 0.0) {
                    *least = Some(least.map_or(flow, |least: f64| least.min(flow)));
                }
            }
            for finding in supply.findings {
                if found.iter().all(|known| known.path != finding.path) {
                    let place = format!("at {} rpm in `{}`", significant(speed * RPM), state.name);
                    found.push(
                        Diagnostic::warning(finding.path, format!("{place}: {}", finding.message))
                            .help(finding.help)
                            .code(codes::OIL_SUPPLY),
                    );
                }
            }
        });
    }
    for (element, flow) in t.hydraulics().elements.iter().zip(relieved) {
        if let Some(flow) = flow.filter(|flow| *flow > 0.0) {
            let message = format!(
                "its relief valve passes at least {} l/min, even at a tenth of the rated speed: it never closes",
                significant(flow * 6e4)
            );
            found.push(
                Diagnostic::warning(element.path.clone(), message)
                    .help("use a smaller pump or a higher opening pressure, or check nozzles and pipes")
                    .code(codes::OIL_SUPPLY),
            );
        }
    }
    found
}

/// Bearings with insufficient static safety at the rated torque and speed, in any gear, in drive and coast.
pub fn overloaded(t: &Transmission) -> Vec<Note> {
    let seen = at_the_rating(t, |_| {});
    if seen.is_empty() {
        return Vec::new();
    }
    let safety = |note: &Note| note.name == STATIC_SAFETY;
    notes(t, &seen).into_iter().filter(safety).collect()
}

/// Warnings for bearings that no oil reaches at the rated speed in any gear.
pub fn dry_bearings(checked: &CheckedGearbox) -> Vec<Diagnostic> {
    above_the_oil(checked)
        .into_iter()
        .chain(unfed_bearings(checked))
        .collect()
}

/// Those in the oil of the housing: the level while rotating is below them, and no gear in the oil is fast enough to throw oil at them.
fn above_the_oil(checked: &CheckedGearbox) -> Vec<Diagnostic> {
    let t = &checked.transmission;
    let bearings = &checked.resolved.value[Bearing::SECTION];
    let sump = &checked.resolved.value["housing"]["oil"]["lubricant"];
    let from_sump = |path: &str| {
        let entry = &bearings[path.split('.').nth(1).unwrap_or_default()];
        let oil = &entry["lubricant"];
        entry["oil_height"].is_null() && entry["lubrication"] != "grease" && (oil.is_null() || oil == sump)
    };
    let parts = t.parts().iter().enumerate();
    let parts = parts.filter(|(_, part)| part.mechanism == Bearing::KEY && from_sump(&part.path));
    let mut asked: Vec<(usize, &str)> = parts.map(|(i, part)| (i, part.path.as_str())).collect();
    let mut last = None;
    at_the_rating(t, |solution| {
        let found = solution.oil_levels();
        let slow = found.and_then(|levels| Some((levels.running, levels.estimate?.rim?)));
        match slow.filter(|(_, rim)| *rim < LEAST_SPLASH) {
            Some(found) => {
                last = Some(found);
                asked.retain(|(i, _)| {
                    let readings = solution.readings(*i);
                    readings
                        .iter()
                        .any(|reading| reading.name == "oil_height" && reading.value == 0.0)
                });
            }
            None => asked.clear(),
        }
    });
    let Some((level, rim)) = last else { return Vec::new() };
    let warning = |(_, path): (usize, &str)| {
        let message = format!(
            "no oil reaches the bearing at the rated speed: the level is {} mm, and the fastest gear in the oil has {} m/s of the {LEAST_SPLASH} m/s \
             from which gears splash",
            figures(level * 1e3, 4),
            figures(rim, 4)
        );
        Diagnostic::warning(path, message)
            .help("raise the level, or state `oil_height` if the bearing gets its oil in another way")
            .code(codes::OIL_LEVEL)
    };
    asked.into_iter().map(warning).collect()
}

/// Those that the oil of the sump does not reach (`fed: false`) and into whose pocket nothing flows at the rated speed.
fn unfed_bearings(checked: &CheckedGearbox) -> Vec<Diagnostic> {
    let t = &checked.transmission;
    let bearings = &checked.resolved.value[Bearing::SECTION];
    let entry = |path: &str| &bearings[path.split('.').nth(1).unwrap_or_default()];
    let parts = t.parts().iter().filter(|part| part.mechanism == Bearing::KEY);
    let mut asked: Vec<(&str, f64)> = parts
        .map(|part| {
            part.path
                .split_once(".model")
                .map_or(part.path.as_str(), |(bearing, _)| bearing)
        })
        .filter(|path| entry(path)["fed"] == false && entry(path)["lubrication"] != "grease")
        .map(|path| (path, 0.0))
        .collect();
    if asked.is_empty() {
        return Vec::new();
    }
    let mut level = None;
    at_the_rating(t, |solution| {
        level = solution.oil_levels().map(|levels| levels.running);
        for pocket in solution.pockets() {
            for (_, most) in asked.iter_mut().filter(|(path, _)| *path == pocket.bearing) {
                *most = most.max(pocket.inflow);
            }
        }
    });
    let level = level.map_or_else(String::new, |level| format!(" at {} mm", figures(level * 1e3, 4)));
    let dry = asked.into_iter().filter(|(path, inflow)| {
        // Without a rated speed nothing is known of the flow into a pocket.
        *inflow == 0.0 && (t.rating.is_some() || entry(path)["pocket"].is_null())
    });
    let warning = |(path, _)| {
        let pocket = if entry(path)["pocket"].is_null() {
            "it has no pocket"
        } else {
            "0 l/min flow into its pocket at the rated speed"
        };
        let message =
            format!("no oil reaches the bearing: `fed: false` keeps the oil of the sump{level} from it, and {pocket}");
        Diagnostic::warning(path, message)
            .help("add `pocket` with what feeds it, state `oil_height`, or remove `fed: false`")
            .code(codes::OIL_LEVEL)
    };
    dry.map(warning).collect()
}

/// Windows through which no gear throws oil at the rated speed in any gear.
fn missed_windows(t: &Transmission) -> Vec<Diagnostic> {
    let mut asked: Vec<(String, WindowFlow)> = Vec::new();
    at_the_rating(t, |solution| {
        for pocket in solution.pockets() {
            let Some(window) = pocket.window else { continue };
            match asked.iter_mut().find(|(path, _)| path == pocket.bearing) {
                Some((_, most)) if window.flow > most.flow => *most = window,
                // Where oil meets the wall says more than where none does.
                Some((_, most)) if most.flow == 0.0 && most.meets == [0.0; 2] => *most = window,
                Some(_) => {}
                None => asked.push((pocket.bearing.to_owned(), window)),
            }
        }
    });
    let missed = asked.into_iter().filter(|(_, window)| window.flow <= 0.0);
    let warning = |(path, window): (String, WindowFlow)| {
        let mm = |x: f64| significant(x * 1e3);
        let ([low, high], [bottom, top]) = (window.meets, window.edges);
        let flight = if window.meets == [0.0; 2] {
            "no oil of its gear meets the wall".to_owned()
        } else {
            format!(
                "the oil of its gear meets the wall {} to {} mm above its axis, the window is {} to {} mm above it",
                mm(low),
                mm(high),
                mm(bottom),
                mm(top)
            )
        };
        Diagnostic::warning(
            format!("{path}.pocket.window"),
            format!("no oil comes through the window at the rated speed: {flight}"),
        )
        .help("move the window, name another gear, or check the sense of rotation and the oil level")
        .code(codes::MISSED_WINDOW)
    };
    missed.map(warning).collect()
}

/// A quantity of a rating that is outside its bound at the rated torque and speed.
#[derive(Debug, Clone)]
pub struct OutOfBound {
    /// Path of the component.
    pub component: String,
    /// Name of the rating.
    pub rating: &'static str,
    /// The quantity with its worst value.
    pub quantity: RatedQuantity,
}

/// Quantities of ratings outside their bounds at the rated torque and speed, in any gear, in drive and coast, each with its worst value;
/// without those that [`overloaded`] reports.
pub fn out_of_bounds(checked: &CheckedGearbox) -> Vec<OutOfBound> {
    let t = &checked.transmission;
    let mut worst: Vec<OutOfBound> = Vec::new();
    at_the_rating(t, |solution| {
        for rated in rated(&checked.ratings, t, solution) {
            for quantity in rated.quantities.into_iter().filter(|quantity| quantity.outside) {
                let known = worst.iter_mut().find(|known| {
                    known.component == rated.component
                        && known.rating == rated.rating
                        && known.quantity.symbol == quantity.symbol
                });
                match known {
                    Some(known) if quantity.excess() > known.quantity.excess() => known.quantity = quantity,
                    Some(_) => {}
                    None => worst.push(OutOfBound {
                        component: rated.component.clone(),
                        rating: rated.rating,
                        quantity,
                    }),
                }
            }
        }
    });
    let reported = overloaded(t);
    worst.retain(|left| {
        let same = |note: &&Note| note.path == left.component && note.meaning == left.quantity.meaning;
        !reported.iter().any(|note| same(&note))
    });
    worst
}
