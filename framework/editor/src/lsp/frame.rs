//! Frames: headers, an empty line, and as many bytes of JSON as the headers say.

use std::io::{BufRead, Read, Write};

use serde_json::Value;

/// Maximum length of a message. \[byte\]
const LONGEST: u64 = 32 << 20;

/// Maximum length of a line of the headers. \[byte\]
const LONGEST_HEADER: u64 = 4096;

/// What was read.
#[derive(Debug)]
pub enum Frame {
    /// A message.
    Message(Value),
    /// The reason why a frame is no message; reading continues after it.
    Broken(String),
}

/// Reads the next frame; `None` at the end of the input, or if it cannot be read further.
pub fn read_frame(input: &mut impl BufRead) -> Option<Frame> {
    let mut length: Option<u64> = None;
    let mut any = false;
    loop {
        let mut line = Vec::new();
        let read = input.by_ref().take(LONGEST_HEADER).read_until(b'\n', &mut line).ok()?;
        if read == 0 {
            return None;
        }
        let line = String::from_utf8_lossy(&line);
        let line = line.trim();
        if line.is_empty() {
            if any {
                break;
            }
            continue;
        }
        any = true;
        if let Some((name, value)) = line.split_once(':')
            && name.trim().eq_ignore_ascii_case("content-length")
        {
            length = value.trim().parse().ok();
        }
    }
    let Some(length) = length else {
        return Some(Frame::Broken("a frame without `Content-Length`".to_owned()));
    };
    if length > LONGEST {
        std::io::copy(&mut input.by_ref().take(length), &mut std::io::sink()).ok()?;
        return Some(Frame::Broken(format!("a message of {} MB", length >> 20)));
    }
    let mut bytes = Vec::new();
    let read = input.by_ref().take(length).read_to_end(&mut bytes).ok()?;
    if (read as u64) < length {
        return None;
    }
    Some(match serde_json::from_slice(&bytes) {
        Ok(message @ Value::Object(_)) => Frame::Message(message),
        Ok(_) => Frame::Broken("a message is an object".to_owned()),
        Err(error) => Frame::Broken(format!("not JSON: {error}")),
    })
}

/// Writes a message.
pub fn write_frame(output: &mut impl Write, message: &Value) -> std::io::Result<()> {
    let text = message.to_string();
    write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    output.flush()
}
