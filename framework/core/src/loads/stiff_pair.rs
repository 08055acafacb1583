//! Two opposed bearings that are adjusted against each other without a spring: with preload or with end play.
//!
//! Derived: the bearing that takes thrust towards +x has the axial load F, the other one F - Ka. Together they are displaced by the closing d
//! of the pair: delta(F, Fr) + delta(F - Ka, Fr) = d, with the displacements of their load distributions, has one root. If d is too small for a
//! bearing without radial load, this one is free and the other takes Ka. The shaft, the housing and the rings are rigid, the bearings do not tilt.

use crate::real::{LANES, Points};
use crate::rolling::{AxialRow, ManyElements, root_of_growing};

/// Two opposed bearings: the one that takes thrust towards -x, and the one that takes it towards +x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StiffPair {
    /// How they are displaced under load.
    pub rows: [AxialRow; 2],
}

/// The row of a bearing with a contact angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AngularRow {
    /// Its elements.
    pub row: ManyElements,
    /// Mean diameter of the contacts with the outer ring. \[m\]
    pub outer_diameter: f64,
    /// True if its internal geometry is estimated.
    pub is_estimated: bool,
}

/// Numbers at one point: thrust, radial loads, closing.
type Input = ([f64; 2], [f64; 2]);

impl StiffPair {
    /// Axial loads of both bearings under a thrust towards +x (N), their radial loads (N), and at a closing (m). \[N\]
    pub fn axial<R: Points>(&self, thrust: R, radial: [R; 2], closing: R) -> [R; 2] {
        let [left, right] = self.rows;
        let least = [radial[0] * left.least_ratio() + thrust, radial[1] * right.least_ratio()];
        let bound = R::select(least[0].is_above(least[1]), least[0], least[1]);
        let mut roots = [None; LANES];
        let mut last: Option<(Input, Option<f64>)> = None;
        for (point, root) in roots.iter_mut().enumerate().take(R::COUNT) {
            let input = (
                [thrust.at_point(point), closing.at_point(point)],
                radial.map(|load| load.at_point(point)),
            );
            *root = match last {
                Some((same, root)) if same == input => root,
                _ => self.root(input, bound.at_point(point)),
            };
            last = Some((input, *root));
        }
        // A step of Newton from the root, which carries the derivatives.
        let root = R::each(|point| roots[point].unwrap_or(f64::NAN));
        let other = root - thrust;
        let off = right.displacement(root, radial[1]) + left.displacement(other, radial[0]) - closing;
        let slope = R::each(|point| {
            right.compliance(root.at_point(point), radial[1].at_point(point))
                + left.compliance(other.at_point(point), radial[0].at_point(point))
        });
        let is_free = R::mask(|point| roots[point].is_none());
        let found = R::select(is_free, bound, root - off / slope);
        [(found - thrust).at_least(0.0), found.at_least(0.0)]
    }

    /// Axial load of the second bearing; `None` if a bearing without radial load is free.
    fn root(&self, ([thrust, closing], radial): Input, bound: f64) -> Option<f64> {
        let [left, right] = self.rows;
        let off = |load: f64| {
            let own = right.displacement(load, radial[1]);
            own + left.displacement((load - thrust).max(0.0), radial[0]) - closing
        };
        if off(bound) >= 0.0 {
            return None;
        }
        let width = bound.abs().max(thrust.abs()).max(1.0);
        Some(root_of_growing(off, bound, width, 60).unwrap_or(f64::NAN))
    }

    /// By how much each bearing is closed at its axial and radial load (N), of the closing of the pair (m); below zero less than half of its
    /// elements carry, none without radial load. \[m\]
    pub fn closings<R: Points>(&self, axial: [R; 2], radial: [R; 2], closing: R) -> [R; 2] {
        let own = [0, 1].map(|side| self.rows[side].displacement(axial[side], radial[side]));
        // Without any load it is what the other one leaves.
        [0, 1].map(|side| {
            let is_free = axial[side].is_zero() & radial[side].is_zero();
            let left = closing - own[1 - side];
            R::select(is_free & left.is_below(own[side]), left, own[side])
        })
    }

    /// Force with which both press against each other at a closing (m), without other loads; zero with end play. \[N\]
    pub fn force(&self, closing: f64) -> f64 {
        let [_, force] = self.axial(0.0, [0.0; 2], closing);
        force
    }

    /// Closing at a force. \[m\]
    pub fn closing(&self, force: f64) -> f64 {
        self.rows.iter().map(|row| row.displacement(force, 0.0)).sum()
    }

    /// Axial stiffness of the shaft between both at a force, without other loads. \[N/m\]
    pub fn stiffness(&self, force: f64) -> f64 {
        self.rows.iter().map(|row| 1.0 / row.compliance(force, 0.0)).sum()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::real::{Dual, Lane, Real as _};
    use crate::rolling::Contact;
    use crate::testing::assert_close;

    const MM: f64 = 1e-3;

    /// Seventeen tapered rollers of 15 mm at 14 degrees, with the approach 7.7e-5 Q^0.9/l^0.8 of catalogues, in mm and N.
    fn tapered() -> ManyElements {
        let approach_at_1_n = 7.7e-5 / 15.0_f64.powf(0.8) * MM;
        ManyElements {
            number: 17.0,
            stiffness: approach_at_1_n.powf(-10.0 / 9.0),
            contact_angle: 14.0_f64.to_radians(),
            contact: Contact::Line,
        }
    }

    fn pair(row: &ManyElements) -> StiffPair {
        StiffPair {
            rows: [AxialRow::new(row); 2],
        }
    }

    /// SciPy: radial loads and thrust onto the first bearing, closing, displacement of it, axial loads.
    #[test]
    fn two_tapered_bearings() {
        let pair = pair(&tapered());
        let closing = pair.closing(1000.0);
        assert_close(closing, 0.010_239_077_930 * MM, 1e-10);
        assert_close(0.5 * pair.stiffness(1000.0) * MM, 217_033.431_8, 1e-9);
        assert_close(pair.force(closing), 1000.0, 1e-12);
        for (radial, thrust, closing, displacement, axial) in [
            (
                [0.0, 0.0],
                500.0,
                closing,
                0.006_272_411_22,
                [1_253.152_94, 753.152_941],
            ),
            (
                [3000.0, 2000.0],
                0.0,
                closing,
                0.004_639_716_58,
                [1_129.774_84, 1_129.774_84],
            ),
            (
                [3000.0, 2000.0],
                500.0,
                closing,
                0.006_285_224_04,
                [1_327.415_44, 827.415_441],
            ),
            (
                [3000.0, 2000.0],
                500.0,
                0.0,
                0.004_020_942_99,
                [1_083.741_36, 583.741_361],
            ),
            (
                [3000.0, 2000.0],
                0.0,
                0.0,
                -0.004_372_300_61,
                [886.322_994, 886.322_994],
            ),
        ] {
            let [second, first] = pair.axial(thrust, [radial[1], radial[0]], closing);
            assert_close(first, axial[0], 1e-6);
            assert_close(second, axial[1], 1e-6);
            let [of_second, of_first] = pair.closings([second, first], [radial[1], radial[0]], closing);
            assert_close(of_first, displacement * MM, 1e-6);
            assert!(
                (of_first + of_second - closing).abs() < 1e-9 * MM,
                "{of_first} {of_second}"
            );
        }
    }

    /// SciPy: balls at 40 degrees.
    #[test]
    fn two_angular_contact_bearings() {
        let pair = pair(&ManyElements {
            number: 12.0,
            stiffness: 4e5 / MM.powf(1.5),
            contact_angle: 40.0_f64.to_radians(),
            contact: Contact::Point,
        });
        let closing = pair.closing(500.0);
        for (thrust, axial) in [(500.0, [271.186_359, 771.186_359]), (1413.0, [0.0189, 1413.0189])] {
            let found = pair.axial(thrust, [0.0; 2], closing);
            assert!((found[0] - axial[0]).abs() < 5e-5, "{found:?}");
            assert_close(found[1], axial[1], 1e-7);
        }
    }

    /// An equal pair without radial loads lifts off at 2^n of its preload: 2.828 with balls, 2.160 with rollers.
    #[test]
    fn a_pair_lifts_off() {
        for contact in [Contact::Point, Contact::Line] {
            let pair = pair(&ManyElements { contact, ..tapered() });
            let closing = pair.closing(1000.0);
            let limit = 1000.0 * 2.0_f64.powf(contact.exponent());
            let [below, _] = pair.axial(0.999 * limit, [0.0; 2], closing);
            assert!(below > 0.0, "{below}");
            for side in [1.0, -1.0] {
                let mut above = pair.axial(side * 1.001 * limit, [0.0; 2], closing);
                let mut closings = pair.closings(above, [0.0; 2], closing);
                if side < 0.0 {
                    above.reverse();
                    closings.reverse();
                }
                assert_eq!(above, [0.0, 1.001 * limit]);
                assert!(closings[0] < 0.0 && closings[1] > closing, "{closings:?}");
            }
        }
    }

    #[test]
    fn without_loads_there_is_the_preload_or_nothing() {
        let pair = pair(&tapered());
        assert_eq!(pair.axial(0.0, [0.0; 2], -1e-5), [0.0; 2]);
        assert_eq!((pair.force(-1e-5), pair.force(0.0)), (0.0, 0.0));
        let [left, right] = pair.axial(0.0, [0.0; 2], pair.closing(700.0));
        assert_close(left, 700.0, 1e-12);
        assert_close(right, 700.0, 1e-12);
    }

    /// With much end play the more loaded bearing has the least axial load.
    #[test]
    fn much_end_play_leaves_one_element() {
        let pair = pair(&tapered());
        let least = 3000.0 * 14.0_f64.to_radians().tan();
        let [left, right] = pair.axial(0.0, [3000.0, 2000.0], -1e-3);
        assert!(
            left > least && left < 1.1 * least && left == right,
            "{left} {right} {least}"
        );
    }

    proptest! {
        #[test]
        fn loads_balance_and_closings_add(
            thrust in -5e3..5e3_f64, radial in [0.0..2e4_f64, 0.0..2e4_f64], closing in -1e-4..1e-4_f64,
        ) {
            let pair = pair(&tapered());
            let axial = pair.axial(thrust, radial, closing);
            let size = axial[0].max(axial[1]);
            prop_assert!((axial[1] - axial[0] - thrust).abs() <= 1e-12 * size);
            for (axial, radial) in axial.iter().zip(radial) {
                prop_assert!(*axial >= 0.999_999 * radial * pair.rows[0].least_ratio());
            }
            let own = pair.closings(axial, radial, closing);
            prop_assert!((own[0] + own[1] - closing).abs() < 1e-9 * (own[0].abs() + own[1].abs()), "{own:?} {closing}");
            // More closing, more load; mirrored, the same.
            let more = pair.axial(thrust, radial, closing + 1e-6);
            prop_assert!(more[0] >= axial[0] && more[1] >= axial[1]);
            let mirrored = pair.axial(-thrust, [radial[1], radial[0]], closing);
            prop_assert!((mirrored[0] - axial[1]).abs() <= 1e-9 * size && (mirrored[1] - axial[0]).abs() <= 1e-9 * size);
        }

        #[test]
        fn lanes_have_the_bits_of_single_points(
            thrust in -5e3..5e3_f64, radial in [0.0..2e4_f64, 0.0..2e4_f64], closing in -1e-4..1e-4_f64,
        ) {
            let pair = pair(&tapered());
            let own = |point: usize| 0.3 * (point / 2) as f64;
            // Every fourth is without radial loads, so that one bearing may be free.
            let loaded = |point: usize| f64::from(u8::from(!point.is_multiple_of(4)));
            let at = |x: f64| move |point: usize| x * own(point);
            let radials = radial.map(|load| move |point: usize| load * own(point) * loaded(point));
            let together = pair.axial(
                Lane::each(at(thrust)),
                [Lane::each(radials[0]), Lane::each(radials[1])],
                Lane::each(at(closing)),
            );
            for point in 0..LANES {
                let alone = pair.axial(
                    at(thrust)(point),
                    [radials[0](point), radials[1](point)],
                    at(closing)(point),
                );
                for (lane, alone) in together.iter().zip(alone) {
                    prop_assert_eq!(lane[point].to_bits(), alone.to_bits());
                }
            }
        }

        #[test]
        fn derivatives_are_those_of_the_root(
            thrust in -2e3..2e3_f64, radial in [100.0..1e4_f64, 100.0..1e4_f64], closing in -2e-5..5e-5_f64,
        ) {
            let pair = pair(&tapered());
            for which in 0..4 {
                let vary = |x: f64, own: usize| if own == which { Dual::variable(x, 0) } else { Dual::constant(x) };
                let found = pair.axial(
                    vary(thrust, 0),
                    [vary(radial[0], 1), vary(radial[1], 2)],
                    vary(closing, 3),
                );
                let step = if which == 3 { 1e-9 } else { 0.1 };
                let moved = |change: f64| {
                    let by = |own: usize| if own == which { change } else { 0.0 };
                    pair.axial(thrust + by(0), [radial[0] + by(1), radial[1] + by(2)], closing + by(3))
                };
                let (more, less) = (moved(step), moved(-step));
                let plain = pair.axial(thrust, radial, closing);
                for side in 0..2 {
                    prop_assert_eq!(found[side].value.to_bits(), plain[side].to_bits());
                    let expected = (more[side] - less[side]) / (2.0 * step);
                    let scale = expected.abs().max(if which == 3 { 1e6 } else { 1e-2 });
                    prop_assert!((found[side].slopes[0] - expected).abs() < 2e-3 * scale, "{which} {side}: {} {expected}", found[side].slopes[0]);
                }
            }
        }
    }
}
