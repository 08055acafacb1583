//! Work for the page: on threads of its own, interrupted when nobody waits for it.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use gearloss_studies::analyses::progress::{Progress, Silent, Steps};
use hyper::body::Bytes;
use serde_json::{Value, json};
use tokio::sync::mpsc::UnboundedSender;

use super::guard::{Guard, secret};
use super::stream::Answered;
use super::watch;
use crate::answer::Fault;
use crate::request::Request;
use crate::session::Session;
use crate::study::Listener;

/// Reports that are kept; the oldest is forgotten.
const MOST_REPORTS: usize = 8;

/// What all connections share.
pub struct Work {
    pub session: Arc<Session<'static>>,
    pub guard: Guard,
    /// Number of pages that watch their files.
    pages: Arc<AtomicUsize>,
    reports: Mutex<Vec<(String, Bytes)>>,
}

/// Interrupts work when it is dropped.
#[derive(Debug, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Drop for Interrupt {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl Interrupt {
    /// Tells the work whether somebody waits.
    pub fn token(&self) -> Token {
        Token(Arc::clone(&self.0))
    }
}

/// Whether somebody waits for the work.
#[derive(Debug, Clone)]
pub struct Token(Arc<AtomicBool>);

impl Token {
    /// False if nobody waits.
    pub fn is_wanted(&self) -> bool {
        !self.0.load(Ordering::Relaxed)
    }
}

impl Progress for Token {
    fn begin(&self, _: &str, _: usize) -> Box<dyn Steps + '_> {
        Box::new(Silent)
    }

    fn should_continue(&self) -> bool {
        self.is_wanted()
    }
}

impl Work {
    pub fn new(session: Arc<Session<'static>>, guard: Guard, pages: Arc<AtomicUsize>) -> Self {
        Self {
            session,
            guard,
            pages,
            reports: Mutex::default(),
        }
    }

    /// The report of an address.
    pub fn report(&self, address: &str) -> Option<Bytes> {
        let reports = self.reports.lock().unwrap_or_else(PoisonError::into_inner);
        let found = reports.iter().find(|(own, _)| own == address);
        found.map(|(_, html)| html.clone())
    }

    /// Answers a request.
    pub async fn answer(self: &Arc<Self>, request: Request) -> Answered {
        let interrupt = Interrupt::default();
        let token = interrupt.token();
        match request {
            Request::Watch { files } => {
                let (lines, body) = Answered::lines(interrupt);
                let page = OpenPage::new(&self.pages);
                let session = Arc::clone(&self.session);
                tokio::spawn(watch::watch(session, files, lines, page));
                body
            }
            Request::Run { texts, study, analyses } => {
                let (lines, body) = Answered::lines(interrupt);
                let own = Arc::clone(self);
                tokio::task::spawn_blocking(move || {
                    let events = Events {
                        work: &own,
                        lines,
                        token,
                    };
                    let run = || own.session.run(&texts, &study, &analyses, &events);
                    if catch_unwind(AssertUnwindSafe(run)).is_err() {
                        events.event(json!({ "event": "fault", "fault": bug() }));
                    }
                });
                body
            }
            request => {
                let session = Arc::clone(&self.session);
                let work = tokio::task::spawn_blocking(move || {
                    let answer = || session.answer(&request, &token).to_string();
                    catch_unwind(AssertUnwindSafe(answer)).ok()
                });
                let answer = work.await.ok().flatten();
                // Here the page still waits; if it did not, this future would have been dropped with the interrupt.
                drop(interrupt);
                let answer = answer.unwrap_or_else(|| json!({ "fault": bug() }).to_string());
                Answered::Whole(Some(answer.into()))
            }
        }
    }
}

fn bug() -> Fault {
    Fault::new(
        "bug: the computation ended in an unexpected way",
        "report it with the text that causes it",
    )
}

/// Events of a run as lines.
struct Events<'a> {
    work: &'a Work,
    lines: UnboundedSender<Bytes>,
    token: Token,
}

impl Listener for Events<'_> {
    fn event(&self, event: Value) {
        let _ = self.lines.send(format!("{event}\n").into());
    }

    fn report(&self, html: String) -> String {
        // Whoever knows the address may read the report, as an open tab does.
        let address = format!("/report/{}", secret().unwrap_or_default());
        let mut reports = self.work.reports.lock().unwrap_or_else(PoisonError::into_inner);
        if reports.len() >= MOST_REPORTS {
            reports.remove(0);
        }
        reports.push((address.clone(), html.into()));
        address
    }

    fn should_continue(&self) -> bool {
        self.token.is_wanted()
    }
}

/// A page that is open.
pub struct OpenPage(Arc<AtomicUsize>);

impl OpenPage {
    fn new(pages: &Arc<AtomicUsize>) -> Self {
        pages.fetch_add(1, Ordering::Relaxed);
        Self(Arc::clone(pages))
    }
}

impl Drop for OpenPage {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body that nobody reads any more ends its work.
    #[test]
    fn work_is_interrupted_when_its_answer_is_dropped() {
        let interrupt = Interrupt::default();
        let token = interrupt.token();
        let (_lines, body) = Answered::lines(interrupt);
        assert!(token.is_wanted() && token.should_continue());
        drop(body);
        assert!(!token.is_wanted() && !token.should_continue());
    }
}
