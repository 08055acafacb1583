//! Drag of rolling elements in an oil bath or under an oil jet, SKF catalogue, including the simpler form of its 2004 edition.

use gearloss_framework::loss::Undefined;
use gearloss_framework::real::{Mask as _, Real};

use super::Constants;

/// V_M over H/d_m for balls, read from the catalogue's diagram to about 2 %.
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

/// V_M over H/d_m for rollers, read from the same diagram to about 2 %, 5 to 10 % near 0.2.
const V_M_ROLLERS: [(f64, f64); 30] = [
    (0.0, 0.0),
    (0.01, 5.600e-06),
    (0.02, 1.260e-05),
    (0.03, 2.040e-05),
    (0.04, 2.930e-05),
    (0.05, 4.000e-05),
    (0.06, 5.210e-05),
    (0.07, 6.620e-05),
    (0.08, 8.150e-05),
    (0.09, 9.870e-05),
    (0.10, 1.164e-04),
    (0.12, 1.580e-04),
    (0.14, 2.050e-04),
    (0.16, 2.540e-04),
    (0.18, 3.020e-04),
    (0.20, 3.300e-04),
    (0.25, 3.880e-04),
    (0.30, 4.520e-04),
    (0.35, 5.120e-04),
    (0.40, 5.700e-04),
    (0.50, 6.830e-04),
    (0.60, 7.840e-04),
    (0.70, 8.860e-04),
    (0.80, 9.820e-04),
    (0.90, 1.090e-03),
    (1.00, 1.190e-03),
    (1.10, 1.310e-03),
    (1.15, 1.374e-03),
    (1.20, 1.440e-03),
    (f64::INFINITY, 1.44e-3),
];

/// The bearing data for the drag; lengths in mm.
pub struct Body {
    pub d: f64,
    pub big_d: f64,
    pub k_z: f64,
    /// K_L and width of rollers; `None` for balls.
    pub roller: Option<(f64, f64)>,
    /// Rows of balls.
    pub rows: f64,
}

/// How the oil height enters.
#[derive(Debug, Clone, Copy)]
pub enum Bath {
    /// The actual height.
    Level,
    /// A jet: a fixed height in mm, and twice the drag.
    Jet(f64),
    /// A vertical shaft: full immersion, times the immersed share of the width.
    Vertical(f64),
}

/// Depth of a bath, which selects the stated viscosity range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Depth {
    /// No bath.
    None,
    /// Up to half of the outside diameter.
    Low,
    /// Above it.
    Deep,
}

/// Drag of one bearing, prepared. Lengths in mm.
#[derive(Debug)]
pub struct Drag {
    coefficients: Constants,
    d_m: f64,
    /// Drag per V_M and squared speed.
    churning: f64,
    /// f_A.
    f_a: f64,
    bath: Bath,
    rollers: bool,
    /// V_M of the 2004 edition, whose form has no other term.
    v_m: Option<f64>,
}

impl Drag {
    /// The drag of a body. `v_m` selects the edition of 2004, whose diagram is not public.
    pub fn new(body: &Body, bath: Bath, v_m: Option<f64>, coefficients: &Constants) -> Self {
        let d_m = 0.5 * (body.d + body.big_d);
        let ratio = body.k_z * (body.d + body.big_d) / (body.big_d - body.d);
        let churning = match body.roller {
            None => {
                let front = if v_m.is_some() { 1.0 } else { 0.4 };
                front * body.rows * ratio * 1e-12 * d_m.powi(5)
            }
            Some((k_l, width)) => {
                let l_d = 5.0 * k_l * width / d_m;
                let c_w = ((2.789e-10 * l_d - 2.786e-4) * l_d + 0.0195) * l_d + 0.6439;
                let front = if v_m.is_some() { 10.0 } else { 4.0 * c_w };
                front * k_l * ratio * 1e-12 * width * d_m.powi(4)
            }
        };
        Self {
            coefficients: *coefficients,
            d_m,
            churning,
            f_a: 0.05 * ratio,
            bath,
            rollers: body.roller.is_some(),
            v_m,
        }
    }

    /// Depth class of an oil height; deep is above half of the outside diameter.
    ///
    /// # Errors
    /// If several points disagree.
    #[inline(always)]
    pub fn depth<R: Real>(&self, height: R, half: f64) -> Result<Depth, Undefined> {
        Ok(match self.bath {
            Bath::Level if height.is_above(R::constant(half)).agreed()? => Depth::Deep,
            Bath::Level if height.is_above(R::ZERO).agreed()? => Depth::Low,
            Bath::Vertical(_) => Depth::Deep,
            Bath::Level | Bath::Jet(_) => Depth::None,
        })
    }

    /// Moment at an oil height in mm, speed in 1/min, viscosity in mm2/s. \[N mm\]
    #[inline(always)]
    pub fn moment<R: Real>(&self, height: R, n: R, nu: R) -> R {
        match self.bath {
            Bath::Level => self.moment_at_height(height, n, nu),
            Bath::Jet(height) => self.moment_at_height(R::constant(height), n, nu) * 2.0,
            Bath::Vertical(share) => self.moment_at_height(R::constant(1.2 * self.d_m), n, nu) * share,
        }
    }

    #[inline(always)]
    fn moment_at_height<R: Real>(&self, height: R, n: R, nu: R) -> R {
        let dry = !height.is_above(R::ZERO) | n.is_zero();
        if let Some(v_m) = self.v_m {
            return R::select(dry, R::ZERO, n * n * (v_m * self.churning));
        }
        let table = if self.rollers { &V_M_ROLLERS } else { &V_M };
        let height = height.at_most(1.2 * self.d_m);
        let churning = n * n * self.churning * height.lift(|height| v_m(table, height / self.d_m));
        let t = height.lift(|height| self.angle(height));
        let f_t = t.lift(|t| {
            if t <= std::f64::consts::PI {
                (0.5 * t).sin()
            } else {
                1.0
            }
        });
        let r_s = t.lift(|t| 0.36 * self.d_m * self.d_m * (t - t.sin()) * self.f_a);
        let c = &self.coefficients;
        let resistance = (n * (self.d_m * self.d_m) * f_t / nu).power(c.bath_exponent);
        let resistance = n * n * (c.bath_factor * self.d_m.powi(3)) * resistance * r_s;
        let both = R::select(f_t.is_zero() | r_s.is_zero(), churning, churning + resistance);
        R::select(dry, R::ZERO, both)
    }

    /// Angle of immersion t at an oil height in mm. \[rad\]
    fn angle(&self, height: f64) -> f64 {
        2.0 * ((0.6 * self.d_m - height) / (0.6 * self.d_m)).clamp(-1.0, 1.0).acos()
    }
}

fn v_m(table: &[(f64, f64)], ratio: f64) -> f64 {
    let i = table.partition_point(|(x, _)| *x <= ratio).clamp(1, table.len() - 1);
    let ((x0, y0), (x1, y1)) = (table[i - 1], table[i]);
    if x1.is_infinite() {
        y0
    } else {
        y0 + (y1 - y0) * (ratio - x0) / (x1 - x0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BALL: Body = Body {
        d: 40.0,
        big_d: 90.0,
        k_z: 3.1,
        roller: None,
        rows: 1.0,
    };

    fn close(value: f64, printed: f64) {
        assert!((value / printed - 1.0).abs() < 1e-5, "{value} against {printed}");
    }

    #[test]
    fn a3_1_drag_in_two_parts() {
        let drag = Drag::new(&BALL, Bath::Level, None, &Constants::PUBLISHED);
        close(v_m(&V_M, 10.0 / 65.0), 1.64923e-4);
        close(drag.f_a, 0.403);
        close(v_m(&V_M, 10.0 / 65.0) * drag.churning * 9e6, 5.55246);
    }

    #[test]
    fn a3_3_drag_variable_of_rollers() {
        close(v_m(&V_M_ROLLERS, 8.0 / 60.0), 1.89333e-4);
    }

    #[test]
    fn a_vertical_shaft_has_the_share_of_its_immersed_width() {
        let whole = Drag::new(&BALL, Bath::Level, None, &Constants::PUBLISHED).moment(78.0, 3000.0, 15.0);
        close(
            Drag::new(&BALL, Bath::Vertical(0.5), None, &Constants::PUBLISHED).moment(0.0, 3000.0, 15.0),
            0.5 * whole,
        );
    }

    #[test]
    fn the_angle_of_immersion_ends_at_both_ends_of_the_height() {
        let drag = Drag::new(&BALL, Bath::Level, None, &Constants::PUBLISHED);
        let full = 1.2 * drag.d_m;
        assert_eq!((drag.angle(-1e-9), drag.angle(0.0)), (0.0, 0.0));
        assert_eq!(drag.angle(full * (1.0 + 1e-9)), 2.0 * std::f64::consts::PI);
    }

    #[test]
    fn drag_rises_with_the_level_and_ends_at_a_full_bath() {
        let drag = Drag::new(&BALL, Bath::Level, None, &Constants::PUBLISHED);
        let mut before = 0.0;
        for height in [1.0, 5.0, 10.0, 30.0, 60.0, 78.0] {
            let now = drag.moment(height, 3000.0, 15.0);
            assert!(now > before);
            before = now;
        }
        assert_eq!(drag.moment(200.0, 3000.0, 15.0), drag.moment(78.0, 3000.0, 15.0));
        assert_eq!(drag.moment(0.0, 3000.0, 15.0), 0.0);
    }

    #[test]
    fn every_value_of_v_m_is_that_of_the_diagram() {
        let table = crate::printed::Printed::read(include_str!("../../../tests/tables/skf_v_m.csv"));
        // The last row of the code extends beyond the diagram.
        assert_eq!(table.rows().count(), V_M.len() - 1);
        for (line, (ball, roller)) in table.rows().zip(V_M.iter().zip(V_M_ROLLERS)) {
            for (column, constants) in [("ball", *ball), ("roller", roller)] {
                line.is("H/d_m", constants.0);
                line.is(column, constants.1);
            }
        }
        // Constant from there on.
        assert_eq!((v_m(&V_M, 5.0), v_m(&V_M_ROLLERS, 5.0)), (1.245e-3, 1.44e-3));
    }
}
