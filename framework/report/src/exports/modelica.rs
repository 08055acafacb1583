//! Tables for `CombiTable2Ds` of the Modelica Standard Library, as text.
//!
//! Source: documentation of `Modelica.Blocks.Tables.CombiTable2Ds`: first line `#1`, then `double name(rows,columns)` and the rows; the
//! first column has the first input, the first row the second one.

use gearloss_studies::analyses::map::{ExportFile, ExportFormat, ExportMap, LossGrid, Refusal};
use gearloss_studies::numbers::tidy;
use gearloss_studies::register_export;

use super::slabs::{GridTable, Slab, UNIT, of_all_maps};

register_export!(Modelica);

struct Modelica;

impl ExportFormat for Modelica {
    fn name(&self) -> &'static str {
        "modelica"
    }

    fn meaning(&self) -> &'static str {
        "Loss torque and loss over torque and speed for `CombiTable2Ds` of the Modelica Standard Library, one table for each oil \
         temperature, and the no-load loss over speed and oil temperature."
    }

    of_all_maps!();

    fn file(&self, map: &ExportMap<'_>) -> Result<Option<ExportFile>, Refusal> {
        if map.number > 1 {
            return Ok(None);
        }
        let tables = GridTable::new(&map.siblings)?;
        let about = tables.about();
        Ok(Some(ExportFile {
            name: format!("{}.txt", map.shared_name()),
            bytes: text(&tables, &map.map.gear, &about).into_bytes(),
            about,
        }))
    }
}

/// All tables.
fn text(tables: &GridTable, gear: &str, about: &str) -> String {
    let mut text = format!(
        "#1\n# Losses{} of gear {gear}, by gearloss {}. {about}.\n# loss_torque: Nm over torque (Nm, rows) and speed (rad/s, columns) of the reference \
         port. loss_power: the same in W, with standstill.\n",
        tables.of.words(),
        env!("CARGO_PKG_VERSION")
    );
    if !tables.of.is_gearbox() {
        let meanings = UNIT.map(|(name, meaning, _)| format!("{name}: {meaning}"));
        text.push_str(&format!(
            "# Over torque and speed, with standstill if it was computed: {}; efficiency: power that passes over the power of the DC link, while \
             generating the reciprocal, zero if no power passes.\n",
            meanings.join("; ")
        ));
    }
    let several = tables.slabs.len() > 1;
    if several {
        text.push_str("# The number behind a name is that of the oil temperature. no_load_torque: Nm over speed (rad/s, rows) and oil temperature (degC, columns).\n");
    }
    let (torques, speeds) = (&tables.axes().torques, tables.speeds());
    for (number, slab) in (1..).zip(&tables.slabs) {
        let suffix = if several { format!("_{number}") } else { String::new() };
        if let Some(oil) = slab.oil {
            text.push_str(&format!("# {number}: oil at {} degC\n", tidy(oil)));
        }
        let loss = |t: usize, c: usize| slab.grid.loss_torque(t, tables.columns[c]).unwrap_or(0.0);
        add(&mut text, &format!("loss_torque{suffix}"), torques, &speeds, loss);
        if tables.of.is_gearbox() {
            let (with_standstill, first) = from_standstill(&speeds);
            let power = |t: usize, c: usize| {
                if c < first {
                    0.0
                } else {
                    loss(t, c - first) * speeds[c - first].abs()
                }
            };
            add(
                &mut text,
                &format!("loss_power{suffix}"),
                torques,
                &with_standstill,
                power,
            );
        } else {
            let of_unit = |name: &str, value: &dyn Fn(&LossGrid, usize, usize) -> Option<f64>| {
                let mut table = String::new();
                let at = |t: usize, c: usize| value(&slab.grid, t, tables.unit_columns[c]).unwrap_or(0.0);
                add(
                    &mut table,
                    &format!("{name}{suffix}"),
                    torques,
                    &tables.unit_speeds(),
                    at,
                );
                table
            };
            for (name, _, read) in UNIT {
                text.push_str(&of_unit(name, &|grid, t, w| read(grid.loss(t, w)?)));
            }
            text.push_str(&of_unit("efficiency", &LossGrid::efficiency));
        }
        if slab.oil.is_none() {
            let oil = |t: usize, c: usize| {
                slab.grid
                    .loss(t, tables.columns[c])
                    .and_then(|loss| loss.oil)
                    .unwrap_or(0.0)
            };
            text.push_str("# Oil temperature at the heat balance, degC.\n");
            add(&mut text, "oil_temperature", torques, &speeds, oil);
        }
    }
    if let (true, Some(zero)) = (several, torques.iter().position(|torque| *torque == 0.0)) {
        let oils: Vec<f64> = tables.slabs.iter().filter_map(|slab| slab.oil).collect();
        let drag = |c: usize, k: usize| {
            let slab: &Slab = &tables.slabs[k];
            slab.grid.loss_torque(zero, tables.columns[c]).unwrap_or(0.0)
        };
        add(&mut text, "no_load_torque", &speeds, &oils, drag);
    }
    text
}

/// Speeds with standstill before them unless one is not above it, and their number before those of the table.
fn from_standstill(speeds: &[f64]) -> (Vec<f64>, usize) {
    if speeds.first().is_some_and(|first| *first > 0.0) {
        (std::iter::once(0.0).chain(speeds.iter().copied()).collect(), 1)
    } else {
        (speeds.to_vec(), 0)
    }
}

/// Adds a table.
fn add(text: &mut String, name: &str, rows: &[f64], columns: &[f64], value: impl Fn(usize, usize) -> f64) {
    text.push_str(&format!("double {name}({},{})\n0", rows.len() + 1, columns.len() + 1));
    for column in columns {
        text.push_str(&format!(" {column}"));
    }
    for (i, row) in rows.iter().enumerate() {
        text.push_str(&format!("\n{row}"));
        for k in 0..columns.len() {
            text.push_str(&format!(" {}", value(i, k)));
        }
    }
    text.push('\n');
}
