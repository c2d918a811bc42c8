//! Interpolating splines against values recorded from scipy (`fixtures/scipy/record.py`).

use ogee::curve::{Boundary, Curve, Spline};
use serde_json::Value;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

fn spline(kind: &str, values: &[f64], knots: &[f64]) -> Spline<f64> {
    use Boundary::{First, NotAKnot, Second};
    let two = |start, end| Spline::interpolate(values, knots, start, end);
    match kind {
        "not-a-knot" => two(NotAKnot, NotAKnot),
        "natural" => two(Second(0.0), Second(0.0)),
        "clamped" => two(First(0.0), First(0.0)),
        "first" => two(First(0.75), First(-1.5)),
        "second" => two(Second(-0.5), Second(2.5)),
        "mixed" => two(First(0.75), NotAKnot),
        "periodic" => Spline::periodic(&values[..values.len() - 1], knots),
        "pchip" => Spline::monotone(values, knots),
        "akima" => Spline::akima(values, knots),
        other => panic!("{other}"),
    }
    .expect("well-formed data")
}

#[test]
fn values_and_derivatives_agree() {
    let recorded: Value = serde_json::from_str(include_str!("../fixtures/scipy/splines.json")).expect("JSON");
    let cases = recorded["cases"].as_array().expect("cases");
    assert!(cases.len() > 50);
    for case in cases {
        let (knots, values) = (numbers(&case["knots"]), numbers(&case["values"]));
        let spline = spline(case["kind"].as_str().expect("a kind"), &values, &knots);
        for ((&t, &value), (&first, &second)) in numbers(&case["at"])
            .iter()
            .zip(&numbers(&case["value"]))
            .zip(numbers(&case["first"]).iter().zip(&numbers(&case["second"])))
        {
            let near = |got: f64, want: f64, unit: f64| (got - want).abs() <= 1e-12 * unit.max(want.abs());
            let jet = spline.jet(t);
            assert!(near(jet.point, value, 1.0), "{} at {t}: {} for {value}", case["name"], jet.point);
            assert!(near(jet.first, first, 10.0), "{} at {t}: {} for {first}", case["name"], jet.first);
            // Second derivatives jump at the knots of C1 splines, where both sides are right.
            if !knots.contains(&t) {
                assert!(
                    near(jet.second, second, 1e3),
                    "{} at {t}: {} for {second}",
                    case["name"],
                    jet.second
                );
            }
        }
    }
}
