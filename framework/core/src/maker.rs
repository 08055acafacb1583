//! Designations of rolling bearings without the name of a maker and without separators.

/// Names of makers before a designation.
const MAKERS: &[&str] = &[
    "SKF",
    "FAG",
    "INA",
    "SCHAEFFLER",
    "NSK",
    "NTN",
    "SNR",
    "KOYO",
    "JTEKT",
    "TIMKEN",
    "NACHI",
    "NKE",
    "RHP",
    "ZKL",
    "URB",
    "IBC",
    "ZWZ",
    "HRB",
    "LYC",
    "KBC",
    "FBJ",
];

/// Whether a character separates parts of a designation.
pub(crate) fn separates(c: char) -> bool {
    matches!(c, '-' | '/' | '.' | '_') || c.is_whitespace()
}

/// The maker before a designation and what is behind it; `None` without one.
pub(crate) fn before(written: &str) -> Option<(&'static str, &str)> {
    let written = written.trim_start();
    MAKERS.iter().find_map(|maker| {
        let (start, rest) = written.split_at_checked(maker.len())?;
        let is_whole = start.eq_ignore_ascii_case(maker) && rest.starts_with(separates);
        is_whole.then(|| (*maker, rest.trim_start_matches(separates)))
    })
}

/// A designation in capital letters without the maker and without separators: `SKF NU 205-ECP` is `NU205ECP`.
pub(crate) fn bare(designation: &str) -> String {
    let rest = before(designation).map_or(designation, |(_, rest)| rest);
    let letters = rest.chars().filter(|c| !separates(*c));
    letters.map(|c| c.to_ascii_uppercase()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_maker_and_separators_are_omitted() {
        for (written, plain) in [
            ("SKF NU 205-ECP", "NU205ECP"),
            ("nu 205", "NU205"),
            ("SKFX", "SKFX"),
            ("Öl 1", "ÖL1"),
        ] {
            // Letters of other alphabets stay as they are.
            assert_eq!(bare(written).to_uppercase(), plain, "{written}");
        }
        assert_eq!(before("fag 6208"), Some(("FAG", "6208")));
        assert_eq!(before("FAG6208"), None);
    }
}
