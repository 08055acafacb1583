#![allow(clippy::unwrap_used)]
use super::*;

const KNOWN: [&str; 32] = [
    "6208",
    "6205",
    "6210",
    "6308",
    "6000",
    "61904",
    "16010",
    "NU205EC",
    "NJ406",
    "QJ308",
    "7208BE",
    "30208",
    "32005X",
    "22208E",
    "604",
    "623",
    "127",
    "1208",
    "2208",
    "2220",
    "62/22",
    "6222",
    "320/28X",
    "32028X",
    "3308D",
    "29412E",
    "51108",
    "LM11749/710",
    "1380/1328",
    "47487/47420",
    "539/532X",
    "23022",
];

fn found(written: &str) -> Option<Designation<'static>> {
    read(written, KNOWN.into_iter())
}

fn keys(written: &str) -> Vec<(&'static str, Value)> {
    found(written).unwrap().changes().0
}

/// Designations as they stand on drawings and in parts lists, of several makers.
#[test]
fn fifty_usual_designations_are_found() {
    let all = [
        ("6208", "6208"),
        ("6208-2RS1", "6208"),
        ("6208-2RS1/C3", "6208"),
        ("6208 2RS1", "6208"),
        ("62082RS1", "6208"),
        ("6208-RS1", "6208"),
        ("6208-2RSH", "6208"),
        ("6205-2RSL", "6205"),
        ("6205-2RSH/C3", "6205"),
        ("6208-2Z", "6208"),
        ("6208-2Z/C3", "6208"),
        ("6208-Z", "6208"),
        ("6208-2RZ", "6208"),
        ("6208-2RZ/C3", "6208"),
        ("6208/C3", "6208"),
        ("6208 C3", "6208"),
        ("6208-C3", "6208"),
        ("6208-2RSR", "6208"),
        ("6208-2RSR-C3", "6208"),
        ("6208-2HRS", "6208"),
        ("6208-2ZR", "6208"),
        ("6208-2Z-C3", "6208"),
        ("6208DDU", "6208"),
        ("6208DDUC3", "6208"),
        ("6208ZZ", "6208"),
        ("6208ZZC3", "6208"),
        ("6208VV", "6208"),
        ("6208LLU", "6208"),
        ("6208LLB", "6208"),
        ("6208ZZ CM", "6208"),
        ("6308-TVP", "6308"),
        ("6308-M", "6308"),
        ("6308-TN9/C4", "6308"),
        ("6210-2Z", "6210"),
        ("6210/P6", "6210"),
        ("6210/P63", "6210"),
        ("6000-2RSH", "6000"),
        ("61904-2RS1", "61904"),
        ("16010/C3", "16010"),
        ("NU 205 ECP", "NU205EC"),
        ("NU205-E-TVP2", "NU205EC"),
        ("NU 205 ECML/C3", "NU205EC"),
        ("NJ 406", "NJ406"),
        ("QJ 308 N2MA", "QJ308"),
        ("7208 BEP", "7208BE"),
        ("7208 BECBP", "7208BE"),
        ("30208-A", "30208"),
        ("32005 X/Q", "32005X"),
        ("6208N", "6208"),
        ("6208-2RS1NR", "6208"),
        ("30208 J2/Q", "30208"),
        ("7208-B-TVP", "7208BE"),
        ("7208-B-TV", "7208BE"),
        // Prefixes.
        ("SKF 6208", "6208"),
        ("FAG 7208-B-TVP", "7208BE"),
        ("skf nu 205 ecp", "NU205EC"),
        ("HR 32005 XJ", "32005X"),
        ("4T-30208", "30208"),
        ("4T-LM11749/LM11710", "LM11749/710"),
        // Families of cages, with a number of the variant.
        ("30208 J3", "30208"),
        ("NU205EW", "NU205EC"),
        ("NU205-E-MPA-C3", "NU205EC"),
        ("NU205-E-M1A", "NU205EC"),
        ("6308-TVH", "6308"),
        ("1208 ETN9", "1208"),
        ("2208 E-2RS1TN9", "2208"),
        ("2208 EKTN9/C3", "2208"),
        ("1208-K-TVH-C3", "1208"),
        ("22208-E1-XL-K-C3", "22208E"),
        ("22208 EK/C3", "22208E"),
        ("22208-E1A-M", "22208E"),
        ("22208EAE4", "22208E"),
        ("22208EMW33C3", "22208E"),
        ("23022 CC/W33", "23022"),
        ("23022 CCK/C3W33", "23022"),
        ("23022-MB", "23022"),
        ("29412-E1-MB", "29412E"),
        ("3308 DMA", "3308D"),
        ("62/22-2RS1", "62/22"),
        ("320/28 X/Q", "320/28X"),
        ("604-2Z", "604"),
        ("623-2RS1/C3", "623"),
        ("LM 11749/710/Q", "LM11749/710"),
        ("LM11749-710", "LM11749/710"),
        ("LM11749/11710", "LM11749/710"),
        ("6208 2NSE", "6208"),
        ("6208-2RS2", "6208"),
        ("6208/C3HVT143", "6208"),
        ("6210/P53", "6210"),
        ("6308 M/C3VL0241", "6308"),
    ];
    assert!(all.len() >= 50);
    for (written, base) in all {
        let read = found(written);
        assert_eq!(read.map(|read| read.base), Some(base), "{written}");
    }
}

#[test]
fn other_bearings_are_not_taken_for_known_ones() {
    for written in [
        "62081",
        "6209",
        "620",
        "6208-QWV",
        "6208-XYZ",
        "6208-ABC",
        "6208-ZYX",
        "6208-X",
        "7208-AC",
        "NU 2050",
        "72080",
        "6208-2RS17",
        // Another bore, in digits that a known designation begins.
        "6042RS",
        "6232RS",
        "1272RS1",
        "22202RS",
        "62-22",
        "62 22",
        "320-28X",
        "2220 8",
        "3 0208",
        // Another contact angle, design or number of bearings.
        "7208",
        "7208-DB",
        "7208 ACD",
        "30208-B",
        "3308",
        "3308 A",
        "NU 205 V",
        "RNU 205",
        "NJ 205 EC",
        "W 6208",
        "L6208",
        "SKF6208X",
        "HR6208",
        "4T-6208",
        // Another cup.
        "LM11749/711",
        "LM11749",
        "LM11749/7100",
        "1380/1329",
        // 1380 is a self-aligning ball bearing of 400 mm bore.
        "1380-1328",
        "1380/13280",
        "1380/132",
        "1380/1328B",
        "1380",
        "47487/47420A",
        "47487/47420-B",
        "539/532",
        "",
        "-2RS1",
    ] {
        assert_eq!(found(written), None, "{written}");
    }
}

#[test]
fn suffixes_of_several_makers_state_the_same_keys() {
    let sealed = vec![("seals", json!({ "design": "rs1", "number": 2 }))];
    for written in ["6208-2RS1", "6208-2RSR", "6208DDU", "6208LLU", "6208 2RS"] {
        assert_eq!(keys(written), sealed, "{written}");
        assert_eq!(
            found(written).unwrap().changes().1,
            ["reference_speed", "limiting_speed"]
        );
    }
    let loose = ("clearance", json!("c3"));
    for written in ["6208/C3", "6208-2Z-C3", "6208DDUC3", "6210/P63"] {
        assert!(keys(written).contains(&loose), "{written}");
    }
    let shields = ("seals", json!({ "design": "shield", "number": 2 }));
    for written in ["6208ZZ", "6208-2Z"] {
        assert_eq!(keys(written), std::slice::from_ref(&shields));
    }
    assert!(keys("6308-TVP").is_empty() && found("6308-TVP").unwrap().changes().1.is_empty());
}

#[test]
fn an_older_design_is_named() {
    assert!(
        found("NU 205")
            .unwrap()
            .words()
            .contains("an older design has lower load ratings")
    );
    assert!(!found("NU 205 ECP").unwrap().words().contains("older"));
    assert_eq!(found("32005").unwrap().words(), "dimensions and ratings of `32005X`");
    assert!(!found("NU205-E-TVP2").unwrap().words().contains("older"));
}

#[test]
fn a_prefix_is_explained() {
    let words = found("SKF 6208/P63").unwrap().words();
    assert_eq!(
        words,
        "dimensions and ratings of `6208`; SKF: the maker, whose own ratings may differ; P63: tolerances: class 6, clearance C3"
    );
}

/// Any change of a letter or digit gives the same size or nothing.
#[test]
fn a_changed_designation_never_leads_to_another_size() {
    let letters = "0123456789/-XBE ";
    for base in KNOWN {
        for place in 0..=base.len() {
            let (before, after) = base.split_at(place);
            let shorter = after.get(1..).unwrap_or_default();
            let changed = letters
                .chars()
                .flat_map(|c| [format!("{before}{c}{after}"), format!("{before}{c}{shorter}")])
                .chain([format!("{before}{shorter}")]);
            for written in changed {
                let Some(read) = found(&written) else { continue };
                let digits = |text: &str| {
                    let parts = text.split(|c: char| !c.is_ascii_digit());
                    parts.filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ")
                };
                let (known, of_written) = (digits(read.base), digits(&written));
                assert!(of_written.starts_with(&known), "{written}: {}", read.base);
                let more = of_written[known.len()..].trim_start();
                // The number of a variant or of a class, never a digit of the size.
                assert!(
                    more.is_empty() || more.len() == 1 && !of_written[known.len()..].is_empty(),
                    "{written}"
                );
            }
        }
    }
}

#[test]
fn words_say_what_differs() {
    let words = found("6208-2RS1/C3").unwrap().words();
    assert_eq!(
        words,
        "dimensions and ratings of `6208`; 2RS1: contact seals on both sides, with friction in the model `skf` only, filled \
         with grease (state `lubrication: grease`); C3: radial clearance greater than normal"
    );
}
