//! Input of statics: members on axes, supports, meshes.

use crate::attach::Axial;
use crate::rolling::AxialRow;

/// A section of a shaft with constant diameters, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Start and end along the shaft. \[m\]
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
    /// True if the copies carry different loads.
    pub uneven: bool,
}

/// A member for statics.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MemberLayout {
    /// Where positions along the shaft count from, along its direction, so that those of parallel shafts are comparable. \[m\]
    pub start: f64,
    /// Permanent forces: position along the shaft, force in x, y, z. \[m, N\]
    pub forces: Vec<(f64, [f64; 3])>,
    /// Permanent moments about y and z, with their position. \[m, Nm\]
    pub moments: Vec<(f64, [f64; 2])>,
    /// Diameters, for more than two supports.
    pub sections: Vec<Section>,
    /// Hinges. \[m\]
    pub hinges: Vec<f64>,
    /// Includes the shear deflection.
    pub shear: bool,
    /// Set for planet bodies.
    pub planet: Option<PlanetBody>,
    /// True for idler gears: the member on the other side of a support carries them.
    pub loose: bool,
}

/// A support for statics.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SupportLayout {
    /// Member inside.
    pub inner: usize,
    /// Member outside; `None` for the housing.
    pub outer: Option<usize>,
    /// Position along the shaft. \[m\]
    pub at: f64,
    /// Directions of thrust that it takes.
    pub axial: Axial,
    /// Share of the thrust if several supports can take it.
    pub share: Option<f64>,
    /// Spring preload; a positive force pushes the shaft towards +x. \[N\]
    pub spring: f64,
    /// Takes radial load; false for thrust bearings.
    pub takes_radial: bool,
    /// Takes a tilting moment.
    pub takes_moment: bool,
    /// Radial stiffness; `None`: rigid. \[N/m\]
    pub radial_stiffness: Option<f64>,
    /// Tilting stiffness; `None`: zero. \[Nm/rad\]
    pub tilting_stiffness: Option<f64>,
    /// Thrust induced by a radial load, per radial load; `None` if the bearing has no contact angle or it is not known.
    pub induced: Option<f64>,
    /// Its axial displacement, of both bearings of a pair that is adjusted with a stated preload; `None` of others.
    pub preloaded: Option<AxialRow>,
}

/// A mesh for statics.
#[derive(Debug, Clone, PartialEq)]
pub enum MeshLayout {
    /// Cylindrical gears on parallel axes.
    Cylindrical(CylindricalMesh),
    /// Gears on axes that cross.
    Crossed(Box<CrossedMesh>),
}

/// Cylindrical gears on parallel axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CylindricalMesh {
    /// Members of both gears.
    pub members: [usize; 2],
    /// Middle of the face along the shafts, counted from where [`MemberLayout::start`] counts. \[m\]
    pub at: f64,
    /// Working pitch radii. \[m\]
    pub radius: [f64; 2],
    /// One for external, minus one for internal pairs.
    pub sign: f64,
    /// Unit vector in y and z from the axis of the first gear to the contact.
    pub direction: [f64; 2],
    /// Force across the line of centres per newton of tangential force: one for gears, less for a chain.
    pub across: f64,
    /// Tangent of the working transverse pressure angle; for a chain the pull along the line of centres, negative.
    pub tan_alpha: f64,
    /// Tangent of the working helix angle times the hand of the first gear, +1 for right; zero without net thrust.
    pub hand_tan_beta: f64,
    /// Number of equal copies.
    pub count: f64,
    /// Which of both gears is on the central axis of a set with several planets: its transverse forces cancel.
    pub central: [bool; 2],
}

/// Gears on axes that cross; vectors in the frame of the member of each gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossedMesh {
    /// Members of both gears.
    pub members: [usize; 2],
    /// Position of the mean point along each shaft. \[m\]
    pub at: [f64; 2],
    /// Vector from each axis to the mean point, y and z. \[m\]
    pub arm: [[f64; 2]; 2],
    /// Force on each gear per newton of the magnitude of the tangential force, without friction: for a positive and for a negative one.
    pub normal: [[[f64; 3]; 2]; 2],
    /// Force and moment about y and z on each gear per newton of friction while the first gear turns forwards: for a positive and for a
    /// negative tangential force, and for each of them if the first and if the second gear drives. \[-, m\]
    pub friction: [[[([f64; 3], [f64; 2]); 2]; 2]; 2],
}

/// Load cases of friction: for a positive and for a negative tangential force, and for each of them for a positive and for a negative speed
/// of the first gear.
pub(super) type Senses<T> = [[T; 2]; 2];

impl CylindricalMesh {
    /// Forces on the first and on the second gear, per newton of tangential force and of its magnitude; x, y, z.
    pub(super) fn forces(&self, gear: usize) -> [[f64; 3]; 2] {
        let [ey, ez] = self.direction;
        let turn = if gear == 0 { 1.0 } else { -1.0 };
        // t = x cross e.
        [
            [
                -turn * self.hand_tan_beta,
                -turn * ez * self.across,
                turn * ey * self.across,
            ],
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

impl MeshLayout {
    /// Members of both gears.
    pub fn members(&self) -> [usize; 2] {
        match self {
            Self::Cylindrical(mesh) => mesh.members,
            Self::Crossed(mesh) => mesh.members,
        }
    }

    /// Number of equal copies.
    pub(super) fn count(&self) -> f64 {
        match self {
            Self::Cylindrical(mesh) => mesh.count,
            Self::Crossed(_) => 1.0,
        }
    }

    /// True for a gear on the central axis of a set with several planets.
    pub fn is_central(&self, gear: usize) -> bool {
        match self {
            Self::Cylindrical(mesh) => mesh.central[gear],
            Self::Crossed(_) => false,
        }
    }

    /// Position along the shaft of a gear, which starts at `start`. \[m\]
    pub(super) fn at(&self, gear: usize, start: f64) -> f64 {
        match self {
            Self::Cylindrical(mesh) => mesh.at - start,
            Self::Crossed(mesh) => mesh.at[gear],
        }
    }

    /// Vector from a gear's axis to the contact, y and z. \[m\]
    pub(super) fn arm(&self, gear: usize) -> [f64; 2] {
        match self {
            Self::Cylindrical(mesh) => mesh.arm(gear),
            Self::Crossed(mesh) => mesh.arm[gear],
        }
    }

    /// Forces on a gear per newton of tangential force and of its magnitude; x, y, z.
    pub(super) fn forces(&self, gear: usize) -> [[f64; 3]; 2] {
        match self {
            Self::Cylindrical(mesh) => mesh.forces(gear),
            Self::Crossed(mesh) => {
                let [positive, negative] = mesh.normal[gear];
                let half = |sign: f64| std::array::from_fn(|i| 0.5 * (positive[i] + sign * negative[i]));
                [half(-1.0), half(1.0)]
            }
        }
    }

    /// Force and moment on a gear per newton of friction, which has the sign of the speed of the first gear; `None` where friction is not in
    /// the forces.
    pub(super) fn friction(&self, gear: usize) -> Option<Senses<([f64; 3], [f64; 2])>> {
        match self {
            Self::Cylindrical(_) => None,
            // The teeth act against the motion of the first gear if it drives.
            Self::Crossed(mesh) => Some(std::array::from_fn(|sense| {
                let [first, second] = mesh.friction[gear][sense];
                if sense == 0 { [second, first] } else { [first, second] }
            })),
        }
    }

    /// True if the teeth push the shafts along their axes.
    pub fn has_thrust(&self) -> bool {
        match self {
            Self::Cylindrical(mesh) => mesh.hand_tan_beta != 0.0,
            Self::Crossed(_) => true,
        }
    }
}

/// The complete layout.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Layout {
    /// Members by number.
    pub members: Vec<MemberLayout>,
    /// Supports by number.
    pub supports: Vec<SupportLayout>,
    /// Meshes by number.
    pub meshes: Vec<MeshLayout>,
}

impl Layout {
    /// The supported and the supporting member of a support: idler gears and planets are supported, else the inner member by the outer.
    pub(crate) fn carried(&self, support: &SupportLayout) -> (usize, Option<usize>) {
        match support.outer {
            Some(outer) if self.members[outer].loose || self.members[outer].planet.is_some() => {
                (outer, Some(support.inner))
            }
            outer => (support.inner, outer),
        }
    }

    /// Meshes with a gear on each member.
    pub(crate) fn meshes_by_member(&self) -> Vec<Vec<usize>> {
        let mut lists = vec![Vec::new(); self.members.len()];
        for (i, mesh) in self.meshes.iter().enumerate() {
            let [first, second] = mesh.members();
            lists[first].push(i);
            if second != first {
                lists[second].push(i);
            }
        }
        lists
    }

    /// Supports of each member, inside or outside.
    pub(crate) fn supports_by_member(&self) -> Vec<Vec<usize>> {
        let mut lists = vec![Vec::new(); self.members.len()];
        for (i, support) in self.supports.iter().enumerate() {
            lists[support.inner].push(i);
            if let Some(outer) = support.outer.filter(|outer| *outer != support.inner) {
                lists[outer].push(i);
            }
        }
        lists
    }
}

/// Why loads cannot be found. Members and supports by number.
#[derive(Debug, Clone, PartialEq)]
pub enum LoadFault {
    /// Members support each other in a loop.
    Cycle {
        /// The members.
        members: Vec<usize>,
    },
    /// The supports let the member tilt or move.
    Mechanism {
        /// The member.
        member: usize,
        /// Its supports.
        supports: Vec<usize>,
    },
    /// Several supports can take the same thrust, and no shares are stated.
    AxialIndeterminate {
        /// The member.
        member: usize,
        /// The supports that can.
        supports: Vec<usize>,
        /// True for thrust towards +x.
        right: bool,
    },
    /// Springs press several rings of a pair.
    SeveralSprings {
        /// The member.
        member: usize,
        /// The supports with springs.
        supports: Vec<usize>,
    },
    /// A spring presses one of several supports of a pair that take the same thrust.
    SpringOfSeveral {
        /// The support with the spring.
        support: usize,
        /// All supports of its side.
        supports: Vec<usize>,
    },
    /// A spring lifts a ring of a pair off its rolling elements.
    SpringLifts {
        /// The support with the spring.
        support: usize,
    },
    /// Diameters are missing although more than two supports carry a member.
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
        /// Position of the hinge. \[m\]
        at: f64,
    },
}
