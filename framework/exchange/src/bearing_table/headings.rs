//! The keys of a catalogue and the headings of makers for them, in English and German.
//!
//! The headings are the words of the usual symbols of ISO 281 and ISO 76, of product tables of SKF and Schaeffler, and common
//! variants. A heading that is not here is assigned by the user.

use gearloss_document::data::without_brackets;
use gearloss_document::{Conversion, Unit};

/// A key of the catalogue.
#[derive(Debug, PartialEq)]
pub(super) struct Key {
    pub name: &'static str,
    /// Unit in the catalogue; empty for texts.
    pub unit: &'static str,
    /// True for a total width or height, which has precedence over the width of a ring.
    pub total: bool,
    /// What the key is needed for; empty if it is never missed.
    pub purpose: &'static str,
    /// Symbols as written, with their case.
    symbols: &'static str,
    /// Words in lower case without signs and spaces.
    words: &'static str,
}

/// All keys, in the order of the catalogue.
pub(super) const KEYS: [Key; 21] = [
    Key {
        name: "designation",
        unit: "",
        total: false,
        purpose: "",
        symbols: "",
        words: "designation designations bearing bearingno bearingnumber bearingnumbers partnumber partno type typedesignation \
                bezeichnung lagerbezeichnung kurzzeichen lager typenbezeichnung teilenummer baseddesignation basicdesignation",
    },
    Key {
        name: "kind",
        unit: "",
        total: false,
        purpose: "",
        symbols: "",
        words: "kind bearingtype bearingkind design lagerart lagerbauart bauart bauform",
    },
    Key {
        name: "series",
        unit: "",
        total: false,
        purpose: "",
        symbols: "",
        words: "series dimensionseries bearingseries reihe lagerreihe massreihe maßreihe",
    },
    Key {
        name: "bore",
        unit: "mm",
        total: false,
        purpose: "",
        symbols: "d",
        words: "bore borediameter borediameterd diameterbore insidediameter innerdiameter bohrung bohrungsdurchmesser bohrungd innendurchmesser id",
    },
    Key {
        name: "outside",
        unit: "mm",
        total: false,
        purpose: "",
        symbols: "D",
        words: "outside outsidediameter outsidediameterd outerdiameter diameteroutside od außendurchmesser aussendurchmesser außendurchmesserd mantel",
    },
    Key {
        name: "width",
        unit: "mm",
        total: false,
        purpose: "the model `skf` of roller bearings",
        symbols: "B b",
        words: "width widthb bearingwidth overallwidth breite breiteb lagerbreite",
    },
    Key {
        name: "width",
        unit: "mm",
        total: true,
        purpose: "",
        symbols: "T H",
        words: "totalwidth totalwidtht widtht height heighth totalheight gesamtbreite bauhöhe höhe gesamthöhe breitet",
    },
    Key {
        name: "c",
        unit: "N",
        total: false,
        purpose: "life (`ratings`)",
        symbols: "C Cr Ca C1 Cdyn",
        words: "c basicdynamicloadrating basicdynamicloadratingc dynamicloadrating dynamicloadratingc basicdynamicloadratingradial \
                basicdynamicloadratingaxial basicdynamicloadratings dynamic dynamictragzahl dynamischetragzahl dynamischetragzahlc dynamischetragzahlradial dynamischetragzahlaxial \
                tragzahldyn tragzahldynamisch dyntragzahl cdyn dynamicloadratingcr",
    },
    Key {
        name: "c0",
        unit: "N",
        total: false,
        purpose: "the models `skf`, `palmgren` and ISO/TR 14179-2 of bearings that need it, static safety",
        symbols: "C0 C0r C0a Co Cor Coa Cstat",
        words: "basicstaticloadrating basicstaticloadratingc0 staticloadrating staticloadratingc0 basicstaticloadratingradial \
                basicstaticloadratingaxial basicstaticloadratings static statischetragzahl statischetragzahlc0 statischetragzahlradial statischetragzahlaxial tragzahlstat \
                tragzahlstatisch stattragzahl cstat c0 c0r",
    },
    Key {
        name: "e",
        unit: "-",
        total: false,
        purpose: "",
        symbols: "e",
        words: "calculationfactore limitingvalue factore faktore",
    },
    Key {
        name: "y",
        unit: "-",
        total: false,
        purpose: "",
        symbols: "Y Y2",
        words: "calculationfactory calculationfactory2 axialfactory faktory axialfaktory",
    },
    Key {
        name: "y0",
        unit: "-",
        total: false,
        purpose: "",
        symbols: "Y0 Yo",
        words: "calculationfactory0 axialfactory0 faktory0",
    },
    Key {
        name: "contact_angle",
        unit: "deg",
        total: false,
        purpose: "",
        symbols: "α alpha α0 alpha0",
        words: "contactangle nominalcontactangle druckwinkel nenndruckwinkel berührungswinkel",
    },
    Key {
        name: "pu",
        unit: "N",
        total: false,
        purpose: "modified life (`ratings`)",
        symbols: "Pu Cu Cur Cua PU",
        words: "fatigueloadlimit fatigueloadlimitpu fatigueloadlimitcu fatigueloadlimitradial fatigueloadlimitaxial ermüdungsgrenzbelastung ermüdungsgrenzbelastungradial \
                ermüdungsgrenzbelastungpu pu cu",
    },
    Key {
        name: "calculation_factor",
        unit: "-",
        total: false,
        purpose: "",
        symbols: "f0",
        words: "calculationfactor calculationfactorf0 factorf0 berechnungsfaktor berechnungsfaktorf0 f0",
    },
    Key {
        name: "minimum_load_factor",
        unit: "-",
        total: false,
        purpose: "",
        symbols: "kr",
        words: "minimumloadfactor minimumloadfactorkr minimallastfaktor mindestlastfaktor kr",
    },
    Key {
        name: "reference_speed",
        unit: "rpm",
        total: false,
        purpose: "",
        symbols: "n_ref nref nB nϑr nθr",
        words: "referencespeed thermalreferencespeed speedratingreference thermalspeedrating referencespeedrating referenzdrehzahl \
                bezugsdrehzahl thermischebezugsdrehzahl nref nb",
    },
    Key {
        name: "limiting_speed",
        unit: "rpm",
        total: false,
        purpose: "",
        symbols: "n_lim nlim nG nmax",
        words: "limitingspeed limitingspeedoil speedlimit speedratinglimiting mechanicallimitingspeed maximumspeed grenzdrehzahl grenzdrehzahlöl \
                nlim ng nmax",
    },
    Key {
        name: "estimated",
        unit: "",
        total: false,
        purpose: "",
        symbols: "",
        words: "estimated",
    },
    Key {
        name: "confidence",
        unit: "",
        total: false,
        purpose: "",
        symbols: "",
        words: "confidence",
    },
    Key {
        name: "basis",
        unit: "",
        total: false,
        purpose: "",
        symbols: "",
        words: "basis",
    },
];

/// The key of a heading without unit.
pub(super) fn key(heading: &str) -> Option<&'static Key> {
    let heading = heading.trim();
    // The own format: `c`, `y`.
    if let Some(key) = KEYS.iter().find(|key| !key.total && key.name == heading) {
        return Some(key);
    }
    let by_symbol = |symbol: &str| {
        KEYS.iter()
            .find(|key| key.symbols.split_whitespace().any(|known| known == symbol))
    };
    let plain: String = heading
        .chars()
        .filter(|c| !matches!(c, '_' | ' ' | ',' | '₀'))
        .collect();
    let subscript = heading.replace('₀', "0");
    if let Some(key) = by_symbol(heading).or_else(|| by_symbol(&subscript)) {
        return Some(key);
    }
    if let Some(key) = by_symbol(&plain).filter(|_| plain.len() < 6) {
        return Some(key);
    }
    let words: String = heading.to_lowercase().chars().filter(|c| c.is_alphanumeric()).collect();
    let words = words.replace('₀', "0");
    // A single letter has a meaning by its case only.
    if words.chars().count() < 2 {
        return None;
    }
    let by_words = |words: &str| {
        KEYS.iter()
            .find(|key| key.words.split_whitespace().any(|known| known == words) || key.name.replace('_', "") == words)
    };
    by_words(&words).or_else(|| {
        // A symbol after the words, such as `Bore diameter, d`.
        let (words, symbol) = heading.rsplit_once([' ', ','])?;
        let key = by_symbol(symbol)?;
        let words: String = words.to_lowercase().chars().filter(|c| c.is_alphanumeric()).collect();
        by_words(&words).filter(|named| named.name == key.name).map(|_| key)
    })
}

/// A unit, also in brackets.
pub(super) fn unit(symbol: &str) -> Option<Conversion> {
    Unit::read(without_brackets(symbol))
}

/// No symbol and no word belongs to two keys.
#[cfg(test)]
pub(super) fn assert_distinct() {
    let mut seen = std::collections::BTreeMap::new();
    for key in &KEYS {
        for word in key.symbols.split_whitespace().chain(key.words.split_whitespace()) {
            let before = seen.insert(word, key.name);
            assert!(before.is_none_or(|name| name == key.name), "{word} belongs to two keys");
        }
    }
}
