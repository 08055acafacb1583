//! Keys that follow from the designation or from other columns: kind, series, and the axial factors that the contact angle determines.
//!
//! Source: ISO 281 (e, Y) and ISO 76 (Y0). Of tapered, spherical and self-aligning bearings e = 1.5 tan(alpha), and Y and Y0 are
//! factors of cot(alpha); for single-row angular contact ball bearings the values are tabulated by angle.

use gearloss_framework::resolve::basic_designation;

use super::{Row, numbers};

/// Where a derived key is from.
const DESIGNATION: &str = "the series in the designation";
const ANGLE: &str = "the contact angle in the designation";
const LIMIT: &str = "column e";

/// Single-row angular contact ball bearings: contact angle in degrees, e, Y, Y0.
const ANGULAR: [(u32, f64, f64, f64); 3] = [(25, 0.68, 0.87, 0.38), (30, 0.80, 0.76, 0.33), (40, 1.14, 0.57, 0.26)];
/// Y0 of single-row ones at 15 degrees, whose e and Y depend on the load.
const Y0_15: f64 = 0.46;
/// Double-row angular contact ball bearings: contact angle in degrees, e, Y beyond it, Y0.
const DOUBLE_ROW: [(u32, f64, f64, f64); 2] = [(30, 0.80, 1.24, 0.66), (45, 1.34, 0.81, 0.44)];

/// Y and Y0 times e: factors of cot(alpha) times 1.5, for loads beyond e.
fn factors_of_limit(kind: &str) -> Option<(f64, f64)> {
    match kind {
        "tapered_roller" => Some((0.4 * 1.5, 0.22 * 1.5)),
        "spherical_roller" => Some((0.67 * 1.5, 0.44 * 1.5)),
        "self_aligning_ball" => Some((0.65 * 1.5, 0.44 * 1.5)),
        _ => None,
    }
}

/// Fills the keys that the table does not have.
pub(super) fn complete(row: &mut Row) {
    let basic = basic_designation(&row.designation);
    if row.kind.is_none()
        && let Some(basic) = &basic
    {
        row.kind = Some(basic.kind.to_owned());
        row.derived.insert("kind", DESIGNATION);
    }
    let Some(kind) = row.kind.clone() else { return };
    // A designation that a maker uses for another kind says nothing about the series.
    let basic = basic.filter(|basic| basic.kind == kind);
    if !row.texts.contains_key("series")
        && let Some(series) = basic.as_ref().and_then(|basic| basic.series.clone())
    {
        row.texts.insert("series", series);
        row.derived.insert("series", DESIGNATION);
    }
    let angle = basic.and_then(|basic| basic.contact_angle);
    match (kind.as_str(), angle) {
        ("angular_contact_ball", Some(15)) => put(row, "y0", Y0_15, ANGLE),
        ("angular_contact_ball", Some(angle)) => {
            if let Some((_, e, y, y0)) = ANGULAR.iter().find(|row| row.0 == angle) {
                put_all(row, [*e, *y, *y0]);
            }
        }
        ("angular_contact_ball_double_row", Some(angle)) => {
            if let Some((_, e, y, y0)) = DOUBLE_ROW.iter().find(|row| row.0 == angle) {
                put_all(row, [*e, *y, *y0]);
            }
        }
        _ => {}
    }
    if let Some((y, y0)) = factors_of_limit(&kind)
        && let Some(e) = row.number("e").filter(|e| *e > 0.0)
    {
        put(row, "y", hundredths(y / e), LIMIT);
        put(row, "y0", hundredths(y0 / e), LIMIT);
    }
}

/// Factors of catalogues have two decimals.
fn hundredths(factor: f64) -> f64 {
    numbers::rounded((factor * 100.0).round() / 100.0)
}

fn put_all(row: &mut Row, values: [f64; 3]) {
    for (key, value) in ["e", "y", "y0"].into_iter().zip(values) {
        put(row, key, value, ANGLE);
    }
}

fn put(row: &mut Row, key: &'static str, value: f64, from: &'static str) {
    if !row.numbers.contains_key(key) {
        row.numbers.insert(key, value);
        row.derived.insert(key, from);
    }
}
