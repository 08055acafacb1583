//! Overflow edges: how high the oil stands over the edge for a flow.
//!
//! Sources: broad edge with critical depth, textbooks (confirmed); sharp edge, form confirmed and coefficient recalled; sill with viscous
//! flow along its length up to the critical depth, derived; circular edge by the criterion of critical flow, derived.

use super::GRAVITY;
use crate::real::Real;

/// An edge over which oil escapes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Edge {
    /// A sharp straight edge.
    Sharp {
        /// Width. \[m\]
        width: f64,
        /// Discharge coefficient; 0.62 usually, 0.60 to 0.73. \[-\]
        discharge: f64,
    },
    /// A straight sill; of zero length it is the broad edge without friction.
    Sill {
        /// Width. \[m\]
        width: f64,
        /// Length in the direction of the flow. \[m\]
        length: f64,
    },
    /// The lower part of a circular opening, such as the bore of a cage or a shoulder.
    Circle {
        /// Radius. \[m\]
        radius: f64,
    },
}

/// Flow over an edge and the height of the oil over it, with their slopes over the unknown that both grow with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Over<R> {
    /// \[m3/s\]
    pub flow: R,
    pub flow_slope: R,
    /// \[m\]
    pub height: R,
    pub height_slope: R,
}

impl Edge {
    /// The largest unknown; that of a circle has the depth of its opening, others grow without bound. \[-\]
    pub(super) fn bound(&self) -> Option<f64> {
        match self {
            Self::Circle { radius } => Some((2.0 * radius).sqrt()),
            Self::Sharp { .. } | Self::Sill { .. } => None,
        }
    }

    /// Flow and height at an unknown above zero. The unknown is the square root of a depth, of which flows are nearly a cube.
    pub(super) fn over<R: Real>(&self, root: R, nu: R) -> Over<R> {
        let depth = root * root;
        let depth_slope = root * 2.0;
        let cube = depth * root;
        let cube_slope = depth * 3.0;
        match self {
            Self::Sharp { width, discharge } => {
                let factor = 2.0 / 3.0 * discharge * width * (2.0 * GRAVITY).sqrt();
                Over {
                    flow: cube * factor,
                    flow_slope: cube_slope * factor,
                    height: depth,
                    height_slope: depth_slope,
                }
            }
            Self::Sill { width, length } => {
                // The depth is the critical one at the end of the sill: q = sqrt(g) h_c^1.5.
                let factor = width * GRAVITY.sqrt();
                let friction = nu * (12.0 * length / GRAVITY.sqrt());
                let fourth = depth * depth * depth * depth + friction * cube;
                let start = fourth.sqrt().sqrt();
                let start_slope =
                    (depth * depth * depth * depth_slope * 4.0 + friction * cube_slope) / (start * start * start * 4.0);
                // q2/(2 g h2) with q2/g = h_c3.
                let square = cube * cube / (start * start) * 0.5;
                let square_slope = square * (cube_slope / cube - start_slope / start) * 2.0;
                Over {
                    flow: cube * factor,
                    flow_slope: cube_slope * factor,
                    height: start + square,
                    height_slope: start_slope + square_slope,
                }
            }
            Self::Circle { radius } => {
                let radius = *radius;
                let area = depth.lift(|y| segment(radius, y));
                let half = R::constant(2.0 * radius) - depth;
                let chord = (depth * half).sqrt() * 2.0;
                let chord_slope = (R::constant(radius) - depth) * 4.0 / chord;
                let flow = area * (area / chord * GRAVITY).sqrt();
                let slope = flow * (chord / area * 1.5 - chord_slope / chord * 0.5);
                Over {
                    flow,
                    flow_slope: slope * depth_slope,
                    height: depth + area / chord * 0.5,
                    height_slope: (R::constant(1.5) - area * chord_slope / (chord * chord) * 0.5) * depth_slope,
                }
            }
        }
    }
}

/// Area of a segment of a circle up to a depth. \[m2\]
pub(super) fn segment(radius: f64, depth: f64) -> f64 {
    let share = (1.0 - depth / radius).clamp(-1.0, 1.0);
    // Half the angle; the difference of nearly equal numbers has a series.
    let half = (0.5 * (1.0 - share)).sqrt().asin() * 2.0;
    if half < 0.1 {
        let square = half * half;
        let series = 2.0 / 3.0 - square * (2.0 / 15.0 - square * (4.0 / 315.0 - square * (2.0 / 2835.0)));
        return radius * radius * half * square * series;
    }
    radius * radius * (half - half.sin() * half.cos())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydraulics::tests::{L_MIN, close};

    /// Flow at a height over the edge, by bisection. \[m3/s\]
    fn flow(edge: &Edge, height: f64, nu: f64) -> f64 {
        let (mut low, mut high) = (0.0, edge.bound().unwrap_or(1.0));
        for _ in 0..200 {
            let at = 0.5 * (low + high);
            if edge.over(at, nu).height < height {
                low = at;
            } else {
                high = at;
            }
        }
        edge.over(high, nu).flow
    }

    #[test]
    fn straight_edges() {
        let width = 20e-3;
        let sharp = Edge::Sharp { width, discharge: 0.62 };
        let broad = Edge::Sill { width, length: 0.0 };
        for (height, of_sharp, of_broad) in [
            (2e-3, 0.196_473, 0.182_957),
            (5e-3, 0.776_626, 0.723_202),
            (10e-3, 2.196_63, 2.045_52),
        ] {
            close(flow(&sharp, height, 1e-5) / L_MIN, of_sharp, 6);
            close(flow(&broad, height, 1e-5) / L_MIN, of_broad, 6);
        }
    }

    #[test]
    fn viscous_sills() {
        for (q, nu, length, height) in [
            (1e-3, 1e-5, 10e-3, 7.030_32e-3),
            (1e-3, 1e-4, 10e-3, 7.657_76e-3),
            (1e-4, 1e-4, 10e-3, 3.378_80e-3),
            (1e-4, 1e-4, 0.0, 1.509_79e-3),
        ] {
            let sill = Edge::Sill { width: 1.0, length };
            let critical = (q * q / GRAVITY).cbrt();
            let over = sill.over(critical.sqrt(), nu);
            close(over.flow, q, 6);
            close(over.height, height, 6);
        }
    }

    #[test]
    fn circular_edges() {
        for (radius, height, wanted) in [
            (20e-3, 3e-3, 0.203_584),
            (20e-3, 6e-3, 0.799_979),
            (30e-3, 3e-3, 0.250_786),
            (30e-3, 6e-3, 0.991_527),
        ] {
            close(flow(&Edge::Circle { radius }, height, 1e-5) / L_MIN, wanted, 6);
        }
    }

    #[test]
    fn slopes_are_those_of_differences() {
        let edges = [
            Edge::Sharp {
                width: 20e-3,
                discharge: 0.62,
            },
            Edge::Sill {
                width: 20e-3,
                length: 10e-3,
            },
            Edge::Circle { radius: 20e-3 },
        ];
        for edge in edges {
            for root in [0.01, 0.03, 0.08, 0.15] {
                let (at, h) = (edge.over(root, 1e-5), 1e-6 * root);
                let [up, down] = [edge.over(root + h, 1e-5), edge.over(root - h, 1e-5)];
                assert!(((up.flow - down.flow) / (2.0 * h) / at.flow_slope - 1.0).abs() < 1e-6);
                assert!(((up.height - down.height) / (2.0 * h) / at.height_slope - 1.0).abs() < 1e-6);
            }
        }
    }
}
