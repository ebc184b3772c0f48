//! Lists the edges of all fragments: between which nodes they run, and along which line.

use std::collections::HashMap;

use super::lines::{Carrier, Lines};
use crate::error::{Error, Limit};
use crate::exact::{Faces, PlaneId, Symbol, SymbolKind};
use crate::memory::{empty, reserve};
use crate::tree::BspTree;

/// A vertex as one face names it: a corner, or where planes cut the face. The first nodes are the
/// corners of all faces, the others [`Survey::cuts`].
pub(super) type Node = u32;

/// An edge of a fragment. It ends where the fragment's next edge begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct FragmentEdge {
    pub(super) carrier: u32,
    pub(super) from: Node,
}

/// The edges of all fragments, face by face.
pub(super) struct Survey<'t> {
    pub(super) tree: &'t BspTree,
    /// The numbers of all fragments, face by face.
    pub(super) fragments: Vec<u32>,
    /// Where the edges of each of `fragments` begin, and the end of the last.
    pub(super) starts: Vec<u32>,
    pub(super) edges: Vec<FragmentEdge>,
    /// Nodes that are no corners: a face, and the vertex on it.
    pub(super) cuts: Vec<(u32, Symbol)>,
    pub(super) carriers: Vec<Carrier>,
}

impl<'t> Survey<'t> {
    pub(super) fn new(tree: &'t BspTree) -> Result<Self, Error> {
        let fragments = by_face(tree)?;
        let (starts, edges) = (Vec::new(), Vec::new());
        let mut survey =
            Self { tree, fragments, starts, edges, cuts: Vec::new(), carriers: Vec::new() };
        let edges = tree.fragments().map(|fragment| fragment.vertex_count()).sum();
        u32::try_from(2 * edges).map_err(|_| Limit::Indices.error())?;
        reserve(&mut survey.edges, edges)?;
        reserve(&mut survey.starts, tree.len() + 1)?;
        let mut names = Names::default();
        for at in 0..survey.fragments.len() {
            let fragment = tree.fragment(survey.fragments[at]);
            names.enter(&tree.faces, fragment.face())?;
            survey.make_room(&mut names, fragment.vertex_count())?;
            survey.starts.push(survey.edges.len() as u32);
            for (symbol, line) in fragment.symbols().zip(fragment.lines()) {
                let from = survey.node(&mut names, symbol);
                let carrier = match line.as_cut() {
                    Some(plane) => survey.carrier_of_cut(&mut names, plane),
                    None => survey.carrier_of_edge(&mut names, line.as_edge().unwrap_or(0)),
                };
                survey.edges.push(FragmentEdge { carrier, from });
            }
        }
        survey.starts.push(survey.edges.len() as u32);
        Ok(survey)
    }

    /// Makes room for a fragment with so many vertices, whatever is new of it.
    fn make_room(&mut self, names: &mut Names, vertices: usize) -> Result<(), Error> {
        reserve(&mut self.cuts, vertices)?;
        reserve(&mut self.carriers, vertices)?;
        let rooms = [
            names.symbols.try_reserve(vertices),
            names.planes.try_reserve(vertices),
            names.lines.try_reserve(vertices),
        ];
        rooms.into_iter().collect::<Result<(), _>>().map_err(|_| Error::out_of_memory())
    }

    fn node(&mut self, names: &mut Names, symbol: Symbol) -> Node {
        if let SymbolKind::Corner(k) = symbol.kind() {
            return names.first_corner + k;
        }
        let corners = self.tree.faces.corner_count();
        *names.symbols.entry(symbol).or_insert_with(|| {
            self.cuts.push((names.face, symbol));
            (corners + self.cuts.len() - 1) as u32
        })
    }

    fn carrier_of_cut(&mut self, names: &mut Names, plane: PlaneId) -> u32 {
        *names.planes.entry(plane).or_insert_with(|| {
            let axis = self.tree.faces.axis_of_cut(names.face, plane);
            self.carriers.push(Carrier { axis, face: Some(names.face) });
            self.carriers.len() as u32 - 1
        })
    }

    fn carrier_of_edge(&mut self, names: &mut Names, k: u32) -> u32 {
        let known = &mut names.edges[k as usize];
        *known.get_or_insert_with(|| {
            let ends = ends(&self.tree.faces, names.face, k);
            names.lines.number(ends, &mut self.carriers)
        })
    }

    /// Which face and vertex a node is, unless it is a corner.
    pub(super) fn cut(&self, node: Node) -> Option<(u32, Symbol)> {
        let at = (node as usize).checked_sub(self.tree.faces.corner_count())?;
        self.cuts.get(at).copied()
    }

    /// How many nodes there are.
    pub(super) fn nodes(&self) -> usize {
        self.tree.faces.corner_count() + self.cuts.len()
    }
}

/// The ends of a face's edge, as they were given.
pub(super) fn ends(faces: &Faces, face: u32, k: u32) -> [[f64; 3]; 2] {
    let range = faces.corner_range(face);
    let next = if k as usize + 1 == range.len() { 0 } else { k + 1 };
    [k, next].map(|k| faces.given_corner(range.start as u32 + k))
}

/// What has a number already, on the current face; lines on any face.
#[derive(Default)]
struct Names {
    face: u32,
    first_corner: u32,
    symbols: HashMap<Symbol, Node>,
    planes: HashMap<PlaneId, u32>,
    edges: Vec<Option<u32>>,
    lines: Lines,
}

impl Names {
    fn enter(&mut self, faces: &Faces, face: u32) -> Result<(), Error> {
        if face == self.face && !self.edges.is_empty() {
            return Ok(());
        }
        let corners = faces.corner_range(face);
        (self.face, self.first_corner) = (face, corners.start as u32);
        empty(&mut self.symbols);
        empty(&mut self.planes);
        self.edges.clear();
        reserve(&mut self.edges, corners.len())?;
        self.edges.resize(corners.len(), None);
        Ok(())
    }
}

/// The numbers of all fragments, face by face.
fn by_face(tree: &BspTree) -> Result<Vec<u32>, Error> {
    let mut ends = Vec::new();
    reserve(&mut ends, tree.faces.len())?;
    ends.resize(tree.faces.len(), 0_u32);
    tree.records.iter().for_each(|record| ends[record.face as usize] += 1);
    let mut sum = 0;
    for end in &mut ends {
        sum += *end;
        *end = sum;
    }
    let mut fragments = Vec::new();
    reserve(&mut fragments, tree.len())?;
    fragments.resize(tree.len(), 0);
    for (number, record) in tree.records.iter().enumerate().rev() {
        let end = &mut ends[record.face as usize];
        *end -= 1;
        fragments[*end as usize] = number as u32;
    }
    Ok(fragments)
}

#[cfg(test)]
mod tests {
    use super::{BspTree, Names, PlaneId, Symbol};
    use crate::exact::Line;

    #[test]
    fn a_face_cut_very_often_costs_the_faces_after_it_nothing() {
        let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
        let tree = BspTree::build([0.0, 1.0, 2.0].map(square)).unwrap();
        let mut names = Names::default();
        names.enter(&tree.faces, 0).unwrap();
        for k in 0..100_000 {
            let plane = PlaneId::face(k);
            names.symbols.insert(Symbol::crossing(Line::edge(0), plane), k);
            names.planes.insert(plane, k);
        }
        // The first face after it still pays for the entries.
        (1..3).for_each(|face| names.enter(&tree.faces, face).unwrap());
        let room = names.symbols.capacity() + names.planes.capacity();
        assert!(room < 1000, "room for {room} names is emptied for each face");
    }
}
