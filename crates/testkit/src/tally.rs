//! Properties that count what they compare, and floors under such counts.

use super::effort::cases;
use proptest::prelude::*;
use proptest::test_runner::{TestCaseError, TestRunner};
use std::cell::RefCell;

/// Holds a property against this many cases, times the effort, and gives back what they counted.
pub fn tally<S: Strategy, T: Default>(
    source: &'static str,
    count: usize,
    strategy: S,
    property: impl Fn(&mut T, S::Value) -> Result<(), TestCaseError>,
) -> T {
    let total = RefCell::new(T::default());
    let result = TestRunner::new(cases(count, source))
        .run(&strategy, |value| property(&mut total.borrow_mut(), value));
    if let Err(error) = result {
        panic!("{error}");
    }
    total.into_inner()
}

/// Asserts that enough was compared: counts above floors. Panics with each that falls short.
#[macro_export]
macro_rules! enough {
    ($($count:expr => $floor:expr),+ $(,)?) => {
        $crate::tally::assert_above(&[$((stringify!($count), $count as f64, $floor as f64)),+])
    };
}

/// Panics unless each count is above its floor.
#[track_caller]
pub fn assert_above(counts: &[(&str, f64, f64)]) {
    let short = |(name, count, floor): &(&str, f64, f64)| {
        (count <= floor).then(|| format!("{name} is {count}, not above {floor}"))
    };
    let short: Vec<String> = counts.iter().filter_map(short).collect();
    assert!(short.is_empty(), "too little was compared: {}", short.join("; "));
}
