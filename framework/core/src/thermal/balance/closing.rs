//! Closing of brackets: from two temperatures with opposite residuals to one with zero residual, or to a jump of a law.

use super::{Balance, Root, Step};

/// Minimum width of a closed bracket, in addition to rounding of the temperature. \[K\]
const CLOSED: f64 = 1e-14;
/// Slope relative to that of the whole bracket above which a law is taken to jump.
const STEEPEST: f64 = 1e6;
/// Maximum number of steps in one bracket; bisection alone needs half as many.
const MOST: usize = 120;

/// The brackets of a member, from losses above dissipation to losses below it, which are closed one after the other.
pub(super) struct Closings {
    /// The coldest last.
    brackets: Vec<[Step; 2]>,
    open: Option<Closing>,
    /// True if a law is undefined where a balance may be.
    pub gap: bool,
}

impl Closings {
    /// From brackets in order of temperature, the coldest first.
    pub fn new(mut brackets: Vec<[Step; 2]>, gap: bool) -> Self {
        brackets.reverse();
        Self {
            brackets,
            open: None,
            gap,
        }
    }

    /// The next temperature to ask for; `None` if all brackets are closed, whose temperatures are then among the stable ones.
    pub fn next<E>(&mut self, found: &mut Balance<E>) -> Option<f64> {
        loop {
            let open = match &mut self.open {
                Some(open) => open,
                None => self.open.insert(Closing::new(self.brackets.pop()?)),
            };
            match open.next() {
                Next::Ask(temperature) => return Some(temperature),
                Next::Closed(root) => {
                    found.stable.push(root);
                    self.open = None;
                }
            }
        }
    }

    /// Takes what the law gave there.
    pub fn take(&mut self, step: Option<Step>) {
        if let (Some(step), Some(open)) = (step, &mut self.open) {
            open.take(step);
        } else {
            // A law is undefined inside.
            (self.open, self.gap) = (None, true);
        }
    }
}

/// A bracket that is being closed.
struct Closing {
    bracket: [Step; 2],
    /// The newest step.
    last: Step,
    /// The opposite end of the bracket.
    other: Step,
    /// Position of the next step between both.
    share: f64,
    steps: usize,
}

/// What a bracket needs, or gave.
enum Next {
    Ask(f64),
    Closed(Root),
}

impl Closing {
    fn new([cold, warm]: [Step; 2]) -> Self {
        Self {
            bracket: [cold, warm],
            last: warm,
            other: cold,
            share: warm.residual() / (warm.residual() - cold.residual()),
            steps: 0,
        }
    }

    fn next(&self) -> Next {
        let (last, other) = (self.last, self.other);
        let nearer = last.residual().abs() < other.residual().abs();
        let best = if nearer { last } else { other };
        if best.is_balanced() {
            return Next::Closed(Root::from_step(best));
        }
        let width = (other.temperature - last.temperature).abs();
        let least = (4.0 * f64::EPSILON * last.temperature.abs()).max(CLOSED) / width;
        if least <= 0.5 && self.steps < MOST {
            let share = self.share.clamp(least, 1.0 - least);
            return Next::Ask(last.temperature + share * (other.temperature - last.temperature));
        }
        let [below, above] = if last.residual() > 0.0 {
            [last, other]
        } else {
            [other, last]
        };
        // The temperature has no more digits. The residual is rounding if it does not exceed slope times width.
        let [cold, warm] = self.bracket;
        let slope = (warm.residual() - cold.residual()).abs() / (warm.temperature - cold.temperature);
        let width = (above.temperature - below.temperature).abs();
        if below.residual() - above.residual() <= STEEPEST * slope * width {
            let nearer = below.residual() < -above.residual();
            return Next::Closed(Root::from_step(if nearer { below } else { above }));
        }
        Next::Closed(Root {
            beyond: Some(above),
            ..Root::from_step(below)
        })
    }

    fn take(&mut self, new: Step) {
        let before;
        if (new.residual() > 0.0) == (self.last.residual() > 0.0) {
            before = self.last;
        } else {
            before = self.other;
            self.other = self.last;
        }
        self.last = new;
        self.share = next([self.last, self.other, before]);
        self.steps += 1;
    }
}

/// Position of the next step between two ends of a bracket, from zero at the first to one at the second.
fn next([last, other, before]: [Step; 3]) -> f64 {
    let (x1, x2, x3) = (last.temperature, other.temperature, before.temperature);
    let (f1, f2, f3) = (last.residual(), other.residual(), before.residual());
    let (xi, phi) = ((x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2));
    if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
        f1 / (f2 - f1) * f3 / (f2 - f3) + (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2)
    } else {
        0.5
    }
}
