//! One picture as data: drawn as SVG for files, told as traces for an interactive report.

use serde_json::{Value, json};

use super::plot::{self, Bar, COLOURS, Line, PlotFault, Stroke};

/// A picture as data.
#[derive(Debug, Clone, PartialEq)]
pub enum Figure {
    /// Stacked bars.
    Bars {
        /// Title.
        title: String,
        /// What the height is, with its unit.
        height: String,
        /// Names of the shares.
        names: Vec<String>,
        /// The bars.
        bars: Vec<Bar>,
    },
    /// A value over two coordinates.
    Map {
        /// Title.
        title: String,
        /// Name of the first coordinate and its values.
        x: (String, Vec<String>),
        /// Name of the second coordinate and its values.
        y: (String, Vec<String>),
        /// Values; the first coordinate runs first.
        values: Vec<Option<f64>>,
        /// Differences: zero in the middle of the colours.
        diverging: bool,
    },
    /// Lines over one coordinate.
    Lines {
        /// Title.
        title: String,
        /// Name of the coordinate.
        x: String,
        /// Name of the values.
        y: String,
        /// The lines.
        lines: Vec<Line>,
    },
}

impl Figure {
    /// Title.
    pub fn title(&self) -> &str {
        match self {
            Self::Bars { title, .. } | Self::Map { title, .. } | Self::Lines { title, .. } => title,
        }
    }

    /// As SVG.
    ///
    /// # Errors
    /// If drawing fails.
    pub fn svg(&self) -> Result<String, PlotFault> {
        match self {
            Self::Bars {
                title,
                height,
                names,
                bars,
            } => plot::bars(title, height, names, bars),
            Self::Map {
                title,
                x,
                y,
                values,
                diverging,
            } => plot::map(title, (&x.0, &x.1), (&y.0, &y.1), values, *diverging),
            Self::Lines { title, x, y, lines } => plot::lines(title, x, y, lines),
        }
    }

    /// As `data` and `layout` of Plotly.
    pub fn plotly(&self) -> Value {
        let (data, mut layout) = match self {
            Self::Bars {
                height, names, bars, ..
            } => stack(height, names, bars),
            Self::Map {
                x,
                y,
                values,
                diverging,
                ..
            } => contours(x, y, values, *diverging),
            Self::Lines { x, y, lines, .. } => traces(x, y, lines),
        };
        layout["title"] = json!({ "text": self.title() });
        json!({ "data": data, "layout": layout })
    }
}

fn css(i: usize) -> String {
    let c = COLOURS[i % COLOURS.len()];
    format!("rgb({}, {}, {})", c.0, c.1, c.2)
}

fn axis(name: &str) -> Value {
    json!({ "title": { "text": name }, "automargin": true })
}

fn stack(height: &str, names: &[String], bars: &[Bar]) -> (Vec<Value>, Value) {
    let labels: Vec<String> = bars.iter().map(|b| b.label.replace('\n', "<br>")).collect();
    let mut data: Vec<Value> = names
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let share: Vec<Option<f64>> = bars.iter().map(|b| b.shares.get(i).copied()).collect();
            json!({ "type": "bar", "name": name, "x": labels, "y": share, "marker": { "color": css(i) } })
        })
        .collect();
    let tops: Vec<f64> = bars.iter().map(|b| b.shares.iter().sum()).collect();
    let above: Vec<&str> = bars.iter().map(|b| b.above.as_str()).collect();
    if above.iter().any(|text| !text.is_empty()) {
        data.push(json!({
            "type": "scatter", "mode": "text", "x": labels, "y": tops, "text": above, "textposition": "top center",
            "showlegend": false, "hoverinfo": "skip",
        }));
    }
    if bars.iter().any(|b| b.measured.is_some()) {
        let value: Vec<Option<f64>> = bars.iter().map(|b| b.measured.map(|m| m.0)).collect();
        let error: Vec<f64> = bars.iter().map(|b| b.measured.map_or(0.0, |m| m.1)).collect();
        data.push(json!({
            "type": "scatter", "mode": "markers", "name": "measured", "x": labels, "y": value,
            "marker": { "color": "black", "symbol": "diamond", "size": 9 },
            "error_y": { "type": "data", "array": error, "visible": true },
        }));
    }
    (
        data,
        json!({ "barmode": "stack", "xaxis": { "type": "category", "automargin": true }, "yaxis": axis(height) }),
    )
}

/// Contours with their values where both coordinates are numbers, else coloured cells.
fn contours(
    (x_name, xs): &(String, Vec<String>),
    (y_name, ys): &(String, Vec<String>),
    values: &[Option<f64>],
    diverging: bool,
) -> (Vec<Value>, Value) {
    let number = |label: &String| label.split(' ').next().and_then(|n| n.parse::<f64>().ok());
    let numbers = |labels: &[String]| labels.iter().map(number).collect::<Option<Vec<f64>>>();
    let rows: Vec<&[Option<f64>]> = values.chunks(xs.len().max(1)).collect();
    let (scale, middle) = if diverging {
        ("RdBu", json!(0.0))
    } else {
        ("Viridis", Value::Null)
    };
    let mut trace = match (numbers(xs), numbers(ys)) {
        (Some(x), Some(y)) if x.len() > 1 && y.len() > 1 => json!({
            "type": "contour", "x": x, "y": y,
            "contours": { "coloring": "heatmap", "showlabels": true, "labelfont": { "size": 11 } },
        }),
        _ => json!({ "type": "heatmap", "x": xs, "y": ys }),
    };
    // Values with a unit lose it on an axis of numbers; there its name takes it.
    let named = |name: &str, labels: &[String]| match labels.first().and_then(|l| l.split_once(' ')) {
        Some((_, unit)) if trace["type"] == "contour" => format!("{name} in {unit}"),
        _ => name.to_owned(),
    };
    let (x_name, y_name) = (named(x_name, xs), named(y_name, ys));
    trace["z"] = json!(rows);
    trace["colorscale"] = json!(scale);
    trace["zmid"] = middle;
    (vec![trace], json!({ "xaxis": axis(&x_name), "yaxis": axis(&y_name) }))
}

fn traces(x: &str, y: &str, lines: &[Line]) -> (Vec<Value>, Value) {
    let data = lines
        .iter()
        .enumerate()
        .map(|(i, line)| {
            let coordinate =
                |f: fn(&(f64, f64)) -> f64| line.points.iter().map(|p| p.as_ref().map(f)).collect::<Vec<_>>();
            let mode = match line.stroke {
                Stroke::Line => "lines",
                Stroke::Marked => "lines+markers",
                Stroke::Dots => "markers",
            };
            json!({
                "type": "scatter", "mode": mode, "name": line.name, "x": coordinate(|p| p.0), "y": coordinate(|p| p.1),
                "line": { "color": css(i) }, "marker": { "color": css(i) }, "connectgaps": false,
            })
        })
        .collect();
    (data, json!({ "xaxis": axis(x), "yaxis": axis(y) }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_of_numbers_has_contours_and_one_of_words_has_cells() {
        let map = |ys: [&str; 2]| Figure::Map {
            title: "Loss".to_owned(),
            x: ("speed".to_owned(), vec!["1000".to_owned(), "2000".to_owned()]),
            y: ("volume".to_owned(), ys.map(str::to_owned).to_vec()),
            values: vec![Some(1.0), None, Some(3.0), Some(4.0)],
            diverging: false,
        };
        let told = map(["60 ml", "90 ml"]).plotly();
        assert_eq!(told["data"][0]["type"], "contour");
        assert_eq!(told["layout"]["yaxis"]["title"]["text"], "volume in ml");
        assert_eq!(told["data"][0]["z"], json!([[1.0, null], [3.0, 4.0]]));
        assert_eq!(map(["low", "high"]).plotly()["data"][0]["type"], "heatmap");
        assert_eq!(told["layout"]["title"]["text"], "Loss");
    }

    #[test]
    fn bars_tell_shares_words_and_measurements() {
        let bar = Bar {
            label: "1\nloaded".to_owned(),
            shares: vec![1.0, 2.0],
            above: "61 °C".to_owned(),
            measured: Some((3.1, 0.2)),
            above_measured: String::new(),
        };
        let told = Figure::Bars {
            title: "Tests".to_owned(),
            height: "loss".to_owned(),
            names: vec!["mesh".to_owned(), "seals".to_owned()],
            bars: vec![bar],
        }
        .plotly();
        assert_eq!(told["data"][1]["y"], json!([2.0]));
        assert_eq!(
            (&told["data"][2]["y"], &told["data"][3]["y"]),
            (&json!([3.0]), &json!([3.1]))
        );
    }
}
