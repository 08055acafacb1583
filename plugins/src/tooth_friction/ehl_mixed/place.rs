//! One contact with its heat: friction determines the film temperature, which determines friction.
//!
//! A coefficient of friction gives the heat, the heat gives the temperatures of bodies, surfaces, inlet and film, and these give
//! the coefficient. The unknown is therefore one number between zero and the larger of boundary friction and the slope of the
//! limiting stress. Common iterations on temperatures are the same loop with fixed relaxation.

use super::contact::Contact;
use super::film::{Factor, Film, Inlet};
use super::mixed::{boundary_share, friction};
use super::oil::Oil;
use super::settled::Search;
use super::temperature::{FilmHeat, Flank, first_heat, first_share};
use super::traction::Transit;

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
    /// Flanks.
    pub flank: Flank,
    /// False for contacts that friction does not heat.
    pub thermal: bool,
}

/// Body temperatures of both gears. \[degC\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bodies {
    /// Each contact heats them by its own heat through these resistances. \[K/W\]
    Rising([f64; 2]),
    /// They are prescribed; the heat is split as in a contact that heats them through these resistances.
    Split([f64; 2], [f64; 2]),
    /// They are prescribed, and both sides of a film have the same temperature.
    Held([f64; 2]),
}

/// Conditions shared by all points of one iteration along the path: formulas, oil and bodies, and the oil at the inlet if the body
/// temperatures are prescribed.
#[derive(Clone, Copy)]
pub struct Conditions<'a> {
    laws: &'a Laws,
    oil: &'a Oil<'a>,
    bodies: Bodies,
    inlet: Option<[f64; 3]>,
}

impl<'a> Conditions<'a> {
    /// Conditions at these body temperatures.
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

/// Slide-to-roll ratio below which only the film acts. Friction is zero at the pitch point, where boundary friction does not
/// dissipate power.
const ROLLING: f64 = 0.001;
/// Convergence tolerance of the film temperature. Friction falls by about a percent per kelvin, and the last iteration removes most
/// of the remaining error. \[K\]
const SETTLED: f64 = 0.005;
/// Maximum number of iterations of a contact: bisection has then narrowed the bracket to 1e-6.
const MOST_PASSES: u32 = 160;
/// Typical derivative of the friction map; initial guess for the first contact of a path.
const USUAL_SLOPE: f64 = -0.2;

/// A converged contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settled {
    /// Coefficient of friction.
    pub mu: f64,
    /// Coefficient of friction of the film alone.
    pub mu_film: f64,
    /// Film thickness over roughness.
    pub lambda: f64,
    /// Share of boundary friction.
    pub boundary: f64,
    /// Film thickness. \[m\]
    pub film: f64,
    /// Film temperature. \[degC\]
    pub temperature: f64,
    /// Body temperatures. \[degC\]
    pub bodies: [f64; 2],
    /// Heat into both bodies. \[W\]
    pub heats: [f64; 2],
    /// Viscosity in the film. \[Pa s\]
    pub eta: f64,
    /// Shear rate times viscosity over Eyring stress.
    pub s: f64,
    /// Relaxation of the oil relative to its transit.
    pub d0: f64,
    /// Film temperature rise per coefficient of friction. \[K\]
    warming: f64,
}

/// A point on the path: a loaded contact and its oil.
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
    /// Film thickness if the body temperatures are prescribed. \[m\]
    known_film: Option<f64>,
}

impl<'a> Place<'a> {
    /// A contact with its roughness (m). Load and mean speed are above zero.
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

    /// Film thickness for inlet oil with a viscosity (Pa s), a pressure-viscosity coefficient (1/Pa) and a relative decrease of
    /// viscosity with temperature (1/K). \[m\]
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

    /// Evaluates the contact at a coefficient of friction; `mu` of the result is the resulting coefficient.
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

    /// Resistances of the contact bands on both flanks. \[K/W\]
    pub fn bands(&self) -> [f64; 2] {
        self.bands
    }

    /// Mean pressure. \[Pa\]
    pub fn mean_pressure(&self) -> f64 {
        self.contact.mean_pressure
    }

    /// Smaller of the Peclet numbers of both flanks.
    pub fn peclet(&self) -> f64 {
        let slow = self.contact.speeds[0].min(self.contact.speeds[1]);
        self.laws.flank.peclet(self.contact.half_width, slow)
    }

    /// Solves the contact from an initial guess of its friction; `slope` is the last estimate of the derivative of the friction
    /// map. Counts iterations.
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

/// An initial slope for a path.
pub const fn first_slope() -> f64 {
    USUAL_SLOPE
}
