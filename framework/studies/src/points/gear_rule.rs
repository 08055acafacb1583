//! The rule by which gears are chosen, and the sequence with the least energy.
//!
//! Rule: a cycle starts in the gear that draws least. It shifts to the gear that draws least at the moment if that saves more than a
//! stated power and the stated time since the last shift has passed. A gear beyond a limit is left at once. Every shift leads to the best
//! gear of the moment, so without limits there are never more shifts than without saving and dwell: derived.
//!
//! Least energy: dynamic programming over intervals and gears (Bellman 1957), exact where what an interval draws does not depend on the
//! gears before it, that is, at given temperatures.

/// What an interval draws in one gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offer {
    /// Drawn power, or the loss of the gearbox where no machine is described. \[W\]
    pub power: f64,
    /// Loss of the gearbox. \[W\]
    pub loss: f64,
    /// Relative excess over the limits of speed and torque; zero within them, infinite without a solution.
    pub excess: f64,
}

impl Offer {
    /// Without motion all gears draw the same.
    pub const REST: Self = Self {
        power: 0.0,
        loss: 0.0,
        excess: 0.0,
    };
}

/// When a shift is worth it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rule {
    /// Power that a shift must save. \[W\]
    pub saving: f64,
    /// Time that must have passed since the last shift. \[s\]
    pub dwell: f64,
}

/// The gear between two intervals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shifting {
    /// Number of the gear; absent before the start.
    pub gear: Option<usize>,
    /// Time since the last shift; infinite before the first. \[s\]
    since: f64,
}

impl Default for Shifting {
    fn default() -> Self {
        Self {
            gear: None,
            since: f64::INFINITY,
        }
    }
}

impl Shifting {
    /// After an interval in a gear.
    pub fn after(self, gear: usize, duration: f64) -> Self {
        let is_shifted = self.gear.is_some_and(|before| before != gear);
        Self {
            gear: Some(gear),
            since: if is_shifted { duration } else { self.since + duration },
        }
    }
}

/// The gear of an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pick {
    /// Its number.
    pub gear: usize,
    /// True if a limit requires the shift.
    pub forced: bool,
    /// True if every gear is beyond a limit.
    pub beyond: bool,
    /// Loss that is to be expected to change by [`CHANGE`] changes nothing.
    pub is_clear: bool,
}

/// Relative change of the losses until the temperatures at which gears are chosen are renewed. Assumed: losses change by less while the
/// intervals pass that are simulated together.
const CHANGE: f64 = 0.05;

/// Tolerance of times, for sums of steps. \[s\]
const MOMENT: f64 = 1e-9;

impl Rule {
    /// The gear of the next interval. There is at least one offer.
    pub fn pick(&self, now: Shifting, offers: &[Offer]) -> Pick {
        let allowed = allowed(offers);
        let beyond = offers.iter().all(|offer| offer.excess > 0.0);
        let before = now.gear.filter(|gear| *gear < offers.len());
        let best = least(offers, &allowed, before);
        let pick = |gear: usize, forced: bool| Pick {
            gear,
            forced,
            beyond,
            is_clear: true,
        };
        let Some(current) = before else {
            return Pick {
                is_clear: clear(offers, &allowed, best, best, 0.0),
                ..pick(best, false)
            };
        };
        if !allowed[current] {
            return pick(best, true);
        }
        if now.since + MOMENT < self.dwell {
            return pick(current, false);
        }
        let saved = offers[current].power - offers[best].power;
        let gear = if best != current && saved > self.saving {
            best
        } else {
            current
        };
        Pick {
            is_clear: clear(offers, &allowed, current, gear, self.saving),
            ..pick(gear, false)
        }
    }
}

/// Gears within the limits; where all are beyond one, those that are least beyond.
pub fn allowed(offers: &[Offer]) -> Vec<bool> {
    let least = offers.iter().map(|offer| offer.excess).fold(f64::INFINITY, f64::min);
    offers.iter().map(|offer| offer.excess <= least).collect()
}

/// The allowed gear that draws least; the present one where others draw the same.
fn least(offers: &[Offer], allowed: &[bool], before: Option<usize>) -> usize {
    let first = before.filter(|gear| allowed[*gear]);
    let first = first.or_else(|| allowed.iter().position(|is| *is)).unwrap_or(0);
    let better = |best: usize, gear: usize| {
        if allowed[gear] && offers[gear].power < offers[best].power {
            gear
        } else {
            best
        }
    };
    (0..offers.len()).fold(first, better)
}

/// True if the choice is the same after a change of the losses.
fn clear(offers: &[Offer], allowed: &[bool], current: usize, gear: usize, saving: f64) -> bool {
    let others = (0..offers.len()).filter(|other| *other != gear && allowed[*other]);
    let mut margins = others.map(|other| {
        // A gear against which the choice had to save more.
        let bonus = if gear == current { saving } else { 0.0 };
        let burden = if other == current { saving } else { 0.0 };
        let margin = offers[other].power - offers[gear].power + bonus - burden;
        margin - CHANGE * (offers[other].loss + offers[gear].loss)
    });
    margins.all(|margin| margin > 0.0) || offers.iter().all(|offer| *offer == Offer::REST)
}

/// Energy of a sequence of gears with its shifts. `shift` is the energy of a shift at the start of an interval, from one gear to another. \[J\]
pub fn energy(
    offers: &[Vec<Offer>],
    durations: &[f64],
    gears: &[usize],
    shift: &dyn Fn(usize, usize, usize) -> f64,
) -> f64 {
    let intervals = offers.iter().zip(durations).zip(gears);
    let driven: f64 = intervals
        .map(|((offers, duration), gear)| offers[*gear].power * duration)
        .sum();
    let pairs = gears.windows(2).enumerate().filter(|(_, pair)| pair[0] != pair[1]);
    driven + pairs.map(|(i, pair)| shift(i + 1, pair[0], pair[1])).sum::<f64>()
}

/// The sequence of allowed gears with the least energy, as in [`energy`].
pub fn least_energy(
    offers: &[Vec<Offer>],
    durations: &[f64],
    shift: &dyn Fn(usize, usize, usize) -> f64,
) -> Vec<usize> {
    let mut sums: Vec<f64> = Vec::new();
    let mut befores: Vec<Vec<usize>> = Vec::with_capacity(offers.len());
    for (i, (offers, duration)) in offers.iter().zip(durations).enumerate() {
        let allowed = allowed(offers);
        let reach = |gear: usize| -> (f64, usize) {
            if i == 0 {
                return (0.0, gear);
            }
            // Staying wins where a shift changes nothing.
            let stay = (sums[gear], gear);
            (0..sums.len())
                .filter(|before| *before != gear)
                .map(|before| (sums[before] + shift(i, before, gear), before))
                .fold(stay, |least, other| if other.0 < least.0 { other } else { least })
        };
        let reached: Vec<(f64, usize)> = (0..offers.len()).map(reach).collect();
        let sum = |gear: usize| {
            if allowed[gear] {
                reached[gear].0 + offers[gear].power * duration
            } else {
                f64::INFINITY
            }
        };
        sums = (0..offers.len()).map(sum).collect();
        befores.push(reached.into_iter().map(|(_, before)| before).collect());
    }
    let last = (0..sums.len()).fold(0, |best, gear| if sums[gear] < sums[best] { gear } else { best });
    let mut gears = vec![last; offers.len()];
    for i in (1..offers.len()).rev() {
        gears[i - 1] = befores[i][gears[i]];
    }
    gears
}

#[cfg(test)]
mod tests;
