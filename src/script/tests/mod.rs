//! The language as a whole, seen from outside: scripts in, messages and recipes out.

mod expressions;
mod hostile;
mod modules;
mod scopes;

use super::*;
use std::collections::BTreeMap;

/// A host with files in memory that writes down what is said.
#[derive(Default)]
pub(super) struct Memory {
    files: BTreeMap<&'static str, &'static str>,
    meshes: BTreeMap<&'static str, Arc<Mesh>>,
    messages: Vec<Message>,
}

impl Host for Memory {
    fn script(&mut self, name: &str, _from: &str) -> Result<Loaded, String> {
        let text = self.files.get(name).ok_or("there is no such file")?;
        Ok(Loaded { name: name.to_owned(), text: (*text).to_owned() })
    }

    fn mesh(&mut self, name: &str, _from: &str) -> Result<Arc<Mesh>, String> {
        self.meshes.get(name).cloned().ok_or_else(|| "there is no such file".to_owned())
    }

    fn say(&mut self, message: Message) {
        self.messages.push(message);
    }
}

impl Memory {
    fn with(files: &[(&'static str, &'static str)]) -> Memory {
        Memory { files: files.iter().copied().collect(), ..Memory::default() }
    }

    fn run(&mut self, text: &str) -> Result<Evaluated, Failure> {
        self.run_with(text, &Options::default())
    }

    pub(super) fn run_with(&mut self, text: &str, options: &Options) -> Result<Evaluated, Failure> {
        evaluate(Loaded { name: "main.scad".to_owned(), text: text.to_owned() }, self, options)
    }

    /// Texts of the messages of a severity.
    fn texts(&self, severity: Severity) -> Vec<&str> {
        let wanted = self.messages.iter().filter(|message| message.severity == severity);
        wanted.map(|message| message.text.as_str()).collect()
    }

    fn echoes(&self) -> Vec<&str> {
        self.texts(Severity::Echo)
    }
}

/// Checks what a script echoes, one line each.
#[track_caller]
pub(super) fn check_echo(text: &str, expected: &[&str]) {
    check_echo_with(&[], text, expected);
}

#[track_caller]
pub(super) fn check_echo_with(files: &[(&'static str, &'static str)], text: &str, expected: &[&str]) {
    let mut host = Memory::with(files);
    let result = host.run(text);
    assert!(result.is_ok(), "{text}\n{:#?}", host.texts(Severity::Error));
    assert_eq!(host.echoes(), expected, "{text}\n{:#?}", host.texts(Severity::Warning));
}

/// Checks that a script says one warning or error that contains `part`, at `at`.
#[track_caller]
pub(super) fn check_complaint(severity: Severity, text: &str, part: &str, at: &str) {
    let mut host = Memory::default();
    let result = host.run(text);
    assert_eq!(result.is_err(), severity == Severity::Error, "{text}\n{:#?}", host.messages);
    let found =
        host.messages.iter().find(|message| message.severity == severity && message.text.contains(part));
    let Some(message) = found else { panic!("{text}\n{:#?}", host.messages) };
    let span = message.at.as_ref().expect("a place").span;
    let place = &message.files[span.file.0 as usize].text[span.start as usize..span.end as usize];
    assert_eq!(place, at, "{text}");
}
