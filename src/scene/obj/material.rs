//! Material libraries of OBJ files.

use std::collections::HashMap;
use std::path::{Component, Path};

use super::ObjReport;
use super::statements::{Lines, behind_keyword, decode, text, words};
use crate::error::Problem;
use crate::scene::Material;

/// Pairs of a material's name (bytes) and the material, in the order of the library file.
type Materials = Vec<(Vec<u8>, Material)>;

/// The reason why a library is not read. The greater value is the worse fault.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Fault {
    Missing,
    /// The library's name leads out of the folder of the file that names it.
    Outside,
}

/// Reads all libraries. If several libraries define a material, the last definition counts.
pub(super) fn load(
    libraries: &[&[u8]],
    mut read: impl FnMut(&Path) -> Option<Vec<u8>>,
    report: &mut ObjReport,
) -> HashMap<Vec<u8>, Material> {
    let mut known = HashMap::new();
    for library in libraries.iter().filter(|library| !library.is_empty()) {
        let library = &text(library);
        let mut find = |name: &str| {
            let path = Path::new(name);
            let is_inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
            if !path.components().all(is_inside) {
                return Err(Fault::Outside);
            }
            let bytes = read(path).ok_or(Fault::Missing)?;
            parse(library, &bytes, report).map_err(|_| Fault::Missing)
        };
        let mut found = find(library);
        // The name may be a Windows path, or several names.
        if matches!(found, Err(Fault::Missing)) && library.contains('\\') {
            found = find(&library.replace('\\', "/"));
        }
        let found = match found {
            Err(_) if library.contains(char::is_whitespace) => {
                library.split_whitespace().map(find).collect()
            }
            whole => vec![whole],
        };
        match found.iter().filter_map(|found| found.as_ref().err()).max() {
            Some(Fault::Outside) => report.outside_libraries.push(library.to_string()),
            Some(Fault::Missing) => report.missing_libraries.push(library.to_string()),
            None => {}
        }
        known.extend(found.into_iter().flatten().flatten());
    }
    known
}

/// The materials of one library.
fn parse(library: &str, bytes: &[u8], report: &mut ObjReport) -> Result<Materials, Problem> {
    let mut materials = Materials::new();
    let mut has_dissolve = false;
    let mut lines = Lines::new(bytes);
    while let Some(at) = lines.next()? {
        let line = decode(&lines.line)?;
        let mut words = words(&line);
        let mut is_clamped = false;
        let mut number = |word: Option<&str>| {
            let number: f32 = word?.parse().ok()?;
            let kept = number.clamp(0.0, 1.0);
            is_clamped |= kept != number;
            number.is_finite().then_some(kept)
        };
        // Lines after a `newmtl` without a name belong to no material.
        let current = materials.last_mut().filter(|(name, _)| !name.is_empty());
        let understood = match (words.next(), current) {
            (Some("newmtl"), _) => {
                let name = behind_keyword(&lines.line);
                has_dissolve = false;
                let material = Material { name: text(name).into_owned(), ..Material::DEFAULT };
                materials.push((name.to_owned(), material));
                !name.is_empty()
            }
            (Some("Kd"), Some((_, material))) => {
                // Red, green and blue, or one number for all.
                let [red, green, blue] = [words.next(), words.next(), words.next()];
                let color = number(red).and_then(|red| match green {
                    None => Some([red; 3]),
                    green => Some([red, number(green)?, number(blue)?]),
                });
                color.map(|color| material.color = color).is_some()
            }
            (Some("d"), Some((_, material))) => {
                has_dissolve = true;
                number(words.next()).map(|opacity| material.opacity = opacity).is_some()
            }
            // Transparency; the standard `d` has priority.
            (Some("Tr"), Some((_, material))) if !has_dissolve => {
                number(words.next()).map(|tr| material.opacity = 1.0 - tr).is_some()
            }
            (Some("map_Kd" | "map_d"), Some(_)) => {
                report.skipped_textures += 1;
                continue;
            }
            _ => continue,
        };
        report.skipped_material_lines += usize::from(!understood);
        if understood && is_clamped {
            report.clamped_material_lines.push(format!("{library}:{at}"));
        }
    }
    materials.retain(|(name, _)| !name.is_empty());
    Ok(materials)
}
