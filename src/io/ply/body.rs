use super::Encoding;
use super::header::{Element, Kind, Number, Property};
use crate::io::text::{Words, parse};
use crate::io::{Place, Problem, ReadError};

/// The values after the header, read in order. Every type of number fits an `f64` exactly.
pub(super) struct Body<'a> {
    encoding: Encoding,
    bytes: &'a [u8],
    /// The next byte of a binary body.
    at: usize,
    /// The next word of an ASCII body.
    words: Words<'a>,
}

impl<'a> Body<'a> {
    /// `words` stand where the header of `bytes` ends.
    pub(super) fn new(encoding: Encoding, bytes: &'a [u8], words: Words<'a>) -> Body<'a> {
        Body { encoding, bytes, at: bytes.len() - words.rest().len(), words }
    }

    pub(super) fn place(&self) -> Place {
        match self.encoding {
            Encoding::Ascii => Place::Line(self.words.line()),
            Encoding::LittleEndian | Encoding::BigEndian => Place::Byte(self.at),
        }
    }

    pub(super) fn error(&self, problem: Problem) -> ReadError {
        ReadError { at: self.place(), problem }
    }

    /// How many rows of `element` the file has room for, at most as many as it claims.
    pub(super) fn room(&self, element: &Element<'_>) -> usize {
        let left = match self.encoding {
            Encoding::Ascii => self.words.rest().len(),
            Encoding::LittleEndian | Encoding::BigEndian => self.bytes.len() - self.at,
        };
        element.count.min(left as u64 / element.least_size(self.encoding).max(1)) as usize
    }

    pub(super) fn number(&mut self, number: Number) -> Result<f64, ReadError> {
        match self.encoding {
            Encoding::Ascii => self.words.number("a number"),
            Encoding::LittleEndian => self.take(number.size()).map(|bytes| little_endian(bytes, number)),
            Encoding::BigEndian => self.take(number.size()).map(|bytes| {
                let mut reversed = [0; 8];
                let reversed = &mut reversed[..bytes.len()];
                reversed.copy_from_slice(bytes);
                reversed.reverse();
                little_endian(reversed, number)
            }),
        }
    }

    /// The length of a list.
    pub(super) fn count(&mut self, number: Number) -> Result<u32, ReadError> {
        self.integer(number, "the length of a list")
    }

    /// A number that counts or names something.
    pub(super) fn integer(&mut self, number: Number, expected: &'static str) -> Result<u32, ReadError> {
        if self.encoding == Encoding::Ascii {
            let word = self.words.expect(expected)?;
            return parse(word).ok_or_else(|| self.words.error(expected, word));
        }
        let at = self.place();
        let value = self.number(number)?;
        // The cast saturates, so only a whole number in range comes back as it was.
        if f64::from(value as u32) == value {
            return Ok(value as u32);
        }
        Err(ReadError { at, problem: Problem::expected(expected, value.to_string().as_bytes()) })
    }

    /// Passes over all rows of an element.
    pub(super) fn skip(&mut self, element: &Element<'_>) -> Result<(), ReadError> {
        if element.properties.is_empty() {
            return Ok(());
        }
        if self.encoding != Encoding::Ascii && element.is_fixed() {
            return self.skip_bytes(element.count.saturating_mul(element.least_size(self.encoding)));
        }
        for _ in 0..element.count {
            element.properties.iter().try_for_each(|property| self.skip_property(property))?;
        }
        Ok(())
    }

    /// Passes over one value or list.
    pub(super) fn skip_property(&mut self, property: &Property<'_>) -> Result<(), ReadError> {
        let (count, number) = match property.kind {
            Kind::Scalar(number) => (1, number),
            Kind::List { count, item } => (u64::from(self.count(count)?), item),
        };
        if self.encoding == Encoding::Ascii {
            return (0..count).try_for_each(|_| self.words.expect("a number").map(drop));
        }
        self.skip_bytes(count.saturating_mul(number.size() as u64))
    }

    fn skip_bytes(&mut self, count: u64) -> Result<(), ReadError> {
        let left = (self.bytes.len() - self.at) as u64;
        if count > left {
            return Err(self.too_short(count));
        }
        self.at += count as usize;
        Ok(())
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], ReadError> {
        let taken = self.bytes.get(self.at..self.at + count).ok_or_else(|| self.too_short(count as u64))?;
        self.at += count;
        Ok(taken)
    }

    fn too_short(&self, count: u64) -> ReadError {
        let needed = (self.at as u64).saturating_add(count);
        self.error(Problem::TooShort { needed, size: self.bytes.len() as u64 })
    }
}

/// The number in as many bytes as its type has.
fn little_endian(bytes: &[u8], number: Number) -> f64 {
    let mut whole = [0; 8];
    whole[..bytes.len()].copy_from_slice(bytes);
    let bits = u64::from_le_bytes(whole);
    match number {
        Number::I8 => f64::from(bits as i8),
        Number::U8 | Number::U16 | Number::U32 => bits as f64,
        Number::I16 => f64::from(bits as i16),
        Number::I32 => f64::from(bits as i32),
        Number::F32 => f64::from(f32::from_bits(bits as u32)),
        Number::F64 => f64::from_bits(bits),
    }
}
