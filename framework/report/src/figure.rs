//! A figure as data: SVG for files, Plotly traces for an interactive report.

use serde_json::{Value, json};

use super::plot::{self, Bar, COLOURS, Interval, Line, PlotError, Stroke};

/// A figure as data.
#[derive(Debug, Clone, PartialEq)]
pub enum Figure {
    /// Stacked bars.
    Bars {
        /// Title.
        title: String,
        /// Name of the horizontal axis with its unit; empty if the labels of the bars contain it.
        over: String,
        /// Name of the vertical axis with its unit.
        height: String,
        /// Names of the shares.
        names: Vec<String>,
        /// The bars.
        bars: Vec<Bar>,
    },
    /// A value over two coordinates.
    Map(Map),
    /// Values at scattered points.
    Cloud(Cloud),
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
    /// Stacked areas over one coordinate.
    Areas {
        /// Title.
        title: String,
        /// Name of the coordinate.
        x: String,
        /// Name of the values.
        y: String,
        /// Names of the areas.
        names: Vec<String>,
        /// Values of the coordinate.
        places: Vec<f64>,
        /// Values of all areas at each coordinate value, from the bottom up.
        stacks: Vec<Vec<f64>>,
    },
    /// Intervals, one below the other.
    Intervals {
        /// Title.
        title: String,
        /// Name of the coordinate.
        x: String,
        /// Values at which lines are drawn, such as bounds.
        marks: Vec<f64>,
        /// The intervals.
        list: Vec<Interval>,
    },
}

/// A value over two coordinates, one cell for each pair.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Map {
    /// Title.
    pub title: String,
    /// Name of the first coordinate and its values.
    pub x: (String, Vec<String>),
    /// Name of the second coordinate and its values.
    pub y: (String, Vec<String>),
    /// Values; the first coordinate varies fastest.
    pub values: Vec<Option<f64>>,
    /// Differences: zero is the middle of the colour scale.
    pub diverging: bool,
    /// Ends of the colour scale if several maps share it; absent: minimum and maximum of the values.
    pub ends: Option<(f64, f64)>,
    /// Cells outside a model's validity range; empty: none.
    pub hatched: Vec<bool>,
    /// Points that are marked, in the coordinates.
    pub marks: Vec<(f64, f64)>,
    /// Legend text of the marks; empty: "measured".
    pub marked: String,
    /// A cell that is marked with a cross: its index and legend text.
    pub crossed: Option<(usize, String)>,
    /// Accuracy of an instrument: lines at plus and minus this value bound the differences that it cannot resolve.
    pub unseen: Option<f64>,
}

/// Values at scattered points.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cloud {
    /// Title.
    pub title: String,
    /// Names of the two coordinates.
    pub axes: (String, String),
    /// Coordinates and value of each point.
    pub points: Vec<(f64, f64, f64)>,
    /// Differences: zero is the middle of the colour scale.
    pub diverging: bool,
}

impl Map {
    /// True if every cell with a value is outside a validity range: then a text replaces the hatching.
    pub(super) fn is_hatched_all_over(&self) -> bool {
        let cells = || {
            self.values
                .iter()
                .zip(&self.hatched)
                .filter(|(value, _)| value.is_some())
        };
        cells().next().is_some() && cells().all(|(_, outside)| *outside)
    }

    /// Coordinates as numbers; absent if they are texts.
    pub(super) fn numbers(&self) -> Option<(Vec<f64>, Vec<f64>)> {
        let number = |label: &String| label.split(' ').next().and_then(|n| n.parse::<f64>().ok());
        let all = |labels: &[String]| labels.iter().map(number).collect::<Option<Vec<f64>>>();
        let (x, y) = (all(&self.x.1)?, all(&self.y.1)?);
        (x.len() > 1 && y.len() > 1).then_some((x, y))
    }
}

impl Figure {
    /// Title.
    pub fn title(&self) -> &str {
        match self {
            Self::Bars { title, .. }
            | Self::Lines { title, .. }
            | Self::Areas { title, .. }
            | Self::Intervals { title, .. } => title,
            Self::Map(map) => &map.title,
            Self::Cloud(cloud) => &cloud.title,
        }
    }

    /// As SVG.
    ///
    /// # Errors
    /// If drawing fails.
    pub fn svg(&self) -> Result<String, PlotError> {
        match self {
            Self::Bars {
                title,
                over,
                height,
                names,
                bars,
            } => plot::bars(title, (over, height), names, bars),
            Self::Map(map) => plot::map(map),
            Self::Cloud(cloud) => plot::cloud(cloud),
            Self::Lines { title, x, y, lines } => plot::lines(title, x, y, lines),
            Self::Areas {
                title,
                x,
                y,
                names,
                places,
                stacks,
            } => plot::areas(title, (x, y), names, places, stacks),
            Self::Intervals { title, x, marks, list } => plot::intervals(title, x, marks, list),
        }
    }

    /// As `data` and `layout` of Plotly.
    pub fn plotly(&self) -> Value {
        let (data, mut layout) = match self {
            Self::Bars {
                over,
                height,
                names,
                bars,
                ..
            } => stack((over, height), names, bars),
            Self::Map(map) => contours(map),
            Self::Cloud(cloud) => scattered(cloud),
            Self::Lines { x, y, lines, .. } => traces(x, y, lines),
            Self::Areas {
                x,
                y,
                names,
                places,
                stacks,
                ..
            } => areas((x, y), names, places, stacks),
            Self::Intervals { x, marks, list, .. } => beneath(x, marks, list),
        };
        layout["title"] =
            json!({ "text": self.title(), "x": 0, "xref": "paper", "xanchor": "left", "font": { "size": 15 } });
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

fn stack((over, height): (&str, &str), names: &[String], bars: &[Bar]) -> (Vec<Value>, Value) {
    let labels: Vec<String> = bars.iter().map(|b| b.label.replace('\n', "<br>")).collect();
    let mut data: Vec<Value> = names
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let share: Vec<Option<f64>> = bars.iter().map(|b| b.shares.get(i).copied()).collect();
            // Repeated colours get a pattern.
            let pattern = ["", "/", ".", "x"][(i / COLOURS.len()) % 4];
            json!({
                "type": "bar", "name": name, "x": labels, "y": share,
                "marker": { "color": css(i), "pattern": { "shape": pattern } },
            })
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
        json!({
            "barmode": "stack", "yaxis": axis(height),
            "xaxis": { "type": "category", "automargin": true, "title": { "text": over } },
        }),
    )
}

fn areas((x, y): (&str, &str), names: &[String], places: &[f64], stacks: &[Vec<f64>]) -> (Vec<Value>, Value) {
    let data = names
        .iter()
        .enumerate()
        .map(|(i, name)| {
            json!({
                "type": "scatter", "mode": "lines", "name": name, "x": places,
                "y": stacks.iter().map(|stack| stack.get(i)).collect::<Vec<_>>(),
                "stackgroup": "all", "line": { "width": 0.5, "color": css(i) }, "fillcolor": css(i),
            })
        })
        .collect();
    (
        data,
        json!({ "xaxis": axis(x), "yaxis": axis(y), "hovermode": "x unified" }),
    )
}

/// Maximum number of hatching marks of a figure.
const MOST_HATCHED: usize = 1600;

fn scale(diverging: bool) -> (&'static str, Value) {
    if diverging {
        ("RdBu", json!(0.0))
    } else {
        ("Viridis", Value::Null)
    }
}

/// Labelled contours if both coordinates are numbers, otherwise coloured cells.
fn contours(map: &Map) -> (Vec<Value>, Value) {
    let ((x_name, xs), (y_name, ys)) = (&map.x, &map.y);
    let rows: Vec<&[Option<f64>]> = map.values.chunks(xs.len().max(1)).collect();
    let numbers = map.numbers();
    let (x, y) = match &numbers {
        Some((x, y)) => (json!(x), json!(y)),
        None => (json!(xs), json!(ys)),
    };
    let (colours, middle) = scale(map.diverging);
    let mut trace = match numbers {
        Some(_) => json!({
            "type": "contour",
            "contours": { "coloring": "heatmap", "showlabels": true, "labelfont": { "size": 11 } },
        }),
        None => json!({ "type": "heatmap" }),
    };
    trace["x"] = x.clone();
    trace["y"] = y.clone();
    trace["z"] = json!(rows);
    trace["colorscale"] = json!(colours);
    trace["zmid"] = middle;
    if let Some((low, high)) = map.ends {
        trace["zmin"] = json!(low);
        trace["zmax"] = json!(high);
    }
    trace["name"] = json!("");
    let mut data = vec![trace];
    if let (Some(level), true) = (map.unseen.filter(|l| *l > 0.0), numbers.is_some()) {
        data.push(json!({
            "type": "contour", "x": x, "y": y, "z": rows, "showscale": false, "hoverinfo": "skip",
            "name": format!("accuracy of the instrument, {level:.3}"), "showlegend": true,
            "contours": { "coloring": "none", "start": -level, "end": level, "size": 2.0 * level },
            "line": { "color": "black", "width": 2, "dash": "dash" },
        }));
    }
    let hatched = map
        .hatched
        .iter()
        .enumerate()
        .filter(|(_, outside)| **outside)
        .map(|(i, _)| i);
    let places: Vec<usize> = hatched.collect();
    let all_over = map.is_hatched_all_over();
    if !places.is_empty() && !all_over {
        let every = places.len().div_ceil(MOST_HATCHED);
        let at = |axis: &Value, i: usize| axis[i].clone();
        let shown = || places.iter().step_by(every);
        data.push(json!({
            "type": "scatter", "mode": "markers", "name": "outside a validity range", "hoverinfo": "skip", "showlegend": true,
            "x": shown().map(|i| at(&x, i % xs.len())).collect::<Vec<_>>(),
            "y": shown().map(|i| at(&y, i / xs.len())).collect::<Vec<_>>(),
            "marker": { "symbol": "line-ne-open", "size": 9, "color": "rgba(0, 0, 0, 0.35)" },
        }));
    }
    if !map.marks.is_empty() {
        data.push(json!({
            "type": "scatter", "mode": "markers", "name": if map.marked.is_empty() { "measured" } else { &map.marked },
            "showlegend": true, "x": map.marks.iter().map(|m| m.0).collect::<Vec<_>>(), "y": map.marks.iter().map(|m| m.1).collect::<Vec<_>>(),
            "marker": { "symbol": "circle-open", "size": 7, "color": "black" },
        }));
    }
    if let Some((cell, what)) = map.crossed.as_ref().filter(|(cell, _)| *cell < map.values.len()) {
        data.push(json!({
            "type": "scatter", "mode": "markers", "name": what, "showlegend": true,
            "x": [x[cell % xs.len()]], "y": [y[cell / xs.len()]],
            "marker": { "symbol": "x", "size": 12, "color": "white", "line": { "width": 2, "color": "black" } },
        }));
    }
    // On an axis of numbers the unit moves from the values to the name of the axis.
    let named = |name: &str, labels: &[String]| match labels.first().and_then(|l| l.split_once(' ')) {
        Some((_, unit)) if numbers.is_some() => format!("{name} in {unit}"),
        _ => name.to_owned(),
    };
    let mut layout = json!({ "xaxis": axis(&named(x_name, xs)), "yaxis": axis(&named(y_name, ys)) });
    layout["legend"] = json!({ "orientation": "h", "y": -0.18 });
    if all_over {
        layout["annotations"] = json!([{
            "text": "all points outside a model's validity range", "xref": "paper", "yref": "paper", "x": 0, "y": 1.0,
            "xanchor": "left", "yanchor": "bottom", "showarrow": false, "font": { "size": 11, "color": "#666" },
        }]);
    }
    (data, layout)
}

fn scattered(cloud: &Cloud) -> (Vec<Value>, Value) {
    let (colours, middle) = scale(cloud.diverging);
    let of = |f: fn(&(f64, f64, f64)) -> f64| cloud.points.iter().map(f).collect::<Vec<_>>();
    let trace = json!({
        "type": "scatter", "mode": "markers", "x": of(|p| p.0), "y": of(|p| p.1), "text": of(|p| p.2), "name": "",
        "hovertemplate": "%{x}, %{y}: %{text:.4g}",
        "marker": {
            "size": 11, "color": of(|p| p.2), "colorscale": colours, "cmid": middle, "showscale": true,
            "line": { "width": 1, "color": "#444" },
        },
    });
    (
        vec![trace],
        json!({ "xaxis": axis(&cloud.axes.0), "yaxis": axis(&cloud.axes.1) }),
    )
}

fn beneath(x: &str, marks: &[f64], list: &[Interval]) -> (Vec<Value>, Value) {
    let names: Vec<&str> = list.iter().map(|i| i.name.as_str()).collect();
    let at: Vec<f64> = list.iter().map(|i| i.at).collect();
    let half = |k: usize| -> Vec<f64> {
        let of = |i: &Interval| i.ends.map_or(0.0, |ends| (ends[k] - i.at).abs());
        list.iter().map(of).collect()
    };
    let mut data = vec![json!({
        "type": "scatter", "mode": "markers", "name": "found, 95 %", "x": at, "y": names,
        "marker": { "size": 11, "color": css(0) },
        "error_x": { "type": "data", "symmetric": false, "array": half(1), "arrayminus": half(0), "thickness": 3, "color": css(0) },
    })];
    if list.iter().any(|i| i.before.is_some()) {
        data.push(json!({
            "type": "scatter", "mode": "markers", "name": "stated", "x": list.iter().map(|i| i.before).collect::<Vec<_>>(),
            "y": names, "marker": { "size": 11, "symbol": "circle-open", "color": css(5), "line": { "width": 2 } },
        }));
    }
    let line = |x: &f64| json!({ "type": "line", "x0": x, "x1": x, "y0": 0, "y1": 1, "yref": "paper", "line": { "width": 1, "color": "black" } });
    let layout = json!({
        "xaxis": axis(x), "yaxis": { "autorange": "reversed", "automargin": true, "type": "category" },
        "shapes": marks.iter().map(line).collect::<Vec<_>>(),
    });
    (data, layout)
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
            // Repeated colours are dashed.
            let dash = ["solid", "dash", "dot", "dashdot"][(i / COLOURS.len()) % 4];
            json!({
                "type": "scatter", "mode": mode, "name": line.name, "x": coordinate(|p| p.0), "y": coordinate(|p| p.1),
                "line": { "color": css(i), "dash": dash }, "marker": { "color": css(i) }, "connectgaps": false,
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
        let map = |ys: [&str; 2]| {
            Figure::Map(Map {
                title: "Loss".to_owned(),
                x: ("speed".to_owned(), vec!["1000".to_owned(), "2000".to_owned()]),
                y: ("volume".to_owned(), ys.map(str::to_owned).to_vec()),
                values: vec![Some(1.0), None, Some(3.0), Some(4.0)],
                hatched: vec![false, false, true, false],
                marks: vec![(1500.0, 70.0)],
                unseen: Some(0.5),
                crossed: Some((2, "least".to_owned())),
                ..Map::default()
            })
        };
        let plotly = map(["60 ml", "90 ml"]).plotly();
        assert_eq!(plotly["data"][0]["type"], "contour");
        assert_eq!(plotly["layout"]["yaxis"]["title"]["text"], "volume in ml");
        assert_eq!(plotly["data"][0]["z"], json!([[1.0, null], [3.0, 4.0]]));
        assert_eq!(map(["low", "high"]).plotly()["data"][0]["type"], "heatmap");
        assert_eq!(plotly["layout"]["title"]["text"], "Loss");
        assert_eq!(plotly["data"][1]["contours"]["end"], 0.5);
        assert_eq!(
            (&plotly["data"][2]["x"], &plotly["data"][2]["y"]),
            (&json!([1000.0]), &json!([90.0]))
        );
        assert_eq!(plotly["data"][3]["name"], "measured");
        let cross = &plotly["data"][4];
        assert_eq!(
            (&cross["name"], &cross["x"], &cross["y"]),
            (&json!("least"), &json!([1000.0]), &json!([90.0]))
        );
    }

    #[test]
    fn intervals_tell_their_ends_and_what_was_stated() {
        let interval = Interval {
            name: "viscosity".to_owned(),
            at: 0.4,
            ends: Some([0.3, 0.6]),
            before: Some(0.5),
        };
        let figure = Figure::Intervals {
            title: "Parameters".to_owned(),
            x: "place".to_owned(),
            marks: vec![0.0, 1.0],
            list: vec![interval],
        };
        let plotly = figure.plotly();
        let error = |key: &str| plotly["data"][0]["error_x"][key][0].as_f64().unwrap_or(f64::NAN);
        assert!((error("array") - 0.2).abs() < 1e-12 && (error("arrayminus") - 0.1).abs() < 1e-12);
        assert_eq!(plotly["data"][1]["x"], json!([0.5]));
        assert_eq!(plotly["layout"]["shapes"].as_array().map(Vec::len), Some(2));
        assert!(figure.svg().is_ok_and(|svg| svg.contains("viscosity")));
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
        let plotly = Figure::Bars {
            title: "Tests".to_owned(),
            over: String::new(),
            height: "loss".to_owned(),
            names: vec!["mesh".to_owned(), "seals".to_owned()],
            bars: vec![bar],
        }
        .plotly();
        assert_eq!(plotly["data"][1]["y"], json!([2.0]));
        assert_eq!(
            (&plotly["data"][2]["y"], &plotly["data"][3]["y"]),
            (&json!([3.0]), &json!([3.1]))
        );
    }
}
