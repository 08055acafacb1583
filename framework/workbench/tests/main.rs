//! Requests of the page, forms, files and the server.
#![allow(clippy::unwrap_used, clippy::too_many_lines)]

// The built-in models register themselves.
use gearloss_plugins as _;

mod common;
mod files;
mod forms;
mod requests;
mod server;
mod studies;
