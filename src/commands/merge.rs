//! `merge`: merges the parts of `run --shard` into the results of the whole study.

use super::run::{all, gather, read};
use crate::args::MergeArgs;
use crate::output::{End, Failure, Out};

pub fn run(args: &MergeArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let study = read(language, &args.study)?;
    let tasks = gather(language, &study, &args.parts, &args.study)?;
    all(language, &study, Some(&tasks), &args.results, out)
}
