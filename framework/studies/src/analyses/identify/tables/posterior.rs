//! Table of the posterior of the parameters.

use super::super::outcome::IdentificationOfSet;
use super::UNIT;
use crate::table::Table;

/// The marginals of all sets, with the other intervals.
pub(in crate::analyses::identify) fn table(name: &str, all: &[IdentificationOfSet]) -> Table {
    Table::of_each(format!("{name}-posterior"), all, |o| {
        o.posterior.iter().flat_map(|posterior| &posterior.parameters)
    })
    .text("model_set", "Model set", |(o, _)| &o.model_set)
    .text("parameter", "Name of the parameter", |(_, parameter)| &parameter.name)
    .text("unit", "Unit of the values of this row", |(_, parameter)| {
        parameter.unit
    })
    .number("median", UNIT, "Median of the draws", |(_, parameter)| parameter.median)
    .ends(
        ["low", "high"],
        UNIT,
        "the 95 % interval of the draws",
        |(_, parameter)| parameter.interval,
    )
    .number(
        "standard_deviation",
        UNIT,
        "Standard deviation of the draws",
        |(_, parameter)| parameter.standard_deviation,
    )
    .ends(
        ["linearised_low", "linearised_high"],
        UNIT,
        "the 95 % interval of the linearised fit",
        |(_, parameter)| parameter.linearised,
    )
    .ends(
        ["profile_low", "profile_high"],
        UNIT,
        "the 95 % profile interval",
        |(_, parameter)| parameter.profile,
    )
    .fields("autocorrelation_steps independent_draws", |(_, parameter)| parameter)
    .finish()
}
