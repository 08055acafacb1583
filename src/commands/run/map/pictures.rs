//! Pictures of maps.

use gearloss_report::{Cloud, Figure, Map as Picture};
use gearloss_studies::analysis::OilTemperature;
use gearloss_studies::study::Write;

use super::super::super::solve::RPM;
use super::super::Runner;
use super::super::write::picture;
use super::{Axes, Brief, Map, Mark, Shown as ShownGrid, over_bound, set_names, tidy, word};
use crate::output::Failure;

/// A quantity in short, in words, and how to read it.
type Shown = (&'static str, &'static str, fn(&Brief) -> Option<f64>);

/// Pictures over speed and torque; over speed and the bound values where there is one torque and one path is bound.
pub fn pictures(
    runner: &Runner<'_>,
    name: &str,
    maps: &[Map<'_>],
    marks: &[Mark],
    write: &[Write],
) -> Result<(), Failure> {
    let mut quantities: Vec<Shown> = vec![
        ("efficiency", "efficiency in %", |p| p.efficiency.map(|e| 100.0 * e)),
        ("loss", "loss in W", |p| p.loss),
        ("loss-torque", "loss torque in Nm", |p| p.loss_torque),
    ];
    if maps.iter().any(|m| m.oil == OilTemperature::Balance) {
        quantities.push(("temperature", "oil temperature in degC", |p| p.oil));
    }
    let one_picture = over_bound::fits(maps);
    let axes = AxisNames::of(runner);
    // One scale for each quantity, so that maps can be compared by eye.
    let ends = |quantity: fn(&Brief) -> Option<f64>| {
        let values = maps.iter().flat_map(|m| m.kept.points.iter().filter_map(quantity));
        values.fold(None, |ends: Option<(f64, f64)>, x| {
            Some(ends.map_or((x, x), |(low, high)| (low.min(x), high.max(x))))
        })
    };
    for set in set_names(maps) {
        let of_set: Vec<&Map<'_>> = maps.iter().filter(|m| m.built.name == set).collect();
        for (short, long, quantity) in &quantities {
            let ends = ends(*quantity);
            // Without load there is no efficiency to show.
            if of_set
                .iter()
                .all(|m| m.kept.points.iter().all(|p| quantity(p).is_none()))
            {
                continue;
            }
            if let (true, Some(own)) = (one_picture, &of_set[0].kept.grid) {
                let points = || of_set.iter().flat_map(|m| &m.kept.points);
                let figure = Figure::Map(Picture {
                    title: format!(
                        "{name}: {long}, models {set}, gear {}, {} Nm",
                        of_set[0].gear, own.axes.torques[0]
                    ),
                    x: own.axes.over_speed(&axes),
                    y: (
                        of_set[0].bound[0].0.clone(),
                        of_set.iter().map(|m| word(&m.bound[0].1)).collect(),
                    ),
                    values: points().map(quantity).collect(),
                    hatched: points().map(|p| p.outside).collect(),
                    ends,
                    ..Picture::default()
                });
                picture(runner, &format!("{name}-{set}-{short}"), figure, write)?;
                continue;
            }
            for (i, map) in of_set.iter().enumerate() {
                let number = if of_set.len() > 1 {
                    format!("-{}", i + 1)
                } else {
                    String::new()
                };
                let oil = map
                    .oil
                    .given()
                    .map_or_else(String::new, |oil| format!(", oil {oil} °C"));
                let title = format!("{name}: {long}, models {set}, gear {}{oil}{}", map.gear, map.words());
                let shown = Quantity {
                    title: &title,
                    sided: *short == "efficiency",
                    of: *quantity,
                    ends,
                };
                for (side, figure) in figures(map, &shown, &axes, marks) {
                    picture(runner, &format!("{name}-{set}-{short}{number}{side}"), figure, write)?;
                }
            }
        }
    }
    Ok(())
}

/// Names of the axes, with the ports at which torque and speed are given.
pub struct AxisNames {
    speed: String,
    torque: String,
}

impl AxisNames {
    pub fn of(runner: &Runner<'_>) -> Self {
        let conditions = &runner.study.entry.conditions;
        Self {
            speed: format!("speed at {} in rpm", conditions.speed_at),
            torque: format!("torque at {} in Nm", conditions.torque_at),
        }
    }
}

/// What a picture shows of a map.
struct Quantity<'a> {
    title: &'a str,
    /// Whether drive and coast have pictures of their own.
    sided: bool,
    of: fn(&Brief) -> Option<f64>,
    /// Ends of the colours.
    ends: Option<(f64, f64)>,
}

/// The pictures of one quantity of one map. Efficiency falls to zero at no torque from both sides, so each side has a picture
/// of its own.
fn figures(map: &Map<'_>, shown: &Quantity<'_>, names: &AxisNames, marks: &[Mark]) -> Vec<(&'static str, Figure)> {
    let quantity = shown.of;
    let Some(ShownGrid { axes, places }) = &map.kept.grid else {
        let of = |p: &Brief| Some((p.speed * RPM, p.torque, quantity(p)?));
        let cloud = Cloud {
            title: shown.title.to_owned(),
            axes: (names.speed.clone(), names.torque.clone()),
            points: map.kept.points.iter().filter_map(of).collect(),
            diverging: false,
        };
        return vec![("", Figure::Cloud(cloud))];
    };
    let both = axes.torques.iter().any(|t| *t > 0.0) && axes.torques.iter().any(|t| *t < 0.0);
    let sides: &[(&str, &str, fn(f64) -> bool)] = if shown.sided && both {
        &[
            ("-above", ", torque above zero", |t| t > 0.0),
            ("-below", ", torque below zero", |t| t < 0.0),
        ]
    } else {
        &[("", "", |_| true)]
    };
    let columns = axes.speeds.len();
    let marks: Vec<(f64, f64)> = marks
        .iter()
        .filter(|m| m.gear.as_deref().is_none_or(|g| g == map.gear))
        .map(|m| (axes.speed(m.speed), axes.torque(m.torque)))
        .collect();
    let picture = |(file, words, held): &(&'static str, &str, fn(f64) -> bool)| {
        let rows: Vec<usize> = (0..axes.torques.len()).filter(|t| held(axes.torques[*t])).collect();
        let cells = || rows.iter().flat_map(|t| &places[t * columns..(t + 1) * columns]);
        let solved = |place: &Option<usize>| place.map(|i| &map.kept.points[i]);
        let mut y = axes.over_torque(names);
        y.1 = rows.iter().map(|t| y.1[*t].clone()).collect();
        let figure = Figure::Map(Picture {
            title: format!("{}{words}", shown.title),
            x: axes.over_speed(names),
            y,
            values: cells().map(|p| solved(p).and_then(quantity)).collect(),
            hatched: cells().map(|p| solved(p).is_some_and(|p| p.outside)).collect(),
            marks: marks.clone(),
            ends: shown.ends,
            ..Picture::default()
        });
        (*file, figure)
    };
    sides.iter().map(picture).collect()
}

impl Axes {
    /// A speed as the axis counts it.
    fn speed(&self, speed: f64) -> f64 {
        tidy(self.shares[0].map_or(speed * RPM, |rating| speed / rating))
    }

    /// A torque as the axis counts it.
    fn torque(&self, torque: f64) -> f64 {
        tidy(self.shares[1].map_or(torque, |rating| torque / rating))
    }

    /// Name and values of the axis of speeds.
    pub fn over_speed(&self, names: &AxisNames) -> (String, Vec<String>) {
        let name = if self.shares[0].is_some() {
            "speed over rating"
        } else {
            &names.speed
        };
        let values = self.speeds.iter().map(|w| format!("{}", self.speed(*w)));
        (name.to_owned(), values.collect())
    }

    /// Name and values of the axis of torques.
    pub fn over_torque(&self, names: &AxisNames) -> (String, Vec<String>) {
        let name = if self.shares[1].is_some() {
            "torque over rating"
        } else {
            &names.torque
        };
        let values = self.torques.iter().map(|t| format!("{}", self.torque(*t)));
        (name.to_owned(), values.collect())
    }
}
