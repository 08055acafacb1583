//! Solves the path of contact: each point converges with its own heat, starting from the solution at its neighbour, and all points
//! together converge with the body temperatures of the gears.
//!
//! Source: Shore and Kadiric solve the path twice: first each point heats the bodies alone, then the bodies get the mean of these
//! temperatures. But the mean heat of the mesh heats the bodies, and two pairs of teeth are active in double contact: the body
//! temperature rise is that mean times the contact ratio. The balance here uses the heat of the mesh.

use gearloss_framework::mechanism::tooth_friction::{PathAt, PathNode};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::contact::Contact;
use super::oil::Oil;
use super::place::{Bodies, Conditions, Laws, Place, first_slope};
use super::settled::Search;

/// Heat source of the gear bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Warmth {
    /// The mean heat of the mesh over time.
    #[default]
    Balance,
    /// The mean along the path of the temperatures that each point alone would cause, as published; lower by the contact ratio.
    PathMean,
    /// None: they have the oil temperature.
    Oil,
}

/// How the body temperatures are determined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Warming {
    /// By friction heat through these resistances to the oil. \[K/W\]
    By(Warmth, [f64; 2]),
    /// They are prescribed. \[degC\]
    Known([f64; 2]),
}

/// Iteration counts of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tally {
    /// Iterations of the body temperatures.
    pub runs: u32,
    /// Iterations of all points together.
    pub passes: u32,
}

/// Convergence tolerance of the body temperatures; the loss is then within 1e-4. \[K\]
const SETTLED: f64 = 0.01;
/// Maximum number of body temperature iterations.
const MOST_RUNS: u32 = 40;
/// Typical friction, the initial guess of a path.
const USUAL_MU: f64 = 0.05;

/// A path of contact with laws and oil.
pub struct March<'a> {
    /// The path.
    pub path: &'a PathAt<'a>,
    /// Formulas.
    pub laws: &'a Laws,
    /// Oil.
    pub oil: &'a Oil<'a>,
}

/// Sums over a path, each point with its weight.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    weight: f64,
    /// Friction heat. \[W\]
    heat: f64,
    /// Part of it that would enter the first body if both had the same temperature. \[W\]
    first: f64,
    /// Heat through the contacts per difference of the body temperatures. \[W/K\]
    conductance: f64,
    /// Body temperatures. \[degC\]
    bodies: [f64; 2],
}

impl Sums {
    /// Adds a point with its friction and body temperatures.
    fn add(&mut self, weight: f64, place: &Place<'_>, mu: f64, bodies: [f64; 2]) {
        let heat = mu * place.heat_per_mu();
        let [b1, b2] = place.bands();
        self.weight += weight;
        self.heat += weight * heat;
        self.first += weight * heat * b2 / (b1 + b2);
        self.conductance += weight / (b1 + b2);
        for (sum, t) in self.bodies.iter_mut().zip(bodies) {
            *sum += weight * t;
        }
    }

    /// Rise of both body temperatures over the oil, from the resistances to it, for another heat with the same split. \[K\]
    ///
    /// Heat also flows from body to body through the contacts: H1 = first + conductance (T2 - T1), H2 = heat - H1, Ti = Mi Hi.
    fn rise(&self, resistances: [f64; 2], heat: f64) -> [f64; 2] {
        let [m1, m2] = resistances;
        let first = if self.heat > 0.0 {
            heat * self.first / self.heat
        } else {
            0.0
        };
        let to_first = (first + self.conductance * m2 * heat) / (1.0 + self.conductance * (m1 + m2));
        [m1 * to_first, m2 * (heat - to_first)]
    }
}

impl March<'_> {
    /// Conditions that all points share at these body temperatures.
    pub fn conditions(&self, bodies: Bodies) -> Conditions<'_> {
        Conditions::new(self.laws, self.oil, bodies)
    }

    /// A point of the path; `None` without load.
    ///
    /// The line load is the force on the pair over the length of its line of contact, b/cos beta_b. The reference line load of a
    /// path is the normal force over the face width, which is larger for helical gears.
    pub fn place<'b>(&self, node: &PathNode, conditions: &Conditions<'b>) -> Option<Place<'b>> {
        let path = self.path;
        let line_load = node.force * path.line_load * path.mean.part.pair.cos_base_helix;
        if line_load <= 0.0 {
            return None;
        }
        let speeds = Contact::speeds(
            node.sliding * path.speed,
            node.sum_speed * path.speed,
            node.first_faster,
        );
        let contact = Contact::new(line_load, node.radius, path.modulus, path.length, speeds);
        Some(Place::new(conditions, contact, path.rq))
    }

    /// One iteration along the path at given body temperatures; `mu` is the initial guess on entry and the friction on return.
    fn run(&self, bodies: Bodies, mu: &mut [f64], tally: &mut Tally) -> Sums {
        let mut sums = Sums::default();
        let conditions = self.conditions(bodies);
        let mut slope = first_slope();
        let first = tally.runs == 0;
        tally.runs += 1;
        let mut before = USUAL_MU;
        for (node, mu) in self.path.nodes.iter().zip(mu) {
            let Some(place) = self.place(node, &conditions) else {
                *mu = 0.0;
                continue;
            };
            let guess = if first { before } else { *mu };
            let settled = place.settle(guess, &mut slope, &mut tally.passes);
            *mu = settled.mu;
            before = settled.mu;
            sums.add(node.weight, &place, settled.mu, settled.bodies);
        }
        sums
    }

    /// Solves the whole path and writes its friction; returns the body temperatures and the iteration counts.
    pub fn settle(&self, warming: Warming, mu: &mut [f64]) -> (Bodies, Tally) {
        let mut tally = Tally::default();
        let oil = self.oil.supplied.temperature;
        let bodies = match warming {
            Warming::Known(temperatures) => Bodies::Held(temperatures),
            Warming::By(Warmth::Oil, _) => Bodies::Held([oil; 2]),
            Warming::By(..) if !self.laws.thermal => Bodies::Held([oil; 2]),
            Warming::By(Warmth::PathMean, resistances) => {
                let sums = self.run(Bodies::Rising(resistances), mu, &mut tally);
                let mean = |i: usize| {
                    if sums.weight > 0.0 {
                        sums.bodies[i] / sums.weight
                    } else {
                        oil
                    }
                };
                Bodies::Split([mean(0), mean(1)], resistances)
            }
            Warming::By(Warmth::Balance, resistances) => return self.balance(resistances, mu),
        };
        self.run(bodies, mu, &mut tally);
        (bodies, tally)
    }

    /// Solves for the body temperatures that balance the mean heat of the mesh.
    fn balance(&self, resistances: [f64; 2], mu: &mut [f64]) -> (Bodies, Tally) {
        let mut tally = Tally::default();
        // Initially all points have the typical friction.
        let unknown = self.conditions(Bodies::Rising(resistances));
        let mut known = Sums::default();
        for node in self.path.nodes {
            if let Some(place) = self.place(node, &unknown) {
                known.add(node.weight, &place, USUAL_MU, [0.0; 2]);
            }
        }
        let rheology = self.oil.rheology;
        let most = known.heat / USUAL_MU * rheology.mu_b.max(rheology.limiting_slope);
        let mut search = Search::new(most, 0.0);
        let mut heat = known.heat;
        loop {
            let rise = known.rise(resistances, heat);
            let bodies = Bodies::Held(rise.map(|rise| self.oil.supplied.temperature + rise));
            let found = self.run(bodies, mu, &mut tally);
            let settled = found.rise(resistances, found.heat);
            let off = (settled[0] - rise[0]).abs().max((settled[1] - rise[1]).abs());
            if off <= SETTLED || tally.runs == MOST_RUNS {
                return (bodies, tally);
            }
            heat = search.next(heat, found.heat);
            known = found;
        }
    }
}
