use super::diagnostic;
use super::stop::Stop;
use crate::script::{Message, Severity, Span};
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use std::cell::RefCell;
use std::collections::HashMap;
use std::fmt;
use std::io::Write;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// How often a warning about one place is shown; a loop can raise it a million times.
const SHOWN_PER_PLACE: u64 = 3;
/// Work that takes less than this shows no progress.
const SHORT: Duration = Duration::from_millis(500);

/// How messages look.
#[derive(Clone, Copy)]
pub(super) struct Style {
    pub(super) colored: bool,
    /// One line a message, as OpenSCAD prints them.
    pub(super) oneline: bool,
}

/// The standard error stream: what is said to the user while we work. Standard output is for results.
pub(super) struct Terminal {
    style: Style,
    quiet: bool,
    /// What is being done, for the spinner's thread.
    stage: Arc<Mutex<String>>,
    spinner: ProgressBar,
    said: RefCell<Said>,
}

/// What has been said.
#[derive(Default)]
struct Said {
    warnings: u64,
    echoes: u64,
    /// How often each place has been warned about.
    at: HashMap<(Option<Span>, String), u64>,
}

impl Terminal {
    pub(super) fn new(style: Style, quiet: bool, is_terminal: bool) -> Terminal {
        let stage = Arc::new(Mutex::new(String::new()));
        let hidden = quiet || !is_terminal;
        let spinner = if hidden { ProgressBar::hidden() } else { spinner(Arc::clone(&stage)) };
        Terminal { style, quiet, stage, spinner, said: RefCell::default() }
    }

    /// Shows what is being done, once it takes long.
    pub(super) fn stage(&self, name: impl Into<String>) {
        if let Ok(mut stage) = self.stage.lock() {
            *stage = name.into();
        }
    }

    /// Takes a warning that is about no place of a script.
    pub(super) fn warn(&self, text: impl Into<String>) {
        self.say(&diagnostic::placeless(Severity::Warning, text));
    }

    /// Prints what a script says.
    pub(super) fn say(&self, message: &Message) {
        let mut said = self.said.borrow_mut();
        match message.severity {
            Severity::Error => {}
            Severity::Echo => said.echoes += 1,
            Severity::Warning => {
                said.warnings += 1;
                let place = message.at.as_ref().map(|label| label.span);
                let text = if place.is_none() { message.text.clone() } else { String::new() };
                let times = said.at.entry((place, text)).or_default();
                *times += 1;
                if *times > SHOWN_PER_PLACE {
                    return;
                }
            }
        }
        if !self.quiet || message.severity == Severity::Error {
            self.print(diagnostic::render(message, self.style).trim_end());
        }
    }

    /// Prints a line about the outcome.
    pub(super) fn note(&self, line: impl fmt::Display) {
        if !self.quiet {
            self.print(line);
        }
    }

    /// The numbers of warnings and echoes so far.
    pub(super) fn counts(&self) -> [u64; 2] {
        let said = self.said.borrow();
        [said.warnings, said.echoes]
    }

    /// Ends the progress display and says what has not been shown.
    pub(super) fn close(&self) {
        self.spinner.finish_and_clear();
        let said = self.said.borrow();
        let hidden: u64 = said.at.values().map(|times| times.saturating_sub(SHOWN_PER_PLACE)).sum();
        if hidden > 0 {
            self.note(format_args!("{hidden} more warnings about the same places"));
        }
    }

    /// Prints why we stop, unless that is known.
    pub(super) fn explain(&self, stop: &Stop) {
        if let Some(text) = stop.text() {
            self.say(&diagnostic::placeless(Severity::Error, text));
        }
    }

    fn print(&self, line: impl fmt::Display) {
        // Nobody is left to tell when this fails.
        self.spinner.suspend(|| drop(writeln!(std::io::stderr().lock(), "{line}")));
    }
}

/// Prints why we stop, from outside of the thread that has the terminal.
pub(super) fn explain_plainly(stop: &Stop) {
    let text = stop.text().unwrap_or_default();
    drop(writeln!(std::io::stderr().lock(), "error: {text}"));
}

/// A line with what is being done and for how long; blank while that is short.
fn spinner(stage: Arc<Mutex<String>>) -> ProgressBar {
    let line = move |state: &ProgressState, out: &mut dyn fmt::Write| {
        let elapsed = state.elapsed();
        if let Ok(stage) = stage.lock()
            && elapsed > SHORT
        {
            let _ = write!(out, "{stage} ({} s)", elapsed.as_secs());
        }
    };
    let style = ProgressStyle::with_template("{line}").unwrap_or_else(|_| ProgressStyle::default_spinner());
    let bar = ProgressBar::new_spinner().with_style(style.with_key("line", line));
    bar.enable_steady_tick(SHORT / 5);
    bar
}
