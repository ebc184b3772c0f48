//! Orders of trees of every shape, compared with a walk that does not use parts.

use crate::exact::PlaneId;
use crate::random::SplitMix64;
use crate::tree::node::{NodeRecord, finish};
use crate::tree::order::{OrderLayout, ROOT, write_order};
use crate::tree::parts::{RawChild, RawNode};

/// A node: the number of fragments on the node's plane, and the front and back sides of the plane.
#[derive(Clone, Debug)]
struct Tree {
    own: u32,
    sides: [Side; 2],
}

#[derive(Clone, Debug)]
enum Side {
    Leaf(u32),
    Below(Box<Tree>),
}

use Side::{Below, Leaf};

impl Tree {
    fn new(own: u32, front: Side, back: Side) -> Self {
        Self { own, sides: [front, back] }
    }

    /// One fragment on the plane, and all others on one side.
    fn link(rest: Self, rest_is_front: bool) -> Self {
        let (rest, nothing) = (Below(Box::new(rest)), Leaf(0));
        if rest_is_front { Self::new(1, rest, nothing) } else { Self::new(1, nothing, rest) }
    }

    fn fragments(&self) -> u32 {
        self.own + self.sides.iter().map(Side::fragments).sum::<u32>()
    }

    /// Appends the nodes of the tree, depth first, the front before the back.
    fn lay(&self, nodes: &mut Vec<RawNode>) {
        let [front, back] = self.sides.each_ref().map(|side| match side {
            Leaf(fragments) => RawChild::Leaf(*fragments),
            Below(_) => RawChild::Node,
        });
        nodes.push(RawNode { plane: PlaneId::face(0), own: self.own, front, back });
        for side in &self.sides {
            if let Below(tree) = side {
                tree.lay(nodes);
            }
        }
    }

    fn nodes(&self) -> Vec<NodeRecord> {
        let mut nodes = Vec::new();
        self.lay(&mut nodes);
        let mut finished = Vec::new();
        finish(nodes.iter().copied(), &mut Vec::new(), &mut finished);
        finished
    }

    /// The order from the first node and fragment that are not counted yet: the far side, the plane, the near
    /// side. Leaves are numbered before subtrees.
    fn order(&self, signs: &[u32], node: &mut usize, next: &mut u32) -> Vec<u32> {
        let is_in_front = signs[*node / 32] >> (*node % 32) & 1 == 1;
        *node += 1;
        let mut take = |fragments: u32| -> Vec<u32> {
            *next += fragments;
            (*next - fragments..*next).collect()
        };
        let own = take(self.own);
        let leaves = self.sides.each_ref().map(|side| match side {
            Leaf(fragments) => take(*fragments),
            Below(_) => Vec::new(),
        });
        let mut parts = self.sides.iter().zip(leaves).map(|(side, leaf)| match side {
            Leaf(_) => leaf,
            Below(tree) => tree.order(signs, node, next),
        });
        let (front, back) = (parts.next().unwrap(), parts.next().unwrap());
        if is_in_front { [back, own, front].concat() } else { [front, own, back].concat() }
    }
}

impl Side {
    fn fragments(&self) -> u32 {
        match self {
            Leaf(fragments) => *fragments,
            Below(tree) => tree.fragments(),
        }
    }
}

/// A tree, and the data for comparing the written orders of the tree with the walk.
struct Checker<'a> {
    tree: &'a Tree,
    nodes: usize,
    fragments: u32,
    layout: OrderLayout,
    buffer: Vec<u32>,
}

impl<'a> Checker<'a> {
    fn new(tree: &'a Tree) -> Self {
        let (nodes, fragments) = (tree.nodes(), tree.fragments());
        let layout = OrderLayout::new(&nodes, fragments).unwrap();
        let parts = layout.parts() - ROOT as usize;
        assert!(parts < 2 * fragments as usize, "{parts} parts of {tree:?}");
        Self { tree, nodes: nodes.len(), fragments, layout, buffer: vec![] }
    }

    fn words(&self) -> usize {
        self.nodes.div_ceil(32) + 1
    }

    fn check(&mut self, signs: &[u32]) {
        let expected = self.tree.order(signs, &mut 0, &mut 0);
        let (words, fragments) = (self.words(), self.fragments as usize);
        for junk in [0, 4 * fragments + 40] {
            self.buffer.clear();
            self.buffer.resize(junk, u32::MAX);
            let write = |words: &mut [u32]| words.copy_from_slice(signs);
            write_order(&self.layout, fragments, words, &mut self.buffer, write);
            assert_eq!(self.buffer, expected, "{:?} by {signs:?}", self.tree);
        }
    }

    fn check_some(&mut self, random: &mut SplitMix64, count: usize) {
        let words = self.words();
        self.check(&vec![0; words]);
        self.check(&vec![u32::MAX; words]);
        for _ in 0..count {
            self.check(&(0..words).map(|_| random.next() as u32).collect::<Vec<_>>());
        }
    }
}

/// All trees of `fragments` fragments, at least one. Each node has fragments on its plane or on both sides of
/// the plane.
fn trees(fragments: u32) -> Vec<Tree> {
    let mut all = Vec::new();
    for own in 0..=fragments {
        for front in 0..=fragments - own {
            let back = fragments - own - front;
            if own == 0 && (front == 0 || back == 0) {
                continue;
            }
            let backs = sides(back);
            for front in sides(front) {
                all.extend(backs.iter().map(|back| Tree::new(own, front.clone(), back.clone())));
            }
        }
    }
    all
}

fn sides(fragments: u32) -> Vec<Side> {
    let below = if fragments > 0 { trees(fragments) } else { vec![] };
    let below = below.into_iter().map(|tree| Below(Box::new(tree)));
    std::iter::once(Leaf(fragments)).chain(below).collect()
}

#[test]
fn without_a_node_there_is_nothing_to_order() {
    let mut order = vec![u32::MAX; 50];
    write_order(&OrderLayout::new(&[], 0).unwrap(), 0, 1, &mut order, |_| ());
    assert!(order.is_empty());
}

#[test]
fn trees_of_up_to_five_fragments_come_by_every_sign() {
    let mut counts = Vec::new();
    for fragments in 1..=5 {
        let trees = trees(fragments);
        for tree in &trees {
            let mut checker = Checker::new(tree);
            (0..1 << checker.nodes).for_each(|signs| checker.check(&[signs, 0]));
        }
        counts.push(trees.len());
    }
    assert_eq!(counts, [1, 9, 69, 589, 5529]);
}

/// Subtrees that may lie below a list: spans on a plane, on one side of a plane and on both sides, and blocks
/// of every size.
fn rests() -> Vec<Tree> {
    let run = Tree::new(7, Leaf(0), Leaf(0));
    let mut rests = vec![
        run.clone(),
        Tree::new(1, Leaf(6), Leaf(0)),
        Tree::new(0, Leaf(5), Leaf(9)),
        Tree::new(2, Below(Box::new(run.clone())), Leaf(3)),
        Tree::new(1, Below(Box::new(run.clone())), Below(Box::new(run))),
    ];
    rests.extend((2..=3).flat_map(trees));
    rests.extend(trees(4).into_iter().step_by(17));
    rests
}

fn list(rest: Tree, nodes: usize, rest_is_front: bool) -> Tree {
    (0..nodes).fold(rest, |rest, _| Tree::link(rest, rest_is_front))
}

#[test]
fn chains_of_any_length_are_followed_by_blocks_and_spans() {
    let mut random = SplitMix64::new(1);
    for rest in rests() {
        for nodes in [1, 2, 6, 7, 8, 9, 15, 31, 32, 33, 70] {
            for is_front in [false, true] {
                Checker::new(&list(rest.clone(), nodes, is_front)).check_some(&mut random, 3);
            }
        }
    }
}

/// Nodes that have one fragment too many or too few to be links, with lists above and below them.
#[test]
fn nodes_that_are_hardly_links_are_ordered_as_well() {
    let mut random = SplitMix64::new(5);
    for (own, beside) in [(0, 1), (1, 1), (2, 0), (1, 2), (2, 1)] {
        for is_front in [false, true] {
            let next_to = |rest: Tree| {
                let (rest, leaf) = (Below(Box::new(rest)), Leaf(beside));
                let [front, back] = if is_front { [rest, leaf] } else { [leaf, rest] };
                Tree::new(own, front, back)
            };
            for (above, nodes, below) in [(0, 12, 0), (0, 1, 12), (12, 1, 12), (9, 9, 9)] {
                let rest = list(Tree::new(3, Leaf(2), Leaf(1)), below, is_front);
                let rest = (0..nodes).fold(rest, |rest, _| next_to(rest));
                Checker::new(&list(rest, above, is_front)).check_some(&mut random, 5);
            }
        }
    }
}

#[test]
fn lists_follow_lists_and_stand_on_both_sides_of_a_branch() {
    let mut random = SplitMix64::new(2);
    let rests = rests();
    for (i, rest) in rests.iter().enumerate() {
        let other = &rests[(i + 7) % rests.len()];
        for (a, b) in [(8, 8), (9, 3), (3, 20), (12, 33)] {
            for sides in 0..4 {
                let [first, second] = [0, 1].map(|bit| sides >> bit & 1 == 1);
                let two = list(list(rest.clone(), a, first), b, second);
                let beside = list(other.clone(), a, second);
                for own in 0..7 {
                    let [front, back] = [&two, &beside].map(|tree| Below(Box::new(tree.clone())));
                    Checker::new(&Tree::new(own, front, back)).check_some(&mut random, 1);
                }
                Checker::new(&two).check_some(&mut random, 3);
            }
        }
    }
}

/// A tree of `fragments` fragments, divided at random.
fn some_tree(fragments: u32, random: &mut SplitMix64) -> Tree {
    let mut below = |limit: u32| (random.next() % u64::from(limit + 1)) as u32;
    let own = match below(5) {
        0 if fragments > 1 => 0,
        1 => 1 + below(fragments.min(12) - 1),
        _ => 1,
    };
    let rest = fragments - own;
    let front = match below(4) {
        _ if own == 0 => 1 + below(rest - 2),
        0 => 0,
        1 => rest,
        _ => below(rest),
    };
    let mut side = |fragments: u32| match fragments {
        0 | 1 => Leaf(fragments),
        2..12 if random.next().is_multiple_of(8) => Leaf(fragments),
        _ => Below(Box::new(some_tree(fragments, random))),
    };
    Tree::new(own, side(front), side(rest - front))
}

#[test]
fn trees_by_chance_come_by_any_signs() {
    let mut random = SplitMix64::new(3);
    for round in 0..3000 {
        let tree = some_tree(1 + round % 150, &mut random);
        Checker::new(&tree).check_some(&mut random, 2);
    }
}

/// No fragment lies on a plane, and each plane has a single fragment on one side. So each node makes an inner
/// node and a block.
#[test]
fn the_most_parts_are_nearly_two_to_a_fragment() {
    let mut tree = Tree::new(0, Leaf(1), Leaf(1));
    for _ in 0..98 {
        tree = Tree::new(0, Leaf(1), Below(Box::new(tree)));
    }
    let parts = OrderLayout::new(&tree.nodes(), 100).unwrap().parts() - ROOT as usize;
    assert_eq!(parts, 2 * 100 - 7);
    Checker::new(&tree).check_some(&mut SplitMix64::new(4), 20);
}
