//! The server of the page: HTTP on the loopback address, for browsers on this computer only.
//!
//! Every request passes [`guard`] before anything else. One thread serves all connections; each piece of work runs on a thread of its own
//! and is interrupted when the page no longer waits for it.

mod activity;
mod guard;
mod page;
mod reply;
mod stream;
mod watch;
mod work;

use std::convert::Infallible;
use std::io;
use std::net::{Ipv4Addr, TcpListener};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use gearloss_framework::language::Language;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::task::JoinHandle;
use tokio::time::{Instant, sleep};

use crate::disk::Folder;
use crate::session::Session;

use activity::Activity;
use guard::Guard;
use work::Work;

/// Connections at once: several browsers with six each. Others wait in the queue of the system.
const MOST_CONNECTIONS: usize = 64;

/// Maximum length of the head of a request. \[byte\]
const LONGEST_HEAD: usize = 64 << 10;

/// How long the head of a request may take.
const SLOWEST_HEAD: Duration = Duration::from_secs(10);

/// Pause after an error of the system.
const PAUSE: Duration = Duration::from_millis(50);

/// Time between two looks for a place, if there is none.
const TURN: Duration = Duration::from_millis(5);

/// How long the server waits for a page: for the first one, and after the last one.
const WAITS: [Duration; 2] = [Duration::from_mins(10), Duration::from_mins(1)];

/// A folder that is ready to be served.
#[derive(Debug)]
pub struct Served {
    listener: TcpListener,
    folder: Folder,
    guard: Guard,
    keep: bool,
}

impl Served {
    /// Binds the loopback address, at a port that the system chooses: an address that others know before could be theirs when a browser
    /// opens it, and what a browser keeps for an address is theirs, too.
    ///
    /// # Errors
    /// If the address cannot be bound, or the system has no random numbers.
    pub fn bind(folder: Folder, keep: bool) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        listener.set_nonblocking(true)?;
        let port = listener.local_addr()?.port();
        Ok(Self {
            guard: Guard::new(port)?,
            listener,
            folder,
            keep,
        })
    }

    /// The address of the page with its token. Browsers do not send the part after `#`.
    pub fn address(&self) -> String {
        self.guard.address()
    }
}

/// Serves until the last page has been closed for a minute, or for ever if the program shall stay.
///
/// # Errors
/// If the sockets of the system fail.
pub fn serve(language: &'static Language, served: Served) -> io::Result<()> {
    let Served {
        listener,
        folder,
        guard,
        keep,
    } = served;
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let pages = Arc::new(AtomicUsize::new(0));
    let work = Arc::new(Work::new(
        Arc::new(Session::new(language, Arc::new(folder))),
        guard,
        Arc::clone(&pages),
    ));
    runtime.block_on(async move {
        let listener = tokio::net::TcpListener::from_std(listener)?;
        let accepting = tokio::spawn(accept(listener, work));
        if !keep {
            abandoned(&pages, &accepting).await;
            if !accepting.is_finished() {
                return Ok(());
            }
        }
        accepting.await.map_err(io::Error::other)
    })
}

/// A connection that is open.
struct Connection {
    activity: Arc<Activity>,
    task: JoinHandle<()>,
}

/// Accepts connections for ever.
async fn accept(listener: tokio::net::TcpListener, work: Arc<Work>) {
    let mut open: Vec<Connection> = Vec::new();
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            // One that broke off at once, or no more sockets: others may follow.
            sleep(PAUSE).await;
            continue;
        };
        has_place(&mut open).await;
        let activity = Activity::begin();
        let (work, served) = (Arc::clone(&work), Arc::clone(&activity));
        let task = tokio::spawn(async move {
            let service = service_fn(|request| {
                let (work, served) = (Arc::clone(&work), Arc::clone(&served));
                async move { Ok::<_, Infallible>(reply::reply(&work, request, &served).await) }
            });
            // A connection that breaks off concerns nobody else.
            let _ = http1::Builder::new()
                .timer(TokioTimer::new())
                .header_read_timeout(SLOWEST_HEAD)
                .max_buf_size(LONGEST_HEAD)
                .serve_connection(TokioIo::new(stream), service)
                .await;
        });
        open.push(Connection { activity, task });
    }
}

/// Returns when there is a place for one more connection. Meanwhile new ones wait in the queue of the system; none is closed without an
/// answer that it may expect.
async fn has_place(open: &mut Vec<Connection>) {
    loop {
        open.retain(|connection| !connection.task.is_finished());
        if open.len() < MOST_CONNECTIONS {
            return;
        }
        let dispensable = open
            .iter()
            .enumerate()
            .filter_map(|(at, connection)| Some((connection.activity.dispensable()?, at)));
        match dispensable.max() {
            Some((_, at)) => open.swap_remove(at).task.abort(),
            None => sleep(TURN).await,
        }
    }
}

/// Returns when no page has been open for a while, or when nothing is accepted any more.
async fn abandoned(pages: &AtomicUsize, accepting: &JoinHandle<()>) {
    let mut since = Instant::now();
    let mut wait = WAITS[0];
    while !accepting.is_finished() {
        sleep(Duration::from_secs(1)).await;
        if pages.load(Ordering::Relaxed) > 0 {
            (since, wait) = (Instant::now(), WAITS[1]);
        } else if since.elapsed() > wait {
            return;
        }
    }
}
