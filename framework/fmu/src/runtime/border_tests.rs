//! The border to C as another program uses it; `.ci/miri` runs these tests under Miri.

use alloc::ffi::CString;
use core::ffi::{CStr, c_char, c_void};
use core::ptr::{null, null_mut};
use std::sync::atomic::{AtomicU32, Ordering};

use super::content::tests::network;
use super::content::{Content, token};
use super::fmi3::*;

/// What the logger is given: the instance that it asks, and what it got.
struct Environment {
    instance: *mut c_void,
    messages: Vec<String>,
    answers: Vec<i32>,
}

/// A logger that calls a function of the instance whose message it gets.
unsafe extern "C" fn logger(environment: *mut c_void, status: i32, _: *const c_char, text: *const c_char) {
    // SAFETY: the environment is that of `Program`, and the text ends with a zero byte.
    unsafe {
        let program = &mut *environment.cast::<Environment>();
        let text = CStr::from_ptr(text).to_string_lossy().into_owned();
        program.messages.push(format!("{status} {text}"));
        let mut count = 0;
        program
            .answers
            .push(fmi3GetNumberOfContinuousStates(program.instance, &raw mut count));
    }
}

/// A folder of resources and an instance of them.
struct Program {
    folder: std::path::PathBuf,
    environment: *mut Environment,
    instance: *mut c_void,
}

impl Program {
    fn new(logging: u8) -> Self {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let folder = std::env::temp_dir().join(format!("gearloss-border-{}-{number}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder for the test");
        let bytes = Content::Network(network()).encode();
        std::fs::write(folder.join("network.bin"), &bytes).expect("room for the test");
        let resources = CString::new(folder.to_str().expect("a plain path")).expect("no zero byte");
        let token = CString::new(token(&bytes).to_vec()).expect("no zero byte");
        let environment = Box::into_raw(Box::new(Environment {
            instance: null_mut(),
            messages: Vec::new(),
            answers: Vec::new(),
        }));
        // SAFETY: all pointers are to texts that end with a zero byte, or to the environment.
        let instance = unsafe {
            let (name, environment) = (c"name".as_ptr(), environment.cast());
            fmi3InstantiateModelExchange(
                name,
                token.as_ptr(),
                resources.as_ptr(),
                7,
                logging,
                environment,
                Some(logger),
            )
        };
        assert!(!instance.is_null());
        // SAFETY: the environment is a box of its own.
        unsafe { (*environment).instance = instance };
        Self {
            folder,
            environment,
            instance,
        }
    }

    /// Frees the instance; the messages, and what the instance answered to the logger.
    fn end(self) -> (Vec<String>, Vec<i32>) {
        // SAFETY: neither is used any more.
        let environment = unsafe {
            fmi3FreeInstance(self.instance);
            Box::from_raw(self.environment)
        };
        let _ = std::fs::remove_dir_all(self.folder);
        (environment.messages, environment.answers)
    }
}

#[test]
fn a_logger_may_call_the_instance_whose_message_it_gets() {
    let program = Program::new(1);
    let (references, mut values) = ([9999_u32], [0.0]);
    // SAFETY: both lists have one element.
    let status = unsafe { fmi3GetFloat64(program.instance, references.as_ptr(), 1, values.as_mut_ptr(), 1) };
    assert_eq!(status, 3);
    let (messages, answers) = program.end();
    assert_eq!(messages, ["3 there is no variable with this value reference and type"]);
    assert_eq!(answers, [0]);
}

#[test]
fn a_boolean_of_another_program_may_have_any_bits() {
    let program = Program::new(255);
    let (mut event, mut terminate, mut early, mut last) = (170_u8, 85_u8, 255_u8, 0.0);
    let values = [2_u8];
    // SAFETY: all pointers are to such values.
    unsafe {
        let instance = program.instance;
        assert_eq!(fmi3SetDebugLogging(instance, 128, 0, null()), 0);
        assert_eq!(fmi3EnterInitializationMode(instance, 3, 0.0, 0.0, 9, 1.0), 0);
        assert_eq!(fmi3ExitInitializationMode(instance), 0);
        let [event, terminate, early] = [&raw mut event, &raw mut terminate, &raw mut early];
        assert_eq!(
            fmi3DoStep(instance, 0.0, 1.0, 4, event, terminate, early, &raw mut last),
            0
        );
        // No variable takes a boolean.
        assert_eq!(fmi3SetBoolean(instance, [9999].as_ptr(), 1, values.as_ptr(), 1), 3);
    }
    assert_eq!((event, terminate, early, last), (0, 0, 0, 1.0));
    program.end();
}

#[test]
fn a_state_is_kept_serialised_and_restored() {
    let program = Program::new(0);
    let instance = program.instance;
    let (mut state, mut copy, mut size, mut last) = (null_mut(), null_mut(), 0, 0.0);
    let mut before = [0.0; 8];
    let mut after = before;
    // SAFETY: all pointers are to such values; states are freed once.
    unsafe {
        let mut count = 0;
        fmi3GetNumberOfContinuousStates(instance, &raw mut count);
        assert!(count > 0 && count <= before.len());
        assert_eq!(fmi3GetFMUState(instance, &raw mut state), 0);
        assert_eq!(fmi3SerializedFMUStateSize(instance, state, &raw mut size), 0);
        let mut bytes = vec![0_u8; size];
        assert_eq!(fmi3SerializeFMUState(instance, state, bytes.as_mut_ptr(), size), 0);
        assert_eq!(fmi3GetContinuousStates(instance, before.as_mut_ptr(), count), 0);
        let [event, terminate, early] = [null_mut(); 3];
        assert_eq!(
            fmi3DoStep(instance, 0.0, 1.0, 0, event, terminate, early, &raw mut last),
            0
        );
        assert_eq!(
            fmi3DeserializeFMUState(instance, bytes.as_ptr(), size, &raw mut copy),
            0
        );
        assert_eq!(fmi3SetFMUState(instance, copy), 0);
        assert_eq!(fmi3GetContinuousStates(instance, after.as_mut_ptr(), count), 0);
        assert_eq!(before, after);
        fmi3FreeFMUState(instance, &raw mut state);
        fmi3FreeFMUState(instance, &raw mut copy);
    }
    assert!(state.is_null() && copy.is_null());
    program.end();
}
