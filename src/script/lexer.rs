//! Text to tokens.

use super::diagnostic::{FileId, Span};
use super::names::{Names, Symbol};
use super::report::Complaint;
use std::rc::Rc;

/// A token and its place.
#[derive(Clone, Debug)]
pub(super) struct Token {
    pub(super) kind: TokenKind,
    pub(super) span: Span,
}

/// What a token is.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum TokenKind {
    Number(f64),
    Text(Rc<str>),
    Name(Symbol),
    Keyword(Keyword),
    /// An operator or a mark of punctuation.
    Mark(&'static str),
    /// `include <path>`, replaced by the tokens of the file.
    Include(Rc<str>),
    /// `use <path>`.
    Use(Rc<str>),
    End,
}

/// Words that cannot name anything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keyword {
    Module,
    Function,
    If,
    Else,
    For,
    Let,
    Assert,
    Echo,
    Each,
    True,
    False,
    Undef,
}

const KEYWORDS: &[(&str, Keyword)] = &[
    ("module", Keyword::Module),
    ("function", Keyword::Function),
    ("if", Keyword::If),
    ("else", Keyword::Else),
    ("for", Keyword::For),
    ("let", Keyword::Let),
    ("assert", Keyword::Assert),
    ("echo", Keyword::Echo),
    ("each", Keyword::Each),
    ("true", Keyword::True),
    ("false", Keyword::False),
    ("undef", Keyword::Undef),
];

impl Keyword {
    /// How it is written.
    pub(super) fn text(self) -> &'static str {
        KEYWORDS.iter().find(|(_, keyword)| *keyword == self).map_or("", |(text, _)| text)
    }
}

/// Marks, longer ones before their beginnings.
const MARKS: &[&str] = &[
    "<=", ">=", "==", "!=", "&&", "||", "<<", ">>", "+", "-", "*", "/", "%", "^", "<", ">", "!", "&", "|",
    "~", "=", "?", ":", ";", ",", ".", "(", ")", "[", "]", "{", "}", "#",
];

/// The tokens of `text`, the last of them [`TokenKind::End`]. What is no token is skipped with a complaint.
pub(super) fn lex(
    text: &str,
    file: FileId,
    names: &mut Names,
    complaints: &mut Vec<Complaint>,
) -> Vec<Token> {
    let mut lexer = Lexer { text, at: 0, file, names, complaints, tokens: Vec::new() };
    while lexer.at < text.len() {
        lexer.next();
    }
    lexer.push(TokenKind::End, text.len());
    lexer.tokens
}

struct Lexer<'a> {
    text: &'a str,
    at: usize,
    file: FileId,
    names: &'a mut Names,
    complaints: &'a mut Vec<Complaint>,
    tokens: Vec<Token>,
}

impl Lexer<'_> {
    fn next(&mut self) {
        let rest = self.rest();
        let Some(c) = rest.chars().next() else { return };
        if is_space(c) {
            self.at += c.len_utf8();
        } else if rest.starts_with("//") {
            self.at += rest.find('\n').unwrap_or(rest.len());
        } else if rest.starts_with("/*") {
            self.block_comment();
        } else if c == '"' {
            self.string();
        } else if is_word(c) || c == '$' || starts_fraction(rest) {
            self.word_or_number();
        } else if let Some(mark) = MARKS.iter().find(|mark| rest.starts_with(**mark)) {
            let start = self.at;
            self.at += mark.len();
            self.push(TokenKind::Mark(mark), start);
        } else {
            let start = self.at;
            self.at += c.len_utf8();
            self.complain(start, format!("the character {c:?} means nothing here"));
        }
    }

    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn push(&mut self, kind: TokenKind, start: usize) {
        let span = self.span(start);
        self.tokens.push(Token { kind, span });
    }

    fn span(&self, start: usize) -> Span {
        Span { file: self.file, start: start as u32, end: self.at.max(start) as u32 }
    }

    fn complain(&mut self, start: usize, text: String) {
        let complaint = Complaint::error(self.span(start), text);
        self.complaints.push(complaint);
    }

    fn block_comment(&mut self) {
        let start = self.at;
        match self.rest().find("*/") {
            Some(length) => self.at += length + 2,
            None => {
                self.at = start + 2;
                self.complain(start, "this comment has no end".to_owned());
                self.at = self.text.len();
            }
        }
    }

    /// A name may start with digits, so the longest of number, hexadecimal number and name is taken.
    fn word_or_number(&mut self) {
        let start = self.at;
        let rest = self.rest();
        let word = rest.len() - rest.trim_start_matches(|c| is_word(c) || c == '$').len();
        let number = number_length(rest);
        let hexadecimal = rest.starts_with("0x") || rest.starts_with("0X");
        if hexadecimal && word > 2 && rest[2..word].bytes().all(|b| b.is_ascii_hexdigit()) {
            let digits = rest[2..word].bytes();
            let value =
                digits.fold(0.0, |sum, b| sum * 16.0 + f64::from((b as char).to_digit(16).unwrap_or(0)));
            self.at += word;
            self.push(TokenKind::Number(value), start);
        } else if number > 0 && number >= word {
            let value: f64 = rest[..number].parse().unwrap_or(f64::NAN);
            self.at += number;
            if !value.is_finite() {
                self.complain(start, "this number is too large".to_owned());
            }
            self.push(TokenKind::Number(value), start);
        } else {
            self.at += word;
            self.word(start);
        }
    }

    fn word(&mut self, start: usize) {
        let word = &self.text[start..self.at];
        if (word == "include" || word == "use")
            && let Some(kind) = self.path(word == "include")
        {
            return self.push(kind, start);
        }
        let kind = match KEYWORDS.iter().find(|(text, _)| *text == word) {
            Some((_, keyword)) => TokenKind::Keyword(*keyword),
            None => TokenKind::Name(self.names.symbol(word)),
        };
        self.push(kind, start);
    }

    /// The `<path>` after `include` or `use`.
    fn path(&mut self, include: bool) -> Option<TokenKind> {
        let rest = self.rest();
        let inner = rest.trim_start_matches(is_space).strip_prefix('<')?;
        let length = inner.find(['>', '\n'])?;
        let path: Rc<str> = inner[..length].trim().into();
        if !inner[length..].starts_with('>') {
            return None;
        }
        self.at += rest.len() - inner.len() + length + 1;
        Some(if include { TokenKind::Include(path) } else { TokenKind::Use(path) })
    }

    fn string(&mut self) {
        let start = self.at;
        self.at += 1;
        let mut value = String::new();
        loop {
            let rest = self.rest();
            let Some(c) = rest.chars().next() else {
                self.at = start + 1;
                self.complain(start, "this string has no end".to_owned());
                self.at = self.text.len();
                break;
            };
            self.at += c.len_utf8();
            match c {
                '"' => break,
                '\\' => self.escape(&mut value),
                _ => value.push(c),
            }
        }
        self.push(TokenKind::Text(value.into()), start);
    }

    /// What follows a backslash.
    fn escape(&mut self, value: &mut String) {
        let start = self.at - 1;
        let Some(c) = self.rest().chars().next() else { return };
        self.at += c.len_utf8();
        match c {
            'n' => value.push('\n'),
            't' => value.push('\t'),
            'r' => value.push('\r'),
            '"' | '\\' => value.push(c),
            'x' => self.code(start, 2, 0x7f, value),
            'u' => self.code(start, 4, 0x10_ffff, value),
            'U' => self.code(start, 6, 0x10_ffff, value),
            _ => {
                let complaint = Complaint::warning(self.span(start), format!("unknown escape \\{c}"))
                    .hint("a backslash itself is written \\\\");
                self.complaints.push(complaint);
                value.push(c);
            }
        }
    }

    /// `digits` hexadecimal digits that give a character up to `most`.
    fn code(&mut self, start: usize, digits: usize, most: u32, value: &mut String) {
        let code = self.rest().get(..digits).and_then(|hex| u32::from_str_radix(hex, 16).ok());
        match code.filter(|&code| code <= most).and_then(char::from_u32) {
            Some(c) => {
                self.at += digits;
                // As in OpenSCAD, where a character of code 0 would end the string.
                value.push(if c == '\0' { ' ' } else { c });
            }
            None => {
                self.complain(start, format!("this escape needs {digits} hexadecimal digits of a character"));
            }
        }
    }
}

/// White space, in which the byte-order mark counts, wherever it stands.
fn is_space(c: char) -> bool {
    c.is_whitespace() || c == '\u{feff}' || c == '\0'
}

fn is_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

fn starts_fraction(text: &str) -> bool {
    text.starts_with('.') && text[1..].starts_with(|c: char| c.is_ascii_digit())
}

/// Bytes of the decimal number at the start of `text`; 0 where there is none.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let whole = digits(0);
    let mut length = whole;
    if bytes.get(length) == Some(&b'.') {
        let fraction = digits(length + 1);
        if whole + fraction == 0 {
            return 0;
        }
        length += 1 + fraction;
    }
    if length > 0 && matches!(bytes.get(length), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(length + 1), Some(b'+' | b'-')));
        let exponent = digits(length + 1 + sign);
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    length
}
