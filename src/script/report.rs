//! What goes wrong, on its way to a [`Message`](super::Message).

use super::Loaded;
use super::diagnostic::{Frame, Label, Message, Severity, Span};
use std::sync::Arc;

/// Something to say about a place, before it is known which calls led there.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Complaint {
    pub(super) severity: Severity,
    pub(super) text: String,
    pub(super) span: Span,
    pub(super) also: Vec<Label>,
    pub(super) hints: Vec<String>,
}

impl Complaint {
    /// The script stops for it.
    pub(super) fn error(span: Span, text: impl Into<String>) -> Complaint {
        Complaint { severity: Severity::Error, text: text.into(), span, also: Vec::new(), hints: Vec::new() }
    }

    /// The script goes on.
    pub(super) fn warning(span: Span, text: impl Into<String>) -> Complaint {
        Complaint { severity: Severity::Warning, ..Complaint::error(span, text) }
    }

    /// With something to try.
    pub(super) fn hint(mut self, text: impl Into<String>) -> Complaint {
        self.hints.push(text.into());
        self
    }

    /// With a further place that explains the first.
    pub(super) fn also(mut self, span: Span, text: impl Into<String>) -> Complaint {
        self.also.push(Label { span, text: text.into() });
        self
    }

    /// As a message, with the calls that led there.
    pub(super) fn into_message(self, trace: Vec<Frame>, files: Arc<Vec<Loaded>>) -> Message {
        let Complaint { severity, text, span, also, hints } = self;
        Message { severity, text, at: Some(Label { span, text: String::new() }), also, hints, trace, files }
    }
}
