//! The order in which the torques and losses of each gear are found, in words.

use std::fmt;

use super::states::RowName;
use super::{Case, PartKind, Transmission};
use crate::flow::FlowBlock;

/// How torques and losses are found in a gear.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, schemars::JsonSchema)]
pub struct TorqueOrder {
    /// Gear.
    pub gear: String,
    /// Ports whose torque is given.
    pub torque_at: Vec<String>,
    /// True if these torques drive, false if they brake.
    pub drives: bool,
    /// What is found one after the other.
    pub blocks: Vec<TorqueBlock>,
}

/// Torques and losses that are found together.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, schemars::JsonSchema)]
pub struct TorqueBlock {
    /// Meshes, chains, couplings, joints, differentials and ports whose torque is found.
    pub torques: Vec<String>,
    /// Components whose loss depends on torques and is found.
    pub losses: Vec<String>,
    /// True if these torques and losses depend on each other, so that the losses are evaluated repeatedly.
    pub is_loop: bool,
}

impl fmt::Display for TorqueOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sense = if self.drives { "drive" } else { "brake" };
        writeln!(
            f,
            "{}, torques at {} that {sense}:",
            self.gear,
            self.torque_at.join(", ")
        )?;
        let mut once = Vec::new();
        let flush = |f: &mut fmt::Formatter<'_>, once: &mut Vec<&str>| {
            let losses = std::mem::take(once);
            if losses.is_empty() {
                return Ok(());
            }
            writeln!(f, "  once: {}", losses.join(", "))
        };
        for block in &self.blocks {
            if block.is_loop {
                flush(f, &mut once)?;
                let (torques, losses) = (block.torques.join(", "), block.losses.join(", "));
                writeln!(f, "  loop: {losses} with the torque of {torques}")?;
            } else {
                once.extend(block.losses.iter().map(String::as_str));
            }
        }
        flush(f, &mut once)
    }
}

impl Transmission {
    /// How torques and losses are found in each gear, with torques given at the first ports that drive at positive speeds, and that brake.
    pub fn torque_orders(&self) -> Vec<TorqueOrder> {
        let mut orders = Vec::new();
        for (number, state) in self.states.iter().enumerate() {
            let reference = self.reference_port();
            let others = (0..self.ports.len()).filter(|port| *port != reference);
            let ports = std::iter::once(reference)
                .chain(others)
                .take(self.torques_needed(number));
            let torque_at: Vec<&str> = ports.map(|port| self.ports[port].name.as_str()).collect();
            // In a gear that connects no ports all torques follow from drags; gears that need another choice have no order to show.
            let Ok(case) = self.case(&state.name, &[], &torque_at) else {
                continue;
            };
            if torque_at.is_empty() {
                continue;
            }
            orders.extend([1.0, -1.0].map(|sign| TorqueOrder {
                gear: state.name.clone(),
                torque_at: torque_at.iter().map(|port| (*port).to_owned()).collect(),
                drives: sign > 0.0,
                blocks: self.torque_blocks(&case, sign),
            }));
        }
        orders
    }

    /// The blocks where all given speeds are positive and all given torques have a sign.
    fn torque_blocks(&self, case: &Case, sign: f64) -> Vec<TorqueBlock> {
        let mut work = case.flow.work::<f64>();
        work.speeds = self.speeds(case, &vec![1.0; case.speed_ports.len()]);
        work.given.fill(sign);
        let state = &self.states[case.state];
        let row = |row: usize| match &state.rows[row] {
            RowName::Path(path) | RowName::Equal(path) | RowName::Ratio(path) => path.clone(),
            RowName::Wheel(wheel) => format!("wheel {wheel}"),
        };
        let port = |column: usize| {
            let port = self.ports.iter().find(|port| port.member == column);
            port.map_or_else(
                || format!("the holding torque of {}", self.members[column]),
                |port| format!("port {}", port.name),
            )
        };
        let path = |kind: PartKind| {
            let part = self.parts.iter().find(|part| part.kind == kind);
            part.map_or_else(String::new, |part| part.path.clone())
        };
        let named = |block: FlowBlock| {
            let rows = block.rows.into_iter().map(row);
            let meshes = block.laws.meshes.iter().map(|mesh| path(self.kind_of_row(*mesh)));
            let component = |drag: &usize| PartKind::Component(case.flow.drags()[*drag].component);
            let components = block.laws.drags.iter().map(component).map(path);
            TorqueBlock {
                torques: rows.chain(block.ports.into_iter().map(port)).collect(),
                losses: meshes.chain(components).collect(),
                is_loop: block.is_loop,
            }
        };
        case.flow.blocks(&mut work).into_iter().map(named).collect()
    }
}
