//! Work for the page: on threads of its own, interrupted when nobody waits for it.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use gearloss_studies::engine::progress::{Progress, Silent, Steps};
use hyper::body::Bytes;
use serde_json::{Value, json};
use tokio::sync::mpsc::Sender;
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::time::timeout;

use super::guard::{Guard, secret};
use super::stream::Answered;
use super::watch::{self, Pace};
use crate::answer::Fault;
use crate::request::Request;
use crate::session::Session;
use crate::study::Listener;

/// Reports that are kept; the oldest is forgotten.
const MOST_REPORTS: usize = 8;

/// Runs of studies at once.
const MOST_RUNS: usize = 4;

/// How long a request waits for its turn.
const PATIENCE: Duration = Duration::from_secs(30);

/// What all connections share.
pub struct Work {
    pub session: Arc<Session<'static>>,
    pub guard: Guard,
    /// Number of pages that watch their files.
    pages: Arc<AtomicUsize>,
    /// Turns to compute an answer, one for each core. Reading and saving need none.
    turns: Arc<Semaphore>,
    /// Turns to run a study.
    runs: Arc<Semaphore>,
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
            turns: Arc::new(Semaphore::new(turns())),
            runs: Arc::new(Semaphore::new(MOST_RUNS)),
            reports: Mutex::default(),
        }
    }

    /// The report of an address.
    pub fn report(&self, address: &str) -> Option<Bytes> {
        let reports = self.reports.lock().unwrap_or_else(PoisonError::into_inner);
        let found = reports.iter().find(|(known, _)| known == address);
        found.map(|(_, html)| html.clone())
    }

    /// Answers a request; `None` if it has waited for its turn for too long.
    pub async fn answer(self: &Arc<Self>, request: Request) -> Option<Answered> {
        let interrupt = Interrupt::default();
        let token = interrupt.token();
        match request {
            Request::Watch { files } => {
                let (lines, body) = Answered::lines(interrupt);
                let page = OpenPage::new(&self.pages);
                let session = Arc::clone(&self.session);
                tokio::spawn(watch::watch(session, files, lines, page, Pace::default()));
                Some(body)
            }
            Request::Run { texts, study, analyses } => {
                let turn = self.turn(&self.runs).await?;
                let (lines, body) = Answered::lines(interrupt);
                let work = Arc::clone(self);
                tokio::task::spawn_blocking(move || {
                    let _turn = turn;
                    let events = Events {
                        work: &work,
                        lines,
                        token,
                    };
                    let run = || work.session.run(&texts, &study, &analyses, &events);
                    if catch_unwind(AssertUnwindSafe(run)).is_err() {
                        events.event(json!({ "event": "fault", "fault": bug() }));
                    }
                });
                Some(body)
            }
            request => {
                let turn = if request.computes() {
                    Some(self.turn(&self.turns).await?)
                } else {
                    None
                };
                let session = Arc::clone(&self.session);
                let work = tokio::task::spawn_blocking(move || {
                    // Until the work has ended, whether somebody still waits for it or not.
                    let _turn = turn;
                    let answer = || session.answer(&request, &token).to_string();
                    catch_unwind(AssertUnwindSafe(answer)).ok()
                });
                let answer = work.await.ok().flatten();
                // Here the page still waits; if it did not, this future would have been dropped with the interrupt.
                drop(interrupt);
                let answer = answer.unwrap_or_else(|| json!({ "fault": bug() }).to_string());
                Some(Answered::Whole(Some(answer.into())))
            }
        }
    }

    /// Waits for a turn. A request whose page does not wait any more gives its place in the queue up.
    async fn turn(&self, turns: &Arc<Semaphore>) -> Option<OwnedSemaphorePermit> {
        let turn = timeout(PATIENCE, Arc::clone(turns).acquire_owned()).await;
        turn.ok()?.ok()
    }
}

/// Number of answers that are computed at once: a short one does not wait for a map on one core.
fn turns() -> usize {
    std::thread::available_parallelism().map_or(2, |cores| cores.get().max(2))
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
    lines: Sender<Bytes>,
    token: Token,
}

impl Listener for Events<'_> {
    /// Waits until the page has read what came before. Progress does not: the next one replaces it.
    fn event(&self, event: Value) {
        let line = format!("{event}\n").into();
        let _ = match event["event"].as_str() {
            Some("progress") => self.lines.try_send(line).map_err(drop),
            _ => self.lines.blocking_send(line).map_err(drop),
        };
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
    #![allow(clippy::unwrap_used)]
    use std::collections::BTreeMap;
    use std::io::{self, Read as _, Write as _};
    use std::path::Path;

    use gearloss_framework::files::{FileSource, SharedSource};
    use gearloss_framework::language::Language;
    use gearloss_plugins as _;

    use super::*;
    use crate::store::{Saved, Store};

    /// A store whose files are read when the gate is open, and counted.
    #[derive(Debug, Default)]
    struct Gated {
        begun: AtomicUsize,
        is_open: AtomicBool,
    }

    impl FileSource for GatedStore {
        fn read(&self, _: &Path, _: u64) -> io::Result<Vec<u8>> {
            self.0.begun.fetch_add(1, Ordering::SeqCst);
            while !self.0.is_open.load(Ordering::SeqCst) {
                std::thread::sleep(Duration::from_millis(1));
            }
            Err(io::ErrorKind::NotFound.into())
        }
    }

    #[derive(Debug)]
    struct GatedStore(Arc<Gated>);

    impl Store for GatedStore {
        fn name(&self) -> String {
            String::new()
        }
        fn names(&self) -> Vec<String> {
            Vec::new()
        }
        fn check(&self, _: &str) -> Result<(), Fault> {
            Ok(())
        }
        fn text(&self, _: &str) -> Result<Option<String>, Fault> {
            Ok(Some(
                self.0.begun.fetch_add(1, Ordering::SeqCst).to_string().repeat(1000),
            ))
        }
        fn save(&self, _: &str, _: &str, _: Option<&str>) -> Result<Saved, Fault> {
            Ok(Saved::Saved(String::new()))
        }
        fn source(&self) -> SharedSource {
            Arc::new(Self(Arc::clone(&self.0)))
        }
    }

    fn work(gate: &Arc<Gated>) -> Arc<Work> {
        let language = Box::leak(Box::new(Language::linked().unwrap()));
        let session = Session::new(language, Arc::new(GatedStore(Arc::clone(gate))));
        Arc::new(Work::new(Arc::new(session), Guard::new(1).unwrap(), Arc::default()))
    }

    fn runtime() -> tokio::runtime::Runtime {
        let mut builder = tokio::runtime::Builder::new_current_thread();
        builder.enable_all().build().unwrap()
    }

    fn drawing() -> Request {
        Request::Drawing {
            texts: BTreeMap::new(),
            gearbox: "gearbox.yaml".to_owned(),
        }
    }

    /// A page that has gone leaves no queue of work behind; saving does not wait for it.
    #[test]
    fn requests_that_nobody_waits_for_are_not_begun() {
        let gate = Arc::new(Gated::default());
        let work = work(&gate);
        runtime().block_on(async {
            let asked: Vec<_> = (0..50)
                .map(|_| {
                    let work = Arc::clone(&work);
                    tokio::spawn(async move { work.answer(drawing()).await.is_some() })
                })
                .collect();
            while gate.begun.load(Ordering::SeqCst) < turns() {
                tokio::time::sleep(Duration::from_millis(1)).await;
            }
            let read = Request::Read {
                file: "gearbox.yaml".to_owned(),
            };
            assert!(work.answer(read).await.is_some());
            for request in asked {
                request.abort();
            }
            tokio::time::sleep(Duration::from_millis(20)).await;
            gate.is_open.store(true, Ordering::SeqCst);
            // Whoever still asks has a turn.
            assert!(work.answer(drawing()).await.is_some());
        });
        assert_eq!(gate.begun.load(Ordering::SeqCst), turns() + 2);
    }

    /// The same over sockets: a connection that is closed takes its request out of the queue.
    #[test]
    fn a_closed_connection_takes_its_request_back() {
        let gate = Arc::new(Gated::default());
        let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        listener.set_nonblocking(true).unwrap();
        let address = listener.local_addr().unwrap();
        let mut work = work(&gate);
        let guard = Guard::new(address.port()).unwrap();
        let token = guard.address().split_once("#t=").unwrap().1.to_owned();
        Arc::get_mut(&mut work).unwrap().guard = guard;
        std::thread::spawn(move || {
            runtime().block_on(async {
                super::super::accept(tokio::net::TcpListener::from_std(listener).unwrap(), work).await;
            });
        });
        let body = r#"{"request":"drawing","texts":{},"gearbox":"gearbox.yaml"}"#;
        let ask = || {
            let mut stream = std::net::TcpStream::connect(address).unwrap();
            let head = format!(
                "POST /api HTTP/1.1\r\nHost: {address}\r\nAuthorization: Bearer {token}\r\nContent-Type: application/json\r\n\
                 Connection: close\r\nContent-Length: {}\r\n\r\n{body}",
                body.len()
            );
            stream.write_all(head.as_bytes()).unwrap();
            stream
        };
        let asked: Vec<_> = (0..50).map(|_| ask()).collect();
        while gate.begun.load(Ordering::SeqCst) < turns() {
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_millis(300));
        drop(asked);
        std::thread::sleep(Duration::from_millis(700));
        gate.is_open.store(true, Ordering::SeqCst);
        let mut answer = String::new();
        ask().read_to_string(&mut answer).unwrap();
        assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
        assert_eq!(gate.begun.load(Ordering::SeqCst), turns() + 1);
    }

    /// A page that does not read stops its watch, which then reads no files, and ends it after a while.
    #[test]
    fn a_watch_that_nobody_reads_is_bounded() {
        let gate = Arc::new(Gated::default());
        let work = work(&gate);
        let pages = Arc::new(AtomicUsize::new(0));
        let (lines, mut body) = Answered::lines(Interrupt::default());
        let pace = Pace {
            period: Duration::ZERO,
            patience: Duration::from_millis(300),
        };
        let files = BTreeMap::from([("gearbox.yaml".to_owned(), String::new())]);
        runtime().block_on(async {
            let session = Arc::clone(&work.session);
            let watched = tokio::spawn(watch::watch(session, files, lines, OpenPage::new(&pages), pace));
            tokio::time::sleep(Duration::from_millis(150)).await;
            let before = gate.begun.load(Ordering::SeqCst);
            assert_eq!(pages.load(Ordering::SeqCst), 1);
            assert!((1..=10).contains(&before), "the file was read {before} times");
            watched.await.unwrap();
            assert_eq!(gate.begun.load(Ordering::SeqCst), before);
            assert_eq!(pages.load(Ordering::SeqCst), 0, "the page counts as open");
        });
        let Answered::Lines { lines, .. } = &mut body else {
            panic!("no lines");
        };
        let kept = std::iter::from_fn(|| lines.try_recv().ok()).count();
        assert!((2..=20).contains(&kept), "{kept} lines are kept");
    }

    /// Events of a run that nobody reads wait, but progress is left out, so that no work is stopped by it.
    #[test]
    fn progress_that_nobody_reads_is_left_out() {
        let work = work(&Arc::default());
        let (lines, mut body) = Answered::lines(Interrupt::default());
        let events = Events {
            work: &work,
            lines,
            token: Interrupt::default().token(),
        };
        for done in 0..1000 {
            events.event(json!({ "event": "progress", "done": done }));
        }
        let Answered::Lines { lines, .. } = &mut body else {
            panic!("no lines");
        };
        let kept = std::iter::from_fn(|| lines.try_recv().ok()).count();
        assert!((1..100).contains(&kept), "{kept} lines are kept");
    }

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
