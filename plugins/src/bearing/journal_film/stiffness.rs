//! Stiffness of the film of a plain bearing: the change of its force with small displacements of the shaft at constant speed and viscosity.
//!
//! Derived. The film pushes the shaft back along the line of centres with F cos(beta) and across it with F sin(beta), which depend on the
//! eccentricity e only. A displacement along the line of centres changes both, one across it turns them, so that along and across it
//! K = [d(F cos beta)/de, F sin(beta)/e; -d(F sin beta)/de, F cos(beta)/e]. Turned to the direction of the load and the one across it, in which the
//! shaft is displaced, this is the usual matrix. It is not symmetric: a film pushes also across.

use gearloss_framework::real::Real;

/// A film under a load.
#[derive(Debug, Clone, Copy)]
pub struct Loaded<R> {
    /// Load. \[N\]
    pub force: R,
    /// Its derivative over the eccentricity. \[N/m\]
    pub slope: R,
    /// Eccentricity. \[m\]
    pub eccentricity: R,
    /// Sine of the attitude angle.
    pub sine: R,
    /// Derivative of that angle over the eccentricity. \[1/m\]
    pub turning: R,
}

impl<R: Real> Loaded<R> {
    fn cosine(&self) -> R {
        (R::constant(1.0) - self.sine * self.sine).at_least(0.0).sqrt()
    }

    /// The matrix: along the load by a displacement along it and across it, then across the load by the same. Across is where the shaft is
    /// displaced. \[N/m\]
    pub fn matrix(&self) -> [[R; 2]; 2] {
        let (s, c) = (self.sine, self.cosine());
        let turned = self.force * self.turning;
        // Along the line of centres and across it.
        let [nn, nt] = [self.slope * c - turned * s, self.force * s / self.eccentricity];
        let [tn, tt] = [-(self.slope * s + turned * c), self.force * c / self.eccentricity];
        [
            [
                c * c * nn - c * s * (nt + tn) + s * s * tt,
                c * s * (nn - tt) + c * c * nt - s * s * tn,
            ],
            [
                c * s * (nn - tt) - s * s * nt + c * c * tn,
                s * s * nn + c * s * (nt + tn) + c * c * tt,
            ],
        ]
    }

    /// The load over the displacement that it causes in its direction, as `radial_stiffness` of a bearing means it. \[N/m\]
    pub fn in_operation(&self) -> R {
        self.force / (self.eccentricity * self.cosine())
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use gearloss_framework::testing::assert_close;

    use super::*;

    /// A very narrow bearing after Ocvirk, with clearance and force of one: F = e/(1 - e^2)^2 sqrt(pi^2 (1 - e^2) + 16 e^2),
    /// tan(beta) = pi sqrt(1 - e^2)/(4 e).
    fn narrow(e: f64) -> (f64, f64) {
        let room = 1.0 - e * e;
        let force = e / (room * room) * (PI * PI * room + 16.0 * e * e).sqrt();
        (force, (PI * room.sqrt() / (4.0 * e)).atan())
    }

    fn loaded(e: f64) -> Loaded<f64> {
        let step = 1e-6;
        let [(below, left), (force, angle), (above, right)] = [-step, 0.0, step].map(|step| narrow(e + step));
        Loaded {
            force,
            slope: (above - below) / (2.0 * step),
            eccentricity: e,
            sine: angle.sin(),
            turning: (right - left) / (2.0 * step),
        }
    }

    /// The published coefficients of very narrow bearings, over F/c.
    #[test]
    fn a_very_narrow_bearing_has_the_published_coefficients() {
        for e in [0.1, 0.3, 0.5, 0.7, 0.9] {
            let (square, rest) = (e * e, 16.0 - PI * PI);
            let q = (PI * PI + rest * square).powf(-1.5);
            let room = 1.0 - square;
            let last = PI * PI + (32.0 + PI * PI) * square + 2.0 * rest * square * square;
            let along = 4.0 * (2.0 * PI * PI + rest * square) * q;
            let across = 4.0 * last / room * q;
            let to_across = PI * (PI * PI - 2.0 * PI * PI * square - rest * square * square) / (e * room.sqrt()) * q;
            let from_across = -PI * last / (e * room.sqrt()) * q;
            let film = loaded(e);
            let [[xx, xy], [yx, yy]] = film.matrix().map(|row| row.map(|k| k / film.force));
            // Books count the directions from across the load, and across against the rotation.
            assert_close(xx, across, 1e-7);
            assert_close(yy, along, 1e-7);
            assert_close(xy, -from_across, 1e-7);
            assert_close(yx, -to_across, 1e-7);
        }
    }

    /// A small further load displaces the shaft as the matrix says.
    #[test]
    fn it_is_the_slope_of_the_equilibrium() {
        for e in [0.2, 0.6, 0.85] {
            let film = loaded(e);
            let [[xx, xy], [yx, yy]] = film.matrix();
            // The shaft at another eccentricity and angle is in equilibrium with a load of another size and direction.
            let (force, angle) = narrow(e);
            let at = |e: f64, turned: f64| {
                let (force, own) = narrow(e);
                // The load is turned; the shaft lies at the angle to it.
                let load = [force * turned.cos(), force * turned.sin()];
                let shaft = [e * (own + turned).cos(), e * (own + turned).sin()];
                (load, shaft)
            };
            for (de, turn) in [(1e-5, 0.0), (0.0, 1e-5), (1e-5, -2e-5)] {
                let (load, shaft) = at(e + de, turn);
                let (before, origin) = at(e - de, -turn);
                let change = [shaft[0] - origin[0], shaft[1] - origin[1]];
                let scale = force * 1e-5;
                let pushed = [xx * change[0] + xy * change[1], yx * change[0] + yy * change[1]];
                for i in 0..2 {
                    let wanted = load[i] - before[i];
                    assert!(
                        (pushed[i] - wanted).abs() < 1e-4 * scale,
                        "{e} {angle}: {pushed:?}, {load:?}"
                    );
                }
            }
        }
    }
}
