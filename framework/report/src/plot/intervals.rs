//! Intervals over one coordinate, one below the other.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{PlotError, SIZE, TEXT, colour, drawn, fault, range};

/// One interval with its value.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize)]
pub struct Interval {
    /// Label.
    pub name: String,
    /// The value.
    pub at: f64,
    /// Lower and upper end; absent if unknown.
    pub ends: Option<[f64; 2]>,
    /// A reference value.
    pub before: Option<f64>,
}

/// Intervals, one below the other, with lines at the given values.
///
/// # Errors
/// If drawing fails.
pub fn intervals(title: &str, x_name: &str, marks: &[f64], list: &[Interval]) -> Result<String, PlotError> {
    drawn(title, |root| {
        let places = list.iter().flat_map(|i| {
            [Some(i.at), i.before]
                .into_iter()
                .flatten()
                .chain(i.ends.into_iter().flatten())
        });
        let x = range(places.chain(marks.iter().copied()));
        let count = list.len().max(1) as f64;
        let area = root.margin(40, 10, 10, 40);
        let mut chart = ChartBuilder::on(&area)
            .x_label_area_size(50)
            .y_label_area_size(200)
            .build_cartesian_2d(x.0..x.1, 0.0..count)
            .map_err(fault)?;
        chart
            .configure_mesh()
            .disable_y_mesh()
            .disable_y_axis()
            .x_desc(x_name)
            .light_line_style(TRANSPARENT)
            .label_style(("sans-serif", TEXT))
            .axis_desc_style(("sans-serif", TEXT))
            .draw()
            .map_err(fault)?;
        for mark in marks {
            let line = vec![(*mark, 0.0), (*mark, count)];
            chart
                .draw_series([PathElement::new(line, BLACK.stroke_width(1))])
                .map_err(fault)?;
        }
        let beside = ("sans-serif", TEXT)
            .into_font()
            .color(&BLACK)
            .pos(Pos::new(HPos::Right, VPos::Center));
        for (k, interval) in list.iter().enumerate() {
            let y = count - k as f64 - 0.5;
            if let Some([low, high]) = interval.ends {
                let line = vec![(low, y), (high, y)];
                chart
                    .draw_series([PathElement::new(line, colour(0).stroke_width(4))])
                    .map_err(fault)?;
            }
            chart
                .draw_series([Circle::new((interval.at, y), 6, colour(0).filled())])
                .map_err(fault)?;
            if let Some(before) = interval.before {
                chart
                    .draw_series([Circle::new((before, y), 5, colour(5).stroke_width(2))])
                    .map_err(fault)?;
            }
            let (_, below) = chart.backend_coord(&(x.0, y));
            root.draw(&Text::new(interval.name.clone(), (195, below), beside.clone()))
                .map_err(fault)?;
        }
        let corner = ("sans-serif", TEXT - 2)
            .into_font()
            .color(&BLACK)
            .pos(Pos::new(HPos::Right, VPos::Top));
        let words = "dot and bar: estimate, 95 %; circle: stated value".to_owned();
        root.draw(&Text::new(words, (SIZE.0 as i32 - 20, 20), corner))
            .map_err(fault)
    })
}
