//! Drag of a planetary set as a power law of speed, viscosity and oil volume.

use crate::codes;
use gearloss_framework::document::{Diagnostic, Unit};
use gearloss_framework::table::{Reading, Table, columns};
use gearloss_numerics::fit::{PowerFit, power_law};

use crate::numbers::significant;

/// Axes of the power law with their units and the parameters for reference, exponent and range.
const AXES: [(&str, &str, [&str; 3]); 3] = [
    ("speed", "rpm", ["speed", "speed_exponent", "speeds"]),
    ("nu", "mm2/s", ["nu", "viscosity_exponent", "viscosities"]),
    ("volume", "ml", ["volume", "volume_exponent", "volumes"]),
];

/// A power law with the table that it was fitted to.
#[derive(Debug, Clone)]
pub struct DragLaw {
    /// The law.
    pub fit: PowerFit,
    /// Axes of the table: name and unit, such as `speed rpm`.
    pub axes: Vec<String>,
    /// Points of the table: a coordinate for each axis, and the moment. \[Nm\]
    pub points: Vec<(Vec<f64>, f64)>,
    /// Parameters of a model with this law, as a gearbox states them: `moment: 0.02 Nm`.
    pub parameters: Vec<String>,
}

impl DragLaw {
    /// Fits the law to the bytes of a table as drag models read it; moments in several columns are added up.
    ///
    /// # Errors
    /// If it is no such table, or its moments do not determine the law.
    pub fn of_table(bytes: &[u8]) -> Result<Self, Diagnostic> {
        let wrong = |fault: String| wrong(fault, "write the table in the format of the drag model `table`");
        let names = columns(bytes).map_err(wrong)?;
        let known = |name: &String| AXES.iter().find(|(axis, ..)| axis == name);
        let count = names.iter().take_while(|name| known(name).is_some()).count();
        for needed in ["speed", "nu"] {
            if !names[..count].iter().any(|name| name == needed) {
                return Err(self::wrong(
                    format!("line 1: no axis `{needed}`; there are: {}", names.join(", ")),
                    "give the table the axes `speed [rpm]`, `nu [mm2/s]` and, if relevant, `volume [ml]`",
                ));
            }
        }
        let tables = Table::several_from_file(bytes, &Reading::default(), count).map_err(wrong)?;
        for axis in tables[0].axes() {
            if let Some((_, unit, _)) = known(&axis.name).filter(|(_, unit, _)| !Unit::is_same(unit, &axis.unit)) {
                return Err(self::wrong(
                    format!("line 1: `{}` is in {}, not in {unit}", axis.name, axis.unit),
                    format!("convert it and write `{} [{unit}]`", axis.name),
                ));
            }
        }
        let mut points = tables[0].points();
        for more in &tables[1..] {
            for (point, (_, answer)) in points.iter_mut().zip(more.points()) {
                point.1 += answer;
            }
        }
        let fit = power_law(&points).map_err(|fault| {
            self::wrong(
                fault,
                "give every axis at least two values and every point a positive moment",
            )
        })?;
        if !fit.rms().is_finite() {
            let message = "the moments are too large, or differ too much, for a fit".to_owned();
            return Err(self::wrong(message, "check their unit"));
        }
        let mut parameters = vec![format!("moment: {} Nm", significant(fit.factor))];
        let mut ranges = Vec::new();
        for (k, axis) in tables[0].axes().iter().enumerate() {
            let Some((_, unit, [reference, exponent, range])) = known(&axis.name) else {
                continue;
            };
            parameters.push(format!("{reference}: {} {unit}", significant(fit.reference[k])));
            parameters.push(format!("{exponent}: {}", significant(fit.exponents[k])));
            let (least, greatest) = (axis.values[0], axis.values[axis.values.len() - 1]);
            ranges.push(format!("{range}: [{least} {unit}, {greatest} {unit}]"));
        }
        parameters.extend(ranges);
        let axes = tables[0].axes().iter();
        Ok(Self {
            fit,
            axes: axes.map(|axis| format!("{} {}", axis.name, axis.unit)).collect(),
            points,
            parameters,
        })
    }
}

fn wrong(message: String, help: impl Into<String>) -> Diagnostic {
    Diagnostic::error("", message).help(help).code(codes::DATA)
}
