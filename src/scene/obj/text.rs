//! From the bytes of a file to its lines.

use super::error::{Kind, ObjError};
use std::borrow::Cow;

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

#[cfg(test)]
mod tests {
    use super::*;

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
