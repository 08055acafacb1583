//! One contact with its heat: friction determines the film temperature, which determines friction.
//!
//! A coefficient of friction gives the heat, the heat gives the temperatures of bodies, surfaces, inlet and film, and these give
//! the coefficient. The unknown is therefore one number between zero and the larger of boundary friction and the slope of the
//! limiting stress. Common iterations on temperatures are the same loop with fixed relaxation.

use gearloss_framework::material::Conductor;
use gearloss_framework::real::{Mask as _, Points};

use super::contact::{Contact, Logarithms};
use super::film::{Factor, Film, Inlet, InletLogarithms};
use super::mixed::{boundary_share, friction};
use super::oil::{InletOil, Oil};
use super::settled::Search;
use super::temperature::{FilmHeat, first_heat, first_share};
use super::traction::{Limit, Transit};

/// Selected formulas and the properties of the flanks, common to all contacts of a mesh.
#[derive(Debug, Clone, Copy)]
pub struct Laws {
    /// Film thickness formula.
    pub film: Film,
    /// Film thinning by inlet heating.
    pub inlet: Factor,
    /// Build-up of the stress.
    pub transit: Transit,
    /// Location of the heat source in the film.
    pub film_heat: FilmHeat,
    /// Exponent of the share of boundary friction.
    pub exponent: f64,
    /// Flanks of both gears.
    pub flanks: [Conductor; 2],
    /// False for contacts that friction does not heat.
    pub thermal: bool,
}

/// Body temperatures of both gears. \[degC\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bodies<R = f64> {
    /// Each contact heats them by its own heat through these resistances. \[K/W\]
    Rising([R; 2]),
    /// They are prescribed; the heat is split as in a contact that heats them through these resistances.
    Split([R; 2], [R; 2]),
    /// They are prescribed, and both sides of a film have the same temperature.
    Held([R; 2]),
}

/// Conditions shared by all points of one iteration along the path: formulas, oil and bodies, and the oil at the inlet if the body
/// temperatures are prescribed.
#[derive(Clone, Copy)]
pub struct Conditions<'a, R = f64> {
    laws: &'a Laws,
    oil: &'a Oil<'a, R>,
    bodies: Bodies<R>,
    inlet: Option<InletOil<R>>,
}

impl<'a, R: Points> Conditions<'a, R> {
    /// Conditions at these body temperatures.
    #[inline(always)]
    pub fn new(laws: &'a Laws, oil: &'a Oil<'a, R>, bodies: Bodies<R>) -> Self {
        let enters = match bodies {
            _ if !laws.thermal => Some(oil.supplied.temperature),
            Bodies::Rising(_) => None,
            Bodies::Split([t1, t2], _) | Bodies::Held([t1, t2]) => Some((t1 + t2) * 0.5),
        };
        Self {
            laws,
            oil,
            bodies,
            inlet: enters.map(|t| oil.inlet(t)),
        }
    }
}

/// Slide-to-roll ratio below which only the film acts. Friction is zero at the pitch point, where boundary friction does not
/// dissipate power.
const ROLLING: f64 = 0.001;
/// Convergence tolerance of the film temperature. Friction falls by about a percent per kelvin, and the last secant removes most of
/// the remaining error. \[K\]
const SETTLED: f64 = 0.005;
/// Change of the film temperature in an iteration up to which a secant that agrees with the one before is the solution. \[K\]
const NEAR: f64 = 0.1;
/// Maximum number of iterations of a contact: bisection has then narrowed the bracket to 1e-6.
const MOST_PASSES: u32 = 160;
/// Typical derivative of the friction map; initial guess for the first contact of a path.
const USUAL_SLOPE: f64 = -0.2;

/// A converged contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settled<R = f64> {
    /// Coefficient of friction.
    pub mu: R,
    /// Coefficient of friction of the film alone.
    pub mu_film: R,
    /// Film thickness over roughness.
    pub lambda: R,
    /// Share of boundary friction.
    pub boundary: R,
    /// Film thickness. \[m\]
    pub film: R,
    /// Film temperature. \[degC\]
    pub temperature: R,
    /// Body temperatures. \[degC\]
    pub bodies: [R; 2],
    /// Heat into both bodies. \[W\]
    pub heats: [R; 2],
    /// Viscosity in the film. \[Pa s\]
    pub eta: R,
    /// Shear rate times viscosity over Eyring stress.
    pub s: R,
    /// Relaxation of the oil relative to its transit.
    pub d0: R,
    /// Film temperature rise per coefficient of friction. \[K\]
    warming: R,
}

/// The solution of a contact, with its last evaluation.
#[derive(Debug, Clone, Copy)]
pub struct Found<R = f64> {
    /// Coefficient of friction.
    pub mu: R,
    /// The coefficient that was evaluated last, and its result.
    at: R,
    last: Settled<R>,
}

impl<R: Points> Found<R> {
    /// The last evaluation, brought to the solution. With prescribed body temperatures the film temperature is linear in the friction, and the film
    /// does not depend on it; shear rate and viscosity stay those of the last evaluation.
    #[inline(always)]
    pub fn settled(&self) -> Settled<R> {
        let Self { mu, at, last } = *self;
        let of_film = R::constant(1.0) - last.boundary;
        let film_step = R::select(of_film.is_zero(), R::ZERO, (mu - last.mu) / of_film);
        Settled {
            mu,
            mu_film: last.mu_film + film_step,
            temperature: last.temperature + (mu - at) * last.warming,
            ..last
        }
    }
}

/// Bodies under a friction heat.
struct Heated<R> {
    /// Their temperatures. \[degC\]
    bodies: [R; 2],
    /// Heat into the first. \[W\]
    first: R,
    /// Mean temperature rise of both surfaces per heat. \[K/W\]
    sides: R,
}

/// A point on the path: a contact and its oil.
pub struct Place<'a, R: Points = f64> {
    laws: &'a Laws,
    oil: &'a Oil<'a, R>,
    bodies: Bodies<R>,
    contact: Contact<R>,
    ln: Logarithms<R>,
    /// Root mean square roughness of both flanks. \[m\]
    rq: R,
    speed: R,
    sliding: R,
    slide_roll: R,
    /// Heat per coefficient of friction. \[W\]
    heat: R,
    bands: [R; 2],
    pressed: R,
    limit: Limit<R>,
    most: f64,
    /// Film thickness if the body temperatures are prescribed. \[m\]
    known_film: Option<R>,
}

impl<'a, R: Points> Place<'a, R> {
    /// A contact with its logarithms and roughness (m). Its mean speed is above zero; without load nothing of it is defined.
    #[inline(always)]
    pub fn new(conditions: &Conditions<'a, R>, contact: Contact<R>, ln: Logarithms<R>, rq: R) -> Self {
        let Conditions {
            laws,
            oil,
            bodies,
            inlet,
        } = *conditions;
        let [u1, u2] = contact.speeds;
        let (speed, sliding) = ((u1 + u2) * 0.5, (u1 - u2).abs());
        let rheology = oil.rheology;
        let resistance =
            |gear: usize, speed: R| laws.flanks[gear].resistance(contact.half_width, contact.length, speed);
        let mut place = Self {
            laws,
            oil,
            bodies,
            contact,
            ln,
            rq,
            speed,
            sliding,
            slide_roll: sliding / speed,
            heat: contact.line_load * contact.length * sliding,
            bands: [resistance(0, u1), resistance(1, u2)],
            pressed: oil.law.pressed(contact.mean_pressure),
            limit: Limit::new(contact.mean_pressure * (rheology.limiting_slope / rheology.tau0)),
            most: rheology.mu_b.max(rheology.limiting_slope),
            known_film: None,
        };
        if let Some(inlet) = inlet {
            place.known_film = Some(place.film(&inlet));
        }
        place
    }

    /// Film thickness for the oil at the inlet. \[m\]
    #[inline(always)]
    fn film(&self, oil: &InletOil<R>) -> R {
        let (contact, ln) = (&self.contact, &self.ln);
        let inlet = Inlet {
            speed: self.speed,
            slide_roll: self.slide_roll,
            thermal_load: oil.unit_thermal_load * self.speed * self.speed,
            pressure: contact.pressure() / contact.modulus,
            g: oil.alpha * contact.modulus,
            w: contact.line_load / (contact.modulus * contact.radius),
        };
        let ln_stiff = ln.modulus + ln.radius;
        let ln_inlet = InletLogarithms {
            slide_roll: ln.slide_roll,
            thermal_load: oil.ln_unit_thermal_load + ln.speed * 2.0,
            g: oil.ln_alpha + ln.modulus,
            w: ln.line_load - ln_stiff,
        };
        let ln_u = oil.ln_eta + ln.speed - ln_stiff;
        let film = self.laws.film;
        let over_radius = film.over_radius(ln_u, ln_inlet.g, ln_inlet.w, ln.length - ln.radius);
        contact.radius * over_radius * self.laws.inlet.at(&inlet, &ln_inlet)
    }

    /// What a friction heat (W) does to the bodies.
    #[inline(always)]
    fn heated(&self, heat: R) -> Heated<R> {
        let supplied = &self.oil.supplied;
        let one = R::constant(1.0);
        let [b1, b2] = self.bands;
        let (bodies, first, sides) = match self.bodies {
            Bodies::Rising(m) => {
                let share = first_share(self.bands, m);
                let to = [share * heat, (one - share) * heat];
                let t = [supplied.temperature + m[0] * to[0], supplied.temperature + m[1] * to[1]];
                (t, to[0], share * (m[0] + b1))
            }
            Bodies::Split(t, m) => {
                let share = first_share(self.bands, m);
                let sides = (share * b1 + (one - share) * b2) * 0.5;
                (t, share * heat, sides)
            }
            Bodies::Held(t) => (t, first_heat(heat, self.bands, t), b1 * b2 / (b1 + b2)),
        };
        let bodies = if self.laws.thermal {
            bodies
        } else {
            [supplied.temperature; 2]
        };
        Heated { bodies, first, sides }
    }

    /// Body temperatures (degC) and the heat into both (W) at a coefficient of friction.
    #[inline(always)]
    pub fn heat_bodies(&self, mu: R) -> ([R; 2], [R; 2]) {
        let heat = mu * self.heat;
        let Heated { bodies, first, .. } = self.heated(heat);
        (bodies, [first, heat - first])
    }

    /// Evaluates the contact at a coefficient of friction; `mu` of the result is the resulting coefficient.
    #[inline(always)]
    pub fn after(&self, mu: R) -> Settled<R> {
        let supplied = &self.oil.supplied;
        let heat = mu * self.heat;
        let [b1, b2] = self.bands;
        let Heated { bodies, first, sides } = self.heated(heat);
        let inlet = (bodies[0] + bodies[1]) * 0.5;
        let h = match self.known_film {
            Some(film) => film,
            None => self.film(&self.oil.inlet(inlet)),
        };
        let area = self.contact.half_width * 2.0 * self.contact.length;
        let above = self.laws.film_heat.resistance(h, supplied.conductivity, area);
        let surfaces = (bodies[0] + first * b1 + bodies[1] + (heat - first) * b2) * 0.5;
        let temperature = if self.laws.thermal {
            surfaces + heat * above
        } else {
            supplied.temperature
        };
        let rheology = self.oil.rheology;
        let eta = self.oil.law.eta_pressed(self.pressed, temperature);
        let s = self.sliding / h * eta / rheology.tau0;
        let d0 = eta * self.speed / (self.contact.half_width * (2.0 * rheology.shear_modulus));
        let stress = self.laws.transit.mean_stress(s, d0, &self.limit);
        let mu_film = stress * rheology.tau0 / self.contact.mean_pressure;
        let lambda = h / self.rq;
        let rolls = self.slide_roll.is_below(R::constant(ROLLING));
        let boundary = R::select(rolls, R::ZERO, boundary_share(lambda, self.laws.exponent));
        Settled {
            mu: friction(mu_film, R::constant(rheology.mu_b), boundary),
            mu_film,
            lambda,
            boundary,
            film: h,
            temperature,
            bodies,
            heats: [first, heat - first],
            eta,
            s,
            d0,
            warming: if self.laws.thermal {
                self.heat * (sides + above)
            } else {
                R::ZERO
            },
        }
    }

    /// Heat per coefficient of friction. \[W\]
    #[inline(always)]
    pub fn heat_per_mu(&self) -> R {
        self.heat
    }

    /// Where it carries load.
    #[inline(always)]
    pub fn loaded(&self) -> R::Mask {
        self.contact.line_load.is_above(R::ZERO)
    }

    /// Resistances of the contact bands on both flanks. \[K/W\]
    #[inline(always)]
    pub fn bands(&self) -> [R; 2] {
        self.bands
    }

    /// Mean pressure. \[Pa\]
    #[inline(always)]
    pub fn mean_pressure(&self) -> R {
        self.contact.mean_pressure
    }

    /// Smaller of the Peclet numbers of both flanks.
    #[inline(always)]
    pub fn peclet(&self) -> R {
        let [first, second] = self.contact.speeds;
        let [a, b] = &self.laws.flanks;
        let half_width = self.contact.half_width;
        a.peclet(half_width, first).min(b.peclet(half_width, second))
    }

    /// Solves the contact from an initial guess of its friction; `slope` is the last estimate of the derivative of the friction map. Counts
    /// iterations. A point that has converged keeps its friction while others iterate.
    #[inline(always)]
    pub fn settle(&self, guess: R, slope: &mut R, passes: &mut u32) -> Found<R> {
        let near = |difference: R, tolerance: f64| difference.abs().is_below(R::constant(tolerance));
        let mut search = Search::new(R::constant(self.most), *slope);
        let mut mu = guess.at_least(0.0).at_most(self.most);
        let mut solved = mu;
        let mut running = self.loaded();
        let mut pass = 0;
        loop {
            let found = self.after(mu);
            pass += 1;
            let expected = search.secant(mu, found.mu);
            let next = search.next(mu, found.mu);
            // The slope of another contact is good for a guess, not for a result: of a small load it may be far from its own.
            let solution = if pass == 1 {
                found.mu
            } else {
                search.solution(mu, found.mu)
            };
            solved = R::select(running, solution, solved);
            *slope = R::select(running, search.slope(), *slope);
            let left = (found.mu - mu) * found.warming;
            running = running & left.abs().is_above(R::constant(SETTLED));
            if pass > 1 {
                // The error of a secant with a measured slope is far less than what that slope has changed of it.
                let agrees = near((solved - expected) * found.warming, SETTLED) & near(left, NEAR);
                running = running & !agrees;
            }
            if !running.any() || pass == MOST_PASSES {
                *passes += pass;
                return Found {
                    mu: solved,
                    at: mu,
                    last: found,
                };
            }
            mu = R::select(running, next, mu);
        }
    }
}

/// An initial slope for a path.
pub const fn first_slope() -> f64 {
    USUAL_SLOPE
}
