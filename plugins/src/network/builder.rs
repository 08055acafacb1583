//! Builds a thermal network in its written form: generates unique names and rounds numbers.

use serde_json::{Map, Value, json};

/// Nodes and links added so far.
#[derive(Default)]
pub struct NetworkBuilder {
    nodes: Map<String, Value>,
    links: Map<String, Value>,
    sources: Map<String, Value>,
    /// Shafts and idler gears with their nodes.
    members: Vec<(String, String)>,
    /// Gears with their nodes.
    gears: Vec<(String, String)>,
}

/// A unique name: the preferred one, else with the kind appended, else with a number.
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

/// A number rounded to four digits, as many as an assumed value justifies.
pub fn number(value: f64) -> Value {
    json!(format!("{value:.3e}").parse::<f64>().unwrap_or(value))
}

impl NetworkBuilder {
    /// Adds a node with a heat capacity in J/K and returns its name.
    pub fn node(&mut self, wanted: &str, what: &str, capacity: f64) -> String {
        let name = free(&self.nodes, wanted, what);
        self.nodes
            .insert(name.clone(), json!({ "heat_capacity": number(capacity) }));
        name
    }

    /// Assigns the oil of the housing to a node.
    pub fn oil(&mut self, node: &str) {
        self.nodes[node]["oil"] = json!(true);
    }

    /// Assigns a shaft or an idler gear to a node.
    pub fn member(&mut self, id: &str, node: &str) {
        self.members.push((id.to_owned(), node.to_owned()));
    }

    /// Assigns the body of a gear to a node.
    pub fn gear(&mut self, id: &str, node: &str) {
        self.push(node, "gears", id);
        self.gears.push((id.to_owned(), node.to_owned()));
    }

    /// Assigns a part as heat source of a node.
    pub fn part(&mut self, node: &str, path: &str) {
        self.push(node, "parts", path);
    }

    /// Assigns a node as the oil temperature of a part.
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

    /// The node of a shaft or an idler gear.
    pub fn of_member(&self, id: &str) -> Option<String> {
        self.members
            .iter()
            .find(|(known, _)| known == id)
            .map(|(_, node)| node.clone())
    }

    /// The node of a gear.
    pub fn of_gear(&self, id: &str) -> Option<String> {
        self.gears
            .iter()
            .find(|(known, _)| known == id)
            .map(|(_, node)| node.clone())
    }

    /// Adds a link with a conductance in W/K; none from a node to itself.
    pub fn link(&mut self, wanted: &str, one: &str, other: &str, conductance: f64) {
        self.law(wanted, one, other, json!({ "conductance": number(conductance) }));
    }

    /// Adds a link with the keys of its model.
    pub fn law(&mut self, wanted: &str, one: &str, other: &str, mut keys: Value) {
        if one == other {
            return;
        }
        keys["between"] = json!([one, other]);
        self.links.insert(free(&self.links, wanted, "link"), keys);
    }

    /// Adds a heat source in W.
    pub fn source(&mut self, id: &str, heat: f64, into: &str) {
        self.sources
            .insert(id.to_owned(), json!({ "heat": heat, "into": into }));
    }

    /// The network in its written form.
    pub fn written(self) -> Value {
        json!({ "nodes": self.nodes, "links": self.links, "sources": self.sources })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_free_and_numbers_short() {
        let mut builder = NetworkBuilder::default();
        assert_eq!(builder.node("a", "shaft", 1.0), "a");
        assert_eq!(builder.node("a", "bearing", 1.0), "a_bearing");
        assert_eq!(builder.node("a", "bearing", 1.0), "a_bearing_2");
        assert_eq!(builder.node("ambient", "shaft", 1.0), "ambient_shaft");
        assert_eq!(number(1234.567), json!(1235.0));
        builder.link("self", "a", "a", 1.0);
        builder.link("l", "a", "a_bearing", 1.53);
        builder.link("l", "a", "a_bearing", 2.0);
        let written = builder.written();
        assert_eq!(
            written["links"],
            json!({ "l": { "conductance": 1.53, "between": ["a", "a_bearing"] },
                    "l_link": { "conductance": 2.0, "between": ["a", "a_bearing"] } })
        );
    }
}
