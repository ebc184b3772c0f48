//! What reading an OBJ file has found.

use std::fmt;

/// What was read from an OBJ file, and what was left out.
///
/// As text it is a short sentence about everything left out, or empty.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ObjReport {
    /// The `f` lines, degenerate ones included: the polygons of the scene.
    pub faces: usize,
    /// Faces with fewer than three different corner positions. They stay in the scene, so that
    /// polygon numbers are those of the file.
    pub degenerate_faces: usize,
    /// `p` lines.
    pub skipped_points: usize,
    /// `l` lines.
    pub skipped_lines: usize,
    /// `vt` and `vn` lines that are malformed, and references of corners to such lines that are
    /// malformed or name none. Those corners are without that attribute.
    pub skipped_attributes: usize,
    /// Lines that begin with any other word that is not understood, such as the statements for
    /// free-form curves and surfaces.
    pub skipped_statements: usize,
    /// Material libraries that could not be read, by the name in the file.
    pub missing_libraries: Vec<String>,
    /// Material libraries that were not read, because their names lead out of the file's folder:
    /// they are absolute or contain `..`.
    pub outside_libraries: Vec<String>,
    /// Materials that are used but not defined.
    pub missing_materials: Vec<String>,
    /// `newmtl`, `Kd`, `d` and `Tr` lines in material libraries that are malformed or of an
    /// unsupported kind, such as spectral curves.
    pub skipped_material_lines: usize,
    /// `Kd`, `d` and `Tr` lines in material libraries with a number below 0 or above 1, which was taken as 0
    /// or 1: the library and the line, as in `parts.mtl:7`.
    pub clamped_material_lines: Vec<String>,
}

impl ObjReport {
    /// Whether nothing was left out or changed.
    pub fn is_clean(&self) -> bool {
        *self == Self { faces: self.faces, ..Self::default() }
    }
}

impl fmt::Display for ObjReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = [
            (self.degenerate_faces, "faces with fewer than three different corners"),
            (self.skipped_points, "`p` lines skipped"),
            (self.skipped_lines, "`l` lines skipped"),
            (self.skipped_attributes, "texture coordinates and normals skipped"),
            (self.skipped_statements, "unknown statements skipped"),
            (self.skipped_material_lines, "material properties skipped"),
        ];
        let lists = [
            (&self.missing_libraries, "material libraries not found"),
            (&self.outside_libraries, "material libraries outside the file's folder, not read"),
            (&self.missing_materials, "materials not defined"),
            (&self.clamped_material_lines, "colours and opacities taken as 0 or 1"),
        ];
        let counted = counts
            .into_iter()
            .filter(|&(count, _)| count > 0)
            .map(|(count, what)| format!("{what}: {count}"));
        let listed = lists
            .into_iter()
            .filter(|(names, _)| !names.is_empty())
            .map(|(names, what)| format!("{what}: {}", some(names)));
        f.write_str(&counted.chain(listed).collect::<Vec<_>>().join("; "))
    }
}

/// The first three names and how many more there are.
fn some(names: &[String]) -> String {
    let shown = names[..names.len().min(3)].join(", ");
    match names.len().saturating_sub(3) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_was_left_out_is_said() {
        let mut report = ObjReport { faces: 7, ..ObjReport::default() };
        assert!(report.is_clean());
        assert_eq!(report.to_string(), "");
        report.skipped_points = 2;
        report.missing_materials = ["a", "b", "c", "d"].map(str::to_owned).to_vec();
        assert!(!report.is_clean());
        let expected = "`p` lines skipped: 2; materials not defined: a, b, c and 1 more";
        assert_eq!(report.to_string(), expected);
    }
}
