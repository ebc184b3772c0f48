//! Texture coordinates, normals and colours of corners.

use std::str::SplitWhitespace;

use glam::{DVec2, DVec3};

use crate::scene::Attributes;

/// What was read of corners besides their positions.
#[derive(Debug, Default)]
pub(super) struct Found {
    /// Of each `vt` line; `None` if it is malformed.
    uvs: Vec<Option<DVec2>>,
    /// Of each `vn` line; `None` if it is malformed.
    normals: Vec<Option<DVec3>>,
    /// Of each vertex up to the last that has one.
    colors: Vec<Option<[f32; 3]>>,
    /// For each corner the numbers from 0 of its vertex, its `vt` line and its `vn` line.
    corners: Vec<[Option<u32>; 3]>,
    /// Malformed lines, and references to what is not there.
    pub(super) faults: usize,
}

impl Found {
    pub(super) fn uv(&mut self, words: SplitWhitespace<'_>) {
        let numbers = numbers(words);
        // The second coordinate may be missing, and a third one is of no use here.
        let uv = match numbers[..] {
            [Some(u)] => Some(DVec2::new(u, 0.0)),
            [Some(u), Some(v), ..] => Some(DVec2::new(u, v)),
            _ => None,
        };
        self.faults += usize::from(uv.is_none());
        self.uvs.push(uv);
    }

    pub(super) fn normal(&mut self, words: SplitWhitespace<'_>) {
        let numbers = numbers(words);
        let normal = match numbers[..] {
            [Some(x), Some(y), Some(z), ..] => Some(DVec3::new(x, y, z)),
            _ => None,
        };
        self.faults += usize::from(normal.is_none());
        self.normals.push(normal);
    }

    /// The words of a vertex behind its coordinates: a colour, if there are three numbers. (One
    /// number is a weight.)
    pub(super) fn vertex(&mut self, vertex: usize, words: SplitWhitespace<'_>) {
        if let [Some(r), Some(g), Some(b)] = numbers(words)[..] {
            self.colors.resize(vertex, None);
            self.colors.push(Some([r, g, b].map(|c| c as f32)));
        }
    }

    /// A corner, by the number from 1 of its vertex and the rest of its word, `/vt/vn` or less.
    pub(super) fn corner(&mut self, vertex: usize, rest: Option<&str>) {
        let mut references = rest.unwrap_or_default().split('/');
        let mut next = |count: usize| {
            let word = references.next().unwrap_or_default();
            let number = (!word.is_empty()).then(|| number_from_0(word, count));
            self.faults += usize::from(number == Some(None));
            number.flatten()
        };
        let (uv, normal) = (next(self.uvs.len()), next(self.normals.len()));
        // A number that is too large names no vertex, which is an error of its own.
        self.corners.push([u32::try_from(vertex - 1).ok(), uv, normal]);
    }

    /// The attributes of each corner.
    pub(super) fn finish(self) -> (Attributes, usize) {
        let lost = |place: usize, count: usize| {
            let is_lost =
                |corner: &&[Option<u32>; 3]| corner[place].is_some_and(|n| n as usize >= count);
            self.corners.iter().filter(is_lost).count()
        };
        let faults = self.faults + lost(1, self.uvs.len()) + lost(2, self.normals.len());
        let attributes = Attributes {
            uvs: of_corners(&self.corners, 1, &self.uvs),
            normals: of_corners(&self.corners, 2, &self.normals),
            colors: of_corners(&self.corners, 0, &self.colors),
        };
        (attributes, faults)
    }
}

/// The values of corners by the numbers at a place; none if no corner has one.
fn of_corners<T: Copy>(
    corners: &[[Option<u32>; 3]],
    place: usize,
    values: &[Option<T>],
) -> Vec<Option<T>> {
    let value = |corner: &[Option<u32>; 3]| *values.get(corner[place]? as usize)?;
    if corners.iter().any(|corner| value(corner).is_some()) {
        corners.iter().map(value).collect()
    } else {
        Vec::new()
    }
}

/// The words up to a comment as finite numbers.
fn numbers(words: SplitWhitespace<'_>) -> Vec<Option<f64>> {
    let number = |word: &str| word.parse::<f64>().ok().filter(|number| number.is_finite());
    words.take_while(|word| !word.starts_with('#')).map(number).collect()
}

/// A reference from 1, or backwards from the last of `count` so far, as a number from 0. It may
/// still lie beyond the last of the file.
fn number_from_0(word: &str, count: usize) -> Option<u32> {
    let number = word.parse::<i64>().ok()?;
    let from_0 = if number > 0 { number - 1 } else { count as i64 + number };
    u32::try_from(from_0).ok().filter(|_| number != 0)
}
