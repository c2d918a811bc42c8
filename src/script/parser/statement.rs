use super::{Parse, Parser, Skip};
use crate::script::ast::{
    Binding, Block, Function, Modifiers, Module, ModuleCall, ModuleId, Room, Slot, Statement, StatementId,
    StatementKind, Target,
};
use crate::script::diagnostic::Span;
use crate::script::lexer::{Keyword, TokenKind};
use crate::script::report::Complaint;

impl Parser<'_> {
    /// All statements up to the end.
    pub(super) fn file(&mut self) -> Block {
        let mut block = Block::default();
        while *self.peek() != TokenKind::End && !self.gave_up() {
            if self.at_mark("}") {
                // The brace closes nothing: say so once and go on.
                let _ = self.unexpected::<()>("a statement");
                self.bump();
            } else {
                self.statement_or_skip(&mut block);
            }
        }
        self.checked(block)
    }

    /// Statements in braces, with a scope of their own.
    fn braces(&mut self) -> Parse<Block> {
        let literals = self.literals;
        let mut block = Block::default();
        self.statements_in_braces(&mut block)?;
        block.has_literal = self.literals > literals;
        Ok(self.checked(block))
    }

    /// Statements up to and with the closing brace, as part of `block`.
    fn statements_in_braces(&mut self, block: &mut Block) -> Parse<()> {
        let open = self.here();
        self.mark("{")?;
        while !self.at_mark("}") {
            if self.gave_up() {
                return Err(Skip);
            }
            if *self.peek() == TokenKind::End {
                let complaint = Complaint::error(self.here(), "expected `}`, found the end of the file");
                self.complaints.push(complaint.also(open, "to close this"));
                return Err(Skip);
            }
            self.statement_or_skip(block);
        }
        self.bump();
        Ok(())
    }

    fn statement_or_skip(&mut self, block: &mut Block) {
        let from = self.at;
        if self.statement(block).is_err() {
            self.recover(from);
        }
    }

    /// Goes on to where a statement may start: after a `;`, after braces, or before a closing brace or a keyword
    /// that starts a definition.
    fn recover(&mut self, from: usize) {
        let mut depth = 0_usize;
        loop {
            match self.peek() {
                TokenKind::End => return,
                TokenKind::Mark(";") if depth == 0 => {
                    self.bump();
                    return;
                }
                TokenKind::Mark("{") => depth += 1,
                TokenKind::Mark("}") if depth <= 1 => {
                    if depth == 1 {
                        self.bump();
                    }
                    return;
                }
                TokenKind::Mark("}") => depth -= 1,
                TokenKind::Keyword(Keyword::Module) if self.at > from && depth == 0 => return,
                _ => {}
            }
            self.bump();
        }
    }

    fn statement(&mut self, block: &mut Block) -> Parse<()> {
        match self.peek() {
            TokenKind::Mark(";") => {
                self.bump();
                Ok(())
            }
            TokenKind::Use(path) => {
                let path = path.clone();
                self.uses.push((path, self.here()));
                self.bump();
                self.opt_mark(";");
                Ok(())
            }
            // Braces that belong to nothing are no scope and no shape: they might as well not be there.
            TokenKind::Mark("{") => self.nested(|parser| parser.statements_in_braces(block)),
            TokenKind::Keyword(Keyword::Module) => self.module(block),
            TokenKind::Keyword(Keyword::Function) => self.function(block),
            TokenKind::Name(_) if *self.peek_second() == TokenKind::Mark("=") => self.assignment(block),
            _ => {
                let statement = self.instantiation()?;
                block.statements.push(statement);
                Ok(())
            }
        }
    }

    fn module(&mut self, block: &mut Block) -> Parse<()> {
        self.bump();
        let name = self.name("the name of a module")?;
        self.mark("(")?;
        let parameters = self.parameters()?;
        let mut body = Block::default();
        self.nested(|parser| {
            if parser.at_mark("{") {
                body = parser.braces()?;
                Ok(())
            } else {
                parser.statement(&mut body)
            }
        })?;
        self.program.modules.push(Module { name, parameters, body, frame: 0 });
        let id = ModuleId(self.program.modules.len() as u32 - 1);
        block.modules.retain(|(known, _)| *known != name);
        block.modules.push((name, id));
        Ok(())
    }

    fn function(&mut self, block: &mut Block) -> Parse<()> {
        self.bump();
        let name = self.name("the name of a function")?;
        self.mark("(")?;
        let parameters = self.parameters()?;
        self.mark("=")?;
        let body = self.expression()?;
        self.mark(";")?;
        let id = self.add_function(Function { name: Some(name), parameters, body, frame: 0 });
        block.functions.retain(|(known, _)| *known != name);
        block.functions.push((name, id));
        Ok(())
    }

    fn assignment(&mut self, block: &mut Block) -> Parse<()> {
        let start = self.here();
        let name = self.name("a name")?;
        self.mark("=")?;
        let value = self.expression()?;
        self.mark(";")?;
        block.assignments.push(Binding {
            name: Some(name),
            value,
            slot: Slot::Special,
            span: self.since(start),
        });
        Ok(())
    }

    /// The last assignment to a name counts, at the place of the first one.
    fn checked(&mut self, mut block: Block) -> Block {
        let mut kept: Vec<Binding> = Vec::with_capacity(block.assignments.len());
        let mut first = std::collections::HashMap::new();
        for binding in std::mem::take(&mut block.assignments) {
            match first.get(&binding.name) {
                None => {
                    first.insert(binding.name, kept.len());
                    kept.push(binding);
                }
                Some(&index) => {
                    let earlier = std::mem::replace(&mut kept[index], binding);
                    self.warn_of_second(&earlier, &kept[index]);
                }
            }
        }
        block.assignments = kept;
        block
    }

    /// Overriding across files is how libraries are configured; within one file it is likely a slip.
    fn warn_of_second(&mut self, earlier: &Binding, later: &Binding) {
        let Some(name) = later.name.filter(|_| earlier.span.file == later.span.file) else { return };
        let text = format!("{} is assigned twice; only the last value counts", self.program.names.text(name));
        self.complaints.push(Complaint::warning(later.span, text).also(earlier.span, "first assigned here"));
    }

    /// A statement that makes geometry, with its modifiers.
    fn instantiation(&mut self) -> Parse<StatementId> {
        self.nested(|parser| {
            let start = parser.here();
            let modifiers = parser.modifiers();
            let (kind, span) = match parser.peek() {
                TokenKind::Mark("{") => (StatementKind::Block(parser.braces()?), start),
                TokenKind::Keyword(Keyword::If) => parser.if_statement()?,
                TokenKind::Keyword(Keyword::For) => parser.for_statement(false)?,
                TokenKind::Keyword(Keyword::Let) => parser.let_statement()?,
                TokenKind::Keyword(Keyword::Assert | Keyword::Echo) | TokenKind::Name(_) => {
                    parser.module_call()?
                }
                _ => return parser.unexpected("a statement"),
            };
            parser.program.statements.push(Statement { modifiers, kind, span });
            Ok(StatementId(parser.program.statements.len() as u32 - 1))
        })
    }

    fn modifiers(&mut self) -> Modifiers {
        let mut modifiers = Modifiers::default();
        loop {
            match self.peek() {
                TokenKind::Mark("*") => modifiers.disable = true,
                TokenKind::Mark("!") => modifiers.root = true,
                TokenKind::Mark("#") => modifiers.highlight = true,
                TokenKind::Mark("%") => modifiers.background = true,
                _ => return modifiers,
            }
            self.bump();
        }
    }

    fn if_statement(&mut self) -> Parse<(StatementKind, Span)> {
        let start = self.here();
        self.bump();
        self.mark("(")?;
        let condition = self.expression()?;
        self.mark(")")?;
        let span = self.since(start);
        let then = self.children()?;
        let otherwise = if self.opt_keyword(Keyword::Else) { Some(self.children()?) } else { None };
        Ok((StatementKind::If { condition, then, otherwise }, span))
    }

    fn for_statement(&mut self, intersect: bool) -> Parse<(StatementKind, Span)> {
        let (bindings, body, room, span) = self.bindings_and_children()?;
        Ok((StatementKind::For { bindings, body, room, intersect }, span))
    }

    fn let_statement(&mut self) -> Parse<(StatementKind, Span)> {
        let (bindings, body, room, span) = self.bindings_and_children()?;
        Ok((StatementKind::Let { bindings, body, room }, span))
    }

    fn bindings_and_children(&mut self) -> Parse<(Vec<Binding>, Block, Room, Span)> {
        let start = self.here();
        self.bump();
        let literals = self.literals;
        self.mark("(")?;
        let bindings = self.bindings()?;
        let span = self.since(start);
        let body = self.children()?;
        Ok((bindings, body, self.room_since(literals), span))
    }

    fn module_call(&mut self) -> Parse<(StatementKind, Span)> {
        let span = self.here();
        let name = match *self.peek() {
            TokenKind::Keyword(keyword) => self.program.names.symbol(keyword.text()),
            TokenKind::Name(name) => name,
            _ => return self.unexpected("the name of a module"),
        };
        if *self.peek_second() == TokenKind::Mark("(") {
            match self.program.names.text(name) {
                "intersection_for" => return self.for_statement(true),
                "assign" => {
                    let text = "assign() is deprecated";
                    self.complaints.push(Complaint::warning(span, text).hint("write let() for it"));
                    return self.let_statement();
                }
                _ => {}
            }
        }
        self.bump();
        self.mark("(")?;
        let arguments = self.arguments()?;
        let span = self.since(span);
        let children = self.children()?;
        Ok((StatementKind::Call(ModuleCall { name, target: Target::Unknown, arguments, children }), span))
    }

    /// What a module is applied to: nothing, one statement, or a block.
    fn children(&mut self) -> Parse<Block> {
        if self.opt_mark(";") {
            return Ok(Block::default());
        }
        if self.at_mark("{") {
            return self.nested(Parser::braces);
        }
        let literals = self.literals;
        if !self.at_child() {
            return self.unexpected("`;`");
        }
        let statement = self.instantiation()?;
        let has_literal = self.literals > literals;
        Ok(Block { statements: vec![statement], has_literal, ..Block::default() })
    }

    fn at_child(&self) -> bool {
        match self.peek() {
            TokenKind::Mark(mark) => matches!(*mark, "*" | "!" | "#" | "%"),
            TokenKind::Name(_) => *self.peek_second() == TokenKind::Mark("("),
            TokenKind::Keyword(keyword) => {
                matches!(keyword, Keyword::If | Keyword::For | Keyword::Let | Keyword::Assert | Keyword::Echo)
            }
            _ => false,
        }
    }
}
