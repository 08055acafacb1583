//! `fit power-law`: drag of planets over speed, viscosity and volume.

use std::path::Path;

use gearloss_framework::files::{LONGEST_DATA, read_text};
use gearloss_framework::table::{Reading, Table, columns};
use gearloss_numerics::fit::power_law;

use crate::output::{End, Failure, Out, Table as Printed, significant};

/// Axes of the power law with their units and the parameters for reference, exponent and range.
const AXES: [(&str, &str, [&str; 3]); 3] = [
    ("speed", "rpm", ["speed", "speed_exponent", "speeds"]),
    ("nu", "mm2/s", ["nu", "viscosity_exponent", "viscosities"]),
    ("volume", "ml", ["volume", "volume_exponent", "volumes"]),
];

pub fn run(path: &Path, out: &mut Out) -> Result<End, Failure> {
    let file = path.display().to_string();
    let wrong = |fault: String| {
        Failure::input(
            format!("{file}: {fault}"),
            "write the table in the format of the drag model `table`",
        )
    };
    let text = read_text(path, LONGEST_DATA)
        .map_err(|e| Failure::input(format!("cannot read {file}: {e}"), "check the file name"))?;
    let names = columns(&text).map_err(wrong)?;
    let known = |name: &String| AXES.iter().find(|(axis, ..)| axis == name);
    let count = names.iter().take_while(|name| known(name).is_some()).count();
    for needed in ["speed", "nu"] {
        if !names[..count].iter().any(|name| name == needed) {
            return Err(Failure::input(
                format!("{file}: line 1: no axis `{needed}`; there are: {}", names.join(", ")),
                "give the table the axes `speed [rpm]`, `nu [mm2/s]` and, if relevant, `volume [ml]`",
            ));
        }
    }
    let tables = Table::several_from_csv(&text, &Reading::default(), count).map_err(wrong)?;
    for axis in tables[0].axes() {
        if let Some((_, unit, _)) = known(&axis.name).filter(|(_, unit, _)| *unit != axis.unit) {
            return Err(Failure::input(
                format!("{file}: line 1: `{}` is in {}, not in {unit}", axis.name, axis.unit),
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
        Failure::input(
            format!("{file}: {fault}"),
            "give every axis at least two values and every point a positive moment",
        )
    })?;
    if !fit.rms().is_finite() {
        return Err(Failure::input(
            format!("{file}: the moments are too large, or differ too much, for a fit"),
            "check their unit",
        ));
    }
    let mut words = vec![
        "type: power_law".to_owned(),
        format!("moment: {} Nm", significant(fit.factor)),
    ];
    let mut ranges = Vec::new();
    for (k, axis) in tables[0].axes().iter().enumerate() {
        let Some((_, unit, [reference, exponent, range])) = known(&axis.name) else {
            continue;
        };
        words.push(format!("{reference}: {} {unit}", significant(fit.reference[k])));
        words.push(format!("{exponent}: {}", significant(fit.exponents[k])));
        let (least, greatest) = (axis.values[0], axis.values[axis.values.len() - 1]);
        ranges.push(format!("{range}: [{least} {unit}, {greatest} {unit}]"));
    }
    words.extend(ranges);
    out.line(format!("model: {{ {} }}", words.join(", ")))?;
    out.line(format!(
        "\n{} points, residuals: rms {:.2} %, max {:.2} %",
        points.len(),
        100.0 * fit.rms(),
        100.0 * fit.worst()
    ))?;
    let mut head: Vec<String> = tables[0]
        .axes()
        .iter()
        .map(|a| format!("{} {}", a.name, a.unit))
        .collect();
    head.extend(["table Nm", "law Nm", "residual %"].map(str::to_owned));
    let mut printed = Printed::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
    for ((point, answer), residual) in points.iter().zip(&fit.residuals) {
        let mut row: Vec<String> = point.iter().map(|x| format!("{x}")).collect();
        row.push(significant(*answer));
        row.push(significant(fit.value(point)));
        row.push(format!("{:.2}", 100.0 * residual));
        printed.row(row);
    }
    out.text(&printed.render())?;
    Ok(End::Fine)
}
