//! Ranges of plausible values.

use schemars::JsonSchema;
use serde::Deserialize;

/// Ranges of plausible values: a value outside is reported as a warning. The defaults are the judgement of this program, not limits of a standard.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct PlausibilityEntry {
    /// Least shared face width of a pair of gears over the narrower face width. Faces are often offset or differ by a few percent on
    /// purpose. [-]
    #[serde(default = "face_overlap")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub face_overlap: f64,
    /// Largest amount of a profile shift coefficient that is not stated and follows from the centre distance only, and of the sum if
    /// neither is stated. Designs according to DIN 3992 are within the default except for pinions with few teeth, whose shift is stated.
    /// One tooth too many changes the sum by about 0.5. [-]
    #[serde(default = "profile_shift")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub profile_shift: f64,
    /// Least clearance between a tip and the root of the mate, in normal modules. The basic racks of ISO 53 have 0.25. [-]
    #[serde(default = "tip_clearance")]
    #[schemars(range(min = -10.0, max = 10.0))]
    pub tip_clearance: f64,
    /// Least tooth width at the tip of an external gear, in normal modules. [-]
    #[serde(default = "tip_width")]
    #[schemars(range(min = -10.0, max = 10.0))]
    pub tip_width: f64,
    /// Largest amount by which a profile shift coefficient may be below that at which undercut begins. The default is that of 14 instead
    /// of 17 teeth without profile shift, the usual practical limit. [-]
    #[serde(default = "undercut")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub undercut: f64,
    /// Largest amount of the specific sliding at the lowest points of the contacting flanks, which grows without bound as contact
    /// approaches the base circle. Gears without profile shift reach 6 to 11. [-]
    #[serde(default = "specific_sliding")]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub specific_sliding: f64,
    /// Least kinematic viscosity of an oil at 40 degC. Water has 0.66 mm2/s. [mm2/s]
    #[serde(default = "least_kv40")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub least_kv40: f64,
    /// Greatest kinematic viscosity of an oil at 40 degC. ISO VG 3200 has 3200 mm2/s, fluids of open gears up to some ten thousand. [mm2/s]
    #[serde(default = "greatest_kv40")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub greatest_kv40: f64,
    /// Least viscosity index of an oil. [-]
    #[serde(default = "least_viscosity_index")]
    #[schemars(range(min = -10000.0, max = 10000.0))]
    pub least_viscosity_index: f64,
    /// Greatest viscosity index of an oil. Mineral oils have about 100, polyglycols and oils with polymers up to some 300. [-]
    #[serde(default = "greatest_viscosity_index")]
    #[schemars(range(min = -10000.0, max = 10000.0))]
    pub greatest_viscosity_index: f64,
}

impl Default for PlausibilityEntry {
    fn default() -> Self {
        Self {
            face_overlap: face_overlap(),
            profile_shift: profile_shift(),
            tip_clearance: tip_clearance(),
            tip_width: tip_width(),
            undercut: undercut(),
            specific_sliding: specific_sliding(),
            least_kv40: least_kv40(),
            greatest_kv40: greatest_kv40(),
            least_viscosity_index: least_viscosity_index(),
            greatest_viscosity_index: greatest_viscosity_index(),
        }
    }
}

fn least_kv40() -> f64 {
    1e-6
}

fn greatest_kv40() -> f64 {
    10_000e-6
}

fn least_viscosity_index() -> f64 {
    -200.0
}

fn greatest_viscosity_index() -> f64 {
    400.0
}

fn face_overlap() -> f64 {
    0.9
}

fn profile_shift() -> f64 {
    0.5
}

fn tip_clearance() -> f64 {
    0.1
}

fn tip_width() -> f64 {
    0.2
}

fn undercut() -> f64 {
    3.0 / 17.0
}

fn specific_sliding() -> f64 {
    20.0
}
