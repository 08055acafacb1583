//! Figures as SVG: stacked bars, maps, lines.

// Pixel coordinates are small numbers.
#![allow(clippy::cast_possible_wrap)]

mod field;
mod intervals;

use gearloss_framework::document::visible;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use serde::Serialize;

/// Colours that are distinguishable for every kind of colour vision (Okabe and Ito 2008).
pub(super) const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(230, 159, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(213, 94, 0),
    RGBColor(240, 228, 66),
    RGBColor(120, 120, 120),
];

/// Colours of the mechanisms, which are those of the report.
const MECHANISMS: [(&str, RGBColor); 11] = [
    ("gear_mesh", RGBColor(0x1f, 0x77, 0xb4)),
    ("bearing", RGBColor(0xe6, 0x9f, 0x00)),
    ("gear_drag", RGBColor(0x12, 0xb4, 0x88)),
    ("seal", RGBColor(0xb8, 0x32, 0x80)),
    ("planetary_drag", RGBColor(0x56, 0xb4, 0xe9)),
    ("clutch", RGBColor(0xd7, 0x68, 0x21)),
    ("synchronizer", RGBColor(0x5d, 0x55, 0xc8)),
    ("auxiliary", RGBColor(0xc1, 0xdd, 0x59)),
    ("chain", RGBColor(0x6f, 0x52, 0x1c)),
    ("differential", RGBColor(0x70, 0x20, 0x70)),
    ("others", RGBColor(0xa9, 0xb0, 0xb8)),
];

/// Mechanisms of the components of a section of the gearbox.
const SECTIONS: [(&str, &str); 13] = [
    ("meshes", "gear_mesh"),
    ("bevel_meshes", "gear_mesh"),
    ("worm_meshes", "gear_mesh"),
    ("crossed_helical_meshes", "gear_mesh"),
    ("gears", "gear_drag"),
    ("bearings", "bearing"),
    ("seals", "seal"),
    ("planetary_sets", "planetary_drag"),
    ("clutches", "clutch"),
    ("couplings", "synchronizer"),
    ("auxiliaries", "auxiliary"),
    ("chains", "chain"),
    ("differentials", "differential"),
];

/// Shares of black (negative) or white in the shades of several components with one mechanism.
const SHADES: [f64; 5] = [0.0, 0.4, -0.35, 0.2, -0.18];

/// Anchors of the colour scale viridis, whose lightness increases evenly.
const SCALE: [(u8, u8, u8); 6] = [
    (68, 1, 84),
    (65, 68, 135),
    (42, 120, 142),
    (34, 168, 132),
    (122, 209, 81),
    (253, 231, 37),
];

const SIZE: (u32, u32) = (960, 560);
const TEXT: i32 = 15;

/// Why a figure could not be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct PlotError(String);

pub(super) use field::{cloud, map};
pub use intervals::Interval;
pub(super) use intervals::intervals;

/// One bar of a stack.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Bar {
    /// Below the bar.
    pub label: String,
    /// Heights from the bottom up, in the order of the names.
    pub shares: Vec<f64>,
    /// Above the bar.
    pub above: String,
    /// Measured height with its accuracy, next to the stack.
    pub measured: Option<(f64, f64)>,
    /// Above the measured bar.
    pub above_measured: String,
}

/// One line.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Line {
    /// Name in the legend.
    pub name: String,
    /// Points; a gap interrupts the line.
    pub points: Vec<Option<(f64, f64)>>,
    /// How it is drawn.
    pub stroke: Stroke,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stroke {
    /// As a line.
    #[default]
    Line,
    /// As a line with its points.
    Marked,
    /// As points without a line.
    Dots,
}

fn drawn(
    title: &str,
    draw: impl FnOnce(&DrawingArea<SVGBackend<'_>, Shift>) -> Result<(), PlotError>,
) -> Result<String, PlotError> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(fault)?;
        let heading = ("sans-serif", TEXT + 3).into_font().color(&BLACK);
        root.draw(&Text::new(title.to_owned(), (16, 14), heading))
            .map_err(fault)?;
        draw(&root)?;
        root.present().map_err(fault)?;
    }
    // The unit as readers write it.
    Ok(visible(&svg).replace("degC", "°C"))
}

fn fault(error: impl std::fmt::Display) -> PlotError {
    PlotError(error.to_string())
}

fn colour(i: usize) -> RGBColor {
    COLOURS[i % COLOURS.len()]
}

/// The mechanism of a share of a loss, and whether it is one of several parts with this mechanism: `bearings.B2` is one of the bearings.
fn mechanism_of(name: &str) -> Option<(&str, bool)> {
    match name {
        "gears, load-dependent" => return Some(("gear_mesh", false)),
        "gears, load-independent" => return Some(("gear_drag", false)),
        "bearings, load-dependent" => return Some(("bearing", false)),
        "bearings, load-independent" => return Some(("bearing", true)),
        "seals" => return Some(("seal", false)),
        _ => {}
    }
    if MECHANISMS.iter().any(|(own, _)| *own == name) {
        return Some((name, false));
    }
    let (section, rest) = name.split_once('.')?;
    let (_, own) = SECTIONS.iter().find(|(own, _)| *own == section)?;
    let is_drag = section == "meshes" && rest.contains(".drag");
    Some((if is_drag { "gear_drag" } else { own }, true))
}

/// Colours of stacked shares: mechanisms have theirs, components the shades of their mechanism's, other names those of their place.
fn colours_of(names: &[String]) -> Vec<RGBColor> {
    let mut parts: Vec<&str> = Vec::new();
    let own = names.iter().enumerate().map(|(i, name)| {
        let Some((mechanism, is_part)) = mechanism_of(name) else {
            return colour(i);
        };
        let base = MECHANISMS.iter().find(|(own, _)| *own == mechanism);
        let base = base.map_or(colour(i), |(_, colour)| *colour);
        if !is_part {
            return base;
        }
        let count = parts.iter().filter(|other| **other == mechanism).count();
        parts.push(mechanism);
        let share = SHADES[count % SHADES.len()];
        let end = if share > 0.0 { 255.0 } else { 0.0 };
        let mix = |own: u8| (f64::from(own) + share.abs() * (end - f64::from(own))).round() as u8;
        RGBColor(mix(base.0), mix(base.1), mix(base.2))
    });
    own.collect()
}

/// A colour of the scale, from zero to one.
fn shade(share: f64) -> RGBColor {
    let place = share.clamp(0.0, 1.0) * (SCALE.len() - 1) as f64;
    let i = (place.floor() as usize).min(SCALE.len() - 2);
    let mix = |a: u8, b: u8| (f64::from(a) + (place - i as f64) * (f64::from(b) - f64::from(a))).round() as u8;
    let (a, b) = (SCALE[i], SCALE[i + 1]);
    RGBColor(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

/// A colour from blue over white to orange, zero to one.
fn two_sided(share: f64) -> RGBColor {
    let side = if share < 0.5 { COLOURS[4] } else { COLOURS[1] };
    let weight = (2.0 * share.clamp(0.0, 1.0) - 1.0).abs();
    let mix = |end: u8| (255.0 + weight * (f64::from(end) - 255.0)).round() as u8;
    RGBColor(mix(side.0), mix(side.1), mix(side.2))
}

/// A number with a sensible number of digits.
fn short(x: f64) -> String {
    let digits = match x.abs() {
        0.0 => 0,
        a if a >= 100.0 => 0,
        a if a >= 10.0 => 1,
        a if a >= 1.0 => 2,
        a if a >= 0.1 => 3,
        _ => 4,
    };
    format!("{x:.digits$}")
}

/// Range of numbers with a margin.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for x in values.filter(|x| x.is_finite()) {
        low = low.min(x);
        high = high.max(x);
    }
    if low > high {
        return (0.0, 1.0);
    }
    let span = (high - low).max(1e-9 * high.abs()).max(1e-12);
    (low - 0.03 * span, high + 0.08 * span)
}

fn legend(
    root: &DrawingArea<SVGBackend<'_>, Shift>,
    names: &[String],
    colours: &[RGBColor],
    solid: bool,
) -> Result<(), PlotError> {
    let style = ("sans-serif", TEXT).into_font().color(&BLACK);
    for (i, name) in names.iter().enumerate() {
        let colour = colours.get(i).copied().unwrap_or_else(|| colour(i));
        let (x, y) = (SIZE.0 as i32 - 190, 60 + 24 * i as i32);
        let mark = if solid {
            Rectangle::new([(x, y), (x + 16, y + 14)], colour.filled())
        } else {
            Rectangle::new([(x, y + 6), (x + 16, y + 9)], colour.filled())
        };
        root.draw(&mark).map_err(fault)?;
        root.draw(&Text::new(name.clone(), (x + 24, y), style.clone()))
            .map_err(fault)?;
    }
    Ok(())
}

/// Stacked bars, each with space for a measured bar and its accuracy.
///
/// # Errors
/// If drawing fails.
pub(super) fn bars(
    title: &str,
    (over, height): (&str, &str),
    names: &[String],
    bars: &[Bar],
) -> Result<String, PlotError> {
    let colours = colours_of(names);
    drawn(title, |root| {
        let measured = bars.iter().any(|b| b.measured.is_some());
        let tallest = bars
            .iter()
            .flat_map(|b| [b.shares.iter().sum(), b.measured.map_or(0.0, |(m, e)| m + e)])
            .fold(0.0, f64::max);
        let count = bars.len().max(1) as f64;
        let area = root.margin(40, 10, 10, 200);
        let mut chart = ChartBuilder::on(&area)
            .x_label_area_size(80)
            .y_label_area_size(70)
            .build_cartesian_2d(0.0..count, 0.0..(1.12 * tallest).max(1e-9))
            .map_err(fault)?;
        chart
            .configure_mesh()
            .disable_x_mesh()
            .disable_x_axis()
            .y_desc(height)
            .light_line_style(TRANSPARENT)
            .label_style(("sans-serif", TEXT))
            .axis_desc_style(("sans-serif", TEXT))
            .draw()
            .map_err(fault)?;
        let centred = ("sans-serif", TEXT - 2)
            .into_font()
            .color(&BLACK)
            .pos(Pos::new(HPos::Center, VPos::Bottom));
        for (i, bar) in bars.iter().enumerate() {
            let left = i as f64 + 0.12;
            let right = if measured { i as f64 + 0.50 } else { i as f64 + 0.88 };
            let mut low = 0.0;
            for (k, share) in bar.shares.iter().enumerate() {
                let own = colours.get(k).copied().unwrap_or_else(|| colour(k));
                let part = Rectangle::new([(left, low), (right, low + share)], own.filled());
                chart.draw_series([part]).map_err(fault)?;
                low += share;
            }
            let mut text = |x: f64, y: f64, text: &str| {
                let text = Text::new(text.to_owned(), (x, y), centred.clone());
                chart.draw_series([text]).map(|_| ()).map_err(fault)
            };
            text(0.5 * (left + right), low + 0.01 * tallest, &bar.above)?;
            if let Some((value, error)) = bar.measured {
                let (left, right) = (i as f64 + 0.52, i as f64 + 0.88);
                let middle = 0.5 * (left + right);
                text(middle, value + error + 0.01 * tallest, &bar.above_measured)?;
                let outline = Rectangle::new([(left, 0.0), (right, value)], BLACK.stroke_width(1));
                chart.draw_series([outline]).map_err(fault)?;
                let whisker = vec![(middle, (value - error).max(0.0)), (middle, value + error)];
                chart
                    .draw_series([PathElement::new(whisker, BLACK.stroke_width(2))])
                    .map_err(fault)?;
            }
            // Below the axis.
            let (x, y) = chart.backend_coord(&(i as f64 + 0.5, 0.0));
            let below = ("sans-serif", TEXT - 2)
                .into_font()
                .color(&BLACK)
                .pos(Pos::new(HPos::Center, VPos::Top));
            for (line, words) in bar.label.split('\n').enumerate() {
                root.draw(&Text::new(
                    words.to_owned(),
                    (x, y + 8 + 16 * line as i32),
                    below.clone(),
                ))
                .map_err(fault)?;
            }
        }
        let middle = ("sans-serif", TEXT)
            .into_font()
            .color(&BLACK)
            .pos(Pos::new(HPos::Center, VPos::Bottom));
        let below = ((SIZE.0 / 2) as i32 - 60, SIZE.1 as i32 - 6);
        root.draw(&Text::new(over.to_owned(), below, middle)).map_err(fault)?;
        let mut names = names.to_vec();
        if measured {
            names.push("measured: outline".to_owned());
        }
        legend(root, &names, &colours, true)
    })
}

/// A chart with two axes of numbers.
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Draws two axes with their names over an area.
fn axes<'a, 'b>(
    area: &'a DrawingArea<SVGBackend<'b>, Shift>,
    (x_name, y_name): (&str, &str),
    x: (f64, f64),
    y: (f64, f64),
) -> Result<Chart<'a, 'b>, PlotError> {
    let mut chart = ChartBuilder::on(area)
        .x_label_area_size(50)
        .y_label_area_size(70)
        .build_cartesian_2d(x.0..x.1, y.0..y.1)
        .map_err(fault)?;
    chart
        .configure_mesh()
        .x_desc(x_name)
        .y_desc(y_name)
        .light_line_style(TRANSPARENT)
        .label_style(("sans-serif", TEXT))
        .axis_desc_style(("sans-serif", TEXT))
        .draw()
        .map_err(fault)?;
    Ok(chart)
}

/// Stacked areas over one axis.
///
/// # Errors
/// If drawing fails.
pub(super) fn areas(
    title: &str,
    (x_name, y_name): (&str, &str),
    names: &[String],
    places: &[f64],
    stacks: &[Vec<f64>],
) -> Result<String, PlotError> {
    let colours = colours_of(names);
    drawn(title, |root| {
        let highest = stacks.iter().map(|s| s.iter().sum()).fold(0.0, f64::max);
        let (first, last) = range(places.iter().copied());
        let area = root.margin(40, 10, 10, 200);
        let heights = (0.0, (1.08 * highest).max(1e-9));
        let mut chart = axes(&area, (x_name, y_name), (first, last), heights)?;
        let below = |stack: &Vec<f64>, count: usize| stack.iter().take(count).sum::<f64>();
        for i in 0..names.len() {
            let along = |count: usize| places.iter().zip(stacks).map(move |(x, s)| (*x, below(s, count)));
            let mut edge: Vec<(f64, f64)> = along(i + 1).collect();
            let mut back: Vec<(f64, f64)> = along(i).collect();
            back.reverse();
            edge.extend(back);
            chart
                .draw_series([Polygon::new(edge, colours[i].filled())])
                .map_err(fault)?;
        }
        legend(root, names, &colours, true)
    })
}

/// Lines over one axis.
///
/// # Errors
/// If drawing fails.
pub(super) fn lines(title: &str, x_name: &str, y_name: &str, lines: &[Line]) -> Result<String, PlotError> {
    drawn(title, |root| {
        let points = || lines.iter().flat_map(|l| l.points.iter().flatten());
        let (x, y) = (range(points().map(|p| p.0)), range(points().map(|p| p.1)));
        let area = root.margin(40, 10, 10, 200);
        let mut chart = axes(&area, (x_name, y_name), x, y)?;
        for (i, line) in lines.iter().enumerate() {
            for stretch in line.points.split(Option::is_none) {
                let stretch: Vec<(f64, f64)> = stretch.iter().flatten().copied().collect();
                if line.stroke != Stroke::Dots {
                    chart
                        .draw_series(LineSeries::new(stretch.clone(), colour(i).stroke_width(2)))
                        .map_err(fault)?;
                }
                if line.stroke != Stroke::Line || stretch.len() == 1 {
                    let marks = stretch.iter().map(|p| Circle::new(*p, 3, colour(i).filled()));
                    chart.draw_series(marks).map_err(fault)?;
                }
            }
        }
        let names: Vec<String> = lines.iter().map(|l| l.name.clone()).collect();
        legend(root, &names, &[], false)
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::{Cloud, Map};
    use super::*;

    #[test]
    fn pictures_hold_their_words() {
        let bar = Bar {
            label: "1\nloaded".to_owned(),
            shares: vec![1.0, 2.0],
            above: "61 degC".to_owned(),
            measured: Some((3.1, 0.2)),
            above_measured: "60 degC".to_owned(),
        };
        let names = ["mesh".to_owned(), "seals".to_owned()];
        let svg = bars("Twelve tests", ("", "loss W"), &names, &[bar.clone(), bar]).unwrap();
        for word in [
            "Twelve tests",
            "loss W",
            "mesh",
            "seals",
            "61 °C",
            "60 °C",
            "loaded",
            "measured",
        ] {
            assert!(svg.contains(word), "{word}");
        }
        let line = Line {
            name: "limit".to_owned(),
            points: vec![Some((0.0, 1.0)), Some((1.0, 2.0)), None, Some((3.0, 1.0))],
            stroke: Stroke::Marked,
        };
        assert!(lines("Limit", "speed", "torque", &[line]).unwrap().contains("limit"));
    }

    #[test]
    fn mechanisms_have_the_colours_of_the_report() {
        let names = ["seal", "bearings.B1", "bearings.B2", "gear_mesh", "iron"].map(str::to_owned);
        let colours = colours_of(&names);
        assert_eq!(colours[0], RGBColor(0xb8, 0x32, 0x80));
        assert_eq!(colours[1], RGBColor(0xe6, 0x9f, 0x00));
        assert_ne!(colours[2], colours[1]);
        assert_eq!(colours[3], RGBColor(0x1f, 0x77, 0xb4));
        assert_eq!(colours[4], COLOURS[4]);
    }

    #[test]
    fn nothing_to_draw_is_no_fault() {
        assert!(bars("a", ("", "b"), &[], &[]).is_ok() && lines("a", "b", "c", &[]).is_ok());
        assert!(intervals("a", "b", &[0.0, 1.0], &[]).is_ok() && areas("a", ("b", "c"), &[], &[], &[]).is_ok());
        assert!(map(&Map::default()).is_ok() && cloud(&Cloud::default()).is_ok());
    }
}
