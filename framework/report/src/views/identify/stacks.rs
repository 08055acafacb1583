//! Losses by mechanism compared with the measured total, as figures.

use gearloss_studies::analyses::identify::IdentificationOfSet;
use gearloss_studies::numbers::RPM;

use super::pictures::{numbered, titled};
use crate::Figure;
use crate::plot::Bar;
use crate::text::fixed;

/// Losses by mechanism and measured total over speed at one torque, before and after the fit.
pub(super) fn pictures(name: &str, stack_at: Option<f64>, o: &IdentificationOfSet) -> Vec<(String, Figure)> {
    let Ok(shares) = &o.found.shares else {
        return Vec::new();
    };
    let measured = &o.found.measured;
    let mut figures = Vec::new();
    for (number, sheet) in o.found.sheets.iter().enumerate() {
        let lines = sheet.lines(measured);
        let most = lines.iter().map(|(torque, _)| *torque).fold(0.0, f64::max);
        let wanted = stack_at.unwrap_or(0.5 * most);
        let nearest = lines
            .iter()
            .min_by(|a, b| (a.0 - wanted).abs().total_cmp(&(b.0 - wanted).abs()));
        let Some((torque, rows)) = nearest else { continue };
        for (which, when) in ["before", "after"].into_iter().enumerate() {
            let bar = |row: &usize| {
                let there = &o.found.rows[which][*row];
                Bar {
                    label: fixed(there.speed * RPM, 0),
                    shares: there.losses.clone(),
                    above: String::new(),
                    measured: there.measured_loss.map(|[loss, accuracy]| (loss, accuracy)),
                    above_measured: String::new(),
                }
            };
            let title = titled(
                format!(
                    "{name}: losses of {} at {torque:.1} Nm and measured total, {when}",
                    o.model_set
                ),
                sheet,
            );
            figures.push((
                numbered(&format!("stack-{when}"), o, number),
                Figure::Bars {
                    title,
                    over: "speed rpm".to_owned(),
                    height: "loss W".to_owned(),
                    names: shares.mechanisms.iter().map(|m| (*m).to_owned()).collect(),
                    bars: rows.iter().map(bar).collect(),
                },
            ));
        }
    }
    figures
}
