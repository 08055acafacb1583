//! The thermal network of `network: auto`: nodes and links derived from shafts, bearings, gears and housing.
//!
//! Nodes: the oil of the sump, the casing, every shaft with gears or bearings together with its fixed gears, every idler gear,
//! every bearing. A planet body is one node for all its copies. The heat of a mesh goes into its gears, that of a bearing into the
//! bearing, that of a seal into its shaft because the rubber lip insulates; all other heat goes into the oil.
//!
//! A description gives only geometry and oil, so the values below are assumed. The conductances of bearings are taken from thermal
//! networks of drive units and scatter by a factor of two in either direction. Each value is written into the description, where it
//! can be changed or identified.

mod body;
mod builder;

use gearloss_framework::description::{GearboxEntry, HeatInto, Mounting};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::lubricant::Lubricant;
use gearloss_framework::mechanism::bearing::{BearingEntry, Lubrication};
use gearloss_framework::mechanism::heat_dissipation::HousingPart;
use gearloss_framework::origin;
use gearloss_framework::registry::{NetworkRecipe, inventory};
use serde_json::{Value, json};

use body::{Bodies, Metal};
use builder::NetworkBuilder;

/// From a bearing to the shaft or gear in its bore, per metre of bore. \[W/(m K)\]
const TO_BORE: f64 = 90.0;
/// From a bearing to its seat, per metre of outside diameter. \[W/(m K)\]
const TO_OUTSIDE: f64 = 80.0;
/// From a bearing in oil to the sump. \[W/K\]
const TO_OIL: f64 = 2.0;
/// From gear to gear through the teeth in contact. \[W/K\]
const TEETH: f64 = 10.0;
/// From an idler gear without bearings to its shaft. \[W/K\]
const PLAIN_BORE: f64 = 5.0;
/// From a component bolted to the housing to the casing. \[W/K\]
const SCREWED: f64 = 20.0;
/// From a stationary gear to the surrounding oil and mist. \[W/(m2 K)\]
const AT_REST: f64 = 50.0;
/// From oil to casing where no splashing gear is known. \[W/(m2 K)\]
const WITHOUT_SPLASH: f64 = 100.0;
/// Share of the volume between bore and outside diameter that the metal of a bearing fills.
const FILLED: f64 = 0.7;
/// Oil volume where none is stated. \[m3\]
const ONE_LITRE: f64 = 1e-3;

inventory::submit! {
    NetworkRecipe {
        meaning: "Nodes for oil, casing, shafts with their gears, idler gears and bearings; conductances by size.",
        generate,
        origin: origin!(),
    }
}

/// A bearing with its position.
struct Seated {
    id: String,
    entry: BearingEntry,
    shaft: String,
    outer: Option<String>,
    /// Position along the shaft. \[m\]
    at: f64,
    /// Number of equal copies, counting all planets.
    copies: f64,
    /// True if its model computes a loss.
    loses: bool,
}

fn generate(entry: &GearboxEntry, value: &Value) -> Result<Value, Diagnostic> {
    let housing = HousingPart::from(entry.housing.outside.unwrap_or_default());
    let area = outside(&housing)?;
    let bodies = Bodies::new(entry);
    let bearings = seated(value, &bodies);
    let mut builder = NetworkBuilder::default();

    let sump = builder.node("sump", "oil", sump_capacity(entry));
    let wall = Metal::of_wall(housing.wall_conductivity);
    let casing = builder.node("casing", "wall", area * housing.wall_thickness * wall.heat_capacity());
    builder.oil(&sump);

    for (id, shaft) in entry.shafts.iter() {
        let carried = bearings.iter().any(|b| b.shaft == id || b.outer.as_deref() == Some(id));
        let fixed = || entry.gears.iter().filter(|(_, g)| is_fixed(g.mounted) && g.shaft == id);
        if !carried && fixed().next().is_none() {
            continue;
        }
        let bores = bearings.iter().filter(|b| b.shaft == id);
        let capacity = if shaft.mass > 0.0 {
            shaft.mass * Metal::STEEL.specific_heat
        } else {
            let gears: f64 = fixed().map(|(gear, _)| bodies.capacity(gear)).sum();
            let places = bores.map(|b| (b.entry.bore, b.at));
            gears + bodies.shaft_capacity(id, shaft, places)
        };
        let node = builder.node(id, "shaft", bodies.copies(id) * capacity);
        builder.member(id, &node);
        for (gear, _) in fixed() {
            builder.gear(gear, &node);
        }
    }
    for (id, gear) in entry.gears.iter().filter(|(_, g)| !is_fixed(g.mounted)) {
        let node = builder.node(id, "gear", bodies.copies(&gear.shaft) * bodies.capacity(id));
        builder.member(id, &node);
        builder.gear(id, &node);
        if let Some(shaft) = builder.of_member(&gear.shaft)
            && !bearings.iter().any(|b| b.outer.as_deref() == Some(id) || b.shaft == id)
        {
            builder.link(&format!("{id}_bore"), &node, &shaft, PLAIN_BORE);
        }
    }
    for bearing in &bearings {
        bearing_node(bearing, &mut builder, &casing, &sump);
    }
    gears_to_oil(entry, &bodies, &mut builder, &sump);
    for (path, gears, _) in entry.all_meshes() {
        let id = path.split_once('.').map_or("", |(_, id)| id);
        let [first, second] = gears.each_ref().map(|gear| builder.of_gear(gear));
        if let (Some(first), Some(second)) = (first, second) {
            let copies = gears.iter().map(|gear| bodies.copies_of_gear(gear)).fold(1.0, f64::max);
            builder.link(id, &first, &second, copies * TEETH);
        }
    }
    screwed(value, &mut builder, &casing);
    seals(value, &mut builder, &sump);

    match bodies.splashing() {
        Some(splash) => {
            let mut model = json!({ "type": "oil_casing" });
            if let Some(reach) = splash.reach {
                model["tip_diameter"] = builder::number(1e3 * reach);
            }
            let link = if splash.reach.is_some() {
                json!({ "model": model, "shaft": splash.member })
            } else {
                json!({ "model": model, "gear": splash.member })
            };
            builder.law("sump_casing", &sump, &casing, link);
        }
        None => builder.link(
            "sump_casing",
            &sump,
            &casing,
            WITHOUT_SPLASH * housing.oil_area.unwrap_or(area),
        ),
    }
    builder.law(
        "casing_ambient",
        &casing,
        "ambient",
        json!({ "model": { "type": "casing_air" } }),
    );
    for (id, source) in entry.thermal.sources.iter() {
        let into = match source.into {
            HeatInto::Oil => &sump,
            HeatInto::Surface => &casing,
        };
        builder.source(id, source.heat, into);
    }
    Ok(builder.written())
}

/// The outside area of the housing; an error if other quantities for its heat transfer are missing.
fn outside(housing: &HousingPart) -> Result<f64, Diagnostic> {
    let missing: Vec<&str> = [
        (housing.area.is_none(), "area"),
        (housing.height.is_none(), "height"),
        (housing.length.is_none(), "length"),
    ]
    .into_iter()
    .filter_map(|(missing, name)| missing.then_some(name))
    .collect();
    housing.area.filter(|_| missing.is_empty()).ok_or_else(|| {
        Diagnostic::error(
            "thermal.network",
            format!("`auto` needs the {} of the housing outside", missing.join(" and the ")),
        )
        .help("add `housing: { outside: { box: [400 mm, 250 mm, 300 mm] } }` with your length, width and height, or `area`, `height` and `length` there")
    })
}

/// Heat capacity of the oil at its given temperature. \[J/K\]
fn sump_capacity(entry: &GearboxEntry) -> f64 {
    let sump = entry.housing.oil.as_ref();
    let lubricant = match sump {
        Some(oil) => entry.lubricants.get(&oil.lubricant),
        None => entry.lubricants.iter().next().map(|(_, oil)| oil),
    };
    // Errors of the oil are reported where it is built.
    let volumetric = lubricant.and_then(|oil| Lubricant::new(oil).ok()).map_or(0.0, |oil| {
        oil.density(entry.thermal.oil) * oil.heat_capacity(entry.thermal.oil)
    });
    sump.and_then(|oil| oil.volume).unwrap_or(ONE_LITRE) * volumetric
}

fn is_fixed(mounted: Mounting) -> bool {
    mounted == Mounting::Fixed
}

/// Entries of a section of components.
fn section<'a>(value: &'a Value, name: &str) -> impl Iterator<Item = (&'a String, &'a Value)> + use<'a> {
    value.get(name).and_then(Value::as_object).into_iter().flatten()
}

fn text<'a>(entry: &'a Value, key: &str) -> Option<&'a str> {
    entry.get(key).and_then(Value::as_str)
}

/// True if a component has a model other than `none`.
fn loses(entry: &Value) -> bool {
    entry
        .get("model")
        .is_some_and(|model| model != "none" && model.get("type").is_none_or(|name| name != "none"))
}

fn seated(value: &Value, bodies: &Bodies<'_>) -> Vec<Seated> {
    section(value, "bearings")
        .filter_map(|(id, bearing)| {
            let shaft = text(bearing, "shaft")?.to_owned();
            let outer = text(bearing, "outer").map(str::to_owned);
            let count = bearing.get("count").and_then(Value::as_f64).unwrap_or(1.0);
            let planets = bodies
                .copies(&shaft)
                .max(outer.as_deref().map_or(1.0, |outer| bodies.copies(outer)));
            Some(Seated {
                id: id.clone(),
                // Errors of the bearing are reported where it is built.
                entry: serde_json::from_value(bearing.clone()).ok()?,
                shaft,
                outer,
                at: bearing.get("at").and_then(Value::as_f64).unwrap_or(0.0),
                copies: count * planets,
                loses: loses(bearing),
            })
        })
        .collect()
}

fn bearing_node(bearing: &Seated, builder: &mut NetworkBuilder, casing: &str, sump: &str) {
    let Seated { id, entry, copies, .. } = bearing;
    let (Some(bore), Some(outside)) = (entry.bore, entry.outside) else {
        return;
    };
    let room = 0.25 * std::f64::consts::PI * (outside * outside - bore * bore).max(0.0) * entry.width.unwrap_or(0.0);
    let node = builder.node(id, "bearing", copies * FILLED * room * Metal::STEEL.heat_capacity());
    if bearing.loses {
        builder.part(&node, &format!("bearings.{id}"));
    }
    let around = match &bearing.outer {
        Some(outer) => builder.of_member(outer),
        None => Some(casing.to_owned()),
    };
    if let Some(shaft) = builder.of_member(&bearing.shaft) {
        builder.link(&format!("{node}_{shaft}"), &node, &shaft, copies * TO_BORE * bore);
    }
    if let Some(around) = around {
        builder.link(
            &format!("{node}_{around}"),
            &node,
            &around,
            copies * TO_OUTSIDE * outside,
        );
    }
    if entry.lubrication != Lubrication::Grease {
        builder.link(&format!("{node}_{sump}"), &node, sump, copies * TO_OIL);
    }
}

/// Adds the links of every gear to the oil: free convection at standstill, centrifugal film flow in motion.
fn gears_to_oil(entry: &GearboxEntry, bodies: &Bodies<'_>, builder: &mut NetworkBuilder, sump: &str) {
    let oiled = |lubricant: Option<&str>| !entry.is_greased(lubricant);
    for (id, gear) in entry
        .gears
        .iter()
        .filter(|(_, gear)| oiled(gear.oil.lubricant.as_deref()))
    {
        let (Some(node), Some(size)) = (builder.of_gear(id), bodies.size(id)) else {
            continue;
        };
        let copies = bodies.copies(&gear.shaft);
        builder.link(
            &format!("{id}_{sump}_at_rest"),
            &node,
            sump,
            copies * AT_REST * size.wetted(),
        );
        // Centrifugal force keeps the oil in a ring gear.
        if !size.ring {
            let mut model = json!({ "type": "fling_off" });
            if copies > 1.0 {
                // The teeth of all planets.
                model["teeth"] = json!(copies * f64::from(gear.z));
            }
            builder.law(
                &format!("{id}_{sump}"),
                &node,
                sump,
                json!({ "model": model, "gear": id }),
            );
        }
    }
}

/// Members that a coupling or clutch can connect to the housing.
fn screwed(value: &Value, builder: &mut NetworkBuilder, casing: &str) {
    for (id, coupling) in section(value, "couplings").chain(section(value, "clutches")) {
        let between: Vec<&str> = coupling
            .get("between")
            .and_then(Value::as_array)
            .into_iter()
            .flatten()
            .filter_map(Value::as_str)
            .collect();
        if let [one, other] = between[..]
            && let Some(member) = match (one, other) {
                ("housing", member) | (member, "housing") => builder.of_member(member),
                _ => None,
            }
        {
            builder.link(id, &member, casing, SCREWED);
        }
    }
}

fn seals(value: &Value, builder: &mut NetworkBuilder, sump: &str) {
    for (id, seal) in section(value, "seals").filter(|(_, seal)| loses(seal)) {
        if let Some(node) = text(seal, "shaft").and_then(|shaft| builder.of_member(shaft)) {
            builder.part(&node, &format!("seals.{id}"));
            builder.oil_of(sump, &format!("seals.{id}"));
        }
    }
}
