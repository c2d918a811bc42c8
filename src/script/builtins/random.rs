//! Random numbers.

use super::{Builtin, function_row};
use crate::script::budget::{Outcome, undefined};
use crate::script::eval::Session;
use crate::script::value::Value;

pub(super) const TABLE: &[Builtin] = &[function_row(
    "rands",
    &["min", "max", "count", "seed"],
    "A list of random numbers, always the same ones for one seed; without a seed, for one script.",
    rands,
)];

fn rands(session: &mut Session<'_>, arguments: &[Value]) -> Outcome {
    let ([min, max, count] | [min, max, count, _]) = arguments else {
        return undefined(format!("3 or 4 arguments needed, {} given", arguments.len()));
    };
    let (Some(min), Some(max), Some(count)) = (min.finite(), max.finite(), count.finite()) else {
        return undefined("range and number must be finite numbers");
    };
    if let [_, _, _, seed] = arguments {
        let Some(seed) = seed.finite() else { return undefined("the seed must be a finite number") };
        session.random = Random::new(seed_of(seed));
    }
    let count = count.abs().trunc();
    session.budget.spend(count as u64)?;
    session.budget.reserve((8.0 * count) as usize)?;
    let (low, high) = (min.min(max), min.max(max));
    let one = |_| low + session.random.unit() * (high - low);
    Ok(Value::from_numbers((0..count as u64).map(one).collect()))
}

/// Whole numbers of 32 bits are their own seeds, as in OpenSCAD; of others the bits are folded.
fn seed_of(seed: f64) -> u32 {
    let whole = seed as u32;
    if f64::from(whole) == seed { whole } else { (seed.to_bits() ^ (seed.to_bits() >> 32)) as u32 }
}

/// The Mersenne twister MT19937 (Matsumoto and Nishimura 1998).
#[derive(Clone, Debug)]
pub(in crate::script) struct Random {
    state: Vec<u32>,
    next: usize,
}

const SIZE: usize = 624;
const MIDDLE: usize = 397;

impl Random {
    /// The sequence that starts from `seed`.
    pub(in crate::script) fn new(seed: u32) -> Random {
        let mut state = vec![seed; SIZE];
        for i in 1..SIZE {
            let before = state[i - 1];
            state[i] = 1_812_433_253_u32.wrapping_mul(before ^ (before >> 30)).wrapping_add(i as u32);
        }
        Random { state, next: SIZE }
    }

    /// A number from 0 to 1, of 64 random bits.
    fn unit(&mut self) -> f64 {
        let (low, high) = (f64::from(self.word()), f64::from(self.word()));
        let word = f64::from(u32::MAX) + 1.0;
        ((low + high * word) / (word * word)).min(1.0_f64.next_down())
    }

    fn word(&mut self) -> u32 {
        if self.next == SIZE {
            self.refill();
        }
        let mut y = self.state[self.next];
        self.next += 1;
        y ^= y >> 11;
        y ^= (y << 7) & 0x9d2c_5680;
        y ^= (y << 15) & 0xefc6_0000;
        y ^ (y >> 18)
    }

    fn refill(&mut self) {
        for i in 0..SIZE {
            let joined = (self.state[i] & 0x8000_0000) | (self.state[(i + 1) % SIZE] & 0x7fff_ffff);
            let twist = if joined & 1 == 0 { 0 } else { 0x9908_b0df };
            self.state[i] = self.state[(i + MIDDLE) % SIZE] ^ (joined >> 1) ^ twist;
        }
        self.next = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::Random;

    #[test]
    fn the_twister_turns_as_published() {
        // The C++ standard: the 10000th word from the seed 5489 is 4123659995.
        let mut random = Random::new(5489);
        let words: Vec<u32> = (0..10_000).map(|_| random.word()).collect();
        assert_eq!(words[9_999], 4_123_659_995);
    }
}
