use crate::io::WriteError;
use std::fmt::Display;
use std::io;

/// Why the program ends before it is done.
#[derive(Debug)]
pub(super) enum Stop {
    /// An error that diagnostics have already explained.
    Explained,
    /// An error in the script, the input or while writing.
    Error(String),
    /// A command line that makes no sense.
    Usage(String),
    /// A limit was reached; `None` when diagnostics have already explained it.
    Limit(Option<String>),
    /// The result is not closed, and had to be.
    NotClosed(String),
    /// Whoever read our output has seen enough.
    BrokenPipe,
}

impl Stop {
    /// An error about the file or thing `name`.
    pub(super) fn about(name: impl Display, reason: impl Display) -> Stop {
        Stop::Error(format!("{name}: {reason}"))
    }

    /// An error while writing to standard output.
    pub(super) fn of_stdout(error: WriteError) -> Stop {
        match error {
            WriteError::Io(error) if error.kind() == io::ErrorKind::BrokenPipe => Stop::BrokenPipe,
            error => Stop::about("standard output", error),
        }
    }

    /// The exit code of the process.
    pub(super) fn code(&self) -> u8 {
        match self {
            Stop::BrokenPipe => 0,
            Stop::Explained | Stop::Error(_) => 1,
            Stop::Usage(_) => 2,
            Stop::Limit(_) => 3,
            Stop::NotClosed(_) => 4,
        }
    }

    /// What is left to say about it.
    pub(super) fn text(&self) -> Option<&str> {
        match self {
            Stop::Explained | Stop::BrokenPipe => None,
            Stop::Error(text) | Stop::Usage(text) | Stop::NotClosed(text) => Some(text),
            Stop::Limit(text) => text.as_deref(),
        }
    }
}
