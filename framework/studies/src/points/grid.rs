//! Points: every torque at every speed of a grid, or a list.

use std::sync::Arc;

use super::temperature::Found;
use super::{OilTemperature, Piece, UnitPoint, solve_pieces, take_points};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::PowerFlow;
use gearloss_framework::flow::Status;
use gearloss_framework::loss::{Extent, MOST_TERMS, Undefined};
use gearloss_framework::machine::MachineState;
use gearloss_framework::thermal::Outcome as ThermalOutcome;
use gearloss_framework::transmission::{Case, Transmission};
use serde::{Deserialize, Serialize};

/// Points and their prescription.
#[derive(Debug, Clone)]
pub struct Points {
    /// Gear state.
    pub gear: String,
    /// Ports with given torque: that of the points at the first, zero at the others. Ports that the gear does not need are omitted.
    pub torque_at: Vec<String>,
    /// Ports with given speed: that of the points at the first; the others are stationary.
    pub speed_at: Vec<String>,
    /// Torques and speeds.
    pub field: Field,
    /// Oil temperature if the list gives none.
    pub oil: OilTemperature,
    /// Real or ideal flow.
    pub flow: PowerFlow,
    /// Whether losses are stored by term.
    pub terms: bool,
}

/// Torque and speed of one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Given {
    /// Torque. \[Nm\]
    pub torque: f64,
    /// Speed. \[rad/s\]
    pub speed: f64,
    /// Oil temperature at this point; absent: the common one. \[degC\]
    pub oil: Option<f64>,
}

impl Given {
    /// A point at a torque in Nm and a speed in rad/s, at the temperature of all points.
    pub fn new(torque: f64, speed: f64) -> Self {
        Self {
            torque,
            speed,
            oil: None,
        }
    }

    fn on_grid(torques: &[f64], speeds: &[f64], place: usize) -> Self {
        Self {
            torque: torques[place / speeds.len()],
            speed: speeds[place % speeds.len()],
            oil: None,
        }
    }
}

/// Torques and speeds of many points.
#[derive(Debug, Clone, PartialEq)]
pub enum Field {
    /// Every torque at every speed; speeds vary fastest.
    Grid {
        /// Torques. \[Nm\]
        torques: Vec<f64>,
        /// Speeds. \[rad/s\]
        speeds: Vec<f64>,
    },
    /// Some positions of such a grid.
    Part {
        /// Torques. \[Nm\]
        torques: Vec<f64>,
        /// Speeds. \[rad/s\]
        speeds: Vec<f64>,
        /// Indices of the positions, ascending.
        places: Arc<[u32]>,
    },
    /// A list.
    List(Vec<Given>),
}

impl Field {
    /// Number of points.
    pub fn len(&self) -> usize {
        match self {
            Self::Grid { torques, speeds } => torques.len() * speeds.len(),
            Self::Part { places, .. } => places.len(),
            Self::List(list) => list.len(),
        }
    }

    /// True without points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A point by its index.
    ///
    /// # Panics
    /// If the index is out of bounds: a bug of the caller.
    pub fn given_point(&self, i: usize) -> Given {
        match self {
            Self::Grid { torques, speeds } => Given::on_grid(torques, speeds, i),
            Self::Part {
                torques,
                speeds,
                places,
            } => Given::on_grid(torques, speeds, places[i] as usize),
            Self::List(list) => list[i],
        }
    }

    /// Torques and speeds of a grid; absent for a list.
    pub fn axes(&self) -> Option<[&[f64]; 2]> {
        match self {
            Self::Grid { torques, speeds } | Self::Part { torques, speeds, .. } => Some([torques, speeds]),
            Self::List(_) => None,
        }
    }

    /// The position on the grid of a point by its index; the index itself for a list.
    pub fn place(&self, i: usize) -> usize {
        match self {
            Self::Part { places, .. } => places[i] as usize,
            _ => i,
        }
    }
}

/// One solved point, as numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PointResult {
    /// Given torque. \[Nm\]
    pub torque: f64,
    /// Given speed. \[rad/s\]
    pub speed: f64,
    /// Speed of the port with given torque; zero if there is none. \[rad/s\]
    pub torque_speed: f64,
    /// Speed of the reference port. \[rad/s\]
    pub reference_speed: f64,
    /// Speed of the other port, if there are two. \[rad/s\]
    pub output_speed: Option<f64>,
    /// Whether the torque is given at the reference port.
    pub at_reference: bool,
    /// Oil temperature; absent if no balance was found, like everything that depends on it. \[degC\]
    pub oil: Option<f64>,
    /// Surface temperature if found by heat balance. \[degC\]
    pub surface: Option<f64>,
    /// Status of the heat balance if the temperature is not given.
    pub balance: Option<ThermalOutcome>,
    /// Temperatures of the nodes of a thermal network; empty without one. \[degC\]
    pub nodes: Vec<f64>,
    /// State of the transmission.
    pub status: Status,
    /// Output power over input power.
    pub efficiency: Option<f64>,
    /// Sum of all losses. \[W\]
    pub loss: Option<f64>,
    /// Loss over the speed of the reference port. \[Nm\]
    pub loss_torque: Option<f64>,
    /// Input power. \[W\]
    pub input: Option<f64>,
    /// Output power. \[W\]
    pub output: Option<f64>,
    /// The usual sums, in the order of [`super::SUMS`]. \[W\]
    pub sums: [f64; 6],
    /// Losses of all components, in order. \[W\]
    pub parts: Vec<f64>,
    /// The same by the terms of their models, if requested. \[W\]
    pub terms: Vec<[f64; MOST_TERMS]>,
    /// The active machines; empty without any, and without a temperature or a power flow.
    pub machines: Vec<MachineState>,
    /// True if a model is outside its stated range.
    pub outside: bool,
    /// Quantities that the study limits, in the order of its limits at points; NaN where one is unknown, empty without limits.
    pub limits: Vec<f64>,
    /// True if one of them is beyond its limit.
    pub beyond: bool,
    /// Why a loss has no value: index of the component and the reason.
    pub undefined: Option<(usize, Undefined)>,
    /// Number of iterations over the loss models.
    pub passes: usize,
}

impl PointResult {
    /// Adds how the temperature was found; without one, removes everything that depends on it.
    pub(super) fn set_temperature(&mut self, found: &Found) {
        self.surface = found.balance.as_ref().and_then(|b| b.surface);
        self.balance = found.outcome();
        if found.is_sound() {
            let network = found.network.as_ref();
            self.nodes = network.map(|n| n.temperatures.clone()).unwrap_or_default();
            return;
        }
        self.oil = None;
        self.efficiency = None;
        self.loss = None;
        self.loss_torque = None;
        self.input = None;
        self.output = None;
        self.sums = [0.0; 6];
        self.parts.fill(0.0);
        self.terms.clear();
        self.machines.clear();
    }

    /// The drive unit; absent without machines, and without a loss.
    pub fn unit(&self) -> Option<UnitPoint> {
        UnitPoint::new(&self.machines, self.loss?)
    }
}

/// Solved points.
#[derive(Debug, Clone, Default)]
pub struct GridResult {
    /// The points, in the order of the field.
    pub points: Vec<PointResult>,
    /// Observed limits and quantities over all points.
    pub seen: Vec<Extent>,
    /// Number of calls of loss models: the sum of iterations.
    pub passes: usize,
}

impl Points {
    /// Points whose torques and speeds are given at the reference port, with real flow and the temperatures that the gearbox
    /// states.
    pub fn at_reference(transmission: &Transmission, gear: &str, field: Field) -> Self {
        let port = transmission.ports()[transmission.reference_port()].name.clone();
        Self {
            gear: gear.to_owned(),
            torque_at: vec![port.clone()],
            speed_at: vec![port],
            field,
            oil: OilTemperature::from_conditions(transmission, None),
            flow: PowerFlow::Real,
            terms: false,
        }
    }

    /// The case of these points.
    ///
    /// # Errors
    /// If the gear or a port is unknown, or the prescription is invalid.
    pub fn case(&self, transmission: &Transmission) -> Result<Case, Vec<Diagnostic>> {
        let state = transmission.state(&self.gear).map_err(|e| vec![e])?;
        let needed = transmission.torques_needed(state);
        let torques: Vec<&str> = self.torque_at.iter().map(String::as_str).take(needed).collect();
        let speeds: Vec<&str> = self.speed_at.iter().map(String::as_str).collect();
        transmission.case(&self.gear, &speeds, &torques)
    }
}

/// Solves all points and stores them. `progress` is called with the number of newly solved points; if it returns false, the work stops
/// without a result.
///
/// # Errors
/// If the case is invalid.
pub fn run_grid(
    transmission: &Transmission,
    points: &Points,
    progress: &(dyn Fn(usize) -> bool + Sync),
) -> Result<Option<GridResult>, Vec<Diagnostic>> {
    let numbers: Vec<usize> = (0..points.field.pieces()).collect();
    let mut all = GridResult {
        points: Vec::with_capacity(points.field.len()),
        ..GridResult::default()
    };
    let whole = solve_pieces(transmission, points, &numbers, &take_points, progress, &mut |piece| {
        all.add(piece);
        true
    })?;
    Ok(whole.then_some(all))
}

impl GridResult {
    /// Adds the next piece.
    pub fn add(&mut self, piece: Piece) {
        merge(&mut self.seen, &piece.seen);
        self.passes += piece.points().map(|p| p.passes).sum::<usize>();
        self.points.extend(piece.into_points());
    }
}

/// Merges observed limits and quantities; both in the order of one transmission.
pub fn merge(total: &mut Vec<Extent>, more: &[Extent]) {
    if total.is_empty() {
        total.extend_from_slice(more);
    } else {
        for (a, b) in total.iter_mut().zip(more) {
            *a = a.merge(*b);
        }
    }
}
