//! Printing without panics: a closed pipe ends the program quietly.

use std::io::{self, IsTerminal, Write};

use gearloss_framework::document::{Diagnostic, visible, visible_json};
use gearloss_framework::gearbox::Findings;
pub use gearloss_report::text::{TextTable as Table, figures, number, significant};
use gearloss_studies::analyses::Stopped;
use gearloss_studies::tasks::StorageError;
use serde::Serialize;

/// How a command ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// Success.
    Fine,
    /// A warning is treated as an error.
    Finding,
}

/// Why a command ended early.
#[derive(Debug)]
pub enum Failure {
    /// Findings in documents.
    Found(Findings),
    /// Other input errors, with the text to print.
    Input(String),
    /// Ctrl-C was pressed.
    Interrupted,
}

impl Failure {
    /// An input error with its help.
    pub fn input(message: impl std::fmt::Display, help: impl std::fmt::Display) -> Self {
        Self::Input(format!("error: {message}\n  = help: {help}\n"))
    }

    /// The text to print; empty after Ctrl-C.
    pub fn text(&self) -> Option<String> {
        match self {
            Self::Found(findings) => Some(findings.render()),
            Self::Input(text) => Some(text.clone()),
            Self::Interrupted => None,
        }
    }
}

impl From<Findings> for Failure {
    fn from(findings: Findings) -> Self {
        Self::Found(findings)
    }
}

/// One finding about something that is no document.
impl From<Diagnostic> for Failure {
    fn from(finding: Diagnostic) -> Self {
        match &finding.help {
            Some(help) => Self::input(&finding.message, help),
            None => Self::Input(format!("error: {}\n", finding.message)),
        }
    }
}

/// `Checked` is not a failure and is never converted.
impl From<Stopped> for Failure {
    fn from(stopped: Stopped) -> Self {
        match stopped {
            Stopped::Found(findings) => Self::Found(findings),
            Stopped::Several(list) => list.as_slice().into(),
            Stopped::Unwritten(error) => error.into(),
            Stopped::Interrupted | Stopped::Elsewhere => Self::Interrupted,
        }
    }
}

/// Results that cannot be written or read.
impl From<StorageError> for Failure {
    fn from(error: StorageError) -> Self {
        let help = match &error {
            StorageError::Write { .. } => "choose another folder with -o",
            StorageError::SameName(_) => "rename an analysis or a model set",
            StorageError::Encode(_) => "this is a bug of the analysis; run it without --shard",
            StorageError::Read { .. } => "run its shard again, then merge",
            StorageError::OtherTask { .. } => "delete the folders of the shards and run them again",
        };
        Self::input(error, help)
    }
}

/// Several input errors.
impl From<&[Findings]> for Failure {
    fn from(list: &[Findings]) -> Self {
        Self::Input(list.iter().map(Findings::render).collect())
    }
}

/// An error of standard output; errors of files contain the file name.
impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::input(
            format!("cannot write to the standard output: {error}"),
            "check its target, such as a full disk",
        )
    }
}

/// Output of a command. After its pipe is closed it prints nothing, and the command continues, because files are still written.
pub struct Out {
    to: Box<dyn Write>,
    terminal: bool,
    closed: bool,
}

impl Out {
    /// Standard output.
    pub fn standard() -> Self {
        Self {
            to: Box::new(io::stdout().lock()),
            terminal: io::stdout().is_terminal(),
            closed: false,
        }
    }

    /// Standard error.
    pub fn error() -> Self {
        Self {
            to: Box::new(io::stderr().lock()),
            terminal: io::stderr().is_terminal(),
            closed: false,
        }
    }

    /// Whether the output is a terminal.
    pub fn is_terminal(&self) -> bool {
        self.terminal
    }

    /// Prints a text, with hidden characters as escapes: parts of it are from documents, and a terminal obeys some of them.
    pub fn text(&mut self, text: &str) -> io::Result<()> {
        self.write(&visible(text))
    }

    /// Prints a line.
    pub fn line(&mut self, text: impl AsRef<str>) -> io::Result<()> {
        self.text(&format!("{}\n", text.as_ref()))
    }

    /// Prints a value as JSON.
    pub fn json(&mut self, value: &impl Serialize) -> Result<(), Failure> {
        let json = serde_json::to_string_pretty(value).map_err(|e| Failure::Input(format!("error: {e}\n")))?;
        Ok(self.write(&visible_json(&format!("{json}\n")))?)
    }

    fn write(&mut self, text: &str) -> io::Result<()> {
        if self.closed {
            return Ok(());
        }
        match self.to.write_all(text.as_bytes()).and_then(|()| self.to.flush()) {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {
                self.closed = true;
                Ok(())
            }
            other => other,
        }
    }
}
