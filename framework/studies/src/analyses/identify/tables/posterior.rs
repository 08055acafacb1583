//! Table of the posterior of the parameters.

use super::super::outcome::IdentificationOfSet;
use crate::cells;
use crate::table::{Column, Table};

/// The marginals of all sets, with the other intervals.
pub(in crate::analyses::identify) fn table(name: &str, all: &[IdentificationOfSet]) -> Table {
    const UNIT: &str = "mixed";
    let mut table = Table::new(
        format!("{name}-posterior"),
        [
            Column::text("model_set", "Model set"),
            Column::text("parameter", "Name of the parameter"),
            Column::text("unit", "Unit of the values of this row"),
            Column::number("median", UNIT, "Median of the draws"),
            Column::number("low", UNIT, "Lower end of the 95 % interval of the draws"),
            Column::number("high", UNIT, "Upper end of the 95 % interval of the draws"),
            Column::number("standard_deviation", UNIT, "Standard deviation of the draws"),
            Column::number(
                "linearised_low",
                UNIT,
                "Lower end of the 95 % interval of the linearised fit",
            ),
            Column::number(
                "linearised_high",
                UNIT,
                "Upper end of the 95 % interval of the linearised fit",
            ),
            Column::number("profile_low", UNIT, "Lower end of the 95 % profile interval"),
            Column::number("profile_high", UNIT, "Upper end of the 95 % profile interval"),
            Column::number("autocorrelation_steps", "-", "Integrated autocorrelation time in steps"),
            Column::number("independent_draws", "-", "Effective number of independent draws"),
        ],
    );
    for o in all {
        for p in o.posterior.iter().flat_map(|posterior| &posterior.parameters) {
            table.push(cells![
                &o.model_set,
                &p.name,
                p.unit,
                p.median,
                p.interval[0],
                p.interval[1],
                p.standard_deviation,
                p.linearised.map(|ends| ends[0]),
                p.linearised.map(|ends| ends[1]),
                p.profile.map(|ends| ends[0]),
                p.profile.map(|ends| ends[1]),
                p.autocorrelation_steps,
                p.independent_draws,
            ]);
        }
    }
    table
}
