use std::fs;

use crate::run::Folder;

/// The page is self-contained, and its exact methods have no errors.
#[test]
#[ignore = "takes half a minute"]
fn all_chapters_are_on_one_page() {
    let folder = Folder::new("lecture");
    let out = folder.run("lecture -o course").good();
    assert!(out.contains("Wrote course"), "{out}");
    let names: Vec<_> = fs::read_dir(folder.path("course")).unwrap().collect();
    assert_eq!(names.len(), 1);
    let page = fs::read_to_string(folder.path("course/index.html")).unwrap();
    let titles = [
        "Why order at all",
        "The painter's algorithm and who hides whom",
        "Newell, Newell and Sancha",
        "Binary space partition trees",
        "Depth buffers",
        "Precision",
        "What need not be drawn",
        "Translucent surfaces",
        "Anti-aliasing",
        "Shadows",
    ];
    let mut rest = &page[..];
    for title in titles {
        let heading = format!("<h2>{title}</h2>");
        let (_, after) = rest.split_once(&heading).unwrap_or_else(|| panic!("{title}"));
        rest = after;
    }
    // No script, and nothing from elsewhere.
    for part in ["<script", "<link", "src=\"http", "href=\"http", "url("] {
        assert!(!page.contains(part), "{part}");
    }
    assert!(page.matches("src=\"data:image/png;base64,").count() > 40);
    assert!(page.matches("<svg").count() > 5);
    assert!(
        page.contains(
            "F C G A D₁ B D₂ E H; the library's tree of 9 pieces gives F C G A D₁ B D₂ E H"
        )
    );
    assert!(page.contains("36 of the 36 pixels"));
    for part in
        ["Shadows as pieces of polygons", "noisy sphere", "<code>binspace-lab report</code>"]
    {
        assert!(page.contains(part), "{part}");
    }
    // No backticks around a command are left.
    assert!(!page.contains(">`") && !page.contains(" `"));
    // Pictures are left out, because their encoded data may contain any letters.
    let texts =
        page.split("base64,").map(|part| part.split_once('"').map_or(part, |(_, text)| text));
    for text in texts {
        assert!(!text.contains("NaN") && !text.contains("inf "), "{text}");
    }
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let folder = Folder::new("lecture_file");
    folder.write("course", "a file");
    let message = folder.run("lecture -o course/inside").refused();
    assert!(message.contains("course"), "{message}");
}
