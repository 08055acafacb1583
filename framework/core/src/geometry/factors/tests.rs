#![allow(clippy::unwrap_used)]
use proptest::prelude::*;

use crate::geometry::{LoadSharing, Pair, PairFault, PairSpec};

/// Relative, for values printed to six digits.
fn close(value: f64, printed: f64) {
    assert!(
        (value - printed).abs() <= 1e-5 * printed.abs().max(1e-12),
        "{value} against {printed}"
    );
}

/// Absolute, for values printed to a number of decimals.
fn near(value: f64, printed: f64, half_digit: f64) {
    // The table was computed from diameters rounded to 0.1 um, which moves the ends of the path by up to 0.06 um.
    assert!(
        (value - printed).abs() <= half_digit * 1.15,
        "{value} against {printed}"
    );
}

fn spec(z: [u32; 2], m: f64, alpha: f64, beta: f64, b: f64, a: f64, tips: [f64; 2]) -> PairSpec {
    PairSpec {
        z,
        internal: false,
        normal_module: m * 1e-3,
        pressure_angle: alpha.to_radians(),
        helix_angle: beta.to_radians(),
        centre_distance: Some(a * 1e-3),
        profile_shift: [None, None],
        tip_diameter: tips.map(|d| Some(d * 1e-3)),
        root_diameter: [None, None],
        facewidth: b * 1e-3,
        tip_shortening: true,
    }
}

fn fzg_c14() -> Pair {
    Pair::new(&spec([16, 24], 4.5, 20.0, 0.0, 14.0, 91.5, [82.636, 118.544])).unwrap()
}

fn helical() -> Pair {
    Pair::new(&spec([31, 96], 1.6, 17.5, 27.0, 17.0, 115.0, [60.2, 176.251])).unwrap()
}

fn internal() -> Pair {
    let spec = PairSpec {
        internal: true,
        ..spec([24, 72], 2.0, 20.0, 0.0, 20.0, 48.0, [52.0, 140.8])
    };
    Pair::new(&spec).unwrap()
}

fn compare(pair: &Pair, alpha_wt: f64, beta_b: f64, p_et: f64, points: [f64; 5], eps: [f64; 4], rho: f64) {
    close(pair.working_angle.to_degrees(), alpha_wt);
    assert!((pair.base_helix.to_degrees() - beta_b).abs() < 1e-4);
    close(pair.base_pitch * 1e3, p_et);
    for (value, printed) in pair.points.iter().zip(points) {
        close(value * 1e3, printed);
    }
    close(pair.contact_ratio, eps[0]);
    close(pair.addendum_ratio[0], eps[1]);
    close(pair.addendum_ratio[1], eps[2]);
    assert!((pair.overlap_ratio - eps[3]).abs() < 1e-5 * eps[3].max(1.0));
    close(pair.pitch_radius * 1e3, rho);
}

#[test]
fn a1_fzg_c14() {
    compare(
        &fzg_c14(),
        22.4388,
        0.0,
        13.2846,
        [4.2939, 10.4384, 13.9701, 17.5785, 23.723],
        [1.46253, 0.734152, 0.728377, 0.0],
        8.38205,
    );
}

#[test]
fn a2_helical_31_96() {
    compare(
        &helical(),
        20.8121,
        25.6567,
        5.31826,
        [6.75146, 9.43, 9.97371, 12.0697, 14.7483],
        [1.50365, 0.897767, 0.605883, 1.53542],
        8.36382,
    );
}

#[test]
fn a3_internal_24_72() {
    compare(
        &internal(),
        20.0,
        0.0,
        5.90426,
        [3.03998, 7.03325, 8.20848, 8.94424, 12.9375],
        [1.67634, 0.800951, 0.875385, 0.0],
        12.3127,
    );
}

/// Derived from ISO 21771 with a negative number of teeth of the ring gear: inv alpha_wt = inv alpha_t + 2 tan alpha_n (x1 +
/// x2)/(z1 + z2),
/// a = m_t (z1 + z2)/2 cos alpha_t/cos alpha_wt.
#[test]
fn shifts_of_a_ring_have_the_sign_of_iso_21771() {
    let ring = |shifts: [Option<f64>; 2], distance: Option<f64>| {
        let free = PairSpec {
            internal: true,
            ..spec([24, 72], 2.0, 20.0, 0.0, 20.0, 48.0, [52.0, 139.6])
        };
        Pair::new(&PairSpec {
            centre_distance: distance,
            profile_shift: shifts,
            ..free
        })
        .unwrap()
    };
    let distance = |x1: f64, x2: f64| ring([Some(x1), Some(x2)], None).centre_distance;
    near(distance(0.1, 0.2), 47.366_892_046e-3, 1e-12);
    near(distance(0.1, -0.2), 48.196_991_638e-3, 1e-12);
    // A pinion and a ring gear with opposite shifts keep the reference centre distance.
    near(distance(0.3, -0.3), 48e-3, 1e-15);
    let closed = ring([Some(0.1), None], Some(47.366_892_046e-3)).profile_shift;
    near(closed[1], 0.2, 1e-6);
    let closed = ring([None, Some(0.2)], Some(47.366_892_046e-3)).profile_shift;
    near(closed[0], 0.1, 1e-6);
}

#[test]
fn shifts_that_no_distance_takes_are_too_close() {
    let spec = PairSpec {
        centre_distance: None,
        profile_shift: [Some(-2.0), Some(-2.0)],
        tip_diameter: [None, None],
        ..spec([20, 40], 3.0, 20.0, 0.0, 20.0, 1.0, [0.0, 0.0])
    };
    let faults = Pair::new(&spec).unwrap_err();
    assert!(matches!(faults[..], [PairFault::TooClose { .. }]), "{faults:?}");
    assert!(!faults[0].to_string().contains("NaN"), "{}", faults[0]);
}

#[test]
fn a4_from_profile_shifts() {
    let pair = Pair::new(&PairSpec {
        centre_distance: None,
        profile_shift: [Some(0.3), Some(0.1)],
        tip_diameter: [None, None],
        ..spec([20, 40], 3.0, 20.0, 15.0, 20.0, 1.0, [0.0, 0.0])
    })
    .unwrap();
    close(pair.working_angle.to_degrees(), 22.4302);
    close(pair.centre_distance * 1e3, 94.3267);
    close(pair.tip_diameter[0] * 1e3, 69.8202);
    close(pair.tip_diameter[1] * 1e3, 130.737);
    close(pair.contact_ratio, 1.45154);
}

#[test]
fn a6_local_kinematics() {
    let omega = 1500.0 * std::f64::consts::PI / 30.0;
    let pair = fzg_c14();
    for (i, rho, rho_red, v_g, v_sum) in [
        (0, [4.2939, 30.6313], 3.76598, 2.53322, 3.88219),
        (3, [17.5785, 17.3467], 8.73092, 0.944678, 4.57777),
        (4, [23.723, 11.2022], 7.60912, 2.55331, 4.89949),
    ] {
        let x = pair.points[i];
        close(pair.curvature(x)[0] * 1e3, rho[0]);
        close(pair.curvature(x)[1] * 1e3, rho[1]);
        close(pair.relative_radius(x) * 1e3, rho_red);
        close(pair.sliding(x) * omega, v_g);
        close(pair.sum_speed(x) * omega, v_sum);
    }
    let pair = internal();
    let x = pair.points[4];
    close(pair.sliding(x) * 100.0, 0.315269);
    close(pair.sum_speed(x) * 100.0, 2.27223);
    close(pair.relative_radius(x) * 1e3, 23.133);
}

#[test]
fn b1_b1b_b4_loss_factors() {
    for (pair, ohlendorf, uniform) in [
        (fzg_c14(), 0.198635, 0.239309),
        (helical(), 0.0995648, 0.116033),
        (internal(), 0.0638342, 0.0732882),
    ] {
        close(pair.loss_factor_ohlendorf(), ohlendorf);
        close(pair.loss_factor_uniform(), uniform);
        // Under its own assumptions the local factor equals the closed form to rounding.
        assert!((pair.loss_factor_local(LoadSharing::Rigid) / pair.loss_factor_ohlendorf() - 1.0).abs() < 1e-12);
        assert!((pair.loss_factor_local(LoadSharing::Uniform) / pair.loss_factor_uniform() - 1.0).abs() < 1e-12);
    }
}

/// The table of the two-speed example: one column for each mesh.
#[test]
#[allow(clippy::too_many_lines)]
fn two_speed_geometry_table() {
    struct Column {
        z: [u32; 2],
        m: f64,
        alpha: f64,
        beta: f64,
        a: f64,
        b: f64,
        x1: f64,
        reference: f64,
        alpha_wt: f64,
        sum: f64,
        x2: f64,
        k: f64,
        d: [f64; 2],
        da: [f64; 2],
        df: [f64; 2],
        points: [f64; 5],
        eps: [f64; 3],
        overlap: f64,
        tip_width: f64,
    }
    let columns = [
        Column {
            z: [16, 83],
            m: 1.25,
            alpha: 20.0,
            beta: 26.0,
            a: 69.0,
            b: 20.0,
            x1: 0.25,
            reference: 68.8422,
            alpha_wt: 22.3669,
            sum: 0.1271,
            x2: -0.1229,
            k: -0.0009,
            d: [22.2520, 115.4325],
            da: [25.3748, 117.6230],
            df: [19.7520, 112.0002],
            points: [1.825, 3.341, 4.244, 5.875, 7.391],
            eps: [1.374, 0.777, 0.597],
            overlap: 2.23,
            tip_width: 0.62,
        },
        Column {
            z: [24, 101],
            m: 1.6,
            alpha: 17.5,
            beta: 29.0,
            a: 115.0,
            b: 25.0,
            x1: 0.25,
            reference: 114.3354,
            alpha_wt: 20.7231,
            sum: 0.4245,
            x2: 0.1745,
            k: -0.0091,
            d: [43.9048, 184.7660],
            da: [47.8757, 188.4952],
            df: [40.7048, 181.3243],
            points: [4.230, 6.699, 7.813, 9.636, 12.105],
            eps: [1.457, 0.794, 0.663],
            overlap: 2.41,
            tip_width: 0.78,
        },
        Column {
            z: [31, 96],
            m: 1.6,
            alpha: 17.5,
            beta: 27.0,
            a: 115.0,
            b: 22.0,
            x1: 0.30,
            reference: 114.0283,
            alpha_wt: 20.8121,
            sum: 0.6273,
            x2: 0.3273,
            k: -0.0200,
            d: [55.6674, 172.3893],
            da: [59.7632, 176.5726],
            df: [52.6274, 169.4368],
            points: [6.338, 8.979, 9.974, 11.656, 14.297],
            eps: [1.497, 0.813, 0.684],
            overlap: 1.99,
            // Before tip shortening it would be 0.79.
            tip_width: 0.80,
        },
    ];
    for c in &columns {
        let pair = Pair::new(&PairSpec {
            profile_shift: [Some(c.x1), None],
            tip_diameter: [None, None],
            ..spec(c.z, c.m, c.alpha, c.beta, c.b, c.a, [0.0, 0.0])
        })
        .unwrap();
        near(pair.reference_distance * 1e3, c.reference, 5e-5);
        near(pair.working_angle.to_degrees(), c.alpha_wt, 5e-5);
        near(pair.profile_shift[0] + pair.profile_shift[1], c.sum, 5e-5);
        near(pair.profile_shift[1], c.x2, 5e-5);
        near(pair.shortening, c.k, 5e-5);
        for i in 0..2 {
            near(pair.reference_diameter[i] * 1e3, c.d[i], 5e-5);
            near(pair.tip_diameter[i] * 1e3, c.da[i], 5e-5);
            near(pair.root_diameter[i] * 1e3, c.df[i], 5e-5);
            near(pair.tip_clearance(i) / pair.normal_module, 0.25, 5e-3);
        }
        for i in 0..5 {
            near(pair.points[i] * 1e3, c.points[i], 5e-4);
        }
        near(pair.contact_ratio, c.eps[0], 5e-4);
        near(pair.addendum_ratio[0], c.eps[1], 5e-4);
        near(pair.addendum_ratio[1], c.eps[2], 5e-4);
        near(pair.overlap_ratio, c.overlap, 5e-3);
        near(pair.tip_width(0) / pair.normal_module, c.tip_width, 5e-3);
    }
}

#[test]
fn undercut_begins_at_seventeen_teeth() {
    let pair = Pair::new(&spec([16, 17], 2.0, 20.0, 0.0, 20.0, 33.0, [36.0, 38.0])).unwrap();
    // 2/sin^2(20 deg) = 17.097 teeth.
    near(pair.undercut_limit(0), 1.0 - 16.0 / 17.097, 5e-5);
    near(pair.undercut_limit(1), 1.0 - 17.0 / 17.097, 5e-5);
}

#[test]
fn specific_sliding_is_that_of_the_surface_speeds_at_the_ends() {
    for pair in [fzg_c14(), helical(), internal()] {
        let at = |x: f64| {
            let [first, mate] = pair.curvature(x);
            [first, mate / pair.ratio()]
        };
        let ([v1, v2], [w1, w2]) = (at(pair.points[0]), at(pair.points[4]));
        let [first, second] = pair.specific_sliding();
        close(first, (v1 - v2) / v1);
        close(second, (w2 - w1) / w2);
        assert!(first < 0.0 && second < 0.0);
    }
}

#[test]
fn an_internal_pair_of_standard_racks_has_standard_clearances() {
    let pair = Pair::new(&PairSpec {
        internal: true,
        profile_shift: [Some(0.0), Some(0.0)],
        ..spec([24, 72], 2.0, 20.0, 0.0, 20.0, 48.0, [52.0, 140.0])
    })
    .unwrap();
    close(pair.tip_clearance(0), 0.5e-3);
    close(pair.tip_clearance(1), 0.5e-3);
}

proptest! {
    #[test]
    fn shifts_and_centre_distance_go_there_and_back(
        z1 in 14_u32..40, more in 5_u32..90, x1 in -0.1..0.4_f64, x2 in -0.1..0.4_f64, beta in 0.0..30.0_f64,
    ) {
        let free = PairSpec {
            centre_distance: None,
            profile_shift: [Some(x1), Some(x2)],
            tip_diameter: [None, None],
            ..spec([z1, z1 + more], 2.0, 20.0, beta, 20.0, 1.0, [0.0, 0.0])
        };
        if let Ok(pair) = Pair::new(&free) {
            let again = Pair::new(&PairSpec { centre_distance: Some(pair.centre_distance), profile_shift: [Some(x1), None], ..free });
            let again = again.unwrap();
            prop_assert!((again.profile_shift[1] - x2).abs() < 1e-8);
            prop_assert!((pair.addendum_ratio[0] + pair.addendum_ratio[1] - pair.contact_ratio).abs() < 1e-12);
            prop_assert!((pair.working_radius[0] + pair.working_radius[1] - pair.centre_distance).abs() < 1e-12);
            let total: f64 = pair.path(LoadSharing::Rigid, 3).iter().map(|p| p.weight).sum();
            prop_assert!((total / (pair.points[4] - pair.points[0]) - 1.0).abs() < 1e-12);
            // The shares of all pairs in contact add up to one, so their integral along the path is one base pitch.
            for sharing in [LoadSharing::Rigid, LoadSharing::Ramp, LoadSharing::Third, LoadSharing::Uniform] {
                let sum: f64 = pair.path(sharing, 3).iter().map(|p| p.weight * p.share).sum();
                prop_assert!((sum / pair.base_pitch - 1.0).abs() < 1e-12, "{sharing:?} {sum}");
            }
        }
    }
}
