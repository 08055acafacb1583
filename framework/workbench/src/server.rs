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
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use gearloss_framework::language::Language;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::sync::Semaphore;
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

/// How long the server waits for a page: for the first one, and after the last one.
const WAITS: [Duration; 2] = [Duration::from_mins(10), Duration::from_mins(1)];

/// Ports that systems leave to programs: the first, and how many.
const PORTS: [u16; 2] = [49152, 16384];

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
        let mut hasher = DefaultHasher::new();
        folder.root().hash(&mut hasher);
        let port = PORTS[0] + (hasher.finish() % u64::from(PORTS[1])) as u16;
        let bind = |port: u16| TcpListener::bind((Ipv4Addr::LOCALHOST, port));
        let listener = bind(port).or_else(|_| bind(0))?;
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
        let connections = Arc::new(Semaphore::new(MOST_CONNECTIONS));
        let accepting = tokio::spawn(accept(listener, work, connections));
        if !keep {
            abandoned(&pages, &accepting).await;
            if !accepting.is_finished() {
                return Ok(());
            }
        }
        accepting.await.map_err(io::Error::other)?
    })
}

async fn accept(listener: tokio::net::TcpListener, work: Arc<Work>, connections: Arc<Semaphore>) -> io::Result<()> {
    loop {
        let (stream, from): (_, SocketAddr) = listener.accept().await?;
        // One that is too many waits for none: it is closed.
        let Ok(permit) = Arc::clone(&connections).try_acquire_owned() else {
            continue;
        };
        debug_assert!(from.ip().is_loopback());
        let work = Arc::clone(&work);
        tokio::spawn(async move {
            let service = service_fn(|request| {
                let work = Arc::clone(&work);
                async move { Ok::<_, Infallible>(reply::reply(&work, request).await) }
            });
            // A connection that breaks off concerns nobody else.
            let _ = http1::Builder::new()
                .timer(TokioTimer::new())
                .header_read_timeout(SLOWEST_HEAD)
                .serve_connection(TokioIo::new(stream), service)
                .await;
            drop(permit);
        });
    }
}

/// Returns when no page has been open for a while, or when nothing is accepted any more.
async fn abandoned(pages: &AtomicUsize, accepting: &JoinHandle<io::Result<()>>) {
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
