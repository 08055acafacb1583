//! Choosing points one after the other, and exchanging them afterwards.

use super::information::scale;
use super::{Information, Precision};

/// Improvement from which on a point is exchanged: of the logarithm of the determinant, or of trace and worst deviation relative
/// to themselves.
const WORTHWHILE: f64 = 1e-3;
/// Gain over the worst deviation below which another parameter is the worst one before and after.
const FLAT: f64 = 1e-12;
/// Passes of an exchange; each improves the plan, so they end, and mostly after two or three.
const PASSES: usize = 50;

/// By what a design is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// The volume of the joint region: fall of the logarithm of the determinant of the covariance.
    Determinant,
    /// The mean: fall of the sum of the variances, each over the square of its range.
    Trace,
    /// The worst interval: fall of the greatest standard deviation over range.
    Worst,
}

/// One point of a plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// Number of the candidate, from zero.
    pub candidate: usize,
    /// What it gains by the rule after the points before it.
    pub gain: f64,
    /// One, and the change-over from the point before.
    pub cost: f64,
    /// The rule it was chosen by: where the worst interval has a flat spot the trace decides.
    pub rule: Rule,
}

/// Points to be measured, in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The points.
    pub choices: Vec<Choice>,
    /// What is known before.
    pub before: Precision,
    /// What will be known after.
    pub after: Precision,
}

impl Plan {
    /// Numbers of the candidates in order.
    pub fn candidates(&self) -> Vec<usize> {
        self.choices.iter().map(|c| c.candidate).collect()
    }

    /// Points of this plan that another lacks, ascending. Plans from the derivatives at other parameters of the joint region show
    /// so which choices hang on the parameters.
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

/// Candidates with all that a choice among them depends on.
#[derive(Debug, Clone)]
pub struct Design<F> {
    information: Information,
    rows: Vec<Vec<f64>>,
    rule: Rule,
    change_over: F,
}

impl<F: Fn(usize, usize) -> f64> Design<F> {
    /// From what is known, the row of each candidate (gradient over its standard uncertainty) and the cost of changing from
    /// one candidate to another, beside one for each point.
    ///
    /// # Errors
    /// If there are no candidates, or a row has another length than there are parameters, or entries that are not finite.
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

    /// Chooses points one after the other by gain over cost; a point may be measured again, and the lowest number decides
    /// between equals.
    ///
    /// # Errors
    /// If a cost is negative or no number.
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

    /// What each candidate gains if it is the only one that is measured.
    pub fn alone(&self) -> Vec<f64> {
        let variances = self.information.variances();
        let gain = |row: &Vec<f64>| gain(&self.information, &variances, row, self.rule);
        self.rows.iter().map(gain).collect()
    }

    /// Exchanges points of a plan for better ones until none is worth it. The order stays, and the plan never gets dearer.
    ///
    /// # Errors
    /// If the plan names other candidates, or a cost is negative or no number.
    pub fn exchange(&self, plan: &Plan) -> Result<Plan, String> {
        let mut places = plan.candidates();
        if places.iter().any(|i| *i >= self.rows.len()) {
            return Err("the plan was made from other candidates".to_owned());
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

    /// The plan of some candidates in order, with what each gains.
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

    /// The candidate of the greatest gain over cost.
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
                "a change-over to candidate {} cannot cost {change}",
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

/// What a row gains by a rule after what is known.
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

/// The greatest deviation of some variances.
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
    fn an_exchange_mends_a_poor_plan() {
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
