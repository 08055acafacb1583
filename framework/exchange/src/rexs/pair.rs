//! Centre distance and profile shifts of a pair of gears, to check a file against itself. The second gear of an internal pair has
//! negative teeth, as in ISO 21771.

/// Basic data of a pair; angles in rad, lengths in mm.
#[derive(Debug, Clone, Copy)]
pub struct Basic {
    pub z: [f64; 2],
    pub module: f64,
    pub pressure_angle: f64,
    pub helix: f64,
}

impl Basic {
    /// Transverse pressure angle.
    fn transverse(&self) -> f64 {
        (self.pressure_angle.tan() / self.helix.cos()).atan()
    }

    /// Reference centre distance; positive for internal pairs, too.
    fn reference(&self) -> f64 {
        (0.5 * (self.z[0] + self.z[1]) * self.module / self.helix.cos()).abs()
    }
}

fn involute(angle: f64) -> f64 {
    angle.tan() - angle
}

/// The centre distance of a sum of profile shift coefficients without backlash; `None` if there is none.
pub fn distance(pair: &Basic, sum: f64) -> Option<f64> {
    let start = pair.transverse();
    let wanted = involute(start) + 2.0 * sum * pair.pressure_angle.tan() / (pair.z[0] + pair.z[1]);
    let mut angle = start;
    for _ in 0..50 {
        let step = (involute(angle) - wanted) / angle.tan().powi(2);
        angle -= step;
        if !(0.01..1.4).contains(&angle) {
            return None;
        }
        if step.abs() < 1e-14 {
            return Some(pair.reference() * start.cos() / angle.cos());
        }
    }
    None
}

/// The sum of profile shift coefficients that gives a centre distance.
pub fn matching_shift(pair: &Basic, distance: f64) -> Option<f64> {
    let start = pair.transverse();
    let cos = pair.reference() * start.cos() / distance;
    if !(0.1..=1.0).contains(&cos) {
        return None;
    }
    let sum = (involute(cos.acos()) - involute(start)) * (pair.z[0] + pair.z[1]) / (2.0 * pair.pressure_angle.tan());
    sum.is_finite().then_some(sum)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// The stages of the public models, whose files state the centre distance.
    #[test]
    fn centre_distances_of_the_public_models() {
        let stage = |z: [f64; 2], module, helix: f64| Basic {
            z,
            module,
            pressure_angle: 20_f64.to_radians(),
            helix: helix.to_radians(),
        };
        for (pair, sum, expected) in [
            (stage([27.0, 51.0], 4.5, 21.0), 0.46283, 190.0),
            (stage([23.0, 34.0], 6.5, 10.0), 0.30148, 190.0),
            (stage([23.0, 67.0], 1.0, 30.0), 1.0941, 53.0),
            (stage([13.0, 76.0], 1.25, 10.0), 0.427, 57.0),
            (stage([14.0, 87.0], 1.5, 10.0), 0.0545, 77.0),
            (stage([22.0, -61.0], 4.0, 0.0), 0.0, 78.0),
        ] {
            let found = distance(&pair, sum).unwrap();
            assert!((found - expected).abs() < 6e-5, "{found} instead of {expected}");
            assert!((matching_shift(&pair, found).unwrap() - sum).abs() < 1e-9);
        }
        assert_eq!(distance(&stage([22.0, -22.0], 4.0, 0.0), 1.0), None);
    }
}
