//! The path of contact of one mesh, prepared for local friction laws.

use super::cut_off::CutOff;
use super::sharing::{Knots, Sharing};
use crate::geometry::{Line, LoadSharing, Pair, PathPoint, ShareTable};
use crate::loss::{Notes, Undefined};
use crate::mechanism::Answers;
use crate::mechanism::mean_friction::MeanFrictionAt;
use crate::mechanism::tooth_friction::{
    FrictionLimits, KINKED, PathAt, PathExtent, PathNode, SMOOTH, ToothFrictionModel,
};
use crate::real::{Mask as _, Real};

/// Points of most paths: four sections for a smooth law.
const FEW: usize = 4 * SMOOTH;

/// Points of a smooth law that needs more of them, or of a path with more sections.
const MORE: usize = 4 * FEW;

/// Points of most paths for a law with a kink.
const MANY: usize = 16 * FEW;

/// Runs a function with space for some numbers. Most paths need little, and zeroing more costs time; only paths of more than 448 nodes
/// allocate.
#[inline(always)]
pub fn with_space<R: Real, T>(len: usize, run: impl FnOnce(&mut [R]) -> T) -> T {
    let (mut few, mut more, mut many, mut any);
    let space: &mut [R] = if len <= FEW {
        few = [R::ZERO; FEW];
        &mut few
    } else if len <= MORE {
        more = [R::ZERO; MORE];
        &mut more
    } else if len <= MANY {
        many = [R::ZERO; MANY];
        &mut many
    } else {
        any = vec![R::ZERO; len];
        &mut any
    };
    run(&mut space[..len])
}

/// The path of one mesh, prepared.
pub struct Path {
    nodes: Vec<PathNode>,
    extent: PathExtent,
    points: Vec<PathPoint>,
    /// Sliding power per friction, normal force and speed of the first gear, by node. \[m\]
    weights: Vec<f64>,
    /// Their sum.
    weight: f64,
    /// Arm of the friction force about the first axis per friction, by node; none for parallel axes. \[m\]
    arms: Vec<f64>,
}

impl Path {
    /// Maximum number of points on a path: 32 sections for a law with a kink.
    const MOST: usize = 32 * KINKED;

    /// The path of a pair with its load sharing, with as many points on each smooth section as the friction law requires.
    ///
    /// # Errors
    /// If the contact ratio is too high, as a sentence.
    pub fn new(pair: &Pair, sharing: LoadSharing, order: usize) -> Result<Self, String> {
        Self::checked(pair, pair.graded_path(sharing, order))
    }

    fn checked(pair: &Pair, points: Vec<PathPoint>) -> Result<Self, String> {
        if points.len() > Self::MOST {
            return Err(format!(
                "the contact ratio {:.2} is too high for a path integral",
                pair.contact_ratio
            ));
        }
        Ok(Self::from_points(pair, points))
    }

    /// The same with both ends of every section in addition, without weight: a jump of the load share, and with it the maximum of pressure
    /// or flash temperature, is at the end of a section, where no quadrature point is.
    ///
    /// # Errors
    /// As [`Path::new`].
    pub fn with_ends(pair: &Pair, sharing: LoadSharing, order: usize) -> Result<Self, String> {
        Self::checked(pair, pair.graded_path_with_ends(sharing, order))
    }

    /// The path of a pair with the shares of a table; with both ends of every section if the greatest values are wanted.
    ///
    /// # Errors
    /// As [`Path::new`].
    pub fn of_table(pair: &Pair, table: &ShareTable, line: Line, order: usize) -> Result<Self, String> {
        Self::checked(pair, pair.graded_path_of(table, line, order, line == Line::Peak))
    }

    /// The path of a pair through points with their weights.
    pub fn from_points(pair: &Pair, points: Vec<PathPoint>) -> Self {
        let nodes: Vec<PathNode> = points
            .iter()
            .map(|p| PathNode {
                weight: p.weight / pair.base_pitch,
                first_faster: pair.first_is_faster(p.x),
                ..PathNode::new(
                    pair.sliding(p.x),
                    pair.sum_speed(p.x),
                    pair.relative_radius(p.x),
                    p.line,
                )
            })
            .collect();
        let path = Self {
            extent: PathExtent::from_nodes(&nodes),
            nodes,
            points,
            weights: Vec::new(),
            weight: 0.0,
            arms: Vec::new(),
        };
        let path = path.with_arms(pair);
        path.weighted(|point| point.weight / pair.base_pitch)
    }

    /// The same with the arms of the friction force, if the axes are not parallel; for those its effect on the normal force is neglected.
    fn with_arms(mut self, pair: &Pair) -> Self {
        if let Some(motion) = &pair.crossed {
            let arm = |p: &PathPoint| p.weight / pair.base_pitch * p.share * motion.friction_arm(p.x - pair.points[2]);
            self.arms = self.points.iter().map(arm).collect();
        }
        self
    }

    /// The same with another average: the weight of each point, instead of the part of a base pitch that it represents.
    pub fn weighted(mut self, weight: impl Fn(&PathPoint) -> f64) -> Self {
        let places = self.points.iter().zip(&self.nodes);
        self.weights = places.map(|(p, n)| weight(p) * p.share * n.sliding).collect();
        self.weight = self.weights.iter().sum();
        self
    }

    /// Equidistant points over the whole path, including its ends; for display, not for integrals.
    pub fn even(pair: &Pair, sharing: LoadSharing, places: usize) -> Self {
        Self::from_even(pair, pair.even_path(sharing, places))
    }

    /// As [`Path::even`], with the shares of a table.
    pub fn even_of_table(pair: &Pair, table: &ShareTable, line: Line, places: usize) -> Self {
        Self::from_even(pair, pair.even_path_of(table, line, places))
    }

    fn from_even(pair: &Pair, points: Vec<PathPoint>) -> Self {
        let mut path = Self::from_points(pair, points);
        // The trapezoidal rule, for laws that need a mean over the path.
        let last = path.nodes.len() - 1;
        for (i, node) in path.nodes.iter_mut().enumerate() {
            let part = if i == 0 || i == last { 0.5 } else { 1.0 };
            node.weight = part * pair.contact_ratio / last as f64;
        }
        path
    }

    /// Sliding power per friction, normal force and speed of the first gear, by point. \[m\]
    pub(super) fn weights(&self) -> &[f64] {
        &self.weights
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
        PathAt::new(&self.nodes, &self.extent, mean, notes)
    }

    /// Sliding power per normal force and speed of the first gear, for friction at each point. \[m\]
    #[inline(always)]
    pub fn sliding<R: Real>(&self, mu: &[R]) -> R {
        let nodes = self.weights.iter().zip(mu);
        nodes.fold(R::ZERO, |sum, (weight, mu)| sum + *mu * *weight)
    }

    /// Arm of the friction force about the first axis, for friction at each point; zero for parallel axes. \[m\]
    #[inline(always)]
    pub fn friction_arm<R: Real>(&self, mu: &[R], limits: Option<FrictionLimits>) -> R {
        self.arms.iter().zip(mu).fold(R::ZERO, |sum, (arm, mu)| {
            let mu = limits.map_or(*mu, |limits| limits.cut_off(*mu));
            sum + mu * *arm
        })
    }

    /// The friction of a law over the path at an operating point, and where the law has a kink between the points.
    #[inline(always)]
    fn friction<R: Answers>(
        &self,
        law: &dyn ToothFrictionModel,
        at: &PathAt<'_, R>,
        cut_off: Option<&CutOff>,
    ) -> Result<(PathFriction<R>, R::Mask), Undefined> {
        let (sliding, arm, along) = with_space(
            self.len(),
            #[inline(always)]
            |mu| match cut_off {
                None => R::along(law, at, mu).map(|along| (self.sliding(mu), self.friction_arm(mu, None), along)),
                Some(cut_off) => R::uncut_along(law, at, mu).map(|along| {
                    let arm = self.friction_arm(mu, law.friction_limits());
                    (cut_off.sliding(self, mu), arm, along)
                }),
            },
        )?;
        let friction = PathFriction {
            sliding,
            mean: sliding / self.weight,
            arm,
            first_heat: along.first_heat,
        };
        Ok((friction, along.kink))
    }
}

/// Friction over a whole path.
#[derive(Debug, Clone, Copy)]
pub struct PathFriction<R = f64> {
    /// Sliding power per normal force and speed of the first gear. \[m\]
    pub sliding: R,
    /// Friction weighted by load and sliding velocity. \[-\]
    pub mean: R,
    /// Arm of the friction force about the axis of the first gear, by which it lowers the normal force for a torque of that gear; zero for
    /// parallel axes, where it is neglected. \[m\]
    pub arm: R,
    /// Share of the heat that enters the body of the first gear. \[-\]
    pub first_heat: R,
}

/// The path of one mesh at one load, with as many points as its friction law requires: few, and many where the law has a kink.
struct PathState {
    few: Path,
    many: Option<Path>,
    cut_off: Option<CutOff>,
}

impl PathState {
    fn new(law: &dyn ToothFrictionModel, path: impl Fn(usize) -> Result<Path, String>) -> Result<Self, String> {
        let many = law.kinked_order().map(&path);
        let few = path(law.order())?;
        Ok(Self {
            cut_off: law
                .friction_limits()
                .map(|limits| CutOff::new(&few, law.order(), limits)),
            few,
            many: many.transpose()?,
        })
    }

    fn weighted(self, weight: impl Fn(&PathPoint) -> f64) -> Self {
        let few = self.few.weighted(&weight);
        Self {
            cut_off: self.cut_off.map(|cut_off| cut_off.weighted(&few)),
            few,
            many: self.many.map(|path| path.weighted(&weight)),
        }
    }

    #[inline(always)]
    fn friction<R: Answers>(
        &self,
        law: &dyn ToothFrictionModel,
        at: &PathAt<'_, R>,
    ) -> Result<PathFriction<R>, Undefined> {
        let (few, kink) = self.few.friction(law, at, self.cut_off.as_ref())?;
        // Not for points that have left the batch or are at rest.
        let has_kink = kink.bits() & at.notes.points() != 0;
        let Some(path) = self.many.as_ref().filter(|_| has_kink) else {
            return Ok(few);
        };
        let at = at.with(|to| {
            (to.nodes, to.extent) = (&path.nodes, &path.extent);
            to.notes = to.notes.among(kink);
        });
        let (many, _) = path.friction(law, &at, None)?;
        Ok(PathFriction {
            sliding: R::select(kink, many.sliding, few.sliding),
            mean: R::select(kink, many.mean, few.mean),
            arm: R::select(kink, many.arm, few.arm),
            first_heat: R::select(kink, many.first_heat, few.first_heat),
        })
    }
}

/// The path of one mesh for a friction law: one of a load sharing that does not depend on the load, else one at each of its knots, between
/// which the friction is interpolated.
pub struct FrictionPath {
    knots: Knots,
    states: Vec<PathState>,
}

impl FrictionPath {
    /// The path of a pair with its load sharing for a friction law.
    ///
    /// # Errors
    /// As [`Path::new`].
    pub fn new(pair: &Pair, sharing: impl Into<Sharing>, law: &dyn ToothFrictionModel) -> Result<Self, String> {
        let sharing = sharing.into();
        let states: Result<Vec<PathState>, String> = match &sharing {
            Sharing::Fixed(sharing) => {
                PathState::new(law, |order| Path::new(pair, *sharing, order)).map(|state| vec![state])
            }
            Sharing::Loaded(shares) => {
                let of = |table| PathState::new(law, |order| Path::of_table(pair, table, Line::Mean, order));
                shares.tables().iter().map(of).collect()
            }
        };
        Ok(Self {
            knots: sharing.knots(),
            states: states?,
        })
    }

    /// As [`Path::weighted`].
    pub fn weighted(self, weight: impl Fn(&PathPoint) -> f64) -> Self {
        let states = self.states.into_iter();
        Self {
            states: states.map(|state| state.weighted(&weight)).collect(),
            ..self
        }
    }

    /// The path with few points, at the first knot.
    pub fn few(&self) -> &Path {
        &self.states[0].few
    }

    /// The paths with few points at all knots.
    pub fn all_few(&self) -> impl Iterator<Item = &Path> {
        self.states.iter().map(|state| &state.few)
    }

    /// The knots of the load sharing.
    pub fn knots(&self) -> &Knots {
        &self.knots
    }

    /// The friction of the law at an operating point of the path with few points.
    ///
    /// # Errors
    /// If the law is undefined.
    #[inline(always)]
    pub fn friction<R: Answers>(
        &self,
        law: &dyn ToothFrictionModel,
        at: &PathAt<'_, R>,
    ) -> Result<PathFriction<R>, Undefined> {
        match &self.states[..] {
            [only] => only.friction(law, at),
            states => self.friction_between(states, law, at),
        }
    }

    /// The friction between the knots next to the load of each point.
    fn friction_between<R: Answers>(
        &self,
        states: &[PathState],
        law: &dyn ToothFrictionModel,
        at: &PathAt<'_, R>,
    ) -> Result<PathFriction<R>, Undefined> {
        let place = self.knots.place(at.line_load);
        let (mut sliding, mut weight, mut arm, mut first_heat) = (R::ZERO, R::ZERO, R::ZERO, R::ZERO);
        for (knot, state) in states.iter().enumerate() {
            let part = self.knots.part(knot, place);
            let counts = part.is_above(R::ZERO);
            if counts.bits() & at.notes.points() == 0 {
                continue;
            }
            let at = at.with(|to| {
                (to.nodes, to.extent) = (&state.few.nodes, &state.few.extent);
                to.notes = to.notes.among(counts);
            });
            let found = state.friction(law, &at)?;
            let of = |x: R| R::select(counts, x * part, R::ZERO);
            sliding += of(found.sliding);
            weight += of(R::constant(state.few.weight));
            arm += of(found.arm);
            first_heat += of(found.first_heat);
        }
        Ok(PathFriction {
            sliding,
            mean: sliding / weight,
            arm,
            first_heat,
        })
    }
}
