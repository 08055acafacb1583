//! Positions: every component has a position relative to another one, up to the gear unit.

use std::collections::{BTreeMap, BTreeSet};

use super::model::{Component, Id};
use super::source::Source;
use super::units::Quantity;
use crate::codes;

pub type Vector = [f64; 3];

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub fn sum(a: Vector, b: Vector, factor: f64) -> Vector {
    [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]]
}

/// A vector of length one; `None` without a direction.
pub fn unit(a: Vector) -> Option<Vector> {
    let length = dot(a, a).sqrt();
    (length > 1e-9 && length.is_finite()).then(|| a.map(|x| x / length))
}

/// Origin and axes of a component in the coordinates of the gear unit, in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    pub origin: Vector,
    pub u: Vector,
    pub v: Vector,
    pub w: Vector,
}

impl Pose {
    const UNIT: Self = Self {
        origin: [0.0; 3],
        u: [1.0, 0.0, 0.0],
        v: [0.0, 1.0, 0.0],
        w: [0.0, 0.0, 1.0],
    };

    /// A vector of this pose in the coordinates of the gear unit.
    pub fn turned(&self, a: Vector) -> Vector {
        sum(sum(self.u.map(|x| x * a[0]), self.v, a[1]), self.w, a[2])
    }

    /// A pose that is relative to this one.
    fn then(&self, next: &Self) -> Self {
        Self {
            origin: sum(self.origin, self.turned(next.origin), 1.0),
            u: self.turned(next.u),
            v: self.turned(next.v),
            w: self.turned(next.w),
        }
    }
}

/// The poses of all components that have a position.
#[derive(Debug)]
pub struct Poses(BTreeMap<Id, Pose>);

impl Poses {
    pub fn new(source: &Source<'_>) -> Self {
        let mut poses = Self(BTreeMap::new());
        for component in source.model.components.values() {
            if component.attribute("support_vector").is_some() && component.kind != "gear_unit" {
                poses.resolve(source, component);
            }
        }
        poses
    }

    pub fn get(&self, id: Id) -> Option<&Pose> {
        self.0.get(&id)
    }

    /// Follows the references up to the gear unit or to a component that is known, and back.
    fn resolve(&mut self, source: &Source<'_>, component: &Component) {
        let mut chain: Vec<(Id, Pose)> = Vec::new();
        let mut seen = BTreeSet::new();
        let mut next = Some(component);
        let mut known = Pose::UNIT;
        while let Some(component) = next {
            if let Some(pose) = self.0.get(&component.id) {
                known = *pose;
                break;
            }
            if component.kind == "gear_unit" {
                break;
            }
            if !seen.insert(component.id) {
                source.error(
                    component,
                    codes::REXS_MODEL,
                    "its position refers to itself through other components",
                    "refer to the gear unit in reference_component_for_position",
                );
                // Known from now on, so that this is reported once.
                for id in seen {
                    self.0.insert(id, Pose::UNIT);
                }
                return;
            }
            chain.push((component.id, own_pose(source, component)));
            let reference = source.integer(component, "reference_component_for_position");
            next = match reference {
                Some(id) if id != component.id => {
                    let target = source.component(id);
                    if target.is_none() {
                        source.error(
                            component,
                            codes::REXS_MODEL,
                            &format!("its position refers to component {id}, which does not exist"),
                            "refer to the gear unit in reference_component_for_position",
                        );
                    }
                    target
                }
                _ => None,
            };
        }
        for (id, pose_in_chain) in chain.into_iter().rev() {
            known = known.then(&pose_in_chain);
            self.0.insert(id, known);
        }
    }
}

/// The position that a component states, with axes at right angles.
fn own_pose(source: &Source<'_>, component: &Component) -> Pose {
    let origin = source.vector(component, "support_vector").unwrap_or_default();
    let u = source
        .vector(component, "u_axis_vector")
        .and_then(unit)
        .unwrap_or(Pose::UNIT.u);
    let w = source.vector(component, "w_axis_vector").unwrap_or(Pose::UNIT.w);
    // Parallel vectors leave no third axis; the directions across the shaft then do not matter.
    let w = unit(sum(w, u, -dot(w, u)))
        .or_else(|| unit(cross(u, Pose::UNIT.v)))
        .unwrap_or(Pose::UNIT.v);
    Pose {
        origin,
        u,
        v: cross(w, u),
        w,
    }
}

/// Cosine of the angle below which axes are parallel, 0.01 degrees.
pub const PARALLEL: f64 = 0.999_999_98;

/// The coordinates of gearbox files: x along the shafts, z upwards.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    pub x: Vector,
    pub y: Vector,
    pub z: Vector,
}

impl Frame {
    /// From the direction of the first shaft and that of gravity.
    pub fn new(source: &Source<'_>, first: Option<&Pose>) -> Self {
        let mut x = first.map_or(Pose::UNIT.u, |pose| pose.u);
        // Along u of the gear unit, so that positions are those of the file.
        if x[0] < -0.999_999_99 {
            x = Pose::UNIT.u;
        }
        let unit_of_gears = source.components("gear_unit").next();
        let gravity = unit_of_gears.and_then(|component| {
            let part = |axis: &str| {
                let id = format!("direction_vector_gravity_{axis}");
                source.number(component, &id, Quantity::Number)
            };
            unit([part("u")?, part("v")?, part("w")?])
        });
        let up = gravity.map(|down| down.map(|x| -x));
        let across = |up: Vector| unit(sum(up, x, -dot(up, x)));
        let z = match up {
            Some(up) if dot(up, x).abs() > 0.999 => {
                source.note(
                    "gravity acts along the shafts: gearbox files describe horizontal shafts, so `z` is no height here",
                );
                None
            }
            Some(up) => {
                if dot(up, x).abs() > 1e-3 {
                    source.note(format!(
                        "the shafts are inclined by {:.1} deg; they are described as horizontal, see `housing.grade`",
                        dot(up, x).asin().to_degrees()
                    ));
                }
                across(up)
            }
            None => {
                source.assume("the file states no direction of gravity: upwards (z) is the w axis of the gear unit");
                None
            }
        };
        let z = z
            .or_else(|| across(Pose::UNIT.w))
            .or_else(|| across(Pose::UNIT.v))
            .unwrap_or(Pose::UNIT.w);
        Self { x, y: cross(z, x), z }
    }

    /// The coordinates of a vector.
    pub fn coordinates(&self, a: Vector) -> Vector {
        [dot(a, self.x), dot(a, self.y), dot(a, self.z)]
    }

    /// The sense of an axis along the shafts: 1 or -1.
    pub fn sense(&self, u: Vector) -> f64 {
        if dot(u, self.x) < 0.0 { -1.0 } else { 1.0 }
    }

    /// True if an axis is parallel to the shafts, within 0.01 degrees.
    pub fn is_parallel(&self, u: Vector) -> bool {
        dot(u, self.x).abs() > PARALLEL
    }
}
