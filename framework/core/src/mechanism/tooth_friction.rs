//! Friction between flanks along the path of contact.

mod suite;

use crate::lanes::{Lane, LaneNotes, Powers};
use crate::loss::{NoteBase, Notes, Undefined};
use crate::mechanism::Scalar;
use crate::mechanism::Slot;
use crate::mechanism::mean_friction::{MeanFrictionAt, hertz, load_at, modulus_at, radius_at};
use crate::mechanism::{Mechanism, NoPart};
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum ToothFriction {}

/// Coefficient of friction between flanks. A model returns it for one contact; a model that iterates along the path, or shares work
/// between its nodes, returns it for the whole path.
///
/// The inputs are [`ContactAt`], which documents each quantity with unit, source and tested range, and the part in it.
pub trait ToothFrictionModel: Send + Sync {
    /// Coefficient of friction at one contact. \[-\] Pure; must not allocate.
    fn mu(&self, at: &ContactAt<'_>) -> Result<f64, Undefined>;

    /// Number of nodes on each smooth section of a path for an error of the loss below 1e-4, or of the mean friction below 1e-6.
    /// Seven are enough for a law that is smooth inside the sections, for any power of sliding and load at their ends; [`CUT_OFF`]
    /// for one that is cut off anywhere, as by `min` or `max`.
    fn order(&self) -> usize {
        SMOOTH
    }

    /// Coefficients of friction at all nodes of a path, into a slice of the length of the path. Pure; must not allocate.
    fn along(&self, path: &PathAt<'_>, mu: &mut [f64]) -> Result<Along, Undefined> {
        for (node, mu) in path.nodes.iter().zip(mu) {
            *mu = self.mu(&path.contact(node))?;
        }
        Ok(Along::default())
    }

    /// Batched coefficients at all nodes of a path for several line loads (N/m), with all other quantities as in `path`, whose own
    /// line load and `mean` are unused; muted. They must have the bits of [`along`](Self::along), the heat must be split equally
    /// between both bodies, and undefined values must be NaN. False if the law has no batched evaluation: it is then evaluated once
    /// per load. Used for the notes of laws with a [`weighted`](Self::weighted) sum.
    fn along_lanes(&self, _path: &PathAt<'_>, _line_loads: &Lane, _mu: &mut [Lane]) -> bool {
        false
    }

    /// The sum of the coefficients over the nodes of a path with given weights, prepared if the law provides a faster way than node
    /// by node; accurate to 1e-9. The heat must be split equally between both bodies, and the sum must be NaN where
    /// [`along`](Self::along) is undefined.
    fn weighted(&self, _nodes: &[PathNode], _weights: &[f64]) -> Option<Box<dyn WeightedFriction>> {
        None
    }

    /// Writes the notes of [`along`](Self::along), from the coefficients of [`along_lanes`](Self::along_lanes).
    fn note_lanes(&self, _path: &PathAt<'_>, _line_loads: &Lane, _mu: &[Lane], _notes: LaneNotes<'_>) {}
}

/// Nodes on each section of a path for a smooth law.
pub const SMOOTH: usize = 7;

/// Nodes on each section of a path for a law with a cut-off at a point that depends on load, speed and oil.
pub const CUT_OFF: usize = 64;

/// A sum of coefficients of friction over the nodes of a path with given weights, prepared by a law.
pub trait WeightedFriction: Send + Sync {
    /// The sum for one line load; NaN if the nodes must be evaluated.
    fn sum(&self, path: &PathAt<'_>) -> f64;

    /// Batched sums for several line loads (N/m), to the bit except for remembered powers; the line load of `path` and its `mean`
    /// are unused.
    fn sums(&self, path: &PathAt<'_>, line_loads: &Lane, powers: &mut Powers) -> Lane;

    /// Writes the notes of the law along the path. False if that needs the coefficients at all nodes.
    fn note(&self, _path: &PathAt<'_>, _line_loads: &Lane, _notes: LaneNotes<'_>) -> bool {
        false
    }
}

/// Results of a law for a whole path in addition to its coefficients.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Along {
    /// Share of the friction heat that enters the body of the first gear. \[-\]
    pub first_heat: f64,
}

impl Default for Along {
    /// Half of the heat for each body.
    fn default() -> Self {
        Self { first_heat: 0.5 }
    }
}

context! {
    /// All inputs of a friction law in one contact.
    pub struct ContactAt of ToothFriction {
        /// Magnitude of the sliding velocity. [m/s]
        sliding: 1.0 in 0.0..=30.0 from "speed of the mesh and the position on the path",
        /// Sum of the surface speeds. [m/s]
        sum_speed: 10.0 in 0.0..=200.0 from "speed of the mesh and the position on the path",
        /// Radius of relative curvature. [mm]
        radius: 8.0 in 0.1..=500.0 from "the position on the path",
        /// Line load. [N/mm]
        line_load: 200.0 in 0.0..=3000.0 from "torque of the mesh and the load share at this point",
        /// Hertz pressure. [GPa]
        pressure: 0.948 in 0.0..=4.0 from "`line_load`, `radius` and `modulus`",
        /// Reduced modulus E/(1 - nu^2) of equal materials. [GPa]
        modulus: 226.0 in 1.0..=500.0 from "the material of the gears",
        /// Length of the line of contact. [mm]
        length: 20.0 in 0.1..=2000.0 from "face width and base helix",
        /// Arithmetic mean roughness, mean of both flanks. [um]
        ra: 0.4 in 0.01..=5.0 from "`surface.ra` of both gears",
        /// Root mean square roughness of both flanks together. [um]
        rq: 0.5 in 0.01..=5.0 from "`surface.rq` of both gears",
        /// Temperature of the oil that enters the contact. [degC]
        temperature: 80.0 in -40.0..=200.0 from "the oil of the mesh, with its `temperature_offset`",
        /// Kinematic viscosity of that oil. [mm2/s]
        nu: 10.0 in 1.0..=10000.0 from "the viscosity of that oil at this temperature",
        /// Dynamic viscosity of that oil. [mPa s]
        eta: 8.2 in 0.5..=10000.0 from "`nu` times `rho`",
        /// Density of that oil. [kg/m3]
        rho: 820.0 in 500.0..=1300.0 from "the density of that oil at this temperature",
        /// Pressure-viscosity coefficient of that oil. [1/GPa]
        alpha: 15.0 in 1.0..=60.0 from "`pressure_viscosity` of the oil, or its kind",
        /// Relative decrease of the oil's viscosity with temperature. [1/K]
        beta: 0.03 in 0.001..=0.3 from "the slope of its viscosity at this temperature",
        /// Thermal conductivity of the oil. [W/(m K)]
        conductivity: 0.135 in 0.05..=0.5 from "`conductivity` of the oil, else its density according to Cragoe",
        /// Lubricant factor of mean mesh friction. [-]
        x_l: 1.0 in 0.1..=2.0 from "`x_l` of the oil, or its kind",
    } laws {
        "eta = nu rho" { eta: |at| at.nu * at.rho, nu: |at| at.eta / at.rho, rho: |at| at.eta / at.nu }
        "pressure = sqrt(line_load modulus/(2 pi radius))" {
            pressure: |at| hertz(at.line_load, at.modulus, at.radius),
            line_load: |at| load_at(at.pressure, at.modulus, at.radius),
            radius: |at| radius_at(at.pressure, at.modulus, at.line_load),
            modulus: |at| modulus_at(at.pressure, at.line_load, at.radius),
        }
        "sliding is at most sum_speed" {
            sliding: |at| at.sliding.min(at.sum_speed),
            sum_speed: |at| at.sum_speed.max(at.sliding),
        }
    }
}

impl ContactAt<'_> {
    /// Slide-to-roll ratio: sliding velocity over mean rolling velocity; zero at standstill. \[-\]
    #[inline]
    pub fn slide_roll(&self) -> f64 {
        if self.sum_speed > 0.0 {
            2.0 * self.sliding / self.sum_speed
        } else {
            0.0
        }
    }
}

/// One point on the path of contact, for a speed of one radian per second of the first gear. Prepared once per mesh. Logarithms are
/// stored because laws that are products of powers need them at every point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathNode {
    /// Sliding velocity per speed of the first gear. \[m\]
    pub sliding: f64,
    /// Sum of the surface speeds per speed of the first gear. \[m\]
    pub sum_speed: f64,
    /// Radius of relative curvature in the normal plane. \[m\]
    pub radius: f64,
    /// Line load at the node over the mesh's reference line load.
    pub share: f64,
    /// Share of the mesh's normal force that the pair of teeth carries.
    pub force: f64,
    /// Length of path that the node represents, over the base pitch; the weights of a path sum to its contact ratio.
    pub weight: f64,
    /// True if the flank of the first gear is the faster one.
    pub first_faster: bool,
    /// Slide-to-roll ratio.
    pub slide_roll: f64,
    /// Natural logarithm of `slide_roll`; minus infinity at the pitch point.
    pub ln_slide_roll: f64,
    /// Natural logarithm of half of `sum_speed`.
    pub ln_rolling: f64,
    /// Natural logarithm of `radius`.
    pub ln_radius: f64,
    /// Root of `share` over `radius`: Hertz pressure per root of reference line load and reduced modulus over 2 pi.
    pub root_load: f64,
    /// Natural logarithm of `root_load`.
    pub ln_root_load: f64,
}

impl PathNode {
    /// A node from sliding and sum velocity per speed of the first gear, radius and share; SI. Its line load is that share of the
    /// force, its weight is one base pitch, and its first flank is the faster one.
    pub fn new(sliding: f64, sum_speed: f64, radius: f64, share: f64) -> Self {
        let slide_roll = 2.0 * sliding / sum_speed;
        let root_load = (share / radius).sqrt();
        Self {
            sliding,
            sum_speed,
            radius,
            share,
            force: share,
            weight: 1.0,
            first_faster: true,
            slide_roll,
            ln_slide_roll: slide_roll.ln(),
            ln_rolling: (0.5 * sum_speed).ln(),
            ln_radius: radius.ln(),
            root_load,
            ln_root_load: root_load.ln(),
        }
    }
}

/// Minimum and maximum values along a path, for notes that need no evaluation of its nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathExtent {
    /// Slide-to-roll ratio.
    pub slide_roll: [f64; 2],
    /// Sum of the surface speeds per speed of the first gear. \[m\]
    pub sum_speed: [f64; 2],
    /// Radius of relative curvature. \[m\]
    pub radius: [f64; 2],
    /// Root of share over radius.
    pub root_load: [f64; 2],
}

impl PathExtent {
    /// The extent of a path.
    pub fn from_nodes(nodes: &[PathNode]) -> Self {
        let range = |value: fn(&PathNode) -> f64| {
            let values = nodes.iter().map(value);
            [
                values.clone().fold(f64::INFINITY, f64::min),
                values.fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        Self {
            slide_roll: range(|n| n.slide_roll),
            sum_speed: range(|n| n.sum_speed),
            radius: range(|n| n.radius),
            root_load: range(|n| n.root_load),
        }
    }
}

/// The whole path of contact at one operating point. SI.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct PathAt<'a> {
    /// The points on the path.
    pub nodes: &'a [PathNode],
    /// Their extent.
    pub extent: &'a PathExtent,
    /// Magnitude of the speed of the first gear in the carrier's frame, positive. \[rad/s\]
    pub speed: f64,
    /// Reference line load, positive. \[N/m\]
    pub line_load: f64,
    /// Reduced modulus E/(1 - nu^2) of equal materials. \[Pa\]
    pub modulus: f64,
    /// Length of the line of contact of one pair. \[m\]
    pub length: f64,
    /// Arithmetic mean roughness, mean of both flanks. \[m\]
    pub ra: f64,
    /// Root mean square roughness of both flanks together. \[m\]
    pub rq: f64,
    /// Temperature of the oil. \[degC\]
    pub temperature: f64,
    /// Kinematic viscosity. \[m2/s\]
    pub nu: f64,
    /// Dynamic viscosity. \[Pa s\]
    pub eta: f64,
    /// Density. \[kg/m3\]
    pub rho: f64,
    /// Pressure-viscosity coefficient. \[1/Pa\]
    pub alpha: f64,
    /// Relative decrease of the viscosity with temperature. \[1/K\]
    pub beta: f64,
    /// Thermal conductivity. \[W/(m K)\]
    pub conductivity: f64,
    /// Lubricant factor of mean mesh friction.
    pub x_l: f64,
    /// Body temperatures of both gears, if a thermal network provides them. \[degC\]
    pub bodies: Option<[f64; 2]>,
    /// The inputs of a mean friction law for this mesh.
    pub mean: &'a MeanFrictionAt<'a>,
    /// Target of limits, observed quantities and steps.
    pub notes: Notes<'a>,
}

impl<'a> PathAt<'a> {
    /// The path of a mesh: its points, their extent and the length of the line of contact of one pair. \[m\]
    pub fn new(
        nodes: &'a [PathNode],
        extent: &'a PathExtent,
        length: f64,
        mean: &'a MeanFrictionAt<'a>,
        notes: Notes<'a>,
    ) -> Self {
        PathAt {
            nodes,
            extent,
            speed: mean.speed,
            line_load: mean.part.pair.line_load(mean.normal_force),
            modulus: mean.part.modulus,
            length,
            ra: mean.ra,
            rq: mean.rq,
            temperature: mean.temperature,
            nu: mean.nu,
            eta: mean.eta,
            rho: mean.rho,
            alpha: mean.alpha,
            beta: mean.beta,
            conductivity: mean.conductivity,
            x_l: mean.x_l,
            bodies: None,
            mean,
            notes,
        }
    }

    /// The same with some quantities changed.
    #[inline]
    pub fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
        change(&mut self);
        self
    }

    /// The same for the law of a nested slot, which has its own notes.
    #[inline]
    pub fn nested(&self, slot: &Slot<ToothFriction>) -> Self {
        self.with(|to| to.notes = self.notes.nested(slot.notes))
    }

    /// Hertz pressure of a node with `root_load` one. \[Pa m^0.5\]
    #[inline]
    pub fn unit_pressure(&self) -> f64 {
        (self.line_load * self.modulus / (2.0 * std::f64::consts::PI)).sqrt()
    }

    /// One point of the path as a contact.
    pub fn contact(&self, node: &PathNode) -> ContactAt<'a> {
        ContactAt {
            part: &NoPart {},
            sliding: node.sliding * self.speed,
            sum_speed: node.sum_speed * self.speed,
            radius: node.radius,
            line_load: node.share * self.line_load,
            pressure: node.root_load * self.unit_pressure(),
            modulus: self.modulus,
            length: self.length,
            ra: self.ra,
            rq: self.rq,
            temperature: self.temperature,
            nu: self.nu,
            eta: self.eta,
            rho: self.rho,
            alpha: self.alpha,
            beta: self.beta,
            conductivity: self.conductivity,
            x_l: self.x_l,
            // Each point has its own velocities.
            notes: self.notes.forgetting(),
        }
    }
}

impl Mechanism for ToothFriction {
    const KEY: &'static str = "tooth_friction";
    const MEANING: &'static str = "Coefficient of friction between flanks along the path of contact.";
    const ANSWER: &'static str = "Coefficient of friction. [-]";
    const EXAMPLE: &'static str = "{}";
    type Part = NoPart;
    type At<'a> = ContactAt<'a>;
    type Answer = f64;
    type Model = dyn ToothFrictionModel;

    answered_by!(mu);

    fn compare_batched(model: &Self::Model, at: &ContactAt<'_>, notes: NoteBase) -> Option<&'static str> {
        suite::fault(model, at, notes)
    }
}

impl ToothFrictionModel for Scalar<ToothFriction> {
    fn mu(&self, at: &ContactAt<'_>) -> Result<f64, Undefined> {
        self.value(at)
    }

    fn order(&self) -> usize {
        if self.is_constant() { SMOOTH } else { CUT_OFF }
    }
}

crate::register_mechanism!(ToothFriction);
