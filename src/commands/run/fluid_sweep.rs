//! Mean losses of duties over one property of an oil, and where they are least.

mod least;
mod show;

use gearloss_framework::description::LubricantEntry;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::lubricant::Lubricant;
use gearloss_framework::lubricant::index::{at_constant_index, index};
use gearloss_framework::resolve::lookup;
use gearloss_studies::study::FluidSweepEntry;
use gearloss_studies::varied::{Tie, Varied};
use rayon::prelude::*;
use serde_json::{Value, json};

use self::least::Least;
use super::write::{cell, head, write};
use super::{Built, Runner};
use crate::interrupt;
use crate::output::{Failure, Out};
use gearloss_studies::analyses::duties::Duties;
use gearloss_studies::analyses::duties::sums_energies;
use gearloss_studies::analyses::shares::{Shares, together};
use gearloss_studies::analyses::trial::{Left, Trial, left};

/// Kinematic viscosity at 100 degC below which the viscosity index is not defined. \[mm2/s\]
const DEFINED: f64 = 2.0;

/// What changes.
enum Swept {
    /// The viscosity, at a constant index. Path of the oil, and what else it says of its viscosity.
    Viscosity {
        oil: String,
        index: f64,
        law: Value,
        factor: Value,
    },
    /// A quantity.
    Property(Varied),
}

/// One hypothetical oil, driven.
struct Fluid {
    /// Value of the property: mm2/s at 100 degC, or in the unit of the path.
    value: f64,
    /// For each duty its mean loss, and that by share. \[W\]
    losses: Vec<(f64, Vec<f64>)>,
    /// True where it came up in the search for the least loss.
    refined: bool,
}

/// All oils of one set.
struct Sweep<'a> {
    built: Built<'a>,
    swept: Swept,
    /// Rising by value.
    fluids: Vec<Fluid>,
    /// For each duty.
    least: Vec<Least>,
}

impl Swept {
    fn new(runner: &Runner<'_>, path: &str, entry: &FluidSweepEntry, b: &Built<'_>) -> Result<Self, Failure> {
        let own = lookup(&b.resolved.value, "housing.oil.lubricant").and_then(Value::as_str);
        let names: Vec<&str> = b.resolved.value["lubricants"]
            .as_object()
            .into_iter()
            .flatten()
            .map(|(k, _)| k.as_str())
            .collect();
        let oil = entry
            .lubricant
            .as_deref()
            .or(own)
            .or(names.first().copied())
            .unwrap_or_default();
        if !names.contains(&oil) {
            let error = gearloss_framework::attach::dangling(&format!("{path}.lubricant"), "lubricant", oil, &names);
            return Err(runner.study.findings(vec![error]).into());
        }
        let oil = format!("lubricants.{oil}");
        if let Some(property) = &entry.property {
            let varied = Varied::new(runner.language, &b.resolved, &format!("{oil}.{property}"), Tie::Value);
            return varied.map(Self::Property).map_err(|d| {
                let at = Diagnostic {
                    path: format!("{path}.property"),
                    ..d
                };
                runner.study.findings(vec![at]).into()
            });
        }
        let index = entry.vi.or_else(|| own_index(&b.resolved.value, &oil)).ok_or_else(|| {
            runner.wrong(
                &format!("{path}.vi"),
                format!("`{oil}` has no viscosity index"),
                "state the index that all oils have",
            )
        })?;
        let own = lookup(&b.resolved.value, &format!("{oil}.viscosity"));
        let of = |key: &str| own.and_then(|v| v.get(key)).cloned().unwrap_or(Value::Null);
        Ok(Self::Viscosity {
            law: of("law"),
            factor: of("factor"),
            oil,
            index,
        })
    }

    /// Values that were listed, rising.
    fn values(&self, runner: &Runner<'_>, path: &str, entry: &FluidSweepEntry) -> Result<Vec<f64>, Failure> {
        let mut values = match self {
            Self::Viscosity { .. } => entry.kv100.iter().map(|nu| nu * 1e6).collect(),
            Self::Property(varied) => entry
                .values
                .iter()
                .map(|value| varied.quantity(value, false))
                .collect::<Result<Vec<f64>, String>>()
                .map_err(|reason| {
                    runner.wrong(
                        &format!("{path}.values"),
                        reason,
                        "write quantities of the property, such as `5 MPa`",
                    )
                })?,
        };
        values.sort_by(f64::total_cmp);
        values.dedup();
        if values.len() < 3 {
            let (key, mend) = match self {
                Self::Viscosity { .. } => (
                    "kv100",
                    "list viscosities, such as `kv100: [2 mm2/s, 4 mm2/s, 6 mm2/s]`",
                ),
                Self::Property(_) => ("values", "list values, each as in a gearbox"),
            };
            return Err(runner.wrong(&format!("{path}.{key}"), "a sweep needs three different values", mend));
        }
        Ok(values)
    }

    fn overrides(&self, value: f64) -> Result<Vec<(String, Value)>, String> {
        match self {
            Self::Viscosity {
                oil,
                index,
                law,
                factor,
            } => {
                let kv40 = at_constant_index(value, *index)
                    .ok_or_else(|| format!("no oil of {value} mm2/s has the viscosity index {index}"))?;
                // The usual law of viscosity over temperature begins at 2 mm2/s.
                let law = if value < DEFINED {
                    json!("astm_d341_low")
                } else {
                    law.clone()
                };
                let mut viscosity = json!({ "kv40": kv40, "kv100": value });
                for (key, own) in [("law", law), ("factor", factor.clone())] {
                    if !own.is_null() {
                        viscosity[key] = own;
                    }
                }
                Ok(vec![(format!("{oil}.viscosity"), viscosity)])
            }
            Self::Property(varied) => Ok(varied.overrides(value).collect()),
        }
    }

    /// Name of the property with its unit.
    fn name(&self) -> String {
        match self {
            Self::Viscosity { index, .. } => format!("kv100 in mm2/s at a viscosity index of {index:.1}"),
            Self::Property(varied) => format!("{} in {}", varied.pattern, varied.unit.symbol),
        }
    }

    /// True where the property has no definition.
    fn is_beyond(&self, value: f64) -> bool {
        matches!(self, Self::Viscosity { .. }) && value < DEFINED
    }
}

/// Viscosity index of an oil of a resolved document; absent where it has none.
fn own_index(document: &Value, oil: &str) -> Option<f64> {
    let entry: LubricantEntry = serde_json::from_value(lookup(document, oil)?.clone()).ok()?;
    let lubricant = Lubricant::new(&entry).ok()?;
    let [kv40, kv100] = [40.0, 100.0].map(|t| lubricant.at(t).nu * 1e6);
    index(kv40, kv100)
}

pub fn run(runner: &Runner<'_>, name: &str, entry: &FluidSweepEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.drive.gearbox.as_ref())?;
    sums_energies(runner, &path, entry.by)?;
    let other = match (
        &entry.property,
        entry.kv100.is_empty() && entry.vi.is_none(),
        entry.values.is_empty(),
    ) {
        (Some(_), false, _) => Some("`property` beside `kv100` or `vi`"),
        (None, _, false) => Some("`values` without a `property`"),
        _ => None,
    };
    if let Some(message) = other {
        return Err(runner.wrong(
            &path,
            message,
            "sweep the viscosity by `kv100`, or one `property` by its `values`",
        ));
    }
    let duties = Duties::new(runner, &path, &entry.drive)?;
    let mut all = Vec::new();
    let built = runner.built(gearbox, &entry.drive.model_sets)?;
    let names = together(built.iter().map(|b| &b.transmission), entry.by);
    for b in built {
        duties.check(runner, &path, &b)?;
        all.extend(sweep(runner, &path, entry, b, (&duties, &names), out)?);
    }
    if runner.only_checks {
        return Ok(());
    }
    for s in &all {
        show::show(name, s, &duties, out)?;
    }
    show::pictures(runner, name, entry, &all, &duties)?;
    let mut header: Vec<String> = [
        "model_set",
        "cycle",
        "value",
        "beyond_definition",
        "refined",
        "mean_loss_w",
    ]
    .map(str::to_owned)
    .to_vec();
    header.extend(names.iter().map(|n| format!("{n}_w")));
    let mut rows = Vec::new();
    for s in &all {
        for (k, read) in duties.list.iter().enumerate() {
            for fluid in &s.fluids {
                let (loss, shares) = &fluid.losses[k];
                let mut row = vec![s.built.name.clone(), read.name.clone(), cell(Some(fluid.value))];
                row.extend([s.swept.is_beyond(fluid.value).to_string(), fluid.refined.to_string()]);
                row.push(cell(Some(*loss)));
                row.extend(shares.iter().map(|x| cell(Some(*x))));
                rows.push(row);
            }
        }
    }
    let mut value = head(runner, &all.iter().map(|s| &s.built).collect::<Vec<_>>());
    value["fluid_sweep"] = all
        .iter()
        .map(|s| s.json(&duties, &names))
        .collect::<Vec<Value>>()
        .into();
    write(runner, name, &entry.write, &header, &rows, &value)
}

/// Drives all listed oils, and those that lead to the least losses; none where the analysis is only checked.
fn sweep<'a>(
    runner: &Runner<'_>,
    path: &str,
    entry: &FluidSweepEntry,
    built: Built<'a>,
    (duties, names): (&Duties<'_>, &[String]),
    out: &mut Out,
) -> Result<Option<Sweep<'a>>, Failure> {
    let swept = Swept::new(runner, path, entry, &built)?;
    let values = swept.values(runner, path, entry)?;
    let trial = Trial::new(runner, &built);
    let drive = |value: f64, refined: bool| -> Result<(Fluid, Left), String> {
        let t = trial.build(swept.overrides(value)?)?;
        let shares = Shares::of(&t, entry.by).under(names);
        let mut losses = Vec::new();
        let mut seen = Left::new();
        for read in &duties.list {
            let driven = duties
                .drive(&t, read, &|_| !interrupt::pressed())
                .map_err(|list| list.first().map_or_else(String::new, |d| d.message.clone()))?
                .ok_or("interrupted")?;
            if let Some((time, why)) = driven.broken {
                let reason = gearloss_studies::analyses::balance::reason(&t, &why);
                return Err(format!("`{}` could not be driven beyond {time} s: {reason}", read.name));
            }
            let time = driven.total.duration;
            let means: Vec<f64> = shares.sums(&driven.total.parts).iter().map(|x| x / time).collect();
            losses.push((driven.total.parts.iter().sum::<f64>() / time, means));
            seen.extend(left(&t, &driven.seen));
        }
        let fluid = Fluid { value, losses, refined };
        Ok((fluid, seen))
    };
    let failed = |value: f64, reason: String| {
        if interrupt::pressed() {
            return Failure::Interrupted;
        }
        runner.wrong(
            path,
            format!("{value}: {reason}"),
            "leave the value out, or narrow the range",
        )
    };
    if runner.only_checks {
        for value in values {
            let oil = swept.overrides(value).and_then(|changes| trial.build(changes));
            oil.map_err(|reason| failed(value, reason))?;
        }
        return Ok(None);
    }
    let bar = runner.bar(values.len() as u64, &format!("{} oils", built.name));
    let mut seen = Left::new();
    let mut fluids: Vec<Fluid> = Vec::new();
    let mut keep = |results: Vec<(f64, Result<(Fluid, Left), String>)>, fluids: &mut Vec<Fluid>| {
        for (value, result) in results {
            let (fluid, more) = result.map_err(|reason| failed(value, reason))?;
            seen.extend(more);
            fluids.push(fluid);
        }
        fluids.sort_by(|a, b| a.value.total_cmp(&b.value));
        Ok::<(), Failure>(())
    };
    let one = |value: &f64| {
        let result = (*value, drive(*value, false));
        bar.inc(1);
        result
    };
    keep(values.par_iter().with_max_len(1).map(one).collect(), &mut fluids)?;
    if entry.refine {
        // Each round asks, for every duty, where a parabola through the three best oils is least.
        for _ in 0..least::ROUNDS {
            let mut wanted: Vec<f64> = (0..duties.list.len())
                .filter_map(|k| least::wanted(&points(&fluids, k)))
                .collect();
            wanted.sort_by(f64::total_cmp);
            wanted.dedup_by(|a, b| (*a / *b - 1.0).abs() < 1e-6);
            if wanted.is_empty() {
                break;
            }
            bar.inc_length(wanted.len() as u64);
            let one = |value: &f64| {
                let result = (*value, drive(*value, true));
                bar.inc(1);
                result
            };
            keep(wanted.par_iter().with_max_len(1).map(one).collect(), &mut fluids)?;
        }
    }
    bar.finish_and_clear();
    runner.left_at_samples(&seen, out);
    let least = (0..duties.list.len()).map(|k| Least::of(&points(&fluids, k))).collect();
    Ok(Some(Sweep {
        built,
        swept,
        fluids,
        least,
    }))
}

/// Value and mean loss of each oil for a duty.
fn points(fluids: &[Fluid], duty: usize) -> Vec<(f64, f64)> {
    fluids.iter().map(|f| (f.value, f.losses[duty].0)).collect()
}

impl Sweep<'_> {
    fn json(&self, duties: &Duties<'_>, names: &[String]) -> Value {
        let cycles: Vec<Value> = duties
            .list
            .iter()
            .zip(&self.least)
            .enumerate()
            .map(|(k, (read, least))| {
                let fluids: Vec<Value> = self
                    .fluids
                    .iter()
                    .map(|f| {
                        json!({
                            "value": f.value, "mean_loss_w": f.losses[k].0, "mean_losses_w": f.losses[k].1,
                            "beyond_definition": self.swept.is_beyond(f.value), "refined": f.refined,
                        })
                    })
                    .collect();
                json!({ "cycle": read.name, "least": least.json(), "fluids": fluids })
            })
            .collect();
        json!({
            "model_set": self.built.name, "property": self.swept.name(), "shares": names, "cycles": cycles,
        })
    }
}
