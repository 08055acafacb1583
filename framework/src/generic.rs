//! `none`, `constant`, `formula` and `table`, written once for all mechanisms, those of other crates included.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde_json::Value;

use crate::description::Ordered;
use crate::document::{Diagnostic, Unit};
use crate::formula::Formula;
use crate::loss::{Loss, Undefined};
use crate::mechanism::gear_drag::Scope;
use crate::mechanism::{Mechanism, Quantity};
use crate::registry::{Build, Built, Entry, Evidence, Graded, formula};
use crate::table::{Interpolation, Outside, Reading, Scale, Table};

/// The most quantities that a context may have, for the inputs of a formula.
const MOST_QUANTITIES: usize = 24;

/// A law that answers with one number: a coefficient, a moment or a power.
pub struct Scalar<M: Mechanism> {
    law: Law<M>,
    unit: &'static Unit,
}

enum Law<M: Mechanism> {
    None,
    /// In SI.
    Constant(f64),
    Formula(Formula),
    Table(Lookup<M>),
}

impl<M: Mechanism> Scalar<M> {
    /// The number at a context, SI.
    ///
    /// # Errors
    /// Where the formula has no value, the table ends, or the number is negative.
    pub fn value(&self, at: &M::At<'_>) -> Result<f64, Undefined> {
        let value = match &self.law {
            Law::None => return Ok(0.0),
            Law::Constant(value) => return Ok(*value),
            Law::Formula(formula) => {
                let mut inputs = [0.0; MOST_QUANTITIES];
                for (input, q) in inputs.iter_mut().zip(M::QUANTITIES) {
                    *input = q.unit().from_si((q.get)(at));
                }
                formula.value(&inputs[..M::QUANTITIES.len()])?
            }
            Law::Table(lookup) => lookup.value(at)?,
        };
        if value < 0.0 {
            return Err(Undefined {
                what: "value of the formula or table is negative",
                value,
            });
        }
        Ok(self.unit.to_si(value))
    }

    /// The number as a moment.
    ///
    /// # Errors
    /// As [`Scalar::value`].
    pub fn moment(&self, at: &M::At<'_>) -> Result<Loss, Undefined> {
        Ok(Loss::MOMENTS.with(&M::TOTAL, self.value(at)?))
    }

    /// The number as a power.
    ///
    /// # Errors
    /// As [`Scalar::value`].
    pub fn power(&self, at: &M::At<'_>) -> Result<Loss, Undefined> {
        Ok(Loss::POWERS.with(&M::TOTAL, self.value(at)?))
    }
}

/// The four entries of a mechanism.
pub(crate) fn entries<M: Mechanism>() -> Vec<Entry> {
    let entry = |name,
                 meaning,
                 example,
                 schema: fn(&mut SchemaGenerator) -> Schema,
                 build: fn(&Value, &mut Build<'_>) -> Result<Built, Diagnostic>| Entry {
        mechanism: M::KEY,
        name,
        meaning,
        source: "the user's own",
        example,
        part: None,
        limits: &[],
        terms: if name == "none" { &[] } else { const { &[M::TOTAL] } },
        observed: &[],
        evidence: const { &[formula(Evidence::User, "the user states it")] as &[Graded] },
        scope: Scope::Gear,
        origin: crate::origin!(),
        schema,
        build,
    };
    vec![
        entry(
            "none",
            "No loss.",
            "{ type: none }",
            <NoParams as JsonSchema>::json_schema,
            |_, cx| built::<M>(Law::None, cx),
        ),
        entry(
            "constant",
            "One value.",
            "{ type: constant, value: 0.05 }",
            constant_schema::<M>,
            |value, cx| {
                let value = value["value"].as_f64().ok_or_else(|| cx.error("`value` is missing"))?;
                built::<M>(Law::Constant(value), cx)
            },
        ),
        entry(
            "formula",
            "A formula over the quantities of the context, in their documented units.",
            "{ type: formula, formula: \"0.02 + 0.001\" }",
            <FormulaParams as JsonSchema>::json_schema,
            build_formula::<M>,
        ),
        entry(
            "table",
            "A table over one to four quantities of the context, from a CSV file.",
            "{ type: table, file: table.csv }",
            <TableParams as JsonSchema>::json_schema,
            build_table::<M>,
        ),
    ]
}

/// No parameters.
#[derive(Deserialize, JsonSchema)]
struct NoParams {}

/// A formula.
#[derive(Deserialize, JsonSchema)]
struct FormulaParams {
    /// Formula over the quantities of the context, such as `0.02 + 1e-6 * abs(speed) * nu`. `gearloss models` lists them with
    /// their units.
    formula: String,
}

/// A table.
#[derive(Deserialize, JsonSchema)]
struct TableParams {
    /// CSV file: a column for each axis, named as a quantity with its unit, such as `speed [rpm]`, then one column for
    /// the answer. One row for each point of the grid.
    file: String,
    /// What holds beyond the ends of the table.
    #[serde(default)]
    outside: Outside,
    /// What connects the points.
    #[serde(default)]
    interpolation: Interpolation,
    /// Scale of each axis by its name, and of the answer as `answer`; others are linear.
    #[serde(default)]
    scale: Ordered<Scale>,
}

fn constant_schema<M: Mechanism>(_: &mut SchemaGenerator) -> Schema {
    json_schema!({
        "type": "object",
        "description": "One value.",
        "properties": { "value": { "type": "number", "minimum": 0.0, "description": M::ANSWER } },
        "required": ["value"],
    })
}

fn built<M: Mechanism>(law: Law<M>, cx: &Build<'_>) -> Result<Built, Diagnostic> {
    let unit = Unit::of_doc(M::ANSWER).ok_or_else(|| cx.error("bug: the mechanism's answer has no [unit]"))?;
    Ok(Box::new(M::scalar(Scalar { law, unit })) as Built)
}

fn build_formula<M: Mechanism>(value: &Value, cx: &mut Build<'_>) -> Result<Built, Diagnostic> {
    let params: FormulaParams = cx.params(value)?;
    let names: Vec<&str> = M::QUANTITIES.iter().map(|q| q.name).collect();
    let formula = Formula::compile(&params.formula, &names).map_err(|fault| {
        let error = cx.error(format!("formula, column {}: {}", fault.column, fault.message));
        match fault.mend {
            Some(mend) => error.mend(mend),
            None => error.note(format!("quantities: {}", names.join(", "))),
        }
    })?;
    built::<M>(Law::Formula(formula), cx)
}

/// A table over quantities of a mechanism's context, for models that read one.
pub struct Lookup<M: Mechanism> {
    table: Table,
    axes: Vec<&'static Quantity<M>>,
}

impl<M: Mechanism> Lookup<M> {
    /// Reads a CSV file; its answer is in `unit`.
    ///
    /// # Errors
    /// The file, its axes or its units, with what to write instead.
    pub fn read(file: &str, reading: &Reading, unit: &str, cx: &Build<'_>) -> Result<Self, Diagnostic> {
        let text = cx.text(file)?;
        let table = Table::from_csv(&text, reading).map_err(|fault| cx.error(format!("{file}: {fault}")))?;
        if let Some(written) = table.unit().filter(|written| *written != unit) {
            return Err(cx
                .error(format!("{file}: the answer is in {written}, not in {unit}"))
                .mend(format!("convert it and write `[{unit}]` in the last column's header")));
        }
        let mut axes = Vec::new();
        for axis in table.axes() {
            let Some(quantity) = M::QUANTITIES.iter().find(|q| q.name == axis.name) else {
                let names: Vec<&str> = M::QUANTITIES.iter().map(|q| q.name).collect();
                return Err(cx
                    .error(format!(
                        "{file}: the context of {} has no quantity `{}`",
                        M::KEY,
                        axis.name
                    ))
                    .note(format!("quantities: {}", names.join(", "))));
            };
            if axis.unit != quantity.unit().symbol {
                return Err(cx
                    .error(format!(
                        "{file}: column `{}` is in {}, not in {}",
                        axis.name,
                        axis.unit,
                        quantity.unit().symbol
                    ))
                    .mend(format!(
                        "convert it and write `{} [{}]`",
                        axis.name,
                        quantity.unit().symbol
                    )));
            }
            axes.push(quantity);
        }
        Ok(Self { table, axes })
    }

    /// The answer at a context, in the unit of the file.
    ///
    /// # Errors
    /// Where the table ends.
    pub fn value(&self, at: &M::At<'_>) -> Result<f64, Undefined> {
        let mut inputs = [0.0; 4];
        for (input, q) in inputs.iter_mut().zip(&self.axes) {
            *input = q.unit().from_si((q.get)(at));
        }
        // A table over speeds that are not negative holds for both senses of rotation.
        for (input, (axis, q)) in inputs.iter_mut().zip(self.table.axes().iter().zip(&self.axes)) {
            if q.least < 0.0 && q.unit().symbol == "rpm" && axis.values[0] >= 0.0 {
                *input = input.abs();
            }
        }
        self.table.value(&inputs[..self.axes.len()])
    }
}

fn build_table<M: Mechanism>(value: &Value, cx: &mut Build<'_>) -> Result<Built, Diagnostic> {
    let params: TableParams = cx.params(value)?;
    let unit = Unit::of_doc(M::ANSWER).map_or("-", |u| u.symbol);
    let reading = Reading {
        outside: params.outside,
        interpolation: params.interpolation,
        scales: params.scale.0,
    };
    let lookup = Lookup::read(&params.file, &reading, unit, cx)?;
    built::<M>(Law::Table(lookup), cx)
}
