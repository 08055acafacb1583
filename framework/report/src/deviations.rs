//! Figures of differences: over speed and torque, as histograms, as parity plots.

use gearloss_studies::points::{histogram, levels};

use crate::figure::jumps;
use crate::plot::{Line, Stroke};
use crate::{Cloud, Figure, Map};

/// A difference at a torque in Nm and a speed in rpm.
pub type Deviation = (f64, f64, Option<f64>);

/// A map of a quantity with its unit if the points lie on a grid apart from the scatter of a rig, otherwise dots. `unseen` is the accuracy
/// of the measurement; `ends` is the colour range if several figures share it.
pub fn picture(
    title: String,
    (what, unit): (&str, &str),
    points: &[Deviation],
    unseen: Option<f64>,
    ends: Option<(f64, f64)>,
) -> Figure {
    let (torques, speeds) = lines(points);
    let mut values = vec![None; torques.len() * speeds.len()];
    let on_grid = torques.len() > 1 && speeds.len() > 1 && values.len() == points.len();
    for (row, line) in torques.iter().enumerate().filter(|_| on_grid) {
        for i in line {
            let column = speeds.iter().position(|line| line.contains(i)).unwrap_or(0);
            values[row * speeds.len() + column] = points[*i].2;
        }
    }
    let axes = ("speed rpm".to_owned(), "torque Nm".to_owned());
    if !on_grid {
        let of = |p: &Deviation| Some((p.1, p.0, p.2?));
        return Figure::Cloud(Cloud {
            title,
            axes,
            points: points.iter().filter_map(of).collect(),
            unit: unit.to_owned(),
            diverging: true,
            ..Cloud::default()
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
        unit: unit.to_owned(),
        jumps: jumps(what),
        diverging: true,
        unseen,
        ends,
        ..Map::default()
    })
}

/// Points as a grid of torques and speeds. Speeds are set values; torques scatter. The first torque of every speed forms one row, the
/// second the next. Absent if speeds have different numbers of points or rows overlap.
fn lines(points: &[Deviation]) -> (Vec<Vec<usize>>, Vec<Vec<usize>>) {
    let speeds = levels(&points.iter().map(|p| p.1).collect::<Vec<_>>());
    let count = speeds.first().map_or(0, Vec::len);
    if speeds.iter().any(|line| line.len() != count) {
        return (Vec::new(), speeds);
    }
    let mut torques: Vec<Vec<usize>> = vec![Vec::new(); count];
    for column in &speeds {
        let mut column = column.clone();
        column.sort_by(|a, b| points[*a].0.total_cmp(&points[*b].0));
        for (line, i) in torques.iter_mut().zip(column) {
            line.push(i);
        }
    }
    let end = |line: &[usize], sign: f64| {
        line.iter()
            .map(|i| sign * points[*i].0)
            .fold(f64::NEG_INFINITY, f64::max)
    };
    if torques.windows(2).any(|w| end(&w[0], 1.0) >= -end(&w[1], -1.0)) {
        torques.clear();
    }
    (torques, speeds)
}

/// Histogram of the differences with the same bins for every set.
pub fn histograms(name: &str, (what, unit): (&str, &str), lists: Vec<(String, Vec<f64>)>) -> Figure {
    let all: Vec<f64> = lists.iter().flat_map(|(_, list)| list.iter().copied()).collect();
    let (from, width, cells) = histogram(&all);
    let steps = |(set, list): (String, Vec<f64>)| {
        let mut counts = vec![0.0; cells.len()];
        for x in list {
            let cell = (((x - from) / width) as usize).min(cells.len().saturating_sub(1));
            counts[cell] += 1.0;
        }
        let mut points = vec![Some((from, 0.0))];
        for (i, count) in counts.iter().enumerate() {
            let left = from + width * i as f64;
            points.extend([Some((left, *count)), Some((left + width, *count))]);
        }
        points.push(Some((from + width * cells.len() as f64, 0.0)));
        Line {
            name: set,
            points,
            stroke: Stroke::Line,
        }
    };
    Figure::Lines {
        title: format!("{name}: histogram of the differences"),
        x: format!("difference of {what} in {unit}"),
        y: "points".to_owned(),
        lines: lists.into_iter().map(steps).collect(),
    }
}

/// A parity plot: one quantity over its reference value, with the line of equal values.
pub fn parity(name: &str, what: &str, (x, y): (&str, &str), lists: Vec<(String, Vec<Option<(f64, f64)>>)>) -> Figure {
    let all = || lists.iter().flat_map(|(_, list)| list.iter().flatten());
    let ends = all().fold(None, |ends: Option<(f64, f64)>, (a, b)| {
        let (low, high) = ends.unwrap_or((*a, *a));
        Some((low.min(*a).min(*b), high.max(*a).max(*b)))
    });
    let mut lines: Vec<Line> = Vec::new();
    for (set, points) in lists {
        lines.push(Line {
            name: set,
            points,
            stroke: Stroke::Dots,
        });
    }
    if let Some((low, high)) = ends {
        lines.push(Line {
            name: "equal".to_owned(),
            points: vec![Some((low, low)), Some((high, high))],
            stroke: Stroke::Line,
        });
    }
    Figure::Lines {
        title: format!("{name}: parity of {what}"),
        x: x.to_owned(),
        y: y.to_owned(),
        lines,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn torques_that_drift_with_the_speed_are_lines_all_the_same() {
        let at = |torque: f64, speed: f64| (torque + 1e-5 * speed, speed, Some(torque));
        let points = [at(2.0, 1000.0), at(4.0, 1000.0), at(4.0, 9000.0), at(2.0, 9000.0)];
        let (torques, speeds) = lines(&points);
        assert_eq!(
            (torques, speeds),
            (vec![vec![0, 3], vec![1, 2]], vec![vec![0, 1], vec![2, 3]])
        );
        let Figure::Map(map) = picture(String::new(), ("", ""), &points, None, None) else {
            panic!("a grid is a map");
        };
        assert_eq!(map.values, [Some(2.0), Some(2.0), Some(4.0), Some(4.0)]);
    }

    #[test]
    fn what_is_no_grid_is_a_cloud() {
        let at = |torque: f64, speed: f64| (torque, speed, Some(1.0));
        for points in [
            vec![at(2.0, 1000.0), at(4.0, 1000.0), at(3.0, 9000.0)],
            vec![at(2.0, 1000.0), at(4.0, 1000.0), at(4.0, 9000.0), at(6.0, 9000.0)],
            vec![],
        ] {
            assert!(matches!(
                picture(String::new(), ("", ""), &points, None, None),
                Figure::Cloud(_)
            ));
        }
    }
}
