//! The oil network at a point as text and as a record.

use gearloss_framework::evaluate::{OilSupply, Solution, WindowFlow};
use gearloss_studies::numbers::tidy;
use schemars::JsonSchema;
use serde::Serialize;

use crate::page::Blocks;
use crate::text::{TextTable, figures, fixed};

const L_MIN: f64 = 6e4;
const BAR: f64 = 1e-5;

/// Head and rows of the flows.
pub fn flow_rows(supply: &OilSupply) -> (Vec<&'static str>, Vec<Vec<String>>) {
    let head = vec![
        "oil network",
        "from",
        "to",
        "l/min",
        "rise bar",
        "relief l/min",
        "power W",
        "feeds",
    ];
    let rows = supply.elements.iter().map(|element| {
        vec![
            element.path.trim_start_matches("oil_network.").to_owned(),
            element.ends[0].clone(),
            element.ends[1].clone(),
            figures(element.flow * L_MIN, 4),
            fixed(element.rise * BAR, 4),
            element
                .relieved
                .map_or_else(String::new, |flow| figures(flow * L_MIN, 4)),
            element.power.map_or_else(String::new, |power| fixed(power, 2)),
            element.feeds.join(", "),
        ]
    });
    (head, rows.collect())
}

/// Flows, pressures, chambers and pockets; nothing without them.
pub(super) fn oil_blocks(solution: &Solution<'_>) -> Blocks {
    let mut blocks = Blocks::default();
    if let Some(supply) = solution.oil_supply() {
        blocks.text("\n");
        let (head, rows) = flow_rows(&supply);
        blocks.table(TextTable::filled(&head, rows));
        let pressures: Vec<String> = supply
            .junctions
            .iter()
            .map(|(name, pressure)| format!("{name} {}", fixed(pressure * BAR, 4)))
            .collect();
        if !pressures.is_empty() {
            blocks.text(&format!(
                "pressures over the housing in bar: {}\n",
                pressures.join(", ")
            ));
        }
        for chamber in &supply.chambers {
            blocks.text(&format!(
                "chamber {}: {} l/min, oil height {} mm, {} l\n",
                chamber.name,
                figures(chamber.flow * L_MIN, 4),
                fixed(chamber.height * 1e3, 1),
                fixed(chamber.volume * 1e3, 3)
            ));
        }
        for finding in &supply.findings {
            blocks.text(&format!("{}: {}\n", finding.path, finding.message));
        }
    }
    for pocket in solution.pockets() {
        let reason = match (pocket.inflow > 0.0, pocket.overflows) {
            (false, _) => "dry: nothing flows into it",
            (true, false) => "below its edge",
            (true, true) => "over its edge",
        };
        blocks.text(&format!(
            "pocket of {}: {} l/min, oil height {} mm, {reason}\n",
            pocket.bearing,
            figures(pocket.inflow * L_MIN, 4),
            fixed(pocket.height * 1e3, 2)
        ));
        if let Some(window) = pocket.window {
            blocks.text(&format!("  its window: {}\n", window_words(&window)));
        }
    }
    blocks
}

/// What a window takes, and where the oil meets its wall.
fn window_words(window: &WindowFlow) -> String {
    let mm = |x: f64| fixed(x * 1e3, 1);
    let [low, high] = window.meets;
    if low == 0.0 && high == 0.0 {
        return "no oil of its gear meets the wall".to_owned();
    }
    format!(
        "{} l/min, {} % of what its gear throws, which meets the wall {} to {} mm above the axis",
        figures(window.flow * L_MIN, 4),
        fixed(100.0 * window.share, 1),
        mm(low),
        mm(high)
    )
}

/// The oil network at a point.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "OilNetwork")]
pub struct OilRecord {
    /// Junctions.
    junctions: Vec<JunctionRecord>,
    /// Pumps, pipes, nozzles and rotating channels.
    elements: Vec<ElementRecord>,
    /// Chambers.
    chambers: Vec<ChamberRecord>,
    /// Pockets of bearings.
    pockets: Vec<PocketRecord>,
    /// What is too little or too much.
    findings: Vec<FindingRecord>,
}

/// A junction.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Junction")]
struct JunctionRecord {
    /// Name.
    junction: String,
    /// Pressure over the air of the housing; null if none was found. [bar]
    pressure_bar: Option<f64>,
}

/// An element.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "OilElement")]
struct ElementRecord {
    /// Path.
    element: String,
    /// Where it begins.
    from: String,
    /// Where it ends.
    to: String,
    /// Flow of oil without its free air; null if none was found. [l/min]
    flow_l_min: Option<f64>,
    /// Pressure at its end minus that at its beginning; null if none was found. [bar]
    rise_bar: Option<f64>,
    /// Flow through the relief valve of a pump; null without one. [l/min]
    relieved_l_min: Option<f64>,
    /// Power that the oil takes from its shaft or motor, without friction; null for elements that do not rotate. [W]
    power_w: Option<f64>,
    /// Components that it supplies.
    feeds: Vec<String>,
}

/// A chamber.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Chamber")]
struct ChamberRecord {
    /// Name.
    chamber: String,
    /// Flow through it; null if none was found. [l/min]
    flow_l_min: Option<f64>,
    /// Height of the oil over its holes; null if none was found. [mm]
    height_mm: Option<f64>,
    /// Oil that it holds; null if none was found. [l]
    volume_l: Option<f64>,
}

/// The pocket of a bearing.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Pocket")]
struct PocketRecord {
    /// Path of the bearing.
    bearing: String,
    /// Flow into it; null if none was found. [l/min]
    inflow_l_min: Option<f64>,
    /// Height of the oil above the lowest point of the raceway; null if none was found. [mm]
    height_mm: Option<f64>,
    /// True if oil flows over its edge.
    overflows: bool,
    /// What its window takes of the oil that a gear throws; absent without a window.
    #[serde(skip_serializing_if = "Option::is_none")]
    window: Option<WindowRecord>,
}

/// A window of a pocket.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Window")]
struct WindowRecord {
    /// Flow through it. [l/min]
    flow_l_min: f64,
    /// Share of the oil that its gear throws. [-]
    share: f64,
    /// Heights above the axis of its gear at which the first and the last oil meet the wall; zeros if none does. [mm]
    meets_mm: [f64; 2],
}

/// What is too little or too much.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "OilFinding")]
struct FindingRecord {
    /// Path.
    path: String,
    /// With its numbers.
    message: String,
}

impl OilRecord {
    /// The network and the pockets; nothing without them.
    pub(super) fn new(solution: &Solution<'_>) -> Option<Self> {
        let supply = solution.oil_supply();
        let known = |x: f64| x.is_finite().then(|| tidy(x));
        let pockets: Vec<PocketRecord> = solution
            .pockets()
            .map(|pocket| PocketRecord {
                bearing: pocket.bearing.to_owned(),
                inflow_l_min: known(pocket.inflow * L_MIN),
                height_mm: known(pocket.height * 1e3),
                overflows: pocket.overflows,
                window: pocket.window.map(|window| WindowRecord {
                    flow_l_min: tidy(window.flow * L_MIN),
                    share: tidy(window.share),
                    meets_mm: window.meets.map(|height| tidy(height * 1e3)),
                }),
            })
            .collect();
        if supply.is_none() && pockets.is_empty() {
            return None;
        }
        let supply = supply.unwrap_or_else(|| OilSupply {
            is_solved: true,
            junctions: Vec::new(),
            elements: Vec::new(),
            chambers: Vec::new(),
            findings: Vec::new(),
        });
        Some(Self {
            junctions: supply
                .junctions
                .into_iter()
                .map(|(junction, pressure)| JunctionRecord {
                    junction,
                    pressure_bar: known(pressure * BAR),
                })
                .collect(),
            elements: supply
                .elements
                .into_iter()
                .map(|element| {
                    let [from, to] = element.ends;
                    ElementRecord {
                        element: element.path,
                        from,
                        to,
                        flow_l_min: known(element.flow * L_MIN),
                        rise_bar: known(element.rise * BAR),
                        relieved_l_min: element.relieved.and_then(|flow| known(flow * L_MIN)),
                        power_w: element.power.and_then(known),
                        feeds: element.feeds,
                    }
                })
                .collect(),
            chambers: supply
                .chambers
                .into_iter()
                .map(|chamber| ChamberRecord {
                    chamber: chamber.name,
                    flow_l_min: known(chamber.flow * L_MIN),
                    height_mm: known(chamber.height * 1e3),
                    volume_l: known(chamber.volume * 1e3),
                })
                .collect(),
            pockets,
            findings: supply
                .findings
                .into_iter()
                .map(|finding| FindingRecord {
                    path: finding.path,
                    message: finding.message,
                })
                .collect(),
        })
    }
}
