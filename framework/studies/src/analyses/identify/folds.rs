//! Groups of rows for cross-validation.

use gearloss_numerics::inference::Fold;
use schemars::JsonSchema;
use serde::Serialize;

use super::found::Found;
use crate::numbers::RPM;
use crate::study::FoldsEntry;

/// Cross-validation errors of groups of rows.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FoldsOfSet {
    /// Grouping of the rows.
    pub by: String,
    /// Root mean square of the errors relative to the accuracies. [-]
    pub rms: f64,
    /// The groups.
    pub bands: Vec<FoldOfSet>,
}

/// One group.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FoldOfSet {
    /// The group as text.
    pub name: String,
    /// Minimum torque; only for groups by torque. [Nm]
    pub from_nm: Option<f64>,
    /// Maximum torque; only for groups by torque. [Nm]
    pub to_nm: Option<f64>,
    /// Number of its points.
    pub points: usize,
    /// Root mean square of their errors relative to the accuracies. [-]
    pub rms: f64,
}

impl FoldsOfSet {
    /// Absent if not requested or if there are none.
    pub(super) fn new(found: &Found, entry: &FoldsEntry) -> Option<Self> {
        let Some(Ok((folds, validation))) = &found.folds else {
            return None;
        };
        let by_torque = fold_unit(entry) == "Nm";
        let fold = |(fold, rms): (&Fold, f64)| {
            let band = fold.band.filter(|_| by_torque);
            FoldOfSet {
                name: fold_name(fold, entry),
                from_nm: band.map(|band| band[0]),
                to_nm: band.map(|band| band[1]),
                points: fold.points.len(),
                rms,
            }
        };
        Some(Self {
            by: match entry {
                FoldsEntry::Torques(_) => "torque".to_owned(),
                FoldsEntry::By(by) => by.by.clone(),
            },
            rms: validation.rms,
            bands: folds.iter().zip(validation.fold_rms()).map(fold).collect(),
        })
    }
}

/// Unit of the bands of rows; empty for groups that are not bands, and for groups of a column.
fn fold_unit(entry: &FoldsEntry) -> &'static str {
    match entry {
        FoldsEntry::Torques(_) => "Nm",
        FoldsEntry::By(by) => match by.by.as_str() {
            "torque" => "Nm",
            "speed" => "rpm",
            "oil_temperature" => "degC",
            _ => "",
        },
    }
}

/// A group as text.
fn fold_name(fold: &Fold, entry: &FoldsEntry) -> String {
    let [from, to] = match (&fold.label, fold.band) {
        (Some(label), _) => return label.clone(),
        (None, Some(band)) => band,
        (None, None) => return String::new(),
    };
    let [first, last] = [format!("{from:.1}"), format!("{to:.1}")];
    let band = if first == last {
        first
    } else {
        format!("{first} to {last}")
    };
    match fold_unit(entry) {
        "rpm" if (from - to).abs() * RPM < 0.5 => format!("{:.0} rpm", from * RPM),
        "rpm" => format!("{:.0} to {:.0} rpm", from * RPM, to * RPM),
        "" => band,
        unit => format!("{band} {unit}"),
    }
}
