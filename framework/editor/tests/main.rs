//! The editing engine on documents with a cursor, written `|`.
#![allow(clippy::unwrap_used, clippy::too_many_lines)]

// The built-in models register themselves.
use gearloss_plugins as _;

mod common;
mod completion;
mod findings;
mod hover;
mod marks;
mod names;
mod outline;
mod prefixes;
mod requests;
mod server;
