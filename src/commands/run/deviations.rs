//! Differences from measured points over speed and torque.

use gearloss_framework::analysis::levels;
use gearloss_framework::report::{Cloud, Figure, Map};

/// A difference at a torque in Nm and a speed in rpm.
pub type Deviation = (f64, f64, Option<f64>);

/// As a map where the points lie on a grid, but for the scatter of a rig; else as dots. `unseen` is the accuracy of the
/// measurement, `ends` those of the colours where several pictures share them.
pub fn picture(title: String, points: &[Deviation], unseen: Option<f64>, ends: Option<(f64, f64)>) -> Figure {
    let over = |f: fn(&Deviation) -> f64| points.iter().map(f).collect::<Vec<_>>();
    let (torques, speeds) = (levels(&over(|p| p.0)), levels(&over(|p| p.1)));
    let mut values = vec![None; torques.len() * speeds.len()];
    let mut on_grid = torques.len() > 1 && speeds.len() > 1 && values.len() == points.len();
    for (i, point) in points.iter().enumerate() {
        let line = |lines: &[Vec<usize>]| lines.iter().position(|line| line.contains(&i)).unwrap_or(0);
        let place = line(&torques) * speeds.len() + line(&speeds);
        on_grid &= values.get(place).is_some_and(Option::is_none);
        if let Some(value) = values.get_mut(place) {
            *value = point.2;
        }
    }
    let axes = ("speed rpm".to_owned(), "torque Nm".to_owned());
    if !on_grid {
        let of = |p: &Deviation| Some((p.1, p.0, p.2?));
        return Figure::Cloud(Cloud {
            title,
            axes,
            points: points.iter().filter_map(of).collect(),
            diverging: true,
        });
    }
    let mean = |lines: &[Vec<usize>], f: fn(&Deviation) -> f64| -> Vec<String> {
        let of = |line: &Vec<usize>| line.iter().map(|i| f(&points[*i])).sum::<f64>() / line.len() as f64;
        lines.iter().map(|line| format!("{:.3}", of(line))).collect()
    };
    Figure::Map(Map {
        title,
        x: (axes.0, mean(&speeds, |p| p.1)),
        y: (axes.1, mean(&torques, |p| p.0)),
        values,
        diverging: true,
        unseen,
        ends,
        ..Map::default()
    })
}
