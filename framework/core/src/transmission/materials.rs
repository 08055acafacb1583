//! Materials of gears: those that they name, and what they do not state.

use crate::attach::dangling;
use crate::codes;
use crate::description::{GearboxEntry, MaterialEntry, WormMeshEntry};
use crate::document::Diagnostic;
use crate::material::Material;
use crate::mechanism::gear_mesh::{steel, steel_poisson};
use crate::mechanism::worm_mesh::WheelMaterial;

/// The material of each gear that names one.
pub(super) fn of_gears(
    entry: &GearboxEntry,
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) -> Vec<Option<Material>> {
    let ids: Vec<&str> = entry.materials.ids().collect();
    let mut known = Vec::new();
    for (id, written) in entry.materials.iter() {
        let material = written.material().map_err(|(key, fault)| {
            found.push(
                Diagnostic::error(format!("materials.{id}.{key}"), fault)
                    .code(codes::MATERIAL)
                    .help("state it, or a `designation`: `gearloss catalogue materials` lists them"),
            );
        });
        known.push(material.ok());
        if !entry.gears.iter().any(|(_, gear)| gear.material.as_deref() == Some(id)) {
            warnings.push(
                Diagnostic::warning(format!("materials.{id}"), format!("no gear is made of `{id}`"))
                    .code(codes::UNUSED_MATERIAL)
                    .help("name it as `material` of a gear, or remove it"),
            );
        }
    }
    let gears = entry.gears.iter().map(|(id, gear)| {
        let name = gear.material.as_deref()?;
        let number = entry.materials.index(name);
        if number.is_none() {
            let fault = dangling(&format!("gears.{id}.material"), "material", name, &ids);
            let entries = fault.help.clone().map(|help| format!("{help}, or name a designation"));
            let help = entries.unwrap_or_else(|| "name a designation".to_owned());
            found.push(fault.help(format!("{help}: `gearloss catalogue materials` lists them")));
        }
        number.and_then(|number| known[number])
    });
    let gears: Vec<Option<Material>> = gears.collect();
    warnings.extend(without_effect(entry));
    warnings.extend(doubtful_wheels(entry));
    gears
}

/// Reports modulus and Poisson's ratio of a mesh both of whose gears name their material.
fn without_effect(entry: &GearboxEntry) -> impl Iterator<Item = Diagnostic> + '_ {
    let meshes = entry.meshes.iter();
    let meshes = meshes.map(|(id, m)| (format!("meshes.{id}"), &m.gears, m.metal));
    let bevel = entry.bevel_meshes.iter();
    let bevel = bevel.map(|(id, m)| (format!("bevel_meshes.{id}"), &m.gears, m.metal));
    let crossed = entry.crossed_helical_meshes.iter();
    let crossed = crossed.map(|(id, m)| (format!("crossed_helical_meshes.{id}"), &m.gears, m.metal));
    let named = |gears: &[String; 2]| {
        let has = |gear: &String| entry.gears.get(gear).is_some_and(|gear| gear.material.is_some());
        gears.iter().all(has)
    };
    let all = meshes.chain(bevel).chain(crossed);
    all.filter(move |(_, gears, ..)| named(gears))
        .flat_map(|(path, _, metal)| {
            let keys = [
                ("elastic_modulus", metal.elastic_modulus != steel()),
                ("poisson", metal.poisson != steel_poisson()),
            ];
            let stated = keys.into_iter().filter(|(_, stated)| *stated);
            stated.map(move |(key, _)| {
                let message = format!("`{key}` has no effect: both gears name their `material`");
                Diagnostic::warning(format!("{path}.{key}"), message)
                    .code(codes::UNUSED_MATERIAL)
                    .help("remove it, or `material` of the gears")
            })
        })
}

/// The material of the rim of a worm wheel: that of the mesh, else what the material of the wheel is as such.
pub(super) fn worm_wheel(entry: &GearboxEntry, mesh: &WormMeshEntry) -> WheelMaterial {
    let of_wheel = of_wheel(entry, mesh).and_then(|material| material.worm_wheel);
    mesh.material.or(of_wheel).unwrap_or_default()
}

/// The material that the wheel of a worm names.
fn of_wheel<'e>(entry: &'e GearboxEntry, mesh: &WormMeshEntry) -> Option<&'e MaterialEntry> {
    let wheel = entry.gears.get(&mesh.gears[1])?;
    entry.materials.get(wheel.material.as_deref()?)
}

/// Reports worm wheels whose material is stated twice, or does not say what it is as such.
fn doubtful_wheels(entry: &GearboxEntry) -> impl Iterator<Item = Diagnostic> + '_ {
    entry.worm_meshes.iter().filter_map(|(id, mesh)| {
        let material = of_wheel(entry, mesh)?;
        let wheel = &mesh.gears[1];
        let message = match (mesh.material, material.worm_wheel) {
            (Some(stated), Some(other)) if stated != other => {
                format!("`material` of the mesh replaces what the material of `{wheel}` is as a worm wheel")
            }
            (None, None) => format!(
                "the material of `{wheel}` does not say what it is as a worm wheel; tin bronze CuSn12 stands in"
            ),
            _ => return None,
        };
        Some(
            Diagnostic::warning(format!("worm_meshes.{id}.material"), message)
                .code(codes::WHEEL_MATERIAL)
                .help("state `worm_wheel` of the material, and no `material` of the mesh"),
        )
    })
}
