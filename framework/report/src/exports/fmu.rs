//! Functional Mock-up Units of the losses of all gears of a model set.
//!
//! Source: the standards FMI 2.0 and FMI 3.0 (Modelica Association); `gearloss-fmu` writes them.

use std::ptr;

use gearloss_fmu::content::Content;
use gearloss_fmu::map::{GearOfMap, Map, OfMap, OilOfMap};
use gearloss_fmu::table::{Axis, Table};
use gearloss_fmu::{Experiment, Fmu, Version};
use gearloss_studies::analyses::map::{Axes, ExportFile, ExportFormat, ExportMap, MapOf, MapOfSet, Refusal, UnitAt};
use gearloss_studies::numbers::{RPM, tidy};
use gearloss_studies::register_export;

use super::missed;
use super::slabs::GridTable;

register_export!(OfVersion {
    version: Version::Two,
    name: "fmu2",
    meaning: "Losses, efficiency and output over speed, torque, gear and oil temperature as a Functional Mock-up Unit of FMI 2.0, for \
              Co-Simulation and Model Exchange.",
});
register_export!(OfVersion {
    version: Version::Three,
    name: "fmu3",
    meaning: "As `fmu2`, of FMI 3.0.",
});

struct OfVersion {
    version: Version,
    name: &'static str,
    meaning: &'static str,
}

/// Names and meanings of the shares of the loss, in the order of the usual sums.
const SHARES: [(&str, &str); 6] = [
    ("gears.load_dependent", "gears, load-dependent"),
    ("gears.no_load", "gears, load-independent"),
    ("bearings.load_dependent", "bearings, load-dependent"),
    ("bearings.no_load", "bearings, load-independent"),
    ("seals", "seals"),
    ("others", "others"),
];
/// Number of points of the reference experiment.
const REFERENCES: usize = 61;

impl ExportFormat for OfVersion {
    fn name(&self) -> &'static str {
        self.name
    }

    fn meaning(&self) -> &'static str {
        self.meaning
    }

    fn fits(&self, axes: &Axes) -> Result<(), Refusal> {
        GridTable::fit(axes)
    }

    fn has_library(&self) -> bool {
        true
    }

    fn takes(&self, _of: MapOf) -> Result<(), Refusal> {
        Ok(())
    }

    fn joins_temperatures(&self) -> bool {
        true
    }

    fn covered<'a>(&self, map: &ExportMap<'a>) -> Vec<&'a MapOfSet> {
        of_set(map)
    }

    fn file(&self, map: &ExportMap<'_>) -> Result<Option<ExportFile>, Refusal> {
        file(map, self.version)
    }
}

/// All maps of the model set.
fn of_set<'a>(map: &ExportMap<'a>) -> Vec<&'a MapOfSet> {
    let maps = map.outcome.maps.iter();
    maps.filter(|other| other.model_set == map.map.model_set).collect()
}

/// The FMU of a model set, for its first map.
fn file(map: &ExportMap<'_>, version: Version) -> Result<Option<ExportFile>, Refusal> {
    let maps = of_set(map);
    if !maps.first().is_some_and(|first| ptr::eq(*first, map.map)) {
        return Ok(None);
    }
    let mut gears: Vec<(&str, GridTable, Option<f64>)> = Vec::new();
    for first in &maps {
        if !gears.iter().any(|(gear, ..)| *gear == first.gear) {
            let of_gear: Vec<&MapOfSet> = maps.iter().copied().filter(|map| map.gear == first.gear).collect();
            gears.push((&first.gear, GridTable::new(&of_gear)?, first.export.ratio));
        }
    }
    let oil = |slabs: &GridTable| match slabs.slabs[0].oil {
        _ if slabs.slabs.len() > 1 => OilOfMap::Given,
        Some(_) => OilOfMap::Fixed,
        None => OilOfMap::Balance,
    };
    let first = &gears[0].1;
    // The machines alone have no other port.
    let has_ratio = first.of != MapOf::Machine && gears.iter().all(|(.., ratio)| ratio.is_some());
    let content = Content::Map(Map {
        of: match first.of {
            MapOf::Gearbox => OfMap::Gearbox,
            MapOf::Unit => OfMap::Unit,
            MapOf::Machine => OfMap::Machines,
        },
        oil: oil(first),
        starts: vec![
            middle(&first.speeds()),
            middle(&first.axes().torques),
            first.slabs[0].oil.unwrap_or(0.0),
        ],
        gears: gears
            .iter()
            .map(|(name, slabs, ratio)| GearOfMap {
                name: (*name).to_owned(),
                ratio: ratio.filter(|_| has_ratio),
                table: table(slabs),
            })
            .collect(),
    });
    let about = about(&gears);
    let name = format!("{}-{}", map.outcome.head.analysis, map.map.model_set).replace('/', "-");
    let fmu = Fmu {
        name: name.clone(),
        description: format!("Losses{} by gearloss: {about}{}", first.of.words(), missed(&maps)),
        tool: format!("gearloss {}", env!("CARGO_PKG_VERSION")),
        content: &content,
        shares: &SHARES,
        experiment: experiment(&gears, oil(first)),
        libraries: &map.outcome.libraries,
    };
    let bytes = fmu.bytes(version).map_err(|reason| {
        Refusal::new(
            format!("the FMU cannot be written: {reason}"),
            "give the grid fewer points",
        )
    })?;
    let platforms: Vec<&str> = map
        .outcome
        .libraries
        .iter()
        .map(|library| library.platform.names()[2])
        .collect();
    Ok(Some(ExportFile {
        name: format!("{name}-{}.fmu", if version == Version::Two { "fmi2" } else { "fmi3" }),
        about: format!("{about}; for {}", platforms.join(", ")),
        bytes,
    }))
}

/// The value in the middle of an axis.
fn middle(axis: &[f64]) -> f64 {
    axis.get(axis.len() / 2).copied().unwrap_or(0.0)
}

/// Gears and axes in words.
fn about(gears: &[(&str, GridTable, Option<f64>)]) -> String {
    let of = |(name, slabs, _): &(&str, GridTable, Option<f64>)| {
        let ends = |axis: &[f64]| [0, axis.len() - 1].map(|i| axis[i]);
        let ([low, high], speeds) = (ends(&slabs.axes().torques), ends(&slabs.speeds()).map(|w| w * RPM));
        format!(
            "gear {name}: {} to {} Nm, {:.0} to {:.0} rpm, {}",
            tidy(low),
            tidy(high),
            speeds[0],
            speeds[1],
            slabs.about()
        )
    };
    gears.iter().map(of).collect::<Vec<_>>().join("; ")
}

/// The table of a gear: speed, torque and, if there are several, oil temperature.
fn table(grid: &GridTable) -> Table {
    let (torques, mut speeds) = (&grid.axes().torques, grid.speeds());
    let oils: Vec<f64> = grid.slabs.iter().filter_map(|slab| slab.oil).collect();
    let is_balanced = grid.slabs[0].oil.is_none();
    let mut values = Vec::new();
    for (column, speed) in grid.columns.iter().zip(&speeds) {
        for t in 0..torques.len() {
            for slab in &grid.slabs {
                let loss = slab.grid.loss(t, *column);
                let unit = loss.and_then(|loss| loss.unit);
                let gearbox = unit.map(|unit| (unit.gearbox_torque, unit.gearbox));
                let (torque, sums) = gearbox
                    .or(loss.map(|loss| (loss.loss_torque, loss.sums)))
                    .unwrap_or_default();
                if grid.of != MapOf::Machine {
                    values.push(torque.unwrap_or(0.0));
                    values.extend(sums.map(|watts| watts / speed.abs()));
                }
                if is_balanced {
                    values.push(loss.and_then(|loss| loss.oil).unwrap_or(0.0));
                }
                if !grid.of.is_gearbox() {
                    values.extend(electric(unit, *speed));
                }
            }
        }
    }
    let channels = values.len() / (speeds.len() * torques.len() * grid.slabs.len());
    // A grid that begins at standstill includes it, with the loss torque of the lowest speed; machines lose there what was solved. Of machines,
    // other grids with standstill do so too, with what lies between the speeds on both sides.
    let standstill = grid.axes().speeds.iter().position(|speed| *speed == 0.0);
    let solved = standstill.filter(|w| grid.unit_columns.contains(w));
    let below = speeds.iter().filter(|speed| **speed < 0.0).count();
    if (standstill == Some(0) || solved.is_some()) && !speeds.contains(&0.0) {
        let size = values.len() / speeds.len();
        let [before, after] = [below.saturating_sub(1), below.min(speeds.len() - 1)];
        let column = |k: usize| values[k * size..(k + 1) * size].iter();
        let mut still: Vec<f64> = if before == after {
            column(after).copied().collect()
        } else {
            let share = speeds[before] / (speeds[before] - speeds[after]);
            column(before)
                .zip(column(after))
                .map(|(a, b)| a + share * (b - a))
                .collect()
        };
        if let Some(w) = solved {
            let places = (0..torques.len()).flat_map(|t| grid.slabs.iter().map(move |slab| (t, slab)));
            for (point, (t, slab)) in still.chunks_exact_mut(channels).zip(places) {
                let [machine, inverter] = losses(slab.grid.loss(t, w).and_then(|loss| loss.unit));
                point[channels - 2..].copy_from_slice(&[machine, inverter]);
            }
        }
        values.splice(below * size..below * size, still);
        speeds.insert(below, 0.0);
    }
    let mut axes = vec![
        Axis {
            quantity: 0,
            points: speeds,
        },
        Axis {
            quantity: 1,
            points: torques.clone(),
        },
    ];
    if oils.len() > 1 {
        axes.push(Axis {
            quantity: 2,
            points: oils,
        });
    }
    Table { axes, channels, values }
}

/// Losses of machines and inverters. \[W\]
fn losses(unit: Option<UnitAt>) -> [f64; 2] {
    unit.map_or([0.0; 2], |unit| [unit.point.machine_loss_w, unit.point.inverter_loss_w])
}

/// Channels of a drive unit: power at the shafts of the machines over speed \[Nm\], losses of machines and inverters \[W\].
fn electric(unit: Option<UnitAt>, speed: f64) -> [f64; 3] {
    let [machine, inverter] = losses(unit);
    [unit.map_or(0.0, |unit| unit.shafts) / speed.abs(), machine, inverter]
}

/// Points all over the axes, between the points of the grid: multiples of irrational numbers fill a range evenly.
fn experiment(gears: &[(&str, GridTable, Option<f64>)], oil: OilOfMap) -> Experiment {
    let within = |axis: &[f64], i: usize, factor: f64| {
        let share = (i as f64 * factor).fract();
        axis[0] + share * (axis[axis.len() - 1] - axis[0])
    };
    let row = |i: usize| {
        let (_, slabs, _) = &gears[i % gears.len()];
        let mut row = vec![
            within(&slabs.speeds(), i, 0.618_033_988_75),
            within(&slabs.axes().torques, i, 0.414_213_562_37),
        ];
        if oil == OilOfMap::Given {
            let oils: Vec<f64> = slabs.slabs.iter().filter_map(|slab| slab.oil).collect();
            row.push(within(&oils, i, 0.732_050_807_57));
        }
        if gears.len() > 1 {
            row.push((i % gears.len() + 1) as f64);
        }
        row
    };
    Experiment {
        step: 1.0,
        inputs: (0..REFERENCES).map(row).collect(),
    }
}
