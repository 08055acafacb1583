//! The axis of a member in the housing: a line with a direction, and the frame in which its statics is solved.

use crate::description::AxisEntry;

/// Unit vector of x.
const X: [f64; 3] = [1.0, 0.0, 0.0];

/// Difference of directions that is rounding.
const ROUNDING: f64 = 1e-9;

/// Distance of lines that are one: a thousandth of a millimetre. \[m\]
const ONE_LINE: f64 = 1e-6;

/// The axis of a member.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// Point from which positions along the shaft count. \[m\]
    pub origin: [f64; 3],
    /// Unit vectors: the direction in which positions and speeds count, then two across it, the last one as far upwards as possible. Those
    /// of an axis along x are x, y and z.
    pub frame: [[f64; 3]; 3],
}

impl Axis {
    /// An axis along x through y and z. \[m\]
    pub fn along_x([y, z]: [f64; 2]) -> Self {
        Self {
            origin: [0.0, y, z],
            frame: [X, [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        }
    }

    /// As described; `None` if the direction is zero.
    pub fn new(entry: &AxisEntry) -> Option<Self> {
        let directed = match entry {
            AxisEntry::AlongX(place) => return Some(Self::along_x(*place)),
            AxisEntry::Directed(directed) => directed,
        };
        let length = norm(directed.direction);
        if !(length > 0.0 && length.is_finite()) {
            return None;
        }
        let direction = directed.direction.map(|part| part / length);
        let horizontal = direction[0].hypot(direction[1]);
        let frame = if direction == X {
            Self::along_x([0.0; 2]).frame
        } else if horizontal < ROUNDING {
            [direction, [0.0, 1.0, 0.0], [-direction[2], 0.0, 0.0]]
        } else {
            let [x, y, z] = direction;
            let up = [-z * x / horizontal, -z * y / horizontal, horizontal];
            [direction, cross(up, direction), up]
        };
        Some(Self {
            origin: directed.through,
            frame,
        })
    }

    /// True if it has the direction of x.
    pub fn is_along_x(&self) -> bool {
        self.frame[0] == X
    }

    /// The direction in which positions count.
    pub fn direction(&self) -> [f64; 3] {
        self.frame[0]
    }

    /// Position of the origin along the direction: positions plus this are comparable between parallel shafts. \[m\]
    pub fn start(&self) -> f64 {
        if self.is_along_x() {
            self.origin[0]
        } else {
            dot(self.origin, self.frame[0])
        }
    }

    /// The point at a position. \[m\]
    pub fn point(&self, at: f64) -> [f64; 3] {
        let [direction, ..] = self.frame;
        std::array::from_fn(|i| self.origin[i] + at * direction[i])
    }

    /// The position of a point along the shaft. \[m\]
    pub fn position(&self, point: [f64; 3]) -> f64 {
        let from_origin = std::array::from_fn(|i| point[i] - self.origin[i]);
        if self.is_along_x() {
            from_origin[0]
        } else {
            dot(from_origin, self.frame[0])
        }
    }

    /// Words for the directions in which positions along the shaft grow and decrease.
    pub fn senses(&self) -> [&'static str; 2] {
        if self.is_along_x() {
            ["+x", "-x"]
        } else {
            ["larger positions", "smaller positions"]
        }
    }

    /// A vector in the frame of the axis.
    pub fn local(&self, vector: [f64; 3]) -> [f64; 3] {
        if self.is_along_x() {
            vector
        } else {
            self.frame.map(|unit| dot(unit, vector))
        }
    }

    /// The vector across from this axis to another of the same direction, in its frame; `None` if their directions differ. \[m\]
    pub fn to_parallel(&self, other: &Self) -> Option<[f64; 2]> {
        if distance(self.frame[0], other.frame[0]) > ROUNDING {
            return None;
        }
        let between = std::array::from_fn(|i| other.origin[i] - self.origin[i]);
        let [_, y, z] = self.local(between);
        Some([y, z])
    }

    /// True if the other axis is the same line, with the same direction and positions that count from the same point.
    pub fn is_same(&self, other: &Self) -> bool {
        self.to_parallel(other)
            .is_some_and(|[y, z]| y.hypot(z) <= ONE_LINE && (self.start() - other.start()).abs() <= ONE_LINE)
    }

    /// True if both are parallel, in whichever direction.
    pub fn is_parallel(&self, other: &Self) -> bool {
        norm(cross(self.frame[0], other.frame[0])) <= ROUNDING
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn norm(vector: [f64; 3]) -> f64 {
    dot(vector, vector).sqrt()
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    norm(std::array::from_fn(|i| a[i] - b[i]))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::description::DirectedAxis;
    use proptest::prelude::*;

    proptest! {
        /// The frame is right-handed and orthonormal, and its last vector points upwards.
        #[test]
        fn frames_are_orthonormal(x in -1.0..1.0_f64, y in -1.0..1.0_f64, z in -1.0..1.0_f64) {
            prop_assume!(norm([x, y, z]) > 0.1);
            let entry = AxisEntry::Directed(DirectedAxis { through: [0.1, 0.2, 0.3], direction: [x, y, z] });
            let axis = Axis::new(&entry).unwrap();
            let [k, e2, e3] = axis.frame;
            for (a, b, product) in [(k, k, 1.0), (e2, e2, 1.0), (e3, e3, 1.0), (k, e2, 0.0), (k, e3, 0.0), (e2, e3, 0.0)] {
                prop_assert!((dot(a, b) - product).abs() < 1e-14);
            }
            prop_assert!(distance(cross(k, e2), e3) < 1e-14 && e3[2] >= 0.0);
        }
    }

    #[test]
    fn vertical_axes_and_those_along_x_have_frames_too() {
        let axis = |direction| {
            let through = [0.1, 0.2, 0.3];
            Axis::new(&AxisEntry::Directed(DirectedAxis { through, direction }))
        };
        assert_eq!(axis([2.0, 0.0, 0.0]).unwrap().frame, Axis::along_x([0.0; 2]).frame);
        for z in [1.0, -3.0] {
            let [k, e2, e3] = axis([0.0, 0.0, z]).unwrap().frame;
            assert_eq!(cross(k, e2), e3);
        }
        assert_eq!(axis([0.0; 3]), None);
    }
}
