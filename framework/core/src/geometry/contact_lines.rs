//! Evenly distributed load over all lines of contact of a helical pair, with their varying length.
//!
//! With N(x) pairs at a transverse position x (modulo the base pitch) the total length of the lines of contact in the phase phi is
//! S(phi) = integral of N from phi to phi + B, over sin(beta_b), where B = b tan(beta_b) is the inclination of a line along the
//! path. Each element of the lines carries the same force, so the share of one pair at x, averaged over the face, is K(x) =
//! integral of 1/S from x - B to x. Without inclination it is 1/N, for an integer overlap ratio 1/eps_alpha.

use super::pair::Pair;

/// Share of one pair along the path, by closed integrals over the pieces where S is linear.
#[derive(Debug, Clone)]
pub(super) struct ContactLines {
    start: f64,
    pitch: f64,
    /// Number of pairs always in contact, and the length of the zone with one more. \[m\]
    always: f64,
    zone: f64,
    inclination: f64,
    /// Phases over one pitch from the start, with S and the integral of 1/S up to each.
    pieces: Vec<(f64, f64, f64)>,
}

impl ContactLines {
    /// The lines of a pair; `None` for spur gears, whose lines are parallel to the axis.
    pub fn new(pair: &Pair) -> Option<Self> {
        let inclination = pair.facewidth * pair.base_helix.tan();
        let [start, .., end] = pair.points;
        let pitch = pair.base_pitch;
        if inclination <= 1e-9 * pitch {
            return None;
        }
        let always = pair.contact_ratio.floor();
        let mut lines = Self {
            start,
            pitch,
            always,
            zone: (end - start) - always * pitch,
            inclination,
            pieces: Vec::new(),
        };
        let within = |x: f64| (x - start).rem_euclid(pitch);
        let mut phases = vec![0.0, pitch];
        for jump in [start, start + lines.zone] {
            phases.extend([within(jump), within(jump - inclination)]);
        }
        phases.sort_by(f64::total_cmp);
        let mut integral = 0.0;
        let mut before: Option<(f64, f64)> = None;
        for phase in phases {
            let s = lines.length(start + phase);
            if let Some((last, s_last)) = before {
                integral += inverse_integral(phase - last, s_last, s);
            }
            lines.pieces.push((phase, s, integral));
            before = Some((phase, s));
        }
        Some(lines)
    }

    /// Integral of N from the start to x. \[m\]
    fn pairs(&self, x: f64) -> f64 {
        let whole = ((x - self.start) / self.pitch).floor();
        let rest = x - self.start - whole * self.pitch;
        (x - self.start) * self.always + whole * self.zone + rest.min(self.zone)
    }

    /// S at a phase. \[m\]
    fn length(&self, x: f64) -> f64 {
        self.pairs(x + self.inclination) - self.pairs(x)
    }

    /// Integral of 1/S from the start to x.
    fn inverse(&self, x: f64) -> f64 {
        let period = self.pieces[self.pieces.len() - 1].2;
        let whole = ((x - self.start) / self.pitch).floor();
        let phase = x - self.start - whole * self.pitch;
        let i = self
            .pieces
            .partition_point(|p| p.0 <= phase)
            .clamp(1, self.pieces.len() - 1);
        let ((low, s_low, before), (high, s_high, _)) = (self.pieces[i - 1], self.pieces[i]);
        let t = if high > low { (phase - low) / (high - low) } else { 0.0 };
        whole * period + before + inverse_integral(phase - low, s_low, s_low + t * (s_high - s_low))
    }

    /// Kinks of the share within the path.
    pub fn kinks(&self, end: f64) -> Vec<f64> {
        let shifts = [0.0, self.inclination];
        let phases = self.pieces.iter().flat_map(|p| shifts.map(|shift| p.0 + shift));
        let mut kinks = Vec::new();
        for phase in phases {
            let mut x = self.start + phase.rem_euclid(self.pitch);
            while x < end {
                kinks.push(x);
                x += self.pitch;
            }
        }
        kinks
    }

    /// Share of the mesh's normal force on one pair, averaged over the face.
    pub fn share(&self, x: f64) -> f64 {
        self.inverse(x) - self.inverse(x - self.inclination)
    }
}

/// Integral of 1/S over a piece where S runs from `a` to `b`.
fn inverse_integral(length: f64, a: f64, b: f64) -> f64 {
    if (b - a).abs() < 1e-9 * a {
        length / (0.5 * (a + b))
    } else {
        length * (b / a).ln() / (b - a)
    }
}
