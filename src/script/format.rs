//! Values and functions as text, as `echo` and `str` show them.

use super::ast::{Argument, BinaryOp, Binding, Callee, Expr, ExprId, FunctionId, Parameter, Program};
use super::budget::{Budget, Fault};
use super::names::Symbol;
use super::value::Value;

/// Appends a value as it stands in a list or an `echo`: texts in quotes (and nothing in them escaped).
pub(super) fn value(
    value: &Value,
    program: &Program,
    budget: &mut Budget,
    out: &mut String,
) -> Result<(), Fault> {
    match value {
        Value::Undef => out.push_str("undef"),
        Value::Bool(value) => out.push_str(if *value { "true" } else { "false" }),
        Value::Number(value) => out.push_str(&number(*value)),
        Value::Text(text) => {
            budget.reserve(out.len() + text.as_str().len())?;
            out.extend(["\"", text.as_str(), "\""]);
        }
        Value::Range(range) => {
            let [begin, step, end] = [range.begin, range.step, range.end].map(number);
            out.push_str(&format!("[{begin} : {step} : {end}]"));
        }
        Value::Formula(_) => out.push_str("formula"),
        Value::Function(closure) => {
            let mut printer = Printer { program, budget, out };
            printer.function(closure.function)?;
        }
        Value::List(list) => {
            budget.spend(list.len() as u64)?;
            budget.reserve(out.len())?;
            out.push('[');
            for (index, element) in list.iter().enumerate() {
                if index > 0 {
                    out.push_str(", ");
                }
                budget.deeper(|budget| self::value(&element, program, budget, out))?;
            }
            out.push(']');
        }
    }
    Ok(())
}

/// A number with six significant digits: from 0.00001 up to 999999 written out, others with an exponent. Halves are
/// rounded away from zero.
pub(super) fn number(value: f64) -> String {
    if value.is_nan() {
        return "nan".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { "inf" } else { "-inf" }.to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let sign = if value < 0.0 { "-" } else { "" };
    let (digits, exponent) = six_digits(value.abs());
    let body = if (-5..=5).contains(&exponent) {
        written_out(&digits, exponent)
    } else {
        scientific(&digits, exponent)
    };
    format!("{sign}{body}")
}

/// The first six digits of a positive number, without zeros at the end, and the exponent of the first.
fn six_digits(value: f64) -> (String, i32) {
    // Thirty digits tell a half from anything else; the last of six is then rounded by hand, halves up.
    let exact = format!("{value:.29e}");
    let (mantissa, exponent) = exact.split_once('e').unwrap_or((&exact, "0"));
    let mut exponent: i32 = exponent.parse().unwrap_or(0);
    let all: Vec<u32> = mantissa.chars().filter_map(|c| c.to_digit(10)).collect();
    let mut six = all[..6].iter().fold(0, |sum, digit| 10 * sum + digit) + u32::from(all[6] >= 5);
    if six == 1_000_000 {
        six = 100_000;
        exponent += 1;
    }
    (six.to_string().trim_end_matches('0').to_owned(), exponent)
}

fn written_out(digits: &str, exponent: i32) -> String {
    if exponent < 0 {
        return format!("0.{}{digits}", "0".repeat((-exponent - 1) as usize));
    }
    let whole = exponent as usize + 1;
    if digits.len() <= whole {
        return format!("{digits}{}", "0".repeat(whole - digits.len()));
    }
    format!("{}.{}", &digits[..whole], &digits[whole..])
}

fn scientific(digits: &str, exponent: i32) -> String {
    let (first, rest) = digits.split_at(1);
    let point = if rest.is_empty() { "" } else { "." };
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{first}{point}{rest}e{sign}{}", exponent.abs())
}

/// Writes code back as text, with parentheses around every operation.
struct Printer<'a> {
    program: &'a Program,
    budget: &'a mut Budget,
    out: &'a mut String,
}

type Printed = Result<(), Fault>;

impl Printer<'_> {
    fn push(&mut self, text: &str) {
        self.out.push_str(text);
    }

    fn name(&mut self, name: Symbol) {
        self.out.push_str(self.program.names.text(name));
    }

    fn function(&mut self, id: FunctionId) -> Printed {
        let function = &self.program[id];
        self.push("function(");
        self.joined(&function.parameters, Printer::parameter)?;
        self.push(") ");
        self.expr(function.body)
    }

    fn joined<T>(&mut self, items: &[T], print: fn(&mut Self, &T) -> Printed) -> Printed {
        for (index, item) in items.iter().enumerate() {
            if index > 0 {
                self.push(", ");
            }
            print(self, item)?;
        }
        Ok(())
    }

    fn parameter(&mut self, parameter: &Parameter) -> Printed {
        self.name(parameter.name);
        let Some(default) = parameter.default else { return Ok(()) };
        self.push(" = ");
        self.expr(default)
    }

    fn argument(&mut self, argument: &Argument) -> Printed {
        self.assignment(argument.name, argument.value)
    }

    fn binding(&mut self, binding: &Binding) -> Printed {
        self.assignment(binding.name, binding.value)
    }

    fn assignment(&mut self, name: Option<Symbol>, value: ExprId) -> Printed {
        if let Some(name) = name {
            self.name(name);
            self.push(" = ");
        }
        self.expr(value)
    }

    fn expr(&mut self, id: ExprId) -> Printed {
        self.budget.enter_level()?;
        let result = super::stack::with_room(|| self.expr_kind(id));
        self.budget.leave_level();
        result
    }

    /// Prints `parts` one after the other: texts as they are, expressions as code.
    fn parts(&mut self, parts: &[Part<'_>]) -> Printed {
        for part in parts {
            match part {
                Part::Text(text) => self.push(text),
                Part::Expr(id) => self.expr(*id)?,
                Part::Operand(id) => self.wrapped(*id, self.program[*id].is_open())?,
                Part::Base(id) => {
                    let expr = &self.program[*id];
                    let loose = matches!(expr, Expr::Unary { .. } | Expr::Number(_));
                    self.wrapped(*id, loose || expr.is_open())?;
                }
                Part::Arguments(arguments) => self.joined(arguments, Printer::argument)?,
                Part::Bindings(bindings) => self.joined(bindings, Printer::binding)?,
            }
        }
        Ok(())
    }

    /// An expression, in parentheses where it would take in what follows.
    fn wrapped(&mut self, id: ExprId, wrap: bool) -> Printed {
        if wrap { self.parts(&[Part::Text("("), Part::Expr(id), Part::Text(")")]) } else { self.expr(id) }
    }

    fn expr_kind(&mut self, id: ExprId) -> Printed {
        use Part::{Arguments, Base, Bindings, Expr as E, Operand, Text as T};
        let program = self.program;
        match &program[id] {
            Expr::Undef => self.push("undef"),
            Expr::Bool(value) => self.push(if *value { "true" } else { "false" }),
            Expr::Number(value) => self.push(&number(*value)),
            Expr::Text(text) => {
                self.parts(&[T("\""), T(text.as_str()), T("\"")])?;
            }
            Expr::Variable { name, .. } => self.name(*name),
            Expr::List(elements) => {
                self.push("[");
                self.joined(elements, |printer, &element| printer.expr(element))?;
                self.push("]");
            }
            Expr::Range { begin, step: None, end } => {
                self.parts(&[T("["), E(*begin), T(" : "), E(*end), T("]")])?;
            }
            Expr::Range { begin, step: Some(step), end } => {
                self.parts(&[T("["), E(*begin), T(" : "), E(*step), T(" : "), E(*end), T("]")])?;
            }
            Expr::Unary { op, operand } => {
                self.parts(&[T(op.text()), Operand(*operand)])?;
            }
            Expr::Binary { op, left, right } => {
                let left = if *op == BinaryOp::Power { Base(*left) } else { Operand(*left) };
                self.parts(&[T("("), left, T(" "), T(op.text()), T(" "), Operand(*right), T(")")])?;
            }
            Expr::Conditional { condition, then, otherwise } => {
                self.parts(&[
                    T("("),
                    Operand(*condition),
                    T(" ? "),
                    E(*then),
                    T(" : "),
                    E(*otherwise),
                    T(")"),
                ])?;
            }
            Expr::Index { list, index } => {
                self.parts(&[Base(*list), T("["), E(*index), T("]")])?;
            }
            Expr::Member { object, name } => {
                self.parts(&[Base(*object), T("."), T(program.names.text(*name))])?;
            }
            Expr::Call(call) => {
                match &call.callee {
                    Callee::Name { name, .. } => self.name(*name),
                    Callee::Value(callee) => {
                        self.parts(&[T("("), E(*callee), T(")")])?;
                    }
                }
                self.parts(&[T("("), Arguments(&call.arguments), T(")")])?;
            }
            Expr::Let(inner) => {
                self.parts(&[T("let("), Bindings(&inner.bindings), T(") "), E(inner.body)])?;
            }
            Expr::Assert { arguments, body } | Expr::Echo { arguments, body } => {
                let word = if matches!(program[id], Expr::Assert { .. }) { "assert(" } else { "echo(" };
                self.parts(&[T(word), Arguments(arguments), T(")")])?;
                if let Some(body) = body {
                    self.parts(&[T(" "), E(*body)])?;
                }
            }
            Expr::Function(function) => self.function(*function)?,
            Expr::Each(list) => {
                self.parts(&[T("each ("), E(*list), T(")")])?;
            }
            Expr::For(inner) => {
                self.parts(&[T("for("), Bindings(&inner.bindings), T(") "), E(inner.body)])?;
            }
            Expr::While(inner) => self.parts(&[
                T("for("),
                Bindings(&inner.init),
                T(";"),
                E(inner.condition),
                T(";"),
                Bindings(&inner.update),
                T(") "),
                E(inner.body),
            ])?,
            Expr::If { condition, then, otherwise } => {
                self.parts(&[T("(if("), E(*condition), T(") ("), E(*then), T(")")])?;
                if let Some(otherwise) = otherwise {
                    self.parts(&[T(" else ("), E(*otherwise), T(")")])?;
                }
                self.push(")");
            }
        }
        Ok(())
    }
}

/// A piece of printed code.
enum Part<'a> {
    Text(&'a str),
    Expr(ExprId),
    /// An expression beside an operator.
    Operand(ExprId),
    /// An expression before `[`, `.` or `^`, which bind tighter than a sign.
    Base(ExprId),
    Arguments(&'a [Argument]),
    Bindings(&'a [Binding]),
}
