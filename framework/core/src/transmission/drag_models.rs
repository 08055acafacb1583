//! Building the drag models of gears and meshes; no cause of loss is counted twice.

use std::sync::Arc;

use super::drags::{Covered, DragSeat, body, body_of_gear, mates, named, part, twice};
use super::oils::OilNumbers;
use super::seats::{GearSeat, MeshSeat};
use super::{DragModel, PartInfo, PartKind};
use crate::attach::{Common, Level, Places};
use crate::codes;
use crate::description::GearboxEntry;
use crate::document::Diagnostic;
use crate::mechanism::gear_drag::{Covers, DragPart, GearDrag, Scope};
use crate::mechanism::{Mechanism, NamedSlots};
use crate::registry::{Build, Registry};

/// Drag models of gears and meshes while they are built one after the other.
pub(crate) struct Drags<'a, 'oils, 'build> {
    pub registry: &'a Registry,
    pub entry: &'a GearboxEntry,
    pub gears: &'a [GearSeat],
    pub meshes: &'a [MeshSeat],
    /// Oil height at each gear.
    pub levels: &'a [Level],
    /// What the models of planetary sets cover, then those built here.
    pub covered: Vec<Covered>,
    pub oils: &'a mut OilNumbers<'oils>,
    pub build: &'a mut Build<'build>,
    pub parts: &'a mut Vec<PartInfo>,
    pub models: Vec<DragModel>,
    pub found: &'a mut Vec<Diagnostic>,
}

/// A gear or a mesh with slots for drag models.
struct Place {
    scope: Scope,
    seat: DragSeat,
    part: Arc<DragPart>,
    common: Common,
    /// The number of the gear. A mesh has a number after those of the gears: its models may cover a gear in several meshes without
    /// counting it twice, because their losses belong to the mesh.
    number: usize,
}

impl Drags<'_, '_, '_> {
    /// Builds all models.
    pub fn built(mut self) -> Vec<DragModel> {
        for (i, gear) in self.gears.iter().enumerate() {
            let slots = self.entry.gears.0[i].1.drag.as_ref();
            if let Some(mesh) = self.meshes.iter().find(|m| m.gears.contains(&i)) {
                match self.on_gear(i, gear, mesh) {
                    Some(place) => self.add(slots, &place),
                    None => self.refuse(slots, &gear.id),
                }
            }
        }
        for (number, mesh) in self.meshes.iter().enumerate() {
            let id = mesh.path.strip_prefix("meshes.");
            if let Some(written) = id.and_then(|id| self.entry.meshes.get(id))
                && let Some(place) = self.on_mesh(number, mesh, (&written.common).into())
            {
                self.add(written.drag.as_ref(), &place);
            }
        }
        self.check_meshes_against_gears();
        self.models
    }

    /// Tip and reference radius of a gear. \[m\]
    fn radii(&self, gear: usize) -> [f64; 2] {
        let [reference, tip, _] = self.gears[gear].diameters;
        [0.5 * tip, 0.5 * reference]
    }

    /// Reports drag models of a gear on axes that cross.
    fn refuse(&mut self, slots: Option<&NamedSlots<GearDrag>>, gear: &str) {
        for (slot, choice) in slots.into_iter().flat_map(|slots| slots.0.iter()) {
            if choice.value != "none" {
                let message = format!("no drag law is available for `{gear}`, whose axis crosses that of its mate");
                self.found.push(
                    Diagnostic::error(format!("gears.{gear}.drag.{slot}"), message)
                        .help(format!("write `drag: {{ {slot}: none }}` at the gear")),
                );
            }
        }
    }

    /// A gear of a mesh; `None` of worms and crossed helical gears.
    fn on_gear(&mut self, i: usize, gear: &GearSeat, mesh: &MeshSeat) -> Option<Place> {
        let written = &self.entry.gears.0[i].1;
        let revolves = mesh.carrier.is_some_and(|c| c != gear.member) && is_planet(self.entry, &gear.id);
        let body = body_of_gear(gear, i, mesh)?;
        let path = ["gears.", &gear.id].concat();
        Some(Place {
            scope: Scope::Gear,
            part: (self.build).part_again(
                &path,
                part(self.entry, written.clearance, self.oils.filled(), body, None),
            ),
            seat: DragSeat {
                path,
                members: [gear.member, gear.member],
                gears: [i, i],
                pair: false,
                radii: [self.radii(i), self.radii(i)],
                levels: [self.levels[i], self.levels[i]],
                mates: [mates(i, self.meshes), Vec::new()],
                count: if revolves { mesh.count } else { 1.0 },
            },
            common: Common::of(&written.oil, written.loss_factor),
            number: i,
        })
    }

    fn on_mesh(&mut self, number: usize, mesh: &MeshSeat, common: Common) -> Option<Place> {
        let [a, b] = mesh.gears;
        let factor = |gear: usize| self.entry.gears.0[gear].1.loss_factor;
        let (first, mate) = (body(&self.gears[a], a, mesh)?, body(&self.gears[b], b, mesh)?);
        Some(Place {
            scope: Scope::Mesh,
            seat: DragSeat {
                path: mesh.path.clone(),
                members: mesh.members,
                gears: mesh.gears,
                pair: true,
                radii: [self.radii(a), self.radii(b)],
                levels: [self.levels[a], self.levels[b]],
                mates: [mates(a, self.meshes), mates(b, self.meshes)],
                count: mesh.count,
            },
            part: (self.build).part_again(
                &format!("{} drag", mesh.path),
                part(self.entry, None, self.oils.filled(), first, Some(mate)),
            ),
            common: Common {
                // Braking of both gears at the mesh is their drag, not the loss of the mesh.
                loss_factor: 0.5 * (factor(a) + factor(b)),
                ..common
            },
            number: self.gears.len() + number,
        })
    }

    /// Builds the models in the slots of a place.
    fn add(&mut self, slots: Option<&NamedSlots<GearDrag>>, place: &Place) {
        for (slot, choice) in slots.into_iter().flat_map(|s| s.0.iter()) {
            let path = [&place.seat.path, ".drag.", slot].concat();
            let value = &choice.value;
            let name = value.as_str().or_else(|| value["type"].as_str()).unwrap_or("none");
            if name == "none" {
                continue;
            }
            let model = self.registry.model(GearDrag::KEY, name);
            if !model.is_none_or(|e| e.scope == place.scope) {
                let (where_it_is, section) = if place.scope == Scope::Gear {
                    ("a gear", "meshes")
                } else {
                    ("a mesh", "gears")
                };
                self.found.push(
                    Diagnostic::error(path, format!("`{name}` is not a law for {where_it_is}"))
                        .help(format!("write it in `{section}` or in `models`")),
                );
                continue;
            }
            let model = match self.build.slot_at::<GearDrag>(&path, &place.part, value) {
                Ok(model) => model,
                Err(error) => {
                    self.found.push(error);
                    continue;
                }
            };
            if place.part.gear.pitch_angle != 0.0 && !model.off && !model.describes_bevel() {
                let message = format!("`{name}` takes the dimensions of a cylindrical gear, and this is a bevel gear");
                self.found
                    .push(Diagnostic::error(path, message).code(codes::BEVEL_DRAG).help(format!(
                        "choose a law that describes bevel gears, or write `drag: {{ {slot}: none }}` at the gear"
                    )));
                continue;
            }
            let covers = model.covers().unwrap_or_else(|| named(slot));
            let others = self
                .covered
                .iter()
                .filter(|(others, ..)| others.contains(&place.number));
            self.found
                .extend(others.filter_map(|(_, other, already)| doubled((&path, covers), (other, *already))));
            // If one model fills several slots of a gear, it is compared with itself only once.
            self.covered.push((vec![place.number], path.clone(), covers));
            let common = &place.common;
            let Some(oil) = self.oils.oil(&place.seat.path, common) else {
                continue;
            };
            self.parts.push(PartInfo {
                path: path.clone(),
                mechanism: GearDrag::KEY,
                kind: PartKind::Drag(self.models.len()),
                count: place.seat.count,
                loss_factor: common.loss_factor,
                notes: model.notes,
            });
            self.models.push(DragModel {
                loss_factor: common.loss_factor,
                seat: DragSeat {
                    path,
                    ..place.seat.clone()
                },
                part: Arc::clone(&place.part),
                supply: self.build.supply(&model),
                model,
                oil,
                churning: covers.churning,
            });
        }
    }

    /// Reports what a model of a mesh and one of its gears both compute.
    fn check_meshes_against_gears(&mut self) {
        let first = self.gears.len();
        let is_mesh = |(numbers, ..): &&Covered| numbers.first().is_some_and(|number| *number >= first);
        for (numbers, mesh_path, mesh_covers) in self.covered.iter().filter(is_mesh) {
            let mesh = &self.meshes[numbers[0] - first];
            let of_gears = self.covered.iter().filter(|covered| !is_mesh(covered));
            let of_gears = of_gears.filter(|(numbers, ..)| numbers.iter().any(|gear| mesh.gears.contains(gear)));
            self.found
                .extend(of_gears.filter_map(|(_, path, covers)| doubled((mesh_path, *mesh_covers), (path, *covers))));
        }
    }
}

/// The error at the first of two models if both compute the same loss.
fn doubled((path, covers): (&str, Covers), (other, already): (&str, Covers)) -> Option<Diagnostic> {
    let both = twice(covers, already);
    (!both.is_empty()).then(|| {
        Diagnostic::error(
            path,
            format!("{} is computed here and by `{other}`", both.join(" and ")),
        )
        .help("switch one of them off with `none`")
    })
}

fn is_planet(entry: &GearboxEntry, gear: &str) -> bool {
    entry.gears.get(gear).is_some_and(|g| {
        entry
            .planetary_sets
            .iter()
            .any(|(_, set)| set.planets.contains(&g.shaft))
    })
}
