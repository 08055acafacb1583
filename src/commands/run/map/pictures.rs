//! Pictures of maps.

use gearloss_framework::analysis::{OilTemperature, PointResult};
use gearloss_framework::report::Figure;
use gearloss_framework::study::Write;

use super::super::super::solve::RPM;
use super::super::Runner;
use super::super::write::picture;
use super::{Map, set_names, tidy, word};
use crate::output::Failure;

/// A quantity in short, in words, and how to read it.
type Shown = (&'static str, &'static str, fn(&PointResult) -> Option<f64>);

/// Pictures over speed and torque; over speed and the bound values where there is one torque and one path is bound.
pub fn pictures(runner: &Runner<'_>, name: &str, maps: &[Map<'_>], write: &[Write]) -> Result<(), Failure> {
    let mut quantities: Vec<Shown> = vec![
        ("efficiency", "efficiency in %", |p| p.efficiency.map(|e| 100.0 * e)),
        ("loss", "loss in W", |p| p.loss),
        ("loss-torque", "loss torque in Nm", |p| p.loss_torque),
    ];
    if maps.iter().any(|m| m.points.oil == OilTemperature::Balance) {
        quantities.push(("temperature", "oil temperature in degC", |p| p.oil));
    }
    let Some(first) = maps.first() else { return Ok(()) };
    let label = |x: f64| format!("{}", tidy(x));
    let speeds: Vec<String> = first.points.speeds.iter().map(|w| label(w * RPM)).collect();
    let torques: Vec<String> = first.points.torques.iter().map(|t| label(*t)).collect();
    for set in set_names(maps) {
        let of_set: Vec<&Map<'_>> = maps.iter().filter(|m| m.built.name == set).collect();
        for (short, long, quantity) in &quantities {
            // Without load there is no efficiency to show.
            if of_set
                .iter()
                .all(|m| m.solved.points.iter().all(|p| quantity(p).is_none()))
            {
                continue;
            }
            let values = |map: &Map<'_>| -> Vec<Option<f64>> { map.solved.points.iter().map(quantity).collect() };
            if first.bound.len() == 1 && torques.len() == 1 {
                let bound: Vec<String> = of_set.iter().map(|m| word(&m.bound[0].1)).collect();
                let all: Vec<Option<f64>> = of_set.iter().flat_map(|m| values(m)).collect();
                let title = format!("{name}: {long}, models {set}, {} Nm", torques[0]);
                let figure = Figure::Map {
                    title,
                    x: ("speed rpm".to_owned(), speeds.clone()),
                    y: (first.bound[0].0.clone(), bound),
                    values: all,
                    diverging: false,
                };
                picture(runner, &format!("{name}-{set}-{short}"), figure, write)?;
                continue;
            }
            for (i, map) in of_set.iter().enumerate() {
                let number = if of_set.len() > 1 {
                    format!("-{}", i + 1)
                } else {
                    String::new()
                };
                let title = format!("{name}: {long}, models {set}{}", map.words());
                let figure = Figure::Map {
                    title,
                    x: ("speed rpm".to_owned(), speeds.clone()),
                    y: ("torque Nm".to_owned(), torques.clone()),
                    values: values(map),
                    diverging: false,
                };
                picture(runner, &format!("{name}-{set}-{short}{number}"), figure, write)?;
            }
        }
    }
    Ok(())
}
