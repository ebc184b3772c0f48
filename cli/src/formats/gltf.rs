//! glTF 2.0 files: triangles of meshes in a tree of nodes, with base colours. Up is y.

use std::cmp::Ordering;
use std::collections::HashMap;
use std::io;
use std::path::{Component, Path};
use std::rc::Rc;
use std::slice::ChunksExact;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use binspace::glam::{DMat4, DQuat, DVec3, Vec4};
use binspace::internals::open_regular;
use binspace::scene::Scene;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::{Source, View};
use gltf::json::validation::{Checked, Error as Invalid, Validate};
use gltf::material::AlphaMode;
use gltf::mesh::Mode;
use gltf::scene::Transform;
use gltf::{Accessor, Document, Gltf, Material, Primitive, Semantic};

use super::mesh::{Colour, Mesh, Precision, mean};
use crate::failure::Failure;
use crate::memory;
use crate::units::count;

/// The bytes before the chunks of a binary file.
const HEADER: usize = 12;
/// The problem with files of the first version.
const FIRST: &str = "this is glTF 1.0; binspace reads glTF 2.0";
/// The beginnings of the names of extensions that a file may require. These extensions change only looks,
/// except for quantized positions, which are read.
const KNOWN: [&str; 10] = [
    "KHR_mesh_quantization",
    "KHR_materials_",
    "KHR_texture_",
    "KHR_lights_",
    "KHR_animation_",
    "KHR_xmp",
    "EXT_texture_",
    "EXT_lights_",
    "EXT_materials_",
    "MSFT_texture_",
];

/// The extension that places several copies of a node's mesh. Such copies are not read.
const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// Keys of a document. The keys occur in any order, and the value of a key may be long.
const KEYS: [&[u8]; 5] =
    [b"\"asset\"", b"\"buffers\"", b"\"meshes\"", b"\"accessors\"", b"\"scenes\""];

/// Whether a file begins as a glTF file.
pub(crate) fn is_gltf(beginning: &[u8]) -> bool {
    let text = beginning.strip_prefix(b"\xef\xbb\xbf").unwrap_or(beginning).trim_ascii_start();
    let names = |word: &[u8]| text.windows(word.len()).any(|part| part == word);
    beginning.starts_with(b"glTF") || text.starts_with(b"{") && KEYS.into_iter().any(names)
}

/// The scene that was read, and notes on omitted data.
pub(crate) struct Read {
    pub(crate) scene: Scene,
    pub(crate) left_out: Vec<String>,
}

/// Reads a file. Separate files of buffers are in `folder`.
pub(crate) fn read(name: &str, bytes: &[u8], folder: Option<&Path>) -> Result<Read, Failure> {
    let about = |problem: String| Failure::about(name, problem);
    let gltf = parsed(bytes).map_err(about)?;
    let buffers = buffers(name, &gltf, folder)?;
    // As many checks as the buffers have bytes, whatever accessors share.
    let mut checks = buffers.iter().map(|bytes| bytes.len()).sum::<usize>();
    for accessor in gltf.accessors() {
        if let Some(sparse) = Sparse::of(&accessor, &buffers).map_err(about)? {
            let left = checks.checked_sub(sparse.numbers.len());
            checks = left.ok_or_else(|| about("accessors share sparse indices".into()))?;
            sparse.check(&accessor).map_err(about)?;
        }
    }
    let instances = instances(&gltf.document).map_err(about)?;
    let used = &gltf.as_json().extensions_used;
    let has_copies = used.iter().any(|name| name == INSTANCING);
    let mut left_out = LeftOut { has_copies, ..LeftOut::default() };
    // Each once, however often it is placed.
    let mut models: Vec<Option<Model<'_>>> = gltf.meshes().map(|_| None).collect();
    let mut triangles = 0_usize;
    for (node, _) in &instances {
        let Some(mesh) = node.mesh() else { continue };
        let model = match &mut models[mesh.index()] {
            Some(model) => model,
            model => {
                let new = Model::of(&mesh, &buffers, &mut left_out).map_err(about)?;
                model.insert(new)
            }
        };
        triangles = triangles.saturating_add(model.triangles);
        left_out.rest_poses += usize::from(node.skin().is_some());
    }
    // There may be far more triangles than bytes.
    memory::check(name, triangles)?;
    let (mut mesh, mut precision) = (Mesh::new(name, DVec3::Y), Precision::default());
    for (node, matrix) in &instances {
        let model = node.mesh().and_then(|mesh| models[mesh.index()].as_ref());
        for part in model.iter().flat_map(|model| &model.parts) {
            part.add_to(&mut mesh, *matrix, &mut precision).map_err(about)?;
        }
    }
    if triangles == 0 {
        return Err(Failure::about(name, "no triangles in its scene"));
    }
    Ok(Read { scene: mesh.finish(precision.unit()), left_out: left_out.said() })
}

/// The document, in which indices lead somewhere.
fn parsed(bytes: &[u8]) -> Result<Gltf, String> {
    let is_binary = bytes.starts_with(b"glTF");
    // The crate subtracts the length of the header from this.
    let length = bytes.get(8..HEADER).map(|n| u32::from_le_bytes([n[0], n[1], n[2], n[3]]));
    if is_binary && length.is_none_or(|length| (length as usize) < HEADER) {
        return Err("truncated header".into());
    }
    if is_binary && is_first_version(bytes) {
        return Err(FIRST.into());
    }
    if let Some(length) = length.filter(|&length| is_binary && length as usize > bytes.len()) {
        return Err(format!("truncated: {length} bytes declared, {} found", bytes.len()));
    }
    let json = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let gltf = Gltf::from_slice_without_validation(json).map_err(|error| match error {
        _ if is_first_version(bytes) => FIRST.into(),
        gltf::Error::Deserialize(error) => format!("invalid JSON: {error}"),
        error => error.to_string(),
    })?;
    let root = gltf.as_json();
    let is_known = |name: &String| KNOWN.iter().any(|known| name.starts_with(known));
    if let Some(name) = root.extensions_required.iter().find(|name| !is_known(name)) {
        let name: String = name.escape_debug().take(60).collect();
        return Err(format!("it requires the extension {name}, which binspace does not support"));
    }
    // The crate takes for granted that these lead somewhere.
    let positions = Checked::Valid(Semantic::Positions);
    for (number, mesh) in root.meshes.iter().enumerate() {
        let mut accessors = mesh.primitives.iter().filter_map(|p| p.attributes.get(&positions));
        if accessors.any(|accessor| accessor.value() >= root.accessors.len()) {
            return Err(format!(
                "mesh {number} (from 0): the accessor of its positions is missing"
            ));
        }
    }
    let mut invalid = None;
    root.validate(root, gltf::json::Path::new, &mut |path, error| {
        let path = path().to_string();
        // Extensions for looks, and the bounds of positions, are not used.
        let is_unused = match error {
            Invalid::Unsupported => true,
            Invalid::Missing => path.ends_with(".min") || path.ends_with(".max"),
            _ => false,
        };
        if !is_unused && invalid.is_none() {
            invalid = Some(format!("`{path}`: {}", error.to_string().to_lowercase()));
        }
    });
    invalid.map_or(Ok(gltf), Err)
}

/// Whether a file is of the first version, in which lists are objects.
fn is_first_version(bytes: &[u8]) -> bool {
    if let Some(rest) = bytes.strip_prefix(b"glTF") {
        return rest.starts_with(&[1, 0, 0, 0]);
    }
    let json: Option<serde_json::Value> = serde_json::from_slice(bytes).ok();
    json.is_some_and(|json| json["accessors"].is_object())
}

/// The bytes of all buffers.
fn buffers(name: &str, gltf: &Gltf, folder: Option<&Path>) -> Result<Vec<Rc<Vec<u8>>>, Failure> {
    let mut all = Vec::new();
    let mut files: HashMap<&str, Rc<Vec<u8>>> = HashMap::new();
    for buffer in gltf.buffers() {
        let about = |problem: String| {
            Failure::about(name, format!("buffer {} (from 0): {problem}", buffer.index()))
        };
        let bytes = match buffer.source() {
            // Only the first buffer is in a binary file.
            Source::Bin => match &gltf.blob {
                Some(blob) if buffer.index() == 0 => Rc::new(blob.clone()),
                _ => return Err(about("its bytes are missing".into())),
            },
            Source::Uri(uri) => match (uri.strip_prefix("data:"), files.get(uri)) {
                (Some(data), _) => {
                    let text = data.split_once(";base64,").map(|(_, text)| text);
                    let bytes = text.and_then(|text| STANDARD.decode(text).ok());
                    Rc::new(bytes.ok_or_else(|| about("its data are not valid base64".into()))?)
                }
                (_, Some(bytes)) => Rc::clone(bytes),
                _ => {
                    let bytes = beside(uri, folder);
                    let bytes = bytes.map_err(|problem| about(format!("{uri}: {problem}")))?;
                    Rc::clone(files.entry(uri).or_insert(Rc::new(bytes)))
                }
            },
        };
        if bytes.len() < buffer.length() {
            let (says, has) = (buffer.length(), bytes.len());
            return Err(about(format!("truncated: {says} bytes declared, {has} found")));
        }
        all.push(bytes);
    }
    Ok(all)
}

/// A file in a folder or in a subfolder.
fn beside(uri: &str, folder: Option<&Path>) -> Result<Vec<u8>, String> {
    let path = urlencoding::decode(uri).map_err(|error| error.to_string())?;
    let path = Path::new(&*path);
    if !path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Err("not read, because it is outside the file's folder".into());
    }
    let folder = folder.ok_or("standard input has no folder: name the file")?;
    let read = || {
        let mut file = open_regular(&folder.join(path))?;
        let length = usize::try_from(file.metadata()?.len()).unwrap_or(usize::MAX);
        let mut bytes = Vec::new();
        bytes.try_reserve_exact(length).map_err(|_| io::ErrorKind::OutOfMemory)?;
        io::Read::read_to_end(&mut file, &mut bytes)?;
        Ok(bytes)
    };
    read().map_err(|error: io::Error| format!("cannot be read: {error}"))
}

/// The nodes of the scene, with their transforms. A node with several parents is an error: such a node might
/// be its own ancestor.
fn instances(document: &Document) -> Result<Vec<(gltf::Node<'_>, DMat4)>, String> {
    let mut is_child = vec![false; document.nodes().len()];
    document
        .nodes()
        .flat_map(|node| node.children())
        .for_each(|node| is_child[node.index()] = true);
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let roots: Vec<_> = match scene {
        Some(scene) => scene.nodes().collect(),
        None => document.nodes().filter(|node| !is_child[node.index()]).collect(),
    };
    let mut is_placed = vec![false; is_child.len()];
    let (mut placed, mut stack) = (Vec::new(), Vec::new());
    stack.extend(roots.into_iter().rev().map(|node| (node, DMat4::IDENTITY)));
    while let Some((node, parent)) = stack.pop() {
        if std::mem::replace(&mut is_placed[node.index()], true) {
            return Err(format!("node {} (from 0): it occurs twice in the scene", node.index()));
        }
        let matrix = parent * local(&node.transform());
        if !matrix.is_finite() {
            return Err(format!("node {} (from 0): its matrix is not finite", node.index()));
        }
        let first = stack.len();
        stack.extend(node.children().map(|child| (child, matrix)));
        stack[first..].reverse();
        placed.push((node, matrix));
    }
    Ok(placed)
}

fn local(transform: &Transform) -> DMat4 {
    match *transform {
        Transform::Matrix { matrix } => {
            DMat4::from_cols_array_2d(&matrix.map(|c| c.map(f64::from)))
        }
        Transform::Decomposed { translation, rotation, scale } => {
            // Four rounded numbers are not quite of length 1.
            let rotation = DQuat::from_array(rotation.map(f64::from)).normalize();
            let [scale, translation] = [scale, translation].map(|v| DVec3::from(v.map(f64::from)));
            DMat4::from_scale_rotation_translation(scale, rotation, translation)
        }
    }
}

/// The triangles of a mesh.
struct Model<'a> {
    /// The primitives that have triangles.
    parts: Vec<Part<'a>>,
    triangles: usize,
}

impl<'a> Model<'a> {
    fn of(
        mesh: &gltf::Mesh<'_>,
        buffers: &'a [Rc<Vec<u8>>],
        left_out: &mut LeftOut,
    ) -> Result<Self, String> {
        let mut model = Self { parts: Vec::new(), triangles: 0 };
        for primitive in mesh.primitives() {
            let place = format!("mesh {}, primitive {} (from 0)", mesh.index(), primitive.index());
            let part = Part::of(&primitive, buffers, &place);
            let part = part.map_err(|problem| format!("{place}: {problem}"))?;
            left_out.note(&primitive, part.is_none());
            if let Some(part) = part.filter(|part| part.triangles() > 0) {
                model.triangles = model.triangles.saturating_add(part.triangles());
                model.parts.push(part);
            }
        }
        Ok(model)
    }
}

/// The triangles of a primitive.
struct Part<'a> {
    /// The name in messages.
    place: String,
    positions: Values<'a>,
    indices: Option<Values<'a>>,
    colours: Option<Values<'a>>,
    mode: Mode,
    /// Linear red, green and blue, and opacity.
    colour: [f32; 4],
    /// Whether opacities count.
    is_blended: bool,
    has_material: bool,
}

impl<'a> Part<'a> {
    /// `None` if the primitive has points or lines.
    fn of(
        primitive: &Primitive<'_>,
        buffers: &'a [Rc<Vec<u8>>],
        place: &str,
    ) -> Result<Option<Self>, String> {
        let mode = primitive.mode();
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            return Ok(None);
        }
        let positions = primitive.get(&Semantic::Positions).ok_or("it has no positions")?;
        if positions.data_type() == DataType::U32 || positions.dimensions() != Dimensions::Vec3 {
            return Err(
                "its positions are not triples of floats or of integers of 8 or 16 bits".into()
            );
        }
        let values = |accessor: Accessor<'_>, is_share| Values::of(&accessor, is_share, buffers);
        let are_shares = positions.normalized();
        let indices = primitive.indices().map(|indices| {
            let is_whole =
                matches!(indices.data_type(), DataType::U8 | DataType::U16 | DataType::U32);
            if !is_whole || indices.dimensions() != Dimensions::Scalar || indices.normalized() {
                let problem = "its indices are not single unsigned integers of 8, 16 or 32 bits";
                return Err(about_accessor(&indices, problem));
            }
            values(indices, false)
        });
        let indices = indices.transpose()?;
        let colours = primitive.get(&Semantic::Colors(0)).map(|colours| {
            let is_colour = match colours.data_type() {
                DataType::U8 | DataType::U16 => colours.normalized(),
                kind => kind == DataType::F32,
            };
            let dimensions = colours.dimensions();
            if !is_colour || !matches!(dimensions, Dimensions::Vec3 | Dimensions::Vec4) {
                let problem = "its colours are not three or four floats or shares of 8 or 16 bits";
                return Err(about_accessor(&colours, problem));
            }
            values(colours, true)
        });
        let material = primitive.material();
        let mut colour = material.pbr_metallic_roughness().base_color_factor();
        let is_blended = material.alpha_mode() == AlphaMode::Blend;
        colour[3] = opacity(&material, colour[3]);
        Ok(Some(Self {
            place: place.to_owned(),
            positions: values(positions, are_shares)?,
            indices,
            colours: colours.transpose()?,
            mode,
            colour,
            is_blended,
            has_material: material.index().is_some(),
        }))
    }

    fn corners(&self) -> usize {
        self.indices.as_ref().map_or(self.positions.count, |indices| indices.count)
    }

    fn triangles(&self) -> usize {
        match self.mode {
            Mode::Triangles => self.corners() / 3,
            _ => self.corners().saturating_sub(2),
        }
    }

    fn add_to(&self, mesh: &mut Mesh, matrix: DMat4, seen: &mut Precision) -> Result<(), String> {
        // A mirrored triangle has its corners the other way round.
        let is_mirrored = matrix.determinant() < 0.0;
        for number in 0..self.triangles() {
            let mut corners = match self.mode {
                Mode::Triangles => [3 * number, 3 * number + 1, 3 * number + 2],
                Mode::TriangleStrip => [number, number + 1 + number % 2, number + 2 - number % 2],
                _ => [number + 1, number + 2, 0],
            };
            if is_mirrored {
                corners.swap(1, 2);
            }
            let about = |problem| format!("{}, triangle {number}: {problem}", self.place);
            let mut points = [DVec3::ZERO; 3];
            let mut colours = [None; 3];
            for (corner, (point, colour)) in
                corners.into_iter().zip(points.iter_mut().zip(&mut colours))
            {
                let vertex = match &self.indices {
                    Some(indices) => indices.get(corner).map_or(usize::MAX, |n| n[0] as usize),
                    None => corner,
                };
                let position = self.positions.get(vertex).ok_or_else(|| {
                    about(format!(
                        "index {vertex} is out of range: {} vertices",
                        self.positions.count
                    ))
                })?;
                *point = matrix.transform_point3(DVec3::from_slice(&position[..3]));
                if !point.to_array().iter().all(|&c| seen.single(c as f32).is_some()) {
                    return Err(about("a coordinate is not a finite number".into()));
                }
                *colour = self.colours.as_ref().and_then(|colours| colours.get(vertex));
            }
            mesh.face(points, self.face_colour(colours));
        }
        Ok(())
    }

    /// The colour of a face, given the colours of its corners.
    fn face_colour(&self, corners: [Option<[f64; 4]>; 3]) -> Option<Colour> {
        let of_corners = mean(corners.into_iter().map(|c| c.map(|c| c.map(|c| c as f32))));
        if of_corners.is_none() && !self.has_material {
            return None;
        }
        let mut times = of_corners.unwrap_or([1.0; 4]);
        if !self.is_blended {
            times[3] = 1.0;
        }
        let [r, g, b, opacity] = (Vec4::from(self.colour) * Vec4::from(times)).to_array();
        let [r, g, b] = [r, g, b].map(encoded);
        Some([r, g, b, opacity])
    }
}

fn opacity(material: &Material<'_>, opacity: f32) -> f32 {
    match material.alpha_mode() {
        AlphaMode::Opaque => 1.0,
        AlphaMode::Mask => f32::from(opacity >= material.alpha_cutoff().unwrap_or(0.5)),
        AlphaMode::Blend => opacity,
    }
}

/// The sRGB value of an amount of light (IEC 61966-2-1).
fn encoded(light: f32) -> f32 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

/// The values of an accessor, decoded on demand.
struct Values<'a> {
    /// The bytes from the first value on.
    bytes: &'a [u8],
    stride: usize,
    count: usize,
    dimensions: usize,
    data_type: DataType,
    /// The integer that stands for 1.
    full: f64,
    sparse: Option<Sparse<'a>>,
}

/// The values that a sparse accessor replaces. Many primitives may share the accessor, so nothing is copied.
struct Sparse<'a> {
    /// The increasing numbers of the replaced values.
    numbers: ChunksExact<'a, u8>,
    /// The new values.
    values: ChunksExact<'a, u8>,
}

impl<'a> Sparse<'a> {
    fn of(accessor: &Accessor<'_>, buffers: &'a [Rc<Vec<u8>>]) -> Result<Option<Self>, String> {
        let Some(sparse) = accessor.sparse() else { return Ok(None) };
        let (indices, values) = (sparse.indices(), sparse.values());
        let chunks = |view, offset, size: usize| {
            let bytes = within(buffers, view, offset)?.get(..size.checked_mul(sparse.count())?)?;
            Some(bytes.chunks_exact(size))
        };
        let numbers = chunks(indices.view(), indices.offset(), indices.index_type().size());
        let values = chunks(values.view(), values.offset(), accessor.size());
        let problem = "its sparse values do not fit into their buffer";
        let (numbers, values) =
            numbers.zip(values).ok_or_else(|| about_accessor(accessor, problem))?;
        Ok(Some(Self { numbers, values }))
    }

    fn number(bytes: &[u8]) -> usize {
        bytes.iter().rev().fold(0, |n, &byte| n << 8 | usize::from(byte))
    }

    /// Returns an error if the numbers do not increase, or are not below the accessor's count.
    fn check(&self, accessor: &Accessor<'_>) -> Result<(), String> {
        let mut least = 0;
        for number in self.numbers.clone().map(Self::number) {
            if number < least || number >= accessor.count() {
                return Err(about_accessor(
                    accessor,
                    "its sparse indices do not increase, or are out of range",
                ));
            }
            least = number + 1;
        }
        Ok(())
    }

    /// The bytes that replace a value.
    fn get(&self, number: usize) -> Option<&'a [u8]> {
        let (mut low, mut high) = (0, self.numbers.len());
        while low < high {
            let middle = usize::midpoint(low, high);
            match Self::number(self.numbers.clone().nth(middle)?).cmp(&number) {
                Ordering::Less => low = middle + 1,
                Ordering::Greater => high = middle,
                Ordering::Equal => return self.values.clone().nth(middle),
            }
        }
        None
    }
}

/// An error about an accessor.
fn about_accessor(accessor: &Accessor<'_>, problem: &str) -> String {
    format!("accessor {} (from 0): {problem}", accessor.index())
}

/// The bytes of a view, from an offset on.
fn within<'a>(buffers: &'a [Rc<Vec<u8>>], view: View<'_>, offset: usize) -> Option<&'a [u8]> {
    let bytes = buffers[view.buffer().index()].get(view.offset()..)?;
    bytes.get(..view.length())?.get(offset..)
}

impl<'a> Values<'a> {
    /// The values of an accessor. `is_share`: whether integers are shares of the largest integer.
    fn of(
        accessor: &Accessor<'_>,
        is_share: bool,
        buffers: &'a [Rc<Vec<u8>>],
    ) -> Result<Self, String> {
        let view = accessor.view().ok_or_else(|| {
            about_accessor(accessor, "it has no buffer view, which is not supported")
        })?;
        let (count, size) = (accessor.count(), accessor.size());
        let stride = view.stride().unwrap_or(size).max(size);
        let sparse = Sparse::of(accessor, buffers)?;
        let bytes = within(buffers, view, accessor.offset());
        let needed =
            count.checked_sub(1).map(|last| last.saturating_mul(stride).saturating_add(size));
        match bytes {
            Some(bytes) if needed.unwrap_or(0) <= bytes.len() => {
                let data_type = accessor.data_type();
                let dimensions = accessor.dimensions().multiplicity();
                let full = match data_type {
                    _ if !is_share => 1.0,
                    DataType::I8 => 127.0,
                    DataType::U8 => 255.0,
                    DataType::I16 => 32_767.0,
                    DataType::U16 => 65_535.0,
                    DataType::U32 | DataType::F32 => 1.0,
                };
                Ok(Self { bytes, stride, count, dimensions, data_type, full, sparse })
            }
            _ => Err(about_accessor(
                accessor,
                &format!("its {count} values do not fit into its buffer"),
            )),
        }
    }

    /// The first four numbers of a value. Missing numbers are 1, as for opacities.
    fn get(&self, index: usize) -> Option<[f64; 4]> {
        if index >= self.count {
            return None;
        }
        let replaced = self.sparse.as_ref().and_then(|sparse| sparse.get(index));
        let value = replaced.unwrap_or(&self.bytes[index * self.stride..]);
        let mut numbers = [1.0; 4];
        let size = self.data_type.size();
        for (number, bytes) in
            numbers.iter_mut().zip(value.chunks_exact(size)).take(self.dimensions)
        {
            let value = match (self.data_type, bytes) {
                (DataType::F32, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
                (DataType::U32, &[a, b, c, d]) => f64::from(u32::from_le_bytes([a, b, c, d])),
                (DataType::U16, &[a, b]) => f64::from(u16::from_le_bytes([a, b])),
                (DataType::I16, &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
                (DataType::U8, &[a]) => f64::from(a),
                (DataType::I8, &[a]) => f64::from(a as i8),
                _ => return None,
            };
            // The least signed integer stands for -1 too.
            *number = if self.full > 1.0 { (value / self.full).max(-1.0) } else { value };
        }
        Some(numbers)
    }
}

/// The content of a file besides triangles and base colours.
#[derive(Default)]
struct LeftOut {
    without_faces: usize,
    textures: usize,
    rest_poses: usize,
    /// Whether nodes may have copies by an extension.
    has_copies: bool,
}

impl LeftOut {
    fn note(&mut self, primitive: &Primitive<'_>, has_no_faces: bool) {
        let material = primitive.material();
        let texture = material.pbr_metallic_roughness().base_color_texture();
        self.without_faces += usize::from(has_no_faces);
        self.textures += usize::from(texture.is_some());
        self.rest_poses += usize::from(primitive.morph_targets().len() > 0);
    }

    fn said(&self) -> Vec<String> {
        let parts = [
            (self.without_faces, "primitive", " of points or lines skipped"),
            (self.textures, "primitive", " drawn without textures"),
            (self.rest_poses, "instance", " with skins or morph targets drawn at rest"),
        ];
        let found = parts.into_iter().filter(|part| part.0 > 0);
        let found = found.map(|(number, what, how)| format!("{}{how}", count(number, what)));
        let copies = self.has_copies.then(|| format!("copies of meshes by {INSTANCING} skipped"));
        found.chain(copies).collect()
    }
}
