//! Palmgren's form, shared by four models: M = M0 + M1 + M2, N mm.
//!
//! M0 = 1e-7 f0 (nu n)^(2/3) dm^3 from nu n = 2000, 160e-7 f0 dm^3 below (the published step of 0.8 % is retained); M1 = f1 P1^a
//! dm^b with f1 = z (P0/C0)^y; M2 = f2 Fa dm for axially loaded cylindrical roller bearings.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::bearing::{Bearing, BearingAt, BearingKind, BearingLaw, BearingPart};
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::registry::Build;
use gearloss_framework::{coefficients, limits, observed, terms};

use super::rows::{Lack, LoadLaw, sliding};

terms! {
    pub LOAD = load("load");
    pub NO_LOAD = no_load("no_load");
}
limits! {
    pub AXIAL_RATIO = ("Fa/Fr", "axial load over radial load", "-", 0.0, 0.5, "axial load on cylindrical rollers, SKF 1994");
    pub RADIAL_RATIO = ("Fr/Fa", "radial load over axial load", "-", 0.0, 0.55, "radial load on spherical roller thrust bearings, SKF 1994");
}
observed! { pub P1 = ("P1", "N", "equivalent load of the load-dependent moment"); }

coefficients! {
    /// Constants of the load-independent moment M0 in N mm, from mm2/s, 1/min and mm.
    pub struct Constants {
        /// Factor of f0 (nu n)^(2/3) d_m^3 in the viscous regime.
        viscous_factor = 1e-7, in 0.5e-7..=2e-7;
        /// Exponent of viscosity times speed in the viscous regime.
        viscous_exponent = 2.0 / 3.0, in 0.5..=1.0;
        /// Factor of f0 d_m^3 at low viscosity times speed.
        constant_factor = 160e-7, in 80e-7..=320e-7;
        /// Viscosity times speed at which the viscous regime starts.
        viscous_from = 2000.0, in 1000.0..=4000.0;
    }
}

/// Factor of the load-independent moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum F0 {
    Fixed(f64),
    /// From no immersion to full immersion, linear in the oil height; heights in m.
    Dip {
        /// No rolling element immersed.
        least: f64,
        /// Fully immersed.
        most: f64,
        /// Oil height of full immersion. \[m\]
        covered: f64,
    },
}

/// One bearing, prepared.
#[derive(Debug)]
pub struct Palmgren {
    pub coefficients: Constants,
    pub f0: F0,
    pub f2: f64,
    pub law: LoadLaw,
    c0: f64,
    /// Factor of the churning of grease on the load-independent moment.
    churning: f64,
    /// Mean diameter. \[mm\]
    d_m: f64,
    /// d_m^3.
    cube: f64,
    /// d_m to the power b of the load law.
    d_m_b: f64,
    /// True for rollers that carry axial load on flanges.
    flanged: bool,
    spherical_thrust: bool,
}

impl Palmgren {
    /// A bearing with its factors.
    ///
    /// # Errors
    /// If a rating that the load law needs is missing.
    pub fn new(part: &BearingPart, f0: F0, law: LoadLaw, f2: f64, coefficients: Constants) -> Result<Self, Lack> {
        let c0 = match part.c0 {
            Some(c0) => c0,
            // A constant f1 does not need it.
            None if law.exponent == 0.0 => 1.0,
            None => {
                let help = "add `c0:`, or a `designation` of a catalogue";
                return Err(("a ball bearing needs `c0`".to_owned(), help.to_owned()));
            }
        };
        let d_m = part.mean_diameter().mm();
        Ok(Self {
            coefficients,
            f0,
            f2,
            law,
            c0,
            churning: part.churning(),
            d_m,
            cube: d_m.powi(3),
            d_m_b: d_m.powf(law.b),
            flanged: flanged(part),
            spherical_thrust: part.kind == BearingKind::SphericalRollerThrust,
        })
    }
}

/// Prepares a model of the bearing that it belongs to.
pub fn of_part(
    cx: &Build<'_>,
    model: impl FnOnce(&BearingPart) -> Result<Palmgren, Lack>,
) -> Result<Palmgren, Diagnostic> {
    let part = cx.own_part::<Bearing>()?;
    let model = if part.kind.rolls() {
        model(part)
    } else {
        Err(sliding(part))
    };
    model.map_err(|(message, help)| cx.error(message).help(help))
}

/// True for rollers that carry axial load on flanges.
pub fn flanged(part: &BearingPart) -> bool {
    matches!(
        part.kind,
        BearingKind::CylindricalRoller | BearingKind::CylindricalRollerFullComplement
    )
}

/// Ratio of two loads; infinite if the second is zero.
#[inline(always)]
fn ratio<R: Real>(load: R, other: R) -> R {
    let limit = R::select(load.is_above(R::ZERO), R::constant(f64::INFINITY), R::ZERO);
    R::select(other.is_above(R::ZERO), load / other, limit)
}

impl Palmgren {
    /// f1 from P0. \[-\]
    #[inline(always)]
    fn f1<R: Real>(&self, p0: R) -> R {
        if self.law.exponent == 0.0 {
            R::constant(self.law.z)
        } else {
            (p0 / self.c0).power(self.law.exponent) * self.law.z
        }
    }

    /// P1 to its power. \[N^a\]
    #[inline(always)]
    fn power<R: Real>(&self, p1: R) -> R {
        if self.law.a == 1.0 { p1 } else { p1.power(self.law.a) }
    }

    /// The load-independent moment. \[N mm\]
    #[inline(always)]
    fn no_load<R: Real>(&self, at: &BearingAt<'_, R>) -> R {
        let f0 = match self.f0 {
            F0::Fixed(f0) => R::constant(f0),
            F0::Dip { least, most, covered } => {
                let dip = at.show("dip", "-", (at.oil_height / covered).at_least(0.0).at_most(1.0));
                dip * (most - least) + least
            }
        };
        let product = at.show("nu n", "mm2/s 1/min", at.nu.mm2_s() * at.speed.abs().rpm());
        let c = &self.coefficients;
        let published = c.viscous_from == Constants::PUBLISHED.viscous_from;
        let constant = product.is_below(R::constant(c.viscous_from));
        at.branch(match (constant.all(), published) {
            (false, true) => "nu n at least 2000: viscous",
            (false, false) => "nu n at least the changed limit: viscous",
            (true, true) => "nu n below 2000: constant",
            (true, false) => "nu n below the changed limit: constant",
        });
        let power = if c.viscous_exponent == 2.0 / 3.0 {
            let root = product.cbrt();
            root * root
        } else {
            product.power(c.viscous_exponent)
        };
        let viscous = f0 * c.viscous_factor * self.cube * power;
        let m0 = R::select(constant, f0 * c.constant_factor * self.cube, viscous) * self.churning;
        at.show("f0", "-", f0);
        if self.churning != 1.0 {
            at.branch("grease churns: its factor is in M0");
        }
        at.show("M0", "N mm", m0)
    }
}

impl BearingLaw for Palmgren {
    #[inline(always)]
    fn loss<R: Real>(&self, at: &BearingAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let (fr, fa) = (at.show("Fr", "N", at.radial), at.show("Fa", "N", at.axial));
        let (p0, p1) = self.law.rule.equivalent(fr, fa);
        if self.law.exponent != 0.0 {
            at.show("P0", "N", p0);
        }
        let f1 = at.show("f1", "-", self.f1(p0));
        let p1 = at.observe(&P1, p1);
        if self.spherical_thrust {
            at.check(&RADIAL_RATIO, ratio(fr, fa));
        }
        let [m0] = at.once(
            #[inline(always)]
            || [self.no_load(at)],
        );
        let mut load = at.show("M1", "N mm", f1 * self.power(p1) * self.d_m_b);
        if self.flanged && fa.is_above(R::ZERO).agreed()? {
            at.check(&AXIAL_RATIO, ratio(fa, fr));
            load += at.show("M2", "N mm", fa * self.f2 * self.d_m);
        }
        Ok(Loss::MOMENTS
            .with(&LOAD, load.nmm_in_nm())
            .with(&NO_LOAD, m0.nmm_in_nm()))
    }
}
