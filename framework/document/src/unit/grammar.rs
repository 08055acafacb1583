//! The units that users write: products, quotients and powers of the symbols below, in the spellings that are in use.
//!
//! A spelling is first brought into one form: `·` between factors, no spaces beside signs, `2` for `²` and `^2`, `u` for `µ`, `deg` for `°`.
//! The same grammar gives the regular expressions of the published schemas.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::sync::LazyLock;

use super::{Conversion, Dimension, UNITS};

/// A symbol of a unit, its SI value in two factors, so that powers of ten are exact, and whether SI prefixes may precede it.
struct Symbol {
    text: &'static str,
    number: f64,
    exponent: i32,
    prefixed: bool,
}

/// Without SI prefixes.
const fn bare(text: &'static str, number: f64) -> Symbol {
    Symbol {
        text,
        number,
        exponent: 0,
        prefixed: false,
    }
}

/// With SI prefixes.
const fn si(text: &'static str, exponent: i32) -> Symbol {
    Symbol {
        text,
        number: 1.0,
        exponent,
        prefixed: true,
    }
}

const PREFIXES: [(&str, i32); 12] = [
    ("da", 1),
    ("p", -12),
    ("n", -9),
    ("u", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

type Symbols = &'static [Symbol];

const POUND: f64 = 0.45359237;
const POUND_FORCE: f64 = 4.4482216152605;
const INCH: f64 = 0.0254;
const FOOT: f64 = 0.3048;
/// US gallon: 231 cubic inches.
const GALLON: f64 = 3.785411784e-3;
const PSI: f64 = POUND_FORCE / (INCH * INCH);
/// British thermal unit of the International Table.
const BTU: f64 = 1055.05585262;
/// 550 ft lbf/s.
const HORSEPOWER: f64 = 745.6998715822702;

const LENGTH: Symbols = &[
    si("m", 0),
    bare("in", INCH),
    bare("uin", INCH * 1e-6),
    bare("ft", FOOT),
    bare("yd", 0.9144),
    bare("mi", 1609.344),
    bare("mil", INCH * 1e-3),
    bare("micron", 1e-6),
];
const VOLUME: Symbols = &[
    si("l", -3),
    si("L", -3),
    bare("cc", 1e-6),
    bare("gal", GALLON),
    bare("qt", GALLON / 4.0),
];
/// No other prefixes: `Grad` means degrees.
const ANGLE: Symbols = &[
    bare("rad", 1.0),
    bare("mrad", 1e-3),
    bare("urad", 1e-6),
    bare("deg", PI / 180.0),
    bare("gon", PI / 200.0),
    bare("arcmin", PI / 10800.0),
    bare("arcsec", PI / 648000.0),
];
/// Turns in a time.
const TURNS: Symbols = &[
    bare("rpm", PI / 30.0),
    bare("RPM", PI / 30.0),
    bare("krpm", 1e3 * (PI / 30.0)),
    bare("kRPM", 1e3 * (PI / 30.0)),
    bare("1/min", PI / 30.0),
    bare("/min", PI / 30.0),
    bare("min-1", PI / 30.0),
    bare("U/min", PI / 30.0),
    bare("Upm", PI / 30.0),
    bare("r/min", PI / 30.0),
    bare("rev/min", PI / 30.0),
    bare("tr/min", PI / 30.0),
    bare("rps", 2.0 * PI),
    bare("r/s", 2.0 * PI),
    bare("rev/s", 2.0 * PI),
    bare("U/s", 2.0 * PI),
    Symbol {
        text: "Hz",
        number: 2.0 * PI,
        exponent: 0,
        prefixed: true,
    },
];
const SPEED: Symbols = &[
    bare("mph", 0.44704),
    bare("kph", 1.0 / 3.6),
    bare("kmh", 1.0 / 3.6),
    bare("kn", 1852.0 / 3600.0),
    bare("knot", 1852.0 / 3600.0),
    bare("knots", 1852.0 / 3600.0),
];
const FORCE: Symbols = &[
    si("N", 0),
    bare("lbf", POUND_FORCE),
    bare("kgf", 9.80665),
    bare("kp", 9.80665),
];
/// Beside a length, a pound is a force.
const US_FORCE: Symbols = &[
    bare("lbf", POUND_FORCE),
    bare("lb", POUND_FORCE),
    bare("lbs", POUND_FORCE),
];
const US_LENGTH: Symbols = &[bare("ft", FOOT), bare("in", INCH)];
const MASS: Symbols = &[
    si("g", -3),
    bare("t", 1e3),
    bare("lb", POUND),
    bare("lbs", POUND),
    bare("lbm", POUND),
];
const TIME: Symbols = &[
    si("s", 0),
    bare("sec", 1.0),
    bare("min", 60.0),
    bare("h", 3600.0),
    bare("hr", 3600.0),
];
const POWER: Symbols = &[
    si("W", 0),
    bare("hp", HORSEPOWER),
    bare("HP", HORSEPOWER),
    bare("PS", 735.49875),
];
const ENERGY: Symbols = &[si("J", 0), bare("BTU", BTU), bare("Btu", BTU)];
const PRESSURE: Symbols = &[
    si("Pa", 0),
    si("bar", 5),
    bare("psi", PSI),
    bare("PSI", PSI),
    bare("ksi", 1e3 * PSI),
    bare("atm", 101325.0),
];
/// A difference of temperatures in a compound. No prefixes: `W/mK` is per metre and kelvin.
const DIFFERENCE: Symbols = &[bare("K", 1.0), bare("degC", 1.0), bare("degF", 5.0 / 9.0)];
const KINEMATIC: Symbols = &[si("St", -4)];
const DYNAMIC: Symbols = &[
    si("P", -1),
    Symbol {
        text: "reyn",
        number: PSI,
        exponent: 0,
        prefixed: true,
    },
];
const FLOW: Symbols = &[
    bare("gpm", GALLON / 60.0),
    bare("lpm", 1e-3 / 60.0),
    bare("LPM", 1e-3 / 60.0),
];
const VOLTAGE: Symbols = &[si("V", 0)];
const CURRENT: Symbols = &[si("A", 0)];
const OHM: Symbols = &[si("ohm", 0), si("Ohm", 0), si("Ω", 0)];
const PERCENT: Symbols = &[bare("%", 0.01)];
const MILLIKELVIN: Symbols = &[bare("mK", 1e-3)];
const PER_KELVIN: Symbols = &[bare("ppm/K", 1e-6)];

/// A part of a compound.
enum Part {
    /// One of several symbols, in this power.
    Of(Symbols, i32),
    /// This text.
    Text(&'static str),
    /// A sign of multiplication, which may be omitted.
    Times,
}
use Part::{Of, Text, Times};

/// What is read, by dimension.
const COMPOUNDS: &[(Dimension, &[Part])] = &[
    (Dimension::None, &[Of(PERCENT, 1)]),
    (Dimension::Percent, &[Text("%")]),
    (Dimension::Length, &[Of(LENGTH, 1)]),
    (Dimension::Area, &[Of(LENGTH, 2), Text("2")]),
    (Dimension::Volume, &[Of(VOLUME, 1)]),
    (Dimension::Volume, &[Of(LENGTH, 3), Text("3")]),
    (Dimension::Angle, &[Of(ANGLE, 1)]),
    (Dimension::AngularSpeed, &[Of(TURNS, 1)]),
    (Dimension::AngularSpeed, &[Of(ANGLE, 1), Text("/"), Of(TIME, -1)]),
    (Dimension::Speed, &[Of(LENGTH, 1), Text("/"), Of(TIME, -1)]),
    (Dimension::Speed, &[Of(SPEED, 1)]),
    (Dimension::Torque, &[Of(FORCE, 1), Times, Of(LENGTH, 1)]),
    (Dimension::Torque, &[Of(US_FORCE, 1), Text("·"), Of(US_LENGTH, 1)]),
    (Dimension::Torque, &[Of(US_LENGTH, 1), Text("·"), Of(US_FORCE, 1)]),
    (Dimension::Force, &[Of(FORCE, 1)]),
    (Dimension::LineLoad, &[Of(FORCE, 1), Text("/"), Of(LENGTH, -1)]),
    (
        Dimension::AngularStiffness,
        &[Of(FORCE, 1), Times, Of(LENGTH, 1), Text("/"), Of(ANGLE, -1)],
    ),
    (
        Dimension::AngularStiffness,
        &[Of(US_FORCE, 1), Text("·"), Of(US_LENGTH, 1), Text("/"), Of(ANGLE, -1)],
    ),
    (
        Dimension::AngularStiffness,
        &[Of(US_LENGTH, 1), Text("·"), Of(US_FORCE, 1), Text("/"), Of(ANGLE, -1)],
    ),
    (Dimension::Power, &[Of(POWER, 1)]),
    (Dimension::Power, &[Of(ENERGY, 1), Text("/"), Of(TIME, -1)]),
    (
        Dimension::Power,
        &[Of(FORCE, 1), Times, Of(LENGTH, 1), Text("/"), Of(TIME, -1)],
    ),
    (
        Dimension::Power,
        &[Of(US_LENGTH, 1), Text("·"), Of(US_FORCE, 1), Text("/"), Of(TIME, -1)],
    ),
    (Dimension::Energy, &[Of(ENERGY, 1)]),
    (Dimension::Energy, &[Of(POWER, 1), Times, Of(TIME, 1)]),
    (Dimension::Mass, &[Of(MASS, 1)]),
    (Dimension::Inertia, &[Of(MASS, 1), Times, Of(LENGTH, 2), Text("2")]),
    (Dimension::Density, &[Of(MASS, 1), Text("/"), Of(VOLUME, -1)]),
    (Dimension::Density, &[Of(MASS, 1), Text("/"), Of(LENGTH, -3), Text("3")]),
    (Dimension::KinematicViscosity, &[Of(KINEMATIC, 1)]),
    (
        Dimension::KinematicViscosity,
        &[Of(LENGTH, 2), Text("2/"), Of(TIME, -1)],
    ),
    (Dimension::DynamicViscosity, &[Of(PRESSURE, 1), Times, Of(TIME, 1)]),
    (
        Dimension::DynamicViscosity,
        &[Of(FORCE, 1), Times, Of(TIME, 1), Text("/"), Of(LENGTH, -2), Text("2")],
    ),
    (Dimension::DynamicViscosity, &[Of(DYNAMIC, 1)]),
    (Dimension::TemperatureDifference, &[Of(MILLIKELVIN, 1)]),
    (Dimension::Expansion, &[Text("1/"), Of(DIFFERENCE, -1)]),
    (Dimension::Expansion, &[Of(PER_KELVIN, 1)]),
    (
        Dimension::Expansion,
        &[
            Of(LENGTH, 1),
            Text("/("),
            Of(LENGTH, -1),
            Times,
            Of(DIFFERENCE, -1),
            Text(")"),
        ],
    ),
    (Dimension::Pressure, &[Of(PRESSURE, 1)]),
    (
        Dimension::Pressure,
        &[Of(FORCE, 1), Text("/"), Of(LENGTH, -2), Text("2")],
    ),
    (Dimension::PressureCoefficient, &[Text("1/"), Of(PRESSURE, -1)]),
    (
        Dimension::PressureCoefficient,
        &[Of(LENGTH, 2), Text("2/"), Of(FORCE, -1)],
    ),
    (Dimension::Time, &[Of(TIME, 1)]),
    (
        Dimension::Acceleration,
        &[Of(LENGTH, 1), Text("/"), Of(TIME, -2), Text("2")],
    ),
    (
        Dimension::AngularAcceleration,
        &[Of(ANGLE, 1), Text("/"), Of(TIME, -2), Text("2")],
    ),
    (Dimension::AngularAcceleration, &[Of(TURNS, 1), Text("/"), Of(TIME, -1)]),
    (
        Dimension::SpeedResistance,
        &[Of(FORCE, 1), Times, Of(TIME, 1), Text("/"), Of(LENGTH, -1)],
    ),
    (
        Dimension::SpeedResistance,
        &[
            Of(FORCE, 1),
            Text("/("),
            Of(LENGTH, -1),
            Text("/"),
            Of(TIME, 1),
            Text(")"),
        ],
    ),
    (Dimension::SpeedResistance, &[Of(FORCE, 1), Text("/"), Of(SPEED, -1)]),
    (
        Dimension::SquareResistance,
        &[Of(FORCE, 1), Times, Of(TIME, 2), Text("2/"), Of(LENGTH, -2), Text("2")],
    ),
    (
        Dimension::SquareResistance,
        &[
            Of(FORCE, 1),
            Text("/("),
            Of(LENGTH, -2),
            Text("/"),
            Of(TIME, 2),
            Text(")2"),
        ],
    ),
    (
        Dimension::SquareResistance,
        &[Of(FORCE, 1), Text("/"), Of(SPEED, -2), Text("2")],
    ),
    (Dimension::Flow, &[Of(VOLUME, 1), Text("/"), Of(TIME, -1)]),
    (Dimension::Flow, &[Of(LENGTH, 3), Text("3/"), Of(TIME, -1)]),
    (Dimension::Flow, &[Of(FLOW, 1)]),
    (Dimension::MassFlow, &[Of(MASS, 1), Text("/"), Of(TIME, -1)]),
    (
        Dimension::HeatTransfer,
        &[
            Of(POWER, 1),
            Text("/("),
            Of(LENGTH, -2),
            Text("2"),
            Times,
            Of(DIFFERENCE, -1),
            Text(")"),
        ],
    ),
    (
        Dimension::HeatTransfer,
        &[
            Of(POWER, 1),
            Text("/"),
            Of(LENGTH, -2),
            Text("2"),
            Times,
            Of(DIFFERENCE, -1),
        ],
    ),
    (
        Dimension::HeatTransfer,
        &[
            Of(ENERGY, 1),
            Text("/("),
            Of(TIME, -1),
            Text("·"),
            Of(LENGTH, -2),
            Text("2·"),
            Of(DIFFERENCE, -1),
            Text(")"),
        ],
    ),
    (Dimension::Conductance, &[Of(POWER, 1), Text("/"), Of(DIFFERENCE, -1)]),
    (
        Dimension::Conductance,
        &[
            Of(ENERGY, 1),
            Text("/("),
            Of(TIME, -1),
            Text("·"),
            Of(DIFFERENCE, -1),
            Text(")"),
        ],
    ),
    (Dimension::Resistance, &[Of(DIFFERENCE, 1), Text("/"), Of(POWER, -1)]),
    (
        Dimension::Conductivity,
        &[
            Of(POWER, 1),
            Text("/("),
            Of(LENGTH, -1),
            Times,
            Of(DIFFERENCE, -1),
            Text(")"),
        ],
    ),
    (
        Dimension::Conductivity,
        &[Of(POWER, 1), Text("/"), Of(LENGTH, -1), Times, Of(DIFFERENCE, -1)],
    ),
    (
        Dimension::Conductivity,
        &[
            Of(ENERGY, 1),
            Text("/("),
            Of(TIME, -1),
            Text("·"),
            Of(LENGTH, -1),
            Text("·"),
            Of(DIFFERENCE, -1),
            Text(")"),
        ],
    ),
    (Dimension::HeatCapacity, &[Of(ENERGY, 1), Text("/"), Of(DIFFERENCE, -1)]),
    (
        Dimension::SpecificHeat,
        &[
            Of(ENERGY, 1),
            Text("/("),
            Of(MASS, -1),
            Times,
            Of(DIFFERENCE, -1),
            Text(")"),
        ],
    ),
    (
        Dimension::SpecificHeat,
        &[Of(ENERGY, 1), Text("/"), Of(MASS, -1), Times, Of(DIFFERENCE, -1)],
    ),
    (Dimension::Voltage, &[Of(VOLTAGE, 1)]),
    (Dimension::Current, &[Of(CURRENT, 1)]),
    (Dimension::ElectricResistance, &[Of(OHM, 1)]),
    (Dimension::Charge, &[Of(CURRENT, 1), Times, Of(TIME, 1)]),
];

/// Other spellings of usual units with an offset, which take part in no compound.
const TEMPERATURES: [(&str, &str); 2] = [("C", "degC"), ("F", "degF")];

/// Why a spelling is read as no unit although it is one to somebody, in the form of [`normalised`].
const REFUSED: &[(&str, &str)] = &[
    (
        "1/s",
        "`1/s` may mean turns or radians per second: write `Hz` for turns, `rad/s` for radians",
    ),
    (
        "/s",
        "turns or radians per second? Write `Hz` for turns, `rad/s` for radians",
    ),
    (
        "s-1",
        "`s-1` may mean turns or radians per second: write `Hz` for turns, `rad/s` for radians",
    ),
    ("Grad", "`Grad` is `deg` in German and `gon` elsewhere"),
    ("grad", "`grad` is `gon` in English and `deg` in German"),
    ("SUS", SAYBOLT),
    ("SSU", SAYBOLT),
    ("SUV", SAYBOLT),
    ("SFS", SAYBOLT),
    (
        "degE",
        "degrees Engler are not proportional to viscosity: take mm2/s from the oil's data sheet",
    ),
    ("ton", "a ton is metric (`t`), short (2000 lb) or long (2240 lb)"),
    ("tons", "a ton is metric (`t`), short (2000 lb) or long (2240 lb)"),
    ("cps", "`cps` may mean centipoise (`cP`) or cycles per second (`Hz`)"),
];

const SAYBOLT: &str = "Saybolt seconds are not proportional to viscosity: convert them by the tables of ASTM D2161, or take mm2/s from the \
                       oil's data sheet";

/// Why a unit is refused, if there is more to say than that it is unknown or of another dimension.
pub(super) fn why_refused(text: &str, dimension: Dimension) -> Option<&'static str> {
    let text = normalised(text);
    if dimension == Dimension::Force && ["lb", "lbs"].contains(&text.as_str()) {
        return Some("a pound is a mass, and its weight is `lbf`");
    }
    let refused = REFUSED.iter().find(|(symbol, _)| *symbol == text);
    refused.map(|(_, why)| *why)
}

/// The usual units in the form of [`normalised`], which keep their factors.
static USUAL: LazyLock<Vec<(String, Conversion)>> = LazyLock::new(|| {
    let usual = UNITS.iter().filter(|unit| unit.dimension != Dimension::None);
    let usual = usual.map(|unit| (normalised(unit.symbol), unit.conversion()));
    let other = TEMPERATURES.iter().filter_map(|(other, symbol)| {
        let unit = UNITS.iter().find(|unit| unit.symbol == *symbol)?;
        Some(((*other).to_owned(), unit.conversion()))
    });
    usual.chain(other).collect()
});

/// A unit of a dimension, or of the first dimension that has it.
pub(super) fn read(text: &str, dimension: Option<Dimension>) -> Option<Conversion> {
    let text = normalised(text);
    if REFUSED.iter().any(|(refused, _)| *refused == text) {
        return None;
    }
    let is_wanted = |given: Dimension| dimension.is_none_or(|wanted| wanted == given);
    let usual = USUAL
        .iter()
        .find(|(symbol, unit)| is_wanted(unit.dimension) && *symbol == text);
    if let Some((_, unit)) = usual {
        return Some(*unit);
    }
    let compounds = COMPOUNDS.iter().filter(|(of_compound, _)| is_wanted(*of_compound));
    compounds.into_iter().find_map(|(dimension, parts)| {
        let (number, exponent) = matched(&text, parts)?;
        Some(Conversion {
            dimension: *dimension,
            factor: scaled(number, exponent),
            offset: 0.0,
        })
    })
}

/// A number with a power of ten, correctly rounded.
fn scaled(number: f64, exponent: i32) -> f64 {
    format!("{number}e{exponent}").parse().unwrap_or(f64::NAN)
}

/// The factor of a text that consists of these parts, as a number and a power of ten.
fn matched(text: &str, parts: &[Part]) -> Option<(f64, i32)> {
    let Some((first, rest)) = parts.split_first() else {
        return text.is_empty().then_some((1.0, 0));
    };
    match first {
        Text(fixed) => matched(text.strip_prefix(fixed)?, rest),
        Times => matched(text.strip_prefix('·').unwrap_or(text), rest),
        Of(symbols, power) => {
            let with = |behind: &str, symbol: &Symbol, prefix: i32| {
                let (number, exponent) = matched(behind, rest)?;
                let power_of_ten = (symbol.exponent + prefix) * power;
                Some((number * symbol.number.powi(*power), exponent + power_of_ten))
            };
            symbols.iter().find_map(|symbol| {
                let bare = text
                    .strip_prefix(symbol.text)
                    .and_then(|behind| with(behind, symbol, 0));
                let prefixed = || {
                    let prefixes = PREFIXES.iter().filter(|_| symbol.prefixed);
                    prefixes.into_iter().find_map(|(prefix, exponent)| {
                        let behind = text.strip_prefix(prefix)?.strip_prefix(symbol.text)?;
                        with(behind, symbol, *exponent)
                    })
                };
                bare.or_else(prefixed)
            })
        }
    }
}

/// The one form of the spellings of a unit.
fn normalised(text: &str) -> String {
    let mut plain: Vec<char> = Vec::with_capacity(text.len());
    for c in text.trim().chars() {
        match c {
            'µ' | 'μ' => plain.push('u'),
            '°' => plain.extend("deg".chars()),
            '¹' => plain.push('1'),
            '²' => plain.push('2'),
            '³' => plain.push('3'),
            '−' => plain.push('⁻'),
            '⋅' | '∙' | '×' | '*' => plain.push('·'),
            _ if c.is_whitespace() => plain.push(' '),
            _ => plain.push(c),
        }
    }
    let mut text = String::with_capacity(plain.len());
    for (i, c) in plain.iter().enumerate() {
        let before = text.chars().next_back();
        let behind = plain[i + 1..].iter().find(|c| **c != ' ').copied();
        let next = plain.get(i + 1).copied();
        match c {
            ' ' if matches!(before, Some('/' | '(' | '·')) || matches!(behind, Some('/' | ')' | '·')) => {}
            ' ' => text.push('·'),
            '^' if before.is_some_and(|c| c.is_ascii_alphanumeric() || c == ')')
                && plain[i + 1..]
                    .iter()
                    .find(|c| !matches!(c, '-' | '⁻'))
                    .is_some_and(char::is_ascii_digit)
                && !matches!(plain[i + 1..], ['-' | '⁻', '-' | '⁻', ..]) => {}
            '⁻' => text.push('-'),
            // `lb-ft` and `N.m`, but not `min-1`.
            '-' | '.'
                if before.is_some_and(|c| c.is_ascii_alphanumeric())
                    && next.is_some_and(|c| c.is_ascii_alphabetic()) =>
            {
                text.push('·');
            }
            _ => text.push(*c),
        }
    }
    text
}

static PATTERNS: LazyLock<HashMap<Dimension, String>> = LazyLock::new(|| {
    let mut patterns: HashMap<Dimension, String> = HashMap::new();
    let mut add = |dimension: Dimension, pattern: String| {
        let pattern_of_unit = patterns.entry(dimension).or_default();
        if !pattern_of_unit.is_empty() {
            pattern_of_unit.push('|');
        }
        pattern_of_unit.push_str(&pattern);
    };
    for (dimension, parts) in COMPOUNDS {
        let mut pattern = String::new();
        for part in *parts {
            match part {
                Text(text) => pattern.push_str(&spellings(text, pattern.is_empty())),
                Times => pattern.push_str(&format!("{TIMES}?")),
                Of(symbols, _) => pattern.push_str(&any(symbols)),
            }
        }
        add(*dimension, pattern);
    }
    // What is no compound.
    for (text, unit) in USUAL.iter() {
        let compounds = COMPOUNDS
            .iter()
            .filter(|(of_compound, _)| *of_compound == unit.dimension);
        if !compounds.into_iter().any(|(_, parts)| matched(text, parts).is_some()) {
            add(unit.dimension, spellings(text, true));
        }
    }
    patterns
});

/// Regular expression of all spellings of the units of a dimension.
pub(super) fn pattern(dimension: Dimension) -> &'static str {
    PATTERNS.get(&dimension).map_or("", String::as_str)
}

/// Spellings of a multiplication.
const TIMES: &str = r"(\s*[·⋅∙×*]\s*|\s+|[-.])";

/// Regular expression of the spellings of a normalised text.
fn spellings(text: &str, at_start: bool) -> String {
    let mut pattern = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        if let Some(behind) = rest.strip_prefix("deg") {
            pattern.push_str("(deg|°)");
            rest = behind;
            continue;
        }
        let is_first = at_start && pattern.is_empty();
        match c {
            'u' => pattern.push_str("[uµμ]"),
            '/' if is_first => pattern.push_str(r"/\s*"),
            '/' => pattern.push_str(r"\s*/\s*"),
            '(' => pattern.push_str(r"\(\s*"),
            ')' => pattern.push_str(r"\s*\)"),
            '·' => pattern.push_str(TIMES),
            '-' => pattern.push_str(r"\^?[-⁻−]"),
            '1' if is_first || pattern.ends_with(']') => pattern.push_str("[1¹]"),
            '2' => pattern.push_str(r"\^?[2²]"),
            '3' => pattern.push_str(r"\^?[3³]"),
            _ => pattern.push(c),
        }
        rest = &rest[c.len_utf8()..];
    }
    pattern
}

/// Regular expression of one of several symbols.
fn any(symbols: Symbols) -> String {
    let texts = |prefixed: bool| {
        let of_kind = symbols.iter().filter(|symbol| symbol.prefixed == prefixed);
        of_kind
            .map(|symbol| spellings(symbol.text, true))
            .collect::<Vec<_>>()
            .join("|")
    };
    let (with, without) = (texts(true), texts(false));
    match (with.is_empty(), without.is_empty()) {
        (true, _) => format!("({without})"),
        (false, true) => format!("((da|[pnuµμmcdhkMGT])?({with}))"),
        (false, false) => format!("((da|[pnuµμmcdhkMGT])?({with})|{without})"),
    }
}
