//! Trees in files.

mod replay;

use std::io::{self, Read, Write};
use std::ops::Range;
use std::sync::OnceLock;

use super::BspTree;
use super::bsp_tree::next_generation;
use super::node::{MOST_FRAGMENTS, NodeRecord, Visit, Walk, finish, make_room};
use super::order::eye::Planes;
use super::order::layout::OrderLayout;
use super::parts::{Parts, RawChild, RawNode};
use crate::error::Error;
use crate::exact::{Faces, MAX_NAMES, PlaneId};
use crate::faces::Preparation;
use crate::parallel_map;
use crate::save::{Kind, Reader, Writer, damaged, invalid, u32_at};

const KIND: Kind = Kind { name: *b"tree", version: 3 };
/// Flag: the tree was built for one view.
const FOR_ONE_VIEW: u32 = 1;
/// Flag: the tree belongs to a cell of a partition.
const OF_CELL: u32 = 2;
/// Trees with more fragments are checked by two threads. Too small: waking a thread takes longer than the
/// thread's work. Too large: one thread works while the other is idle.
const WORTH_A_THREAD: usize = 4096;

impl BspTree {
    /// Writes the tree. [`read`](Self::read) returns an equal tree: the fragments, the fragments' numbers and
    /// bits, and the orders are the same. Trees of a [`FrameBuilder`](crate::FrameBuilder) can be written
    /// too.
    ///
    /// Takes O(n) time and O(depth) memory, plus a buffer of 64 kB, so `output` need not be a `BufWriter`.
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
    /// This is version 3 of the layout. Numbers are little-endian. A *list* is a length as `u64`, followed by
    /// that number of items. Words in italics are explained below the table. The file consists of these
    /// parts, in this order:
    ///
    /// | part | type | content |
    /// |---|---|---|
    /// | kind | 12 bytes | `binspacetree` |
    /// | version | `u32` | 3 |
    /// | flags | `u32` | the sum of 1 for a tree of a `FrameBuilder` and 2 for a tree of a [cell](crate::partition) |
    /// | grid | `i32` | the exponent e |
    /// | | 3 `f64` | the origin o |
    /// | | 3 `f64` | the far coordinates f; a point x of the scene has the grid coordinates (x − f) · 2ᵉ − o |
    /// | tolerance | `f64` | in steps of the grid |
    /// | faces | list of 3 `u32` | for each face (a convex polygon, or a triangle of a triangulated polygon): the polygon, the number of corners, the *frame* |
    /// | corners | 6 `i64` | only for the tree of a cell: the lower and the upper corner of the cell |
    /// | | 3 `i64` each | the corners of all faces, face by face |
    /// | numbered faces | list of `u32` | the faces whose *corner numbers* are stored; the corner numbers of any other face are 0, 1, 2, … |
    /// | corner numbers | `u32` each | for each corner of the numbered faces, face by face: the *corner number* |
    /// | moved corners | list of `u32` and 3 `i64` | the *corner index* of a corner that was moved onto the plane of its face, and the corner's position before the move |
    /// | dropped polygons | list of `u32` | the indices of the polygons without area, and of the polygons outside the cell |
    /// | counts | 4 `u64` | `triangulated`, `crossing`, `flattened` and `bent` of the [`Preparation`](crate::Preparation) |
    /// | distances | 2 `f64` | `flattened_by` and `bent_by` of the `Preparation` |
    /// | nodes | list of 2 `u32` | the *plane* and the *sides* of each node; depth first, the front before the back |
    /// | fragments | list of `u32` | the face of each fragment |
    /// | checksum | `u32` | the CRC-32 of all bytes before, as of gzip and PNG |
    ///
    /// The *corner index* counts all corners of the file: in the tree of a cell, first the two corners of the
    /// cell, then the corners of all faces. Four kinds of numbers are packed:
    ///
    /// | number | bits | content |
    /// |---|---|---|
    /// | frame | 0–14 | the third corner of the triangle that spans the plane; corner 0 is the first corner of this triangle |
    /// | | 15–29 | the second corner of the same triangle |
    /// | | 30–31 | the axis along which corners were moved; 3 if none was moved |
    /// | corner number | 0–30 | the number of the corner in its polygon |
    /// | | 31 | 1 if the edge to the next corner is not an edge of the polygon |
    /// | plane | 0–27 | the number of a face, or a *corner index* |
    /// | | 28–30 | 1 for the plane of the face; 2, 3, 4 for the plane through the corner perpendicular to x, y, z |
    /// | sides | 0–1 | the back: 0 if it is empty, 1 for a fragment, 2 for a node |
    /// | | 2–3 | the front, in the same form as the back |
    /// | | 4–31 | the number of fragments on the plane |
    ///
    /// If no plane bounds a cell in some direction, the coordinate of the cell's corner is −(2⁵¹ + 2⁴⁴) for
    /// the lower corner and 2⁵¹ + 2⁴⁴ for the upper corner. Vertices are not stored: reading splits the faces
    /// by the planes again.
    ///
    /// # Errors
    ///
    /// The errors of the writer. The bytes written before an error are not a valid file.
    pub fn write(&self, output: impl Write) -> io::Result<()> {
        let mut file = Writer::new(output, KIND)?;
        let of_cell = if self.faces.corners_of_cell() > 0 { OF_CELL } else { 0 };
        file.u32(of_cell + if self.layout.is_none() { FOR_ONE_VIEW } else { 0 })?;
        self.faces.write(&mut file)?;
        self.write_preparation(&mut file)?;
        file.u64(self.nodes.len() as u64)?;
        let mut walk = Walk::new(self);
        while let Some(visit) = walk.next(self) {
            let node = &self.nodes[visit.node];
            file.u32(node.plane.0)?;
            file.u32(shape(node, &visit))?;
        }
        file.list(self.records.iter(), |file, record| file.u32(record.face))?;
        file.finish()
    }

    /// Reads a tree that [`write`](Self::write) has written. Reads only the tree's bytes, so other data may
    /// follow.
    ///
    /// Reading splits the faces by the stored planes again, which takes O(n · mean depth) time for polygons
    /// with few corners; a cut takes time proportional to the corners of the piece that is cut. Unlike
    /// building, reading does not choose planes, so reading takes a quarter to a half of the build time. (If
    /// the builder chose planes in almost no time and split most faces, as with
    /// [`Heuristic::First`](crate::Heuristic::First), reading takes nine tenths of the build time.) `input`
    /// need not be a `BufReader`.
    ///
    /// # Untrusted files
    ///
    /// The file may contain anything. If `read` returns a tree, these guarantees hold:
    ///
    /// - the tree's faces are convex, planar and within the grid;
    /// - each fragment lies on the correct side of the planes of all nodes above the fragment, and the
    ///   fragments of each face cover the face once;
    /// - no method panics, or takes more time or memory than documented.
    ///
    /// A forged file can choose the faces and the planes. So the tree may be deep, and a polygon may be cut
    /// into many fragments, but there are never more fragments than the file lists. The corner numbers that
    /// [`weights`](crate::Fragment::weights) and [`edges`](crate::Fragment::edges) return may be larger than
    /// the numbers of your polygons' corners. Memory grows only with the bytes read: a false length cannot
    /// reserve more than a small multiple of the file's size.
    ///
    /// # Errors
    ///
    /// The message says which of these errors occurred:
    ///
    /// - the data cannot be read;
    /// - the data are not a tree, have another version, or are truncated or damaged;
    /// - the library could not have built such a tree;
    /// - memory runs out.
    pub fn read(input: impl Read) -> Result<Self, Error> {
        let mut file = Reader::new(input, KIND)?;
        let flags = file.u32("flags")?;
        let faces = Faces::read(&mut file, if flags & OF_CELL > 0 { 2 } else { 0 })?;
        let (mut preparation, dropped) = read_preparation(&mut file)?;
        let nodes = file.list("nodes", MOST_FRAGMENTS, pair)?;
        let listed = file.list("fragments", MOST_FRAGMENTS, |bytes: &[u8; 4]| u32_at(bytes, 0))?;
        file.finish()?;
        // The checksum is right, so a fault found below was made by the writer of the file.
        if flags > FOR_ONE_VIEW + OF_CELL {
            return Err(damaged("flags", "are unknown"));
        }
        // Faces and nodes are checked independently. If both are invalid, the error of the faces is returned,
        // with any number of threads.
        let for_one_view = flags & FOR_ONE_VIEW > 0;
        let mut laid_out = Ok(Default::default());
        let lay_out = || {
            let nodes = read_nodes(&nodes, listed.len(), &faces)?;
            let layout = || OrderLayout::new(&nodes, listed.len() as u32);
            let layout = (!for_one_view).then(layout).transpose();
            Ok((layout.map_err(|_| Error::out_of_memory())?, nodes))
        };
        let is_worth_it = listed.len() > WORTH_A_THREAD;
        let checked = parallel_map::beside(is_worth_it, || laid_out = lay_out(), || faces.check());
        checked?;
        check_preparation(&mut preparation, &dropped, &faces)?;
        let (layout, nodes) = laid_out?;
        let parts = replay::replay(&faces, &nodes, &listed, for_one_view)?;
        let mut planes = Planes::default();
        planes.fill(&faces, &nodes).map_err(|_| Error::out_of_memory())?;
        let Parts { records, vertices, positions, cuts, .. } = parts;
        let generation = next_generation();
        Ok(Self {
            faces,
            preparation,
            nodes,
            planes,
            layout,
            records,
            vertices,
            positions,
            cuts,
            generation,
            bounds: OnceLock::new(),
            open_edges: OnceLock::new(),
        })
    }

    fn write_preparation(&self, file: &mut Writer<impl Write>) -> io::Result<()> {
        let found = &self.preparation;
        file.u64(self.dropped().count() as u64)?;
        file.items(self.dropped(), |file, polygon| file.u32(polygon as u32))?;
        let counts = [found.triangulated, found.crossing, found.flattened, found.bent];
        file.items(counts.into_iter(), |file, count| file.u64(count as u64))?;
        file.f64(found.flattened_by)?;
        file.f64(found.bent_by)
    }
}

fn pair(bytes: &[u8; 8]) -> [u32; 2] {
    [u32_at(bytes, 0), u32_at(bytes, 4)]
}

const EMPTY: u32 = 0;
const FRAGMENT: u32 = 1;
const NODE: u32 = 2;

/// The packed number *sides* of a node. (A plane has at most as many fragments as there are faces, fewer than
/// 2²⁷.)
fn shape(node: &NodeRecord, visit: &Visit) -> u32 {
    let side = |is_node, leaf: &Range<u32>| match is_node {
        true => NODE,
        false if leaf.is_empty() => EMPTY,
        false => FRAGMENT,
    };
    let front = side(node.front_nodes > 0, &visit.front);
    node.own() << 4 | front << 2 | side(node.back_is_node(), &visit.back)
}

/// A node from its two numbers in a file. A side of an unknown kind counts as empty.
fn raw(&[plane, shape]: &[u32; 2]) -> RawNode {
    let side = |bits| match bits {
        FRAGMENT => RawChild::Leaf(1),
        NODE => RawChild::Node,
        _ => RawChild::Leaf(0),
    };
    let plane = PlaneId(plane);
    RawNode { plane, own: shape >> 4, front: side(shape >> 2 & 3), back: side(shape & 3) }
}

/// Reads the nodes of a tree; an error unless they form one tree of `fragments` fragments, and each plane has
/// fragments on the plane itself or on both sides.
fn read_nodes(
    bits: &[[u32; 2]],
    fragments: usize,
    faces: &Faces,
) -> Result<Vec<NodeRecord>, Error> {
    // The number of nodes and fragments still to come. If there are faces, there is a root.
    let (mut to_come, mut left) = (usize::from(!faces.is_empty()), fragments);
    for (index, bits) in bits.iter().enumerate() {
        let fault = |fault| invalid("node", index, fault);
        let RawNode { plane, own, front, back } = raw(bits);
        if !faces.has_plane(plane) {
            return Err(fault("names a face or corner that does not exist"));
        }
        if bits[1] >> 2 & 3 > NODE || bits[1] & 3 > NODE {
            return Err(fault("has a side of an unknown kind"));
        }
        let count = |child| [front, back].into_iter().filter(|&side| side == child).count();
        if own == 0 && count(RawChild::Leaf(0)) > 0 {
            return Err(fault("has a plane that separates no fragments"));
        }
        // The node's own place is subtracted first: a node without a parent must not count as its own child.
        let others = to_come.checked_sub(1).ok_or_else(|| fault("has no parent"))?;
        to_come = others + count(RawChild::Node);
        let here = own as usize + count(RawChild::Leaf(1));
        left = left.checked_sub(here).ok_or_else(|| fault("has more fragments than the tree"))?;
    }
    if to_come > 0 || left > 0 {
        return Err(damaged("nodes", "do not match its fragments"));
    }
    let (mut sizes, mut nodes) = (Vec::new(), Vec::new());
    make_room(bits.len(), &mut sizes, &mut nodes).map_err(|_| Error::out_of_memory())?;
    finish(bits.iter().map(raw), &mut sizes, &mut nodes);
    Ok(nodes)
}

/// Reads the counts of polygons and the list of dropped polygons. A file does not contain the number of all
/// polygons.
fn read_preparation(file: &mut Reader<impl Read>) -> Result<(Preparation, Vec<u32>), Error> {
    const WHAT: &str = "counts of polygons";
    let dropped = file.list("dropped polygons", MAX_NAMES, |bytes: &[u8; 4]| u32_at(bytes, 0))?;
    let mut found = Preparation { dropped: dropped.len(), ..Preparation::default() };
    for count in
        [&mut found.triangulated, &mut found.crossing, &mut found.flattened, &mut found.bent]
    {
        *count = file.count(WHAT, MAX_NAMES)?;
    }
    (found.flattened_by, found.bent_by) = (file.f64(WHAT)?, file.f64(WHAT)?);
    Ok((found, dropped))
}

/// Counts all polygons. Returns an error if a polygon neither has faces nor is listed as dropped, or if the
/// counts are impossible.
fn check_preparation(found: &mut Preparation, dropped: &[u32], faces: &Faces) -> Result<(), Error> {
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
            return Err(invalid("polygon", polygons, "has no faces, but is not listed as dropped"));
        }
    }
    found.polygons = polygons;
    let counts = [found.triangulated, found.crossing, found.flattened, found.bent];
    let is_length = |length: f64| length.is_finite() && length >= 0.0;
    if counts.into_iter().any(|count| count > polygons)
        || ![found.flattened_by, found.bent_by].into_iter().all(is_length)
    {
        return Err(damaged("counts of polygons", "are impossible"));
    }
    Ok(())
}
