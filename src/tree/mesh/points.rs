//! Which nodes are the same point, and in which order the points of each line come.

#[cfg(test)]
mod tests;

use std::cmp::Ordering;
use std::collections::HashMap;

use super::survey::{Node, Survey, ends};
use crate::Error;
use crate::exact::vertex::Fraction;
use crate::exact::{POSITION_OFF, Symbol, SymbolKind};
use crate::memory::reserve;
use crate::union::Union;

/// Rounded coordinates that differ by more than this share of the larger, and by [`POSITION_OFF`]
/// for both, are in their true order: each is off by three roundings of its own size at most, and
/// the difference by one. Smaller: wrong orders; larger: more work for the integers.
const ERROR: f64 = 5.0 * f64::EPSILON;

/// The points of all lines.
pub(super) struct Points {
    /// Which nodes are the same point.
    same: Union,
    /// A node of each point, line after line, in order along each.
    pub(super) on_lines: Vec<Node>,
    /// For each edge, the places of its two ends in `on_lines`.
    pub(super) ends: Vec<[u32; 2]>,
}

/// An end of an edge, on the edge's line.
#[derive(Clone, Copy, Default)]
struct End {
    node: Node,
    /// The edge, doubled, and 1 for its second end.
    slot: u32,
    rounded: f64,
}

impl Points {
    pub(super) fn new(survey: &Survey<'_>) -> Result<Self, Error> {
        let same = Union::new(survey.nodes() as u32)?;
        let mut points = Self { same, on_lines: Vec::new(), ends: Vec::new() };
        points.unite_corners(survey)?;
        let (mut all, starts) = by_line(survey)?;
        reserve(&mut points.ends, survey.edges.len())?;
        points.ends.resize(survey.edges.len(), [0; 2]);
        reserve(&mut points.on_lines, all.len() / 2)?;
        // Lines that faces share come first: where corners were moved onto their planes, an edge as
        // given decides, not one of its faces.
        for shared in [true, false] {
            for (line, range) in starts.windows(2).enumerate() {
                if survey.carriers[line].face.is_none() == shared {
                    let ends = &mut all[range[0] as usize..range[1] as usize];
                    points.order(survey, line, ends)?;
                }
            }
        }
        Ok(points)
    }

    /// The node that names a node's point: the least, a corner if there is one.
    pub(super) fn root(&self, node: Node) -> Node {
        self.same.root(node)
    }

    fn unite_corners(&mut self, survey: &Survey<'_>) -> Result<(), Error> {
        let faces = &survey.tree.faces;
        let mut known: HashMap<[u64; 3], Node> = HashMap::new();
        known.try_reserve(faces.corner_count() / 4).map_err(|_| Error::out_of_memory())?;
        for corner in faces.corners_of_cell() as u32..faces.corner_count() as u32 {
            let place = faces.given_corner(corner).map(f64::to_bits);
            known.try_reserve(1).map_err(|_| Error::out_of_memory())?;
            self.same.unite(*known.entry(place).or_insert(corner), corner);
        }
        Ok(())
    }

    /// Sorts the ends on one line, unites those in one place, and notes the places.
    fn order(&mut self, survey: &Survey<'_>, line: usize, ends: &mut [End]) -> Result<(), Error> {
        ends.sort_unstable_by(|a, b| compare(survey, line, a, b));
        reserve(&mut self.on_lines, ends.len())?;
        let mut last: Option<End> = None;
        // What the edges as given have made one point may have two places on a line of a face whose corners
        // were moved.
        let is_one = |same: &Union, a: &End, b: &End| {
            same.root(a.node) == same.root(b.node) || compare(survey, line, a, b).is_eq()
        };
        for end in ends.iter() {
            match last {
                Some(last) if is_one(&self.same, &last, end) => {
                    self.same.unite(last.node, end.node);
                }
                _ => self.on_lines.push(end.node),
            }
            last = Some(*end);
            let place = self.on_lines.len() as u32 - 1;
            self.ends[end.slot as usize / 2][end.slot as usize % 2] = place;
        }
        Ok(())
    }
}

/// How two ends on a line compare: as their [`coordinate`]s there do, whatever is known of their points. So
/// it is a total order.
fn compare(survey: &Survey<'_>, line: usize, a: &End, b: &End) -> Ordering {
    let slack = ERROR * a.rounded.abs().max(b.rounded.abs()) + 2.0 * POSITION_OFF;
    // A rounded coordinate that is not to be relied on is NaN, and then no difference is large.
    if (a.rounded - b.rounded).abs() > slack {
        return a.rounded.total_cmp(&b.rounded);
    }
    if a.node == b.node || is_same_place(survey, line, a, b) {
        return Ordering::Equal;
    }
    let [a, b] = [a, b].map(|end| coordinate(survey, line, end.node));
    a.compare(&b)
}

/// Whether two ends on a line that faces share are corners given there in one place, or where the same
/// plane cuts it.
fn is_same_place(survey: &Survey<'_>, line: usize, a: &End, b: &End) -> bool {
    let plane = |(face, symbol): (u32, Symbol)| match symbol.kind() {
        SymbolKind::OnEdge(_, plane) if !is_moved(survey, face) => Some(plane),
        _ => None,
    };
    survey.carriers[line].face.is_none()
        && match [a, b].map(|end| survey.cut(end.node)) {
            [None, None] => a.rounded == b.rounded,
            [Some(a), Some(b)] => plane(a).is_some() && plane(a) == plane(b),
            _ => false,
        }
}

fn is_moved(survey: &Survey<'_>, face: u32) -> bool {
    survey.tree.faces.upright_axis(face).is_some()
}

/// The coordinate of a node on a line, along the line's axis.
///
/// On the line of an edge as given, it is that of a corner as given, or of the place where the plane
/// cuts the edge as given, so that all faces agree; on a line inside a face, that of the vertex on
/// the face's plane.
pub(super) fn coordinate(survey: &Survey<'_>, line: usize, node: Node) -> Fraction {
    let (faces, carrier) = (&survey.tree.faces, survey.carriers[line]);
    match (survey.cut(node), carrier.face) {
        (None, None) => Fraction::whole(faces.given_corner(node)[carrier.axis]),
        (None, Some(face)) => {
            let first = faces.corner_range(face).start as u32;
            faces.along(face, Symbol::corner(node - first), carrier.axis)
        }
        (Some((face, symbol)), None) => {
            let given = match symbol.kind() {
                SymbolKind::OnEdge(k, plane) => faces.cut_of_segment(ends(faces, face, k), plane),
                _ => None,
            };
            // The plane may cut the edge as moved and not as given; then the former decides.
            given.map_or_else(
                || faces.along(face, symbol, carrier.axis),
                |cut| cut.along(carrier.axis),
            )
        }
        (Some((face, symbol)), Some(_)) => faces.along(face, symbol, carrier.axis),
    }
}

/// The ends of all edges, line by line, and where each line's begin.
fn by_line(survey: &Survey<'_>) -> Result<(Vec<End>, Vec<u32>), Error> {
    let mut starts = Vec::new();
    reserve(&mut starts, survey.carriers.len() + 1)?;
    starts.resize(survey.carriers.len() + 1, 0_u32);
    survey.edges.iter().for_each(|edge| starts[edge.carrier as usize] += 2);
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    let mut all = Vec::new();
    reserve(&mut all, 2 * survey.edges.len())?;
    all.resize(2 * survey.edges.len(), End::default());
    let places = rounded_places(survey)?;
    let faces = &survey.tree.faces;
    for range in survey.starts.windows(2) {
        let edges = &survey.edges[range[0] as usize..range[1] as usize];
        for (i, edge) in edges.iter().enumerate() {
            let carrier = survey.carriers[edge.carrier as usize];
            let to = edges[if i + 1 == edges.len() { 0 } else { i + 1 }].from;
            for (node, second) in [(edge.from, 0), (to, 1)] {
                let rounded = match survey.cut(node) {
                    None if carrier.face.is_none() => faces.given_corner(node)[carrier.axis],
                    None => faces.corner(node)[carrier.axis],
                    Some(_) => places[node as usize - faces.corner_count()][carrier.axis],
                };
                let moved = match (survey.cut(node), carrier.face) {
                    (Some((face, _)), _) | (None, Some(face)) => is_moved(survey, face),
                    (None, None) => false,
                };
                let rounded = if moved { f64::NAN } else { rounded };
                let start = &mut starts[edge.carrier as usize];
                *start -= 1;
                let slot = 2 * (range[0] + i as u32) + second;
                all[*start as usize] = End { node, slot, rounded };
            }
        }
    }
    Ok((all, starts))
}

/// The rounded places of the cuts on their faces.
fn rounded_places(survey: &Survey<'_>) -> Result<Vec<[f64; 3]>, Error> {
    let mut places = Vec::new();
    reserve(&mut places, survey.cuts.len())?;
    let faces = &survey.tree.faces;
    places.extend(survey.cuts.iter().map(|&(face, symbol)| faces.position(face, symbol)));
    Ok(places)
}
