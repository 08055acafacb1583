//! One table for a map over speed and the values of one bound path.

use gearloss_studies::analysis::{OilTemperature, merge, notes};

use super::super::super::solve::RPM;
use super::super::Runner;
use super::{Brief, Map, set_names, spread, word};
use crate::output::{Failure, Out, Table, fixed, number};

/// A quantity in words, and how to read it.
type Shown = (&'static str, fn(&Brief) -> Option<f64>);

/// True for maps of one torque and one gear state, over speed and the values of one bound path.
pub fn fits(maps: &[Map<'_>]) -> bool {
    maps.iter().all(|m| {
        let one = m
            .kept
            .grid
            .as_ref()
            .is_some_and(|shown| shown.axes.torques.len() == 1 && !shown.places.contains(&None));
        one && m.bound.len() == 1 && m.gear == maps[0].gear
    })
}

/// The loss, and with a balance the temperature, over speed and the values of the one bound path.
pub fn over_bound(runner: &Runner<'_>, name: &str, maps: &[Map<'_>], out: &mut Out) -> Result<(), Failure> {
    for set in set_names(maps) {
        let of_set: Vec<&Map<'_>> = maps.iter().filter(|m| m.built.name == set).collect();
        let points = &of_set[0].kept.points;
        let shown = spread(points.len());
        let mut quantities: Vec<Shown> = vec![("loss in W", |p| p.loss)];
        if of_set[0].oil == OilTemperature::Balance {
            quantities.push(("oil temperature in degC", |p| p.oil));
        }
        for (words, quantity) in quantities {
            out.line(format!(
                "{name}: {words}, gear {}, {} Nm, models {set}",
                of_set[0].gear, points[0].torque
            ))?;
            let mut head = vec![of_set[0].bound[0].0.clone()];
            head.extend(
                shown
                    .iter()
                    .map(|i| format!("{} rpm", fixed(points[*i].speed * RPM, 0))),
            );
            let mut table = Table::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
            for map in &of_set {
                let mut row = vec![word(&map.bound[0].1)];
                row.extend(shown.iter().map(|i| number(quantity(&map.kept.points[*i]), 2)));
                table.row(row);
            }
            out.text(&table.render())?;
        }
        // Notes of all maps together: the transmissions differ in the bound value only.
        let mut all = Vec::new();
        for map in &of_set {
            merge(&mut all, &map.seen);
        }
        runner.outside(&notes(&of_set[0].built.transmission, &all), out);
        out.line("")?;
    }
    Ok(())
}
