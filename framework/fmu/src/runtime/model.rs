//! One simulated model: the values of its variables over time.

use alloc::vec::Vec;

use super::content::Content;
use super::variables::{Causality, Kind, Slot, Use};

/// A model with the values of its variables.
#[derive(Debug, Clone)]
pub struct Model {
    content: Content,
    slots: Vec<Slot>,
    values: Vec<f64>,
    /// Whether outputs follow from the present inputs.
    current: bool,
    /// Whether the temperatures of algebraic nodes were found at the present inputs.
    solved: bool,
    /// Whether the start values can no longer be set.
    started: bool,
}

/// Why a call has no result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// There is no variable with this reference and type.
    Unknown,
    /// The variable cannot be set, or not now.
    NotSettable,
    /// The value is infinite or not a number.
    NotFinite,
    /// No temperatures were found for a step, or at this time.
    NoSolution,
    /// A state has another size.
    State,
}

impl Fault {
    /// In words.
    pub fn words(self) -> &'static core::ffi::CStr {
        match self {
            Self::Unknown => c"there is no variable with this value reference and type",
            Self::NotSettable => c"this variable cannot be set, or not after the initialization",
            Self::NotFinite => c"the value is infinite or not a number",
            Self::NoSolution => c"no temperatures were found; the step may be too long, or its size is not a number",
            Self::State => c"the state does not belong to this FMU",
        }
    }
}

impl Model {
    /// A model at its start values.
    pub fn new(content: Content) -> Self {
        let variables = match &content {
            Content::Map(map) => map.variables(),
            Content::Network(network) => network.variables(),
        };
        let mut slots = Vec::with_capacity(variables.len() + 1);
        slots.push(Slot::time());
        slots.extend(variables);
        let mut model = Self {
            content,
            values: Vec::new(),
            slots,
            current: false,
            solved: true,
            started: false,
        };
        model.reset();
        model
    }

    /// The variables.
    pub fn slots(&self) -> &[Slot] {
        &self.slots
    }

    /// Back to the start values.
    pub fn reset(&mut self) {
        self.values = self.slots.iter().map(|slot| slot.start).collect();
        (self.current, self.started) = (false, false);
    }

    /// The simulation starts: start values can no longer be set.
    pub fn start(&mut self) {
        self.started = true;
    }

    /// The time. \[s\]
    pub fn time(&self) -> f64 {
        self.values.first().copied().unwrap_or(0.0)
    }

    /// Sets the time. \[s\]
    pub fn set_time(&mut self, time: f64) {
        if let Some(first) = self.values.first_mut() {
            *first = time;
        }
    }

    /// Value of a variable.
    pub fn get(&mut self, reference: u32, kind: Kind) -> Result<f64, Fault> {
        self.bring_up_to_date();
        let place = reference as usize;
        let slot = self.slots.get(place).filter(|slot| slot.kind == kind);
        let value = slot.and_then(|_| self.values.get(place));
        value.copied().ok_or(Fault::Unknown)
    }

    /// Sets an input, or before the start a start value.
    pub fn set(&mut self, reference: u32, kind: Kind, value: f64) -> Result<(), Fault> {
        let place = reference as usize;
        let slot = self.slots.get(place).filter(|slot| slot.kind == kind);
        let slot = slot.ok_or(Fault::Unknown)?;
        let settable = match slot.causality {
            Causality::Input => true,
            Causality::State => !self.started,
            Causality::Independent | Causality::Output | Causality::Derivative => false,
        };
        if !settable {
            return Err(Fault::NotSettable);
        }
        if !value.is_finite() {
            return Err(Fault::NotFinite);
        }
        if let Some(known) = self.values.get_mut(place) {
            *known = value;
        }
        self.current = false;
        Ok(())
    }

    /// Number of continuous states.
    pub fn state_count(&self) -> usize {
        self.places(Causality::State).count()
    }

    /// Places of the states, or of their derivatives in the same order.
    fn places(&self, wanted: Causality) -> impl Iterator<Item = usize> {
        let slots = self.slots.iter().enumerate();
        slots
            .filter(move |(_, slot)| slot.causality == wanted)
            .map(|(place, _)| place)
    }

    /// The continuous states, or their derivatives.
    ///
    /// # Errors
    /// If there are not as many, or if they are not found at these inputs.
    pub fn write_continuous(&mut self, wanted: Causality, to: &mut [f64]) -> Result<(), Fault> {
        if to.len() != self.state_count() {
            return Err(Fault::State);
        }
        if wanted == Causality::Derivative {
            self.bring_up_to_date();
            if !self.solved {
                return Err(Fault::NoSolution);
            }
        }
        for (place, to) in self.places(wanted).zip(to) {
            *to = self.values.get(place).copied().unwrap_or(0.0);
        }
        Ok(())
    }

    /// Sets the continuous states.
    pub fn set_continuous(&mut self, from: &[f64]) -> Result<(), Fault> {
        if from.len() != self.state_count() {
            return Err(Fault::State);
        }
        if !from.iter().all(|x| x.is_finite()) {
            return Err(Fault::NotFinite);
        }
        let places: Vec<usize> = self.places(Causality::State).collect();
        for (place, from) in places.into_iter().zip(from) {
            if let Some(known) = self.values.get_mut(place) {
                *known = *from;
            }
        }
        self.current = false;
        Ok(())
    }

    /// Simulates a time with constant inputs. \[s\]
    pub fn advance(&mut self, duration: f64) -> Result<(), Fault> {
        if let Content::Network(network) = &self.content {
            self.current = false;
            if !network.advance(&self.slots, &mut self.values, duration) {
                return Err(Fault::NoSolution);
            }
        }
        Ok(())
    }

    /// Whether an input is beyond the tables.
    pub fn is_outside(&mut self) -> bool {
        self.bring_up_to_date();
        Slot::value(&self.slots, &self.values, Use::Outside) != 0.0
    }

    fn bring_up_to_date(&mut self) {
        if self.current {
            return;
        }
        match &self.content {
            Content::Map(map) => map.evaluate(&self.slots, &mut self.values),
            Content::Network(network) => self.solved = network.evaluate(&self.slots, &mut self.values),
        }
        self.current = true;
    }

    /// Values and phase as bytes, which [`Model::restore`] reads.
    pub fn state(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(self.state_size());
        bytes.push(u8::from(self.started));
        for value in &self.values {
            bytes.extend(value.to_le_bytes());
        }
        bytes
    }

    /// Number of bytes of a state.
    pub fn state_size(&self) -> usize {
        1 + 8 * self.values.len()
    }

    /// Back to a state.
    pub fn restore(&mut self, state: &[u8]) -> Result<(), Fault> {
        if state.len() != self.state_size() {
            return Err(Fault::State);
        }
        let (started, values) = state.split_first().ok_or(Fault::State)?;
        for (known, bytes) in self.values.iter_mut().zip(values.chunks_exact(8)) {
            *known = bytes.try_into().map(f64::from_le_bytes).map_err(|_| Fault::State)?;
        }
        (self.started, self.current) = (*started != 0, false);
        Ok(())
    }
}
