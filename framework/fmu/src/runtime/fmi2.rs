//! FMI 2.0. Source: headers fmi2TypesPlatform.h, fmi2FunctionTypes.h, fmi2Functions.h of the standard (Modelica Association).
//!
//! Every function of the headers is there, because other programs load all of them. What this FMU does not have is an error.
//!
//! Safety of all functions: the pointers are as the standard demands, which each `SAFETY` note calls "the standard".

#![allow(non_snake_case, clippy::missing_safety_doc)]

use core::ffi::{CStr, c_char, c_void};

use super::instance::{ERROR, Instance, Log, OK, Status, free_state, keep_state, list, list_mut, put, state, text};
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

/// Runs a call on an instance.
unsafe fn with(c: Handle, call: impl FnOnce(&mut Own) -> Status) -> Status {
    // SAFETY: the standard.
    unsafe { Own::with(c, call) }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> Name {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> Name {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    c: Handle,
    on: Boolean,
    _count: usize,
    _categories: *const Name,
) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.logging = on != 0;
            OK
        })
    }
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
        let (logger, environment) = callbacks
            .as_ref()
            .map_or((None, core::ptr::null_mut()), |own| (own.logger, own.environment));
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

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(c: Handle) {
    // SAFETY: the standard.
    unsafe { Own::free(c) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    c: Handle,
    _tolerance_defined: Boolean,
    _tolerance: f64,
    start: f64,
    _stop_defined: Boolean,
    _stop: f64,
) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.model.set_time(start);
            OK
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterInitializationMode(c: Handle) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |_| OK) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2ExitInitializationMode(c: Handle) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.model.start();
            OK
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(c: Handle) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |_| OK) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(c: Handle) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, Own::reset) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(c: Handle, references: *const u32, count: usize, values: *mut f64) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.get(list(references, count), Kind::Real, list_mut(values, count), |x| x)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(c: Handle, references: *const u32, count: usize, values: *mut i32) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.get(list(references, count), Kind::Integer, list_mut(values, count), |x| {
                x as i32
            })
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(
    c: Handle,
    references: *const u32,
    count: usize,
    values: *mut Boolean,
) -> Status {
    let convert = |x: f64| Boolean::from(x != 0.0);
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.get(list(references, count), Kind::Boolean, list_mut(values, count), convert)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(c: Handle, _references: *const u32, count: usize, _values: *mut Name) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |_| if count == 0 { OK } else { ERROR }) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(c: Handle, references: *const u32, count: usize, values: *const f64) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.set(list(references, count), Kind::Real, list(values, count), |x| x)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(c: Handle, references: *const u32, count: usize, values: *const i32) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.set(list(references, count), Kind::Integer, list(values, count), f64::from)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(
    c: Handle,
    references: *const u32,
    count: usize,
    values: *const Boolean,
) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.set(list(references, count), Kind::Boolean, list(values, count), f64::from)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    c: Handle,
    _references: *const u32,
    count: usize,
    _values: *const Name,
) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |_| if count == 0 { OK } else { ERROR }) }
}

super::instance::state_functions!(
    fmi2GetFMUstate,
    fmi2SetFMUstate,
    fmi2FreeFMUstate,
    fmi2SerializedFMUstateSize,
    fmi2SerializeFMUstate,
    fmi2DeSerializeFMUstate
);

/// Not provided, as the model description says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    _c: Handle,
    _unknowns: *const u32,
    _unknown_count: usize,
    _knowns: *const u32,
    _known_count: usize,
    _changes: *const f64,
    _to: *mut f64,
) -> Status {
    ERROR
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterEventMode(c: Handle) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |_| OK) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2NewDiscreteStates(c: Handle, info: *mut EventInfo) -> Status {
    let none = EventInfo {
        new_discrete_states_needed: 0,
        terminate: 0,
        nominals_changed: 0,
        values_changed: 0,
        next_event_time_defined: 0,
        next_event_time: 0.0,
    };
    // SAFETY: the standard.
    unsafe {
        with(c, |_| {
            put(info, none);
            OK
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterContinuousTimeMode(c: Handle) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |_| OK) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CompletedIntegratorStep(
    c: Handle,
    _no_earlier: Boolean,
    enter_event_mode: *mut Boolean,
    terminate: *mut Boolean,
) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |_| {
            put(enter_event_mode, 0);
            put(terminate, 0);
            OK
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetTime(c: Handle, time: f64) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.model.set_time(time);
            OK
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetContinuousStates(c: Handle, values: *const f64, count: usize) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |own| own.set_continuous(list(values, count))) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDerivatives(c: Handle, values: *mut f64, count: usize) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.get_continuous(Causality::Derivative, list_mut(values, count))
        })
    }
}

/// There are no event indicators.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetEventIndicators(c: Handle, _values: *mut f64, count: usize) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |_| if count == 0 { OK } else { ERROR }) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetContinuousStates(c: Handle, values: *mut f64, count: usize) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |own| own.get_continuous(Causality::State, list_mut(values, count))) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetNominalsOfContinuousStates(c: Handle, values: *mut f64, count: usize) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |own| own.get_nominals(list_mut(values, count))) }
}

/// Inputs are constant over a step, as the model description says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    _c: Handle,
    _references: *const u32,
    _count: usize,
    _orders: *const i32,
    _values: *const f64,
) -> Status {
    ERROR
}

/// Not provided, as the model description says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    _c: Handle,
    _references: *const u32,
    _count: usize,
    _orders: *const i32,
    _values: *mut f64,
) -> Status {
    ERROR
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(c: Handle, time: f64, length: f64, _no_earlier: Boolean) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |own| own.step(time, length)) }
}

/// A step is over when its call returns.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CancelStep(_c: Handle) -> Status {
    ERROR
}

/// A step is over when its call returns.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(_c: Handle, _kind: i32, _to: *mut Status) -> Status {
    ERROR
}

/// The time of the last successful step, kind 2, and nothing else.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(c: Handle, kind: i32, to: *mut f64) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            if kind != 2 {
                return ERROR;
            }
            put(to, own.model.time());
            OK
        })
    }
}

/// A step is over when its call returns.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetIntegerStatus(_c: Handle, _kind: i32, _to: *mut i32) -> Status {
    ERROR
}

/// Whether the simulation must end, kind 3: never.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(c: Handle, kind: i32, to: *mut Boolean) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |_| {
            if kind != 3 {
                return ERROR;
            }
            put(to, 0);
            OK
        })
    }
}

/// A step is over when its call returns.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(_c: Handle, _kind: i32, _to: *mut Name) -> Status {
    ERROR
}
