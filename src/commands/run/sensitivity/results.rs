//! Rows and JSON of what was found.

use gearloss_numerics::sensitivity::{Effect, Estimate, Influence, Local};
use serde_json::{Value, json};

use super::super::write::cell;
use super::Found;
use super::outputs::Kind;

pub fn header() -> Vec<String> {
    [
        "model_set",
        "gear",
        "output",
        "kind",
        "unit",
        "parameter",
        "parameter_unit",
        "local_slope",
        "local_scaled",
        "local_elasticity",
        "morris_mu",
        "morris_mu_star",
        "morris_sigma",
        "morris_influence",
        "sobol_first",
        "sobol_first_low",
        "sobol_first_high",
        "sobol_total",
        "sobol_total_low",
        "sobol_total_high",
    ]
    .map(str::to_owned)
    .to_vec()
}

/// Name of an influence in results.
fn name(influence: Influence) -> &'static str {
    match influence {
        Influence::None => "none",
        Influence::NonlinearOrInteracting => "nonlinear_or_interacting",
        Influence::Steady => "steady",
    }
}

fn estimate(e: &Estimate) -> Value {
    json!({ "value": e.value, "interval": e.interval })
}

impl Found<'_> {
    /// A row for each output and parameter.
    pub fn rows(&self) -> Vec<Vec<String>> {
        let mut rows = Vec::new();
        for (i, output) in self.outputs.list.iter().enumerate() {
            let influences = self.morris.as_ref().map(|m| m.influences(i)).unwrap_or_default();
            for (k, range) in self.ranges.iter().enumerate() {
                let local = self.slopes(i, k);
                let effect = self.morris.as_ref().map(|m| m.effects[i][k]);
                let shares = self.sobol.as_ref().map(|s| [s[i].first[k], s[i].total[k]]);
                let mut row = vec![
                    self.built.name.clone(),
                    self.gear.clone(),
                    output.name.clone(),
                    output.kind.name().to_owned(),
                    output.unit().to_owned(),
                    range.varied.pattern.clone(),
                    range.varied.unit.symbol.to_owned(),
                ];
                row.extend([
                    cell(local.map(|l| l.slope)),
                    cell(local.and_then(|l| l.scaled)),
                    cell(local.and_then(|l| l.elasticity)),
                    cell(effect.map(|e| e.mean)),
                    cell(effect.map(|e| e.magnitude)),
                    cell(effect.map(|e| e.deviation)),
                    influences.get(k).map_or("", |i| name(*i)).to_owned(),
                ]);
                for which in 0..2 {
                    let share = shares.map(|s| s[which]);
                    row.push(cell(share.map(|s| s.value)));
                    row.extend([0, 1].map(|end| cell(share.map(|s| s.interval[end]))));
                }
                rows.push(row);
            }
        }
        rows
    }

    pub fn result(&self) -> Value {
        let parameter = |range: &super::Range| {
            json!({
                "path": range.varied.pattern, "paths": range.varied.paths, "unit": range.varied.unit.symbol,
                "start": range.varied.start(), "from": range.ends[0], "to": range.ends[1],
            })
        };
        let outputs = self.outputs.list.iter().enumerate().map(|(i, output)| {
            json!({
                "output": output.name, "kind": output.kind.name(), "unit": output.unit(),
                "load_dependent": output.load_dependent, "mean": self.values[i],
                "local": self.local_of(i),
                "morris": self.effects(i), "sobol": self.shares(i),
            })
        });
        json!({
            "model_set": self.built.name, "gear": self.gear, "points": self.points,
            "runs": {
                "local": self.local.as_ref().map(|_| 1 + 2 * self.ranges.len()),
                "morris": self.morris.as_ref().map(|m| m.runs),
                "sobol": self.sobol.as_ref().map(|_| self.samples * (self.ranges.len() + 2)),
            },
            "parameters": self.ranges.iter().map(parameter).collect::<Vec<_>>(),
            "outputs": outputs.collect::<Vec<_>>(),
        })
    }

    fn local_of(&self, output: usize) -> Option<Vec<Value>> {
        let slopes = |k: usize| self.slopes(output, k).as_ref().map(slope);
        self.local
            .as_ref()
            .filter(|_| self.outputs.list[output].kind != Kind::RelativeLoss)
            .map(|_| (0..self.ranges.len()).filter_map(slopes).collect())
    }

    fn effects(&self, output: usize) -> Option<Vec<Value>> {
        let morris = self.morris.as_ref()?;
        let effect = |(e, influence): (&Effect, Influence)| {
            json!({
                "mu": e.mean, "mu_star": e.magnitude, "sigma": e.deviation, "influence": name(influence),
            })
        };
        Some(
            morris.effects[output]
                .iter()
                .zip(morris.influences(output))
                .map(effect)
                .collect(),
        )
    }

    fn shares(&self, output: usize) -> Option<Value> {
        let shares = &self.sobol.as_ref()?[output];
        Some(json!({
            "mean": shares.mean, "variance": shares.variance, "interactions": shares.interact(),
            "first": shares.first.iter().map(estimate).collect::<Vec<_>>(),
            "total": shares.total.iter().map(estimate).collect::<Vec<_>>(),
        }))
    }
}

fn slope(l: &Local) -> Value {
    json!({ "slope": l.slope, "scaled": l.scaled, "elasticity": l.elasticity })
}
