//! Shares over the plane of action from a file.

use super::{Coordinate, Flank, Knots, LoadedShares, SharingFault};
use crate::geometry::{Pair, ShareRow, ShareTable};
use crate::table::{Axis, Outside, Reading, Table};

/// Greatest difference of the sum of all shares from one that is corrected.
const CORRECTED: f64 = 0.02;

/// Phases at which the sum is checked, and places on the face between which a mean is taken.
const PHASES: usize = 200;
const FACES: usize = 40;

const COLUMNS: &str = "the columns are `flank` (absent: valid for both flanks), `torque [Nm]` (absent: valid for every torque), `path [-]` from 0 \
                       to 1, `face [-]` from 0 to 1 (absent: the mean over the face), and `share [-]` or `line load [N/mm]`, in this order";

/// The file of a pair.
struct Imported<'a> {
    pair: &'a Pair,
    table: Table,
    /// Positions of torque, path and face among the axes.
    torque: Option<usize>,
    path: usize,
    face: Option<usize>,
    /// True for a line load in N/mm, false for a share.
    is_line_load: bool,
}

impl Imported<'_> {
    /// Share at a place, over that of one pair alone. Torque in N m, path and face from 0 to 1.
    fn value(&self, torque: f64, path: f64, face: f64) -> f64 {
        if !(0.0..=1.0).contains(&path) {
            return 0.0;
        }
        let mut point = [0.0; 3];
        let axes = self.table.axes().len();
        for (axis, x) in [(self.torque, torque), (Some(self.path), path), (self.face, face)] {
            if let Some(axis) = axis {
                point[axis] = x;
            }
        }
        let value = self.table.value(&point[..axes]).unwrap_or(0.0);
        if self.is_line_load {
            let force = torque / self.pair.base_radius[0];
            value * 1e3 * self.pair.facewidth / force
        } else {
            value
        }
    }

    /// Values along the face at a place of the path.
    fn along_the_face(&self, torque: f64, path: f64) -> Vec<f64> {
        match self.face {
            None => vec![self.value(torque, path, 0.5)],
            Some(_) => (0..FACES)
                .map(|i| self.value(torque, path, (i as f64 + 0.5) / FACES as f64))
                .collect(),
        }
    }

    /// Sum of the shares of all pairs at a phase from zero to one.
    fn sum(&self, torque: f64, phase: f64) -> f64 {
        let ratio = self.pair.contact_ratio;
        let lean = self.pair.facewidth * self.pair.base_helix.tan() / self.pair.base_pitch;
        let most = (ratio + lean).ceil() as usize + 1;
        let faces = if self.face.is_some() { FACES } else { 1 };
        let of = |i: usize| {
            let face = (i as f64 + 0.5) / faces as f64;
            let pairs = (0..=most).map(|k| (phase + k as f64 - face * lean) / ratio);
            pairs.map(|path| self.value(torque, path, face)).sum::<f64>()
        };
        (0..faces).map(of).sum::<f64>() / faces as f64
    }

    /// Greatest distance between two rows along the path, in phases.
    fn spacing(&self) -> usize {
        let paths = &self.table.axes()[self.path].values;
        let most = paths.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
        ((most * self.pair.contact_ratio * PHASES as f64).ceil() as usize).min(PHASES / 4)
    }

    fn table(&self, torque: f64) -> ShareTable {
        let [start, .., end] = self.pair.points;
        let mut paths = self.table.axes()[self.path].values.clone();
        paths.extend(self.pair.breaks().iter().map(|x| (x - start) / (end - start)));
        paths.extend([0.0, 1.0]);
        paths.retain(|path| (0.0..=1.0).contains(path));
        paths.sort_by(f64::total_cmp);
        paths.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
        let row = |path: f64| {
            let values = self.along_the_face(torque, path);
            let sum: f64 = values.iter().sum();
            let fifth = values.iter().map(|v| v.max(0.0).powf(1.2)).sum::<f64>() / sum;
            ShareRow {
                x: start + path * (end - start),
                share: sum / values.len() as f64,
                line: if sum > 0.0 { fifth.powi(5) } else { 0.0 },
                peak: values.iter().copied().fold(0.0, f64::max),
            }
        };
        ShareTable::new(paths.into_iter().map(row).collect())
    }
}

/// A column by the words that its name may have, among the axes.
fn axis(axes: &[Axis], name: &str, units: &[&str]) -> Result<Option<usize>, String> {
    let found = axes.iter().position(|axis| axis.name == name);
    if let Some(axis) = found.map(|i| &axes[i])
        && !units.contains(&axis.unit.as_str())
    {
        return Err(format!("column `{name} [{}]`: the unit is {}", axis.unit, units[0]));
    }
    Ok(found)
}

/// The table of a flank; `None` for the coast flank of a file that has none of its own.
fn table_of(bytes: &[u8], flank: Flank) -> Result<Option<Table>, String> {
    let reading = Reading {
        outside: Outside::Clamp,
        ..Reading::default()
    };
    let tables = Table::by_word(bytes, &reading, "flank")?;
    let wanted = match flank {
        Flank::Drive => "drive",
        Flank::Coast => "coast",
    };
    let known = |word: &str| ["", "drive", "coast"].contains(&word);
    if let Some((word, _)) = tables.iter().find(|(word, _)| !known(word)) {
        return Err(format!("the flank `{word}` is neither `drive` nor `coast`"));
    }
    let is_wanted = |word: &str| word == wanted || (flank == Flank::Drive && word.is_empty());
    match tables.into_iter().find(|(word, _)| is_wanted(word)) {
        Some((_, table)) => Ok(Some(table)),
        None if flank == Flank::Coast => Ok(None),
        None => Err("there is no row of the flank `drive`".to_owned()),
    }
}

fn read<'a>(pair: &'a Pair, bytes: &[u8], table: Table) -> Result<Imported<'a>, String> {
    let names = crate::table::columns(bytes)?;
    let torque = axis(table.axes(), "torque", &["Nm"])?;
    let Some(path) = axis(table.axes(), "path", &["-"])? else {
        return Err("there is no column `path [-]`".to_owned());
    };
    let face = axis(table.axes(), "face", &["-"])?;
    let known = [torque, Some(path), face];
    if let Some(other) = (0..table.axes().len()).find(|i| !known.contains(&Some(*i))) {
        return Err(format!("the column `{}` is not known", table.axes()[other].name));
    }
    let last = names.last().map_or("", String::as_str);
    let is_line_load = match (last, table.unit()) {
        ("share", Some("-")) => false,
        ("line load", Some("N/mm")) => true,
        (name, unit) => {
            let unit = unit.unwrap_or("no unit");
            return Err(format!(
                "the last column `{name}` [{unit}] is neither `share [-]` nor `line load [N/mm]`"
            ));
        }
    };
    if is_line_load && torque.is_none() {
        return Err("a line load requires the torque at which it is: there is no column `torque [Nm]`".to_owned());
    }
    for axis in [Some(path), face].into_iter().flatten().map(|i| &table.axes()[i]) {
        if let Some(outside) = axis.values.iter().find(|x| !(0.0..=1.0).contains(*x)) {
            return Err(format!("`{}` is {outside}, not from 0 to 1", axis.name));
        }
    }
    if let Some(axis) = torque.map(|i| &table.axes()[i])
        && axis.values[0] <= 0.0
    {
        return Err(format!("`torque` is {}, not positive", axis.values[0]));
    }
    if let Some((point, value)) = table.points().into_iter().find(|(_, value)| *value < 0.0) {
        return Err(format!("the load {value} at {point:?} is negative: teeth do not pull"));
    }
    Ok(Imported {
        pair,
        table,
        torque,
        path,
        face,
        is_line_load,
    })
}

/// The shares of a file for a flank of a pair; `None` for the coast flank of a file that has none of its own.
pub(super) fn shares(
    pair: &Pair,
    name: &str,
    bytes: &[u8],
    flank: Flank,
) -> Result<Option<LoadedShares>, SharingFault> {
    if !pair.involute {
        return Err(SharingFault::of_file(
            "a file of shares describes involute teeth, and this mesh has none",
            "state the tip diameter of the ring, or choose another load sharing",
        ));
    }
    let wrong = |fault: String| SharingFault::of_file(format!("{name}: {fault}"), COLUMNS);
    let Some(table) = table_of(bytes, flank).map_err(wrong)? else {
        return Ok(None);
    };
    let imported = read(pair, bytes, table).map_err(wrong)?;
    let torques = imported
        .torque
        .map_or_else(|| vec![1.0], |i| imported.table.axes()[i].values.clone());
    let is_spur = pair.helix_angle == 0.0;
    let mut deviation = 0.0_f64;
    let mut tables = Vec::new();
    for torque in &torques {
        let table = imported.table(*torque);
        let mean = table
            .rows()
            .windows(2)
            .map(|pair| 0.5 * (pair[0].share + pair[1].share) * (pair[1].x - pair[0].x));
        let mean = mean.sum::<f64>() / pair.base_pitch;
        // Without a column of the face, the shares of a helical pair add up over a base pitch only.
        let mut worst = (mean, None);
        if is_spur || imported.face.is_some() {
            let phase = |i: usize| (i as f64 + 0.5) / PHASES as f64;
            let sums: Vec<f64> = (0..PHASES).map(|i| imported.sum(*torque, phase(i))).collect();
            // Where a share jumps, straight lines between two rows pass over it: the sum counts on average over their distance.
            let window = imported.spacing();
            for i in 0..PHASES {
                let near = (0..=2 * window).map(|k| sums[(i + k + PHASES - window) % PHASES]);
                let sum = near.sum::<f64>() / (2 * window + 1) as f64;
                if (sum - 1.0).abs() > (worst.0 - 1.0).abs() {
                    worst = (sum, Some(phase(i)));
                }
            }
        }
        let off = (worst.0 - 1.0).abs();
        deviation = deviation.max(off);
        if off > CORRECTED || off.is_nan() {
            let place = worst.1.map_or_else(
                || "on average over a base pitch".to_owned(),
                |phase| format!("{phase:.3} of a base pitch after the first contact"),
            );
            let torque = imported.torque.map(|_| format!(" at {torque} Nm")).unwrap_or_default();
            return Err(SharingFault::of_file(
                format!(
                    "{name}: the shares of all pairs{torque} add up to {:.4} {place}, not to 1; up to 2 % off is corrected",
                    worst.0
                ),
                "a share is the line load over that of one pair alone; where it jumps, state two rows close to each other",
            ));
        }
        let rows = table.rows().iter().map(|row| ShareRow {
            share: row.share / mean,
            ..*row
        });
        tables.push(ShareTable::new(rows.collect()));
    }
    let knots = match imported.torque {
        None => Knots::ONE,
        Some(_) => Knots {
            coordinate: Coordinate::Load,
            places: torques
                .iter()
                .map(|t| t / (pair.base_radius[0] * pair.facewidth))
                .collect(),
        },
    };
    Ok(Some(LoadedShares {
        factors: tables.iter().map(|table| table.loss_factor(pair)).collect(),
        knots,
        tables,
        meshes: Vec::new(),
        error: 0.0,
        deviation,
    }))
}
