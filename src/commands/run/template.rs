//! A template of the user, which a process of its own fills: see [`fill_template`](crate::commands::fill_template).

use std::io::Write as _;
use std::path::Path;
use std::process::Stdio;

use gearloss_report::html::LONGEST_TEMPLATE;
use serde_json::{Value, json};

use crate::commands::fill_template::COMMAND;
use crate::commands::read_file;
use crate::output::Failure;
use crate::own_process;

/// A template with its name in messages.
pub struct Template {
    name: String,
    text: String,
}

impl Template {
    pub fn read(file: &Path) -> Result<Self, Failure> {
        Ok(Self {
            name: file.display().to_string(),
            text: read_file(file, LONGEST_TEMPLATE, "give a shorter template with --template")?,
        })
    }

    /// The page with this content.
    pub fn fill(&self, content: &Value) -> Result<Vec<u8>, Failure> {
        let cannot = |error: &dyn std::fmt::Display| {
            Failure::input(
                format!("the template {}: no process can fill it: {error}", self.name),
                "omit --template",
            )
        };
        let mut command = own_process::command().ok_or_else(|| cannot(&"the program cannot be started again"))?;
        command
            .arg(COMMAND)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut process = command.spawn().map_err(|error| cannot(&error))?;
        if let Some(mut to) = process.stdin.take() {
            let input = json!({ "name": self.name, "template": self.text, "content": content });
            // A process that ended early says why.
            let _ = to.write_all(input.to_string().as_bytes());
        }
        let ended = process.wait_with_output().map_err(|error| cannot(&error))?;
        match ended.status.code() {
            Some(0) => Ok(ended.stdout),
            Some(2) => Err(Failure::Input(String::from_utf8_lossy(&ended.stderr).into_owned())),
            _ => Err(Failure::input(
                format!(
                    "the template {}: the process that fills it broke off: it is nested too deeply, or needs too much memory",
                    self.name
                ),
                "nest fewer blocks and operators in it, or omit --template",
            )),
        }
    }
}
