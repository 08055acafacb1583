//! Stage data: the derived geometry of every mesh in common units, and the ratio of every gear state.

use schemars::JsonSchema;
use serde::Serialize;

use super::{Case, CrossedKind, TransferLaw, Transmission};
use crate::evaluate::{Point, PowerFlow, Solution};
use crate::loss::Extent;
use crate::material::MaterialKind;

/// Derived geometry of one mesh; values of two gears in the order of `gears`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Stage {
    /// Path of the mesh.
    pub mesh: String,
    /// Ids of both gears.
    pub gears: [String; 2],
    /// Numbers of teeth. [-]
    pub z: [u32; 2],
    /// True if the second gear is a ring gear with internal teeth.
    pub internal: bool,
    /// Number of teeth of the second gear over that of the first. [-]
    pub ratio: f64,
    /// Working centre distance. [mm]
    pub centre_distance_mm: f64,
    /// Reference centre distance, without profile shifts. [mm]
    pub reference_centre_distance_mm: f64,
    /// Profile shift coefficients according to ISO 21771, also for ring gears. [-]
    pub profile_shift: [f64; 2],
    /// Transverse pressure angle alpha_t. [deg]
    pub transverse_pressure_angle_deg: f64,
    /// Working transverse pressure angle alpha_wt. [deg]
    pub working_pressure_angle_deg: f64,
    /// Base helix angle beta_b. [deg]
    pub base_helix_angle_deg: f64,
    /// Transverse contact ratio eps_alpha; null if the pair is treated as pitch circles. [-]
    pub transverse_contact_ratio: Option<f64>,
    /// Overlap contact ratio eps_beta. [-]
    pub overlap_contact_ratio: f64,
    /// Face width that both gears share. [mm]
    pub face_overlap_mm: f64,
    /// Face widths. [mm]
    pub facewidth_mm: [f64; 2],
    /// Reference diameters d. [mm]
    pub reference_diameter_mm: [f64; 2],
    /// Base diameters d_b. [mm]
    pub base_diameter_mm: [f64; 2],
    /// Working pitch diameters d_w. [mm]
    pub pitch_diameter_mm: [f64; 2],
    /// Tip diameters d_a, stated or from the standard basic rack. [mm]
    pub tip_diameter_mm: [f64; 2],
    /// Root diameters d_f, stated or from the standard basic rack. [mm]
    pub root_diameter_mm: [f64; 2],
    /// Clearances between the tip of each gear and the root of its mate; null if the pair is treated as pitch circles. [mm]
    pub tip_clearance_mm: Option<[f64; 2]>,
    /// Normal tooth widths at the tips; null for a ring gear and for pitch circles. [mm]
    pub tip_width_mm: [Option<f64>; 2],
    /// Profile shift coefficients below which a standard rack undercuts the teeth; null for a ring gear. [-]
    pub undercut_limit: [Option<f64>; 2],
    /// Specific sliding of each gear at the lowest point of its contacting flank; null for pitch circles. [-]
    pub specific_sliding: Option<[f64; 2]>,
    /// Kinds of the materials, if a gear names its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<[MaterialKind; 2]>,
    /// Young's moduli, if a gear names its material. [GPa]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elastic_modulus_gpa: Option<[f64; 2]>,
    /// Reduced modulus of the contact, 2/E' = (1 - nu1^2)/E1 + (1 - nu2^2)/E2, if a gear names its material. [GPa]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reduced_modulus_gpa: Option<f64>,
}

/// Derived geometry of one mesh of gears on axes that cross; values of two gears in the order of `gears`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CrossedStage {
    /// Path of the mesh.
    pub mesh: String,
    /// Kind of the pair.
    pub kind: CrossedKind,
    /// Ids of both gears.
    pub gears: [String; 2],
    /// Numbers of teeth, of a worm that of its threads. [-]
    pub z: [u32; 2],
    /// Number of teeth of the second gear over that of the first. [-]
    pub ratio: f64,
    /// Shaft angle, between the axes from apex to base. [deg]
    pub shaft_angle_deg: f64,
    /// Distance of the axes. [mm]
    pub offset_mm: f64,
    /// Pitch angles; zero of a worm and of cylindrical gears. [deg]
    pub pitch_angle_deg: [f64; 2],
    /// Mean spiral angles; helix angles of a worm and of cylindrical gears, the second one of a pair with equal hands negative. [deg]
    pub spiral_angle_deg: [f64; 2],
    /// Mean normal module m_mn. [mm]
    pub mean_normal_module_mm: f64,
    /// Mean pitch diameters d_m. [mm]
    pub mean_diameter_mm: [f64; 2],
    /// Mean cone distances R_m; null without cones. [mm]
    pub mean_cone_distance_mm: Option<[f64; 2]>,
    /// Outer pitch diameters d_e; null without cones. [mm]
    pub outer_diameter_mm: Option<[f64; 2]>,
    /// Tip diameters, of bevel gears outer ones d_ae. [mm]
    pub tip_diameter_mm: [f64; 2],
    /// Normal pressure angles of the drive and of the coast flank. [deg]
    pub pressure_angle_deg: [f64; 2],
    /// Limit pressure angle; zero without offset. [deg]
    pub limit_pressure_angle_deg: f64,
    /// Positions of the mean point along both shafts. [mm]
    pub at_mm: [f64; 2],
    /// Distances of the mean point from the crossing point or the common perpendicular of the axes, along the axes towards the base. [mm]
    pub mounting_distance_mm: [f64; 2],
    /// Mean point: x, y, z. [mm]
    pub mean_point_mm: [f64; 3],
}

impl Transmission {
    /// Derived geometry of all meshes of gears on axes that cross, in the order of the document.
    pub fn crossed_stages(&self) -> impl Iterator<Item = CrossedStage> {
        self.meshes.iter().filter_map(|mesh| {
            let teeth = mesh.seat.crossed()?;
            let cones = &teeth.cones;
            let gears = mesh.seat.gears.map(|g| &self.gears[g]);
            let mm = |lengths: [f64; 2]| lengths.map(|length| length * 1e3);
            let deg = |angles: [f64; 2]| angles.map(f64::to_degrees);
            let is_bevel = teeth.kind == CrossedKind::Bevel;
            Some(CrossedStage {
                mesh: mesh.seat.path.clone(),
                kind: teeth.kind,
                gears: gears.map(|gear| gear.id.clone()),
                z: cones.z,
                ratio: cones.ratio(),
                shaft_angle_deg: cones.shaft_angle.to_degrees(),
                offset_mm: cones.offset.abs() * 1e3,
                pitch_angle_deg: deg(cones.pitch_angle),
                spiral_angle_deg: deg(cones.spiral_angle),
                mean_normal_module_mm: cones.normal_module() * 1e3,
                mean_diameter_mm: mm(cones.radius.map(|radius| 2.0 * radius)),
                mean_cone_distance_mm: is_bevel.then(|| mm(cones.cone_distance())),
                outer_diameter_mm: is_bevel.then(|| mm(gears.map(|gear| gear.diameters[0]))),
                tip_diameter_mm: mm(gears.map(|gear| gear.diameters[1])),
                pressure_angle_deg: deg(teeth.pressure_angle),
                limit_pressure_angle_deg: cones.limit_pressure_angle().to_degrees(),
                at_mm: mm(gears.map(|gear| gear.at)),
                mounting_distance_mm: mm(teeth.mounting_distance()),
                mean_point_mm: (teeth.mean_point * 1e3).into(),
            })
        })
    }
}

/// Derived geometry of one chain or belt over wheels with teeth; values of two wheels in the order of `wheels`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ChainStage {
    /// Path of the chain.
    pub chain: String,
    /// Numbers of teeth. [-]
    pub z: [u32; 2],
    /// Number of teeth of the second wheel over that of the first. [-]
    pub ratio: f64,
    /// Centre distance. [mm]
    pub centre_distance_mm: f64,
    /// Radii at which the tension acts: the length of the links around a wheel over 2 pi. [mm]
    pub radius_mm: [f64; 2],
    /// Angles over which the chain wraps the wheels. [deg]
    pub wrap_deg: [f64; 2],
    /// Length that wheels and centre distance need, in links. [-]
    pub links_needed: f64,
    /// Links that are stated; null if none are. [-]
    pub links: Option<u32>,
}

impl Transmission {
    /// Derived geometry of all chains and belts over wheels with teeth.
    pub fn chain_stages(&self) -> impl Iterator<Item = ChainStage> {
        self.transfers.iter().filter_map(|transfer| {
            let (TransferLaw::Chain(part, _), Some(strands)) = (&transfer.law, &transfer.seat.strands) else {
                return None;
            };
            let z = part.z?;
            Some(ChainStage {
                chain: transfer.seat.path.clone(),
                z,
                ratio: f64::from(z[1]) / f64::from(z[0]),
                centre_distance_mm: strands.distance * 1e3,
                radius_mm: strands.radii.map(|r| r * 1e3),
                wrap_deg: strands.wraps().map(f64::to_degrees),
                links_needed: strands.length / part.pitch?,
                links: part.links,
            })
        })
    }

    /// Derived geometry of all meshes of cylindrical gears, in the order of the document.
    pub fn stages(&self) -> impl Iterator<Item = Stage> {
        self.meshes.iter().filter_map(|mesh| {
            let part = mesh.law.cylindrical()?;
            let pair = &part.pair;
            let gears = mesh.seat.gears.map(|g| &self.gears[g]);
            let named = gears.iter().any(|gear| gear.material.is_some());
            let mm = |lengths: [f64; 2]| lengths.map(|length| length * 1e3);
            let external = |gear: usize| Some(gear).filter(|gear| !pair.internal || *gear == 0);
            Some(Stage {
                mesh: mesh.seat.path.clone(),
                gears: gears.map(|g| g.id.clone()),
                z: pair.z,
                internal: pair.internal,
                ratio: pair.ratio(),
                centre_distance_mm: pair.centre_distance * 1e3,
                reference_centre_distance_mm: pair.reference_distance * 1e3,
                profile_shift: pair.profile_shift,
                transverse_pressure_angle_deg: pair.transverse_angle.to_degrees(),
                working_pressure_angle_deg: pair.working_angle.to_degrees(),
                base_helix_angle_deg: pair.base_helix.to_degrees(),
                transverse_contact_ratio: pair.involute.then_some(pair.contact_ratio),
                overlap_contact_ratio: pair.overlap_ratio,
                face_overlap_mm: pair.facewidth * 1e3,
                facewidth_mm: mm(gears.map(|g| g.facewidth)),
                reference_diameter_mm: mm(pair.reference_diameter),
                base_diameter_mm: mm(pair.base_radius.map(|r| 2.0 * r)),
                pitch_diameter_mm: mm(pair.working_radius.map(|r| 2.0 * r)),
                tip_diameter_mm: mm(pair.tip_diameter),
                root_diameter_mm: mm(pair.root_diameter),
                tip_clearance_mm: pair.involute.then(|| mm([0, 1].map(|gear| pair.tip_clearance(gear)))),
                tip_width_mm: [0, 1].map(|gear| {
                    external(gear)
                        .filter(|_| pair.involute)
                        .map(|_| 1e3 * pair.tip_width(gear))
                }),
                undercut_limit: [0, 1].map(|gear| external(gear).map(|gear| pair.undercut_limit(gear))),
                specific_sliding: pair.involute.then(|| pair.specific_sliding()),
                material: named.then(|| part.materials.map(|material| material.kind)),
                elastic_modulus_gpa: named.then(|| part.elastic().map(|elastic| elastic.modulus * 1e-9)),
                reduced_modulus_gpa: named.then_some(part.modulus * 1e-9),
            })
        })
    }

    /// The case of a gear state in which the reference port has the single given speed and the first given torque; `None` if its
    /// speed does not determine all others.
    pub fn case_at_reference(&self, state: usize) -> Option<Case> {
        let reference = &self.ports[self.reference_port()].name;
        let mut order: Vec<&str> = self.ports.iter().map(|p| p.name.as_str()).collect();
        order.sort_by_key(|port| port != reference);
        order.truncate(self.torques_needed(state));
        let state = &self.states[state];
        let alone = state.speed_ports.len() == 1;
        alone
            .then(|| self.case(&state.name, &[reference], &order).ok())
            .flatten()
    }

    /// Calls `each` for every point of speed and torque at the reference port in a gear state, solved with an ideal flow and the oil at its
    /// temperature, and returns the notes of the models. Without a case at the reference port it calls nothing; points with a torque are left
    /// out where no port has one. \[rad/s, Nm\]
    pub fn at_reference(
        &self,
        state: usize,
        points: impl IntoIterator<Item = [f64; 2]>,
        mut each: impl FnMut([f64; 2], &Solution<'_>),
    ) -> Vec<Extent> {
        let Some(case) = self.case_at_reference(state) else {
            return Vec::new();
        };
        let mut scratch = self.scratch(&case);
        let mut torques = vec![0.0; case.torque_ports.len()];
        for place @ [speed, torque] in points {
            match torques.first_mut() {
                Some(first) => *first = torque,
                None if torque != 0.0 => continue,
                None => {}
            }
            let point = Point {
                speeds: &[speed],
                torques: &torques,
                flow: PowerFlow::Ideal,
                ..Point::default()
            };
            each(
                place,
                &self.evaluate(&case, &point, &[self.oil_temperature], &mut scratch),
            );
        }
        scratch.totals
    }

    /// What `read` takes from the rated torque and speed at the reference port in a gear state; `None` without a rating, if they do not
    /// determine the state, or if no power flows.
    pub fn at_rating<T>(&self, state: usize, read: impl FnOnce(&Solution<'_>) -> T) -> Option<T> {
        let rating = self.rating?;
        let (mut read, mut found) = (Some(read), None);
        self.at_reference(state, [[rating.speed, rating.torque]], |_, solution| {
            if solution.has_flow() {
                found = read.take().map(|read| read(solution));
            }
        });
        found
    }

    /// Speed of the reference port over that of each other port in a gear state, by port; `None` if that port is stationary, and
    /// empty if the speed of the reference port does not determine all others.
    pub fn ratios(&self, state: usize) -> Vec<(usize, Option<f64>)> {
        let reference = self.reference_port();
        let Some(case) = self.case_at_reference(state) else {
            return Vec::new();
        };
        let speeds = self.speeds(&case, &[1.0]);
        let others = (0..self.ports.len()).filter(|port| *port != reference);
        others
            .map(|port| {
                let speed = speeds[self.ports[port].member];
                (port, (speed != 0.0).then(|| 1.0 / speed))
            })
            .collect()
    }
}
