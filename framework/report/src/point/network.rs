//! The steady state of a thermal network as text and as a record.

use gearloss_framework::thermal::Outcome;
use gearloss_framework::thermal::network::Steady;
use gearloss_framework::transmission::{BearingPair, BodyTemperature, Transmission};
use gearloss_studies::analyses::balance::reason;
use schemars::JsonSchema;
use serde::Serialize;

use crate::page::Blocks;
use crate::text::{TextTable, significant};

/// The temperatures of the nodes.
pub(super) fn network_blocks(transmission: &Transmission, steady: &Steady) -> Blocks {
    let Some(network) = transmission.network() else {
        return Blocks::default();
    };
    let mut blocks = Blocks::default();
    blocks.text(&format!(
        "network: {} after {} evaluations\n",
        steady.outcome.name(),
        steady.evaluations
    ));
    if steady.outcome != Outcome::Converged {
        if let Some(why) = &steady.undefined {
            blocks.text(&format!("  {}\n", reason(transmission, why)));
        }
        if steady.outcome == Outcome::NoneBelowMaximum {
            let maximum = significant(transmission.housing().maximum);
            blocks.text(&format!(
                "  as it warms up, more heat enters the network than leaves it, up to {maximum} degC of the oil\n"
            ));
        }
        for line in tightening(transmission, steady) {
            blocks.text(&line);
        }
        return blocks;
    }
    let mut table = TextTable::new(&["node", "degC", "heat in W", "heat out W"]);
    for (node, name) in network.names().iter().enumerate() {
        table.row(vec![
            name.clone(),
            format!("{:.2}", steady.temperatures[node]),
            format!("{:.2}", steady.heat[node]),
            if network.is_held(node) {
                format!("{:.2}", steady.leaving.held[node])
            } else {
                String::new()
            },
        ]);
    }
    blocks.table(table);
    for (path, heat) in network.exchangers().zip(&steady.leaving.exchangers) {
        blocks.text(&format!("{path} transfers {heat:.2} W\n"));
    }
    if steady.leaving.flows.abs() > 1e-6 * steady.heat.iter().sum::<f64>().abs() {
        blocks.text(&format!("flows transfer {:.2} W\n", steady.leaving.flows));
    }
    blocks.text(&format!("residual {} W\n", significant(steady.residual)));
    blocks
}

/// Lines about pairs of bearings whose preload grows as they warm their shaft, which may be why there is no steady state.
fn tightening(transmission: &Transmission, steady: &Steady) -> Vec<String> {
    if steady.undefined.is_some() {
        return Vec::new();
    }
    let tightens = |pair: &&BearingPair| {
        pair.preload.is_some_and(|preload| {
            matches!(preload.temperatures[0], BodyTemperature::Node(_)) && preload.per_kelvin[0] > 0.0
        })
    };
    let line = |pair: &BearingPair| {
        let id = |support: usize| transmission.supports()[support].trim_start_matches("bearings.");
        let bearings: Vec<&str> = pair.supports().map(id).collect();
        format!(
            "  the preload of {} of {} grows as the shaft warms, and with it the heat: mount them with less preload or more end play, or back to back\n",
            bearings.join("/"),
            transmission.members()[pair.member]
        )
    };
    transmission.pairs().iter().filter(tightens).map(line).collect()
}

/// Steady state of a thermal network.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Network")]
pub struct NetworkRecord {
    /// Status of the search for its temperatures.
    #[schemars(extend("enum" = ["converged", "none_below_maximum", "undefined", "no_convergence"]))]
    outcome: Outcome,
    /// Evaluations of the losses.
    evaluations: usize,
    /// Nodes, the surroundings first.
    nodes: Vec<NodeRecord>,
    /// Heat exchangers.
    exchangers: Vec<ExchangerRecord>,
    /// Heat removed by oil flows. [W]
    carried_away_w: f64,
    /// Heat flow in minus heat flow out. [W]
    residual_w: f64,
    /// Why there are no temperatures; null if there are.
    undefined: Option<String>,
}

/// One node.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Node")]
struct NodeRecord {
    /// Name.
    node: String,
    /// Temperature; null if none was found. [degC]
    temperature_degc: Option<f64>,
    /// Heat of losses, motors and sources into the node; null if there is no balance. [W]
    heat_in_w: Option<f64>,
    /// Heat flow of the links into a node of prescribed temperature; null for other nodes. [W]
    heat_out_w: Option<f64>,
}

/// One heat exchanger.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Exchanger")]
struct ExchangerRecord {
    /// Path.
    exchanger: String,
    /// Heat through it. [W]
    heat_w: f64,
}

impl NetworkRecord {
    /// The nodes and the heat paths; nothing without a network.
    pub(super) fn new(transmission: &Transmission, steady: &Steady) -> Option<Self> {
        let network = transmission.network()?;
        let found = steady.outcome == Outcome::Converged;
        let node = |(i, name): (usize, &String)| NodeRecord {
            node: name.clone(),
            temperature_degc: found.then(|| steady.temperatures[i]),
            heat_in_w: steady.heat.get(i).copied(),
            heat_out_w: steady.leaving.held.get(i).copied().filter(|_| network.is_held(i)),
        };
        let exchanger = |(path, heat): (&str, &f64)| ExchangerRecord {
            exchanger: path.to_owned(),
            heat_w: *heat,
        };
        let exchangers = network.exchangers().zip(&steady.leaving.exchangers);
        Some(Self {
            outcome: steady.outcome,
            evaluations: steady.evaluations,
            nodes: network.names().iter().enumerate().map(node).collect(),
            exchangers: exchangers.map(exchanger).collect(),
            carried_away_w: steady.leaving.flows,
            residual_w: steady.residual,
            undefined: steady.undefined.as_ref().map(|why| reason(transmission, why)),
        })
    }
}
