//! `report`: makes the report of a run again from its files, without computing anything.

use gearloss_framework::files::{LONGEST_DATA, read_bytes};

use super::run::{CONTENT, REPORT, Template, page};
use crate::args::ReportArgs;
use crate::output::{End, Failure, Out};

pub fn run(args: &ReportArgs, out: &mut Out) -> Result<End, Failure> {
    let template = args.template.as_deref().map(Template::read).transpose()?;
    let file = args.results.join(CONTENT);
    let content = read_bytes(&file, LONGEST_DATA).map_err(|error| {
        Failure::input(
            format!(
                "{} is not a folder of results: cannot read {}: {error}",
                args.results.display(),
                file.display()
            ),
            "give the folder that `gearloss run` has written",
        )
    })?;
    let content = serde_json::from_slice(&content).map_err(|fault| {
        Failure::input(
            format!("{} is not the content of a report: {fault}", file.display()),
            "run the study again",
        )
    })?;
    let to = args.output.clone().unwrap_or_else(|| args.results.join(REPORT));
    std::fs::write(&to, page(content, template.as_ref())?).map_err(|error| {
        Failure::input(
            format!("cannot write {}: {error}", to.display()),
            "choose another file with -o",
        )
    })?;
    out.line(to.display().to_string())?;
    Ok(End::Fine)
}
