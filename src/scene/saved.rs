//! Writes and reads scenes.

use std::io::{self, Read, Write};

use glam::{DVec2, DVec3};

use super::{Attributes, Material, Scene};
use crate::error::Error;
use crate::save::{Kind, Reader, Writer, damaged, too_many, u32_at, u64_at};

const KIND: Kind = Kind { name: *b"scen", version: 1 };

/// A limit above the number of polygons, corners or materials that a tree can have.
const MOST: usize = u32::MAX as usize;
/// The largest number of bytes of a name.
const LONGEST: usize = 1 << 16;

impl Scene {
    /// Writes the scene with its materials and the attributes of its corners. [`read`](Self::read) returns an
    /// equal scene. The scene may follow a tree in the same file, as in files of the program `binspace`.
    ///
    /// # Layout
    ///
    /// This is version 1. All numbers are little-endian. A *list* is stored as its length, a `u64`, followed
    /// by its items. An *optional* item begins with a `u32`, which is 1 if the item is present and 0 if not.
    /// Its numbers follow in both cases; the numbers of an absent item have no meaning.
    ///
    /// | part | content |
    /// |---|---|
    /// | head | the bytes `binspacescen`, the version as `u32` |
    /// | name | a list of at most 65 536 bytes: the name in UTF-8 |
    /// | up, precision | three `f64`, and one `f64` |
    /// | view | six `f64`, optional: eye and target |
    /// | materials | the number of materials as `u64`; for each material its name, a list of bytes; then red, green, blue and opacity as `f32` |
    /// | polygons | a list: for each polygon the number of its corners, and the number of its material, as `u32` |
    /// | corners | the corners of all polygons: three `f64` each |
    /// | lines | a list: for each polygon its line in the source file, `u64`; or empty |
    /// | texture coordinates | a list: for each corner two `f64`, optional; or empty |
    /// | normals | a list: for each corner three `f64`, optional; or empty |
    /// | colours | a list: for each corner three `f32`, optional; or empty |
    /// | end | the CRC-32 of all bytes before, `u32` |
    ///
    /// # Errors
    ///
    /// If the writer returns an error, or if a name is too long. The bytes written before an error are not a
    /// valid file.
    pub fn write(&self, output: impl Write) -> io::Result<()> {
        let mut file = Writer::new(output, KIND)?;
        let numbers = |file: &mut Writer<_>, numbers: &[f64]| {
            file.items(numbers.iter(), |file, &number| file.f64(number))
        };
        write_name(&mut file, &self.name)?;
        numbers(&mut file, &[self.up.x, self.up.y, self.up.z, self.precision])?;
        let view = self.view.map(|(eye, target)| [eye.to_array(), target.to_array()].concat());
        file.u32(u32::from(view.is_some()))?;
        numbers(&mut file, &view.unwrap_or_else(|| vec![0.0; 6]))?;
        file.list(self.materials.iter(), |file, material| {
            write_name(file, &material.name)?;
            let light = material.color.into_iter().chain([material.opacity]);
            file.items(light, |file, number| file.put(number.to_le_bytes()))
        })?;
        file.list(0..self.len(), |file, index| {
            file.u32(self.polygon(index).len() as u32)?;
            file.u32(self.material_of[index])
        })?;
        file.items(self.corners.iter(), |file, corner| numbers(file, &corner.to_array()))?;
        file.list(self.lines.iter(), |file, &line| file.u64(line as u64))?;
        let Attributes { uvs, normals, colors } = &self.attributes;
        file.list(uvs.iter(), |file, uv| {
            file.u32(u32::from(uv.is_some()))?;
            numbers(file, &uv.unwrap_or_default().to_array())
        })?;
        file.list(normals.iter(), |file, normal| {
            file.u32(u32::from(normal.is_some()))?;
            numbers(file, &normal.unwrap_or_default().to_array())
        })?;
        file.list(colors.iter(), |file, color| {
            file.u32(u32::from(color.is_some()))?;
            let light = color.unwrap_or_default().into_iter();
            file.items(light, |file, number| file.put(number.to_le_bytes()))
        })?;
        file.finish()
    }

    /// Reads a scene that [`write`](Self::write) has written. No byte after the scene is read.
    ///
    /// Any file is safe to read: the memory used is proportional to the bytes read. As in any scene,
    /// coordinates and colours may be infinite or NaN.
    ///
    /// # Errors
    ///
    /// If the data cannot be read; if the data are not a scene, have another version, are truncated or
    /// damaged, or contain lists that contradict each other; or if memory runs out. The message names the
    /// fault.
    pub fn read(input: impl Read) -> Result<Self, Error> {
        let mut file = Reader::new(input, KIND)?;
        let name = read_name(&mut file)?;
        let [x, y, z, precision] = f64s(&file.bytes::<32>("up and precision")?);
        let mut scene = Self { precision, ..Self::new("", DVec3::new(x, y, z)) };
        let has_view = file.u32("view")? != 0;
        let [a, b, c, d, e, f] = f64s(&file.bytes::<48>("view")?);
        scene.view = has_view.then_some((DVec3::new(a, b, c), DVec3::new(d, e, f)));
        let material = |file: &mut Reader<_>| -> Result<(Vec<u8>, [f32; 4]), Error> {
            Ok((read_name(file)?, f32s(&file.bytes::<16>("materials")?)))
        };
        let count = file.count("materials", MOST)?;
        // The list grows with the bytes read, so a wrong count reserves no memory.
        let materials: Vec<_> =
            (0..count).map(|_| material(&mut file)).collect::<Result<_, _>>()?;
        let mut corners = 0_u64;
        let polygons = file.list("polygons", MOST, |bytes: &[u8; 8]| {
            corners = corners.saturating_add(u32_at(bytes, 0).into());
            (corners as usize, u32_at(bytes, 4))
        })?;
        if corners > MOST as u64 {
            return Err(too_many("corners", corners, MOST as u64));
        }
        (scene.ends, scene.material_of) = polygons.into_iter().unzip();
        scene.corners = file.items("corners", corners as usize, |bytes: &[u8; 24]| {
            DVec3::from_array(f64s(bytes))
        })?;
        scene.lines = file.list("lines", MOST, |bytes: &[u8; 8]| {
            usize::try_from(u64_at(bytes, 0)).unwrap_or(usize::MAX)
        })?;
        let is_there = |bytes: &[u8]| bytes[..4] != [0; 4];
        scene.attributes = Attributes {
            uvs: file.list("texture coordinates", MOST, |bytes: &[u8; 20]| {
                is_there(bytes).then(|| DVec2::from_array(f64s(&bytes[4..])))
            })?,
            normals: file.list("normals", MOST, |bytes: &[u8; 28]| {
                is_there(bytes).then(|| DVec3::from_array(f64s(&bytes[4..])))
            })?,
            colors: file.list("colours", MOST, |bytes: &[u8; 16]| {
                is_there(bytes).then(|| f32s(&bytes[4..]))
            })?,
        };
        file.finish()?;
        let name_of = |bytes| String::from_utf8(bytes).map_err(|_| damaged("name", "is not UTF-8"));
        scene.name = name_of(name)?;
        for (name, [red, green, blue, opacity]) in materials {
            let color = [red, green, blue];
            scene.materials.push(Material { name: name_of(name)?, color, opacity });
        }
        let Attributes { uvs, normals, colors } = &scene.attributes;
        let is_wrong = |len: usize, of: usize| len != 0 && len != of;
        if is_wrong(scene.lines.len(), scene.len()) {
            return Err(damaged("lines", "do not match its polygons in number"));
        }
        let of_corners = [uvs.len(), normals.len(), colors.len()];
        if of_corners.into_iter().any(|len| is_wrong(len, scene.corners.len())) {
            let what = "texture coordinates, normals or colours";
            return Err(damaged(what, "do not match its corners in number"));
        }
        Ok(scene)
    }
}

fn write_name(file: &mut Writer<impl Write>, name: &str) -> io::Result<()> {
    if name.len() > LONGEST {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "a name is too long for a file"));
    }
    file.list(name.bytes(), |file, byte| file.put([byte]))
}

fn read_name(file: &mut Reader<impl Read>) -> Result<Vec<u8>, Error> {
    file.list("bytes of a name", LONGEST, |&[byte]: &[u8; 1]| byte)
}

fn f64s<const N: usize>(bytes: &[u8]) -> [f64; N] {
    let chunks = bytes.as_chunks::<8>().0;
    std::array::from_fn(|i| chunks.get(i).map_or(0.0, |&bytes| f64::from_le_bytes(bytes)))
}

fn f32s<const N: usize>(bytes: &[u8]) -> [f32; N] {
    let chunks = bytes.as_chunks::<4>().0;
    std::array::from_fn(|i| chunks.get(i).map_or(0.0, |&bytes| f32::from_le_bytes(bytes)))
}
