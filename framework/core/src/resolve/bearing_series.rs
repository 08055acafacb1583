//! What the basic designation of a rolling bearing states: kind, dimension series, bore and contact angle.
//!
//! Source: DIN 623-1 for kinds, series and bores; DIN 628-1 for the letters of contact angles, except D of double rows, which is SKF's. The series are written as the tables of
//! the loss models name them.

/// A basic designation.
#[derive(Debug, Clone, PartialEq)]
pub struct BasicDesignation {
    /// Kind, as in a gearbox file.
    pub kind: &'static str,
    /// Dimension series with the letters that distinguish designs, such as `62`, `72 BE`, `320 X`; absent if no model needs it.
    pub series: Option<String>,
    /// Bore. \[mm\]
    pub bore: Option<f64>,
    /// Contact angle of a ball bearing, if a letter states it. \[deg\]
    pub contact_angle: Option<u32>,
}

/// Series of digits alone by kind. Those of four digits with the bore number have two, those of five have three.
const SERIES: [(&str, &str); 10] = [
    (
        "deep_groove_ball",
        "60 62 63 64 160 161 617 618 619 622 623 628 630 637 638 639",
    ),
    ("deep_groove_ball_double_row", "42 43"),
    ("angular_contact_ball", "70 72 73 718 719"),
    ("angular_contact_ball_double_row", "32 33"),
    ("self_aligning_ball", "12 13 22 23 112 130 139"),
    ("tapered_roller", "302 303 313 320 322 323 329 330 331 332"),
    ("spherical_roller", "213 222 223 230 231 232 238 239 240 241 248 249"),
    ("spherical_roller_thrust", "292 293 294"),
    ("thrust_ball", "511 512 513 514"),
    ("cylindrical_roller_thrust", "811 812 893 894"),
];

/// Letters before the series.
const LETTERS: [(&str, &str); 5] = [
    ("cylindrical_roller", "NU NJ NUP N NF"),
    ("cylindrical_roller_full_complement", "NCF NNCF NNF NJG"),
    ("four_point_contact_ball", "QJ"),
    ("needle_cage", "HK BK NK NKI NA RNA"),
    ("toroidal_roller", "C"),
];

/// Reads the basic designation at the start of a designation; `None` if the usual series do not have it.
pub fn basic_designation(designation: &str) -> Option<BasicDesignation> {
    let bare: String = designation.chars().filter(|c| !c.is_whitespace()).collect();
    let bare = bare.to_ascii_uppercase();
    let (letters, rest) = bare.split_at(bare.find(|c: char| !c.is_ascii_alphabetic())?);
    let (digits, rest) = rest.split_at(rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len()));
    // `62/22` has its bore behind the stroke; `1380/1328` is an inch size.
    let stroke = rest.strip_prefix('/').map(|rest| {
        let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        rest.split_at(end)
    });
    let (series, bore, suffix) = match stroke.filter(|(bore, _)| !bore.is_empty()) {
        Some((bore, suffix)) => (digits, bore.parse().ok(), suffix),
        // Bores below 10 mm: `608`, `625`.
        None if letters.is_empty() && digits.len() == 3 && digits.starts_with('6') => {
            let (series, bore) = digits.split_at(2);
            (series, bore.parse().ok().filter(|bore| *bore > 0.0), rest)
        }
        None if digits.len() > 2 => {
            let (series, code) = digits.split_at(digits.len() - 2);
            (series, bore_of_code(code), rest)
        }
        None => return None,
    };
    let suffix = suffix.trim_start_matches(['-', '.', '_']);
    let basic = |kind, series: Option<String>, bore| BasicDesignation {
        kind,
        series,
        bore,
        contact_angle: None,
    };
    if !letters.is_empty() {
        let (kind, _) = LETTERS
            .iter()
            .find(|(_, all)| all.split(' ').any(|known| known == letters))?;
        return match *kind {
            "cylindrical_roller" if matches!(series.len(), 1 | 2) => Some(basic(kind, Some(series.to_owned()), bore)),
            "four_point_contact_ball" if matches!(series.len(), 1 | 2) => {
                Some(basic(kind, Some(format!("QJ{series}")), bore))
            }
            "toroidal_roller" if series.len() == 2 => {
                let kind = if suffix.starts_with('V') {
                    "toroidal_roller_full_complement"
                } else {
                    kind
                };
                Some(basic(kind, Some(format!("C{series}")), bore))
            }
            "needle_cage" if letters == "NA" && series.len() == 2 => {
                Some(basic(kind, Some(format!("NA{series}")), bore))
            }
            // The numbers of the others are not those of a bore code.
            "needle_cage" => Some(basic(kind, None, None)),
            "cylindrical_roller_full_complement" => Some(basic(kind, Some(series.to_owned()), bore)),
            _ => None,
        };
    }
    let (kind, _) = SERIES
        .iter()
        .find(|(_, all)| all.split(' ').any(|known| known == series))?;
    let starts = |letters: &[&'static str]| letters.iter().copied().find(|start| suffix.starts_with(start));
    let (letter, contact_angle) = match *kind {
        "angular_contact_ball" => match starts(&["BE", "B", "AC", "A5", "A", "C"]) {
            Some(letter @ ("BE" | "B")) => (Some(letter), Some(40)),
            Some("AC") => (Some("AC"), Some(25)),
            Some("A5") => (Some("A"), Some(25)),
            Some("A") => (Some("A"), Some(30)),
            Some(letter) => (Some(letter), Some(15)),
            None => (None, None),
        },
        "angular_contact_ball_double_row" => match starts(&["A", "D"]) {
            Some("D") => (Some("D"), Some(45)),
            Some(letter) => (Some(letter), Some(30)),
            None => (None, None),
        },
        "tapered_roller" if series == "320" => (starts(&["X"]), None),
        "tapered_roller" if matches!(series, "322" | "323") => (starts(&["B"]), None),
        _ => (None, None),
    };
    // The E design of roller bearings is written without a space.
    let is_e = matches!(series, "213" | "222" | "223" | "292" | "293" | "294") && suffix.starts_with('E');
    let series = match letter {
        Some(letter) => format!("{series} {letter}"),
        None if is_e => format!("{series}E"),
        None => series.to_owned(),
    };
    Some(BasicDesignation {
        contact_angle,
        ..basic(kind, Some(series), bore)
    })
}

/// Bore of the last two digits. \[mm\]
fn bore_of_code(code: &str) -> Option<f64> {
    match code.parse::<u32>().ok()? {
        0 => Some(10.0),
        1 => Some(12.0),
        2 => Some(15.0),
        3 => Some(17.0),
        code if code <= 96 => Some(5.0 * f64::from(code)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn usual_designations_state_kind_series_and_bore() {
        for (designation, kind, series, bore) in [
            ("6208-2RS1/C3", "deep_groove_ball", Some("62"), Some(40.0)),
            ("6200", "deep_groove_ball", Some("62"), Some(10.0)),
            ("608", "deep_groove_ball", Some("60"), Some(8.0)),
            ("62/22", "deep_groove_ball", Some("62"), Some(22.0)),
            ("16008", "deep_groove_ball", Some("160"), Some(40.0)),
            ("7208 BECBP", "angular_contact_ball", Some("72 BE"), Some(40.0)),
            ("7208-B-TVP", "angular_contact_ball", Some("72 B"), Some(40.0)),
            ("7008 AC", "angular_contact_ball", Some("70 AC"), Some(40.0)),
            ("3208 A-2Z", "angular_contact_ball_double_row", Some("32 A"), Some(40.0)),
            ("3308 DMA", "angular_contact_ball_double_row", Some("33 D"), Some(40.0)),
            ("NU 208 ECP", "cylindrical_roller", Some("2"), Some(40.0)),
            ("NU 2208", "cylindrical_roller", Some("22"), Some(40.0)),
            ("N208", "cylindrical_roller", Some("2"), Some(40.0)),
            ("NU 1008 ML", "cylindrical_roller", Some("10"), Some(40.0)),
            ("QJ 308 N2MA", "four_point_contact_ball", Some("QJ3"), Some(40.0)),
            ("NA 4908", "needle_cage", Some("NA49"), Some(40.0)),
            ("HK 1616", "needle_cage", None, None),
            ("32008 X/Q", "tapered_roller", Some("320 X"), Some(40.0)),
            ("32208 BJ2/Q", "tapered_roller", Some("322 B"), Some(40.0)),
            ("32313", "tapered_roller", Some("323"), Some(65.0)),
            ("22208 EK", "spherical_roller", Some("222E"), Some(40.0)),
            ("23022 CC/W33", "spherical_roller", Some("230"), Some(110.0)),
            ("230/500", "spherical_roller", Some("230"), Some(500.0)),
            ("29412 E", "spherical_roller_thrust", Some("294E"), Some(60.0)),
            (
                "NCF 3008 CV",
                "cylindrical_roller_full_complement",
                Some("30"),
                Some(40.0),
            ),
            ("51108", "thrust_ball", Some("511"), Some(40.0)),
            ("C 2208 V", "toroidal_roller_full_complement", Some("C22"), Some(40.0)),
        ] {
            let found = basic_designation(designation).unwrap();
            assert_eq!(
                (found.kind, found.series.as_deref(), found.bore),
                (kind, series, bore),
                "{designation}"
            );
        }
        for (designation, degrees) in [
            ("7208 C", 15),
            ("7208 A5", 25),
            ("7208 AC", 25),
            ("7208 A", 30),
            ("7208 B", 40),
        ] {
            let found = basic_designation(designation).unwrap();
            assert_eq!(found.contact_angle, Some(degrees), "{designation}");
        }
        for other in ["1380/1328", "W 100", "62O5", "X", "", "LM11949", "2608"] {
            assert_eq!(basic_designation(other), None, "{other}");
        }
    }
}
