//! What statics needs to know of a gearbox: members on axes, supports, meshes.

use crate::attach::Axial;

/// A piece of a shaft with constant diameters, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Begin and end along the shaft. \[m\]
    pub range: [f64; 2],
    /// Outer diameter. \[m\]
    pub outer: f64,
    /// Inner diameter. \[m\]
    pub inner: f64,
}

/// A planet body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanetBody {
    /// Member that is the carrier.
    pub carrier: usize,
    /// Radius of the orbit. \[m\]
    pub orbit: f64,
    /// Number of equal copies.
    pub count: f64,
    /// Mass of one copy. \[kg\]
    pub mass: f64,
}

/// A member for statics.
#[derive(Debug, Clone, Default)]
pub struct MemberLayout {
    /// Forces that always act: place along the shaft, force in x, y, z. \[m, N\]
    pub forces: Vec<(f64, [f64; 3])>,
    /// Moments about y and z that always act, with their place. \[m, Nm\]
    pub moments: Vec<(f64, [f64; 2])>,
    /// Diameters, for more than two supports.
    pub sections: Vec<Section>,
    /// Hinges. \[m\]
    pub hinges: Vec<f64>,
    /// Counts the deflection by shear.
    pub shear: bool,
    /// Set for planet bodies.
    pub planet: Option<PlanetBody>,
    /// True for loose gears: whatever they share a support with carries them.
    pub loose: bool,
}

/// A support for statics.
#[derive(Debug, Clone, Copy)]
pub struct SupportLayout {
    /// Member inside.
    pub inner: usize,
    /// Member outside; absent for the housing.
    pub outer: Option<usize>,
    /// Place along the shaft. \[m\]
    pub at: f64,
    /// Thrust of the shaft that it takes.
    pub axial: Axial,
    /// Share of the thrust where several could take it.
    pub share: Option<f64>,
    /// Spring preload, positive pushes the shaft towards +x. \[N\]
    pub spring: f64,
    /// Takes a tilting moment.
    pub takes_moment: bool,
    /// Radial stiffness; absent, rigid. \[N/m\]
    pub radial_stiffness: Option<f64>,
    /// Tilting stiffness; absent, none. \[Nm/rad\]
    pub tilting_stiffness: Option<f64>,
    /// Thrust that a radial load induces, over the radial load; zero for bearings without contact angle.
    pub induced: f64,
}

/// A mesh for statics.
#[derive(Debug, Clone, Copy)]
pub struct MeshLayout {
    /// Members of both gears.
    pub members: [usize; 2],
    /// Middle of the face along the shafts. \[m\]
    pub at: f64,
    /// Working pitch radii. \[m\]
    pub radius: [f64; 2],
    /// One for external, minus one for internal pairs.
    pub sign: f64,
    /// Unit vector in y and z from the axis of the first gear to the contact.
    pub direction: [f64; 2],
    /// Tangent of the working transverse pressure angle.
    pub tan_alpha: f64,
    /// Tangent of the working helix angle times the hand of the first gear, one for right; zero without net thrust.
    pub hand_tan_beta: f64,
    /// Number of equal copies.
    pub count: f64,
    /// Which of both gears is on the central axis of a set with several planets: its transverse forces cancel.
    pub central: [bool; 2],
}

impl MeshLayout {
    /// Forces on the first gear, and on the second, from one newton of tangential force and of its magnitude; x, y, z.
    pub(super) fn forces(&self, gear: usize) -> [[f64; 3]; 2] {
        let [ey, ez] = self.direction;
        let turn = if gear == 0 { 1.0 } else { -1.0 };
        // t = x cross e.
        [
            [-turn * self.hand_tan_beta, -turn * ez, turn * ey],
            [0.0, -turn * self.tan_alpha * ey, -turn * self.tan_alpha * ez],
        ]
    }

    /// Vector from a gear's axis to the contact, y and z. \[m\]
    pub(super) fn arm(&self, gear: usize) -> [f64; 2] {
        let r = if gear == 0 {
            self.radius[0]
        } else {
            -self.sign * self.radius[1]
        };
        [r * self.direction[0], r * self.direction[1]]
    }
}

/// All of it.
#[derive(Debug, Clone, Default)]
pub struct Layout {
    /// Members by number.
    pub members: Vec<MemberLayout>,
    /// Supports by number.
    pub supports: Vec<SupportLayout>,
    /// Meshes by number.
    pub meshes: Vec<MeshLayout>,
}

/// Why loads cannot be found. Members and supports by number.
#[derive(Debug, Clone, PartialEq)]
pub enum LoadFault {
    /// Members carry each other in a circle.
    Cycle {
        /// The members.
        members: Vec<usize>,
    },
    /// The supports leave the member free to tilt or move.
    Mechanism {
        /// The member.
        member: usize,
        /// Its supports.
        supports: Vec<usize>,
    },
    /// Several supports could take the same thrust and no shares are stated.
    AxialIndeterminate {
        /// The member.
        member: usize,
        /// The supports that could.
        supports: Vec<usize>,
        /// Towards +x.
        right: bool,
    },
    /// Diameters are missing where more than two supports carry a member.
    NoSection {
        /// The member.
        member: usize,
        /// The range without diameters. \[m\]
        range: [f64; 2],
    },
    /// A moment acts at a hinge.
    MomentAtHinge {
        /// The member.
        member: usize,
        /// Place of the hinge. \[m\]
        at: f64,
    },
}
