//! One contact with its heat: friction decides the temperature of the film, which decides friction.
//!
//! Given a coefficient of friction, the heat is known, from it the temperatures of bodies, surfaces, inlet and film, and from these
//! the coefficient. So one number is sought, and it lies between zero and the greater of boundary friction and the slope of the
//! limiting stress. Usual iterations on temperatures are the same loop with a fixed relaxation.

use super::contact::Contact;
use super::film::{Factor, Film, Inlet};
use super::mixed::{boundary_share, friction};
use super::oil::Oil;
use super::settled::Search;
use super::temperature::{FilmHeat, Flank, first_heat, first_share};
use super::traction::Transit;

/// Which formulas count, and the properties of the flanks. One for all contacts of a mesh.
#[derive(Debug, Clone, Copy)]
pub struct Laws {
    /// Film thickness.
    pub film: Film,
    /// Its loss by heating at the inlet.
    pub inlet: Factor,
    /// How the stress builds up.
    pub transit: Transit,
    /// Where in the film its heat arises.
    pub film_heat: FilmHeat,
    /// Exponent of the share of boundary friction.
    pub exponent: f64,
    /// Flanks.
    pub flank: Flank,
    /// False for contacts that friction does not warm.
    pub thermal: bool,
}

/// Temperatures of the bodies of both gears. \[degC\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bodies {
    /// Each contact warms them by its own heat through these resistances. \[K/W\]
    Rising([f64; 2]),
    /// They have these temperatures; heat goes to where it meets less resistance, as in a contact that warms them through these.
    Split([f64; 2], [f64; 2]),
    /// They have these temperatures, and both sides of a film share one.
    Held([f64; 2]),
}

/// What all places of one way along the path share: formulas, oil and bodies, and the oil at the inlet where the bodies' temperatures
/// are known beforehand.
#[derive(Clone, Copy)]
pub struct Conditions<'a> {
    laws: &'a Laws,
    oil: &'a Oil<'a>,
    bodies: Bodies,
    inlet: Option<[f64; 3]>,
}

impl<'a> Conditions<'a> {
    /// Conditions with these bodies.
    pub fn new(laws: &'a Laws, oil: &'a Oil<'a>, bodies: Bodies) -> Self {
        let enters = match bodies {
            _ if !laws.thermal => Some(oil.supplied.temperature),
            Bodies::Rising(_) => None,
            Bodies::Split([t1, t2], _) | Bodies::Held([t1, t2]) => Some(0.5 * (t1 + t2)),
        };
        Self {
            laws,
            oil,
            bodies,
            inlet: enters.map(|t| oil.inlet(t)),
        }
    }
}

/// Slide to roll ratio below which nothing but the film acts. Friction is zero at the pitch point, and boundary friction does not
/// lose power there.
const ROLLING: f64 = 0.001;
/// Film temperature within which a contact has settled. Friction falls by about a percent per kelvin, and the last pass takes most of
/// what is left. \[K\]
const SETTLED: f64 = 0.005;
/// Passes after which a contact counts as settled: halving has then closed the bracket to 1e-6.
const MOST_PASSES: u32 = 160;
/// Usual fall of friction with itself; the first contact of a path starts with it.
const USUAL_SLOPE: f64 = -0.2;

/// A contact that has settled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settled {
    /// Coefficient of friction.
    pub mu: f64,
    /// That of the film alone.
    pub mu_film: f64,
    /// Film over roughness.
    pub lambda: f64,
    /// Share of boundary friction.
    pub boundary: f64,
    /// Film thickness. \[m\]
    pub film: f64,
    /// Temperature of the film. \[degC\]
    pub temperature: f64,
    /// Temperatures of the bodies. \[degC\]
    pub bodies: [f64; 2],
    /// Heat into both bodies. \[W\]
    pub heats: [f64; 2],
    /// Viscosity in the film. \[Pa s\]
    pub eta: f64,
    /// Shear rate, viscosity and Eyring stress in one.
    pub s: f64,
    /// Relaxation of the oil over its transit.
    pub d0: f64,
    /// How much the film warms per coefficient of friction. \[K\]
    warming: f64,
}

/// A place on the path: a contact under load and its oil.
pub struct Place<'a> {
    laws: &'a Laws,
    oil: &'a Oil<'a>,
    bodies: Bodies,
    contact: Contact,
    /// Root mean square roughness of both flanks. \[m\]
    rq: f64,
    speed: f64,
    sliding: f64,
    slide_roll: f64,
    /// Heat per coefficient of friction. \[W\]
    heat: f64,
    bands: [f64; 2],
    pressed: f64,
    limit: f64,
    most: f64,
    /// Film where the bodies' temperatures are known beforehand. \[m\]
    known_film: Option<f64>,
}

impl<'a> Place<'a> {
    /// A contact and the roughness (m). Load and mean speed are above zero.
    pub fn new(conditions: &Conditions<'a>, contact: Contact, rq: f64) -> Self {
        let Conditions {
            laws,
            oil,
            bodies,
            inlet,
        } = *conditions;
        let [u1, u2] = contact.speeds;
        let (speed, sliding) = (0.5 * (u1 + u2), (u1 - u2).abs());
        let rheology = oil.rheology;
        let mut place = Self {
            laws,
            oil,
            bodies,
            contact,
            rq,
            speed,
            sliding,
            slide_roll: sliding / speed,
            heat: contact.line_load * contact.length * sliding,
            bands: contact
                .speeds
                .map(|u| laws.flank.resistance(contact.half_width, contact.length, u)),
            pressed: oil.law.pressed(contact.mean_pressure),
            limit: rheology.limiting_slope * contact.mean_pressure / rheology.tau0,
            most: rheology.mu_b.max(rheology.limiting_slope),
            known_film: None,
        };
        place.known_film = inlet.map(|inlet| place.film(inlet));
        place
    }

    /// Film for oil that enters with a viscosity (Pa s), a pressure-viscosity coefficient (1/Pa) and a fall of viscosity with
    /// temperature (1/K). \[m\]
    fn film(&self, [eta, alpha, beta]: [f64; 3]) -> f64 {
        let Contact {
            line_load,
            radius,
            modulus,
            length,
            ..
        } = self.contact;
        let stiff = modulus * radius;
        let (u, g, w) = (eta * self.speed / stiff, alpha * modulus, line_load / stiff);
        let inlet = Inlet {
            speed: self.speed,
            slide_roll: self.slide_roll,
            thermal_load: eta * beta * self.speed * self.speed / self.oil.supplied.conductivity,
            pressure: self.contact.pressure() / modulus,
            g,
            w,
        };
        radius * self.laws.film.over_radius(u, g, w, length / radius) * (self.laws.inlet)(&inlet)
    }

    /// What a coefficient of friction leads to; `mu` of the answer is the coefficient that follows.
    pub fn after(&self, mu: f64) -> Settled {
        let supplied = &self.oil.supplied;
        let heat = mu * self.heat;
        let (bodies, first, sides) = match self.bodies {
            Bodies::Rising(m) => {
                let share = first_share(self.bands, m);
                let to = [share * heat, (1.0 - share) * heat];
                let t = [0, 1].map(|i| supplied.temperature + m[i] * to[i]);
                (t, to[0], share * (m[0] + self.bands[0]))
            }
            Bodies::Split(t, m) => {
                let share = first_share(self.bands, m);
                let sides = 0.5 * (share * self.bands[0] + (1.0 - share) * self.bands[1]);
                (t, share * heat, sides)
            }
            Bodies::Held(t) => {
                let [b1, b2] = self.bands;
                (t, first_heat(heat, self.bands, t), b1 * b2 / (b1 + b2))
            }
        };
        let bodies = if self.laws.thermal {
            bodies
        } else {
            [supplied.temperature; 2]
        };
        let inlet = 0.5 * (bodies[0] + bodies[1]);
        let h = self.known_film.unwrap_or_else(|| self.film(self.oil.inlet(inlet)));
        let area = 2.0 * self.contact.half_width * self.contact.length;
        let above = self.laws.film_heat.resistance(h, supplied.conductivity, area);
        let surfaces = 0.5 * (bodies[0] + first * self.bands[0] + bodies[1] + (heat - first) * self.bands[1]);
        let temperature = if self.laws.thermal {
            surfaces + heat * above
        } else {
            supplied.temperature
        };
        let rheology = self.oil.rheology;
        let eta = self.oil.law.eta_pressed(self.pressed, temperature);
        let s = self.sliding / h * eta / rheology.tau0;
        let d0 = eta * self.speed / (2.0 * self.contact.half_width * rheology.shear_modulus);
        let stress = self.laws.transit.mean_stress(s, d0, self.limit);
        let mu_film = rheology.tau0 * stress / self.contact.mean_pressure;
        let lambda = h / self.rq;
        let boundary = if self.slide_roll < ROLLING {
            0.0
        } else {
            boundary_share(lambda, self.laws.exponent)
        };
        Settled {
            mu: friction(mu_film, rheology.mu_b, boundary),
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
                0.0
            },
        }
    }

    /// Heat per coefficient of friction. \[W\]
    pub fn heat_per_mu(&self) -> f64 {
        self.heat
    }

    /// Resistances of the bands of contact on both flanks. \[K/W\]
    pub fn bands(&self) -> [f64; 2] {
        self.bands
    }

    /// Mean pressure. \[Pa\]
    pub fn mean_pressure(&self) -> f64 {
        self.contact.mean_pressure
    }

    /// Lower one of the Peclet numbers of both flanks.
    pub fn peclet(&self) -> f64 {
        let slow = self.contact.speeds[0].min(self.contact.speeds[1]);
        self.laws.flank.peclet(self.contact.half_width, slow)
    }

    /// The contact at rest with itself, from a guess at its friction; `slope` is what friction was last seen to fall by with
    /// itself. Counts passes.
    pub fn settle(&self, guess: f64, slope: &mut f64, passes: &mut u32) -> Settled {
        let mut search = Search::new(self.most, *slope);
        let mut mu = guess.clamp(0.0, self.most);
        let mut found = self.after(mu);
        let mut pass = 1;
        while (found.mu - mu).abs() * found.warming > SETTLED && pass < MOST_PASSES {
            mu = search.next(mu, found.mu);
            found = self.after(mu);
            pass += 1;
        }
        *slope = search.slope();
        *passes += pass;
        found
    }
}

/// A slope to start a path with.
pub const fn first_slope() -> f64 {
    USUAL_SLOPE
}
