//! Ratings: quantities of a component at a solved point that compare it with what it can bear, such as life, safety, film or
//! temperature.
//!
//! A rating reads the context of its mechanism, as a loss model does, but it is evaluated after the point is solved: no loss depends on
//! it. It returns named quantities with their unit, not watts, some of them with a bound. A quantity whose inputs are not known is
//! omitted. [`register_rating!`](crate::register_rating) registers it; documents address it by its name under `ratings`.

use crate::loss::{NoteBase, Undefined};
use crate::mechanism::Mechanism;
use std::sync::Arc;

/// A rating of the components of one mechanism.
pub trait Rating<M: Mechanism>: Send + Sync {
    /// Adds the quantities that are known at one solved point. Pure. What it cannot know it omits.
    ///
    /// # Errors
    /// If a formula is undefined at this point.
    fn rate(&self, at: &M::At<'_, f64>, to: &mut Rated) -> Result<(), Undefined>;
}

/// How values of a quantity over a time are combined into one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Over {
    /// The minimum is decisive, such as for a safety.
    #[serde(rename = "minimum")]
    Least,
    /// The maximum is decisive, such as for a temperature.
    #[serde(rename = "maximum")]
    Greatest,
    /// A life: shares of damage add up, after Palmgren and Miner.
    Damage,
}

/// One quantity of a rating.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, schemars::JsonSchema)]
pub struct Figure {
    /// Symbol as in the source.
    pub symbol: &'static str,
    /// Name of the quantity, as it stands in a sentence.
    pub meaning: &'static str,
    /// Unit of the value; `-` if there is none.
    pub unit: &'static str,
    /// How values over a time are combined: minimum, maximum, or shares of damage.
    #[serde(rename = "over_time")]
    pub over: Over,
    /// True for an intermediate that tables of several components omit.
    #[serde(skip)]
    pub detail: bool,
}

impl Figure {
    /// A quantity whose minimum over a time is decisive: symbol, unit, meaning.
    pub const fn least(symbol: &'static str, unit: &'static str, meaning: &'static str) -> Self {
        Self {
            symbol,
            unit,
            meaning,
            over: Over::Least,
            detail: false,
        }
    }

    /// The same as an intermediate, which tables of several components omit.
    pub const fn detail(self) -> Self {
        Self { detail: true, ..self }
    }

    /// A quantity whose maximum over a time is decisive.
    pub const fn greatest(symbol: &'static str, unit: &'static str, meaning: &'static str) -> Self {
        Self {
            over: Over::Greatest,
            ..Self::least(symbol, unit, meaning)
        }
    }

    /// A life, whose damage adds up over a time.
    pub const fn life(symbol: &'static str, unit: &'static str, meaning: &'static str) -> Self {
        Self {
            over: Over::Damage,
            ..Self::least(symbol, unit, meaning)
        }
    }
}

/// Range in which a quantity should be, in its unit; bounds are parameters of the rating.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// Minimum.
    pub least: f64,
    /// Maximum.
    pub greatest: f64,
}

impl Bound {
    /// No bound.
    pub const NONE: Self = Self {
        least: f64::NEG_INFINITY,
        greatest: f64::INFINITY,
    };

    /// A minimum.
    pub const fn at_least(least: f64) -> Self {
        Self { least, ..Self::NONE }
    }

    /// A maximum.
    pub const fn at_most(greatest: f64) -> Self {
        Self { greatest, ..Self::NONE }
    }
}

/// A quantity with its value and its bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RatedFigure {
    /// The quantity.
    pub figure: Figure,
    /// Its value in its unit; finite.
    pub value: f64,
    /// Where it should be.
    pub bound: Bound,
}

impl RatedFigure {
    /// True if the value is outside its bound.
    pub fn is_outside(&self) -> bool {
        !(self.bound.least..=self.bound.greatest).contains(&self.value)
    }

    /// What is wrong with a value outside its bound, as a sentence without its subject; `None` if it is inside.
    pub fn fault(&self) -> Option<(&'static str, f64)> {
        match () {
            () if !self.is_outside() => None,
            () if self.value < self.bound.least => Some(("below", self.bound.least)),
            () => Some(("above", self.bound.greatest)),
        }
    }
}

/// The quantities of one component at one point.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rated(Vec<RatedFigure>);

impl Rated {
    /// Adds a quantity without a bound. A value that is not finite is omitted, such as the life without load.
    pub fn add(&mut self, figure: &Figure, value: f64) {
        self.add_bounded(figure, value, Bound::NONE);
    }

    /// Adds a quantity with its bound; as [`Rated::add`].
    pub fn add_bounded(&mut self, figure: &Figure, value: f64, bound: Bound) {
        if value.is_finite() {
            self.0.push(RatedFigure {
                figure: *figure,
                value,
                bound,
            });
        }
    }

    /// All quantities, in the order in which they were added.
    pub fn figures(&self) -> &[RatedFigure] {
        &self.0
    }

    /// The value of a quantity by its symbol.
    pub fn value(&self, symbol: &str) -> Option<f64> {
        self.0.iter().find(|f| f.figure.symbol == symbol).map(|f| f.value)
    }
}

/// Value of a quantity over a time, from its values over parts of the time with their durations. A part without a value does no damage.
/// `None` if there is no value, or no damage.
pub fn over_time(over: Over, parts: impl IntoIterator<Item = (f64, Option<f64>)>) -> Option<f64> {
    let (mut time, mut damage) = (0.0, 0.0);
    let mut extreme: Option<f64> = None;
    for (duration, value) in parts {
        time += duration;
        let Some(value) = value else { continue };
        damage += duration / value;
        extreme = Some(match (extreme, over) {
            (None, _) => value,
            (Some(known), Over::Greatest) => known.max(value),
            (Some(known), _) => known.min(value),
        });
    }
    match over {
        Over::Damage => (damage > 0.0).then(|| time / damage).filter(|life| life.is_finite()),
        Over::Least | Over::Greatest => extreme,
    }
}

/// A built rating with the position of its notes.
pub struct RatingSlot<M: Mechanism> {
    pub(crate) rating: Arc<dyn Rating<M>>,
    pub(crate) notes: NoteBase,
}

impl<M: Mechanism> RatingSlot<M> {
    /// Evaluates it.
    ///
    /// # Errors
    /// As [`Rating::rate`].
    pub(crate) fn rate(&self, at: &M::At<'_, f64>) -> Result<Rated, Undefined> {
        let mut to = Rated::default();
        self.rating.rate(at, &mut to)?;
        Ok(to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn damages_add_up_after_palmgren_and_miner() {
        // By hand: 1/L = 0.25/1000 + 0.75/6000 = 0.375e-3.
        let life = over_time(Over::Damage, [(1.0, Some(1000.0)), (3.0, Some(6000.0))]);
        assert_eq!(life.map(f64::round), Some(2667.0));
        // Time without load does no damage.
        assert_eq!(
            over_time(Over::Damage, [(1.0, Some(1000.0)), (1.0, None)]),
            Some(2000.0)
        );
        assert_eq!(over_time(Over::Damage, [(1.0, None)]), None);
    }

    #[test]
    fn extremes_do_not_depend_on_durations() {
        let parts = [(1.0, Some(3.0)), (9.0, Some(5.0)), (2.0, None)];
        assert_eq!(over_time(Over::Least, parts), Some(3.0));
        assert_eq!(over_time(Over::Greatest, parts), Some(5.0));
        assert_eq!(over_time(Over::Greatest, []), None);
    }

    #[test]
    fn a_value_that_is_not_finite_is_omitted() {
        let figure = Figure::life("L", "h", "life");
        let mut rated = Rated::default();
        rated.add(&figure, f64::INFINITY);
        rated.add(&figure, f64::NAN);
        rated.add_bounded(&figure, 5.0, Bound::at_least(6.0));
        assert_eq!(rated.value("L"), Some(5.0));
        assert_eq!(rated.figures()[0].fault(), Some(("below", 6.0)));
        assert_eq!(rated.figures().len(), 1);
    }
}
