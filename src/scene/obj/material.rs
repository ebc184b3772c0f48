use super::report::ObjReport;
use super::text::{decode, lines};
use crate::scene::Material;
use std::collections::HashMap;
use std::path::Path;

/// What a material library says about a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Look {
    pub(super) color: [f32; 3],
    pub(super) opacity: f32,
}

/// Reads all libraries. Where several define a material, the last one counts.
pub(super) fn load(
    libraries: &[String],
    mut read: impl FnMut(&Path) -> Option<Vec<u8>>,
    report: &mut ObjReport,
) -> HashMap<String, Look> {
    let mut looks = HashMap::new();
    for library in libraries {
        // A name may hold spaces, or be several names; or have been written on
        // Windows.
        let slashed = library.replace('\\', "/");
        let whole = read(Path::new(library)).or_else(|| read(Path::new(&slashed)));
        let contents: Vec<Option<Vec<u8>>> = match whole {
            None if library.contains(char::is_whitespace) => {
                library.split_whitespace().map(|name| read(Path::new(name))).collect()
            }
            whole => vec![whole],
        };
        let mut missing = false;
        for content in contents {
            match content.as_deref().map(|bytes| parse(bytes, report)) {
                Some(Some(found)) => looks.extend(found),
                _ => missing = true,
            }
        }
        if missing {
            report.missing_libraries.push(library.clone());
        }
    }
    looks
}

/// The materials of one library; `None` if it is no text.
fn parse(bytes: &[u8], report: &mut ObjReport) -> Option<HashMap<String, Look>> {
    let text = decode(bytes).ok()?;
    let (cleaned, names) = clean(&text, report);
    let (materials, _) = tobj::load_mtl_buf(&mut cleaned.as_bytes()).ok()?;
    let look = |material: &tobj::Material| Look {
        color: material.diffuse.map_or(Material::DEFAULT.color, |rgb| rgb.map(narrow)),
        opacity: material.dissolve.map_or(1.0, narrow),
    };
    Some(names.into_iter().zip(materials.iter().map(look)).collect())
}

/// Keeps `newmtl`, `Kd` and opacity where they are well-formed: `tobj` gives the
/// whole library up for one bad line, and panics on a `Kd` of one number. Names
/// come apart: `tobj` gets their numbers, as it has its own idea of what a space is.
fn clean(text: &str, report: &mut ObjReport) -> (String, Vec<String>) {
    let (mut cleaned, mut names) = (String::new(), Vec::new());
    let mut named = false;
    let mut has_dissolve = false;
    for (_, line) in lines(text) {
        let line = line.trim_start();
        let mut words = line.split_whitespace();
        let keyword = words.next().unwrap_or_default();
        let kept = match keyword {
            "newmtl" => {
                let name = line[keyword.len()..].trim_ascii();
                (named, has_dissolve) = (!name.is_empty(), false);
                named.then(|| {
                    names.push(name.to_owned());
                    format!("newmtl {}\n", names.len())
                })
            }
            "Kd" if named => color(words).map(|[r, g, b]| format!("Kd {r} {g} {b}\n")),
            "d" if named => {
                has_dissolve = true;
                number(words.next()).map(|d| format!("d {d}\n"))
            }
            // Transparency; `d` is the standard one and goes before it.
            "Tr" if named && !has_dissolve => {
                number(words.next()).map(|tr| format!("d {}\n", 1.0 - tr))
            }
            _ => continue,
        };
        match kept {
            Some(kept) => cleaned.push_str(&kept),
            None => report.skipped_material_lines += 1,
        }
    }
    (cleaned, names)
}

/// Red, green and blue, or one number for all.
fn color<'a>(mut words: impl Iterator<Item = &'a str>) -> Option<[f32; 3]> {
    let red = number(words.next())?;
    match words.next().filter(|word| !word.starts_with('#')) {
        None => Some([red; 3]),
        green => Some([red, number(green)?, number(words.next())?]),
    }
}

/// A finite number, brought between 0 and 1.
fn number(word: Option<&str>) -> Option<f32> {
    let number: f32 = word?.parse().ok()?;
    number.is_finite().then(|| number.clamp(0.0, 1.0))
}

/// Generic because tobj's number type is `f32` or `f64` by its features.
fn narrow<T: Into<f64>>(number: T) -> f32 {
    number.into() as f32
}
