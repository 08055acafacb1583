//! A step with sufficient decrease without cone program: along the projected gradient, then towards the minimum on the free face.
//!
//! Its decrease is at least that of the generalised Cauchy point (Conn, Gould and Toint, "Trust-Region Methods", 2000, chapter 12), so that
//! a run also converges with it alone, but more slowly.

use nalgebra::DVector;

use super::model::{Model, Region};

/// A step inside ball and box.
pub(super) fn step(model: &Model<'_>, region: &Region) -> DVector<f64> {
    let mut z = DVector::zeros(model.r.ncols());
    for _ in 0..=z.len() {
        let gradient = model.gradient(&z);
        let mut leg = -gradient;
        for j in 0..leg.len() {
            if outward(region, &z, j, leg[j]) {
                leg[j] = 0.0;
            }
        }
        let bend = (model.r * &leg).norm_squared();
        let flat = leg.norm_squared();
        if flat == 0.0 {
            break;
        }
        // Without curvature the ball or a bound ends the leg.
        let least = if bend > 0.0 { flat / bend } else { f64::INFINITY };
        if walk(region, &mut z, &leg, least).is_none() {
            break;
        }
    }
    let gradient = model.gradient(&z);
    let mut free: Vec<usize> = (0..z.len())
        .filter(|j| !outward(region, &z, *j, -gradient[*j]))
        .collect();
    while let Some(target) = model.minimum(&z, &free) {
        let leg = target - &z;
        let Some(bound) = walk(region, &mut z, &leg, 1.0) else {
            break;
        };
        free.retain(|j| *j != bound);
    }
    z
}

/// Whether a component is at a bound and the step points outwards.
fn outward(region: &Region, z: &DVector<f64>, j: usize, along: f64) -> bool {
    (z[j] <= region.lower[j] && along < 0.0) || (z[j] >= region.upper[j] && along > 0.0)
}

/// Moves along a leg by `least` of its lengths, or to a bound, or to the ball. Returns the bound that ended it.
fn walk(region: &Region, z: &mut DVector<f64>, leg: &DVector<f64>, least: f64) -> Option<usize> {
    let mut bound = None;
    let mut length = least;
    for j in 0..z.len() {
        let room = match leg[j] {
            d if d > 0.0 => (region.upper[j] - z[j]) / d,
            d if d < 0.0 => (region.lower[j] - z[j]) / d,
            _ => continue,
        };
        if room < length {
            length = room;
            bound = Some(j);
        }
    }
    let ball = to_ball(z, leg, region.radius);
    if ball <= length {
        length = ball;
        bound = None;
    }
    if length.is_finite() {
        *z += leg * length;
    }
    region.clip(z);
    if let Some(j) = bound {
        z[j] = if leg[j] > 0.0 { region.upper[j] } else { region.lower[j] };
    }
    bound
}

/// Length along a leg from a point inside the ball to its surface.
fn to_ball(z: &DVector<f64>, leg: &DVector<f64>, radius: f64) -> f64 {
    let (a, b) = (leg.norm_squared(), z.dot(leg));
    let c = (radius * radius - z.norm_squared()).max(0.0);
    if a == 0.0 {
        return f64::INFINITY;
    }
    let root = (b * b + a * c).sqrt();
    // The form of the larger root without cancellation.
    if b > 0.0 { c / (b + root) } else { (root - b) / a }
}
