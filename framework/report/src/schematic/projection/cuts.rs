//! Long bare shafts of the projected views, shortened: half shafts of an axle are several times as long as its gears are wide.

/// Length of a bare shaft over the largest tip radius from which it is shortened, and the length that remains.
const LONG: f64 = 3.0;
const LEFT: f64 = 1.0;

/// What is cut out of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cut {
    /// From the gears outwards: where the bare shaft begins and how much of it is cut out. \[m\]
    from: f64,
    length: f64,
    /// One if it is behind the gears, minus one before them.
    side: f64,
}

/// The cuts of all axes.
#[derive(Debug, Default)]
pub(super) struct Cuts {
    /// By axis, from the gears outwards.
    lines: Vec<Vec<Cut>>,
    left: f64,
}

impl Cuts {
    /// From the bodies on all axes: axis, both ends, and whether it is a gear. Between gears nothing is cut out, so that they stay
    /// beside their mates.
    pub fn new(lines: usize, bodies: impl Iterator<Item = (usize, [f64; 2], bool)>, largest: f64) -> Self {
        let mut own = vec![Vec::new(); lines];
        for (line, [a, b], is_gear) in bodies {
            own[line].push(([a.min(b), a.max(b)], is_gear));
        }
        let cuts = own.iter().map(|bodies| {
            let gears = bodies.iter().filter(|(_, is_gear)| *is_gear).map(|(ends, _)| *ends);
            let Some(gears) = gears.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]) else {
                return Vec::new();
            };
            let mut cuts = Vec::new();
            for side in [-1.0, 1.0] {
                let outwards = |[a, b]: [f64; 2]| if side > 0.0 { [a, b] } else { [-b, -a] };
                let mut beyond: Vec<[f64; 2]> = bodies.iter().map(|(ends, _)| outwards(*ends)).collect();
                beyond.sort_by(|a, b| a[0].total_cmp(&b[0]));
                let mut end = outwards(gears)[1];
                for [from, to] in beyond {
                    if from - end > LONG * largest {
                        cuts.push(Cut {
                            from: end,
                            length: from - end - LEFT * largest,
                            side,
                        });
                    }
                    end = end.max(to);
                }
            }
            cuts
        });
        Self {
            lines: cuts.collect(),
            left: LEFT * largest,
        }
    }

    /// True if anything is cut out.
    pub fn any(&self) -> bool {
        self.lines.iter().any(|cuts| !cuts.is_empty())
    }

    /// Where a position on an axis is shown. \[m\]
    pub fn place(&self, line: usize, at: f64) -> f64 {
        let moved = |cut: &Cut| {
            let beyond = cut.side * at - cut.from - 0.5 * self.left;
            cut.side * beyond.clamp(0.0, cut.length)
        };
        at - self.lines[line].iter().map(moved).sum::<f64>()
    }

    /// Where the cuts of an axis are shown. \[m\]
    pub fn marks(&self, line: usize) -> impl Iterator<Item = f64> {
        let cuts = self.lines[line].iter();
        cuts.map(move |cut| self.place(line, cut.side * (cut.from + 0.5 * self.left)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bare_shafts_beyond_the_gears_are_shortened() {
        let bodies = [
            (0, [0.0, 0.1], true),
            (0, [0.75, 0.7], false),
            (0, [-0.9, -0.8], false),
            (0, [0.2, 0.3], false),
            (1, [0.0, 0.1], true),
            (1, [0.9, 1.0], true),
        ];
        let cuts = Cuts::new(3, bodies.into_iter(), 0.1);
        assert!(cuts.any());
        // Gears and what is near them stay; of 0.4 m and 0.8 m a tenth of a metre remains.
        for (at, expected) in [
            (0.05, 0.05),
            (0.3, 0.3),
            (0.7, 0.4),
            (0.75, 0.45),
            (-0.05, -0.05),
            (-0.8, -0.1),
            (-0.9, -0.2),
        ] {
            assert!(
                (cuts.place(0, at) - expected).abs() < 1e-12,
                "{at}: {}",
                cuts.place(0, at)
            );
        }
        assert_eq!(cuts.place(1, 0.95), 0.95);
        let marks: Vec<f64> = cuts.marks(0).collect();
        assert!(
            (marks[0] + 0.05).abs() < 1e-12 && (marks[1] - 0.35).abs() < 1e-12,
            "{marks:?}"
        );
        assert_eq!(cuts.marks(2).count(), 0);
    }
}
