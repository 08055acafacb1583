//! Values of a form that follow from those that were typed: a ring from its sun and planets, a centre distance from the teeth.

use std::collections::BTreeMap;

use gearloss_editor::outline::{Content, Node};
use gearloss_framework::document::{Unit, parse_quantity};

use super::fields::at;
use super::layouts::{Distance, Layout};

/// Values by path of the field. What was typed never follows.
pub fn followed(layout: &Layout, document: &Node, values: &BTreeMap<String, String>) -> BTreeMap<String, String> {
    let mut form = Form {
        document,
        values: values.clone(),
    };
    for (leader, follower) in layout.follows {
        if let Some(value) = values.get(*leader) {
            form.follow(follower, || Some(value.clone()));
        }
    }
    if let Some([sun, planets, ring]) = layout.planetary {
        let teeth = [sun, planets].map(|gear| format!("gears.{gear}.z"));
        if teeth.iter().any(|path| values.contains_key(path)) {
            let sum = form.teeth(sun).zip(form.teeth(planets)).map(|(s, p)| s + 2.0 * p);
            form.follow(&format!("gears.{ring}.z"), || sum.map(|z| z.to_string()));
        }
    }
    for axis in layout.distances {
        // The working pressure angle stays, and with it the sum of the profile shifts over that of the teeth.
        let was = form.as_in_template(|form| form.reference_distance(axis));
        let scaled = |(now, was): (f64, f64)| (now != was).then(|| axis.value * now / was);
        let value = form.reference_distance(axis).zip(was).and_then(scaled);
        form.follow(&axis.path(), || value.map(millimetres));
    }
    if let Some([_, planets, ring]) = layout.planetary {
        let path = format!("gears.{ring}.tip_diameter");
        let tip = at(document, &path).and_then(Node::text).and_then(length);
        let grown = |form: &Form<'_>| form.reference_diameter(planets, ring);
        let was = form.as_in_template(grown);
        let change = grown(&form)
            .zip(was)
            .map(|(now, was)| now - was)
            .filter(|change| *change != 0.0);
        form.follow(&path, || tip.zip(change).map(|(tip, change)| millimetres(tip + change)));
    }
    form.values.retain(|path, _| !values.contains_key(path));
    form.values
}

struct Form<'a> {
    document: &'a Node,
    /// What was typed, and what follows.
    values: BTreeMap<String, String>,
}

impl Form<'_> {
    fn follow(&mut self, path: &str, value: impl FnOnce() -> Option<String>) {
        if !self.values.contains_key(path)
            && let Some(value) = value()
        {
            self.values.insert(path.to_owned(), value);
        }
    }

    /// A result without what was typed.
    fn as_in_template<T>(&self, result: impl Fn(&Form<'_>) -> T) -> T {
        result(&Form {
            document: self.document,
            values: BTreeMap::new(),
        })
    }

    fn text(&self, path: &str) -> Option<&str> {
        let typed = self.values.get(path).map(String::as_str);
        typed.or_else(|| at(self.document, path).and_then(Node::text))
    }

    fn teeth(&self, gear: &str) -> Option<f64> {
        let teeth = self.text(&format!("gears.{gear}.z"))?.trim().parse::<u32>().ok()?;
        (teeth > 0).then_some(f64::from(teeth))
    }

    /// Normal module over the cosine of the helix angle. \[mm\]
    fn transverse_module(&self, mesh: &str) -> Option<f64> {
        let module = self.text(&format!("meshes.{mesh}.normal_module")).and_then(length)?;
        let helix = match self.text(&format!("meshes.{mesh}.helix_angle")) {
            Some(text) => quantity(text, "deg")?,
            None => 0.0,
        };
        Some(module / helix.cos()).filter(|module| module.is_finite() && *module > 0.0)
    }

    /// Centre distance of the reference cylinders of a pair of external gears, or of a worm and its wheel. \[mm\]
    fn reference_distance(&self, axis: &Distance) -> Option<f64> {
        match axis.section {
            "meshes" => {
                let [first, second] = self.gears(axis.mesh)?;
                Some(0.5 * self.transverse_module(axis.mesh)? * (self.teeth(first)? + self.teeth(second)?))
            }
            "worm_meshes" => {
                let of = |key: &str| self.text(&format!("worm_meshes.{}.{key}", axis.mesh));
                let module = of("module").and_then(length)?;
                let worm = of("worm_diameter").and_then(length)?;
                let [_, wheel] = self.gears_of("worm_meshes", axis.mesh)?;
                let distance = 0.5 * (worm + module * self.teeth(wheel)?);
                (distance > 0.0 && distance.is_finite()).then_some(distance)
            }
            // An offset does not follow from teeth.
            _ => None,
        }
    }

    /// Reference diameter of a ring in its mesh with planets. \[mm\]
    fn reference_diameter(&self, planets: &str, ring: &str) -> Option<f64> {
        let meshes = at(self.document, "meshes")?.entries().iter();
        let mesh_of_ring = meshes
            .map(|entry| entry.key.as_str())
            .find(|mesh| self.gears(mesh) == Some([planets, ring]))?;
        Some(self.transverse_module(mesh_of_ring)? * self.teeth(ring)?)
    }

    fn gears(&self, mesh: &str) -> Option<[&str; 2]> {
        self.gears_of("meshes", mesh)
    }

    fn gears_of(&self, section: &str, mesh: &str) -> Option<[&str; 2]> {
        match &at(self.document, &format!("{section}.{mesh}.gears"))?.content {
            Content::List(gears) => gears.iter().filter_map(Node::text).collect::<Vec<_>>().try_into().ok(),
            _ => None,
        }
    }
}

/// A text in SI; a bare number is in the documented unit.
fn quantity(text: &str, unit: &'static str) -> Option<f64> {
    let unit = Unit::of_symbol(unit).unwrap_or(Unit::ONE);
    let bare = text.trim().parse::<f64>().ok().map(|bare| unit.to_si(bare));
    bare.or_else(|| parse_quantity(text.trim(), unit).ok())
}

/// A length. \[mm\]
fn length(text: &str) -> Option<f64> {
    quantity(text, "mm").map(|metres| 1e3 * metres)
}

/// A length to a hundredth of a millimetre.
fn millimetres(length: f64) -> String {
    format!("{} mm", (length * 100.0).round() / 100.0)
}
