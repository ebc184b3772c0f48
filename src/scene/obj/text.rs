use super::error::{Kind, ObjError};
use std::borrow::Cow;

/// The text without its byte-order mark. Bytes that are not UTF-8, as old files
/// have in names and comments, become U+FFFD.
pub(super) fn decode(bytes: &[u8]) -> Result<Cow<'_, str>, ObjError> {
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err(Kind::Utf16.at(None, None));
    }
    if let Some(zero) = bytes.iter().position(|&byte| byte == 0) {
        let before = String::from_utf8_lossy(&bytes[..zero]);
        let line = lines(&before).count().max(1);
        return Err(Kind::ZeroByte.at(Some(line), None));
    }
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    Ok(String::from_utf8_lossy(text))
}

/// Lines with their numbers from 1. They end in LF, CR LF or CR; a line that is
/// no comment and ends in a backslash is joined with the next by a space.
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
    fn a_zero_byte_is_found_on_its_line() {
        let error = decode(b"v 1 2 3\nv\0").map(Cow::into_owned);
        assert_eq!(error.err().and_then(|error| error.line()), Some(2));
    }
}
