//! Tests the preparation of polygons of up to some thousand corners, simple or not.

mod flat;
mod maze;
mod outline;

use super::super::decode;
use super::super::dice::Dice;
use super::super::judge::{Verdict, ensure};
use super::cover;
use arbitrary::{Result, Unstructured};
use binspace::glam::DVec3;
use binspace::internals::Faces;
use binspace::{BuildOptions, ErrorKind, Preparation};
use flat::{Area, area_of, cross, main_axes};
use outline::Outline;
use std::ops::ControlFlow;

/// The largest number of fragments of a tree. Other targets test larger trees.
const MOST_FRAGMENTS: usize = 20_000;
/// A build that reports its progress more often takes too long as well. It reports about once in 65 536
/// examined pieces.
const MOST_CALLS: usize = 60;

/// Places one to three outlines in space, and checks their preparation.
pub fn run(data: &[u8]) {
    // Too few bytes make no polygon.
    let _ = try_run(&mut Unstructured::new(data));
}

fn try_run(bytes: &mut Unstructured<'_>) -> Result<()> {
    let options = decode::options(bytes)?;
    let mut dice = Dice(u64::from(bytes.arbitrary::<u16>()?));
    let mut given = Vec::new();
    for _ in 0..bytes.int_in_range(1..=3u8)? {
        let place = Place::some(bytes)?;
        let outline = outline::some(bytes)?;
        given.push(Given::new(outline, &place, &mut dice));
    }
    if let Err(what) = check(&given, options.clone(), &mut dice) {
        panic!("{what}: {options:?} {given:?}");
    }
    Ok(())
}

fn check(given: &[Given], options: BuildOptions, dice: &mut Dice) -> Verdict {
    let corners = || given.iter().map(|given| &given.corners);
    let (faces, report) =
        Faces::new(corners(), options.tolerance).map_err(|error| error.to_string())?;
    let mut ranges = vec![0..0; given.len()];
    for face in 0..faces.len() as u32 {
        let range = &mut ranges[faces.polygon(face)];
        let start = if range.start == range.end { face } else { range.start };
        *range = start..face + 1;
    }
    for (given, range) in given.iter().zip(ranges) {
        let made = Made { given, faces: &faces, range };
        made.is_dropped_if_it_has_no_area(dice)?;
        made.names_its_corners()?;
        if given.is_simple() {
            made.has_the_area()?;
        }
        if given.is_simple() && given.kind == Kind::Whole {
            flat::winds_once(&faces, made.range.clone(), given, dice)?;
        }
    }
    counts(given, &faces, &report)?;
    let mut calls = 0;
    let built = options.with_max_fragments(MOST_FRAGMENTS).build_with_progress(corners(), |_| {
        calls += 1;
        if calls < MOST_CALLS { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    match built {
        Ok(tree) => {
            tree.validate()?;
            cover::covers(&tree)
        }
        // Triangles of polygons that cross, or are planar except for rounding, cut each other.
        Err(error) => ensure(
            error.kind() == ErrorKind::OverBudget || error.kind() == ErrorKind::Cancelled,
            || error.to_string(),
        ),
    }
}

/// Checks that the report on the polygons agrees with their faces.
fn counts(given: &[Given], faces: &Faces, report: &Preparation) -> Verdict {
    let dropped: Vec<usize> = faces.dropped(report.polygons).collect();
    let crossing = given.iter().filter(|given| !given.is_simple()).count();
    let fits = report.polygons == given.len()
        && report.dropped == dropped.len()
        && report.triangulated + report.dropped <= given.len()
        && report.crossing <= crossing.min(report.triangulated);
    ensure(fits, || format!("{report:?}, dropped {dropped:?}"))
}

/// The rounding of an outline's coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Integers: exactly planar.
    Whole,
    /// Tenths, which are not binary fractions: planar except for rounding.
    Tenths,
    /// Each corner slightly off the plane.
    Rough,
}

/// A plane with integer coordinates.
#[derive(Clone, Copy, Debug)]
struct Place {
    axes: [DVec3; 2],
    origin: DVec3,
    kind: Kind,
}

impl Place {
    fn some(bytes: &mut Unstructured<'_>) -> Result<Self> {
        let kind = *bytes.choose(&[Kind::Whole, Kind::Whole, Kind::Tenths, Kind::Rough])?;
        let mut vector = |most: i8| {
            let mut axis = || Ok(f64::from(bytes.int_in_range(-most..=most)?));
            Ok(DVec3::new(axis()?, axis()?, axis()?))
        };
        Ok(Self { axes: [vector(2)?, vector(2)?], origin: vector(100)?, kind })
    }

    fn normal(&self) -> DVec3 {
        self.axes[0].cross(self.axes[1])
    }
}

/// A polygon as given to the library.
#[derive(Clone, Debug)]
struct Given {
    corners: Vec<DVec3>,
    kind: Kind,
    is_simple: bool,
}

impl Given {
    fn new(outline: Outline, place: &Place, dice: &mut Dice) -> Self {
        let ([u, v], seed) = (place.axes, dice.roll());
        let hash = |[x, y]: [i32; 2]| (x as u64) << 32 ^ y as u64;
        let off = place.normal().normalize_or_zero() * 1e-6;
        let corner = |&[x, y]: &[i32; 2]| {
            let point = place.origin + u * f64::from(x) + v * f64::from(y);
            match place.kind {
                Kind::Whole => point,
                Kind::Tenths => point * 0.1,
                // The offset is the same for every repetition of the corner.
                Kind::Rough => point + off * (2.0 * Dice(seed ^ hash([x, y])).share() - 1.0),
            }
        };
        let corners = outline.corners.iter().map(corner).collect();
        let is_simple = outline.is_simple && place.normal() != DVec3::ZERO;
        Self { corners, kind: place.kind, is_simple }
    }

    /// Whether the polygon is known not to touch or cross itself.
    fn is_simple(&self) -> bool {
        self.is_simple
    }
}

/// A polygon with its faces.
struct Made<'a> {
    given: &'a Given,
    faces: &'a Faces,
    range: std::ops::Range<u32>,
}

impl Made<'_> {
    fn snapped(&self) -> Vec<[f64; 3]> {
        self.given.corners.iter().map(|&corner| self.faces.lattice().snap(corner)).collect()
    }

    /// Checks that polygons are dropped if they have fewer than three different corners, or only collinear
    /// corners. Polygons that touch themselves may also be dropped if they wind around no point, like spikes.
    fn is_dropped_if_it_has_no_area(&self, dice: &mut Dice) -> Verdict {
        let corners = self.snapped();
        let first = corners[0];
        let second = corners.iter().find(|&&corner| corner != first).copied();
        let on_a_line =
            |&corner: &[f64; 3]| second.is_none_or(|second| cross(first, second, corner) == [0; 3]);
        let is_line = corners.iter().all(on_a_line);
        let is_dropped = self.range.is_empty();
        let empty = |dice| !self.given.is_simple && !flat::goes_around_something(&corners, dice);
        ensure(is_dropped == is_line || is_dropped && empty(dice), || {
            format!("on a line: {is_line}, faces: {:?}", self.range)
        })
    }

    /// Checks that a face has area, that its corners are the polygon's by number, and that its outer edges
    /// run along the edges of the polygon.
    fn names_its_corners(&self) -> Verdict {
        let corners = self.snapped();
        let moved = 2.0 * self.faces.tolerance() + 2.0;
        for face in self.range.clone() {
            let own = self.faces.corners(face);
            ensure(area_of(own) != [0; 3], || format!("face {face} has no area"))?;
            for (k, &corner) in own.iter().enumerate() {
                let number = self.faces.corner_number(face, k as u32) as usize;
                let off = (DVec3::from(corner) - DVec3::from(corners[number])).abs().max_element();
                let exact = self.given.kind == Kind::Whole;
                ensure(if exact { off == 0.0 } else { off <= moved }, || {
                    format!("corner {k} of face {face} is {off} off corner {number}")
                })?;
                let Some(edge) = self.faces.outline_edge(face, k as u32) else { continue };
                let n = corners.len();
                let ahead = (1..n).map(|step| corners[(edge as usize + step) % n]);
                let next = ahead.clone().find(|&next| next != corners[edge as usize]);
                let end = own[(k + 1) % own.len()];
                let along = |next| cross(corners[edge as usize], next, end) == [0; 3];
                ensure(edge as usize == number && (!exact || next.is_some_and(along)), || {
                    format!("edge {k} of face {face} is not along edge {edge}")
                })?;
            }
        }
        Ok(())
    }

    /// Checks that the faces of a simple polygon have its orientation and area: exactly, unless corners
    /// were rounded or moved.
    fn has_the_area(&self) -> Verdict {
        let whole = area_of(&self.snapped());
        let axes = main_axes(whole);
        let mut sum: Area = [0; 3];
        for face in self.range.clone() {
            let own = area_of(self.faces.corners(face));
            // Corners that are collinear except for rounding may make a triangle that is seen edge-on, or
            // that faces the other way along an axis other than the axis of its projection.
            let least = i128::from(self.given.kind == Kind::Whole);
            let faces_as = |&axis: &usize| own[axis].signum() * whole[axis].signum() >= least;
            ensure(axes.iter().any(faces_as), || format!("face {face} faces the other way"))?;
            sum = std::array::from_fn(|i| sum[i] + own[i]);
        }
        let is_same = match self.given.kind {
            Kind::Whole => sum == whole,
            Kind::Tenths | Kind::Rough => {
                let float = |area: Area| DVec3::from_array(area.map(|c| c as f64));
                (float(sum) - float(whole)).length() <= 1e-4 * float(whole).length()
            }
        };
        ensure(is_same, || format!("the faces' area {sum:?}, not {whole:?}"))
    }
}
