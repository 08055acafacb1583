//! The steady state of a thermal network as text and as JSON.

use gearloss_framework::thermal::Outcome;
use gearloss_framework::thermal::network::Steady;
use gearloss_framework::transmission::Transmission;
use gearloss_studies::analyses::balance::reason;
use serde_json::{Value, json};

use crate::text::{TextTable, significant};

/// The temperatures of the nodes as text.
pub(super) fn network_text(transmission: &Transmission, steady: &Steady) -> String {
    let Some(network) = transmission.network() else {
        return String::new();
    };
    let mut text = format!(
        "network: {} after {} evaluations\n",
        steady.outcome.name(),
        steady.evaluations
    );
    if steady.outcome != Outcome::Converged {
        if let Some(why) = &steady.undefined {
            text.push_str(&format!("  {}\n", reason(transmission, why)));
        }
        return text;
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
    text.push_str(&table.render());
    for (path, heat) in network.exchangers().zip(&steady.leaving.exchangers) {
        text.push_str(&format!("{path} transfers {heat:.2} W\n"));
    }
    if steady.leaving.flows.abs() > 1e-6 * steady.heat.iter().sum::<f64>().abs() {
        text.push_str(&format!("flows transfer {:.2} W\n", steady.leaving.flows));
    }
    text.push_str(&format!("residual {} W\n", significant(steady.residual)));
    text
}

/// The nodes and the heat paths.
pub(super) fn network_json(transmission: &Transmission, steady: &Steady) -> Value {
    let Some(network) = transmission.network() else {
        return Value::Null;
    };
    let found = steady.outcome == Outcome::Converged;
    let nodes: Vec<Value> = network
        .names()
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let held = network.is_held(i);
            json!({
                "node": name,
                "temperature_degc": found.then_some(steady.temperatures[i]),
                "heat_in_w": steady.heat.get(i),
                "heat_out_w": steady.leaving.held.get(i).filter(|_| held),
            })
        })
        .collect();
    let exchangers: Vec<Value> = network
        .exchangers()
        .zip(&steady.leaving.exchangers)
        .map(|(path, watts)| json!({ "exchanger": path, "heat_w": watts }))
        .collect();
    json!({
        "outcome": steady.outcome,
        "evaluations": steady.evaluations,
        "nodes": nodes,
        "exchangers": exchangers,
        "carried_away_w": steady.leaving.flows,
        "residual_w": steady.residual,
        "undefined": steady.undefined.as_ref().map(|why| reason(transmission, why)),
    })
}
