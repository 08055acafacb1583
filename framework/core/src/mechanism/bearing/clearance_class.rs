//! Radial internal clearance of the classes of rolling bearings before mounting.
//!
//! Source: ISO 5753-1 and DIN 620-4 as printed by two suppliers for deep groove ball bearings up to a bore of 100 mm, above it recalled, and by one
//! for cylindrical roller bearings with a cylindrical bore. For bores of 18 to 24 mm and the class C5 the suppliers misprint ball bearings;
//! these are recalled.

use super::{BearingKind, ClearanceClass};

/// Greatest bore in mm with the range of C2, normal, C3, C4, C5 in um.
type Row = (f64, [[f64; 2]; 5]);

const DEEP_GROOVE: [Row; 14] = [
    (10.0, [[0.0, 7.0], [2.0, 13.0], [8.0, 23.0], [14.0, 29.0], [20.0, 37.0]]),
    (
        18.0,
        [[0.0, 9.0], [3.0, 18.0], [11.0, 25.0], [18.0, 33.0], [25.0, 45.0]],
    ),
    (
        24.0,
        [[0.0, 10.0], [5.0, 20.0], [13.0, 28.0], [20.0, 36.0], [28.0, 48.0]],
    ),
    (
        30.0,
        [[1.0, 11.0], [5.0, 20.0], [13.0, 28.0], [23.0, 41.0], [30.0, 53.0]],
    ),
    (
        40.0,
        [[1.0, 11.0], [6.0, 20.0], [15.0, 33.0], [28.0, 46.0], [40.0, 64.0]],
    ),
    (
        50.0,
        [[1.0, 11.0], [6.0, 23.0], [18.0, 36.0], [30.0, 51.0], [45.0, 73.0]],
    ),
    (
        65.0,
        [[1.0, 15.0], [8.0, 28.0], [23.0, 43.0], [38.0, 61.0], [55.0, 90.0]],
    ),
    (
        80.0,
        [[1.0, 15.0], [10.0, 30.0], [25.0, 51.0], [46.0, 71.0], [65.0, 105.0]],
    ),
    (
        100.0,
        [[1.0, 18.0], [12.0, 36.0], [30.0, 58.0], [53.0, 84.0], [75.0, 120.0]],
    ),
    (
        120.0,
        [[2.0, 20.0], [15.0, 41.0], [36.0, 66.0], [61.0, 97.0], [90.0, 140.0]],
    ),
    (
        140.0,
        [[2.0, 23.0], [18.0, 48.0], [41.0, 81.0], [71.0, 114.0], [105.0, 160.0]],
    ),
    (
        160.0,
        [[2.0, 23.0], [18.0, 53.0], [46.0, 91.0], [81.0, 130.0], [120.0, 180.0]],
    ),
    (
        180.0,
        [[2.0, 25.0], [20.0, 61.0], [53.0, 102.0], [91.0, 147.0], [135.0, 200.0]],
    ),
    (
        200.0,
        [[2.0, 30.0], [25.0, 71.0], [63.0, 117.0], [107.0, 163.0], [150.0, 230.0]],
    ),
];

const CYLINDRICAL: [Row; 16] = [
    (
        24.0,
        [[0.0, 25.0], [20.0, 45.0], [35.0, 60.0], [50.0, 75.0], [65.0, 90.0]],
    ),
    (
        30.0,
        [[0.0, 25.0], [20.0, 45.0], [35.0, 60.0], [50.0, 75.0], [70.0, 95.0]],
    ),
    (
        40.0,
        [[5.0, 30.0], [25.0, 50.0], [45.0, 70.0], [60.0, 85.0], [80.0, 105.0]],
    ),
    (
        50.0,
        [[5.0, 35.0], [30.0, 60.0], [50.0, 80.0], [70.0, 100.0], [95.0, 125.0]],
    ),
    (
        65.0,
        [[10.0, 40.0], [40.0, 70.0], [60.0, 90.0], [80.0, 110.0], [110.0, 140.0]],
    ),
    (
        80.0,
        [[10.0, 45.0], [40.0, 75.0], [65.0, 100.0], [90.0, 125.0], [130.0, 165.0]],
    ),
    (
        100.0,
        [
            [15.0, 50.0],
            [50.0, 85.0],
            [75.0, 110.0],
            [105.0, 140.0],
            [155.0, 190.0],
        ],
    ),
    (
        120.0,
        [
            [15.0, 55.0],
            [50.0, 90.0],
            [85.0, 125.0],
            [125.0, 165.0],
            [180.0, 220.0],
        ],
    ),
    (
        140.0,
        [
            [15.0, 60.0],
            [60.0, 105.0],
            [100.0, 145.0],
            [145.0, 190.0],
            [200.0, 245.0],
        ],
    ),
    (
        160.0,
        [
            [20.0, 70.0],
            [70.0, 120.0],
            [115.0, 165.0],
            [165.0, 215.0],
            [225.0, 275.0],
        ],
    ),
    (
        180.0,
        [
            [25.0, 75.0],
            [75.0, 125.0],
            [120.0, 170.0],
            [170.0, 220.0],
            [250.0, 300.0],
        ],
    ),
    (
        200.0,
        [
            [35.0, 90.0],
            [90.0, 145.0],
            [140.0, 195.0],
            [195.0, 250.0],
            [275.0, 330.0],
        ],
    ),
    (
        225.0,
        [
            [45.0, 105.0],
            [105.0, 165.0],
            [160.0, 220.0],
            [220.0, 280.0],
            [305.0, 365.0],
        ],
    ),
    (
        250.0,
        [
            [45.0, 110.0],
            [110.0, 175.0],
            [170.0, 235.0],
            [235.0, 300.0],
            [330.0, 395.0],
        ],
    ),
    (
        280.0,
        [
            [55.0, 125.0],
            [125.0, 195.0],
            [190.0, 260.0],
            [260.0, 330.0],
            [370.0, 440.0],
        ],
    ),
    (
        315.0,
        [
            [55.0, 130.0],
            [130.0, 205.0],
            [200.0, 275.0],
            [275.0, 350.0],
            [410.0, 485.0],
        ],
    ),
];

impl ClearanceClass {
    /// By how much the mean clearance of this class exceeds that of the normal class, at least zero; `None` beyond the tables. \[m\]
    pub(super) fn above_normal(self, kind: BearingKind, bore: f64) -> Option<f64> {
        let table: &[Row] = match kind {
            BearingKind::DeepGrooveBall => &DEEP_GROOVE,
            BearingKind::CylindricalRoller | BearingKind::CylindricalRollerFullComplement => &CYLINDRICAL,
            _ => return None,
        };
        let (_, ranges) = table.iter().find(|(limit, _)| 1e3 * bore <= limit + 1e-9)?;
        let mean = |class: usize| 0.5 * (ranges[class][0] + ranges[class][1]);
        let class = match self {
            Self::C1 | Self::C2 | Self::Cn => return Some(0.0),
            Self::C3 => 2,
            Self::C4 => 3,
            Self::C5 => 4,
        };
        Some(1e-6 * (mean(class) - mean(1)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Classes follow each other, and clearance grows with the bore.
    #[test]
    fn classes_and_bores_are_in_order() {
        for table in [&DEEP_GROOVE[..], &CYLINDRICAL[..]] {
            for (_, ranges) in table {
                assert!(ranges.iter().all(|[least, most]| least < most), "{ranges:?}");
                let grow = |pair: &[[f64; 2]]| pair[0][0] < pair[1][0] && pair[0][1] < pair[1][1];
                assert!(ranges.windows(2).all(grow), "{ranges:?}");
            }
            for pair in table.windows(2) {
                assert!(pair[0].0 < pair[1].0);
                for (small, large) in pair[0].1.iter().zip(&pair[1].1) {
                    assert!(small[0] <= large[0] && small[1] <= large[1], "{pair:?}");
                }
            }
        }
    }

    /// A 6208 C3: 15 to 33 um where the normal class has 6 to 20 um.
    #[test]
    fn c3_above_normal() {
        let of = |class: ClearanceClass, kind| class.above_normal(kind, 0.04);
        assert_eq!(of(ClearanceClass::C3, BearingKind::DeepGrooveBall), Some(11e-6));
        assert_eq!(of(ClearanceClass::C2, BearingKind::DeepGrooveBall), Some(0.0));
        assert_eq!(of(ClearanceClass::C3, BearingKind::TaperedRoller), None);
        assert_eq!(ClearanceClass::C4.above_normal(BearingKind::DeepGrooveBall, 0.3), None);
    }
}
