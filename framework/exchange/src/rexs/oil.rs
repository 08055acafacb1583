//! Oils, and what the housing states.

use super::draft::{Draft, Lubricant};
use super::map::{Map, id, named};
use super::model::Component;
use super::units::Quantity;
use crate::codes;

/// Oil that stands in where the file has none.
const PLACEHOLDER: &str = "ISO VG 220 mineral";

/// The oil of the housing: that of the casing, else the first.
pub fn sump<'a>(map: &Map<'a>) -> Option<&'a Component> {
    let source = map.source;
    let casing = source.components("gear_casing").next();
    casing
        .and_then(|casing| map.referenced(casing.id, "lubricant"))
        .or_else(|| {
            let first = source.components("lubricant").next()?;
            source.assume(format!(
                "the casing names no oil; {} is that of the sump",
                first.label()
            ));
            Some(first)
        })
}

/// Writes the oils and the housing into the draft.
pub fn oils(map: &Map<'_>, draft: &mut Draft) {
    let source = map.source;
    for component in source.components("lubricant") {
        draft.lubricants.extend(oil(map, component));
    }
    match map
        .sump
        .clone()
        .filter(|name| draft.lubricants.iter().any(|oil| oil.id == *name))
    {
        Some(name) => draft.sump = name,
        None if source.has_errors() => {}
        None => {
            draft.lubricants.push(Lubricant {
                id: "placeholder".to_owned(),
                designation: Some(PLACEHOLDER.to_owned()),
                ..Lubricant::default()
            });
            "placeholder".clone_into(&mut draft.sump);
            draft.assumed.push((
                vec!["lubricants.placeholder".to_owned()],
                "placeholder: the REXS file names no oil".to_owned(),
            ));
            source.missing(format!("the oil: {PLACEHOLDER} stands in as `lubricants.placeholder`"));
        }
    }
    let Some(casing) = source.components("gear_casing").next() else {
        return;
    };
    let vdi = |id: &str, quantity: Quantity| {
        ["_housing_vdi_2736_2014", "_vdi_2736_2014"]
            .into_iter()
            .find_map(|end| source.positive(casing, &format!("{id}{end}"), quantity))
    };
    let area = vdi("heat_dissipating_surface", Quantity::Area);
    let resistance = vdi("heat_transfer_resistance", Quantity::Resistance);
    draft.heat = area.zip(resistance.map(|resistance| 1.0 / resistance));
}

fn oil(map: &Map<'_>, component: &Component) -> Option<Lubricant> {
    let source = map.source;
    let number = |id: &str, quantity: Quantity| source.positive(component, id, quantity);
    let mut oil = Lubricant {
        id: id("lubricant", component.id),
        comment: named(component),
        kv40: number("viscosity_at_40_degree_celsius", Quantity::Viscosity),
        kv100: number("viscosity_at_100_degree_celsius", Quantity::Viscosity),
        density: number("density_at_15_degree_celsius", Quantity::Density),
        heat_capacity: number("thermal_capacity", Quantity::HeatCapacity),
        conductivity: number("thermal_conductivity", Quantity::Conductivity),
        ..Lubricant::default()
    };
    if oil.kv40.is_none() || oil.kv100.is_none() {
        points(map, component, &mut oil);
    }
    oil.kind = kind(map, component, oil.density);
    oil.is_grease = is_grease(map, component);
    if oil.is_grease {
        source.assume(format!(
            "{}: it is a grease; its viscosities count as those of its base oil",
            component.label()
        ));
    }
    if oil.kv40.is_none_or(|_| oil.kv100.is_none()) && oil.points.is_empty() {
        source.error(
            component,
            codes::REXS_VALUE,
            "its viscosities at 40 and 100 degC are missing",
            "state both in the program that exported the model",
        );
        return None;
    }
    Some(oil)
}

/// True if a lubricant is a grease.
pub fn is_grease(map: &Map<'_>, lubricant: &Component) -> bool {
    map.source.word(lubricant, "kind").as_deref() == Some("grease")
}

/// Two or three viscosities of a table over temperature.
fn points(map: &Map<'_>, component: &Component, oil: &mut Lubricant) {
    let source = map.source;
    let at = source.numbers(
        component,
        "temperature_variation_lubricant_viscosity",
        Quantity::Temperature,
    );
    let nu = source.numbers(
        component,
        "temperature_dependent_kinematic_viscosity",
        Quantity::Viscosity,
    );
    let (Some(at), Some(nu)) = (at, nu) else {
        return;
    };
    let mut table: Vec<(f64, f64)> = at.into_iter().zip(nu).filter(|(_, nu)| *nu > 0.0).collect();
    table.sort_by(|a, b| a.0.total_cmp(&b.0));
    table.dedup_by_key(|point| point.0);
    if table.len() < 2 {
        return;
    }
    let count = table.len();
    let (first, last) = (table[0], table[count - 1]);
    oil.points = if count == 2 {
        vec![first, last]
    } else {
        vec![first, table[count / 2], last]
    };
    (oil.kv40, oil.kv100) = (None, None);
    source.assume(format!(
        "{}: of {count} viscosities over temperature, {} were taken",
        component.label(),
        oil.points.len()
    ));
}

fn kind(map: &Map<'_>, component: &Component, density: Option<f64>) -> Option<&'static str> {
    let source = map.source;
    let of_standard = ["lubricant_type_iso_6336_2019", "lubricant_type_iso_6336_2006"]
        .into_iter()
        .find_map(|id| source.word(component, id));
    let (kind, basis) = (source.word(component, "kind"), source.word(component, "basis"));
    match of_standard.as_deref() {
        Some("mineral_oil") => return Some("mineral"),
        Some("polyalfaolefin" | "polyalphaolefin") => return Some("polyalphaolefin"),
        Some("water_soluble_polyglycol" | "non_water_soluble_polyglycol") => return Some("polyglycol"),
        Some("phosphate_ester") => return Some("ester"),
        Some("traction_fluid") => source.assume(format!(
            "{}: a traction fluid is described as a mineral oil; its friction is higher",
            component.label()
        )),
        _ => {}
    }
    if basis.as_deref() == Some("mineral") || kind.as_deref() == Some("mineraloel") {
        return Some("mineral");
    }
    if basis.as_deref() == Some("synthetic") {
        // Polyglycols are heavier than water, polyalphaolefins far lighter.
        let kind = if density.is_some_and(|density| density > 980.0) {
            "polyglycol"
        } else {
            "polyalphaolefin"
        };
        source.assume(format!(
            "{}: a synthetic oil of this density is described as {kind}",
            component.label()
        ));
        return Some(kind);
    }
    source.assume(format!(
        "{}: the file does not state the kind of oil; it counts as mineral",
        component.label()
    ));
    None
}
