//! Components, mechanisms and quantities of a study in the words of the field, for sentences and key figures.

use crate::text::{last_key, quoted_set};

/// A section of a gearbox: its key, one of its components, all of them.
const SECTIONS: [[&str; 3]; 16] = [
    ["auxiliaries", "auxiliary", "auxiliaries"],
    ["bearings", "bearing", "bearings"],
    ["bevel_meshes", "bevel mesh", "bevel meshes"],
    ["chains", "chain", "chains"],
    ["clutches", "clutch", "clutches"],
    ["couplings", "coupling", "couplings"],
    [
        "crossed_helical_meshes",
        "crossed helical mesh",
        "crossed helical meshes",
    ],
    ["differentials", "differential", "differentials"],
    ["gears", "gear", "gears"],
    ["joints", "joint", "joints"],
    ["machines", "machine", "machines"],
    ["meshes", "mesh", "meshes"],
    ["planetary_sets", "planetary set", "planetary sets"],
    ["seals", "seal", "seals"],
    ["shafts", "shaft", "shafts"],
    ["worm_meshes", "worm mesh", "worm meshes"],
];

/// Mechanisms by their key.
const MECHANISMS: [[&str; 2]; 14] = [
    ["auxiliary", "auxiliaries"],
    ["bearing", "bearings"],
    ["bevel_mesh", "bevel meshes"],
    ["chain", "chains and belts"],
    ["clutch", "clutches"],
    ["crossed_helical_mesh", "crossed helical meshes"],
    ["differential", "differentials"],
    ["gear_drag", "gear drag"],
    ["gear_mesh", "gear meshes"],
    ["joint", "joints"],
    ["planetary_drag", "planetary drag"],
    ["seal", "seals"],
    ["synchronizer", "synchronizers"],
    ["worm_mesh", "worm meshes"],
];

/// Ends of the paths of quantities.
const QUANTITIES: [[&str; 2]; 20] = [
    ["clearance.axial", "axial clearance of the housing"],
    ["clearance.radial", "radial clearance of the housing"],
    ["injection.flow", "injected oil flow"],
    ["kv100", "oil viscosity at 100 °C"],
    ["kv40", "oil viscosity at 40 °C"],
    ["level_offset", "offset of the oil level"],
    ["mu_bl", "boundary friction"],
    ["oil.volume", "oil volume"],
    ["oil_height", "oil level"],
    ["radial_factor", "radial load factor"],
    ["rheology.limiting_slope", "limiting shear stress of the oil"],
    ["rheology.tau0", "Eyring stress of the oil"],
    ["rheology.z", "pressure index of the oil viscosity"],
    ["rig.support_in.torque", "bearing torque of the rig"],
    ["rig.torque_offset_in", "torque offset of the rig"],
    ["surface.rq", "surface roughness"],
    ["thermal.oil", "oil temperature"],
    ["tip_relief.amount", "tip relief"],
    ["viscosity.factor", "oil viscosity factor"],
    ["viscosity.vi", "viscosity index of the oil"],
];

/// Lists that are vectors: their key, their name, and their components.
const VECTORS: [[&str; 3]; 4] = [
    ["axis", "axis", "yz"],
    ["direction", "direction", "xyz"],
    ["force", "force", "xyz"],
    ["through", "point", "xyz"],
];

/// Cycles that are known by capital letters.
const CYCLES: [&str; 7] = ["ftp75", "hwfet", "nedc", "nycc", "udds", "us06", "wltc"];

/// A component with the rest of its path: `bearings.B2.model` is `bearing B2` and `model`. All components of a section for `*`.
fn owner(path: &str) -> Option<(String, &str)> {
    let (section, rest) = path.split_once('.')?;
    let [_, one, all] = SECTIONS.iter().find(|[key, ..]| *key == section)?;
    let (id, rest) = rest.split_once('.').unwrap_or((rest, ""));
    let name = if id == "*" {
        format!("the {all}")
    } else {
        format!("{one} {id}")
    };
    Some((name, rest))
}

fn spaced(key: &str) -> String {
    key.replace('_', " ")
}

/// A mechanism, a component, or another share of a loss: `gear_mesh` is `gear meshes`, `bearings.B2` is `bearing B2`.
pub fn share(name: &str) -> String {
    let mechanism = MECHANISMS.iter().find(|[key, _]| *key == name);
    let mechanism = mechanism.map(|[_, words]| (*words).to_owned());
    mechanism.unwrap_or_else(|| model(name))
}

/// A component or one of its models: `meshes.M1.model.tooth_friction` is `tooth friction of mesh M1`.
pub fn model(path: &str) -> String {
    match owner(path) {
        None => path.to_owned(),
        Some((owner, "" | "model")) => owner,
        Some((owner, rest)) => format!("{} of {owner}", spaced(last_key(rest.trim_end_matches(".model")))),
    }
}

/// A quantity that ends with the path of its component: `life of bearings.B2` is `life of bearing B2`.
pub fn of_component(quantity: &str) -> String {
    match quantity.rsplit_once(" of ") {
        Some((name, path)) => format!("{name} of {}", model(path)),
        None => quantity.to_owned(),
    }
}

/// The end of a path in words. Values and entries of a list have the name of the list and their number, from one: `pins.errors.0` is `error 1 of
/// the pins`, `sections.1.outer` is `outer of section 2`; those of a vector are its components: `axis.0` is `y of the axis`.
fn end(path: &str) -> String {
    let number = |key: &str| key.parse::<usize>().ok().map(|number| number + 1);
    let Some((before, last)) = path.rsplit_once('.') else {
        return spaced(path);
    };
    let Some(count) = number(last) else {
        let listed = number(last_key(before)).map(|_| format!("{} of {}", spaced(last), end(before)));
        return listed.unwrap_or_else(|| spaced(last));
    };
    let (around, list) = before.rsplit_once('.').unwrap_or(("", before));
    let value = component(list, count).unwrap_or_else(|| format!("{} {count}", singular(list)));
    match around {
        "" => value,
        _ if number(last_key(around)).is_some() => format!("{value} of {}", end(around)),
        _ => format!("{value} of the {}", spaced(last_key(around))),
    }
}

/// A component of a vector by its number from one: the second of `axis` is `z of the axis`. Absent for other lists.
fn component(list: &str, number: usize) -> Option<String> {
    let [_, name, letters] = VECTORS.iter().find(|[key, ..]| *key == list)?;
    let letter = letters.chars().nth(number.checked_sub(1)?)?;
    Some(format!("{letter} of the {name}"))
}

/// One of what the key of a list names: `errors` is `error`.
fn singular(key: &str) -> String {
    let words = spaced(key);
    let ends = |ends: &[&str]| ends.iter().any(|end| words.ends_with(end));
    let cut = |letters: usize| words[..words.len() - letters].to_owned();
    if ends(&["ies"]) {
        return cut(3) + "y";
    }
    if ends(&["axes"]) {
        return cut(2) + "is";
    }
    if ends(&["xes", "ches", "shes"]) {
        return cut(2);
    }
    if ends(&["s"]) && !ends(&["is", "ss", "us"]) {
        return cut(1);
    }
    words
}

/// A quantity of a gearbox: `gears.*.surface.rq` is `surface roughness of the gears`.
pub fn quantity(path: &str) -> String {
    let is_end = |end: &str| path == end || path.strip_suffix(end).is_some_and(|rest| rest.ends_with('.'));
    let known = QUANTITIES.iter().find(|[end, _]| is_end(end));
    let owned = owner(path).filter(|(_, rest)| !rest.is_empty());
    let own = owned.as_ref().map_or(path, |(_, rest)| rest);
    let name = known.map_or_else(|| end(own), |[_, words]| (*words).to_owned());
    match owned {
        Some((owner, _)) => format!("{name} of {owner}"),
        None if known.is_none() && path.starts_with("lubricants.") => format!("{name} of the oil"),
        _ => name,
    }
}

/// A cycle: `wltc` is `WLTC`.
pub fn cycle(name: &str) -> String {
    if CYCLES.contains(&name) {
        name.to_uppercase()
    } else {
        format!("`{name}`")
    }
}

/// Names of model sets in a sentence: `ours/joint` and `theirs/joint` differ in the product alone.
pub struct SetNames<'a> {
    common: Option<&'a str>,
}

impl<'a> SetNames<'a> {
    /// For sentences about these sets.
    pub fn new(all: impl Iterator<Item = &'a str>) -> Self {
        let mut sets = all.map(|name| name.split_once('/').map(|(_, set)| set));
        let first = sets.next().flatten();
        Self {
            common: first.filter(|_| sets.all(|set| set == first)),
        }
    }

    /// The name without what all have in common.
    pub fn word(&self, name: &str) -> String {
        let product = self
            .common
            .and_then(|common| name.strip_suffix(common)?.strip_suffix('/'));
        product.unwrap_or(name).to_owned()
    }

    /// The same between backticks.
    pub fn quoted(&self, name: &str) -> String {
        quoted_set(&self.word(name))
    }
}

/// `a, b and c`.
pub fn listed(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::{SetNames, cycle, listed, model, of_component, quantity, share, singular};

    #[test]
    fn paths_are_words_of_the_field() {
        assert_eq!(quantity("gears.*.surface.rq"), "surface roughness of the gears");
        assert_eq!(quantity("lubricants.sump.viscosity.kv100"), "oil viscosity at 100 °C");
        assert_eq!(quantity("lubricants.sump.kind"), "kind of the oil");
        assert_eq!(quantity("bearings.B3.oil_height"), "oil level of bearing B3");
        assert_eq!(quantity("thermal.network.oil_flow"), "oil flow");
        assert_eq!(quantity("shafts.S1"), "S1");
        assert_eq!(
            quantity("planetary_sets.stage.pins.errors.0"),
            "error 1 of the pins of planetary set stage"
        );
        assert_eq!(
            quantity("shafts.*.sections.1.outer"),
            "outer of section 2 of the shafts"
        );
        assert_eq!(quantity("shafts.S1.axis.0"), "y of the axis of shaft S1");
        assert_eq!(
            quantity("shafts.S1.axis.through.0"),
            "x of the point of the axis of shaft S1"
        );
        assert_eq!(
            quantity("shafts.S1.loads.0.force.2"),
            "z of the force of load 1 of shaft S1"
        );
        assert_eq!(quantity("shafts.S1.loads.0.moment.1"), "moment 2 of load 1 of shaft S1");
        assert_eq!(
            ["axes", "boxes", "viscosities"].map(singular),
            ["axis", "box", "viscosity"]
        );
        assert_eq!(model("meshes.M1.model.tooth_friction"), "tooth friction of mesh M1");
        assert_eq!(model("gears.G4.drag.churning.model"), "churning of gear G4");
        assert_eq!(share("bearings.B2"), "bearing B2");
        assert_eq!(share("gear_mesh"), "gear meshes");
        assert_eq!(of_component("life of bearings.B2"), "life of bearing B2");
        assert_eq!(of_component("loss of the drive unit"), "loss of the drive unit");
        assert_eq!((cycle("wltc"), cycle("town")), ("WLTC".to_owned(), "`town`".to_owned()));
        assert_eq!(listed(&["a", "b", "c"].map(str::to_owned)), "a, b and c");
    }

    #[test]
    fn products_with_one_set_need_no_set() {
        let names = SetNames::new(["ours/joint", "theirs/joint"].into_iter());
        assert_eq!(names.quoted("theirs/joint"), "`theirs`");
        assert_eq!(SetNames::new(["iso", "joint"].into_iter()).quoted("iso"), "`iso`");
        let mixed = SetNames::new(["ours/iso", "theirs/joint"].into_iter());
        assert_eq!(mixed.quoted("ours/iso"), "`ours/iso`");
    }
}
