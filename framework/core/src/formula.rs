//! User-defined formulas: compiles text to a stack program.
//!
//! Powers bind tighter than a sign and are right-associative: `-2^2` is -4, `2^3^2` is 512. A comparison is 1 or 0; `if(c, a, b)`
//! is a if c is not 0.

use crate::document::did_you_mean;
use crate::document::expression::{ExpressionFault, Grammar, Grouping, Level, Scanner};
use crate::loss::Undefined;
use crate::real::{Mask as _, Points};

/// The deepest stack that a formula may need.
const DEEPEST: usize = 32;
/// That of most formulas.
const SHALLOW: usize = 4;

#[derive(Debug, Clone, Copy)]
enum Op {
    Number(f64),
    Input(u8),
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    /// A power with a constant exponent.
    PowerOf(f64),
    Less,
    Greater,
    LessEqual,
    GreaterEqual,
    Call1(Function1, bool),
    Least,
    Greatest,
    If,
}

/// Functions of one number: those of [`Real`], and others, which are called for each of several points.
#[derive(Debug, Clone, Copy)]
enum Function1 {
    Root,
    Exponential,
    Logarithm,
    Magnitude,
    Each(fn(f64) -> f64),
}

/// Functions of one number, with whether they have neither kinks nor jumps.
const ONE: [(&str, Function1, bool); 12] = [
    ("sqrt", Function1::Root, true),
    ("exp", Function1::Exponential, true),
    ("ln", Function1::Logarithm, true),
    ("log10", Function1::Each(f64::log10), true),
    ("abs", Function1::Magnitude, false),
    ("sin", Function1::Each(f64::sin), true),
    ("cos", Function1::Each(f64::cos), true),
    ("tan", Function1::Each(f64::tan), true),
    ("tanh", Function1::Each(f64::tanh), true),
    ("atan", Function1::Each(f64::atan), true),
    ("floor", Function1::Each(f64::floor), false),
    ("sign", Function1::Each(sign), false),
];

const TWO: [(&str, Op); 3] = [("min", Op::Least), ("max", Op::Greatest), ("pow", Op::Power)];

fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        0.0
    }
}

/// A power. A number that is not positive has those of [`f64::powf`]: whole ones if it is negative.
#[inline(always)]
fn power<R: Points>(x: R, exponent: R) -> R {
    let positive = x.is_above(R::ZERO);
    let power = (x.ln() * exponent).exp();
    if positive.all() {
        return power;
    }
    R::each(|point| {
        if positive.at_point(point) {
            power.at_point(point)
        } else {
            x.at_point(point).powf(exponent.at_point(point))
        }
    })
}

/// The same with an exponent that all points have in common; common ones are products, a root and a quotient.
#[inline(always)]
fn power_of<R: Points>(x: R, exponent: f64) -> R {
    if exponent == 2.0 {
        x * x
    } else if exponent == 3.0 {
        x * x * x
    } else if exponent == 0.5 {
        x.sqrt()
    } else if exponent == -1.0 {
        R::constant(1.0) / x
    } else {
        power(x, R::constant(exponent))
    }
}

/// A compiled formula.
#[derive(Debug, Clone)]
pub struct Formula {
    program: Vec<Op>,
    depth: usize,
}

impl Formula {
    /// Compiles a formula over named quantities.
    ///
    /// # Errors
    /// The column, the problem and its fix.
    pub fn compile(text: &str, names: &[&str]) -> Result<Self, ExpressionFault> {
        let mut scanner = Scanner::new(text);
        let mut compiler = Compiler {
            names,
            program: Vec::new(),
        };
        scanner.expression(&mut compiler)?;
        if !scanner.rest().is_empty() {
            return Err(scanner.fault(format!("unexpected `{}` after the formula", beginning(&scanner))));
        }
        let mut formula = Self {
            program: compiler.program,
            depth: 0,
        };
        formula.depth = formula.deepest();
        if formula.depth > DEEPEST {
            return Err(Compiler::too_deep(1));
        }
        Ok(formula)
    }

    /// True if the value has neither kinks nor jumps where it is defined.
    pub(crate) fn is_smooth(&self) -> bool {
        self.program.iter().all(|op| match op {
            Op::Less | Op::Greater | Op::LessEqual | Op::GreaterEqual | Op::Least | Op::Greatest | Op::If => false,
            Op::Call1(_, smooth) => *smooth,
            _ => true,
        })
    }

    /// True if the value may depend on a quantity, given by its position among the names.
    pub fn uses(&self, input: usize) -> bool {
        let is_it = |op: &Op| matches!(op, Op::Input(i) if usize::from(*i) == input);
        self.program.iter().any(is_it)
    }

    fn deepest(&self) -> usize {
        let (mut now, mut most) = (0_usize, 0);
        for op in &self.program {
            match op {
                Op::Number(_) | Op::Input(_) => now += 1,
                Op::Negate | Op::PowerOf(_) | Op::Call1(..) => {}
                Op::If => now -= 2,
                _ => now -= 1,
            }
            most = most.max(now);
        }
        most
    }

    /// The value at the named quantities, each by its position among the names.
    ///
    /// # Errors
    /// If the value is not a finite number.
    pub fn value(&self, input: impl Fn(usize) -> f64) -> Result<f64, Undefined> {
        let value = self.evaluate(input);
        if value.is_finite() {
            Ok(value)
        } else {
            Err(Undefined {
                what: "value of the formula",
                value,
            })
        }
    }

    /// The value at one point or at several, from that of each quantity by its position among the names; where it is undefined, it is
    /// not a finite number. Some powers have no derivatives.
    #[inline(always)]
    pub fn evaluate<R: Points>(&self, input: impl Fn(usize) -> R) -> R {
        // Zeroing a stack that is not needed costs time.
        if self.depth <= SHALLOW {
            self.evaluate_within::<R, SHALLOW>(input)
        } else {
            self.evaluate_within::<R, DEEPEST>(input)
        }
    }

    /// The same with a stack that is as deep as necessary.
    #[inline(always)]
    fn evaluate_within<R: Points, const DEPTH: usize>(&self, input: impl Fn(usize) -> R) -> R {
        let mut stack = [R::ZERO; DEPTH];
        let mut top = 0;
        for op in &self.program {
            match *op {
                Op::Number(x) => {
                    stack[top] = R::constant(x);
                    top += 1;
                }
                Op::Input(i) => {
                    stack[top] = input(usize::from(i));
                    top += 1;
                }
                Op::Negate => stack[top - 1] = -stack[top - 1],
                Op::PowerOf(exponent) => stack[top - 1] = power_of(stack[top - 1], exponent),
                Op::Call1(function, _) => {
                    let x = stack[top - 1];
                    stack[top - 1] = match function {
                        Function1::Root => x.sqrt(),
                        Function1::Exponential => x.exp(),
                        Function1::Logarithm => x.ln(),
                        Function1::Magnitude => x.abs(),
                        Function1::Each(f) => x.lift(f),
                    };
                }
                Op::If => {
                    top -= 2;
                    stack[top - 1] = R::select(stack[top - 1].is_zero(), stack[top + 1], stack[top]);
                }
                two => {
                    top -= 1;
                    let (a, b) = (stack[top - 1], stack[top]);
                    let one_where = |holds| R::select(holds, R::constant(1.0), R::ZERO);
                    stack[top - 1] = match two {
                        Op::Add => a + b,
                        Op::Subtract => a - b,
                        Op::Multiply => a * b,
                        Op::Divide => a / b,
                        Op::Power => power(a, b),
                        // The other one if one is not a number.
                        Op::Least => R::select(a.is_equal(a), a.min(b), b),
                        Op::Greatest => R::select(a.is_equal(a), a.max(b), b),
                        Op::Less => one_where(a.is_below(b)),
                        Op::Greater => one_where(a.is_above(b)),
                        Op::LessEqual => one_where(a.is_below(b) | a.is_equal(b)),
                        Op::GreaterEqual => one_where(a.is_above(b) | a.is_equal(b)),
                        _ => a,
                    };
                }
            }
        }
        stack[0]
    }
}

/// The grammar of formulas, which writes the program in the order of its evaluation.
struct Compiler<'a> {
    names: &'a [&'a str],
    program: Vec<Op>,
}

impl Grammar for Compiler<'_> {
    type Operator = Op;
    type Value = ();

    const LEVELS: &'static [Level<Op>] = &[
        (
            Grouping::Single,
            &[
                ("<=", Op::LessEqual),
                (">=", Op::GreaterEqual),
                ("<", Op::Less),
                (">", Op::Greater),
            ],
        ),
        (Grouping::Left, &[("+", Op::Add), ("-", Op::Subtract)]),
        (Grouping::Left, &[("*", Op::Multiply), ("/", Op::Divide)]),
        (Grouping::Right, &[("^", Op::Power)]),
    ];
    const PREFIXES: &'static [(&'static str, bool)] = &[("-", true), ("+", false)];
    const ABOVE_PREFIXES: usize = 3;
    const DEEPEST: usize = DEEPEST;

    fn too_deep(column: usize) -> ExpressionFault {
        ExpressionFault::new(column, "nested too deeply").help("split the formula")
    }

    fn unclosed(column: usize) -> ExpressionFault {
        ExpressionFault::new(column, "a `)` is missing")
    }

    fn operand(&mut self, scanner: &mut Scanner<'_>) -> Result<(), ExpressionFault> {
        let column = scanner.column();
        if let Some(number) = scanner.take_number() {
            self.program.push(Op::Number(number.parse().unwrap_or(f64::NAN)));
            return Ok(());
        }
        // Paths are names with dots.
        let name = scanner.advance_to(|c| !(c.is_ascii_alphanumeric() || c == '_' || c == '.'));
        if name.is_empty() {
            return Err(if scanner.rest().is_empty() {
                scanner.fault("the formula ends too early")
            } else if scanner.before().ends_with('*') && scanner.rest().starts_with('*') {
                ExpressionFault::new(column - 1, "`**` is not a power").help("write `^`")
            } else {
                scanner.fault(format!("`{}` is not a value", beginning(scanner)))
            });
        }
        if scanner.take("(") {
            return self.call(scanner, name, column);
        }
        let op = if let Some(i) = self.names.iter().position(|n| *n == name) {
            Op::Input(i as u8)
        } else if name == "pi" {
            Op::Number(std::f64::consts::PI)
        } else {
            return Err(ExpressionFault {
                help: did_you_mean(name, self.names.iter().copied()).map(|close| format!("write `{close}`")),
                ..ExpressionFault::new(column, format!("unknown quantity `{name}`"))
            });
        };
        self.program.push(op);
        Ok(())
    }

    fn negate(&mut self, (): ()) {
        match self.program.last_mut() {
            // An operand whose program ends in a number is that number.
            Some(Op::Number(number)) => *number = -*number,
            _ => self.program.push(Op::Negate),
        }
    }

    /// Powers with constant exponents are known before the formula is evaluated.
    fn join(&mut self, op: Op, (): (), (): ()) {
        match (op, &self.program[..]) {
            (Op::Power, [.., Op::Number(x), Op::Number(exponent)]) => {
                let power = x.powf(*exponent);
                self.program.truncate(self.program.len() - 2);
                self.program.push(Op::Number(power));
            }
            (Op::Power, [.., Op::Number(exponent)]) => {
                let exponent = *exponent;
                self.program.pop();
                self.program.push(Op::PowerOf(exponent));
            }
            _ => self.program.push(op),
        }
    }
}

impl Compiler<'_> {
    /// Reads the arguments of a function, whose name is at a column.
    fn call(&mut self, scanner: &mut Scanner<'_>, name: &str, column: usize) -> Result<(), ExpressionFault> {
        let (count, op) = if let Some((_, function, smooth)) = ONE.iter().find(|(n, ..)| *n == name) {
            (1, Op::Call1(*function, *smooth))
        } else if let Some((_, op)) = TWO.iter().find(|(n, _)| *n == name) {
            (2, *op)
        } else if name == "if" {
            (3, Op::If)
        } else {
            let known = ONE
                .iter()
                .map(|(n, ..)| *n)
                .chain(TWO.iter().map(|(n, _)| *n))
                .chain(["if"]);
            let help = match did_you_mean(name, known.clone()) {
                Some(close) => format!("write `{close}(`"),
                None => format!("functions: {}", known.collect::<Vec<_>>().join(", ")),
            };
            return Err(ExpressionFault::new(column, format!("unknown function `{name}`")).help(help));
        };
        for i in 0..count {
            scanner.expression(self)?;
            let more = i + 1 < count;
            if !scanner.take(if more { "," } else { ")" }) {
                let plural = if count == 1 { "" } else { "s" };
                return Err(scanner.fault(format!("`{name}` takes {count} argument{plural}")));
            }
        }
        self.join(op, (), ());
        Ok(())
    }
}

/// The next characters, for messages.
fn beginning(scanner: &Scanner<'_>) -> String {
    scanner.rest().chars().take(12).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::real::Lane;
    use proptest::prelude::*;

    fn value(text: &str) -> f64 {
        Formula::compile(text, &["speed", "nu"])
            .unwrap()
            .value(|input| [3.0, 10.0][input])
            .unwrap()
    }

    #[test]
    fn engineers_arithmetic() {
        for (text, expected) in [
            ("-2^2", -4.0),
            ("2^3^2", 512.0),
            ("2^-1", 0.5),
            ("1e-3 * 2", 2e-3),
            ("10 - 4 - 3", 3.0),
            ("8 / 4 / 2", 1.0),
            ("speed * nu + 1", 31.0),
            ("if(speed > 2, 1, 0)", 1.0),
            ("max(1, min(5, nu))", 5.0),
            ("log10(1000) + ln(exp(2))", 5.0),
            ("--3", 3.0),
            ("2 * (1 + pi/pi)", 4.0),
        ] {
            assert!((value(text) - expected).abs() < 1e-12, "{text}: {}", value(text));
        }
    }

    #[test]
    fn constant_exponents_are_known_before_evaluation() {
        for (text, known) in [
            ("speed^-1", -1.0_f64),
            ("pow(speed, -0.25)", -0.25),
            ("speed^2^-1", 0.5),
        ] {
            let formula = Formula::compile(text, &["speed"]).unwrap();
            let found = match formula.program[..] {
                [Op::Input(0), Op::PowerOf(exponent)] => exponent,
                _ => f64::NAN,
            };
            assert_eq!(found.to_bits(), known.to_bits(), "{text}: {:?}", formula.program);
        }
        assert_eq!(value("speed^-1").to_bits(), (1.0 / 3.0_f64).to_bits());
    }

    #[test]
    fn faults_have_a_column_and_a_way_out() {
        let fault = |text: &str| Formula::compile(text, &["speed", "nu"]).unwrap_err();
        assert_eq!(
            (fault("1 + sped").column, fault("1 + sped").help.unwrap()),
            (5, "write `speed`".to_owned())
        );
        assert_eq!(fault("2 ** 3").help.unwrap(), "write `^`");
        assert!(fault("sqr(2)").help.unwrap().contains("sqrt"));
        assert!(fault("(1 + 2").message.contains("missing"));
        assert!(fault("1 2").message.contains("unexpected"));
        assert!(fault("").message.contains("too early"));
        assert!(fault(&"(".repeat(5000)).message.contains("deeply"));
    }

    #[test]
    fn what_has_no_value_is_undefined() {
        for text in ["ln(0)", "sqrt(-1)", "1/0", "(-1)^0.5"] {
            assert!(Formula::compile(text, &[]).unwrap().value(|_| 0.0).is_err(), "{text}");
        }
    }

    #[test]
    fn several_points_together_have_the_bits_of_each_alone() {
        for text in [
            "-2^speed + nu / 3 * speed - 1",
            "if(speed > 0, sqrt(nu), abs(speed))",
            "(speed <= 0) + (speed >= 0) + (nu < 10) + sign(speed)",
            "max(speed, min(nu, 3)) + floor(nu) + pow(nu, 0.3) + tanh(speed)",
        ] {
            let formula = Formula::compile(text, &["speed", "nu"]).unwrap();
            let inputs = |point: usize| [point as f64 - 7.0, 1.5 * point as f64];
            let all: Lane = formula.evaluate(|input| Lane::each(|point| inputs(point)[input]));
            for point in 0..Lane::COUNT {
                let alone: f64 = formula.evaluate(|input| inputs(point)[input]);
                assert_eq!(all[point].to_bits(), alone.to_bits(), "{text} at point {point}");
            }
        }
    }

    #[test]
    fn kinks_and_jumps_are_known() {
        let smooth = |text: &str| Formula::compile(text, &["speed"]).unwrap().is_smooth();
        assert!(smooth("0.05 + 0.1 * exp(-speed / 3) + sqrt(speed)^1.5 + pow(speed, 2)"));
        for text in [
            "abs(speed)",
            "max(speed, 1)",
            "min(1, speed)",
            "speed > 1",
            "if(1, 2, 3)",
            "floor(speed)",
        ] {
            assert!(!smooth(text), "{text}");
        }
    }

    proptest! {
        #[test]
        fn no_text_makes_it_panic(text in "[-+*/^()<>=,. 0-9a-z]{0,40}") {
            if let Ok(formula) = Formula::compile(&text, &["a", "b"]) {
                let _ = formula.value(|input| [1.0, 2.0][input]);
            }
        }
    }
}
