//! Thermal elastohydrodynamic and mixed friction along the path of contact.
//!
//! Source: Shore and Kadiric, Optimization of electric vehicle drivetrain fluid with a new system-level approach: at each point of
//! the path the film according to Chittenden et al., thinned by inlet heating; viscosity according to Roelands at the mean Hertz pressure and the
//! film temperature; shear stress according to Johnson and Tevaarwerk with a limit, its mean over the transit according to Olver and Spikes;
//! flash and film temperature according to Blok; boundary friction from the film ratio. Each point converges with its own heat, the path
//! with the body temperatures of the gears. Where the publication has misprints (the factor eta_inf in its shear rate, the
//! viscosity in its flow groups), the form required by its other equations is used.
//!
//! It requires the rheology of the oil: Eyring stress, slope of the limiting stress, boundary friction; from traction and Stribeck
//! curves, or stated next to `type`. Body temperatures are the most uncertain part: a resistance of 0.01, 0.2 or 1 K/W per gear
//! instead of 0.05 changes the loss of a small helical stage at 30 kW and 2000 rpm by -2, +10 or +80 %. The article shares the load
//! by a ramp: `load_sharing: ramp` in the mesh model.
//! Not for starved or grease-lubricated gears; above about 1 GPa the viscosity is overestimated, but the limiting stress bounds its
//! effect. Rolling loss is not included. Bodies, load and film are quasi-steady.
//! Two limits are our own. Below a slide-to-roll ratio of 0.001 there is no boundary friction, because at the pitch point it dissipates
//! nothing; at 0.001 it sets in with its whole share, so that the coefficient jumps there, in a thin film by a factor of thirty and more.
//! The part of the path on which it is missing slides at most a thousandth of the rolling, so that its loss hardly counts. The viscosity
//! under pressure is at most 1e9 Pa s, that of a glass.

pub mod contact;
pub mod dilogarithm;
pub mod film;
pub mod identification;
pub mod march;
pub mod mixed;
pub mod oil;
pub mod place;
pub mod seen;
pub mod settled;
pub mod temperature;
pub mod traction;

#[cfg(test)]
pub(crate) mod cases;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Notes, Observed, Undefined};
use gearloss_framework::material::{Conductor, FAST};
use gearloss_framework::mechanism::gear_mesh::{GearMesh, MeshPart};
use gearloss_framework::mechanism::tooth_friction::{Along, ContactAt, PathAt, ToothFriction, ToothFrictionModel};
use gearloss_framework::real::{Lane, Points};
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use gearloss_framework::{limits, observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::flank_heat::{flanks, known};
use crate::rotating::Body;
use contact::Contact;
use film::{Factor, Film, InletHeating};
use march::{March, Solved, Tally, Warming, Warmth};
use oil::{MeshFluid, Oil, Supplied, Written};
use place::{Bodies, Conditions, Laws, Place, Settled, first_slope};
use seen::Seen;
use temperature::FilmHeat;
use traction::Transit;

limits! {
    PRESSURE = ("p_mean", "mean Hertzian pressure", "GPa", 0.0, 1.0, "pressure range of Roelands' law, quoted from memory");
    WARMTH = ("T_film", "film temperature", "degC", 20.0, 140.0,
        "where Roelands' law fitted at 40 and 100 degC is within 2 % of ASTM D341");
    PECLET = ("Pe", "Péclet number of the contact", "-", FAST, f64::INFINITY, "fast bands of contact, derived");
}

/// Bodies at different temperatures exchange heat even without friction; as a share of a small friction heat it would be unbounded.
pub(crate) const LEAST_SHARE: f64 = -0.5;

observed! {
    MU = ("mu", "-", "coefficient of friction");
    MU_F = ("mu_f", "-", "coefficient of friction of the film alone");
    LAMBDA = ("lambda", "-", "film thickness over rms roughness of both flanks");
    THICKNESS = ("h", "um", "film thickness");
    T_FILM = ("T_film", "degC", "temperature of the film");
    T_B1 = ("T_b1", "degC", "body temperature of the first gear");
    T_B2 = ("T_b2", "degC", "body temperature of the second gear");
}
const T_BODY: [Observed; 2] = [T_B1, T_B2];

/// Thermal elastohydrodynamic and mixed friction along the path of contact.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Film thickness formula.
    #[serde(default)]
    pub film: Film,
    /// Film thinning by inlet heating.
    #[serde(default)]
    pub inlet_heating: InletHeating,
    /// Build-up of the shear stress over the transit.
    #[serde(default)]
    pub transit: Transit,
    /// Location of the heat source in the film.
    #[serde(default)]
    pub film_heat: FilmHeat,
    /// Friction heats film and gears; otherwise all have the oil temperature.
    #[serde(default = "yes")]
    pub thermal: bool,
    /// Heat source of the gear bodies.
    #[serde(default)]
    pub bodies: Warmth,
    /// Body temperatures of both gears, if known; they take precedence over those of a thermal network, and both take precedence
    /// over `bodies`. [degC]
    #[schemars(inner(range(min = -60.0, max = 300.0)))]
    pub body_temperatures: Option<[f64; 2]>,
    /// Thermal resistances from both gear bodies to the oil; default: those of discs and cylinders rotating in a mist. [K/W]
    #[schemars(inner(range(min = 0.0, max = 100.0)))]
    pub gear_resistance: Option<[f64; 2]>,
    /// Volume fraction of oil in that mist: 0.02 to 0.2 splash, 1 submerged. [-]
    #[serde(default = "mist")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub oil_fraction: f64,
    /// Ratio of the shaft or hub radius to the tip radius; the sides of a gear do not dissipate heat inside it. [-]
    #[serde(default = "hub")]
    #[schemars(range(min = 0.0, max = 0.95))]
    pub hub_ratio: f64,
    /// Exponent of the share of boundary friction over one plus the film ratio. [-]
    #[serde(default = "two")]
    #[schemars(range(min = 0.1, max = 10.0))]
    pub exponent: f64,
    /// Thermal conductivity of both flanks; default: that of the gears' materials, else 46. [W/(m K)]
    #[schemars(range(min = 0.1, max = 500.0))]
    pub flank_conductivity: Option<f64>,
    /// Density of both flanks; default: that of the gears' materials, else 7800. [kg/m3]
    #[schemars(range(min = 500.0, max = 20000.0))]
    pub flank_density: Option<f64>,
    /// Specific heat of both flanks; default: that of the gears' materials, else 470. [J/(kg K)]
    #[schemars(range(min = 100.0, max = 3000.0))]
    pub flank_heat_capacity: Option<f64>,
    /// Eyring stress; default: that of the oil. [MPa]
    #[schemars(range(min = 0.1, max = 50.0))]
    pub tau0: Option<f64>,
    /// Exponent of Roelands' law over pressure; default: that of the oil, else the one that reproduces its pressure-viscosity
    /// coefficient. [-]
    #[schemars(range(min = 0.1, max = 1.5))]
    pub z: Option<f64>,
    /// Slope of the limiting shear stress over mean pressure; default: that of the oil. [-]
    #[schemars(range(min = 0.005, max = 0.2))]
    pub limiting_slope: Option<f64>,
    /// Effective shear modulus of film and surfaces; default: that of the oil, else 0.5 GPa. [GPa]
    #[schemars(range(min = 0.001, max = 10.0))]
    pub shear_modulus: Option<f64>,
    /// Coefficient of boundary friction; default: that of the oil. [-]
    #[schemars(range(min = 0.01, max = 0.5))]
    pub mu_b: Option<f64>,
}

fn yes() -> bool {
    true
}
fn mist() -> f64 {
    0.5
}
fn hub() -> f64 {
    0.6
}
fn two() -> f64 {
    2.0
}
/// The steel of gears that name no material.
const STEEL: Conductor = Conductor {
    conductivity: 46.0,
    density: 7800.0,
    heat_capacity: 470.0,
};

/// The model, prepared.
pub struct EhlMixed {
    laws: Laws,
    fluid: MeshFluid,
    warmth: Warmth,
    known: Option<[f64; 2]>,
    resistances: Option<[f64; 2]>,
    oil_fraction: f64,
    cooled: [Body; 2],
    /// The pair; FZG C gears for a single contact.
    part: Arc<MeshPart>,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<EhlMixed, Diagnostic> {
    let factor = params.inlet_heating.factor();
    EhlMixed::new(&params, factor, cx)
}

impl EhlMixed {
    /// The model with a user-defined factor of film thickness to isothermal film thickness, instead of `inlet_heating`, such as a
    /// correction for high speed.
    ///
    /// # Errors
    /// If neither oil nor parameters state a required value.
    pub fn new(params: &Params, factor: Factor, cx: &Build<'_>) -> Result<Self, Diagnostic> {
        let part = match cx.part::<GearMesh>() {
            Some(part) => part.clone(),
            None => MeshPart::fzg_c().map_err(|fault| cx.error(fault))?,
        };
        Self::of_part(params, factor, part, cx)
    }

    /// The model for a pair, as [`EhlMixed::new`].
    ///
    /// # Errors
    /// If neither oil nor parameters state a required value.
    pub fn of_part(params: &Params, factor: Factor, part: MeshPart, cx: &Build<'_>) -> Result<Self, Diagnostic> {
        let written = Written {
            tau0: params.tau0,
            z: params.z,
            limiting_slope: params.limiting_slope,
            shear_modulus: params.shear_modulus,
            mu_b: params.mu_b,
        };
        let stated = [
            params.flank_conductivity,
            params.flank_density,
            params.flank_heat_capacity,
        ];
        Ok(Self {
            laws: Laws {
                film: params.film,
                inlet: factor,
                transit: params.transit,
                film_heat: params.film_heat,
                exponent: params.exponent,
                flanks: flanks(stated, STEEL, part.materials.map(known), cx)?,
                thermal: params.thermal,
            },
            fluid: MeshFluid::new(written, part.oil.as_ref(), cx)?,
            warmth: params.bodies,
            known: params.body_temperatures,
            resistances: params.gear_resistance,
            oil_fraction: params.oil_fraction,
            cooled: cooled(&part, params.hub_ratio),
            part: Arc::new(part),
        })
    }

    /// Body temperatures or resistances at a speed of the first gear in rad/s.
    fn warming<R: Points>(&self, oil: &Oil<'_, R>, speed: R) -> Warming<R> {
        if let Some(known) = self.known {
            return Warming::Known(known.map(R::constant));
        }
        let ratios = [1.0, self.part.pair.ratio()];
        let cooled = |i: usize| {
            R::each(|point| {
                let fluid = oil.fluid(point).mist(self.oil_fraction);
                self.cooled[i].resistance(&fluid, speed.at_point(point) / ratios[i])
            })
        };
        let resistances = match self.resistances {
            Some(stated) => stated.map(R::constant),
            None => [0, 1].map(cooled),
        };
        Warming::By(self.warmth, resistances)
    }

    /// The friction along a path, with its notes.
    fn march_along<R: Points>(&self, path: &PathAt<'_, R>, mu: &mut [R]) -> Result<Along<R>, Undefined> {
        let explain = path.notes.is_traced().then_some(
            #[inline(always)]
            |place: &Place<'_, R>, settled: &Settled<R>| {
                note(path.notes, place, settled);
            },
        );
        let mut seen = (!path.notes.is_muted() && !path.notes.is_traced()).then(Seen::default);
        let (_, first_heat) = self.settle(path, mu, seen.as_mut(), explain);
        if let Some(seen) = seen {
            let loaded = path.notes.among(path.line_load.is_above(R::ZERO));
            R::wide(
                #[inline(always)]
                || seen.note(loaded),
            );
        }
        let sum = mu.iter().fold(R::ZERO, |sum, mu| sum + *mu);
        // Points of a batch that have left it, or are at rest, are not asked.
        let asked = R::mask(|point| R::COUNT == 1 || path.notes.points() >> point & 1 == 1);
        super::finite(R::select(asked, sum, R::ZERO)).map(|_| Along {
            first_heat,
            ..Along::default()
        })
    }

    /// Solves a path and writes its friction, and what is seen on the way; shows each loaded point at that friction in order. Returns the iteration
    /// counts and the heat share of the first gear.
    pub fn settle<R: Points>(
        &self,
        path: &PathAt<'_, R>,
        mu: &mut [R],
        seen: Option<&mut Seen<R>>,
        show: Option<impl FnMut(&Place<'_, R>, &Settled<R>)>,
    ) -> (Tally, R) {
        let oil = self.fluid.for_supply(Supplied {
            temperature: path.temperature,
            nu: path.nu,
            eta: path.eta,
            alpha: path.alpha,
            beta: path.beta,
            conductivity: path.conductivity,
        });
        let march = March::new(path, &self.laws, &oil);
        let warming = match path.bodies {
            Some(known) if self.known.is_none() => Warming::Known(known),
            _ => self.warming(&oil, path.speed),
        };
        let Solved {
            bodies,
            heats,
            mut tally,
        } = march.settle(warming, mu, seen);
        if let Some(mut show) = show {
            R::wide(
                #[inline(always)]
                || {
                    let conditions = march.conditions(bodies);
                    for (node, mu) in path.nodes.iter().zip(mu) {
                        if let Some(place) = march.place(node, &conditions) {
                            tally.passes += 1;
                            show(&place, &place.after(*mu));
                        }
                    }
                },
            );
        }
        let [first, second] = heats;
        let heat = first + second;
        let share = (first / heat).at_least(LEAST_SHARE).at_most(1.0 - LEAST_SHARE);
        (tally, R::select(heat.is_above(R::ZERO), share, R::HALF))
    }
}

/// The heat-dissipating surfaces of both gears: the sides from hub to tip, for a ring gear from tip to root, and the toothed face.
fn cooled(part: &MeshPart, hub: f64) -> [Body; 2] {
    let pair = &part.pair;
    [0, 1].map(|i| {
        let tip = 0.5 * pair.tip_diameter[i];
        Body {
            sides: if pair.internal && i == 1 {
                [0.5 * pair.root_diameter[1], tip]
            } else {
                [tip, hub * tip]
            },
            track: tip,
            facewidth: pair.facewidth,
        }
    })
}

/// Notes a converged contact where it carries load; returns its friction.
#[inline(always)]
fn note<R: Points>(notes: Notes<'_, R>, place: &Place<'_, R>, settled: &Settled<R>) -> R {
    let notes = notes.among(place.loaded());
    seen::note(notes, &seen::observed(place, settled), || {
        notes.show("eta_p", "Pa s", settled.eta);
        notes.show("S", "-", settled.s);
        notes.show("D0", "-", settled.d0);
        notes.show("share of boundary friction", "-", settled.boundary);
    });
    settled.mu
}

impl ToothFrictionModel for EhlMixed {
    /// A single contact heats the bodies by its own heat; the flank of the first gear is the faster one.
    fn mu(&self, at: &ContactAt<'_>) -> Result<f64, Undefined> {
        if at.line_load == 0.0 {
            at.branch("no load: no friction");
            return Ok(at.observe(&MU, 0.0));
        }
        if at.sum_speed == 0.0 && at.sliding == 0.0 {
            at.branch("at standstill: boundary friction, the limit without a film");
            return Ok(at.observe(&MU, self.fluid.rheology.mu_b));
        }
        let oil = self.fluid.for_supply(Supplied {
            temperature: at.temperature,
            nu: at.nu,
            eta: at.eta,
            alpha: at.alpha,
            beta: at.beta,
            conductivity: at.conductivity,
        });
        let pair = &self.part.pair;
        let speed = 0.5 * at.sum_speed / (pair.sin_working_angle * pair.working_radius[0]);
        let bodies = match self.warming(&oil, speed) {
            Warming::Known(temperatures) => Bodies::Held(temperatures),
            Warming::By(Warmth::Oil, _) => Bodies::Held([at.temperature; 2]),
            Warming::By(_, resistances) => Bodies::Rising(resistances),
        };
        let speeds = Contact::speeds(at.sliding, at.sum_speed, true);
        let contact = Contact::new(at.line_load, at.radius, at.modulus, at.length, speeds);
        let place = Place::new(
            &Conditions::new(&self.laws, &oil, bodies),
            contact,
            contact.logarithms(),
            at.rq,
        );
        let mu = place.settle(0.05, &mut first_slope(), &mut 0).mu;
        super::finite(note(at.notes, &place, &place.after(mu)))
    }

    /// The limiting stress cuts off the friction, but one point costs as much as a whole path of other laws. Eight nodes leave an
    /// error of 1e-4 of the loss at nine of ten points over 10 to 20000 rpm and -20 to 140 degC, and 5e-3 in the worst case, where
    /// cold oil reaches that stress.
    fn order(&self) -> usize {
        8
    }

    fn uncut_along(&self, path: &PathAt<'_>, mu: &mut [f64]) -> Result<Along, Undefined> {
        self.march_along(path, mu)
    }

    fn uncut_along_together(&self, path: &PathAt<'_, Lane>, mu: &mut [Lane]) -> Result<Along<Lane>, Undefined> {
        self.march_along(path, mu)
    }
}

register!(ToothFriction, "ehl_mixed", Params,
    source: "Shore, Kadiric: Optimization of electric vehicle drivetrain fluid with a new system-level approach; Olver, Spikes 1998; \
Johnson, Tevaarwerk 1977",
    example: "{ type: ehl_mixed, tau0: 5 MPa, limiting_slope: 0.055, mu_b: 0.13 }",
    evidence: [
        formula(Evidence::OneSource, "one article; each part has several sources; gaps are derived"),
        default_of("film", Evidence::Reconstructed, "published for ellipses; applied to a line as a long ellipse of equal pressure"),
        default_of("inlet_heating", Evidence::Disputed, "laws differ by a third of the film at high speed"),
        default_of("transit", Evidence::Derived, "closed form of the equation"),
        default_of("film_heat", Evidence::Reconstructed, "shown in a figure of the article"),
        default_of("bodies", Evidence::Derived, "conservation of heat; the article uses a lower mean"),
        default_of("thermal", Evidence::OneSource, "the article"),
        default_of("oil_fraction", Evidence::Assumed, "between splash and submerged; gives about the body temperatures of ISO/TR 15144-1, quoted from memory"),
        default_of("hub_ratio", Evidence::Assumed, "typical for a pinion on its shaft"),
        default_of("exponent", Evidence::OneSource, "Olver and Spikes"),
        default_of("flank_conductivity", Evidence::Assumed, "typical for gear steel"),
        default_of("flank_density", Evidence::SeveralSources, "steel"),
        default_of("flank_heat_capacity", Evidence::Assumed, "typical for gear steel"),
        default_of("shear_modulus", Evidence::Recalled, "0.1 to 1 GPa; hardly affects gears"),
        default_of("z", Evidence::Derived, "follows from the pressure-viscosity coefficient"),
    ],
    limits: [PRESSURE, WARMTH, PECLET],
    observed: [MU, MU_F, LAMBDA, THICKNESS, T_FILM, T_B1, T_B2], prepare: prepare);
