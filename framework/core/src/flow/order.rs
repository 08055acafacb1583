//! The order in which torques and losses are found.
//!
//! An equation of equilibrium determines one torque from others, from the drags on its member and from the losses of meshes whose driven
//! gear or carrier it is; a law reads a few torques. What depends on each other is a block; blocks are solved one after the other, so
//! that a law outside of a loop is evaluated once. The order depends on which gears are driven.

use super::linear::{eliminate, substitute};
use super::structure::components;
use super::system::{Driven, Flow, LoadedDrag};
use super::work::{Drive, Work};

/// Exponent with which losses of teeth are assumed to follow the torque: laws give 1 to 1.2, because mean friction hardly depends on the load.
const OF_TEETH: f64 = 1.05;
/// The same of bearings: their losses range from nearly independent of the load to proportional to it.
const OF_BEARINGS: f64 = 0.5;

/// Blocks, each after those that it depends on.
#[derive(Debug, Clone, Default)]
pub(super) struct Order {
    /// The driven gear of each mesh; `None` for the equations without laws.
    pub driven: Option<Vec<Driven>>,
    pub blocks: Vec<Block>,
}

/// Unknowns and laws that depend on each other; or only unknowns, or only laws.
#[derive(Debug, Clone, Default)]
pub(super) struct Block {
    /// The unknowns.
    pub unknowns: Vec<usize>,
    /// The equation of each.
    pub equations: Vec<Equation>,
    /// Factors of the equations for the unknowns, column by column, and the rows that were exchanged.
    pub factors: Vec<f64>,
    pub exchanged: Vec<usize>,
    /// Meshes whose multiplier is among the unknowns.
    pub rolling: Vec<usize>,
    pub laws: Laws,
    /// Of a loop: the laws as they act within it.
    pub feedback: Vec<Feedback>,
    /// Of a loop: the unknowns of which its laws are functions, by place among the unknowns.
    pub leads: Vec<usize>,
}

/// Laws by kind.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Laws {
    /// Meshes.
    pub meshes: Vec<usize>,
    /// Drags that depend on torques, as in [`Flow::drags`].
    pub drags: Vec<usize>,
}

/// A block as it is shown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FlowBlock {
    /// Rows whose multiplier is found.
    pub rows: Vec<usize>,
    /// Columns of ports whose torque is found.
    pub ports: Vec<usize>,
    /// Laws that are evaluated.
    pub laws: Laws,
    /// True if the laws depend on these torques.
    pub is_loop: bool,
}

/// One equation: what is known when the block is solved.
#[derive(Debug, Clone, Default)]
pub(super) struct Equation {
    pub number: usize,
    /// Earlier unknowns with coefficients.
    pub unknowns: Vec<(usize, f64)>,
    /// Earlier laws with what a unit of each adds.
    pub laws: Vec<(usize, f64)>,
    /// The same for laws of the block itself.
    pub own_laws: Vec<(usize, f64)>,
}

/// A law in a loop.
#[derive(Debug, Clone)]
pub(super) struct Feedback {
    pub law: usize,
    /// Change of each unknown of the block per unit of the law.
    pub response: Vec<f64>,
    /// The unknown that it depends on most: place among the leads.
    pub lead: usize,
    /// Other unknowns of the block that it depends on.
    pub others: Vec<usize>,
    /// What a unit of it takes from this unknown: one for a mesh, whose lost multiplier is part of its multiplier, and half of that for a steep one.
    pub gain: f64,
    /// Exponent with which it is assumed to follow this unknown before more is known.
    pub exponent: f64,
}

impl Order {
    /// The order for these driven gears; without them that of the equations without laws. `None` if the equations are singular.
    pub fn new(flow: &Flow, driven: Option<&[Driven]>) -> Option<Self> {
        let size = flow.equations.len();
        let acting = driven.map_or_else(|| vec![Vec::new(); size], |driven| flow.acting(driven));
        let mut reads: Vec<Vec<usize>> = Vec::new();
        for (unknown, &equation) in flow.matched.iter().enumerate() {
            let others = flow.equations[equation].iter().map(|(other, _)| *other);
            let laws = acting[equation].iter().map(|(law, _)| size + law);
            reads.push(others.filter(|other| *other != unknown).chain(laws).collect());
        }
        if driven.is_some() {
            reads.extend(flow.meshes.iter().map(|mesh| vec![mesh.row]));
            let first_drag = size + flow.meshes.len();
            for drag in &flow.drags {
                let torques = drag.reads.iter().filter_map(|reading| flow.unknown_of(*reading));
                let together = |other: &&LoadedDrag| drag.group.is_some() && other.group == drag.group;
                let group = flow.drags.iter().enumerate().filter(|(_, other)| together(other));
                reads.push(torques.chain(group.map(|(other, _)| first_drag + other)).collect());
            }
        }
        let mut blocks: Vec<Block> = Vec::new();
        let mut level_before = None;
        for (level, nodes) in components(&reads) {
            let (unknowns, laws) = nodes.split_at(nodes.partition_point(|node| *node < size));
            let laws: Vec<usize> = laws.iter().map(|node| node - size).collect();
            // Laws that wait for the same are evaluated together.
            match blocks.last_mut() {
                Some(last) if unknowns.is_empty() && last.unknowns.is_empty() && level_before == Some(level) => {
                    last.laws.extend(flow, &laws);
                }
                _ => blocks.push(Block::new(flow, unknowns, &laws, &acting)?),
            }
            level_before = Some(level);
        }
        Some(Self {
            driven: driven.map(<[Driven]>::to_vec),
            blocks,
        })
    }

    /// True if it is that of these driving gears.
    pub fn is_of(&self, drives: &[Drive]) -> bool {
        let driven = self.driven.as_ref();
        driven.is_some_and(|driven| driven.iter().copied().eq(drives.iter().map(|drive| drive.driven())))
    }
}

impl Block {
    fn new(flow: &Flow, unknowns: &[usize], laws: &[usize], acting: &[Vec<(usize, f64)>]) -> Option<Self> {
        let n = unknowns.len();
        let place = |unknown: &usize| unknowns.binary_search(unknown).ok();
        let mut block = Self {
            unknowns: unknowns.to_vec(),
            factors: vec![0.0; n * n],
            exchanged: vec![0; n],
            rolling: (0..flow.meshes.len())
                .filter(|mesh| place(&flow.meshes[*mesh].row).is_some())
                .collect(),
            ..Self::default()
        };
        block.laws.extend(flow, laws);
        for (i, unknown) in unknowns.iter().enumerate() {
            let number = flow.matched[*unknown];
            let mut equation = Equation {
                number,
                ..Equation::default()
            };
            for (other, coefficient) in &flow.equations[number] {
                match place(other) {
                    Some(j) => block.factors[j * n + i] = *coefficient,
                    None => equation.unknowns.push((*other, *coefficient)),
                }
            }
            let (own, earlier) = acting[number].iter().partition(|(law, _)| laws.contains(law));
            (equation.own_laws, equation.laws) = (own, earlier);
            block.equations.push(equation);
        }
        if !eliminate(&mut block.factors, &mut block.exchanged) {
            return None;
        }
        if n == 0 {
            return Some(block);
        }
        for law in laws {
            let mut response = vec![0.0; n];
            for (effect, equation) in response.iter_mut().zip(&block.equations) {
                *effect = equation
                    .own_laws
                    .iter()
                    .filter(|(own, _)| own == law)
                    .map(|own| own.1)
                    .sum();
            }
            substitute(&block.factors, &block.exchanged, &mut response);
            // A law of a loop reads at least one of its unknowns.
            let mut read = flow.read_by(*law).filter_map(|unknown| place(&unknown));
            let lead = read.next().unwrap_or_default();
            let others = read
                .filter(|other| *other != lead)
                .map(|other| unknowns[other])
                .collect();
            let lead = block.leads.iter().position(|other| *other == lead).unwrap_or_else(|| {
                block.leads.push(lead);
                block.leads.len() - 1
            });
            let mesh = flow.meshes.get(*law);
            block.feedback.push(Feedback {
                law: *law,
                gain: match mesh {
                    Some(mesh) if mesh.steep => 0.5,
                    Some(_) => 1.0,
                    None => response[block.leads[lead]].abs(),
                },
                exponent: if mesh.is_some() { OF_TEETH } else { OF_BEARINGS },
                response,
                lead,
                others,
            });
        }
        Some(block)
    }

    /// True if its laws depend on its unknowns.
    pub fn is_loop(&self) -> bool {
        !self.feedback.is_empty()
    }
}

impl Laws {
    fn extend(&mut self, flow: &Flow, laws: &[usize]) {
        for law in laws {
            match law.checked_sub(flow.meshes.len()) {
                Some(drag) => self.drags.push(drag),
                None => self.meshes.push(*law),
            }
        }
    }

    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.meshes.is_empty() && self.drags.is_empty()
    }
}

impl Flow {
    /// The blocks in their order for the driving gears of the flow without losses, at the speeds and given torques of the work.
    pub fn blocks(&self, work: &mut Work) -> Vec<FlowBlock> {
        self.ideal(work);
        let order = self.order(&work.drives);
        let blocks = order.iter().flat_map(|order| &order.blocks);
        let shown = blocks.map(|block| {
            let (rows, ports) = block
                .unknowns
                .split_at(block.unknowns.partition_point(|u| *u < self.rows));
            FlowBlock {
                rows: rows.to_vec(),
                ports: ports.iter().map(|port| self.unknown[port - self.rows]).collect(),
                laws: block.laws.clone(),
                is_loop: block.is_loop(),
            }
        });
        shown.collect()
    }

    /// For each equation the laws that act on it, with what a unit of each adds to its right-hand side.
    fn acting(&self, driven: &[Driven]) -> Vec<Vec<(usize, f64)>> {
        let mut acting = vec![Vec::new(); self.equations.len()];
        for (mesh, (sides, driven)) in self.friction.iter().zip(driven).enumerate() {
            for (equation, change) in &sides[*driven] {
                acting[*equation].push((mesh, *change));
            }
        }
        for (drag, own) in self.drags.iter().enumerate() {
            for (column, sign) in own.between.iter().zip([1.0, -1.0]) {
                if let Some(column) = column {
                    acting[*column].push((self.meshes.len() + drag, sign));
                }
            }
        }
        acting
    }

    /// Unknowns that a law reads, the most important first.
    fn read_by(&self, law: usize) -> impl Iterator<Item = usize> {
        let (row, reads) = match law.checked_sub(self.meshes.len()) {
            None => (Some(self.meshes[law].row), &[][..]),
            Some(drag) => (None, &self.drags[drag].reads[..]),
        };
        row.into_iter()
            .chain(reads.iter().filter_map(|reading| self.unknown_of(*reading)))
    }
}
