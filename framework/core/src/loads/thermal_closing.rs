//! What temperature makes of the closing of a pair of bearings.
//!
//! Derived: an outer raceway is a cone whose tip is D/(2 tan a) beside the contacts. Growth of the shaft with inner rings and elements moves the
//! tips of both cones apart or together, as the bearings do along the shaft, and the contacts outwards.

use schemars::JsonSchema;
use serde::Serialize;

/// How two bearings with a contact angle are mounted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mounting {
    /// X arrangement: each takes the thrust away from the other one.
    FaceToFace,
    /// O arrangement: each takes the thrust towards the other one.
    BackToBack,
}

impl Mounting {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::FaceToFace => "face to face",
            Self::BackToBack => "back to back",
        }
    }

    /// What a longer distance does to the closing if the shaft grows.
    pub fn sign(self) -> f64 {
        match self {
            Self::FaceToFace => 1.0,
            Self::BackToBack => -1.0,
        }
    }
}

/// What the closing of a pair depends on when temperatures change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThermalClosing {
    /// How the bearings are mounted.
    pub mounting: Mounting,
    /// Mean diameters of the contacts with the outer rings. \[m\]
    pub diameter: [f64; 2],
    /// Contact angles. \[rad\]
    pub contact_angle: [f64; 2],
    /// Distance of these contacts along the axis. \[m\]
    pub distance: f64,
    /// Expansion of the shaft with inner rings and elements. \[1/K\]
    pub shaft: f64,
    /// Expansion of the outer rings across the axis. \[1/K\]
    pub outer_rings: f64,
    /// Expansion of the housing along the axis. \[1/K\]
    pub housing: f64,
}

impl ThermalClosing {
    /// Change of the closing of the pair per kelvin of the shaft and of the housing with the outer rings:
    /// a (D1/(2 tan a1) + D2/(2 tan a2) + s L) of the shaft less the same of the housing, with s = 1 face to face, -1 back to back. \[m/K\]
    pub fn per_kelvin(&self) -> [f64; 2] {
        let (across, along) = (self.neutral_distance(), self.mounting.sign() * self.distance);
        [
            self.shaft * (across + along),
            -(self.outer_rings * across + self.housing * along),
        ]
    }

    /// Distance at which equal temperatures do not change the closing of a pair back to back of one material. \[m\]
    pub fn neutral_distance(&self) -> f64 {
        let cones = self.diameter.iter().zip(&self.contact_angle);
        cones.map(|(diameter, angle)| 0.5 * diameter / angle.tan()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::assert_close;

    /// By hand, of the formula: 60 K of the shaft, 45 K of the housing.
    #[test]
    fn temperature_closes_or_opens_a_pair() {
        let pair = |mounting, housing| ThermalClosing {
            mounting,
            diameter: [0.070, 0.060],
            contact_angle: [14.0_f64.to_radians(); 2],
            distance: 0.120,
            shaft: 11.5e-6,
            outer_rings: housing,
            housing,
        };
        for (mounting, housing, closing) in [
            (Mounting::FaceToFace, 11.5e-6, 0.065_670_881_2),
            (Mounting::BackToBack, 11.5e-6, 0.024_270_881_2),
            (Mounting::FaceToFace, 23e-6, -0.131_341_762_4),
            (Mounting::BackToBack, 23e-6, -0.048_541_762_4),
        ] {
            let [of_shaft, of_housing] = pair(mounting, housing).per_kelvin();
            assert_close(60.0 * of_shaft + 45.0 * of_housing, 1e-3 * closing, 1e-8);
        }
        let neutral = pair(Mounting::BackToBack, 11.5e-6);
        assert_close(neutral.neutral_distance(), 0.260_700_760_7, 1e-9);
        let distance = neutral.neutral_distance();
        assert_eq!(ThermalClosing { distance, ..neutral }.per_kelvin(), [0.0, -0.0]);
    }

    /// Loose rings of steel in aluminium grow less than the housing across the axis.
    #[test]
    fn loose_outer_rings_grow_as_steel() {
        let pair = ThermalClosing {
            mounting: Mounting::FaceToFace,
            diameter: [0.1; 2],
            contact_angle: [45.0_f64.to_radians(); 2],
            distance: 0.1,
            shaft: 11.5e-6,
            outer_rings: 11.5e-6,
            housing: 23e-6,
        };
        let [of_shaft, of_housing] = pair.per_kelvin();
        assert_close(of_shaft, 2.3e-6, 1e-12);
        assert_close(of_housing, -(1.15e-6 + 2.3e-6), 1e-12);
    }
}
