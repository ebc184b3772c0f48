//! Properties that count their comparisons, so that a test can demand a minimum.

use proptest::prelude::*;
use proptest::test_runner::{TestCaseError, TestRunner};
use std::cell::RefCell;

/// Holds a property against this many cases, and gives back what they counted. What fails is kept
/// beside the source file, as by `proptest!`.
pub(crate) fn tally<S: Strategy, T: Default>(
    source: &'static str,
    cases: u32,
    strategy: S,
    property: impl Fn(&mut T, S::Value) -> Result<(), TestCaseError>,
) -> T {
    let mut config = ProptestConfig::with_cases(cases);
    config.source_file = Some(source);
    let total = RefCell::new(T::default());
    let result =
        TestRunner::new(config).run(&strategy, |value| property(&mut total.borrow_mut(), value));
    if let Err(error) = result {
        panic!("{error}");
    }
    total.into_inner()
}
