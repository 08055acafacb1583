//! From the resolved description to the transmission; reports all errors of this stage at once.

use super::case::Cases;
use super::drag_models::Drags;
use super::drags::Covered;
use super::gearing::gearing;
use super::grease;
use super::lean::{self, Lean};
use super::materials;
use super::members::Members;
use super::nodes::{HeatPath, NodeNames, unmet};
use super::oil_network::{self, element_paths};
use super::oils::{OilNumbers, Oils};
use super::pairs::{BearingPair, Design};
use super::planet_sharing;
use super::planets::{self, Held};
use super::plausible;
use super::preloads::Preloading;
use super::seats::{GearSeat, MeshSeat, materials_of};
use super::states::{GearState, states};
use super::statics::{Imported, imported, load_factors, shaft_loads};
use super::transfers::{self, Transfer, TransferSeat};
use super::{
    Component, DragModel, MeshLaw, MeshModel, PartInfo, PartKind, Port, RatedSupport, Sharing, StiffnessAtLoad, Sump,
    Transmission, WHEEL_SPEEDS, WHEELS,
};
use crate::attach::{
    Common, Level, Names, Places, Seated, SeatedClearance, SeatedPocket, SeatedSupport, StatedStiffness, Stiffness,
    dangling,
};
use crate::codes;
use crate::description::{GearboxEntry, MeshMetal, NetworkChoice, OF_MODELS, SameModels, ThermalMode};
use crate::document::{Diagnostic, classify};
use crate::hydraulics::Hydraulics;
use crate::language::Language;
use crate::loads::ShaftLoads;
use crate::loss::{NoteBase, Term};
use crate::machine::{self, Contained, Machine};
use crate::mechanism::auxiliary::Auxiliary;
use crate::mechanism::bearing::Bearing;
use crate::mechanism::bevel_mesh::{BevelMesh, BevelPart};
use crate::mechanism::clutch::Clutch;
use crate::mechanism::crossed_helical_mesh::{CrossedHelicalMesh, CrossedHelicalPart};
use crate::mechanism::gear_mesh::{FlankSurfaces, GearMesh, MeshOil, MeshPart};
use crate::mechanism::planetary_drag::PlanetaryDrag;
use crate::mechanism::seal::Seal;
use crate::mechanism::worm_mesh::{Described, WormMesh, WormPart};
use crate::mechanism::{Component as _, Mechanism};
use crate::registry::{Build, Files, Instance, Memory};
use crate::resolve::{Resolved, ValueSource};
use crate::thermal::Housing;
use crate::thermal::network::{Around, Network};
use serde::Deserialize;
use serde_json::Value;
use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

impl Transmission {
    /// Builds the transmission of a resolved description.
    ///
    /// # Errors
    /// All faults, by path.
    pub fn new(language: &Language, files: &Files, resolved: &Resolved) -> Result<Self, Vec<Diagnostic>> {
        Self::again(language, files, resolved, Memory::default()).map(|(built, _)| built)
    }

    /// As [`Transmission::new`], after another build of the description whose changes the memory has; steps whose input is the same are
    /// not repeated. Without success there is no memory for the next build.
    ///
    /// # Errors
    /// All faults, by path.
    pub(crate) fn again(
        language: &Language,
        files: &Files,
        resolved: &Resolved,
        memory: Memory,
    ) -> Result<(Self, Memory), Vec<Diagnostic>> {
        let (built, memory) = Self::with_leans(language, files, resolved, memory, &[])?;
        let Some(entry) = memory.get::<GearboxEntry>(ENTRY).filter(|entry| lean::is_wanted(entry)) else {
            return Ok((built, memory));
        };
        // How shafts deflect is known when the forces of all meshes are.
        let leans = lean::leans(&built, entry, &resolved.value)?;
        Self::with_leans(language, files, resolved, memory, &leans)
    }

    /// The same with what the deflection of the shafts does to each mesh; empty: nothing.
    fn with_leans(
        language: &Language,
        files: &Files,
        resolved: &Resolved,
        mut memory: Memory,
        leans: &[Lean],
    ) -> Result<(Self, Memory), Vec<Diagnostic>> {
        let mut found = Vec::new();
        let mut warnings = Vec::new();
        let mut frame = Frame::new(language, resolved, &mut memory, &mut found, &mut warnings)?;
        frame.leans = leans.to_vec();
        let frame = frame;
        let (entry, members, ports) = (&frame.entry, &frame.members, &frame.ports);
        let mut oils = frame.oils(resolved, &mut memory);
        let mut build = Build::again(language.registry(), files, memory);
        build.oil_elements = Some(element_paths(entry));
        let models = Models::new(
            language,
            resolved,
            &frame,
            &mut oils,
            &mut build,
            &mut found,
            &mut warnings,
        );
        let hydraulics = models.hydraulics(&frame, resolved, &mut oils, &mut found, &mut warnings);
        let supports = &models.supports;
        let housing = Housing::new(entry, &mut build, &mut found);
        classify(&mut found, codes::THERMAL);
        let machines = models.machines(&frame, (&build, files), &mut found, &mut warnings);
        let around = Around {
            names: &frame.nodes,
            members: &members.names,
            gears: &frame.gears,
            meshes: frame.meshes.iter().map(|mesh| mesh.gears).collect(),
            lubricants: &oils.lubricants(),
            housing: housing.outside(),
            machines: &machines,
        };
        let mut network = Network::new(entry, &around, &mut build, &mut found);
        check_network(entry, resolved, &models.parts, &mut found, &mut warnings);
        classify(&mut found, codes::NETWORK);
        let mut memory = std::mem::take(&mut build.memory);
        let (states, cases) = models.states(&frame, &mut memory, &mut found);
        classify(&mut found, codes::POWER_FLOW);
        let designs = models.designs();
        let loads = models.shaft_loads(&frame, &designs, &mut memory, &mut found, &mut warnings);
        let load_factors = load_factors(supports, ports, &mut found);
        let imported = imported_loads(entry, files, ports, &states, supports, &mut found);
        let (oils, mut more) = oils.finish();
        let sound = loads.as_ref().filter(|_| found.is_empty() && more.is_empty());
        let of = (&models, &designs[..], &oils);
        let pairs = sound.map(|loads| pairs(loads, &frame, of, &mut found, &mut warnings));
        classify(&mut found, codes::SUPPORT);
        classify(&mut more, codes::LUBRICANT);
        // Errors of an oil cause many of the later ones.
        found.splice(0..0, more);
        let (Some(loads), Some(pairs), true) = (loads, pairs, found.is_empty()) else {
            return Err(found);
        };
        let (instances, cells) = build.finish();
        warnings.extend(instances.iter().flat_map(|instance| instance.doubts.iter().cloned()));
        let rated: Vec<RatedSupport> = models.components.iter().filter_map(rated).collect();
        let parts = in_document_order(resolved, models.parts, &mut memory);
        if let Some(network) = &mut network {
            warnings.extend(network.warnings());
            network.set_heat(heat_of(&parts, &models.meshes, &frame.nodes));
        }
        let built = Self {
            title: entry.title.clone().unwrap_or_default(),
            supports: supports.iter().map(|s| s.path.clone()).collect(),
            stiffnesses: stiffnesses(supports, &designs),
            locked_below: entry.locked_below,
            oil_temperature: entry.thermal.oil,
            thermal_mode: entry.thermal.mode,
            rating: entry.rating,
            members: frame.members.names,
            axes: frame.members.frames,
            ports: frame.ports,
            wheels: frame.wheels,
            states,
            cases,
            gears: frame.gears,
            meshes: models.meshes,
            drags: models.drags,
            transfers: models.transfers,
            components: models.components,
            limited: limited(&instances, &parts, (&rated, &pairs), (supports, cells), &mut memory),
            parts,
            instances,
            cells: cells + rated.len() + pairs.iter().map(BearingPair::cells).sum::<usize>(),
            rated,
            pairs,
            oils,
            hydraulics,
            loads,
            load_factors,
            imported,
            uneven: (frame.sharing.iter().flatten()).fold(0, |most, set| most.max(set.counts().len())),
            warnings,
            housing,
            machines,
            network,
        };
        built.check_states(&mut memory)?;
        memory.keep(ENTRY, frame.entry);
        memory.settle();
        Ok((built, memory))
    }
}

/// Opposed bearings that load each other; reports what is wrong with their preloads.
fn pairs(
    loads: &ShaftLoads,
    frame: &Frame,
    (models, designs, oils): (&Models, &[Design], &Oils),
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) -> Vec<BearingPair> {
    let preloading = Preloading {
        supports: &models.supports,
        designs,
        components: &models.components,
        nodes: &frame.nodes,
        oils,
        members: &frame.members.names,
    };
    let pairs = BearingPair::all(loads, &preloading, found);
    warnings.extend(pairs.iter().flat_map(|pair| pair.warnings(&preloading)));
    pairs
}

/// The parts in the order of the document, which other numbers do not change.
fn in_document_order(resolved: &Resolved, parts: Vec<PartInfo>, memory: &mut Memory) -> Vec<PartInfo> {
    let known = memory.get::<RanksOfParts>(RANKS);
    let known = known.filter(|(paths, _)| paths.iter().eq(parts.iter().map(|part| &part.path)));
    let ranks = known.map_or_else(|| ranks(resolved, &parts), |(_, ranks)| ranks.clone());
    if known.is_none() {
        let paths: Vec<String> = parts.iter().map(|part| part.path.clone()).collect();
        memory.keep(RANKS, (paths, ranks.clone()));
    }
    let mut ranked: Vec<((usize, usize), PartInfo)> = ranks.into_iter().zip(parts).collect();
    ranked.sort_by_key(|(rank, _)| *rank);
    ranked.into_iter().map(|(_, part)| part).collect()
}

/// Paths of the parts as built, and by what they are sorted.
type RanksOfParts = (Vec<String>, Vec<(usize, usize)>);

/// Key of the ranks of the parts in the memory of builds.
const RANKS: &str = "ranks of parts";

fn ranks(resolved: &Resolved, parts: &[PartInfo]) -> Vec<(usize, usize)> {
    let sections = resolved.value.as_object().into_iter().flatten();
    let places: Vec<HashMap<&str, usize>> = sections
        .clone()
        .map(|(_, section)| {
            let ids = section.as_object().into_iter().flat_map(|section| section.keys());
            ids.enumerate().map(|(place, id)| (id.as_str(), place)).collect()
        })
        .collect();
    let numbers: HashMap<&str, usize> = sections.enumerate().map(|(i, (name, _))| (name.as_str(), i)).collect();
    let rank = |part: &PartInfo| document_order(&numbers, &places, &part.path);
    parts.iter().map(rank).collect()
}

/// As [`Transmission::limited`], which follows from where the notes are; the cells of rated supports follow those of the models, and those of
/// pairs with springs these.
fn limited(
    instances: &[Instance],
    parts: &[PartInfo],
    (rated, pairs): (&[RatedSupport], &[BearingPair]),
    (supports, cells): (&[SeatedSupport], usize),
    memory: &mut Memory,
) -> Arc<[(usize, usize)]> {
    let rated = rated.iter().map(|rated| rated.support);
    let noted: Vec<usize> = rated.chain(pairs.iter().flat_map(BearingPair::noted)).collect();
    let of_instances: Vec<NoteBase> = instances.iter().map(|instance| instance.notes).collect();
    let of_parts: Vec<NoteBase> = parts.iter().map(|part| part.notes).collect();
    memory.repeat(
        "limited parts",
        (of_instances, of_parts, noted, cells),
        |(_, of_parts, noted, _)| {
            let mut list = Vec::new();
            for instance in instances {
                let first = instance.notes.limits();
                let users = of_parts.iter().enumerate();
                let users = users.filter(|(_, notes)| (notes.limits()..notes.end()).contains(&first));
                for (part, _) in users {
                    list.extend((first..first + instance.entry.limits.len()).map(|cell| (cell, part)));
                }
            }
            let places: HashMap<&str, usize> = parts.iter().map(|part| part.path.as_str()).zip(0..).collect();
            for (i, support) in noted.iter().enumerate() {
                let bearing = places.get(supports[*support].path.as_str());
                list.extend(bearing.map(|part| (cells + i, *part)));
            }
            list.into()
        },
    )
}

impl Transmission {
    /// Checks that every gear state determines its torques when its default ports state them, unless these states were checked before.
    fn check_states(&self, memory: &mut Memory) -> Result<(), Vec<Diagnostic>> {
        let checked = memory.get::<Arc<Vec<GearState>>>(CHECKED);
        if checked.is_some_and(|checked| Arc::ptr_eq(checked, &self.states)) {
            return Ok(());
        }
        memory.keep(CHECKED, Arc::clone(&self.states));
        let mut found = Vec::new();
        for (i, state) in self.states.iter().enumerate() {
            let mut order: Vec<&str> = self.ports.iter().map(|p| p.name.as_str()).collect();
            order.sort_by_key(|name| *name != self.ports[self.reference_port()].name);
            order.truncate(self.torques_needed(i));
            found.extend(self.case(&state.name, &[], &order).err().into_iter().flatten());
        }
        if found.is_empty() { Ok(()) } else { Err(found) }
    }
}

/// The description as read, and what carries its models: shafts, ports, gears and meshes.
struct Frame {
    entry: GearboxEntry,
    members: Members,
    ports: Vec<Port>,
    wheels: Vec<Port>,
    gears: Vec<GearSeat>,
    meshes: Vec<MeshSeat>,
    transfers: Vec<TransferSeat>,
    /// Unequal load sharing of each planet body.
    sharing: Vec<Option<Arc<Sharing>>>,
    nodes: NodeNames,
    /// What is described on each member beside gears.
    described: Vec<Described>,
    /// What the deflection of the shafts does to each mesh; empty: nothing.
    leans: Vec<Lean>,
}

impl Frame {
    /// The oils of the description.
    fn oils(&self, resolved: &Resolved, memory: &mut Memory) -> OilNumbers<'_> {
        OilNumbers::new(
            (&self.entry, &resolved.value),
            &self.members,
            (&self.gears, &self.meshes),
            &self.nodes,
            memory,
        )
    }

    fn new(
        language: &Language,
        resolved: &Resolved,
        memory: &mut Memory,
        found: &mut Vec<Diagnostic>,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self, Vec<Diagnostic>> {
        let entry = entry_again(language, &resolved.value, memory)
            .map_err(|e| vec![Diagnostic::error("", format!("the description cannot be read: {e}"))])?;
        let mut members = Members::new(&entry, found);
        let ports = ports(&entry, &members, found);
        let (ports, wheels) = joined(&entry, &members, ports, found);
        classify(found, codes::SHAFTS);
        let (gears, meshes) = gearing(language.registry(), &entry, &members, memory, found, warnings);
        let sharing = planet_sharing::sharing((&entry, &resolved.value), &members, (&gears, &meshes), found, warnings);
        for (planet, sharing) in members.planets.iter_mut().zip(&sharing) {
            if let Some(planet) = planet {
                planet.uneven = sharing.is_some();
            }
        }
        classify(found, codes::GEARING);
        warnings.extend(lean::without_effect(&entry, &resolved.value));
        let transfers = transfers::seats(&entry, &members, found, warnings);
        let nodes = NodeNames::new(&entry, found);
        classify(found, codes::NETWORK);
        let described = described(&resolved.value, &members);
        Ok(Self {
            entry,
            members,
            ports,
            wheels,
            gears,
            meshes,
            transfers,
            sharing,
            nodes,
            described,
            leans: Vec::new(),
        })
    }
}

/// Key of the description as read in the memory of builds.
const ENTRY: &str = "description";

/// Key of the gear states whose torques were checked.
const CHECKED: &str = "checked gear states";

/// The description as read: that of the last build, with the changed entries read again.
fn entry_again(language: &Language, document: &Value, memory: &mut Memory) -> Result<GearboxEntry, serde_json::Error> {
    let Some(mut entry) = memory.take::<GearboxEntry>(ENTRY) else {
        return GearboxEntry::deserialize(document);
    };
    for path in memory.changed() {
        let (section, id) = path.split_once('.').unwrap_or((path, ""));
        // The sections of components are read where they are placed.
        if !language.registry().sections().any(|(_, known)| known.name == section) {
            let is_same = |key: &&str| memory.is_same_value(&[path, ".", key].concat());
            let same = SameModels(OF_MODELS.iter().all(is_same));
            entry.read_again(document, (section, id), same)?;
        }
    }
    Ok(entry)
}

/// The models on a frame, and the parts of the loss that they compute.
struct Models {
    components: Vec<Component>,
    meshes: Vec<MeshModel>,
    drags: Vec<DragModel>,
    transfers: Vec<Transfer>,
    parts: Vec<PartInfo>,
    supports: Vec<SeatedSupport>,
    clearances: Vec<SeatedClearance>,
    pockets: Vec<SeatedPocket>,
}

impl Models {
    /// The gear states with their cases.
    fn states(
        &self,
        frame: &Frame,
        memory: &mut Memory,
        found: &mut Vec<Diagnostic>,
    ) -> (Arc<Vec<GearState>>, Arc<Cases>) {
        states(
            &frame.entry,
            &frame.members,
            (&frame.meshes, &frame.transfers),
            &self.clearances,
            (&frame.ports, &frame.wheels),
            memory,
            found,
        )
    }

    /// The design of each support.
    fn designs(&self) -> Vec<Design> {
        let mut designs = vec![Design::default(); self.supports.len()];
        let has_preload = self.supports.iter().any(|support| support.place.preload.is_some());
        for placed in self.components.iter().map(|component| &component.placed) {
            if let Some(support) = placed.support() {
                let place = &self.supports[usize::from(support)].place;
                let stiffness = Stiffness::ALL.map(|stiffness| match place.stated(stiffness)? {
                    StatedStiffness::Constant(_) => None,
                    StatedStiffness::At(load) => Some(placed.stiffness(stiffness, load).map_err(Cow::into_owned)),
                });
                designs[usize::from(support)] = Design {
                    stiffness,
                    name: placed.name(),
                    carries: placed.carries(),
                    induced: placed.induced(),
                    row: has_preload.then(|| placed.angular_row().map_err(Cow::into_owned)),
                };
            }
        }
        designs
    }

    /// The oil network; empty without one.
    fn hydraulics(
        &self,
        frame: &Frame,
        resolved: &Resolved,
        oils: &mut OilNumbers<'_>,
        found: &mut Vec<Diagnostic>,
        warnings: &mut Vec<Diagnostic>,
    ) -> Hydraulics {
        let around = oil_network::Around {
            entry: &frame.entry,
            document: &resolved.value,
            members: &frame.members.names,
            parts: &self.parts,
            components: &self.components,
            pockets: &self.pockets,
            gears: &frame.gears,
        };
        let built = oil_network::hydraulics(&around, oils, found, warnings);
        classify(found, codes::OIL_NETWORK);
        built
    }

    /// Loads of the supports; `None` if they cannot be found.
    fn shaft_loads(
        &self,
        frame: &Frame,
        designs: &[Design],
        memory: &mut Memory,
        found: &mut Vec<Diagnostic>,
        warnings: &mut Vec<Diagnostic>,
    ) -> Option<Arc<ShaftLoads>> {
        let supports = (&self.supports[..], designs);
        shaft_loads(
            &frame.entry,
            &frame.members,
            (&frame.meshes, &frame.transfers, &frame.leans),
            supports,
            memory,
            found,
            warnings,
        )
    }

    fn new(
        language: &Language,
        resolved: &Resolved,
        frame: &Frame,
        oils: &mut OilNumbers<'_>,
        build: &mut Build<'_>,
        found: &mut Vec<Diagnostic>,
        warnings: &mut Vec<Diagnostic>,
    ) -> Self {
        let (entry, gears, meshes) = (&frame.entry, &frame.gears[..], &frame.meshes[..]);
        let mut models = place(language, resolved, frame, oils, build, found);
        classify(found, codes::COMPONENT);
        models.meshes = mesh_models(frame, oils, build, &mut models.parts, found);
        give_bodies(&mut models.meshes, gears, &frame.nodes, warnings);
        let seats = frame.transfers.clone();
        models.transfers = transfers::models(entry, seats, oils, build, &mut models.parts, found);
        for locking in transfers::locking(entry, &frame.members, oils, build, found) {
            place_locking(locking, &mut models.components, &mut models.parts);
        }
        let held = planets::models(entry, &frame.members, gears, meshes, oils, build, found);
        let covered = place_sets(held, &mut models.components, &mut models.parts);
        classify(found, codes::MODEL);
        let levels = levels(entry, gears, oils);
        found.extend(grease::faults(&resolved.value, entry));
        warnings.extend(grease::doubts(&resolved.value, entry, &frame.members, gears, oils));
        warnings.extend(plausible::oil_level(entry, gears, &levels, oils));
        warnings.extend(covered_seals(resolved, &frame.members, oils));
        for (id, oil) in oils.named() {
            warnings.extend(plausible::viscosities(id, oil, &entry.plausibility));
        }
        build.drawn_space = oils.inside.as_ref().is_some_and(|inside| inside.drawn);
        let drags = Drags {
            registry: language.registry(),
            entry,
            gears,
            meshes,
            levels: &levels,
            covered,
            oils,
            build,
            parts: &mut models.parts,
            models: Vec::new(),
            found,
        };
        models.drags = drags.built();
        classify(found, codes::DRAG);
        if entry.housing.travel.is_some() {
            found.extend(no_travel(entry, oils));
        }
        let highest = if entry.housing.travel.is_some() {
            f64::INFINITY
        } else {
            oils.highest_at_rest()
        };
        let reads = models
            .components
            .iter()
            .any(|component| component.placed.reads_level(highest));
        let mut pipes = entry.oil_network.iter().flat_map(|network| network.pipes.iter());
        let reads = reads || pipes.any(|(_, pipe)| pipe.inlet_height.is_some());
        let catches = models
            .pockets
            .iter()
            .any(|pocket| pocket.entry.window.is_some() || pocket.entry.rib.is_some_and(|rib| rib.wetting.is_none()));
        if let (Some(inside), Some(rest)) = (oils.inside.clone(), oils.rest())
            && let Some(oil) = oils.oil("housing.oil", &Common::default())
        {
            oils.sump = Some(Sump::new(
                &inside,
                rest,
                oil.into(),
                reads || catches,
                (gears, &levels),
                &models.drags,
            ));
        }
        if catches && !oils.sump.as_ref().is_some_and(Sump::has_lifts) {
            found.extend(no_wetting(&models.pockets));
        }
        warnings.append(&mut oils.warnings);
        planets::assembly(entry, &frame.members, gears, meshes, warnings);
        models
    }
}

impl Models {
    /// The electric machines at the ports, with the motors of the thermal network.
    fn machines(
        &self,
        frame: &Frame,
        (build, files): (&Build<'_>, &Files),
        found: &mut Vec<Diagnostic>,
        warnings: &mut Vec<Diagnostic>,
    ) -> Vec<Arc<Machine>> {
        let counted = self.of_rotors(frame, build);
        let around = machine::Around {
            names: &frame.nodes,
            ports: &frame.ports,
            shafts: &frame.entry.ports,
            files,
            counted: &counted,
        };
        let mut machines = machine::machines(&frame.entry, around, found, warnings);
        classify(found, codes::MACHINE);
        machines.extend(machine::motors(&frame.entry, around, &machines, found));
        machines
    }

    /// Bearings and windage of shafts with a loss, which a loss map of a machine may contain: shaft, path and what it is.
    fn of_rotors(&self, frame: &Frame, build: &Build<'_>) -> Vec<(String, String, Contained)> {
        // Windage of a rotor or a shaft has terms of its surfaces.
        let of_surfaces = |term: &Term| ["gap", "faces", "cylinders", "shoulders"].contains(&term.name);
        let of_rotor = |part: &PartInfo| {
            let PartKind::Component(number) = part.kind else {
                return None;
            };
            let component = self.components.get(number).filter(|component| !component.off)?;
            let what = match part.mechanism {
                Bearing::KEY => Contained::Bearings,
                Auxiliary::KEY if build.terms_of(part.notes).iter().any(of_surfaces) => Contained::Windage,
                _ => return None,
            };
            let member = component.between.iter().flatten().next()?;
            let shaft = frame.members.names.get(usize::from(*member))?;
            Some((shaft.clone(), part.path.clone(), what))
        };
        self.parts.iter().filter_map(of_rotor).collect()
    }
}

/// Adds the drags of planetary sets to the components; returns what they cover.
fn place_sets(held: Vec<Held>, components: &mut Vec<Component>, parts: &mut Vec<PartInfo>) -> Vec<Covered> {
    let mut covered = Vec::new();
    for model in held {
        parts.push(PartInfo {
            path: model.path,
            mechanism: PlanetaryDrag::KEY,
            kind: PartKind::Component(components.len()),
            count: 1.0,
            loss_factor: model.loss_factor,
            notes: model.placed.notes(),
        });
        components.push(Component::new(model.placed, model.loss_factor, None));
        covered.push(model.covered);
    }
    covered
}

/// Adds the friction between the sides of a differential to the components.
fn place_locking(locking: transfers::Locking, components: &mut Vec<Component>, parts: &mut Vec<PartInfo>) {
    parts.push(PartInfo {
        path: locking.path,
        mechanism: Clutch::KEY,
        kind: PartKind::Component(components.len()),
        count: 1.0,
        loss_factor: locking.loss_factor,
        notes: locking.placed.notes(),
    });
    components.push(Component::new(locking.placed, locking.loss_factor, None));
}

/// Where the heat of each part enters the network.
fn heat_of(parts: &[PartInfo], meshes: &[MeshModel], nodes: &NodeNames) -> Vec<HeatPath> {
    let of_gears = |part: &PartInfo| match part.kind {
        PartKind::Mesh(i) => meshes[i].bodies.map(HeatPath::Gears),
        _ => None,
    };
    let heat = |part: &PartInfo| of_gears(part).unwrap_or_else(|| nodes.heat(&part.path));
    parts.iter().map(heat).collect()
}

/// Gives meshes the thermal nodes of their gears; warns where only one gear of a mesh has one.
fn give_bodies(models: &mut [MeshModel], gears: &[GearSeat], nodes: &NodeNames, warnings: &mut Vec<Diagnostic>) {
    for mesh in models {
        let gears = mesh.seat.gears.map(|g| gears[g].id.as_str());
        mesh.bodies = nodes.bodies(&mesh.seat.path, gears);
        let known = gears.map(|gear| nodes.of_gear(gear).is_some());
        if let Some(i) = known.iter().position(|known| *known).filter(|_| known[0] != known[1]) {
            let message = format!(
                "`{}` has a thermal node and `{}` has none, so neither is used",
                gears[i],
                gears[1 - i]
            );
            warnings.push(
                Diagnostic::warning(mesh.seat.path.clone(), message)
                    .help("name both gears under `gears` of a node, or the mesh under `parts`"),
            );
        }
    }
}

/// Checks that a network which balances the temperatures is stated and heated by parts that exist.
fn check_network(
    entry: &GearboxEntry,
    resolved: &Resolved,
    parts: &[PartInfo],
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) {
    let laid_out = *resolved.source_of("thermal.network") == ValueSource::Network;
    let balances = entry.thermal.mode == ThermalMode::Network;
    if let Some(NetworkChoice::Written(written)) = &entry.thermal.network {
        let elements = element_paths(entry);
        let parts = parts.iter().map(|p| p.path.as_str());
        let paths: Vec<&str> = parts.chain(elements.iter().map(String::as_str)).collect();
        unmet(written, &paths, found);
        if balances {
            unused(entry, laid_out, found, warnings);
        }
    } else if balances {
        found.push(
            Diagnostic::error("thermal.mode", "the network is missing")
                .help("add `network: auto` under `thermal`, or nodes and links"),
        );
    }
}

/// The bearing loads of the file that `imported_loads` names.
fn imported_loads(
    entry: &GearboxEntry,
    files: &Files,
    ports: &[Port],
    states: &[GearState],
    supports: &[SeatedSupport],
    found: &mut Vec<Diagnostic>,
) -> Option<Imported> {
    let import = entry.imported_loads.as_ref()?;
    let names: Vec<String> = states.iter().map(|s| s.name.clone()).collect();
    let port = ports.iter().position(|p| p.name == import.port);
    if port.is_none() {
        let known: Vec<&str> = ports.iter().map(|p| p.name.as_str()).collect();
        found.push(dangling("imported_loads.port", "port", &import.port, &known));
    }
    files
        .text(&import.file)
        .map_err(|reason| Diagnostic::error("imported_loads.file", reason))
        .and_then(|text| imported(&text, &import.file, port.unwrap_or(0), &names, supports))
        .map_err(|error| found.push(error))
        .ok()
}

/// The support of a component, if its static load rating is known.
fn rated(component: &Component) -> Option<RatedSupport> {
    Some(RatedSupport {
        support: usize::from(component.support?),
        rating: component.placed.static_rating()?,
        uneven: component.sharing.is_some(),
    })
}

/// Warns about settings that a balance of the oil uses, but a network does not.
fn unused(entry: &GearboxEntry, laid_out: bool, found: &mut Vec<Diagnostic>, warnings: &mut Vec<Diagnostic>) {
    let thermal = &entry.thermal;
    if !laid_out && !thermal.sources.is_empty() {
        found.push(
            Diagnostic::error("thermal.sources", "a network does not use these heat sources")
                .help("write them under `thermal.network.sources`, with the node that they heat"),
        );
    }
    if thermal.oil_to_surface != 0.0 {
        warnings.push(
            Diagnostic::warning("thermal.oil_to_surface", "a network uses links instead")
                .help("link the oil to the casing, and remove it"),
        );
    }
    if thermal.heat_dissipation.as_ref().is_some_and(|ways| !ways.0.is_empty()) {
        warnings.push(
            Diagnostic::warning("thermal.heat_dissipation", "a network uses links instead")
                .help("link the casing to `ambient`, for example with `casing_air`, and remove it"),
        );
    }
}

/// Sections in the usual order: gears, bearings, then the others as written.
fn document_order(numbers: &HashMap<&str, usize>, places: &[HashMap<&str, usize>], path: &str) -> (usize, usize) {
    let section = path.split('.').next().unwrap_or_default();
    let id = path.split('.').nth(1).unwrap_or_default();
    let number = numbers.get(section);
    let rank = match section {
        "meshes" | "bevel_meshes" | "worm_meshes" | "crossed_helical_meshes" => 0,
        "gears" => 1,
        "planetary_sets" => 2,
        "bearings" => 3,
        _ => 4 + number.copied().unwrap_or(0),
    };
    let place = number.and_then(|number| places[*number].get(id));
    (rank, place.copied().unwrap_or(0))
}

fn ports(entry: &GearboxEntry, members: &Members, found: &mut Vec<Diagnostic>) -> Vec<Port> {
    let ids: Vec<&str> = members.names.iter().map(String::as_str).collect();
    let mut ports: Vec<Port> = Vec::new();
    for (name, shaft) in entry.ports.iter() {
        let path = format!("ports.{name}");
        match ids.iter().position(|m| m == shaft) {
            None => found.push(dangling(&path, "shaft", shaft, &ids)),
            Some(member) if ports.iter().any(|p| p.member == member) => {
                found
                    .push(Diagnostic::error(path, format!("`{shaft}` is already a port")).help("name each shaft once"));
            }
            Some(member) => ports.push(Port {
                name: name.to_owned(),
                member,
            }),
        }
    }
    if entry.shafts.is_empty() {
        found.push(
            Diagnostic::error("shafts", "shafts are missing").help("add `shafts:`, or `extends:` with a base file"),
        );
    }
    if entry.ports.is_empty() {
        found.push(
            Diagnostic::error("ports", "ports are missing")
                .help("add `ports: { input: SHAFT, output: SHAFT }`, or `extends:` with a base file"),
        );
    }
    ports
}

/// The ports, with those of `wheels` as one port at the end, and those of `wheels` themselves.
fn joined(
    entry: &GearboxEntry,
    members: &Members,
    ports: Vec<Port>,
    found: &mut Vec<Diagnostic>,
) -> (Vec<Port>, Vec<Port>) {
    if let Some(speeds) = &entry.wheel_speeds {
        found.extend(faults_of_speeds(entry.wheels.as_deref(), speeds));
    }
    let Some(names) = &entry.wheels else {
        return (ports, Vec::new());
    };
    let known: Vec<&str> = entry.ports.ids().collect();
    for (i, name) in names.iter().enumerate() {
        let path = format!("wheels.{i}");
        if !known.contains(&name.as_str()) {
            found.push(dangling(&path, "port", name, &known));
        } else if names[..i].contains(name) {
            found.push(Diagnostic::error(path, format!("`{name}` is named twice")).help("name each port once"));
        }
    }
    if known.contains(&WHEELS) && !names.iter().any(|name| name == WHEELS) {
        let message = format!("the ports of `wheels` become one port of that name, and there is one called `{WHEELS}`");
        found.push(Diagnostic::error(format!("ports.{WHEELS}"), message).help("rename the port"));
    }
    let (wheels, mut ports): (Vec<Port>, Vec<Port>) = ports.into_iter().partition(|port| names.contains(&port.name));
    ports.push(Port {
        name: WHEELS.to_owned(),
        // The column after those of the members: the axle, which is not a shaft of the gearbox.
        member: members.names.len(),
    });
    (ports, wheels)
}

/// What is wrong with the speeds of the ports of `wheels`.
fn faults_of_speeds(wheels: Option<&[String]>, speeds: &[f64]) -> Option<Diagnostic> {
    let fault = match wheels {
        None => Diagnostic::error(WHEEL_SPEEDS, "`wheels` is missing, so these are the speeds of no ports").help(
            "add `wheels: [left, right]` with the ports of the wheels; or state `speed_difference` of a differential",
        ),
        Some(wheels) if wheels.len() != speeds.len() => Diagnostic::error(
            WHEEL_SPEEDS,
            format!("{} speeds for {} ports of `wheels`", speeds.len(), wheels.len()),
        )
        .help("write one number for each port, in the order of `wheels`"),
        Some(_) if speeds.iter().all(|speed| *speed == 0.0) => Diagnostic::error(WHEEL_SPEEDS, "no wheel turns")
            .help("write speeds over the common speed, such as `[1.05, 0.95]`"),
        Some(_) => return None,
    };
    Some(fault.code(codes::DIFFERENTIAL))
}

/// Places the components of all sections.
fn place(
    language: &Language,
    resolved: &Resolved,
    frame: &Frame,
    oils: &mut OilNumbers<'_>,
    build: &mut Build<'_>,
    found: &mut Vec<Diagnostic>,
) -> Models {
    let members = &frame.members;
    let by_name: Vec<(String, Option<u16>)> = members
        .names
        .iter()
        .enumerate()
        .map(|(i, name)| (name.clone(), Some(i as u16)))
        .collect();
    let mut names = Names::new(&by_name, oils);
    let mut components = Vec::new();
    let mut parts = Vec::new();
    for (mechanism, section) in language.registry().sections() {
        let entries = resolved.value.get(section.name).and_then(|s| s.as_object());
        for (id, value) in entries.into_iter().flatten() {
            names.turn_to(section.name, id);
            match (section.place)(value, &mut names, build) {
                Ok(Some(placed)) => {
                    let copies = |m: Option<u16>| m.and_then(|m| members.planets[m as usize]).map(|p| p.count);
                    let planets = placed.between().into_iter().find_map(copies).unwrap_or(1.0);
                    let common = value.get("count").and_then(serde_json::Value::as_f64).unwrap_or(1.0);
                    let count = planets * common;
                    let factor = value.get("loss_factor").and_then(serde_json::Value::as_f64);
                    let loss_factor = factor.unwrap_or(1.0);
                    parts.push(PartInfo {
                        path: names.path().to_owned(),
                        mechanism: mechanism.key,
                        kind: PartKind::Component(components.len()),
                        count,
                        loss_factor,
                        notes: placed.notes(),
                    });
                    let sharing = placed
                        .between()
                        .into_iter()
                        .flatten()
                        .find_map(|m| frame.sharing[m as usize].clone());
                    components.push(Component::new(placed, count * loss_factor, sharing));
                }
                Ok(None) => {}
                Err(error) => found.push(error),
            }
        }
    }
    let (seated, more) = names.finish();
    let Seated {
        supports,
        clearances,
        pockets,
    } = seated;
    found.extend(more);
    Models {
        components,
        meshes: Vec::new(),
        drags: Vec::new(),
        transfers: Vec::new(),
        parts,
        supports,
        clearances,
        pockets,
    }
}

fn mesh_models(
    frame: &Frame,
    oils: &mut OilNumbers<'_>,
    build: &mut Build<'_>,
    parts: &mut Vec<PartInfo>,
    found: &mut Vec<Diagnostic>,
) -> Vec<MeshModel> {
    let mut models = Vec::new();
    for (i, seat) in frame.meshes.iter().enumerate() {
        let Some(teeth) = seat.cylindrical() else {
            match crossed_model(i, seat, frame, oils, build, parts) {
                Ok(model) => models.extend(model),
                Err(error) => found.push(error),
            }
            continue;
        };
        let id = seat.path.strip_prefix("meshes.");
        let Some(written) = id.and_then(|id| frame.entry.meshes.get(id)) else {
            continue;
        };
        let common = Common::from(&written.common);
        let oil = oils.oil(&seat.path, &common);
        let part = MeshPart::of_surfaces(teeth.pair, surfaces(seat, frame, written.metal));
        let gears = [0, 1].map(|i| frame.entry.gears.get(&written.gears[i]));
        let flanks = gears.map(|gear| gear.and_then(|gear| gear.modification).unwrap_or_default());
        let lean = frame.leans.get(i).copied().unwrap_or_default();
        let part = part.with_flanks(flanks, written.misalignment);
        let part = part.leaning(lean.constant, lean.per_line_load);
        let part = part.with_bores(gears.map(|gear| gear.and_then(|gear| gear.bore)));
        let part = build.part_again(&seat.path, part.with_oil(oil.and_then(|oil| oils.lubricant(oil))));
        match build.model_of(&seat.path, &part, written.model.as_ref()) {
            Ok(model) => {
                parts.push(PartInfo {
                    path: seat.path.clone(),
                    mechanism: GearMesh::KEY,
                    kind: PartKind::Mesh(i),
                    count: seat.count,
                    loss_factor: common.loss_factor,
                    notes: model.notes,
                });
                models.push(MeshModel {
                    bodies: None,
                    loss_factor: common.loss_factor,
                    sharing: planet_sharing::of_mesh(i, seat, &frame.sharing),
                    force_per_multiplier: force_per_multiplier(seat),
                    seat: seat.clone(),
                    law: MeshLaw::Cylindrical { part, model },
                    oil: oil.unwrap_or(0),
                    greased: frame.entry.is_greased(common.lubricant.as_deref()),
                });
            }
            Err(error) => found.push(error),
        }
    }
    models
}

/// Tangential force of one copy of a mesh per multiplier of its row. \[1/m\]
fn force_per_multiplier(seat: &MeshSeat) -> f64 {
    f64::from(seat.z()[0]) / (seat.count * seat.radius())
}

/// What the entry of a mesh on axes that cross states as all meshes do.
fn crossed_common(entry: &GearboxEntry, path: &str) -> Option<Common> {
    let (section, id) = path.split_once('.')?;
    let common = match section {
        "bevel_meshes" => &entry.bevel_meshes.get(id)?.common,
        "worm_meshes" => &entry.worm_meshes.get(id)?.common,
        _ => &entry.crossed_helical_meshes.get(id)?.common,
    };
    Some(common.into())
}

/// The law of a mesh with the key of its mechanism.
type KeyedLaw = (&'static str, MeshLaw);

/// A mesh of gears on axes that cross, with its number.
fn crossed_model(
    number: usize,
    seat: &MeshSeat,
    frame: &Frame,
    oils: &mut OilNumbers<'_>,
    build: &mut Build<'_>,
    parts: &mut Vec<PartInfo>,
) -> Result<Option<MeshModel>, Diagnostic> {
    let entry = &frame.entry;
    let Some(common) = crossed_common(entry, &seat.path) else {
        return Ok(None);
    };
    let Some(oil) = oils.oil(&seat.path, &common) else {
        return Ok(None);
    };
    let of_mesh = oils.lubricant(oil);
    let mut law = bevel_law(seat, frame, of_mesh.clone(), build)?;
    if law.is_none() {
        law = worm_law(seat, frame, of_mesh.clone(), build)?;
    }
    if law.is_none() {
        law = crossed_helical_law(seat, frame, of_mesh, build)?;
    }
    let Some((mechanism, law)) = law else {
        return Ok(None);
    };
    parts.push(PartInfo {
        path: seat.path.clone(),
        mechanism,
        kind: PartKind::Mesh(number),
        count: seat.count,
        loss_factor: common.loss_factor,
        notes: law.notes(),
    });
    Ok(Some(MeshModel {
        bodies: None,
        loss_factor: common.loss_factor,
        sharing: None,
        force_per_multiplier: force_per_multiplier(seat),
        seat: seat.clone(),
        law,
        oil,
        greased: entry.is_greased(common.lubricant.as_deref()),
    }))
}

/// Part and model of a bevel mesh; none of another mesh.
fn bevel_law(
    seat: &MeshSeat,
    frame: &Frame,
    oil: Option<MeshOil>,
    build: &mut Build<'_>,
) -> Result<Option<KeyedLaw>, Diagnostic> {
    let id = seat.path.strip_prefix("bevel_meshes.");
    let written = id.and_then(|id| frame.entry.bevel_meshes.get(id));
    let pair = seat.crossed().and_then(|teeth| teeth.bevel_pair());
    let (Some(written), Some(pair)) = (written, pair) else {
        return Ok(None);
    };
    let part = BevelPart::new(pair, surfaces(seat, frame, written.metal), oil.as_ref());
    let part = build.part_again(&seat.path, part);
    let model = build.model_of(&seat.path, &part, written.model.as_ref())?;
    Ok(Some((BevelMesh::KEY, MeshLaw::Bevel { part, model })))
}

/// Part and model of a worm drive; none of another mesh.
fn worm_law(
    seat: &MeshSeat,
    frame: &Frame,
    oil: Option<MeshOil>,
    build: &mut Build<'_>,
) -> Result<Option<KeyedLaw>, Diagnostic> {
    let entry = &frame.entry;
    let id = seat.path.strip_prefix("worm_meshes.");
    let written = id.and_then(|id| entry.worm_meshes.get(id));
    let pair = seat.crossed().and_then(|teeth| teeth.worm);
    let (Some(written), Some(pair)) = (written, pair) else {
        return Ok(None);
    };
    let oil = oil.and_then(|oil| entry.lubricants.get(&oil.id));
    let part = WormPart {
        pair,
        material: materials::worm_wheel(entry, written),
        ra: seat.ra[0],
        lubrication: written.lubrication,
        oil: oil.and_then(|oil| oil.kind).unwrap_or_default(),
        described: frame.described[seat.members[0]].with(frame.described[seat.members[1]]),
    };
    let part = build.part_again(&seat.path, part);
    let model = build.model_of(&seat.path, &part, written.model.as_ref())?;
    Ok(Some((WormMesh::KEY, MeshLaw::Worm { part, model })))
}

/// The surfaces of a mesh.
fn surfaces(seat: &MeshSeat, frame: &Frame, metal: MeshMetal) -> FlankSurfaces {
    FlankSurfaces {
        ra: seat.ra,
        rq: seat.rq,
        materials: materials_of(&frame.gears, seat.gears, metal),
    }
}

/// Part and model of a crossed helical mesh; none of another mesh.
fn crossed_helical_law(
    seat: &MeshSeat,
    frame: &Frame,
    oil: Option<MeshOil>,
    build: &mut Build<'_>,
) -> Result<Option<KeyedLaw>, Diagnostic> {
    let id = seat.path.strip_prefix("crossed_helical_meshes.");
    let written = id.and_then(|id| frame.entry.crossed_helical_meshes.get(id));
    let (Some(written), Some(teeth)) = (written, seat.crossed()) else {
        return Ok(None);
    };
    let tips = seat.gears.map(|gear| 0.5 * frame.gears[gear].diameters[1]);
    let surfaces = surfaces(seat, frame, written.metal);
    let part = CrossedHelicalPart::new(&teeth.cones, (written.pressure_angle, tips), surfaces);
    let mut part = part.map_err(|faults| {
        let message = faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
        Diagnostic::error(&seat.path, message)
            .code(codes::CROSSED)
            .help("check tip diameters, module and helix angles")
    })?;
    part.flanks = part.flanks.with_oil(oil);
    let part = build.part_again(&seat.path, part);
    let model = build.model_of(&seat.path, &part, written.model.as_ref())?;
    Ok(Some((CrossedHelicalMesh::KEY, MeshLaw::CrossedHelical { part, model })))
}

/// What the sections of a resolved document describe on each member beside gears.
fn described(resolved: &Value, members: &Members) -> Vec<Described> {
    let shafts = |section: &str| -> Vec<&str> {
        let entries = resolved.get(section).and_then(Value::as_object).into_iter().flatten();
        entries.filter_map(|(_, own)| own["shaft"].as_str()).collect()
    };
    let [bearings, seals] = [Bearing::SECTION, Seal::SECTION].map(shafts);
    let described = |shaft: &String| Described {
        bearings: bearings.contains(&shaft.as_str()),
        seals: seals.contains(&shaft.as_str()),
    };
    members.names.iter().map(described).collect()
}

/// Each stiffness that follows from a load.
fn stiffnesses(supports: &[SeatedSupport], designs: &[Design]) -> Vec<StiffnessAtLoad> {
    let each = supports.iter().zip(designs).enumerate();
    each.flat_map(|(support, (seated, design))| {
        Stiffness::ALL.into_iter().filter_map(move |stiffness| {
            let StatedStiffness::At(load) = seated.place.stated(stiffness)? else {
                return None;
            };
            let value = *design.stiffness(stiffness)?.as_ref().ok()?;
            Some(StiffnessAtLoad {
                support,
                stiffness,
                load,
                value,
            })
        })
    })
    .collect()
}

/// What prevents a cycle from inclining the oil.
fn no_travel(entry: &GearboxEntry, oils: &OilNumbers<'_>) -> Option<Diagnostic> {
    let (message, help) = match &entry.housing.oil {
        None => (
            "the housing has no oil that a cycle could incline",
            "state `housing.oil`, or delete `travel`",
        ),
        Some(oil) if oil.dry_sump => ("a dry sump has no level that a cycle could incline", "delete `travel`"),
        Some(_) if oils.inside.is_none() => (
            "the level at an inclination follows from the volume, and the oil space is not known",
            "state `housing.inside.sections` from the drawing, or delete `travel`",
        ),
        Some(_) if oils.rest().is_none() => (
            "the level at an inclination follows from that at rest, which is not known",
            "state `volume` or `level` of the oil, or delete `travel`",
        ),
        Some(_) => return None,
    };
    Some(
        Diagnostic::error("housing.travel", message)
            .code(codes::TRAVEL)
            .help(help),
    )
}

/// Ribs that shall catch the oil that gears lift, where it is not known how much that is.
fn no_wetting(pockets: &[SeatedPocket]) -> Vec<Diagnostic> {
    let asked = pockets
        .iter()
        .filter(|pocket| pocket.entry.rib.is_some_and(|rib| rib.wetting.is_none()));
    let error = |pocket: &SeatedPocket| {
        Diagnostic::error(
            format!("{}.pocket.catch", pocket.path),
            "how much oil the gears lift is not known: no gear with a churning law dips into a known oil space",
        )
        .code(codes::OIL_NETWORK)
        .help("state `wetting`, or an oil level with `housing.inside` and a churning law in `models.gear_drag`")
    };
    asked.map(error).collect()
}

/// Reports seals that the oil at rest covers.
fn covered_seals(resolved: &Resolved, members: &Members, oils: &OilNumbers<'_>) -> Vec<Diagnostic> {
    let entries = resolved.value.get(Seal::SECTION).and_then(Value::as_object);
    let depth = |seal: &Value| {
        let member = members.names.iter().position(|name| seal["shaft"] == name.as_str())?;
        let at = seal["at"].as_f64().unwrap_or(0.0);
        let Level::Sump { height, slope, .. } = oils.level(Some(member as u16), at) else {
            return None;
        };
        Some((oils.rest()? - height) * slope - 0.5 * seal["diameter"].as_f64()?)
    };
    let covered = entries
        .into_iter()
        .flatten()
        .filter_map(|(id, seal)| Some((id, depth(seal)?)));
    covered
        .filter(|(_, depth)| *depth > 0.0)
        .map(|(id, depth)| {
            let message = format!(
                "the oil at rest covers the seal: it stands {:.1} mm above its upper edge",
                depth * 1e3
            );
            Diagnostic::warning(format!("{}.{id}", Seal::SECTION), message)
                .code(codes::OIL_LEVEL)
                .help("check the level and `measured_from`, the volume, and the axis of the shaft")
        })
        .collect()
}

/// Oil height at each gear.
fn levels(entry: &GearboxEntry, gears: &[GearSeat], oils: &OilNumbers<'_>) -> Vec<Level> {
    let seats = gears.iter().enumerate();
    seats
        .map(|(i, g)| {
            let gear = &entry.gears.0[i].1;
            if entry.is_greased(gear.oil.lubricant.as_deref()) {
                return Level::Dry;
            }
            gear.level
                .map_or_else(|| oils.level(Some(g.member as u16), g.tip_at), Level::Own)
        })
        .collect()
}
