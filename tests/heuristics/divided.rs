//! The sets that a tree's nodes divided, cut again in exact rationals.

use binspace::Node;
use binspace::internals::{EdgeLine, PlaneKind};
use std::collections::HashMap;
use testkit::model::{Face, Vertex, clip};
use testkit::prelude::*;
use testkit::rational::Plane;

/// A piece of a face on its way down the tree.
#[derive(Clone)]
pub(super) struct Piece {
    pub(super) face: u32,
    pub(super) outline: Vec<Vertex>,
    /// The number of planes that cut the piece.
    pub(super) cuts: usize,
}

impl Piece {
    pub(super) fn values(&self, plane: &Plane) -> Vec<Rational> {
        self.outline.iter().map(|vertex| plane.at(&vertex.point)).collect()
    }

    /// The least and the largest coordinate along an axis.
    pub(super) fn span(&self, axis: usize) -> [&Rational; 2] {
        let all = || self.outline.iter().map(|vertex| &vertex.point[axis]);
        [all().min().expect("a vertex"), all().max().expect("a vertex")]
    }

    /// The corners of the face that are at an end of the piece along an axis.
    pub(super) fn ends(&self, exact: &Face, axis: usize) -> impl Iterator<Item = Rational> {
        let span = self.span(axis).map(Clone::clone);
        let is_corner = |c: &Rational| {
            exact.corners.iter().any(|corner| &corner[axis] == c && self.has(corner))
        };
        span.into_iter().filter(is_corner).collect::<Vec<_>>().into_iter()
    }

    pub(super) fn spans(&self, plane: &Plane) -> bool {
        let values = self.values(plane);
        let reaches = |side| values.iter().any(|value| rational::sign(value) == side);
        reaches(std::cmp::Ordering::Greater) && reaches(std::cmp::Ordering::Less)
    }

    /// The points where a plane meets the outline.
    pub(super) fn segment(&self, plane: &Plane) -> Vec<rational::Point> {
        let values = self.values(plane);
        let mut points = Vec::new();
        for (i, (here, at)) in self.outline.iter().zip(&values).enumerate() {
            let next = (i + 1) % values.len();
            let (side, next_side) = (rational::sign(at), rational::sign(&values[next]));
            if side.is_eq() {
                points.push(here.point.clone());
            } else if next_side == side.reverse() {
                let ends = [&here.point, &self.outline[next].point];
                points.push(rational::crossing(ends, [at, &values[next]]));
            }
        }
        points
    }

    pub(super) fn has(&self, corner: &rational::Point) -> bool {
        self.outline.iter().any(|vertex| &vertex.point == corner)
    }
}

/// The numbers of pieces in front of a plane, behind it, and across.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Counts {
    pub(super) front: usize,
    pub(super) back: usize,
    pub(super) splits: usize,
}

impl Counts {
    pub(super) fn of(plane: &Plane, set: &[Piece]) -> Self {
        set.iter().fold(Self::default(), |mut counts, piece| {
            let values = piece.values(plane);
            let reaches = |side| values.iter().any(|value| rational::sign(value) == side);
            match [reaches(std::cmp::Ordering::Greater), reaches(std::cmp::Ordering::Less)] {
                [true, true] => counts.splits += 1,
                [true, false] => counts.front += 1,
                [false, true] => counts.back += 1,
                [false, false] => {}
            }
            counts
        })
    }

    pub(super) fn imbalance(&self) -> f64 {
        self.front.abs_diff(self.back) as f64
    }

    /// Whether neither side nor the plane has all pieces.
    pub(super) fn separates(&self, pieces: usize) -> bool {
        let on_sides = [self.front + self.splits, self.back + self.splits];
        on_sides.iter().all(|&side| side < pieces) && on_sides != [0, 0]
    }

    /// The work left on both sides, which decides between planes with equal cuts.
    pub(super) fn work(&self) -> f64 {
        work(self.front + self.splits) + work(self.back + self.splits)
    }
}

pub(super) fn work(pieces: usize) -> f64 {
    (pieces as f64).powf(1.25)
}

/// A piece's own plane in a small set.
pub(super) struct Row {
    /// The work left on both sides.
    pub(super) work: f64,
    /// The work, less a reward for the planes that cut the piece.
    pub(super) amount: f64,
    /// The number of pieces that the plane cuts, and a share of those that the next planes may cut.
    pub(super) cuts: f64,
}

/// A node with the set that was divided there.
pub(super) struct Divided<'t> {
    pub(super) faces: &'t Faces,
    pub(super) exact: &'t [Face],
    /// The number of nodes above.
    pub(super) depth: usize,
    pub(super) plane: PlaneId,
    pub(super) counts: Counts,
    pub(super) set: Vec<Piece>,
}

impl Divided<'_> {
    pub(super) fn own_planes(&self) -> impl Iterator<Item = (Counts, bool)> {
        self.set.iter().map(|piece| {
            let plane = model::plane(self.faces, PlaneId::face(piece.face));
            let is_axial = (0..3).any(|axis| {
                let [low, high] = piece.span(axis);
                low == high
            });
            (Counts::of(&plane, &self.set), is_axial)
        })
    }

    /// How `auto` compares the pieces' own planes in a small set, and the mean share of the set that a plane cuts.
    pub(super) fn rows(&self) -> (Vec<Row>, f64) {
        let n = self.set.len();
        // For each plane, whether each piece reaches in front and behind.
        let sides: Vec<Vec<[bool; 2]>> = self
            .set
            .iter()
            .map(|own| {
                let plane = model::plane(self.faces, PlaneId::face(own.face));
                let reach = |piece: &Piece| {
                    let values = piece.values(&plane);
                    [std::cmp::Ordering::Greater, std::cmp::Ordering::Less]
                        .map(|side| values.iter().any(|value| rational::sign(value) == side))
                };
                self.set.iter().map(reach).collect()
            })
            .collect();
        let cuts = |plane: usize, piece: usize| sides[plane][piece] == [true; 2];
        let pairs = || (0..n).flat_map(|plane| (0..n).map(move |piece| (plane, piece)));
        let density =
            pairs().filter(|&(plane, piece)| cuts(plane, piece)).count() as f64 / (n * n) as f64;
        let weight = 0.5 * density / (density + 0.2) * 1.25 * (n as f64).powf(0.25);
        let row = |own: usize| {
            let on_side = [0, 1].map(|side| {
                (0..n).filter(|&piece| sides[own][piece][side]).collect::<Vec<usize>>()
            });
            let risk = (0..n).filter(|&plane| cuts(plane, own)).count();
            let next = on_side.iter().flat_map(|all| {
                all.iter().flat_map(|&plane| all.iter().map(move |&piece| (plane, piece)))
            });
            Row {
                amount: on_side.iter().map(|all| work(all.len())).sum::<f64>()
                    - weight * risk as f64,
                work: on_side.iter().map(|all| work(all.len())).sum(),
                cuts: (0..n).filter(|&piece| cuts(own, piece)).count() as f64
                    + 0.05 * next.filter(|&(plane, piece)| cuts(plane, piece)).count() as f64,
            }
        };
        ((0..n).map(row).collect(), density)
    }

    /// All planes perpendicular to an axis, through a corner where a piece ends, that separate pieces.
    pub(super) fn free_planes(&self) -> Vec<Counts> {
        let mut found = Vec::new();
        for axis in 0..3 {
            let ends = self.set.iter().flat_map(|p| p.ends(&self.exact[p.face as usize], axis));
            let mut ends: Vec<Rational> = ends.collect();
            ends.sort();
            ends.dedup();
            let spans: Vec<_> = self.set.iter().map(|piece| piece.span(axis)).collect();
            for at in ends {
                let counts = spans.iter().fold(Counts::default(), |mut counts, [low, high]| {
                    match [**high > at, **low < at] {
                        [true, true] => counts.splits += 1,
                        [true, false] => counts.front += 1,
                        [false, true] => counts.back += 1,
                        [false, false] => {}
                    }
                    counts
                });
                if counts.separates(self.set.len()) {
                    found.push(counts);
                }
            }
        }
        found
    }

    /// Whether the plane belongs to a piece that crosses all pieces that it cuts.
    pub(super) fn cuts_what_crosses(&self) -> bool {
        let PlaneKind::Face(face) = self.plane.kind() else { return false };
        let plane = model::plane(self.faces, self.plane);
        let cut: Vec<&Piece> = self.set.iter().filter(|piece| piece.spans(&plane)).collect();
        let own = self.set.iter().filter(|piece| piece.face == face);
        own.into_iter().any(|own| {
            cut.iter().all(|other| {
                let other_plane = model::plane(self.faces, PlaneId::face(other.face));
                let [here, there] = [own.segment(&other_plane), other.segment(&plane)];
                (0..3).all(|axis| {
                    let ends = |points: &[rational::Point]| {
                        let along = || points.iter().map(|point| point[axis].clone());
                        along().min().zip(along().max())
                    };
                    let (Some(a), Some(b)) = (ends(&here), ends(&there)) else { return false };
                    a.0 <= b.1 && b.0 <= a.1
                })
            })
        })
    }

    /// The score of the chosen plane, and the least score of the pieces' own planes.
    pub(super) fn scores(&self, score: impl Fn(&Counts, bool) -> f64) -> [f64; 2] {
        let PlaneKind::Face(face) = self.plane.kind() else { panic!("{:?} is free", self.plane) };
        let chosen = self.set.iter().zip(self.own_planes()).filter(|(piece, _)| piece.face == face);
        // If one of several pieces of a face is perpendicular to an axis, all of them are.
        let of_chosen = chosen.map(|(_, (counts, is_axial))| score(&counts, is_axial));
        let least = self.own_planes().map(|(counts, is_axial)| score(&counts, is_axial));
        [of_chosen.fold(f64::INFINITY, f64::min), least.fold(f64::INFINITY, f64::min)]
    }
}

/// All nodes of a tree that was built without a tolerance, with the sets divided there: cut again, in
/// rationals.
pub(super) fn nodes(tree: &BspTree, mut visit: impl FnMut(&Divided<'_>)) {
    let faces = tree.faces();
    assert_eq!(faces.tolerance(), 0.0);
    let exact: Vec<Face> = (0..faces.len() as u32).map(|face| Face::new(faces, face)).collect();
    let named: HashMap<_, Node<'_>> =
        tree.nodes().map(|node| ((node.depth(), node.fragments()), node)).collect();
    let whole = |face: u32| Piece { face, outline: exact[face as usize].outline(), cuts: 0 };
    let all = (0..faces.len() as u32).map(whole).collect();
    let mut pending: Vec<(_, Vec<Piece>)> = vec![((1, 0..tree.len() as u32), all)];
    let mut seen = 0;
    while let Some((at, set)) = pending.pop() {
        let Some(node) = named.get(&at) else {
            assert_eq!((at.1.len(), set.len()), (1, 1), "no node divides {at:?}");
            continue;
        };
        seen += 1;
        let plane = model::plane(faces, node.plane());
        let sides = divided(&set, node.plane(), &plane);
        let found = sides.each_ref().map(Vec::len);
        assert_eq!(found[0], node.on().len(), "on {:?}", node.plane());
        let counts = Counts::of(&plane, &set);
        let depth = node.depth() - 1;
        visit(&Divided { faces, exact: &exact, depth, plane: node.plane(), counts, set });
        let [_, front, back] = sides;
        for (range, set) in [(node.in_front(), front), (node.behind(), back)] {
            assert_eq!(range.is_empty(), set.is_empty());
            if !set.is_empty() {
                pending.push(((at.0 + 1, range), set));
            }
        }
    }
    assert_eq!(seen, named.len(), "nodes that no path leads to");
}

/// The parts of a set on a plane, in front, and behind.
pub(super) fn divided(set: &[Piece], id: PlaneId, plane: &Plane) -> [Vec<Piece>; 3] {
    let mut sides = [vec![], vec![], vec![]];
    for piece in set {
        let values = piece.values(plane);
        let reaches = |side| values.iter().any(|value| rational::sign(value) == side);
        let (in_front, behind) =
            (reaches(std::cmp::Ordering::Greater), reaches(std::cmp::Ordering::Less));
        match (in_front, behind) {
            (false, false) => sides[0].push(piece.clone()),
            (true, false) => sides[1].push(piece.clone()),
            (false, true) => sides[2].push(piece.clone()),
            (true, true) => {
                for (side, behind) in [(1, false), (2, true)] {
                    let outline: Vec<Vertex> = clip(&piece.outline, &values, id, behind);
                    assert!(outline.iter().any(|v| v.line == EdgeLine::cut(id, behind)));
                    sides[side].push(Piece { face: piece.face, outline, cuts: piece.cuts + 1 });
                }
            }
        }
    }
    sides
}
