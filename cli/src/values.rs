//! Parses and checks the values of options: vectors, sizes, angles.

use binspace::Heuristic;
use binspace::glam::DVec3;
use binspace::view::Camera;

/// A point: three finite numbers separated by commas.
pub(crate) fn point(text: &str) -> Result<DVec3, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let &[x, y, z] = &parts[..] else {
        let count = if text.is_empty() { 0 } else { parts.len() };
        return Err(format!("expected three numbers X,Y,Z, not {count}"));
    };
    Ok(DVec3::new(finite(x)?, finite(y)?, finite(z)?))
}

/// A direction: a vector that is not zero.
pub(crate) fn direction(text: &str) -> Result<DVec3, String> {
    let vector = point(text)?;
    if vector == DVec3::ZERO {
        return Err("a direction must not be zero".to_owned());
    }
    Ok(vector)
}

/// A direction upwards: an axis, or any direction.
pub(crate) fn up(text: &str) -> Result<DVec3, String> {
    let (name, sign) = text.strip_prefix('-').map_or((text, 1.0), |name| (name, -1.0));
    let axis = match name {
        "x" => DVec3::X,
        "y" => DVec3::Y,
        "z" => DVec3::Z,
        _ if name.contains(',') => return direction(text),
        _ => return Err("expected an axis (x, y, z, -x, …) or a vector X,Y,Z".to_owned()),
    };
    Ok(axis * sign)
}

/// A picture's size: `640x480`.
pub fn size(text: &str) -> Result<[u32; 2], String> {
    let number = |part: &str| part.trim().parse::<u32>().ok().filter(|&n| n > 0);
    let sides = text.split_once(['x', 'X', '×']);
    let Some((Some(width), Some(height))) = sides.map(|(w, h)| (number(w), number(h))) else {
        return Err("expected two whole numbers of pixels, such as 640x480".to_owned());
    };
    let pixels = u64::from(width) * u64::from(height);
    if width.max(height) > Camera::MAX_SIDE || pixels > Camera::MAX_PIXELS {
        return Err(format!(
            "at most {} pixels each way and {} in all",
            Camera::MAX_SIDE,
            Camera::MAX_PIXELS
        ));
    }
    Ok([width, height])
}

/// A vertical field of view in degrees, as radians.
pub(crate) fn field_of_view(text: &str) -> Result<f64, String> {
    let degrees = finite(text)?;
    if !(0.001..=179.0).contains(&degrees) {
        return Err("expected an angle from 0.001 to 179 degrees".to_owned());
    }
    Ok(degrees.to_radians())
}

/// A length of 0 or more.
pub(crate) fn length(text: &str) -> Result<f64, String> {
    let length = finite(text)?;
    if length < 0.0 {
        return Err("expected a length of 0 or more".to_owned());
    }
    Ok(length)
}

/// The heuristics to build with: one, or all.
#[derive(Clone, Debug)]
pub(crate) struct Heuristics(pub(crate) Vec<Heuristic>);

/// A heuristic's name, or `all`.
pub(crate) fn heuristics(text: &str) -> Result<Heuristics, String> {
    if text == "all" {
        return Ok(Heuristics(Heuristic::ALL.to_vec()));
    }
    let one = text.parse::<Heuristic>().map_err(|error| format!("{error}; or use `all`"))?;
    Ok(Heuristics(vec![one]))
}

fn finite(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err(format!("{:?} is not a finite number", text.trim())),
        Err(_) => Err(format!("{:?} is not a number", text.trim())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_have_three_finite_numbers() {
        assert_eq!(point("-1, 2.5,3e4"), Ok(DVec3::new(-1.0, 2.5, 3e4)));
        for (text, problem) in [
            ("1,2", "not 2"),
            ("", "not 0"),
            ("1,2,3,4", "not 4"),
            ("1,2,nan", "\"nan\" is not a finite"),
            ("1,-inf,3", "\"-inf\" is not a finite"),
            ("1,1e999,3", "\"1e999\" is not a finite"),
            ("1,,3", "\"\" is not a number"),
        ] {
            let message = point(text).unwrap_err();
            assert!(message.contains(problem), "{text}: {message}");
        }
        assert!(direction("0,-0,0").unwrap_err().contains("zero"));
    }

    #[test]
    fn up_is_an_axis_or_a_vector() {
        assert_eq!(up("z"), Ok(DVec3::Z));
        assert_eq!(up("-y"), Ok(DVec3::NEG_Y));
        assert_eq!(up("-1,0,2"), Ok(DVec3::new(-1.0, 0.0, 2.0)));
        assert!(up("w").is_err() && up("").is_err() && up("0,0,0").is_err());
    }

    #[test]
    fn sizes_and_angles_have_limits() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        for text in ["640", "0x5", "-1x5", "axb", "70000x1", "16384x16384", "99999999999x1"] {
            assert!(size(text).is_err(), "{text}");
        }
        assert_eq!(field_of_view("90"), Ok(std::f64::consts::FRAC_PI_2));
        assert!(field_of_view("0").is_err() && field_of_view("180").is_err());
        assert!(length("0").is_ok() && length("-1e-9").is_err() && length("nan").is_err());
    }

    #[test]
    fn all_heuristics_are_one_word() {
        assert_eq!(heuristics("all").unwrap().0, Heuristic::ALL);
        assert_eq!(heuristics("random:3").unwrap().0, [Heuristic::Random { seed: 3 }]);
        assert!(heuristics("best").unwrap_err().ends_with("or use `all`"));
    }
}
