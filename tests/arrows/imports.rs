//! What a file imports, as it writes it.

use std::collections::BTreeSet;

use crate::methods::{Added, added, own_calls};
use crate::tokens::tokens;

/// A path as it is written, and the module that it is written in, below the file's own.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Named {
    pub(crate) path: Vec<String>,
    /// Modules with a body around it.
    pub(crate) within: Vec<String>,
}

/// One name of a `use`.
#[derive(Clone, Debug)]
pub(crate) struct Use {
    pub(crate) named: Named,
    /// What the file calls it; `*` for all of a module.
    pub(crate) name: String,
    pub(crate) is_public: bool,
}

/// What a file says of other files.
#[derive(Debug, Default)]
pub(crate) struct Imports {
    pub(crate) uses: Vec<Use>,
    /// Paths, and words alone, outside of `use`.
    pub(crate) paths: Vec<Named>,
    /// The modules that it declares in files of their own.
    pub(crate) modules: Vec<String>,
    /// Methods that it adds to types of other files.
    pub(crate) added: Vec<Added>,
    /// Names of the methods that its types call of their own.
    pub(crate) own_calls: BTreeSet<String>,
}

pub(crate) fn imports(text: &str) -> Imports {
    let tokens = tokens(text);
    let token = |index: usize| tokens.get(index).map_or("", String::as_str);
    let mut imports =
        Imports { added: added(&tokens), own_calls: own_calls(&tokens), ..Imports::default() };
    // The modules with a body that are open, each with the depth of braces outside.
    let (mut open, mut depth): (Vec<(String, usize)>, usize) = (Vec::new(), 0);
    let (mut index, mut is_public) = (0, false);
    while index < tokens.len() {
        let within = || open.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
        match token(index) {
            "pub" => {
                is_public = true;
                index += 1;
                if token(index) == "("
                    && matches!(token(index + 1), "crate" | "super" | "self" | "in")
                {
                    while token(index) != ")" {
                        index += 1;
                    }
                    index += 1;
                }
                continue;
            }
            "use" if depth == 0 || token(index + 1) != "<" => {
                let mut end = index + 1;
                let mut found = Vec::new();
                use_tree(&tokens, &mut end, &[], &mut found);
                let named =
                    |(path, name)| Use { named: Named { path, within: within() }, name, is_public };
                imports.uses.extend(found.into_iter().map(named));
                index = end;
            }
            "mod" if token(index + 2) == ";" => {
                imports.modules.push(token(index + 1).to_owned());
                index += 2;
            }
            "mod" if token(index + 2) == "{" => {
                open.push((token(index + 1).to_owned(), depth));
                index += 2;
                continue;
            }
            "{" => depth += 1,
            "}" => {
                depth -= 1;
                if open.last().is_some_and(|(_, outside)| *outside == depth) {
                    open.pop();
                }
            }
            word if word.chars().all(|c| c.is_alphanumeric() || c == '_') => {
                let mut path = vec![word.to_owned()];
                let before = if index == 0 { "" } else { token(index - 1) };
                while token(index + 1) == "::"
                    && token(index + 2).starts_with(|c: char| c.is_alphabetic() || c == '_')
                {
                    path.push(token(index + 2).to_owned());
                    index += 2;
                }
                // A method or a field, a macro's own crate, or the rest of a path after `<…>`.
                if !matches!(before, "." | "$" | "::") {
                    imports.paths.push(Named { path, within: within() });
                }
            }
            _ => (),
        }
        is_public = false;
        index += 1;
    }
    imports
}

/// Reads a tree of `use` up to the sign after it.
fn use_tree(
    tokens: &[String],
    index: &mut usize,
    before: &[String],
    found: &mut Vec<(Vec<String>, String)>,
) {
    let mut path = before.to_vec();
    loop {
        let token = tokens[*index].as_str();
        *index += 1;
        match token {
            "::" => continue,
            "{" => {
                while tokens[*index] != "}" {
                    use_tree(tokens, index, &path, found);
                    *index += usize::from(tokens[*index] == ",");
                }
                *index += 1;
                return;
            }
            "*" => return found.push((path, "*".to_owned())),
            // The module itself.
            "self" if !path.is_empty() => (),
            word => path.push(word.to_owned()),
        }
        match tokens[*index].as_str() {
            "::" => (),
            "as" => {
                found.push((path, tokens[*index + 1].clone()));
                *index += 2;
                return;
            }
            _ => {
                let name = path.last().cloned().unwrap_or_default();
                return found.push((path, name));
            }
        }
    }
}

#[test]
fn imports_are_found_however_they_are_written() {
    let text = "use crate::exact::{Faces, Lattice as L, plane::{self, cross}};\npub use a::*;\n\
                pub(crate) mod b;\npub(in crate::tree) fn f() -> super::super::Error { g.h::<u8>(); $crate::i() }\n\
                mod j { pub(super) use super::k; }\nuse l;";
    let found = imports(text);
    let uses = |public: bool| -> Vec<String> {
        let uses = found.uses.iter().filter(|found| found.is_public == public);
        uses.map(|found| format!("{} {}", found.named.path.join("::"), found.name)).collect()
    };
    let private =
        ["crate::exact::Faces Faces", "crate::exact::Lattice L", "crate::exact::plane plane"];
    assert_eq!(uses(false)[..3], private);
    assert_eq!(uses(false)[3..], ["crate::exact::plane::cross cross", "l l"]);
    assert_eq!(uses(true), ["a *", "super::k k"]);
    assert_eq!(found.uses[5].named.within, ["j"]);
    assert_eq!(found.modules, ["b"]);
    let paths: Vec<String> = found.paths.iter().map(|named| named.path.join("::")).collect();
    assert_eq!(paths, ["fn", "f", "super::super::Error", "g", "u8"]);
}
