//! `open`: the workbench in the browser.

use gearloss_workbench::disk::Folder;
use gearloss_workbench::drafts::state_folder;
use gearloss_workbench::{Served, serve};

use super::browser;
use crate::args::OpenArgs;
use crate::output::{End, Failure, Out};

/// Serves until the last page is closed, or until it is interrupted.
pub fn run(args: &OpenArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let folder = Folder::open(&args.path).map_err(|error| {
        Failure::input(
            format!("cannot open {}: {error}", args.path.display()),
            "give a folder, or a gearbox or study in it",
        )
    })?;
    let folder = folder.with_drafts(state_folder().as_deref());
    let served = Served::bind(folder, args.keep).map_err(|error| {
        Failure::input(
            format!("cannot serve on this computer: {error}"),
            "check whether programs may listen on 127.0.0.1",
        )
    })?;
    out.line(format!("workbench: {}", served.address()))?;
    out.line("It is for browsers on this computer only. Ctrl-C ends it.")?;
    if !args.no_browser
        && let Some(text) = browser::open(served.address()).err().and_then(|failure| failure.text())
    {
        Out::error().text(&text)?;
    }
    serve(language, served)
        .map_err(|error| Failure::input(format!("the workbench ended: {error}"), "start it again"))?;
    Ok(End::Fine)
}
