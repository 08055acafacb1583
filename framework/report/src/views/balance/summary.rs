//! The temperature at which losses and heat balance, in one sentence.

use gearloss_studies::analyses::balance::BalanceOutcome;

use crate::page::Page;
use crate::text::{capitalised, of_set, short};

pub fn add(outcome: &BalanceOutcome, page: &mut Page) {
    let mut words = Vec::new();
    for found in &outcome.balances {
        let balance = &found.balance;
        let set = &found.model_set;
        let loss = balance.history.iter().find(|step| {
            let oil = balance.oil_temperature_degc;
            oil.is_some_and(|oil| (step.oil_temperature_degc - oil).abs() < 1e-6)
        });
        if let Some(oil) = balance.oil_temperature_degc {
            if let Some(step) = loss {
                page.key_figure("loss", short(step.loss_w), "W", set);
            }
            let loss = loss.map_or_else(String::new, |step| format!(" with a loss of {} W", short(step.loss_w)));
            words.push(format!(
                "{}the oil settles at {} °C{loss}",
                of_set(set, outcome.balances.len()),
                short(oil)
            ));
            page.key_figure("oil temperature", short(oil), "°C", set);
            if let Some(unit) = &found.unit {
                page.key_figure("DC power", short(unit.dc_power_w), "W", set);
            }
        } else {
            let why = balance.outcome.name();
            words.push(format!("{}{why}", of_set(set, outcome.balances.len())));
            page.careful.push(format!("{set}: no heat balance was found: {why}"));
        }
        if balance.stable.len() > 1 {
            page.careful
                .push(format!("{set}: several temperatures are stable; the lowest is used"));
        }
    }
    page.headline = (!words.is_empty()).then(|| capitalised(&words.join("; ")));
}
