//! Model contexts at a solved point, and the torque balance of each member.

use super::{PartLoss, Solution};
use crate::attach::State;
use crate::document::Unit;
use crate::flow::Drive;
use crate::loss::Notebook;
use crate::mechanism::Mechanism;
use crate::mechanism::bevel_mesh::BevelMesh;
use crate::mechanism::crossed_helical_mesh::CrossedHelicalMesh;
use crate::mechanism::gear_drag::GearDrag;
use crate::mechanism::gear_mesh::GearMesh;
use crate::mechanism::worm_mesh::WormMesh;
use crate::transmission::{PartKind, RowName};

/// One quantity of a context.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Name.
    pub name: &'static str,
    /// Unit of the value.
    pub unit: &'static Unit,
    /// Value in that unit.
    pub value: f64,
}

/// All quantities of a context, in their documented units.
pub(crate) fn readings<M: Mechanism>(at: &M::At<'_, f64>) -> Vec<Reading> {
    let of = |q: &crate::mechanism::Quantity<M>| Reading {
        name: q.name,
        unit: q.unit,
        value: q.unit.from_si((q.get)(at)),
    };
    M::QUANTITIES.iter().map(of).collect()
}

/// Torques on one member; they balance. \[Nm\]
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MemberTorques {
    /// From ports, and from supports that hold a stationary member.
    pub ports: f64,
    /// From meshes, chains, joints and differentials, including their friction.
    pub meshes: f64,
    /// From drag of components and gears.
    pub drags: f64,
}

impl MemberTorques {
    /// The residual; zero to rounding. \[Nm\]
    pub fn residual(&self) -> f64 {
        self.ports + self.meshes + self.drags
    }
}

impl Solution<'_> {
    /// What the models read at this point.
    pub(super) fn state(&self) -> State<'_> {
        self.scratch.models.conditions.open(false).0
    }

    /// The context of the model of a part, one copy.
    pub fn readings(&self, part: usize) -> Vec<Reading> {
        let t = self.transmission;
        let state = self.state();
        match t.parts[part].kind {
            PartKind::Component(i) => t.components[i].placed.readings(&state),
            PartKind::Mesh(i) => {
                let bevel = self.bevel_mesh_at(i).map(|at| readings::<BevelMesh>(&at));
                let worm = || self.worm_mesh_at(i).map(|at| readings::<WormMesh>(&at));
                let helical = || {
                    self.crossed_helical_mesh_at(i)
                        .map(|at| readings::<CrossedHelicalMesh>(&at))
                };
                let cylindrical = || self.mesh_at(i).map(|at| readings::<GearMesh>(&at));
                bevel
                    .or_else(worm)
                    .or_else(helical)
                    .or_else(cylindrical)
                    .unwrap_or_default()
            }
            PartKind::Drag(i) => readings::<GearDrag>(&t.drag_at(i, &state, &Notebook::CLOSED)),
            PartKind::Transfer(i) => self.transfer_readings(i),
        }
    }

    /// Loss of one part by number.
    pub fn part(&self, part: usize) -> PartLoss {
        self.transmission
            .part_loss(&self.transmission.parts[part], self.scratch)
    }

    /// Torques on every member. With ideal power flow losses change no torque, so friction and drag are zero.
    pub fn member_torques(&self) -> Vec<MemberTorques> {
        let (t, work) = (self.transmission, &self.scratch.work);
        let state = &t.states[self.case.state];
        let mut torques = vec![MemberTorques::default(); t.members.len()];
        for (i, own) in torques.iter_mut().enumerate() {
            own.ports = work.ports[i];
            own.drags = work.drags[i];
        }
        for ((row, name), multiplier) in state.train.rows.iter().zip(&state.rows).zip(&work.multipliers) {
            for (column, coefficient) in &row.terms {
                if let Some(own) = torques.get_mut(*column) {
                    let torque = coefficient * multiplier;
                    match name {
                        RowName::Wheel(_) => own.ports += torque,
                        RowName::Path(_) | RowName::Equal(_) | RowName::Ratio(_) => own.meshes += torque,
                    }
                }
            }
        }
        if self.scratch.ideal {
            return torques;
        }
        for (k, mesh) in state.meshes.iter().enumerate() {
            // The driven gear loses torque against its motion in the carrier's frame; the carrier takes the reaction.
            let (driven, side) = match work.drives[k] {
                Drive::Second => (mesh.first, 1),
                Drive::First | Drive::Neither => (mesh.second, 0),
            };
            let relative = work.relative[k][side];
            if relative == 0.0 || work.mesh_loss[k] == 0.0 {
                continue;
            }
            let torque = work.mesh_loss[k] / relative;
            if let Some(own) = driven.and_then(|d| torques.get_mut(d)) {
                own.meshes -= torque;
            }
            if let Some(own) = mesh.carrier.and_then(|c| torques.get_mut(c)) {
                own.meshes += torque;
            }
        }
        torques
    }
}
