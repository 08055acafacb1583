//! `import`: gearboxes, studies and tables from files of other programs.

mod bearings;
mod openfoam;
mod rexs;

use crate::args::{ImportArgs, ImportFrom};
use crate::output::{End, Failure, Out};

pub fn run(args: &ImportArgs, out: &mut Out) -> Result<End, Failure> {
    match &args.from {
        ImportFrom::Rexs { file, output } => rexs::run(file, output.as_deref(), out),
        ImportFrom::Bearings(args) => bearings::run(args, out),
        ImportFrom::OpenfoamForces(args) => openfoam::run(args, out),
    }
}
