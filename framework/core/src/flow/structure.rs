//! The structure of equations: which unknown each determines, and which must be solved together.

/// An equation for each unknown, such that no two have the same; `None` if there is none. `equations` list their unknowns.
pub(super) fn matching(equations: &[Vec<(usize, f64)>]) -> Option<Vec<usize>> {
    let size = equations.len();
    let mut matched = vec![None; size];
    for start in 0..size {
        // The shortest chain of equations that take each other's unknown, to an unknown that is free.
        let mut reached_from = vec![None; size];
        let mut chain = vec![start];
        let mut next = 0;
        let mut free = None;
        while free.is_none() && next < chain.len() {
            let equation = chain[next];
            next += 1;
            for &(unknown, _) in &equations[equation] {
                if reached_from[unknown].is_some() {
                    continue;
                }
                reached_from[unknown] = Some(equation);
                let Some(other) = matched[unknown] else {
                    free = Some(unknown);
                    break;
                };
                chain.push(other);
            }
        }
        let mut unknown = free?;
        while let Some(equation) = reached_from[unknown] {
            matched[unknown] = Some(equation);
            let before = equations[equation]
                .iter()
                .find(|(other, _)| *other != unknown && matched[*other] == Some(equation));
            match before {
                Some((other, _)) => unknown = *other,
                None => break,
            }
        }
    }
    matched.into_iter().collect()
}

/// Sets of nodes that depend on each other (strongly connected components), each after those that it depends on, with the length of
/// the longest chain of sets before it; nodes are ascending. `reads` lists what each node depends on.
pub(super) fn components(reads: &[Vec<usize>]) -> Vec<(usize, Vec<usize>)> {
    // Nodes in the order in which all that they lead to is known (Kosaraju).
    let mut read_by = vec![Vec::new(); reads.len()];
    for (node, sources) in reads.iter().enumerate() {
        for source in sources {
            read_by[*source].push(node);
        }
    }
    let mut left = vec![true; reads.len()];
    let finished: Vec<usize> = (0..reads.len())
        .flat_map(|node| reached(node, &read_by, &mut left))
        .collect();
    left.fill(true);
    let mut set_of = vec![0; reads.len()];
    let mut sets: Vec<(usize, Vec<usize>)> = Vec::new();
    for node in finished.into_iter().rev() {
        let mut nodes = reached(node, reads, &mut left);
        if nodes.is_empty() {
            continue;
        }
        nodes.sort_unstable();
        for node in &nodes {
            set_of[*node] = sets.len();
        }
        let sources = nodes
            .iter()
            .flat_map(|node| &reads[*node])
            .map(|source| set_of[*source]);
        let level = sources
            .filter(|set| *set != sets.len())
            .map(|set| sets[set].0 + 1)
            .max();
        sets.push((level.unwrap_or(0), nodes));
    }
    sets.sort();
    sets
}

/// The nodes that are left and that a node leads to, each after those that it leads to; they are left no longer.
fn reached(start: usize, edges: &[Vec<usize>], left: &mut [bool]) -> Vec<usize> {
    let mut finished = Vec::new();
    let mut open = Vec::new();
    if std::mem::take(&mut left[start]) {
        open.push((start, 0));
    }
    while let Some((node, edge)) = open.last_mut() {
        if let Some(next) = edges[*node].get(*edge) {
            *edge += 1;
            if std::mem::take(&mut left[*next]) {
                open.push((*next, 0));
            }
        } else {
            finished.push(*node);
            open.pop();
        }
    }
    finished
}
