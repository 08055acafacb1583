//! The kind of a bearing from a word of its maker, or from the series in its designation.

/// Kinds of gearbox files with words of makers, in lower case without signs and spaces.
const WORDS: [(&str, &str); 17] = [
    (
        "deep_groove_ball",
        "deepgrooveball deepgrooveballbearing deepgrooveballbearings singlerowdeepgrooveballbearing rillenkugellager",
    ),
    (
        "deep_groove_ball_double_row",
        "doublerowdeepgrooveballbearing zweireihigesrillenkugellager rillenkugellagerzweireihig",
    ),
    (
        "self_aligning_ball",
        "selfaligningball selfaligningballbearing selfaligningballbearings pendelkugellager",
    ),
    (
        "angular_contact_ball",
        "angularcontactball angularcontactballbearing angularcontactballbearings singlerowangularcontactballbearing schrägkugellager",
    ),
    (
        "angular_contact_ball_double_row",
        "doublerowangularcontactballbearing zweireihigesschrägkugellager schrägkugellagerzweireihig",
    ),
    (
        "four_point_contact_ball",
        "fourpointcontactball fourpointcontactballbearing fourpointcontactbearing vierpunktlager",
    ),
    (
        "thrust_ball",
        "thrustball thrustballbearing thrustballbearings axialrillenkugellager axialkugellager",
    ),
    (
        "cylindrical_roller",
        "cylindricalroller cylindricalrollerbearing cylindricalrollerbearings zylinderrollenlager",
    ),
    (
        "cylindrical_roller_full_complement",
        "fullcomplementcylindricalrollerbearing vollrolligeszylinderrollenlager zylinderrollenlagervollrollig",
    ),
    (
        "needle_cage",
        "needlerollerbearing needlerollerbearings needlerollerandcageassembly drawncupneedlerollerbearing nadellager nadelkranz nadelhülse",
    ),
    (
        "tapered_roller",
        "taperedroller taperedrollerbearing taperedrollerbearings kegelrollenlager",
    ),
    (
        "spherical_roller",
        "sphericalroller sphericalrollerbearing sphericalrollerbearings pendelrollenlager",
    ),
    (
        "toroidal_roller",
        "toroidalroller carbtoroidalrollerbearing toroidalrollerbearing toroidalrollenlager carb",
    ),
    ("toroidal_roller_full_complement", "fullcomplementtoroidalrollerbearing"),
    (
        "cylindrical_roller_thrust",
        "cylindricalrollerthrustbearing axialzylinderrollenlager",
    ),
    (
        "needle_roller_thrust",
        "needlerollerthrustbearing axialnadellager axialnadelkranz",
    ),
    (
        "spherical_roller_thrust",
        "sphericalrollerthrustbearing axialpendelrollenlager",
    ),
];

/// The kind of a word.
pub(super) fn from_words(text: &str) -> Option<&'static str> {
    let plain: String = text.to_lowercase().chars().filter(|c| c.is_alphanumeric()).collect();
    let found = WORDS
        .iter()
        .find(|(kind, words)| kind.replace('_', "") == plain || words.split_whitespace().any(|own| own == plain));
    found.map(|(kind, _)| *kind)
}

/// The kinds of gearbox files.
pub(super) fn all() -> impl Iterator<Item = &'static str> {
    WORDS.iter().map(|(kind, _)| *kind)
}

/// The kind of the usual series (DIN 623-1). Only whole basic designations of digits count: bore number of two digits, or bores after a
/// stroke.
pub(super) fn from_designation(designation: &str) -> Option<&'static str> {
    let bare: String = designation.chars().filter(|c| *c != ' ').collect();
    let letters: String = bare.chars().take_while(char::is_ascii_alphabetic).collect();
    let digits: String = bare[letters.len()..].chars().take_while(char::is_ascii_digit).collect();
    let is_usual = |lengths: &[usize]| lengths.contains(&digits.len());
    match letters.to_ascii_uppercase().as_str() {
        "NU" | "NJ" | "NUP" | "N" | "NF" if is_usual(&[3, 4]) => return Some("cylindrical_roller"),
        "NCF" | "NNCF" | "NNF" | "NJG" => return Some("cylindrical_roller_full_complement"),
        "QJ" => return Some("four_point_contact_ball"),
        "HK" | "BK" | "NK" | "NKI" | "NA" | "RNA" => return Some("needle_cage"),
        "" => {}
        _ => return None,
    }
    let starts = |series: &[&str]| series.iter().any(|own| digits.starts_with(own));
    match digits.len() {
        5 if starts(&["302", "303", "313", "320", "322", "323", "329", "330", "331", "332"]) => Some("tapered_roller"),
        5 if starts(&[
            "213", "222", "223", "230", "231", "232", "238", "239", "240", "241", "248", "249",
        ]) =>
        {
            Some("spherical_roller")
        }
        5 if starts(&["292", "293", "294"]) => Some("spherical_roller_thrust"),
        5 if starts(&["511", "512", "513", "514"]) => Some("thrust_ball"),
        5 if starts(&["811", "812"]) => Some("cylindrical_roller_thrust"),
        5 if starts(&["160", "617", "618", "619", "622", "623", "630"]) => Some("deep_groove_ball"),
        4 if starts(&["60", "62", "63", "64"]) => Some("deep_groove_ball"),
        4 if starts(&["70", "72", "73"]) => Some("angular_contact_ball"),
        4 if starts(&["32", "33"]) => Some("angular_contact_ball_double_row"),
        4 if starts(&["42", "43"]) => Some("deep_groove_ball_double_row"),
        4 if starts(&["12", "13", "22", "23"]) => Some("self_aligning_ball"),
        _ => None,
    }
}
