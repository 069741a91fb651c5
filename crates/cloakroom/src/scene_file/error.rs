//! What is wrong with a scene file, and where.

use std::fmt;
use std::ops::Range;

/// What is wrong with a scene: one message, with the place it points at.
///
/// Its `Display` is the whole message for people, several lines where it quotes the file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct SceneFileError {
    /// The scene file.
    pub file: String,
    /// The line in the file, counted from 1; `None` if the error is in no line of it.
    pub line: Option<u32>,
    /// The column in characters, counted from 1.
    pub column: Option<u32>,
    /// The override at fault; `None` if the file is.
    pub at_fault: Option<Box<OverrideAtFault>>,
    /// What is wrong.
    pub message: String,
    /// The quoted line with a mark under the place, and what is set beside it.
    pub(super) excerpt: Option<String>,
}

/// An override that cannot be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OverrideAtFault {
    /// Its key and its value, such as `camera.samples=16`.
    pub text: String,
    /// The words on the command line that set it, such as `--set camera.samples=16`.
    pub words: String,
}

impl SceneFileError {
    /// An error of the file as a whole.
    pub fn whole(file: impl Into<String>, message: impl Into<String>) -> Self {
        SceneFileError {
            file: file.into(),
            line: None,
            column: None,
            at_fault: None,
            message: message.into(),
            excerpt: None,
        }
    }

    /// The same error, of some bytes of the file's text.
    pub(super) fn in_text(self, text: &str, span: Range<usize>) -> Self {
        let (line, column, excerpt) = place(text, span);
        SceneFileError { line: Some(line), column: Some(column), excerpt: Some(excerpt), ..self }
    }
}

impl fmt::Display for SceneFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.at_fault, self.line, self.column) {
            (Some(at_fault), _, _) => write!(f, "{}: ", at_fault.words)?,
            (None, Some(line), Some(column)) => write!(f, "{}:{line}:{column}: ", self.file)?,
            (None, Some(line), None) => write!(f, "{}:{line}: ", self.file)?,
            (None, None, _) => write!(f, "{}: ", self.file)?,
        }
        f.write_str(&self.message)?;
        match &self.excerpt {
            Some(excerpt) => write!(f, "\n{excerpt}"),
            None => Ok(()),
        }
    }
}

/// Line and column (in characters) of a stretch of a text, counted from 1, and its line with a mark
/// under it.
fn place(text: &str, span: Range<usize>) -> (u32, u32, String) {
    let start = char_boundary(text, span.start);
    let end = char_boundary(text, span.end).max(start);
    let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
    let line_end = text[start..].find('\n').map_or(text.len(), |newline| start + newline);
    let content = text[line_start..line_end].trim_end_matches('\r');
    // A byte order mark is no character of the first line.
    let bom = if line_start == 0 { content.len() - without_bom(content).len() } else { 0 };
    let before = text[line_start + bom.min(start - line_start)..start].chars().count();
    let marked = &text[start..end.min(line_start + content.len()).max(start)];
    let line = text[..line_start].matches('\n').count() + 1;
    let excerpt = excerpt(line, without_bom(content), before, marked.chars().count());
    (small(line), small(before + 1), excerpt)
}

/// A line with its number, and a mark under so many of its characters, one at least, behind those
/// before.
fn excerpt(number: usize, content: &str, before: usize, marked: usize) -> String {
    /// Of a longer line only the part around the place is shown.
    const LONGEST: usize = 100;
    const BEFORE: usize = 40;
    let skipped = if content.chars().count() > LONGEST { before.saturating_sub(BEFORE) } else { 0 };
    // One character, one column: a tab or an escape code would shift the mark.
    let plain = |c: char| if c.is_control() { ' ' } else { c };
    let mut shown: String = content.chars().skip(skipped).take(LONGEST).map(plain).collect();
    let mut indent = before - skipped;
    if skipped > 0 {
        shown.insert_str(0, "...");
        indent += 3;
    }
    if content.chars().nth(skipped + LONGEST).is_some() {
        shown.push_str("...");
    }
    let length = marked.min(shown.chars().count().saturating_sub(indent)).max(1);
    let number = number.to_string();
    let gutter = " ".repeat(number.len());
    let (indent, mark) = (" ".repeat(indent), "^".repeat(length));
    format!("  {number} | {shown}\n  {gutter} | {indent}{mark}")
}

fn without_bom(text: &str) -> &str {
    text.trim_start_matches('\u{feff}')
}

/// The nearest start of a character at or before a byte.
fn char_boundary(text: &str, byte: usize) -> usize {
    let last = byte.min(text.len());
    (0..=last).rev().find(|&byte| text.is_char_boundary(byte)).unwrap_or(0)
}

fn small(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str, span: Range<usize>) -> String {
        SceneFileError::whole("scene.toml", "wrong").in_text(text, span).to_string()
    }

    #[test]
    fn the_line_is_quoted_and_the_place_marked() {
        let text = "# a\n[camera]\npositon = 1\r\n";
        let expected = "scene.toml:3:1: wrong\n  3 | positon = 1\n    | ^^^^^^^";
        assert_eq!(shown(text, 13..20), expected);
        let expected = "scene.toml:3:11: wrong\n  3 | positon = 1\n    |           ^";
        assert_eq!(shown(text, 23..24), expected);
    }

    #[test]
    fn columns_are_characters_and_tabs_do_not_shift_the_mark() {
        let text = "\u{feff}\té = ü\n";
        let at = text.find('ü').expect("there");
        let expected = "scene.toml:1:6: wrong\n  1 |  é = ü\n    |      ^";
        assert_eq!(shown(text, at..at + 2), expected);
        assert!(shown("\u{feff}a = 1", 3..4).starts_with("scene.toml:1:1: "));
    }

    #[test]
    fn a_place_at_the_end_or_over_several_lines_is_shown_in_one() {
        assert_eq!(shown("a = [", 5..5), "scene.toml:1:6: wrong\n  1 | a = [\n    |      ^");
        assert_eq!(
            shown("a = [1,\n2]", 4..10),
            "scene.toml:1:5: wrong\n  1 | a = [1,\n    |     ^^^"
        );
        assert!(shown("", 0..0).starts_with("scene.toml:1:1: "));
        assert!(shown("a\n", 2..2).starts_with("scene.toml:2:1: "));
    }

    #[test]
    fn long_lines_are_cut_around_the_place() {
        let text = format!("a = \"{}\" b {}", "x".repeat(500), "y".repeat(500));
        let at = text.find(" b ").expect("there") + 1;
        let lines: Vec<String> = shown(&text, at..at + 1).lines().map(str::to_owned).collect();
        let mark = lines[2].find('^').expect("a mark");
        assert_eq!(lines[1].as_bytes()[mark], b'b');
        assert!(lines[1].len() < 120 && lines[1].ends_with("..."));
    }

    #[test]
    fn any_place_in_any_text_can_be_shown() {
        let text = "é\r\n\r\n\tü\n\u{feff}x";
        for start in 0..=text.len() + 2 {
            for end in 0..=text.len() + 2 {
                shown(text, start..end);
            }
        }
    }
}
