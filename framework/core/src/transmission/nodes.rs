//! Thermal node of each part: for its oil temperature, and for its heat.

use crate::attach::dangling;
use crate::description::{GearboxEntry, NetworkChoice, NetworkEntry, NodeEntry};
use crate::document::{Diagnostic, did_you_mean};

/// Destination of the heat of a part.
#[derive(Debug, Clone, PartialEq)]
pub enum HeatPath {
    /// Equal shares into these nodes.
    Nodes(Vec<usize>),
    /// The nodes of both gears of a mesh, with the split of its model.
    Gears([usize; 2]),
}

/// Assignment of nodes to parts, by patterns; `ambient` is the first node.
#[derive(Debug, Clone, Default)]
pub(crate) struct NodeNames {
    names: Vec<String>,
    /// Pattern and node: parts whose heat enters the node.
    heated: Vec<(String, usize)>,
    /// Pattern and node: parts whose oil has the temperature of the node.
    oiled: Vec<(String, usize)>,
    /// Gear and node.
    gears: Vec<(String, usize)>,
    /// The oil of all parts that are not listed.
    oil: usize,
}

/// Name of the ambient node, which every network has.
pub const AMBIENT: &str = "ambient";

impl NodeNames {
    /// The nodes of a description; without a network no part has a node.
    pub fn new(entry: &GearboxEntry, found: &mut Vec<Diagnostic>) -> Self {
        let Some(NetworkChoice::Written(network)) = &entry.thermal.network else {
            return Self::default();
        };
        let mut names = Self {
            names: std::iter::once(AMBIENT.to_owned())
                .chain(network.nodes.ids().map(str::to_owned))
                .collect(),
            ..Self::default()
        };
        let mut oil = None;
        for (i, (id, node)) in network.nodes.iter().enumerate() {
            let path = format!("thermal.network.nodes.{id}");
            if id == AMBIENT {
                found.push(
                    Diagnostic::error(
                        path.clone(),
                        "`ambient` is reserved for the node at the temperature `thermal.ambient`",
                    )
                    .help("rename the node"),
                );
            }
            let before = names.gears.len();
            names.add(i + 1, node);
            for gear in &node.gears {
                if let Some((_, first)) = names.gears[..before].iter().find(|(known, _)| known == gear) {
                    let first = names.names[*first].clone();
                    found.push(
                        Diagnostic::error(
                            format!("{path}.gears"),
                            format!("`{gear}` already belongs to `{first}`"),
                        )
                        .help("list each gear for one node only"),
                    );
                }
                if entry.gears.get(gear).is_none() {
                    let ids: Vec<&str> = entry.gears.ids().collect();
                    found.push(dangling(&format!("{path}.gears"), "gear", gear, &ids));
                }
            }
            if node.oil
                && let Some(first) = oil.replace(id)
            {
                found.push(
                    Diagnostic::error(format!("{path}.oil"), format!("`{first}` is already the oil"))
                        .help("write `oil: true` for one node, and list parts under `oil_of` of the others"),
                );
            }
        }
        match oil.and_then(|id| names.node(id)) {
            Some(node) => names.oil = node,
            None => found.push(
                Diagnostic::error("thermal.network.nodes", "no node is the oil of the housing")
                    .help("write `oil: true` for the sump node"),
            ),
        }
        names
    }

    fn add(&mut self, node: usize, entry: &NodeEntry) {
        self.heated
            .extend(entry.parts.iter().map(|pattern| (pattern.clone(), node)));
        self.oiled
            .extend(entry.oil_of.iter().map(|pattern| (pattern.clone(), node)));
        self.gears.extend(entry.gears.iter().map(|gear| (gear.clone(), node)));
    }

    /// Number of a node by its name.
    pub fn node(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| known == name)
    }

    /// Names of all nodes.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The node whose temperature the oil of a part has; the first one without a network.
    pub fn of_oil(&self, path: &str) -> usize {
        let first = |list: &[(String, usize)]| {
            list.iter()
                .find(|(pattern, _)| meets(pattern, path))
                .map(|(_, node)| *node)
        };
        first(&self.oiled).or_else(|| first(&self.heated)).unwrap_or(self.oil)
    }

    /// The node of a gear's body.
    pub fn of_gear(&self, id: &str) -> Option<usize> {
        self.gears.iter().find(|(gear, _)| gear == id).map(|(_, node)| *node)
    }

    /// The nodes of both gears of a mesh, if both have one and the mesh is not listed under `parts`.
    pub fn bodies(&self, path: &str, gears: [&str; 2]) -> Option<[usize; 2]> {
        if self.heated.iter().any(|(pattern, _)| meets(pattern, path)) {
            return None;
        }
        Some([self.of_gear(gears[0])?, self.of_gear(gears[1])?])
    }

    /// Destination of the heat of a part that is not a mesh with two nodes: the nodes that list it, else the oil.
    pub fn heat(&self, path: &str) -> HeatPath {
        let mut nodes: Vec<usize> = self
            .heated
            .iter()
            .filter(|(pattern, _)| meets(pattern, path))
            .map(|(_, node)| *node)
            .collect();
        nodes.dedup();
        if nodes.is_empty() {
            nodes.push(self.of_oil(path));
        }
        HeatPath::Nodes(nodes)
    }
}

/// Patterns under `parts` and `oil_of` that match no part, with the path of their list.
pub(crate) fn unmet(network: &NetworkEntry, parts: &[&str], found: &mut Vec<Diagnostic>) {
    for (id, node) in network.nodes.iter() {
        for (key, patterns) in [("parts", &node.parts), ("oil_of", &node.oil_of)] {
            for pattern in patterns.iter().filter(|p| !parts.iter().any(|part| meets(p, part))) {
                found.push(
                    Diagnostic::error(
                        format!("thermal.network.nodes.{id}.{key}"),
                        format!("`{pattern}` matches no part with a loss"),
                    )
                    .note(format!("available: {}", parts.join(", ")))
                    .help(match did_you_mean(pattern, parts.iter().copied()) {
                        Some(close) => format!("write `{close}`"),
                        None => "write a part, such as `bearings.B1` or `meshes.*`".to_owned(),
                    }),
                );
            }
        }
    }
}

/// True if a pattern matches a path or one above it: `gears.G1` matches `gears.G1.drag.churning`.
fn meets(pattern: &str, path: &str) -> bool {
    let mut keys = path.split('.');
    pattern
        .split('.')
        .all(|want| keys.next().is_some_and(|key| want == "*" || want == key))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_meet_what_lies_below_them() {
        assert!(meets("gears.G1", "gears.G1.drag.churning") && meets("gears.*.drag", "gears.G1.drag.churning"));
        assert!(meets("bearings.*", "bearings.B1") && !meets("bearings.B1", "bearings.B10"));
        assert!(!meets("gears.G1.drag", "gears.G1"));
    }
}
