//! From bytes to text.

use std::borrow::Cow;

use super::form::Encoding;
use super::{MeasuredFault, fault};

/// The text of a file. An encoding that was not stated is noted unless it is UTF-8.
pub(super) fn decoded<'a>(
    bytes: &'a [u8],
    encoding: Option<Encoding>,
    notes: &mut Vec<String>,
) -> Result<Cow<'a, str>, MeasuredFault> {
    let marked = |mark: &[u8]| bytes.strip_prefix(mark);
    let [low, high] = [marked(b"\xff\xfe"), marked(b"\xfe\xff")];
    let utf16 = |bytes: &[u8], is_high_first: bool| utf16(bytes, is_high_first).map(Cow::Owned);
    match encoding {
        Some(Encoding::Utf16Le) => return utf16(low.unwrap_or(bytes), false),
        Some(Encoding::Utf16Be) => return utf16(high.unwrap_or(bytes), true),
        Some(Encoding::Utf16) => return utf16(low.or(high).unwrap_or(bytes), high.is_some()),
        Some(Encoding::Utf8 | Encoding::Latin1) => {}
        None => {
            let found = low.map(|rest| (rest, false)).or(high.map(|rest| (rest, true)));
            if let Some((rest, is_high_first)) = found.or_else(|| unmarked(bytes)) {
                notes.push("read as UTF-16".to_owned());
                return utf16(rest, is_high_first);
            }
        }
    }
    let bytes = marked(b"\xef\xbb\xbf").unwrap_or(bytes);
    let latin = || bytes.iter().map(|byte| char::from(*byte)).collect::<String>();
    let text = match (encoding, std::str::from_utf8(bytes)) {
        (Some(Encoding::Latin1), _) => Cow::Owned(latin()),
        (_, Ok(text)) => Cow::Borrowed(text),
        (None, Err(_)) => {
            notes.push("read as Latin-1, because it is not UTF-8".to_owned());
            Cow::Owned(latin())
        }
        (_, Err(wrong)) => {
            return Err(MeasuredFault::new(
                "encoding",
                format!("byte {} is not UTF-8", wrong.valid_up_to() + 1),
                if low.or(high).is_some() {
                    "the byte order mark is that of UTF-16: write `encoding: utf16`"
                } else {
                    "write `encoding: latin1`, or convert the file"
                },
            ));
        }
    };
    match text.bytes().position(|byte| byte == 0) {
        Some(place) => Err(fault(
            format!("byte {} is zero, as in a file that is no text", place + 1),
            "export the table as CSV, workbook (.xlsx) or MDF file (.mf4); state `encoding: utf16_le` or `utf16_be` if it is UTF-16",
        )),
        None => Ok(text),
    }
}

/// UTF-16 without a byte order mark: letters of ASCII, of which each second byte is zero.
fn unmarked(bytes: &[u8]) -> Option<(&[u8], bool)> {
    let begin = bytes.get(..8)?;
    let is_ascii = |place: usize| begin[place..].iter().step_by(2).all(|byte| matches!(byte, 9..=126));
    let is_zero = |place: usize| begin[place..].iter().step_by(2).all(|byte| *byte == 0);
    match (is_ascii(0) && is_zero(1), is_zero(0) && is_ascii(1)) {
        (true, _) => Some((bytes, false)),
        (_, true) => Some((bytes, true)),
        _ => None,
    }
}

fn utf16(bytes: &[u8], is_high_first: bool) -> Result<String, MeasuredFault> {
    let wrong = |place: usize| {
        MeasuredFault::new(
            "encoding",
            format!("byte {} is not UTF-16", place + 1),
            "state another `encoding`, or save the file as UTF-8",
        )
    };
    if !bytes.len().is_multiple_of(2) {
        return Err(wrong(bytes.len() - 1));
    }
    let units = bytes.chunks_exact(2).map(|pair| {
        if is_high_first {
            u16::from_be_bytes([pair[0], pair[1]])
        } else {
            u16::from_le_bytes([pair[0], pair[1]])
        }
    });
    let mut text = String::with_capacity(bytes.len() / 2);
    for (place, letter) in char::decode_utf16(units).enumerate() {
        match letter {
            Ok('\0') | Err(_) => return Err(wrong(2 * place)),
            Ok(letter) => text.push(letter),
        }
    }
    Ok(text)
}
