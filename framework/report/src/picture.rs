//! Pictures of the report: figures, and those that need a screen.

use serde::Serialize;

use crate::Figure;
use crate::figure::Best;

/// A picture of the report, drawn in the browser.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Picture {
    /// A figure, which exists as an SVG file, too.
    Figure(Figure),
    /// A picture for the screen alone.
    Screen(Screen),
}

impl Picture {
    /// Title.
    pub fn title(&self) -> &str {
        match self {
            Self::Figure(figure) => figure.title(),
            Self::Screen(Screen::Panels(panels)) => &panels.title,
            Self::Screen(Screen::Panes(panes)) => &panes.title,
            Self::Screen(Screen::Waterfall(waterfall)) => &waterfall.title,
            Self::Screen(Screen::Tornado(tornado)) => &tornado.title,
        }
    }

    /// Title, to be changed.
    pub fn title_mut(&mut self) -> &mut String {
        match self {
            Self::Figure(figure) => figure.title_mut(),
            Self::Screen(Screen::Panels(panels)) => &mut panels.title,
            Self::Screen(Screen::Panes(panes)) => &mut panes.title,
            Self::Screen(Screen::Waterfall(waterfall)) => &mut waterfall.title,
            Self::Screen(Screen::Tornado(tornado)) => &mut tornado.title,
        }
    }
}

/// A picture for the screen.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Screen {
    /// Maps side by side with one colour scale.
    Panels(Box<Panels>),
    /// Lines one below the other over a common coordinate.
    Panes(Panes),
    /// Losses from the input power to the output power.
    Waterfall(Waterfall),
    /// What the change of each quantity does to a result, the largest effect first.
    Tornado(Tornado),
}

/// Maps side by side: a row for each model set or product, a column for each gear, temperature or bound value.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Panels {
    /// Title.
    pub title: String,
    /// Names of the rows.
    pub rows: Vec<String>,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Name and values of the horizontal coordinate of all panels.
    pub x: (String, Vec<f64>),
    /// Name and values of the vertical coordinate.
    pub y: (String, Vec<f64>),
    /// A further coordinate with its values as text; absent if there is none.
    pub slider: Option<(String, Vec<String>)>,
    /// The quantities, one tab each.
    pub quantities: Vec<PanelQuantity>,
    /// Cells outside a model's stated range, by panel in the order of [`PanelQuantity::panels`]; an empty list: none.
    pub outside: Vec<Vec<bool>>,
    /// Points that are marked.
    pub marks: Vec<(f64, f64)>,
    /// Legend of the marks.
    pub marked: String,
    /// Powers for which lines are drawn. \[W\]
    pub powers: Vec<f64>,
    /// Maximum of the vertical over the horizontal coordinate, drawn as a line, also for their negatives; an empty list: none.
    pub envelope: Vec<(f64, f64)>,
    /// Losses of each cell by share, shown after a click; absent if unknown.
    pub breakdown: Option<Breakdown>,
}

/// A quantity of panels.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct PanelQuantity {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Differences: zero is the middle of the colour scale.
    pub diverging: bool,
    /// Which end is good, for the best point and for closer levels towards it.
    pub best: Option<Best>,
    /// True if the value [jumps](crate::figure::jumps) where a coordinate changes its sign.
    pub jumps: bool,
    /// Values of each panel, absent where there is no map: for each value of the slider row by row of panels, within a panel the horizontal
    /// coordinate varies fastest.
    pub panels: Vec<Option<Vec<Option<f64>>>>,
}

/// Losses by share in all cells.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Breakdown {
    /// Names of the shares.
    pub names: Vec<String>,
    /// Loss of each share in each cell of each panel, the share varies fastest. \[W\]
    pub panels: Vec<Option<Vec<f32>>>,
}

/// Lines one below the other.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Panes {
    /// Title.
    pub title: String,
    /// Name of the common coordinate with its unit.
    pub x: String,
    /// The panes from the top down.
    pub panes: Vec<Pane>,
}

/// One of several panes.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Pane {
    /// Name of the values with their unit.
    pub y: String,
    /// The lines.
    pub lines: Vec<crate::plot::Line>,
}

/// Losses between the input and the output.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Waterfall {
    /// Title.
    pub title: String,
    /// Unit of all values.
    pub unit: String,
    /// Input and output with their names.
    pub ends: [(String, f64); 2],
    /// Name, group and value of each loss, in the order of the components.
    pub losses: Vec<(String, String, f64)>,
}

/// Effects of the change of quantities.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Tornado {
    /// Title.
    pub title: String,
    /// Name of the result with its unit.
    pub x: String,
    /// The result without a change.
    pub base: f64,
    /// The quantities, the largest effect first.
    pub bars: Vec<TornadoBar>,
}

/// The effect of one quantity.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct TornadoBar {
    /// The quantity.
    pub name: String,
    /// The result at the lower and at the upper end of the quantity.
    pub results: [f64; 2],
    /// Both ends of the quantity as text.
    pub ends: [String; 2],
}
