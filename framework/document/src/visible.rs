//! Texts of documents as they are shown: characters that a reader cannot see, or that change what a terminal or a page shows, are written
//! as escapes. `web/src/visible.ts` has the same list for the page.

use std::borrow::Cow;
use std::fmt::Write as _;

/// A text with its hidden characters as escapes such as `\u{202e}`: control characters, which a terminal obeys; marks that reverse the
/// direction of the text after them; characters without width. Line ends and tabs stay, and all letters and signs of all languages.
///
/// ```
/// use gearloss_document::visible;
///
/// assert_eq!(visible("Größe µ ≥ 2 °C"), "Größe µ ≥ 2 °C");
/// assert_eq!(visible("\u{1b}[2J\u{202e}fdp"), r"\u{1b}[2J\u{202e}fdp");
/// ```
pub fn visible(text: &str) -> Cow<'_, str> {
    escaped(text, |c, to| {
        let _ = write!(to, "{}", c.escape_unicode());
    })
}

/// JSON with the hidden characters of its texts in the escapes of JSON, so that it means the same.
pub fn visible_json(json: &str) -> Cow<'_, str> {
    escaped(json, |c, to| {
        for unit in c.encode_utf16(&mut [0; 2]) {
            let _ = write!(to, "\\u{unit:04x}");
        }
    })
}

fn escaped(text: &str, write: impl Fn(char, &mut String)) -> Cow<'_, str> {
    let hidden = |at: usize, c: char| is_hidden(c) && !(c == '\r' && text[at + 1..].starts_with('\n'));
    let Some((first, _)) = text.char_indices().find(|(at, c)| hidden(*at, *c)) else {
        return Cow::Borrowed(text);
    };
    let mut shown = String::with_capacity(text.len() + 16);
    shown.push_str(&text[..first]);
    for (at, c) in text[first..].char_indices() {
        if hidden(first + at, c) {
            write(c, &mut shown);
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

/// Whether a character is shown as an escape.
fn is_hidden(c: char) -> bool {
    match c {
        // Most texts have no others.
        '\n' | '\t' | ' '..='~' => false,
        c if c.is_control() => true,
        // Soft hyphen; marks of direction; spaces without width, joiners; separators of lines; overrides, isolates and invisible operators;
        // the mark of the byte order; annotations; tags.
        '\u{ad}'
        | '\u{61c}'
        | '\u{180e}'
        | '\u{200b}'..='\u{200f}'
        | '\u{2028}'..='\u{202e}'
        | '\u{2060}'..='\u{206f}'
        | '\u{feff}'
        | '\u{fff9}'..='\u{fffb}'
        | '\u{e0000}'..='\u{e007f}' => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_obeys_or_a_reader_cannot_see_is_an_escape() {
        for (text, shown) in [
            ("\u{1b}]0;title\u{7}", r"\u{1b}]0;title\u{7}"),
            ("\u{9b}31m", r"\u{9b}31m"),
            ("a\u{7f}\u{8}b", r"a\u{7f}\u{8}b"),
            ("fine\rerror", r"fine\u{d}error"),
            ("\u{202e}lmay", r"\u{202e}lmay"),
            ("\u{2066}a\u{2069}", r"\u{2066}a\u{2069}"),
            ("6208\u{200b}", r"6208\u{200b}"),
            ("\u{feff}6208\u{e0041}", r"\u{feff}6208\u{e0041}"),
        ] {
            assert_eq!(visible(text), shown);
        }
    }

    #[test]
    fn letters_and_signs_of_all_languages_stay() {
        for text in [
            "Getriebe für 2 m² Öl, η = 98 %, ν₄₀ 46 mm²/s, α ≥ 20°, 12 345 µm",
            "減速機 伝達効率 변속기 редуктор مسنن גלגל",
            "two\nlines\r\nand\ta tab",
            "",
        ] {
            assert!(matches!(visible(text), Cow::Borrowed(unchanged) if unchanged == text));
            assert!(matches!(visible_json(text), Cow::Borrowed(unchanged) if unchanged == text));
        }
    }

    #[test]
    fn json_means_the_same() {
        assert_eq!(
            visible_json("\"\u{9b}\u{202e}\u{e0041}\""),
            r#""\u009b\u202e\udb40\udc41""#
        );
    }
}
