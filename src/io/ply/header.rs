use super::Encoding;
use super::body::Body;
use crate::io::text::{Words, parse};
use crate::io::{Problem, ReadError};

/// What a file declares before its values.
pub(super) struct Header<'a> {
    pub(super) elements: Vec<Element<'a>>,
}

/// A table of `count` rows.
pub(super) struct Element<'a> {
    pub(super) name: &'a [u8],
    pub(super) count: u64,
    pub(super) properties: Vec<Property<'a>>,
    /// Where it is declared.
    line: usize,
}

/// A column.
pub(super) struct Property<'a> {
    pub(super) name: &'a [u8],
    pub(super) kind: Kind,
}

/// What a row has in a column.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    /// One number.
    Scalar(Number),
    /// A count, then as many items.
    List { count: Number, item: Number },
}

/// The types of numbers.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl<'a> Header<'a> {
    /// Reads the header, and says where and how its values follow.
    pub(super) fn read(bytes: &'a [u8]) -> Result<(Header<'a>, Body<'a>), ReadError> {
        let mut words = Words::new(bytes);
        keyword(&mut words, "ply")?;
        keyword(&mut words, "format")?;
        let encoding = encoding(&mut words)?;
        let mut header = Header { elements: Vec::new() };
        while words.next_line() {
            match words.on_line() {
                Some(b"element") => header.elements.push(element(&mut words)?),
                Some(b"property") => {
                    let property = property(&mut words)?;
                    let Some(element) = header.elements.last_mut() else {
                        return Err(words.error("an element before its properties", b"property"));
                    };
                    element.properties.push(property);
                }
                Some(b"comment" | b"obj_info") | None => {}
                Some(b"end_header") => {
                    words.next_line();
                    return Ok((header, Body::new(encoding, bytes, words)));
                }
                Some(word) => return Err(words.error("element, property or end_header", word)),
            }
        }
        Err(ReadError::line(words.line(), Problem::Ended { expected: "end_header" }))
    }
}

impl Element<'_> {
    /// An error about the declaration.
    pub(super) fn error(&self, problem: Problem) -> ReadError {
        ReadError::line(self.line, problem)
    }

    /// Fewest bytes that a row takes.
    pub(super) fn least_size(&self, encoding: Encoding) -> u64 {
        let size = |kind| match (encoding, kind) {
            // A character and a space.
            (Encoding::Ascii, _) => 2,
            (_, Kind::Scalar(number) | Kind::List { count: number, .. }) => number.size() as u64,
        };
        self.properties.iter().map(|property| size(property.kind)).sum()
    }

    /// Whether all rows have the same size in bytes.
    pub(super) fn is_fixed(&self) -> bool {
        self.properties.iter().all(|property| matches!(property.kind, Kind::Scalar(_)))
    }
}

impl Number {
    fn named(name: &[u8]) -> Option<Number> {
        Some(match name {
            b"char" | b"int8" => Number::I8,
            b"uchar" | b"uint8" => Number::U8,
            b"short" | b"int16" => Number::I16,
            b"ushort" | b"uint16" => Number::U16,
            b"int" | b"int32" => Number::I32,
            b"uint" | b"uint32" => Number::U32,
            b"float" | b"float32" => Number::F32,
            b"double" | b"float64" => Number::F64,
            _ => return None,
        })
    }

    /// In bytes, in a binary file.
    pub(super) fn size(self) -> usize {
        match self {
            Number::I8 | Number::U8 => 1,
            Number::I16 | Number::U16 => 2,
            Number::I32 | Number::U32 | Number::F32 => 4,
            Number::F64 => 8,
        }
    }

    fn is_integer(self) -> bool {
        !matches!(self, Number::F32 | Number::F64)
    }
}

fn keyword(words: &mut Words<'_>, expected: &'static str) -> Result<(), ReadError> {
    // A comment may stand before the format.
    let mut word = words.expect(expected)?;
    while word == b"comment" {
        words.next_line();
        word = words.expect(expected)?;
    }
    if word == expected.as_bytes() { Ok(()) } else { Err(words.error(expected, word)) }
}

fn encoding(words: &mut Words<'_>) -> Result<Encoding, ReadError> {
    match words.on_line().unwrap_or_default() {
        b"ascii" => Ok(Encoding::Ascii),
        b"binary_little_endian" => Ok(Encoding::LittleEndian),
        b"binary_big_endian" => Ok(Encoding::BigEndian),
        word => Err(words.error("ascii, binary_little_endian or binary_big_endian", word)),
    }
}

fn element<'a>(words: &mut Words<'a>) -> Result<Element<'a>, ReadError> {
    let name = words.on_line().ok_or_else(|| words.error("the name of an element", b""))?;
    let count = words.on_line().unwrap_or_default();
    let count = parse(count).ok_or_else(|| words.error("the number of elements", count))?;
    Ok(Element { name, count, properties: Vec::new(), line: words.line() })
}

fn property<'a>(words: &mut Words<'a>) -> Result<Property<'a>, ReadError> {
    let kind = match words.on_line().unwrap_or_default() {
        b"list" => {
            let [count, item] = [words.on_line(), words.on_line()].map(Option::unwrap_or_default);
            Kind::List { count: number(words, count)?, item: number(words, item)? }
        }
        name => Kind::Scalar(number(words, name)?),
    };
    if let Kind::List { count, .. } = kind
        && !count.is_integer()
    {
        return Err(words.error("an integer type for the count of a list", b"a float"));
    }
    let name = words.on_line().ok_or_else(|| words.error("the name of a property", b""))?;
    Ok(Property { name, kind })
}

fn number(words: &Words<'_>, name: &[u8]) -> Result<Number, ReadError> {
    Number::named(name).ok_or_else(|| words.error("a type such as float, double, uchar or int", name))
}
