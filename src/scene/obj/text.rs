//! From the bytes of a file to its lines.

use super::error::{Kind, ObjError};
use std::borrow::Cow;
use std::io::{self, BufRead};

/// Byte-order marks of encodings that are not read; that of UTF-32 begins with one of UTF-16.
const MARKS: [(&[u8], &str); 4] = [
    (b"\xff\xfe\0\0", "UTF-32"),
    (b"\0\0\xfe\xff", "UTF-32"),
    (b"\xff\xfe", "UTF-16"),
    (b"\xfe\xff", "UTF-16"),
];

/// The text without its byte-order mark.
///
/// Old files have names and comments in other encodings. Where there is a line, not a comment, that
/// is not UTF-8, each byte becomes the character of that number (Latin-1), so that different names
/// stay different, and a name in a material library is the same as in the file that uses it.
pub(super) fn decode(bytes: &[u8]) -> Result<Cow<'_, str>, ObjError> {
    if let Some((_, name)) = MARKS.iter().find(|(mark, _)| bytes.starts_with(mark)) {
        return Err(Kind::Encoding(name).at(None, None));
    }
    if let Some(zero) = bytes.iter().position(|&byte| byte == 0) {
        let before = String::from_utf8_lossy(&bytes[..zero]);
        let line = lines(&before).count().max(1);
        return Err(Kind::ZeroByte.at(Some(line), None));
    }
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let is_good = |line: &[u8]| {
        line.trim_ascii_start().starts_with(b"#") || std::str::from_utf8(line).is_ok()
    };
    if text.split(|&byte| byte == b'\n' || byte == b'\r').all(is_good) {
        return Ok(String::from_utf8_lossy(text));
    }
    Ok(text.iter().map(|&byte| char::from(byte)).collect())
}

/// Lines with their numbers from 1. They end in LF, CR LF or CR; a line that is no comment and ends
/// in a backslash is joined with the next by a space.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut rest = text;
    let mut number = 0;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let mut line = Cow::Borrowed(physical_line(&mut rest));
        number += 1;
        let first = number;
        // A comment may well end in a Windows path.
        while line.ends_with('\\') && !line.trim_start().starts_with('#') {
            let joined = line.to_mut();
            joined.pop();
            if rest.is_empty() {
                break;
            }
            joined.push(' ');
            joined.push_str(physical_line(&mut rest));
            number += 1;
        }
        Some((first, line))
    })
}

fn physical_line<'a>(rest: &mut &'a str) -> &'a str {
    let end = rest.find(['\n', '\r']).unwrap_or(rest.len());
    let (line, behind) = rest.split_at(end);
    *rest = behind.strip_prefix("\r\n").or(behind.get(1..)).unwrap_or_default();
    line
}

/// The lines of a file as [`lines`] gives them, read one by one. A line, not a file, that is not UTF-8
/// is taken for Latin-1.
pub(super) struct LinesOf<R> {
    input: R,
    /// The line read last, in bytes.
    bytes: Vec<u8>,
    number: usize,
    /// Whether a line ended in CR: a LF that follows belongs to it.
    is_after_cr: bool,
}

impl<R: BufRead> LinesOf<R> {
    pub(super) fn new(input: R) -> Self {
        Self { input, bytes: Vec::new(), number: 0, is_after_cr: false }
    }

    /// The next line and its number; `None` at the end.
    pub(super) fn next(&mut self) -> Result<Option<(usize, Cow<'_, str>)>, ObjError> {
        self.bytes.clear();
        if !self.read_physical()? {
            return Ok(None);
        }
        let first = self.number;
        let is_comment = self.bytes.trim_ascii_start().starts_with(b"#");
        while !is_comment && self.bytes.ends_with(b"\\") {
            self.bytes.pop();
            self.bytes.push(b' ');
            if !self.read_physical()? {
                self.bytes.pop();
                break;
            }
        }
        if self.bytes.contains(&0) {
            return Err(Kind::ZeroByte.at(Some(first), None));
        }
        let text = match std::str::from_utf8(&self.bytes) {
            Ok(text) => Cow::Borrowed(text),
            Err(_) => self.bytes.iter().map(|&byte| char::from(byte)).collect(),
        };
        Ok(Some((first, text)))
    }

    /// Adds the next line as it stands; `false` at the end.
    fn read_physical(&mut self) -> Result<bool, ObjError> {
        let about = |error: io::Error| Kind::Read(error).at(None, None);
        let start = self.bytes.len();
        let mut has_begun = false;
        loop {
            let mut given = self.input.fill_buf().map_err(about)?;
            if given.is_empty() {
                break;
            }
            if std::mem::take(&mut self.is_after_cr) && given[0] == b'\n' {
                self.input.consume(1);
                given = self.input.fill_buf().map_err(about)?;
                if given.is_empty() {
                    break;
                }
            }
            has_begun = true;
            let end = given.iter().position(|&byte| byte == b'\n' || byte == b'\r');
            self.bytes.extend_from_slice(&given[..end.unwrap_or(given.len())]);
            let Some(end) = end else {
                let all = given.len();
                self.input.consume(all);
                continue;
            };
            self.is_after_cr = given[end] == b'\r';
            self.input.consume(end + 1);
            break;
        }
        self.number += usize::from(has_begun);
        if has_begun && self.number == 1 {
            self.strip_mark(start)?;
        }
        Ok(has_begun)
    }

    fn strip_mark(&mut self, start: usize) -> Result<(), ObjError> {
        let line = &self.bytes[start..];
        if let Some((_, name)) = MARKS.iter().find(|(mark, _)| line.starts_with(mark)) {
            return Err(Kind::Encoding(name).at(None, None));
        }
        if line.starts_with(b"\xef\xbb\xbf") {
            self.bytes.drain(start..start + 3);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Read in small parts, so that lines end everywhere in them.
    #[test]
    fn lines_read_one_by_one_are_the_same() {
        let texts = [
            "a\nb\n\nc\n",
            "a\r\nb\r\n\r\nc",
            "a\rb\r\rc\r",
            "",
            "\n",
            "\r",
            "v \\",
            "f 1 \\\n2 \\\r\n3\n# C:\\\nv",
            "\u{feff}v 1\nf \\",
            "\r\n\r\n\n\rx\n\ré",
        ];
        for text in texts {
            let plain = text.strip_prefix('\u{feff}').unwrap_or(text);
            for size in 1..6 {
                let parts = io::BufReader::with_capacity(size, text.as_bytes());
                let (mut lines, mut found) = (LinesOf::new(parts), Vec::new());
                while let Some((number, line)) = lines.next().unwrap() {
                    found.push((number, line.into_owned()));
                }
                assert_eq!(found, all(plain), "{text:?} by {size}");
            }
        }
        let error = |bytes: &[u8]| LinesOf::new(bytes).next().map(|_| ()).unwrap_err().to_string();
        assert!(error(b"\xff\xfev\0").contains("UTF-16") && error(b"v\0").contains("zero byte"));
    }

    fn all(text: &str) -> Vec<(usize, String)> {
        lines(text).map(|(number, line)| (number, line.into_owned())).collect()
    }

    #[test]
    fn every_line_end_counts_once() {
        let expected = [(1, "a"), (2, "b"), (3, ""), (4, "c")].map(|(n, s)| (n, s.to_owned()));
        assert_eq!(all("a\nb\n\nc\n"), expected);
        assert_eq!(all("a\r\nb\r\n\r\nc"), expected);
        assert_eq!(all("a\rb\r\rc\r"), expected);
    }

    #[test]
    fn backslash_joins_lines_but_not_after_a_comment() {
        let expected = [(1, "f 1  2  3"), (4, "# C:\\"), (5, "v")].map(|(n, s)| (n, s.to_owned()));
        assert_eq!(all("f 1 \\\n2 \\\r\n3\n# C:\\\nv"), expected);
        assert_eq!(all("v \\"), [(1, "v ".to_owned())]);
    }

    #[test]
    fn names_that_differ_in_bytes_that_are_no_utf_8_stay_different() {
        let text = |bytes: &'static [u8]| decode(bytes).map(Cow::into_owned).ok();
        let names: Vec<Option<String>> =
            [&b"o \xe9"[..], b"o \xe8", b"o \xc3\xa9\xff", b"o \xe9\xff"].map(text).into();
        assert_eq!(names[0].as_deref(), Some("o é"));
        assert!((0..4).all(|i| (0..i).all(|j| names[i] != names[j])), "{names:?}");
        // A comment in another encoding does not change how names are read.
        assert_eq!(text(b"# \xe9\no \xc3\xa9").as_deref(), Some("# \u{fffd}\no é"));
    }

    #[test]
    fn a_zero_byte_is_found_on_its_line() {
        let error = decode(b"v 1 2 3\nv\0").map(Cow::into_owned);
        assert_eq!(error.err().and_then(|error| error.line()), Some(2));
    }
}
