//! Drag of balls in an oil bath or under an oil jet, SKF catalogue.

/// V_M over H/d_m for balls, read from the catalogue's diagram, about 2 %.
const V_M: [(f64, f64); 30] = [
    (0.0, 0.0),
    (0.01, 2.2e-6),
    (0.02, 6.4e-6),
    (0.03, 1.00e-5),
    (0.04, 1.37e-5),
    (0.05, 1.90e-5),
    (0.06, 2.61e-5),
    (0.07, 3.54e-5),
    (0.08, 4.65e-5),
    (0.09, 5.92e-5),
    (0.10, 7.36e-5),
    (0.12, 1.05e-4),
    (0.14, 1.40e-4),
    (0.16, 1.76e-4),
    (0.18, 2.12e-4),
    (0.20, 2.47e-4),
    (0.25, 3.14e-4),
    (0.30, 3.83e-4),
    (0.35, 4.33e-4),
    (0.40, 4.80e-4),
    (0.50, 5.66e-4),
    (0.60, 6.40e-4),
    (0.70, 7.05e-4),
    (0.80, 7.80e-4),
    (0.90, 8.66e-4),
    (1.00, 9.47e-4),
    (1.10, 1.045e-3),
    (1.15, 1.12e-3),
    (1.20, 1.245e-3),
    (f64::INFINITY, 1.245e-3),
];

/// Drag of one bearing, prepared. Lengths in mm.
#[derive(Debug)]
pub(super) struct Drag {
    d_m: f64,
    /// 0.4 K_ball d_m^5.
    churning: f64,
    /// f_A.
    f_a: f64,
    /// Height that a jet counts as; the jet doubles the drag.
    jet: Option<f64>,
}

impl Drag {
    pub fn ball(d: f64, big_d: f64, k_z: f64, rows: f64, jet: Option<f64>) -> Self {
        let d_m = 0.5 * (d + big_d);
        let ratio = k_z * (d + big_d) / (big_d - d);
        Self {
            d_m,
            churning: 0.4 * rows * ratio * 1e-12 * d_m.powi(5),
            f_a: 0.05 * ratio,
            jet,
        }
    }

    /// Moment for a height of the oil in mm, speed in 1/min, viscosity in mm2/s. \[N mm\]
    pub fn moment(&self, height: f64, n: f64, nu: f64) -> f64 {
        match self.jet {
            Some(height) => 2.0 * self.bath(height, n, nu),
            None => self.bath(height, n, nu),
        }
    }

    fn bath(&self, height: f64, n: f64, nu: f64) -> f64 {
        if height <= 0.0 || n == 0.0 {
            return 0.0;
        }
        let height = height.min(1.2 * self.d_m);
        let v_m = v_m(height / self.d_m);
        let t = 2.0 * ((0.6 * self.d_m - height) / (0.6 * self.d_m)).acos();
        let f_t = if t <= std::f64::consts::PI {
            (0.5 * t).sin()
        } else {
            1.0
        };
        let r_s = 0.36 * self.d_m * self.d_m * (t - t.sin()) * self.f_a;
        let churning = v_m * self.churning * n * n;
        if f_t == 0.0 || r_s == 0.0 {
            return churning;
        }
        churning + 1.093e-7 * n * n * self.d_m.powi(3) * (n * self.d_m * self.d_m * f_t / nu).powf(-1.379) * r_s
    }
}

fn v_m(ratio: f64) -> f64 {
    let i = V_M.partition_point(|(x, _)| *x <= ratio).clamp(1, V_M.len() - 1);
    let ((x0, y0), (x1, y1)) = (V_M[i - 1], V_M[i]);
    if x1.is_infinite() {
        y0
    } else {
        y0 + (y1 - y0) * (ratio - x0) / (x1 - x0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a3_1_drag_in_two_parts() {
        let drag = Drag::ball(40.0, 90.0, 3.1, 1.0, None);
        assert!((v_m(10.0 / 65.0) / 1.64923e-4 - 1.0).abs() < 1e-5);
        assert!((drag.f_a / 0.403 - 1.0).abs() < 1e-9);
        assert!((v_m(10.0 / 65.0) * drag.churning * 9e6 / 5.55246 - 1.0).abs() < 1e-5);
        assert!((drag.moment(10.0, 3000.0, 15.0) / 6.46321 - 1.0).abs() < 1e-5);
    }

    #[test]
    fn drag_rises_with_the_level_and_ends_at_a_full_bath() {
        let drag = Drag::ball(40.0, 90.0, 3.1, 1.0, None);
        let mut before = 0.0;
        for height in [1.0, 5.0, 10.0, 30.0, 60.0, 78.0] {
            let now = drag.moment(height, 3000.0, 15.0);
            assert!(now > before);
            before = now;
        }
        assert_eq!(drag.moment(200.0, 3000.0, 15.0), drag.moment(78.0, 3000.0, 15.0));
        assert_eq!(drag.moment(0.0, 3000.0, 15.0), 0.0);
    }
}
