//! A row of rollers, cut into slices.
//!
//! Source: ISO/TS 16281:2008 as printed by a public program: c_L = 35948 L^(8/9) N/mm^(10/9) for both contacts of steel together, divided
//! among equal slices, each with the power 10/9 of its own approach; profile of cylindrical and needle rollers up to L = 2.5 D
//! 0.00035 D ln(1/(1 - (2x/L)^2)) on each contact, of tapered rollers 0.00045 D instead. Longer cylindrical rollers are straight in the middle:
//! the profile begins at |x| = (L - 2.5 D)/2 and has its pole at the end, which fixes its argument (2|x| - (L - 2.5 D))/(2.5 D); the program
//! prints that with misplaced brackets and the factor 0.0005, which is kept. The factor jumps at L = 2.5 D.
//! A tapered roller touches along the normal of its outer raceway; the rib, which takes about 5 % of an axial load, is neglected.
//! c_L is scaled with the contact modulus for other materials, as Palmgren's formula for the approach of a line contact has it.

use super::balls::directions;
use super::equilibrium::{Axes, LocalForce, Row};
use super::material::Material;

/// Factor of the stiffness of a roller between two raceways of steel, in N, for a length of 1 mm and an approach of 1 mm.
const LINE_STIFFNESS: f64 = 35_948.0;
/// Exponent of the approach of a line contact.
const EXPONENT: f64 = 10.0 / 9.0;

/// Profile of a roller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Profile {
    /// Logarithmic towards the ends.
    #[default]
    Logarithmic,
    /// Straight.
    Straight,
}

/// Internal geometry of a row of rollers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RollerGeometry {
    /// Number of rollers.
    pub number: usize,
    /// Mean diameter D of a roller. \[m\]
    pub diameter: f64,
    /// Effective length L of a roller. \[m\]
    pub length: f64,
    /// Diameter d_m of the circle of their centres. \[m\]
    pub pitch_diameter: f64,
    /// Angle of the normal of the outer raceway to the radial plane: zero for cylindrical rollers. \[rad\]
    pub contact_angle: f64,
    /// Radial clearance, from side to side; negative with preload. \[m\]
    pub clearance: f64,
    /// Number of slices.
    pub slices: usize,
    /// Profile.
    pub profile: Profile,
    /// Material of the rollers.
    pub rollers: Material,
    /// Material of the rings.
    pub rings: Material,
}

impl RollerGeometry {
    /// By how much the profile is lower than a straight roller, on each contact, at a distance from the middle. \[m\]
    fn relief(&self, x: f64) -> f64 {
        let (length, diameter) = (self.length, self.diameter);
        let long = 2.5 * diameter;
        let (factor, share) = match self.profile {
            Profile::Straight => return 0.0,
            Profile::Logarithmic if self.contact_angle != 0.0 => (0.000_45, 2.0 * x / length),
            Profile::Logarithmic if length <= long => (0.000_35, 2.0 * x / length),
            Profile::Logarithmic => (0.000_5, (2.0 * x.abs() - (length - long)).max(0.0) / long),
        };
        -factor * diameter * (-share * share).ln_1p()
    }
}

/// A slice of a roller.
#[derive(Debug, Clone, Copy)]
struct Slice {
    /// Distance of its middle from that of the roller. \[m\]
    x: f64,
    /// Approach that a straight roller in the middle has when the slice touches. \[m\]
    relief: f64,
}

/// A row of rollers.
#[derive(Debug, Clone)]
pub struct Rollers {
    geometry: RollerGeometry,
    slices: Vec<Slice>,
    /// Load of a slice over the power 10/9 of its approach. \[N/m^(10/9)\]
    stiffness: f64,
    /// Cosine and sine of the contact angle.
    normal: [f64; 2],
    directions: Vec<[f64; 2]>,
}

/// One roller under load.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RollerLoad {
    /// Load. \[N\]
    pub load: f64,
    /// Load of the most loaded slice. \[N\]
    pub greatest_slice: f64,
}

impl Rollers {
    /// A row with its slices.
    pub fn new(geometry: RollerGeometry) -> Self {
        let count = geometry.slices as f64;
        let slices = (0..geometry.slices).map(|k| {
            let x = ((k as f64 + 0.5) / count - 0.5) * geometry.length;
            Slice {
                x,
                relief: 2.0 * geometry.relief(x),
            }
        });
        let steel = Material::STEEL.contact_modulus(&Material::STEEL);
        let softer = geometry.rollers.contact_modulus(&geometry.rings) / steel;
        // In mm as printed, then in m.
        let whole = LINE_STIFFNESS * (1e3 * geometry.length).powf(8.0 / 9.0) * softer * 1e3_f64.powf(EXPONENT);
        Self {
            slices: slices.collect(),
            stiffness: whole / count,
            normal: [geometry.contact_angle.cos(), geometry.contact_angle.sin()],
            directions: directions(geometry.number),
            geometry,
        }
    }

    /// The internal geometry.
    pub fn geometry(&self) -> &RollerGeometry {
        &self.geometry
    }

    /// Load of a straight roller over the power 10/9 of the approach of both rings. \[N/m^(10/9)\]
    pub fn stiffness(&self) -> f64 {
        self.stiffness * self.slices.len() as f64
    }

    /// Distance of the pressure centre, in which a radial load does not tilt the ring, from the middle of the row along the axis. \[m\]
    pub fn pressure_centre(&self) -> f64 {
        0.5 * self.geometry.pitch_diameter * self.geometry.contact_angle.tan()
    }

    /// Approach of both rings at the middle of a straight roller. \[m\]
    fn approach(&self, [axial, radial, tilt]: [f64; 3]) -> f64 {
        let [cos, sin] = self.normal;
        radial * cos + (axial + tilt) * sin - 0.5 * self.geometry.clearance * cos
    }

    /// Loads of the slices of a roller at a displacement of the inner ring, in the order along the axis. \[N\]
    pub fn slices(&self, roller: usize, displacement: &Axes<f64>) -> impl Iterator<Item = f64> {
        let plane = self.in_plane(roller, displacement);
        let (approach, tilt) = (self.approach(plane), plane[2] / self.radius());
        let load = move |slice: &Slice| {
            let own = approach - tilt * slice.x - slice.relief;
            self.stiffness * own.max(0.0).powf(EXPONENT)
        };
        self.slices.iter().map(load)
    }

    /// The rollers in their order at a displacement of the inner ring.
    pub fn loads(&self, displacement: &Axes<f64>) -> impl Iterator<Item = RollerLoad> {
        let displacement = *displacement;
        (0..self.directions.len()).map(move |roller| {
            let mut sum = RollerLoad::default();
            for load in self.slices(roller, &displacement) {
                sum.load += load;
                sum.greatest_slice = sum.greatest_slice.max(load);
            }
            sum
        })
    }

    /// Maximum pressure in the contact of a slice with the inner (`0`) or outer (`1`) raceway under a load, of a line contact of Hertz. \[Pa\]
    pub fn pressure(&self, slice_load: f64, ring: usize) -> f64 {
        let geometry = &self.geometry;
        let gamma = geometry.diameter * self.normal[0] / geometry.pitch_diameter;
        let side = [1.0, -1.0][ring];
        let radius = 0.5 * geometry.diameter * (1.0 - side * gamma);
        let modulus = geometry.rollers.contact_modulus(&geometry.rings);
        let per_length = slice_load * self.slices.len() as f64 / geometry.length;
        (per_length * modulus / (std::f64::consts::PI * radius)).sqrt()
    }
}

impl Row for Rollers {
    fn directions(&self) -> &[[f64; 2]] {
        &self.directions
    }

    fn radius(&self) -> f64 {
        0.5 * self.geometry.pitch_diameter
    }

    fn force(&self, _element: usize, displacement: [f64; 3]) -> LocalForce {
        let approach = self.approach(displacement);
        let [cos, sin] = self.normal;
        let mut sum = LocalForce::default();
        for slice in &self.slices {
            let arm = slice.x / self.radius();
            let own = approach - displacement[2] * arm - slice.relief;
            if own <= 0.0 {
                continue;
            }
            let load = self.stiffness * own.powf(EXPONENT);
            let slope = EXPONENT * load / own;
            let shares = [sin, cos, sin - arm];
            for (i, share) in shares.iter().enumerate() {
                sum.force[i] += share * load;
                for (j, other) in shares.iter().enumerate() {
                    sum.stiffness[i][j] += share * other * slope;
                }
            }
            sum.size += load;
        }
        sum
    }

    fn guess(&self, axial: f64, radial: f64) -> [f64; 2] {
        let [cos, sin] = self.normal;
        let number = self.directions.len() as f64;
        let approach = |load: f64| (load / (number * self.stiffness())).powf(1.0 / EXPONENT);
        let clearance = self.geometry.clearance.max(0.0);
        let along = if sin == 0.0 { 0.0 } else { approach(axial / sin) / sin };
        [along.max(0.0), approach(4.0 * radial / cos) / cos + 0.5 * clearance]
    }
}
