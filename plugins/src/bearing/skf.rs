//! Frictional moment after the SKF catalogue: rolling, sliding and drag. Deep groove ball bearings.
//!
//! Source: SKF, Rolling bearings, PUB BU/P1 10000 (2013) and 17000 (2018), "The SKF model for calculating the frictional
//! moment": M = M_rr + M_sl + M_drag, N mm.
//! Steady load above the minimum load, normal clearance, speed below the limiting speed, large oil bath, horizontal shaft.
//! Not for n d_m far above 0.5e6 mm/min. At vanishing axial load the formulas do not join: a purely radial load uses other
//! exponents of d_m, as published.
//! Two editions differ in the coefficient of boundary friction: 0.15 in 2013, 0.12 running in 2018.

mod drag;

use drag::Drag;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Limit, Loss, Observed, Term, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::bearing::{Bearing, BearingAt, BearingKind, BearingModel, BearingPart, Lubrication};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const ROLLING: Term = Term::load(0, "rolling");
const SLIDING: Term = Term::load(1, "sliding");
const DRAG: Term = Term::no_load(2, "drag");
const SPEED: Limit = Limit::new(0, "n d_m", "mm/min", 0.0, 0.5e6, "above, drag follows other laws");
const VISCOSITY: Limit = Limit::new(
    1,
    "nu",
    "mm2/s",
    0.0,
    500.0,
    "stated for the drag of oil baths up to D/2",
);
const VISCOSITY_DEEP: Limit = Limit::new(
    2,
    "nu (deep bath)",
    "mm2/s",
    0.0,
    250.0,
    "stated for the drag of oil baths above D/2",
);
const MU_SL: Observed = Observed::new(0, "mu_sl", "-", "Coefficient of sliding friction.");
const PHI_BL: Observed = Observed::new(1, "phi_bl", "-", "Weight of boundary friction.");

/// Coefficient of sliding friction at standstill, both editions.
const MU_START: f64 = 0.15;

/// R1/1e-7, R2, S1/1e-3, S2 of deep groove ball bearings, by series.
const DEEP_GROOVE: [(&[&str], [f64; 4]); 9] = [
    (&["2", "3"], [4.4, 1.7, 2.00, 100.0]),
    (&["42", "43"], [5.4, 0.96, 3.00, 40.0]),
    (&["60", "630"], [4.1, 1.7, 3.73, 14.6]),
    (&["62", "622"], [3.9, 1.7, 3.23, 36.5]),
    (&["63", "623"], [3.7, 1.7, 2.84, 92.8]),
    (&["64"], [3.6, 1.7, 2.43, 198.0]),
    (&["160", "161"], [4.3, 1.7, 4.63, 4.25]),
    (&["617", "618", "628", "637", "638"], [4.7, 1.7, 6.50, 0.78]),
    (&["619", "639"], [4.3, 1.7, 4.75, 3.6]),
];

/// Edition of the catalogue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum Edition {
    /// PUB 10000.
    #[serde(rename = "2013")]
    Y2013,
    /// PUB 17000.
    #[default]
    #[serde(rename = "2018")]
    Y2018,
}

/// Frictional moment after the SKF catalogue.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Skf {
    /// Edition of the catalogue, in quotes; sets the coefficient of boundary friction.
    #[serde(default)]
    pub edition: Edition,
    /// Coefficient of boundary friction; absent, that of the oil, else that of the edition. [-]
    #[schemars(range(min = 0.01, max = 0.3))]
    pub mu_bl: Option<f64>,
    /// Coefficient of full-film friction; absent, that of the oil. [-]
    #[schemars(range(min = 0.001, max = 0.2))]
    pub mu_ehl: Option<f64>,
    /// Diameter of a ball, for jet lubrication; absent, 0.3 times the difference of outside and bore. [mm]
    #[schemars(range(min = 0.1, max = 500.0))]
    pub ball: Option<f64>,
    /// No starvation, as where the oil stands above the centre of the lowest ball and keeps the raceway replenished. This is
    /// not taken from the level.
    #[serde(default)]
    pub full_replenishment: bool,
}

/// One bearing, prepared.
#[derive(Debug)]
struct DeepGroove {
    /// \[mm\]
    d_m: f64,
    ln_d_m: f64,
    /// R1 d_m^1.96.
    rolling: f64,
    r2: f64,
    /// S1 d_m^-0.26 for purely radial, S1 d_m^-0.145 for combined load.
    sliding: [f64; 2],
    /// S2 d_m^1.5.
    s2: f64,
    c0: f64,
    /// Exponent of starvation per viscosity and speed.
    starvation: f64,
    mu_bl: Option<f64>,
    edition_mu_bl: f64,
    mu_ehl: Option<f64>,
    drag: Option<Drag>,
}

impl DeepGroove {
    fn new(params: &Skf, part: &BearingPart) -> Result<Self, (String, String)> {
        if part.kind != BearingKind::DeepGrooveBall && part.kind != BearingKind::DeepGrooveBallDoubleRow {
            return Err((
                "skf covers deep groove ball bearings".to_owned(),
                "give this bearing a model of its own, such as `model: { type: iso14179_2 }`".to_owned(),
            ));
        }
        let known = || {
            DEEP_GROOVE
                .iter()
                .flat_map(|(names, _)| names.iter().copied())
                .collect::<Vec<_>>()
                .join(", ")
        };
        let series = part.series.as_deref().unwrap_or("");
        let Some((_, [r1, r2, s1, s2])) = DEEP_GROOVE.iter().find(|(names, _)| names.contains(&series)) else {
            return Err((
                format!("skf has no constants for series `{series}`"),
                format!("set `series` to one of {}", known()),
            ));
        };
        let c0 = part.c0.ok_or_else(|| {
            (
                "skf needs `c0`".to_owned(),
                "add `c0:`, or a `designation` of a catalogue".to_owned(),
            )
        })?;
        let (d, big_d, d_m) = (part.bore.mm(), part.outside.mm(), part.mean_diameter().mm());
        let k_z = 3.1;
        let k_rs = match part.lubrication {
            Lubrication::Bath | Lubrication::Jet => 3e-8,
            Lubrication::Grease | Lubrication::OilAir => 6e-8,
        };
        let rows = if part.kind == BearingKind::DeepGrooveBallDoubleRow {
            2.0
        } else {
            1.0
        };
        let drag = match part.lubrication {
            Lubrication::Bath => Some(Drag::ball(d, big_d, k_z, rows, None)),
            Lubrication::Jet => {
                let ball = params.ball.map_or(0.3 * (big_d - d), ShopUnits::mm);
                Some(Drag::ball(d, big_d, k_z, rows, Some(0.5 * ball)))
            }
            Lubrication::Grease | Lubrication::OilAir => None,
        };
        Ok(Self {
            d_m,
            ln_d_m: d_m.ln(),
            rolling: r1 * 1e-7 * d_m.powf(1.96),
            r2: *r2,
            sliding: [s1 * 1e-3 * d_m.powf(-0.26), s1 * 1e-3 * d_m.powf(-0.145)],
            s2: s2 * d_m.powf(1.5),
            c0,
            starvation: if params.full_replenishment {
                0.0
            } else {
                k_rs * (d + big_d) * (k_z / (2.0 * (big_d - d))).sqrt()
            },
            mu_bl: params.mu_bl,
            edition_mu_bl: if params.edition == Edition::Y2013 { 0.15 } else { 0.12 },
            mu_ehl: params.mu_ehl,
            drag,
        })
    }

    /// G_rr and G_sl from radial and axial load. \[N\]
    fn load_variables(&self, fr: f64, fa: f64) -> (f64, f64) {
        let ratio = fa / self.c0;
        // Also where the quotient underflows: an angle of zero has no sine to divide by.
        if ratio == 0.0 {
            if fr == 0.0 {
                return (0.0, 0.0);
            }
            let ln = fr.ln();
            return (
                self.rolling * (0.54 * ln).exp(),
                self.sliding[0] * (5.0 / 3.0 * ln).exp(),
            );
        }
        let alpha = (24.6 * ratio.powf(0.24)).to_radians();
        let sin = alpha.sin();
        let rolling = self.rolling * (fr + self.r2 * fa / sin).powf(0.54);
        let sliding = self.sliding[1] * (fr.powi(5) + self.s2 * fa.powi(4) / sin).cbrt();
        (rolling, sliding)
    }
}

fn prepare(params: Skf, cx: &mut Build<'_>) -> Result<DeepGroove, Diagnostic> {
    let part = cx.part::<Bearing>().ok_or_else(|| cx.error("bug: no part"))?;
    DeepGroove::new(&params, part).map_err(|(message, mend)| cx.error(message).mend(mend))
}

impl BearingModel for DeepGroove {
    fn loss(&self, at: &BearingAt<'_>) -> Result<Loss, Undefined> {
        let (fr, fa) = (at.show("Fr", "N", at.radial), at.show("Fa", "N", at.axial));
        // 24.6 (Fa/C0)^0.24 degrees reach 90 at Fa = 222 C0; far before, no bearing lives.
        if fa > 10.0 * self.c0 {
            return Err(Undefined {
                what: "axial load over C0",
                value: fa / self.c0,
            });
        }
        let (g_rr, g_sl) = self.load_variables(fr, fa);
        at.show("G_rr", "-", g_rr);
        at.show("G_sl", "-", g_sl);
        let n = at.speed.abs().rpm();
        let nu = at.show("nu", "mm2/s", at.nu.mm2_s());
        at.check(&SPEED, n * self.d_m);
        if n == 0.0 {
            at.branch("at rest: starting friction");
            return Ok(Loss::MOMENTS.with(&SLIDING, (MU_START * g_sl).nmm_in_nm()));
        }
        let (ln_n, ln_nu) = (n.ln(), nu.ln());
        let phi_ish = 1.0 / (1.0 + 1.84e-9 * (1.28 * (ln_n + self.ln_d_m) + 0.64 * ln_nu).exp());
        let phi_rs = (-self.starvation * nu * n).max(-700.0).exp();
        let phi_bl = (-2.6e-8 * (1.4 * (ln_n + ln_nu)).exp() * self.d_m).max(-700.0).exp();
        let mu_bl = self
            .mu_bl
            .unwrap_or(if at.mu_bl > 0.0 { at.mu_bl } else { self.edition_mu_bl });
        let mu_ehl = self.mu_ehl.unwrap_or(at.mu_ehl);
        let mu_sl = at.observe(&MU_SL, at.observe(&PHI_BL, phi_bl) * mu_bl + (1.0 - phi_bl) * mu_ehl);
        at.show("phi_ish", "-", phi_ish);
        at.show("phi_rs", "-", phi_rs);
        let m_rr = at.show("M_rr", "N mm", phi_ish * phi_rs * g_rr * (0.6 * (ln_n + ln_nu)).exp());
        let m_sl = at.show("M_sl", "N mm", g_sl * mu_sl);
        let loss = Loss::MOMENTS
            .with(&ROLLING, m_rr.nmm_in_nm())
            .with(&SLIDING, m_sl.nmm_in_nm());
        Ok(match &self.drag {
            Some(drag) => {
                let height = at.show("H", "mm", at.oil_height.mm());
                at.check(
                    if at.oil_height > 0.5 * at.part.outside {
                        &VISCOSITY_DEEP
                    } else {
                        &VISCOSITY
                    },
                    nu,
                );
                loss.with(&DRAG, at.show("M_drag", "N mm", drag.moment(height, n, nu)).nmm_in_nm())
            }
            None => loss,
        })
    }
}

register!(Bearing, "skf", Skf,
    meaning: "Rolling, sliding and drag moment after the SKF catalogue, for deep groove ball bearings.",
    source: "SKF Rolling bearings, PUB 10000 (2013) and PUB 17000 (2018)",
    example: "{ type: skf, edition: \"2018\" }",
    evidence: [
        formula(Evidence::SeveralSources, "catalogue pages and three transcriptions of the constants agree"),
        default_of("edition", Evidence::SeveralSources, "both editions are printed"),
        default_of("ball", Evidence::Assumed, "usual share of the section"),
        default_of("mu_bl", Evidence::SeveralSources, "0.15 in 2013, 0.12 running in 2018, unless the oil states its own"),
        default_of("mu_ehl", Evidence::SeveralSources, "by the kind of oil: 0.05 mineral, 0.04 synthetic, 0.10 transmission fluid"),
        default_of("full_replenishment", Evidence::OneSource, "starvation as in the catalogue"),
    ],
    limits: [SPEED, VISCOSITY, VISCOSITY_DEEP], terms: [ROLLING, SLIDING, DRAG], observed: [MU_SL, PHI_BL], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::bearing::BearingEntry;

    fn params() -> Skf {
        Skf {
            edition: Edition::Y2018,
            mu_bl: None,
            mu_ehl: Some(0.10),
            ball: None,
            full_replenishment: false,
        }
    }

    fn part() -> BearingPart {
        let entry = BearingEntry {
            kind: Some(BearingKind::DeepGrooveBall),
            series: Some("63".to_owned()),
            bore: Some(0.040),
            outside: Some(0.090),
            c0: Some(24000.0),
            ..BearingEntry::default()
        };
        BearingPart::try_from(entry).unwrap()
    }

    fn close(value: f64, printed: f64) {
        assert!((value / printed - 1.0).abs() < 1e-5, "{value} against {printed}");
    }

    fn at(part: &BearingPart, fr: f64, fa: f64, height: f64) -> BearingAt<'_> {
        BearingAt {
            speed: 3000.0 * std::f64::consts::PI / 30.0,
            nu: 15e-6,
            radial: fr,
            axial: fa,
            oil_height: height * 1e-3,
            ..BearingAt::usual(part, Notes::MUTED)
        }
    }

    #[test]
    fn a3_1_deep_groove_6308_in_a_low_bath() {
        let part = part();
        let model = DeepGroove::new(&params(), &part).unwrap();
        let (g_rr, g_sl) = model.load_variables(3000.0, 1000.0);
        close(g_rr, 0.206651);
        close(g_sl, 1220.21);
        let loss = model.loss(&at(&part, 3000.0, 1000.0, 10.0)).unwrap();
        close(loss.value(0) * 1e3, 116.905);
        close(loss.value(1) * 1e3, 122.118);
        close(loss.value(2) * 1e3, 6.46321);
        close(loss.sum() * 1e3, 245.486);
    }

    #[test]
    fn a3_2_without_axial_load() {
        let (g_rr, g_sl) = DeepGroove::new(&params(), &part()).unwrap().load_variables(3000.0, 0.0);
        close(g_rr, 0.0998062);
        close(g_sl, 598.636);
    }

    #[test]
    fn a3_13_deep_bath() {
        let part = part();
        let model = DeepGroove::new(&params(), &part).unwrap();
        close(model.loss(&at(&part, 0.0, 0.0, 65.0)).unwrap().value(2) * 1e3, 38.1012);
    }

    #[test]
    fn a3_12_oil_jet() {
        let mut part = part();
        part.lubrication = Lubrication::Jet;
        let model = DeepGroove::new(
            &Skf {
                ball: Some(15.081e-3),
                ..params()
            },
            &part,
        )
        .unwrap();
        close(model.loss(&at(&part, 0.0, 0.0, 0.0)).unwrap().value(2) * 1e3, 8.07646);
    }

    #[test]
    fn editions_differ_in_boundary_friction_and_rest_is_finite() {
        let part = part();
        let slow = |edition| {
            let model = DeepGroove::new(&Skf { edition, ..params() }, &part).unwrap();
            let at = BearingAt {
                speed: 1e-3,
                ..at(&part, 3000.0, 0.0, 0.0)
            };
            model.loss(&at).unwrap().value(1)
        };
        close(slow(Edition::Y2013) / slow(Edition::Y2018), 0.15 / 0.12);
        let model = DeepGroove::new(&params(), &part).unwrap();
        let rest = model
            .loss(&BearingAt {
                speed: 0.0,
                ..at(&part, 3000.0, 0.0, 10.0)
            })
            .unwrap();
        assert!(rest.is_sound() && rest.value(0) == 0.0 && rest.value(2) == 0.0);
        assert_eq!(model.loss(&at(&part, 0.0, 0.0, 0.0)).unwrap().sum(), 0.0);
    }

    #[test]
    fn other_kinds_are_refused_with_a_way_out() {
        let mut part = part();
        part.kind = BearingKind::NeedleCage;
        assert!(
            DeepGroove::new(&params(), &part)
                .unwrap_err()
                .1
                .contains("model of its own")
        );
    }

    #[test]
    fn starvation_follows_lubrication_and_full_replenishment_ends_it() {
        let rolling = |lubrication, full_replenishment| {
            let mut part = part();
            part.lubrication = lubrication;
            let model = DeepGroove::new(
                &Skf {
                    full_replenishment,
                    ..params()
                },
                &part,
            )
            .unwrap();
            let loss = model.loss(&at(&part, 3000.0, 1000.0, 10.0)).unwrap();
            (loss.value(0) * 1e3, loss.value(2))
        };
        let full = 116.905 / 0.969573;
        let (bath, _) = rolling(Lubrication::Bath, false);
        close(bath, full * 0.969573);
        close(rolling(Lubrication::Bath, true).0, full);
        // Grease and oil-air starve twice as fast and drag no bath along.
        for lubrication in [Lubrication::Grease, Lubrication::OilAir] {
            let (rolling, drag) = rolling(lubrication, false);
            close(rolling, full * 0.969573 * 0.969573);
            assert_eq!(drag, 0.0);
        }
    }

    #[test]
    fn a_written_coefficient_goes_before_that_of_the_oil_and_of_the_edition() {
        let part = part();
        let sliding = |mu_bl, oil| {
            let model = DeepGroove::new(&Skf { mu_bl, ..params() }, &part).unwrap();
            let at = BearingAt {
                speed: 1e-3,
                mu_bl: oil,
                ..at(&part, 3000.0, 0.0, 0.0)
            };
            model.loss(&at).unwrap().value(1)
        };
        let edition = sliding(None, 0.0);
        close(sliding(None, 0.06) / edition, 0.5);
        close(sliding(Some(0.18), 0.06) / edition, 1.5);
    }

    #[test]
    fn a_vanishing_axial_load_stays_a_number() {
        let part = part();
        let model = DeepGroove::new(&params(), &part).unwrap();
        for fa in [f64::from_bits(1), 1e-300, 1e-30, 1e-9] {
            assert!(model.loss(&at(&part, 0.0, fa, 10.0)).unwrap().is_sound(), "{fa}");
            assert!(model.loss(&at(&part, 3000.0, fa, 10.0)).unwrap().is_sound(), "{fa}");
        }
    }
}
