//! `new gearbox`: a gearbox with a common layout.

use std::path::Path;

use gearloss_framework::language::{DESCRIBE_THE_REST, Kind, undescribed_stage};
use gearloss_workbench::form::{LAYOUTS, Layout};

use super::{print_next, word, write, write_schema};
use crate::args::NewGearboxArgs;
use crate::output::{End, Failure, Out};

pub fn run(args: &NewGearboxArgs, out: &mut Out) -> Result<End, Failure> {
    let Some(layout) = args.layout.as_deref().and_then(Layout::named) else {
        return Err(args.layout.as_deref().map_or_else(unnamed, undescribed));
    };
    let file = args.output.as_path();
    write(file, layout.text, out)?;
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
            format!("solve {name} {}", layout.point),
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

/// Names that are asked for, and the layout that has their stage.
const NEAREST: [(&str, &str); 3] = [("bevel", "bevel-helical"), ("hypoid", "axle"), ("helical-worm", "worm")];

/// A layout that does not exist, or whose physics is not modelled.
fn undescribed(layout: &str) -> Failure {
    if let Some((_, nearest)) = NEAREST.iter().find(|(name, _)| *name == layout) {
        return Failure::input(
            format!("no layout is called `{layout}`"),
            format!("start with `gearloss new gearbox {nearest}`, which has such a stage"),
        );
    }
    let stage = undescribed_stage(layout).unwrap_or("such gearboxes");
    Failure::input(format!("{stage} cannot be described yet"), DESCRIBE_THE_REST)
}

fn unnamed() -> Failure {
    let mut help = "choose one: gearloss new gearbox LAYOUT, with".to_owned();
    for layout in LAYOUTS {
        help += &format!("\n      {:<19}{}", layout.name, layout.about);
    }
    Failure::input("no layout is given", help)
}
