//! The film of a plain bearing at an operating point: its temperature, its thickness, its friction.

use std::f64::consts::PI;

use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::ShopUnits as _;
use gearloss_framework::mechanism::bearing::{BearingAt, BearingKind, BearingPart};
use gearloss_framework::real::{Mask as _, Real};

use super::characteristics::{Characteristics, FilmFit, Place};
use super::stiffness::Loaded;

/// Coefficient of friction of surfaces without a film, if none is stated.
const SOLID_FRICTION: f64 = 0.1;
/// Density times specific heat of mineral oil, as in ISO 7902-1, quoted from memory. \[J/(m3 K)\]
const OIL_HEAT: f64 = 1.8e6;
/// Temperature at which the search for a balance ends; no oil lasts there. \[degC\]
const HOTTEST: f64 = 400.0;
/// Steps of bisection and of Newton's method of that search: the former leave 0.1 K, the latter 1e-5 K, 1e-11 K, then all digits, with the derivatives
/// of the implicit function.
const BISECTIONS: usize = 12;
const REFINEMENTS: usize = 3;
/// Step of its central differences; they have ten digits, as the oil changes by a factor over tens of K. \[K\]
const STEP: f64 = 1e-3;
/// Viscosity at which the line of Walther ends. \[mm2/s\]
const THINNEST: f64 = 0.5;
/// Logarithm of the highest viscosity of that line with its constant, as for oils. \[ln mm2/s\]
const THICKEST: f64 = 36.0;
/// Speed that replaces standstill in So. \[rad/s\]
const SLOWEST: f64 = 1e-12;

/// A plain bearing, prepared. Lengths in m.
#[derive(Debug)]
pub struct Journal {
    functions: Characteristics,
    /// Diameter D.
    pub diameter: f64,
    /// Width B.
    pub width: f64,
    /// Relative clearance psi.
    pub psi: f64,
    /// Thickness h_lim at which the surfaces touch.
    pub least: f64,
    /// Coefficient of friction without a film.
    solid: f64,
    /// True if the load keeps its direction in space.
    fixed_in_space: bool,
    cooling: Option<Cooling>,
}

/// How a film gives off its heat.
#[derive(Debug)]
struct Cooling {
    /// \[W/K\]
    conductance: f64,
    /// \[degC\]; `None`: that of the oil.
    surroundings: Option<f64>,
    /// True if fresh oil carries heat away.
    fed: bool,
    /// Temperature of the fresh oil, as before.
    supply: Option<f64>,
}

/// The film at a point.
#[derive(Debug, Clone, Copy)]
pub struct Film<R> {
    /// \[degC\]
    pub temperature: R,
    /// \[Pa s\]
    pub eta: R,
    /// Relative load So.
    pub sommerfeld: R,
    /// Where the shaft is.
    pub place: Place<R>,
    /// Sine of the attitude angle.
    pub sine: R,
    /// Minimum thickness. \[m\]
    pub thickness: R,
    /// Share of the friction of touching surfaces.
    pub touching: R,
    /// Moment of the film around a shaft in the middle, of its eccentricity, and of touching surfaces. \[Nm\]
    pub moments: [R; 3],
    /// Side flow Q3. \[m3/s\]
    pub flow: R,
    /// dF/d(eps c) at constant speed and viscosity, c the clearance of the radius. \[N/m\]
    pub stiffness: R,
    /// Reynolds number over its critical one, 41.3/sqrt(psi).
    pub turbulence: R,
}

impl<R: Real> Film<R> {
    /// The whole moment. \[Nm\]
    #[inline(always)]
    pub fn moment(&self) -> R {
        let [concentric, eccentric, contact] = self.moments;
        concentric + eccentric + contact
    }
}

impl Journal {
    /// A plain bearing; `None` for other bearings.
    pub fn of(part: &BearingPart, fit: FilmFit) -> Option<Self> {
        let (BearingKind::Plain, Some(film), Some(width)) = (part.kind, part.film, part.width) else {
            return None;
        };
        Some(Self {
            functions: Characteristics::new(fit, width / part.bore),
            diameter: part.bore,
            width,
            psi: film.relative_clearance?,
            least: film.least_thickness?,
            solid: film.solid_friction.unwrap_or(SOLID_FRICTION),
            fixed_in_space: film.load_fixed_in_space,
            cooling: film.conductance.map(|conductance| Cooling {
                conductance,
                surroundings: film.surroundings,
                fed: film.fed,
                supply: film.supply,
            }),
        })
    }

    /// True if its film has a temperature of its own.
    pub fn is_cooled(&self) -> bool {
        self.cooling.is_some()
    }

    /// A film under its load, whose stiffness is asked.
    #[inline(always)]
    pub fn loaded<R: Real>(&self, force: R, film: &Film<R>) -> Loaded<R> {
        let clearance = 0.5 * self.psi * self.diameter;
        Loaded {
            force,
            slope: film.stiffness,
            eccentricity: film.place.eccentricity * clearance,
            sine: film.sine,
            turning: self.functions.turning(&film.place) / clearance,
        }
    }

    /// The film at a point.
    ///
    /// # Errors
    /// If it has no temperature at which it gives off its loss.
    #[inline(always)]
    pub fn film<R: Real>(&self, at: &BearingAt<'_, R>) -> Result<Film<R>, Undefined> {
        match &self.cooling {
            None => Ok(self.film_of(at, at.temperature, at.nu * at.rho)),
            Some(cooling) => Ok(self.film_at(at, self.balance(at, cooling)?)),
        }
    }

    #[inline(always)]
    fn film_at<R: Real>(&self, at: &BearingAt<'_, R>, temperature: R) -> Film<R> {
        self.film_of(at, temperature, viscosity(at, temperature))
    }

    #[inline(always)]
    fn film_of<R: Real>(&self, at: &BearingAt<'_, R>, temperature: R, eta: R) -> Film<R> {
        let (diameter, radius) = (self.diameter, 0.5 * self.diameter);
        let speed = at.speed.abs();
        // The sum of both speeds relative to the load.
        let drawing = if self.fixed_in_space {
            (at.speed + at.outer_speed * 2.0).abs()
        } else {
            speed
        };
        // F over So.
        let carried = eta * drawing.at_least(SLOWEST) * (diameter * self.width / (self.psi * self.psi));
        let sommerfeld = at.radial / carried;
        let place = self.functions.place(sommerfeld);
        let (_, slope) = self.functions.load(&place);
        let sine = self.functions.sine_of_angle(&place);
        let thickness = place.room * (self.psi * radius);
        let touching = (R::constant(1.0) - thickness / self.least).at_least(0.0);
        let petroff = eta * speed * (PI * self.width * diameter * diameter / (2.0 * self.psi));
        let of_film = R::constant(1.0) - touching;
        let friction = place.eccentricity * sine * at.radial * (0.5 * self.psi * radius);
        let eccentric = petroff * (R::constant(1.0) / place.root() - 1.0) + friction;
        Film {
            temperature,
            eta,
            sommerfeld,
            place,
            sine,
            thickness,
            touching,
            moments: [
                petroff * of_film,
                eccentric * of_film,
                at.radial * touching * (self.solid * radius),
            ],
            flow: self.functions.flow(&place) * drawing * (diameter.powi(3) * self.psi),
            stiffness: carried * slope / (self.psi * radius),
            turbulence: at.rho * drawing / eta * (radius * radius * self.psi * self.psi.sqrt() / 41.3),
        }
    }

    /// Temperature at which the film gives off its loss: P = k (T - T_s) + rho c Q3 2 (T - T_in), for a mean T of the oil that enters and the
    /// oil that leaves. \[degC\]
    #[inline(always)]
    fn balance<R: Real>(&self, at: &BearingAt<'_, R>, cooling: &Cooling) -> Result<R, Undefined> {
        let stated = |temperature: Option<f64>| temperature.map_or(at.temperature, R::constant);
        let surroundings = stated(cooling.surroundings);
        let supply = cooling.fed.then(|| stated(cooling.supply));
        let excess = |temperature: R| {
            let film = self.film_at(at, temperature);
            let kept = film.moment() * at.speed.abs() - (temperature - surroundings) * cooling.conductance;
            supply.map_or(kept, |supply| {
                kept - film.flow * (temperature - supply) * (2.0 * OIL_HEAT)
            })
        };
        let mut high = R::constant(HOTTEST);
        let mut low = supply.map_or(surroundings, |supply| surroundings.min(supply));
        if excess(high).is_above(R::ZERO).agreed()? {
            return Err(Undefined {
                what: "loss of a plain bearing that gives off less heat than it produces, even with a film at 400 degC: conductance in W/K",
                value: cooling.conductance,
            });
        }
        for _ in 0..BISECTIONS {
            let middle = (low + high) * 0.5;
            let heats_up = excess(middle).is_above(R::ZERO);
            (low, high) = (R::select(heats_up, middle, low), R::select(heats_up, high, middle));
        }
        let mut temperature = (low + high) * 0.5;
        for _ in 0..REFINEMENTS {
            let slope = (excess(temperature + STEP) - excess(temperature - STEP)) * (0.5 / STEP);
            let refined = temperature - excess(temperature) / slope;
            temperature = R::select(slope.is_below(R::ZERO), refined, temperature);
        }
        Ok(temperature)
    }
}

/// Viscosity of the oil at another temperature: the line of Walther through its viscosity at the bearing, with its slope there; at the density
/// there. \[Pa s\]
#[inline(always)]
fn viscosity<R: Real>(at: &BearingAt<'_, R>, temperature: R) -> R {
    const CONSTANT: f64 = 0.7;
    const KELVIN: f64 = 273.15;
    let nu = at.nu.mm2_s().at_least(THINNEST);
    let z = nu + CONSTANT;
    let ln_z = z.ln();
    let here = at.temperature + KELVIN;
    let b = at.beta * here * nu / (z * ln_z);
    let ln_z = (ln_z * (((temperature + KELVIN) / here).ln() * -b).exp()).at_most(THICKEST);
    (ln_z.exp() - CONSTANT).at_least(THINNEST) * at.rho * 1e-6
}
