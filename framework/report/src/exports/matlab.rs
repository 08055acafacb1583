//! Vectors for Simulink's gearbox blocks as a script.
//!
//! Source: documentation of the Powertrain Blockset's block Gearbox.

use gearloss_studies::analyses::map::{Axes, ExportFile, ExportFormat, ExportMap, LossGrid, MapOfSet, Refusal};
use gearloss_studies::analyses::numbers::tidy;
use gearloss_studies::register_export;

register_export!(Matlab);

struct Matlab;

impl ExportFormat for Matlab {
    fn name(&self) -> &'static str {
        "matlab"
    }

    fn meaning(&self) -> &'static str {
        "Efficiency and loss torque over torque, speed and, if several were computed, oil temperature, as a script with the vectors \
         of Simulink's gearbox blocks."
    }

    fn fits(&self, axes: &Axes) -> Result<(), Refusal> {
        if axes.torques.len() < 2 || axes.speeds.len() < 2 {
            return Err(Refusal::new(
                "a table needs at least two torques and two speeds",
                "give the grid more points",
            ));
        }
        Ok(())
    }

    /// All temperatures of one table are in one file.
    fn file(&self, map: &ExportMap<'_>) -> Result<Option<ExportFile>, Refusal> {
        if map.grid.has_gaps() {
            return Err(Refusal::new(
                "outside the envelope of the grid the efficiency would be zero",
                "give a grid without envelope",
            ));
        }
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

/// Oil temperature of a map; absent with a heat balance.
struct Slab<'a> {
    oil: Option<f64>,
    grid: &'a LossGrid,
}

/// The maps of one table, sorted by temperature.
fn slabs<'a>(maps: &[&'a MapOfSet]) -> Result<Vec<Slab<'a>>, Refusal> {
    let slab = |map: &&'a MapOfSet| {
        Some(Slab {
            oil: map.oil.given(),
            grid: map.shown.whole.as_ref()?,
        })
    };
    let mut slabs: Vec<Slab<'a>> = maps.iter().filter_map(slab).collect();
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
    Ok(slabs)
}

/// Indices of the speeds of a table. Standstill has no loss torque and is omitted.
fn speeds(slabs: &[Slab<'_>], axes: &Axes) -> Result<Vec<usize>, Refusal> {
    let turns = |w: &usize| {
        let mut grids = slabs.iter().map(|slab| slab.grid);
        grids.any(|grid| (0..axes.torques.len()).any(|t| grid.loss_torque(t, *w).is_some()))
    };
    let columns: Vec<usize> = (0..axes.speeds.len()).filter(turns).collect();
    if columns.len() < 2 {
        return Err(Refusal::new(
            "a table needs at least two speeds with a loss torque",
            "give the grid more speeds above zero",
        ));
    }
    Ok(columns)
}

/// Numbers as elements of a vector.
fn list(values: impl Iterator<Item = f64>) -> String {
    values.map(|x| format!("{x}")).collect::<Vec<_>>().join(" ")
}

/// A table with one value for each grid point, with a third index if there are several temperatures, and the number of missing values.
fn table(
    name: &str,
    empty: &str,
    slabs: &[Slab<'_>],
    columns: &[usize],
    value: fn(&LossGrid, usize, usize) -> Option<f64>,
) -> (String, usize) {
    let (mut text, mut missing) = (String::new(), 0);
    for (k, slab) in slabs.iter().enumerate() {
        let index = if slabs.len() > 1 {
            format!("(:,:,{})", k + 1)
        } else {
            String::new()
        };
        text.push_str(&format!("{name}{index} = [\n"));
        for t in 0..slab.grid.axes.torques.len() {
            let row = columns.iter().map(|w| {
                let value = value(slab.grid, t, *w);
                missing += usize::from(value.is_none());
                value.map_or_else(|| empty.to_owned(), |x| format!("{x}"))
            });
            text.push_str(&format!("  {};\n", row.collect::<Vec<_>>().join(" ")));
        }
        text.push_str("];\n");
    }
    (text, missing)
}

/// The script with the vectors of efficiency and loss torque, and its description.
fn script(map: &ExportMap<'_>) -> Result<(String, String), Refusal> {
    let slabs = slabs(&map.siblings)?;
    let axes = &map.grid.axes;
    let columns = speeds(&slabs, axes)?;
    let (eta, without_output) = table("eta_tbl", "0", &slabs, &columns, LossGrid::efficiency);
    let (loss, without_loss) = table("loss_tbl", "", &slabs, &columns, LossGrid::loss_torque);
    if without_loss > 0 {
        return Err(Refusal::new(
            format!("{without_loss} points of the grid have no loss torque; a table needs a value at every point"),
            "omit torques and speeds at which the transmission is self-locking or a loss is undefined",
        ));
    }
    let mut about = format!("{} torques, {} speeds, ", axes.torques.len(), columns.len());
    let omitted = axes.speeds.len() - columns.len();
    if omitted > 0 {
        about.push_str(&format!("{omitted} speed without a loss torque omitted, "));
    }
    about.push_str(&match slabs[0].oil {
        _ if slabs.len() > 1 => format!("{} oil temperatures", slabs.len()),
        Some(oil) => format!("no temperature axis: all points at {} degC", tidy(oil)),
        None => "no temperature axis: each point at its heat balance temperature".to_owned(),
    });
    if without_output > 0 {
        about.push_str(&format!(
            "; efficiency zero at {without_output} points without output power"
        ));
    }
    let temperatures = if slabs.len() > 1 {
        let kelvin = slabs.iter().filter_map(|slab| Some(slab.oil? + 273.15));
        format!("Temp_bpts = [{}]; % K\n", list(kelvin))
    } else {
        String::new()
    };
    let text = format!(
        "% Losses of gear {}, by gearloss {}. {about}.\n% eta_tbl: power out over power in, drive and coast; loss_tbl: loss over the speed of the reference port, Nm; \
         rows are torques, columns are speeds.\nTrq_bpts = [{}]; % Nm\nomega_bpts = [{}]; % rad/s\n{temperatures}{eta}{loss}",
        map.map.gear,
        env!("CARGO_PKG_VERSION"),
        list(axes.torques.iter().copied()),
        list(columns.iter().map(|w| axes.speeds[*w])),
    );
    Ok((text, about))
}
