//! Tokens to syntax tree: recursive descent, with binding powers for operators.
//!
//! A statement that cannot be read is skipped with a complaint, so that one run tells of many mistakes.

mod expression;
mod statement;

use super::ast::{Binding, Block, Expr, ExprId, Program, Slot};
use super::diagnostic::{Severity, Span};
use super::lexer::{Keyword, Token, TokenKind};
use super::names::Symbol;
use super::report::Complaint;
use super::stack::with_room;
use std::rc::Rc;

/// Deepest nesting of brackets, braces and everything else that nests.
const DEEPEST: usize = 10_000;
/// Mistakes after which the rest is not read.
const MOST_ERRORS: usize = 20;

/// What stands in a file.
pub(super) struct Parsed {
    /// Its statements.
    pub(super) body: Block,
    /// The paths it uses.
    pub(super) uses: Vec<(Rc<str>, Span)>,
}

/// Reads `tokens`, which end with [`TokenKind::End`], into the arenas of `program`.
pub(super) fn parse(tokens: &[Token], program: &mut Program, complaints: &mut Vec<Complaint>) -> Parsed {
    let mut parser = Parser { tokens, at: 0, program, complaints, uses: Vec::new(), depth: 0, literals: 0 };
    let body = if tokens.is_empty() { Block::default() } else { parser.file() };
    Parsed { body, uses: parser.uses }
}

/// A complaint has been made; the statement is given up.
struct Skip;

type Parse<T> = Result<T, Skip>;

struct Parser<'a> {
    tokens: &'a [Token],
    at: usize,
    program: &'a mut Program,
    complaints: &'a mut Vec<Complaint>,
    uses: Vec<(Rc<str>, Span)>,
    depth: usize,
    /// Number of function values so far.
    literals: usize,
}

impl Parser<'_> {
    fn peek(&self) -> &TokenKind {
        &self.tokens[self.at].kind
    }

    fn peek_second(&self) -> &TokenKind {
        &self.tokens[(self.at + 1).min(self.tokens.len() - 1)].kind
    }

    /// The place of the next token.
    fn here(&self) -> Span {
        self.tokens[self.at].span
    }

    /// Takes the next token; the end stays.
    fn bump(&mut self) -> &TokenKind {
        let at = self.at;
        self.at = (self.at + 1).min(self.tokens.len() - 1);
        &self.tokens[at].kind
    }

    fn at_mark(&self, mark: &str) -> bool {
        matches!(self.peek(), TokenKind::Mark(found) if *found == mark)
    }

    fn at_keyword(&self, keyword: Keyword) -> bool {
        *self.peek() == TokenKind::Keyword(keyword)
    }

    /// Takes the mark if it is next.
    fn opt_mark(&mut self, mark: &str) -> bool {
        let found = self.at_mark(mark);
        if found {
            self.bump();
        }
        found
    }

    fn opt_keyword(&mut self, keyword: Keyword) -> bool {
        let found = self.at_keyword(keyword);
        if found {
            self.bump();
        }
        found
    }

    fn mark(&mut self, mark: &str) -> Parse<()> {
        if self.opt_mark(mark) { Ok(()) } else { self.unexpected(&format!("`{mark}`")) }
    }

    fn name(&mut self, what: &str) -> Parse<Symbol> {
        let TokenKind::Name(name) = *self.peek() else { return self.unexpected(what) };
        self.bump();
        Ok(name)
    }

    /// Complains that `wanted` does not stand here.
    fn unexpected<T>(&mut self, wanted: &str) -> Parse<T> {
        let found = match self.peek() {
            TokenKind::Number(_) => "a number".to_owned(),
            TokenKind::Text(_) => "a string".to_owned(),
            TokenKind::Name(name) => format!("`{}`", self.program.names.text(*name)),
            TokenKind::Keyword(keyword) => format!("`{}`", keyword.text()),
            TokenKind::Mark(mark) => format!("`{mark}`"),
            TokenKind::Include(_) => "`include`".to_owned(),
            TokenKind::Use(_) => "`use`".to_owned(),
            TokenKind::End => "the end of the file".to_owned(),
        };
        let mut complaint = Complaint::error(self.here(), format!("expected {wanted}, found {found}"));
        if wanted == "`;`" && self.at > 0 {
            complaint = complaint.also(self.tokens[self.at - 1].span, "a `;` may be missing after this");
        }
        self.complaints.push(complaint);
        Err(Skip)
    }

    fn gave_up(&self) -> bool {
        self.complaints.iter().filter(|complaint| complaint.severity == Severity::Error).count()
            >= MOST_ERRORS
    }

    /// From `start` to the last token taken.
    fn since(&self, start: Span) -> Span {
        let last = self.tokens[self.at.saturating_sub(1)].span;
        if last.file == start.file { Span { end: last.end.max(start.end), ..start } } else { start }
    }

    /// Adds an expression that began at `start`.
    fn add(&mut self, expr: Expr, start: Span) -> ExprId {
        let span = self.since(start);
        self.program.expressions.push(expr);
        self.program.spans.push(span);
        ExprId(self.program.expressions.len() as u32 - 1)
    }

    /// Runs `production` one level deeper.
    fn nested<T>(&mut self, production: impl FnOnce(&mut Self) -> Parse<T>) -> Parse<T> {
        if self.depth == DEEPEST {
            let text = format!("this is nested more than {DEEPEST} levels deep");
            self.complaints.push(Complaint::error(self.here(), text));
            self.at = self.tokens.len() - 1;
            return Err(Skip);
        }
        self.depth += 1;
        let result = with_room(|| production(self));
        self.depth -= 1;
        result
    }

    /// `name = value, ...` up to and with the closing parenthesis; a value may stand without a name.
    fn bindings(&mut self) -> Parse<Vec<Binding>> {
        let arguments = self.arguments()?;
        let binding = |argument: super::ast::Argument| Binding {
            name: argument.name,
            value: argument.value,
            slot: Slot::Special,
            span: argument.span,
        };
        Ok(arguments.into_iter().map(binding).collect())
    }
}
