//! Losses by mechanism at the measured points, with bands due to the parameters.

use super::fit::JUMPS;
use super::{Fitted, Identification};
use crate::distinct::distinct;
use gearloss_framework::transmission::{PartInfo, Transmission};
use gearloss_numerics::inference::{Breakdown, Derived, ProfileInterval, Reach, Standing, hull};
use gearloss_numerics::sensitivity::gradients;

/// Half-width of a 95 % band in standard deviations.
const DEVIATIONS: f64 = 1.959_963_985;

/// Losses by mechanism at some rows.
#[derive(Debug, Clone, Default)]
pub struct ShareBands {
    /// The mechanisms.
    pub mechanisms: Vec<&'static str>,
    /// For each of the rows the losses of the mechanisms, their sum and their shares.
    pub rows: Vec<Breakdown>,
    /// For each row the 95 % bands of the losses of the mechanisms and, last, of their sum, widened for parameters at a bound. \[W\]
    pub bands: Vec<Vec<Option<[f64; 2]>>>,
}

/// Mechanism of each component; none if its model is `none` in all transmissions.
fn places(t: &Transmission, mechanisms: &[&'static str]) -> Vec<Option<usize>> {
    let place = |mechanism: &str| mechanisms.iter().position(|m| *m == mechanism);
    t.parts().iter().map(|part| place(part.mechanism)).collect()
}

impl Identification<'_> {
    /// Losses by mechanism at some rows, with standard deviations from the covariance of all parameters.
    ///
    /// # Errors
    /// If a neighbour of the optimum has no value.
    pub fn share_bands(
        &self,
        fitted: &Fitted,
        rows: &[usize],
        profiles: &[Option<Result<ProfileInterval, String>>],
    ) -> Result<ShareBands, String> {
        if rows.is_empty() {
            return Ok(ShareBands::default());
        }
        let at_optimum = self.calculate(fitted.theta())?;
        let with_loss = at_optimum.solved.transmissions.iter().flat_map(|t| {
            let has_loss = |part: &&PartInfo| t.instances()[part.notes.instance()].entry.name != "none";
            t.parts().iter().filter(has_loss).map(|part| part.mechanism)
        });
        let mechanisms: Vec<&'static str> = distinct(with_loss);
        let width = mechanisms.len();
        let losses = |calculated: &super::Calculated| -> Vec<f64> {
            let mut all = Vec::with_capacity(rows.len() * width);
            for row in rows {
                let (number, _, point) = &calculated.solved.rows[*row];
                let places = places(&calculated.solved.transmissions[*number], &mechanisms);
                let mut sums = vec![0.0; width];
                for (place, watts) in places.iter().zip(&point.parts) {
                    if let Some(place) = place {
                        sums[*place] += watts;
                    }
                }
                all.extend(sums);
            }
            all
        };
        let values = losses(&at_optimum);
        let outputs = |theta: &[f64]| self.calculate(theta).map(|c| losses(&c));
        let slopes = gradients(fitted.inference.parameters(), JUMPS, outputs)?;
        let breakdown = |i: usize| {
            let places = i * width..(i + 1) * width;
            fitted.inference.breakdown(&values[places.clone()], &slopes[places])
        };
        let breakdowns: Vec<Breakdown> = (0..rows.len()).map(breakdown).collect::<Result<_, _>>()?;
        let mut bands: Vec<Vec<Option<[f64; 2]>>> = breakdowns
            .iter()
            .map(|b| b.parts.iter().chain([&b.total]).map(|d| d.band(DEVIATIONS)).collect())
            .collect();
        for theta in self.far_ends(fitted, profiles)? {
            let moved = outputs(&theta)?;
            for (i, bands) in bands.iter_mut().enumerate() {
                let shares = &moved[i * width..(i + 1) * width];
                let sum: f64 = shares.iter().sum();
                for (band, value) in bands.iter_mut().zip(shares.iter().chain([&sum])) {
                    *band = band.map(|band| hull(band, [*value, *value]));
                }
            }
        }
        Ok(ShareBands {
            mechanisms,
            rows: breakdowns,
            bands,
        })
    }
}

impl Identification<'_> {
    /// Parameters at the other end of the profile interval of each parameter at a bound, which is not part of the covariance.
    pub(super) fn far_ends(
        &self,
        fitted: &Fitted,
        profiles: &[Option<Result<ProfileInterval, String>>],
    ) -> Result<Vec<Vec<f64>>, String> {
        let mut ends = Vec::new();
        for (k, profile) in profiles.iter().enumerate() {
            let active = matches!(fitted.inference.parameters()[k].standing, Standing::Active(_));
            let Some(Ok(interval)) = profile.as_ref().filter(|_| active) else {
                continue;
            };
            let far = interval.ends.iter().find(|end| end.reach == Reach::Limit);
            let Some(far) = far else { continue };
            let from: Vec<f64> = fitted.inference.parameters().iter().map(|p| p.u).collect();
            let there = self.refit(fitted, (k, far.u), &from, &mut None, None)?;
            let parameters = fitted.inference.parameters().iter();
            ends.push(parameters.zip(&there.u).map(|(p, u)| p.scale.theta(*u)).collect());
        }
        Ok(ends)
    }
}

impl ShareBands {
    /// The share of a mechanism at a row with its 95 % band; absent if the loss is zero.
    pub fn share(&self, row: usize, mechanism: usize) -> Option<(Derived, Option<[f64; 2]>)> {
        let share = *self.rows[row].shares.get(mechanism)?;
        Some((share, share.share_band(DEVIATIONS)))
    }
}
