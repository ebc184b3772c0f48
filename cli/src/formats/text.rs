//! Lines of text in bytes.

/// The lines of a text that contain words. Comments are left out.
pub(crate) struct Lines<'a> {
    rest: &'a [u8],
    number: usize,
}

/// A line.
#[derive(Clone, Copy)]
pub(crate) struct Line<'a> {
    bytes: &'a [u8],
    /// The number of the line, counted from 1.
    number: usize,
}

impl<'a> Lines<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self::after(0, bytes)
    }

    /// The lines after the first `number` lines, which were read otherwise.
    pub(crate) fn after(number: usize, bytes: &'a [u8]) -> Self {
        Self { rest: bytes, number }
    }

    /// The bytes behind the lines that were read.
    pub(crate) fn rest(&self) -> &'a [u8] {
        self.rest
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        while !self.rest.is_empty() {
            let end = self.rest.iter().position(|&byte| byte == b'\n');
            let (line, rest) = self.rest.split_at(end.map_or(self.rest.len(), |end| end + 1));
            self.rest = rest;
            self.number += 1;
            let comment = line.iter().position(|&byte| byte == b'#').unwrap_or(line.len());
            let bytes = line[..comment].trim_ascii();
            if !bytes.is_empty() {
                return Some(Line { bytes, number: self.number });
            }
        }
        None
    }
}

impl<'a> Line<'a> {
    /// The words of the line. A word that is not UTF-8 is not a number, and is returned as an empty word.
    pub(crate) fn words(self) -> impl Iterator<Item = &'a str> {
        let words = self.bytes.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        words.map(|word| std::str::from_utf8(word).unwrap_or(""))
    }

    /// An error about something in the line.
    pub(crate) fn about(self, what: &str, problem: &str) -> String {
        format!("line {}, {what}: {problem}", self.number)
    }
}
