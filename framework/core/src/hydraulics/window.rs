//! Oil that a gear throws through a window or onto a wall in front of a pocket.
//!
//! Derived. The oil leaves the rim tangentially, evenly between the angle at which the rim leaves the oil, cos(psi_e) = 1 - h/R from the
//! lowest point in the sense of rotation, and sqrt(2 H/R) beyond it, within which a slug leaves a tooth space of the height H (a
//! convention). At a wall at the distance X from the axis it has, with u = tan(psi) and s = sqrt(1 + u^2), the height
//! z = -R/s + u (X - R u/s) - g (X s - R u)^2/(2 v^2), which rises with psi up to about 80 degrees. Along the axis the sheet widens by 15
//! degrees to each side (a convention). First impact only.

use super::GRAVITY;
use crate::real::{Points, Real};

/// Up to this angle the height at a wall rises with the angle; what leaves the rim later flies upwards and is not counted.
const HIGHEST: f64 = 80.0 * std::f64::consts::PI / 180.0;

/// Widening of the sheet to each side, the tangent of 15 degrees: a convention.
const WIDENING: f64 = 0.267_949_192_431_122_7;

/// Most steps to an edge, before the last one over numbers with derivatives: a handful of Newton's, or those of halving.
const STEPS: usize = 50;

/// A window in a wall across the shafts' direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// The gear that throws, by its number among those that lift oil.
    pub lift: usize,
    /// Its member.
    pub member: usize,
    /// Distance of the wall from the axis, towards +y. \[m\]
    pub wall: f64,
    /// Heights of the lower and the upper edge above the axis. \[m\]
    pub edges: [f64; 2],
    /// Its ends along the shafts, from the middle of the gear. \[m\]
    pub ends: [f64; 2],
    /// Tip radius, tooth height and face width of the gear. \[m\]
    pub gear: [f64; 3],
}

/// What a window takes of the oil that its gear throws.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Taken<R = f64> {
    /// Share of the thrown oil.
    pub share: R,
    /// Heights above the axis at which the first and the last oil meet the wall; zeros if it flies elsewhere. \[m\]
    pub meets: [R; 2],
}

impl Window {
    /// What it takes at a speed of the gear (rad/s, with its sign) and an immersion depth of its tip circle (m).
    pub fn taken<R: Points>(&self, speed: R, dip: R) -> Taken<R> {
        let [radius, tooth, width] = self.gear;
        let alone = |point: usize| {
            let (speed, dip) = (speed.at_point(point), dip.at_point(point));
            // The lowest point of a gear that turns positively moves towards +y.
            let wall = self.wall * speed.signum();
            let start = (1.0 - dip / radius).clamp(-1.0, 1.0).acos();
            let end = start + (2.0 * tooth / radius).sqrt();
            if speed == 0.0 || dip <= 0.0 || start >= HIGHEST || wall <= radius {
                return [0.0; 3];
            }
            let rim = speed.abs() * radius;
            // The tangent of the angle at which oil leaves that meets an edge; an end of the range if none does.
            let tangent = |edge: f64| {
                let (mut low, mut high) = (start.tan(), end.min(HIGHEST).tan());
                if height(radius, wall, rim, low) >= edge {
                    return low;
                }
                if height(radius, wall, rim, high) <= edge {
                    return high;
                }
                let mut at = 0.5 * (low + high);
                for _ in 0..STEPS {
                    let excess = height(radius, wall, rim, at) - edge;
                    if excess < 0.0 {
                        low = at;
                    } else {
                        high = at;
                    }
                    let newton = at - excess / slope(radius, wall, rim, at);
                    let next = if newton > low && newton < high {
                        newton
                    } else {
                        0.5 * (low + high)
                    };
                    let close = (next - at).abs() <= 1e-15 * next;
                    at = next;
                    if close {
                        break;
                    }
                }
                at
            };
            let [from, to] = self.edges.map(tangent);
            [1.0, from, to]
        };
        let [hits, from, to] = R::each_of(alone);
        let wall = R::each(|point| (self.wall * speed.at_point(point).signum()).max(radius));
        let rim = speed.abs().at_least(1e-9) * radius;
        let start = (dip * (-1.0 / radius) + 1.0).lift(|x| x.clamp(-1.0, 1.0).acos());
        let arc = (2.0 * tooth / radius).sqrt();
        let end = (start + arc).at_most(HIGHEST);
        // One step of Newton's from each root gives derivatives, where numbers have them; an edge that no oil meets has none.
        let refined = |u: R, edge: f64| {
            let next =
                u - (height(R::constant(radius), wall, rim, u) - edge) / slope(R::constant(radius), wall, rim, u);
            let near = (next - u).abs().is_below(R::constant(1e-6));
            R::select(near, next, u).lift(f64::atan)
        };
        let within = |angle: R| Real::min(Real::max(angle, start), end);
        let [from, to] = [within(refined(from, self.edges[0])), within(refined(to, self.edges[1]))];
        let across = ((to - from) / arc).at_least(0.0);
        let sine = |angle: R| angle.lift(f64::sin);
        let flight = (wall - sine(start) * radius).at_least(0.0);
        let half = flight * WIDENING + 0.5 * width;
        let along =
            (Real::min(R::constant(self.ends[1]), half) - Real::max(R::constant(self.ends[0]), -half)) / (half * 2.0);
        let tangent = |angle: R| angle.lift(f64::tan);
        let meets = [start, end].map(|angle| hits * height(R::constant(radius), wall, rim, tangent(angle)));
        Taken {
            share: hits * across * along.at_least(0.0),
            meets,
        }
    }
}

/// Height above the axis at which oil meets a wall that left the rim at an angle with a tangent. \[m\]
fn height<R: Real>(radius: R, wall: R, rim: R, tangent: R) -> R {
    let s = (tangent * tangent + 1.0).sqrt();
    let fall = (wall * s - radius * tangent) / rim;
    -radius / s + tangent * (wall - radius * tangent / s) - fall * fall * (0.5 * GRAVITY)
}

/// Its slope over the tangent. \[m\]
fn slope<R: Real>(radius: R, wall: R, rim: R, tangent: R) -> R {
    let s = (tangent * tangent + 1.0).sqrt();
    let sine = tangent / s;
    let fall = (wall * s - radius * tangent) / (rim * rim);
    wall - radius * sine - fall * (wall * sine - radius) * GRAVITY
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::{Dual, Lane};
    use crate::testing::assert_close;
    use proptest::prelude::*;

    const MM: f64 = 1e-3;

    /// A wide window beside a wheel of 80 mm with teeth of 5.6 mm.
    fn window(edges: [f64; 2]) -> Window {
        Window {
            lift: 0,
            member: 0,
            wall: 120.0 * MM,
            edges: edges.map(|edge| edge * MM),
            ends: [-1.0, 1.0],
            gear: [80.0 * MM, 5.6 * MM, 30.0 * MM],
        }
    }

    const OMEGA: f64 = 8.0 / 0.08;

    /// Values calculated independently.
    #[test]
    fn shares_of_two_windows() {
        let taken = window([60.0, 100.0]).taken(OMEGA, 25.0 * MM);
        assert_close(taken.share, 0.215_605, 3e-6);
        assert_close(taken.meets[0] / MM, 9.767_36, 1e-6);
        assert_close(taken.meets[1] / MM, 82.3380, 1e-6);
        assert_close(window([0.0, 30.0]).taken(OMEGA, 25.0 * MM).share, 0.373_552, 3e-6);
        let middle = height(0.08, 0.12, 8.0, (0.812_756_f64 + 0.5 * 0.374_166).tan());
        assert_close(middle / MM, 38.0663, 1e-5);
    }

    #[test]
    fn oil_flies_in_the_sense_of_rotation() {
        assert_eq!(window([60.0, 100.0]).taken(-OMEGA, 25.0 * MM).share, 0.0);
        let other = Window {
            wall: -120.0 * MM,
            ..window([60.0, 100.0])
        };
        assert_close(other.taken(-OMEGA, 25.0 * MM).share, 0.215_605, 3e-6);
        for (speed, dip) in [(0.0, 0.025), (OMEGA, 0.0), (OMEGA, 0.16)] {
            assert_eq!(window([0.0, 100.0]).taken(speed, dip), Taken::default());
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let window = window([20.0, 60.0]);
        let share = |speed: f64, dip: f64| window.taken(speed, dip).share;
        let found = window.taken(Dual::variable(OMEGA, 0), Dual::constant(0.025)).share;
        assert_close(found.value, share(OMEGA, 0.025), 1e-12);
        let slope = (share(OMEGA + 1e-3, 0.025) - share(OMEGA - 1e-3, 0.025)) / 2e-3;
        assert_close(found.slopes[0], slope, 1e-4);
    }

    proptest! {
        /// Windows that follow each other share the thrown oil, which is never more than all; a point has its bits among others.
        #[test]
        fn windows_share_the_oil(dip in 1.0..70.0_f64, edge in 0.0..100.0_f64, omega in 30.0..500.0_f64) {
            let of = |edges: [f64; 2]| window(edges).taken(omega, dip * MM).share;
            let all = of([-1e4, 1e4]);
            prop_assert!((of([-1e4, edge]) + of([edge, 1e4]) - all).abs() < 1e-9);
            prop_assert!((0.0..=1.0 + 1e-9).contains(&all));
            let narrow = Window { ends: [0.0, 10.0 * MM], ..window([-1e4, 1e4]) };
            prop_assert!(narrow.taken(omega, dip * MM).share <= all);
            let lanes = window([-1e4, edge]).taken(Lane::constant(omega), Lane::constant(dip * MM)).share;
            prop_assert_eq!(lanes.at_point(3).to_bits(), of([-1e4, edge]).to_bits());
        }
    }
}
