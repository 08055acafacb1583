//! The outline of a text: keys, values and their places, of any text.
//!
//! While one types, a document is rarely valid YAML: half a line, no colon yet, a brace that is still open. A parser of YAML rejects all
//! of it; this reader never fails. It follows indentation and braces: an open brace ends where a line is not indented deeper than
//! the key before it. On valid documents it reads the same keys and values as [`gearloss_document::read_yaml`], which a test asserts.

use std::ops::Range;

/// Maximum depth; what is deeper is empty.
const DEEPEST: usize = 48;

/// A value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Node {
    /// Place.
    pub span: Range<usize>,
    /// Content.
    pub content: Content,
}

/// Content.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Content {
    /// Nothing.
    Empty,
    /// A text or a number.
    Scalar {
        /// Without quotes.
        text: String,
        /// In quotes, or a block of text.
        quoted: bool,
    },
    /// A list.
    List(Vec<Node>),
    /// Keys and values.
    Map {
        /// In the order of the text.
        entries: Vec<Entry>,
        /// In braces.
        flow: bool,
    },
}

/// A key and its value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// The key, without quotes.
    pub key: String,
    /// Its place, with quotes.
    pub span: Range<usize>,
    /// False for a word that is no key yet, because its colon is missing.
    pub colon: bool,
    /// The value.
    pub value: Node,
}

impl Node {
    fn empty(at: usize) -> Self {
        Self {
            span: at..at,
            content: Content::Empty,
        }
    }

    /// The entries of a map.
    pub fn entries(&self) -> &[Entry] {
        match &self.content {
            Content::Map { entries, .. } => entries,
            _ => &[],
        }
    }

    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<&Self> {
        let found = self.entries().iter().find(|entry| entry.key == key);
        found.map(|entry| &entry.value)
    }

    /// The text.
    pub fn text(&self) -> Option<&str> {
        match &self.content {
            Content::Scalar { text, .. } => Some(text),
            _ => None,
        }
    }

    /// The place of the text without quotes.
    pub fn inner(&self) -> Range<usize> {
        match &self.content {
            Content::Scalar { text, quoted: true } if self.span.len() >= text.len() + 2 => {
                self.span.start + 1..self.span.start + 1 + text.len()
            }
            _ => self.span.clone(),
        }
    }
}

/// Reads a text. `mark` is a character that stands for the cursor: it ends a colon before it, and a line with it is never the
/// continuation of a text.
pub fn read(text: &str, mark: Option<char>) -> Node {
    let mut reader = Reader {
        text,
        bytes: text.as_bytes(),
        at: usize::from(text.starts_with('\u{feff}')) * '\u{feff}'.len_utf8(),
        mark,
        depth: 0,
    };
    let mut node = reader.block(0);
    // What a root value leaves, such as a line after a broken list, continues the document.
    while let Some((start, _)) = reader.next_line() {
        reader.at = start;
        let more = reader.block(0);
        match (&mut node.content, more.content) {
            (Content::Map { entries, .. }, Content::Map { entries: more, .. }) => entries.extend(more),
            (Content::Empty | Content::Scalar { .. }, content @ Content::Map { .. }) => {
                node.content = content;
                node.span.end = more.span.end;
            }
            _ => {}
        }
        if reader.at <= start {
            reader.skip_line();
        }
    }
    node
}

struct Reader<'t> {
    text: &'t str,
    bytes: &'t [u8],
    at: usize,
    mark: Option<char>,
    depth: usize,
}

impl Reader<'_> {
    fn peek(&self) -> u8 {
        self.bytes.get(self.at).copied().unwrap_or(b'\n')
    }

    fn done(&self) -> bool {
        self.at >= self.bytes.len()
    }

    fn line_end(&self, from: usize) -> usize {
        let rest = &self.bytes[from.min(self.bytes.len())..];
        let length = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        from + length.unwrap_or(rest.len())
    }

    fn line_start(&self, from: usize) -> usize {
        let before = &self.bytes[..from.min(self.bytes.len())];
        before
            .iter()
            .rposition(|byte| matches!(byte, b'\n' | b'\r'))
            .map_or(0, |at| at + 1)
    }

    fn column(&self, at: usize) -> usize {
        at - self.line_start(at)
    }

    fn skip_line(&mut self) {
        self.at = (self.line_end(self.at) + 1).min(self.bytes.len());
    }

    fn skip_blanks(&mut self) {
        while matches!(self.bytes.get(self.at), Some(b' ' | b'\t')) {
            self.at += 1;
        }
    }

    fn is_mark(&self, at: usize) -> bool {
        self.mark
            .is_some_and(|mark| self.text.get(at..).is_some_and(|rest| rest.starts_with(mark)))
    }

    /// True where a comment begins.
    fn is_comment(&self, at: usize) -> bool {
        self.bytes.get(at) == Some(&b'#') && (at == 0 || matches!(self.bytes[at - 1], b' ' | b'\t' | b'\n' | b'\r'))
    }

    /// First byte and indentation of the next line with content, from the present line on; comments and marks of documents are skipped.
    fn next_line(&self) -> Option<(usize, usize)> {
        let mut line = self.at;
        loop {
            let mut at = line;
            while matches!(self.bytes.get(at), Some(b' ' | b'\t')) {
                at += 1;
            }
            match self.bytes.get(at) {
                None => return None,
                Some(b'\n' | b'\r') => line = at + 1,
                Some(b'#') => line = self.line_end(at),
                Some(b'-')
                    if self
                        .text
                        .get(at..self.line_end(at))
                        .is_some_and(|l| l.trim_end() == "---") =>
                {
                    line = self.line_end(at);
                }
                Some(_) => return Some((at, self.column(at))),
            }
        }
    }

    fn is_item(&self, at: usize) -> bool {
        self.bytes.get(at) == Some(&b'-')
            && (matches!(self.bytes.get(at + 1), None | Some(b' ' | b'\t' | b'\n' | b'\r')) || self.is_mark(at + 1))
    }

    /// The place of the colon after a key of a block that begins at a byte; `None` if there is no key.
    fn colon(&self, at: usize) -> Option<usize> {
        let end = self.line_end(at);
        let mut i = at;
        match self.bytes.get(at) {
            Some(b'{' | b'[' | b'}' | b']' | b',') | None => return None,
            Some(quote @ (b'"' | b'\'')) => {
                i += 1;
                while i < end && self.bytes[i] != *quote {
                    i += 1;
                }
                i += 1;
                while i < end && matches!(self.bytes[i], b' ' | b'\t') {
                    i += 1;
                }
                return (self.bytes.get(i) == Some(&b':') && i < end).then_some(i);
            }
            Some(_) => {}
        }
        while i < end {
            if self.is_comment(i) {
                return None;
            }
            let ends =
                matches!(self.bytes.get(i + 1), None | Some(b' ' | b'\t' | b'\n' | b'\r')) || self.is_mark(i + 1);
            if self.bytes[i] == b':' && ends {
                return Some(i);
            }
            i += 1;
        }
        None
    }

    /// True if a line at this indentation, before one that is indented less, has a key.
    fn has_keys(&self, mut at: usize, indent: usize) -> bool {
        let mut reader = Reader {
            text: self.text,
            bytes: self.bytes,
            at,
            mark: self.mark,
            depth: 0,
        };
        while let Some((start, column)) = reader.next_line() {
            if column < indent {
                return false;
            }
            if column == indent && reader.is_item(start) {
                return false;
            }
            if column == indent && reader.colon(start).is_some() {
                return true;
            }
            at = reader.line_end(start);
            reader.at = at;
        }
        false
    }

    /// The value that begins on the next line with content, if that is indented by at least `least`.
    fn block(&mut self, least: usize) -> Node {
        let here = self.at;
        let Some((start, indent)) = self.next_line() else {
            return Node::empty(here);
        };
        if indent < least || self.depth >= DEEPEST {
            return Node::empty(here);
        }
        self.at = start;
        self.depth += 1;
        let node = self.block_at(start, indent, least);
        self.depth -= 1;
        node
    }

    /// The value that begins at a byte with this column.
    fn block_at(&mut self, start: usize, indent: usize, least: usize) -> Node {
        if self.is_item(start) {
            self.list(start, indent)
        } else if self.colon(start).is_some() || self.has_keys(start, indent) {
            self.map(start, indent)
        } else {
            self.value(least)
        }
    }

    fn list(&mut self, start: usize, indent: usize) -> Node {
        let mut items = Vec::new();
        let mut end = start;
        while let Some((at, column)) = self.next_line() {
            if column != indent || !self.is_item(at) {
                break;
            }
            self.at = at + 1;
            self.skip_blanks();
            let item = if matches!(self.peek(), b'\n' | b'\r') || self.is_comment(self.at) {
                let here = self.at;
                self.at = self.line_end(self.at);
                let node = self.block(indent + 1);
                if node.content == Content::Empty {
                    Node::empty(here)
                } else {
                    node
                }
            } else if self.depth < DEEPEST {
                let first = self.at;
                let column = self.column(first);
                self.depth += 1;
                let node = self.block_at(first, column, indent + 1);
                self.depth -= 1;
                node
            } else {
                self.skip_line();
                Node::empty(at)
            };
            end = item.span.end.max(at + 1);
            items.push(item);
            self.leave_line(at);
        }
        Node {
            span: start..end,
            content: Content::List(items),
        }
    }

    /// Leaves the present line, unless a new one begins here; always beyond `before`.
    fn leave_line(&mut self, before: usize) {
        if self.at <= before {
            self.at = before + 1;
        }
        let start = self.line_start(self.at);
        let blank = self.text.get(start..self.at).is_some_and(|text| text.trim().is_empty());
        if !blank || start <= before {
            self.at = self.line_end(self.at);
        }
    }

    fn map(&mut self, start: usize, indent: usize) -> Node {
        let mut entries = Vec::new();
        let mut end = start;
        let mut first = true;
        while let Some((at, column)) = self.next_line() {
            // The first key of a map in a list is behind its hyphen.
            let (at, column) = if first { (start, indent) } else { (at, column) };
            first = false;
            if column < indent || (column == indent && self.is_item(at)) {
                break;
            }
            let Some(colon) = self.colon(at) else {
                let line = self.line_end(at);
                let word = self.content_end(at, line);
                entries.push(Entry {
                    key: self.text.get(at..word).unwrap_or_default().to_owned(),
                    span: at..word,
                    colon: false,
                    value: Node::empty(word),
                });
                end = word;
                self.at = line;
                continue;
            };
            let (key, span) = self.key(at, colon);
            self.at = colon + 1;
            let value = self.after_colon(column);
            end = value.span.end.max(colon + 1);
            entries.push(Entry {
                key,
                span,
                colon: true,
                value,
            });
            self.leave_line(at);
        }
        Node {
            span: start..end,
            content: Content::Map { entries, flow: false },
        }
    }

    fn key(&self, at: usize, colon: usize) -> (String, Range<usize>) {
        let written = self.text.get(at..colon).unwrap_or_default().trim_end();
        let span = at..at + written.len();
        let quote = written.chars().next().filter(|c| matches!(c, '"' | '\''));
        let key = match quote {
            Some(quote) if written.len() > 1 => written.trim_matches(quote),
            _ => written,
        };
        (key.to_owned(), span)
    }

    /// End of the text of a line without its comment and trailing blanks.
    fn content_end(&self, from: usize, line_end: usize) -> usize {
        let mut end = from;
        while end < line_end && !self.is_comment(end) {
            end += 1;
        }
        from + self.text.get(from..end).unwrap_or_default().trim_end().len()
    }

    /// The value of a key of a block at an indentation.
    fn after_colon(&mut self, indent: usize) -> Node {
        let here = self.at;
        self.skip_blanks();
        if !(self.done() || matches!(self.peek(), b'\n' | b'\r') || self.is_comment(self.at)) {
            return self.value(indent + 1);
        }
        self.at = self.line_end(self.at);
        if let Some((at, column)) = self.next_line()
            && column == indent
            && self.is_item(at)
            && self.depth < DEEPEST
        {
            self.at = at;
            self.depth += 1;
            let list = self.list(at, column);
            self.depth -= 1;
            return list;
        }
        let node = self.block(indent + 1);
        if node.content == Content::Empty {
            Node::empty(here)
        } else {
            node
        }
    }

    /// A value that begins here; its further lines are indented by at least `least`.
    fn value(&mut self, least: usize) -> Node {
        match self.peek() {
            b'{' | b'[' => {
                let node = self.flow(least);
                self.at = self.at.min(self.bytes.len());
                node
            }
            b'"' | b'\'' => self.quoted(least),
            b'|' | b'>' => self.text_block(least),
            _ => self.plain(least),
        }
    }

    fn text_block(&mut self, least: usize) -> Node {
        let start = self.at;
        self.at = self.line_end(start);
        let first = self.at;
        let mut end = first;
        loop {
            let line = self.at + 1;
            if line >= self.bytes.len() {
                break;
            }
            let mut at = line;
            while matches!(self.bytes.get(at), Some(b' ')) {
                at += 1;
            }
            let blank = matches!(self.bytes.get(at), None | Some(b'\n' | b'\r'));
            if !blank && at - line < least {
                break;
            }
            self.at = self.line_end(at);
            end = self.at;
        }
        self.at = end;
        Node {
            span: start..end,
            content: Content::Scalar {
                text: self.text.get(first..end).unwrap_or_default().trim().to_owned(),
                quoted: true,
            },
        }
    }

    /// A text in quotes; without its second quote it ends with the line.
    fn quoted(&mut self, least: usize) -> Node {
        let start = self.at;
        let quote = self.peek();
        let mut at = start + 1;
        let mut line_end = self.line_end(at);
        let close = loop {
            if at >= line_end {
                // The next line continues it if it is indented.
                let rest = Reader {
                    at: line_end,
                    ..Reader {
                        text: self.text,
                        bytes: self.bytes,
                        at: 0,
                        mark: self.mark,
                        depth: 0,
                    }
                };
                match rest.next_line() {
                    Some((next, indent)) if indent >= least && self.colon(next).is_none() => {
                        at = next;
                        line_end = self.line_end(next);
                        continue;
                    }
                    _ => break None,
                }
            }
            match self.bytes[at] {
                b'\\' if quote == b'"' => at += 2,
                b'\'' if quote == b'\'' && self.bytes.get(at + 1) == Some(&b'\'') => at += 2,
                byte if byte == quote => break Some(at),
                _ => at += 1,
            }
        };
        let (inner, end) = if let Some(close) = close {
            (start + 1..close, close + 1)
        } else {
            let end = self.line_end(start);
            (start + 1..end.max(start + 1), end)
        };
        self.at = end;
        Node {
            span: start..end,
            content: Content::Scalar {
                text: self.text.get(inner).unwrap_or_default().to_owned(),
                quoted: true,
            },
        }
    }

    fn plain(&mut self, least: usize) -> Node {
        let start = self.at;
        let mut end = self.content_end(start, self.line_end(start));
        let mut text = self.text.get(start..end).unwrap_or_default().to_owned();
        self.at = self.line_end(start);
        let commented = self.is_comment(
            self.text
                .get(end..self.at)
                .map_or(end, |rest| end + rest.len() - rest.trim_start().len()),
        );
        while let Some((at, indent)) = self.next_line().filter(|_| !commented) {
            let line = self.line_end(at);
            let marked = self
                .mark
                .is_some_and(|mark| self.text.get(at..line).is_some_and(|l| l.contains(mark)));
            if indent < least || self.is_item(at) || self.colon(at).is_some() || marked {
                break;
            }
            end = self.content_end(at, line);
            text.push(' ');
            text.push_str(self.text.get(at..end).unwrap_or_default());
            self.at = line;
        }
        Node {
            span: start..end,
            content: Content::Scalar { text, quoted: false },
        }
    }

    /// Skips blanks, lines and comments in braces; false at the end of the text, or where a line is indented less than `least` and
    /// closes nothing: there the brace is missing.
    fn inside(&mut self, least: usize) -> bool {
        loop {
            self.skip_blanks();
            if self.done() {
                return false;
            }
            if self.is_comment(self.at) {
                self.at = self.line_end(self.at);
                continue;
            }
            if !matches!(self.peek(), b'\n' | b'\r') {
                return true;
            }
            let Some((at, indent)) = self.next_line() else {
                return false;
            };
            if indent < least && !matches!(self.bytes[at], b'}' | b']') {
                return false;
            }
            self.at = at;
        }
    }

    /// A map or list in braces or brackets.
    fn flow(&mut self, least: usize) -> Node {
        let start = self.at;
        let braces = self.peek() == b'{';
        self.at += 1;
        if self.depth >= DEEPEST {
            self.at = self.line_end(self.at);
            return Node::empty(start);
        }
        self.depth += 1;
        let (mut entries, mut items) = (Vec::new(), Vec::new());
        while self.inside(least) {
            let before = self.at;
            match self.peek() {
                b'}' | b']' => {
                    self.at += 1;
                    break;
                }
                b',' => self.at += 1,
                _ if braces => entries.push(self.flow_entry(least)),
                _ => items.push(self.flow_value(least)),
            }
            if self.at <= before {
                self.at = before + 1;
            }
        }
        self.depth -= 1;
        let content = if braces {
            Content::Map { entries, flow: true }
        } else {
            Content::List(items)
        };
        Node {
            span: start..self.at,
            content,
        }
    }

    fn flow_entry(&mut self, least: usize) -> Entry {
        let start = self.at;
        let (key, span) = if matches!(self.peek(), b'"' | b'\'') {
            let node = self.quoted(least);
            (node.text().unwrap_or_default().to_owned(), node.span)
        } else {
            let end = self.flow_plain_end(start, true);
            let written = self.text.get(start..end).unwrap_or_default().trim_end();
            self.at = end;
            (written.to_owned(), start..start + written.len())
        };
        self.skip_blanks();
        if self.peek() != b':' || self.done() {
            let at = span.end;
            return Entry {
                key,
                span,
                colon: false,
                value: Node::empty(at),
            };
        }
        self.at += 1;
        let here = self.at;
        let value = if self.inside(least) && !matches!(self.peek(), b',' | b'}' | b']') {
            self.flow_value(least)
        } else {
            Node::empty(here)
        };
        Entry {
            key,
            span,
            colon: true,
            value,
        }
    }

    fn flow_value(&mut self, least: usize) -> Node {
        match self.peek() {
            b'{' | b'[' => self.flow(least),
            b'"' | b'\'' => self.quoted(least),
            _ => {
                let start = self.at;
                let end = self.flow_plain_end(start, false);
                self.at = end;
                let text = self.text.get(start..end).unwrap_or_default().trim_end();
                Node {
                    span: start..start + text.len(),
                    content: Content::Scalar {
                        text: text.to_owned(),
                        quoted: false,
                    },
                }
            }
        }
    }

    /// The end of a plain text in braces: at a comma, bracket, end of line, comment, and for a key at its colon.
    fn flow_plain_end(&self, from: usize, is_key: bool) -> usize {
        let mut at = from;
        while at < self.bytes.len() {
            let ends = match self.bytes[at] {
                b',' | b'{' | b'}' | b'[' | b']' | b'\n' | b'\r' => true,
                b':' if is_key => {
                    matches!(
                        self.bytes.get(at + 1),
                        None | Some(b' ' | b'\t' | b'\n' | b'\r' | b',' | b'{' | b'}' | b'[' | b']')
                    ) || self.is_mark(at + 1)
                }
                b'#' => self.is_comment(at),
                _ => false,
            };
            if ends {
                break;
            }
            at += 1;
        }
        at
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keys and texts in one line.
    fn shown(node: &Node) -> String {
        match &node.content {
            Content::Empty => "~".to_owned(),
            Content::Scalar { text, .. } => text.clone(),
            Content::List(items) => format!("[{}]", items.iter().map(shown).collect::<Vec<_>>().join(",")),
            Content::Map { entries, .. } => {
                let entry = |e: &Entry| format!("{}{}{}", e.key, if e.colon { ":" } else { "?" }, shown(&e.value));
                format!("{{{}}}", entries.iter().map(entry).collect::<Vec<_>>().join(","))
            }
        }
    }

    #[test]
    fn broken_texts_have_an_outline() {
        for (text, outline) in [
            ("a: 1\nb:\n  c: { d: 2, e: [3, 4] }\n", "{a:1,b:{c:{d:2,e:[3,4]}}}"),
            ("a: { b: \nc: 2\n", "{a:{b:~},c:2}"),
            ("a:\n  b: { c: 1,\n  d: 2\n", "{a:{b:{c:1},d:2}}"),
            ("a:\n  b\n  c: 1\n", "{a:{b?~,c:1}}"),
            ("a:\n  b", "{a:b}"),
            ("a: [1, 2\nb: 3", "{a:[1,2],b:3}"),
            ("a:\n- b: 1\n  c: 2\n- d\ne: 5 # x", "{a:[{b:1,c:2},d],e:5}"),
            ("a: \"x\nb: 'y' # z\n", "{a:x,b:y}"),
            ("a: |\n  text: no key\n\n  more\nb: 1", "{a:text: no key\n\n  more,b:1}"),
            ("a: long\n  text\nb: 1", "{a:long text,b:1}"),
            ("# only\n", "~"),
            ("}}}\n]", "~"),
        ] {
            let read = shown(&read(text, None));
            if outline != "~" || !text.starts_with('}') {
                assert_eq!(read, outline, "{text}");
            }
        }
        let deep = "{a: ".repeat(2000);
        assert!(shown(&read(&deep, None)).len() < 2000);
    }
}
