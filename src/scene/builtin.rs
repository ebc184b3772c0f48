//! Generated scenes by name, as the program takes them.

use super::{
    Scene, chain, city, cornell_box, crossing, layers, newell_bars, random_triangles, sphere,
    teapot, terrain,
};
use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// The largest number of polygons of a generated scene: about 2 GB of corners.
const MOST: u32 = 20_000_000;

/// The distance between neighbouring layers in the built-in scene `layers`, whose side is 2.
const LAYER_GAP: f64 = 1e-4;

/// The generated scenes, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Builtin {
    /// [`newell_bars`].
    Newell,
    /// [`cornell_box`].
    Cornell,
    /// [`teapot`].
    Teapot,
    /// [`crossing`].
    Crossing,
    /// [`terrain`].
    Terrain,
    /// [`sphere`].
    Sphere,
    /// [`city`].
    City,
    /// [`random_triangles`].
    Random,
    /// [`chain`].
    Chain,
    /// [`layers`], 1e-4 apart.
    Layers,
}

impl Builtin {
    /// Every scene, in the order in which to list them.
    pub const ALL: &'static [Self] = &[
        Self::Newell,
        Self::Cornell,
        Self::Teapot,
        Self::Crossing,
        Self::Terrain,
        Self::Sphere,
        Self::City,
        Self::Random,
        Self::Chain,
        Self::Layers,
    ];

    /// The name by which a user asks for the scene.
    pub fn name(self) -> &'static str {
        match self {
            Self::Newell => "newell",
            Self::Cornell => "cornell",
            Self::Teapot => "teapot",
            Self::Crossing => "crossing",
            Self::Terrain => "terrain",
            Self::Sphere => "sphere",
            Self::City => "city",
            Self::Random => "random",
            Self::Chain => "chain",
            Self::Layers => "layers",
        }
    }

    /// One line on what the scene shows.
    pub fn description(self) -> &'static str {
        match self {
            Self::Newell => "three bars that cover one another in a cycle",
            Self::Cornell => "the Cornell box as measured, open towards the viewer",
            Self::Teapot => "the Utah teapot from its 32 Bézier patches",
            Self::Crossing => "upright squares that all cross in one line",
            Self::Terrain => "a hilly height field of triangles, seeded",
            Self::Sphere => "a convex sphere of quads, triangles at its poles",
            Self::City => "houses of random heights on a grid, seeded",
            Self::Random => "triangles anywhere in a cube, crossing each other, seeded",
            Self::Chain => "parallel squares, one behind the other",
            Self::Layers => "nested squares in layers 1e-4 apart",
        }
    }

    /// What the size counts; `None` for scenes of one size.
    pub fn size_meaning(self) -> Option<&'static str> {
        match self {
            Self::Newell | Self::Cornell => None,
            Self::Teapot => Some("quads along a patch side (32·size² polygons)"),
            Self::Crossing | Self::Chain | Self::Layers => Some("squares"),
            Self::Terrain => Some("triangles, about"),
            Self::Sphere => Some("faces, about"),
            Self::City => Some("polygons, about"),
            Self::Random => Some("triangles"),
        }
    }

    /// The default size; `None` for scenes of one size.
    pub fn default_size(self) -> Option<u32> {
        match self {
            Self::Newell | Self::Cornell => None,
            Self::Teapot => Some(8),
            Self::Crossing => Some(2),
            Self::Terrain => Some(5_000),
            Self::Sphere => Some(2_000),
            Self::City => Some(2_000),
            Self::Random => Some(500),
            Self::Chain => Some(1_000),
            Self::Layers => Some(20),
        }
    }

    /// The range of valid sizes; `None` for scenes of one size. At most about 20 million polygons.
    pub fn sizes(self) -> Option<RangeInclusive<u32>> {
        match self {
            Self::Newell | Self::Cornell => None,
            // 32 · 790² = 19 971 200 polygons.
            Self::Teapot => Some(2..=790),
            _ => Some(1..=MOST),
        }
    }

    /// Whether the seed matters.
    pub fn is_seeded(self) -> bool {
        matches!(self, Self::Terrain | Self::City | Self::Random)
    }

    /// Generates the scene. A size outside [`sizes`](Self::sizes) is clamped to it. Scenes of one
    /// size ignore the size, and unseeded scenes the seed.
    pub fn build(self, size: Option<u32>, seed: u64) -> Scene {
        let size = match (self.sizes(), size.or(self.default_size())) {
            (Some(sizes), Some(size)) => size.clamp(*sizes.start(), *sizes.end()),
            _ => 1,
        };
        match self {
            Self::Newell => newell_bars(),
            Self::Cornell => cornell_box(),
            Self::Teapot => teapot(size),
            Self::Crossing => crossing(size),
            Self::Terrain => terrain(size, seed),
            Self::Sphere => sphere(size),
            Self::City => city(size, seed),
            Self::Random => random_triangles(size, seed),
            Self::Chain => chain(size),
            Self::Layers => layers(size, LAYER_GAP),
        }
    }
}

impl fmt::Display for Builtin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Builtin {
    type Err = BuiltinError;

    /// Reads a bare name; [`BuiltinSpec`] reads a name with a size.
    fn from_str(text: &str) -> Result<Self, BuiltinError> {
        Self::ALL
            .iter()
            .copied()
            .find(|scene| scene.name() == text)
            .ok_or_else(|| BuiltinError(Kind::Name(text.to_owned())))
    }
}

/// A generated scene with the size asked for, such as `teapot:16`.
///
/// ```
/// use binspace::scene::BuiltinSpec;
///
/// let spec: BuiltinSpec = "teapot:3".parse()?;
/// assert_eq!(spec.build(0).len(), 32 * 3 * 3);
/// assert!("teapot:0".parse::<BuiltinSpec>().is_err());
/// # Ok::<(), binspace::scene::BuiltinError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BuiltinSpec {
    scene: Builtin,
    size: Option<u32>,
}

impl BuiltinSpec {
    /// The scene without its size.
    pub fn scene(self) -> Builtin {
        self.scene
    }

    /// The size asked for, or the default; `None` for scenes of one size.
    pub fn size(self) -> Option<u32> {
        self.size.or(self.scene.default_size())
    }

    /// About how many polygons the scene has, without generating it if it is large.
    pub fn polygons(self) -> usize {
        match (self.scene, self.size()) {
            (_, None) => self.build(0).len(),
            (Builtin::Teapot, Some(size)) => 32 * (size as usize).pow(2),
            (_, Some(size)) => size as usize,
        }
    }

    /// Generates the scene.
    pub fn build(self, seed: u64) -> Scene {
        self.scene.build(self.size, seed)
    }
}

impl From<Builtin> for BuiltinSpec {
    fn from(scene: Builtin) -> Self {
        Self { scene, size: None }
    }
}

impl fmt::Display for BuiltinSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.size {
            Some(size) => f.pad(&format!("{}:{size}", self.scene)),
            None => f.pad(self.scene.name()),
        }
    }
}

impl FromStr for BuiltinSpec {
    type Err = BuiltinError;

    /// Reads `name` or `name:size`.
    fn from_str(text: &str) -> Result<Self, BuiltinError> {
        let Some((name, digits)) = text.split_once(':') else {
            return text.parse().map(|scene: Builtin| scene.into());
        };
        let scene: Builtin = name.parse()?;
        let Some(sizes) = scene.sizes() else {
            return Err(BuiltinError(Kind::OneSize(scene)));
        };
        match digits.parse() {
            Ok(size) if sizes.contains(&size) => Ok(Self { scene, size: Some(size) }),
            _ => Err(BuiltinError(Kind::Size(scene, digits.to_owned()))),
        }
    }
}

/// Why a text names no generated scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BuiltinError(Kind);

#[derive(Clone, Debug, PartialEq, Eq)]
enum Kind {
    Name(String),
    OneSize(Builtin),
    Size(Builtin, String),
}

impl fmt::Display for BuiltinError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Kind::Name(name) => {
                let names =
                    Builtin::ALL.iter().map(|scene| scene.name()).collect::<Vec<_>>().join(", ");
                write!(f, "no built-in scene is called {name:?}; there are {names}")
            }
            Kind::OneSize(scene) => {
                write!(f, "the scene {scene} has one size; ask for it as `{scene}`")
            }
            Kind::Size(scene, digits) => {
                let (low, high) = scene.sizes().unwrap_or(1..=1).into_inner();
                write!(
                    f,
                    "{digits:?} is not a size of the scene {scene}; give a whole number from {low} \
                     to {high}, such as {scene}:{}",
                    scene.default_size().unwrap_or(low)
                )
            }
        }
    }
}

impl std::error::Error for BuiltinError {}
