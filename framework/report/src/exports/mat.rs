//! The vectors of Simulink's gearbox blocks as a MAT-file of level 5, which every MATLAB, Octave and SciPy reads.
//!
//! Source: MathWorks, MAT-File Format, level 5: header of 128 bytes, then a matrix of doubles for each variable, little-endian, each part
//! aligned to eight bytes, columns first.

use gearloss_studies::analyses::map::{Axes, ExportFile, ExportFormat, ExportMap, LossGrid, MapOf, MapOfSet, Refusal};
use gearloss_studies::register_export;

use super::slabs::{GridTable, Slab, UNIT};

register_export!(Mat);

struct Mat;

impl ExportFormat for Mat {
    fn name(&self) -> &'static str {
        "mat"
    }

    fn takes(&self, _of: MapOf) -> Result<(), Refusal> {
        Ok(())
    }

    fn meaning(&self) -> &'static str {
        "The vectors of `matlab` as a MAT-file, with the oil temperature of each point if it follows from a heat balance."
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

    fn file(&self, map: &ExportMap<'_>) -> Result<Option<ExportFile>, Refusal> {
        if map.number > 1 {
            return Ok(None);
        }
        let tables = GridTable::new(&map.siblings)?;
        let name = format!("{}.mat", map.shared_name());
        let bytes = file(&tables, &map.map.gear).ok_or_else(|| {
            Refusal::new(
                "a matrix of a MAT-file of level 5 has at most 4 GB",
                "give the grid fewer points",
            )
        })?;
        Ok(Some(ExportFile {
            name,
            bytes,
            about: tables.about(),
        }))
    }
}

/// Types of data.
const INT8: u32 = 1;
const INT32: u32 = 5;
const UINT32: u32 = 6;
const DOUBLE: u32 = 9;
const MATRIX: u32 = 14;
/// Class of a matrix of doubles.
const CLASS: u32 = 6;

/// The file; absent if a matrix is too large.
fn file(tables: &GridTable, gear: &str) -> Option<Vec<u8>> {
    let about = format!(
        "MATLAB 5.0 MAT-file, losses of gear {gear}, by gearloss {}",
        env!("CARGO_PKG_VERSION")
    );
    // The header is text of one byte for each character.
    let text = about
        .chars()
        .map(|c| if c.is_ascii() && !c.is_control() { c as u8 } else { b'_' });
    let mut bytes: Vec<u8> = text.chain(std::iter::repeat(b' ')).take(116).collect();
    bytes.extend([0; 8]);
    bytes.extend([0x00, 0x01, b'I', b'M']);
    let (torques, speeds) = (&tables.axes().torques, tables.speeds());
    let (rows, slabs, columns) = (torques.len(), tables.slabs.len(), &tables.columns);
    add(&mut bytes, "Trq_bpts", &[1, rows], torques)?;
    add(&mut bytes, "omega_bpts", &[1, speeds.len()], &speeds)?;
    let kelvin: Vec<f64> = tables
        .slabs
        .iter()
        .filter_map(|slab| Some(slab.oil? + 273.15))
        .collect();
    let size: &[usize] = if slabs > 1 {
        add(&mut bytes, "Temp_bpts", &[1, slabs], &kelvin)?;
        &[rows, speeds.len(), slabs]
    } else {
        &[rows, speeds.len()]
    };
    // Without output power the efficiency is zero.
    add(
        &mut bytes,
        "eta_tbl",
        size,
        &values(tables, columns, LossGrid::efficiency),
    )?;
    add(
        &mut bytes,
        "loss_tbl",
        size,
        &values(tables, columns, LossGrid::loss_torque),
    )?;
    if tables.slabs[0].oil.is_none() {
        let oil = |grid: &LossGrid, t: usize, w: usize| Some(grid.loss(t, w)?.oil? + 273.15);
        add(&mut bytes, "oil_tbl", size, &values(tables, columns, oil))?;
    }
    if !tables.unit_columns.is_empty() {
        let columns = &tables.unit_columns;
        add(
            &mut bytes,
            "omega_unit_bpts",
            &[1, columns.len()],
            &tables.unit_speeds(),
        )?;
        let mut size = size.to_vec();
        size[1] = columns.len();
        for (name, _, read) in UNIT {
            let value = |grid: &LossGrid, t: usize, w: usize| read(grid.loss(t, w)?);
            add(
                &mut bytes,
                &format!("{name}_tbl"),
                &size,
                &values(tables, columns, value),
            )?;
        }
    }
    Some(bytes)
}

/// The values at all torques and some speeds, columns first.
fn values(tables: &GridTable, columns: &[usize], value: impl Fn(&LossGrid, usize, usize) -> Option<f64>) -> Vec<f64> {
    let rows = tables.axes().torques.len();
    let of_slab = |slab: &Slab| -> Vec<f64> {
        let places = columns.iter().flat_map(|w| (0..rows).map(move |t| (t, *w)));
        places.map(|(t, w)| value(&slab.grid, t, w).unwrap_or(0.0)).collect()
    };
    tables.slabs.iter().flat_map(of_slab).collect()
}

/// Adds a variable; `None` if it is too large.
fn add(bytes: &mut Vec<u8>, name: &str, size: &[usize], values: &[f64]) -> Option<()> {
    let mut matrix = Vec::new();
    let part = |to: &mut Vec<u8>, kind: u32, data: Vec<u8>| {
        to.extend(kind.to_le_bytes());
        to.extend(u32::try_from(data.len()).ok()?.to_le_bytes());
        to.extend(data);
        to.resize(to.len().next_multiple_of(8), 0);
        Some(())
    };
    part(&mut matrix, UINT32, [CLASS.to_le_bytes(), [0; 4]].concat())?;
    let size: Option<Vec<i32>> = size.iter().map(|n| i32::try_from(*n).ok()).collect();
    part(&mut matrix, INT32, size?.iter().flat_map(|n| n.to_le_bytes()).collect())?;
    part(&mut matrix, INT8, name.as_bytes().to_vec())?;
    part(
        &mut matrix,
        DOUBLE,
        values.iter().flat_map(|x| x.to_le_bytes()).collect(),
    )?;
    part(bytes, MATRIX, matrix)
}
