//! Stiffness of one pair of teeth per face width along the path of contact.
//!
//! Sources: single stiffness c' of ISO 6336-1, as two public codes agree (without C_R: solid gears); for a ring the number of teeth is
//! infinite, quoted from memory. Variation as a cosine along the path: Sanchez, Pedrero and Pleguezuelos, quoted from memory. Bending and
//! shear of the tooth, its root and the Hertzian contact: Weber and Banaschek 1953 in the form for any Poisson's ratio, re-derived; the
//! printed constants for 0.3 follow from it. The thickness below the form circle of the rack is held at its value there. Root with the ring
//! below the tooth: Sainsot, Velex and Duverger 2004, whose constants are the same in ten public codes.

use std::f64::consts::PI;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::geometry::{Pair, involute};
use crate::material::Elastic;

/// Law of the stiffness of one pair of teeth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StiffnessLaw {
    /// Bending, shear, root and Hertzian contact of the tooth at each place, after Weber and Banaschek. External gears.
    #[default]
    Weber,
    /// As `weber`, with the root of Sainsot, Velex and Duverger, which includes the ring between the `bore` of the gear and its teeth.
    Sainsot,
    /// The single stiffness of ISO 6336-1, the same along the path.
    Iso6336,
    /// A cosine along the path whose maximum is the single stiffness of ISO 6336-1, after Sanchez, Pedrero and Pleguezuelos.
    Cosine,
}

/// Theoretical single stiffness 1/q' of ISO 6336-1. \[N/(m m)\], which is 1e-9 N/(mm um)
fn theoretical(pair: &Pair) -> f64 {
    let virtual_teeth = |z: u32| f64::from(z) / (pair.base_helix.cos().powi(2) * pair.helix_angle.cos());
    let of = |pinion: usize| {
        let [z1, mut z2] = [pinion, 1 - pinion].map(|gear| virtual_teeth(pair.z[gear]));
        let [x1, x2] = [pinion, 1 - pinion].map(|gear| pair.profile_shift[gear]);
        if pair.internal {
            z2 = f64::INFINITY;
        }
        0.04723 + 0.15551 / z1 + 0.25791 / z2 - 0.00635 * x1 - 0.11654 * x1 / z1 - 0.00193 * x2 - 0.24188 * x2 / z2
            + 0.00529 * x1 * x1
            + 0.00182 * x2 * x2
    };
    // The formula is not symmetric: its first gear is the pinion. Of equal gears either is.
    let q = match pair.z[0].cmp(&pair.z[1]) {
        std::cmp::Ordering::Less => of(0),
        std::cmp::Ordering::Equal => 0.5 * (of(0) + of(1)),
        std::cmp::Ordering::Greater => of(1),
    };
    1e9 / q
}

/// Correction of measured to theoretical stiffness in ISO 6336-1.
const C_M: f64 = 0.8;

/// Single stiffness c' of ISO 6336-1 for a line load F_t/b of at least 100 N/mm. \[Pa\]
pub fn single_stiffness(pair: &Pair, materials: [Elastic; 2]) -> f64 {
    let dedendum = |gear: usize| {
        let depth = 0.5 * (pair.reference_diameter[gear] - pair.root_diameter[gear]).abs();
        depth / pair.normal_module + pair.profile_shift[gear]
    };
    let angle = 1.0 - 0.02 * (20.0 - pair.pressure_angle.to_degrees());
    let of = |gear: usize| (1.0 + 0.5 * (1.2 - dedendum(gear))) * angle;
    let rack = if pair.internal { of(0) } else { 0.5 * (of(0) + of(1)) };
    let [e1, e2] = materials.map(|m| m.modulus);
    let modulus = 2.0 * e1 * e2 / (e1 + e2) / 206e9;
    theoretical(pair) * C_M * rack * pair.helix_angle.cos() * modulus
}

/// Line load F_t/b below which c' falls with its fourth root in ISO 6336-1. \[N/m\]
const LIGHT: f64 = 100e3;

/// Stiffness of one pair of teeth along the path.
#[derive(Debug, Clone)]
pub enum Stiffness {
    /// The same everywhere. \[Pa\]
    Constant(f64),
    /// A cosine along the path.
    Cosine {
        /// Its maximum. \[Pa\]
        greatest: f64,
        /// Factor of the distance from the middle of the path. \[1/m\]
        factor: f64,
        /// Middle of the path. \[m\]
        middle: f64,
    },
    /// Teeth as beams.
    Weber(Box<Weber>),
}

impl Stiffness {
    /// The stiffness of a pair by a law; the single stiffness, if stated, replaces that of ISO 6336-1. \[Pa\]
    ///
    /// # Errors
    /// If the law does not describe the pair, as a sentence.
    pub fn new(
        pair: &Pair,
        (materials, bores): ([Elastic; 2], [Option<f64>; 2]),
        law: StiffnessLaw,
        single: Option<f64>,
    ) -> Result<Self, String> {
        let greatest = single.unwrap_or_else(|| single_stiffness(pair, materials));
        match law {
            StiffnessLaw::Iso6336 => Ok(Self::Constant(greatest)),
            StiffnessLaw::Cosine => {
                let ratio = 1.0 + 0.5 * pair.contact_ratio;
                let root = (0.5 * ratio * ratio - 1.0).max(f64::MIN_POSITIVE).sqrt();
                let [start, .., end] = pair.points;
                let factor = 1.0 / (root * pair.base_pitch);
                if 0.5 * (end - start) * factor >= 0.5 * PI {
                    return Err(format!(
                        "the cosine has no stiffness at the ends of a path with the contact ratio {:.2}",
                        pair.contact_ratio
                    ));
                }
                Ok(Self::Cosine {
                    greatest,
                    factor,
                    middle: 0.5 * (start + end),
                })
            }
            StiffnessLaw::Weber | StiffnessLaw::Sainsot if pair.internal => {
                Err("the teeth of a ring are no beams of this law".to_owned())
            }
            StiffnessLaw::Weber => Ok(Self::Weber(Box::new(Weber::new(pair, materials, [None; 2])))),
            StiffnessLaw::Sainsot => {
                let [Some(first), Some(second)] = bores else {
                    return Err("the ring below the teeth requires the `bore` of both gears".to_owned());
                };
                let bores = [first, second];
                for (gear, bore) in bores.iter().enumerate() {
                    if *bore >= pair.root_diameter[gear] {
                        return Err(format!(
                            "a bore of {:.3} mm leaves no ring below the root diameter {:.3} mm",
                            bore * 1e3,
                            pair.root_diameter[gear] * 1e3
                        ));
                    }
                }
                Ok(Self::Weber(Box::new(Weber::new(pair, materials, bores.map(Some)))))
            }
        }
    }

    /// Stiffness at a place under a line load in N/m. \[Pa\]
    pub fn at(&self, x: f64, line_load: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Cosine {
                greatest,
                factor,
                middle,
            } => greatest * (factor * (x - middle)).cos(),
            Self::Weber(teeth) => teeth.at(x, line_load),
        }
    }

    /// Factor on the stiffness under a line load F_bt/b of the mesh, which ISO 6336-1 takes from F_t/b. \[N/m\]
    pub fn factor(&self, pair: &Pair, line_load: f64, stated: bool) -> f64 {
        let tangential = line_load * pair.transverse_angle.cos();
        match self {
            Self::Weber(_) => 1.0,
            _ if stated || tangential >= LIGHT => 1.0,
            _ => (tangential / LIGHT).powf(0.25),
        }
    }

    /// True if it depends on the load of a slice.
    pub fn depends_on_load(&self) -> bool {
        matches!(self, Self::Weber(_))
    }
}

/// Compliance of one tooth loaded at a place of its flank, over 1/E.
#[derive(Debug, Clone, Copy)]
struct Tooth {
    poisson: f64,
    base_radius: f64,
    /// Half of the angle of the tooth at the reference circle plus the involute there.
    half_angle: f64,
    /// Height above the axis at the root, half thickness there, and height where the involute begins.
    root_height: f64,
    root_half: f64,
    form_height: f64,
    /// The ring below the tooth: coefficients L, M, P, Q of Sainsot, Velex and Duverger; `None`: a half-space.
    ring: Option<[f64; 4]>,
}

/// Coefficients A to F of L, M, P, Q of Sainsot, Velex and Duverger.
const RING: [[f64; 6]; 4] = [
    [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
    [60.111e-5, 28.1e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
    [-50.952e-5, 185.5e-3, 0.0538e-4, 53.3e-3, 0.2895, 0.9236],
    [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
];

/// What follows from the place of the load.
struct Loaded {
    bending: f64,
    root: f64,
    /// Distance of the contact from the centre line of the tooth along the load. \[m\]
    depth: f64,
}

impl Tooth {
    fn new(pair: &Pair, gear: usize, poisson: f64, bore: Option<f64>) -> Self {
        let radius = 0.5 * pair.reference_diameter[gear];
        let base_radius = pair.base_radius[gear];
        let (m, x) = (pair.normal_module, pair.profile_shift[gear]);
        let thickness = m * (0.5 * PI + 2.0 * x * pair.pressure_angle.tan()) / pair.helix_angle.cos();
        let half_angle = thickness / (2.0 * radius) + involute(pair.transverse_angle);
        let root_radius = 0.5 * pair.root_diameter[gear];
        let dedendum = (1.0 - x) * m;
        let form = (radius - dedendum).hypot(dedendum / pair.transverse_angle.tan());
        let form = form.max(base_radius).max(root_radius);
        let mut tooth = Self {
            poisson,
            base_radius,
            half_angle,
            root_height: 0.0,
            root_half: 0.0,
            form_height: 0.0,
            ring: None,
        };
        let angle = tooth.angle(form);
        tooth.root_half = (form * angle.sin()).max(1e-3 * m);
        tooth.form_height = form * angle.cos();
        tooth.root_height = (root_radius * root_radius - tooth.root_half * tooth.root_half)
            .max(0.0)
            .sqrt();
        tooth.ring = bore.map(|bore| {
            let (h, half) = (2.0 * root_radius / bore, tooth.root_half / root_radius);
            RING.map(|[a, b, c, d, e, f]| a / (half * half) + b * h * h + c * h / half + d / half + e * h + f)
        });
        tooth
    }

    /// Half of the angle of the tooth at a radius.
    fn angle(&self, radius: f64) -> f64 {
        self.half_angle - involute((self.base_radius / radius).min(1.0).acos())
    }

    /// Half of the thickness at a height above the axis. \[m\]
    fn half(&self, height: f64) -> f64 {
        if height <= self.form_height {
            return self.root_half;
        }
        let mut radius = height;
        for _ in 0..8 {
            let radius_now: f64 = radius.max(self.base_radius);
            let (angle, pressure) = (self.angle(radius_now), (self.base_radius / radius_now).min(1.0).acos());
            let slope = angle.cos() + angle.sin() * pressure.tan();
            let step = (radius_now * angle.cos() - height) / slope;
            radius = radius_now - step;
            if step.abs() < 1e-15 * radius {
                break;
            }
        }
        (radius * self.angle(radius).sin()).max(1e-3 * self.root_half)
    }

    /// The tooth loaded where its flank has a radius.
    fn loaded(&self, radius: f64, rule: &[(f64, f64)]) -> Loaded {
        let nu = self.poisson;
        let half_angle = self.angle(radius);
        let slant = (self.base_radius / radius).min(1.0).acos() - half_angle;
        let load_height = self.base_radius / slant.cos();
        let thick = 2.0 * self.root_half;
        let span = (load_height - self.root_height).max(0.0);
        let middle = self
            .form_height
            .clamp(self.root_height, load_height.max(self.root_height));
        let (mut bent, mut sheared) = (0.0, 0.0);
        for [low, high] in [[self.root_height, middle], [middle, load_height]] {
            if high <= low {
                continue;
            }
            for (t, w) in rule {
                let y = 0.5 * (low + high) + 0.5 * (high - low) * t;
                let (thickness, w) = (2.0 * self.half(y), 0.5 * (high - low) * w);
                bent += w * (load_height - y).powi(2) / thickness.powi(3);
                sheared += w / thickness;
            }
        }
        let across = slant.cos().powi(2);
        let pressed = 1.0 + (1.0 - nu) / 2.4 * slant.tan().powi(2);
        let plane = 1.0 - nu * nu;
        let lever = span / thick;
        let root = match self.ring {
            None => {
                18.0 / PI * plane * lever * lever
                    + 2.0 * (1.0 - 2.0 * nu) * (1.0 + nu) * lever
                    + 4.8 / PI * plane * pressed
            }
            Some([l, m, p, q]) => l * lever * lever + m * lever + p * (1.0 + q * slant.tan().powi(2)),
        };
        Loaded {
            bending: across * (12.0 * plane * bent + 2.4 * (1.0 + nu) * pressed * sheared),
            root: across * root,
            depth: (radius * half_angle.sin() / slant.cos()).max(1e-2 * self.root_half),
        }
    }
}

/// Places at which the compliance of beams is computed; between them it is interpolated.
const PLACES: usize = 65;

/// Points of the integrals over the height of a tooth on each of their two sections.
const HEIGHTS: usize = 16;

/// Teeth of a pair as beams, with a Hertzian contact.
#[derive(Debug, Clone)]
pub struct Weber {
    start: f64,
    step: f64,
    /// Compliance of both teeth without contact, and of the contact under a line load of one, at each place. \[1/Pa\]
    places: Vec<[f64; 2]>,
    /// Decrease of the compliance of the contact with the logarithm of the line load. \[1/Pa\]
    fall: f64,
}

/// The compliances of both teeth: bending, root and depth of each.
fn teeth_at(pair: &Pair, teeth: &[Tooth; 2], x: f64, rule: &[(f64, f64)]) -> [Loaded; 2] {
    let rho = pair.curvature(x);
    [0, 1].map(|gear| teeth[gear].loaded(pair.base_radius[gear].hypot(rho[gear]), rule))
}

/// Compliance of the half-spaces of both gears together. \[1/Pa\]
fn both_half_spaces(materials: [Elastic; 2]) -> f64 {
    materials.iter().map(|m| m.half_space()).sum()
}

/// Compliance of both teeth without contact, and of the contact under a line load of one, at a place. \[1/Pa\]
fn compliances(pair: &Pair, teeth: &[Tooth; 2], materials: [Elastic; 2], x: f64, rule: &[(f64, f64)]) -> [f64; 2] {
    let loaded = teeth_at(pair, teeth, x, rule);
    let body = (0..2).map(|i| (loaded[i].bending + loaded[i].root) / materials[i].modulus);
    // b_H^2 = 4 w rho/(pi E*) with 1/E* the sum of both half-spaces.
    let band = (4.0 * pair.relative_radius(x) * both_half_spaces(materials) / PI).sqrt();
    let contact = (0..2).map(|i| {
        let nu = materials[i].poisson;
        let depth = (2.0 * loaded[i].depth / band).ln() - nu / (2.0 * (1.0 - nu));
        2.0 / PI * materials[i].half_space() * depth
    });
    [body.sum(), contact.sum()]
}

impl Weber {
    fn new(pair: &Pair, materials: [Elastic; 2], bores: [Option<f64>; 2]) -> Self {
        let teeth = [0, 1].map(|gear| Tooth::new(pair, gear, materials[gear].poisson, bores[gear]));
        let rule = crate::geometry::gauss::rule(HEIGHTS);
        let [start, .., end] = pair.points;
        let step = (end - start) / (PLACES - 1) as f64;
        let half_spaces = both_half_spaces(materials);
        let places = (0..PLACES).map(|i| compliances(pair, &teeth, materials, start + step * i as f64, &rule));
        Self {
            start,
            step,
            places: places.collect(),
            fall: half_spaces / PI,
        }
    }

    fn at(&self, x: f64, line_load: f64) -> f64 {
        let place = ((x - self.start) / self.step).clamp(0.0, (PLACES - 1) as f64);
        let i = (place as usize).min(PLACES - 2);
        let t = place - i as f64;
        let between = |k: usize| self.places[i][k] + t * (self.places[i + 1][k] - self.places[i][k]);
        let body = between(0);
        // A band as wide as the tooth has no compliance of its own.
        let contact = (between(1) - self.fall * line_load.max(1.0).ln()).max(0.0);
        1.0 / (body + contact)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::tests::{STEEL, c14};
    use super::*;

    #[test]
    fn single_stiffness_of_c14() {
        let pair = c14();
        let close = |value: f64, printed: f64| assert!((value / printed - 1.0).abs() < 1e-6, "{value} {printed}");
        close(theoretical(&pair) * 1e-9, 15.77607502);
        let single = single_stiffness(&pair, [STEEL; 2]) * 1e-9;
        close(single, 12.30533851);
        close(single * (0.75 * pair.contact_ratio + 0.25), 16.574017604);
    }

    /// Bending, root of both teeth, contact, stiffness and Hertzian half width in mm at A, B, C, D, E.
    #[test]
    fn teeth_of_c14_as_beams() {
        let pair = c14();
        let teeth = [0, 1].map(|gear| Tooth::new(&pair, gear, 0.3, None));
        let rule = crate::geometry::gauss::rule(48);
        let printed = [
            [
                1.26896276, 2.41516108, 7.75520932, 6.69857314, 4.01325292, 9.29973903, 0.13375283,
            ],
            [
                1.57845659,
                2.70817586,
                3.16995176,
                4.04134460,
                3.98424415,
                13.30562580,
                0.18645649,
            ],
            [
                2.09940157,
                3.19792199,
                2.08916356,
                3.12751764,
                3.95925640,
                14.23314328,
                0.19954418,
            ],
            [
                3.10517825,
                4.06766241,
                1.43820901,
                2.51873722,
                3.90817109,
                13.69866842,
                0.20365444,
            ],
            [
                7.89768169, 6.86017040, 0.86547860, 1.98584997, 3.58206097, 9.72099717, 0.19012146,
            ],
        ];
        for (tooth, printed) in teeth.iter().zip([33.86425402, 51.30471409]) {
            let form = tooth.form_height.hypot(tooth.root_half) * 1e3;
            assert!((form / printed - 1.0).abs() < 1e-6, "{form} {printed}");
        }
        let load = 422.29276686e3_f64;
        let stiffness = Stiffness::new(&pair, ([STEEL; 2], [None; 2]), StiffnessLaw::Weber, None).unwrap();
        for (x, row) in pair.points.into_iter().zip(printed) {
            let loaded = teeth_at(&pair, &teeth, x, &rule);
            let found = [loaded[0].bending, loaded[0].root, loaded[1].bending, loaded[1].root];
            for (value, printed) in found.into_iter().zip(row) {
                assert!((value / printed - 1.0).abs() < 1e-6, "{value} {printed}");
            }
            let [body, contact] = compliances(&pair, &teeth, [STEEL; 2], x, &rule);
            let band = (4.0 * load * pair.relative_radius(x) * both_half_spaces([STEEL; 2]) / PI).sqrt() * 1e3;
            assert!((band / row[6] - 1.0).abs() < 1e-6, "{band} {}", row[6]);
            let pressed = contact - both_half_spaces([STEEL; 2]) / PI * load.ln();
            assert!((pressed * STEEL.modulus / row[4] - 1.0).abs() < 1e-6, "{pressed}");
            let c = 1e-9 / (body + pressed);
            assert!((c / row[5] - 1.0).abs() < 1e-6, "{c} {}", row[5]);
            // Between the places of the table it is interpolated.
            let c = stiffness.at(x, load) * 1e-9;
            assert!((c / row[5] - 1.0).abs() < 1e-4, "{c} {}", row[5]);
        }
    }

    /// Root with its ring at the pitch point, for a bore of 30 mm, and the stiffness there.
    #[test]
    fn rings_below_the_teeth_of_c14() {
        let pair = c14();
        let close = |value: f64, printed: f64| assert!((value / printed - 1.0).abs() < 1e-6, "{value} {printed}");
        let teeth = [0, 1].map(|gear| Tooth::new(&pair, gear, 0.3, Some(30e-3)));
        let rule = crate::geometry::gauss::rule(48);
        let loaded = teeth_at(&pair, &teeth, pair.points[2], &rule);
        close(loaded[0].root, 4.992010);
        close(loaded[1].root, 6.563075);
        let load = 422.29276686e3_f64;
        let [body, contact] = compliances(&pair, &teeth, [STEEL; 2], pair.points[2], &rule);
        let pressed = contact - both_half_spaces([STEEL; 2]) / PI * load.ln();
        close(1e-9 / (body + pressed), 10.455310);
        let of = |bores| Stiffness::new(&pair, ([STEEL; 2], bores), StiffnessLaw::Sainsot, None);
        assert!(of([Some(30e-3), None]).is_err() && of([Some(70e-3), Some(30e-3)]).is_err());
        assert!((of([Some(30e-3); 2]).unwrap().at(pair.points[2], load) * 1e-9 / 10.455310 - 1.0).abs() < 1e-4);
    }

    /// c' and c_gamma_alpha of a helical pair in the report of another program by ISO 6336:2006, with its factor C_R = 0.898 of the gear body,
    /// which is one here: z 24/95, module 14 mm, 10 deg, centre distance 861 mm, F_t/b 667 N/mm.
    #[test]
    fn single_stiffness_of_a_helical_pair() {
        let pair = super::super::tests::large_helical();
        let single = single_stiffness(&pair, [STEEL; 2]) * 1e-9;
        let close = |value: f64, printed: f64| assert!((value / printed - 1.0).abs() < 1e-3, "{value} {printed}");
        close(single * 0.898, 13.832);
        close(single * 0.898 * (0.75 * pair.contact_ratio + 0.25), 18.632);
    }

    #[test]
    fn a_cosine_lands_on_the_classical_third() {
        let pair = c14();
        let cosine = Stiffness::new(&pair, ([STEEL; 2], [None; 2]), StiffnessLaw::Cosine, Some(14e9)).unwrap();
        let [start, .., end] = pair.points;
        // The local loss factor of the shares by stiffness alone.
        // Shares jump at the ends of single contact.
        let of = |piece: &[f64]| {
            let at = |i: i32| {
                let x = piece[0] + (f64::from(i) + 0.5) / 5000.0 * (piece[1] - piece[0]);
                let others = [x - pair.base_pitch, x + pair.base_pitch].into_iter();
                let others = others.filter(|x| (start..=end).contains(x));
                let others: f64 = others.map(|x| cosine.at(x, 1.0)).sum();
                cosine.at(x, 1.0) / (cosine.at(x, 1.0) + others) * pair.sliding(x)
            };
            (0..5000).map(at).sum::<f64>() / 5000.0 * (piece[1] - piece[0])
        };
        let sum = pair.points.windows(2).map(of).sum::<f64>() / pair.base_pitch;
        let factor = sum / (pair.cos_base_helix * pair.base_radius[0]);
        assert!((factor / 0.1919463264 - 1.0).abs() < 1e-6, "{factor}");
        let Stiffness::Cosine { factor, .. } = cosine else {
            panic!("{cosine:?}")
        };
        assert!((factor * pair.base_pitch / 1.4161434985 - 1.0).abs() < 1e-6, "{factor}");
        let printed = [0.354561390, 0.419493143, 0.511360929, 0.604286420];
        for (xi, printed) in [0.0, 0.1, 0.25, 0.4].into_iter().zip(printed) {
            let [own, mate] = [xi, xi + 1.0].map(|xi| cosine.at(start + xi * pair.base_pitch, 1.0));
            assert!(
                (own / (own + mate) / printed - 1.0).abs() < 1e-6,
                "{}",
                own / (own + mate)
            );
        }
    }
}
