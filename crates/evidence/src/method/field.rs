//! The standard set of methods.

use super::{
    Bsp, Centroid, Clear, DepthBuffer, DepthFormat, DepthRules, DepthTest, ExactDepth, FrontFaces,
    InputOrder, Interpolation, Method, Nearer, Newell,
};
use binspace::BuildOptions;

/// Options of the methods that [`all`] makes.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// The options of trees. The tolerance here has no effect: the faces' tolerance counts.
    pub build: BuildOptions,
    /// Newell's algorithm, its budgets and its epsilon.
    pub newell: Newell,
    /// The near plane of depth buffers; see [`DepthBuffer::near`].
    pub near: Option<f64>,
    /// The far plane of depth buffers; see [`DepthBuffer::far`].
    pub far: Option<f64>,
}

impl Options {
    /// The defaults.
    pub const DEFAULT: Self =
        Self { build: BuildOptions::DEFAULT, newell: Newell::DEFAULT, near: None, far: None };

    /// Sets the options for trees.
    #[must_use]
    pub fn with_build(self, build: BuildOptions) -> Self {
        Self { build, ..self }
    }

    /// Sets the options of Newell's algorithm.
    #[must_use]
    pub fn with_newell(self, newell: Newell) -> Self {
        Self { newell, ..self }
    }

    /// Sets the near and the far plane of depth buffers, in world units.
    #[must_use]
    pub fn with_range(self, near: f64, far: f64) -> Self {
        Self { near: Some(near), far: Some(far), ..self }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Returns the standard set of methods, the exact tree first and the judge last.
pub fn all(options: &Options) -> Vec<Box<dyn Method>> {
    let build = options.build.clone();
    let mut methods: Vec<Box<dyn Method>> = vec![Box::new(Bsp::exact(build.clone()))];
    for epsilon in [1e-12, 1e-9, 1e-6, 1e-3] {
        methods.push(Box::new(Bsp::double(build.clone(), epsilon)));
    }
    for epsilon in [1e-6, 1e-5, 1e-4, 1e-3] {
        methods.push(Box::new(Bsp::single(build.clone(), epsilon)));
    }
    methods.push(Box::new(InputOrder));
    methods.push(Box::new(FrontFaces(InputOrder)));
    methods.push(Box::new(Centroid));
    methods.push(Box::new(options.newell));
    let buffer =
        |format| DepthBuffer { near: options.near, far: options.far, ..DepthBuffer::new(format) };
    use DepthFormat::{Float, FloatReversed, Integer, LinearFloat, LinearInteger};
    for format in [Integer(16), Integer(24), Float, FloatReversed, LinearInteger(16), LinearFloat] {
        methods.push(Box::new(buffer(format)));
    }
    let walks = Interpolation::ALL.into_iter().filter(|&how| how != Interpolation::EdgeFunctions);
    for how in walks {
        methods.push(Box::new(buffer(Integer(24)).with_interpolation(how)));
    }
    // Buffers with other conventions. In one, the later of equal depths shows. In the other, larger is
    // nearer, and the buffer is cleared to the far plane, so that faces there do not show.
    let rules = DepthRules::DEFAULT;
    let larger = rules.with_nearer(Nearer::Larger).with_test(DepthTest::Greater);
    for rules in [rules.with_test(DepthTest::LessOrEqual), larger.with_clear(Clear::Smallest)] {
        methods.push(Box::new(buffer(Integer(24)).with_rules(rules)));
    }
    methods.push(Box::new(ExactDepth));
    methods
}
