//! Material libraries of OBJ files.

use super::report::ObjReport;
use super::text::{decode, lines};
use crate::scene::Material;
use std::collections::HashMap;
use std::path::{Component, Path};

/// What a material library says about a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Look {
    pub(super) color: [f32; 3],
    pub(super) opacity: f32,
}

/// The result of looking for a material library.
enum Library {
    Content(Vec<u8>),
    Missing,
    /// The name leads out of the folder of the file that names it.
    Outside,
}

/// Reads all libraries. Where several define a material, the last one counts.
pub(super) fn load(
    libraries: &[String],
    mut read: impl FnMut(&Path) -> Option<Vec<u8>>,
    report: &mut ObjReport,
) -> HashMap<String, Look> {
    let mut looks = HashMap::new();
    let mut find = |name: &str| {
        let name = Path::new(name);
        if !is_inside(name) {
            return Library::Outside;
        }
        read(name).map_or(Library::Missing, Library::Content)
    };
    for library in libraries {
        let (mut missing, mut outside) = (false, false);
        for found in find_all(library, &mut find) {
            match found {
                Library::Content(bytes) => match parse(library, &bytes, report) {
                    Some(found) => looks.extend(found),
                    None => missing = true,
                },
                Library::Missing => missing = true,
                Library::Outside => outside = true,
            }
        }
        if outside {
            report.outside_libraries.push(library.clone());
        } else if missing {
            report.missing_libraries.push(library.clone());
        }
    }
    looks
}

/// The libraries that one `mtllib` line names: the name may hold spaces, or be several names; or
/// have been written on Windows.
fn find_all(name: &str, find: &mut impl FnMut(&str) -> Library) -> Vec<Library> {
    let whole = match find(name) {
        Library::Missing if name.contains('\\') => find(&name.replace('\\', "/")),
        found => found,
    };
    match whole {
        Library::Content(_) => vec![whole],
        _ if name.contains(char::is_whitespace) => name.split_whitespace().map(find).collect(),
        _ => vec![whole],
    }
}

/// Whether a path stays within its folder and those below it, judged by its text alone.
fn is_inside(path: &Path) -> bool {
    path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir))
}

/// The materials of one library; `None` if it is not text.
fn parse(name: &str, bytes: &[u8], report: &mut ObjReport) -> Option<HashMap<String, Look>> {
    let text = decode(bytes).ok()?;
    let (cleaned, names) = clean(name, &text, report);
    let (materials, _) = tobj::load_mtl_buf(&mut cleaned.as_bytes()).ok()?;
    let look = |material: &tobj::Material| Look {
        color: material.diffuse.map_or(Material::DEFAULT.color, |rgb| rgb.map(|c| c as f32)),
        opacity: material.dissolve.map_or(1.0, |opacity| opacity as f32),
    };
    Some(names.into_iter().zip(materials.iter().map(look)).collect())
}

/// Keeps the well-formed `newmtl`, `Kd` and opacity lines. The others must go, because `tobj`
/// rejects a whole library for one bad line, and panics on a `Kd` of one number. Names are replaced
/// by numbers, because `tobj` treats other characters as spaces.
fn clean(library: &str, text: &str, report: &mut ObjReport) -> (String, Vec<String>) {
    let (mut cleaned, mut names) = (String::new(), Vec::new());
    let mut named = false;
    let mut has_dissolve = false;
    for (at, line) in lines(text) {
        let line = line.trim_start();
        let mut words = line.split_whitespace();
        let keyword = words.next().unwrap_or_default();
        let mut is_clamped = false;
        let kept = match keyword {
            "newmtl" => {
                let name = line[keyword.len()..].trim_ascii();
                (named, has_dissolve) = (!name.is_empty(), false);
                named.then(|| {
                    names.push(name.to_owned());
                    format!("newmtl {}\n", names.len())
                })
            }
            "Kd" if named => {
                color(words, &mut is_clamped).map(|[r, g, b]| format!("Kd {r} {g} {b}\n"))
            }
            "d" if named => {
                has_dissolve = true;
                number(words.next(), &mut is_clamped).map(|d| format!("d {d}\n"))
            }
            // Transparency; `d` is the standard one and goes before it.
            "Tr" if named && !has_dissolve => {
                number(words.next(), &mut is_clamped).map(|tr| format!("d {}\n", 1.0 - tr))
            }
            _ => continue,
        };
        match kept {
            Some(kept) => {
                if is_clamped {
                    report.clamped_material_lines.push(format!("{library}:{at}"));
                }
                cleaned.push_str(&kept);
            }
            None => report.skipped_material_lines += 1,
        }
    }
    (cleaned, names)
}

/// Red, green and blue, or one number for all.
fn color<'a>(mut words: impl Iterator<Item = &'a str>, is_clamped: &mut bool) -> Option<[f32; 3]> {
    let mut number = |word| number(word, is_clamped);
    let red = number(words.next())?;
    match words.next().filter(|word| !word.starts_with('#')) {
        None => Some([red; 3]),
        green => Some([red, number(green)?, number(words.next())?]),
    }
}

/// A finite number, brought between 0 and 1; notes if that changed it.
fn number(word: Option<&str>, is_clamped: &mut bool) -> Option<f32> {
    let number: f32 = word?.parse().ok()?;
    let kept = number.is_finite().then(|| number.clamp(0.0, 1.0))?;
    *is_clamped |= kept != number;
    Some(kept)
}
