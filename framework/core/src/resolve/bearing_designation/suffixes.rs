//! Suffixes of designations: families of letters in a fixed order, some with a number of the variant.
//!
//! Source: DIN 623-1 for the order and for cages, clearance and tolerance classes (DIN 620, ISO 5753); what the catalogues of SKF,
//! Schaeffler (FAG), NSK, NTN and Koyo explain for seals, shields and internal designs, recalled. The makers use different letters for the
//! same thing; what they have in common is kept.

use super::{Meaning, Suffix};
use crate::maker::separates;
use crate::mechanism::bearing::SealDesign;

/// Seals and shields on one side. A `2` before them means both sides.
const SEALS: &[(&str, SealDesign)] = &[
    // Contact seals: SKF, FAG (RSR, HRS), NSK (DU), NTN (LU), Koyo and Timken (RS), Nachi (NSE).
    ("RS", SealDesign::Rs1),
    ("RS1", SealDesign::Rs1),
    ("RS2", SealDesign::Rs1),
    ("RSR", SealDesign::Rs1),
    ("HRS", SealDesign::Rs1),
    ("NSE", SealDesign::Rs1),
    ("DU", SealDesign::Rs1),
    ("LU", SealDesign::Rs1),
    ("RSH", SealDesign::Rsh),
    ("RSH2", SealDesign::Rsh),
    ("RSL", SealDesign::Rsl),
    ("RST", SealDesign::Rsl),
    ("LS", SealDesign::Ls),
    ("CS", SealDesign::Cs),
    ("CS2", SealDesign::Cs),
    ("CS5", SealDesign::Cs),
    // Non-contact seals: SKF, FAG (BRS), NTN (LB).
    ("RZ", SealDesign::NonContact),
    ("BRS", SealDesign::NonContact),
    ("LB", SealDesign::NonContact),
    ("Z", SealDesign::Shield),
    ("ZR", SealDesign::Shield),
];

/// Seals and shields on both sides by a doubled letter.
const BOTH_SIDES: &[(&str, SealDesign)] = &[
    ("DDU", SealDesign::Rs1),
    ("LLU", SealDesign::Rs1),
    ("VV", SealDesign::NonContact),
    ("LLB", SealDesign::NonContact),
    ("ZZ", SealDesign::Shield),
];

/// Cages; a number of the variant may follow.
const CAGES: &[(&str, &str)] = &[
    ("J", "pressed steel"),
    ("JA", "pressed steel"),
    ("JP", "pressed steel"),
    ("JR", "pressed steel"),
    ("W", "pressed steel"),
    ("Y", "pressed brass"),
    ("M", "machined brass"),
    ("MA", "machined brass, guided by the outer ring"),
    ("MB", "machined brass, guided by the inner ring"),
    ("M1A", "machined brass, guided by the outer ring"),
    ("M1B", "machined brass, guided by the inner ring"),
    ("ML", "machined brass, window type"),
    ("MP", "machined brass, window type"),
    ("MPA", "machined brass, window type, guided by the outer ring"),
    ("MPB", "machined brass, window type, guided by the inner ring"),
    ("F", "machined steel"),
    ("FA", "machined steel, guided by the outer ring"),
    ("FB", "machined steel, guided by the inner ring"),
    ("L", "light alloy, of some makers machined brass"),
    ("LA", "light alloy, guided by the outer ring"),
    ("T", "laminated fabric or polyamide"),
    ("TA", "laminated fabric, guided by the outer ring"),
    ("TB", "laminated fabric, guided by the inner ring"),
    ("TN", "polyamide"),
    ("TNG", "polyamide with glass fibre"),
    ("TNH", "PEEK"),
    ("TV", "polyamide with glass fibre"),
    ("TVH", "polyamide with glass fibre"),
    ("TVP", "polyamide with glass fibre"),
    ("TVPA", "polyamide with glass fibre, guided by the outer ring"),
    ("TVPB", "polyamide with glass fibre, guided by the inner ring"),
    ("T2XA", "polyamide"),
    ("P", "polyamide with glass fibre"),
    ("PA", "polyamide with glass fibre, guided by the outer ring"),
    ("PH", "PEEK"),
    ("PHA", "PEEK, guided by the outer ring"),
];

/// Classes of the radial internal clearance, as the key `clearance` has them. A letter for a part of the range may follow.
const CLEARANCES: &[(&str, &str)] = &[
    ("C1", "c1"),
    ("C2", "c2"),
    ("CN", "cn"),
    ("C3", "c3"),
    ("C4", "c4"),
    ("C5", "c5"),
];
const PARTS_OF_CLEARANCE: [&str; 5] = ["", "L", "M", "H", "P"];

/// Tolerance classes. The digit of a class of clearance may follow: `P63` is class 6 with C3.
const CLASSES: &[(&str, &str)] = &[
    ("P0", "normal"),
    ("PN", "normal"),
    ("P6", "class 6"),
    ("P6X", "class 6X"),
    ("P5", "class 5"),
    ("P4", "class 4"),
    ("P2", "class 2"),
    ("CLN", "class 6X"),
    ("CL7C", "class 7C"),
];

/// Internal designs: of one basic designation, with other ratings.
const DESIGNS: &[(&str, &str)] = &[
    ("EC", "optimised internal design"),
    ("E", "optimised internal design"),
    ("E1", "optimised internal design"),
    ("E1A", "optimised internal design"),
    ("EA", "optimised internal design"),
    ("A", "changed internal design"),
    ("B", "contact angle of 40 degrees, or changed internal design"),
    ("C", "changed internal design"),
];

/// Matching of angular contact ball bearings; cage and guiding of the rollers of spherical roller bearings.
const MATCHING: &[(&str, &str)] = &[
    ("CB", "for universal matching, normal axial clearance"),
    (
        "CA",
        "for universal matching, small axial clearance; of spherical roller bearings a machined brass cage",
    ),
    ("CC", "of spherical roller bearings: two pressed steel cages"),
    ("UA", "for universal matching, small axial clearance"),
    ("UO", "for universal matching, no axial clearance"),
    ("GA", "for universal matching, light preload"),
];

/// External design.
const EXTERNAL: &[(&str, &str)] = &[
    ("K", "tapered bore"),
    ("K30", "tapered bore of 1 in 30"),
    ("N", "snap ring groove"),
    ("NR", "snap ring groove with ring"),
    ("N1", "a locating slot"),
    ("N2", "two locating slots"),
    ("X", "boundary dimensions adapted to ISO"),
];

/// Everything else.
const OTHERS: &[(&str, &str)] = &[
    ("XL", "higher ratings than the earlier design of the maker"),
    ("CM", "radial clearance for electric motors"),
    ("W20", "lubrication holes in the outer ring"),
    ("W33", "lubrication groove and holes in the outer ring"),
    ("W33X", "lubrication groove and holes in the outer ring"),
    ("E4", "lubrication groove and holes in the outer ring"),
    ("D1", "lubrication groove and holes in the outer ring"),
    ("Q", "optimised contact and surface"),
    ("S0", "stabilised up to 150 degC"),
    ("S1", "stabilised up to 200 degC"),
    ("S2", "stabilised up to 250 degC"),
    ("S3", "stabilised up to 300 degC"),
    ("GJN", "grease filling"),
    ("WT", "grease filling"),
];

/// Others with the number of a variant.
const NUMBERED: &[(&str, &str)] = &[
    ("MT", "grease filling"),
    ("LT", "grease filling"),
    ("HT", "grease filling"),
    ("LHT", "grease filling"),
    ("VT", "grease filling"),
    ("VL", "electrically insulating coating"),
];

/// A suffix at the start of a text: its length, its place among those that are written without a separator (DIN 623-1: internal design,
/// matching, external design and seals, cage, the rest), and its meaning.
type Candidate = (usize, u8, Meaning);

/// Digits at the start of a text, at most `most`.
fn digits(text: &str, most: usize) -> usize {
    text.bytes().take(most).take_while(u8::is_ascii_digit).count()
}

/// All suffixes that a text may begin with, the longest first.
fn candidates(text: &str) -> Vec<Candidate> {
    let mut all: Vec<Candidate> = Vec::new();
    for (names, rank) in [(DESIGNS, 1), (MATCHING, 2), (EXTERNAL, 3), (OTHERS, 5)] {
        let fits = names.iter().filter(|(name, _)| text.starts_with(name));
        all.extend(fits.map(|(name, words)| (name.len(), rank, Meaning::Other(words))));
    }
    for (name, words) in NUMBERED.iter().filter(|(name, _)| text.starts_with(name)) {
        let number = digits(&text[name.len()..], 4);
        if number > 0 {
            all.push((name.len() + number, 5, Meaning::Other(words)));
        }
    }
    let (sides, one) = text.strip_prefix('2').map_or((1, text), |rest| (2, rest));
    let before = text.len() - one.len();
    for (name, design) in SEALS.iter().filter(|(name, _)| one.starts_with(name)) {
        all.push((before + name.len(), 3, Meaning::Seals(*design, sides)));
    }
    for (name, design) in BOTH_SIDES.iter().filter(|(name, _)| text.starts_with(name)) {
        all.push((name.len(), 3, Meaning::Seals(*design, 2)));
    }
    for (name, words) in CAGES.iter().filter(|(name, _)| text.starts_with(name)) {
        all.push((name.len(), 4, Meaning::Cage(words)));
        let number = digits(&text[name.len()..], 2);
        // `P6` is a tolerance class.
        if number > 0 && !matches!(*name, "P" | "PA") {
            all.push((name.len() + number, 4, Meaning::Cage(words)));
        }
    }
    for (name, class) in CLEARANCES.iter().filter(|(name, _)| text.starts_with(name)) {
        let rest = &text[name.len()..];
        let parts = PARTS_OF_CLEARANCE.iter().filter(|part| rest.starts_with(*part));
        all.extend(parts.map(|part| (name.len() + part.len(), 5, Meaning::Clearance(class))));
    }
    for (name, class) in CLASSES.iter().filter(|(name, _)| text.starts_with(name)) {
        all.push((name.len(), 5, Meaning::Precision(class, None)));
        let digit = text.get(name.len()..=name.len()).unwrap_or_default();
        let clearance = CLEARANCES.iter().find(|(clearance, _)| clearance[1..] == *digit);
        if let Some((_, clearance)) = clearance.filter(|_| name.starts_with('P')) {
            all.push((name.len() + 1, 5, Meaning::Precision(class, Some(clearance))));
        }
    }
    all.sort_by_key(|(length, ..)| std::cmp::Reverse(*length));
    all
}

/// Suffixes without separators between them, only in the order of designations and one of each sort, so that `XYZ` is not X and Y and Z.
fn of_token(token: &str, before: &[Candidate]) -> Option<Vec<Suffix>> {
    if token.is_empty() {
        return Some(Vec::new());
    }
    let sort = |meaning: &Meaning| std::mem::discriminant(meaning);
    for candidate @ (length, rank, meaning) in candidates(token) {
        let follows = |(_, known_rank, known): &Candidate| {
            *known_rank < rank || *known_rank == rank && sort(known) != sort(&meaning)
        };
        if !before.iter().all(follows) {
            continue;
        }
        let before: Vec<Candidate> = before.iter().copied().chain([candidate]).collect();
        if let Some(rest) = of_token(&token[length..], &before) {
            let written = token[..length].to_owned();
            return Some(std::iter::once(Suffix { written, meaning }).chain(rest).collect());
        }
    }
    None
}

/// Suffixes after a basic designation; `None` if there are none or a part is unknown.
pub(super) fn read(rest: &str) -> Option<Vec<Suffix>> {
    let upper = rest.to_ascii_uppercase();
    if !upper.is_ascii() {
        return None;
    }
    let tokens = upper.split(separates).filter(|token| !token.is_empty());
    let mut all = Vec::new();
    for token in tokens {
        all.extend(of_token(token, &[])?);
    }
    (!all.is_empty()).then_some(all)
}
