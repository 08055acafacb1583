//! FMI 2.0. Source: headers fmi2TypesPlatform.h, fmi2FunctionTypes.h, fmi2Functions.h of the standard (Modelica Association).
//!
//! Every function of the headers is there, because other programs load all of them. What this FMU does not have is an error.
//!
//! Safety of all functions: the pointers are as the standard demands, which each `SAFETY` note calls "the standard".

#![allow(non_snake_case, clippy::missing_safety_doc)]

use core::ffi::{CStr, c_char, c_void};

use super::instance::{
    ERROR, Instance, Log, OK, Status, free_state, functions, keep_state, list, list_mut, none, put, shared_functions,
    state, text,
};
use super::uri::path_of;
use super::variables::{Causality, Kind};

type Handle = *mut c_void;
type Name = *const c_char;
type Boolean = i32;
type Logger = unsafe extern "C" fn(*mut c_void, Name, Status, Name, Name, ...);

/// Functions of the other program.
#[repr(C)]
pub struct Callbacks {
    logger: Option<Logger>,
    allocate: *const c_void,
    free: *const c_void,
    step_finished: *const c_void,
    environment: *mut c_void,
}

/// What follows from an event.
#[repr(C)]
pub struct EventInfo {
    new_discrete_states_needed: Boolean,
    terminate: Boolean,
    nominals_changed: Boolean,
    values_changed: Boolean,
    next_event_time_defined: Boolean,
    next_event_time: f64,
}

/// Receiver of messages.
struct Receiver {
    logger: Option<Logger>,
    environment: *mut c_void,
    /// Name of the instance, with its zero byte.
    name: alloc::vec::Vec<u8>,
}

impl Log for Receiver {
    fn send(&self, status: Status, category: &CStr, text: &CStr) {
        if let Some(logger) = self.logger {
            // SAFETY: the standard: the logger remains valid, and the text has no format characters.
            unsafe {
                logger(
                    self.environment,
                    self.name.as_ptr().cast(),
                    status,
                    category.as_ptr(),
                    text.as_ptr(),
                );
            }
        }
    }
}

type Own = Instance<Receiver>;

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> Name {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> Name {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    name: Name,
    _kind: i32,
    guid: Name,
    resources: Name,
    callbacks: *const Callbacks,
    _visible: Boolean,
    logging: Boolean,
) -> Handle {
    // SAFETY: the standard.
    unsafe {
        let (logger, environment) = callbacks.as_ref().map_or((None, core::ptr::null_mut()), |callbacks| {
            (callbacks.logger, callbacks.environment)
        });
        let mut name = text(name).unwrap_or(b"").to_vec();
        name.push(0);
        let log = Receiver {
            logger,
            environment,
            name,
        };
        Own::into_pointer(Own::new(text(resources).and_then(path_of), guid, log, logging != 0))
    }
}

shared_functions! {
    set_debug_logging: fmi2SetDebugLogging,
    free_instance: fmi2FreeInstance,
    exit_initialization_mode: fmi2ExitInitializationMode,
    terminate: fmi2Terminate,
    reset: fmi2Reset,
    get_state: fmi2GetFMUstate,
    set_state: fmi2SetFMUstate,
    free_state: fmi2FreeFMUstate,
    state_size: fmi2SerializedFMUstateSize,
    serialize_state: fmi2SerializeFMUstate,
    deserialize_state: fmi2DeSerializeFMUstate,
    enter_event_mode: fmi2EnterEventMode,
    enter_continuous_time_mode: fmi2EnterContinuousTimeMode,
    completed_integrator_step: fmi2CompletedIntegratorStep,
    set_time: fmi2SetTime,
    set_states: fmi2SetContinuousStates,
    get_states: fmi2GetContinuousStates,
    get_derivatives: fmi2GetDerivatives,
    get_nominals: fmi2GetNominalsOfContinuousStates,
    get_event_indicators: fmi2GetEventIndicators,
}

functions! {
    fmi2SetupExperiment(
        _tolerance_defined: Boolean,
        _tolerance: f64,
        start: f64,
        _stop_defined: Boolean,
        _stop: f64
    ) => |instance| {
        instance.model.set_time(start);
        OK
    };
    fmi2EnterInitializationMode() => |_| OK;
    fmi2GetReal(references: *const u32, count: usize, values: *mut f64) => |instance| {
        instance.get(list(references, count), Kind::Real, list_mut(values, count), |x| x)
    };
    fmi2GetInteger(references: *const u32, count: usize, values: *mut i32) => |instance| {
        instance.get(list(references, count), Kind::Integer, list_mut(values, count), |x| x as i32)
    };
    fmi2GetBoolean(references: *const u32, count: usize, values: *mut Boolean) => |instance| {
        let convert = |x: f64| Boolean::from(x != 0.0);
        instance.get(list(references, count), Kind::Boolean, list_mut(values, count), convert)
    };
    fmi2GetString(_references: *const u32, count: usize, _values: *mut Name) => |_| none(count);
    fmi2SetReal(references: *const u32, count: usize, values: *const f64) => |instance| {
        instance.set(list(references, count), Kind::Real, list(values, count), |x| x)
    };
    fmi2SetInteger(references: *const u32, count: usize, values: *const i32) => |instance| {
        instance.set(list(references, count), Kind::Integer, list(values, count), f64::from)
    };
    fmi2SetBoolean(references: *const u32, count: usize, values: *const Boolean) => |instance| {
        instance.set(list(references, count), Kind::Boolean, list(values, count), f64::from)
    };
    fmi2SetString(_references: *const u32, count: usize, _values: *const Name) => |_| none(count);
    /// Not provided, as the model description says.
    fmi2GetDirectionalDerivative(
        _unknowns: *const u32,
        _unknown_count: usize,
        _knowns: *const u32,
        _known_count: usize,
        _changes: *const f64,
        _to: *mut f64
    ) => |_| ERROR;
    fmi2NewDiscreteStates(info: *mut EventInfo) => |_| {
        let none = EventInfo {
            new_discrete_states_needed: 0,
            terminate: 0,
            nominals_changed: 0,
            values_changed: 0,
            next_event_time_defined: 0,
            next_event_time: 0.0,
        };
        put(info, none);
        OK
    };
    /// Inputs are constant over a step, as the model description says.
    fmi2SetRealInputDerivatives(
        _references: *const u32,
        _count: usize,
        _orders: *const i32,
        _values: *const f64
    ) => |_| ERROR;
    /// Not provided, as the model description says.
    fmi2GetRealOutputDerivatives(
        _references: *const u32,
        _count: usize,
        _orders: *const i32,
        _values: *mut f64
    ) => |_| ERROR;
    fmi2DoStep(time: f64, length: f64, _no_earlier: Boolean) => |instance| instance.step(time, length);
    /// A step is over when its call returns.
    fmi2CancelStep() => |_| ERROR;
    /// A step is over when its call returns.
    fmi2GetStatus(_kind: i32, _to: *mut Status) => |_| ERROR;
    /// The time of the last successful step, kind 2, and nothing else.
    fmi2GetRealStatus(kind: i32, to: *mut f64) => |instance| {
        if kind != 2 {
            return ERROR;
        }
        put(to, instance.model.time());
        OK
    };
    /// A step is over when its call returns.
    fmi2GetIntegerStatus(_kind: i32, _to: *mut i32) => |_| ERROR;
    /// Whether the simulation must end, kind 3: never.
    fmi2GetBooleanStatus(kind: i32, to: *mut Boolean) => |_| {
        if kind != 3 {
            return ERROR;
        }
        put(to, 0);
        OK
    };
    /// A step is over when its call returns.
    fmi2GetStringStatus(_kind: i32, _to: *mut Name) => |_| ERROR;
}
