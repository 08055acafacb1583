//! Faults of a thermal network that leave temperatures undetermined.

use crate::codes;
use crate::document::Diagnostic;

/// Names, capacities and connections of a network.
pub struct Shape<'a> {
    /// Names of the nodes.
    pub names: &'a [String],
    /// Heat capacities. \[J/K\]
    pub capacities: &'a [f64],
    /// True for nodes with prescribed temperature.
    pub held: Vec<bool>,
    /// Links.
    pub links: Vec<[usize; 2]>,
    /// Flows and heat exchangers, downstream.
    pub flows: Vec<[usize; 2]>,
    /// Nodes after heat exchangers, which depend on a coolant.
    pub cooled: Vec<usize>,
}

/// Finds isolated nodes, and loops of oil without heat capacity.
pub fn check(shape: &Shape<'_>, found: &mut Vec<Diagnostic>) {
    let at = |node: usize| format!("thermal.network.nodes.{}", shape.names[node]);
    let mut fixed: Vec<bool> = shape.held.clone();
    for node in &shape.cooled {
        fixed[*node] = true;
    }
    // The nodes that determine a node: both ends of its links, and the sources of its incoming flows.
    loop {
        let mut more = false;
        for (ends, both) in shape
            .links
            .iter()
            .map(|l| (l, true))
            .chain(shape.flows.iter().map(|f| (f, false)))
        {
            let [a, b] = *ends;
            if fixed[a] && !fixed[b] {
                fixed[b] = true;
                more = true;
            }
            if both && fixed[b] && !fixed[a] {
                fixed[a] = true;
                more = true;
            }
        }
        if !more {
            break;
        }
    }
    for (node, _) in fixed.iter().enumerate().filter(|(_, fixed)| !**fixed) {
        found.push(
            Diagnostic::error(
                at(node),
                format!("no path leads from `{}` to a prescribed temperature", shape.names[node]),
            )
            .code(codes::NO_HEAT_PATH)
            .help("link it to a neighbour, to `ambient`, or to a heat exchanger, or give it a `temperature`"),
        );
    }
    if let Some(ring) = empty_loop(shape) {
        let names: Vec<&str> = ring.iter().map(|node| shape.names[*node].as_str()).collect();
        found.push(
            Diagnostic::error(
                at(ring[0]),
                format!("oil flows in a loop without heat capacity: {}", names.join(", ")),
            )
            .help("state a `heat_capacity`, mass times specific heat, for the oil of one of these nodes")
            .code(codes::NO_HEAT_PATH),
        );
    }
}

/// A loop of flows whose nodes all have no heat capacity and no prescribed temperature.
fn empty_loop(shape: &Shape<'_>) -> Option<Vec<usize>> {
    let empty = |node: usize| shape.capacities[node] == 0.0 && !shape.held[node];
    (0..shape.names.len()).filter(|node| empty(*node)).find_map(|start| {
        let mut way = vec![start];
        let mut seen = vec![false; shape.names.len()];
        loop_from(shape, start, &mut way, &mut seen, &empty).then_some(way)
    })
}

/// Follows flows downstream from the end of a path until it returns to its start.
fn loop_from(
    shape: &Shape<'_>,
    start: usize,
    way: &mut Vec<usize>,
    seen: &mut [bool],
    empty: &dyn Fn(usize) -> bool,
) -> bool {
    let here = way[way.len() - 1];
    for [_, next] in shape.flows.iter().filter(|[from, _]| *from == here) {
        if *next == start {
            return true;
        }
        if seen[*next] || !empty(*next) {
            continue;
        }
        seen[*next] = true;
        way.push(*next);
        if loop_from(shape, start, way, seen, empty) {
            return true;
        }
        way.pop();
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(capacities: &[f64], links: &[[usize; 2]], flows: &[[usize; 2]], cooled: &[usize]) -> Vec<String> {
        let names: Vec<String> = (0..capacities.len()).map(|i| format!("n{i}")).collect();
        let mut held = vec![false; names.len()];
        held[0] = true;
        let shape = Shape {
            names: &names,
            capacities,
            held,
            links: links.to_vec(),
            flows: flows.to_vec(),
            cooled: cooled.to_vec(),
        };
        let mut found = Vec::new();
        check(&shape, &mut found);
        found
            .into_iter()
            .map(|d| format!("{}: {}", d.path, d.message))
            .collect()
    }

    #[test]
    fn a_node_without_a_path_is_named() {
        let lost = found(&[0.0, 1.0, 1.0, 1.0], &[[0, 1], [2, 3]], &[], &[]);
        assert_eq!(lost.len(), 2);
        assert_eq!(
            lost[0],
            "thermal.network.nodes.n2: no path leads from `n2` to a prescribed temperature"
        );
        // Flows carry heat downstream only: an incoming flow determines a temperature, an outgoing one does not.
        assert_eq!(found(&[0.0, 1.0], &[], &[[1, 0]], &[]).len(), 1);
        assert!(found(&[0.0, 1.0], &[], &[[0, 1]], &[]).is_empty());
        assert!(found(&[0.0, 1.0, 0.0], &[], &[[1, 2], [2, 1]], &[2]).is_empty());
    }

    #[test]
    fn a_loop_without_capacity_is_named() {
        let loops = found(&[0.0; 4], &[[0, 1]], &[[1, 2], [2, 3], [3, 1]], &[]);
        assert_eq!(
            loops,
            ["thermal.network.nodes.n1: oil flows in a loop without heat capacity: n1, n2, n3"]
        );
        assert!(found(&[0.0, 0.0, 5.0, 0.0], &[[0, 1]], &[[1, 2], [2, 3], [3, 1]], &[]).is_empty());
    }
}
