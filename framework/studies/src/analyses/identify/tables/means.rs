//! Table of the means over cycles.

use super::super::outcome::IdentificationOfSet;
use super::UNIT;
use crate::table::Table;

/// One row for each mean of each set.
pub(in crate::analyses::identify) fn table(name: &str, all: &[IdentificationOfSet]) -> Table {
    Table::of_each(format!("{name}-means"), all, |o| &o.means)
        .text("model_set", "Model set", |(o, _)| &o.model_set)
        .text("mean", "Name of the mean", |(_, mean)| &mean.name)
        .text("unit", "Unit of the values of this row", |(_, mean)| mean.unit)
        .fields_in(UNIT, "from to accuracy model_before model", |(_, mean)| mean)
        .fields("residual_before residual leverage", |(_, mean)| mean)
        .finish()
}
