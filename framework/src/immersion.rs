//! How deep parts dip into the oil.

use std::f64::consts::PI;

/// Depth of a circle's lowest point below the oil, for a height of the oil above its axis. \[m\]
pub fn dip(level: f64, radius: f64) -> f64 {
    (level + radius).clamp(0.0, 2.0 * radius)
}

/// Mean dip of a circle whose axis orbits, for a height of the oil above the centre of the orbit. \[m\]
pub fn orbiting_dip(level: f64, radius: f64, orbit: f64) -> f64 {
    let mean = |q: f64| {
        if q >= orbit {
            q
        } else if q <= -orbit {
            0.0
        } else {
            let angle = (q / orbit).acos();
            (q * (PI - angle) + orbit * angle.sin()) / PI
        }
    };
    mean(level + radius) - mean(level - radius)
}

/// Share of its orbit in which a circle touches the oil.
pub fn wet_share(level: f64, radius: f64, orbit: f64) -> f64 {
    1.0 - ((level + radius) / orbit).clamp(-1.0, 1.0).acos() / PI
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
        for (level, depth, share) in [
            (-80.0, 0.0, 0.0),
            (-49.0, 5.56903813, 0.340938945),
            (-20.0, 18.2756224, 0.539893088),
            (0.0, 26.0, 0.682206491),
            (30.0, 38.6680431, 1.0),
            (80.0, 52.0, 1.0),
        ] {
            close(orbiting_dip(level, 26.0, 48.0), depth);
            close(wet_share(level, 26.0, 48.0), share);
        }
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
