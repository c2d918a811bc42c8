//! Scripts that mean no good: bounded time and memory, a typed failure, never a panic.

use super::*;
use proptest::prelude::*;
use std::time::Instant;

/// Limits that are met soon.
fn tight() -> Options {
    Options { max_steps: 1_000_000, max_depth: 5_000, max_bytes: 64 << 20, ..Options::default() }
}

#[track_caller]
fn check_limit(text: &str, part: &str) {
    let mut host = Memory::default();
    let start = Instant::now();
    let result = host.run_with(text, &tight()).map(|_| ());
    assert_eq!(result, Err(Failure::Limit), "{text}");
    let errors = host.texts(Severity::Error);
    assert!(errors.len() == 1 && errors[0].contains(part), "{text}: {errors:?}");
    assert!(start.elapsed().as_secs() < 20, "{text}: {:?}", start.elapsed());
}

#[test]
fn limits_stop_what_has_no_end() {
    check_limit("for (i = [0:1e9]) {}", "steps");
    check_limit("x = [for (i = [0:1e9]) i];", "steps");
    check_limit("x = [for (i = 0; true; i = i + 1) i];", "steps");
    check_limit("function f(x) = f(x + 1); y = f(0);", "steps");
    check_limit("function f(x) = 1 + f(x + 1); y = f(0);", "nested");
    check_limit("f = function(x) 1 + f(x + 1); y = f(0);", "nested");
    check_limit("function f(x) = [for (i = [0]) f(x)]; y = f(0);", "nested");
    check_limit("module m() { m(); } m();", "nested");
    check_limit("module m() { translate([1, 0, 0]) { cube(); m(); } } m();", "nested");
    check_limit("module m() { children(); m() children(); } m() cube();", "steps");
    check_limit("function f(x) = let (y = f(x)) y; z = f(0);", "nested");
    check_limit("s = [for (i = 0, s = \"ab\"; i < 60; i = i + 1, s = str(s, s)) s];", "bytes");
    check_limit("s = [for (i = 0, s = [1]; i < 60; i = i + 1, s = concat(s, s)) len(s)];", "");
    check_limit("a = rands(0, 1, 1e12);", "steps");
    check_limit("a = chr([65:1e12]);", "steps");
    check_limit("for (i = [0:1e7]) cube(i);", "bytes");
    check_limit("l = [for (i = [0:9999]) i]; x = search(l, [for (i = l) -i - 1]);", "steps");
}

#[test]
fn sharing_does_not_hide_size() {
    // A list of two of a list of two of ..., fifty deep, takes no room; to look at all of it takes for ever.
    let double = "d = [for (i = 0, s = [1]; i < 50; i = i + 1, s = [s, s]) s][49];";
    check_limit(&format!("{double} echo(d);"), "steps");
    check_limit(
        &format!("{double} x = d == [for (i = 0, s = [1]; i < 50; i = i + 1, s = [s, s]) s][49];"),
        "steps",
    );
    check_limit(&format!("{double} x = -d;"), "");
    check_limit(&format!("{double} x = d * 2;"), "");
    check_limit(&format!("{double} x = d + d;"), "");
    check_limit(&format!("{double} x = str(d);"), "steps");
}

#[test]
fn facets_are_limited() {
    check_limit("sphere($fn = 1e7);", "facets");
    check_limit("sphere($fn = 1e300);", "facets");
    check_limit("cylinder(r = 1, h = 1, $fn = 1e8);", "facets");
    check_limit("circle(1e9, $fa = 0.01, $fs = 0.01, $fe = 1e-30);", "facets");
    check_limit("linear_extrude(1, slices = 1e8) square(1);", "facets");
    check_limit("rotate_extrude($fn = 1e8) square(1);", "facets");
}

#[test]
fn deep_values_live_and_die() {
    let deep = "[for (i = 0, s = []; i <= 200000; i = i + 1, s = [s]) if (i == 200000) s][0]";
    check_echo(&format!("d = {deep}; echo(len(d));"), &["1"]);
    let chain = "[for (i = 0, f = function(x) x; i <= 100000; i = i + 1, f = let (g = f) function(x) g(x) + 1) if (i == 100000) f][0]";
    check_echo(&format!("f = {chain}; echo(is_function(f));"), &["true"]);
    check_limit(&format!("f = {chain}; echo(f(1));"), "nested");
    let mut host = Memory::default();
    let limited = host.run(&format!("echo({});", deep.replace("200000", "3000000")));
    assert_eq!(limited.map(|_| ()), Err(Failure::Limit));
}

#[test]
fn deep_texts_are_refused() {
    for (open, close) in [
        ("(", ")"),
        ("[", "]"),
        ("-", ""),
        ("!", ""),
        ("f(", ")"),
        ("let(a=", ")"),
        ("1?", ":1"),
        ("function() ", ""),
        ("[for(i=", ") i]"),
        ("a[", "]"),
        ("2^", ""),
    ] {
        let text = format!("x = {}1{};", open.repeat(100_000), close.repeat(100_000));
        let mut host = Memory::default();
        assert_eq!(host.run(&text).map(|_| ()), Err(Failure::Error), "{open}");
        assert!(host.messages[0].text.contains("nested more than"), "{open}: {}", host.messages[0].text);
    }
    for open in ["{", "union() ", "if (1) ", "module m() {", "for (i = [0:1]) ", "if (0) cube(); else "] {
        let mut host = Memory::default();
        assert_eq!(host.run(&open.repeat(100_000)).map(|_| ()), Err(Failure::Error), "{open}");
    }
}

#[test]
fn long_texts_are_read() {
    let sum = format!("echo({}0);", "1 + ".repeat(50_000));
    check_echo(&sum, &["50000"]);
    check_echo(&format!("echo(len([{}]));", "1, ".repeat(100_000)), &["100000"]);
    check_echo(
        &format!("x = {}; echo(x);", (0..5000).map(|i| format!("false ? {i} : ")).collect::<String>() + "7"),
        &["7"],
    );
    let chain = format!("a = [1]; x = a{}; echo(x);", "[0]".repeat(50_000));
    check_echo(&chain, &["undef"]);
    let too_long = format!("x = {}0;", "1 + ".repeat(200_000));
    assert_eq!(Memory::default().run(&too_long).map(|_| ()), Err(Failure::Error));
}

#[test]
fn circles_of_files_are_seen() {
    let run = |files: &[(&'static str, &'static str)], text: &str| {
        let mut host = Memory::with(files);
        let result = host.run(text).map(|_| ());
        (result, host.texts(Severity::Error).join("; "))
    };
    let (result, errors) = run(&[("a", "include <a>\n")], "include <a>\n");
    assert!(result == Err(Failure::Error) && errors.contains("a includes itself"), "{errors}");
    let (result, errors) = run(&[("a", "include <b>\n"), ("b", "include <a>\n")], "include <a>\n");
    assert!(result == Err(Failure::Error) && errors.contains("includes itself"), "{errors}");
    let (result, _) = run(
        &[("a", "use <b>\nfunction a() = 1;"), ("b", "use <a>\nfunction b() = a();")],
        "use <a>\nuse <b>\nx = b();",
    );
    assert_eq!(result, Ok(()));
    let (result, _) = run(
        &[("a", "use <b>\nx = b(); function a() = x;"), ("b", "use <a>\ny = a(); function b() = y;")],
        "use <a>\nz = a();",
    );
    assert_eq!(result, Ok(()));
}

#[test]
fn warnings_do_not_flood() {
    let mut host = Memory::default();
    host.run("for (i = [1:10000]) { x = nobody; }").expect("it runs");
    assert_eq!(host.messages.len(), 20);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_text_makes_it_panic(text in any::<String>()) {
        let _ = Memory::default().run_with(&text, &tight());
    }

    #[test]
    fn no_words_make_it_panic(words in prop::collection::vec(prop::sample::select(WORDS), 0..60)) {
        let _ = Memory::default().run_with(&words.join(" "), &Options { max_steps: 20_000, max_depth: 200, ..tight() });
    }

    #[test]
    fn no_change_makes_it_panic(at in 0..SCRIPT.len(), length in 0..12_usize, word in prop::sample::select(WORDS)) {
        let end = (at + length).min(SCRIPT.len());
        let text = format!("{}{word}{}", &SCRIPT[..at], &SCRIPT[end..]);
        let _ = Memory::default().run_with(&text, &Options { max_steps: 50_000, max_depth: 200, ..tight() });
    }
}

const WORDS: &[&str] = &[
    "module",
    "function",
    "if",
    "else",
    "for",
    "let",
    "assert",
    "echo",
    "each",
    "true",
    "undef",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ";",
    ",",
    "=",
    "==",
    "?",
    ":",
    "+",
    "-",
    "*",
    "/",
    "%",
    "^",
    "!",
    "&&",
    "<<",
    ".",
    "#",
    "x",
    "y",
    "m",
    "f",
    "$fn",
    "$children",
    "children",
    "cube",
    "translate",
    "difference",
    "1",
    "0",
    "1e308",
    "\"s\"",
    "[0:3]",
    "[1,2,3]",
    "x = 1;",
    "cube(1);",
    "include <a>",
    "use <b>",
    "polygon",
    "linear_extrude",
    "rotate",
    "search",
    "str",
    "rands",
    "concat",
];

/// One of everything.
const SCRIPT: &str = "$fn = 8; w = [1, 2, 3]; function f(x, y = 2) = x < 1 ? [y] : concat(f(x - 1), [x]);
module m(s, t = \"a\") { if (s > 1) { translate([s, 0]) children(); } else for (i = [0:s]) cube(i + 1); }
m(2) { sphere(1); k = 3; %cylinder(k); } difference() { cube(2, center = true); #rotate([0, 45]) cylinder(3, 1, 0); }
g = function(a) let (b = a ^ 2) assert(b >= 0, \"no\") b; echo(f(3), g(-2), [for (i = [0:2:6]) if (i % 4 == 0) each [i, -i]]);
linear_extrude(3, twist = 90, scale = [1, 2]) polygon([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]); hull() { cube(1); *cube(2); }
intersection_for (n = [1:2]) rotate_extrude(angle = 90 * n) translate([2, 0]) circle(1); color(\"red\", 0.5) mirror([1, 1]) cube();
echo(search(\"a\", \"banana\", 0), lookup(1.5, [[1, 2], [2, 3]]), str(w.x, w[1]), rands(0, 1, 2, 3), chr([65:70]), 0xff & ~3);";
