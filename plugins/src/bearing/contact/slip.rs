//! Sliding in the elliptic contact of a ball in a groove: the surfaces are curved across the direction of rolling, and spin.
//!
//! Sources: the speeds are geometry: with the deformed radius R_d = 2 f D/(2 f + 1), the roll rate w and the spin w_s a point (x along, y across) slides
//! with w (y^2 - y0^2)/(2 R_d) - w_s y along and w_s x across the direction of rolling (Heathcote 1921 for the first part). The lines of pure rolling
//! at y0 follow from traction that sums to zero. Traction is that of Eyring's flow with a limiting stress, with boundary friction by the film ratio.

use std::sync::LazyLock;

use gearloss_framework::real::{LANES, Lane, Points as _, Real};
use gearloss_framework::rolling::Ellipse;

/// Nodes and weights of Gauss for six points between -1 and 1.
const GAUSS: [[f64; 2]; 6] = [
    [-0.932_469_514_203_152, 0.171_324_492_379_170_36],
    [-0.661_209_386_466_264_5, 0.360_761_573_048_138_6],
    [-0.238_619_186_083_196_9, 0.467_913_934_572_691_04],
    [0.238_619_186_083_196_9, 0.467_913_934_572_691_04],
    [0.661_209_386_466_264_5, 0.360_761_573_048_138_6],
    [0.932_469_514_203_152, 0.171_324_492_379_170_36],
];
/// Sine and cosine of the angles of places along half an ellipse, ahead of the long axis: as many as one wide instruction serves together.
static PLACES: LazyLock<[Lane; 2]> = LazyLock::new(|| {
    let angle = |place: usize| std::f64::consts::PI * ((place as f64 + 0.5) / LANES as f64 - 0.5);
    [
        Lane::each(|place| angle(place).sin()),
        Lane::each(|place| angle(place).cos()),
    ]
});
/// Square of y0 over a of Coulomb's friction without spin: the root of t - t^3/3 = 1/3.
const COULOMB: f64 = 0.347_296_355_333_860_7 * 0.347_296_355_333_860_7;
/// Steps towards the lines of pure rolling. The power is stationary there, so that two suffice.
const STEPS: usize = 2;
/// Spin over roll rate below which it is rounding.
const NO_SPIN: f64 = 1e-9;

/// Stress of sliding surfaces at a pressure.
pub trait Traction {
    /// What depends on the pressure only.
    type Pressed: Copy;
    /// At a pressure. \[Pa\]
    fn under(&self, pressure: f64) -> Self::Pressed;
    /// Stress at a sliding speed in m/s; mark it as `#[inline(always)]`, so that it uses wide instructions. \[Pa\]
    fn stress<R: Real>(&self, pressed: Self::Pressed, speed: R) -> R;
}

/// Sliding of one contact.
#[derive(Debug, Clone, Copy)]
pub struct Slip {
    /// The contact.
    pub ellipse: Ellipse,
    /// Deformed radius R_d across the direction of rolling. \[m\]
    pub radius: f64,
    /// Roll rate. \[rad/s\]
    pub rolling: f64,
    /// Spin. \[rad/s\]
    pub spin: f64,
}

impl Slip {
    /// Power of sliding. \[W\]
    pub fn power(&self, traction: &impl Traction) -> f64 {
        let places = *PLACES;
        Lane::wide(
            #[inline(always)]
            || self.power_at(&places, traction),
        )
    }

    #[inline(always)]
    fn power_at(&self, places: &[Lane; 2], traction: &impl Traction) -> f64 {
        let rings = GAUSS.map(|[node, weight]| {
            let r = 0.5 + 0.5 * node;
            let pressure = self.ellipse.pressure * (1.0 - r * r).max(0.0).sqrt();
            (r, weight * r, traction.under(pressure))
        });
        let square = self.ellipse.across * self.ellipse.across;
        let (mut low, mut high) = (0.0, square);
        let mut line = COULOMB * square;
        let mut before: Option<(f64, f64)> = None;
        // Outer contacts do not spin but for rounding, which must not decide the number of steps.
        let is_rolling = self.spin.abs() <= NO_SPIN * self.rolling;
        let steps = if is_rolling { 0 } else { STEPS };
        let mut step = 0;
        loop {
            let [along, power] = self.sums(places, &rings, traction, line);
            if step == steps {
                return power;
            }
            step += 1;
            if along > 0.0 {
                low = line;
            } else {
                high = line;
            }
            let secant = before.map(|(line_before, before)| line - along * (line - line_before) / (along - before));
            let next = secant
                .filter(|next| next.is_finite() && *next > low && *next < high)
                .unwrap_or(0.5 * (low + high));
            before = Some((line, along));
            line = next;
        }
    }

    /// Traction along the direction of rolling and power of sliding, with the square of the lines of pure rolling. \[N, W\]
    #[inline(always)]
    fn sums<T: Traction>(
        &self,
        [sin, cos]: &[Lane; 2],
        rings: &[(f64, f64, T::Pressed); GAUSS.len()],
        traction: &T,
        line: f64,
    ) -> [f64; 2] {
        let (a, b) = (self.ellipse.across, self.ellipse.along);
        let per_square = self.rolling / (2.0 * self.radius);
        let (mut along, mut power) = (Lane::ZERO, Lane::ZERO);
        for (r, weight, pressed) in rings {
            let y = *sin * (a * r);
            let v_x = (y * y - Lane::constant(line)) * per_square - y * self.spin;
            let v_y = *cos * (b * r * self.spin);
            let v = (v_x * v_x + v_y * v_y).sqrt();
            let stress = traction.stress(*pressed, v);
            let share = Lane::select(v.is_above(Lane::ZERO), stress * v_x / v, Lane::ZERO);
            along += share * *weight;
            power += stress * v * *weight;
            Lane::end_pass();
        }
        // Both halves of the ellipse, of the radii from zero to one.
        let area = a * b * std::f64::consts::PI / LANES as f64;
        [along, power].map(|sum| sum.iter().sum::<f64>() * area)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearloss_framework::rolling::{Material, PointContact};
    use gearloss_framework::testing::assert_close;

    /// Coulomb's friction.
    struct Coulomb(f64);

    impl Traction for Coulomb {
        type Pressed = f64;
        fn under(&self, pressure: f64) -> f64 {
            self.0 * pressure
        }
        #[inline(always)]
        fn stress<R: Real>(&self, pressed: f64, _: R) -> R {
            R::constant(pressed)
        }
    }

    /// The inner contact of a 6308 under 1 kN.
    fn slip(rolling: f64, spin: f64) -> Slip {
        let modulus = Material::STEEL.contact_modulus(&Material::STEEL);
        let contact = PointContact::new(5.790_988e-3, 196.053e-3, modulus);
        Slip {
            ellipse: contact.under(1000.0),
            radius: 2.0 * 0.52 * 15.081e-3 / (2.0 * 0.52 + 1.0),
            rolling,
            spin,
        }
    }

    /// Traction along the direction of rolling and power as [`Slip::sums`], on a grid of 384 radii, denser at the edge, and 1024 angles.
    fn fine_sums(slip: &Slip, traction: &Coulomb, line: f64) -> [f64; 2] {
        const PANELS: usize = 64;
        const SHIFTS: usize = 64;
        let mut sums = [0.0; 2];
        for shift in 0..SHIFTS {
            let angle = |place: usize| {
                let place = place as f64 + (shift as f64 + 0.5) / SHIFTS as f64;
                std::f64::consts::PI * (place / LANES as f64 - 0.5)
            };
            let places = [
                Lane::each(|place| angle(place).sin()),
                Lane::each(|place| angle(place).cos()),
            ];
            for panel in 0..PANELS {
                let rings = GAUSS.map(|[node, weight]| {
                    let from_edge = 1.0 - (panel as f64 + 0.5 + 0.5 * node) / PANELS as f64;
                    let r = 1.0 - from_edge * from_edge;
                    let pressure = slip.ellipse.pressure * (1.0 - r * r).sqrt();
                    let weight = weight * r * 2.0 * from_edge / PANELS as f64;
                    (r, weight, traction.under(pressure))
                });
                let own = slip.sums(&places, &rings, traction, line);
                sums = [sums[0] + own[0] / SHIFTS as f64, sums[1] + own[1] / SHIFTS as f64];
            }
        }
        sums
    }

    /// Power on the fine grid, with lines of pure rolling where traction sums to zero.
    fn fine_power(slip: &Slip, traction: &Coulomb) -> f64 {
        let square = slip.ellipse.across * slip.ellipse.across;
        let (mut low, mut high) = (-square, square);
        for _ in 0..24 {
            let middle = 0.5 * (low + high);
            if fine_sums(slip, traction, middle)[0] > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        fine_sums(slip, traction, low)[1]
    }

    /// Heathcote's slip, P = 0.0805711989 mu Q w a^2/R_d, and with spin an independent quadrature (400 by 4000 places); a printed 3.1063 W is 0.17 %
    /// below it. The grid of the model is within two per cent.
    #[test]
    fn powers_of_coulomb() {
        let (friction, heathcote) = (Coulomb(0.05), slip(1000.0, 0.0));
        let per_square = 0.05 * 1000.0 * 1000.0 / heathcote.radius;
        let square = heathcote.ellipse.across * heathcote.ellipse.across;
        assert_close(0.080_571_198_9 * per_square * square, 1.389_715_527, 2e-7);
        for (spin, exact) in [(0.0, 1.389_715_527), (100.0, 3.111_468)] {
            let slip = slip(1000.0, spin);
            assert_close(fine_power(&slip, &friction), exact, 1e-6);
            assert_close(slip.power(&friction), exact, 0.02);
        }
        let [along, _] = fine_sums(&heathcote, &friction, COULOMB * square);
        assert!(along.abs() < 1e-3 * 0.05 * 1000.0, "{along}");
    }

    /// A contact that only spins takes the moment 3/8 mu Q a E: of a circle, of an ellipse, of a contact under 200 N.
    #[test]
    fn moments_of_spin() {
        for (across, along, load_and_friction, expected) in [
            (1.0, 1.0, 1.0, 0.589_048_62),
            (1.0, 0.2, 1.0, 0.393_938_34),
            (0.873_622_80e-3, 0.097_136_66e-3, 0.05 * 200.0, 3.338_751_8e-3),
        ] {
            let slip = Slip {
                ellipse: Ellipse {
                    across,
                    along,
                    pressure: 1.5 * load_and_friction / (std::f64::consts::PI * across * along),
                    approach: 0.0,
                },
                radius: 1.0,
                rolling: 0.0,
                spin: 1.0,
            };
            let [_, moment] = fine_sums(&slip, &Coulomb(1.0), 0.0);
            assert_close(moment, expected, 2e-8);
            assert_close(slip.power(&Coulomb(1.0)), expected, 0.01);
        }
    }

    #[test]
    fn slip_is_even_in_spin_and_grows_with_it() {
        let power = |spin: f64| slip(1000.0, spin).power(&Coulomb(0.05));
        assert!((power(80.0) / power(-80.0) - 1.0).abs() < 1e-9);
        let powers = [0.0, 20.0, 50.0, 100.0, 300.0].map(power);
        assert!(powers.is_sorted(), "{powers:?}");
    }
}
