//! Generated scenes by name, as arguments of the program.

use super::{
    Scene, chain, city, cornell_box, crossing, layers, newell_bars, random_triangles, sphere,
    teapot, terrain,
};
use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

use crate::error::{Error, Kind};

/// The largest number of polygons of a generated scene: about 2 GB of corners. Too large: memory runs out.
/// Too small: large scenes cannot be generated.
const MOST: u32 = 20_000_000;

/// The generator of a scene. For scenes of several sizes, also the default size and the meaning of a size.
#[derive(Clone, Copy)]
enum Recipe {
    OfOneSize(fn() -> Scene),
    Sized(u32, &'static str, fn(u32) -> Scene),
    Seeded(u32, &'static str, fn(u32, u64) -> Scene),
}

/// Makes the list of generated scenes from a table: the variant, and the scene's name, one-line description
/// and generator.
macro_rules! builtin {
    ($($(#[$doc:meta])* $scene:ident $name:literal $description:literal $recipe:expr;)*) => {
        /// The generated scenes, by name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Builtin {
            $($(#[$doc])* $scene,)*
        }

        impl Builtin {
            /// All generated scenes, in the order in which lists show them.
            pub const ALL: &'static [Self] = &[$(Self::$scene),*];

            fn row(self) -> (&'static str, &'static str, Recipe) {
                use Recipe::*;
                match self {
                    $(Self::$scene => ($name, $description, $recipe),)*
                }
            }
        }
    };
}

builtin! {
    /// [`newell_bars`].
    Newell "newell" "three bars that cover one another in a cycle" OfOneSize(newell_bars);
    /// [`cornell_box`].
    Cornell "cornell" "the Cornell box as measured, open towards the viewer" OfOneSize(cornell_box);
    /// [`teapot`].
    Teapot "teapot" "the Utah teapot from its 32 Bézier patches"
        Sized(8, "quads along a patch side (32·size² polygons)", teapot);
    /// [`crossing`].
    Crossing "crossing" "upright squares that all cross in one line" Sized(2, "squares", crossing);
    /// [`terrain`].
    Terrain "terrain" "a hilly height field of triangles, seeded"
        Seeded(5_000, "triangles, about", terrain);
    /// [`sphere`].
    Sphere "sphere" "a convex sphere of quads, triangles at its poles"
        Sized(2_000, "faces, about", sphere);
    /// [`city`].
    City "city" "houses of random heights on a grid, seeded" Seeded(2_000, "polygons, about", city);
    /// [`random_triangles`].
    Random "random" "triangles anywhere in a cube, crossing each other, seeded"
        Seeded(500, "triangles", random_triangles);
    /// [`chain`].
    Chain "chain" "parallel squares, one behind the other" Sized(1_000, "squares", chain);
    /// [`layers`], 1e-4 apart.
    Layers "layers" "nested squares in layers 1e-4 apart"
        Sized(20, "squares", |size| layers(size, 1e-4));
}

impl Builtin {
    /// Returns the name by which users select the scene.
    pub fn name(self) -> &'static str {
        self.row().0
    }

    /// Returns a one-line description of the scene.
    pub fn description(self) -> &'static str {
        self.row().1
    }

    /// The default size and the meaning of a size.
    fn size(self) -> Option<(u32, &'static str)> {
        match self.row().2 {
            Recipe::OfOneSize(_) => None,
            Recipe::Sized(size, meaning, _) | Recipe::Seeded(size, meaning, _) => {
                Some((size, meaning))
            }
        }
    }

    /// Returns the meaning of the size of [`build`](Self::build), for example `squares`; `None` for scenes
    /// of one size.
    pub fn size_meaning(self) -> Option<&'static str> {
        self.size().map(|(_, meaning)| meaning)
    }

    /// Returns the default size; `None` for scenes of one size.
    pub fn default_size(self) -> Option<u32> {
        self.size().map(|(size, _)| size)
    }

    /// Returns the range of valid sizes, up to about 20 million polygons; `None` for scenes of one size.
    pub fn sizes(self) -> Option<RangeInclusive<u32>> {
        // 32 · 790² = 19 971 200 polygons.
        let sizes = if self == Self::Teapot { 2..=790 } else { 1..=MOST };
        self.size().map(|_| sizes)
    }

    /// Returns whether the scene depends on the `seed` of [`build`](Self::build).
    pub fn is_seeded(self) -> bool {
        matches!(self.row().2, Recipe::Seeded(..))
    }

    /// Reads the name of a scene, with a size, as in `teapot:16`, or without. Without a size, the second
    /// result is `None`.
    ///
    /// ```
    /// use binspace::scene::Builtin;
    ///
    /// let (scene, size) = Builtin::parse("teapot:3")?;
    /// assert_eq!(scene.build(size, 0).len(), 32 * 3 * 3);
    /// assert!(Builtin::parse("teapot:0").is_err());
    /// # Ok::<(), binspace::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// If no scene has the name, or if the scene cannot have the size.
    pub fn parse(text: &str) -> Result<(Self, Option<u32>), Error> {
        let Some((name, digits)) = text.split_once(':') else { return Ok((text.parse()?, None)) };
        let scene: Self = name.parse()?;
        let (Some(sizes), Some(default)) = (scene.sizes(), scene.default_size()) else {
            let problem = format!("the scene {scene} has only one size; write `{scene}`");
            return Err(Kind::Argument(problem).error());
        };
        match digits.parse().ok().filter(|size| sizes.contains(size)) {
            Some(size) => Ok((scene, Some(size))),
            None => {
                let (low, high) = sizes.into_inner();
                let problem = format!(
                    "{digits:?} is not a size of the scene {scene}; give a whole number from {low} to \
                     {high}, such as {scene}:{default}"
                );
                Err(Kind::Argument(problem).error())
            }
        }
    }

    /// Returns the approximate number of polygons of [`build`](Self::build), without generating large scenes.
    pub fn polygons(self, size: Option<u32>) -> usize {
        let of_size = |default| self.clamped(size, default) as usize;
        match (self, self.default_size()) {
            (_, None) => self.build(None, 0).len(),
            (Self::Teapot, Some(default)) => 32 * of_size(default).pow(2),
            (_, Some(default)) => of_size(default),
        }
    }

    fn clamped(self, size: Option<u32>, default: u32) -> u32 {
        let (low, high) = self.sizes().unwrap_or(default..=default).into_inner();
        size.unwrap_or(default).clamp(low, high)
    }

    /// Generates the scene. A size outside the range of [`sizes`](Self::sizes) is clamped to this range;
    /// `None` is the default size. Scenes of only one size ignore `size`. Scenes without randomness ignore
    /// `seed`.
    pub fn build(self, size: Option<u32>, seed: u64) -> Scene {
        let clamp = |default| self.clamped(size, default);
        match self.row().2 {
            Recipe::OfOneSize(make) => make(),
            Recipe::Sized(default, _, make) => make(clamp(default)),
            Recipe::Seeded(default, _, make) => make(clamp(default), seed),
        }
    }
}

impl fmt::Display for Builtin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Builtin {
    type Err = Error;

    /// Reads a bare name; [`Builtin::parse`] reads a name with a size.
    fn from_str(text: &str) -> Result<Self, Error> {
        Self::ALL.iter().copied().find(|scene| scene.name() == text).ok_or_else(|| {
            let names: Vec<_> = Self::ALL.iter().map(|scene| scene.name()).collect();
            let names = names.join(", ");
            Kind::Argument(format!(
                "no built-in scene is called {text:?}; the built-in scenes are {names}"
            ))
            .error()
        })
    }
}
