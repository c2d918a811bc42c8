/// A text that takes part, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FileId(pub u32);

/// A stretch of text, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Span {
    /// Where.
    pub file: FileId,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

/// How much a message matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// What the script wanted to be printed.
    Echo,
    /// Worth a look; the script goes on.
    Warning,
    /// The script stops.
    Error,
}

/// Something a script, or the kernel on its behalf, has to say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// How much it matters.
    pub severity: Severity,
    /// One sentence; for an echo, its text.
    pub text: String,
    /// The place it is about, with a word on it; none for a message about no place.
    pub at: Option<Label>,
    /// Further places that explain the first.
    pub also: Vec<Label>,
    /// What to try.
    pub hints: Vec<String>,
    /// The calls that led there, innermost first.
    pub trace: Vec<Frame>,
    /// The texts of the places, so that they can be shown: name and text by [`FileId`].
    pub files: std::sync::Arc<Vec<super::Loaded>>,
}

/// A place with a word on it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// What is there; may be empty.
    pub text: String,
}

/// One call of a trace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// What was called, such as `module gear` or `function f`.
    pub name: String,
    /// Where it was called.
    pub span: Span,
}
