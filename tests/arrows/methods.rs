//! Methods that a file adds to types of other files, and calls.

use std::collections::BTreeSet;

/// Methods added to a type.
#[derive(Debug, PartialEq)]
pub(crate) struct Added {
    pub(crate) to: String,
    pub(crate) methods: BTreeSet<String>,
}

/// The methods that types call of their own, but for those that are defined here.
pub(crate) fn own_calls(tokens: &[String]) -> BTreeSet<String> {
    let is_call = |words: &&[String]| {
        matches!([0, 1, 3].map(|at| words[at].as_str()), ["self" | "Self", "." | "::", "("])
    };
    let mut called: BTreeSet<String> =
        tokens.windows(4).filter(is_call).map(|words| words[2].clone()).collect();
    for pair in tokens.windows(2).filter(|pair| pair[0] == "fn") {
        called.remove(&pair[1]);
    }
    called
}

/// The methods in `impl` blocks, those of traits apart, of types that are not defined here.
pub(crate) fn added(tokens: &[String]) -> Vec<Added> {
    let is_defined = |name: &str| {
        let mut pairs = tokens.windows(2);
        pairs.any(|pair| matches!(pair[0].as_str(), "struct" | "enum") && pair[1] == name)
    };
    let mut found = Vec::new();
    for start in (0..tokens.len()).filter(|&index| tokens[index] == "impl") {
        // `-> impl Trait` and `: impl Trait` are no blocks.
        let is_item = start == 0 || matches!(tokens[start - 1].as_str(), "}" | ";" | "]");
        let Some(open) = tokens[start..].iter().position(|token| token == "{") else { continue };
        let open = start + open;
        let head = without_generics(&tokens[start + 1..open]);
        if !is_item || head.contains(&"for") {
            continue;
        }
        let Some(to) = head.last().filter(|name| !is_defined(name)) else { continue };
        let methods = methods(&tokens[open + 1..]);
        found.push(Added { to: (*to).to_owned(), methods });
    }
    found
}

/// The words of a head outside of `<…>`, up to `where`.
fn without_generics(head: &[String]) -> Vec<&str> {
    let (mut depth, mut words) = (0, Vec::new());
    for token in head.iter().map(String::as_str).take_while(|&token| token != "where") {
        match token {
            "<" => depth += 1,
            ">" => depth -= 1,
            word if depth == 0 => words.push(word),
            _ => (),
        }
    }
    words
}

/// The functions of a block, up to its end.
fn methods(body: &[String]) -> BTreeSet<String> {
    let (mut depth, mut found) = (0, BTreeSet::new());
    for pair in body.windows(2) {
        match pair[0].as_str() {
            "{" => depth += 1,
            "}" if depth == 0 => break,
            "}" => depth -= 1,
            "fn" if depth == 0 => drop(found.insert(pair[1].clone())),
            _ => (),
        }
    }
    found
}

#[test]
fn added_methods_and_calls_are_found() {
    let text = "struct Own; impl Own { fn a() {} }\nimpl<K: Kernel> super::Other<'_, K> where K: X { pub fn b() { fn c() {} d(); }\n\
                fn e() -> impl Z { self.f(); g.h(); self.k; self.e(); Self::j() } }\nimpl X for Other { fn i() {} }";
    let tokens = crate::tokens::tokens(text);
    let methods = ["b", "e"].map(String::from).into();
    assert_eq!(added(&tokens), [Added { to: "Other".to_owned(), methods }]);
    let called: Vec<String> = own_calls(&tokens).into_iter().collect();
    assert_eq!(called, ["f", "j"]);
}
