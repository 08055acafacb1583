//! A study of a gearbox, from a template.

use std::path::Path;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;
use gearloss_report::text::significant;

use crate::answer::Fault;

/// The template of the study; words in capitals are placeholders.
const STUDY: &str = include_str!("study.yaml");

/// The shipped model sets that the study compares.
const SHIPPED: [&str; 2] = ["iso14179_2", "joint"];

/// Data of a gearbox for the template.
#[derive(Debug, Clone, PartialEq)]
pub struct NewStudy {
    /// The first gear that transmits torque.
    pub gear: String,
    /// Port of torque and speed.
    pub port: String,
    mesh: Option<String>,
    /// Torque in Nm and speed in rpm; without a rating those of the study are placeholders.
    pub rating: Option<[f64; 2]>,
    /// The first shipped model set that the gearbox has not all inputs for; the study then has no comparison.
    pub unfit: Option<&'static str>,
}

impl NewStudy {
    /// The study of a gearbox.
    ///
    /// # Errors
    /// Findings of the gearbox; that no gear is determined by torque and speed at one port.
    pub fn new(language: &Language, gearbox: &Gearbox) -> Result<Self, Fault> {
        let transmission = gearbox.transmission(language, &Choice::default())?;
        let fits = |set: &str| gearbox.transmission(language, &Choice::of_set(set)).is_ok();
        let unfit = SHIPPED.into_iter().find(|set| !fits(set));
        Ok(Self::from_transmission(&transmission, unfit)?)
    }

    fn from_transmission(transmission: &Transmission, unfit: Option<&'static str>) -> Result<Self, Diagnostic> {
        let port = transmission.ports()[transmission.reference_port()].name.clone();
        // A gear transmits torque if torque and speed at one port determine a point; neutral needs the speeds of both ports.
        let drives = |gear: &str| transmission.case(gear, &[port.as_str()], &[port.as_str()]).is_ok();
        let Some(state) = transmission.states().iter().find(|state| drives(&state.name)) else {
            let message = format!("no gear is determined by torque and speed at `{port}` alone");
            return Err(Diagnostic::error("", message).help("define a gear that connects this port to another"));
        };
        Ok(Self {
            gear: state.name.clone(),
            mesh: transmission
                .cylindrical_meshes()
                .next()
                .map(|(_, path, _)| path.trim_start_matches("meshes.").to_owned())
                .or_else(|| {
                    let mut crossed = transmission.crossed_meshes();
                    crossed.find_map(|(path, _)| path.strip_prefix("bevel_meshes.").map(str::to_owned))
                }),
            rating: transmission.rating.as_ref().map(|r| [r.torque, r.speed.rpm()]),
            port,
            unfit,
        })
    }

    /// The text; `gearbox` is the file relative to the study.
    pub fn text(&self, gearbox: &Path) -> String {
        let (axes, half) = match self.rating {
            Some([torque, speed]) => (
                [parts_of(torque, "Nm"), parts_of(speed, "rpm")],
                [0.5 * torque, 0.5 * speed],
            ),
            None => (
                [
                    "[5 Nm, 10 Nm, 20 Nm, 50 Nm]".to_owned(),
                    "[500 rpm, 1000 rpm, 2000 rpm]".to_owned(),
                ],
                [20.0, 1000.0],
            ),
        };
        let words = [
            ("HALF_TORQUE", Some(format!("{} Nm", significant(half[0])))),
            ("HALF_SPEED", Some(format!("{} rpm", significant(half[1])))),
            ("TORQUES", Some(axes[0].clone())),
            ("SPEEDS", Some(axes[1].clone())),
            ("GEARBOX", Some(scalar(&gearbox.to_string_lossy().replace('\\', "/")))),
            ("SHIPPED", self.unfit.is_none().then(|| SHIPPED[0].to_owned())),
            ("MESH", self.mesh.as_deref().map(scalar)),
            ("GEAR", Some(scalar(&self.gear))),
            ("PORT", Some(scalar(&self.port))),
        ];
        STUDY.lines().map(|line| filled(line, &words) + "\n").collect()
    }
}

/// A tenth, a quarter, half, three quarters and all of a rated value, as a list.
fn parts_of(rated: f64, unit: &str) -> String {
    let value = |part: f64| format!("{} {unit}", significant(part * rated));
    format!("[{}]", [0.1, 0.25, 0.5, 0.75, 1.0].map(value).join(", "))
}

/// A line of the template with its placeholders replaced, once and from left to right, so that names of the gearbox are never treated as
/// placeholders. A line without a value for its placeholder becomes a comment.
fn filled(line: &str, words: &[(&str, Option<String>)]) -> String {
    let mut text = String::new();
    let mut rest = line;
    loop {
        let first = words
            .iter()
            .filter_map(|(word, value)| rest.find(word).map(|at| (at, *word, value)))
            .min_by_key(|(at, word, _)| (*at, usize::MAX - word.len()));
        let Some((at, word, value)) = first else {
            return text + rest;
        };
        text += &rest[..at];
        match value {
            Some(value) => text += value,
            None => return "  # (omitted: not applicable to this gearbox)".to_owned(),
        }
        rest = &rest[at + word.len()..];
    }
}

/// A text as one YAML value, quoted unless it is unambiguous.
fn scalar(text: &str) -> String {
    const WORDS: [&str; 3] = ["true", "false", "null"];
    let begins =
        text.starts_with(|c: char| c.is_ascii_alphabetic()) || text.starts_with("../") || text.starts_with('/');
    let plain = begins
        && text.chars().all(|c| c.is_ascii_alphanumeric() || "_-./".contains(c))
        && !WORDS.contains(&text.to_ascii_lowercase().as_str());
    if plain {
        text.to_owned()
    } else {
        serde_json::Value::from(text).to_string()
    }
}
