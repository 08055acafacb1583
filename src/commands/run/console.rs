//! What `run` prints: a line with the result of each analysis, or all tables.

use std::io;
use std::path::Path;
use std::time::Instant;

use gearloss_report::limits;
use gearloss_report::page::{Block, Page};
use gearloss_report::stated_ranges::StatedRanges;
use gearloss_report::text::with_printed_units;
use gearloss_studies::limits::reached::LimitReached;

use crate::args::ShownArgs;
use crate::output::Out;

/// Lines on quantities outside their ranges.
const WORST: usize = 3;
/// Length of a line that does not answer the question of the study; its rest is in the report.
const LENGTH: usize = 160;

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

    /// The result of an analysis, with its time on a terminal: a mark and the whole result if it answers the question of the study, else
    /// what fits a line.
    pub fn headline(
        self,
        (width, name): (usize, &str),
        result: &str,
        answers: bool,
        since: Instant,
        out: &mut Out,
    ) -> io::Result<()> {
        if !self.has_headlines() {
            return Ok(());
        }
        let mark = if answers { ">" } else { " " };
        let time = if out.is_terminal() {
            format!("{:>6.1} s  ", since.elapsed().as_secs_f64())
        } else {
            String::new()
        };
        let (head, result) = (format!("{mark} {name:width$}  {time}"), with_printed_units(result));
        if answers || self == Self::Everything {
            return out.line(head + &result);
        }
        out.line(on_one_line(head, &result))
    }

    /// Limits of the study that are not kept, each with the name of its analysis: all of them, or of each limit the worst.
    pub fn limits(self, width: usize, broken: &[(String, LimitReached)], out: &mut Out) -> io::Result<()> {
        if !self.has_headlines() {
            return Ok(());
        }
        let all = self == Self::Everything;
        for (analysis, limit) in broken {
            let same = || {
                broken
                    .iter()
                    .map(|(_, other)| other)
                    .filter(|other| other.limit == limit.limit)
            };
            let worst = same().reduce(|a, b| if excess(b) > excess(a) { b } else { a });
            if !all && !worst.is_some_and(|worst| std::ptr::eq(worst, limit)) {
                continue;
            }
            let more = match same().count() - 1 {
                0 => String::new(),
                _ if all => String::new(),
                more => format!("; not kept in {more} other results: see the report"),
            };
            let sentence = with_printed_units(&limits::sentence(limit));
            out.line(format!("  {:width$}  {analysis}: {sentence}{more}", "limit"))?;
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
            out.line(on_one_line(format!("  {name:width$}  "), line))?;
        }
        let hint = match all.len().saturating_sub(WORST) {
            0 => return Ok(()),
            1 => "1 more quantity outside its range".to_owned(),
            more => format!("{more} more quantities outside their ranges"),
        };
        out.line(format!("  {:width$}  {hint}: see the report", ""))
    }
}

/// How far the worst value is beyond a limit; an unknown one is beyond any.
fn excess(limit: &LimitReached) -> f64 {
    let beyond = |worst: f64| {
        let below = limit.least.map_or(f64::NEG_INFINITY, |least| least - worst);
        let above = limit.most.map_or(f64::NEG_INFINITY, |most| worst - most);
        below.max(above)
    };
    limit.worst.map_or(f64::INFINITY, beyond)
}

/// What fits a line, up to the end of a clause where possible.
fn on_one_line(head: String, sentence: &str) -> String {
    const REST: &str = " ...";
    let room = LENGTH.saturating_sub(head.chars().count());
    if sentence.chars().count() <= room {
        return head + sentence;
    }
    let longest = room.saturating_sub(REST.len());
    let end = sentence.char_indices().nth(longest).map_or(0, |(at, _)| at);
    let start = &sentence[..end];
    let clause = start.rfind("; ").filter(|at| 3 * at > room);
    let end = clause.or_else(|| start.rfind(' ')).unwrap_or(end);
    head + sentence[..end].trim_end_matches([',', ';', ':']) + REST
}

#[cfg(test)]
mod tests {
    use gearloss_studies::limits::reached::{LimitReached, Place};
    use gearloss_studies::study::Severity;

    use super::{LENGTH, excess, on_one_line};

    #[test]
    fn the_worst_of_equal_limits_is_farthest_beyond_either_bound() {
        let limit = |least, most, worst| LimitReached {
            limit: "life".to_owned(),
            model_set: "own".to_owned(),
            quantity: "life".to_owned(),
            unit: "h".to_owned(),
            least,
            most,
            severity: Severity::Warning,
            points: 1,
            points_unknown: 0,
            beyond: 1,
            worst,
            at: Place::default(),
        };
        assert_eq!(excess(&limit(Some(8.0), None, Some(3.0))), 5.0);
        assert_eq!(excess(&limit(Some(8.0), Some(9.0), Some(11.0))), 2.0);
        assert_eq!(excess(&limit(None, Some(9.0), None)), f64::INFINITY);
    }

    #[test]
    fn a_line_ends_with_a_clause_or_a_word() {
        let head = || "  name  ".to_owned();
        assert_eq!(on_one_line(head(), "short; whole"), "  name  short; whole");
        let long = format!("{}; {}", "loss 5 W ".repeat(8).trim(), "and more ".repeat(20));
        assert_eq!(
            on_one_line(head(), &long),
            format!("  name  {} ...", "loss 5 W ".repeat(8).trim())
        );
        let words = on_one_line(head(), &"µ ".repeat(200));
        assert!(words.chars().count() <= LENGTH && words.ends_with("µ ..."), "{words}");
    }
}
