//! Hashing.

use siphasher::sip128::{Hasher128, SipHasher13};
use std::hash::Hasher;

/// A fast hasher of integers for tables that are only looked up in, never iterated: multiply and fold.
#[derive(Clone, Copy, Debug, Default)]
pub struct MixHasher(u64);

impl Hasher for MixHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.write_u64(u64::from_le_bytes(word));
        }
    }

    fn write_u32(&mut self, value: u32) {
        self.write_u64(u64::from(value));
    }

    fn write_u64(&mut self, value: u64) {
        // The odd constant is 2^64 divided by the golden ratio; the halves of the product are folded together.
        let product =
            u128::from(self.0 ^ value ^ 0x2545_f491_4f6c_dd1d) * u128::from(0x9e37_79b9_7f4a_7c15_u64);
        self.0 = product as u64 ^ (product >> 64) as u64;
    }

    fn write_usize(&mut self, value: usize) {
        self.write_u64(value as u64);
    }
}

/// A hash of 128 bits by which contents are known: equal on every platform and in every run, and so long that two
/// contents of one hash do not occur by chance.
#[derive(Clone, Debug, Default)]
pub struct ContentHasher(SipHasher13);

impl ContentHasher {
    /// Adds whole numbers.
    pub fn integers(&mut self, values: impl IntoIterator<Item = u64>) {
        values.into_iter().for_each(|value| self.0.write(&value.to_le_bytes()));
    }

    /// Adds numbers by their bits, -0 as 0.
    pub fn numbers(&mut self, values: impl IntoIterator<Item = f64>) {
        self.integers(values.into_iter().map(|value| (value + 0.0).to_bits()));
    }

    /// Adds another hash.
    pub fn content(&mut self, hash: u128) {
        self.integers([hash as u64, (hash >> 64) as u64]);
    }

    /// The hash of all that was added, in order.
    pub fn finish(&self) -> u128 {
        self.0.finish128().as_u128()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contents_have_the_same_hash_for_ever() {
        const EMPTY: u128 = 0xb91c5ed031fb33032134935d61d9b40d;
        const FEW: u128 = 0x4c9ae92296290268099b0c64a2a73d39;
        let mut hasher = ContentHasher::default();
        assert_eq!(hasher.finish(), EMPTY);
        hasher.numbers([1.5, -0.0]);
        hasher.integers([7]);
        let mut same = ContentHasher::default();
        same.numbers([1.5, 0.0]);
        same.integers([7]);
        assert_eq!(hasher.finish(), same.finish());
        assert_eq!(hasher.finish(), FEW);
    }
}
