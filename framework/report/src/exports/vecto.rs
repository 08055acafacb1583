//! Transmission loss maps of VECTO, and power maps of its electric machines with drag and full load.
//!
//! Source: VECTO's user manual, Transmission Loss Map, Electric Motor Power Map (.vemo), Drag Curve (.vemd), Max Torque (.vemp), and the generic
//! vehicles that VECTO contains, from which the signs follow: torque and electric power are positive in drive, the drag torque is negative.

use gearloss_studies::analyses::map::{Axes, ExportFile, ExportFormat, ExportMap, MachineAtSpeeds, MapOf, Refusal};
use gearloss_studies::numbers::{RPM, tidy};
use gearloss_studies::register_export;

register_export!(Vecto);

struct Vecto;

impl ExportFormat for Vecto {
    fn name(&self) -> &'static str {
        "vecto"
    }

    fn meaning(&self) -> &'static str {
        "Loss torque over input speed and torque in the format of VECTO, for engineering mode; with `of: machine` the electric power of the \
         machine with its inverter, its drag and its largest torque."
    }

    fn takes(&self, of: MapOf) -> Result<(), Refusal> {
        if of != MapOf::Unit {
            return Ok(());
        }
        Err(Refusal::new(
            "VECTO takes the machine and the gearbox as files of their own",
            "export `vecto` of two maps: `of: machine` for the machine, and without `of` for the gearbox",
        ))
    }

    fn fits(&self, axes: &Axes) -> Result<(), Refusal> {
        let torques = &axes.torques;
        let [drive, coast] = [1.0, -1.0].map(|sign| torques.iter().any(|torque| sign * torque > 0.0));
        if drive && coast && torques.contains(&0.0) {
            Ok(())
        } else {
            Err(Refusal::new(
                "VECTO needs rows below, at and above zero torque",
                "give the grid negative torques, zero and positive torques",
            ))
        }
    }

    fn file(&self, map: &ExportMap<'_>) -> Result<Option<ExportFile>, Refusal> {
        if map.map.of == MapOf::Machine {
            return power_map(map).map(Some);
        }
        let Axes { torques, speeds, .. } = &map.grid.axes;
        let mut text = "Input Speed [rpm],Input Torque [Nm],Torque Loss [Nm]\n".to_owned();
        let (mut rows, mut left) = (0, 0);
        for w in 0..speeds.len() {
            for t in 0..torques.len() {
                // At standstill, or if a loss has no value, there is no loss torque.
                match map.grid.loss_torque(t, w) {
                    Some(loss) => {
                        let speed = tidy(speeds[w] * RPM);
                        text.push_str(&format!("{speed:.2},{:.4},{loss:.6}\n", torques[t]));
                        rows += 1;
                    }
                    None => left += 1,
                }
            }
        }
        if rows < 4 {
            return Err(Refusal::new(
                format!("VECTO needs at least four rows with a loss torque; there are {rows}"),
                "give the grid more points",
            ));
        }
        let mut about = format!("{rows} rows, for VECTO's engineering mode");
        if left > 0 {
            about.push_str(&format!("; {left} points without a loss torque are omitted"));
        }
        Ok(Some(ExportFile {
            name: format!("{}.vtlm", map.own_name()),
            bytes: text.into_bytes(),
            about,
        }))
    }

    /// Drag and full load of the machine.
    fn further_files(&self, map: &ExportMap<'_>) -> Vec<ExportFile> {
        let Ok(machine) = machine(map) else { return Vec::new() };
        drag(map, machine).into_iter().chain(full_load(map, machine)).collect()
    }
}

/// The machine of a map that shows it.
fn machine<'a>(map: &ExportMap<'a>) -> Result<&'a MachineAtSpeeds, Refusal> {
    match &map.map.export.machines[..] {
        [machine] if machine.at_reference => Ok(machine),
        [_] => Err(Refusal::new(
            "VECTO needs torque and speed of the machine, which is not at the reference port",
            "export `fmu3`, `mat`, `matlab` or `modelica`, or export the machine from a gearbox in which its port is the reference port",
        )),
        machines => Err(Refusal::new(
            format!("a file of VECTO is that of one machine; there are {}", machines.len()),
            "export `fmu3`, `mat`, `matlab` or `modelica` of all of them",
        )),
    }
}

/// Indices of the speeds from standstill on. VECTO has no others.
fn forward(map: &ExportMap<'_>) -> Vec<usize> {
    let speeds = &map.grid.axes.speeds;
    (0..speeds.len()).filter(|w| speeds[*w] >= 0.0).collect()
}

/// Speed of a column as it is written.
fn rpm(map: &ExportMap<'_>, column: usize) -> f64 {
    tidy(map.grid.axes.speeds[column] * RPM)
}

/// The electric power over speed and torque. A machine that turns freely without torque draws nothing; its drag is a curve of its own.
fn power_map(map: &ExportMap<'_>) -> Result<ExportFile, Refusal> {
    let machine = machine(map)?;
    let has_drag = drag(map, machine).is_some();
    let mut text = "n [rpm],T [Nm],P_el [kW]\n".to_owned();
    let (mut rows, mut left) = (0, 0);
    for w in forward(map) {
        for (t, torque) in map.grid.axes.torques.iter().enumerate() {
            if has_drag && *torque == 0.0 {
                continue;
            }
            match map.grid.loss(t, w).and_then(|loss| loss.unit) {
                Some(unit) => {
                    let power = unit.point.dc_power_w / 1000.0;
                    text.push_str(&format!("{:.2},{torque:.4},{power:.6}\n", rpm(map, w)));
                    rows += 1;
                }
                None => left += 1,
            }
        }
    }
    if rows < 4 {
        return Err(Refusal::new(
            format!("VECTO needs at least four rows with an electric power; there are {rows}"),
            "give the grid more points",
        ));
    }
    let mut about = format!("{rows} rows, electric power of machine and inverter, for VECTO's engineering mode");
    if left > 0 {
        about.push_str(&format!("; {left} points without a loss are omitted"));
    }
    if !machine.freewheels {
        about.push_str("; no drag curve, since the machine is energised without torque (`idle: \"off\"` with `freewheel` states one)");
    } else if !has_drag {
        about.push_str("; no drag curve, which needs two speeds above standstill at zero torque");
    }
    Ok(ExportFile {
        name: format!("{}.vemo", map.own_name()),
        bytes: text.into_bytes(),
        about,
    })
}

/// The drag torque of a machine whose inverter is off, from its losses at zero torque.
fn drag(map: &ExportMap<'_>, machine: &MachineAtSpeeds) -> Option<ExportFile> {
    let zero = map.grid.axes.torques.iter().position(|torque| *torque == 0.0)?;
    let at = |w: usize| {
        let loss = map.grid.loss(zero, w)?;
        let drag = loss.unit?.point.machine_loss_w / map.grid.axes.speeds[w];
        drag.is_finite().then(|| format!("{:.2},{:.6}\n", rpm(map, w), -drag))
    };
    let rows: Vec<String> = forward(map).into_iter().filter_map(at).collect();
    (machine.freewheels && rows.len() >= 2).then(|| ExportFile {
        name: format!("{}.vemd", map.own_name()),
        bytes: format!("n [rpm],T_drag [Nm]\n{}", rows.concat()).into_bytes(),
        about: format!(
            "drag of the machine with its inverter off, {} speeds above standstill",
            rows.len()
        ),
    })
}

/// The largest torque in drive and while generating.
fn full_load(map: &ExportMap<'_>, machine: &MachineAtSpeeds) -> Option<ExportFile> {
    let most = machine.most.as_ref()?;
    let at = |w: usize| format!("{:.2},{:.4},{:.4}\n", rpm(map, w), most[w], -most[w]);
    let rows: Vec<String> = forward(map).into_iter().map(at).collect();
    (rows.len() >= 2).then(|| ExportFile {
        name: format!("{}.vemp", map.own_name()),
        bytes: format!("n [rpm],T_drive [Nm],T_recuperation [Nm]\n{}", rows.concat()).into_bytes(),
        about: format!("largest torque of the machine, {} speeds", rows.len()),
    })
}
