//! One pair of cylindrical involute gears.
//!
//! Sources: ISO 21771; points on the line of action as in DIN 3990: T1, T2 tangent points, A first contact, E last contact
//! when the first gear drives, B and D ends of double contact, C pitch point.

use super::crossed::CrossedMotion;
use super::involute::{inverse_involute, involute};
use crate::real::Real;

/// Input data of a pair. SI; angles in rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairSpec {
    /// Numbers of teeth, also positive for a ring gear.
    pub z: [u32; 2],
    /// The second gear is a ring.
    pub internal: bool,
    /// Normal module. \[m\]
    pub normal_module: f64,
    /// Normal pressure angle. \[rad\]
    pub pressure_angle: f64,
    /// Helix angle at the reference circle, magnitude. \[rad\]
    pub helix_angle: f64,
    /// Working centre distance; `None`: that of the profile shifts. \[m\]
    pub centre_distance: Option<f64>,
    /// Profile shift coefficients according to ISO 21771, also for a ring gear: positive ones thicken the teeth and move the tips
    /// away from the reference circle, towards the axis for a ring gear. `None`: the value that matches the centre distance.
    pub profile_shift: [Option<f64>; 2],
    /// Tip diameters; `None`: that of the standard basic rack; required for a ring gear. \[m\]
    pub tip_diameter: [Option<f64>; 2],
    /// Root diameters; `None`: that of the standard basic rack. \[m\]
    pub root_diameter: [Option<f64>; 2],
    /// Effective face width. \[m\]
    pub facewidth: f64,
    /// Shortens the tips of external gears with profile shift to maintain the tip clearance.
    pub tip_shortening: bool,
}

/// Why a pair is impossible. Lengths in m.
#[derive(Debug, Clone, PartialEq)]
pub enum PairFault {
    /// Centre distance and profile shifts disagree.
    Shifts {
        /// As given.
        centre_distance: f64,
        /// From the shifts.
        from_shifts: f64,
        /// The required sum x1 + x2 according to ISO 21771.
        sum: f64,
    },
    /// The centre distance is below the sum (external) or difference (internal) of the base radii.
    TooClose {
        /// As given.
        centre_distance: f64,
        /// The minimum.
        least: f64,
    },
    /// A ring gear requires its tip diameter.
    RingTip,
    /// A ring gear must have more teeth than its mate.
    RingTeeth,
    /// A tip circle is inside its base circle, or a ring gear's tip circle does not reach the path of contact.
    Tip {
        /// Number of the gear, 0 or 1.
        gear: usize,
        /// Its tip diameter.
        diameter: f64,
        /// Its base diameter.
        base: f64,
    },
    /// Contact would start below the base circle of a gear.
    BelowBase {
        /// Number of the gear whose flank is used below its base circle.
        gear: usize,
    },
    /// The transverse contact ratio is below one.
    ContactRatio {
        /// The ratio.
        ratio: f64,
    },
}

impl PairFault {
    /// True if only the teeth are impossible, while the pitch circles can still roll on each other.
    pub fn is_of_teeth(&self) -> bool {
        !matches!(self, Self::Shifts { .. } | Self::RingTeeth)
    }
}

impl std::fmt::Display for PairFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let name = |gear: usize| if gear == 0 { "first" } else { "second" };
        match self {
            Self::Shifts {
                centre_distance,
                from_shifts,
                sum,
            } => write!(
                f,
                "the centre distance is {:.4} mm, but the profile shifts give {:.4} mm; it requires a sum x1 + x2 of {:.4}",
                centre_distance * 1e3,
                from_shifts * 1e3,
                // No negative zero.
                (sum * 1e4).round() / 1e4 + 0.0
            ),
            Self::TooClose { centre_distance, least } => write!(
                f,
                "the centre distance {:.4} mm does not exceed {:.4} mm, so the base circles have no line of action",
                centre_distance * 1e3,
                least * 1e3
            ),
            Self::RingTip => write!(f, "a ring gear requires its tip diameter"),
            Self::RingTeeth => write!(f, "a ring gear must have more teeth than its mate"),
            Self::Tip { gear, diameter, base } => write!(
                f,
                "the tip diameter {:.3} mm of the {} gear is not above its base diameter {:.3} mm",
                diameter * 1e3,
                name(*gear),
                base * 1e3
            ),
            Self::BelowBase { gear } => {
                write!(
                    f,
                    "contact starts below the base circle of the {} gear: the tip diameter of its mate is too large",
                    name(*gear)
                )
            }
            Self::ContactRatio { ratio } => write!(f, "the transverse contact ratio is {ratio:.3}, below one"),
        }
    }
}

/// What the centre distance of a pair requires of its teeth. Lengths in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RequiredShifts {
    /// The centre distance.
    pub centre_distance: f64,
    /// That without profile shift.
    pub reference_distance: f64,
    /// That at which the base circles have no line of action.
    pub least: f64,
    /// The transverse working pressure angle in rad and the sum x1 + x2 according to ISO 21771; absent up to `least`.
    pub fit: Option<(f64, f64)>,
}

impl PairSpec {
    /// What the centre distance requires; `None` without one.
    pub fn required_shifts(&self) -> Option<RequiredShifts> {
        let centre_distance = self.centre_distance?;
        let (module_t, alpha_t, teeth) = self.transverse();
        let reference_distance = 0.5 * module_t * teeth;
        let least = reference_distance * alpha_t.cos();
        let fit = (centre_distance > least).then(|| {
            let working = (least / centre_distance).acos();
            (working, self.shift_sum(alpha_t, teeth, working))
        });
        Some(RequiredShifts {
            centre_distance,
            reference_distance,
            least,
            fit,
        })
    }

    /// Transverse module in m, transverse pressure angle in rad, sum of the teeth, where those of a ring gear are positive and those of its mate
    /// negative.
    fn transverse(&self) -> (f64, f64, f64) {
        let (beta, [z1, z2]) = (self.helix_angle, self.z.map(f64::from));
        let module_t = self.normal_module / beta.cos();
        let alpha_t = (self.pressure_angle.tan() / beta.cos()).atan();
        (module_t, alpha_t, z2 + self.sign() * z1)
    }

    /// One for external pairs, minus one for internal ones.
    pub fn sign(&self) -> f64 {
        if self.internal { -1.0 } else { 1.0 }
    }

    /// Sum x1 + x2 according to ISO 21771 of a transverse working pressure angle in rad.
    fn shift_sum(&self, alpha_t: f64, teeth: f64, working: f64) -> f64 {
        self.sign() * ((involute(working) - involute(alpha_t)) * teeth / (2.0 * self.pressure_angle.tan()))
    }
}

/// Where the axes of a pair are, and the profile shifts that this takes.
struct Axes {
    centre_distance: f64,
    working_angle: f64,
    profile_shift: [f64; 2],
    shortening: f64,
}

impl Axes {
    /// From the transverse pressure angle in rad, the sum of the teeth and the reference centre distance in m.
    fn new(spec: &PairSpec, alpha_t: f64, teeth: f64, a: f64, involute_pair: bool) -> Result<Self, PairFault> {
        let (s, m, alpha_n) = (spec.sign(), spec.normal_module, spec.pressure_angle);
        // ISO 21771: inv alpha_wt = inv alpha_t + 2 tan alpha_n (x1 + x2)/(z1 + z2), where z2 of a ring gear is negative; `teeth`
        // is the magnitude of that sum.
        let distance_of = |sum: f64| {
            let involute = involute(alpha_t) + 2.0 * alpha_n.tan() * (s * sum) / teeth;
            // No angle has a negative involute: the shifts are impossible even at the minimum centre distance.
            let working = if involute > 0.0 {
                inverse_involute(involute)
            } else {
                0.0
            };
            a * alpha_t.cos() / working.cos()
        };
        let sum_of = |working: f64| spec.shift_sum(alpha_t, teeth, working);
        let both = match spec.profile_shift {
            [Some(x1), Some(x2)] => Some(x2 + x1),
            _ => None,
        };
        let centre_distance = match (spec.centre_distance, both) {
            (Some(distance), Some(sum)) => {
                let from_shifts = distance_of(sum);
                if (from_shifts / distance - 1.0).abs() > 1e-4 {
                    let cos = (a * alpha_t.cos() / distance).min(1.0);
                    return Err(PairFault::Shifts {
                        centre_distance: distance,
                        from_shifts,
                        sum: sum_of(cos.acos()),
                    });
                }
                distance
            }
            (Some(distance), None) => distance,
            (None, Some(sum)) => distance_of(sum),
            (None, None) => distance_of(spec.profile_shift[1].unwrap_or(0.0) + spec.profile_shift[0].unwrap_or(0.0)),
        };
        let least = a * alpha_t.cos();
        if centre_distance <= least && involute_pair {
            return Err(PairFault::TooClose { centre_distance, least });
        }
        let working_angle = if centre_distance > least {
            (least / centre_distance).acos()
        } else {
            alpha_t
        };
        let sum = sum_of(working_angle);
        let profile_shift = match spec.profile_shift {
            [Some(x1), Some(x2)] => [x1, x2],
            [Some(x1), None] => [x1, sum - x1],
            [None, Some(x2)] => [sum - x2, x2],
            // No negative zero.
            [None, None] if spec.internal => [0.0, sum + 0.0],
            [None, None] => [0.5 * sum, 0.5 * sum],
        };
        let shortening = if spec.internal || !spec.tip_shortening {
            0.0
        } else {
            ((centre_distance - a) / m - (profile_shift[0] + profile_shift[1])).min(0.0)
        };
        Ok(Self {
            centre_distance,
            working_angle,
            profile_shift,
            shortening,
        })
    }

    /// As stated, else those of the standard basic rack. \[m\]
    fn tip_diameters(&self, spec: &PairSpec, reference: [f64; 2]) -> [f64; 2] {
        let tip = |i: usize| {
            let outwards = if spec.internal && i == 1 { -1.0 } else { 1.0 };
            let rack = outwards * 2.0 * spec.normal_module * (1.0 + self.profile_shift[i] + self.shortening);
            spec.tip_diameter[i].unwrap_or(reference[i] + rack)
        };
        [tip(0), tip(1)]
    }

    /// As stated, else those of the standard basic rack. \[m\]
    fn root_diameters(&self, spec: &PairSpec, reference: [f64; 2], tip: [f64; 2]) -> [f64; 2] {
        let m = spec.normal_module;
        let root = |i: usize| {
            spec.root_diameter[i].unwrap_or(if spec.internal && i == 1 {
                tip[1] + 4.5 * m
            } else {
                reference[i] - 2.0 * m * (1.25 - self.profile_shift[i])
            })
        };
        [root(0), root(1)]
    }
}

/// Gears whose tips do not reach beyond their base circles.
fn below_base(tip_diameter: [f64; 2], base_radius: [f64; 2]) -> Vec<PairFault> {
    (0..2)
        .filter(|i| tip_diameter[*i] <= 2.0 * base_radius[*i])
        .map(|i| PairFault::Tip {
            gear: i,
            diameter: tip_diameter[i],
            base: 2.0 * base_radius[i],
        })
        .collect()
}

/// Faults of a path of contact between two distances from T1. \[m\]
fn impossible_contact(
    spec: &PairSpec,
    [start, end]: [f64; 2],
    tangent_length: f64,
    contact_ratio: f64,
) -> Vec<PairFault> {
    let faults = [
        (start < 0.0, PairFault::BelowBase { gear: 0 }),
        (!spec.internal && end > tangent_length, PairFault::BelowBase { gear: 1 }),
        (contact_ratio < 1.0, PairFault::ContactRatio { ratio: contact_ratio }),
    ];
    let found = faults.into_iter().filter(|(is_found, _)| *is_found);
    found.map(|(_, fault)| fault).collect()
}

/// A pair with its computed geometry. SI; angles in rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// False for pitch circles only, see [`Pair::schematic`].
    pub involute: bool,
    /// Motion of the flanks of bevel and hypoid gears, see [`Pair::bevel`]; `None` for parallel axes.
    pub crossed: Option<CrossedMotion>,
    /// Numbers of teeth.
    pub z: [u32; 2],
    /// The second gear is a ring.
    pub internal: bool,
    /// Normal module. \[m\]
    pub normal_module: f64,
    /// Normal pressure angle. \[rad\]
    pub pressure_angle: f64,
    /// Helix angle at the reference circle. \[rad\]
    pub helix_angle: f64,
    /// Transverse pressure angle. \[rad\]
    pub transverse_angle: f64,
    /// Working transverse pressure angle. \[rad\]
    pub working_angle: f64,
    /// Base helix angle. \[rad\]
    pub base_helix: f64,
    /// Sine of `working_angle`, which mesh losses use at every point.
    pub sin_working_angle: f64,
    /// Cosine of `base_helix`, likewise.
    pub cos_base_helix: f64,
    /// Helix angle at the working pitch cylinder. \[rad\]
    pub working_helix: f64,
    /// Reference centre distance. \[m\]
    pub reference_distance: f64,
    /// Working centre distance. \[m\]
    pub centre_distance: f64,
    /// Profile shift coefficients according to ISO 21771.
    pub profile_shift: [f64; 2],
    /// Tip shortening coefficient, zero or negative.
    pub shortening: f64,
    /// Reference diameters. \[m\]
    pub reference_diameter: [f64; 2],
    /// Base radii. \[m\]
    pub base_radius: [f64; 2],
    /// Working pitch radii. \[m\]
    pub working_radius: [f64; 2],
    /// Tip diameters. \[m\]
    pub tip_diameter: [f64; 2],
    /// Root diameters. \[m\]
    pub root_diameter: [f64; 2],
    /// Transverse base pitch. \[m\]
    pub base_pitch: f64,
    /// Distance T1T2 along the line of action. \[m\]
    pub tangent_length: f64,
    /// Distances T1A, T1B, T1C, T1D, T1E. \[m\]
    pub points: [f64; 5],
    /// Transverse contact ratio.
    pub contact_ratio: f64,
    /// Addendum contact ratios of both gears.
    pub addendum_ratio: [f64; 2],
    /// Overlap ratio.
    pub overlap_ratio: f64,
    /// Effective face width. \[m\]
    pub facewidth: f64,
    /// Radius of relative curvature at the pitch point in the normal plane. \[m\]
    pub pitch_radius: f64,
}

impl Pair {
    /// Normal force on the flanks at a torque of the first gear in N m. \[N\]
    // Written so that a loop over torques divides once.
    #[inline(always)]
    pub fn normal_force<R: Real>(&self, torque: R) -> R {
        torque * (1.0 / (self.base_radius[0] * self.cos_base_helix))
    }

    /// Length of the line of contact of a pair of teeth, which is inclined by the base helix angle. \[m\]
    #[inline(always)]
    pub fn line_length(&self) -> f64 {
        self.facewidth / self.cos_base_helix
    }

    /// Normal force in N on one pair of teeth over the length of its line of contact: F_bn/(b/cos beta_b) = F_bt/b. Of a point contact over 4/3 of
    /// its long semi-axis. \[N/m\]
    #[inline(always)]
    pub fn line_load<R: Real>(&self, normal_force: R) -> R {
        if let Some(semi_axis) = self.spot() {
            let root = normal_force.cbrt();
            return root * root * (0.75 / semi_axis);
        }
        normal_force * (1.0 / self.line_length())
    }

    /// Long semi-axis of a point contact under one newton. \[m\]
    fn spot(&self) -> Option<f64> {
        self.crossed.as_ref()?.spot
    }

    /// True if the flanks touch in a point.
    pub fn touches_in_a_point(&self) -> bool {
        self.spot().is_some()
    }

    /// Computes the geometry.
    ///
    /// # Errors
    /// All faults that make the pair impossible.
    pub fn new(spec: &PairSpec) -> Result<Self, Vec<PairFault>> {
        Self::solve(spec, true)
    }

    /// Pitch circles that roll on each other, for teeth that form no involute pair or a ring gear without known tip diameter:
    /// ratio, pitch radii and the directions of forces, which are those at the reference circles if the centre distance leaves no
    /// line of action. A missing tip diameter is that of the standard basic rack. The path of contact is a point, all contact
    /// ratios are zero.
    ///
    /// # Errors
    /// Faults other than those of [`PairFault::is_of_teeth`].
    pub fn schematic(spec: &PairSpec) -> Result<Self, Vec<PairFault>> {
        Self::solve(spec, false)
    }

    fn solve(spec: &PairSpec, involute_pair: bool) -> Result<Self, Vec<PairFault>> {
        let s = spec.sign();
        let [z1, z2] = spec.z.map(f64::from);
        if spec.internal && z2 <= z1 {
            return Err(vec![PairFault::RingTeeth]);
        }
        if involute_pair && spec.internal && spec.tip_diameter[1].is_none() {
            return Err(vec![PairFault::RingTip]);
        }
        let (m, alpha_n, beta) = (spec.normal_module, spec.pressure_angle, spec.helix_angle);
        let (module_t, alpha_t, teeth) = spec.transverse();
        let base_helix = (beta.sin() * alpha_n.cos()).asin();
        let a = 0.5 * module_t * teeth;
        let axes = Axes::new(spec, alpha_t, teeth, a, involute_pair).map_err(|fault| vec![fault])?;
        let Axes {
            centre_distance,
            working_angle,
            profile_shift,
            shortening,
        } = axes;
        let reference_diameter = [module_t * z1, module_t * z2];
        let base_radius = reference_diameter.map(|d| 0.5 * d * alpha_t.cos());
        let tip_diameter = axes.tip_diameters(spec, reference_diameter);
        let root_diameter = axes.root_diameters(spec, reference_diameter, tip_diameter);
        if involute_pair {
            let faults = below_base(tip_diameter, base_radius);
            if !faults.is_empty() {
                return Err(faults);
            }
        }
        let tangent_length = centre_distance * working_angle.sin();
        let reach = |i: usize| ((0.5 * tip_diameter[i]).powi(2) - base_radius[i].powi(2)).sqrt();
        let pitch = base_radius[0] * working_angle.tan();
        let (start, end) = if involute_pair {
            (s * (tangent_length - reach(1)), reach(0))
        } else {
            (pitch, pitch)
        };
        let base_pitch = std::f64::consts::PI * module_t * alpha_t.cos();
        let contact_ratio = (end - start) / base_pitch;
        if involute_pair {
            let faults = impossible_contact(spec, [start, end], tangent_length, contact_ratio);
            if !faults.is_empty() {
                return Err(faults);
            }
        }
        let working_radius = [centre_distance * z1 / teeth, centre_distance * z2 / teeth];
        let mut pair = Self {
            involute: involute_pair,
            crossed: None,
            z: spec.z,
            internal: spec.internal,
            normal_module: m,
            pressure_angle: alpha_n,
            helix_angle: beta,
            transverse_angle: alpha_t,
            working_angle,
            base_helix,
            sin_working_angle: working_angle.sin(),
            cos_base_helix: base_helix.cos(),
            working_helix: (beta.tan() * alpha_t.cos() / working_angle.cos()).atan(),
            reference_distance: a,
            centre_distance,
            profile_shift,
            shortening,
            reference_diameter,
            base_radius,
            working_radius,
            tip_diameter,
            root_diameter,
            base_pitch,
            tangent_length,
            points: if involute_pair {
                [start, end - base_pitch, pitch, start + base_pitch, end]
            } else {
                [pitch; 5]
            },
            contact_ratio,
            addendum_ratio: [(end - pitch) / base_pitch, (pitch - start) / base_pitch],
            overlap_ratio: spec.facewidth * beta.sin() / (std::f64::consts::PI * m),
            facewidth: spec.facewidth,
            pitch_radius: 0.0,
        };
        pair.pitch_radius = pair.relative_radius(pitch);
        Ok(pair)
    }

    /// Plus one for external pairs, minus one for internal ones.
    pub fn sign(&self) -> f64 {
        if self.internal { -1.0 } else { 1.0 }
    }

    /// Gear ratio z2/z1.
    pub fn ratio(&self) -> f64 {
        f64::from(self.z[1]) / f64::from(self.z[0])
    }

    /// Radii of curvature of both flanks at a distance from T1 along the line of action, transverse. \[m\]
    pub fn curvature(&self, x: f64) -> [f64; 2] {
        [x, self.tangent_length - self.sign() * x]
    }

    /// Radius of relative curvature in the normal plane. \[m\]
    pub fn relative_radius(&self, x: f64) -> f64 {
        let [rho1, rho2] = self.curvature(x);
        let cylindrical = rho1 * rho2 / (rho2 + self.sign() * rho1) / self.base_helix.cos();
        match &self.crossed {
            None => cylindrical,
            Some(motion) => cylindrical * motion.radius_factor,
        }
    }

    /// Sliding speed per speed of the first gear. \[m\]
    pub fn sliding(&self, x: f64) -> f64 {
        let from_pitch = x - self.points[2];
        match &self.crossed {
            None => (1.0 + self.sign() / self.ratio()) * from_pitch.abs(),
            Some(motion) => motion.sliding_speed(from_pitch),
        }
    }

    /// Sliding speed along the teeth per speed of the first gear, which only gears with an offset of their axes have; it is a vector, the same
    /// on the whole path, to which that of the profile is added. \[m\]
    pub fn lengthwise_sliding(&self) -> f64 {
        self.crossed.as_ref().map_or(0.0, CrossedMotion::lengthwise)
    }

    /// Sum of the surface speeds across the line of contact per speed of the first gear. \[m\]
    pub fn sum_speed(&self, x: f64) -> f64 {
        match &self.crossed {
            None => {
                let [rho1, rho2] = self.curvature(x);
                rho1 + rho2 / self.ratio()
            }
            Some(motion) => {
                let [first, second] = motion.rolling(x - self.points[2]);
                (first + second).abs()
            }
        }
    }

    /// True where the flank of the first gear is the faster one.
    pub fn first_is_faster(&self, x: f64) -> bool {
        match &self.crossed {
            None => x > self.points[2],
            Some(motion) => {
                let [first, second] = motion.rolling(x - self.points[2]);
                first.abs() > second.abs()
            }
        }
    }

    /// Normal tooth width at the tip of an external gear. \[m\]
    pub fn tip_width(&self, gear: usize) -> f64 {
        let d = self.reference_diameter[gear];
        let tip = self.tip_diameter[gear];
        let at_tip = (2.0 * self.base_radius[gear] / tip).acos();
        let thickness = 0.5 * std::f64::consts::PI + 2.0 * self.profile_shift[gear] * self.pressure_angle.tan();
        let angle = thickness / f64::from(self.z[gear]) + involute(self.transverse_angle) - involute(at_tip);
        let helix = (self.helix_angle.tan() * tip / d).atan();
        tip * angle * helix.cos()
    }

    /// Clearance between a tip and the mate's root. \[m\]
    pub fn tip_clearance(&self, gear: usize) -> f64 {
        let [tip, root] = [self.tip_diameter[gear], self.root_diameter[1 - gear]].map(|d| 0.5 * d);
        match (self.internal, gear) {
            (false, _) => self.centre_distance - tip - root,
            (true, 0) => root - self.centre_distance - tip,
            (true, _) => tip - self.centre_distance - root,
        }
    }

    /// Profile shift coefficient of an external gear below which a rack with a straight flank of one module below the pitch line
    /// (form dedendum of the basic rack A of ISO 53) undercuts its teeth.
    pub fn undercut_limit(&self, gear: usize) -> f64 {
        1.0 - f64::from(self.z[gear]) * self.transverse_angle.sin().powi(2) / (2.0 * self.helix_angle.cos())
    }

    /// Specific sliding of both gears where it is lowest, at the lowest points of their contacting flanks: sliding speed of the flank
    /// against its mate over its own surface speed, negative (ISO 21771).
    pub fn specific_sliding(&self) -> [f64; 2] {
        let [a, .., e] = self.points;
        let [[first, mate], [mate_at_e, own_at_e]] = [self.curvature(a), self.curvature(e)];
        [
            1.0 - mate / (self.ratio() * first),
            1.0 - self.ratio() * mate_at_e / own_at_e,
        ]
    }
}
