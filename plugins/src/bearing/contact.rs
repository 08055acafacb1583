//! Friction of rolling bearings from the contacts of their elements.
//!
//! The load of each element follows from the equilibrium of the ring ([load distribution](../load-distribution.md)), at speed with centrifugal forces and
//! gyroscopic moments of balls. Each contact with a raceway then takes power by
//! - rolling: the inlet film resists (Biboulet and Houpert 2010 for balls; Zhou and Hoeprich 1991 or Aihara 1987 for rollers), less if it is heated or
//!   starved;
//! - hysteresis of the material (Balan, Houpert and others, Lubricants 2015, 3, 222 for balls; a share of the strain energy for rollers, Johnson);
//! - sliding, by curvature and spin, with Eyring's flow of the oil, its limiting stress, and boundary friction by the film ratio as in `ehl_mixed`.
//!
//! Rollers of tapered bearings also slide on the rib, by the part of their load that the angle between both raceways leaves. Balls and rollers drag
//! through oil and air with the density of their mixture. The share of oil that jets leave between balls falls with the speed (Parker 1984).
//! The moment is the power over the speed of the inner ring relative to the outer ring.
//!
//! The rolling resistance of a lightly loaded element hardly depends on its load and ends where it comes free: under a thrust that turns the contacts
//! of balls, the loss of a bearing may fall by some per cent while its load grows.
//!
//! Steady loads, stationary outer ring, balls up to a speed factor of 4e6 mm/min, no skidding, pockets of the cage without friction; on lands of a ring only if `cage` states them (Petroff, a
//! concentric gap full of oil). Flooded rolling laws of rollers are about twice the measurement of a 32216 in an oil bath (Wingertszahn and others
//! 2023); Zhou and Hoeprich alone are 13 to 27 % above it. Internal geometry is rarely in catalogues: what is estimated decides the result, see
//! `internal`. Not for bearings with several rows.

mod rolling;
mod slip;

use std::f64::consts::PI;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::lubricant::roelands::Roelands;
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::bearing::{
    Bearing, BearingAt, BearingKind, BearingModel, ElementRow, Elements, Lubrication,
};
use gearloss_framework::real::Real;
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::rolling::{Axes, BallAtSpeed, Balls, Given, Mirrored, Rollers, Row as _, balance};
use gearloss_framework::{limits, observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::checks::SIX_DIGITS;
use rolling::{InletOil, LineLaw, RollingLine, RollingPoint};
use slip::{Slip, Traction};

terms! {
    ROLLING = load("rolling");
    HYSTERESIS = load("hysteresis");
    SLIDING = load("sliding");
    RIB = load("rib");
    DRAG = no_load("drag");
}
limits! {
    SPEED = ("n d_m", "speed factor", "mm/min", 0.0, 1e6, "end of a public study of balls in oil and air; above, their drag decides and is least known");
    OUTER = ("n_outer", "speed of the outer ring", "1/min", 0.0, 0.0, "the equations are those of a stationary outer ring");
    THRUST = ("Fa/(Fr tan a)", "thrust over the least that a contact angle needs", "-", 1.0, 1e9, "equilibrium of a ring on elements with a contact angle; below, the least is taken");
    AXIAL = ("Fa/Fr", "thrust over radial load", "-", 0.0, 0.0, "flanges of cylindrical and needle roller bearings are not modelled");
    ANGLE = ("a_i", "contact angle of a ball on the inner ring", "deg", 0.0, GREATEST_ANGLE, "shoulders of grooves end below it; beyond, balls run over the one of the inner ring");
    HEATING = ("phi_ZH", "factor of heating after Zhou and Hoeprich", "-", 0.0, 1.0, "below zero the inlet is hotter than their formula covers, and the rolling loss is taken as zero");
}
observed! {
    LOAD = ("Q_max", "N", "largest load of an element");
    LAMBDA = ("Lambda", "-", "film ratio at the most loaded inner contact");
}

/// Friction of a rolling bearing from the contacts of its elements.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct Params {
    /// Law of the rolling friction of rollers; balls have that of Biboulet and Houpert.
    #[serde(default)]
    pub rolling: LineLaw,
    /// Factor of a starved inlet on rolling friction; one is flooded. [-]
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub supply: f64,
    /// Height of the oil at the inlet over the minimum film, which starves it: a factor on rolling friction besides `supply`; 8.9 halves it. [-]
    #[schemars(range(min = 2.0, max = 1e6))]
    pub inlet_height: Option<f64>,
    /// Root mean square roughness of raceway and element together. [um]
    #[serde(default = "roughness")]
    #[schemars(range(min = 0.001, max = 5.0))]
    pub roughness: f64,
    /// Eyring stress of the oil; default: `tau0` of its `rheology`, else 5 MPa. [MPa]
    #[schemars(range(min = 0.1, max = 50.0))]
    pub tau0: Option<f64>,
    /// Slope of the limiting stress over pressure; default: `limiting_slope` of its `rheology`, else 0.07. [-]
    #[schemars(range(min = 0.005, max = 0.2))]
    pub limiting_slope: Option<f64>,
    /// Coefficient of boundary friction; default: `mu_bl` of the oil, else 0.12. [-]
    #[schemars(range(min = 0.0, max = 0.5))]
    pub mu_bl: Option<f64>,
    /// Share of the strain energy that hysteresis in the contacts of rollers takes: 0.005 to 0.05. [-]
    #[serde(default = "hysteresis")]
    #[schemars(range(min = 0.0, max = 0.1))]
    pub hysteresis: f64,
    /// Contact of tapered rollers with the rib.
    #[serde(default)]
    pub rib: Rib,
    /// Share of oil in the space of the rolling elements; default: that of `flow`, else the part of their circle that is below the oil. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub filling: Option<f64>,
    /// Oil that jets inject into a ball bearing, instead of `filling`: the share of oil is 1e5 V^0.37/(n d_m^1.7) for cm3/min, 1/min and mm, at
    /// most one. [l/min]
    #[schemars(range(min = 0.1, max = 20.0))]
    pub flow: Option<f64>,
    /// Drag coefficient of an element in the row: 0.05 to 0.5, that of a lone sphere being 0.4. [-]
    #[serde(default = "drag_coefficient")]
    #[schemars(range(min = 0.0, max = 2.0))]
    pub drag_coefficient: f64,
    /// Cage that a ring guides; default: its friction is left out.
    pub cage: Option<Cage>,
}

/// Cage that runs on the lands of a ring, in a gap full of oil. Its shear is part of the drag.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct Cage {
    /// Ring with the lands.
    pub guided_by: Guide,
    /// Diameter of the lands. [mm]
    #[schemars(range(min = 1.0, max = 5000.0))]
    pub diameter: f64,
    /// Width of all lands together. [mm]
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub width: f64,
    /// Radial gap between cage and land. [um]
    #[schemars(range(min = 10.0, max = 10000.0))]
    pub gap: f64,
}

/// Ring that guides a cage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Guide {
    /// The inner ring.
    Inner,
    /// The outer ring.
    Outer,
}

impl Cage {
    /// Power of the shear in the gap (Petroff), at the viscosity (Pa s), the speed of the inner ring and that of the cage (rad/s). \[W\]
    fn power(&self, eta: f64, speed: f64, orbital: f64) -> f64 {
        let slip = match self.guided_by {
            Guide::Inner => speed - orbital,
            Guide::Outer => orbital,
        };
        0.25 * PI * eta * self.width * self.diameter.powi(3) * slip * slip / self.gap
    }
}

/// Contact of tapered rollers with the rib.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Rib {
    /// Angle between both raceways; default: 0.19 of the contact angle. [deg]
    #[schemars(range(min = 0.0, max = 20.0))]
    pub taper: Option<f64>,
    /// Angle of the normal of the rib to the radial plane; default: the rib is square to the axis of the roller. [deg]
    #[schemars(range(min = 45.0, max = 90.0))]
    pub angle: Option<f64>,
    /// Height of the contact above the inner raceway; default: 0.07 of the roller's diameter. [mm]
    #[schemars(range(min = 0.01, max = 100.0))]
    pub height: Option<f64>,
    /// Half width of the contact along the rib, for the spin of the roller's end; 0 leaves the spin out. [mm]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub half_width: f64,
    /// Coefficient of friction. [-]
    #[schemars(range(min = 0.0, max = 0.3))]
    pub friction: f64,
}

impl Default for Rib {
    fn default() -> Self {
        Self {
            taper: None,
            angle: None,
            height: None,
            half_width: 0.0,
            friction: 0.05,
        }
    }
}

fn one() -> f64 {
    1.0
}

fn roughness() -> f64 {
    0.15e-6
}

fn hysteresis() -> f64 {
    0.01
}

fn drag_coefficient() -> f64 {
    0.2
}

/// Eyring stress, slope of the limiting stress and boundary friction of an oil for which none is stated. \[Pa, -, -\]
const USUAL: (f64, f64, f64) = (5e6, 0.07, 0.12);
/// Density of air at 50 degC and 1 bar. \[kg/m3\]
const AIR: f64 = 1.1;
/// Thrust over the least that a contact angle needs, where less is given; a convention, because at the least one element carries everything.
const ENOUGH: f64 = 1.05;
/// Speed factor above which the inertia of balls matters, a convention. \[mm/min\]
pub(crate) const FAST: f64 = 0.3e6;
/// Speed factor up to which balls are balanced, a convention: aircraft engines end below it (recalled), and far beyond it inertia leaves some rings without a
/// stable equilibrium. \[mm/min\]
pub(crate) const FASTEST: f64 = 4e6;
/// Contact angle that shoulders of grooves do not reach: they would be 0.41 D high. A convention. \[deg\]
pub(crate) const GREATEST_ANGLE: f64 = 80.0;
/// Branch of an explanation where internal geometry is not stated.
pub(crate) const ESTIMATED: &str = "internal geometry is estimated from the boundary dimensions: state `internal`";

/// A bearing with the geometry of its elements.
struct Contacts {
    params: Params,
    /// Factor of a starved inlet and of the churning of grease on rolling friction.
    supply: f64,
    elements: Elements,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Contacts, Diagnostic> {
    let part = cx.own_part::<Bearing>()?;
    let elements = part.rolling_elements().map_err(|reason| {
        cx.error(reason)
            .help("choose another model for this bearing, such as `skf`, or state its `internal` geometry")
    })?;
    let mut unused = Vec::new();
    if matches!(elements.row, ElementRow::Balls(_)) {
        unused.extend(["rolling", "hysteresis"]);
    }
    if part.kind != BearingKind::TaperedRoller {
        unused.push("rib");
    }
    if let ElementRow::Rollers(rollers) = &elements.row
        && part.kind == BearingKind::TaperedRoller
        && params.rib.half_width > 0.5 * rollers.geometry().diameter
    {
        let half = format!("{:.3} mm", 0.5 * rollers.geometry().diameter.mm());
        let message = format!("`half_width` of the `rib` exceeds half the diameter of the rollers, {half}");
        return Err(cx.error(message).help(format!("state at most {half}")));
    }
    if params.flow.is_some() {
        let fault = match elements.row {
            _ if params.filling.is_some() => Some((
                "`filling` and `flow` both state the share of oil between the rolling elements",
                "delete one of them",
            )),
            _ if matches!(part.lubrication, Lubrication::Grease | Lubrication::OilAir) => Some((
                "`flow` is for oil jets, and the bearing has grease, or oil and air",
                "delete `flow`, or write `lubrication: jet`",
            )),
            ElementRow::Rollers(_) => Some((
                "`flow` is for balls only: how much oil jets leave between rollers is not known",
                "state `filling` instead, the share of oil",
            )),
            ElementRow::Balls(_) => None,
        };
        if let Some((message, help)) = fault {
            return Err(cx.error(message).help(help));
        }
    }
    if let Some(cage) = &params.cage {
        if part.kind == BearingKind::CylindricalRollerFullComplement {
            let error = cx.error("`cage` is stated, but a full complement bearing has none");
            return Err(error.help("delete `cage`"));
        }
        let middle = match &elements.row {
            ElementRow::Balls(balls) => balls.geometry().pitch_diameter,
            ElementRow::Rollers(rollers) => rollers.geometry().pitch_diameter,
        };
        let (ring, [from, to]) = match cage.guided_by {
            Guide::Inner => ("inner", [part.bore, middle]),
            Guide::Outer => ("outer", [middle, part.outside]),
        };
        if !(from..=to).contains(&cage.diameter) {
            let [from, to] = [from, to].map(|diameter| format!("{:.3} mm", diameter.mm()));
            let message = format!("`diameter` of the `cage`: lands of the {ring} ring are between {from} and {to}");
            let error = cx.error(message);
            return Err(error.help("state the diameter of the lands, or the other ring in `guided_by`"));
        }
        if let Some(width) = part.width.filter(|width| cage.width > *width) {
            let width = format!("{:.3} mm", width.mm());
            let error = cx.error(format!("`width` of the `cage` exceeds that of the bearing, {width}"));
            return Err(error.help(format!("state at most {width}, for all lands together")));
        }
    }
    let churning = part.churning();
    cx.leave_unused(unused);
    let contacts = Contacts::new(params, elements);
    Ok(Contacts {
        supply: contacts.supply * churning,
        ..contacts
    })
}

/// Friction of an oil in a contact.
struct Flow {
    law: Roelands,
    temperature: f64,
    tau0: f64,
    limiting_slope: f64,
    /// Thickness of the film. \[m\]
    film: f64,
    /// Share of boundary friction, and its coefficient.
    boundary: f64,
    mu_bl: f64,
}

/// What a pressure decides: viscosity over film and Eyring stress, limiting stress, boundary friction.
#[derive(Clone, Copy)]
struct Pressed {
    thinning: f64,
    limit: f64,
    boundary: f64,
}

impl Traction for Flow {
    type Pressed = Pressed;

    fn under(&self, pressure: f64) -> Pressed {
        Pressed {
            thinning: self.law.eta(pressure, self.temperature) / (self.film * self.tau0),
            limit: self.limiting_slope * pressure,
            boundary: self.mu_bl * pressure,
        }
    }

    #[inline(always)]
    fn stress<R: Real>(&self, pressed: Pressed, speed: R) -> R {
        let shear = speed * pressed.thinning;
        // The inverse hyperbolic sine; its digits for small shear do not matter in a sum.
        let film = ((shear + (shear * shear + 1.0).sqrt()).ln() * self.tau0).at_most(pressed.limit);
        film + (R::constant(pressed.boundary) - film) * self.boundary
    }
}

/// The powers of an element, of several, or of all. \[W\]
#[derive(Debug, Clone, Copy, Default)]
struct Powers {
    rolling: f64,
    hysteresis: f64,
    sliding: f64,
    rib: f64,
}

impl Powers {
    /// Adds the powers of some equal elements.
    fn add(&mut self, other: &Self, count: f64) {
        self.rolling += count * other.rolling;
        self.hysteresis += count * other.hysteresis;
        self.sliding += count * other.sliding;
        self.rib += count * other.rib;
    }
}

/// The oil at the inlets.
fn inlet_oil(at: &BearingAt<'_>) -> InletOil {
    InletOil {
        eta: at.nu * at.rho,
        alpha: at.alpha,
        beta: at.beta,
        conductivity: at.conductivity,
    }
}

/// The loads on the ring, the radial one in the pressure centre; the least thrust that a contact angle needs, if less is given.
fn loads_on_ring(at: &BearingAt<'_>, axial: f64, angle: f64, pressure_centre: f64) -> Axes<Given> {
    let least = at.radial * angle.tan();
    if least > 0.0 {
        at.check(&THRUST, (axial / least).min(1e9));
    }
    let axial = axial.max(ENOUGH * least);
    let given = Axes::loaded(axial, at.radial);
    if at.tilting > 0.0 {
        given.with_moment(at.tilting + at.radial * pressure_centre)
    } else {
        given
    }
}

impl Contacts {
    fn new(params: Params, elements: Elements) -> Self {
        let starved = params.inlet_height.map_or(1.0, rolling::starvation);
        Self {
            supply: params.supply * starved,
            params,
            elements,
        }
    }

    /// Powers of one ball, and the film ratio at its inner contact.
    fn ball(&self, at: &BearingAt<'_>, balls: &Balls, ball: &BallAtSpeed) -> (Powers, f64) {
        let (geometry, oil) = (balls.geometry(), inlet_oil(at));
        let modulus = 2.0 * geometry.balls.contact_modulus(&geometry.rings);
        let (speed, diameter) = (at.speed.abs(), geometry.diameter);
        let (mut powers, mut film_ratio) = (Powers::default(), 0.0);
        for (ring, contact) in balls.contacts().iter().enumerate() {
            let (load, angle) = (ball.contacts.load[ring], ball.contacts.angle[ring]);
            if load <= 0.0 {
                continue;
            }
            let gamma = diameter * angle.cos() / geometry.pitch_diameter;
            let mean = 0.25 * geometry.pitch_diameter * (1.0 - gamma * gamma) * speed;
            let [along, across] = geometry.radii(ring, angle.cos());
            let ellipse = contact.under(load);
            let point = RollingPoint {
                along,
                across,
                modulus,
                second: contact.second_integral(),
            };
            let rate = mean / along;
            let heating = oil.heating(mean) * self.supply;
            powers.rolling += 2.0 * point.force(load, &ellipse, oil.eta, mean) * mean * heating;
            let k = across / along;
            let strain = 7.48e-7 * (0.5 * diameter).powf(0.33) * load.powf(1.33);
            powers.hysteresis += strain * (1.0 - 3.519e-3 * (k - 1.0).max(0.0).powf(0.8063)) * rate;
            let flow = self.flow(at, &oil, &point, load, mean);
            if ring == 0 {
                film_ratio = flow.film / self.params.roughness;
            }
            let conformity = geometry.conformity[ring];
            let slip = Slip {
                ellipse,
                radius: 2.0 * conformity * diameter / (2.0 * conformity + 1.0),
                rolling: rate,
                spin: ball.motion.spin[ring],
            };
            powers.sliding += slip.power(&flow);
        }
        (powers, film_ratio)
    }

    /// The film of a point contact and the friction in it: central film of Hamrock and Dowson 1977, thinned by heating at the inlet after Wilson
    /// and Sheu for pure rolling, with the mean speed in the thermal load.
    fn flow(&self, at: &BearingAt<'_>, oil: &InletOil, point: &RollingPoint, load: f64, mean: f64) -> Flow {
        let params = &self.params;
        let unit = point.modulus * point.along;
        let (u, g) = (oil.eta * mean / unit, oil.alpha * point.modulus);
        let w = load / (unit * point.along);
        let shape = 1.0 - 0.61 * (-0.73 * 1.03 * (point.across / point.along).powf(0.64)).exp();
        let cold = 2.69 * u.powf(0.67) * g.powf(0.53) * w.powf(-0.067) * shape * point.along;
        let film = cold / (1.0 + 0.1 * (4.0 * oil.thermal_load(mean)).powf(0.64));
        let above = 1.0 + film / params.roughness;
        let stated = |value: f64| Some(value).filter(|value| *value > 0.0);
        let z = Roelands::exponent(oil.alpha, oil.eta);
        Flow {
            law: Roelands::tangent(at.temperature, oil.eta, oil.beta, z),
            temperature: at.temperature,
            tau0: params.tau0.or(stated(at.tau0)).unwrap_or(USUAL.0),
            limiting_slope: params.limiting_slope.or(stated(at.limiting_slope)).unwrap_or(USUAL.1),
            film,
            boundary: 1.0 / (above * above),
            mu_bl: params.mu_bl.or(stated(at.mu_bl)).unwrap_or(USUAL.2),
        }
    }

    /// Powers of all balls, and the largest load.
    fn of_balls(&self, at: &BearingAt<'_>, balls: &Balls) -> Result<(Powers, f64), Undefined> {
        let speed = at.speed.abs();
        let given = loads_on_ring(at, at.axial, balls.geometry().contact_angle, balls.pressure_centre()).mirrored();
        let (row, moving) = (Mirrored(balls), balls.at_speed(speed));
        let speed_factor = at.part.mean_diameter().mm() * speed.rpm();
        if speed_factor > FASTEST {
            return Err(Undefined {
                what: "speed factor n d_m of balls, of which 4e6 is the most [mm/min]",
                value: speed_factor,
            });
        }
        let is_fast = speed_factor > FAST;
        let found = if is_fast {
            balls.balance_mirrored(speed, &given)
        } else {
            balance(&row, &given)
        };
        let displacement = found.map_err(|_| unbalanced(at))?.displacement;
        let (mut powers, mut largest, mut ratio) = (Powers::default(), 0.0_f64, 0.0);
        let mut steepest = 0.0_f64;
        let mut add = |(place, ball): (usize, BallAtSpeed)| {
            let (own, film_ratio) = self.ball(at, balls, &ball);
            powers.add(&own, row.count(place));
            if ball.contacts.load[0] > 0.0 {
                steepest = steepest.max(ball.contacts.angle[0].abs());
            }
            if ball.contacts.load[0] > largest {
                (largest, ratio) = (ball.contacts.load[0], film_ratio);
            }
        };
        let half = row.directions().len();
        if is_fast {
            let half = moving.loads(&displacement).take(half);
            half.enumerate().for_each(&mut add);
        } else {
            let half = balls.loads(&displacement).take(half);
            half.enumerate().for_each(|(place, contacts)| {
                let motion = moving.motion(contacts.angle.map(|angle| [angle.sin(), angle.cos()]));
                add((place, BallAtSpeed { contacts, motion }));
            });
        }
        at.observe(&LAMBDA, ratio);
        at.check(&ANGLE, steepest.to_degrees());
        Ok((powers, largest))
    }

    /// Powers of all rollers, and the largest load.
    fn of_rollers(&self, at: &BearingAt<'_>, rollers: &Rollers) -> Result<(Powers, f64), Undefined> {
        let geometry = rollers.geometry();
        // Flanges carry the thrust of rollers without a contact angle.
        let axial = if geometry.contact_angle > 0.0 {
            at.axial
        } else {
            if at.axial > 0.0 {
                at.check(&AXIAL, (at.axial / at.radial).min(1e9));
            }
            0.0
        };
        let given = loads_on_ring(at, axial, geometry.contact_angle, rollers.pressure_centre()).mirrored();
        let row = Mirrored(rollers);
        let found = balance(&row, &given).map_err(|_| unbalanced(at))?;
        let (oil, speed) = (inlet_oil(at), at.speed.abs());
        let (diameter, cos) = (geometry.diameter, geometry.contact_angle.cos());
        let raceways = [-1.0, 1.0].map(|side| 0.5 * (geometry.pitch_diameter + side * diameter * cos));
        let mean = speed * raceways[0] * raceways[1] / (raceways[0] + raceways[1]);
        let modulus = 2.0 * geometry.rollers.contact_modulus(&geometry.rings);
        let gamma = diameter * cos / geometry.pitch_diameter;
        let lines = [1.0, -1.0].map(|side| RollingLine {
            radius: 0.5 * diameter * (1.0 - side * gamma),
            length: geometry.length,
            diameter,
            modulus,
        });
        let rib = self.rib_torque(geometry.contact_angle, diameter) * speed * raceways[1] / diameter;
        let (mut powers, mut largest) = (Powers::default(), 0.0_f64);
        let half = rollers.loads(&found.displacement).take(row.directions().len());
        for (place, load) in half.map(|roller| roller.load).enumerate() {
            if load <= 0.0 {
                continue;
            }
            let mut own = Powers {
                rib: rib * load,
                ..Powers::default()
            };
            for (line, opposite) in lines.iter().zip([raceways[1], raceways[0]]) {
                // The moment of a contact about the roller acts on the bearing with the arm of the other raceway.
                let moment = line.moment(self.params.rolling, load, &oil, mean) * self.supply;
                if self.params.rolling == LineLaw::ZhouHoeprich {
                    at.check(&HEATING, line.heating_of_zhou_hoeprich(load, &oil, mean));
                }
                own.rolling += moment * opposite / diameter * speed;
                let hysteresis = self.params.hysteresis * load * 2.0 * line.half_width(load) / (3.0 * PI);
                own.hysteresis += hysteresis * mean / line.radius;
            }
            powers.add(&own, row.count(place));
            largest = largest.max(load);
        }
        Ok((powers, largest))
    }

    /// Friction torque of a tapered roller about its axis at the rib, per load on its outer raceway. \[Nm/N\]
    fn rib_torque(&self, angle: f64, diameter: f64) -> f64 {
        let rib = &self.params.rib;
        let taper = rib.taper.unwrap_or(0.19 * angle);
        let height = rib.height.unwrap_or(0.07 * diameter);
        // From the normal of the inner raceway to that of the rib. A rib square to the axis of the roller is half the taper inside of the outer contact.
        let between = rib.angle.map_or(PI / 2.0 - 0.5 * taper, |rib| angle - taper + rib);
        let share = taper.sin() / between.sin();
        // Sliding and the spin of the roller's end together: Houpert's root with 0.18, as a paper on the losses of axle-box bearings prints it.
        let wide = rib.half_width / height;
        rib.friction * share * height * (1.0 + 0.18 * wide * wide).sqrt()
    }

    /// Drag of the elements in oil and air, and of the cage on its lands. \[W\]
    fn drag(&self, at: &BearingAt<'_>) -> f64 {
        let (number, diameter, area, pitch_diameter, contact_angle) = match &self.elements.row {
            ElementRow::Balls(balls) => {
                let g = balls.geometry();
                (
                    g.number,
                    g.diameter,
                    0.25 * PI * g.diameter * g.diameter,
                    g.pitch_diameter,
                    g.contact_angle,
                )
            }
            ElementRow::Rollers(rollers) => {
                let g = rollers.geometry();
                let area = g.diameter * g.length;
                (g.number, g.diameter, area, g.pitch_diameter, g.contact_angle)
            }
        };
        let filling = match (self.params.filling, self.params.flow) {
            (Some(filling), _) => filling,
            (None, Some(flow)) => filling_of_jets(flow, at.speed.rpm().abs(), pitch_diameter),
            (None, None) => {
                // The oil over the lowest point of the circle of the centres.
                let deep = (at.oil_height - 0.5 * diameter).max(0.0) / pitch_diameter;
                (1.0 - 2.0 * deep).clamp(-1.0, 1.0).acos() / PI
            }
        };
        at.show("X", "-", filling);
        let density = at.show("rho_eff", "kg/m3", filling * at.rho + (1.0 - filling) * AIR);
        let orbital = 0.5 * at.speed.abs() * (1.0 - diameter * contact_angle.cos() / pitch_diameter);
        let speed = 0.5 * orbital * pitch_diameter;
        let of_elements = 0.5 * number as f64 * density * self.params.drag_coefficient * area * speed.powi(3);
        let of_cage = self.params.cage.map_or(0.0, |cage| {
            at.show("P_cage", "W", cage.power(at.nu * at.rho, at.speed.abs(), orbital))
        });
        of_elements + of_cage
    }
}

/// Share of oil between balls from the flow of jets (m3/s), the speed of the inner ring (1/min, positive) and the pitch diameter (m): Parker 1984.
fn filling_of_jets(flow: f64, rpm: f64, pitch_diameter: f64) -> f64 {
    let cubic_centimetres = 60e6 * flow;
    (1e5 * cubic_centimetres.powf(0.37) / (rpm * pitch_diameter.mm().powf(1.7))).min(1.0)
}

/// No equilibrium of the ring: a load beyond any bearing of this size, or a moment beyond what the load holds.
fn unbalanced(at: &BearingAt<'_>) -> Undefined {
    let (what, value) = if at.tilting > 0.0 {
        (
            "tilting moment for which the rolling elements have no equilibrium [Nm]",
            at.tilting,
        )
    } else {
        (
            "radial load for which the rolling elements have no equilibrium [N]",
            at.radial,
        )
    };
    Undefined { what, value }
}

impl BearingModel for Contacts {
    fn loss(&self, at: &BearingAt<'_>) -> Result<Loss, Undefined> {
        let speed = at.speed.abs();
        at.check(&SPEED, at.part.mean_diameter().mm() * speed.rpm());
        at.check(&OUTER, at.outer_speed.abs().rpm());
        if speed == 0.0 {
            return Ok(Loss::POWERS);
        }
        if self.elements.is_estimated {
            at.branch(ESTIMATED);
        }
        let (number, diameter) = match &self.elements.row {
            ElementRow::Balls(balls) => (balls.geometry().number, balls.geometry().diameter),
            ElementRow::Rollers(rollers) => (rollers.geometry().number, rollers.geometry().diameter),
        };
        at.show("Z", "-", number as f64);
        at.show("D", "mm", diameter.mm());
        let (powers, largest) = if at.radial == 0.0 && at.axial == 0.0 && at.tilting == 0.0 {
            Default::default()
        } else {
            match &self.elements.row {
                ElementRow::Balls(balls) => self.of_balls(at, balls)?,
                ElementRow::Rollers(rollers) => self.of_rollers(at, rollers)?,
            }
        };
        at.observe(&LOAD, largest);
        let watts = |symbol: &'static str, power: f64| at.show(symbol, "W", power);
        Ok(Loss::POWERS
            .with(&ROLLING, watts("P_rolling", powers.rolling))
            .with(&HYSTERESIS, watts("P_hysteresis", powers.hysteresis))
            .with(&SLIDING, watts("P_sliding", powers.sliding))
            .with(&RIB, watts("P_rib", powers.rib))
            .with(&DRAG, watts("P_drag", self.drag(at))))
    }
}

register!(Bearing, "contact", Params,
    source: "Biboulet and Houpert 2010; Zhou and Hoeprich 1991; Aihara 1987; Balan, Houpert and others 2015; Hertz; Harris; Petroff",
    example: "{ type: contact }",
    evidence: [
        formula(Evidence::OneSource, "hysteresis and drag; load distribution, rolling, slip and spin have two sources, or one and a derivation"),
        default_of("rolling", Evidence::OneSource, "one bearing measured: 13 to 27 % above it"),
        default_of("supply", Evidence::Assumed, "flooded; a bath leaves less at high speed"),
        default_of("roughness", Evidence::Assumed, "ground and honed raceways"),
        default_of("tau0", Evidence::Assumed, "typical range 3 to 8 MPa"),
        default_of("limiting_slope", Evidence::Assumed, "typical range 0.05 to 0.09"),
        default_of("mu_bl", Evidence::Assumed, "typical value"),
        default_of("hysteresis", Evidence::Assumed, "sources state 0.005 to 0.05"),
        default_of("rib", Evidence::Assumed, "geometry of one bearing; friction 0.03 to 0.11"),
        default_of("filling", Evidence::Assumed, "level at rest; the cage clears the space at speed"),
        default_of("flow", Evidence::Recalled, "Parker 1984, quoted from memory, not checked; jets into ball bearings"),
        default_of("drag_coefficient", Evidence::Assumed, "0.05 to 0.5; that of balls in a row is not public"),
    ],
    checks: [
        Check {
            input: "{ model: { type: contact }, part: { kind: deep_groove_ball, bore: 40 mm, outside: 90 mm, internal: { elements: 8, \
                    diameter: 15.081 mm, clearance: 0 um } }, at: { speed: 3000 rpm, radial: 3000 N, axial: 0 N, tilting: 0 Nm } }",
            values: &[("hysteresis", "7.2044668 W"), ("Q_max", "1629.64 N")],
            tolerance: 1e-6,
            because: "the values have six to eight digits",
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: contact, flow: 1 l/min }, part: { kind: deep_groove_ball, bore: 40 mm, outside: 90 mm, internal: { elements: 8, \
                    diameter: 15.081 mm, clearance: 0 um } }, at: { speed: 15000 rpm, radial: 0 N, axial: 0 N, tilting: 0 Nm } }",
            values: &[("X", "0.07111415")],
            tolerance: 1e-7,
            because: "the value has seven digits",
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: contact, filling: 0, drag_coefficient: 0.05, cage: { guided_by: outer, diameter: 75 mm, width: 6 mm, \
                    gap: 300 um } }, part: { kind: deep_groove_ball, bore: 40 mm, outside: 90 mm, internal: { elements: 8, diameter: 15.081 mm, \
                    clearance: 0 um } }, at: { speed: 15000 rpm, radial: 0 N, axial: 0 N, tilting: 0 Nm, nu: 10 mm2/s, rho: 820 kg/m3 } }",
            values: &[("P_cage", "19.769802 W")],
            tolerance: 1e-6,
            because: "by hand: pi/4 eta B D^3 w^2/gap with half of the speed times (1 - 15.081/65)",
            ..SIX_DIGITS
        },
    ],
    limits: [SPEED, OUTER, THRUST, AXIAL, ANGLE, HEATING], terms: [ROLLING, HYSTERESIS, SLIDING, RIB, DRAG], observed: [LOAD, LAMBDA], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::bearing::BearingPart;
    use gearloss_framework::testing::assert_close;
    use proptest::prelude::*;

    const RPM: f64 = PI / 30.0;

    fn part(text: &str) -> BearingPart {
        serde_json::from_value(gearloss_framework::testing::part("bearing", text)).unwrap()
    }

    fn model(part: &BearingPart, params: &str) -> Contacts {
        Contacts::new(serde_json::from_str(params).unwrap(), part.rolling_elements().unwrap())
    }

    /// A 6308 with the geometry that an independent implementation used.
    const BALLS: &str = "{ kind: deep_groove_ball, bore: 40 mm, outside: 90 mm, width: 23 mm, c: 42300 N, c0: 24000 N, \
        internal: { elements: 8, diameter: 15.081 mm, clearance: 0 um } }";
    const TAPERED: &str = "{ kind: tapered_roller, bore: 80 mm, outside: 140 mm, width: 35.25 mm, c: 160000 N, c0: 200000 N, e: 0.42, \
        y: 1.43 }";
    const CYLINDRICAL: &str =
        "{ kind: cylindrical_roller, bore: 40 mm, outside: 80 mm, width: 18 mm, c: 62000 N, c0: 53000 N }";

    fn loads(radial: f64, axial: f64, rpm: f64) -> impl Fn(&mut BearingAt<'_>) {
        move |to| {
            to.radial = radial;
            to.axial = axial;
            to.speed = rpm * RPM;
            to.tilting = 0.0;
            to.outer_speed = 0.0;
            to.oil_height = 0.0;
        }
    }

    /// Moments in N mm of an independent implementation for 3 kN at 3000 rpm, without heating of the inlet and with a thick film.
    #[test]
    fn moments_of_a_6308() {
        let part = part(BALLS);
        let at = BearingAt::usual(&part, Notes::MUTED).with(|to| {
            loads(3000.0, 0.0, 3000.0)(to);
            to.nu = 15e-6;
            to.rho = 850.0;
            to.alpha = 1.8e-8;
            to.beta = 0.0;
        });
        let model = model(&part, r#"{ "roughness": 1e-12, "tau0": 5e6, "limiting_slope": 0.08 }"#);
        let loss = model.loss(&at).unwrap();
        let moment = |term: usize| 1e3 * loss.watts(term, at.speed) / at.speed;
        assert_close(moment(0), 41.797_64, 1e-5);
        assert_close(moment(1), 22.932_53, 1e-5);
        // The grid of six radii and sixteen angles is within two per cent of a fine one.
        assert_close(moment(2), 10.746_16, 0.02);
        // Boundary friction of 0.05 alone.
        let rough = self::model(&part, r#"{ "roughness": 1e6, "mu_bl": 0.05 }"#);
        let sliding = rough.loss(&at).unwrap().watts(2, at.speed) / at.speed;
        assert_close(1e3 * sliding, 21.693_07, 0.02);
    }

    /// The rib of a 32216 under 6 kN of thrust, by an independent implementation: 71.4 N at a height of 1.2 mm, in a line and in a contact of 1.6 mm.
    #[test]
    fn rib_of_a_32216() {
        let angle = 14.17_f64.to_radians();
        let inclined = Some(77_f64.to_radians());
        let torque = |angle_of_rib: Option<f64>, height: f64, half_width: f64, friction: f64| {
            let mut model = model(&part(TAPERED), "{}");
            model.params.rib = Rib {
                taper: Some(2.67_f64.to_radians()),
                angle: angle_of_rib,
                height: Some(height),
                half_width,
                friction,
            };
            model.rib_torque(angle, 17e-3) * 1_531.864_298
        };
        assert_close(torque(inclined, 1.0, 0.0, 1.0), 71.383_950, 5e-8);
        let [line, wide] = [0.0, 0.8e-3].map(|half_width| torque(inclined, 1.2e-3, half_width, 0.05));
        assert_close(wide / line, 261.984_80 / 252.094_99, 5e-8);
        // The radius of the outer raceway has four digits.
        let moment = |torque: f64| 1e3 * 16.0 * torque * 62.54 / 17.0;
        assert_close(moment(line), 252.094_99, 5e-5);
        // A rib square to the axis of the roller is 0.17 deg beside that of 77 deg.
        assert_close(moment(torque(None, 1.2e-3, 0.0, 0.05)), 252.094_99, 2e-4);
    }

    /// Balls in a mixture of oil and air with the density of an independent calculation, whose share of oil is 1e5 V^0.37/(n d_m^1.7) of a jet of
    /// 1000 cm3/min.
    #[test]
    fn drag_of_a_6308() {
        let part = part(BALLS);
        for (rpm, share, expected) in [
            (15_000.0, 0.071_114_15, 132.143_38),
            (30_000.0, 0.035_557_08, 537.185_59),
        ] {
            // Its air has 1 kg/m3.
            let density = share * 850.0 + (1.0 - share);
            let filling = (density - AIR) / (850.0 - AIR);
            let at = BearingAt::usual(&part, Notes::MUTED).with(|to| {
                loads(0.0, 0.0, rpm)(to);
                to.rho = 850.0;
            });
            let model = model(
                &part,
                &format!(r#"{{ "drag_coefficient": 0.4, "filling": {filling} }}"#),
            );
            assert_close(model.loss(&at).unwrap().watts(4, 1.0), expected, 2e-7);
            let jets = self::model(
                &part,
                &format!(r#"{{ "drag_coefficient": 0.4, "flow": {} }}"#, 1e-3 / 60.0),
            );
            let of_air = (share * 850.0 + (1.0 - share) * AIR) / density;
            assert_close(jets.loss(&at).unwrap().watts(4, 1.0), expected * of_air, 3e-7);
        }
        // Slowly, jets fill the bearing.
        assert_eq!(filling_of_jets(1e-3 / 60.0, 500.0, 65e-3), 1.0);
    }

    /// By hand: pi eta B D^3 w^2/(4 c) of 10 mPa s, 5 mm, 55 mm, 200 um, and 100 or 200 rad/s.
    #[test]
    fn shear_at_the_lands_of_a_cage() {
        for (guided_by, expected) in [(Guide::Outer, 0.326_676_55), (Guide::Inner, 1.306_706_19)] {
            let cage = Cage {
                guided_by,
                diameter: 55e-3,
                width: 5e-3,
                gap: 200e-6,
            };
            assert_close(cage.power(0.01, 300.0, 100.0), expected, 1e-6);
        }
    }

    #[test]
    fn hybrid_balls_roll_as_steel_balls_and_are_thrown_less() {
        let of = |material: &str, rpm: f64| {
            let part = part(&BALLS.replace("0 um }", &format!("0 um, material: {material} }}")));
            let at = BearingAt::usual(&part, Notes::MUTED).with(loads(1000.0, 500.0, rpm));
            model(&part, "{}").loss(&at).unwrap()
        };
        let (steel, hybrid) = (of("steel", 3000.0), of("silicon_nitride", 3000.0));
        assert_close(hybrid.watts(0, 1.0), steel.watts(0, 1.0), 0.03);
        assert!(of("silicon_nitride", 30_000.0).sum() < of("steel", 30_000.0).sum());
    }

    #[test]
    fn without_load_only_drag_remains() {
        for text in [BALLS, TAPERED, CYLINDRICAL] {
            let part = part(text);
            let still = BearingAt::usual(&part, Notes::MUTED).with(|to| {
                loads(0.0, 0.0, 3000.0)(to);
                to.oil_height = 0.01;
            });
            let loss = model(&part, "{}").loss(&still).unwrap();
            assert_eq!([0, 1, 2, 3].map(|term| loss.watts(term, 1.0)), [0.0; 4]);
            assert!(loss.watts(4, 1.0) > 0.0);
            assert_eq!(
                model(&part, "{}").loss(&still.with(|to| to.speed = 0.0)).unwrap().sum(),
                0.0
            );
        }
    }

    /// A contact angle needs thrust; less than that counts as the least, so that friction does not end where thrust does.
    #[test]
    fn little_thrust_is_the_least_that_the_angle_needs() {
        let part = part(TAPERED);
        let of = |axial: f64| {
            let at = BearingAt::usual(&part, Notes::MUTED).with(loads(5000.0, axial, 2000.0));
            model(&part, "{}").loss(&at).unwrap().sum()
        };
        assert_eq!(of(0.0), of(100.0));
        assert!(of(6000.0) > of(0.0));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// Losses are finite, even in the sense of rotation, and grow with the speed; with the load, too, where it keeps the loaded zone: the
        /// thrust of a ball bearing turns its contacts, and a ball that comes free no longer rolls under load.
        #[test]
        fn losses_grow(kind in 0..3_usize, radial in 10.0..20_000.0_f64, share in 0.0..1.0_f64, rpm in 10.0..10_000.0_f64) {
            let part = part([BALLS, TAPERED, CYLINDRICAL][kind]);
            let model = model(&part, "{}");
            let axial = if kind == 2 { 0.0 } else { (share + [0.0, 0.5, 0.0][kind]) * radial };
            let of = |radial: f64, axial: f64, rpm: f64| {
                let at = BearingAt::usual(&part, Notes::MUTED).with(loads(radial, axial, rpm));
                model.loss(&at).unwrap().sum()
            };
            let here = of(radial, axial, rpm);
            prop_assert!(here.is_finite() && here > 0.0);
            prop_assert!((of(radial, axial, -rpm) / here - 1.0).abs() < 1e-9);
            prop_assert!(of(radial, axial, 1.2 * rpm) > here);
            let axial = if kind == 0 { 0.0 } else { axial };
            prop_assert!(of(1.3 * radial, 1.3 * axial, rpm) > of(radial, axial, rpm));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]

        /// At any load, speed and viscosity, of few elements or many, each power is a number and not negative, and even in the sense of rotation;
        /// balls beyond their stated speed are refused. A flooded, unheated inlet takes more of a more viscous oil.
        #[test]
        fn extremes_have_finite_losses(
            kind in 0..5_usize, number in 3..=12_u32, logs in [-6.0..6.0_f64, -6.0..6.0_f64, -6.0..4.0_f64],
            log_rpm in -12.0..6.0_f64, log_nu in -3.0..7.0_f64, pure in 0..4_usize, level in -0.1..0.2_f64,
        ) {
            const HYBRID: &str = "{ kind: angular_contact_ball, bore: 40 mm, outside: 80 mm, contact_angle: 25 deg, \
                internal: { elements: 8, diameter: 11 mm, material: silicon_nitride } }";
            const NEEDLES: &str = "{ kind: needle_cage, bore: 40 mm, outside: 50 mm, width: 20 mm, c: 30000 N, c0: 50000 N, \
                internal: { elements: 20, diameter: 3 mm, length: 15 mm } }";
            let mut part = part([BALLS, HYBRID, TAPERED, CYLINDRICAL, NEEDLES][kind]);
            if kind < 2 && let Some(internal) = &mut part.internal {
                internal.elements = Some(number);
            }
            let model = model(&part, "{}");
            let [radial, axial, moment] = logs.map(|log| 10_f64.powf(log));
            let (radial, axial) = match pure {
                0 => (radial, 0.0),
                1 => (0.0, axial),
                _ => (radial, axial),
            };
            let rpm = 10_f64.powf(log_rpm);
            let at = |rpm: f64, nu: f64, tilting: f64| {
                BearingAt::usual(&part, Notes::MUTED).with(|to| {
                    loads(radial, axial, rpm)(to);
                    to.nu = nu;
                    to.oil_height = level.max(0.0);
                    to.tilting = tilting;
                })
            };
            let nu = 10_f64.powf(log_nu) * 1e-6;
            let is_too_fast = kind < 2 && part.mean_diameter().mm() * rpm > FASTEST;
            for tilting in [0.0, if pure == 3 { moment } else { 0.0 }] {
                let loss = match model.loss(&at(rpm, nu, tilting)) {
                    Ok(loss) => loss,
                    Err(refused) => {
                        prop_assert!(is_too_fast || tilting > 0.0, "{} {}", refused.what, refused.value);
                        continue;
                    }
                };
                prop_assert!(!is_too_fast);
                let speed = rpm * RPM;
                for term in 0..5 {
                    let power = loss.watts(term, speed);
                    prop_assert!(power.is_finite() && power >= 0.0, "{term}: {power}");
                    let back = model.loss(&at(-rpm, nu, tilting)).unwrap().watts(term, -speed);
                    prop_assert!((back - power).abs() <= 1e-9 * power, "{term}: {power} {back}");
                }
            }
            if !is_too_fast {
                let rolling = |nu: f64| model.loss(&at(rpm, nu, 0.0).with(|to| to.beta = 0.0)).unwrap().watts(0, rpm * RPM);
                prop_assert!(rolling(1.5 * nu) >= rolling(nu), "{} {}", rolling(nu), rolling(1.5 * nu));
            }
        }
    }
}
