//! The way along the path of contact: every place settles with its own heat, from where its neighbour settled, and all places
//! together settle with the bodies of the gears.
//!
//! Source: Shore and Kadiric march twice: first each place warms the bodies alone, then the bodies have the mean of these
//! temperatures. But the bodies are warmed by the mean heat of the mesh, in which two pairs of teeth work while contact is double:
//! their rise is that mean times the contact ratio. The balance here takes the heat of the mesh.

use gearloss_framework::mechanism::tooth_friction::{PathAt, PathNode};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::contact::Contact;
use super::oil::Oil;
use super::place::{Bodies, Conditions, Laws, Place, first_slope};
use super::settled::Search;

/// What warms the bodies of the gears.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Warmth {
    /// The mean heat of the mesh over time.
    #[default]
    Balance,
    /// The mean over the path of what each place alone would make of them, as published; lower by the contact ratio.
    PathMean,
    /// Nothing: they are as warm as the oil.
    Oil,
}

/// How the bodies' temperatures come about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Warming {
    /// From friction, through these resistances to the oil. \[K/W\]
    By(Warmth, [f64; 2]),
    /// They are known. \[degC\]
    Known([f64; 2]),
}

/// How much work a path took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tally {
    /// Ways along the path.
    pub runs: u32,
    /// Passes of all places together.
    pub passes: u32,
}

/// Body temperature within which gears and mesh have settled; the loss then is within 1e-4. \[K\]
const SETTLED: f64 = 0.01;
/// Ways along a path after which the bodies count as settled.
const MOST_RUNS: u32 = 40;
/// Usual friction, from where a path starts.
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

/// Sums over a path, each place by its weight.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    weight: f64,
    /// Heat of friction. \[W\]
    heat: f64,
    /// How much of it would enter the first body, were both equally warm. \[W\]
    first: f64,
    /// Heat that passes through the contacts per difference of the bodies' temperatures. \[W/K\]
    conductance: f64,
    /// Temperatures of the bodies. \[degC\]
    bodies: [f64; 2],
}

impl Sums {
    /// Adds a place by its friction and the temperatures of its bodies.
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

    /// Rise of both bodies over the oil, from the resistances to it, for another heat of the same split. \[K\]
    ///
    /// Heat also passes from body to body through the contacts: H1 = first + conductance (T2 - T1), H2 = heat - H1, Ti = Mi Hi.
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
    /// What the places share with these bodies.
    pub fn conditions(&self, bodies: Bodies) -> Conditions<'_> {
        Conditions::new(self.laws, self.oil, bodies)
    }

    /// A place of the path; absent without load.
    ///
    /// The line load is the force on the pair over the length of its line of contact, b/cos beta_b. The reference line load of a
    /// path is the normal force over the face width, which is more for helical gears.
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

    /// One way along the path with given bodies; `mu` is the guess before and the friction after it.
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

    /// Settles the whole path and writes its friction; the bodies as they are then, and the work it took.
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

    /// Finds the bodies that the mean heat of the mesh keeps at their temperatures.
    fn balance(&self, resistances: [f64; 2], mu: &mut [f64]) -> (Bodies, Tally) {
        let mut tally = Tally::default();
        // Before anything has settled, all places have the usual friction.
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
