//! Minimum of a loss over a positive property, and its flatness.

use schemars::JsonSchema;
use serde::Serialize;

/// Maximum number of rounds of the search.
pub const ROUNDS: usize = 6;
/// Tolerance of the logarithm of the property.
const FOUND: f64 = 0.005;
/// Relative increase of the loss within a flat range.
const FLAT: f64 = 0.01;

/// The minimum loss over a property.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct LeastLoss {
    /// Value of the property, in its unit.
    pub value: f64,
    /// Mean loss there. [W]
    pub mean_loss_w: f64,
    /// Range in which the loss is within one percent of the minimum, limited by the range of the values. In the unit of the property.
    pub flat_range: [f64; 2],
    /// True if the minimum is at an end of the range, beyond which the loss may decrease further.
    pub at_end_of_range: bool,
}

/// Coordinate of a property: its logarithm if all values are positive.
fn coordinate(points: &[(f64, f64)]) -> (fn(f64) -> f64, fn(f64) -> f64) {
    if points.iter().all(|(value, _)| *value > 0.0) {
        (f64::ln, f64::exp)
    } else {
        (|x| x, |x| x)
    }
}

fn best(points: &[(f64, f64)]) -> usize {
    let order = points.iter().enumerate().min_by(|a, b| a.1.1.total_cmp(&b.1.1));
    order.map_or(0, |(i, _)| i)
}

/// The next value of the search: the minimum of a parabola through the lowest loss and its neighbours, or the middle of the wider side if
/// that is known; absent if the minimum is found or at an end. Points are sorted by value.
pub fn wanted(points: &[(f64, f64)]) -> Option<f64> {
    let i = best(points);
    if i == 0 || i + 1 >= points.len() {
        return None;
    }
    let (to, from) = coordinate(points);
    let [a, b, c] = [i - 1, i, i + 1].map(|k| (to(points[k].0), points[k].1));
    let span = to(points[points.len() - 1].0) - to(points[0].0);
    let tolerance = FOUND * if points[0].0 > 0.0 { 1.0 } else { span };
    if c.0 - a.0 <= 2.0 * tolerance {
        return None;
    }
    let (p, q) = ((b.0 - a.0) * (b.1 - c.1), (b.0 - c.0) * (b.1 - a.1));
    let vertex = b.0 - 0.5 * ((b.0 - a.0) * p - (b.0 - c.0) * q) / (p - q);
    let wider = if c.0 - b.0 > b.0 - a.0 {
        0.5 * (b.0 + c.0)
    } else {
        0.5 * (a.0 + b.0)
    };
    let inside = vertex.is_finite() && vertex > a.0 && vertex < c.0;
    match inside {
        true if (vertex - b.0).abs() > tolerance => Some(from(vertex)),
        // The parabola agrees with the known points: one more evaluation on the wider side confirms it.
        true if (c.0 - a.0) > 40.0 * tolerance => Some(from(wider)),
        true => None,
        false => Some(from(wider)),
    }
}

impl LeastLoss {
    /// The minimum loss of points sorted by value.
    pub fn new(points: &[(f64, f64)]) -> Self {
        let i = best(points);
        let (value, loss) = points[i];
        let limit = (1.0 + FLAT) * loss;
        let (to, from) = coordinate(points);
        let edge = |step: &mut dyn Iterator<Item = usize>| {
            let mut last = i;
            for k in step {
                if points[k].1 > limit {
                    let (inner, outer) = (points[last], points[k]);
                    let share = (limit - inner.1) / (outer.1 - inner.1);
                    return from(to(inner.0) + share * (to(outer.0) - to(inner.0)));
                }
                last = k;
            }
            points[last].0
        };
        Self {
            value,
            mean_loss_w: loss,
            flat_range: [edge(&mut (0..i).rev()), edge(&mut (i + 1..points.len()))],
            at_end_of_range: i == 0 || i + 1 == points.len(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn searched(law: impl Fn(f64) -> f64, values: &[f64]) -> (LeastLoss, usize) {
        let mut points: Vec<(f64, f64)> = values.iter().map(|x| (*x, law(*x))).collect();
        let mut asked = 0;
        for _ in 0..ROUNDS {
            let Some(next) = wanted(&points) else { break };
            points.push((next, law(next)));
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            asked += 1;
        }
        (LeastLoss::new(&points), asked)
    }

    #[test]
    fn a_flat_minimum_is_found_with_its_range() {
        // Least at 4: loss 80; a percent more at ln(x/4) = +-0.2.
        let law = |x: f64| 80.0 + 20.0 * (x / 4.0).ln().powi(2);
        let (least, asked) = searched(law, &[1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0]);
        assert!(
            (least.value / 4.0).ln().abs() < 0.02 && (least.mean_loss_w - 80.0).abs() < 0.01,
            "{}",
            least.value
        );
        assert!((least.flat_range[0] / 4.0).ln() < -0.15 && (least.flat_range[1] / 4.0).ln() > 0.15);
        assert!(!least.at_end_of_range && asked <= ROUNDS);
    }

    #[test]
    fn a_loss_that_falls_all_the_way_has_its_least_at_the_end() {
        let (least, asked) = searched(|x| 10.0 / x, &[1.0, 2.0, 3.0]);
        assert!(least.at_end_of_range && asked == 0 && least.value == 3.0);
    }
}
