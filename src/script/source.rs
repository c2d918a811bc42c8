//! From the main script to a whole program: loading, splicing of includes, parsing of everything used.

use super::ast::{Program, Unit, UnitId};
use super::diagnostic::{FileId, Span};
use super::lexer::{self, Token, TokenKind};
use super::parser;
use super::report::Complaint;
use super::{Host, Loaded};

/// Most tokens of a program: includes that include each other twice grow without bound.
const MOST_TOKENS: usize = 20_000_000;
/// Deepest chain of includes.
const DEEPEST_INCLUDE: usize = 200;

/// A program before names are resolved, with its texts and what was wrong with them.
pub(super) struct Source {
    pub(super) program: Program,
    pub(super) files: Vec<Loaded>,
    pub(super) complaints: Vec<Complaint>,
}

/// Reads `main`, with the assignments `define` after its last statement, and all that it includes and uses.
pub(super) fn load(main: Loaded, define: &[String], host: &mut dyn Host) -> Source {
    let source = Source { program: Program::default(), files: Vec::new(), complaints: Vec::new() };
    let mut loader = Loader { source, host, tokens: 0 };
    let unit = loader.add_unit(&main.name);
    let file = loader.add_file(main);
    let mut tokens = Vec::new();
    loader.splice(file, &mut vec![file], &mut tokens);
    loader.append_definitions(define, &mut tokens);
    loader.parse(unit, &tokens);
    loader.source
}

struct Loader<'h> {
    source: Source,
    host: &'h mut dyn Host,
    /// Number of tokens so far.
    tokens: usize,
}

impl Loader<'_> {
    fn add_unit(&mut self, name: &str) -> UnitId {
        let unit = Unit { name: name.to_owned(), body: Default::default(), uses: Vec::new(), frame: 0 };
        self.source.program.units.push(unit);
        UnitId(self.source.program.units.len() as u32 - 1)
    }

    fn add_file(&mut self, loaded: Loaded) -> FileId {
        let known = self.source.files.iter().position(|file| file.name == loaded.name);
        let index = known.unwrap_or_else(|| {
            self.source.files.push(loaded);
            self.source.files.len() - 1
        });
        FileId(index as u32)
    }

    /// Appends the tokens of `file` and, in place of each `include`, those of the file it names.
    fn splice(&mut self, file: FileId, chain: &mut Vec<FileId>, tokens: &mut Vec<Token>) {
        let text = std::mem::take(&mut self.source.files[file.0 as usize].text);
        let lexed = if text.len() < u32::MAX as usize {
            lexer::lex(&text, file, &mut self.source.program.names, &mut self.source.complaints)
        } else {
            let start = Span { file, start: 0, end: 0 };
            self.complain(Complaint::error(start, "this text is longer than 4 GiB"));
            Vec::new()
        };
        self.source.files[file.0 as usize].text = text;
        self.tokens += lexed.len();
        for token in lexed {
            match &token.kind {
                TokenKind::Include(path) => self.include(path, token.span, chain, tokens),
                TokenKind::End if chain.len() > 1 => {}
                _ => tokens.push(token),
            }
        }
    }

    fn include(&mut self, path: &str, span: Span, chain: &mut Vec<FileId>, tokens: &mut Vec<Token>) {
        let from = self.source.files[span.file.0 as usize].name.clone();
        let loaded = match self.host.script(path, &from) {
            Ok(loaded) => loaded,
            Err(reason) => {
                return self.complain(Complaint::warning(span, format!("cannot include {path}: {reason}")));
            }
        };
        let file = self.add_file(loaded);
        if chain.contains(&file) {
            let mut complaint = Complaint::error(span, format!("{path} includes itself"));
            if chain.len() > 1 {
                let names = chain.iter().map(|file| self.source.files[file.0 as usize].name.as_str());
                complaint = complaint.hint(format!("the chain is {}", names.collect::<Vec<_>>().join(" > ")));
            }
            return self.complain(complaint);
        }
        if chain.len() >= DEEPEST_INCLUDE || self.tokens > MOST_TOKENS {
            return self.complain(Complaint::error(span, "the included files are too many or too large"));
        }
        chain.push(file);
        self.splice(file, chain, tokens);
        chain.pop();
    }

    /// Puts `define`, each `name=expression`, before the end.
    fn append_definitions(&mut self, define: &[String], tokens: &mut Vec<Token>) {
        let end = tokens.pop();
        for text in define {
            let loaded = Loaded { name: format!("-D {text}"), text: format!("{text};") };
            let file = self.add_file(loaded);
            self.splice(file, &mut vec![file, file], tokens);
        }
        tokens.extend(end);
    }

    fn parse(&mut self, unit: UnitId, tokens: &[Token]) {
        let parsed = parser::parse(tokens, &mut self.source.program, &mut self.source.complaints);
        self.source.program[unit].body = parsed.body;
        for (path, span) in parsed.uses {
            if let Some(used) = self.use_unit(&path, span) {
                self.source.program[unit].uses.push(used);
            }
        }
    }

    fn use_unit(&mut self, path: &str, span: Span) -> Option<UnitId> {
        let from = self.source.files[span.file.0 as usize].name.clone();
        let loaded = match self.host.script(path, &from) {
            Ok(loaded) => loaded,
            Err(reason) => {
                self.complain(Complaint::warning(span, format!("cannot use {path}: {reason}")));
                return None;
            }
        };
        // The first unit is the main program: a file that uses it sees its definitions and not what it was run as.
        let used = &self.source.program.units[1..];
        if let Some(known) = used.iter().position(|unit| unit.name == loaded.name) {
            return Some(UnitId(known as u32 + 1));
        }
        if self.tokens > MOST_TOKENS {
            self.complain(Complaint::error(span, "the used files are too many or too large"));
            return None;
        }
        let unit = self.add_unit(&loaded.name);
        let file = self.add_file(loaded);
        let mut tokens = Vec::new();
        self.splice(file, &mut vec![file], &mut tokens);
        super::stack::with_room(|| self.parse(unit, &tokens));
        Some(unit)
    }

    fn complain(&mut self, complaint: Complaint) {
        self.source.complaints.push(complaint);
    }
}
