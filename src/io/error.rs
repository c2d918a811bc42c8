use super::text::Shortest;
use crate::math::Vec3;
use crate::mesh::Mesh;
use std::{fmt, io};

/// Where and why the bytes of a file stop making sense.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadError {
    /// The place.
    pub at: Place,
    /// The reason.
    pub problem: Problem,
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of a text, from 1.
    Line(usize),
    /// A character of a line of a text, both from 1.
    Character {
        /// The line.
        line: usize,
        /// The character in it.
        column: usize,
    },
    /// A byte of a binary file, from 0.
    Byte(usize),
}

/// Why bytes make no sense.
#[derive(Clone, Debug, PartialEq)]
pub enum Problem {
    /// Something else stands there.
    Expected {
        /// What should be there.
        expected: &'static str,
        /// What is there, shortened.
        found: String,
    },
    /// The file ends in the middle.
    Ended {
        /// What should follow.
        expected: &'static str,
    },
    /// The file is shorter than its own counts say.
    TooShort {
        /// Bytes that the counts ask for; `u64::MAX` where that is not enough to say it.
        needed: u64,
        /// Bytes there are.
        size: u64,
    },
    /// The file goes on long after its own counts say that it ends.
    TooLong {
        /// Bytes that are left over.
        left: u64,
    },
    /// A face names a vertex that is not there.
    NoSuchVertex {
        /// As written in the file.
        index: i64,
        /// Number of vertices.
        count: usize,
    },
    /// More vertices or triangles than indices of 32 bits can tell apart.
    TooLarge,
    /// A kind of file that is not read.
    Unsupported {
        /// What is not.
        what: &'static str,
    },
    /// The text breaks the rules of its format.
    Malformed {
        /// What the parser says of it.
        reason: String,
    },
    /// There is more of something than is read.
    TooMany {
        /// Of what.
        what: &'static str,
        /// How many are read at most.
        most: usize,
    },
    /// Coordinates that leave the range of `f64`.
    OutOfRange,
}

impl ReadError {
    pub(super) fn line(line: usize, problem: Problem) -> ReadError {
        ReadError { at: Place::Line(line), problem }
    }

    pub(super) fn byte(byte: usize, problem: Problem) -> ReadError {
        ReadError { at: Place::Byte(byte), problem }
    }
}

impl Problem {
    pub(super) fn expected(expected: &'static str, found: &[u8]) -> Problem {
        const SHOWN: usize = 40;
        let mut text = String::from_utf8_lossy(&found[..found.len().min(SHOWN)]).escape_debug().to_string();
        if found.len() > SHOWN {
            text.push('…');
        }
        Problem::Expected { expected, found: text }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.at, self.problem)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Line(line) => write!(f, "line {line}"),
            Place::Character { line, column } => write!(f, "line {line}, column {column}"),
            Place::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Problem::Expected { expected, found } => write!(f, "expected {expected}, found `{found}`"),
            Problem::Ended { expected } => write!(f, "the file ends where {expected} should follow"),
            Problem::TooShort { needed, size } => {
                write!(f, "the file is truncated: its counts ask for {needed} bytes, it has {size}")
            }
            Problem::TooLong { left } => write!(f, "{left} bytes follow after the last triangle"),
            Problem::NoSuchVertex { index, count } => {
                write!(f, "a face names vertex {index}, there are {count}")
            }
            Problem::TooLarge => write!(f, "more vertices or triangles than 32 bits can count"),
            Problem::Unsupported { what } => write!(f, "{what} cannot be read"),
            Problem::Malformed { reason } => f.write_str(reason),
            Problem::TooMany { what, most } => write!(f, "more than {most} {what}"),
            Problem::OutOfRange => write!(f, "coordinates leave the range of numbers"),
        }
    }
}

impl std::error::Error for ReadError {}

/// Why a mesh could not be written.
#[derive(Debug)]
pub enum WriteError {
    /// What the writer reported.
    Io(io::Error),
    /// A triangle names a vertex that is not there.
    NoSuchVertex {
        /// Index of the triangle.
        triangle: usize,
        /// The vertex that it names.
        vertex: u32,
        /// Number of vertices.
        count: usize,
    },
    /// A position that becomes infinite, or is not a number, in the `f32` of the format.
    NotInFormat {
        /// Index of the vertex.
        vertex: u32,
        /// Its position.
        position: Vec3,
    },
    /// A mesh, a polygon or another field is part of what should be a formula.
    NotAFormula,
}

impl WriteError {
    /// Checks that all triangles of `mesh` name vertices that are there.
    pub(super) fn check_indices(mesh: &Mesh) -> Result<(), WriteError> {
        let count = mesh.positions.len();
        for (triangle, corners) in mesh.triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= count) {
                return Err(WriteError::NoSuchVertex { triangle, vertex, count });
            }
        }
        Ok(())
    }
}

impl fmt::Display for WriteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            WriteError::Io(error) => error.fmt(f),
            WriteError::NoSuchVertex { triangle, vertex, count } => {
                write!(f, "triangle {triangle} names vertex {vertex}, there are {count}")
            }
            WriteError::NotInFormat { vertex, position: p } => {
                let [x, y, z] = p.to_array().map(Shortest);
                write!(f, "vertex {vertex} at ({x}, {y}, {z}) does not fit the format's f32")
            }
            WriteError::NotAFormula => {
                write!(
                    f,
                    "a mesh, a polygon or another field is part of it, which cannot be written as a formula"
                )
            }
        }
    }
}

impl std::error::Error for WriteError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            WriteError::Io(error) => Some(error),
            WriteError::NoSuchVertex { .. } | WriteError::NotInFormat { .. } | WriteError::NotAFormula => {
                None
            }
        }
    }
}

impl From<io::Error> for WriteError {
    fn from(error: io::Error) -> WriteError {
        WriteError::Io(error)
    }
}
