//! The kind of a bearing from a word of its maker.

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
        .find(|(kind, words)| kind.replace('_', "") == plain || words.split_whitespace().any(|known| known == plain));
    found.map(|(kind, _)| *kind)
}

/// The kinds of gearbox files.
pub(super) fn all() -> impl Iterator<Item = &'static str> {
    WORDS.iter().map(|(kind, _)| *kind)
}
