//! Planets on their carriers: radius of the orbit, unequal sharing of the load, whether the set can be assembled.

use super::gearing::{GearSeat, MeshSeat};
use super::members::Members;
use crate::description::GearboxEntry;
use crate::document::Diagnostic;

/// How unequally the planets of a set share its load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sharing {
    /// Load of the most loaded planet over the mean.
    pub most: f64,
    /// Load of each of the others over the mean.
    pub others: f64,
    /// Share of the most loaded planet in the number of planets.
    pub weight: f64,
}

impl Sharing {
    /// Load over the mean: of the most loaded planet, and of each of the others.
    pub fn factors(&self) -> [f64; 2] {
        [self.most, self.others]
    }

    fn new(factor: f64, count: f64) -> Self {
        Self {
            most: factor,
            others: (count - factor) / (count - 1.0),
            weight: 1.0 / count,
        }
    }
}

/// Radius of a planet body's orbit; absent where it meets no gear on the central axis. \[m\]
pub fn orbit(body: usize, members: &Members, meshes: &[MeshSeat]) -> Option<f64> {
    meshes
        .iter()
        .find(|m| m.members.contains(&body) && !m.members.iter().all(|b| members.planets[*b].is_some()))
        .map(|m| m.pair.centre_distance)
}

/// Sharing of the set that each member is a planet of; absent where all planets carry the same.
pub fn sharing(entry: &GearboxEntry, members: &Members, found: &mut Vec<Diagnostic>) -> Vec<Option<Sharing>> {
    let mut sharing = vec![None; members.names.len()];
    for (id, set) in entry.planetary_sets.iter() {
        let count = f64::from(set.count);
        if set.load_sharing > count {
            found.push(
                Diagnostic::error(
                    format!("planetary_sets.{id}.load_sharing"),
                    format!("one planet of {count} cannot carry {} times the mean", set.load_sharing),
                )
                .mend(format!("write a number from 1 to {count}")),
            );
        } else if set.load_sharing > 1.0 {
            for planet in &set.planets {
                if let Some(body) = members.names.iter().position(|m| m == planet) {
                    sharing[body] = Some(Sharing::new(set.load_sharing, count));
                }
            }
        }
    }
    sharing
}

/// What keeps a simple set from being assembled: planets that touch each other, or teeth that do not meet at equal spacing.
pub fn assembly(
    entry: &GearboxEntry,
    members: &Members,
    gears: &[GearSeat],
    meshes: &[MeshSeat],
    warnings: &mut Vec<Diagnostic>,
) {
    for (id, set) in entry.planetary_sets.iter() {
        let path = format!("planetary_sets.{id}");
        let count = f64::from(set.count);
        for planet in &set.planets {
            let Some(body) = members.names.iter().position(|m| m == planet) else {
                continue;
            };
            let Some(radius) = orbit(body, members, meshes) else {
                continue;
            };
            let apart = 2.0 * radius * (std::f64::consts::PI / count).sin();
            for gear in gears.iter().filter(|g| g.member == body && g.diameters[1] >= apart) {
                warnings.push(
                    Diagnostic::warning(
                        path.clone(),
                        format!(
                            "neighbouring planets touch: `{}` has a tip diameter of {:.3} mm, and their axes are {:.3} mm apart",
                            gear.id,
                            gear.diameters[1] * 1e3,
                            apart * 1e3
                        ),
                    )
                    .mend("take fewer planets or smaller ones"),
                );
            }
            // Of one gear between a sun and a ring the condition is known; a stepped planet can be turned to fit.
            let own: Vec<&MeshSeat> = meshes.iter().filter(|m| m.members.contains(&body)).collect();
            let [a, b] = own[..] else { continue };
            let one_gear = a.gears.iter().any(|g| b.gears.contains(g));
            if one_gear && a.pair.internal != b.pair.internal {
                let central = |m: &MeshSeat| {
                    let side = usize::from(m.members[0] == body);
                    (members.planets[m.members[side]].is_none()).then(|| m.pair.z[side])
                };
                if let (Some(first), Some(second)) = (central(a), central(b))
                    && !(first + second).is_multiple_of(set.count)
                {
                    warnings.push(
                        Diagnostic::warning(
                            path.clone(),
                            format!(
                                "{} planets cannot be spaced equally: {first} and {second} teeth do not add up to a multiple",
                                set.count
                            ),
                        )
                        .mend("change a number of teeth or of planets; losses are computed for equal spacing"),
                    );
                }
            }
        }
    }
}
