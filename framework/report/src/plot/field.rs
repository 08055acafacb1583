//! Values over two coordinates: coloured cells with labelled contours, and coloured points.

use super::super::contours::{Piece, levels, pieces};
use super::super::{Cloud, Map};
use super::{
    BLACK, Circle, Color, DrawingArea, EmptyElement, HPos, IntoFont, PathElement, PlotError, Pos, RGBColor, Rectangle,
    SVGBackend, Shift, TEXT, Text, VPos, WHITE, drawn, fault, shade, short, two_sided,
};

/// Position and size of the field. \[px\]
const LEFT: i32 = 90;
const TOP: i32 = 50;
const WIDTH: i32 = 740;
const HEIGHT: i32 = 430;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

fn style(colour: &RGBColor, size: i32, pos: Pos) -> plotters::style::TextStyle<'_> {
    ("sans-serif", size).into_font().color(colour).pos(pos)
}

/// The range of values; symmetric about zero for differences.
fn range(values: impl Iterator<Item = f64>, diverging: bool) -> Option<(f64, f64)> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in values {
        low = low.min(value);
        high = high.max(value);
    }
    if low > high {
        return None;
    }
    // Zero in the middle, so that both signs have the same weight.
    let most = low.abs().max(high.abs());
    Some(if diverging { (-most, most) } else { (low, high) })
}

/// Colour of a value.
fn tone(value: f64, (low, high): (f64, f64), diverging: bool) -> RGBColor {
    let share = if high > low { (value - low) / (high - low) } else { 0.5 };
    if diverging { two_sided(share) } else { shade(share) }
}

fn bar_of_colours(root: &Area<'_>, (low, high): (f64, f64), diverging: bool) -> Result<(), PlotError> {
    let (x, steps) = (LEFT + WIDTH + 30, 40);
    for k in 0..steps {
        let part = [
            (x, TOP + HEIGHT - HEIGHT * (k + 1) / steps),
            (x + 18, TOP + HEIGHT - HEIGHT * k / steps),
        ];
        let value = low + (high - low) * (f64::from(k) + 0.5) / f64::from(steps);
        let colour = tone(value, (low, high), diverging);
        root.draw(&Rectangle::new(part, colour.filled())).map_err(fault)?;
    }
    for (value, y) in [(low, TOP + HEIGHT), (0.5 * (low + high), TOP + HEIGHT / 2), (high, TOP)] {
        let beside = style(&BLACK, TEXT - 2, Pos::new(HPos::Left, VPos::Center));
        root.draw(&Text::new(short(value), (x + 24, y), beside))
            .map_err(fault)?;
    }
    Ok(())
}

fn names(root: &Area<'_>, x: &str, y: &str) -> Result<(), PlotError> {
    let below = style(&BLACK, TEXT, Pos::new(HPos::Center, VPos::Top));
    let at = (LEFT + WIDTH / 2, TOP + HEIGHT + 34);
    root.draw(&Text::new(x.to_owned(), at, below)).map_err(fault)?;
    let above = style(&BLACK, TEXT, Pos::new(HPos::Left, VPos::Bottom));
    root.draw(&Text::new(y.to_owned(), (20, TOP - 4), above)).map_err(fault)
}

/// A map: one coloured cell for each pair of values, with labelled contours if the coordinates are numbers; otherwise cells that are large
/// enough show their values.
///
/// # Errors
/// If drawing fails.
pub fn map(map: &Map) -> Result<String, PlotError> {
    drawn(&map.title, |root| {
        let (xs, ys) = (&map.x.1, &map.y.1);
        let (columns, rows) = (xs.len().max(1) as i32, ys.len().max(1) as i32);
        let range_of_map = range(map.values.iter().flatten().copied(), map.diverging);
        let Some(range) = map.ends.filter(|_| range_of_map.is_some()).or(range_of_map) else {
            return names(root, &map.x.0, &map.y.0);
        };
        let x_at = |i: i32| LEFT + WIDTH * i / columns;
        let y_at = |j: i32| TOP + HEIGHT - HEIGHT * j / rows;
        let lined = map.numbers().is_some() && columns > 3 && rows > 3;
        let size = (WIDTH / columns / 4).min(HEIGHT / rows / 2).clamp(6, TEXT);
        // Small cells show no numbers.
        let numbered = !lined && WIDTH / columns >= 34 && HEIGHT / rows >= 14;
        let middle = Pos::new(HPos::Center, VPos::Center);
        let all_over = map.is_hatched_all_over();
        for (k, value) in map.values.iter().enumerate() {
            let Some(value) = *value else { continue };
            let (i, j) = (k as i32 % columns, k as i32 / columns);
            let cell = [(x_at(i), y_at(j + 1)), (x_at(i + 1), y_at(j))];
            let colour = tone(value, range, map.diverging);
            root.draw(&Rectangle::new(cell, colour.filled())).map_err(fault)?;
            if !all_over && map.hatched.get(k).copied().unwrap_or(false) {
                let stroke = vec![(cell[0].0, cell[1].1), (cell[1].0, cell[0].1)];
                root.draw(&PathElement::new(stroke, BLACK.mix(0.25))).map_err(fault)?;
            }
            if numbered {
                let dark =
                    0.299 * f64::from(colour.0) + 0.587 * f64::from(colour.1) + 0.114 * f64::from(colour.2) < 128.0;
                let ink = if dark { WHITE } else { BLACK };
                let at = (i32::midpoint(cell[0].0, cell[1].0), i32::midpoint(cell[0].1, cell[1].1));
                root.draw(&Text::new(short(value), at, style(&ink, size, middle)))
                    .map_err(fault)?;
            }
        }
        let place = |(i, j): (f64, f64)| {
            let x = f64::from(LEFT) + f64::from(WIDTH) * (i + 0.5) / f64::from(columns);
            let y = f64::from(TOP + HEIGHT) - f64::from(HEIGHT) * (j + 0.5) / f64::from(rows);
            (x.round() as i32, y.round() as i32)
        };
        let is_cut = cut(map);
        if lined {
            let mut labels: Vec<(i32, i32)> = Vec::new();
            for level in levels(range.0, range.1, 8) {
                let line = pieces(&map.values, xs.len(), level, &is_cut);
                draw_line(root, &line, &place, 1)?;
                if let Some(at) = free_place(&line, &place, &labels) {
                    labels.push(at);
                    let words = short_level(level);
                    let half = 4 * words.len() as i32;
                    let back = Rectangle::new(
                        [(at.0 - half, at.1 - 8), (at.0 + half, at.1 + 8)],
                        WHITE.mix(0.75).filled(),
                    );
                    root.draw(&back).map_err(fault)?;
                    root.draw(&Text::new(words, at, style(&BLACK, TEXT - 2, middle)))
                        .map_err(fault)?;
                }
            }
            for level in map.unseen.iter().filter(|l| **l > 0.0).flat_map(|l| [-l, *l]) {
                draw_line(root, &pieces(&map.values, xs.len(), level, &is_cut), &place, 3)?;
            }
        }
        if let Some((x, y)) = map.numbers() {
            for (mx, my) in &map.marks {
                if let (Some(i), Some(j)) = (within(&x, *mx), within(&y, *my)) {
                    root.draw(&(EmptyElement::at(place((i, j))) + Circle::new((0, 0), 3, BLACK.stroke_width(1))))
                        .map_err(fault)?;
                }
            }
        }
        if let Some((cell, _)) = map.crossed.as_ref().filter(|(cell, _)| *cell < map.values.len()) {
            cross(root, place(((cell % xs.len()) as f64, (cell / xs.len()) as f64)))?;
        }
        let every = |count: usize| count.div_ceil(16).max(1);
        for (i, x) in xs.iter().enumerate().step_by(every(xs.len())) {
            let at = (i32::midpoint(x_at(i as i32), x_at(i as i32 + 1)), TOP + HEIGHT + 6);
            let below = style(&BLACK, TEXT - 2, Pos::new(HPos::Center, VPos::Top));
            root.draw(&Text::new(x.clone(), at, below)).map_err(fault)?;
        }
        for (j, y) in ys.iter().enumerate().step_by(every(ys.len())) {
            let at = (LEFT - 6, i32::midpoint(y_at(j as i32), y_at(j as i32 + 1)));
            let beside = style(&BLACK, TEXT - 2, Pos::new(HPos::Right, VPos::Center));
            root.draw(&Text::new(y.clone(), at, beside)).map_err(fault)?;
        }
        let mut words = map.x.0.clone();
        words.push_str(map.words_of_hatching());
        if let Some(level) = map.unseen.filter(|_| lined) {
            words.push_str(&format!("; thick line: accuracy of the instrument, {}", short(level)));
        }
        if let Some((_, what)) = &map.crossed {
            words.push_str(&format!("; cross: {what}"));
        }
        names(root, &words, &map.y.0)?;
        bar_of_colours(root, range, map.diverging)
    })
}

/// The cells between drive and coast, where the value jumps.
fn cut(map: &Map) -> impl Fn(usize, usize) -> bool {
    let (xs, ys) = map.numbers().filter(|_| map.jumps).unwrap_or_default();
    move |i, j| {
        let crosses = |list: &[f64], k: usize| list.get(k..k + 2).is_some_and(|pair| pair[0] * pair[1] < 0.0);
        crosses(&xs, i) || crosses(&ys, j)
    }
}

/// A cross that is visible on dark and on light cells.
fn cross(root: &Area<'_>, (x, y): (i32, i32)) -> Result<(), PlotError> {
    const ARM: i32 = 7;
    for (colour, width) in [(&WHITE, 5), (&BLACK, 2)] {
        for arm in [ARM, -ARM] {
            let stroke = vec![(x - ARM, y - arm), (x + ARM, y + arm)];
            root.draw(&PathElement::new(stroke, colour.stroke_width(width)))
                .map_err(fault)?;
        }
    }
    Ok(())
}

fn short_level(level: f64) -> String {
    format!("{}", (level * 1e6).round() / 1e6)
}

fn draw_line(
    root: &Area<'_>,
    line: &[Piece],
    place: &dyn Fn((f64, f64)) -> (i32, i32),
    width: u32,
) -> Result<(), PlotError> {
    for [from, to] in line {
        let piece = PathElement::new(vec![place(*from), place(*to)], BLACK.mix(0.8).stroke_width(width));
        root.draw(&piece).map_err(fault)?;
    }
    Ok(())
}

/// The middle of the piece that is farthest from labels and border.
fn free_place(line: &[Piece], place: &dyn Fn((f64, f64)) -> (i32, i32), taken: &[(i32, i32)]) -> Option<(i32, i32)> {
    let room = |(x, y): (i32, i32)| {
        let border = [x - LEFT, LEFT + WIDTH - x, y - TOP, TOP + HEIGHT - y];
        let labels = taken.iter().map(|(a, b)| (x - a).abs().max(2 * (y - b).abs()));
        border.into_iter().chain(labels).min().unwrap_or(0)
    };
    let middles = line.iter().map(|[p, q]| place((0.5 * (p.0 + q.0), 0.5 * (p.1 + q.1))));
    middles.max_by_key(|at| room(*at)).filter(|at| room(*at) >= 16)
}

/// Fractional index of a value in an increasing or decreasing list.
fn within(values: &[f64], x: f64) -> Option<f64> {
    values.windows(2).enumerate().find_map(|(i, w)| {
        let share = (x - w[0]) / (w[1] - w[0]);
        (-0.5..=1.0).contains(&share).then_some(i as f64 + share)
    })
}

/// Coloured points.
///
/// # Errors
/// If drawing fails.
pub fn cloud(cloud: &Cloud) -> Result<String, PlotError> {
    drawn(&cloud.title, |root| {
        let of = |f: fn(&(f64, f64, f64)) -> f64| cloud.points.iter().map(f);
        let ranges = (
            range(of(|p| p.0), false),
            range(of(|p| p.1), false),
            range(of(|p| p.2), cloud.diverging),
        );
        let (Some(x), Some(y), Some(z)) = ranges else {
            return names(root, &cloud.axes.0, &cloud.axes.1);
        };
        let share = |value: f64, (low, high): (f64, f64)| {
            let share = if high > low { (value - low) / (high - low) } else { 0.5 };
            0.04 + 0.92 * share
        };
        let frame = [(LEFT, TOP), (LEFT + WIDTH, TOP + HEIGHT)];
        root.draw(&Rectangle::new(frame, BLACK.stroke_width(1)))
            .map_err(fault)?;
        for (k, (px, py, value)) in cloud.points.iter().enumerate() {
            let size = (12.0 * cloud.sizes.get(k).map_or(0.5, |share| share.sqrt())).max(2.0) as i32;
            let at = (
                LEFT + (f64::from(WIDTH) * share(*px, x)) as i32,
                TOP + HEIGHT - (f64::from(HEIGHT) * share(*py, y)) as i32,
            );
            let colour = tone(*value, z, cloud.diverging);
            root.draw(&Circle::new(at, size, colour.filled())).map_err(fault)?;
            root.draw(&Circle::new(at, size, BLACK.stroke_width(1)))
                .map_err(fault)?;
        }
        for k in 0..=4 {
            let part = f64::from(k) / 4.0;
            let below = style(&BLACK, TEXT - 2, Pos::new(HPos::Center, VPos::Top));
            let value = x.0 + part * (x.1 - x.0);
            let at = (LEFT + (f64::from(WIDTH) * share(value, x)) as i32, TOP + HEIGHT + 6);
            root.draw(&Text::new(short(value), at, below)).map_err(fault)?;
            let beside = style(&BLACK, TEXT - 2, Pos::new(HPos::Right, VPos::Center));
            let value = y.0 + part * (y.1 - y.0);
            let at = (LEFT - 6, TOP + HEIGHT - (f64::from(HEIGHT) * share(value, y)) as i32);
            root.draw(&Text::new(short(value), at, beside)).map_err(fault)?;
        }
        names(root, &cloud.axes.0, &cloud.axes.1)?;
        bar_of_colours(root, z, cloud.diverging)
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn words(list: &[&str]) -> Vec<String> {
        list.iter().map(|w| (*w).to_owned()).collect()
    }

    #[test]
    fn a_small_map_numbers_its_cells() {
        let svg = map(&Map {
            title: "Loss".to_owned(),
            x: ("speed rpm".to_owned(), words(&["1000", "2000"])),
            y: ("volume ml".to_owned(), words(&["60", "90"])),
            values: vec![Some(1.5), None, Some(3.0), Some(4.0)],
            ..Map::default()
        })
        .unwrap();
        for word in ["speed rpm", "volume ml", "1.50", "2000", "60"] {
            assert!(svg.contains(word), "{word}");
        }
    }

    #[test]
    fn a_large_map_has_labelled_lines_marks_and_hatching() {
        let numbers = words(&["1", "2", "3", "4", "5"]);
        let svg = map(&Map {
            title: "Efficiency".to_owned(),
            x: ("speed".to_owned(), numbers.clone()),
            y: ("torque".to_owned(), numbers),
            values: (0..25).map(|k| Some(90.0 + f64::from(k % 5 + k / 5))).collect(),
            hatched: (0..25).map(|k| k < 3).collect(),
            marks: vec![(2.5, 3.0), (99.0, 0.0)],
            unseen: Some(93.5),
            crossed: Some((7, "minimum".to_owned())),
            ..Map::default()
        })
        .unwrap();
        for word in ["96", "hatched", "thick", "cross: minimum"] {
            assert!(svg.contains(word), "{word}");
        }
        assert_eq!(
            svg.matches("<circle").count(),
            1,
            "a mark outside the field is not drawn"
        );
    }

    #[test]
    fn a_cloud_shows_every_point() {
        let svg = cloud(&Cloud {
            title: "Differences".to_owned(),
            axes: ("speed".to_owned(), "torque".to_owned()),
            points: vec![(1.0, 2.0, -0.5), (3.0, 4.0, 0.25)],
            diverging: true,
            ..Cloud::default()
        })
        .unwrap();
        assert_eq!(svg.matches("<circle").count(), 4);
    }
}
