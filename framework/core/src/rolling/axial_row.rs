//! Axial displacement of a row of very many elements under a thrust and a radial load, quick and at several points together.
//!
//! The load integrals of Sjoevall depend on the load zone alone, so with rho = Fr tan a/Fa = J_r/J_a the displacement is
//!
//! ```text
//! delta_a = (Fa/(Z K sin a))^(1/n) g(rho)/sin a,   g = (1 - 1/(2 eps)) J_a^(-1/n)
//! ```
//!
//! with one function g for points and one for lines: g(0) = 1, zero where half of the elements carry, minus infinity at rho = 1, where one
//! element carries all. (1 - rho)^(1 + 1/(2 n)) g is smooth and is interpolated by cubic pieces.

use std::sync::OnceLock;

use super::many_elements::{Contact, ManyElements, load_integral};
use crate::real::{LANES, Points, Real};

/// Pieces on each side of the load zone one, where the last element begins to carry.
const PIECES: u32 = 48;

/// Load zone at the last node, beyond which the last piece goes on.
const LEAST_ZONE: f64 = 1e-4;

/// A cubic polynomial in the distance from the start.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    start: f64,
    coefficients: [f64; 4],
}

/// The interpolated function of one kind of contact.
#[derive(Debug, PartialEq)]
struct Shape {
    pieces: Vec<Piece>,
}

/// rho, the function there and its derivative.
type Node = [f64; 3];

impl Shape {
    /// That of a kind of contact.
    fn of(contact: Contact) -> &'static Self {
        static SHAPES: [OnceLock<Shape>; 2] = [OnceLock::new(), OnceLock::new()];
        SHAPES[usize::from(contact == Contact::Line)].get_or_init(|| Self::new(contact.exponent()))
    }

    fn new(n: f64) -> Self {
        let power = pole(n);
        // Without radial load; g has no slope there.
        let mut nodes: Vec<Node> = vec![[0.0, 1.0, -power]];
        // Close nodes where the function has the root of a power of the distance.
        let narrow = |i: u32| (f64::from(i) / f64::from(PIECES)).powi(2);
        nodes.extend((1..PIECES).rev().map(|i| node(n, 1.0 / (1.0 - narrow(i)))));
        nodes.extend((0..PIECES).map(|i| node(n, 1.0 - narrow(i))));
        nodes.push(node(n, LEAST_ZONE));
        let pieces = nodes.windows(2).map(|pair| {
            let ([start, value, slope], [end, next, next_slope]) = (pair[0], pair[1]);
            let width = end - start;
            let mean = (next - value) / width;
            Piece {
                start,
                coefficients: [
                    value,
                    slope,
                    (3.0 * mean - 2.0 * slope - next_slope) / width,
                    (slope + next_slope - 2.0 * mean) / (width * width),
                ],
            }
        });
        Self {
            pieces: pieces.collect(),
        }
    }

    fn piece(&self, ratio: f64) -> &Piece {
        let next = self.pieces.partition_point(|piece| piece.start <= ratio);
        &self.pieces[next.saturating_sub(1)]
    }

    #[inline(always)]
    fn value<R: Points>(&self, ratio: R) -> R {
        let mut own = [self.pieces[0]; LANES];
        for (point, own) in own.iter_mut().enumerate().take(R::COUNT) {
            *own = *self.piece(ratio.at_point(point));
        }
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| R::each(|point| own[point].coefficients[k]));
        let x = ratio - R::each(|point| own[point].start);
        ((d * x + c) * x + b) * x + a
    }

    fn slope(&self, ratio: f64) -> f64 {
        let Piece {
            start,
            coefficients: [_, b, c, d],
        } = self.piece(ratio);
        let x = ratio - start;
        (3.0 * d * x + 2.0 * c) * x + b
    }
}

/// The power of the pole at rho = 1: there 1 - rho is as eps, and J_a as its root.
fn pole(n: f64) -> f64 {
    1.0 + 0.5 / n
}

/// The node at a load zone.
fn node(n: f64, zone: f64) -> Node {
    let ([j_a, j_r], [less_a, less_r]) = (load_integral(zone, n), load_integral(zone, n - 1.0));
    // Derivatives over the load zone: of the load (1 - x/eps)^n, n ((1 - x/eps)^(n-1) - (1 - x/eps)^n)/eps.
    let [d_a, d_r] = [n / zone * (less_a - j_a), n / zone * (less_r - j_r)];
    let ratio = j_r / j_a;
    let d_ratio = (d_r - ratio * d_a) / j_a;
    let (share, scale) = (1.0 - 0.5 / zone, j_a.powf(-1.0 / n));
    let g = share * scale;
    let d_g = scale * (0.5 / (zone * zone) - share * d_a / (n * j_a));
    let (rest, power) = (1.0 - ratio, pole(n));
    let smooth = rest.powf(power);
    [ratio, g * smooth, d_g / d_ratio * smooth - power * g * smooth / rest]
}

/// A row of very many elements with a contact angle, as the displacement that a load causes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxialRow {
    /// Tangent of the contact angle.
    tan: f64,
    /// Displacement of a thrust of 1 N without radial load. \[m\]
    at_one: f64,
    /// Its power of the thrust.
    power: f64,
    /// Power of the pole.
    pole: f64,
    shape: &'static Shape,
}

impl AxialRow {
    /// The row.
    pub fn new(row: &ManyElements) -> Self {
        let n = row.contact.exponent();
        Self {
            tan: row.contact_angle.tan(),
            at_one: row.approach(1.0),
            power: 1.0 / n,
            pole: pole(n),
            shape: Shape::of(row.contact),
        }
    }

    /// Thrust over a radial load at which one element carries all; there is no equilibrium with less.
    pub fn least_ratio(&self) -> f64 {
        self.tan
    }

    /// Thrust over a radial load at which half of the elements carry and the displacement is zero.
    pub fn half_ratio(contact: Contact, contact_angle: f64) -> f64 {
        let [j_a, j_r] = load_integral(0.5, contact.exponent());
        j_a / j_r * contact_angle.tan()
    }

    /// Axial displacement under a thrust and a radial load, both not negative, the thrust not below [`Self::least_ratio`] of the radial load,
    /// where it is minus infinity. \[m\]
    #[inline(always)]
    pub fn displacement<R: Points>(&self, thrust: R, radial: R) -> R {
        let ratio = R::select(thrust.is_above(R::ZERO), radial * self.tan / thrust, R::ZERO);
        let rest = (-ratio + 1.0).at_least(0.0);
        thrust.power(self.power) * self.at_one * self.shape.value(ratio) * Real::power(rest, -self.pole)
    }

    /// Its derivative over the thrust. \[m/N\]
    pub fn compliance(&self, thrust: f64, radial: f64) -> f64 {
        let ratio = if thrust > 0.0 { radial * self.tan / thrust } else { 0.0 };
        let rest = (1.0 - ratio).max(0.0);
        let value = self.shape.value(ratio);
        let turned = ratio * (self.shape.slope(ratio) + self.pole * value / rest);
        self.at_one * thrust.powf(self.power - 1.0) * rest.powf(-self.pole) * (self.power * value - turned)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::assert_close;

    fn row(contact: Contact) -> ManyElements {
        ManyElements {
            number: 15.0,
            stiffness: 1e9,
            contact_angle: 0.3,
            contact,
        }
    }

    /// The integrals give the thrust of a displacement, the interpolation the displacement of a thrust.
    #[test]
    fn it_is_the_inverse_of_the_integrals() {
        for contact in [Contact::Point, Contact::Line] {
            let (exact, quick) = (row(contact), AxialRow::new(&row(contact)));
            let usual = exact.approach(1000.0);
            for share in [
                -3.0, -1.0, -0.4, -0.1, -0.01, 0.0, 0.03, 0.2, 0.35, 0.5, 0.7, 1.0, 2.0, 6.0,
            ] {
                let Some(thrust) = exact.thrust(3000.0, share * usual) else {
                    panic!("no thrust at {share}");
                };
                let found = quick.displacement(thrust, 3000.0);
                assert!(
                    (found / usual - share).abs() < 2e-8 * (1.0 + share * share),
                    "{contact:?} {share}: {}",
                    found / usual
                );
            }
            assert_close(quick.displacement(1000.0, 0.0), usual, 1e-14);
            assert_close(
                AxialRow::half_ratio(contact, 0.3),
                exact.thrust(1.0, 0.0).unwrap_or_default(),
                1e-9,
            );
        }
    }

    #[test]
    fn the_compliance_is_the_slope() {
        for contact in [Contact::Point, Contact::Line] {
            let quick = AxialRow::new(&row(contact));
            for (thrust, radial) in [(1000.0, 0.0), (1000.0, 500.0), (1000.0, 1900.0), (1000.0, 3100.0)] {
                let step = 1e-3;
                let [more, less] = [step, -step].map(|change| quick.displacement(thrust + change, radial));
                assert_close(quick.compliance(thrust, radial), (more - less) / (2.0 * step), 1e-6);
            }
        }
    }

    #[test]
    fn with_one_element_it_has_no_limit() {
        let quick = AxialRow::new(&row(Contact::Line));
        let least = 1000.0 * quick.least_ratio();
        assert_eq!(quick.displacement(least, 1000.0), f64::NEG_INFINITY);
        assert_eq!(quick.displacement(0.0, 0.0), 0.0);
    }
}
