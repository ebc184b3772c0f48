//! Words and signs of Rust, without comments, literals and what is compiled for tests alone.

/// The words and signs of a text; `::` is one sign.
pub(crate) fn tokens(text: &str) -> Vec<String> {
    let text: Vec<char> = text.chars().collect();
    let at = |index: usize| text.get(index).copied().unwrap_or(' ');
    let (mut found, mut index) = (Vec::new(), 0);
    while index < text.len() {
        let start = index;
        index = match (at(index), at(index + 1)) {
            ('/', '/') => line_end(&text, index),
            ('/', '*') => comment_end(&text, index),
            ('"', _) => string_end(&text, index + 1),
            ('r', '"' | '#') if raw_end(&text, index + 1).is_some() => {
                raw_end(&text, index + 1).expect("just found")
            }
            // A letter in quotes; else the name of a lifetime.
            ('\'', '\\') => 1 + (index + 3..text.len()).find(|&i| at(i) == '\'').expect("a quote"),
            ('\'', _) if at(index + 2) == '\'' => index + 3,
            ('\'', _) => word_end(&text, index + 1),
            (letter, _) if is_word(letter) => {
                let end = word_end(&text, index);
                let word: String = text[start..end].iter().collect();
                // `b"…"`, `br"…"` and the like are literals.
                if !(word.len() <= 2
                    && matches!(at(end), '"' | '\'')
                    && word.starts_with(['b', 'c']))
                {
                    found.push(word);
                }
                end
            }
            (':', ':') => {
                found.push("::".to_owned());
                index + 2
            }
            (sign, _) => {
                found.extend((!sign.is_whitespace()).then(|| sign.to_string()));
                index + 1
            }
        };
    }
    without_tests(found)
}

fn is_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

fn word_end(text: &[char], from: usize) -> usize {
    (from..text.len()).find(|&index| !is_word(text[index])).unwrap_or(text.len())
}

fn line_end(text: &[char], from: usize) -> usize {
    (from..text.len()).find(|&index| text[index] == '\n').unwrap_or(text.len())
}

fn comment_end(text: &[char], from: usize) -> usize {
    let (mut depth, mut index) = (0, from);
    while index + 1 < text.len() {
        match (text[index], text[index + 1]) {
            ('/', '*') => depth += 1,
            ('*', '/') => depth -= 1,
            _ => {
                index += 1;
                continue;
            }
        }
        index += 2;
        if depth == 0 {
            return index;
        }
    }
    text.len()
}

fn string_end(text: &[char], mut index: usize) -> usize {
    while index < text.len() && text[index] != '"' {
        index += if text[index] == '\\' { 2 } else { 1 };
    }
    index + 1
}

/// The end of a raw string whose quote or first `#` is given; none if it is something else.
fn raw_end(text: &[char], from: usize) -> Option<usize> {
    let hashes = text[from..].iter().take_while(|&&letter| letter == '#').count();
    (text.get(from + hashes) == Some(&'"')).then_some(())?;
    let is_end = |index: &usize| {
        text[*index] == '"'
            && text[index + 1..].iter().take_while(|&&letter| letter == '#').count() >= hashes
    };
    (from + hashes + 1..text.len()).find(is_end).map(|index| index + 1 + hashes)
}

/// Leaves out each item that `#[cfg(test)]` stands before.
fn without_tests(tokens: Vec<String>) -> Vec<String> {
    const TEST: [&str; 7] = ["#", "[", "cfg", "(", "test", ")", "]"];
    let (mut kept, mut index) = (Vec::new(), 0);
    while index < tokens.len() {
        if tokens[index..].iter().take(TEST.len()).eq(TEST.iter()) {
            index = item_end(&tokens, index + TEST.len());
        } else {
            kept.push(tokens[index].clone());
            index += 1;
        }
    }
    kept
}

/// The end of an item: behind its `;`, or behind the block that closes it.
fn item_end(tokens: &[String], from: usize) -> usize {
    let mut depth = 0;
    for (index, token) in tokens.iter().enumerate().skip(from) {
        match token.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" => depth -= 1,
            "}" if depth == 1 && tokens.get(index + 1).is_none_or(|next| next != ";") => {
                return index + 1;
            }
            "}" => depth -= 1,
            ";" if depth == 0 => return index + 1,
            _ => (),
        }
    }
    tokens.len()
}

#[test]
fn comments_literals_and_tests_are_left_out() {
    let text = "use a::b; // c::d\n/* e /* f */ g */ h(\"i\\\"j\", r#\"k\"l\"#, b\"m\", 'n', '\\'', 'o: p);\n\
                #[cfg(test)]\n#[allow(x)]\nmod tests { use q; fn r() {} }\n#[cfg(test)]\nuse s::{t};\n\
                #[cfg(feature = \"u\")]\nmod v;";
    assert_eq!(
        tokens(text).join(" "),
        "use a :: b ; h ( , , , , , : p ) ; # [ cfg ( feature = ) ] mod v ;"
    );
}
