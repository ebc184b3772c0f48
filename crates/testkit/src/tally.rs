//! Properties that count their comparisons, and lower bounds on such counts.

use super::effort::cases;
use proptest::prelude::*;
use proptest::test_runner::{TestCaseError, TestRunner};
use std::cell::RefCell;

/// Checks a property for this many cases, times the effort, and returns its counts.
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

/// Returns a failing case, for any reason.
pub fn fail(why: impl ToString) -> TestCaseError {
    TestCaseError::fail(why.to_string())
}

/// Asserts that enough was compared. Panics with the conditions that fail, and with the message.
#[macro_export]
macro_rules! enough {
    ($($enough:expr),+; $($what:tt)+) => {{
        let floors = [$((stringify!($enough), $enough)),+];
        let short = floors.into_iter().filter(|(_, is_enough)| !is_enough).map(|(floor, _)| floor);
        let short: Vec<&str> = short.collect();
        assert!(
            short.is_empty(),
            "too little was compared, not {}: {}",
            short.join(", nor "),
            format_args!($($what)+)
        );
    }};
}
