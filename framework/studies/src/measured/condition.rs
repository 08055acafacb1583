//! Conditions on measured rows in the syntax of users: `torque > 1000 Nm and not (speed <= 500 rpm)`.
//!
//! Operands: the quantities of a measurement, bound names, and headers of columns; `==`, `!=`, `<`, `<=`, `>`, `>=`; `and`, `or`, `not`,
//! parentheses. `not` has the highest precedence, `or` the lowest.

use super::{KNOWN, Measured, Row};
use gearloss_framework::document::expression::{ExpressionFault, Grammar, Grouping, Level, Scanner};
use gearloss_framework::document::{Dimension, Unit, did_you_mean, number_length};

/// Maximum number of characters of a condition.
const LONGEST: usize = 2000;
/// Maximum nesting of parentheses and `not`.
const DEEPEST: usize = 50;
/// Maximum number of bytes of a unit.
const LONGEST_UNIT: usize = 60;
/// Relative difference of equal numbers: rounding of unit conversions, far below the resolution of instruments.
const EQUAL: f64 = 1e-9;

/// A condition on measured rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    text: String,
    rule: Rule,
}

#[derive(Debug, Clone, PartialEq)]
enum Rule {
    All(Vec<Rule>),
    Any(Vec<Rule>),
    Not(Box<Rule>),
    Compare(Comparison),
}

#[derive(Debug, Clone, PartialEq)]
struct Comparison {
    /// Quantity, bound name or header.
    subject: String,
    operator: Operator,
    value: Literal,
    /// Columns of subject and value in the text.
    columns: [usize; 2],
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Operator {
    Equal,
    Unequal,
    Below,
    AtMost,
    Above,
    AtLeast,
}

impl Operator {
    /// Longer operators precede their prefixes.
    const ALL: [(&'static str, Self); 6] = [
        ("==", Self::Equal),
        ("!=", Self::Unequal),
        ("<=", Self::AtMost),
        (">=", Self::AtLeast),
        ("<", Self::Below),
        (">", Self::Above),
    ];

    fn compares_sizes(self) -> bool {
        !matches!(self, Self::Equal | Self::Unequal)
    }

    fn holds(self, value: f64, limit: f64) -> bool {
        let equal = (value - limit).abs() <= EQUAL * value.abs().max(limit.abs());
        match self {
            Self::Equal => equal,
            Self::Unequal => !equal,
            Self::Below => value < limit && !equal,
            Self::AtMost => value < limit || equal,
            Self::Above => value > limit && !equal,
            Self::AtLeast => value > limit || equal,
        }
    }
}

/// The right-hand side as written.
#[derive(Debug, Clone, PartialEq)]
struct Literal {
    text: String,
    /// Number and symbol of its unit; absent for words.
    number: Option<(f64, Option<String>)>,
}

impl Literal {
    /// The value for a quantity with a unit, `%` for fractions; SI.
    fn value_for(&self, subject: &str, unit: &str, column: usize) -> Result<f64, ExpressionFault> {
        let text = &self.text;
        let wrong = |message: String, help: String| fault(column, message, help);
        let Some((number, symbol)) = &self.number else {
            return Err(wrong(
                format!("`{text}` is not a number, which {subject} is compared with"),
                format!("write a number, such as `1{}`", spaced(unit)),
            ));
        };
        match symbol.as_deref() {
            None if unit == "%" => Err(wrong(
                format!("`{text}`: fraction or percent?"),
                format!("write `{text} %`, or `{text} -` for a fraction"),
            )),
            Some("%") if unit == "%" => Ok(0.01 * number),
            None | Some("-") if is_plain(unit) => Ok(*number),
            Some("-") if unit == "%" => Ok(*number),
            None => Err(wrong(
                format!("`{text}` has no unit"),
                format!("write its unit, such as `{text} {unit}`"),
            )),
            Some(symbol) => {
                let due = Unit::read(unit).map_or(Dimension::None, |due| due.dimension);
                let found = Unit::read_as(symbol, due).map_err(|fault| wrong(fault.message, fault.help))?;
                Ok(found.to_si(*number))
            }
        }
    }
}

fn is_plain(unit: &str) -> bool {
    matches!(unit, "" | "-")
}

fn spaced(unit: &str) -> String {
    if is_plain(unit) {
        String::new()
    } else {
        format!(" {unit}")
    }
}

fn fault(column: usize, message: impl Into<String>, help: impl Into<String>) -> ExpressionFault {
    ExpressionFault::new(column, message).help(help)
}

/// Documented unit of a quantity, `%` for efficiencies; empty for texts.
fn known_unit(subject: &str) -> Option<&'static str> {
    let known = KNOWN.iter().find(|known| known.name == subject)?;
    let is_share = known.unit == "-" && subject.starts_with("efficiency");
    Some(if is_share { "%" } else { known.unit })
}

impl Condition {
    /// Reads a condition. Names that are not measured quantities may be columns of a file, which [`Condition::check`] verifies.
    ///
    /// # Errors
    /// The first error with its column: for example a missing operator, or a missing or wrong unit.
    pub fn parse(text: &str) -> Result<Self, ExpressionFault> {
        if text.chars().count() > LONGEST {
            return Err(fault(
                LONGEST,
                format!("more than {LONGEST} characters"),
                "add a column to the file, and use its name",
            ));
        }
        let mut scanner = Scanner::new(text);
        let rule = scanner.expression(&mut Conditions)?;
        if !scanner.rest().is_empty() {
            let help = if scanner.rest().starts_with(')') {
                "delete the parenthesis, or add the opening one"
            } else {
                "join comparisons by `and` or `or`"
            };
            return Err(scanner.fault(format!("unexpected `{}`", word(&scanner))).help(help));
        }
        Ok(Self {
            text: text.trim().to_owned(),
            rule,
        })
    }

    /// The condition as written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Rejects names that are neither measured quantities nor columns of the file, and invalid values.
    ///
    /// # Errors
    /// The first such name or value, with the column of the text.
    pub fn check(&self, measured: &Measured) -> Result<(), ExpressionFault> {
        self.rule.check(measured)
    }

    /// Whether a row satisfies the condition; absent if a missing value makes it undecidable.
    pub fn holds(&self, measured: &Measured, row: &Row) -> Option<bool> {
        self.rule.holds(measured, row)
    }
}

impl Rule {
    fn check(&self, measured: &Measured) -> Result<(), ExpressionFault> {
        match self {
            Self::All(rules) | Self::Any(rules) => rules.iter().try_for_each(|rule| rule.check(measured)),
            Self::Not(rule) => rule.check(measured),
            Self::Compare(comparison) => comparison.check(measured),
        }
    }

    fn holds(&self, measured: &Measured, row: &Row) -> Option<bool> {
        // One decisive rule is sufficient.
        let joined = |rules: &[Rule], decides: bool| {
            let mut all_known = true;
            for rule in rules {
                match rule.holds(measured, row) {
                    Some(held) if held == decides => return Some(decides),
                    Some(_) => {}
                    None => all_known = false,
                }
            }
            all_known.then_some(!decides)
        };
        match self {
            Self::All(rules) => joined(rules, false),
            Self::Any(rules) => joined(rules, true),
            Self::Not(rule) => rule.holds(measured, row).map(|held| !held),
            Self::Compare(comparison) => comparison.holds(measured, row),
        }
    }
}

impl Comparison {
    /// Checks without a file.
    fn check_known(&self) -> Result<(), ExpressionFault> {
        match known_unit(&self.subject) {
            Some("") if self.operator.compares_sizes() => Err(fault(
                self.columns[0],
                format!("{} is text, which has no order", self.subject),
                "compare it by `==` or `!=`",
            )),
            Some("") | None => Ok(()),
            Some(unit) => self.value.value_for(&self.subject, unit, self.columns[1]).map(|_| ()),
        }
    }

    fn check(&self, measured: &Measured) -> Result<(), ExpressionFault> {
        let [subject, value] = self.columns;
        if let Some(unit) = known_unit(&self.subject) {
            let there = if unit.is_empty() {
                measured.rows.iter().any(|row| text_of(row, &self.subject).is_some())
            } else {
                measured.holds(&self.subject)
            };
            return if there {
                Ok(())
            } else {
                Err(fault(
                    subject,
                    format!("the data do not contain `{}`", self.subject),
                    format!(
                        "state its column under `columns: {{ {}: ... }}`, or delete it",
                        self.subject
                    ),
                ))
            };
        }
        let Some(place) = measured.column(&self.subject) else {
            let headers = measured.columns.iter().map(|c| c.header.as_str());
            let names = KNOWN.iter().map(|k| k.name).chain(headers.clone());
            let bound = measured.columns.iter().filter_map(|c| c.bound.as_deref());
            let help = match did_you_mean(&self.subject, names.chain(bound)) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("the columns are {}", headers.collect::<Vec<_>>().join(", ")),
            };
            return Err(fault(
                subject,
                format!(
                    "`{}` is neither a measured quantity nor a column of the file",
                    self.subject
                ),
                help,
            ));
        };
        // As a header it would lack the sign, the scale and the unit of the quantity.
        if let Some(quantity) = measured.columns[place].quantity {
            return Err(fault(
                subject,
                format!("the column `{}` is read as `{quantity}`", self.subject),
                format!("write `{quantity}`"),
            ));
        }
        let unit = measured.columns[place].unit.as_deref().unwrap_or("");
        match &self.value.number {
            Some((_, symbol)) if symbol.is_some() || !unit.is_empty() || self.operator.compares_sizes() => {
                self.value.value_for(&self.subject, unit, value).map(|_| ())
            }
            None if self.operator.compares_sizes() => self.value.value_for(&self.subject, unit, value).map(|_| ()),
            _ => Ok(()),
        }
    }

    fn holds(&self, measured: &Measured, row: &Row) -> Option<bool> {
        let texts = |text: &str| match self.operator {
            Operator::Equal => Some(text == self.value.text),
            Operator::Unequal => Some(text != self.value.text),
            _ => None,
        };
        let numbers = |value: f64, unit: &str| {
            let limit = self.value.value_for(&self.subject, unit, self.columns[1]).ok()?;
            Some(self.operator.holds(value, limit))
        };
        match known_unit(&self.subject) {
            Some("") => texts(text_of(row, &self.subject)?),
            Some(unit) => numbers(measured.value(row, &self.subject)?, unit),
            None => {
                let place = measured.column(&self.subject)?;
                let cell = row.cells.get(place).filter(|cell| !cell.is_empty())?;
                let unit = measured.columns[place].unit.as_deref().unwrap_or("");
                let number = cell.parse::<f64>().ok().filter(|x| x.is_finite());
                match (number, &self.value.number) {
                    (Some(number), Some(_)) => {
                        // The value of a literal is in SI, and so is that of a cell.
                        let number = Unit::read(unit).map_or(number, |unit| unit.to_si(number));
                        numbers(number, unit)
                    }
                    _ => texts(cell),
                }
            }
        }
    }
}

fn text_of<'r>(row: &'r Row, subject: &str) -> Option<&'r str> {
    if subject == "gear" {
        row.gear.as_deref()
    } else {
        row.name.as_deref()
    }
}

/// The grammar of conditions.
struct Conditions;

#[derive(Clone, Copy)]
enum Join {
    And,
    Or,
}

impl Grammar for Conditions {
    type Operator = Join;
    type Value = Rule;

    const LEVELS: &'static [Level<Join>] = &[
        (Grouping::Left, &[("or", Join::Or)]),
        (Grouping::Left, &[("and", Join::And)]),
    ];
    const PREFIXES: &'static [(&'static str, bool)] = &[("not", true)];
    const ABOVE_PREFIXES: usize = 2;
    const DEEPEST: usize = DEEPEST;

    fn too_deep(column: usize) -> ExpressionFault {
        let message = format!("more than {DEEPEST} nested parentheses");
        fault(column, message, "add a column to the file, and use its name")
    }

    fn unclosed(column: usize) -> ExpressionFault {
        fault(column, "a parenthesis is not closed", "write `)`")
    }

    fn operand(&mut self, scanner: &mut Scanner<'_>) -> Result<Rule, ExpressionFault> {
        comparison(scanner).map(Rule::Compare)
    }

    fn negate(&mut self, rule: Rule) -> Rule {
        Rule::Not(Box::new(rule))
    }

    fn join(&mut self, join: Join, left: Rule, right: Rule) -> Rule {
        match (join, left) {
            (Join::And, Rule::All(rules)) => Rule::All(with(rules, right)),
            (Join::Or, Rule::Any(rules)) => Rule::Any(with(rules, right)),
            (Join::And, left) => Rule::All(vec![left, right]),
            (Join::Or, left) => Rule::Any(vec![left, right]),
        }
    }
}

fn with(mut rules: Vec<Rule>, rule: Rule) -> Vec<Rule> {
    rules.push(rule);
    rules
}

/// The next word, for messages.
fn word(scanner: &Scanner<'_>) -> String {
    let word = scanner.rest().split_whitespace().next().unwrap_or_default();
    word.chars().take(20).collect()
}

fn comparison(scanner: &mut Scanner<'_>) -> Result<Comparison, ExpressionFault> {
    let begin = scanner.column();
    if number_length(scanner.rest()) > 0 {
        return Err(scanner
            .fault("a comparison cannot start with a number")
            .help("start with the quantity: `speed > 500 rpm and speed < 3000 rpm`"));
    }
    let subject = quoted(scanner)?.unwrap_or_else(|| name(scanner)).to_owned();
    if subject.is_empty() {
        let message = if scanner.rest().is_empty() {
            "the condition ends before a comparison".to_owned()
        } else {
            format!("expected a quantity, found `{}`", word(scanner))
        };
        return Err(scanner
            .fault(message)
            .help("write a comparison such as `torque > 1000 Nm` or `gear == first`"));
    }
    let operator = Operator::ALL.iter().find(|(sign, _)| scanner.take(sign));
    let Some((_, operator)) = operator else {
        let help = if scanner.rest().starts_with('=') {
            "write `==`"
        } else {
            "write one of ==, !=, <, <=, >, >= and a value"
        };
        return Err(scanner
            .fault(format!("`{subject}` is not followed by a comparison"))
            .help(help));
    };
    scanner.skip_spaces();
    let value_at = scanner.column();
    let value = literal(scanner, &subject)?;
    let comparison = Comparison {
        subject,
        operator: *operator,
        value,
        columns: [begin, value_at],
    };
    comparison.check_known()?;
    Ok(comparison)
}

/// A name in quotes, if next.
fn quoted<'t>(scanner: &mut Scanner<'t>) -> Result<Option<&'t str>, ExpressionFault> {
    let Some(quote) = scanner.rest().chars().next().filter(|c| matches!(c, '"' | '\'')) else {
        return Ok(None);
    };
    let Some(end) = scanner.rest()[1..].find(quote) else {
        return Err(scanner
            .fault("quotes are not closed")
            .help(format!("write `{quote}` after the name")));
    };
    Ok(Some(&scanner.advance(end + 2)[1..=end]))
}

/// A name up to a space, a parenthesis or a comparison.
fn name<'t>(scanner: &mut Scanner<'t>) -> &'t str {
    scanner.advance_to(|c| c.is_whitespace() || matches!(c, '(' | ')' | '<' | '>' | '=' | '!'))
}

fn literal(scanner: &mut Scanner<'_>, subject: &str) -> Result<Literal, ExpressionFault> {
    let word = |text: &str| Literal {
        text: text.to_owned(),
        number: None,
    };
    if let Some(text) = quoted(scanner)? {
        return Ok(word(text));
    }
    let length = number_length(scanner.rest());
    let behind = scanner.rest()[length..].chars().next();
    // `2nd` is a word, `60degC` a quantity.
    let is_text = known_unit(subject) == Some("");
    if length == 0 || (is_text && behind.is_some_and(char::is_alphanumeric)) {
        let text = name(scanner);
        return if text.is_empty() {
            Err(scanner
                .fault("a value is missing")
                .help("write a value, such as `1000 Nm` or `first`"))
        } else {
            Ok(word(text))
        };
    }
    if behind == Some(',') {
        return Err(scanner
            .fault("a comma in a number")
            .help("use a decimal point and no thousands separators"));
    }
    let text = &scanner.rest()[..length];
    let number = text.parse::<f64>().ok().filter(|x| x.is_finite());
    let Some(number) = number else {
        return Err(scanner
            .fault(format!("`{text}` is too large"))
            .help("write another number"));
    };
    scanner.advance(length);
    Ok(Literal {
        text: text.to_owned(),
        number: Some((number, unit(scanner)?)),
    })
}

/// The longest matching unit; absent if the number has none.
fn unit(scanner: &mut Scanner<'_>) -> Result<Option<String>, ExpressionFault> {
    scanner.skip_spaces();
    let rest = scanner.rest();
    let ends = rest.char_indices().map(|(at, c)| (at, c.is_whitespace() || c == ')'));
    let mut ends: Vec<usize> = ends.filter_map(|(at, is_end)| is_end.then_some(at)).collect();
    ends.push(rest.len());
    ends.retain(|end| *end <= LONGEST_UNIT);
    let is_unit = |end: &&usize| !rest[..**end].ends_with(char::is_whitespace) && Unit::read(&rest[..**end]).is_some();
    if let Some(end) = ends.iter().rev().find(is_unit) {
        return Ok(Some(scanner.advance(*end).to_owned()));
    }
    let word = rest.split([' ', ')']).next().unwrap_or_default();
    if matches!(word, "" | "and" | "or") {
        return Ok(None);
    }
    Err(scanner
        .fault(format!("`{word}` is not a unit"))
        .help("write a unit such as Nm, rpm, W, degC or %, or join comparisons by `and` or `or`"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::measured::tests::entry;

    const FILE: &str = "torque [Nm],speed [rpm],efficiency [%],oil_temperature [degC],gear,name,V_oil [ml],use_for_test,T Öl\n\
        1000,3000,95,60,first,idle,800,yes,1\n\
        -20,500,90,,second,run,900,no,2\n\
        1500,1000.5,97,80,first,,1000,1,x\n";

    fn measured() -> Measured {
        let mut entry = entry(&[("volume", "V_oil")], &[]);
        entry.faulty_rows = crate::measured::FaultyRows::Keep;
        entry.read(FILE.as_bytes(), &["volume"]).unwrap()
    }

    fn rows(text: &str) -> Vec<Option<bool>> {
        let measured = measured();
        let condition = Condition::parse(text).unwrap_or_else(|f| panic!("{text}: {f:?}"));
        condition.check(&measured).unwrap_or_else(|f| panic!("{text}: {f:?}"));
        measured
            .rows
            .iter()
            .map(|row| condition.holds(&measured, row))
            .collect()
    }

    #[test]
    fn quantities_are_compared_with_their_units() {
        let (yes, no) = (Some(true), Some(false));
        for (text, expected) in [
            ("torque > 1000 Nm", [no, no, yes]),
            ("torque >= 1 kNm", [yes, no, yes]),
            ("torque>=1kNm", [yes, no, yes]),
            ("torque < 0 Nm", [no, yes, no]),
            ("torque < -5e0 N m", [no, yes, no]),
            ("speed == 50 1/min or speed == 3000 rpm", [yes, no, no]),
            ("speed != 3000 1/min", [no, yes, yes]),
            ("efficiency > 92 %", [yes, no, yes]),
            ("efficiency > 0.92 -", [yes, no, yes]),
            ("oil_temperature > 60 degC", [no, None, yes]),
            ("oil_temperature <= 140 degF", [yes, None, no]),
            ("not oil_temperature > 60 degC", [yes, None, no]),
        ] {
            assert_eq!(rows(text), expected, "{text}");
        }
    }

    #[test]
    fn texts_and_columns_of_the_file_are_compared() {
        let (yes, no) = (Some(true), Some(false));
        for (text, expected) in [
            ("gear == first", [yes, no, yes]),
            ("name != idle", [no, yes, None]),
            ("name == 'idle'", [yes, no, None]),
            ("volume > 0.85 l", [no, yes, yes]),
            ("V_oil == 800 ml", [yes, no, no]),
            ("use_for_test == yes", [yes, no, no]),
            ("use_for_test == 1", [no, no, yes]),
            ("\"T Öl\" > 1", [no, yes, None]),
            ("\"T Öl\" == x", [no, no, yes]),
        ] {
            assert_eq!(rows(text), expected, "{text}");
        }
    }

    #[test]
    fn and_binds_tighter_than_or_and_blanks_decide_nothing() {
        let (yes, no) = (Some(true), Some(false));
        for (text, expected) in [
            ("torque < 0 Nm or gear == first and speed > 2000 rpm", [yes, yes, no]),
            ("(torque < 0 Nm or gear == first) and speed > 2000 rpm", [yes, no, no]),
            ("not (gear == first and speed > 2000 rpm)", [no, yes, yes]),
            ("not not(gear == first)", [yes, no, yes]),
            // What is known decides where it can.
            ("gear == second or oil_temperature > 70 degC", [no, yes, yes]),
            ("gear == second and oil_temperature > 70 degC", [no, None, no]),
        ] {
            assert_eq!(rows(text), expected, "{text}");
        }
    }

    #[test]
    fn faults_name_the_column_and_the_way_out() {
        for (text, column, message, help) in [
            ("torque > 1000", 10, "has no unit", "`1000 Nm`"),
            (
                "torque > 1000 rpm",
                10,
                "`rpm` is an angular speed, not a torque",
                "kNm",
            ),
            ("torque > 1000 Mm", 10, "`Mm` is a length, not a torque", "Nm"),
            ("torque > 1000 Nmx", 15, "`Nmx` is not a unit", "Nm"),
            ("torque > 1000 Nm speed < 2 rpm", 18, "unexpected `speed`", "`and`"),
            ("torque > 1,5 Nm", 10, "a comma", "point"),
            ("torque = 5 Nm", 8, "not followed by a comparison", "`==`"),
            ("torque > first", 10, "not a number", "`1 Nm`"),
            ("torque >", 9, "a value is missing", "1000 Nm"),
            ("torque > 1e999 Nm", 10, "too large", "another"),
            ("5 Nm < torque", 1, "cannot start with a number", "speed > 500 rpm and"),
            ("efficiency > 95", 14, "percent", "`95 %`"),
            ("gear > first", 1, "has no order", "`==`"),
            ("(torque > 1 Nm", 15, "not closed", "`)`"),
            ("torque > 1 Nm)", 14, "unexpected `)`", "parenthesis"),
            ("torque > 1 Nm and", 18, "ends before", "comparison"),
            ("", 1, "ends before", "torque > 1000 Nm"),
            ("'T > 5", 1, "quotes", "after"),
        ] {
            let found = Condition::parse(text).unwrap_err();
            assert!(
                found.message.contains(message) && found.help.as_ref().unwrap().contains(help),
                "{text}: {found:?}"
            );
            assert_eq!(found.column, column, "{text}: {found:?}");
        }
        assert!(Condition::parse(&"(".repeat(1000)).is_err());
        assert!(Condition::parse(&"not ".repeat(100)).is_err());
        assert!(Condition::parse(&"x".repeat(3000)).is_err());
    }

    #[test]
    fn names_that_no_file_holds_find_their_neighbour() {
        for (text, column, message, help) in [
            ("torqe > 1 Nm", 1, "`torqe` is neither a measured quantity", "`torque`"),
            (
                "gear == first and use_for_tset == 1",
                19,
                "nor a column",
                "`use_for_test`",
            ),
            (
                "loss > 5 W",
                1,
                "the data do not contain `loss`",
                "columns: { loss: ... }",
            ),
            ("V_oil > 5", 9, "has no unit", "`5 ml`"),
            ("V_oil > 5 Nm", 9, "`Nm` is a torque, not a volume", "ml"),
            (
                "use_for_test > 5 Nm",
                16,
                "`Nm` is a torque, not a plain number",
                "only `%`",
            ),
            ("xyzxyz == 1", 1, "nor a column", "the columns are torque"),
        ] {
            let found = Condition::parse(text).unwrap().check(&measured()).unwrap_err();
            assert!(
                found.message.contains(message) && found.help.as_ref().unwrap().contains(help),
                "{text}: {found:?}"
            );
            assert_eq!(found.column, column, "{text}: {found:?}");
        }
    }
}
