//! Checks the fragments of a file.
//!
//! A vertex of a cut fragment is named by two lines. It need not be where the fragment's edges
//! meet by name: a plane that passes exactly through a vertex makes no new one. So it is checked that
//! it *is* there, exactly.

use crate::exact::lattice::MAX_CORNER;
use crate::exact::{Faces, Line, PlaneId, PreparedPlane, StoredVertex, SymbolKind, Vertex};
use crate::parallel_map;
use crate::save::{LoadError, invalid};
use crate::tree::parts::{Parts, Record};

/// How many fragments one thread checks at a time.
const OUTLINES_A_THREAD: usize = 4096;

/// An error unless each face has fragments, which are all of it or have outlines. If `keep`, writes
/// down where their vertices are.
pub(super) fn check(faces: &Faces, parts: &mut Parts, keep: bool) -> Result<(), LoadError> {
    check_numbers(faces, parts)?;
    let Parts { records, vertices, positions, .. } = parts;
    let ranges = (0..records.len()).step_by(OUTLINES_A_THREAD);
    let ranges = ranges.map(|start| start..records.len().min(start + OUTLINES_A_THREAD)).collect();
    let checked = parallel_map::map(ranges, |range: std::ops::Range<usize>| {
        let mut outline = Outline { faces, vertices: Vec::new() };
        let mut places = Vec::new();
        for fragment in range {
            let stored = stored(records, vertices, fragment);
            if stored.is_empty() {
                continue;
            }
            let face = records[fragment].face;
            let fault = |fault| invalid("fragment", fragment, fault);
            outline.check(face, stored).map_err(fault)?;
            if keep {
                places.extend(outline.vertices.iter().map(Vertex::position));
            }
        }
        Ok(places)
    })?;
    if keep {
        let room = positions.try_reserve_exact(vertices.len());
        room.map_err(|_| LoadError::out_of_memory())?;
    }
    checked.into_iter().for_each(|places| positions.extend(places));
    Ok(())
}

/// The vertices of a fragment.
fn stored<'a>(
    records: &[Record],
    vertices: &'a [StoredVertex],
    fragment: usize,
) -> &'a [StoredVertex] {
    let end = records.get(fragment + 1).map_or(vertices.len(), |next| next.vertices as usize);
    &vertices[records[fragment].vertices as usize..end]
}

/// Every face has one fragment that is whole, or several that are not.
fn check_numbers(faces: &Faces, parts: &Parts) -> Result<(), LoadError> {
    const NONE: u8 = 0;
    const WHOLE: u8 = 1;
    const FIRST: u8 = 2;
    const MORE: u8 = 3;
    let mut found = Vec::new();
    found.try_reserve_exact(faces.len()).map_err(|_| LoadError::out_of_memory())?;
    found.resize(faces.len(), NONE);
    for (fragment, record) in parts.records.iter().enumerate() {
        let fault = |fault| invalid("fragment", fragment, fault);
        let is_whole = stored(&parts.records, &parts.vertices, fragment).is_empty();
        let found = found.get_mut(record.face as usize);
        let found = found.ok_or_else(|| fault("is of a face that does not exist"))?;
        *found = match (*found, is_whole) {
            (NONE, true) => WHOLE,
            (NONE, false) => FIRST,
            (FIRST | MORE, false) => MORE,
            _ => return Err(fault("is of a face that is there uncut")),
        };
    }
    // One fragment may be all of a face that is in a cell.
    let is_of_cell = faces.corners_of_cell() > 0;
    let is_part = |&found: &u8| found != WHOLE && found != MORE && !(is_of_cell && found == FIRST);
    match found.iter().position(is_part) {
        Some(face) => Err(invalid("face", face, "has only some of its fragments, or none")),
        None => Ok(()),
    }
}

/// The outline of a cut fragment.
struct Outline<'a> {
    faces: &'a Faces,
    vertices: Vec<Vertex>,
}

impl Outline<'_> {
    fn check(&mut self, face: u32, stored: &[StoredVertex]) -> Result<(), &'static str> {
        self.check_names(face, stored)?;
        let faces = self.faces;
        self.vertices.clear();
        self.vertices.extend(stored.iter().map(|stored| stored.restored(faces, face)));
        // Where lines are parallel, this is infinite or no number.
        let is_point = |vertex: &Vertex| vertex.position().iter().all(|c| c.abs() <= MAX_CORNER);
        if !self.vertices.iter().all(is_point) {
            return Err("has a vertex outside the grid");
        }
        (0..stored.len()).try_for_each(|edge| match stored_line(stored, edge).as_cut() {
            Some(plane) => self.check_cut(face, edge, plane),
            None => self.check_edge(face, edge),
        })
    }

    fn check_names(&self, face: u32, stored: &[StoredVertex]) -> Result<(), &'static str> {
        let (known, edges) = (self.faces.known(), self.faces.corners(face).len() as u32);
        let is_known = |stored: &StoredVertex| {
            stored.symbol().is_known(known, edges) && stored.line().is_known(known, edges)
        };
        if stored.len() < 3 {
            return Err("has fewer than three vertices");
        }
        if !stored.iter().all(is_known) {
            return Err("has a vertex or line of something that does not exist");
        }
        if stored.iter().all(|stored| stored.line().as_cut().is_none()) {
            return Err("is cut by no plane, but not whole");
        }
        Ok(())
    }

    /// The vertex a number of places after another.
    fn vertex(&self, at: usize, after: usize) -> &Vertex {
        &self.vertices[(at + after) % self.vertices.len()]
    }

    /// The two ends of an edge on a plane are on it, and the vertices before and after are on the
    /// side that the edge says. So the plane is not that of the face.
    fn check_cut(&self, face: u32, edge: usize, plane: PlaneId) -> Result<(), &'static str> {
        let prepared = PreparedPlane::new(self.faces, plane);
        let side = |vertex: &Vertex| prepared.side(self.faces, face, vertex);
        let is_on = |vertex: &Vertex| vertex.symbol().is_on(plane) || side(vertex).is_eq();
        if !is_on(self.vertex(edge, 0)) || !is_on(self.vertex(edge, 1)) {
            return Err("has a vertex that is not on its line");
        }
        let is_behind = self.vertices[edge].line().is_behind();
        let is_inside = |vertex: &Vertex| {
            let side = side(vertex);
            if is_behind { side.is_lt() } else { side.is_gt() }
        };
        let last = self.vertices.len() - 1;
        if is_inside(self.vertex(edge, 2)) && is_inside(self.vertex(edge, last)) {
            Ok(())
        } else {
            Err("has a vertex on the wrong side of a cut")
        }
    }

    /// The two ends of an edge of the face are on it by name.
    fn check_edge(&self, face: u32, edge: usize) -> Result<(), &'static str> {
        let len = self.faces.corners(face).len() as u32;
        let k = self.vertices[edge].line().as_edge().unwrap_or(0);
        let is_on = |vertex: &Vertex| match vertex.symbol().kind() {
            SymbolKind::Corner(corner) => corner == k || corner == (k + 1) % len,
            SymbolKind::OnEdge(edge, _) => edge == k,
            SymbolKind::Inside(..) => false,
        };
        if is_on(self.vertex(edge, 0)) && is_on(self.vertex(edge, 1)) {
            Ok(())
        } else {
            Err("has a vertex that is not on its edge")
        }
    }
}

fn stored_line(stored: &[StoredVertex], edge: usize) -> Line {
    stored[edge].line()
}
