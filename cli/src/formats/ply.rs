//! PLY files: vertices and polygons as text or binary, with colours in some. Up is z, as in scans.

use binspace::glam::DVec3;
use binspace::scene::Scene;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType,
};

use super::mesh::{Colour, Mesh, Precision, mean};
use super::text::{Line, Lines};

/// Whether a file begins as a PLY file.
pub(crate) fn is_ply(beginning: &[u8]) -> bool {
    beginning.strip_prefix(b"ply").is_some_and(|rest| rest.trim_ascii_start().len() < rest.len())
}

const NO_POSITION: &str = "x, y or z is missing";
const NOT_FINITE: &str = "a coordinate is not a finite number";

/// The known properties of a vertex or a face.
#[derive(Default)]
struct Element {
    position: [Option<Number>; 3],
    /// Red, green, blue, opacity.
    colour: [Option<f32>; 4],
    corners: Option<Vec<f64>>,
}

/// A number, and whether it has 32 bits.
#[derive(Clone, Copy)]
struct Number(f64, bool);

/// The meaning of a value, by the name of the value's property.
enum Place {
    Position(usize),
    Colour(usize),
    Corners,
}

impl Place {
    fn of(property: &str) -> Option<Self> {
        Some(match property {
            "x" => Self::Position(0),
            "y" => Self::Position(1),
            "z" => Self::Position(2),
            "red" | "diffuse_red" => Self::Colour(0),
            "green" | "diffuse_green" => Self::Colour(1),
            "blue" | "diffuse_blue" => Self::Colour(2),
            "alpha" => Self::Colour(3),
            "vertex_indices" | "vertex_index" => Self::Corners,
            _ => return None,
        })
    }
}

/// A binary element; the crate leaves out properties that are not wanted.
impl PropertyAccess for Element {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let Some(place) = Place::of(name) else { return PropertyAccessResult::Ignored };
        fn all<T: Copy + Into<f64>>(list: &[T]) -> Vec<f64> {
            list.iter().map(|&number| number.into()).collect()
        }
        let (number, full) = match &property {
            Property::Char(n) => (Number(f64::from(*n), false), f64::from(i8::MAX)),
            Property::UChar(n) => (Number(f64::from(*n), false), f64::from(u8::MAX)),
            Property::Short(n) => (Number(f64::from(*n), false), f64::from(i16::MAX)),
            Property::UShort(n) => (Number(f64::from(*n), false), f64::from(u16::MAX)),
            Property::Int(n) => (Number(f64::from(*n), false), f64::from(i32::MAX)),
            Property::UInt(n) => (Number(f64::from(*n), false), f64::from(u32::MAX)),
            Property::Float(n) => (Number(f64::from(*n), true), 1.0),
            Property::Double(n) => (Number(*n, false), 1.0),
            list => {
                let Place::Corners = place else { return PropertyAccessResult::UnsupportedType };
                self.corners = Some(match list {
                    Property::ListChar(list) => all(list),
                    Property::ListUChar(list) => all(list),
                    Property::ListShort(list) => all(list),
                    Property::ListUShort(list) => all(list),
                    Property::ListInt(list) => all(list),
                    Property::ListUInt(list) => all(list),
                    Property::ListFloat(list) => all(list),
                    Property::ListDouble(list) => list.clone(),
                    _ => return PropertyAccessResult::UnsupportedType,
                });
                return PropertyAccessResult::Set;
            }
        };
        match place {
            Place::Position(axis) => self.position[axis] = Some(number),
            Place::Colour(channel) => self.colour[channel] = Some((number.0 / full) as f32),
            Place::Corners => return PropertyAccessResult::UnsupportedType,
        }
        PropertyAccessResult::Set
    }
}

impl Element {
    /// An element from a line. The crate would read `float` as 32 bits, and refuses numbers such as `.5`.
    fn of_line(
        line: Line<'_>,
        definition: &ElementDef,
        precision: &mut Precision,
    ) -> Result<Self, String> {
        let mut element = Self::default();
        let mut words = line.words();
        for (name, property) in &definition.properties {
            let missing = || format!("the property `{name}` is missing");
            let word = words.next().ok_or_else(missing)?;
            let bad = |word: &str| format!("`{name}`: {word:.20} is not a finite number");
            let scalar = match &property.data_type {
                PropertyType::Scalar(scalar) => scalar,
                PropertyType::List(..) => {
                    let count: usize = word.parse().map_err(|_| bad(word))?;
                    let mut list = Vec::new();
                    for _ in 0..count {
                        let word = words.next().ok_or_else(missing)?;
                        list.push(word.parse().map_err(|_| bad(word))?);
                    }
                    if let Some(Place::Corners) = Place::of(name) {
                        element.corners = Some(list);
                    }
                    continue;
                }
            };
            match Place::of(name) {
                Some(Place::Position(axis)) => {
                    let value = precision.text(word).ok_or_else(|| bad(word))?;
                    element.position[axis] = Some(Number(value, false));
                }
                Some(Place::Colour(channel)) => {
                    let value: f32 = word.parse().map_err(|_| bad(word))?;
                    let full = match scalar {
                        ScalarType::UChar => 255.0,
                        ScalarType::UShort => 65_535.0,
                        _ => 1.0,
                    };
                    element.colour[channel] = Some(value / full);
                }
                Some(Place::Corners) => return Err(format!("`{name}` is not a list")),
                None => {}
            }
        }
        Ok(element)
    }

    fn colour(&self) -> Option<Colour> {
        let [r, g, b, opacity] = self.colour;
        Some([r?, g?, b?, opacity.unwrap_or(1.0)])
    }
}

/// The fewest bytes of an element. At zero, nothing bounds the number of elements that a file may declare.
fn least_size(definition: &ElementDef, encoding: Encoding) -> usize {
    if encoding == Encoding::Ascii {
        return 2 * definition.properties.len();
    }
    let size = |property: &PropertyType| match property {
        PropertyType::Scalar(scalar) | PropertyType::List(scalar, _) => match scalar {
            ScalarType::Char | ScalarType::UChar => 1,
            ScalarType::Short | ScalarType::UShort => 2,
            ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
            ScalarType::Double => 8,
        },
    };
    definition.properties.values().map(|property| size(&property.data_type)).sum()
}

/// The crate's message for an error, in one short line.
fn short(error: &ParseError) -> String {
    let text = error.to_string();
    text.lines().next().unwrap_or_default().trim_end_matches('.').chars().take(120).collect()
}

/// The content of a file. Faces may stand before the vertices, so their corners are known only at the end.
#[derive(Default)]
struct Contents {
    vertices: Vec<Vertex>,
    /// The corners of all faces.
    corners: Vec<f64>,
    /// For each face, the end of the face's corners, and the face's colour.
    faces: Vec<(usize, Option<Colour>)>,
}

struct Vertex {
    position: DVec3,
    colour: Option<Colour>,
}

impl Contents {
    /// Adds an element. Vertices and faces count.
    fn add(
        &mut self,
        kind: &str,
        element: Element,
        precision: &mut Precision,
    ) -> Result<(), &'static str> {
        let colour = element.colour();
        if kind == "vertex" {
            let mut coordinate = |axis: usize| {
                let Number(value, is_single) = element.position[axis].ok_or(NO_POSITION)?;
                let value = if is_single { precision.single(value as f32) } else { Some(value) };
                value.filter(|value| value.is_finite()).ok_or(NOT_FINITE)
            };
            let position = DVec3::new(coordinate(0)?, coordinate(1)?, coordinate(2)?);
            self.vertices.push(Vertex { position, colour });
        } else if kind == "face" {
            self.add_face(element.corners.ok_or("its list of corners is missing")?, colour);
        } else if kind == "tristrips" {
            // -1 ends a strip.
            let corners = element.corners.ok_or("its list of corners is missing")?;
            for strip in corners.split(|&corner| corner == -1.0) {
                for (number, triangle) in strip.windows(3).enumerate() {
                    let &[a, b, c] = triangle else { continue };
                    // Repeated corners join two strips.
                    if a != b && b != c && c != a {
                        self.add_face(if number % 2 == 0 { [a, b, c] } else { [b, a, c] }, colour);
                    }
                }
            }
        }
        Ok(())
    }

    fn add_face(&mut self, corners: impl IntoIterator<Item = f64>, colour: Option<Colour>) {
        self.corners.extend(corners);
        self.faces.push((self.corners.len(), colour));
    }

    fn into_mesh(self, name: &str) -> Result<Mesh, String> {
        let mut mesh = Mesh::new(name, DVec3::Z);
        let mut start = 0;
        for (number, (end, colour)) in self.faces.into_iter().enumerate() {
            let mut face = Vec::with_capacity(end - start);
            for &corner in &self.corners[start..end] {
                let is_index = corner >= 0.0 && corner.fract() == 0.0;
                let vertex = self.vertices.get(corner as usize).filter(|_| is_index);
                face.push(vertex.ok_or_else(|| {
                    let count = self.vertices.len();
                    format!(
                        "face {number} (from 0): index {corner} is out of range: {count} vertices"
                    )
                })?);
            }
            start = end;
            let colour = colour.or_else(|| mean(face.iter().map(|vertex| vertex.colour)));
            mesh.face(face.iter().map(|vertex| vertex.position), colour);
        }
        Ok(mesh)
    }
}

/// Reads a file.
pub(crate) fn read(name: &str, bytes: &[u8]) -> Result<Scene, String> {
    let parser = Parser::<Element>::new();
    let mut reader = Reader::new(bytes);
    let header = parser.read_header(&mut reader);
    let header = header.map_err(|error| format!("in the header: {}", short(&error)))?;
    let mut rest = reader.into_inner();
    let header_lines =
        bytes[..bytes.len() - rest.len()].iter().filter(|&&byte| byte == b'\n').count();
    let mut lines = Lines::after(header_lines, rest);
    let mut precision = Precision::default();
    let mut contents = Contents::default();
    for definition in header.elements.values() {
        let (kind, count) = (&definition.name, definition.count);
        // A last line may lack its end.
        let fits =
            rest.len().saturating_add(1).checked_div(least_size(definition, header.encoding));
        let fits = fits.unwrap_or(0);
        if count > fits {
            return Err(format!("truncated: {count} of `{kind}` declared, at most {fits} found"));
        }
        for number in 0..count {
            let what = format!("{kind} {number} (from 0)");
            let about = |problem: &str| format!("{what}: {problem}");
            let element = match header.encoding {
                Encoding::Ascii => {
                    let line = lines.next().ok_or_else(|| about("truncated"))?;
                    Element::of_line(line, definition, &mut precision)
                        .map_err(|problem| line.about(&what, &problem))
                }
                Encoding::BinaryBigEndian => parser
                    .read_big_endian_element(&mut rest, definition)
                    .map_err(|error| about(&short(&error))),
                Encoding::BinaryLittleEndian => parser
                    .read_little_endian_element(&mut rest, definition)
                    .map_err(|error| about(&short(&error))),
            };
            contents.add(kind, element?, &mut precision).map_err(about)?;
        }
    }
    if contents.faces.is_empty() {
        let has_points = !contents.vertices.is_empty();
        let problem = if has_points { "no faces: this is a point cloud" } else { "no faces" };
        return Err(problem.to_owned());
    }
    Ok(contents.into_mesh(name)?.finish(precision.unit()))
}
