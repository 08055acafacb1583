//! Laws with a single result, which serve every mechanism: a constant, a formula, a table or a function over quantities of the context.
//!
//! [`crate::generic`] builds them from the parameters in a document.

use std::sync::Arc;

use crate::document::Unit;
use crate::formula::Formula;
use crate::function::Function;
use crate::limits;
use crate::loss::{Loss, Undefined};
use crate::mechanism::{Inputs, Mechanism, Quantity};
use crate::real::{LANES, Lane, Mask as _, Points as _, Real as _};
use crate::table::Table;

/// A law with a single result: a coefficient, a moment or a power.
pub struct Scalar<M: Mechanism> {
    pub(crate) law: ScalarLaw<M>,
    pub(crate) unit: &'static Unit,
}

/// The law behind a [`Scalar`].
pub(crate) enum ScalarLaw<M: Mechanism> {
    None,
    /// In SI.
    Constant(f64),
    /// Of the quantities of the context, by their numbers.
    Formula(Formula),
    Table(Lookup<M>),
    /// Of the embedding program, with the quantities that it takes.
    Function(Arc<dyn Function>, Vec<&'static Quantity<M>>),
}

impl<M: Mechanism> Scalar<M> {
    /// The value at a context, SI.
    ///
    /// # Errors
    /// If the formula is undefined, the table ends, or the value is negative.
    pub fn value(&self, at: &M::At<'_, f64>) -> Result<f64, Undefined> {
        let value = match &self.law {
            ScalarLaw::None => return Ok(0.0),
            ScalarLaw::Constant(value) => return Ok(*value),
            ScalarLaw::Formula(formula) => formula.value(|input| M::QUANTITIES[input].value(at))?,
            ScalarLaw::Table(lookup) => {
                let (value, place) = lookup.value(at)?;
                at.notes().check(&PLACE, place);
                value
            }
            ScalarLaw::Function(function, inputs) => {
                let inputs: Vec<Vec<f64>> = inputs.iter().map(|input| vec![input.value(at)]).collect();
                let mut value = [0.0];
                function.evaluate(&inputs, &mut value)?;
                let [value] = value;
                if !(0.0..=f64::MAX).contains(&value) {
                    return Err(Undefined {
                        what: "value of the function is negative or not finite",
                        value,
                    });
                }
                value
            }
        };
        if value < 0.0 {
            return Err(Undefined {
                what: "value of the formula or table is negative",
                value,
            });
        }
        Ok(self.unit.to_si(value))
    }

    /// The values at several points, SI.
    ///
    /// # Errors
    /// If one of them is undefined, or the law is a table: the points are then evaluated one by one.
    pub fn values(&self, at: &M::At<'_, Lane>) -> Result<Lane, Undefined> {
        Lane::wide(
            #[inline(always)]
            || self.inlined_values(at),
        )
    }

    /// The same, inlined into code that uses wide instructions.
    #[inline(always)]
    pub(crate) fn inlined_values(&self, at: &M::At<'_, Lane>) -> Result<Lane, Undefined> {
        match &self.law {
            ScalarLaw::None => Ok(Lane::ZERO),
            ScalarLaw::Constant(value) => Ok(Lane::constant(*value)),
            ScalarLaw::Formula(formula) => {
                let values: Lane = formula.evaluate(
                    #[inline(always)]
                    |input| M::QUANTITIES[input].values(at),
                );
                self.sound(values, at)
            }
            ScalarLaw::Function(function, inputs) => {
                let values = |lane: Lane| (0..LANES).map(|point| lane.at_point(point)).collect();
                let inputs: Vec<Vec<f64>> = inputs.iter().map(|input| values(input.values(at))).collect();
                let mut results = [0.0; LANES];
                function.evaluate(&inputs, &mut results)?;
                self.sound(Lane::each(|point| results[point]), at)
            }
            ScalarLaw::Table(_) => Err(Undefined::DISAGREED),
        }
    }

    /// Values in SI, if those of all points that are asked for are sound. Points that have left the batch, or are at rest, are not.
    #[inline(always)]
    fn sound(&self, values: Lane, at: &M::At<'_, Lane>) -> Result<Lane, Undefined> {
        let sound = values.is_within(0.0, f64::MAX);
        if sound.all() || at.notes().points() & !Lane::bits(sound) == 0 {
            Ok(values.map(|value| self.unit.to_si(value)))
        } else {
            Err(Undefined::DISAGREED)
        }
    }

    /// True if the law has the same value at every context.
    pub fn is_constant(&self) -> bool {
        self.constant().is_some()
    }

    /// The value of a law that has the same at every context, SI.
    pub fn constant(&self) -> Option<f64> {
        match self.law {
            ScalarLaw::None => Some(0.0),
            ScalarLaw::Constant(value) => Some(value),
            ScalarLaw::Formula(..) | ScalarLaw::Table(_) | ScalarLaw::Function(..) => None,
        }
    }

    /// True if the law has neither kinks nor jumps.
    pub fn is_smooth(&self) -> bool {
        match &self.law {
            ScalarLaw::None | ScalarLaw::Constant(_) => true,
            ScalarLaw::Formula(formula) => formula.is_smooth(),
            ScalarLaw::Table(_) | ScalarLaw::Function(..) => false,
        }
    }

    /// The value as a moment.
    ///
    /// # Errors
    /// As [`Scalar::value`].
    pub fn moment(&self, at: &M::At<'_, f64>) -> Result<Loss, Undefined> {
        Ok(Loss::MOMENTS.with(&M::TOTAL, self.value(at)?))
    }

    /// The value as a power.
    ///
    /// # Errors
    /// As [`Scalar::value`].
    pub fn power(&self, at: &M::At<'_, f64>) -> Result<Loss, Undefined> {
        Ok(Loss::POWERS.with(&M::TOTAL, self.value(at)?))
    }
}

limits! {
    /// Position of a point in a table: the first limit of every model that reads one.
    pub PLACE = ("s", "relative position in the table", "-", 0.0, 1.0,
        "the ends of the table");
}

/// A table over quantities of a mechanism's context, for models that read one.
pub struct Lookup<M: Mechanism> {
    /// One for each column of results.
    pub(crate) tables: Vec<Table>,
    pub(crate) axes: Vec<&'static Quantity<M>>,
}

impl<M: Mechanism> Lookup<M> {
    /// The sum of the results at a context, in the unit of the file, and the position of the context along the axis on which it is
    /// farthest outside.
    ///
    /// # Errors
    /// If the table ends.
    pub fn value(&self, at: &M::At<'_, f64>) -> Result<(f64, f64), Undefined> {
        let mut inputs = [0.0; 4];
        for ((value, input), axis) in inputs.iter_mut().zip(&self.axes).zip(self.tables[0].axes()) {
            *value = input.value(at);
            // A table over non-negative speeds applies to both directions of rotation.
            if input.least < 0.0 && input.unit.symbol == "rpm" && axis.values[0] >= 0.0 {
                *value = value.abs();
            }
        }
        let inputs = &inputs[..self.axes.len()];
        let mut sum = 0.0;
        for table in &self.tables {
            sum += table.value(inputs)?;
        }
        Ok((sum, self.tables[0].place(inputs)))
    }
}
