//! Bevel differential: friction of thrust washers, pinions and teeth; torque bias of an open differential.
//!
//! Derived. In the frame of the case the side gears turn at half the difference of speed, in opposite directions, and drive each other
//! through the pinions. The thrust of a side gear on its washer takes e_s = mu_w tan(alpha) sin(delta_s) r_w/r_s of its torque, the thrust of
//! a pinion on its seat and its force on the pin take e_p = (mu_s tan(alpha) sin(delta_p) r_sp + mu_p r_pin)/r_p of the torque through it, and two
//! meshes in series e_m = (1 - eta_0)/(1 + eta_0). The slower side gains what the faster one loses:
//! S = (T_slow - T_fast)/T_case = tanh(atanh(e_s) + atanh(e_p) + atanh(e_m)), T_slow/T_fast = (1 + S)/(1 - S). The loss is
//! (T_slow - T_fast) |w_left - w_right|/2: none straight ahead. While the wheels drive the case, the faster side carries more.
//! With the pitch radii r_s and r_p = r_s z_p/z_s, straight teeth and any number of pinions. All coefficients of friction must be stated: those of
//! washers without their own film are of the order of boundary friction.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::differential::{Differential, DifferentialAt, DifferentialGears, DifferentialLaw};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

terms! {
    pub(super) WASHERS = load("washers");
    pub(super) PINIONS = load("pinions");
    pub(super) TEETH = load("teeth");
}
observed! {
    pub(super) BIAS = ("S", "-", "torque bias (T_slow - T_fast)/T_case while the case drives");
    pub(super) RATIO = ("T_slow/T_fast", "-", "torque of the slower side over that of the faster one while the case drives");
}

/// Bevel differential: friction of thrust washers, pinions and teeth; torque bias of an open differential.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Friction of the contacts that are no teeth.
    #[serde(flatten)]
    pub contacts: ContactFriction,
    /// Efficiency of the two meshes in series, from one side gear to the other. [-]
    #[schemars(range(min = 0.5, max = 1.0))]
    pub mesh_efficiency: f64,
}

/// Coefficients of friction of the contacts that are no teeth.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct ContactFriction {
    /// Coefficient of friction of the thrust washers of the side gears. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub friction: f64,
    /// Coefficient of friction of the pinions on their seats; default: `friction`. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub seat_friction: Option<f64>,
    /// Coefficient of friction of the pinions on their pin; default: `friction`. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub pin_friction: Option<f64>,
}

/// Shares of the torque through a side gear that its washer takes, and of that through a pinion that its seat and its pin take.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contacts {
    pub washer: f64,
    pub pinion: f64,
}

impl Contacts {
    /// `None` if a contact takes the whole torque.
    pub fn new(friction: &ContactFriction, gears: &DifferentialGears) -> Option<Self> {
        let [z_s, z_p] = [gears.side.z, gears.pinion.z].map(f64::from);
        let thrust = gears.pressure_angle.tan();
        // Sines of the pitch angles.
        let [s_s, s_p] = [z_s, z_p].map(|z| z / z_s.hypot(z_p));
        let r_p = gears.side.radius * z_p / z_s;
        let washer = friction.friction * thrust * s_s * gears.side.washer_radius / gears.side.radius;
        let seat = friction.seat_friction.unwrap_or(friction.friction) * thrust * s_p * gears.pinion.seat_radius;
        let pin = friction.pin_friction.unwrap_or(friction.friction) * gears.pinion.pin_radius;
        let pinion = (seat + pin) / r_p;
        (washer < 1.0 && pinion < 1.0).then_some(Self { washer, pinion })
    }
}

struct BevelGears {
    /// Shares of the torque of the driving side gear that washers, pinions and teeth take.
    shares: [f64; 3],
    washer: f64,
    pinion: f64,
    bias: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<BevelGears, Diagnostic> {
    let Some(gears) = cx.own_part::<Differential>()?.gears else {
        return Err(cx
            .error("bevel_gears requires the gears of the differential")
            .help("add `gears: { side: { z, radius, washer_radius }, pinion: { z, seat_radius, pin_radius } }`, or use `bias`"));
    };
    let built = BevelGears::new(&params, &gears);
    built.ok_or_else(|| {
        cx.error("friction takes the whole torque: the differential would lock itself")
            .help("correct the coefficients of friction and the radii")
    })
}

impl BevelGears {
    /// `None` if a washer or a pinion takes the whole torque.
    fn new(params: &Params, gears: &DifferentialGears) -> Option<Self> {
        let Contacts { washer, pinion } = Contacts::new(&params.contacts, gears)?;
        let mesh = (1.0 - params.mesh_efficiency) / (1.0 + params.mesh_efficiency);
        // From the driving side gear through its washer, a mesh, the pinion and the other mesh to the other washer.
        let one_mesh = params.mesh_efficiency.sqrt();
        let first = 1.0 / (1.0 + washer);
        let at_pinion = one_mesh * first;
        let behind_pinion = at_pinion * (1.0 - pinion) / (1.0 + pinion);
        let last = one_mesh * behind_pinion;
        Some(Self {
            shares: [
                washer * (first + last),
                at_pinion - behind_pinion,
                (first - at_pinion) + (behind_pinion - last),
            ],
            washer,
            pinion,
            bias: (washer.atanh() + pinion.atanh() + mesh.atanh()).tanh(),
        })
    }
}

impl DifferentialLaw for BevelGears {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &DifferentialAt<'_, R>) -> Result<Loss<R>, Undefined> {
        at.show("e_s", "-", R::constant(self.washer));
        at.show("e_p", "-", R::constant(self.pinion));
        let bias = at.observe(&BIAS, R::constant(self.bias));
        at.observe(&RATIO, (bias + 1.0) / (-bias + 1.0));
        let power = at.show("P_in", "W", at.torque * at.speed.abs());
        let [washers, pinions, teeth] = self.shares;
        Ok(Loss::POWERS
            .with(&WASHERS, power * washers)
            .with(&PINIONS, power * pinions)
            .with(&TEETH, power * teeth))
    }
}

register!(Differential, "bevel_gears", Params,
    source: "derived: equilibrium of side gears and pinions",
    example: "{ type: bevel_gears, friction: 0.08, mesh_efficiency: 0.98 }",
    evidence: [
        formula(Evidence::Derived, "equilibrium; the coefficients of friction are the user's"),
        default_of("seat_friction", Evidence::Assumed, "the same as of the washers"),
        default_of("pin_friction", Evidence::Assumed, "the same as of the washers"),
    ],
    checks: [
        Check {
            input: "{ model: { type: bevel_gears, friction: 0.08, mesh_efficiency: 1 }, at: { torque: 535.13560538 Nm, speed: 5 rad/s } }",
            values: &[
                ("e_s", "0.0230455786 -"), ("e_p", "0.0473022354 -"), ("S", "0.0702712108 -"), ("T_slow/T_fast", "1.1511649667 -"),
                ("total", "351.35605377 W"), ("washers", "115.10241878 W"), ("pinions", "236.25363499 W"),
            ],
            tolerance: 3e-9,
            because: "the smallest value has nine digits",
            source: "independent implementation of the formula: 1000 Nm at the case, sides 10 rad/s apart; the total is the sum of its parts",
        },
    ],
    terms: [WASHERS, PINIONS, TEETH], observed: [BIAS, RATIO], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::mechanism::differential::{PinionGear, SideGear};

    const GEARS: DifferentialGears = DifferentialGears {
        side: SideGear {
            z: 16,
            radius: 30e-3,
            washer_radius: 28e-3,
        },
        pinion: PinionGear {
            z: 10,
            seat_radius: 16e-3,
            pin_radius: 8e-3,
        },
        pressure_angle: 0.349_065_850_398_865_9,
        teeth: None,
    };

    #[test]
    fn the_shares_are_those_of_the_torque_bias() {
        for mesh_efficiency in [1.0, 0.97, 0.9] {
            let contacts = ContactFriction {
                friction: 0.08,
                seat_friction: Some(0.1),
                pin_friction: None,
            };
            let params = Params {
                contacts,
                mesh_efficiency,
            };
            let built = BevelGears::new(&params, &GEARS).unwrap();
            // Of a torque of one on the slow side the fast side has (1 - S)/(1 + S).
            let lost: f64 = built.shares.iter().sum();
            let fast = (1.0 - built.bias) / (1.0 + built.bias);
            assert!((1.0 - lost - fast).abs() < 1e-15, "{mesh_efficiency}");
        }
    }

    #[test]
    fn without_friction_nothing_is_lost() {
        let contacts = ContactFriction {
            friction: 0.0,
            seat_friction: None,
            pin_friction: None,
        };
        let params = Params {
            contacts,
            mesh_efficiency: 1.0,
        };
        let built = BevelGears::new(&params, &GEARS).unwrap();
        assert_eq!((built.shares, built.bias), ([0.0; 3], 0.0));
    }
}
