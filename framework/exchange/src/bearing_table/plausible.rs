//! Values that bearings do not have: usually a wrong column or unit.

use gearloss_document::Diagnostic;
use gearloss_framework::resolve::CatalogueTable;

use super::{Row, warning};

/// C0/C of radial and thrust bearings of all kinds: 0.4 for small balls, 4 for rollers between washers.
const STATIC_TO_DYNAMIC: [f64; 2] = [0.25, 6.0];
/// C0/C of self-aligning ball bearings, whose outer raceway touches the balls in nearly a point: 0.21 to 0.5.
const STATIC_TO_DYNAMIC_SELF_ALIGNING: [f64; 2] = [0.15, 1.0];
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
    match row.kind.as_deref() {
        Some("self_aligning_ball") => STATIC_TO_DYNAMIC_SELF_ALIGNING,
        _ => STATIC_TO_DYNAMIC,
    }
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
