//! One table for a map over speed and the values of one bound path.

use gearloss_framework::analysis::{OilTemperature, PointResult, merge, notes};

use super::super::super::solve::{RPM, outside};
use super::{Map, set_names, spread, word};
use crate::output::{Failure, Out, Table, number};

/// A quantity in words, and how to read it.
type Shown = (&'static str, fn(&PointResult) -> Option<f64>);

/// The loss, and with a balance the temperature, over speed and the values of the one bound path.
pub fn over_bound(name: &str, maps: &[Map<'_>], out: &mut Out) -> Result<(), Failure> {
    for set in set_names(maps) {
        let of_set: Vec<&Map<'_>> = maps.iter().filter(|m| m.built.name == set).collect();
        let points = &of_set[0].points;
        let shown = spread(points.speeds.len());
        let mut quantities: Vec<Shown> = vec![("loss in W", |p| p.loss)];
        if points.oil == OilTemperature::Balance {
            quantities.push(("oil temperature in degC", |p| p.oil));
        }
        for (words, quantity) in quantities {
            out.line(format!(
                "{name}: {words}, gear {}, {} Nm, models {set}",
                points.gear, points.torques[0]
            ))?;
            let mut head = vec![of_set[0].bound[0].0.clone()];
            head.extend(shown.iter().map(|i| format!("{:.0} rpm", points.speeds[*i] * RPM)));
            let mut table = Table::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
            for map in &of_set {
                let mut row = vec![word(&map.bound[0].1)];
                row.extend(shown.iter().map(|i| number(quantity(&map.solved.points[*i]), 2)));
                table.row(row);
            }
            out.text(&table.render())?;
        }
        // Notes of all maps together: the transmissions differ in the bound value only.
        let mut all = Vec::new();
        for map in &of_set {
            merge(&mut all, &map.solved.seen);
        }
        out.text(&outside(&notes(&of_set[0].built.transmission, &all)))?;
        out.line("")?;
    }
    Ok(())
}
