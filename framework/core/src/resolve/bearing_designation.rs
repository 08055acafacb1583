//! Designations of rolling bearings: a basic designation and suffixes for seals, clearance, cage and precision.
//!
//! Source: clearance and tolerance classes as in DIN 623-1 and DIN 620; seals, shields and cages are the suffixes that the catalogues of SKF,
//! Schaeffler (FAG), NSK, NTN and Koyo explain. The makers use different letters for the same thing; what they have in common is kept.

use serde_json::{Value, json};

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
    /// Tolerance class in words.
    Precision(&'static str),
    /// Anything else, in words.
    Other(&'static str),
}

/// A suffix with its meaning.
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
    /// The suffixes, in their order.
    pub suffixes: Vec<Suffix>,
}

/// Suffixes with their meanings. At a place the longest that fits is taken.
const SUFFIXES: &[(&str, Meaning)] = &[
    // Contact seals: SKF, FAG (RSR, HRS), NSK (DU), NTN (LU), Koyo (RS).
    ("2RS1", Meaning::Seals(SealDesign::Rs1, 2)),
    ("RS1", Meaning::Seals(SealDesign::Rs1, 1)),
    ("2RS", Meaning::Seals(SealDesign::Rs1, 2)),
    ("RS", Meaning::Seals(SealDesign::Rs1, 1)),
    ("2RSR", Meaning::Seals(SealDesign::Rs1, 2)),
    ("RSR", Meaning::Seals(SealDesign::Rs1, 1)),
    ("2HRS", Meaning::Seals(SealDesign::Rs1, 2)),
    ("HRS", Meaning::Seals(SealDesign::Rs1, 1)),
    ("DDU", Meaning::Seals(SealDesign::Rs1, 2)),
    ("DU", Meaning::Seals(SealDesign::Rs1, 1)),
    ("LLU", Meaning::Seals(SealDesign::Rs1, 2)),
    ("LU", Meaning::Seals(SealDesign::Rs1, 1)),
    ("2RSH", Meaning::Seals(SealDesign::Rsh, 2)),
    ("RSH", Meaning::Seals(SealDesign::Rsh, 1)),
    ("2RSH2", Meaning::Seals(SealDesign::Rsh, 2)),
    ("RSH2", Meaning::Seals(SealDesign::Rsh, 1)),
    ("2RSL", Meaning::Seals(SealDesign::Rsl, 2)),
    ("RSL", Meaning::Seals(SealDesign::Rsl, 1)),
    ("2RST", Meaning::Seals(SealDesign::Rsl, 2)),
    ("2LS", Meaning::Seals(SealDesign::Ls, 2)),
    ("LS", Meaning::Seals(SealDesign::Ls, 1)),
    ("2CS", Meaning::Seals(SealDesign::Cs, 2)),
    ("2CS2", Meaning::Seals(SealDesign::Cs, 2)),
    ("2CS5", Meaning::Seals(SealDesign::Cs, 2)),
    // Non-contact seals: SKF, FAG (BRS), NSK (VV), NTN (LLB).
    ("2RZ", Meaning::Seals(SealDesign::NonContact, 2)),
    ("RZ", Meaning::Seals(SealDesign::NonContact, 1)),
    ("2BRS", Meaning::Seals(SealDesign::NonContact, 2)),
    ("VV", Meaning::Seals(SealDesign::NonContact, 2)),
    ("LLB", Meaning::Seals(SealDesign::NonContact, 2)),
    ("LB", Meaning::Seals(SealDesign::NonContact, 1)),
    // Shields.
    ("2Z", Meaning::Seals(SealDesign::Shield, 2)),
    ("ZZ", Meaning::Seals(SealDesign::Shield, 2)),
    ("2ZR", Meaning::Seals(SealDesign::Shield, 2)),
    ("ZR", Meaning::Seals(SealDesign::Shield, 1)),
    ("Z", Meaning::Seals(SealDesign::Shield, 1)),
    // Radial internal clearance.
    ("C1", Meaning::Clearance("c1")),
    ("C2", Meaning::Clearance("c2")),
    ("CN", Meaning::Clearance("cn")),
    ("C3", Meaning::Clearance("c3")),
    ("C4", Meaning::Clearance("c4")),
    ("C5", Meaning::Clearance("c5")),
    ("CM", Meaning::Other("radial clearance for electric motors")),
    // Cages.
    ("TN9", Meaning::Cage("polyamide with glass fibre")),
    ("TNG", Meaning::Cage("polyamide with glass fibre")),
    ("TNH", Meaning::Cage("PEEK")),
    ("TN", Meaning::Cage("polyamide")),
    ("TVP2", Meaning::Cage("polyamide with glass fibre")),
    ("TVP", Meaning::Cage("polyamide with glass fibre")),
    ("TV", Meaning::Cage("polyamide with glass fibre")),
    ("TVH", Meaning::Cage("polyamide with glass fibre")),
    ("T2XA", Meaning::Cage("polyamide")),
    (
        "XL",
        Meaning::Other("higher ratings than the earlier design of the maker"),
    ),
    ("MA", Meaning::Cage("machined brass, guided by the outer ring")),
    ("MB", Meaning::Cage("machined brass, guided by the inner ring")),
    ("ML", Meaning::Cage("machined brass, window type")),
    ("M1", Meaning::Cage("machined brass, riveted")),
    ("M", Meaning::Cage("machined brass")),
    ("J", Meaning::Cage("pressed steel")),
    ("J2", Meaning::Cage("pressed steel")),
    ("JP", Meaning::Cage("pressed steel")),
    ("Y", Meaning::Cage("pressed brass")),
    ("PH", Meaning::Cage("PEEK")),
    ("P", Meaning::Cage("polyamide with glass fibre")),
    // Tolerance classes, P with clearance as P63.
    ("P0", Meaning::Precision("normal")),
    ("P6", Meaning::Precision("class 6")),
    ("P5", Meaning::Precision("class 5")),
    ("P4", Meaning::Precision("class 4")),
    ("P63", Meaning::Precision("class 6, clearance C3")),
    ("P62", Meaning::Precision("class 6, clearance C2")),
    // Others that change neither dimensions nor ratings of the basic designation much.
    ("EC", Meaning::Other("optimised internal design")),
    ("E1", Meaning::Other("optimised internal design")),
    ("E", Meaning::Other("optimised internal design")),
    ("CC", Meaning::Other("optimised internal design")),
    (
        "B",
        Meaning::Other("contact angle of 40 degrees, or changed internal design"),
    ),
    ("CB", Meaning::Other("for universal matching, normal axial clearance")),
    ("CA", Meaning::Other("for universal matching, small axial clearance")),
    ("UA", Meaning::Other("for universal matching, small axial clearance")),
    ("GA", Meaning::Other("for universal matching, light preload")),
    ("N2", Meaning::Other("two locating slots")),
    ("W33", Meaning::Other("lubrication groove and holes in the outer ring")),
    ("NR", Meaning::Other("snap ring groove with ring")),
    ("N", Meaning::Other("snap ring groove")),
    ("K", Meaning::Other("tapered bore")),
    ("X", Meaning::Other("boundary dimensions adapted to ISO")),
    ("Q", Meaning::Other("optimised contact and surface")),
    ("A", Meaning::Other("changed internal design")),
    ("C", Meaning::Other("changed internal design")),
    ("S0", Meaning::Other("stabilised up to 150 degC")),
    ("S1", Meaning::Other("stabilised up to 200 degC")),
    ("MT33", Meaning::Other("grease filling")),
    ("MT47", Meaning::Other("grease filling")),
    ("GJN", Meaning::Other("grease filling")),
    ("WT", Meaning::Other("grease filling")),
    ("VL0241", Meaning::Other("electrically insulating coating")),
];

/// Whether a character separates suffixes.
fn separates(c: char) -> bool {
    matches!(c, '-' | '/' | '.' | '_') || c.is_whitespace()
}

/// Place of a suffix among those that are written without a separator (DIN 623-1): internal design, matching, external design and
/// seals, cage, the rest.
fn rank(name: &str, meaning: Meaning) -> u8 {
    match (meaning, name) {
        (Meaning::Other(_), "EC" | "E1" | "E" | "CC" | "A" | "B" | "C") => 1,
        (Meaning::Other(_), "CB" | "CA" | "UA" | "GA") => 2,
        (Meaning::Seals(..), _) | (Meaning::Other(_), "K" | "N" | "NR" | "N2" | "X") => 3,
        (Meaning::Cage(_), _) => 4,
        _ => 5,
    }
}

/// Suffixes after a basic designation; `None` if a part is unknown. Letters without a separator are read as several suffixes only in
/// the order of designations and one of each sort, so that `XYZ` is not X and Y and Z.
fn suffixes(rest: &str) -> Option<Vec<Suffix>> {
    let mut all = Vec::new();
    let upper = rest.to_ascii_uppercase();
    for token in upper.split(separates).filter(|token| !token.is_empty()) {
        let mut left = token;
        let mut before: Vec<(u8, std::mem::Discriminant<Meaning>)> = Vec::new();
        while !left.is_empty() {
            let fits = SUFFIXES.iter().filter(|(name, _)| left.starts_with(name));
            // The rest must be known too: `C3` after `RS1`, not `1C3` after `RS`.
            let (name, meaning) = fits.max_by_key(|(name, _)| name.len())?;
            let sort = (rank(name, *meaning), std::mem::discriminant(meaning));
            if before.iter().any(|known| known.0 > sort.0 || *known == sort) {
                return None;
            }
            before.push(sort);
            all.push(Suffix {
                written: (*name).to_owned(),
                meaning: *meaning,
            });
            left = &left[name.len()..];
        }
    }
    (!all.is_empty()).then_some(all)
}

/// Designations as catalogues write them with and without spaces: `NU 205 EC`, `NU205EC`. Length of the part of `written` that `base` is.
fn matched(written: &str, base: &str) -> Option<usize> {
    let mut base = base.chars().filter(|c| !c.is_whitespace()).peekable();
    for (i, c) in written.char_indices() {
        match base.peek() {
            None => return Some(i),
            Some(letter) if letter.eq_ignore_ascii_case(&c) => {
                base.next();
            }
            Some(_) if separates(c) => {}
            Some(_) => return None,
        }
    }
    base.peek().is_none().then_some(written.len())
}

/// Reads a designation with suffixes, such as `6208-2RS1/C3` or `NU 205 ECP`; `None` if no known designation begins it or a suffix is unknown.
/// A catalogue that has cylindrical roller bearings as `NU205EC` also finds `NU 205`, because the basic designation is the same.
pub fn read<'a>(written: &str, known: impl Iterator<Item = &'a str>) -> Option<Designation<'a>> {
    let of_base = |base: &'a str| {
        // `NU 205` and `32005` on drawings are `NU205EC` and `32005X` in catalogues. A letter after an angular contact ball bearing is its
        // contact angle, which must be the same.
        let plain = base.strip_suffix("EC").or_else(|| base.strip_suffix('X'));
        // `7208 B` has the contact angle of `7208BE`.
        let short = plain.or_else(|| base.strip_suffix('E').filter(|base| base.ends_with('B')));
        let forms = [Some(base), short]
            .map(|form| form.and_then(|form| matched(written, form).map(|end| (base, end, form.len()))));
        forms.into_iter().flatten()
    };
    let mut found: Vec<(&str, usize, usize)> = known.flat_map(of_base).collect();
    found.sort_by_key(|(_, _, length)| std::cmp::Reverse(*length));
    found.into_iter().find_map(|(base, end, _)| {
        let rest = &written[end..];
        let mut suffixes = if rest.trim_matches(separates).is_empty() {
            Vec::new()
        } else {
            suffixes(rest)?
        };
        for design in ["EC", "BE"] {
            if base.ends_with(design) && !written[..end].to_ascii_uppercase().ends_with(design) {
                suffixes.push(Suffix {
                    written: format!("without {}", design.trim_start_matches('B')),
                    meaning: Meaning::Other("an older design has lower load ratings than these"),
                });
            }
        }
        let designation = Designation { base, suffixes };
        designation.is_consistent().then_some(designation)
    })
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
            Meaning::Precision(class) => format!("tolerances: {class}"),
            Meaning::Other(words) => words.to_owned(),
        };
        format!("{}: {meaning}", self.written)
    }
}

impl Designation<'_> {
    /// Whether no two suffixes contradict each other, and none states another contact angle than the basic designation has.
    fn is_consistent(&self) -> bool {
        let count = |of: fn(Meaning) -> bool| self.suffixes.iter().filter(|suffix| of(suffix.meaning)).count();
        let seals = count(|meaning| matches!(meaning, Meaning::Seals(..)));
        let clearances = count(|meaning| matches!(meaning, Meaning::Clearance(_)));
        // Tapered roller bearings: B, C and D have other angles.
        let angle = self.base.starts_with('3')
            && self
                .suffixes
                .iter()
                .any(|suffix| matches!(suffix.written.as_str(), "B" | "C"));
        // Only tapered roller bearings have two sizes of one designation.
        let size = !self.base.starts_with('3') && self.suffixes.iter().any(|suffix| suffix.written == "X");
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
                Meaning::Precision("class 6, clearance C3") => keys.push(("clearance", json!("c3"))),
                Meaning::Precision("class 6, clearance C2") => keys.push(("clearance", json!("c2"))),
                Meaning::Cage(_) | Meaning::Precision(_) | Meaning::Other(_) => {}
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
