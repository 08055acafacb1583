//! What is ground off the flanks of a gear, and the gap that it leaves between the flanks of a pair.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::geometry::Pair;

/// Modification of the flanks of one gear: what is removed from the involute.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FlankModification {
    /// Relief of the tip.
    pub tip_relief: Option<Relief>,
    /// Relief of the root.
    pub root_relief: Option<Relief>,
    /// Height of the crowning along the face; both ends are lower than the middle by it. [um]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub crowning: f64,
    /// Height of the crowning along the profile; first and last contact are lower than the middle of the path by it. [um]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub profile_crowning: f64,
    /// Slope of the profile over the path of contact, positive if the tip is lower. [um]
    #[serde(default)]
    #[schemars(range(min = -1000.0, max = 1000.0))]
    pub profile_slope: f64,
    /// Slope of the flank along the face, positive if the end of the face is lower than its start. [um]
    #[serde(default)]
    #[schemars(range(min = -1000.0, max = 1000.0))]
    pub helix_slope: f64,
    /// Pitch error of every second tooth along the line of action, positive if its flank lies behind that of its neighbours, which then carry
    /// more. [um]
    #[serde(default)]
    #[schemars(range(min = -1000.0, max = 1000.0))]
    pub pitch_error: f64,
}

/// Relief of tip or root.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Relief {
    /// Amount at the end of contact, normal to the flank in the transverse section. [um]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub amount: f64,
    /// Length along the path of contact; default: to the end of double contact, or half of the path from two pairs on. [mm]
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub length: Option<f64>,
    /// Diameter where it starts, instead of its length. [mm]
    #[schemars(range(min = 0.1, max = 1e4))]
    pub from_diameter: Option<f64>,
    /// Shape.
    #[serde(default)]
    pub shape: ReliefShape,
}

/// Shape of a relief.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ReliefShape {
    /// A straight line.
    #[default]
    Linear,
    /// A parabola that starts smoothly.
    Parabolic,
}

/// A relief at one end of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Placed {
    amount: f64,
    start: f64,
    length: f64,
    /// Plus one at the end of the path, minus one at its start.
    sense: f64,
    shape: ReliefShape,
}

impl Placed {
    fn gap(&self, x: f64) -> f64 {
        let t = ((x - self.start) * self.sense / self.length).max(0.0);
        self.amount
            * match self.shape {
                ReliefShape::Linear => t,
                ReliefShape::Parabolic => t * t,
            }
    }
}

/// The gap between unloaded flanks of a pair over its plane of action.
#[derive(Debug, Clone, PartialEq)]
pub struct Gap {
    reliefs: Vec<Placed>,
    /// Middle of the path and half of its length. \[m\]
    middle: f64,
    half: f64,
    profile_crowning: f64,
    /// Rise over half of the path.
    profile_slope: f64,
    crowning: f64,
    /// Slope of both helices and misalignment together over the face. \[m\]
    slope: f64,
    facewidth: f64,
    /// By how much every second pair of teeth lags behind its neighbours. \[m\]
    lag: f64,
    /// Growth of the slope with the line load of the mesh. \[m2/N\]
    yielding: f64,
}

impl Gap {
    /// The gap of a pair from the modifications of both gears and the misalignment over the face width, positive if the end of the face
    /// opens, with its growth with the line load of the mesh. \[m, m2/N\]
    ///
    /// # Errors
    /// A relief that does not fit the path, with the number of the gear and the key.
    pub fn new(
        pair: &Pair,
        gears: &[FlankModification; 2],
        (misalignment, yielding): (f64, f64),
    ) -> Result<Self, (usize, &'static str, String)> {
        let [start, .., end] = pair.points;
        let mut reliefs = Vec::new();
        for (gear, of) in gears.iter().enumerate() {
            for (key, relief) in [("tip_relief", of.tip_relief), ("root_relief", of.root_relief)] {
                let Some(relief) = relief else { continue };
                // The tip of the first gear and the root of the second one are in contact at the end.
                let at_end = (gear == 0) == (key == "tip_relief");
                let length = length(pair, gear, at_end, &relief).map_err(|fault| (gear, key, fault))?;
                if relief.amount > 0.0 {
                    reliefs.push(Placed {
                        amount: relief.amount,
                        start: if at_end { end - length } else { start + length },
                        length,
                        sense: if at_end { 1.0 } else { -1.0 },
                        shape: relief.shape,
                    });
                }
            }
        }
        Ok(Self {
            reliefs,
            middle: 0.5 * (start + end),
            half: 0.5 * (end - start),
            profile_crowning: gears.iter().map(|g| g.profile_crowning).sum(),
            // The tip of the second gear is at the start of the path.
            profile_slope: 0.5 * (gears[0].profile_slope - gears[1].profile_slope),
            crowning: gears.iter().map(|g| g.crowning).sum(),
            slope: gears.iter().map(|g| g.helix_slope).sum::<f64>() + misalignment,
            facewidth: pair.facewidth,
            // The worst of all combinations that occur: the teeth that lag meet each other.
            lag: gears.iter().map(|g| g.pitch_error).sum(),
            yielding,
        })
    }

    /// The gap at a place of the plane of action; constant parts only shift the transmission error. \[m\]
    pub fn at(&self, x: f64, y: f64) -> f64 {
        let t = (x - self.middle) / self.half;
        let v = 2.0 * y / self.facewidth - 1.0;
        let reliefs: f64 = self.reliefs.iter().map(|relief| relief.gap(x)).sum();
        reliefs
            + self.profile_crowning * t * t
            + self.profile_slope * t
            + self.crowning * v * v
            + self.slope * y / self.facewidth
    }

    /// By how much every second pair of teeth lags, in addition to the gap at a place. \[m\]
    pub fn lag(&self) -> f64 {
        self.lag
    }

    /// True if it changes with the load of the mesh.
    pub fn yields(&self) -> bool {
        self.yielding != 0.0
    }

    /// The gap under a line load of the mesh. \[N/m\]
    pub fn under(&self, line_load: f64) -> Self {
        Self {
            slope: self.slope + self.yielding * line_load,
            yielding: 0.0,
            ..self.clone()
        }
    }

    /// True if it is the same along the whole face.
    pub fn is_even_along_the_face(&self) -> bool {
        self.crowning == 0.0 && self.slope == 0.0 && self.yielding == 0.0
    }

    /// True if there is none.
    pub fn is_none(&self) -> bool {
        self.is_even_along_the_face()
            && self.reliefs.is_empty()
            && self.profile_crowning == 0.0
            && self.profile_slope == 0.0
            && self.lag == 0.0
    }

    /// Greatest gap less the least one over the plane of action, from its corners and middles, with the pitch error. \[m\]
    pub fn range(&self) -> f64 {
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        for i in 0..=32 {
            for j in 0..=8 {
                let x = self.middle + self.half * (f64::from(i) / 16.0 - 1.0);
                let gap = self.at(x, self.facewidth * f64::from(j) / 8.0);
                (least, greatest) = (least.min(gap), greatest.max(gap));
            }
        }
        greatest - least + self.lag.abs()
    }
}

/// Length of a relief along the path. \[m\]
fn length(pair: &Pair, gear: usize, at_end: bool, relief: &Relief) -> Result<f64, String> {
    let [start, .., end] = pair.points;
    let path = end - start;
    let length = match (relief.length, relief.from_diameter) {
        (Some(_), Some(_)) => return Err("its start is stated twice, by `length` and by `from_diameter`".to_owned()),
        (Some(length), None) => length,
        (None, Some(diameter)) => {
            let radius = 0.5 * diameter;
            let reach = (radius * radius - pair.base_radius[gear].powi(2)).max(0.0).sqrt();
            let x = match gear {
                0 => reach,
                _ => pair.sign() * (pair.tangent_length - reach),
            };
            if at_end { end - x } else { x - start }
        }
        (None, None) => ((pair.contact_ratio - 1.0) * pair.base_pitch).min(0.5 * path),
    };
    if length > 0.0 && length <= path * (1.0 + 1e-9) {
        return Ok(length);
    }
    Err(format!(
        "it is {:.4} mm long, and the path of contact {:.4} mm",
        length * 1e3,
        path * 1e3
    ))
}
