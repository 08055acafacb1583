//! The path of contact of one mesh, prepared for local friction laws.

use crate::geometry::{LoadSharing, Pair, PathPoint};
use crate::loss::Notes;
use crate::mechanism::mean_friction::MeanFrictionAt;
use crate::mechanism::tooth_friction::{CUT_OFF, PathAt, PathExtent, PathNode, SMOOTH};
use crate::real::Real;

/// Points of most paths: four sections for a smooth law.
const FEW: usize = 4 * SMOOTH;

/// Points of most paths for a law with a cut-off, and of their like.
const MANY: usize = 16 * FEW;

/// Runs a function with space for some numbers. Most paths need little, and zeroing more costs time; only paths of more than 448 nodes
/// allocate.
#[inline(always)]
pub(crate) fn with_space<R: Real, T>(len: usize, run: impl FnOnce(&mut [R]) -> T) -> T {
    if len <= FEW {
        run(&mut [R::ZERO; FEW][..len])
    } else if len <= MANY {
        run(&mut [R::ZERO; MANY][..len])
    } else {
        run(&mut vec![R::ZERO; len])
    }
}

/// The path of one mesh, prepared.
pub struct Path {
    nodes: Vec<PathNode>,
    extent: PathExtent,
    points: Vec<PathPoint>,
    /// Sliding power per friction, normal force and speed of the first gear, by node. \[m\]
    weights: Vec<f64>,
    length: f64,
}

impl Path {
    /// Maximum number of points on a path: 32 sections for a law with a cut-off.
    const MOST: usize = 32 * CUT_OFF;

    /// The path of a pair with its load sharing, with as many points on each smooth section as the friction law requires.
    ///
    /// # Errors
    /// If the contact ratio is too high, as a sentence.
    pub fn new(pair: &Pair, sharing: LoadSharing, order: usize) -> Result<Self, String> {
        let points = pair.graded_path(sharing, order);
        if points.len() > Self::MOST {
            return Err(format!(
                "the contact ratio {:.2} is too high for a path integral",
                pair.contact_ratio
            ));
        }
        Ok(Self::from_points(pair, points))
    }

    /// The path of a pair through points with their weights.
    pub fn from_points(pair: &Pair, points: Vec<PathPoint>) -> Self {
        let nodes: Vec<PathNode> = points
            .iter()
            .map(|p| PathNode {
                force: p.share,
                weight: p.weight / pair.base_pitch,
                first_faster: p.x > pair.points[2],
                ..PathNode::new(
                    pair.sliding(p.x),
                    pair.sum_speed(p.x),
                    pair.relative_radius(p.x),
                    p.line,
                )
            })
            .collect();
        let weights = points
            .iter()
            .zip(&nodes)
            .map(|(p, n)| p.weight / pair.base_pitch * p.share * n.sliding)
            .collect();
        Self {
            extent: PathExtent::from_nodes(&nodes),
            nodes,
            points,
            weights,
            length: pair.facewidth / pair.base_helix.cos(),
        }
    }

    /// Equidistant points over the whole path, including its ends; for display, not for integrals.
    pub fn even(pair: &Pair, sharing: LoadSharing, places: usize) -> Self {
        let mut path = Self::from_points(pair, pair.even_path(sharing, places));
        // The trapezoidal rule, for laws that need a mean over the path.
        let last = path.nodes.len() - 1;
        for (i, node) in path.nodes.iter_mut().enumerate() {
            let part = if i == 0 || i == last { 0.5 } else { 1.0 };
            node.weight = part * pair.contact_ratio / last as f64;
        }
        path
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// True if there are no points, which never occurs.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The points, as points of the pair.
    pub fn points(&self) -> &[PathPoint] {
        &self.points
    }

    /// The points.
    pub fn nodes(&self) -> &[PathNode] {
        &self.nodes
    }

    /// The path at one operating point.
    #[inline(always)]
    pub fn at_operating_point<'a, R: Real>(
        &'a self,
        mean: &'a MeanFrictionAt<'a, R>,
        notes: Notes<'a, R>,
    ) -> PathAt<'a, R> {
        PathAt::new(&self.nodes, &self.extent, self.length, mean, notes)
    }

    /// Runs a function with space for friction at each node.
    #[inline(always)]
    pub fn with_space<R: Real, T>(&self, run: impl FnOnce(&mut [R]) -> T) -> T {
        with_space(self.len(), run)
    }

    /// Sliding power per normal force and speed of the first gear, for friction at each point. \[m\]
    #[inline(always)]
    pub fn sliding<R: Real>(&self, mu: &[R]) -> R {
        let nodes = self.weights.iter().zip(mu);
        nodes.fold(R::ZERO, |sum, (weight, mu)| sum + *mu * *weight)
    }

    /// Friction weighted by load and sliding velocity.
    #[inline(always)]
    pub fn average<R: Real>(&self, mu: &[R]) -> R {
        self.sliding(mu) / self.weights.iter().sum::<f64>()
    }
}
