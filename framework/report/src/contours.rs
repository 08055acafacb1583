//! Lines of equal value over a lattice, by marching squares.

/// A straight piece of a line in lattice coordinates; whole numbers are lattice points.
pub type Piece = [(f64, f64); 2];

/// About `count` round values between the minimum and the maximum.
pub fn levels(low: f64, high: f64, about: usize) -> Vec<f64> {
    let raw = (high - low) / about.max(1) as f64;
    if !raw.is_finite() || raw <= 0.0 {
        return Vec::new();
    }
    let decade = 10_f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0]
        .into_iter()
        .map(|s| s * decade)
        .find(|s| *s >= raw / 1.4)
        .unwrap_or(raw);
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    (first..=last).map(|k| k as f64 * step).collect()
}

/// The pieces of the contour of one value; cells with a missing corner have none, nor those that are cut, given by column and row. Values are
/// stored row by row.
pub fn pieces(values: &[Option<f64>], columns: usize, level: f64, is_cut: &dyn Fn(usize, usize) -> bool) -> Vec<Piece> {
    let mut pieces = Vec::new();
    if columns < 2 {
        return pieces;
    }
    let rows = values.len() / columns;
    for j in 0..rows.saturating_sub(1) {
        for i in (0..columns - 1).filter(|i| !is_cut(*i, j)) {
            let corner = |di: usize, dj: usize| values[(j + dj) * columns + i + di].map(|v| v - level);
            let (Some(a), Some(b), Some(c), Some(d)) = (corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)) else {
                continue;
            };
            let (x, y) = (i as f64, j as f64);
            let at = |p: f64, q: f64| p / (p - q);
            // Crossings of the four sides in turn.
            let sides = [
                (a, b, (x + at(a, b), y)),
                (b, c, (x + 1.0, y + at(b, c))),
                (d, c, (x + at(d, c), y + 1.0)),
                (a, d, (x, y + at(a, d))),
            ];
            let crossed: Vec<(f64, f64)> = sides
                .iter()
                .filter(|(p, q, _)| (*p < 0.0) != (*q < 0.0))
                .map(|(_, _, place)| *place)
                .collect();
            match crossed[..] {
                [p, q] => pieces.push([p, q]),
                // A saddle: the mean of the corners decides which sides are connected.
                [p, q, r, s] => {
                    let together = ((a + b + c + d) < 0.0) == (a < 0.0);
                    pieces.extend(if together { [[p, q], [r, s]] } else { [[p, s], [q, r]] });
                }
                _ => {}
            }
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_levels_lie_between_the_ends() {
        assert_eq!(
            levels(0.13, 0.98, 8),
            [
                0.2,
                0.30000000000000004,
                0.4,
                0.5,
                0.6000000000000001,
                0.7000000000000001,
                0.8,
                0.9
            ]
        );
        assert!(levels(1.0, 1.0, 8).is_empty() && levels(f64::INFINITY, 0.0, 8).is_empty());
    }

    #[test]
    fn a_plane_has_straight_lines_and_a_gap_breaks_them() {
        // Value x + y on three by three points.
        let plane: Vec<Option<f64>> = (0..9).map(|k| Some(f64::from(k % 3 + k / 3))).collect();
        let line = pieces(&plane, 3, 1.5, &|_, _| false);
        assert_eq!(line.len(), 3);
        for (x, y) in line.iter().flatten() {
            assert!((x + y - 1.5).abs() < 1e-12);
        }
        let mut broken = plane;
        broken[4] = None;
        assert!(pieces(&broken, 3, 1.5, &|_, _| false).is_empty());
    }

    #[test]
    fn a_saddle_has_two_pieces() {
        assert_eq!(
            pieces(&[Some(1.0), Some(0.0), Some(0.0), Some(1.0)], 2, 0.4, &|_, _| false).len(),
            2
        );
    }
}
