//! Iterators with wrong size hints.

use binspace::Polygon;
use binspace::glam::DVec3;

pub type Hint = (usize, Option<usize>);

/// An iterator with a hint that may be wrong.
#[derive(Clone)]
pub struct Hinted<I> {
    pub items: I,
    pub hint: Hint,
}

impl<I: Iterator> Iterator for Hinted<I> {
    type Item = I::Item;

    fn next(&mut self) -> Option<I::Item> {
        self.items.next()
    }

    fn size_hint(&self) -> Hint {
        self.hint
    }
}

/// A polygon whose corners have such a hint.
impl<I: Iterator<Item = DVec3> + Clone> Polygon for Hinted<I> {
    type Point = DVec3;

    fn corners(&self) -> impl Iterator<Item = DVec3> {
        self.clone()
    }
}
