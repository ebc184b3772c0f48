//! The common arguments of several commands.

use std::ffi::OsString;

use binspace::glam::DVec3;
use binspace::{BuildOptions, Heuristic};
use clap::Args;

use crate::values;

#[derive(Args, Debug)]
pub(crate) struct SceneArgs {
    /// A file (OBJ, STL, PLY, OFF, glTF or of `binspace build`), - for one on standard input, or a built-in
    /// scene such as sphere:100000; for render, order and stats also a folder of `binspace build --cells`
    ///
    /// A name that ends as such files do (.obj, .stl, .bsp …) or contains a path separator is a file. Any
    /// other is a built-in scene, with an optional size after a colon, or, if there is none of that name,
    /// a file. A file's kind is detected from its content.
    /// `binspace scenes` lists the built-in scenes.
    #[arg(value_name = "SCENE")]
    pub(crate) name: OsString,
    /// Seed of built-in scenes that are random, and of random views
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub(crate) seed: u64,
}

#[derive(Args, Debug)]
pub(crate) struct UpArgs {
    /// Direction that points up: x, y, z, or X,Y,Z [default: the scene's up; of files y, but z for
    /// STL, PLY and OFF]
    #[arg(long, value_name = "AXIS", value_parser = values::up, allow_hyphen_values = true)]
    pub(crate) up: Option<DVec3>,
}

#[derive(Args, Debug)]
pub(crate) struct BuildArgs {
    /// How to choose splitters: first, random(SEED), fewest-splits, balanced,
    /// weighted(SPLITS,BALANCE,AXIAL), sampled(K), free-planes or auto [default: auto]
    #[arg(long, value_name = "H")]
    pub(crate) heuristic: Option<Heuristic>,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
}

#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct LimitArgs {
    /// Coplanar tolerance, a length: points this near to a plane count as on it, and layers up to
    /// twice as far apart may be exchanged [default: four units in the last decimal that a file's
    /// coordinates need, or four steps of binary ones, but between 1e-9 and 1e-5 of the extent, the longest side of the scene's
    /// bounding box; at most 1/256 of the extent is used]
    #[arg(long, value_name = "T", value_parser = values::length, allow_hyphen_values = true)]
    pub(crate) tolerance: Option<f64>,
    /// Give up if there are more fragments than this [default: 33554432]
    #[arg(long, value_name = "N")]
    pub(crate) max_fragments: Option<usize>,
}

impl LimitArgs {
    /// The options to build with.
    pub(crate) fn options(self, heuristic: Heuristic) -> BuildOptions {
        let mut options = BuildOptions::DEFAULT.with_heuristic(heuristic);
        if let Some(most) = self.max_fragments {
            options = options.with_max_fragments(most);
        }
        match self.tolerance {
            Some(length) => options.with_tolerance(length),
            None => options,
        }
    }
}
