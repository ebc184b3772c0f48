//! A textbook tree with rounded planes, rounded vertices, and an epsilon.

use std::cmp::Ordering;
use std::fmt::Debug;
use std::marker::PhantomData;

use binspace::internals::{
    EdgeLine, Eye, Faces, LATTICE_LIMIT, PlaneId, PlaneKind, Side, VertexId,
};

use crate::tree::{self, Fragment, Node, Tree, Vertex};

/// The type that every operation is rounded to.
pub trait Precision: Copy + Debug + 'static {
    /// Rounds a number to this precision.
    fn round(value: f64) -> f64;
}

impl Precision for f64 {
    #[inline]
    fn round(value: f64) -> f64 {
        value
    }
}

impl Precision for f32 {
    #[inline]
    fn round(value: f64) -> f64 {
        f64::from(value as f32)
    }
}

/// The plane of a face, with a unit normal.
#[derive(Clone, Copy, Debug)]
pub struct RoundedPlane<T> {
    plane: PlaneId,
    normal: [f64; 3],
    offset: f64,
    /// In lattice units.
    epsilon: f64,
    precision: PhantomData<T>,
}

/// A face or a piece of a face. The definitions of vertices are kept to judge the vertices; no decision uses
/// them.
#[derive(Clone, Debug)]
pub struct RoundedPiece {
    face: u32,
    vertices: Vec<Vertex>,
    is_whole: bool,
}

impl<T: Precision> RoundedPlane<T> {
    /// Creates the plane of a face. Vertices within `epsilon` times half the scene's extent of the plane
    /// are treated as lying on the plane.
    pub fn new(faces: &Faces, face: u32, epsilon: f64) -> Self {
        let triangle = faces.reference_triangle(face);
        let [p, q, r] = triangle.map(|c| faces.corner(c).map(T::round));
        // Scaled to at most 1, so that products stay within the range of f32.
        let edge = |x: [f64; 3]| -> [f64; 3] {
            std::array::from_fn(|i| T::round((x[i] - p[i]) * f64::EPSILON))
        };
        let (u, w) = (edge(q), edge(r));
        let product = |a: f64, b: f64| T::round(a * b);
        let normal: [f64; 3] = std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            T::round(product(u[j], w[k]) - product(u[k], w[j]))
        });
        let [x, y, z] = normal.map(|c| product(c, c));
        let length = T::round(T::round(T::round(x + y) + z).sqrt());
        let normal = normal.map(|c| if length > 0.0 { T::round(c / length) } else { 0.0 });
        let term = |i: usize| T::round(normal[i] * p[i]);
        let offset = T::round(T::round(term(0) + term(1)) + term(2));
        let (plane, epsilon) = (PlaneId::face(face), epsilon * LATTICE_LIMIT);
        Self { plane, normal, offset, epsilon, precision: PhantomData }
    }

    #[inline]
    fn distance(&self, p: [f64; 3]) -> f64 {
        let term = |i: usize| T::round(self.normal[i] * p[i]);
        T::round(T::round(T::round(term(0) + term(1)) + term(2)) - self.offset)
    }

    #[inline]
    fn side(&self, position: [f64; 3]) -> Ordering {
        let distance = self.distance(position);
        if distance > self.epsilon {
            Ordering::Greater
        } else if distance < -self.epsilon {
            Ordering::Less
        } else {
            Ordering::Equal
        }
    }

    /// Returns the side of a plane on which a piece lies.
    pub fn classify(&self, piece: &RoundedPiece) -> Side {
        if self.plane == PlaneId::face(piece.face) {
            return Side::Coplanar;
        }
        let (mut in_front, mut behind) = (false, false);
        for vertex in &piece.vertices {
            let side = self.side(vertex.position);
            in_front |= side.is_gt();
            behind |= side.is_lt();
        }
        match (in_front, behind) {
            (true, true) => Side::Spanning,
            (true, false) => Side::Front,
            (false, true) => Side::Back,
            (false, false) => Side::Coplanar,
        }
    }

    /// Returns the parts of a piece in front of the plane and behind it.
    pub fn split(&self, piece: &RoundedPiece) -> [RoundedPiece; 2] {
        let part = || RoundedPiece { face: piece.face, vertices: Vec::new(), is_whole: false };
        let mut parts = [part(), part()];
        let sides: Vec<Ordering> =
            piece.vertices.iter().map(|vertex| self.side(vertex.position)).collect();
        for (i, &vertex) in piece.vertices.iter().enumerate() {
            let j = (i + 1) % sides.len();
            let (here, next) = (sides[i], sides[j]);
            let crossing = || self.crossing(&vertex, &piece.vertices[j]);
            for (part, own) in parts.iter_mut().zip([Ordering::Greater, Ordering::Less]) {
                // The line along the plane, where the outline of the part leaves the outline of the piece.
                let cut = EdgeLine::cut(self.plane, own.is_lt());
                let leaves = next == own.reverse();
                if here == own || here.is_eq() {
                    let line = if here.is_eq() && leaves { cut } else { vertex.line };
                    part.vertices.push(Vertex { line, ..vertex });
                }
                if here.is_ne() && next == here.reverse() {
                    let line = if leaves { cut } else { vertex.line };
                    part.vertices.push(Vertex { line, ..crossing() });
                }
            }
        }
        parts
    }

    /// The point in which the plane cuts an edge.
    fn crossing(&self, from: &Vertex, to: &Vertex) -> Vertex {
        let (a, b) = (self.distance(from.position), self.distance(to.position));
        let t = T::round(a / T::round(a - b));
        let position = std::array::from_fn(|i| {
            let (p, q) = (from.position[i], to.position[i]);
            T::round(p + T::round(T::round(q - p) * t))
        });
        let vertex_id = VertexId::crossing(from.line, self.plane);
        Vertex { position, vertex_id, line: from.line }
    }
}

impl RoundedPiece {
    /// Creates the piece that is a whole face.
    pub fn whole<T: Precision>(faces: &Faces, face: u32) -> Self {
        let vertex = |(k, corner): (u32, &[f64; 3])| Vertex {
            position: corner.map(T::round),
            vertex_id: VertexId::corner(k),
            line: EdgeLine::edge(k),
        };
        let vertices = (0..).zip(faces.corners(face)).map(vertex).collect();
        Self { face, vertices, is_whole: true }
    }

    /// Returns the positions of the piece's vertices, in lattice units.
    pub fn positions(&self) -> impl Iterator<Item = [f64; 3]> {
        self.vertices.iter().map(|vertex| vertex.position)
    }

    /// Returns the definitions of the piece's vertices.
    pub fn vertex_ids(&self) -> impl Iterator<Item = VertexId> {
        self.vertices.iter().map(|vertex| vertex.vertex_id)
    }
}

/// The number of planes tried at each node, as by `Heuristic::Sampled`.
const CANDIDATES: usize = 16;
/// The cost of a cut, in pieces by which the two sides differ.
const CUT: usize = 8;

/// A set of pieces that is still to be divided.
struct Pending {
    pieces: Vec<RoundedPiece>,
    depth: usize,
    parent: Option<(usize, bool)>,
}

impl Tree {
    /// Builds a tree of faces by rounded numbers. Vertices within `epsilon` times half the scene's extent of
    /// a plane are treated as lying on the plane. Decisions are wrong where distances are near the epsilon or
    /// the precision. `Heuristic::Sampled` chooses the same planes with exact decisions.
    ///
    /// `None` if there would be more than `max_fragments` fragments.
    pub fn with_epsilon<T: Precision>(
        faces: Faces,
        epsilon: f64,
        max_fragments: usize,
    ) -> Option<Self> {
        let mut tree = Self {
            faces,
            nodes: Vec::new(),
            fragments: Vec::new(),
            vertices: Vec::new(),
            cuts: 0,
            eye_side: eye_side::<T>,
        };
        let count = tree.faces.len();
        let pieces = (0..count as u32).map(|face| RoundedPiece::whole::<T>(&tree.faces, face));
        let mut stack = vec![Pending { pieces: pieces.collect(), depth: 1, parent: None }];
        while let Some(Pending { pieces, depth, parent }) = stack.pop() {
            if pieces.is_empty() {
                continue;
            }
            let plane: RoundedPlane<T> = choose(&tree.faces, &pieces, epsilon);
            let (mut on, mut front, mut back) = (Vec::new(), Vec::new(), Vec::new());
            for piece in pieces {
                match plane.classify(&piece) {
                    Side::Coplanar => on.push(piece),
                    Side::Front => front.push(piece),
                    Side::Back => back.push(piece),
                    Side::Spanning => {
                        let [in_front, behind] = plane.split(&piece);
                        front.push(in_front);
                        back.push(behind);
                        tree.cuts += 1;
                    }
                }
            }
            if count + tree.cuts > max_fragments {
                return None;
            }
            // Coplanar pieces are painted in input order.
            on.sort_by_key(|piece| piece.face);
            let node = tree.push(plane.plane, depth, parent, &on);
            for (pieces, is_front) in [(back, false), (front, true)] {
                stack.push(Pending { pieces, depth: depth + 1, parent: Some((node, is_front)) });
            }
        }
        // A subtree ends where its last node ends.
        for node in (0..tree.nodes.len()).rev() {
            let Node { front, back, .. } = &tree.nodes[node];
            let last = match (front, back) {
                (_, &tree::Side::Node(last)) | (&tree::Side::Node(last), _) => last,
                _ => continue,
            };
            tree.nodes[node].all.end = tree.nodes[last].all.end;
        }
        Some(tree)
    }

    /// Appends a node with the pieces on its plane, and makes it its parent's child.
    fn push(
        &mut self,
        plane: PlaneId,
        depth: usize,
        parent: Option<(usize, bool)>,
        on: &[RoundedPiece],
    ) -> usize {
        let start = self.fragments.len() as u32;
        for piece in on {
            let vertices = self.vertices.len() as u32;
            self.fragments.push(Fragment { face: piece.face, start: vertices });
            if !piece.is_whole {
                self.vertices.extend_from_slice(&piece.vertices);
            }
        }
        let (node, end) = (self.nodes.len(), self.fragments.len() as u32);
        let nothing = || tree::Side::Leaf(end..end);
        self.nodes.push(Node {
            plane,
            depth,
            is_front: parent.is_some_and(|(_, is_front)| is_front),
            on: start..end,
            front: nothing(),
            back: nothing(),
            all: start..end,
        });
        if let Some((parent, is_front)) = parent {
            let Node { front, back, .. } = &mut self.nodes[parent];
            *(if is_front { front } else { back }) = tree::Side::Node(node);
        }
        node
    }
}

/// The best plane of a sample of the pieces' planes: few cuts, and sides of similar size.
fn choose<T: Precision>(faces: &Faces, pieces: &[RoundedPiece], epsilon: f64) -> RoundedPlane<T> {
    let count = CANDIDATES.min(pieces.len());
    let planes = (0..count).map(|i| {
        let face = pieces[i * pieces.len() / count].face;
        RoundedPlane::new(faces, face, epsilon)
    });
    let cost = |plane: &RoundedPlane<T>| {
        let [mut front, mut back, mut cuts] = [0usize; 3];
        for piece in pieces {
            match plane.classify(piece) {
                Side::Front => front += 1,
                Side::Back => back += 1,
                Side::Spanning => cuts += 1,
                Side::Coplanar => {}
            }
        }
        CUT * cuts + front.abs_diff(back)
    };
    planes.min_by_key(cost).expect("a piece")
}

/// On which side of a face's plane an eye lies, rounded.
fn eye_side<T: Precision>(faces: &Faces, plane: PlaneId, eye: &Eye) -> Ordering {
    let PlaneKind::Face(face) = plane.kind() else {
        unreachable!("only planes of faces are chosen")
    };
    let RoundedPlane { normal, offset, .. } = RoundedPlane::<T>::new(faces, face, 0.0);
    let (e, w) = eye.homogeneous();
    let distance = normal[0] * e[0] + normal[1] * e[1] + normal[2] * e[2] - w * offset;
    T::round(distance).total_cmp(&0.0)
}
