//! Sequential choice of points, and exchange afterwards.

use super::information::scale;
use super::{Information, Precision};

/// Minimum improvement for an exchange of a point: of the logarithm of the determinant, or relative for trace and worst deviation.
const WORTHWHILE: f64 = 1e-3;
/// Relative gain below which the worst deviation is considered unchanged.
const FLAT: f64 = 1e-12;
/// Maximum number of passes of an exchange; usually two or three suffice.
const PASSES: usize = 50;

/// Criterion of a design.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// D-optimality, the volume of the joint region: decrease of the logarithm of the determinant of the covariance.
    Determinant,
    /// A-optimality, the mean: decrease of the sum of the variances, each relative to the square of its range.
    Trace,
    /// The widest interval: decrease of the largest standard deviation relative to the range.
    Worst,
}

/// One point of a plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// Index of the candidate.
    pub candidate: usize,
    /// Gain by the rule, given the previous points.
    pub gain: f64,
    /// One, plus the cost of the change from the previous point.
    pub cost: f64,
    /// The rule that selected it: if the widest interval does not change, the trace decides.
    pub rule: Rule,
}

/// Proposed points, in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The points.
    pub choices: Vec<Choice>,
    /// Precision before.
    pub before: Precision,
    /// Expected precision after.
    pub after: Precision,
}

impl Plan {
    /// Indices of the candidates in order.
    pub fn candidates(&self) -> Vec<usize> {
        self.choices.iter().map(|c| c.candidate).collect()
    }

    /// Points of this plan that are absent from another, ascending. Plans for other parameters of the joint region show which choices
    /// depend on the parameters.
    pub fn lacking_in(&self, other: &Self) -> Vec<usize> {
        let mut others = other.candidates();
        let mut lacking = self.candidates();
        lacking.retain(|c| match others.iter().position(|o| o == c) {
            Some(i) => {
                others.swap_remove(i);
                false
            }
            None => true,
        });
        lacking.sort_unstable();
        lacking
    }
}

/// Candidates with the data for a choice.
#[derive(Debug, Clone)]
pub struct Design<F> {
    information: Information,
    rows: Vec<Vec<f64>>,
    rule: Rule,
    change_over: F,
}

impl<F: Fn(usize, usize) -> f64> Design<F> {
    /// From the current information, the row of each candidate (gradient over its standard uncertainty) and the cost of changing from one
    /// candidate to another, in addition to one for each point.
    ///
    /// # Errors
    /// If there are no candidates, or a row has the wrong length or non-finite entries.
    pub fn new(information: Information, candidates: &[Vec<f64>], rule: Rule, change_over: F) -> Result<Self, String> {
        if candidates.is_empty() {
            return Err("there are no candidates to choose from".to_owned());
        }
        let rows = (candidates.iter().enumerate())
            .map(|(i, row)| scale(row, information.ranges()).map_err(|fault| format!("candidate {}: {fault}", i + 1)))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            information,
            rows,
            rule,
            change_over,
        })
    }

    /// Chooses points sequentially by gain over cost; points may repeat, and the lowest index decides between equals.
    ///
    /// # Errors
    /// If a cost is negative or not a number.
    pub fn greedy(&self, count: usize) -> Result<Plan, String> {
        let mut known = self.information.clone();
        let mut choices: Vec<Choice> = Vec::with_capacity(count);
        for _ in 0..count {
            let before = choices.last().map(|c| c.candidate);
            let mut best = self.best(&known, before, self.rule)?;
            if self.rule == Rule::Worst && best.gain <= FLAT * known.precision().worst() {
                best = self.best(&known, before, Rule::Trace)?;
            }
            known.add(self.rows[best.candidate].clone());
            choices.push(best);
        }
        Ok(Plan {
            choices,
            before: self.information.precision(),
            after: known.precision(),
        })
    }

    /// Gain of each candidate as the only measurement.
    pub fn alone(&self) -> Vec<f64> {
        let variances = self.information.variances();
        let gain = |row: &Vec<f64>| gain(&self.information, &variances, row, self.rule);
        self.rows.iter().map(gain).collect()
    }

    /// Exchanges points of a plan for better ones until no exchange is worthwhile. The order is kept, and the cost never increases.
    ///
    /// # Errors
    /// If the plan contains other candidates, or a cost is negative or not a number.
    pub fn exchange(&self, plan: &Plan) -> Result<Plan, String> {
        let mut places = plan.candidates();
        if places.iter().any(|i| *i >= self.rows.len()) {
            return Err("the plan was made for other candidates".to_owned());
        }
        for _ in 0..PASSES {
            let mut changed = false;
            for place in 0..places.len() {
                let mut others = self.information.clone();
                for (_, candidate) in places.iter().enumerate().filter(|(i, _)| *i != place) {
                    others.add(self.rows[*candidate].clone());
                }
                let variances = others.variances();
                let gain = |candidate: usize| gain(&others, &variances, &self.rows[candidate], self.rule);
                let (now, price) = (gain(places[place]), self.price(&places)?);
                let mut best = (places[place], now);
                for candidate in 0..self.rows.len() {
                    let better = gain(candidate);
                    if better > best.1 {
                        let mut trial = places.clone();
                        trial[place] = candidate;
                        if self.price(&trial)? <= price {
                            best = (candidate, better);
                        }
                    }
                }
                let size = match self.rule {
                    Rule::Determinant => 1.0,
                    Rule::Trace => variances.iter().sum::<f64>() - now,
                    Rule::Worst => worst(variances.iter().copied()) - now,
                };
                if best.1 - now > WORTHWHILE * size {
                    places[place] = best.0;
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
        self.plan(&places)
    }

    /// The plan of candidates in order with their gains.
    fn plan(&self, places: &[usize]) -> Result<Plan, String> {
        let mut known = self.information.clone();
        let mut choices: Vec<Choice> = Vec::with_capacity(places.len());
        for candidate in places {
            let cost = self.cost(choices.last().map(|c| c.candidate), *candidate)?;
            let row = &self.rows[*candidate];
            choices.push(Choice {
                candidate: *candidate,
                gain: gain(&known, &known.variances(), row, self.rule),
                cost,
                rule: self.rule,
            });
            known.add(row.clone());
        }
        Ok(Plan {
            choices,
            before: self.information.precision(),
            after: known.precision(),
        })
    }

    /// The candidate with the largest gain over cost.
    fn best(&self, known: &Information, before: Option<usize>, rule: Rule) -> Result<Choice, String> {
        let variances = known.variances();
        let choice = |candidate: usize| -> Result<Choice, String> {
            Ok(Choice {
                candidate,
                gain: gain(known, &variances, &self.rows[candidate], rule),
                cost: self.cost(before, candidate)?,
                rule,
            })
        };
        let mut best = choice(0)?;
        for candidate in 1..self.rows.len() {
            let next = choice(candidate)?;
            if next.gain / next.cost > best.gain / best.cost {
                best = next;
            }
        }
        Ok(best)
    }

    fn cost(&self, before: Option<usize>, candidate: usize) -> Result<f64, String> {
        let change = before.map_or(0.0, |before| (self.change_over)(before, candidate));
        if change >= 0.0 && change.is_finite() {
            Ok(1.0 + change)
        } else {
            Err(format!(
                "invalid cost of a change to candidate {}: {change}",
                candidate + 1
            ))
        }
    }

    /// Cost of some candidates in order.
    fn price(&self, places: &[usize]) -> Result<f64, String> {
        let before = std::iter::once(None).chain(places.iter().copied().map(Some));
        before
            .zip(places)
            .map(|(before, candidate)| self.cost(before, *candidate))
            .sum()
    }
}

/// Gain of a row by a rule, given the current information.
fn gain(known: &Information, variances: &[f64], row: &[f64], rule: Rule) -> f64 {
    let step = known.step(row);
    let less = || step.change.iter().map(|v| v * v / (1.0 + step.news));
    match rule {
        Rule::Determinant => step.news.ln_1p(),
        Rule::Trace => less().sum(),
        Rule::Worst => {
            let after = variances
                .iter()
                .zip(less())
                .map(|(variance, less)| (variance - less).max(0.0));
            worst(variances.iter().copied()) - worst(after)
        }
    }
}

/// The largest standard deviation of a list of variances.
fn worst(variances: impl Iterator<Item = f64>) -> f64 {
    variances.fold(0.0, f64::max).sqrt()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A line a + b x on places from -1 to 1, both parameters known to range/sqrt(12).
    fn line(rule: Rule) -> Design<impl Fn(usize, usize) -> f64> {
        let ranges = [2.0, 2.0];
        let known = [
            super::super::uniform_row(0, &ranges),
            super::super::uniform_row(1, &ranges),
        ];
        let candidates: Vec<Vec<f64>> = (0..21).map(|i| vec![10.0, f64::from(i) - 10.0]).collect();
        Design::new(Information::new(&ranges, &known).unwrap(), &candidates, rule, |_, _| {
            0.0
        })
        .unwrap()
    }

    #[test]
    fn a_line_is_measured_at_its_ends() {
        // The classical answer for every rule: half of the points at either end.
        for rule in [Rule::Determinant, Rule::Trace, Rule::Worst] {
            let plan = line(rule).exchange(&line(rule).greedy(4).unwrap()).unwrap();
            let mut places = plan.candidates();
            places.sort_unstable();
            assert_eq!(places, [0, 0, 20, 20], "{rule:?}");
            assert!(plan.after.worst() < plan.before.worst());
        }
    }

    #[test]
    fn gains_add_up_to_what_is_known_after() {
        let plan = line(Rule::Determinant).greedy(3).unwrap();
        let sum: f64 = plan.choices.iter().map(|c| c.gain).sum();
        assert!((plan.before.ln_determinant - sum - plan.after.ln_determinant).abs() < 1e-12);
        let plan = line(Rule::Trace).greedy(3).unwrap();
        let sum: f64 = plan.choices.iter().map(|c| c.gain).sum();
        assert!((plan.before.trace - sum - plan.after.trace).abs() < 1e-12);
    }

    #[test]
    fn an_exchange_improves_a_poor_plan() {
        let design = line(Rule::Determinant);
        let poor = design.plan(&[10, 10, 10, 10]).unwrap();
        let better = design.exchange(&poor).unwrap();
        assert!(better.after.ln_determinant < poor.after.ln_determinant - 1.0);
        assert_eq!(design.exchange(&better).unwrap(), better);
        assert_eq!(poor.lacking_in(&better).len(), 4);
        assert!(better.lacking_in(&better).is_empty());
    }

    #[test]
    fn change_overs_are_paid_for() {
        let ranges = [2.0, 2.0];
        let known = [
            super::super::uniform_row(0, &ranges),
            super::super::uniform_row(1, &ranges),
        ];
        let candidates = [vec![10.0, -10.0], vec![10.0, 10.0], vec![9.0, 9.0]];
        let dear = |a: usize, b: usize| if (a == 0) == (b == 0) { 0.0 } else { 1000.0 };
        let information = Information::new(&ranges, &known).unwrap();
        let design = Design::new(information.clone(), &candidates, Rule::Determinant, dear).unwrap();
        let plan = design.greedy(3).unwrap();
        assert_eq!(plan.candidates(), [0, 0, 0]);
        assert_eq!(
            design
                .exchange(&plan)
                .unwrap()
                .choices
                .iter()
                .map(|c| c.cost)
                .sum::<f64>(),
            3.0
        );
        let wrong = Design::new(information, &candidates, Rule::Determinant, |_, _| f64::NAN).unwrap();
        assert!(wrong.greedy(1).is_ok() && wrong.greedy(2).unwrap_err().contains("cost"));
    }

    #[test]
    fn flat_spots_of_the_worst_interval_fall_back_to_the_trace() {
        // Nothing can be learnt of the first parameter, which stays the worst.
        let ranges = [1.0, 1.0];
        let information = Information::new(&ranges, &[vec![1.0, 0.0], vec![0.0, 2.0]]).unwrap();
        let candidates = [vec![0.0, 1.0], vec![0.0, 2.0]];
        let plan = Design::new(information, &candidates, Rule::Worst, |_, _| 0.0)
            .unwrap()
            .greedy(2)
            .unwrap();
        assert_eq!(plan.candidates(), [1, 1]);
        assert!(plan.choices.iter().all(|c| c.rule == Rule::Trace));
    }

    #[test]
    fn what_cannot_be_chosen_from_is_refused() {
        let information = Information::new(&[1.0], &[vec![1.0]]).unwrap();
        let design =
            |candidates: &[Vec<f64>]| Design::new(information.clone(), candidates, Rule::Trace, |_, _| 0.0).err();
        assert!(design(&[]).is_some());
        assert!(design(&[vec![1.0], vec![1.0, 2.0]]).unwrap().contains("candidate 2"));
        assert!(design(&[vec![f64::INFINITY]]).is_some());
        let stranger = line(Rule::Trace).plan(&[7]).unwrap();
        let one = Design::new(information, &[vec![1.0]], Rule::Trace, |_, _| 0.0).unwrap();
        assert!(one.exchange(&stranger).unwrap_err().contains("other candidates"));
    }
}
