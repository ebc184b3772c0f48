//! The convex cells of a tree, and the portals between them.

use std::ops::Range;

use binspace::glam::DVec3;
use binspace::{BspTree, Child};

use super::outline::{Outline, Plane, clip, split, without};

/// Lengths as shares of the scene's extent. Points within `NOISE` of a plane are treated as lying on the
/// plane. `NOISE` is some thousand rounding errors. Openings thinner than `THIN` are closed. Too large: real
/// cracks close. Too small: the rounding of walls that meet leaves cracks between them.
pub(super) const NOISE: f64 = 1e-12;
const THIN: f64 = 1e-9;

/// The cells into which a tree divides space, and the portals: the openings between two cells.
///
/// Cells are the tree's leaves. A leaf that holds a fragment is divided by its plane as well, so that all
/// polygons lie on the walls of cells. The portals on a plane are the parts that its polygons leave open (S.
/// Teller and C. Séquin, "Visibility preprocessing for interactive walkthroughs", 1991).
///
/// Everything is limited to the box around the scene: eyes belong inside.
#[derive(Clone, Debug)]
pub struct Cells {
    nodes: Vec<Node>,
    pub(super) cells: Vec<Cell>,
    pub(super) portals: Vec<Portal>,
    pub(super) polygons: usize,
    /// The longest side of the box.
    pub(super) extent: f64,
    whole: Next,
}

#[derive(Clone, Debug)]
struct Node {
    plane: Plane,
    /// The front side, then the back side.
    sides: [Next; 2],
    /// The fragments on the plane.
    own: Range<u32>,
    /// The parent node, and the side of the parent on which this node is.
    parent: Option<(usize, usize)>,
}

#[derive(Clone, Copy, Debug)]
enum Next {
    Node(usize),
    Cell(usize),
}

/// A convex region.
#[derive(Clone, Debug, Default)]
pub(super) struct Cell {
    /// The portals of this cell, each with the side of its plane on which the cell lies.
    pub(super) portals: Vec<(usize, usize)>,
    /// The parts of polygons on the walls of the cell.
    pub(super) surfaces: Vec<Surface>,
}

#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub(super) polygon: usize,
    pub(super) outline: Outline,
}

/// An opening between two cells.
#[derive(Clone, Debug)]
pub(super) struct Portal {
    pub(super) plane: Plane,
    pub(super) outline: Outline,
    /// The cell in front, and the cell behind.
    pub(super) cells: [usize; 2],
}

impl Cells {
    /// Creates the cells of a tree of `polygons` polygons.
    pub fn new(tree: &BspTree, polygons: usize) -> Self {
        let corners = || tree.fragments().flat_map(|fragment| fragment.vertices());
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        let extent = (high - low).max_element().max(0.0);
        let mut cells = Self {
            nodes: Vec::new(),
            cells: Vec::new(),
            portals: Vec::new(),
            polygons,
            extent,
            whole: Next::Cell(0),
        };
        cells.divide(tree);
        let space = Space::around(low, high, 0.01 * extent);
        (0..cells.nodes.len()).for_each(|node| cells.open(tree, node, &space));
        cells
    }

    /// Returns the number of cells.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Returns whether there is no cell: never.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Returns the number of portals.
    pub fn portal_count(&self) -> usize {
        self.portals.len()
    }

    /// Returns the cells that contain a point; several if it is on their common boundary.
    pub fn at(&self, point: DVec3) -> Vec<usize> {
        let (mut pending, mut found) = (vec![self.whole], Vec::new());
        while let Some(next) = pending.pop() {
            match next {
                Next::Cell(cell) => found.push(cell),
                Next::Node(node) => {
                    let Node { plane, sides, .. } = &self.nodes[node];
                    let height = plane.at(point);
                    let is_there = [height, -height].map(|h| h >= -NOISE * self.extent);
                    let there = sides.iter().zip(is_there).filter(|&(_, is_there)| is_there);
                    pending.extend(there.map(|(&side, _)| side));
                }
            }
        }
        found
    }

    /// Copies the tree's nodes, and divides its leaves by the planes of their fragments.
    fn divide(&mut self, tree: &BspTree) {
        let root = tree.root().map_or(Child::Leaf(0..tree.len() as u32), Child::Node);
        let mut pending = vec![(root, None)];
        while let Some((child, parent)) = pending.pop() {
            let (plane, own, below) = match child {
                Child::Node(node) => {
                    let plane = Plane { normal: node.normal(), offset: node.offset() };
                    (plane, node.on(), [node.front(), node.back()])
                }
                Child::Leaf(own) if !own.is_empty() => {
                    let (first, rest) = (own.start..own.start + 1, own.start + 1..own.end);
                    (plane_of(tree, own.start), first, [Child::Leaf(rest), Child::Leaf(0..0)])
                }
                Child::Leaf(_) => {
                    self.cells.push(Cell::default());
                    self.attach(parent, Next::Cell(self.cells.len() - 1));
                    continue;
                }
            };
            let number = self.nodes.len();
            self.nodes.push(Node { plane, sides: [Next::Cell(0); 2], own, parent });
            self.attach(parent, Next::Node(number));
            let sides =
                below.into_iter().zip(0..).map(|(child, side)| (child, Some((number, side))));
            pending.extend(sides);
        }
    }

    fn attach(&mut self, parent: Option<(usize, usize)>, next: Next) {
        match parent {
            Some((node, side)) => self.nodes[node].sides[side] = next,
            None => self.whole = next,
        }
    }

    /// Finds the portals on a node's plane, and puts its polygons on the walls of cells.
    fn open(&mut self, tree: &BspTree, node: usize, space: &Space) {
        let Node { plane, sides, own, .. } = self.nodes[node].clone();
        let thin = THIN * self.extent;
        let mut open = vec![self.region(node, space)];
        for fragment in own {
            let outline: Outline = tree.fragment(fragment).vertices().collect();
            let polygon = tree.fragment(fragment).polygon();
            let left = open.into_iter().flat_map(|part| without(part, &outline, &plane, thin));
            open = left.filter(|part| !part.is_empty()).collect();
            for side in sides {
                for (cell, outline) in self.spread(side, outline.clone()) {
                    self.cells[cell].surfaces.push(Surface { polygon, outline });
                }
            }
        }
        let parts = open.into_iter().flat_map(|part| self.spread(sides[0], part));
        for (front, part) in parts.collect::<Vec<_>>() {
            for (back, outline) in self.spread(sides[1], part) {
                let number = self.portals.len();
                self.cells[front].portals.push((number, 0));
                self.cells[back].portals.push((number, 1));
                self.portals.push(Portal { plane, outline, cells: [front, back] });
            }
        }
    }

    /// The part of a node's plane that is in its region.
    fn region(&self, node: usize, space: &Space) -> Outline {
        let Node { plane, mut parent, .. } = self.nodes[node];
        let mut region = plane.square(space.middle, self.extent);
        space.walls.iter().for_each(|wall| region = clip(&region, wall));
        while let Some((above, side)) = parent {
            let Node { plane, parent: next, .. } = &self.nodes[above];
            let kept = if side == 0 { *plane } else { plane.flipped() };
            // A plane that almost coincides with the plane of an ancestor still has a region.
            region = clip(&region, &kept.eased(NOISE * self.extent));
            parent = *next;
        }
        region
    }

    /// The parts of an outline in the cells below a node.
    fn spread(&self, below: Next, outline: Outline) -> Vec<(usize, Outline)> {
        let (mut pending, mut parts) = (vec![(below, outline)], Vec::new());
        while let Some((next, outline)) = pending.pop() {
            match next {
                Next::Cell(cell) => parts.push((cell, outline)),
                Next::Node(node) => {
                    let Node { plane, sides, .. } = &self.nodes[node];
                    let halves = split(&outline, plane, THIN * self.extent);
                    let there = sides.iter().zip(halves).filter(|(_, half)| !half.is_empty());
                    pending.extend(there.map(|(&side, half)| (side, half)));
                }
            }
        }
        parts
    }
}

/// The box that everything is limited to.
struct Space {
    middle: DVec3,
    walls: [Plane; 6],
}

impl Space {
    fn around(low: DVec3, high: DVec3, margin: f64) -> Self {
        let (low, high) = (low - margin, high + margin);
        let walls = [0, 1, 2, 3, 4, 5].map(|side| match DVec3::AXES[side % 3] {
            axis if side < 3 => Plane::new(axis, low),
            axis => Plane::new(-axis, high),
        });
        Self { middle: 0.5 * (low + high), walls }
    }
}

fn plane_of(tree: &BspTree, fragment: u32) -> Plane {
    let faces = tree.faces();
    let triangle = faces.reference_triangle(tree.fragment(fragment).face());
    let [p, q, r] = triangle.map(|corner| faces.lattice().to_world(faces.corner(corner)));
    Plane::new((q - p).cross(r - p).normalize_or_zero(), p)
}
