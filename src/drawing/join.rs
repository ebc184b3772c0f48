//! Joining pieces of polygons while an order of them is left.

use super::order::Pair;
use super::tile::VISITED;
use crate::Error;
use crate::progress::Watch;

/// Groups of nodes in an order that keeps all pairs: an order of a graph without cycles that stays one
/// while nodes are joined (D. J. Pearce, P. H. J. Kelly, "A dynamic topological sort algorithm for
/// directed acyclic graphs", 2006).
#[derive(Debug)]
pub(super) struct Groups {
    /// Nodes lead to the node that names their group.
    leader: Vec<u32>,
    /// The place of each group in the order.
    place: Vec<u32>,
    /// What has to come after each group, and before it: nodes of other groups, some more than once.
    after: Vec<Vec<u32>>,
    before: Vec<Vec<u32>>,
    /// In which search each group was met last.
    met: Vec<u64>,
    search: u64,
}

/// Searches of joins end after so many groups, and what they asked for is not joined. Larger: up to a sixth
/// fewer pieces in heaps of crossing polygons, and many times the time there; other scenes do not
/// notice.
const BUDGET: usize = 300;

#[derive(Clone, Copy)]
enum Way {
    After,
    Before,
}

impl Groups {
    /// Each node by itself, in the order of their numbers: of each pair, `below` is the lower number.
    pub(super) fn new(nodes: usize, pairs: impl Iterator<Item = Pair>) -> Self {
        let numbers: Vec<u32> = (0..nodes as u32).collect();
        let (mut after, mut before) = (vec![vec![]; nodes], vec![vec![]; nodes]);
        for Pair { below, above } in pairs {
            after[below as usize].push(above);
            before[above as usize].push(below);
        }
        Self {
            leader: numbers.clone(),
            place: numbers,
            after,
            before,
            met: vec![0; nodes],
            search: 0,
        }
    }

    /// The group of a node, by one of its nodes.
    pub(super) fn group(&mut self, node: u32) -> u32 {
        let mut at = node;
        while self.leader[at as usize] != at {
            let next = self.leader[at as usize];
            self.leader[at as usize] = self.leader[next as usize];
            at = next;
        }
        at
    }

    /// Makes one group of those of two nodes, if neither has to come before a third that has to come
    /// before the other, as far as a search of limited length can tell.
    pub(super) fn join(&mut self, a: u32, b: u32, watch: &Watch<'_>) -> Result<(), Error> {
        watch.work(VISITED)?;
        let [a, b] = [self.group(a), self.group(b)];
        if a == b {
            return Ok(());
        }
        let (a, b) = if self.place[a as usize] < self.place[b as usize] { (a, b) } else { (b, a) };
        if self.bring_together(a, b, BUDGET, watch)? {
            self.unite(a, b);
        }
        Ok(())
    }

    /// Adds a pair of nodes, unless `above` has to come before `below`. Whether it was added. The search has no
    /// limit: in a grid of 900 crossing triangles, that of joins would refuse a third of 39 000 pairs, nearly all
    /// of them in vain, and all searches take less than a sixtieth of the drawing's time.
    pub(super) fn add(&mut self, pair: Pair, watch: &Watch<'_>) -> Result<bool, Error> {
        watch.work(VISITED)?;
        let [below, above] = [self.group(pair.below), self.group(pair.above)];
        let is_in_order = self.place[below as usize] < self.place[above as usize];
        if below == above
            || !is_in_order && !self.bring_together(above, below, usize::MAX, watch)?
        {
            return Ok(false);
        }
        self.after[below as usize].push(above);
        self.before[above as usize].push(below);
        Ok(true)
    }

    /// Moves groups so that `b`, until now after `a`, is next before it, and all pairs are kept. Whether it did:
    /// not if these ask for `a` before `b`, or may, as far as a search can tell that ends after so many groups.
    fn bring_together(
        &mut self,
        a: u32,
        b: u32,
        most: usize,
        watch: &Watch<'_>,
    ) -> Result<bool, Error> {
        let Some(after) = self.reach([a, b], Way::After, most, watch)? else { return Ok(false) };
        let Some(before) = self.reach([b, a], Way::Before, most, watch)? else { return Ok(false) };
        // What has to come before keeps its order in the first of their places, then the two groups, then what
        // has to come after.
        let groups = [&before[..], &[b, a], &after[..]].concat();
        let mut places: Vec<u32> = groups.iter().map(|&group| self.place[group as usize]).collect();
        places.sort_unstable();
        for (&group, &place) in groups.iter().zip(&places) {
            self.place[group as usize] = place;
        }
        Ok(true)
    }

    /// The groups between two that are reached from the first, in their order; `None` if the second is
    /// one of them, or there are more than so many.
    fn reach(
        &mut self,
        [from, to]: [u32; 2],
        way: Way,
        most: usize,
        watch: &Watch<'_>,
    ) -> Result<Option<Vec<u32>>, Error> {
        self.search += 1;
        let end = self.place[to as usize];
        let mut found: Vec<u32> = vec![];
        let mut next = 0;
        let mut at = from;
        loop {
            let list = match way {
                Way::After => &mut self.after[at as usize],
                Way::Before => &mut self.before[at as usize],
            };
            let mut neighbours = std::mem::take(list);
            let mut is_met = false;
            watch.work(neighbours.len() * VISITED)?;
            for node in &mut neighbours {
                // Lists name groups, as they are now, so that the next search is shorter.
                *node = self.group(*node);
                let (group, place) = (*node as usize, self.place[*node as usize]);
                is_met |= *node == to;
                let is_between = match way {
                    Way::After => place < end,
                    Way::Before => place > end,
                };
                if is_between && self.met[group] != self.search {
                    self.met[group] = self.search;
                    found.push(*node);
                }
            }
            match way {
                Way::After => self.after[at as usize] = neighbours,
                Way::Before => self.before[at as usize] = neighbours,
            }
            if is_met || found.len() > most {
                return Ok(None);
            }
            let Some(&group) = found.get(next) else { break };
            (at, next) = (group, next + 1);
        }
        found.sort_unstable_by_key(|&group| self.place[group as usize]);
        Ok(Some(found))
    }

    fn unite(&mut self, a: u32, b: u32) {
        let place = self.place[a as usize];
        let degree =
            |group: u32| self.after[group as usize].len() + self.before[group as usize].len();
        let (large, small) = if degree(a) < degree(b) { (b, a) } else { (a, b) };
        self.leader[small as usize] = large;
        self.place[large as usize] = place;
        for lists in [&mut self.after, &mut self.before] {
            let mut moved = std::mem::take(&mut lists[small as usize]);
            let list = &mut lists[large as usize];
            list.append(&mut moved);
            list.sort_unstable();
            list.dedup();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    /// Whether one node leads to another by at least one of some pairs.
    fn leads(pairs: &[[u32; 2]], from: u32, to: u32) -> bool {
        let (mut met, mut stack) = (vec![], vec![from]);
        while let Some(node) = stack.pop() {
            for &[_, next] in pairs.iter().filter(|pair| pair[0] == node) {
                if !met.contains(&next) {
                    met.push(next);
                    stack.push(next);
                }
            }
        }
        met.contains(&to)
    }

    #[test]
    fn groups_are_joined_unless_that_closes_a_circle() {
        let mut random = SplitMix64::new(1);
        let (mut joined, mut refused) = (0, 0);
        for round in 0..300 {
            let nodes = 2 + round % 14;
            let mut below = |most: u64| (random.next() % most) as u32;
            let mut pairs = vec![];
            for above in 1..nodes as u32 {
                pairs.extend((0..below(4)).map(|_| Pair { below: below(above.into()), above }));
            }
            let mut groups = Groups::new(nodes, pairs.iter().copied());
            for _ in 0..3 * nodes {
                let [a, b] = [below(nodes as u64), below(nodes as u64)];
                let [one, other] = [groups.group(a), groups.group(b)];
                let mut between: Vec<[u32; 2]> = pairs
                    .iter()
                    .map(|pair| [groups.group(pair.below), groups.group(pair.above)])
                    .collect();
                between.retain(|pair| pair[0] != pair[1]);
                let closes = leads(&between, one, other) || leads(&between, other, one);
                groups.join(a, b, &Watch::default()).unwrap();
                assert_eq!(groups.group(a) == groups.group(b), one == other || !closes);
                *if closes { &mut refused } else { &mut joined } += usize::from(one != other);
                // Every pair is in order still.
                for pair in &pairs {
                    let [x, y] = [pair.below, pair.above].map(|node| groups.group(node) as usize);
                    assert!(x == y || groups.place[x] < groups.place[y]);
                }
            }
        }
        assert!(joined > 500 && refused > 500, "{joined} {refused}");
    }

    #[test]
    fn pairs_are_added_unless_they_close_a_circle() {
        let mut random = SplitMix64::new(2);
        let (mut added, mut moved, mut refused) = (0, 0, 0);
        for round in 0..300 {
            let nodes = 2 + round % 14;
            let mut below = |most: u64| (random.next() % most) as u32;
            let mut groups = Groups::new(nodes, std::iter::empty());
            let mut pairs: Vec<[u32; 2]> = vec![];
            for _ in 0..3 * nodes {
                let [a, b] = [below(nodes as u64), below(nodes as u64)];
                let closes = a == b || leads(&pairs, b, a);
                let is_moved = groups.place[a as usize] > groups.place[b as usize];
                let pair = Pair { below: a, above: b };
                assert_eq!(groups.add(pair, &Watch::default()).unwrap(), !closes);
                if closes {
                    refused += 1;
                    continue;
                }
                *if is_moved { &mut moved } else { &mut added } += 1;
                pairs.push([a, b]);
                for pair in &pairs {
                    let [x, y] = pair.map(|node| groups.place[node as usize]);
                    assert!(x < y);
                }
            }
        }
        assert!(added > 500 && moved > 500 && refused > 500, "{added} {moved} {refused}");
    }

    /// The search goes through all that lies between: more than it may.
    #[test]
    fn searches_end_at_their_budget() {
        for (between, expected) in [(BUDGET - 2, true), (BUDGET + 2, false)] {
            // The first comes before all but the last.
            let last = between as u32 + 1;
            let pairs: Vec<Pair> = (1..last).map(|above| Pair { below: 0, above }).collect();
            let mut groups = Groups::new(between + 2, pairs.into_iter());
            groups.join(0, last, &Watch::default()).unwrap();
            assert_eq!(groups.group(0) == groups.group(last), expected, "{between}");
        }
    }
}
