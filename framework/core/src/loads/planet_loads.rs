//! How planets share their load: elastic planets between central members, in the plane across the axis, turning with the carrier.
//!
//! Derivation. The tooth forces of one planet are in a fixed ratio, as the planet is in equilibrium about its own axis, so each planet has one
//! unknown: the tangential force f of its pin. Its meshes and its pin are springs in series; by virtual work their compliances add up to that
//! of the planet, 1/k = ((P^2 + P_r^2)/k_pin + sum (F_bt^2/k_mesh))/P^2 for a force P of the pin. If the central members turn by an angle that
//! moves all pins by theta, and the floating ones are displaced, the planet at the angle psi is compressed by
//! d = theta - e - c - w_y cos(psi) - w_z sin(psi) where the force of the pin is towards its position error e, with a play c. So
//! f = k max(d, 0), the sum of f is that of the torque, and w = (sum f cos(psi), sum f sin(psi))/kappa, with 1/kappa = sum h^2/k_float and
//! h the resultant force on a floating member for a force P = 1. That is the minimum of a convex function of theta and w, which is quadratic in
//! pieces: Newton steps with an exact line search end in it. The forces are linear between torques at which a planet gains or loses contact,
//! so those torques and the forces at them are found once.
//!
//! Closed limits: equal errors give equal shares. One planet of n with an error e carries 1 + (n - 1)/n k e/f times the mean f with fixed
//! members, as long as all planets carry, and 1 + (n - 3)/n k e/f with a free one: three planets on a free member share equally. Rigid
//! planets: n and n/2 (an even n, free).
//!
//! Not included: bending of the rim of a ring between planets, run-out of gears, weight and inertia of the planets.

/// Elastic planets between central members.
#[derive(Debug, Clone, PartialEq)]
pub struct ElasticPlanets {
    /// Position error of each pin, towards positive turns of the carrier. \[m\]
    pub errors: Vec<f64>,
    /// Radial play of each planet on its pin. \[m\]
    pub clearances: Vec<f64>,
    /// Stiffness of one planet with its meshes and its pin, for the tangential force of the pin. \[N/m\]
    pub stiffness: f64,
    /// Force of all pins against a displacement of the floating members, for the tangential force of a pin; zero if one is free, `None` if
    /// none floats. \[N/m\]
    pub centring: Option<f64>,
}

/// A free member has this part of the stiffness of a planet as centring, so that its place is defined where two planets carry.
const FREE: f64 = 1e-10;

/// Part of the force that would flatten all errors below which forces are proportional to the torque.
const LEAST: f64 = 1e-7;

/// Most torques at which contact changes; a path that has more is cut.
const MOST_KNOTS: usize = 400;

/// Forces of the pins over the mean of them: lines between knots, and one beyond the last.
#[derive(Debug, Clone, PartialEq)]
pub struct PinForces {
    /// Mean forces, ascending from zero. \[N\]
    pub knots: Vec<f64>,
    /// At each knot the force of each planet and its slope behind the knot. \[N, -\]
    pub planets: Vec<Vec<[f64; 2]>>,
}

/// What is unknown: the turn as a displacement of the pins, and the displacement of the floating members. \[m\]
type Place = [f64; 3];

impl ElasticPlanets {
    fn count(&self) -> usize {
        self.errors.len()
    }

    /// Angle of a planet from the first one. \[rad\]
    pub fn angle(&self, planet: usize) -> f64 {
        std::f64::consts::TAU * planet as f64 / self.count() as f64
    }

    /// How the compression of a planet follows from the place of the members.
    fn row(&self, planet: usize) -> Place {
        if self.centring.is_none() {
            return [1.0, 0.0, 0.0];
        }
        let (sin, cos) = self.angle(planet).sin_cos();
        [1.0, -cos, -sin]
    }

    /// Compression of a planet at the origin, for pins pushed forwards or backwards. \[m\]
    fn offset(&self, planet: usize, sense: f64) -> f64 {
        -sense * self.errors[planet] - self.clearances[planet]
    }

    fn compression(&self, planet: usize, sense: f64, at: Place) -> f64 {
        dot(self.row(planet), at) + self.offset(planet, sense)
    }

    fn centring(&self) -> f64 {
        self.centring.map_or(0.0, |own| own.max(FREE * self.stiffness))
    }

    /// The place in which the planets of `carry` and no others carry, without a torque and per newton of the sum of all pins.
    fn place(&self, sense: f64, carry: &[bool]) -> [Place; 2] {
        let mut matrix = [[0.0; 3]; 3];
        let mut right = [[0.0; 3], [1.0, 0.0, 0.0]];
        for planet in (0..self.count()).filter(|planet| carry[*planet]) {
            let row = self.row(planet);
            for ((line, still), own) in matrix.iter_mut().zip(&mut right[0]).zip(row) {
                for (entry, other) in line.iter_mut().zip(row) {
                    *entry += self.stiffness * own * other;
                }
                *still -= self.stiffness * own * self.offset(planet, sense);
            }
        }
        let floats = self.centring.is_some();
        for (i, line) in matrix.iter_mut().enumerate().skip(1) {
            line[i] += if floats { self.centring() } else { 1.0 };
        }
        solve(matrix, right)
    }

    /// The place under a sum of the forces of all pins, and the planets that carry. \[N\]
    fn equilibrium(&self, sense: f64, sum: f64) -> (Place, Vec<bool>) {
        let n = self.count();
        let mut at = [0.0; 3];
        // All planets carry at the start.
        at[0] = (0..n).fold(0.0_f64, |most, planet| most.max(-self.offset(planet, sense))) + sum / self.stiffness;
        let mut carry: Vec<bool> = vec![true; n];
        for _ in 0..100 {
            let [still, per_newton] = self.place(sense, &carry);
            let aim: Place = std::array::from_fn(|i| still[i] + sum * per_newton[i]);
            let step: Place = std::array::from_fn(|i| aim[i] - at[i]);
            let length = self.line_search(sense, sum, at, step);
            for (own, step) in at.iter_mut().zip(step) {
                *own += length * step;
            }
            let compressions: Vec<f64> = (0..n).map(|planet| self.compression(planet, sense, at)).collect();
            // At least one carries: the sum is positive.
            let greatest = compressions.iter().fold(f64::NEG_INFINITY, |most, own| most.max(*own));
            let next: Vec<bool> = compressions.iter().map(|own| *own > 0.0 || *own == greatest).collect();
            if next == carry && length >= 1.0 {
                break;
            }
            carry = next;
        }
        (at, carry)
    }

    /// Length of a step to the least energy along it, at most one step beyond the aim.
    fn line_search(&self, sense: f64, sum: f64, at: Place, step: Place) -> f64 {
        let n = self.count();
        let of = |planet: usize| (self.compression(planet, sense, at), dot(self.row(planet), step));
        let slope = |length: f64| {
            let pins: f64 = (0..n)
                .map(|planet| {
                    let (d, change) = of(planet);
                    self.stiffness * (d + length * change).max(0.0) * change
                })
                .sum();
            let float = self.centring() * (1..3).map(|i| (at[i] + length * step[i]) * step[i]).sum::<f64>();
            pins + float - sum * step[0]
        };
        let mut kinks: Vec<f64> = (0..n)
            .map(|planet| {
                let (d, change) = of(planet);
                -d / change
            })
            .filter(|length| length.is_finite() && *length > 0.0)
            .chain([1.0])
            .collect();
        kinks.sort_by(f64::total_cmp);
        let (mut low, mut low_slope) = (0.0, slope(0.0));
        if low_slope >= 0.0 {
            return 1.0;
        }
        for kink in kinks {
            let own = slope(kink);
            if own >= 0.0 {
                return low - low_slope * (kink - low) / (own - low_slope);
            }
            (low, low_slope) = (kink, own);
        }
        // Beyond the last kink the slope is a line.
        let further = slope(low + 1.0) - low_slope;
        if further > 0.0 { low - low_slope / further } else { low }
    }

    /// Force that would press the most distant planet into contact. \[N\]
    fn scale(&self) -> f64 {
        let greatest = self
            .errors
            .iter()
            .chain(&self.clearances)
            .fold(0.0_f64, |most, own| most.max(own.abs()));
        self.stiffness * greatest
    }

    /// True if all planets carry the same load at any torque.
    pub fn equal(&self) -> bool {
        let same = |values: &[f64]| values.iter().all(|own| *own == values[0]);
        same(&self.errors) && same(&self.clearances)
    }

    /// The forces of pins that are pushed forwards (`sense` 1) or backwards (-1).
    pub fn forces(&self, sense: f64) -> PinForces {
        let n = self.count();
        let count = n as f64;
        let least = LEAST * self.scale();
        // Knots from above, as sums of the forces of all pins.
        let mut sum = 4.0 * count * self.scale() * (1.0 + count);
        let mut knots: Vec<(f64, Vec<[f64; 2]>)> = Vec::new();
        while knots.len() < MOST_KNOTS {
            let (_, carry) = self.equilibrium(sense, sum);
            let [still, per_newton] = self.place(sense, &carry);
            let line = |planet: usize| {
                let row = self.row(planet);
                [
                    self.stiffness * (dot(row, still) + self.offset(planet, sense)),
                    self.stiffness * dot(row, per_newton),
                ]
            };
            // The greatest lower sum at which a planet loses or gains contact.
            let changes = (0..n).filter_map(|planet| {
                let [still, slope] = line(planet);
                let changes = if carry[planet] { slope > 0.0 } else { slope < 0.0 };
                changes.then(|| -still / slope).filter(|at| *at < sum)
            });
            let end = changes.fold(least, f64::max);
            let planets = (0..n)
                .map(|planet| {
                    let [still, slope] = line(planet);
                    if carry[planet] {
                        [(still + slope * end).max(0.0), slope * count]
                    } else {
                        [0.0, 0.0]
                    }
                })
                .collect();
            let planets = without_rounding(planets, [end, count]);
            knots.push((end / count, planets));
            if end <= least {
                break;
            }
            // Where several planets change at once, the next ones are those below all of them.
            sum = end * (1.0 - 1e-9);
        }
        let (first, forces) = knots.last().cloned().unwrap_or_default();
        let from_zero = forces
            .iter()
            .map(|[force, _]| [0.0, force / first.max(f64::MIN_POSITIVE)]);
        knots.push((0.0, from_zero.collect()));
        knots.reverse();
        let (knots, planets) = knots.into_iter().unzip();
        PinForces { knots, planets }
    }

    /// Displacement of floating members, as seen by the pins, at a mean force of the pins. \[m\]
    pub fn displacement(&self, sense: f64, mean: f64) -> f64 {
        let (at, _) = self.equilibrium(sense, mean * self.count() as f64);
        at[1].hypot(at[2])
    }
}

impl PinForces {
    /// Of all planets at a mean force: each force. \[N\]
    pub fn at(&self, mean: f64) -> Vec<f64> {
        let from = self.knots.iter().rposition(|knot| *knot <= mean).unwrap_or(0);
        let own = self.planets[from].iter();
        own.map(|[force, slope]| force + slope * (mean - self.knots[from]))
            .collect()
    }

    /// The forces ordered at every torque, the greatest first, with knots where two planets change places.
    pub fn ordered(&self) -> Self {
        let mut knots = self.knots.clone();
        for (i, planets) in self.planets.iter().enumerate() {
            let end = self.knots.get(i + 1).copied().unwrap_or(f64::INFINITY);
            for (j, [force, slope]) in planets.iter().enumerate() {
                for [other, others] in &planets[..j] {
                    let crossing = self.knots[i] + (other - force) / (slope - others);
                    // Equal slopes may differ by rounding.
                    let crosses = (slope - others).abs() > 1e-9;
                    if crosses && crossing > self.knots[i] && crossing < end {
                        knots.push(crossing);
                    }
                }
            }
        }
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        let ends = knots[1..].iter().copied().chain([2.0 * knots[knots.len() - 1] + 1.0]);
        let planets = knots.iter().zip(ends).map(|(knot, end)| {
            let from = self.knots.iter().rposition(|own| own <= knot).unwrap_or(0);
            let mut lines: Vec<[f64; 2]> = self.planets[from]
                .iter()
                .map(|[force, slope]| [force + slope * (knot - self.knots[from]), *slope])
                .collect();
            let middle = 0.5 * (end - knot);
            lines.sort_by(|a, b| (b[0] + b[1] * middle).total_cmp(&(a[0] + a[1] * middle)));
            lines
        });
        let planets = planets.collect();
        Self { knots, planets }
    }
}

/// Forces and slopes with these sums, from those whose sums are almost so: no torque is lost by rounding.
fn without_rounding(mut lines: Vec<[f64; 2]>, sums: [f64; 2]) -> Vec<[f64; 2]> {
    for (i, sum) in sums.into_iter().enumerate() {
        let own: f64 = lines.iter().map(|line| line[i]).sum();
        for line in &mut lines {
            line[i] *= sum / own;
        }
    }
    lines
}

fn dot(a: Place, b: Place) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Both solutions of a system of three equations, by elimination with pivots.
fn solve(mut matrix: [[f64; 3]; 3], mut right: [Place; 2]) -> [Place; 2] {
    for column in 0..3 {
        let pivot = (column..3).fold(column, |best, line| {
            if matrix[line][column].abs() > matrix[best][column].abs() {
                line
            } else {
                best
            }
        });
        matrix.swap(column, pivot);
        for own in &mut right {
            own.swap(column, pivot);
        }
        for line in column + 1..3 {
            let factor = matrix[line][column] / matrix[column][column];
            let above = matrix[column];
            for (entry, above) in matrix[line].iter_mut().zip(above).skip(column) {
                *entry -= factor * above;
            }
            for own in &mut right {
                own[line] -= factor * own[column];
            }
        }
    }
    right.map(|own| {
        let mut solution = [0.0; 3];
        for line in (0..3).rev() {
            let known: f64 = (line + 1..3).map(|i| matrix[line][i] * solution[i]).sum();
            solution[line] = (own[line] - known) / matrix[line][line];
        }
        solution
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn planets(errors: &[f64], centring: Option<f64>) -> ElasticPlanets {
        ElasticPlanets {
            errors: errors.iter().map(|e| e * 1e-6).collect(),
            clearances: vec![0.0; errors.len()],
            stiffness: 2e8,
            centring,
        }
    }

    /// Shares over the mean at a mean force.
    fn shares(planets: &ElasticPlanets, mean: f64) -> Vec<f64> {
        let forces = planets.forces(-1.0).at(mean);
        forces.into_iter().map(|force| force / mean).collect()
    }

    fn close(found: &[f64], expected: &[f64]) {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-7, "{found} {expected}");
        }
    }

    /// k e = 4000 N; closed forms in the head of the file.
    #[test]
    fn one_planet_with_an_error_has_the_closed_shares() {
        for n in 3..8_usize {
            let mut errors = vec![0.0; n];
            errors[0] = 20.0;
            let count = n as f64;
            for (centring, lost) in [(None, 1.0), (Some(0.0), 3.0)] {
                let found = shares(&planets(&errors, centring), 20e3);
                assert!(
                    (found[0] - (1.0 + (count - lost) / count * 0.2)).abs() < 1e-7,
                    "{n} {found:?}"
                );
            }
        }
        // Fixed members: the planet in front carries everything until the others touch at f = k e/n.
        close(
            &shares(&planets(&[20.0, 0.0, 0.0, 0.0], None), 900.0),
            &[4.0, 0.0, 0.0, 0.0],
        );
        close(
            &shares(&planets(&[20.0, 0.0, 0.0, 0.0], None), 4000.0),
            &[1.75, 0.75, 0.75, 0.75],
        );
        // Four planets on a free member: opposite planets carry alike.
        close(
            &shares(&planets(&[20.0, 0.0, 0.0, 0.0], Some(0.0)), 500.0),
            &[2.0, 0.0, 2.0, 0.0],
        );
        close(
            &shares(&planets(&[20.0, 0.0, 0.0, 0.0], Some(0.0)), 4000.0),
            &[1.25, 0.75, 1.25, 0.75],
        );
    }

    /// A centred member with kappa: the first harmonic of the errors is reduced by kappa/(kappa + n k/2).
    #[test]
    fn a_centred_member_takes_a_part_of_the_first_harmonic() {
        let (k, kappa) = (2e8, 1e8);
        let found = shares(&planets(&[20.0, 0.0, 0.0], Some(kappa)), 20e3);
        let first = 2.0 / 3.0 * 0.2 * kappa / (kappa + 1.5 * k);
        close(&found, &[1.0 + first, 1.0 - 0.5 * first, 1.0 - 0.5 * first]);
    }

    proptest! {
        #[test]
        fn forces_are_an_equilibrium(
            errors in proptest::collection::vec(-60.0..60.0_f64, 2..9),
            play in proptest::collection::vec(0.0..40.0_f64, 9),
            float in prop_oneof![Just(None), Just(Some(0.0)), (1e6..1e9_f64).prop_map(Some)],
            mean in 1.0..50e3_f64,
            turns in 0..9_usize,
        ) {
            let n = errors.len();
            let mut planets = planets(&errors, float);
            planets.clearances = play[..n].iter().map(|c| c * 1e-6).collect();
            let forces = planets.forces(1.0);
            let own = forces.at(mean);
            prop_assert!(own.iter().all(|force| *force >= 0.0 && force.is_finite()), "{own:?}");
            let sum: f64 = own.iter().sum();
            prop_assert!((sum / (mean * n as f64) - 1.0).abs() < 1e-10, "{sum} {mean}");
            // They are those of the equilibrium at this force itself.
            let (at, _) = planets.equilibrium(1.0, mean * n as f64);
            for (planet, force) in own.iter().enumerate() {
                let exact = planets.stiffness * planets.compression(planet, 1.0, at).max(0.0);
                prop_assert!((exact - force).abs() < 1e-6 * mean, "{planet}: {force} {exact} of {mean}, {forces:?}");
            }
            // Floating members are in equilibrium.
            if float.is_some() {
                for (axis, of) in [(1, f64::cos as fn(f64) -> f64), (2, f64::sin)] {
                    let across: f64 = own.iter().enumerate().map(|(i, force)| force * of(planets.angle(i))).sum();
                    prop_assert!((across - planets.centring() * at[axis]).abs() < 1e-5 * mean, "{across}");
                }
            }
            // The order of the planets does not matter, but for which planet is which.
            let mut turned = planets.clone();
            turned.errors.rotate_left(turns % n);
            turned.clearances.rotate_left(turns % n);
            let mut again = turned.forces(1.0).at(mean);
            again.rotate_right(turns % n);
            for (one, other) in own.iter().zip(&again) {
                prop_assert!((one - other).abs() < 1e-6 * mean, "{own:?} {again:?}");
            }
            // Ordered forces are the same forces.
            let ordered = forces.ordered().at(mean);
            let mut sorted = own.clone();
            sorted.sort_by(|a, b| b.total_cmp(a));
            for (one, other) in sorted.iter().zip(&ordered) {
                prop_assert!((one - other).abs() < 1e-6 * mean, "{sorted:?} {ordered:?}");
            }
            // A high torque evens out.
            let high = forces.at(1e9);
            prop_assert!(high.iter().all(|force| (force / 1e9 - 1.0).abs() < 1e-3), "{high:?}");
        }
    }
}
