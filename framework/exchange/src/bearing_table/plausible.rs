//! Values that bearings do not have: usually a wrong column or unit.

use gearloss_document::Diagnostic;
use gearloss_framework::resolve::CatalogueTable;

use super::{Row, warning};

/// C0/C by kind: that of the bearings of the shipped catalogue with a margin; of kinds that it does not have, that of similar ones.
pub(super) const STATIC_TO_DYNAMIC: [(&str, [f64; 2]); 17] = [
    ("deep_groove_ball", [0.25, 2.0]),
    ("deep_groove_ball_double_row", [0.3, 2.0]),
    ("self_aligning_ball", [0.15, 1.0]),
    ("angular_contact_ball", [0.35, 1.6]),
    ("angular_contact_ball_double_row", [0.4, 1.8]),
    ("four_point_contact_ball", [0.4, 2.0]),
    ("thrust_ball", [1.0, 8.0]),
    ("cylindrical_roller", [0.6, 2.5]),
    ("cylindrical_roller_full_complement", [0.7, 3.0]),
    ("needle_cage", [0.6, 4.0]),
    ("tapered_roller", [0.6, 3.0]),
    ("spherical_roller", [0.7, 3.0]),
    ("toroidal_roller", [0.7, 3.0]),
    ("toroidal_roller_full_complement", [0.7, 3.5]),
    ("cylindrical_roller_thrust", [2.0, 8.0]),
    ("needle_roller_thrust", [2.0, 12.0]),
    ("spherical_roller_thrust", [1.8, 7.0]),
];
/// C0/C of any kind.
const STATIC_TO_DYNAMIC_OF_ANY: [f64; 2] = [0.15, 12.0];
/// C per area of the section, C / ((D - d) B): bearings have 20 to 200. \[N/mm2\]
const RATING_PER_AREA: [f64; 2] = [4.0, 800.0];
/// Pu/C0: 1/22 (ball) to 1/8.2 (roller) by ISO 281, less for large bearings.
const FATIGUE_TO_STATIC: [f64; 2] = [0.01, 0.2];
/// Speed times mean diameter. \[mm/min\]
const SPEED_DIAMETER: [f64; 2] = [5e3, 3e6];

/// True if a gearbox can have it: a bore and a larger outside diameter.
pub(super) fn can_be_built(row: &Row) -> bool {
    matches!((row.number("bore"), row.number("outside")), (Some(bore), Some(outside)) if bore > 0.0 && outside > bore)
}

pub(super) fn check(row: &Row, name: &str, shipped: Option<&CatalogueTable>, warnings: &mut Vec<Diagnostic>) {
    let mut warn = |message: String, help: &str| {
        warnings.push(warning(
            format!("{name}: line {}: `{}`: {message}", row.line, row.designation),
            help,
        ));
    };
    let [bore, outside, width, c, c0, pu] = ["bore", "outside", "width", "c", "c0", "pu"].map(|key| row.number(key));
    let (Some(bore), Some(outside)) = (bore, outside) else {
        warn(
            "bore or outside diameter is blank; this row is omitted".to_owned(),
            "complete it",
        );
        return;
    };
    if !can_be_built(row) {
        warn(
            format!("the outside diameter {outside} mm is not larger than the bore {bore} mm; this row is omitted"),
            "check the columns of d and D",
        );
        return;
    }
    for (key, number) in &row.numbers {
        if *number <= 0.0 && !matches!(*key, "e" | "y" | "y0") {
            warn(
                format!("{key} is {number}, not above zero"),
                "correct it, or leave the cell blank",
            );
        }
    }
    let outside_of = |value: f64, [low, high]: [f64; 2]| value > 0.0 && !(low..=high).contains(&value);
    if let (Some(c), Some(c0)) = (c, c0)
        && outside_of(c0 / c, static_to_dynamic(row))
    {
        let [low, high] = static_to_dynamic(row);
        warn(
            format!("C0/C is {:.3}, usually {low} to {high}", c0 / c),
            "check both columns and their units",
        );
    }
    if let (Some(c), Some(width)) = (c, width)
        && outside_of(c / ((outside - bore) * width), RATING_PER_AREA)
    {
        let ratio = c / ((outside - bore) * width);
        warn(
            format!("C is {c} N, {ratio:.3} N/mm2 of its section, usually 20 to 200"),
            "check the unit of C: N or kN",
        );
    }
    if let (Some(pu), Some(c0)) = (pu, c0)
        && outside_of(pu / c0, FATIGUE_TO_STATIC)
    {
        warn(
            format!("Pu/C0 is {:.4}, usually 0.02 to 0.12", pu / c0),
            "check the unit of Pu: N or kN",
        );
    }
    for key in ["reference_speed", "limiting_speed"] {
        let speed = row
            .number(key)
            .filter(|speed| outside_of(speed * (bore + outside) / 2.0, SPEED_DIAMETER));
        if let Some(speed) = speed {
            warn(
                format!("{key} is {speed} rpm, which no bearing of this size has"),
                "check the column and its unit",
            );
        }
    }
    if let Some([own_bore, own_outside]) = shipped_sizes(shipped, &row.designation)
        && ((own_bore - bore).abs() > 0.01 || (own_outside - outside).abs() > 0.01)
    {
        warn(
            format!("d {bore} mm, D {outside} mm; the shipped catalogue has {own_bore} and {own_outside} mm"),
            "check the designation and the columns",
        );
    }
}

fn static_to_dynamic(row: &Row) -> [f64; 2] {
    let of_kind = STATIC_TO_DYNAMIC
        .iter()
        .find(|(kind, _)| row.kind.as_deref() == Some(kind));
    of_kind.map_or(STATIC_TO_DYNAMIC_OF_ANY, |(_, range)| *range)
}

/// Bore and outside diameter of a designation of the shipped catalogue. \[mm\]
fn shipped_sizes(shipped: Option<&CatalogueTable>, designation: &str) -> Option<[f64; 2]> {
    let row = shipped?.0.get(designation)?;
    let size = |key: &str| {
        let (_, value) = row.values.iter().find(|(name, _)| name == key)?;
        value.as_str()?.split_once(' ')?.0.parse::<f64>().ok()
    };
    Some([size("bore")?, size("outside")?])
}
