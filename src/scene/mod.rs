//! Scenes: polygons with flat colours, generated or read from a file.
//!
//! A [`Scene`] is a plain list of polygons, in the order in which they were
//! added, and says nothing about how they are sorted or drawn. Generated scenes
//! have one function each ([`cornell_box`], [`teapot`], …) and are listed by
//! [`Builtin`]; with the feature `obj`, Wavefront OBJ files are read by
//! `Scene::read_obj`.
//!
//! The corners of a polygon run counter-clockwise as seen from its front. The
//! front of a closed body is its outside; that of a room is its inside.
//! Every generated scene is the same, bit for bit, on every machine: generators
//! use `+ − × ÷` and `sqrt` alone, which IEEE 754 defines to the last bit.

mod builtin;
mod chain;
mod city;
mod cornell;
mod crossing;
pub(crate) mod cuboid;
mod layers;
mod material;
mod newell;
#[cfg(feature = "obj")]
mod obj;
mod random;
mod sphere;
mod teapot;
mod terrain;
pub(crate) mod turn;

pub use builtin::{Builtin, BuiltinError, BuiltinSpec};
pub use chain::chain;
pub use city::city;
pub use cornell::cornell_box;
pub use crossing::crossing;
pub use layers::layers;
pub use material::Material;
pub use newell::newell_bars;
#[cfg(feature = "obj")]
pub use obj::{ObjError, ObjReport};
pub use random::random_triangles;
pub use sphere::sphere;
pub use teapot::teapot;
pub use terrain::terrain;

use glam::DVec3;

/// Polygons with colours.
///
/// Polygons are numbered from 0 in the order in which they were pushed. A scene
/// accepts everything: the tree builder decides about polygons of fewer than three corners, without
/// area or with non-finite coordinates.
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
/// Two scenes are equal if they hold the same, even if it is from different lines of a file.
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
    up: DVec3,
    view: Option<(DVec3, DVec3)>,
}

impl PartialEq for Scene {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
            && (self.up, self.view) == (other.up, other.view)
            && self.corners == other.corners
            && self.ends == other.ends
            && self.material_of == other.material_of
            && self.materials == other.materials
    }
}

impl Scene {
    /// A scene without polygons or materials, in which `up` points upwards.
    pub fn new(name: impl Into<String>, up: DVec3) -> Self {
        Self {
            name: name.into(),
            corners: Vec::new(),
            ends: Vec::new(),
            material_of: Vec::new(),
            lines: Vec::new(),
            materials: Vec::new(),
            up,
            view: None,
        }
    }

    /// Adds a material and returns its number for [`push`](Self::push).
    pub fn add_material(&mut self, material: Material) -> u32 {
        self.materials.push(material);
        (self.materials.len() - 1) as u32
    }

    /// Adds a polygon. A `material` that was never added shows as
    /// [`Material::DEFAULT`].
    pub fn push(&mut self, polygon: impl IntoIterator<Item = DVec3>, material: u32) {
        self.corners.extend(polygon);
        self.ends.push(self.corners.len());
        self.material_of.push(material);
    }

    /// Sets the view that [`suggested_view`](Self::suggested_view) returns.
    #[must_use]
    pub fn with_view(mut self, eye: DVec3, target: DVec3) -> Self {
        self.view = Some((eye, target));
        self
    }

    /// The name given at the start; for a file its path.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// How many polygons there are, degenerate ones included.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is no polygon.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The corners of one polygon.
    ///
    /// # Panics
    ///
    /// If `index` is not less than [`len`](Self::len).
    pub fn polygon(&self, index: usize) -> &[DVec3] {
        let start = index.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.corners[start..self.ends[index]]
    }

    /// The corners of every polygon, in order.
    pub fn polygons(&self) -> impl ExactSizeIterator<Item = &[DVec3]> + Clone {
        (0..self.len()).map(|index| self.polygon(index))
    }

    /// The material of one polygon.
    ///
    /// # Panics
    ///
    /// If `index` is not less than [`len`](Self::len).
    pub fn material(&self, index: usize) -> &Material {
        static UNKNOWN: Material = Material::DEFAULT;
        let number = self.material_of[index] as usize;
        self.materials.get(number).unwrap_or(&UNKNOWN)
    }

    /// The line of the file that a polygon is from, counted from 1; `None` in generated scenes.
    pub fn line(&self, index: usize) -> Option<usize> {
        self.lines.get(index).copied()
    }

    /// All materials, in the order in which they were added.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The direction that points upwards, of length 1 in generated scenes.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// The least and the greatest corner of the bounding box of all polygons; `None` without
    /// corners. O(n) in the corners.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let (&first, rest) = self.corners.split_first()?;
        Some(rest.iter().fold((first, first), |(low, high), &p| (low.min(p), high.max(p))))
    }

    /// An eye point and a point to look at, for scenes that have a usual or only possible view,
    /// such as the Cornell box through its open side.
    pub fn suggested_view(&self) -> Option<(DVec3, DVec3)> {
        self.view
    }
}
