//! Models with kinks at a minimum, and their regimes.

use super::Identification;
use crate::distinct::distinct;
use gearloss_numerics::least_squares::{Fit, Kink};

/// Relative change of a component's loss below which it is due to rounding and the iterated power flow. \[-\]
const LEAST: f64 = 1e-9;

/// A model whose loss or slope is discontinuous at the minimum.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelKink {
    /// Path of the part, such as `gears.G4.drag.churning`.
    pub path: String,
    /// Name of its model.
    pub model: String,
    /// Regimes on the lower and on the upper side as named by the model; absent if none change.
    pub regimes: Option<[String; 2]>,
    /// Whether the loss is discontinuous, not only its slope.
    pub jumps: bool,
    /// Maximum deviation of the component's loss from a straight line between both sides, relative to its loss. \[-\]
    pub change: f64,
    /// Lines of the measured points concerned.
    pub lines: Vec<u64>,
    /// Indices of the parameters along which it occurs.
    pub parameters: Vec<usize>,
}

impl ModelKink {
    /// A sentence without full stop: `minimum at a kink of ...`.
    pub fn sentence(&self) -> String {
        let lines = match self.lines.as_slice() {
            [line] => format!("line {line}"),
            [first, .., last] if self.lines.len() > 4 => format!("{} lines, {first} to {last}", self.lines.len()),
            list => format!(
                "lines {}",
                list.iter().map(u64::to_string).collect::<Vec<_>>().join(", ")
            ),
        };
        let place = format!("`{}` of {}", self.model, self.path);
        let what = if self.jumps {
            "loss changes abruptly"
        } else {
            "slope of the loss changes abruptly"
        };
        match &self.regimes {
            Some([a, b]) => format!("minimum at a kink of {place} between the regimes \"{a}\" and \"{b}\" ({lines})"),
            None if self.jumps => format!(
                "minimum at a kink of {place}: the {what} by {:.2} % ({lines})",
                100.0 * self.change
            ),
            None => format!("minimum at a kink of {place}: the {what} ({lines})"),
        }
    }
}

impl Identification<'_> {
    /// Models with kinks at the minimum of a fit, sorted by their change relative to the total loss.
    ///
    /// # Errors
    /// If the gearbox has no value near the minimum.
    pub fn model_kinks(&self, fit: &Fit) -> Result<Vec<ModelKink>, String> {
        // Each with its maximum change relative to the total loss.
        let mut all: Vec<(f64, ModelKink)> = Vec::new();
        if fit.kinks.is_empty() {
            return Ok(Vec::new());
        }
        let middle = self.calculate(&fit.theta)?;
        for kink in &fit.kinks {
            let sides = [self.calculate(&kink.sides[0])?, self.calculate(&kink.sides[1])?];
            for row in kink
                .rows
                .iter()
                .filter_map(|i| self.observations.get(*i))
                .map(|o| o.row)
            {
                let (number, gear, here) = &middle.solved.rows[row];
                let [below, above] = [0, 1].map(|k| sides[k].point(row));
                let loss = here.loss.unwrap_or(0.0).abs().max(f64::MIN_POSITIVE);
                let parts = here.parts.iter().zip(below.parts.iter().zip(&above.parts)).enumerate();
                // The maximum deviation from a straight line between both sides.
                let bent = |(part, (here, (below, above))): (usize, (&f64, (&f64, &f64)))| {
                    (part, (below + above - 2.0 * here).abs(), *here)
                };
                let Some((part, bent, watts)) = parts.map(bent).max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))
                else {
                    continue;
                };
                if bent <= LEAST * loss {
                    continue;
                }
                let transmission = &middle.solved.transmissions[*number];
                let info = &transmission.parts()[part];
                let taken = [0, 1].map(|k| {
                    let beside = &sides[k].solved;
                    self.rows
                        .branches(&beside.transmissions[*number], gear, sides[k].point(row), part)
                });
                let regimes = changed(&taken);
                let change = bent / watts.abs().max(f64::MIN_POSITIVE);
                self.note(
                    &mut all,
                    kink,
                    (info.path.as_str(), row),
                    (regimes, [change, bent / loss]),
                    || transmission.instances()[info.notes.instance()].entry.name.to_owned(),
                );
            }
        }
        all.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.path.cmp(&b.1.path)));
        Ok(all.into_iter().map(|(_, kink)| kink).collect())
    }

    /// Merges the finding at a row with those of the same model and regimes.
    fn note(
        &self,
        all: &mut Vec<(f64, ModelKink)>,
        kink: &Kink,
        (path, row): (&str, usize),
        (regimes, [change, share]): (Option<[String; 2]>, [f64; 2]),
        model: impl FnOnce() -> String,
    ) {
        let line = self.rows.measured.rows[row].line;
        // Which side is the lower one depends on the parameter.
        let same = |(_, old): &&mut (f64, ModelKink)| {
            let turned = old.regimes.clone().map(|[a, b]| [b, a]);
            old.path == path && (old.regimes == regimes || turned == regimes)
        };
        if let Some((most, old)) = all.iter_mut().find(same) {
            *most = most.max(share);
            old.jumps |= kink.jumps;
            old.change = old.change.max(change);
            if let Err(place) = old.lines.binary_search(&line) {
                old.lines.insert(place, line);
            }
            if let Err(place) = old.parameters.binary_search(&kink.parameter) {
                old.parameters.insert(place, kink.parameter);
            }
        } else {
            let kink = ModelKink {
                path: path.to_owned(),
                model: model(),
                regimes,
                jumps: kink.jumps,
                change,
                lines: vec![line],
                parameters: vec![kink.parameter],
            };
            all.push((share, kink));
        }
    }
}

/// The branches that differ between both sides as text; absent if none differ or a side has none.
fn changed([below, above]: &[Vec<(String, &'static str)>; 2]) -> Option<[String; 2]> {
    let only = |taken: &[(String, &'static str)], other: &[(String, &'static str)]| {
        let branches = taken.iter().filter(|branch| !other.contains(branch));
        distinct(branches.map(|(_, words)| *words)).join(", ")
    };
    let sides = [only(below, above), only(above, below)];
    sides.iter().all(|words| !words.is_empty()).then_some(sides)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regimes_are_the_branches_that_differ() {
        let path = || "gears.G4.drag.churning".to_owned();
        let sides = [
            vec![(path(), "viscous"), (path(), "slow")],
            vec![(path(), "inertial"), (path(), "slow")],
        ];
        assert_eq!(changed(&sides), Some(["viscous".to_owned(), "inertial".to_owned()]));
        assert_eq!(changed(&[sides[0].clone(), sides[0].clone()]), None);
    }

    #[test]
    fn sentences_name_model_regimes_and_lines() {
        let mut kink = ModelKink {
            path: "gears.G4.drag.churning".to_owned(),
            model: "a_law".to_owned(),
            regimes: Some(["viscous".to_owned(), "inertial".to_owned()]),
            jumps: true,
            change: 0.002,
            lines: vec![7],
            parameters: vec![0],
        };
        let words = "minimum at a kink of `a_law` of gears.G4.drag.churning";
        assert_eq!(
            kink.sentence(),
            format!("{words} between the regimes \"viscous\" and \"inertial\" (line 7)")
        );
        (kink.regimes, kink.lines) = (None, vec![2, 4, 6, 8, 9]);
        assert_eq!(
            kink.sentence(),
            format!("{words}: the loss changes abruptly by 0.20 % (5 lines, 2 to 9)")
        );
    }
}
