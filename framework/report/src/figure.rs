//! A figure as data: drawn as SVG for files, and in the browser by the page of the report.

use serde::Serialize;

use super::plot::{self, Bar, Interval, Line, PlotError};

/// A figure as data.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
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
        /// What the values, the references and the lines are, in the legend.
        key: [String; 3],
        /// The intervals.
        list: Vec<Interval>,
    },
}

/// Which end of a quantity is good.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Best {
    /// As an efficiency.
    Highest,
    /// As a loss.
    Lowest,
}

/// True for a quantity that jumps where the torque or the speed changes its sign: its maps have no contours between drive and coast.
pub fn jumps(quantity: &str) -> bool {
    quantity == "efficiency"
}

/// A value over two coordinates, one cell for each pair.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Map {
    /// Title.
    pub title: String,
    /// Name of the first coordinate and its values.
    pub x: (String, Vec<String>),
    /// Name of the second coordinate and its values.
    pub y: (String, Vec<String>),
    /// Values; the first coordinate varies fastest.
    pub values: Vec<Option<f64>>,
    /// Unit of the values; may be empty.
    pub unit: String,
    /// Which end is good, for the best point and for closer levels towards it.
    pub best: Option<Best>,
    /// True if the value [jumps] where a coordinate changes its sign.
    pub jumps: bool,
    /// Differences: zero is the middle of the colour scale.
    pub diverging: bool,
    /// Ends of the colour scale if several maps share it; absent: minimum and maximum of the values.
    pub ends: Option<(f64, f64)>,
    /// Cells outside a model's validity range; empty: none.
    pub hatched: Vec<bool>,
    /// What the hatching means.
    pub hatching: Hatching,
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
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Cloud {
    /// Title.
    pub title: String,
    /// Names of the two coordinates.
    pub axes: (String, String),
    /// Coordinates and value of each point.
    pub points: Vec<(f64, f64, f64)>,
    /// Area of each point as a share of the largest; empty: all are equal.
    pub sizes: Vec<f64>,
    /// Name of what the areas show, and the value of the largest.
    pub sized: String,
    /// Unit of the values; may be empty.
    pub unit: String,
    /// Differences: zero is the middle of the colour scale.
    pub diverging: bool,
}

/// What the hatched cells of a map are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Hatching {
    /// Outside the validity range of a model.
    #[default]
    Validity,
    /// Beyond a limit of the study.
    Limit,
}

impl Map {
    /// The hatching in words; empty without hatched cells.
    pub(super) fn words_of_hatching(&self) -> &'static str {
        let all_over = self.is_hatched_all_over();
        match self.hatching {
            _ if !self.hatched.contains(&true) => "",
            Hatching::Validity if all_over => "; all points outside a model's validity range",
            Hatching::Validity => "; hatched: outside a validity range",
            Hatching::Limit if all_over => "; all points beyond the limit",
            Hatching::Limit => "; hatched: beyond the limit",
        }
    }

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

    /// Title, to be changed.
    pub fn title_mut(&mut self) -> &mut String {
        match self {
            Self::Bars { title, .. }
            | Self::Lines { title, .. }
            | Self::Areas { title, .. }
            | Self::Intervals { title, .. } => title,
            Self::Map(map) => &mut map.title,
            Self::Cloud(cloud) => &mut cloud.title,
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
            Self::Intervals {
                title, x, marks, list, ..
            } => plot::intervals(title, x, marks, list),
        }
    }
}
