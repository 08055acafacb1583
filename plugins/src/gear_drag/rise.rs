//! What changes the torque of any churning law: oil that gears raise in front of their mesh, and a factor of the user.
//!
//! The sense of rotation that draws oil into a mesh raises the level there; for the other one the torques of both gears add as if each ran
//! alone (Changenet and Velex, J. Mech. Des. 129 (2007); their formula is not public). Bound, derived: the surface in front of a mesh
//! stands no higher than the mesh, and half of the gear sees it. With the depth h_m at which the surface reaches the pitch point the
//! torque therefore grows at most by (T(h_m)/T(h) - 1)/2.
//!
//! A shroud with holes, derived: the oil in it falls until the gear throws off what the holes let in, P = rho v^2 Q. At its lowest the gear only
//! skims it, so that Q is the flow through the holes under the whole depth of the gear below the surface of the sump, and no law over a depth at rest
//! applies. The gear throws off c P/(rho v^2) with c = 1 by momentum (band 0.3 to 2, at most 2 by energy), all of it from 3 m/s on.

use gearloss_framework::description::HoleEntry;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::hydraulics::{GRAVITY, Orifice};
use gearloss_framework::limits;
use gearloss_framework::loss::{Loss, Notes, Undefined};
use gearloss_framework::mechanism::gear_drag::{GearBody, GearDrag, GearDragAt};
use gearloss_framework::registry::Build;
use gearloss_framework::sump::LEAST_SPLASH;

limits! {
    pub SWELL = ("swell - swell_max", "`swell` less the bound by the height of the mesh", "-", -10.0, 0.0,
        "derived: oil in front of a mesh stands no higher than the mesh");
}

/// Adds the parameters of [`Rise`] to those of a churning law.
macro_rules! churning {
    ($(#[$attribute:meta])* pub struct $Name:ident { $($fields:tt)* }) => {
        $(#[$attribute])*
        pub struct $Name {
            /// Relative increase of the torque if the gear's lowest point moves towards its mate. `explain` shows `swell_max`, up to which the
            /// height of the mesh allows it. [-]
            #[serde(default)]
            #[schemars(range(min = 0.0, max = 10.0))]
            pub swell: f64,
            /// The same as a share of `swell_max`; not with `swell`. [-]
            #[serde(default)]
            #[schemars(range(min = 0.0, max = 1.0))]
            pub swell_share: f64,
            /// Factor on the churning torque, for what the law does not contain, such as air in the oil, baffles or ribs. An identification may
            /// fit it. [-]
            #[serde(default = "crate::gear_drag::rise::default_one")]
            #[schemars(range(min = 0.0, max = 100.0))]
            pub factor: f64,
            /// Holes at the bottom of a shroud around the gear, through which its oil flows; without a shroud the sump feeds it.
            pub shroud: Option<gearloss_framework::description::HoleEntry>,
            $($fields)*
        }

        impl $Name {
            /// What changes the torque of the law.
            ///
            /// # Errors
            /// If swell is stated twice, or a shroud encloses two gears.
            fn rise(
                &self,
                cx: &mut gearloss_framework::registry::Build<'_>,
            ) -> Result<crate::gear_drag::rise::Rise, gearloss_framework::document::Diagnostic> {
                crate::gear_drag::rise::Rise::new([self.swell, self.swell_share], self.factor, self.shroud, cx)
            }
        }
    };
}
pub(super) use churning;

pub(crate) fn default_one() -> f64 {
    1.0
}

/// Swell in front of a mesh, the factor of the user, and the holes of a shroud.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rise {
    swell: f64,
    share: f64,
    factor: f64,
    shroud: Option<Orifice>,
}

impl Rise {
    #[cfg(test)]
    pub const NONE: Self = Self {
        swell: 0.0,
        share: 0.0,
        factor: 1.0,
        shroud: None,
    };

    #[cfg(test)]
    pub fn swelling(swell: f64) -> Self {
        Self { swell, ..Self::NONE }
    }

    /// From `swell` or `swell_share`, `factor` and `shroud`.
    pub fn new(
        [swell, share]: [f64; 2],
        factor: f64,
        shroud: Option<HoleEntry>,
        cx: &mut Build<'_>,
    ) -> Result<Self, Diagnostic> {
        if shroud.is_some() && cx.own_part::<GearDrag>()?.mate.is_some() {
            return Err(cx
                .error("a shroud encloses one gear, and this law is that of a pair")
                .help("choose a law for single gears, such as `changenet_2011`, or remove `shroud`"));
        }
        if swell > 0.0 && share > 0.0 {
            return Err(cx
                .error(format!(
                    "swell is stated twice: `swell: {swell}` and `swell_share: {share}`"
                ))
                .help("remove one of them"));
        }
        if share > 0.0 {
            cx.leave_unused(["swell"]);
        }
        Ok(Self {
            swell,
            share,
            factor,
            shroud: shroud.map(|holes| holes.orifice()),
        })
    }

    /// The loss of a law with swell and factor.
    ///
    /// # Errors
    /// If the law is undefined.
    pub fn applied(
        &self,
        at: &GearDragAt<'_>,
        law: impl Fn(&GearDragAt<'_>) -> Result<Loss, Undefined>,
    ) -> Result<Loss, Undefined> {
        let mut loss = law(at)?;
        let mut factor = self.factor;
        let draws_in = at.towards_mesh > 0.0 || at.towards_mesh_2 > 0.0;
        if draws_in && self.swell + self.share > 0.0 && loss.sum() > 0.0 {
            at.branch("the lowest point moves towards the mate: swell applies");
            let swell = match bound(at, loss.sum(), law) {
                Ok(bound) => {
                    at.show("swell_max", "-", bound);
                    // A gear that hardly dips has a bound beyond all limits.
                    at.check(&SWELL, (self.swell - bound).max(-10.0));
                    self.swell + self.share * bound
                }
                // Without a bound there is no share of it.
                Err(undefined) if self.share > 0.0 => return Err(undefined),
                Err(_) => self.swell,
            };
            factor *= 1.0 + at.show("swell", "-", swell);
        }
        if factor != 1.0 {
            loss = loss.times(at.show("factor", "-", factor));
        }
        match &self.shroud {
            Some(holes) => Ok(starved(at, loss, holes)),
            None => Ok(loss),
        }
    }
}

/// A loss, or what the holes of a shroud leave of it.
fn starved(at: &GearDragAt<'_>, loss: Loss, holes: &Orifice) -> Loss {
    let radius = 0.5 * at.part.gear.tip_diameter;
    let omega = at.speed.abs();
    let x = (omega * radius / LEAST_SPLASH * 2.0 - 1.0).clamp(0.0, 1.0);
    let thrown = x * x * (3.0 - 2.0 * x);
    let (flow, _) = holes.flow(at.rho * GRAVITY * at.tip_dip, at.eta, at.rho);
    at.show("Q_hole", "l/min", flow * 6e4);
    let most = at.rho * omega * radius * radius * flow;
    if most >= thrown * loss.sum() {
        at.branch("the holes of the shroud let in more oil than the gear throws off");
        return loss;
    }
    at.branch("the gear has emptied its shroud: it throws off what the holes let in");
    loss.times(most / (thrown * loss.sum()))
}

/// Largest relative increase of a law's sum if the surface in front of the mesh stands at the pitch point.
fn bound(
    at: &GearDragAt<'_>,
    sum: f64,
    law: impl Fn(&GearDragAt<'_>) -> Result<Loss, Undefined>,
) -> Result<f64, Undefined> {
    let raised = at.with(|to| {
        if at.towards_mesh > 0.0 {
            [to.tip_dip, to.dip] = at_mesh(&at.part.gear, at.mesh_height, [at.tip_dip, at.dip]);
        }
        if let Some(mate) = at.part.mate.as_ref().filter(|_| at.towards_mesh_2 > 0.0) {
            [to.tip_dip_2, to.dip_2] = at_mesh(mate, at.mesh_height_2, [at.tip_dip_2, at.dip_2]);
        }
        to.notes = Notes::MUTED;
    });
    Ok((0.5 * (law(&raised)?.sum() / sum - 1.0)).max(0.0))
}

/// Immersion depths of tip and reference circle with the surface at the pitch point of a height, if it is below. \[m\]
fn at_mesh(gear: &GearBody, height: f64, dips: [f64; 2]) -> [f64; 2] {
    let height = if height > 0.0 {
        height.min(gear.tip_diameter)
    } else {
        gear.contact_height
    };
    if height > dips[0] {
        [height, gear.dip_of(height)]
    } else {
        dips
    }
}

#[cfg(test)]
mod tests {
    use gearloss_framework::hydraulics::{GRAVITY, Orifice};
    use gearloss_framework::testing::{assert_close, eval};

    /// Loss of a wheel of 160 mm with 64 teeth of 5.6 mm height, 30 mm wide, at a mesh at the height of its axis.
    fn loss(law: &str, speed: f64, dip: f64, towards: f64) -> f64 {
        loss_at(law, speed, dip, (towards, 0.0))
    }

    /// The same with the height of the highest mesh towards which the lowest point moves. \[mm\]
    fn loss_at(law: &str, speed: f64, dip: f64, (towards, height): (f64, f64)) -> f64 {
        let input = format!(
            "{{ model: {law}, part: {{ gear: {{ z: 64, normal_module: 2.5 mm, pressure_angle: 20 deg, facewidth: 30 mm, \
             reference_diameter: 160 mm, working_diameter: 160 mm, tip_diameter: 165 mm, root_diameter: 153.8 mm, contact_height: 82.5 mm }}, \
             oil_volume: 1.3 l, radial_clearance: 6 mm, axial_clearance: 30 mm }}, \
             at: {{ speed: {speed} rad/s, dip: {dip} mm, nu: 10 mm2/s, rho: 840 kg/m3, towards_mesh: {towards}, mesh_height: {height} mm }} }}"
        );
        let name = law.split(&[':', ',', '}'][..]).nth(1).unwrap_or_default().trim();
        eval(&format!("gear_drag/{name}"), &input).total
    }

    /// The largest swell of the slow and the fast branch of Changenet and others 2011, calculated independently.
    #[test]
    fn the_bound_is_that_of_a_surface_at_the_mesh() {
        let law = "{ type: changenet_2011, swell_share: 1 }";
        for (speed, dip, expected) in [
            (100.0, 10.0, 7.4646),
            (100.0, 25.0, 2.8844),
            (100.0, 40.0, 1.8013),
            (400.0, 10.0, 3.8637),
            (400.0, 25.0, 2.0870),
            (400.0, 40.0, 1.5210),
        ] {
            let ratio = loss(law, speed, dip, 1.0) / loss(law, speed, dip, 0.0);
            assert!((ratio - expected).abs() <= 5e-5, "{ratio} {expected}");
        }
        // At the height of the mesh and above it nothing can swell.
        assert_close(loss(law, 100.0, 90.0, 1.0), loss(law, 100.0, 90.0, 0.0), 1e-15);
    }

    #[test]
    fn every_law_over_immersion_has_swell_and_factor() {
        for law in [
            "changenet_2007",
            "changenet_2011",
            "shore, fill: 0.3",
            "iso14179_1",
            "mauz",
            "seetharaman_kahraman",
            "dimensional, c_m: \"0.1 * fr^-0.6 * h^0.5\"",
        ] {
            let at = |keys: &str, towards| loss(&format!("{{ type: {law}{keys} }}"), 100.0, 25.0, towards);
            let alone = at("", 0.0);
            assert!(alone > 0.0, "{law}");
            assert_eq!(at("", 1.0).to_bits(), alone.to_bits(), "{law}");
            assert_close(at(", swell: 0.3", 1.0), 1.3 * alone, 1e-14);
            assert_eq!(at(", swell: 0.3", 0.0).to_bits(), alone.to_bits(), "{law}");
            assert_close(at(", factor: 0.5", 0.0), 0.5 * alone, 1e-14);
            let (half, whole) = (at(", swell_share: 0.5", 1.0), at(", swell_share: 1", 1.0));
            assert!(half > alone, "{law}");
            assert_close(half, 0.5 * (alone + whole), 1e-13);
        }
    }

    /// Of several mates the highest one that draws oil in bounds the swell, whatever mesh the gear has its body from.
    #[test]
    fn the_highest_mesh_bounds_the_swell() {
        let law = "{ type: changenet_2011, swell_share: 1 }";
        let at = |height: f64| loss_at(law, 20.0, 25.0, (1.0, height));
        assert_eq!(at(0.0).to_bits(), at(82.5).to_bits());
        assert!(at(40.0) < at(82.5) && at(82.5) < at(140.0));
        // Not above the gear itself, and nothing below the surface.
        assert_eq!(at(165.0).to_bits(), at(4000.0).to_bits());
        assert_eq!(at(20.0).to_bits(), loss_at(law, 20.0, 25.0, (0.0, 20.0)).to_bits());
    }

    /// The gear throws off what the holes let in, and no more than the law says.
    #[test]
    fn holes_of_a_shroud_starve_a_gear() {
        let law = |keys: &str| format!("{{ type: changenet_2011{keys} }}");
        let free = |speed| loss(&law(""), speed, 50.0, 0.0);
        let shrouded = |hole: &str, speed| loss(&law(&format!(", shroud: {{ {hole} }}")), speed, 50.0, 0.0);
        let narrow = "diameter: 4 mm, length: 8 mm, discharge: 0.8";
        // Tip circle 82.5 mm, 52.5 mm deep; 10 mm2/s and 840 kg/m3.
        let hole = Orifice {
            diameter: 4e-3,
            length: 8e-3,
            discharge: 0.8,
            count: 1.0,
        };
        let (flow, _) = hole.flow(840.0 * GRAVITY * 52.5e-3, 8.4e-3, 840.0);
        for speed in [100.0, 300.0] {
            let watts = 840.0 * (speed * 0.0825_f64).powi(2) * flow;
            assert!(watts < free(speed), "{watts} {}", free(speed));
            assert_close(shrouded(narrow, speed), watts, 1e-12);
        }
        // Wide holes feed it as the sump does, and a slow gear throws nothing off.
        assert_eq!(shrouded("diameter: 100 mm", 300.0).to_bits(), free(300.0).to_bits());
        assert_eq!(shrouded(narrow, 15.0).to_bits(), free(15.0).to_bits());
        let more = |count: u32| shrouded(&format!("{narrow}, count: {count}"), 300.0);
        assert!(more(1) < more(2) && more(2) < more(6) && more(6) <= free(300.0));
    }

    #[test]
    #[should_panic(expected = "swell is stated twice")]
    fn swell_is_stated_once() {
        loss("{ type: mauz, swell: 0.3, swell_share: 0.5 }", 100.0, 25.0, 1.0);
    }
}
