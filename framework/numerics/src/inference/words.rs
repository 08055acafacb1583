//! Verdicts on parameters as sentences.

use super::verdict::FILLS;
use super::{Determination, Fit, Parameter, Scale, Verdict};

/// Confidence of the intervals in sentences, and its text.
const CONFIDENCE: (f64, &str) = (0.95, "95 %");

impl Fit {
    /// The verdict on a parameter as a sentence without full stop, with a note if its interval fills half the range or more.
    pub fn sentence(&self, parameter: usize) -> String {
        let found = self.determination(parameter);
        let said = self.verdict_text(parameter, &found);
        match found.filled {
            Some(filled) if filled >= FILLS && found.verdict != Verdict::NotSeen => {
                format!("{said}; its interval fills {:.0} % of the given range", 100.0 * filled)
            }
            _ => said,
        }
    }

    /// The verdict as text.
    fn verdict_text(&self, parameter: usize, found: &Determination) -> String {
        let at = &self.parameters()[parameter];
        match found.verdict {
            Verdict::Held => format!("fixed at {}", digits(at.theta())),
            Verdict::OnBound(side) => {
                let wish = if side.sign() < 0.0 { "less" } else { "more" };
                let bound = digits(at.scale.theta(at.bounds[side.place()]));
                format!("is at its {} bound {bound}; the data prefer {wish}", side.name())
            }
            Verdict::NotSeen => {
                "not identifiable: a change by its own size has less effect than the accuracy of the instruments"
                    .to_owned()
            }
            Verdict::WellDetermined | Verdict::RoughlyDetermined | Verdict::NotDetermined => self.alone(parameter),
            Verdict::OnlyInCombination => {
                let Some(first) = found.partners.first() else {
                    return format!(
                        "identifiable only in combination with several others; alone {}",
                        self.alone(parameter)
                    );
                };
                let names: Vec<&str> = found
                    .partners
                    .iter()
                    .map(|k| self.parameters()[*k].name.as_str())
                    .collect();
                let names = names.join(", ");
                match self.known(parameter, *first) {
                    Some(known) => {
                        format!(
                            "identifiable only in combination with {names}: {known} is determined, {} alone {}",
                            at.name,
                            self.alone(parameter)
                        )
                    }
                    None => format!("identifiable only in combination with {names}: the data do not separate them"),
                }
            }
        }
    }

    /// Value and interval of one parameter.
    fn alone(&self, parameter: usize) -> String {
        let at = &self.parameters()[parameter];
        let (confidence, name) = CONFIDENCE;
        let Some(interval) = self.interval(parameter, confidence, 1.0) else {
            return format!("{}, without an interval", digits(at.theta()));
        };
        let [low, high] = interval.ends;
        if at.scale == Scale::Linear && interval.ends == interval.uncut {
            return format!("{} ({name})", with_half(at.u, high - at.u));
        }
        let [low, high] = [low, high].map(digits);
        format!("{}, {low} to {high} ({name})", digits(at.theta()))
    }

    /// A combination of two parameters with its interval.
    fn known(&self, parameter: usize, with: usize) -> Option<String> {
        let combination = self.combination(parameter, with)?;
        let half = self.quantile(CONFIDENCE.0)? * combination.deviation;
        let coordinate = |p: &Parameter| match p.scale {
            Scale::Linear => p.name.clone(),
            Scale::Log => format!("ln {}", p.name),
        };
        let [one, other] = [parameter, with].map(|k| coordinate(&self.parameters()[k]));
        let sign = if combination.factor < 0.0 { "+" } else { "-" };
        let factor = digits(combination.factor.abs());
        Some(format!(
            "{one} {sign} {factor} {other} = {}",
            with_half(combination.value, half)
        ))
    }
}

/// A number with four digits.
fn digits(x: f64) -> String {
    decimals(x, 4).map_or_else(|| format!("{x:.3e}"), |places| format!("{x:.places$}"))
}

/// A number with its half-width, both rounded to the second digit of the half-width.
fn with_half(x: f64, half: f64) -> String {
    match decimals(half, 2) {
        Some(places) if half > 0.0 => format!("{x:.places$} +- {half:.places$}"),
        _ => format!("{} +- {half:.1e}", digits(x)),
    }
}

/// Decimals that show a number of digits; absent if there would be too many on either side of the point.
fn decimals(x: f64, digits: i32) -> Option<usize> {
    if x == 0.0 {
        return Some(0);
    }
    let power = x.abs().log10().floor();
    (-6.0..7.0)
        .contains(&power)
        .then(|| (digits - 1 - power as i32).max(0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_long_as_a_reader_wants() {
        assert_eq!(digits(1.149_303), "1.149");
        assert_eq!(digits(-0.013_831), "-0.01383");
        assert_eq!(digits(0.0), "0");
        assert_eq!(digits(12_345.6), "12346");
        assert_eq!(digits(1.5e-9), "1.500e-9");
        assert_eq!(digits(3e12), "3.000e12");
        assert_eq!(with_half(0.046_546, 0.003_807), "0.0465 +- 0.0038");
        assert_eq!(with_half(1.0, 0.0), "1.000 +- 0.0e0");
    }
}
