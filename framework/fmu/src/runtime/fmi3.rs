//! FMI 3.0. Source: headers fmi3PlatformTypes.h, fmi3FunctionTypes.h, fmi3Functions.h of the standard (Modelica Association).
//!
//! Every function of the headers is there, because other programs load all of them. What this FMU does not have is an error.
//!
//! Safety of all functions: the pointers are as the standard demands, which each `SAFETY` note calls "the standard".

#![allow(non_snake_case, clippy::missing_safety_doc, clippy::too_many_arguments)]

use core::ffi::{CStr, c_char, c_void};

use super::instance::{ERROR, Instance, Log, OK, Status, free_state, keep_state, list, list_mut, put, state, text};
use super::variables::{Causality, Kind};

/// `bool` of C. It may come with any bits, which a `bool` of Rust must not have.
type Boolean = u8;
type Handle = *mut c_void;
type Name = *const c_char;
type Logger = unsafe extern "C" fn(*mut c_void, Status, Name, Name);

/// Receiver of messages.
struct Receiver {
    logger: Option<Logger>,
    environment: *mut c_void,
}

impl Log for Receiver {
    fn send(&self, status: Status, category: &CStr, text: &CStr) {
        if let Some(logger) = self.logger {
            // SAFETY: the standard: the logger remains valid.
            unsafe { logger(self.environment, status, category.as_ptr(), text.as_ptr()) }
        }
    }
}

type Own = Instance<Receiver>;

/// Runs a call on an instance.
unsafe fn with(c: Handle, call: impl FnOnce(&mut Own) -> Status) -> Status {
    // SAFETY: the standard.
    unsafe { Own::with(c, call) }
}

/// A new instance.
unsafe fn instance(
    token: Name,
    resources: Name,
    logging: Boolean,
    environment: *mut c_void,
    logger: Option<Logger>,
) -> Handle {
    let log = Receiver { logger, environment };
    // SAFETY: the standard.
    unsafe { Own::into_pointer(Own::new(text(resources).map(<[u8]>::to_vec), token, log, logging != 0)) }
}

/// Fine without variables of a type that no variable has.
unsafe fn none(c: Handle, count: usize) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |_| if count == 0 { OK } else { ERROR }) }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> Name {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
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
pub unsafe extern "C" fn fmi3InstantiateModelExchange(
    _name: Name,
    token: Name,
    resources: Name,
    _visible: Boolean,
    logging: Boolean,
    environment: *mut c_void,
    logger: Option<Logger>,
) -> Handle {
    // SAFETY: the standard.
    unsafe { instance(token, resources, logging, environment, logger) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    _name: Name,
    token: Name,
    resources: Name,
    _visible: Boolean,
    logging: Boolean,
    _event_mode: Boolean,
    _early_return: Boolean,
    _intermediate: *const u32,
    _intermediate_count: usize,
    environment: *mut c_void,
    logger: Option<Logger>,
    _update: *const c_void,
) -> Handle {
    // SAFETY: the standard.
    unsafe { instance(token, resources, logging, environment, logger) }
}

/// Not provided, as the model description says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateScheduledExecution(
    _name: Name,
    _token: Name,
    _resources: Name,
    _visible: Boolean,
    _logging: Boolean,
    _environment: *mut c_void,
    _logger: Option<Logger>,
    _update: *const c_void,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> Handle {
    core::ptr::null_mut()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeInstance(c: Handle) {
    // SAFETY: the standard.
    unsafe { Own::free(c) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterInitializationMode(
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
pub unsafe extern "C" fn fmi3ExitInitializationMode(c: Handle) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.model.start();
            OK
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Reset(c: Handle) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, Own::reset) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterEventMode(c: Handle) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |_| OK) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Terminate(c: Handle) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |_| OK) }
}

/// There are no structural parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterConfigurationMode(_c: Handle) -> Status {
    ERROR
}

/// There are no structural parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ExitConfigurationMode(_c: Handle) -> Status {
    ERROR
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EvaluateDiscreteStates(c: Handle) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |_| OK) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterContinuousTimeMode(c: Handle) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |_| OK) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterStepMode(c: Handle) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |_| OK) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat64(
    c: Handle,
    references: *const u32,
    count: usize,
    values: *mut f64,
    value_count: usize,
) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.get(
                list(references, count),
                Kind::Real,
                list_mut(values, value_count),
                |x| x,
            )
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat64(
    c: Handle,
    references: *const u32,
    count: usize,
    values: *const f64,
    value_count: usize,
) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.set(list(references, count), Kind::Real, list(values, value_count), |x| x)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetInt32(
    c: Handle,
    references: *const u32,
    count: usize,
    values: *mut i32,
    value_count: usize,
) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.get(
                list(references, count),
                Kind::Integer,
                list_mut(values, value_count),
                |x| x as i32,
            )
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetInt32(
    c: Handle,
    references: *const u32,
    count: usize,
    values: *const i32,
    value_count: usize,
) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.set(
                list(references, count),
                Kind::Integer,
                list(values, value_count),
                f64::from,
            )
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetBoolean(
    c: Handle,
    references: *const u32,
    count: usize,
    values: *mut Boolean,
    value_count: usize,
) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.get(
                list(references, count),
                Kind::Boolean,
                list_mut(values, value_count),
                |x| Boolean::from(x != 0.0),
            )
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetBoolean(
    c: Handle,
    references: *const u32,
    count: usize,
    values: *const Boolean,
    value_count: usize,
) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.set(list(references, count), Kind::Boolean, list(values, value_count), |x| {
                f64::from(u8::from(x != 0))
            })
        })
    }
}

/// Functions of a type that no variable has.
macro_rules! without_variables {
    ($($get:ident, $set:ident: $of:ty;)*) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $get(c: Handle, _: *const u32, count: usize, _: *mut $of, _: usize) -> Status {
            // SAFETY: the standard.
            unsafe { none(c, count) }
        }

        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $set(c: Handle, _: *const u32, count: usize, _: *const $of, _: usize) -> Status {
            // SAFETY: the standard.
            unsafe { none(c, count) }
        }
    )*};
}

without_variables! {
    fmi3GetFloat32, fmi3SetFloat32: f32;
    fmi3GetInt8, fmi3SetInt8: i8;
    fmi3GetUInt8, fmi3SetUInt8: u8;
    fmi3GetInt16, fmi3SetInt16: i16;
    fmi3GetUInt16, fmi3SetUInt16: u16;
    fmi3GetUInt32, fmi3SetUInt32: u32;
    fmi3GetInt64, fmi3SetInt64: i64;
    fmi3GetUInt64, fmi3SetUInt64: u64;
    fmi3GetString, fmi3SetString: Name;
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetBinary(
    c: Handle,
    _references: *const u32,
    count: usize,
    _sizes: *mut usize,
    _values: *mut *const u8,
    _value_count: usize,
) -> Status {
    // SAFETY: the standard.
    unsafe { none(c, count) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetBinary(
    c: Handle,
    _references: *const u32,
    count: usize,
    _sizes: *const usize,
    _values: *const *const u8,
    _value_count: usize,
) -> Status {
    // SAFETY: the standard.
    unsafe { none(c, count) }
}

/// There are no clocks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetClock(
    c: Handle,
    _references: *const u32,
    count: usize,
    _values: *mut Boolean,
) -> Status {
    // SAFETY: the standard.
    unsafe { none(c, count) }
}

/// There are no clocks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetClock(
    c: Handle,
    _references: *const u32,
    count: usize,
    _values: *const Boolean,
) -> Status {
    // SAFETY: the standard.
    unsafe { none(c, count) }
}

/// There are no clocks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetIntervalDecimal(
    c: Handle,
    _references: *const u32,
    count: usize,
    _intervals: *mut f64,
    _qualifiers: *mut i32,
) -> Status {
    // SAFETY: the standard.
    unsafe { none(c, count) }
}

/// There are no clocks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetIntervalFraction(
    c: Handle,
    _references: *const u32,
    count: usize,
    _counters: *mut u64,
    _resolutions: *mut u64,
    _qualifiers: *mut i32,
) -> Status {
    // SAFETY: the standard.
    unsafe { none(c, count) }
}

/// There are no clocks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetShiftDecimal(
    c: Handle,
    _references: *const u32,
    count: usize,
    _shifts: *mut f64,
) -> Status {
    // SAFETY: the standard.
    unsafe { none(c, count) }
}

/// There are no clocks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetShiftFraction(
    c: Handle,
    _references: *const u32,
    count: usize,
    _counters: *mut u64,
    _resolutions: *mut u64,
) -> Status {
    // SAFETY: the standard.
    unsafe { none(c, count) }
}

/// There are no clocks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetIntervalDecimal(
    c: Handle,
    _references: *const u32,
    count: usize,
    _intervals: *const f64,
) -> Status {
    // SAFETY: the standard.
    unsafe { none(c, count) }
}

/// There are no clocks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetIntervalFraction(
    c: Handle,
    _references: *const u32,
    count: usize,
    _counters: *const u64,
    _resolutions: *const u64,
) -> Status {
    // SAFETY: the standard.
    unsafe { none(c, count) }
}

/// There are no clocks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetShiftDecimal(
    c: Handle,
    _references: *const u32,
    count: usize,
    _shifts: *const f64,
) -> Status {
    // SAFETY: the standard.
    unsafe { none(c, count) }
}

/// There are no clocks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetShiftFraction(
    c: Handle,
    _references: *const u32,
    count: usize,
    _counters: *const u64,
    _resolutions: *const u64,
) -> Status {
    // SAFETY: the standard.
    unsafe { none(c, count) }
}

/// Not provided, as the model description says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfVariableDependencies(_c: Handle, _reference: u32, _to: *mut usize) -> Status {
    ERROR
}

/// Not provided, as the model description says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetVariableDependencies(
    _c: Handle,
    _dependent: u32,
    _elements: *mut usize,
    _independents: *mut u32,
    _elements_of_independents: *mut usize,
    _kinds: *mut i32,
    _count: usize,
) -> Status {
    ERROR
}

super::instance::state_functions!(
    fmi3GetFMUState,
    fmi3SetFMUState,
    fmi3FreeFMUState,
    fmi3SerializedFMUStateSize,
    fmi3SerializeFMUState,
    fmi3DeserializeFMUState
);

/// Not provided, as the model description says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetDirectionalDerivative(
    _c: Handle,
    _unknowns: *const u32,
    _unknown_count: usize,
    _knowns: *const u32,
    _known_count: usize,
    _seed: *const f64,
    _seed_count: usize,
    _to: *mut f64,
    _to_count: usize,
) -> Status {
    ERROR
}

/// Not provided, as the model description says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetAdjointDerivative(
    _c: Handle,
    _unknowns: *const u32,
    _unknown_count: usize,
    _knowns: *const u32,
    _known_count: usize,
    _seed: *const f64,
    _seed_count: usize,
    _to: *mut f64,
    _to_count: usize,
) -> Status {
    ERROR
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3UpdateDiscreteStates(
    c: Handle,
    again: *mut Boolean,
    terminate: *mut Boolean,
    nominals_changed: *mut Boolean,
    values_changed: *mut Boolean,
    next_event_time_defined: *mut Boolean,
    next_event_time: *mut f64,
) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |_| {
            for to in [
                again,
                terminate,
                nominals_changed,
                values_changed,
                next_event_time_defined,
            ] {
                put(to, 0);
            }
            put(next_event_time, 0.0);
            OK
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3CompletedIntegratorStep(
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
pub unsafe extern "C" fn fmi3SetTime(c: Handle, time: f64) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.model.set_time(time);
            OK
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetContinuousStates(c: Handle, values: *const f64, count: usize) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |own| own.set_continuous(list(values, count))) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetContinuousStateDerivatives(c: Handle, values: *mut f64, count: usize) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            own.get_continuous(Causality::Derivative, list_mut(values, count))
        })
    }
}

/// There are no event indicators.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetEventIndicators(c: Handle, _values: *mut f64, count: usize) -> Status {
    // SAFETY: the standard.
    unsafe { none(c, count) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetContinuousStates(c: Handle, values: *mut f64, count: usize) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |own| own.get_continuous(Causality::State, list_mut(values, count))) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNominalsOfContinuousStates(c: Handle, values: *mut f64, count: usize) -> Status {
    // SAFETY: the standard.
    unsafe { with(c, |own| own.get_nominals(list_mut(values, count))) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfEventIndicators(c: Handle, to: *mut usize) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |_| {
            put(to, 0);
            OK
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfContinuousStates(c: Handle, to: *mut usize) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            put(to, own.model.state_count());
            OK
        })
    }
}

/// Not provided, as the model description says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetOutputDerivatives(
    _c: Handle,
    _references: *const u32,
    _count: usize,
    _orders: *const i32,
    _values: *mut f64,
    _value_count: usize,
) -> Status {
    ERROR
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    c: Handle,
    time: f64,
    length: f64,
    _no_earlier: Boolean,
    event: *mut Boolean,
    terminate: *mut Boolean,
    early: *mut Boolean,
    last: *mut f64,
) -> Status {
    // SAFETY: the standard.
    unsafe {
        with(c, |own| {
            let status = own.step(time, length);
            for to in [event, terminate, early] {
                put(to, 0);
            }
            put(last, own.model.time());
            status
        })
    }
}

/// Not provided, as the model description says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ActivateModelPartition(_c: Handle, _clock: u32, _time: f64) -> Status {
    ERROR
}
