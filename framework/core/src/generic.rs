//! `none`, `constant`, `formula`, `table` and `function`, written once for all mechanisms, including those of other crates.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde_json::Value;

use crate::description::Ordered;
use crate::document::{Diagnostic, Unit, did_you_mean};
use crate::formula::Formula;
use crate::function::FunctionSource;
use crate::mechanism::gear_drag::Scope;
pub use crate::mechanism::scalar::PLACE;
use crate::mechanism::scalar::ScalarLaw;
pub use crate::mechanism::{Lookup, Scalar};
use crate::mechanism::{Mechanism, Quantity};
use crate::registry::{Build, Built, Entry, Evidence, Graded, USER_DEFINED, formula};
use crate::table::{self, Interpolation, Outside, Reading, Scale, Table};

/// The entries that every mechanism has automatically.
pub(crate) fn entries<M: Mechanism>() -> Vec<Entry> {
    let entry = |name,
                 example,
                 schema: fn(&mut SchemaGenerator) -> Schema,
                 build: fn(&Value, &mut Build<'_>) -> Result<Built, Diagnostic>| Entry {
        mechanism: M::KEY,
        name,
        source: USER_DEFINED,
        example,
        part: None,
        files: &[],
        limits: if name == "table" { const { &[PLACE] } } else { &[] },
        terms: if name == "none" { &[] } else { const { &[M::TOTAL] } },
        observed: &[],
        checks: &[],
        evidence: const { &[formula(Evidence::User, "the user states it")] as &[Graded] },
        scope: Scope::Gear,
        geometry: false,
        plastics: true,
        origin: crate::origin!(),
        schema,
        build,
    };
    let mut entries = vec![
        entry(
            "none",
            "{ type: none }",
            <NoParams as JsonSchema>::json_schema,
            |_, cx| built::<M>(ScalarLaw::None, cx),
        ),
        entry(
            "constant",
            "{ type: constant, value: 0.05 }",
            constant_schema::<M>,
            |value, cx| {
                let value = value["value"].as_f64().ok_or_else(|| cx.error("`value` is missing"))?;
                built::<M>(ScalarLaw::Constant(value), cx)
            },
        ),
        entry(
            "formula",
            "{ type: formula, formula: \"0.02 + 0.001\" }",
            <FormulaParams as JsonSchema>::json_schema,
            build_formula::<M>,
        ),
        entry(
            "table",
            "{ type: table, file: table.csv }",
            <TableParams as JsonSchema>::json_schema,
            build_table::<M>,
        ),
    ];
    if FunctionSource::linked().is_some() {
        entries.push(entry(
            "function",
            "{ type: function, name: law }",
            <FunctionParams as JsonSchema>::json_schema,
            build_function::<M>,
        ));
    }
    entries.retain(|entry| !M::OWN.contains(&entry.name));
    entries
}

/// No loss.
#[derive(Deserialize, JsonSchema)]
struct NoParams {}

/// A formula over the quantities of the context, in their documented units.
#[derive(Deserialize, JsonSchema)]
struct FormulaParams {
    /// Formula over the quantities of the context, such as `0.02 + 1e-6 * abs(speed) * nu`. `gearloss models` lists them with
    /// their units.
    formula: String,
}

/// A function of the program that embeds gearloss, over quantities of the context in their documented units.
#[derive(Deserialize, JsonSchema)]
struct FunctionParams {
    /// Name under which the function was registered.
    name: String,
}

/// A table over one to four quantities of the context, from a CSV file or written in the document.
#[derive(Deserialize, JsonSchema)]
struct TableParams {
    /// CSV file: a column for each axis, named as a quantity with its unit, such as `speed [rpm]`, then a column for the result, or
    /// several that are added. One row for each point of the grid.
    #[schemars(extend("x-refers-to" = "file"))]
    file: Option<String>,
    /// Axes of a table in the document, instead of `file`: increasing values by quantity, such as `{ speed: [0, 1000] }`, in the
    /// units listed by `gearloss models`.
    axes: Option<Axes>,
    /// Results of a table in the document, in the unit of the mechanism's result, with the last axis varying fastest. Each has its
    /// own path, such as `model.values.2`. [-]
    #[schemars(inner(range(min = 0.0)), length(min = 2), extend("x-bare" = true))]
    values: Option<Vec<f64>>,
    /// Extrapolation of the table.
    #[serde(default)]
    outside: Outside,
    /// Interpolation of the table.
    #[serde(default)]
    interpolation: Interpolation,
    /// Scale of each axis by its name, and of the result as `answer`; default: linear, or as set by the mechanism.
    #[serde(default)]
    scale: Ordered<Scale>,
}

/// Values of axes by the name of the quantity, in its documented unit.
#[derive(Deserialize)]
struct Axes(Ordered<Vec<f64>>);

impl JsonSchema for Axes {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Axes".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": "object",
            "additionalProperties": {
                "type": "array",
                "description": "Increasing values of one quantity.",
                "minItems": 2,
                "items": { "type": "number", "description": "A value in the unit of the quantity. [-]", "x-bare": true },
            },
        })
    }
}

fn constant_schema<M: Mechanism>(_: &mut SchemaGenerator) -> Schema {
    json_schema!({
        "type": "object",
        "description": "One value.",
        "properties": { "value": { "type": "number", "minimum": 0.0, "description": M::ANSWER } },
        "required": ["value"],
    })
}

fn built<M: Mechanism>(law: ScalarLaw<M>, cx: &Build<'_>) -> Result<Built, Diagnostic> {
    let unit = Unit::of_doc(M::ANSWER).ok_or_else(|| cx.error("bug: the mechanism's answer has no [unit]"))?;
    Ok(Box::new(M::scalar(Scalar { law, unit })) as Built)
}

fn build_formula<M: Mechanism>(value: &Value, cx: &mut Build<'_>) -> Result<Built, Diagnostic> {
    let params: FormulaParams = cx.params(value)?;
    let names: Vec<&str> = M::QUANTITIES.iter().map(|q| q.name).collect();
    let formula = Formula::compile(&params.formula, &names).map_err(|fault| {
        let error = cx.error(format!("formula, {fault}"));
        match fault.help {
            Some(help) => error.help(help),
            None => error.note(format!("quantities: {}", names.join(", "))),
        }
    })?;
    for (used, quantity) in M::QUANTITIES.iter().enumerate() {
        let needed = cx.part::<M>().and_then(|part| M::needs(part, quantity.name));
        if let (true, Some(needed)) = (formula.uses(used), needed) {
            return Err(cx
                .error(format!("`{}` is unknown here", quantity.name))
                .help(format!("state {needed}")));
        }
    }
    built::<M>(ScalarLaw::Formula(formula), cx)
}

fn build_function<M: Mechanism>(value: &Value, cx: &mut Build<'_>) -> Result<Built, Diagnostic> {
    let FunctionParams { name } = cx.params(value)?;
    let source = FunctionSource::linked();
    let function = source.and_then(|source| (source.find)(&name)).ok_or_else(|| {
        let known = source.map_or_else(Vec::new, |source| (source.names)());
        let error = cx.error(format!("there is no function `{name}`"));
        match did_you_mean(&name, known.iter().map(String::as_str)) {
            Some(close) => error.help(format!("write `{close}`")),
            None if known.is_empty() => error.help("register it before the transmission is built"),
            None => error.help(format!("use one of {}", known.join(", "))),
        }
    })?;
    let inputs = function.quantities().iter().map(|quantity| input::<M>(quantity, cx));
    let inputs = inputs.collect::<Result<Vec<_>, _>>().map_err(|error| Diagnostic {
        message: format!("function `{name}`: {}", error.message),
        ..error
    })?;
    built::<M>(ScalarLaw::Function(function, inputs), cx)
}

/// A quantity of the context by its name, for the part of the model.
fn input<M: Mechanism>(name: &str, cx: &Build<'_>) -> Result<&'static Quantity<M>, Diagnostic> {
    let names: Vec<&str> = M::QUANTITIES.iter().map(|q| q.name).collect();
    let quantity = M::QUANTITIES.iter().find(|q| q.name == name).ok_or_else(|| {
        let error = cx.error(format!("the context of {} has no quantity `{name}`", M::KEY));
        error.help(match did_you_mean(name, names.iter().copied()) {
            Some(close) => format!("write `{close}`"),
            None => format!("use one of {}", names.join(", ")),
        })
    })?;
    match cx.part::<M>().and_then(|part| M::needs(part, quantity.name)) {
        Some(needed) => Err(cx
            .error(format!("`{name}` is unknown here"))
            .help(format!("state {needed}"))),
        None => Ok(quantity),
    }
}

impl<M: Mechanism> Lookup<M> {
    /// Reads a CSV file with one column of results in `unit`.
    ///
    /// # Errors
    /// Faults of the file, its axes or its units, with the fix.
    pub fn read(file: &str, reading: &Reading, unit: &str, cx: &Build<'_>) -> Result<Self, Diagnostic> {
        let lookup = Self::read_sum(file, reading, unit, cx)?;
        if lookup.tables.len() > 1 {
            return Err(cx
                .error(format!(
                    "{file}: line 1: {} columns after the axes",
                    lookup.tables.len()
                ))
                .help("keep one column for the result; each axis is named as a quantity"));
        }
        Ok(lookup)
    }

    /// A table in the document: increasing values of quantities in their documented units, and the results.
    ///
    /// # Errors
    /// If a quantity is unknown, an axis does not increase, or the number of values does not match.
    fn stated(
        stated: &[(String, Vec<f64>)],
        values: Vec<f64>,
        reading: &Reading,
        cx: &Build<'_>,
    ) -> Result<Self, Diagnostic> {
        let axes = stated.iter().map(|(name, _)| input::<M>(name, cx));
        let axes = axes.collect::<Result<Vec<_>, _>>().map_err(|error| Diagnostic {
            message: format!("`axes`: {}", error.message),
            ..error
        })?;
        let grid = stated.iter().zip(&axes).map(|((name, values), axis)| table::Axis {
            name: name.clone(),
            unit: axis.unit.symbol.to_owned(),
            values: values.clone(),
        });
        let table = Table::from_grid(grid.collect(), values, reading).map_err(|reason| {
            cx.error(reason).help(
                "write one value for each point of the grid, with the last axis varying fastest, and increasing axes",
            )
        })?;
        Ok(Self {
            tables: vec![table],
            axes,
        })
    }

    /// Reads a CSV file whose results, in `unit`, are added.
    ///
    /// # Errors
    /// As [`Lookup::read`].
    pub fn read_sum(file: &str, reading: &Reading, unit: &str, cx: &Build<'_>) -> Result<Self, Diagnostic> {
        let bytes = cx.bytes(file)?;
        let fault = |fault: String| cx.error(format!("{file}: {fault}"));
        let columns = table::columns(&bytes).map_err(fault)?;
        let quantity = |name: &str| M::QUANTITIES.iter().find(|q| q.name == name);
        // Results follow the axes; a misspelled first or only axis must not be taken for a result.
        let axes = columns.iter().take_while(|c| quantity(c).is_some()).count();
        if axes == 0 {
            let names: Vec<&str> = M::QUANTITIES.iter().map(|q| q.name).collect();
            let first = columns.first().map_or("", String::as_str);
            return Err(cx
                .error(format!(
                    "{file}: line 1, column 1: the context of {} has no quantity `{first}`",
                    M::KEY
                ))
                .note(format!("quantities: {}", names.join(", ")))
                .help("name each axis as a quantity with its unit, such as `speed [rpm]`"));
        }
        if let Some(later) = columns[axes..].iter().find(|c| quantity(c).is_some()) {
            return Err(cx
                .error(format!(
                    "{file}: line 1: the axis `{later}` follows `{}`, which is not a quantity of {}",
                    columns[axes],
                    M::KEY
                ))
                .help("name each axis as a quantity; results follow all axes"));
        }
        let tables = Table::several_from_file(&bytes, reading, axes).map_err(|reason| {
            let error = fault(reason);
            if columns.len() > axes + 1 {
                let names: Vec<&str> = M::QUANTITIES.iter().map(|q| q.name).collect();
                let answers = columns[axes..].join("`, `");
                error.note(format!(
                    "`{answers}` are taken as results, because {} has no such quantities: {}",
                    M::KEY,
                    names.join(", ")
                ))
            } else {
                error
            }
        })?;
        for (i, (table, column)) in tables.iter().zip(&columns[axes..]).enumerate() {
            let at = format!("line 1, column {}", axes + i + 1);
            if table.unit().is_none() && unit != "-" {
                return Err(cx
                    .error(format!("{file}: {at}: `{column}` has no unit"))
                    .help(format!("convert it where needed and write `{column} [{unit}]`")));
            }
            if let Some(written) = table.unit().filter(|written| !Unit::is_same(written, unit)) {
                return Err(cx
                    .error(format!("{file}: {at}: `{column}` is in {written}, not in {unit}"))
                    .help(format!("convert it and write `{column} [{unit}]`")));
            }
        }
        let axes: Vec<&'static Quantity<M>> = columns[..axes].iter().filter_map(|c| quantity(c)).collect();
        for (i, (axis, quantity)) in tables[0].axes().iter().zip(&axes).enumerate() {
            let symbol = quantity.unit.symbol;
            if !Unit::is_same(&axis.unit, symbol) {
                return Err(cx
                    .error(format!(
                        "{file}: line 1, column {}: `{}` is in {}, not in {symbol}",
                        i + 1,
                        axis.name,
                        axis.unit
                    ))
                    .help(format!("convert it and write `{} [{symbol}]`", axis.name)));
            }
            if let Some(needed) = cx.part::<M>().and_then(|part| M::needs(part, quantity.name)) {
                return Err(cx
                    .error(format!("{file}: `{}` is unknown here", quantity.name))
                    .help(format!("state {needed}")));
            }
        }
        let mut sums = tables[0].points();
        for table in &tables[1..] {
            for (sum, (_, more)) in sums.iter_mut().zip(table.points()) {
                sum.1 += more;
            }
        }
        for (point, sum) in sums {
            if sum < 0.0 {
                let at: Vec<String> = point
                    .iter()
                    .zip(&columns)
                    .map(|(x, name)| format!("{name} = {x}"))
                    .collect();
                return Err(cx
                    .error(format!(
                        "{file}: at {} the result is {sum}, which is negative",
                        at.join(", ")
                    ))
                    .help("correct it: losses and coefficients must not be negative"));
            }
        }
        Ok(Self { tables, axes })
    }
}

fn build_table<M: Mechanism>(value: &Value, cx: &mut Build<'_>) -> Result<Built, Diagnostic> {
    let params: TableParams = cx.params(value)?;
    let unit = Unit::of_doc(M::ANSWER).map_or("-", |u| u.symbol);
    let reading = Reading {
        outside: params.outside,
        interpolation: params.interpolation,
        scales: params.scale.0,
        usually_log: M::LOGARITHMIC,
    };
    let lookup = match (params.file, params.axes, params.values) {
        (Some(file), None, None) => Lookup::read_sum(&file, &reading, unit, cx)?,
        (None, Some(axes), Some(values)) => Lookup::stated(&axes.0.0, values, &reading, cx)?,
        _ => {
            return Err(cx.error("table requires `file`, or `axes` and `values`").help(
                "write `file: NAME.csv`, or the table itself: `axes: { speed: [0, 1000] }, values: [0.1, 0.3]`",
            ));
        }
    };
    built::<M>(ScalarLaw::Table(lookup), cx)
}
