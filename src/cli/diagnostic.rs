//! Messages of a script as text: with the line and a caret, or on one line as OpenSCAD prints them.

use super::terminal::Style;
use crate::script::{FileId, Label, Loaded, Message, Severity, Span};
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use std::ops::Range;
use std::path::Path;

/// Calls of a trace that are shown at each end.
const TRACE_SHOWN: usize = 6;

/// A message, ready to be printed.
pub(super) fn render(message: &Message, style: Style) -> String {
    match (message.severity, style.oneline) {
        (Severity::Echo, _) => format!("ECHO: {}", message.text),
        (_, true) => one_line(message),
        (_, false) => with_snippets(message, style),
    }
}

/// A message about no place.
pub(super) fn placeless(severity: Severity, text: impl Into<String>) -> Message {
    let (at, also, hints, trace, files) = Default::default();
    Message { severity, text: text.into(), at, also, hints, trace, files }
}

/// `WARNING: text in file name, line n`, then a line for each call and hint.
fn one_line(message: &Message) -> String {
    let kind = if message.severity == Severity::Error { "ERROR" } else { "WARNING" };
    let mut text = format!("{kind}: {}", message.text);
    if let Some(place) = message.at.as_ref().and_then(|label| Place::of(label.span, &message.files)) {
        text += &format!(" in file {}, line {}", place.name, place.line);
    }
    for frame in &message.trace {
        if let Some(place) = Place::of(frame.span, &message.files) {
            text +=
                &format!("\nTRACE: called by '{}' in file {}, line {}", frame.name, place.name, place.line);
        }
    }
    for hint in &message.hints {
        text += &format!("\nHINT: {hint}");
    }
    text
}

fn with_snippets(message: &Message, style: Style) -> String {
    let level = if message.severity == Severity::Error { Level::ERROR } else { Level::WARNING };
    let mut group = Group::with_title(level.primary_title(message.text.as_str()));
    for snippet in snippets(message) {
        group = group.element(snippet);
    }
    for line in trace(message) {
        group = group.element(Level::NOTE.message(line));
    }
    for hint in &message.hints {
        group = group.element(Level::HELP.message(hint.as_str()));
    }
    let renderer = if style.colored { Renderer::styled() } else { Renderer::plain() };
    renderer.render(&[group])
}

/// One snippet a file: that of the message's own place first, then those of the places that explain it.
fn snippets(message: &Message) -> Vec<Snippet<'_, annotate_snippets::Annotation<'_>>> {
    let labels = || message.at.iter().chain(&message.also);
    let mut files: Vec<FileId> = Vec::new();
    for label in labels() {
        if !files.contains(&label.span.file) {
            files.push(label.span.file);
        }
    }
    let own = message.at.as_ref().map(|label| label.span);
    let of_file = |&file: &FileId| {
        let loaded = message.files.get(file.0 as usize)?;
        let labels: Vec<&Label> = labels().filter(|label| label.span.file == file).collect();
        Some(snippet(loaded, &labels, own))
    };
    files.iter().filter_map(of_file).collect()
}

/// The lines of all `labels`, and only those: rendering takes time with the length of its source.
fn snippet<'a>(
    file: &'a Loaded,
    labels: &[&'a Label],
    own: Option<Span>,
) -> Snippet<'a, annotate_snippets::Annotation<'a>> {
    let ranges: Vec<Range<usize>> = labels.iter().map(|label| range(label.span, &file.text)).collect();
    let first = ranges.iter().map(|range| range.start).min().unwrap_or_default();
    let last = ranges.iter().map(|range| range.end).max().unwrap_or_default();
    let start = file.text[..first].rfind('\n').map_or(0, |line_end| line_end + 1);
    let end = file.text[last..].find('\n').map_or(file.text.len(), |length| last + length);
    let annotations = labels.iter().zip(ranges).map(|(label, range)| {
        let kind = if Some(label.span) == own { AnnotationKind::Primary } else { AnnotationKind::Context };
        let annotation = kind.span(range.start - start..range.end - start);
        if label.text.is_empty() { annotation } else { annotation.label(label.text.as_str()) }
    });
    Snippet::source(&file.text[start..end])
        .line_start(1 + file.text[..start].matches('\n').count())
        .path(shown_name(&file.name))
        .annotations(annotations)
}

/// The calls, innermost first; of many, those at both ends.
fn trace(message: &Message) -> Vec<String> {
    let frames = &message.trace;
    let hidden = frames.len().saturating_sub(2 * TRACE_SHOWN);
    let mut lines = Vec::new();
    for (index, frame) in frames.iter().enumerate() {
        if hidden > 0 && index == TRACE_SHOWN {
            lines.push(format!("... {hidden} more calls ..."));
        }
        if hidden > 0 && (TRACE_SHOWN..TRACE_SHOWN + hidden).contains(&index) {
            continue;
        }
        let place = Place::of(frame.span, &message.files);
        let place =
            place.map(|p| format!(", called at {}:{}:{}", p.name, p.line, p.column)).unwrap_or_default();
        lines.push(format!("in {}{place}", frame.name));
    }
    lines
}

/// A place as people name it.
struct Place {
    name: String,
    /// From 1.
    line: usize,
    /// In characters, from 1.
    column: usize,
}

impl Place {
    fn of(span: Span, files: &[Loaded]) -> Option<Place> {
        let file = files.get(span.file.0 as usize)?;
        let before = &file.text[..range(span, &file.text).start];
        let line_start = before.rfind('\n').map_or(0, |line_end| line_end + 1);
        let line = 1 + before.matches('\n').count();
        Some(Place { name: shown_name(&file.name), line, column: 1 + before[line_start..].chars().count() })
    }
}

/// The bytes of a span, within the text and at the edges of characters.
fn range(span: Span, text: &str) -> Range<usize> {
    let floor = |byte: u32| {
        let byte = (byte as usize).min(text.len());
        (0..=byte).rev().find(|&byte| text.is_char_boundary(byte)).unwrap_or_default()
    };
    let start = floor(span.start);
    start..floor(span.end).max(start)
}

/// A path from the working folder where that is shorter.
fn shown_name(name: &str) -> String {
    let here = std::env::current_dir().and_then(|folder| folder.canonicalize());
    let inside = here.ok().and_then(|here| Path::new(name).strip_prefix(here).ok().map(Path::to_owned));
    inside.map_or_else(|| name.to_owned(), |path| path.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::script::Frame;
    use std::sync::Arc;

    const PLAIN: Style = Style { colored: false, oneline: false };
    const ONE_LINE: Style = Style { colored: false, oneline: true };

    fn span(file: u32, start: u32, end: u32) -> Span {
        Span { file: FileId(file), start, end }
    }

    fn message() -> Message {
        let main = "include <gear.scad>\n\u{fc} = 1; gaer(3);\n";
        let gear = "module gear(n) {\n  cube(n);\n}\n";
        let file = |name: &str, text: &str| Loaded { name: name.to_owned(), text: text.to_owned() };
        Message {
            severity: Severity::Warning,
            text: "there is no module `gaer`".to_owned(),
            at: Some(Label { span: span(0, 28, 32), text: "not found".to_owned() }),
            also: vec![Label { span: span(1, 7, 11), text: String::new() }],
            hints: vec!["did you mean `gear`?".to_owned()],
            trace: vec![Frame { name: "module wheel".to_owned(), span: span(1, 19, 23) }],
            files: Arc::new(vec![file("/m/main.scad", main), file("/m/gear.scad", gear)]),
        }
    }

    #[test]
    fn carets_stand_under_the_text() {
        let text = render(&message(), PLAIN);
        let expected = "\
warning: there is no module `gaer`
 --> /m/main.scad:2:8
  |
2 | \u{fc} = 1; gaer(3);
  |        ^^^^ not found
  |
 ::: /m/gear.scad:1:8
  |
1 | module gear(n) {
  |        ----
  |
  = note: in module wheel, called at /m/gear.scad:2:3
  = help: did you mean `gear`?";
        assert_eq!(text, expected);
    }

    #[test]
    fn on_one_line() {
        let expected = "WARNING: there is no module `gaer` in file /m/main.scad, line 2\n\
            TRACE: called by 'module wheel' in file /m/gear.scad, line 2\nHINT: did you mean `gear`?";
        assert_eq!(render(&message(), ONE_LINE), expected);
        let echo = Message { severity: Severity::Echo, text: "[1, 2]".to_owned(), ..message() };
        assert_eq!(render(&echo, PLAIN), "ECHO: [1, 2]");
    }

    #[test]
    fn long_traces_are_cut_in_the_middle() {
        let frame = message().trace[0].clone();
        let long = Message { trace: vec![frame; 10_000], ..message() };
        let text = render(&long, PLAIN);
        assert!(text.contains("... 9988 more calls ..."), "{text}");
        assert_eq!(text.matches("in module wheel").count(), 12);
    }

    /// Spans at the end of a text, beyond it, inside a character, and of a file that is not there.
    #[test]
    fn odd_places() {
        for place in [span(0, 40, 40), span(0, 4000, 5000), span(0, 21, 21), span(0, 30, 3), span(7, 0, 1)] {
            let odd = Message { at: Some(Label { span: place, text: String::new() }), ..message() };
            assert!(render(&odd, PLAIN).contains("gaer"));
            assert!(render(&odd, ONE_LINE).contains("gaer"));
        }
    }
}
