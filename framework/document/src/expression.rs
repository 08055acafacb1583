//! Expressions that users write: operands joined by operators, with prefixes and parentheses. A [`Grammar`] states the operators and
//! reads the operands, [`Scanner::expression`] does the rest.

use super::quantity::number_length;

/// An error in an expression.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("column {column}: {message}")]
pub struct ExpressionFault {
    /// Column, counted from one in characters.
    pub column: usize,
    /// Message.
    pub message: String,
    /// How to fix it.
    pub help: Option<String>,
}

impl ExpressionFault {
    /// An error at a column, without help.
    pub fn new(column: usize, message: impl Into<String>) -> Self {
        Self {
            column,
            message: message.into(),
            help: None,
        }
    }

    /// With the way to fix it.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// How operators of one precedence are grouped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Grouping {
    /// `a - b - c` is `(a - b) - c`.
    Left,
    /// `a ^ b ^ c` is `a ^ (b ^ c)`.
    Right,
    /// `a < b < c` is an error.
    Single,
}

/// Operators of one precedence. A symbol that starts with another one precedes it.
pub type Level<Operator> = (Grouping, &'static [(&'static str, Operator)]);

/// The operators of a kind of expressions, and its operands.
pub trait Grammar {
    /// An operator between two values.
    type Operator: Copy + 'static;
    /// What an expression is read into.
    type Value;

    /// Operators between two values, those with the lowest precedence first.
    const LEVELS: &'static [Level<Self::Operator>];
    /// Operators before a value, each with whether it negates.
    const PREFIXES: &'static [(&'static str, bool)];
    /// Index of the first level whose operators have a higher precedence than the prefixes.
    const ABOVE_PREFIXES: usize;
    /// Maximum nesting.
    const DEEPEST: usize;

    /// The error of deeper nesting.
    fn too_deep(column: usize) -> ExpressionFault;
    /// The error of a missing closing parenthesis.
    fn unclosed(column: usize) -> ExpressionFault;

    /// Reads a value without operators and parentheses around it.
    ///
    /// # Errors
    /// If there is none.
    fn operand(&mut self, scanner: &mut Scanner<'_>) -> Result<Self::Value, ExpressionFault>;
    /// The negation of the value that was read last.
    fn negate(&mut self, value: Self::Value) -> Self::Value;
    /// The result of an operator between the values that were read last.
    fn join(&mut self, operator: Self::Operator, left: Self::Value, right: Self::Value) -> Self::Value;
}

/// A position in the text of an expression.
#[derive(Debug)]
pub struct Scanner<'t> {
    text: &'t str,
    /// Bytes read.
    at: usize,
    nested: usize,
}

impl<'t> Scanner<'t> {
    /// At the start of a text.
    pub fn new(text: &'t str) -> Self {
        Self { text, at: 0, nested: 0 }
    }

    /// The text that was read.
    pub fn before(&self) -> &'t str {
        &self.text[..self.at]
    }

    /// The text that was not read yet.
    pub fn rest(&self) -> &'t str {
        &self.text[self.at..]
    }

    /// Column of the position, counted from one in characters.
    pub fn column(&self) -> usize {
        self.before().chars().count() + 1
    }

    /// An error at the position.
    pub fn fault(&self, message: impl Into<String>) -> ExpressionFault {
        ExpressionFault::new(self.column(), message)
    }

    /// Moves behind white space.
    pub fn skip_spaces(&mut self) {
        self.advance(self.rest().len() - self.rest().trim_start().len());
    }

    /// Moves by a number of bytes; the text in between.
    pub fn advance(&mut self, bytes: usize) -> &'t str {
        let passed = &self.rest()[..bytes];
        self.at += bytes;
        passed
    }

    /// Moves to the first character of a kind, or to the end; the text in between.
    pub fn advance_to(&mut self, is_end: impl Fn(char) -> bool) -> &'t str {
        self.advance(self.rest().find(is_end).unwrap_or(self.rest().len()))
    }

    /// Moves behind a symbol if it is next, possibly after white space, which is skipped anyway. Words must end where the symbol ends.
    pub fn take(&mut self, symbol: &str) -> bool {
        self.skip_spaces();
        let taken = self.is_at(symbol);
        self.at += if taken { symbol.len() } else { 0 };
        taken
    }

    /// Moves behind a decimal number if it is next; its digits.
    pub fn take_number(&mut self) -> Option<&'t str> {
        let length = number_length(self.rest());
        (length > 0).then(|| self.advance(length))
    }

    fn is_at(&self, symbol: &str) -> bool {
        let is_word = symbol.ends_with(char::is_alphabetic);
        let ends = |c: char| c.is_whitespace() || matches!(c, '(' | ')');
        self.rest()
            .strip_prefix(symbol)
            .is_some_and(|behind| !is_word || behind.chars().next().is_none_or(ends))
    }

    /// Reads an expression as long as possible.
    ///
    /// # Errors
    /// The first error.
    pub fn expression<G: Grammar>(&mut self, grammar: &mut G) -> Result<G::Value, ExpressionFault> {
        self.nested(grammar, 0)
    }

    fn nested<G: Grammar>(&mut self, grammar: &mut G, lowest: usize) -> Result<G::Value, ExpressionFault> {
        self.nested += 1;
        if self.nested > G::DEEPEST {
            return Err(G::too_deep(self.column()));
        }
        let value = self.joined(grammar, lowest)?;
        self.nested -= 1;
        Ok(value)
    }

    /// Values and the operators between them, from a level on.
    fn joined<G: Grammar>(&mut self, grammar: &mut G, lowest: usize) -> Result<G::Value, ExpressionFault> {
        let mut value = self.prefixed(grammar)?;
        let mut end = G::LEVELS.len();
        while let Some((level, operator)) = self.take_operator::<G>(lowest..end) {
            let grouping = G::LEVELS[level].0;
            let right = match grouping {
                Grouping::Right => self.nested(grammar, level)?,
                Grouping::Left | Grouping::Single => self.joined(grammar, level + 1)?,
            };
            value = grammar.join(operator, value, right);
            if grouping == Grouping::Single {
                end = level;
            }
        }
        Ok(value)
    }

    fn take_operator<G: Grammar>(&mut self, levels: std::ops::Range<usize>) -> Option<(usize, G::Operator)> {
        self.skip_spaces();
        for level in levels {
            let (_, operators) = G::LEVELS[level];
            if let Some((_, operator)) = operators.iter().find(|(symbol, _)| self.take(symbol)) {
                return Some((level, *operator));
            }
        }
        None
    }

    /// A value and the prefixes before it.
    fn prefixed<G: Grammar>(&mut self, grammar: &mut G) -> Result<G::Value, ExpressionFault> {
        let (mut is_prefixed, mut is_negated) = (false, false);
        while let Some((_, negates)) = G::PREFIXES.iter().find(|(symbol, _)| self.take(symbol)) {
            is_prefixed = true;
            is_negated ^= negates;
        }
        let value = if is_prefixed {
            self.joined(grammar, G::ABOVE_PREFIXES)?
        } else if self.take("(") {
            let value = self.expression(grammar)?;
            if !self.take(")") {
                return Err(G::unclosed(self.column()));
            }
            value
        } else {
            self.skip_spaces();
            grammar.operand(self)?
        };
        Ok(if is_negated { grammar.negate(value) } else { value })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Reads into text with all parentheses.
    struct Grouped;

    impl Grammar for Grouped {
        type Operator = &'static str;
        type Value = String;

        const LEVELS: &'static [Level<&'static str>] = &[
            (Grouping::Left, &[("or", "or")]),
            (Grouping::Single, &[("<=", "<="), ("<", "<")]),
            (Grouping::Left, &[("-", "-")]),
            (Grouping::Right, &[("^", "^")]),
        ];
        const PREFIXES: &'static [(&'static str, bool)] = &[("-", true), ("+", false)];
        const ABOVE_PREFIXES: usize = 3;
        const DEEPEST: usize = 20;

        fn too_deep(column: usize) -> ExpressionFault {
            ExpressionFault::new(column, "too deep")
        }

        fn unclosed(column: usize) -> ExpressionFault {
            ExpressionFault::new(column, "unclosed")
        }

        fn operand(&mut self, scanner: &mut Scanner<'_>) -> Result<String, ExpressionFault> {
            match scanner.advance_to(|c| !c.is_alphanumeric()) {
                "" => Err(scanner.fault("no operand").help("write one")),
                name => Ok(name.to_owned()),
            }
        }

        fn negate(&mut self, value: String) -> String {
            format!("-{value}")
        }

        fn join(&mut self, operator: &'static str, left: String, right: String) -> String {
            format!("({left}{operator}{right})")
        }
    }

    fn grouped(text: &str) -> Result<String, ExpressionFault> {
        let mut scanner = Scanner::new(text);
        let value = scanner.expression(&mut Grouped)?;
        Ok(format!("{value}{}", scanner.rest()))
    }

    #[test]
    fn precedence_and_grouping() {
        for (text, expected) in [
            ("a - b - c", "((a-b)-c)"),
            ("a ^ b ^ c", "(a^(b^c))"),
            ("-a ^ b", "-(a^b)"),
            ("a ^ -b ^ c - d", "((a^-(b^c))-d)"),
            ("a - --+-b", "(a--b)"),
            ("a < b - c or d <= e", "((a<(b-c))or(d<=e))"),
            ("(a or b) < c", "((aorb)<c)"),
            ("a or(b)", "(aorb)"),
            // One comparison, and words that only start like an operator.
            ("a < b < c", "(a<b)< c"),
            ("a orb", "aorb"),
        ] {
            assert_eq!(grouped(text).unwrap(), expected, "{text}");
        }
    }

    #[test]
    fn faults_have_their_column() {
        for (text, expected) in [
            ("", "column 1: no operand"),
            ("µ - ", "column 5: no operand"),
            ("(µ - b", "column 7: unclosed"),
            ("((((((((((((((((((((a", "column 21: too deep"),
            ("a^b^c^d^e^f^g^h^i^j^k^l^m^n^o^p^q^r^s^t^u", "column 41: too deep"),
        ] {
            assert_eq!(grouped(text).unwrap_err().to_string(), expected, "{text}");
        }
    }
}
