//! Bearings and operating points of the check values of models in Palmgren's form.
#![allow(clippy::unwrap_used)]

use gearloss_framework::loss::Notes;
use gearloss_framework::mechanism::bearing::{BearingAt, BearingEntry, BearingKind, BearingModel, BearingPart};

use super::palmgren::Palmgren;

/// Speed in 1/min, viscosity in mm2/s, radial and axial load in N.
pub const RIG: [f64; 4] = [3000.0, 15.0, 3000.0, 1000.0];

/// A bearing of a series with bore and outside diameter in mm.
pub fn part(kind: BearingKind, series: &str, d: f64, big_d: f64, c0: Option<f64>) -> BearingPart {
    let entry = BearingEntry {
        kind: Some(kind),
        series: Some(series.to_owned()),
        bore: Some(d * 1e-3),
        outside: Some(big_d * 1e-3),
        c0,
        ..BearingEntry::default()
    };
    BearingPart::try_from(entry).unwrap()
}

/// Load-dependent and load-independent moment, as at the [`RIG`], at an oil height in m. \[Nmm\]
pub fn moments(model: &Palmgren, part: &BearingPart, [n, nu, fr, fa]: [f64; 4], height: f64) -> [f64; 2] {
    let at = BearingAt::usual(part, Notes::MUTED).with(|to| {
        to.speed = n * std::f64::consts::PI / 30.0;
        to.nu = nu * 1e-6;
        to.radial = fr;
        to.axial = fa;
        to.oil_height = height;
    });
    let loss = model.loss(&at).unwrap();
    [loss.value(0) * 1e3, loss.value(1) * 1e3]
}
