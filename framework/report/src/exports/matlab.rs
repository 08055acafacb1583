//! Vectors for Simulink's gearbox blocks as a script.
//!
//! Source: documentation of the Powertrain Blockset's block Gearbox.

use gearloss_studies::analyses::map::{Axes, ExportFile, ExportFormat, ExportMap, LossGrid, MapOf, MapOfSet, Refusal};
use gearloss_studies::register_export;

use super::slabs::{GridTable, Slab, UNIT};

register_export!(Matlab);

struct Matlab;

impl ExportFormat for Matlab {
    fn name(&self) -> &'static str {
        "matlab"
    }

    fn takes(&self, _of: MapOf) -> Result<(), Refusal> {
        Ok(())
    }

    fn meaning(&self) -> &'static str {
        "Efficiency and loss torque over torque, speed and, if several were computed, oil temperature, as a script with the vectors \
         of Simulink's gearbox blocks."
    }

    fn fits(&self, axes: &Axes) -> Result<(), Refusal> {
        GridTable::fit(axes)
    }

    fn joins_temperatures(&self) -> bool {
        true
    }

    fn covered<'a>(&self, map: &ExportMap<'a>) -> Vec<&'a MapOfSet> {
        map.siblings.clone()
    }

    /// All temperatures of one table are in one file.
    fn file(&self, map: &ExportMap<'_>) -> Result<Option<ExportFile>, Refusal> {
        if map.number > 1 {
            return Ok(None);
        }
        let (text, about) = script(map)?;
        Ok(Some(ExportFile {
            name: format!("{}.m", map.shared_name()),
            bytes: text.into_bytes(),
            about,
        }))
    }
}

/// Numbers as elements of a vector.
fn list(values: impl Iterator<Item = f64>) -> String {
    values.map(|x| format!("{x}")).collect::<Vec<_>>().join(" ")
}

/// A table with one value for each grid point, with a third index if there are several temperatures.
fn table(
    name: &str,
    slabs: &[Slab],
    columns: &[usize],
    value: impl Fn(&LossGrid, usize, usize) -> Option<f64>,
) -> String {
    let mut text = String::new();
    for (k, slab) in slabs.iter().enumerate() {
        let index = if slabs.len() > 1 {
            format!("(:,:,{})", k + 1)
        } else {
            String::new()
        };
        text.push_str(&format!("{name}{index} = [\n"));
        for t in 0..slab.grid.axes.torques.len() {
            let row = columns.iter().map(|w| value(&slab.grid, t, *w).unwrap_or(0.0));
            text.push_str(&format!("  {};\n", list(row)));
        }
        text.push_str("];\n");
    }
    text
}

/// The script with the vectors of efficiency and loss torque, and its description.
fn script(map: &ExportMap<'_>) -> Result<(String, String), Refusal> {
    let tables = GridTable::new(&map.siblings)?;
    let (slabs, columns, about) = (&tables.slabs, &tables.columns, tables.about());
    let axes = tables.axes();
    // Without output power the efficiency is zero.
    let eta = table("eta_tbl", slabs, columns, LossGrid::efficiency);
    let loss = table("loss_tbl", slabs, columns, LossGrid::loss_torque);
    let temperatures = if slabs.len() > 1 {
        let kelvin = slabs.iter().filter_map(|slab| Some(slab.oil? + 273.15));
        format!("Temp_bpts = [{}]; % K\n", list(kelvin))
    } else {
        String::new()
    };
    let mut unit = String::new();
    if !tables.unit_columns.is_empty() {
        let meanings = UNIT.map(|(name, meaning, _)| format!("{name}_tbl: {meaning}"));
        unit = format!(
            "% Over Trq_bpts and omega_unit_bpts: {}.\nomega_unit_bpts = [{}]; % rad/s\n",
            meanings.join("; "),
            list(tables.unit_speeds().into_iter())
        );
        for (name, _, read) in UNIT {
            let value = |grid: &LossGrid, t: usize, w: usize| read(grid.loss(t, w)?);
            unit.push_str(&table(&format!("{name}_tbl"), slabs, &tables.unit_columns, value));
        }
    }
    let meaning = if tables.of.is_gearbox() {
        "power out over power in, drive and coast"
    } else {
        "power that passes over the power of the DC link, while generating the reciprocal, zero if no power passes"
    };
    let text = format!(
        "% Losses{} of gear {}, by gearloss {}. {about}.\n% eta_tbl: {meaning}; loss_tbl: loss over the speed of the reference port, Nm; \
         rows are torques, columns are speeds.\nTrq_bpts = [{}]; % Nm\nomega_bpts = [{}]; % rad/s\n{temperatures}{eta}{loss}{unit}",
        tables.of.words(),
        map.map.gear,
        env!("CARGO_PKG_VERSION"),
        list(axes.torques.iter().copied()),
        list(columns.iter().map(|w| axes.speeds[*w])),
    );
    Ok((text, about))
}
