//! Tiles in which one sheet of faces is visible, so that nothing has to be subtracted.
//!
//! Let S be the faces that are connected, over shared edges, with the face of the tile's first item. An edge is
//! shared if exactly two opaque faces have it, and lie on opposite sides of it in the picture. If no other edge
//! of S crosses the tile, each point of the tile lies in the same number of faces of S, because this number
//! changes only at edges that are not shared. So if one point lies in one face, S covers the tile exactly once.
//! If also no item outside S is in front of an item of S, then S is what the tile shows.

use super::cell::{Rect, are_apart, common, is_empty};
use super::lines::HalfPlane;
use super::primitives::FEW_CORNERS;
use super::quadtree::{Across, CUT, Candidate, Leaf, TileList, VISITED, Visible};
use crate::Error;
use crate::progress::Watch;

/// A tile, and the sheet that the tile shows, if a search found one.
pub(super) struct MapTile<'p> {
    pub(super) list: TileList<'p>,
    /// The indices of the sheet's items in the list.
    sheet: Option<Vec<u32>>,
    /// An edge that ended the search in this tile or in a larger one.
    contour: Option<Contour>,
}

/// An edge that is not shared, and a box around it.
#[derive(Clone, Copy)]
struct Contour {
    half: HalfPlane,
    around: Rect,
}

/// The result of a search for a sheet.
enum Found {
    Sheet(Vec<u32>),
    Contour(Contour),
    Nothing,
}

/// Pairs of items that are compared for each item of a list. Too small: sheets are missed where other items lie
/// behind them, in front of other parts of the sheet. Too large: comparing takes longer than subtracting.
const COMPARED: usize = 32;

impl<'p> MapTile<'p> {
    /// The whole picture.
    pub(super) fn picture(list: TileList<'p>, watch: &Watch<'_>) -> Result<Self, Error> {
        Self::new(list, None, watch)
    }

    /// A tile in a larger one whose search ended at `contour`.
    fn new(list: TileList<'p>, contour: Option<Contour>, watch: &Watch<'_>) -> Result<Self, Error> {
        let lines = &list.candidates.primitives.lines;
        let sides = list.tile.sides();
        let crosses = |Contour { half, around }: &Contour| {
            !are_apart(around, &sides) && lines.across(*half, &sides) == Across::Maybe
        };
        let contour = contour.filter(crosses);
        // The sheet in a smaller tile may begin with another face.
        if contour.is_some() && !list.is_short() {
            return Ok(Self { list, sheet: None, contour });
        }
        let (sheet, contour) = match list.sheet(watch)? {
            Found::Sheet(sheet) => (Some(sheet), None),
            Found::Contour(contour) => (None, Some(contour)),
            Found::Nothing => (None, None),
        };
        Ok(Self { list, sheet, contour })
    }

    /// Whether the tile's visible parts can be found without division.
    pub(super) fn is_settled(&self) -> bool {
        self.sheet.is_some() || self.list.is_short()
    }

    /// The two halves of the tile.
    pub(super) fn halves(&self, watch: &Watch<'_>) -> Result<[Self; 2], Error> {
        let [first, second] = self.list.halves(watch)?;
        Ok([Self::new(first, self.contour, watch)?, Self::new(second, self.contour, watch)?])
    }

    /// Computes the visible parts of items in the tile.
    pub(super) fn leaf(&self, watch: &Watch<'_>) -> Result<Leaf, Error> {
        let Some(sheet) = &self.sheet else { return Leaf::new(&self.list, watch) };
        let TileList { tile, candidates, .. } = &self.list;
        let primitives = candidates.primitives;
        let (whole, sides) = (tile.cell(&primitives.lines), tile.sides());
        let mut cells = Vec::with_capacity(sheet.len());
        for &index in sheet {
            watch.work(CUT)?;
            let candidate = &candidates.list[index as usize];
            let item = candidate.number;
            let inside = match primitives.is_whole(item) {
                true => primitives.whole_in(primitives.face(item), &sides),
                false => None,
            };
            let halves = candidates.halves_of(candidate);
            let cell = match inside {
                Some(cell) => Some(cell),
                None => whole.within(&primitives.lines, halves, None, watch)?,
            };
            cells.extend(cell.map(|cell| Visible { item, cell }));
        }
        Ok(Leaf { tile: *tile, cells })
    }
}

impl TileList<'_> {
    /// Searches for a sheet.
    fn sheet(&self, watch: &Watch<'_>) -> Result<Found, Error> {
        let Self { candidates, tile, .. } = self;
        let (primitives, list) = (candidates.primitives, &candidates.list);
        let sides = tile.sides();
        let Some(first) = list.first() else { return Ok(Found::Nothing) };
        if !primitives.is_opaque(first.number) {
            return Ok(Found::Nothing);
        }
        let mut is_in_sheet = vec![false; list.len()];
        let mut faces = vec![primitives.face(first.number)];
        let mut count = 0;
        while let Some(face) = faces.pop() {
            if candidates.misses(face) {
                return Ok(Found::Nothing);
            }
            for item in primitives.items_of(face) {
                watch.work(VISITED)?;
                let find = |candidate: &Candidate| candidate.number.cmp(&item);
                let Ok(index) = list.binary_search_by(find) else { continue };
                if std::mem::replace(&mut is_in_sheet[index], true) {
                    continue;
                }
                count += 1;
                let outline = primitives.outline(face);
                if outline.len() > FEW_CORNERS {
                    return Ok(Found::Nothing);
                }
                for &half in candidates.halves_of(&list[index]) {
                    let edges = (0..).zip(outline).filter(|(_, edge)| **edge == half);
                    for (k, _) in edges {
                        match primitives.neighbour(face, k) {
                            Some(other) => faces.push(other),
                            None => match primitives.around_edge(face, k) {
                                Some(around) if !are_apart(&around, &sides) => {
                                    return Ok(Found::Contour(Contour { half, around }));
                                }
                                _ => {}
                            },
                        }
                    }
                }
            }
        }
        let is_sheet = self.shows_once(&is_in_sheet) && self.is_in_front(&is_in_sheet, watch)?;
        if !is_sheet {
            return Ok(Found::Nothing);
        }
        let mut sheet = Vec::with_capacity(count);
        sheet.extend((0..list.len() as u32).filter(|&index| is_in_sheet[index as usize]));
        Ok(Found::Sheet(sheet))
    }

    /// Whether the first sample that floats decide lies in exactly one item of a sheet.
    fn shows_once(&self, is_in_sheet: &[bool]) -> bool {
        let [low, high] = self.tile.sides();
        let count = |share: &[f64; 2]| {
            let at = [0, 1].map(|axis| low[axis] + share[axis] * (high[axis] - low[axis]));
            let mut count = 0;
            for (candidate, _) in self.candidates.list.iter().zip(is_in_sheet).filter(|c| *c.1) {
                count += usize::from(self.candidates.is_in(candidate, at)?);
            }
            Some(count)
        };
        SAMPLES.iter().find_map(count) == Some(1)
    }

    /// Whether each item outside a sheet is certainly behind all items of the sheet that it overlaps in the tile.
    fn is_in_front(&self, is_in_sheet: &[bool], watch: &Watch<'_>) -> Result<bool, Error> {
        let Self { candidates, tile, .. } = self;
        let (primitives, list) = (candidates.primitives, &candidates.list);
        let sides = tile.sides();
        let mut left = COMPARED * list.len();
        let mut others: Vec<u32> = Vec::new();
        for (candidate, &is_in_sheet) in list.iter().zip(is_in_sheet) {
            let item = candidate.number;
            if !is_in_sheet {
                others.push(item);
                continue;
            }
            if others.len() > left {
                return Ok(false);
            }
            left -= others.len();
            watch.work(others.len())?;
            let around = common(candidates.around(item), &sides);
            for &other in &others {
                let both = common(&around, candidates.around(other));
                let is_apart = |item: u32| {
                    let mut halves = primitives.halves(item).iter();
                    halves.any(|&half| primitives.lines.across(half, &both) == Across::Outside)
                };
                if !is_empty(&both) && !is_apart(other) && !is_apart(item) {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }
}

/// Places in a tile, as shares of its sides: a sample may lie on an edge.
const SAMPLES: [[f64; 2]; 3] = [[0.511, 0.487], [0.27, 0.71], [0.683, 0.317]];

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use glam::DVec3;

    use super::MapTile;
    use crate::drawing::map::drawing_rays;
    use crate::drawing::primitives::Primitives;
    use crate::drawing::quadtree::{Candidates, Leaf, TileList};
    use crate::progress::Watch;
    use crate::random::SplitMix64;
    use crate::tree::BspTree;
    use crate::view::{Camera, views};

    /// The visible area of each polygon in a tile.
    fn areas(leaf: &Leaf, primitives: &Primitives<'_>) -> BTreeMap<usize, f64> {
        let mut areas = BTreeMap::new();
        for visible in &leaf.cells {
            *areas.entry(primitives.polygon(visible.item)).or_default() +=
                visible.cell.double_area();
        }
        areas
    }

    /// The triangles of a grid over a surface.
    fn triangles(n: usize, at: impl Fn(f64, f64) -> DVec3) -> Vec<Vec<DVec3>> {
        let at = |x: usize, y: usize| at(x as f64 / n as f64, y as f64 / n as f64);
        let quad = |x: usize, y: usize| {
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            [vec![a, b, c], vec![a, c, d]]
        };
        (0..n * n).flat_map(|i| quad(i % n, i / n)).collect()
    }

    /// The sheet of a tile, where there is one, has the same polygons and areas as subtraction finds.
    #[test]
    fn a_sheet_is_what_subtraction_finds() {
        let mut random = SplitMix64::new(9);
        let hills = |x: f64, y: f64| {
            let z = 0.2 * (7.0 * x).sin() * (5.0 * y).cos() + 0.05 * (31.0 * x * y).sin();
            DVec3::new(2.0 * x - 1.0, 2.0 * y - 1.0, z)
        };
        // A surface of two turns, of which one lies over the other.
        let ramp = |x: f64, y: f64| {
            let (sin, cos) = (4.0 * std::f64::consts::PI * x).sin_cos();
            DVec3::new((0.2 + y) * cos, (0.2 + y) * sin, x) * 0.8
        };
        let ball = |x: f64, y: f64| {
            let (sin, cos) = (std::f64::consts::TAU * x).sin_cos();
            let (height, radius) = (std::f64::consts::PI * y).sin_cos();
            DVec3::new(height * cos, height * sin, radius)
        };
        let (hills, ramp, ball) = (triangles(24, hills), triangles(20, ramp), triangles(24, ball));
        let mut with_others = hills.clone();
        with_others.extend((0..40).map(|_| {
            let at = random.point(-1.0, 1.0);
            [(); 3].map(|()| at + random.point(-0.1, 0.1)).to_vec()
        }));
        let scenes = [hills, ramp, ball, with_others];
        let (mut sheets, mut parts) = ([0; 8], 0);
        for (i, scene) in scenes.iter().enumerate() {
            let tree = BspTree::build(scene).unwrap();
            let cameras = views([-DVec3::ONE, DVec3::ONE], DVec3::Z, 12, [320, 240], 3).unwrap();
            let down = Camera::parallel(DVec3::NEG_Z, DVec3::Y, DVec3::ZERO, 2.5, [320, 240]);
            for (camera, is_mixed) in
                cameras.into_iter().chain([down.unwrap()]).flat_map(|c| [(c, false), (c, true)])
            {
                let opacity = |polygon: usize| if polygon % 61 == 3 { 0.5 } else { 1.0 };
                let opacities = match is_mixed {
                    true => (0..scene.len()).map(opacity).collect(),
                    false => vec![],
                };
                let watch = Watch::default();
                let rays = drawing_rays(&tree, &camera, false).unwrap();
                let primitives = Primitives::new(&tree, rays, opacities, &watch).unwrap();
                let items = Candidates::items(&primitives, |_| true).unwrap().ending_at_covers();
                let all = TileList::picture(items, &watch).unwrap();
                let mut tiles = vec![MapTile::picture(all, &watch).unwrap()];
                while let Some(tile) = tiles.pop() {
                    if !tile.is_settled() {
                        tiles.extend(tile.halves(&watch).unwrap());
                    } else if tile.sheet.is_some() {
                        let leaves = [tile.leaf(&watch), Leaf::new(&tile.list, &watch)];
                        let [found, expected] =
                            leaves.map(|leaf| areas(&leaf.unwrap(), &primitives));
                        assert!(found.keys().eq(expected.keys()), "{i}: {found:?} {expected:?}");
                        for (polygon, area) in &found {
                            assert!((area - expected[polygon]).abs() < 1e-6, "{i}: {polygon}");
                        }
                        sheets[2 * i + usize::from(is_mixed)] += 1;
                        parts += found.len();
                    }
                }
            }
        }
        assert!(sheets.iter().all(|&count| count > 3) && parts > 10_000, "{sheets:?} {parts}");
    }
}
