//! Bounding boxes of a tree's subtrees and fragments, bounds on the subtrees' normals, and half-spaces
//! compared with boxes.

use std::cmp::Ordering;
use std::ops::Range;

use glam::{DVec3, Vec3, Vec4};

use super::order::eye::{Planes, rounded};
use super::{BspTree, Child, Fragment, Node};
use crate::exact::lattice::{exponent_of, scaled};
use crate::exact::{Eye, LATTICE_LIMIT, Lattice, PlaneId, StoredVertex, VertexKind};
use crate::viewpoint::{Facing, Viewpoint};

/// Bounding boxes of a tree's subtrees and fragments, and bounds on the subtrees' normals. Boxes and bounds
/// take about 90 bytes per fragment.
///
/// Boxes are stored in `f32`, relative to the scene's middle, and rounded outwards. So a box contains the
/// exact vertices of its fragments, and the rounded vertices that [`Fragment::vertices`] returns.
#[derive(Clone, Debug)]
pub(crate) struct Bounds {
    fragments: u32,
    /// The box of each node's subtree.
    pub(crate) nodes: Vec<Flat>,
    normals: Vec<Normals>,
    /// Level 0 has the box of each fragment, in blocks of consecutive numbers. Each further level has a box
    /// around each block of the level before. The last level has a single block.
    pub(crate) levels: Vec<Vec<Block>>,
    /// The plane of each fragment.
    pub(super) planes: Planes,
}

/// The error of a cut vertex's rounded position is at most `SHARE` of the coordinate plus `STEP` lattice
/// units. `SHARE` is more than three roundings, and `STEP` is more than `POSITION_OFF`.
const SHARE: f64 = 2.0 * f64::EPSILON;
const STEP: f64 = 1.0 / 64.0;
/// The largest distance of a moved corner from its stored position, which is the nearest lattice point.
const MOVED: f64 = 0.5;

impl BspTree {
    /// Returns the bounding box `[low, high]` of all fragments, rounded outwards; `None` for an empty tree.
    ///
    /// The first call computes the boxes of all subtrees and fragments, in O(n) time, and stores them in the
    /// tree, with about 90 bytes per fragment. Later calls take constant time.
    ///
    /// Several other calls need the boxes too, and compute them if they are missing: [`Node::bounds`],
    /// [`Node::facing_all`], [`hits`](Self::hits), [`is_occluded`](Self::is_occluded),
    /// [`fragments_in`](Self::fragments_in), [`winding_number`](Self::winding_number), and
    /// [culled](crate::Order::culled) orders of the tree or of an overlay. To compute the boxes in advance,
    /// call this method after building. While one thread computes the boxes, other threads that need them
    /// wait.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let bounds = self.boxes();
        let top = bounds.levels.len() - 1;
        let block = bounds.levels[top].first()?;
        Some(in_world(self.faces.lattice(), &block.all(bounds.len_of(top))))
    }

    /// The boxes, computed at the first use.
    pub(crate) fn boxes(&self) -> &Bounds {
        self.bounds.get_or_init(|| Bounds::new(self))
    }
}

impl Node<'_> {
    /// Returns the bounding box `[low, high]` of all fragments of the node's subtree, in the polygons' unit.
    /// Each side of the box is rounded outwards, by at most 2⁻²³ of the scene's extent (the longest side of
    /// the scene's bounding box) plus three [steps](BspTree#which-tolerance) of `f64`.
    ///
    /// The first call computes the boxes of the whole tree in O(n) time ([`BspTree::bounds`]). Later calls
    /// take constant time.
    pub fn bounds(&self) -> [DVec3; 2] {
        in_world(self.tree.faces.lattice(), &self.tree.boxes().nodes[self.index()])
    }

    /// Returns the [facing](Fragment::facing) of all fragments of the node's subtree, if the subtree's
    /// bounding box and a bound on the fragments' normals prove that all fragments have the same facing.
    /// Otherwise returns `None`, even if all fragments do have the same facing.
    ///
    /// The first call computes the boxes of the whole tree in O(n) time ([`BspTree::bounds`]). Later calls
    /// take constant time.
    pub fn facing_all(&self, viewpoint: Viewpoint) -> Option<Facing> {
        let lattice = self.tree.faces.lattice();
        let arms = Arms::new(&Eye::new(viewpoint, lattice));
        self.tree.boxes().seen(self.index(), &arms).map(Facing::from)
    }
}

fn in_world(lattice: &Lattice, bounds: &Flat) -> [DVec3; 2] {
    let [low, high] = in_lattice(bounds);
    lattice.enclose(low, high)
}

impl Fragment<'_> {
    /// Returns the bounding box `[low, high]` of the fragment, in the polygons' unit. The box is rounded
    /// outwards, like [`Node::bounds`]. Takes O(vertices) time.
    pub fn bounds(&self) -> [DVec3; 2] {
        in_world(self.faces.lattice(), &self.flat_bounds())
    }

    pub(crate) fn flat_bounds(&self) -> Flat {
        let faces = self.faces;
        let moved = faces.moved_axis(self.face);
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let mut stored = self.stored().iter();
        for vertex in self.lattice_vertices() {
            let vertex_id = stored.next().map(StoredVertex::vertex_id);
            let is_cut = vertex_id.is_some_and(|s| !matches!(s.kind(), VertexKind::Corner(_)));
            let off = rounding(vertex, is_cut, moved);
            for axis in 0..3 {
                low[axis] = low[axis].min(vertex[axis] - off[axis]);
                high[axis] = high[axis].max(vertex[axis] + off[axis]);
            }
        }
        outwards(low, high)
    }
}

/// The largest distance of a vertex's rounded position from its exact position along each axis, in lattice
/// units. The distance depends on whether a cut made the vertex, and on the axis along which corners of the
/// vertex's face were moved, if any.
pub(crate) fn rounding(vertex: [f64; 3], is_cut: bool, moved: Option<usize>) -> [f64; 3] {
    std::array::from_fn(|axis| {
        let rounded = if is_cut { vertex[axis].abs() * SHARE + STEP } else { 0.0 };
        if moved == Some(axis) { rounded + MOVED } else { rounded }
    })
}

impl Bounds {
    fn new(tree: &BspTree) -> Self {
        // Uses this thread alone: other threads may be waiting for the boxes. With parallel jobs, rayon's
        // threads could then wait for one another.
        let blocks = blocks(tree.len(), |i| tree.fragment(i as u32).flat_bounds());
        let mut nodes = vec![NOTHING; tree.nodes.len()];
        let mut normals = vec![Normals::NONE; tree.nodes.len()];
        let faces: Vec<Vec4> = (0..tree.faces.len() as u32)
            .map(|face| rounded(&tree.faces, PlaneId::face(face)))
            .collect();
        let planes = Planes::of(tree.records.iter().map(|record| faces[record.face as usize]));
        // Children are stored after their parents. So in reverse order, all children of a node are complete
        // before the node.
        for node in tree.nodes().rev() {
            let index = node.index();
            let parts = [node.front(), Child::Leaf(node.on()), node.back()];
            for part in parts {
                match part {
                    Child::Node(child) => {
                        nodes[index] = union(nodes[index], nodes[child.index()]);
                        normals[index] = normals[index].union(normals[child.index()]);
                    }
                    Child::Leaf(run) => {
                        for fragment in run.start as usize..run.end as usize {
                            let bounds = blocks[fragment / BLOCK].get(fragment % BLOCK);
                            let normal = faces[tree.records[fragment].face as usize].truncate();
                            nodes[index] = union(nodes[index], bounds);
                            normals[index] = normals[index].union(Normals::of(normal));
                        }
                    }
                }
            }
        }
        let levels = levels(tree.len(), blocks);
        Self { fragments: tree.len() as u32, nodes, normals, levels, planes }
    }

    /// The bounds of fragments without nodes: an overlay's pieces.
    pub(crate) fn of_pieces(len: usize, flat: impl Fn(usize) -> Flat) -> Self {
        let (nodes, normals, planes) = (vec![], vec![], Planes::of([].into_iter()));
        Self {
            fragments: len as u32,
            nodes,
            normals,
            levels: levels(len, blocks(len, flat)),
            planes,
        }
    }

    pub(super) fn seen(&self, node: usize, arms: &Arms) -> Option<Ordering> {
        self.normals[node].facing(arms, &self.nodes[node])
    }

    /// The box of one of the blocks of a level, or of a fragment at level 0.
    #[inline]
    pub(crate) fn get(&self, level: usize, number: u32) -> Flat {
        self.levels[level][number as usize / BLOCK].get(number as usize % BLOCK)
    }

    /// The number of boxes of a level.
    #[inline]
    pub(super) fn len_of(&self, level: usize) -> usize {
        (self.fragments as usize).div_ceil(BLOCK.pow(level as u32))
    }

    /// Finds the largest aligned block that begins at the start of a run of fragments and lies within the
    /// run. Returns the block's level and number of fragments.
    pub(crate) fn block(&self, run: &Range<u32>) -> (usize, u32) {
        let (mut level, mut len) = (0, 1_u32);
        while level + 1 < self.levels.len()
            && run.start.is_multiple_of(len * BLOCK as u32)
            && run.end - run.start >= len * BLOCK as u32
        {
            (level, len) = (level + 1, len * BLOCK as u32);
        }
        (level, len)
    }

    /// Removes blocks from the start of a run of fragments, including the first block that may be inside a
    /// region. Returns that block, and whether the block is certainly inside. A block that is not certainly
    /// inside is a single fragment. `is_inside` returns whether a box is inside, or `None` if it cannot decide.
    #[inline]
    pub(crate) fn next_block(
        &self,
        run: &mut Range<u32>,
        is_inside: impl Fn(&Flat) -> Option<bool>,
    ) -> Option<(Range<u32>, bool)> {
        while run.start < run.end {
            let (mut level, mut len) = self.block(run);
            let found = loop {
                match is_inside(&self.get(level, run.start / len)) {
                    None if level > 0 => (level, len) = (level - 1, len / BLOCK as u32),
                    found => break found,
                }
            };
            let block = run.start..run.start + len;
            run.start = block.end;
            if found != Some(false) {
                return Some((block, found.is_some()));
            }
        }
        None
    }

    /// The size on the heap in bytes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.nodes)
            + size_of_val(&*self.normals)
            + self.levels.iter().map(|level| size_of_val(&**level)).sum::<usize>()
            + self.planes.bytes()
    }
}

/// `len` boxes in blocks.
fn blocks(len: usize, flat: impl Fn(usize) -> Flat) -> Vec<Block> {
    (0..len).step_by(BLOCK).map(|first| Block::new((first..len).map(&flat))).collect()
}

/// The given blocks, which contain `len` boxes; then blocks of the boxes around these blocks, and so on.
fn levels(mut len: usize, blocks: Vec<Block>) -> Vec<Vec<Block>> {
    let mut levels = vec![blocks];
    while let Some(last) = levels.last().filter(|last| last.len() > 1) {
        let whole: Vec<Flat> =
            last.iter().enumerate().map(|(k, block)| block.all(len - k * BLOCK)).collect();
        let next = whole.chunks(BLOCK).map(|boxes| Block::new(boxes.iter().copied())).collect();
        len = last.len();
        levels.push(next);
    }
    levels
}

/// The least coordinates of a box, then the largest.
///
/// The unit is 2⁵¹ lattice steps, so coordinates are hardly larger than 1 in every scene.
pub(crate) type Flat = [f32; 6];

/// The box of no points.
const NOTHING: Flat = [
    f32::INFINITY,
    f32::INFINITY,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NEG_INFINITY,
    f32::NEG_INFINITY,
];

/// The number of boxes in one larger box. Too small: larger boxes take more memory. Too large: more boxes are
/// tested where few are met.
pub(crate) const BLOCK: usize = 16;

/// The number of boxes that are compared with a plane at once.
const GROUP: usize = 4;

/// [`BLOCK`] boxes in groups of four: the least x of the four boxes, the least y of the four, and so on. The
/// last block of a list is filled up with zeros.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Block([[Vec4; 6]; BLOCK / GROUP]);

impl Block {
    fn new(boxes: impl Iterator<Item = Flat>) -> Self {
        let mut block = Self::default();
        for (k, bounds) in boxes.take(BLOCK).enumerate() {
            for (row, side) in block.0[k / GROUP].iter_mut().zip(bounds) {
                row[k % GROUP] = side;
            }
        }
        block
    }

    /// The box with a given number, less than [`BLOCK`].
    #[inline]
    pub(crate) fn get(&self, k: usize) -> Flat {
        self.0[k / GROUP % (BLOCK / GROUP)].map(|row| row[k % GROUP])
    }

    /// The box around the first `len` boxes.
    fn all(&self, len: usize) -> Flat {
        (0..len.min(BLOCK)).map(|k| self.get(k)).fold(NOTHING, union)
    }
}

/// A box given in lattice units, rounded outwards to `f32`.
pub(crate) fn outwards(low: [f64; 3], high: [f64; 3]) -> Flat {
    std::array::from_fn(|i| {
        let exact = if i < 3 { low[i] } else { high[i - 3] } / LATTICE_LIMIT;
        let rounded = exact as f32;
        match f64::from(rounded) - exact {
            lost if i < 3 && lost > 0.0 => rounded.next_down(),
            lost if i >= 3 && lost < 0.0 => rounded.next_up(),
            _ => rounded,
        }
    })
}

/// The least and the largest coordinates of a box, in lattice units.
fn in_lattice(bounds: &Flat) -> [[f64; 3]; 2] {
    let [a, b, c, d, e, f] = bounds.map(|side| f64::from(side) * LATTICE_LIMIT);
    [[a, b, c], [d, e, f]]
}

fn union(a: Flat, b: Flat) -> Flat {
    std::array::from_fn(|i| if i < 3 { a[i].min(b[i]) } else { a[i].max(b[i]) })
}

/// The front of a plane, prepared to be compared with many boxes of one scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfSpace {
    normal: [f32; 3],
    /// The plane's offset, reduced by more than the rounding error of all compared values.
    offset: f32,
    /// The indices, in a box, of the coordinates of two corners: the furthest corner along the normal, and
    /// the nearest.
    far: [usize; 3],
    near: [usize; 3],
}

/// Error bound of a scalar product with a corner of a box, as a share of the sum of the normal's magnitudes.
/// Coordinates are at most 1.014, and the normal, products and sums are rounded, by 4 · 1.014 · 2⁻²⁴ in
/// total. The rest of the bound is more than a step of the scene's grid, by which the eye may be off. Too
/// small: boxes that reach over the plane count as behind. Too large: boxes behind the plane, but near it, do
/// not count as behind.
const DISTANCE_ERROR: f64 = 4.2 / (1_u64 << 24) as f64;

/// Error bound of the plane's position in `f64`, as a share of the sum of its terms' magnitudes.
const ROUNDINGS: f64 = 8.0 * f64::EPSILON;

/// A bound on the distance of a corner from the scene's middle, along a normal whose largest coordinate is 1.
const OUTSIDE: f64 = 4.0;

impl HalfSpace {
    /// Prepares a plane. If a number of the plane is infinite or NaN, all boxes are in front.
    pub(crate) fn new((normal, offset): (DVec3, f64), lattice: &Lattice) -> Self {
        // Scales by a power of two first, which is exact, so that subnormal numbers lose no digits.
        let largest = normal.abs().max_element();
        let up = if largest > 0.0 { -exponent_of(largest) } else { 0 };
        let normal = DVec3::from_array(normal.to_array().map(|c| scaled(c, up)));
        let offset = scaled(offset, up);
        let size = normal.abs().max_element().max(f64::MIN_POSITIVE);
        let normal = normal / size;
        // An eighth of all lengths, so that no length overflows.
        let middle = lattice.to_world([0.0; 3]) / 8.0;
        let unit = lattice.length_to_world(LATTICE_LIMIT / 8.0);
        let offset = offset / 8.0 / size;
        let sum = offset.abs() + normal.abs().dot(middle.abs());
        let margin = (sum * ROUNDINGS + f64::MIN_POSITIVE) / unit;
        let margin = margin + normal.abs().element_sum() * DISTANCE_ERROR;
        let least = ((offset - normal.dot(middle)) / unit - margin).clamp(-OUTSIDE, OUTSIDE);
        // The margin is the same for all boxes. So if a box is behind a plane, no smaller box inside that box
        // counts as in front of the plane.
        let offset = if least.is_nan() { f32::NEG_INFINITY } else { (least as f32).next_down() };
        let normal = if least.is_nan() { [0.0; 3] } else { normal.as_vec3().to_array() };
        let sides = |is_far| [0, 1, 2].map(|i| if (normal[i] > 0.0) == is_far { i + 3 } else { i });
        Self { normal, offset, far: sides(true), near: sides(false) }
    }

    /// A bit for each box that is not certainly behind.
    #[inline]
    pub(crate) fn meets(&self, block: &Block) -> u32 {
        self.fronts(block, self.far)
    }

    /// A bit for each box that is in front.
    #[inline]
    pub(crate) fn holds(&self, block: &Block) -> u32 {
        self.fronts(block, self.near)
    }

    /// A bit for each box that has the given corner in front.
    #[inline]
    fn fronts(&self, Block(groups): &Block, [x, y, z]: [usize; 3]) -> u32 {
        let [a, b, c] = self.normal;
        let mut fronts = 0;
        for (g, group) in groups.iter().enumerate() {
            let along = group[x] * a + group[y] * b + group[z] * c;
            fronts |= along.cmpge(Vec4::splat(self.offset)).bitmask() << (4 * g);
        }
        fronts
    }

    /// Whether a whole box is behind.
    #[inline]
    pub(crate) fn is_behind(&self, bounds: &Flat) -> bool {
        let [a, b, c] = self.normal;
        let [x, y, z] = self.far;
        bounds[x] * a + bounds[y] * b + bounds[z] * c < self.offset
    }
}

/// The least and the largest coordinates of unit normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::tree) struct Normals {
    low: [f32; 3],
    high: [f32; 3],
}

/// Bounds the total error of rounding a unit normal's coordinate to `f32` and then adding this constant. With
/// ε = 2⁻²³: a normal is within 2⁻³⁴ of its longest coordinate and is normalised in `f64`, so its error is
/// less than ε / 1000. Rounding to `f32` moves a coordinate of at most 1 by ε / 4, and a sum of more than 1
/// by ε / 2. The constant is more than twice that total. Too small: a box may not contain the exact normal.
/// Too large: fewer subtrees are decided at once.
const NORMAL_ERROR: f32 = 2.0 * f32::EPSILON;

impl Normals {
    const NONE: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    /// The bounds of one unit normal, which is given rounded to `f32`.
    fn of(normal: Vec3) -> Self {
        let normal = normal.to_array();
        Self { low: normal.map(|c| c - NORMAL_ERROR), high: normal.map(|c| c + NORMAL_ERROR) }
    }

    fn union(self, other: Self) -> Self {
        let pick = |of: fn(f32, f32) -> f32, a: [f32; 3], b: [f32; 3]| {
            std::array::from_fn(|i| of(a[i], b[i]))
        };
        Self {
            low: pick(f32::min, self.low, other.low),
            high: pick(f32::max, self.high, other.high),
        }
    }

    /// The side that all polygons with such normals and with vertices in a box show to an eye; `None` if the
    /// normals and the box do not decide the side.
    ///
    /// The distance of the eye e from a polygon's plane is n·(e − p), where n is the plane's normal and p is
    /// any point of the plane. The bounds of n and p bound each product, and therefore the sum of the
    /// products.
    fn facing(&self, arms: &Arms, bounds: &Flat) -> Option<Ordering> {
        let [least, most] = arms.to(bounds);
        let (mut low, mut high, mut size) = (0.0, 0.0, 0.0);
        for axis in 0..3 {
            let [a, b] = [self.low[axis], self.high[axis]].map(f64::from);
            let [c, d] = [least[axis], most[axis]];
            let products = [a * c, a * d, b * c, b * d];
            low += products.into_iter().fold(f64::INFINITY, f64::min);
            high += products.into_iter().fold(f64::NEG_INFINITY, f64::max);
            size += products.into_iter().fold(0.0, |size, product| product.abs().max(size));
        }
        // With ε = 2⁻⁵²: each product has a rounding error of ε / 2 of the product, and each sum an error of
        // ε / 2 of its terms. Two sums round (the first adds to 0), so ε / 2 + ε / 2 + ε / 2 of the size is
        // enough.
        let margin = 4.0 * f64::EPSILON * size;
        if low > margin {
            Some(Ordering::Greater)
        } else if high < -margin {
            Some(Ordering::Less)
        } else {
            None
        }
    }
}

/// The eye relative to points of boxes.
#[derive(Clone, Copy, Debug)]
pub(in crate::tree) struct Arms {
    eye: [f64; 3],
    /// The eye's homogeneous coordinate: 1, or 0 for an eye at infinity.
    w: f64,
}

impl Arms {
    pub(in crate::tree) fn new(eye: &Eye) -> Self {
        let (eye, w) = eye.homogeneous();
        Self { eye, w }
    }

    /// The least and largest coordinates of the eye minus a point of a box, in lattice units, or of the
    /// direction towards the eye.
    fn to(&self, bounds: &Flat) -> [[f64; 3]; 2] {
        let [low, high] = in_lattice(bounds);
        let bound = |corner: [f64; 3], sign: f64| {
            std::array::from_fn(|axis| {
                let (eye, corner) = (self.eye[axis], self.w * corner[axis]);
                // The eye is rounded by ε / 2 of its coordinate, and the difference by ε / 2 of the eye and
                // the corner. The sum below is rounded by as much again. (A direction and corners of boxes
                // are exact.)
                let rounded = 2.0 * f64::EPSILON * (eye.abs() + corner.abs() + 1.0);
                eye - corner + sign * rounded
            })
        };
        [bound(high, -1.0), bound(low, 1.0)]
    }
}
