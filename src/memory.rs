//! Grows long lists with little spare capacity, and returns an error if memory runs out. Empties hash tables
//! quickly.

use std::collections::HashMap;

use crate::Error;

/// Makes room for `more` items, plus an eighth of the list. (`Vec` itself doubles its capacity, which would
/// leave the largest lists half empty.)
///
/// # Errors
///
/// If there is not enough memory.
#[inline]
pub(crate) fn reserve<T>(list: &mut Vec<T>, more: usize) -> Result<(), Error> {
    if list.capacity() - list.len() >= more { Ok(()) } else { grow(list, more) }
}

/// Adds an item to a list.
///
/// # Errors
///
/// If there is not enough memory.
#[inline]
pub(crate) fn push<T>(list: &mut Vec<T>, item: T) -> Result<(), Error> {
    reserve(list, 1)?;
    list.push(item);
    Ok(())
}

/// Converts the length of a list to the place of its next item.
///
/// # Errors
///
/// If the length is more than `u32::MAX`: such a length counts as out of memory.
pub(crate) fn place(len: usize) -> Result<u32, Error> {
    u32::try_from(len).map_err(|_| Error::out_of_memory())
}

/// Collects all items into a list.
///
/// # Errors
///
/// If there is not enough memory.
pub(crate) fn collect<T>(items: impl ExactSizeIterator<Item = T>) -> Result<Vec<T>, Error> {
    let mut list = Vec::new();
    list.try_reserve_exact(items.len()).map_err(|_| Error::out_of_memory())?;
    list.extend(items);
    Ok(list)
}

/// A table with more capacity than this for each of its entries is freed rather than emptied. Too small:
/// sets of similar sizes allocate repeatedly. Too large: emptying takes time for unused capacity.
const ROOM: usize = 8;
/// A table with no more capacity than this is kept.
const SMALL: usize = 64;

/// Empties a table in time proportional to its entries. (`HashMap::clear` takes time proportional to the
/// table's capacity. After one large set of entries, `clear` would be slow for every later set.)
pub(crate) fn empty<K, V>(table: &mut HashMap<K, V>) {
    if table.capacity() > SMALL.max(ROOM * table.len()) {
        *table = HashMap::new();
    } else {
        table.clear();
    }
}

#[cold]
fn grow<T>(list: &mut Vec<T>, more: usize) -> Result<(), Error> {
    let spare = (list.len() / 8).max(64);
    list.try_reserve_exact(more.saturating_add(spare)).map_err(|_| Error::out_of_memory())
}

#[cfg(test)]
mod tests {
    use super::{HashMap, ROOM, SMALL, empty, reserve};

    #[test]
    fn lack_of_memory_is_an_error() {
        let mut list = vec![0u64; 3];
        for more in [usize::MAX, usize::MAX / 8, 1 << 58] {
            assert!(
                reserve(&mut list, more)
                    .is_err_and(|error| error.kind() == crate::ErrorKind::OutOfMemory)
            );
        }
        reserve(&mut list, 1000).expect("8 kB");
        assert!((1003..2000).contains(&list.capacity()));
        assert_eq!(list, [0; 3]);
    }

    /// Sets of every size, and a set that is far larger than all others.
    #[test]
    fn a_table_is_emptied_in_time_proportional_to_its_entries() {
        let mut table = HashMap::new();
        for len in [3, 100_000, 0, 5, 1000, 1000, 40, 900, 100_000, 1, 1] {
            table.extend((0..len).map(|k| (k, ())));
            let room = table.capacity();
            empty(&mut table);
            assert!(table.is_empty());
            let visited = if table.capacity() == room { room } else { len };
            assert!(visited <= SMALL.max(ROOM * len), "{visited} places for {len} entries");
        }
        // A table whose capacity is used is kept.
        table.extend((0..1000).map(|k| (k, ())));
        let room = table.capacity();
        empty(&mut table);
        assert_eq!(table.capacity(), room);
    }
}
