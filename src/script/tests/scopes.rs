//! Where names hold. What is not marked otherwise was seen to be so in OpenSCAD 2021.01.

use super::*;

const LIB: (&str, &str) = (
    "lib.scad",
    "$fn = 7; w = 3; module m() { echo(\"m\", $fn, w); children(); } function lf() = w;
     echo(\"never\"); cube(9); module dup() { echo(\"lib\"); }",
);
const SECOND: (&str, &str) =
    ("second.scad", "use <lib.scad>\nmodule dup() { echo(\"second\"); } function two() = 2 * lf();");

#[test]
fn variables_are_lexical_and_hoisted() {
    check_echo("echo(x); x = 1; x = 2;", &["2"]);
    check_echo("y = 1; module m() { x = y; y = 2; echo(x, y); } m();", &["1, 2"]);
    check_echo("x = 1; module m() { echo(x); } union() { x = 2; m(); echo(x); }", &["1", "2"]);
    check_echo("x = 1; { x = 2; { x = 3; echo(x); } echo(x); } echo(x);", &["3", "3", "3"]);
    check_echo("x = 1; union() { x = 2; union() { x = 3; echo(x); } echo(x); } echo(x);", &["3", "2", "1"]);
    check_echo("{ module m() echo(\"in\"); } m();", &["\"in\""]);
    check_echo("function f(a, b = a) = [a, b]; a = 5; echo(f(1));", &["[1, 5]"]);
    check_echo("module m() { x = 1; module inner() { echo(x); } inner(); } x = 7; m();", &["1"]);
    check_echo("module m(n) { function f(k) = k == 0 ? n : f(k - 1); echo(f(3)); } m(5);", &["5"]);
    check_echo("for (i = [0:1]) { x = i * 2; y = x + 1; echo(x, y); }", &["0, 1", "2, 3"]);
    check_echo("x = 9; for (i = [0:1]) { echo(x); x = i; }", &["0", "1"]);
    check_echo("let (a = 4, b = a) echo(a, b); assign (c = 3) echo(c);", &["4, 4", "3"]);
    check_echo("x = 5; y = function(a) a + x; union() { x = 6; echo(y(1)); }", &["6"]);
}

#[test]
fn a_name_may_be_a_function_a_module_and_a_variable() {
    check_echo("f = 1; function f() = 2; module f() { echo(3); } echo(f, f()); f();", &["1, 2", "3"]);
    check_echo("module m(len) { echo(len([1, 2])); } m(5); m(function(x) \"mine\");", &["2", "\"mine\""]);
    check_echo("function f(x) = \"named\"; echo(let (f = function(x) \"value\") f(0));", &["\"value\""]);
    // In one scope the function comes first: observed in 2025.07.
    check_echo("f = function(x) \"value\"; function f(x) = \"named\"; echo(f(0));", &["\"named\""]);
    check_echo("a = function(x) 1; module m() { function a(x) = 2; echo(a(0)); } m();", &["2"]);
    check_echo(
        "function sin(x) = \"own\"; echo(sin(30)); module cube() echo(\"own\"); cube();",
        &["\"own\"", "\"own\""],
    );
}

#[test]
fn special_variables_belong_to_the_caller() {
    check_echo(
        "module q() echo($z); module p($z = 3) { children(); q(); } p() echo($z); p($z = 4) echo($z);",
        &["3", "3", "4", "4"],
    );
    check_echo(
        "module p() { $a = 1; children(); } p() echo($a); module r() { $a = 2; p() echo($a); } r();",
        &["1", "1"],
    );
    check_echo("function f() = $x; echo(f($x = 5), let ($x = 6) f());", &["5, 6"]);
    check_echo("for ($i = [1:2]) echo($i); echo(is_undef($i));", &["1", "2", "true"]);
    check_echo("translate([1, 0, 0], $fn = 9) echo($fn); echo($fn);", &["9", "0"]);
    check_echo("echo($fn, $fa, $fs, $t, $preview, $children);", &["0, 12, 2, 0, false, 0"]);
}

#[test]
fn children_are_chosen_by_number() {
    let module = "module m() { children(1); echo(\"--\"); children([0, 2]); children([0:1]); children(); }";
    let script = format!("{module} m() {{ echo(0); echo(1); echo(2); }}");
    check_echo(&script, &["1", "\"--\"", "0", "2", "0", "1", "0", "1", "2"]);
    check_echo(
        "module m() { echo($children); } m(); m() cube(); m() { cube(); sphere(); x = 1; }",
        &["0", "1", "2"],
    );
    check_echo(
        "module outer() { inner() children(); } module inner() { children(); } outer() echo(\"deep\");",
        &["\"deep\""],
    );
    check_echo("module m() for (i = [0:1]) { $i = i; children(); } x = 10; m() echo(x + $i);", &["10", "11"]);
    check_echo("module b() children(); module a() { b() echo($children); } a() { cube(); cube(); }", &["2"]);
}

#[test]
fn modules_know_their_parents() {
    check_echo(
        "module a() { echo($parent_modules, parent_module(0), parent_module(1)); } module b() a(); b();",
        &["2, \"a\", \"b\""],
    );
}

#[test]
fn arguments_find_their_parameters() {
    let module = "module n(a, b = 2, c) echo(a, b, c);";
    let check = |call: &str, expected: &str| check_echo(&format!("{module} {call}"), &[expected]);
    check("n(1, 2, 3, 4);", "1, 2, 3");
    check("n(c = 1, d = 5);", "undef, 2, 1");
    check("n(1, a = 2);", "2, 2, undef");
    check("n(5, 6, a = 1);", "1, 6, undef");
    check("n(b = 1, 7);", "7, 1, undef");
}

#[test]
fn using_brings_definitions_and_including_everything() {
    let check = |text: &str, expected: &[&str]| check_echo_with(&[LIB, SECOND], text, expected);
    check(
        "use <lib.scad>\n$fn = 50; m() echo($fn); echo(lf(), is_undef(w));",
        &["\"m\", 7, 3", "7", "3, true"],
    );
    check("use <lib.scad>\nuse <second.scad>\ndup(); echo(two());", &["\"second\"", "6"]);
    check("use <lib.scad>\nmodule dup() echo(\"own\"); dup();", &["\"own\""]);
    check("include <lib.scad>\nw = 4; m(); echo(lf());", &["\"never\"", "\"m\", 7, 4", "4"]);
    check_echo_with(&[("list.txt", "1, 2,\n3")], "x = [ include <list.txt> ]; echo(x);", &["[1, 2, 3]"]);
    check_echo_with(
        &[("a", "use <b>\nfunction a() = b();"), ("b", "use <a>\nfunction b() = 1; function c() = a();")],
        "use <b>\necho(c());",
        &["1"],
    );
}

#[test]
fn definitions_of_the_command_line_win() {
    let mut host = Memory::default();
    let options = Options { define: vec!["x=5".to_owned(), "y=[x, 1]".to_owned()], ..Options::default() };
    host.run_with("x = 1; y = 2; z = x + 1; echo(x, y, z);", &options).expect("it runs");
    assert_eq!(host.echoes(), ["5, [5, 1], 6"]);
    let options = Options { define: vec!["x=".to_owned()], ..Options::default() };
    assert_eq!(host.run_with("x = 1;", &options).map(|_| ()), Err(Failure::Error));
}

#[test]
fn complaints_name_the_place_and_what_was_meant() {
    let warns = |text: &str, part: &str, at: &str| check_complaint(Severity::Warning, text, part, at);
    warns("lenght = 1; echo(lenhgt);", "unknown variable lenhgt", "lenhgt");
    warns("cubee([1, 2, 3]);", "unknown module cubee", "cubee([1, 2, 3])");
    warns("echo(1 + squrt(2));", "unknown function squrt", "squrt(2)");
    warns("echo(1 + \"a\");", "number + string", "1 + \"a\"");
    warns("cube(size = -1);", "size of -1", "cube(size = -1)");
    warns("sphere(r = 0/0);", "radius of nan", "sphere(r = 0/0)");
    warns("cylinder(h = 1/0);", "h of inf", "cylinder(h = 1/0)");
    warns("module m(width) {} m(widht = 3);", "no parameter widht", "widht = 3");
    warns("cube(sise = 3);", "no parameter sise", "sise = 3");
    warns("include <nowhere.scad>\n", "cannot include nowhere.scad", "include <nowhere.scad>");
    warns("use <nowhere.scad>\n", "cannot use nowhere.scad", "use <nowhere.scad>");
    warns("x = 1; x = 2;", "assigned twice", "x = 2;");
    let errs = |text: &str, part: &str, at: &str| check_complaint(Severity::Error, text, part, at);
    errs("assert(1 > 2, \"no\");", "assertion `1 > 2` failed: no", "1 > 2");
    errs("x = [1, 2;", "expected `,`, found `;`", ";");
    errs("cube(1)\nsphere(2", "expected `,` or `)`, found the end", "");
    errs("text(\"a\");", "does not have text() yet", "text(\"a\")");
    errs("x = \"abc", "has no end", "\"");
}

#[test]
fn misspelt_names_are_suggested() {
    let check = |text: &str, hint: &str| {
        let mut host = Memory::default();
        host.run(text).expect("it runs");
        let hints: Vec<&String> = host.messages.iter().flat_map(|message| &message.hints).collect();
        assert!(hints.iter().any(|found| found.contains(hint)), "{text}: {hints:?}");
    };
    check("length = 1; echo(lenght);", "did you mean length?");
    check("cubee(1);", "did you mean cube?");
    check("echo(squrt(2));", "did you mean sqrt?");
    check("module gear() {} geer();", "did you mean gear?");
    check("cube(sise = 3);", "did you mean size?");
    check("module m(width, height) {} m(depth = 3);", "the parameters are width, height");
}

#[test]
fn errors_carry_the_calls_that_led_there() {
    let mut host = Memory::default();
    let script = "function f(x) = assert(false) x; function g(x) = 1 + f(x); module m() echo(g(1)); m();";
    assert_eq!(host.run(script).map(|_| ()), Err(Failure::Error));
    let trace: Vec<&str> = host.messages[0].trace.iter().map(|frame| &*frame.name).collect();
    assert_eq!(trace, ["function f", "function g", "module m"]);
    let mut host = Memory::default();
    let script = "function f(n) = n == 0 ? assert(false) 0 : 1 + f(n - 1); x = f(1000);";
    assert_eq!(host.run(script).map(|_| ()), Err(Failure::Error));
    let trace = &host.messages[0].trace;
    assert!(trace.len() < 20 && trace.iter().any(|frame| frame.name.contains("985 more calls")), "{trace:?}");
}

#[test]
fn several_mistakes_are_told_at_once() {
    let mut host = Memory::default();
    let script = "x = ;\nmodule m() { y = 1 +; cube(1); }\ncube(;\nz = 3;\nmodule n() { sphere(1) }\n";
    assert_eq!(host.run(script).map(|_| ()), Err(Failure::Error));
    assert_eq!(host.texts(Severity::Error).len(), 4, "{:#?}", host.messages);
}

/// Scripts, a line each, with what OpenSCAD 2021.01 was seen to echo for them, indented.
const OBSERVED: &str = include_str!("scripts.txt");

#[test]
fn scripts_echo_what_was_seen_in_openscad() {
    let mut lines = OBSERVED.lines().peekable();
    while let Some(script) = lines.next() {
        let mut expected = Vec::new();
        while let Some(echo) = lines.next_if(|line| line.starts_with('\t')) {
            expected.push(&echo[1..]);
        }
        check_echo(script, &expected);
    }
}
