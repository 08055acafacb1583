//! What is kept of the points of a map once their rows are written.

use gearloss_framework::analysis::{Field, Piece, PointResult};

use super::Axes;

/// Grids of more points are shown by some of their rows and columns.
const MOST_SHOWN: usize = 65_536;

/// Rows and columns of a larger grid that are shown at most: those of the table on the terminal, and 35 between each two.
const LINES: usize = 36 * (super::SHOWN - 1) + 1;

/// One point as pictures and the terminal show it.
#[derive(Debug, Clone, Copy)]
pub struct Brief {
    /// \[Nm\]
    pub torque: f64,
    /// \[rad/s\]
    pub speed: f64,
    /// \[degC\]
    pub oil: Option<f64>,
    pub efficiency: Option<f64>,
    /// \[W\]
    pub loss: Option<f64>,
    /// \[Nm\]
    pub loss_torque: Option<f64>,
    pub outside: bool,
}

impl From<&PointResult> for Brief {
    fn from(point: &PointResult) -> Self {
        Self {
            torque: point.torque,
            speed: point.speed,
            oil: point.oil,
            efficiency: point.efficiency,
            loss: point.loss,
            loss_torque: point.loss_torque,
            outside: point.outside,
        }
    }
}

/// A grid as it is shown: its axes, perhaps with gaps, and for each place the number of its point; absent beyond the envelope.
pub struct Shown {
    pub axes: Axes,
    pub places: Vec<Option<usize>>,
}

/// Points of a map that are shown, and the values of all of them where another program wants them.
pub struct Kept {
    /// All points of a list; those of a grid that are shown.
    pub points: Vec<Brief>,
    pub grid: Option<Shown>,
    /// How many were solved.
    pub solved: usize,
    /// Every torque and speed of a grid with all values, where they are asked for.
    pub whole: Option<Whole>,
    /// For each torque and each speed of the grid its number among those that are shown.
    lines: [Vec<Option<usize>>; 2],
}

/// All values of a grid.
pub struct Whole {
    pub axes: Axes,
    /// Efficiency and loss torque; absent beyond the envelope.
    values: Vec<Option<[Option<f64>; 2]>>,
}

impl Whole {
    /// The efficiency at a place.
    pub fn efficiency(&self, torque: usize, speed: usize) -> Option<f64> {
        self.at(torque, speed)?[0]
    }

    /// The loss torque at a place. \[Nm\]
    pub fn loss_torque(&self, torque: usize, speed: usize) -> Option<f64> {
        self.at(torque, speed)?[1]
    }

    fn at(&self, torque: usize, speed: usize) -> Option<[Option<f64>; 2]> {
        self.values[torque * self.axes.speeds.len() + speed]
    }

    /// True where an envelope leaves places empty.
    pub fn has_gaps(&self) -> bool {
        self.values.contains(&None)
    }
}

impl Kept {
    /// Nothing of a map yet: of a grid with its axes, or of a list. `whole` keeps the values of all places.
    pub fn new(grid: Option<&Axes>, whole: bool) -> Self {
        let Some(axes) = grid else {
            return Self {
                points: Vec::new(),
                grid: None,
                solved: 0,
                whole: None,
                lines: [Vec::new(), Vec::new()],
            };
        };
        let count = axes.torques.len() * axes.speeds.len();
        let most = if count > MOST_SHOWN { LINES } else { usize::MAX };
        let [torques, speeds] = [&axes.torques, &axes.speeds].map(|axis| super::some(axis.len(), most));
        let numbers = |shown: &[usize], count: usize| {
            let mut numbers = vec![None; count];
            for (k, i) in shown.iter().enumerate() {
                numbers[*i] = Some(k);
            }
            numbers
        };
        Self {
            points: Vec::new(),
            lines: [
                numbers(&torques, axes.torques.len()),
                numbers(&speeds, axes.speeds.len()),
            ],
            grid: Some(Shown {
                places: vec![None; torques.len() * speeds.len()],
                axes: Axes {
                    torques: torques.iter().map(|i| axes.torques[*i]).collect(),
                    speeds: speeds.iter().map(|i| axes.speeds[*i]).collect(),
                    shares: axes.shares,
                },
            }),
            solved: 0,
            whole: whole.then(|| Whole {
                axes: axes.clone(),
                values: vec![None; count],
            }),
        }
    }

    /// Adds the points of a piece that follows.
    pub fn add(&mut self, field: &Field, piece: &Piece) {
        for point in piece.points() {
            let place = field.place(self.solved);
            self.solved += 1;
            if let Some(whole) = &mut self.whole {
                whole.values[place] = Some([point.efficiency, point.loss_torque]);
            }
            let Some(shown) = &mut self.grid else {
                self.points.push(point.into());
                continue;
            };
            let [torques, speeds] = &self.lines;
            if let (Some(row), Some(column)) = (torques[place / speeds.len()], speeds[place % speeds.len()]) {
                shown.places[row * shown.axes.speeds.len() + column] = Some(self.points.len());
                self.points.push(point.into());
            }
        }
    }

    /// Torques and speeds of the grid; points of a list and one.
    pub fn size(&self) -> (usize, usize) {
        match &self.grid {
            Some(_) => (self.lines[0].len(), self.lines[1].len()),
            None => (self.points.len(), 1),
        }
    }

    /// Says where pictures show fewer points than there are.
    pub fn thinned(&self) -> Option<String> {
        let (torques, speeds) = self.size();
        let axes = &self.grid.as_ref()?.axes;
        let (rows, columns) = (axes.torques.len(), axes.speeds.len());
        (rows * columns < torques * speeds).then(|| {
            format!(
                "pictures show {rows} of {torques} torques and {columns} of {speeds} speeds, both ends among them; the files hold \
                 all points"
            )
        })
    }
}
