//! Words of SVG attributes.

/// What is wrong within an attribute: where, in bytes from its start, and what should stand there.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fault {
    pub(super) at: usize,
    pub(super) expected: &'static str,
}

/// A position in the value of an attribute.
pub(super) struct Scanner<'a> {
    text: &'a str,
    pub(super) at: usize,
}

impl<'a> Scanner<'a> {
    pub(super) fn new(text: &'a str) -> Scanner<'a> {
        Scanner { text, at: 0 }
    }

    pub(super) fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    /// The next byte, passed over, if it is this one.
    pub(super) fn take(&mut self, byte: u8) -> bool {
        let taken = self.peek() == Some(byte);
        self.at += usize::from(taken);
        taken
    }

    pub(super) fn skip_spaces(&mut self) {
        self.skip(|byte| matches!(byte, b' ' | b'\t' | b'\n' | b'\r' | 0x0c));
    }

    fn skip(&mut self, passed: impl Fn(u8) -> bool) {
        while self.peek().is_some_and(&passed) {
            self.at += 1;
        }
    }

    /// Passes over spaces and at most one comma; whether there was a comma.
    pub(super) fn separator(&mut self) -> bool {
        self.skip_spaces();
        let comma = self.take(b',');
        self.skip_spaces();
        comma
    }

    pub(super) fn fault(&self, expected: &'static str) -> Fault {
        Fault { at: self.at, expected }
    }

    /// Whether a number starts here.
    pub(super) fn is_number(&self) -> bool {
        self.peek().is_some_and(|byte| matches!(byte, b'0'..=b'9' | b'.' | b'-' | b'+'))
    }

    /// A number of the SVG grammar, finite: the longest run of bytes that is one, so that `1.5.5` and `1-2` are two
    /// and `2em` leaves its unit.
    pub(super) fn number(&mut self, expected: &'static str) -> Result<f64, Fault> {
        let start = self.at;
        if matches!(self.peek(), Some(b'+' | b'-')) {
            self.at += 1;
        }
        let digits = self.digits();
        let fraction = if self.take(b'.') { self.digits() } else { 0 };
        if digits + fraction > 0 {
            self.exponent();
        }
        let number = self.text[start..self.at].parse().ok().filter(|x: &f64| x.is_finite());
        number.ok_or(Fault { at: start, expected })
    }

    fn digits(&mut self) -> usize {
        let start = self.at;
        self.skip(|byte| byte.is_ascii_digit());
        self.at - start
    }

    /// An exponent if all of one is there.
    fn exponent(&mut self) {
        let start = self.at;
        if self.take(b'e') || self.take(b'E') {
            if matches!(self.peek(), Some(b'+' | b'-')) {
                self.at += 1;
            }
            if self.digits() == 0 {
                self.at = start;
            }
        }
    }

    /// A number and what separates it from the next.
    pub(super) fn listed(&mut self, expected: &'static str) -> Result<f64, Fault> {
        let number = self.number(expected)?;
        self.separator();
        Ok(number)
    }

    /// A flag of an arc and what separates it from the next word: a single `0` or `1`.
    pub(super) fn flag(&mut self) -> Result<bool, Fault> {
        let set = match self.peek() {
            Some(b'0') => false,
            Some(b'1') => true,
            _ => return Err(self.fault("a flag, 0 or 1")),
        };
        self.at += 1;
        self.separator();
        Ok(set)
    }

    /// Letters.
    pub(super) fn word(&mut self) -> &'a str {
        let start = self.at;
        self.skip(|byte| byte.is_ascii_alphabetic());
        &self.text[start..self.at]
    }

    /// What is left.
    pub(super) fn rest(&self) -> &'a str {
        self.text.get(self.at..).unwrap_or_default()
    }

    /// Checks that nothing but spaces is left.
    pub(super) fn end(&mut self) -> Result<(), Fault> {
        self.skip_spaces();
        if self.at == self.text.len() { Ok(()) } else { Err(self.fault("nothing more")) }
    }
}
