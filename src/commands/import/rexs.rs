//! `import rexs`: a gearbox and a study from a REXS model.

use std::path::{Path, PathBuf};

use gearloss_exchange::rexs::{self, LONGEST_MODEL};
use gearloss_framework::files::read_bytes;
use gearloss_framework::language::Kind;

use super::super::new::{print_next, word, write, write_schema};
use crate::output::{End, Failure, Out};

pub fn run(file: &Path, output: Option<&Path>, out: &mut Out) -> Result<End, Failure> {
    let bytes = read_bytes(file, LONGEST_MODEL)
        .map_err(|e| Failure::input(format!("cannot read {}: {e}", file.display()), "check the file name"))?;
    let language = super::super::language()?;
    let imported = rexs::import(&bytes, &file.display().to_string(), language)?;
    for warning in &imported.warnings.list {
        Out::error().line(format!("{}\n", imported.warnings.sources.render(warning)))?;
    }
    let folder = output.map_or_else(
        || PathBuf::from(rexs::title(&file.display().to_string())),
        Path::to_path_buf,
    );
    let shares = imported.shares.iter().map(|(name, text)| (name.as_str(), Some(text)));
    let texts: Vec<(PathBuf, &str)> = [
        ("gearbox.yaml", Some(&imported.gearbox)),
        ("study.yaml", imported.study.as_ref()),
        ("load_cases.csv", imported.load_cases.as_ref()),
    ]
    .into_iter()
    .chain(shares)
    .filter_map(|(name, text)| Some((folder.join(name), text?.as_str())))
    .collect();
    // All or none, so that files of two models never lie side by side.
    if let Some((present, _)) = texts.iter().find(|(path, _)| path.exists()) {
        return Err(Failure::input(
            format!("{} exists and is not overwritten", present.display()),
            "choose another folder with -o",
        ));
    }
    std::fs::create_dir_all(&folder).map_err(|e| {
        Failure::input(
            format!("cannot create the folder {}: {e}", folder.display()),
            "choose another folder with -o",
        )
    })?;
    for (path, text) in &texts {
        write(path, text, out)?;
    }
    let gearbox = folder.join("gearbox.yaml");
    write_schema(&gearbox, language, Kind::Gearbox, "gearbox.schema.json", out)?;
    let mut next = vec![format!("check {}", word(&gearbox))];
    if imported.study.is_some() {
        let study = folder.join("study.yaml");
        write_schema(&study, language, Kind::Study, "study.schema.json", out)?;
        next.push(format!("run {}", word(&study)));
    } else {
        next.push(format!(
            "new study --gearbox {} -o {}",
            word(&gearbox),
            word(&folder.join("study.yaml"))
        ));
    }
    out.line("")?;
    for line in &imported.report {
        out.line(line)?;
    }
    out.line("")?;
    print_next(&next, out)?;
    Ok(End::Fine)
}
