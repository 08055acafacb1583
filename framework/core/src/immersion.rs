//! Immersion depth of parts in the oil.

use std::f64::consts::PI;

use crate::real::Real;

/// Oil height above a stationary or orbiting axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Height<R = f64> {
    /// Above the axis, or above the centre of its orbit; minus infinity if it is dry. \[m\]
    pub level: R,
    /// Radius of the orbit; zero for a stationary axis. \[m\]
    pub orbit: f64,
}

impl<R: Real> Height<R> {
    /// Immersion depth of a circle's lowest point, averaged over the orbit. \[m\]
    #[inline]
    pub fn dip(self, radius: f64) -> R {
        self.level.lift(|level| {
            if self.orbit > 0.0 {
                orbiting_dip(level, radius, self.orbit)
            } else {
                dip(level, radius)
            }
        })
    }

    /// Oil height over the lowest point of a circle, zero if it is above the oil, averaged over the orbit. \[m\]
    #[inline]
    pub(crate) fn over_bottom(self, radius: f64) -> R {
        self.level.lift(|level| {
            if self.orbit > 0.0 {
                mean_height(level + radius, self.orbit)
            } else {
                (level + radius).max(0.0)
            }
        })
    }
}

/// Immersion depth of a circle's lowest point, for an oil height above its axis. \[m\]
pub fn dip(level: f64, radius: f64) -> f64 {
    (level + radius).clamp(0.0, 2.0 * radius)
}

/// Mean immersion depth of a circle with an orbiting axis, for an oil height above the centre of the orbit. \[m\]
pub fn orbiting_dip(level: f64, radius: f64, orbit: f64) -> f64 {
    // Without a sump both heights are minus infinity, and the means are zero.
    mean_height(level + radius, orbit) - mean_height(level - radius, orbit)
}

/// Mean over an orbit of the oil height above a point that is `height` below it at the centre of the orbit; zero where the point is
/// above the oil. \[m\]
fn mean_height(height: f64, orbit: f64) -> f64 {
    if height >= orbit {
        height
    } else if height <= -orbit {
        0.0
    } else {
        let angle = (height / orbit).acos();
        (height * (PI - angle) + orbit * angle.sin()) / PI
    }
}

/// The upward direction of a housing turned by road grade about y and by bank about x. \[rad\]
pub fn upward(grade: f64, bank: f64) -> [f64; 3] {
    [grade.sin(), grade.cos() * bank.sin(), grade.cos() * bank.cos()]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, printed: f64) {
        assert!(
            (value - printed).abs() < 1e-7 * printed.abs().max(1.0),
            "{value} against {printed}"
        );
    }

    #[test]
    fn o1_dips_of_the_two_speed_example() {
        assert_eq!(dip(-118.0, 58.8), 0.0);
        for (level, diameter, depth) in [
            (-49.0, 188.4952, 45.2476),
            (-49.0, 184.7660, 43.3830),
            (-49.0, 176.5726, 39.2863),
            (-49.0, 172.3893, 37.19465),
        ] {
            close(dip(level, 0.5 * diameter), depth);
        }
        assert_eq!(dip(500.0, 10.0), 20.0);
        assert_eq!(dip(f64::NEG_INFINITY, 10.0), 0.0);
    }

    #[test]
    fn o2_bearing_height_and_dips_at_rest() {
        close(-9.2 + 23.2, 14.0);
        close(dip(-9.2, 0.5 * 188.4952), 85.0476);
        close(dip(-9.2, 0.5 * 176.5726), 79.0863);
    }

    #[test]
    fn o3_planets_on_their_orbit() {
        for (level, depth) in [
            (-80.0, 0.0),
            (-49.0, 5.56903813),
            (-20.0, 18.2756224),
            (0.0, 26.0),
            (30.0, 38.6680431),
            (80.0, 52.0),
        ] {
            close(orbiting_dip(level, 26.0, 48.0), depth);
            close(Height { level, orbit: 48.0 }.dip(26.0), depth);
        }
    }

    #[test]
    fn means_over_the_orbit_are_means_of_many_positions() {
        for level in [-70.0, -30.0, 5.0, 60.0] {
            let height = Height { level, orbit: 48.0 };
            let mean = |f: &dyn Fn(f64) -> f64| {
                let at = |i: usize| f(level - 48.0 * (f64::from(i as u32) * PI / 5000.0).cos());
                (0..10000).map(at).sum::<f64>() / 10000.0
            };
            assert!((height.dip(26.0) - mean(&|l| dip(l, 26.0))).abs() < 1e-4);
            assert!((height.over_bottom(10.0) - mean(&|l| (l + 10.0).max(0.0))).abs() < 1e-4);
        }
        let dry = Height {
            level: f64::NEG_INFINITY,
            orbit: 48.0,
        };
        assert_eq!((dry.dip(26.0), dry.over_bottom(26.0)), (0.0, 0.0));
    }

    #[test]
    fn o4_tilted_housing() {
        let ten = 10.0_f64.to_radians();
        let level =
            |up: [f64; 3], p: [f64; 3]| (-49.0 - (up[0] * p[0] + up[1] * p[1] + up[2] * p[2])) / up[1].hypot(up[2]);
        let (g4, g6, g2) = ([50.0, 0.0, 0.0], [128.0, 0.0, 0.0], [22.0, 92.0, 69.0]);
        let bank = upward(0.0, ten);
        close(level(bank, g4), -49.0);
        close(level(bank, g2), -132.927367);
        let grade = upward(ten, 0.0);
        close(level(grade, g4), -58.5722530);
        close(dip(level(grade, g4), 0.5 * 188.4952), 35.6753470);
        close(level(grade, g6), -72.3257575);
        close(dip(level(grade, g6), 0.5 * 176.5726), 15.9605425);
        close(level(grade, g2), -122.635098);
    }
}
