//! Transmission loss maps of VECTO.
//!
//! Source: VECTO's user manual, Transmission Loss Map.

use gearloss_studies::analyses::map::{Axes, ExportFile, ExportFormat, ExportMap, Refusal};
use gearloss_studies::analyses::numbers::{RPM, tidy};
use gearloss_studies::register_export;

register_export!(Vecto);

struct Vecto;

impl ExportFormat for Vecto {
    fn name(&self) -> &'static str {
        "vecto"
    }

    fn meaning(&self) -> &'static str {
        "Loss torque over input speed and torque in the format of VECTO, for engineering mode."
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
}
