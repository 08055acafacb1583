#![allow(clippy::unwrap_used)]
use super::*;

const KNOWN: [&str; 14] = [
    "6208", "6205", "6210", "6308", "6000", "61904", "16010", "NU205EC", "NJ406", "QJ308", "7208BE", "30208", "32005X",
    "22208E",
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
