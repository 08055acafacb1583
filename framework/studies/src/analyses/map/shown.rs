//! Data of the points of a map for figures and text, independent of its rows.

use gearloss_framework::flow::Status;
use gearloss_framework::machine::MachineState;

use super::axes::Axes;
use super::map_of::MapOf;
use crate::numbers::spread_over;
use crate::points::{Field, Numbered, PointResult, UnitPoint};

/// Grids with more points are shown by a selection of their rows and columns.
const MOST_SHOWN: usize = 65_536;

/// Maximum number of rows and columns of a larger grid in figures: those of the table on the terminal, and 35 between each two.
const LINES: usize = 36 * (SHOWN - 1) + 1;

/// Maximum number of rows and columns of a table on the terminal.
pub const SHOWN: usize = 8;

/// One point for figures and the terminal.
#[derive(Debug, Clone)]
pub struct ShownPoint {
    /// Number of its gear state from zero, if the gears of the points differ.
    pub gear: Option<usize>,
    /// Torque. \[Nm\]
    pub torque: f64,
    /// Speed. \[rad/s\]
    pub speed: f64,
    /// Temperature of the oil. \[degC\]
    pub oil: Option<f64>,
    /// Output power over input power.
    pub efficiency: Option<f64>,
    /// Sum of all losses. \[W\]
    pub loss: Option<f64>,
    /// Loss over the speed of the reference port. \[Nm\]
    pub loss_torque: Option<f64>,
    /// True if the drive locks itself, so that no load keeps it moving.
    pub locked: bool,
    /// The usual sums of losses. \[W\]
    pub sums: [f64; 6],
    /// True if a model is outside its stated range.
    pub outside: bool,
    /// Quantities that the study limits; empty without limits.
    pub limits: Vec<f64>,
}

impl ShownPoint {
    fn new(of: MapOf, point: &PointResult) -> Self {
        let [efficiency, loss, loss_torque] = of.read(point);
        Self {
            gear: None,
            torque: point.torque,
            speed: point.speed,
            oil: point.oil,
            efficiency,
            loss,
            loss_torque,
            locked: point.status == Status::SelfLocking,
            sums: of.sums(point),
            outside: point.outside,
            limits: point.limits.clone(),
        }
    }
}

/// The shown grid: its axes, possibly with gaps, and the index of the point at each position; absent outside the envelope.
#[derive(Debug, Clone)]
pub struct ShownGrid {
    /// The shown axes.
    pub axes: Axes,
    /// Index of the point at each position.
    pub places: Vec<Option<usize>>,
}

/// Shown points of a map, and the values of all points if an export needs them.
#[derive(Debug, Clone)]
pub struct ShownMap {
    /// All points of a list; the shown points of a grid.
    pub points: Vec<ShownPoint>,
    /// The grid; absent for a list.
    pub grid: Option<ShownGrid>,
    /// Every torque and speed of a grid with all values, if requested.
    pub whole: Option<LossGrid>,
    /// Torques and speeds of the grid.
    size: Option<(usize, usize)>,
}

/// Selection of points.
pub struct Selection {
    /// Whose efficiency and loss is shown.
    of: MapOf,
    /// Whether the values of all positions are stored.
    whole: bool,
    /// Shown part of a grid; absent for a list, which is shown completely.
    lines: Option<Lines>,
    /// Number of the gear state, if the gears of the points differ.
    gear: Option<usize>,
}

/// For each torque and each speed of a grid its index among the shown ones.
struct Lines {
    torques: Vec<Option<usize>>,
    speeds: Vec<Option<usize>>,
    /// Number of shown speeds.
    columns: usize,
}

/// Data of some points.
pub struct Picked {
    /// Shown points with their positions.
    shown: Vec<(usize, ShownPoint)>,
    /// Losses at the grid points.
    values: Vec<(usize, LossAt)>,
}

/// Losses at one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LossAt {
    /// Output power over input power.
    pub efficiency: Option<f64>,
    /// Loss over the speed of the reference port. \[Nm\]
    pub loss_torque: Option<f64>,
    /// Temperature of the oil. \[degC\]
    pub oil: Option<f64>,
    /// The usual sums of losses. \[W\]
    pub sums: [f64; 6],
    /// The drive unit of a map that shows it or its machines.
    pub unit: Option<UnitAt>,
}

/// A drive unit at one point, and its gearbox alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnitAt {
    /// Powers and losses of the unit.
    pub point: UnitPoint,
    /// What the map shows: loss of the unit, or of its machines. \[W\]
    pub loss: f64,
    /// Power at the shafts of the machines. \[W\]
    pub shafts: f64,
    /// Loss of the gearbox over the speed of the reference port. \[Nm\]
    pub gearbox_torque: Option<f64>,
    /// The usual sums of losses of the gearbox. \[W\]
    pub gearbox: [f64; 6],
}

impl LossAt {
    /// Of what a map shows.
    pub fn new(of: MapOf, point: &PointResult) -> Self {
        let [efficiency, loss, loss_torque] = of.read(point);
        let unit = point.unit().zip(loss).filter(|_| !of.is_gearbox());
        Self {
            efficiency,
            loss_torque,
            unit: unit.map(|(unit, loss)| UnitAt {
                point: unit,
                loss,
                shafts: point.machines.iter().map(MachineState::shaft).sum(),
                gearbox_torque: point.loss_torque,
                gearbox: point.sums,
            }),
            oil: point.oil,
            sums: of.sums(point),
        }
    }
}

/// Losses at all grid points.
#[derive(Debug, Clone)]
pub struct LossGrid {
    /// The axes.
    pub axes: Axes,
    /// Losses; absent outside the envelope.
    values: Vec<Option<LossAt>>,
}

impl LossGrid {
    /// The efficiency at a grid point.
    pub fn efficiency(&self, torque: usize, speed: usize) -> Option<f64> {
        self.loss(torque, speed)?.efficiency
    }

    /// The loss torque at a grid point. \[Nm\]
    pub fn loss_torque(&self, torque: usize, speed: usize) -> Option<f64> {
        self.loss(torque, speed)?.loss_torque
    }

    /// Losses at a grid point; absent outside the envelope.
    pub fn loss(&self, torque: usize, speed: usize) -> Option<&LossAt> {
        self.values[torque * self.axes.speeds.len() + speed].as_ref()
    }

    /// The same grid with a row at zero torque, one value for each speed; without a value at every speed that has one elsewhere, and with a
    /// grid that has such a row, the grid itself.
    pub fn with_no_load(&self, row: &[LossAt]) -> Self {
        let mut extended = self.clone();
        let Axes { torques, speeds, .. } = &self.axes;
        let turns = |w: usize| (0..torques.len()).any(|t| self.loss_torque(t, w).is_some());
        let has_all = row.len() == speeds.len() && (0..speeds.len()).all(|w| row[w].loss_torque.is_some() || !turns(w));
        if torques.contains(&0.0) || !has_all {
            return extended;
        }
        let place = torques.partition_point(|torque| *torque < 0.0);
        extended.axes.torques.insert(place, 0.0);
        let at = place * speeds.len();
        extended.values.splice(at..at, row.iter().copied().map(Some));
        extended
    }

    /// True if an envelope leaves positions empty.
    pub fn has_gaps(&self) -> bool {
        self.values.contains(&None)
    }
}

impl Selection {
    /// For a grid with its axes, or for a list. `whole` stores the values of all positions.
    pub fn new(of: MapOf, grid: Option<&Axes>, whole: bool) -> Self {
        let numbers = |lines: &[f64], shown: &[usize]| {
            let mut numbers = vec![None; lines.len()];
            for (k, i) in shown.iter().enumerate() {
                numbers[*i] = Some(k);
            }
            numbers
        };
        Self {
            of,
            whole,
            gear: None,
            lines: grid.map(|axes| {
                let [torques, speeds] = axes.shown();
                Lines {
                    torques: numbers(&axes.torques, &torques),
                    speeds: numbers(&axes.speeds, &speeds),
                    columns: speeds.len(),
                }
            }),
        }
    }

    /// The same for points in a gear of several.
    pub fn in_gear(self, gear: Option<usize>) -> Self {
        Self { gear, ..self }
    }

    /// Data of some points.
    pub fn pick(&self, field: &Field, points: &Numbered<'_>) -> Picked {
        let mut picked = Picked {
            shown: Vec::new(),
            values: Vec::new(),
        };
        for (number, point) in points {
            let place = field.place(*number);
            if self.whole {
                picked.values.push((place, LossAt::new(self.of, point)));
            }
            if let Some(shown) = self.place(place) {
                let point = ShownPoint {
                    gear: self.gear,
                    ..ShownPoint::new(self.of, point)
                };
                picked.shown.push((shown, point));
            }
        }
        picked
    }

    /// Shown position of a point; absent if it is not shown.
    fn place(&self, place: usize) -> Option<usize> {
        let Some(lines) = &self.lines else {
            return Some(place);
        };
        let speeds = lines.speeds.len();
        let (row, column) = (lines.torques[place / speeds]?, lines.speeds[place % speeds]?);
        Some(row * lines.columns + column)
    }
}

impl Axes {
    /// Indices of the shown torques and speeds.
    fn shown(&self) -> [Vec<usize>; 2] {
        let count = self.torques.len() * self.speeds.len();
        let most = if count > MOST_SHOWN { LINES } else { usize::MAX };
        [&self.torques, &self.speeds].map(|axis| spread_over(axis.len(), most))
    }
}

impl ShownMap {
    /// Empty data for a map over a grid with its axes, or for a list. `whole` stores the values of all positions.
    pub fn new(grid: Option<&Axes>, whole: bool) -> Self {
        let shown = |axes: &Axes| {
            let [torques, speeds] = axes.shown();
            ShownGrid {
                places: vec![None; torques.len() * speeds.len()],
                axes: Axes {
                    torques: torques.iter().map(|i| axes.torques[*i]).collect(),
                    speeds: speeds.iter().map(|i| axes.speeds[*i]).collect(),
                    shares: axes.shares,
                },
            }
        };
        Self {
            points: Vec::new(),
            grid: grid.map(shown),
            whole: grid.filter(|_| whole).map(|axes| LossGrid {
                axes: axes.clone(),
                values: vec![None; axes.torques.len() * axes.speeds.len()],
            }),
            size: grid.map(|axes| (axes.torques.len(), axes.speeds.len())),
        }
    }

    /// Adds the data of the next piece.
    pub fn add(&mut self, picked: Vec<Picked>) {
        let mut more = Vec::new();
        for picked in picked {
            more.extend(picked.shown);
            if let Some(whole) = &mut self.whole {
                for (place, values) in picked.values {
                    whole.values[place] = Some(values);
                }
            }
        }
        // Tasks contain points of many positions.
        more.sort_unstable_by_key(|(place, _)| *place);
        for (place, point) in more {
            if let Some(shown) = &mut self.grid {
                shown.places[place] = Some(self.points.len());
            }
            self.points.push(point);
        }
    }

    /// Numbers of torques and speeds of the grid; number of points of a list and one.
    pub fn size(&self) -> (usize, usize) {
        self.size.unwrap_or((self.points.len(), 1))
    }

    /// True for a grid of one torque without gaps.
    pub fn is_line(&self) -> bool {
        let grid = self.grid.as_ref();
        grid.is_some_and(|shown| shown.axes.torques.len() == 1 && !shown.places.contains(&None))
    }

    /// A note if figures show only a selection of points.
    pub fn thinned(&self) -> Option<String> {
        let (torques, speeds) = self.size();
        let axes = &self.grid.as_ref()?.axes;
        let (rows, columns) = (axes.torques.len(), axes.speeds.len());
        (rows * columns < torques * speeds).then(|| {
            format!(
                "figures show {rows} of {torques} torques and {columns} of {speeds} speeds; the files contain \
                 all points"
            )
        })
    }
}
