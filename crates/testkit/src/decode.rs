//! Decodes bytes into scenes in which many corners coincide, or almost coincide, with earlier corners.

use arbitrary::{Result, Unstructured};
use binspace::glam::DVec3;
use binspace::{BuildOptions, Heuristic};

/// Decodes at most `most` polygons of three to six corners, or degenerate polygons with fewer corners.
pub fn polygons(bytes: &mut Unstructured<'_>, most: usize) -> Result<Vec<Vec<DVec3>>> {
    let mut polygons: Vec<Vec<DVec3>> = Vec::new();
    let mut known = vec![DVec3::ZERO];
    for _ in 0..bytes.int_in_range(1..=most)? {
        if bytes.is_empty() {
            break;
        }
        let len = match bytes.int_in_range(0..=15u8)? {
            0 => bytes.int_in_range(0..=2usize)?,
            1..=8 => 3,
            9..=12 => 4,
            _ => bytes.int_in_range(5..=8usize)?,
        };
        let mut polygon = Vec::with_capacity(len);
        for _ in 0..len {
            let corner = corner(bytes, &known, polygons.last())?;
            known.push(corner);
            polygon.push(corner);
        }
        polygons.push(polygon);
    }
    Ok(polygons)
}

/// A corner: on a small lattice, at another corner or within a few ulps of it, on a line or a plane through
/// other corners, or anywhere.
fn corner(
    bytes: &mut Unstructured<'_>,
    known: &[DVec3],
    last: Option<&Vec<DVec3>>,
) -> Result<DVec3> {
    let any_known = |bytes: &mut Unstructured<'_>| bytes.choose(known).copied();
    let share = |bytes: &mut Unstructured<'_>| Ok(f64::from(bytes.int_in_range(-8..=16i8)?) / 8.0);
    Ok(match bytes.int_in_range(0..=9u8)? {
        0..=3 => lattice(bytes)?,
        4 => any_known(bytes)?,
        5 => {
            let mut corner = any_known(bytes)?;
            let axis = bytes.int_in_range(0..=2usize)?;
            for _ in 0..bytes.int_in_range(1..=4u8)? {
                corner[axis] = corner[axis].next_up();
            }
            corner
        }
        6 => {
            let (a, b) = (any_known(bytes)?, any_known(bytes)?);
            a + (b - a) * share(bytes)?
        }
        7 => match last.map(|polygon| &polygon[..]) {
            Some([a, b, c, ..]) => a + (b - a) * share(bytes)? + (c - a) * share(bytes)?,
            _ => lattice(bytes)?,
        },
        8 => {
            let step = 10f64.powi(-i32::from(bytes.int_in_range(0..=12u8)?));
            any_known(bytes)? + lattice(bytes)? * step
        }
        _ => number(bytes)?,
    })
}

fn lattice(bytes: &mut Unstructured<'_>) -> Result<DVec3> {
    let mut axis = || Ok(f64::from(bytes.int_in_range(-3..=3i8)?));
    Ok(DVec3::new(axis()?, axis()?, axis()?))
}

/// Any coordinates from −1 to 1; occasionally any bits.
fn number(bytes: &mut Unstructured<'_>) -> Result<DVec3> {
    if bytes.int_in_range(0..=31u8)? == 7 {
        return Ok(DVec3::new(bytes.arbitrary()?, bytes.arbitrary()?, bytes.arbitrary()?));
    }
    let mut axis = || Ok(f64::from(bytes.arbitrary::<i32>()?) / 2f64.powi(31));
    Ok(DVec3::new(axis()?, axis()?, axis()?))
}

/// Decodes options with any heuristic. A third of them have the default tolerance, a third have none, and a
/// third have another.
pub fn options(bytes: &mut Unstructured<'_>) -> Result<BuildOptions> {
    let options = BuildOptions::DEFAULT.with_heuristic(*bytes.choose(Heuristic::ALL)?);
    Ok(match bytes.int_in_range(0..=2u8)? {
        0 => options,
        1 => options.with_tolerance(0.0),
        _ => options.with_tolerance(10f64.powi(-i32::from(bytes.int_in_range(0..=16u8)?))),
    })
}
