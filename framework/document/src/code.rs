//! Stable codes of findings: a program compares codes, a reader looks them up. Messages may be put better at any time.

use std::fmt;

use serde::{Serialize, Serializer};

/// The kind of a finding. Errors begin with `E`, warnings with `W`. A code keeps its meaning; one that is no longer used is not
/// given to another kind.
#[derive(Clone, Copy)]
pub struct Code(&'static CodeEntry);

/// What the list of codes says of one.
#[doc(hidden)]
#[derive(Debug)]
pub struct CodeEntry {
    pub id: &'static str,
    pub title: &'static str,
    pub cause: &'static str,
    pub help: &'static str,
}

impl Code {
    /// A code; use [`codes!`](crate::codes).
    #[doc(hidden)]
    pub const fn new(entry: &'static CodeEntry) -> Self {
        Self(entry)
    }

    /// The code, such as `E0101`.
    pub fn id(self) -> &'static str {
        self.0.id
    }

    /// What it is, in a few words.
    pub fn title(self) -> &'static str {
        self.0.title
    }

    /// What leads to it.
    pub fn cause(self) -> &'static str {
        self.0.cause
    }

    /// How to fix it.
    pub fn help(self) -> &'static str {
        self.0.help
    }
}

impl PartialEq for Code {
    fn eq(&self, other: &Self) -> bool {
        self.id() == other.id()
    }
}

impl Eq for Code {}

impl fmt::Debug for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.id())
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.id())
    }
}

impl Serialize for Code {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.id())
    }
}

/// Lists the codes of a crate: `UNKNOWN_KEY = "E0101", "title", cause: "...", help: "...";`. `ALL` holds them in this order.
#[macro_export]
macro_rules! codes {
    ($($NAME:ident = $id:literal, $title:literal, cause: $cause:literal, help: $help:literal;)*) => {
        $(
            #[doc = concat!($id, ": ", $title, ".")]
            pub const $NAME: $crate::Code = $crate::Code::new(&$crate::CodeEntry {
                id: $id,
                title: $title,
                cause: $cause,
                help: $help,
            });
        )*

        /// All codes of this crate.
        pub const ALL: &[$crate::Code] = &[$($NAME),*];
    };
}
