//! The text of a gearbox file.

use std::fmt::Write as _;

use super::draft::{Axis, Bearing, CrossedMesh, Draft, Film, Gear, Lubricant, Material, Mesh, Shaft};

/// A number as short as it can be written, with at most twelve digits: coordinates are sums, and their last digits are rounding.
pub fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.11e}").parse().unwrap_or(value);
    // Sums that cancel leave less than a nanometre.
    let rounded = if rounded.abs() < 1e-9 { 0.0 } else { rounded };
    let text = rounded.to_string();
    // YAML readers take plain decimals; a value with so many digits is out of every range and reported there.
    text.chars().take(40).collect()
}

/// A text in quotes.
pub fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// A flow map of the keys that have values.
#[derive(Debug, Default)]
pub struct Entry(Vec<String>);

impl Entry {
    pub fn word(mut self, key: &str, value: impl AsRef<str>) -> Self {
        self.0.push(format!("{key}: {}", value.as_ref()));
        self
    }

    pub fn word_if(self, key: &str, value: Option<impl AsRef<str>>) -> Self {
        match value {
            Some(value) => self.word(key, value),
            None => self,
        }
    }

    pub fn quantity(self, key: &str, value: f64, unit: &str) -> Self {
        let space = if unit.is_empty() { "" } else { " " };
        self.word(key, format!("{}{space}{unit}", number(value)))
    }

    pub fn quantity_if(self, key: &str, value: Option<f64>, unit: &str) -> Self {
        match value {
            Some(value) => self.quantity(key, value, unit),
            None => self,
        }
    }

    pub fn text(self) -> String {
        if self.0.is_empty() {
            "{}".to_owned()
        } else {
            format!("{{ {} }}", self.0.join(", "))
        }
    }
}

/// One entry of a section, with its comment at the end of the line.
fn line(text: &mut String, id: &str, entry: Entry, comment: &str) {
    let entry = format!("  {id}: {}", entry.text());
    if comment.is_empty() {
        let _ = writeln!(text, "{entry}");
    } else {
        let _ = writeln!(text, "{entry}   # {comment}");
    }
}

fn lengths(values: &[f64], unit: &str) -> String {
    let values: Vec<String> = values
        .iter()
        .map(|value| format!("{} {unit}", number(*value)))
        .collect();
    format!("[{}]", values.join(", "))
}

/// The text of a gearbox.
pub fn gearbox(draft: &Draft) -> String {
    let mut text = "# yaml-language-server: $schema=gearbox.schema.json\n".to_owned();
    for head in &draft.head {
        let _ = writeln!(text, "# {head}");
    }
    let _ = writeln!(text, "gearloss: gearbox/1");
    let _ = writeln!(text, "title: {}", quoted(&draft.title));
    let _ = writeln!(text, "source: {}", quoted(&draft.source));
    ports(&mut text, draft);
    shafts(&mut text, &draft.shafts);
    gears(&mut text, &draft.gears, &draft.meshes);
    meshes(&mut text, &draft.meshes);
    crossed(&mut text, &draft.crossed);
    surface(&mut text, draft);
    materials(&mut text, &draft.meshes);
    sets(&mut text, draft);
    couplings(&mut text, draft);
    bearings(&mut text, &draft.bearings);
    let seals = draft.ports.iter().map(|port| {
        let seal = Entry::default()
            .word("shaft", &port.shaft)
            .word("diameter", "40 mm")
            .word("kind", "radial_lip");
        format!("{}: {}", port.name, seal.text())
    });
    let _ = write!(
        text,
        "\n# REXS has no component for seals; their friction is often a large part of the no-load loss.\n#seals: {{ {} }}\n",
        seals.collect::<Vec<_>>().join(", ")
    );
    housing(&mut text, draft);
    models(&mut text, draft);
    origins(&mut text, draft);
    text.push_str("\n# Import of the REXS model\n");
    for report in &draft.report {
        let _ = writeln!(text, "{}", format!("# {report}").trim_end());
    }
    text
}

fn ports(text: &mut String, draft: &Draft) {
    let ports = draft
        .ports
        .iter()
        .fold(Entry::default(), |entry, port| entry.word(&port.name, &port.shaft));
    let _ = writeln!(text, "ports: {}", ports.text());
    if let Some((torque, speed)) = draft.rating {
        let rating = Entry::default()
            .quantity("torque", torque, "Nm")
            .quantity("speed", speed, "rpm");
        let _ = writeln!(text, "rating: {}   # largest values of the load cases", rating.text());
    }
}

fn shafts(text: &mut String, shafts: &[Shaft]) {
    let crosses = shafts
        .iter()
        .any(|shaft| matches!(shaft.axis, Some(Axis::Directed(..))));
    text.push_str(if crosses {
        "\n# Axis: y sideways, z upwards; x is the position along shafts without a `direction`, the distance from `through` that of others. A planet \
         has no `axis`, because it orbits.\nshafts:\n"
    } else {
        "\n# Axis: y sideways, z upwards; x is the position along all shafts. A planet has no `axis`, because it orbits.\nshafts:\n"
    });
    for shaft in shafts {
        let small = shaft.sections.is_empty() && shaft.loads.is_empty();
        let axis = shaft.axis.map(axis);
        let unsupported = shaft.unsupported.then_some("none");
        if small {
            let entry = Entry::default()
                .word_if("axis", axis)
                .quantity_if("mass", shaft.mass.map(|m| m.0), "kg")
                .quantity_if("mass_at", shaft.mass.map(|m| m.1), "mm")
                .word_if("bearings", unsupported);
            line(text, &shaft.id, entry, &shaft.comment);
            continue;
        }
        let _ = writeln!(text, "  {}:   # {}", shaft.id, shaft.comment);
        if let Some(axis) = axis {
            let _ = writeln!(text, "    axis: {axis}");
        }
        if let Some((mass, at)) = shaft.mass {
            let _ = writeln!(text, "    mass: {} kg\n    mass_at: {} mm", number(mass), number(at));
        }
        if let Some(none) = unsupported {
            let _ = writeln!(text, "    bearings: {none}");
        }
        if !shaft.sections.is_empty() {
            text.push_str("    sections:\n");
        }
        for section in &shaft.sections {
            let entry = Entry::default()
                .quantity("from", section.from, "mm")
                .quantity("to", section.to, "mm")
                .quantity("outer", section.outer, "mm")
                .quantity_if("inner", Some(section.inner).filter(|inner| *inner > 0.0), "mm");
            let _ = writeln!(text, "      - {}", entry.text());
        }
        if !shaft.loads.is_empty() {
            text.push_str("    loads:\n");
        }
        for load in &shaft.loads {
            let moment = (load.moment != [0.0; 2]).then(|| lengths(&load.moment, "Nm"));
            let entry = Entry::default()
                .quantity("at", load.at, "mm")
                .word("force", lengths(&load.force, "N"))
                .word_if("moment", moment);
            let _ = writeln!(text, "      - {}   # {}", entry.text(), load.comment);
        }
    }
}

fn axis(axis: Axis) -> String {
    match axis {
        Axis::AlongX(place) => lengths(&place, "mm"),
        Axis::Directed(through, direction) => Entry::default()
            .word("through", lengths(&through, "mm"))
            .word("direction", format!("[{}]", direction.map(number).join(", ")))
            .text(),
    }
}

/// Materials of the gears of meshes in which they differ or are soft, each once.
fn materials(text: &mut String, meshes: &[Mesh]) {
    let mut known: Vec<&Material> = Vec::new();
    for material in meshes.iter().flat_map(|mesh| mesh.materials.iter().flatten()) {
        if !known.iter().any(|other| other.id == material.id) {
            known.push(material);
        }
    }
    if !known.is_empty() {
        text.push_str("materials:\n");
    }
    for material in known {
        let entry = Entry::default()
            .word_if("kind", material.is_soft().then_some("plastic"))
            .quantity("elastic_modulus", material.modulus, "GPa")
            .quantity("poisson", material.poisson, "");
        line(text, &material.id, entry, &material.comment);
    }
}

/// The material that a gear names.
fn material_of<'m>(gear: &Gear, meshes: &'m [Mesh]) -> Option<&'m str> {
    meshes.iter().find_map(|mesh| {
        let place = mesh.gears.iter().position(|id| *id == gear.id)?;
        Some(mesh.materials.as_ref()?[place].id.as_str())
    })
}

fn gears(text: &mut String, gears: &[Gear], meshes: &[Mesh]) {
    if gears.is_empty() {
        return;
    }
    text.push_str("\n# `at` is the middle of the face.\ngears:\n");
    for gear in gears {
        let sign = (gear.ring && gear.profile_shift.is_some()).then_some("iso21771");
        let entry = Entry::default()
            .word("shaft", &gear.shaft)
            .quantity_if("at", gear.at, "mm")
            .word("z", gear.z.to_string())
            .quantity("facewidth", gear.facewidth, "mm")
            .word_if("kind", gear.ring.then_some("ring"))
            .word_if("mounted", gear.loose.then_some("loose"))
            .word_if("hand", gear.hand)
            .word_if("faces", gear.faces)
            .quantity_if("profile_shift", gear.profile_shift, "")
            .word_if("profile_shift_sign", sign)
            .quantity_if("tip_diameter", gear.tip_diameter, "mm")
            .quantity_if("root_diameter", gear.root_diameter, "mm")
            .word_if("material", material_of(gear, meshes))
            .word_if(
                "surface",
                gear.ra.map(|ra| Entry::default().quantity("ra", ra, "um").text()),
            );
        line(text, &gear.id, entry, &gear.comment);
    }
}

fn meshes(text: &mut String, meshes: &[Mesh]) {
    if meshes.is_empty() {
        return;
    }
    text.push_str("meshes:\n");
    for mesh in meshes {
        let entry = Entry::default()
            .word("gears", format!("[{}]", mesh.gears.join(", ")))
            .quantity("normal_module", mesh.normal_module, "mm")
            .quantity("pressure_angle", mesh.pressure_angle, "deg")
            .quantity_if(
                "helix_angle",
                Some(mesh.helix_angle).filter(|angle| *angle != 0.0),
                "deg",
            )
            .quantity_if("centre_distance", mesh.centre_distance, "mm")
            .quantity_if("elastic_modulus", mesh.modulus, "GPa")
            .quantity_if("poisson", mesh.poisson, "")
            .word_if("lubricant", mesh.lubricant.as_ref())
            .word_if("model", mesh.shares.as_ref().map(with_shares));
        line(text, &mesh.id, entry, &mesh.comment);
    }
}

/// A model that takes the loads on the teeth from a file.
fn with_shares(file: &String) -> String {
    let shares = Entry::default().word("type", "file").word("path", file).text();
    Entry::default()
        .word("type", "path_integral")
        .word("load_sharing", shares)
        .word("tooth_friction", "{ type: xu }")
        .text()
}

fn crossed(text: &mut String, meshes: &[CrossedMesh]) {
    for section in ["bevel_meshes", "worm_meshes", "crossed_helical_meshes"] {
        let of_section: Vec<&CrossedMesh> = meshes.iter().filter(|mesh| mesh.section == section).collect();
        if of_section.is_empty() {
            continue;
        }
        let _ = writeln!(text, "{section}:");
        for mesh in of_section {
            let entry = Entry::default().word("gears", format!("[{}]", mesh.gears.join(", ")));
            let entry = mesh
                .keys
                .iter()
                .fold(entry, |entry, (key, value)| entry.word(key, value));
            let entry = entry.word_if("lubricant", mesh.lubricant.as_ref());
            line(text, &mesh.id, entry, &mesh.comment);
        }
    }
}

/// Roughness of the flanks that state none.
fn surface(text: &mut String, draft: &Draft) {
    if draft.gears.iter().any(|gear| gear.ra.is_none()) {
        text.push_str(
            "# Placeholder, not in the REXS file: ground and run in 0.2 to 0.4 um, shaved or hobbed 0.8 to 1.6 um.\nsurface: { ra: 0.4 um }\n",
        );
    }
}

fn sets(text: &mut String, draft: &Draft) {
    if draft.sets.is_empty() {
        return;
    }
    text.push_str("\n# One planet stands for all of its set.\nplanetary_sets:\n");
    for set in &draft.sets {
        let _ = write!(
            text,
            "  {}:   # {}\n    carrier: {}\n    planets: [{}]\n    count: {}\n    #load_sharing: 1.1   # K_gamma: load of the most loaded planet over the mean\n",
            set.id,
            set.comment,
            set.carrier,
            set.planets.join(", "),
            set.count
        );
    }
}

fn couplings(text: &mut String, draft: &Draft) {
    if !draft.couplings.is_empty() {
        text.push_str("\ncouplings:\n");
        for coupling in &draft.couplings {
            let entry = Entry::default()
                .word("kind", "dog")
                .word("between", format!("[{}]", coupling.between.join(", ")))
                .word("model", "none");
            line(text, &coupling.id, entry, &coupling.comment);
        }
    }
    if !draft.states.is_empty() {
        text.push_str("gear_states:\n");
        for (gear, engaged) in &draft.states {
            let _ = writeln!(text, "  {gear}: [{}]", engaged.join(", "));
        }
    }
}

fn bearings(text: &mut String, bearings: &[Bearing]) {
    if bearings.is_empty() {
        return;
    }
    text.push_str(
        "\n# `axial` is the axial force of the shaft that the bearing supports: left is towards -x.\nbearings:\n",
    );
    for bearing in bearings {
        let entry = Entry::default()
            .word("shaft", &bearing.shaft)
            .word_if("outer", bearing.outer.as_ref())
            .quantity("at", bearing.at, "mm")
            .word_if("designation", bearing.designation.as_ref().map(|text| quoted(text)))
            .word_if("kind", bearing.kind)
            .word_if("series", bearing.series.as_ref().map(|text| quoted(text)))
            .quantity_if("bore", bearing.bore, "mm")
            .quantity_if("outside", bearing.outside, "mm")
            .quantity_if("width", bearing.width, "mm")
            .quantity_if("c", bearing.c, "N")
            .quantity_if("c0", bearing.c0, "N")
            .quantity_if("e", bearing.e, "")
            .quantity_if("y", bearing.y, "")
            .quantity_if("y0", bearing.y0, "")
            .quantity_if("pu", bearing.pu, "N")
            .word("axial", bearing.axial)
            .quantity_if("axial_share", bearing.axial_share, "")
            .word_if("takes_moment", bearing.takes_moment.then_some("true"))
            .quantity_if("radial_stiffness", bearing.radial_stiffness, "N/mm")
            .quantity_if("tilting_stiffness", bearing.tilting_stiffness, "Nm/rad")
            .word_if("lubrication", bearing.lubrication)
            .quantity_if("oil_height", bearing.oil_height, "mm")
            .word_if("lubricant", bearing.lubricant.as_ref())
            .word_if("film", bearing.film.as_ref().map(film))
            .word_if("model", bearing.model.map(model));
        line(text, &bearing.id, entry, &bearing.comment);
        if let Some(known) = &bearing.known {
            let known = quoted(known);
            let _ = writeln!(
                text,
                "    # Its name has a designation of the catalogue: `designation: {known}` can replace kind, bore, outside and model."
            );
        }
    }
}

fn film(film: &Film) -> String {
    Entry::default()
        .quantity("relative_clearance", film.relative_clearance, "")
        .quantity("least_thickness", film.least_thickness, "um")
        .text()
}

fn model(name: &str) -> String {
    if name == "none" {
        name.to_owned()
    } else {
        format!("{{ type: {name} }}")
    }
}

fn lubricant(oil: &Lubricant) -> Entry {
    let points: Vec<String> = oil
        .points
        .iter()
        .map(|(at, nu)| {
            Entry::default()
                .quantity("at", *at, "degC")
                .quantity("value", *nu, "mm2/s")
                .text()
        })
        .collect();
    let viscosity = Entry::default()
        .quantity_if("kv40", oil.kv40, "mm2/s")
        .quantity_if("kv100", oil.kv100, "mm2/s")
        .word_if(
            "points",
            (!points.is_empty()).then(|| format!("[{}]", points.join(", "))),
        );
    let density = oil.density.map(|density| {
        Entry::default()
            .word("at", "15 degC")
            .quantity("value", density, "kg/m3")
            .text()
    });
    Entry::default()
        .word_if("designation", oil.designation.as_ref().map(|text| quoted(text)))
        .word_if("kind", oil.kind)
        .word_if("viscosity", (!viscosity.0.is_empty()).then(|| viscosity.text()))
        .word_if("density", density)
        .quantity_if("heat_capacity", oil.heat_capacity, "J/(kg K)")
        .quantity_if("conductivity", oil.conductivity, "W/(m K)")
        .word_if("grease", oil.is_grease.then_some("{}"))
}

fn housing(text: &mut String, draft: &Draft) {
    text.push_str("\nlubricants:\n");
    for oil in &draft.lubricants {
        line(text, &oil.id, lubricant(oil), &oil.comment);
    }
    let _ = write!(
        text,
        "# REXS states no oil level, so no gear churns. With level, section and clearance, add `gear_drag` to `models`.\n\
         housing:\n  oil:\n    lubricant: {}\n    #level: -70 mm                                # at standstill, above the axis of `measured_from`\n    \
         #measured_from: {}\n    #volume: 2 l\n  #section: {{ area: 700 cm2, perimeter: 118 cm }}   # cross section of the gear case\n  \
         #clearance: {{ radial: 10 mm, axial: 12 mm }}      # gears to wall\n",
        draft.sump,
        draft.ports.first().map_or("shaft", |port| &port.shaft)
    );
    let oil = draft.oil_temperature.unwrap_or(80.0);
    let from = if draft.oil_temperature.is_some() {
        "that of the first load case"
    } else {
        "placeholder, not in the REXS file"
    };
    let _ = writeln!(
        text,
        "\nthermal:\n  mode: fixed\n  oil: {} degC   # {from}",
        number(oil)
    );
    if let Some((area, alpha)) = draft.heat {
        let _ = writeln!(
            text,
            "  #heat_dissipation: {{ casing: {{ type: constant, alpha: {} W/(m2 K), area: {} cm2 }} }}   # of VDI 2736; with `mode: balance`",
            number(alpha),
            number(area)
        );
    }
}

fn models(text: &mut String, draft: &Draft) {
    text.push_str(
        "\n# One loss model for each mechanism: `gearloss models bearing` lists them, `gearloss models --needs FILE` lists their missing inputs.\nmodels:\n",
    );
    if !draft.meshes.is_empty() {
        text.push_str("  gear_mesh: { type: iso14179_2 }\n");
    }
    for (section, model) in [
        (
            "bevel_meshes",
            "bevel_mesh: { type: path_integral, tooth_friction: { type: xu } }",
        ),
        ("worm_meshes", "worm_mesh: { type: din_3996 }"),
        (
            "crossed_helical_meshes",
            "crossed_helical_mesh: { type: point_contact, tooth_friction: { type: xu } }",
        ),
    ] {
        if draft.crossed.iter().any(|mesh| mesh.section == section) {
            let _ = writeln!(text, "  {model}");
        }
    }
    text.push_str(
        "  bearing: { type: skf }\n  #gear_drag: { churning: { type: changenet_2011 } }   # needs level, volume, section and clearance\n  \
         #seal: { type: iso14179_2 }                          # needs `seals`\n",
    );
    if !draft.sets.is_empty() {
        text.push_str("  #planetary_drag: { type: estimate, planet: none }    # drag of the carrier, accurate to a factor of three\n");
    }
}

/// What was assumed, and what is from the file, for the grades of evidence in reports.
fn origins(text: &mut String, draft: &Draft) {
    let entry = |paths: &[String], because: &str| {
        format!(
            "  - {{ paths: [{}], because: {} }}\n",
            paths.join(", "),
            quoted(because)
        )
    };
    if !draft.assumed.is_empty() {
        text.push_str("\n# Values that the REXS file does not have; reports show how much of the loss depends on them. Delete what you have replaced.\nassumed:\n");
        for (paths, because) in &draft.assumed {
            text.push_str(&entry(paths, because));
        }
    }
    if !draft.from_file.is_empty() {
        let paths: Vec<String> = draft.from_file.iter().map(|path| (*path).to_owned()).collect();
        text.push_str("sources:\n");
        text.push_str(&entry(&paths, &draft.source));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_plain() {
        for (value, expected) in [
            (47.0, "47"),
            (28.000000000000004, "28"),
            (47.02148907341676, "47.0214890734"),
            (-0.0, "0"),
            (1e-13, "0"),
            (22400.000000000002, "22400"),
            (1e-7, "0.0000001"),
        ] {
            assert_eq!(number(value), expected);
        }
    }

    #[test]
    fn texts_are_quoted() {
        assert_eq!(quoted("a\"b\\c\n"), r#""a\"b\\c\n""#);
    }
}
