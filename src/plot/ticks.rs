//! Where an axis has numbers, and how they read.

use super::Scale;
use crate::math::{log10, pow};

/// A number on an axis, at a place of the axis' own scale (the logarithm on a logarithmic one).
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub(super) place: f64,
    /// Empty for a line without a number.
    pub(super) label: String,
}

/// Ticks between two places, with at most `most` numbers, and two where there is room for that.
pub(super) fn ticks(scale: Scale, low: f64, high: f64, most: usize) -> Vec<Tick> {
    match scale {
        Scale::Linear => linear(low, high, most),
        Scale::Log => logarithmic(low, high, most),
    }
}

fn linear(low: f64, high: f64, most: usize) -> Vec<Tick> {
    let exponent = log10((high - low) / most.max(1) as f64).floor() as i32 - 1;
    // The smallest step of 1, 2 or 5 times a power of ten that gives few enough.
    let steps = (exponent..).flat_map(|e| [1.0, 2.0, 5.0].map(|digit| (digit, e)));
    for (digit, exponent) in steps.take(30) {
        let step = digit * power_of_ten(exponent);
        let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
        if last - first < most as f64 {
            let values = (0..=(last - first).max(-1.0) as i64).map(|k| (first + k as f64) * step);
            let mut values: Vec<f64> = values.take(most).collect();
            // Steps below the rounding of the numbers.
            values.dedup();
            let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
            let label = |&place: &f64| Tick { place, label: label(place, exponent, largest) };
            return values.iter().map(label).collect();
        }
    }
    Vec::new()
}

/// A multiple of a step of this power of ten, among numbers of which the largest has this size.
fn label(value: f64, exponent: i32, largest: f64) -> String {
    let size = if largest > 0.0 { log10(largest).floor() as i32 } else { 0 };
    if exponent >= -5 && size < 6 {
        return minus(&format!("{:.*}", (-exponent).max(0) as usize, value + 0.0));
    }
    if value.abs() < 0.5 * power_of_ten(exponent) {
        return "0".to_owned();
    }
    format!("{}·10{}", minus(&mantissa(value, exponent, size)), superscript(size))
}

/// A number to a power of ten, less another power that is taken out of it: from its exact decimals, so that neighbours
/// differ where the numbers do.
fn mantissa(value: f64, exponent: i32, size: i32) -> String {
    let rounded = |places: i32| format!("{:.*e}", places.max(0) as usize, value.abs());
    let power = |text: &str| text.split_once('e').and_then(|(_, power)| power.parse().ok()).unwrap_or(0);
    let text = rounded(power(&rounded(17)) - exponent);
    let front = "0".repeat((size - power(&text)).max(0) as usize);
    let digits = front + &text.split('e').next().unwrap_or_default().replace('.', "");
    let (before, after) = digits.split_at(1);
    let sign = if value < 0.0 { "-" } else { "" };
    let point = if size > exponent { "." } else { "" };
    format!("{sign}{before}{point}{}", &after[..after.len().min((size - exponent).max(0) as usize)])
}

fn logarithmic(low: f64, high: f64, most: usize) -> Vec<Tick> {
    let (first, last) = ((low - 1e-9).ceil() as i32, (high + 1e-9).floor() as i32);
    let count = (last - first + 1).max(0) as usize;
    if count < 2 {
        return within_a_decade(low, high, most);
    }
    let stride = count.div_ceil(most.max(1)) as i32;
    let small = first >= -3 && last <= 3;
    let mut ticks = Vec::new();
    for decade in first - 1..=last {
        if decade >= first && decade.rem_euclid(stride) == 0 {
            let label = if small { plain_power(decade) } else { format!("10{}", superscript(decade)) };
            ticks.push(Tick { place: f64::from(decade), label });
        }
        if stride == 1 && count <= 8 {
            let between = (2..10).map(|digit| f64::from(decade) + log10(f64::from(digit)));
            ticks.extend(
                between
                    .filter(|place| (low..=high).contains(place))
                    .map(|place| Tick { place, label: String::new() }),
            );
        }
    }
    ticks
}

/// Numbers at equal differences, where no two powers of ten are in sight.
fn within_a_decade(low: f64, high: f64, most: usize) -> Vec<Tick> {
    let inner = linear(pow(10.0, low), pow(10.0, high), most);
    let kept = inner.into_iter().filter(|tick| tick.place > 0.0);
    kept.map(|tick| Tick { place: log10(tick.place), label: tick.label }).collect()
}

fn plain_power(decade: i32) -> String {
    format!("{:.*}", (-decade).max(0) as usize, power_of_ten(decade))
}

/// A power of ten, the nearest one.
fn power_of_ten(exponent: i32) -> f64 {
    // The parser rounds correctly, repeated products do not.
    format!("1e{exponent}").parse().unwrap_or(f64::INFINITY)
}

/// The true minus sign, as wide as a digit; no sign on what rounds to zero.
fn minus(text: &str) -> String {
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| matches!(c, '0' | '.')) => rest.to_owned(),
        Some(rest) => format!("\u{2212}{rest}"),
        None => text.to_owned(),
    }
}

fn superscript(number: i32) -> String {
    let raised = |c: char| match c {
        '-' => '\u{207b}',
        '1' => '\u{b9}',
        '2' => '\u{b2}',
        '3' => '\u{b3}',
        digit => char::from_u32(0x2070 + digit.to_digit(10).unwrap_or_default()).unwrap_or(digit),
    };
    number.to_string().chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale, low: f64, high: f64, most: usize) -> String {
        let ticks = ticks(scale, low, high, most);
        let numbers: Vec<&str> =
            ticks.iter().map(|tick| tick.label.as_str()).filter(|l| !l.is_empty()).collect();
        numbers.join(" ")
    }

    #[test]
    fn linear_axes() {
        for (low, high, most, expected) in [
            (0.0, 1.0, 6, "0.0 0.2 0.4 0.6 0.8 1.0"),
            (-3.0, 103.0, 6, "0 20 40 60 80 100"),
            (-0.3, 0.3, 4, "−0.2 0.0 0.2"),
            (0.0, 2.5e7, 4, "0 1·10⁷ 2·10⁷"),
            (-1e-9, 1e-9, 3, "−1·10⁻⁹ 0 1·10⁻⁹"),
            (1e8, 1e8 + 1.0, 3, "1.000000000·10⁸ 1.000000005·10⁸ 1.000000010·10⁸"),
            (1e9, 1e9 + 1e-3, 3, "1.0000000000000·10⁹ 1.0000000000005·10⁹ 1.0000000000010·10⁹"),
            (-1e9, -1e9 + 1e-3, 3, "−1.0000000000000·10⁹ −0.9999999999995·10⁹ −0.9999999999990·10⁹"),
            (999_999_999.999, 1e9, 2, "0.999999999999·10⁹ 1.000000000000·10⁹"),
            (1e300, 1.5e300, 3, "1.0·10³⁰⁰ 1.2·10³⁰⁰ 1.4·10³⁰⁰"),
            (7.1, 7.9, 1, "7.5"),
            (0.001, 0.0041, 5, "0.001 0.002 0.003 0.004"),
        ] {
            assert_eq!(labels(Scale::Linear, low, high, most), expected, "{low} to {high}");
        }
    }

    /// Down to the rounding of the numbers themselves.
    #[test]
    fn far_from_the_origin_labels_still_differ() {
        for offset in [1e3, -1e6, 1e9, 1e15, -1e-5, 3.7e200] {
            for span in [1e-3, 1e-9, 1e-12, 1e-14, 4e-16, 1e-17] {
                let (low, high) = (offset, offset + f64::abs(offset) * span);
                if low == high {
                    continue;
                }
                let found = ticks(Scale::Linear, low, high, 5);
                for pair in found.windows(2) {
                    assert!(pair[0].place < pair[1].place, "{low} to {high}: {found:?}");
                    assert_ne!(pair[0].label, pair[1].label, "{low} to {high}: {found:?}");
                }
            }
        }
    }

    #[test]
    fn logarithmic_axes() {
        for (low, high, most, expected) in [
            (-1.0, 2.0, 6, "0.1 1 10 100"),
            (-16.0, 1.0, 5, "10⁻¹⁶ 10⁻¹² 10⁻⁸ 10⁻⁴ 10⁰"),
            (0.1, 0.9, 4, "2 4 6"),
            (3.0, 6.0, 9, "10³ 10⁴ 10⁵ 10⁶"),
        ] {
            assert_eq!(labels(Scale::Log, low, high, most), expected, "{low} to {high}");
        }
    }

    #[test]
    fn never_too_many_and_always_in_sight() {
        for k in 0..2000 {
            let (low, size) = (f64::from(k % 37) * 0.37 - 5.0, pow(10.0, f64::from(k % 41) - 20.0));
            for most in [1, 2, 5, 11] {
                let (low, high) = (low * size, (low + 0.1 + f64::from(k % 13)) * size);
                let found = ticks(Scale::Linear, low, high, most);
                assert!(
                    found.len() <= most && (most < 5 || found.len() >= 2),
                    "{low} {high} {most}: {found:?}"
                );
                let slack = 1e-8 * (high - low);
                assert!(found.iter().all(|tick| tick.place >= low - slack && tick.place <= high + slack));
            }
        }
    }
}
