//! `new study`: a study of a gearbox.

use std::path::{Path, PathBuf};

use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Kind;
use gearloss_workbench::form::NewStudy;

use super::{folder, print_next, word, write, write_schema};
use crate::args::NewStudyArgs;
use crate::output::{End, Failure, Out};

pub fn run(args: &NewStudyArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::super::language()?;
    if !args.gearbox.is_file() {
        return Err(Failure::input(
            format!("the gearbox {} does not exist", args.gearbox.display()),
            "create one with `gearloss new gearbox LAYOUT`, or give yours with --gearbox",
        ));
    }
    let gearbox = Gearbox::read(language, &args.gearbox)?;
    let start = NewStudy::new(language, &gearbox).map_err(|fault| {
        let help = fault.help.unwrap_or_default();
        Failure::input(fault.message, help)
    })?;
    let file = args.output.as_path();
    let path = seen_from(folder(file), &args.gearbox);
    write(file, &start.text(&path), out)?;
    write_schema(file, language, Kind::Study, "study.schema.json", out)?;
    out.line(format!(
        "gear `{}`, the first that transmits torque; torque and speed at `{}`",
        start.gear, start.port
    ))?;
    if let Some(set) = start.unfit {
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
