//! The workbench as WebAssembly: JSON in, JSON out, over linear memory.
//!
//! [`allocate`] gives the place of a request, [`answer`] that of its answer: four bytes with its length, least first, then its text.
//! [`release`] frees an answer. There is one thread, so a run of a study is answered by all of its events at once.

// Natively there is nothing to build.
#![cfg(target_family = "wasm")]

use std::alloc::{Layout, alloc, dealloc};
use std::cell::{OnceCell, RefCell};
use std::sync::{Arc, Mutex, PoisonError};

use gearloss_framework::language::Language;
use gearloss_studies::engine::progress::Silent;
use gearloss_workbench::request::Request;
use gearloss_workbench::store::Memory;
use gearloss_workbench::{Listener, Session};
use serde_json::{Value, json};

/// Length of the length before an answer.
const HEAD: usize = 4;

thread_local! {
    static SESSION: OnceCell<Result<Session<'static>, String>> = const { OnceCell::new() };
    /// Place and length of what is lent.
    static LENT: RefCell<Vec<(usize, usize)>> = const { RefCell::new(Vec::new()) };
}

/// Memory for a request of this length; zero if there is none.
#[unsafe(no_mangle)]
pub extern "C" fn allocate(length: usize) -> usize {
    let Ok(layout) = Layout::array::<u8>(length.max(1)) else {
        return 0;
    };
    // SAFETY: the layout is not empty.
    let place = unsafe { alloc(layout) } as usize;
    if place != 0 {
        LENT.with_borrow_mut(|lent| lent.push((place, length)));
    }
    place
}

/// Frees memory that [`allocate`] or [`answer`] gave; another place is ignored.
#[unsafe(no_mangle)]
pub extern "C" fn release(place: usize) {
    let known = LENT.with_borrow_mut(|lent| {
        let entry = lent.iter().position(|(known, _)| *known == place)?;
        Some(lent.swap_remove(entry))
    });
    if let Some((place, length)) = known
        && let Ok(layout) = Layout::array::<u8>(length.max(1))
    {
        // SAFETY: it was allocated with this layout and is freed once, because it is no longer in the list.
        unsafe { dealloc(place as *mut u8, layout) };
    }
}

/// Answers the request at a place that [`allocate`] gave; the place of the answer, or zero if there is no memory.
#[unsafe(no_mangle)]
pub extern "C" fn answer(place: usize) -> usize {
    let known = LENT.with_borrow(|lent| lent.iter().find(|(known, _)| *known == place).copied());
    let text = match known {
        // SAFETY: it is memory of this length that was lent, and the page has written it.
        Some((place, length)) => answered(unsafe { std::slice::from_raw_parts(place as *const u8, length) }),
        None => fault("the request is not in memory that was allocated for it"),
    };
    let text = text.to_string();
    let Ok(length) = u32::try_from(text.len()) else {
        return 0;
    };
    let place = allocate(HEAD + text.len());
    if place != 0 {
        // SAFETY: the memory was allocated with this length.
        let bytes = unsafe { std::slice::from_raw_parts_mut(place as *mut u8, HEAD + text.len()) };
        bytes[..HEAD].copy_from_slice(&length.to_le_bytes());
        bytes[HEAD..].copy_from_slice(text.as_bytes());
    }
    place
}

fn fault(message: &str) -> Value {
    json!({ "fault": { "message": message, "help": null, "findings": [] } })
}

fn answered(request: &[u8]) -> Value {
    let Ok(request) = serde_json::from_slice::<Request>(request) else {
        return fault("this request is not known");
    };
    SESSION.with(|session| match session.get_or_init(begun) {
        Err(message) => fault(message),
        Ok(session) => match &request {
            Request::Run { texts, study, analyses } => {
                let events = Events::default();
                session.run(texts, study, analyses, &events);
                let events = events.0.into_inner().unwrap_or_else(PoisonError::into_inner);
                json!({ "value": events })
            }
            request => session.answer(request, &Silent),
        },
    })
}

/// A session about the examples.
fn begun() -> Result<Session<'static>, String> {
    gearloss_plugins::link();
    let language = Language::linked().map_err(|findings| findings.render())?;
    let files = [
        (
            "two-speed-ev.yaml",
            include_str!("../../../examples/two-speed-ev/gearbox.yaml"),
        ),
        (
            "planetary-reducer.yaml",
            include_str!("../../../examples/planetary-reducer/gearbox.yaml"),
        ),
        ("drag.csv", include_str!("../../../examples/planetary-reducer/drag.csv")),
        ("study.yaml", include_str!("study.yaml")),
    ];
    let store = Memory::new("examples", files);
    Ok(Session::new(Box::leak(Box::new(language)), Arc::new(store)))
}

/// The events of a run.
#[derive(Default)]
struct Events(Mutex<Vec<Value>>);

impl Listener for Events {
    fn event(&self, event: Value) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(event);
    }

    /// There is no server: the page makes an address of the report itself.
    fn report(&self, html: String) -> String {
        html
    }

    fn should_continue(&self) -> bool {
        true
    }
}
