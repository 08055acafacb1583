//! Answers that grow: lines of JSON.

use std::convert::Infallible;
use std::pin::Pin;
use std::task::{Context, Poll};

use hyper::body::{Body, Bytes, Frame, SizeHint};
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

use super::work::Interrupt;

/// The body of an answer.
pub enum Answered {
    /// All at once.
    Whole(Option<Bytes>),
    /// Line by line.
    Lines {
        /// What is written.
        lines: UnboundedReceiver<Bytes>,
        /// The work is interrupted when nobody reads any more.
        _interrupt: Interrupt,
    },
}

impl Answered {
    /// A body of lines, and where they are written.
    pub fn lines(interrupt: Interrupt) -> (UnboundedSender<Bytes>, Self) {
        let (sender, lines) = unbounded_channel();
        let body = Self::Lines {
            lines,
            _interrupt: interrupt,
        };
        (sender, body)
    }
}

impl Body for Answered {
    type Data = Bytes;
    type Error = Infallible;

    fn poll_frame(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Result<Frame<Bytes>, Infallible>>> {
        let next = match self.get_mut() {
            Self::Whole(bytes) => Poll::Ready(bytes.take()),
            Self::Lines { lines, .. } => lines.poll_recv(cx),
        };
        next.map(|bytes| bytes.map(|bytes| Ok(Frame::data(bytes))))
    }
    /// With its length an answer needs no marks of its parts.
    fn size_hint(&self) -> SizeHint {
        match self {
            Self::Whole(bytes) => SizeHint::with_exact(bytes.as_ref().map_or(0, |bytes| bytes.len() as u64)),
            Self::Lines { .. } => SizeHint::default(),
        }
    }
}
