//! Errors of one quantity, and their verdict.

use gearloss_numerics::inference::{Coverage, ErrorSummary, PlacedError, Region};

use crate::identify::CONFIDENCE;
use crate::numbers::{figures, fixed};
use crate::study::{Difference, Quantity};

/// Errors of one quantity, of fitted and held-out rows, in percentage points, W, Nm or K.
#[derive(Debug, Clone)]
pub struct ErrorsOfQuantity {
    /// The quantity.
    pub quantity: Quantity,
    /// All errors.
    pub all: Vec<PlacedError>,
    /// Summary over fitted rows.
    pub fitted: Option<ErrorSummary>,
    /// Summary over held-out rows.
    pub held_out: Option<ErrorSummary>,
    /// Coverage of the bands.
    pub coverage: Option<Coverage>,
    /// Errors by region.
    pub regions: Vec<Region>,
}

fn short(x: f64) -> String {
    figures(x, 3)
}

fn signed(x: f64) -> String {
    let sign = if x < 0.0 { "-" } else { "+" };
    format!("{sign}{}", short(x.abs()))
}

fn percent(share: f64) -> String {
    fixed(100.0 * share, 1)
}

impl ErrorsOfQuantity {
    /// Whether errors are also stated in percent of the measured values.
    pub fn is_relative(&self) -> bool {
        matches!(self.quantity, Quantity::Loss | Quantity::LossTorque)
    }

    /// The verdict as a sentence.
    pub(super) fn sentence(&self, choice: &str) -> Option<String> {
        let held = self.held_out?;
        let (what, unit) = self.quantity.words(Difference::Points);
        let in_percent = |s: ErrorSummary| s.in_percent.filter(|_| self.is_relative());
        let relative = in_percent(held).filter(|_| self.fitted.is_none_or(|fitted| in_percent(fitted).is_some()));
        let ([rms, mean], unit_of_errors) = match relative {
            Some([rms, mean, _]) => ([rms, mean], "%"),
            None => ([held.rms, held.mean], unit),
        };
        let over_accuracy = |s: ErrorSummary| s.in_accuracies.map(|[rms, ..]| short(rms));
        let held_over = over_accuracy(held).map_or_else(String::new, |x| format!(", {x} times the stated accuracy"));
        let beside = self.fitted.map_or_else(String::new, |fitted| {
            let rms = in_percent(fitted)
                .filter(|_| relative.is_some())
                .map_or(fitted.rms, |[rms, ..]| rms);
            let over = over_accuracy(fitted).map_or_else(String::new, |x| format!(", {x} times"));
            format!(" (fitted points {}{over})", short(rms))
        });
        let at = held.greatest;
        let points = if held.count == 1 { "point" } else { "points" };
        let mut words = format!(
            "predicts the {what} of the {} held-out {points} ({choice}) with {} {unit_of_errors} rms{held_over}{beside}, bias {} {unit_of_errors}, maximum {} {unit} at \
             {} Nm and {} rpm (line {})",
            held.count,
            short(rms),
            signed(mean),
            signed(at.error),
            short(at.torque),
            fixed(at.speed, 0),
            at.line,
        );
        if let Some((coverage, [low, high])) = self.coverage.and_then(|c| Some((c, c.interval(CONFIDENCE)?))) {
            let judged = if high < CONFIDENCE {
                "; the bands are too narrow: the errors there are larger than the fit indicates"
            } else if low > CONFIDENCE {
                "; the bands are wider than the errors"
            } else {
                ""
            };
            words += &format!(
                "; {} of {} are inside their 95 % bands ({} %, 95 % interval {} to {} %){judged}",
                coverage.inside,
                coverage.count,
                percent(coverage.share()),
                percent(low),
                percent(high),
            );
        }
        Some(words)
    }
}
