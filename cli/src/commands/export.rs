//! `binspace export`: the fragments as a file of triangles for other programs.

use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, Read as _, Write};
use std::path::{Path, PathBuf};

use binspace::Viewpoint;
use binspace::glam::DVec3;
use binspace::mesh::Mesh;
use binspace::scene::Scene;
use serde_json::json;

use crate::Outcome;
use crate::args::{ExportArgs, ExportFormat};
use crate::colours::{Colouring, Colours};
use crate::failure::Failure;
use crate::files::{NewFile, Output, STANDARD, behind_links};
use crate::format::format;
use crate::job::{self, Made};
use crate::progress::Progress;
use crate::samples::linear;

/// Runs the command.
pub(crate) fn run(args: &ExportArgs) -> Result<Outcome, Failure> {
    let format = format(&args.output, args.format)?;
    let output = Output::open(&args.output, &args.scene)?;
    // Colours of OBJ files are in a file beside it.
    let library = match format {
        ExportFormat::Obj => library(&args.output)?,
        _ => None,
    };
    let materials = library.as_deref().map(NewFile::create).transpose()?;
    let Made { scene, tree, .. } = job::make(&args.scene, &args.build)?;
    let _progress = Progress::spinner("writing");
    let about = |error| job::about(&scene, &error);
    let mesh = if args.unwelded { tree.mesh() } else { tree.welded_mesh() }.map_err(about)?;
    let mut triangles = mesh.triangles().indices().to_vec();
    if let Some(eye) = args.order {
        let mut order = Vec::new();
        let sorted = mesh.triangles();
        sorted
            .write_back_to_front(&tree, Viewpoint::Eye(eye), &mut order, &mut triangles)
            .map_err(about)?;
    }
    let export = Export { scene: &scene, mesh: &mesh, triangles: &triangles };
    match format {
        ExportFormat::Obj => {
            let library = library.as_deref().and_then(Path::file_name);
            output.write(|out| export.obj(out, library))?;
            materials.map_or(Ok(()), |file| file.write(|out| export.mtl(out)))?;
        }
        ExportFormat::Ply => output.write(|out| export.ply(out))?,
        ExportFormat::Glb => {
            let (json, buffer) = export.glb();
            output.write(|out| write_glb(out, &json, &buffer))?;
        }
    }
    Ok(Outcome::Done)
}

/// The first line of a file of materials: only such a file is replaced.
const MATERIALS: &str = "# Materials of `binspace export`";

/// The file of materials beside an OBJ file; `None` if the output is not a regular file.
fn library(output: &Path) -> Result<Option<PathBuf>, Failure> {
    let is_special = output.metadata().is_ok_and(|data| !data.is_file());
    if output == Path::new(STANDARD) || is_special {
        return Ok(None);
    }
    let target = behind_links(output).map_err(|error| Failure::about(output.display(), error))?;
    let library = target.with_extension("mtl");
    if library == target {
        let problem = "the file of materials gets this name: name the output .obj";
        return Err(Failure::about(output.display(), problem));
    }
    // The OBJ file names it in a line, without quotes.
    let is_plain = library.file_name().and_then(OsStr::to_str).is_some_and(|name| {
        !name.starts_with(char::is_whitespace) && !name.contains(char::is_control)
    });
    if !is_plain {
        let problem = "the file cannot name its file of materials: name the output without control \
                       characters, spaces at the start, and bytes that are not UTF-8";
        return Err(Failure::about(
            format!("{}", output.display().to_string().escape_debug()),
            problem,
        ));
    }
    if library.metadata().is_ok_and(|data| data.is_file()) {
        let mut begin = String::new();
        let file = File::open(&library).map(|file| file.take(MATERIALS.len() as u64));
        // A text that is not UTF-8 is not ours either.
        let _ = file.and_then(|mut file| file.read_to_string(&mut begin));
        if begin != MATERIALS {
            let problem = "`binspace export` did not write this file and does not replace it: give the \
                           .obj another name";
            return Err(Failure::about(library.display(), problem));
        }
    }
    Ok(Some(library))
}

/// The data to write.
struct Export<'a> {
    scene: &'a Scene,
    mesh: &'a Mesh,
    /// The triangles, three vertices each, in the order to write.
    triangles: &'a [u32],
}

impl Export<'_> {
    /// For each triangle: the points of its vertices, and its polygon.
    fn faces(&self) -> impl Iterator<Item = ([u32; 3], usize)> {
        self.triangles.chunks_exact(3).map(|triangle| {
            let vertices = [0, 1, 2].map(|k| self.mesh.vertex(triangle[k]));
            (vertices.map(|vertex| vertex.point), vertices[0].polygon)
        })
    }

    /// The colour of a polygon: red, green and blue in sRGB, and opacity.
    fn colour(&self, polygon: usize) -> [u8; 4] {
        let [r, g, b] = Colours::new(self.scene, Colouring::Material).rgb(polygon);
        let opacity = self.scene.material(polygon).opacity;
        [r, g, b, (opacity * 255.0).round() as u8]
    }

    /// The name of the material of a colour, of letters that every reader of OBJ files takes.
    fn material([r, g, b, opacity]: [u8; 4]) -> String {
        format!("colour_{r:02x}{g:02x}{b:02x}{opacity:02x}")
    }

    fn obj(&self, out: &mut dyn Write, library: Option<&OsStr>) -> io::Result<()> {
        if let Some(library) = library {
            writeln!(out, "mtllib {}", library.to_string_lossy())?;
        }
        for p in self.mesh.positions() {
            writeln!(out, "v {:?} {:?} {:?}", p.x, p.y, p.z)?;
        }
        let (mut group, mut material) = (usize::MAX, None);
        for (points, polygon) in self.faces() {
            let colour = self.colour(polygon);
            if group != polygon {
                writeln!(out, "g polygon_{polygon}")?;
                group = polygon;
            }
            if library.is_some() && material != Some(colour) {
                writeln!(out, "usemtl {}", Self::material(colour))?;
                material = Some(colour);
            }
            let [a, b, c] = points.map(|point| point + 1);
            writeln!(out, "f {a} {b} {c}")?;
        }
        Ok(())
    }

    fn mtl(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut colours: Vec<[u8; 4]> = self.faces().map(|face| self.colour(face.1)).collect();
        colours.sort_unstable();
        colours.dedup();
        writeln!(out, "{MATERIALS}")?;
        for colour in colours {
            let [r, g, b, opacity] = colour.map(|channel| f64::from(channel) / 255.0);
            let name = Self::material(colour);
            writeln!(out, "newmtl {name}\nKd {r:.6} {g:.6} {b:.6}\nd {opacity:.6}")?;
        }
        Ok(())
    }

    fn ply(&self, out: &mut dyn Write) -> io::Result<()> {
        let points = self.mesh.positions();
        write!(
            out,
            "ply\nformat binary_little_endian 1.0\ncomment polygon: the number of the \
             triangle's polygon, from 0\nelement vertex {}\nproperty double x\nproperty double y\n\
             property double z\nelement face {}\nproperty list uchar uint vertex_indices\n\
             property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n\
             property uint polygon\nend_header\n",
            points.len(),
            self.triangles.len() / 3
        )?;
        let mut numbers = points.iter().flat_map(|point| point.to_array());
        numbers.try_for_each(|number| out.write_all(&number.to_le_bytes()))?;
        for (points, polygon) in self.faces() {
            out.write_all(&[3])?;
            points.iter().try_for_each(|point| out.write_all(&point.to_le_bytes()))?;
            out.write_all(&self.colour(polygon))?;
            out.write_all(&(polygon as u32).to_le_bytes())?;
        }
        Ok(())
    }

    /// The JSON and the buffer of a glTF file. Vertices have the colour and the number of their polygon, so
    /// vertices of several polygons coincide.
    fn glb(&self) -> (String, Vec<u8>) {
        let mut buffer = Vec::new();
        let (mut views, mut accessors) = (Vec::new(), Vec::new());
        let mut add = |bytes: Vec<u8>, mut accessor: serde_json::Value| {
            accessor["bufferView"] = views.len().into();
            views.push(json!({"buffer": 0, "byteOffset": buffer.len(), "byteLength": bytes.len()}));
            accessors.push(accessor);
            buffer.extend(bytes);
            accessors.len() - 1
        };
        let little = |numbers: &mut dyn Iterator<Item = f32>| -> Vec<u8> {
            numbers.flat_map(f32::to_le_bytes).collect()
        };
        let count = self.mesh.len();
        let position = |point: DVec3| point.as_vec3();
        let places = || self.mesh.vertices().map(|vertex| position(vertex.position));
        let low = places().reduce(|a, b| a.min(b)).unwrap_or_default().to_array();
        let high = places().reduce(|a, b| a.max(b)).unwrap_or_default().to_array();
        let positions = add(
            little(&mut places().flat_map(|place| place.to_array())),
            json!({"componentType": 5126, "count": count, "type": "VEC3", "min": low, "max": high}),
        );
        let light = |polygon| {
            let [r, g, b, opacity] = self.colour(polygon).map(|channel| f64::from(channel) / 255.0);
            [linear(r) as f32, linear(g) as f32, linear(b) as f32, opacity as f32]
        };
        let colours = add(
            little(&mut self.mesh.vertices().flat_map(|vertex| light(vertex.polygon))),
            json!({"componentType": 5126, "count": count, "type": "VEC4"}),
        );
        // Integers of 32 bits are for indices alone; floats are exact up to 2²⁴.
        let polygons = add(
            little(&mut self.mesh.vertices().map(|vertex| vertex.polygon as f32)),
            json!({"componentType": 5126, "count": count, "type": "SCALAR"}),
        );
        let mut primitives = Vec::new();
        for (material, is_opaque) in [true, false].into_iter().enumerate() {
            let triangles = self.triangles.chunks_exact(3).filter(|triangle| {
                (self.colour(self.mesh.vertex(triangle[0]).polygon)[3] == 255) == is_opaque
            });
            let indices: Vec<u8> =
                triangles.flatten().flat_map(|index| index.to_le_bytes()).collect();
            if !indices.is_empty() {
                let count = indices.len() / 4;
                let indices =
                    add(indices, json!({"componentType": 5125, "count": count, "type": "SCALAR"}));
                primitives.push(json!({
                    "attributes": {"POSITION": positions, "COLOR_0": colours, "_POLYGON": polygons},
                    "indices": indices,
                    "material": material,
                }));
            }
        }
        let look = json!({"metallicFactor": 0});
        let mut json = json!({
            "asset": {"version": "2.0", "generator": "binspace"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": primitives}],
            "materials": [
                {"doubleSided": true, "pbrMetallicRoughness": look},
                {"doubleSided": true, "pbrMetallicRoughness": look, "alphaMode": "BLEND"},
            ],
            "accessors": accessors,
            "bufferViews": views,
            "buffers": [{"byteLength": buffer.len()}],
        });
        // In these files up is y.
        if self.scene.up() == DVec3::Z {
            let half = 0.5_f64.sqrt();
            json["nodes"][0]["rotation"] = json!([-half, 0, 0, half]);
        }
        (json.to_string(), buffer)
    }
}

/// The file around JSON and a buffer.
fn write_glb(out: &mut dyn Write, json: &str, buffer: &[u8]) -> io::Result<()> {
    let mut text = json.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let too_long = |_| io::Error::other("a .glb file has at most 4 GiB: write .ply");
    let length = u32::try_from(28 + text.len() + buffer.len()).map_err(too_long)?;
    out.write_all(b"glTF")?;
    out.write_all(&2u32.to_le_bytes())?;
    out.write_all(&length.to_le_bytes())?;
    for (kind, chunk) in [(b"JSON", &text[..]), (b"BIN\0", buffer)] {
        out.write_all(&(chunk.len() as u32).to_le_bytes())?;
        out.write_all(kind)?;
        out.write_all(chunk)?;
    }
    Ok(())
}
