//! Linear model of the residuals about a point, in scaled steps.

use nalgebra::{DMatrix, DVector};

use super::context::Point;
use super::dogleg;
use super::evaluate::{Evaluator, Miss};
use super::linear::Factors;
use super::model::{Model, Region};
use super::optimality;
use super::robust::{Robust, Weighted};
use super::second_order;
use super::space::Space;

/// A point with its derivatives. Steps z = D p are scaled by the norms D of the columns.
pub(super) struct Linearised<'a> {
    space: &'a Space<'a>,
    point: Point,
    pub jacobian: DMatrix<f64>,
    weighted: Weighted,
    pub cost: f64,
    factors: Factors,
    scale: DVector<f64>,
    pub first_order: f64,
    pub relative_offset: Option<f64>,
}

impl<'a> Linearised<'a> {
    /// Linearises at a point; scales follow the norms of the columns with a memory.
    pub fn about(
        point: &Point,
        jacobian: DMatrix<f64>,
        robust: &Robust,
        space: &'a Space<'a>,
        scale: &mut DVector<f64>,
        memory: f64,
    ) -> Self {
        let weighted = robust.weighted(&point.r);
        let rows = weighted.rows(&jacobian);
        let mut columns = rows.clone();
        for (j, mut column) in columns.column_iter_mut().enumerate() {
            let norm = column.norm().max(memory * scale[j]);
            scale[j] = if norm > 0.0 { norm } else { 1.0 / space.typical[j] };
            column /= scale[j];
        }
        let gradient = rows.tr_mul(&weighted.residual);
        let active = optimality::active(space, &point.u, &gradient);
        Self {
            space,
            point: point.clone(),
            cost: robust.cost(&point.r),
            factors: Factors::new(columns, &weighted.residual),
            scale: scale.clone(),
            first_order: optimality::first_order(space, &point.u, &rows, &weighted.residual),
            relative_offset: optimality::relative_offset(&rows, &weighted.residual, &active),
            jacobian,
            weighted,
        }
    }

    /// Half the sum of squares over scaled steps.
    pub fn model(&self) -> Model<'_> {
        Model {
            r: &self.factors.r,
            q: &self.factors.q,
        }
    }

    /// The region of a step: ball, bounds and maximum relative change of each coordinate.
    pub fn region(&self, radius: f64, bound: f64) -> Region {
        let (space, u) = (self.space, &self.point.u);
        let farthest = |j: usize| bound * self.scale[j] * u[j].abs().max(space.typical[j]);
        let n = u.len();
        Region {
            radius,
            lower: DVector::from_fn(n, |j, _| self.room(j)[0].max(-farthest(j))),
            upper: DVector::from_fn(n, |j, _| self.room(j)[1].min(farthest(j))),
        }
    }

    /// Decrease of the cost predicted by the model without the ball.
    pub fn promise(&self, bound: f64) -> f64 {
        let model = self.model();
        model.fall(&dogleg::step(&model, &self.region(f64::INFINITY, bound)))
    }

    /// The target of a step, exactly at a bound that it reaches.
    pub fn target(&self, z: &DVector<f64>) -> Vec<f64> {
        let (space, u) = (self.space, &self.point.u);
        let place = |j: usize| match (z[j], self.room(j)) {
            (z, [lower, _]) if z <= lower => space.lower[j],
            (z, [_, upper]) if z >= upper => space.upper[j],
            (z, _) => (u[j] + z / self.scale[j]).clamp(space.lower[j], space.upper[j]),
        };
        (0..u.len()).map(place).collect()
    }

    /// Half the second-order correction of a step, for one call. Absent if it is too long or leaves the bounds.
    pub fn correction(
        &self,
        evaluator: &Evaluator<'_>,
        region: &Region,
        z: &DVector<f64>,
    ) -> Result<Option<DVector<f64>>, Miss> {
        let Some(probe) = evaluator.try_residual(&self.target(&(z * second_order::PROBE)))? else {
            return Ok(None);
        };
        let slope = &self.jacobian * z.component_div(&self.scale);
        let mut bend = second_order::bend(&self.point.r, &probe, &slope);
        // Weights of rows are constant over a step, as in the linear model.
        if let Some(factors) = &self.weighted.factors {
            bend.component_mul_assign(factors);
        }
        let half = second_order::correction(&self.model(), region, z, &self.factors.project(bend));
        let inside = |j: usize, half: f64| {
            let [lower, upper] = self.room(j);
            half == 0.0 || (lower <= z[j] + half && z[j] + half <= upper)
        };
        Ok(half.filter(|half| half.iter().enumerate().all(|(j, half)| inside(j, *half))))
    }

    /// Length of a vector of coordinates in the metric of the ball.
    pub fn length(&self, of: impl Fn(usize) -> f64) -> f64 {
        DVector::from_fn(self.scale.len(), |j, _| self.scale[j] * of(j)).norm()
    }

    /// Maximum relative change of a coordinate to another point.
    pub fn change(&self, u: &[f64]) -> f64 {
        let change = |j: usize| (u[j] - self.point.u[j]).abs() / self.space.size(j, self.point.u[j]);
        (0..u.len()).map(change).fold(0.0, f64::max)
    }

    /// Scaled distance to the bounds.
    fn room(&self, j: usize) -> [f64; 2] {
        let (space, u) = (self.space, &self.point.u);
        [space.lower[j], space.upper[j]].map(|bound| self.scale[j] * (bound - u[j]))
    }
}
