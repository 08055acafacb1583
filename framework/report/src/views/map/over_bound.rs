//! A table for maps over speed and the values of one bound path.

use gearloss_studies::analyses::map::{MapOfSet, MapOutcome, NotesOfSet, ShownPoint};
use gearloss_studies::numbers::{RPM, word};
use gearloss_studies::points::OilTemperature;

use crate::page::Page;
use crate::text::{TextTable, fixed, number, spread};

/// A quantity as text, and its reader.
type Quantity = (&'static str, fn(&ShownPoint) -> Option<f64>);

/// The loss, and with a heat balance the temperature, over speed and the values of one bound path.
pub fn show(outcome: &MapOutcome, sets: &[NotesOfSet], page: &mut Page) {
    let name = &outcome.head.analysis;
    for NotesOfSet { model_set, .. } in sets {
        let maps: Vec<&MapOfSet> = outcome.maps.iter().filter(|m| m.model_set == *model_set).collect();
        let points = &maps[0].shown.points;
        let shown = spread(points.len());
        let mut quantities: Vec<Quantity> = vec![("loss in W", |p| p.loss)];
        if maps[0].oil == OilTemperature::Balance {
            quantities.push(("oil temperature in degC", |p| p.oil));
        }
        for (words, quantity) in quantities {
            page.line(format!(
                "{name}: {words}, gear {}, {} Nm, models {model_set}",
                maps[0].gear, points[0].torque
            ));
            let table = TextTable::of(&maps)
                .each(maps[0].bound.keys(), |table, path| {
                    table.column(path, |map| word(&map.bound[path]))
                })
                .each(&shown, |table, i| {
                    let speed = format!("{} rpm", fixed(points[*i].speed * RPM, 0));
                    table.column(speed, |map| number(quantity(&map.shown.points[*i]), 2))
                });
            page.table(table.finish());
        }
        page.line("");
    }
}
