//! The range of efficiency and loss over all maps, in one sentence.

use gearloss_studies::analyses::map::{MapOfSet, MapOutcome, ShownPoint};
use gearloss_studies::numbers::RPM;

use crate::names::{SetNames, listed};
use crate::page::Page;
use crate::text::{capitalised, extremes, place, range, short};

type Found<'a> = (&'a MapOfSet, &'a ShownPoint);

/// Gears that are named.
const GEARS: usize = 3;

pub fn add(outcome: &MapOutcome, page: &mut Page) {
    let points = || {
        outcome
            .maps
            .iter()
            .flat_map(|map| map.shown.points.iter().map(move |point| (map, point)))
    };
    let of = |value: fn(&ShownPoint) -> Option<f64>| {
        extremes(points().filter_map(move |(map, point)| Some((value(point)?, (map, point)))))
    };
    let sets = outcome.set_names();
    let names = SetNames::new(sets.iter().copied());
    let at = |(map, point): Found<'_>| {
        let set = if sets.len() > 1 {
            format!(" with {}", names.quoted(&map.model_set))
        } else {
            String::new()
        };
        format!("{}{set}", place(point.torque, point.speed * RPM))
    };
    let mut words = Vec::new();
    if let Some([low, high]) = of(|point| {
        point
            .efficiency
            .filter(|_| point.torque != 0.0)
            .map(|share| 100.0 * share)
    }) {
        words.push(format!(
            "the efficiency{} is {} %, highest at {}",
            outcome.of.words(),
            range(low.0, high.0, 1),
            at(high.1)
        ));
        page.key_figure(
            &format!("efficiency{}", outcome.of.words()),
            range(low.0, high.0, 1),
            "%",
            format!("highest at {}", at(high.1)),
        );
    }
    if let Some([low, high]) = of(|point| point.loss) {
        words.push(format!(
            "the loss{} is {} W",
            outcome.of.words(),
            range(low.0, high.0, 0)
        ));
        page.key_figure(
            &format!("loss{}", outcome.of.words()),
            range(low.0, high.0, 0),
            "W",
            format!("largest at {}", at(high.1)),
        );
    }
    let is_given = outcome.maps.iter().all(|map| map.oil.given().is_some());
    let oil = of(|point| point.oil).filter(|ends| ends[1].0 - ends[0].0 > 0.05);
    if let (true, Some([low, high])) = (is_given, oil) {
        words.push(format!("the oil temperature is given, {} °C", range(low.0, high.0, 0)));
    } else if let Some([low, high]) = oil {
        words.push(format!("the oil temperature is {} °C", range(low.0, high.0, 0)));
        page.key_figure(
            "oil temperature",
            range(low.0, high.0, 0),
            "°C",
            format!("highest at {}", at(high.1)),
        );
    }
    let locked = points().filter(|(_, point)| point.locked).count();
    if locked > 0 {
        let count = points().count();
        page.careful.push(format!(
            "the drive locks itself at {locked} of the {count} points shown, which have no loss"
        ));
    }
    let missing = points()
        .filter(|(_, point)| point.loss.is_none() && !point.locked)
        .count();
    if missing > 0 {
        let points = if missing == 1 {
            "point shown has"
        } else {
            "points shown have"
        };
        page.careful
            .push(format!("{missing} {points} no power flow or no defined loss"));
    }
    words.splice(0..0, standstill(outcome));
    // Of several maps each states its own in the text.
    let mut gears = outcome.maps.iter().filter_map(best_gears);
    words.extend(gears.next().filter(|_| gears.next().is_none()));
    let count = match sets.len() {
        1 => String::new(),
        sets => format!("With {sets} model sets "),
    };
    page.headline = (!words.is_empty()).then(|| capitalised(&format!("{count}{}", words.join("; "))));
}

/// The speed up to which no point has a loss, as of a drive that locks itself, while all faster ones have.
fn standstill(outcome: &MapOutcome) -> Option<String> {
    let points = || outcome.maps.iter().flat_map(|map| &map.shown.points);
    let speeds = |has_loss: bool| {
        points()
            .filter(move |point| point.loss.is_some() == has_loss)
            .map(|point| point.speed.abs())
    };
    let fastest = speeds(false).reduce(f64::max)?;
    let slowest = speeds(true).reduce(f64::min)?;
    let (stands, moves) = if points().all(|point| point.loss.is_some() || point.locked) {
        ("the drive locks itself", "it moves")
    } else {
        ("no point has a loss", "every one has")
    };
    (fastest < slowest).then(|| {
        format!(
            "up to {} rpm {stands}, from {} rpm on {moves}",
            short(fastest * RPM),
            short(slowest * RPM)
        )
    })
}

/// The gears that are best at most points.
fn best_gears(map: &MapOfSet) -> Option<String> {
    let mut gears: Vec<_> = map.best_gears.as_ref()?.gears.iter().collect();
    gears.sort_by_key(|gear| std::cmp::Reverse(gear.points));
    let used = gears.iter().filter(|gear| gear.points > 0).take(GEARS);
    let words = used.map(|gear| format!("{} at {} %", gear.gear, short(100.0 * gear.share)));
    let words = listed(&words.collect::<Vec<_>>());
    Some(format!("least is drawn in gear {words} of the points"))
}
