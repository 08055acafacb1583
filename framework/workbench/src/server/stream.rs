//! The bodies of answers: whole, or growing by lines of JSON.

use std::convert::Infallible;
use std::pin::Pin;
use std::task::{Context, Poll};

use hyper::body::{Body, Bytes, Frame, SizeHint};
use tokio::sync::mpsc::{Receiver, Sender, channel};

use super::activity::Busy;
use super::work::Interrupt;

/// Lines that wait for a page. One that does not read stops what writes them, instead of filling the memory.
const MOST_LINES: usize = 16;

/// The body of an answer.
pub enum Answered {
    /// All at once.
    Whole(Option<Bytes>),
    /// Line by line.
    Lines {
        /// What is written.
        lines: Receiver<Bytes>,
        /// The work is interrupted when nobody reads any more.
        _interrupt: Interrupt,
    },
}

impl Answered {
    /// A body of lines, and where they are written.
    pub fn lines(interrupt: Interrupt) -> (Sender<Bytes>, Self) {
        let (sender, lines) = channel(MOST_LINES);
        let body = Self::Lines {
            lines,
            _interrupt: interrupt,
        };
        (sender, body)
    }
}

/// An answer, during which its connection is busy.
pub struct Answer {
    pub answered: Answered,
    pub _busy: Busy,
}

impl Body for Answer {
    type Data = Bytes;
    type Error = Infallible;

    fn poll_frame(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Result<Frame<Bytes>, Infallible>>> {
        let next = match &mut self.get_mut().answered {
            Answered::Whole(bytes) => Poll::Ready(bytes.take()),
            Answered::Lines { lines, .. } => lines.poll_recv(cx),
        };
        next.map(|bytes| bytes.map(|bytes| Ok(Frame::data(bytes))))
    }

    /// With its length an answer needs no marks of its parts.
    fn size_hint(&self) -> SizeHint {
        match &self.answered {
            Answered::Whole(bytes) => SizeHint::with_exact(bytes.as_ref().map_or(0, |bytes| bytes.len() as u64)),
            Answered::Lines { .. } => SizeHint::default(),
        }
    }
}
