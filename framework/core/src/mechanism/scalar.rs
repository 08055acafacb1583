//! Laws with a single result, which serve every mechanism: a constant, a formula, a table over quantities of the context.
//!
//! [`crate::generic`] builds them from the parameters in a document.

use crate::document::Unit;
use crate::formula::Formula;
use crate::limits;
use crate::loss::{Loss, Undefined};
use crate::mechanism::{Inputs, Mechanism, Quantity};
use crate::table::Table;

/// Maximum number of quantities of a context, for the inputs of a formula.
const MOST_QUANTITIES: usize = 24;

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
    Formula(Formula),
    Table(Lookup<M>),
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
            ScalarLaw::Formula(formula) => {
                let mut inputs = [0.0; MOST_QUANTITIES];
                for (input, q) in inputs.iter_mut().zip(M::QUANTITIES) {
                    *input = q.unit().from_si((q.get)(at));
                }
                formula.value(&inputs[..M::QUANTITIES.len()])?
            }
            ScalarLaw::Table(lookup) => {
                let (value, place) = lookup.value(at)?;
                at.notes().check(&PLACE, place);
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

    /// True if the law has the same value at every context.
    pub fn is_constant(&self) -> bool {
        matches!(self.law, ScalarLaw::None | ScalarLaw::Constant(_))
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
    pub PLACE = ("position along the axis that is exceeded most, 0 and 1 are its ends", "-", 0.0, 1.0,
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
        for ((input, q), axis) in inputs.iter_mut().zip(&self.axes).zip(self.tables[0].axes()) {
            *input = q.unit().from_si((q.get)(at));
            // A table over non-negative speeds applies to both directions of rotation.
            if q.least < 0.0 && q.unit().symbol == "rpm" && axis.values[0] >= 0.0 {
                *input = input.abs();
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
