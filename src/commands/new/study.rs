//! `new study`: a study of a gearbox.

use std::path::{Path, PathBuf};

use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Kind;
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;

use super::{folder, print_next, word, write, write_schema};
use crate::args::NewStudyArgs;
use crate::output::{End, Failure, Out, figures};

/// The template of the study; words in capitals are placeholders.
const STUDY: &str = include_str!("study.yaml");

/// The shipped model sets that the study compares.
const SHIPPED: [&str; 2] = ["iso14179_2", "joint"];

pub fn run(args: &NewStudyArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::super::language()?;
    if !args.gearbox.is_file() {
        return Err(Failure::input(
            format!("the gearbox {} does not exist", args.gearbox.display()),
            "create one with `gearloss new gearbox LAYOUT`, or give yours with --gearbox",
        ));
    }
    let gearbox = Gearbox::read(language, &args.gearbox)?;
    let transmission = gearbox.transmission(language, &Choice::default())?;
    let fits = |set: &str| {
        let choice = Choice {
            set: Some(set.to_owned()),
            ..Choice::default()
        };
        gearbox.transmission(language, &choice).is_ok()
    };
    let unfit = SHIPPED.into_iter().find(|set| !fits(set));
    let start = Start::from_transmission(&transmission, unfit.is_none())?;
    let file = args.output.as_path();
    let path = seen_from(folder(file), &args.gearbox);
    write(file, &start.study(&path), out)?;
    write_schema(file, language, Kind::Study, "study.schema.json", out)?;
    out.line(format!(
        "gear `{}`, the first that transmits torque; torque and speed at `{}`",
        start.gear, start.port
    ))?;
    if let Some(set) = unfit {
        out.line(format!(
            "omitted the comparison of shipped model sets: `gearloss check {} --models {set}` lists the missing inputs",
            word(&args.gearbox)
        ))?;
    }
    if start.rating.is_none() {
        out.line("the gearbox has no `rating`: the torques and speeds in the study are placeholders, replace them")?;
    }
    let name = word(file);
    print_next(&[format!("check {name}"), format!("run {name}")], out)?;
    Ok(End::Fine)
}

/// Data of the gearbox for the template.
struct Start {
    gear: String,
    port: String,
    mesh: Option<String>,
    /// Torque in Nm and speed in rpm.
    rating: Option<[f64; 2]>,
    /// Whether the shipped model sets are applicable to the gearbox.
    shipped: bool,
}

impl Start {
    fn from_transmission(transmission: &Transmission, shipped: bool) -> Result<Self, Failure> {
        let port = transmission.ports()[transmission.reference_port()].name.clone();
        // A gear transmits torque if torque and speed at one port determine a point; neutral needs the speeds of both ports.
        let drives = |gear: &str| transmission.case(gear, &[port.as_str()], &[port.as_str()]).is_ok();
        let Some(state) = transmission.states().iter().find(|state| drives(&state.name)) else {
            return Err(Failure::input(
                format!("no gear is determined by torque and speed at `{port}` alone"),
                "define a gear that connects this port to another",
            ));
        };
        Ok(Self {
            gear: state.name.clone(),
            mesh: transmission
                .meshes()
                .next()
                .map(|(path, _)| path.trim_start_matches("meshes.").to_owned()),
            rating: transmission.rating.as_ref().map(|r| [r.torque, r.speed.rpm()]),
            port,
            shipped,
        })
    }

    /// The text of the study; `path` is the gearbox relative to the study.
    fn study(&self, gearbox: &Path) -> String {
        let (axes, half) = match self.rating {
            Some([torque, speed]) => {
                let shares = "{ of_rating: [0.1, 0.25, 0.5, 0.75, 1] }";
                ([shares, shares], [0.5 * torque, 0.5 * speed])
            }
            None => (
                ["[5 Nm, 10 Nm, 20 Nm, 50 Nm]", "[500 rpm, 1000 rpm, 2000 rpm]"],
                [20.0, 1000.0],
            ),
        };
        let words = [
            ("HALF_TORQUE", Some(format!("{} Nm", figures(half[0], 4)))),
            ("HALF_SPEED", Some(format!("{} rpm", figures(half[1], 4)))),
            ("TORQUES", Some(axes[0].to_owned())),
            ("SPEEDS", Some(axes[1].to_owned())),
            ("GEARBOX", Some(scalar(&gearbox.to_string_lossy().replace('\\', "/")))),
            ("SHIPPED", self.shipped.then(|| SHIPPED[0].to_owned())),
            ("MESH", self.mesh.as_deref().map(scalar)),
            ("GEAR", Some(scalar(&self.gear))),
            ("PORT", Some(scalar(&self.port))),
        ];
        STUDY.lines().map(|line| filled(line, &words) + "\n").collect()
    }
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

/// A file relative to a folder, both relative to the current folder; unchanged without a common root.
fn seen_from(folder: &Path, file: &Path) -> PathBuf {
    let (Ok(from), Ok(to)) = (folder.canonicalize(), file.canonicalize()) else {
        return file.to_path_buf();
    };
    let common = from
        .components()
        .zip(to.components())
        .take_while(|(a, b)| a == b)
        .count();
    if file.is_absolute() || common == 0 {
        return file.to_path_buf();
    }
    let up = from.components().skip(common).map(|_| "..");
    up.map(PathBuf::from)
        .chain(to.components().skip(common).map(|c| PathBuf::from(c.as_os_str())))
        .collect()
}
