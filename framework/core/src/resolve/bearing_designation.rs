//! Designations of rolling bearings: a basic designation, a prefix, and [suffixes] for seals, clearance, cage and precision.
//!
//! A designation never leads to another kind or size: what is between two digits counts, and a letter that nobody explains is not skipped.

mod suffixes;

use std::borrow::Cow;

use super::bearing_series::basic_designation;
use serde_json::{Value, json};

use crate::maker::{self, separates};
use crate::mechanism::bearing::SealDesign;

/// What a suffix means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// Seals or shields: design and number.
    Seals(SealDesign, u32),
    /// Class of the radial internal clearance, as the key `clearance` has it.
    Clearance(&'static str),
    /// Cage: its material and design in words.
    Cage(&'static str),
    /// Tolerance class in words, and a class of clearance that it states, too.
    Precision(&'static str, Option<&'static str>),
    /// Anything else, in words.
    Other(&'static str),
}

/// A suffix or prefix with its meaning.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Suffix {
    /// As written, without separators.
    pub written: String,
    /// What it means.
    pub meaning: Meaning,
}

/// A designation that a catalogue has without its suffixes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Designation<'a> {
    /// The designation of the catalogue.
    pub base: &'a str,
    /// Prefix and suffixes, in their order.
    pub suffixes: Vec<Suffix>,
}

/// Prefixes of tapered roller bearings: NSK, NTN. Those of other kinds change ratings or name single parts.
const TAPERED: &[(&str, &str)] = &[
    ("HR", "high load ratings"),
    ("4T", "case-hardened"),
    ("ET", "case-hardened"),
];

/// Cone and cup of an inch designation, such as `LM11749/710`.
fn cone_and_cup(base: &str) -> Option<(&str, &str)> {
    let (cone, cup) = base.split_once('/')?;
    (cup.bytes().filter(u8::is_ascii_digit).count() >= 3).then_some((cone, cup))
}

/// Spellings of a designation of a catalogue on drawings and in parts lists, besides suffixes and separators.
fn spellings(base: &str) -> impl Iterator<Item = Cow<'_, str>> {
    let inch = cone_and_cup(base);
    // `NU 205` and `32005` are `NU205EC` and `32005X` in catalogues. A letter after an angular contact ball bearing is its contact angle, which
    // must be the same; `7208 B` has that of `7208BE`.
    let short = if inch.is_some() {
        None
    } else if base.starts_with('N') {
        base.strip_suffix("EC")
    } else if base.starts_with('3') {
        base.strip_suffix('X')
    } else {
        base.strip_suffix('E').filter(|base| base.ends_with('B'))
    };
    // `22208-E1` of FAG is the E design.
    let is_e = base.ends_with('E') && base.starts_with('2');
    let numbered = is_e.then(|| ["1A", "1"].map(|variant| Cow::from(format!("{base}{variant}"))));
    // The number of a cup omits what it has in common with the cone: `LM11749/LM11710`, `LM11749/11710`.
    let whole = inch.and_then(|(cone, cup)| {
        let number = cone.trim_start_matches(|c: char| c.is_ascii_alphabetic());
        let number = number.trim_end_matches(|c: char| c.is_ascii_alphabetic());
        let letters = &cone[..cone.len() - cone.trim_start_matches(|c: char| c.is_ascii_alphabetic()).len()];
        let digits = cup.bytes().take_while(u8::is_ascii_digit).count();
        let common = number
            .get(..number.len().checked_sub(digits)?)
            .filter(|common| !common.is_empty())?;
        Some([
            Cow::from(format!("{cone}/{letters}{common}{cup}")),
            Cow::from(format!("{cone}/{common}{cup}")),
        ])
    });
    numbered
        .into_iter()
        .flatten()
        .chain(whole.into_iter().flatten())
        .chain([Cow::from(base)])
        .chain(short.map(Cow::from))
}

/// Length of the part of `written` that a spelling is, with and without separators: `NU 205 EC`, `NU205EC`. A separator between two digits
/// is part of the designation: `62/22` is not `6222`.
fn matched(written: &str, spelling: &str) -> Option<usize> {
    let is_inch = cone_and_cup(spelling).is_some();
    let mut left = spelling.chars().filter(|c| !c.is_whitespace()).peekable();
    let mut is_after_digit = false;
    for (i, c) in written.char_indices() {
        match left.peek() {
            None => return Some(i),
            Some(letter) if letter.eq_ignore_ascii_case(&c) || is_inch && *letter == '/' && c == '-' => {
                left.next();
                is_after_digit = c.is_ascii_digit();
            }
            Some(next) if separates(c) && !(is_after_digit && next.is_ascii_digit()) => {}
            Some(_) => return None,
        }
    }
    left.peek().is_none().then_some(written.len())
}

/// Reads a designation with prefix and suffixes, such as `6208-2RS1/C3`, `NU 205 ECP` or `SKF 6208`; `None` if no known designation begins
/// it or a part is unknown. A catalogue that has cylindrical roller bearings as `NU205EC` also finds `NU 205`, because the basic designation is
/// the same.
pub fn read<'a>(written: &str, known: impl Iterator<Item = &'a str> + Clone) -> Option<Designation<'a>> {
    if let Some(read) = without_prefix(written, known.clone()) {
        return Some(read);
    }
    let (prefix, words, rest) = match maker::before(written) {
        Some((maker, rest)) => (maker, "the maker, whose own ratings may differ", rest),
        None => TAPERED.iter().find_map(|(prefix, words)| {
            let (start, rest) = written.split_at_checked(prefix.len())?;
            let rest = rest.trim_start_matches(separates);
            start.eq_ignore_ascii_case(prefix).then_some((*prefix, *words, rest))
        })?,
    };
    let mut read = without_prefix(rest, known)?;
    let is_tapered = |base: &str| {
        cone_and_cup(base).is_some() || basic_designation(base).is_some_and(|basic| basic.kind == "tapered_roller")
    };
    let of_kind = TAPERED.iter().all(|(of_tapered, _)| *of_tapered != prefix) || is_tapered(read.base);
    let prefix = Suffix {
        written: prefix.to_owned(),
        meaning: Meaning::Other(words),
    };
    read.suffixes.insert(0, prefix);
    of_kind.then_some(read)
}

fn without_prefix<'a>(written: &str, known: impl Iterator<Item = &'a str>) -> Option<Designation<'a>> {
    let first = written.chars().find(|c| !separates(*c))?;
    let begins = |base: &&str| base.starts_with(|c: char| c.eq_ignore_ascii_case(&first));
    let places = |base: &'a str| {
        spellings(base).filter_map(move |spelling| {
            let end = matched(written, &spelling)?;
            Some((base, end, spelling.len()))
        })
    };
    let mut found: Vec<(&str, usize, usize)> = known.filter(begins).flat_map(places).collect();
    found.sort_by_key(|(_, _, length)| std::cmp::Reverse(*length));
    found.into_iter().find_map(|(base, end, _)| of_base(written, base, end))
}

/// The designation if the first `end` bytes are that of a base.
fn of_base<'a>(written: &str, base: &'a str, end: usize) -> Option<Designation<'a>> {
    let rest = &written[end..];
    let mut suffixes = if rest.trim_matches(separates).is_empty() {
        Vec::new()
    } else {
        suffixes::read(rest)?
    };
    // A letter behind an inch number is part of it.
    if cone_and_cup(base).is_some() && !(suffixes.is_empty() || rest.starts_with(separates)) {
        return None;
    }
    let is_design = |suffix: &Suffix| suffix.written.starts_with('E');
    for design in ["EC", "BE"] {
        if base.ends_with(design)
            && !written[..end].to_ascii_uppercase().ends_with(design)
            && !suffixes.first().is_some_and(is_design)
        {
            suffixes.push(Suffix {
                written: format!("without {}", design.trim_start_matches('B')),
                meaning: Meaning::Other("an older design has lower load ratings than these"),
            });
        }
    }
    let designation = Designation { base, suffixes };
    (designation.is_consistent() && is_same_size(written, base)).then_some(designation)
}

/// Whether the basic designations state the same kind, bore and contact angle: `1272RS` is no `127` with seals.
fn is_same_size(written: &str, base: &str) -> bool {
    match (basic_designation(written), basic_designation(base)) {
        (None, _) => true,
        (Some(_), None) => false,
        (Some(written), Some(base)) => {
            let angles = written.contact_angle.zip(base.contact_angle);
            written.kind == base.kind && written.bore == base.bore && angles.is_none_or(|(a, b)| a == b)
        }
    }
}

impl Suffix {
    /// Suffix and meaning in words.
    pub fn words(&self) -> String {
        let meaning = match self.meaning {
            Meaning::Seals(design, number) => {
                let sides = if number == 2 { "both sides" } else { "one side" };
                match design {
                    SealDesign::Shield => format!("shields on {sides}, without friction"),
                    SealDesign::NonContact => format!("non-contact seals on {sides}, without friction"),
                    _ if number == 2 => {
                        "contact seals on both sides, with friction in the model `skf` only, filled with grease (state `lubrication: grease`)".to_owned()
                    }
                    _ => "a contact seal on one side, with friction in the model `skf` only".to_owned(),
                }
            }
            Meaning::Clearance("c1") => "radial clearance less than C2".to_owned(),
            Meaning::Clearance("c2") => "radial clearance less than normal".to_owned(),
            Meaning::Clearance("cn") => "normal radial clearance".to_owned(),
            Meaning::Clearance("c3") => "radial clearance greater than normal".to_owned(),
            Meaning::Clearance("c4") => "radial clearance greater than C3".to_owned(),
            Meaning::Clearance(_) => "radial clearance greater than C4".to_owned(),
            Meaning::Cage(cage) => format!("cage of {cage}"),
            Meaning::Precision(class, None) => format!("tolerances: {class}"),
            Meaning::Precision(class, Some(clearance)) => {
                format!("tolerances: {class}, clearance {}", clearance.to_uppercase())
            }
            Meaning::Other(words) => words.to_owned(),
        };
        format!("{}: {meaning}", self.written)
    }
}

impl Designation<'_> {
    /// Whether no two suffixes contradict each other, and none states another contact angle or size than the basic designation has.
    fn is_consistent(&self) -> bool {
        let count = |of: fn(Meaning) -> bool| self.suffixes.iter().filter(|suffix| of(suffix.meaning)).count();
        let seals = count(|meaning| matches!(meaning, Meaning::Seals(..)));
        let clearances = count(|meaning| matches!(meaning, Meaning::Clearance(_)));
        let has = |letters: &[&str]| {
            self.suffixes
                .iter()
                .any(|suffix| letters.contains(&suffix.written.as_str()))
        };
        let is_inch = cone_and_cup(self.base).is_some();
        let begins_with_3 = self.base.starts_with('3');
        // Tapered roller and double-row angular contact ball bearings: B and C have other angles.
        let angle = begins_with_3 && has(&["B", "C"]);
        // Only metric tapered roller bearings have two sizes of one designation; of inch ones a letter is another cup.
        let size = (!begins_with_3 || is_inch) && has(&["X"]) || is_inch && has(&["A", "B", "C"]);
        seals <= 1 && clearances <= 1 && !angle && !size
    }

    /// Keys of a bearing that the suffixes state, and keys of the basic bearing that no longer hold.
    pub fn changes(&self) -> (Vec<(&'static str, Value)>, &'static [&'static str]) {
        let mut keys = Vec::new();
        let mut invalid: &[&str] = &[];
        for suffix in &self.suffixes {
            match suffix.meaning {
                Meaning::Seals(design, number) => {
                    keys.push(("seals", json!({ "design": design, "number": number })));
                    if design.is_contact() {
                        // The catalogue states them for the open bearing; rubbing seals permit less.
                        invalid = &["reference_speed", "limiting_speed"];
                    }
                }
                Meaning::Clearance(class) => keys.push(("clearance", json!(class))),
                Meaning::Precision(_, Some(clearance)) => keys.push(("clearance", json!(clearance))),
                Meaning::Cage(_) | Meaning::Precision(..) | Meaning::Other(_) => {}
            }
        }
        (keys, invalid)
    }

    /// What differs from the bearing of the catalogue, as a sentence.
    pub fn words(&self) -> String {
        let base = format!("dimensions and ratings of `{}`", self.base);
        let suffixes = self.suffixes.iter().map(Suffix::words);
        std::iter::once(base).chain(suffixes).collect::<Vec<_>>().join("; ")
    }
}

#[cfg(test)]
mod tests;
