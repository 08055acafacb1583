//! Planets on their carriers: drag of the set, feasibility of assembly.

use std::sync::Arc;

use super::drags::{Covered, body, part};
use super::members::Members;
use super::oils::OilNumbers;
use super::seats::{GearSeat, MeshSeat, orbit};
use crate::attach::{Common, Places, Spot, State, dangling};
use crate::description::GearboxEntry;
use crate::document::Diagnostic;
use crate::evaluate::{Reading, readings};
use crate::loss::{Loss, NoteBase, Notebook, Notes, Undefined};
use crate::mechanism::gear_drag::Covers;
use crate::mechanism::planetary_drag::{PlanetaryDrag, PlanetaryDragAt, PlanetaryPart};
use crate::mechanism::{Answers, Slot, with_oil};
use crate::real::{Dual, Lane, Points};
use crate::registry::{Build, Placed, Sealed};

/// The placed drag model of a set.
struct PlacedDrag {
    part: Arc<PlanetaryPart>,
    model: Slot<PlanetaryDrag>,
    /// Reference shaft of the moment, carrier, first planet.
    members: [u16; 3],
    /// The oil, and its height above the carrier's axis.
    spot: Spot,
}

impl PlacedDrag {
    fn context<'a, R: Points>(&'a self, state: &State<'_, R>, notes: Notes<'a, R>) -> PlanetaryDragAt<'a, R> {
        let [speed, carrier_speed, planet_speed] = self.members.map(|m| state.speed(Some(m)));
        let oil = state.oil(&self.spot);
        let part = &*self.part;
        // Models do not use quantities that the part does not state: building it has rejected that.
        with_oil!(from oil, PlanetaryDragAt {
            part,
            speed,
            carrier_speed,
            planet_speed,
            volume: R::constant(part.oil_volume.unwrap_or(0.0)),
            level: state.level_at_rest(self.spot.level).level.at_least(-10.0),
            size: R::constant(part.size.unwrap_or(0.0)),
            ratio: R::constant(part.ratio.unwrap_or(0.0)),
            notes,
        })
    }
}

impl Sealed for PlacedDrag {}

impl PlacedDrag {
    fn answer<R: Answers>(&self, state: &State<'_, R>, book: &Notebook<'_, R>) -> Result<Loss<R>, Undefined> {
        let notes = book.notes(self.model.notes).forgetting();
        R::answer::<PlanetaryDrag>(&*self.model, &self.context(state, notes))
    }
}

impl Placed for PlacedDrag {
    fn loss(&self, state: &State<'_>, book: &Notebook<'_>) -> Result<Loss, Undefined> {
        self.answer(state, book)
    }
    fn losses(&self, state: &State<'_, Lane>, book: &Notebook<'_, Lane>) -> Loss<Lane> {
        // Undefined points are NaN.
        self.answer(state, book).unwrap_or(Loss::POWERS)
    }
    fn loss_with_derivatives(
        &self,
        state: &State<'_, Dual>,
        book: &Notebook<'_, Dual>,
    ) -> Result<Loss<Dual>, Undefined> {
        self.answer(state, book)
    }
    fn readings(&self, state: &State<'_>) -> Vec<Reading> {
        readings::<PlanetaryDrag>(&self.context(state, Notes::MUTED))
    }
    fn between(&self) -> [Option<u16>; 2] {
        [Some(self.members[0]), None]
    }
    fn loaded(&self) -> bool {
        false
    }
    fn off(&self) -> bool {
        self.model.off
    }
    fn notes(&self) -> NoteBase {
        self.model.notes
    }
    fn support(&self) -> Option<u16> {
        None
    }
}

/// A drag model with the losses of the planet gears that it covers.
pub struct Held {
    pub path: String,
    pub placed: Box<dyn Placed>,
    pub covered: Covered,
    /// Factor on the loss of the model.
    pub loss_factor: f64,
}

/// The drag models of all sets.
pub fn models(
    entry: &GearboxEntry,
    members: &Members,
    gears: &[GearSeat],
    meshes: &[MeshSeat],
    oils: &mut OilNumbers<'_>,
    build: &mut Build<'_>,
    found: &mut Vec<Diagnostic>,
) -> Vec<Held> {
    let ids: Vec<&str> = members.names.iter().map(String::as_str).collect();
    let mut held = Vec::new();
    for (id, set) in entry.planetary_sets.iter() {
        let path = format!("planetary_sets.{id}");
        let member = |name: &str| ids.iter().position(|m| *m == name);
        let bodies: Vec<usize> = set.planets.iter().filter_map(|p| member(p)).collect();
        let reference = set.reference.as_deref().unwrap_or(&set.carrier);
        let Some(reference) = member(reference) else {
            // An unknown carrier was reported with the members.
            if set.reference.is_some() {
                found.push(dangling(&format!("{path}.reference"), "shaft", reference, &ids));
            }
            continue;
        };
        let (Some(carrier), Some(first)) = (member(&set.carrier), bodies.first()) else {
            continue;
        };
        let gears_of_set: Vec<usize> = (0..gears.len())
            .filter(|g| bodies.contains(&gears[*g].member))
            .collect();
        let planets = gears_of_set
            .iter()
            .filter(|g| gears[**g].member == *first)
            .filter_map(|g| {
                let mesh = meshes.iter().find(|m| m.gears.contains(g))?;
                let own = entry.gears.0[*g].1.clearance;
                Some(part(entry, own, oils.filled(), body(&gears[*g], *g, mesh)?, None))
            })
            .collect();
        let part = PlanetaryPart {
            count: set.count,
            orbit: orbit(*first, members, meshes).unwrap_or(0.0),
            bodies: bodies.len() as u32,
            planets,
            size: set.size,
            ratio: set.ratio,
            oil_volume: oils.filled()[0],
            has_level: oils.has_level(),
        };
        let part = build.part_again(&path, part);
        let common = Common::of(&set.oil, set.loss_factor);
        let model = match build.model_of::<PlanetaryDrag>(&path, &part, set.model.as_ref()) {
            Ok(model) => model,
            Err(error) => {
                found.push(error);
                continue;
            }
        };
        let Some(oil) = oils.oil(&path, &common) else { continue };
        let covers = if model.off { Covers::default() } else { model.covers() };
        held.push(Held {
            covered: (gears_of_set, format!("{path}.model"), covers),
            loss_factor: set.loss_factor,
            path,
            placed: Box::new(PlacedDrag {
                part,
                model,
                members: [reference, carrier, *first].map(|m| m as u16),
                spot: Spot {
                    oil,
                    level: oils.level(Some(carrier as u16), 0.0),
                    supply: None,
                },
            }),
        });
    }
    held
}

/// Checks whether a simple set can be assembled: adjacent planets must not touch, and the teeth must match equal spacing.
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
                            "adjacent planets touch: `{}` has a tip diameter of {:.3} mm, and their axes are {:.3} mm apart",
                            gear.id,
                            gear.diameters[1] * 1e3,
                            apart * 1e3
                        ),
                    )
                    .help("use fewer or smaller planets"),
                );
            }
            // For a single gear between a sun and a ring the condition is known; a stepped planet can be rotated to match.
            let seats: Vec<&MeshSeat> = meshes.iter().filter(|m| m.members.contains(&body)).collect();
            let [a, b] = seats[..] else { continue };
            let one_gear = a.gears.iter().any(|g| b.gears.contains(g));
            if one_gear && a.internal() != b.internal() {
                let central = |m: &MeshSeat| {
                    let side = usize::from(m.members[0] == body);
                    (members.planets[m.members[side]].is_none()).then(|| m.z()[side])
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
                        .help("change a number of teeth or of planets; losses are computed for equal spacing"),
                    );
                }
            }
        }
    }
}
