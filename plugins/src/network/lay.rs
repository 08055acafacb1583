//! A thermal network while it is laid out: names that are free, numbers that can be read.

use serde_json::{Map, Value, json};

/// Nodes and links so far.
#[derive(Default)]
pub struct Lay {
    nodes: Map<String, Value>,
    links: Map<String, Value>,
    sources: Map<String, Value>,
    /// Shafts and loose gears with their nodes.
    members: Vec<(String, String)>,
    /// Gears with their nodes.
    gears: Vec<(String, String)>,
}

/// A name that nothing has: the wanted one, else with what the thing is, else with a number.
fn free(taken: &Map<String, Value>, wanted: &str, what: &str) -> String {
    if !taken.contains_key(wanted) && wanted != "ambient" {
        return wanted.to_owned();
    }
    let named = format!("{wanted}_{what}");
    (1..=taken.len() + 1)
        .map(|n| if n == 1 { named.clone() } else { format!("{named}_{n}") })
        .find(|name| !taken.contains_key(name))
        .unwrap_or(named)
}

/// A number with four digits, as many as an assumed one deserves.
pub fn number(value: f64) -> Value {
    json!(format!("{value:.3e}").parse::<f64>().unwrap_or(value))
}

impl Lay {
    /// A node with a heat capacity in J/K; its name.
    pub fn node(&mut self, wanted: &str, what: &str, capacity: f64) -> String {
        let name = free(&self.nodes, wanted, what);
        self.nodes
            .insert(name.clone(), json!({ "heat_capacity": number(capacity) }));
        name
    }

    /// Says that a node is the oil of the housing.
    pub fn oil(&mut self, node: &str) {
        self.nodes[node]["oil"] = json!(true);
    }

    /// Says which node a shaft or a loose gear is.
    pub fn member(&mut self, id: &str, node: &str) {
        self.members.push((id.to_owned(), node.to_owned()));
    }

    /// Says of which node a gear is the body.
    pub fn gear(&mut self, id: &str, node: &str) {
        self.push(node, "gears", id);
        self.gears.push((id.to_owned(), node.to_owned()));
    }

    /// Says which part heats a node.
    pub fn part(&mut self, node: &str, path: &str) {
        self.push(node, "parts", path);
    }

    /// Says which part has oil as warm as a node.
    pub fn oil_of(&mut self, node: &str, path: &str) {
        self.push(node, "oil_of", path);
    }

    fn push(&mut self, node: &str, key: &str, text: &str) {
        let node = &mut self.nodes[node];
        match node.get_mut(key).and_then(Value::as_array_mut) {
            Some(list) => list.push(json!(text)),
            None => node[key] = json!([text]),
        }
    }

    /// The node of a shaft or a loose gear.
    pub fn of_member(&self, id: &str) -> Option<String> {
        self.members
            .iter()
            .find(|(own, _)| own == id)
            .map(|(_, node)| node.clone())
    }

    /// The node of a gear.
    pub fn of_gear(&self, id: &str) -> Option<String> {
        self.gears
            .iter()
            .find(|(own, _)| own == id)
            .map(|(_, node)| node.clone())
    }

    /// A link with a conductance in W/K; none from a node to itself.
    pub fn link(&mut self, wanted: &str, one: &str, other: &str, conductance: f64) {
        self.law(wanted, one, other, json!({ "conductance": number(conductance) }));
    }

    /// A link with the keys that make its law.
    pub fn law(&mut self, wanted: &str, one: &str, other: &str, mut keys: Value) {
        if one == other {
            return;
        }
        keys["between"] = json!([one, other]);
        self.links.insert(free(&self.links, wanted, "link"), keys);
    }

    /// Heat from elsewhere in W.
    pub fn source(&mut self, id: &str, heat: f64, into: &str) {
        self.sources
            .insert(id.to_owned(), json!({ "heat": heat, "into": into }));
    }

    /// The network as one writes it.
    pub fn written(self) -> Value {
        json!({ "nodes": self.nodes, "links": self.links, "sources": self.sources })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_free_and_numbers_short() {
        let mut lay = Lay::default();
        assert_eq!(lay.node("a", "shaft", 1.0), "a");
        assert_eq!(lay.node("a", "bearing", 1.0), "a_bearing");
        assert_eq!(lay.node("a", "bearing", 1.0), "a_bearing_2");
        assert_eq!(lay.node("ambient", "shaft", 1.0), "ambient_shaft");
        assert_eq!(number(1234.567), json!(1235.0));
        lay.link("self", "a", "a", 1.0);
        lay.link("l", "a", "a_bearing", 1.53);
        lay.link("l", "a", "a_bearing", 2.0);
        let written = lay.written();
        assert_eq!(
            written["links"],
            json!({ "l": { "conductance": 1.53, "between": ["a", "a_bearing"] },
                    "l_link": { "conductance": 2.0, "between": ["a", "a_bearing"] } })
        );
    }
}
