//! Scenes: polygons with flat colours, generated or read from a file.
//!
//! A [`Scene`] is a plain list of polygons, in the order in which the polygons were added. Each generated
//! scene has a function ([`cornell_box`], [`teapot`], …), and [`Builtin`] lists all generated scenes. With
//! the feature `obj`, `Scene::read_obj` reads Wavefront OBJ files.
//!
//! The corners of a polygon are counter-clockwise seen from its front. Fronts face outwards on a closed body,
//! and inwards in a room. Every generated scene is bit for bit the same on every machine: generators use only
//! `+ − × ÷` and `sqrt`, which IEEE 754 defines to the last bit.

mod builtin;
mod cornell;
pub(crate) mod generated;
#[cfg(feature = "obj")]
pub(crate) mod obj;
#[cfg(feature = "save")]
mod saved;
mod teapot;

pub use builtin::Builtin;
pub use cornell::cornell_box;
pub use generated::{
    chain, city, crossing, layers, newell_bars, random_triangles, sphere, terrain,
};
#[cfg(feature = "obj")]
pub use obj::{ObjReport, ObjStream};
pub use teapot::teapot;

use glam::{DVec2, DVec3};

use crate::Polygon;

/// Polygons with colours.
///
/// Polygons are numbered from 0, in the order in which they were added. A scene accepts every polygon. A
/// [tree](crate::BspTree#contents) of the scene drops polygons without area. Infinite coordinates and NaN
/// are an error only when a tree is built.
///
/// ```
/// use binspace::glam::DVec3;
/// use binspace::scene::{Material, Scene};
///
/// let mut scene = Scene::new("one triangle", DVec3::Z);
/// let red = scene.add_material(Material::new("red", [0.8, 0.1, 0.1]));
/// scene.push([DVec3::ZERO, DVec3::X, DVec3::Y], red);
/// assert_eq!(scene.len(), 1);
/// assert_eq!(scene.polygon(0)[1], DVec3::X);
/// assert_eq!(scene.material(0).name, "red");
/// ```
///
/// Two scenes are equal if their contents are equal, even if the polygons come from different lines of a
/// file.
#[derive(Clone, Debug)]
pub struct Scene {
    name: String,
    corners: Vec<DVec3>,
    /// Polygon `i` owns the corners `ends[i - 1]..ends[i]`.
    ends: Vec<usize>,
    material_of: Vec<u32>,
    /// The line of each polygon; empty unless the scene is from a file.
    lines: Vec<usize>,
    materials: Vec<Material>,
    attributes: Attributes,
    precision: f64,
    up: DVec3,
    view: Option<(DVec3, DVec3)>,
}

/// Attributes of corners that a file contains besides positions. A list is empty if the file has no attribute
/// of that kind; otherwise it has an entry for each corner that was read.
#[derive(Clone, Debug, Default, PartialEq)]
struct Attributes {
    uvs: Vec<Option<DVec2>>,
    normals: Vec<Option<DVec3>>,
    colors: Vec<Option<[f32; 3]>>,
}

/// A polygon of a [`Scene`]: the corners and their precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScenePolygon<'a> {
    corners: &'a [DVec3],
    precision: f64,
}

impl<'a> ScenePolygon<'a> {
    /// Returns the corners, counter-clockwise seen from the front.
    pub fn points(&self) -> &'a [DVec3] {
        self.corners
    }
}

impl<'a> IntoIterator for ScenePolygon<'a> {
    type Item = &'a DVec3;
    type IntoIter = std::slice::Iter<'a, DVec3>;

    fn into_iter(self) -> Self::IntoIter {
        self.corners.iter()
    }
}

impl Polygon for ScenePolygon<'_> {
    type Point = DVec3;

    fn corners(&self) -> impl Iterator<Item = DVec3> {
        self.corners.iter().copied()
    }

    fn precision(&self) -> f64 {
        self.precision
    }
}

impl PartialEq for Scene {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
            && (self.up, self.view) == (other.up, other.view)
            && self.corners == other.corners
            && self.ends == other.ends
            && self.material_of == other.material_of
            && self.materials == other.materials
            && self.attributes == other.attributes
            && self.precision == other.precision
    }
}

impl Scene {
    /// Creates a scene without polygons or materials, in which `up` points upwards.
    pub fn new(name: impl Into<String>, up: DVec3) -> Self {
        Self {
            name: name.into(),
            corners: Vec::new(),
            ends: Vec::new(),
            material_of: Vec::new(),
            lines: Vec::new(),
            materials: Vec::new(),
            attributes: Attributes::default(),
            precision: 0.0,
            up,
            view: None,
        }
    }

    /// Adds a material and returns its number for [`push`](Self::push).
    pub fn add_material(&mut self, material: Material) -> u32 {
        self.materials.push(material);
        (self.materials.len() - 1) as u32
    }

    /// Adds a polygon. A `material` that was never added appears as [`Material::DEFAULT`].
    pub fn push(&mut self, polygon: impl IntoIterator<Item = DVec3>, material: u32) {
        // One by one, because a wrong size hint must not allocate memory.
        polygon.into_iter().for_each(|corner| self.corners.push(corner));
        self.ends.push(self.corners.len());
        self.material_of.push(material);
    }

    /// Adds a quad, or a triangle if neighbouring corners coincide.
    fn push_quad(&mut self, corners: [DVec3; 4], material: u32) {
        let mut corners = corners.to_vec();
        corners.dedup();
        self.push(corners, material);
    }

    /// Sets the view that [`suggested_view`](Self::suggested_view) returns.
    #[must_use]
    pub fn with_view(mut self, eye: DVec3, target: DVec3) -> Self {
        self.view = Some((eye, target));
        self
    }

    /// Sets the length that [`precision`](Self::precision) returns, of 0 or more.
    #[must_use]
    pub fn with_precision(self, precision: f64) -> Self {
        Self { precision, ..self }
    }

    /// Changes the name.
    #[must_use]
    pub fn with_name(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }

    /// Returns the name of the scene; for a file its path.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the number of polygons, including degenerate polygons.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Returns whether there are no polygons.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Returns the corners of a polygon.
    ///
    /// # Panics
    ///
    /// If `index` is not less than [`len`](Self::len).
    pub fn polygon(&self, index: usize) -> &[DVec3] {
        let start = index.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.corners[start..self.ends[index]]
    }

    /// Returns the polygons, in order. Pass the iterator to a build, such as
    /// [`BspTree::build`](crate::BspTree::build). Each polygon consists of its corners and the scene's
    /// [`precision`](Self::precision).
    pub fn polygons(&self) -> impl ExactSizeIterator<Item = ScenePolygon<'_>> + Clone {
        let polygon =
            |index| ScenePolygon { corners: self.polygon(index), precision: self.precision };
        (0..self.len()).map(polygon)
    }

    /// Returns the precision of the coordinates: the largest distance of a corner from the plane in which it
    /// was meant to lie. The [default tolerance](crate::BspTree#which-tolerance) of a tree depends on this
    /// distance.
    ///
    /// For a scene from an OBJ file, the precision is four units in the last decimal that the coordinates
    /// need. (Suppose that rounding moves the corners of a parallelogram by half a unit along each axis.
    /// Then one corner may be three and a half units off the plane of the three others.) In generated scenes
    /// the precision is 0. [`with_precision`](Self::with_precision) changes the precision.
    pub fn precision(&self) -> f64 {
        self.precision
    }

    /// Returns the texture coordinates of a polygon's corner; `None` if the scene's file gives no texture
    /// coordinates for this corner.
    ///
    /// # Panics
    ///
    /// If the polygon or corner does not exist.
    pub fn uv(&self, polygon: usize, corner: usize) -> Option<DVec2> {
        self.attribute(&self.attributes.uvs, polygon, corner)
    }

    /// Returns the normal at a polygon's corner, as in the scene's file; its length may differ from 1.
    /// Returns `None` if the file gives no normal for this corner.
    ///
    /// # Panics
    ///
    /// If the polygon or corner does not exist.
    pub fn normal(&self, polygon: usize, corner: usize) -> Option<DVec3> {
        self.attribute(&self.attributes.normals, polygon, corner)
    }

    /// Returns the colour of a polygon's corner: red, green and blue as in the scene's file, usually from 0
    /// to 1. Returns `None` if the file gives no colour for this corner.
    ///
    /// # Panics
    ///
    /// If the polygon or corner does not exist.
    pub fn color(&self, polygon: usize, corner: usize) -> Option<[f32; 3]> {
        self.attribute(&self.attributes.colors, polygon, corner)
    }

    fn attribute<T: Copy>(&self, of: &[Option<T>], polygon: usize, corner: usize) -> Option<T> {
        let corners = self.polygon(polygon).len();
        assert!(corner < corners, "corner {corner} of a polygon of {corners} corners");
        let start = polygon.checked_sub(1).map_or(0, |before| self.ends[before]);
        of.get(start + corner).copied().flatten()
    }

    /// Returns the material of a polygon.
    ///
    /// # Panics
    ///
    /// If `index` is not less than [`len`](Self::len).
    pub fn material(&self, index: usize) -> &Material {
        static UNKNOWN: Material = Material::DEFAULT;
        let number = self.material_of[index] as usize;
        self.materials.get(number).unwrap_or(&UNKNOWN)
    }

    /// Returns the line of the file from which a polygon was read, counted from 1; `None` in generated
    /// scenes.
    pub fn line(&self, index: usize) -> Option<usize> {
        self.lines.get(index).copied()
    }

    /// Returns all materials, in the order in which they were added.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// Returns the direction that points upwards, of length 1 in generated scenes.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// Returns the least and the greatest corner of the bounding box of all polygons; `None` without corners.
    /// O(n) for n corners.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let (&first, rest) = self.corners.split_first()?;
        Some(rest.iter().fold((first, first), |(low, high), &p| (low.min(p), high.max(p))))
    }

    /// Returns an eye point and a target to look at, if the scene has a usual view. For example, the Cornell
    /// box is seen through its open side.
    pub fn suggested_view(&self) -> Option<(DVec3, DVec3)> {
        self.view
    }
}

/// A flat colour. There is no lighting.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Material {
    /// A name for people; it need not be unique.
    pub name: String,
    /// Red, green and blue from 0 to 1, sRGB-encoded: the value to display, unchanged.
    pub color: [f32; 3],
    /// The opacity, from 0, invisible, to 1, opaque.
    pub opacity: f32,
}

impl Material {
    /// Light grey, opaque, without a name: for polygons without a material.
    pub const DEFAULT: Self = Self { name: String::new(), color: [0.8; 3], opacity: 1.0 };

    /// Creates an opaque material.
    pub fn new(name: impl Into<String>, color: [f32; 3]) -> Self {
        Self { name: name.into(), color, opacity: 1.0 }
    }

    /// Sets the opacity, from 0, invisible, to 1, opaque.
    #[must_use]
    pub fn with_opacity(self, opacity: f32) -> Self {
        Self { opacity, ..self }
    }

    /// Returns eight materials, with colours that colour-blind people can distinguish (Okabe and Ito, "Color
    /// Universal Design", 2008). Grey replaces the black of this palette.
    pub fn palette() -> impl Iterator<Item = Self> {
        const PALETTE: [(&str, [u8; 3]); 8] = [
            ("orange", [230, 159, 0]),
            ("sky blue", [86, 180, 233]),
            ("bluish green", [0, 158, 115]),
            ("yellow", [240, 228, 66]),
            ("blue", [0, 114, 178]),
            ("vermilion", [213, 94, 0]),
            ("reddish purple", [204, 121, 167]),
            ("grey", [153, 153, 153]),
        ];
        PALETTE.iter().map(|&(name, rgb)| Self::new(name, rgb.map(|byte| f32::from(byte) / 255.0)))
    }
}
