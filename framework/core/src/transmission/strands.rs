//! The strands of a chain between two wheels: their directions, the length of the chain, the forces on the shafts.
//!
//! With `e` from the axis of the first wheel to that of the second, `n = x cross e` and `cos = (r1 - r2)/a`, the strands touch the first
//! wheel at `r1 (cos e +- sin n)` and run along `sin e -+ cos n`. A torque `T` of the chain on the first wheel needs the tensions
//! `F0 + (|t| + t)/2` and `F0 + (|t| - t)/2`, `t = T/r1`. Their sum on the first wheel is `(2 F0 + |t|) sin e + t cos n`; the second one
//! feels the opposite. Centrifugal force loads the links, not the shafts.

use super::axis::Axis;
use crate::codes;
use crate::description::ChainEntry;
use crate::document::Diagnostic;
use crate::loads::{CylindricalMesh, MeshLayout};

/// Greatest difference of positions and centre distances that are the same. \[m\]
const SAME: f64 = 1e-5;
/// Share of the length by which a chain may be too short: tolerance of new chains and belts.
const SHORT: f64 = 1e-3;
/// Sag of the slack strand over its length above which it is doubtful; 1 to 4 % are usual.
const SAG: f64 = 0.06;

/// Both strands of a chain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Strands {
    /// Positions of the wheels along their shafts. \[m\]
    pub at: [f64; 2],
    /// Position of both, counted from where [`MemberLayout::start`](crate::loads::MemberLayout::start) counts. \[m\]
    pub plane: f64,
    /// Radii at which the tension acts. \[m\]
    pub radii: [f64; 2],
    /// Unit vector across the shafts from the axis of the first wheel to that of the second.
    pub direction: [f64; 2],
    /// Centre distance. \[m\]
    pub distance: f64,
    /// Sine and cosine of the angle between the line of centres and the radius to the point where a strand leaves the first wheel.
    pub angle: [f64; 2],
    /// Tension of the slack strand without torque. \[N\]
    pub slack: f64,
    /// Length of the chain that these wheels need. \[m\]
    pub length: f64,
}

/// The strands of a chain with pitch and teeth, compared with what else is stated; `None` for a belt of variable ratio, or if there is a
/// fault.
pub(super) fn checked(
    path: &str,
    chain: &ChainEntry,
    axes: [Axis; 2],
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) -> Option<Strands> {
    let mut fault = |key: &str, message: String, help: String| {
        let path = if key.is_empty() {
            path.to_owned()
        } else {
            format!("{path}.{key}")
        };
        found.push(Diagnostic::error(path, message).code(codes::CHAIN).help(help));
    };
    let mm = |x: f64| format!("{:.3} mm", 1e3 * x);
    let Some([y, z]) = axes[0].to_parallel(&axes[1]) else {
        fault(
            "wheels",
            "the axes are not parallel and of the same direction".to_owned(),
            "name two shafts with the same direction, or correct `axis`".to_owned(),
        );
        return None;
    };
    let distance = y.hypot(z);
    if let Some(stated) = chain.centre_distance
        && (stated - distance).abs() > SAME
    {
        fault(
            "centre_distance",
            format!("the axes are {} apart, not {}", mm(distance), mm(stated)),
            "correct `axis` of a shaft or `centre_distance`, or remove it".to_owned(),
        );
        return None;
    }
    let [first, second] = &chain.wheels;
    let planes = [axes[0].start() + first.at, axes[1].start() + second.at];
    if (planes[0] - planes[1]).abs() > SAME {
        fault(
            "wheels",
            format!("the wheels are at {} and {}", mm(planes[0]), mm(planes[1])),
            "write the same `at` for both: the chain runs in a plane across the shafts".to_owned(),
        );
        return None;
    }
    let (radii, pitch) = (chain.part().radii()?, chain.pitch?);
    if distance <= radii[0] + radii[1] {
        fault(
            "wheels",
            format!(
                "the axes are {} apart, and the wheels with radii of {} and {} touch",
                mm(distance),
                mm(radii[0]),
                mm(radii[1])
            ),
            "correct `axis` of a shaft, the pitch or the numbers of teeth".to_owned(),
        );
        return None;
    }
    let cos = (radii[0] - radii[1]) / distance;
    let sin = (1.0 - cos * cos).sqrt();
    let psi = cos.acos();
    let span = distance * sin;
    let length = 2.0 * (span + radii[0] * (std::f64::consts::PI - psi) + radii[1] * psi);
    if let Some(links) = chain.links {
        let stated = f64::from(links) * pitch;
        let needed = length / pitch;
        if stated < length * (1.0 - SHORT) {
            fault(
                "links",
                format!("{links} links are too short: wheels and centre distance need {needed:.2}"),
                format!("write `links: {}`, or correct the axes", needed.ceil()),
            );
            return None;
        }
        // The arc of a strand with a small sag f is 8 f^2/(3 l) longer than the straight line.
        let sag = (0.375 * (stated - length).max(0.0) / span).sqrt();
        if sag > SAG && chain.slack_tension == 0.0 {
            warnings.push(
                Diagnostic::warning(
                    format!("{path}.links"),
                    format!(
                        "{links} links leave a slack strand that sags by {:.1} % of its length: wheels and centre distance need {needed:.2}",
                        100.0 * sag
                    ),
                )
                .code(codes::CHAIN_DOUBTFUL)
                .help("correct the number of links or the axes; with a tensioner, state `slack_tension`"),
            );
        }
    }
    Some(Strands {
        at: [first.at, second.at],
        plane: planes[0],
        radii,
        direction: [y / distance, z / distance],
        distance,
        angle: [sin, cos],
        slack: chain.slack_tension,
        length,
    })
}

impl Strands {
    /// The chain for statics: its force per newton of the tangential force at the first wheel, and of its magnitude.
    pub fn layout(&self, members: [usize; 2]) -> MeshLayout {
        let [sin, cos] = self.angle;
        MeshLayout::Cylindrical(CylindricalMesh {
            members,
            at: self.plane,
            radius: self.radii,
            sign: 1.0,
            direction: self.direction,
            across: cos,
            tan_alpha: -sin,
            hand_tan_beta: 0.0,
            count: 1.0,
            central: [false; 2],
        })
    }

    /// Force of the tension without torque on the shaft of a wheel. \[N\]
    pub fn permanent(&self, wheel: usize) -> [f64; 3] {
        let pull = 2.0 * self.slack * self.angle[0] * if wheel == 0 { 1.0 } else { -1.0 };
        [0.0, pull * self.direction[0], pull * self.direction[1]]
    }

    /// Angles over which the chain wraps both wheels. \[rad\]
    pub fn wraps(&self) -> [f64; 2] {
        let psi = self.angle[1].acos();
        [2.0 * (std::f64::consts::PI - psi), 2.0 * psi]
    }
}
