//! The gear over speed and torque of the wheels, from a file.

use gearloss_framework::document::data::missing::CELL_HELP;
use gearloss_framework::document::data::sheet::{Sheet, Wanted, limited_faults};
use gearloss_framework::document::data::{MeasuredFault, TableFile, fault};

const SPEED: usize = 0;
const TORQUE: usize = 1;
const GEAR: usize = 2;

const QUANTITIES: [Wanted<'static>; 3] = [("speed", "rpm"), ("torque", "Nm"), ("gear", "")];

/// Gears over a grid: each applies from its speed and torque up to the next ones, the first ones also below.
#[derive(Debug, Clone, PartialEq)]
pub struct ShiftMap {
    /// Speeds of the wheels, ascending. \[rad/s\]
    speeds: Vec<f64>,
    /// Torques of the wheels, ascending, negative while braking. \[Nm\]
    torques: Vec<f64>,
    /// Gears by speed, then torque.
    gears: Vec<String>,
    /// The line of the first row of each gear.
    lines: Vec<(String, u64)>,
}

impl ShiftMap {
    /// Reads the bytes of a file with `speed [rpm]`, `torque [Nm]` and `gear`.
    ///
    /// # Errors
    /// The problem, with line and column.
    pub fn read(file: &TableFile, bytes: &[u8]) -> Result<Self, Vec<MeasuredFault>> {
        let stated = file.stated();
        let sheet = Sheet::open(bytes, &stated.form, &QUANTITIES, stated.assigned())?;
        Self::from_sheet(&sheet).map_err(|faults| sheet.table.placed(faults))
    }

    fn from_sheet(sheet: &Sheet) -> Result<Self, Vec<MeasuredFault>> {
        let lacking = QUANTITIES.iter().enumerate().filter(|(place, _)| !sheet.holds(*place));
        let lacking: Vec<MeasuredFault> = lacking
            .map(|(_, (name, _))| sheet.lacks(&format!("the {name}"), name))
            .collect();
        if !lacking.is_empty() {
            return Err(lacking);
        }
        let mut faulty = Vec::new();
        let mut rows = Vec::new();
        for row in 0..sheet.table.rows.len() {
            match cells(sheet, row) {
                Ok(cells) => rows.push(cells),
                Err(reason) => faulty.push(reason),
            }
        }
        if !faulty.is_empty() {
            return Err(limited_faults(faulty, CELL_HELP));
        }
        let speeds = rising(rows.iter().map(|row| row.speed));
        let torques = rising(rows.iter().map(|row| row.torque));
        let mut cells: Vec<Option<&Row>> = vec![None; speeds.len() * torques.len()];
        for row in &rows {
            let place = below(&speeds, row.speed) * torques.len() + below(&torques, row.torque);
            if let Some(first) = cells[place] {
                let message = format!(
                    "line {}: this speed and torque are already in line {}",
                    row.line, first.line
                );
                return Err(vec![fault(message, "remove one of them")]);
            }
            cells[place] = Some(row);
        }
        if let Some(place) = cells.iter().position(Option::is_none) {
            let (speed, torque) = (speeds[place / torques.len()], torques[place % torques.len()]);
            let message = format!(
                "there is no gear at {} rpm and {torque} Nm, but at other torques of this speed",
                crate::numbers::tidy(speed * crate::numbers::RPM)
            );
            return Err(vec![fault(message, "write a gear for the same torques at each speed")]);
        }
        let mut lines: Vec<(String, u64)> = Vec::new();
        for row in &rows {
            if lines.iter().all(|(gear, _)| *gear != row.gear) {
                lines.push((row.gear.clone(), row.line));
            }
        }
        Ok(Self {
            gears: cells.into_iter().flatten().map(|row| row.gear.clone()).collect(),
            speeds,
            torques,
            lines,
        })
    }

    /// The gear at a speed (rad/s) and a torque (Nm) of the wheels.
    pub fn gear(&self, speed: f64, torque: f64) -> &str {
        let place = below(&self.speeds, speed) * self.torques.len() + below(&self.torques, torque);
        self.gears.get(place).map_or("", String::as_str)
    }

    /// Its gears with the line of the first row of each.
    pub fn gears(&self) -> &[(String, u64)] {
        &self.lines
    }
}

/// A row of the file.
struct Row {
    line: u64,
    speed: f64,
    torque: f64,
    gear: String,
}

fn cells(sheet: &Sheet, row: usize) -> Result<Row, String> {
    let empty = |what: usize| format!("{}: the cell is empty", sheet.describe_cell(row, what));
    Ok(Row {
        line: sheet.line(row),
        speed: sheet.not_negative(row, SPEED)?.ok_or_else(|| empty(SPEED))?,
        torque: sheet.number(row, TORQUE)?.ok_or_else(|| empty(TORQUE))?,
        gear: sheet.text(row, GEAR).ok_or_else(|| empty(GEAR))?.to_owned(),
    })
}

/// The distinct values, ascending.
fn rising(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.dedup_by(|b, a| (*b - *a).abs() <= 1e-9 * a.abs());
    values
}

/// Index of the greatest value that is not above x, or of the first. Values of one grid differ by more than rounding.
fn below(values: &[f64], x: f64) -> usize {
    values
        .partition_point(|value| *value <= x + 1e-9 * x.abs())
        .saturating_sub(1)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn read(text: &str) -> Result<ShiftMap, Vec<MeasuredFault>> {
        ShiftMap::read(&TableFile::Name("shift.csv".to_owned()), text.as_bytes())
    }

    #[test]
    fn a_row_applies_up_to_the_next_speed_and_torque() {
        let text = "speed [rpm],torque [Nm],gear\n0,-500,second\n0,0,first\n300,-500,second\n300,0,second\n";
        let map = read(text).unwrap();
        let rpm = std::f64::consts::PI / 30.0;
        for (speed, torque, gear) in [
            (0.0, 0.0, "first"),
            (299.0, 900.0, "first"),
            (300.0, 900.0, "second"),
            (1000.0, 10.0, "second"),
            (100.0, -1.0, "second"),
            (100.0, -900.0, "second"),
        ] {
            assert_eq!(map.gear(speed * rpm, torque), gear, "{speed} rpm, {torque} Nm");
        }
        assert_eq!(map.gears(), [("second".to_owned(), 2), ("first".to_owned(), 3)]);
    }

    #[test]
    fn faults_name_their_place() {
        let message = |text: &str| read(text).unwrap_err()[0].message.clone();
        let twice = message("speed [rpm],torque [Nm],gear\n0,0,a\n0,0,b\n");
        assert!(twice.contains("line 3") && twice.contains("line 2"), "{twice}");
        let gap = message("speed [rpm],torque [Nm],gear\n0,0,a\n0,10,b\n100,0,a\n");
        assert!(gap.contains("100 rpm and 10 Nm"), "{gap}");
        let column = message("speed [rpm],torque [Nm]\n0,0\n");
        assert!(column.contains("gear"), "{column}");
        let empty = message("speed [rpm],torque [Nm],gear\n0,0,\n");
        assert!(empty.contains("line 2"), "{empty}");
    }
}
