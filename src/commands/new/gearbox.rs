//! `new gearbox`: a gearbox with a common layout.

use std::path::Path;

use clap::ValueEnum;
use gearloss_framework::language::Kind;

use super::{print_next, word, write, write_schema};
use crate::args::{Layout, NewGearboxArgs};
use crate::output::{End, Failure, Out};

/// A template with a typical operating point.
struct Start {
    text: &'static str,
    point: &'static str,
}

impl Start {
    fn for_layout(layout: Layout) -> Self {
        let (text, point) = match layout {
            Layout::SingleStage => (
                include_str!("layouts/single-stage.yaml"),
                "--torque \"90 Nm\" --speed \"1500 rpm\"",
            ),
            Layout::TwoStage => (
                include_str!("layouts/two-stage.yaml"),
                "--torque \"45 Nm\" --speed \"1500 rpm\"",
            ),
            Layout::Planetary => (
                include_str!("layouts/planetary.yaml"),
                "--gear reducing --torque \"60 Nm\" --speed \"3000 rpm\"",
            ),
            Layout::TwoSpeed => (
                include_str!("layouts/two-speed.yaml"),
                "--gear first --torque \"80 Nm\" --speed \"3000 rpm\"",
            ),
            Layout::DualCountershaft => (
                include_str!("layouts/dual-countershaft.yaml"),
                "--torque \"400 Nm\" --speed \"1500 rpm\"",
            ),
        };
        Self { text, point }
    }
}

pub fn run(args: &NewGearboxArgs, out: &mut Out) -> Result<End, Failure> {
    let Some(layout) = args.layout else {
        return Err(unnamed());
    };
    let start = Start::for_layout(layout);
    let file = args.output.as_path();
    write(file, start.text, out)?;
    write_schema(
        file,
        super::super::language()?,
        Kind::Gearbox,
        "gearbox.schema.json",
        out,
    )?;
    let name = word(file);
    print_next(
        &[
            format!("check {name}"),
            format!("solve {name} {}", start.point),
            study_of(file),
        ],
        out,
    )?;
    Ok(End::Fine)
}

/// The command for a study in the folder of the gearbox.
fn study_of(file: &Path) -> String {
    let mut command = "new study".to_owned();
    if file != Path::new("gearbox.yaml") {
        command += &format!(" --gearbox {}", word(file));
    }
    let study = file.with_file_name("study.yaml");
    if study != Path::new("study.yaml") {
        command += &format!(" -o {}", word(&study));
    }
    command
}

fn unnamed() -> Failure {
    let mut help = "choose one: gearloss new gearbox LAYOUT, with".to_owned();
    for layout in Layout::value_variants().iter().filter_map(ValueEnum::to_possible_value) {
        let about = layout.get_help().map(ToString::to_string).unwrap_or_default();
        help += &format!("\n      {:<19}{about}", layout.get_name());
    }
    Failure::input("no layout is given", help)
}
