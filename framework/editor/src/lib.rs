//! Editing of gearboxes and studies: findings, completion, explanations, definitions, references, renaming and outline.
//!
//! [`Workspace`] holds the texts that are open; files that they name are read from a [`FileSource`](gearloss_document::files::FileSource)
//! below them. [`Workspace::answer`] takes a [`Request`] and gives an [`Answer`], both of which are JSON. [`lsp`] serves the same over the
//! Language Server Protocol.
//!
//! Everything that is suggested or explained comes from the published schema of the linked models, and from the documents themselves.

mod complete;
mod cursor;
mod findings;
pub mod folder;
mod hover;
mod ids;
pub mod lsp;
mod navigate;
pub mod outline;
mod place;
mod request;
mod symbols;
mod text;
mod workspace;

pub use complete::{Completion, Suggested};
pub use findings::{FileRange, Finding, Related};
pub use hover::Hover;
pub use navigate::{Edit, FileEdits, NoRename};
pub use request::{Answer, Request};
pub use symbols::Symbol;
pub use text::{Encoding, Lines, Position, TextRange};
pub use workspace::Workspace;
