//! Lists that are no larger than they must be.

/// Makes room for more, and for an eighth of the list beyond that: by doubling, as lists grow
/// otherwise, the largest would be made twice as large for a few.
pub(crate) fn reserve<T>(list: &mut Vec<T>, more: usize) {
    if list.capacity() - list.len() < more {
        list.reserve_exact(more + (list.len() / 8).max(64));
    }
}
