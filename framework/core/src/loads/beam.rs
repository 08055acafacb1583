//! A shaft as a beam on several supports: Euler-Bernoulli, or Timoshenko with Cowper's shear coefficient.

use nalgebra::{DMatrix, DVector, Dyn, LU};

use super::layout::{Section, SupportLayout};

/// Young's modulus, shear modulus and Poisson's ratio of steel.
const STEEL: (f64, f64, f64) = (206e9, 79e9, 0.3);

/// A support of a beam.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BeamSupport {
    /// Position. \[m\]
    pub at: f64,
    /// Lateral stiffness; `None`: rigid. \[N/m\]
    pub radial: Option<f64>,
    /// Tilting stiffness; `None`: zero. \[Nm/rad\]
    pub tilting: Option<f64>,
}

impl BeamSupport {
    /// A support of a member.
    pub fn of(seat: &SupportLayout) -> Self {
        Self {
            at: seat.at,
            radial: seat.radial_stiffness,
            tilting: seat.tilting_stiffness,
        }
    }
}

/// A load in one plane, or a reaction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BeamLoad {
    /// Position. \[m\]
    pub at: f64,
    /// Lateral force. \[N\]
    pub force: f64,
    /// Moment that increases the slope. \[Nm\]
    pub moment: f64,
}

/// Why a beam cannot be solved.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum BeamFault {
    /// It can move.
    Mechanism,
    /// Diameters are missing in a range.
    NoSection([f64; 2]),
    /// A load acts at a hinge, where its moment would be ambiguous.
    MomentAtHinge(f64),
}

/// A beam with its factored stiffness matrix.
#[derive(Debug, Clone)]
pub(crate) struct Beam {
    nodes: Vec<f64>,
    /// Degrees of freedom of each node: deflection, slope left of it, slope right of it.
    freedom: Vec<[usize; 3]>,
    supports: Vec<BeamSupport>,
    /// Node of each support.
    support_nodes: Vec<usize>,
    stiffness: DMatrix<f64>,
    fixed: Vec<usize>,
    factors: LU<f64, Dyn, Dyn>,
}

impl Beam {
    /// A beam from its sections, supports and hinges, with nodes where loads may act.
    ///
    /// # Errors
    /// If it can move or diameters are missing.
    pub fn new(
        sections: &[Section],
        supports: &[BeamSupport],
        hinges: &[f64],
        loads: &[f64],
        shear: bool,
    ) -> Result<Self, BeamFault> {
        if let Some(at) = hinges.iter().find(|h| loads.iter().any(|x| (*x - **h).abs() < 1e-9)) {
            return Err(BeamFault::MomentAtHinge(*at));
        }
        let mut nodes: Vec<f64> = supports
            .iter()
            .map(|s| s.at)
            .chain(hinges.iter().copied())
            .chain(loads.iter().copied())
            .collect();
        let first = nodes.iter().copied().fold(f64::INFINITY, f64::min);
        let last = nodes.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        nodes.extend(
            sections
                .iter()
                .flat_map(|s| s.range)
                .filter(|x| *x > first && *x < last),
        );
        nodes.sort_by(f64::total_cmp);
        nodes.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
        let node = |x: f64| nodes.iter().position(|n| (n - x).abs() < 2e-9).unwrap_or(0);
        let hinge_nodes: Vec<usize> = hinges.iter().map(|x| node(*x)).collect();
        let mut count = 0;
        let freedom: Vec<[usize; 3]> = (0..nodes.len())
            .map(|i| {
                let hinge = hinge_nodes.contains(&i);
                let own = [count, count + 1, count + 1 + usize::from(hinge)];
                count += 2 + usize::from(hinge);
                own
            })
            .collect();
        let mut k = DMatrix::zeros(count, count);
        for i in 0..nodes.len() - 1 {
            let middle = 0.5 * (nodes[i] + nodes[i + 1]);
            let Some(section) = sections.iter().find(|s| s.range[0] <= middle && middle <= s.range[1]) else {
                return Err(BeamFault::NoSection([nodes[i], nodes[i + 1]]));
            };
            let element = element(section, nodes[i + 1] - nodes[i], shear);
            let places = [freedom[i][0], freedom[i][2], freedom[i + 1][0], freedom[i + 1][1]];
            for (r, &row) in places.iter().enumerate() {
                for (c, &column) in places.iter().enumerate() {
                    k[(row, column)] += element[r][c];
                }
            }
        }
        let support_nodes: Vec<usize> = supports.iter().map(|s| node(s.at)).collect();
        let mut fixed = Vec::new();
        for (support, &n) in supports.iter().zip(&support_nodes) {
            match support.radial {
                Some(stiffness) => k[(freedom[n][0], freedom[n][0])] += stiffness,
                None => fixed.push(freedom[n][0]),
            }
            if let Some(stiffness) = support.tilting {
                k[(freedom[n][1], freedom[n][1])] += stiffness;
            }
        }
        let mut reduced = k.clone();
        for &f in &fixed {
            reduced.row_mut(f).fill(0.0);
            reduced.column_mut(f).fill(0.0);
            reduced[(f, f)] = k[(f, f)].max(1.0);
        }
        // Lengths and moments have different magnitudes; diagonal scaling makes the test of the pivots consistent.
        let scale: Vec<f64> = (0..count)
            .map(|i| reduced[(i, i)].abs().max(f64::MIN_POSITIVE).sqrt())
            .collect();
        let scaled = DMatrix::from_fn(count, count, |i, j| reduced[(i, j)] / (scale[i] * scale[j]));
        let pivots = LU::new(scaled).u();
        if (0..count).any(|i| pivots[(i, i)].abs() < 1e-11) {
            return Err(BeamFault::Mechanism);
        }
        let factors = LU::new(reduced);
        Ok(Self {
            nodes: nodes.clone(),
            freedom,
            supports: supports.to_vec(),
            support_nodes,
            stiffness: k,
            fixed,
            factors,
        })
    }

    fn node(&self, x: f64) -> usize {
        self.nodes.iter().position(|n| (n - x).abs() < 2e-9).unwrap_or(0)
    }

    fn deflections(&self, loads: &[BeamLoad]) -> (DVector<f64>, DVector<f64>) {
        let mut f = DVector::zeros(self.stiffness.nrows());
        for load in loads {
            let n = self.node(load.at);
            f[self.freedom[n][0]] += load.force;
            f[self.freedom[n][1]] += load.moment;
        }
        let mut right = f.clone();
        for &fixed in &self.fixed {
            right[fixed] = 0.0;
        }
        let u = self
            .factors
            .solve(&right)
            .unwrap_or_else(|| DVector::zeros(right.len()));
        (u, f)
    }

    /// Deflection at a position where a load may act. \[m\]
    #[cfg(test)]
    pub(crate) fn deflection(&self, loads: &[BeamLoad], at: f64) -> f64 {
        self.deflections(loads).0[self.freedom[self.node(at)][0]]
    }

    /// Slope at a position where a load may act.
    pub fn slope(&self, loads: &[BeamLoad], at: f64) -> f64 {
        self.deflections(loads).0[self.freedom[self.node(at)][1]]
    }

    /// Reactions of the supports to loads in one plane.
    pub fn reactions(&self, loads: &[BeamLoad]) -> Vec<BeamLoad> {
        let (u, f) = self.deflections(loads);
        let inner = &self.stiffness * &u;
        self.supports
            .iter()
            .zip(&self.support_nodes)
            .map(|(support, &n)| {
                let place = self.freedom[n][0];
                let force = match support.radial {
                    Some(stiffness) => -stiffness * u[place],
                    None => inner[place] - f[place],
                };
                let moment = support
                    .tilting
                    .map_or(0.0, |stiffness| -stiffness * u[self.freedom[n][1]]);
                BeamLoad {
                    at: support.at,
                    force,
                    moment,
                }
            })
            .collect()
    }
}

fn element(section: &Section, length: f64, shear: bool) -> [[f64; 4]; 4] {
    let (e, g, nu) = STEEL;
    let (outer, inner) = (section.outer, section.inner);
    let inertia = std::f64::consts::PI * (outer.powi(4) - inner.powi(4)) / 64.0;
    let area = std::f64::consts::PI * (outer.powi(2) - inner.powi(2)) / 4.0;
    let q = inner / outer;
    let ring = (1.0 + q * q).powi(2);
    let kappa = 6.0 * (1.0 + nu) * ring / ((7.0 + 6.0 * nu) * ring + (20.0 + 12.0 * nu) * q * q);
    let phi = if shear {
        12.0 * e * inertia / (kappa * g * area * length * length)
    } else {
        0.0
    };
    let c = e * inertia / (length.powi(3) * (1.0 + phi));
    let (l, l2) = (length, length * length);
    [
        [12.0 * c, 6.0 * l * c, -12.0 * c, 6.0 * l * c],
        [6.0 * l * c, (4.0 + phi) * l2 * c, -6.0 * l * c, (2.0 - phi) * l2 * c],
        [-12.0 * c, -6.0 * l * c, 12.0 * c, -6.0 * l * c],
        [6.0 * l * c, (2.0 - phi) * l2 * c, -6.0 * l * c, (4.0 + phi) * l2 * c],
    ]
}
