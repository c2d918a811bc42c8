//! Words and numbers of text formats, in bytes: names in a file need not be UTF-8.

use super::{Problem, ReadError};
use std::fmt;

/// The words of a text, with the number of the line they stand on.
///
/// A line ends with a line feed, a carriage return, or both.
#[derive(Clone)]
pub(super) struct Words<'a> {
    text: &'a [u8],
    at: usize,
    line: usize,
    comment: Option<u8>,
    continued: bool,
}

impl<'a> Words<'a> {
    pub(super) fn new(text: &'a [u8]) -> Words<'a> {
        let at = if text.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Words { text, at, line: 1, comment: None, continued: false }
    }

    /// From `mark` on, a line is a comment.
    pub(super) fn with_comments(self, mark: u8) -> Words<'a> {
        Words { comment: Some(mark), ..self }
    }

    /// A backslash at the end of a line joins it with the next one.
    pub(super) fn with_continuation(self) -> Words<'a> {
        Words { continued: true, ..self }
    }

    /// The line of the next byte.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// The bytes not read yet.
    pub(super) fn rest(&self) -> &'a [u8] {
        &self.text[self.at..]
    }

    /// The next word on this line.
    pub(super) fn on_line(&mut self) -> Option<&'a [u8]> {
        self.skip_blanks();
        let rest = self.rest();
        let length = rest.iter().position(|&b| b.is_ascii_whitespace() || Some(b) == self.comment);
        let (word, after) = rest.split_at(length.unwrap_or(rest.len()));
        let word = match word {
            [word @ .., b'\\'] if self.continued && matches!(after.first(), Some(b'\n' | b'\r')) => word,
            word => word,
        };
        self.at += word.len();
        (!word.is_empty()).then_some(word)
    }

    /// The next word on this line or a later one.
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        loop {
            if let Some(word) = self.on_line() {
                return Some(word);
            }
            if !self.next_line() {
                return None;
            }
        }
    }

    /// Goes to the start of the next line; `false` at the end of the text.
    pub(super) fn next_line(&mut self) -> bool {
        while let Some(length) = self.rest().iter().position(|&b| b == b'\n' || b == b'\r') {
            let joined = self.continued && self.rest()[..length].ends_with(b"\\");
            self.at += length;
            self.skip_line_end();
            if !joined {
                return true;
            }
        }
        self.at = self.text.len();
        false
    }

    /// Like [`Words::word`], for a word that must be there.
    pub(super) fn expect(&mut self, expected: &'static str) -> Result<&'a [u8], ReadError> {
        self.word().ok_or(ReadError::line(self.line, Problem::Ended { expected }))
    }

    /// A number on this line or a later one.
    pub(super) fn number(&mut self, expected: &'static str) -> Result<f64, ReadError> {
        let word = self.expect(expected)?;
        parse(word).ok_or_else(|| self.error(expected, word))
    }

    /// What is wrong with `word`, the last one read.
    pub(super) fn error(&self, expected: &'static str, word: &[u8]) -> ReadError {
        ReadError::line(self.line, Problem::expected(expected, word))
    }

    fn skip_blanks(&mut self) {
        while let [first, after @ ..] = self.rest() {
            match first {
                b'\n' | b'\r' => return,
                b'\\' if self.continued && matches!(after.first(), Some(b'\n' | b'\r')) => {
                    self.at += 1;
                    self.skip_line_end();
                }
                b if b.is_ascii_whitespace() => self.at += 1,
                _ => return,
            }
        }
    }

    fn skip_line_end(&mut self) {
        self.at += if self.rest().starts_with(b"\r\n") { 2 } else { 1 };
        self.line += 1;
    }
}

/// A number in any form that Rust reads, which includes `nan` and `inf`.
pub(super) fn parse<T: std::str::FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// A number printed with the fewest digits that read back to the same bits; very large and very small ones with an
/// exponent.
pub(super) struct Shortest(pub(super) f64);

impl fmt::Display for Shortest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Shortest(number) = *self;
        let size = number.abs();
        if number == 0.0 || (1e-5..1e16).contains(&size) {
            number.fmt(f)
        } else {
            fmt::LowerExp::fmt(&number, f)
        }
    }
}
