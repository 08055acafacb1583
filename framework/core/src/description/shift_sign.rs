//! The sign of profile shifts.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sign of the profile shift of internal teeth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ShiftSign {
    /// ISO 21771 and DIN 3960: a positive shift thickens the teeth and moves their tips towards the axis of the ring gear. A larger
    /// sum x1 + x2 reduces the centre distance of the pair.
    Iso21771,
    /// A positive shift moves the teeth away from the axis, the opposite of ISO 21771: the meaning of documents that do not
    /// state a sign.
    Outward,
}

impl ShiftSign {
    /// A profile shift of internal teeth, converted to ISO 21771.
    pub fn standard(sign: Option<Self>, shift: f64) -> f64 {
        if sign == Some(Self::Iso21771) { shift } else { -shift }
    }
}
