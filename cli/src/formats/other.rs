//! Recognises files that are not read by their first bytes, so that messages can name the kind of file.

/// First bytes, and the kind of the files that begin with these bytes.
const BEGINNINGS: [(&[u8], &str); 33] = [
    (b"ISO-10303-21", "a STEP or IFC file"),
    (b"PK\x03\x04", "a ZIP archive, as 3MF and USDZ files are"),
    (b"\x1f\x8b", "compressed by gzip: unpack it (`gunzip -c FILE | binspace … -`)"),
    (b"BZh", "compressed by bzip2: unpack it (`bunzip2 -c FILE | binspace … -`)"),
    (b"\xfd7zXZ\0", "compressed by xz: unpack it (`xz -dc FILE | binspace … -`)"),
    (b"\x28\xb5\x2f\xfd", "compressed by Zstandard: unpack it (`zstd -dc FILE | binspace … -`)"),
    (b"Kaydara FBX", "an FBX file"),
    (b"; FBX", "an FBX file"),
    (b"BLENDER", "a Blender file"),
    (b"3D Geometry File Format", "a Rhino file"),
    (b"PXR-USDC", "a USD file"),
    (b"#usda", "a USD file"),
    (b"#VRML", "a VRML file"),
    (b"#X3D", "an X3D file"),
    (b"xof ", "a DirectX file"),
    (b"AC10", "a DWG file"),
    (b"AutoCAD Binary DXF", "a DXF file"),
    (b"FORM", "an IFF file, as LightWave writes"),
    (b"LWSC", "a LightWave scene"),
    (b"*3DSMAX", "an ASE file, as 3ds Max writes"),
    (b"AC3D", "an AC3D file"),
    (b"4OFF", "an OFF file with four coordinates for each vertex"),
    (b"nOFF", "an OFF file with another number of coordinates than three"),
    (b"DBRep_DrawableShape", "a BREP file"),
    (b"LASF", "a LAS point cloud"),
    (b"# .PCD", "a PCD point cloud"),
    (b"%PDF", "a PDF file"),
    (b"%!PS", "a PostScript file"),
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"GIF8", "a GIF picture"),
    (b"\xd0\xcf\x11\xe0", "an OLE file, as SolidWorks and 3ds Max write"),
    (b"\x7fELF", "an executable file"),
];

/// Names of elements in small letters, and the kind of XML files with such an element. The first name found
/// counts.
const ELEMENTS: [(&[u8], &str); 5] = [
    (b"<collada", "a COLLADA file"),
    (b"<x3d", "an X3D file"),
    (b"<svg", "an SVG picture"),
    (b"<amf", "an AMF file"),
    (b"<html", "an HTML page, perhaps from a failed download"),
];

/// The first words of lines of OBJ files.
const OBJ: [&[u8]; 14] = [
    b"v", b"vt", b"vn", b"vp", b"f", b"l", b"p", b"g", b"o", b"s", b"mtllib", b"usemtl", b"call",
    b"curv",
];

/// The kind of a file of `length` bytes that cannot be read, if the kind is known.
pub(crate) fn name(beginning: &[u8], length: u64) -> Option<&'static str> {
    let begins = |&(bytes, _): &(&[u8], &str)| beginning.starts_with(bytes);
    if let Some((_, name)) = BEGINNINGS.iter().find(|entry| begins(entry)) {
        return Some(name);
    }
    // A chunk with the length of the file.
    if beginning.starts_with(b"MM")
        && beginning.get(2..6).is_some_and(|n| {
            n.iter().rev().fold(0, |sum, &byte| sum << 8 | u64::from(byte)) == length
        })
    {
        return Some("a 3DS file");
    }
    let text = beginning.strip_prefix(b"\xef\xbb\xbf").unwrap_or(beginning).trim_ascii_start();
    if text.starts_with(b"<") {
        let text = text.to_ascii_lowercase();
        let has = |element: &[u8]| text.windows(element.len()).any(|part| part == element);
        let known = ELEMENTS.iter().find(|(element, _)| has(element));
        return Some(known.map_or("an XML file", |(_, name)| name));
    }
    if text.starts_with(b"{") {
        return Some("a JSON file, but not a glTF file");
    }
    let lines = text.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let lines: Vec<&[u8]> = lines.take(64).collect();
    // Pairs of lines, the first of which may be comments.
    let first = lines.chunks_exact(2).find(|pair| pair[0] != b"999");
    if first == Some(&[b"0", b"SECTION"]) {
        return Some("a DXF file");
    }
    // The first section of lines of 80 letters.
    (beginning.get(72..80) == Some(b"S      1")).then_some("an IGES file")
}

/// Whether a line begins as lines of OBJ files do.
pub(crate) fn is_like_obj(beginning: &[u8]) -> bool {
    let mut lines = beginning.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii_start);
    lines.any(|line| {
        line.split(u8::is_ascii_whitespace).next().is_some_and(|word| OBJ.contains(&word))
    })
}
