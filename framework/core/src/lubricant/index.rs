//! Viscosity index according to ASTM D2270 and ISO 2909, and its inverses.

/// Upper end of each range of kv100, then the coefficients of L and H.
const ROWS: [(f64, [f64; 6]); 16] = [
    (3.8, [1.14673, 1.7576, -0.109, 0.84155, 1.5521, -0.077]),
    (4.4, [3.38095, -15.4952, 33.196, 0.78571, 1.7929, -0.183]),
    (5.0, [2.5000, -7.2143, 13.812, 0.82143, 1.5679, 0.119]),
    (6.4, [0.10100, 16.6350, -45.469, 0.04985, 9.1613, -18.557]),
    (7.0, [3.35714, -23.5643, 78.466, 0.22619, 7.7369, -16.656]),
    (7.7, [0.01191, 21.4750, -72.870, 0.79762, -0.7321, 14.610]),
    (9.0, [0.41858, 16.1558, -56.040, 0.05794, 10.5156, -28.240]),
    (12.0, [0.88779, 7.5527, -16.600, 0.26665, 6.7015, -10.810]),
    (15.0, [0.76720, 10.7972, -38.180, 0.20073, 8.4658, -22.490]),
    (18.0, [0.97305, 5.3135, -2.200, 0.28889, 5.9741, -4.930]),
    (22.0, [0.97256, 5.2500, -0.980, 0.24504, 7.4160, -16.730]),
    (28.0, [0.91413, 7.4759, -21.820, 0.20323, 9.1267, -34.230]),
    (40.0, [0.87031, 9.7157, -50.770, 0.18411, 10.1015, -46.750]),
    (55.0, [0.84703, 12.6752, -133.310, 0.17029, 11.4866, -80.620]),
    (70.0, [0.85921, 11.1009, -83.19, 0.17130, 11.3680, -76.940]),
    (f64::INFINITY, [0.83531, 14.6731, -216.246, 0.16841, 11.8493, -96.947]),
];

/// L and H at a viscosity at 100 degC in mm2/s; `None` below 2, where the index is not defined.
fn references(kv100: f64) -> Option<(f64, f64)> {
    if kv100.is_nan() || kv100 < 2.0 {
        return None;
    }
    row(kv100)
}

/// L and H of the row of a viscosity; the first row is extrapolated below its range.
fn row(kv100: f64) -> Option<(f64, f64)> {
    let (_, [a, b, c, d, e, f]) = ROWS.iter().find(|(end, _)| kv100 < *end)?;
    let square = |p: f64, q: f64, r: f64| (p * kv100 + q) * kv100 + r;
    Some((square(*a, *b, *c), square(*d, *e, *f)))
}

/// Viscosity index of two viscosities in mm2/s; `None` below 2 mm2/s at 100 degC.
pub fn index(kv40: f64, kv100: f64) -> Option<f64> {
    let (l, h) = references(kv100)?;
    Some(if kv40 >= h {
        100.0 * (l - kv40) / (l - h)
    } else {
        let n = (h.log10() - kv40.log10()) / kv100.log10();
        (10.0_f64.powf(n) - 1.0) / 0.00715 + 100.0
    })
}

/// Viscosity at 40 degC of an oil with this index. \[mm2/s\]
pub fn kv40(kv100: f64, index: f64) -> Option<f64> {
    let kv40 = of_references(references(kv100)?, kv100, index);
    (kv40 > kv100).then_some(kv40)
}

/// Viscosity at 40 degC of an oil in a family with one index. \[mm2/s\] Below 2 mm2/s at 100 degC, where the standard defines no
/// index, its first row is extrapolated; other common continuations jump there by a fifth.
pub fn at_constant_index(kv100: f64, index: f64) -> Option<f64> {
    let kv40 = of_references(row(kv100)?, kv100, index);
    (kv40 > kv100).then_some(kv40)
}

fn of_references((l, h): (f64, f64), kv100: f64, index: f64) -> f64 {
    if index <= 100.0 {
        l - index * (l - h) / 100.0
    } else {
        h / kv100.powf((1.0 + 0.00715 * (index - 100.0)).log10())
    }
}

/// Viscosity at 100 degC of an oil with this index, by bisection. \[mm2/s\]
pub fn kv100(target: f64, index: f64) -> Option<f64> {
    let (mut low, mut high) = (2.0, target);
    if kv40(low, index)? > target {
        return None;
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        // If no viscosity at 40 degC is higher, the oil is too thick.
        if kv40(middle, index).is_some_and(|kv40| kv40 <= target) {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(low)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use proptest::prelude::*;

    fn close(value: f64, expected: f64) {
        assert!((value / expected - 1.0).abs() < 1e-5, "{value} against {expected}");
    }

    #[test]
    fn d2_u8a_index_of_known_oils() {
        close(index(22.83, 5.05).unwrap(), 156.461);
        close(index(73.30, 8.86).unwrap(), 92.4260);
        close(index(27.3, 5.9).unwrap(), 169.2978);
        close(index(27.3, 5.97).unwrap(), 173.6855);
    }

    #[test]
    fn d2_viscosity_at_40_degc_of_an_index() {
        for (kv100, expected) in [
            (2.0, 5.62615),
            (3.0, 9.92417),
            (4.0, 15.1470),
            (5.0, 21.1770),
            (5.9, 26.8361),
            (8.0, 40.6100),
            (10.0, 54.1953),
        ] {
            close(kv40(kv100, 174.0).unwrap(), expected);
        }
        close(kv40(10.0, 95.0).unwrap(), 86.1118);
    }

    #[test]
    fn an_index_below_zero_thins_faster_than_the_worse_reference() {
        // L 147.706 and H 82.870 mm2/s at 10 mm2/s: ISO 2909, VI = 100 (L - U)/(L - H).
        close(kv40(10.0, -50.0).unwrap(), 180.1240);
        close(index(180.1240, 10.0).unwrap(), -50.0);
        close(kv100(180.1240, -50.0).unwrap(), 10.0);
    }

    #[test]
    fn u8b_a_family_of_one_index() {
        for (kv100, expected) in [
            (1.0, 2.316650),
            (1.5, 3.845998),
            (2.0, 5.626148),
            (3.0, 9.924169),
            (4.0, 15.14700),
            (5.0, 21.17702),
            (5.9, 26.83612),
            (7.0, 33.92266),
            (8.0, 40.60998),
            (10.0, 54.19528),
        ] {
            close(at_constant_index(kv100, 174.0).unwrap(), expected);
        }
    }

    #[test]
    fn d2_below_2_mm2_s_there_is_no_index() {
        assert_eq!(kv40(1.5, 174.0), None);
    }

    proptest! {
        #[test]
        fn index_and_inverse_agree(nu in 2.1..60.0_f64, vi in -200.0..250.0_f64) {
            if let Some(forty) = kv40(nu, vi) {
                // At exactly 100 both branches of the standard meet within its rounding.
                prop_assert!((index(forty, nu).unwrap() - vi).abs() < 0.02);
            }
        }
    }

    #[test]
    fn every_coefficient_is_that_of_the_standard() {
        // Independently transcribed from the standard.
        let table = include_str!("../../tests/tables/viscosity_index.csv");
        let lines: Vec<Vec<Option<f64>>> = table
            .lines()
            .filter(|line| !line.starts_with('#'))
            .skip(1)
            .map(|line| line.split(',').map(|cell| cell.parse().ok()).collect())
            .collect();
        assert_eq!(lines.len(), ROWS.len());
        let mut from = 2.0;
        for (line, (to, coefficients)) in lines.iter().zip(ROWS) {
            let expected = [from, to].into_iter().chain(coefficients);
            for (i, (cell, expected)) in line.iter().zip(expected).enumerate() {
                assert_eq!(cell.unwrap_or(f64::INFINITY), expected, "column {i} from {from} mm2/s");
            }
            assert_eq!(line.len(), 8);
            from = to;
        }
    }
}
