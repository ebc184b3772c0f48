//! What the raster, which judges the order, takes over from the arithmetic that it judges.

/// What the judge may take from `exact`: the scene, the eye, and the labels of planes and lines.
/// Planes, integers and predicates are its own.
const INPUT: [&str; 5] = ["Eye", "Faces", "Line", "PlaneId", "PlaneKind"];

/// The paths that lead into `exact` and are not its input.
pub(crate) fn foreign(paths: Vec<Vec<String>>) -> Vec<String> {
    let is_foreign =
        |path: &Vec<String>| match path.iter().map(String::as_str).collect::<Vec<_>>()[..] {
            ["exact", name, ..] => !INPUT.contains(&name),
            ["exact" | "internals", ..] => true,
            _ => false,
        };
    paths.into_iter().filter(is_foreign).map(|path| path.join("::")).collect()
}

/// The methods of `Faces` among some that a text calls.
pub(crate) fn calls(text: &str, methods: &[String]) -> Vec<String> {
    let dense = crate::tokens::tokens(text).concat();
    let is_called = |name: &&String| {
        dense.contains(&format!(".{name}(")) || dense.contains(&format!("Faces::{name}"))
    };
    methods.iter().filter(is_called).cloned().collect()
}

/// The methods that a text adds to `Faces`, its own apart.
pub(crate) fn methods_of_faces(text: &str) -> Vec<String> {
    let Some((_, body)) = text.split_once("impl Faces {") else { return vec![] };
    let body = body.split("\n}").next().unwrap_or_default();
    let name = |line: &str| Some(line.split_once("fn ")?.1.split(['(', '<']).next()?.to_owned());
    body.lines().filter(|line| line.starts_with("    pub")).filter_map(name).collect()
}

#[test]
fn borrowed_arithmetic_is_found_however_it_is_written() {
    let predicates = methods_of_faces(
        "impl Faces {\n    pub(crate) fn plane(&self) {\n    }\n    pub fn compare<T>() {}\n\
             fn own() {}\n}\nfn other() {}",
    );
    assert_eq!(predicates, ["plane", "compare"]);
    let calls = |text| calls(text, &predicates);
    assert_eq!(calls("let p = faces\n    .plane(id);"), ["plane"]);
    assert_eq!(calls("map(Faces::compare)"), ["compare"]);
    assert!(calls("let p = Plane::of(faces); // faces.plane(id)").is_empty());
    let foreign =
        |path: &str| !foreign(vec![path.split("::").map(String::from).collect()]).is_empty();
    assert!(foreign("exact::Int") && foreign("exact::plane::cross") && foreign("exact"));
    assert!(foreign("internals::Faces"));
    assert!(
        !foreign("exact::Faces") && !foreign("view::Camera") && !foreign("raster::exact::Plane")
    );
}
