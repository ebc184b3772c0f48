//! Lines along which polygons may go through one another.

use super::feet::Feet;
use super::half::Half;
use super::lines::Lines;
use super::table::{Table, insert};
use crate::Error;

/// Lines of which all that are the same have one number.
#[derive(Default)]
pub(super) struct CutLines {
    feet: Feet,
    /// The first of each half's line, if it is one of these, and whether both are positive on the same side.
    known: Table<u64, Option<(u32, bool)>>,
}

impl CutLines {
    /// Adds the line of a half. All have to be added before any is looked up.
    pub(super) fn add(&mut self, lines: &Lines<'_>, half: Half, line: u32) -> Result<(), Error> {
        if self.known.contains_key(&half.line()) {
            return Ok(());
        }
        let found = lines.same_line(&self.feet, half);
        if found.is_none() {
            self.feet.add(&lines.foot(half), line)?;
        }
        insert(&mut self.known, half.line(), Some(found.unwrap_or((line, true))))
    }

    /// That of these lines which is the line of a half.
    pub(super) fn of(
        &mut self,
        lines: &Lines<'_>,
        half: Half,
    ) -> Result<Option<(u32, bool)>, Error> {
        if let Some(&found) = self.known.get(&half.line()) {
            return Ok(found);
        }
        let found = lines.same_line(&self.feet, half);
        insert(&mut self.known, half.line(), found)?;
        Ok(found)
    }
}
