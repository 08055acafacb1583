//! How the gears of cycles are chosen: read from a study, with its files.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::transmission::Transmission;

use crate::analyses::{Planner, Stopped};
use crate::codes;
use crate::duty::ShiftMap;
use crate::points::{ChosenBy, GearChoice, Rule};
use crate::study::{BEST, Choose, ChosenGear, CycleGear};

/// The gear of cycles without one.
#[derive(Clone, Copy)]
pub enum GearOfCycles<'a> {
    /// By its name, or `best`.
    Named(&'a str),
    /// Chosen.
    Chosen(&'a ChosenGear),
}

impl<'a> From<&'a CycleGear> for GearOfCycles<'a> {
    fn from(gear: &'a CycleGear) -> Self {
        match gear {
            CycleGear::Name(name) => Self::Named(name),
            CycleGear::Chosen(chosen) => Self::Chosen(chosen),
        }
    }
}

/// The gear of points, which is not chosen; absent: the first.
///
/// # Errors
/// If it is chosen.
pub fn stated_gear<'a>(cx: &Planner<'_>, gear: Option<&'a CycleGear>) -> Result<Option<&'a str>, Stopped> {
    let name = gear.map(GearOfCycles::from).map(GearOfCycles::name);
    match name {
        Some(None) => Err(cx.wrong_as(
            codes::GEAR_CHOICE,
            &format!("{}.gear", cx.path()),
            "gears are chosen in cycles and maps, not at points",
            "name a gear, or write `drive: { cycles: [NAME] }`",
        )),
        name => Ok(name.flatten()),
    }
}

impl<'a> GearOfCycles<'a> {
    /// The gear by its name; absent if it is chosen.
    pub fn name(self) -> Option<&'a str> {
        match self {
            Self::Named(name) if name != BEST => Some(name),
            _ => None,
        }
    }

    /// The gear or its choice in a word.
    pub fn word(self) -> &'a str {
        match self {
            Self::Named(name) => name,
            Self::Chosen(chosen) => match chosen.choose {
                Some(Choose::Best) => BEST,
                Some(Choose::Optimum) => "optimum",
                None => "map",
            },
        }
    }

    /// The choice; absent if a gear is stated. `path` is the place of the gear.
    ///
    /// # Errors
    /// If keys contradict each other, or the map cannot be read.
    pub fn choice(self, cx: &Planner<'_>, path: &str) -> Result<Option<GearChoice>, Stopped> {
        let by_rule = ChosenGear {
            choose: Some(Choose::Best),
            ..ChosenGear::default()
        };
        let chosen = match self {
            Self::Named(name) if name == BEST => &by_rule,
            Self::Named(_) => return Ok(None),
            Self::Chosen(chosen) => chosen,
        };
        let wrong = |key: &str, message: String, help: &str| {
            let at = if key.is_empty() {
                path.to_owned()
            } else {
                format!("{path}.{key}")
            };
            cx.wrong_as(codes::GEAR_CHOICE, &at, message, help)
        };
        let rule = Rule {
            saving: chosen.saving.unwrap_or(0.0),
            dwell: chosen.dwell.unwrap_or(0.0),
        };
        let by = match (chosen.choose, &chosen.map) {
            (Some(Choose::Best), None) => ChosenBy::Rule(rule),
            (Some(Choose::Optimum), None) => ChosenBy::Optimum(rule),
            (None, Some(map)) => {
                let unused = [
                    ("saving", chosen.saving.is_some()),
                    ("dwell", chosen.dwell.is_some()),
                    ("most_speed", chosen.most_speed.is_some()),
                    ("most_torque", chosen.most_torque.is_some()),
                    ("gears", !chosen.gears.is_empty()),
                ];
                if let Some((key, _)) = unused.iter().find(|(_, is_stated)| *is_stated) {
                    let message = format!("`{key}` has no effect beside `map`, which states the gears");
                    return Err(wrong(
                        key,
                        message,
                        "delete it, or write `choose: best` instead of `map`",
                    ));
                }
                ChosenBy::Map(shift_map(cx, &format!("{path}.map"), map)?)
            }
            _ => {
                let message = "a choice of gears needs either `choose` or `map`".to_owned();
                let help = "write `choose: best`, `choose: optimum` or `map: shift.csv`";
                return Err(wrong("", message, help));
            }
        };
        Ok(Some(GearChoice {
            by,
            among: chosen.gears.clone(),
            shift_energy: chosen.shift_energy,
            actuation: chosen.actuation,
            most_speed: chosen.most_speed,
            most_torque: chosen.most_torque,
            place: path.to_owned(),
        }))
    }
}

/// Reads a map of gears.
fn shift_map(
    cx: &Planner<'_>,
    path: &str,
    map: &gearloss_framework::document::data::TableFile,
) -> Result<ShiftMap, Stopped> {
    let file = map.name();
    let bytes = cx.study.read_file(file).map_err(|reason| {
        let message = format!("cannot read {file}: {reason}");
        cx.wrong_as(codes::SHIFT_MAP, path, message, "check the file name")
    })?;
    cx.keep_input(file, &bytes);
    ShiftMap::read(map, &bytes).map_err(|faults| {
        let of_file = |fault: gearloss_framework::document::data::MeasuredFault| {
            let error = Diagnostic::error(path, format!("{file}: {}", fault.message));
            error.help(fault.help).code(codes::SHIFT_MAP)
        };
        cx.found(faults.into_iter().map(of_file).collect())
    })
}

/// Refuses a map of gears that the gearbox does not have.
pub fn check_gears(cx: &Planner<'_>, choice: &GearChoice, t: &Transmission) -> Result<(), Stopped> {
    let ChosenBy::Map(map) = &choice.by else {
        return Ok(());
    };
    let names: Vec<&str> = t.states().iter().map(|state| state.name.as_str()).collect();
    let unknown = map.gears().iter().find(|(gear, _)| !names.contains(&gear.as_str()));
    let Some((gear, line)) = unknown else {
        return Ok(());
    };
    let path = format!("{}.map", choice.place);
    let message = format!("line {line}: the gearbox has no gear state `{gear}`");
    let help = format!("there are: {}", names.join(", "));
    Err(cx.wrong_as(codes::SHIFT_MAP, &path, message, &help))
}
