//! The maps of one table: the same grid at one oil temperature or several, complete at zero torque and without gaps.

use gearloss_studies::analyses::map::{Axes, ExportMap, LossAt, LossGrid, MapOf, MapOfSet, Refusal};
use gearloss_studies::numbers::tidy;

/// What formats have in common whose file contains all maps of a [`GridTable`], those of drive units and machines too.
macro_rules! of_all_maps {
    () => {
        fn takes(&self, _of: gearloss_studies::analyses::map::MapOf) -> Result<(), Refusal> {
            Ok(())
        }

        fn fits(&self, axes: &gearloss_studies::analyses::map::Axes) -> Result<(), Refusal> {
            GridTable::fit(axes)
        }

        fn joins_temperatures(&self) -> bool {
            true
        }

        fn covered<'a>(&self, map: &ExportMap<'a>) -> Vec<&'a gearloss_studies::analyses::map::MapOfSet> {
            map.siblings.clone()
        }
    };
}
pub(super) use of_all_maps;

/// Losses at one oil temperature.
pub struct Slab {
    /// Oil temperature; absent with a heat balance. \[degC\]
    pub oil: Option<f64>,
    /// The grid, with a row at zero torque.
    pub grid: LossGrid,
}

/// The maps of one table.
pub struct GridTable {
    /// By ascending temperature; at least one.
    pub slabs: Vec<Slab>,
    /// Indices of the speeds with a loss torque at every torque. Standstill has none and is omitted.
    pub columns: Vec<usize>,
    /// Indices of the speeds of tables of the drive unit: standstill too if the grid has it, since machines lose there. Empty of a map of the
    /// gearbox.
    pub unit_columns: Vec<usize>,
    /// Whose losses they are.
    pub of: MapOf,
    /// Whether the row at zero torque was added.
    added: bool,
}

impl GridTable {
    /// Whether a table can have these axes.
    pub fn fit(axes: &Axes) -> Result<(), Refusal> {
        if axes.torques.len() < 2 || axes.speeds.len() < 2 {
            return Err(Refusal::new(
                "a table needs at least two torques and two speeds",
                "give the grid more points",
            ));
        }
        Ok(())
    }

    /// The maps of one table, which differ in the oil temperature only.
    pub fn new(maps: &[&MapOfSet]) -> Result<Self, Refusal> {
        let slab = |map: &&MapOfSet| {
            Some(Slab {
                oil: map.oil.given(),
                grid: ExportMap::complete(map)?,
            })
        };
        let mut slabs: Vec<Slab> = maps.iter().filter_map(slab).collect();
        if slabs.iter().any(|slab| slab.grid.has_gaps()) {
            return Err(Refusal::new(
                "outside the envelope of the grid the table would have no values",
                "give a grid without envelope",
            ));
        }
        if slabs.len() > 1 && slabs.iter().any(|slab| slab.oil.is_none()) {
            return Err(Refusal::new(
                "a table over oil temperature needs given temperatures, not a heat balance",
                "fix the temperature, or bind `thermal.mode: [fixed]` and `thermal.oil: [40 degC, 80 degC]` in the grid",
            ));
        }
        slabs.sort_by(|a, b| a.oil.unwrap_or(0.0).total_cmp(&b.oil.unwrap_or(0.0)));
        if slabs.windows(2).any(|w| w[0].oil == w[1].oil) {
            return Err(Refusal::new(
                "two maps of one table have the same oil temperature",
                "bind only `thermal.oil` in its grid",
            ));
        }
        let Some(first) = slabs.first().map(|slab| &slab.grid.axes) else {
            return Err(Refusal::new("a table needs a grid", "give `grid` instead of `points`"));
        };
        let same = |slab: &Slab| slab.grid.axes.torques == first.torques && slab.grid.axes.speeds == first.speeds;
        if !slabs.iter().all(same) {
            return Err(Refusal::new(
                "the no-load loss exists at some oil temperatures only",
                "give the grid the torque zero",
            ));
        }
        let added = maps.iter().any(|map| !map.export.no_load.is_empty()) && first.torques.contains(&0.0);
        let columns = columns(&slabs, first)?;
        let (torques, speeds) = (0..first.torques.len(), 0..first.speeds.len());
        let has_unit = |w: &usize| {
            let at = |slab: &Slab, t: usize| slab.grid.loss(t, *w).is_some_and(|loss| loss.unit.is_some());
            slabs.iter().all(|slab| torques.clone().all(|t| at(slab, t)))
        };
        Ok(Self {
            unit_columns: speeds.filter(has_unit).collect(),
            of: maps.first().map_or(MapOf::Gearbox, |map| map.of),
            slabs,
            columns,
            added,
        })
    }

    /// The axes of all maps.
    pub fn axes(&self) -> &Axes {
        &self.slabs[0].grid.axes
    }

    /// The speeds of the table. \[rad/s\]
    pub fn speeds(&self) -> Vec<f64> {
        self.columns.iter().map(|w| self.axes().speeds[*w]).collect()
    }

    /// The speeds of tables of the drive unit. \[rad/s\]
    pub fn unit_speeds(&self) -> Vec<f64> {
        self.unit_columns.iter().map(|w| self.axes().speeds[*w]).collect()
    }

    /// Notes as one line.
    pub fn about(&self) -> String {
        let axes = self.axes();
        let mut about = format!("{} torques, {} speeds, ", axes.torques.len(), self.columns.len());
        if self.added {
            about.push_str("zero torque added for the no-load loss, ");
        }
        let omitted = axes.speeds.len() - self.columns.len();
        if omitted > 0 && self.unit_columns.len() > self.columns.len() {
            about.push_str("standstill for powers only, ");
        } else if omitted > 0 {
            about.push_str(&format!("{omitted} speed without a loss torque omitted, "));
        }
        about.push_str(&match self.slabs[0].oil {
            _ if self.slabs.len() > 1 => format!("{} oil temperatures", self.slabs.len()),
            Some(oil) => format!("no temperature axis: all points at {} degC", tidy(oil)),
            None => "no temperature axis: each point at its heat balance temperature".to_owned(),
        });
        let rows = 0..axes.torques.len();
        let without = |slab: &Slab| {
            let places = rows.clone().flat_map(|t| self.columns.iter().map(move |w| (t, *w)));
            places.filter(|(t, w)| slab.grid.efficiency(*t, *w).is_none()).count()
        };
        let without: usize = self.slabs.iter().map(without).sum();
        if without > 0 {
            about.push_str(&format!("; efficiency zero at {without} points without output power"));
        }
        about
    }
}

/// A table of a drive unit or of its machines in W: name, meaning, value.
pub type UnitColumn = (&'static str, &'static str, fn(&LossAt) -> Option<f64>);

/// The tables of a drive unit or of its machines.
pub const UNIT: [UnitColumn; 4] = [
    ("dc_power", "power out of the DC link, W", |loss| {
        Some(loss.unit?.point.dc_power_w)
    }),
    ("loss_power", "all losses, W", |loss| Some(loss.unit?.loss)),
    ("machine_loss", "losses of the machines, W", |loss| {
        Some(loss.unit?.point.machine_loss_w)
    }),
    (
        "inverter_loss",
        "losses of inverters that are described apart, W",
        |loss| Some(loss.unit?.point.inverter_loss_w),
    ),
];

/// Indices of the speeds of a table.
fn columns(slabs: &[Slab], axes: &Axes) -> Result<Vec<usize>, Refusal> {
    let missing = |w: usize| {
        let grids = slabs.iter().map(|slab| &slab.grid);
        let of = |grid: &LossGrid| {
            (0..axes.torques.len())
                .filter(|t| grid.loss_torque(*t, w).is_none())
                .count()
        };
        grids.map(of).sum::<usize>()
    };
    let all = slabs.len() * axes.torques.len();
    let columns: Vec<usize> = (0..axes.speeds.len()).filter(|w| missing(*w) < all).collect();
    if columns.len() < 2 {
        return Err(Refusal::new(
            "a table needs at least two speeds with a loss torque",
            "give the grid more speeds above zero",
        ));
    }
    let without: usize = columns.iter().map(|w| missing(*w)).sum();
    if without > 0 {
        return Err(Refusal::new(
            format!("{without} points of the grid have no loss torque; a table needs a value at every point"),
            "omit torques and speeds at which the transmission is self-locking or a loss is undefined",
        ));
    }
    Ok(columns)
}
