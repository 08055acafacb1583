//! The ratings of a transmission at its solved points.
//!
//! They are built apart from the transmission and evaluated after a point is solved, so that no loss and no time of a map depends on
//! them.

use std::cell::Cell;

use serde_json::Value;

use super::Solution;
use crate::attach::State;
use crate::document::Diagnostic;
use crate::language::Language;
use crate::loss::{Extent, Notebook, Seen, Trace, Undefined};
use crate::mechanism::Mechanism as _;
use crate::mechanism::bevel_mesh::BevelMesh;
use crate::mechanism::gear_mesh::GearMesh;
use crate::mechanism::worm_mesh::WormMesh;
use crate::rating::{Rated, RatingSlot};
use crate::registry::{Build, BuiltRating, Files, Instance, RatingPlugin};
use crate::resolve::{RATINGS, Resolved};
use crate::transmission::{MeshLaw, PartKind, Transmission};

/// The ratings of all components of a transmission.
pub struct Ratings {
    /// In the order of the parts.
    own: Vec<Own>,
    instances: Vec<Instance>,
    cells: usize,
}

/// One rating of one component.
struct Own {
    part: usize,
    plugin: RatingPlugin,
    /// Number of its instance.
    instance: usize,
    built: Kind,
}

enum Kind {
    Component(usize, BuiltRating),
    Mesh(usize, RatingSlot<GearMesh>),
    BevelMesh(usize, RatingSlot<BevelMesh>),
    WormMesh(usize, RatingSlot<WormMesh>),
}

/// A rating of a component at one point.
#[derive(Clone)]
pub struct ComponentRating {
    /// Number of the component among the parts of the transmission.
    pub part: usize,
    /// The registered rating.
    pub plugin: RatingPlugin,
    /// Its quantities, or why a formula is undefined.
    pub result: Result<Rated, Undefined>,
    /// Stated ranges of its formulas that the point leaves: number among `plugin.entry.limits` and the observed values.
    pub left: Vec<(usize, Extent)>,
}

impl Ratings {
    /// Builds the ratings that a resolved description chooses; without a choice all linked ones with their defaults.
    ///
    /// # Errors
    /// If one cannot be built.
    pub fn new(
        language: &Language,
        files: &Files,
        resolved: &Resolved,
        transmission: &Transmission,
    ) -> Result<Self, Vec<Diagnostic>> {
        let registry = language.registry();
        let mut build = Build::new(registry, files);
        let (mut own, mut found) = (Vec::new(), Vec::new());
        let mut instances = 0;
        let chosen = choices(language, resolved, &mut found);
        for (part, info) in transmission.parts.iter().enumerate() {
            for (plugin, value) in chosen.iter().filter(|(p, _)| p.entry.mechanism == info.mechanism) {
                let path = format!("{}.{RATINGS}.{}", info.path, plugin.entry.name);
                let built = match info.kind {
                    PartKind::Component(i) => transmission.components[i]
                        .placed
                        .build_rating(&path, &plugin.entry, value, &mut build)
                        .map(|built| built.map(|built| Kind::Component(i, built))),
                    PartKind::Mesh(i) if plugin.entry.mechanism == GearMesh::KEY => {
                        let MeshLaw::Cylindrical { part, .. } = &transmission.meshes[i].law else {
                            continue;
                        };
                        build
                            .rating::<GearMesh>(&path, part, &plugin.entry, value)
                            .map(|built| Some(Kind::Mesh(i, built)))
                    }
                    PartKind::Mesh(i) if plugin.entry.mechanism == BevelMesh::KEY => {
                        let MeshLaw::Bevel { part, .. } = &transmission.meshes[i].law else {
                            continue;
                        };
                        build
                            .rating::<BevelMesh>(&path, part, &plugin.entry, value)
                            .map(|built| Some(Kind::BevelMesh(i, built)))
                    }
                    PartKind::Mesh(i) if plugin.entry.mechanism == WormMesh::KEY => {
                        let MeshLaw::Worm { part, .. } = &transmission.meshes[i].law else {
                            continue;
                        };
                        build
                            .rating::<WormMesh>(&path, part, &plugin.entry, value)
                            .map(|built| Some(Kind::WormMesh(i, built)))
                    }
                    // Drags are rated with their gears.
                    PartKind::Mesh(_) | PartKind::Drag(_) | PartKind::Transfer(_) => continue,
                };
                match built {
                    Ok(None) => {}
                    Ok(Some(built)) => own.push(Own {
                        part,
                        plugin: *plugin,
                        instance: instances,
                        built,
                    }),
                    Err(error) => found.push(error),
                }
                instances = build.instances();
            }
        }
        if !found.is_empty() {
            return Err(found);
        }
        let (instances, cells) = build.finish();
        Ok(Self { own, instances, cells })
    }

    /// Keeps those that are wanted, by name of the rating and number of the component.
    pub fn retain(&mut self, is_wanted: impl Fn(&str, usize) -> bool) {
        self.own.retain(|own| is_wanted(own.plugin.entry.name, own.part));
    }

    /// Every rating and nested model that was built, with its path.
    pub fn instances(&self) -> &[Instance] {
        &self.instances
    }

    /// All ratings at a solved point, in the order of the parts; none without a power flow. A component on planets that carry
    /// different loads is rated at the most loaded planet.
    pub fn at(&self, solution: &Solution<'_>) -> Vec<ComponentRating> {
        self.rate(solution, None, None)
    }

    /// The ratings of one part, recording every step.
    pub fn explain(&self, solution: &Solution<'_>, part: usize) -> (Vec<ComponentRating>, Trace) {
        let trace = Trace::default();
        (self.rate(solution, Some(part), Some(&trace)), trace)
    }

    fn rate(&self, solution: &Solution<'_>, part: Option<usize>, trace: Option<&Trace>) -> Vec<ComponentRating> {
        if !solution.has_flow() {
            return Vec::new();
        }
        let cells = vec![Cell::new(Seen::NOTHING); self.cells];
        let book = Notebook {
            cells: &cells,
            trace,
            ..Notebook::CLOSED
        };
        let own = self.own.iter().filter(|own| part.is_none_or(|part| part == own.part));
        own.map(|own| {
            let result = solution.rated(&own.built, &book);
            let notes = self.instances[own.instance].notes;
            let seen = |i: usize| (i, cells[notes.limits() + i].get().extent());
            ComponentRating {
                part: own.part,
                plugin: own.plugin,
                result,
                left: (0..own.plugin.entry.limits.len())
                    .map(seen)
                    .filter(|(_, extent)| extent.outside > 0)
                    .collect(),
            }
        })
        .collect()
    }
}

/// The chosen ratings with their parameters.
fn choices(language: &Language, resolved: &Resolved, found: &mut Vec<Diagnostic>) -> Vec<(RatingPlugin, Value)> {
    let mut chosen = Vec::new();
    for plugin in language.registry().ratings() {
        let name = plugin.entry.name;
        let written = resolved.value.get(RATINGS).and_then(|all| all.get(name));
        match written.filter(|value| !value.is_null()) {
            Some(value) if value == "none" => {}
            Some(value) => chosen.push((*plugin, value.clone())),
            None => match language.default_rating(name) {
                Ok(value) => chosen.push((*plugin, value)),
                Err(more) => found.extend(more),
            },
        }
    }
    chosen
}

impl Solution<'_> {
    /// Evaluates a rating at this point.
    fn rated(&self, built: &Kind, book: &Notebook<'_>) -> Result<Rated, Undefined> {
        let (t, s) = (self.transmission, self.scratch);
        let state = self.state();
        match built {
            Kind::Component(i, rating) => {
                let component = &t.components[*i];
                let most = component.sharing.as_ref().and(s.models.uneven_loads.first());
                let state = State {
                    loads: most.map_or(state.loads, Vec::as_slice),
                    ..state
                };
                component.placed.rate(&**rating, &state, book)
            }
            Kind::Mesh(i, rating) => {
                let mean = s.models.forces[*i];
                let most = t.meshes[*i]
                    .sharing
                    .as_ref()
                    .map_or(mean, |sharing| sharing.force(0, mean));
                let MeshLaw::Cylindrical { part, .. } = &t.meshes[*i].law else {
                    return Ok(Rated::default());
                };
                let muted = t.mesh_at((*i, part), most, s.work.drives[*i], &state, &Notebook::CLOSED);
                rating.rate(&muted.with(|to| to.notes = book.notes(rating.notes)))
            }
            Kind::WormMesh(i, rating) => match self.worm_mesh_at(*i) {
                Some(muted) => rating.rate(&muted.with(|to| to.notes = book.notes(rating.notes))),
                None => Ok(Rated::default()),
            },
            Kind::BevelMesh(i, rating) => match self.bevel_mesh_at(*i) {
                Some(muted) => rating.rate(&muted.with(|to| to.notes = book.notes(rating.notes))),
                None => Ok(Rated::default()),
            },
        }
    }
}
