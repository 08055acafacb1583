//! FMI 3.0. Source: headers fmi3PlatformTypes.h, fmi3FunctionTypes.h, fmi3Functions.h of the standard (Modelica Association).
//!
//! Every function of the headers is there, because other programs load all of them. What this FMU does not have is an error.
//!
//! Safety of all functions: the pointers are as the standard demands, which each `SAFETY` note calls "the standard".

#![allow(non_snake_case, clippy::missing_safety_doc, clippy::too_many_arguments)]

use core::ffi::{CStr, c_char, c_void};

use super::instance::{
    ERROR, Instance, Log, OK, Status, free_state, functions, keep_state, list, list_mut, none, put, shared_functions,
    state, text,
};
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

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> Name {
    c"3.0".as_ptr()
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

shared_functions! {
    set_debug_logging: fmi3SetDebugLogging,
    free_instance: fmi3FreeInstance,
    exit_initialization_mode: fmi3ExitInitializationMode,
    terminate: fmi3Terminate,
    reset: fmi3Reset,
    get_state: fmi3GetFMUState,
    set_state: fmi3SetFMUState,
    free_state: fmi3FreeFMUState,
    state_size: fmi3SerializedFMUStateSize,
    serialize_state: fmi3SerializeFMUState,
    deserialize_state: fmi3DeserializeFMUState,
    enter_event_mode: fmi3EnterEventMode,
    enter_continuous_time_mode: fmi3EnterContinuousTimeMode,
    completed_integrator_step: fmi3CompletedIntegratorStep,
    set_time: fmi3SetTime,
    set_states: fmi3SetContinuousStates,
    get_states: fmi3GetContinuousStates,
    get_derivatives: fmi3GetContinuousStateDerivatives,
    get_nominals: fmi3GetNominalsOfContinuousStates,
    get_event_indicators: fmi3GetEventIndicators,
}

functions! {
    fmi3EnterInitializationMode(
        _tolerance_defined: Boolean,
        _tolerance: f64,
        start: f64,
        _stop_defined: Boolean,
        _stop: f64
    ) => |instance| {
        instance.model.set_time(start);
        OK
    };
    /// There are no structural parameters.
    fmi3EnterConfigurationMode() => |_| ERROR;
    /// There are no structural parameters.
    fmi3ExitConfigurationMode() => |_| ERROR;
    fmi3EvaluateDiscreteStates() => |_| OK;
    fmi3EnterStepMode() => |_| OK;
    fmi3GetFloat64(references: *const u32, count: usize, values: *mut f64, value_count: usize) => |instance| {
        instance.get(list(references, count), Kind::Real, list_mut(values, value_count), |x| x)
    };
    fmi3SetFloat64(references: *const u32, count: usize, values: *const f64, value_count: usize) => |instance| {
        instance.set(list(references, count), Kind::Real, list(values, value_count), |x| x)
    };
    fmi3GetInt32(references: *const u32, count: usize, values: *mut i32, value_count: usize) => |instance| {
        instance.get(list(references, count), Kind::Integer, list_mut(values, value_count), |x| x as i32)
    };
    fmi3SetInt32(references: *const u32, count: usize, values: *const i32, value_count: usize) => |instance| {
        instance.set(list(references, count), Kind::Integer, list(values, value_count), f64::from)
    };
    fmi3GetBoolean(references: *const u32, count: usize, values: *mut Boolean, value_count: usize) => |instance| {
        let convert = |x: f64| Boolean::from(x != 0.0);
        instance.get(list(references, count), Kind::Boolean, list_mut(values, value_count), convert)
    };
    fmi3SetBoolean(references: *const u32, count: usize, values: *const Boolean, value_count: usize) => |instance| {
        let convert = |x: Boolean| f64::from(u8::from(x != 0));
        instance.set(list(references, count), Kind::Boolean, list(values, value_count), convert)
    };
}

/// Functions of a type that no variable has.
macro_rules! without_variables {
    ($($get:ident, $set:ident: $of:ty;)*) => {
        functions! {$(
            $get(_references: *const u32, count: usize, _values: *mut $of, _value_count: usize) => |_| none(count);
            $set(_references: *const u32, count: usize, _values: *const $of, _value_count: usize) => |_| none(count);
        )*}
    };
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

functions! {
    fmi3GetBinary(
        _references: *const u32,
        count: usize,
        _sizes: *mut usize,
        _values: *mut *const u8,
        _value_count: usize
    ) => |_| none(count);
    fmi3SetBinary(
        _references: *const u32,
        count: usize,
        _sizes: *const usize,
        _values: *const *const u8,
        _value_count: usize
    ) => |_| none(count);
    /// There are no clocks.
    fmi3GetClock(_references: *const u32, count: usize, _values: *mut Boolean) => |_| none(count);
    /// There are no clocks.
    fmi3SetClock(_references: *const u32, count: usize, _values: *const Boolean) => |_| none(count);
    /// There are no clocks.
    fmi3GetIntervalDecimal(
        _references: *const u32,
        count: usize,
        _intervals: *mut f64,
        _qualifiers: *mut i32
    ) => |_| none(count);
    /// There are no clocks.
    fmi3GetIntervalFraction(
        _references: *const u32,
        count: usize,
        _counters: *mut u64,
        _resolutions: *mut u64,
        _qualifiers: *mut i32
    ) => |_| none(count);
    /// There are no clocks.
    fmi3GetShiftDecimal(_references: *const u32, count: usize, _shifts: *mut f64) => |_| none(count);
    /// There are no clocks.
    fmi3GetShiftFraction(
        _references: *const u32,
        count: usize,
        _counters: *mut u64,
        _resolutions: *mut u64
    ) => |_| none(count);
    /// There are no clocks.
    fmi3SetIntervalDecimal(_references: *const u32, count: usize, _intervals: *const f64) => |_| none(count);
    /// There are no clocks.
    fmi3SetIntervalFraction(
        _references: *const u32,
        count: usize,
        _counters: *const u64,
        _resolutions: *const u64
    ) => |_| none(count);
    /// There are no clocks.
    fmi3SetShiftDecimal(_references: *const u32, count: usize, _shifts: *const f64) => |_| none(count);
    /// There are no clocks.
    fmi3SetShiftFraction(
        _references: *const u32,
        count: usize,
        _counters: *const u64,
        _resolutions: *const u64
    ) => |_| none(count);
    /// Not provided, as the model description says.
    fmi3GetNumberOfVariableDependencies(_reference: u32, _to: *mut usize) => |_| ERROR;
    /// Not provided, as the model description says.
    fmi3GetVariableDependencies(
        _dependent: u32,
        _elements: *mut usize,
        _independents: *mut u32,
        _elements_of_independents: *mut usize,
        _kinds: *mut i32,
        _count: usize
    ) => |_| ERROR;
    /// Not provided, as the model description says.
    fmi3GetDirectionalDerivative(
        _unknowns: *const u32,
        _unknown_count: usize,
        _knowns: *const u32,
        _known_count: usize,
        _seed: *const f64,
        _seed_count: usize,
        _to: *mut f64,
        _to_count: usize
    ) => |_| ERROR;
    /// Not provided, as the model description says.
    fmi3GetAdjointDerivative(
        _unknowns: *const u32,
        _unknown_count: usize,
        _knowns: *const u32,
        _known_count: usize,
        _seed: *const f64,
        _seed_count: usize,
        _to: *mut f64,
        _to_count: usize
    ) => |_| ERROR;
    fmi3UpdateDiscreteStates(
        again: *mut Boolean,
        terminate: *mut Boolean,
        nominals_changed: *mut Boolean,
        values_changed: *mut Boolean,
        next_event_time_defined: *mut Boolean,
        next_event_time: *mut f64
    ) => |_| {
        for to in [again, terminate, nominals_changed, values_changed, next_event_time_defined] {
            put(to, 0);
        }
        put(next_event_time, 0.0);
        OK
    };
    fmi3GetNumberOfEventIndicators(to: *mut usize) => |_| {
        put(to, 0);
        OK
    };
    fmi3GetNumberOfContinuousStates(to: *mut usize) => |instance| {
        put(to, instance.model.state_count());
        OK
    };
    /// Not provided, as the model description says.
    fmi3GetOutputDerivatives(
        _references: *const u32,
        _count: usize,
        _orders: *const i32,
        _values: *mut f64,
        _value_count: usize
    ) => |_| ERROR;
    fmi3DoStep(
        time: f64,
        length: f64,
        _no_earlier: Boolean,
        event: *mut Boolean,
        terminate: *mut Boolean,
        early: *mut Boolean,
        last: *mut f64
    ) => |instance| {
        let status = instance.step(time, length);
        for to in [event, terminate, early] {
            put(to, 0);
        }
        put(last, instance.model.time());
        status
    };
    /// Not provided, as the model description says.
    fmi3ActivateModelPartition(_clock: u32, _time: f64) => |_| ERROR;
}
