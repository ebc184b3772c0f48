//! Which format a file is written in.

use std::path::Path;

use clap::ValueEnum;

use crate::failure::Failure;
use crate::files::{STANDARD, about_output};

/// The format of the option, or of the file's name. Without either, the first of all formats goes to standard
/// output.
pub(crate) fn format<F: ValueEnum + PartialEq + 'static>(
    output: &Path,
    asked: Option<F>,
) -> Result<F, Failure> {
    let extension = output.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    let named = formats().find(|(name, _)| Some(name) == extension.as_ref());
    match (named, asked) {
        (Some((_, named)), Some(asked)) if named != asked => Err(about_output(
            output,
            "the file's name and --format disagree: omit --format, or name a file of that format",
        )),
        (Some((_, format)), _) | (None, Some(format)) => Ok(format),
        (None, None) => {
            let names: Vec<String> = formats::<F>().map(|(name, _)| format!(".{name}")).collect();
            let first = formats().next().filter(|_| output == Path::new(STANDARD));
            let endings = names.join(", ");
            let problem = format!("name a file that ends in one of {endings}, or give --format");
            first.map(|(_, format)| format).ok_or_else(|| about_output(output, &problem))
        }
    }
}

/// All formats, each with its name, which is also the file extension.
fn formats<F: ValueEnum + 'static>() -> impl Iterator<Item = (String, F)> {
    let named =
        |format: &F| Some((format.to_possible_value()?.get_name().to_owned(), format.clone()));
    F::value_variants().iter().filter_map(named)
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
