//! Chooses the format in which a file is written.

use std::ffi::OsStr;
use std::path::Path;

use clap::ValueEnum;

use crate::failure::Failure;
use crate::files::{STANDARD, about_output};

/// The format of the option, or of the file's name. Without either, the first of all formats goes to standard
/// output.
pub(crate) fn format<F: ValueEnum + PartialEq>(
    output: &Path,
    asked: Option<F>,
) -> Result<F, Failure> {
    let extension = output.extension().map(OsStr::to_string_lossy);
    let named = extension.and_then(|extension| F::from_str(&extension, true).ok());
    let formats = F::value_variants();
    match (named, asked, formats) {
        (Some(named), Some(asked), _) if named != asked => Err(about_output(
            output,
            "the file's name and --format disagree: omit --format, or name a file of that format",
        )),
        (Some(format), ..) | (None, Some(format), _) => Ok(format),
        (None, None, [first, ..]) if output == Path::new(STANDARD) => Ok(first.clone()),
        (None, None, _) => {
            let names = formats.iter().filter_map(F::to_possible_value);
            let names: Vec<String> = names.map(|name| format!(".{}", name.get_name())).collect();
            let endings = names.join(", ");
            let problem = format!("name a file that ends in one of {endings}, or give --format");
            Err(about_output(output, &problem))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::DrawFormat;

    #[test]
    fn names_and_options_mean_formats() {
        for (output, asked, expected) in [
            ("a.svg", None, Some(DrawFormat::Svg)),
            ("a.b.PDF", None, Some(DrawFormat::Pdf)),
            ("-", None, Some(DrawFormat::Svg)),
            ("-", Some(DrawFormat::Png), Some(DrawFormat::Png)),
            ("a", Some(DrawFormat::Png), Some(DrawFormat::Png)),
            ("a.png", Some(DrawFormat::Png), Some(DrawFormat::Png)),
            ("a.png", Some(DrawFormat::Svg), None),
            ("a.txt", None, None),
            ("svg", None, None),
        ] {
            let found = format(Path::new(output), asked);
            assert_eq!(found.ok(), expected, "{output} {asked:?}");
        }
    }
}
