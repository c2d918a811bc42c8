use super::{Parse, Parser};
use crate::script::ast::{
    Argument, BinaryOp, Binding, Call, Callee, Expr, ExprId, Function, FunctionId, Let, Parameter, Place,
    Room, Slot, Target, UnaryOp, While,
};
use crate::script::diagnostic::Span;
use crate::script::lexer::{Keyword, TokenKind};
use crate::script::names::Symbol;
use crate::script::report::Complaint;
use crate::script::value::Text;
use std::rc::Rc;

/// How tightly unary operators bind: looser than `^`, tighter than all others.
const UNARY_POWER: u8 = 19;

/// The operator a mark stands for between operands, with its binding powers to the left and to the right.
fn binary(mark: &str) -> Option<(BinaryOp, u8, u8)> {
    let (op, power) = match mark {
        "||" => (BinaryOp::Or, 1),
        "&&" => (BinaryOp::And, 3),
        "==" => (BinaryOp::Equal, 5),
        "!=" => (BinaryOp::NotEqual, 5),
        "<" => (BinaryOp::Less, 7),
        "<=" => (BinaryOp::LessEqual, 7),
        ">" => (BinaryOp::Greater, 7),
        ">=" => (BinaryOp::GreaterEqual, 7),
        "|" => (BinaryOp::BitOr, 9),
        "&" => (BinaryOp::BitAnd, 11),
        "<<" => (BinaryOp::ShiftLeft, 13),
        ">>" => (BinaryOp::ShiftRight, 13),
        "+" => (BinaryOp::Add, 15),
        "-" => (BinaryOp::Subtract, 15),
        "*" => (BinaryOp::Multiply, 17),
        "/" => (BinaryOp::Divide, 17),
        "%" => (BinaryOp::Modulo, 17),
        // To the right of `^` stands a unary expression, which may again hold a `^`.
        "^" => return Some((BinaryOp::Power, 22, UNARY_POWER)),
        _ => return None,
    };
    Some((op, power, power + 1))
}

fn unary(mark: &str) -> Option<UnaryOp> {
    match mark {
        "+" => Some(UnaryOp::Plus),
        "-" => Some(UnaryOp::Minus),
        "!" => Some(UnaryOp::Not),
        "~" => Some(UnaryOp::BitNot),
        _ => None,
    }
}

impl Parser<'_> {
    /// Any expression: operators, and `?:` below them all.
    pub(super) fn expression(&mut self) -> Parse<ExprId> {
        self.nested(|parser| {
            let start = parser.here();
            let condition = parser.operators(0)?;
            if !parser.opt_mark("?") {
                return Ok(condition);
            }
            let then = parser.expression()?;
            parser.mark(":")?;
            let otherwise = parser.expression()?;
            Ok(parser.add(Expr::Conditional { condition, then, otherwise }, start))
        })
    }

    /// Operators that bind at least as tightly as `least`.
    fn operators(&mut self, least: u8) -> Parse<ExprId> {
        let start = self.here();
        let mut left = self.operand()?;
        while let TokenKind::Mark(mark) = *self.peek() {
            let Some((op, _, right_power)) = binary(mark).filter(|(_, power, _)| *power >= least) else {
                break;
            };
            self.bump();
            let right = self.nested(|parser| parser.operators(right_power))?;
            left = self.add(Expr::Binary { op, left, right }, start);
        }
        Ok(left)
    }

    fn operand(&mut self) -> Parse<ExprId> {
        let start = self.here();
        let TokenKind::Mark(mark) = *self.peek() else { return self.postfix() };
        let Some(op) = unary(mark) else { return self.postfix() };
        self.bump();
        let operand = self.nested(|parser| parser.operators(UNARY_POWER))?;
        Ok(self.add(Expr::Unary { op, operand }, start))
    }

    /// Calls, indices and members after a primary expression.
    fn postfix(&mut self) -> Parse<ExprId> {
        let start = self.here();
        let mut expr = self.primary()?;
        loop {
            if self.opt_mark("(") {
                let arguments = self.arguments()?;
                expr = self.call(expr, arguments, start);
            } else if self.opt_mark("[") {
                let index = self.expression()?;
                self.mark("]")?;
                expr = self.add(Expr::Index { list: expr, index }, start);
            } else if self.opt_mark(".") {
                let name = self.name("the name of a member, such as x")?;
                expr = self.add(Expr::Member { object: expr, name }, start);
            } else {
                return Ok(expr);
            }
        }
    }

    fn call(&mut self, callee: ExprId, arguments: Vec<Argument>, start: Span) -> ExprId {
        let callee = match self.program[callee] {
            Expr::Variable { name, .. } => {
                Callee::Name { name, variable: Place::Unknown, function: Target::Unknown }
            }
            _ => Callee::Value(callee),
        };
        let has_special = arguments.iter().any(|a| a.name.is_some_and(Symbol::is_special));
        self.add(Expr::Call(Box::new(Call { callee, arguments, has_special })), start)
    }

    fn primary(&mut self) -> Parse<ExprId> {
        let start = self.here();
        let expr = match self.peek() {
            TokenKind::Number(value) => Expr::Number(*value),
            TokenKind::Text(text) => Expr::Text(Rc::new(Text::new(text.to_string()))),
            TokenKind::Name(name) => Expr::Variable { name: *name, place: Place::Unknown },
            TokenKind::Keyword(Keyword::True) => Expr::Bool(true),
            TokenKind::Keyword(Keyword::False) => Expr::Bool(false),
            TokenKind::Keyword(Keyword::Undef) => Expr::Undef,
            TokenKind::Keyword(keyword) => return self.prefixed(*keyword),
            TokenKind::Mark("(") => {
                self.bump();
                let inner = self.expression()?;
                self.mark(")")?;
                return Ok(inner);
            }
            TokenKind::Mark("[") => return self.list_or_range(),
            _ => return self.unexpected("an expression"),
        };
        self.bump();
        Ok(self.add(expr, start))
    }

    /// `let`, `assert`, `echo` and `function` before an expression.
    fn prefixed(&mut self, keyword: Keyword) -> Parse<ExprId> {
        let start = self.here();
        if !matches!(keyword, Keyword::Let | Keyword::Assert | Keyword::Echo | Keyword::Function) {
            return self.unexpected("an expression");
        }
        self.bump();
        self.mark("(")?;
        if keyword == Keyword::Function {
            return self.function_value(start);
        }
        if keyword == Keyword::Let {
            return self.let_with(Parser::expression, start);
        }
        let arguments = self.arguments()?;
        let body = if self.at_expression() { Some(self.expression()?) } else { None };
        Ok(match keyword {
            Keyword::Assert => self.add(Expr::Assert { arguments, body }, start),
            _ => self.add(Expr::Echo { arguments, body }, start),
        })
    }

    /// Whether an expression can start here; the body of `assert` and `echo` may be missing.
    fn at_expression(&self) -> bool {
        match self.peek() {
            TokenKind::Mark(mark) => matches!(*mark, "(" | "[") || unary(mark).is_some(),
            TokenKind::Keyword(keyword) => !matches!(
                keyword,
                Keyword::Else | Keyword::Each | Keyword::For | Keyword::If | Keyword::Module
            ),
            TokenKind::Number(_) | TokenKind::Text(_) | TokenKind::Name(_) => true,
            TokenKind::Include(_) | TokenKind::Use(_) | TokenKind::End => false,
        }
    }

    fn function_value(&mut self, start: Span) -> Parse<ExprId> {
        let parameters = self.parameters()?;
        let body = self.expression()?;
        self.literals += 1;
        let function = self.add_function(Function { name: None, parameters, body, frame: 0 });
        Ok(self.add(Expr::Function(function), start))
    }

    pub(super) fn add_function(&mut self, function: Function) -> FunctionId {
        self.program.functions.push(function);
        FunctionId(self.program.functions.len() as u32 - 1)
    }

    /// The bindings of a `let`, and what `body` reads after them.
    fn let_with(&mut self, body: fn(&mut Self) -> Parse<ExprId>, start: Span) -> Parse<ExprId> {
        let literals = self.literals;
        let bindings = self.bindings()?;
        let body = body(self)?;
        let room = self.room_since(literals);
        Ok(self.add(Expr::Let(Box::new(Let { bindings, body, room })), start))
    }

    /// Variables of a scope with a function value in it need a frame of their own, which that value can keep.
    pub(super) fn room_since(&self, literals: usize) -> Room {
        if self.literals > literals { Room::Own(0) } else { Room::Shared }
    }

    /// `[a, b, ...]`, `[begin : end]` or `[begin : step : end]`.
    fn list_or_range(&mut self) -> Parse<ExprId> {
        let start = self.here();
        self.mark("[")?;
        let mut elements = Vec::new();
        while !self.opt_mark("]") {
            elements.push(self.element()?);
            if elements.len() == 1 && self.opt_mark(":") {
                return self.range(elements[0], start);
            }
            if !self.at_mark("]") {
                self.mark(",")?;
            }
        }
        Ok(self.add(Expr::List(elements), start))
    }

    fn range(&mut self, begin: ExprId, start: Span) -> Parse<ExprId> {
        let second = self.expression()?;
        let third = if self.opt_mark(":") { Some(self.expression()?) } else { None };
        self.mark("]")?;
        let (step, end) = third.map_or((None, second), |end| (Some(second), end));
        Ok(self.add(Expr::Range { begin, step, end }, start))
    }

    /// An element of a list: an expression, or what makes any number of elements.
    fn element(&mut self) -> Parse<ExprId> {
        self.nested(|parser| {
            let start = parser.here();
            match parser.peek() {
                TokenKind::Keyword(Keyword::Each) => {
                    parser.bump();
                    let list = parser.element()?;
                    Ok(parser.add(Expr::Each(list), start))
                }
                TokenKind::Keyword(Keyword::For) => parser.for_element(),
                TokenKind::Keyword(Keyword::If) => parser.if_element(),
                TokenKind::Keyword(Keyword::Let) => {
                    parser.bump();
                    parser.mark("(")?;
                    parser.let_with(Parser::element, start)
                }
                TokenKind::Mark("(") if parser.at_comprehension() => {
                    parser.bump();
                    let element = parser.element()?;
                    parser.mark(")")?;
                    Ok(element)
                }
                _ => parser.expression(),
            }
        })
    }

    /// Whether the parentheses that open here hold `for`, `if` or `each`, after any number of `let`s.
    fn at_comprehension(&self) -> bool {
        let mut at = self.at;
        let kind = |at: usize| &self.tokens[at.min(self.tokens.len() - 1)].kind;
        loop {
            match kind(at) {
                TokenKind::Mark("(") => at += 1,
                TokenKind::Keyword(Keyword::For | Keyword::If | Keyword::Each) => return true,
                TokenKind::Keyword(Keyword::Let) => at = self.after_parentheses(at + 1),
                _ => return false,
            }
        }
    }

    /// The token after the parentheses that open at `at`.
    fn after_parentheses(&self, mut at: usize) -> usize {
        let mut depth = 0;
        while at < self.tokens.len() {
            match self.tokens[at].kind {
                TokenKind::Mark("(") => depth += 1,
                TokenKind::Mark(")") => depth -= 1,
                _ => {}
            }
            at += 1;
            if depth <= 0 {
                break;
            }
        }
        at
    }

    fn for_element(&mut self) -> Parse<ExprId> {
        let start = self.here();
        let literals = self.literals;
        self.bump();
        self.mark("(")?;
        let init = self.binding_list()?;
        if self.opt_mark(";") {
            let condition = self.expression()?;
            self.mark(";")?;
            let update = self.binding_list()?;
            self.mark(")")?;
            let body = self.element()?;
            let room = self.room_since(literals);
            return Ok(self.add(Expr::While(Box::new(While { init, condition, update, body, room })), start));
        }
        self.mark(")")?;
        let body = self.element()?;
        let room = self.room_since(literals);
        Ok(self.add(Expr::For(Box::new(Let { bindings: init, body, room })), start))
    }

    fn if_element(&mut self) -> Parse<ExprId> {
        let start = self.here();
        self.bump();
        self.mark("(")?;
        let condition = self.expression()?;
        self.mark(")")?;
        let then = self.element()?;
        let otherwise = if self.opt_keyword(Keyword::Else) { Some(self.element()?) } else { None };
        Ok(self.add(Expr::If { condition, then, otherwise }, start))
    }

    /// Bindings up to a `;` or a closing parenthesis, which stay.
    fn binding_list(&mut self) -> Parse<Vec<Binding>> {
        let mut bindings = Vec::new();
        while !self.at_mark(";") && !self.at_mark(")") {
            let argument = self.argument()?;
            let Argument { name, value, span } = argument;
            bindings.push(Binding { name, value, slot: Slot::Special, span });
            if !self.opt_mark(",") {
                break;
            }
        }
        Ok(bindings)
    }

    /// Arguments up to and with the closing parenthesis; a comma may follow the last.
    pub(super) fn arguments(&mut self) -> Parse<Vec<Argument>> {
        let mut arguments = Vec::new();
        while !self.opt_mark(")") {
            arguments.push(self.argument()?);
            if !self.at_mark(")") && !self.at_mark(",") {
                return self.unexpected("`,` or `)`");
            }
            while self.opt_mark(",") {}
        }
        Ok(arguments)
    }

    fn argument(&mut self) -> Parse<Argument> {
        let start = self.here();
        let name = match *self.peek() {
            TokenKind::Name(name) if *self.peek_second() == TokenKind::Mark("=") => {
                self.bump();
                self.bump();
                Some(name)
            }
            _ => None,
        };
        let value = self.expression()?;
        Ok(Argument { name, value, span: self.since(start) })
    }

    /// Parameters up to and with the closing parenthesis.
    pub(super) fn parameters(&mut self) -> Parse<Vec<Parameter>> {
        let mut parameters: Vec<Parameter> = Vec::new();
        while !self.opt_mark(")") {
            let span = self.here();
            let name = self.name("the name of a parameter")?;
            let default = if self.opt_mark("=") { Some(self.expression()?) } else { None };
            if parameters.iter().any(|known| known.name == name) {
                let text = format!("the parameter {} occurs twice", self.program.names.text(name));
                self.complaints.push(Complaint::warning(span, text));
            }
            parameters.push(Parameter { name, default, slot: Slot::Special });
            if !self.at_mark(")") {
                self.mark(",")?;
            }
            while self.opt_mark(",") {}
        }
        Ok(parameters)
    }
}
