//! What `run` prints: a line with the result of each analysis, or all tables.

use std::io;
use std::path::Path;
use std::time::Instant;

use gearloss_report::limits;
use gearloss_report::page::{Block, Page};
use gearloss_report::stated_ranges::StatedRanges;
use gearloss_studies::analyses::limits::reached::LimitReached;

use crate::args::ShownArgs;
use crate::output::Out;

/// Lines on quantities outside their ranges.
const WORST: usize = 3;

/// How much is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// Nothing, for `check`.
    Nothing,
    /// Errors, warnings and the path of the report.
    Path,
    /// A line for each analysis.
    Headlines,
    /// All tables and notes, too.
    Everything,
}

impl Shown {
    pub fn new(args: ShownArgs) -> Self {
        match (args.quiet, args.verbose) {
            (true, _) => Self::Path,
            (_, true) => Self::Everything,
            _ => Self::Headlines,
        }
    }

    /// Width of the names of analyses.
    pub fn width(names: &[&str]) -> usize {
        let longest = names.iter().map(|name| name.len()).max();
        longest.unwrap_or(0).max("careful".len())
    }

    /// The path of the report.
    pub fn report(self, file: &Path, out: &mut Out) -> io::Result<()> {
        let size = std::fs::metadata(file).map_or(0.0, |file| file.len() as f64);
        let hint = match self {
            Self::Headlines => "; --verbose prints the tables",
            Self::Nothing | Self::Path | Self::Everything => "",
        };
        out.line(format!("report: {} ({:.1} MB){hint}", file.display(), 1e-6 * size))
    }

    /// Whether a line of an analysis is printed.
    pub fn has_headlines(self) -> bool {
        matches!(self, Self::Headlines | Self::Everything)
    }

    /// The details of an outcome.
    pub fn page(self, page: &Page, out: &mut Out) -> io::Result<()> {
        if self != Self::Everything {
            return Ok(());
        }
        for block in &page.blocks {
            match block {
                Block::Text(text) => out.text(text)?,
                Block::Table(table) => out.text(&table.render())?,
            }
        }
        Ok(())
    }

    /// The result of an analysis, with its time on a terminal.
    pub fn headline(self, width: usize, name: &str, result: &str, since: Instant, out: &mut Out) -> io::Result<()> {
        if !self.has_headlines() {
            return Ok(());
        }
        let time = if out.is_terminal() {
            format!("{:>6.1} s  ", since.elapsed().as_secs_f64())
        } else {
            String::new()
        };
        out.line(format!("  {name:width$}  {time}{result}"))
    }

    /// Limits of the study that are not kept, each with the name of its analysis.
    pub fn limits(self, width: usize, broken: &[(String, LimitReached)], out: &mut Out) -> io::Result<()> {
        for (analysis, limit) in broken.iter().filter(|_| self.has_headlines()) {
            out.line(format!("  {:width$}  {analysis}: {}", "limit", limits::sentence(limit)))?;
        }
        Ok(())
    }

    /// Quantities outside their stated ranges: all of them, or the worst.
    pub fn outside(self, width: usize, ranges: &StatedRanges, out: &mut Out) -> io::Result<()> {
        if self == Self::Everything {
            for line in ranges.lines() {
                out.line(line)?;
            }
        }
        if !self.has_headlines() {
            return Ok(());
        }
        let all = ranges.worst();
        for (i, line) in all.iter().take(WORST).enumerate() {
            let name = if i == 0 { "careful" } else { "" };
            out.line(format!("  {name:width$}  {line}"))?;
        }
        if all.len() > WORST {
            let more = all.len() - WORST;
            let plural = if more == 1 { "quantity" } else { "quantities" };
            out.line(format!(
                "  {:width$}  {more} more {plural} outside their ranges: see the report",
                ""
            ))?;
        }
        Ok(())
    }
}
