//! The server of the page: HTTP on the loopback address, for browsers on this computer only.
//!
//! Every request passes [`guard`] before anything else. One thread serves all connections; each piece of work runs on a thread of its own
//! and is interrupted when the page no longer waits for it.

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
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use gearloss_framework::language::Language;
use gearloss_studies::analyses::head::fnv1a_64;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::task::JoinHandle;
use tokio::time::{Instant, sleep};

use crate::disk::Folder;
use crate::session::Session;

use guard::Guard;
use work::Work;

/// Connections at once: two browsers with six each, and some that are being closed.
const MOST_CONNECTIONS: usize = 16;

/// How long the head of a request may take.
const SLOWEST_HEAD: Duration = Duration::from_secs(10);

/// Pause after an error of the system.
const PAUSE: Duration = Duration::from_millis(50);

/// How long the server waits for a page: for the first one, and after the last one.
const WAITS: [Duration; 2] = [Duration::from_mins(10), Duration::from_mins(1)];

/// Ports below those that systems hand out to connections: the first, and how many.
const PORTS: [u16; 2] = [20_000, 12_000];

/// Ports of one folder, for programs that serve it at the same time.
const PORTS_OF_FOLDER: u16 = 4;

/// A folder that is ready to be served.
#[derive(Debug)]
pub struct Served {
    listener: TcpListener,
    folder: Folder,
    guard: Guard,
    keep: bool,
}

impl Served {
    /// Binds the loopback address. The port follows from the folder if it is free, because a browser keeps unsaved texts by
    /// address: it finds them again after a restart. It is no secret; the token is.
    ///
    /// # Errors
    /// If the address cannot be bound, or the system has no random numbers.
    pub fn bind(folder: Folder, keep: bool) -> io::Result<Self> {
        let first = fnv1a_64(folder.root().to_string_lossy().as_bytes());
        let own = (0..PORTS_OF_FOLDER).map(|k| PORTS[0] + ((first + u64::from(k)) % u64::from(PORTS[1])) as u16);
        let bind = |port: u16| TcpListener::bind((Ipv4Addr::LOCALHOST, port));
        let bound = own.map(bind).find_map(Result::ok);
        let listener = bound.map_or_else(|| bind(0), Ok)?;
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
    /// Whether a request on it has shown the token.
    known: Arc<AtomicBool>,
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
        open.retain(|connection| !connection.task.is_finished());
        if open.len() >= MOST_CONNECTIONS {
            // Whoever has no token must not keep out those who have.
            let Some(stranger) = open
                .iter()
                .position(|connection| !connection.known.load(Ordering::Relaxed))
            else {
                continue;
            };
            open.remove(stranger).task.abort();
        }
        let known = Arc::new(AtomicBool::new(false));
        let (work, own) = (Arc::clone(&work), Arc::clone(&known));
        let task = tokio::spawn(async move {
            let service = service_fn(|request| {
                let (work, known) = (Arc::clone(&work), Arc::clone(&own));
                async move { Ok::<_, Infallible>(reply::reply(&work, request, &known).await) }
            });
            // A connection that breaks off concerns nobody else.
            let _ = http1::Builder::new()
                .timer(TokioTimer::new())
                .header_read_timeout(SLOWEST_HEAD)
                .serve_connection(TokioIo::new(stream), service)
                .await;
        });
        open.push(Connection { known, task });
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
