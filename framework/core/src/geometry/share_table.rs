//! Shares of the load on one pair of teeth along the path of contact, as a table.

use super::pair::Pair;

/// One place of a table.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ShareRow {
    /// Distance from T1 along the line of action. \[m\]
    pub x: f64,
    /// Share of the mesh's normal force on the pair, mean over the face.
    pub share: f64,
    /// Line load where the pair touches, over that of one pair that carries the force evenly along the whole face.
    pub line: f64,
    /// The same where it is greatest along the face.
    pub peak: f64,
}

/// Shares along the path at one load: straight lines between places, and a jump where two places are the same.
#[derive(Debug, Clone, PartialEq)]
pub struct ShareTable {
    rows: Vec<ShareRow>,
}

impl ShareTable {
    /// A table of places in the order of the path.
    pub fn new(rows: Vec<ShareRow>) -> Self {
        Self { rows }
    }

    /// The places.
    pub fn rows(&self) -> &[ShareRow] {
        &self.rows
    }

    /// The values at a place; of a jump those behind it. Zero outside the table.
    pub fn at(&self, x: f64) -> ShareRow {
        let zero = ShareRow {
            x,
            ..ShareRow::default()
        };
        let i = self.rows.partition_point(|row| row.x <= x);
        let Some(low) = i.checked_sub(1).map(|i| self.rows[i]) else {
            return zero;
        };
        let Some(high) = self.rows.get(i) else {
            return if x > low.x { zero } else { low };
        };
        let t = (x - low.x) / (high.x - low.x);
        let between = |a: f64, b: f64| a + t * (b - a);
        ShareRow {
            x,
            share: between(low.share, high.share),
            line: between(low.line, high.line),
            peak: between(low.peak, high.peak),
        }
    }

    /// Integral of share times distance from the pitch point over a section without the pitch point inside. \[m2\]
    pub(super) fn moment(&self, pair: &Pair, [start, end]: [f64; 2]) -> f64 {
        let mut places: Vec<f64> = vec![start];
        places.extend(self.rows.iter().map(|row| row.x).filter(|x| *x > start && *x < end));
        places.push(end);
        let inside = 1e-9 * (end - start);
        let pieces = places.windows(2).filter(|piece| piece[1] > piece[0]);
        pieces
            .map(|piece| {
                let length = piece[1] - piece[0];
                let inside = inside.min(0.25 * length);
                // Both factors are linear: the rule of Simpson is exact.
                let value = |x: f64| self.at(x).share * (x - pair.points[2]).abs();
                let ends = value(piece[0] + inside) + value(piece[1] - inside);
                length / 6.0 * (ends + 4.0 * value(0.5 * (piece[0] + piece[1])))
            })
            .sum()
    }

    /// Local tooth loss factor of a pair with these shares.
    pub fn loss_factor(&self, pair: &Pair) -> f64 {
        let [start, _, pitch, _, end] = pair.points;
        let middle = pitch.clamp(start, end);
        let moment = self.moment(pair, [start, middle]) + self.moment(pair, [middle, end]);
        let sliding = 1.0 + pair.sign() / pair.ratio();
        moment * sliding / (pair.base_pitch * pair.base_helix.cos() * pair.base_radius[0])
    }
}
