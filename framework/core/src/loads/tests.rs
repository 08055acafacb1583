#![allow(clippy::unwrap_used)]
use super::beam::{Beam, BeamFault, BeamLoad, BeamSupport};
use super::layout::Section;
use super::*;
use crate::attach::Axial;
use crate::real::{LANES, Lane, Points, Real};
use proptest::prelude::*;

fn close(value: f64, printed: f64, scale: f64) {
    assert!(
        (value - printed).abs() <= 1e-7 * scale.abs().max(printed.abs()),
        "{value} against {printed}"
    );
}

fn support(inner: usize, at_mm: f64, axial: Axial) -> SupportLayout {
    SupportLayout {
        inner,
        outer: None,
        at: at_mm * 1e-3,
        axial,
        share: None,
        spring: 0.0,
        takes_radial: true,
        takes_moment: false,
        radial_stiffness: None,
        tilting_stiffness: None,
        induced: None,
        preloaded: None,
    }
}

/// A mesh from tooth numbers and angles at the reference cylinder, mm and degrees.
struct Teeth {
    z: [f64; 2],
    m: f64,
    alpha: f64,
    beta: f64,
    a: f64,
    sign: f64,
}

fn cylindrical(meshes: Vec<CylindricalMesh>) -> Vec<MeshLayout> {
    meshes.into_iter().map(MeshLayout::Cylindrical).collect()
}

fn gears(mesh: &MeshLayout) -> &CylindricalMesh {
    match mesh {
        MeshLayout::Cylindrical(mesh) => mesh,
        MeshLayout::Crossed(_) => panic!("a mesh of cylindrical gears"),
    }
}

fn teeth<R>(tangential: &[R]) -> ToothForces<'_, R> {
    ToothForces {
        tangential,
        friction: &[],
        turning: &[],
    }
}

impl Teeth {
    fn mesh(&self, members: [usize; 2], at: f64, direction: [f64; 2], hand: f64) -> CylindricalMesh {
        let beta = self.beta.to_radians();
        let alpha_t = (self.alpha.to_radians().tan() / beta.cos()).atan();
        let teeth = self.z[1] + self.sign * self.z[0];
        let reference = 0.5 * self.m / beta.cos() * teeth;
        let working = (reference * alpha_t.cos() / self.a).acos();
        CylindricalMesh {
            members,
            at: at * 1e-3,
            radius: self.z.map(|z| self.a * 1e-3 * z / teeth),
            sign: self.sign,
            direction,
            across: 1.0,
            tan_alpha: working.tan(),
            hand_tan_beta: hand * beta.tan() * alpha_t.cos() / working.cos(),
            count: 1.0,
            central: [false; 2],
        }
    }
}

/// Members input 0, intermediate 1, output 2, G3 3, G5 4.
fn two_speed() -> Layout {
    let mut members = vec![MemberLayout::default(); 5];
    members[3].loose = true;
    members[4].loose = true;
    let needle = |outer: usize, at: f64| SupportLayout {
        outer: Some(outer),
        ..support(1, at, Axial::None)
    };
    Layout {
        members,
        supports: vec![
            support(0, 0.0, Axial::None),
            support(0, 66.0, Axial::Both),
            support(1, 0.0, Axial::Both),
            support(1, 160.0, Axial::None),
            support(2, 0.0, Axial::Both),
            support(2, 160.0, Axial::None),
            needle(3, 50.0),
            needle(4, 128.0),
        ],
        meshes: cylindrical(vec![
            Teeth {
                z: [16.0, 83.0],
                m: 1.25,
                alpha: 20.0,
                beta: 26.0,
                a: 69.0,
                sign: 1.0,
            }
            .mesh([0, 1], 22.0, [-0.6, -0.8], 1.0),
            Teeth {
                z: [24.0, 101.0],
                m: 1.6,
                alpha: 17.5,
                beta: 29.0,
                a: 115.0,
                sign: 1.0,
            }
            .mesh([3, 2], 50.0, [-0.8, -0.6], -1.0),
            Teeth {
                z: [31.0, 96.0],
                m: 1.6,
                alpha: 17.5,
                beta: 27.0,
                a: 115.0,
                sign: 1.0,
            }
            .mesh([4, 2], 128.0, [-0.8, -0.6], -1.0),
        ]),
    }
}

/// The loads of all supports.
fn all<R: Points>(solved: &ShaftLoads, tangential: &[R], speeds: &[R]) -> Vec<SupportLoad<R>> {
    let mut loads = vec![SupportLoad::default(); solved.cases.len()];
    for group in solved.groups() {
        let mut passed = vec![R::ZERO; solved.scratch_len()];
        solved.evaluate(group, teeth(tangential), speeds, &[], &mut passed, &mut loads);
    }
    loads
}

fn loads_of(layout: &Layout, tangential: &[f64]) -> (Vec<SupportLoad>, Vec<[f64; 2]>) {
    let solved = ShaftLoads::new(layout).unwrap();
    assert_several_equal_single(&solved, layout.meshes.len(), &vec![100.0; layout.members.len()]);
    let mut loads = Vec::new();
    // Rotated first, so that the forces of the caller stay unchanged.
    for sense in [-1.0, 1.0] {
        let tangential: Vec<f64> = tangential.iter().map(|force| sense * force).collect();
        loads = all(&solved, &tangential, &vec![0.0; layout.members.len()]);
        // If a single mesh loads a support, its radial load is not computed from a vector; it must equal that of all meshes.
        for (load, [y, z]) in loads.iter().zip(solved.vectors(teeth(&tangential))) {
            let length = y.hypot(z);
            assert!(
                (load.radial - length).abs() <= 1e-12 * length,
                "{} {length}",
                load.radial
            );
        }
    }
    (loads, solved.vectors(teeth(tangential)))
}

/// Tangential forces of the two-speed example from its multipliers.
fn two_speed_forces(multipliers: [f64; 3]) -> Vec<f64> {
    let layout = two_speed();
    let z1 = [16.0, 24.0, 31.0];
    (0..3)
        .map(|i| multipliers[i] * z1[i] / gears(&layout.meshes[i]).radius[0])
        .collect()
}

#[test]
fn t0_working_geometry_of_the_two_speed_example() {
    let layout = two_speed();
    for (mesh, [r1, r2, alpha, beta]) in layout.meshes.iter().map(gears).zip([
        [11.1515152, 57.8484848, 22.3669428, 26.0517084],
        [22.08, 92.92, 20.7231108, 29.1410245],
        [28.0708661, 86.9291339, 20.8121097, 27.1971448],
    ]) {
        close(mesh.radius[0] * 1e3, r1, r1);
        close(mesh.radius[1] * 1e3, r2, r2);
        close(mesh.tan_alpha.atan().to_degrees(), alpha, alpha);
        close(mesh.hand_tan_beta.abs().atan().to_degrees(), beta, beta);
    }
}

#[test]
fn t2_gear_forces() {
    let layout = two_speed();
    for (mesh, lambda, force) in [
        (0, -0.625, [438.371147, -495.988864, 833.246731]),
        (1, 2.16145833, [1309.86974, 2120.72807, -1346.21799]),
        (0, 0.625, [-438.371147, 938.793744, -242.840225]),
        (2, -1.6733871, [-949.627305, -546.851355, 1899.86324]),
    ] {
        let mut multipliers = [0.0; 3];
        multipliers[mesh] = lambda;
        let tangential = two_speed_forces(multipliers)[mesh];
        let [along, radial] = layout.meshes[mesh].forces(0);
        for i in 0..3 {
            let value = along[i] * tangential + radial[i] * tangential.abs();
            assert!((value - force[i]).abs() < 5e-7 * 2500.0, "{value} {}", force[i]);
        }
    }
}

#[test]
fn t2_bearing_loads_of_the_two_speed_example() {
    let cases: [([f64; 3], [[f64; 4]; 6]); 4] = [
        (
            [-0.625, 2.161458333, 0.0],
            [
                [375.100175, -496.243245, 622.05908, 0.0],
                [120.88869, -337.003486, 358.029922, 438.371147],
                [-1646.08467, 1879.45292, 2498.38709, 871.498595],
                [-970.632259, 300.011799, 1015.93999, 0.0],
                [2066.56603, -469.100756, 2119.13913, 1309.86974],
                [54.1620388, -877.117233, 878.787897, 0.0],
            ],
        ),
        (
            [0.625, -2.161458333, 0.0],
            [
                [-670.303428, 102.638908, 678.116089, 0.0],
                [-268.490316, 140.201317, 302.891828, 438.371147],
                [1050.26705, -2103.52993, 2351.14845, 871.498595],
                [587.0921, -552.150277, 805.944826, 0.0],
                [-1088.8292, 1202.40338, 1622.13529, 1309.86974],
                [390.263791, 1210.43661, 1271.79503, 0.0],
            ],
        ),
        (
            [-0.625, 0.0, 1.673387097],
            [
                [375.100175, -496.243245, 622.05908, 0.0],
                [120.88869, -337.003486, 358.029922, 438.371147],
                [-533.559506, 1156.82187, 1273.93979, 511.256159],
                [-1633.17969, 733.363869, 1790.27888, 0.0],
                [746.901461, 98.1757454, 753.326138, 949.627305],
                [923.848867, -1155.11475, 1479.11691, 0.0],
            ],
        ),
        (
            [0.625, 0.0, -1.673387097],
            [
                [-670.303428, 102.638908, 678.116089, 0.0],
                [-268.490316, 140.201317, 302.891828, 438.371147],
                [690.698921, -816.181103, 1069.21307, 511.256159],
                [794.946179, -1326.52236, 1546.4802, 0.0],
                [-522.121667, 70.4091006, 526.847678, 949.627305],
                [-24.7296883, 1829.45414, 1829.62127, 0.0],
            ],
        ),
    ];
    for (multipliers, table) in cases {
        let (loads, vectors) = loads_of(&two_speed(), &two_speed_forces(multipliers));
        for (i, [ry, rz, radial, axial]) in table.into_iter().enumerate() {
            close(vectors[i][0], ry, 2500.0);
            close(vectors[i][1], rz, 2500.0);
            close(loads[i].radial, radial, 2500.0);
            close(loads[i].axial, axial, 2500.0);
        }
        // Twice the torque gives twice the loads; the cage of the idler pinion carries its gear's resultant and tilts.
        let twice: Vec<f64> = two_speed_forces(multipliers).iter().map(|f| 2.0 * f).collect();
        let (double, _) = loads_of(&two_speed(), &twice);
        for (one, two) in loads.iter().zip(&double) {
            assert!((two.radial - 2.0 * one.radial).abs() < 1e-9 * (1.0 + two.radial));
        }
    }
    let (loads, _) = loads_of(&two_speed(), &two_speed_forces([-0.625, 2.161458333, 0.0]));
    close(loads[6].radial, 2511.92962, 2511.0);
    close(loads[6].tilting, 28.9219238, 28.9);
    assert_eq!((loads[7].radial, loads[6].axial), (0.0, 0.0));
}

#[test]
fn t2_the_bearing_table_in_newtons() {
    for (torque, multipliers, table) in [
        (
            10.0,
            [-0.625, 2.161458333, 0.0],
            [[622, 0], [358, 438], [2498, 871], [1016, 0], [2119, 1310], [879, 0]],
        ),
        (
            20.0,
            [-1.25, 4.322916667, 0.0],
            [[1244, 0], [716, 877], [4997, 1743], [2032, 0], [4238, 2620], [1758, 0]],
        ),
        (
            10.0,
            [-0.625, 0.0, 1.673387097],
            [[622, 0], [358, 438], [1274, 511], [1790, 0], [753, 950], [1479, 0]],
        ),
    ] {
        let (loads, _) = loads_of(&two_speed(), &two_speed_forces(multipliers));
        for (load, [radial, axial]) in loads.iter().zip(table) {
            assert!(
                (load.radial - f64::from(radial)).abs() <= 0.51,
                "{torque} {}",
                load.radial
            );
            assert!((load.axial - f64::from(axial)).abs() <= 0.51, "{torque} {}", load.axial);
        }
    }
}

#[test]
fn e1_e2_forces_of_an_electric_drive_unit() {
    // Working centre distances follow from the profile shifts.
    for (teeth, torque, tangential, axial, radial) in [
        (
            Teeth {
                z: [31.0, 81.0],
                m: 1.7,
                alpha: 20.0,
                beta: 20.0,
                a: 101.712455,
                sign: 1.0,
            },
            100.0,
            3552.07552,
            1297.98916,
            1417.20786,
        ),
        (
            Teeth {
                z: [24.0, 83.0],
                m: 2.6,
                alpha: 20.0,
                beta: 22.5,
                a: 151.075153,
                sign: 1.0,
            },
            100.0 * 81.0 / 31.0,
            7710.86000,
            3204.85505,
            3114.17983,
        ),
    ] {
        let mesh = teeth.mesh([0, 1], 0.0, [1.0, 0.0], 1.0);
        let force: f64 = torque / mesh.radius[0];
        close(force, tangential, tangential);
        // The centre distances are printed to nine digits, which leaves seven in the small difference of the angles.
        assert!((force * mesh.hand_tan_beta / axial - 1.0).abs() < 1e-6);
        assert!((force * mesh.tan_alpha / radial - 1.0).abs() < 1e-6);
    }
}

/// Members A to F of the chain of six shafts.
fn six_shafts() -> Layout {
    let unit = |degrees: f64| [degrees.to_radians().cos(), degrees.to_radians().sin()];
    let teeth = |z: [f64; 2], m: f64, beta: f64, a: f64, sign: f64| Teeth {
        z,
        m,
        alpha: 20.0,
        beta,
        a,
        sign,
    };
    let mut members = vec![MemberLayout::default(); 6];
    members[4].forces.push((0.070, [0.0, 0.0, -9.0 * 9.80665]));
    members[5].forces.push((0.130, [0.0, 0.0, -12.0 * 9.80665]));
    // For an internal pair the contact lies from the ring's axis towards the pinion.
    let inner = unit(-100.0).map(|x| -x);
    Layout {
        members,
        supports: vec![
            support(0, 0.0, Axial::Both),
            support(0, 80.0, Axial::None),
            support(1, 0.0, Axial::Left),
            support(1, 150.0, Axial::Right),
            support(2, 80.0, Axial::Both),
            support(2, 140.0, Axial::None),
            support(3, 0.0, Axial::None),
            support(3, 150.0, Axial::Both),
            support(4, 0.0, Axial::Both),
            support(4, 100.0, Axial::None),
            support(5, 150.0, Axial::Both),
            support(5, 220.0, Axial::None),
        ],
        meshes: cylindrical(vec![
            teeth([23.0, 57.0], 2.5, 18.0, 106.0, 1.0).mesh([0, 1], 40.0, unit(30.0), 1.0),
            teeth([19.0, 41.0], 3.0, 12.0, 92.5, 1.0).mesh([1, 2], 110.0, unit(-20.0), 1.0),
            teeth([41.0, 47.0], 3.0, 12.0, 135.5, 1.0).mesh([2, 3], 110.0, unit(65.0), -1.0),
            teeth([21.0, 64.0], 4.0, 0.0, 170.0, 1.0).mesh([3, 4], 60.0, unit(150.0), 0.0),
            teeth([26.0, 89.0], 3.5, 0.0, 110.25, -1.0).mesh([4, 5], 130.0, inner, 0.0),
        ]),
    }
}

#[test]
fn s2_s3_six_shafts() {
    let layout = six_shafts();
    let z1 = [23.0, 19.0, 41.0, 21.0, 26.0];
    let forces = |scale: f64| -> Vec<f64> {
        [-3.47826087, 10.4347826, -10.4347826, 23.3540373, -57.486861]
            .iter()
            .zip(z1)
            .zip(layout.meshes.iter().map(gears))
            .map(|((lambda, z), mesh)| scale * lambda * z / mesh.radius[0])
            .collect()
    };
    let tangential = forces(1.0);
    let [along, radial] = layout.meshes[4].forces(0);
    for (i, printed) in [0.0, 30274.3872, -17478.9256].into_iter().enumerate() {
        // Multipliers are printed to nine digits.
        assert!((along[i] * tangential[4] + radial[i] * tangential[4].abs() - printed).abs() < 1e-3);
    }
    let tables = [
        (
            1.0,
            [
                [1328.59537, 859.873376],
                [1569.73113, 0.0],
                [4312.48646, 2306.21557],
                [5767.65173, 0.0],
                [7119.151, 0.0],
                [7128.33311, 0.0],
                [7205.94964, 0.0],
                [4286.6162, 1446.3422],
                [13031.2209, 0.0],
                [43485.4629, 0.0],
                [44870.3487, 0.0],
                [9971.18861, 0.0],
            ],
        ),
        (
            -1.0,
            [
                [1569.73113, 859.873376],
                [1328.59537, 0.0],
                [3056.24289, 0.0],
                [5012.50779, 2306.21557],
                [3932.43746, 0.0],
                [3928.64806, 0.0],
                [9539.51873, 0.0],
                [9092.81176, 1446.3422],
                [6669.03848, 0.0],
                [52050.9688, 0.0],
                [44919.7824, 0.0],
                [9982.17387, 0.0],
            ],
        ),
    ];
    for (scale, table) in tables {
        let (loads, _) = loads_of(&layout, &forces(scale));
        for (load, [radial, axial]) in loads.iter().zip(table) {
            close(load.radial, radial, 52050.0);
            close(load.axial, axial, 52050.0);
        }
    }
    let (rest, _) = loads_of(&layout, &[0.0; 5]);
    for (i, printed) in [(8, 26.477955), (9, 61.781895), (10, 151.3026), (11, 33.6228)] {
        close(rest[i].radial, printed, 151.0);
    }
}

#[test]
fn g_planet_bearing() {
    // Sun 0, carrier 1, planet 2, ring 3 in the frame of the carrier.
    let a = 49.2;
    let teeth = |z: [f64; 2], sign: f64| Teeth {
        z,
        m: 2.0,
        alpha: 20.0,
        beta: 15.0,
        a,
        sign,
    };
    let planet_mesh = |mesh: CylindricalMesh, central: [bool; 2]| CylindricalMesh {
        count: 3.0,
        central,
        ..mesh
    };
    let sun = planet_mesh(
        teeth([24.0, 23.0], 1.0).mesh([0, 2], 0.0, [1.0, 0.0], 1.0),
        [true, false],
    );
    let ring = planet_mesh(
        teeth([23.0, 72.0], -1.0).mesh([2, 3], 0.0, [1.0, 0.0], -1.0),
        [false, true],
    );
    for (value, printed) in [
        (sun.radius[0] * 1e3, 25.1234043),
        (sun.radius[1] * 1e3, 24.0765957),
        (sun.tan_alpha.atan().to_degrees(), 22.2618503),
        (sun.hand_tan_beta.atan().to_degrees(), 15.1594404),
        (ring.radius[0] * 1e3, 23.0938776),
        (ring.radius[1] * 1e3, 72.2938776),
        (ring.tan_alpha.atan().to_degrees(), 15.2377500),
        (-ring.hand_tan_beta.atan().to_degrees(), 14.5675316),
    ] {
        close(value, printed, printed);
    }
    let mut members = vec![MemberLayout::default(); 4];
    members[2].planet = Some(PlanetBody {
        carrier: 1,
        orbit: a * 1e-3,
        count: 3.0,
        mass: 0.30,
        uneven: false,
    });
    let pin = SupportLayout {
        outer: Some(1),
        ..support(2, 0.0, Axial::None)
    };
    let layout = Layout {
        members,
        supports: vec![pin],
        meshes: cylindrical(vec![sun, ring]),
    };
    let solved = ShaftLoads::new(&layout).unwrap();
    assert_several_equal_single(&solved, layout.meshes.len(), &vec![100.0; layout.members.len()]);
    // The most loaded planet carries 1.1 times its share of 60 N m; the carrier turns at 750 rpm.
    let share = 1.1 * 60.0 / 3.0;
    let speeds = [0.0, 750.0 * std::f64::consts::PI / 30.0, 0.0, 0.0];
    // The torque on the planet from the sun and from the ring balance each other.
    let on_sun = share / sun.radius[0];
    let planet_torque = on_sun * sun.radius[1];
    let tangential = [on_sun, -planet_torque / ring.radius[0]];
    let loads = all(&solved, &tangential, &speeds);
    close(loads[0].radial, 1799.85641, 1799.0);
    assert!(loads[0].axial.abs() < 1e-9);
    close(loads[0].tilting, 11.1912321, 11.2);
    // With three planets the transverse force on the sun cancels, and the thrust is three times that of one.
    let mut even = [0.0; 2];
    even[0] = 60.0 / 3.0 / sun.radius[0];
    close((3.0 * even[0] * sun.forces(0)[0][0]).abs(), 647.047613, 647.0);
}

fn three_bearings(
    stiffness: Option<f64>,
    tilting: Option<f64>,
    hinges: &[f64],
    shear: bool,
    middle: bool,
) -> ([Vec<BeamLoad>; 2], [f64; 4]) {
    let sections = [
        Section {
            range: [0.0, 0.120],
            outer: 0.030,
            inner: 0.0,
        },
        Section {
            range: [0.120, 0.300],
            outer: 0.040,
            inner: 0.0,
        },
    ];
    let places: &[f64] = if middle { &[0.0, 0.120, 0.300] } else { &[0.0, 0.300] };
    let supports: Vec<BeamSupport> = places
        .iter()
        .map(|at| BeamSupport {
            at: *at,
            radial: stiffness,
            tilting,
        })
        .collect();
    let beam = Beam::new(&sections, &supports, hinges, &[0.060, 0.200], shear).unwrap();
    // The force along x at an arm of 50 mm in y bends about z only.
    let y = [
        BeamLoad {
            at: 0.060,
            force: 1000.0,
            moment: 0.0,
        },
        BeamLoad {
            at: 0.200,
            force: -800.0,
            moment: -0.050 * 500.0,
        },
    ];
    let z = [
        BeamLoad {
            at: 0.060,
            force: -2000.0,
            moment: 0.0,
        },
        BeamLoad {
            at: 0.200,
            force: 3000.0,
            moment: 0.0,
        },
    ];
    let deflections = [
        beam.deflection(&y, 0.060),
        beam.deflection(&y, 0.200),
        beam.deflection(&z, 0.060),
        beam.deflection(&z, 0.200),
    ];
    ([beam.reactions(&y), beam.reactions(&z)], deflections)
}

#[test]
fn q1_to_q6_three_bearings() {
    let tol = 1e-6 * 1500.0;
    for (case, stiffness, tilting, hinges, shear, middle, y, z) in [
        (
            "Q1",
            None,
            None,
            vec![],
            false,
            true,
            vec![-444.536424, -286.883738, 531.420162],
            vec![1023.84106, -706.401766, -1317.43929],
        ),
        (
            "Q2",
            Some(2e8),
            None,
            vec![],
            false,
            true,
            vec![-460.075277, -260.98565, 521.060927],
            vec![970.845455, -618.075758, -1352.7697],
        ),
        (
            "Q3",
            None,
            None,
            vec![],
            true,
            true,
            vec![-448.033483, -281.055306, 529.088789],
            vec![1023.09852, -705.164201, -1317.93432],
        ),
        (
            "Q4",
            None,
            None,
            vec![0.100],
            false,
            true,
            vec![-400.0, -361.111111, 561.111111],
            vec![800.0, -333.333333, -1466.66667],
        ),
        (
            "Q5",
            None,
            None,
            vec![],
            false,
            false,
            vec![-616.666667, 416.666667],
            vec![600.0, -1600.0],
        ),
        (
            "Q6",
            Some(2e8),
            Some(5e4),
            vec![],
            false,
            true,
            vec![-480.877907, -235.190708, 516.068615],
            vec![985.867849, -630.222294, -1355.64555],
        ),
    ] {
        let ([own_y, own_z], deflections) = three_bearings(stiffness, tilting, &hinges, shear, middle);
        for (own, printed) in own_y.iter().zip(&y).chain(own_z.iter().zip(&z)) {
            assert!(
                (own.force - printed).abs() < tol,
                "{case}: {} against {printed}",
                own.force
            );
        }
        if case == "Q1" {
            for (own, printed) in deflections
                .iter()
                .zip([3.66389399, -4.48208481, -9.10479475, 13.5058336])
            {
                assert!((own * 1e6 - printed).abs() < 1e-6 * 13.5, "{own}");
            }
        }
    }
}

#[test]
fn q_two_supports_and_a_hinge_are_a_mechanism() {
    let section = [Section {
        range: [0.0, 0.3],
        outer: 0.03,
        inner: 0.0,
    }];
    let ends = [
        BeamSupport {
            at: 0.0,
            radial: None,
            tilting: None,
        },
        BeamSupport {
            at: 0.3,
            radial: None,
            tilting: None,
        },
    ];
    assert_eq!(
        Beam::new(&section, &ends, &[0.1], &[0.2], false).unwrap_err(),
        BeamFault::Mechanism
    );
    assert!(matches!(
        Beam::new(&[], &ends, &[], &[0.2], false).unwrap_err(),
        BeamFault::NoSection(_)
    ));
    assert_eq!(
        Beam::new(&section, &ends, &[0.1], &[0.1], false).unwrap_err(),
        BeamFault::MomentAtHinge(0.1)
    );
    // Two equal spans, the load in the middle of the first.
    let three = [0.0, 0.1, 0.2].map(|at| BeamSupport {
        at,
        radial: None,
        tilting: None,
    });
    let beam = Beam::new(&section, &three, &[], &[0.05], false).unwrap();
    let reactions = beam.reactions(&[BeamLoad {
        at: 0.05,
        force: -32.0,
        moment: 0.0,
    }]);
    for (own, exact) in reactions.iter().zip([13.0, 22.0, -3.0]) {
        assert!((own.force - exact).abs() < 1e-6 * 22.0);
    }
}

/// One shaft with two bearings and an axial force.
fn axial_case(a: SupportLayout, b: SupportLayout, thrust: f64) -> Result<(f64, f64, f64), Vec<LoadFault>> {
    let mut member = MemberLayout::default();
    member.forces.push((0.05, [thrust, 0.0, 0.0]));
    let layout = Layout {
        members: vec![member],
        supports: vec![a, b],
        meshes: Vec::new(),
    };
    let solved = ShaftLoads::new(&layout)?;
    assert_several_equal_single(&solved, layout.meshes.len(), &vec![100.0; layout.members.len()]);
    let (loads, _) = loads_of(&layout, &[]);
    Ok((loads[0].axial, loads[1].axial, loads[0].untaken))
}

#[test]
fn a1_thrust_finds_its_bearing() {
    let s = |at: f64, axial| support(0, at, axial);
    let spring = SupportLayout {
        spring: 120.0,
        ..s(100.0, Axial::None)
    };
    for (a, b, thrust, at_a, at_b) in [
        (s(0.0, Axial::Both), s(100.0, Axial::None), 500.0, 500.0, 0.0),
        (s(0.0, Axial::Left), s(100.0, Axial::Right), 500.0, 0.0, 500.0),
        (s(0.0, Axial::Left), s(100.0, Axial::Right), -500.0, 500.0, 0.0),
        (s(0.0, Axial::Both), spring, 500.0, 620.0, 120.0),
        (s(0.0, Axial::Both), spring, -500.0, 380.0, 120.0),
        (s(0.0, Axial::Both), spring, 0.0, 120.0, 120.0),
    ] {
        assert_eq!(axial_case(a, b, thrust).unwrap(), (at_a, at_b, 0.0));
    }
    let fault = axial_case(s(0.0, Axial::Both), s(100.0, Axial::Both), 500.0).unwrap_err();
    assert!(matches!(fault[0], LoadFault::AxialIndeterminate { .. }));
    assert_eq!(
        axial_case(s(0.0, Axial::Left), s(100.0, Axial::None), 500.0).unwrap().2,
        500.0
    );
    let shared = |share: f64, at: f64| SupportLayout {
        share: Some(share),
        ..s(at, Axial::Both)
    };
    assert_eq!(
        axial_case(shared(0.6, 0.0), shared(0.4, 100.0), 500.0).unwrap(),
        (300.0, 200.0, 0.0)
    );
}

#[test]
fn a2_tapered_pair() {
    // The radial loads follow from forces that statics turns into 3000 N at R and 2000 N at L.
    let right = SupportLayout {
        induced: Some(1.0 / (2.0 * 1.6)),
        ..support(0, 0.0, Axial::Right)
    };
    let left = SupportLayout {
        induced: Some(1.0 / (2.0 * 1.5)),
        ..support(0, 100.0, Axial::Left)
    };
    for (thrust, at_right, at_left) in [
        (1000.0, 1666.66667, 666.666667),
        (0.0, 937.5, 937.5),
        (-200.0, 937.5, 1137.5),
        (-1000.0, 937.5, 1937.5),
    ] {
        let forces = vec![(0.0, [thrust, 3000.0, 0.0]), (0.1, [0.0, 2000.0, 0.0])];
        let member = MemberLayout {
            forces,
            ..MemberLayout::default()
        };
        let (loads, _) = loads_of(
            &Layout {
                members: vec![member],
                supports: vec![right, left],
                meshes: Vec::new(),
            },
            &[],
        );
        close(loads[0].axial, at_right, 2000.0);
        close(loads[1].axial, at_left, 2000.0);
    }
}

/// A shaft on A, which takes thrust towards -x, and B, which takes thrust towards +x, under a thrust towards +x and radial loads of both.
fn pair_case(a: SupportLayout, b: SupportLayout, radial: [f64; 2], thrust: f64) -> Result<[f64; 2], Vec<LoadFault>> {
    let mut member = MemberLayout::default();
    member.forces.push((0.0, [thrust, radial[0], 0.0]));
    member.forces.push((0.1, [0.0, radial[1], 0.0]));
    let layout = Layout {
        members: vec![member],
        supports: vec![a, b],
        meshes: Vec::new(),
    };
    ShaftLoads::new(&layout)?;
    let (loads, _) = loads_of(&layout, &[]);
    close(loads[0].radial, radial[0], 3000.0);
    close(loads[1].radial, radial[1], 3000.0);
    assert_eq!((loads[0].untaken, loads[1].untaken), (0.0, 0.0));
    Ok([loads[0].axial, loads[1].axial])
}

/// A and B with a thrust per radial load.
fn opposed(induced: [f64; 2]) -> [SupportLayout; 2] {
    [(0.0, Axial::Left, induced[0]), (100.0, Axial::Right, induced[1])].map(|(at, axial, induced)| SupportLayout {
        induced: Some(induced),
        ..support(0, at, axial)
    })
}

#[test]
fn a3_the_six_cases_of_the_catalogues() {
    let [a, b] = opposed([0.3, 0.3]);
    for (radial, thrust, at_a, at_b) in [
        ([3000.0, 2000.0], 500.0, 900.0, 1400.0),
        ([2000.0, 3000.0], 500.0, 600.0, 1100.0),
        ([2000.0, 3000.0], 200.0, 700.0, 900.0),
        ([2000.0, 3000.0], -500.0, 1400.0, 900.0),
        ([3000.0, 2000.0], -500.0, 1100.0, 600.0),
        ([3000.0, 2000.0], -200.0, 900.0, 700.0),
    ] {
        let [found_a, found_b] = pair_case(a, b, radial, thrust).unwrap();
        close(found_a, at_a, at_a);
        close(found_b, at_b, at_b);
    }
}

#[test]
fn a4_a_ring_on_a_spring_has_the_force_of_the_spring() {
    let [a, b] = opposed([0.3, 0.3]);
    let sprung_a = SupportLayout { spring: 800.0, ..a };
    let sprung_b = SupportLayout { spring: -800.0, ..b };
    for (thrust, at_a, at_b) in [
        (0.0, 800.0, 800.0),
        (500.0, 800.0, 1300.0),
        (-500.0, 800.0, 300.0),
        // Beyond the spring, the ring takes the thrust and the other bearing is free.
        (-1000.0, 1000.0, 0.0),
    ] {
        for radial in [[0.0, 0.0], [2000.0, 1000.0]] {
            assert_eq!(pair_case(sprung_a, b, radial, thrust).unwrap(), [at_a, at_b]);
            // The mirror image.
            assert_eq!(pair_case(a, sprung_b, radial, -thrust).unwrap(), [at_b, at_a]);
        }
    }
    // A spring on a third bearing is a thrust on the shaft, and its own axial load.
    let third = SupportLayout {
        spring: 200.0,
        ..support(0, 50.0, Axial::None)
    };
    let mut member = MemberLayout::default();
    member.forces.push((0.0, [500.0, 3000.0, 0.0]));
    member.forces.push((0.1, [0.0, 2000.0, 0.0]));
    member.sections.push(Section {
        range: [0.0, 0.1],
        outer: 0.03,
        inner: 0.0,
    });
    let layout = Layout {
        members: vec![member],
        supports: vec![a, b, third],
        meshes: Vec::new(),
    };
    let (loads, _) = loads_of(&layout, &[]);
    close(loads[0].axial, 900.0, 900.0);
    close(loads[1].axial, 1600.0, 1600.0);
    assert_eq!(loads[2].axial, 200.0);
}

#[test]
fn a4_springs_that_do_not_fit_a_pair_are_refused() {
    let [a, b] = opposed([0.3, 0.3]);
    let spring = |seat: SupportLayout, spring: f64| SupportLayout { spring, ..seat };
    let fault = |a, b| pair_case(a, b, [0.0, 0.0], 0.0).unwrap_err();
    assert!(matches!(
        &fault(spring(a, 800.0), spring(b, -800.0))[..],
        [LoadFault::SeveralSprings { member: 0, supports }] if supports[..] == [0, 1]
    ));
    assert_eq!(fault(spring(a, -800.0), b), [LoadFault::SpringLifts { support: 0 }]);
    assert_eq!(fault(a, spring(b, 800.0)), [LoadFault::SpringLifts { support: 1 }]);
}

#[test]
fn a5_several_bearings_share_the_load_of_their_side() {
    let [a, b] = opposed([0.3, 0.5]);
    let shared = |at: f64, share: f64| SupportLayout {
        at: 1e-3 * at,
        share: Some(share),
        ..a
    };
    let layout = |b| {
        let mut member = MemberLayout::default();
        member.forces.push((0.0, [500.0, 3000.0, 0.0]));
        member.forces.push((0.05, [0.0, 1000.0, 0.0]));
        member.forces.push((0.1, [0.0, 2000.0, 0.0]));
        member.sections.push(Section {
            range: [0.0, 0.1],
            outer: 0.03,
            inner: 0.0,
        });
        Layout {
            members: vec![member],
            supports: vec![shared(0.0, 0.5), shared(50.0, 0.5), b],
            meshes: Vec::new(),
        }
    };
    // 0.3 (3000 + 1000) = 1200 against 0.5 2000 = 1000.
    let (loads, _) = loads_of(&layout(b), &[]);
    for (load, axial) in loads.iter().zip([600.0, 600.0, 1700.0]) {
        close(load.axial, axial, axial);
    }
    // Without a known thrust of one of them there is no pair.
    let solved = ShaftLoads::new(&layout(SupportLayout { induced: None, ..b })).unwrap();
    assert_eq!(solved.pairs().count(), 0);
    let spring = |b: SupportLayout| {
        let mut layout = layout(b);
        layout.supports[1].spring = 100.0;
        ShaftLoads::new(&layout).unwrap_err()
    };
    assert!(matches!(&spring(b)[..], [LoadFault::SpringOfSeveral { support: 1, supports }] if supports[..] == [0, 1]));
}

#[test]
fn loads_of_a_pair_are_found_together() {
    // Two spur meshes, each in the plane of one bearing.
    let [a, b] = opposed([0.3, 0.3]);
    let mesh = |at: f64, mate: usize| CylindricalMesh {
        members: [0, mate],
        at,
        radius: [0.03, 0.09],
        sign: 1.0,
        direction: [1.0, 0.0],
        across: 1.0,
        tan_alpha: 0.4,
        hand_tan_beta: 0.0,
        count: 1.0,
        central: [false; 2],
    };
    let mate = |inner: usize| SupportLayout {
        takes_moment: true,
        ..support(inner, 50.0, Axial::Both)
    };
    let layout = Layout {
        members: vec![MemberLayout::default(); 3],
        supports: vec![a, b, mate(1), mate(2)],
        meshes: cylindrical(vec![mesh(0.0, 1), mesh(0.1, 2)]),
    };
    let solved = ShaftLoads::new(&layout).unwrap();
    let group = &solved.groups()[solved.group_of(0)];
    let mut meshes = group.meshes.clone();
    meshes.sort_unstable();
    assert_eq!((&group.supports[..], &meshes[..]), (&[0, 1][..], &[0, 1][..]));
    // Only the second mesh has a force, and A has its axial load from B.
    let (loads, _) = loads_of(&layout, &[0.0, 1000.0]);
    assert!(loads[0].radial < 1e-9 && loads[1].radial > 1000.0);
    assert_eq!([loads[0].axial, loads[1].axial], [0.3 * loads[1].radial; 2]);
    let mut passed = vec![0.0; solved.scratch_len()];
    let pair = solved
        .pair_loads(1, teeth(&[0.0, 1000.0]), &[0.0; 3], &[], &mut passed)
        .unwrap();
    assert_eq!(pair.axial, [loads[0].axial, loads[1].axial]);
    assert_eq!((pair.thrust, pair.mutual()), (0.0, loads[0].axial));
    assert_eq!(
        solved.pair_loads(2, teeth(&[0.0, 1000.0]), &[0.0; 3], &[], &mut passed),
        None
    );
}

#[test]
fn the_reserve_of_a_spring_is_what_it_has_over_the_induced_thrust() {
    let side = |support: usize| {
        vec![PairedSupport {
            support,
            induced: 0.3,
            share: 1.0,
        }]
    };
    let pair = |of: usize| Pair {
        member: 0,
        sides: [side(0), side(1)],
        spring: Some(PairSpring {
            side: of,
            support: of,
            force: 800.0,
        }),
        stiff: None,
    };
    let reserve = |of: usize, thrust: f64| {
        let pair = pair(of);
        pair.loads(thrust, 0.0, |support| [2000.0, 1000.0][support])
            .reserve(pair.spring.unwrap())
    };
    // 600 N and 300 N are induced. A thrust towards +x loads the second bearing.
    assert_eq!(reserve(0, 100.0), [200.0, 600.0]);
    assert_eq!(reserve(0, -700.0), [200.0, -200.0]);
    assert_eq!(reserve(1, 100.0), [100.0, 500.0]);
    assert_eq!(reserve(1, 700.0), [-500.0, 500.0]);
}

/// The table of the catalogues, with the conditions that it prints: axial loads of A and B for a thrust that B takes if it is positive.
fn catalogue_table(s_a: f64, s_b: f64, thrust: f64) -> [f64; 2] {
    let magnitude = thrust.abs();
    match (thrust >= 0.0, s_a >= s_b) {
        (true, true) => [s_a, s_a + magnitude],
        (true, false) if magnitude >= s_b - s_a => [s_a, s_a + magnitude],
        (true, false) => [s_b - magnitude, s_b],
        (false, false) => [s_b + magnitude, s_b],
        (false, true) if magnitude >= s_a - s_b => [s_b + magnitude, s_b],
        (false, true) => [s_a, s_a - magnitude],
    }
}

proptest! {
    #[test]
    fn supports_balance_all_forces_and_moments(
        places in proptest::collection::vec(-0.2..0.4_f64, 3),
        forces in proptest::collection::vec((-3000.0..3000.0_f64, -3000.0..3000.0_f64), 3),
        a in -0.1..0.05_f64, length in 0.05..0.4_f64,
    ) {
        let b = a + length;
        let all = places.iter().zip(&forces).map(|(x, (y, z))| (*x, [0.0, *y, *z])).collect();
        let member = MemberLayout { forces: all, ..MemberLayout::default() };
        let layout = Layout {
            members: vec![member],
            supports: vec![support(0, a * 1e3, Axial::None), support(0, b * 1e3, Axial::None)],
            meshes: Vec::new(),
        };
        let (_, vectors) = loads_of(&layout, &[]);
        for axis in 0..2 {
            let force = |f: &(f64, f64)| if axis == 0 { f.0 } else { f.1 };
            let sum: f64 = forces.iter().map(force).sum::<f64>() + vectors[0][axis] + vectors[1][axis];
            let moment: f64 = places.iter().zip(&forces).map(|(x, f)| x * force(f)).sum::<f64>()
                + a * vectors[0][axis] + b * vectors[1][axis];
            prop_assert!(sum.abs() < 1e-8 && moment.abs() < 1e-8, "{sum} {moment}");
        }
    }

    #[test]
    fn a_pair_follows_the_table_of_the_catalogues(
        r in proptest::array::uniform2(0.1..1.2_f64), radial in proptest::array::uniform2(0.0..5000.0_f64), thrust in -5000.0..5000.0_f64,
    ) {
        let [a, b] = opposed(r);
        let found = pair_case(a, b, radial, thrust).unwrap();
        let s = [r[0] * radial[0], r[1] * radial[1]];
        let table = catalogue_table(s[0], s[1], thrust);
        for side in 0..2 {
            prop_assert!((found[side] - table[side]).abs() < 1e-8, "{found:?} {table:?}");
            // Each bearing has at least the thrust that it induces, and they balance the thrust of the shaft.
            prop_assert!(found[side] > s[side] - 1e-8);
        }
        prop_assert!((found[1] - found[0] - thrust).abs() < 1e-8);
        // The mirror image has the mirrored loads.
        let [a, b] = opposed([r[1], r[0]]);
        let mirrored = pair_case(a, b, [radial[1], radial[0]], -thrust).unwrap();
        prop_assert!((mirrored[0] - found[1]).abs() < 1e-8 && (mirrored[1] - found[0]).abs() < 1e-8);
    }

    #[test]
    fn a_mesh_acts_equally_and_oppositely_on_both_gears(
        angle in 0.0..6.2_f64, force in -5000.0..5000.0_f64, beta in 0.0..0.6_f64, sign in prop_oneof![Just(1.0), Just(-1.0)],
    ) {
        let mesh = CylindricalMesh {
            members: [0, 1], at: 0.0, radius: [0.03, 0.09], sign, direction: [angle.cos(), angle.sin()],
            across: 1.0,
            tan_alpha: 0.4, hand_tan_beta: beta.tan(), count: 1.0, central: [false; 2],
        };
        let on = |gear: usize| -> Vec<f64> {
            let [along, radial] = mesh.forces(gear);
            (0..3).map(|i| along[i] * force + radial[i] * force.abs()).collect()
        };
        let (first, second) = (on(0), on(1));
        for i in 0..3 {
            prop_assert!((first[i] + second[i]).abs() < 1e-9);
        }
        // The moment about the first axis is force times radius, and about the second the same on the opposite side.
        let about = |gear: usize, f: &[f64]| mesh.arm(gear)[0] * f[2] - mesh.arm(gear)[1] * f[1];
        prop_assert!((about(0, &first) - force * 0.03).abs() < 1e-9);
        prop_assert!((about(1, &second) - sign * force * 0.09).abs() < 1e-9);
    }
}

#[test]
fn e3_electric_drive_unit() {
    let g = 9.80665;
    let layout = |hand: f64| {
        let mut members = vec![MemberLayout::default(); 3];
        // Half of the rotor's weight is on the bearing at the pinion, half on the one behind the rotor.
        members[0].forces.push((0.0, [0.0, 0.0, -9.0 * g]));
        Layout {
            members,
            supports: vec![
                support(0, 0.0, Axial::None),
                support(0, 70.0, Axial::Both),
                support(1, 0.0, Axial::Both),
                support(1, 130.0, Axial::None),
                support(2, 0.0, Axial::Both),
                support(2, 120.0, Axial::None),
            ],
            meshes: cylindrical(vec![
                Teeth {
                    z: [31.0, 81.0],
                    m: 1.7,
                    alpha: 20.0,
                    beta: 20.0,
                    a: 101.712455,
                    sign: 1.0,
                }
                .mesh([0, 1], 35.0, [1.0, 0.0], hand),
                CylindricalMesh {
                    at: 0.0,
                    ..Teeth {
                        z: [24.0, 83.0],
                        m: 2.6,
                        alpha: 20.0,
                        beta: 22.5,
                        a: 151.075153,
                        sign: 1.0,
                    }
                    .mesh([1, 2], 0.0, [1.0, 0.0], -hand)
                },
            ]),
        }
    };
    for (torque, hand, table) in [
        (
            -100.0,
            -1.0,
            [
                [1698.05954, 0.0],
                [2160.73050, 1297.98916],
                [4994.77158, 1906.86589],
                [7446.02491, 0.0],
                [6068.86619, 3204.85505],
                [4163.85762, 0.0],
            ],
        ),
        (
            100.0,
            1.0,
            [
                [1873.61082, 0.0],
                [2160.73050, 1297.98916],
                [4994.77158, 1906.86589],
                [7446.02491, 0.0],
                [6068.86619, 3204.85505],
                [4163.85762, 0.0],
            ],
        ),
        (
            -100.0,
            1.0,
            [
                [2088.78923, 0.0],
                [1785.81131, 1297.98916],
                [4869.22290, 1906.86589],
                [6599.16285, 0.0],
                [4163.85762, 3204.85505],
                [6068.86619, 0.0],
            ],
        ),
    ] {
        let mut layout = layout(hand);
        // The second mesh is at 95 mm on the intermediate and at 60 mm on the output shaft: shift the output's bearings.
        if let MeshLayout::Cylindrical(mesh) = &mut layout.meshes[1] {
            mesh.at = 0.095;
        }
        layout.supports[4].at += 0.035;
        layout.supports[5].at += 0.035;
        // The torque applied to the input is balanced by the mesh: its torque on the pinion is the opposite.
        let first = -torque / gears(&layout.meshes[0]).radius[0];
        let second = torque * 81.0 / 31.0 / gears(&layout.meshes[1]).radius[0];
        let (loads, _) = loads_of(&layout, &[first, second]);
        for (load, [radial, axial]) in loads.iter().zip(table) {
            // The centre distances are printed to nine digits, which leaves seven in the small difference of the angles.
            assert!((load.radial - radial).abs() < 1e-6 * 7446.0, "{} {radial}", load.radial);
            assert!((load.axial - axial).abs() < 1e-6 * 7446.0, "{} {axial}", load.axial);
        }
    }
}

/// Asserts that the loads of several points equal those of each, to the bit.
fn assert_several_equal_single(loads: &ShaftLoads, meshes: usize, speeds: &[f64]) {
    // Forces of both signs and zero.
    let force = |k: usize, i: usize| {
        137.0
            * (i as f64 - 5.0)
            * if (i + k).is_multiple_of(3) {
                -1.0
            } else {
                1.0 + 0.1 * k as f64
            }
    };
    let tangential: Vec<Lane> = (0..meshes).map(|k| Lane::each(|i| force(k, i))).collect();
    let lanes: Vec<Lane> = speeds.iter().map(|speed| Lane::constant(*speed)).collect();
    let together = all(loads, &tangential, &lanes);
    for i in 0..LANES {
        let own: Vec<f64> = (0..meshes).map(|k| force(k, i)).collect();
        let alone = all(loads, &own, speeds);
        for (together, alone) in together.iter().zip(&alone) {
            assert_eq!(together.at_point(i), *alone);
        }
    }
}
