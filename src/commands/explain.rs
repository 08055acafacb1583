//! `explain`: every step of the loss of one component, in the symbols and units of the source.

use gearloss_framework::gearbox::Gearbox;
use gearloss_report::point::Explained;

use super::point::prepare;
use super::{set, warn};
use crate::args::ExplainArgs;
use crate::output::{End, Failure, Out};

pub fn run(args: &ExplainArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let gearbox = Gearbox::read(language, &args.gearbox)?;
    let resolved = set::resolve(language, &gearbox, &args.choice)?;
    let transmission = gearbox.build(language, &resolved)?;
    warn(&gearbox, &transmission)?;
    let explained = Explained::named(&transmission, &args.component)?;
    let prepared = prepare(&args.point, &gearbox, &transmission)?;
    let mut scratch = transmission.scratch(&prepared.case);
    let solved = prepared.solve(&transmission, &mut scratch);
    let ratings = gearbox.ratings(language, &resolved, &transmission)?;
    out.text(&explained.text((&gearbox, &resolved, &transmission), &ratings, &prepared, &solved))?;
    Ok(End::Fine)
}
