//! Cross-validation of the made-up problem over five folds of two torques.

use gearloss_numerics::inference::{FOLDS, Fold, Validation, folds};

use super::check_problem::{OPTIMUM, measured, minimise, parameters, points, residuals};

/// M_s and dT, whose bounds and values are looked at.
const M_S: usize = 6;
const D_T: usize = 7;

/// Errors of points that are left out, and the offset that is found without each fold.
fn leave_out(folds: &[Fold], least_seal: f64) -> (Validation, Vec<f64>) {
    let measured = measured();
    let (mut errors, mut offsets) = (vec![0.0; 440], Vec::new());
    for fold in folds {
        let others: Vec<usize> = (0..440).filter(|i| !fold.points.contains(i)).collect();
        let mut start = parameters(&OPTIMUM);
        start[M_S].bounds[0] = least_seal;
        let (_, u) = minimise(&others, &measured, start, &[]);
        offsets.push(u[D_T]);
        for (i, r) in fold.points.iter().zip(residuals(&u, &fold.points, &measured)) {
            errors[*i] = r;
        }
    }
    (Validation::new(folds, &errors).unwrap(), offsets)
}

/// The fits end within 1e-6 standard deviations; check values are printed with six to nine digits.
fn near(x: f64, y: f64) {
    assert!((x - y).abs() < 1e-7, "{x} instead of {y}");
}

#[test]
fn check_7_4_folds() {
    let torque: Vec<f64> = points().iter().map(|p| p.torque).collect();
    let folds = folds(&torque, FOLDS).unwrap();
    let bands: Vec<[f64; 2]> = folds.iter().filter_map(|f| f.band).collect();
    assert_eq!(
        bands,
        [[2.0, 4.0], [6.0, 8.0], [10.0, 12.0], [14.0, 16.0], [18.0, 20.0]]
    );
    // The check values belong to fits in which M_s may fall below zero, as it does without the first fold.
    let (found, offsets) = leave_out(&folds, -0.1);
    let rms = [1.03859838, 1.03002249, 1.03248298, 1.04297129, 1.17346344];
    for (x, y) in found.fold_rms().into_iter().zip(rms) {
        near(x, y);
    }
    near(found.rms, 1.06493752);
    for (x, y) in offsets
        .into_iter()
        .zip([0.0449127, 0.0083749, 0.0186688, 0.0301635, 0.0253304])
    {
        near(x, y);
    }
    assert!(found.strange(1.03177192).is_empty());
    // With M_s held at its bound of zero another program finds these for the first fold; the other folds stay.
    let (bounded, offsets) = leave_out(&folds, 0.0);
    near(bounded.fold_rms()[0], 1.03566382);
    near(offsets[0], 0.04297845);
    for (x, y) in bounded.fold_rms().into_iter().zip(rms).skip(1) {
        near(x, y);
    }
}
