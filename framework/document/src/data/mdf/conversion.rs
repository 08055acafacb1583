//! From the stored number of a channel to its value: the block `CC`.

use super::blocks::MdfFile;
use super::channel::Value;
use crate::data::MeasuredFault;

/// How values follow from stored numbers.
enum Rule {
    Same,
    /// Offset and factor.
    Linear([f64; 2]),
    /// (p1 x^2 + p2 x + p3) / (p4 x^2 + p5 x + p6).
    Rational([f64; 6]),
    /// Values at stored numbers: straight lines between them, or the nearest one.
    Table(Vec<(f64, f64)>, Between),
    /// Texts of stored numbers; other numbers remain.
    Texts(Vec<(f64, String)>),
}

#[derive(Clone, Copy, PartialEq)]
enum Between {
    Line,
    Nearest,
}

pub(super) struct Conversion {
    rule: Rule,
    pub unit: String,
}

impl Conversion {
    /// Reads a conversion; the inner error says why it is not read.
    pub(super) fn read(file: &MdfFile<'_>, at: u64) -> Result<Result<Self, &'static str>, MeasuredFault> {
        if at == 0 {
            return Ok(Ok(Self {
                rule: Rule::Same,
                unit: String::new(),
            }));
        }
        let block = file.block(at, *b"##CC")?;
        let unit = file.text(block.link(1))?;
        let count = usize::from(block.u16(6)?);
        // Each is in the block, so that a wrong count is an error of the file.
        let values = || {
            (0..count)
                .map(|i| block.f64(24 + 8 * i))
                .collect::<Result<Vec<f64>, _>>()
        };
        let rule = match block.u8(0)? {
            0 => Rule::Same,
            1 => match <[f64; 2]>::try_from(values()?) {
                Ok(linear) => Rule::Linear(linear),
                Err(_) => return Ok(Err("a linear conversion without two numbers")),
            },
            2 => match <[f64; 6]>::try_from(values()?) {
                Ok(rational) => Rule::Rational(rational),
                Err(_) => return Ok(Err("a rational conversion without six numbers")),
            },
            kind @ (4 | 5) => {
                let pairs = values()?
                    .chunks_exact(2)
                    .map(|pair| (pair[0], pair[1]))
                    .collect::<Vec<_>>();
                let rising = pairs.windows(2).all(|pair| pair[0].0 < pair[1].0);
                if pairs.is_empty() || !rising {
                    return Ok(Err("a conversion by a table that is empty or not sorted"));
                }
                Rule::Table(pairs, if kind == 4 { Between::Line } else { Between::Nearest })
            }
            7 => {
                let mut texts = Vec::new();
                for (i, value) in values()?.into_iter().enumerate() {
                    let link = block.link(4 + i);
                    if link != 0 && file.any(link)?.id != *b"##TX" {
                        return Ok(Err("a conversion by other conversions"));
                    }
                    texts.push((value, file.text(link)?));
                }
                texts.sort_by(|a, b| a.0.total_cmp(&b.0));
                Rule::Texts(texts)
            }
            3 => return Ok(Err("a conversion by a formula")),
            _ => return Ok(Err("a conversion by ranges or texts")),
        };
        Ok(Ok(Self { rule, unit }))
    }

    /// The value of a stored number.
    pub(super) fn value(&self, x: f64) -> Value {
        Value::Number(match &self.rule {
            Rule::Same => x,
            Rule::Linear([offset, factor]) => offset + factor * x,
            Rule::Rational([a, b, c, d, e, f]) => (a * x * x + b * x + c) / (d * x * x + e * x + f),
            Rule::Table(pairs, between) => in_table(pairs, *between, x),
            Rule::Texts(texts) => match texts.binary_search_by(|(value, _)| value.total_cmp(&x)) {
                Ok(place) => return Value::Text(texts[place].1.clone()),
                Err(_) => x,
            },
        })
    }
}

/// The value at the ends of a table is that of its end.
fn in_table(pairs: &[(f64, f64)], between: Between, x: f64) -> f64 {
    let after = pairs.partition_point(|(key, _)| *key < x);
    let (Some(low), Some(high)) = (after.checked_sub(1).and_then(|i| pairs.get(i)), pairs.get(after)) else {
        return if after == 0 {
            pairs[0].1
        } else {
            pairs[pairs.len() - 1].1
        };
    };
    let share = (x - low.0) / (high.0 - low.0);
    match between {
        Between::Line => low.1 + share * (high.1 - low.1),
        // The standard takes the lower key in the middle.
        Between::Nearest if share > 0.5 => high.1,
        Between::Nearest => low.1,
    }
}
