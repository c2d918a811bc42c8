use super::*;
use proptest::prelude::*;

/// Expressions with what OpenSCAD 2021.01 was seen to echo for them, and whether it warned; `warns here` where we
/// warn and it does not.
const OBSERVED: &str = include_str!("expressions.tsv");

#[test]
fn expressions_have_the_values_seen_in_openscad() {
    let mut wrong = Vec::new();
    for line in OBSERVED.lines() {
        let mut fields = line.split('\t');
        let (expression, value) = (fields.next().unwrap_or_default(), fields.next().unwrap_or_default());
        let value =
            value.replace("\\t", "\t").replace("\\n", "\n").replace("\\\"", "\"").replace("\\\\", "\\");
        let warns = fields.next().is_some_and(|field| field.starts_with("warns"));
        let mut host = Memory::default();
        let result = host.run(&format!("echo(({expression}));"));
        let found = host.echoes().last().map(|text| (*text).to_owned());
        let warned = !host.texts(Severity::Warning).is_empty();
        if result.is_err() || found.as_deref() != Some(&*value) || warned != warns {
            wrong.push(format!("{expression}\n  {value} {warns}\n  {found:?} {:?}", host.messages));
        }
    }
    assert!(wrong.is_empty(), "{} differ\n{}", wrong.len(), wrong.join("\n"));
}

/// What the development snapshots of OpenSCAD have beyond 2021.01; observed in 2025.07.
#[test]
fn snapshots_have_bits_and_hexadecimal_numbers() {
    check_echo(
        "echo(0xff, 1<<4, 6&3, 6|1, ~5, 1|2==3, 1&1+1, 1<<1+1, ~1^2, 1<2|4, 255>>2, -1>>1, 1.7|0);",
        &["255, 16, 2, 7, -6, true, 0, 4, -2, true, 63, -1, 1"],
    );
    check_echo("echo([1,2,3].xy, [1,2,3,4].w, [1,2].xz);", &["[1, 2], 4, undef"]);
    check_echo("echo([for (i = [5:1]) i]);", &["[]"]);
    check_echo("echo([for (f = [for (i = [0:2]) function() i]) f()]);", &["[0, 1, 2]"]);
    check_echo("echo([for (f = [for (i = 0; i < 3; i = i + 1) function() i]) f()]);", &["[0, 1, 2]"]);
    check_echo("echo([(for (i = [1:2]) i), (let (a = 1) each [a, a])]);", &["[1, 2, 1, 1]"]);
}

#[test]
fn texts_are_written_in_many_ways() {
    check_echo("\u{feff}echo\u{a0}( 1 /* a */ , // b\n 2 )\u{feff};", &["1, 2"]);
    check_echo(
        "1st = 1; 2_nd = 2; 3e = 3; 0x = 4; echo(1st, 2_nd, 3e, 0x, 1e1, 0x1F);",
        &["1, 2, 3, 4, 10, 31"],
    );
    check_echo("echo(\"a\nb\", \"\\u00e9\\U01f600\\x41\\t\\\\\\\"\");", &["\"a\nb\", \"é😀A\t\\\"\""]);
    check_echo("echo([1, 2,], max(1, 2,),); function f(a, b,) = a + b; echo(f(1, 2,));", &["[1, 2], 2", "3"]);
    check_echo(
        "echo(-2^2, 2^-2, -2^-2, 2^3^2, !1^2, 2*-3, 1--1, - -1);",
        &["-4, 0.25, -0.25, 512, false, -6, 2, 1"],
    );
}

#[test]
fn tail_calls_take_no_stack_and_others_little() {
    check_echo("function f(n, a = 0) = n == 0 ? a : f(n - 1, a + n); echo(f(200000));", &["2.00001e+10"]);
    check_echo("function f(n) = n == 0 ? 0 : let (m = n - 1) assert(m >= 0) f(m); echo(f(50000));", &["0"]);
    check_echo(
        "function a(n) = n == 0 ? \"a\" : b(n - 1); function b(n) = n == 0 ? \"b\" : a(n - 1); echo(a(50001));",
        &["\"b\""],
    );
    check_echo("f = function(n) n == 0 ? 0 : f(n - 1); echo(f(50000));", &["0"]);
    check_echo("function f(n) = n == 0 ? 0 : 1 + f(n - 1); echo(f(15000));", &["15000"]);
    check_echo("function f(n) = n == 0 ? [] : [for (x = [0]) f(n - 1)]; echo(len(f(3000)));", &["1"]);
    check_echo("function f(n) = n == 0 ? $x : f(n - 1, $x = n); echo(f(1000));", &["1"]);
}

#[test]
fn the_same_script_has_the_same_random_numbers() {
    let script = "echo(rands(0, 1, 3), rands(-1, 1, 2, 42), rands(0, 1, 1));";
    let echo = |script: &str| {
        let mut host = Memory::default();
        host.run(script).expect("it runs");
        host.echoes().concat()
    };
    assert_eq!(echo(script), echo(script));
    check_echo("a = rands(0, 1, 5); b = rands(0, 1, 5); echo(a == b);", &["false"]);
    check_echo("a = rands(0, 1, 5, 9); b = rands(0, 1, 5, 9); echo(a == b);", &["true"]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn six_digits_are_the_nearest(value in proptest::num::f64::NORMAL) {
        let text = super::format::number(value);
        let back: f64 = text.parse().expect("a number");
        prop_assert!(((back - value) / value).abs() <= 5.000001e-6, "{value:e} {text}");
        prop_assert_eq!(super::format::number(back), text);
    }

    #[test]
    fn printed_functions_read_back(source in expression()) {
        let print = |source: &str| {
            let mut host = Memory::default();
            let result = host.run(&format!("echo(function(x) {source});"));
            (result.is_ok(), host.echoes().concat())
        };
        let (fine, once) = print(&source);
        prop_assert!(fine, "{source}");
        let (fine, twice) = print(once.strip_prefix("function(x) ").expect("a function"));
        prop_assert!(fine, "{once}");
        prop_assert_eq!(once, twice);
    }
}

/// Any expression of the language, as text.
fn expression() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        (0..1000_u32).prop_map(|n| n.to_string()),
        Just("x".to_owned()),
        Just("\"s\"".to_owned()),
        Just("undef".to_owned()),
        Just("$fn".to_owned()),
    ];
    leaf.prop_recursive(4, 40, 3, |inner| {
        let op =
            prop::sample::select(vec!["+", "-", "*", "/", "%", "^", "<", ">=", "==", "&&", "||", "&", "<<"]);
        let unary = prop::sample::select(vec!["-", "!", "~", "+"]);
        prop_oneof![
            (inner.clone(), op, inner.clone()).prop_map(|(a, op, b)| format!("{a} {op} {b}")),
            (unary, inner.clone()).prop_map(|(op, a)| format!("{op}{a}")),
            (inner.clone(), inner.clone(), inner.clone()).prop_map(|(a, b, c)| format!("({a} ? {b} : {c})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("[{a}, for (i = {b}) if (i) each i]")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("f({a}, b = {b})[{a}].x")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("(let (y = {a}) {b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("[{a} : {b}]")),
        ]
    })
}
