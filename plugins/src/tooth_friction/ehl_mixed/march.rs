//! Solves the path of contact: each point converges with its own heat, starting from the solution at its neighbour, and all points
//! together converge with the body temperatures of the gears.
//!
//! Source: Shore and Kadiric solve the path twice: first each point heats the bodies alone, then the bodies get the mean of these
//! temperatures. But the mean heat of the mesh heats the bodies, and two pairs of teeth are active in double contact: the body
//! temperature rise is that mean times the contact ratio. The balance here uses the heat of the mesh.

use gearloss_framework::mechanism::tooth_friction::{PathAt, PathNode};
use gearloss_framework::real::{Mask as _, Points};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::contact::{Contact, Logarithms};
use super::oil::Oil;
use super::place::{Bodies, Conditions, Laws, Place, first_slope};
use super::seen::{Seen, observed};
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
pub enum Warming<R = f64> {
    /// By friction heat through these resistances to the oil. \[K/W\]
    By(Warmth, [R; 2]),
    /// They are prescribed. \[degC\]
    Known([R; 2]),
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
pub struct March<'a, R: Points = f64> {
    /// The path.
    pub path: &'a PathAt<'a, R>,
    /// Formulas.
    pub laws: &'a Laws,
    /// Oil.
    pub oil: &'a Oil<'a, R>,
    /// Natural logarithms of what all points share: line load of a pair with the whole force, modulus, length, speed of the first gear.
    ln_line_load: R,
    ln_modulus: R,
    ln_length: R,
    ln_speed: R,
}

/// A solved path.
#[derive(Debug, Clone, Copy)]
pub struct Solved<R = f64> {
    /// Body temperatures.
    pub bodies: Bodies<R>,
    /// Heat into both bodies. \[W\]
    pub heats: [R; 2],
    /// Iteration counts.
    pub tally: Tally,
}

/// Sums over a path, each point with its weight.
#[derive(Debug, Clone, Copy, Default)]
struct Sums<R = f64> {
    weight: R,
    /// Friction heat. \[W\]
    heat: R,
    /// Part of it that would enter the first body if both had the same temperature. \[W\]
    first: R,
    /// Heat through the contacts per difference of the body temperatures. \[W/K\]
    conductance: R,
    /// Body temperatures. \[degC\]
    bodies: [R; 2],
    /// Heat into both bodies. \[W\]
    heats: [R; 2],
}

impl<R: Points> Sums<R> {
    /// Adds a point with its friction, where it carries load.
    #[inline(always)]
    fn add(&mut self, weight: f64, place: &Place<'_, R>, mu: R) {
        let (bodies, heats) = place.heat_bodies(mu);
        let weight = R::select(place.loaded(), R::constant(weight), R::ZERO);
        let heat = mu * place.heat_per_mu();
        let [b1, b2] = place.bands();
        // Without load there is no contact, and nothing to weight.
        let weighted = |x: R| R::select(weight.is_zero(), R::ZERO, weight * x);
        self.weight += weight;
        self.heat += weighted(heat);
        self.first += weighted(heat * b2 / (b1 + b2));
        self.conductance += weighted(R::constant(1.0) / (b1 + b2));
        for (sum, x) in self
            .bodies
            .iter_mut()
            .zip(bodies)
            .chain(self.heats.iter_mut().zip(heats))
        {
            *sum += weighted(x);
        }
    }

    /// Rise of both body temperatures over the oil, from the resistances to it, for another heat with the same split. \[K\]
    ///
    /// Heat also flows from body to body through the contacts: H1 = first + conductance (T2 - T1), H2 = heat - H1, Ti = Mi Hi.
    #[inline(always)]
    fn rise(&self, resistances: [R; 2], heat: R) -> [R; 2] {
        let [m1, m2] = resistances;
        let heats = self.heat.is_above(R::ZERO);
        let first = R::select(heats, heat * self.first / self.heat, R::ZERO);
        let to_first = (first + self.conductance * m2 * heat) / (self.conductance * (m1 + m2) + 1.0);
        [m1 * to_first, m2 * (heat - to_first)]
    }

    /// These sums where a condition holds, others elsewhere.
    #[inline(always)]
    fn select(mask: R::Mask, then: Self, other: Self) -> Self {
        let selected = |of: fn(&Self) -> R| R::select(mask, of(&then), of(&other));
        Self {
            weight: selected(|sums| sums.weight),
            heat: selected(|sums| sums.heat),
            first: selected(|sums| sums.first),
            conductance: selected(|sums| sums.conductance),
            bodies: [selected(|sums| sums.bodies[0]), selected(|sums| sums.bodies[1])],
            heats: [selected(|sums| sums.heats[0]), selected(|sums| sums.heats[1])],
        }
    }
}

impl<'a, R: Points> March<'a, R> {
    /// A path with its laws and oil.
    pub fn new(path: &'a PathAt<'a, R>, laws: &'a Laws, oil: &'a Oil<'a, R>) -> Self {
        Self {
            path,
            laws,
            oil,
            ln_line_load: path.line_load.ln(),
            ln_modulus: R::constant(path.modulus).ln(),
            ln_length: R::constant(path.length).ln(),
            ln_speed: path.speed.ln(),
        }
    }

    /// Conditions that all points share at these body temperatures.
    #[inline(always)]
    pub fn conditions(&self, bodies: Bodies<R>) -> Conditions<'_, R> {
        Conditions::new(self.laws, self.oil, bodies)
    }

    /// A point of the path; `None` without load.
    #[inline(always)]
    pub fn place<'b>(&self, node: &PathNode, conditions: &Conditions<'b, R>) -> Option<Place<'b, R>> {
        let path = self.path;
        let line_load = path.line_load * node.share;
        if !line_load.is_above(R::ZERO).any() {
            return None;
        }
        let speeds = Contact::speeds(
            path.speed * node.sliding,
            path.speed * node.sum_speed,
            node.first_faster,
        );
        let contact = Contact::new(
            line_load,
            R::constant(node.radius),
            R::constant(path.modulus),
            R::constant(path.length),
            speeds,
        );
        // Flanks that move against each other have the sliding velocity as their sum.
        let [speed, slide_roll] = if node.sliding <= node.sum_speed {
            [node.ln_rolling, node.ln_slide_roll]
        } else {
            [0.5 * node.sliding, 2.0 * node.sum_speed.abs() / node.sliding].map(f64::ln)
        };
        let ln = Logarithms {
            line_load: self.ln_line_load + node.share.ln(),
            radius: R::constant(node.ln_radius),
            modulus: self.ln_modulus,
            length: self.ln_length,
            speed: self.ln_speed + speed,
            slide_roll: R::constant(slide_roll),
        };
        Some(Place::new(conditions, contact, ln, path.rq))
    }

    /// One iteration along the path at given body temperatures, for the points that are not settled; `mu` is the initial guess on
    /// entry and the friction on return. `seen` is what this iteration sees.
    fn run(
        &self,
        bodies: Bodies<R>,
        open: R::Mask,
        mu: &mut [R],
        tally: &mut Tally,
        mut seen: Option<&mut Seen<R>>,
    ) -> Sums<R> {
        let first = tally.runs == 0;
        tally.runs += 1;
        R::wide(
            #[inline(always)]
            || {
                let mut sums = Sums::default();
                if let Some(seen) = seen.as_deref_mut() {
                    seen.forget(open);
                }
                let conditions = self.conditions(bodies);
                let mut slope = R::constant(first_slope());
                let mut before = R::constant(USUAL_MU);
                for (node, mu) in self.path.nodes.iter().zip(&mut *mu) {
                    let Some(place) = self.place(node, &conditions) else {
                        *mu = R::ZERO;
                        continue;
                    };
                    let guess = if first { before } else { *mu };
                    let found = place.settle(guess, &mut slope, &mut tally.passes);
                    let loaded = place.loaded();
                    *mu = R::select(open, R::select(loaded, found.mu, R::ZERO), *mu);
                    before = R::select(loaded, found.mu, before);
                    sums.add(node.weight, &place, found.mu);
                    if let Some(seen) = seen.as_deref_mut() {
                        seen.add(open & loaded, &observed(&place, &found.settled()));
                    }
                }
                sums
            },
        )
    }

    /// The sums if all points have the typical friction.
    fn typical(&self, resistances: [R; 2]) -> Sums<R> {
        R::wide(
            #[inline(always)]
            || {
                let unknown = self.conditions(Bodies::Rising(resistances));
                let mut sums = Sums::default();
                for node in self.path.nodes {
                    if let Some(place) = self.place(node, &unknown) {
                        sums.add(node.weight, &place, R::constant(USUAL_MU));
                    }
                }
                sums
            },
        )
    }

    /// Solves the whole path and writes its friction, and what is seen.
    pub fn settle(&self, warming: Warming<R>, mu: &mut [R], seen: Option<&mut Seen<R>>) -> Solved<R> {
        let mut tally = Tally::default();
        let all = R::mask(|_| true);
        let oil = self.oil.supplied.temperature;
        let bodies = match warming {
            Warming::Known(temperatures) => Bodies::Held(temperatures),
            Warming::By(Warmth::Oil, _) => Bodies::Held([oil; 2]),
            Warming::By(..) if !self.laws.thermal => Bodies::Held([oil; 2]),
            Warming::By(Warmth::PathMean, resistances) => {
                let sums = self.run(Bodies::Rising(resistances), all, mu, &mut tally, None);
                let loaded = sums.weight.is_above(R::ZERO);
                let mean = sums.bodies.map(|sum| R::select(loaded, sum / sums.weight, oil));
                Bodies::Split(mean, resistances)
            }
            Warming::By(Warmth::Balance, resistances) => return self.balance(resistances, mu, seen),
        };
        let Sums { heats, .. } = self.run(bodies, all, mu, &mut tally, seen);
        Solved { bodies, heats, tally }
    }

    /// Solves for the body temperatures that balance the mean heat of the mesh.
    fn balance(&self, resistances: [R; 2], mu: &mut [R], mut seen: Option<&mut Seen<R>>) -> Solved<R> {
        let mut tally = Tally::default();
        let mut known = self.typical(resistances);
        let rheology = self.oil.rheology;
        let most = known.heat / USUAL_MU * rheology.mu_b.max(rheology.limiting_slope);
        let mut search = Search::new(most, R::ZERO);
        let mut heat = known.heat;
        let mut heats = known.heats;
        // What belongs to points that are settled stays.
        let mut open = R::mask(|_| true);
        loop {
            let rise = known.rise(resistances, heat);
            let bodies = Bodies::Held(rise.map(|rise| self.oil.supplied.temperature + rise));
            let found = self.run(bodies, open, mu, &mut tally, seen.as_deref_mut());
            let settled = found.rise(resistances, found.heat);
            let off = (settled[0] - rise[0]).abs().max((settled[1] - rise[1]).abs());
            heats = [0, 1].map(|i| R::select(open, found.heats[i], heats[i]));
            open = open & off.is_above(R::constant(SETTLED));
            if !open.any() || tally.runs == MOST_RUNS {
                return Solved { bodies, heats, tally };
            }
            heat = R::select(open, search.next(heat, found.heat), heat);
            known = Sums::select(open, found, known);
        }
    }
}
