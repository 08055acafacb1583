//! How models answer for one point, for several together, and with derivatives.

use super::tooth_friction::{Along, PathAt, Range, ToothFrictionModel};
use super::{Answer, Inputs, Mechanism, differences};
use crate::attach::State;
use crate::contact::path::with_space;
use crate::loss::{Loss, Notebook, Undefined};
use crate::real::{Dual, Lane, Points};
use crate::registry::Placed;

/// Numbers for which models answer: one point, with or without derivatives, or several. Several are answered together by a law that
/// is written for any [`Real`](crate::real::Real), one by one by others and where their branches differ. Derivatives follow from such
/// a law; those of others are found by differences.
pub trait Answers: Points {
    /// The result of a model; NaN at points where it is undefined, unless there is one only.
    ///
    /// # Errors
    /// Why it is undefined at the only point.
    fn answer<M: Mechanism>(
        model: &M::Model,
        at: &M::At<'_, Self>,
    ) -> Result<<M::Answer as Answer>::Of<Self>, Undefined>;

    /// The loss of one copy of a placed component.
    ///
    /// # Errors
    /// As [`Answers::answer`].
    fn placed(placed: &dyn Placed, state: &State<'_, Self>, book: &Notebook<'_, Self>)
    -> Result<Loss<Self>, Undefined>;

    /// Coefficients of friction at all nodes of a path, before they are cut off at limits.
    ///
    /// # Errors
    /// As [`Answers::answer`].
    fn uncut_along(
        model: &dyn ToothFrictionModel,
        path: &PathAt<'_, Self>,
        mu: &mut [Self],
    ) -> Result<Along<Self>, Undefined>;

    /// Coefficients of friction at all nodes of a path. A cut-off is a kink.
    ///
    /// # Errors
    /// As [`Answers::answer`].
    #[inline(always)]
    fn along(
        model: &dyn ToothFrictionModel,
        path: &PathAt<'_, Self>,
        mu: &mut [Self],
    ) -> Result<Along<Self>, Undefined> {
        let mut along = Self::uncut_along(model, path, mu)?;
        if let Some(limits) = model.friction_limits() {
            let mut range = Range::default();
            for (node, mu) in path.nodes.iter().zip(mu) {
                range.extend(node, *mu);
                *mu = limits.cut_off(*mu);
            }
            along.kink = along.kink | range.is_cut_off([limits.least, limits.greatest]);
        }
        Ok(along)
    }
}

impl Answers for f64 {
    #[inline(always)]
    fn answer<M: Mechanism>(
        model: &M::Model,
        at: &M::At<'_, f64>,
    ) -> Result<<M::Answer as Answer>::Of<f64>, Undefined> {
        M::answer(model, at).map(Answer::alone)
    }

    #[inline(always)]
    fn placed(placed: &dyn Placed, state: &State<'_>, book: &Notebook<'_>) -> Result<Loss, Undefined> {
        placed.loss(state, book)
    }

    #[inline(always)]
    fn uncut_along(model: &dyn ToothFrictionModel, path: &PathAt<'_>, mu: &mut [f64]) -> Result<Along, Undefined> {
        model.uncut_along(path, mu)
    }
}

impl Answers for Lane {
    #[inline(always)]
    fn answer<M: Mechanism>(
        model: &M::Model,
        at: &M::At<'_, Lane>,
    ) -> Result<<M::Answer as Answer>::Of<Lane>, Undefined> {
        if let Ok(all) = M::answer_together(model, at) {
            return Ok(all);
        }
        let notes = at.notes();
        let mut last = None;
        let evaluate = |point: usize| match last {
            Some((earlier, answer)) if notes.book.are_alike(earlier, point) => answer,
            _ => {
                let answer = M::answer(model, &at.at_point(point));
                last = Some((point, answer));
                answer
            }
        };
        Ok(M::Answer::one_by_one(notes.points(), evaluate))
    }

    #[inline(always)]
    fn placed(
        placed: &dyn Placed,
        state: &State<'_, Lane>,
        book: &Notebook<'_, Lane>,
    ) -> Result<Loss<Lane>, Undefined> {
        Ok(placed.losses(state, book))
    }

    #[inline(always)]
    fn uncut_along(
        model: &dyn ToothFrictionModel,
        path: &PathAt<'_, Lane>,
        mu: &mut [Lane],
    ) -> Result<Along<Lane>, Undefined> {
        if let Ok(along) = model.uncut_along_together(path, mu) {
            return Ok(along);
        }
        let mut all = Along::<Lane>::default();
        let mut kinks = [false; Lane::COUNT];
        let points = path.notes.points();
        with_space(mu.len(), |numbers: &mut [f64]| {
            for point in (0..Lane::COUNT).filter(|point| points >> point & 1 == 1) {
                let along = path.at_point(point, |path| model.uncut_along(path, numbers));
                for (mu, number) in mu.iter_mut().zip(&*numbers) {
                    mu.set(point, if along.is_ok() { *number } else { f64::NAN });
                }
                if let Ok(along) = along {
                    all.first_heat.set(point, along.first_heat);
                    kinks[point] = along.kink;
                }
            }
        });
        all.kink = Lane::mask(|point| kinks[point]);
        Ok(all)
    }
}

impl Answers for Dual {
    fn answer<M: Mechanism>(
        model: &M::Model,
        at: &M::At<'_, Dual>,
    ) -> Result<<M::Answer as Answer>::Of<Dual>, Undefined> {
        M::answer_with_derivatives(model, at).unwrap_or_else(|| differences::answer::<M>(model, at))
    }

    fn placed(
        placed: &dyn Placed,
        state: &State<'_, Dual>,
        book: &Notebook<'_, Dual>,
    ) -> Result<Loss<Dual>, Undefined> {
        placed.loss_with_derivatives(state, book)
    }

    fn uncut_along(
        model: &dyn ToothFrictionModel,
        path: &PathAt<'_, Dual>,
        mu: &mut [Dual],
    ) -> Result<Along<Dual>, Undefined> {
        let along = model.uncut_along_with_derivatives(path, mu);
        along.unwrap_or_else(|| differences::along(model, path, mu))
    }
}
