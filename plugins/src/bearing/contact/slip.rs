//! Sliding in the elliptic contact of a ball in a groove: the surfaces are curved across the direction of rolling, and spin.
//!
//! Sources: the speeds are geometry: with the deformed radius R_d = 2 f D/(2 f + 1), the roll rate w and the spin w_s a point (x along, y across) slides
//! with w (y^2 - y0^2)/(2 R_d) - w_s y along and w_s x across the direction of rolling (Heathcote 1921 for the first part). The lines of pure rolling
//! at y0 follow from traction that sums to zero. Traction is that of Eyring's flow with a limiting stress, with boundary friction by the film ratio.

use std::sync::LazyLock;

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
/// Places along half an ellipse.
const ANGLES: usize = 16;
/// Sine and cosine of their angles, in the half ahead of the long axis.
static PLACES: LazyLock<[(f64, f64); ANGLES]> = LazyLock::new(|| {
    std::array::from_fn(|place| (std::f64::consts::PI * ((place as f64 + 0.5) / ANGLES as f64 - 0.5)).sin_cos())
});
/// Square of y0 over a of Coulomb's friction without spin: the root of t - t^3/3 = 1/3.
const COULOMB: f64 = 0.347_296_355_333_860_7 * 0.347_296_355_333_860_7;
/// Steps towards the lines of pure rolling. The power is stationary there, so that two suffice.
const STEPS: usize = 2;

/// Stress of sliding surfaces at a pressure.
pub trait Traction {
    /// What depends on the pressure only.
    type Pressed: Copy;
    /// At a pressure. \[Pa\]
    fn under(&self, pressure: f64) -> Self::Pressed;
    /// Stress at a sliding speed in m/s. \[Pa\]
    fn stress(&self, pressed: Self::Pressed, speed: f64) -> f64;
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
        let (a, b) = (self.ellipse.across, self.ellipse.along);
        let per_square = self.rolling / (2.0 * self.radius);
        let sums = |line: f64| {
            let (mut along, mut power) = (0.0, 0.0);
            for [node, weight] in GAUSS {
                let r = 0.5 + 0.5 * node;
                let pressed = traction.under(self.ellipse.pressure * (1.0 - r * r).max(0.0).sqrt());
                let (mut own_along, mut own_power) = (0.0, 0.0);
                for (sin, cos) in *PLACES {
                    let (x, y) = (b * r * cos, a * r * sin);
                    let v_x = per_square * (y * y - line) - self.spin * y;
                    let v = v_x.hypot(self.spin * x);
                    let stress = traction.stress(pressed, v);
                    if v > 0.0 {
                        own_along += stress * v_x / v;
                    }
                    own_power += stress * v;
                }
                along += own_along * weight * r;
                power += own_power * weight * r;
            }
            // Both halves of the ellipse, of the radii from zero to one.
            let area = a * b * std::f64::consts::PI / ANGLES as f64;
            (along * area, power * area)
        };
        let (mut low, mut high) = (0.0, a * a);
        let mut line = COULOMB * a * a;
        let mut found = sums(line);
        if self.spin == 0.0 {
            return found.1;
        }
        let mut before: Option<(f64, f64)> = None;
        for _ in 0..STEPS {
            if found.0 > 0.0 {
                low = line;
            } else {
                high = line;
            }
            let secant = before.map(|(line_before, along)| line - found.0 * (line - line_before) / (found.0 - along));
            let next = secant
                .filter(|next| next.is_finite() && *next > low && *next < high)
                .unwrap_or(0.5 * (low + high));
            before = Some((line, found.0));
            line = next;
            found = sums(line);
        }
        found.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearloss_framework::rolling::{Material, PointContact};

    /// Coulomb's friction.
    struct Coulomb(f64);

    impl Traction for Coulomb {
        type Pressed = f64;
        fn under(&self, pressure: f64) -> f64 {
            self.0 * pressure
        }
        fn stress(&self, pressed: f64, _: f64) -> f64 {
            pressed
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

    /// The exact values of Heathcote's slip, P = 0.0805711989 mu Q w a^2/R_d, and of spin besides. The grid is within two per cent.
    #[test]
    fn powers_of_coulomb() {
        for (spin, exact) in [(0.0, 1.389_715_527), (100.0, 3.106_343_548)] {
            let found = slip(1000.0, spin).power(&Coulomb(0.05));
            assert!((found / exact - 1.0).abs() < 0.02, "{spin}: {found} {exact}");
        }
        let pure = slip(0.0, 100.0);
        let (a, b) = (pure.ellipse.across, pure.ellipse.along);
        let modulus = Material::STEEL.contact_modulus(&Material::STEEL);
        let second = PointContact::new(5.790_988e-3, 196.053e-3, modulus).second_integral();
        let exact = 0.375 * 0.05 * 1000.0 * a * second * 100.0;
        let found = pure.power(&Coulomb(0.05));
        assert!((found / exact - 1.0).abs() < 0.01, "{found} {exact} {b}");
    }

    #[test]
    fn slip_is_even_in_spin_and_grows_with_it() {
        let power = |spin: f64| slip(1000.0, spin).power(&Coulomb(0.05));
        assert!((power(80.0) / power(-80.0) - 1.0).abs() < 1e-9);
        let powers = [0.0, 20.0, 50.0, 100.0, 300.0].map(power);
        assert!(powers.is_sorted(), "{powers:?}");
    }
}
