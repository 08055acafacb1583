//! Losses of chains, joints and differentials: rows with friction that are no gear meshes.

use super::scratch::Models;
use super::{Solution, accepted, readings};
use crate::attach::{Oil, State};
use crate::evaluate::Reading;
use crate::flow::{Drive, FlowState};
use crate::loss::{Loss, Notebook, Notes, Undefined};
use crate::mechanism::chain::{Chain, ChainAt, ChainPart};
use crate::mechanism::differential::{Differential, DifferentialAt, DifferentialPart};
use crate::mechanism::joint::{Joint, JointAt, JointPart};
use crate::mechanism::{Answers, with_oil};
use crate::real::{Points, Real};
use crate::transmission::{Case, Transfer, TransferLaw, Transmission};

/// The side of a row that drives, its torque and speed in the frame of its carrier, and the ratio of both sides.
struct Side<R> {
    torque: R,
    speed: R,
    first_drives: R,
    ratio: f64,
}

impl Transmission {
    /// Evaluates the law of a row at the torques of the flow.
    #[inline(always)]
    pub(super) fn lose_at_transfer<R: Answers>(
        &self,
        case: &Case,
        index: usize,
        flow: &mut FlowState<'_, R>,
        m: &mut Models<R>,
        notes: bool,
    ) {
        let transfer = &self.transfers[index];
        if transfer.law.is_off() {
            return;
        }
        let number = self.meshes.len() + index;
        let torque = self.transfer_torque(case, index, flow.multipliers);
        m.conditions.live = *flow.live;
        let (state, book) = m.conditions.open(notes);
        book.clear(transfer.law.notes());
        let drives = flow.drives[number];
        let answer = self.transfer_loss(case, (index, torque, drives), &state, &book, flow.live);
        let speed = transfer_speed(transfer, state.speeds);
        flow.mesh_loss[number] = match &answer {
            Ok(loss) => {
                let watts = loss.total_watts(speed) * transfer.loss_factor;
                R::select(
                    speed.is_zero(),
                    R::ZERO,
                    watts * self.transfer_grip(transfer, state.speeds),
                )
            }
            Err(_) => R::ZERO,
        };
        m.transfer_losses[index] = answer;
    }

    /// Torque on the first side of a row. \[Nm\]
    #[inline(always)]
    pub(super) fn transfer_torque<R: Real>(&self, case: &Case, index: usize, multipliers: &[R]) -> R {
        let row = &case.flow.meshes()[self.meshes.len() + index];
        multipliers[row.row] * row.z1
    }

    /// The answer of the law of a row at a torque on its first side.
    #[inline(always)]
    pub(super) fn transfer_loss<R: Answers>(
        &self,
        case: &Case,
        (index, torque, drives): (usize, R, Drive),
        state: &State<'_, R>,
        book: &Notebook<'_, R>,
        live: &mut R::Mask,
    ) -> Result<Loss<R>, Undefined> {
        state.count_call(*live);
        let transfer = &self.transfers[index];
        let side = self.side(case, (index, torque, drives), state);
        let answer = match &transfer.law {
            TransferLaw::Chain(part, model) => {
                let oil = state.oils[transfer.oil as usize];
                R::answer::<Chain>(&**model, &chain_at(part, &side, &oil, book.notes(model.notes)))
            }
            TransferLaw::Joint(part, model) => {
                R::answer::<Joint>(&**model, &joint_at(part, &side, book.notes(model.notes)))
            }
            TransferLaw::Differential(part, model) => {
                let (oil, case_speed) = (state.oils[transfer.oil as usize], carrier_speed(transfer, state.speeds));
                let notes = book.notes(model.notes);
                R::answer::<Differential>(&**model, &differential_at(part, &side, case_speed, &oil, notes))
            }
        };
        accepted(answer, R::ZERO, live)
    }

    #[inline(always)]
    fn side<R: Points>(
        &self,
        case: &Case,
        (index, torque, drives): (usize, R, Drive),
        state: &State<'_, R>,
    ) -> Side<R> {
        let row = &case.flow.meshes()[self.meshes.len() + index];
        Side {
            torque: torque.abs(),
            speed: transfer_speed(&self.transfers[index], state.speeds),
            first_drives: R::constant(f64::from(u8::from(drives != Drive::Second))),
            ratio: -row.sz2 / row.z1,
        }
    }

    /// Share of full friction: both sides of a differential rotate together with its case.
    #[inline(always)]
    pub(super) fn transfer_grip<R: Real>(&self, transfer: &Transfer, speeds: &[R]) -> R {
        self.grip(transfer_speed(transfer, speeds), carrier_speed(transfer, speeds))
    }
}

/// Speed of the first side of a row in the frame of its carrier; zero if it is rounding error. \[rad/s\]
#[inline(always)]
pub(super) fn transfer_speed<R: Real>(transfer: &Transfer, speeds: &[R]) -> R {
    let own = speeds[transfer.seat.members[0]];
    let carrier = carrier_speed(transfer, speeds);
    let rounding = own.abs().max(carrier.abs()) * 1e-12;
    R::select((own - carrier).abs().is_above(rounding), own - carrier, R::ZERO)
}

impl Solution<'_> {
    /// The context of the model of a row, with muted notes.
    pub(super) fn transfer_readings(&self, index: usize) -> Vec<Reading> {
        let (t, s, state) = (self.transmission, self.scratch, self.state());
        let transfer = &t.transfers[index];
        let drives = s.work.drives[t.meshes.len() + index];
        let torque = t.transfer_torque(self.case, index, &s.work.multipliers);
        let side = t.side(self.case, (index, torque, drives), &state);
        match &transfer.law {
            TransferLaw::Chain(part, _) => {
                let oil = state.oils[transfer.oil as usize];
                readings::<Chain>(&chain_at(part, &side, &oil, Notes::MUTED))
            }
            TransferLaw::Joint(part, _) => readings::<Joint>(&joint_at(part, &side, Notes::MUTED)),
            TransferLaw::Differential(part, _) => {
                let (oil, case_speed) = (state.oils[transfer.oil as usize], carrier_speed(transfer, state.speeds));
                readings::<Differential>(&differential_at(part, &side, case_speed, &oil, Notes::MUTED))
            }
        }
    }
}

/// Speed of the case of a differential; zero without one. \[rad/s\]
#[inline(always)]
fn carrier_speed<R: Real>(transfer: &Transfer, speeds: &[R]) -> R {
    transfer.seat.carrier.map_or(R::ZERO, |carrier| speeds[carrier])
}

#[inline(always)]
fn chain_at<'a, R: Points>(part: &'a ChainPart, side: &Side<R>, oil: &Oil<R>, notes: Notes<'a, R>) -> ChainAt<'a, R> {
    with_oil!(from oil, ChainAt {
        part,
        torque: side.torque,
        speed: side.speed,
        first_drives: side.first_drives,
        ratio: R::constant(side.ratio),
        notes,
    })
}

#[inline(always)]
fn joint_at<'a, R: Points>(part: &'a JointPart, side: &Side<R>, notes: Notes<'a, R>) -> JointAt<'a, R> {
    JointAt {
        part,
        torque: side.torque,
        speed: side.speed,
        first_drives: side.first_drives,
        angle: R::constant(part.angle),
        notes,
    }
}

#[inline(always)]
fn differential_at<'a, R: Points>(
    part: &'a DifferentialPart,
    side: &Side<R>,
    case_speed: R,
    oil: &Oil<R>,
    notes: Notes<'a, R>,
) -> DifferentialAt<'a, R> {
    with_oil!(of contacts from oil, DifferentialAt {
        part,
        torque: side.torque,
        speed: side.speed,
        left_drives: side.first_drives,
        case_speed,
        notes,
    })
}
