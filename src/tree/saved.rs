//! Trees in files.

mod nodes;
mod outlines;

use std::io::{self, Read, Write};

use super::BspTree;
use super::bsp_tree::next_generation;
use super::node::MOST_FRAGMENTS;
use super::order::eye::Planes;
use super::order::layout::Schedule;
use super::parts::{Parts, Record, raw_nodes};
use crate::exact::{Faces, Line, MAX_LABELS, StoredVertex, Symbol};
use crate::faces::Preparation;
use crate::parallel_map;
use crate::save::{Kind, LoadError, Reader, Writer, invalid, u32_at};

const KIND: Kind = Kind { name: *b"tree", version: 2 };
/// Set in the flags of a tree for one view.
const FOR_ONE_VIEW: u32 = 1;
/// Set in the flags of a tree of a cell.
const OF_CELL: u32 = 2;
/// Trees with more fragments are checked by two threads. Smaller: waking one takes longer than what it
/// does; larger: some wait for one thread while the other is idle.
const WORTH_A_THREAD: usize = 4096;

impl BspTree {
    /// Writes the tree, so that [`read`](Self::read) gives the same: the same fragments with the same
    /// numbers, bits and orders. Trees of a [`FrameBuilder`](crate::FrameBuilder) too.
    ///
    /// Takes O(n) time, and of memory O(depth) and 64 kB. It need not be a `BufWriter`.
    ///
    /// ```
    /// use binspace::{BspTree, Viewpoint};
    ///
    /// let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    /// let tree = BspTree::build([square(2.0), square(0.0)])?;
    /// let mut file = Vec::new(); // or a `std::fs::File`
    /// tree.write(&mut file)?;
    ///
    /// let again = BspTree::read(&file[..])?;
    /// let above = Viewpoint::eye([0.5, 0.5, 9.0]);
    /// assert!(again.back_to_front(above).map(|fragment| fragment.polygon()).eq([1, 0]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Layout
    ///
    /// Version 2. All numbers are little-endian; a list is its length as `u64` and then its items.
    ///
    /// | part | what |
    /// |---|---|
    /// | head | the bytes `binspacetree`, the version as `u32`, flags as `u32`, added up: 1 for a tree of a `FrameBuilder`, 2 for a tree of a cell |
    /// | grid | the exponent e of 2 as `i32`, the origin o and the far coordinates f as three `f64` each: a point x is the grid's point (x − f) · 2ᵉ − o |
    /// | tolerance | `f64`, in steps of the grid |
    /// | faces | a list: polygon, number of corners, frame, as `u32`. The frame is the numbers of the second (bits 15 to 29) and third corner (0 to 14) of the triangle that spans the plane, and the axis along which corners were moved (30 and 31; 3 for none) |
    /// | corners | of the cell, if it is of one: the lower and the upper; then of all faces: three `i64` each. Sides of a cell that have no plane are at 2⁵¹ + 2⁴⁴, with a minus the lower ones |
    /// | numbered faces | a list: faces, as `u32`, whose corners are not the first of their polygon |
    /// | corner numbers | of these: `u32` each, bit 31 set if the edge to the next is none of the polygon |
    /// | moved corners | a list: the corner as `u32`, and where it was given, three `i64` |
    /// | preparation | a list of the dropped polygons as `u32`; 0 (unused) and the numbers of triangulated, crossing, flattened and bent polygons as `u64`; the lengths of the last two as `f64` |
    /// | cuts | how many times a piece was cut in two: `u64` |
    /// | nodes | a list, depth first: the plane, and 16 · the fragments on it + 4 · the front + the back, where 0 is nothing, 1 a fragment and 2 a node; `u32` each |
    /// | fragments | a list: the face, and how many vertices it has, 0 for a whole face; `u32` each |
    /// | vertices | of all fragments: the two lines that cross in it, and the line to the next; `u32` each |
    /// | end | the CRC-32 of all bytes before, as of gzip and PNG, `u32` |
    ///
    /// A plane is 1 in bits 28 to 30 for the plane of a face, or 2, 3, 4 for one perpendicular to x, y,
    /// z through a corner, and the number of the face or corner in the bits below. A line is the number
    /// of an edge of the face, or a plane, with bit 31 set where the fragment lies behind it. Of the two
    /// lines of a vertex, an edge or else the lesser number comes first; a corner is its number twice.
    ///
    /// # Errors
    ///
    /// Those of the writer. What it has taken until then is no file.
    pub fn write(&self, output: impl Write) -> io::Result<()> {
        let mut file = Writer::new(output, KIND)?;
        let of_cell = if self.faces.corners_of_cell() > 0 { OF_CELL } else { 0 };
        file.u32(of_cell + if self.schedule.is_none() { FOR_ONE_VIEW } else { 0 })?;
        self.faces.write(&mut file)?;
        self.write_preparation(&mut file)?;
        file.u64(self.cuts as u64)?;
        file.u64(self.nodes.len() as u64)?;
        file.items(raw_nodes(self), |file, node| {
            file.u32(node.plane.to_bits())?;
            file.u32(nodes::shape(&node))
        })?;
        file.list(self.fragments(), |file, fragment| {
            file.u32(fragment.face())?;
            file.u32(fragment.stored().len() as u32)
        })?;
        file.items(self.vertices.iter(), |file, vertex| {
            let symbol = vertex.symbol().to_bits();
            let lines = symbol.into_iter().chain([vertex.line().to_bits()]);
            file.items(lines, |file, line| file.u32(line))
        })?;
        file.finish()
    }

    /// Reads a tree that [`write`](Self::write) has written. Takes up no more than the tree's bytes,
    /// so that something else may follow them.
    ///
    /// Takes O(n) time, a fourteenth to a ninth of what building takes (two fifths where nearly all
    /// vertices are cut); a `BufReader` makes it no faster.
    ///
    /// # Files from strangers
    ///
    /// The file may hold anything: whatever `read` returns, no method panics, and none takes more
    /// time or memory than it says. Memory grows with what is read, so a false length cannot ask for
    /// more than a small multiple of the file. For this it checks that
    ///
    /// - the file is complete and undamaged;
    /// - corners are within the grid, and each face is convex, planar and has area;
    /// - sizes of subtrees add up, each plane parts something, and every number names something;
    /// - every face has fragments, which are the face, or each bounded by a closed outline: every
    ///   vertex is a point within the grid, exactly on both lines that meet there, and the lines of
    ///   cuts have the next vertices on the side that they say.
    ///
    /// It does not check that fragments lie on their sides of the planes above, nor that they cover
    /// their faces: [`validate`](Self::validate) does. So a forged tree may have wrong orders and
    /// pieces. Corner numbers ([`weights`](crate::Fragment::weights), [`edges`](crate::Fragment::edges))
    /// may be larger than any that your polygons have.
    ///
    /// # Errors
    ///
    /// If the data cannot be read, are no tree, of another version, cut short, damaged, or of no tree
    /// that the library could have built; or if memory runs out. The message says which.
    pub fn read(input: impl Read) -> Result<Self, LoadError> {
        let mut file = Reader::new(input, KIND)?;
        let flags = file.u32("flags")?;
        let faces = Faces::read(&mut file, if flags & OF_CELL > 0 { 2 } else { 0 })?;
        let (mut preparation, dropped) = read_preparation(&mut file)?;
        let cuts = file.count("cuts", MOST_FRAGMENTS)?;
        let nodes = file.list("nodes", MOST_FRAGMENTS, pair)?;
        let (records, vertices) = read_records(&mut file)?;
        file.finish()?;
        // Only now is it known that nothing is damaged: what is wrong from here on was written so.
        if flags > FOR_ONE_VIEW + OF_CELL {
            return Err(LoadError::of("flags", "are unknown"));
        }
        // Faces and nodes need nothing of each other. Of two faults, the same is found first on any
        // number of threads.
        let (for_one_view, known) = (flags & FOR_ONE_VIEW > 0, faces.known());
        let mut laid_out = Ok(Default::default());
        let lay_out = || {
            let nodes = nodes::read(&nodes, &records, known)?;
            let schedule = || Schedule::new(&nodes, records.len() as u32);
            let schedule = (!for_one_view).then(schedule).transpose();
            Ok((schedule.map_err(|_| LoadError::out_of_memory())?, nodes))
        };
        let is_worth_it = records.len() > WORTH_A_THREAD;
        let checked = parallel_map::beside(is_worth_it, || laid_out = lay_out(), || faces.check());
        checked?;
        check_preparation(&mut preparation, &dropped, &faces)?;
        let (schedule, nodes) = laid_out?;
        // Each cut makes one fragment more.
        if cuts > records.len() {
            return Err(LoadError::of("cuts", "are more than the fragments"));
        }
        let positions = Vec::new();
        let mut parts = Parts { nodes: Vec::new(), records, vertices, positions, cuts };
        outlines::check(&faces, &mut parts, for_one_view)?;
        let mut planes = Planes::default();
        planes.fill(&faces, &nodes).map_err(|_| LoadError::out_of_memory())?;
        let Parts { records, vertices, positions, .. } = parts;
        let generation = next_generation();
        Ok(Self {
            faces,
            preparation,
            nodes,
            planes,
            schedule,
            records,
            vertices,
            positions,
            cuts,
            generation,
        })
    }

    fn write_preparation(&self, file: &mut Writer<impl Write>) -> io::Result<()> {
        let found = &self.preparation;
        file.u64(self.dropped().count() as u64)?;
        file.items(self.dropped(), |file, polygon| file.u32(polygon as u32))?;
        let counts = [0, found.triangulated, found.crossing, found.flattened, found.bent];
        file.items(counts.into_iter(), |file, count| file.u64(count as u64))?;
        file.f64(found.flattened_by)?;
        file.f64(found.bent_by)
    }
}

fn pair(bytes: &[u8; 8]) -> [u32; 2] {
    [u32_at(bytes, 0), u32_at(bytes, 4)]
}

/// The fragments, and the vertices of those that were cut.
fn read_records(
    file: &mut Reader<impl Read>,
) -> Result<(Vec<Record>, Vec<StoredVertex>), LoadError> {
    let mut vertices = 0_u64;
    let records = file.list("fragments", MOST_FRAGMENTS, |bytes: &[u8; 8]| {
        let [face, len] = pair(bytes);
        let record = Record { face, vertices: u32::try_from(vertices).unwrap_or(u32::MAX) };
        vertices += u64::from(len);
        record
    })?;
    if vertices > u64::from(u32::MAX) {
        return Err(LoadError::too_many("vertices", vertices, u32::MAX.into()));
    }
    let vertices = file.items("vertices", vertices as usize, |bytes: &[u8; 12]| {
        let symbol = Symbol::from_bits([u32_at(bytes, 0), u32_at(bytes, 4)]);
        StoredVertex::new(symbol, Line::from_bits(u32_at(bytes, 8)))
    })?;
    Ok((records, vertices))
}

/// What became of the polygons, but for how many there were, and the polygons that were dropped.
fn read_preparation(file: &mut Reader<impl Read>) -> Result<(Preparation, Vec<u32>), LoadError> {
    const WHAT: &str = "counts of polygons";
    let dropped = file.list("dropped polygons", MAX_LABELS, |bytes: &[u8; 4]| u32_at(bytes, 0))?;
    let mut found = Preparation { dropped: dropped.len(), ..Preparation::default() };
    file.count(WHAT, 0)?;
    for count in
        [&mut found.triangulated, &mut found.crossing, &mut found.flattened, &mut found.bent]
    {
        *count = file.count(WHAT, MAX_LABELS)?;
    }
    (found.flattened_by, found.bent_by) = (file.f64(WHAT)?, file.f64(WHAT)?);
    Ok((found, dropped))
}

/// Counts the polygons: each has faces, or was dropped.
fn check_preparation(
    found: &mut Preparation,
    dropped: &[u32],
    faces: &Faces,
) -> Result<(), LoadError> {
    let mut dropped = dropped.iter().copied().peekable();
    let (mut polygons, mut face) = (0, 0);
    loop {
        let of_face = (face < faces.len() as u32).then(|| faces.polygon(face));
        if dropped.next_if(|&polygon| polygon as usize == polygons).is_some() {
            polygons += 1;
        } else if of_face == Some(polygons) {
            while face < faces.len() as u32 && faces.polygon(face) == polygons {
                face += 1;
            }
            polygons += 1;
        } else if of_face.is_none() && dropped.peek().is_none() {
            break;
        } else {
            return Err(invalid("polygon", polygons, "has neither faces nor been dropped"));
        }
    }
    found.polygons = polygons;
    let counts = [found.triangulated, found.crossing, found.flattened, found.bent];
    let is_length = |length: f64| length.is_finite() && length >= 0.0;
    if counts.into_iter().any(|count| count > polygons)
        || ![found.flattened_by, found.bent_by].into_iter().all(is_length)
    {
        return Err(LoadError::of("counts of polygons", "are impossible"));
    }
    Ok(())
}
