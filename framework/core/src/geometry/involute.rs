//! The involute function and its inverse.

/// inv a = tan a - a, for an angle in rad.
pub fn involute(angle: f64) -> f64 {
    angle.tan() - angle
}

/// The angle in rad with this involute; zero unless the value is positive.
pub(crate) fn inverse_involute(value: f64) -> f64 {
    if value.is_nan() || value <= 0.0 {
        return 0.0;
    }
    let mut angle = (3.0 * value).cbrt().min(1.5);
    for _ in 0..50 {
        let step = (angle.tan() - angle - value) / angle.tan().powi(2);
        angle = (angle - step).clamp(1e-12, 1.57);
        if step.abs() <= 1e-16 * angle {
            break;
        }
    }
    angle
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a0_involute_of_20_degrees_and_back() {
        assert!((involute(20.0_f64.to_radians()) - 0.014904384).abs() < 5e-10);
        assert!((inverse_involute(0.02).to_degrees() - 21.9811).abs() < 5e-5);
    }

    proptest! {
        #[test]
        fn there_and_back(angle in 0.01..1.2_f64) {
            prop_assert!((inverse_involute(involute(angle)) - angle).abs() < 1e-11);
        }
    }
}
