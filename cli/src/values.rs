//! Parses and checks the values of options: vectors, sizes, angles, colours.

use std::ffi::OsString;

use binspace::Heuristic;
use binspace::glam::DVec3;
use binspace::view::Camera;

/// The options that take a vector.
const VECTORS: [&str; 5] = ["--eye", "--direction", "--target", "--up", "--order"];

/// Joins the numbers of a vector to one argument: `--eye 9 -4 3` to `--eye=9,-4,3`.
pub(crate) fn with_joined_vectors(arguments: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let arguments: Vec<OsString> = arguments.collect();
    let mut joined = Vec::with_capacity(arguments.len());
    let mut rest = &arguments[..];
    while let [first, others @ ..] = rest {
        joined.push(first.clone());
        rest = others;
        let is_vector = VECTORS.iter().any(|option| first == *option);
        let numbers = others.iter().take(3).map_while(|number| number.to_str());
        let numbers: Vec<&str> = numbers.map(|number| number.trim_end_matches(',')).collect();
        let count = numbers.iter().take_while(|number| number.parse::<f64>().is_ok()).count();
        if let (true, 2.., Some(last)) = (is_vector, count, joined.last_mut()) {
            *last = format!("{}={}", first.to_string_lossy(), numbers[..count].join(",")).into();
            rest = &others[count..];
        }
    }
    joined
}

/// A point: three finite numbers separated by commas.
pub(crate) fn point(text: &str) -> Result<DVec3, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let &[x, y, z] = &parts[..] else {
        let count = if text.is_empty() { 0 } else { parts.len() };
        return Err(format!("expected three numbers, as in 9,-4,3 or 9 -4 3, not {count}"));
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

/// The direction that points up; `None` for the direction that [`up_of`](crate::upright::up_of) finds for a
/// scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Up(pub(crate) Option<DVec3>);

/// A direction upwards: an axis, any direction, or `auto`.
pub(crate) fn up(text: &str) -> Result<Up, String> {
    if text == "auto" {
        return Ok(Up(None));
    }
    let (name, sign) = text.strip_prefix('-').map_or((text, 1.0), |name| (name, -1.0));
    let axis = match name {
        "x" => DVec3::X,
        "y" => DVec3::Y,
        "z" => DVec3::Z,
        _ if name.contains(',') => return direction(text).map(|up| Up(Some(up))),
        _ => return Err("expected auto, an axis (x, y, z, -x, …) or a vector X,Y,Z".to_owned()),
    };
    Ok(Up(Some(axis * sign)))
}

/// A background: a colour, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Background(pub(crate) Option<[u8; 3]>);

/// A colour: a number as in SVG and CSS, a usual name, or `none`.
pub(crate) fn background(text: &str) -> Result<Background, String> {
    let digits = match text {
        "none" => return Ok(Background(None)),
        "white" => "fff",
        "black" => "000",
        _ => text.strip_prefix('#').unwrap_or(text),
    };
    let each = if digits.len() == 3 { 2 } else { 1 };
    let digits: String =
        digits.chars().flat_map(|digit| std::iter::repeat_n(digit, each)).collect();
    let is_hex = digits.len() == 6 && digits.chars().all(|digit| digit.is_ascii_hexdigit());
    let number = u32::from_str_radix(&digits, 16).ok().filter(|_| is_hex);
    let number = number.ok_or("expected a colour such as #ffeecc, white or black, or none")?;
    let [_, r, g, b] = number.to_be_bytes();
    Ok(Background(Some([r, g, b])))
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
            "at most {} pixels wide or high, and {} in total",
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

/// A share of 0 to 45 percent, as a number up to 0.45.
pub(crate) fn margin(text: &str) -> Result<f64, String> {
    match finite(text)? {
        percent @ 0.0..=45.0 => Ok(percent / 100.0),
        _ => Err("expected 0 to 45 percent".to_owned()),
    }
}

/// A length of more than 0.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    Some(finite(text)?).filter(|&n| n > 0.0).ok_or_else(|| "expected a number above 0".to_owned())
}

/// The width of lines in pixels. Thinner lines have too many dashes, and wider ones do not fit into formats.
pub(crate) fn line_width(text: &str) -> Result<f64, String> {
    let width = Some(finite(text)?).filter(|width| (0.01..=1000.0).contains(width));
    width.ok_or_else(|| "expected 0.01 to 1000 pixels".to_owned())
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
    fn three_numbers_after_an_option_are_one_vector() {
        let joined = |line: &str| -> String {
            let words = with_joined_vectors(line.split(' ').map(OsString::from));
            words.iter().map(|word| word.to_str().unwrap()).collect::<Vec<_>>().join(" ")
        };
        for (line, expected) in [
            ("draw --eye 9 -4 3 s.obj", "draw --eye=9,-4,3 s.obj"),
            ("--eye 1, 2, 3 --eye 4 5 6e1", "--eye=1,2,3 --eye=4,5,6e1"),
            ("--eye 9,-4,3 s.obj --up z", "--eye 9,-4,3 s.obj --up z"),
            // Too few: the option's own parser reports this.
            ("--eye 9 -4 s.obj", "--eye=9,-4 s.obj"),
            ("--size 9 4 3 --eye=1,2,3 1", "--size 9 4 3 --eye=1,2,3 1"),
            ("--target 1", "--target 1"),
        ] {
            assert_eq!(joined(line), expected);
        }
    }

    #[test]
    fn backgrounds_are_colours_or_none() {
        let colour = |text| background(text).unwrap().0;
        assert_eq!(colour("#ffeecc"), Some([255, 238, 204]));
        assert_eq!([colour("fec"), colour("#ffeecc")], [Some([255, 238, 204]); 2]);
        assert_eq!([colour("none"), colour("black")], [None, Some([0; 3])]);
        for text in ["", "#", "#12345", "grey!", "+1234f", "#ééé"] {
            assert!(background(text).is_err(), "{text}");
        }
    }

    #[test]
    fn up_is_an_axis_or_a_vector() {
        assert_eq!(up("auto"), Ok(Up(None)));
        assert_eq!(up("z"), Ok(Up(Some(DVec3::Z))));
        assert_eq!(up("-y"), Ok(Up(Some(DVec3::NEG_Y))));
        assert_eq!(up("-1,0,2"), Ok(Up(Some(DVec3::new(-1.0, 0.0, 2.0)))));
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
