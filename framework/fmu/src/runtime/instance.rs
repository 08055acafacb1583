//! Instances as the other program sees them: pointers, texts, messages.

use alloc::boxed::Box;
use alloc::rc::Rc;
use alloc::vec::Vec;
use core::ffi::{CStr, c_char, c_void};

use super::content::{Content, token};
use super::host;
use super::model::{Fault, Model};
use super::variables::{Causality, Kind};

/// Maximum size of a content. \[bytes\]
const LONGEST: usize = 1 << 30;

/// Status of a call, the same numbers in both versions.
pub type Status = i32;
/// Everything is well.
pub const OK: Status = 0;
/// A warning.
pub const WARNING: Status = 1;
/// The call had no effect; the other program may try another step.
pub const DISCARD: Status = 2;
/// The instance cannot be used any more, or the call is not supported.
pub const ERROR: Status = 3;

/// Sends a message to the other program.
pub trait Log {
    /// Status, category, text.
    fn send(&self, status: Status, category: &CStr, text: &CStr);
}

/// An instance.
pub struct Instance<L> {
    /// Its model.
    pub model: Model,
    /// Receiver of messages, shared so that it gets them while nothing borrows the instance.
    log: Rc<L>,
    /// Messages of the present call: status, category, text.
    messages: Vec<(Status, &'static CStr, &'static CStr)>,
    /// Whether messages are wanted.
    pub logging: bool,
    /// Whether it was reported that an input is beyond the tables.
    warned: bool,
}

impl<L: Log> Instance<L> {
    /// An instance of the content in a folder of resources, if the token is that of the content.
    ///
    /// # Safety
    /// The token is null or a text.
    pub unsafe fn new(folder: Option<Vec<u8>>, expected: *const c_char, log: L, logging: bool) -> Option<Box<Self>> {
        let fail = |text: &CStr| {
            log.send(ERROR, c"logStatusError", text);
            None
        };
        let Some(folder) = folder else {
            return fail(c"the location of the resources is missing or not a local file");
        };
        let read = |name: &[u8]| {
            let mut path = folder.clone();
            if !matches!(path.last(), Some(b'/' | b'\\')) {
                path.push(b'/');
            }
            path.extend_from_slice(name);
            host::read(&path, LONGEST)
        };
        let Some(bytes) = read(b"map.bin").or_else(|| read(b"network.bin")) else {
            return fail(c"neither map.bin nor network.bin can be read in the folder of resources");
        };
        // SAFETY: as promised by the caller.
        let expected = unsafe { text(expected) };
        if expected != Some(&token(&bytes)) {
            return fail(c"the GUID or instantiation token is not that of the resources: the FMU was changed");
        }
        let Some(content) = Content::decode(&bytes) else {
            return fail(c"the resources are damaged or of another version");
        };
        let model = Model::new(content);
        Some(Box::new(Self {
            model,
            log: Rc::new(log),
            messages: Vec::new(),
            logging,
            warned: false,
        }))
    }

    /// Reports a fault.
    pub fn result(&mut self, result: Result<(), Fault>) -> Status {
        match result {
            Ok(()) => OK,
            Err(fault) => {
                let (status, category) = match fault {
                    Fault::NoSolution => (DISCARD, c"logStatusDiscard"),
                    _ => (ERROR, c"logStatusError"),
                };
                self.messages.push((status, category, fault.words()));
                status
            }
        }
    }

    /// Reads variables of a type.
    pub fn get<T>(&mut self, references: &[u32], kind: Kind, values: &mut [T], convert: fn(f64) -> T) -> Status {
        if references.len() != values.len() {
            return ERROR;
        }
        let model = &mut self.model;
        let result = references.iter().zip(values).try_for_each(|(reference, value)| {
            *value = convert(model.get(*reference, kind)?);
            Ok(())
        });
        self.warn();
        self.result(result)
    }

    /// Writes variables of a type.
    pub fn set<T: Copy>(&mut self, references: &[u32], kind: Kind, values: &[T], convert: fn(T) -> f64) -> Status {
        if references.len() != values.len() {
            return ERROR;
        }
        let model = &mut self.model;
        let mut pairs = references.iter().zip(values);
        let result = pairs.try_for_each(|(reference, value)| model.set(*reference, kind, convert(*value)));
        self.result(result)
    }

    /// Reads the continuous states or their derivatives.
    pub fn get_continuous(&mut self, wanted: Causality, values: &mut [f64]) -> Status {
        let result = self.model.write_continuous(wanted, values);
        self.warn();
        self.result(result)
    }

    /// Sets the continuous states.
    pub fn set_continuous(&mut self, values: &[f64]) -> Status {
        let result = self.model.set_continuous(values);
        self.result(result)
    }

    /// The nominal values of the continuous states, which are one unless the model description states others.
    pub fn get_nominals(&self, values: &mut [f64]) -> Status {
        if values.len() != self.model.state_count() {
            return ERROR;
        }
        values.fill(1.0);
        OK
    }

    /// Simulates until the end of a step.
    pub fn step(&mut self, time: f64, length: f64) -> Status {
        let result = self.model.advance(length);
        if result.is_ok() {
            self.model.set_time(time + length);
        }
        self.warn();
        self.result(result)
    }

    /// Back to the start values.
    pub fn reset(&mut self) -> Status {
        self.model.reset();
        self.warned = false;
        OK
    }

    /// Reports once that an input is beyond the tables.
    fn warn(&mut self) {
        if self.logging && !self.warned && self.model.is_outside() {
            self.warned = true;
            let text = c"an input is beyond the tables: their ends are used, and the variable `outside` is true";
            self.messages.push((WARNING, c"logStatusWarning", text));
        }
    }

    /// Runs a call on an instance behind a pointer, then sends its messages: the receiver may call functions of the instance.
    ///
    /// # Safety
    /// The pointer is null or of [`Instance::new`], not freed, and not in use by another thread.
    pub unsafe fn with(pointer: *mut c_void, call: impl FnOnce(&mut Self) -> Status) -> Status {
        // SAFETY: as promised by the caller.
        let Some(instance) = (unsafe { pointer.cast::<Self>().as_mut() }) else {
            return ERROR;
        };
        let status = call(instance);
        if !instance.messages.is_empty() {
            let (log, messages) = (Rc::clone(&instance.log), core::mem::take(&mut instance.messages));
            for (status, category, text) in messages {
                log.send(status, category, text);
            }
        }
        status
    }

    /// As a pointer; null if there is none.
    pub fn into_pointer(instance: Option<Box<Self>>) -> *mut c_void {
        instance.map_or(core::ptr::null_mut(), |instance| Box::into_raw(instance).cast())
    }

    /// Frees an instance.
    ///
    /// # Safety
    /// As [`Instance::with`]; the pointer is not used afterwards.
    pub unsafe fn free(pointer: *mut c_void) {
        if !pointer.is_null() {
            // SAFETY: as promised by the caller.
            drop(unsafe { Box::from_raw(pointer.cast::<Self>()) });
        }
    }
}

/// Stores the state of an instance behind a pointer, whose memory is reused.
///
/// # Safety
/// `to` is null or points to null or to a state of this function.
pub unsafe fn keep_state(model: &Model, to: *mut *mut c_void) -> Status {
    // SAFETY: as promised by the caller.
    let Some(to) = (unsafe { to.as_mut() }) else {
        return ERROR;
    };
    // SAFETY: as promised by the caller.
    match unsafe { to.cast::<Vec<u8>>().as_mut() } {
        Some(kept) => *kept = model.state(),
        None => *to = Box::into_raw(Box::new(model.state())).cast(),
    }
    OK
}

/// The bytes of a state behind a pointer.
///
/// # Safety
/// The pointer is null or of [`keep_state`].
pub unsafe fn state<'a>(pointer: *mut c_void) -> Option<&'a Vec<u8>> {
    // SAFETY: as promised by the caller.
    unsafe { pointer.cast::<Vec<u8>>().as_ref() }
}

/// Frees a state and forgets its pointer.
///
/// # Safety
/// As [`keep_state`].
pub unsafe fn free_state(to: *mut *mut c_void) -> Status {
    // SAFETY: as promised by the caller.
    let Some(to) = (unsafe { to.as_mut() }) else {
        return ERROR;
    };
    if !to.is_null() {
        // SAFETY: as promised by the caller.
        drop(unsafe { Box::from_raw(to.cast::<Vec<u8>>()) });
        *to = core::ptr::null_mut();
    }
    OK
}

/// A list of the other program; empty if it is null.
///
/// # Safety
/// The pointer is null or to as many elements.
pub unsafe fn list<'a, T>(pointer: *const T, count: usize) -> &'a [T] {
    if pointer.is_null() {
        return &[];
    }
    // SAFETY: as promised by the caller.
    unsafe { core::slice::from_raw_parts(pointer, count) }
}

/// A list of the other program to write to; empty if it is null.
///
/// # Safety
/// As [`list`], and nothing else uses it.
pub unsafe fn list_mut<'a, T>(pointer: *mut T, count: usize) -> &'a mut [T] {
    if pointer.is_null() {
        return &mut [];
    }
    // SAFETY: as promised by the caller.
    unsafe { core::slice::from_raw_parts_mut(pointer, count) }
}

/// Writes a value unless the pointer is null.
///
/// # Safety
/// The pointer is null or to room for such a value.
pub unsafe fn put<T>(pointer: *mut T, value: T) {
    // What was there may be no value of the type.
    if !pointer.is_null() {
        // SAFETY: as promised by the caller.
        unsafe { pointer.write(value) }
    }
}

/// The bytes of a text; `None` if it is null.
///
/// # Safety
/// The pointer is null or to a text that ends with a zero byte.
pub unsafe fn text<'a>(pointer: *const c_char) -> Option<&'a [u8]> {
    // SAFETY: as promised by the caller.
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) }.to_bytes())
}

/// Fine without variables of a type that no variable has, and without clocks and event indicators.
pub fn none(count: usize) -> Status {
    if count == 0 { OK } else { ERROR }
}

/// Functions of C that run a call on the instance of their first argument.
macro_rules! functions {
    ($($(#[$doc:meta])* $name:ident($($argument:ident: $of:ty),*) => $call:expr;)*) => {$(
        $(#[$doc])*
        #[unsafe(no_mangle)]
        #[allow(clippy::macro_metavars_in_unsafe)]
        pub unsafe extern "C" fn $name(c: Handle, $($argument: $of),*) -> Status {
            // SAFETY: the standard.
            unsafe { Own::with(c, $call) }
        }
    )*};
}
pub(super) use functions;

/// The functions that are the same in both versions but for their names.
macro_rules! shared_functions {
    (
        set_debug_logging: $set_debug_logging:ident,
        free_instance: $free_instance:ident,
        exit_initialization_mode: $exit_initialization_mode:ident,
        terminate: $terminate:ident,
        reset: $reset:ident,
        get_state: $get_state:ident,
        set_state: $set_state:ident,
        free_state: $free_state:ident,
        state_size: $state_size:ident,
        serialize_state: $serialize_state:ident,
        deserialize_state: $deserialize_state:ident,
        enter_event_mode: $enter_event_mode:ident,
        enter_continuous_time_mode: $enter_continuous_time_mode:ident,
        completed_integrator_step: $completed_integrator_step:ident,
        set_time: $set_time:ident,
        set_states: $set_states:ident,
        get_states: $get_states:ident,
        get_derivatives: $get_derivatives:ident,
        get_nominals: $get_nominals:ident,
        get_event_indicators: $get_event_indicators:ident $(,)?
    ) => {
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $free_instance(c: Handle) {
            // SAFETY: the standard.
            unsafe { Own::free(c) }
        }

        functions! {
            $set_debug_logging(on: Boolean, _count: usize, _categories: *const Name) => |instance| {
                instance.logging = on != 0;
                OK
            };
            $exit_initialization_mode() => |instance| {
                instance.model.start();
                OK
            };
            $terminate() => |_| OK;
            $reset() => Own::reset;
            $get_state(to: *mut *mut c_void) => |instance| keep_state(&instance.model, to);
            $set_state(from: *mut c_void) => |instance| match state(from) {
                Some(bytes) => {
                    let result = instance.model.restore(bytes);
                    instance.result(result)
                }
                None => ERROR,
            };
            $free_state(to: *mut *mut c_void) => |_| free_state(to);
            $state_size(from: *mut c_void, size: *mut usize) => |_| match state(from) {
                Some(bytes) => {
                    put(size, bytes.len());
                    OK
                }
                None => ERROR,
            };
            $serialize_state(from: *mut c_void, to: *mut u8, size: usize) => |_| {
                match state(from).zip(Some(list_mut(to, size))) {
                    Some((bytes, to)) if to.len() == bytes.len() => {
                        to.copy_from_slice(bytes);
                        OK
                    }
                    _ => ERROR,
                }
            };
            $deserialize_state(from: *const u8, size: usize, to: *mut *mut c_void) => |instance| {
                // The copy checks the bytes without touching the instance.
                let mut copy = instance.model.clone();
                let result = copy.restore(list(from, size));
                match instance.result(result) {
                    OK => keep_state(&copy, to),
                    status => status,
                }
            };
            $enter_event_mode() => |_| OK;
            $enter_continuous_time_mode() => |_| OK;
            $completed_integrator_step(
                _no_earlier: Boolean,
                enter_event_mode: *mut Boolean,
                terminate: *mut Boolean
            ) => |_| {
                put(enter_event_mode, 0);
                put(terminate, 0);
                OK
            };
            $set_time(time: f64) => |instance| {
                instance.model.set_time(time);
                OK
            };
            $set_states(values: *const f64, count: usize) => |instance| instance.set_continuous(list(values, count));
            $get_states(values: *mut f64, count: usize) => |instance| {
                instance.get_continuous(Causality::State, list_mut(values, count))
            };
            $get_derivatives(values: *mut f64, count: usize) => |instance| {
                instance.get_continuous(Causality::Derivative, list_mut(values, count))
            };
            $get_nominals(values: *mut f64, count: usize) => |instance| instance.get_nominals(list_mut(values, count));
            /// There are no event indicators.
            $get_event_indicators(_values: *mut f64, count: usize) => |_| none(count);
        }
    };
}
pub(super) use shared_functions;
