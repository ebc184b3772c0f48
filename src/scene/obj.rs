//! Wavefront OBJ files as scenes.

mod attributes;
mod decimals;
mod error;
pub(crate) mod file;
mod lines;
mod material;
mod report;
mod stream;
mod text;

pub use error::ObjError;
pub use report::ObjReport;
pub use stream::ObjStream;

use super::{Material, Scene};
use error::Kind;
use glam::DVec3;
use lines::Scan;
use material::Look;
use std::collections::HashMap;
use std::path::Path;

impl Scene {
    /// Reads a Wavefront OBJ file and the material libraries it names.
    ///
    /// Polygon `i` of the scene is the `i`-th `f` line of the file, counted from 0, with all its
    /// corners, in whatever object or group it stands. A face of fewer than three different corners
    /// stays in its place and is counted in the report; faces that are given twice, not convex or
    /// not planar stay as they are, for the tree builder to judge. Corners keep their texture
    /// coordinates, their normals, and the colours of their `v` lines ([`uv`](Self::uv),
    /// [`normal`](Self::normal), [`color`](Self::color)). Points, lines and curves are left out,
    /// and so is a weight behind the three coordinates of a `v` line. A line that ends in a
    /// backslash goes on in the next.
    ///
    /// Coordinates are read as `f64`. Four units in the last decimal that they need are the scene's
    /// [`precision`](Self::precision): of the decimals, or of the significant digits of the largest
    /// coordinates, whichever number the file holds fixed. Zeros at the end of all coordinates do not
    /// count (`1.230000` and `4.500000` need two decimals). Of a coordinate with more than 15
    /// significant digits, what is left if it is rounded to 15 counts (`0.30000000000000004` needs
    /// one), and one of less than about 10⁻¹¹ of the largest counts as 0. If no more than one
    /// coordinate in 100 has nine significant digits or more *and* more decimals than all with
    /// fewer digits, only the first three digits of such coordinates count, so that a few computed
    /// numbers do not decide for all. If all coordinates of nine digits and more (but for one in 100)
    /// are numbers of `f32`, as near as they are written, a unit is a step of `f32` of the largest.
    /// Up is y, as OBJ files do not say.
    ///
    /// Colours are the `Kd` of the face's material, taken as sRGB, with its `d` or `Tr` as opacity.
    /// A library that is missing or unreadable is no error; its materials show as
    /// [`Material::DEFAULT`], and the report says so.
    ///
    /// Libraries are read from the file's folder and the folders in it. A name that leads out of
    /// it, because it is absolute or contains `..`, is not followed, and the report lists it.
    /// (Symbolic links are followed: they were put there by whoever owns the folder, not by the
    /// file.) Only regular files are read.
    ///
    /// The file itself may be a device, or a pipe without a name as behind `/dev/stdin`. A named pipe is
    /// refused, since reading one that nobody writes to would wait without an end.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, is not in UTF-8 or an 8-bit superset of ASCII, has no face, has
    /// a coordinate that is malformed or not finite, or a face that names a corner which is not
    /// there, or that has more than 2²² corners. The error names the line and face.
    pub fn read_obj(path: impl AsRef<Path>) -> Result<(Self, ObjReport), ObjError> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let bytes =
            file::read(path).map_err(|error| Kind::Read(error).at(None, None).in_file(&name))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_obj(&name, &bytes, |library| {
            let library = folder.join(library);
            library.is_file().then(|| std::fs::read(library).ok())?
        })
    }

    /// Reads the text of an OBJ file as [`read_obj`](Self::read_obj) does.
    ///
    /// `name` becomes the scene's name and stands in errors. `library` gives the content of a
    /// material library by the name used in the text, or `None`; it is never asked for a name that
    /// is absolute or contains `..`.
    ///
    /// # Errors
    ///
    /// As for [`read_obj`](Self::read_obj), except for reading the file.
    pub fn from_obj(
        name: &str,
        bytes: &[u8],
        library: impl FnMut(&Path) -> Option<Vec<u8>>,
    ) -> Result<(Self, ObjReport), ObjError> {
        let read = || {
            let scan = Scan::new(&text::decode(bytes)?)?;
            let polygons = load(&scan)?;
            Ok((scan, polygons))
        };
        let (mut scan, polygons) = read().map_err(|error: ObjError| error.in_file(name))?;
        let looks = material::load(&scan.libraries, library, &mut scan.report);
        let mut scene = Self::new(name, DVec3::Y);
        add_materials(&mut scene, &scan.materials, &looks, &mut scan.report);
        for (polygon, material) in polygons.iter().zip(&scan.material_of) {
            if is_degenerate(polygon) {
                scan.report.degenerate_faces += 1;
            }
            scene.push(polygon.iter().copied(), *material);
        }
        scene.lines = scan.face_lines;
        scene.precision = 4.0 * scan.decimals.unit();
        (scene.attributes, scan.report.skipped_attributes) = scan.attributes.finish();
        Ok((scene, scan.report))
    }
}

/// Faces as lists of corners, back to back.
struct Polygons {
    corners: Vec<DVec3>,
    sides: Vec<u32>,
}

impl Polygons {
    fn iter(&self) -> impl Iterator<Item = &[DVec3]> {
        let mut rest = &self.corners[..];
        self.sides.iter().map(move |&sides| {
            let (polygon, behind) = rest.split_at(sides as usize);
            rest = behind;
            polygon
        })
    }
}

/// Lets `tobj` read the cleaned text, and checks that it found every face with every corner.
fn load(scan: &Scan) -> Result<Polygons, ObjError> {
    let options = tobj::LoadOptions::default();
    let no_library = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut scan.cleaned.as_bytes(), &options, no_library)
        .map_err(|error| Kind::Reader(error.to_string()).at(None, None))?;
    let mut polygons = Polygons {
        corners: Vec::with_capacity(scan.corners),
        sides: Vec::with_capacity(scan.report.faces),
    };
    for mesh in models.iter().map(|model| &model.mesh) {
        let points: Vec<DVec3> = mesh.positions.chunks_exact(3).map(DVec3::from_slice).collect();
        let corners = mesh.indices.iter().filter_map(|&i| points.get(i as usize));
        polygons.corners.extend(corners);
        if mesh.face_arities.is_empty() {
            // How tobj says "triangles only".
            let triangles = std::iter::repeat_n(3, mesh.indices.len() / 3);
            polygons.sides.extend(triangles);
        } else {
            polygons.sides.extend(&mesh.face_arities);
        }
    }
    let sides: usize = polygons.sides.iter().map(|&sides| sides as usize).sum();
    let faces = polygons.sides.len();
    if faces != scan.report.faces || sides != polygons.corners.len() || sides != scan.corners {
        let expected = scan.report.faces;
        let problem = format!("found {faces} faces where the file has {expected}");
        return Err(Kind::Reader(problem).at(None, None));
    }
    Ok(polygons)
}

fn is_degenerate(polygon: &[DVec3]) -> bool {
    let Some(&first) = polygon.first() else {
        return true;
    };
    match polygon.iter().find(|&&corner| corner != first) {
        None => true,
        Some(second) => polygon.iter().all(|corner| corner == second || *corner == first),
    }
}

/// Adds the materials that faces use, in the order of their numbers.
fn add_materials(
    scene: &mut Scene,
    names: &[Option<String>],
    looks: &HashMap<String, Look>,
    report: &mut ObjReport,
) {
    for name in names {
        let mut material = Material::DEFAULT;
        if let Some(name) = name {
            material.name.clone_from(name);
            match looks.get(name) {
                Some(look) => (material.color, material.opacity) = (look.color, look.opacity),
                None => report.missing_materials.push(name.clone()),
            }
        }
        scene.add_material(material);
    }
}
